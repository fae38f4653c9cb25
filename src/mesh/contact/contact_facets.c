/* SPDX-License-Identifier: MIT */
/*
 * Facets of a difference, one after the other.
 *
 * A side of T and an edge of P make a facet where the arc of the edge on the sphere crosses the circle across the side.
 * Where doubles cannot tell, it is taken for a crossing: a direction that is none of a facet is still one along which
 * P leaves, if its depth is that of the farthest points, as it is here.
 */
#include "mesh/contact/contact_facets.h"

/* The error of the sine of an angle is at most this. */
#define SINE_ERROR 0x1p-40

/* How far P has to move along n. */
static double depth_along(const pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s, pir_vec3 n) {
    double least = HUGE_VAL, along[3];
    for (uint32_t v = 0; v < job->p->vertex_count; v++)
        least = pir_lesser(least, pir_vec_dot(n, job->vertex[v]));
    for (int k = 0; k < 3; k++)
        along[k] = pir_vec_dot(n, pir_vec_sub(s->p[k], t));
    return pir_greater(along[0], pir_greater(along[1], along[2])) - least;
}

struct tour {
    double far;    /* how far points of the difference are from one another */
    bool parallel; /* a side and an edge that are too nearly so for doubles are told of too, with no normal */
    const pir_contact_job *job;
    const pir_near_triangle *s;
    pir_vec3 t;
    pir_contact_facet_visitor *visit;
    void *context;
};

static void offer(const struct tour *tour, pir_contact_facet facet) {
    facet.depth = depth_along(tour->job, tour->t, tour->s, facet.n);
    facet.off *= tour->far;
    tour->visit(tour->context, &facet);
}

static void offer_across(const struct tour *tour, uint32_t k, uint32_t edge) {
    const pir_polytope *p = tour->job->p;
    const pir_vec3 *normal = tour->job->turned, *direction = normal + p->facet_count;
    uint32_t half = p->edge_half[edge];
    pir_vec3 side = pir_vec_sub(tour->s->p[(k + 1) % 3], tour->s->p[k]);
    pir_vec3 left = normal[p->left[half]], right = normal[pir_right(p, half)];
    double wide = pir_length(side), a = pir_vec_dot(side, left), b = pir_vec_dot(side, right);
    double small = wide * SINE_ERROR;
    if (p->dimension == 3 && ((a > small && b > small) || (a < -small && b < -small)))
        return;
    pir_vec3 n = pir_vec_cross(side, direction[edge]);
    double length = pir_length(n);
    if (!(length > small)) {
        if (tour->parallel)
            tour->visit(tour->context, &(pir_contact_facet){PIR_CONTACT_ACROSS, k, edge, {0, 0, 0}, -HUGE_VAL, 0});
        return;
    }
    n = pir_vec_scale(n, 1 / length);
    double off = (8 * tour->job->error + 0x1p-48 * wide) / length;
    pir_vec3 to = pir_vec_sub(tour->s->p[(k + 2) % 3], tour->s->p[k]), of_p = pir_vec_add(left, right);
    for (int sign = -1; sign <= 1; sign += 2) {
        pir_vec3 m = pir_vec_scale(n, sign);
        if (pir_vec_dot(m, to) > (SINE_ERROR + off) * pir_length(to) ||
            (p->dimension == 3 && pir_vec_dot(m, of_p) > SINE_ERROR + 2 * off))
            continue;
        offer(tour, (pir_contact_facet){PIR_CONTACT_ACROSS, k, edge, m, 0, off});
    }
}

