/* SPDX-License-Identifier: MIT */
/* Files of slices, opened and read; the form is that of docs/slices.md. */
#include "cspace/store/store.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <pirouette/io.h>

#include "base/report.h"
#include "cspace/parts/plan.h"
#include "cspace/store/h5.h"
#include "cspace/store/names.h"
#include "cspace/store/sealed_file.h"

/* The longest model that is read, and the most pieces. */
#define OFF_MOST    ((uint64_t)1 << 31)
#define PIECES_MOST (1u << 24)

/* The data sets of a section; -1 where the file has none. */
struct sets {
    hid_t group, data, count, unit, check;
    uint64_t elements; /* in `data` */
};

struct pir_store {
    pir_allocator allocator;
    char *path;
    size_t path_size;
    pir_sealed_file sealed;
    hid_t file, rotation; /* the file is that of `sealed` */
    pir_cspace_info info;
    uint64_t units_per_pair;
    pir_polytope **piece;
    uint32_t piece_count;
    struct sets section[PIR_UNIT_SECTION_COUNT];
};

static pir_status broken(const pir_store *store, pir_report *report, const char *where, const char *why) {
    pir_status damaged = pir_sealed_tell(&store->sealed.sealed, store->path, report);
    if (damaged != PIR_OK)
        return damaged;
    return pir_fail(report, PIR_ERR_FORMAT, "%s: %s: %s", store->path, where, why);
}

/* --- what the file is --- */

static pir_status read_head(pir_store *store, pir_report *report) {
    char format[32];
    uint32_t version;
    if (!pir_h5_get_text(store->file, "format", format, sizeof format) || strcmp(format, PIR_SLICES_FORMAT) != 0)
        return broken(store, report, "attribute format", "it is no file of slices");
    if (!pir_h5_get_numbers(store->file, "version", PIR_H5_U32, &version, 1))
        return broken(store, report, "attribute version", "missing");
    if (version != PIR_SLICES_VERSION)
        return pir_fail(report, PIR_ERR_VERSION, "%s: attribute version: it is %u, this library reads %u", store->path,
                        (unsigned)version, PIR_SLICES_VERSION);
    return PIR_OK;
}

static pir_status read_grid(pir_store *store, pir_report *report) {
    pir_grid_info *grid = &store->info.grid;
    char kind[16] = "";
    double axis[3];
    uint64_t size[2];
    hid_t group = pir_h5_open_group(store->file, "grid");
    bool good = group >= 0 && pir_h5_get_text(group, "kind", kind, sizeof kind) &&
                pir_h5_get_numbers(group, "axis", PIR_H5_F64, axis, 3) &&
                pir_h5_get_numbers(group, "level", PIR_H5_U32, &grid->level, 1) &&
                pir_h5_get_numbers(group, "spacing", PIR_H5_F64, &grid->spacing, 1);
    int number = 0;
    while (number < 3 && strcmp(kind, pir_names_of_grid[number]) != 0)
        number++;
    if (good)
        store->rotation = pir_h5_open_set(group, "rotation", PIR_H5_F64, 2, size);
    pir_h5_close(group);
    if (!good || number == 3)
        return broken(store, report, "group grid", "missing, or of no kind that there is");
    if (store->rotation < 0 || size[1] != 4 || size[0] == 0)
        return broken(store, report, "grid/rotation", "missing, or not N x 4 doubles");
    grid->kind = (pir_grid_kind)number;
    grid->axis = (pir_vec3){axis[0], axis[1], axis[2]};
    grid->count = size[0];
    return PIR_OK;
}

/* --- pieces --- */

/* Reads the text of a model, to be freed by its size. */
static pir_status read_off(pir_store *store, hid_t group, const char *where, pir_report *report, pir_bytes *text) {
    uint64_t size, start = 0;
    hid_t set = pir_h5_open_set(group, "off", PIR_H5_U8, 1, &size);
    pir_status status = PIR_OK;
    if (set < 0 || size == 0 || size > OFF_MOST || H5Dget_storage_size(set) == 0)
        status = broken(store, report, where, "no model in off");
    // what is kept in no chunk costs nothing in the file: memory follows what is stored
    else if (size / 1100 > H5Dget_storage_size(set))
        status = broken(store, report, where, "a model of a size that lies");
    else if (!pir_bytes_reserve(text, &store->allocator, (size_t)size))
        status = pir_fail(report, PIR_ERR_MEMORY, "%s: out of memory", store->path);
    else if (!pir_h5_read(set, PIR_H5_U8, &start, &size, text->data))
        status = broken(store, report, where, "the model cannot be read");
    text->used = status == PIR_OK ? (size_t)size : 0;
    pir_h5_close(set);
    return status;
}

