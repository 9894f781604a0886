"""Ctrl-C ends the calls that take long, and what they work on stays usable."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import pytest

import manyworlds as mw

NEVER = 2**31 - 1  # steps: days of work
PATIENCE = 120  # s; a call that is not ended takes far longer

# Each makes `begin()`, which would work for long, and `check()` for after it.
BATCH = """
def make():
    return mw.Batch("bin2d", worlds=64, threads=1, seed=1)

batch = make()

def check():
    done = batch.steps
    assert 0 < done < NEVER, done
    other = make()
    other.step(done)
    batch.step(3), other.step(3)
    assert (batch.hashes() == other.hashes()).all()
"""
CASES = {
    "step": BATCH + "begin = lambda: batch.step(NEVER)",
    "rollout": BATCH + "begin = lambda: batch.rollout(steps=NEVER, every=NEVER)",
    "rollout, controlled": """
batch = mw.Batch("lunar-lander", worlds=256, threads=1, seed=1)
controls = np.zeros((5_000, 256, 3), np.float32)
begin = lambda: [batch.rollout(controls=controls, every=5_000) for _ in range(10_000)]
check = lambda: batch.step(3)
""",
    "step of some": """
batch = mw.Batch("bin2d", worlds=64, threads=1, seed=1)
begin = lambda: batch.step(NEVER, ids=[1, 40])

def check():
    assert batch.steps == 0  # they are of steps of all worlds
    batch.step(3)
    assert batch.steps == 3
""",
    "measure_contacts": """
batch = mw.Batch("ball2d", worlds=50_000, threads=1)
begin = lambda: [batch.measure_contacts() for _ in range(10_000)]
check = lambda: batch.step()
""",
    "Environment.step": """
env = mw.Environment("Acrobot", 2048, threads=1)
actions = np.zeros(2048, np.int64)

def begin():
    while True:
        env.step(actions)

def check():
    assert env.batch.steps % env.task.frame_skip == 0  # whole steps of the task
    env.step(actions)
""",
    "Environment.step, in its middle": """
task = mw.tasks.load("LunarLander")
task.frame_skip = NEVER
env = mw.Environment(task, 64, threads=1, seed=1)
actions = np.ones(64, np.int64)
env.rewards[:] = 7.5
begin = lambda: env.step(actions)

def check():
    done = env.batch.steps
    assert 0 < done < NEVER and env.steps_left == NEVER - done
    assert (env.rewards == 7.5).all()  # nothing was filled
    for call in (lambda: env.step(actions), env.save, lambda: env.copy_world(0, 1), lambda: env.reset([3])):
        try:
            call()
        except ValueError as error:
            assert f"after {done} of its {NEVER} physics steps" in str(error), error
        else:
            raise AssertionError("it was not refused")
    other = mw.Environment(task, 64, threads=1, seed=1)
    env.batch.step(3)  # the batch is usable
    env.reset(seeds=5), other.reset(seeds=5)
    try:
        env.finish_step()
    except ValueError as error:
        assert "no step was interrupted" in str(error)
    assert env.steps_left == 0 and (env.observations == other.observations).all()
    assert (env.batch.hashes() == other.batch.hashes()).all()
    env.save()
""",
    "Environment.finish_step": """
import time
task = mw.tasks.load("LunarLander")
actions = np.arange(64) % 4

def make(frame_skip):
    task.frame_skip = frame_skip
    return mw.Environment(task, 64, threads=1, seed=1)

trial = make(2000)
trial.step(actions)
before = time.perf_counter()
trial.step(actions)
pace = (time.perf_counter() - before) / 2000
long = make(int(1.5 / pace))  # s, a step
steps = 0

def begin():
    global steps
    while True:
        long.step(actions)
        steps += 1

def check():
    other = make(task.frame_skip)
    if long.steps_left > 0:
        assert long.finish_step()[0] is long.observations
        for _ in range(steps + 1):
            wanted = other.step(actions)
        for mine, its in zip((long.observations, long.rewards, long.terminated, long.truncated), wanted):
            assert mine.tobytes() == its.tobytes()
        assert (long.batch.hashes() == other.batch.hashes()).all()
    try:
        long.finish_step()
    except ValueError as error:
        assert "no step was interrupted" in str(error)
    else:
        raise AssertionError("there was none to finish")
""",
    "VectorEnv.step, in its middle": """
from manyworlds.gym import VectorEnv
task = mw.tasks.load("LunarLander")
task.frame_skip = NEVER
envs = VectorEnv(task, 64, threads=1)
envs.reset(seed=1)
begin = lambda: envs.step(envs.action_space.sample())

def check():
    assert envs.environment.steps_left > 0
    envs.reset(seed=1)
    assert envs.environment.steps_left == 0
""",
    "VectorEnv.step": """
from manyworlds.gym import VectorEnv
envs = VectorEnv("LunarLander", 2048, threads=1)
envs.reset(seed=1)

def begin():
    while True:
        envs.step(envs.action_space.sample())

check = lambda: envs.step(envs.action_space.sample())
""",
    "replay": """
import os, tempfile
from manyworlds import record
file = os.path.join(tempfile.mkdtemp(), "run.h5")
batch = mw.Batch("bin2d", worlds=32, threads=1)
recorder = record.Recorder(batch, file, every=100)
batch.step(100)
recorder.close()
recording = record.Recording(file)
begin = lambda: [recording.replay() for _ in range(100_000)]
check = lambda: recording.replay()
""",
}
CHILD = """
import sys
import numpy as np
import manyworlds as mw
NEVER = {never}
{case}
print("ready", flush=True)
try:
    begin()
except KeyboardInterrupt:
    check()
    print("ended and usable", flush=True)
"""


@pytest.mark.skipif(os.name != "posix", reason="signals")
@pytest.mark.parametrize("case", CASES)
def test_ctrl_c_ends(case):
    if case.startswith("VectorEnv"):
        pytest.importorskip("gymnasium")
    if case == "replay":
        pytest.importorskip("manyworlds._record")
    code = CHILD.format(never=NEVER, case=CASES[case])
    with subprocess.Popen([sys.executable, "-c", code], stdout=-1, stderr=-1, text=True) as child:
        try:
            first = child.stdout.readline()
            try:
                child.wait(0.3)  # in the middle of the call
            except subprocess.TimeoutExpired:
                child.send_signal(signal.SIGINT)
            out, errors = child.communicate(timeout=PATIENCE)
        finally:
            child.kill()
    assert first == "ready\n", errors
    assert out == "ended and usable\n", errors
    assert child.returncode == 0


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_what_a_signals_handler_raises_comes_out_of_the_call():
    class Enough(Exception):
        pass

    def ring(*_):
        raise Enough

    batch = mw.Batch("bin2d", worlds=64, threads=1)
    batch.add_force((1, 0), 1)
    before = signal.signal(signal.SIGALRM, ring)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with pytest.raises(Enough):
            batch.step(NEVER)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    done = batch.steps
    assert 0 < done < NEVER
    other = mw.Batch("bin2d", worlds=64, threads=1)
    other.add_force((1, 0), 1)
    other.step(done)  # the force acted in all of them, and is gone in both
    batch.step(2), other.step(2)
    assert batch.hash() == other.hash()
