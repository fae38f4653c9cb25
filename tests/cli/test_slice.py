#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""
Runs `pirouette slice` and reads its files with h5py alone: test_slice.py COMMAND [CLASS]. PIR_TEST_KILLS says how often
a run is killed (6).
"""
import json
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

try:
    import h5py
    import numpy as np
except ImportError:
    h5py = None

COMMAND = ""
KILLS = int(os.environ.get("PIR_TEST_KILLS", "6"))
BOX = "OFF\n8 6 0\n" + "".join(f"{x} {y} {z}\n" for x in (0, 1) for y in (0, 2) for z in (0, 3)) + (
    "4 0 1 3 2\n4 4 6 7 5\n4 0 4 5 1\n4 2 3 7 6\n4 0 2 6 4\n4 1 5 7 3\n")
TWO_OBJECTS = """# two boxes
o first
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
f 1 3 2
f 1 2 4
f 2 3 4
f 1 4 3
o second
v 5 0 0
v 6 0 0
v 5 1 0
v 5 0 1
f -4 -2 -3
f 5//1 6//1 8//1
f 6/1 7/1 8/1
f 5 8 7
"""


def run(*args, **more):
    return subprocess.run([COMMAND, "slice", *map(str, args)], capture_output=True, text=True, timeout=1800,
                          stdin=subprocess.DEVNULL, **more)


def turn(q, v):
    """Rows of v turned by the quaternion."""
    x, y, z, w = q
    m = np.array([[w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
                  [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
                  [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z]])
    return v @ (m / (q @ q)).T


def numbers_of(data):
    """The numbers of a record: 3 bits a half byte, least significant first, the lower half of a byte first."""
    numbers, number, shift = [], 0, 0
    for half in (half for byte in data.tolist() for half in (byte & 15, byte >> 4)):
        number |= (half & 7) << shift
        shift += 3
        if half < 8:
            numbers.append(number)
            number = shift = 0
    return numbers


class Pairing:
    """A pairing that records are applied to, as docs/slices.md says."""

    def __init__(self, file, robot, obstacle):
        self.p, self.q = file[f"robot/{robot}"], file[f"obstacle/{obstacle}"]
        self.edges = [piece["edge"][:].tolist() for piece in (self.p, self.q)]
        self.around = [self.edges_of_vertices(edges) for edges in self.edges]
        self.facet_edges = [self.edges_of_facets(piece) for piece in (self.p, self.q)]
        self.guides = [self.guides_of(piece) for piece in (self.p, self.q)]
        self.ends = self.p["edge_facet"][:][:, ::-1].tolist()  # of −P
        self.cells, self.crossed = [[], []], {}

    @staticmethod
    def edges_of_vertices(edges):
        found = {}
        for e, ends in enumerate(edges):
            for v in ends:
                found.setdefault(v, []).append(e)
        return found

    @staticmethod
    def edges_of_facets(piece):
        found = {}
        for e, facets in enumerate(piece["edge_facet"][:].tolist()):
            for f in facets:
                found.setdefault(f, []).append(e)
        return found

    @staticmethod
    def guides_of(piece):
        least = list(range(len(piece["normal"])))
        for f, g in piece["edge_facet"][:].tolist():
            least[f], least[g] = min(least[f], g), min(least[g], f)
        return [None if least[f] == f else least[f] for f in range(len(least))]

    def across(self, side, cell, rank):
        """The edge of that rank at a vertex, and where it leads."""
        edge = self.around[side][cell][rank]
        return edge, sum(self.edges[side][edge]) - cell

    def apply(self, record):
        numbers = iter(numbers_of(record))
        take = lambda: next(numbers)
        if take() == 1:
            for side in (0, 1):
                cells = self.cells[side] = []
                for guide in self.guides[side]:
                    cells.append(take() if guide is None else self.cell_from(1 - side, cells[guide], take))
            for e in range(len(self.ends)):
                self.crossed[e] = self.way(e, take)
        else:
            for side in (0, 1):
                f = 0
                for _ in range(take()):
                    f += take()
                    self.step(side, f, take(), take)
            e = 0
            for _ in range(take()):
                e += take()
                self.crossed[e] = self.way(e, take)
        assert all(number == 0 for number in numbers)  # half a byte may be left over

    def cell_from(self, other, near, take):
        step, ring = take(), self.around[other].get(near, [])
        return near if step == 0 else take() if step > len(ring) else self.across(other, near, step - 1)[1]

    def way(self, e, take):
        left, right = self.ends[e]
        cell, end, crossed = self.cells[0][left], self.cells[0][right], set()
        while cell != end:
            step, around = take(), self.around[1][cell]
            g = around[step - 1] if step else next(g for g in around if end in self.edges[1][g])
            cell = sum(self.edges[1][g]) - cell
            crossed.add(g)
        return crossed

    def step(self, side, f, step, take):
        if step == 0:
            self.cells[side][f] = take()
            return
        passed, self.cells[side][f] = self.across(1 - side, self.cells[side][f], step - 1)
        for own in self.facet_edges[side][f]:
            e, g = (own, passed) if side == 0 else (passed, own)
            self.crossed[e] = self.crossed[e] ^ {g}

    def ordered(self):
        """The crossings by edge of −P, in order along each arc."""
        for e, (left, right) in enumerate(self.ends):
            cell, rest = self.cells[0][left], set(self.crossed[e])
            while rest:
                g = next(g for g in rest if cell in self.edges[1][g])
                rest.remove(g)
                cell = sum(self.edges[1][g]) - cell
                yield e, g
            assert cell == self.cells[0][right]

    def planes(self, q):
        """The planes of all pairs, from pairs, rotation and models alone."""
        minus, stand = turn(q, -self.p["vertex"][:]), self.q["vertex"][:]
        n_f, n_g = turn(q, -self.p["normal"][:]), self.q["normal"][:]
        on_f = self.p["facet_vertex"][:][self.p["facet_start"][:-1]]
        on_g = self.q["facet_vertex"][:][self.q["facet_start"][:-1]]
        ee = np.array(list(self.ordered())).reshape(-1, 2)
        ends, others = np.array(self.edges[0])[ee[:, 0]], np.array(self.edges[1])[ee[:, 1]]
        n = np.cross(minus[ends[:, 1]] - minus[ends[:, 0]], stand[others[:, 1]] - stand[others[:, 0]])
        n /= np.linalg.norm(n, axis=1)[:, None]
        beside = n_f[np.array(self.ends)[ee[:, 0]]].sum(axis=1)
        n *= np.sign((n * beside).sum(axis=1))[:, None]
        normals = np.vstack([n_f, n_g, n])
        corners = np.vstack([minus[on_f] + stand[self.cells[0]], minus[self.cells[1]] + stand[on_g],
                             minus[ends[:, 0]] + stand[others[:, 0]]])
        return np.hstack([normals, (normals * corners).sum(axis=1)[:, None]])


class InFolder(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="pirouette-slice-"))
        self.addCleanup(shutil.rmtree, self.folder)
        (self.folder / "box.off").write_text(BOX)

    def path(self, name):
        return str(self.folder / name)

    def make(self, name, *args, models=("shape:icosahedron", "shape:gs2"), grid=("--axis", "1,2,3", "--steps", 100)):
        result = run(*models, *grid, "-o", self.path(name), *args)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return result

    def refused(self, *args, says, **more):
        result = run(*args, **more)
        self.assertEqual(result.returncode, 2, result)
        self.assertRegex(result.stderr, says)
        self.assertEqual(result.stderr.count("\n"), 1)


@unittest.skipIf(h5py is None, "no h5py")
class Files(InFolder):
    def test_records_alone_give_the_planes_of_every_slice(self):
        self.make("a.h5", "--planes", models=("shape:icosahedron", self.path("box.off"), "shape:gs2"))
        with h5py.File(self.path("a.h5")) as file:
            slices, planes = file["slices"], file["planes"]
            per_unit, length, count = slices.attrs["slices_per_unit"], slices["length"], planes["count"]
            for pair in range(2):
                pairing = Pairing(file, 0, pair)
                for i in range(100):
                    if i % per_unit == 0:
                        at, plane_at = slices["unit"][pair, i // per_unit], planes["unit"][pair, i // per_unit]
                    pairing.apply(slices["bytes"][at:at + length[pair, i]])
                    stored = planes["plane"][plane_at:plane_at + count[pair, i]]
                    own = pairing.planes(file["grid/rotation"][i])
                    self.assertEqual(own.shape, stored.shape)
                    # a pair of edges that are parallel has the half-space of the facet beside it
                    same = np.isfinite(own).all(axis=1)
                    self.assertGreater(same.mean(), 0.9)
                    self.assertLess(np.abs(own - stored)[same].max(), 1e-9)
                    at += length[pair, i]
                    plane_at += count[pair, i]

    def test_vertices_lie_within_all_planes(self):
        self.make("a.h5", "--planes", "--vertices")
        with h5py.File(self.path("a.h5")) as file:
            vertices = file["vertices/vertex"][:file["vertices/count"][0, 0]]
            planes = file["planes/plane"][:file["planes/count"][0, 0]]
            self.assertLessEqual((vertices @ planes[:, :3].T - planes[:, 3]).max(), 0)

    def test_the_file_says_what_it_is(self):
        self.make("a.h5", models=(self.path("box.off"), "shape:gs2"))
        with h5py.File(self.path("a.h5")) as file:
            self.assertEqual(file.attrs["format"], b"pirouette slices")
            self.assertEqual(file.attrs["version"], 3)
            self.assertEqual(file["grid"].attrs["kind"], b"axis")
            self.assertEqual(file["grid"].attrs["axis"].tolist(), [1, 2, 3])
            self.assertEqual(file["robot/0/vertex"].shape, (8, 3))
            self.assertTrue(bytes(file["robot/0/off"][:]).startswith(b"OFF"))
            self.assertEqual(file["grid/rotation"].shape, (100, 4))

    def test_h5dump_reads_it(self):
        if not shutil.which("h5dump"):
            self.skipTest("no h5dump")
        self.make("a.h5")
        dump = subprocess.run(["h5dump", self.path("a.h5")], capture_output=True, text=True, timeout=600)
        self.assertEqual((dump.returncode, dump.stderr), (0, ""))
        self.assertIn('"pirouette slices', dump.stdout)

    def test_all_rotations_and_a_list(self):
        self.make("hopf.h5", grid=("--grid", "hopf", "--level", 0))
        with h5py.File(self.path("hopf.h5")) as file:
            self.assertEqual(sorted(file["grid/cell"][:].tolist()), list(range(72)))
            rotations = file["grid/rotation"][:]
        np.savetxt(self.folder / "list.csv", rotations[:20], delimiter=",")
        self.make("list.h5", grid=("--rotations", self.path("list.csv")))
        with h5py.File(self.path("list.h5")) as file:
            cells = file["grid/cell"][:]
            self.assertEqual(sorted(cells.tolist()), list(range(20)))
            self.assertTrue((file["grid/rotation"][:] == rotations[cells]).all())


class Pieces(InFolder):
    def test_objects_and_folders_are_pieces(self):
        (self.folder / "two.obj").write_text(TWO_OBJECTS)
        (self.folder / "parts").mkdir()
        for name in ("b.off", "a.off"):
            (self.folder / "parts" / name).write_text(BOX)
        (self.folder / "parts" / "notes.txt").write_text("no model")
        result = self.make("a.h5", "--json", models=(self.path("two.obj"), self.path("parts"), "shape:cube"))
        told = json.loads(result.stdout)
        self.assertEqual((told["robot_pieces"], told["obstacle_pieces"], told["slices"]), (2, 3, 600))
        if h5py:
            with h5py.File(self.path("a.h5")) as file:
                self.assertEqual(file["robot/0/vertex"][:].max(), 1)
                self.assertEqual(file["robot/1/vertex"][:, 0].min(), 5)

    def test_what_is_no_body_is_refused(self):
        (self.folder / "empty").mkdir()
        (self.folder / "two.obj").write_text(TWO_OBJECTS.replace("f 5 8 7", "f 5 8 70"))
        grid = ("--axis", "0,0,1", "--steps", 3, "-o", self.path("a.h5"))
        self.refused(self.path("empty"), "shape:cube", *grid, says="empty: the folder has no")
        self.refused(self.path("two.obj"), "shape:cube", *grid, says="two.obj")
        # corners count from 1, or from -1 backwards
        (self.folder / "two.obj").write_text(TWO_OBJECTS.replace("f 5 8 7", "f 5 8 0"))
        self.refused(self.path("two.obj"), "shape:cube", *grid, says="two.obj:[0-9]+: '0' is not a corner")
        self.refused("shape:cube", self.path("none.off"), *grid, says="none.off")
        self.assertEqual(sorted(os.listdir(self.folder)), ["box.off", "empty", "two.obj"])


class Usage(InFolder):
    def test_bad_usage(self):
        cubes, out = ("shape:cube", "shape:cube"), ("-o", self.path("a.h5"))
        axis = ("--axis", "0,0,1", "--steps", "5")
        self.refused(*cubes, *out, says="give one grid")
        self.refused(*cubes, *axis, "--grid", "hopf", "--level", "1", *out, says="give one grid")
        self.refused(*cubes, "--axis", "0,0,1", *out, says="--steps N beside it")
        self.refused(*cubes, "--axis", "0,0,0", "--steps", "5", *out, says="--axis: .*zero vector")
        self.refused(*cubes, "--axis", "0,0,1", "--steps", "0", *out, says="--steps: 0 is not between")
        self.refused(*cubes, "--grid", "hopf", "--level", "9", *out, says="--level: 9 is not between")
        self.refused(*cubes, *axis, says="-o FILE.h5 is missing")
        self.refused(*cubes, *axis, "-o", self.path("a.off"), says="ends in neither .h5 nor .hdf5")
        self.refused(*cubes, *axis, *out, "--threads", "0", says="--threads: 0 is not between")
        self.refused("shape:cube", *axis, *out, says="OBSTACLE... is missing")
        self.refused(*cubes, *axis, "-o", self.path("no/a.h5"), says=r"no/a\.h5\.lock: cannot write: No such file")

    def test_rotations_that_are_none(self):
        (self.folder / "nan.csv").write_text("0,0,0,1\n0,nan,0,1\n")
        self.refused("shape:cube", "shape:cube", "--rotations", self.path("nan.csv"), "-o", self.path("a.h5"),
                     says=r"nan\.csv.*2")

    def test_dry_run_makes_no_file(self):
        result = run("shape:icosahedron", "shape:gs2", "--grid", "hopf", "--level", 2, "--dry-run", "--json")
        told = json.loads(result.stdout)
        self.assertEqual((result.returncode, told["slices"], told["units"]), (0, 4608, 72))
        self.assertTrue(told["seconds"] > 0 and told["bytes"] > 4608)
        self.assertRegex(run("shape:cube", "shape:cube", "--axis", "0,0,1", "--steps", 10, "--dry-run").stdout,
                         "time +about .*\n +size +about")
        self.assertEqual(os.listdir(self.folder), ["box.off"])

    def test_dry_run_tells_the_size(self):
        job = ("shape:gs2", "shape:gs3", "--grid", "hopf", "--level", 1, "--json")
        for more in ((), ("--slices-per-unit", 32), ("--planes",)):
            foreseen = json.loads(run(*job, *more, "--dry-run").stdout)
            made = json.loads(self.make("a.h5", *job[4:], *more, models=job[:2], grid=job[2:4]).stdout)
            self.assertEqual(foreseen["units"], 18 if more and more[-1] == 32 else 9)
            self.assertTrue(0.7 < foreseen["bytes"] / made["bytes"] < 1.4, (foreseen["bytes"], made["bytes"]))
        self.refused(*job, "-o", self.path("a.h5"), "--slices-per-unit", "0", says="--slices-per-unit: 0 is not")


class WhatStandsThere(InFolder):
    JOB = ("shape:cube", "shape:cube", "--axis", "0,0,1", "--steps", 4)

    def other(self, name="a.h5"):
        self.make(name, models=("shape:tetrahedron", "shape:cube"), grid=("--axis", "0,0,1", "--steps", 5))
        return Path(self.path(name)).read_bytes()

    def test_a_link_is_followed(self):
        (self.folder / "far").mkdir()
        for old in (None, self.other("far/b.h5")):
            if old is None:
                (self.folder / "a.h5").symlink_to("far/b.h5")
            self.make("a.h5", models=self.JOB[:2], grid=self.JOB[2:])
            self.assertTrue((self.folder / "a.h5").is_symlink())
            self.assertNotEqual((self.folder / "far/b.h5").read_bytes(), old)
            self.assertEqual(os.listdir(self.folder / "far"), ["b.h5"])

    def test_what_is_no_file_is_refused_before_any_work(self):
        (self.folder / "folder.h5").mkdir()
        os.mkfifo(self.path("fifo.h5"))
        (self.folder / "link.h5").symlink_to("fifo.h5")
        (self.folder / "round.h5").symlink_to("round.h5")
        here = sorted(os.listdir(self.folder))
        many = ("shape:gs4", "shape:gs4", "--grid", "hopf", "--level", 3)
        for name, says in (("folder", "no regular file"), ("fifo", "no regular file"), ("link", "no regular file"),
                           ("round", "symbolic links")):
            self.refused(*many, "-o", self.path(name + ".h5"), says=rf"{name}\.h5: cannot write: .*{says}")
            self.assertFalse(os.path.exists(self.path(name + ".h5.part0")))
        self.assertEqual(sorted(os.listdir(self.folder)), here)

    def test_permissions_are_kept(self):
        old = self.other()
        os.chmod(self.path("a.h5"), 0o640)
        self.make("a.h5", models=self.JOB[:2], grid=self.JOB[2:])
        self.assertEqual(os.stat(self.path("a.h5")).st_mode & 0o7777, 0o640)
        self.assertNotEqual(Path(self.path("a.h5")).read_bytes(), old)

    @unittest.skipIf(os.geteuid() == 0, "all files may be written")
    def test_a_file_that_may_not_be_written_is_refused(self):
        self.other()
        os.chmod(self.path("a.h5"), 0o440)
        self.refused(*self.JOB, "-o", self.path("a.h5"), says=r"a\.h5: cannot write: Permission denied")

    def test_resuming_leaves_the_file_of_another_job(self):
        old = self.other()
        self.refused(*self.JOB, "-o", self.path("a.h5"), "--resume",
                     says=r"a\.h5: it is of another job; without resuming it is replaced")
        self.assertEqual(Path(self.path("a.h5")).read_bytes(), old)

    def test_a_run_over_an_older_file_resumes(self):
        self.make("whole.h5", models=self.JOB[:2], grid=self.JOB[2:])
        self.other()
        # what a run leaves that is killed before its first unit
        for left in (b"", Path(self.path("whole.h5")).read_bytes()[:3]):
            Path(self.path("a.h5.part0")).write_bytes(left)
            self.make("a.h5", "--resume", models=self.JOB[:2], grid=self.JOB[2:])
            self.assertEqual(Path(self.path("a.h5")).read_bytes(), Path(self.path("whole.h5")).read_bytes())
            self.other()


    def test_a_run_that_was_killed_before_the_sections_were_added_resumes(self):
        job = {"models": self.JOB[:2], "grid": self.JOB[2:]}
        self.make("whole.h5", "--planar", "z=0.25", **job)
        self.make("a.h5", **job)
        self.assertNotIn(b"planar", Path(self.path("a.h5")).read_bytes())
        for _ in range(2):  # sections that are there already are made anew
            self.make("a.h5", "--planar", "z=0.25", "--resume", **job)
            self.assertEqual(Path(self.path("a.h5")).read_bytes(), Path(self.path("whole.h5")).read_bytes())


class LongJobs(InFolder):
    GRID = ("--grid", "hopf", "--level", 2)
    MODELS = ("shape:gs2", "shape:gs3", "shape:icosahedron")

    def start(self, name, *args, **more):
        return subprocess.Popen([COMMAND, "slice", *self.MODELS, *map(str, self.GRID), "-o", self.path(name), *args],
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, **more)

    def whole(self):
        """The bytes of an undisturbed run, and its seconds."""
        start = time.monotonic()
        self.make("whole.h5", models=self.MODELS, grid=self.GRID)
        return Path(self.path("whole.h5")).read_bytes(), time.monotonic() - start

    def expect_finished(self, name, whole):
        self.make(name, "--resume", models=self.MODELS, grid=self.GRID)
        self.assertEqual(Path(self.path(name)).read_bytes(), whole)
        self.assertEqual([entry for entry in os.listdir(self.folder) if entry.startswith(name + ".")], [])

    def test_runs_that_are_killed_lose_nothing(self):
        whole, seconds = self.whole()
        moments = random.Random(os.environ.get("PIR_TEST_SEED", "1"))
        for kill in range(KILLS):
            with self.start("a.h5", *(["--resume"] if kill else []), *(["--threads", "2"] if kill % 2 else [])) as job:
                try:
                    job.wait(moments.uniform(0.02, 0.6 * seconds))
                except subprocess.TimeoutExpired:
                    job.kill()
            if (self.folder / "a.h5").exists():
                self.assertEqual(Path(self.path("a.h5")).read_bytes(), whole)
        self.expect_finished("a.h5", whole)

    def test_an_interrupted_run_says_what_is_kept(self):
        whole, seconds = self.whole()
        with self.start("a.h5") as job:
            part = Path(self.path("a.h5.part0"))
            while job.poll() is None and not (part.exists() and part.stat().st_size > 100):
                time.sleep(0.002)
            job.send_signal(signal.SIGINT)
            said = job.stderr.read()
        if job.returncode == -signal.SIGINT:
            self.assertRegex(said, r"ended after \d+ of 9216 slices, which are kept; --resume goes on\n")
            self.assertFalse((self.folder / "a.h5").exists())
        self.expect_finished("a.h5", whole)

    def test_a_full_disk_is_told_and_loses_nothing(self):
        whole, _ = self.whole()
        for share in (0.2, 0.9):
            def full(limit=int(share * len(whole))):
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

            args = (*self.MODELS, *self.GRID, "-o", self.path("a.h5"), *(["--resume"] if share > 0.5 else []))
            self.refused(*args, says=r"a\.h5(\.part0)?: cannot write: File too large", preexec_fn=full)
            self.assertFalse((self.folder / "a.h5").exists())
        self.expect_finished("a.h5", whole)

    def test_a_part_of_another_job_is_refused(self):
        with self.start("a.h5") as job:
            while job.poll() is None and not os.path.exists(self.path("a.h5.part0")):
                time.sleep(0.002)
            time.sleep(0.05)
            job.kill()
        self.refused("shape:cube", "shape:cube", *self.GRID, "-o", self.path("a.h5"), "--resume",
                     says=r"a\.h5\.part0: it is of another job")

    def test_threads_make_the_same_file(self):
        whole, _ = self.whole()
        self.make("a.h5", "--threads", 2, models=self.MODELS, grid=self.GRID)
        self.assertEqual(Path(self.path("a.h5")).read_bytes(), whole)


if __name__ == "__main__":
    COMMAND = sys.argv.pop(1)
    unittest.main(argv=["test_slice", *sys.argv[1:]])
