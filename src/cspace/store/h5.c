/* SPDX-License-Identifier: MIT */
/* HDF5 in the few forms that a file of slices has. */
#include "cspace/store/h5.h"

#include <pthread.h>
#include <string.h>

/* The largest chunk that is read, in bytes: HDF5 makes memory for a whole one. */
#define CHUNK_MOST ((hsize_t)1 << 26)

/* HDF5 keeps state of its own for the process, and is in general not made for threads: one at a time is in it. */
static pthread_mutex_t one_at_a_time = PTHREAD_MUTEX_INITIALIZER;

pir_h5_reports pir_h5_quiet(void) {
    pthread_mutex_lock(&one_at_a_time);
    pir_h5_reports reports = {NULL, NULL};
    H5Eget_auto2(H5E_DEFAULT, &reports.function, &reports.data);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    return reports;
}

void pir_h5_loud(pir_h5_reports reports) {
    H5Eset_auto2(H5E_DEFAULT, reports.function, reports.data);
    pthread_mutex_unlock(&one_at_a_time);
}

static hid_t memory_type(pir_h5_type type) {
    switch (type) {
    case PIR_H5_U8:
        return H5T_NATIVE_UINT8;
    case PIR_H5_U32:
        return H5T_NATIVE_UINT32;
    case PIR_H5_U64:
        return H5T_NATIVE_UINT64;
    case PIR_H5_F64:
        break;
    }
    return H5T_NATIVE_DOUBLE;
}

static hid_t file_type(pir_h5_type type) {
    switch (type) {
    case PIR_H5_U8:
        return H5T_STD_U8LE;
    case PIR_H5_U32:
        return H5T_STD_U32LE;
    case PIR_H5_U64:
        return H5T_STD_U64LE;
    case PIR_H5_F64:
        break;
    }
    return H5T_IEEE_F64LE;
}

bool pir_h5_close(hid_t id) {
    if (id < 0)
        return true;
    switch (H5Iget_type(id)) {
    case H5I_FILE:
        return H5Fclose(id) >= 0;
    case H5I_GROUP:
        return H5Gclose(id) >= 0;
    case H5I_DATASET:
        return H5Dclose(id) >= 0;
    default:
        return false;
    }
}

/* --- making --- */

