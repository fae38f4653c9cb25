#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""check.py CERTIFICATE P Q [ANSWER]: checks a certificate; models are OFF or OBJ, ANSWER as query --json gave it.

Says "proven" (exit status 0), or which line of the certificate fails (1), or what cannot be read (2). Nothing of
Pirouette is used, only whole numbers and fractions of Python: whoever has read these lines knows what is proven.
Two bodies, P and Q, are the convex hulls of the points of their models. P is turned by a quaternion and moved by a
translation. All coordinates in a certificate are whole numbers of 1/unit. "Pairs" (i, j) are vertex i of P and j of Q.
"""
import json
import sys
from fractions import Fraction
getattr(sys, "set_int_max_str_digits", int)(0)  # numbers of any length, where Python has a limit

class Refused(Exception):
    """A statement that is not true: its key, which element of it, and why."""

def hold(true, key, why, index=None):
    """Goes on where a statement is true."""
    if not true:
        raise Refused(key, index, why)

def plus(a, b, times=1):
    return (a[0] + times * b[0], a[1] + times * b[1], a[2] + times * b[2])
def minus(a, b):
    return plus(a, b, -1)
def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
def least(direction, points):
    return min(dot(direction, v) for v in points)
def most(direction, points):
    return max(dot(direction, v) for v in points)

def items(data, key, count=None):
    """A list, of so many things or of some."""
    right = isinstance(data[key], list) and (len(data[key]) == count if count else data[key])
    hold(right, key, f"is no list of {count or 'things'}")
    return data[key]

def numbers(data, key, count, whole=False):
    """A list of so many numbers."""
    return tuple(number(data, key, text, whole) for text in items(data, key, count))

def number(data, key, text=None, whole=False, index=None):
    """A text such as "-3/4", or "-3", which is whole."""
    text = data[key] if text is None else text
    top, slash, bottom = text.partition("/") if isinstance(text, str) else ("", "", "")
    digits = top[1:] if top.startswith("-") else top
    right = digits.isascii() and digits.isdigit() and (not slash or (bottom.isascii() and bottom.isdigit()))
    hold(right and not (whole and slash) and (not slash or int(bottom) > 0), key, "is no number", index)
    return int(top) if not slash else Fraction(int(top), int(bottom))

def place(points, quat, move, unit):
    """Points, turned by R = M(q)/|q|^2 and moved, in units. M(q) = (w^2 - |v|^2) I + 2 v v' + 2 w [v]x, q = (v, w)."""
    x, y, z, w = quat
    norm = x * x + y * y + z * z + w * w
    hold(norm > 0, "quat", "is zero")
    rows = ((w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z))
    placed = [[(Fraction(dot(row, v)) / norm + t) * unit for row, t in zip(rows, move)] for v in points]
    return [tuple(c.numerator if c.denominator == 1 else c for c in v) for v in placed]  # whole numbers are faster

def read_bodies(data, p_points, q_points):
    """The unit, the vertices that the certificate has of each body, and all points of the models where they stand.
    Each vertex must be a point of its model, at this pose. So every number of the pose and of the vertices is held."""
    unit = number(data, "unit", whole=True)
    hold(unit > 0, "unit", "is not above 0")
    quat, move = numbers(data, "quat", 4), numbers(data, "translation", 3)
    bodies = []
    for key, stood in (("p", place(p_points, quat, move, unit)), ("q", place(q_points, (0, 0, 0, 1), (0, 0, 0), unit))):
        known = set(stood)
        vertices = []
        for i, v in enumerate(items(data, key)):
            hold(isinstance(v, list) and len(v) == 3, key, "is no vertex", i)
            vertices.append(tuple(number(data, key, c, True, i) for c in v))
            hold(vertices[i] in known, key, "is no point of the model at this pose", i)
            hold(vertices.index(vertices[i]) == i, key, "is there twice", i)
        bodies += [vertices, list(known)]
    return (unit, *bodies)

def read_pair(entry, size, key, index, p, q, used):
    """A vertex of P and one of Q, by their numbers in an entry of so many things."""
    hold(isinstance(entry, list) and len(entry) == size, key, "is no pair", index)
    for vertex, vertices, those in zip(entry, (p, q), used):
        hold(type(vertex) is int and 0 <= vertex < len(vertices), key, "is no pair of vertices", index)
        those.add(vertex)
    return p[entry[0]], q[entry[1]]

