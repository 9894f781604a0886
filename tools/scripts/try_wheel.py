"""Runs what an installed package can do. tools/wheel calls it with the Python of a fresh environment.

python -I tools/scripts/try_wheel.py REPOSITORY
"""

import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

import manyworlds
import manyworlds.plot
import manyworlds.record

AVX2 = {"avx2", "fma", "bmi2"}
NEEDS = {  # of instruction sets
    "scalar": set(),
    "avx2": AVX2,
    "avx512": AVX2 | {"avx512f", "avx512vl", "avx512dq", "avx512bw"},
}
BALL = "<mujoco><worldbody><body><freejoint/><geom size='1'/></body></worldbody></mujoco>"
MUJOCO = sys.version_info >= (3, 11)
PACKAGE = pathlib.Path(manyworlds.__file__).parent
COMMAND = pathlib.Path(sys.executable).with_name("manyworlds")


def cpu():
    """What the CPU can do."""
    return set(re.search(r"^flags\s*:(.*)", pathlib.Path("/proc/cpuinfo").read_text(), re.M)[1].split())


def mjcf_scene():
    """A scene of an MJCF text; on Python 3.10, which mujoco-core does not support, another."""
    if MUJOCO:
        return manyworlds.mjcf.load_string(BALL)
    try:
        manyworlds.mjcf.load_string(BALL)
    except ImportError as error:
        assert "Python 3.11" in str(error), error
    else:
        raise AssertionError("an MJCF text was read without MuJoCo")
    return manyworlds.scenes.load("ball3d")


def try_package(repository):
    assert PACKAGE.is_relative_to(sys.prefix), PACKAGE
    assert (PACKAGE / "py.typed").exists()
    built = (os.environ.get("MW_ISAS") or "scalar;avx2;avx512").split(";")
    assert manyworlds.available_isas() == [isa for isa in NEEDS if isa in built and NEEDS[isa] <= cpu()]
    examples = re.findall(r"```python\n(.*?)```", (repository / "README.md").read_text(), re.S)
    assert examples
    for code in examples:
        exec(code.replace("range(1000)", "range(50)"), {})
    scene = mjcf_scene()
    batch = manyworlds.Batch(scene, worlds=5)
    with tempfile.TemporaryDirectory() as folder:
        with manyworlds.record.Recorder(batch, f"{folder}/run.h5"):
            batch.step(10)
        assert manyworlds.record.Recording(f"{folder}/run.h5").replay().same
    assert len(manyworlds.show(batch).text) > 200_000  # the page is there
    with manyworlds.view(batch) as view:
        assert view.port > 0 and view.url.startswith("http://127.0.0.1:")
    assert manyworlds.plot.Picture(scene).frame(batch).std() > 1


def program(*arguments, status=0, module=False, **environment):
    """Standard output and standard error of the program, which has to end with this status."""
    command = [sys.executable, "-m", "manyworlds"] if module else [str(COMMAND)]
    done = subprocess.run(
        [*command, *arguments],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == status, (arguments, done.returncode, done.stdout, done.stderr)
    return done.stdout + done.stderr


def try_program():
    assert manyworlds.__version__ in program("--version")
    assert program("--version", module=True) == program("--version")
    program("nosuch", status=2)
    program("nosuch", status=2, module=True)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        program("run", "ball3d", "--worlds", "5", "--steps", "10", "--record", "run.h5")
        program("replay", "run.h5")
        program("view", "run.h5", "--out", "page.html")
        assert pathlib.Path("page.html").stat().st_size > 200_000
        pathlib.Path("ball.xml").write_text(BALL)
        status = 0 if MUJOCO else 2
        message = program("run", "ball.xml", "--worlds", "5", "--steps", "3", status=status)
        assert MUJOCO or "Python 3.11" in message, message
        # As where mujoco-core is not installed: only models need it.
        program("run", "ball3d", "--worlds", "5", "--steps", "3", MANYWORLDS_MUJOCO="")
        message = program("run", "ball.xml", "--steps", "3", status=2, MANYWORLDS_MUJOCO="")
        reason = "pip install 'manyworlds-sim[mjcf]'" if MUJOCO else "Python 3.11"
        assert reason in message and message.count("\n") == 1, message
        os.chdir("/")


def try_signals():
    """The process is the program itself, so a signal reaches it and its status is what a shell sees."""
    steps = ["run", "ball3d", "--worlds", "100", "--steps", "100000000"]
    for command in ([str(COMMAND)], [sys.executable, "-m", "manyworlds"]):
        with subprocess.Popen(
            [*command, *steps], stdout=subprocess.PIPE, stderr=subprocess.PIPE
        ) as run:
            for _ in range(600):
                if os.readlink(f"/proc/{run.pid}/exe") == str(
                    (PACKAGE / "bin/manyworlds").resolve()
                ):
                    break
                signal.sigtimedwait([], 0.05)
            else:
                raise AssertionError("the process is not the program")
            signal.sigtimedwait([], 0.5)
            run.terminate()
            run.communicate(timeout=60)
            assert run.returncode in (-signal.SIGTERM, 128 + signal.SIGTERM), run.returncode


if __name__ == "__main__":
    try_package(pathlib.Path(sys.argv[1]))
    try_program()
    try_signals()
    print(
        f"README's Python and the program ran with manyworlds {manyworlds.__version__}, {PACKAGE}"
    )
