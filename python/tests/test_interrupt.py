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
