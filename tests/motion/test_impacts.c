/* SPDX-License-Identifier: MIT */
/*
 * First contacts held against exact states. The bodies are placed anew as rational points about the pivot, so that a
 * quaternion (u, κ) of doubles is exactly P's rotation at κ. All planes of features, those of facets and those of two
 * edges, have their roots in doubles; between each two of them before the told κ the bodies must be apart, at the ends
 * of the told interval neither early nor late. Ways are held against casts, which compute otherwise. Of a screw Q is
 * placed anew for each state, where P would see it.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/exact.h>
#include <pirouette/pair.h>
#include <pirouette/pose.h>

#include "support/bodies.h"
#include "support/memory.h"

#define PI     3.14159265358979323846
#define DEGREE (180 / PI)

typedef struct hinge {
    pir_polytope *p, *q, *placed[2];
    pir_pair *pair, *pair_placed;
    pir_workspace *workspace;
    pir_pair_input input;
    pir_exact_motion motion;
    bool aligned, screws;
    double end_kappa; /* of a screw */
} hinge;

static struct { uint32_t hits, misses, receding, inside, from_start, grazes, roots, changes; } seen;

/* --- cases --- */

static pir_polytope *random_body(test_random *random, int least) {
    static const test_body kinds[] = {TEST_BOX, TEST_OCTAHEDRON, TEST_GRID, TEST_PRISM, TEST_SPHERE, TEST_POLYGON};
    for (;;) {
        const test_body kind = kinds[test_random_below(random, sizeof kinds / sizeof *kinds)];
        pir_polytope *body = test_random_polytope(random, kind, 4 + test_random_below(random, 5));
        if ((int)pir_polytope_dimension(body) >= least)
            return body;
        pir_polytope_release(body);
    }
}

static pir_vec3 grid_point(test_random *random, int size) {
    return (pir_vec3){0.5 * test_random_between(random, -2 * size, 2 * size),
                      0.5 * test_random_between(random, -2 * size, 2 * size),
                      0.5 * test_random_between(random, -2 * size, 2 * size)};
}

static pir_quat random_turn(test_random *random, bool aligned) {
    static const pir_quat even[] = {{0, 0, 0, 1}, {0, 0, 1, 1}, {1, 0, 0, 1}, {0, 1, 0, 0}, {1, 1, 1, 1}};
    if (aligned)
        return even[test_random_below(random, 5)];
    const pir_vec3 v = test_random_direction(random);
    return (pir_quat){v.x, v.y, v.z, test_random_unit(random)};
}

/* The body at a pose, relative to the pivot, without rounding. */
static pir_polytope *place(const pir_polytope *body, pir_pose pose, pir_vec3 pivot) {
    const uint32_t count = pir_polytope_vertex_count(body);
    mpq_t *at = calloc(3 * (size_t)count, sizeof *at), v[3], q[4], m[9], norm, a, b;
    const double given[4] = {pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w};
    const double move[3] = {pose.translation.x, pose.translation.y, pose.translation.z};
    const double back[3] = {pivot.x, pivot.y, pivot.z};
    mpq_inits(v[0], v[1], v[2], norm, a, b, NULL);
    for (int i = 0; i < 4; i++) {
        mpq_init(q[i]);
        mpq_set_d(q[i], given[i]);
        mpq_mul(a, q[i], q[i]);
        mpq_add(norm, norm, a);
    }
    // columns are q e_i q*: by Hamilton's product of e_i in the middle, r = 2 v (v·e) + (w² − v²) e + 2 w v × e
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            mpq_init(m[3 * j + i]);
            mpq_mul(m[3 * j + i], q[i], q[j]);
            if (i != j) {
                mpq_mul(a, q[3], q[3 - i - j]);
                if ((i + 1) % 3 == j)
                    mpq_add(m[3 * j + i], m[3 * j + i], a);
                else
                    mpq_sub(m[3 * j + i], m[3 * j + i], a);
            }
            mpq_add(m[3 * j + i], m[3 * j + i], m[3 * j + i]);
            if (i == j) {
                mpq_mul(a, q[3], q[3]);
                mpq_add(a, a, a);
                mpq_sub(a, a, norm);
                mpq_add(m[3 * j + i], m[3 * j + i], a);
            }
        }
    for (uint32_t i = 0; i < count; i++) {
        pir_polytope_vertex_exact(body, i, v);
        for (int j = 0; j < 3; j++) {
            mpq_t *c = &at[3 * (size_t)i + (size_t)j];
            mpq_init(*c);
            for (int k = 0; k < 3; k++) {
                mpq_mul(a, m[3 * j + k], v[k]);
                mpq_add(*c, *c, a);
            }
            mpq_div(*c, *c, norm);
            mpq_set_d(a, move[j]);
            mpq_add(*c, *c, a);
            mpq_set_d(a, back[j]);
            mpq_sub(*c, *c, a);
        }
    }
    pir_polytope *placed;
    assert_int_equal(pir_polytope_create_exact((const mpq_t *)at, count, NULL, &placed), PIR_OK);
    for (size_t i = 0; i < 3 * (size_t)count; i++)
        mpq_clear(at[i]);
    for (int i = 0; i < 9; i++)
        mpq_clear(m[i]);
    for (int i = 0; i < 4; i++)
        mpq_clear(q[i]);
    mpq_clears(v[0], v[1], v[2], norm, a, b, NULL);
    free(at);
    return placed;
}