hid_t pir_h5_make_group(hid_t in, const char *name) {
    return H5Gcreate2(in, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
}

static hid_t space_of(const pir_h5_shape *shape) {
    hsize_t size[PIR_H5_RANK], most[PIR_H5_RANK];
    for (int i = 0; i < shape->rank; i++) {
        size[i] = shape->size[i];
        most[i] = i == 0 && shape->grows ? H5S_UNLIMITED : shape->size[i];
    }
    return H5Screate_simple(shape->rank, size, most);
}

/* Packed numbers are those of memory, so these have the order of bytes that files have. */
static const uint16_t byte_order = 1;

static uint32_t element_of(pir_h5_type type) {
    return type == PIR_H5_U8 ? 1 : type == PIR_H5_U32 ? 4 : 8;
}

/* The extent of a chunk along a dimension. */
static uint64_t chunk_of(const pir_h5_shape *shape, int i) {
    if (shape->grows || shape->chunk[i] < shape->size[i])
        return shape->chunk[i];
    return shape->size[i] > 0 ? shape->size[i] : 1;
}

/* How a data set is kept: in chunks, mostly compressed, without times, so that equal data gives equal files. */
static hid_t layout_of(const pir_h5_shape *shape) {
    hid_t list = H5Pcreate(H5P_DATASET_CREATE);
    bool good = list >= 0 && H5Pset_obj_track_times(list, false) >= 0;
    if (good) {
        hsize_t chunk[PIR_H5_RANK];
        for (int i = 0; i < shape->rank; i++)
            chunk[i] = chunk_of(shape, i);
        good = H5Pset_chunk(list, shape->rank, chunk) >= 0;
    }
    if (good && !shape->plain)
        good = (shape->type == PIR_H5_U8 || H5Pset_shuffle(list) >= 0) && H5Pset_deflate(list, PIR_DEFLATE_LEVEL) >= 0;
    if (good)
        return list;
    H5Pclose(list);
    return -1;
}

hid_t pir_h5_make_set(hid_t in, const char *name, const pir_h5_shape *shape) {
    hid_t space = space_of(shape), layout = layout_of(shape), set = -1;
    if (space >= 0 && layout >= 0)
        set = H5Dcreate2(in, name, file_type(shape->type), space, H5P_DEFAULT, layout, H5P_DEFAULT);
    if (layout >= 0)
        H5Pclose(layout);
    if (space >= 0)
        H5Sclose(space);
    return set;
}

bool pir_h5_extend(hid_t set, const pir_h5_shape *shape, uint64_t length) {
    hsize_t size[PIR_H5_RANK] = {length, shape->rank > 1 ? shape->size[1] : 0};
    return H5Dset_extent(set, size) >= 0;
}

/* --- blocks --- */

typedef herr_t transfer(hid_t set, hid_t type, hid_t memory, hid_t file, void *data);

static herr_t write_block(hid_t set, hid_t type, hid_t memory, hid_t file, void *data) {
    return H5Dwrite(set, type, memory, file, H5P_DEFAULT, data);
}

static herr_t read_block(hid_t set, hid_t type, hid_t memory, hid_t file, void *data) {
    return H5Dread(set, type, memory, file, H5P_DEFAULT, data);
}

static bool transfer_block(hid_t set, pir_h5_type type, const uint64_t *start, const uint64_t *count, void *data,
                           transfer *move) {
    hid_t file = H5Dget_space(set);
    int rank = file >= 0 ? H5Sget_simple_extent_ndims(file) : 0;
    hsize_t first[PIR_H5_RANK], size[PIR_H5_RANK];
    for (int i = 0; i < rank && i < PIR_H5_RANK; i++) {
        first[i] = start[i];
        size[i] = count[i];
    }
    hid_t memory = rank > 0 && rank <= PIR_H5_RANK ? H5Screate_simple(rank, size, NULL) : -1;
    bool good = memory >= 0 && H5Sselect_hyperslab(file, H5S_SELECT_SET, first, NULL, size, NULL) >= 0 &&
                move(set, memory_type(type), memory, file, data) >= 0;
    if (memory >= 0)
        H5Sclose(memory);
    if (file >= 0)
        H5Sclose(file);
    return good;
}

bool pir_h5_write(hid_t set, pir_h5_type type, const uint64_t *start, const uint64_t *count, const void *data) {
    // what is written is only read; HDF5's own parameter is const
    return transfer_block(set, type, start, count, (void *)data, write_block);
}

bool pir_h5_read(hid_t set, pir_h5_type type, const uint64_t *start, const uint64_t *count, void *data) {
    return transfer_block(set, type, start, count, data, read_block);
}

bool pir_h5_write_chunk(hid_t set, const pir_h5_shape *shape, const uint64_t *start, const pir_chunk *chunk) {
    const hsize_t first[PIR_H5_RANK] = {start[0], start[1]};
    // a bit for each filter that was left out; deflate is the last one
    uint32_t left_out = !chunk->stored ? 0 : shape->type == PIR_H5_U8 ? 1 : 2;
    return H5Dwrite_chunk(set, H5P_DEFAULT, left_out, first, chunk->size, chunk->data) >= 0;
}

bool pir_h5_put_rows(hid_t set, const pir_h5_shape *shape, uint64_t first, const void *data, pir_packer *packer) {
    const uint64_t row = element_of(shape->type) * (shape->rank > 1 ? shape->size[1] : 1), chunk = chunk_of(shape, 0);
    const uint64_t rows = shape->size[0] - first < chunk ? shape->size[0] - first : chunk, start[2] = {first, 0};
    if (shape->plain || *(const uint8_t *)&byte_order != 1)
        return pir_h5_write(set, shape->type, start, (uint64_t[]){rows, shape->size[1]}, data);
    // bytes that are put so are text
    const pir_chunk_form form = {(uint32_t)(chunk * row), element_of(shape->type), shape->type == PIR_H5_U8};
    const pir_chunk packed = pir_pack_chunk(packer, &form, data, (uint32_t)(rows * row));
    return pir_h5_write_chunk(set, shape, start, &packed);
}

bool pir_h5_put(hid_t in, const char *name, const pir_h5_shape *shape, const void *data, pir_packer *packer) {
    const uint64_t row = element_of(shape->type) * (shape->rank > 1 ? shape->size[1] : 1);
    hid_t set = pir_h5_make_set(in, name, shape);
    bool good = set >= 0;
    for (uint64_t i = 0; good && row > 0 && i < shape->size[0]; i += chunk_of(shape, 0))
        good = pir_h5_put_rows(set, shape, i, (const char *)data + i * row, packer);
    return pir_h5_close(set) && good;
}

/* --- opening --- */

/* Whether the name is that of an object of this file: a link may lead to another one. */
static bool is_own(hid_t in, const char *name) {
    H5L_info_t info;
    return H5Lget_info(in, name, &info, H5P_DEFAULT) >= 0 && info.type == H5L_TYPE_HARD;
}

hid_t pir_h5_open_group(hid_t in, const char *name) {
    return is_own(in, name) ? H5Gopen2(in, name, H5P_DEFAULT) : -1;
}

/* Whether a data set is kept in this file, in chunks that are read one at a time in little memory where in chunks. */
static bool is_modest(hid_t set, size_t element) {
    hid_t how = H5Dget_create_plist(set);
    if (how < 0)
        return false;
    hsize_t chunk[H5S_MAX_RANK], bytes = element;
    int rank = 0;
    H5D_layout_t layout = H5Pget_layout(how);
    bool good = layout != H5D_VIRTUAL && layout != H5D_LAYOUT_ERROR && H5Pget_external_count(how) == 0;
    if (good && layout == H5D_CHUNKED)
        good = (rank = H5Pget_chunk(how, H5S_MAX_RANK, chunk)) > 0;
    for (int i = 0; good && i < rank; i++) {
        good = chunk[i] <= CHUNK_MOST / bytes;
        bytes *= chunk[i];
    }
    H5Pclose(how);
    return good;
}

/* Whether a stored type is the one expected: of its class, size and order. */
static bool is_type(hid_t stored, pir_h5_type type) {
    hid_t expected = file_type(type);
    return stored >= 0 && H5Tequal(stored, expected) > 0;
}

hid_t pir_h5_open_set(hid_t in, const char *name, pir_h5_type type, int rank, uint64_t *ret_size) {
    hid_t set = is_own(in, name) ? H5Dopen2(in, name, H5P_DEFAULT) : -1;
    if (set < 0)
        return -1;
    hid_t stored = H5Dget_type(set), space = H5Dget_space(set);
    hsize_t size[PIR_H5_RANK];
    bool good = is_type(stored, type) && is_modest(set, H5Tget_size(stored)) && space >= 0 &&
                H5Sget_simple_extent_ndims(space) == rank && H5Sget_simple_extent_dims(space, size, NULL) == rank;
    for (int i = 0; good && i < rank; i++)
        ret_size[i] = size[i];
    if (stored >= 0)
        H5Tclose(stored);
    if (space >= 0)
        H5Sclose(space);
    if (good)
        return set;
    H5Dclose(set);
    return -1;
}

/* --- attributes --- */

static hid_t text_type(size_t size) {
    hid_t type = H5Tcopy(H5T_C_S1);
    if (type >= 0 && H5Tset_size(type, size) < 0) {
        H5Tclose(type);
        return -1;
    }
    return type;
}

static bool put_attribute(hid_t in, const char *name, hid_t stored, hid_t given, hid_t space, const void *data) {
    hid_t attribute = space < 0 || stored < 0 ? -1 : H5Acreate2(in, name, stored, space, H5P_DEFAULT, H5P_DEFAULT);
    bool good = attribute >= 0 && H5Awrite(attribute, given, data) >= 0;
    if (attribute >= 0)
        H5Aclose(attribute);
    if (space >= 0)
        H5Sclose(space);
    return good;
}

bool pir_h5_put_text(hid_t in, const char *name, const char *text) {
    hid_t type = text_type(strlen(text) + 1);
    bool good = put_attribute(in, name, type, type, H5Screate(H5S_SCALAR), text);
    if (type >= 0)
        H5Tclose(type);
    return good;
}

bool pir_h5_put_numbers(hid_t in, const char *name, pir_h5_type type, const void *numbers, uint64_t count) {
    hsize_t size = count;
    hid_t space = count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &size, NULL);
    return put_attribute(in, name, file_type(type), memory_type(type), space, numbers);
}

