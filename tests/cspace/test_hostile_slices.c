/* SPDX-License-Identifier: MIT */
/*
 * Files of slices that were made to do harm: each is whole HDF5 under a seal that matches, but says something that a
 * file of slices may not. All are refused with the place named, without much memory, and without a look at another
 * file.
 */
#include "support/test.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <hdf5.h>

#include "cspace/answer_world.h"
#include "support/memory.h"

#define WHOLE  "hostile-whole.h5"
#define BROKEN "hostile-broken.h5"
#define OTHER  "hostile-other.h5"

/* A list of rotations, so that all of them are read when the file is opened. */
static int make_whole(void **state) {
    (void)state;
    pir_quat list[40];
    for (int i = 0; i < 40; i++)
        list[i] = (pir_quat){i, 1, 2, 40};
    pir_grid *grid = NULL;
    assert_int_equal(pir_grid_list(list, 40, 0, NULL, &grid), PIR_OK);
    answer_world world;
    answer_world_init(&world, 1, grid);
    answer_world_write(&world, WHOLE);
    answer_world_finish(&world);
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    unlink(WHOLE);
    unlink(BROKEN);
    unlink(OTHER);
    return 0;
}

static void copy_file(const char *from, const char *to) {
    char block[4096];
    FILE *in = fopen(from, "rb"), *out = fopen(to, "wb");
    assert_true(in && out);
    for (size_t size; (size = fread(block, 1, sizeof block, in)) > 0;)
        assert_int_equal(fwrite(block, 1, size, out), size);
    fclose(in);
    fclose(out);
}

static hid_t begin(void) {
    copy_file(WHOLE, BROKEN);
    hid_t file = H5Fopen(BROKEN, H5F_ACC_RDWR, H5P_DEFAULT);
    assert_true(file >= 0);
    return file;
}

/* Closes the file under a seal that matches. */
static void end(hid_t file) {
    assert_true(H5Fclose(file) >= 0);
    assert_int_equal(pir_cspace_seal(BROKEN, NULL, NULL), PIR_OK);
}

/* Closes the file, and asks it: it must be refused, with these words. */
static void expect_refused(hid_t file, const char *words) {
    end(file);
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_cspace *cspace = NULL;
    pir_report report = {0};
    pir_status status = pir_cspace_open(BROKEN, &allocator, &report, &cspace);
    const pir_pose pose = {{0, 1, 2, 40}, {0, 0, 0}};
    pir_configuration answer;
    pir_sum *sum = NULL;
    if (status == PIR_OK)
        status = pir_cspace_classify(cspace, &pose, &report, &answer);
    if (status == PIR_OK)
        status = pir_cspace_sum(cspace, answer.place, &report, &sum);
    pir_sum_destroy(sum);
    pir_cspace_destroy(cspace);
    assert_true(status != PIR_OK && report.status == status);
    expect(strstr(report.text, words) != NULL, "'%s' has no '%s'", report.text, words);
    expect(memory.peak < (size_t)64 << 20, "%zu bytes at a time", memory.peak);
    assert_int_equal(memory.blocks, 0);
}

static void the_whole_file_answers(void **state) {
    (void)state;
    pir_cspace *cspace = NULL;
    pir_report report = {0};
    expect(pir_cspace_open(WHOLE, NULL, &report, &cspace) == PIR_OK, "%s", report.text);
    const pir_pose pose = {{0, 1, 2, 40}, {0, 0, 0}};
    pir_configuration answer;
    assert_int_equal(pir_cspace_classify(cspace, &pose, &report, &answer), PIR_OK);
    assert_true(answer.on_grid && answer.verdict == PIR_VERDICT_BLOCKED);
    pir_cspace_destroy(cspace);
}

/* A data set in place of another, of these dimensions. */
static void replace(hid_t file, const char *name, hid_t type, int rank, const hsize_t *size, hid_t how) {
    assert_true(H5Ldelete(file, name, H5P_DEFAULT) >= 0);
    hid_t space = H5Screate_simple(rank, size, NULL);
    hid_t set = H5Dcreate2(file, name, type, space, H5P_DEFAULT, how, H5P_DEFAULT);
    assert_true(set >= 0);
    H5Dclose(set);
    H5Sclose(space);
}

