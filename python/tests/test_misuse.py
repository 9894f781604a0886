"""Wrong calls: each raises an error that says what was found and what was expected."""

import os
import subprocess
import sys

import numpy as np
import pytest

import manyworlds as mw
from conftest import crates, lander

READ_ONLY = np.zeros((5, 5, 2), np.float32)
READ_ONLY.flags.writeable = False
SPATIAL = crates().compile()

# What is called on a batch of 5 lunar landers (5 state bodies, 2 joints), the error, its words.
WRONG = [
    # step
    (lambda b: b.step(-1), ValueError, "n is -1, must be 0 to 2147483647"),
    (lambda b: b.step(1.5), TypeError, "n is of type float; expected an integer"),
    (lambda b: b.step(2**31), ValueError, "n is 2147483648"),
    (lambda b: b.step(True), TypeError, "n is a bool"),
    (
        lambda b: b.step(1, controls=[1, 2]),
        ValueError,
        r"controls has shape \(2,\); expected \(worlds=5",
    ),
    # get
    (lambda b: b.get("positon"), ValueError, "the field is 'positon'.*nearest: 'position'"),
    (lambda b: b.get(3), TypeError, "the field is of type int"),
    (lambda b: b.get("kinetic_energy"), ValueError, "observe=.'motion'"),
    (lambda b: b.get("ray_body"), ValueError, "rays="),
    (lambda b: b.get("position", out=[1]), TypeError, "out is of type list; expected a numpy"),
    (lambda b: b.get("position", out=np.zeros((5, 5, 2))), TypeError, "float64; expected float32"),
    (
        lambda b: b.get("position", out=np.zeros((5, 2), "f4")),
        ValueError,
        r"out has shape \(5, 2\); expected \(worlds=5, bodies=5, components=2\)",
    ),
    (
        lambda b: b.get("position", out=np.zeros((2, 5, 5), "f4").T),
        ValueError,
        "not C-contiguous",
    ),
    (lambda b: b.get("position", out=READ_ONLY), ValueError, "read-only"),
    (lambda b: b.get("position", out=np.zeros((5, 5, 2), ">f4")), TypeError, "expected float32"),
    # set
    (lambda b: b.set("position", np.zeros((5, 5, 3))), ValueError, r"\(5, 5, 3\); expected"),
    (lambda b: b.set("position", [1, 2, 3]), ValueError, r"shape \(3,\); expected"),
    (lambda b: b.set("position", "abc"), TypeError, "expected real numbers"),
    (lambda b: b.set("position", [[1], [1, 2]]), ValueError, "position is not an array"),
    (lambda b: b.set("position", np.zeros((5, 5, 2), complex)), TypeError, "complex128"),
    (lambda b: b.set("position", np.full((5, 5, 2), None)), TypeError, "dtype object"),
    (lambda b: b.set("penetration", np.zeros((5, 1, 1))), ValueError, "not observed"),
    (lambda b: b.set("friction", np.zeros((5, 6, 1))), ValueError, "friction"),
    (
        lambda b: b.set("position", np.zeros((1, 5, 2)), ids=5),
        IndexError,
        "ids hold 5, must be 0 to 4",
    ),
    (lambda b: b.set("position", np.zeros((1, 5, 2)), ids=-1), IndexError, "ids hold -1"),
    (lambda b: b.set("position", np.zeros((1, 5, 2)), ids=1.0), TypeError, "expected integers"),
    (lambda b: b.set("position", np.zeros((1, 5, 2)), ids="a"), TypeError, "expected integers"),
    (lambda b: b.set("position", np.zeros((1, 5, 2)), ids=[[0]]), IndexError, "expected one axis"),
    (
        lambda b: b.set("position", np.zeros((3, 5, 2)), ids=[0, 1]),
        ValueError,
        r"\(ids=2, bodies=5",
    ),
    (
        lambda b: b.set("position", np.zeros((2, 5, 2)), ids=[True, True]),
        IndexError,
        r"the mask of ids has shape \(2,\); expected \(5,\)",
    ),
    # views
    (lambda b: b.view("friction"), ValueError, "not a state field"),
    (lambda b: b.view("x"), ValueError, "the field is 'x'"),
    (lambda b: b.view("position")[9], IndexError, "out of bounds"),
    # inputs
    (lambda b: b.set_controls(np.zeros((5, 99))), ValueError, r"controls has shape \(5, 99\)"),
    (lambda b: b.set_controls(None), TypeError, "expected real numbers"),
    (
        lambda b: b.add_force((1, 2, 3)),
        ValueError,
        r"\(worlds=5, bodies=5, components=2\), or a shape that",
    ),
    (lambda b: b.add_force((1, 2), bodies=6), IndexError, "bodies hold 6, must be 0 to 5"),
    (lambda b: b.add_force((1, 2), ids=[0, 7]), IndexError, "ids hold 7"),
    (lambda b: b.add_force((1, 2), points=(1, 2, 3)), ValueError, "points has shape"),
    (lambda b: b.add_torque((1, 2)), ValueError, "torque has shape"),
    (lambda b: b.set_enabled(1), TypeError, "expected bools"),
    (lambda b: b.set_joints_enabled(True, joints=2), IndexError, "joints hold 2, must be 0 to 1"),
    (lambda b: b.spawn(6, (0, 0)), IndexError, "body is 6, must be 0 to 5"),
    (lambda b: b.spawn(1, (0, 0, 0)), ValueError, "position has shape"),
    (lambda b: b.spawn(1, (0, 0), orientation=(0, 0)), ValueError, "length 0"),
    (lambda b: b.wake(ids=9), IndexError, "ids hold 9"),
    (lambda b: b.set_rays([mw.Ray()]), ValueError, "ray"),
    # results
    (lambda b: b.hash(5), IndexError, "world is 5, must be 0 to 4"),
    (lambda b: b.contacts(-1), IndexError, "world is -1"),
    (lambda b: b.contacts([0, 1]), TypeError, "world is of type list; expected an integer"),
    (lambda b: b.step_contacts(0), ValueError, "observe=.'contacts'"),
    (lambda b: b.look(), ValueError, "nothing is observed"),
    (lambda b: b.status(out=np.zeros(5, np.int32)), TypeError, "int32; expected uint32"),
    (lambda b: b.energy(out=np.zeros(5)), ValueError, r"expected \(worlds=5, 2\)"),
    (lambda b: b.copy_world(0, 5), IndexError, "world is 5, must be 0 to 4"),
    (lambda b: b.reset(7), IndexError, "ids hold 7"),
    (lambda b: b.reset([True]), IndexError, "the mask of ids"),
    # snapshots
    (lambda b: b.restore(b"abc"), TypeError, "expected a manyworlds.Snapshot"),
    (lambda b: b.restore(b.save([0])), mw.SnapshotError, "1 world"),
    (lambda b: b.restore(mw.Batch(SPATIAL, 5).save()), mw.SnapshotError, None),
    (lambda b: b.restore(lander(precision="f64").save()), mw.SnapshotError, None),
    (lambda b: b.restore(b.save(), source=9, ids=0), IndexError, "source hold 9"),
    (
        lambda b: b.restore(b.save(), source=[0, 1], ids=[0, 1, 2]),
        ValueError,
        "source has 2 worlds",
    ),
    (lambda b: mw.Snapshot.from_bytes(b"abc"), mw.SnapshotError, None),
    (lambda b: mw.Snapshot.from_bytes(b.save().bytes()[:-1]), mw.SnapshotError, None),
    (lambda b: mw.Snapshot.load("no/such/file"), mw.SnapshotError, "no/such/file"),
    (lambda b: mw.Snapshot(), TypeError, None),
    # rollouts
    (lambda b: b.rollout(), ValueError, "needs controls .* or steps"),
    (lambda b: b.rollout(steps=-1), ValueError, "steps is -1"),
    (lambda b: b.rollout(steps=3, every=0), ValueError, "every is 0"),
    (lambda b: b.rollout(steps=3, fields="position"), TypeError, r"such as \['position'\]"),
    (lambda b: b.rollout(steps=3, fields=["pos"]), ValueError, "the field is 'pos'"),
    (lambda b: b.rollout(steps=3, fields=["mass", "mass"]), ValueError, "more than once"),
    (lambda b: b.rollout(controls=np.zeros((5, 2))), ValueError, r"expected \(steps, worlds=5"),
    (lambda b: b.rollout(controls=np.zeros((3, 4, 2))), ValueError, "steps=3, worlds=5"),
    (lambda b: b.rollout(controls=np.zeros((3, 5, 2)), steps=4), ValueError, "give one of them"),
    (lambda b: b.rollout(steps=3, out={"mass": 1}), ValueError, "'mass'"),
    (lambda b: b.rollout(steps=3, out=[]), TypeError, "expected a dict"),
    (lambda b: b.rollout(steps=3, out={"position": np.zeros(3, "f4")}), ValueError, "frames=3"),
    (lambda b: b.rollout(7, steps=3), TypeError, "expected a Snapshot or a dict"),
    (lambda b: b.rollout({"position": [1, 2, 3]}, steps=3), ValueError, "position has shape"),
]


