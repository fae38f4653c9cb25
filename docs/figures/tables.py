# SPDX-License-Identifier: MIT
"""The tables of measured numbers in the pages, by name; each takes the results and gives lines of Markdown."""
import re

from results import SUPERSCRIPTS, both, count, markdown, percent, power, short, two

BODIES = {
    "cube": "two cubes", "icosahedron": "two icosahedra", "20 points": "two hulls of 20 points",
    "60 points": "two hulls of 60 points", "gs4": "two spheres of 500 facets",
    "ellipsoid960": "two ellipsoids of 960 facets",
}


# ---- README ----------------------------------------------------------------------------------------------------------


def better_coal(by):
    coals = [by[who] for who in ("coal warm", "coal cold") if who in by]
    return min(coals, key=lambda row: float(row["median_ns"]), default=None)


def pairs(r):
    def cell(row):
        return f"{both(row, 'median_ns', 'mean_ns')} · {row['wrong']}" if row else "–"

    rows = []
    for body, title in BODIES.items():
        for steps in (500, 50) if body != "icosahedron" else ():
            by = {row["who"]: row for row in r.pairs.all(body=body, motion="hovering", steps=steps)}
            engines = (by["ours pair"], by["ours sum"], better_coal(by), by.get("FCL"), by.get("Bullet"))
            rows.append([f"{title}, {steps}", *map(cell, engines)])
    return markdown(["bodies, frames to a turn", ">Pirouette, pair", ">Pirouette, sum", ">coal 3", ">FCL 0.7",
                     ">Bullet 3.24"], rows)


def pairs_motions(r):
    def cell(row):
        return " / ".join(short(float(row[f"{what}_ns"]) / 1e3) for what in ("median", "mean", "p99", "worst"))

    bodies = {**{name: BODIES[name] for name in ("cube", "20 points", "gs4", "ellipsoid960")},
              "sliver and cube": "a sliver of 100 points, a cube",
              "sliver and extreme": "a sliver, a hull of 101 points"}
    rows = []
    for body, title in bodies.items():
        for motion in ("hovering both", "apart both", "deep both", "teleport both"):
            by = {row["who"]: row for row in r.pairs_motions.all(body=body, motion=motion, steps=500)}
            engines = (by["ours pair"], better_coal(by), by["ours manifold"], by.get("box3d manifold"))
            rows.append([f"{title}, {motion.removesuffix(' both')}", *(cell(row) if row else "–" for row in engines)])
    return markdown(["bodies, motion of both", ">signed distance", ">coal", ">cutoff, manifold", ">box3d, manifold"],
                    rows)


def pairs_growth(r):
    titles = {"facets": "facets of each body, a signed distance", "facets teleport": "the same, a new pose each time",
              "pairs": "pairs of 20 points, each", "bodies": "moving bodies of a scene, each",
              "sums rebuilt": "facets of a sum, made anew", "sums updated": "the same, after a 50,000th of a turn"}
    rows = []
    for what, title in titles.items():
        found = r.pairs_growth.all(what=what)
        for k, row in enumerate(found):
            last = k == len(found) - 1
            rows.append(["" if k else title, count(row["count"]),
                         " / ".join(short(float(row[name]) / 1e3) for name in ("ns", "p99_ns", "worst_ns")),
                         short(float(row["bytes"]) / 1e6),
                         f"{row['time_exponent'][:-1]}, {row['bytes_exponent'][:-1]}" if last else ""])
    return markdown(["", ">how many", ">µs, median / p99 / worst", ">MB", ">exponents of time, bytes"], rows)