static void sizes_that_lie_are_refused(void **state) {
    (void)state;
    // as many rotations as a list may have, none of them stored, and tables to match
    const hsize_t many[2] = {PIR_GRID_LIST_MAX, 4}, chunk[2] = {1024, 4}, row[2] = {1, 4096};
    const hsize_t slices[2] = {1, PIR_GRID_LIST_MAX}, units[2] = {1, PIR_GRID_LIST_MAX / 16};
    hid_t chunked = H5Pcreate(H5P_DATASET_CREATE), rows = H5Pcreate(H5P_DATASET_CREATE), file = begin();
    H5Pset_chunk(chunked, 2, chunk);
    H5Pset_chunk(rows, 2, row);
    replace(file, "grid/rotation", H5T_IEEE_F64LE, 2, many, chunked);
    replace(file, "slices/length", H5T_STD_U32LE, 2, slices, rows);
    replace(file, "slices/unit", H5T_STD_U64LE, 2, units, rows);
    replace(file, "slices/check", H5T_STD_U64LE, 2, units, rows);
    expect_refused(file, "grid/rotation: row 0: it is no rotation");
    // more than that
    const hsize_t more[2] = {(hsize_t)1 << 40, 4};
    file = begin();
    replace(file, "grid/rotation", H5T_IEEE_F64LE, 2, more, chunked);
    expect_refused(file, "slices: a data set");
    // a chunk of 4 GB minus a little
    const hsize_t few[2] = {40, 4}, wide[2] = {(hsize_t)1 << 26, 4};
    file = begin();
    const hsize_t unlimited[2] = {H5S_UNLIMITED, 4};
    hid_t huge = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(2, few, unlimited);
    H5Pset_chunk(huge, 2, wide);
    assert_true(H5Ldelete(file, "grid/rotation", H5P_DEFAULT) >= 0);
    hid_t set = H5Dcreate2(file, "grid/rotation", H5T_IEEE_F64LE, space, H5P_DEFAULT, huge, H5P_DEFAULT);
    assert_true(set >= 0);
    H5Dclose(set);
    H5Sclose(space);
    expect_refused(file, "grid/rotation");
    H5Pclose(huge);
    H5Pclose(chunked);
    H5Pclose(rows);
}

static void other_files_are_not_opened(void **state) {
    (void)state;
    copy_file(WHOLE, OTHER);
    // links to another file, to a data set and to a group
    hid_t file = begin();
    H5Ldelete(file, "grid/rotation", H5P_DEFAULT);
    assert_true(H5Lcreate_external(OTHER, "/grid/rotation", file, "grid/rotation", H5P_DEFAULT, H5P_DEFAULT) >= 0);
    expect_refused(file, "grid/rotation");
    file = begin();
    H5Ldelete(file, "robot", H5P_DEFAULT);
    assert_true(H5Lcreate_external(OTHER, "/robot", file, "robot", H5P_DEFAULT, H5P_DEFAULT) >= 0);
    expect_refused(file, "robot");
    // a data set that is kept in another file, as it stands there
    const hsize_t size[2] = {40, 4};
    file = begin();
    hid_t outside = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(outside, "/etc/passwd", 0, 40 * 32);
    replace(file, "grid/rotation", H5T_IEEE_F64LE, 2, size, outside);
    expect_refused(file, "grid/rotation");
    H5Pclose(outside);
    // a view of one in another file
    file = begin();
    hid_t view = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(2, size, NULL);
    assert_true(H5Pset_virtual(view, space, OTHER, "/grid/rotation", space) >= 0);
    replace(file, "grid/rotation", H5T_IEEE_F64LE, 2, size, view);
    expect_refused(file, "grid/rotation");
    H5Sclose(space);
    H5Pclose(view);
}

static void put_number(hid_t file, const char *name, uint32_t number) {
    hid_t attribute = H5Aopen(file, name, H5P_DEFAULT);
    assert_true(attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_UINT32, &number) >= 0);
    H5Aclose(attribute);
}

static void another_version_or_hash_is_refused(void **state) {
    (void)state;
    hid_t file = begin();
    // the one before, and the next
    put_number(file, "version", 2);
    expect_refused(file, "version");
    file = begin();
    put_number(file, "version", 4);
    expect_refused(file, "version");
    file = begin();
    hid_t piece = H5Gopen2(file, "robot/0", H5P_DEFAULT), attribute = H5Aopen(piece, "hash", H5P_DEFAULT);
    hid_t type = H5Aget_type(attribute);
    char text[64] = "0123456789abcdef";
    assert_true(piece >= 0 && attribute >= 0 && H5Awrite(attribute, type, text) >= 0);
    H5Tclose(type);
    H5Aclose(attribute);
    H5Gclose(piece);
    expect_refused(file, "hash");
    file = begin();
    assert_true(H5Ldelete(file, "slices/bytes", H5P_DEFAULT) >= 0);
    expect_refused(file, "slices");
}

/* FNV-1a, 64 bits, eight bytes at a time, as docs/slices.md has it. */
static uint64_t checksum(const uint8_t *bytes, size_t size) {
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < size; i += 8) {
        uint64_t word = 0;
        for (size_t k = i; k < size && k < i + 8; k++)
            word |= (uint64_t)bytes[k] << 8 * (k - i);
        hash = (hash ^ word) * UINT64_C(0x100000001b3);
    }
    return hash;
}

