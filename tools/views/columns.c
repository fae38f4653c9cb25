/* SPDX-License-Identifier: MIT */
#include "columns.h"

#include <stdlib.h>
#include <string.h>

/* Rows of a chunk, and how hard to compress. */
#define CHUNK_ROWS 16384
#define EFFORT     4

bool column_make(struct column *column, hid_t parent, const char *name, hid_t stored, hid_t type, hsize_t width) {
    const int rank = width ? 2 : 1;
    const hsize_t none[2] = {0, width}, most[2] = {H5S_UNLIMITED, width}, chunk[2] = {CHUNK_ROWS, width};
    *column = (struct column){.type = type, .width = width, .row_size = H5Tget_size(type) * (width ? width : 1)};
    column->waiting = malloc(CHUNK_ROWS * column->row_size);
    hid_t space = H5Screate_simple(rank, none, most), how = H5Pcreate(H5P_DATASET_CREATE);
    bool done = column->waiting && space >= 0 && how >= 0 && H5Pset_chunk(how, rank, chunk) >= 0 &&
                H5Pset_shuffle(how) >= 0 && H5Pset_deflate(how, EFFORT) >= 0 && H5Pset_obj_track_times(how, false) >= 0;
    hid_t dataset = done ? H5Dcreate2(parent, name, stored, space, H5P_DEFAULT, how, H5P_DEFAULT) : -1;
    if (space >= 0)
        H5Sclose(space);
    if (how >= 0)
        H5Pclose(how);
    column->dataset = dataset > 0 ? dataset : 0;
    return column->dataset > 0;
}

/* Puts the waiting rows into the file. */
static bool flush_rows(struct column *column) {
    if (column->waiting_count == 0)
        return true;
    const int rank = column->width ? 2 : 1;
    const hsize_t whole[2] = {column->rows, column->width}, start[2] = {column->rows - column->waiting_count, 0},
                  part[2] = {column->waiting_count, column->width};
    column->waiting_count = 0;
    if (H5Dset_extent(column->dataset, whole) < 0)
        return false;
    hid_t in_file = H5Dget_space(column->dataset), in_memory = H5Screate_simple(rank, part, NULL);
    bool done = in_file >= 0 && in_memory >= 0 &&
                H5Sselect_hyperslab(in_file, H5S_SELECT_SET, start, NULL, part, NULL) >= 0 &&
                H5Dwrite(column->dataset, column->type, in_memory, in_file, H5P_DEFAULT, column->waiting) >= 0;
    if (in_file >= 0)
        H5Sclose(in_file);
    if (in_memory >= 0)
        H5Sclose(in_memory);
    return done;
}

bool column_add(struct column *column, const void *row) {
    if (column->dataset == 0 || (column->waiting_count == CHUNK_ROWS && !flush_rows(column)))
        return false;
    memcpy(column->waiting + column->waiting_count * column->row_size, row, column->row_size);
    column->waiting_count++;
    column->rows++;
    return true;
}

bool column_close(struct column *column) {
    bool done = column->dataset == 0 || flush_rows(column);
    done &= column->dataset == 0 || H5Dclose(column->dataset) >= 0;
    free(column->waiting);
    *column = (struct column){0};
    return done;
}

hid_t group_make(hid_t parent, const char *name) {
    hid_t how = H5Pcreate(H5P_GROUP_CREATE), group = -1;
    if (how >= 0 && H5Pset_obj_track_times(how, false) >= 0)
        group = H5Gcreate2(parent, name, H5P_DEFAULT, how, H5P_DEFAULT);
    if (how >= 0)
        H5Pclose(how);
    return group > 0 ? group : 0;
}

bool attribute_number(hid_t object, const char *name, hid_t stored, hid_t type, const void *values, hsize_t count) {
    hid_t space = count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, NULL);
    hid_t attribute = space >= 0 ? H5Acreate2(object, name, stored, space, H5P_DEFAULT, H5P_DEFAULT) : -1;
    bool done = attribute >= 0 && H5Awrite(attribute, type, values) >= 0;
    if (attribute >= 0)
        H5Aclose(attribute);
    if (space >= 0)
        H5Sclose(space);
    return done;
}

bool attribute_text(hid_t object, const char *name, const char *text) {
    hid_t type = H5Tcopy(H5T_C_S1);
    bool done = type >= 0 && H5Tset_size(type, strlen(text)) >= 0 && H5Tset_strpad(type, H5T_STR_NULLPAD) >= 0 &&
                attribute_number(object, name, type, type, text, 1);
    if (type >= 0)
        H5Tclose(type);
    return done;
}

void columns_quiet(void) {
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}
