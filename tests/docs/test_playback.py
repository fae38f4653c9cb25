#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The page of `pirouette simulate` in Chromium: its canvas shows the bodies where they are, frame by frame.

Usage: test_playback.py COMMAND. Ends with 77, skipped, where Chromium is missing or has no WebGL.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
import chromium  # noqa: E402

SCENE = {"title": "Two <boxes>", "about": "One <falls>.", "seconds": 2,
         "shapes": {"box": {"model": "shape:box?x=1&y=1&z=1"}, "floor": {"model": "shape:box?x=9&y=9&z=1"}},
         "bodies": [{"shape": "floor", "kind": "static", "position": [0, 0, -0.5]},
                    {"shape": "box", "position": [0, 0, 0.5]}, {"shape": "box", "position": [2, 0, 2]}]}
MORE = {"title": "More", "seconds": 2, "rollbacks": [{"at": 1, "to": 0.5}], "shapes": SCENE["shapes"],
        "bodies": [SCENE["bodies"][0], SCENE["bodies"][1],
                   {"shape": "box", "kind": "static", "sensor": True, "position": [0, 0, 1]}]}
# The colours of the canvas at points of the world.
LOOK = """(points => {
    const view = viewOf(canvas, looking, scene), seen = new Uint8Array(4);
    return points.map(p => {
        const at = [0, 1, 2, 3].map(r => view[r] * p[0] + view[4 + r] * p[1] + view[8 + r] * p[2] + view[12 + r]);
        const x = (at[0] / at[3] + 1) / 2 * canvas.width, y = (at[1] / at[3] + 1) / 2 * canvas.height;
        gl.readPixels(x, y, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, seen);
        return [...seen];
    });
})"""
PICTURE = "canvas.toDataURL('image/png')"


def is_like(colour, other):
    """Whether a pixel is a colour under some light: the same but for its length, nearly."""
    dot = sum(a * b for a, b in zip(colour, other))
    return dot ** 2 > 0.985 * sum(a * a for a in colour) * sum(b * b for b in other) > 0


def check(browser):
    assert browser.evaluate("document.title") == "Two <boxes>"
    browser.evaluate("play(false); document.getElementById('points').click()")
    looks = browser.evaluate("LOOKS.map(look => look[1].map(x => 255 * x))")
    pictures = set()
    for frame in (0, 8, 59):
        browser.evaluate(f"slider.value = {frame}; slider.dispatchEvent(new Event('input'));")
        assert browser.evaluate("Math.floor(time)") == frame
        for body in (1, 2):
            x, y, z = browser.evaluate(f"[...frames[{frame}].pose.slice({7 * body}, {7 * body + 3})]")
            look = browser.evaluate(f"frames[{frame}].look[{body}]")
            (*seen, _), = browser.evaluate(f"{LOOK}({json.dumps([[x, y, z + 0.5]])})")
            assert is_like(seen, looks[look]), (frame, body, seen, looks[look])
        pictures.add(browser.evaluate(PICTURE))
    assert browser.evaluate("frames[0].look.join()") == "0,0,0"
    assert browser.evaluate("frames[59].look.slice(1).includes(2) || frames[59].look.slice(1).includes(3)")
    # contacts, another view, colours by body, and the dark theme each change the picture
    browser.evaluate("document.getElementById('points').click()")
    pictures.add(browser.evaluate(PICTURE))
    browser.drag("canvas")
    pictures.add(browser.evaluate(PICTURE))
    browser.evaluate("const list = document.getElementById('colours'); list.value = 'bodies';"
                     "list.dispatchEvent(new Event('change'))")
    pictures.add(browser.evaluate(PICTURE))
    browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark"}])
    browser.evaluate("draw()")
    pictures.add(browser.evaluate(PICTURE))
    assert len(pictures) == 7, len(pictures)
    check_controls(browser)
    check_words(browser)
    browser.evaluate("show(3); document.getElementById('play').click()")
    browser.wait_until("time != 3")


