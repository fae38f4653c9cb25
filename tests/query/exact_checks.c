/* SPDX-License-Identifier: MIT */
/* See exact_checks.h: what single queries say of a pose. */
#include "query/exact_checks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "query/exact_report.h"

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

/* --- features --- */

static const pir_polytope *polytope_of(const exact_pair *pair, pir_operand operand) {
    return operand == PIR_OPERAND_P ? pair->p : pair->q;
}

static const oracle_solid *solid_of(const exact_pair *pair, pir_operand operand) {
    return operand == PIR_OPERAND_P ? pair->solid_p : pair->solid_q;
}

/*
 * The distance of the point that the oracle is set to from a part of one operand: about, then exactly where that leaves
 * it open.
 */
static double distance_of(exact_pair *pair, pir_operand operand, const oracle_set *set, double tolerance) {
    oracle_place *o = pair->place;
    const oracle_set *p = operand == PIR_OPERAND_P ? set : o->only_p, *q = operand == PIR_OPERAND_P ? o->only_q : set;
    double about = oracle_place_near(o, p, q);
    if (about <= 0.5 * tolerance && tolerance > 0)
        return about;
    if (about > 1e-13 * pair->size + 2 * tolerance)
        return about;
    return oracle_place_nearest(o, p, q).distance;
}

/* Whether the lesser face holds the point exactly. */
static int less_holds(exact_pair *pair, pir_operand operand, oracle_set *less, uint32_t i, uint32_t j) {
    memset(less, 0, solid_of(pair, operand)->words * sizeof *less);
    oracle_set_put(less, i);
    oracle_set_put(less, j);
    return distance_of(pair, operand, less, 0) == 0;
}

/* An edge or a vertex of the feature that holds the point exactly, into `less`; 0 when there is none. */
static int find_less(exact_pair *pair, pir_operand operand, pir_feature feature, const oracle_set *set,
                     oracle_set *less) {
    const oracle_solid *s = solid_of(pair, operand);
    for (uint32_t v = 0; feature.kind != PIR_FEATURE_VERTEX && v < s->count; v++)
        if (oracle_set_has(set, v) && less_holds(pair, operand, less, v, v))
            return 1;
    for (uint32_t e = 0; feature.kind == PIR_FEATURE_FACET && e < s->edge_count; e++)
        if (oracle_set_has(set, s->edge[e][0]) && oracle_set_has(set, s->edge[e][1]) &&
            less_holds(pair, operand, less, s->edge[e][0], s->edge[e][1]))
            return 1;
    return 0;
}

/* Whether bodies can meet, exactly, with a point of this face of the operand. */
static int can_meet_on(exact_pair *pair, pir_operand operand, const oracle_set *face, const exact_contact *contact) {
    oracle_place *o = pair->place;
    oracle_place_set(o, contact->t, contact->direction);
    if (contact->way == EXACT_NEAREST)
        oracle_place_to_nearest(o);
    else if (contact->way == EXACT_TO_PLANE)
        oracle_place_to_plane(o, contact->plane);
    else
        oracle_place_along_to_plane(o, contact->plane);
    return operand == PIR_OPERAND_P ? !oracle_place_nearest(o, face, NULL).apart
                                    : !oracle_place_nearest(o, NULL, face).apart;
}

void exact_check_holds(exact_pair *pair, pir_operand operand, pir_feature feature, pir_vec3 point,
                       const exact_contact *contact, double tolerance) {
    const oracle_solid *s = solid_of(pair, operand);
    const char *name = operand == PIR_OPERAND_P ? "P" : "Q";
    oracle_set *set = oracle_new(s->words, sizeof *set), *less = oracle_new(s->words, sizeof *less);
    oracle_place_set_point(pair->place, operand, point, contact->there);
    if (!oracle_solid_feature(s, polytope_of(pair, operand), feature, set)) {
        exact_check(EXACT_HOLDS, 0, "%s has no feature %d %u", name, (int)feature.kind, feature.index);
    } else {
        double away = distance_of(pair, operand, set, tolerance);
        exact_check(EXACT_HOLDS, away <= tolerance,
                    "point (%.17g, %.17g, %.17g) is %.3g of the size off feature %d %u of %s", point.x, point.y,
                    point.z, away / pair->size, (int)feature.kind, feature.index, name);
        int lies_on_less = away <= tolerance && find_less(pair, operand, feature, set, less);
        exact_check(EXACT_LEAST, !lies_on_less || !can_meet_on(pair, operand, less, contact),
                    "point (%.17g, %.17g, %.17g) is on a lesser face of feature %d %u of %s", point.x, point.y, point.z,
                    (int)feature.kind, feature.index, name);
    }
    oracle_place_set(pair->place, contact->t, contact->direction);
    free(less);
    free(set);
}

