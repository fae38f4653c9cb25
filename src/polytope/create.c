/* SPDX-License-Identifier: MIT */
/*
 * Polytopes from what callers have: doubles, rationals, another polytope.
 *
 * Every input becomes integers on one scale. Doubles are integers times the power of two of their lowest set bit;
 * rationals are integers over the least common multiple of their denominators.
 */
#include <math.h>
#include <string.h>

#include <pirouette/exact.h>

#include "base/vec.h"
#include "polytope/merge/merge.h"
#include "polytope/polytope.h"

/* The exponents of the lowest and above the highest set bit among all coordinates; false when all are zero. */
static bool exponent_range(const pir_vec3 *points, size_t count, int *ret_low, int *ret_top) {
    bool any = false;
    for (size_t i = 0; i < count; i++) {
        const double c[3] = {points[i].x, points[i].y, points[i].z};
        for (int k = 0; k < 3; k++) {
            if (c[k] == 0)
                continue;
            int top;
            uint64_t mantissa = (uint64_t)ldexp(frexp(fabs(c[k]), &top), 53);
            int low = top - 53;
            while ((mantissa & 1) == 0)
                mantissa >>= 1, low++;
            *ret_low = any && *ret_low < low ? *ret_low : low;
            *ret_top = any && *ret_top > top ? *ret_top : top;
            any = true;
        }
    }
    return any;
}

pir_polytope_options pir_polytope_options_default(void) {
    return (pir_polytope_options){NULL, 0};
}

pir_status pir_polytope_check_options(const pir_polytope_options *options) {
    if (options && !isfinite(options->merge_tolerance))
        return PIR_ERR_NOT_FINITE;
    return options && options->merge_tolerance < 0 ? PIR_ERR_ARGUMENT : PIR_OK;
}

/* What both ways to make a polytope ask of their arguments. */
static pir_status check_arguments(const void *points, size_t count, const pir_polytope_options *options,
                                  pir_polytope **ret_polytope) {
    if (!ret_polytope || (!points && count > 0))
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_polytope_check_options(options);
    if (status != PIR_OK)
        return status;
    if (count == 0)
        return PIR_ERR_EMPTY;
    return count >= (size_t)1 << 30 ? PIR_ERR_LIMIT : PIR_OK;
}

pir_status pir_polytope_merge_within(pir_polytope *hull, double tolerance, pir_polytope **ret_polytope) {
    pir_polytope *merged = NULL;
    pir_status status = tolerance > 0 && hull->dimension == 3 ? pir_polytope_merge(hull, tolerance, &merged) : PIR_OK;
    if (status != PIR_OK || merged)
        pir_polytope_release(hull);
    if (status == PIR_OK)
        *ret_polytope = merged ? merged : hull;
    return status;
}

/* The hull of exact points, its facets merged where `tolerance` is not 0. */
static pir_status build(const struct pir_exact_points *exact, const pir_vec3 *doubles, const pir_allocator *allocator,
                        double tolerance, pir_polytope **ret_polytope) {
    pir_polytope_parts parts = {.points = &exact->vectors, .scale = &exact->scale, .doubles = doubles};
    pir_polytope *hull = NULL;
    pir_status status = pir_polytope_build_hull(&parts, allocator, &hull);
    return status == PIR_OK ? pir_polytope_merge_within(hull, tolerance, ret_polytope) : status;
}

pir_status pir_exact_points_of_doubles(struct pir_exact_points *exact, const pir_vec3 *points, size_t count,
                                       const pir_allocator *allocator) {
    int low = 0, top = 0;
    exponent_range(points, count, &low, &top);
    *exact = (struct pir_exact_points){0};
    // the coordinates as integers in units of 2^low
    if (!pir_scale_init_power(&exact->scale, allocator, low) ||
        !pir_vectors_init(&exact->vectors, allocator, (uint32_t)count, pir_double_limbs(top, low))) {
        pir_exact_points_finish(exact, allocator);
        return PIR_ERR_MEMORY;
    }
    for (uint32_t i = 0; i < count; i++) {
        pir_int3 v = pir_vectors_at(&exact->vectors, i);
        pir_int_set_double(&v.c[0], points[i].x, low);
        pir_int_set_double(&v.c[1], points[i].y, low);
        pir_int_set_double(&v.c[2], points[i].z, low);
        pir_vectors_put(&exact->vectors, i, &v);
    }
    return PIR_OK;
}

void pir_exact_points_finish(struct pir_exact_points *exact, const pir_allocator *allocator) {
    pir_vectors_finish(&exact->vectors, allocator);
    pir_scale_finish(&exact->scale, allocator);
}

