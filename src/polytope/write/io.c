/* SPDX-License-Identifier: MIT */
/* What reading and writing files share: names in reports, endings, the locale, bounds. Reading is in read.c, writing in
 * write.c. */
#include "polytope/write/io.h"

#include <string.h>

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
