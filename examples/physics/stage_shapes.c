/* SPDX-License-Identifier: MIT */
/* Shapes: models, points and pieces become polytopes, and these a shape. */
#include "stage_shapes.h"

#include "stage_surfaces.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The most pieces of a body in a scene. */
#define PIECES_MOST 4096
/* Pieces of pieces of pieces, so deep and no deeper. */
#define DEPTH_MOST 4

struct gathered {
    pir_polytope *piece[PIECES_MOST];
    uint32_t count;
};

static bool fail_status(const struct fields *fields, const char *name, pir_status status, const pir_report *report) {
    return fields_fail(fields, name, "%s", *report->text ? report->text : pir_status_text(status));
}

/* Takes the polytope over. */
static bool gather(const struct fields *fields, struct gathered *to, pir_polytope *piece) {
    if (to->count == PIECES_MOST) {
        pir_polytope_release(piece);
        return fields_fail(fields, NULL, "has more than %d pieces", PIECES_MOST);
    }
    to->piece[to->count++] = piece;
    return true;
}

static bool gather_points(const struct fields *fields, struct gathered *to) {
    const cJSON *array = fields_array(fields, "points");
    int count = cJSON_GetArraySize(array), i = 0;
    pir_vec3 *point = array ? calloc((size_t)count, sizeof *point) : NULL;
    bool good = point;
    if (array && !point)
        fields_fail(fields, "points", "out of memory");
    for (const cJSON *item = good ? array->child : NULL; good && item; item = item->next, i++) {
        double values[3];
        for (int k = 0; good && k < 3; k++) {
            const cJSON *number =
                cJSON_IsArray(item) && cJSON_GetArraySize(item) == 3 ? cJSON_GetArrayItem(item, k) : NULL;
            good = cJSON_IsNumber(number) || fields_fail(fields, "points", "element %d is no array of 3 numbers", i);
            values[k] = good ? number->valuedouble : 0;
        }
        point[i] = (pir_vec3){values[0], values[1], values[2]};
    }
    pir_polytope *made = NULL;
    if (good) {
        const pir_report none = {0};
        pir_status status = pir_polytope_create(point, (size_t)count, NULL, &made);
        good = status == PIR_OK ? gather(fields, to, made) : fail_status(fields, "points", status, &none);
    }
    free(point);
    return good;
}

/* The convex pieces of a solid. */
static bool gather_solid(const struct fields *fields, const char *path, struct gathered *to) {
    pir_solid *solid = NULL;
    pir_pieces *pieces = NULL;
    pir_report report = {0};
    pir_status status = pir_solid_read(path, NULL, &report, &solid);
    if (status == PIR_OK)
        status = pir_solid_decompose(solid, NULL, NULL, &pieces);
    bool good = status == PIR_OK || fail_status(fields, "model", status, &report);
    for (uint32_t i = 0; good && i < pir_pieces_count(pieces); i++) {
        pir_polytope *piece = NULL;
        status = pir_pieces_polytope(pieces, i, &piece);
        good = status == PIR_OK ? gather(fields, to, piece) : fail_status(fields, "model", status, &report);
    }
    pir_pieces_destroy(pieces);
    pir_solid_release(solid);
    return good;
}

static bool gather_model(const struct fields *fields, const char *folder, struct gathered *to) {
    const char *model = fields_text(fields, "model");
    bool solid = false;
    if (!model || !fields_flag(fields, "solid", &solid))
        return false;
    const char *prefix = "shape:";
    bool is_shape = strncmp(model, prefix, strlen(prefix)) == 0;
    char path[4096];
    int length = snprintf(path, sizeof path, "%s%s", *model == '/' ? "" : folder, model);
    if (!is_shape && (length < 0 || (size_t)length >= sizeof path))
        return fields_fail(fields, "model", "the path is too long");
    if (solid && !is_shape)
        return gather_solid(fields, path, to);
    pir_polytope *made = NULL;
    pir_report report = {0};
    pir_status status = is_shape ? pir_shape_create(model + strlen(prefix), NULL, &report, &made)
                                 : pir_polytope_read(path, NULL, &report, NULL, &made);
    return status == PIR_OK ? gather(fields, to, made) : fail_status(fields, "model", status, &report);
}

/* Multiplies the pieces from number `from` on. */
static bool scale(const struct fields *fields, struct gathered *to, uint32_t from) {
    double factor = 1;
    if (!fields_number(fields, "scale", 1e-9, 1e9, &factor))
        return false;
    for (uint32_t i = from; factor != 1 && i < to->count; i++) {
        const pir_report none = {0};
        pir_polytope *scaled = NULL;
        pir_status status = pir_polytope_scale(to->piece[i], factor, &scaled);
        if (status != PIR_OK)
            return fail_status(fields, "scale", status, &none);
        pir_polytope_release(to->piece[i]);
        to->piece[i] = scaled;
    }
    return true;
}

static bool gather_shape(const struct fields *fields, const char *folder, int depth, struct gathered *to) {
    static const char *const known[] = {"model", "points", "pieces", "scale", "solid", NULL};
    uint32_t from = to->count;
    if (!fields_known(fields, known))
        return false;
    int kinds = 0;
    for (int i = 0; i < 3; i++)
        kinds += cJSON_HasObjectItem(fields->object, known[i]) != 0;
    if (kinds != 1)
        return fields_fail(fields, NULL, "has %s of model, points and pieces", kinds ? "more than one" : "none");
    if (cJSON_HasObjectItem(fields->object, "solid") && !cJSON_HasObjectItem(fields->object, "model"))
        return fields_fail(fields, "solid", "is for a model");
    bool good;
    if (cJSON_HasObjectItem(fields->object, "model"))
        good = gather_model(fields, folder, to);
    else if (cJSON_HasObjectItem(fields->object, "points"))
        good = gather_points(fields, to);
    else {
        int count = cJSON_GetArraySize(fields_array(fields, "pieces"));
        good = count > 0 && (depth < DEPTH_MOST || fields_fail(fields, "pieces", "are nested too deep"));
        for (int i = 0; good && i < count; i++) {
            struct fields piece = fields_element(fields, "pieces", i);
            good = gather_shape(&piece, folder, depth + 1, to);
        }
    }
    return good && scale(fields, to, from);
}

bool stage_shape(const struct fields *fields, const char *folder, struct world_shape *ret_shape) {
    if (stage_is_surface(fields))
        return stage_surface(fields, folder, ret_shape);
    struct gathered *pieces = calloc(1, sizeof *pieces);
    if (!pieces)
        return fields_fail(fields, NULL, "out of memory");
    bool good = gather_shape(fields, folder, 0, pieces);
    if (good) {
        const pir_report none = {0};
        pir_status status = world_shape_make(pieces->piece, pieces->count, ret_shape);
        good = status == PIR_OK || fail_status(fields, NULL, status, &none);
    }
    for (uint32_t i = 0; i < pieces->count; i++)
        pir_polytope_release(pieces->piece[i]);
    free(pieces);
    return good;
}
