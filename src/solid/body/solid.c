/* SPDX-License-Identifier: MIT */
/* Solids are checked in a space of their own, which is gone when they are made. */
#include "solid/body/solid.h"

#include <math.h>

#include <pirouette/exact.h>

#include "base/options.h"
#include "base/report.h"
#include "base/vec.h"
#include "solid/body/crossing.h"
#include "solid/body/shells.h"
#include "solid/space/exact.h"

pir_status pir_solid_options_take(const pir_solid_options *options, pir_report *const *report, pir_allocator *allocator,
                                  pir_solid_options *ret_used) {
    *ret_used = pir_solid_options_default();
    const pir_status status =
        pir_options_take("pir_solid_options", options, ret_used, report ? report : &ret_used->report);
    *allocator = pir_allocator_or_default(ret_used->allocator);
    ret_used->allocator = allocator;
    return status;
}

pir_solid *pir_solid_retain(pir_solid *solid) {
    atomic_fetch_add(&solid->references, 1);
    return solid;
}

void pir_solid_release(pir_solid *solid) {
    if (!solid || atomic_fetch_sub(&solid->references, 1) != 1)
        return;
    const pir_allocator allocator = solid->allocator, *a = &allocator;
    pir_vectors_finish(&solid->points, a);
    pir_scale_finish(&solid->scale, a);
    PIR_FREE(a, solid->corner, solid->corner_count);
    PIR_FREE(a, solid->start, (size_t)solid->facet_count + 1);
    mpq_clear(solid->volume);
    PIR_FREE(a, solid, 1);
}

void pir_solid_describe(const pir_solid *solid, pir_solid_info *ret_info) {
    *ret_info = solid->info;
}

pir_status pir_solid_volume_exact(const pir_solid *solid, mpq_t ret_volume) {
    if (!solid)
        return PIR_ERR_ARGUMENT;
    mpq_set(ret_volume, solid->volume);
    return PIR_OK;
}

/* --- the body of a solid --- */

/* The length 1 of a space with this shift, in units of the model. */
static double unit_of(const pir_scale *scale, int shift) {
    int top, bottom;
    const double num = pir_int_to_double(&scale->num, &top), den = pir_int_to_double(&scale->den, &bottom);
    return ldexp(num / den, top - bottom + shift);
}

pir_status pir_solid_body(const pir_solid *solid, pir_space *space, pir_shell_body *ret_body) {
    const uint32_t numbers = pir_space_numbers(space, 3 * solid->points.count);
    for (uint32_t i = 0; i < solid->points.count && space->status == PIR_OK; i++) {
        const pir_int3 v = pir_vectors_at(&solid->points, i);
        for (uint32_t k = 0; k < 3; k++) {
            mpz_t view;
            mpz_set(space->number[numbers + 3 * i + k], mpz_roinit_n(view, v.c[k].limb, v.c[k].size));
        }
    }
    const pir_shell_body_source source = {.name = "the solid",
                                          .unit = unit_of(&solid->scale, space->shift),
                                          .point_count = solid->points.count,
                                          .facet_count = solid->facet_count,
                                          .start = solid->start,
                                          .corner = solid->corner};
    return space->status == PIR_OK ? pir_shell_body_make(ret_body, space, &source, numbers) : space->status;
}

/* --- making --- */

static bool copy_points(pir_solid *solid, const pir_solid_parts *parts) {
    const pir_allocator *a = &solid->allocator;
    const pir_shell_body_source *source = &parts->source;
    const uint32_t points = parts->points->count, corners = source->start[source->facet_count];
    uint32_t *number = PIR_NEW(a, uint32_t, points), used = 0;
    solid->start = PIR_ZEROED(a, uint32_t, (size_t)solid->facet_count + 1);
    solid->corner_count = corners;
    solid->corner = PIR_NEW(a, uint32_t, corners);
    bool done = number && solid->start && solid->corner;
    for (uint32_t i = 0; i < points && done; i++)
        number[i] = PIR_SPACE_NONE;
    for (uint32_t i = 0; i < corners && done; i++)
        if (number[source->corner[i]] == PIR_SPACE_NONE)
            number[source->corner[i]] = used++;
    done = done && pir_vectors_init(&solid->points, a, used, parts->points->stride) &&
           pir_scale_copy(&solid->scale, a, parts->scale);
    for (uint32_t i = 0; i < points && done; i++) {
        const pir_int3 v = pir_vectors_at(parts->points, i);
        if (number[i] != PIR_SPACE_NONE)
            pir_vectors_set(&solid->points, number[i], &v);
    }
    for (uint32_t i = 0; i < corners && done; i++)
        solid->corner[i] = number[source->corner[i]];
    for (uint32_t f = 0; f <= solid->facet_count && done; f++)
        solid->start[f] = source->start[f];
    PIR_FREE(a, number, points);
    return done;
}