static pir_status read_piece(pir_store *store, hid_t in, const char *where, const char *name, pir_report *report) {
    char hash[17] = "", found[17];
    pir_bytes text = {0};
    hid_t group = pir_h5_open_group(in, name);
    pir_status status = PIR_OK;
    if (group < 0 || !pir_h5_get_text(group, "hash", hash, sizeof hash))
        status = broken(store, report, where, "a piece is missing, or has no hash");
    if (status == PIR_OK)
        status = read_off(store, group, where, report, &text);
    pir_h5_close(group);
    if (status == PIR_OK) {
        snprintf(found, sizeof found, "%016" PRIx64, pir_hash_bytes(PIR_HASH_START, text.data, text.used));
        if (strcmp(hash, found) != 0)
            status = broken(store, report, where, "the hash does not match the model");
    }
    const pir_read_options options = {.size = sizeof options, .allocator = &store->allocator};
    if (status == PIR_OK)
        status = pir_polytope_read_bytes(&(pir_file_bytes){(const char *)text.data, text.used, where, "off"}, &options,
                                         report, NULL, &store->piece[store->piece_count]);
    store->piece_count += status == PIR_OK;
    pir_bytes_finish(&text, &store->allocator);
    return status;
}

static pir_status count_pieces(pir_store *store, const char *name, pir_report *report, uint32_t *ret_count) {
    H5G_info_t info;
    hid_t group = pir_h5_open_group(store->file, name);
    bool good = group >= 0 && H5Gget_info(group, &info) >= 0 && info.nlinks > 0 && info.nlinks <= PIECES_MOST;
    pir_h5_close(group);
    if (!good)
        return broken(store, report, name, "no pieces, or too many");
    *ret_count = (uint32_t)info.nlinks;
    return PIR_OK;
}

static pir_status read_pieces(pir_store *store, const char *name, uint32_t count, pir_report *report) {
    hid_t group = pir_h5_open_group(store->file, name);
    pir_status status = PIR_OK;
    for (uint32_t i = 0; status == PIR_OK && i < count; i++) {
        char number[16], where[48];
        snprintf(number, sizeof number, "%" PRIu32, i);
        snprintf(where, sizeof where, "%s/%s", name, number);
        status = read_piece(store, group, where, number, report);
    }
    pir_h5_close(group);
    return status;
}

static pir_status read_models(pir_store *store, pir_report *report) {
    pir_cspace_info *info = &store->info;
    pir_status status = count_pieces(store, "robot", report, &info->robot_count);
    if (status == PIR_OK)
        status = count_pieces(store, "obstacle", report, &info->obstacle_count);
    if (status != PIR_OK)
        return status;
    store->piece = PIR_ZEROED(&store->allocator, pir_polytope *, (size_t)info->robot_count + info->obstacle_count);
    if (!store->piece)
        return pir_fail(report, PIR_ERR_MEMORY, "%s: out of memory", store->path);
    status = read_pieces(store, "robot", info->robot_count, report);
    return status == PIR_OK ? read_pieces(store, "obstacle", info->obstacle_count, report) : status;
}

/* --- sections --- */

/* Opens the data sets of a section, whose sizes must be those of the pieces and rotations. */
static bool open_sets(pir_store *store, int s) {
    const pir_unit_section_names *names = &pir_names_of_section[s];
    struct sets *sets = &store->section[s];
    uint32_t doubles = pir_unit_section_doubles[s];
    uint64_t pairs = (uint64_t)store->info.robot_count * store->info.obstacle_count, slices = store->info.grid.count;
    uint64_t data[2] = {0, doubles}, count[2], unit[2], check[2];
    sets->data = pir_h5_open_set(sets->group, names->data, doubles ? PIR_H5_F64 : PIR_H5_U8, doubles ? 2 : 1, data);
    sets->count = pir_h5_open_set(sets->group, names->count, PIR_H5_U32, 2, count);
    sets->unit = pir_h5_open_set(sets->group, names->unit, PIR_H5_U64, 2, unit);
    sets->check = pir_h5_open_set(sets->group, names->check, PIR_H5_U64, 2, check);
    sets->elements = data[0];
    return sets->data >= 0 && sets->count >= 0 && sets->unit >= 0 && sets->check >= 0 && data[1] == doubles &&
           count[0] == pairs && count[1] == slices && unit[0] == pairs && unit[1] == store->units_per_pair &&
           check[0] == pairs && check[1] == store->units_per_pair;
}

