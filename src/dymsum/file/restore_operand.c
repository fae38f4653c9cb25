/* SPDX-License-Identifier: MIT */
/*
 * Operands out of the bytes of a sum. Every count is compared with the bytes that are left before memory is allocated.
 * The polytope is made anew as the exact hull of the vertices, and the facets in the file must be those of the hull, in
 * any order.
 */
#include <string.h>

#include "base/memory.h"
#include "base/report.h"
#include "dymsum/file/sum_source.h"
#include "polytope/hull/hull.h"
#include "polytope/scale.h"

/* One operand, as the file describes it. */
struct operand {
    uint32_t dimension, vertices, facets, width, corners;
    pir_scale_room room;
    pir_scale scale;
    pir_vectors points;
    uint32_t *source;
    pir_loops loops;
};

static void finish_operand(struct operand *operand, const pir_allocator *a) {
    pir_vectors_finish(&operand->points, a);
    PIR_FREE(a, operand->source, operand->vertices);
    if (operand->loops.start)
        pir_loops_finish(&operand->loops, a, operand->corners);
}

static pir_status get_vertices(pir_source *from, struct operand *operand) {
    if (!pir_source_has(from, operand->vertices, 3 * ((size_t)operand->width + 1) + 4))
        return pir_source_broken(from, "truncated, or a number of vertices that lies");
    operand->source = PIR_NEW(from->allocator, uint32_t, operand->vertices);
    if (!operand->source ||
        !pir_vectors_init(&operand->points, from->allocator, operand->vertices, pir_limbs_for_bytes(operand->width)))
        return pir_source_no_memory(from);
    for (uint32_t v = 0; v < operand->vertices; v++) {
        pir_int3 x = pir_vectors_at(&operand->points, v);
        for (int k = 0; k < 3; k++) {
            uint8_t negative = from->data[from->at++];
            if (negative > 1)
                return pir_source_broken(from, "a coordinate's sign is neither 0 nor 1");
            pir_source_magnitude(from, operand->width, &x.c[k]);
            if (negative)
                pir_int_negate(&x.c[k]);
        }
        pir_vectors_put(&operand->points, v, &x);
    }
    for (uint32_t v = 0; v < operand->vertices; v++)
        operand->source[v] = pir_source_u32(from);
    return PIR_OK;
}

static pir_status get_facets(pir_source *from, struct operand *operand) {
    if (!pir_source_has(from, operand->facets, 4))
        return pir_source_broken(from, "truncated, or a number of facets that lies");
    // the sizes first, so that the corners are counted before room for them is made
    size_t sizes_at = from->at;
    uint64_t corners = 0;
    for (uint32_t f = 0; f < operand->facets; f++) {
        uint32_t size = pir_source_u32(from);
        if (size < 3)
            return pir_source_broken(from, "a facet of fewer than three corners");
        corners += size;
    }
    if (!pir_source_has(from, corners, 4))
        return pir_source_broken(from, "truncated, or numbers of corners that lie");
    operand->corners = (uint32_t)corners;
    if (!pir_loops_init(&operand->loops, from->allocator, operand->facets, operand->corners))
        return pir_source_no_memory(from);
    size_t corners_at = from->at;
    from->at = sizes_at;
    operand->loops.start[0] = 0;
    for (uint32_t f = 0; f < operand->facets; f++)
        operand->loops.start[f + 1] = operand->loops.start[f] + pir_source_u32(from);
    from->at = corners_at;
    for (uint32_t i = 0; i < operand->corners; i++) {
        operand->loops.corner[i] = pir_source_u32(from);
        if (operand->loops.corner[i] >= operand->vertices)
            return pir_source_broken(from, "a corner that is no vertex");
    }
    return PIR_OK;
}

/* Whether the facets that were read are those of the hull, each from any corner on, in any order. */
static pir_status compare_facets(const pir_source *from, const struct operand *operand, const pir_hull *hull) {
    const pir_loops *own = &operand->loops;
    bool counts = hull->dimension == (int)operand->dimension && hull->vertex_count == operand->vertices &&
                  own->count == hull->facets.count && pir_loops_corners(own) == pir_loops_corners(&hull->facets);
    if (!counts)
        return pir_source_broken(from, "the vertices are not the corners of a body with these facets");
    pir_loops sorted;
    if (!pir_loops_init(&sorted, from->allocator, own->count, operand->corners))
        return pir_source_no_memory(from);
    memcpy(sorted.start, own->start, ((size_t)own->count + 1) * sizeof *own->start);
    memcpy(sorted.corner, own->corner, operand->corners * sizeof *own->corner);
    pir_status status = PIR_OK;
    if (!pir_loops_canonicalise(&sorted, NULL, from->allocator))
        status = pir_source_no_memory(from);
    else if (memcmp(sorted.start, hull->facets.start, ((size_t)own->count + 1) * sizeof *own->start) != 0 ||
             memcmp(sorted.corner, hull->facets.corner, operand->corners * sizeof *own->corner) != 0)
        status = pir_source_broken(from, "the facets are not those of the vertices' hull");
    pir_loops_finish(&sorted, from->allocator, operand->corners);
    return status;
}

