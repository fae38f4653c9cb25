/* SPDX-License-Identifier: MIT */
/* Poses from files. */
#include <pirouette/cspace.h>

#include "base/memory.h"
#include "base/report.h"
#include "cspace/table/table.h"
#include "polytope/file/file_bytes.h"

static pir_status make_poses(const pir_table *table, const pir_allocator *allocator, pir_pose **ret_poses) {
    pir_pose *poses = PIR_NEW(allocator, pir_pose, table->rows);
    if (!poses)
        return pir_fail(table->report, PIR_ERR_MEMORY, "%s: out of memory", table->name);
    for (uint32_t i = 0; i < table->rows; i++) {
        const double *v = table->value + 7 * (size_t)i;
        poses[i] = (pir_pose){{v[0], v[1], v[2], v[3]}, {v[4], v[5], v[6]}};
        if (v[0] == 0 && v[1] == 0 && v[2] == 0 && v[3] == 0) {
            PIR_FREE(allocator, poses, table->rows);
            return pir_table_fail(table, i, PIR_ERR_ZERO_QUATERNION, "the quaternion 0, 0, 0, 0 is no rotation");
        }
    }
    *ret_poses = poses;
    return PIR_OK;
}

pir_status pir_cspace_read_poses(const char *path, const pir_allocator *allocator, pir_report *report,
                                 pir_pose **ret_poses, size_t *ret_count) {
    if (!path || !ret_poses || !ret_count)
        return pir_fail(report, PIR_ERR_ARGUMENT, "no path, or no place for the poses");
    const pir_allocator memory = pir_allocator_or_default(allocator);
    struct pir_read_bytes bytes = {0};
    pir_table table = {0};
    pir_status status = pir_file_read(path, &memory, report, &bytes);
    if (status == PIR_OK) {
        const pir_table_source source = {bytes.data, bytes.size, path, report};
        status = pir_table_read(&source, (pir_table_form){"x,y,z,w,tx,ty,tz", 7}, &memory, &table);
    }
    if (status == PIR_OK)
        status = make_poses(&table, &memory, ret_poses);
    if (status == PIR_OK)
        *ret_count = table.rows;
    pir_table_finish(&table, &memory);
    PIR_FREE(&memory, bytes.data, bytes.capacity);
    return status;
}

void pir_cspace_free_poses(pir_pose *poses, size_t count, const pir_allocator *allocator) {
    const pir_allocator memory = pir_allocator_or_default(allocator);
    PIR_FREE(&memory, poses, count);
}