/* Also goes, along the axis in half of the cases. */
static void make_screw(hinge *h, test_random *random) {
    pir_exact_motion *motion = &h->motion;
    const pir_vec3 u = motion->axis, t = h->input.pose_p.translation;
    motion->degrees = h->aligned ? 45 * test_random_between(random, 1, 3) : 1 + 175 * test_random_unit(random);
    motion->degrees *= test_random_below(random, 2) == 0 ? 1 : -1;
    const double by = h->aligned ? 0.5 * test_random_between(random, -8, 8) : 8 * test_random_unit(random) - 4;
    motion->way = (pir_vec3){by * u.x, by * u.y, by * u.z};
    if (test_random_below(random, 2) == 0)
        motion->way = h->aligned ? grid_point(random, 4) : (pir_vec3){-2 * t.x, by - t.y, -2 * t.z};
    if (motion->way.x == 0 && motion->way.y == 0 && motion->way.z == 0)
        motion->way = u;
    h->screws = true;
    const double tangent = fabs(motion->degrees) == 90 ? 1 : tan(fabs(motion->degrees) / DEGREE / 2);
    h->end_kappa = sqrt(u.x * u.x + u.y * u.y + u.z * u.z) / tangent;
}

static void make_hinge(hinge *h, test_random *random, bool screws) {
    h->screws = false;
    h->aligned = test_random_below(random, 3) == 0;
    h->p = random_body(random, 2);
    h->q = random_body(random, pir_polytope_dimension(h->p) == 3 ? 2 : 3);
    h->input = pir_pair_input_default();
    h->input.pose_p.rotation = random_turn(random, h->aligned);
    h->input.pose_q.rotation = random_turn(random, h->aligned);
    const double size = 1 + 3 * test_random_unit(random);
    h->input.pose_p.translation =
        h->aligned ? grid_point(random, 4) : pir_pose_apply(pir_pose_identity(), test_random_direction(random));
    if (!h->aligned) {
        pir_vec3 *t = &h->input.pose_p.translation;
        *t = (pir_vec3){t->x * 2 * size, t->y * 2 * size, t->z * 2 * size};
    }
    static const pir_vec3 even[] = {{0, 0, 1}, {1, 0, 0}, {0, -2, 0}, {1, 1, 1}, {1, -1, 0}};
    h->motion =
        (pir_exact_motion){.pivot = grid_point(random, 3),
                           .axis = h->aligned ? even[test_random_below(random, 5)] : test_random_direction(random),
                           .degrees = test_random_between(random, -4, 4) * 90};
    if (!h->aligned)
        h->motion.degrees = 360 * test_random_unit(random);
    // half of the time the turn leads onto Q
    if (test_random_below(random, 2) == 0) {
        const pir_vec3 t = h->input.pose_p.translation, off = grid_point(random, 1);
        h->motion.pivot = (pir_vec3){0.5 * t.x + 0.25 * off.x, 0.5 * t.y + 0.25 * off.y, 0.5 * t.z + 0.25 * off.z};
    }
    if (h->motion.degrees == 0)
        h->motion.degrees = 360;
    if (screws)
        make_screw(h, random);
    h->placed[0] = place(h->p, h->input.pose_p, h->motion.pivot);
    h->placed[1] = place(h->q, h->input.pose_q, h->motion.pivot);
    assert_int_equal(pir_pair_create(h->p, h->q, NULL, &h->pair), PIR_OK);
    assert_int_equal(pir_pair_create(h->placed[0], h->placed[1], NULL, &h->pair_placed), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &h->workspace), PIR_OK);
}

static void free_hinge(hinge *h) {
    pir_pair_destroy(h->pair);
    pir_pair_destroy(h->pair_placed);
    pir_workspace_destroy(h->workspace);
    for (int k = 0; k < 2; k++)
        pir_polytope_release(h->placed[k]);
    pir_polytope_release(h->p);
    pir_polytope_release(h->q);
}

/* --- exact states --- */

