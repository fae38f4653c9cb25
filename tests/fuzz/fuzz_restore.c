/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as a serialised sum, as they are and with the length and checksum made to fit, so that what lies behind
 * those is reached: they are refused with a report of one line and leave nothing behind, or make a sum that is valid,
 * equal to a walk, the same when it is written and read again, and that updates.
 *
 * Restored bodies may have coordinates no double holds, so that the rest of the library sees them here as well. Work is
 * bounded by refusing large inputs. write_sums.c makes the inputs to start from; see fuzz_sum.c for how to run an
 * engine.
 */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pirouette.h>

#include "dymsum/file/sum_file.h"
#include "fuzz/input.h"
#include "support/bodies.h"
#include "support/memory.h"
#include "support/sum_bytes.h"

#define SIZE_LIMIT 16384

/* A sum may take so much: fixed parts, and a multiple of its bytes in the file. */
#define MEMORY_FIXED  (1u << 20)
#define MEMORY_FACTOR 2048

static test_bytes bytes_of(const pir_sum *sum) {
    test_bytes bytes = test_bytes_of(sum);
    fuzz_require(bytes.data != NULL, "a sum can be written");
    return bytes;
}

/* The pairing is the one that a walk finds, where it is exact. */
static void check_pairing(pir_sum *sum) {
    pir_sum *walked = NULL;
    // operands are shared by reference count, which is all that the call changes in them
    pir_polytope *p = (pir_polytope *)pir_sum_p(sum), *q = (pir_polytope *)pir_sum_q(sum);
    fuzz_require(pir_sum_is_valid(sum), "the pairing is valid");
    fuzz_require(pir_sum_create(p, q, pir_sum_pairing_rotation(sum), NULL, &walked) == PIR_OK, "a walk is made");
    fuzz_require(pir_sum_same_pairing(sum, walked), "the pairing is the walk's");
    pir_sum_destroy(walked);
}

/* Written and read again it is the same, and so are the bytes. */
static void check_round_trip(const pir_sum *sum) {
    test_bytes first = bytes_of(sum);
    pir_sum *again = NULL;
    pir_report report = {PIR_OK, ""};
    fuzz_require(pir_sum_restore(first.data, first.size, NULL, &report, &again) == PIR_OK, report.text);
    fuzz_require(pir_sum_same_pairing(sum, again), "the pairing comes back");
    test_bytes second = bytes_of(again);
    fuzz_require(first.size == second.size && memcmp(first.data, second.data, first.size) == 0,
                 "the bytes are the same again");
    free(second.data);
    free(first.data);
    pir_sum_destroy(again);
}

/* A small step, a large one, and one by the automatic choice, from where the sum is. */
static void check_updates(pir_sum *sum) {
    static const pir_quat steps[] = {{0.001, -0.002, 0.0005, 1}, {1, 2, -1, 1}, {0, 0, 0.01, 1}};
    for (int i = 0; i < 3; i++) {
        pir_quat next = test_compose(steps[i], pir_sum_rotation(sum), 1);
        // tiny and huge quaternions do not survive being composed
        if (!fuzz_is_rotation(next))
            next = steps[i];
        fuzz_require(pir_sum_rotate(sum, next, i == 2 ? PIR_METHOD_AUTO : PIR_METHOD_UPDATE) == PIR_OK,
                     "a restored sum can be updated");
        fuzz_require(pir_sum_shortfall_bound(sum) <= pir_sum_tolerance(sum), "the tolerance is kept");
        check_pairing(sum);
    }
}

static void check_sum(pir_sum *sum) {
    fuzz_require(pir_polytope_is_valid(pir_sum_p(sum)), "P is valid");
    fuzz_require(pir_polytope_is_valid(pir_sum_q(sum)), "Q is valid");
    fuzz_require(pir_sum_shortfall_bound(sum) <= pir_sum_tolerance(sum), "the tolerance is kept");
    check_pairing(sum);
    check_round_trip(sum);
    check_updates(sum);
    pir_mesh *mesh = NULL;
    fuzz_require(pir_sum_mesh(sum, PIR_DOUBLE, &mesh) == PIR_OK, "a restored sum has a mesh");
    pir_mesh_destroy(mesh);
}

static void restore(test_bytes bytes) {
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_report report = {PIR_OK, ""};
    pir_sum *sum = NULL;
    pir_status status = pir_sum_restore(bytes.data, bytes.size, &allocator, &report, &sum);
    if (status == PIR_OK) {
        fuzz_require(memory.bytes <= MEMORY_FIXED + MEMORY_FACTOR * bytes.size, "memory is in proportion to the bytes");
        check_sum(sum);
        pir_sum_destroy(sum);
    } else {
        fuzz_require(sum == NULL && report.status == status, "a refusal makes nothing and is reported");
        fuzz_require(status == PIR_ERR_EMPTY || status == PIR_ERR_FORMAT || status == PIR_ERR_VERSION ||
                         status == PIR_ERR_LIMIT,
                     "bytes are refused for what they are");
        fuzz_require(strncmp(report.text, "sum:", 4) == 0 && !strchr(report.text, '\n'),
                     "a report is one line that says where");
    }
    fuzz_require(memory.blocks == 0 && !memory.wrong_size, "nothing is left behind");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size > SIZE_LIMIT)
        return 0;
    test_bytes copy = {malloc(size + 1), size};
    fuzz_require(copy.data != NULL, "memory");
    if (size > 0)
        memcpy(copy.data, data, size);
    restore(copy);
    if (size >= PIR_SUM_HEADER_SIZE) {
        test_bytes_seal(copy.data, copy.size);
        restore(copy);
    }
    free(copy.data);
    return 0;
}
