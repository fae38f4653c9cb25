/* SPDX-License-Identifier: MIT */
/*
 * Sweeps held against states at many times: poses on the way in long double, by sines and cosines, and all axes that
 * can separate two convex bodies tried. Where a sweep says that bodies share no point, all axes' greatest gap must be
 * above 0; where it says that they do, below. Turns and ways that are screws are held against exact first contacts too.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pair.h>
#include <pirouette/pose.h>
#include <pirouette/sweep.h>

#include "support/bodies.h"
#include "support/memory.h"

#define SAMPLES  48
#define MOST     64
#define ON_CURVE 1e-15L /* long doubles of poses and gaps are this near, relative to size */

typedef long double number;

typedef struct vector {
    number x, y, z;
} vector;

typedef struct quaternion {
    vector v;
    number w;
} quaternion;

static struct { uint32_t free, meets, ends, undecided, tied, budget, queries, most, open, exact; } seen;
static double widest;

/* --- the oracle --- */

static vector scaled(vector a, number s) {
    return (vector){a.x * s, a.y * s, a.z * s};
}

static vector plus(vector a, vector b) {
    return (vector){a.x + b.x, a.y + b.y, a.z + b.z};
}

static vector minus(vector a, vector b) {
    return plus(a, scaled(b, -1));
}

