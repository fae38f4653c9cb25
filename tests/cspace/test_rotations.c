/* SPDX-License-Identifier: MIT */
/* Rotations from files: text and npy, good and bad, each bad one told with its place. */
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/grid.h>

#include "support/memory.h"
#include "support/random.h"

struct bad {
    const char *text;
    pir_status status;
    const char *report;
};

static pir_status read_text(const char *text, size_t size, pir_report *report, pir_grid **ret_grid) {
    // a copy of the very size, so that a look beyond its end is noticed
    char *copy = malloc(size ? size : 1);
    memcpy(copy, text, size);
    pir_status status = pir_grid_read_bytes(copy, size, "turns.csv", NULL, report, ret_grid);
    free(copy);
    return status;
}

static void text_is_read(void **state) {
    (void)state;
    static const char *const texts[] = {
        "x,y,z,w\n0,0,0,1\n1,0,0,0\n",
        "0 0 0 1\n1 0 0 0",
        "# two\r\n\r\n  0 , 0,0 ,\t1 # one\r\n+1.0e0,-0,.0,0.\r\n",
        "qx qy qz qw\n\n0\t0\t0\t1\n\n\n1 0 0 0\n\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        pir_grid *grid = NULL;
        pir_report report = {0};
        expect(read_text(texts[i], strlen(texts[i]), &report, &grid) == PIR_OK, "text %zu: %s", i, report.text);
        assert_int_equal(pir_grid_get_info(grid).count, 2);
        pir_quat q = pir_grid_rotation(grid, 1);
        assert_true(q.x == 1 && q.w == 0 && pir_grid_get_info(grid).kind == PIR_GRID_LIST);
        pir_grid_destroy(grid);
    }
}

