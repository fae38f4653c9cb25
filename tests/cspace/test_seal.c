/* SPDX-License-Identifier: MIT */
/*
 * Seals: of a file that was cut short, lengthened or changed anywhere, HDF5 is given nothing that was not written; what
 * other programs change is refused until it is sealed anew.
 */
#include "cspace/slice_scene.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <hdf5.h>

#include "support/random.h"

/* A file of slices, its bytes, and where another file may stand. */
struct sealed_world {
    char whole[SLICE_PATH], broken[SLICE_PATH];
    uint8_t *bytes;
    size_t size;
};

static void world_make(struct sealed_world *world, uint64_t steps) {
    struct slice_scene scene;
    pir_cspace_options options = slice_short_units();
    slice_scene_make(&scene, steps);
    scene.bodies.robot_count = scene.bodies.obstacle_count = 1;
    slice_path("sealed.h5", world->whole);
    slice_path("broken.h5", world->broken);
    slice_make_file(&scene, world->whole, &options);
    world->bytes = slice_read_whole(world->whole, &world->size);
    slice_scene_finish(&scene);
}

static void world_finish(struct sealed_world *world) {
    free(world->bytes);
    unlink(world->whole);
    unlink(world->broken);
}

/* Opens the broken file and reads all slices: the status of what failed. */
static pir_status read_broken(const struct sealed_world *world, pir_report *report) {
    pir_cspace *cspace = NULL;
    pir_status status = pir_cspace_open(world->broken, NULL, report, &cspace);
    for (uint64_t i = 0; status == PIR_OK && i < pir_cspace_get_info(cspace).grid.count; i++) {
        pir_slice slice;
        status = pir_cspace_slice(cspace, (pir_cspace_place){0, 0, i}, report, &slice);
    }
    pir_cspace_destroy(cspace);
    return status;
}

/* The file must be refused, by the check and by who reads it, with one of these words. */
static void expect_refused(const struct sealed_world *world, const char *words, const char *others) {
    pir_report report = {0};
    assert_int_equal(pir_cspace_check(world->broken, NULL, &report), PIR_ERR_FORMAT);
    expect(strstr(report.text, words) || strstr(report.text, others), "'%s'", report.text);
    assert_int_equal(read_broken(world, &report), PIR_ERR_FORMAT);
    expect(strstr(report.text, words) || strstr(report.text, others), "'%s'", report.text);
    assert_int_equal(H5Fget_obj_count((hid_t)H5F_OBJ_ALL, H5F_OBJ_ALL), 0);
}

static void a_file_cut_at_any_length_is_refused(void **state) {
    (void)state;
    struct sealed_world world;
    pir_report report;
    world_make(&world, 3);
    slice_write_whole(world.broken, world.bytes, world.size);
    assert_int_equal(pir_cspace_check(world.broken, NULL, NULL), PIR_OK);
    for (size_t size = world.size; size-- > 0;) {
        assert_int_equal(truncate(world.broken, (off_t)size), 0);
        pir_cspace *cspace = NULL;
        assert_int_equal(pir_cspace_open(world.broken, NULL, &report, &cspace), PIR_ERR_FORMAT);
        expect(strstr(report.text, size < 8 ? "it is no HDF5" : "no seal at its end"), "%zu: '%s'", size, report.text);
    }
    printf("# cut at %zu lengths\n", world.size);
    // longer than it was
    slice_write_whole(world.broken, world.bytes, world.size);
    assert_int_equal(truncate(world.broken, (off_t)world.size + 1), 0);
    expect_refused(&world, "no seal at its end", "");
    world_finish(&world);
}

/* Overwrites `length` bytes from `at` on, asks, and puts them back. */
static void change(const struct sealed_world *world, FILE *file, size_t at, size_t length, int with) {
    uint8_t changed[64];
    length = world->size - at < length ? world->size - at : length;
    for (size_t i = 0; i < length; i++)
        changed[i] = with < 0 ? (uint8_t)~world->bytes[at + i] : (uint8_t)with;
    if (memcmp(changed, world->bytes + at, length) == 0)
        return;
    assert_true(fseek(file, (long)at, SEEK_SET) == 0 && fwrite(changed, 1, length, file) == length);
    assert_int_equal(fflush(file), 0);
    pir_report report;
    const pir_status status = read_broken(world, &report);
    // bytes that hold nothing may stand in a block that nobody reads
    expect(status == PIR_ERR_FORMAT || (status == PIR_OK && at >= 8), "%zu: %d", at, (int)status);
    assert_int_equal(pir_cspace_check(world->broken, NULL, NULL), PIR_ERR_FORMAT);
    assert_true(fseek(file, (long)at, SEEK_SET) == 0 && fwrite(world->bytes + at, 1, length, file) == length);
    assert_int_equal(fflush(file), 0);
}

