/* SPDX-License-Identifier: MIT */
/*
 * How far points are from a polytope, by a pair of the point and the polytope: whether a point is in it is exact, and a
 * distance is within 10^-12 of the size of both, as query.h promises, so that much is added. How far both are from the
 * origin does not matter.
 */
#ifndef PIR_SIMPLIFY_MEASURE_H
#define PIR_SIMPLIFY_MEASURE_H

#include <stdbool.h>

#include <pirouette/pair.h>

typedef struct pir_measure {
    pir_polytope *origin; /* a point, moved to where it is asked for */
    pir_workspace *workspace;
    pir_pair *pair;         /* of the origin and the polytope; NULL before the first one */
    pir_polytope *polytope; /* that is asked */
    double slack;           /* of distances */
    double
        rough; /* of distances from a vertex that is rounded to doubles; or 0: too rough, vertices are taken exactly */
} pir_measure;

/* A point and how far it is from the polytope at most: 0 exactly where it is in it. */
typedef struct pir_measured {
    double distance;
    pir_feature nearest; /* of the polytope */
} pir_measured;

/* After a failure there is nothing to finish. */
pir_status pir_measure_init(pir_measure *measure, const pir_allocator *allocator);
void pir_measure_finish(pir_measure *measure);

/* The polytope that is asked from here on; it must stay. */
pir_status pir_measure_aim(pir_measure *measure, pir_polytope *polytope);

pir_status pir_measure_point(pir_measure *measure, pir_vec3 point, pir_measured *ret_measured);

/* Measures a vertex of another polytope. */
pir_status pir_measure_vertex(pir_measure *measure, const pir_polytope *of, uint32_t vertex,
                              pir_measured *ret_measured);

/* Whether `around` holds a vertex of a polytope, as it is exactly. Aim again before the next point. */
pir_status pir_measure_holds(pir_measure *measure, pir_polytope *around, const pir_polytope *polytope, uint32_t vertex,
                             bool *ret_holds);

#endif
