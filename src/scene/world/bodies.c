/* SPDX-License-Identifier: MIT */
/* Bodies and their pieces: see bodies.h. */
#include "scene/world/bodies.h"

#include "base/processor.h"
#include "base/report.h"
#include "exact/rotation.h"
#include "polytope/polytope.h"
#include "scene/world/surfaces.h"
#include "scene/world/triangles.h"
#include "scene/world/turned_box.h"

/* How much wider boxes are than they have to be, relative to bodies and coordinates. */
#define BOX_ERROR 0x1p-36

void pir_bodies_init(pir_bodies *bodies) {
    *bodies = (pir_bodies){.piece_unused = PIR_PIECE_NONE};
}

void pir_bodies_finish(pir_bodies *bodies, const pir_allocator *allocator) {
    for (uint32_t b = 0; b < bodies->body_end; b++)
        if (bodies->body[b].used)
            pir_bodies_remove(bodies, b);
    PIR_FREE(allocator, bodies->body, bodies->body_capacity);
    PIR_FREE(allocator, bodies->piece, bodies->piece_capacity);
    PIR_FREE(allocator, bodies->triangle, bodies->triangle_slots);
    PIR_FREE(allocator, bodies->kept, PIR_TRIANGLES_KEPT);
}

/* --- places --- */

pir_status pir_place_make(pir_pose pose, pir_place *ret_place) {
    pir_rotation rotation;
    if (!pir_vec_is_finite(pose.translation))
        return PIR_ERR_NOT_FINITE;
    pir_status status = pir_rotation_set(&rotation, pose.rotation);
    if (status != PIR_OK)
        return status;
    pir_vec3 t = pose.translation;
    if (!(fabs(t.x) <= PIR_BOX_FARTHEST && fabs(t.y) <= PIR_BOX_FARTHEST && fabs(t.z) <= PIR_BOX_FARTHEST))
        return PIR_ERR_LIMIT;
    *ret_place = (pir_place){pose, rotation.unit, rotation.r};
    return PIR_OK;
}

pir_status pir_place_fail(pir_pose pose, pir_status status, const char *of, pir_report *report) {
    const double at[3] = {pose.translation.x, pose.translation.y, pose.translation.z};
    if (status == PIR_ERR_ZERO_QUATERNION)
        return pir_fail(report, status, "%s: its pose: %s", of, pir_status_text(status));
    for (int k = 0; k < 3; k++) {
        if (!isfinite(at[k]))
            return pir_fail(report, status, "%s: its pose: %c is %g", of, "xyz"[k], at[k]);
        if (status == PIR_ERR_LIMIT && fabs(at[k]) > PIR_BOX_FARTHEST)
            return pir_fail(report, status, "%s: its pose: %c is %g, beyond 2^60", of, "xyz"[k], at[k]);
    }
    const double part[4] = {pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w};
    for (int k = 0; k < 4; k++)
        if (!isfinite(part[k]))
            return pir_fail(report, status, "%s: its rotation: %c is %g", of, "xyzw"[k], part[k]);
    return pir_fail(report, status, "%s: it reaches beyond 2^60", of);
}

/*
 * A turned vertex is off by 31u |v| by the matrix and by 6u |v| by the product, the vertex itself by u |v|, the sum
 * with the translation by u (|v| + |t|): below 64u (|v| + |t|) with u = 2^-53. Boxes are wider by more than that, and
 * by more than a distance in doubles is off by: where a distance says that two pieces are within radii and margin of
 * each other, their boxes meet.
 */
bool pir_place_points(const pir_place *place, const pir_reaching *points, double around, pir_box *ret_box) {
    pir_vec3 least, most;
    pir_processor_best()->turned_box->find(&place->r, points->point, points->count, &least, &most);
    double low[3] = {least.x, least.y, least.z}, high[3] = {most.x, most.y, most.z};
    double t[3] = {place->pose.translation.x, place->pose.translation.y, place->pose.translation.z};
    bool near = true;
    for (int k = 0; k < 3; k++) {
        double wider = around + (around + points->reach + fabs(t[k])) * BOX_ERROR;
        low[k] += t[k] - wider;
        high[k] += t[k] + wider;
        near = near && low[k] >= -PIR_BOX_FARTHEST && high[k] <= PIR_BOX_FARTHEST;
    }
    for (int k = 0; near && k < 3; k++) {
        ret_box->low[k] = pir_float_below(low[k]);
        ret_box->high[k] = pir_float_above(high[k]);
    }
    return near;
}