def query(r):
    asked = (("depth, two cubes", "cubes", "deep"), ("depth, two spheres of 500 facets", "gs4", "deep"),
             ("depth, two ellipsoids of 960 facets", "ellipsoid960", "deep"),
             ("depth, two cubes of edge 10⁻⁶", "cubes 1e-6", "deep"),
             ("signed distance, cubes face to face", "cubes", "face-face"),
             ("distance, two cubes nearly touching", "cubes", "near"),
             ("distance, two spheres of 500 facets nearly touching", "gs4", "near"),
             ("distance, two spheres of 500 facets far apart", "gs4", "separated"))
    rows = []
    for title, bodies, poses in asked:
        cells = []
        for who in ("ours warm", "ours frame", "FCL", "Bullet", "libccd"):
            row = r.query.one(set=bodies, poses=poses, who=who)
            alone = "state alone: " if who == "libccd" and poses in ("near", "separated") else ""
            wrong = max(int(row["wrong_numbers"]), int(row["wrong_states"]))
            cells.append(f"{alone}{both(row, 'median_ns', 'mean_ns')} · {wrong}")
        rows.append([title, *cells])
    return markdown(["what is asked", ">Pirouette, sum at hand", ">with its update", ">FCL 0.7", ">Bullet 3.24",
                     ">libccd 2.1, MPR"], rows)


def readme(r):
    rows = []
    for bodies, title in (("controller", "controller, mug"), ("gs4", "gs4, gs4")):
        for k, row in enumerate(r.readme.all(bodies=bodies)):
            times = [both(row, f"{way}_ns", f"{way}_mean_ns") for way in ("update", "walk", "brute")]
            rows.append(["" if k else title, row["steps"], *times, short(float(row["checked_per_frame"])),
                         short(float(row["repaired_per_frame"]))])
    return markdown(["bodies", ">frames to a full turn", ">update", ">rebuild by walk", ">brute-force re-check",
                     ">pairs looked at", ">pairs repaired"], rows)


# ---- accuracy.md -----------------------------------------------------------------------------------------------------


def distances(r):
    rows = []
    for vertices in ("20", "100", "1000", "10000"):
        cells = [count(r.distances.number("ns", vertices=vertices, accuracy=0))]
        for accuracy in ("0.001", "0.01", "0.05", "0.2"):
            row = r.distances.one(vertices=vertices, accuracy=accuracy)
            cells.append(f"{count(row['ns'])} ({percent(1 - float(row['exactly']))})")
        rows.append([count(vertices), *cells])
    return markdown([">vertices of a body", ">none", ">0.1 %", ">1 %", ">5 %", ">20 %"], rows)


# ---- cgm.md ----------------------------------------------------------------------------------------------------------


def cgm(r):
    ways = (("CGAL 5.5 spherical Gaussian map, overlay alone", "CGAL spherical map overlay"),
            ("CGAL 5.5 `convex_hull_3` of all pairwise sums", "CGAL convex_hull_3 of all sums"),
            ("qhull 2020.2 of all pairwise sums", "qhull of all sums"))
    ours = [r.cgm.all(pair=pair, way="overlay and mesh")[0] for pair in ("gs4", "ellipse")]

    def peer(row, way):
        other = r.cgm.one(pair=row["pair"], way=way, **{"facets of the sum": row["facets of the sum"]})
        return f"{short(float(other['median ms']))} ms, {count(other['times overlay and mesh'])} times"

    def settled(share):
        return "more than 99.99 %" if float(share) == 1 else percent(float(share), 2)

    rows = [["facets of the sum", *(count(row["facets of the sum"]) for row in ours)],
            ["overlay and mesh", *(f"{short(float(row['median ms']))} ms" for row in ours)]]
    rows += [[title, *(peer(row, way) for row in ours)] for title, way in ways]
    rows += [["signs settled by the filter", *(settled(row["filter share"]) for row in ours)],
             ["bytes a halfedge", *(row["bytes a halfedge"] for row in ours)]]
    return markdown(["", "gs4 and itself turned", "ellipse and itself turned"], rows)


# ---- object-space.md -------------------------------------------------------------------------------------------------


