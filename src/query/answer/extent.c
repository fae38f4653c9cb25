/* SPDX-License-Identifier: MIT */
/*
 * The largest distance: from x to the farthest vertex of D. Every vertex of D is a corner of a piece of the pairing,
 * so the corners of pieces are compared, not all pairs of vertices.
 */
#include "query/answer/extent.h"
#include "query/depth/depth.h"

struct farthest {
    uint32_t a, b;
    double square;
};

static void look(const pir_query *query, pir_vec3 x, uint32_t a, uint32_t b, struct farthest *best) {
    pir_vec3 w = pir_vec_sub(pir_frame_vertex(&query->frame, a, b), x);
    double square = pir_vec_dot(w, w);
    if (square > best->square)
        *best = (struct farthest){a, b, square};
}

static struct farthest find_farthest(const pir_query *query, pir_vec3 x) {
    const pir_polytope *p = query->p, *q = query->q;
    const pir_pairing *pairing = pir_sum_pairing(query->sum);
    struct farthest best = {0, 0, -1};
    look(query, x, 0, 0, &best);
    for (uint32_t i = 0; i < p->half_count; i++)
        look(query, x, p->origin[i], pairing->fv[p->left[i]], &best);
    for (uint32_t i = 0; i < q->half_count; i++)
        look(query, x, pairing->vf[q->left[i]], q->origin[i], &best);
    for (uint32_t e = 0; e < p->edge_count; e++)
        for (uint32_t at = pir_crossing_first(pairing, e); at != PIR_NO_CROSSING; at = pir_crossing_next(pairing, at)) {
            uint32_t half = p->edge_half[e], h = pir_crossing_half(pairing, at);
            look(query, x, p->origin[half], q->origin[h], &best);
            look(query, x, p->origin[half], q->target[h], &best);
            look(query, x, p->target[half], q->origin[h], &best);
            look(query, x, p->target[half], q->target[h], &best);
        }
    return best;
}

pir_status pir_query_farthest(pir_query *query, const pir_placement *placement, const pir_query_input *input,
                              pir_query_result *ret_result) {
    struct farthest best = find_farthest(query, placement->x);
    double length = sqrt(best.square);
    pir_vec3 w = pir_vec_sub(placement->x, pir_frame_vertex(&query->frame, best.a, best.b));
    pir_query_result result = {
        .outcome = PIR_SEPARATED, .distance = pir_frame_length(&query->frame, length), .steps = 1};
    pir_piece separating;
    pir_least touching;
    result.state = pir_state_find(&query->search, placement, NULL, &separating, &touching, &result.steps);
    result.normal = length > 0 ? pir_vec_scale(w, 1 / length) : (pir_vec3){1, 0, 0};
    result.point_q = pir_frame_world(&query->frame, query->frame.q.vertex[best.b]);
    result.witness = (pir_witness){{PIR_FEATURE_VERTEX, best.a}, {PIR_FEATURE_VERTEX, best.b}};
    result.distance += input->radius_p + input->radius_q;
    if (!isfinite(result.distance))
        return PIR_ERR_LIMIT;
    result.point_q = pir_vec_add(result.point_q, pir_vec_scale(result.normal, -input->radius_q));
    result.point_p = pir_vec_add(result.point_q, pir_vec_scale(result.normal, result.distance));
    *ret_result = result;
    return PIR_OK;
}

pir_status pir_query_largest_distance(pir_query *query, const pir_query_input *input, pir_query_result *ret_result) {
    pir_placement placement;
    if (!ret_result)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_query_begin(query, input, &placement);
    return status == PIR_OK ? pir_query_farthest(query, &placement, input, ret_result) : status;
}
