/* SPDX-License-Identifier: MIT */
/*
 * The loops over planes compute their formulas. With the argument `versions`: every version gives the bits of the
 * plain one, for any input. That is skipped where only the plain one runs.
 */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include "base/processor.h"
#include "query/depth/scan.h"
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

/* All results of the loops. */
struct outcome {
    struct data turned, normals, moved;
    double offsets[COUNT], slacks[COUNT], h[COUNT], err[COUNT], bounds[COUNT], boxes[COUNT], caps[COUNT];
    double most, lowest_slack, high, least[3], lowest[2];
};

static void run_scan(const pir_scan *scan, struct data in[4], struct outcome *out) {
    memset(out, 0, sizeof *out);
    const pir_mat3 r = {{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}}};
    const pir_vec3 x = {in[0].x[3], -in[0].y[4], in[0].z[6]};
    scan->turn(COUNT, &r, lanes(&in[0]), lanes(&out->turned));
    scan->offset(COUNT, lanes(&in[0]), in[1].x, lanes(&in[2]), out->offsets);
    out->most = scan->cross(COUNT, lanes(&in[0]), lanes(&in[1]), lanes(&in[2]), lanes(&out->normals), out->h, out->err);
    scan->look(COUNT, lanes(&out->normals), out->h, out->err, x, 0x1p-40, out->least);
    out->lowest_slack = scan->least(COUNT, lanes(&out->normals), out->h, x);
    pir_box_lanes boxes = {lanes(&in[0]), lanes(&in[1]), in[3].x, in[3].y};
    scan->boxes(COUNT, &boxes, x, 0x1p-44, out->boxes);
    pir_facet_lanes facets = {lanes(&in[2]), in[3].z};
    pir_slack_lanes slacks = {.to = lanes(&out->moved), .s = out->slacks};
    scan->slacks(COUNT, &r, lanes(&in[1]), x, &facets, &slacks);
    out->lowest[0] = slacks.least;
    out->lowest[1] = slacks.along;
    pir_lasting_lanes lasting = {in[3].x, in[3].y, in[3].z, in[1].y, lanes(&in[2])};
    scan->bounds(COUNT, &lasting, 3.5, x, 0x1p-44, out->bounds);
    for (int i = 0; i < COUNT; i++)
        out->caps[i] = i % 3 ? -HUGE_VAL : in[3].x[i];
    pir_cap_lanes caps = {lanes(&out->normals), lanes(&in[1]), in[3].y, in[3].z};
    out->high = scan->caps(0, COUNT, &caps, x, 0x1p-44, out->caps);
}