@pytest.mark.parametrize("index", range(len(WRONG)))
def test_a_wrong_call_says_what_is_wrong(index):
    call, error, match = WRONG[index]
    batch = lander()
    before = batch.hash()
    with pytest.raises(error, match=match):
        call(batch)
    assert batch.hash() == before and batch.steps == 0


@pytest.mark.parametrize(
    "arguments, error, match",
    [
        ({"worlds": 0}, ValueError, "worlds is 0, must be 1 to 100000000"),
        ({"worlds": 2**31}, ValueError, "worlds is 2147483648"),
        (
            {"worlds": 10**8},
            ValueError,
            r"worlds: 100000000 worlds of '.*' need \d+\.\d GB of memory, the machine has",
        ),
        ({"worlds": "5"}, TypeError, "worlds is of type str"),
        ({"threads": 0}, ValueError, "threads is 0, must be 1"),
        ({"threads": 10**6}, ValueError, "must be 1 to 1024"),
        ({"seed": -1}, ValueError, "seed is -1"),
        ({"seed": 2**64}, ValueError, "seed is"),
        ({"precision": "f16"}, ValueError, "precision is 'f16'; expected one of 'f32', 'f64'"),
        ({"precision": np.float32}, TypeError, "expected a str"),
        ({"isa": "avx"}, ValueError, "isa is 'avx'.*nearest: 'avx2'"),
        ({"layout": "row"}, ValueError, "nearest: 'rows'"),
        ({"sleep": 1}, TypeError, "expected a bool"),
        ({"observe": ["motions"]}, ValueError, r"observe\[0\] is 'motions'.*nearest: 'motion'"),
        ({"observe": "motion"}, TypeError, "observe is of type str; expected a list"),
        ({"rays": [1]}, TypeError, r"rays\[0\] is of type int; expected manyworlds.Ray"),
        ({"rays": [mw.Ray(direction=(0, 0, 0))]}, ValueError, "direction"),
        ({"contacts_per_world": -1}, ValueError, "contacts_per_world is -1"),
        ({"scene": "lunar"}, ValueError, "there is no scene 'lunar'"),
        ({"scene": 3}, TypeError, "expected a Scene, a Plan or a name"),
        ({"wrlds": 3}, TypeError, "wrlds"),
    ],
)
def test_a_batch_is_refused_with_a_reason(arguments, error, match):
    with pytest.raises(error, match=match):
        mw.Batch(**{"scene": "stack10", **arguments})


THREADS = """
import resource
import manyworlds as mw

with open("/proc/self/statm") as file:
    used = int(file.read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used + (1 << 30), -1))
try:
    mw.Batch("ball3d", 64, threads=600)
except RuntimeError as error:
    print(error)
batch = mw.Batch("ball3d", 64, threads=2)
batch.step(3)
print(batch.steps)
"""


@pytest.mark.skipif("libasan" in os.environ.get("LD_PRELOAD", ""), reason="its address space")
def test_threads_that_cannot_be_started_are_an_error():
    done = subprocess.run([sys.executable, "-c", THREADS], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    said, steps = done.stdout.splitlines()
    assert said.startswith("threads: 600 cannot be started, this process may have ")
    assert steps == "3"
