/* SPDX-License-Identifier: MIT */
/*
 * Shapes of bodies, known by a hash of their content. Each holds references to its polytopes and coarse bodies, or to
 * its surface, until all are dropped.
 *
 * Invariant: the table of slots is open and at most half full; it finds each shape by its hash.
 */
#ifndef PIR_SCENE_SHAPES_KEPT_SHAPES_H
#define PIR_SCENE_SHAPES_KEPT_SHAPES_H

#include <pirouette/scene.h>

#include "base/memory.h"

typedef struct pir_scene_form {
    uint64_t hash;
    pir_polytope **piece;
    pir_coarse **coarse; /* or NULL */
    uint32_t pieces;     /* 0 of a surface */
    pir_trimesh *mesh;
    pir_height_field *field;
} pir_scene_form;

typedef struct pir_kept_shapes {
    pir_scene_form *at;
    uint32_t *slot; /* places in `at`, plus 1; 0 where there is none */
    uint32_t capacity, count, slots;
} pir_kept_shapes;

void pir_kept_shapes_drop(pir_kept_shapes *shapes, const pir_allocator *allocator);

/* Keeps the shape of a body, where it is not kept yet. PIR_ERR_MEMORY; then nothing has changed. */
pir_status pir_kept_shapes_add(pir_kept_shapes *shapes, const pir_allocator *allocator, const pir_body_options *body,
                               uint64_t hash);

/* The shape with a hash, or NULL. */
const pir_scene_form *pir_kept_shapes_find(const pir_kept_shapes *shapes, uint64_t hash);

#endif
