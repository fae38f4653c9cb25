/* SPDX-License-Identifier: MIT */
/* Every version of the loops over planes gives the bits of the plain one, whatever comes in. */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include "query/scan.h"
#include "support/random.h"

#define COUNT 40

struct data {
    double x[COUNT], y[COUNT], z[COUNT];
};

static pir_lanes lanes(struct data *data) {
    return (pir_lanes){data->x, data->y, data->z};
}

static void fill(test_random *random, struct data *data) {
    for (int i = 0; i < COUNT; i++) {
        data->x[i] = test_random_scaled(random, -20, 20);
        data->y[i] = i % 7 ? test_random_scaled(random, -20, 20) : 0;
        data->z[i] = i % 5 ? test_random_scaled(random, -20, 20) : -0.0;
    }
}

/* What the loops put out, all of it. */
struct outcome {
    struct data turned, normals;
    double offsets[COUNT], h[COUNT], err[COUNT], bounds[COUNT], boxes[COUNT];
    double most, least[3];
};

static void run(const pir_scan *scan, struct data in[4], struct outcome *out) {
    memset(out, 0, sizeof *out);
    const pir_mat3 r = {{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}}};
    const pir_vec3 x = {in[0].x[3], -in[0].y[4], in[0].z[6]};
    scan->turn(COUNT, &r, lanes(&in[0]), lanes(&out->turned));
    scan->offset(COUNT, lanes(&in[0]), in[1].x, lanes(&in[2]), out->offsets);
    out->most = scan->cross(COUNT, lanes(&in[0]), lanes(&in[1]), lanes(&in[2]), lanes(&out->normals), out->h, out->err);
    scan->look(COUNT, lanes(&out->normals), out->h, out->err, x, 0x1p-40, out->least);
    scan->bounds(COUNT, in[3].x, in[3].y, in[3].z, in[1].y, lanes(&in[2]), 3.5, x, 0x1p-44, out->bounds);
    scan->boxes(COUNT, lanes(&in[0]), lanes(&in[1]), in[3].x, x, 0x1p-44, out->boxes);
}

static void every_version_gives_the_same_bits(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 500; number++) {
        test_random random = test_random_case("scans", number);
        struct data in[4];
        for (int k = 0; k < 4; k++)
            fill(&random, &in[k]);
        struct outcome plain, other;
        run(pir_scan_version(0), in, &plain);
        for (unsigned version = 1; pir_scan_version(version); version++) {
            run(pir_scan_version(version), in, &other);
            expect(memcmp(&plain, &other, sizeof plain) == 0, "%s differs, case %llu", pir_scan_version(version)->name,
                   (unsigned long long)number);
        }
    }
}

static void the_plain_version_says_what_the_formulas_say(void **state) {
    (void)state;
    test_random random = test_random_case("scans", 1000);
    struct data in[4];
    for (int k = 0; k < 4; k++)
        fill(&random, &in[k]);
    struct outcome out;
    run(pir_scan_version(0), in, &out);
    double low = HUGE_VAL;
    for (int i = 0; i < COUNT; i++) {
        pir_vec3 d = {in[0].x[i], in[0].y[i], in[0].z[i]}, e = {in[1].x[i], in[1].y[i], in[1].z[i]};
        pir_vec3 c = pir_vec_cross(d, e), n = {out.normals.x[i], out.normals.y[i], out.normals.z[i]};
        double length = sqrt(pir_vec_dot(c, c));
        // parallel vectors have no normal, and their plane is passed over
        if (length == 0) {
            assert_true(isinf(out.err[i]));
            continue;
        }
        assert_true(fabs(out.err[i] * length - 1) < 1e-14);
        assert_true(fabs(pir_vec_dot(n, c) - length) <= 1e-14 * length);
        double s = out.h[i] - (n.x * in[0].x[3] + n.y * -in[0].y[4] + n.z * in[0].z[6]) - 0x1p-40 * out.err[i];
        low = fmin(low, s);
    }
    assert_true(out.least[0] == low);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_version_gives_the_same_bits),
                                       cmocka_unit_test(the_plain_version_says_what_the_formulas_say)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
