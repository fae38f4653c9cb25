/* SPDX-License-Identifier: MIT */
/* Shapes that a scene keeps: see kept_shapes.h. */
#include "scene/shapes/kept_shapes.h"

static void finish_shape(pir_scene_form *shape, const pir_allocator *allocator) {
    for (uint32_t i = 0; i < shape->pieces; i++) {
        pir_polytope_release(shape->piece[i]);
        if (shape->coarse)
            pir_coarse_release(shape->coarse[i]);
    }
    pir_trimesh_release(shape->mesh);
    pir_height_field_release(shape->field);
    PIR_FREE(allocator, shape->piece, shape->pieces);
    PIR_FREE(allocator, shape->coarse, shape->pieces);
}

void pir_kept_shapes_drop(pir_kept_shapes *shapes, const pir_allocator *allocator) {
    for (uint32_t i = 0; i < shapes->count; i++)
        finish_shape(&shapes->at[i], allocator);
    PIR_FREE(allocator, shapes->at, shapes->capacity);
    PIR_FREE(allocator, shapes->slot, shapes->slots);
    *shapes = (pir_kept_shapes){0};
}

/* The slot of a hash, or the gap where it would be. */
static uint32_t seek(const pir_kept_shapes *shapes, uint64_t hash) {
    uint32_t slot = (uint32_t)(hash ^ hash >> 32) & (shapes->slots - 1);
    while (shapes->slot[slot] != 0 && shapes->at[shapes->slot[slot] - 1].hash != hash)
        slot = (slot + 1) & (shapes->slots - 1);
    return slot;
}

const pir_scene_form *pir_kept_shapes_find(const pir_kept_shapes *shapes, uint64_t hash) {
    const uint32_t place = shapes->slots > 0 ? shapes->slot[seek(shapes, hash)] : 0;
    return place > 0 ? &shapes->at[place - 1] : NULL;
}

static bool grow(pir_kept_shapes *shapes, const pir_allocator *allocator) {
    const uint32_t slots = shapes->slots > 0 ? 2 * shapes->slots : 32, capacity = slots / 2;
    uint32_t *slot = PIR_ZEROED(allocator, uint32_t, slots);
    pir_scene_form *at = slot ? PIR_RESIZE(allocator, shapes->at, shapes->capacity, capacity) : NULL;
    if (!at) {
        PIR_FREE(allocator, slot, slots);
        return false;
    }
    PIR_FREE(allocator, shapes->slot, shapes->slots);
    *shapes = (pir_kept_shapes){at, slot, capacity, shapes->count, slots};
    for (uint32_t i = 0; i < shapes->count; i++)
        shapes->slot[seek(shapes, at[i].hash)] = i + 1;
    return true;
}

/* The shape of a body, with references; its arrays may lack memory. */
static pir_status take_shape(const pir_allocator *allocator, const pir_body_options *body, pir_scene_form *shape) {
    if (body->pieces) {
        pir_polytope **piece = PIR_NEW(allocator, pir_polytope *, body->piece_count);
        pir_coarse **coarse = piece && body->coarse ? PIR_ZEROED(allocator, pir_coarse *, body->piece_count) : NULL;
        if (!piece || (body->coarse && !coarse)) {
            PIR_FREE(allocator, piece, body->piece_count);
            return PIR_ERR_MEMORY;
        }
        for (uint32_t i = 0; i < body->piece_count; i++) {
            piece[i] = pir_polytope_retain(body->pieces[i]);
            if (coarse && body->coarse[i])
                coarse[i] = pir_coarse_retain(body->coarse[i]);
        }
        shape->piece = piece;
        shape->coarse = coarse;
        shape->pieces = body->piece_count;
    }
    shape->mesh = body->mesh ? pir_trimesh_retain(body->mesh) : NULL;
    shape->field = body->field ? pir_height_field_retain(body->field) : NULL;
    return PIR_OK;
}

pir_status pir_kept_shapes_add(pir_kept_shapes *shapes, const pir_allocator *allocator, const pir_body_options *body,
                               uint64_t hash) {
    pir_scene_form shape = {.hash = hash};
    if (pir_kept_shapes_find(shapes, hash))
        return PIR_OK;
    if (2 * shapes->count >= shapes->slots && !grow(shapes, allocator))
        return PIR_ERR_MEMORY;
    const pir_status status = take_shape(allocator, body, &shape);
    if (status != PIR_OK)
        return status;
    const uint32_t slot = seek(shapes, hash);
    shapes->at[shapes->count++] = shape;
    shapes->slot[slot] = shapes->count;
    return PIR_OK;
}
