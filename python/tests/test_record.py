"""Recordings: what was recorded is read back, and done again bit by bit."""

import importlib.util
import os
import subprocess
import sys
import threading

import numpy as np
import pytest

import manyworlds as mw
from conftest import crates, lander

if importlib.util.find_spec("manyworlds._record") is None:
    pytest.skip("built without HDF5", allow_module_level=True)
import manyworlds.record as record  # noqa: E402


def disturbed(file, batch, steps=12, **arguments):
    """A recording with inputs of many kinds; returns what was there at its samples."""
    seen = []
    with record.Recorder(batch, file, **arguments) as recorder:
        seen.append(batch.get("position"))
        for i in range(steps):
            batch.add_force((3.0, 0, 9), bodies=1, ids=[1])
            if i == 4:
                batch.reset([2])
                batch.set_enabled(False, bodies=2, ids=[0])
            batch.step(2)
            seen.append(batch.get("position"))
        assert recorder.samples == steps + 1
    return np.array(seen)


def test_what_is_recorded_is_read_back_and_replayed(batch, tmp_path):
    file = tmp_path / "run.h5"
    seen = disturbed(file, batch, worlds=[0, 1, 4])
    with record.Recording(file) as recording:
        assert recording.kinds == 1 and recording.precision == "f32" and not recording.sleep
        np.testing.assert_array_equal(recording.worlds, [0, 1, 4])
        np.testing.assert_array_equal(recording.steps, 2 * np.arange(13))
        x = recording.get("position")
        assert x.dtype == np.float32
        np.testing.assert_array_equal(x, seen[:, [0, 1, 4]])
        np.testing.assert_array_equal(recording.get("position", sample=3), seen[3, [0, 1, 4]])
        assert recording.get("orientation").shape == (13, 3, 3, 4)
        np.testing.assert_array_equal(recording.hashes[-1], batch.hashes()[[0, 1, 4]])
        assert recording.status.shape == (13, 3) and not recording.status.any()
        assert recording.inputs > 12
        assert recording.scene() == batch.plan.scene
        for isa in mw.available_isas():
            result = recording.replay(isa=isa, threads=2)
            assert result.same and result.difference is None
            assert (result.worlds, result.samples, result.compared) == (3, 13, 39)
            assert result.steps == 24 and isa in result.kernel_table
    assert recording.closed and "closed" in repr(recording)
    with pytest.raises(ValueError, match="the recording is closed"):
        recording.get("position")


def test_coordinates_of_robots_are_read_back(tmp_path):
    """Of which there are more than bodies."""
    file = tmp_path / "run.h5"
    with mw.Batch("cheetah", 3, threads=1, seed=2) as robots:
        with record.Recorder(robots, file):
            robots.step(5, controls=0.5)
        with record.Recording(file) as recording:
            for field in ("generalized_position", "generalized_velocity", "position"):
                assert (recording.get(field)[-1] == robots.get(field)).all()
            assert recording.get("generalized_position").shape == (2, 3, 9, 1)


def test_contacts_bear_the_weight(tmp_path):
    ground = mw.Body(motion="fixed", shapes=[mw.Shape(geometry=mw.Plane())])
    crate = mw.Body(position=(0, 0, 0.5), shapes=[mw.Shape(geometry=mw.Box())])
    scene = mw.Scene(bodies=[ground, crate])
    with mw.Batch(scene, 2, threads=1, observe=["contacts"]) as crates_:
        crates_.step(240)
        with record.Recorder(crates_, tmp_path / "run.h5", contacts=3):
            crates_.step(1)
        seen = crates_.step_contacts(1)
    with record.Recording(tmp_path / "run.h5") as recording:
        assert recording.has_contacts
        found = recording.contacts(1, 1)
        assert found.dtype == record.RECORDED_CONTACT and len(found) == 3
        assert recording.contacts_found(1, 1) == 4
        assert (found["body_a"] == 0).all() and (found["body_b"] == 1).all()
        forces = np.sort(seen["normal_impulse"] / scene.options.dt)[1:]
        np.testing.assert_allclose(np.sort(found["force"]), forces, rtol=1e-6)
        np.testing.assert_allclose(found["normal"], [[0, 0, 1]] * 3, atol=1e-6)
        with pytest.raises(IndexError):
            recording.contacts(2, 0)
    with mw.Batch(scene, 2, threads=1) as blind:
        with pytest.raises(ValueError, match="does not observe contacts"):
            record.Recorder(blind, tmp_path / "none.h5", contacts=3)
        with record.Recorder(blind, tmp_path / "plain.h5"):
            blind.step()
    with record.Recording(tmp_path / "plain.h5") as plain:
        assert not plain.has_contacts and len(plain.contacts(1, 0)) == 0