static void visit_facets(pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s, bool parallel,
                         pir_contact_facet_visitor *visit, void *context) {
    double far = 2 * job->radius, sides = 0;
    for (int k = 0; k < 3; k++) {
        far += pir_length(pir_vec_sub(s->p[k], t));
        sides += pir_length(pir_vec_sub(s->p[(k + 1) % 3], s->p[k]));
    }
    double area = pir_length(pir_vec_cross(pir_vec_sub(s->p[1], s->p[0]), pir_vec_sub(s->p[2], s->p[0])));
    double off = (8 * job->error * sides + 0x1p-48 * sides * sides) / area;
    const struct tour tour = {far, parallel, job, s, t, visit, context};
    const pir_polytope *p = job->p;
    pir_contact_turn(job);
    if (pir_vec_dot(s->front, s->front) > 0) {
        offer(&tour, (pir_contact_facet){PIR_CONTACT_FRONT, 0, 0, s->front, 0, off});
        offer(&tour, (pir_contact_facet){PIR_CONTACT_FRONT, 1, 0, pir_vec_scale(s->front, -1), 0, off});
    }
    for (uint32_t f = 0; f < p->facet_count; f++)
        offer(&tour, (pir_contact_facet){PIR_CONTACT_FACET, f, 0, pir_vec_scale(job->turned[f], -1), 0, 0x1p-46});
    for (uint32_t k = 0; k < 3; k++)
        for (uint32_t e = 0; e < p->edge_count; e++)
            offer_across(&tour, k, e);
}

void pir_contact_each_facet(pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s,
                            pir_contact_facet_visitor *visit, void *context) {
    visit_facets(job, t, s, false, visit, context);
}

void pir_contact_plane_facets(pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s,
                              pir_contact_facet_visitor *visit, void *context) {
    const struct tour tour = {0, false, job, s, t, visit, context};
    if (!(pir_vec_dot(s->front, s->front) > 0))
        return;
    offer(&tour, (pir_contact_facet){PIR_CONTACT_FRONT, 0, 0, s->front, 0, 0});
    if (!s->one_sided)
        offer(&tour, (pir_contact_facet){PIR_CONTACT_FRONT, 1, 0, pir_vec_scale(s->front, -1), 0, 0});
}

/* --- whether they touch --- */

/* How far off a point may be of which doubles say that it is beside a facet, by the size of what it is made of. */
#define BESIDE 0x1p-30

/* The vertex that is least along n; UINT32_MAX where another one is nearly as low. */
static uint32_t single_lowest(const pir_contact_job *job, pir_vec3 n, double near) {
    double least = HUGE_VAL, next = HUGE_VAL;
    uint32_t best = UINT32_MAX;
    for (uint32_t v = 0; v < job->p->vertex_count; v++) {
        const double along = pir_vec_dot(n, job->vertex[v]);
        next = pir_lesser(next, pir_greater(along, least));
        best = along < least ? v : best;
        least = pir_lesser(least, along);
    }
    return next - least > near ? best : UINT32_MAX;
}

/* The corner that is most along n; 3 where another one is nearly as high. */
static uint32_t single_highest(const pir_near_triangle *s, pir_vec3 n, double near) {
    const double h[3] = {pir_vec_dot(n, s->p[0]), pir_vec_dot(n, s->p[1]), pir_vec_dot(n, s->p[2])};
    for (uint32_t k = 0; k < 3; k++)
        if (h[k] - pir_greater(h[(k + 1) % 3], h[(k + 2) % 3]) > near)
            return k;
    return 3;
}

/* How far x is outside of the side from a to b of a face that is counter-clockwise about n. */
static double beyond(pir_vec3 a, pir_vec3 b, pir_vec3 n, pir_vec3 x) {
    const pir_vec3 e = pir_vec_sub(b, a);
    return pir_vec_dot(pir_vec_cross(e, n), pir_vec_sub(x, a)) / pir_length(e);
}

/* On the triangle's plane: the lowest vertex over the triangle. */
static bool may_touch_plane(const pir_contact_job *job, pir_vec3 moved, const pir_near_triangle *s,
                            const pir_contact_facet *facet, double near) {
    const uint32_t v = single_lowest(job, facet->n, near);
    for (uint32_t k = 0; k < 3 && v != UINT32_MAX; k++)
        if (beyond(s->p[k], s->p[(k + 1) % 3], s->front, pir_vec_add(job->vertex[v], moved)) > near)
            return false;
    return true;
}

