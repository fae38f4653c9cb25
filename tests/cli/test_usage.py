#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Arguments: subcommands, options, numbers, files that are no models."""
from command_test import CommandTest, TETRAHEDRON, main


class Usage(CommandTest):
    def test_help_and_version_go_to_stdout(self):
        help_text = self.good("--help")
        for name in ("info", "shape", "sum", "track"):
            self.assertIn(name, help_text)
            self.assertTrue(self.good(name, "--help").startswith(f"usage: pirouette {name}"))
        self.assertRegex(self.good("--version"), r"^pirouette \d+\.\d+\.\d+\n$")

    def test_help_names_every_option(self):
        for option in ("--quat", "--axis", "--angle", "--difference", "--method", "--exact", "-o", "--json", "--help"):
            self.assertIn(option, self.good("sum", "--help"))
        for option in ("--steps", "--frames", "--axis", "--seed", "--method", "--verify", "--verify-every", "--brute",
                       "--dump", "--every", "--plot", "--json", "--help"):
            self.assertIn(option, self.good("track", "--help"))

    def test_no_subcommand_or_an_unknown_one(self):
        self.bad(says="usage")
        self.bad("spin", says="'spin'")
        self.bad("--spin", says="'--spin'")
        self.bad("", says="''")

    def test_too_few_and_too_many_arguments(self):
        self.bad("info", says="MODEL is missing")
        self.bad("sum", self.tetrahedron, says="Q is missing")
        self.bad("track", says="P is missing")
        self.bad("info", self.tetrahedron, "more", says="'more'")

    def test_options_that_do_not_exist_or_lack_their_value(self):
        self.bad("info", self.tetrahedron, "--jsn", says="'--jsn'")
        self.bad("info", self.tetrahedron, "--json=1", says="--json")
        self.bad("sum", "a", "b", "-x", says="'-x'")
        self.bad("sum", "a", "b", "--quat", says="--quat")
        self.bad("track", "a", "b", "--steps", says="--steps")
        self.bad("sum", "a", "b", "--step=3", says="'--step=3'")

    def test_words_behind_two_dashes_are_no_options(self):
        self.bad("info", "--", "--json", says="--json")
        self.bad("info", "--", "-nothing.off", says="-nothing.off")

    def test_a_complaint_is_one_line_whatever_is_in_it(self):
        self.bad("info", "no\nsuch\rfile.off")
        self.bad("sp\nin")
        self.bad("info", "x" * 5000)


class BadNumbers(CommandTest):
    def test_quaternions(self):
        for text in ("1,2,x,4", "1,2,3", "1,2,3,4,5", "", ",,,", "nan,0,0,1", "inf,0,0,1", "1e999,0,0,1", "0,0,0,0",
                     "-0.0,0,0,0", "1 ,0,0,0", " 1,0,0,0", "1;0;0;0", "1,0,0,0,", "9" * 200 + ",0,0,1"):
            for form in (["--quat", text], [f"--quat={text}"]):
                self.bad("sum", self.tetrahedron, self.pyramid, *form, says="--quat")

    def test_the_number_that_is_wrong_is_named(self):
        pair = ["sum", self.tetrahedron, self.pyramid]
        for text, says in (("1,2,x,4", "number 3 of 4, 'x' is not a number"),
                           ("1,,3,4", "number 2 of 4, '' is not a number"),
                           ("1,2,3,inf", "number 4 of 4, 'inf' is not finite"),
                           ("1,2,3", "'1,2,3' is 3 numbers, not 4"),
                           ("7" * 200 + ",0,0,1", "number 1 of 4, of more than 127 characters")):
            self.bad(*pair, f"--quat={text}", says=f"sum: --quat: {says}\n")
        self.bad(*pair, "--axis=0,0,1", "--angle=1_0", says="sum: --angle: '1_0' is not a number\n")
        self.bad(*pair, "--axis=0,0,1", "--angle=" + "1" * 128,
                 says="sum: --angle: a number of more than 127 characters\n")

    def test_axes_and_angles(self):
        for axis in ("0,0,0", "1,0", "x,y,z", "nan,1,0", "random"):
            self.bad("sum", self.tetrahedron, self.pyramid, "--axis", axis, "--angle", "90", says="--axis")
        for angle in ("", "ninety", "nan", "inf", "-inf", "1,2", "90deg"):
            self.bad("sum", self.tetrahedron, self.pyramid, "--axis=0,0,1", f"--angle={angle}", says="--angle")
        for axis in ("0,0,0", "1,0", "x,y,z", "nan,1,0", "Random"):
            self.bad("track", self.tetrahedron, self.pyramid, "--axis", axis, says="--axis")

    def test_two_rotations_or_half_of_one(self):
        pair = ["sum", self.tetrahedron, self.pyramid]
        self.bad(*pair, "--quat", "0,0,0,1", "--axis", "0,0,1", "--angle", "3", says=["--quat", "--axis"])
        self.bad(*pair, "--quat", "0,0,0,1", "--angle", "3", says=["--quat", "--angle"])
        self.bad(*pair, "--axis", "0,0,1", says="--angle")
        self.bad(*pair, "--angle", "5", says="--axis")

    def test_counts(self):
        for option in ("--steps", "--frames", "--verify-every"):
            for text in ("0", "-1", "1.5", "", "1e3", "0x10", "many", "99999999999999999999999", " 5"):
                self.bad("track", self.tetrahedron, self.pyramid, f"{option}={text}", says=option)
        for text in ("-1", "x", "99999999999999999999999"):
            self.bad("track", self.tetrahedron, self.pyramid, "--seed", text, says="--seed")
        self.bad("track", self.tetrahedron, self.pyramid, "--dump", self.path / "d", "--every", "0", says="--every")
        self.assertFalse((self.path / "d").exists())

    def test_methods(self):
        self.bad("sum", self.tetrahedron, self.pyramid, "--method", "magic", says=["'magic'", "walk", "hull"])
        self.bad("track", self.tetrahedron, self.pyramid, "--method", "hull", says=["'hull'", "auto", "update", "walk"])


class BadModels(CommandTest):
    def test_files_that_are_no_models(self):
        broken = {
            "empty.off": "",
            "word.off": "hello",
            "truncated.off": TETRAHEDRON[:30],
            "lying.off": TETRAHEDRON.replace("4 4 6", "9 4 6"),
            "far.off": TETRAHEDRON.replace("3 1 2 3", "3 1 2 77"),
            "nan.off": TETRAHEDRON.replace("1 0 0", "nan 0 0"),
            "zero.off": TETRAHEDRON.replace("1 0 0", "1/0 0 0"),
            "binary.off": bytes(range(256)) * 40,
            "model.txt": TETRAHEDRON,
            "plain": TETRAHEDRON,
        }
        for name, text in broken.items():
            path = self.file(name, text)
            self.bad("info", path, says=name)
            self.bad("sum", self.tetrahedron, path, says=name)
            self.bad("track", path, self.tetrahedron, says=name)

    def test_files_that_are_not_there(self):
        self.bad("info", self.path / "none.off", says="none.off")
        self.bad("info", "", says="")
        (self.path / "folder.off").mkdir()
        self.bad("info", self.path / "folder.off", says="folder.off")

    def test_shapes_that_do_not_exist(self):
        for name in ("shape:", "shape:cub", "shape:cube?", "shape:cube?size=nan", "shape:box?x=0", "shape:box?x=-1",
                     "shape:box?x", "shape:geodesic?level=1e9"):
            self.bad("info", name)
            self.bad("sum", "shape:cube", name)


if __name__ == "__main__":
    main()
