# SPDX-License-Identifier: MIT
"""The test of the house finds what it is for: a small tree without a breach, and that tree with each kind of breach
planted.

Usage: test_house.py
"""
import contextlib
import io
import pathlib
import tempfile
import unittest

import c_text
import house

CLEAN = {
    "ARCHITECTURE.md": "# Architecture\n\n```rooms\nsrc/low   numbers\nsrc/high  bodies\n```\n",
    "include/pirouette/body.h": "PIR_API void pir_body_move(pir_body *body, double x);\n",
    "src/low/number.h": "int pir_number_add(int a, int b);\n",
    "src/low/number.c": '#include "low/number.h"\n\nint pir_number_add(int a, int b) {\n    return a + b;\n}\n',
    "src/high/body.h": '#include "low/number.h"\n\nvoid pir_body_turn(void);\n',
    "src/high/body.c": '#include "high/body.h"\n\nvoid pir_body_turn(void) {\n}\n',
    "tools/main.c": '#include "args.h"\n#include <pirouette/body.h>\n\nint main(void) {\n    return 0;\n}\n',
    "tools/args.h": "int read_args(int count, char **words);\n",
    "tests/unit/test_body.c": '#include "high/body.h"\n',
    "tests/oracle/points.c": '#include "oracle/points.h"\n',
    "docs/a.md": "| " + "x" * 150 + " |\n",
}


def lines(*texts):
    return "\n".join(texts) + "\n"


