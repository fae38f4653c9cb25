#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The site that ./dev docs makes: every link and anchor leads somewhere, no page complains in a browser or overflows a
phone, the search finds, pictures and colours are there, and the reference says of every function what it must.

Usage: test_site.py ROOT [COMMAND]. With COMMAND the site has its gallery. Needs doxygen and Chromium; ends with 77,
skipped, where one is missing.
"""
import html.parser
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import urllib.parse

sys.dont_write_bytecode = True
ROOT = pathlib.Path(sys.argv[1]).resolve()
COMMAND = [pathlib.Path(path).resolve() for path in sys.argv[2:]]
sys.path[:0] = [str(ROOT / "docs" / "site")]
import check_reference  # noqa: E402
import chromium  # noqa: E402
import reference  # noqa: E402


class Links(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.links, self.anchors, self.again = [], set(), []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("href", "src"):
                self.links.append(value)
            if name == "id":
                if value in self.anchors:
                    self.again.append(value)
                self.anchors.add(value)


def broken_links(site):
    """Lines on what leads nowhere, and the number of links."""
    pages = {path: Links(path.read_text(encoding="utf-8")) for path in sorted(site.rglob("*.html"))}
    found, count = [], 0
    for path, page in pages.items():
        found += [f"{path}: two anchors {name}" for name in page.again]
        for link in page.links:
            if link.startswith(("https://", "data:")):
                continue
            count += 1
            address, _, anchor = link.partition("#")
            target = (path.parent / urllib.parse.unquote(address)).resolve() if address else path
            if not target.is_file() or site not in target.parents:
                found.append(f"{path}: no {link}")
            elif anchor and (target not in pages or urllib.parse.unquote(anchor) not in pages[target].anchors):
                found.append(f"{path}: no anchor {link}")
    return found, count


# How wide the page is, which pictures are not shown, and what marks of the sources are left in its text.
LOOK = r"""(() => {
    const text = document.querySelector("main").cloneNode(true);
    text.querySelectorAll("pre, code").forEach(code => code.remove());
    return [document.documentElement.scrollWidth,
        [...document.images].filter(i => !i.complete || !i.naturalWidth).map(i => i.src),
        /\*\*|\]\(|[\\@](param|par|file)\b/.exec(text.textContent)?.[0] ?? ""];
})()"""


def check_pages(browser, site):
    """Opens every page, as wide as a phone."""
    browser.call("Emulation.setDeviceMetricsOverride", width=390, height=800, deviceScaleFactor=1, mobile=True)
    # scenes that play are pages of another program, and looked at by test_playback.py
    pages = [path for path in sorted(site.rglob("*.html")) if path.parent.name != "gallery" or path.stem == "index"]
    for path in pages:
        browser.open(path.as_uri())
        wide, pictures, marks = browser.evaluate(LOOK)
        assert wide <= 390, f"{path}: {wide} wide on a phone"
        assert not pictures, f"{path}: not shown: {pictures}"
        assert not marks, f"{path}: marks are left: {marks}"
        complaints = browser.complaints()
        assert not complaints, f"{path}: {complaints}"
    return len(pages)


def check_examples(site, headers):
    """Every function that an example calls leads there; the number of those."""
    count = 0
    for header in headers:
        page = (site / "api" / (header.name[:-2] + ".html")).read_text(encoding="utf-8")
        sections = page.split('<section class="item">')
        for example in sorted((ROOT / "examples").glob("*.c")):
            text = example.read_text(encoding="utf-8")
            for item in header.items:
                if item.kind == "function" and re.search(rf"\b{item.name}\(", text):
                    own = next(section for section in sections if f'id="{item.name}"' in section)
                    assert f"examples/{example.stem}.html" in own, (item.name, example.name)
                    count += 1
    return count


# What people type, and what has to be among the first five that are found.
WORDS = {
    "capsule": "capsule", "ray cast": "ray", "raycast": "ray", "EPA": "penetration", "GJK": "distance",
    "mesh": "mesh", "trigger": "sensor", "heightmap": "height", "terrain": "height", "broad phase": "scene",
    "python-fcl": "python", "convex hull": "hull", "quaternion": "rotation", "manifold": "manifold",
    "collide": "overlap",
    "toi": "time_of_impact", "non-convex": "solid", "inertia": "mass", "threads": "thread", "minkowski sum": "sum",
}


def check_words(browser):
    for typed, expected in WORDS.items():
        found = browser.evaluate(f"""(() => {{
            const field = document.getElementById("search");
            field.value = "{typed}";
            field.dispatchEvent(new Event("input"));
            return [...document.querySelectorAll("#found a")].slice(0, 5).map(link => link.innerText.toLowerCase());
        }})()""")
        assert any(expected in line for line in found), (typed, expected, found)


def check_contents(site, headers):
    """A page of the reference begins with a table of its functions, each with what it does."""
    for header in headers:
        names = [item.name for item in header.items if item.kind == "function"]
        text = (site / f"api/{header.name[:-2]}.html").read_text(encoding="utf-8")
        table = text.partition('<section class="item">')[0].partition('<table class="contents">')[2]
        assert re.findall(r'<td><a href="#(\w+)">', table) == names, header.name
        assert not re.search(r"<td></td>", table), header.name


def check_search(browser, site):
    for start in ("index.html", "api/query.html"):
        for typed, expected in (("pir_sum_rotate", "/api/sum.html#pir_sum_rotate"),
                                ("touching rule", "/queries.html#the-touching-rule"),
                                ("pir_query_cast", "/api/query.html#pir_query_cast"),
                                ("grid_of_states", "/examples/grid_of_states.html")):
            browser.open((site / start).as_uri())
            found = browser.evaluate(f"""(() => {{
                const field = document.getElementById("search");
                field.value = "{typed}";
                field.dispatchEvent(new Event("input"));
                const link = document.querySelector("#found a");
                return link && link.href;
            }})()""")
            assert found and found.endswith(expected), (start, typed, found)
    check_words(browser)
    nothing = browser.evaluate("""(() => {
        const field = document.getElementById("search");
        field.value = "qwertzuiop no such words";
        field.dispatchEvent(new Event("input"));
        return document.getElementById("found").innerText.trim();
    })()""")
    assert nothing == "Nothing found.", nothing
    browser.open((site / "index.html").as_uri())
    browser.evaluate("""(() => {
        const field = document.getElementById("search");
        field.value = "pir_sum_mesh";
        field.dispatchEvent(new Event("input"));
        field.dispatchEvent(new KeyboardEvent("keydown", {key: "Enter"}));
    })()""")
    browser.wait("Page.loadEventFired")
    assert browser.evaluate("location.href").endswith("/api/sum.html#pir_sum_mesh")
    assert not browser.complaints()


def check_looks(browser, site):
    """Light and dark differ, and the picture at the top moves."""
    grounds = []
    for scheme in ("light", "dark"):
        browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
        browser.open((site / "index.html").as_uri())
        grounds.append(browser.evaluate("getComputedStyle(document.body).backgroundColor"))
    assert grounds[0] != grounds[1], grounds
    browser.open((site / "files/docs/img/turning.svg").as_uri())
    shown = """new Promise(done => setTimeout(() => done([...document.querySelectorAll(".f")].map((group, i) => i)
        .filter(i => getComputedStyle(document.querySelectorAll(".f")[i]).visibility === "visible")), %d))"""
    first, second = browser.evaluate(shown % 0), browser.evaluate(shown % 700)
    assert len(first) <= 2 and len(second) <= 2 and first != second, (first, second)


def main():
    needed = {"doxygen": shutil.which("doxygen"), "chromium": chromium.find()}
    missing = [name for name, there in needed.items() if not there]
    if missing:
        print(f"skipped: no {' and no '.join(missing)} here; ./dev setup installs them")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        site = pathlib.Path(folder).resolve() / "site"
        made = subprocess.run([sys.executable, "-B", ROOT / "docs/site/make_site.py", site, *COMMAND],
                              capture_output=True, text=True)
        assert made.returncode == 0, made.stdout + made.stderr
        found, count = broken_links(site)
        assert not found and count > 1000, "\n".join(found)
        warnings = reference.run_doxygen(ROOT, pathlib.Path(folder) / "doxygen")
        headers = reference.read_headers(pathlib.Path(folder) / "doxygen")
        lacks, functions = check_reference.check(headers)
        assert not warnings, warnings
        assert not lacks and functions > 100, "\n".join(lacks)
        written = {name for header in (ROOT / "include" / "pirouette").glob("*.h")
                   for name in check_reference.declared(header.read_text(encoding="utf-8"))}
        told = {item.name for header in headers for item in header.items if item.kind == "function"}
        assert told == written, told ^ written
        assert check_examples(site, headers) > 80
        check_contents(site, headers)
        browser = chromium.Chromium(chromium.find())
        try:
            pages = check_pages(browser, site)
            check_search(browser, site)
            check_looks(browser, site)
        finally:
            browser.close()
    print(f"{pages} pages, {count} links, {functions} functions")
    return 0


if __name__ == "__main__":
    os.chdir(ROOT)
    sys.exit(main())
