/* SPDX-License-Identifier: MIT */
/* Grids of rotations that a file lists. */
#include <pirouette/grid.h>

#include "base/memory.h"
#include "base/report.h"
#include "cspace/table/table.h"
#include "polytope/file/file_bytes.h"
#include "polytope/file/file_name.h"

/* A grid of the rows of a table. */
static pir_status make_grid(const pir_table *table, const pir_allocator *allocator, pir_grid **ret_grid) {
    if (table->rows > PIR_GRID_LIST_MAX)
        return pir_fail(table->report, PIR_ERR_LIMIT, "%s: %u rotations, more than %zu", table->name, table->rows,
                        PIR_GRID_LIST_MAX);
    pir_quat *rotations = PIR_NEW(allocator, pir_quat, table->rows);
    if (!rotations)
        return pir_fail(table->report, PIR_ERR_MEMORY, "%s: out of memory", table->name);
    pir_status status = PIR_OK;
    for (uint32_t i = 0; i < table->rows && status == PIR_OK; i++) {
        const double *v = table->value + 4 * (size_t)i;
        rotations[i] = (pir_quat){v[0], v[1], v[2], v[3]};
        if (v[0] == 0 && v[1] == 0 && v[2] == 0 && v[3] == 0)
            status = pir_table_fail(table, i, PIR_ERR_ZERO_QUATERNION, "the quaternion 0, 0, 0, 0 is no rotation");
    }
    if (status == PIR_OK) {
        status = pir_grid_list(rotations, table->rows, 0, allocator, ret_grid);
        if (status != PIR_OK)
            pir_fail(table->report, status, "%s: %s", table->name, pir_status_text(status));
    }
    PIR_FREE(allocator, rotations, table->rows);
    return status;
}

pir_status pir_grid_read_bytes(const void *data, size_t size, const char *name, const pir_allocator *allocator,
                               pir_report *report, pir_grid **ret_grid) {
    if ((!data && size > 0) || !ret_grid)
        return pir_fail(report, PIR_ERR_ARGUMENT, "no bytes, or no place for the grid");
    const pir_allocator memory = pir_allocator_or_default(allocator);
    const pir_table_source source = {data, size, name ? name : "text", report};
    pir_table table;
    pir_status status = pir_table_read(&source, (pir_table_form){"x,y,z,w", 4}, &memory, &table);
    if (status == PIR_OK)
        status = make_grid(&table, &memory, ret_grid);
    pir_table_finish(&table, &memory);
    return status;
}

pir_status pir_grid_read(const char *path, const pir_allocator *allocator, pir_report *report, pir_grid **ret_grid) {
    if (!path || !ret_grid)
        return pir_fail(report, PIR_ERR_ARGUMENT, "no path, or no place for the grid");
    const pir_allocator memory = pir_allocator_or_default(allocator);
    struct pir_read_bytes bytes = {0};
    pir_status status = pir_file_read(path, &memory, report, &bytes);
    if (status == PIR_OK)
        status = pir_grid_read_bytes(bytes.data, bytes.size, path, allocator, report, ret_grid);
    PIR_FREE(&memory, bytes.data, bytes.capacity);
    return status;
}
