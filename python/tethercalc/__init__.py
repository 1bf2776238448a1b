"""Design calculator for drones powered through a tether.

    >>> import tethercalc
    >>> design = tethercalc.load("examples/holybro-x500.json")
    >>> design["supply.voltage_V"] = 60
    >>> optimum = tethercalc.optimize(design)
    >>> optimum.cross_section_mm2

Wherever a design is asked for, a Design, a spec as a dictionary, or the path of a spec's file will
do. Fields and numbers bear their units in their names, as in specs and in the program's JSON.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from ._core import (
    Design,
    Figure,
    OperatingPoint,
    Optimum,
    Sweep,
    fields,
    load,
    optimize,
)
from ._core import _sweep, version as __version__
from ._errors import InputError, Problem
from ._types import Spec, Varied

__all__ = [
    "Design",
    "Figure",
    "InputError",
    "OperatingPoint",
    "Optimum",
    "Problem",
    "Sweep",
    "fields",
    "load",
    "optimize",
    "sweep",
]


def _word(value: object) -> str:
    """A value as the grammar PATH=VALUES writes it."""
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(float(value))  # type: ignore[arg-type]


def _varied(vary: Varied) -> list[str]:
    """Axes as the grammar PATH=VALUES writes them."""
    if isinstance(vary, str):
        return [vary]
    if not isinstance(vary, Mapping):
        return list(vary)
    texts = []
    for path, values in vary.items():
        words = values if isinstance(values, str) else ",".join(_word(value) for value in values)
        texts.append(f"{path}={words}")
    return texts


def sweep(
    spec: Spec,
    vary: Varied,
    *,
    sample: int | None = None,
    method: str = "sobol",
    seed: int = 0,
    jobs: int = 0,
) -> Sweep:
    """Computes many designs on all cores, or on `jobs` of them.

    `vary` maps dot paths to lists of values or to texts such as "40:100:5", "10..60" and "75~1.5",
    or lists "path=values" as --vary takes them. Every combination is computed or, with `sample`, as
    many draws by `method`: "sobol" or "lhs". Ctrl-C ends it.
    """
    return _sweep(spec, _varied(vary), sample, method, seed, jobs)