/* --- the tie rule --- */

static uint32_t members(const oracle_set *set, uint32_t words) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < words; i++)
        for (oracle_set bits = set[i]; bits; bits &= bits - 1)
            count++;
    return count;
}

/* Which way a facet of the operand faces in the difference, along `along`: in doubles, far from 0. */
static int faces(const exact_pair *pair, pir_operand operand, uint32_t facet, const double along[3]) {
    const pir_polytope *polytope = polytope_of(pair, operand);
    double(*near)[3] = operand == PIR_OPERAND_P ? pair->place->near_a : pair->place->near_b, height = 0;
    uint32_t size = pir_polytope_facet_size(polytope, facet), *corner = oracle_new(size, sizeof *corner);
    pir_polytope_facet(polytope, facet, corner);
    for (uint32_t i = 0; i < size; i++) {
        const double *x = near[corner[i]], *y = near[corner[(i + 1) % size]];
        height += along[0] * (x[1] * y[2] - x[2] * y[1]) + along[1] * (x[2] * y[0] - x[0] * y[2]) +
                  along[2] * (x[0] * y[1] - x[1] * y[0]);
    }
    free(corner);
    return operand == PIR_OPERAND_P ? height < 0 : height > 0;
}

/*
 * The index of the feature that is exactly the set, by the polytope's own numbers; of a polygon's two facets the one
 * that faces `along`.
 */
static uint32_t index_of(const exact_pair *pair, pir_operand operand, pir_feature_kind kind, const oracle_set *set,
                         const double along[3]) {
    const oracle_solid *s = solid_of(pair, operand);
    uint32_t features = kind == PIR_FEATURE_VERTEX ? s->count
                        : kind == PIR_FEATURE_EDGE ? s->edge_count
                                                   : s->facet_count;
    oracle_set *other = oracle_new(s->words, sizeof *other);
    uint32_t found = UINT32_MAX;
    for (uint32_t i = 0; i < features && found == UINT32_MAX; i++) {
        oracle_solid_feature(s, polytope_of(pair, operand), (pir_feature){kind, i}, other);
        if (memcmp(other, set, s->words * sizeof *set) == 0 &&
            (kind != PIR_FEATURE_FACET || s->dimension > 2 || faces(pair, operand, i, along)))
            found = i;
    }
    free(other);
    return found;
}

/* The rank of a plane by the tie rule: fv, vf, ee; then the lower index of P, then of Q. */
struct rank {
    uint32_t kind, p, q;
};

static int ranks_before(struct rank a, struct rank b) {
    if (a.kind != b.kind)
        return a.kind < b.kind;
    return a.p != b.p ? a.p < b.p : a.q < b.q;
}

/* 0 where its rank depends on how the perturbation cuts it to pieces. */
static int find_rank(const exact_pair *pair, const oracle_plane *plane, struct rank *ret_rank) {
    uint32_t in_p = members(plane->p, pair->solid_p->words), in_q = members(plane->q, pair->solid_q->words);
    if (in_p > 2) {
        *ret_rank = (struct rank){0, index_of(pair, PIR_OPERAND_P, PIR_FEATURE_FACET, plane->p, plane->near), 0};
        return 1;
    }
    if (in_q > 2) {
        *ret_rank = (struct rank){1, index_of(pair, PIR_OPERAND_P, PIR_FEATURE_VERTEX, plane->p, plane->near),
                                  index_of(pair, PIR_OPERAND_Q, PIR_FEATURE_FACET, plane->q, plane->near)};
        return in_p == 1;
    }
    *ret_rank = (struct rank){2, index_of(pair, PIR_OPERAND_P, PIR_FEATURE_EDGE, plane->p, plane->near),
                              index_of(pair, PIR_OPERAND_Q, PIR_FEATURE_EDGE, plane->q, plane->near)};
    return 1;
}

