/* SPDX-License-Identifier: MIT */
/*
 * A point of a facet of the sum, off the facet's edges, is the sum of a point of P and one of Q at which the two
 * bodies have the facet's plane for a common support near those points: were it otherwise, sums of points nearby would
 * fill both sides. That leaves, for a normal n,
 *
 *     a facet of one with normal n, and of the other a vertex whose edges all lead below the plane; or an edge in the
 *     plane whose facets lead below it; or a facet with normal n as well;
 *     an edge of each, both convex, whose arcs in the Gaussian map cross.
 *
 * This is the convolution of the two surfaces (Guibas, Ramshaw, Stolfi 1983). Facets are taken part by part, so that
 * every candidate is the sum of two convex polygons, segments or points in parallel planes, and convex.
 */
#include "solid/sum/convolution.h"

#include "solid/space/exact.h"

/* A convex polygon of one body in a plane, or a segment with its two directions, or a point. */
struct flat_face {
    const uint32_t *point, *direction;
    uint32_t count;
};

struct candidate_maker {
    pir_space *space;
    const pir_shell_body *a, *b; /* the body whose facet gives the normal, and the other */
    pir_polygons *polygons;
    pir_candidate_taker *take;
    void *context;
    uint32_t *first, *edge; /* per point of b: where its edges begin in `edge` */
    uint32_t count;         /* corners of the polygon that is to be added */
};

/* --- sums of faces --- */

static void push(struct candidate_maker *m, uint32_t a, uint32_t b, uint32_t direction) {
    pir_polygons *p = m->polygons;
    if (!pir_space_grow(m->space, (void **)&p->corner, &p->made_room, m->count, sizeof *p->corner) ||
        !pir_space_grow(m->space, (void **)&p->direction, &p->direction_room, m->count, sizeof *p->direction))
        return;
    p->corner[m->count] = pir_space_add_sum(m->space, a, b);
    p->direction[m->count++] = direction;
}

/* The corner of `face` that is farthest out beyond a side of direction d, counter-clockwise about n; of two, the one
 * from which the side to the other leads along d. */
static uint32_t start_of(struct candidate_maker *m, const struct flat_face *face, uint32_t n, uint32_t d) {
    for (uint32_t i = 0; i < face->count && face->count > 1; i++) {
        const uint32_t before = face->direction[i > 0 ? i - 1 : face->count - 1], after = face->direction[i];
        const int to = pir_space_det(m->space, n, d, after), from = pir_space_det(m->space, n, d, before);
        const bool leads = to > 0 || (to == 0 && pir_space_dot(m->space, d, after) > 0);
        if (leads && (from < 0 || (from == 0 && pir_space_dot(m->space, d, before) < 0)))
            return i;
    }
    return 0;
}

/* The sum of a polygon f and of g, as a candidate in the plane of `half` with normal n. */
static void add_sum(struct candidate_maker *m, uint32_t half, uint32_t n, const struct flat_face *f,
                    const struct flat_face *g) {
    uint32_t j = start_of(m, g, n, f->direction[0]), left = g->count > 1 ? g->count : 0;
    m->count = 0;
    for (uint32_t i = 0; (i < f->count || left > 0) && m->space->status == PIR_OK;) {
        const uint32_t d = f->direction[i < f->count ? i : 0], e = left > 0 ? g->direction[j] : d;
        const int turn = i == f->count ? -1 : left == 0 ? 1 : pir_space_det(m->space, n, d, e);
        push(m, f->point[i < f->count ? i : 0], g->point[j], turn >= 0 ? d : e);
        i += turn >= 0;
        if (turn <= 0 && left > 0) {
            j = j + 1 < g->count ? j + 1 : 0;
            left--;
        }
    }
    const uint32_t polygon =
        pir_polygons_add(m->polygons, half, m->polygons->corner, m->polygons->direction, NULL, m->count);
    if (m->space->status == PIR_OK && m->take)
        m->take(m->context, polygon);
}

static struct flat_face part_of(const pir_shell_body *body, uint32_t part) {
    const uint32_t first = body->part_start[part];
    return (struct flat_face){body->part_corner + first, body->part_direction + first,
                              body->part_start[part + 1] - first};
}

/* The sums of all parts of a's facets in the group of `facet` with a face of b. */
static void add_parts(struct candidate_maker *m, uint32_t facet, const struct flat_face *g) {
    const uint32_t n = m->space->plane[m->a->plane[facet]].direction[0];
    uint32_t half = PIR_SPACE_NONE;
    for (uint32_t p = 0; p < m->a->part_count; p++) {
        if (m->a->group[m->a->part_facet[p]] != facet)
            continue;
        const struct flat_face f = part_of(m->a, p);
        if (half == PIR_SPACE_NONE)
            half = pir_half(pir_space_add_plane(m->space, (const uint32_t[]){n, PIR_SPACE_NONE}, false,
                                                (const uint32_t[]){f.point[0], g->point[0]}),
                            false);
        add_sum(m, half, n, &f, g);
    }
}

