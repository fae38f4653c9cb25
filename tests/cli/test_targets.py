#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Every output of every subcommand: what cannot be written, names of all kinds, two outputs, equal runs."""
import hashlib
import os
import resource
import signal
import stat
import subprocess
import time
import unittest
import xml.dom.minidom

from command_test import CommandTest, main

SCENE = """{"seconds": 1, "shapes": {"box": {"model": "shape:gs2"}},
"bodies": [{"shape": "box", "kind": "moving", "position": [0, 0, 1]}]}"""
NOBODY = 65534
HAS_FULL = os.path.exists("/dev/full")


def little_room():
    """Run in the child: a limit on the size of files, which kills a process that does not mind it."""
    signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
    resource.setrlimit(resource.RLIMIT_FSIZE, (64, 64))


class TargetTest(CommandTest):
    def setUp(self):
        super().setUp()
        pair = [self.tetrahedron, self.pyramid]
        scene, places = self.file("scene.json", SCENE), self.file("places.csv", "0,0,0\n3,0.5,0\n")
        # each command, the option of its output, and the ending of that
        self.writers = [
            (["sum", *pair], "-o", ".off"), (["sum", "shape:gs4", "shape:gs4"], "-o", ".stl"),
            (["sum", *pair], "-o", ".svg"), (["sum", "shape:cube", "shape:cube", "--solid"], "-o", ".off"),
            (["shape", "geodesic?level=40"], "-o", ".off"), (["cgm", *pair], "-o", ".svg"),
            (["query", *pair, "--translate=2,0,0"], "-o", ".svg"),
            (["query", *pair, "--batch", places], "-o", ".csv"),
            (["track", *pair, "--frames=3"], "--plot", ".svg"), (["decompose", "shape:gs2"], "-o", ".obj"),
            (["simplify", "shape:geodesic?level=10", "--vertices=400"], "-o", ".off"),
            (["simplify", "shape:gs4", "--vertices=200"], "--outer", ".ply"),
            (["simulate", scene], "-o", ".html"), (["simulate", scene], "--record", ".bin")]
        if self.run_command("sum", *pair, "--solid", "-o", self.path / "probe.png").returncode == 0:
            self.writers += [(["sum", "shape:cube", "shape:cube", "--solid"], "-o", ".png"),
                             (["decompose", "shape:gs2"], "-o", ".png")]
        slices = self.path / "slices.h5"
        if self.run_command("slice", "shape:gs2", "shape:gs2", "--axis", "0,0,1", "--steps", 40, "-o",
                            slices).returncode == 0:
            poses = self.file("poses.csv", "0,0,0,1,5,0,0\n")
            self.writers += [(["view", slices], "-o", ".svg"), (["view", slices], "-o", ".html"),
                             (["view", slices], "-o", ".vtkhdf"), (["view", slices, "--slice=0"], "-o", ".obj"),
                             (["configuration", slices, "--batch", poses], "-o", ".csv")]
        # what has an ending that a stream has not is OFF there, or for regular files alone
        self.streams = [(args, option) for args, option, ending in self.writers
                        if ending not in (".vtkhdf", ".png") and (args[0] != "view" or ending == ".obj")]
        (self.path / "out").mkdir()

    def target(self, ending, name="a"):
        return self.path / "out" / (name + ending)

    def left(self):
        return sorted(os.listdir(self.path / "out"))

    def run_as(self, args, **how):
        return subprocess.run([self.command, *map(str, args)], capture_output=True, text=True, timeout=600, **how)

    def expect_failed(self, done, args, told):
        self.assertEqual((done.returncode, done.stdout), (2, ""), (args, done.stderr))
        self.assertRegex(done.stderr, f"^pirouette: [^\n]*{told}\n$", args)


