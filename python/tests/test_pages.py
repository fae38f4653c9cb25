# SPDX-License-Identifier: MIT
"""The Python of the pages runs, and examples/python prints what it should."""
import pathlib
import re
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "examples/python").glob("*.py"))


@pytest.mark.parametrize("page", ["docs/python.md", "docs/getting-started.md", "README.md", "python/README.md"])
def test_pages(page, monkeypatch):
    monkeypatch.chdir(ROOT / "examples/models")
    blocks = re.findall(r"^```python\n(.*?)^```", (ROOT / page).read_text(encoding="utf-8"), re.M | re.S)
    assert blocks
    exec(compile("\n".join(blocks), page, "exec"), {})


def test_the_first_program_is_that_of_its_page():
    page = (ROOT / "docs/getting-started.md").read_text(encoding="utf-8")
    source = (ROOT / "examples/first.c").read_text(encoding="utf-8").split("\n", 4)[4]
    assert source in page
    for line in (ROOT / "examples/python/first.py").read_text(encoding="utf-8").splitlines()[2:-1]:
        assert line in page
    told = re.search(r"```text\n(.*?)```", page, re.S)[1]
    found = subprocess.run([sys.executable, "-B", str(ROOT / "examples/python/first.py")], capture_output=True,
                           text=True)
    assert found.stdout.replace("-0.000", "0.000") == told + "done: first\n"


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_examples(path, tmp_path):
    found = subprocess.run([sys.executable, "-B", str(path)], capture_output=True, text=True, cwd=tmp_path)
    assert found.returncode == 0, found.stderr
    assert found.stdout.splitlines()[-1].startswith("done: "), found.stdout
