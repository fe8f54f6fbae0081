"""Types of arrays and numbers in annotations."""
from __future__ import annotations

from typing import Any, Sequence, Union

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Records = npt.NDArray[np.void]
"""A structured array, such as of PAIR_DTYPE."""
Pixels = npt.NDArray[Any]
"""A picture of uint8, uint16, float32 or float16, or a mask of uint8 or bool."""
Values = Union[npt.NDArray[Any], Sequence[Any]]
"""Numbers of any shape."""
Numbers = Union[float, Values]
