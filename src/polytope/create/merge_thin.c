/* SPDX-License-Identifier: MIT */
/*
 * Dropping the vertices that are vertices only by rounding.
 *
 * A point in the middle of an edge or of a facet that is turned in doubles comes to lie a little outside of it. It is a
 * vertex of the exact hull then, and slivers join it to the facets beside it. Such a vertex is next to the hull of its
 * neighbours: next to a segment between two of them, or to a triangle. It is dropped where its distance is within what
 * is left of half of the tolerance.
 *
 * This goes by rounds. In one round no vertex goes that the distance of another was measured to. So the hull after the
 * round is within the longest of these distances of the hull before. These of all rounds add up to the bound. Doubles
 * find the nearest point, as weights of the neighbours; its distance is measured in integers.
 */
#include "polytope/create/merge_thin.h"

#include <math.h>

#include "polytope/create/merge.h"
#include "polytope/some_vertices.h"

/* Vertices with more neighbours stay: looking at them takes time that grows with the square of that number. */
#define NEIGHBOURS_MAX 64

/* Weights are integers in units of 2^-WEIGHT_BITS. */
#define WEIGHT_BITS 60

enum mark { FREE = 0, HELD, DROPPED };

struct thinning {
    const pir_polytope *hull;
    pir_vec3 *at;  /* per vertex */
    uint8_t *mark; /* per vertex */
    double reach;  /* in units of `at` */
    uint32_t dropped;
    mpq_t limit;    /* the square of the reach, in the hull's integers */
    mpq_t farthest; /* the square of the longest distance of a vertex that goes, in the same */
    mpz_t difference, weight;
    mpq_t distance; /* work space, with the two before */
};

/* A point of the hull of up to three vertices near a fourth. */
struct thin_nearest {
    uint32_t vertex[3];
    double weight[3]; /* from 0 to 1; the first makes up the sum of 1 */
    double square;    /* of the distance */
};

/* --- the nearest point --- */

static void keep_nearer(struct thin_nearest *best, const struct thin_nearest *other) {
    if (other->square < best->square)
        *best = *other;
}

/* The point of the segment from u to w that is nearest to v. */
static void look_at_segment(const struct thinning *t, uint32_t v, uint32_t u, uint32_t w, struct thin_nearest *best) {
    pir_vec3 a = pir_vec_sub(t->at[u], t->at[v]), along = pir_vec_sub(t->at[w], t->at[u]);
    double s = -pir_vec_dot(a, along) / pir_vec_dot(along, along);
    s = s > 0 ? fmin(s, 1) : 0;
    pir_vec3 d = pir_vec_add(a, pir_vec_scale(along, s));
    keep_nearer(best, &(struct thin_nearest){{u, w, u}, {1 - s, s, 0}, pir_vec_dot(d, d)});
}

/* The foot of v on the plane of three vertices, where that lies between them. */
static void look_at_triangle(const struct thinning *t, uint32_t v, const uint32_t vertex[3],
                             struct thin_nearest *best) {
    pir_vec3 a = pir_vec_sub(t->at[vertex[0]], t->at[v]), b = pir_vec_sub(t->at[vertex[1]], t->at[vertex[0]]),
             c = pir_vec_sub(t->at[vertex[2]], t->at[vertex[0]]), n = pir_vec_cross(b, c);
    double square = pir_vec_dot(n, n), height = pir_vec_dot(n, a);
    if (!(square > 0))
        return;
    double s = pir_vec_dot(n, pir_vec_cross(c, a)) / square, r = pir_vec_dot(n, pir_vec_cross(a, b)) / square;
    if (s > 0 && r > 0 && s + r < 1)
        keep_nearer(best, &(struct thin_nearest){
                              {vertex[0], vertex[1], vertex[2]}, {1 - s - r, s, r}, height / square * height});
}

/*
 * A point near v of the hull of its neighbours: the nearest of the segments between two of them; where that is out of
 * reach, of the triangles that two neighbouring ones make with a third.
 */
