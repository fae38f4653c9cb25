/* SPDX-License-Identifier: MIT */
/*
 * The overlay of two maps: the map of the Minkowski sum. Six times, for each face of the cube: merge the two rims, walk
 * a's edges through b's faces, put the pieces together.
 */
#include "cgm/overlay/overlay_join.h"
#include "cgm/overlay/overlay_walk.h"

/* --- rims --- */

/* Adds the vertices of one side but for its last corner, in order; *va and *vb go on to that corner. */
static bool merge_side(struct pir_overlay *o, uint32_t map, uint32_t side, uint32_t *va, uint32_t *vb) {
    const pir_cgm *a = o->a, *b = o->b;
    uint32_t line = pir_side_line(map, side), i = *va, j = *vb;
    uint32_t a_end = a->vertex_start[map] + a->rim[map], b_end = b->vertex_start[map] + b->rim[map];
    do {
        // the corner first: it is in both
        bool more_a = i < a_end && (i == *va || a->vertex[i].place == PIR_CGM_EDGE);
        bool more_b = j < b_end && (j == *vb || b->vertex[j].place == PIR_CGM_EDGE);
        if (!more_a && !more_b)
            break;
        int order = !more_b ? 1 : !more_a ? -1 : 0;
        if (more_a && more_b && i != *va)
            order = pir_cgm_ahead(&o->sides, a, line, a, &a->vertex[i].point, b, &b->vertex[j].point);
        uint32_t v = order <= 0 ? pir_overlay_vertex_of_b(o, j)
                                : pir_overlay_add_vertex(o, map, &a->vertex[i].point, PIR_CGM_EDGE);
        if (v == PIR_CGM_NONE)
            return false;
        if (order >= 0) {
            o->joint[v].a = i;
            o->a_vertex[i] = v;
            o->where[i] = (struct pir_location){PIR_AT_VERTEX, j};
            if (order > 0) {
                // alone it is within the side that the last vertex of b starts
                uint32_t on = b->vertex[j - 1].out;
                o->where[i] = (struct pir_location){PIR_ON_EDGE, on};
                if (!pir_overlay_add_record(o, v, on >> 1))
                    return false;
            }
            i++;
        }
        j += order <= 0;
    } while (true);
    *va = i;
    *vb = j;
    return true;
}

static bool merge_rims(struct pir_overlay *o, uint32_t map) {
    pir_cgm *r = o->result;
    const pir_cgm *a = o->a, *b = o->b;
    uint32_t first = o->vertices, i = a->vertex_start[map], j = b->vertex_start[map];
    for (uint32_t side = 0; side < 4; side++) {
        r->corner[map][pir_side_corner(side)] = o->vertices;
        if (!merge_side(o, map, side, &i, &j))
            return false;
    }
    // the sides between them, each part of one side of a and of one of b
    uint32_t n = r->rim[map] = o->vertices - first, side = PIR_CGM_NONE, half_a = 0, half_b = 0;
    for (uint32_t k = 0; k < n; k++) {
        uint32_t v = first + k, half = 2 * o->edges;
        struct pir_joint *joint = &o->joint[v];
        side += r->vertex[v].place == PIR_CGM_CORNER;
        half_a = joint->a != PIR_CGM_NONE ? a->vertex[joint->a].out : half_a;
        half_b = joint->b != PIR_CGM_NONE ? b->vertex[joint->b].out : half_b;
        struct pir_overlay_run *run = &o->run[half_a >> 1];
        if (joint->a != PIR_CGM_NONE)
            *run = (struct pir_overlay_run){o->edges, o->edges, half_a};
        else
            joint->a_mid = half;
        run->last = o->edges;
        if (joint->b != PIR_CGM_NONE)
            o->first_cover[half_b >> 1] = half;
        else
            o->record[joint->record].cover = half;
        r->vertex[v].out = half;
        if (pir_overlay_add_edge(o, v, k + 1 == n ? first : v + 1, pir_side_line(map, side),
                                 (struct pir_overlay_seam){half_a, half_b, PIR_CGM_NONE}) == PIR_CGM_NONE)
            return false;
    }
    return true;
}

/* --- all of it --- */

pir_status pir_cgm_overlay(const pir_cgm *a, const pir_cgm *b, pir_cgm **ret_cgm) {
    if (!a || !b || !ret_cgm)
        return PIR_ERR_ARGUMENT;
    struct pir_overlay overlay;
    bool done = pir_overlay_init(&overlay, a, b);
    for (uint32_t map = 0; map < 6 && done; map++)
        done = merge_rims(&overlay, map) && pir_overlay_walk(&overlay, map) && pir_overlay_join(&overlay, map);
    done = done && pir_overlay_attribute(&overlay);
    if (done) {
        pir_cgm_flag_vertices(overlay.result);
        pir_cgm_trim(overlay.result);
        overlay.result->by_filter = overlay.sides.by_filter;
        overlay.result->by_exact = overlay.sides.by_exact;
        *ret_cgm = overlay.result;
    } else {
        pir_cgm_release(overlay.result);
    }
    pir_overlay_finish(&overlay);
    return done ? PIR_OK : PIR_ERR_MEMORY;
}
