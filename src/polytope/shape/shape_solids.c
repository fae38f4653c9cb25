/* SPDX-License-Identifier: MIT */
/*
 * The platonic and archimedean solids, as orbits of a few points under a group of signed permutations of the axes.
 *
 * A signed permutation is exact in doubles, so every orbit has its group's symmetry bit for bit, and that alone
 * flattens all facets of the octahedral solids. The icosahedral group is not one of signed permutations: a true
 * dodecahedron has no rational coordinates, and rounded pentagons would break into slivers. The points of those solids
 * are instead integers that satisfy the plane equations of all facets with more than three corners exactly: with the
 * golden ratio in the facets' normals replaced by a ratio of Fibonacci numbers the equations are linear and have
 * integer solutions, and one next to the true solid, found by lattice reduction, was taken. It is within 1e-6 of the
 * true solid, has its combinatorics, and keeps the pyritohedral (the snub dodecahedron: the tetrahedral) symmetry.
 */
#include "polytope/shape/shape_solids.h"

#include <math.h>

/* Groups of signed permutations. An element is even when its permutation is even; it is a rotation when
   parity and signs agree. */
enum group {
    TETRAHEDRAL,          /* T, 12: even, rotations */
    PYRITOHEDRAL,         /* Th, 24: even */
    OCTAHEDRAL_ROTATIONS, /* O, 24: rotations */
    FULL_TETRAHEDRAL,     /* Td, 24: an even number of minus signs */
    FULL_OCTAHEDRAL,      /* Oh, 48: all */
};

struct solid {
    enum group group;
    int generators;
    pir_vec3 generator[5];
};

static const struct solid solids[] = {
    [PIR_TETRAHEDRON] = {FULL_TETRAHEDRAL, 1, {{1, 1, 1}}},
    [PIR_CUBE] = {FULL_OCTAHEDRAL, 1, {{1, 1, 1}}},
    [PIR_OCTAHEDRON] = {FULL_OCTAHEDRAL, 1, {{1, 0, 0}}},
    [PIR_DODECAHEDRON] = {PYRITOHEDRAL, 2, {{38580030724, 38580030724, 38580030724}, {0, 23843770275, 62423800998}}},
    [PIR_ICOSAHEDRON] = {PYRITOHEDRAL, 1, {{0, 1, 1.618033988749895}}},
    [PIR_TRUNCATED_TETRAHEDRON] = {FULL_TETRAHEDRAL, 1, {{1, 1, 3}}},
    [PIR_CUBOCTAHEDRON] = {FULL_OCTAHEDRAL, 1, {{0, 1, 1}}},
    [PIR_TRUNCATED_CUBE] = {FULL_OCTAHEDRAL, 1, {{0.41421356237309515, 1, 1}}},
    [PIR_TRUNCATED_OCTAHEDRON] = {FULL_OCTAHEDRAL, 1, {{0, 1, 2}}},
    [PIR_RHOMBICUBOCTAHEDRON] = {FULL_OCTAHEDRAL, 1, {{1, 1, 2.414213562373095}}},
    [PIR_TRUNCATED_CUBOCTAHEDRON] = {FULL_OCTAHEDRAL, 1, {{1, 2.414213562373095, 3.8284271247461903}}},
    [PIR_SNUB_CUBE] = {OCTAHEDRAL_ROTATIONS, 1, {{0.5436890126920764, 1, 1.8392867552141612}}},
    [PIR_ICOSIDODECAHEDRON] = {PYRITOHEDRAL,
                               2,
                               {{0, 0, 281193501717029}, {86893570721950, 140596750866053, 227490321613925}}},
    [PIR_TRUNCATED_DODECAHEDRON] = {PYRITOHEDRAL,
                                    3,
                                    {{0, 48033584545519, 281193502757938},
                                     {48033586346295, 125753555853015, 251507113324995},
                                     {125753555928495, 155439943567567, 203473529759115}}},
    [PIR_TRUNCATED_ICOSAHEDRON] = {PYRITOHEDRAL,
                                   3,
                                   {{0, 57929042580352, 281193502778771},
                                    {57929043796180, 209589255612776, 187462340263635},
                                    {93731164096544, 115858094075004, 245391381501043}}},
    [PIR_RHOMBICOSIDODECAHEDRON] = {PYRITOHEDRAL,
                                    3,
                                    {{13276138782199, 13276138782199, 56238712074846},
                                     {34757432242609, 21481274951199, 42962532732546},
                                     {48033600145579, 0, 34757403633446}}},
    [PIR_TRUNCATED_ICOSIDODECAHEDRON] = {PYRITOHEDRAL,
                                         5,
                                         {{37632272500942, 37632272500942, 281193505942426},
                                          {75264559699305, 98522585663478, 257935474342194},
                                          {37632278436745, 159412898341018, 234677442927214},
                                          {136154857471580, 121780607901878, 220303202291594},
                                          {98522576209020, 182670920579418, 197045170876614}}},
    [PIR_SNUB_DODECAHEDRON] = {TETRAHEDRAL,
                               5,
                               {{-50259756219850, 44373129662637, 281193501736064},
                                {-147922064849975, 113647805099260, 220834875590624},
                                {-76124832864125, -86223702780544, 265208005250336},
                                {-234145767657025, 25865076635530, 167545696626848},
                                {-189772637967500, -97662308616882, 194969798958656}}},
    [PIR_TRIAKIS_ICOSAHEDRON] = {PYRITOHEDRAL,
                                 3,
                                 {{0, 1, 1.618033988749895},
                                  {0.9387489019317514, 0.9387489019317514, 0.9387489019317514},
                                  {0, 1.5189276302272157, 0.5801787282954641}}},
};