class Unwritable(TargetTest):
    @unittest.skipUnless(HAS_FULL, "no /dev/full here")
    def test_a_full_device_is_named_as_the_reason(self):
        for args, option in self.streams:
            self.expect_failed(self.run_as([*args, option, "/dev/full"]), args,
                               "/dev/full: cannot write: No space left on device")

    @unittest.skipUnless(HAS_FULL, "no /dev/full here")
    def test_a_full_standard_output_is_named_as_the_reason(self):
        prints = [["--help"], ["track", "--help"], ["shape", "--list"], ["shape", "--list", "--json"],
                  ["info", "shape:cube"], ["cgm", "shape:gs4", "--json"], ["--version"]]
        for args in prints + [[*args, option, "-"] for args, option in self.streams]:
            with open("/dev/full", "w") as full:
                done = subprocess.run([self.command, *map(str, args)], stdout=full, stderr=subprocess.PIPE, text=True,
                                      timeout=600)
            self.assertEqual((done.returncode, done.stderr),
                             (2, "pirouette: standard output: cannot write: No space left on device\n"), args)

    def test_a_limit_on_the_size_of_files_leaves_the_old_one(self):
        for args, option, ending in self.writers:
            target = self.target(ending)
            target.write_text("old")
            self.expect_failed(self.run_as([*args, option, target], preexec_fn=little_room), args,
                               f"a{ending}: cannot write: File too large")
            self.assertEqual((self.left(), target.read_text()), ([target.name], "old"), args)
            target.unlink()

    def test_a_reader_that_went_away(self):
        for args, option in self.streams:
            reader, writer = os.pipe()
            os.close(reader)
            with os.fdopen(writer, "w") as pipe:
                done = subprocess.run([self.command, *map(str, args), option, "-"], stdout=pipe, text=True,
                                      stderr=subprocess.PIPE, timeout=600)
            self.assertEqual((done.returncode, done.stderr),
                             (2, "pirouette: standard output: cannot write: Broken pipe\n"), args)

    @unittest.skipUnless(os.geteuid() == 0, "needs to be another user for a while")
    def test_a_folder_that_may_not_be_written_to(self):
        os.chmod(self.path, 0o755)
        command = self.path / "command"
        os.chmod(self.path / "out", 0o555)
        if subprocess.run([self.command, "--version"], user=NOBODY, capture_output=True).returncode != 0:
            self.skipTest("another user may not run the command here")
        for args, option, ending in self.writers:
            self.expect_failed(self.run_as([*args, option, self.target(ending)], user=NOBODY), args,
                               f"a{ending}: cannot write: Permission denied")
        self.assertFalse(command.exists() or self.left())

    def test_a_folder_in_its_place(self):
        for args, option, ending in self.writers:
            self.target(ending).mkdir(exist_ok=True)
            self.expect_failed(self.run_as([*args, option, self.target(ending)]), args,
                               f"a{ending}: cannot write: Is a directory")
        self.assertTrue(all(name.startswith("a.") for name in self.left()))

    def test_streams_that_are_closed_are_no_targets(self):
        def close_streams():
            for stream in (0, 1, 2):
                os.close(stream)

        target = self.target(".off")
        done = subprocess.run([self.command, "shape", "cube", "-o", target], preexec_fn=close_streams)
        self.assertEqual(done.returncode, 2)  # what it tells cannot be printed
        self.assertEqual(self.data("info", target)["vertices"], 8)
        self.assertEqual(target.read_text().count("cube"), 0)


