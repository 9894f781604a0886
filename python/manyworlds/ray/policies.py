"""Policies as functions of arrays of NumPy, JAX or torch."""

from __future__ import annotations

import sys
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from ..environment import Environment
from .work import Policy


def actions_of(policy: Optional[Policy], environment: Environment) -> NDArray[Any]:
    """Actions of a policy in an environment's worlds. Without a policy: zeros, or choice 0.

    A torch.nn.Module is called with a tensor, without gradients. Other policies are called with the array
    of observations. The result is converted to a NumPy array.
    """
    if policy is None:
        kind = np.int64 if environment.discrete else np.float32
        return np.zeros(environment.action_shape, kind)
    torch = sys.modules.get("torch")
    if torch is not None and isinstance(policy, torch.nn.Module):
        with torch.inference_mode():
            found = policy(torch.from_numpy(environment.observations)).cpu().numpy()
    else:
        found = policy(environment.observations)
    actions: NDArray[Any] = np.asarray(found)
    return actions
