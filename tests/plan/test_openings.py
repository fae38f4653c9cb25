#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Proofs by openings of planes are accepted by check/motions.py, and changed ones are refused.

Usage: test_openings.py CHECK_FOLDER

Proofs are of opening_models.py. An oracle in doubles, which knows neither, looks for a plane of a cell at which what
the proof says of it is wrong. A change at random has to be refused where it finds one, as has each lie of the list.
"""
import copy
import json
import os
import random
import subprocess
import sys
import tempfile
from fractions import Fraction
from itertools import product
from math import cos, sin

import opening_models as models
import proof_lies


def numbers(texts):
    return [float(Fraction(x)) for x in texts]


def cells(chart):
    """The letter, box and place of each leaf, by recursion on the text."""
    text, at = chart["tree"], 0

    def below(box):
        nonlocal at
        place, letter = at, text[at]
        at += 1
        if letter not in "012":
            return [(letter, box, place)]
        k, found = int(letter), []
        for half in range(2):
            part = [list(interval) for interval in box]
            part[k][1 - half] = sum(box[k]) / 2
            found += below(part)
        return found
    return below([[-1, 1]] * 3)


def plane_of(chart, reach, place):
    k, (a, b, s) = chart["axis"], place
    u = [a] * 3
    u[k], u[(k + 1) % 3], u[(k + 2) % 3] = chart["sign"], a, b
    return u, s * reach


def spread(told, points, u, s):
    """The variance of the crossings of chords, or none where a plane crosses one of them not."""
    total, met = sum(weight for weight, _, _ in told), []
    for weight, *ends in told:
        a, b = ([x + (y - x) / 2 ** e for x, y in zip(points[i], points[k])] for i, k, e in ends)
        g, h = (sum(x * y for x, y in zip(u, p)) - s for p in (a, b))
        if g > 1e-12 or h < -1e-12 or h - g < 1e-12:
            return None
        met.append((weight / total, [(x * h - y * g) / (h - g) for x, y in zip(a, b)]))
    middle = [sum(w * p[k] for w, p in met) for k in range(3)]
    return sum(w * sum((x - y) ** 2 for x, y in zip(p, middle)) for w, p in met)


def is_wrong(told, random_, tries=4):
    """Whether the oracle finds a plane of a cell at which a proof is wrong."""
    points, reach = [numbers(p) for p in told["robot"][told["piece"]]["points"]], float(Fraction(told["reach"]))
    square = max(sum((x - y) ** 2 for x, y in zip(numbers(p), numbers(hole["centre"])))
                 for hole in told["holes"] for part in hole["parts"] for p in part)
    for chart in told["charts"]:
        blocked = iter(chart["blocked"])
        for letter, box, _ in cells(chart):
            leaf = next(blocked) if letter == "x" else None
            for i in range(8 + tries):
                place = [interval[i >> k & 1] if i < 8 else random_.uniform(*interval)
                         for k, interval in enumerate(box)]
                u, s = plane_of(chart, reach, place)
                heights = [sum(x * y for x, y in zip(u, p)) for p in points]
                if letter == "x":
                    found = spread(leaf, points, u, s)
                    if found is None or found < square * (1 - 1e-9):
                        return True
                elif s < min(heights) - 1e-9 if letter == "+" else s > max(heights) + 1e-9:
                    return True
    return False


def leaf_at(chart, place):
    """The letter of a leaf that has a plane, and which leaf of its chart it is."""
    text, at, box = chart["tree"], 0, [[-1, 1] for _ in range(3)]
    while text[at] in "012":
        k = int(text[at])
        middle = sum(box[k]) / 2
        upper = place[k] > middle
        box[k][1 - upper] = middle
        at += 1
        if upper:  # the other half is left out: one leaf more than halvings
            wanted = 1
            while wanted:
                wanted += 1 if text[at] in "012" else -1
                at += 1
    return text[at], at


def fits(points, u, s, square):
    """Whether a disc that is moved towards the farthest point over and over has a section after all."""
    met = []
    for i, p in enumerate(points):
        for q in points[:i]:
            g, h = (sum(x * y for x, y in zip(u, r)) - s for r in (p, q))
            if g * h < 0:
                met.append([(y * g - x * h) / (g - h) for x, y in zip(p, q)])
    centre = [sum(x) / len(met) for x in zip(*met)]
    for i in range(2, 60):
        far = max(met, key=lambda p: sum((x - y) ** 2 for x, y in zip(p, centre)))
        if sum((x - y) ** 2 for x, y in zip(far, centre)) < square * (1 - 1e-9):
            return True
        centre = [x + (y - x) / i for x, y in zip(centre, far)]
    return False


def hold_planes(told, random_, count):
    """On the way of planes along and across a piece, blocked ones are between both sides, and fit no disc."""
    points, reach = [numbers(p) for p in told["robot"][0]["points"]], float(Fraction(told["reach"]))
    square = max(sum((x - y) ** 2 for x, y in zip(numbers(p), numbers(hole["centre"])))
                 for hole in told["holes"] for part in hole["parts"] for p in part)
    for _ in range(count):
        chart = random_.choice(told["charts"])
        start, end = ([random_.uniform(-1, 1) for _ in range(2)] for _ in range(2))
        letters, last = "", None
        for i in range(400):
            l = i / 399
            place = [x + l * (y - x) for x, y in zip(start, end)] + [1 - 2 * l]
            letter, at = leaf_at(chart, place)
            if letter == "x" and at != last:
                assert not fits(points, *plane_of(chart, reach, place), square), "a section fits"
            letters, last = letters + letter, at
        assert letters[0] == "+" and letters[-1] == "-" and "+-" not in letters and "-+" not in letters, letters


def is_sealed(letters):
    """Whether a grid of halved squares is told: each is an obstacle, or of a hole of which no side is open."""
    beside = {}
    for (i, k, half), letter in letters.items():
        corners = [(i, k), (i + 1, k + 1), (i, k + 1) if half else (i + 1, k)]
        for side in zip(corners, corners[1:] + corners[:1]):
            beside.setdefault(frozenset(side), []).append(letter)
    return " " not in letters.values() and all("W" in both or both[0] == (both + [None])[1] for both in beside.values())


def hold_cover(random_, openings, size=5):
    """Obstacles and holes of a grid, in a plane at random, leave an edge open or a part out where a look tells so."""
    letters, kind = {}, random_.choice(["WAA", "WAB", "WWWA"])
    for i, k in product(range(size), repeat=2):
        edge = 0 in (i, k) or size - 1 in (i, k)
        letters[i, k, 0] = "W" if edge and random_.random() < 0.99 else random_.choice(kind * 9 + " AB")
        letters[i, k, 1] = letters[i, k, 0] if edge or random_.random() < 0.7 else random_.choice(kind)
    polygons, taken = [], set()
    for k, i in product(range(size), repeat=2):
        a, b, wide = letters[i, k, 0], letters[i, k, 1], 1
        if (i, k) not in taken and a == b:
            while random_.random() < 0.5 and letters.get((i + wide, k, 0)) == letters.get((i + wide, k, 1)) == a:
                taken.add((i + wide, k))
                wide += 1
            polygons.append((a, [(i, k), (i + wide, k), (i + wide, k + 1), (i, k + 1)]))
        elif a != b:
            polygons += [(a, [(i, k), (i + 1, k), (i + 1, k + 1)]), (b, [(i, k), (i + 1, k + 1), (i, k + 1)])]
    random_.shuffle(polygons)
    n = [0, 0, 0]
    while not any(n):
        o, e, f = ([Fraction(random_.randrange(-4, 5), random_.randrange(1, 4)) for _ in range(3)] for _ in range(3))
        n = [e[i - 2] * f[i - 1] - e[i - 1] * f[i - 2] for i in range(3)]

    def place(p):
        return [x + p[0] * y + p[1] * z for x, y, z in zip(o, e, f)]
    plane = openings.Plane(models.texts((*n, sum(x * y for x, y in zip(n, o)))))
    proof = object.__new__(openings.Openings)
    proof.plane = plane
    proof.sections = [plane.section([tuple(x + s * y for x, y in zip(place(p), n)) for p in polygon for s in (-1, 2)])
                      for letter, polygon in polygons if letter == "W"]
    proof.holes = [openings.Hole(plane, {"centre": ["0"] * 3, "parts": parts}) for parts in (
        [[models.texts(place(p)) for p in polygon] for letter, polygon in polygons if letter == name] for name in "AB")
        if parts]
    whole = [plane.flat(place(p)) for p in ((0, 0), (size, 0), (size, size), (0, size))]
    try:
        proof.check_holes(whole)
        told = True
    except ValueError:
        told = False
    assert told == is_sealed(letters), "holes are not as the grid has them"


def hold_blocked(random_, openings):
    """The most square radius that chords at random block throughout a cell is below their spread at planes in it."""
    points = [tuple(Fraction(random_.randrange(-64, 65), 64) for _ in range(3)) for _ in range(6)]
    reach = max(sum(map(abs, p)) for p in points)
    charts, chart = openings.Charts(points, reach, Fraction(1)), {"axis": random_.randrange(3), "sign": 1}
    scale, cell = charts.square, []
    for k in range(3):  # planes near the origin
        deep = random_.randrange(3, 7)
        start = random_.randrange(2 ** deep) if k < 2 else random_.randrange(3 << deep - 3, 5 << deep - 3)
        cell.append(-openings.ONE + (start << 41 - deep))
        cell.append(cell[-1] + (1 << 41 - deep))

    def is_blocked(leaf, square):
        charts.square = scale * square
        try:
            charts.check_blocked(chart["axis"], 1, tuple(cell), leaf)
            return True
        except ValueError:
            return False
    for _ in range(300):
        leaf = [[random_.choice([1, 2, 1000])] + [[random_.randrange(6), random_.randrange(6), random_.randrange(5)]
                                                  for _ in range(2)] for _ in range(random_.choice([2, 3]))]
        if not is_blocked(leaf, -10 ** 9):
            continue
        low, high = Fraction(-10 ** 9), Fraction(100)
        while high - low > 1e-9:
            low, high = ((low + high) / 2, high) if is_blocked(leaf, (low + high) / 2) else (low, (low + high) / 2)
        for i in range(40):
            place = [cell[2 * k + (i >> k & 1)] / openings.ONE if i < 8 else
                     random_.uniform(cell[2 * k], cell[2 * k + 1]) / openings.ONE for k in range(3)]
            found = spread(leaf, [numbers(p) for p in points], *plane_of(chart, float(reach), place))
            assert found is not None and found > low - 2e-9, "a cell is blocked that is not"
        return True
    return False


def leaf_of(told, random_, letters, wanted=lambda *_: True):
    """A chart, and the place in its text of a leaf of some letters that is as wanted."""
    found = [(chart, place) for chart in told["charts"] for letter, box, place in cells(chart)
             if letter in letters and wanted(chart, letter, box)]
    return random_.choice(found)


def blocked_of(told, random_):
    return random_.choice(random_.choice([chart for chart in told["charts"] if chart["blocked"]])["blocked"])


def replaced(text, at, letter):
    return text[:at] + letter + text[at + 1:]


def at_end(_, letter, box):
    """Whether a leaf has planes before a whole piece, or beyond it, which ends of the motion have."""
    return box[2][1] == 1 if letter == "+" else box[2][0] == -1


def other_side(told, random_):
    """A leaf that has an end of the motion is told to be of the other side."""
    chart, at = leaf_of(told, random_, "+-", at_end)
    chart["tree"] = replaced(chart["tree"], at, "+-"[chart["tree"][at] == "+"])


def blocked_end(told, random_):
    """A leaf that has an end is told to be blocked, as another one is."""
    chart, at = leaf_of(told, random_, "+-", at_end)
    chart["blocked"].insert(chart["tree"][:at].count("x"), copy.deepcopy(blocked_of(told, random_)))
    chart["tree"] = replaced(chart["tree"], at, "x")


def never_blocked(told, random_):
    """Both sides meet where no leaf is blocked."""
    letter = random_.choice("+-")
    for chart in told["charts"]:
        chart["tree"], chart["blocked"] = chart["tree"].replace("x", letter), []


def leaf_not_told(told, random_):
    random_.choice(told["charts"])["blocked"].pop()


def leaf_too_many(told, random_):
    leaves = random_.choice(told["charts"])["blocked"]
    leaves.append(random_.choice(leaves))


def tree_cut(told, random_):
    chart = random_.choice(told["charts"])
    chart["tree"] = chart["tree"][:random_.randrange(len(chart["tree"]))]


def tree_longer(told, random_):
    random_.choice(told["charts"])["tree"] += random_.choice("+-0")


def letter_of_none(told, random_):
    chart = random_.choice(told["charts"])
    chart["tree"] = replaced(chart["tree"], random_.randrange(len(chart["tree"])), random_.choice("3 y*"))


def halved_for_ever(told, random_):
    chart = random_.choice(told["charts"])
    letter = random_.choice("012")
    chart["tree"], chart["blocked"] = letter * 60 + "+" * 61, []


def chart_left_out(told, random_):
    told["charts"].pop(random_.randrange(6))


def chart_twice(told, random_):
    i, k = random_.sample(range(6), 2)
    told["charts"][i] = told["charts"][k]


def chart_renamed(told, random_):
    chart = random_.choice(told["charts"])
    chart["sign"] = -chart["sign"]


def one_weight(told, random_):
    """A weight that leaves next to nothing to the others."""
    random_.choice(blocked_of(told, random_))[0] = 10 ** 9


def no_weight(told, random_):
    random_.choice(blocked_of(told, random_))[0] = random_.choice([0, -1, 1.5, "1"])


def chord_reversed(told, random_):
    chord = random_.choice(blocked_of(told, random_))
    chord[1], chord[2] = chord[2], chord[1]


def chord_to_itself(told, random_):
    chord = random_.choice(blocked_of(told, random_))
    chord[1] = chord[2]


def one_chord(told, random_):
    """All chords of a cell are one."""
    leaf = blocked_of(told, random_)
    leaf[:] = [leaf[0]] * len(leaf)


def beyond_corner(told, random_):
    """An end of a chord is beyond a corner, or none."""
    end = random_.choice(blocked_of(told, random_))[random_.choice([1, 2])]
    end[2] = random_.choice([-1, -3, 0.5, 10 ** 9])


def no_corner(told, random_):
    end = random_.choice(blocked_of(told, random_))[random_.choice([1, 2])]
    end[random_.randrange(2)] = random_.choice([-1, len(told["robot"][0]["points"]), None])


def part_of(told, random_):
    return random_.choice(random_.choice(told["holes"])["parts"])


def hole_left_out(told, random_):
    told["holes"].pop(random_.randrange(len(told["holes"])))


def part_left_out(told, random_):
    parts = random_.choice(told["holes"])["parts"]
    parts.pop(random_.randrange(len(parts)))


def hole_moved(told, random_):
    k, way = random_.randrange(2), random_.choice([-1, 1]) * Fraction(1, 2 ** random_.randrange(3, 60))
    for part in random_.choice(told["holes"])["parts"]:
        for p in part:
            p[k] = str(Fraction(p[k]) + way)


def corner_cut(told, random_):
    """A corner of a hole is nearer to its middle."""
    part = part_of(told, random_)
    i, near = random_.randrange(len(part)), 1 - Fraction(1, 2 ** random_.randrange(3, 60))
    middle = [sum(Fraction(p[k]) for p in part) / len(part) for k in range(3)]
    part[i] = [str(m + near * (Fraction(x) - m)) for x, m in zip(part[i], middle)]


def corner_off_plane(told, random_):
    random_.choice(part_of(told, random_))[2] = str(Fraction(1, 2 ** random_.randrange(1, 60)))


def clockwise(told, random_):
    part_of(told, random_).reverse()


def corners_exchanged(told, random_):
    part = part_of(told, random_)
    i = random_.randrange(len(part))
    part[i], part[i - 1] = part[i - 1], part[i]


def parts_parted(told, random_):
    """Each part is a hole, so that edges between parts are open."""
    told["holes"] = [{"centre": hole["centre"], "parts": [part]} for hole in told["holes"] for part in hole["parts"]]


def far_centre(told, random_):
    random_.choice(told["holes"])["centre"][random_.randrange(3)] = str(random_.choice([-9, 9]))


def plane_moved(told, random_):
    told["plane"][3] = str(random_.choice([-1, 1]) * Fraction(1, 2 ** random_.randrange(0, 60)))


def plane_turned(told, random_):
    told["plane"][random_.randrange(2)] = str(random_.choice([-1, 1]) * Fraction(1, 2 ** random_.randrange(0, 60)))


def plane_reversed(told, random_):
    told["plane"] = [str(-Fraction(x)) for x in told["plane"]]


def no_plane(told, random_):
    told["plane"][2] = "0"


def other_piece(told, random_):
    told["piece"] = random_.choice([-1, 1, 7, "0"])


def point_outside(told, random_):
    """A corner, a middle of corners on an edge, or what is beyond."""
    a, b = (random_.choice(told["robot"][0]["points"]) for _ in range(2))
    l = random_.choice([0, 2])
    told["point"] = [str(Fraction(x) + l * (Fraction(x) - Fraction(y))) for x, y in zip(a, b)]


def small_robot(told, random_):
    """A robot that goes through."""
    told["robot"][0]["points"] = [[str(Fraction(x) / 8) for x in p] for p in told["robot"][0]["points"]]


def dented_robot(told, random_):
    """A corner is within the rest of the piece."""
    points = told["robot"][0]["points"]
    middle = [sum(Fraction(p[k]) for p in points) / len(points) for k in range(3)]
    points[random_.randrange(len(points))] = [str(x) for x in middle]


def obstacle_left_out(told, random_):
    """A piece where the robot can be: all of them are beside a hole, or between the bounds."""
    told["obstacles"].pop(random_.choice(near_pieces(told)))


def near_pieces(told):
    return [i for i, piece in enumerate(told["obstacles"])
            if any(max(abs(Fraction(x)) for x in p[:2]) < 1 for p in piece["points"])]


def obstacle_moved(told, random_):
    """By little, away from the middle."""
    piece = told["obstacles"][random_.choice(near_pieces(told))]
    middle = [sum(Fraction(p[k]) for p in piece["points"]) for k in range(2)]
    k = max(range(2), key=lambda k: abs(middle[k]))
    way = Fraction(1 if middle[k] > 0 else -1, 2 ** random_.randrange(2, 50))
    for p in piece["points"]:
        p[k] = str(Fraction(p[k]) + way)


def obstacle_lifted(told, random_):
    """Off the plane, or so that it is only met."""
    piece, (a, b, c, d) = told["obstacles"][random_.choice(near_pieces(told))], map(Fraction, told["plane"])
    points = [[Fraction(x) for x in p] for p in piece["points"]]
    rise = max((d - a * x - b * y) / c for x, y, _ in points) - min(z for _, _, z in points)
    piece["points"] = [models.texts((x, y, z + rise)) for x, y, z in points]


def larger_window(told, random_):
    """One that lets the robot through."""
    changed = models.proof(None, models.round_window(0.95, 24))
    told["obstacles"], told["holes"] = changed["obstacles"], changed["holes"]


def wide_bounds(told, random_):
    """The robot can go round the plate."""
    told["low"][random_.randrange(2)] = "-9"


def no_bounds(told, random_):
    told["low"] = told["high"]


def short_reach(told, random_):
    """Less than how far a corner is."""
    most = max(sum(abs(Fraction(x)) for x in p) for p in told["robot"][0]["points"])
    told["reach"] = str(most * (1 - Fraction(1, 2 ** random_.randrange(1, 60))))


def ends_exchanged(told, random_):
    told["from"], told["to"] = told["to"], told["from"]


def end_at_plane(told, random_):
    """An end at which the plane cuts the robot, or touches it."""
    name, sign = random_.choice([("from", -1), ("to", 1)])
    told[name + "_rotation"] = ["0", "0", "0", "1"]
    deep = max(-sign * Fraction(p[2]) for p in told["robot"][0]["points"])
    told[name][2] = str(sign * deep * (1 - Fraction(random_.choice([0, 1, 2]), 2 ** random_.randrange(2, 30))))


def end_outside(told, random_):
    beyond = 1 + Fraction(1, 2 ** 50)
    told[random_.choice(["from", "to"])][random_.randrange(2)] = str(random_.choice([-beyond, beyond]))


def no_rotation(told, random_):
    told[random_.choice(["from", "to"]) + "_rotation"] = ["0"] * 4


def other_version(told, random_):
    told["openings"] = random_.choice([0, 2, "1"])


LIES = [other_side, blocked_end, never_blocked, leaf_not_told, leaf_too_many, tree_cut, tree_longer, letter_of_none,
        halved_for_ever, chart_left_out, chart_twice, chart_renamed, one_weight, no_weight, chord_reversed,
        chord_to_itself, one_chord, beyond_corner, no_corner, hole_left_out, part_left_out, hole_moved, corner_cut,
        corner_off_plane, clockwise, corners_exchanged, far_centre, plane_moved, plane_turned, plane_reversed,
        no_plane, other_piece, point_outside, small_robot, dented_robot, obstacle_left_out, obstacle_moved,
        obstacle_lifted, larger_window, wide_bounds, no_bounds, short_reach, ends_exchanged, end_at_plane,
        end_outside, no_rotation, other_version]


def changed_chord(told, random_):
    end = random_.choice(blocked_of(told, random_))[random_.choice([1, 2])]
    i = random_.randrange(3)
    end[i] = random_.randrange(len(told["robot"][0]["points"]) if i < 2 else 9)


def changed_weight(told, random_):
    random_.choice(blocked_of(told, random_))[0] = 1 << random_.randrange(16)


def leaves_exchanged(told, random_):
    leaves = random_.choice(told["charts"])["blocked"]
    i, k = random_.sample(range(len(leaves)), 2)
    leaves[i], leaves[k] = leaves[k], leaves[i]


def changed_halving(told, random_):
    chart = random_.choice(told["charts"])
    at = random_.choice([i for i, letter in enumerate(chart["tree"]) if letter in "012"])
    chart["tree"] = replaced(chart["tree"], at, random_.choice("012".replace(chart["tree"][at], "")))


def changed_corner(told, random_):
    p = random_.choice(told["robot"][0]["points"])
    k = random_.randrange(3)
    p[k] = str(Fraction(p[k]) * random_.choice([Fraction(1, 2), Fraction(9, 10), Fraction(11, 10)]))


def changed_reach(told, random_):
    told["reach"] = str(Fraction(told["reach"]) * random_.choice([2, 1 + Fraction(1, 8)]))


def letter_changed(told, random_):
    chart, at = leaf_of(told, random_, "+-")
    chart["tree"] = replaced(chart["tree"], at, "+-"[chart["tree"][at] == "+"])


def more_room(told, random_):
    told["room"] = str(Fraction(told["room"]) * Fraction(1001, 1000))


def less_smaller(told, random_):
    told["shrink"] += random_.randrange(1, 9)


def far_smaller(told, random_):
    told["shrink"] = 10 ** random_.randrange(10, 20)


def no_room(told, random_):
    del told["room"]


CHANGES = [changed_chord, changed_weight, leaves_exchanged, changed_halving, changed_corner, changed_reach,
           letter_changed]


def made():
    """Proofs: of a round window, a hole of three squares in a plane that is not level and one of a square, and none."""
    half = cos(0.3), sin(0.3)
    round_ = models.proof(models.tetrahedron(), models.round_window(0.25, 8), turn=(half[1], 0, 0, half[0]))
    squares = models.grid_window([[(0, 0), (1, 0), (0, 1)], [(-3, -2)]], 0.25, 4, thickness=0.5)
    bent = models.proof(models.tetrahedron(2), squares, tilt=0.125)
    block = models.proof(models.block(0.25, 0.375, 0.5), models.round_window(0.25, 24))
    closed = models.proof(models.tetrahedron(), models.grid_window([], 0.5, 4))
    return round_, bent, block, closed


def hold_lies(told, lies, random_, cases, openings):
    text, count = json.dumps(told), 0
    for lie in lies:
        for _ in range(cases):
            changed = json.loads(text)
            lie(changed, random_)
            assert not proof_lies.is_proven(openings.Openings, changed), f"{lie.__name__}: a lie is accepted"
            count += 1
    return count


def hold_changes(told, random_, cases, openings):
    """Changes at random are refused where the oracle finds a plane at which the proof is wrong."""
    text, count = json.dumps(told), [0, 0, 0]
    for change in CHANGES:
        for _ in range(cases):
            changed = json.loads(text)
            change(changed, random_)
            try:
                wrong = is_wrong(changed, random_)
            except (IndexError, StopIteration, ValueError):
                wrong = True
            proven = proof_lies.is_proven(openings.Openings, changed)
            assert not (wrong and proven), f"{change.__name__}: a wrong proof is accepted"
            count[0 if wrong else 2 if proven else 1] += 1
    return count


def main(program, folder):
    sys.path.insert(0, folder)
    import motions
    import openings
    seed, cases = int(os.environ.get("PIR_TEST_SEED", "1")), int(os.environ.get("PIR_TEST_CASES", "4"))
    print("seed", seed)
    random_ = random.Random(seed)
    for _ in range(6 * cases):
        hold_cover(random_, openings)
    print("cells of which chords block some:", sum(hold_blocked(random_, openings) for _ in range(6 * cases)))
    proofs = made()
    with tempfile.TemporaryDirectory() as place:  # what the library writes, smallest first
        path = os.path.join(place, "proof.json")
        subprocess.run([program, path], check=True, stdout=subprocess.DEVNULL)
        with open(path, encoding="utf-8") as file:
            proofs = (*proofs, json.load(file))
    for told in proofs:
        with tempfile.TemporaryDirectory() as place:
            path = os.path.join(place, "proof.json")
            with open(path, "w", encoding="utf-8") as file:
                json.dump(told, file)
            assert motions.main(path) == 0, "a proof is refused"
        if told["holes"]:
            assert not is_wrong(told, random_), "the oracle finds a proof wrong"
            hold_planes(told, random_, 2 * cases)
    round_, bent, block, closed, written = proofs

    def some(lies):
        return random_.sample(lies, min(4 * cases, len(lies)))
    count = hold_lies(written, some(LIES) + [more_room, less_smaller, far_smaller, no_room], random_, 1, openings)
    print(f"{count} lies about what the library writes are refused")
    count = hold_lies(round_, LIES, random_, cases, openings)
    count += hold_lies(bent, some(LIES) + [parts_parted], random_, max(1, cases // 8), openings)
    count += hold_lies(block, some(LIES), random_, max(1, cases // 8), openings)
    count += hold_lies(closed, [obstacle_left_out, obstacle_moved, obstacle_lifted, wide_bounds, ends_exchanged],
                       random_, cases, openings)
    print(f"{count} lies are refused")
    print("changes refused with the oracle, without it, and true:", hold_changes(round_, random_, cases, openings))


if __name__ == "__main__":
    main(*sys.argv[1:])