bool pir_place_box(const pir_place *place, const pir_extent *extent, double around, pir_box *ret_box) {
    const pir_polytope *p = extent->polytope;
    return pir_place_points(place, &(pir_reaching){p->vertex, p->vertex_count, extent->reach}, around, ret_box);
}

bool pir_piece_box(const pir_scene_body *body, const pir_scene_piece *piece, const pir_place *place, double around,
                   pir_box *ret_box) {
    if (piece->kind == PIR_PIECE_CONVEX)
        return pir_place_box(place, &piece->extent, around, ret_box);
    pir_vec3 point[8];
    const pir_surface_ref surface = pir_body_surface_of(body);
    uint32_t count = piece->kind == PIR_PIECE_SURFACE ? pir_surface_corners(surface, point)
                                                      : pir_surface_triangle(surface, piece->number, point);
    return pir_place_points(place, &(pir_reaching){point, count, piece->extent.reach}, around, ret_box);
}

pir_extent pir_extent_of(pir_polytope *polytope) {
    double most = 0;
    for (uint32_t v = 0; v < polytope->vertex_count; v++)
        most = fmax(most, sqrt(pir_vec_dot(polytope->vertex[v], polytope->vertex[v])));
    return (pir_extent){polytope, NULL, most * (1 + 0x1p-40)};
}

/* --- the tables --- */

static bool grow_bodies(pir_bodies *bodies, const pir_allocator *allocator) {
    uint32_t old = bodies->body_capacity, capacity = old > 0 ? 2 * old : 32;
    pir_scene_body *body = PIR_RESIZE(allocator, bodies->body, old, capacity);
    if (!body)
        return false;
    bodies->body = body;
    bodies->body_capacity = capacity;
    return true;
}

static bool grow_pieces(pir_bodies *bodies, const pir_allocator *allocator, uint32_t need) {
    uint32_t old = bodies->piece_capacity, capacity = 2 * old > need ? 2 * old : need;
    pir_scene_piece *piece = PIR_RESIZE(allocator, bodies->piece, old, capacity);
    if (!piece)
        return false;
    for (uint32_t i = capacity; i-- > old;) {
        piece[i] = (pir_scene_piece){.next = bodies->piece_unused};
        bodies->piece_unused = i;
    }
    bodies->piece = piece;
    bodies->piece_capacity = capacity;
    return true;
}

pir_status pir_pieces_reserve(pir_bodies *bodies, const pir_allocator *allocator, uint32_t pieces) {
    uint32_t used = bodies->piece_count + bodies->triangle_count;
    if (used > (uint32_t)1 << 30)
        return PIR_ERR_LIMIT;
    bool has_room = used + pieces <= bodies->piece_capacity || grow_pieces(bodies, allocator, used + pieces);
    return has_room ? PIR_OK : PIR_ERR_MEMORY;
}

pir_status pir_bodies_reserve(pir_bodies *bodies, const pir_allocator *allocator, uint32_t pieces) {
    if (bodies->body_count >= PIR_BODIES_MAX)
        return PIR_ERR_LIMIT;
    if (bodies->body_count == bodies->body_capacity && !grow_bodies(bodies, allocator))
        return PIR_ERR_MEMORY;
    return pir_pieces_reserve(bodies, allocator, pieces);
}

/* A piece of a body: `extent` is what it holds. */
static void add_piece(pir_bodies *bodies, uint32_t body, uint32_t number, pir_extent extent) {
    uint32_t piece = bodies->piece_unused;
    bodies->piece_unused = bodies->piece[piece].next;
    bodies->piece_count++;
    bodies->piece[piece] = (pir_scene_piece){.extent = extent,
                                             .body = body,
                                             .number = number,
                                             .next = bodies->body[body].first,
                                             .node = PIR_PIECE_NONE,
                                             .first = PIR_NO_END,
                                             .kind = (uint8_t)(extent.polytope ? PIR_PIECE_CONVEX : PIR_PIECE_SURFACE)};
    bodies->body[body].first = piece;
    bodies->body[body].reach = fmax(bodies->body[body].reach, bodies->piece[piece].extent.reach);
}