static void bad_text_is_told_with_its_line(void **state) {
    (void)state;
    static const struct bad cases[] = {
        {"", PIR_ERR_EMPTY, "turns.csv: the file is empty"},
        {"# none\n\n", PIR_ERR_EMPTY, "turns.csv: holds no rows"},
        {"x,y,z,w\n", PIR_ERR_EMPTY, "turns.csv: holds no rows"},
        {"0,0,0,1\n0,nan,0,1\n", PIR_ERR_NOT_FINITE, "turns.csv:2: 'nan' is not a finite number"},
        {"nan,nan,nan,nan\n", PIR_ERR_NOT_FINITE, "turns.csv:1: 'nan' is not a finite number"},
        {"0,0,0,1\n0,0,-inf,1\n", PIR_ERR_NOT_FINITE, "turns.csv:2: '-inf' is not a finite number"},
        {"0,0,0,1e999\n", PIR_ERR_NOT_FINITE, "turns.csv:1: '1e999' is not a finite number"},
        {"0,0,0,1\n\n0,0,1\n", PIR_ERR_FORMAT, "turns.csv:3: 3 numbers, not 4: x,y,z,w"},
        {"0,0,0,1,\n", PIR_ERR_FORMAT, "turns.csv:1: '' is not a number"},
        {"0,0,0,1,5\n", PIR_ERR_FORMAT, "turns.csv:1: 5 numbers, not 4: x,y,z,w"},
        {"0 0 0 1\n0 0 zero 1\n", PIR_ERR_FORMAT, "turns.csv:2: 'zero' is not a number"},
        {"0,0,0,1\nx,y,z,w\n", PIR_ERR_FORMAT, "turns.csv:2: 'x' is not a number"},
        {"0;0;0;1\n0;0;0;1\n", PIR_ERR_FORMAT, "turns.csv:2: '0;0;0;1' is not a number"},
        {"w x\n0,0,0,1\n0,0,0,0\n", PIR_ERR_ZERO_QUATERNION, "turns.csv:3: the quaternion 0, 0, 0, 0 is no rotation"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        pir_grid *grid = NULL;
        pir_report report = {0};
        pir_status status = read_text(cases[i].text, strlen(cases[i].text), &report, &grid);
        assert_string_equal(report.text, cases[i].report);
        assert_int_equal(status, cases[i].status);
        assert_int_equal(report.status, status);
        assert_null(grid);
    }
    pir_report report = {0};
    pir_grid *grid = NULL;
    assert_int_equal(read_text("0,0,0,1\n0,\0,0,1\n", 16, &report, &grid), PIR_ERR_FORMAT);
    assert_string_equal(report.text, "turns.csv:2: a zero byte");
    assert_int_equal(pir_grid_read("/nowhere/turns.csv", NULL, &report, &grid), PIR_ERR_FILE);
    assert_string_equal(report.text, "/nowhere/turns.csv: cannot open: No such file or directory");
}

/* An npy file of version 1 with this header and `count` doubles. */
static size_t make_npy(char *bytes, const char *header, const double *values, size_t count) {
    const size_t length = strlen(header);
    memcpy(bytes, "\x93NUMPY\x01\x00", 8);
    bytes[8] = (char)(length & 255);
    bytes[9] = (char)(length >> 8);
    memcpy(bytes + 10, header, length);
    // values as this machine stores them, which the header says
    memcpy(bytes + 10 + length, values, count * sizeof *values);
    return 10 + length + count * sizeof *values;
}

static const char *native(void) {
    const uint16_t one = 1;
    return *(const char *)&one ? "<f8" : ">f8";
}

static void npy_is_read(void **state) {
    (void)state;
    static const double values[] = {0, 0, 0, 1, 3, 0, 0, 0, 1, 2, 3, 4};
    char header[128], bytes[512];
    snprintf(header, sizeof header, "{'descr': '%s', 'fortran_order': False, 'shape': (3, 4), }      \n", native());
    size_t size = make_npy(bytes, header, values, 12);
    pir_grid *grid = NULL;
    pir_report report = {0};
    expect(read_text(bytes, size, &report, &grid) == PIR_OK, "%s", report.text);
    assert_int_equal(pir_grid_get_info(grid).count, 3);
    for (uint64_t i = 0; i < 3; i++) {
        pir_quat q = pir_grid_rotation(grid, i);
        assert_memory_equal(&q, values + 4 * pir_grid_cell(grid, i), sizeof q);
    }
    pir_grid_destroy(grid);
    // the other order of bytes
    header[11] = header[11] == '<' ? '>' : '<';
    size = make_npy(bytes, header, values, 12);
    for (size_t at = 10 + strlen(header); at < size; at += 8)
        for (int k = 0; k < 4; k++) {
            char held = bytes[at + k];
            bytes[at + k] = bytes[at + 7 - k];
            bytes[at + 7 - k] = held;
        }
    assert_int_equal(read_text(bytes, size, &report, &grid), PIR_OK);
    assert_true(pir_grid_rotation(grid, pir_grid_cell(grid, 0)).w != 0);
    pir_grid_destroy(grid);
}

static void bad_npy_is_told(void **state) {
    (void)state;
    static const struct bad cases[] = {
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (1, 4), }", PIR_ERR_FORMAT,
         "turns.csv: npy header: descr is not '<f8' or '>f8', the numbers are no float64"},
        {"{'descr': '<f8', 'fortran_order': True, 'shape': (1, 4), }", PIR_ERR_FORMAT,
         "turns.csv: npy header: fortran_order is not False, the array is not stored by rows"},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (4,), }", PIR_ERR_FORMAT,
         "turns.csv: npy header: shape is not (rows, columns)"},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (1, 5), }", PIR_ERR_FORMAT,
         "turns.csv: rows of 5 numbers, not 4: x,y,z,w"},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (9, 4), }", PIR_ERR_FORMAT,
         "turns.csv: ends in row 1 of 9"},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (999999999999999999, 4), }", PIR_ERR_FORMAT,
         "turns.csv: ends in row 1 of 999999999999999999"},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (9999999999999999999, 4), }", PIR_ERR_FORMAT,
         "turns.csv: npy header: shape is not (rows, columns)"},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (0, 4), }", PIR_ERR_FORMAT,
         "turns.csv: 32 bytes behind the last row"},
        {"{'descr': '<f8', 'shape': (1, 4), }", PIR_ERR_FORMAT,
         "turns.csv: npy header: descr, fortran_order or shape is missing"},
        {"{'what': 1}", PIR_ERR_FORMAT, "turns.csv: npy header: another key than descr, fortran_order and shape"},
        {"{'descr' '<f8'}", PIR_ERR_FORMAT, "turns.csv: npy header: no ':' behind a key"},
        {"{'descr': '<f8' 'shape': (1, 4)}", PIR_ERR_FORMAT, "turns.csv: npy header: no ',' or '}' behind a value"},
        {"[1]", PIR_ERR_FORMAT, "turns.csv: npy header: no dictionary"},
    };
    static const double one[] = {0, 0, 0, 1};
    char bytes[512];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        pir_grid *grid = NULL;
        pir_report report = {0};
        size_t size = make_npy(bytes, cases[i].text, one, 4);
        pir_status status = read_text(bytes, size, &report, &grid);
        assert_string_equal(report.text, cases[i].report);
        assert_int_equal(status, cases[i].status);
        assert_null(grid);
    }
    char header[128];
    snprintf(header, sizeof header, "{'descr': '%s', 'fortran_order': False, 'shape': (2, 4)}", native());
    const double wild[] = {0, 0, 0, 1, 0, 0, (double)NAN, 1}, zero[8] = {0, 0, 0, 1};
    pir_report report = {0};
    pir_grid *grid = NULL;
    assert_int_equal(read_text(bytes, make_npy(bytes, header, wild, 8), &report, &grid), PIR_ERR_NOT_FINITE);
    assert_non_null(strstr(report.text, "turns.csv: row 1: number 3 of x,y,z,w is "));
    assert_int_equal(read_text(bytes, make_npy(bytes, header, zero, 8), &report, &grid), PIR_ERR_ZERO_QUATERNION);
    assert_string_equal(report.text, "turns.csv: row 1: the quaternion 0, 0, 0, 0 is no rotation");
}

