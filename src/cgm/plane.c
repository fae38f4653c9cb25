/* SPDX-License-Identifier: MIT */
/*
 * Support planes. In the direction n of a vertex the vertices that any face beside it carries are extreme, so their sum
 * x is on the plane n·y = n·x.
 */
#include <pirouette/exact.h>

#include "cgm/place.h"
#include "cgm/sides.h"

void pir_cgm_vertex_plane(const pir_cgm *cgm, uint32_t vertex, pir_vec3 *ret_normal, double *ret_offset) {
    const struct pir_cgm_vertex *v = &cgm->vertex[vertex];
    *ret_normal = v->point.unit;
    *ret_offset = pir_vec_dot(v->point.unit, pir_cgm_place_near(cgm, cgm->half[v->out].face));
}

pir_status pir_cgm_vertex_plane_exact(const pir_cgm *cgm, uint32_t vertex, mpq_t ret_plane[4]) {
    if (!cgm || vertex >= pir_cgm_vertices(cgm))
        return PIR_ERR_ARGUMENT;
    const pir_allocator *a = &cgm->allocator;
    struct pir_cgm_sides sides;
    struct pir_cgm_places places;
    if (!pir_cgm_sides_init(&sides, a, cgm, cgm))
        return PIR_ERR_MEMORY;
    if (!pir_cgm_places_init(&places, cgm)) {
        pir_cgm_sides_finish(&sides, a);
        return PIR_ERR_MEMORY;
    }
    uint32_t count = 4 * places.stride + 2 * pir_cgm_point_limbs(cgm) + 4;
    pir_limbs room = {PIR_NEW(a, mp_limb_t, count), 0, count};
    if (room.base) {
        const struct pir_cgm_vertex *v = &cgm->vertex[vertex];
        mp_limb_t one_limb = 1;
        pir_scale whole = {{&one_limb, 1, 0}, {&one_limb, 1, 0}};
        pir_int3 n = pir_cgm_point_exact(cgm, &v->point, &sides.scratch), x = pir_int3_take(&room, places.stride);
        pir_cgm_place_exact(&places, cgm->half[v->out].face, &x);
        pir_int offset = pir_limbs_take(&room, places.stride + pir_cgm_point_limbs(cgm) + 2);
        pir_int3_dot(&offset, &n, &x, &sides.scratch);
        for (int k = 0; k < 3; k++)
            pir_scale_to_rational(ret_plane[k], &n.c[k], &whole);
        pir_scale_to_rational(ret_plane[3], &offset, &places.scale);
    }
    bool done = room.base != NULL;
    PIR_FREE(a, room.base, count);
    pir_cgm_places_finish(&places);
    pir_cgm_sides_finish(&sides, a);
    return done ? PIR_OK : PIR_ERR_MEMORY;
}
