"""The examples of examples/python, in short form."""

import importlib.util

import numpy as np
import pytest

from test_tasks import example


def test_a_composed_pole_is_balanced():
    assert example("compose").main().mean() > 400


def test_design_search_improves():
    pytest.importorskip("cma")
    history = example("design_search").main(["--candidates", "256", "--generations", "4"])
    assert history[-1][0] > history[0][0]


def test_planning_swings_a_pole_up_and_keeps_it_up():
    seen = example("mppi").main(["--branches", "128", "--seconds", "3"])
    assert len(seen) == 150
    upright = seen[:, 2]
    assert upright[0] < -0.9 and upright[-25:].min() > 0.95


def test_planning_raises_a_humanoid():
    seen = example("mppi").main("--task humanoid --branches 64 --seconds 0.8 --horizon 0.4".split())
    height, upright = seen.T
    assert height[0] < 0.15 and upright[0] < 0.2
    assert height[-1] > height[5] + 0.1 and upright[-1] > 0.7


def test_a_gait_is_found():
    pytest.importorskip("cma")
    pytest.importorskip("gymnasium")
    if importlib.util.find_spec("manyworlds._mjcf") is None:
        pytest.skip("built without MuJoCo")
    short = "--candidates 128 --generations 10 --seconds 1.5"
    history, far = example("gait_search").main(short.split())
    assert history[-1] > history[0] + 0.3  # m: from about -0.3 to 0.4
    assert np.median(far) > 0.5  # 1.3


def test_friction_and_damping_are_found_in_a_recording():
    pytest.importorskip("cma")
    if importlib.util.find_spec("manyworlds._record") is None:
        pytest.skip("built without HDF5")
    short = "--candidates 128 --generations 30 --seconds 1"
    numbers = example("identification").main(short.split())
    assert len(numbers) == 7
    for name, (hidden, found) in numbers.items():
        assert found == pytest.approx(hidden, rel=0.02), name


def statics(bridge, thick):
    """Forces in the bars of the bridge, N, by the equilibrium of its nodes: no dynamics."""
    nodes, bars = bridge.nodes(), np.array(bridge.bars())
    along = nodes[bars[:, 1]] - nodes[bars[:, 0]]
    length = np.hypot(*along.T)
    disc = np.pi * bridge.NODE**2 * bridge.DEPTH * bridge.IRON
    down = np.full(len(nodes), disc)
    down[1 : bridge.PANELS] += bridge.CRATE
    weights = thick * length * bridge.DEPTH * bridge.DENSITY / 2
    np.add.at(down, bars, np.stack([weights, weights], axis=1))
    at = np.zeros((len(nodes), 2, len(bars) + 3))
    for i, (a, b) in enumerate(bars):
        at[a, :, i], at[b, :, i] = along[i] / length[i], -along[i] / length[i]
    at[0, 0, -3] = at[0, 1, -2] = at[bridge.PANELS, 1, -1] = 1  # pin and roller
    load = np.stack([0 * down, down * bridge.GRAVITY], axis=1)
    forces = np.linalg.solve(at.reshape(2 * len(nodes), -1), load.reshape(-1))
    return forces[: len(bars)], length


def test_a_bridge_bears_its_load_with_little_mass():
    pytest.importorskip("cma")
    bridge = example("bridge")
    best = bridge.main("--candidates 128 --generations 30 --threads 1".split()).best

    def needed(thick):
        force, length = statics(bridge, thick)
        area = np.abs(force) / bridge.STRENGTH / bridge.DEPTH
        push = np.maximum(-force, 0)
        slender = 12 * push * length**2 / (np.pi**2 * bridge.STIFFNESS * bridge.DEPTH)
        return np.maximum(0.003, np.maximum(area, np.cbrt(slender)))

    found = np.array([best.values[g] for g in bridge.groups()])
    assert (found > 0.97 * needed(found)).all()
    thick = found
    for _ in range(30):  # every bar as thick as it has to be, its own weight considered
        thick = needed(thick)
    least = (thick * statics(bridge, thick)[1]).sum() * bridge.DEPTH * bridge.DENSITY
    assert 0.97 * least < best.value < 1.1 * least