def objects(r):
    keys = ("object_us", "walk_us", "cgm_us", "hull_us", "qhull_us", "cgal_us", "index_us")
    rows = [[row["pair"], *(two(float(row[key])) for key in keys), row["paper_object_ms"], row["paper_hull_ms"]]
            for row in r.object.rows]
    return markdown(["", ">object space", ">walk", ">overlay", ">hull", ">qhull", ">CGAL hull", ">by index",
                     ">paper, ms", ">paper's hull, ms"], rows)


# ---- guarantees.md ---------------------------------------------------------------------------------------------------


def tens(text):
    """Powers as 1e-150 in the name of a situation, as 10⁻¹⁵⁰."""
    return re.sub(r"\b1e(-?\d+)", lambda m: "10" + m[1].translate(SUPERSCRIPTS), text)


def extremes(r):
    def error(text):
        value = float(text)
        return short(value) if value > 0.01 else power(text)

    rows = [[tens(row["situation"]), count(row["poses"]), *(error(row[key]) for key in ("vertex", "number", "turned"))]
            for row in r.extremes.rows]
    return markdown(["situation", ">poses", ">vertex", ">number", ">turned"], rows)


def histories(r):
    rows = [[tens(row["history"]), *(count(row[key]) for key in ("frames", "compared", "wrong"))]
            for row in r.histories.rows]
    return markdown(["history", ">frames", ">compared with one made there", ">wrong"], rows)


def large(r):
    def size(text):
        return count(text) if float(text) < 1e6 else power(text)

    rows = [[row["sum"], *(size(row[key]) for key in ("size", "pairs", "facets", "bytes")),
             short(float(row["seconds"]))] for row in r.large.rows]
    return markdown(["sum, in suite `slow`", ">facets or sides", ">pairs", ">facets", ">bytes of memory", ">seconds"],
                    rows)


# ---- meshes.md -------------------------------------------------------------------------------------------------------


def mesh_pairs(r):
    rows = [[count(row["triangles"]), row["place"], count(row["steps"]),
             *(count(row[key]) for key in ("median_us", "mean_us", "p99_us", "fcl_median_us", "fcl_mean_us"))]
            for row in r.mesh_pairs.rows]
    return markdown([">triangles each", "place", ">steps", ">median", ">mean", ">p99", ">FCL median", ">FCL mean"],
                    rows)


def mesh_contacts(r):
    rows = [[row["body"], row["field"], f"{float(row['cell']):.2f}", row["place"], count(row["triangles"]),
             count(row["median_us"]), count(row["p99_us"])] for row in r.mesh_contacts.rows]
    return markdown(["body", "field", ">cell", "place", ">triangles near", ">median, µs", ">p99, µs"], rows)


def mesh_sliding(r):
    groups = {}
    for row in r.mesh_sliding.rows:
        groups.setdefault((row["floor"], row["body"], row["engine"]), []).append(row)
    cells = {}
    for (floor, body, engine), of in groups.items():
        key = "off" if engine == "Pirouette" else "ghosts"
        off, contacts = (sum(int(row[column]) for row in of) for column in (key, "contacts"))
        lost = max(float(row["lost"]) for row in of)
        cells.setdefault((floor, body), {})[engine] = (f"{count(off)} of {count(contacts)}, "
                                                       + (f"{two(100 * lost)} %" if lost > 1e-6 else "0"))
    engines = ("box3d", "Bullet", "Jolt", "Pirouette")
    rows = [[*key, *(of[engine] for engine in engines)] for key, of in cells.items()]
    return markdown(["floor", "body", *(f">{engine}" for engine in engines)], rows)


def terrain_rows(table):
    def plain(text):
        return f"{float(text):,.0f}" if float(text) >= 100 else short(float(text))
    rows = [[row["who"], row["measure"], plain(row["median"]), plain(row["p99"]), row["unit"].replace("us", "µs")]
            for row in table.rows]
    return markdown(["who", "measure", ">median", ">p99", "unit"], rows)


def scene_terrain(r):
    return terrain_rows(r.scene_terrain)


