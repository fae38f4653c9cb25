/* SPDX-License-Identifier: MIT */
/* Files by their ending: which reader, which writer; reading whole files. Writing them is in write.c. */
#include "polytope/io.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"
#include "base/report.h"

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

enum pir_file_type pir_file_type_of(const char *path, char ret_ending[4]) {
    size_t length = strlen(path);
    ret_ending[0] = '\0';
    if (length < 4 || path[length - 4] != '.')
        return PIR_FILE_UNKNOWN;
    for (size_t i = 0; i < 4; i++) {
        char c = path[length - 3 + i];
        ret_ending[i] = c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
    }
    if (strcmp(ret_ending, "off") == 0)
        return PIR_FILE_OFF;
    if (strcmp(ret_ending, "svg") == 0)
        return PIR_FILE_SVG;
    if (strcmp(ret_ending, "obj") == 0 || strcmp(ret_ending, "stl") == 0 || strcmp(ret_ending, "ply") == 0)
        return PIR_FILE_ASSIMP;
    return PIR_FILE_UNKNOWN;
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

pir_status pir_polytope_read(const char *path, const pir_polytope_options *options, pir_report *report,
                             pir_polytope **ret_polytope) {
    if (!path || !ret_polytope)
        return pir_fail(report, PIR_ERR_ARGUMENT, "no path, or no place for the polytope");
    const char *name = pir_short_name(path);
    char ending[4];
    enum pir_file_type type = pir_file_type_of(path, ending);
    if (type == PIR_FILE_SVG)
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: .svg files are written, not read", name);
    if (type == PIR_FILE_UNKNOWN)
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: the name does not end in .off, .obj, .stl or .ply", name);

    pir_allocator memory = pir_allocator_or_default(options ? options->allocator : NULL);
    struct bytes bytes = {0};
    pir_status status = read_file(path, &memory, report, &bytes);
    if (status == PIR_OK && bytes.size == 0)
        status = pir_fail(report, PIR_ERR_EMPTY, "%s: the file is empty", name);
    if (status == PIR_OK && type == PIR_FILE_OFF)
        status = pir_polytope_read_off(bytes.data, bytes.size, name, options, report, ret_polytope);
    if (status == PIR_OK && type == PIR_FILE_ASSIMP)
        status = pir_polytope_read_assimp(bytes.data, bytes.size, ending, name, options, report, ret_polytope);
    PIR_FREE(&memory, bytes.data, bytes.capacity);
    return status;
}
