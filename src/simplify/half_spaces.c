/* SPDX-License-Identifier: MIT */
/* See half_spaces.h. */
#include "simplify/half_spaces.h"

#include "base/vec.h"

static pir_vec3 to_frame(const pir_half_spaces *s, pir_vec3 x) {
    pir_vec3 d = pir_vec_sub(x, s->middle);
    return (pir_vec3){d.x / s->unit.x, d.y / s->unit.y, d.z / s->unit.z};
}

/* A plane's normal in the frame, with its greatest component 1. */
static pir_vec3 normal_in_frame(const pir_half_spaces *s, pir_vec3 n) {
    double most = fmax(s->unit.x, fmax(s->unit.y, s->unit.z));
    pir_vec3 m = {n.x * (s->unit.x / most), n.y * (s->unit.y / most), n.z * (s->unit.z / most)};
    return pir_vec_scale(m, 1 / fmax(fabs(m.x), fmax(fabs(m.y), fabs(m.z))));
}

bool pir_half_spaces_init(pir_half_spaces *spaces, const pir_polytope *body, uint32_t room) {
    pir_vec3 low, high, sum = {0, 0, 0};
    pir_polytope_bounds(body, &low, &high);
    // the mean of the vertices, about a corner of the box so that little is lost far from the origin
    for (uint32_t v = 0; v < body->vertex_count; v++)
        sum = pir_vec_add(sum, pir_vec_scale(pir_vec_sub(body->vertex[v], low), 1.0 / body->vertex_count));
    *spaces = (pir_half_spaces){.middle = pir_vec_add(low, sum), .room = room};
    spaces->unit = pir_vec_scale(pir_vec_sub(high, low), 0.5);
    spaces->dual = PIR_NEW(&body->allocator, pir_vec3, room);
    return spaces->dual != NULL;
}

void pir_half_spaces_finish(pir_half_spaces *spaces, const pir_polytope *body) {
    PIR_FREE(&body->allocator, spaces->dual, spaces->room);
}

bool pir_half_spaces_add(pir_half_spaces *spaces, pir_vec3 normal, pir_vec3 through) {
    pir_vec3 n = normal_in_frame(spaces, normal);
    double height = pir_vec_dot(n, to_frame(spaces, through));
    if (!(height > 0x1p-40) || spaces->count == spaces->room)
        return false;
    spaces->dual[spaces->count++] = pir_vec_scale(n, 1 / height);
    return true;
}

double pir_half_spaces_beyond(const pir_half_spaces *spaces, pir_vec3 normal, pir_vec3 through, pir_vec3 point) {
    pir_vec3 n = normal_in_frame(spaces, normal);
    pir_vec3 beyond = pir_vec_sub(to_frame(spaces, point), to_frame(spaces, through));
    return pir_vec_dot(n, beyond) / sqrt(pir_vec_dot(n, n));
}

/* The corner of a facet of the dual, moved outwards, out of the frame. False where the facet passes the middle by. */
static bool corner_of(const pir_half_spaces *s, const pir_polytope *dual, uint32_t facet, double push,
                      pir_vec3 *ret_corner) {
    pir_vec3 n = dual->normal[facet], on = dual->vertex[dual->origin[dual->loop[dual->loop_start[facet]]]];
    double height = pir_vec_dot(n, on);
    if (!(height > 0x1p-40))
        return false;
    pir_vec3 w = pir_vec_scale(n, (1 + push) / height);
    *ret_corner =
        (pir_vec3){s->middle.x + w.x * s->unit.x, s->middle.y + w.y * s->unit.y, s->middle.z + w.z * s->unit.z};
    return pir_vec_is_finite(*ret_corner);
}

pir_status pir_half_spaces_polytope(const pir_half_spaces *spaces, double push, const pir_allocator *allocator,
                                    pir_polytope **ret_polytope) {
    const pir_polytope_options options = {.size = sizeof options, .allocator = allocator};
    pir_polytope *dual = NULL;
    pir_status status = pir_polytope_create(spaces->dual, spaces->count, &options, &dual);
    if (status != PIR_OK)
        return status;
    uint32_t count = dual->facet_count;
    pir_vec3 *corner = PIR_NEW(allocator, pir_vec3, count);
    status = corner ? PIR_OK : PIR_ERR_MEMORY;
    if (status == PIR_OK && dual->dimension < 3)
        status = PIR_ERR_EMPTY;
    for (uint32_t f = 0; f < count && status == PIR_OK; f++)
        if (!corner_of(spaces, dual, f, push, &corner[f]))
            status = PIR_ERR_EMPTY;
    if (status == PIR_OK)
        status = pir_polytope_create(corner, count, &options, ret_polytope);
    PIR_FREE(allocator, corner, count);
    pir_polytope_release(dual);
    return status;
}
