# SPDX-License-Identifier: MIT
"""A wheel holds the package alone, with its types, its licence and that of GMP, and its tag is that of its module.

Usage: check_wheel.py WHEEL
"""
import pathlib
import sys
import zipfile


def main(path):
    names = set(zipfile.ZipFile(path).namelist())
    folders = {name.split("/")[0] for name in names}
    module = [name for name in names if name.startswith("pirouette/_native.") and name.endswith(".so")]
    wrong = []
    if len(folders) != 2 or "pirouette" not in folders or not any(f.endswith(".dist-info") for f in folders):
        wrong.append(f"it has the folders {sorted(folders)}")
    if len(module) != 1:
        wrong.append(f"it has the modules {module}")
    if "none-any" in pathlib.Path(path).name or "-abi3-" in pathlib.Path(path).name:
        wrong.append("its tag promises more than its module keeps")
    for name in ("pirouette/py.typed", "pirouette/_native.pyi", "pirouette/__init__.py"):
        if name not in names:
            wrong.append(f"{name} is missing")
    if "pirouette/libgmp.so.10" in names and "pirouette/GMP.txt" not in names:
        wrong.append("it has GMP without its licence")
    if not any(name.endswith(".dist-info/LICENSE") for name in names):
        wrong.append("its licence is missing")
    print(*(f"{path}: {reason}" for reason in wrong), sep="\n", end="")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
