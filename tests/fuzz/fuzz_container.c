/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as a file of slices, as they are and with the last 64 bytes made those of a seal, so that what lies behind
 * these is reached: it is refused with a report of one line, or every slice is the pairing of its rotation and poses at
 * it have the state that pairs by need find.
 *
 * HDF5 sees only what has been sealed, so bytes that are changed end at the seal. write_containers.c makes the files to
 * start from; see fuzz_sum.c for how to run an engine.
 */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <pirouette/cspace.h>
#include <pirouette/pirouette.h>

#include "fuzz/input.h"
#include "support/memory.h"

#define SIZE_LIMIT ((size_t)1 << 17)
#define SLICES     12

/* HDF5 does not free all that it has made of a broken file. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
    return "leak:libhdf5";
}

/* A file without a name, which opens under the path. */
static int make_file(const uint8_t *data, size_t size, char path[32]) {
    char name[256];
    const char *folder = getenv("TMPDIR");
    snprintf(name, sizeof name, "%s/pirouette-container-XXXXXX", folder ? folder : "/tmp");
    int descriptor = mkstemp(name);
    fuzz_require(descriptor >= 0 && unlink(name) == 0, "there is a place for files");
    fuzz_require(write(descriptor, data, size) == (ssize_t)size, "a file is written");
    snprintf(path, 32, "/dev/fd/%d", descriptor);
    return descriptor;
}

static pir_state state_of(pir_cspace *cspace, const pir_pose *pose) {
    const pir_cspace_info info = pir_cspace_get_info(cspace);
    pir_workspace *workspace = NULL;
    pir_state most = PIR_OUTSIDE;
    fuzz_require(pir_workspace_create(NULL, &workspace) == PIR_OK, "a workspace is made");
    for (uint32_t k = 0; k < info.robot_count * info.obstacle_count; k++) {
        pir_pair *pair = NULL;
        pir_query_result result;
        // polytopes are shared by reference count, which is all that changes in them
        pir_polytope *p = (pir_polytope *)pir_cspace_robot(cspace, k / info.obstacle_count);
        pir_polytope *q = (pir_polytope *)pir_cspace_obstacle(cspace, k % info.obstacle_count);
        pir_pair_input input = pir_pair_input_default();
        input.pose_p = *pose;
        fuzz_require(pir_pair_create(p, q, NULL, &pair) == PIR_OK, "a pair is made");
        fuzz_require(pir_pair_overlap(pair, workspace, &input, &result) == PIR_OK, "a pair answers");
        most = result.state > most ? result.state : most;
        pir_pair_destroy(pair);
    }
    pir_workspace_destroy(workspace);
    return most;
}

/* What is proven of a slice, and a pose at its rotation. */
static pir_status check_slice(pir_cspace *cspace, uint64_t slice, pir_report *report) {
    pir_sum *sum = NULL;
    pir_status status = pir_cspace_sum(cspace, (pir_cspace_place){0, 0, slice}, report, &sum);
    if (status != PIR_OK)
        return status;
    fuzz_require(pir_sum_is_valid(sum), "a slice is the pairing of its rotation");
    pir_sum_destroy(sum);
    const pir_pose pose = {pir_grid_rotation(pir_cspace_grid(cspace), slice), {0.25 * (double)slice, 0.5, 0.125}};
    pir_configuration answer;
    status = pir_cspace_classify(cspace, &pose, report, &answer);
    if (status == PIR_OK && answer.on_grid)
        fuzz_require(answer.state == state_of(cspace, &pose), "a pose at a slice has its exact state");
    return status;
}

static void read_file(const uint8_t *data, size_t size) {
    char path[32];
    test_memory memory = {0};
    const pir_allocator allocator = test_allocator(&memory);
    pir_report report = {PIR_OK, ""};
    pir_cspace *cspace = NULL;
    int descriptor = make_file(data, size, path);
    pir_status status = pir_cspace_open(path, &allocator, &report, &cspace);
    for (uint64_t i = 0; status == PIR_OK && i < SLICES && i < pir_cspace_get_info(cspace).grid.count; i++)
        status = check_slice(cspace, i, &report);
    if (status != PIR_OK) {
        fuzz_require(status == PIR_ERR_FORMAT || status == PIR_ERR_VERSION || status == PIR_ERR_LIMIT,
                     "a file is refused for what it is");
        fuzz_require(report.status == status && strncmp(report.text, path, strlen(path)) == 0 &&
                         !strchr(report.text, '\n'),
                     "a report is one line that says where");
    }
    pir_cspace_destroy(cspace);
    close(descriptor);
    fuzz_require(memory.blocks == 0 && !memory.wrong_size, "nothing is left behind");
    fuzz_require(memory.peak <= ((size_t)8 << 20) + 256 * size, "memory is bounded by the bytes of the file");
}

/* Makes the last 64 bytes an end whose own hash matches; the size in it stays. */
static void make_end(uint8_t *end) {
    XXH128_canonical_t hash;
    memcpy(end, "PIRSEAL1", 8);
    XXH128_canonicalFromHash(&hash, XXH3_128bits(end, 48));
    memcpy(end + 48, hash.digest, 16);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size > SIZE_LIMIT)
        return 0;
    read_file(data, size);
    if (size < 64)
        return 0;
    uint8_t *copy = malloc(size);
    fuzz_require(copy != NULL, "memory");
    memcpy(copy, data, size);
    make_end(copy + size - 64);
    read_file(copy, size);
    free(copy);
    return 0;
}
