/* SPDX-License-Identifier: MIT */
/*
 * Parts into the file. Units are taken pair by pair in order, wherever they stand, so that the file does not depend on
 * who made them when.
 */
#include "cspace/store/assemble.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <time.h>
#include <unistd.h>

#include <pirouette/version.h>

#include "base/report.h"
#include "cspace/store/h5.h"
#include "cspace/store/names.h"
#include "cspace/store/piece_file.h"
#include "cspace/store/sealed_file.h"
#include "polytope/file/file_name.h"
#include "polytope/file/target.h"

#define TABLE_CHUNK 1024
#define GRID_CHUNK  2048

/* At most what a file takes before there is anything in it, and a piece beside its model. */
#define FILE_MOST  65536
#define PIECE_MOST 32768

/* A section that is written, and the tables beside it. */
struct section {
    hid_t group, data, count, unit, check;
    pir_h5_shape shape;
    uint64_t elements; /* so far, those included that fill chunks up */
};

struct output {
    const pir_parts *parts;
    const pir_plan *plan;
    hid_t file;
    struct section section[PIR_UNIT_SECTION_COUNT];
    pir_unit unit;
    pir_packer *packer;
};

/* --- the grid --- */

static bool put_rotations(const struct output *out, hid_t group) {
    const pir_plan *plan = out->plan;
    // digits of rotations are as good as random: they are kept as they are
    const pir_h5_shape rotations = {PIR_H5_F64, 2, {plan->slices, 4}, {GRID_CHUNK, 4}, false, true};
    const pir_h5_shape cells = {PIR_H5_U64, 1, {plan->slices, 0}, {GRID_CHUNK, 0}, false, false};
    hid_t rotation = pir_h5_make_set(group, "rotation", &rotations), cell = pir_h5_make_set(group, "cell", &cells);
    bool good = rotation >= 0 && cell >= 0;
    for (uint64_t i = 0; good && i < plan->slices; i += GRID_CHUNK) {
        double q[GRID_CHUNK][4];
        uint64_t c[GRID_CHUNK], n = 0;
        for (; n < GRID_CHUNK && i + n < plan->slices; n++) {
            pir_quat r = pir_grid_rotation(plan->grid, i + n);
            q[n][0] = r.x;
            q[n][1] = r.y;
            q[n][2] = r.z;
            q[n][3] = r.w;
            c[n] = pir_grid_cell(plan->grid, i + n);
        }
        good = pir_h5_write(rotation, PIR_H5_F64, (uint64_t[]){i, 0}, (uint64_t[]){n, 4}, q) &&
               pir_h5_put_rows(cell, &cells, i, c, out->packer);
    }
    good = pir_h5_close(rotation) && good;
    return pir_h5_close(cell) && good;
}

static bool put_grid(const struct output *out) {
    pir_grid_info info = pir_grid_get_info(out->plan->grid);
    const double axis[3] = {info.axis.x, info.axis.y, info.axis.z};
    const uint32_t level = info.level;
    hid_t group = pir_h5_make_group(out->file, "grid");
    bool good = group >= 0 && pir_h5_put_text(group, "kind", pir_names_of_grid[info.kind]) &&
                pir_h5_put_numbers(group, "axis", PIR_H5_F64, axis, 3) &&
                pir_h5_put_numbers(group, "level", PIR_H5_U32, &level, 1) &&
                pir_h5_put_numbers(group, "spacing", PIR_H5_F64, &info.spacing, 1) && put_rotations(out, group);
    return pir_h5_close(group) && good;
}

/* --- models and what the file is --- */

static void write_hash(const pir_plan *plan, char hash[17]) {
    snprintf(hash, 17, "%016" PRIx64, plan->hash);
}

static bool put_head(const struct output *out) {
    char hash[17];
    const uint32_t version = PIR_SLICES_VERSION;
    write_hash(out->plan, hash);
    return pir_h5_put_text(out->file, "format", PIR_SLICES_FORMAT) &&
           pir_h5_put_numbers(out->file, "version", PIR_H5_U32, &version, 1) &&
           pir_h5_put_text(out->file, "library", PIR_VERSION_STRING) && pir_h5_put_text(out->file, "hash", hash) &&
           pir_h5_put_text(out->file, "length_unit", "that of the models") &&
           pir_h5_put_text(out->file, "angle_unit", "radian");
}

