/* SPDX-License-Identifier: MIT */
/* Solids of files, of facets in memory and of polytopes. Points at one place become one. */
#include <pirouette/mesh.h>

#include "base/report.h"
#include "base/vec.h"
#include "polytope/exact_points.h"
#include "polytope/mesh.h"
#include "polytope/polytope.h"
#include "polytope/read/read.h"
#include "polytope/surface/facets.h"
#include "solid/body/solid.h"

struct solid_maker {
    const pir_solid_options *options;
    pir_solid **solid;
};

static pir_status make_of_points(const struct pir_model *model, const struct pir_exact_points *exact,
                                 const struct solid_maker *maker) {
    struct pir_model_facets facets;
    uint32_t *line = PIR_NEW(&model->allocator, uint32_t, model->facet_count);
    if (!line || !pir_facets_init(&facets, model, &exact->vectors)) {
        PIR_FREE(&model->allocator, line, model->facet_count);
        return pir_model_fail_memory(model);
    }
    for (uint32_t f = 0; f < model->facet_count; f++)
        line[f] = model->facet[f].line;
    const pir_solid_parts parts = {.points = &exact->vectors,
                                   .scale = &exact->scale,
                                   .source = {.name = model->name,
                                              .report = model->report,
                                              .line = model->binary ? NULL : line,
                                              .facet_count = facets.count,
                                              .start = facets.start,
                                              .corner = facets.corner}};
    const pir_status status = pir_solid_make(&parts, maker->options, maker->solid);
    pir_facets_finish(&facets, &model->allocator);
    PIR_FREE(&model->allocator, line, model->facet_count);
    return status;
}

static pir_status make_of_model(const struct pir_model *model, void *context) {
    if (model->point_count == 0 || model->facet_count == 0)
        return pir_fail(model->report, PIR_ERR_EMPTY, "%s: there are no facets", model->name);
    struct pir_exact_points exact = {0};
    pir_status status =
        model->exact
            ? pir_exact_points_of_rationals(&exact, (const mpq_t *)model->exact, model->point_count, &model->allocator)
            : pir_exact_points_of_doubles(&exact, model->points, model->point_count, &model->allocator);
    if (status != PIR_OK)
        return pir_fail(model->report, status, "%s: its points: %s", model->name, pir_status_text(status));
    status = make_of_points(model, &exact, context);
    pir_exact_points_finish(&exact, &model->allocator);
    return status;
}

pir_status pir_solid_read(const char *path, const pir_solid_options *options, pir_report *report,
                          pir_solid **ret_solid) {
    if (!path || !ret_solid)
        return pir_fail(report, PIR_ERR_ARGUMENT, "no path, or no place for the solid");
    pir_allocator allocator;
    pir_solid_options used;
    const pir_status status = pir_solid_options_take(options, &report, &allocator, &used);
    if (status != PIR_OK)
        return status;
    struct solid_maker maker = {&used, ret_solid};
    return pir_model_read_file(path, &allocator, report, (struct pir_model_maker){make_of_model, &maker});
}

pir_status pir_solid_read_bytes(const pir_file_bytes *file, const pir_solid_options *options, pir_report *report,
                                pir_solid **ret_solid) {
    if (!file || (!file->bytes && file->size > 0) || !ret_solid)
        return pir_fail(report, PIR_ERR_ARGUMENT, "no bytes, or no place for the solid");
    pir_allocator allocator;
    pir_solid_options used;
    const pir_status status = pir_solid_options_take(options, &report, &allocator, &used);
    if (status != PIR_OK)
        return status;
    struct solid_maker maker = {&used, ret_solid};
    return pir_model_read_bytes(file, &allocator, report, (struct pir_model_maker){make_of_model, &maker});
}

/* The points and facets in memory as a reader would leave them. */
static pir_status fill_model(struct pir_model *model, const pir_solid_facets *facets) {
    pir_status status = pir_model_check_counts(model, facets->point_count, facets->facet_count);
    model->binary = true;
    for (size_t i = 0; i < facets->point_count && status == PIR_OK; i++)
        status = pir_vec_is_finite(facets->points[i])
                     ? pir_model_add_point(model, facets->points[i])
                     : pir_fail(model->report, PIR_ERR_NOT_FINITE, "point %zu is not finite", i);
    for (size_t f = 0; f < facets->facet_count && status == PIR_OK; f++) {
        status = pir_model_begin_facet(model, 0);
        for (uint32_t i = facets->starts[f]; i < facets->starts[f + 1] && status == PIR_OK; i++)
            status = facets->corners[i] < facets->point_count
                         ? pir_model_add_corner(model, facets->corners[i])
                         : pir_fail(model->report, PIR_ERR_ARGUMENT, "facet %zu: there is no point %u", f,
                                    (unsigned)facets->corners[i]);
    }
    return status;
}

pir_status pir_solid_create(const pir_solid_facets *facets, const pir_solid_options *options, pir_report *report,
                            pir_solid **ret_solid) {
    if (!facets || (!facets->points && facets->point_count) || !facets->starts || !facets->corners || !ret_solid)
        return pir_fail(report, PIR_ERR_ARGUMENT, "no facets, or no place for the solid");
    pir_allocator allocator;
    pir_solid_options used;
    pir_status status = pir_solid_options_take(options, &report, &allocator, &used);
    if (status != PIR_OK)
        return status;
    struct solid_maker maker = {&used, ret_solid};
    struct pir_model model;
    pir_model_init(&model, "the facets", &allocator, report);
    status = fill_model(&model, facets);
    if (status == PIR_OK)
        status = make_of_model(&model, &maker);
    pir_model_finish(&model);
    return status;
}

pir_status pir_solid_from_polytope(const pir_polytope *polytope, const pir_solid_options *options,
                                   pir_solid **ret_solid) {
    if (!polytope || !ret_solid)
        return PIR_ERR_ARGUMENT;
    if (polytope->dimension < 3)
        return PIR_ERR_EMPTY;
    pir_allocator allocator;
    pir_solid_options used;
    pir_status status = pir_solid_options_take(options, NULL, &allocator, &used);
    if (status != PIR_OK)
        return status;
    pir_mesh *mesh = NULL;
    status = pir_mesh_from_polytope(polytope, &mesh);
    if (status != PIR_OK)
        return status;
    const pir_solid_parts parts = {.points = &mesh->where,
                                   .scale = &mesh->scale,
                                   .source = {.name = "the polytope",
                                              .report = used.report,
                                              .facet_count = mesh->facets.count,
                                              .start = mesh->facets.start,
                                              .corner = mesh->facets.corner}};
    status = pir_solid_make(&parts, &used, ret_solid);
    pir_mesh_destroy(mesh);
    return status;
}
