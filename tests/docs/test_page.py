#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The page of `pirouette view` in Chromium: what its canvas shows is what the command exports, slice by slice.

Usage: test_page.py COMMAND. Ends with 77, skipped, where Chromium is missing.
"""
import pathlib
import random
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
import chromium  # noqa: E402

STEPS = 20
# The canvas as rows of characters: blank, an edge, or what fills a facet.
LOOK = """(() => {
    const d = context.getImageData(0, 0, canvas.width, canvas.height).data, rows = [];
    for (let y = 0; y < canvas.height; y++) {
        let row = "";
        for (let x = 0; x < canvas.width; x++) {
            const i = 4 * (y * canvas.width + x);
            row += d[i] + d[i + 1] + d[i + 2] === 765 ? " " : d[i] === 0x24 && d[i + 1] === 0x38 ? "#" : "o";
        }
        rows.push(row);
    }
    return rows;
})()"""
# The facets of a slice as the page has decoded them.
FACETS = """(() => pairs.map(pair => pair.perSlice[slice].map(
    number => cornersOf(pair, pair.facets[number], matrixOf(slice)))))()"""
PROJECT = """(point => {
    const v = times(viewOf(), ...point.map((x, k) => x - frame.middle[k]));
    const scale = looking.zoom * 0.48 * Math.min(canvas.width, canvas.height) / frame.radius;
    return [canvas.width / 2 + scale * v[0], canvas.height / 2 - scale * v[1]];
})"""


def box(low, high):
    corners = [[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)]
    return "OFF\n8 0 0\n" + "".join(f"{x} {y} {z}\n" for x, y, z in corners)


def read_off(path):
    lines = path.read_text().split("\n")
    vertices, facets = map(int, lines[1].split()[:2])
    points = [tuple(map(float, line.split())) for line in lines[2:2 + vertices]]
    return [[points[int(i)] for i in line.split()[1:]] for line in lines[2 + vertices:2 + vertices + facets]]


def canonical(loop):
    """A loop of points, rounded, from its least point on."""
    loop = [tuple(round(c, 9) + 0.0 for c in point) for point in loop]
    start = loop.index(min(loop))
    return tuple(loop[start:] + loop[:start])


def inside(polygon, x, y):
    """How far a point is inside of a convex polygon, either way round."""
    turns = [((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / (((bx - ax) ** 2 + (by - ay) ** 2) ** 0.5 or 1)
             for (ax, ay), (bx, by) in zip(polygon, polygon[1:] + polygon[:1])]
    return max(min(turns), -max(turns))


def check_slice(browser, exported, number):
    """The page's facets are the exported ones, and the canvas is filled where they are."""
    shown = browser.evaluate(FACETS)
    assert len(shown) == len(exported)
    for own, other in zip(shown, exported):
        assert sorted(map(canonical, own)) == sorted(map(canonical, other)), number
    rows = browser.evaluate(LOOK)
    polygons = [[tuple(browser.evaluate(f"{PROJECT}({list(point)})")) for point in facet]
                for body in shown for facet in body]
    rng, checked = random.Random(number), 0
    for _ in range(400):
        x, y = rng.randrange(len(rows[0])), rng.randrange(len(rows))
        depths = [inside(polygon, x + 0.5, y + 0.5) for polygon in polygons]
        if all(abs(depth) > 2 for depth in depths):  # away from all edges
            assert (rows[y][x] != " ") == (max(depths) > 0), (number, x, y)
            assert rows[y][x] != "#" or max(depths) > 0, (number, x, y)
            checked += max(depths) > 0
    assert checked > 5, checked
    assert sum(row.count("#") for row in rows) > 200


def main(command):
    program = chromium.find()
    if not program:
        print("no Chromium")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder)

        def run(*args):
            subprocess.run([command, *map(str, args)], check=True, timeout=600, stdout=subprocess.DEVNULL)

        (path / "p.off").write_text(box((-1, -.25, -.25), (1, .25, .5)))
        (path / "q").mkdir()
        (path / "q" / "0.off").write_text(box((1, -1, -1), (2, 1, 1)))
        (path / "q" / "1.off").write_text(box((-1, -2, -1), (1, -1, .5)))
        run("slice", path / "p.off", path / "q", "-o", path / "s.h5", "--axis", "1,2,3", "--steps", STEPS)
        run("view", path / "s.h5", "-o", path / "s.html")
        browser = chromium.Chromium(program)
        try:
            browser.open((path / "s.html").as_uri())
            assert browser.evaluate("data.slices") == STEPS and browser.evaluate("document.title") == "s.h5"
            pictures = set()
            for k in (0, 7, STEPS - 1):
                # as a reader does it: by the slider
                browser.evaluate(f"slider.value = {k}; slider.dispatchEvent(new Event('input'));")
                assert browser.evaluate("slice") == k
                exported = []
                for pair in ("0,0", "0,1"):
                    run("view", path / "s.h5", "--slice", k, "--pair", pair, "-o", path / "one.off")
                    exported.append(read_off(path / "one.off"))
                check_slice(browser, exported, k)
                pictures.add("".join(browser.evaluate(LOOK)))
                assert f"slice {k} of {STEPS}" in browser.evaluate("document.getElementById('where').textContent")
            browser.drag("canvas")
            pictures.add("".join(browser.evaluate(LOOK)))
            assert len(pictures) == 4, "each slice and each view is another picture"
            browser.evaluate("document.getElementById('play').click()")
            browser.wait_until(f"slice != {STEPS - 1}")
            complaints = browser.complaints()
            assert not complaints, complaints
        finally:
            browser.close()
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