static void add_pieces(pir_bodies *bodies, uint32_t body, const pir_body_options *options) {
    for (uint32_t i = options->piece_count; i-- > 0;) {
        pir_extent extent = pir_extent_of(pir_polytope_retain(options->pieces[i]));
        extent.coarse = options->coarse ? pir_coarse_retain(options->coarse[i]) : NULL;
        add_piece(bodies, body, i, extent);
    }
}

static void add_surface(pir_bodies *bodies, uint32_t body, const pir_body_options *options) {
    pir_body_surface *surface = &bodies->body[body].surface;
    const pir_surface_ref of = {options->mesh, options->field};
    surface->mesh = options->mesh ? pir_trimesh_retain(options->mesh) : NULL;
    surface->field = options->field ? pir_height_field_retain(options->field) : NULL;
    surface->hash = pir_surface_hash(of);
    surface->skin = options->kind == PIR_BODY_STATIC ? 0 : pir_surface_skin(of);
    surface->triangles = PIR_PIECE_NONE;
    add_piece(bodies, body, 0, (pir_extent){NULL, NULL, pir_surface_farthest(of)});
}

uint32_t pir_bodies_add(pir_bodies *bodies, const pir_body_options *options, const pir_place *place) {
    uint32_t body = 0;
    while (body < bodies->body_end && bodies->body_count < bodies->body_end && bodies->body[body].used)
        body++;
    if (bodies->body_count == bodies->body_end)
        body = bodies->body_end++;
    bodies->body_count++;
    bodies->body[body] = (pir_scene_body){.pose = place->pose,
                                          .previous = place->pose,
                                          .unit = place->unit,
                                          .radius = options->radius,
                                          .first = PIR_PIECE_NONE,
                                          .pieces = options->pieces ? options->piece_count : 1,
                                          .category = options->category,
                                          .mask = options->mask,
                                          .used = true,
                                          .sensor = options->sensor != 0,
                                          .fresh = true,
                                          .kind = (uint8_t)options->kind};
    if (options->pieces)
        add_pieces(bodies, body, options);
    else
        add_surface(bodies, body, options);
    return body;
}

void pir_bodies_remove(pir_bodies *bodies, uint32_t body) {
    uint32_t piece = bodies->body[body].first;
    while (pir_body_has_surface(&bodies->body[body]) && bodies->body[body].surface.triangles != PIR_PIECE_NONE)
        pir_triangles_remove(bodies, bodies->body[body].surface.triangles);
    pir_triangles_forget(bodies, body);
    pir_trimesh_release(bodies->body[body].surface.mesh);
    pir_height_field_release(bodies->body[body].surface.field);
    while (piece != PIR_PIECE_NONE) {
        uint32_t next = bodies->piece[piece].next;
        pir_polytope_release(bodies->piece[piece].extent.polytope);
        pir_coarse_release(bodies->piece[piece].extent.coarse);
        pir_trimesh_release(bodies->piece[piece].facets);
        bodies->piece[piece] = (pir_scene_piece){.next = bodies->piece_unused};
        bodies->piece_unused = piece;
        bodies->piece_count--;
        piece = next;
    }
    bodies->body[body] = (pir_scene_body){.used = false};
    bodies->body_count--;
    while (bodies->body_end > 0 && !bodies->body[bodies->body_end - 1].used)
        bodies->body_end--;
}

/* --- motion --- */

void pir_bodies_travel(pir_scene_body *body, const pir_place *place) {
    pir_vec3 way = pir_vec_sub(place->pose.translation, body->pose.translation);
    double step = sqrt(pir_vec_dot(way, way)) + pir_rotation_angle_bound(body->unit, place->unit) * body->reach;
    body->travel = (body->travel + step * (1 + 0x1p-40)) * (1 + 0x1p-51);
    body->surface.drift = (body->surface.drift + step * (1 + 0x1p-40)) * (1 + 0x1p-51);
}

bool pir_bodies_meet(const pir_bodies *bodies, uint32_t a, uint32_t b) {
    const pir_scene_body *p = &bodies->body[a], *q = &bodies->body[b];
    return a != b && (p->kind == PIR_BODY_MOVING || q->kind == PIR_BODY_MOVING) && (p->category & q->mask) != 0 &&
           (q->category & p->mask) != 0 && !(p->sensor && q->sensor);
}