class Planted(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for name, text in CLEAN.items():
            self.write(name, text)

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def assert_found(self, *expected):
        """Exactly these breaches, each as FILE:LINE: RULE."""
        found = [f"{breach.file}:{breach.line}: {breach.rule}" for breach in house.breaches(self.root)]
        self.assertEqual(sorted(found), sorted(expected))

    def planted(self, name, text, *expected):
        self.write(name, text)
        self.assert_found(*expected)

    def test_clean(self):
        self.assert_found()

    def test_room_that_is_not_listed(self):
        self.planted("src/high/new/a.c", "", "src/high/new/a.c:1: rooms")

    def test_listed_room_that_is_not_there(self):
        text = CLEAN["ARCHITECTURE.md"].replace("src/high", "src/none\nsrc/high")
        self.planted("ARCHITECTURE.md", text, "ARCHITECTURE.md:5: rooms")

    def test_arrow_upwards(self):
        self.planted("src/low/number.c", lines("", '#include "low/number.h"', '#include "high/body.h"'),
                     "src/low/number.c:3: arrows")

    def test_include_from_no_room(self):
        self.planted("src/high/body.c", lines('#include "body.h"'), "src/high/body.c:1: arrows")

    def test_public_header_shows_an_internal_one(self):
        self.planted("include/pirouette/body.h", lines('#include "low/number.h"'), "include/pirouette/body.h:1: arrows")

    def test_outside_includes_an_internal_header(self):
        for name in ("tools/main.c", "bench/a.cpp", "examples/a.c", "tests/oracle/points.c"):
            with self.subTest(name):
                before = CLEAN.get(name, "")
                self.planted(name, lines('#include "low/number.h"'), f"{name}:1: arrows")
                self.write(name, before)

    def test_kernels_benchmark_may_include_an_internal_header(self):
        self.planted(house.INTERNAL_BENCHMARKS[0], lines('#include "low/number.h"'))

    def test_header_of_three_files(self):
        for name in ("one", "two", "three"):
            self.write(f"src/low/{name}.c", lines(f"int pir_{name}(void) {{", "    return 1;", "}"))
        self.planted("src/low/all.h", lines("int pir_one(void);", "int pir_two(void);"))
        self.planted("src/low/all.h",
                     lines("int pir_one(void);", "enum kind pir_two(int a,", "  int b);", "int *pir_three(void);"),
                     "src/low/all.h:1: declares")

    def test_header_of_another_room(self):
        self.planted("src/high/other.h", lines("int pir_number_add(int a, int b);"), "src/high/other.h:1: declares")

    def test_comment_of_a_member_that_the_reference_does_not_show(self):
        self.planted("include/pirouette/body.h", lines("struct pir_pair {", "    int a; /**< shown */", "};"))
        for comment in ("/* < hidden */", "/*< hidden */"):
            with self.subTest(comment):
                self.planted("include/pirouette/body.h", lines("struct pir_pair {", f"    int a; {comment}", "};"),
                             "include/pirouette/body.h:2: marks")

    def test_long_file(self):
        for name in ("docs/long.md", "src/low/long.c", "tests/long.py"):
            with self.subTest(name):
                self.planted(name, "\n" * house.MAX_LINES)
                self.planted(name, "\n" * (house.MAX_LINES + 1), f"{name}:{house.MAX_LINES + 1}: length")
                self.write(name, "")

    def test_long_files_of_machines(self):
        self.planted("tests/fuzz/corpus/a.txt", "\n" * (house.MAX_LINES + 1))

    def test_wide_line(self):
        for name in ("docs/wide.md", "src/low/wide.c", "tools/meson.build", "ARCHITECTURE.md", "bench/smoke.py"):
            with self.subTest(name):
                before = CLEAN.get(name, "")
                comment = "# " if name.endswith((".py", ".build")) else "//"
                widest = before + comment + "é" * (house.MAX_WIDTH // 2 - 1)
                self.planted(name, widest + "\n")
                self.planted(name, widest + "x\n", f"{name}:{before.count(chr(10)) + 1}: width")
                self.write(name, before)

    def test_function_of_eight_parameters(self):
        seven = "int a, int b, int c, int (*d)(int, int), int e, int f,\n       int g"
        head = "static inline enum kind\npir_many("
        self.planted("src/low/many.h", lines("", head + seven + ") {", "}"))
        self.planted("src/low/many.h", lines("", head + seven + ", int h) {", "}"), "src/low/many.h:2: parameters")
        self.write("src/low/many.h", "")
        for name, text in (
                ("bench/many.cpp", "namespace {\nint many(" + seven + ", int h) {\n}\n}\n"),
                ("src/low/macro.c", "\n#define MANY(a, b, c, d, \\\n             e, f, g, h) (a)\n"),
                ("src/low/made.c", "\nstatic int NAME(many)(" + seven + ", int h) {\n}\n"),
                ("tests/many.py", "\ndef many(a, b, c, d, e, *, f, g, h):\n    pass\n")):
            with self.subTest(name):
                self.planted(name, text, f"{name}:2: parameters")
                self.write(name, "")

    def test_two_files_of_one_name(self):
        self.planted("src/high/number.h", "", "src/low/number.c:1: names", "src/low/number.h:1: names")

    def test_two_files_of_one_name_in_tools(self):
        self.planted("tools/pages/main.c", "", "tools/pages/main.c:1: names")

    def test_two_types_of_one_name(self):
        self.write("include/pirouette/kinds.h", lines("typedef enum pir_kind {", "    PIR_ONE,", "} pir_kind;"))
        self.write("src/high/kept.h", lines("typedef struct pir_kept pir_kept;"))
        self.planted("src/high/kept.c", lines("struct pir_kept {", "};", "struct side {", "};"))
        for text in ("struct pir_kept {", "enum side {", "typedef int pir_kind;", "typedef int (*side)(int a);"):
            with self.subTest(text):  # of two files the later one is named
                end = "};" if text.endswith("{") else ""
                self.planted("src/low/kept_too.h", lines("", text, end), "src/low/kept_too.h:2: types")

    def test_comment_without_a_noun(self):
        for text in ("/* What is left. */", "/*", "/** The same for Q. */", "    /* The same", "/*\n * What is left."):
            with self.subTest(text):
                end = [] if text == "/*" else [f"src/low/number.h:{2 + text.count(chr(10))}: comments"]
                self.planted("src/low/number.h", lines("", text), *end)
        self.planted("src/low/number.h", lines("/* The rest, whatever it is. What else? */", "int what; /* What? */"))

    def test_report(self):
        """The program names each breach and fails, and passes without one."""
        for text, status, said in (("", 0, "0 breaches"), ("x" * 121, 1, "docs/wide.md:1: width: 121 bytes")):
            self.write("docs/wide.md", text)
            output = io.StringIO()
            with contextlib.redirect_stdout(output):
                self.assertEqual(house.main(self.root), status)
            self.assertIn(said, output.getvalue())


class Declarations(unittest.TestCase):
    def test_functions(self):
        found = c_text.functions(lines(
            "/* int no(void); */", '#define TEXT "int none(int a);"', "struct body {", "    int (*call)(int a);", "};",
            "typedef int (*callback)(int a);", "static const struct body empty = {make(1)};", "int first(void);",
            "static double second(struct pair a[2], double (*b)(int)) {", "    return third(a);", "}", 'extern "C" {',
            "struct body *fourth(int a, int b);", "}", "__attribute__((cold)) void fifth(int a) {", "}"))
        self.assertEqual([(function.name, function.line, function.parameters, function.defined) for function in found],
                         [("first", 8, 0, False), ("second", 9, 2, True), ("fourth", 13, 2, False),
                          ("fifth", 15, 1, True)])

    def test_types(self):
        found = c_text.types(lines(
            "/* struct no { int a; }; */", "typedef int first;", "typedef int second __attribute__((aligned(8)));",
            "typedef int (*third)(int a, struct b c);", "typedef bool fourth(void *x);", "typedef struct made made;",
            "typedef struct fifth {", "    struct inner {", "        int a;", "    } b;", "} fifth;",
            "typedef enum {", "    A,", "} sixth;", "static const struct seventh {", "    int a;", "} all[3] = {{1}};",
            "int make(void) {", "    struct within {", "        int a;", "    } b;", "}", "struct made;",
            "typedef uint8_t eighth[4];", "union ninth {", "    int a;", "};"))
        self.assertEqual([name for name, _ in found],
                         ["first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth"])
        self.assertEqual(found[4], ("fifth", 7))


if __name__ == "__main__":
    unittest.main()
