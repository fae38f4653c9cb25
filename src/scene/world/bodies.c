/* SPDX-License-Identifier: MIT */
/* Bodies and their pieces: see bodies.h. */
#include "scene/world/bodies.h"

#include "base/processor.h"
#include "base/report.h"
#include "exact/rotation.h"
#include "mesh/query/mesh_walk.h"
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

/* The number that the next body gets: the least that is free and has a generation left. */
static uint32_t next_number(const pir_bodies *bodies) {
    uint32_t body = bodies->body_count == bodies->body_end ? bodies->body_end : 0;
    while (body < bodies->body_slots &&
           (bodies->body[body].used || bodies->body[body].generation == PIR_GENERATIONS_LAST))
        body++;
    return body;
}

pir_status pir_bodies_reserve(pir_bodies *bodies, const pir_allocator *allocator, uint32_t pieces) {
    const uint32_t next = next_number(bodies);
    if (next >= PIR_BODIES_MAX)
        return PIR_ERR_LIMIT;
    if (next == bodies->body_capacity && !grow_bodies(bodies, allocator))
        return PIR_ERR_MEMORY;
    return pir_pieces_reserve(bodies, allocator, pieces);
}

/* A piece of a body: `extent` is what it holds. */
static void add_piece(pir_bodies *bodies, uint32_t body, uint32_t number, pir_extent extent, uint64_t user) {
    uint32_t piece = bodies->piece_unused;
    bodies->piece_unused = bodies->piece[piece].next;
    bodies->piece_count++;
    bodies->piece[piece] = (pir_scene_piece){.extent = extent,
                                             .body = body,
                                             .number = number,
                                             .next = bodies->body[body].first,
                                             .node = PIR_PIECE_NONE,
                                             .first = PIR_NO_END,
                                             .user = user,
                                             .kind = (uint8_t)(extent.polytope ? PIR_PIECE_CONVEX : PIR_PIECE_SURFACE)};
    bodies->body[body].first = piece;
    bodies->body[body].reach = fmax(bodies->body[body].reach, bodies->piece[piece].extent.reach);
}

static void add_pieces(pir_bodies *bodies, uint32_t body, const pir_body_options *options) {
    for (uint32_t i = options->piece_count; i-- > 0;) {
        pir_extent extent = pir_extent_of(pir_polytope_retain(options->pieces[i]));
        extent.coarse = options->coarse ? pir_coarse_retain(options->coarse[i]) : NULL;
        add_piece(bodies, body, i, extent, options->piece_users ? options->piece_users[i] : 0);
    }
}

static void add_surface(pir_bodies *bodies, uint32_t body, const pir_body_options *options) {
    pir_body_surface *surface = &bodies->body[body].surface;
    const pir_surface_ref of = {options->mesh, options->field};
    surface->mesh = options->mesh ? pir_trimesh_retain(options->mesh) : NULL;
    surface->field = options->field ? pir_height_field_retain(options->field) : NULL;
    surface->skin = options->kind == PIR_BODY_STATIC ? 0 : pir_surface_skin(of);
    surface->triangles = PIR_PIECE_NONE;
    add_piece(bodies, body, 0, (pir_extent){NULL, NULL, pir_surface_farthest(of)}, 0);
}

/* FNV-1a over words, folded. */
static uint64_t hash_word(uint64_t hash, uint64_t word) {
    hash = (hash ^ word) * UINT64_C(0x100000001b3);
    return hash ^ hash >> 29;
}

static uint64_t hash_polytope(uint64_t hash, const pir_polytope *p) {
    hash = hash_word(hash_word(hash, p->vertex_count), p->facet_count);
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        uint64_t bits[3];
        memcpy(bits, &p->vertex[v], sizeof bits);
        for (int k = 0; k < 3; k++)
            hash = hash_word(hash, bits[k]);
    }
    return hash;
}

uint64_t pir_shape_hash(const pir_body_options *options) {
    if (!options->pieces)
        return pir_surface_hash((pir_surface_ref){options->mesh, options->field});
    uint64_t hash = hash_word(UINT64_C(0xcbf29ce484222325), options->piece_count);
    for (uint32_t i = 0; i < options->piece_count; i++)
        hash = hash_polytope(hash, options->pieces[i]);
    return hash;
}

bool pir_bodies_reach(pir_bodies *bodies, const pir_allocator *allocator, uint32_t numbers) {
    while (bodies->body_capacity < numbers)
        if (!grow_bodies(bodies, allocator))
            return false;
    for (; bodies->body_slots < numbers; bodies->body_slots++)
        bodies->body[bodies->body_slots] = (pir_scene_body){.used = false};
    return true;
}

