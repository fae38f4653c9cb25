#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""pirouette simulate: what stands and what rests, pages, recordings, and scenes that are refused."""
import base64
import json
import math
import os
import re
import struct
import threading
import zlib
from pathlib import Path

from command_test import CommandTest, main

SCENES = Path(__file__).resolve().parents[2] / "examples" / "scenes"
CUBE = {"model": "shape:box?x=1&y=1&z=1"}
SLAB = {"points": [[x, y, z] for x in (-5, 5) for y in (-5, 5) for z in (-1, 0)]}


def scene(bodies=(), **more):
    floor = {"shape": "slab", "kind": "static"}
    return {"shapes": {"cube": CUBE, "slab": SLAB}, "bodies": [floor, *bodies], **more}


def cube(z, **more):
    return {"shape": "cube", "position": [0, 0, z], **more}


def numbers(data):
    """Numbers of 7 bits a byte."""
    value, place = 0, 0
    for byte in data:
        value |= (byte & 127) << place
        place += 7
        if byte < 128:
            yield value
            value, place = 0, 0


def png(rows, bits):
    """Grey, rows of whole numbers."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    pixels = b"".join(b"\0" + b"".join(n.to_bytes(bits // 8, "big") for n in row) for row in rows)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), bits, 0, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(pixels)) + chunk(b"IEND", b""))


def on_ground(ground, bodies=None, **more):
    """A cube over the middle of a ground of 4 by 4 m."""
    bodies = [cube(0.6)] if bodies is None else bodies
    return {"shapes": {"cube": CUBE, "ground": ground}, "seconds": 1,
            "bodies": [{"shape": "ground", "kind": "static", "position": [-2, -2, 0]}, *bodies], **more}


class Simulated(CommandTest):
    def scene(self, data, name="scene.json"):
        return self.file(name, data if isinstance(data, (str, bytes)) else json.dumps(data))

    def page(self, path):
        text = path.read_text()
        self.assertFalse(re.search(r'(?:src|href)\s*=|https?://|import\s*\(|fetch\(', text))
        return json.loads(re.search(r'<script id="data" type="application/json">(.*?)</script>', text, re.S)[1])


def signed(n):
    return -(n + 1) // 2 if n % 2 else n // 2


def normal_of(x, y):
    """From the square that an octahedron was folded into."""
    z = 1 - abs(x) - abs(y)
    if z < 0:
        x, y = (1 - abs(y)) * (1 if x >= 0 else -1), (1 - abs(x)) * (1 if y >= 0 else -1)
    length = math.sqrt(x * x + y * y + z * z)
    return x / length, y / length, z / length


def frames_of(page):
    """The poses of each frame, the looks and the contacts, decoded as the page says."""
    at = numbers(base64.b64decode(page["motion"]))
    count = len(page["shape"])
    pose, look, contacts, frames = [[0] * 7 for _ in range(count)], [0] * count, [], []
    for _ in range(page["frames"]):
        body = -1
        for _ in range(next(at)):
            body += next(at) + 1
            pose[body] = [old + signed(next(at)) for old in pose[body]]
        body = -1
        for _ in range(next(at)):
            body += next(at) + 1
            look[body] = next(at)
        points = next(at)
        if points:
            contacts, place = [], [0, 0, 0]
            for _ in range(points - 1):
                place = [old + signed(next(at)) for old in place]
                contacts.append((*(8 * page["quantum"] * c for c in place), next(at), (next(at), next(at)),
                                 normal_of(next(at) / 63 - 1, next(at) / 63 - 1)))
        q = page["quantum"]
        frames.append(([[*(c * q for c in p[:3]), *(c / 16384 for c in p[3:])] for p in pose], look[:], contacts))
    assert next(at, None) is None
    return frames


def read_recording(path):
    data = path.read_bytes()
    assert data[:8] == b"SCENE01\0"
    shapes, bodies, statics, frames = struct.unpack_from("<4I", data, 8)
    at, hulls = 28, []
    for _ in range(shapes):
        vertices, triangles = struct.unpack_from("<2I", data, at)
        points = [struct.unpack_from("<3f", data, at + 8 + 12 * i) for i in range(vertices)]
        at += 8 + 12 * vertices
        corners = [struct.unpack_from("<3I", data, at + 12 * i) for i in range(triangles)]
        at += 12 * triangles
        hulls.append((points, corners))
    boxes = [struct.unpack_from("<10f", data, at + 40 * i) for i in range(statics)]
    at += 40 * statics
    shape = struct.unpack_from(f"<{bodies}I", data, at)
    at += 4 * bodies
    poses = [[struct.unpack_from("<7f", data, at + 28 * (f * bodies + i)) for i in range(bodies)]
             for f in range(frames)]
    assert at + 28 * frames * bodies == len(data)
    return {"dt": struct.unpack_from("<f", data, 24)[0], "hulls": hulls, "boxes": boxes, "shape": shape, "poses": poses}


class Simulate(Simulated):
    def test_what_stands_stands(self):
        for name, moving in (("stack", 10), ("cards", 15)):
            recording = self.path / "run.bin"
            told = self.data("simulate", SCENES / f"{name}.json", "--awake", "--seconds", 3, "--record", recording)
            self.assertEqual((told["moving"], told["asleep"], told["duration"], told["steps"]), (moving, 0, 3, 720))
            self.assertLess(told["mean_speed"], 1e-3)
            poses = read_recording(recording)["poses"]
            self.assertEqual(len(poses), 181)
            for first, last in zip(poses[0], poses[-1]):
                self.assertLess(max(abs(a - b) for a, b in zip(first[:3], last[:3])), 0.012, name)

    def test_a_fall_is_what_gravity_makes_it(self):
        recording, page = self.path / "fall.bin", self.path / "fall.html"
        spun = cube(4, velocity=[1, 0, 0], spin=[0, 0, 1])
        path = self.scene(scene([spun], gravity=[0, 0, -10], seconds=0.5))
        told = self.data("simulate", path, "--record", recording, "-o", page)
        run = read_recording(recording)
        self.assertEqual((len(run["poses"]), len(run["boxes"])), (31, 1))
        self.assertAlmostEqual(run["dt"], 1 / 60, delta=1e-8)
        # about its centre the slab is a box
        self.assertEqual(run["boxes"][0], (5, 5, 0.5, 0, 0, -0.5, 0, 0, 0, 1))
        frames = frames_of(self.page(page))
        self.assertEqual((told["frames"], len(frames)), (16, 16))
        for f, poses in enumerate(run["poses"]):
            t = f / 60
            x, y, z, *quat = poses[-1]
            # a parabola, whatever the steps are
            self.assertAlmostEqual(z, 4 - 5 * t * t, delta=1e-5)
            self.assertAlmostEqual(x, t, delta=1e-5)
            self.assertAlmostEqual(abs(quat[2]), math.sin(t / 2), delta=1e-5)
            if f % 2 == 0:
                for a, b in zip(frames[f // 2][0][-1], poses[-1]):
                    self.assertAlmostEqual(a, b, delta=1e-3)

    def test_levels_and_contacts_of_a_page(self):
        page = self.path / "rest.html"
        self.good("simulate", self.scene(scene([cube(0.6), cube(3)], seconds=4)), "-o", page)
        data = self.page(page)
        frames = frames_of(data)
        self.assertEqual(data["kind"], [2, 0, 0])
        self.assertEqual(frames[0][1:], ([0, 0, 0], []))
        self.assertEqual(frames[-1][1][1:], [3, 3])  # asleep
        self.assertEqual(len(frames[-1][2]) >= 8, True)
        # bodies that begin in each other overlap, and those that meet do not
        self.assertFalse(any(look[1] == 2 for _, look, _ in frames[:10]))
        deep = self.path / "deep.html"
        self.good("simulate", self.scene(scene([cube(0.4)], seconds=1)), "-o", deep)
        self.assertTrue(any(look[1] == 2 for _, look, _ in frames_of(self.page(deep))))
        for x, y, z, kind, bodies, normal in frames[-1][2]:
            self.assertLess(max(abs(x), abs(y)), 0.52)
            self.assertLess(min(abs(z), abs(z - 1)), 0.02)
            self.assertIn(sorted(bodies), ([0, 1], [1, 2]))
            self.assertGreater(abs(normal[2]), 0.9999)

    def test_runs_are_the_same(self):
        states = set()
        for more in ([], ["--threads", 3]):
            told = self.data("simulate", SCENES / "heap.json", "--seconds", 0.6, *more)
            states.add(told["state"])
            self.assertEqual(told["seconds"] > 0, True)
        self.assertEqual(len(states), 1)

    def test_contacts_told_again(self):
        """Runs with --reuse are the same by any number of threads, but not those without."""
        told = [self.data("simulate", SCENES / "stack.json", "--seconds", 2, "--awake", *more)["state"]
                for more in ([], ["--reuse", 0.001], ["--reuse", 0.001, "--threads", 3])]
        self.assertNotEqual(told[0], told[1])
        self.assertEqual(told[1], told[2])
        for length in (-1, "nan", "inf", "x"):
            self.bad("simulate", SCENES / "stack.json", "--reuse", length, says=("--reuse",))

    def test_every_shipped_scene_runs(self):
        names = sorted(path.stem for path in SCENES.glob("*.json"))
        self.assertEqual(names, ["bullets", "cards", "character", "dominoes", "game", "gears", "heap", "pile",
                                 "rollback", "sensors", "slot", "stack", "table", "terrain", "thousands"])
        for name in names:
            told = self.data("simulate", SCENES / f"{name}.json", "--seconds", 0.05)
            self.assertGreater(told["moving"], 0)

    def test_scenes_have_names(self):
        listed = {one["name"]: one for one in self.data("simulate", "--list")["scenes"]}
        self.assertEqual(sorted([*listed, "pile", "table"]), sorted(path.stem for path in SCENES.glob("*.json")))
        for name, one in listed.items():
            said = json.loads((SCENES / f"{name}.json").read_text())
            self.assertEqual((one["title"], one["about"]), (said["title"], said["about"]))
            self.assertIn(f"scene:{name} ", self.good("simulate", "--list"))
        states = {self.data("simulate", path, "--seconds", 0.5)["state"]
                  for path in ("scene:heap", SCENES / "heap.json")}
        self.assertEqual(len(states), 1)
        self.bad("simulate", "scene:none", says=["scene:none", "--list"])
        self.bad("simulate", "--list", "scene:heap", says="alone")

    def test_the_page_tells_what_updates_did(self):
        path, page = self.scene(scene([cube(0.6)], seconds=0.5)), self.path / "p.html"
        self.good("simulate", path, "-o", page)
        bytes_of = page.read_bytes()
        self.good("simulate", path, "-o", page, "--threads", 2)
        self.assertEqual(page.read_bytes(), bytes_of)  # without times it is the same each time
        counts = {name: (unit, *numbers) for name, unit, *numbers in self.page(page)["profile"]}
        self.assertEqual(counts["bodies moved"][0], "")
        self.assertEqual(counts["bodies moved"][3], 2)  # in the first update, to which the floor is new
        self.assertEqual(counts["contacts"][3], 4)
        self.good("simulate", path, "-o", page, "--times")
        rows = self.page(page)["profile"]
        self.assertEqual([row for row in rows if not row[1]], [[name, *row] for name, row in counts.items()])
        times = [row for row in rows if row[1] == "µs"]
        self.assertEqual((times[0][0], len(times)), ("update", 8))
        self.assertAlmostEqual(times[0][2], sum(row[2] for row in times[1:]), delta=1e-3 * times[0][2])
        for _, _, mean, p99, worst in rows:
            self.assertTrue(0 <= mean <= worst and p99 <= worst)

    def test_a_sensor_tells_and_holds_nothing(self):
        """A cube that falls through a sensor is in it where their boxes meet, and falls as it would without."""
        zone = {"shape": "cube", "kind": "static", "sensor": True, "position": [0.25, 0, 2.25]}
        with_zone, without = self.path / "with.html", self.path / "without.html"
        self.good("simulate", self.scene(scene([cube(4), zone], seconds=2)), "-o", with_zone)
        self.good("simulate", self.scene(scene([cube(4)], seconds=2)), "-o", without)
        page = self.page(with_zone)
        self.assertEqual(page["sensors"], [2])
        looks = set()
        for (poses, look, contacts), (others, _, same) in zip(frames_of(page), frames_of(self.page(without))):
            self.assertEqual((poses[:2], contacts), (others, same))
            gap = abs(poses[1][2] - 2.25) - 1
            if abs(gap) > 1e-3:
                self.assertEqual(look[1] == 4, gap < 0, (gap, look))
            looks.add(look[1])
        self.assertEqual(looks, {0, 2, 3, 4} if 2 in looks else {0, 1, 3, 4})

    def test_a_rollback_goes_back(self):
        """After it the run is that of the earlier time, bit for bit, and elsewhere with another velocity."""
        bodies = [cube(0.6), cube(1.8, quat=[0.1, 0.2, 0, 1], velocity=[0.5, 0, 0])]
        short = self.data("simulate", self.scene(scene(bodies, seconds=1)))["state"]
        back, page = {"at": 1.5, "to": 0.5}, self.path / "b.html"
        for more in ([], ["--threads", 3]):
            told = self.data("simulate", self.scene(scene(bodies, seconds=2, rollbacks=[back])), "-o", page, *more)
            self.assertEqual((told["state"], told["duration"]), (short, 2))
        frames = frames_of(self.page(page))
        self.assertEqual(frames[45:61], frames[15:31])
        self.assertNotEqual(frames[44][0], frames[14][0])
        twice = [back, {"at": 2, "to": 1.75}]
        states = [self.data("simulate", self.scene(scene(bodies, seconds=s, rollbacks=b)))["state"]
                  for s, b in ((2.25, twice), (2, [back | {"body": 2, "velocity": [0, 1, 0]}]))]
        self.assertEqual(states[0], short)
        self.assertNotEqual(states[1], short)

    def test_a_body_walks(self):
        """Up two stairs, to a point and to another, where it stays."""
        capsule = {"points": [[x, y, z] for x in (-0.2, 0.2) for y in (-0.2, 0.2) for z in (-0.6, 0.6)]
                   + [[0, 0, -0.9], [0, 0, 0.9]]}
        stairs = [{"shape": "slab", "kind": "static", "position": [6 + 0.5 * i, 0, 0.25 * (i + 1)]} for i in range(2)]
        walker = {"shape": "capsule", "kind": "kinematic", "position": [-1, 0, 1], "walk": [[3, 0], [3, 2]], "speed": 2}
        data = scene([walker, *stairs], seconds=5)
        data["shapes"]["capsule"] = capsule
        page = self.path / "w.html"
        states = {self.data("simulate", self.scene(data), "-o", page, "--threads", n)["state"] for n in (1, 2)}
        self.assertEqual(len(states), 1)
        poses = [frame[0][1] for frame in frames_of(self.page(page))]
        self.assertTrue(any(abs(x - 3) < 0.06 and abs(y) < 0.06 and z > 1.3 for x, y, z, *_ in poses))
        self.assertLess(max(abs(poses[-1][0] - 3), abs(poses[-1][1] - 2)), 0.06)
        self.assertEqual(poses[-1], poses[-15])

    def test_grids_are_many_bodies(self):
        page = self.path / "g.html"
        many = {"shape": ["cube", "small"], "grid": [3, 2, 2], "apart": [2, 3, 4], "position": [1, 1, 5], "turned": 7}
        data = scene([many, cube(0.5, velocity=[0, 0, 0])], seconds=0)
        data["shapes"]["small"] = CUBE | {"scale": 0.5}
        self.assertEqual(self.data("simulate", self.scene(data), "-o", page)["bodies"], 14)
        told = self.page(page)
        poses = frames_of(told)[0][0]
        kinds = [list(data["shapes"]).index(name) for name in ("cube", "small")]
        self.assertEqual(told["shape"][1:13], kinds * 6)
        places = [(1 + 2 * i, 1 + 3 * j, 5 + 4 * k) for k in range(2) for j in range(2) for i in range(3)]
        for place, pose in zip(places, poses[1:13]):
            self.assertLess(max(abs(a - b) for a, b in zip(place, pose)), 1e-3)
        self.assertEqual(len({tuple(pose[3:]) for pose in poses[1:13]}), 12)

    def test_a_recording_has_what_a_replay_needs(self):
        recording = self.path / "heap.bin"
        self.good("simulate", SCENES / "heap.json", "--seconds", 0.1, "--record", recording)
        run = read_recording(recording)
        self.assertEqual((len(run["boxes"]), len(run["shape"]), len(run["poses"])), (5, 80, 7))
        for points, corners in run["hulls"]:
            self.assertEqual(len(points) - len(corners) / 2, 2)  # Euler's count for triangles
        self.assertTrue(all(abs(sum(c * c for c in pose[3:]) - 1) < 1e-5 for pose in run["poses"][-1]))
        self.assertIn("bodies[1] has 32 pieces", self.run_command(
            "simulate", SCENES / "gears.json", "--record", self.path / "gears.bin").stderr)

    def test_empty_and_short_runs(self):
        page = self.path / "none.html"
        for data, bodies in (({"shapes": {}, "bodies": []}, 0), (scene(), 1), (scene([cube(1)], seconds=0), 2)):
            told = self.data("simulate", self.scene(data), "-o", page, "--seconds", 0)
            self.assertEqual((told["bodies"], told["steps"], told["frames"]), (bodies, 0, 1))
            self.page(page)
        self.assertEqual(self.data("simulate", self.scene({"shapes": {}, "bodies": []}))["duration"], 10)

    def test_bodies_that_begin_in_each_other_part(self):
        told = self.data("simulate", self.scene(scene([cube(0.5)] * 6, seconds=3)))
        self.assertLess(told["deepest"], 0.02)

    def test_huge_and_tiny_bodies(self):
        for density in (1e-9, 1e15):
            told = self.data("simulate", self.scene(scene([cube(0.6, density=density), cube(1.7)], seconds=1)))
            self.assertLess(told["mean_speed"], 1)
        self.bad("simulate", self.scene(scene([cube(1e300, velocity=[1e300, 0, 0])])), says="scene.json")
        self.bad("simulate", self.scene(scene([cube(4, velocity=[1e17, 0, 0])], gravity=[1e18, 0, 0])),
                 says=["scene.json", "after"])

    def test_targets(self):
        path = self.scene(scene([cube(1)], seconds=0.1))
        link, real = self.path / "link.html", self.path / "real.html"
        link.symlink_to(real)
        self.good("simulate", path, "-o", link)
        self.assertTrue(link.is_symlink() and real.read_text().startswith("<!DOCTYPE html>"))
        self.assertTrue(self.good("simulate", path, "-o", "-").startswith("<!DOCTYPE html>"))
        fifo = self.path / "fifo"
        os.mkfifo(fifo)
        got = []
        reader = threading.Thread(target=lambda: got.append(fifo.read_bytes()))
        reader.start()
        self.good("simulate", path, "-o", fifo)
        reader.join()
        self.assertIn(b"</html>", got[0])
        self.good("simulate", path, "-o", "/dev/null", "--record", self.path / "r.bin")
        for option, target, says in (("-o", self.path / "a.txt", ".html"), ("-o", "/dev/full", "/dev/full"),
                                     ("--record", "/dev/full", "/dev/full"), ("--record", self.path, str(self.path)),
                                     ("-o", self.path / "no" / "a.html", "no")):
            self.bad("simulate", path, option, target, says=says)
        self.bad("simulate", path, "-o", self.path / "a.html", "--record", self.path / "a.html", says="both")
        self.bad("simulate", path, "-o", "-", "--record", "-", says="both")
        self.bad("simulate", path, "-o", "-", "--json", says="--json")
        for seconds in (-1, "nan", 1e9, "x", ""):
            self.bad("simulate", path, "--seconds", seconds, says="--seconds")

    def test_scenes_that_are_refused(self):
        def refused(data, *says):
            self.bad("simulate", self.scene(data), says=["scene.json", *says])

        def body(**more):
            return scene([cube(1) | more])

        for text, says in (("", "line 1"), ("{", "line 1"), ("[]", "no object"), ("{} x", "line 1"),
                           ("null", "no object"), ('{\n"shapes": {},\n "bodies" 1}', "line 3"),
                           ('{"bodies": [NaN]}', "no JSON"),
                           (b"{\0}", "zero byte"), ("[" * 100000, "no JSON"), ('{"shapes": {}}', "bodies: is missing"),
                           ('{"bodies": []}', "shapes: is missing"), ('{"shapes": {}, "bodies": {}}', "no array"),
                           ('{"shapes": {}, "bodies": [], "bodies": []}', "twice"), ("\xff\xfe", "line 1")):
            refused(text, says)
        refused(scene(colour=1), "unknown key 'colour'")
        refused(scene(**{"a\nb\x1b[31m": 1}), "unknown key 'a?b?[31m'")
        refused(scene(gravity=[0, 0]), "gravity", "3 numbers")
        refused('{"shapes": {}, "bodies": [], "gravity": [0, 0, 1e999]}', "gravity", "not finite")
        refused(scene(seconds=-1), "seconds: -1")
        refused(scene(seconds=1e6), "seconds")
        refused(scene(sleep=1), "sleep: is neither true nor false")
        refused(scene(title="x" * 200), "title")
        refused(scene(title=3), "title")
        refused(scene(["x"]), "bodies[1]", "no object")
        refused(body(shape="ball"), "bodies[1].shape", "'ball'")
        refused(body(postion=[0, 0, 0]), "bodies[1]", "'postion'")
        refused(body(position=[0, 0, "1"]), "bodies[1].position", "element 2")
        refused(body(quat=[0, 0, 0, 0]), "bodies[1].quat")
        refused(body(kind="dynamic"), "bodies[1].kind", "'dynamic' is none of moving, kinematic, static")
        refused(body(kind="static", velocity=[1, 0, 0]), "bodies[1]", "static")
        refused(body(density=0), "bodies[1].density")
        refused(body(density="heavy"), "bodies[1].density")
        refused(body(friction=-0.1), "friction")
        refused(body(restitution=2), "restitution")
        refused(body(sensor=True), "bodies[1].sensor")
        refused(body(sensor=1, kind="static"), "bodies[1].sensor")
        refused(scene(about=1), "about")
        for more, says in (({"walk": [[0, 0]]}, "walk"), ({"walk": [], "kind": "kinematic"}, "walk: is empty"),
                           ({"walk": [[0]], "kind": "kinematic"}, "walk: element 0"), ({"speed": 1}, "speed"),
                           ({"walk": [[0, 0]], "kind": "kinematic"}, "shape: is not higher than wide"),
                           ({"walk": [[0, 0]], "kind": "kinematic", "grid": [1, 1, 1]}, "walk"),
                           ({"grid": [0, 1, 1]}, "grid: element 0"), ({"grid": [1.5, 1, 1]}, "grid"),
                           ({"grid": [2000, 2000, 1]}, "more than"), ({"apart": [1, 1, 1]}, "grid: is missing"),
                           ({"grid": [1, 1, 1], "shape": [1]}, "shape"), ({"shape": ["cube"]}, "shape: is no text"),
                           ({"grid": [1, 1, 1], "shape": ["ball"]}, "'ball'")):
            refused(body(**more), "bodies[1]", says)
        for back, says in (({}, "at: is missing"), ({"at": 1}, "to: is missing"), ({"at": 1, "to": 1}, "goes back"),
                           ({"at": 1, "to": 0, "body": 1}, "not both"), ({"at": 1, "to": 0, "when": 1}, "unknown key"),
                           ({"at": 1, "to": 0, "body": 0, "velocity": [0, 0, 0]}, "body: 0"),
                           ({"at": 1, "to": 0, "body": 9, "velocity": [0, 0, 0]}, "body: 9")):
            refused(scene([cube(1)], rollbacks=[back]), "rollbacks[0]", says)
        refused(scene(rollbacks=[{"at": 2, "to": 0}, {"at": 1, "to": 0}]), "rollbacks[1]", "in order")
        refused(scene(rollbacks={}), "rollbacks: is no array")
        for shape, says in (({}, "none of"), ({"model": "shape:nosuch"}, "nosuch"), ({"model": "none.off"}, "none.off"),
                            ({"model": 1}, "no text"), ({"points": []}, "empty"), ({"points": [[0, 0]]}, "element 0"),
                            ({"points": [[0, 0, 0]]}, "flat"), ({"pieces": []}, "empty"),
                            ({"pieces": [{"pieces": [{"pieces": [{"pieces": [{"pieces": [CUBE]}]}]}]}]}, "too deep"),
                            ({"model": "shape:cube", "points": [[0, 0, 0]]}, "more than one"),
                            ({"model": "shape:cube", "scale": 0}, "scale"),
                            ({"points": [[0, 0, 0]], "solid": True}, "solid"),
                            ({"model": str(self.path)}, str(self.path)), ({"model": "scene.json"}, "scene.json")):
            refused({"shapes": {"cube": shape}, "bodies": [cube(1)]}, "cube" if says != "flat" else "bodies[0]", says)
        self.bad("simulate", self.path / "none.json", says="none.json")
        self.bad("simulate", self.path, says=str(self.path))
        self.bad("simulate", says="SCENE.json")

    def test_grounds_that_are_surfaces(self):
        flat = [[0] * 5 for _ in range(5)]
        self.file("flat.txt", "# five rows\n" + "\n".join("0, 0 0;0\t0" for _ in range(5)))
        self.file("flat.obj", "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nf 1 2 3\nf 1 3 4\n")
        self.file("small.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3\nf 1 3 4\n")
        self.stands_on({"heights": flat}, {"heights": "flat.txt"}, {"mesh": "flat.obj"},
                       {"mesh": "small.obj", "scale": 2, "two_sided": True})

    def test_grounds_that_are_pictures(self):
        for name, data in (("flat8.png", png([[51] * 5] * 5, 8)), ("flat16.png", png([[13107] * 5] * 5, 16)),
                           ("black.png", png([[0] * 5] * 5, 8))):
            self.file(name, data)
        done = self.run_command("simulate", self.scene(on_ground({"heights": "black.png"})))
        if done.returncode and "made without libpng" in done.stderr:
            for says in ("shapes.ground.heights", "black.png", "-Dpng=enabled"):
                self.assertIn(says, done.stderr)
            self.skipTest("this build has no libpng")
        self.stands_on({"heights": "flat8.png", "range": [-1, 4]}, {"heights": "flat16.png", "range": [-1, 4]},
                       {"heights": "black.png"}, {"heights": "flat8.png", "range": [0, 0]})

    def stands_on(self, *grounds):
        for ground in grounds:
            path = self.scene(on_ground(ground))
            first = self.data("simulate", path, "-o", self.path / "g.html")
            # it falls a tenth of a metre, and stands on four contacts
            self.assertEqual(first["contacts"], 4, ground)
            self.assertLess(first["deepest"], 1e-4)
            self.assertLess(first["mean_speed"], 1e-3)
            page = self.page(self.path / "g.html")
            self.assertAlmostEqual(frames_of(page)[-1][0][1][2], 0.5, delta=1e-3)
            for threads in (2, 4):
                self.assertEqual(self.data("simulate", path, "--threads", threads)["state"], first["state"])

    def test_heights_come_through_a_pipe(self):
        path, fifo = self.scene(on_ground({"heights": "pipe"}), "piped.json"), self.path / "pipe"
        flat = {"heights": [[0] * 5] * 5}
        os.mkfifo(fifo)
        writer = threading.Thread(target=lambda: fifo.write_text("0 , 0\t0 0 0 \n" * 5))
        writer.start()
        told = self.data("simulate", path)
        writer.join()
        self.assertEqual(told["contacts"], 4)
        self.assertEqual(told["state"], self.data("simulate", self.scene(on_ground(flat)))["state"])

    def test_recordings_hold_no_surface(self):
        recording, ground = self.path / "ground.bin", {"heights": [[0, 0], [0, 0]]}
        self.bad("simulate", self.scene(on_ground(ground)), "--record", recording, "-o", self.path / "ground.html",
                 says=["--record", "bodies[0] is a surface", "do not hold surfaces yet"])
        self.assertFalse(recording.exists() or (self.path / "ground.html").exists())
        # that no body is of such a shape is no harm
        unused = scene([cube(1)], seconds=0.1)
        unused["shapes"] = {"ground": ground, "two": {"pieces": [CUBE, SLAB]}} | unused["shapes"]
        self.good("simulate", self.scene(unused), "--record", recording)
        run = read_recording(recording)
        self.assertEqual(([len(points) for points, _ in run["hulls"]], run["shape"], len(run["poses"])),
                         ([0, 0, 8, 8], (2,), 7))

    def test_a_run_is_of_whole_frames(self):
        path, recording = self.scene(scene([cube(4)])), self.path / "run.bin"
        for seconds, frames in ((0, 0), (1e-9, 1), (0.01, 1), (0.024, 1), (0.026, 2), (0.06, 4), (0.1, 6), (1 / 60, 1)):
            told = self.data("simulate", path, "--seconds", seconds, "--record", recording)
            self.assertEqual((told["steps"], told["duration"]), (4 * frames, frames / 60))
            self.assertEqual(len(read_recording(recording)["poses"]), frames + 1)
            said = self.good("simulate", self.scene(scene([cube(4)], seconds=seconds)))
            self.assertEqual(f"as near to {seconds:g} s as" in said, seconds not in (0, 0.1, 1 / 60), said)

    def test_a_hole_lets_fall(self):
        heights = [[0, 0, 0, 0, 0], [0, 0, 0, 0, 0], [0, 0, None, 0, 0], [0, 0, 0, 0, 0], [0, 0, 0, 0, 0]]
        path = self.scene(on_ground({"heights": heights}))
        self.data("simulate", path, "-o", self.path / "h.html")
        self.assertLess(frames_of(self.page(self.path / "h.html"))[-1][0][1][2], -1)

    def test_grounds_that_are_refused(self):
        self.file("bad.txt", "0 0\n0 x\n")
        self.file("ragged.txt", "0 0\n\n0\n")
        self.file("wide.txt", "0 0\n0 0 0\n")
        self.file("one.txt", "1 2 3\n")
        self.file("holes.txt", "nan nan\nnan nan\n")
        for name, data in (("gap.csv", "# all alike\n0,,0\n0,,0\n"), ("lead.csv", "0;0\n ;0\n"),
                           ("trail.csv", "0,0,\r\n0,0,"),
                           ("empty.txt", ""), ("notes.txt", "# none\n\n"), ("zeros.txt", "0 0\n0 0\0 0\n"),
                           ("inf.txt", "0 0\n0 -inf\n"), ("huge.txt", "0 1e400\n0 0\n")):
            self.file(name, data)
        self.file("cut.png", png([[0] * 5] * 5, 8)[:40])
        self.file("lies.png", png([[0] * 5] * 5, 8).replace(b"IDAT", b"IDAX"))
        self.file("nan.obj", "v 0 0 0\nv 4 0 nan\nv 4 4 0\nf 1 2 3\n")
        self.file("index.obj", "v 0 0 0\nv 4 0 0\nv 4 4 0\nf 1 2 9\n")
        for ground, *says in (({"heights": "bad.txt"}, "shapes.ground.heights", "bad.txt", "line 2", "column 2"),
                              ({"heights": "ragged.txt"}, "ragged.txt", "line 3", "fewer"),
                              ({"heights": "wide.txt"}, "wide.txt", "line 2", "more"),
                              ({"heights": "one.txt"}, "shapes.ground.heights", "one.txt: 3 columns and 1 rows"),
                              ({"heights": "holes.txt"}, "shapes.ground.heights", "holes.txt: every cell is a hole"),
                              ({"heights": "none.txt"}, "none.txt", "cannot be read"),
                              ({"heights": "gap.csv"}, "shapes.ground.heights", "gap.csv: line 2: nothing in column 2"),
                              ({"heights": "lead.csv"}, "lead.csv: line 2: nothing in column 1"),
                              ({"heights": "trail.csv"}, "trail.csv: line 1: nothing in column 3"),
                              ({"heights": "empty.txt"}, "shapes.ground.heights", "empty.txt: is empty"),
                              ({"heights": "notes.txt"}, "notes.txt: has no row of numbers"),
                              ({"heights": "zeros.txt"}, "zeros.txt: line 2: no text, has a zero in byte 4"),
                              ({"heights": "inf.txt"}, "inf.txt: line 2: no finite number in column 2"),
                              ({"heights": "huge.txt"}, "huge.txt: line 1: no finite number in column 2"),
                              ({"heights": "."}, ".: cannot be read: Is a directory"),
                              ({"heights": 3}, "shapes.ground.heights: is neither an array of rows nor the name"),
                              ({}, "shapes.ground", "none of"),
                              ({"heights": "cut.png"}, "cut.png"), ({"heights": "lies.png"}, "lies.png"),
                              ({"heights": [[0, 0], [0]]}, "shapes.ground.heights", "row 1"),
                              ({"heights": [[0, "1"], [0, 0]]}, "shapes.ground.heights", "row 0"),
                              ({"heights": [[0, 0], [0, 0]], "step": [0, 1]}, "shapes.ground.step"),
                              ({"heights": [[0, 0], [0, 0]], "range": [0, 1]}, "shapes.ground.range", "picture"),
                              ({"heights": [[0, 0], [0, 0]], "scale": 2}, "'scale'"),
                              ({"mesh": "nan.obj"}, "shapes.ground.mesh"), ({"mesh": "index.obj"}, "index.obj:4"),
                              ({"mesh": "none.obj"}, "none.obj"), ({"mesh": 3}, "shapes.ground.mesh", "no text")):
            self.bad("simulate", self.scene(on_ground(ground)), says=says[0])
            for text in says[1:]:
                self.bad("simulate", self.scene(on_ground(ground)), says=text)
        moving = on_ground({"heights": [[0, 0], [0, 0]]}, [{"shape": "ground"}])
        self.bad("simulate", self.scene(moving), says="bodies[1].shape: is a surface")

    def test_models_are_found_from_the_scene_on(self):
        (self.path / "deep").mkdir()
        data = {"shapes": {"t": {"model": "../tetrahedron.off"}, "s": {"model": "../tetrahedron.off", "solid": True}},
                "bodies": [{"shape": "t"}, {"shape": "s", "position": [3, 0, 0]}]}
        path = self.scene(data, "deep/scene.json")
        self.assertEqual(self.data("simulate", path, "--seconds", 0.1)["moving"], 2)

    def test_memory_that_runs_out(self):
        path = self.scene(scene([cube(0.6)], seconds=0.1))
        for number in range(1, 60, 7):
            done = self.fault("memory", number, "simulate", path, "-o", self.path / "m.html")
            if not self.fault_came:
                break
            self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
            self.assertFalse((self.path / "m.html").exists())


if __name__ == "__main__":
    main()