static void every_version_gives_the_same_bits(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 500; number++) {
        test_random random = test_random_case("scans", number);
        struct data in[4];
        for (int k = 0; k < 4; k++)
            fill(&random, &in[k]);
        struct outcome plain, other;
        run_scan(pir_processor_version(0)->scan, in, &plain);
        for (unsigned version = 1; pir_processor_version(version); version++) {
            run_scan(pir_processor_version(version)->scan, in, &other);
            expect(memcmp(&plain, &other, sizeof plain) == 0, "%s differs, case %llu",
                   pir_processor_version(version)->scan->name, (unsigned long long)number);
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
    run_scan(pir_processor_version(0)->scan, in, &out);
    double low = HUGE_VAL;
    for (int i = 0; i < COUNT; i++) {
        pir_vec3 d = {in[0].x[i], in[0].y[i], in[0].z[i]}, e = {in[1].x[i], in[1].y[i], in[1].z[i]};
        pir_vec3 c = pir_vec_cross(d, e), n = {out.normals.x[i], out.normals.y[i], out.normals.z[i]};
        double length = sqrt(pir_vec_dot(c, c));
        // parallel vectors have no normal; their plane is skipped
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

/* The bound of a cap is |w| times the cosine of the greatest angle to w, where that is positive. */
static void caps_bound_by_their_widest_angle(void **state) {
    (void)state;
    test_random random = test_random_case("scans", 1001);
    for (int round = 0; round < 2000; round++) {
        struct data axis, corner;
        pir_vec3 x = test_random_direction(&random), n[PIR_SCAN_LANES], w[PIR_SCAN_LANES];
        double cosine[PIR_SCAN_LANES], sine[PIR_SCAN_LANES], low[PIR_SCAN_LANES], angle[PIR_SCAN_LANES];
        for (int i = 0; i < PIR_SCAN_LANES; i++) {
            n[i] = test_random_direction(&random);
            w[i] = pir_vec_scale(test_random_direction(&random), 0.1 + 2 * fabs(test_random_unit(&random)));
            angle[i] = fabs(test_random_unit(&random)) * acos(0);
            pir_lane_put(lanes(&axis), (uint32_t)i, n[i]);
            pir_lane_put(lanes(&corner), (uint32_t)i, pir_vec_add(w[i], x));
            cosine[i] = cos(angle[i]);
            sine[i] = sin(angle[i]);
            low[i] = -HUGE_VAL;
        }
        const double error = 0x1p-30;
        pir_cap_lanes caps = {lanes(&axis), lanes(&corner), cosine, sine};
        double high = pir_processor_version(0)->scan->caps(0, PIR_SCAN_LANES, &caps, x, error, low);
        double least = HUGE_VAL;
        for (int i = 0; i < PIR_SCAN_LANES; i++) {
            double length = sqrt(pir_vec_dot(w[i], w[i])), along = pir_vec_dot(n[i], w[i]);
            double widest = atan2(sqrt(fmax(0, length * length - along * along)), along) + angle[i];
            double right = length * cos(widest) - 2 * error;
            least = fmin(least, along + error);
            if (fabs(right) > 1e-6)
                expect(right > 0 ? fabs(low[i] - right) < 1e-6 : low[i] == -HUGE_VAL, "bound %.17g, not %.17g", low[i],
                       right);
        }
        assert_true(fabs(high - least) < 1e-13);
    }
}

static void slacks_are_those_of_turned_points(void **state) {
    (void)state;
    test_random random = test_random_case("scans", 1002);
    const pir_mat3 r = {{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}}};
    struct data from, n, to;
    double base[COUNT], s[COUNT], slack = HUGE_VAL, along = HUGE_VAL;
    for (int i = 0; i < COUNT; i++) {
        pir_vec3 a = test_random_direction(&random), b = test_random_direction(&random);
        pir_lane_put(lanes(&from), (uint32_t)i, a);
        pir_lane_put(lanes(&n), (uint32_t)i, b);
        base[i] = test_random_unit(&random);
    }
    pir_vec3 x = test_random_direction(&random);
    pir_facet_lanes facets = {lanes(&n), base};
    pir_slack_lanes slacks = {.to = lanes(&to), .s = s};
    pir_processor_version(0)->scan->slacks(COUNT, &r, lanes(&from), x, &facets, &slacks);
    for (int i = 0; i < COUNT; i++) {
        pir_vec3 u = pir_vec_sub(pir_mat_apply(&r, (pir_vec3){from.x[i], from.y[i], from.z[i]}), x);
        pir_vec3 normal = {n.x[i], n.y[i], n.z[i]};
        assert_true(fabs(to.x[i] - u.x) + fabs(to.y[i] - u.y) + fabs(to.z[i] - u.z) < 1e-14);
        assert_true(fabs(s[i] - base[i] - pir_vec_dot(normal, u)) < 1e-14);
        slack = fmin(slack, s[i]);
        along = fmin(along, pir_vec_dot(normal, x));
    }
    assert_true(slacks.least == slack && fabs(slacks.along - along) < 1e-14);
}

static int compare_versions(void) {
    if (!pir_processor_version(1)) {
        print_message("# nothing to compare: the plain version alone runs here\n");
        return TEST_SKIPPED;
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_version_gives_the_same_bits)};
    return cmocka_run_group_tests_name("scan versions", tests, NULL, NULL);
}

int main(int argc, char **argv) {
    test_print_seed();
    if (argc > 1 && strcmp(argv[1], "versions") == 0)
        return compare_versions();
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_plain_version_says_what_the_formulas_say),
                                       cmocka_unit_test(caps_bound_by_their_widest_angle),
                                       cmocka_unit_test(slacks_are_those_of_turned_points)};
    return cmocka_run_group_tests_name("scans", tests, NULL, NULL);
}
