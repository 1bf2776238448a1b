"""Answers as notebooks show them."""

from __future__ import annotations

from difflib import get_close_matches
from html import escape
from typing import Any


def html(text: str, svgs: list[str]) -> str:
    """The text as it is, then each picture."""
    pictures = "".join(f'<div style="max-width: 170mm">{svg}</div>' for svg in svgs)
    return f"<pre>{escape(text)}</pre>{pictures}"


class Record(dict[str, Any]):
    """An object of an answer: its members are attributes as well as keys."""

    def __getattr__(self, name: str) -> Any:
        return member(self, name)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self]


def _view(value: Any) -> Any:
    if isinstance(value, dict):
        return Record(value)
    if isinstance(value, list):
        return [_view(one) for one in value]
    return value


def member(members: dict[str, Any], name: str) -> Any:
    """A member as an attribute; AttributeError with the names that there are."""
    if name in members:
        return _view(members[name])
    close = get_close_matches(name, members, 1)
    hint = f"; did you mean {close[0]!r}?" if close else ""
    raise AttributeError(f"no {name!r} here{hint}")