def test_h5py_reads_the_same(batch, tmp_path):
    h5py = pytest.importorskip("h5py")
    seen = disturbed(tmp_path / "run.h5", batch)
    with h5py.File(tmp_path / "run.h5") as file:
        np.testing.assert_array_equal(file["kinds/0/position"][:], seen)
        np.testing.assert_array_equal(file["step"][:], 2 * np.arange(13))
        assert file["kinds/0/position"].attrs["unit"].decode() == "m"


def test_a_changed_file_is_refused(batch, tmp_path):
    file = tmp_path / "run.h5"
    disturbed(file, batch)
    data = bytearray(file.read_bytes())
    data[len(data) // 2] ^= 1
    file.write_bytes(data)
    with pytest.raises(record.RecordError, match="run.h5"):
        record.Recording(file)
    assert issubclass(record.RecordError, ValueError)
    with pytest.raises(record.RecordError, match="nothing.h5"):
        record.Recording(tmp_path / "nothing.h5")


def test_environments_are_recorded_over_the_ends_of_episodes(tmp_path):
    env = mw.Environment("CartPole", worlds=9, seed=3, autoreset="same_step")
    rng = np.random.default_rng(1)
    ended = 0
    with record.Recorder(env.batch, tmp_path / "run.h5", every=0) as recorder:
        for _ in range(60):
            _, _, terminated, _ = env.step(rng.integers(0, 2, 9))
            ended += terminated.sum()
            recorder.sample()
    assert ended > 5
    assert record.Recording(tmp_path / "run.h5").replay().same


def test_what_is_not_finished_leaves_no_file(batch, tmp_path):
    recorder = record.Recorder(batch, tmp_path / "run.h5")
    batch.step(3)
    del recorder
    batch.step()
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(ZeroDivisionError):
        with record.Recorder(batch, tmp_path / "run.h5"):
            batch.step(3)
            1 / 0
    assert len(record.Recording(tmp_path / "run.h5").steps) == 2


CUT_OFF = """
import os, signal, sys
import manyworlds as mw
batch = mw.Batch("stack10", worlds=2, threads=1, seed=3)
recorder = mw.record.Recorder(batch, sys.argv[1], every=2, flush_seconds=float(sys.argv[2]))
batch.step(2), batch.step(2)
batch.add_impulse((0, 0, 1), bodies=1)
batch.step(2)
os.kill(os.getpid(), signal.SIGKILL)
"""


def cut_off(file, flush_seconds):
    """What a process that is killed while it records leaves of a file."""
    done = subprocess.run([sys.executable, "-c", CUT_OFF, file, flush_seconds], stderr=-1)
    assert done.returncode < 0, done.stderr
    return record.unfinished_recordings(file)


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_what_a_killed_process_had_flushed_is_found_and_replays(tmp_path):
    file = tmp_path / "run.h5"
    assert record.unfinished_recordings(file) == []
    (left,) = cut_off(file, "0")
    assert left.name.startswith("run.h5.part-") and left.parent == tmp_path and not file.exists()
    with record.Recording(left) as recording:
        assert not recording.finished and "unfinished" in repr(recording)
        assert recording.steps.tolist() == [0, 2, 4, 6] and recording.inputs == 2
        assert recording.replay().same
    batch = mw.Batch("stack10", worlds=2, threads=1, seed=3)
    with record.Recorder(batch, file, flush_seconds=0) as recorder:
        batch.step()
        assert len(record.unfinished_recordings(str(file))) == 1  # without the one that is written
        recorder.sample()
    with record.Recording(file) as recording:
        assert recording.finished and "unfinished" not in repr(recording)
    assert record.unfinished_recordings(file) == [left]


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_without_a_flush_a_killed_process_leaves_nothing_that_counts(tmp_path):
    assert cut_off(tmp_path / "run.h5", "inf") == []


def test_a_busy_batch_is_recorded_on_and_closed_later(batch, tmp_path):
    recorder = record.Recorder(batch, tmp_path / "run.h5", every=0)
    dumps = record.LostWorldDumps(batch, tmp_path / "lost")
    batch.add_force((np.inf, 0, 0), bodies=1, ids=[3])
    thread = threading.Thread(target=batch.step, args=(100_000,))
    thread.start()
    refused = 0
    while thread.is_alive() and not refused:
        try:
            batch.time
        except RuntimeError:
            refused = 1
            for close in (recorder.close, dumps.close):
                with pytest.raises(RuntimeError, match="in use by another thread"):
                    close()
    thread.join()
    assert refused
    recorder.close()
    with pytest.raises(ValueError, match="the recorder is closed"):
        recorder.sample()
    assert len(record.Recording(tmp_path / "run.h5").steps) == 1
    assert (
        [file.name for file in dumps.close()]
        == ["world_3.h5"]
        == [file.name for file in dumps.close()]
    )


def test_a_recording_outlives_its_batch(tmp_path):
    batch = lander()
    recorder = record.Recorder(batch, tmp_path / "run.h5")
    batch.step(2)
    batch.close()
    recorder.close()
    recorder.close()
    assert record.Recording(tmp_path / "run.h5").replay().same


def test_lost_worlds_are_dumped(tmp_path):
    batch = mw.Batch(crates(), worlds=6, seed=2)
    with record.LostWorldDumps(batch, tmp_path / "lost") as dumps:
        batch.step(5)
        batch.add_force((np.inf, 0, 0), bodies=1, ids=[3])
        batch.step()
        batch.step()
    assert [file.name for file in dumps.files] == ["world_3.h5"]
    recording = record.Recording(dumps.files[0])
    assert recording.worlds.tolist() == [3] and recording.status[-1, 0] != 0
    assert recording.replay().same


def test_scenes_become_json_and_come_back():
    for name in mw.scenes.names():
        scene = mw.scenes.load(name)
        assert record.scene_from_json(record.scene_to_json(scene)) == scene
    with pytest.raises(record.RecordError):
        record.scene_from_json("{}")


def test_many_threads_record_and_read_at_a_time(tmp_path):
    problems = []

    def work(i):
        try:
            batch = mw.Batch(crates(), worlds=4, threads=1, seed=i)
            for turn in range(5):
                file = tmp_path / f"{i}_{turn}.h5"
                with record.Recorder(batch, file):
                    batch.step(3)
                assert record.Recording(file).replay(threads=1).same
        except BaseException as error:  # noqa: BLE001: said by the main thread
            problems.append(error)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert problems == []


@pytest.mark.parametrize(
    "arguments, error, words",
    [
        ({"worlds": []}, ValueError, "at least one"),
        ({"worlds": [6]}, IndexError, "worlds hold 6"),
        ({"worlds": [2, 1]}, ValueError, "must ascend"),
        ({"every": -1}, ValueError, "every is -1"),
        ({"every": 1.5}, TypeError, "every is of type float"),
        ({"flush_seconds": -1}, ValueError, "flush_seconds is -1, must be >= 0"),
        ({"flush_seconds": np.nan}, ValueError, "flush_seconds is nan, must be >= 0"),
        ({"flush_seconds": "5"}, TypeError, "flush_seconds is of type str; expected a number"),
        ({"flush_seconds": True}, TypeError, "flush_seconds is of type bool; expected a number"),
        ({"flush_seconds": None}, TypeError, "flush_seconds is of type NoneType"),
    ],
)
def test_wrong_arguments_are_errors(batch, tmp_path, arguments, error, words):
    with pytest.raises(error, match=words):
        record.Recorder(batch, tmp_path / "run.h5", **arguments)
    assert list(tmp_path.iterdir()) == []


def test_more_wrong_arguments_are_errors(batch, tmp_path):
    with pytest.raises(TypeError, match="expected a Batch"):
        record.Recorder("stack10", tmp_path / "run.h5")
    with pytest.raises(record.RecordError, match="nowhere"):
        record.Recorder(batch, tmp_path / "nowhere" / "run.h5")
    with pytest.raises(record.RecordError, match="is a directory"):
        record.Recorder(batch, tmp_path)
    with pytest.raises(record.RecordError, match="nothing.*no such|cannot"):
        record.Recording("/nothing/\udcff.h5")
    with pytest.raises(ValueError, match="contains a NUL character"):
        record.Recording("a\0b")
    with pytest.raises(TypeError, match="file is of type int; expected a str or a Path"):
        record.Recorder(batch, 3)
    with pytest.raises(TypeError, match="file is of type int; expected a str or a Path"):
        record.unfinished_recordings(3)
    with pytest.raises(record.RecordError, match="is a directory"):
        record.unfinished_recordings(tmp_path)
    with pytest.raises(TypeError, match="scene is of type NoneType; expected manyworlds.Scene"):
        record.scene_to_json(None)
    with pytest.raises(TypeError, match="json is of type bytes; expected a str"):
        record.scene_from_json(b"{}")
    batch.add_force((0, 0, 1), bodies=1)
    with pytest.raises(ValueError, match="forces are pending"):
        record.Recorder(batch, tmp_path / "run.h5")
    batch.step()
    disturbed(tmp_path / "run.h5", batch)
    recording = record.Recording(tmp_path / "run.h5")
    with pytest.raises(ValueError, match="expected one of 'position'"):
        recording.get("positon")
    with pytest.raises(IndexError, match="sample is 13"):
        recording.get("position", sample=13)
    with pytest.raises(IndexError, match="kind is 1"):
        recording.scene(1)
    with pytest.raises(ValueError, match="expected one of 'scalar'"):
        recording.replay(isa="avx")
