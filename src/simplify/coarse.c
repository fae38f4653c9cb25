/* SPDX-License-Identifier: MIT */
/* Coarse bodies: inner polytopes of rising numbers of vertices, and the polytope itself at the end. */
#include "simplify/coarse.h"

#include "base/memory.h"
#include "base/vec.h"
#include "simplify/inner.h"

/* Vertices of the first coarse body, and by how many times each has more than the one before. */
#define FIRST 8
#define TIMES 4

/* By how much a length may be off here, of the polytope's size and place, many times over. */
#define OFF 0x1p-40

/* --- balls --- */

static double apart(pir_vec3 a, pir_vec3 b) {
    pir_vec3 d = pir_vec_sub(a, b);
    return sqrt(pir_vec_dot(d, d));
}

/* The radius of a ball about the centre in the polytope, or less than 0: of one that holds a vertex. */
static double radius_inside(const pir_polytope *polytope, pir_vec3 centre, double off) {
    double planes = HUGE_VAL, vertices = HUGE_VAL;
    for (uint32_t f = 0; polytope->dimension == 3 && f < polytope->facet_count; f++) {
        pir_vec3 on = polytope->vertex[polytope->origin[polytope->loop[polytope->loop_start[f]]]];
        planes = fmin(planes, pir_vec_dot(polytope->normal[f], pir_vec_sub(on, centre)));
    }
    for (uint32_t v = 0; v < polytope->vertex_count; v++)
        vertices = fmin(vertices, apart(polytope->vertex[v], centre));
    return polytope->dimension == 3 && planes > off ? planes - off : -(vertices + off);
}

static void make_balls(pir_polytope *polytope, pir_coarse *coarse) {
    pir_vec3 low, high;
    pir_polytope_bounds(polytope, &low, &high);
    coarse->centre = pir_vec_add(pir_vec_scale(low, 0.5), pir_vec_scale(high, 0.5));
    for (uint32_t v = 0; v < polytope->vertex_count; v++)
        coarse->around = fmax(coarse->around, apart(polytope->vertex[v], coarse->centre));
    double far = fmax(apart(low, (pir_vec3){0, 0, 0}), apart(high, (pir_vec3){0, 0, 0}));
    coarse->inside = radius_inside(polytope, coarse->centre, OFF * (far + coarse->around));
    coarse->around += OFF * (far + coarse->around);
}

/* --- the call --- */

static pir_status make(pir_measure *measure, pir_polytope *polytope, pir_coarse *coarse) {
    pir_status status = PIR_OK;
    for (uint64_t n = FIRST; status == PIR_OK && 2 * n <= polytope->vertex_count; n *= TIMES) {
        pir_coarse_body made;
        status = pir_simplify_inner(measure, polytope, (uint32_t)n, 0, &made.polytope, &made.error);
        if (status == PIR_OK)
            coarse->body[coarse->count++] = made;
    }
    coarse->body[coarse->count++] = (pir_coarse_body){pir_polytope_retain(polytope), 0};
    make_balls(polytope, coarse);
    return status;
}

pir_status pir_coarse_create(pir_polytope *polytope, pir_coarse **ret_coarse) {
    if (!polytope || !ret_coarse)
        return PIR_ERR_ARGUMENT;
    pir_measure measure;
    pir_coarse *coarse = PIR_ZEROED(&polytope->allocator, pir_coarse, 1);
    if (!coarse)
        return PIR_ERR_MEMORY;
    atomic_init(&coarse->references, 1);
    pir_status status = pir_measure_init(&measure, &polytope->allocator);
    if (status != PIR_OK) {
        PIR_FREE(&polytope->allocator, coarse, 1);
        return status;
    }
    status = make(&measure, polytope, coarse);
    pir_measure_finish(&measure);
    if (status == PIR_OK)
        *ret_coarse = coarse;
    else
        pir_coarse_release(coarse);
    return status;
}

pir_coarse *pir_coarse_retain(pir_coarse *coarse) {
    if (coarse)
        atomic_fetch_add_explicit(&coarse->references, 1, memory_order_relaxed);
    return coarse;
}

void pir_coarse_release(pir_coarse *coarse) {
    if (!coarse || atomic_fetch_sub_explicit(&coarse->references, 1, memory_order_acq_rel) != 1)
        return;
    const pir_allocator allocator = coarse->body[coarse->count - 1].polytope->allocator;
    for (uint32_t i = 0; i < coarse->count; i++)
        pir_polytope_release(coarse->body[i].polytope);
    PIR_FREE(&allocator, coarse, 1);
}

uint32_t pir_coarse_count(const pir_coarse *coarse) {
    return coarse->count;
}

pir_coarse_body pir_coarse_get(const pir_coarse *coarse, uint32_t index) {
    return coarse->body[index];
}