/* --- sections --- */

static bool has_section(const pir_plan *plan, int s) {
    return s == PIR_UNIT_SECTION_RECORDS || (s == PIR_UNIT_SECTION_PLANES ? plan->planes : plan->vertices);
}

static bool begin_section(struct output *out, int s) {
    const pir_plan *plan = out->plan;
    const pir_unit_section_names *names = &pir_names_of_section[s];
    struct section *section = &out->section[s];
    uint32_t doubles = pir_unit_section_doubles[s];
    section->shape = (pir_h5_shape){.type = doubles ? PIR_H5_F64 : PIR_H5_U8, .rank = doubles ? 2 : 1, .grows = true};
    section->shape.size[1] = section->shape.chunk[1] = doubles;
    section->shape.chunk[0] = pir_chunk_elements[s];
    const pir_h5_shape counts = {PIR_H5_U32, 2, {plan->pairs, plan->slices}, {1, TABLE_CHUNK}, false, false};
    const pir_h5_shape units = {PIR_H5_U64, 2, {plan->pairs, plan->units_per_pair}, {1, TABLE_CHUNK}, false, false};
    section->group = pir_h5_make_group(out->file, names->group);
    if (section->group < 0)
        return false;
    section->data = pir_h5_make_set(section->group, names->data, &section->shape);
    section->count = pir_h5_make_set(section->group, names->count, &counts);
    section->unit = pir_h5_make_set(section->group, names->unit, &units);
    section->check = pir_h5_make_set(section->group, names->check, &units);
    return section->data >= 0 && section->count >= 0 && section->unit >= 0 && section->check >= 0 &&
           (s != PIR_UNIT_SECTION_RECORDS ||
            (pir_h5_put_numbers(section->group, "slices_per_unit", PIR_H5_U32, &plan->slices_per_unit, 1) &&
             pir_h5_put_numbers(section->group, "slices_per_key", PIR_H5_U32, &plan->slices_per_key, 1)));
}

static bool end_section(struct section *section) {
    bool good = pir_h5_close(section->data);
    good = pir_h5_close(section->count) && good;
    good = pir_h5_close(section->unit) && good;
    good = pir_h5_close(section->check) && good;
    return pir_h5_close(section->group) && good;
}

/* Appends the chunks of a section of the unit that has been read. */
static bool put_chunks(struct output *out, int s, uint64_t elements) {
    struct section *section = &out->section[s];
    const pir_bytes *packed = &out->unit.packed[s];
    uint64_t start[2] = {section->elements, 0};
    size_t at = 0;
    if (!pir_h5_extend(section->data, &section->shape, section->elements + elements))
        return false;
    for (pir_chunk chunk; pir_next_chunk(packed, &at, &chunk); start[0] += pir_chunk_elements[s])
        if (!pir_h5_write_chunk(section->data, &section->shape, start, &chunk))
            return false;
    return true;
}

/* Appends a section of the unit that has been read. */
static bool put_unit(struct output *out, int s) {
    const pir_plan *plan = out->plan;
    const pir_unit *unit = &out->unit;
    struct section *section = &out->section[s];
    uint64_t pair = unit->number / plan->units_per_pair, elements = pir_unit_elements(unit, s);
    const uint64_t in_units[2] = {pair, unit->number % plan->units_per_pair}, one[2] = {1, 1};
    const uint64_t in_counts[2] = {pair, pir_plan_first(plan, unit->number)}, counts[2] = {1, unit->slices};
    if (elements > 0 && !put_chunks(out, s, elements))
        return false;
    bool good = pir_h5_write(section->count, PIR_H5_U32, in_counts, counts, unit->count[s]) &&
                pir_h5_write(section->unit, PIR_H5_U64, in_units, one, &section->elements) &&
                pir_h5_write(section->check, PIR_H5_U64, in_units, one, &unit->check[s]);
    // the next unit begins a chunk
    section->elements += (elements + pir_chunk_elements[s] - 1) / pir_chunk_elements[s] * pir_chunk_elements[s];
    return good;
}