static double turn_from(const oracle_plane *plane, pir_vec3 normal) {
    return exact_length((pir_vec3){normal.x - plane->near[0], normal.y - plane->near[1], normal.z - plane->near[2]});
}

/* The plane whose normal is the nearest. */
static uint32_t plane_of(const oracle_place *o, pir_vec3 normal) {
    uint32_t best = 0;
    for (uint32_t i = 1; i < o->plane_count; i++)
        if (turn_from(&o->plane[i], normal) < turn_from(&o->plane[best], normal))
            best = i;
    return best;
}

/* The normal of a depth is that of the facet which the rule puts first among those that tie. */
static void check_tie(const exact_pair *pair, uint32_t deepest, const pir_query_result *r) {
    const oracle_place *o = pair->place;
    double least = oracle_place_slack(o, deepest), apart = HUGE_VAL;
    struct rank best = {3, 0, 0};
    uint32_t first = deepest, tied = 0;
    int open = 0, open_solid = 0;
    for (uint32_t i = 0; i < o->plane_count; i++) {
        struct rank rank;
        double over = (oracle_place_slack(o, i) - least) / pair->size;
        if (over > 1e-11)
            continue;
        apart = fmin(apart, turn_from(&o->plane[i], r->normal));
        if (over > 1e-14)
            open = 1;
        tied++;
        if (!find_rank(pair, &o->plane[i], &rank))
            open_solid = 1;
        else if (ranks_before(rank, best)) {
            best = rank;
            first = i;
        }
    }
    exact_check(EXACT_NORMAL, apart <= 1e-12, "the normal of depth is %.3g off every facet's that is near the least",
                apart);
    if (!open && !(open_solid && best.kind > 0) && tied > 1)
        exact_check(
            EXACT_TIE, turn_from(&o->plane[first], r->normal) <= 1e-14,
            "of %u facets that tie, kind %u (%u, %u) of normal (%g, %g, %g) is first, not that of (%g, %g, %g), "
            "whose witness is %d %u, %d %u (%.3g of the size over the least)",
            tied, best.kind, best.p, best.q, o->plane[first].near[0], o->plane[first].near[1], o->plane[first].near[2],
            r->normal.x, r->normal.y, r->normal.z, (int)r->witness.p.kind, r->witness.p.index, (int)r->witness.q.kind,
            r->witness.q.index, (oracle_place_slack(o, first) - least) / pair->size);
}

/* --- a pose --- */

int exact_same_bits(const pir_query_result *a, const pir_query_result *b) {
    return a->state == b->state && a->outcome == b->outcome &&
           memcmp(&a->distance, &b->distance, sizeof a->distance) == 0 &&
           memcmp(&a->normal, &b->normal, sizeof a->normal) == 0 &&
           memcmp(&a->point_p, &b->point_p, sizeof a->point_p) == 0 &&
           memcmp(&a->point_q, &b->point_q, sizeof a->point_q) == 0 &&
           memcmp(&a->witness, &b->witness, sizeof a->witness) == 0;
}