def hold_used(p, q, used):
    """Every vertex that is listed serves the proof."""
    for key, vertices, those in (("p", p, used[0]), ("q", q, used[1])):
        hold(len(those) == len(vertices), key, "lists a vertex that nothing rests on")

def read_mix(data, p, q):
    """Pairs (i, j) with weights w > 0, 1 in all: for each the difference q_j - p_i, and the sums of w p_i, of w q_j.
    Sum(w p_i) lies in P, as it is a convex combination of points of P; likewise for Q."""
    differences, whole, of_p, of_q, used = [], 0, (0, 0, 0), (0, 0, 0), (set(), set())
    for index, entry in enumerate(items(data, "pairs")):
        a, b = read_pair(entry, 3, "pairs", index, p, q, used)
        weight = number(data, "pairs", entry[2], False, index)
        hold(weight > 0, "pairs", "has a weight that is not above 0", index)
        differences.append(plus(b, a, -1))
        whole += weight
        of_p, of_q = plus(of_p, a, weight), plus(of_q, b, weight)
    hold(whole == 1, "pairs", "have weights that are not 1 in all")
    hold_used(p, q, used)
    return differences, of_p, of_q

def read_common_point(data, unit, p, q):
    """A mixture of pairs that puts P's point and Q's at one place: their differences."""
    differences, of_p, of_q = read_mix(data, p, q)
    hold(of_p == of_q, "pairs", "put P's point elsewhere than Q's")
    hold_point(data, "point", of_p, unit)
    return differences

def hold_point(data, key, at, unit):
    hold(numbers(data, key, 3) == tuple(Fraction(c, unit) for c in at), key, "is not where the pairs put it")

def check_apart(data, unit, p, all_p, q, all_q):
    """n.q <= low < high <= n.p for all points q of Q and p of P: a plane between them parts the bodies."""
    n = numbers(data, "normal", 3, True)
    low, high = number(data, "low", whole=True), number(data, "high", whole=True)
    hold(most(n, all_q) == low, "low", "is not how far Q reaches along the normal")
    hold(least(n, all_p) == high, "high", "is not where P begins along the normal")
    hold(low < high, "low", "does not lie below high")
    hold_used(p, q, ([v for v in p if dot(n, v) == high], [v for v in q if dot(n, v) == low]))
    gap = Fraction((high - low) ** 2, dot(n, n) * unit ** 2)
    hold(number(data, "gap_squared") == gap, "gap_squared", "is not the square of (high - low)/|normal|")

def check_touching(data, unit, p, all_p, q, all_q):
    """A common point, by the pairs; and n.q <= at <= n.p for all points, so that no interiors meet."""
    read_common_point(data, unit, p, q)
    n, at = numbers(data, "normal", 3, True), number(data, "at", whole=True)
    hold(number(data, "length_squared", whole=True) == dot(n, n) > 0, "length_squared", "is not that of a normal")
    hold(most(n, all_q) == at, "at", "is not how far Q reaches along the normal")
    hold(least(n, all_p) == at, "at", "is not where P begins along the normal")

def check_overlap(data, unit, p, all_p, q, all_q):
    """The origin as a mixture of differences q_j - p_i that lie in no plane, with all weights positive.
    So a ball about the origin lies in the convex hull of the differences, which is in Q - P: the bodies still share a
    point when P moves a little, whatever the way."""
    d = read_common_point(data, unit, p, q)
    edges = [minus(v, d[0]) for v in d[1:]]
    solid = any(dot(cross(a, b), c) for i, a in enumerate(edges) for k, b in enumerate(edges[:i]) for c in edges[:k])
    hold(solid, "pairs", "all lie in one plane")

def check_distance(data, unit, p, all_p, q, all_q):
    """z, the difference of a point of Q and one of P, and (q - p).z >= z.z for all points q and p.
    So no difference is shorter than z: |q - p| |z| >= (q - p).z >= |z|^2."""
    _, of_p, of_q = read_mix(data, p, q)
    hold((z := minus(of_q, of_p)) != (0, 0, 0), "pairs", "put both points at one place")
    hold_point(data, "point_p", of_p, unit)
    hold_point(data, "point_q", of_q, unit)
    hold(least(z, all_q) - most(z, all_p) >= dot(z, z), "pairs", "are not the nearest: a point lies nearer")
    length = Fraction(dot(z, z), unit ** 2)
    hold(number(data, "distance_squared") == length, "distance_squared", "is not that of the two points")