static pir_status build_polytope(const pir_source *from, const struct operand *operand, pir_polytope **ret) {
    pir_hull hull;
    pir_status status = pir_hull_make(&operand->points, NULL, from->allocator, &hull);
    if (status != PIR_OK)
        return pir_fail(from->report, status, "sum: %s: %s", from->part, pir_status_text(status));
    if (hull.dimension >= 2)
        status = compare_facets(from, operand, &hull);
    else if (hull.dimension != (int)operand->dimension || hull.vertex_count != operand->vertices || operand->facets > 0)
        status = pir_source_broken(from, "the vertices are not those of a segment or point");
    pir_polytope *polytope = NULL;
    if (status == PIR_OK) {
        pir_polytope_parts parts = {&operand->points, &operand->scale,   NULL,           hull.dimension,
                                    hull.vertices,    hull.vertex_count, &operand->loops};
        if (pir_polytope_build(&parts, from->allocator, &polytope) != PIR_OK)
            status = pir_source_no_memory(from);
    }
    pir_hull_finish(&hull, from->allocator);
    for (uint32_t v = 0; status == PIR_OK && v < polytope->vertex_count; v++) {
        polytope->source[v] = operand->source[v];
        if (!pir_vec_is_finite(polytope->vertex[v]))
            status = pir_source_broken(from, "a coordinate beyond the doubles");
    }
    if (status == PIR_OK)
        *ret = polytope;
    else
        pir_polytope_release(polytope);
    return status;
}

static pir_status get_operand(pir_source *from, struct operand *operand, pir_polytope **ret_made,
                              pir_polytope **ret_now) {
    if (!pir_source_has(from, 4, 4))
        return pir_source_broken(from, "truncated");
    operand->dimension = pir_source_u32(from);
    uint32_t vertices = pir_source_u32(from);
    operand->facets = pir_source_u32(from);
    operand->width = pir_source_u32(from);
    if (operand->dimension > 3 || vertices == 0 || vertices >= (uint32_t)1 << 30 || operand->width == 0 ||
        operand->width > PIR_SUM_COORDINATE_MAX)
        return pir_source_broken(from, "a dimension or count out of range");
    operand->vertices = vertices;
    pir_status status = pir_source_scale(from, &operand->room, &operand->scale);
    if (status == PIR_OK)
        status = get_vertices(from, operand);
    if (status == PIR_OK)
        status = get_facets(from, operand);
    pir_polytope *made = NULL, *now = NULL;
    if (status == PIR_OK)
        status = build_polytope(from, operand, &made);
    if (status == PIR_OK && !pir_source_has(from, 1, 4))
        status = pir_source_broken(from, "truncated");
    uint32_t scaled = status == PIR_OK ? pir_source_u32(from) : 0;
    if (scaled > 1)
        status = pir_source_broken(from, "neither scaled nor not");
    pir_scale scale;
    if (status == PIR_OK && scaled)
        status = pir_source_scale(from, &operand->room, &scale);
    if (status == PIR_OK) {
        pir_status built = PIR_OK;
        if (scaled)
            built = pir_polytope_rescale(made, &scale, &now);
        else
            now = pir_polytope_retain(made);
        if (built != PIR_OK)
            status = built == PIR_ERR_MEMORY ? pir_source_no_memory(from)
                                             : pir_source_broken(from, "a scale beyond the doubles");
    }
    if (status == PIR_OK) {
        *ret_made = made;
        *ret_now = now;
    } else {
        pir_polytope_release(made);
    }
    return status;
}

pir_status pir_source_operand(pir_source *from, pir_polytope **ret_made, pir_polytope **ret_now) {
    struct operand *operand = PIR_ZEROED(from->allocator, struct operand, 1);
    if (!operand)
        return pir_source_no_memory(from);
    pir_status status = get_operand(from, operand, ret_made, ret_now);
    finish_operand(operand, from->allocator);
    PIR_FREE(from->allocator, operand, 1);
    return status;
}
