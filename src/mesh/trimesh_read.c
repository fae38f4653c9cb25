/* SPDX-License-Identifier: MIT */
/* Meshes from files: the model that the reader of its format makes, its facets cut into triangles. */
#include <string.h>

#include <pirouette/trimesh.h>

#include "base/layout.h"
#include "base/options.h"
#include "base/report.h"
#include "mesh/polygon_cut.h"
#include "polytope/read/read.h"

struct trimesh_maker {
    const pir_trimesh_options *options;
    pir_report *report;
    pir_trimesh **mesh;
};

static pir_status fail_facet(const struct pir_model *model, uint32_t f, uint32_t corners, pir_status status) {
    const char *why = status == PIR_ERR_LIMIT ? "it is concave, and more than 4096 are too many"
                                              : "it crosses itself, so it has no inside";
    if (model->binary)
        return pir_fail(model->report, status, "%s: facet %u has %u corners: %s", model->name, f, corners, why);
    return pir_fail(model->report, status, "%s:%u: a facet of %u corners: %s", model->name, model->facet[f].line,
                    corners, why);
}

static pir_status fail_memory(const struct pir_model *model) {
    return pir_fail(model->report, PIR_ERR_MEMORY, "%s: out of memory", model->name);
}

/* How many triangles the facets make; a facet of fewer than three corners makes none. */
static size_t triangle_count(const struct pir_model *model) {
    size_t count = 0;
    for (uint32_t f = 0; f < model->facet_count; f++) {
        uint32_t corners = pir_model_corners_end(model, f) - model->facet[f].start;
        count += corners > 2 ? corners - 2 : 0;
    }
    return count;
}

static pir_status cut_facets(const struct pir_model *model, const pir_cut_room *room, uint32_t (*triangle)[3]) {
    for (uint32_t f = 0; f < model->facet_count; f++) {
        uint32_t start = model->facet[f].start, corners = pir_model_corners_end(model, f) - start;
        if (corners < 3)
            continue;
        pir_status status = pir_polygon_cut(model->points, model->corner + start, corners, room, triangle);
        if (status != PIR_OK)
            return fail_facet(model, f, corners, status);
        triangle += corners - 2;
    }
    return PIR_OK;
}

static pir_layout layout_of(pir_cut_room *room) {
    return (pir_layout){{PIR_ROW(room->flat, PIR_CUT_MOST), PIR_ROW(room->before, PIR_CUT_MOST),
                         PIR_ROW(room->after, PIR_CUT_MOST), PIR_ROW(room->is_ear, PIR_CUT_MOST)}};
}

/* The mesh of triangles whose facets have been cut; what it says is wrong is told with the name of the file. */
static pir_status make_mesh(const struct pir_model *model, const struct trimesh_maker *maker, uint32_t (*triangle)[3],
                            size_t count) {
    const pir_trimesh_arrays arrays = {
        .vertices = model->points,
        .vertex_count = model->point_count,
        .triangles = triangle ? triangle[0] : NULL,
        .triangle_count = count,
    };
    pir_report report = {0};
    pir_status status = pir_trimesh_create(&arrays, maker->options, &report, maker->mesh);
    return status == PIR_OK ? PIR_OK : pir_fail(maker->report, status, "%s: %.150s", model->name, report.text);
}

static pir_status make(const struct pir_model *model, void *context) {
    const struct trimesh_maker *maker = context;
    const pir_allocator *allocator = &model->allocator;
    size_t count = triangle_count(model);
    if (count == 0)
        return pir_fail(maker->report, PIR_ERR_EMPTY, "%s: there is no facet", model->name);
    uint32_t(*triangle)[3] = pir_memory_new(allocator, count, sizeof *triangle);
    pir_cut_room room = {0};
    const pir_layout layout = layout_of(&room);
    pir_status status = triangle && pir_layout_new(allocator, &layout) ? PIR_OK : fail_memory(model);
    if (status == PIR_OK)
        status = cut_facets(model, &room, triangle);
    pir_layout_free(allocator, &layout);
    if (status == PIR_OK)
        status = make_mesh(model, maker, triangle, count);
    PIR_FREE(allocator, triangle, count);
    return status;
}

/* Reads the bytes or, where that is NULL, the file at the path. */
static pir_status read_model(const pir_file_bytes *file, const char *path, const pir_trimesh_options *options,
                             pir_report *report, pir_trimesh **ret_mesh) {
    pir_trimesh_options used = pir_trimesh_options_default();
    const pir_status status = pir_options_take("pir_trimesh_options", options, &used, &report);
    if (status != PIR_OK)
        return status;
    const pir_allocator allocator = pir_allocator_or_default(used.allocator);
    struct trimesh_maker maker = {&used, report, ret_mesh};
    const struct pir_model_maker model = {make, &maker};
    return file ? pir_model_read_bytes(file, &allocator, report, model)
                : pir_model_read_file(path, &allocator, report, model);
}

pir_status pir_trimesh_read_bytes(const pir_file_bytes *file, const pir_trimesh_options *options, pir_report *report,
                                  pir_trimesh **ret_mesh) {
    if (!file || (!file->bytes && file->size > 0) || !ret_mesh)
        return pir_fail(report, PIR_ERR_ARGUMENT, "no bytes, or no place for the mesh");
    return read_model(file, NULL, options, report, ret_mesh);
}

pir_status pir_trimesh_read(const char *path, const pir_trimesh_options *options, pir_report *report,
                            pir_trimesh **ret_mesh) {
    if (!path || !ret_mesh)
        return pir_fail(report, PIR_ERR_ARGUMENT, "no path, or no place for the mesh");
    return read_model(NULL, path, options, report, ret_mesh);
}
