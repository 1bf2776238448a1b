"""What the tests share: the examples, the program, and the reference data where it is at hand."""

import os
import pathlib
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"
PUBLISHED = EXAMPLES / "holybro-x500.json"
COMMAND = os.environ.get("TETHERCALC_COMMAND", str(ROOT / "build/release/tethercalc"))


def command(*arguments: object) -> str:
    """What the program prints."""
    told = subprocess.run(
        [COMMAND, *map(str, arguments)], check=True, capture_output=True, text=True
    )
    return told.stdout


def reference(path: str) -> pathlib.Path:
    """A file of the reference data, which the project does not ship."""
    folder = os.environ.get("TETHERCALC_REFERENCE_DATA", ROOT.parent / "shared")
    file = pathlib.Path(folder) / "data" / path
    if not file.exists():
        raise unittest.SkipTest(f"{file} is not at hand")
    return file