def mesh_octrees(r):
    keys = ("depth", "cubes", "left", "culled_percent", "sums", "octrees_us", "pair_us", "missed")
    rows = [[f"{float(row[key]):.2f} %" if key == "culled_percent" else count(row[key]) for key in keys]
            for row in r.mesh_octrees.rows]
    return markdown([">depth", ">cubes", ">triangles left", ">culled", ">sums of cubes", ">time, µs",
                     ">a new pair, µs", ">nearest missed"], rows)


def mesh_index(r):
    groups = {}
    for row in r.mesh_index.rows:
        groups.setdefault((row["triangles"], row["place"], row["steps"]), []).append(row)
    rows = [[count(key[0]), key[1], key[2], *(f"{count(row['median_us'])} ({count(row['looked_at'])})" for row in of)]
            for key, of in groups.items()]
    return markdown([">triangles each", "place", ">steps", ">as they are", ">prototype alone", ">prototype besides"],
                    rows)


# ---- queries.md ------------------------------------------------------------------------------------------------------


def whole(r):
    rows = [[row["body"], count(row["both_bytes"]), f"{float(row['both_ns']) / 1e3:.1f}",
             f"{float(row['reset_ns']) / 1e3:.1f}"] for row in r.whole.rows]
    return markdown(["body", ">sum and query, bytes", ">made in µs", ">reset in µs"], rows)


# ---- gradients.md ----------------------------------------------------------------------------------------------------


def gradients(r):
    rows = []
    for body, motion in dict.fromkeys((row["body"], row["motion"]) for row in r.gradients.rows):
        times = [r.gradients.number("median_ns", body=body, motion=motion, what=what)
                 for what in ("distance", "gradient", "Hessian", "active set")]
        rows.append([BODIES[body], motion, *(count(f"{time:.0f}") for time in times)])
    return markdown(["bodies", "motion", ">distance", ">with its gradient", ">and Hessian", ">active set"], rows)


# ---- motion.md -------------------------------------------------------------------------------------------------------


def impacts(r):
    rows = [[f"{row['motion']}, {row['bodies']}", row["engine"], *(count(row[what]) for what in (
        "hits", "early", "late", "missed")), f"{float(row['median_ns']) / 1e3:.1f}"] for row in r.impacts.rows]
    return markdown(["motion, bodies", "engine", ">hits", ">early", ">late", ">missed", ">µs"], rows)


# ---- scale.md --------------------------------------------------------------------------------------------------------


def scale(r):
    rows = []
    for scene, title in (("dodecahedra", "two dodecahedra"),
                         ("cube gs4", "cube and geodesic sphere of 500 triangles"),
                         ("gs4", "two geodesic spheres of 500 triangles")):
        found = [r.slices_scale.one(scene=scene, level=level) for level in (5, 6)]
        rows.append([title, *(f"{two(float(row['make_ns']) / 1e3)}, {two(float(row['record_bytes']))}"
                              for row in found)])
    return markdown(["pair", ">level 5: µs, bytes", ">level 6: µs, bytes"], rows)


# ---- scenes.md -------------------------------------------------------------------------------------------------------


def pile(r):
    titles = {"ours": "ours", "ours, 2 threads": "ours, two threads", "box3d": "box3d, no manifold reused"}
    rows = []
    for row in r.scene.all(scene="rec1000.bin"):
        ours = row["engine"] == "ours"
        part = "1" if ours else "" if row["engine"].startswith("ours") else f"{float(row['ours_over']):.2f}"
        rows.append([titles.get(row["engine"], row["engine"]),
                     f"{float(row['median_ms']):.1f} / {float(row['mean_ms']):.1f}", part, row["wrong"]])
    judged = r.scene.one(scene="rec1000.bin", engine="ours")["judged"]
    return markdown(["engine", ">ms a frame, median / mean", ">our mean in parts of its",
                     f">states wrong in {judged} frames"], rows)


