"""What docs/python.md shows is what runs."""

import contextlib
import io
import os
import pathlib
import re
import tempfile
import unittest

import tethercalc
from support import EXAMPLES, ROOT, reference


class Documents(unittest.TestCase):
    def test_the_page_on_python_names_every_function(self):
        page = (ROOT / "docs/python.md").read_text()
        for name in tethercalc.__all__:
            if not isinstance(getattr(tethercalc, name), type):
                self.assertIn(f"{name}(", page)

    def test_the_code_of_the_page_on_python_runs_as_it_stands(self):
        blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs/python.md").read_text(), re.S)
        self.assertGreater(len(blocks), 2)
        flight = reference("x500-flight.bin")
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "examples").symlink_to(EXAMPLES)
            pathlib.Path(folder, "flight.bin").symlink_to(flight)
            os.chdir(folder)
            names = {}
            with contextlib.redirect_stdout(io.StringIO()) as printed:
                for block in blocks:
                    exec(compile(block, "docs/python.md", "exec"), names)
            os.chdir(before)
        self.assertIn("Fly ", printed.getvalue())


if __name__ == "__main__":
    unittest.main()