void pir_bodies_put(pir_bodies *bodies, uint32_t body, uint32_t generation, const pir_body_options *options,
                    const pir_place *place) {
    bodies->body_end = body < bodies->body_end ? bodies->body_end : body + 1;
    bodies->body_count++;
    bodies->body[body] = (pir_scene_body){.pose = place->pose,
                                          .previous = place->pose,
                                          .unit = place->unit,
                                          .radius = options->radius,
                                          .fast = options->fast,
                                          .first = PIR_PIECE_NONE,
                                          .pieces = options->pieces ? options->piece_count : 1,
                                          .category = options->category,
                                          .mask = options->mask,
                                          .used = true,
                                          .sensor = options->sensor != 0,
                                          .fresh = true,
                                          .disabled = options->disabled != 0,
                                          .generation = (uint16_t)generation,
                                          .user = options->user,
                                          .shape = pir_shape_hash(options),
                                          .kind = (uint8_t)options->kind};
    if (options->pieces)
        add_pieces(bodies, body, options);
    else
        add_surface(bodies, body, options);
}

uint32_t pir_bodies_add(pir_bodies *bodies, const pir_body_options *options, const pir_place *place) {
    const uint32_t body = next_number(bodies);
    if (body == bodies->body_slots)
        bodies->body[bodies->body_slots++] = (pir_scene_body){.used = false};
    pir_bodies_put(bodies, body, bodies->body[body].generation, options, place);
    return body;
}

void pir_bodies_empty(pir_bodies *bodies, uint32_t body) {
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
}

void pir_bodies_trim(pir_bodies *bodies) {
    while (bodies->body_end > 0 && !bodies->body[bodies->body_end - 1].used)
        bodies->body_end--;
}

void pir_bodies_remove(pir_bodies *bodies, uint32_t body) {
    const uint16_t generation = bodies->body[body].generation;
    pir_bodies_empty(bodies, body);
    bodies->body[body] = (pir_scene_body){.used = false, .generation = (uint16_t)(generation + 1)};
    bodies->body_count--;
    pir_bodies_trim(bodies);
}

/* --- motion --- */

void pir_bodies_travel(pir_scene_body *body, const pir_place *place) {
    pir_vec3 way = pir_vec_sub(place->pose.translation, body->pose.translation);
    double step = sqrt(pir_vec_dot(way, way)) + pir_rotation_angle_bound(body->unit, place->unit) * body->reach;
    body->travel = (body->travel + step * (1 + 0x1p-40)) * (1 + 0x1p-51);
    body->surface.drift = (body->surface.drift + step * (1 + 0x1p-40)) * (1 + 0x1p-51);
}

/* Whether the kinds of two bodies, one a sensor or none, let them meet. */
static bool kinds_meet(const pir_scene_body *p, const pir_scene_body *q) {
    if (p->kind == PIR_BODY_MOVING || q->kind == PIR_BODY_MOVING)
        return true;
    if (pir_body_has_surface(p) && pir_body_has_surface(q))
        return false;
    return (p->sensor && q->kind == PIR_BODY_KINEMATIC) || (q->sensor && p->kind == PIR_BODY_KINEMATIC);
}

/* Whether the caller lets two bodies meet. */
static bool may_meet(const pir_bodies *bodies, uint32_t a, uint32_t b) {
    const uint32_t p = a < b ? a : b, q = a < b ? b : a;
    return bodies->meets(bodies->meets_context, pir_body_id(bodies, p), bodies->body[p].user, pir_body_id(bodies, q),
                         bodies->body[q].user);
}

bool pir_bodies_meet(const pir_bodies *bodies, uint32_t a, uint32_t b) {
    const pir_scene_body *p = &bodies->body[a], *q = &bodies->body[b];
    return a != b && !p->disabled && !q->disabled && kinds_meet(p, q) && (p->category & q->mask) != 0 &&
           (q->category & p->mask) != 0 && !(p->sensor && q->sensor) && (!bodies->meets || may_meet(bodies, a, b));
}

/* --- names --- */

uint64_t pir_piece_user(const pir_bodies *bodies, const pir_scene_piece *piece) {
    if (piece->kind != PIR_PIECE_TRIANGLE)
        return piece->user;
    return pir_surface_material(pir_body_surface_of(&bodies->body[piece->body]), piece->number);
}

uint32_t pir_bodies_piece(const pir_bodies *bodies, uint32_t body, uint32_t number) {
    if (pir_body_has_surface(&bodies->body[body]))
        return pir_triangles_find(bodies, body, number);
    uint32_t piece = bodies->body[body].first;
    while (piece != PIR_PIECE_NONE && bodies->piece[piece].number != number)
        piece = bodies->piece[piece].next;
    return piece;
}