static bool in_group(enum group group, bool even, bool even_signs) {
    switch (group) {
    case TETRAHEDRAL:
        return even && even_signs;
    case PYRITOHEDRAL:
        return even;
    case OCTAHEDRAL_ROTATIONS:
        return even == even_signs;
    case FULL_TETRAHEDRAL:
        return even_signs;
    case FULL_OCTAHEDRAL:
        break;
    }
    return true;
}

/* Adds c when it is none of the points from `first` on: what a generator on a mirror gives more
   than once is added once. */
static void add_new(struct pir_point_list *points, size_t first, const double c[3]) {
    for (size_t i = first; i < points->count; i++)
        if (points->at[i].x == c[0] && points->at[i].y == c[1] && points->at[i].z == c[2])
            return;
    pir_point_list_add(points, c[0], c[1], c[2]);
}

static void add_orbit(struct pir_point_list *points, enum group group, const double c[3]) {
    static const unsigned char permutations[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    const size_t first = points->count;
    for (int p = 0; p < 6; p++)
        for (int signs = 0; signs < 8; signs++) {
            const bool even_signs = ((signs ^ (signs >> 1) ^ (signs >> 2)) & 1) == 0;
            if (!in_group(group, p < 3, even_signs))
                continue;
            double image[3];
            for (int k = 0; k < 3; k++) {
                const double coordinate = c[permutations[p][k]];
                image[k] = coordinate != 0 && (signs >> k & 1) ? -coordinate : coordinate;
            }
            add_new(points, first, image);
        }
}

void pir_points_solid(const double *value, struct pir_point_list *points) {
    const struct solid *solid = &solids[(int)value[0]];
    // the power of two above every coordinate
    int exponent = 0;
    for (int g = 0; g < solid->generators; g++) {
        const pir_vec3 v = solid->generator[g];
        int top;
        frexp(fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z))), &top);
        exponent = g == 0 || top > exponent ? top : exponent;
    }
    for (int g = 0; g < solid->generators; g++) {
        const pir_vec3 v = solid->generator[g];
        add_orbit(points, solid->group,
                  (double[3]){ldexp(v.x, -exponent), ldexp(v.y, -exponent), ldexp(v.z, -exponent)});
    }
}
