"""Answers as notebooks show them."""

from __future__ import annotations

from html import escape


def html(text: str, svgs: list[str]) -> str:
    """The text as it is, then each picture."""
    pictures = "".join(f'<div style="max-width: 170mm">{svg}</div>' for svg in svgs)
    return f"<pre>{escape(text)}</pre>{pictures}"
