/* SPDX-License-Identifier: MIT */
/*
 * A plane in integers. With a vertex V·num/den, a normal N·2^a of integers N and an offset C·2^b, the sign of
 *
 *     normal·x − offset    is that of    2^a·num·(N·V) − 2^b·den·C,
 *
 * and the lower of both powers of two is left out. Heights are linear, so the plane cuts the edge from A to B, of the
 * heights h and k, at (k·A − h·B) / (k − h).
 */
#include "polytope/section/cut.h"

#include <math.h>

static void init_all(struct pir_cut *cut) {
    mpz_inits(cut->normal[0], cut->normal[1], cut->normal[2], cut->offset, cut->height[0], cut->height[1], cut->part,
              cut->divisor, NULL);
}

void pir_cut_finish(struct pir_cut *cut) {
    mpz_clears(cut->normal[0], cut->normal[1], cut->normal[2], cut->offset, cut->height[0], cut->height[1], cut->part,
               cut->divisor, NULL);
}

/* The exponent of the last of x's 53 bits. */
static int exponent_of(double x) {
    int exponent;
    frexp(x, &exponent);
    return exponent - 53;
}

/* to = x / 2^exponent, which is an integer. */
static void set_double(mpz_t to, double x, int exponent) {
    int own;
    mpz_set_d(to, ldexp(frexp(x, &own), 53));
    own -= 53;
    if (own > exponent)
        mpz_mul_2exp(to, to, (mp_bitcnt_t)(own - exponent));
}

static void view(mpz_t to, const pir_int *a) {
    mpz_roinit_n(to, a->limb, a->size);
}

void pir_cut_init(struct pir_cut *cut, const pir_mesh *mesh, pir_vec3 normal, double offset) {
    const double n[3] = {normal.x, normal.y, normal.z};
    cut->mesh = mesh;
    init_all(cut);
    int low = offset != 0 ? exponent_of(offset) : 1024;
    for (int k = 0; k < 3; k++)
        if (n[k] != 0 && exponent_of(n[k]) < low)
            low = exponent_of(n[k]);
    mpz_t factor;
    view(factor, &mesh->scale.num);
    for (int k = 0; k < 3; k++) {
        set_double(cut->normal[k], n[k], low);
        mpz_mul(cut->normal[k], cut->normal[k], factor);
    }
    view(factor, &mesh->scale.den);
    set_double(cut->offset, offset, low);
    mpz_mul(cut->offset, cut->offset, factor);
}

/* The height of a vertex over the plane. */
static void set_height(struct pir_cut *cut, mpz_t height, uint32_t vertex) {
    pir_int3 v = pir_vectors_at(&cut->mesh->where, vertex);
    mpz_t c;
    mpz_neg(height, cut->offset);
    for (int k = 0; k < 3; k++) {
        view(c, &v.c[k]);
        mpz_addmul(height, cut->normal[k], c);
    }
}

int pir_cut_side(struct pir_cut *cut, uint32_t vertex) {
    set_height(cut, cut->height[0], vertex);
    return mpz_sgn(cut->height[0]);
}

/* to = component k of b − a. */
static void set_difference(mpz_t to, const pir_int3 *a, const pir_int3 *b, int k) {
    mpz_t from, less;
    view(from, &b->c[k]);
    view(less, &a->c[k]);
    mpz_sub(to, from, less);
}

int pir_cut_turn(struct pir_cut *cut, const uint32_t corners[3]) {
    const pir_vectors *where = &cut->mesh->where;
    pir_int3 a = pir_vectors_at(where, corners[0]), b = pir_vectors_at(where, corners[1]),
             c = pir_vectors_at(where, corners[2]);
    mpz_set_ui(cut->height[0], 0);
    // normal · ((b − a) × (c − a)): each component of the cross product is two products
    for (int k = 0; k < 3; k++)
        for (int way = 0; way < 2; way++) {
            int i = (k + 1 + way) % 3, j = (k + 2 - way) % 3;
            set_difference(cut->height[1], &a, &b, i);
            set_difference(cut->part, &a, &c, j);
            mpz_mul(cut->part, cut->part, cut->height[1]);
            if (way)
                mpz_submul(cut->height[0], cut->normal[k], cut->part);
            else
                mpz_addmul(cut->height[0], cut->normal[k], cut->part);
        }
    return mpz_sgn(cut->height[0]);
}

void pir_cut_point(struct pir_cut *cut, const uint32_t edge[2], mpz_t ret_over[3], mpz_t ret_under) {
    const pir_scale *scale = &cut->mesh->scale;
    pir_int3 a = pir_vectors_at(&cut->mesh->where, edge[0]), b = pir_vectors_at(&cut->mesh->where, edge[1]);
    mpz_t c, num, den;
    view(num, &scale->num);
    view(den, &scale->den);
    if (edge[0] == edge[1]) {
        mpz_set_ui(cut->height[0], 0);
        mpz_set_ui(cut->height[1], 1);
    } else {
        set_height(cut, cut->height[0], edge[0]);
        set_height(cut, cut->height[1], edge[1]);
    }
    mpz_sub(ret_under, cut->height[1], cut->height[0]);
    int sign = mpz_sgn(ret_under);
    mpz_mul(ret_under, ret_under, den);
    mpz_abs(ret_under, ret_under);
    for (int k = 0; k < 3; k++) {
        view(c, &a.c[k]);
        mpz_mul(ret_over[k], cut->height[1], c);
        view(c, &b.c[k]);
        mpz_submul(ret_over[k], cut->height[0], c);
        mpz_mul(ret_over[k], ret_over[k], num);
        if (sign < 0)
            mpz_neg(ret_over[k], ret_over[k]);
    }
}
