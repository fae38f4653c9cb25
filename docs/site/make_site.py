#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the site: every page of the project, the reference of its public functions, the examples, and a search.

Usage: make_site.py OUTPUT [COMMAND]. The site is static and works from a folder as from a server; OUTPUT/index.html is
its door. With COMMAND, the program `pirouette`, it has a gallery of scenes that play, each that has a name.
Exits with 1, and says why, when a link of a page leads nowhere or Doxygen warns.
"""
import html
import importlib.util
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

import markdown
import reference

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
# The pages in the order of the navigation.
PAGES = {
    "README.md": "Pirouette", "docs/getting-started.md": "Getting started", "docs/python.md": "Python",
    "docs/coming-from.md": "Coming from others", "docs/queries.md": "Placement queries",
    "docs/gradients.md": "Gradients", "docs/scenes.md": "Scenes",
    "docs/exactness.md": "Exactness", "docs/cgm.md": "Cubical Gaussian maps",
    "docs/object-space.md": "Sums of simple bodies", "docs/slices.md": "Slices",
    "docs/scale.md": "Slices at scale",
    "docs/motion.md": "Critical angles and first contacts",
    "docs/solids.md": "Solids", "docs/clash.md": "Clashes", "docs/plan.md": "Plans",
    "docs/meshes.md": "Meshes", "docs/command.md": "The command",
    "docs/bad-input.md": "Bad input",
    "docs/accuracy.md": "Accuracy and time",
    "docs/replay.md": "Replay",
    "docs/proofs.md": "Proofs",
    "docs/guarantees.md": "Guarantees", "docs/api-tests.md": "What tests each function",
    "docs/building.md": "Building", "ARCHITECTURE.md": "Architecture",
    "CONTRIBUTING.md": "Contributing", "SECURITY.md": "Security",
    "docs/upgrading.md": "Upgrading", "CHANGELOG.md": "Changelog",
}
# Scenes of the gallery that are shorter there than they say, in seconds.
SECONDS = {"cards": 4, "game": 3, "gears": 3, "stack": 3, "terrain": 5, "thousands": 0.6}
# Those that have no name, for they need other files.
UNNAMED = ["table"]
# Plans of the gallery, of models that examples/plan/make_models.py writes: name, title, about, and what is asked.
PLANS = [
    ("bug", "Out of a trap", "A bug finds its way out by translations alone.",
     ["bug", "trap", "--translate-only", "--from=1.5,1.5,1.5", "--to=4.5,4.5,13"]),
    ("bug-large", "No way out of the trap",
     "A larger bug does not, and the parts of space on either side of the walls prove it.",
     ["bug-large", "trap", "--translate-only", "--from=1.5,1.5,1.5", "--to=4.5,4.5,13"]),
    ("peg", "A peg turns to go through", "It lies across a hole, goes through upright, and lies on the other side.",
     ["peg-loose", "plate", "--axis=0,1,0", "--bounds=0.5,0,-9,5.5,5,9", "--from=1,2.5,4,90", "--to=1,2.5,-2,90"]),
    ("alpha", "The alpha puzzle", "Two tubes that hang in each other come apart, by turns and ways at once.",
     ["alpha-50", "alpha-50", "--bounds=-4,-2,-2,2,2,2", "--from=-1.5,0,0,0,1,1,0", "--to=-3,0,0,0,1,1,0"]),
]
WORD = re.compile(r"\b(?:pir|PIR)_\w+\b")


def load_models():
    """The models that examples/plan writes, by name."""
    spec = importlib.util.spec_from_file_location("make_models", ROOT / "examples" / "plan" / "make_models.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.models()


def contents(header):
    """A table of the functions of a header, each with the first sentence that is said of it."""
    rows, told = [], ""
    for item in header.items:
        if item.kind != "function":
            continue
        told = item.text or told  # one comment may stand for several
        first = re.split(r"(?<=[.:])\s", told.strip(), maxsplit=1)[0]
        name = f'<a href="#{item.name}">{item.name}</a>'
        rows.append(f"<tr><td>{name}</td><td>{html.escape(first, quote=False)}</td></tr>")
    return f'<div class="table"><table class="contents">{"".join(rows)}</table></div>' if rows else ""


class Site:
    def __init__(self, out, command=None):
        self.out = out
        self.command = command
        self.errors = []
        self.symbols = {}  # name -> address from the top of the site
        self.files = {}  # path in the repository -> address
        self.entries = []  # of the search
        self.wanted = []  # files that pages link to
        for page in PAGES:
            self.files[page] = "index.html" if page == "README.md" else pathlib.Path(page).stem.lower() + ".html"

    # ---- addresses

    def relative(self, address, here):
        return os.path.relpath(address.partition("#")[0] or here, os.path.dirname(here) or ".") + (
            "#" + address.partition("#")[2] if "#" in address else "")

    def link_of(self, page, here):
        """The function that turns a link of a page of the repository into one of the site."""
        folder = pathlib.PurePosixPath(page).parent

        def link(target):
            if re.match(r"https?:", target):
                return target
            path, _, anchor = target.partition("#")
            name = os.path.normpath(folder / path) if path else page
            if not (ROOT / name).exists():
                self.errors.append(f"{page}: the link to {target} leads nowhere")
                return target
            if name not in self.files:
                self.files[name] = self.address_of_file(name)
                self.wanted.append(name)
            return self.relative(self.files[name] + ("#" + anchor if anchor else ""), here)

        return link

    def address_of_file(self, name):
        return "files/" + name if name.endswith((".svg", ".png")) else "files/" + name.replace("/", "_") + ".html"

    def linked(self, text, here):
        """HTML in which each name of the reference leads there, but within links and headings."""
        parts = re.split(r"(<a .*?</a>|<h\d.*?</h\d>|<[^>]+>)", text, flags=re.S)
        for i in range(0, len(parts), 2):
            parts[i] = WORD.sub(lambda m: self.name_link(m[0], here), parts[i])
        return "".join(parts)

    def name_link(self, name, here):
        if name not in self.symbols:
            return name
        return f'<a href="{self.relative(self.symbols[name], here)}">{name}</a>'

    # ---- writing

    def navigation(self, here, headers):
        def entry(address, title):
            mark = ' aria-current="page"' if address == here else ""
            return f'<li><a href="{self.relative(address, here)}"{mark}>{html.escape(title)}</a></li>'

        pages = "".join(entry(self.files[page], title) for page, title in PAGES.items())
        if self.command:
            pages += entry("gallery/index.html", "Scenes that play")
        api = "".join(entry(f"api/{header.name[:-2]}.html", header.name) for header in headers)
        return (f'<h2>Pages</h2><ul>{pages}</ul><h2>Reference</h2><ul>{entry("api/index.html", "All names")}{api}</ul>'
                f'<h2>Examples</h2><ul>{"".join(entry(f"examples/{e.stem}.html", e.name) for e in EXAMPLES)}</ul>')

    def write(self, here, title, body, headings=()):
        top = self.relative("index.html", here)[:-len("index.html")]
        toc = "".join(f'<li class="l{level}"><a href="#{anchor}">{html.escape(words)}</a></li>'
                      for level, words, anchor in headings if level in (2, 3))
        page = TEMPLATE
        values = {"title": html.escape(title), "top": top, "navigation": self.navigation(here, self.headers),
                  "toc": f"<h2>On this page</h2><ul>{toc}</ul>" if toc else "", "body": body}
        for name, value in values.items():
            page = page.replace("{{" + name + "}}", value)
        path = self.out / here
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(page, encoding="utf-8")

    def note(self, title, address, kind, text):
        words = html.unescape(re.sub(r"<[^>]+>", " ", text)).split()
        self.entries.append([title, address, kind, " ".join(words)])

    # ---- kinds of pages

    def write_page(self, page, title):
        here = self.files[page]
        body, headings = markdown.render((ROOT / page).read_text(encoding="utf-8"), self.link_of(page, here))
        body = self.linked(body, here)
        self.write(here, title, body, headings)
        parts = re.split(r'<h[123] id="([^"]*)">(.*?)</h[123]>', body)
        for anchor, words, text in zip(parts[1::3], parts[2::3], parts[3::3]):
            self.note(html.unescape(re.sub("<[^>]+>", "", words)), f"{here}#{anchor}", title, text)

    def write_example(self, path):
        here = f"examples/{path.stem}.html"
        text = path.read_text(encoding="utf-8")
        told = re.search(r"/\*\n(.*?)\*/", text, re.S)[1].replace(" *", "").strip()
        body = self.linked(f"<pre><code class=\"c\">{html.escape(text, quote=False)}</code></pre>", here)
        self.write(here, path.name, f"<h1>{path.name}</h1>\n{body}")
        self.note(path.name, here, "Example", told)

    def write_file(self, name):
        path, here = ROOT / name, self.files[name]
        if not here.endswith(".html"):
            (self.out / here).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, self.out / here)
            return
        if path.is_dir():
            shown = [entry for entry in path.iterdir() if not entry.name.startswith((".", "__"))]
            inside = sorted(entry.name + ("/" if entry.is_dir() else "") for entry in shown)
            body = "<ul>" + "".join(f"<li>{self.in_folder(name, entry, here)}</li>" for entry in inside) + "</ul>"
        else:
            body = f"<pre><code>{html.escape(path.read_text(encoding='utf-8'), quote=False)}</code></pre>"
        self.write(here, name, f"<h1>{html.escape(name)}</h1>\n{body}")

    def in_folder(self, folder, entry, here):
        address = self.files.get(f"{folder}/{entry.rstrip('/')}")
        return f'<a href="{self.relative(address, here)}">{entry}</a>' if address else entry

    def write_gallery(self):
        here, items = "gallery/index.html", []
        (self.out / "gallery").mkdir(parents=True, exist_ok=True)
        listed = subprocess.run([self.command, "simulate", "--list", "--json"], capture_output=True, text=True,
                                check=True)
        scenes = [(f"scene:{scene['name']}", scene) for scene in json.loads(listed.stdout)["scenes"]]
        for name in UNNAMED:
            path = ROOT / f"examples/scenes/{name}.json"
            scenes.append((path, {"name": name, **json.loads(path.read_text(encoding="utf-8"))}))
        for scene, told in scenes:
            name, title, about = told["name"], told["title"], told["about"]
            page = self.out / "gallery" / f"{name}.html"
            seconds = ["--seconds", str(SECONDS[name])] if name in SECONDS else []
            done = subprocess.run([self.command, "simulate", scene, *seconds, "--times", "-o", page],
                                  capture_output=True, text=True)
            if done.returncode != 0:
                self.errors.append(f"gallery: {name}: {done.stderr.strip()}")
                continue
            items.append(f'<li><a href="{name}.html">{html.escape(title)}</a><br>{html.escape(about)}</li>')
            self.note(title, f"gallery/{name}.html", "Scene", about)
        items += self.write_plans()
        body = ("<h1>Scenes that play</h1><p>Each is a page by itself that <code>pirouette simulate</code> wrote: turn "
                "it by dragging, click a body to see its contacts and their normals. A table below tells what the "
                "updates of the run did, and how long that took. The last ones are plans, which <code>pirouette plan "
                "--page</code> wrote.</p>"
                f"<ul>{''.join(items)}</ul>")
        self.write(here, "Scenes that play", body)

    def write_plans(self):
        """Pages of plans; the items of the gallery's list."""
        items, models = [], load_models()
        for name, title, about, (robot, obstacle, *asked) in PLANS:
            page, paths = self.out / "gallery" / f"plan-{name}.html", []
            for model in (robot, obstacle):
                suffix = "off" if models[model].startswith("OFF") else "obj"
                paths.append(self.out / "gallery" / f"{model}.{suffix}")
                paths[-1].write_text(models[model], encoding="utf-8")
            done = subprocess.run([self.command, "plan", *paths, *asked, "--page", page], capture_output=True,
                                  text=True)
            for path in set(paths):
                path.unlink()
            if done.returncode != 0:
                self.errors.append(f"gallery: plan-{name}: {done.stderr.strip()}")
                continue
            items.append(f'<li><a href="{page.name}">{html.escape(title)}</a><br>{html.escape(about)}</li>')
            self.note(title, f"gallery/{page.name}", "Plan", about)
        return items

    # ---- the reference

    def uses(self, names, here):
        called = re.compile(rf"\b(?:{'|'.join(names)})\b")
        links = [f'<a href="{self.relative(f"examples/{path.stem}.html", here)}">{path.name}</a>' for path in EXAMPLES
                 if called.search(path.read_text(encoding="utf-8"))]
        return f'<p class="uses">Used in {", ".join(links)}.</p>' if links else ""

    def write_header(self, header):
        here = f"api/{header.name[:-2]}.html"
        out = [f"<h1>&lt;pirouette/{header.name}&gt;</h1>", header.description, contents(header)]
        self.note(header.name, here, "Reference", header.description)
        headings, blocks = [], []
        for item in header.items:  # functions under one comment stand together
            if blocks and item.kind == "function" and item.text and blocks[-1][0].text == item.text:
                blocks[-1].append(item)
            else:
                blocks.append([item])
        for block in blocks:
            first = block[0]
            out.append('<section class="item">')
            for item in block:
                headings.append((2, item.name, item.name))
                out.append(f'<h2 id="{item.name}">{item.name}</h2>')
                told = [body for _, body in [*first.parameters, *first.sections.items()] if body]
                self.note(item.name, f"{here}#{item.name}", header.name, " ".join([item.text or first.text, *told]))
            signature = "\n".join(html.escape(item.signature, quote=False) + ("" if item.kind == "define" else ";")
                                  for item in block)
            out += [f'<pre><code class="c">{signature}</code></pre>', first.description]
            if any(told for _, told in first.parameters) or first.kind == "enum":
                rows = "".join(f'<dt id="{name}"><code>{name}</code></dt><dd>{told or ""}</dd>'
                               if first.kind == "enum" else f"<dt><code>{name}</code></dt><dd>{told}</dd>"
                               for name, told in first.parameters if told or first.kind == "enum")
                out.append(f"<dl>{rows}</dl>")
            out += [f'<p class="section">{title}</p>{body}' for title, body in first.sections.items()]
            out.append(self.uses([item.name for item in block], here) if first.kind == "function" else "")
            out.append("</section>")
        self.write(here, header.name, self.linked("\n".join(out), here), headings)

    def write_names(self):
        here, out = "api/index.html", ["<h1>All names</h1>"]
        for header in self.headers:
            names = "".join(f'<li><a href="{header.name[:-2]}.html#{item.name}">{item.name}</a></li>'
                            for item in header.items)
            out.append(f'<h2 id="{header.name}"><a href="{header.name[:-2]}.html">{header.name}</a></h2>'
                       f'{header.description.partition("</p>")[0] + "</p>"}<ul class="names">{names}</ul>')
        self.write(here, "All names", self.linked("\n".join(out), here), [(2, h.name, h.name) for h in self.headers])

    def make(self):
        warnings = reference.run_doxygen(ROOT, self.out / "doxygen")
        self.errors += [line for line in warnings.split("\n") if line]
        self.headers = reference.read_headers(self.out / "doxygen")
        for header in self.headers:
            for item in header.items:
                for name in [item.name] + ([name for name, _ in item.parameters] if item.kind == "enum" else []):
                    self.symbols[name] = f"api/{header.name[:-2]}.html#{name}"
        for path in EXAMPLES:
            self.files[f"examples/{path.name}"] = f"examples/{path.stem}.html"
        for page, title in PAGES.items():
            self.write_page(page, title)
        for path in EXAMPLES:
            self.write_example(path)
        for header in self.headers:
            self.write_header(header)
        self.write_names()
        if self.command:
            self.write_gallery()
        for name in self.wanted:
            self.write_file(name)
        for name in ("site.css", "site.js"):
            shutil.copyfile(HERE / name, self.out / name)
        index = json.dumps(self.entries, ensure_ascii=False, separators=(",", ":"))
        (self.out / "search.js").write_text(f"const ENTRIES = {index};\n", encoding="utf-8")
        shutil.rmtree(self.out / "doxygen")


EXAMPLES = sorted((ROOT / "examples").glob("*.c"))
TEMPLATE = (HERE / "page.html").read_text(encoding="utf-8")


def main(out, command=None):
    out = pathlib.Path(out).resolve()
    shutil.rmtree(out, ignore_errors=True)
    site = Site(out, command and pathlib.Path(command).resolve())
    site.make()
    print(*site.errors, sep="\n", file=sys.stderr, end="\n" if site.errors else "")
    print(f"{out}/index.html: {sum(1 for _ in out.rglob('*.html'))} pages, {len(site.symbols)} names")
    return 1 if site.errors else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
