#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The pages of `pirouette plan` in Chromium: the robot is where the path has it, and the parts of a proof are those
that its planes leave, by volumes that are computed otherwise.

Usage: test_plan_page.py COMMAND. Ends with 77, skipped, where Chromium is missing or has no WebGL.
"""
import pathlib
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
import chromium  # noqa: E402

# A plate with a hole of .5, and in the path's case a cube of .25.
WALLS = [(-2, -2, -.25, -.25, 2, .25), (.25, -2, -.25, 2, 2, .25), (-.25, -2, -.25, .25, -.25, .25),
         (-.25, .25, -.25, .25, 2, .25)]
ASKED = ["--bounds=-1,-1,-2,1,1,2", "--from=0,0,-1.5", "--to=0,0,1.5"]
VOLUMES = """[seen.start, seen.other].map(parts => parts.length)
    .concat(["start", "other"].map(side => partsOf(seen.region.tree, low, high)[side].map(massOf)
                                                .reduce((sum, mass) => sum + mass.volume / 6, 0)))"""


def solid(low, high):
    """A box in OBJ."""
    corners = [[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)]
    sides = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    return "".join(f"v {x} {y} {z}\n" for x, y, z in corners) + \
        "".join("f " + " ".join(str(i + 1) for i in side) + "\n" for side in sides)


def write(command, folder, half, *options):
    """The page of a cube of that half width before the plate."""
    paths = [folder / "cube.obj"]
    paths[0].write_text(solid((-half,) * 3, (half,) * 3))
    for i, wall in enumerate(WALLS):
        paths.append(folder / f"wall-{i}.obj")
        paths[-1].write_text(solid(wall[:3], wall[3:]))
    page = folder / "page.html"
    subprocess.run([command, "plan", *paths, *options, "--page", page], check=True, capture_output=True)
    return page.as_uri()


def check_path(browser):
    """The picture changes along the way, the line tells the motion, and keys step through it."""
    told, picture = "document.getElementById('where').textContent", "canvas.toDataURL('image/png')"
    motions = browser.evaluate("motions.map(pose => pose.at)")
    assert motions[0] == [0, 0, -1.5] and motions[-1] == [0, 0, 1.5] and browser.evaluate("regions.length") == 0
    pictures = set()
    for i in range(len(motions)):
        browser.evaluate(f"show({i})")
        pictures.add(browser.evaluate(picture))
    assert len(pictures) == len(motions), (len(pictures), motions)
    browser.evaluate("show(0)")
    assert browser.evaluate(told).startswith(f"motion 1 of {len(motions) - 1}: "), browser.evaluate(told)
    browser.evaluate("document.dispatchEvent(new KeyboardEvent('keydown', {key: 'End'}))")
    assert browser.evaluate("place") == len(motions) - 1
    faint = browser.evaluate(picture)
    browser.evaluate("opaque.value = 1; opaque.dispatchEvent(new Event('input'))")
    assert browser.evaluate(picture) != faint
    assert "the robot" in browser.evaluate("document.getElementById('legend').textContent")


def check_proof(browser, half):
    """The parts on each side fill what the plate leaves there; the hole is blocked."""
    start, other, below, above = browser.evaluate(VOLUMES)
    assert start > 0 and other > 0
    for volume in (below, above):
        assert abs(volume - 2 * 2 * (2 - .25 - half)) < 1e-9, (below, above)
    assert "on the start's side" in browser.evaluate("document.getElementById('where').textContent")
    assert browser.evaluate("document.getElementById('steps').hidden")


def check_turns(browser):
    """Regions of turns: a slider over them, each with parts on both sides."""
    count = browser.evaluate("regions.length")
    assert count >= 8 and browser.evaluate("divided.length") == count
    sides = []
    for i in range(count):
        browser.evaluate(f"show({i})")
        sides.append(browser.evaluate(VOLUMES))
    assert all(start > 0 and other > 0 and abs(below - above) < 1e-6 for start, other, below, above in sides), sides
    browser.evaluate("both.click()")
    assert browser.evaluate("shown.length") == count


def main(command):
    program = chromium.find()
    if not program:
        print("no Chromium")
        return 77
    with tempfile.TemporaryDirectory() as name:
        folder, browser = pathlib.Path(name), chromium.Chromium(program, "--enable-unsafe-swiftshader")
        try:
            browser.open(write(command, folder, .2, "--translate-only", *ASKED))
            if not browser.evaluate("Boolean(gl)"):
                print("Chromium has no WebGL")
                return 77
            check_path(browser)
            browser.open(write(command, folder, .5, "--translate-only", *ASKED))
            check_proof(browser, .5)
            browser.open(write(command, folder, .5, "--axis=0,0,1", *ASKED))
            check_turns(browser)
            complaints = [text for text in browser.complaints() if "GL Driver Message" not in text]
            assert not complaints, complaints
        finally:
            browser.close()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