static struct thin_nearest find_nearest(const struct thinning *t, uint32_t v) {
    const pir_polytope *hull = t->hull;
    uint32_t around[NEIGHBOURS_MAX], count = 0;
    for (uint32_t h = hull->ring_start[v]; h < hull->ring_start[v + 1]; h++)
        if (t->mark[hull->target[h]] != DROPPED)
            around[count++] = hull->target[h];
    struct thin_nearest best = {.square = INFINITY};
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t j = i + 1; j < count; j++)
            look_at_segment(t, v, around[i], around[j], &best);
    if (best.square <= t->reach * t->reach)
        return best;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t j = 0; j < count; j++) {
            uint32_t next = (j + 1) % count;
            if (i != j && i != next)
                look_at_triangle(t, v, (uint32_t[3]){around[i], around[j], around[next]}, &best);
        }
    return best;
}

/* --- the exact distance --- */

/* t->distance = the square of the distance of v from the point, in the hull's integers. */
static void measure_distance(struct thinning *t, uint32_t v, const struct thin_nearest *point) {
    int64_t weight[3] = {0};
    weight[1] = llround(ldexp(point->weight[1], WEIGHT_BITS));
    weight[2] = llround(ldexp(point->weight[2], WEIGHT_BITS));
    weight[0] = ((int64_t)1 << WEIGHT_BITS) - weight[1] - weight[2];
    mpq_set_ui(t->distance, 0, 1);
    for (int k = 0; k < 3; k++) {
        mpz_t view;
        pir_int own = pir_vertex_exact(t->hull, v).c[k];
        mpz_mul_2exp(t->difference, mpz_roinit_n(view, own.limb, own.size), WEIGHT_BITS);
        for (int i = 0; i < 3; i++) {
            pir_int x = pir_vertex_exact(t->hull, point->vertex[i]).c[k];
            mpz_set_si(t->weight, (long)weight[i]);
            mpz_submul(t->difference, mpz_roinit_n(view, x.limb, x.size), t->weight);
        }
        mpz_addmul(mpq_numref(t->distance), t->difference, t->difference);
    }
    mpq_div_2exp(t->distance, t->distance, 2 * WEIGHT_BITS);
}

/* Drops v where it is near enough to the hull of its neighbours, which are held then. */
static void try_vertex(struct thinning *t, uint32_t v) {
    uint32_t degree = t->hull->ring_start[v + 1] - t->hull->ring_start[v];
    if (t->mark[v] == HELD || degree > NEIGHBOURS_MAX)
        return;
    struct thin_nearest point = find_nearest(t, v);
    if (!(point.square <= t->reach * t->reach))
        return;
    measure_distance(t, v, &point);
    if (mpq_cmp(t->distance, t->limit) > 0)
        return;
    if (mpq_cmp(t->distance, t->farthest) > 0)
        mpq_set(t->farthest, t->distance);
    for (int i = 0; i < 3; i++)
        t->mark[point.vertex[i]] = HELD;
    t->mark[v] = DROPPED;
    t->dropped++;
}

/* --- rounds --- */

/* The hull of the vertices that were not dropped. */
static pir_status build_rest(const struct thinning *t, pir_polytope **ret_rest) {
    const pir_polytope *hull = t->hull;
    uint32_t count = hull->vertex_count - t->dropped, *kept = PIR_NEW(&hull->allocator, uint32_t, count);
    if (!kept)
        return PIR_ERR_MEMORY;
    for (uint32_t v = 0, i = 0; v < hull->vertex_count; v++)
        if (t->mark[v] != DROPPED)
            kept[i++] = v;
    pir_status status = pir_polytope_of_some(hull, kept, count, ret_rest);
    PIR_FREE(&hull->allocator, kept, count);
    return status;
}

/* The hull's unit of length. */
static void set_unit(mpq_t unit, const pir_polytope *hull) {
    mpz_t view;
    mpz_set(mpq_numref(unit), mpz_roinit_n(view, hull->scale.num.limb, hull->scale.num.size));
    mpz_set(mpq_denref(unit), mpz_roinit_n(view, hull->scale.den.limb, hull->scale.den.size));
    mpq_canonicalize(unit);
}

