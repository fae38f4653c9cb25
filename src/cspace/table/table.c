/* SPDX-License-Identifier: MIT */
/* A table, whichever form its file has. */
#include "cspace/table/table.h"

#include <stdarg.h>
#include <stdio.h>

#include "base/memory.h"
#include "base/report.h"
#include "cspace/table/table_forms.h"
#include "polytope/file/file_name.h"

pir_status pir_table_read(const pir_table_source *source, pir_table_form form, const pir_allocator *allocator,
                          pir_table *ret_table) {
    *ret_table = (pir_table){.name = pir_short_name(source->name), .report = source->report, .form = form};
    if (source->size == 0)
        return pir_fail(source->report, PIR_ERR_EMPTY, "%s: the file is empty", ret_table->name);
    if (source->size > PIR_FILE_SIZE_MAX)
        return pir_fail(source->report, PIR_ERR_LIMIT, "%s: larger than 2 GiB", ret_table->name);
    pir_status status = pir_table_is_npy(source->data, source->size)
                            ? pir_table_read_npy(source->data, source->size, allocator, ret_table)
                            : pir_table_read_text(source->data, source->size, allocator, ret_table);
    if (status == PIR_OK && ret_table->rows == 0)
        return pir_fail(source->report, PIR_ERR_EMPTY, "%s: holds no rows", ret_table->name);
    return status;
}

void pir_table_finish(pir_table *table, const pir_allocator *allocator) {
    PIR_FREE(allocator, table->value, (size_t)table->capacity * table->form.columns);
    PIR_FREE(allocator, table->line, table->capacity);
}

pir_status pir_table_fail(const pir_table *table, uint32_t row, pir_status status, const char *format, ...) {
    char text[160];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (table->line)
        return pir_fail(table->report, status, "%s:%u: %s", table->name, table->line[row], text);
    return pir_fail(table->report, status, "%s: row %u: %s", table->name, row, text);
}
