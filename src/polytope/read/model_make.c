/* SPDX-License-Identifier: MIT */
/* The surface that the facets make is examined before the hull of the points replaces them; then facets are merged. */
#include "polytope/read/model_make.h"

#include "base/report.h"
#include "polytope/create/merge.h"
#include "polytope/exact_points.h"
#include "polytope/surface/surface.h"

pir_status pir_model_make(const struct pir_model *model, const pir_read_options *options, pir_surface *ret_surface,
                          pir_polytope **ret_polytope) {
    if (model->point_count == 0)
        return pir_fail(model->report, PIR_ERR_EMPTY, "%s: the file has no points", model->name);
    struct pir_exact_points exact = {0};
    pir_polytope *polytope = NULL;
    pir_surface surface;
    pir_status status =
        model->exact
            ? pir_exact_points_of_rationals(&exact, (const mpq_t *)model->exact, model->point_count, &model->allocator)
            : pir_exact_points_of_doubles(&exact, model->points, model->point_count, &model->allocator);
    if (status == PIR_OK)
        status = pir_polytope_build_hull(&(pir_polytope_parts){.points = &exact.vectors,
                                                               .scale = &exact.scale,
                                                               .doubles = model->exact ? NULL : model->points},
                                         &model->allocator, &polytope);
    if (status != PIR_OK)
        pir_fail(model->report, status, "%s: the convex hull of its points: %s", model->name, pir_status_text(status));
    const bool require_convex = options->require_convex != 0;
    if (status == PIR_OK && (ret_surface || require_convex))
        status = pir_surface_examine(model, &exact, polytope, require_convex, &surface);
    pir_exact_points_finish(&exact, &model->allocator);
    if (status != PIR_OK) {
        pir_polytope_release(polytope);
        return status;
    }
    status = pir_polytope_merge_within(polytope, options->merge_tolerance, ret_polytope);
    if (status != PIR_OK)
        return pir_fail(model->report, status, "%s: merging its facets: %s", model->name, pir_status_text(status));
    if (ret_surface)
        *ret_surface = surface;
    return PIR_OK;
}
