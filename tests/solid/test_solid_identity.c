/* SPDX-License-Identifier: MIT */
/*
 * Incidences that sums of solids know without looking at numbers, and tables of equal points, planes and lines, held
 * against exact numbers: each incidence told holds, most of those that hold at a general rotation are told, and two
 * are under one number just where their numbers are equal.
 *
 * PIR_TEST_CASES sets how many rotations each pair goes through.
 */
#include "support/test.h"

#include <math.h>

#include <pirouette/pirouette.h>

#include "solid/bodies.h"
#include "solid/kept/solid_sum.h"
#include "solid/models.h"
#include "solid/space/exact.h"
#include "solid/space/identity.h"
#include "solid/space/places.h"

static const char *const pairs[][2] = {{"gear8", "star5"}, {"stella", "clamp"}, {"spoon", "frame"}};
#define PAIRS (sizeof pairs / sizeof *pairs)

struct incidences {
    uint64_t told, zeros;
};

/* n·X − d·W of a plane and a point, exactly. */
static int exact_sign(pir_space *space, uint32_t plane, uint32_t point) {
    mpz_t sum;
    const uint32_t a = pir_space_exact_plane(space, plane), x = pir_space_exact_point(space, point);
    mpz_init(sum);
    for (uint32_t k = 0; k < 3; k++)
        mpz_addmul(sum, space->number[a + k], space->number[x + k]);
    mpz_submul(sum, space->number[a + 3], space->number[x + 3]);
    const int sign = mpz_sgn(sum);
    mpz_clear(sum);
    return sign;
}

static void compare_incidences(pir_space *space, uint32_t first_plane, uint32_t first_point, test_random *random,
                               struct incidences *ret) {
    const uint32_t planes = space->plane_count - first_plane, points = space->point_count - first_point;
    for (uint32_t i = 0; i < 60000; i++) {
        const uint32_t f = first_plane + (uint32_t)test_random_below(random, planes);
        // one of a few points that are near the plane, where there is one
        uint32_t p = first_point + (uint32_t)test_random_below(random, points);
        for (int tries = 0; tries < 40; tries++) {
            const uint32_t other = first_point + (uint32_t)test_random_below(random, points);
            const double *n = space->plane[f].n, *x = space->point[other].x;
            if (fabs(n[0] * x[0] + n[1] * x[1] + n[2] * x[2] - space->plane[f].d) < 1e-9)
                p = other;
        }
        const bool told = pir_identity_holds(space, f, p);
        const double *n = space->plane[f].n, *x = space->point[p].x;
        if (fabs(n[0] * x[0] + n[1] * x[1] + n[2] * x[2] - space->plane[f].d) > 1e-6) {
            expect(!told, "plane %u holds no point %u", f, p);
            continue;
        }
        const int sign = exact_sign(space, f, p);
        expect(!told || sign == 0, "plane %u does not hold point %u", f, p);
        ret->told += told;
        ret->zeros += sign == 0;
    }
}

static bool same_numbers(const pir_space *space, uint32_t a, uint32_t b, bool either_way) {
    bool same = true, reverse = either_way;
    for (uint32_t k = 0; k < 4; k++) {
        mpz_srcptr x = space->number[a + k], y = space->number[b + k];
        same = same && mpz_cmp(x, y) == 0;
        reverse = reverse && mpz_cmpabs(x, y) == 0 && mpz_sgn(x) == -mpz_sgn(y);
    }
    return same || reverse;
}

/* Points and planes with every one before them, of some in a row. */
static void compare_numbers(pir_space *space, uint32_t first_plane, uint32_t first_point, test_random *random) {
    pir_places points, planes;
    uint32_t of[300], half[300];
    pir_places_init(&points, space);
    pir_places_init(&planes, space);
    for (uint32_t i = 0; i < 300; i++) {
        const uint32_t f = first_plane + (uint32_t)test_random_below(random, space->plane_count - first_plane);
        const uint32_t p = first_point + (uint32_t)test_random_below(random, space->point_count - first_point);
        of[i] = pir_places_point(&points, p);
        half[i] = pir_places_half(&planes, pir_half(f, test_random_below(random, 2) != 0));
        expect(same_numbers(space, pir_space_exact_point(space, p), pir_space_exact_point(space, of[i]), false),
               "point %u is not %u", p, of[i]);
        expect(same_numbers(space, pir_space_exact_plane(space, f), pir_space_exact_plane(space, half[i] >> 1), true),
               "plane %u is not %u", f, half[i] >> 1);
        for (uint32_t k = 0; k < i; k++) {
            expect(of[i] == of[k] || !same_numbers(space, pir_space_exact_point(space, of[i]),
                                                   pir_space_exact_point(space, of[k]), false),
                   "points %u and %u are one", of[i], of[k]);
            expect(half[i] >> 1 == half[k] >> 1 || !same_numbers(space, pir_space_exact_plane(space, half[i] >> 1),
                                                                 pir_space_exact_plane(space, half[k] >> 1), true),
                   "planes %u and %u are one", half[i] >> 1, half[k] >> 1);
        }
    }
    pir_places_finish(&points);
    pir_places_finish(&planes);
}