/*
 * Records of another rotation, under checksums that match: nothing but the proof of the pairing can tell. The rotations
 * change their places instead, which comes to the same.
 */
static void another_pairing_is_refused(void **state) {
    (void)state;
    hid_t file = begin();
    double rotation[40][4], kept[4];
    hid_t set = H5Dopen2(file, "grid/rotation", H5P_DEFAULT);
    assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, rotation) >= 0);
    int at = 0;
    while (rotation[at][0] != 0)
        at++;
    const int other = at < 20 ? 39 : 0;
    memcpy(kept, rotation[at], sizeof kept);
    memcpy(rotation[at], rotation[other], sizeof kept);
    memcpy(rotation[other], kept, sizeof kept);
    assert_true(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, rotation) >= 0);
    H5Dclose(set);
    expect_refused(file, "it is not the pairing at its rotation");
}

/* The bytes of the records of each unit. */
static void find_sizes(hid_t file, uint64_t ret_sizes[3]) {
    uint32_t length[40];
    hid_t set = H5Dopen2(file, "slices/length", H5P_DEFAULT), group = H5Gopen2(file, "slices", H5P_DEFAULT);
    hid_t attribute = H5Aopen(group, "slices_per_unit", H5P_DEFAULT);
    uint32_t per_unit = 0;
    assert_true(H5Dread(set, H5T_NATIVE_UINT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, length) >= 0);
    assert_true(H5Aread(attribute, H5T_NATIVE_UINT32, &per_unit) >= 0 && (40 + per_unit - 1) / per_unit == 3);
    H5Aclose(attribute);
    H5Gclose(group);
    H5Dclose(set);
    for (int u = 0; u < 3; u++)
        ret_sizes[u] = 0;
    for (uint32_t i = 0; i < 40; i++)
        ret_sizes[i / per_unit] += length[i];
}

/* A byte of a record changed, and the checksum with it: refused, wherever it is, or of no slice that is asked. */
static void changed_records_are_refused(void **state) {
    (void)state;
    uint32_t refused = 0;
    for (uint32_t i = 0; i < 60; i++) {
        test_random random = test_random_case("records", i);
        hid_t file = begin(), set = H5Dopen2(file, "slices/bytes", H5P_DEFAULT), space = H5Dget_space(set);
        hssize_t size = H5Sget_simple_extent_npoints(space);
        uint8_t *bytes = malloc((size_t)size);
        uint64_t unit[3], check[3], sizes[3];
        find_sizes(file, sizes);
        hid_t units = H5Dopen2(file, "slices/unit", H5P_DEFAULT), checks = H5Dopen2(file, "slices/check", H5P_DEFAULT);
        assert_true(H5Dread(set, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes) >= 0);
        assert_true(H5Dread(units, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, unit) >= 0);
        bytes[unit[i % 3] + test_random_bits(&random) % sizes[i % 3]] = (uint8_t)test_random_bits(&random);
        for (int u = 0; u < 3; u++)
            check[u] = checksum(bytes + unit[u], (size_t)sizes[u]);
        assert_true(H5Dwrite(set, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes) >= 0);
        assert_true(H5Dwrite(checks, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, check) >= 0);
        free(bytes);
        H5Sclose(space);
        H5Dclose(set);
        H5Dclose(units);
        H5Dclose(checks);
        end(file);
        pir_cspace *cspace = NULL;
        pir_report report = {0};
        expect(pir_cspace_open(BROKEN, NULL, &report, &cspace) == PIR_OK, "%s", report.text);
        bool all = true;
        for (uint64_t slice = 0; slice < 40; slice++) {
            pir_sum *sum = NULL;
            pir_status status = pir_cspace_sum(cspace, (pir_cspace_place){0, 0, slice}, &report, &sum);
            assert_true(status == PIR_OK || status == PIR_ERR_FORMAT);
            // what is given is right, whatever the file says
            assert_true(status != PIR_OK || pir_sum_is_valid(sum));
            all = all && status == PIR_OK;
            pir_sum_destroy(sum);
        }
        refused += !all;
        pir_cspace_destroy(cspace);
    }
    printf("# 60 changed records: %u refused\n", refused);
    assert_true(refused > 30);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_whole_file_answers),     cmocka_unit_test(sizes_that_lie_are_refused),
        cmocka_unit_test(other_files_are_not_opened), cmocka_unit_test(another_version_or_hash_is_refused),
        cmocka_unit_test(another_pairing_is_refused), cmocka_unit_test(changed_records_are_refused),
    };
    return cmocka_run_group_tests(tests, make_whole, remove_files);
}
