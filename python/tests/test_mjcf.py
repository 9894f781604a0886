"""MJCF files: scenes with MuJoCo's own numbers, and clear errors."""

import importlib.util
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

import manyworlds as mw

ROOT = Path(__file__).parents[2]
if importlib.util.find_spec("manyworlds._mjcf") is None:
    pytest.skip("built without MuJoCo", allow_module_level=True)

BALL = """
<mujoco model="ball">
  <option timestep="0.004" gravity="0 0 -3.7"/>
  <worldbody>
    <geom name="ground" type="plane" size="5 5 0.1"/>
    <body name="ball" pos="0 0 2">
      <freejoint/>
      <geom type="sphere" size="0.1" mass="0.5"/>
    </body>
  </worldbody>
</mujoco>
"""


def test_a_text_becomes_a_scene():
    scene = mw.mjcf.load_string(BALL)
    assert [body.name for body in scene.bodies] == ["world", "ball"]
    assert [body.motion for body in scene.bodies] == ["fixed", "dynamic"]
    assert scene.options.dt == 0.004
    assert scene.options.gravity == (0, 0, -3.7)
    mass = scene.mass_properties(1)
    assert mass.mass == pytest.approx(0.5)
    np.testing.assert_allclose(mass.inertia, np.eye(3) * 0.4 * 0.5 * 0.01, atol=1e-12)
    batch = mw.Batch(scene, worlds=8)
    batch.step(1000)
    np.testing.assert_allclose(batch.get("position")[:, 0, 2], 0.1, atol=2e-3)


def test_a_file_becomes_a_scene_that_steps():
    for file in (ROOT / "scenes/mjcf").glob("*.xml"):
        batch = mw.Batch(mw.mjcf.load(file), worlds=4)
        batch.step(100)
        assert batch.bodies > 0 and not batch.lost().any()


def test_what_acts_otherwise_is_a_warning():
    soft = BALL.replace('size="0.1"', 'size="0.1" solref="0.1 1"')
    with pytest.warns(mw.mjcf.MjcfWarning, match="solref") as warned:
        mw.mjcf.load_string(soft)
    assert warned[0].filename == __file__


def test_what_is_not_simulated_is_an_error_that_names_it(tmp_path):
    rough = BALL.replace("<freejoint/>", '<joint name="hip" frictionloss="1"/>')
    (tmp_path / "leg.xml").write_text(rough)
    with pytest.raises(mw.mjcf.MjcfError, match="leg.xml.*'hip'.*frictionloss"):
        mw.mjcf.load(tmp_path / "leg.xml")
    assert issubclass(mw.mjcf.MjcfError, ValueError)
    with pytest.raises(mw.mjcf.MjcfError, match="no such file"):
        mw.mjcf.load(tmp_path / "none.xml")
    with pytest.raises(mw.mjcf.MjcfError):
        mw.mjcf.load_string("<mujoco><worldbody><geom/>")
    with pytest.raises(mw.mjcf.MjcfError, match="contains a NUL character"):
        mw.mjcf.load_string(BALL + "\0<oops/>")
    with pytest.raises(TypeError, match="file is of type int"):
        mw.mjcf.load(7)
    with pytest.raises(TypeError, match="xml is of type NoneType; expected a str"):
        mw.mjcf.load_string(None)


def test_files_come_from_the_model_s_folder_and_from_roots(tmp_path):
    (tmp_path / "model").mkdir()
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts/ball.xml").write_text(BALL)
    model = tmp_path / "model/model.xml"
    model.write_text('<mujoco><include file="../parts/ball.xml"/></mujoco>')
    with pytest.raises(
        mw.mjcf.MjcfError, match="include, line 1: .* is outside the model's folder"
    ):
        mw.mjcf.load(model)
    assert len(mw.mjcf.load(model, roots=[tmp_path / "parts"]).bodies) == len(
        mw.mjcf.load_string(BALL).bodies
    )
    text = '<mujoco><include file="ball.xml"/></mujoco>'
    with pytest.raises(mw.mjcf.MjcfError, match="an MJCF string has no folder"):
        mw.mjcf.load_string(text)
    assert mw.mjcf.load_string(text, roots=[str(tmp_path / "parts")]).bodies
    with pytest.raises(TypeError, match="roots must be a list of folders"):
        mw.mjcf.load(model, roots="parts")


def test_what_asks_for_too_much_is_refused_and_limits_widen():
    crowd = BALL.replace("<body", '<replicate count="20"><body').replace(
        "</body>", "</body></replicate>"
    )
    with pytest.raises(mw.mjcf.MjcfError, match=r"replicate, line \d+: .*expected at most 9 .*'copies'"):
        mw.mjcf.load_string(crowd, limits={"copies": 9})
    assert len(mw.mjcf.load_string(crowd).bodies) >= 20
    assert mw.mjcf.limits()["copies"] >= 10000
    with pytest.raises(ValueError, match="'copys' is unknown; there are .*copies"):
        mw.mjcf.load_string(crowd, limits={"copys": 9})
    with pytest.raises(TypeError):
        mw.mjcf.load_string(crowd, limits={"copies": 9.5})


def test_the_extra_accepts_the_versions_that_were_tested():
    tested = mw.mjcf._TESTED
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    (extra,) = project["optional-dependencies"]["mjcf"]
    assert extra == f"mujoco-core>={tested[0]},<={tested[-1]}"
    fetched = (ROOT / "tools/scripts/fetch_mujoco.sh").read_text().split("\nversion=")[1].split()[0]
    assert fetched in tested
    source = (ROOT / "src/mjcf/mjcf.cpp").read_text()
    numbers = source.split("kTestedVersions = {")[1].split("}")[0].split(",")
    parts = [[int(part) for part in version.split(".")] for version in tested]
    assert [int(n) for n in numbers] == [a * 1_000_000 + b * 1000 + c for a, b, c in parts]
    script = (ROOT / "tools/scripts/check_mujoco_versions").read_text()
    assert f"versions=({' '.join(tested)})" in script


@pytest.mark.parametrize(
    ("versions", "message"),
    [
        (["3.17.0"], r"found MuJoCo 3\.17\.0 in .*; expected one of 4\.0\.0, .*pip install 'manyworlds-sim\[mjcf\]'"),
        (["3.17.0", "4.0.1"], r"found MuJoCo 3\.17\.0 and 4\.0\.1 in .*pip uninstall mujoco mujoco-core, then pip"),
        ([], r"found MuJoCo without its library in "),
    ],
)
def test_a_mujoco_that_was_not_tested_is_refused(versions, message, monkeypatch, tmp_path):
    package = tmp_path / "mujoco"
    package.mkdir()
    (package / "__init__.py").touch()
    for version in versions:
        (package / f"libmujoco.so.{version}").touch()
    monkeypatch.delitem(sys.modules, "mujoco", raising=False)
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(ImportError, match=message):
        mw.mjcf.load_string(BALL)


def test_the_module_is_not_linked_with_one_version():
    module = importlib.util.find_spec("manyworlds._mjcf").origin
    assert b"libmujoco.so" not in Path(module).read_bytes()
