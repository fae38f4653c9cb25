/* SPDX-License-Identifier: MIT */
/*
 * Files by their ending: which reader, which writer; reading whole files, writing whole files or none.
 *
 * A file is written under a name of its own in the same directory, opened so that it cannot already exist, and renamed to
 * its target only when every byte is down; on any failure it is removed and the target is as before.
 */
#include "polytope/io.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"
#include "base/report.h"

/* Names tried for the file beside the target before giving up: one for each writer at work on it at once. */
#define TEMPORARY_NAMES 100

/* The longest part of a path that a report repeats. */
#define SHORT_NAME 96

bool pir_c_locale_enter(struct pir_c_locale *ret_locale) {
    ret_locale->own = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (ret_locale->own == (locale_t)0)
        return false;
    ret_locale->previous = uselocale(ret_locale->own);
    return true;
}

void pir_c_locale_leave(struct pir_c_locale *locale) {
    uselocale(locale->previous);
    freelocale(locale->own);
}

const char *pir_short_name(const char *path) {
    size_t length = strlen(path);
    return length > SHORT_NAME ? path + length - SHORT_NAME : path;
}

void pir_mesh_bounds(const pir_mesh *mesh, pir_vec3 *ret_low, pir_vec3 *ret_high) {
    const pir_vec3 *vertices = pir_mesh_vertices(mesh);
    pir_vec3 low = vertices[0], high = vertices[0];
    for (uint32_t v = 1; v < pir_mesh_vertex_count(mesh); v++) {
        low.x = vertices[v].x < low.x ? vertices[v].x : low.x;
        low.y = vertices[v].y < low.y ? vertices[v].y : low.y;
        low.z = vertices[v].z < low.z ? vertices[v].z : low.z;
        high.x = vertices[v].x > high.x ? vertices[v].x : high.x;
        high.y = vertices[v].y > high.y ? vertices[v].y : high.y;
        high.z = vertices[v].z > high.z ? vertices[v].z : high.z;
    }
    *ret_low = low;
    *ret_high = high;
}

/* --- endings --- */

enum file_type { TYPE_UNKNOWN, TYPE_OFF, TYPE_ASSIMP, TYPE_SVG };

/* The type by the ending, in either case; ret_ending gets it in lower case without the dot. */
static enum file_type type_of(const char *path, char ret_ending[4]) {
    size_t length = strlen(path);
    ret_ending[0] = '\0';
    if (length < 4 || path[length - 4] != '.')
        return TYPE_UNKNOWN;
    for (size_t i = 0; i < 4; i++) {
        char c = path[length - 3 + i];
        ret_ending[i] = c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
    }
    if (strcmp(ret_ending, "off") == 0)
        return TYPE_OFF;
    if (strcmp(ret_ending, "svg") == 0)
        return TYPE_SVG;
    if (strcmp(ret_ending, "obj") == 0 || strcmp(ret_ending, "stl") == 0 || strcmp(ret_ending, "ply") == 0)
        return TYPE_ASSIMP;
    return TYPE_UNKNOWN;
}

/* --- reading --- */

struct bytes {
    char *data;
    size_t size, capacity;
};

static pir_status fail_file(pir_report *report, const char *path, const char *doing, int error) {
    return pir_fail(report, PIR_ERR_FILE, "%s: cannot %s: %s", pir_short_name(path), doing, strerror(error));
}

/* Reads an open stream to its end; `expected` is a guess at its size. */
static pir_status read_stream(FILE *file, size_t expected, const char *path, const pir_allocator *allocator,
                              pir_report *report, struct bytes *bytes) {
    for (;;) {
        // Room for at least one byte more, which a read at the end leaves empty.
        if (bytes->size == bytes->capacity) {
            size_t capacity = bytes->capacity ? 2 * bytes->capacity : expected + 1;
            char *data = PIR_RESIZE(allocator, bytes->data, bytes->capacity, capacity);
            if (!data)
                return pir_fail(report, PIR_ERR_MEMORY, "%s: out of memory", pir_short_name(path));
            bytes->data = data;
            bytes->capacity = capacity;
        }
        errno = 0;
        bytes->size += fread(bytes->data + bytes->size, 1, bytes->capacity - bytes->size, file);
        if (ferror(file))
            return fail_file(report, path, "read", errno);
        if (bytes->size > PIR_FILE_SIZE_MAX)
            return pir_fail(report, PIR_ERR_LIMIT, "%s: larger than 2 GiB", pir_short_name(path));
        if (feof(file))
            return PIR_OK;
    }
}

/* Reads a file into `bytes`, which the caller frees whatever the outcome. */
static pir_status read_file(const char *path, const pir_allocator *allocator, pir_report *report, struct bytes *bytes) {
    FILE *file = fopen(path, "rb");
    if (!file)
        return fail_file(report, path, "open", errno);
    pir_status status;
    struct stat about;
    if (fstat(fileno(file), &about) != 0)
        status = fail_file(report, path, "read", errno);
    else if (S_ISDIR(about.st_mode))
        status = fail_file(report, path, "read", EISDIR);
    else if (S_ISREG(about.st_mode) && (uintmax_t)about.st_size > PIR_FILE_SIZE_MAX)
        status = pir_fail(report, PIR_ERR_LIMIT, "%s: larger than 2 GiB", pir_short_name(path));
    else
        status =
            read_stream(file, S_ISREG(about.st_mode) ? (size_t)about.st_size : 4096, path, allocator, report, bytes);
    fclose(file);
    return status;
}