static void set_volume(pir_solid *solid, mpz_t six_volume) {
    mpz_t num, den;
    mpz_set(mpq_numref(solid->volume), six_volume);
    mpz_set_ui(mpq_denref(solid->volume), 6);
    for (int k = 0; k < 3; k++) {
        mpz_mul(mpq_numref(solid->volume), mpq_numref(solid->volume),
                mpz_roinit_n(num, solid->scale.num.limb, solid->scale.num.size));
        mpz_mul(mpq_denref(solid->volume), mpq_denref(solid->volume),
                mpz_roinit_n(den, solid->scale.den.limb, solid->scale.den.size));
    }
    mpq_canonicalize(solid->volume);
    mp_limb_t one_limb = 1;
    const pir_int one = {&one_limb, 1, 0};
    const pir_int top = pir_int_of_mpz(mpq_numref(solid->volume)), bottom = pir_int_of_mpz(mpq_denref(solid->volume));
    solid->info.volume = pir_scaled_nearest_double(&top, &one, &bottom);
}

static void set_bounds(pir_solid *solid) {
    pir_vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < solid->points.count; i++) {
        const pir_int3 v = pir_vectors_at(&solid->points, i);
        double x[3];
        for (int k = 0; k < 3; k++)
            x[k] = pir_scaled_nearest_double(&v.c[k], &solid->scale.num, &solid->scale.den);
        low = (pir_vec3){fmin(low.x, x[0]), fmin(low.y, x[1]), fmin(low.z, x[2])};
        high = (pir_vec3){fmax(high.x, x[0]), fmax(high.y, x[1]), fmax(high.z, x[2])};
    }
    solid->info.low = low;
    solid->info.high = high;
}

/* Checks all that makes the facets of `parts` a solid, in the numbers that `solid` has copied. */
static pir_status check(pir_solid *solid, const pir_solid_parts *parts, pir_space *space) {
    pir_shell_body body = {0};
    pir_shell_body_counts counts;
    mpz_t six;
    mpz_init(six);
    solid->info = (pir_solid_info){0};
    const uint32_t numbers = pir_space_numbers(space, 3 * solid->points.count);
    for (uint32_t i = 0; i < 3 * solid->points.count && space->status == PIR_OK; i++) {
        mpz_t view;
        const pir_int3 v = pir_vectors_at(&solid->points, i / 3);
        mpz_set(space->number[numbers + i], mpz_roinit_n(view, v.c[i % 3].limb, v.c[i % 3].size));
    }
    pir_shell_body_source source = parts->source;
    source.unit = unit_of(&solid->scale, space->shift);
    source.point_count = solid->points.count;
    source.corner = solid->corner;
    source.start = solid->start;
    pir_status status = space->status == PIR_OK ? pir_shell_body_make(&body, space, &source, numbers) : space->status;
    if (status == PIR_OK)
        status = pir_shell_body_check_crossing(&body);
    if (status == PIR_OK)
        status = pir_shell_body_check_shells(&body, &counts, six);
    if (status == PIR_OK) {
        solid->info = (pir_solid_info){.vertices = counts.vertices,
                                       .edges = counts.edges,
                                       .facets = counts.facets,
                                       .merged_vertices = counts.merged_vertices,
                                       .merged_edges = counts.merged_edges,
                                       .merged_facets = counts.merged_facets,
                                       .reflex_edges = counts.reflex_edges,
                                       .shells = counts.shells,
                                       .genus = counts.genus};
        set_volume(solid, six);
        set_bounds(solid);
    }
    pir_shell_body_finish(&body);
    mpz_clear(six);
    return status;
}

pir_status pir_solid_make(const pir_solid_parts *parts, const pir_solid_options *options, pir_solid **ret_solid) {
    const pir_shell_body_source *source = &parts->source;
    if (source->facet_count == 0)
        return pir_fail(source->report, PIR_ERR_EMPTY, "%s: there are no facets", source->name);
    pir_solid *solid = PIR_ZEROED(options->allocator, pir_solid, 1);
    if (!solid)
        return pir_fail(source->report, PIR_ERR_MEMORY, "%s: out of memory", source->name);
    atomic_init(&solid->references, 1);
    solid->allocator = *options->allocator;
    solid->facet_count = source->facet_count;
    mpq_init(solid->volume);
    pir_status status = PIR_OK;
    if (copy_points(solid, parts)) {
        pir_space space;
        pir_space_init(&space, &solid->allocator, options->memory, pir_vectors_bits(&solid->points) + 1);
        pir_space_begin_stage(&space, "checking the solid", 0);
        status = pir_space_outcome(&space, check(solid, parts, &space), source->name, source->report);
        pir_space_finish(&space);
    } else {
        status = pir_fail(source->report, PIR_ERR_MEMORY, "%s: out of memory", source->name);
    }
    if (status == PIR_OK) {
        *ret_solid = solid;
        return PIR_OK;
    }
    pir_solid_release(solid);
    return status;
}
