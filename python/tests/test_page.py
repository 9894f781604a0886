"""Pages from Python; what is on them is tested in C++ and in a browser."""

import json
import re

import numpy as np
import pytest

import manyworlds as mw

record = pytest.importorskip("manyworlds.record")

EMPTY = (
    '<meta name="manyworlds-page" content="1"><!-- manyworlds: recordings -->'
)


@pytest.fixture
def viewer(tmp_path, monkeypatch):
    file = tmp_path / "viewer.html"
    file.write_text(EMPTY)
    monkeypatch.setenv("MANYWORLDS_VIEWER", str(file))
    return file


def recorded(folder, name="stack10", worlds=3, every=2):
    batch = mw.Batch(name, worlds=worlds)
    with record.Recorder(batch, folder / f"{name}.h5", every=every):
        batch.step(12)
    return record.Recording(folder / f"{name}.h5")


def head_of(page):
    return json.loads(re.search(r'id="mw-head">(.*?)</script>', page, re.S).group(1))


def test_a_page_of_a_recording(viewer, tmp_path):
    run = recorded(tmp_path)
    rewards = np.arange(len(run.steps) * 3).reshape(-1, 3)
    report = mw.write_page(
        [run, recorded(tmp_path, "ball3d")][:1], tmp_path / "p.html", title="T", numbers={"reward": rewards}
    )
    assert report == (3, 30, len(run.steps), (tmp_path / "p.html").stat().st_size)
    head = head_of((tmp_path / "p.html").read_text())
    assert head["title"] == "T" and [n["name"] for n in head["runs"][0]["numbers"]] == ["reward"]
    other = record.Recording(run.file)
    assert len(head_of(mw.show([run, other]).text)["runs"]) == 2


def test_a_notebook_shows_recordings_and_batches(viewer, tmp_path):
    run = recorded(tmp_path)
    page = mw.show(run, worlds=2, every=3, height=300)
    html = page._repr_html_()
    assert html.startswith("<iframe srcdoc=") and "height: 300px" in html and "<meta" not in html
    assert "&lt;meta" in html and 'sandbox="allow-scripts"' in html
    head = head_of(page.text)
    assert head["runs"][0]["kinds"][0]["worlds"] == 2
    now = head_of(mw.show(mw.Batch("ball2d", worlds=4)).text)["runs"][0]
    assert now["kinds"][0]["worlds"] == 4 and len(now["times"]) == 1
    page.save(tmp_path / "saved.html")
    assert (tmp_path / "saved.html").read_text() == page.text


def test_a_cell_that_ends_with_a_batch_shows_it(viewer):
    batch = mw.Batch("bin-boxes", worlds=200)
    batch.step(3)
    before = batch.hashes().tolist()
    html = batch._repr_html_()
    assert batch.steps == 3 and batch.hashes().tolist() == before
    assert html.startswith("<div><code>&lt;manyworlds.Batch &#x27;bin-boxes&#x27;: 200 worlds")
    assert "shown: the first 64 of 200 worlds" in html and html.count("<iframe srcdoc=") == 1
    head = head_of(html.replace("&quot;", '"').replace("&lt;", "<").replace("&gt;", ">"))
    assert [kind["worlds"] for kind in head["runs"][0]["kinds"]] == [64]
    assert len(head["runs"][0]["times"]) == 1
    few = mw.Batch("joint-grid", worlds=300)._repr_html_()  # 100 bodies in each
    assert "the first 64 of 300 worlds" in few
    many = mw.Batch([("ball3d", 2), ("stack10", 3)])
    assert "shown" not in many._repr_html_()
    task = mw.Environment("Pendulum", worlds=4)
    assert task._repr_html_().startswith("<div><code>&lt;manyworlds.Environment &#x27;Pendulum&#x27;")
    task.close()
    assert task._repr_html_() is None
    batch.add_force([0, 0, 1])  # for the next step: no page, and no error
    assert batch._repr_html_() is None and len(repr(batch)) > 10
    viewer.unlink()
    assert many._repr_html_() is None
    many.close()
    assert many._repr_html_() is None


def test_what_is_refused(viewer, tmp_path, monkeypatch):
    run = recorded(tmp_path)
    with pytest.raises(ValueError, match="recordings is empty"):
        mw.write_page([], tmp_path / "p.html")
    with pytest.raises(TypeError, match=r"recordings\[0\] is of type int; expected a Recording"):
        mw.show(3)
    with pytest.raises(ValueError, match=r"numbers\['r'\] has shape \(2,\)"):
        mw.show(run, numbers={"r": [1, 2]})
    with pytest.raises(ValueError, match="worlds"):
        mw.show(run, worlds=0)
    with pytest.raises(record.RecordError, match="no such folder: "):
        mw.write_page([run], tmp_path / "no" / "p.html")
    viewer.write_text("<html>")
    with pytest.raises(record.RecordError, match="is not a page of this version"):
        mw.show(run)
    viewer.unlink()
    with pytest.raises(FileNotFoundError, match="there is no page at .*tools/viewer"):
        mw.show(run)
    run.close()
    viewer.write_text(EMPTY)
    with pytest.raises(ValueError, match="the recording is closed"):
        mw.show(run)