def pile_reuse(r):
    rows = [[row["engine"].replace("2 threads", "two threads"),
             f"{float(row['median_ms']):.2f} / {float(row['mean_ms']):.2f}", f"{float(row['p99_ms']):.1f}",
             row["wrong"],
             f"{float(row['peak_mb']):.0f}" if float(row["peak_mb"]) > 0 else ""] for row in r.scene_reuse.rows]
    return markdown(["engine", ">ms a frame, median / mean", ">99th percentile",
                     f">states wrong in {r.scene_reuse.rows[0]['judged']} frames", ">MB"], rows)


def terrain_reuse(r):
    return terrain_rows(r.scene_terrain_reuse)


def game(r):
    rows = [[row["threads"], row["guesses"], row["updates"],
             *(count(round(float(row[key]))) for key in ("mean_us", "median_us", "p99_us", "most_us"))]
            for row in r.scene_game.rows]
    return markdown([">threads", "guesses taken back", ">updates", ">mean, µs", ">median", ">99th percentile",
                     ">most"], rows)


# ---- slices.md -------------------------------------------------------------------------------------------------------

SCENES = {
    "gs4 axis 500": "gs4, gs4, one axis, 500 steps", "gs4 level 3": "gs4, gs4, level 3",
    "gs4 level 4": "gs4, gs4, a tenth of level 4", "gs4 level 5": "gs4, gs4, a tenth of level 5",
    "dodecahedra level 3": "two dodecahedra, level 3",
    "given level 3": "12 pieces of 27 to 66 vertices, a dodecahedron, level 3",
}


def slices(r):
    rows = []
    for row in r.slices.rows:
        times = [two(float(row[key]) / 1e3) for key in ("track_ns", "make_ns", "file_ns", "walk_ns", "qhull_ns")]
        older = two(float(row["faster_than_older_walks"])) if row["older_walk_ns"] != "nan" else "–"
        rows.append([SCENES[row["scene"]], *times, two(float(row["faster_than_walks"])), older,
                     count(row["bytes_a_slice"]), count(row["mesh_bytes"])])
    return markdown(["pair, grid", ">followed", ">made", ">file", ">walk", ">hull", ">times, walks",
                     ">times, older walks", ">bytes", ">bytes of a mesh"], rows)


def slices_read(r):
    rows = []
    for scene in ("gs4 axis 500", "gs4 level 5"):
        for row in r.slices_read.all(scene=scene):
            rows.append([SCENES[scene].replace("a tenth of ", ""), row["slices_per_key"], count(row["bytes_a_slice"]),
                         *(two(float(row[key]) / 1e3) for key in ("alone_ns", "next_ns"))])
    return markdown(["pair, grid", ">slices a key", ">bytes a slice", ">alone", ">next"], rows)


def grid(r):
    rows = []
    for row in r.grid.rows:
        level = int(row["level"])
        digits = 2 if level > 5 else 1
        ends = [f"{float(row[key]):.{digits}f}°" for key in ("least_dispersion", "most_dispersion")]
        rows.append([row["level"], count(row["rotations"]), f"{60 / 2 ** level:.6g}°",
                     f"{float(row['mean_turn']):.3f}", f"{float(row['most_turn']):.2f}", " to ".join(ends)])
    return markdown([">level", ">rotations", ">spacing", ">mean turn / spacing", ">largest turn / spacing",
                     ">dispersion"], rows)


def classify(r):
    rows = []
    for row in r.classify.rows:
        bodies, level = row["scene"].split(" level ")
        title = {"cubes": "two cubes", "dodecahedron sphere": "a dodecahedron and a sphere of 42 vertices"}
        rows.append([title.get(bodies, "gs4, gs4"), level, row["poses"], *(f"{float(row[key]) / 1000:.2f}" for key in
                     ("verdict_ns", "whole_ns", "median_ns", "pairs_ns")), row["wrong"]])
    return markdown(["bodies", ">level", "poses", ">verdicts", ">all", ">alone, median", ">a loop over a pair",
                     ">wrong"], rows)


