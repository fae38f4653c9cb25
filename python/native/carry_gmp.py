# SPDX-License-Identifier: MIT
"""Copies GMP as a shared library, with what its licence wants told, into the package.

Usage: carry_gmp.py LIBDIR NOTICE LIBRARY TEXT   LIBDIR is where pkg-config has GMP; LIBRARY and TEXT are written.
"""
import pathlib
import shutil
import sys

LICENCES = pathlib.Path("/usr/share/common-licenses")


def main(libdir, notice, library, text):
    shutil.copyfile((pathlib.Path(libdir) / pathlib.Path(library).name).resolve(), library)
    told = [pathlib.Path(notice).read_text(encoding="utf-8")]
    told += [(LICENCES / name).read_text(encoding="utf-8") for name in ("LGPL-3", "GPL-3", "GPL-2")
             if (LICENCES / name).is_file()]
    pathlib.Path(text).write_text("\n\n".join(told), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
