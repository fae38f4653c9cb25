/* SPDX-License-Identifier: MIT */
/* The two forms of a table's file. Each fills a table that has its name, report and form. */
#ifndef PIR_CSPACE_TABLE_TABLE_FORMS_H
#define PIR_CSPACE_TABLE_TABLE_FORMS_H

#include <stdbool.h>

#include "cspace/table/table.h"

/* Whether the bytes begin as those of npy do. */
bool pir_table_is_npy(const char *data, size_t size);

pir_status pir_table_read_npy(const char *data, size_t size, const pir_allocator *allocator, pir_table *table);
pir_status pir_table_read_text(const char *data, size_t size, const pir_allocator *allocator, pir_table *table);

#endif
