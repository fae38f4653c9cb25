/* SPDX-License-Identifier: MIT */
/*
 * See core_flight.h. The nearest points are sought while the polytope moves (van den Bergen, "Ray casting against
 * general convex objects", 2004): each step takes the point v of their difference nearest to 0 that is known, and the
 * supports along v. These make a plane between the bodies, down to which the polytope moves at once (parting.h); and
 * with v they make the next one. So a flight takes hardly more steps than one distance.
 *
 * Errors. Supports and v are off by less than 2^-44 of all sizes and coordinates, which is far below
 * PIR_CORE_ERROR of them; a body is as near as is asked for where v says so, and apart where a plane says so.
 */
#include "scene/query/core_flight.h"

#include "polytope/polytope.h"
#include "scene/world/core_simplex.h"

/* Few flights need more than ten; those that do not end are left to pairs. */
#define MOST_STEPS 48

/* Distances that count as none, relative to bodies and coordinates, and to the way of the farthest point in a turn. */
#define PIR_CORE_ERROR 1e-11
#define TURN_ERROR     0x1p-48

static double length(pir_vec3 v) {
    return sqrt(pir_vec_dot(v, v));
}

bool pir_core_flight_begin(pir_core_flight *flight, const pir_probe *probe, const pir_motion *motion,
                           double tolerance) {
    const pir_polytope *polytope = probe->extent.polytope;
    pir_rotation rotation;
    if (polytope->vertex_count > PIR_CORE_POINTS || motion->held > 0 ||
        pir_rotation_set(&rotation, probe->pose.rotation) != PIR_OK)
        return false;
    flight->polytope = polytope;
    flight->parted = (pir_parted){.point = polytope->vertex,
                                  .count = polytope->vertex_count,
                                  .radius = probe->radius,
                                  .reach = probe->extent.reach,
                                  .way = motion->way,
                                  .turn = motion->turn};
    flight->from = probe->pose;
    flight->tolerance = tolerance;
    flight->turns = motion->turn.x != 0 || motion->turn.y != 0 || motion->turn.z != 0;
    for (uint32_t v = 0; v < polytope->vertex_count; v++)
        flight->turned[v] = pir_mat_apply(&rotation.r, polytope->vertex[v]);
    return true;
}

/* The polytope and the triangle at a time. */
struct moment {
    const pir_core_flight *flight;
    const pir_core_target *target;
    const pir_vec3 *point; /* of the polytope, turned */
    pir_vec3 at;           /* its place */
    pir_pose pose;
    double time, until;
    double near, error; /* what has met; what counts as nothing */
    bool apart;         /* proven, at time 0 */
    pir_vec3 room[PIR_CORE_POINTS];
};

/* Supports along a unit direction, from the triangle to the polytope, and the gap between the rounded bodies there. */
static pir_core_supports supports_along(const struct moment *m, pir_vec3 n) {
    pir_core_supports s = pir_core_supports_along(m->point, m->flight->polytope->vertex_count, m->target->corner, n);
    s.gap += pir_vec_dot(n, m->at) - m->target->radius - m->flight->parted.radius;
    return s;
}

static pir_vec3 difference(const struct moment *m, uint32_t a, uint32_t b) {
    return pir_vec_sub(pir_vec_add(m->point[a], m->at), m->target->corner[b]);
}

static void put_in(const struct moment *m, pir_core_simplex *simplex, uint32_t a, uint32_t b) {
    simplex->corner[simplex->count++] = (pir_core_corner){difference(m, a, b), 1, a, b};
}

/* Moves the polytope down to the plane across n through a support of the triangle; false where it never comes there. */
static bool advance(struct moment *m, pir_vec3 n, const pir_core_supports *s) {
    const pir_core_flight *flight = m->flight;
    const pir_vec3 foot = pir_vec_add(pir_vec_add(m->target->corner[s->b], flight->from.translation),
                                      pir_vec_scale(n, m->target->radius));
    const pir_parting plane = {n, foot, 0.75 * m->near, 0.5 * m->near};
    m->time = pir_part_until(&flight->parted, &plane, m->pose, s->gap, m->time, m->until);
    if (!(m->time <= m->until))
        return false;
    m->at = pir_vec_scale(flight->parted.way, m->time);
    if (!flight->turns)
        return true;
    pir_rotation rotation;
    m->pose = pir_pose_integrate(flight->from, flight->parted.way, flight->parted.turn, m->time);
    (void)pir_rotation_set(&rotation, m->pose.rotation); // of length 1
    for (uint32_t v = 0; v < flight->polytope->vertex_count; v++)
        m->room[v] = pir_mat_apply(&rotation.r, flight->polytope->vertex[v]);
    m->point = m->room;
    return true;
}