def critical(r):
    rows = []
    for row in r.critical.rows:
        bodies = row["p"] if row["p"] == row["q"] else f"{row['p']}, {row['q']}"
        rows.append([bodies if row["p"] != row["q"] else f"two of {bodies}", row["axis"], count(row["events"]),
                     *(two(float(row[key])) for key in ("make_ms", "grid_ms")),
                     count(row["bytes"]), count(row["grid_bytes"]),
                     *(two(float(row[key])) for key in ("state_us", "beside_us", "pair_us", "around_us")),
                     row["unknown"], row["wrong"]])
    return markdown(["bodies", "axis", ">events", ">made, ms", ">grid, ms", ">bytes", ">grid, bytes", ">a state, µs",
                     ">beside events, µs", ">a pair, µs", ">all around, µs", ">unknown", ">wrong"], rows)


# ---- solids.md -------------------------------------------------------------------------------------------------------


def solids(r):
    shown = ("real:mushroom+ball128/10", "real:mushroom+stella/50", "real:mushroom+cube/16", "stella+ball128",
             "spoon+spoon", "mushroom+cup/4", "gear8+gear8", "gear8+star5", "gear64+star5")
    rows = []
    for name in shown:
        for row in r.solids.all(pair=name):
            title = name.replace("real:mushroom", "mushroom†").replace("+", " ⊕ ")
            counts = "/".join(row[key] for key in ("vertices", "edges", "facets"))
            rows.append([title, counts, f"{row['pieces_p']} × {row['pieces_q']}",
                         f"{float(row['whole_ms']):.3g} ms", peer_seconds(row["nef_s"]),
                         peer_seconds(row["manifold_s"])])
    return markdown(["sum", "V/E/F", "pieces", ">Pirouette", ">CGAL Nef", ">Manifold"], rows)


def peer_seconds(text):
    if not text:
        return "–"
    return f"{text} s" if text.startswith(">") else f"{two(float(text))} s"


def solid_query(r):
    rows = []
    for row in r.solid_query.rows:
        cells = [f"{two(float(row[f'{what}_us']))} / {two(float(row[f'{what}_mean_us']))}"
                 for what in ("state", "fcl_state", "distance", "fcl_distance")]
        rows.append([row["bodies"], *cells, count(row["fcl_other_states"])])
    return markdown(["bodies", ">state", ">FCL", ">distance", ">FCL", ">states that FCL has otherwise"], rows)


def solid_depth(r):
    rows = []
    for row in r.solid_depth.rows:
        off = [f"{two(100 * float(row[f'fcl_off_{what}']))} %" for what in ("mean", "most")]
        rows.append([row["bodies"], count(row["steps"]), *(two(float(row[f"depth{what}_us"])) for what in
                     ("", "_mean", "_p99")), two(float(row["fcl_depth_us"])), " / ".join(off)])
    return markdown(["bodies", ">steps a turn", ">median", ">mean", ">p99", ">FCL", ">FCL is off by"], rows)


def solid_track(r):
    rows = []
    for row in r.solid_track.rows:
        rebuild, *kept = (float(row[f"{what}_ms"]) for what in ("rebuild", "update", "update_glued"))
        rows.append([row["sum"], count(row["steps"]), two(rebuild),
                     *(f"{two(ms)} ({rebuild / ms:.1f}×)" for ms in kept), f"{two(100 * float(row['clipped']))} %",
                     two(float(row["kept_kb"]))])
    return markdown(["sum", ">steps a turn", ">rebuild, ms", ">update, ms", ">update and gluing, ms", ">clipped",
                     ">kept, kB a candidate"], rows)


TABLES = {function.__name__: function for function in (
    pairs, pairs_motions, pairs_growth, query, readme, distances, cgm, extremes, histories, large, mesh_pairs,
    mesh_contacts, mesh_sliding, scene_terrain, mesh_octrees, mesh_index, objects, whole, gradients, impacts, scale,
    pile, pile_reuse, terrain_reuse, game, slices, slices_read, grid, classify, critical, solids, solid_query,
    solid_depth, solid_track)}
