/* SPDX-License-Identifier: MIT */
/*
 * The polytope −p: vertices negated, loops reversed, all features with the numbers that they had.
 *
 * It is made when it is first asked for, and kept by p, so that all sums with p that are differences share one. Two
 * threads that ask at once may both make it, and one of the two is kept. The reflection does not hold p: it makes one
 * of its own when it is asked, and no references go round.
 */
#include <string.h>

#include "base/vec.h"
#include "polytope/attachment.h"
#include "polytope/polytope.h"

/* The facets of `p` as loops of vertices, each turned the other way round. */
static bool reversed_loops(const pir_polytope *p, pir_loops *loops) {
    if (!pir_loops_init(loops, &p->allocator, p->facet_count, p->half_count))
        return false;
    for (uint32_t f = 0; f <= p->facet_count; f++)
        loops->start[f] = p->loop_start[f];
    for (uint32_t f = 0; f < p->facet_count; f++)
        for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++)
            loops->corner[p->loop_start[f] + p->loop_start[f + 1] - 1 - i] = p->origin[p->loop[i]];
    return true;
}

static pir_status make_reflection(const pir_polytope *p, pir_polytope **ret_polytope) {
    const pir_allocator *a = &p->allocator;
    pir_loops loops = {0};
    pir_vectors exact = {0};
    pir_vec3 *doubles = PIR_NEW(a, pir_vec3, p->vertex_count);
    uint32_t *vertices = PIR_NEW(a, uint32_t, p->vertex_count);
    pir_status status = PIR_ERR_MEMORY;
    if (doubles && vertices && reversed_loops(p, &loops) &&
        pir_vectors_init(&exact, a, p->vertex_count, p->exact_vertex.stride)) {
        for (uint32_t v = 0; v < p->vertex_count; v++) {
            pir_int3 x = pir_vertex_exact(p, v);
            for (int k = 0; k < 3; k++)
                pir_int_negate(&x.c[k]);
            pir_vectors_set(&exact, v, &x);
            doubles[v] = pir_vec_scale(p->vertex[v], -1);
            vertices[v] = v;
        }
        pir_polytope_parts parts = {&exact, &p->scale, doubles, p->dimension, vertices, p->vertex_count, &loops};
        pir_polytope *reflected;
        status = pir_polytope_build(&parts, a, &reflected);
        if (status == PIR_OK) {
            memcpy(reflected->source, p->source, p->vertex_count * sizeof *p->source);
            reflected->merge_bound = p->merge_bound;
            *ret_polytope = reflected;
        }
    }
    pir_vectors_finish(&exact, a);
    pir_loops_finish(&loops, a, p->half_count);
    PIR_FREE(a, vertices, p->vertex_count);
    PIR_FREE(a, doubles, p->vertex_count);
    return status;
}

/* The kind of the attachment by which a polytope keeps its reflection. */
static const char a_reflection;

struct kept_reflection {
    pir_attachment attachment;
    pir_polytope *polytope; /* held */
};

static void destroy_kept(pir_attachment *attachment, const pir_allocator *a) {
    struct kept_reflection *kept = (struct kept_reflection *)attachment;
    pir_polytope_release(kept->polytope);
    PIR_FREE(a, kept, 1);
}

pir_status pir_polytope_reflect(const pir_polytope *p, pir_polytope **ret_polytope) {
    if (!p || !ret_polytope)
        return PIR_ERR_ARGUMENT;
    pir_attachment *attachment = pir_polytope_attachment(p, &a_reflection, 0);
    if (!attachment) {
        struct kept_reflection *made = PIR_ZEROED(&p->allocator, struct kept_reflection, 1);
        if (!made)
            return PIR_ERR_MEMORY;
        made->attachment = (pir_attachment){.kind = &a_reflection, .destroy = destroy_kept};
        pir_status status = make_reflection(p, &made->polytope);
        if (status != PIR_OK) {
            PIR_FREE(&p->allocator, made, 1);
            return status;
        }
        // what is attached is no part of what p says
        attachment = pir_polytope_attach((pir_polytope *)p, &made->attachment);
    }
    *ret_polytope = pir_polytope_retain(((struct kept_reflection *)attachment)->polytope);
    return PIR_OK;
}
