/* SPDX-License-Identifier: MIT */
/*
 * Merging facets exactly.
 *
 * Vertices that are vertices only by rounding go first (merge_thin.c), within half of the tolerance.
 *
 * Each group of nearly coplanar facets gets one plane with a normal of few bits, midway between its corners. A vertex
 * of such a group moves to where the planes of its merged facets meet; other facets of four corners and more keep their
 * planes, triangles have none to keep. One plane or two leave a vertex free to keep one or two of its coordinates. The
 * hull of all vertices, moved or not, is the result: it is convex whatever happened, and its merged facets are planar
 * because their corners lie on one plane exactly.
 *
 * Vertex by vertex the corners of the two bodies are no farther apart than the longest move, so neither are their
 * hulls: that is the bound. A move that is too long gives up the least of the vertex's groups, and so does a vertex
 * with more than three planes. All coordinates go on one denominator, which is why their length is limited.
 *
 * This file, merge_groups.c and merge_thin.c compute with GMP's rationals, in GMP's own memory.
 */
#include "polytope/create/merge.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "polytope/create/merge_groups.h"
#include "polytope/create/merge_thin.h"
#include "polytope/exact_points.h"

/* The longest common denominator of the moved vertices, in bits. */
#define DENOMINATOR_BITS_MAX 32768

#define PLANES_MAX 3

/* A plane n·x = d in the hull's integers. */
struct integer_plane {
    mpz_t n[3], d;
};

struct merging {
    const pir_polytope *hull;
    pir_merge_groups groups;
    mpz_t *offset;                          /* per group */
    mpq_t *at;                              /* three a vertex, in the hull's integers */
    mpq_t limit;                            /* the square of the tolerance, in those units */
    mpq_t unit;                             /* of length: the hull's scale */
    mpq_t farthest;                         /* the square of the longest move */
    mpz_t common;                           /* the denominator so far */
    struct integer_plane plane[PLANES_MAX]; /* work space, with the next two */
    mpz_t minor[3], rest;
    mpq_t move;
};

static void set_int(mpz_t to, pir_int a) {
    mpz_t view;
    mpz_set(to, mpz_roinit_n(view, a.limb, a.size));
}

/* --- planes --- */

/* sum = n·x for the vertex's own place. */
static void height_of(struct merging *m, mpz_t sum, const struct integer_plane *plane, uint32_t vertex) {
    pir_int3 x = pir_vertex_exact(m->hull, vertex);
    mpz_set_ui(sum, 0);
    for (int k = 0; k < 3; k++) {
        mpz_t view;
        mpz_addmul(sum, plane->n[k], mpz_roinit_n(view, x.c[k].limb, x.c[k].size));
    }
}

static void set_normal(struct integer_plane *plane, const pir_merge_slope *slope) {
    mpz_set_ui(plane->n[slope->axis], 1);
    mpz_mul_2exp(plane->n[slope->axis], plane->n[slope->axis], (mp_bitcnt_t)slope->bits);
    for (int k = 0; k < 2; k++)
        mpz_set_si(plane->n[(slope->axis + 1 + k) % 3], (long)-slope->slope[k]);
}

/* The offsets of all groups: midway between the corners that lie lowest and highest. */
static void set_offsets(struct merging *m) {
    const pir_polytope *hull = m->hull;
    mpz_t height, low, high;
    mpz_inits(height, low, high, NULL);
    for (uint32_t g = 0, i = 0; g < m->groups.count; g++) {
        set_normal(&m->plane[0], &m->groups.group[g].slope);
        bool any = false;
        for (; i < m->groups.group[g].next; i++) {
            uint32_t f = m->groups.facets[i];
            for (uint32_t j = hull->loop_start[f]; j < hull->loop_start[f + 1]; j++, any = true) {
                height_of(m, height, &m->plane[0], hull->origin[hull->loop[j]]);
                if (!any || mpz_cmp(height, low) < 0)
                    mpz_set(low, height);
                if (!any || mpz_cmp(height, high) > 0)
                    mpz_set(high, height);
            }
        }
        mpz_add(low, low, high);
        mpz_fdiv_q_2exp(m->offset[g], low, 1);
    }
    mpz_clears(height, low, high, NULL);
}