/* On P's facet: the highest corner under it. */
static bool may_touch_facet(const pir_contact_job *job, pir_vec3 moved, const pir_near_triangle *s,
                            const pir_contact_facet *facet, double near) {
    const pir_polytope *p = job->p;
    const uint32_t w = single_highest(s, facet->n, near), end = p->loop_start[facet->first + 1];
    for (uint32_t i = p->loop_start[facet->first]; i < end && w < 3; i++) {
        const pir_vec3 a = job->vertex[p->origin[p->loop[i]]], b = job->vertex[p->target[p->loop[i]]];
        if (beyond(a, b, job->turned[facet->first], pir_vec_sub(s->p[w], moved)) > near)
            return false;
    }
    return true;
}

/* Of two segments a b and c d across n: whether one of them is on one side of the other. */
static bool are_beside(pir_vec3 a, pir_vec3 b, pir_vec3 c, pir_vec3 d, pir_vec3 n, double near) {
    const double x = beyond(a, b, n, c), y = beyond(a, b, n, d), z = beyond(c, d, n, a), w = beyond(c, d, n, b);
    return (x > near && y > near) || (x < -near && y < -near) || (z > near && w > near) || (z < -near && w < -near);
}

bool pir_contact_may_touch(const pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s,
                           const pir_contact_facet *facet) {
    const pir_polytope *p = job->p;
    const pir_vec3 moved = pir_vec_add(t, pir_vec_scale(facet->n, facet->depth));
    const double near = BESIDE * job->size + 4 * facet->off;
    if (facet->kind == PIR_CONTACT_FRONT)
        return may_touch_plane(job, moved, s, facet, near);
    if (facet->kind == PIR_CONTACT_FACET)
        return p->dimension < 3 || may_touch_facet(job, moved, s, facet, near);
    const uint32_t half = p->edge_half[facet->second];
    const pir_vec3 a = pir_vec_add(job->vertex[p->origin[half]], moved);
    const pir_vec3 b = pir_vec_add(job->vertex[p->target[half]], moved);
    return !are_beside(a, b, s->p[facet->first], s->p[(facet->first + 1) % 3], facet->n, near);
}

/* --- whether they overlap --- */

struct facet_search {
    pir_contact_job *job;
    pir_contact_place place;
    const pir_near_triangle *s;
    double error, least;
    bool separated;
};

static void find_least(void *context, const pir_contact_facet *facet) {
    struct facet_search *search = context;
    search->least = pir_lesser(search->least, facet->depth - facet->off);
}

static pir_int3 exact_of(pir_contact_job *job, const pir_near_triangle *s, const pir_contact_facet *facet) {
    if (facet->kind == PIR_CONTACT_FRONT)
        return pir_exact_front(job, s);
    return facet->kind == PIR_CONTACT_FACET ? pir_exact_facet(job, facet->first)
                                            : pir_exact_across(job, s, facet->first, facet->second);
}

static void try_separating(void *context, const pir_contact_facet *facet) {
    struct facet_search *search = context;
    if (search->separated || facet->depth - facet->off > search->error)
        return;
    pir_limbs *limbs = &search->job->limbs;
    uint32_t used = limbs->used;
    pir_int3 n = exact_of(search->job, search->s, facet);
    // either way: doubles may have its sign wrong
    for (int turn = 0; turn < 2 && !search->separated && !pir_int3_is_zero(&n); turn++) {
        search->separated = pir_exact_least(search->job, &search->place, search->s, &n) >= 0;
        for (int k = 0; k < 3; k++)
            pir_int_negate(&n.c[k]);
    }
    limbs->used = used;
}

/*
 * A side and an edge that are parallel but for SINE_ERROR make a sliver of a facet, of which doubles have no normal.
 * Another facet beside it is as far from 0 but for that part of the edge's length, so what is deeper than that overlaps
 * there too; else integers are asked about the sliver.
 */
bool pir_contact_overlaps(pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s, bool exactly) {
    const double size = job->radius + pir_length(pir_vec_sub(t, s->p[0]));
    const double error = 0x1p-44 * size + 16 * job->error + 4 * SINE_ERROR * job->radius;
    struct facet_search search = {job, pir_place_at(t), s, error, HUGE_VAL, false};
    visit_facets(job, t, s, false, find_least, &search);
    if (search.least > search.error || !exactly)
        return search.least > search.error;
    job->counts.exact++;
    visit_facets(job, t, s, true, try_separating, &search);
    return !search.separated;
}
