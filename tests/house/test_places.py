# SPDX-License-Identifier: MIT
"""Adding things takes few places, those that CONTRIBUTING.md lists: a subcommand, a format of models and a kind of
query are added to a copy of the tree, which is built and tested.

Usage: test_places.py ROOT
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv[1])
WITHOUT = ("build", "build-*", ".git", "__pycache__", "results", "corpus")

COMMAND = """/* SPDX-License-Identifier: MIT */
/* pirouette corners: how many vertices a model has. */
#include "cmd.h"
#include "message.h"
#include "model.h"

SUBCOMMAND(corners) {
    pir_surface surface;
    pir_polytope *polytope = model_load(args, 0, &surface);
    if (!polytope)
        return EXIT_BAD_INPUT;
    say("%u corners\\n", (unsigned)pir_polytope_vertex_count(polytope));
    pir_polytope_release(polytope);
    return EXIT_DONE;
}
"""
COMMAND_OPTIONS = """command_run cmd_corners;
static const struct option corners_options[] = {
    MODEL_OPTIONS,
};

"""
COMMAND_ROW = """    {
        .name = "corners",
        .run = CORE(cmd_corners),
        .positional = {"MODEL"},
        .required = 1,
        .summary = "how many vertices a model has",
        .options = corners_options,
        .examples = {{"corners shape:cube", "the vertices of a cube"}},
    },
"""
COMMAND_TEST = """# SPDX-License-Identifier: MIT
from command_test import CommandTest, main


class Corners(CommandTest):
    def test_cube(self):
        self.assertEqual(self.good("corners", "shape:cube"), "8 corners\\n")


if __name__ == "__main__":
    main()
"""

READER = """/* SPDX-License-Identifier: MIT */
/* Reading XYZ: a point a line. */
#include "polytope/read/readers.h"
#include "polytope/read/text.h"

pir_status pir_read_xyz(const char *data, size_t size, struct pir_model *model) {
    struct pir_text text;
    pir_text_init(&text, data, size, model->name, model->report);
    while (pir_text_next(&text, false)) {
        double value[3];
        for (int i = 0; i < 3; i++) {
            if (i > 0 && !pir_text_next(&text, true))
                return pir_text_fail(&text, PIR_ERR_FORMAT, "a point has no 3 numbers");
            pir_status status = pir_text_number(&text, model->point_count + 1, &value[i]);
            if (status != PIR_OK)
                return status;
        }
        pir_status status = pir_model_add_point(model, (pir_vec3){value[0], value[1], value[2]});
        if (status != PIR_OK)
            return status;
    }
    return PIR_OK;
}
"""
READER_TEST = """static void test_points_of_xyz(void **state) {
    (void)state;
    pir_file_bytes file = {"0 0 0\\n1 0 0\\n0 1 0\\n0 0 1\\n", 24, "m", "XYZ"};
    pir_polytope *polytope = NULL;
    assert_int_equal(pir_polytope_read_bytes(&file, NULL, NULL, NULL, &polytope), PIR_OK);
    assert_int_equal(pir_polytope_vertex_count(polytope), 4);
    pir_polytope_release(polytope);
}

"""

QUERY_HEADER = """/**
 * The sum of the distance and the largest distance of P and Q.
 *
 * input  where P is.
 *
 * Cost: O(size of the sum).
 *
 * Errors: those of pir_query_largest_distance.
 */
PIR_API pir_status pir_query_both_distances(pir_query *query, const pir_query_input *input,
                                            pir_query_result *ret_result);

"""
QUERY = """
pir_status pir_query_both_distances(pir_query *query, const pir_query_input *input, pir_query_result *ret_result) {
    pir_query_result least, most;
    if (!ret_result)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_query_distance(query, input, NULL, &least);
    if (status == PIR_OK)
        status = pir_query_largest_distance(query, input, &most);
    if (status != PIR_OK)
        return status;
    most.distance += least.distance;
    *ret_result = most;
    return PIR_OK;
}
"""
QUERY_KIND = """static pir_status both_distances(const test_question *q, test_answer *a) {
    return pir_query_both_distances(q->query, q->input, RESULT);
}