/* A facet's plane: of its group where that is active, else its own. */
static void set_plane(struct merging *m, struct integer_plane *plane, uint32_t facet) {
    uint32_t g = m->groups.of[facet];
    if (g != PIR_NO_GROUP && m->groups.group[g].active) {
        set_normal(plane, &m->groups.group[g].slope);
        mpz_set(plane->d, m->offset[g]);
        return;
    }
    pir_int3 n = pir_normal_exact(m->hull, facet);
    for (int k = 0; k < 3; k++)
        set_int(plane->n[k], n.c[k]);
    height_of(m, plane->d, plane, m->hull->origin[m->hull->loop[m->hull->loop_start[facet]]]);
}

/* --- vertices --- */

static void cross_of(mpz_t to[3], mpz_t *a, mpz_t *b) {
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        mpz_mul(to[k], a[i], b[j]);
        mpz_submul(to[k], a[j], b[i]);
    }
}

static int longest_axis(mpz_t *v) {
    int best = 0;
    for (int k = 1; k < 3; k++)
        if (mpz_cmpabs(v[k], v[best]) > 0)
            best = k;
    return best;
}

/* to = num/den in lowest terms. */
static void set_quotient(mpq_t to, const mpz_t num, const mpz_t den) {
    mpz_set(mpq_numref(to), num);
    mpz_set(mpq_denref(to), den);
    mpq_canonicalize(to);
}

/* Onto one plane: the coordinate along its steepest axis changes. */
static bool move_to_plane(struct merging *m, mpq_t *x) {
    struct integer_plane *plane = &m->plane[0];
    int axis = longest_axis(plane->n);
    mpz_set(m->rest, plane->d);
    for (int k = 1; k < 3; k++)
        mpz_submul(m->rest, plane->n[(axis + k) % 3], mpq_numref(x[(axis + k) % 3]));
    set_quotient(x[axis], m->rest, plane->n[axis]);
    return true;
}

/* Onto two planes: the coordinate along which their line runs most stays. */
static bool move_to_line(struct merging *m, mpq_t *x) {
    struct integer_plane *a = &m->plane[0], *b = &m->plane[1];
    cross_of(m->minor, a->n, b->n);
    int axis = longest_axis(m->minor), i = (axis + 1) % 3, j = (axis + 2) % 3;
    if (mpz_sgn(m->minor[axis]) == 0)
        return false;
    // what is left for the other two coordinates: a.n·(x_i, x_j) = a.d, and the same of b
    mpz_submul(a->d, a->n[axis], mpq_numref(x[axis]));
    mpz_submul(b->d, b->n[axis], mpq_numref(x[axis]));
    mpz_mul(m->rest, a->d, b->n[j]);
    mpz_submul(m->rest, b->d, a->n[j]);
    set_quotient(x[i], m->rest, m->minor[axis]);
    mpz_mul(m->rest, b->d, a->n[i]);
    mpz_submul(m->rest, a->d, b->n[i]);
    set_quotient(x[j], m->rest, m->minor[axis]);
    return true;
}

/* To the point of three planes, by Cramer's rule. */
static bool move_to_point(struct merging *m, mpq_t *x) {
    mpz_t sum[3], determinant;
    mpz_inits(sum[0], sum[1], sum[2], determinant, NULL);
    for (int p = 0; p < 3; p++) {
        struct integer_plane *one = &m->plane[p], *two = &m->plane[(p + 1) % 3], *three = &m->plane[(p + 2) % 3];
        cross_of(m->minor, two->n, three->n);
        for (int k = 0; k < 3; k++) {
            mpz_addmul(sum[k], one->d, m->minor[k]);
            if (p == 0)
                mpz_addmul(determinant, one->n[k], m->minor[k]);
        }
    }
    bool done = mpz_sgn(determinant) != 0;
    for (int k = 0; k < 3 && done; k++)
        set_quotient(x[k], sum[k], determinant);
    mpz_clears(sum[0], sum[1], sum[2], determinant, NULL);
    return done;
}

/*
 * A facet for each plane that the vertex is to lie on, or PLANES_MAX + 1 when there are more; none where no group that
 * is active meets it.
 */
