"""What arguments may be."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any, Union

from ._core import Design

#: A design, a spec as a dictionary, or the path of a spec's file.
Spec = Union[Design, "dict[str, Any]", str, "os.PathLike[str]"]
#: Dot paths with their values, or texts "path=values".
Varied = Union[Mapping[str, Union[str, Iterable[Any]]], Iterable[str], str]
