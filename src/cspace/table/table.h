/* SPDX-License-Identifier: MIT */
/*
 * Tables of numbers from files: text, or the npy format of NumPy.
 *
 * Every number is finite. Every failure is reported with its place: "name:LINE: what" in text, "name: row ROW: what",
 * rows counted from 0, in npy.
 */
#ifndef PIR_CSPACE_TABLE_TABLE_H
#define PIR_CSPACE_TABLE_TABLE_H

#include <stdint.h>

#include <pirouette/base.h>

/* The columns of a row: their names, such as "x,y,z,w", and their number. */
typedef struct pir_table_form {
    const char *names;
    uint32_t columns;
} pir_table_form;

typedef struct pir_table {
    const char *name; /* of the file, in reports */
    pir_report *report;
    pir_table_form form;
    double *value;  /* by rows */
    uint32_t *line; /* of each row, from 1; NULL where the file has no lines */
    uint32_t rows, capacity;
} pir_table;

/* Reads a table from the bytes of a file. The table is to be finished whatever the outcome. PIR_ERR_EMPTY (no rows),
   PIR_ERR_FORMAT, PIR_ERR_NOT_FINITE, PIR_ERR_LIMIT, PIR_ERR_VERSION, PIR_ERR_MEMORY. */
typedef struct pir_table_source {
    const char *data;
    size_t size;
    const char *name;
    pir_report *report;
} pir_table_source;

pir_status pir_table_read(const pir_table_source *source, pir_table_form form, const pir_allocator *allocator,
                          pir_table *ret_table);
void pir_table_finish(pir_table *table, const pir_allocator *allocator);

/* Reports what is wrong with a row. */
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
pir_status
pir_table_fail(const pir_table *table, uint32_t row, pir_status status, const char *format, ...);

#endif