def check_surface(data, p, all_p, q, all_q, sign):
    """All facets of Q + sign P: for each its outward normal and how far the body reaches along it.
    Each facet is a convex polygon of vertices q_j + sign p_i in a plane that no point of the body is beyond: it lies on
    the body's surface. Each of its edges is an edge of another facet, the other way round: across no edge does the
    surface go on without a facet, so together they are all of it. What lies within all planes is the body."""
    at, planes, edges, used, corners = [], [], set(), (set(), set()), set()
    for index, entry in enumerate(items(data, "vertices")):
        a, b = read_pair(entry, 2, "vertices", index, p, q, used)
        at.append(plus(b, a, sign))
    for index, cycle in enumerate(items(data, "facets")):
        right = isinstance(cycle, list) and all(type(v) is int and 0 <= v < len(at) for v in cycle)
        hold(right and len(cycle) >= 3, "facets", "is no cycle of vertices", index)
        v = [at[k] for k in cycle]
        n = cross(minus(v[1], v[0]), minus(v[2], v[0]))
        h = dot(n, v[0])
        reach = most(n, all_q) + (most(n, all_p) if sign > 0 else -least(n, all_p))
        flat = n != (0, 0, 0) and all(dot(n, c) == h for c in v)
        hold(flat and h == reach, "facets", "has points of the body beyond its plane, or corners off it", index)
        for k, (a, b) in enumerate(zip(v, v[1:] + v[:1])):
            inward = cross(n, minus(b, a))
            others = [c for i, c in enumerate(v) if i not in (k, (k + 1) % len(v))]
            hold(all(dot(inward, minus(c, a)) > 0 for c in others), "facets", "is no convex polygon", index)
            if len(data["facets"]) == 2:  # both sides of a flat body, whose outline the edges must be
                reach = least(inward, all_q) + (least(inward, all_p) if sign > 0 else -most(inward, all_p))
                hold(dot(inward, a) == reach, "facets", "has points of the body beyond an edge", index)
            edge = (cycle[k], cycle[(k + 1) % len(v)])
            hold(edge not in edges, "facets", "has an edge of another facet the same way round", index)
            edges.add(edge)
        corners.update(cycle)
        planes.append((n, h))
    hold(all((b, a) in edges for a, b in edges), "facets", "have an edge that no other one has")
    hold(len(corners) == len(at) == len(set(at)), "vertices", "are not all of the facets, or some are one point")
    hold_used(p, q, used)
    return planes, len(at), len(edges) // 2

def check_depth(data, unit, p, all_p, q, all_q):
    """The origin is within all planes of Q - P; the depth is its least distance from one of them."""
    planes, _, _ = check_surface(data, p, all_p, q, all_q, -1)
    facet = data["facet"]
    hold(all(h > 0 for _, h in planes), "facets", "do not have the origin within them all")
    squares = [Fraction(h * h, dot(n, n) * unit ** 2) for n, h in planes]
    hold(type(facet) is int and facet == squares.index(min(squares)), "facet", "is not the first one of the nearest")
    hold(number(data, "depth_squared") == squares[facet], "depth_squared", "is not that of the facet")

def check_sum(data, unit, p, all_p, q, all_q):
    """All facets, no two in one plane, and the counts with Euler's formula."""
    planes, vertices, edges = check_surface(data, p, all_p, q, all_q, 1 if data["claim"] == "sum" else -1)
    ways = {tuple(Fraction(c, max(map(abs, n))) for c in n) for n, _ in planes}
    hold(len(ways) == len(planes), "facets", "has two in one plane")
    for key, count in (("vertex_count", vertices), ("edge_count", edges), ("facet_count", len(planes))):
        hold(type(data[key]) is int and data[key] == count, key, f"is not {count}")
    hold(vertices - edges + len(planes) == 2, "vertex_count", "does not fit Euler's formula")

SURFACE, COUNTS = {"vertices", "facets"}, {"vertex_count", "edge_count", "facet_count"}
# Of each claim its check, the keys that its certificate has beside those of all, no more and no fewer, and the state
# that it proves.
COMMON = {"pirouette_certificate", "claim", "quat", "translation", "unit", "p", "q"}
CLAIMS = {
    "apart": (check_apart, {"normal", "low", "high", "gap_squared"}, "outside"),
    "touching": (check_touching, {"pairs", "point", "normal", "at", "length_squared"}, "boundary"),
    "overlap": (check_overlap, {"pairs", "point"}, "inside"),
    "distance": (check_distance, {"pairs", "point_p", "point_q", "distance_squared"}, "outside"),
    "depth": (check_depth, SURFACE | {"facet", "depth_squared"}, "inside"),
    "sum": (check_sum, SURFACE | COUNTS, None),
    "difference": (check_sum, SURFACE | COUNTS, None),
}