/* --- a facet of a with what it meets of b --- */

static uint32_t direction_from(const pir_shell_body_edge *edge, uint32_t point, int *ret_sign) {
    *ret_sign = edge->a == point ? 1 : -1;
    return edge->direction;
}

/* Whether all edges of a vertex lead below a plane with normal n. */
static bool supports_at_vertex(struct candidate_maker *m, uint32_t v, uint32_t n) {
    for (uint32_t i = m->first[v]; i < m->first[v + 1]; i++) {
        int sign;
        const uint32_t d = direction_from(&m->b->edge[m->edge[i]], m->b->first_point + v, &sign);
        if (sign * pir_space_dot(m->space, d, n) >= 0)
            return false;
    }
    return m->first[v] < m->first[v + 1];
}

/* Whether an edge lies in a plane with normal n, and both its facets lead below it. */
static bool supports_at_edge(struct candidate_maker *m, const pir_shell_body_edge *edge, uint32_t n) {
    if (edge->bend != PIR_BEND_CONVEX || pir_space_dot(m->space, edge->direction, n) != 0)
        return false;
    const uint32_t left = m->space->plane[m->b->plane[edge->left]].direction[0];
    const uint32_t right = m->space->plane[m->b->plane[edge->right]].direction[0];
    return pir_space_det(m->space, n, left, edge->direction) < 0 &&
           pir_space_det(m->space, n, edge->direction, right) < 0;
}

static bool same_direction(pir_space *space, uint32_t a, uint32_t b) {
    const double *x = space->direction[a].n, *y = space->direction[b].n;
    for (int k = 0; k < 3; k++)
        if (x[k] - y[k] > 0x1p-45 || y[k] - x[k] > 0x1p-45)
            return false;
    const uint32_t i = pir_space_exact_direction(space, a), j = pir_space_exact_direction(space, b);
    for (uint32_t k = 0; k < 3 && space->status == PIR_OK; k++)
        if (mpz_cmp(space->number[i + k], space->number[j + k]) != 0)
            return false;
    return true;
}

static void meet_vertices(struct candidate_maker *m, uint32_t facet, uint32_t n) {
    for (uint32_t v = 0; v < m->b->source.point_count && m->space->status == PIR_OK; v++) {
        const uint32_t point = m->b->first_point + v;
        if (supports_at_vertex(m, v, n))
            add_parts(m, facet, &(struct flat_face){&point, NULL, 1});
    }
}

static void meet_edges(struct candidate_maker *m, uint32_t facet, uint32_t n) {
    for (uint32_t e = 0; e < m->b->edge_count && m->space->status == PIR_OK; e++) {
        const pir_shell_body_edge *edge = &m->b->edge[e];
        if (!supports_at_edge(m, edge, n))
            continue;
        const uint32_t exact = pir_space_exact_direction(m->space, edge->direction);
        if (m->space->status != PIR_OK)
            return;
        mpz_t *t = m->space->t + 8;
        for (uint32_t k = 0; k < 3; k++)
            mpz_neg(t[k], m->space->number[exact + k]);
        const uint32_t point[2] = {edge->a, edge->b};
        const uint32_t direction[2] = {edge->direction, pir_space_add_direction(m->space, t[0], t[1], t[2])};
        add_parts(m, facet, &(struct flat_face){point, direction, 2});
    }
}

static void meet_facets(struct candidate_maker *m, uint32_t facet, uint32_t n) {
    for (uint32_t p = 0; p < m->b->part_count && m->space->status == PIR_OK; p++) {
        const struct flat_face g = part_of(m->b, p);
        if (same_direction(m->space, n, m->space->plane[m->b->plane[m->b->part_facet[p]]].direction[0]))
            add_parts(m, facet, &g);
    }
}

/* --- edges --- */

/* As of convex pieces: the sign of right · direction where an edge's arc passes strictly through its great circle. */
static int passes(const struct candidate_maker *m, const pir_shell_body *body, const pir_shell_body_edge *edge,
                  uint32_t direction) {
    const uint32_t left = m->space->plane[body->plane[edge->left]].direction[0];
    const uint32_t right = m->space->plane[body->plane[edge->right]].direction[0];
    const int sign = pir_space_dot(m->space, right, direction);
    return sign != 0 && pir_space_dot(m->space, left, direction) == -sign ? sign : 0;
}