/* Files cut short and changed at random are read or refused; sanitizers see to the rest. */
static void changed_files_do_no_harm(void **state) {
    (void)state;
    static const double values[] = {0, 0, 0, 1, 3, 0, 0, 0, 1, 2, 3, 4};
    char header[128], bytes[512], changed[512];
    snprintf(header, sizeof header, "{'descr': '%s', 'fortran_order': False, 'shape': (3, 4), }", native());
    size_t sizes[2] = {make_npy(bytes, header, values, 12), 0};
    static const char text[] = "x,y,z,w\n0,0,0,1\n# more\n0.5 1e-3 7 -2\n1,2,3,4\n";
    uint32_t read = 0, refused = 0;
    for (int i = 0; i < 20000; i++) {
        test_random random = test_random_case("changed rotations", (uint64_t)i);
        const bool npy = i % 2;
        size_t size = npy ? sizes[0] : sizeof text - 1;
        memcpy(changed, npy ? bytes : text, size);
        for (uint32_t k = test_random_below(&random, 4); k > 0; k--)
            changed[test_random_below(&random, (uint32_t)size)] = (char)test_random_bits(&random);
        if (i % 3 == 0)
            size = test_random_below(&random, (uint32_t)size + 1);
        pir_grid *grid = NULL;
        pir_report report = {0};
        pir_status status = read_text(changed, size, &report, &grid);
        if (status == PIR_OK)
            read++;
        else
            refused++;
        assert_true(status == PIR_OK ? grid != NULL : !grid && report.status == status && report.text[0] != '\0');
        pir_grid_destroy(grid);
    }
    assert_true(read > 1000 && refused > 1000);
}

static void no_memory_is_a_status(void **state) {
    (void)state;
    char text[4096] = "";
    for (int i = 1; i < 100; i++)
        sprintf(text + strlen(text), "%d,1,2,3\n", i);
    for (uint64_t n = 1;; n++) {
        test_memory memory = {.fail_at = n};
        pir_allocator allocator = test_allocator(&memory);
        pir_grid *grid = NULL;
        pir_report report = {0};
        pir_status status = pir_grid_read_bytes(text, strlen(text), NULL, &allocator, &report, &grid);
        assert_true(status == PIR_OK ? grid != NULL : status == PIR_ERR_MEMORY && !grid && report.status == status);
        pir_grid_destroy(grid);
        assert_true(memory.blocks == 0 && !memory.wrong_size && !memory.overrun);
        if (status == PIR_OK) {
            assert_true(n > 4);
            break;
        }
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_is_read),
        cmocka_unit_test(bad_text_is_told_with_its_line),
        cmocka_unit_test(npy_is_read),
        cmocka_unit_test(bad_npy_is_told),
        cmocka_unit_test(changed_files_do_no_harm),
        cmocka_unit_test(no_memory_is_a_status),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
