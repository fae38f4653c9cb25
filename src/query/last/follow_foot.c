/* SPDX-License-Identifier: MIT */
/* From facet to facet after the foot of x: see follow_foot.h. */
#include "query/last/same_facet_versions.h"

/*
 * The edge of a vertex's ring through which the straight way from n to m leaves the vertex's cell; UINT32_MAX where m
 * is in that. n is in it, or on its rim.
 */
static uint32_t leave_cell(const pir_body *body, uint32_t vertex, pir_vec3 n, pir_vec3 m) {
    const pir_polytope *p = body->polytope;
    uint32_t first = UINT32_MAX, end = p->ring_start[vertex + 1];
    double least = HUGE_VAL;
    for (uint32_t h = p->ring_start[vertex]; h < end; h++) {
        double from = pir_vec_dot(p->direction[h], n), to = pir_vec_dot(p->direction[h], m), part = from / (from - to);
        bool leaves = (to > 0) & (part < least);
        first = leaves ? h : first;
        least = leaves ? part : least;
    }
    return first;
}

/* The side of a facet that a point is farthest beyond, by its place in the loops. */
static uint32_t farthest_beyond(const pir_body *body, uint32_t facet, pir_vec3 at) {
    const pir_polytope *p = body->polytope;
    uint32_t side = p->loop_start[facet];
    double least = HUGE_VAL;
    for (uint32_t i = side; i < p->loop_start[facet + 1]; i++) {
        uint32_t half = p->loop[i];
        pir_vec3 in = pir_vec_cross(p->normal[facet], p->direction[half]);
        double within = pir_vec_dot(in, pir_vec_sub(at, body->vertex[p->origin[half]]));
        side = within < least ? i : side;
        least = within < least ? within : least;
    }
    return side;
}

#define FOOT_TARGET
#define FOOT_PROVE pir_same_facet_prove
#include "query/last/follow_foot_body.h"

pir_same pir_follow_foot(const pir_frame *frame, const pir_placement *placement, pir_same is, pir_same_facet *same) {
    // the arcs of a polygon are half circles, and the straight way between their ends is none
    if (frame->p.polytope->dimension < 3 || frame->q.polytope->dimension < 3)
        return is;
    return follow(frame, placement, is, same);
}

pir_foot_follower *pir_follow_foot_version(unsigned index) {
    if (index == 0)
        return pir_follow_foot;
#if PIR_HAVE_X86_SAME
    if (index == 1 && __builtin_cpu_supports("avx2"))
        return pir_follow_foot_avx2;
#endif
    return NULL;
}

pir_foot_follower *pir_follow_foot_best(void) {
    unsigned index = 0;
    while (pir_follow_foot_version(index + 1))
        index++;
    return pir_follow_foot_version(index);
}
