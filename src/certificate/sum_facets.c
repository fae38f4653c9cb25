/* SPDX-License-Identifier: MIT */
/*
 * Facets of a sum as its mesh has them, their planes from the integers of the bodies. A plane is n·x = h with n the
 * cross product of two edges; a facet's first three corners are no line, for meshes have no straight corners.
 */
#include "certificate/sum_facets.h"

pir_status pir_boundary_make(pir_boundary *boundary, const pir_stance *bodies, pir_sum *sum) {
    *boundary = (pir_boundary){.bodies = bodies};
    return pir_sum_mesh(sum, PIR_DOUBLE, &boundary->mesh);
}

void pir_boundary_finish(pir_boundary *boundary) {
    pir_mesh_destroy(boundary->mesh);
}

pir_vertex_pair pir_boundary_corner(const pir_boundary *boundary, uint32_t vertex) {
    uint32_t pair[2];
    pir_mesh_pair(boundary->mesh, vertex, pair);
    return (pir_vertex_pair){pair[0], pair[1]};
}

void pir_boundary_list(const pir_boundary *boundary, pir_stance *bodies) {
    uint32_t count = pir_mesh_vertex_count(boundary->mesh);
    for (uint32_t i = 0; i < count; i++)
        pir_stance_list(bodies, pir_boundary_corner(boundary, i));
}

/* Vertex `vertex` of the mesh, in units. */
static void vertex_at(const pir_boundary *boundary, uint32_t vertex, pir_triple *to) {
    pir_stance_vertex(boundary->bodies, pir_boundary_corner(boundary, vertex), to);
}

/* to = (b − a) × (c − a). */
static void plane_of(const pir_triple *a, const pir_triple *b, const pir_triple *c, pir_triple *to) {
    pir_triple e, f;
    pir_triple_init(&e);
    pir_triple_init(&f);
    pir_triple_subtract(&e, b, a);
    pir_triple_subtract(&f, c, a);
    pir_triple_cross(to, &e, &f);
    pir_triple_finish(&e);
    pir_triple_finish(&f);
}

void pir_boundary_normal(const pir_boundary *boundary, uint32_t facet, pir_triple *normal) {
    uint32_t count;
    const uint32_t *corner = pir_mesh_facet(boundary->mesh, facet, &count);
    pir_triple v[3];
    for (int k = 0; k < 3; k++) {
        pir_triple_init(&v[k]);
        vertex_at(boundary, corner[k], &v[k]);
    }
    plane_of(&v[0], &v[1], &v[2], normal);
    pir_triple_strip(normal);
    for (int k = 0; k < 3; k++)
        pir_triple_finish(&v[k]);
}

/* The normal n of a facet and its h. */
static void plane_at(const pir_boundary *boundary, uint32_t facet, pir_triple *normal, mpz_t h) {
    uint32_t count;
    const uint32_t *corner = pir_mesh_facet(boundary->mesh, facet, &count);
    pir_triple v;
    pir_triple_init(&v);
    pir_boundary_normal(boundary, facet, normal);
    vertex_at(boundary, corner[0], &v);
    pir_triple_dot(h, normal, &v);
    pir_triple_finish(&v);
}

uint32_t pir_boundary_least(const pir_boundary *boundary, mpz_t ret_slack, pir_triple *ret_normal) {
    uint32_t facets = pir_mesh_facet_count(boundary->mesh), least = 0;
    pir_triple normal;
    mpz_t h, square, least_square, here, best;
    pir_triple_init(&normal);
    mpz_inits(h, square, least_square, here, best, NULL);
    for (uint32_t f = 0; f < facets; f++) {
        plane_at(boundary, f, &normal, h);
        pir_triple_dot(square, &normal, &normal);
        // h² / |n|² against the least one's
        mpz_mul(here, h, h);
        mpz_mul(here, here, least_square);
        mpz_mul(best, ret_slack, ret_slack);
        mpz_mul(best, best, square);
        if (f > 0 && mpz_cmp(here, best) >= 0)
            continue;
        least = f;
        mpz_swap(ret_slack, h);
        mpz_swap(least_square, square);
        for (int k = 0; k < 3; k++)
            mpz_swap(ret_normal->c[k], normal.c[k]);
    }
    mpz_clears(h, square, least_square, here, best, NULL);
    pir_triple_finish(&normal);
    return least;
}

/* --- the origin among corners --- */

/* Vertices of the mesh that do not lie in one plane: the first two, and the first ones off their line and plane. */
static void four_apart(const pir_boundary *boundary, uint32_t ret[4]) {
    pir_triple v[4], n;
    mpz_t size;
    uint32_t found = 2, count = pir_mesh_vertex_count(boundary->mesh);
    for (int k = 0; k < 4; k++)
        pir_triple_init(&v[k]);
    pir_triple_init(&n);
    mpz_init(size);
    ret[0] = ret[2] = ret[3] = 0;
    ret[1] = 1;
    vertex_at(boundary, 0, &v[0]);
    vertex_at(boundary, 1, &v[1]);
    for (uint32_t i = 2; i < count && found < 4; i++) {
        vertex_at(boundary, i, &v[found]);
        if (found == 2) {
            plane_of(&v[0], &v[1], &v[2], &n);
            pir_triple_dot(size, &n, &n);
        } else {
            pir_triple_subtract(&v[3], &v[3], &v[0]);
            pir_triple_dot(size, &n, &v[3]);
        }
        if (mpz_sgn(size) != 0)
            ret[found++] = i;
    }
    for (int k = 0; k < 4; k++)
        pir_triple_finish(&v[k]);
    pir_triple_finish(&n);
    mpz_clear(size);
}

