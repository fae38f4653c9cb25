/* SPDX-License-Identifier: MIT */
/*
 * Tables in npy, versions 1 to 3 (NumPy Enhancement Proposal 1): six bytes of magic, two of version, the length of a
 * header, the header, a Python dictionary of `descr`, `fortran_order` and `shape`, then the numbers. Read are arrays of
 * float64 by rows, of two dimensions. Counts are compared with the size of the file before anything is allocated.
 */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/report.h"
#include "cspace/table/table_forms.h"
#include "polytope/read/bytes.h"

#define MAGIC      "\x93NUMPY"
#define MAGIC_SIZE 6

/* The keys of the header that were read, and their values. */
struct header {
    bool has_type, has_order, has_shape;
    bool big; /* numbers are stored most significant byte first */
    uint64_t rows, columns;
};

/* Reading the header: what is left of it. */
struct header_scan {
    const char *at, *end;
    const pir_table *table;
};

bool pir_table_is_npy(const char *data, size_t size) {
    return size >= MAGIC_SIZE && memcmp(data, MAGIC, MAGIC_SIZE) == 0;
}

static pir_status fail(const pir_table *table, pir_status status, const char *what) {
    return pir_fail(table->report, status, "%s: npy header: %s", table->name, what);
}

/* Passes blanks, then `c`, when it is there. */
static bool pass(struct header_scan *scan, char c) {
    while (scan->at < scan->end && (*scan->at == ' ' || *scan->at == '\n'))
        scan->at++;
    if (scan->at == scan->end || *scan->at != c)
        return false;
    scan->at++;
    return true;
}

/* Passes a word or a string in quotes when it is `text`. */
static bool pass_text(struct header_scan *scan, const char *text) {
    while (scan->at < scan->end && *scan->at == ' ')
        scan->at++;
    size_t length = strlen(text);
    if ((size_t)(scan->end - scan->at) < length || memcmp(scan->at, text, length) != 0)
        return false;
    scan->at += length;
    return true;
}

static bool pass_string(struct header_scan *scan, const char *text) {
    char quoted[2][32];
    size_t length = strlen(text);
    for (int k = 0; k < 2; k++) {
        quoted[k][0] = quoted[k][length + 1] = k ? '"' : '\'';
        memcpy(quoted[k] + 1, text, length);
        quoted[k][length + 2] = '\0';
    }
    return pass_text(scan, quoted[0]) || pass_text(scan, quoted[1]);
}

/* A count of at most 18 digits. */
static bool pass_count(struct header_scan *scan, uint64_t *ret_count) {
    while (scan->at < scan->end && *scan->at == ' ')
        scan->at++;
    uint64_t count = 0;
    int digits = 0;
    for (; scan->at < scan->end && *scan->at >= '0' && *scan->at <= '9' && digits < 19; scan->at++, digits++)
        count = 10 * count + (uint64_t)(*scan->at - '0');
    *ret_count = count;
    return digits > 0 && digits < 19;
}

static pir_status read_type(struct header_scan *scan, struct header *header) {
    header->has_type = true;
    header->big = pass_string(scan, ">f8");
    if (!header->big && !pass_string(scan, "<f8"))
        return fail(scan->table, PIR_ERR_FORMAT, "descr is not '<f8' or '>f8', the numbers are no float64");
    return PIR_OK;
}

static pir_status read_order(struct header_scan *scan, struct header *header) {
    header->has_order = true;
    if (!pass_text(scan, "False"))
        return fail(scan->table, PIR_ERR_FORMAT, "fortran_order is not False, the array is not stored by rows");
    return PIR_OK;
}

static pir_status read_shape(struct header_scan *scan, struct header *header) {
    header->has_shape = true;
    bool good =
        pass(scan, '(') && pass_count(scan, &header->rows) && pass(scan, ',') && pass_count(scan, &header->columns);
    if (good && pass(scan, ')'))
        return PIR_OK;
    if (!good || !pass(scan, ',') || !pass(scan, ')'))
        return fail(scan->table, PIR_ERR_FORMAT, "shape is not (rows, columns)");
    return PIR_OK;
}

