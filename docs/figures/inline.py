# SPDX-License-Identifier: MIT
"""The single measured numbers in the prose of pages, by name; each takes the results and gives text.

Besides these, `TABLE.machine` is the machine that a table is of.
"""
import math

from results import Figures, between, count, percent, power, short, slope, two

PAIRS = ("gamepad-mug", "gs4-mug", "gs4", "ellipsoid960", "20-points")


def us(ns):
    return short(ns / 1e3)


# ---- README ----------------------------------------------------------------------------------------------------------


def one_part_in(whole, part):
    """1/230, with two digits."""
    return f"1/{float(f'{whole / part:.2g}'):.0f}"


README = {
    "update": lambda r: us(r.readme.number("update_ns", bodies="controller", steps=500)),
    "walk": lambda r: us(r.readme.number("walk_ns", bodies="controller", steps=500)),
    "brute": lambda r: us(r.readme.number("brute_ns", bodies="controller", steps=500)),
    "mismatches": lambda r: count(sum(int(row["mismatches"]) for row in r.readme.rows)),
    "mpr_wrong": lambda r: r.query.one(set="ellipsoid960", poses="deep", who="libccd")["wrong_numbers"],
    "walk_by_brute": lambda r: one_part_in(r.readme.number("brute_ns", bodies="gs4", steps=5000),
                                           r.readme.number("walk_ns", bodies="gs4", steps=5000)),
    "update_by_walk": lambda r: one_part_in(r.readme.number("walk_ns", bodies="gs4", steps=5000),
                                            r.readme.number("update_ns", bodies="gs4", steps=5000)),
    "as_fast_as_walk": lambda r: between([crossover(r, model) for model in ("gs4", "ellipse", "vrod")], two),
}


def crossover(r, model):
    """Degrees a frame from which on a walk takes no longer than an update; between rows, logarithms are on a line."""
    rows = [(math.log(360 / float(row["steps"])), math.log(float(row["walk_ns"]) / float(row["update_ns"])))
            for row in r.figure4.all(model=model)]
    for (turn, slower), (less, faster) in zip(rows, rows[1:]):
        if slower < 0 <= faster:
            return math.exp(turn + (less - turn) * slower / (slower - faster))
    raise Figures(f"{model}: no walk is as fast as an update")


# ---- accuracy.md -----------------------------------------------------------------------------------------------------


def trade(r, pair, family, setting="built in", column="frame_ns"):
    return r.trade.number(column, pair=pair, family=family, setting=setting)


def over_pairs(value):
    return lambda r: between([value(r, pair) for pair in PAIRS])


def saves_from(r, pair):
    """The least tolerance with which a frame takes nine tenths of the time or less; None where none does."""
    rows = [row for row in r.trade.all(pair=pair, family="tolerance") if float(row["setting"]) > 0]
    without = float(rows[0]["frame_ns"])
    return next((float(row["setting"]) for row in rows if float(row["frame_ns"]) <= 0.9 * without), None)


def simplified(vertices):
    def times(r):
        there = [pair for pair in PAIRS if r.trade.all(pair=pair, family="simplified", setting=vertices)]
        return between([trade(r, pair, "level", "by need") / trade(r, pair, "simplified", vertices) for pair in there])

    return times


def tightest(r, pair):
    """Times of a frame of engines that come to rounding accuracy, in parts of those of a pair by need."""
    times = [trade(r, pair, engine, "1e-12") for engine in ("FCL", "coal warm")] + [trade(r, pair, "Bullet")]
    return [time / trade(r, pair, "level", "by need") for time in times]


def rain(r, family, setting="built in", column="frame_ns"):
    return trade(r, "rain-300", family, setting, column)


