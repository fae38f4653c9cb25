/* SPDX-License-Identifier: MIT */
/*
 * Hulls and overlaps of outlines in the plane, where every coordinate has a rounding error. What is one corner, on
 * one line, or flush but for rounding is found to be so every time.
 */
#include "support/test.h"

#include <math.h>

#include "query/contact/outline.h"
#include "support/random.h"

#define SNAP     1e-13
#define ROUNDING 1e-15
#define PART     1e-6
#define MOST     64

static const double pi = 3.14159265358979323846;

typedef struct points {
    uint32_t count;
    pir_corner at[MOST];
} points;

static void put(points *to, test_random *random, double u, double v) {
    assert_true(to->count < MOST);
    to->at[to->count] = (pir_corner){
        .u = u + ROUNDING * test_random_unit(random), .v = v + ROUNDING * test_random_unit(random), .p = to->count};
    to->count++;
}

static void hull(points *of) {
    pir_corner room[MOST + 1];
    of->count = pir_outline_hull(of->at, of->count, SNAP, room);
}

static points square(test_random *random, double u, double v, double half) {
    points p = {0};
    put(&p, random, u - half, v - half);
    put(&p, random, u + half, v - half);
    put(&p, random, u + half, v + half);
    put(&p, random, u - half, v + half);
    hull(&p);
    return p;
}

static points segment(test_random *random, double u, double v, double to_u, double to_v) {
    points p = {0};
    put(&p, random, u, v);
    put(&p, random, to_u, to_v);
    hull(&p);
    return p;
}

static points overlap(const points *p, const points *q) {
    points shared = {0};
    pir_outline of_p = {p->at, p->count}, of_q = {q->at, q->count};
    shared.count = pir_outline_overlap(of_p, of_q, SNAP, PART, shared.at);
    assert_true(shared.count <= 2 * p->count + q->count);
    hull(&shared);
    return shared;
}

static uint32_t kinds(const points *of, pir_corner_kind kind) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < of->count; i++)
        count += of->at[i].kind == kind;
    return count;
}

static double area(const points *p) {
    double twice = 0;
    for (uint32_t i = 2; i < p->count; i++) {
        const pir_corner *a = &p->at[0], *b = &p->at[i - 1], *c = &p->at[i];
        twice += (b->u - a->u) * (c->v - a->v) - (b->v - a->v) * (c->u - a->u);
    }
    return twice / 2;
}

/* A regular polygon, each corner three times and points along each side, in random order. */
static void hulls_have_their_corners_and_no_others(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 300; number++) {
        test_random random = test_random_case("outline, hulls", number);
        uint32_t n = 3 + (uint32_t)number % 8;
        double angle = number % 5 ? pi * test_random_unit(&random) : 0;
        points p = {0};
        for (uint32_t i = 0; i < n; i++) {
            double a = angle + 2 * pi * i / n, b = angle + 2 * pi * (i + 1) / n;
            for (int k = 0; k < 6; k++) {
                double t = k < 3 ? 0 : k / 6.0;
                put(&p, &random, cos(a) + t * (cos(b) - cos(a)), sin(a) + t * (sin(b) - sin(a)));
            }
        }
        for (uint32_t i = p.count; i-- > 1;) {
            uint32_t j = test_random_below(&random, i + 1);
            pir_corner moved = p.at[i];
            p.at[i] = p.at[j];
            p.at[j] = moved;
        }
        hull(&p);
        expect(p.count == n, "case %d: %u corners of %u", (int)number, p.count, n);
        assert_true(fabs(area(&p) - 0.5 * n * sin(2 * pi / n)) < 1e-12);
    }
}

static void points_and_segments_are_outlines(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 100; number++) {
        test_random random = test_random_case("outline, flat", number);
        double u = cos((double)number), v = number % 2 ? sin((double)number) : 0;
        points one = {0}, two = {0};
        for (int i = 0; i < 7; i++) {
            put(&one, &random, u, v);
            put(&two, &random, i * u, i * v);
        }
        hull(&one);
        hull(&two);
        assert_true(one.count == 1 && two.count == 2);
        assert_true(fabs(pir_outline_distance(&two.at[0], &two.at[1]) - 6 * hypot(u, v)) < 1e-12);
        // narrow ones become segments of their whole length
        points thin = {0};
        put(&thin, &random, 0, 0), put(&thin, &random, u, v),
            put(&thin, &random, 0.5 * u - 1e-7 * v, 0.5 * v + 1e-7 * u);
        put(&thin, &random, 0.5 * u + 1e-7 * v, 0.5 * v - 1e-7 * u);
        hull(&thin);
        assert_int_equal(thin.count, 4);
        assert_int_equal(pir_outline_slim(thin.at, 4, 1e-7), 4);
        assert_int_equal(pir_outline_slim(thin.at, 4, 1e-6), 2);
        assert_true(fabs(pir_outline_distance(&thin.at[0], &thin.at[1]) - hypot(u, v)) < 1e-12);
    }
}

/*
 * Flush sides and equal corners, as faces of stacked boxes have them. A corner of P is named where there is one, else
 * a corner of Q, else a crossing.
 */