/* --- features --- */

/* The vertices of one of the two bodies that hold its nearest point. */
struct held_by {
    uint32_t vertex[3];
    int count;
};

static struct held_by holders(const pir_core_simplex *simplex, bool of_triangle) {
    struct held_by held = {{0, 0, 0}, 0};
    for (int k = 0; k < simplex->count; k++) {
        const uint32_t v = of_triangle ? simplex->corner[k].b : simplex->corner[k].a;
        bool has = false;
        for (int i = 0; i < held.count; i++)
            has |= held.vertex[i] == v;
        if (!has)
            held.vertex[held.count++] = v;
    }
    return held;
}

/* Of a triangle as a polytope: vertices in their order, edges by their vertices, the front for facet 0. */
static pir_feature triangle_feature(const struct held_by *held, bool front) {
    if (held->count == 1)
        return (pir_feature){PIR_FEATURE_VERTEX, held->vertex[0]};
    if (held->count == 2)
        return (pir_feature){PIR_FEATURE_EDGE, held->vertex[0] + held->vertex[1] - 1};
    return (pir_feature){PIR_FEATURE_FACET, front ? 0 : 1};
}

static bool facet_has(const pir_polytope *p, uint32_t facet, uint32_t vertex) {
    for (uint32_t i = p->loop_start[facet]; i < p->loop_start[facet + 1]; i++)
        if (p->origin[p->loop[i]] == vertex)
            return true;
    return false;
}

/* The facet with all of the vertices that looks most along a direction; PIR_FEATURE_NONE where none has them. */
static pir_feature facet_of(const pir_polytope *p, const struct held_by *held, pir_vec3 along) {
    pir_feature found = {PIR_FEATURE_NONE, 0};
    double most = -HUGE_VAL;
    for (uint32_t h = p->ring_start[held->vertex[0]]; h < p->ring_start[held->vertex[0] + 1]; h++) {
        const uint32_t f = p->left[h];
        bool has = true;
        for (int k = 1; k < held->count; k++)
            has = has && facet_has(p, f, held->vertex[k]);
        const double height = pir_vec_dot(p->normal[f], along);
        if (has && height > most) {
            most = height;
            found = (pir_feature){PIR_FEATURE_FACET, f};
        }
    }
    return found;
}

static pir_feature polytope_feature(const pir_polytope *p, const struct held_by *held, pir_vec3 along) {
    if (held->count == 1)
        return (pir_feature){PIR_FEATURE_VERTEX, held->vertex[0]};
    for (uint32_t h = p->ring_start[held->vertex[0]]; held->count == 2 && h < p->ring_start[held->vertex[0] + 1]; h++)
        if (p->target[h] == held->vertex[1])
            return (pir_feature){PIR_FEATURE_EDGE, p->artificial ? 0 : p->edge[h]};
    return facet_of(p, held, along);
}

/* --- the end --- */

static pir_vec3 towards(pir_vec3 n, pir_vec3 v) {
    return pir_vec_scale(n, (pir_vec_dot(n, v) < 0 ? -1 : 1) / length(n));
}

/* The normal across the features that hold v, which has more bits than v itself has where that is short. */
static pir_vec3 normal_of(const struct moment *m, pir_vec3 v, const struct held_by *p, const struct held_by *q) {
    const pir_vec3 *c = m->target->corner;
    if (q->count == 3)
        return towards(pir_vec_cross(pir_vec_sub(c[1], c[0]), pir_vec_sub(c[2], c[0])), v);
    if (p->count != 2 || q->count != 2)
        return towards(v, v);
    const pir_vec3 e = pir_vec_sub(m->point[p->vertex[1]], m->point[p->vertex[0]]),
                   f = pir_vec_sub(c[q->vertex[1]], c[q->vertex[0]]), n = pir_vec_cross(e, f);
    return length(n) > 0x1p-20 * length(e) * length(f) ? towards(n, v) : towards(v, v);
}