static pir_status drop_vertices(struct thinning *t, double reach, pir_polytope **ret_rest) {
    const pir_polytope *hull = t->hull;
    mpq_t unit;
    mpq_init(unit);
    set_unit(unit, hull);
    mpq_set_d(t->limit, reach);
    mpq_div(t->limit, t->limit, unit);
    mpq_mul(t->limit, t->limit, t->limit);
    t->reach = pir_merge_place(hull, reach, t->at);
    for (uint32_t v = 0; v < hull->vertex_count; v++)
        try_vertex(t, v);
    pir_polytope *rest = NULL;
    pir_status status = t->dropped > 0 ? build_rest(t, &rest) : PIR_OK;
    if (rest && rest->dimension == 3) {
        mpq_mul(t->farthest, t->farthest, unit);
        mpq_mul(t->farthest, t->farthest, unit);
        rest->merge_bound = fmin(pir_root_rounded_up(t->farthest), reach);
        *ret_rest = rest;
    } else {
        pir_polytope_release(rest);
    }
    mpq_clear(unit);
    return status;
}

/* One round: *ret_rest is NULL where no vertex went, its merge bound the longest distance of one that did. */
static pir_status run_round(const pir_polytope *hull, double reach, pir_polytope **ret_rest) {
    const pir_allocator *a = &hull->allocator;
    struct thinning t = {.hull = hull,
                         .at = PIR_NEW(a, pir_vec3, hull->vertex_count),
                         .mark = PIR_ZEROED(a, uint8_t, hull->vertex_count)};
    *ret_rest = NULL;
    pir_status status = PIR_ERR_MEMORY;
    if (t.at && t.mark) {
        mpq_inits(t.limit, t.farthest, t.distance, NULL);
        mpz_inits(t.difference, t.weight, NULL);
        status = drop_vertices(&t, reach, ret_rest);
        mpz_clears(t.difference, t.weight, NULL);
        mpq_clears(t.limit, t.farthest, t.distance, NULL);
    }
    PIR_FREE(a, t.mark, hull->vertex_count);
    PIR_FREE(a, t.at, hull->vertex_count);
    return status;
}

pir_status pir_merge_thin(const pir_polytope *hull, double tolerance, pir_polytope **ret_thinned) {
    pir_polytope *thinned = NULL;
    double spent = 0;
    for (;;) {
        double reach = tolerance / 2 - spent;
        pir_polytope *rest = NULL;
        pir_status status = reach > 0 ? run_round(thinned ? thinned : hull, reach, &rest) : PIR_OK;
        if (status != PIR_OK) {
            pir_polytope_release(thinned);
            return status;
        }
        if (!rest)
            break;
        // rounding up may pass the half by a bit
        spent = fmin(nextafter(spent + rest->merge_bound, INFINITY), tolerance / 2);
        pir_polytope_release(thinned);
        thinned = rest;
        thinned->merge_bound = spent;
    }
    *ret_thinned = thinned;
    return PIR_OK;
}

/* --- places --- */

double pir_merge_place(const pir_polytope *hull, double tolerance, pir_vec3 *ret_at) {
    long bits = 0;
    mpz_t work;
    mpz_init(work);
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t v = 0; v < hull->vertex_count; v++) {
            double near[3];
            for (int k = 0; k < 3; k++) {
                pir_int x = pir_vertex_exact(hull, v).c[k], origin = pir_vertex_exact(hull, 0).c[k];
                mpz_t view, view_origin;
                mpz_sub(work, mpz_roinit_n(view, x.limb, x.size), mpz_roinit_n(view_origin, origin.limb, origin.size));
                long exponent;
                double mantissa = mpz_get_d_2exp(&exponent, work);
                if (pass == 0 && mantissa != 0 && exponent > bits)
                    bits = exponent;
                near[k] = ldexp(mantissa, (int)(exponent - bits));
            }
            ret_at[v] = (pir_vec3){near[0], near[1], near[2]};
        }
    mpz_clear(work);
    mpq_t length, unit;
    mpq_inits(length, unit, NULL);
    set_unit(unit, hull);
    mpq_set_d(length, tolerance);
    mpq_div(length, length, unit);
    mpq_div_2exp(length, length, (mp_bitcnt_t)bits);
    double placed = mpq_get_d(length);
    mpq_clears(length, unit, NULL);
    return placed;
}
