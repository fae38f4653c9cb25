#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""docs/img/turning.svg is what docs/img/turning.py draws from the command of this build, to the byte, and stays light.
docs/img/pile.svg is light, and pile.py draws as many frames, of about as many bodies.

Usage: test_picture.py COMMAND FOLDER_OF_THE_PICTURE
"""
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree


def frames_of(data):
    return [group for group in xml.etree.ElementTree.fromstring(data) if group.get("class", "").startswith("f")]


def check_pile(command, folder):
    kept = (folder / "pile.svg").read_bytes()
    with tempfile.TemporaryDirectory() as out:
        drawn = pathlib.Path(out) / "pile.svg"
        subprocess.run([sys.executable, "-B", folder / "pile.py", command, drawn], check=True, timeout=100)
        fresh = drawn.read_bytes()
    assert len(kept) < 300_000, len(kept)
    before, now = frames_of(kept), frames_of(fresh)
    assert len(before) == len(now) == 31, (len(before), len(now))
    for a, b in zip(before, now):
        assert a.get("style") == b.get("style"), (a.get("style"), b.get("style"))
        # a pile may fall a little otherwise where the scene or the solver has changed, and is drawn again then
        assert abs(len(a) - len(b)) < 20 and len(b) > 60, (len(a), len(b))


def main(command, folder):
    folder = pathlib.Path(folder)
    check_pile(command, folder)
    kept = (folder / "turning.svg").read_bytes()
    with tempfile.TemporaryDirectory() as out:
        drawn = pathlib.Path(out) / "turning.svg"
        subprocess.run([sys.executable, "-B", folder / "turning.py", command, drawn], check=True, timeout=600)
        assert drawn.read_bytes() == kept, "the picture is not what turning.py draws: draw it again"
    assert len(kept) < 200_000, len(kept)
    frames = frames_of(kept)
    pictures = {tuple(path.get("d") for path in group) for group in frames}
    delays = {group.get("style") for group in frames}
    assert len(frames) == len(delays) == len(pictures) == 90, (len(frames), len(delays), len(pictures))


if __name__ == "__main__":
    main(*sys.argv[1:])