static void meet_edge_pair(struct candidate_maker *m, const pir_shell_body_edge *e, const pir_shell_body_edge *g) {
    const int along = passes(m, m->a, e, g->direction);
    if (along == 0 || passes(m, m->b, g, e->direction) != -along)
        return;
    pir_space *space = m->space;
    const uint32_t half = pir_half(pir_space_add_plane(space, (const uint32_t[]){e->direction, g->direction}, along > 0,
                                                       (const uint32_t[]){e->a, g->a}),
                                   false);
    // round the parallelogram, counter-clockwise about its normal
    const uint32_t corner[2][4][2] = {{{e->a, g->a}, {e->b, g->a}, {e->b, g->b}, {e->a, g->b}},
                                      {{e->a, g->a}, {e->a, g->b}, {e->b, g->b}, {e->b, g->a}}};
    const uint32_t side[2] = {along > 0 ? g->direction : e->direction, along > 0 ? e->direction : g->direction};
    m->count = 0;
    for (int i = 0; i < 4; i++)
        push(m, corner[along > 0][i][0], corner[along > 0][i][1], side[i & 1]);
    if (space->status != PIR_OK)
        return;
    const uint32_t polygon = pir_polygons_add(m->polygons, half, m->polygons->corner, m->polygons->direction,
                                              (const bool[]){false, false, true, true}, m->count);
    if (space->status == PIR_OK && m->take)
        m->take(m->context, polygon);
}

static void meet_edge_pairs(struct candidate_maker *m) {
    for (uint32_t e = 0; e < m->a->edge_count; e++)
        for (uint32_t g = 0; g < m->b->edge_count && m->space->status == PIR_OK; g++)
            if (m->a->edge[e].bend == PIR_BEND_CONVEX && m->b->edge[g].bend == PIR_BEND_CONVEX)
                meet_edge_pair(m, &m->a->edge[e], &m->b->edge[g]);
}

/* --- the whole --- */

/* The edges of each point of b, by counting. */
static bool list_edges(struct candidate_maker *m) {
    const pir_allocator *a = &m->space->allocator;
    const uint32_t points = m->b->source.point_count;
    m->first = PIR_ZEROED(a, uint32_t, (size_t)points + 2);
    m->edge = PIR_NEW(a, uint32_t, 2 * (size_t)m->b->edge_count);
    if (!m->first || !m->edge)
        return false;
    uint32_t *after = m->first + 1;
    for (uint32_t e = 0; e < m->b->edge_count; e++) {
        after[m->b->edge[e].a - m->b->first_point + 1]++;
        after[m->b->edge[e].b - m->b->first_point + 1]++;
    }
    for (uint32_t v = 0; v < points; v++)
        after[v + 1] += after[v];
    for (uint32_t e = 0; e < m->b->edge_count; e++) {
        m->edge[after[m->b->edge[e].a - m->b->first_point]++] = e;
        m->edge[after[m->b->edge[e].b - m->b->first_point]++] = e;
    }
    return true;
}

static void finish(struct candidate_maker *m) {
    const pir_allocator *a = &m->space->allocator;
    PIR_FREE(a, m->first, (size_t)m->b->source.point_count + 2);
    PIR_FREE(a, m->edge, 2 * (size_t)m->b->edge_count);
}

/* The candidates with a facet of `a`; those of two facets and of two edges when `both`. */
static void make(struct candidate_maker *m, bool both) {
    if (!list_edges(m))
        m->space->status = PIR_ERR_MEMORY;
    for (uint32_t f = 0; f < m->a->source.facet_count && m->space->status == PIR_OK; f++) {
        if (m->a->group[f] != f)
            continue;
        const uint32_t n = m->space->plane[m->a->plane[f]].direction[0];
        meet_vertices(m, f, n);
        meet_edges(m, f, n);
        if (both)
            meet_facets(m, f, n);
    }
    if (both)
        meet_edge_pairs(m);
    finish(m);
}

void pir_candidates_at_vertex(const pir_shell_body *a, const pir_shell_body *b, uint32_t facet, uint32_t vertex,
                              pir_polygons *polygons) {
    struct candidate_maker m = {.space = a->space, .a = a, .b = b, .polygons = polygons};
    const uint32_t point = b->first_point + vertex;
    add_parts(&m, facet, &(struct flat_face){&point, NULL, 1});
}

void pir_candidate_of_edges(const pir_shell_body *p, const pir_shell_body *q, uint32_t e, uint32_t g,
                            pir_polygons *polygons) {
    struct candidate_maker m = {.space = p->space, .a = p, .b = q, .polygons = polygons};
    meet_edge_pair(&m, &p->edge[e], &q->edge[g]);
}

void pir_candidates(const pir_shell_body *p, const pir_shell_body *q, pir_polygons *polygons, pir_candidate_taker *take,
                    void *context) {
    struct candidate_maker pq = {
        .space = p->space, .a = p, .b = q, .polygons = polygons, .take = take, .context = context};
    struct candidate_maker qp = {
        .space = p->space, .a = q, .b = p, .polygons = polygons, .take = take, .context = context};
    make(&pq, true);
    make(&qp, false);
}