static bool put_sections(struct output *out, pir_status *status, pir_report *report) {
    const pir_plan *plan = out->plan;
    bool good = true;
    for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++)
        if (has_section(plan, s))
            good = good && begin_section(out, s);
    for (uint64_t u = 0; good && u < plan->units; u++) {
        *status = pir_parts_read(out->parts, u, &out->unit, report);
        good = *status == PIR_OK;
        for (int s = 0; good && s < PIR_UNIT_SECTION_COUNT; s++)
            good = !has_section(plan, s) || put_unit(out, s);
    }
    for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++)
        good = end_section(&out->section[s]) && good;
    return good;
}

/* --- the file --- */

/* Opens a new file for HDF5 to write. Jobs have a lock of their own: HDF5's, which some systems lack, is off. */
static hid_t create_file(const char *path) {
    hid_t create = H5Pcreate(H5P_FILE_CREATE), access = H5Pcreate(H5P_FILE_ACCESS);
    hid_t file = -1;
    bool good = create >= 0 && access >= 0 && H5Pset_obj_track_times(create, false) >= 0;
#if H5_VERSION_GE(1, 10, 7) && (H5_VERS_MINOR != 12 || H5_VERS_RELEASE > 0)
    good = good && H5Pset_file_locking(access, false, true) >= 0;
#endif
    if (good)
        file = H5Fcreate(path, H5F_ACC_TRUNC, create, access);
    if (create >= 0)
        H5Pclose(create);
    if (access >= 0)
        H5Pclose(access);
    return file;
}

/* The reason in words. HDF5 may not set errno. */
static const char *reason(int error) {
    return error ? strerror(error) : "HDF5 could not";
}

/* At most what the file will take; tables as if they were not compressed. */
static uint64_t most_bytes(const pir_parts *parts) {
    const pir_plan *plan = parts->plan;
    uint64_t sections = 1u + plan->planes + plan->vertices, tables = plan->slices * 5 * sizeof(double);
    tables += sections * (plan->pairs * plan->slices * sizeof(uint32_t) + 2 * plan->units * sizeof(uint64_t));
    uint64_t bytes = FILE_MOST + parts->done_bytes + tables + tables / 8;
    for (uint32_t i = 0; i < plan->robot_count + plan->obstacle_count; i++)
        bytes += PIECE_MOST + 8 * (uint64_t)plan->piece[i].off.used;
    return bytes + pir_seal_size(bytes);
}

/*
 * Makes the file, which must not be there, and tells whether it may become so large. Where HDF5 cannot write to the
 * end, it cannot close the file either, and some versions of it crash when the process ends. So limits are met before.
 */
static bool make_room(const pir_parts *parts, const char *path) {
    const uint64_t most = most_bytes(parts);
    struct statvfs disk;
    int descriptor = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0)
        return false;
    errno = 0;
    if (ftruncate(descriptor, (off_t)most) == 0 && ftruncate(descriptor, 0) == 0 && fstatvfs(descriptor, &disk) == 0 &&
        (uint64_t)disk.f_bavail < most / disk.f_frsize)
        errno = ENOSPC;
    int error = errno;
    close(descriptor);
    errno = error;
    return error == 0;
}

static pir_status write_file(struct output *out, const char *path, pir_report *report) {
    for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++)
        out->section[s] = (struct section){-1, -1, -1, -1, -1, {0}, 0};
    errno = 0;
    if (!make_room(out->parts, path))
        return pir_fail(report, PIR_ERR_FILE, "%s: cannot write: %s", pir_short_name(out->parts->file),
                        strerror(errno));
    out->file = create_file(path);
    pir_status status = PIR_OK;
    bool good = out->file >= 0 && put_head(out) && put_grid(out) && pir_pieces_put(out->file, out->plan, out->packer) &&
                put_sections(out, &status, report) && H5Fflush(out->file, H5F_SCOPE_GLOBAL) >= 0;
    int error = errno;
    if (!pir_h5_close(out->file))
        good = false;
    if (status != PIR_OK)
        return status;
    return good ? PIR_OK
                : pir_fail(report, PIR_ERR_FILE, "%s: cannot write: %s", pir_short_name(out->parts->file),
                           reason(error));
}