static pir_status read_sections(pir_store *store, pir_report *report) {
    pir_cspace_info *info = &store->info;
    for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++)
        store->section[s].group = pir_h5_open_group(store->file, pir_names_of_section[s].group);
    hid_t slices = store->section[PIR_UNIT_SECTION_RECORDS].group;
    if (slices < 0 || !pir_h5_get_numbers(slices, "slices_per_unit", PIR_H5_U32, &info->slices_per_unit, 1) ||
        !pir_h5_get_numbers(slices, "slices_per_key", PIR_H5_U32, &info->slices_per_key, 1) ||
        info->slices_per_unit == 0 || info->slices_per_unit > PIR_CSPACE_UNIT_MAX || info->slices_per_key == 0)
        return broken(store, report, "group slices", "missing, or units of no length");
    store->units_per_pair = (info->grid.count - 1) / info->slices_per_unit + 1;
    info->has_planes = store->section[PIR_UNIT_SECTION_PLANES].group >= 0;
    info->has_vertices = store->section[PIR_UNIT_SECTION_VERTICES].group >= 0;
    for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++)
        if (store->section[s].group >= 0 && !open_sets(store, s))
            return broken(store, report, pir_names_of_section[s].group, "a data set is missing, or of another form");
    return PIR_OK;
}

/* --- opening --- */

static void close_store(pir_store *store) {
    for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++) {
        pir_h5_close(store->section[s].data);
        pir_h5_close(store->section[s].count);
        pir_h5_close(store->section[s].unit);
        pir_h5_close(store->section[s].check);
        pir_h5_close(store->section[s].group);
    }
    pir_h5_close(store->rotation);
    pir_sealed_file_close(&store->sealed);
}

void pir_store_close(pir_store *store) {
    if (!store)
        return;
    const pir_allocator a = store->allocator;
    pir_h5_reports reports = pir_h5_quiet();
    close_store(store);
    pir_h5_loud(reports);
    for (uint32_t i = 0; i < store->piece_count; i++)
        pir_polytope_release(store->piece[i]);
    if (store->piece)
        PIR_FREE(&a, store->piece, (size_t)store->info.robot_count + store->info.obstacle_count);
    if (store->path)
        PIR_FREE(&a, store->path, store->path_size);
    PIR_FREE(&a, store, 1);
}

static pir_status read_all(pir_store *store, pir_report *report) {
    pir_status status = pir_sealed_file_open(&store->sealed, store->path, &store->allocator, report);
    if (status != PIR_OK)
        return status;
    store->file = store->sealed.file;
    status = read_head(store, report);
    if (status == PIR_OK)
        status = read_grid(store, report);
    if (status == PIR_OK)
        status = read_models(store, report);
    return status == PIR_OK ? read_sections(store, report) : status;
}

pir_status pir_store_open(const char *path, const pir_allocator *allocator, pir_report *report, pir_store **ret_store) {
    const pir_allocator a = pir_allocator_or_default(allocator);
    pir_store *store = PIR_ZEROED(&a, pir_store, 1);
    if (!store)
        return pir_fail(report, PIR_ERR_MEMORY, "%s: out of memory", path);
    *store = (pir_store){
        .allocator = a, .sealed = PIR_NO_SEALED_FILE, .file = -1, .rotation = -1, .path_size = strlen(path) + 1};
    for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++)
        store->section[s] = (struct sets){-1, -1, -1, -1, -1, 0};
    store->path = PIR_NEW(&a, char, store->path_size);
    pir_status status = PIR_ERR_MEMORY;
    if (store->path) {
        memcpy(store->path, path, store->path_size);
        pir_h5_reports reports = pir_h5_quiet();
        status = read_all(store, report);
        pir_h5_loud(reports);
    } else {
        pir_fail(report, status, "%s: out of memory", path);
    }
    if (status != PIR_OK) {
        pir_store_close(store);
        return status;
    }
    *ret_store = store;
    return PIR_OK;
}

const pir_cspace_info *pir_store_info(const pir_store *store) {
    return &store->info;
}

