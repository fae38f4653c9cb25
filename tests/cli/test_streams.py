#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Where results go: links, FIFOs, devices, standard output, full disks, signals."""
import array
import fcntl
import json
import os
import resource
import signal
import stat
import subprocess
import termios
import threading
import time
import unittest
from pathlib import Path

from command_test import CommandTest, TETRAHEDRON, main, with_own_signals

SLOW_SUM = ["sum", "shape:geodesic?level=16", "shape:geodesic?level=17", "--method", "hull", "-o"]


def least_files():
    """Run in the child: a disk on which a file of 64 bytes is the largest."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (64, 64))


def waits_for_more(running):
    """Whether a run has read all that was written to it, and sleeps; where the system does not tell, after a while."""
    unread = array.array("i", [0])
    fcntl.ioctl(running.stdin, termios.FIONREAD, unread)
    try:
        state = Path(f"/proc/{running.pid}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        time.sleep(0.5)
        state = "S"
    return unread[0] == 0 and state == "S"


def without_hangup():
    with_own_signals()
    signal.signal(signal.SIGHUP, signal.SIG_IGN)


class StreamTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.places = self.file("places.csv", "0,0,0\n3,0.5,0\n")
        pair = [self.tetrahedron, self.pyramid]
        # each command, the option and the ending of the file that it writes
        self.writers = [
            (["sum", *pair], "-o", ".off"), (["sum", *pair, "--exact"], "-o", ".off"),
            (["shape", "cube"], "-o", ".off"),
            (["cgm", *pair], "-o", ".svg"), (["query", *pair, "--translate=2,0,0"], "-o", ".svg"),
            (["query", *pair, "--batch", self.places], "-o", ".csv"), (["sum", *pair], "-o", ".svg"),
        ]

    def left(self):
        return sorted(str(p.relative_to(self.path)) for p in self.path.rglob("*"))

    def start(self, *args, **how):
        how = {"preexec_fn": with_own_signals, "stderr": subprocess.PIPE, **how}
        running = subprocess.Popen([self.command, *map(str, args)], stdout=subprocess.PIPE, text=True, **how)
        self.addCleanup(running.kill)
        return running

    def wait_for(self, running, is_there):
        started = time.monotonic()
        while not is_there():
            self.assertIsNone(running.poll(), "the run ended before it could be looked at")
            self.assertLess(time.monotonic() - started, 60)
            time.sleep(0.002)


class Targets(StreamTest):
    def test_links_stay_and_what_they_lead_to_is_written(self):
        (self.path / "sub").mkdir()
        for k, (args, option, ending) in enumerate(self.writers):
            plain, target = self.path / f"plain{k}{ending}", self.path / "sub" / f"target{k}{ending}"
            first, second = self.path / f"first{k}{ending}", self.path / "sub" / f"second{k}{ending}"
            first.symlink_to(f"sub/second{k}{ending}")
            second.symlink_to(target)
            self.good(*args, option, plain)
            for old in (None, "old"):
                if old:
                    target.write_text(old)
                    target.chmod(0o640)
                self.good(*args, option, first)
                self.assertTrue(first.is_symlink() and second.is_symlink() and not target.is_symlink())
                self.assertEqual(target.read_bytes(), plain.read_bytes(), args)
            self.assertEqual(stat.S_IMODE(target.stat().st_mode), 0o640)
        self.assertEqual([name for name in self.left() if "pirouette-" in name], [])

    def test_a_circle_of_links_and_a_folder_are_refused(self):
        for args, option, ending in self.writers:
            (self.path / f"a{ending}").unlink(missing_ok=True)
            (self.path / f"a{ending}").symlink_to(f"a{ending}")
            self.bad(*args, option, self.path / f"a{ending}", says=[f"a{ending}", "cannot write", "links"])
            (self.path / f"d{ending}").mkdir(exist_ok=True)
            self.bad(*args, option, self.path / f"d{ending}", says=[f"d{ending}", "cannot write", "directory"])

    def test_a_fifo_is_written_to_and_stays(self):
        fifo = self.path / "fifo"
        os.mkfifo(fifo)
        for args, option, ending in self.writers:
            if ending == ".svg" and args[0] == "sum":
                continue  # what has no ending is OFF
            plain = self.path / f"plain{ending}"
            self.good(*args, option, plain)
            got = []
            reader = threading.Thread(target=lambda: got.append(fifo.read_bytes()))
            reader.start()
            self.good(*args, option, fifo)
            reader.join()
            self.assertEqual(got, [plain.read_bytes()], args)
            self.assertTrue(stat.S_ISFIFO(os.lstat(fifo).st_mode))

    @unittest.skipUnless(hasattr(os, "O_DIRECT") and hasattr(os, "pipe2"), "no pipes of packets")
    def test_a_complaint_is_one_write(self):
        # what others write into the same place comes before or after it
        reader, writer = os.pipe2(os.O_DIRECT)
        with open(reader, "rb", buffering=0) as packets:
            with open(writer, "wb") as stderr:
                self.start("info", "no\nmodel.off", stderr=stderr).wait(timeout=60)
            line = packets.read(4096)
            self.assertTrue(line.startswith(b"pirouette: no") and line.endswith(b"\n"), line)
            self.assertEqual(packets.read(4096), b"")

    def test_a_full_device_is_a_failed_write_and_stays(self):
        node = self.path / "full"
        try:
            os.mknod(node, 0o666 | stat.S_IFCHR, os.makedev(1, 7))
            with open(node, "wb", buffering=0) as file:
                file.write(b"x")
        except PermissionError:
            self.skipTest("this user may not make device nodes")
        except OSError:
            pass
        for args, option, _ in self.writers:
            self.bad(*args, option, node, says="full: cannot write: No space left on device")
            self.assertTrue(stat.S_ISCHR(os.lstat(node).st_mode), args)

    def test_a_dash_is_standard_output_and_nothing_else_is_printed_there(self):
        for args, option, ending in self.writers:
            if ending == ".svg" and args[0] == "sum":
                continue
            plain, printed = self.path / f"plain{ending}", self.path / "printed"
            self.good(*args, option, plain)
            self.assertEqual(self.good(*args, option, "-"), plain.read_text(), args)
            # by another name, where it is a file that must not be replaced under the command's feet
            with open(printed, "w") as file:
                done = subprocess.run([self.command, *map(str, args), option, "/dev/stdout"], stdout=file, timeout=600,
                                      stderr=subprocess.PIPE)
            self.assertEqual((done.returncode, done.stderr), (0, b""))
            self.assertEqual(printed.read_bytes(), plain.read_bytes(), args)
            self.bad(*args, option, "-", "--json", says=[option, "--json", "standard output"])
        plot = self.good("track", self.tetrahedron, self.pyramid, "--frames", "5", "--plot", "-")
        self.assertTrue(plot.startswith("<svg") and plot.endswith("</svg>\n"))

    @unittest.skipUnless(os.path.exists("/dev/full"), "no /dev/full here")
    def test_standard_output_that_is_full(self):
        for args, option, _ in self.writers:
            with open("/dev/full", "w") as full:
                done = subprocess.run([self.command, *map(str, args), option, "-"], stdout=full, stderr=subprocess.PIPE,
                                      text=True, timeout=600)
            self.assertEqual((done.returncode, done.stderr),
                             (2, "pirouette: standard output: cannot write: No space left on device\n"))

    def test_a_full_disk_leaves_the_old_file_and_no_other(self):
        frames = ["track", self.tetrahedron, self.pyramid, "--frames", "2"]
        for args, option, ending in self.writers + [(frames, "--plot", ".svg"), (frames, "--dump", "")]:
            target = self.path / f"old{ending}"
            if option == "--dump":
                (self.path / "old" / "exact").mkdir(parents=True)
            else:
                target.write_text("old")
            before = self.left()
            done = subprocess.run([self.command, *map(str, args), option, str(target)], stdout=subprocess.PIPE,
                                  text=True,
                                  stderr=subprocess.PIPE, timeout=600, preexec_fn=least_files,
                                  env={**os.environ, "GCOV_PREFIX": "/dev/null"})
            # a build that measures coverage has files to write, too
            told = [line for line in done.stderr.splitlines() if not line.startswith("profiling:")]
            self.assertEqual((done.returncode, done.stdout, len(told)), (2, "", 1), args)
            self.assertRegex(told[0], "^pirouette: .*cannot write: File too large$")
            self.assertEqual(self.left(), before)
            self.assertTrue(option == "--dump" or target.read_text() == "old")


class StandardInput(StreamTest):
    def feed(self, text, *args):
        done = subprocess.run([self.command, *map(str, args)], input=text, capture_output=True, text=True, timeout=600)
        return done.returncode, done.stdout, done.stderr

    def test_a_dash_is_a_model_in_off(self):
        for args in (["info"], ["cgm"]):
            told = json.loads(self.good(*args, self.tetrahedron, "--json"))
            code, out, err = self.feed(TETRAHEDRON, *args, "-", "--json")
            self.assertEqual((code, err), (0, ""))
            again = json.loads(out)
            for key in ("model", "p", "seconds"):
                told.pop(key, None), again.pop(key, None)
            self.assertEqual(again, told)
        for order in ([self.pyramid, "-"], ["-", self.pyramid]):
            named = [self.tetrahedron if name == "-" else name for name in order]
            for args in (["sum", "-o", "-"], ["query", "--translate=2,0,0", "-o", "-"]):
                self.assertEqual(self.feed(TETRAHEDRON, args[0], *order, *args[1:]),
                                 (0, self.good(args[0], *named, *args[1:]), ""))
            self.assertEqual(self.feed(TETRAHEDRON, "track", *order, "--frames=3", "--verify", "--json")[0], 0)
        # larger than what is read at once
        self.good("shape", "geodesic?level=40", "-o", self.path / "large.off")
        code, out, _ = self.feed((self.path / "large.off").read_text(), "info", "-", "--json")
        self.assertEqual(json.loads(out)["vertices"], self.data("info", self.path / "large.off")["vertices"])

    def test_what_is_no_model_names_standard_input(self):
        for text in ("", "hello", TETRAHEDRON[:30], TETRAHEDRON.replace("1 0 0", "x 0 0")):
            code, out, err = self.feed(text, "info", "-")
            self.assertEqual((code, out, err.count("\n")), (2, "", 1))
            self.assertTrue(err.startswith("pirouette: standard input"), err)

    def test_it_is_read_once(self):
        for args in (["sum", "-", "-"], ["track", "-", "-"], ["query", "-", "-", "--translate=0,0,0"],
                     ["cgm", "-", "-"],
                     ["query", "-", "shape:cube", "--batch", "-", "-o", "-"]):
            self.assertEqual(self.feed(TETRAHEDRON, *args),
                             (2, "", "pirouette: '-' is given twice, and standard input is read once\n"))

    def test_one_that_cannot_be_read(self):
        folder = os.open(self.path, os.O_RDONLY)
        self.addCleanup(os.close, folder)
        done = subprocess.run([self.command, "info", "-"], stdin=folder, capture_output=True, text=True, timeout=600)
        self.assertEqual((done.returncode,
                          done.stderr), (2, "pirouette: standard input: cannot read: Is a directory\n"))


class Signals(StreamTest):
    def test_a_run_that_is_stopped_leaves_no_file(self):
        target = self.path / "sum.off"
        before = self.left()
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            running = self.start(*SLOW_SUM, target)
            self.wait_for(running, lambda: self.left() != before)
            running.send_signal(number)
            out, err = running.communicate(timeout=600)
            self.assertEqual((running.returncode, out, err), (-number, "", ""))
            self.assertEqual(self.left(), before)

    def test_a_signal_that_is_ignored_stays_ignored(self):
        target = self.path / "sum.off"
        before = self.left()
        running = self.start(*SLOW_SUM, target, preexec_fn=without_hangup)
        self.wait_for(running, lambda: self.left() != before)
        running.send_signal(signal.SIGHUP)
        time.sleep(0.05)
        self.assertIsNone(running.poll())
        running.send_signal(signal.SIGINT)
        running.communicate(timeout=600)
        self.assertEqual(running.returncode, -signal.SIGINT)

    def test_a_tracked_run_that_is_stopped_tells_what_it_measured(self):
        dump, plot = self.path / "dump", self.path / "plot.svg"
        args = ["track", self.tetrahedron, self.pyramid, "--frames=10000000", "--verify-every=100", "--dump", dump,
                "--every=1000", "--plot", plot]
        for number, extra in ((signal.SIGINT, ["--json"]), (signal.SIGTERM, []),
                              (signal.SIGHUP, ["--json", "--exact"])):
            running = self.start(*args, *extra)
            self.wait_for(running, lambda: (dump / "frame-005000.off").exists())
            running.send_signal(number)
            out, err = running.communicate(timeout=600)
            self.assertEqual((running.returncode, err), (-number, ""))
            frames = json.loads((dump / "frames.json").read_text())["frames"]
            self.assertGreaterEqual(len(frames), 6)
            for frame in frames:
                self.assertTrue((dump / frame["file"]).exists())
            self.assertTrue(plot.read_text().endswith("</svg>\n"))
            if "--json" in extra:
                told = json.loads(out)
                self.assertTrue(told["interrupted"])
                self.assertTrue(5000 < told["frames"] < 10000000)
                self.assertEqual(told["frames"], told["updates"] + told["rebuilds"])
                self.assertEqual((told["frames"] - 1) // 1000 + 1, told["dumped"])
                self.assertEqual((told["frames"] - 1) // 100 + 1, told["verified"])
                self.assertEqual([f["index"] for f in frames], [1000 * k for k in range(told["dumped"])])
            else:
                self.assertRegex(out, r" (\d+) frames, .*\n  interrupted, 10000000 frames were asked for\n")
                self.assertRegex(out, r"verified +\d+ frames, 0 differ")
            self.assertEqual([name for name in self.left() if "pirouette-" in name], [])
            for path in [*dump.rglob("*.off"), plot]:
                path.unlink()

    def test_a_batch_that_is_stopped_tells_what_it_answered(self):
        before = self.left()
        for extra in ([], ["--json"]):
            running = self.start("query", self.tetrahedron, self.pyramid, "--batch", "-", "-o",
                                 self.path / "answers.csv", *extra,
                                 stdin=subprocess.PIPE)
            running.stdin.write("0,0,0\n9,0,0\n9,9,0\n")
            running.stdin.flush()
            self.wait_for(running, lambda: self.left() != before and waits_for_more(running))
            running.send_signal(signal.SIGINT)
            out, err = running.communicate(timeout=600)
            self.assertEqual((running.returncode, err), (-signal.SIGINT, ""))
            if extra:
                told = json.loads(out)
                self.assertEqual([told[k] for k in ("placements", "outside", "boundary", "inside", "interrupted")],
                                 [3, 2, 0, 1, True])
            else:
                self.assertEqual(out, "3 placements, then interrupted: 2 outside, 0 boundary, 1 inside\n")
            self.assertEqual(self.left(), before)

    def test_a_fifo_without_a_reader_can_be_left(self):
        os.mkfifo(self.path / "fifo")
        running = self.start("shape", "cube", "-o", self.path / "fifo")
        time.sleep(0.1)
        self.assertIsNone(running.poll())
        running.send_signal(signal.SIGINT)
        running.communicate(timeout=600)
        self.assertEqual(running.returncode, -signal.SIGINT)
        self.assertTrue(stat.S_ISFIFO(os.lstat(self.path / "fifo").st_mode))


if __name__ == "__main__":
    main()
