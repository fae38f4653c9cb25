#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measured numbers in the pages are those of the committed tables, and every table of numbers says where it is from.

Usage: test_figures.py ROOT
"""
import pathlib
import re
import shutil
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path[:0] = [str(ROOT / "docs" / "figures"), str(ROOT / "docs" / "site")]
import figures  # noqa: E402
import inline  # noqa: E402
import markdown  # noqa: E402
import results  # noqa: E402
import tables  # noqa: E402

BENCHMARK = re.compile(r"^benchmark\('(\w+)'", re.M)


class Planted(unittest.TestCase):
    """A copy of the pages and the tables in which something is wrong."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = pathlib.Path(self.folder.name)
        shutil.copytree(ROOT / "docs", self.root / "docs", ignore=shutil.ignore_patterns("img", "__pycache__"))
        shutil.copytree(ROOT / "bench" / "results", self.root / "bench" / "results",
                        ignore=shutil.ignore_patterns("*.svg"))
        shutil.copy(ROOT / "README.md", self.root)
        for path in (ROOT / "tests").rglob("meson.build"):
            copy = self.root / path.relative_to(ROOT)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, copy)

    def change(self, name, before, after):
        path = self.root / name
        text = path.read_text(encoding="utf-8")
        self.assertIn(before, text)
        path.write_text(text.replace(before, after, 1), encoding="utf-8")

    def wrong(self):
        return "\n".join(figures.differences(self.root)[0])

    def test_a_table_that_was_measured_again_is_missed_in_the_page(self):
        self.change("bench/results/amd-epyc-2-cores/growth.csv", "5,720,23605,", "5,720,99999,")
        self.assertIn("docs/queries.md", self.wrong())
        figures.rewrite(self.root)
        self.assertEqual(self.wrong(), "")

    def test_a_number_that_was_typed_is_missed(self):
        path = self.root / "README.md"
        text = path.read_text(encoding="utf-8")
        path.write_text(re.sub(r"(<!--=readme.update-->)[\d.]+", r"\g<1>0.1", text), encoding="utf-8")
        self.assertIn("0.1", self.wrong())

    def test_a_row_that_was_added_is_missed(self):
        self.change("docs/queries.md", "| cube |", "| cuboid | 1 | 1 | 1 |\n| cube |")
        self.assertIn("cuboid", self.wrong())

    def test_a_table_of_numbers_without_a_mark_is_found(self):
        self.change("docs/queries.md", "<!-- figures: whole -->\n", "")
        self.assertIn("a table of numbers without a mark", self.wrong())

    def test_a_time_without_a_mark_is_found(self):
        self.change("docs/queries.md", "## Limits", "An update takes 3 µs.\n\n## Limits")
        self.assertIn("a time without a mark", self.wrong())

    def test_a_mark_that_would_end_a_paragraph_is_found(self):
        self.change("docs/queries.md", "## Limits", "It takes\n<!--=readme.update-->1<!--/--> µs.\n\n## Limits")
        self.assertIn("at the beginning of a line", self.wrong())

    def test_a_test_that_is_not_there_is_found(self):
        self.change("docs/guarantees.md", "tested: golden histories", "tested: silver histories")
        self.assertIn("there is no test silver histories", self.wrong())

    def test_a_peer_that_was_not_there_leaves_its_cells_empty(self):
        path = self.root / "bench/results/amd-epyc-2-cores/pairs.csv"
        lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
        path.write_text("".join(line for line in lines if ",coal " not in line), encoding="utf-8")
        self.assertIn("–", tables.pairs(results.Results(self.root)))

    def test_names_and_tables_that_are_not_there_end_it(self):
        for mark in ("<!--=readme.upsilon-->1<!--/-->", "<!-- figures: nothing -->"):
            with self.subTest(mark), self.assertRaises(results.Figures):
                figures.filled(f"here\n{mark}\n", results.Results(self.root), "README.md")


class Pages(unittest.TestCase):
    def test_pages_say_what_the_tables_hold(self):
        found, marks = figures.differences(ROOT)
        self.assertEqual(found, [])
        self.assertGreater(marks, 90)

    def test_no_table_and_no_figure_is_without_a_page(self):
        text = "".join(path.read_text(encoding="utf-8") for path in figures.pages(ROOT))
        self.assertEqual([name for name in tables.TABLES if f"<!-- figures: {name} -->" not in text], [])
        self.assertEqual([name for name in inline.FIGURES if f"<!--={name}-->" not in text], [])

    def test_readme_names_each_benchmark(self):
        names = {name for path in (ROOT / "bench").rglob("meson.build") for name in BENCHMARK.findall(path.read_text())}
        text = (ROOT / "README.md").read_text(encoding="utf-8")
        self.assertGreater(len(names), 15)
        self.assertEqual([name for name in sorted(names) if f"`{name}`" not in text], [])

    def test_no_mark_is_in_the_site(self):
        for path in figures.pages(ROOT):
            body, _ = markdown.render(path.read_text(encoding="utf-8"), lambda address: address)
            self.assertNotIn("&lt;!--", body, path)
            self.assertEqual(body.count("<table>"), len(re.findall(r"^\|[ :|-]+\|$", path.read_text(), re.M)), path)


class Numbers(unittest.TestCase):
    def test_two_digits_or_all_before_the_point(self):
        self.assertEqual([results.short(x) for x in (0.125, 0.996, 1.25, 9.96, 1234.5)],
                         ["0.12", "1.0", "1.2", "10", "1,234"])
        self.assertEqual([results.two(x) for x in (0.055, 1, 2.25, 99.6, 4321)], ["0.055", "1", "2.2", "100", "4,321"])

    def test_powers_of_ten(self):
        self.assertEqual([results.power(x) for x in ("0", "2.3e-16", "6.1e-301", "6.603e+06")],
                         ["0", "2.3·10⁻¹⁶", "6.1·10⁻³⁰¹", "6.6·10⁶"])

    def test_exponents_are_fitted(self):
        self.assertAlmostEqual(results.slope((1, 2, 4, 9), (3, 12, 48, 243)), 2)

    def test_a_mean_stands_beside_a_median_where_there_is_one(self):
        self.assertEqual(results.both({"a": "1500", "b": "2500"}, "a", "b"), "1.5 / 2.5")
        self.assertEqual(results.both({"a": "1500"}, "a", "b"), "1.5")


if __name__ == "__main__":
    unittest.main()
