/* SPDX-License-Identifier: MIT */
/* Sums as bytes: a restored sum equals the one that was written; what was cut, changed or made up is refused. */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "dymsum/file/sum_file.h"
#include "support/bodies.h"
#include "support/memory.h"
#include "support/meshes.h"
#include "support/sum_bytes.h"

static test_bytes bytes_of(const pir_sum *sum) {
    test_bytes bytes = test_bytes_of(sum);
    assert_non_null(bytes.data);
    return bytes;
}

#define WHOLE 4.0

static pir_sum *make_sum(const test_pose *pose, int difference, double half_angle) {
    pir_polytope *p = test_polytope(&pose->p), *q = test_polytope(&pose->q);
    pir_sum_options options = {.size = sizeof options, .allocator = NULL, .difference = difference};
    pir_sum *sum = NULL;
    assert_int_equal(pir_sum_create(p, q, pose->rotation, &options, &sum), PIR_OK);
    assert_int_equal(pir_sum_set_region(sum, (pir_vec3){0.2, -0.3, 1}, half_angle), PIR_OK);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return sum;
}

static void expect_same_sum(pir_sum *a, pir_sum *b, const char *situation) {
    pir_mesh *x, *y;
    pir_quat s = pir_sum_rotation(a), t = pir_sum_rotation(b);
    assert_memory_equal(&s, &t, sizeof s);
    expect(pir_sum_same_pairing(a, b) && pir_sum_is_valid(b), "%s", situation);
    assert_int_equal(pir_sum_mesh(a, PIR_DOUBLE, &x), PIR_OK);
    assert_int_equal(pir_sum_mesh(b, PIR_DOUBLE, &y), PIR_OK);
    expect(pir_mesh_equal(x, y), "%s", situation);
    pir_mesh_destroy(y);
    pir_mesh_destroy(x);
}

/* The same region, and the same pairs kept for it. */
static void expect_same_region(const pir_sum *a, const pir_sum *b) {
    pir_vec3 x = {0, 0, 0}, y = {0, 0, 0};
    double s = 0, t = 0;
    assert_int_equal(pir_sum_region(a, &x, &s), pir_sum_region(b, &y, &t));
    assert_true(x.x == y.x && x.y == y.y && x.z == y.z && s == t);
    assert_int_equal(pir_sum_ee_count(a), pir_sum_ee_count(b));
    uint32_t of_p = pir_polytope_facet_count(pir_sum_p(a)), of_q = pir_polytope_facet_count(pir_sum_q(a));
    assert_memory_equal(pir_sum_fv(a), pir_sum_fv(b), of_p * sizeof(uint32_t));
    assert_memory_equal(pir_sum_vf(a), pir_sum_vf(b), of_q * sizeof(uint32_t));
}

static void restored_sum_is_the_one_that_was_written(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 200; i++) {
        test_random random = test_random_case("files", i);
        test_pose pose;
        test_random_pose(&random, 14, &pose);
        const double half_angle = i % 5 < 2 ? 0.3 + 0.7 * (double)(i % 5) : WHOLE;
        pir_sum *sum = make_sum(&pose, i % 2, half_angle), *back = NULL;
        if (i % 3 == 0)
            assert_int_equal(pir_sum_set_scale(sum, i % 2 ? PIR_OPERAND_P : PIR_OPERAND_Q, 1.3), PIR_OK);
        assert_int_equal(pir_sum_rotate(sum, test_rotation(&random), PIR_METHOD_UPDATE), PIR_OK);
        test_bytes bytes = bytes_of(sum);
        test_memory memory = {0};
        pir_allocator allocator = test_allocator(&memory);
        pir_report report;
        pir_status status = pir_sum_restore(bytes.data, bytes.size, &allocator, &report, &back);
        expect(status == PIR_OK, "case %d: %s: %s", (int)i, pose.situation, report.text);
        expect_same_sum(sum, back, pose.situation);
        expect_same_region(sum, back);
        // the bytes are the same again, and the sums go on alike
        test_bytes again = bytes_of(back);
        assert_int_equal(again.size, bytes.size);
        assert_memory_equal(again.data, bytes.data, bytes.size);
        assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_P, 1), PIR_OK);
        assert_int_equal(pir_sum_set_scale(back, PIR_OPERAND_P, 1), PIR_OK);
        pir_quat next = test_rotation(&random);
        assert_int_equal(pir_sum_rotate(sum, next, PIR_METHOD_WALK), PIR_OK);
        assert_int_equal(pir_sum_rotate(back, next, PIR_METHOD_UPDATE), PIR_OK);
        expect_same_sum(sum, back, pose.situation);
        for (int step = 0; step < 10; step++) {
            next = test_compose((pir_quat){0.01, -0.02, 0.01, 1}, next, 0);
            if (pir_sum_rotate(back, next, PIR_METHOD_UPDATE) != PIR_OK)
                break; // tiny or huge by now
            assert_int_equal(pir_sum_rotate(sum, next, PIR_METHOD_UPDATE), PIR_OK);
            expect_same_sum(sum, back, pose.situation);
        }
        pir_sum_destroy(back);
        assert_int_equal(memory.blocks, 0);
        assert_false(memory.wrong_size);
        free(again.data);
        free(bytes.data);
        pir_sum_destroy(sum);
    }
}

