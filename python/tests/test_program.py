"""The program in the package: ``python -m manyworlds``. tools/wheel tests the command that pip installs."""

import os
import subprocess
import sys

import pytest

import manyworlds
from manyworlds import __main__ as launcher

pytestmark = pytest.mark.skipif(
    not os.access(launcher._PROGRAM, os.X_OK), reason="built without the program"
)


def run(*arguments, **environment):
    return subprocess.run(
        [sys.executable, "-m", "manyworlds", *arguments],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=60,
    )


def test_arguments_and_output_are_the_programs():
    done = run("run", "ball3d", "--worlds", "3", "--steps", "2", "--json")
    assert done.returncode == 0, done.stderr
    assert '"worlds": 3' in done.stdout


def test_exit_status_is_the_programs():
    assert run("nosuch").returncode == 2
    assert run("--version").returncode == 0
    assert manyworlds.__version__ in run("--version").stdout


def test_process_is_replaced_by_the_program():
    command = [
        sys.executable,
        "-m",
        "manyworlds",
        "run",
        "ball3d",
        "--worlds",
        "100",
        "--steps",
        "1000000000",
    ]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        wanted = str(launcher._PROGRAM.resolve())
        try:
            while os.readlink(f"/proc/{process.pid}/exe") != wanted:
                assert process.poll() is None
        finally:
            process.kill()


def test_missing_program_is_exit_3(monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(launcher, "_PROGRAM", tmp_path / "manyworlds")
    with pytest.raises(SystemExit) as stop:
        launcher.main()
    assert stop.value.code == 3
    assert str(tmp_path) in capsys.readouterr().err


def test_program_gets_the_installed_libmujoco_and_encoder(monkeypatch, tmp_path):
    package = tmp_path / "mujoco"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "libmujoco.so.4.0.1").touch()
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "mujoco", raising=False)
    started = []
    monkeypatch.setattr(os, "execv", lambda program, arguments: started.append(arguments))
    monkeypatch.setattr(sys, "argv", ["__main__.py", "plan", "ball3d"])
    monkeypatch.setenv("MANYWORLDS_MUJOCO", "")  # restored at the end
    monkeypatch.delenv("MANYWORLDS_MUJOCO")
    monkeypatch.setenv("FFMPEG", "")
    monkeypatch.setattr(launcher, "encoder_program", lambda: "/opt/ffmpeg")
    launcher.main()
    assert started == [["manyworlds", "plan", "ball3d"]]
    assert os.environ["MANYWORLDS_MUJOCO"] == str(package / "libmujoco.so.4.0.1")
    assert os.environ["FFMPEG"] == "/opt/ffmpeg"

    del os.environ["MANYWORLDS_MUJOCO"]
    (package / "libmujoco.so.4.0.1").rename(package / "libmujoco.so.3.3.0")
    monkeypatch.setenv("MANYWORLDS_NO_MUJOCO", "")
    launcher.main()
    assert "MANYWORLDS_MUJOCO" not in os.environ
    assert "3.3.0" in os.environ["MANYWORLDS_NO_MUJOCO"]