ACCURACY = {
    "float_error": lambda r: power(max((r.trade.one(pair=p, family="coordinates", setting="float")["hausdorff"]
                                        for p in PAIRS), key=float), 0),
    "tolerance_saves": lambda r: between([t for t in (saves_from(r, p) for p in PAIRS) if t], lambda t: f"{t:g}"),
    "exact_coordinates": over_pairs(lambda r, p: trade(r, p, "coordinates", "exact") / trade(r, p, "coordinates",
                                                                                             "double")),
    "region_60": over_pairs(lambda r, p: trade(r, p, "region", 60) / trade(r, p, "region", 180)),
    "region_10": over_pairs(lambda r, p: trade(r, p, "region", 10) / trade(r, p, "region", 180)),
    "simplified_32": simplified(32),
    "simplified_16": simplified(16),
    "engines_tightest": lambda r: between([t for p in PAIRS for t in tightest(r, p)]),
    "loose_saves": lambda r: percent(max(1 - trade(r, p, "FCL", 0.1) / trade(r, p, "FCL", "1e-12") for p in PAIRS)),
    "loose_error": lambda r: f"{max(trade(r, p, 'FCL', 0.1, 'depth') for p in PAIRS):.1g}",
    "ccd_error": lambda r: f"{max(trade(r, p, 'libccd', '1e-12', 'depth') for p in PAIRS):.1g}",
    "rain_engines": lambda r: between([rain(r, e) / rain(r, "scene", "exact")
                                       for e in ("FCL", "Bullet", "box3d reusing manifolds")]),
    "rain_16_saves": lambda r: percent(1 - rain(r, "simplified", 16) / rain(r, "scene", "exact")),
    "rain_16_wrong": lambda r: percent(rain(r, "simplified", 16, "depth")),
    "far_pair": lambda r: between([r.distances.number("ns", vertices=v, accuracy=0) / 1e3 for v in (20, 100, 1000)]),
}


# ---- cgm.md ----------------------------------------------------------------------------------------------------------


def cgm_spheres(column, form=count):
    return lambda r: " to ".join(form(float(r.cgm_growth.rows[at][column])) for at in (0, -1))


def cgm_power(column):
    return lambda r: f"{slope(*([float(row[key]) for row in r.cgm_growth.rows] for key in (column, 'median ms'))):.2f}"


CGM = {
    "unturned": lambda r: short(float(r.cgm.one(pair="gs4", way="overlay and mesh",
                                                **{"facets of the sum": 500})["median ms"])),
    "unturned_filter": lambda r: percent(float(r.cgm.one(pair="gs4", way="overlay and mesh",
                                                         **{"facets of the sum": 500})["filter share"])),
    "each": cgm_spheres("facets of each"),
    "sums": cgm_spheres("facets of the sum"),
    "ms": cgm_spheres("median ms", short),
    "power_facets": cgm_power("facets of the sum"),
    "power_halfedges": cgm_power("halfedges"),
}


# ---- guarantees.md ---------------------------------------------------------------------------------------------------


def worst(column, most=0.01):
    return lambda r: power(max((row[column] for row in r.extremes.rows if float(row[column]) < most), key=float))


def reached(part):
    return lambda r: percent(r.coverage.number("reached", part=part) / r.coverage.number("lines", part=part), 1)


GUARANTEES = {
    "vertex": worst("vertex", 1e-13),
    "number": worst("number"),
    "turned": worst("turned"),
    "lines_src": lambda r: count(r.coverage.number("lines", part="src")),
    "lines_tools": lambda r: count(r.coverage.number("lines", part="tools")),
    "reached_src": reached("src"),
    "reached_tools": reached("tools"),
    "unreached": lambda r: count(sum(int(row["lines"]) - int(row["reached"]) for row in r.coverage.rows)),
}


# ---- queries.md ------------------------------------------------------------------------------------------------------


def growth(column, few=0, many=None):
    """Nanoseconds a facet of rows of growth.csv."""
    return lambda r: between([float(row[column]) / float(row["facets"]) for row in r.growth.rows[few:many]],
                             lambda x: f"{x:.0f}")


def growth_power(column):
    def fitted(r):
        return f"{slope(*([float(row[key]) for row in r.growth.rows] for key in ('facets', column))):.2f}"

    return fitted


def events(first, last):
    return lambda r: between([float(row["ns_per_event"]) for row in r.growth.rows[first:last]], lambda x: f"{x:.0f}")


QUERIES = {
    "walk_small": growth("walk_ns", 0, 1),
    "walk_middle": growth("walk_ns", 4, 8),
    "walk_large": growth("walk_ns", 8),
    "walk_power": growth_power("walk_ns"),
    "update_power": growth_power("update_ns"),
    "checked_power": growth_power("checked_per_frame"),
    "repaired_power": growth_power("repaired_per_frame"),
    "event_small": events(0, 4),
    "event_large": events(8, None),
}