/* An attribute that is read: its type as stored, its space. -1 where there is none. */
struct attribute {
    hid_t id, stored, space;
};

static struct attribute open_attribute(hid_t in, const char *name) {
    struct attribute attribute = {H5Aopen(in, name, H5P_DEFAULT), -1, -1};
    if (attribute.id >= 0) {
        attribute.stored = H5Aget_type(attribute.id);
        attribute.space = H5Aget_space(attribute.id);
    }
    return attribute;
}

/* Whether it has so many elements. */
static bool has_elements(const struct attribute *attribute, uint64_t count) {
    return attribute->stored >= 0 && attribute->space >= 0 &&
           H5Sget_simple_extent_npoints(attribute->space) == (hssize_t)count;
}

static void close_attribute(const struct attribute *attribute) {
    if (attribute->space >= 0)
        H5Sclose(attribute->space);
    if (attribute->stored >= 0)
        H5Tclose(attribute->stored);
    if (attribute->id >= 0)
        H5Aclose(attribute->id);
}

bool pir_h5_get_text(hid_t in, const char *name, char *ret_text, size_t room) {
    struct attribute attribute = open_attribute(in, name);
    hid_t type = text_type(room);
    bool good = type >= 0 && has_elements(&attribute, 1) && H5Tget_class(attribute.stored) == H5T_STRING &&
                H5Tis_variable_str(attribute.stored) == 0 && H5Aread(attribute.id, type, ret_text) >= 0;
    if (good)
        ret_text[room - 1] = '\0';
    if (type >= 0)
        H5Tclose(type);
    close_attribute(&attribute);
    return good;
}

bool pir_h5_get_numbers(hid_t in, const char *name, pir_h5_type type, void *ret_numbers, uint64_t count) {
    struct attribute attribute = open_attribute(in, name);
    bool good = has_elements(&attribute, count) && is_type(attribute.stored, type) &&
                H5Aread(attribute.id, memory_type(type), ret_numbers) >= 0;
    close_attribute(&attribute);
    return good;
}