static void streams_hold_one_sum_after_another(void **state) {
    (void)state;
    test_random random = test_random_case("streams", 0);
    test_pose pose;
    FILE *file = tmpfile();
    assert_non_null(file);
    pir_sum *sums[4];
    for (int i = 0; i < 4; i++) {
        test_random_pose(&random, 40, &pose);
        sums[i] = make_sum(&pose, 0, i % 2 ? 0.9 : WHOLE);
        assert_int_equal(pir_sum_write(sums[i], file, NULL), PIR_OK);
    }
    rewind(file);
    pir_report report;
    pir_sum *back = NULL;
    for (int i = 0; i < 4; i++) {
        assert_int_equal(pir_sum_read(file, NULL, &report, &back), PIR_OK);
        expect_same_sum(sums[i], back, "stream");
        pir_sum_destroy(back);
        pir_sum_destroy(sums[i]);
    }
    back = NULL;
    assert_int_equal(pir_sum_read(file, NULL, &report, &back), PIR_ERR_FORMAT);
    assert_null(back);
    assert_non_null(strstr(report.text, "ends"));
    fclose(file);
}

static void golden_bytes_are_read_on_every_machine(void **state) {
    (void)state;
    const pir_vec3 points[] = {{0, 0, 0}, {3, 0, 0}, {0, 2, 0}, {0, 0, -1}};
    pir_polytope *p;
    pir_sum *sum;
    assert_int_equal(pir_polytope_create(points, 4, NULL, &p), PIR_OK);
    assert_int_equal(pir_sum_create(p, p, (pir_quat){0, 1, 2, 3}, NULL, &sum), PIR_OK);
    test_bytes bytes = bytes_of(sum);
    // the header and the first operand, byte by byte
    const uint8_t start[] = {'P', 'I', 'R', 'S', 'U', 'M', '\r', '\n', 2, 0, 0, 0, 0, 0, 0, 0};
    const uint8_t operand[] = {3, 0, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 0,
                               1, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 1, 1};
    assert_memory_equal(bytes.data, start, sizeof start);
    assert_memory_equal(bytes.data + PIR_SUM_HEADER_SIZE, operand, sizeof operand);
    free(bytes.data);
    pir_sum_destroy(sum);
    pir_polytope_release(p);
}

