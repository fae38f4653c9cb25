/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as a table, text or npy: they are refused with a report of one line, or every number is finite. Those of
 * rotations make a grid that has each of them once, and finds each as the nearest one to itself.
 *
 * The first byte chooses how many columns, 4 or 7; the rest is the file. See fuzz_sum.c for how to run an engine.
 */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include <pirouette/grid.h>

#include "cspace/table/table.h"
#include "fuzz/input.h"
#include "support/memory.h"

#define SIZE_LIMIT 65536

static void check_report(pir_status status, const pir_report *report) {
    fuzz_require(report->status == status && report->text[0] != '\0', "what is refused has a report");
    fuzz_require(strchr(report->text, '\n') == NULL, "a report is one line");
}

static void read_numbers(const char *data, size_t size, pir_table_form form, const pir_allocator *allocator) {
    pir_report report = {PIR_OK, ""};
    const pir_table_source source = {data, size, "input", &report};
    pir_table table = {0};
    pir_status status = pir_table_read(&source, form, allocator, &table);
    if (status != PIR_OK)
        check_report(status, &report);
    for (size_t i = 0; status == PIR_OK && i < (size_t)table.rows * form.columns; i++)
        fuzz_require(isfinite(table.value[i]), "every number is finite");
    pir_table_finish(&table, allocator);
}

/* A path through all rows, each once. */
static void check_grid(const pir_grid *grid) {
    pir_grid_info info = pir_grid_get_info(grid);
    uint64_t sum = 0;
    for (uint64_t i = 0; i < info.count; i++) {
        pir_quat at = pir_grid_rotation(grid, i);
        uint64_t nearest;
        fuzz_require(fuzz_is_rotation(at), "a grid has rotations");
        fuzz_require(pir_grid_nearest(grid, at, 1, &nearest) == 1, "one of them is the nearest");
        fuzz_require(pir_grid_turn(pir_grid_rotation(grid, nearest), at) <= 1e-7, "a rotation is near itself");
        sum += pir_grid_cell(grid, i);
    }
    fuzz_require(sum == info.count * (info.count - 1) / 2, "each row comes once");
}

static void read_grid(const char *data, size_t size, const pir_allocator *allocator) {
    pir_report report = {PIR_OK, ""};
    pir_grid *grid = NULL;
    pir_status status = pir_grid_read_bytes(data, size, "input", allocator, &report, &grid);
    if (status == PIR_OK)
        check_grid(grid);
    else
        check_report(status, &report);
    pir_grid_destroy(grid);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    test_memory memory = {0};
    const pir_allocator allocator = test_allocator(&memory);
    if (size < 1 || size > SIZE_LIMIT)
        return 0;
    const char *file = (const char *)data + 1;
    if (data[0] % 2 == 0)
        read_grid(file, size - 1, &allocator);
    else
        read_numbers(file, size - 1, (pir_table_form){"x,y,z,w,tx,ty,tz", 7}, &allocator);
    fuzz_require(memory.blocks == 0, "all memory is given back");
    fuzz_require(memory.peak <= ((size_t)1 << 20) + 256 * size, "memory is bounded by the bytes of the file");
    return 0;
}
