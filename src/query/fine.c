/* SPDX-License-Identifier: MIT */
/*
 * The descent of descent.c in double-double, for points next to D.
 *
 * There the direction of v is a difference of nearly equal numbers, and simplices of three vertices may be slivers a billionth as wide as
 * long. With 106 bits both are well told. Vertices of the operands are doubles already, a little off the exact ones, but always by the
 * same: what is descended on is a polytope, within rounding of D.
 */
#include <string.h>

#include "query/query.h"

/* As in descent.c. */
struct nearest {
    uint32_t count, index[3];
    pir_dd weight[3];
    pir_dd3 v;
    pir_dd square;
};

static const pir_dd one = {1, 0};

static void take(struct nearest *best, struct nearest candidate) {
    candidate.square = pir_dd3_product(candidate.v, candidate.v);
    if (best->count == 0 || pir_dd_less(candidate.square, best->square))
        *best = candidate;
}

static void take_segment(const pir_dd3 *w, uint32_t a, uint32_t b, struct nearest *best) {
    pir_dd3 e = pir_dd3_sub(w[b], w[a]);
    pir_dd along = pir_dd_negate(pir_dd3_product(w[a], e)), whole = pir_dd3_product(e, e);
    if (!(along.hi > 0 && pir_dd_less(along, whole)))
        return;
    pir_dd t = pir_dd_divide(along, whole);
    take(best, (struct nearest){.count = 2,
                                .index = {a, b},
                                .weight = {pir_dd_sub(one, t), t},
                                .v = pir_dd3_add(w[a], pir_dd3_times(e, t))});
}

static void take_triangle(const pir_dd3 *w, uint32_t a, uint32_t b, uint32_t c, struct nearest *best) {
    pir_dd3 n = pir_dd3_cross(pir_dd3_sub(w[b], w[a]), pir_dd3_sub(w[c], w[a]));
    pir_dd whole = pir_dd3_product(n, n);
    pir_dd wa = pir_dd3_product(n, pir_dd3_cross(w[b], w[c])), wb = pir_dd3_product(n, pir_dd3_cross(w[c], w[a]));
    pir_dd wc = pir_dd3_product(n, pir_dd3_cross(w[a], w[b]));
    if (!(wa.hi > 0 && wb.hi > 0 && wc.hi > 0) || whole.hi == 0)
        return;
    pir_dd sum = pir_dd_add(pir_dd_add(wa, wb), wc);
    // the plane's distance from the nearest corner: from a far one it cancels, and faces of a sliver are not told apart
    double qa = pir_dd3_product(w[a], w[a]).hi, qb = pir_dd3_product(w[b], w[b]).hi,
           qc = pir_dd3_product(w[c], w[c]).hi;
    uint32_t corner = qa <= qb && qa <= qc ? a : qb <= qc ? b : c;
    take(best, (struct nearest){.count = 3,
                                .index = {a, b, c},
                                .weight = {pir_dd_divide(wa, sum), pir_dd_divide(wb, sum), pir_dd_divide(wc, sum)},
                                .v = pir_dd3_times(n, pir_dd_divide(pir_dd3_product(n, w[corner]), whole))});
}

/* Every face of up to four points: which of them are new does not matter here. */
static struct nearest find_nearest(const pir_dd3 *w, uint32_t count) {
    struct nearest best = {0};
    for (uint32_t i = 0; i < count; i++) {
        take(&best, (struct nearest){.count = 1, .index = {i}, .weight = {one}, .v = w[i]});
        for (uint32_t j = 0; j < i; j++) {
            take_segment(w, j, i, &best);
            for (uint32_t k = 0; k < j; k++)
                take_triangle(w, k, j, i, &best);
        }
    }
    return best;
}

/* Vertex (a, b) of D less x. */
static pir_dd3 fine_vertex(const pir_query *query, const pir_placement *placement, uint32_t a, uint32_t b) {
    pir_dd3 w = pir_dd3_sub(pir_dd3_from(query->vq[b]), placement->fine);
    for (int i = 0; i < 3; i++)
        w.c[i] = pir_dd_add(w.c[i], pir_dd3_dot(query->r_fine[i], query->vp[a]));
    return w;
}

static void keep_nearest(pir_simplex *simplex, pir_dd3 *w, const struct nearest *best) {
    pir_simplex old = *simplex;
    pir_dd3 points[4];
    memcpy(points, w, sizeof points);
    simplex->count = best->count;
    for (uint32_t i = 0; i < best->count; i++) {
        simplex->a[i] = old.a[best->index[i]];
        simplex->b[i] = old.b[best->index[i]];
        simplex->weight[i] = best->weight[i].hi;
        w[i] = points[best->index[i]];
    }
}

/* The unit vector along −v. */
static pir_vec3 towards_x(const pir_dd3 *v, double *ret_length) {
    // scaled first: the square of a tiny vector would vanish; what even scaling cannot hold is nothing
    pir_vec3 d = pir_dd3_round(*v);
    double most = fmax(fabs(d.x), fmax(fabs(d.y), fabs(d.z)));
    *ret_length = 0;
    if (most < 0x1p-900)
        return d;
    d = pir_vec_scale(d, 1 / most);
    double length = sqrt(pir_vec_dot(d, d));
    *ret_length = length * most;
    return pir_vec_scale(d, -1 / length);
}

void pir_descend_finely(pir_query *query, const pir_placement *placement, pir_simplex *simplex, uint32_t *steps) {
    pir_dd3 w[4] = {{{{0, 0}, {0, 0}, {0, 0}}}};
    pir_frame_make_fine(query);
    pir_simplex_start(query, placement, simplex);
    for (uint32_t i = 0; i < simplex->count; i++)
        w[i] = fine_vertex(query, placement, simplex->a[i], simplex->b[i]);
    simplex->certain = simplex->parts = false;
    double gap = HUGE_VAL;
    pir_simplex kept = *simplex;
    struct nearest best = find_nearest(w, simplex->count);
    for (uint32_t step = 0; step < PIR_MOST_STEPS; step++) {
        keep_nearest(simplex, w, &best);
        simplex->direction = towards_x(&best.v, &simplex->upper);
        simplex->lower = 0;
        simplex->parts = false;
        simplex->certain = simplex->upper == 0;
        if (simplex->certain) {
            kept = *simplex;
            break;
        }
        ++*steps;
        uint32_t a = pir_climb(query->p, pir_mat_apply_transposed(&query->r, simplex->direction), simplex->a[0]);
        uint32_t b = pir_climb(query->q, simplex->direction, simplex->b[0]), n = simplex->count;
        w[n] = fine_vertex(query, placement, a, b);
        // x is not in D's inside, so no distance is below 0
        double lower = -pir_vec_dot(pir_dd3_round(w[n]), simplex->direction);
        simplex->lower = fmax(0, lower);
        simplex->parts = lower >= -placement->error;
        simplex->certain = simplex->upper - simplex->lower <= PIR_MEET * placement->reach;
        if (simplex->upper - simplex->lower < gap) {
            gap = simplex->upper - simplex->lower;
            kept = *simplex;
        }
        if (simplex->certain || pir_simplex_holds(simplex, a, b))
            break;
        simplex->a[n] = a;
        simplex->b[n] = b;
        best = find_nearest(w, n + 1);
    }
    *simplex = kept;
}