static pir_status read_header(struct header_scan *scan, struct header *header) {
    if (!pass(scan, '{'))
        return fail(scan->table, PIR_ERR_FORMAT, "no dictionary");
    while (!pass(scan, '}')) {
        pir_status status;
        bool type = pass_string(scan, "descr"), order = !type && pass_string(scan, "fortran_order");
        if (!type && !order && !pass_string(scan, "shape"))
            return fail(scan->table, PIR_ERR_FORMAT, "another key than descr, fortran_order and shape");
        if (!pass(scan, ':'))
            return fail(scan->table, PIR_ERR_FORMAT, "no ':' behind a key");
        status = type ? read_type(scan, header) : order ? read_order(scan, header) : read_shape(scan, header);
        if (status != PIR_OK)
            return status;
        if (!pass(scan, ',')) {
            if (pass(scan, '}'))
                break;
            return fail(scan->table, PIR_ERR_FORMAT, "no ',' or '}' behind a value");
        }
    }
    if (!header->has_type || !header->has_order || !header->has_shape)
        return fail(scan->table, PIR_ERR_FORMAT, "descr, fortran_order or shape is missing");
    return PIR_OK;
}

/* The numbers behind the header. */
static pir_status read_values(const char *data, size_t size, const struct header *header,
                              const pir_allocator *allocator, pir_table *table) {
    const uint32_t columns = table->form.columns;
    if (header->columns != columns)
        return pir_fail(table->report, PIR_ERR_FORMAT, "%s: rows of %llu numbers, not %u: %s", table->name,
                        (unsigned long long)header->columns, columns, table->form.names);
    if (header->rows > size / (columns * sizeof(double)))
        return pir_fail(table->report, PIR_ERR_FORMAT, "%s: ends in row %zu of %llu", table->name,
                        size / (columns * sizeof(double)), (unsigned long long)header->rows);
    if (header->rows * columns * sizeof(double) != size)
        return pir_fail(table->report, PIR_ERR_FORMAT, "%s: %zu bytes behind the last row", table->name,
                        size - (size_t)header->rows * columns * sizeof(double));
    // the file is no larger than 2 GiB
    table->capacity = (uint32_t)header->rows;
    table->value = PIR_NEW(allocator, double, (size_t)table->capacity *columns);
    if (!table->value) {
        table->capacity = 0;
        return pir_fail(table->report, PIR_ERR_MEMORY, "%s: out of memory", table->name);
    }
    for (; table->rows < table->capacity; table->rows++)
        for (uint32_t k = 0; k < columns; k++) {
            size_t at = (size_t)table->rows * columns + k;
            table->value[at] = pir_bytes_double(data + 8 * at, header->big);
            if (!isfinite(table->value[at]))
                return pir_table_fail(table, table->rows, PIR_ERR_NOT_FINITE, "number %u of %s is %g", k + 1,
                                      table->form.names, table->value[at]);
        }
    return PIR_OK;
}

pir_status pir_table_read_npy(const char *data, size_t size, const pir_allocator *allocator, pir_table *table) {
    if (size < MAGIC_SIZE + 4)
        return fail(table, PIR_ERR_FORMAT, "the file ends in it");
    const unsigned version = (unsigned char)data[MAGIC_SIZE];
    if (version < 1 || version > 3)
        return pir_fail(table->report, PIR_ERR_VERSION, "%s: npy version %u, not 1 to 3", table->name, version);
    // a length of two bytes in version 1, of four later
    const size_t width = version == 1 ? 2 : 4, from = MAGIC_SIZE + 2 + width;
    if (size < from || pir_bytes_unsigned(data + MAGIC_SIZE + 2, width, false) > size - from)
        return fail(table, PIR_ERR_FORMAT, "the file ends in it");
    const size_t length = (size_t)pir_bytes_unsigned(data + MAGIC_SIZE + 2, width, false);
    struct header_scan scan = {data + from, data + from + length, table};
    struct header header = {0};
    pir_status status = read_header(&scan, &header);
    if (status != PIR_OK)
        return status;
    return read_values(data + from + length, size - from - length, &header, allocator, table);
}
