#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""docs/img/turning.svg is what docs/img/turning.py draws from the command of this build, to the byte, and stays light.

Usage: test_picture.py COMMAND FOLDER_OF_THE_PICTURE
"""
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree


def main(command, folder):
    folder = pathlib.Path(folder)
    kept = (folder / "turning.svg").read_bytes()
    with tempfile.TemporaryDirectory() as out:
        drawn = pathlib.Path(out) / "turning.svg"
        subprocess.run([sys.executable, "-B", folder / "turning.py", command, drawn], check=True, timeout=60)
        assert drawn.read_bytes() == kept, "the picture is not what turning.py draws: draw it again"
    assert len(kept) < 200_000, len(kept)
    root = xml.etree.ElementTree.fromstring(kept)
    frames = [group for group in root if group.get("class") == "f"]
    pictures = {tuple(path.get("d") for path in group) for group in frames}
    delays = {group.get("style") for group in frames}
    assert len(frames) == len(delays) == len(pictures) == 90, (len(frames), len(delays), len(pictures))


if __name__ == "__main__":
    main(*sys.argv[1:])
