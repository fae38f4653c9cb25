/* SPDX-License-Identifier: MIT */
/*
 * The table of shapes. Ranges keep every shape below two million points.
 *
 * The models of Behar and Lien (GMU-CS-TR-2010-12, Figure 3) come first. The paper counts triangles: a facet of k
 * corners is k − 2 of them, and the parameters below give its numbers.
 */
#include "polytope/shape/shape_table.h"

#include "polytope/shape/shape_families.h"
#include "polytope/shape/shape_solids.h"

// clang-format off
#define FIXED(value)                       {NULL, value, value, value, false}
#define LENGTH(name, standard)             {name, standard, 1e-9, 1e9, false}
#define COUNT(name, standard, low, high)   {name, standard, low, high, true}
#define SIDES(standard)                    COUNT("sides", standard, 3, 100000)
#define SOLID(name, solid, help)           {name, help, pir_points_solid, {FIXED(solid)}}

const struct pir_shape_entry pir_shapes[] = {
    {"cone", "cone over a regular polygon; 78 triangles; sides=40 radius=1 height=2",
     pir_points_pyramid, {SIDES(40), LENGTH("radius", 1), LENGTH("height", 2)}},
    SOLID("cube", PIR_CUBE, "cube of side 1; 6 facets, 12 triangles"),
    {"cylinder", "cylinder over a regular polygon; 140 triangles; sides=36 radius=1 height=2",
     pir_points_prism, {SIDES(36), LENGTH("radius", 1), LENGTH("height", 2)}},
    {"dd", "dioctagonal dipyramid; 32 triangles; radius=1 height=2",
     pir_points_dioctagonal, {LENGTH("radius", 1), LENGTH("height", 2)}},
    {"ellipse", "ellipsoid of semi-axes 1, 3/4 and 1/2; 960 triangles",
     pir_points_ellipsoid, {FIXED(16), FIXED(1), FIXED(0.75), FIXED(0.5)}},
    {"gs1", "geodesic sphere of level 1; 80 triangles", pir_points_geodesic, {FIXED(1), FIXED(1)}},
    {"gs2", "geodesic sphere of level 2; 180 triangles", pir_points_geodesic, {FIXED(2), FIXED(1)}},
    {"gs3", "geodesic sphere of level 3; 320 triangles", pir_points_geodesic, {FIXED(3), FIXED(1)}},
    {"gs4", "geodesic sphere of level 4; 500 triangles", pir_points_geodesic, {FIXED(4), FIXED(1)}},
    {"hp", "hexagonal pyramid; 7 facets, 10 triangles; radius=1 height=2",
     pir_points_pyramid, {FIXED(6), LENGTH("radius", 1), LENGTH("height", 2)}},
    SOLID("t", PIR_TRIAKIS_ICOSAHEDRON, "triakis icosahedron; 60 triangles"),
    SOLID("ti", PIR_TRUNCATED_ICOSIDODECAHEDRON, "truncated icosidodecahedron, within 1e-6; 62 facets, 236 triangles"),
    {"vrod", "round rod; 324 triangles", pir_points_rod, {FIXED(27), FIXED(3), FIXED(0.25), FIXED(2)}},

    SOLID("tetrahedron", PIR_TETRAHEDRON, "platonic; 4 facets"),
    SOLID("octahedron", PIR_OCTAHEDRON, "platonic; 8 facets"),
    SOLID("dodecahedron", PIR_DODECAHEDRON, "platonic; 12 facets; rational, within 1e-6 of regular"),
    SOLID("icosahedron", PIR_ICOSAHEDRON, "platonic; 20 facets"),

    SOLID("truncated-tetrahedron", PIR_TRUNCATED_TETRAHEDRON, "archimedean; 8 facets"),
    SOLID("cuboctahedron", PIR_CUBOCTAHEDRON, "archimedean; 14 facets"),
    SOLID("truncated-cube", PIR_TRUNCATED_CUBE, "archimedean; 14 facets"),
    SOLID("truncated-octahedron", PIR_TRUNCATED_OCTAHEDRON, "archimedean; 14 facets"),
    SOLID("rhombicuboctahedron", PIR_RHOMBICUBOCTAHEDRON, "archimedean; 26 facets"),
    SOLID("truncated-cuboctahedron", PIR_TRUNCATED_CUBOCTAHEDRON, "archimedean; 26 facets"),
    SOLID("snub-cube", PIR_SNUB_CUBE, "archimedean; 38 facets"),
    SOLID("icosidodecahedron", PIR_ICOSIDODECAHEDRON, "archimedean; 32 facets; rational, within 1e-6 of uniform"),
    SOLID("truncated-dodecahedron", PIR_TRUNCATED_DODECAHEDRON,
          "archimedean; 32 facets; rational, within 1e-6 of uniform"),
    SOLID("truncated-icosahedron", PIR_TRUNCATED_ICOSAHEDRON,
          "archimedean; 32 facets; rational, within 1e-6 of uniform"),
    SOLID("rhombicosidodecahedron", PIR_RHOMBICOSIDODECAHEDRON,
          "archimedean; 62 facets; rational, within 1e-6 of uniform"),
    SOLID("truncated-icosidodecahedron", PIR_TRUNCATED_ICOSIDODECAHEDRON,
          "archimedean; 62 facets; rational, within 1e-6 of uniform; the same as ti"),
    SOLID("snub-dodecahedron", PIR_SNUB_DODECAHEDRON, "archimedean; 92 facets; rational, within 1e-6 of uniform"),

    {"geodesic", "geodesic sphere of 20*(level+1)^2 triangles; level=4 radius=1",
     pir_points_geodesic, {COUNT("level", 4, 0, 446), LENGTH("radius", 1)}},
    {"ellipsoid", "ellipsoid of 4*level*(level-1) triangles and semi-axes x, y, z; level=16 x=1 y=0.75 z=0.5",
     pir_points_ellipsoid, {COUNT("level", 16, 2, 1000), LENGTH("x", 1), LENGTH("y", 0.75), LENGTH("z", 0.5)}},
    {"box", "box of sides x, y, z; x=1 y=1 z=1", pir_points_box, {LENGTH("x", 1), LENGTH("y", 1), LENGTH("z", 1)}},
    {"prism", "right prism over a regular polygon; sides=6 radius=1 height=2",
     pir_points_prism, {SIDES(6), LENGTH("radius", 1), LENGTH("height", 2)}},
    {"antiprism", "antiprism over a regular polygon; sides=6 radius=1 height=1",
     pir_points_antiprism, {SIDES(6), LENGTH("radius", 1), LENGTH("height", 1)}},
    {"pyramid", "pyramid over a regular polygon; sides=4 radius=1 height=1",
     pir_points_pyramid, {SIDES(4), LENGTH("radius", 1), LENGTH("height", 1)}},
    {"dipyramid", "dipyramid over a regular polygon; sides=6 radius=1 height=2",
     pir_points_dipyramid, {SIDES(6), LENGTH("radius", 1), LENGTH("height", 2)}},
    {"needle", "thin dipyramid; sides=8 radius=0.01 height=2",
     pir_points_dipyramid, {SIDES(8), LENGTH("radius", 0.01), LENGTH("height", 2)}},
    {"rod", "cylinder of that height with a half sphere of so many rings on each end; "
            "sides=12 rings=3 radius=0.25 height=2",
     pir_points_rod, {COUNT("sides", 12, 3, 1000), COUNT("rings", 3, 1, 500),
                      LENGTH("radius", 0.25), LENGTH("height", 2)}},
    {"random", "random points in a ball; points=100 seed=1 radius=1",
     pir_points_random, {COUNT("points", 100, 1, 1999999), COUNT("seed", 1, 0, 0x1p53), LENGTH("radius", 1)}},
    {"random-sphere", "random points on a sphere; points=100 seed=1 radius=1",
     pir_points_random_sphere, {COUNT("points", 100, 1, 1999999), COUNT("seed", 1, 0, 0x1p53), LENGTH("radius", 1)}},

    {"polygon", "flat regular polygon; sides=6 radius=1", pir_points_polygon, {SIDES(6), LENGTH("radius", 1)}},
    {"triangle", "flat triangle; radius=1", pir_points_polygon, {FIXED(3), LENGTH("radius", 1)}},
    {"segment", "segment along z; length=1", pir_points_segment, {LENGTH("length", 1)}},
    {"point", "the origin", pir_points_point, {FIXED(0)}},
};
// clang-format on

const size_t pir_shapes_count = sizeof pir_shapes / sizeof pir_shapes[0];
