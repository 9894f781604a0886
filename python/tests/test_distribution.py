"""The name that pip knows, and what is said where a package of an extra is missing."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from manyworlds import _distribution

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
SUFFIXES = {".py", ".pyi", ".md", ".cpp", ".hpp", ".toml", ".ts", ".sh", ".txt", ".cff", ".cmake", ".html"}
# PyPI's package of our import name is another project.
OTHER = re.compile(
    r"\b(?:pip3?|pipx|uv|poetry|conda)\s+(?:pip\s+)?(?:install|add)\b[^\n`;|&]*?"
    r"(?<![\w/.])manyworlds(?!-sim|_sim|\.[a-z]|\w)"
    r"|(?<![\w.])manyworlds\[[a-z]"
    r"|(?<!\w)manyworlds-[\d*]\S*\.whl"
)


def test_nothing_recommends_the_other_project():
    listed = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    if listed.returncode != 0:
        pytest.skip("not a git checkout")
    files = [ROOT / name for name in listed.stdout.split("\0") if Path(name).suffix in SUFFIXES]
    assert len(files) > 500
    found = [
        f"{file.relative_to(ROOT)}:{number}: {line.strip()}"
        for file in files
        if file.is_file()
        for number, line in enumerate(file.read_text().splitlines(), 1)
        if OTHER.search(line)
    ]
    assert not found, "\n".join(found)


@pytest.mark.parametrize(
    ("before", "after", "bad"),
    [
        ("pip install ", "", True),
        ("pip install '", "'", True),
        ("uv add numpy ", ".", True),
        ("python -m pip install -q ", " numpy", True),
        ("'", "[gym]'", True),
        ("env/bin/pip install dist/", "-*.whl", True),
        ("pip install ", "-sim", False),
        ("pip install '", "-sim[gym]'", False),
        ("pip install dist/", "_sim-*.whl", False),
        ("pip install . -C cmake.define.MW_PREBUILT=/opt/", "", False),
        ("import ", ".gym", False),
    ],
)
def test_the_search_finds_what_it_should(before, after, bad):
    assert bool(OTHER.search(f"{before}manyworlds{after}")) == bad


def test_the_name_is_that_of_the_project():
    assert PROJECT["name"] == _distribution.DISTRIBUTION != "manyworlds"


# What is imported, the packages that are blocked, the package that is named, the extra.
MISSING = [
    ("import manyworlds.gym", "gymnasium", "manyworlds.gym", "gym"),
    ("import manyworlds.sb3", "gymnasium", "manyworlds.sb3", "sb3"),
    ("import manyworlds.sb3", "stable_baselines3", "manyworlds.sb3", "sb3"),
    ("import manyworlds.plot", "matplotlib", "manyworlds.plot", "plot"),
    ("import manyworlds as mw; mw.mjcf.load_string('<mujoco/>')", "mujoco", "manyworlds.mjcf", "mjcf"),
    (
        "import manyworlds.ray as r; r.Rollouts('CartPole', 4, shards=1)",
        "ray",
        "Rollouts with shards other than 0",
        "ray",
    ),
]


@pytest.mark.parametrize(("code", "package", "what", "extra"), MISSING)
def test_a_missing_extra_says_what_to_install(code, package, what, extra):
    """In a process of its own, since the modules stay imported."""
    if package == "mujoco" and _without("_mjcf"):
        pytest.skip("built without MuJoCo")
    if package == "stable_baselines3":
        pytest.importorskip("gymnasium")
    block = f"""
import sys
class Blocked:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] == {package!r}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)
sys.meta_path.insert(0, Blocked())
try:
    {code}
except ImportError as error:
    print(error)
"""
    ran = subprocess.run([sys.executable, "-c", block], capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.startswith(f"{what} needs ")
    assert f"install it with: pip install 'manyworlds-sim[{extra}]'" in ran.stdout
    assert extra in PROJECT["optional-dependencies"]


def _without(extension):
    return not list(Path(_distribution.__file__).parent.glob(f"{extension}.*.so"))


def test_other_import_errors_pass_unchanged():
    with pytest.raises(ModuleNotFoundError, match="No module named 'no_such'"):
        with _distribution.needs("gymnasium", extra="gym", what="manyworlds.gym"):
            import no_such  # noqa: F401