static bool set_impact(const struct moment *m, const pir_core_simplex *simplex, pir_vec3 v, pir_core_impact *impact) {
    const struct held_by p = holders(simplex, false), q = holders(simplex, true);
    const pir_vec3 n = normal_of(m, v, &p, &q), *c = m->target->corner;
    pir_vec3 point = pir_vec_add(m->flight->from.translation, pir_vec_scale(n, m->target->radius));
    for (int k = 0; k < simplex->count; k++)
        point = pir_vec_add(point, pir_vec_scale(c[simplex->corner[k].b], simplex->corner[k].part));
    const pir_vec3 front = pir_vec_cross(pir_vec_sub(c[1], c[0]), pir_vec_sub(c[2], c[0]));
    const pir_vec3 along = pir_pose_rotate_inverse(m->pose, pir_vec_scale(n, -1));
    *impact = (pir_core_impact){true, m->time, n, point, {{PIR_FEATURE_NONE, 0}, {PIR_FEATURE_NONE, 0}}};
    impact->witness.p = polytope_feature(m->flight->polytope, &p, along);
    impact->witness.q = triangle_feature(&q, pir_vec_dot(front, n) > 0);
    return impact->witness.p.kind != PIR_FEATURE_NONE;
}

enum flight_step {
    FLIES_ON,
    PASSES,
    MEETS,
    UNSETTLED,
};

/* One step from the point v, of length d. */
static enum flight_step step_from(struct moment *m, pir_core_simplex *simplex, pir_vec3 v, double d) {
    const double away = d - m->target->radius - m->flight->parted.radius;
    if (!(d > 0))
        return UNSETTLED;
    const pir_vec3 n = pir_vec_scale(v, 1 / d);
    const pir_core_supports s = supports_along(m, n);
    m->apart = m->apart || s.gap > m->error;
    if (m->apart && away <= m->near)
        return MEETS;
    const bool advances = m->apart && s.gap > 0.75 * m->near, has = pir_core_simplex_has(simplex, s.a, s.b);
    if (advances && !advance(m, n, &s))
        return PASSES;
    for (int k = 0; advances && k < simplex->count; k++)
        simplex->corner[k].w = difference(m, simplex->corner[k].a, simplex->corner[k].b);
    if (!has)
        put_in(m, simplex, s.a, s.b);
    return has && !advances ? UNSETTLED : FLIES_ON;
}

/* The first plane is that of the triangle, and the first simplex the triangle seen from a support along its normal. */
static enum flight_step begin(struct moment *m, pir_core_simplex *simplex) {
    const pir_vec3 *c = m->target->corner, across = pir_vec_cross(pir_vec_sub(c[1], c[0]), pir_vec_sub(c[2], c[0]));
    const double square = pir_vec_dot(across, across);
    if (!(square > 0x1p-900))
        return UNSETTLED;
    pir_vec3 n = pir_vec_scale(across, 1 / sqrt(square));
    pir_core_supports s = supports_along(m, n);
    if (s.gap < 0) {
        const pir_vec3 back = pir_vec_scale(n, -1);
        const pir_core_supports behind = supports_along(m, back);
        n = behind.gap > s.gap ? back : n;
        s = behind.gap > s.gap ? behind : s;
    }
    m->apart = s.gap > m->error;
    if (m->apart && s.gap > 0.75 * m->near && !advance(m, n, &s))
        return PASSES;
    simplex->count = 0;
    for (uint32_t k = 0; k < 3; k++)
        put_in(m, simplex, s.a, k);
    return FLIES_ON;
}

bool pir_core_fly(const pir_core_flight *flight, const pir_core_target *target, double until,
                  pir_core_impact *ret_impact) {
    struct moment m;
    pir_core_simplex simplex;
    m.flight = flight;
    m.target = target;
    m.point = flight->turned;
    m.at = (pir_vec3){0, 0, 0};
    m.pose = flight->from;
    m.time = 0;
    m.until = until;
    m.error = PIR_CORE_ERROR * target->size + TURN_ERROR * length(flight->parted.turn) * flight->parted.reach;
    m.near = fmax(flight->tolerance, 4 * m.error);
    enum flight_step step = begin(&m, &simplex);
    for (int steps = 0; step == FLIES_ON && steps < MOST_STEPS; steps++) {
        const pir_vec3 v = pir_core_simplex_solve(&simplex);
        step = step_from(&m, &simplex, v, length(v));
        if (step == MEETS)
            return set_impact(&m, &simplex, v, ret_impact);
    }
    if (step == PASSES)
        *ret_impact = (pir_core_impact){.hits = false, .time = 1};
    return step == PASSES;
}
