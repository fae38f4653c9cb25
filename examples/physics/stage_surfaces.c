/* SPDX-License-Identifier: MIT */
/* Surfaces of a stage: see stage_surfaces.h. */
#include "stage_surfaces.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "heights.h"

static bool path_of(const struct fields *fields, const char *name, const char *folder, char path[4096]) {
    const char *file = fields_text(fields, name);
    if (!file)
        return false;
    const int length = snprintf(path, 4096, "%s%s", *file == '/' ? "" : folder, file);
    return (length >= 0 && length < 4096) || fields_fail(fields, name, "the path is too long");
}

static bool fail_status(const struct fields *fields, const char *name, pir_status status, const pir_report *report) {
    return fields_fail(fields, name, "%s", *report->text ? report->text : pir_status_text(status));
}

/* --- meshes --- */

/* The triangles of a mesh, larger. */
static pir_status scale_mesh(pir_trimesh *mesh, double by, const pir_trimesh_options *options, pir_report *report,
                             pir_trimesh **ret_scaled) {
    pir_trimesh_info info;
    pir_trimesh_describe(mesh, &info);
    pir_vec3 *vertex = malloc((3 * (size_t)info.triangles + 1) * sizeof *vertex);
    uint32_t *corner = malloc((3 * (size_t)info.triangles + 1) * sizeof *corner);
    pir_status status = vertex && corner ? PIR_OK : PIR_ERR_MEMORY;
    for (uint32_t t = 0; status == PIR_OK && t < info.triangles; t++) {
        pir_triangle_corners corners;
        status = pir_trimesh_triangle(mesh, t, &corners);
        for (uint32_t k = 0; status == PIR_OK && k < 3; k++) {
            const pir_vec3 p = corners.corner[k];
            vertex[3 * (size_t)t + k] = (pir_vec3){by * p.x, by * p.y, by * p.z};
            corner[3 * (size_t)t + k] = 3 * t + k;
        }
    }
    const pir_trimesh_arrays arrays = {.vertices = vertex,
                                       .vertex_count = 3 * (size_t)info.triangles,
                                       .triangles = corner,
                                       .triangle_count = info.triangles};
    if (status == PIR_OK)
        status = pir_trimesh_create(&arrays, options, report, ret_scaled);
    free(vertex);
    free(corner);
    return status;
}

static bool read_mesh(const struct fields *fields, const char *folder, struct world_shape *ret_shape) {
    static const char *const known[] = {"mesh", "scale", "two_sided", NULL};
    char path[4096];
    double scale = 1;
    pir_trimesh_options options = pir_trimesh_options_default();
    pir_trimesh *mesh = NULL, *scaled = NULL;
    pir_report report = {0};
    if (!fields_known(fields, known) || !path_of(fields, "mesh", folder, path) ||
        !fields_number(fields, "scale", 1e-9, 1e9, &scale) || !fields_flag(fields, "two_sided", &options.two_sided))
        return false;
    pir_status status = pir_trimesh_read(path, &options, &report, &mesh);
    if (status == PIR_OK && scale == 1)
        scaled = pir_trimesh_retain(mesh);
    else if (status == PIR_OK)
        status = scale_mesh(mesh, scale, &options, &report, &scaled);
    pir_trimesh_release(mesh);
    if (status != PIR_OK)
        return fail_status(fields, "mesh", status, &report);
    *ret_shape = world_shape_of_mesh(scaled);
    pir_trimesh_release(scaled);
    return true;
}

/* --- heights --- */

/* Heights that stand in the scene itself: rows of numbers, null for none. */
static bool take_rows(const struct fields *fields, const cJSON *rows, struct heights *to) {
    const int count = cJSON_GetArraySize(rows), columns = count > 0 ? cJSON_GetArraySize(rows->child) : 0;
    if (columns < 1 || columns > 32768 || count > 32768 || !heights_reserve(to, (uint32_t)columns, (uint32_t)count))
        return fields_fail(fields, "heights", "has %d rows of %d", count, columns);
    to->columns = (uint32_t)columns;
    for (const cJSON *row = rows->child; row; row = row->next, to->rows++) {
        if (!cJSON_IsArray(row) || cJSON_GetArraySize(row) != columns)
            return fields_fail(fields, "heights", "row %u is no array of %d", (unsigned)to->rows, columns);
        double *at = to->at + (size_t)to->rows * to->columns;
        for (const cJSON *item = row->child; item; item = item->next, at++) {
            if (!(cJSON_IsNumber(item) && isfinite(item->valuedouble)) && !cJSON_IsNull(item))
                return fields_fail(fields, "heights", "row %u has what is no number", (unsigned)to->rows);
            *at = cJSON_IsNull(item) ? NAN : item->valuedouble;
        }
    }
    return true;
}

