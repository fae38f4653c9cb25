#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the scenes beside this file, for `pirouette simulate`: make_scenes.py [FOLDER]

Metres, kilograms, seconds; z is up. Only the standard library is used, and nothing of the build depends on this script.
"""
import json
import math
import pathlib
import random
import sys


def about(axis, degrees):
    """The quaternion of a turn about x, y or z."""
    half = math.radians(degrees) / 2
    quat = [0.0, 0.0, 0.0, math.cos(half)]
    quat["xyz".index(axis)] = math.sin(half)
    return quat


def times(a, b):
    """First b, then a."""
    (x, y, z, w), (p, q, r, s) = a, b
    return [w * p + x * s + y * r - z * q, w * q - x * r + y * s + z * p, w * r + x * q - y * p + z * s,
            w * s - x * p - y * q - z * r]


def rounded(value):
    if isinstance(value, float):
        return round(value, 9) + 0.0
    if isinstance(value, list):
        return [rounded(v) for v in value]
    return {k: rounded(v) for k, v in value.items()} if isinstance(value, dict) else value


def box(x, y, z):
    return {"points": [[i * x / 2, j * y / 2, k * z / 2] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]}


def body(shape, position, quat=None, **more):
    return {"shape": shape, "position": list(position), **({"quat": quat} if quat else {}), **more}


def floor(size, **more):
    """A slab whose top is at z = 0."""
    return {"floor": box(size, size, 0.1)}, body("floor", [0, 0, -0.05], kind="static", **more)


def stack():
    shapes, ground = floor(4.0)
    shapes["crate"] = box(0.4, 0.4, 0.4)
    crates = [body("crate", [0, 0, 0.2 + 0.4 * i], density=300) for i in range(10)]
    return {"title": "A stack of ten boxes", "seconds": 10, "shapes": shapes, "bodies": [ground, *crates]}


def cards():
    """Three storeys: 3, 2 and 1 pairs of leaning cards, with 2 and 1 flat ones between them."""
    height, depth, thick, tilt, apart = 0.2, 0.14, 0.004, 25, 0.205
    s, c = math.sin(math.radians(tilt)), math.cos(math.radians(tilt))
    shapes, ground = floor(2.0, friction=0.7)
    shapes["card"] = box(thick, depth, height)
    # a leaning card reaches so far from its middle
    across, up = (height * s + thick * c) / 2, (height * c + thick * s) / 2
    bodies, z = [ground], 0.0
    for storey in range(3):
        frames = 3 - storey
        for i in range(frames):
            x = apart * (i - (frames - 1) / 2)
            bodies += [body("card", [x + side * across, 0, z + up], about("y", -side * tilt), friction=0.7)
                       for side in (-1, 1)]
        z += 2 * up
        bodies += [body("card", [apart * (i - (frames - 2) / 2), 0, z + thick / 2], about("y", 90), friction=0.7)
                   for i in range(frames - 1)]
        z += thick
    return {"title": "A house of fifteen cards", "seconds": 10, "margin": 0.001, "shapes": shapes, "bodies": bodies}


def hull(numbers, corners, size):
    """Points on an ellipsoid, as a shape."""
    axes = [size * numbers.uniform(0.6, 1) for _ in range(3)]
    points = []
    while len(points) < corners:
        p = [numbers.uniform(-1, 1) for _ in range(3)]
        length = math.hypot(*p)
        if 0.1 < length < 1:
            points.append([axis * x / length for axis, x in zip(axes, p)])
    return {"points": points}


def turned(numbers):
    quat = [numbers.gauss(0, 1) for _ in range(4)]
    return [x / math.hypot(*quat) for x in quat]


def pile(count, side, seconds):
    numbers = random.Random(1)
    shapes, ground = floor(6.0)
    half, bodies = 0.16 * side, [ground]
    shapes["wall"] = box(0.2, 2 * half + 0.4, 1.6)
    for i in range(4):
        a = math.radians(90 * i)
        bodies.append(body("wall", [(half + 0.1) * round(math.cos(a)), (half + 0.1) * round(math.sin(a)), 0.8],
                           about("z", 90 * i), kind="static"))
    for i in range(20):
        shapes[f"hull {i}"] = hull(numbers, 8 + 24 * i // 20, 0.11)
    for i in range(count):
        place = [i % side, i // side % side, i // side ** 2]
        x, y = (0.3 * (p - (side - 1) / 2) + numbers.uniform(-0.02, 0.02) for p in place[:2])
        bodies.append(body(f"hull {numbers.randrange(20)}", [x, y, 0.2 + 0.26 * place[2]], turned(numbers)))
    return {"title": f"A pile of {count} hulls", "seconds": seconds, "shapes": shapes, "bodies": bodies}


def dominoes():
    shapes, ground = floor(6.0)
    shapes["domino"], shapes["ball"] = box(0.05, 0.25, 0.5), {"model": "shape:geodesic?level=3", "scale": 0.12}
    bodies, count, radius = [ground], 40, 1.5
    for i in range(count):
        angle = 300 * i / (count - 1)
        a = math.radians(angle)
        bodies.append(body("domino", [radius * math.cos(a), radius * math.sin(a), 0.25], about("z", angle + 90)))
    bodies.append(body("ball", [radius, -0.3, 0.4], velocity=[0, 2.5, 0]))
    return {"title": "Dominoes", "seconds": 8, "shapes": shapes, "bodies": bodies}


def table():
    shapes, ground = floor(2.0)
    shapes["top"], shapes["leg"] = box(0.8, 0.5, 0.04), box(0.05, 0.05, 0.4)
    shapes["mug"] = {"model": "../models/mug.off", "scale": 0.001}
    shapes["controller"] = {"model": "../models/gamepad.off", "scale": 0.001}
    bodies = [ground, body("top", [0, 0, 0.42], kind="static")]
    bodies += [body("leg", [x, y, 0.2], kind="static") for x in (-0.35, 0.35) for y in (-0.2, 0.2)]
    bodies += [body("mug", [-0.1, 0, 0.6], times(about("x", 40), about("y", 25)), density=600),
               body("controller", [0.1, 0.02, 0.65], times(about("y", 35), about("x", 100)), density=400),
               body("mug", [-0.02, 0.05, 0.85], about("y", 80), density=600)]
    return {"title": "The mug and the controller on a table", "seconds": 6, "margin": 0.001, "shapes": shapes,
            "bodies": bodies}


def prism(corners, height):
    return {"points": [[x, y, side * height / 2] for x, y in corners for side in (-1, 1)]}


def gear(teeth, height):
    """A ring and its teeth, in convex pieces; the pitch circle has radius 1."""
    hole, rim, tip = 0.35, 1 - 2.4 / teeth, 1 + 1.7 / teeth
    step, pieces = 2 * math.pi / teeth, []

    def at(radius, angle):
        return [radius * math.cos(angle), radius * math.sin(angle)]

    for i in range(teeth):
        a = i * step
        pieces.append(prism([at(r, a + s * step / 2) for r in (hole, rim) for s in (-1, 1)], height))
        sides = [at(r, a + s * w * step) for r, w in ((0.97 * rim, 0.3), (1, 0.22), (tip, 0.1)) for s in (-1, 1)]
        pieces.append(prism(sides, height))
    return {"pieces": pieces, "scale": 0.5}


def gears():
    """The left gear is turned, the right one turns on its pin by what the teeth push."""
    teeth, radius, height = 16, 0.5, 0.3
    shapes, ground = floor(4.0, friction=0.1)
    shapes["gear"], shapes["pin"] = gear(teeth, height), {"model": "shape:cylinder?sides=24", "scale": 0.17}
    pin = [[0.172 * math.cos(i * math.pi / 12), 0.172 * math.sin(i * math.pi / 12)] for i in range(24)]
    shapes["pin"] = prism(pin, 0.4)
    bodies = [ground, body("gear", [-radius, 0, height / 4 + 0.001], kind="kinematic", spin=[0, 0, 1], friction=0.1),
              body("pin", [radius, 0, 0.2], kind="static", friction=0.05),
              body("gear", [radius, 0, height / 4 + 0.001], about("z", 180 / teeth), density=500, friction=0.1)]
    return {"title": "A pair of gears", "seconds": 10, "margin": 0.002, "shapes": shapes, "bodies": bodies}


def slot():
    """A tenth of a millimetre of room on each side."""
    shapes, ground = floor(2.0)
    shapes["box"], shapes["cheek"] = box(0.2, 0.2, 0.3), box(0.3, 0.6, 0.4)
    gap = 0.2002 / 2 + 0.15
    bodies = [ground, body("cheek", [gap, 0, 0.2], kind="static", friction=0.2),
              body("cheek", [-gap, 0, 0.2], kind="static", friction=0.2),
              body("box", [0, 0, 0.54], friction=0.2, density=700, velocity=[0, 0.05, 0])]
    return {"title": "A box in a tight slot", "seconds": 4, "margin": 0.001, "shapes": shapes, "bodies": bodies}


def terrain():
    """Hulls roll down into a hollow of a height field, round a driven gate."""
    numbers, side = random.Random(2), 25
    heights = [[0.035 * ((i - 12) ** 2 + (j - 12) ** 2) / 12 + 0.12 * math.sin(1.1 * i) * math.cos(0.9 * j)
                for i in range(side)] for j in range(side)]
    shapes = {"ground": {"heights": heights, "step": [0.4, 0.4]}, "gate": box(2.4, 0.12, 0.6),
              "ball": {"model": "shape:geodesic?level=2", "scale": 0.13}}
    for i in range(8):
        shapes[f"hull {i}"] = hull(numbers, 10 + 2 * i, 0.16)
    bodies = [body("ground", [0, 0, 0], kind="static"),
              body("gate", [4.8, 4.8, 0.45], kind="kinematic", spin=[0, 0, 0.8])]
    for i in range(60):
        angle, out = 2 * math.pi * i / 60, 2.6 + 0.9 * (i % 2)
        name = "ball" if i % 4 == 0 else f"hull {i % 8}"
        bodies.append(body(name, [4.8 + out * math.cos(angle), 4.8 + out * math.sin(angle), 1.9 + 0.2 * (i % 3)],
                           turned(numbers)))
    return {"title": "Hulls that roll into a hollow", "seconds": 8, "shapes": shapes, "bodies": bodies}


def bullets():
    """200 m/s is 83 cm a step; the plates are 1 cm thick."""
    shapes, ground = floor(6.0)
    shapes["plate"], shapes["bullet"] = box(0.01, 0.8, 0.8), {"model": "shape:geodesic?level=1", "scale": 0.03}
    bodies = [ground]
    for i in range(3):
        bodies.append(body("plate", [0.5 + 0.6 * i, 0, 0.4], density=7800))
    bodies.append(body("plate", [2.3, 0, 0.4], kind="static"))
    for i in range(4):
        bodies.append(body("bullet", [-1.5 - 0.2 * i, 0.25 * (i - 1.5), 0.3 + 0.1 * i], density=11000,
                           velocity=[200, 0, 0]))
    return {"title": "Bullets of 200 m/s and plates of 1 cm", "seconds": 3, "shapes": shapes, "bodies": bodies}


def lying(numbers, center, count, reach):
    """Hulls that fall about a place."""
    return [body(f"hull {i % 8}", [center[0] + numbers.uniform(-reach, reach),
                                   center[1] + numbers.uniform(-reach, reach), center[2] + 0.25 * i],
                 turned(numbers)) for i in range(count)]


def capsule():
    """Upright, 1.8 m high."""
    ring = [[0.3 * math.cos(a) * math.cos(b), 0.3 * math.sin(a) * math.cos(b), 0.3 * math.sin(b)]
            for a in [i * math.pi / 8 for i in range(16)] for b in [i * math.pi / 12 for i in range(7)]]
    return {"points": [[x, y, side * (z + 0.6)] for x, y, z in ring for side in (-1, 1)]}


def character():
    """Stairs up, a turning platform across, a ramp down, hulls on the way."""
    numbers = random.Random(3)
    shapes, ground = floor(16.0)
    shapes["capsule"] = capsule()
    shapes["stair"], shapes["landing"] = box(0.4, 2.0, 0.2), box(2.0, 2.0, 0.2)
    shapes["platform"] = box(2.6, 2.6, 0.2)
    shapes["ramp"] = {"points": [[x, y, z] for y in (-1, 1) for x, z in ((0, 0), (3.4, 0), (0, 1.4))]}
    for i in range(8):
        shapes[f"hull {i}"] = hull(numbers, 10 + 2 * i, 0.22)
    bodies = [ground]
    bodies += [body("stair", [-4 + 0.4 * i, 0, 0.1 + 0.2 * i], kind="static") for i in range(7)]
    bodies += [body("landing", [-0.4, 0, 1.3], kind="static"),
               body("platform", [1.95, 0, 1.3], kind="kinematic", spin=[0, 0, 0.5]),
               body("ramp", [3.3, 0, 0.002], kind="static", friction=0.8),
               body("capsule", [-6, 0, 1.0], kind="kinematic", walk=[[1.9, 0], [4.2, 0], [7.2, 0], [6.2, 3.3],
                                                                     [-5, 3.3]], speed=1.8)]
    bodies += lying(numbers, [2, 3.4, 0.5], 8, 1.2) + lying(numbers, [-0.4, 0.4, 1.9], 3, 0.4)
    return {"title": "A character walks over stairs, a turning platform and a ramp", "seconds": 16, "shapes": shapes,
            "bodies": bodies}


def sensors():
    """Two boxes through which hulls fall, one that is driven to and fro over what lies there."""
    numbers = random.Random(4)
    shapes, ground = floor(6.0)
    shapes["zone"], shapes["beam"] = box(1.4, 1.4, 0.8), box(0.5, 4.0, 0.5)
    for i in range(8):
        shapes[f"hull {i}"] = hull(numbers, 10 + 2 * i, 0.2)
    bodies = [ground, body("zone", [-0.8, 0, 1.6], kind="static", sensor=True),
              body("zone", [0.9, 0, 0.4], kind="static", sensor=True),
              body("beam", [-2.6, 0, 0.3], kind="kinematic", velocity=[0.7, 0, 0], sensor=True)]
    bodies += lying(numbers, [-0.8, 0, 1.4], 12, 0.5) + lying(numbers, [0.9, 0, 0.9], 12, 0.7)
    return {"title": "Sensors tell which hulls are in them", "seconds": 8, "shapes": shapes, "bodies": bodies}


def rollback():
    """A ball misses a tower of boxes; the run goes back, and then again, with other velocities."""
    shapes, ground = floor(6.4)
    shapes["crate"], shapes["ball"] = box(0.3, 0.3, 0.3), {"model": "shape:geodesic?level=3", "scale": 0.2}
    shapes["rim x"], shapes["rim y"] = box(0.2, 4.4, 0.5), box(6.0, 0.2, 0.5)
    bodies = [ground, body("ball", [-2.5, 0, 0.21], density=3000, velocity=[3, 1.8, 0])]
    bodies += [body("crate", [0.31 * (i - (2 - k) / 2), 0, 0.15 + 0.3 * k], density=200)
               for k in range(3) for i in range(3 - k)]
    bodies += [body("rim x", [3.1 * side, 0, 0.25], kind="static") for side in (-1, 1)]
    bodies += [body("rim y", [0, 2.1 * side, 0.25], kind="static") for side in (-1, 1)]
    backs = [{"at": 1.5, "to": 0.25, "body": 1, "velocity": [3.5, -1.2, 0]},
             {"at": 3, "to": 0.25, "body": 1, "velocity": [6, 0, 0]}]
    return {"title": "A shot is taken back twice", "seconds": 6, "rollbacks": backs, "shapes": shapes,
            "bodies": bodies}


def thousands():
    """Two layers of hulls of twenty shapes over a floor with a rim."""
    numbers = random.Random(5)
    shapes, ground = floor(17.0)
    half = 25 * 0.3 + 0.1
    shapes["rim x"], shapes["rim y"] = box(0.2, 2 * half + 0.4, 0.6), box(2 * half, 0.2, 0.6)
    for i in range(20):
        shapes[f"hull {i}"] = hull(numbers, 8 + 24 * i // 20, 0.14)
    bodies = [ground] + [body("rim x", [side * (half + 0.1), 0, 0.3], kind="static") for side in (-1, 1)]
    bodies += [body("rim y", [0, side * (half + 0.1), 0.3], kind="static") for side in (-1, 1)]
    bodies.append(body([f"hull {i}" for i in range(20)], [-7.35, -7.35, 0.2], grid=[50, 50, 2],
                       apart=[0.3, 0.3, 0.3], turned=1))
    return {"title": "Five thousand hulls", "seconds": 2, "margin": 0.02, "shapes": shapes, "bodies": bodies}


def game():
    """What examples/game has: hills, 300 hulls, a character, bullets, a sensor, and a state to go back to."""
    numbers, side = random.Random(6), 33
    heights = [[0.5 * math.sin(0.45 * i) * math.sin(0.38 * j) + 0.004 * ((i - 16) ** 2 + (j - 16) ** 2)
                for i in range(side)] for j in range(side)]
    shapes = {"hills": {"heights": heights, "step": [0.6, 0.6]}, "capsule": capsule(), "zone": box(3.0, 3.0, 2.0),
              "plate": box(0.01, 16.0, 4.0), "bullet": {"model": "shape:geodesic?level=1", "scale": 0.04}}
    for i in range(12):
        shapes[f"hull {i}"] = hull(numbers, 8 + 2 * i, 0.22)
    bodies = [body("hills", [0, 0, 0], kind="static"),
              body("zone", [9.6, 9.6, 1.0], kind="static", sensor=True),
              body("plate", [17.9, 9.6, 2.5], kind="static"),
              body("capsule", [2.4, 9.6, 2.6], kind="kinematic", walk=[[4, 3.2], [15.5, 3.2], [15.5, 14]], speed=4),
              body([f"hull {i}" for i in range(12)], [5.0, 4.4, 2.4], grid=[15, 20, 1], apart=[0.62, 0.55, 0.5],
                   turned=2)]
    bodies += [body("bullet", [1.5, 5.0 + 3 * i, 1.9 + 0.3 * i], density=9000, velocity=[200, 0, 0]) for i in range(4)]
    return {"title": "A game: hulls, a character, bullets, a sensor, taken back once", "seconds": 6,
            "rollbacks": [{"at": 2, "to": 1, "body": 304, "velocity": [-60, 0, 2]}], "shapes": shapes,
            "bodies": bodies}


ABOUT = {
    "bullets": "Bullets of 200 m/s meet plates of 1 cm, and none passes.",
    "cards": "A house of cards stands on friction alone.",
    "character": "A capsule walks by casts alone, up stairs, over a platform that carries it round, down a ramp, and "
                 "among hulls.",
    "dominoes": "A ball starts a row of dominoes.",
    "game": "Three hundred hulls on a height field; a character walks round them. At 2 s the run goes back by one.",
    "gears": "Two gears, each of convex pieces; the right one turns by what the left one's teeth push.",
    "heap": "Eighty hulls fall and come to rest.",
    "pile": "Five hundred hulls fall and come to rest.",
    "rollback": "A ball misses a tower. The run goes back to 0.25 s, twice, and on with another velocity of the ball.",
    "sensors": "Hulls have another colour while they share a point with a sensor; two stand, one is driven.",
    "slot": "A box goes down a slot with a tenth of a millimetre on each side.",
    "stack": "Ten boxes stand on one another and do not drift.",
    "table": "Two mugs and a controller, scanned, fall on a table.",
    "terrain": "Hulls roll over a height field, round a gate that is driven.",
    "thousands": "Hulls of twenty shapes fall on a floor and on each other.",
}
SCENES = {"stack": stack, "cards": cards, "pile": lambda: pile(500, 8, 12), "heap": lambda: pile(80, 4, 6),
          "dominoes": dominoes, "table": table, "gears": gears, "slot": slot, "terrain": terrain,
          "bullets": bullets, "character": character, "sensors": sensors, "rollback": rollback,
          "game": game, "thousands": thousands}


def text_of(scene):
    """One line for each shape and each body."""
    scene = rounded(scene)
    shapes = ",\n".join(f"  {json.dumps(name)}: {json.dumps(shape)}" for name, shape in scene.pop("shapes").items())
    bodies = ",\n".join("  " + json.dumps(one) for one in scene.pop("bodies"))
    head = json.dumps(scene)[:-1]
    return f'{head},\n "shapes": {{\n{shapes}}},\n "bodies": [\n{bodies}]}}\n'


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent)
    for scene_name, make in SCENES.items():
        (folder / f"{scene_name}.json").write_text(text_of({"title": "", "about": ABOUT[scene_name], **make()}))
