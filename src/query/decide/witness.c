/* SPDX-License-Identifier: MIT */
/* Which features and which points attain an answer. */
#include "query/decide/touch.h"

static bool facet_has(const pir_polytope *p, uint32_t f, uint32_t v) {
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++)
        if (p->origin[p->loop[i]] == v)
            return true;
    return false;
}

/* The edge that a segment shows. Its second edge and its facets are hidden: all of them stand for its one edge. */
static pir_feature shown(const pir_polytope *p, pir_feature feature) {
    if (p->artificial && feature.kind != PIR_FEATURE_VERTEX)
        return (pir_feature){PIR_FEATURE_EDGE, 0};
    return feature;
}

pir_feature pir_feature_of(const pir_polytope *p, const uint32_t *vertices, uint32_t count) {
    // the distinct vertices
    uint32_t v[4] = {vertices[0]}, n = 1;
    for (uint32_t i = 1; i < count; i++) {
        bool is_new = true;
        for (uint32_t k = 0; k < n; k++)
            is_new &= v[k] != vertices[i];
        if (is_new)
            v[n++] = vertices[i];
    }
    if (n == 1)
        return (pir_feature){PIR_FEATURE_VERTEX, v[0]};
    if (n == 2)
        for (uint32_t h = p->ring_start[v[0]]; h < p->ring_start[v[0] + 1]; h++)
            if (p->target[h] == v[1])
                return shown(p, (pir_feature){PIR_FEATURE_EDGE, p->edge[h]});
    // most often an edge leads from the first vertex to another
    if (n == 3)
        for (uint32_t h = p->ring_start[v[0]]; h < p->ring_start[v[0] + 1]; h++)
            if (p->target[h] == v[1] || p->target[h] == v[2]) {
                uint32_t other = p->target[h] == v[1] ? v[2] : v[1], f = p->left[h], g = pir_right(p, h);
                bool left = facet_has(p, f, other);
                if (left || facet_has(p, g, other))
                    return shown(p, (pir_feature){PIR_FEATURE_FACET, left ? f : g});
                break;
            }
    for (uint32_t h = p->ring_start[v[0]]; h < p->ring_start[v[0] + 1]; h++) {
        bool all = true;
        for (uint32_t k = 1; k < n; k++)
            all = all && facet_has(p, p->left[h], v[k]);
        if (all)
            return shown(p, (pir_feature){PIR_FEATURE_FACET, p->left[h]});
    }
    // no facet holds all: rounding chose among nearly coplanar facets
    return (pir_feature){PIR_FEATURE_VERTEX, v[0]};
}

/* Of a polygon's two facets the one whose normal, turned, is along n; any other facet as it is. */
static uint32_t facing(const pir_polytope *p, const pir_mat3 *r, uint32_t facet, pir_vec3 n) {
    if (p->dimension != 2)
        return facet;
    pir_vec3 normal = r ? pir_mat_apply(r, p->normal[facet]) : p->normal[facet];
    return pir_vec_dot(normal, n) < 0 ? 1 - facet : facet;
}

bool pir_piece_of(const pir_frame *frame, pir_witness faces, uint32_t a, uint32_t b, pir_vec3 n, pir_piece *ret_piece) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    if (faces.p.kind == PIR_FEATURE_FACET) {
        *ret_piece = (pir_piece){PIR_FACET_FV, facing(p, &frame->r, faces.p.index, n), b};
        return true;
    }
    if (faces.q.kind == PIR_FEATURE_FACET) {
        *ret_piece = (pir_piece){PIR_FACET_VF, a, facing(q, NULL, faces.q.index, n)};
        return true;
    }
    if (faces.p.kind != PIR_FEATURE_EDGE || faces.q.kind != PIR_FEATURE_EDGE)
        return false;
    uint32_t half = q->edge_half[faces.q.index];
    pir_vec3 e = pir_mat_apply(&frame->r, p->direction[p->edge_half[faces.p.index]]);
    bool along = pir_vec_dot(pir_vec_cross(q->direction[half], e), n) > 0;
    *ret_piece = (pir_piece){PIR_FACET_EE, faces.p.index, along ? half : q->twin[half]};
    return true;
}

pir_vec3 pir_facet_point(const pir_frame *frame, const pir_placement *placement, const pir_facet *facet, double slack) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    if (facet->piece.kind == PIR_FACET_FV)
        return frame->q.vertex[facet->b];
    pir_vec3 y = pir_vec_add(placement->x, pir_vec_scale(facet->n, slack));
    if (facet->piece.kind == PIR_FACET_VF)
        return pir_vec_sub(y, pir_mat_apply(&frame->r, frame->p.vertex[facet->a]));
    // y = corner + λ e + μ d lies on the parallelogram of the two edges
    uint32_t half = p->edge_half[facet->piece.first], h = facet->piece.second;
    pir_vec3 from = frame->q.vertex[q->origin[h]], d = pir_vec_sub(frame->q.vertex[q->target[h]], from);
    pir_vec3 corner = pir_frame_vertex(frame, p->origin[half], q->origin[h]);
    pir_vec3 across = pir_vec_cross(pir_mat_apply(&frame->r, p->direction[half]), facet->n);
    double whole = pir_vec_dot(d, across);
    double part = whole != 0 ? pir_vec_dot(pir_vec_sub(y, corner), across) / whole : 0;
    return pir_vec_add(from, pir_vec_scale(d, fmin(1, fmax(0, part))));
}