pir_status pir_polytope_read(const char *path, const pir_allocator *allocator, pir_report *report,
                             pir_polytope **ret_polytope) {
    if (!path || !ret_polytope)
        return pir_fail(report, PIR_ERR_ARGUMENT, "no path, or no place for the polytope");
    const char *name = pir_short_name(path);
    char ending[4];
    enum file_type type = type_of(path, ending);
    if (type == TYPE_SVG)
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: .svg files are written, not read", name);
    if (type == TYPE_UNKNOWN)
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: the name does not end in .off, .obj, .stl or .ply", name);

    pir_allocator memory = pir_allocator_or_default(allocator);
    struct bytes bytes = {0};
    pir_status status = read_file(path, &memory, report, &bytes);
    if (status == PIR_OK && bytes.size == 0)
        status = pir_fail(report, PIR_ERR_EMPTY, "%s: the file is empty", name);
    if (status == PIR_OK && type == TYPE_OFF)
        status = pir_polytope_read_off(bytes.data, bytes.size, name, &memory, report, ret_polytope);
    if (status == PIR_OK && type == TYPE_ASSIMP)
        status = pir_polytope_read_assimp(bytes.data, bytes.size, ending, name, &memory, report, ret_polytope);
    PIR_FREE(&memory, bytes.data, bytes.capacity);
    return status;
}

/* --- writing --- */

/* A new file beside `path`; its name to `ret_name`, room for `room` bytes. NULL with errno set on failure. */
static FILE *open_beside(const char *path, char *ret_name, size_t room) {
    for (int i = 0; i < TEMPORARY_NAMES; i++) {
        snprintf(ret_name, room, "%s.tmp%d", path, i);
        FILE *file = fopen(ret_name, "wbx");
        if (file || errno != EEXIST)
            return file;
    }
    return NULL;
}

static pir_status write_stream(const pir_mesh *mesh, FILE *file, const char *path, int exact, pir_report *report) {
    const char *name = pir_short_name(path);
    char ending[4];
    pir_status status = PIR_ERR_ARGUMENT;
    switch (type_of(path, ending)) {
    case TYPE_ASSIMP:
        return pir_mesh_write_assimp(mesh, file, ending, name, report);
    case TYPE_OFF:
        status = pir_mesh_write_off(mesh, file, exact != 0);
        break;
    case TYPE_SVG:
        status = pir_mesh_write_svg(mesh, file);
        break;
    case TYPE_UNKNOWN:
        break;
    }
    return status == PIR_OK ? PIR_OK : pir_fail(report, status, "%s: cannot write: %s", name, pir_status_text(status));
}

/* Writes to the temporary name, then renames. */
static pir_status write_and_rename(const pir_mesh *mesh, const char *path, int exact, char *temporary, size_t room,
                                   pir_report *report) {
    FILE *file = open_beside(path, temporary, room);
    if (!file)
        return fail_file(report, path, "write", errno);
    pir_status status = write_stream(mesh, file, path, exact, report);
    // A full disk may show only now; errno is that of the first failure.
    errno = 0;
    bool bad = fflush(file) != 0 || ferror(file);
    int error = errno ? errno : EIO;
    if (fclose(file) != 0 && !bad) {
        bad = true;
        error = errno;
    }
    if (status == PIR_OK && bad)
        status = fail_file(report, path, "write", error);
    if (status == PIR_OK && rename(temporary, path) != 0)
        status = fail_file(report, path, "write", errno);
    if (status != PIR_OK)
        remove(temporary);
    return status;
}

pir_status pir_mesh_write(const pir_mesh *mesh, const char *path, int exact, pir_report *report) {
    if (!mesh || !path)
        return pir_fail(report, PIR_ERR_ARGUMENT, "no mesh, or no path to write it to");
    const char *name = pir_short_name(path);
    char ending[4];
    enum file_type type = type_of(path, ending);
    if (type == TYPE_UNKNOWN)
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: the name does not end in .off, .obj, .stl, .ply or .svg", name);
    if (exact && type != TYPE_OFF)
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: only .off holds exact coordinates", name);
    if (exact && !pir_mesh_is_exact(mesh))
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: the mesh holds no exact coordinates", name);

    pir_allocator memory = pir_allocator_or_default(NULL);
    size_t room = strlen(path) + sizeof ".tmp99";
    char *temporary = PIR_NEW(&memory, char, room);
    if (!temporary)
        return pir_fail(report, PIR_ERR_MEMORY, "%s: out of memory", name);
    pir_status status = write_and_rename(mesh, path, exact, temporary, room, report);
    PIR_FREE(&memory, temporary, room);
    return status;
}