static void expect_same(const char *how, const pir_query_result *a, const pir_query_result *b) {
    exact_check(EXACT_CACHE, exact_same_bits(a, b),
                "%s: state %d %d, distance %.17g %.17g, normal (%.17g, %.17g, %.17g) (%.17g, %.17g, %.17g), point_p "
                "(%.17g, %.17g, %.17g) (%.17g, %.17g, %.17g), witness %d %u, %d %u and %d %u, %d %u",
                how, (int)a->state, (int)b->state, a->distance, b->distance, a->normal.x, a->normal.y, a->normal.z,
                b->normal.x, b->normal.y, b->normal.z, a->point_p.x, a->point_p.y, a->point_p.z, b->point_p.x,
                b->point_p.y, b->point_p.z, (int)a->witness.p.kind, a->witness.p.index, (int)a->witness.q.kind,
                a->witness.q.index, (int)b->witness.p.kind, b->witness.p.index, (int)b->witness.q.kind,
                b->witness.q.index);
}

static pir_query_cache some_cache(test_random *random) {
    uint32_t x[11];
    int small = (int)test_random_below(random, 2);
    for (int i = 0; i < 11; i++)
        x[i] = small ? test_random_below(random, 12) : (uint32_t)test_random_bits(random);
    return (pir_query_cache){.points = test_random_below(random, 5),
                             .p = {x[1], x[2], x[3]},
                             .q = {x[4], x[5], x[6]},
                             .pieces = test_random_below(random, 2),
                             .kind = test_random_below(random, 4),
                             .first = x[9],
                             .second = x[10]};
}

typedef pir_status ask(pir_query *, const pir_query_input *, pir_query_cache *, pir_query_result *);

static struct {
    const char *name;
    ask *call;
} const asks[4] = {{"signed distance", pir_query_signed_distance},
                   {"penetration", pir_query_penetration},
                   {"distance", pir_query_distance},
                   {"overlap", pir_query_overlap}};

/* Each query with no cache, the caller's, and any other, by a query with a history and one with less: all the same. */
static void ask_all_ways(exact_pair *pair, test_random *random, exact_pose *pose, pir_query_result *results) {
    for (int k = 0; k < 4; k++) {
        pir_query_result cold, other;
        pir_query_cache zero = {0}, any = some_cache(random);
        pir_status status = asks[k].call(pair->fresh, &pose->input, NULL, &cold);
        pose->limit |= status == PIR_ERR_LIMIT;
        exact_check(EXACT_STATE, status == PIR_OK || status == PIR_ERR_LIMIT, "%s: status %d", asks[k].name,
                    (int)status);
        if (status != PIR_OK)
            continue;
        results[k] = cold;
        asks[k].call(pair->query, &pose->input, &zero, &other);
        expect_same(asks[k].name, &cold, &other);
        asks[k].call(pair->query, &pose->input, &pair->cache, &other);
        expect_same(asks[k].name, &cold, &other);
        asks[k].call(pair->query, &pose->input, &any, &other);
        expect_same(asks[k].name, &cold, &other);
    }
}

/* What each call must say of a state. */
static void check_outcome(const char *name, const pir_query_result *r, pir_state state) {
    static const pir_outcome outcome[3] = {PIR_SEPARATED, PIR_TOUCHING, PIR_OVERLAPPING};
    exact_check(EXACT_STATE, r->state == state && r->outcome == outcome[state],
                "%s: state %d and outcome %d, state %d is right", name, (int)r->state, (int)r->outcome, (int)state);
}

static void check_points(exact_pair *pair, const exact_pose *pose, const pir_query_result *r) {
    double coordinates = fmax(pair->reach, fmax(exact_largest(pose->t), exact_largest(r->point_p)));
    pir_vec3 end = exact_add(r->point_q, r->normal, r->distance), miss = exact_add(r->point_p, end, -1);
    exact_check(EXACT_RELATION, exact_length(miss) <= 0x1p-50 * fmax(coordinates, fabs(r->distance)),
                "point_p is not point_q + distance · normal by %.3g of coordinates", exact_length(miss) / coordinates);
    exact_check(EXACT_NORMAL, fabs(exact_length(r->normal) - 1) <= 4e-15, "the normal's length is 1 + %.3g",
                exact_length(r->normal) - 1);
    exact_contact contact = {.t = pose->t, .direction = pose->direction, .there = pose->t};
    if (pose->state == PIR_INSIDE) {
        contact.way = EXACT_TO_PLANE;
        contact.plane = plane_of(pair->place, r->normal);
    }
    double tolerance = 0x1p-50 * coordinates + 1e-14 * pair->size;
    exact_check_holds(pair, PIR_OPERAND_P, r->witness.p, r->point_p, &contact, tolerance);
    exact_check_holds(pair, PIR_OPERAND_Q, r->witness.q, r->point_q, &contact, tolerance);
}

