#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The page of examples/terrain in Chromium: the ground hides what is under it, and the capsule goes over the bridge.

Usage: test_terrain_page.py PROGRAM. Ends with 77, skipped, where Chromium is missing or has no WebGL.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
import chromium  # noqa: E402
from test_playback import LOOK, PICTURE, is_like  # noqa: E402


def looks(browser, *points):
    return [look[:3] for look in browser.evaluate(f"{LOOK}({json.dumps(points)})")]


def check(browser):
    assert browser.evaluate("document.title") == "A capsule walks over hills and a bridge, among 300 bodies"
    browser.evaluate("play(false); document.getElementById('points').click()")
    count = browser.evaluate("data.kind.length")
    assert (count, browser.evaluate("ground.length"), browser.evaluate("driven.length")) == (303, 2, 1)
    purple, grey = browser.evaluate("[KINEMATIC, STATIC].map(colour => colour.map(x => 255 * x))")
    pictures = set()
    for frame, x in ((2, None), (29, 32), (59, None)):
        browser.evaluate(f"slider.value = {frame}; slider.dispatchEvent(new Event('input'));")
        at = browser.evaluate(f"[...frames[{frame}].pose.slice({7 * (count - 1)}, {7 * (count - 1) + 3})]")
        assert x is None or abs(at[0] - x) < 2, at
        capsule, = looks(browser, at)
        assert is_like(capsule, purple), (frame, at, capsule)
        pictures.add(browser.evaluate(PICTURE))
    # a slope of the hills without bodies, and what is under it
    assert all(is_like(look, grey) for look in looks(browser, [3, 60, 9], [2, 3, 9.5])), "hills"
    assert len(pictures) == 3
    browser.evaluate("document.getElementById('points').click()")
    assert browser.evaluate(PICTURE) not in pictures


def main(program):
    path = chromium.find()
    if not path:
        print("no Chromium")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        page = pathlib.Path(folder) / "terrain.html"
        with open(page, "wb") as file:
            subprocess.run([program, "page"], check=True, stdout=file)
        assert b"http://" not in page.read_bytes() and b"https://" not in page.read_bytes()
        browser = chromium.Chromium(path, "--enable-unsafe-swiftshader")
        try:
            browser.open(page.as_uri())
            if not browser.evaluate("Boolean(gl)"):
                print("no WebGL")
                return 77
            check(browser)
            complaints = [text for text in browser.complaints() if "GL Driver Message" not in text]
            assert not complaints, complaints
        finally:
            browser.close()
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
