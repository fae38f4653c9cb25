# SPDX-License-Identifier: MIT
"""The Python of the pages runs, and examples/python prints what it should."""
import importlib.util
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


def checks_of_examples():
    """The class that holds what the C examples print against what it works out from the bodies alone."""
    path = ROOT / "tests/cli/test_examples.py"
    found = importlib.util.spec_from_file_location("checks_of_examples", path)
    module = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)
    return module.Examples


# by the name of the C example; one whose Python has another name
C_EXAMPLES = {path.stem: path.stem for path in (ROOT / "examples").glob("*.c")} | {"trajectory": "bend_path"}


@pytest.mark.parametrize("name", sorted(C_EXAMPLES))
def test_what_c_examples_print_python_prints(name, tmp_path):
    script, models = ROOT / f"examples/python/{C_EXAMPLES[name]}.py", ROOT / "examples/models"
    given = [str(models / "gamepad.off"), str(models / "mug.off"), str(tmp_path / "sum.off")] if name == "track" else []
    found = subprocess.run([sys.executable, "-B", str(script), *given], capture_output=True, text=True, cwd=tmp_path)
    assert found.returncode == 0 and found.stderr == "", found.stderr
    checks = checks_of_examples()
    told = checks.__new__(checks)
    told.arguments, told.lines = given, found.stdout.splitlines()
    assert told.lines.pop() == f"done: {C_EXAMPLES[name]}"
    if name == "two_bodies":  # C also prints counters, which a batch has not
        told.lines.append("of 201 answers 1 and 1")
    if name == "first":
        told.lines = [line.replace("-0.000", "0.000") for line in told.lines]
    getattr(told, name)()


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_examples(path, tmp_path):
    found = subprocess.run([sys.executable, "-B", str(path)], capture_output=True, text=True, cwd=tmp_path)
    assert found.returncode == 0, found.stderr
    last = found.stdout.splitlines()[-1]
    if last.startswith("skipped: "):
        pytest.skip(last)
    assert last.startswith("done: "), found.stdout
