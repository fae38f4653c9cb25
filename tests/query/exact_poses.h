/* SPDX-License-Identifier: MIT */
/*
 * Scenes and poses for exact checks of placement queries. A third of the scenes is degenerate: aligned, equal, of one
 * grid, flat. A third is nearly degenerate: moved by an ulp to 1e-10, or rotated in double. A third is in general
 * position. Some have sizes about 1e150 or 1e-150.
 */
#ifndef PIR_TEST_EXACT_POSES_H
#define PIR_TEST_EXACT_POSES_H

#include "oracle/place.h"
#include "support/bodies.h"

typedef struct exact_scene {
    char situation[64];
    test_points points_p, points_q;
    pir_quat rotation;
    int aligns;   /* rotations by small integers keep features parallel */
    double scale; /* the factor of all coordinates, a power of two or of ten */
} exact_scene;

/* Scene `number` of the seed. */
void exact_scene_make(test_random *random, uint64_t number, exact_scene *ret_scene);

/* Another rotation for the scene. */
pir_quat exact_rotation(test_random *random, const exact_scene *scene);

/*
 * A translation: far, near or deep, on vertices, edges and facets of the difference, or an ulp and more beside them.
 * `size` is that of the bodies.
 */
pir_vec3 exact_translation(test_random *random, const oracle_place *place, double size);

/*
 * A direction at a translation: any direction, one along an axis, an edge or a facet, one nearly along a facet, or
 * one to the middle of the difference.
 */
pir_vec3 exact_direction(test_random *random, const oracle_place *place, pir_vec3 translation, double size);

#endif
