/* SPDX-License-Identifier: MIT */
/* The triangles of a surface near a box: see near_triangles.h. */
#include "scene/world/near_triangles.h"

#include "scene/world/grow.h"

/* How much wider a box is than it has to be, of the coordinates: more than turning its middle and edges is off by. */
#define SEEN_ERROR 0x1p-44

pir_walk_box pir_place_sees(const pir_place *place, const pir_box *box) {
    double middle[3], half[3], size = 0;
    const double t[3] = {place->pose.translation.x, place->pose.translation.y, place->pose.translation.z};
    for (int k = 0; k < 3; k++) {
        middle[k] = 0.5 * ((double)box->low[k] + (double)box->high[k]) - t[k];
        half[k] = 0.5 * ((double)box->high[k] - (double)box->low[k]);
        size += fabs((double)box->low[k]) + fabs((double)box->high[k]) + fabs(t[k]);
    }
    const pir_vec3 at = pir_mat_apply_transposed(&place->r, (pir_vec3){middle[0], middle[1], middle[2]});
    pir_mat3 size_of = place->r;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            size_of.m[i][j] = fabs(size_of.m[i][j]);
    const pir_vec3 reach = pir_mat_apply_transposed(&size_of, (pir_vec3){half[0], half[1], half[2]});
    const double centre[3] = {at.x, at.y, at.z}, edge[3] = {reach.x, reach.y, reach.z}, room = SEEN_ERROR * size;
    pir_walk_box seen;
    for (int k = 0; k < 3; k++) {
        seen.low[k] = centre[k] - edge[k] - room;
        seen.high[k] = centre[k] + edge[k] + room;
    }
    return seen;
}

struct triangle_list {
    pir_walk_box box;
    pir_scene *scene;
    uint32_t count;
    bool failed;
};

static void measure(const void *context, const pir_mesh_boxes *boxes, double ret_near[PIR_MESH_WIDTH]) {
    pir_walk_box_measure(&((const struct triangle_list *)context)->box, boxes, ret_near);
}

static bool look(void *context, const pir_met_triangle *met) {
    struct triangle_list *list = context;
    pir_scene_lists *lists = &list->scene->lists;
    if (!pir_walk_box_meets(&list->box, &met->tri))
        return true;
    list->failed = !PIR_GROW(&list->scene->allocator, lists->triangle, lists->triangle_capacity, list->count + 1);
    if (!list->failed)
        lists->triangle[list->count++] = met->number;
    return !list->failed;
}

pir_status pir_scene_list_triangles(pir_scene *scene, const pir_scene_body *body, const pir_place *place,
                                    const pir_box *box, uint32_t *ret_count) {
    struct triangle_list list = {.box = pir_place_sees(place, box), .scene = scene};
    const double most = 0;
    pir_surface_walk(pir_body_surface_of(body), &(pir_walk){measure, look, &list, &most, &list.box});
    *ret_count = list.count;
    return list.failed ? PIR_ERR_MEMORY : PIR_OK;
}