/* Among these are changes that crashed HDF5 1.10.8. */
static void a_file_changed_anywhere_is_refused(void **state) {
    (void)state;
    struct sealed_world world;
    world_make(&world, 30);
    slice_write_whole(world.broken, world.bytes, world.size);
    FILE *file = fopen(world.broken, "r+b");
    assert_non_null(file);
    for (size_t at = 0; at < world.size; at += 16) {
        change(&world, file, at, 1 + at / 16 % 8, 0xff);
        change(&world, file, at + 8 < world.size ? at + 8 : at, 1, -1);
        change(&world, file, at, 16, 0);
    }
    fclose(file);
    assert_int_equal(pir_cspace_check(world.broken, NULL, NULL), PIR_OK);
    world_finish(&world);
}

/* What h5py and others do to a file that they open for writing. */
static void a_file_that_was_added_to_is_sealed_anew(void **state) {
    (void)state;
    struct sealed_world world;
    pir_report report = {0};
    world_make(&world, 30);
    slice_write_whole(world.broken, world.bytes, world.size);
    hid_t file = H5Fopen(world.broken, H5F_ACC_RDWR, H5P_DEFAULT);
    assert_true(file >= 0);
    hid_t group = H5Gcreate2(file, "notes", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(group >= 0 && H5Gclose(group) >= 0 && H5Fclose(file) >= 0);
    expect_refused(&world, "no seal at its end", "its seal is damaged");
    for (int i = 0; i < 2; i++) {
        assert_int_equal(pir_cspace_seal(world.broken, NULL, &report), PIR_OK);
        expect(read_broken(&world, &report) == PIR_OK, "%s", report.text);
        assert_int_equal(pir_cspace_check(world.broken, NULL, NULL), PIR_OK);
    }
    // a seal that is renewed where nothing was added is the one that was there
    slice_write_whole(world.broken, world.bytes, world.size);
    assert_int_equal(pir_cspace_seal(world.broken, NULL, &report), PIR_OK);
    slice_expect_same_files(world.whole, world.broken);
    world_finish(&world);
}

/* More than one block of hashes: the first, the last and one between are each found to be changed. */
static void a_long_file_has_hashes_of_hashes(void **state) {
    (void)state;
    struct sealed_world world;
    world_make(&world, 3);
    const size_t more = ((size_t)36 << 20) + 1234;
    FILE *file = fopen(world.whole, "r+b");
    assert_non_null(file);
    // HDF5 reads no further than it has written
    assert_true(fseek(file, (long)more, SEEK_SET) == 0 && fputc(1, file) == 1 && fclose(file) == 0);
    assert_int_equal(pir_cspace_seal(world.whole, NULL, NULL), PIR_OK);
    assert_int_equal(pir_cspace_check(world.whole, NULL, NULL), PIR_OK);
    free(world.bytes);
    world.bytes = slice_read_whole(world.whole, &world.size);
    const size_t places[] = {100, (size_t)17 << 20, more, more + 1, more + 20000, world.size - 100, world.size - 64};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        world.bytes[places[i]] ^= 4;
        slice_write_whole(world.broken, world.bytes, world.size);
        world.bytes[places[i]] ^= 4;
        pir_report report;
        assert_int_equal(pir_cspace_check(world.broken, NULL, &report), PIR_ERR_FORMAT);
    }
    world_finish(&world);
}

static void what_is_no_file_is_refused(void **state) {
    (void)state;
    pir_report report;
    char path[SLICE_PATH];
    pir_cspace *cspace = NULL;
    slice_path("nothing.h5", path);
    assert_int_equal(pir_cspace_open(path, NULL, &report, &cspace), PIR_ERR_FILE);
    assert_int_equal(pir_cspace_check(path, NULL, &report), PIR_ERR_FILE);
    assert_int_equal(pir_cspace_seal(path, NULL, &report), PIR_ERR_FILE);
    assert_int_equal(pir_cspace_open("/", NULL, &report, &cspace), PIR_ERR_FILE);
    assert_int_equal(pir_cspace_open("/dev/zero", NULL, &report, &cspace), PIR_ERR_FILE);
    assert_non_null(strstr(report.text, "no regular file"));
    assert_int_equal(pir_cspace_check(NULL, NULL, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_cspace_seal(NULL, NULL, NULL), PIR_ERR_ARGUMENT);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_cut_at_any_length_is_refused),
        cmocka_unit_test(a_file_changed_anywhere_is_refused),
        cmocka_unit_test(a_file_that_was_added_to_is_sealed_anew),
        cmocka_unit_test(a_long_file_has_hashes_of_hashes),
        cmocka_unit_test(what_is_no_file_is_refused),
    };
    return cmocka_run_group_tests(tests, slice_make_folder, slice_remove_folder);
}