static uint32_t list_planes(const struct merging *m, uint32_t v, uint32_t facet[PLANES_MAX]) {
    const pir_polytope *hull = m->hull;
    uint32_t count = 0;
    bool moves = false;
    for (uint32_t h = hull->ring_start[v]; h < hull->ring_start[v + 1]; h++) {
        uint32_t f = hull->left[h], g = m->groups.of[f];
        bool merged = g != PIR_NO_GROUP && m->groups.group[g].active;
        moves |= merged;
        if (!merged && hull->loop_start[f + 1] - hull->loop_start[f] == 3)
            continue;
        bool known = false;
        for (uint32_t i = 0; i < count && i < PLANES_MAX; i++)
            known |= facet[i] == f || (merged && m->groups.of[facet[i]] == g);
        if (known)
            continue;
        if (count < PLANES_MAX)
            facet[count] = f;
        count++;
    }
    return !moves ? 0 : count > PLANES_MAX ? PLANES_MAX + 1 : count;
}

/* Adds up how far the vertex went: whether it is within the limit. */
static bool measure_move(struct merging *m, uint32_t v) {
    mpq_t *x = m->at + 3 * (size_t)v;
    mpq_set_ui(m->move, 0, 1);
    mpq_t d, own;
    mpq_inits(d, own, NULL);
    for (int k = 0; k < 3; k++) {
        set_int(mpq_numref(own), pir_vertex_exact(m->hull, v).c[k]);
        mpq_sub(d, x[k], own);
        mpq_mul(d, d, d);
        mpq_add(m->move, m->move, d);
    }
    mpq_clears(d, own, NULL);
    if (mpq_cmp(m->move, m->farthest) > 0 && mpq_cmp(m->move, m->limit) <= 0)
        mpq_set(m->farthest, m->move);
    return mpq_cmp(m->move, m->limit) <= 0;
}

/* Moves a vertex onto its planes; false when that is too far, or there are too many. */
static bool move_vertex(struct merging *m, uint32_t v) {
    mpq_t *x = m->at + 3 * (size_t)v;
    for (int k = 0; k < 3; k++) {
        set_int(mpq_numref(x[k]), pir_vertex_exact(m->hull, v).c[k]);
        mpz_set_ui(mpq_denref(x[k]), 1);
    }
    uint32_t facet[PLANES_MAX], count = list_planes(m, v, facet);
    if (count == 0)
        return true;
    if (count > PLANES_MAX)
        return false;
    for (uint32_t i = 0; i < count; i++)
        set_plane(m, &m->plane[i], facet[i]);
    bool done = count == 1 ? move_to_plane(m, x) : count == 2 ? move_to_line(m, x) : move_to_point(m, x);
    if (!done || !measure_move(m, v))
        return false;
    for (int k = 0; k < 3; k++)
        mpz_lcm(m->common, m->common, mpq_denref(x[k]));
    return true;
}

/* --- giving groups up --- */

/* Gives up the least of the groups that meet at a vertex, by area; of equal ones the last. */
static void give_up_at(struct merging *m, uint32_t v) {
    pir_merge_group *least = NULL;
    for (uint32_t h = m->hull->ring_start[v]; h < m->hull->ring_start[v + 1]; h++) {
        uint32_t g = m->groups.of[m->hull->left[h]];
        if (g == PIR_NO_GROUP || !m->groups.group[g].active)
            continue;
        pir_merge_group *group = &m->groups.group[g];
        if (!least || group->area < least->area || (group->area == least->area && group > least))
            least = group;
    }
    if (least)
        least->active = false;
}

