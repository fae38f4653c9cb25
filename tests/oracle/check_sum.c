/* SPDX-License-Identifier: MIT */
/* See check_sum.h: the proof by local convexity and supporting planes. */
#include "oracle/check_sum.h"

#include <math.h>
#include <stdlib.h>

#include <pirouette/exact.h>

/* What the steps of the proof share; all points over one denominator. */
struct proof {
    const pir_mesh *mesh;
    oracle_points v;
    const oracle_points *p, *q;
    oracle_vec *normal; /* per facet */
    mpz_t a, b;
    oracle_vec s, t, u;
};

/* u = the normal of corners i, j, k, counter-clockwise. */
static void normal_of(struct proof *proof, oracle_vec r, uint32_t i, uint32_t j, uint32_t k) {
    oracle_sub(proof->s, proof->v.at[j], proof->v.at[i]);
    oracle_sub(proof->t, proof->v.at[k], proof->v.at[i]);
    oracle_cross(r, proof->s, proof->t);
}

/* The sign of n·(x − o). */
static int side(struct proof *proof, oracle_vec n, uint32_t o, uint32_t x) {
    oracle_sub(proof->s, proof->v.at[x], proof->v.at[o]);
    oracle_dot(proof->a, n, proof->s);
    return mpz_sgn(proof->a);
}

static const char *check_vertices(struct proof *proof) {
    for (uint32_t i = 0; i < proof->v.count; i++) {
        uint32_t pair[2];
        pir_mesh_pair(proof->mesh, i, pair);
        if (pair[0] >= proof->p->count || pair[1] >= proof->q->count)
            return "a vertex's pair is out of range";
        for (int k = 0; k < 3; k++) {
            mpz_add(proof->a, proof->p->at[pair[0]][k], proof->q->at[pair[1]][k]);
            if (mpz_cmp(proof->a, proof->v.at[i][k]) != 0)
                return "a vertex is not the sum of its pair";
        }
    }
    return NULL;
}

/* Strict convexity of facet f: from each side all other corners lie strictly to the left. */
static const char *check_facet(struct proof *proof, uint32_t f) {
    uint32_t count;
    const uint32_t *corner = pir_mesh_facet(proof->mesh, f, &count);
    if (count < 3)
        return "a facet has fewer than three corners";
    normal_of(proof, proof->normal[f], corner[0], corner[1], corner[2]);
    if (oracle_is_zero(proof->normal[f]))
        return "a facet has a straight corner";
    for (uint32_t i = 0; i < count; i++) {
        if (corner[i] >= proof->v.count || (i > 0 && corner[i] <= corner[0]))
            return "a facet does not start at its smallest vertex";
        if (side(proof, proof->normal[f], corner[0], corner[i]) != 0)
            return "a facet is not flat";
        for (uint32_t j = 0; j < count; j++) {
            uint32_t next = (i + 1) % count;
            if (j == i || j == next)
                continue;
            normal_of(proof, proof->u, corner[i], corner[next], corner[j]);
            oracle_dot(proof->a, proof->u, proof->normal[f]);
            if (mpz_sgn(proof->a) <= 0)
                return "a facet is not strictly convex";
        }
    }
    return NULL;
}

struct side_of_facet {
    uint32_t from, to, facet, opposite; /* opposite: a corner of the facet off the side */
};

static int compare_sides(const void *a, const void *b) {
    const struct side_of_facet *x = a, *y = b;
    if (x->from != y->from)
        return x->from < y->from ? -1 : 1;
    return x->to < y->to ? -1 : x->to > y->to;
}

/* All sides sorted; *ret_count of them. The caller frees. */
static struct side_of_facet *sorted_sides(const pir_mesh *mesh, size_t *ret_count) {
    size_t sides = 0;
    uint32_t count;
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        pir_mesh_facet(mesh, f, &count);
        sides += count;
    }
    struct side_of_facet *side = malloc((sides + 1) * sizeof *side);
    if (!side)
        abort();
    sides = 0;
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        for (uint32_t i = 0; i < count; i++)
            side[sides++] = (struct side_of_facet){corner[i], corner[(i + 1) % count], f, corner[(i + 2) % count]};
    }
    qsort(side, sides, sizeof *side, compare_sides);
    *ret_count = sides;
    return side;
}

/* Each side once, its reverse once, and from each a strict bend inwards (`flat`: a fold onto the other side). */
static const char *check_edges(struct proof *proof, int flat) {
    size_t count;
    struct side_of_facet *sides = sorted_sides(proof->mesh, &count);
    const char *wrong = NULL;
    for (size_t i = 0; i < count && !wrong; i++) {
        struct side_of_facet reverse = {sides[i].to, sides[i].from, 0, 0};
        const struct side_of_facet *twin = bsearch(&reverse, sides, count, sizeof *sides, compare_sides);
        if (!twin || (i > 0 && compare_sides(&sides[i - 1], &sides[i]) == 0))
            wrong = "facets do not close";
        else if (!flat && side(proof, proof->normal[sides[i].facet], sides[i].from, twin->opposite) >= 0)
            wrong = "neighbouring facets are coplanar or bend outwards";
    }
    free(sides);
    if (!wrong && pir_mesh_edge_count(proof->mesh) * 2 != count)
        wrong = "the edge count is wrong";
    return wrong;
}

/* Whether the plane through vertex `on` with normal n supports the sum. */
static int supports(struct proof *proof, oracle_vec n, uint32_t on) {
    oracle_support(proof->a, proof->p, n);
    oracle_support(proof->b, proof->q, n);
    mpz_add(proof->a, proof->a, proof->b);
    oracle_dot(proof->b, n, proof->v.at[on]);
    return mpz_cmp(proof->a, proof->b) == 0;
}

