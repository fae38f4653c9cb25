/* SPDX-License-Identifier: MIT */
/* All pairs of triangles within a distance. */
#include "mesh/pair/pair_descent.h"
#include "mesh/signs/heap_sort.h"

struct within {
    pir_trimesh_pair *pair;
    double distance;
    pir_triangle_pair *pairs;
    size_t capacity, count;
};

pir_within_input pir_within_input_default(void) {
    return (pir_within_input){pir_pose_identity(), pir_pose_identity(), 0};
}

/* Whether two triangles are within the distance, exactly: distance² · den ≥ num. */
static bool is_within_exactly(struct within *w, uint32_t p, uint32_t q) {
    pir_mesh_frame *frame = &w->pair->frame;
    pir_exact_square *square = &w->pair->best.other;
    w->pair->counts.exact++;
    pir_mesh_frame_square(frame, p, q, square);
    uint32_t used = frame->limbs.used;
    pir_int length = pir_mesh_frame_exact_length(frame, w->distance);
    pir_int allowed = pir_num_mul(&frame->limbs, &length, &length);
    pir_int most = pir_num_mul(&frame->limbs, &allowed, &square->den);
    int order = pir_num_compare(&frame->limbs, &square->num, &most);
    frame->limbs.used = used;
    return order <= 0;
}

static void consider(void *context, uint32_t p, uint32_t q, const pir_corners *const corners[2]) {
    struct within *w = context;
    pir_span span = pir_triangle_span(corners[0], corners[1], w->pair->frame.error);
    w->pair->counts.triangles++;
    if (span.low > w->distance || (span.high > w->distance && !is_within_exactly(w, p, q)))
        return;
    if (w->count++ < w->capacity)
        w->pairs[w->count - 1] = (pir_triangle_pair){p, q};
}

static void look(void *context, const uint32_t leaf[2], pir_vec3 n) {
    struct within *w = context;
    pir_leaf_pair_visit(&w->pair->frame, leaf, n, w->distance, consider, w);
}

static int compare(const void *a, const void *b) {
    const pir_triangle_pair *x = a, *y = b;
    if (x->p != y->p)
        return x->p < y->p ? -1 : 1;
    return x->q < y->q ? -1 : x->q > y->q;
}

pir_status pir_trimesh_pair_within(pir_trimesh_pair *pair, const pir_within_input *input, size_t capacity,
                                   pir_triangle_pair *ret_pairs, size_t *ret_count) {
    if (!pair || !input || !ret_count || (!ret_pairs && capacity > 0) || input->distance < 0)
        return PIR_ERR_ARGUMENT;
    if (isnan(input->distance))
        return PIR_ERR_NOT_FINITE;
    // what is farther than any two meshes can be is as good as that, and an exact number stays short
    double distance = input->distance < 0x1p63 ? input->distance : 0x1p63;
    pir_status status = pir_trimesh_pair_place(pair, input->pose_p, input->pose_q, distance);
    if (status != PIR_OK)
        return status;
    struct within w = {pair, distance, ret_pairs, capacity, 0};
    pir_pair_descend(pair, &(pir_pair_descent){distance, NULL, look, &w});
    pir_heap_sort(ret_pairs, w.count < capacity ? w.count : capacity, sizeof *ret_pairs, compare);
    *ret_count = w.count;
    return PIR_OK;
}
