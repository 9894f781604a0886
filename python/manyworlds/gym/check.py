"""Whether a vector environment keeps to Gymnasium's contract.

Gymnasium has a checker for single environments only. This one looks at spaces, seeds, dtypes, shapes
and infos; and it steps a slow reference beside, single environments in Gymnasium's own
SyncVectorEnv, whose observations, rewards, ends and infos must be the same bits in every step.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Optional

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from gymnasium.vector.utils import batch_space

from .single_env import Env
from .vector_env import VectorEnv

Maker = Callable[[], gymnasium.Env[Any, Any]]


class ContractError(AssertionError):
    """The environment does not keep to the contract."""


def _demand(condition: Any, text: str) -> None:
    if not condition:
        raise ContractError(text)


def check_vector_env(
    env: gymnasium.vector.VectorEnv[Any, Any, Any],
    steps: int = 100,
    seed: int = 0,
    reference: Optional[Maker] = None,
) -> int:
    """Steps ``env`` with random actions and raises ContractError where it does not keep to the
    contract. ``reference`` makes one single environment; those of ``manyworlds.gym`` need none.

    Leaves the environment open, somewhere. Returns how many episodes have ended.
    """
    _check_spaces(env)
    if reference is None and isinstance(env.unwrapped, VectorEnv):
        reference = _own_reference(env.unwrapped)
    _check_seeds(env, seed)
    return _check_steps(env, steps, seed, reference)


def _own_reference(env: VectorEnv) -> Maker:
    batch = env.environment.batch
    terms = env.environment.reward_terms is not None
    return lambda: Env(
        env.task,
        precision=batch.precision,  # type: ignore[arg-type]
        isa=batch.isa,  # type: ignore[arg-type]
        reward_terms=terms,
    )


def _check_spaces(env: gymnasium.vector.VectorEnv[Any, Any, Any]) -> None:
    _demand(isinstance(env, gymnasium.vector.VectorEnv), "is not a gymnasium.vector.VectorEnv")
    _demand(isinstance(env.num_envs, int) and env.num_envs > 0, "num_envs is not a positive int")
    mode = env.metadata.get("autoreset_mode")
    _demand(isinstance(mode, AutoresetMode), "metadata['autoreset_mode'] is not an AutoresetMode")
    for name in ("observation", "action"):
        single, batched = getattr(env, f"single_{name}_space"), getattr(env, f"{name}_space")
        wanted = batch_space(single, env.num_envs)
        _demand(batched == wanted, f"{name}_space is {batched}, expected {wanted}")


def _check_seeds(env: gymnasium.vector.VectorEnv[Any, Any, Any], seed: int) -> None:
    def start(seeds: Any) -> Any:
        observations, infos = env.reset(seed=seeds)
        _check_observations(env, observations)
        _check_infos(infos, env.num_envs)
        return np.array(observations)

    first = start(seed)
    _demand(_same(first, start(seed)), "the same seed gives different observations")
    each = [seed + i for i in range(env.num_envs)]
    _demand(
        _same(first, start(each)), "seed s gives world i different observations than the seed s + i"
    )
    start([None] * env.num_envs)
    start(None)
    if env.num_envs > 1:
        shifted = start(seed + 1)
        _demand(_same(first[1:], shifted[:-1]), "world i depends on more than its seed s + i")


def _check_steps(
    env: gymnasium.vector.VectorEnv[Any, Any, Any], steps: int, seed: int, maker: Optional[Maker]
) -> int:
    mode = env.metadata["autoreset_mode"]
    slow = None
    if maker is not None:
        slow = SyncVectorEnv([maker] * env.num_envs, autoreset_mode=mode)
    env.action_space.seed(seed)
    found, _ = env.reset(seed=seed)
    if slow is not None:
        _compare("observations", found, slow.reset(seed=seed)[0])
    kept = found
    before = np.array(found)
    episodes = 0
    for _ in range(steps):
        actions = env.action_space.sample()
        results = env.step(actions)
        if getattr(env.unwrapped, "copy", False):
            _demand(_same(kept, before), "a step changes the observations of the step before")
        observations, rewards, terminated, truncated, infos = results
        _check_results(env, results)
        _check_infos(infos, env.num_envs)
        ended = np.logical_or(terminated, truncated)
        episodes += int(ended.sum())
        _check_final(mode, ended, infos)
        if slow is not None:
            wanted = slow.step(actions)
            names = ("observations", "rewards", "terminated", "truncated", "infos")
            for name, a, b in zip(names, results, wanted):
                _compare(name, a, b)
        kept, before = observations, np.array(observations)
        if mode == AutoresetMode.DISABLED and ended.any():
            mask = ended.copy()  # `ended` may be asked for once more
            kept, _ = env.reset(options={"reset_mask": mask.copy()})
            stay = ~mask
            _demand(_same(kept[stay], before[stay]), "reset_mask changes worlds that are not in it")
            if slow is not None:
                _compare("observations", kept, slow.reset(options={"reset_mask": mask})[0])
            before = np.array(kept)
    if slow is not None:
        slow.close()
    return episodes


def _check_observations(env: gymnasium.vector.VectorEnv[Any, Any, Any], found: Any) -> None:
    space = env.observation_space
    _demand(isinstance(found, np.ndarray), "observations are not a NumPy array")
    _demand(found.shape == space.shape, f"observations have shape {found.shape}, not {space.shape}")
    _demand(found.dtype == space.dtype, f"observations are {found.dtype}, not {space.dtype}")


def _check_results(env: gymnasium.vector.VectorEnv[Any, Any, Any], results: Any) -> None:
    observations, rewards, terminated, truncated, _ = results
    _check_observations(env, observations)
    for name, array, dtype in (
        ("rewards", rewards, np.float64),
        ("terminated", terminated, np.bool_),
        ("truncated", truncated, np.bool_),
    ):
        _demand(isinstance(array, np.ndarray), f"{name} are not a NumPy array")
        _demand(array.shape == (env.num_envs,), f"{name} have shape {array.shape}")
        _demand(array.dtype == dtype, f"{name} are {array.dtype}, not {np.dtype(dtype)}")


def _check_infos(infos: Any, num_envs: int, path: str = "infos") -> None:
    """Every key has a mask, and every mask has a key."""
    _demand(isinstance(infos, dict), f"{path} is not a dict")
    for key, value in infos.items():
        if key.startswith("_") and key[1:] in infos:
            _demand(
                isinstance(value, np.ndarray)
                and value.dtype == np.bool_
                and value.shape == (num_envs,),
                f"{path}['{key}'] is not a mask of {num_envs} bools",
            )
            continue
        _demand("_" + key in infos, f"{path}['{key}'] has no mask '_{key}'")
        if isinstance(value, dict):
            _check_infos(value, num_envs, f"{path}['{key}']")
        else:
            _demand(len(value) == num_envs, f"{path}['{key}'] is not one for each world")


def _check_final(mode: AutoresetMode, ended: np.ndarray, infos: dict[str, Any]) -> None:
    if mode != AutoresetMode.SAME_STEP or not ended.any():
        _demand("final_obs" not in infos, "final_obs is present although no world was reset")
        return
    for key in ("final_obs", "final_info"):
        _demand(key in infos, f"infos have no {key} where episodes end")
        _demand(_same(infos["_" + key], ended), f"_{key} does not mark the episodes that ended")


def _same(a: Any, b: Any) -> bool:
    a, b = np.asarray(a), np.asarray(b)
    return a.shape == b.shape and a.dtype == b.dtype and a.tobytes() == b.tobytes()


def _compare(path: str, found: Any, wanted: Any) -> None:
    """Bitwise comparison. Recursive for dicts and arrays of objects."""
    if isinstance(wanted, Mapping):
        _demand(isinstance(found, Mapping), f"{path} is not a dict")
        keys = set(found) ^ set(wanted)
        _demand(not keys, f"{path}: {sorted(keys)} are not in both it and the reference")
        for key in wanted:
            _compare(f"{path}['{key}']", found[key], wanted[key])
    elif isinstance(wanted, np.ndarray) and wanted.dtype == object:
        _demand(len(found) == len(wanted), f"{path} has {len(found)} entries")
        for i, (a, b) in enumerate(zip(found, wanted)):
            if b is None:
                _demand(a is None, f"{path}[{i}] is not None")
            else:
                _compare(f"{path}[{i}]", a, b)
    else:
        text = f"{path} differ from the reference:\n{found}\n{wanted}"
        _demand(_same(found, wanted), text)