static void negate(oracle_vec n) {
    for (int k = 0; k < 3; k++)
        mpz_neg(n[k], n[k]);
}

/* A sum that is a polygon: two facets, one the other backwards; its plane and those upright on its
   sides support the sum. */
static const char *check_polygon(struct proof *proof) {
    uint32_t count, other;
    const uint32_t *corner = pir_mesh_facet(proof->mesh, 0, &count);
    pir_mesh_facet(proof->mesh, 1, &other);
    if (count != other || count != proof->v.count)
        return "the sides of a polygon differ";
    for (uint32_t i = 0; i < count; i++) {
        oracle_sub(proof->s, proof->v.at[corner[(i + 1) % count]], proof->v.at[corner[i]]);
        oracle_cross(proof->u, proof->s, proof->normal[0]);
        if (!supports(proof, proof->u, corner[i]))
            return "a side of a polygon does not support the sum";
    }
    return NULL;
}

static const char *check_surface(struct proof *proof) {
    uint32_t facets = pir_mesh_facet_count(proof->mesh);
    int flat = facets == 2;
    const char *wrong = NULL;
    for (uint32_t f = 0; f < facets && !wrong; f++)
        wrong = check_facet(proof, f);
    if (!wrong)
        wrong = check_edges(proof, flat);
    if (!wrong && proof->v.count + facets != pir_mesh_edge_count(proof->mesh) + 2)
        wrong = "V - E + F is not 2";
    for (uint32_t f = 0; f < facets && !wrong; f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(proof->mesh, f, &count);
        if (!supports(proof, proof->normal[f], corner[0]))
            wrong = "a facet's plane does not support the sum";
    }
    if (!wrong && flat)
        wrong = check_polygon(proof);
    return wrong;
}

/* A sum that is a segment or a point: it reaches as far as the sum along itself, and no operand leaves its line. */
static const char *check_line(struct proof *proof) {
    if (proof->v.count > 2 || pir_mesh_edge_count(proof->mesh) != proof->v.count - 1)
        return "a sum without facets is neither a segment nor a point";
    uint32_t last = proof->v.count - 1;
    oracle_sub(proof->u, proof->v.at[last], proof->v.at[0]);
    if (last > 0 && oracle_is_zero(proof->u))
        return "a segment's ends are equal";
    for (int o = 0; o < 2; o++) {
        const oracle_points *operand = o ? proof->q : proof->p;
        for (uint32_t i = 1; i < operand->count; i++) {
            oracle_sub(proof->s, operand->at[i], operand->at[0]);
            oracle_cross(proof->t, proof->s, proof->u);
            if (!oracle_is_zero(proof->t) || (last == 0 && !oracle_is_zero(proof->s)))
                return "a sum without facets is not flat";
        }
    }
    if (!supports(proof, proof->u, last))
        return "a segment's end does not support the sum";
    negate(proof->u);
    return supports(proof, proof->u, 0) ? NULL : "a segment's start does not support the sum";
}

const char *oracle_check_sum(const pir_mesh *mesh, oracle_points *p, oracle_points *q) {
    if (!pir_mesh_is_exact(mesh) || pir_mesh_vertex_count(mesh) == 0)
        return "the mesh holds no exact coordinates";
    struct proof proof = {.mesh = mesh, .p = p, .q = q};
    uint32_t facets = pir_mesh_facet_count(mesh);
    oracle_points_from_mesh(&proof.v, mesh);
    oracle_points_common((oracle_points *const[]){&proof.v, p, q}, 3);
    proof.normal = malloc((facets + 1) * sizeof *proof.normal);
    if (!proof.normal)
        abort();
    for (uint32_t f = 0; f < facets; f++)
        oracle_vec_init(proof.normal[f]);
    mpz_inits(proof.a, proof.b, NULL);
    oracle_vec_init(proof.s);
    oracle_vec_init(proof.t);
    oracle_vec_init(proof.u);

    const char *wrong = check_vertices(&proof);
    if (!wrong)
        wrong = facets == 0 ? check_line(&proof) : check_surface(&proof);

    oracle_vec_clear(proof.u);
    oracle_vec_clear(proof.t);
    oracle_vec_clear(proof.s);
    mpz_clears(proof.a, proof.b, NULL);
    for (uint32_t f = 0; f < facets; f++)
        oracle_vec_clear(proof.normal[f]);
    free(proof.normal);
    oracle_points_clear(&proof.v);
    return wrong;
}

const char *oracle_check_doubles(const pir_mesh *mesh, double ulps, double size) {
    mpq_t exact[3], bound, off;
    mpq_inits(exact[0], exact[1], exact[2], bound, off, NULL);
    mpq_set_d(bound, ulps * ldexp(size, -53));
    const char *wrong = NULL;
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh) && !wrong; v++) {
        pir_vec3 x = pir_mesh_vertices(mesh)[v];
        const double near[3] = {x.x, x.y, x.z};
        if (pir_mesh_vertex_exact(mesh, v, exact) != PIR_OK)
            wrong = "no exact coordinates";
        for (int k = 0; k < 3 && !wrong; k++) {
            mpq_set_d(off, near[k]);
            mpq_sub(off, off, exact[k]);
            mpq_abs(off, off);
            if (mpq_cmp(off, bound) > 0)
                wrong = "a double is too far from its exact coordinate";
        }
    }
    mpq_clears(exact[0], exact[1], exact[2], bound, off, NULL);
    return wrong;
}