static void refuse_cut_or_changed(double half_angle) {
    test_random random = test_random_case("cut", 0);
    test_pose pose;
    test_random_pose(&random, 12, &pose);
    pir_sum *sum = make_sum(&pose, 0, half_angle), *const before = (pir_sum *)&before, *back = before;
    test_bytes bytes = bytes_of(sum);
    uint8_t *copy = malloc(bytes.size + 1);
    assert_non_null(copy);
    pir_report report;
    // every beginning of it, as it is and with the length and checksum made to fit
    for (size_t size = 0; size < bytes.size; size++) {
        pir_status status = pir_sum_restore(bytes.data, size, NULL, &report, &back);
        expect(status == (size == 0 ? PIR_ERR_EMPTY : PIR_ERR_FORMAT) && strlen(report.text) > 10, "size %zu", size);
        memcpy(copy, bytes.data, size);
        if (size >= PIR_SUM_HEADER_SIZE) {
            test_bytes_seal(copy, size);
            expect(pir_sum_restore(copy, size, NULL, &report, &back) == PIR_ERR_FORMAT, "sealed, size %zu", size);
        }
    }
    // one byte more
    memcpy(copy, bytes.data, bytes.size);
    copy[bytes.size] = 0;
    test_bytes_seal(copy, bytes.size + 1);
    assert_int_equal(pir_sum_restore(copy, bytes.size + 1, NULL, &report, &back), PIR_ERR_FORMAT);
    // every bit of it
    memcpy(copy, bytes.data, bytes.size);
    for (size_t bit = 0; bit < 8 * bytes.size; bit++) {
        copy[bit / 8] ^= (uint8_t)(1u << bit % 8);
        pir_status status = pir_sum_restore(copy, bytes.size, NULL, &report, &back);
        expect(status == PIR_ERR_FORMAT || status == PIR_ERR_VERSION, "bit %zu", bit);
        copy[bit / 8] = bytes.data[bit / 8];
    }
    assert_ptr_equal(back, before);
    assert_int_equal(pir_sum_serialise(sum, copy, bytes.size - 1), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_restore(NULL, 9, NULL, &report, &back), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_write(sum, NULL, &report), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_write(NULL, stderr, &report), PIR_ERR_ARGUMENT);
    free(copy);
    free(bytes.data);
    pir_sum_destroy(sum);
}

static void bytes_that_were_cut_or_changed_are_refused(void **state) {
    (void)state;
    refuse_cut_or_changed(WHOLE);
    refuse_cut_or_changed(0.5);
}

/* One of the ways in which bytes go wrong. */
/* Another version of the format is told by its number, whatever comes after it. */
static void other_versions_are_named(void **state) {
    (void)state;
    test_random random = test_random_case("file versions", 0);
    test_pose pose;
    test_random_pose(&random, 10, &pose);
    pir_sum *sum = make_sum(&pose, 0, WHOLE), *const before = (pir_sum *)&before, *back = before;
    test_bytes bytes = test_bytes_of(sum);
    const uint8_t own = bytes.data[8];
    for (int version = 0; version < 256; version++) {
        pir_report report;
        char named[32];
        bytes.data[8] = (uint8_t)version;
        test_bytes_seal(bytes.data, bytes.size);
        if (version == own)
            continue;
        assert_int_equal(pir_sum_restore(bytes.data, bytes.size, NULL, &report, &back), PIR_ERR_VERSION);
        snprintf(named, sizeof named, "version %d,", version);
        assert_non_null(strstr(report.text, named));
        assert_ptr_equal(back, before);
    }
    free(bytes.data);
    pir_sum_destroy(sum);
}

static void mutate(test_random *random, uint8_t *data, size_t size) {
    size_t at = PIR_SUM_HEADER_SIZE + test_random_below(random, (uint32_t)(size - PIR_SUM_HEADER_SIZE));
    size_t other = PIR_SUM_HEADER_SIZE + test_random_below(random, (uint32_t)(size - PIR_SUM_HEADER_SIZE));
    switch (test_random_below(random, 5)) {
    case 0:
        data[at] = (uint8_t)test_random_bits(random);
        break;
    case 1:
        data[at] ^= (uint8_t)(1u << test_random_below(random, 8));
        break;
    case 2:
        for (size_t k = at; k < at + 4 && k < size; k++)
            data[k] = 0xff;
        break;
    case 3:
        for (size_t k = at & ~(size_t)3; k < size && k < (at & ~(size_t)3) + 4; k++)
            data[k] = 0;
        break;
    default:
        data[at] = data[other];
        break;
    }
}

/*
 * Bytes changed at random under a checksum that fits: refused, or read as a sum that proves valid. Memory stays in
 * proportion, whatever the counts say.
 */