pir_polytope *const *pir_store_pieces(const pir_store *store) {
    return store->piece;
}

/* --- reading --- */

pir_status pir_store_rotations(pir_store *store, uint64_t first, size_t count, pir_report *report,
                               pir_quat *ret_rotations) {
    pir_h5_reports reports = pir_h5_quiet();
    bool good = pir_h5_read(store->rotation, PIR_H5_F64, (uint64_t[]){first, 0}, (uint64_t[]){count, 4}, ret_rotations);
    pir_h5_loud(reports);
    if (!good)
        return broken(store, report, "grid/rotation", "it cannot be read");
    for (size_t i = 0; i < count; i++) {
        const pir_quat *q = &ret_rotations[i];
        bool finite = isfinite(q->x) && isfinite(q->y) && isfinite(q->z) && isfinite(q->w);
        if (!finite || (q->x == 0 && q->y == 0 && q->z == 0 && q->w == 0))
            return pir_fail(report, PIR_ERR_FORMAT, "%s: grid/rotation: row %" PRIu64 ": it is no rotation",
                            store->path, first + i);
    }
    return PIR_OK;
}

/* The elements of the section's data from `start` on, into the unit. */
static pir_status read_data(pir_store *store, pir_unit_section s, uint64_t start, uint64_t elements, pir_report *report,
                            pir_bytes *data) {
    const struct sets *sets = &store->section[s];
    const char *where = pir_names_of_section[s].group;
    if (start > sets->elements || elements > sets->elements - start)
        return broken(store, report, where, "a unit that lies outside of its data set");
    // a data set may say that it is long where nothing is stored
    uint64_t size = elements * pir_unit_section_element[s];
    if (size / 1100 > H5Dget_storage_size(sets->data))
        return broken(store, report, where, "a data set of a size that lies");
    data->used = 0;
    if (!pir_bytes_reserve(data, &store->allocator, (size_t)size))
        return pir_fail(report, PIR_ERR_MEMORY, "%s: out of memory", store->path);
    const uint64_t from[2] = {start, 0}, count[2] = {elements, pir_unit_section_doubles[s]};
    pir_h5_type type = pir_unit_section_doubles[s] ? PIR_H5_F64 : PIR_H5_U8;
    if (elements > 0 && !pir_h5_read(sets->data, type, from, count, data->data))
        return broken(store, report, where, "a unit cannot be read: truncated or corrupted");
    data->used = (size_t)size;
    return PIR_OK;
}

static pir_status read_unit(pir_store *store, pir_unit_section s, uint64_t number, pir_report *report, pir_unit *unit) {
    const struct sets *sets = &store->section[s];
    const pir_cspace_info *info = &store->info;
    uint64_t in_pair = number % store->units_per_pair, first = in_pair * info->slices_per_unit, start, check;
    const uint64_t at[2] = {number / store->units_per_pair, in_pair}, one[2] = {1, 1};
    uint64_t left = info->grid.count - first;
    unit->number = number;
    unit->slices = left < info->slices_per_unit ? (uint32_t)left : info->slices_per_unit;
    if (!pir_h5_read(sets->unit, PIR_H5_U64, at, one, &start) ||
        !pir_h5_read(sets->check, PIR_H5_U64, at, one, &check) ||
        !pir_h5_read(sets->count, PIR_H5_U32, (uint64_t[]){at[0], first}, (uint64_t[]){1, unit->slices},
                     unit->count[s]))
        return broken(store, report, pir_names_of_section[s].group, "a table cannot be read");
    uint64_t elements = 0;
    for (uint32_t i = 0; i < unit->slices; i++)
        elements += unit->count[s][i];
    pir_status status = read_data(store, s, start, elements, report, &unit->data[s]);
    if (status == PIR_OK && check != pir_hash_words(PIR_HASH_START, unit->data[s].data, unit->data[s].used))
        return pir_fail(report, PIR_ERR_FORMAT, "%s: %s: unit %" PRIu64 ": the checksum does not match", store->path,
                        pir_names_of_section[s].group, number);
    return status;
}

pir_status pir_store_unit(pir_store *store, pir_unit_section section, uint64_t number, pir_report *report,
                          pir_unit *unit) {
    pir_h5_reports reports = pir_h5_quiet();
    pir_status status = read_unit(store, section, number, report, unit);
    pir_h5_loud(reports);
    return status;
}
