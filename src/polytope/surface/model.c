/* SPDX-License-Identifier: MIT */
/* Points and facets in arrays that grow; see model.h. */
#include "polytope/surface/model.h"

#include "base/memory.h"
#include "base/report.h"

/* Points, and facets, that a model may have. */
#define COUNT_MAX ((uint32_t)1 << 30)

void pir_model_init(struct pir_model *model, const char *name, const pir_allocator *allocator, pir_report *report) {
    *model = (struct pir_model){.allocator = *allocator, .name = name, .report = report};
}

void pir_model_finish(struct pir_model *model) {
    for (size_t i = 0; i < 3 * (size_t)model->exact_count; i++)
        mpq_clear(model->exact[i]);
    PIR_FREE(&model->allocator, model->exact, 3 * (size_t)model->exact_count);
    PIR_FREE(&model->allocator, model->points, model->point_room);
    PIR_FREE(&model->allocator, model->facet, model->facet_room);
    PIR_FREE(&model->allocator, model->corner, model->corner_room);
}

pir_status pir_model_fail_memory(const struct pir_model *model) {
    return pir_fail(model->report, PIR_ERR_MEMORY, "%s: out of memory", model->name);
}

/* Twice the room, or a first one. */
static uint32_t more_room(uint32_t room) {
    return room < 32 ? 64 : room < UINT32_MAX / 2 ? 2 * room : UINT32_MAX;
}

pir_status pir_model_check_counts(const struct pir_model *model, size_t points, size_t facets) {
    if (points >= COUNT_MAX)
        return pir_fail(model->report, PIR_ERR_LIMIT, "%s: 2^30 points or more", model->name);
    if (facets >= COUNT_MAX)
        return pir_fail(model->report, PIR_ERR_LIMIT, "%s: 2^30 facets or more", model->name);
    return PIR_OK;
}

pir_status pir_model_reserve_points(struct pir_model *model, uint32_t count) {
    if (count <= model->point_room)
        return PIR_OK;
    pir_vec3 *points = PIR_RESIZE(&model->allocator, model->points, model->point_room, count);
    if (!points)
        return pir_model_fail_memory(model);
    model->points = points;
    model->point_room = count;
    return PIR_OK;
}

pir_status pir_model_add_point(struct pir_model *model, pir_vec3 point) {
    pir_status status = pir_model_check_counts(model, (size_t)model->point_count + 1, 0);
    if (status == PIR_OK && model->point_count == model->point_room)
        status = pir_model_reserve_points(model, more_room(model->point_room));
    if (status != PIR_OK)
        return status;
    model->points[model->point_count++] = point;
    return PIR_OK;
}

pir_status pir_model_begin_facet(struct pir_model *model, size_t line) {
    pir_status status = pir_model_check_counts(model, 0, (size_t)model->facet_count + 1);
    if (status != PIR_OK)
        return status;
    if (model->facet_count == model->facet_room) {
        uint32_t room = more_room(model->facet_room);
        struct pir_model_facet *facet = PIR_RESIZE(&model->allocator, model->facet, model->facet_room, room);
        if (!facet)
            return pir_model_fail_memory(model);
        model->facet = facet;
        model->facet_room = room;
    }
    model->facet[model->facet_count++] = (struct pir_model_facet){model->corner_count, (uint32_t)line};
    return PIR_OK;
}

pir_status pir_model_add_corner(struct pir_model *model, uint32_t point) {
    if (model->corner_count == UINT32_MAX)
        return pir_fail(model->report, PIR_ERR_LIMIT, "%s: 2^32 corners or more", model->name);
    if (model->corner_count == model->corner_room) {
        uint32_t room = more_room(model->corner_room);
        uint32_t *corner = PIR_RESIZE(&model->allocator, model->corner, model->corner_room, room);
        if (!corner)
            return pir_model_fail_memory(model);
        model->corner = corner;
        model->corner_room = room;
    }
    model->corner[model->corner_count++] = point;
    return PIR_OK;
}
