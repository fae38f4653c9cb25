#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""
Holds the help of the `pirouette` command, its manual pages and its completion against what it takes and against each
other: test_help.py COMMAND SOURCES PAGES [CLASS]
"""
import collections
import functools
import json
import os
import pty
import re
import select
import shutil
import subprocess
import sys
import tempfile
import textwrap
import unittest
from pathlib import Path

COMMAND = ""
SOURCES = Path()
PAGES = Path()


@functools.lru_cache(maxsize=None)
def run(*args):
    return subprocess.run([COMMAND, *args], capture_output=True, text=True, timeout=600, stdin=subprocess.DEVNULL)


def subcommands():
    """The names that the help lists."""
    listed = run("--help").stdout.split("subcommands:\n")[1].split("\n\n")[0]
    return re.findall(r"^  ([a-z]+) ", listed, re.M)


def plain(text):
    """The text with one blank between words, however its lines were broken."""
    return " ".join(text.split())


def wrapped(left, text, indent):
    """The text in lines of at most 80 columns that begin at column `indent`, and `left` before them."""
    lines = textwrap.wrap(plain(text), 80 - indent, break_long_words=False, break_on_hyphens=False)
    lines = [" " * indent + line for line in lines]
    return "\n".join([left, *lines] if len(left) >= indent > 0 else [left + lines[0][len(left):], *lines[1:]])


def option_table(text):
    """The options that a help text lists: from what stands on the left, `-o FILE`, to what it says."""
    listed = text.split("options:\n")[1].split("\n\n")[0]
    entries = re.findall(r"^  (-\S+(?:, -\S+)*(?: \S+)?)(?:  +|\n {8,})(.*(?:\n {8,}.*)*)", listed, re.M)
    return {left: plain(right) for left, right in entries}


def names(option):
    """The names in `-h, --help` or `-o FILE`."""
    return [part for part in option.replace(",", "").split() if part.startswith("-")]


def help_options(text):
    """The names of the options that a help text lists, with what stands for their values."""
    options = {}
    for left in option_table(text):
        words = left.split()
        options.update(dict.fromkeys(names(left), None if words[-1].startswith("-") else words[-1]))
    return options


class Help(unittest.TestCase):
    def help(self, *args):
        result = run(*args)
        self.assertEqual((result.returncode, result.stderr), (0, ""), args)
        return result.stdout

    def test_every_way_to_ask_for_help_answers_on_stdout(self):
        self.assertEqual(subcommands()[0], "info")
        general = self.help("--help")
        self.assertEqual(general, self.help("-h"))
        self.assertEqual(general, self.help("help"))
        for name in subcommands():
            text = self.help(name, "--help")
            self.assertTrue(text.startswith(f"usage: pirouette {name} "), name)
            self.assertEqual(text, self.help(name, "-h"))
            self.assertEqual(text, self.help("help", name))
            # help also comes when the arguments before it make no sense
            self.assertEqual(text, self.help(name, "--json", "-h", "--nosuch") if name != "help" else text)

    def test_help_of_what_does_not_exist_is_refused(self):
        for args, named in ((["help", "nosuch"], "nosuch"), (["help", "sum", "track"], "track"), (["help", "-x"], "-x"),
                            (["sum", "--help=3"], "--help"), (["sum", "-h=3"], "-h"), (["-x"], "-x")):
            result = run(*args)
            self.assertEqual((result.returncode, result.stdout), (2, ""), args)
            self.assertEqual(result.stderr.count("\n"), 1)
            self.assertIn(named, result.stderr)

    def test_text_is_wrapped_at_80_columns(self):
        for args in (["--help"], *(["help", name] for name in subcommands())):
            for paragraph in self.help(*args)[:-1].split("\n\n"):
                heading, *rest = paragraph.split("\n", 1)
                if heading == "subcommands:":
                    expected = [wrapped(f"  {name}", text, 17) for name, text in re.findall(
                        r"^  (\S+) +(.*(?:\n {8}.*)*)", rest[0], re.M)]
                elif heading == "options:":
                    expected = [wrapped(f"  {left}", text, 28) for left, text in option_table(paragraph).items()]
                elif heading == "examples:":
                    expected = [line if line.startswith("  pirouette ") else wrapped("     ", line, 6)
                                for line in rest[0].splitlines()]
                else:
                    self.assertEqual(paragraph, wrapped("", paragraph, 0), args)
                    continue
                self.assertGreater(len(expected), 0)
                self.assertEqual(rest[0], "\n".join(expected), args)

    def test_the_parser_takes_the_options_of_the_help_and_no_others(self):
        written = set()
        for source in SOURCES.glob("*.c"):
            for literal in re.findall(r'"((?:-[a-z-]*[a-z](?:, )?)+)"', source.read_text()):
                written.update(literal.split(", "))
        self.assertIn("--quat", written)
        for name in subcommands():
            listed = help_options(self.help("help", name))
            self.assertLessEqual({"-h", "--help"}, set(listed))
            for option in written | set(listed):
                result = run(name, option)
                self.assertEqual("unknown option" in result.stderr, option not in listed, f"{name} {option}")
                # at the end of the line an option that takes a value misses it
                self.assertEqual("has no value" in result.stderr, bool(listed.get(option)), f"{name} {option}")

    def prepare(self, line, folder):
        """The files that an example reads."""
        if " slices.h5" in line and "-o slices.h5" not in line:
            run("slice", "shape:cube", "shape:octahedron", "--axis", "1,2,3", "--steps", "20", "-o",
                folder / "slices.h5")
        if " cube.turn" in line and "-o cube.turn" not in line:
            run("slice", "shape:cube", "shape:octahedron", "--axis", "1,2,3", "--critical", "-o", folder / "cube.turn")
        if "poses.csv" in line:
            (folder / "poses.csv").write_text("0,0,0,1,3,0,0\n1,0,0,1,0,0,0\n")
        for history in re.findall(r"replay (\S+)", line):
            subprocess.run([os.environ["PIR_WRITE_HISTORY"], folder / history], check=True, timeout=600)
        for scene in re.findall(r"simulate (\S+)", line):
            bodies = [{"shape": "cube", "kind": "static"}, {"shape": "cube", "position": [0, 0, 2.5]}]
            (folder / scene).write_text(json.dumps({"shapes": {"cube": {"model": "shape:cube"}}, "bodies": bodies}))

    def test_the_examples_of_the_help_run(self):
        count = 0
        for name in subcommands():
            for line in re.findall(r"^  pirouette (.*)$", self.help("help", name).split("examples:\n")[1], re.M):
                count += 1
                with tempfile.TemporaryDirectory() as folder:
                    self.prepare(line, Path(folder))
                    result = subprocess.run(["/bin/sh", "-c", f'"$0" {line}', COMMAND], cwd=folder, capture_output=True,
                                            text=True, timeout=600)
                    if ".h5" in line and "no HDF5" in result.stderr:
                        continue  # in this build
                    self.assertEqual((result.returncode, result.stderr), (0, ""), line)
                    for written in re.findall(r"(?:-o|--plot|--dump) (\S+)", line):
                        self.assertTrue((Path(folder) / written).exists(), line)
        self.assertGreaterEqual(count, len(subcommands()))


def roff(text):
    """How a manual page writes a text."""
    escapes = {"\\": "\\e", "-": "\\-", "'": "\\(aq", "`": "\\(ga", "^": "\\(ha", "~": "\\(ti"}
    text = "".join(escapes.get(character, character) for character in text)
    return "\\&" + text if text.startswith(".") else text


def expected_page(text):
    """The source of the manual page that says what this help says, without changes of font."""
    general = run("--help").stdout
    parts = collections.defaultdict(list)  # of the help, by what they begin with
    for paragraph in text[:-1].split("\n\n"):
        start = re.match(r"usage|subcommands|options|examples|A MODEL|Exit status|pirouette help|", paragraph)[0]
        parts[start].append(paragraph)
    usage = parts["usage"][0].removeprefix("usage: ")
    words = [roff(plain(paragraph)) for paragraph in parts[""]]
    name = "pirouette" if text == general else "-".join(usage.split()[:2])
    models, status = (re.search(rf"^{start}((?:.|\n)*?)(?=\n\n|\n\Z)", general, re.M)[1]
                      for start in ("(?=A MODEL)", "Exit status: "))
    lines = [f'.TH {roff(name.upper())} 1 "" "{run("--version").stdout.strip()}" "User Commands"', ".SH NAME"]
    what = words[0] if text != general else "exact Minkowski sums of rotating convex polyhedra"
    lines += [roff(name) + r" \- " + what, ".SH SYNOPSIS", roff(usage), ".SH DESCRIPTION", words[-1]]
    if re.search(r"\b(MODEL|P|ROBOT|SUBCOMMAND \[ARG)", usage):
        lines += [".PP", roff(plain(models))]
    if text == general:
        lines += [".SH SUBCOMMANDS"]
        for subcommand in subcommands():
            summary = run("help", subcommand).stdout.split("\n\n")[1]
            lines += [".TP", roff(f"pirouette-{subcommand}") + "(1)", roff(plain(summary))]
    lines += [".SH OPTIONS"]
    for left, right in option_table(text).items():
        lines += [".TP", roff(left), roff(right)]
    for paragraph in parts["examples"]:
        lines += [".SH EXAMPLES"]
        for line, what in re.findall(r"^  (pirouette .*)\n {6}(.*(?:\n {6}.*)*)", paragraph, re.M):
            lines += [".PP", ".nf", roff(line), ".fi", ".RS 4", roff(plain(what)), ".RE"]
    lines += [".SH EXIT STATUS", roff(plain(status))]
    if text != general:
        lines += [".SH SEE ALSO", "pirouette(1)"]
    return "\n".join(lines) + "\n"


class Manual(unittest.TestCase):
    def pages(self):
        """Each page with the help that it stands for."""
        self.assertEqual(sorted(page.name for page in PAGES.glob("*.1")),
                         sorted(["pirouette.1", *(f"pirouette-{name}.1" for name in subcommands())]))
        yield "pirouette.1", run("--help").stdout
        for name in subcommands():
            yield f"pirouette-{name}.1", run("help", name).stdout

    def test_a_page_says_what_the_help_says(self):
        for name, text in self.pages():
            page = (PAGES / name).read_text()
            self.assertEqual(re.sub(r"\\f[BIR]", "", page), expected_page(text), name)

    def test_fonts_begin_and_end_in_a_line(self):
        for name, text in self.pages():
            for line in (PAGES / name).read_text().splitlines():
                closed = re.sub(r"\\f[BI][^\\]*(?:\\[-e(][^\\]*)*\\fR", "", line)
                self.assertNotIn("\\f", closed, f"{name}: {line}")
            for left in option_table(text):
                option, *value = left.rsplit(" ", 1) if not left.split()[-1].startswith("-") else [left]
                tag = f"\n\\fB{roff(option)}\\fR" + "".join(f" \\fI{roff(word)}\\fR" for word in value) + "\n"
                self.assertIn(tag, (PAGES / name).read_text(), name)

    def test_a_page_that_cannot_be_right_ends_the_build(self):
        """What writes the pages, with names and places that are wrong."""
        script = SOURCES / "pages" / "completion.bash"
        good = ["pirouette", "pirouette.1", *(f"pirouette-{name}.1" for name in subcommands())]
        with tempfile.TemporaryDirectory() as folder:
            for files, names, says in (
                (script, good, ""),
                (script, good[:-1], f"no page of the subcommand {subcommands()[-1]}"),
                (script, [*good[:2], *good[3:]], f"no page of the subcommand {subcommands()[0]}"),
                (script, [*good, "pirouette-nosuch.1"], "no subcommand has the page pirouette-nosuch.1"),
                (script, ["nosuch/pirouette.1"], "cannot open "),
                (Path(folder) / "nosuch.bash", good, "cannot write "),
            ):
                result = subprocess.run([PAGES / "write_pages", files, *names], cwd=folder, capture_output=True,
                                        text=True, timeout=600)
                self.assertEqual((result.returncode, result.stderr.count("\n")), (1, 1) if says else (0, 0), names)
                self.assertIn(says, result.stderr)
            for name in good[:2]:
                full = Path(folder) / "full"
                full.mkdir(exist_ok=True)
                (full / name).symlink_to("/dev/full")
                result = subprocess.run([PAGES / "write_pages", script, full / name], capture_output=True,
                                        text=True, timeout=600)
                self.assertEqual(result.returncode, 1)
                self.assertIn("cannot write ", result.stderr)

    def test_roff_has_no_complaint_about_a_page(self):
        if not shutil.which("groff"):
            self.skipTest("groff is not installed")
        for name, _ in self.pages():
            result = subprocess.run(["groff", "-man", "-ww", "-Tutf8", "-rLL=78n", PAGES / name], capture_output=True,
                                    text=True, timeout=600)
            self.assertEqual((result.returncode, result.stderr), (0, ""), name)
            self.assertIn("EXIT STATUS", re.sub("\x1b[^m]*m|.\b", "", result.stdout))


# Calls the completion for each line of stdin as bash does, and prints the replies in one line.
COMPLETE = """
compopt() { :; }
source "$1"
while IFS= read -r COMP_LINE; do
    COMP_POINT=${#COMP_LINE} COMP_WORDS=("$2") COMPREPLY=()
    _pirouette
    printf '%s\n' "${COMPREPLY[*]}"
done
"""


@unittest.skipUnless(shutil.which("bash"), "bash is not installed")
class Completion(unittest.TestCase):
    def complete(self, *lines):
        """What may follow each of these lines."""
        with tempfile.TemporaryDirectory() as folder:
            for name in ("a.off", "b c.off", "sheep.off"):
                (Path(folder) / name).touch()
            (Path(folder) / "shelf").mkdir()
            result = subprocess.run(["bash", "--norc", "-c", COMPLETE, "bash", PAGES / "pirouette", COMMAND],
                                    input="".join(line + "\n" for line in lines), cwd=folder, capture_output=True,
                                    text=True, timeout=600)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        replies = [line.split(" ") if line else [] for line in result.stdout.splitlines()]
        self.assertEqual(len(replies), len(lines))
        return replies

    def test_subcommands_and_options_are_those_of_the_help(self):
        known = subcommands()
        replies = self.complete("pirouette ", "pirouette help ", "pirouette -",
                                *(f"pirouette {name} -" for name in known))
        self.assertEqual(replies[:2], [known, known])
        for args, reply in zip((["--help"], *(["help", name] for name in known)), replies[2:]):
            self.assertEqual(sorted(reply), sorted(help_options(run(*args).stdout)), args)

    def test_a_value_is_not_taken_for_an_argument_and_words_are_offered(self):
        for name in subcommands():
            for option, value in help_options(run("help", name).stdout).items():
                words = [word for word in (value or "").split("|") if re.fullmatch("[a-z]+", word)]
                beside, inside, after = self.complete(f"pirouette {name} {option} ", f"pirouette {name} {option}=",
                                                      f"pirouette {name} {option} x -")
                if value and not value.startswith(("FILE", "DIR")):
                    self.assertEqual((beside, inside), (words, words), f"{name} {option}")
                self.assertIn("--help", after)

    def test_what_follows_the_cursor_and_the_breaks_of_words(self):
        cases = {
            "pirouette sum --method w": ["walk"],
            "pirouette sum --method=w": ["walk"],
            "pirouette --": ["--help", "--version"],
            "pirouette sum shape:cub": ["cube", "cuboctahedron"],
            "pirouette sum a.off s": ["sheep.off", "shelf/", "shape:"],
            "pirouette sum a.off shape:tr": ["truncated-tetrahedron"],
            "pirouette sum a.off a.off shape:": [],
            "pirouette sum --axis 0,0,1 a.off sha": ["shape:"],
            "pirouette sum -- --me": [],
            "pirouette shape cub": ["cube", "cuboctahedron"],
            "pirouette help tr": ["track"],
            "pirouette track a.off a.off --dump sh": ["shelf/"],
            "pirouette info a": [],  # bash's own completion of files follows
            "pirouette nosuch -": [],
        }
        for line, expected, reply in zip(cases, cases.values(), self.complete(*cases)):
            if line == "pirouette sum a.off shape:tr":
                self.assertIn(expected[0], reply)
            else:
                self.assertEqual(reply, expected, line)

    def test_a_terminal_completes(self):
        """Types into an interactive bash, and reads what the command line becomes."""
        process, terminal = pty.fork()
        if process == 0:
            os.chdir(Path(COMMAND).parent)
            os.environ.update(PS1="$ ", TERM="dumb", INPUTRC="/dev/null", HISTFILE="", PATH=f".:{os.environ['PATH']}")
            os.execvp("bash", ["bash", "--norc", "--noprofile", "-i"])
        try:
            os.write(terminal, f"source '{PAGES / 'pirouette'}'; echo rea''dy\n".encode())
            self.read_until(terminal, "ready")
            os.write(terminal, b"pirouette su\tshape:icosah\tshape:dodec\t--method=wal\t--js\t\x01echo [\x05]\n")
            self.assertIn("\n[pirouette sum shape:icosahedron shape:dodecahedron --method=walk --json ]",
                          self.read_until(terminal, "\n["))
        finally:
            os.close(terminal)
            os.waitpid(process, 0)

    def read_until(self, terminal, text):
        """What the terminal shows, up to this text and the rest of its line."""
        seen = ""
        while not re.search(re.escape(text) + r".*\n", seen):
            self.assertTrue(select.select([terminal], [], [], 30)[0], f"{text!r} does not come after {seen!r}")
            seen += os.read(terminal, 4096).decode().replace("\r", "")
        return seen


if __name__ == "__main__":
    COMMAND = str(Path(sys.argv[1]).resolve())
    SOURCES = Path(sys.argv[2]).resolve()
    PAGES = Path(sys.argv[3]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