/* Sees to it that the folder of a path is on the disk, as far as the system lets it. */
static void sync_folder(const char *path) {
    char folder[PIR_PATH_SIZE] = ".";
    const char *slash = strrchr(path, '/');
    if (slash && (size_t)(slash + 1 - path) < sizeof folder)
        snprintf(folder, sizeof folder, "%.*s", (int)(slash + 1 - path), path);
    int descriptor = open(folder, O_RDONLY | O_CLOEXEC);
    if (descriptor < 0)
        return;
    fsync(descriptor);
    close(descriptor);
}

/* Puts the file, which is sealed and on the disk, in the place of an older one, whose permissions it takes over. */
static pir_status give_name(const char *path, const char *name, pir_report *report) {
    struct stat old;
    if (stat(name, &old) == 0)
        chmod(path, old.st_mode & 07777);
    if (rename(path, name) != 0)
        return pir_fail(report, PIR_ERR_FILE, "%s: cannot rename to it: %s", pir_short_name(name), strerror(errno));
    // the parts are removed next: by then the name must be on the disk as well
    sync_folder(name);
    return PIR_OK;
}

/* Lets the caller add to the file before it gets its name. */
static pir_status complete(const pir_parts *parts, const pir_cspace_options *options, const char *path,
                           pir_report *report) {
    if (!options->complete || options->complete(options->context, path))
        return PIR_OK;
    return pir_fail(report, PIR_ERR_FILE, "%s: the caller could not complete it", pir_short_name(parts->file));
}

static pir_status assemble_as(const pir_parts *parts, const pir_cspace_options *options, const char *path,
                              pir_report *report) {
    struct output out = {.parts = parts, .plan = parts->plan, .file = -1};
    out.packer = pir_packer_new(&parts->allocator);
    if (!out.packer || !pir_unit_init(&out.unit, parts->plan->slices_per_unit, &parts->allocator)) {
        pir_packer_free(out.packer);
        return pir_fail(report, PIR_ERR_MEMORY, "%s: out of memory", parts->file);
    }
    pir_h5_reports reports = pir_h5_quiet();
    pir_status status = write_file(&out, path, report);
    pir_h5_loud(reports);
    if (status == PIR_OK)
        status = pir_seal(path, &parts->allocator, report);
    pir_unit_finish(&out.unit, &parts->allocator);
    pir_packer_free(out.packer);
    if (status == PIR_OK)
        status = complete(parts, options, path, report);
    if (status == PIR_OK)
        status = give_name(path, parts->file, report);
    if (status != PIR_OK)
        unlink(path);
    return status;
}

pir_status pir_assemble(const pir_parts *parts, const pir_cspace_options *options, pir_report *report) {
    struct timespec now;
    size_t size = strlen(parts->file) + sizeof PIR_ASSEMBLING + 3 * sizeof(long) * 3;
    char *path = PIR_NEW(&parts->allocator, char, size);
    if (!path)
        return pir_fail(report, PIR_ERR_MEMORY, "%s: out of memory", pir_short_name(parts->file));
    // a name that no other process has, for where there are no locks and someone has removed that of a job under way
    clock_gettime(CLOCK_REALTIME, &now);
    snprintf(path, size, "%s" PIR_ASSEMBLING "-%ld-%ld%09ld", parts->file, (long)getpid(), (long)now.tv_sec,
             now.tv_nsec);
    pir_status status = assemble_as(parts, options, path, report);
    PIR_FREE(&parts->allocator, path, size);
    return status;
}

bool pir_assembled(const pir_parts *parts) {
    char hash[17], found[17];
    write_hash(parts->plan, hash);
    pir_h5_reports reports = pir_h5_quiet();
    pir_sealed_file file;
    bool same = pir_sealed_file_open(&file, parts->file, &parts->allocator, NULL) == PIR_OK &&
                pir_h5_get_text(file.file, "hash", found, sizeof found) && strcmp(hash, found) == 0;
    pir_sealed_file_close(&file);
    pir_h5_loud(reports);
    return same;
}
