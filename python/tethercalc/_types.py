"""What arguments may be."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any, Union

from ._core import Design

Path = Union[str, "os.PathLike[str]"]
Paths = Union[Path, Iterable[Path]]
Texts = Union[str, Iterable[str]]
#: A design, a spec as a dictionary, or the path of a spec's file.
Spec = Union[Design, "dict[str, Any]", Path]
#: Dot paths with their values, or texts "path=values".
Varied = Union[Mapping[str, Union[str, Iterable[Any]]], Iterable[str], str]
#: A cross-section in mm², or a standard size such as "AWG18".
Area = Union[float, str, None]
Areas = Union[Area, Iterable[Union[float, str]]]
