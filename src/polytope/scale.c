/* SPDX-License-Identifier: MIT */
/*
 * A polytope of another size. The integers stay, and so do all features and their numbers; the scale that turns
 * integers into coordinates is multiplied, exactly and in lowest terms.
 */
#include "polytope/scale.h"

#include <math.h>
#include <string.h>

#include <pirouette/exact.h>

#include "base/vec.h"
#include "polytope/exact_points.h"

static pir_int view_of(mpz_srcptr z) {
    return (pir_int){(mp_limb_t *)mpz_limbs_read(z), (int32_t)mpz_size(z), 0};
}

/* The facets of `p` as loops of vertices, none below dimension 2. */
static bool list_loops(const pir_polytope *p, pir_loops *loops) {
    uint32_t facets = p->dimension >= 2 ? p->facet_count : 0, corners = facets > 0 ? p->half_count : 0;
    if (!pir_loops_init(loops, &p->allocator, facets, corners))
        return false;
    for (uint32_t f = 0; f <= facets; f++)
        loops->start[f] = facets > 0 ? p->loop_start[f] : 0;
    for (uint32_t i = 0; i < corners; i++)
        loops->corner[i] = p->origin[p->loop[i]];
    return true;
}

static bool is_finite(const pir_polytope *p) {
    for (uint32_t v = 0; v < p->vertex_count; v++)
        if (!pir_vec_is_finite(p->vertex[v]))
            return false;
    return true;
}

/* to = the scale, in lowest terms. */
static void set_scale(mpq_t to, const pir_scale *scale) {
    mpz_t view;
    mpz_set(mpq_numref(to), mpz_roinit_n(view, scale->num.limb, scale->num.size));
    mpz_set(mpq_denref(to), mpz_roinit_n(view, scale->den.limb, scale->den.size));
    mpq_canonicalize(to);
}

/* The merge bound of `p` on another scale, rounded up. */
static double scaled_bound(const pir_polytope *p, const pir_scale *scale) {
    if (p->merge_bound == 0)
        return 0;
    mpq_t exact, factor;
    mpq_inits(exact, factor, NULL);
    mpq_set_d(exact, p->merge_bound);
    set_scale(factor, scale);
    mpq_mul(exact, exact, factor);
    set_scale(factor, &p->scale);
    mpq_div(exact, exact, factor);
    // mpq_get_d cuts off
    double bound = mpq_get_d(exact);
    mpq_set_d(factor, bound);
    if (mpq_cmp(factor, exact) < 0)
        bound = nextafter(bound, INFINITY);
    mpq_clears(exact, factor, NULL);
    return bound;
}

pir_status pir_polytope_rescale(const pir_polytope *p, const pir_scale *scale, pir_polytope **ret_polytope) {
    const pir_allocator *a = &p->allocator;
    pir_loops loops = {0};
    pir_polytope *scaled = NULL;
    uint32_t *vertices = PIR_NEW(a, uint32_t, p->vertex_count);
    pir_status status = PIR_ERR_MEMORY;
    if (vertices && list_loops(p, &loops)) {
        for (uint32_t v = 0; v < p->vertex_count; v++)
            vertices[v] = v;
        pir_polytope_parts parts = {.points = &p->exact_vertex,
                                    .scale = scale,
                                    .dimension = p->dimension,
                                    .vertices = vertices,
                                    .vertex_count = p->vertex_count,
                                    .facets = &loops};
        status = pir_polytope_build(&parts, a, &scaled);
    }
    if (status == PIR_OK && !is_finite(scaled)) {
        pir_polytope_release(scaled);
        status = PIR_ERR_LIMIT;
    }
    if (status == PIR_OK) {
        memcpy(scaled->source, p->source, p->vertex_count * sizeof *p->source);
        scaled->merge_bound = scaled_bound(p, scale);
        *ret_polytope = scaled;
    }
    pir_loops_finish(&loops, a, p->dimension >= 2 ? p->half_count : 0);
    PIR_FREE(a, vertices, p->vertex_count);
    return status;
}

pir_status pir_polytope_scale_exact(const pir_polytope *p, const mpq_t factor, pir_polytope **ret_polytope) {
    if (!p || !ret_polytope || mpq_sgn(factor) <= 0)
        return PIR_ERR_ARGUMENT;
    mpq_t product;
    mpq_init(product);
    set_scale(product, &p->scale);
    mpq_mul(product, product, factor);
    pir_status status = PIR_ERR_LIMIT;
    if (mpz_sizeinbase(mpq_numref(product), 2) <= PIR_SCALE_BITS_MAX &&
        mpz_sizeinbase(mpq_denref(product), 2) <= PIR_SCALE_BITS_MAX) {
        pir_scale scale = {view_of(mpq_numref(product)), view_of(mpq_denref(product))};
        status = pir_polytope_rescale(p, &scale, ret_polytope);
    }
    mpq_clear(product);
    return status;
}

pir_status pir_polytope_scale(const pir_polytope *p, double factor, pir_polytope **ret_polytope) {
    if (!isfinite(factor))
        return PIR_ERR_NOT_FINITE;
    if (!(factor > 0))
        return PIR_ERR_ARGUMENT;
    mpq_t exact;
    mpq_init(exact);
    mpq_set_d(exact, factor);
    pir_status status = pir_polytope_scale_exact(p, exact, ret_polytope);
    mpq_clear(exact);
    return status;
}