/* By its first byte, with which no text begins; so what comes through a pipe is read too. */
static bool is_png(FILE *file) {
    const int first = getc(file);
    if (first != EOF)
        ungetc(first, file);
    return first == 0x89;
}

/* Heights from a file; *ret_grey says whether it is a picture, whose heights are from 0 to 1. */
static bool read_heights(const struct fields *fields, const char *path, struct heights *to, bool *ret_grey) {
    char why[HEIGHTS_WHY] = "";
    FILE *file = fopen(path, "rb");
    if (!file)
        return fields_fail(fields, "heights", "%s: cannot be read: %s", path, strerror(errno));
    *ret_grey = is_png(file);
    const bool good = (*ret_grey ? heights_read_png : heights_read_table)(file, to, why);
    fclose(file);
    return good || fields_fail(fields, "heights", "%s: %s", path, why);
}

/* The height field of heights, from `file` or NULL; cells with a corner that has none are holes. */
static bool make_field(const struct fields *fields, const char *file, const struct heights *heights,
                       const double step[2], struct world_shape *ret_shape) {
    const uint32_t cells = heights->columns > 1 && heights->rows > 1 ? heights->columns - 1 : 0;
    uint8_t *hole = calloc((size_t)cells * heights->rows + 1, 1);
    pir_height_options options = pir_height_options_default();
    pir_height_field *field = NULL;
    pir_report report = {0};
    if (!hole)
        return fields_fail(fields, "heights", "out of memory");
    for (uint32_t j = 0; j + 1 < heights->rows; j++)
        for (uint32_t i = 0; i < cells; i++) {
            const double *at = heights->at + (size_t)j * heights->columns + i;
            hole[(size_t)j * cells + i] =
                isnan(at[0]) || isnan(at[1]) || isnan(at[heights->columns]) || isnan(at[heights->columns + 1]);
        }
    const pir_height_samples samples = {.heights = heights->at,
                                        .type = PIR_NUMBERS_DOUBLE,
                                        .columns = heights->columns,
                                        .rows = heights->rows,
                                        .step_x = step[0],
                                        .step_y = step[1],
                                        .holes = hole};
    bool good = fields_flag(fields, "two_sided", &options.two_sided);
    const pir_status status = good ? pir_height_field_create(&samples, &options, &report, &field) : PIR_OK;
    free(hole);
    if (status != PIR_OK)
        return fields_fail(fields, "heights", "%s%s%s", file ? file : "", file ? ": " : "",
                           *report.text ? report.text : pir_status_text(status));
    if (good)
        *ret_shape = world_shape_of_field(field);
    pir_height_field_release(field);
    return good;
}

static bool read_field(const struct fields *fields, const char *folder, struct world_shape *ret_shape) {
    static const char *const known[] = {"heights", "step", "range", "two_sided", NULL};
    double step[2] = {1, 1}, range[2] = {0, 1};
    struct heights heights = {0};
    char path[4096];
    bool grey = false;
    const cJSON *rows = cJSON_GetObjectItemCaseSensitive(fields->object, "heights");
    bool good = fields_known(fields, known) && fields_numbers(fields, "step", 2, step) &&
                fields_numbers(fields, "range", 2, range);
    if (good && !(step[0] > 0 && step[1] > 0))
        good = fields_fail(fields, "step", "is not above 0");
    if (good && cJSON_IsArray(rows))
        good = take_rows(fields, rows, &heights);
    else if (good && rows && !cJSON_IsString(rows))
        good = fields_fail(fields, "heights", "is neither an array of rows nor the name of a file");
    else if (good)
        good = path_of(fields, "heights", folder, path) && read_heights(fields, path, &heights, &grey);
    if (good && !grey && cJSON_HasObjectItem(fields->object, "range"))
        good = fields_fail(fields, "range", "is for a picture");
    for (size_t i = 0; good && grey && i < (size_t)heights.columns * heights.rows; i++)
        heights.at[i] = range[0] + heights.at[i] * (range[1] - range[0]);
    good = good && make_field(fields, cJSON_IsArray(rows) ? NULL : path, &heights, step, ret_shape);
    heights_clear(&heights);
    return good;
}

bool stage_is_surface(const struct fields *fields) {
    return cJSON_HasObjectItem(fields->object, "mesh") || cJSON_HasObjectItem(fields->object, "heights");
}

bool stage_surface(const struct fields *fields, const char *folder, struct world_shape *ret_shape) {
    if (cJSON_HasObjectItem(fields->object, "mesh"))
        return read_mesh(fields, folder, ret_shape);
    return read_field(fields, folder, ret_shape);
}
