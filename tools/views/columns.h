/* SPDX-License-Identifier: MIT */
/* Datasets of HDF5 that rows are appended to, chunked and compressed. Needs HDF5. */
#ifndef TOOLS_VIEWS_COLUMNS_H
#define TOOLS_VIEWS_COLUMNS_H

#include <stdbool.h>
#include <stddef.h>

#include <hdf5.h>

/* A dataset under way. Zeroed it is closed. */
struct column {
    hid_t dataset; /* 0 when closed */
    hid_t type;    /* of the rows as they are given */
    hsize_t rows, width;
    size_t row_size;
    unsigned char *waiting; /* rows that are not in the file yet, the last of all */
    size_t waiting_count;
};

/*
 * Makes dataset `name` of rows of `width` numbers; 0 stands for plain numbers. `stored` is the type in the file, which
 * the native type `type` is turned into. False when HDF5 failed.
 */
bool column_make(struct column *column, hid_t parent, const char *name, hid_t stored, hid_t type, hsize_t width);

/* Appends a row. False when HDF5 failed, or column_make had. */
bool column_add(struct column *column, const void *row);

/* Closes; false when HDF5 failed. One that is closed is accepted. */
bool column_close(struct column *column);

/* A group, which holds no times, as the datasets do not: equal runs make equal files. 0 when HDF5 failed. */
hid_t group_make(hid_t parent, const char *name);

/* Attributes of an object; false when HDF5 failed. */
bool attribute_number(hid_t object, const char *name, hid_t stored, hid_t type, const void *values, hsize_t count);
bool attribute_text(hid_t object, const char *name, const char *text);

/* Makes HDF5 keep its complaints to itself. */
void columns_quiet(void);

#endif