/* A line from a point c through the origin: it leaves at −c·num/den, by a facet of the normal n. */
struct exit_line {
    pir_triple c, n;
    mpz_t num, den;
    uint32_t facet;
};

/* Finds where it leaves: the least h / −(n·c) of all facets that it runs out by. */
static void find_exit(const pir_boundary *boundary, struct exit_line *line) {
    uint32_t facets = pir_mesh_facet_count(boundary->mesh);
    pir_triple normal;
    mpz_t h, rate, here, best;
    pir_triple_init(&normal);
    mpz_inits(h, rate, here, best, NULL);
    for (uint32_t f = 0; f < facets; f++) {
        plane_at(boundary, f, &normal, h);
        pir_triple_dot(rate, &normal, &line->c);
        mpz_neg(rate, rate);
        if (mpz_sgn(rate) <= 0)
            continue;
        mpz_mul(here, h, line->den);
        mpz_mul(best, line->num, rate);
        if (mpz_sgn(line->den) != 0 && mpz_cmp(here, best) >= 0)
            continue;
        line->facet = f;
        mpz_swap(line->num, h);
        mpz_swap(line->den, rate);
        for (int k = 0; k < 3; k++)
            mpz_swap(line->n.c[k], normal.c[k]);
    }
    mpz_clears(h, rate, here, best, NULL);
    pir_triple_finish(&normal);
}

/*
 * The weight of a triangle's third corner for the point y/den: n·((b − a) × (y/den − a)), times den.
 */
static void area(const struct exit_line *line, const pir_triple *y, const pir_triple *a, const pir_triple *b,
                 mpz_t to) {
    pir_triple e, f, x;
    pir_triple_init(&e);
    pir_triple_init(&f);
    pir_triple_init(&x);
    pir_triple_subtract(&e, b, a);
    for (int k = 0; k < 3; k++) {
        mpz_set(f.c[k], y->c[k]);
        mpz_submul(f.c[k], line->den, a->c[k]);
    }
    pir_triple_cross(&x, &e, &f);
    pir_triple_dot(to, &line->n, &x);
    pir_triple_finish(&e);
    pir_triple_finish(&f);
    pir_triple_finish(&x);
}

/* Adds the corners of the triangle of the facet that holds the exit, with their weights. */
static void add_exit(const pir_boundary *boundary, const struct exit_line *line, pir_mix *mix) {
    uint32_t count;
    const uint32_t *corner = pir_mesh_facet(boundary->mesh, line->facet, &count);
    pir_triple v[3], y;
    mpz_t weight[3];
    for (int k = 0; k < 3; k++) {
        pir_triple_init(&v[k]);
        mpz_init(weight[k]);
    }
    pir_triple_init(&y);
    for (int k = 0; k < 3; k++) {
        mpz_mul(y.c[k], line->c.c[k], line->num);
        mpz_neg(y.c[k], y.c[k]);
    }
    vertex_at(boundary, corner[0], &v[0]);
    for (uint32_t i = 2; i < count; i++) {
        vertex_at(boundary, corner[i - 1], &v[1]);
        vertex_at(boundary, corner[i], &v[2]);
        for (int k = 0; k < 3; k++)
            area(line, &y, &v[(k + 1) % 3], &v[(k + 2) % 3], weight[k]);
        if (mpz_sgn(weight[0]) < 0 || mpz_sgn(weight[1]) < 0 || mpz_sgn(weight[2]) < 0)
            continue;
        const uint32_t of[3] = {corner[0], corner[i - 1], corner[i]};
        for (int k = 0; k < 3; k++)
            if (mpz_sgn(weight[k]) > 0) {
                mpz_set(mix->weight[mix->count], weight[k]);
                mix->corner[mix->count++] = pir_boundary_corner(boundary, of[k]);
            }
        break;
    }
    for (int k = 0; k < 3; k++) {
        pir_triple_finish(&v[k]);
        mpz_clear(weight[k]);
    }
    pir_triple_finish(&y);
}

/*
 * With c the sum of four corners and the exit y = −c·num/den in a triangle of weights w_k, W in all,
 * 0 = (num/den)·c + y: each of the four weighs num·W, each of the triangle's den·w_k.
 */
void pir_boundary_around(const pir_boundary *boundary, pir_mix *mix) {
    struct exit_line line;
    uint32_t four[4];
    pir_triple v;
    mpz_t whole;
    pir_triple_init(&line.c);
    pir_triple_init(&line.n);
    pir_triple_init(&v);
    mpz_inits(line.num, line.den, whole, NULL);
    four_apart(boundary, four);
    mix->count = 4;
    for (int k = 0; k < 4; k++) {
        mix->corner[k] = pir_boundary_corner(boundary, four[k]);
        mpz_set_ui(mix->weight[k], 1);
        vertex_at(boundary, four[k], &v);
        for (int i = 0; i < 3; i++)
            mpz_add(line.c.c[i], line.c.c[i], v.c[i]);
    }
    find_exit(boundary, &line);
    if (mpz_sgn(line.den) != 0) { // else the origin is their middle
        add_exit(boundary, &line, mix);
        for (int k = 4; k < mix->count; k++) {
            mpz_add(whole, whole, mix->weight[k]);
            mpz_mul(mix->weight[k], mix->weight[k], line.den);
        }
        for (int k = 0; k < 4; k++)
            mpz_mul(mix->weight[k], whole, line.num);
    }
    pir_mix_reduce(mix, boundary->bodies);
    mpz_clears(line.num, line.den, whole, NULL);
    pir_triple_finish(&line.c);
    pir_triple_finish(&line.n);
    pir_triple_finish(&v);
}