/* Q as P sees it, which has gone κ₁/κ of its way. */
static pir_polytope *seen_from_p(const hinge *h, double kappa) {
    const uint32_t count = pir_polytope_vertex_count(h->placed[1]);
    const double way[3] = {h->motion.way.x, h->motion.way.y, h->motion.way.z};
    mpq_t *at = calloc(3 * (size_t)count, sizeof *at), part, gone;
    mpq_inits(part, gone, NULL);
    mpq_set_d(part, h->end_kappa);
    mpq_set_d(gone, kappa);
    mpq_div(part, part, gone);
    for (uint32_t i = 0; i < count; i++) {
        mpq_t *c = &at[3 * (size_t)i];
        mpq_inits(c[0], c[1], c[2], NULL);
        pir_polytope_vertex_exact(h->placed[1], i, c);
        for (int j = 0; j < 3; j++) {
            mpq_set_d(gone, way[j]);
            mpq_mul(gone, gone, part);
            mpq_sub(c[j], c[j], gone);
        }
    }
    pir_polytope *q;
    assert_int_equal(pir_polytope_create_exact((const mpq_t *)at, count, NULL, &q), PIR_OK);
    for (size_t i = 0; i < 3 * (size_t)count; i++)
        mpq_clear(at[i]);
    mpq_clears(part, gone, NULL);
    free(at);
    return q;
}

static pir_state state_at(const hinge *h, double kappa) {
    pir_pair_input input = pir_pair_input_default();
    const pir_vec3 u = h->motion.axis;
    const double sign = h->motion.degrees < 0 ? -1 : 1;
    pir_pair *pair = h->pair_placed;
    const bool moves = h->screws && isfinite(kappa);
    if (isfinite(kappa))
        input.pose_p.rotation = (pir_quat){sign * u.x, sign * u.y, sign * u.z, kappa};
    if (moves) {
        pir_polytope *q = seen_from_p(h, kappa);
        assert_int_equal(pir_pair_create(h->placed[0], q, NULL, &pair), PIR_OK);
        pir_polytope_release(q);
    }
    pir_query_result result;
    assert_int_equal(pir_pair_overlap(pair, h->workspace, &input, &result), PIR_OK);
    if (moves)
        pir_pair_destroy(pair);
    return result.state;
}

/* --- all roots --- */

typedef struct roots {
    double *at;
    size_t count, room;
} roots;

static void add_root(roots *all, double theta) {
    if (all->count == all->room)
        all->at = realloc(all->at, (all->room = 2 * all->room + 64) * sizeof *all->at);
    all->at[all->count++] = theta;
}

/* Conditions are taken at four places: a screw's at these parts of the tangent of half of the angle at the end. */
#define PLACES 4

/* Roots of a cubic c[0] + c[1]·t + … from 0 to 1, between those of its derivatives; each is the tangent's part. */
static void add_cubic_roots(roots *all, const double c[4], double end) {
    double cuts[2][8] = {{0, 1}, {0}};
    int count = 2;
    for (int degree = 1; degree <= 3; degree++) {
        // the derivative of order 3 − degree
        double d[4] = {c[0], c[1], c[2], c[3]}, *from = cuts[(degree - 1) % 2], *to = cuts[degree % 2];
        for (int k = 3; k > degree; k--)
            for (int i = 0; i < k; i++)
                d[i] = (i + 1) * d[i + 1];
        for (int i = degree + 1; i < 4; i++)
            d[i] = 0;
        int found = 0;
        to[found++] = 0;
        for (int i = 0; i + 1 < count; i++) {
            double low = from[i], high = from[i + 1];
            for (int k = 0; k < 60; k++) {
                const double t = 0.5 * (low + high), at = d[0] + t * (d[1] + t * (d[2] + t * d[3]));
                const double first = d[0] + low * (d[1] + low * (d[2] + low * d[3]));
                *((at < 0) == (first < 0) ? &low : &high) = t;
            }
            // an end of the stretch where there is no root does no harm
            to[found++] = 0.5 * (low + high);
        }
        to[found++] = 1;
        count = found;
    }
    for (int i = 1; i + 1 < count; i++)
        add_root(all, 2 * atan(cuts[1][i] * tan(end / 2)));
}

/* Of a screw: by values at parts of the way to the end, times 1 + t². */
static void add_screw_roots(const hinge *h, roots *all, const double value[PLACES]) {
    const double end = fabs(h->motion.degrees) / DEGREE, most = tan(end / 2);
    double y[PLACES], c[4];
    for (int k = 0; k < PLACES; k++)
        y[k] = value[k] * (1 + k * most / 3 * k * most / 3);
    // differences of the four, at distances of a third
    const double d1 = y[1] - y[0], d2 = y[2] - 2 * y[1] + y[0], d3 = y[3] - 3 * y[2] + 3 * y[1] - y[0];
    c[0] = y[0];
    c[1] = 3 * (d1 - d2 / 2 + d3 / 3);
    c[2] = 9 * (d2 / 2 - d3 / 2);
    c[3] = 27 * d3 / 6;
    add_cubic_roots(all, c, end);
}