/* Whether each of two planes that meet holds two points of the line where two others meet. */
static bool same_line(pir_space *space, const uint32_t f[2], const uint32_t g[2]) {
    mpz_t *t = space->t;
    for (int k = 0; k < 2; k++) {
        pir_space_exact_plane(space, f[k]);
        pir_space_exact_plane(space, g[k]);
    }
    mpz_t *a = space->number + space->plane[f[0]].exact, *b = space->number + space->plane[f[1]].exact;
    for (int k = 0; k < 2; k++) {
        // all determinants of three columns of the three planes
        mpz_t *c = space->number + space->plane[g[k]].exact;
        for (int left = 0; left < 4; left++) {
            int column[3];
            for (int i = 0, at = 0; i < 4; i++)
                if (i != left)
                    column[at++] = i;
            mpz_set_ui(t[0], 0);
            for (int i = 0; i < 3; i++) {
                const int u = column[(i + 1) % 3], v = column[(i + 2) % 3];
                mpz_mul(t[1], b[u], c[v]);
                mpz_submul(t[1], b[v], c[u]);
                mpz_addmul(t[0], t[1], a[column[i]]);
            }
            if (mpz_sgn(t[0]) != 0)
                return false;
        }
    }
    return true;
}

static void compare_lines(pir_sum_boundary *b) {
    pir_union_outline *o = &b->outline;
    pir_space *space = b->space;
    const uint32_t lines = o->lines.count < 120 ? o->lines.count : 120;
    for (uint32_t i = 0; i < lines; i++) {
        for (uint32_t k = 0; k < i; k++)
            expect(!same_line(space, o->line_plane[i], o->line_plane[k]), "lines %u and %u are one", i, k);
        // from two planes of the runs on it
        for (uint32_t r = 0; r < o->run_count; r++) {
            const uint32_t *plane = o->line_plane[o->run[r].line];
            if (o->run[r].line != i)
                continue;
            expect(exact_sign(space, plane[0], o->run[r].a) == 0 && exact_sign(space, plane[1], o->run[r].b) == 0,
                   "a run is not on line %u", i);
            expect(exact_sign(space, o->run[r].half >> 1, o->run[r].a) == 0, "a run is not in its plane");
        }
    }
}

static void what_is_told_holds(void **state) {
    (void)state;
    for (uint64_t i = 0; i < PAIRS * solid_cases(2); i++) {
        test_random random = test_random_case("identity", i);
        pir_solid *p = solid_model_new(pairs[i % PAIRS][0], 1), *q = solid_model_new(pairs[i % PAIRS][1], 2);
        const bool general = i / PAIRS % 2 == 0;
        const pir_quat turn = {test_random_unit(&random), test_random_unit(&random), 1, .3};
        pir_solid_sum *sum = NULL;
        struct incidences found = {0};
        assert_true(p && q);
        assert_int_equal(pir_solid_sum_create(p, q, general ? turn : (pir_quat){0, 0, 1, 1}, NULL, &sum), PIR_OK);
        pir_space *space = &sum->operands.space;
        const uint32_t plane = sum->rest.plane_mark, point = sum->rest.point_mark;
        compare_incidences(space, plane, point, &random, &found);
        compare_numbers(space, plane, point, &random);
        compare_lines(&sum->boundary);
        assert_int_equal(space->status, PIR_OK);
        printf("%s and %s: %llu of %llu incidences are told\n", pairs[i % PAIRS][0], pairs[i % PAIRS][1],
               (unsigned long long)found.told, (unsigned long long)found.zeros);
        expect(found.told > 100 && (!general || 2 * found.told > found.zeros), "few are told");
        pir_solid_sum_destroy(sum);
        pir_solid_release(q);
        pir_solid_release(p);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_told_holds)};
    return cmocka_run_group_tests_name("incidences at every rotation", tests, NULL, NULL);
}
