"""The tasks as vector environments of Gymnasium. Importing this registers them:

    import gymnasium
    import manyworlds.gym
    envs = gymnasium.make_vec("manyworlds/LunarLander-v0", num_envs=4096)

docs/rl.md explains the rest by example.
"""

from .check import check_vector_env
from .registration import ids, register
from .single_env import Env
from .vector_env import VectorEnv

__all__ = ["Env", "VectorEnv", "check_vector_env", "ids", "register"]

register()