/* Of a turn: roots of A + B cos θ + C sin θ by its values at 0, 120 and 240 degrees. */
static void add_roots(const hinge *h, roots *all, const double value[PLACES]) {
    if (h->screws) {
        add_screw_roots(h, all, value);
        return;
    }
    const double a = (value[0] + value[1] + value[2]) / 3, b = value[0] - a;
    const double c = (value[1] - value[2]) / sqrt(3), r = hypot(b, c);
    if (r == 0 || fabs(a) > r * (1 + 1e-9))
        return;
    const double middle = atan2(c, b), off = acos(fmin(1, fmax(-1, -a / r)));
    for (int k = 0; k < 2; k++) {
        double theta = middle + (k == 0 ? off : -off);
        add_root(all, theta - 2 * PI * floor(theta / (2 * PI)));
    }
}

static double triple(pir_vec3 a, pir_vec3 b, pir_vec3 c) {
    return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
}

static pir_vec3 minus(pir_vec3 a, pir_vec3 b) {
    return (pir_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static pir_vec3 turned(const hinge *h, const pir_polytope *body, uint32_t v, bool turns, int third) {
    const pir_vec3 x = pir_polytope_vertex(body, v), u = h->motion.axis, w = h->motion.way;
    if (!turns || third == 0)
        return x;
    const double length = sqrt(u.x * u.x + u.y * u.y + u.z * u.z) * (h->motion.degrees < 0 ? -1 : 1);
    const double half = h->screws ? atan(third / 3.0 * tan(fabs(h->motion.degrees) / DEGREE / 2)) : third * PI / 3;
    const double s = sin(half) / length, c = cos(half), by = h->screws ? third / 3.0 : 0;
    return pir_pose_apply((pir_pose){{s * u.x, s * u.y, s * u.z, c}, {by * w.x, by * w.y, by * w.z}}, x);
}

static void add_planes(const hinge *h, roots *all, const pir_polytope *own, const pir_polytope *other, bool own_turns) {
    for (uint32_t f = 0; f < pir_polytope_facet_count(own); f++) {
        uint32_t loop[64];
        assert_true(pir_polytope_facet_size(own, f) <= 64);
        pir_polytope_facet(own, f, loop);
        for (uint32_t v = 0; v < pir_polytope_vertex_count(other); v++) {
            double value[PLACES];
            for (int k = 0; k < PLACES; k++) {
                const pir_vec3 a = turned(h, own, loop[0], own_turns, k), b = turned(h, own, loop[1], own_turns, k);
                const pir_vec3 c = turned(h, own, loop[2], own_turns, k), x = turned(h, other, v, !own_turns, k);
                value[k] = triple(minus(b, a), minus(c, a), minus(x, a));
            }
            add_roots(h, all, value);
        }
    }
}

static void add_edges(const hinge *h, roots *all) {
    const pir_polytope *p = h->placed[0], *q = h->placed[1];
    for (uint32_t e = 0; e < pir_polytope_edge_count(p); e++)
        for (uint32_t f = 0; f < pir_polytope_edge_count(q); f++) {
            uint32_t a[2], b[2];
            pir_polytope_edge(p, e, a);
            pir_polytope_edge(q, f, b);
            double value[PLACES];
            for (int k = 0; k < PLACES; k++) {
                const pir_vec3 x = turned(h, p, a[0], true, k), y = turned(h, q, b[0], false, k);
                value[k] =
                    triple(minus(turned(h, p, a[1], true, k), x), minus(turned(h, q, b[1], false, k), y), minus(x, y));
            }
            add_roots(h, all, value);
        }
}

static int by_size(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double kappa_of(const hinge *h, double theta) {
    const pir_vec3 u = h->motion.axis;
    return sqrt(u.x * u.x + u.y * u.y + u.z * u.z) / tan(theta / 2);
}

/* Before `least` the bodies are apart between all roots. */
static void expect_apart_before(const hinge *h, double least, double end, uint64_t number) {
    roots all = {0};
    add_planes(h, &all, h->placed[0], h->placed[1], true);
    add_planes(h, &all, h->placed[1], h->placed[0], false);
    add_edges(h, &all);
    qsort(all.at, all.count, sizeof *all.at, by_size);
    double before = 0;
    for (size_t i = 0; i <= all.count; i++) {
        const double theta = i < all.count ? fmin(all.at[i], end) : end; // nothing after the end is asked
        const double kappa = kappa_of(h, 0.5 * (before + theta));
        if (theta - before > 1e-13 && kappa > least) {
            seen.roots++;
            expect(state_at(h, kappa) == PIR_OUTSIDE, "case %llu at κ %.17g", (unsigned long long)number, kappa);
        }
        before = theta;
        if (theta >= end)
            break;
    }
    free(all.at);
}

/* --- the check --- */

/* How far the bodies are apart, or how deep they overlap. */
static double gap_at(const hinge *h, double kappa) {
    const pir_vec3 u = h->motion.axis, w = h->motion.way;
    const double sign = h->motion.degrees < 0 ? -1 : 1, part = h->screws ? h->end_kappa / kappa : 0;
    pir_pair_input input = pir_pair_input_default();
    input.pose_p = (pir_pose){{sign * u.x, sign * u.y, sign * u.z, kappa}, {part * w.x, part * w.y, part * w.z}};
    pir_query_result result;
    assert_int_equal(pir_pair_signed_distance(h->pair_placed, h->workspace, &input, &result), PIR_OK);
    return fabs(result.distance);
}

/* The bodies touch at the root: they overlap on one side of it, or touch at a double, or the quadratic has it twice. */
static void expect_contact(const hinge *h, const pir_exact_impact *impact, mpz_t *c, uint64_t number) {
    const double low = impact->kappa[0], high = impact->kappa[1];
    expect(low <= high && high - low < 1e-4 * (1 + fabs(low)), "case %llu: interval %.17g %.17g",
           (unsigned long long)number, low, high);
    expect(state_at(h, high) != PIR_INSIDE, "case %llu: late", (unsigned long long)number);
    // a hair behind: as far as the interval is wide
    const double behind[3] = {low, low - 1e-9 * (fabs(low) + 1), low - 1e-6 * (fabs(low) + 1)};
    for (int k = 0; k < 3; k++)
        if (state_at(h, behind[k]) == PIR_INSIDE)
            return;
    // a graze: the bodies must touch at a rational root, or nearly so at an irrational one
    seen.grazes++;
    if (h->screws) {
        expect(gap_at(h, 0.5 * (low + high)) < 1e-9, "screw %llu: no contact", (unsigned long long)number);
        return;
    }
    mpz_t d;
    mpz_init(d);
    mpz_mul(d, c[1], c[1]);
    mpz_submul(d, c[0], c[2]);
    mpz_submul(d, c[0], c[2]);
    mpz_submul(d, c[0], c[2]);
    mpz_submul(d, c[0], c[2]);
    double root = mpz_sgn(c[0]) == 0 ? -mpz_get_d(c[2]) / mpz_get_d(c[1]) : -mpz_get_d(c[1]) / (2 * mpz_get_d(c[0]));
    const bool rational = mpz_sgn(c[0]) == 0 || mpz_sgn(d) == 0;
    if (!rational)
        root = 0.5 * (low + high);
    mpz_clear(d);
    expect(gap_at(h, root) < 1e-9, "case %llu: no contact", (unsigned long long)number);
}

/*
 * The told polynomial changes its sign between the doubles around κ, or is zero at one of them, or has a root twice.
 */
static void expect_root(const hinge *h, const pir_exact_impact *impact, mpz_t *c) {
    const int degree = h->screws ? 3 : 2;
    int sign[2];
    mpq_t x, value, term;
    mpq_inits(x, value, term, NULL);
    for (int k = 0; k < 2; k++) {
        mpq_set_d(x, impact->kappa[k]);
        mpq_set_ui(value, 0, 1);
        for (int i = 0; i <= degree; i++) {
            mpq_mul(value, value, x);
            mpq_set_z(term, c[i]);
            mpq_add(value, value, term);
        }
        sign[k] = mpq_sgn(value);
    }
    mpq_clears(x, value, term, NULL);
    seen.changes += sign[0] * sign[1] <= 0;
}

static void check_hinge(const char *kind, uint64_t number) {
    test_random random = test_random_case(kind, number);
    hinge h;
    make_hinge(&h, &random, strcmp(kind, "screw") == 0);
    pir_exact_impact impact, plain;
    mpz_t c[4];
    mpz_inits(c[0], c[1], c[2], c[3], NULL);
    assert_int_equal(pir_pair_impact_exact(h.pair, h.workspace, &h.input, &h.motion, &impact, c), PIR_OK);
    assert_int_equal(pir_pair_impact(h.pair, h.workspace, &h.input, &h.motion, &plain), PIR_OK);
    assert_int_equal(plain.impact.outcome, impact.impact.outcome);
    assert_true(plain.degrees == impact.degrees || impact.impact.outcome > PIR_CAST_MISS);
    const pir_state start = state_at(&h, INFINITY);
    const double end = fabs(h.motion.degrees) / DEGREE;
    switch (impact.impact.outcome) {
    case PIR_CAST_HIT:
        assert_true(start != PIR_INSIDE);
        if (start == PIR_BOUNDARY) {
            seen.from_start++;
            assert_int_equal(state_at(&h, 1e7), PIR_INSIDE);
            break;
        }
        seen.hits++;
        expect_apart_before(&h, impact.kappa[1], end, number);
        expect_contact(&h, &impact, c, number);
        expect_root(&h, &impact, c);
        assert_true(impact.degrees <= end * DEGREE && impact.impact.time <= 1);
        assert_true(kappa_of(&h, impact.degrees / DEGREE) >= impact.kappa[0]);
        break;
    case PIR_CAST_MISS:
        seen.misses++;
        assert_int_equal(start, PIR_OUTSIDE);
        expect_apart_before(&h, -INFINITY, end, number);
        break;
    case PIR_CAST_RECEDING:
        seen.receding++;
        assert_int_equal(start, PIR_BOUNDARY);
        assert_true(state_at(&h, 1e7) != PIR_INSIDE);
        break;
    default:
        seen.inside++;
        assert_int_equal(impact.impact.outcome, PIR_CAST_START_INSIDE);
        assert_int_equal(start, PIR_INSIDE);
    }
    mpz_clears(c[0], c[1], c[2], c[3], NULL);
    free_hinge(&h);
}

static uint64_t case_count(uint64_t usual) {
    const char *text = getenv("PIR_TEST_CASES");
    return text != NULL ? strtoull(text, NULL, 10) : usual;
}

static void check_all(const char *kind, uint64_t count) {
    memset(&seen, 0, sizeof seen);
    for (uint64_t i = 0; i < count; i++)
        check_hinge(kind, i);
    print_message("%u hits, %u of them grazes, %u misses, %u receding, %u inside, %u into contact; %u states\n",
                  seen.hits, seen.grazes, seen.misses, seen.receding, seen.inside, seen.from_start, seen.roots);
    assert_true(seen.hits > 0 && seen.misses > 0 && seen.changes > 0.9 * seen.hits);
}

static void hinges_are_neither_early_nor_late(void **state) {
    (void)state;
    check_all("hinge", case_count(400));
}

static void screws_are_neither_early_nor_late(void **state) {
    (void)state;
    check_all("screw", case_count(400));
}

/* A way, held against the cast. */
static void check_way(uint64_t number) {
    test_random random = test_random_case("way", number);
    hinge h;
    make_hinge(&h, &random, false);
    h.motion.degrees = 0;
    h.motion.way = h.aligned ? grid_point(&random, 8) : test_random_direction(&random);
    if (!h.aligned) {
        const pir_vec3 t = h.input.pose_p.translation;
        h.motion.way = (pir_vec3){h.motion.way.x - 2 * t.x, h.motion.way.y - 2 * t.y, h.motion.way.z - 2 * t.z};
    }
    pir_exact_impact impact;
    pir_impact cast;
    mpz_t c[3];
    mpz_inits(c[0], c[1], c[2], NULL);
    assert_int_equal(pir_pair_impact_exact(h.pair, h.workspace, &h.input, &h.motion, &impact, c), PIR_OK);
    assert_int_equal(pir_pair_cast(h.pair, h.workspace, &h.input, h.motion.way, &cast), PIR_OK);
    expect(impact.impact.outcome == cast.outcome, "way %llu: %d, cast %d at %g", (unsigned long long)number,
           impact.impact.outcome, cast.outcome, cast.time);
    if (cast.outcome == PIR_CAST_HIT) {
        expect(impact.impact.time <= cast.time + 1e-15 && impact.impact.time >= cast.time - 1e-9,
               "way %llu: %.17g, cast %.17g", (unsigned long long)number, impact.impact.time, cast.time);
        if (mpz_sgn(c[1]) != 0) {
            assert_int_equal(mpz_sgn(c[0]), 0);
            assert_true(fabs(-mpz_get_d(c[1]) / mpz_get_d(c[2]) - cast.time) < 1e-9);
        }
    }
    mpz_clears(c[0], c[1], c[2], NULL);
    free_hinge(&h);
}

static void ways_are_those_of_casts(void **state) {
    (void)state;
    const uint64_t count = case_count(1000);
    for (uint64_t i = 0; i < count; i++)
        check_way(i);
}

/* --- by hand --- */

static pir_pair_input shifted(double x, double y, double z) {
    pir_pair_input input = pir_pair_input_default();
    input.pose_p.translation = (pir_vec3){x, y, z};
    return input;
}

static pir_exact_impact ask(pir_polytope *p, pir_polytope *q, pir_pair_input input, pir_exact_motion motion,
                            pir_status expected) {
    pir_pair *pair;
    pir_workspace *workspace;
    pir_exact_impact impact = {.degrees = -1};
    assert_int_equal(pir_pair_create(p, q, NULL, &pair), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    assert_int_equal(pir_pair_impact(pair, workspace, &input, &motion, &impact), expected);
    if (expected != PIR_OK)
        assert_true(impact.degrees == -1);
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    return impact;
}

static pir_exact_motion turn(double x, double y, double degrees) {
    return (pir_exact_motion){.pivot = {x, y, 0}, .axis = {0, 0, 1}, .degrees = degrees};
}

static pir_exact_motion go(double y) {
    return (pir_exact_motion){.way = {0, y, 0}};
}

static void contacts_known_by_hand(void **state) {
    (void)state;
    // a bar's end, √17 from its axis, never reaches a box that is 5 away
    pir_polytope *bar = test_box(4, 1, 1), *box = test_box_at(1, 1, 1, (pir_vec3){0, 6, 0}), *cube = test_box(1, 1, 1);
    pir_exact_impact impact = ask(bar, box, shifted(0, 0, 0), turn(0, 0, 360), PIR_OK);
    assert_int_equal(impact.impact.outcome, PIR_CAST_MISS);
    assert_true(impact.degrees == 360 && impact.impact.time == 1);
    // cubes that touch with a side and turn apart
    impact = ask(cube, cube, shifted(2, 2, 0), turn(1, 1, 90), PIR_OK);
    assert_int_equal(impact.impact.outcome, PIR_CAST_RECEDING);
    // a way that ends in contact, and one that ends just before
    impact = ask(cube, cube, shifted(0, 5, 0), go(-3), PIR_OK);
    assert_int_equal(impact.impact.outcome, PIR_CAST_HIT);
    assert_true(impact.impact.time <= 1 && impact.impact.time > 1 - 1e-9 && impact.impact.normal.y == 1);
    impact = ask(cube, cube, shifted(0, 5, 0), go(-2.9999999999999996), PIR_OK);
    assert_int_equal(impact.impact.outcome, PIR_CAST_MISS);
    assert_int_equal(ask(cube, cube, shifted(0, 5, 0), go(0), PIR_OK).impact.outcome, PIR_CAST_AT_REST);
    assert_int_equal(ask(cube, cube, shifted(0, 1, 0), go(1), PIR_OK).impact.outcome, PIR_CAST_START_INSIDE);
    // about the middle between them two corners of one come to the side of the other at a quarter turn
    impact = ask(cube, cube, shifted(4, 0, 0), turn(2, 0, 180), PIR_OK);
    assert_int_equal(impact.impact.outcome, PIR_CAST_HIT);
    assert_true(impact.degrees <= 90 && impact.degrees > 90 - 1e-9);
    pir_polytope_release(cube);
    pir_polytope_release(bar);
    pir_polytope_release(box);
}

/* A lid of length 4, hinged half above a table, meets it with its end where the sine is an eighth. */
static void a_lid_meets_the_table_with_its_end(void **state) {
    (void)state;
    pir_polytope *lid = test_box_at(2, 0.25, 2, (pir_vec3){0, 0.25, 0});
    pir_polytope *table = test_box_at(2, 1, 2, (pir_vec3){2, -1, 0});
    // upright from (0, 0.5) on, it falls towards +x
    pir_pair_input input = shifted(0, 2.5, 0);
    input.pose_p.rotation = (pir_quat){0, 0, 1, 1};
    const pir_exact_impact impact = ask(lid, table, input, turn(0, 0.5, -120), PIR_OK);
    const double expected = 90 + asin(0.125) * DEGREE;
    assert_int_equal(impact.impact.outcome, PIR_CAST_HIT);
    expect(impact.degrees <= expected + 1e-13 && impact.degrees > expected - 1e-9, "at %.17g", impact.degrees);
    assert_true(impact.impact.normal.y == 1 && fabs(impact.impact.point.y) < 1e-9);
    assert_int_equal(impact.impact.witness.q.kind, PIR_FEATURE_FACET);
    assert_int_equal(impact.impact.witness.p.kind, PIR_FEATURE_VERTEX);
    pir_polytope_release(lid);
    pir_polytope_release(table);
}

/* A square peg comes down onto a plate as it turns: all of its lower corners at once, at 2/3 of the way. */
static void a_peg_meets_the_plate_with_its_side(void **state) {
    (void)state;
    pir_polytope *peg = test_box(1, 1, 1), *plate = test_box(5, 5, 1);
    const pir_pair_input input = {.pose_p = {.rotation = {0, 0, 0, 1}, .translation = {0, 0, 4}},
                                  .pose_q = pir_pose_identity()};
    pir_exact_motion screw = turn(0.25, 0.5, 90);
    screw.way = (pir_vec3){1, 0, -3};
    pir_exact_impact impact = ask(peg, plate, input, screw, PIR_OK);
    const double expected = 2 * atan(2.0 / 3) * DEGREE;
    assert_int_equal(impact.impact.outcome, PIR_CAST_HIT);
    expect(impact.degrees <= expected + 1e-13 && impact.degrees > expected - 1e-9, "at %.17g", impact.degrees);
    assert_true(impact.kappa[0] <= 1.5 && impact.kappa[1] >= 1.5 && impact.impact.normal.z == 1);
    // down to the plate and no farther, and less far
    screw.way.z = -2;
    impact = ask(peg, plate, input, screw, PIR_OK);
    assert_int_equal(impact.impact.outcome, PIR_CAST_HIT);
    assert_true(impact.kappa[0] <= 1 && impact.kappa[1] >= 1 && impact.degrees > 90 - 1e-9);
    screw.way.z = nextafter(-2, 0);
    assert_int_equal(ask(peg, plate, input, screw, PIR_OK).impact.outcome, PIR_CAST_MISS);
    // from the plate it is lifted off, or slides on it, or it is pressed into it
    const pir_pair_input on = {.pose_p = {.rotation = {0, 0, 0, 1}, .translation = {0, 0, 2}},
                               .pose_q = pir_pose_identity()};
    screw.way.z = 1;
    assert_int_equal(ask(peg, plate, on, screw, PIR_OK).impact.outcome, PIR_CAST_RECEDING);
    screw.way.z = 0;
    assert_int_equal(ask(peg, plate, on, screw, PIR_OK).impact.outcome, PIR_CAST_RECEDING);
    screw.way.z = -0x1p-60;
    impact = ask(peg, plate, on, screw, PIR_OK);
    assert_true(impact.impact.outcome == PIR_CAST_HIT && impact.impact.time == 0);
    pir_polytope_release(peg);
    pir_polytope_release(plate);
}

static void memory_that_fails_at_any_request_is_told(void **state) {
    (void)state;
    pir_polytope *p = test_box(1, 1, 1), *q = test_box(1, 2, 1);
    for (uint64_t at = 1, done = 0; !done; at++) {
        test_memory memory = {.fail_at = at};
        const pir_allocator allocator = test_allocator(&memory);
        pir_pair_options options = pir_pair_options_default();
        options.allocator = &allocator;
        pir_pair *pair = NULL;
        pir_workspace *workspace;
        assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
        pir_status status = pir_pair_create(p, q, &options, &pair);
        pir_exact_impact impact = {.degrees = -1};
        const pir_pair_input input = shifted(3, 0, 0);
        pir_exact_motion motion = turn(1.5, 0, at % 2 == 0 ? 180 : 90);
        motion.way.x = at % 2 == 0 ? 0 : -2;
        if (status == PIR_OK)
            status = pir_pair_impact(pair, workspace, &input, &motion, &impact);
        done = memory.requests + 1 < at; // both motions
        assert_true(status == PIR_OK || (status == PIR_ERR_MEMORY && !done && impact.degrees == -1));
        pir_pair_destroy(pair);
        pir_workspace_destroy(workspace);
        expect(memory.blocks == 0 && !memory.wrong_size && !memory.overrun, "request %llu", (unsigned long long)at);
    }
    pir_polytope_release(p);
    pir_polytope_release(q);
}

static void bad_input_is_refused(void **state) {
    (void)state;
    pir_polytope *cube = test_box(1, 1, 1), *flat = test_box(1, 1, 0);
    const pir_pair_input far = shifted(5, 0, 0);
    ask(flat, flat, far, turn(0, 0, 90), PIR_ERR_ARGUMENT);
    ask(cube, cube, far, turn(0, 0, 361), PIR_ERR_ARGUMENT);
    ask(cube, cube, far, turn(0, 0, NAN), PIR_ERR_NOT_FINITE);
    ask(cube, cube, far, turn(INFINITY, 0, 90), PIR_ERR_NOT_FINITE);
    pir_exact_motion motion = turn(0, 0, 180);
    motion.way.x = 1;
    ask(cube, cube, far, motion, PIR_ERR_ARGUMENT);
    motion.degrees = 1e-7;
    ask(cube, cube, far, motion, PIR_ERR_LIMIT);
    motion = turn(0, 0, 90);
    motion.axis.z = 0;
    ask(cube, cube, far, motion, PIR_ERR_ARGUMENT);
    motion.axis.z = 1e200;
    ask(cube, cube, far, motion, PIR_ERR_LIMIT);
    pir_pair_input turned = far;
    turned.pose_q.rotation = (pir_quat){0, 0, 0, 0};
    ask(cube, cube, turned, turn(0, 0, 90), PIR_ERR_ZERO_QUATERNION);
    turned = far;
    turned.pose_p.translation.x = NAN;
    ask(cube, cube, turned, turn(0, 0, 90), PIR_ERR_NOT_FINITE);
    pir_exact_impact impact;
    assert_int_equal(pir_pair_impact(NULL, NULL, NULL, NULL, &impact), PIR_ERR_ARGUMENT);
    pir_polytope_release(cube);
    pir_polytope_release(flat);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hinges_are_neither_early_nor_late),
        cmocka_unit_test(screws_are_neither_early_nor_late),
        cmocka_unit_test(ways_are_those_of_casts),
        cmocka_unit_test(contacts_known_by_hand),
        cmocka_unit_test(a_lid_meets_the_table_with_its_end),
        cmocka_unit_test(a_peg_meets_the_plate_with_its_side),
        cmocka_unit_test(memory_that_fails_at_any_request_is_told),
        cmocka_unit_test(bad_input_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
