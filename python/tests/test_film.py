"""Pictures and films from Python, by programs that stand for Chromium and ffmpeg; real ones are in viewer/test."""

import os
import signal
import sys
import threading
import time
import types
from pathlib import Path

import pytest

import manyworlds as mw

record = pytest.importorskip("manyworlds.record")

SUPPORT = Path(__file__).parents[2] / "tests" / "support"
EMPTY = '<meta name="manyworlds-page" content="1"><!-- manyworlds: recordings -->'


@pytest.fixture
def run(tmp_path, monkeypatch):
    """A recording, in the folder of its own in which all is done."""
    (tmp_path / "viewer.html").write_text(EMPTY)
    (tmp_path / "tmp").mkdir()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MANYWORLDS_VIEWER", "viewer.html")
    monkeypatch.setenv("CHROMIUM", str(SUPPORT / "fake_browser.py"))
    monkeypatch.setenv("FFMPEG", str(SUPPORT / "fake_encoder.sh"))
    monkeypatch.setenv("TMPDIR", str(tmp_path / "tmp"))
    monkeypatch.setattr("tempfile.tempdir", None)
    with record.Recorder(mw.Batch("ball3d", worlds=3), "run.h5"):
        pass
    yield record.Recording("run.h5")
    assert list((tmp_path / "tmp").iterdir()) == [], "something was left"
    assert not list(tmp_path.glob("*.part-*"))


def test_a_film_has_a_frame_for_each_moment(run):
    report = mw.write_film(
        [run], "film.mp4", fps=4, speed=0.5, begin=0.5, end=1, size=(320, 200), world=2, color="number:a b"
    )
    assert report == (5, 1.25, Path("film.mp4").stat().st_size) and report.frames == 5
    frames = Path("film.mp4").read_text().splitlines()
    assert frames == [f"{0.5 + 0.125 * k} image/jpeg true" for k in range(5)]
    assert Path("size").read_text() == "320x200"
    assert Path("url").read_text().endswith("/page.html#film&color=number%3Aa%20b&theme=light&world=2")
    for follow in ("ball & co", mw.BodyId(1), 1):
        mw.write_film([run], "film.mp4", world=1, follow=follow)
        wanted = "ball%20%26%20co" if isinstance(follow, str) else "1"
        assert Path("url").read_text().endswith(f"&world=1&follow={wanted}")


def test_a_picture_is_of_one_moment(run):
    mw.write_picture([run], "a.png", time=1.25, dark=True)
    assert Path("a.png").read_text() == "1.25 image/png false\n"
    assert Path("url").read_text().endswith("#film&color=body&theme=dark")
    mw.write_picture([run], "a.png", follow="ball")
    assert Path("url").read_text().endswith("#film&color=body&theme=light&follow=ball")
    mw.write_picture([run], "a.png")
    assert Path("a.png").read_text() == "2.0 image/png false\n"


def test_what_is_refused(run, monkeypatch):
    for wrong, error, message in [
        ({"size": (641, 480)}, ValueError, "size is 641 x 480; films need even numbers"),
        ({"size": (10, 480)}, ValueError, r"size\[0\]"),
        ({"size": 640}, TypeError, "expected a width and a height"),
        ({"fps": 0}, ValueError, "fps"),
        ({"fps": 2000}, ValueError, "fps is 2000"),
        ({"speed": float("nan")}, ValueError, "speed"),
        ({"begin": 2, "end": 1}, ValueError, "end"),
        (
            {"begin": 3},
            record.FilmError,
            r"the film would start at 3\.0 s, but worlds end at 2\.0 s",
        ),
        ({"world": -1}, ValueError, "world"),
        ({"color": 3}, TypeError, "color is of type int"),
        ({"follow": ""}, ValueError, "follow is empty; expected the name of a body"),
        ({"follow": -1}, ValueError, "follow is -1"),
        ({"follow": 1.5}, TypeError, "follow is of type float"),
        ({"follow": mw.JointId(0)}, TypeError, r"follow is JointId\(0\); expected a BodyId"),
        ({"title": 3}, TypeError, "title"),
    ]:
        with pytest.raises(error, match=message):
            mw.write_film([run], "film.mp4", **wrong)
    monkeypatch.setenv("MODE", "refuses")
    with pytest.raises(record.FilmError, match="the page: there is no world 7, only 0 to 1$"):
        mw.write_picture([run], "a.png")
    monkeypatch.setenv("MODE", "fails")
    with pytest.raises(ValueError, match=r"failed \(exit code 1\): No space left on device"):
        mw.write_film([run], "film.mp4")
    monkeypatch.setenv("FFMPEG", "no-such-encoder")
    with pytest.raises(
        record.FilmError,
        match="found none of no-such-encoder; install Debian's ffmpeg or PyPI's imageio-ffmpeg",
    ):
        mw.write_film([run], "film.mp4")
    assert not Path("film.mp4").exists() and not Path("a.png").exists()


def test_ffmpeg_is_that_of_imageio_ffmpeg_where_there_is_no_other(run, monkeypatch, tmp_path):
    package = types.ModuleType("imageio_ffmpeg")
    package.get_ffmpeg_exe = lambda: str(SUPPORT / "fake_encoder.sh")
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", package)
    monkeypatch.delenv("FFMPEG")
    monkeypatch.setattr("shutil.which", lambda name: None)
    assert mw.write_film([run], "film.mp4", fps=1).frames == 3
    assert Path("film.mp4").read_text().count("image/jpeg") == 3
    # Another goes first.
    monkeypatch.setenv("FFMPEG", "no-such-encoder")
    with pytest.raises(record.FilmError, match="found none of no-such-encoder"):
        mw.write_film([run], "other.mp4")
    # A package without a program is as none.
    def fails():
        raise RuntimeError("No ffmpeg exe could be found")

    monkeypatch.delenv("FFMPEG")
    package.get_ffmpeg_exe = fails
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(record.FilmError, match="found none of ffmpeg; .* imageio-ffmpeg"):
        mw.write_film([run], "other.mp4")


def test_a_film_can_be_interrupted(run, monkeypatch):
    monkeypatch.setenv("MODE", "sleeps")

    def interrupt():
        while not Path("browser_waits").exists() or Path("browser_waits").read_text() == "":
            time.sleep(0.02)
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        mw.write_film([run], "film.mp4")
    thread.join()
    assert not Path(f"/proc/{Path('browser_waits').read_text()}").exists()