class Pairs(TargetTest):
    def two(self, pair, *paths):
        args, first, second = pair
        return self.run_as([*args, first, paths[0], second, paths[1]])

    def setUp(self):
        super().setUp()
        scene = self.path / "scene.json"
        self.pairs = [(["simplify", "shape:gs2", "--vertices=8"], "-o", "--outer"),
                      (["simulate", scene, "--seconds=0.1"], "-o", "--record")]

    def test_two_outputs_that_are_one_file(self):
        (self.path / "link").symlink_to("out")
        for pair, ending in zip(self.pairs, (".off", ".html")):
            target = self.target(ending)
            other = self.path / "out" / ("link" + ending)
            other.symlink_to(target.name)
            fifo = self.path / ("fifo" + ending)
            os.mkfifo(fifo)
            for paths in ((target, target), (target, self.path / "out" / ".." / "out" / target.name),
                          (target, self.path / "link" / target.name), (other, target), (fifo, fifo)):
                done = self.two(pair, *paths)
                self.expect_failed(done, pair, f"{pair[0][0]}: {pair[1]} and {pair[2]} both write to {paths[0]}")
            self.expect_failed(self.two(pair, "-", "/dev/stdout"), pair, "both write to standard output")
            self.assertEqual(self.left(), [other.name])
            other.unlink()

    def test_two_outputs_with_one_content_or_none(self):
        for pair, ending in zip(self.pairs, (".off", ".html")):
            first, second = self.target(ending), self.target(ending, "b")
            first.write_text("old")
            os.link(first, second)  # two names of one file are two outputs: each is replaced
            self.assertEqual(self.two(pair, first, second).returncode, 0)
            self.assertNotEqual(first.read_bytes(), second.read_bytes())
            done = self.two(pair, "/dev/null", "/dev/null")
            self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_one_that_cannot_be_written_costs_no_time_and_leaves_no_other(self):
        for pair, ending in zip(self.pairs, (".off", ".html")):
            done = self.two(pair, self.target(ending), self.path / "none" / ("b" + ending))
            self.expect_failed(done, pair, "cannot write: No such file or directory")
            self.assertEqual(self.left(), [])

    def test_an_option_given_twice(self):
        for args, option, ending in self.writers:
            done = self.run_as([*args, option, self.target(ending), f"{option}={self.target(ending, 'b')}"])
            self.expect_failed(done, args, f"{args[0]}: {option} is given twice")
        self.bad("info", "shape:cube", "--json", "--json", says="info: --json is given twice")
        self.bad("sum", "--quat=1,2,3,4", "shape:cube", "shape:cube", "--quat", "1,2,3,4", says="--quat is given twice")
        self.assertEqual(self.left(), [])

    def test_an_output_that_is_an_input(self):
        model = self.target(".off")
        self.good("shape", "cube", "-o", model)
        self.good("sum", model, model, "-o", model)
        self.good("simplify", model, "--vertices", 6, "-o", model)
        self.assertEqual(self.data("info", model)["vertices"], 6)
        lines = self.file("lines.csv", "0,0,0\n3,0.5,0\n")
        self.good("query", model, model, "--batch", lines, "-o", lines)
        self.assertEqual(len(lines.read_text().splitlines()), 3)


class Names(TargetTest):
    def test_the_longest_names(self):
        for args, option, ending in self.writers:
            target = self.target(ending, "n" * (255 - len(ending)))
            self.good(*args, option, target)
            self.assertEqual(self.left(), [target.name], args)
            target.unlink()
            self.expect_failed(self.run_as([*args, option, self.target(ending, "n" * (256 - len(ending)))]), args,
                               f"n{ending}: cannot write: File name too long")

    def test_a_long_path_leaves_room_for_the_reason(self):
        folder = self.path / "out" / "/".join("d" * 200 for _ in range(8))
        self.expect_failed(self.run_as(["shape", "cube", "-o", folder / "a.off"]), [],
                           "a.off: cannot write: No such file or directory")

    def odd_name(self):
        """A model whose name is no UTF-8, would change a terminal, and goes on in another line; as it is shown."""
        name = b"x\xff\x1b[31m\n\xe2\x80\xae\xc2\x9b\xc3\xa9<&.off"
        path = os.fsencode(self.path) + b"/" + name
        with open(path, "wb") as file:
            file.write(self.tetrahedron.read_bytes())
        return path, r"x\xff\x1b[31m\x0a\xe2\x80\xae\xc2\x9bé<&.off"

    def test_names_are_shown_without_control_characters(self):
        path, shown = self.odd_name()
        told = (["info", path], ["info", path, "--solid"], ["sum", path, path], ["sum", path, path, "--solid"],
                ["cgm", path, path], ["query", path, path, "--translate=2,0,0"], ["track", path, path, "--frames=2"],
                ["query", path, path, "--translate=2,0,0", "--solid"], ["simplify", path, "--vertices=4"],
                ["decompose", path], ["sum", path, path, "-o", path])
        for args in told:
            done = subprocess.run([self.command, *args], capture_output=True, timeout=600)
            self.assertEqual((done.returncode, done.stderr), (0, b""), args)
            text = done.stdout.decode()
            self.assertIn(shown, text, args)
            self.assertFalse([c for c in text if c != "\n" and not c.isprintable()], args)
        done = subprocess.run([self.command, "info", path + b".off"], capture_output=True, timeout=600)
        self.assertRegex(done.stderr.decode(), r"^pirouette: .*\\xff\\x1b\[31m.*\.off\.off: [^\n]*\n$")

    def test_json_and_pictures_are_text_whatever_the_names(self):
        path, shown = self.odd_name()
        for args in (["info", path], ["sum", path, path], ["track", path, path, "--frames=2"], ["cgm", path],
                     ["query", path, path, "--translate=2,0,0"], ["decompose", path],
                     ["simplify", path, "--vertices=4"]):
            told = self.data_of(args)
            name = told.get("model", told.get("p"))
            self.assertTrue(name.endswith("x\ufffd\x1b[31m\n\u202e\x9bé<&.off"), (args, name))
        plot = self.target(".svg")
        done = subprocess.run([self.command, "track", path, path, "--frames=2", "--plot", plot], capture_output=True)
        self.assertEqual(done.returncode, 0)
        title = xml.dom.minidom.parse(str(plot)).getElementsByTagName("text")[0].firstChild.data
        self.assertEqual(title, f"{shown} turning against {shown}")

    def data_of(self, args):
        import json
        done = subprocess.run([self.command, *args, "--json"], capture_output=True, timeout=600)
        self.assertEqual((done.returncode, done.stderr), (0, b""), args)
        return json.loads(done.stdout.decode())