static void made_up_bytes_are_refused_or_true(void **state) {
    (void)state;
    uint32_t accepted = 0, refused = 0;
    for (uint64_t i = 0; i < 60; i++) {
        test_random random = test_random_case("made up", i);
        test_pose pose;
        test_random_pose(&random, 12, &pose);
        pir_sum *sum = make_sum(&pose, 0, i % 3 ? WHOLE : 0.2 + 0.1 * (double)(i % 16));
        test_bytes bytes = bytes_of(sum);
        uint8_t *copy = malloc(bytes.size);
        assert_non_null(copy);
        test_memory memory = {0};
        pir_allocator allocator = test_allocator(&memory);
        size_t most = 0;
        {
            pir_sum *back = NULL;
            assert_int_equal(pir_sum_restore(bytes.data, bytes.size, &allocator, NULL, &back), PIR_OK);
            most = memory.bytes;
            pir_sum_destroy(back);
        }
        for (int n = 0; n < 200; n++) {
            memcpy(copy, bytes.data, bytes.size);
            for (uint32_t k = 1 + test_random_below(&random, 3); k > 0; k--)
                mutate(&random, copy, bytes.size);
            test_bytes_seal(copy, bytes.size);
            pir_report report = {PIR_OK, ""};
            pir_sum *back = NULL;
            pir_status status = pir_sum_restore(copy, bytes.size, &allocator, &report, &back);
            if (status == PIR_OK) {
                accepted++;
                expect(pir_sum_is_valid(back), "case %d, mutation %d", (int)i, n);
                expect(pir_sum_rotate(back, (pir_quat){1, 2, 3, 5}, PIR_METHOD_UPDATE) == PIR_OK &&
                           pir_sum_is_valid(back),
                       "case %d, mutation %d, turned", (int)i, n);
                expect(pir_polytope_is_valid(pir_sum_p(back)), "case %d, mutation %d", (int)i, n);
                expect(memory.bytes <= 8 * most + 65536, "case %d, mutation %d: %zu bytes", (int)i, n, memory.bytes);
                pir_sum_destroy(back);
            } else {
                refused++;
                expect(report.status == status && strlen(report.text) > 10, "case %d, mutation %d", (int)i, n);
            }
            expect(memory.blocks == 0 && !memory.wrong_size, "case %d, mutation %d", (int)i, n);
        }
        free(copy);
        free(bytes.data);
        pir_sum_destroy(sum);
    }
    // some changes keep the pairing: a vertex moved a little, another source
    print_message("%u accepted, %u refused\n", accepted, refused);
    assert_true(accepted > 100 && refused > 1000);
}

static void restoring_without_memory_leaves_nothing_behind(void **state) {
    (void)state;
    test_random random = test_random_case("file memory", 0);
    test_pose pose;
    test_random_pose(&random, 12, &pose);
    pir_sum *sum = make_sum(&pose, 0, 1);
    test_bytes bytes = bytes_of(sum);
    uint64_t n = 0;
    for (bool failed = true; failed;) {
        test_memory memory = {.fail_at = ++n};
        pir_allocator allocator = test_allocator(&memory);
        pir_sum *back = NULL;
        pir_report report;
        pir_status status = pir_sum_restore(bytes.data, bytes.size, &allocator, &report, &back);
        failed = status == PIR_ERR_MEMORY;
        expect(failed ? back == NULL : status == PIR_OK, "request %d: %s", (int)n, report.text);
        pir_sum_destroy(back);
        assert_int_equal(memory.blocks, 0);
    }
    assert_true(n > 20);
    free(bytes.data);
    pir_sum_destroy(sum);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(restored_sum_is_the_one_that_was_written),
        cmocka_unit_test(streams_hold_one_sum_after_another),
        cmocka_unit_test(golden_bytes_are_read_on_every_machine),
        cmocka_unit_test(bytes_that_were_cut_or_changed_are_refused),
        cmocka_unit_test(other_versions_are_named),
        cmocka_unit_test(made_up_bytes_are_refused_or_true),
        cmocka_unit_test(restoring_without_memory_leaves_nothing_behind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
