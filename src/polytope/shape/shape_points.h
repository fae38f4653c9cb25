/* SPDX-License-Identifier: MIT */
/*
 * Point lists that the model maker fills, and the directions of a circle, the same bits on every machine.
 */
#ifndef PIR_POLYTOPE_SHAPE_SHAPE_POINTS_H
#define PIR_POLYTOPE_SHAPE_SHAPE_POINTS_H

#include <stdbool.h>

#include <pirouette/base.h>

/* A growing list. Once memory has run out `failed` stays set and further points are dropped, so
   that a maker checks once. */
struct pir_point_list {
    const pir_allocator *allocator;
    pir_vec3 *at;
    size_t count, capacity;
    bool failed;
};

void pir_point_list_add(struct pir_point_list *list, double x, double y, double z);
void pir_point_list_finish(struct pir_point_list *list);

/* Cosine and sine. */
struct pir_direction {
    double x, y;
};

/* The direction at part/whole of a full turn, 0 < whole < 2^60, within 4·2^-53; quarter turns are exact. */
struct pir_direction pir_turn_direction(uint64_t part, uint64_t whole);

#endif