/* Overlap's normal, where there is one, is that of a facet which has t on its outer side. */
static void check_separating(exact_pair *pair, const pir_query_result *r) {
    if (exact_length(r->normal) == 0)
        return;
    double turn = turn_from(&pair->place->plane[plane_of(pair->place, r->normal)], r->normal);
    double reach = oracle_place_reach(pair->place, r->normal);
    exact_check(EXACT_NORMAL, reach <= 1e-15 * pair->size, "the difference reaches %.3g along overlap's normal", reach);
    exact_check(EXACT_NORMAL, pair->place->dimension < 3 || turn <= 1e-12, "overlap's normal is %.3g off every facet's",
                turn);
}

void exact_check_pose(exact_pair *pair, test_random *random, exact_pose *pose) {
    oracle_place *o = pair->place;
    pir_query_result r[4];
    oracle_place_set(o, pose->t, pose->direction);
    pose->state = oracle_place_state(o);
    ask_all_ways(pair, random, pose, r);
    if (pose->limit) {
        exact_check(EXACT_STATE, exact_largest(pose->t) > 0x1p390 * pair->size, "refused as too far");
        return;
    }
    pose->answer = r[0];
    if (pose->state != PIR_OUTSIDE)
        exact_check(EXACT_ORACLE, !oracle_place_nearest(o, NULL, NULL).apart,
                    "in no half-space's outside, but not in the hull");
    for (int k = 0; k < 4; k++)
        check_outcome(asks[k].name, &r[k], pose->state);
    pose->should = 0;
    if (pose->state == PIR_OUTSIDE) {
        oracle_nearest nearest = oracle_place_nearest(o, NULL, NULL);
        double scale = pair->size + nearest.distance;
        exact_check(EXACT_ORACLE, nearest.apart, "outside of a half-space, but in the hull");
        pose->should = nearest.distance;
        exact_number(EXACT_DISTANCE, "signed distance", r[0].distance, nearest.distance, scale);
        exact_number(EXACT_DISTANCE, "distance", r[2].distance, nearest.distance, scale);
        // as exact as points that are right can make it
        exact_number(EXACT_NORMAL, "separation's normal is off by",
                     exact_length(exact_add(r[0].normal, nearest.normal, -1)), 0, scale / nearest.distance);
        exact_check(EXACT_DEPTH, r[1].distance == 0, "penetration %.17g, not 0", r[1].distance);
        check_points(pair, pose, &r[2]);
        check_separating(pair, &r[3]);
    }
    if (pose->state == PIR_INSIDE) {
        uint32_t deepest = oracle_place_deepest(o);
        pose->should = -oracle_place_slack(o, deepest);
        exact_number(EXACT_DEPTH, "signed distance", r[0].distance, pose->should, pair->size);
        exact_number(EXACT_DEPTH, "penetration", r[1].distance, pose->should, pair->size);
        exact_check(EXACT_DISTANCE, r[2].distance == 0, "distance %.17g, not 0", r[2].distance);
        check_tie(pair, deepest, &r[0]);
        check_points(pair, pose, &r[1]);
    }
    if (pose->state == PIR_BOUNDARY) {
        exact_check(EXACT_DISTANCE, r[0].distance == 0 && r[1].distance == 0 && r[2].distance == 0,
                    "touching at %.17g, %.17g, %.17g, not 0", r[0].distance, r[1].distance, r[2].distance);
        exact_number(EXACT_NORMAL, "reach along the normal of touching", oracle_place_reach(o, r[0].normal), 0,
                     pair->size);
        check_points(pair, pose, &r[2]);
    }
    check_points(pair, pose, &r[0]);
}