def check_controls(browser):
    """Steps, keys, the view, and a body that is clicked, as the text and the picture say."""
    press = "document.dispatchEvent(new KeyboardEvent('keydown', {key: '%s'}))"
    browser.evaluate("reset(); show(7); document.getElementById('on').click()")
    assert browser.evaluate("time") == 8
    for key, time in (("ArrowLeft", 7), ("ArrowRight", 8), ("Home", 0), ("End", 60)):
        browser.evaluate(press % key)
        assert browser.evaluate("time") == time, key
    browser.evaluate(press % "+")
    assert browser.evaluate("looking.zoom") > 1
    browser.evaluate(press % "r")
    assert browser.evaluate("looking.zoom") == 1
    text = "document.getElementById('chosen').textContent"
    nobody = browser.evaluate(text)
    for body in (1, 2):
        x, y = browser.evaluate(f"""(() => {{
            const view = viewOf(canvas, looking, scene), p = [...frames[60].pose.slice({7 * body}, {7 * body + 3}), 1];
            const at = [0, 1, 2, 3].map(r => p.reduce((sum, c, k) => sum + view[4 * k + r] * c, 0));
            const box = canvas.getBoundingClientRect();
            return [box.left + (at[0] / at[3] + 1) / 2 * box.width, box.top + (1 - at[1] / at[3]) / 2 * box.height];
        }})()""")
        for kind in ("mousePressed", "mouseReleased"):
            browser.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)
        assert browser.evaluate("chosen") == body, (body, browser.evaluate("chosen"))
        its = browser.evaluate(f"contactsOf(frames[60].contacts, {body}).length")
        assert its > 0 and browser.evaluate(text).startswith(f"Body {body}: ")
        assert f"{its} contacts with 1 body;" in browser.evaluate(text), browser.evaluate(text)
        # a box on a floor: its normals are along z
        worst = browser.evaluate(f"Math.min(...contactsOf(frames[60].contacts, {body}).map(i => "
                                 "Math.abs(frames[60].contacts[i + 8])))")
        assert worst > 0.9999, worst
        since = browser.evaluate(f"sinceWhen({body}, 60)")
        assert f" for {since:.2f} s;" in browser.evaluate(text), (since, browser.evaluate(text))
        look = browser.evaluate(f"frames.map(frame => frame.look[{body}])")
        assert look[60 - round(30 * since):] == look[60:] * (round(30 * since) + 1), (since, look)
    browser.evaluate(press % "Escape")
    assert browser.evaluate(text) == nobody


def check_words(browser):
    """The title, what there is to see, colours that occur, and the table of what updates did."""
    shown = "document.getElementById('%s').textContent"
    assert browser.evaluate(shown % "title") == "Two <boxes>" and browser.evaluate(shown % "about") == "One <falls>."
    browser.evaluate("show(0)")
    assert "2 bodies move, 0 asleep, " in browser.evaluate(shown % "where")
    legend = browser.evaluate(shown % "legend")
    assert "static" in legend and "driven" not in legend and "sensor" not in legend, legend
    rows = browser.evaluate("[...document.querySelectorAll('#profile tr')].map(row => "
                            "[...row.cells].map(cell => cell.textContent))")
    assert rows[0] == ["", "mean", "99th percentile", "worst"], rows
    assert [row[0] for row in rows[1:3]] == ["update, µs", "poses and boxes, µs"] and len(rows) == 21, rows
    assert all(float(cell.replace(",", "")) >= 0 for row in rows[1:] for cell in row[1:]), rows


def check_more(browser):
    """Sensors are seen through, and change the colour of what is in them; a rollback is told."""
    browser.evaluate("play(false); document.getElementById('points').click(); show(0)")
    (*inside, _), (*zone, _) = browser.evaluate(f"{LOOK}([[0, 0, 1], [0, 0, 3]])")
    told = "document.getElementById('where').textContent"
    assert is_like(inside, browser.evaluate("LOOKS[4][1].map(x => 255 * x)")) is False  # through the zone
    assert max(zone) != min(zone) and "in 1 sensor" in browser.evaluate(told), (inside, zone, browser.evaluate(told))
    assert "1 body moves" in browser.evaluate(told), browser.evaluate(told)
    assert "taken back" not in browser.evaluate(told)
    browser.evaluate("show(31)")
    assert "taken back from 1.00 s to 0.50 s" in browser.evaluate(told), browser.evaluate(told)
    assert "sensor" in browser.evaluate("document.getElementById('legend').textContent")
    assert browser.evaluate("document.querySelectorAll('#profile tr').length") == 13  # no times


def main(command):
    program = chromium.find()
    if not program:
        print("no Chromium")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder)
        for name, scene, more in (("page", SCENE, ["--times"]), ("more", MORE, [])):
            (path / "scene.json").write_text(json.dumps(scene))
            subprocess.run([command, "simulate", path / "scene.json", "-o", path / f"{name}.html", *more], check=True,
                           stdout=subprocess.DEVNULL)
        browser = chromium.Chromium(program, "--enable-unsafe-swiftshader")
        try:
            browser.open((path / "page.html").as_uri())
            if not browser.evaluate("Boolean(gl)"):
                print("no WebGL")
                return 77
            check(browser)
            browser.open((path / "more.html").as_uri())
            check_more(browser)
            # what the driver says of reading pixels is not the page's
            complaints = [text for text in browser.complaints() if "GL Driver Message" not in text]
            assert not complaints, complaints
        finally:
            browser.close()
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
