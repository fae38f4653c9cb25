/* SPDX-License-Identifier: MIT */
/* Recordings; see recording.h. */
#include "recording.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "../message.h"

static void put_count(FILE *file, uint32_t number) {
    const uint8_t bytes[4] = {(uint8_t)number, (uint8_t)(number >> 8), (uint8_t)(number >> 16),
                              (uint8_t)(number >> 24)};
    fwrite(bytes, 1, sizeof bytes, file);
}

static void put_float(FILE *file, double x) {
    float rounded = (float)x;
    uint32_t bits;
    memcpy(&bits, &rounded, sizeof bits);
    put_count(file, bits);
}

static void put_vec(FILE *file, pir_vec3 v) {
    put_float(file, v.x);
    put_float(file, v.y);
    put_float(file, v.z);
}

static void put_pose(FILE *file, pir_pose pose) {
    put_vec(file, pose.translation);
    put_float(file, pose.rotation.x);
    put_float(file, pose.rotation.y);
    put_float(file, pose.rotation.z);
    put_float(file, pose.rotation.w);
}

/* Whether the shape is a box about its origin, along its axes; its half sides. */
static bool is_box(const struct world_shape *shape, pir_vec3 *ret_half) {
    const pir_polytope *piece = shape->piece[0];
    if (shape->count != 1 || pir_polytope_vertex_count(piece) != 8 || pir_polytope_facet_count(piece) != 6)
        return false;
    pir_vec3 first = pir_polytope_vertex(piece, 0), half = {fabs(first.x), fabs(first.y), fabs(first.z)};
    for (uint32_t v = 1; v < 8; v++) {
        pir_vec3 x = pir_polytope_vertex(piece, v);
        if (fabs(x.x) != half.x || fabs(x.y) != half.y || fabs(x.z) != half.z)
            return false;
    }
    *ret_half = half;
    return true;
}

static bool is_static_box(const struct stage_body *body, pir_vec3 *ret_half) {
    return body->body.kind == PIR_BODY_STATIC && is_box(body->body.shape, ret_half);
}

bool recording_check(const struct stage *stage) {
    for (uint32_t i = 0; i < stage->body_count; i++) {
        const struct world_shape *shape = stage->body[i].body.shape;
        if (world_shape_is_surface(shape))
            complain("simulate: --record: bodies[%" PRIu32 "] is a surface; recordings do not hold surfaces yet", i);
        else if (shape->count != 1)
            complain("simulate: --record: bodies[%" PRIu32 "] has %" PRIu32 " pieces; a recording has convex bodies", i,
                     shape->count);
        else
            continue;
        return false;
    }
    return true;
}

static pir_status put_shape(FILE *file, const pir_polytope *piece) {
    pir_mesh *mesh = NULL;
    pir_status status = pir_mesh_from_polytope(piece, &mesh);
    if (status != PIR_OK)
        return status;
    uint32_t triangles = 0, facets = pir_mesh_facet_count(mesh), count;
    for (uint32_t f = 0; f < facets; f++) {
        pir_mesh_facet(mesh, f, &count);
        triangles += count > 2 ? count - 2 : 0;
    }
    put_count(file, pir_mesh_vertex_count(mesh));
    put_count(file, triangles);
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh); v++)
        put_vec(file, pir_mesh_vertices(mesh)[v]);
    for (uint32_t f = 0; f < facets; f++) {
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        for (uint32_t i = 2; i < count; i++) {
            put_count(file, corner[0]);
            put_count(file, corner[i - 1]);
            put_count(file, corner[i]);
        }
    }
    pir_mesh_destroy(mesh);
    return PIR_OK;
}

/* The shapes, each once. One that is not convex is of no body, since those have been refused, and is empty. */
static bool put_shapes(FILE *file, const struct stage *stage) {
    for (uint32_t i = 0; i < stage->shape_count; i++) {
        const struct world_shape *shape = &stage->shape[i];
        if (shape->count != 1) {
            put_count(file, 0);
            put_count(file, 0);
            continue;
        }
        const pir_status status = put_shape(file, shape->piece[0]);
        if (status != PIR_OK) {
            complain("simulate: %s", pir_status_text(status));
            return false;
        }
    }
    return true;
}

bool recording_begin(FILE *file, const struct stage *stage, uint32_t frames) {
    uint32_t statics = 0;
    pir_vec3 half;
    for (uint32_t i = 0; i < stage->body_count; i++)
        statics += is_static_box(&stage->body[i], &half);
    fwrite("SCENE01", 1, 8, file);
    put_count(file, stage->shape_count);
    put_count(file, stage->body_count - statics);
    put_count(file, statics);
    put_count(file, frames);
    put_float(file, 1. / 60);
    if (!put_shapes(file, stage))
        return false;
    for (uint32_t i = 0; i < stage->body_count; i++)
        if (is_static_box(&stage->body[i], &half)) {
            put_vec(file, half);
            put_pose(file, stage->body[i].body.pose);
        }
    for (uint32_t i = 0; i < stage->body_count; i++)
        if (!is_static_box(&stage->body[i], &half))
            put_count(file, stage->body[i].shape);
    return true;
}

void recording_add(FILE *file, const struct stage *stage, const struct world *world) {
    pir_vec3 half;
    for (uint32_t i = 0; i < stage->body_count; i++)
        if (!is_static_box(&stage->body[i], &half))
            put_pose(file, world_motion(world, i).pose);
}