# ---- scenes.md -------------------------------------------------------------------------------------------------------


def pile(column, engine="ours"):
    return lambda r: r.scene.number(column, scene="rec1000.bin", engine=engine)


def scene_power(engine):
    return lambda r: f"{r.scene_growth.number('power', engine=engine):.2f}"


SCENES = {
    "two_threads": lambda r: f"{pile('ours_over', 'ours, 2 threads')(r):.2f}",
    "memory": lambda r: f"{pile('peak_mb')(r):.0f}",
    "power": scene_power("ours"),
    "power_box3d": scene_power("box3d"),
    "few_move": lambda r: between([r.scene.number(column, scene="rain 10000 moving 10", engine="ours")
                                   for column in ("median_ms", "mean_ms")]),
}


# ---- slices.md, scale.md ---------------------------------------------------------------------------------------------


SLICES = {
    "open": lambda r: short(r.slices_read.number("open_ns", scene="gs4 level 3", slices_per_key=64) / 1e6),
    "next": lambda r: us(r.slices_read.number("next_ns", scene="gs4 level 3", slices_per_key=64)),
    "verdict": lambda r: between([float(row["verdict_ns"]) / 1000 for row in r.classify.rows]),
    "verdict_ratio": lambda r: between([float(row["verdict_ns"]) / float(row["pairs_ns"])
                                        for row in r.classify.rows]),
    "whole_ratio": lambda r: between([float(row["whole_ns"]) / float(row["pairs_ns"]) for row in r.classify.rows]),
}


def file_ns(scene):
    return lambda r: r.slices_scale.number("file_ns", scene=scene, level=6)


def assembling(scene):
    """Minutes to assemble the file of 1,000 pairs at level 6."""
    return lambda r: f"{file_ns(scene)(r) * 1e-9 * 72 * 8 ** 6 * 1000 / 60:.0f}"


SCALE = {
    "file_gs4": lambda r: us(file_ns("gs4")(r)),
    "file_dodecahedra": lambda r: us(file_ns("dodecahedra")(r)),
    "minutes_gs4": assembling("gs4"),
    "minutes_dodecahedra": assembling("dodecahedra"),
}


# ---- solids.md -------------------------------------------------------------------------------------------------------


def gears(r):
    rows = [r.solids.one(pair=f"gear{teeth}+star5") for teeth in (8, 16, 32, 64)]
    return slope(*([float(row[key]) for row in rows] for key in ("candidates", "whole_ms")))


def fcl_state(column):
    row = {"bodies": "mushroom and cup"}
    return lambda r: two(r.solid_query.number(f"fcl_state_{column}", **row) / r.solid_query.number(f"state_{column}",
                                                                                                   **row))


SOLIDS = {
    "rows": lambda r: count(len(r.solids.rows)),
    "manifold_faster": lambda r: count(sum(float(row["manifold_times"].strip(">") or 2) < 1 for row in r.solids.rows)),
    "power": lambda r: f"{gears(r):.2f}",
    "fcl_median": fcl_state("us"),
    "fcl_mean": fcl_state("mean_us"),
}


# ---- meshes.md -------------------------------------------------------------------------------------------------------


def of_pairs(column, triangles, by=1, form=count):
    return lambda r: between([float(row[column]) / by for row in r.mesh_pairs.all(triangles=triangles)], form)


MESHES = {
    "front": of_pairs("front", 20480),
    "megabytes": of_pairs("bytes", 20480, 1e6, short),
    "front_large": of_pairs("front", 81920),
    "megabytes_large": of_pairs("bytes", 81920, 1e6, short),
}

FIGURES = {f"{page}.{name}": figure
           for page, figures in (("readme", README), ("accuracy", ACCURACY), ("cgm", CGM), ("guarantees", GUARANTEES),
                                 ("queries", QUERIES), ("scenes", SCENES), ("slices", SLICES), ("scale", SCALE),
                                 ("solids", SOLIDS), ("meshes", MESHES))
           for name, figure in figures.items()}