static void flush_outlines_share_the_same_corners_every_time(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 300; number++) {
        test_random random = test_random_case("outline, flush", number);
        points p = square(&random, 0, 0, 1), same = square(&random, 0, 0, 1), up = square(&random, 0, 1, 1);
        points both = overlap(&p, &same), half = overlap(&p, &up);
        expect(both.count == 4 && kinds(&both, PIR_CORNER_P) == 4, "case %d: %u corners, %u of P", (int)number,
               both.count, kinds(&both, PIR_CORNER_P));
        expect(half.count == 4 && kinds(&half, PIR_CORNER_P) == 2 && kinds(&half, PIR_CORNER_Q) == 2,
               "case %d: %u corners, %u of P", (int)number, half.count, kinds(&half, PIR_CORNER_P));
        assert_true(fabs(area(&both) - 4) < 1e-12 && fabs(area(&half) - 2) < 1e-12);
        // beside each other, and corner to corner
        points beside = square(&random, 2, 0.5, 1), corner = square(&random, 2, 2, 1), away = square(&random, 3, 0, 1);
        points side = overlap(&p, &beside), point = overlap(&p, &corner);
        assert_true(side.count == 2 && kinds(&side, PIR_CORNER_P) == 1 && kinds(&side, PIR_CORNER_Q) == 1);
        assert_true(point.count == 1 && kinds(&point, PIR_CORNER_P) == 1);
        assert_int_equal(overlap(&p, &away).count, 0);
        // a diamond whose sides pass through the corners of P
        points diamond = {0};
        put(&diamond, &random, 2, 0), put(&diamond, &random, 0, 2), put(&diamond, &random, -2, 0),
            put(&diamond, &random, 0, -2);
        hull(&diamond);
        points in = overlap(&p, &diamond), out = overlap(&diamond, &p);
        assert_true(in.count == 4 && kinds(&in, PIR_CORNER_P) == 4 && out.count == 4 && kinds(&out, PIR_CORNER_Q) == 4);
    }
}

static void crossings_lie_where_the_sides_cross(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 100; number++) {
        test_random random = test_random_case("outline, crossings", number);
        points p = square(&random, 0, 0, 1), q = square(&random, 0.5, 0.25, 1), shared = overlap(&p, &q);
        assert_true(shared.count == 4 && kinds(&shared, PIR_CORNER_CROSSING) == 2);
        for (uint32_t i = 0; i < 4; i++) {
            const pir_corner *x = &shared.at[i];
            if (x->kind == PIR_CORNER_CROSSING)
                assert_true(fmin(hypot(x->u - 1, x->v + 0.75), hypot(x->u + 0.5, x->v - 1)) < 1e-14);
        }
        assert_true(fabs(area(&shared) - 1.5 * 1.75) < 1e-12);
    }
}

static void segments_share_points_and_segments(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 200; number++) {
        test_random random = test_random_case("outline, segments", number);
        points p = square(&random, 0, 0, 1), along = segment(&random, -3, 0, 3, 0),
               inner = segment(&random, 0, 0, 0.5, 0.5), rim = segment(&random, 0, 1, 3, 1),
               across = segment(&random, 0, -1, 0, 1), off = segment(&random, -3, 2, 3, 2);
        points a = overlap(&along, &p), b = overlap(&p, &along), c = overlap(&inner, &p), d = overlap(&rim, &p);
        assert_true(a.count == 2 && kinds(&a, PIR_CORNER_CROSSING) == 2 &&
                    fabs(pir_outline_distance(&a.at[0], &a.at[1]) - 2) < 1e-12);
        assert_true(b.count == 2 && kinds(&b, PIR_CORNER_CROSSING) == 2);
        assert_true(c.count == 2 && kinds(&c, PIR_CORNER_P) == 2);
        assert_true(d.count == 2 && kinds(&d, PIR_CORNER_P) == 1 && kinds(&d, PIR_CORNER_Q) == 1);
        assert_int_equal(overlap(&off, &p).count, 0);
        // two segments: parallel ones share what is beside both
        points longer = segment(&random, -1, 0, 5, 0), equal = segment(&random, -3, 0, 3, 0),
               end = segment(&random, 3, 0, 4, 0), turned = segment(&random, -3, 1e-5, 3, -1e-5);
        points e = overlap(&along, &longer), f = overlap(&along, &equal), g = overlap(&along, &end);
        assert_true(e.count == 2 && kinds(&e, PIR_CORNER_P) == 1 && kinds(&e, PIR_CORNER_Q) == 1);
        expect(f.count == 2 && kinds(&f, PIR_CORNER_P) == 2, "case %d: %u of P", (int)number, kinds(&f, PIR_CORNER_P));
        assert_true(g.count == 1 && g.at[0].kind == PIR_CORNER_P);
        assert_true(overlap(&along, &across).count == 0 && overlap(&along, &turned).count == 0);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hulls_have_their_corners_and_no_others), cmocka_unit_test(points_and_segments_are_outlines),
        cmocka_unit_test(flush_outlines_share_the_same_corners_every_time),
        cmocka_unit_test(crossings_lie_where_the_sides_cross), cmocka_unit_test(segments_share_points_and_segments)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
