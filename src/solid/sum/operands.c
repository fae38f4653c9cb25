/* SPDX-License-Identifier: MIT */
/*
 * See operands.h. The doubles of the space have room for a sum of points, each turned: √3 times as long and twice.
 * P's coordinates are integers times n_p/d_p, turned M·X times n_p/(d_p·|q|²); Q's are integers times n_q/d_q. With
 * L a common multiple of both denominators, both are integers over L; their common factors go into the scale, so that
 * the numbers are as short as they can be.
 */
#include "solid/sum/operands.h"

static void set_int(mpz_ptr to, const pir_int *a) {
    mpz_t view;
    mpz_set(to, mpz_roinit_n(view, a->limb, a->size));
}

/* The coordinates of a solid's points, turned where a rotation is given. */
static void copy_points(pir_operands *o, int k, const pir_solid *solid, const pir_rotation *rotation) {
    mpz_t v[3], m;
    mpz_inits(v[0], v[1], v[2], m, NULL);
    for (uint32_t i = 0; i < o->count[k]; i++) {
        const pir_int3 x = pir_vectors_at(&solid->points, i);
        mpz_t *to = o->coordinate[k] + 3 * (size_t)i;
        for (int r = 0; r < 3; r++)
            set_int(rotation ? v[r] : to[r], &x.c[r]);
        for (int r = 0; r < 3 && rotation; r++)
            for (int c = 0; c < 3; c++) {
                set_int(m, &rotation->integers->m[r][c]);
                mpz_addmul(to[r], m, v[c]);
            }
    }
    mpz_clears(v[0], v[1], v[2], m, NULL);
}

/* Brings both to the common scale. */
static void unify(pir_operands *o, const pir_solid *const solid[2], const pir_rotation *rotation, bool reflected) {
    mpz_t num[2], den[2], common;
    mpz_init(common);
    for (int k = 0; k < 2; k++) {
        mpz_inits(num[k], den[k], NULL);
        set_int(num[k], &solid[k]->scale.num);
        set_int(den[k], &solid[k]->scale.den);
    }
    set_int(common, &rotation->integers->norm);
    mpz_mul(den[0], den[0], common);
    mpz_lcm(o->den, den[0], den[1]);
    mpz_set_ui(common, 0);
    for (int k = 0; k < 2; k++) {
        mpz_divexact(den[k], o->den, den[k]);
        mpz_mul(num[k], num[k], den[k]);
        if (k == 0 && reflected)
            mpz_neg(num[k], num[k]);
        for (size_t i = 0; i < 3 * (size_t)o->count[k]; i++) {
            mpz_mul(o->coordinate[k][i], o->coordinate[k][i], num[k]);
            mpz_gcd(common, common, o->coordinate[k][i]);
        }
    }
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < 3 * (size_t)o->count[k]; i++)
            mpz_divexact(o->coordinate[k][i], o->coordinate[k][i], common);
    mpz_gcd(o->num, common, o->den);
    mpz_divexact(o->den, o->den, o->num);
    mpz_divexact(o->num, common, o->num);
    for (int k = 0; k < 2; k++)
        mpz_clears(num[k], den[k], NULL);
    mpz_clear(common);
}

static size_t longest(const pir_operands *o) {
    size_t bits = 1;
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < 3 * (size_t)o->count[k]; i++) {
            const size_t own = mpz_sizeinbase(o->coordinate[k][i], 2);
            bits = own > bits ? own : bits;
        }
    return bits;
}

static bool reverse(pir_operands *o, const pir_solid *p) {
    o->reversed_count = p->start[p->facet_count];
    o->reversed = PIR_NEW(&o->allocator, uint32_t, o->reversed_count);
    for (uint32_t f = 0; f < p->facet_count && o->reversed; f++)
        for (uint32_t i = p->start[f], end = p->start[f + 1]; i < end; i++)
            o->reversed[i] = p->corner[end - 1 - (i - p->start[f])];
    return o->reversed;
}

static pir_status make_body(pir_operands *o, int k, const pir_solid *solid, const uint32_t *corner) {
    const uint32_t numbers = pir_space_numbers(&o->space, 3 * o->count[k]);
    for (uint32_t i = 0; i < 3 * o->count[k] && o->space.status == PIR_OK; i++)
        mpz_set(o->space.number[numbers + i], o->coordinate[k][i]);
    const pir_shell_body_source source = {.name = "the solid",
                                          .unit = 1,
                                          .point_count = o->count[k],
                                          .facet_count = solid->facet_count,
                                          .start = solid->start,
                                          .corner = corner};
    return o->space.status == PIR_OK ? pir_shell_body_make(&o->body[k], &o->space, &source, numbers) : o->space.status;
}

pir_status pir_operands_init(pir_operands *operands, const pir_solid *const solid[2], pir_rotation *rotation,
                             bool reflected, const pir_solid_options *options) {
    pir_operands *o = operands;
    *o = (pir_operands){.allocator = *options->allocator};
    mpz_inits(o->num, o->den, NULL);
    for (int k = 0; k < 2; k++) {
        o->coordinate[k] = PIR_NEW(&o->allocator, mpz_t, 3 * (size_t)solid[k]->points.count);
        if (!o->coordinate[k])
            return PIR_ERR_MEMORY;
        o->count[k] = solid[k]->points.count;
        for (size_t i = 0; i < 3 * (size_t)o->count[k]; i++)
            mpz_init(o->coordinate[k][i]);
    }
    if (reflected && !reverse(o, solid[0]))
        return PIR_ERR_MEMORY;
    pir_rotation_make_exact(rotation);
    copy_points(o, 0, solid[0], rotation);
    copy_points(o, 1, solid[1], NULL);
    unify(o, solid, rotation, reflected);
    pir_space_init(&o->space, &o->allocator, options->memory, longest(o) + 2);
    o->has_space = true;
    const pir_status status = make_body(o, 0, solid[0], reflected ? o->reversed : solid[0]->corner);
    return status == PIR_OK ? make_body(o, 1, solid[1], solid[1]->corner) : status;
}

void pir_operands_finish(pir_operands *operands) {
    pir_operands *o = operands;
    if (!o->allocator.resize)
        return;
    for (int k = 0; k < 2; k++) {
        pir_shell_body_finish(&o->body[k]);
        for (size_t i = 0; i < 3 * (size_t)o->count[k]; i++)
            mpz_clear(o->coordinate[k][i]);
        PIR_FREE(&o->allocator, o->coordinate[k], 3 * (size_t)o->count[k]);
    }
    PIR_FREE(&o->allocator, o->reversed, o->reversed_count);
    if (o->has_space)
        pir_space_finish(&o->space);
    mpz_clears(o->num, o->den, NULL);
}
