/* SPDX-License-Identifier: MIT */
/* Units made: see maker.h. */
#include "cspace/parts/maker.h"

#include <string.h>

#include "cspace/record/halfspaces.h"

bool pir_maker_init(pir_maker *maker, const pir_plan *plan) {
    *maker = (pir_maker){.plan = plan};
    maker->packer = pir_packer_new(&plan->allocator);
    return maker->packer && pir_unit_init(&maker->unit, plan->slices_per_unit, &plan->allocator);
}

static void forget_pair(pir_maker *maker) {
    pir_recorder_finish(&maker->recorder);
    pir_sum_destroy(maker->sum);
    maker->sum = NULL;
}

void pir_maker_finish(pir_maker *maker) {
    if (!maker->plan)
        return;
    forget_pair(maker);
    pir_unit_finish(&maker->unit, &maker->plan->allocator);
    pir_packer_free(maker->packer);
    *maker = (pir_maker){0};
}

/* Brings the sum to the first rotation of a unit, by walk. */
static pir_status begin(pir_maker *maker, uint64_t pair, pir_quat rotation) {
    const pir_plan *plan = maker->plan;
    if (maker->sum && maker->pair == pair)
        return pir_sum_reset(maker->sum, rotation);
    forget_pair(maker);
    pir_sum_options options = {.size = sizeof options, .allocator = &plan->allocator, .difference = true};
    pir_status status =
        pir_sum_create(pir_plan_robot(plan, pair), pir_plan_obstacle(plan, pair), rotation, &options, &maker->sum);
    if (status == PIR_OK && !pir_recorder_init(&maker->recorder, maker->sum, &plan->allocator))
        status = PIR_ERR_MEMORY;
    if (status != PIR_OK)
        forget_pair(maker);
    maker->pair = pair;
    return status;
}

/* --- sections --- */

static void put_halfspace(pir_bytes *bytes, pir_halfspace plane) {
    const double number[4] = {plane.normal.x, plane.normal.y, plane.normal.z, plane.offset};
    memcpy(bytes->data + bytes->used, number, sizeof number);
    bytes->used += sizeof number;
}

static bool add_planes(pir_maker *maker, uint32_t slice) {
    const pir_pairing *pairing = pir_sum_pairing(maker->sum);
    const pir_polytope *p = pairing->p, *q = pairing->q;
    pir_bytes *bytes = &maker->unit.data[PIR_UNIT_SECTION_PLANES];
    uint32_t count = p->facet_count + q->facet_count + pairing->crossings.count;
    if (!pir_bytes_reserve(bytes, &maker->plan->allocator,
                           (size_t)count * pir_unit_section_element[PIR_UNIT_SECTION_PLANES]))
        return false;
    pir_halfspaces of = pir_halfspaces_of(p, q, &pir_sum_exact_rotation(maker->sum)->r);
    for (uint32_t f = 0; f < p->facet_count; f++)
        put_halfspace(bytes, pir_halfspace_fv(&of, f, pairing->fv[f]));
    for (uint32_t g = 0; g < q->facet_count; g++)
        put_halfspace(bytes, pir_halfspace_vf(&of, g, pairing->vf[g]));
    for (uint32_t e = 0; e < p->edge_count; e++)
        for (uint32_t at = pir_crossing_first(pairing, e); at != PIR_NO_CROSSING; at = pir_crossing_next(pairing, at))
            put_halfspace(bytes, pir_halfspace_ee(&of, e, pir_crossing_half(pairing, at), pairing->fv));
    maker->unit.count[PIR_UNIT_SECTION_PLANES][slice] = count;
    return true;
}

static pir_status add_vertices(pir_maker *maker, uint32_t slice) {
    pir_mesh *mesh;
    pir_status status = pir_sum_mesh(maker->sum, PIR_DOUBLE, &mesh);
    if (status != PIR_OK)
        return status;
    pir_bytes *bytes = &maker->unit.data[PIR_UNIT_SECTION_VERTICES];
    size_t size = (size_t)pir_mesh_vertex_count(mesh) * pir_unit_section_element[PIR_UNIT_SECTION_VERTICES];
    if (pir_bytes_reserve(bytes, &maker->plan->allocator, size)) {
        memcpy(bytes->data + bytes->used, pir_mesh_vertices(mesh), size);
        bytes->used += size;
        maker->unit.count[PIR_UNIT_SECTION_VERTICES][slice] = pir_mesh_vertex_count(mesh);
    } else {
        status = PIR_ERR_MEMORY;
    }
    pir_mesh_destroy(mesh);
    return status;
}

static pir_status add_slice(pir_maker *maker, uint32_t slice) {
    const pir_plan *plan = maker->plan;
    pir_bytes *records = &maker->unit.data[PIR_UNIT_SECTION_RECORDS];
    size_t before = records->used;
    if (!pir_recorder_write(&maker->recorder, slice % plan->slices_per_key == 0, records))
        return PIR_ERR_MEMORY;
    if (records->used - before > UINT32_MAX)
        return PIR_ERR_LIMIT;
    maker->unit.count[PIR_UNIT_SECTION_RECORDS][slice] = (uint32_t)(records->used - before);
    if (plan->planes && !add_planes(maker, slice))
        return PIR_ERR_MEMORY;
    return plan->vertices ? add_vertices(maker, slice) : PIR_OK;
}

pir_status pir_maker_make(pir_maker *maker, uint64_t number, uint32_t most) {
    const pir_plan *plan = maker->plan;
    uint64_t first = pir_plan_first(plan, number);
    uint32_t count = pir_plan_count(plan, number);
    maker->unit.number = number;
    maker->unit.slices = count < most ? count : most;
    for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++)
        maker->unit.data[s].used = 0;
    pir_status status = begin(maker, number / plan->units_per_pair, pir_grid_rotation(plan->grid, first));
    for (uint32_t i = 0; status == PIR_OK && i < maker->unit.slices; i++) {
        if (i > 0)
            status = pir_sum_rotate(maker->sum, pir_grid_rotation(plan->grid, first + i), PIR_METHOD_AUTO);
        if (status == PIR_OK)
            status = add_slice(maker, i);
    }
    if (status == PIR_OK)
        pir_unit_seal(&maker->unit);
    else
        forget_pair(maker);
    return status;
}
