/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as a file of critical maps: as they are, with the length and checksum made to fit, and with those of the
 * sum within made to fit too, so that what lies behind them is reached. They are refused with a report of one line and
 * leave nothing behind, or make a map that is written as the same events and knows states at them.
 *
 * Work is bounded by refusing large inputs. write_turns.c makes the inputs to start from; see fuzz_sum.c for how to run
 * an engine.
 */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pirouette.h>

#include "base/byte_block.h"
#include "dymsum/file/sum_file.h"
#include "fuzz/input.h"
#include "support/memory.h"
#include "support/sum_bytes.h"

#define SIZE_LIMIT 16384

/* Of the file: see critical_file.c. */
enum { LENGTH_AT = 16, CHECKSUM_AT = 24, HEADER_SIZE = 32, SUM_AT = HEADER_SIZE + 8 };

static void put(uint8_t *at, uint64_t value) {
    for (int k = 0; k < 8; k++)
        at[k] = (uint8_t)(value >> (8 * k));
}

static void seal(uint8_t *data, size_t size) {
    put(data + LENGTH_AT, size);
    put(data + CHECKSUM_AT, pir_hash_bytes(PIR_HASH_START, data + HEADER_SIZE, size - HEADER_SIZE));
}

static uint64_t sum_size_of(const uint8_t *data) {
    uint64_t size = 0;
    for (int k = 7; k >= 0; k--)
        size = size << 8 | data[HEADER_SIZE + k];
    return size;
}

/* The same behind the sum, of which a file may have one with settings that a map does not keep. */
static void check_map(const pir_critical_map *map, const uint8_t *data, size_t size) {
    char *written = NULL;
    size_t count = 0;
    FILE *file = open_memstream(&written, &count);
    fuzz_require(file != NULL && pir_critical_map_write(map, file, NULL) == PIR_OK, "a map is written");
    fuzz_require(fclose(file) == 0, "a map is written");
    const size_t from = SUM_AT + (size_t)sum_size_of(data), to = SUM_AT + (size_t)sum_size_of((uint8_t *)written);
    fuzz_require(to <= count && from + (count - to) <= size && memcmp(data + from, written + to, count - to) == 0,
                 "its bytes are the same");
    free(written);
    pir_state state;
    for (uint32_t i = 0; i < pir_critical_map_event_count(map); i++)
        fuzz_require(pir_critical_map_state_at_event(map, i, (pir_vec3){0, 0, 0}, &state) == PIR_OK, "a state is told");
}

static void read_maps(const uint8_t *data, size_t size) {
    test_memory memory = {0};
    const pir_allocator allocator = test_allocator(&memory);
    FILE *file = size > 0 ? fmemopen((void *)data, size, "rb") : NULL;
    pir_status status = PIR_OK;
    while (file && status == PIR_OK) {
        pir_report report = {PIR_OK, ""};
        pir_critical_map *map = NULL;
        const long at = ftell(file);
        status = pir_critical_map_read(file, &allocator, &report, &map);
        if (status == PIR_OK) {
            check_map(map, data + at, size - (size_t)at);
            pir_critical_map_destroy(map);
            continue;
        }
        fuzz_require(map == NULL && report.status == status, "a refusal makes nothing and is reported");
        fuzz_require(status == PIR_ERR_EMPTY || status == PIR_ERR_FORMAT || status == PIR_ERR_VERSION ||
                         status == PIR_ERR_LIMIT || status == PIR_ERR_ZERO_QUATERNION,
                     "bytes are refused for what they are");
        fuzz_require(report.text[0] && !strchr(report.text, '\n'), "a report is one line");
    }
    if (file)
        fclose(file);
    fuzz_require(memory.blocks == 0 && !memory.wrong_size, "nothing is left behind");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size > SIZE_LIMIT)
        return 0;
    uint8_t *copy = malloc(size + 1);
    fuzz_require(copy != NULL, "memory");
    if (size > 0)
        memcpy(copy, data, size);
    read_maps(copy, size);
    if (size >= SUM_AT) {
        seal(copy, size);
        read_maps(copy, size);
        const uint64_t sum_size = sum_size_of(copy);
        if (sum_size >= PIR_SUM_HEADER_SIZE && sum_size <= size - SUM_AT) {
            test_bytes_seal(copy + SUM_AT, (size_t)sum_size);
            seal(copy, size);
            read_maps(copy, size);
        }
    }
    free(copy);
    return 0;
}
