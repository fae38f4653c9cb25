# SPDX-License-Identifier: MIT
"""What OBJ, STL and PLY files hold, by readers of this file's own, beside the OFF file of the same body."""
import struct
from fractions import Fraction

from command_test import CommandTest, main


def read_off(data):
    tokens = data.decode().split()
    vertices, facets = int(tokens[1]), int(tokens[2])
    numbers = [float(t) for t in tokens[4:4 + 3 * vertices]]
    points = list(zip(*[iter(numbers)] * 3))
    loops, at = [], 4 + 3 * vertices
    for _ in range(facets):
        end = at + 1 + int(tokens[at])
        loops.append([int(t) for t in tokens[at + 1:end]])
        at = end
    assert at == len(tokens)
    return points, loops


def read_obj(data):
    points, loops = [], []
    for line in data.decode().splitlines():
        kind, *rest = line.split()
        assert kind in ("v", "f"), line
        if kind == "v":
            assert len(rest) == 3
            points.append(tuple(float(t) for t in rest))
        else:
            loops.append([int(t) - 1 for t in rest])
    return points, loops


def read_ply(data):
    head, _, body = data.partition(b"end_header\n")
    head = head.decode().splitlines()
    assert head[:2] == ["ply", "format binary_little_endian 1.0"]
    assert head[3:6] == [f"property double {axis}" for axis in "xyz"]
    vertices, facets = (int(line.split()[2]) for line in (head[2], head[6]))
    assert head[2].startswith("element vertex ") and head[6].startswith("element face ")
    size, index = {"property list uchar int vertex_indices": ("B", "i"),
                   "property list uint int vertex_indices": ("I", "i")}[head[7]]
    assert len(head) == 8
    points = [struct.unpack_from("<3d", body, 24 * v) for v in range(vertices)]
    loops, at = [], 24 * vertices
    for _ in range(facets):
        count, = struct.unpack_from("<" + size, body, at)
        at += struct.calcsize(size)
        loops.append(list(struct.unpack_from(f"<{count}{index}", body, at)))
        at += 4 * count
    assert at == len(body)
    return points, loops


def read_stl(data):
    """Triangles as (normal, corners), and whether the file is binary."""
    if not data.startswith(b"solid"):
        count, = struct.unpack_from("<I", data, 80)
        assert len(data) == 84 + 50 * count
        rows = [struct.unpack_from("<12fH", data, 84 + 50 * t) for t in range(count)]
        assert all(row[12] == 0 for row in rows)
    else:
        lines = data.decode().splitlines()
        assert lines[0].split()[0] == "solid" and lines[-1].split()[0] == "endsolid" and len(lines) % 7 == 2
        rows = []
        for at in range(1, len(lines) - 1, 7):
            normal, loop, *corners, end_loop, end_facet = (line.split() for line in lines[at:at + 7])
            assert normal[:2] == ["facet", "normal"] and loop == ["outer", "loop"]
            assert [end_loop, end_facet] == [["endloop"], ["endfacet"]]
            assert all(corner[0] == "vertex" and len(corner) == 4 for corner in corners)
            rows.append([float(t) for words in (normal[2:], *(corner[1:] for corner in corners)) for t in words])
    return [(row[:3], [tuple(row[3 * k:3 * k + 3]) for k in (1, 2, 3)]) for row in rows], data[:5] != b"solid"


def cross(corners):
    a, b, c = [[Fraction(x) for x in corner] for corner in corners]
    u, v = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
    return [u[i - 2] * v[i - 1] - u[i - 1] * v[i - 2] for i in range(3)]


class Formats(CommandTest):
    # a sum whose corners are no floats, bodies whose corners are, a polygon, large and small bodies
    bodies = {
        "sum": ("sum", "shape:gs2", "shape:cube", "--quat=0.1,-0.2,0.3,0.7"),
        "cube": ("shape", "cube"),
        "prism": ("shape", "prism?sides=300"),
        "flat": ("sum", "flat.off", "flat.off"),
        "large": ("sum", "large.off", "large.off"),
        "small": ("sum", "small.off", "small.off"),
    }

    def written(self, name, ending):
        texts = {"flat.off": "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1/3 0\n",
                 "large.off": "OFF\n4 0 0\n0 0 0\n8e307 0 0\n0 7e307 0\n0 0 -6e307\n",
                 "small.off": "OFF\n4 0 0\n0 0 0\n5e-324 0 0\n0 1e-323 0\n0 0 3e-310\n"}
        args = [self.file(word, texts[word]) if word in texts else word for word in self.bodies[name]]
        path = self.path / f"{name}.{ending}"
        self.good(*args, "-o", path)
        return path.read_bytes()

    def test_obj_and_ply_hold_the_vertices_and_facets_of_off(self):
        for name in self.bodies:
            body = read_off(self.written(name, "off"))
            self.assertEqual(read_obj(self.written(name, "obj")), body, name)
            self.assertEqual(read_ply(self.written(name, "ply")), body, name)

    def test_triangles_of_stl_are_fans_of_the_facets(self):
        for name in self.bodies:
            points, loops = read_off(self.written(name, "off"))
            fans = [[points[loop[k]] for k in (0, i, i + 1)] for loop in loops for i in range(1, len(loop) - 1)]
            triangles, binary = read_stl(self.written(name, "stl"))
            self.assertEqual([corners for _, corners in triangles], fans, name)
            floats = all(struct.unpack("<f", struct.pack("<f", x))[0] == x
                         for point in points for x in point if abs(x) < 3e38) and max(map(max, points)) < 3e38
            self.assertEqual(binary, floats, name)

    def test_normals_of_stl_are_those_of_the_corners(self):
        for name in self.bodies:
            for normal, corners in read_stl(self.written(name, "stl"))[0]:
                exact = cross(corners)
                most = max(map(abs, exact))
                exact = [float(x / most) for x in exact]
                length = sum(x * x for x in exact) ** 0.5
                for got, want in zip(normal, exact):
                    self.assertAlmostEqual(got, want / length, 5, name)

    def test_decimals_are_the_shortest(self):
        for ending in ("off", "obj"):
            for token in self.written("small", ending).decode().split():
                if "e" in token:
                    self.assertEqual(token.replace("e-0", "e-"), repr(float(token)), ending)
        tokens = self.written("sum", "obj").decode().split()
        self.assertGreater(len(tokens), 100)
        for token in tokens:
            if "." in token and "e" not in token:
                self.assertLessEqual(len(token), len(repr(float(token))), token)


if __name__ == "__main__":
    main()