pir_status pir_polytope_create(const pir_vec3 *points, size_t count, const pir_polytope_options *options,
                               pir_polytope **ret_polytope) {
    pir_status status = check_arguments(points, count, options, ret_polytope);
    if (status != PIR_OK)
        return status;
    for (size_t i = 0; i < count; i++)
        if (!pir_vec_is_finite(points[i]))
            return PIR_ERR_NOT_FINITE;
    const pir_allocator used = pir_allocator_or_default(options ? options->allocator : NULL);
    struct pir_exact_points exact;
    status = pir_exact_points_of_doubles(&exact, points, count, &used);
    if (status != PIR_OK)
        return status;
    status = build(&exact, points, &used, options ? options->merge_tolerance : 0, ret_polytope);
    pir_exact_points_finish(&exact, &used);
    return status;
}

/* The integer of a GMP integer, borrowed. */
static pir_int view_of(mpz_srcptr z) {
    return (pir_int){(mp_limb_t *)mpz_limbs_read(z), mpz_sgn(z) * (int32_t)mpz_size(z), 0};
}

/* The least common denominator; PIR_ERR_LIMIT where it or a coordinate over it is too long. */
static pir_status find_common(mpz_t common, const mpq_t *coordinates, size_t count) {
    mpz_set_ui(common, 1);
    for (size_t i = 0; i < 3 * count; i++) {
        mpz_lcm(common, common, mpq_denref(coordinates[i]));
        if (mpz_sizeinbase(common, 2) > PIR_SCALE_BITS_MAX)
            return PIR_ERR_LIMIT;
    }
    // a product has as many bits as its factors together, at most
    for (size_t i = 0; i < 3 * count; i++)
        if (mpz_sizeinbase(mpq_numref(coordinates[i]), 2) + mpz_sizeinbase(common, 2) > PIR_COORDINATE_BITS_MAX)
            return PIR_ERR_LIMIT;
    return PIR_OK;
}

/* coordinates · common, as integers. */
static bool scale_rationals(pir_vectors *exact, const pir_allocator *allocator, const mpq_t *coordinates, size_t count,
                            const mpz_t common) {
    // a product has as many limbs as its factors together, at most
    size_t longest = 1;
    for (size_t i = 0; i < 3 * count; i++) {
        size_t limbs = mpz_size(mpq_numref(coordinates[i])) + mpz_size(common);
        longest = limbs > longest ? limbs : longest;
    }
    if (!pir_vectors_init(exact, allocator, (uint32_t)count, (uint32_t)longest))
        return false;
    mpz_t scaled;
    mpz_init(scaled);
    for (uint32_t i = 0; i < count; i++) {
        pir_int3 v = pir_vectors_at(exact, i);
        for (uint32_t k = 0; k < 3; k++) {
            mpq_srcptr c = coordinates[(size_t)i * 3 + k];
            mpz_divexact(scaled, common, mpq_denref(c));
            mpz_mul(scaled, scaled, mpq_numref(c));
            pir_int whole = view_of(scaled);
            pir_int_copy(&v.c[k], &whole);
        }
        pir_vectors_put(exact, i, &v);
    }
    mpz_clear(scaled);
    return true;
}

pir_status pir_exact_points_of_rationals(struct pir_exact_points *exact, const mpq_t *coordinates, size_t count,
                                         const pir_allocator *allocator) {
    mpz_t common;
    mpz_init(common);
    *exact = (struct pir_exact_points){0};
    pir_status status = find_common(common, coordinates, count);
    mp_limb_t one_limb = 1;
    const pir_scale scale = {{&one_limb, 1, 0}, view_of(common)};
    if (status == PIR_OK && !(pir_scale_copy(&exact->scale, allocator, &scale) &&
                              scale_rationals(&exact->vectors, allocator, coordinates, count, common))) {
        pir_exact_points_finish(exact, allocator);
        status = PIR_ERR_MEMORY;
    }
    mpz_clear(common);
    return status;
}

pir_status pir_polytope_create_exact(const mpq_t *coordinates, size_t count, const pir_polytope_options *options,
                                     pir_polytope **ret_polytope) {
    pir_status status = check_arguments(coordinates, count, options, ret_polytope);
    if (status != PIR_OK)
        return status;
    const pir_allocator used = pir_allocator_or_default(options ? options->allocator : NULL);
    struct pir_exact_points exact;
    status = pir_exact_points_of_rationals(&exact, coordinates, count, &used);
    if (status != PIR_OK)
        return status;
    status = build(&exact, NULL, &used, options ? options->merge_tolerance : 0, ret_polytope);
    pir_exact_points_finish(&exact, &used);
    return status;
}

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

pir_status pir_polytope_reflect(const pir_polytope *p, pir_polytope **ret_polytope) {
    if (!p || !ret_polytope)
        return PIR_ERR_ARGUMENT;
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