def test_a_launcher_hits_its_mark(tmp_path):
    """There is another way, which takes 691 kg and lets go on the way up."""
    pytest.importorskip("cma")
    short = "--candidates 300 --generations 10 --threads 1".split()
    if importlib.util.find_spec("pyarrow") is not None:
        short += ["--table", str(tmp_path / "all.parquet")]
    best = example("launcher").main(short).best
    assert best.violation == 0
    assert best.value == best.values["counterweight"] == pytest.approx(391, rel=0.02)
    assert len(list(tmp_path.iterdir())) == len(short) // 7


def test_a_walker_gets_on():
    pytest.importorskip("cma")
    short = "--candidates 128 --generations 6 --seconds 1.5 --threads 1"
    found = example("walker").main(short.split())
    medians = [np.median(g.value[g.status == 0]) for g in found.generations]
    assert medians[-1] > medians[0] + 0.1 and found.best.value > 0.8


def test_limbs_are_as_long_as_their_worlds_want_them():
    """Standing, with the weight on them: off by what their springs give, some millimetres."""
    walker, search = example("walker"), pytest.importorskip("manyworlds.search")
    space, seen = walker.make_space(), []

    def drive(run):
        run.batch.step(200)
        return {}

    def lengths(run):
        seen.append(run.batch.get("generalized_position")[:, [4, 6, 8, 10], 0] + walker.LENGTH)
        return np.zeros(run.batch.worlds)

    with search.Trial(walker.make_scene(), space, lengths, begin=walker.stand, drive=drive) as t:
        wanted = np.array([[0.25, 0.5, 0.35, 0.4], [0.4, 0.4, 0.4, 0.4], [0.3, 0.3, 0.25, 0.35]])
        rest = np.tile(space.values([[0.5] * len(space)])[0, 4:], (3, 1))
        assert not t.evaluate(np.concatenate([wanted, rest], axis=1), 0).lost.any()
    assert np.abs(seen[-1] - wanted).max() < 0.01


def test_every_task_has_a_picture(tmp_path):
    pytest.importorskip("matplotlib")
    example("gallery").main(["--steps", "2", "--out", str(tmp_path / "tasks.png")])
    assert (tmp_path / "tasks.png").read_bytes()[1:4] == b"PNG"


def test_throughput_is_printed():
    pytest.importorskip("gymnasium")
    found = example("throughput").main(["--worlds", "64", "--seconds", "0.1"])
    assert len(found) == 3 and min(found.values()) > 1000


OWN_TASK = """
import manyworlds as mw

def make():
    task = mw.tasks.load("CartPole")
    task.name, task.max_steps = "Mine", 60
    return task

def endless():
    task = make()
    task.max_steps = 0
    return task

number = 7
"""


def test_ppo_trains_a_task_of_a_module(tmp_path, monkeypatch, capsys):
    pytest.importorskip("jax")
    pytest.importorskip("optax")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "own_task.py").write_text(OWN_TASK)
    ppo, tiny = example("ppo"), "--envs 8 --steps 16 --updates 2 --minibatch 32 --epochs 1".split()
    result = ppo.main(["--task", "own_task:make", *tiny])
    assert result["task"] == "own_task:make" and len(result["curve"]) == 2
    assert result["curve"][-1]["steps"] > 200 and 0 < result["evaluation"] <= 60
    for name, message in (
        ("own_task:endless", "has no time limit: its max_steps is 0"),
        ("own_task:made", "the module 'own_task' has no function 'made'"),
        ("own_task:number", "the module 'own_task' has no function 'number'"),
        ("own_task:print", "the module 'own_task' has no function 'print'"),
        ("own_tusk:make", "there is no module 'own_tusk'"),
        ("builtins:dict", "it returns a dict; expected a manyworlds.Task"),
    ):
        with pytest.raises(SystemExit):
            ppo.main(["--task", name, *tiny])
        assert message in capsys.readouterr().err
    with pytest.raises(SystemExit):
        ppo.main(["--help"])
    assert "module:function" in capsys.readouterr().out


def test_ppo_learns_to_balance():
    pytest.importorskip("gymnasium")
    pytest.importorskip("jax")
    pytest.importorskip("optax")
    short = "--task CartPole --envs 64 --steps 32 --updates 25 --seconds 900 --goal 150"
    result = example("ppo").main(short.split())
    assert result["curve"][0]["return"] < 40
    assert result["curve"][-1]["return"] > 60
    assert result["evaluation"] > 300
