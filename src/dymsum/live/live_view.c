/* SPDX-License-Identifier: MIT */
/* The public view of a live mesh: slots, pairs, and coordinates and planes, computed in one pass each. */
#include "dymsum/live/live_mesh.h"
#include "dymsum/mesh/placing.h"

const pir_sum_pair *pir_live_mesh_appeared(const pir_live_mesh *live, uint32_t *ret_count) {
    *ret_count = live->appeared.count;
    return live->appeared.at;
}

const pir_sum_pair *pir_live_mesh_disappeared(const pir_live_mesh *live, uint32_t *ret_count) {
    *ret_count = live->disappeared.count;
    return live->disappeared.at;
}

const uint32_t *pir_live_mesh_rewritten(const pir_live_mesh *live, uint32_t *ret_count) {
    *ret_count = live->rewritten_count;
    return live->slots.rewritten;
}

uint32_t pir_live_mesh_facet_slots(const pir_live_mesh *live) {
    return live->sizes.facets_p + live->sizes.facets_q + live->slots.used;
}

uint32_t pir_live_mesh_vertex_slots(const pir_live_mesh *live) {
    return live->vertices.used;
}

bool pir_live_mesh_pair(const pir_live_mesh *live, uint32_t slot, pir_sum_pair *ret_pair) {
    const pir_polytope *p = live->pairing->p, *q = live->pairing->q;
    uint32_t facets = live->sizes.facets_p + live->sizes.facets_q;
    if (slot < live->sizes.facets_p) {
        if (p->artificial || live->fv[slot] == PIR_NO_SLOT)
            return false;
        *ret_pair = (pir_sum_pair){PIR_FACET_FV, slot, live->fv[slot]};
        return true;
    }
    if (slot < facets) {
        uint32_t v = live->vf[slot - live->sizes.facets_p];
        if (q->artificial || v == PIR_NO_SLOT)
            return false;
        *ret_pair = (pir_sum_pair){PIR_FACET_VF, v, slot - live->sizes.facets_p};
        return true;
    }
    if (slot - facets >= live->slots.used || live->slots.edge[slot - facets] == PIR_NO_CROSSING)
        return false;
    // a segment's two edges are one to callers
    uint32_t e = live->slots.edge[slot - facets], h = live->slots.half[slot - facets];
    *ret_pair = (pir_sum_pair){PIR_FACET_EE, p->artificial ? 0 : e, q->artificial ? 0 : q->edge[h]};
    return true;
}

const uint32_t *pir_live_mesh_facet(const pir_live_mesh *live, uint32_t slot, uint32_t *ret_count) {
    const pir_polytope *p = live->pairing->p, *q = live->pairing->q;
    pir_sum_pair pair;
    *ret_count = 0;
    if (!pir_live_mesh_pair(live, slot, &pair))
        return live->slots.corner;
    if (slot < live->sizes.facets_p) {
        *ret_count = p->loop_start[slot + 1] - p->loop_start[slot];
        return live->slots.corner + p->loop_start[slot];
    }
    slot -= live->sizes.facets_p;
    if (slot < live->sizes.facets_q) {
        *ret_count = q->loop_start[slot + 1] - q->loop_start[slot];
        return live->slots.corner + p->half_count + q->loop_start[slot];
    }
    *ret_count = 4;
    return live->slots.corner + live->sizes.corners_fixed + 4 * (size_t)(slot - live->sizes.facets_q);
}

bool pir_live_mesh_vertex_pair(const pir_live_mesh *live, uint32_t slot, uint32_t ret_pair[2]) {
    if (slot >= live->vertices.used || live->vertices.uses[slot] == 0)
        return false;
    ret_pair[0] = live->vertices.pair[slot][0];
    ret_pair[1] = live->vertices.pair[slot][1];
    return true;
}

/* --- coordinates --- */

/* Rotates each vertex of P once. */
static void turn_vertices(pir_live_mesh *live) {
    const pir_mat3 *r = pir_live_matrix(live);
    for (uint32_t v = 0; v < live->sizes.vertices_p; v++)
        live->turned[v] = pir_mat_apply(r, live->pairing->p->vertex[v]);
}

void pir_live_mesh_vertices(pir_live_mesh *live, pir_vec3 *ret_vertices) {
    const pir_vec3 *q = live->pairing->q->vertex;
    turn_vertices(live);
    for (uint32_t i = 0; i < live->vertices.used; i++)
        ret_vertices[i] = pir_vec_add(live->turned[live->vertices.pair[i][0]], q[live->vertices.pair[i][1]]);
}

void pir_live_mesh_vertices_float(pir_live_mesh *live, float (*ret_vertices)[3]) {
    const pir_vec3 *q = live->pairing->q->vertex;
    turn_vertices(live);
    for (uint32_t i = 0; i < live->vertices.used; i++) {
        pir_vec3 x = pir_vec_add(live->turned[live->vertices.pair[i][0]], q[live->vertices.pair[i][1]]);
        ret_vertices[i][0] = (float)x.x;
        ret_vertices[i][1] = (float)x.y;
        ret_vertices[i][2] = (float)x.z;
    }
}

/* The plane through a point of the sum, given by the vertices that it is the sum of. */
static pir_plane_equation plane_through(const pir_live_mesh *live, pir_vec3 normal, uint32_t p, uint32_t q) {
    return (pir_plane_equation){normal, pir_vec_dot(normal, pir_vec_add(live->turned[p], live->pairing->q->vertex[q]))};
}

static pir_plane_equation plane_of_crossing(const pir_live_mesh *live, const pir_mat3 *r, uint32_t slot) {
    const pir_polytope *p = live->pairing->p, *q = live->pairing->q;
    uint32_t half = p->edge_half[live->slots.edge[slot]], h = live->slots.half[slot];
    pir_vec3 n = pir_vec_cross(q->direction[h], pir_mat_apply(r, p->direction[half]));
    double length = sqrt(pir_vec_dot(n, n));
    if (length == 0)
        return (pir_plane_equation){{0, 0, 0}, 0};
    return plane_through(live, pir_vec_scale(n, 1 / length), p->origin[half], q->origin[h]);
}

void pir_live_mesh_planes(pir_live_mesh *live, pir_plane_equation *ret_planes) {
    const pir_polytope *p = live->pairing->p, *q = live->pairing->q;
    const pir_mat3 *r = pir_live_matrix(live);
    const pir_plane_equation none = {{0, 0, 0}, 0};
    turn_vertices(live);
    for (uint32_t f = 0; f < live->sizes.facets_p; f++)
        *ret_planes++ = p->artificial || live->fv[f] == PIR_NO_SLOT
                            ? none
                            : plane_through(live, pir_mat_apply(r, p->normal[f]), p->origin[p->loop[p->loop_start[f]]],
                                            live->fv[f]);
    for (uint32_t g = 0; g < live->sizes.facets_q; g++)
        *ret_planes++ = q->artificial || live->vf[g] == PIR_NO_SLOT
                            ? none
                            : plane_through(live, q->normal[g], live->vf[g], q->origin[q->loop[q->loop_start[g]]]);
    for (uint32_t slot = 0; slot < live->slots.used; slot++)
        *ret_planes++ = live->slots.edge[slot] == PIR_NO_CROSSING ? none : plane_of_crossing(live, r, slot);
}