static number dot(vector a, vector b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vector cross(vector a, vector b) {
    return (vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static number length(vector a) {
    return sqrtl(dot(a, a));
}

static quaternion unit_of(pir_quat q) {
    const number n = sqrtl((number)q.x * q.x + (number)q.y * q.y + (number)q.z * q.z + (number)q.w * q.w);
    return (quaternion){{q.x / n, q.y / n, q.z / n}, q.w / n};
}

static quaternion times(quaternion a, quaternion b) {
    return (quaternion){plus(plus(scaled(b.v, a.w), scaled(a.v, b.w)), cross(a.v, b.v)), a.w * b.w - dot(a.v, b.v)};
}

static vector turned(quaternion q, vector x) {
    const vector inner = plus(cross(q.v, x), scaled(x, q.w));
    return plus(x, scaled(cross(q.v, inner), 2));
}

/* A body on its way. */
typedef struct mover {
    const pir_polytope *body;
    pir_pose pose[2];
    const pir_exact_motion *screw; /* in place of the second pose, or NULL */
    uint32_t vertices, edges, facets;
    vector vertex[MOST], edge[2 * MOST], normal[MOST]; /* at the time at hand */
} mover;

/* Rotation and translation at a time: the relative turn, of the shorter way, by a part of its angle after the first. */
static quaternion between(const mover *m, number time, vector *ret_translation) {
    const quaternion a = unit_of(m->pose[0].rotation), b = unit_of(m->pose[1].rotation);
    quaternion part = times((quaternion){scaled(a.v, -1), a.w}, b);
    // aligned quaternions are of small integers, and in others nothing is that near to a half turn
    if (fabsl(part.w) < 1e-17L)
        part.w = 0;
    const number order[4] = {part.w, part.v.x, part.v.y, part.v.z};
    int k = 0;
    while (k < 3 && fabsl(order[k]) < 1e-17L)
        k++;
    if (order[k] < 0)
        part = (quaternion){scaled(part.v, -1), -part.w};
    const number sine = length(part.v), half = atan2l(sine, part.w) * time;
    part = (quaternion){scaled(part.v, sine > 0 ? sinl(half) / sine : 0), cosl(half)};
    const quaternion q = times(a, part);
    const pir_vec3 s = m->pose[0].translation, e = m->pose[1].translation;
    *ret_translation =
        (vector){s.x + time * ((number)e.x - s.x), s.y + time * ((number)e.y - s.y), s.z + time * ((number)e.z - s.z)};
    return q;
}

/* Rotation and translation at a time of a screw. */
static quaternion screwed(const mover *m, number time, vector *ret_translation) {
    const pir_exact_motion *s = m->screw;
    const vector axis = {s->axis.x, s->axis.y, s->axis.z}, pivot = {s->pivot.x, s->pivot.y, s->pivot.z};
    const number half = time * s->degrees * (3.14159265358979323846264338L / 360);
    const quaternion q = unit_of(m->pose[0].rotation);
    const pir_vec3 from = m->pose[0].translation;
    vector t = {from.x, from.y, from.z};
    quaternion part = {{0, 0, 0}, 1};
    if (s->degrees != 0) {
        part = (quaternion){scaled(axis, sinl(half) / length(axis)), cosl(half)};
        t = plus(pivot, turned(part, minus(t, pivot)));
    }
    *ret_translation = plus(t, scaled((vector){s->way.x, s->way.y, s->way.z}, time));
    return times(part, q);
}

/* A body at a time. */
static void place(mover *m, number time) {
    vector t;
    const quaternion q = m->screw ? screwed(m, time, &t) : between(m, time, &t);
    m->vertices = pir_polytope_vertex_count(m->body);
    m->edges = pir_polytope_edge_count(m->body);
    m->facets = pir_polytope_facet_count(m->body);
    assert_true(m->vertices <= MOST && m->edges <= 2 * MOST && m->facets <= MOST);
    for (uint32_t i = 0; i < m->vertices; i++) {
        const pir_vec3 v = pir_polytope_vertex(m->body, i);
        m->vertex[i] = plus(turned(q, (vector){v.x, v.y, v.z}), t);
    }
    for (uint32_t i = 0; i < m->edges; i++) {
        uint32_t end[2];
        pir_polytope_edge(m->body, i, end);
        m->edge[i] = minus(m->vertex[end[1]], m->vertex[end[0]]);
    }
    for (uint32_t i = 0; i < m->facets; i++) {
        uint32_t loop[MOST];
        pir_polytope_facet(m->body, i, loop);
        m->normal[i] =
            cross(minus(m->vertex[loop[1]], m->vertex[loop[0]]), minus(m->vertex[loop[2]], m->vertex[loop[0]]));
    }
}

/* How wide the bodies are apart along an axis, whichever way. */
static number gap_along(const mover *p, const mover *q, vector axis) {
    const number size = length(axis);
    if (!(size > 1e-15L))
        return -INFINITY;
    number low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    const mover *const both[2] = {p, q};
    for (int k = 0; k < 2; k++)
        for (uint32_t i = 0; i < both[k]->vertices; i++) {
            const number h = dot(axis, both[k]->vertex[i]) / size;
            low[k] = fminl(low[k], h);
            high[k] = fmaxl(high[k], h);
        }
    return fmaxl(low[0] - high[1], low[1] - high[0]);
}

/* The greatest gap of all axes at a time: above 0 apart, below 0 overlapping, and then minus the depth. */
static number gap_at(mover *p, mover *q, number time) {
    number most = -INFINITY;
    place(p, time);
    place(q, time);
    for (uint32_t i = 0; i < p->facets; i++)
        most = fmaxl(most, gap_along(p, q, p->normal[i]));
    for (uint32_t i = 0; i < q->facets; i++)
        most = fmaxl(most, gap_along(p, q, q->normal[i]));
    for (uint32_t i = 0; i < p->edges; i++)
        for (uint32_t j = 0; j < q->edges; j++)
            most = fmaxl(most, gap_along(p, q, cross(p->edge[i], q->edge[j])));
    return most;
}

/* --- motions --- */

static pir_polytope *random_body(test_random *random) {
    static const test_body kinds[] = {TEST_BOX, TEST_OCTAHEDRON, TEST_GRID, TEST_SPHERE, TEST_BOX};
    for (;;) {
        const test_body kind = kinds[test_random_below(random, sizeof kinds / sizeof *kinds)];
        pir_polytope *body = test_random_polytope(random, kind, 4 + test_random_below(random, 4));
        if (pir_polytope_dimension(body) == 3)
            return body;
        pir_polytope_release(body);
    }
}

static pir_quat random_turn(test_random *random, bool aligned) {
    static const pir_quat even[] = {{0, 0, 0, 1}, {0, 0, 1, 1}, {1, 0, 0, -1},
                                    {0, 1, 0, 0}, {1, 1, 1, 1}, {0, 0, -3, 0}};
    if (aligned)
        return even[test_random_below(random, 6)];
    const pir_vec3 v = test_random_direction(random);
    return (pir_quat){v.x, v.y, v.z, test_random_unit(random)};
}

static pir_vec3 random_place(test_random *random, bool aligned, double size) {
    if (aligned)
        return (pir_vec3){0.5 * test_random_between(random, -10, 10), 0.5 * test_random_between(random, -10, 10),
                          0.5 * test_random_between(random, -10, 10)};
    const pir_vec3 v = test_random_direction(random);
    const double s = size * (1 + test_random_unit(random));
    return (pir_vec3){s * v.x, s * v.y, s * v.z};
}

/* Puts P above Q, which is at the origin, at a distance down to nothing. */
static void put_above(test_random *random, mover *p, mover *q) {
    const double above = test_random_below(random, 4) == 0 ? 0 : ldexp(1, -test_random_between(random, 0, 45));
    q->pose[1] = q->pose[0] = (pir_pose){{0, 0, 0, 1}, {0, 0, 0}};
    double top = -HUGE_VAL, bottom = HUGE_VAL;
    for (uint32_t i = 0; i < pir_polytope_vertex_count(q->body); i++)
        top = fmax(top, pir_polytope_vertex(q->body, i).z);
    for (uint32_t i = 0; i < pir_polytope_vertex_count(p->body); i++)
        bottom = fmin(bottom, pir_pose_rotate(p->pose[0], pir_polytope_vertex(p->body, i)).z);
    p->pose[0].translation.z = p->pose[1].translation.z = top - bottom + above;
}

/* Poses, of some kinds: any; turns alone; ways alone; both alike; small motions; sliding just above; far away. */
static void random_motion(test_random *random, mover *p, mover *q) {
    const bool aligned = test_random_below(random, 3) == 0;
    const uint32_t kind = test_random_below(random, 7);
    mover *const both[2] = {p, q};
    for (int k = 0; k < 2; k++)
        for (int end = 0; end < 2; end++) {
            pir_pose *pose = &both[k]->pose[end];
            *pose = (pir_pose){random_turn(random, aligned), random_place(random, aligned, k == 0 ? 5 : 1)};
            if (kind == 6)
                pose->translation.y += 0x1p20;
            if (end == 1 && kind == 1)
                pose->translation = both[k]->pose[0].translation;
            if (end == 1 && (kind == 2 || kind == 5))
                pose->rotation = both[k]->pose[0].rotation;
        }
    const pir_vec3 a = p->pose[0].translation, b = q->pose[0].translation, step = random_place(random, aligned, 4);
    if (kind == 3) { // both go alike
        p->pose[1].translation = (pir_vec3){a.x + step.x, a.y + step.y, a.z + step.z};
        q->pose[1].translation = (pir_vec3){b.x + step.x, b.y + step.y, b.z + step.z};
    }
    if (kind == 4) { // a small motion of one that turns little
        p->pose[1].translation = (pir_vec3){a.x + step.x / 16, a.y + step.y / 16, a.z + step.z / 16};
        const pir_quat r = p->pose[0].rotation;
        p->pose[1].rotation = (pir_quat){r.x + step.y / 64, r.y, r.z - step.x / 64, r.w};
    }
    if (kind == 5)
        put_above(random, p, q);
}

static double size_of(const mover *p, const mover *q) {
    const pir_exact_motion *s = p->screw;
    double size =
        s ? fabs(s->pivot.x) + fabs(s->pivot.y) + fabs(s->pivot.z) + fabs(s->way.x) + fabs(s->way.y) + fabs(s->way.z)
          : 0;
    const mover *const both[2] = {p, q};
    for (int k = 0; k < 2; k++) {
        for (int end = 0; end < 2; end++) {
            const pir_vec3 t = both[k]->pose[end].translation;
            size += fabs(t.x) + fabs(t.y) + fabs(t.z);
        }
        double most = 0;
        for (uint32_t i = 0; i < pir_polytope_vertex_count(both[k]->body); i++) {
            const pir_vec3 v = pir_polytope_vertex(both[k]->body, i);
            most = fmax(most, fabs(v.x) + fabs(v.y) + fabs(v.z));
        }
        size += most;
    }
    return s ? size * fmax(1, ceil(fabs(s->degrees) / 180)) : size;
}

/* --- the check --- */

static pir_pair_input input_at(const mover *p, const mover *q, int end) {
    pir_pair_input input = pir_pair_input_default();
    input.pose_p = p->pose[end];
    input.pose_q = q->pose[end];
    return input;
}

/*
 * Turns alone and ways alone have exact first contacts, at the same fractions. So have screws that hardly turn, but for
 * a part of the way far below what sweeps decide.
 */
static void check_exact(pir_pair *pair, pir_workspace *workspace, const mover *p, const pir_pair_input *input,
                        const pir_sweep_result *sweep, uint64_t number_of_case) {
    const pir_exact_motion *s = p->screw;
    const bool goes = s->way.x != 0 || s->way.y != 0 || s->way.z != 0;
    const bool hardly = fabs(s->degrees) < 1e-4 && fabs(s->degrees) > 0x1p-20;
    if (fabs(s->degrees) > 360 || (goes && s->degrees != 0 && !hardly))
        return;
    pir_exact_impact exact;
    assert_int_equal(pir_pair_impact(pair, workspace, input, s, &exact), PIR_OK);
    const bool free = exact.impact.outcome == PIR_CAST_MISS || exact.impact.outcome == PIR_CAST_AT_REST;
    const bool late = exact.impact.outcome == PIR_CAST_HIT && exact.impact.time > 0;
    seen.exact++;
    expect(sweep->outcome == PIR_SWEEP_UNDECIDED || free == (sweep->outcome == PIR_SWEEP_FREE),
           "case %llu: outcome %d where the exact one is %d", (unsigned long long)number_of_case, sweep->outcome,
           exact.impact.outcome);
    expect(!late || (sweep->from < exact.impact.time + 2e-9 && exact.impact.time <= sweep->to),
           "case %llu: %.17g to %.17g, the exact contact at %.17g", (unsigned long long)number_of_case, sweep->from,
           sweep->to, exact.impact.time);
}

static pir_status sweep_by(pir_pair *pair, pir_workspace *workspace, const mover *p, const mover *q, uint32_t budget,
                           pir_sweep_result *ret_sweep) {
    const pir_pair_input first = input_at(p, q, 0), second = input_at(p, q, 1);
    return p->screw ? pir_pair_sweep_screw(pair, workspace, &first, p->screw, budget, ret_sweep)
                    : pir_pair_sweep(pair, workspace, &first, &second, budget, ret_sweep);
}

/* The same rotation. */
static pir_quat other_sign(pir_quat q) {
    return (pir_quat){-2 * q.x, -2 * q.y, -2 * q.z, -2 * q.w};
}

static pir_sweep_result sweep_of(const mover *p, const mover *q, uint32_t budget, uint64_t number_of_case) {
    pir_polytope *own = pir_polytope_retain((pir_polytope *)(uintptr_t)p->body),
                 *other = pir_polytope_retain((pir_polytope *)(uintptr_t)q->body);
    pir_pair *pair;
    pir_workspace *workspace;
    assert_int_equal(pir_pair_create(own, other, NULL, &pair), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    pir_sweep_result sweep, again;
    assert_int_equal(sweep_by(pair, workspace, p, q, budget, &sweep), PIR_OK);
    mover same = *p;
    for (int k = 0; k < 2; k++)
        same.pose[k].rotation = other_sign(p->pose[k].rotation);
    assert_int_equal(sweep_by(pair, workspace, &same, q, budget, &again), PIR_OK);
    assert_true(again.outcome == sweep.outcome && again.from == sweep.from && again.to == sweep.to &&
                again.queries == sweep.queries);
    assert_true(sweep.queries <= (budget > 2 ? budget : budget == 0 ? PIR_SWEEP_BUDGET : 2));
    assert_true(0 <= sweep.from && sweep.from <= sweep.to && sweep.to <= 1);
    const pir_pair_input input = input_at(p, q, 0);
    if (p->screw)
        check_exact(pair, workspace, p, &input, &sweep, number_of_case);
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_polytope_release(own);
    pir_polytope_release(other);
    return sweep;
}

static void expect_apart(mover *p, mover *q, number low, number high, const pir_sweep_result *sweep,
                         uint64_t number_of_case) {
    for (int i = 0; i <= SAMPLES && low < high; i++) {
        const number time = low + (high - low) * i / SAMPLES, gap = gap_at(p, q, time);
        expect(gap > 0, "case %llu: outcome %d, %.17g to %.17g, at %.17Lg %Lg apart",
               (unsigned long long)number_of_case, sweep->outcome, sweep->from, sweep->to, time, gap);
    }
}

static void check_sweep(mover *p, mover *q, uint32_t budget, uint64_t number_of_case) {
    const pir_sweep_result sweep = sweep_of(p, q, budget, number_of_case);
    const double size = size_of(p, q);
    expect_apart(p, q, 0, sweep.from, &sweep, number_of_case);
    seen.queries += sweep.queries;
    seen.most = sweep.queries > seen.most ? sweep.queries : seen.most;
    const number at = gap_at(p, q, sweep.from);
    const bool spent = sweep.queries >= (budget > 0 ? budget : PIR_SWEEP_BUDGET);
    if (sweep.outcome == PIR_SWEEP_FREE) {
        seen.free++;
        assert_true(sweep.from == 1 && sweep.to == 1);
        return;
    }
    if (sweep.outcome == PIR_SWEEP_MEETS) {
        const number gap = gap_at(p, q, sweep.to);
        const bool is_end = sweep.to == 0 || sweep.to == 1;
        seen.meets++;
        seen.ends += is_end;
        expect(is_end ? gap <= ON_CURVE * size : gap < 0, "case %llu: meets at %.17g, %Lg apart",
               (unsigned long long)number_of_case, sweep.to, gap);
        widest = spent ? widest : fmax(widest, sweep.to - sweep.from);
    } else {
        seen.undecided++;
        seen.open += sweep.to < 1;
        seen.tied += !spent;
        expect_apart(p, q, nextafter(sweep.to, 2), 1, &sweep, number_of_case);
    }
    seen.budget += spent;
    expect(spent || at < 1e-10L * size, "case %llu: %Lg apart where the bound ends", (unsigned long long)number_of_case,
           at);
}

static uint32_t random_budget(test_random *random) {
    static const uint32_t budgets[] = {1, 3, 8, 40};
    return test_random_below(random, 8) > 0 ? 0 : budgets[test_random_below(random, 4)];
}

static void check_case(uint64_t number_of_case) {
    test_random random = test_random_case("sweep", number_of_case);
    mover p = {.body = NULL}, q = {.body = NULL};
    pir_polytope *own = random_body(&random), *other = random_body(&random);
    p.body = own;
    q.body = other;
    random_motion(&random, &p, &q);
    check_sweep(&p, &q, random_budget(&random), number_of_case);
    pir_polytope_release(own);
    pir_polytope_release(other);
}

/*
 * Screws, of some kinds: any; turns alone; ways alone; many turns; a pivot far away; along a side, at a distance down
 * to nothing, or down on it; hardly a turn. The axis is as long as it likes.
 */
static pir_exact_motion random_screw(test_random *random, mover *p, mover *q) {
    static const pir_vec3 axes[] = {{0, 0, 1}, {0, -1, 0}, {1, 1, 1}, {1, 0x1p-30, 0}};
    const bool aligned = test_random_below(random, 3) == 0;
    const uint32_t kind = test_random_below(random, 7);
    const double length = ldexp(1, 10 * (test_random_between(random, -30, 30)));
    pir_vec3 axis = aligned ? axes[test_random_below(random, 4)] : test_random_direction(random);
    axis = (pir_vec3){length * axis.x, length * axis.y, length * axis.z};
    pir_exact_motion s = {.pivot = random_place(random, aligned, 3),
                          .axis = axis,
                          .degrees = aligned ? 45 * test_random_between(random, -7, 7) : 360 * test_random_unit(random),
                          .way = random_place(random, aligned, 4)};
    p->pose[0] = (pir_pose){random_turn(random, aligned), random_place(random, aligned, 6)};
    q->pose[0] = (pir_pose){random_turn(random, aligned), random_place(random, aligned, 1)};
    if (kind == 1)
        s.way = (pir_vec3){0, 0, 0};
    if (kind == 2)
        s.degrees = 0;
    if (kind == 3)
        s.degrees *= 10;
    if (kind == 4)
        s.pivot.y += 0x1p20;
    if (kind == 5) {
        put_above(random, p, q);
        s.axis = (pir_vec3){0, 0, length};
        s.way.z = test_random_below(random, 2) == 0 ? 0 : s.way.z;
    }
    if (kind == 6)
        s.degrees = ldexp(s.degrees, -22);
    p->pose[1] = p->pose[0];
    q->pose[1] = q->pose[0];
    return s;
}

static void check_screw(uint64_t number_of_case) {
    test_random random = test_random_case("sweep of a screw", number_of_case);
    mover p = {.body = NULL}, q = {.body = NULL};
    pir_polytope *own = random_body(&random), *other = random_body(&random);
    p.body = own;
    q.body = other;
    const pir_exact_motion screw = random_screw(&random, &p, &q);
    p.screw = &screw;
    check_sweep(&p, &q, random_budget(&random), number_of_case);
    pir_polytope_release(own);
    pir_polytope_release(other);
}

static void check_all(void check(uint64_t)) {
    const char *text = getenv("PIR_TEST_CASES");
    const uint64_t count = text ? strtoull(text, NULL, 10) : 1000;
    memset(&seen, 0, sizeof seen);
    widest = 0;
    for (uint64_t i = 0; i < count; i++)
        check(i);
    print_message("%u free, %u meet, %u of them known by an end alone, %u undecided, %u of them free after, %u "
                  "that touch; %u used their budget up; %.1f distances a motion, %u at most; contacts within %.2g; "
                  "%u against exact contacts\n",
                  seen.free, seen.meets, seen.ends, seen.undecided, seen.open, seen.tied, seen.budget,
                  (double)seen.queries / (double)count, seen.most, widest, seen.exact);
    assert_true(seen.free > 0 && seen.meets > seen.ends && seen.undecided > 0);
}

static void sweeps_are_never_wrong(void **state) {
    (void)state;
    check_all(check_case);
}

static void sweeps_of_screws_are_never_wrong(void **state) {
    (void)state;
    check_all(check_screw);
    assert_true(seen.exact > 0);
}

/* --- by hand --- */

typedef struct hand {
    pir_polytope *p, *q;
    pir_pair_input first, second;
    uint32_t budget;
} hand;

static hand by_hand(pir_polytope *p, pir_polytope *q) {
    return (hand){p, q, pir_pair_input_default(), pir_pair_input_default(), 0};
}

/* P goes from x0 to x1 at a height y. */
static void go_along(hand *h, double x0, double x1, double y) {
    h->first.pose_p.translation = (pir_vec3){x0, y, 0};
    h->second.pose_p.translation = (pir_vec3){x1, y, 0};
}

/* Sweeps along a screw of P, or from the first placement to the second where there is none. */
static pir_sweep_result ask_screw(const hand *h, const pir_exact_motion *screw, pir_status expected) {
    pir_pair *pair;
    pir_workspace *workspace;
    pir_sweep_result sweep = {.from = -1};
    assert_int_equal(pir_pair_create(h->p, h->q, NULL, &pair), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    const pir_status status = screw ? pir_pair_sweep_screw(pair, workspace, &h->first, screw, h->budget, &sweep)
                                    : pir_pair_sweep(pair, workspace, &h->first, &h->second, h->budget, &sweep);
    assert_int_equal(status, expected);
    assert_true(expected == PIR_OK || sweep.from == -1);
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    return sweep;
}

static pir_sweep_result ask(const hand *h, pir_status expected) {
    return ask_screw(h, NULL, expected);
}

static void outcomes_known_by_hand(void **state) {
    (void)state;
    pir_polytope *cube = test_box(1, 1, 1);
    hand h = by_hand(cube, cube);
    go_along(&h, -5, 5, 2.25);
    assert_int_equal(ask(&h, PIR_OK).outcome, PIR_SWEEP_FREE);
    go_along(&h, -5, 5, 1.75);
    pir_sweep_result sweep = ask(&h, PIR_OK);
    assert_int_equal(sweep.outcome, PIR_SWEEP_MEETS);
    assert_true(sweep.from <= 0.3 && sweep.to >= 0.3 && sweep.to - sweep.from < 1e-10);
    // a side along a side is what is not told, but for that the way there is free
    go_along(&h, -5, 5, 2);
    sweep = ask(&h, PIR_OK);
    assert_int_equal(sweep.outcome, PIR_SWEEP_UNDECIDED);
    assert_true(sweep.from <= 0.3 && sweep.from > 0.3 - 1e-9 && sweep.to >= 0.7 && sweep.to < 1);
    // touching ends, and rest
    go_along(&h, -5, -2, 0);
    sweep = ask(&h, PIR_OK);
    assert_true(sweep.outcome == PIR_SWEEP_MEETS && sweep.to == 1);
    go_along(&h, -2, -5, 0);
    sweep = ask(&h, PIR_OK);
    assert_true(sweep.outcome == PIR_SWEEP_MEETS && sweep.from == 0 && sweep.to == 0);
    go_along(&h, -2.0000000000000004, -2.0000000000000004, 0);
    assert_int_equal(ask(&h, PIR_OK).outcome, PIR_SWEEP_FREE);
    // both go alike
    go_along(&h, -3, 95, 0);
    h.second.pose_q.translation.x = 98;
    sweep = ask(&h, PIR_OK);
    assert_true(sweep.outcome == PIR_SWEEP_FREE && sweep.queries == 2);
    pir_polytope_release(cube);
}

/* A blade that turns comes down upon a plate, or by it, whatever it turns by: its way is proportional to the angle. */
static void screws_known_by_hand(void **state) {
    (void)state;
    pir_polytope *blade = test_box(4, 0.5, 0.5), *plate = test_box(8, 8, 0.5);
    hand h = by_hand(blade, plate);
    h.first.pose_p.translation = (pir_vec3){0, 0, 4};
    pir_exact_motion screw = {.axis = {0, 0, -3}, .pivot = {1, 1, 9}, .degrees = 1800, .way = {0, 0, -9}};
    pir_sweep_result sweep = ask_screw(&h, &screw, PIR_OK);
    assert_int_equal(sweep.outcome, PIR_SWEEP_MEETS);
    assert_true(sweep.from <= 1.0 / 3 && sweep.to >= 1.0 / 3 && sweep.to - sweep.from < 1e-9);
    screw.way.z = -2.75;
    assert_int_equal(ask_screw(&h, &screw, PIR_OK).outcome, PIR_SWEEP_FREE);
    // the end of a screw is at no double, so touching there is undecided
    screw.way.z = -3;
    sweep = ask_screw(&h, &screw, PIR_OK);
    assert_true(sweep.outcome == PIR_SWEEP_UNDECIDED && sweep.from > 1 - 1e-9 && sweep.to == 1);
    // at rest and at the start states are exact
    screw = (pir_exact_motion){.degrees = 0};
    assert_int_equal(ask_screw(&h, &screw, PIR_OK).outcome, PIR_SWEEP_FREE);
    h.first.pose_p.translation.z = 1;
    assert_int_equal(ask_screw(&h, &screw, PIR_OK).outcome, PIR_SWEEP_MEETS);
    screw = (pir_exact_motion){.axis = {0, 0, 1}, .degrees = 90, .way = {0, 0, 1}};
    sweep = ask_screw(&h, &screw, PIR_OK);
    assert_true(sweep.outcome == PIR_SWEEP_MEETS && sweep.to == 0);
    screw.degrees = 36001;
    ask_screw(&h, &screw, PIR_ERR_ARGUMENT);
    screw.degrees = NAN;
    ask_screw(&h, &screw, PIR_ERR_NOT_FINITE);
    screw.degrees = 90;
    screw.axis.z = 0;
    ask_screw(&h, &screw, PIR_ERR_ARGUMENT);
    screw.axis.z = 0x1p401;
    ask_screw(&h, &screw, PIR_ERR_LIMIT);
    screw.axis.z = 1;
    screw.pivot.x = 1e200;
    ask_screw(&h, &screw, PIR_ERR_LIMIT);
    pir_polytope_release(blade);
    pir_polytope_release(plate);
}

static void radii_count(void **state) {
    (void)state;
    pir_polytope *cube = test_box(1, 1, 1), *flat = test_box(1, 1, 0);
    hand h = by_hand(cube, cube);
    go_along(&h, -5, 5, 3);
    h.first.radius_p = 0.25;
    h.first.radius_q = 0.5;
    assert_int_equal(ask(&h, PIR_OK).outcome, PIR_SWEEP_FREE);
    h.first.radius_p = 0.625;
    assert_int_equal(ask(&h, PIR_OK).outcome, PIR_SWEEP_MEETS);
    h.first.radius_p = -1;
    ask(&h, PIR_ERR_ARGUMENT);
    // a flat body meets one that is not, and of two in a plane is told nothing
    h = by_hand(flat, cube);
    go_along(&h, -5, 5, 0.5);
    assert_int_equal(ask(&h, PIR_OK).outcome, PIR_SWEEP_MEETS);
    h = by_hand(flat, flat);
    go_along(&h, -5, 5, 0.5);
    const pir_sweep_result sweep = ask(&h, PIR_OK);
    assert_int_equal(sweep.outcome, PIR_SWEEP_UNDECIDED);
    assert_true(sweep.from <= 0.3 && sweep.to >= 0.7);
    pir_polytope_release(cube);
    pir_polytope_release(flat);
}

/* A bar that points along y turns by nearly half a turn about x, past a cube above, or the other way. */
static void the_shorter_way_is_decided_exactly(void **state) {
    (void)state;
    pir_polytope *bar = test_box_at(0.5, 2, 0.5, (pir_vec3){0, 2, 0}),
                 *cube = test_box_at(1, 1, 1, (pir_vec3){0, 0, 3});
    hand h = by_hand(bar, cube);
    h.first.pose_p.rotation = (pir_quat){0x1p-60, 0, 0, 1};
    static const double w[] = {-0x1p-60 + 0x1p-112, -0x1p-60, -0x1p-60 - 0x1p-112};
    for (int k = 0; k < 3; k++) {
        h.second.pose_p.rotation = (pir_quat){1, 0, 0, w[k]};
        // half a turn goes about the axis whose first component is positive
        assert_int_equal(ask(&h, PIR_OK).outcome, k < 2 ? PIR_SWEEP_MEETS : PIR_SWEEP_FREE);
        h.second.pose_p.rotation = (pir_quat){-7, 0, 0, -7 * w[k]};
        assert_int_equal(ask(&h, PIR_OK).outcome, k < 2 ? PIR_SWEEP_MEETS : PIR_SWEEP_FREE);
    }
    pir_polytope_release(bar);
    pir_polytope_release(cube);
}

static void a_budget_ends_undecided(void **state) {
    (void)state;
    // round about the other one
    pir_polytope *cube = test_box(1, 1, 1), *moon = test_box_at(1, 1, 1, (pir_vec3){4, 0, 0});
    hand h = by_hand(moon, cube);
    h.second.pose_p.rotation = (pir_quat){0, 0, 10, 1};
    const pir_sweep_result all = ask(&h, PIR_OK);
    assert_int_equal(all.outcome, PIR_SWEEP_FREE);
    assert_true(all.queries > 3);
    h.budget = all.queries - 1;
    const pir_sweep_result less = ask(&h, PIR_OK);
    assert_int_equal(less.outcome, PIR_SWEEP_UNDECIDED);
    assert_true(less.from > 0 && less.to == 1 && less.queries == h.budget);
    pir_polytope_release(cube);
    pir_polytope_release(moon);
}

static void bad_input_is_refused(void **state) {
    (void)state;
    pir_polytope *cube = test_box(1, 1, 1);
    hand h = by_hand(cube, cube);
    go_along(&h, -5, 5, NAN);
    ask(&h, PIR_ERR_NOT_FINITE);
    go_along(&h, -5, INFINITY, 0);
    ask(&h, PIR_ERR_NOT_FINITE);
    go_along(&h, -1e308, 1e308, 0);
    ask(&h, PIR_ERR_LIMIT);
    go_along(&h, -5, 1e300, 0);
    ask(&h, PIR_ERR_LIMIT);
    go_along(&h, -5, 5, 0);
    h.second.pose_q.rotation.w = 0;
    ask(&h, PIR_ERR_ZERO_QUATERNION);
    h.second.pose_q.rotation = (pir_quat){1e-300, 0, 1, 0};
    h.first.pose_q.rotation = (pir_quat){0, 1, 1e-300, 0};
    ask(&h, PIR_ERR_LIMIT);
    h.first.pose_q.rotation = (pir_quat){0, 0, 0, 1};
    h.second.pose_q.rotation.w = NAN;
    ask(&h, PIR_ERR_NOT_FINITE);
    pir_sweep_result sweep;
    assert_int_equal(pir_pair_sweep(NULL, NULL, NULL, NULL, 0, &sweep), PIR_ERR_ARGUMENT);
    pir_polytope_release(cube);
}

static void memory_that_fails_at_any_request_is_told(void **state) {
    (void)state;
    pir_polytope *p = test_box(1, 1, 1), *q = test_box(1, 2, 1);
    hand h = by_hand(p, q);
    go_along(&h, -5, 5, 1);
    h.second.pose_p.rotation = (pir_quat){0, 1, 1, 1};
    for (uint64_t at = 1, done = 0; !done; at++) {
        test_memory memory = {.fail_at = at};
        const pir_allocator allocator = test_allocator(&memory);
        pir_pair_options options = pir_pair_options_default();
        options.allocator = &allocator;
        pir_pair *pair = NULL;
        pir_workspace *workspace = NULL;
        pir_sweep_result sweep = {.from = -1};
        pir_status status = pir_workspace_create(&allocator, &workspace);
        if (status == PIR_OK)
            status = pir_pair_create(p, q, &options, &pair);
        if (status == PIR_OK)
            status = pir_pair_sweep(pair, workspace, &h.first, &h.second, 0, &sweep);
        done = memory.requests < at;
        assert_true(status == PIR_OK || (status == PIR_ERR_MEMORY && !done && sweep.from == -1));
        pir_pair_destroy(pair);
        pir_workspace_destroy(workspace);
        expect(memory.blocks == 0 && !memory.wrong_size && !memory.overrun, "request %llu", (unsigned long long)at);
    }
    pir_polytope_release(p);
    pir_polytope_release(q);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sweeps_are_never_wrong),
        cmocka_unit_test(sweeps_of_screws_are_never_wrong),
        cmocka_unit_test(screws_known_by_hand),
        cmocka_unit_test(outcomes_known_by_hand),
        cmocka_unit_test(radii_count),
        cmocka_unit_test(the_shorter_way_is_decided_exactly),
        cmocka_unit_test(a_budget_ends_undecided),
        cmocka_unit_test(bad_input_is_refused),
        cmocka_unit_test(memory_that_fails_at_any_request_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
