"""Bad input, with everything that is wrong with it."""

from __future__ import annotations

import re
from dataclasses import dataclass

_PLACE = re.compile(r"(?P<file>.*?)(?::(?P<line>\d+))?(?: (?P<pointer>/\S*))?", re.DOTALL)

_OPTION = re.compile(r"(?<![^\s(\"])--([a-z][\w-]*)")
#: Options whose arguments have another name.
_ARGUMENTS = {
    "air-density": "air_density_kg_m3",
    "battery": "batteries",
    "from": "start",
    "to": "end",
}


@dataclass(frozen=True)
class Problem:
    """One thing wrong with an input."""

    where: str  #: where it stands, in words: "spec.json:3 /drone/mass_g", or an argument
    message: str  #: what was found, what is allowed, and the closest known name
    file: str | None = None  #: the file, or "spec" for a dictionary
    line: int | None = None  #: counted from 1
    pointer: str | None = None  #: JSON pointer within the file: "/drone/mass_g"

    def __str__(self) -> str:
        return f"{self.where}: {self.message}"


def in_arguments(text: str) -> str:
    """A sentence of the command, whose options are arguments here."""
    return _OPTION.sub(lambda o: _ARGUMENTS.get(o[1], o[1].replace("-", "_")), text)


def _problem(where: str, message: str) -> Problem:
    message = in_arguments(message)
    if where.startswith("--"):
        return Problem(in_arguments(where), message)
    place = _PLACE.fullmatch(where)
    if place is None or not (place["line"] or place["pointer"]):
        return Problem(where, message)
    line = int(place["line"]) if place["line"] else None
    return Problem(where, message, place["file"], line, place["pointer"])


class InputError(ValueError):
    """Bad input. `problems` lists all that is wrong with it, in the order of the input."""

    def __init__(self, problems: list[Problem]) -> None:
        super().__init__("\n".join(str(problem) for problem in problems))
        self.problems = problems

    @classmethod
    def _from_problems(cls, problems: list[tuple[str, str]]) -> InputError:
        return cls([_problem(where, message) for where, message in problems])

    def __reduce__(self) -> tuple[type[InputError], tuple[list[Problem]]]:
        return type(self), (self.problems,)
