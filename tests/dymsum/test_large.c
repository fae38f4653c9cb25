/* SPDX-License-Identifier: MIT */
/* Bodies large enough that walks and updates fetch ahead, by themselves and with small ones: both give the same valid
   pairing, and every version of the kernels the same counts. */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/shape.h>

#include "base/processor.h"
#include "dymsum/sum.h"

/* 17,000 facets and more. The poles of the ellipsoid have more sides than a mask of sides has bits. */
static const char *const pairs[][2] = {
    {"geodesic?level=28", "geodesic?level=29"},
    {"geodesic?level=28", "ellipsoid?level=70"},
    {"ellipsoid?level=70", "geodesic?level=28"},
    {"geodesic?level=28", "box"},
    {"box", "geodesic?level=28"},
    {"geodesic?level=28", "segment"},
    {"segment", "geodesic?level=28"},
    {"geodesic?level=28", "triangle"},
    {"geodesic?level=28", "point"},
};

/* To and fro about one axis, in steps and a leap. */
static const double places[] = {0, 1, 2, 3, 2, 1, 0, 40, 41, 42};

static pir_polytope *body(const char *name) {
    static const struct {
        const char *name;
        uint32_t points;
    } flat[] = {{"point", 1}, {"segment", 2}, {"triangle", 3}};
    static const pir_vec3 points[3] = {{1, 0.25, -0.5}, {-0.5, 1, 0.75}, {0.125, -1, 0.25}};
    pir_polytope *p = NULL;
    for (int i = 0; i < 3; i++)
        if (strcmp(name, flat[i].name) == 0)
            assert_int_equal(pir_polytope_create(points, flat[i].points, NULL, &p), PIR_OK);
    if (!p)
        assert_int_equal(pir_shape_create(name, NULL, NULL, &p), PIR_OK);
    return p;
}

static pir_quat rotation(double place) {
    const double turned = 0.3 + place * 0.0008;
    return (pir_quat){0.48 * sin(turned), 0.6 * sin(turned), 0.64 * sin(turned), cos(turned)};
}

/* Runs a sum of the two, with the kernels of that version, through all places; checks it against walks. */
static pir_sum_statistics run_version(pir_polytope *p, pir_polytope *q, unsigned version) {
    pir_sum *updated = NULL, *walked = NULL;
    assert_int_equal(pir_sum_create(p, q, rotation(0), NULL, &updated), PIR_OK);
    assert_int_equal(pir_sum_create(p, q, rotation(7), NULL, &walked), PIR_OK);
    updated->tracked.kernels = walked->tracked.kernels = pir_processor_version(version)->kernels;
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        assert_int_equal(pir_sum_rotate(updated, rotation(places[i]), PIR_METHOD_UPDATE), PIR_OK);
        assert_int_equal(pir_sum_rotate(walked, rotation(places[i]), PIR_METHOD_WALK), PIR_OK);
        expect(pir_sum_same_pairing(updated, walked), "%s kernels, place %zu",
               pir_processor_version(version)->kernels->name, i);
    }
    assert_true(pir_sum_is_valid(updated));
    pir_sum_statistics did = pir_sum_get_statistics(updated), walks = pir_sum_get_statistics(walked);
    did.by_filter += walks.by_filter;
    did.by_exact += walks.by_exact;
    pir_sum_destroy(updated);
    pir_sum_destroy(walked);
    return did;
}

static void large_bodies_have_one_pairing(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        print_message("# %s, %s\n", pairs[i][0], pairs[i][1]);
        pir_polytope *p = body(pairs[i][0]), *q = body(pairs[i][1]);
        const pir_sum_statistics reference = run_version(p, q, 0);
        for (unsigned k = 1; pir_processor_version(k); k++) {
            const pir_sum_statistics did = run_version(p, q, k);
            assert_memory_equal(&did, &reference, sizeof did);
        }
        pir_polytope_release(p);
        pir_polytope_release(q);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(large_bodies_have_one_pairing)};
    return cmocka_run_group_tests_name("large", tests, NULL, NULL);
}