def check_answer(data, answer, unit, bodies):
    """The answer that the command printed: pose and state exactly, the number within 1e-11 of what it is made of."""
    for key in ("quat", "translation"):
        told = tuple(Fraction(c) for c in answer[key])
        hold(numbers(data, key, len(told)) == told, key, "is not the answer's")
    hold(answer["state"] == CLAIMS[data["claim"]][2], "claim", f"does not prove the state {answer['state']}")
    told = Fraction(answer["penetration"]["depth"] if answer["state"] == "inside" else answer["distance"])
    key = {"distance": "distance_squared", "depth": "depth_squared"}.get(data["claim"])
    reach = Fraction(max(abs(c) for body in bodies for v in body for c in v), unit)
    error = (abs(told) + reach + max(map(abs, numbers(data, "translation", 3)))) / 10 ** 11
    if key:
        square = number(data, key)
        hold(max(told - error, 0) ** 2 <= square <= (told + error) ** 2, key, f"is not the answer's, {float(told)}")
    elif data["claim"] == "touching":
        hold(told <= error, "claim", f"does not prove the distance {float(told)}")

def check(text, p_points, q_points, answer=None):
    """Raises Refused, or returns what the certificate states."""
    pairs = json.loads(text, object_pairs_hook=list)
    data = dict(pairs)
    claim = data.get("claim")
    hold(isinstance(claim, str) and claim in CLAIMS, "claim", "is none that is known")
    hold(len(pairs) == len(data) and set(data) == COMMON | CLAIMS[claim][1], "claim", "does not have the right keys")
    hold(data["pirouette_certificate"] == 1, "pirouette_certificate", "is another version")
    CLAIMS[claim][0](data, *(bodies := read_bodies(data, p_points, q_points)))
    if answer is not None:
        check_answer(data, answer, bodies[0], bodies[1:])
    return data

def coordinate(token, exact):
    """In OFF a/b and integers are what they say; any other number is the double nearest to it."""
    plain_number = exact and not set(token) - set("+-/0123456789")
    return Fraction(token) if plain_number else Fraction(float(token))

def read_model(path):
    """All points of an OFF or OBJ file: the body is their convex hull, whatever the facets are."""
    with open(path, encoding="utf-8") as file:
        lines = [line.split("#")[0].split() for line in file]
    if path.lower().endswith(".obj"):
        return [tuple(coordinate(c, False) for c in line[1:4]) for line in lines if line and line[0] == "v"]
    tokens = [token for line in lines for token in line]
    start = 1 if tokens[0] == "OFF" else 0
    count, values = int(tokens[start]), tokens[start + 3:]
    if len(values) < 3 * count:
        raise ValueError("fewer vertices than it says")
    return [tuple(coordinate(c, True) for c in values[3 * i:3 * i + 3]) for i in range(count)]

def line_of(text, key, index):
    """The line of a key, or of an element of its list, which has a line of its own."""
    lines = text.split("\n")
    found = [i for i, line in enumerate(lines) if line.startswith(f'"{key}":')]
    return (found[0] if found else 0) + 1 + (0 if index is None else index + 1)

def main(arguments):
    try:
        with open(arguments[0], encoding="ascii") as file:
            text = file.read()
        with open(arguments[3] if len(arguments) == 4 else "/dev/null", encoding="utf-8") as file:
            answer = json.loads(file.read() or "null")
        data = check(text, read_model(arguments[1]), read_model(arguments[2]), answer)
    except Refused as refused:
        key, index, why = refused.args
        print(f"{arguments[0]}:{line_of(text, key, index)}: refused: \"{key}\" {why}")
        return 1
    except (OSError, ValueError, IndexError, KeyError, TypeError, ZeroDivisionError, RecursionError) as error:
        print(f"refused: cannot be read: {error!r}; usage: check.py CERTIFICATE P Q [ANSWER]", file=sys.stderr)
        return 2
    squares = [f", {key} {data[key]}" for key in ("gap_squared", "distance_squared", "depth_squared") if key in data]
    print(f"proven: {data['claim']}{''.join(squares)}")
    return 0

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