class Equal(TargetTest):
    def test_equal_runs_make_equal_files(self):
        made = []
        for number in range(2):
            digests = {}
            for args, option, ending in self.writers:
                if option != "--plot":  # which holds times
                    self.good(*args, option, self.target(ending))
                    digests[f"{args[0]} {ending}"] = hashlib.sha256(self.target(ending).read_bytes()).hexdigest()
                    self.assertTrue(stat.S_ISREG(os.lstat(self.target(ending)).st_mode))
            made.append(digests)
            if number == 0:
                time.sleep(1.1)  # HDF5 would keep seconds
        self.assertEqual(*made)


class Large(TargetTest):
    """Numbers beyond what doubles hold, or beyond what is computed with, are named by where they were given."""

    def test_translations(self):
        cubes = ["shape:cube", "shape:cube"]
        for far in ("1e308,0,0", "0,-1e308,0"):
            for more in ([], ["--solid"]):
                self.bad("query", *cubes, f"--translate={far}", *more, says=f"query: --translate: '{far}': too large")
        self.bad("query", *cubes, "--translate=5,0,0", "--radius-p=1e308", "--radius-q=1e308",
                 says="query: --radius-p and --radius-q: too large together")
        slices = self.path / "slices.h5"
        if not slices.exists():
            return
        far = "1e308,0,0"
        says = f"configuration: --translate: '{far}': too large"
        self.bad("configuration", slices, "--translate", far, says=says)
        self.bad("configuration", slices, "--translate", far, "--to", "9,0,0", says=says)
        self.bad("configuration", slices, "--translate", far, "--to-quat", "0,0,1,0", says=says)
        self.bad("configuration", slices, "--translate", "9,0,0", "--to", far,
                 says=f"configuration: --to: '{far}': too large")
        poses = self.file("far.csv", f"0,0,0,1,0,0,0\n0,0,0,1,{far}\n")
        self.bad("configuration", slices, "--batch", poses, "-o", self.target(".csv"),
                 says="far.csv: pose 2: too large")

    def test_a_volume_beyond_the_largest_double(self):
        model = self.file("large.off", "OFF\n4 0 0\n0 0 0\n1e200 0 0\n0 1e200 0\n0 0 1e200\n")
        self.assertRegex(self.good("info", model), r"volume +above 1\.79e308\n")
        self.assertIsNone(self.data("info", model)["volume"])
        solid = self.file("solid.off", self.tetrahedron.read_text().replace(" 1", " 1e200").replace("\n1 ", "\n1e200 ")
                          .replace("3 0 2 1e200", "3 0 2 1").replace("3 0 1e200 3", "3 0 1 3")
                          .replace("3 1e200 2 3", "3 1 2 3"))
        self.assertRegex(self.good("info", solid, "--solid"), r"volume +above 1\.79e308\n")
        for told in (self.good("info", model), self.good("info", solid, "--solid")):
            self.assertNotRegex(told, r"\b(inf|nan)\b")


if __name__ == "__main__":
    main()