static int compare_areas(const void *left, const void *right) {
    const double *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

/* Gives up the least quarter of the groups. False when out of memory. */
static bool give_up_least(struct merging *m) {
    double *area = PIR_NEW(&m->hull->allocator, double, m->groups.count);
    if (!area)
        return false;
    uint32_t active = 0, given_up = 0;
    for (uint32_t g = 0; g < m->groups.count; g++)
        if (m->groups.group[g].active)
            area[active++] = m->groups.group[g].area;
    qsort(area, active, sizeof *area, compare_areas);
    for (uint32_t g = m->groups.count; g-- > 0 && active > 0 && given_up < active / 4 + 1;)
        if (m->groups.group[g].active && m->groups.group[g].area <= area[active / 4]) {
            m->groups.group[g].active = false;
            given_up++;
        }
    PIR_FREE(&m->hull->allocator, area, m->groups.count);
    return true;
}

/* Moves all vertices, giving groups up until every one can go where it must; false when out of memory. */
static bool move_vertices(struct merging *m) {
    for (;;) {
        bool all = true;
        mpq_set_ui(m->farthest, 0, 1);
        mpz_set_ui(m->common, 1);
        for (uint32_t v = 0; v < m->hull->vertex_count; v++) {
            if (mpz_sizeinbase(m->common, 2) > DENOMINATOR_BITS_MAX)
                break;
            if (!move_vertex(m, v)) {
                give_up_at(m, v);
                all = false;
            }
        }
        if (mpz_sizeinbase(m->common, 2) > DENOMINATOR_BITS_MAX) {
            if (!give_up_least(m))
                return false;
        } else if (all) {
            return true;
        }
    }
}

/* --- the whole --- */

double pir_root_rounded_up(const mpq_t square) {
    if (mpq_sgn(square) == 0)
        return 0;
    // floor(square · 4^k) + 1 has 128 bits or more: the root of that has 64 or more, and 1 more is above the true root
    mpz_t n;
    mpz_init(n);
    long bits = (long)mpz_sizeinbase(mpq_numref(square), 2) - (long)mpz_sizeinbase(mpq_denref(square), 2);
    long k = bits >= 128 ? 0 : (130 - bits) / 2;
    mpz_mul_2exp(n, mpq_numref(square), 2 * (mp_bitcnt_t)k);
    mpz_fdiv_q(n, n, mpq_denref(square));
    mpz_add_ui(n, n, 1);
    mpz_sqrt(n, n);
    mpz_add_ui(n, n, 1);
    // mpz_get_d cuts off; below the normal doubles ldexp may round down once more
    double root = ldexp(nextafter(mpz_get_d(n), INFINITY), (int)-k);
    mpz_clear(n);
    return root < 0x1p-1020 ? nextafter(root, INFINITY) : root;
}

static bool start_merging(struct merging *m, const pir_polytope *hull, double tolerance) {
    const pir_allocator *a = &hull->allocator;
    m->hull = hull;
    mpz_inits(m->minor[0], m->minor[1], m->minor[2], m->rest, m->common, NULL);
    mpq_inits(m->limit, m->unit, m->farthest, m->move, NULL);
    for (int i = 0; i < PLANES_MAX; i++)
        mpz_inits(m->plane[i].n[0], m->plane[i].n[1], m->plane[i].n[2], m->plane[i].d, NULL);
    set_int(mpq_numref(m->unit), hull->scale.num);
    set_int(mpq_denref(m->unit), hull->scale.den);
    mpq_canonicalize(m->unit);
    mpq_set_d(m->limit, tolerance);
    mpq_div(m->limit, m->limit, m->unit);
    mpq_mul(m->limit, m->limit, m->limit);
    m->offset = pir_memory_new(a, m->groups.count, sizeof *m->offset);
    m->at = pir_memory_new(a, 3 * (size_t)hull->vertex_count, sizeof *m->at);
    for (uint32_t g = 0; m->offset && g < m->groups.count; g++)
        mpz_init(m->offset[g]);
    for (size_t i = 0; m->at && i < 3 * (size_t)hull->vertex_count; i++)
        mpq_init(m->at[i]);
    return m->offset && m->at;
}

static void finish_merging(struct merging *m) {
    const pir_polytope *hull = m->hull;
    for (uint32_t g = 0; m->offset && g < m->groups.count; g++)
        mpz_clear(m->offset[g]);
    for (size_t i = 0; m->at && i < 3 * (size_t)hull->vertex_count; i++)
        mpq_clear(m->at[i]);
    PIR_FREE(&hull->allocator, m->offset, m->groups.count);
    PIR_FREE(&hull->allocator, m->at, 3 * (size_t)hull->vertex_count);
    for (int i = 0; i < PLANES_MAX; i++)
        mpz_clears(m->plane[i].n[0], m->plane[i].n[1], m->plane[i].n[2], m->plane[i].d, NULL);
    mpz_clears(m->minor[0], m->minor[1], m->minor[2], m->rest, m->common, NULL);
    mpq_clears(m->limit, m->unit, m->farthest, m->move, NULL);
}

/* The hull of the vertices where they are now; NULL where it has no fewer facets than before. */
static pir_status build_merged(struct merging *m, double tolerance, pir_polytope **ret_merged) {
    const pir_polytope *hull = m->hull;
    for (size_t i = 0; i < 3 * (size_t)hull->vertex_count; i++)
        mpq_mul(m->at[i], m->at[i], m->unit);
    pir_polytope *merged = NULL;
    struct pir_exact_points exact;
    pir_status status =
        pir_exact_points_of_rationals(&exact, (const mpq_t *)m->at, hull->vertex_count, &hull->allocator);
    if (status == PIR_OK) {
        status = pir_polytope_build_hull(&(pir_polytope_parts){.points = &exact.vectors, .scale = &exact.scale},
                                         &hull->allocator, &merged);
        pir_exact_points_finish(&exact, &hull->allocator);
    }
    if (status != PIR_OK && status != PIR_ERR_LIMIT)
        return status;
    // coordinates that were as long as is allowed before stay as they were
    if (status == PIR_ERR_LIMIT || merged->facet_count >= hull->facet_count) {
        pir_polytope_release(merged);
        *ret_merged = NULL;
        return PIR_OK;
    }
    mpq_mul(m->farthest, m->farthest, m->unit);
    mpq_mul(m->farthest, m->farthest, m->unit);
    // the longest move is within the tolerance exactly; rounding up may pass it by a bit
    merged->merge_bound = fmin(pir_root_rounded_up(m->farthest), tolerance);
    for (uint32_t v = 0; v < merged->vertex_count; v++)
        merged->source[v] = hull->source[merged->source[v]];
    *ret_merged = merged;
    return PIR_OK;
}

/* The hull with what facets can be merged within `tolerance` merged: a new polytope, its bound
   set. NULL where none can. */
static pir_status merge_facets(const pir_polytope *hull, double tolerance, pir_polytope **ret_merged) {
    struct merging m = {0};
    pir_status status = pir_merge_groups_make(&m.groups, hull, tolerance);
    if (status != PIR_OK)
        return status;
    *ret_merged = NULL;
    if (m.groups.count > 0) {
        status = PIR_ERR_MEMORY;
        if (start_merging(&m, hull, tolerance)) {
            set_offsets(&m);
            if (move_vertices(&m))
                status = build_merged(&m, tolerance, ret_merged);
        }
        finish_merging(&m);
    }
    pir_merge_groups_finish(&m.groups, hull);
    return status;
}

/* Drops vertices, then merges facets, where that is possible; NULL where it is not. */
static pir_status drop_and_merge(const pir_polytope *hull, double tolerance, pir_polytope **ret_merged) {
    pir_polytope *thinned = NULL, *merged = NULL;
    pir_status status = pir_merge_thin(hull, tolerance, &thinned);
    if (status != PIR_OK)
        return status;
    // the distances of both steps add up to no more than the tolerance
    double spent = thinned ? thinned->merge_bound : 0, left = thinned ? nextafter(tolerance - spent, 0) : tolerance;
    status = merge_facets(thinned ? thinned : hull, left, &merged);
    if (merged && thinned)
        merged->merge_bound = fmin(nextafter(spent + merged->merge_bound, INFINITY), tolerance);
    if (status != PIR_OK || merged)
        pir_polytope_release(thinned);
    if (status == PIR_OK)
        *ret_merged = merged ? merged : thinned;
    return status;
}

pir_status pir_polytope_merge_within(pir_polytope *hull, double tolerance, pir_polytope **ret_polytope) {
    pir_polytope *merged = NULL;
    pir_status status = tolerance > 0 && hull->dimension == 3 ? drop_and_merge(hull, tolerance, &merged) : PIR_OK;
    if (status != PIR_OK || merged)
        pir_polytope_release(hull);
    if (status == PIR_OK)
        *ret_polytope = merged ? merged : hull;
    return status;
}
