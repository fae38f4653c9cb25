/* SPDX-License-Identifier: MIT */
/* See exact_pair.h. */
#include "query/exact_pair.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

double exact_length(pir_vec3 v) {
    double most = exact_largest(v);
    if (most == 0)
        return 0;
    double x = v.x / most, y = v.y / most, z = v.z / most;
    return most * sqrt(x * x + y * y + z * z);
}

pir_vec3 exact_add(pir_vec3 a, pir_vec3 b, double s) {
    return (pir_vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

double exact_largest(pir_vec3 v) {
    return fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
}

double exact_turn_from(const oracle_plane *plane, pir_vec3 normal) {
    return exact_length((pir_vec3){normal.x - plane->near[0], normal.y - plane->near[1], normal.z - plane->near[2]});
}

/* --- bodies --- */

static exact_body make_body(pir_polytope *polytope) {
    exact_body body = {.polytope = polytope, .solid = oracle_solid_make(polytope)};
    uint32_t words = body.solid->words;
    body.edges = pir_polytope_edge_count(polytope);
    body.facets = pir_polytope_facet_count(polytope);
    body.edge = oracle_new((size_t)body.edges * words, sizeof *body.edge);
    body.facet = oracle_new((size_t)body.facets * words, sizeof *body.facet);
    for (uint32_t e = 0; e < body.edges; e++)
        oracle_solid_feature(body.solid, polytope, (pir_feature){PIR_FEATURE_EDGE, e}, &body.edge[e * words]);
    for (uint32_t f = 0; f < body.facets; f++)
        oracle_solid_feature(body.solid, polytope, (pir_feature){PIR_FEATURE_FACET, f}, &body.facet[f * words]);
    return body;
}

static double measure(const exact_body *body, double *reach) {
    pir_vec3 low, high;
    pir_polytope_bounds(body->polytope, &low, &high);
    *reach = fmax(*reach, fmax(exact_largest(low), exact_largest(high)));
    return exact_length(exact_add(high, low, -1));
}

exact_pair exact_pair_make(pir_polytope *p, pir_polytope *q, double scale) {
    exact_pair pair = {.body = {make_body(p), make_body(q)}};
    pair.size = measure(&pair.body[0], &pair.reach) + measure(&pair.body[1], &pair.reach);
    pair.size = pair.size > 0 ? pair.size : scale;
    return pair;
}

void exact_pair_free(exact_pair *pair) {
    for (int i = 0; i < 2; i++) {
        exact_body *body = &pair->body[i];
        oracle_solid_free(body->solid);
        pir_polytope_release(body->polytope);
        free(body->edge);
        free(body->facet);
    }
}

/* --- features --- */

int exact_feature_set(const exact_body *body, pir_feature feature, oracle_set *set) {
    return oracle_solid_feature(body->solid, body->polytope, feature, set);
}

static uint32_t find_set(const oracle_set *sets, uint32_t count, const oracle_set *set, uint32_t words) {
    uint32_t i = 0;
    while (i < count && memcmp(&sets[i * words], set, words * sizeof *set) != 0)
        i++;
    return i;
}

static uint32_t members(const oracle_set *set, uint32_t words, uint32_t *last) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < 64 * words; i++)
        if (oracle_set_has(set, i)) {
            *last = i;
            count++;
        }
    return count;
}

pir_feature exact_feature_of(const exact_body *body, const oracle_set *set) {
    uint32_t words = body->solid->words, one = 0, count = members(set, words, &one);
    if (count == 1)
        return (pir_feature){PIR_FEATURE_VERTEX, one};
    if (count == 2)
        return (pir_feature){PIR_FEATURE_EDGE, find_set(body->edge, body->edges, set, words)};
    return (pir_feature){PIR_FEATURE_FACET, find_set(body->facet, body->facets, set, words)};
}

int exact_same_feature(const exact_body *body, pir_feature a, pir_feature b) {
    if (a.kind == PIR_FEATURE_FACET && b.kind == PIR_FEATURE_FACET && body->solid->dimension == 2)
        return a.index < 2 && b.index < 2;
    return a.kind == b.kind && a.index == b.index;
}

/* --- ranks --- */

/* Whether a polygon's facet faces along a plane's normal in the difference, where P is subtracted. */
static int faces(double (*near)[3], const exact_body *body, uint32_t facet, const double along[3], int sign) {
    uint32_t size = pir_polytope_facet_size(body->polytope, facet), *corner = oracle_new(size, sizeof *corner);
    double height = 0;
    pir_polytope_facet(body->polytope, facet, corner);
    for (uint32_t i = 0; i < size; i++) {
        const double *x = near[corner[i]], *y = near[corner[(i + 1) % size]];
        height += along[0] * (x[1] * y[2] - x[2] * y[1]) + along[1] * (x[2] * y[0] - x[0] * y[2]) +
                  along[2] * (x[0] * y[1] - x[1] * y[0]);
    }
    free(corner);
    return sign * height > 0;
}

static exact_rank rank_of(const exact_pair *pair, const oracle_plane *plane) {
    const exact_body *p = &pair->body[PIR_OPERAND_P], *q = &pair->body[PIR_OPERAND_Q];
    pir_feature of_p = exact_feature_of(p, plane->p), of_q = exact_feature_of(q, plane->q);
    if (of_p.kind == PIR_FEATURE_FACET) {
        if (p->solid->dimension == 2 && !faces(pair->place->near_a, p, of_p.index, plane->near, -1))
            of_p.index = 1 - of_p.index;
        return (exact_rank){0, of_p.index, 0};
    }
    if (of_q.kind == PIR_FEATURE_FACET) {
        if (q->solid->dimension == 2 && !faces(pair->place->near_b, q, of_q.index, plane->near, 1))
            of_q.index = 1 - of_q.index;
        return (exact_rank){1, of_q.index, 0};
    }
    return (exact_rank){2, of_p.index, of_q.index};
}

static int ranks_before(exact_rank a, exact_rank b) {
    if (a.kind != b.kind)
        return a.kind < b.kind;
    return a.first != b.first ? a.first < b.first : a.second < b.second;
}

void exact_pair_turn(exact_pair *pair, pir_quat rotation) {
    pair->place = oracle_place_make(pair->body[0].solid, pair->body[1].solid, rotation);
    uint32_t count = pair->place->plane_count;
    pair->rank = oracle_new(count, sizeof *pair->rank);
    pair->order = oracle_new(count, sizeof *pair->order);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t at = i;
        pair->rank[i] = rank_of(pair, &pair->place->plane[i]);
        for (; at > 0 && ranks_before(pair->rank[i], pair->rank[pair->order[at - 1]]); at--)
            pair->order[at] = pair->order[at - 1];
        pair->order[at] = i;
    }
}

void exact_pair_leave(exact_pair *pair) {
    oracle_place_free(pair->place);
    free(pair->rank);
    free(pair->order);
}