"""


def defining(root, function):
    """The file of src that defines a function."""
    return next(path for path in sorted((root / "src").rglob("*.c"))
                if re.search(rf"^pir_status {function}\(", path.read_text(), re.M))


class Copy:
    """A copy of the tree. What is added to it is counted in files."""

    def __init__(self, root):
        self.root, self.changed = root, set()

    def add(self, name, text):
        (self.root / name).write_text(text)
        self.changed.add(name)

    def before(self, name, place, text):
        """Puts a text before the only `place` in a file."""
        old = (self.root / name).read_text()
        assert old.count(place) == 1, (name, place)
        self.add(name, old.replace(place, text + place))

    def run(self, *command):
        done = subprocess.run(command, cwd=self.root, capture_output=True, text=True)
        assert done.returncode == 0, f"{command}\n{done.stdout[-3000:]}{done.stderr[-3000:]}"
        return done.stdout

    def test(self, *names):
        self.run("meson", "test", "-C", "build", "--no-rebuild", "--print-errorlogs", *names)


def add_subcommand(copy):
    copy.add("tools/cmd_corners.c", COMMAND)
    copy.before("tools/command_table.c", "command_run cmd_help;", COMMAND_OPTIONS)
    copy.before("tools/command_table.c", '    {\n        .name = "help",', COMMAND_ROW)
    copy.add("tests/cli/test_corners.py", COMMAND_TEST)
    copy.before("docs/command.md", "\n## Text", "- `corners` prints no JSON.\n")


def add_format(copy):
    copy.add("src/polytope/read/read_xyz.c", READER)
    line = next(line for line in (copy.root / "include/pirouette/io.h").read_text().splitlines(True)
                if line.strip().startswith("FORMAT("))
    copy.before("include/pirouette/io.h", line, line.replace(line.split("(")[1].split(")")[0], "xyz"))
    copy.before("tests/unit/test_io.c", "int main(void)", READER_TEST)
    copy.before("tests/unit/test_io.c", "        cmocka_unit_test(test_missing_arguments)",
                "        cmocka_unit_test(test_points_of_xyz),\n")
    # a name without a reader is no longer model.xyz
    text = (copy.root / "tests/unit/test_io.c").read_text().replace("model.xyz", "model.abc")
    copy.add("tests/unit/test_io.c", text.replace("none of .off", "none of .xyz .off"))


def add_query(copy):
    copy.before("include/pirouette/query.h", "/** A contact: a point of each body", QUERY_HEADER)
    file = defining(copy.root, "pir_query_largest_distance")
    copy.add(file.relative_to(copy.root).as_posix(), file.read_text() + QUERY)
    copy.before("tests/support/queries.c", "const test_query_kind test_query_kinds[]", QUERY_KIND)
    copy.before("tests/support/queries.c", "    {NULL, 0, NULL}", '    {"both distances", 0, both_distances},\n')
    copy.before("docs/queries.md", "\n## Lifetimes", "\n`pir_query_both_distances` adds two distances.\n")


class Places(unittest.TestCase):
    def test_a_subcommand_a_format_and_a_kind_of_query(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder) / "tree"
            shutil.copytree(ROOT, root, ignore=shutil.ignore_patterns(*WITHOUT), symlinks=True)
            for add, most in ((add_subcommand, 4), (add_format, 3), (add_query, 4)):
                copy = Copy(root)
                add(copy)
                self.assertLessEqual(len(copy.changed), most, copy.changed)
            self.check(copy)

    def check(self, copy):
        copy.run("meson", "setup", "build", "-Dbuildtype=plain", "-Ddefault_library=static", "-Dtools=enabled",
                 "-Dtests=enabled", "-Dbench=disabled")
        copy.run("ninja", "-C", "build", "tools/pirouette", "tools/pages/pirouette-corners.1", "tests/unit/test_io",
                 "tests/cli/answers", "tests/cli/write_history", "tests/query/query_refusals",
                 "tests/query/query_every_query")
        command = str(copy.root / "build/tools/pirouette")
        self.assertIn("  corners        how many vertices", copy.run(command, "help"))
        self.assertIn(" .xyz", copy.run(command, "help"))
        self.assertIn("corners) options=(", (copy.root / "build/tools/pages/pirouette").read_text())
        self.assertIn("vertices", (copy.root / "build/tools/pages/pirouette-corners.1").read_text())
        (copy.root / "cloud.xyz").write_text("0 0 0\n1 0 0\n0 1 0\n0 0 1\n")
        self.assertEqual(copy.run(command, "corners", "cloud.xyz"), "4 corners\n")
        copy.test("command Corners", "io", "refusals", "every query")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
