/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as the notes of a history, behind a header whose size and checksum are right: they are run, or refused, and
 * run again they give the same.
 *
 * See fuzz_sum.c for how to run an engine.
 */
#include <stdlib.h>
#include <string.h>

#include <pirouette/history.h>

#include "base/byte_block.h"
#include "fuzz/input.h"
#include "history/history_file.h"

#define SIZE_LIMIT 8192

static void tell(void *context, const pir_history_step *step) {
    uint64_t *hash = context;
    *hash = (*hash ^ step->hash ^ (uint64_t)step->status) * UINT64_C(0x100000001b3);
    fuzz_require(step->call != NULL && (step->status == PIR_OK || step->hash == 0), "a step has a call and a hash");
}

/* Puts a number where a header has it. */
static void put(uint8_t *at, uint64_t value) {
    for (int k = 0; k < 8; k++)
        at[k] = (uint8_t)(value >> (8 * k));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size > SIZE_LIMIT)
        return 0;
    // kept inputs are whole files: what stands in place of their header does not matter
    size_t skip = size >= PIR_HISTORY_HEADER && memcmp(data, PIR_HISTORY_MAGIC, 8) == 0 ? PIR_HISTORY_HEADER : 0;
    size_t whole = PIR_HISTORY_HEADER + size - skip;
    uint8_t *file = calloc(1, whole);
    fuzz_require(file != NULL, "memory");
    memcpy(file, PIR_HISTORY_MAGIC, 8);
    file[8] = PIR_HISTORY_VERSION;
    if (size > skip)
        memcpy(file + PIR_HISTORY_HEADER, data + skip, size - skip);
    put(file + PIR_HISTORY_SIZE_AT, whole);
    uint64_t checksum = pir_hash_bytes(PIR_HASH_START, file, PIR_HISTORY_CHECKSUM_AT);
    put(file + PIR_HISTORY_CHECKSUM_AT, pir_hash_bytes(checksum, file + PIR_HISTORY_HEADER, size - skip));
    uint64_t hash[2] = {0, 0};
    pir_status status[2];
    for (int run = 0; run < 2; run++) {
        const pir_history_visitor visitor = {NULL, &hash[run], tell};
        pir_report report = {PIR_OK, ""};
        status[run] = pir_history_replay_bytes(file, whole, &visitor, &report);
        fuzz_require(status[run] == PIR_OK || (status[run] == PIR_ERR_FORMAT && report.text[0]),
                     "a history is run, or refused with a reason");
    }
    fuzz_require(status[0] == status[1] && hash[0] == hash[1], "run again it gives the same");
    free(file);
    return 0;
}
