"""Tasks as vector environments of Gymnasium. Importing this module registers them:

    import gymnasium
    import manyworlds.gym
    envs = gymnasium.make_vec("manyworlds/LunarLander-v0", num_envs=4096)
    envs = gymnasium.make_vec("manyworlds/Ant-v5", num_envs=4096)  # MuJoCo tasks: see ``mujoco``

Requires Gymnasium: ``pip install "manyworlds-sim[gym]"``. Its MuJoCo tasks require ``[gym,mjcf]``.
docs/rl.md has examples.
"""

from .._distribution import needs

with needs("gymnasium", extra="gym", what="manyworlds.gym"):
    from . import mujoco
    from .check import check_vector_env
    from .registration import ids, register
    from .single_env import Env
    from .vector_env import VectorEnv

__all__ = ["Env", "VectorEnv", "check_vector_env", "ids", "mujoco", "register"]

register()
