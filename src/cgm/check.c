/* SPDX-License-Identifier: MIT */
/*
 * The whole-structure check of a map. It proves three things. The six maps are planar, their inner faces are convex,
 * and they are joined along the cube's edges. At every corner of every face the vertices that the face carries are
 * extreme; so each face lies in its cell, and the faces, which fill the cube, are the overlay of the sources' Gaussian
 * maps cut by the cube. Each vertex names the facets whose normal it is.
 */
#include "cgm/build.h"
#include "cgm/sides.h"

struct check {
    const pir_cgm *cgm;
    struct pir_cgm_sides sides;
};

static int side(struct check *check, uint32_t half, uint32_t vertex) {
    const pir_cgm *cgm = check->cgm;
    return pir_cgm_side(&check->sides, cgm, pir_cgm_half_line(cgm, half), cgm, &cgm->vertex[vertex].point);
}

/* Whether a feature of a source is one, or absent where that may be. */
static bool is_feature(uint32_t index, uint32_t count, bool may_be_absent) {
    return index < count || (index == PIR_CGM_NONE && may_be_absent);
}

/* Whether `copy` is a vertex, one on the rim of its map where that is asked for. */
static bool is_copy(const pir_cgm *cgm, uint32_t copy, bool on_rim) {
    if (copy >= pir_cgm_vertices(cgm) || cgm->vertex[copy].map >= 6)
        return false;
    uint32_t map = cgm->vertex[copy].map;
    return !on_rim || copy - cgm->vertex_start[map] < cgm->rim[map];
}

/* Whether every index is in range, so that the checks that follow may use it. */
static bool indices_are_valid(const pir_cgm *cgm, uint32_t map) {
    uint32_t k = cgm->source_count;
    for (uint32_t s = 0; s < k; s++) {
        const pir_polytope *p = cgm->source[s].polytope;
        for (uint32_t v = cgm->vertex_start[map]; v < cgm->vertex_start[map + 1]; v++)
            if (!is_feature(cgm->vertex_facet[(size_t)v * k + s], p->facet_count, true))
                return false;
        for (uint32_t e = cgm->edge_start[map]; e < cgm->edge_start[map + 1]; e++)
            if (!is_feature(cgm->edge_half[(size_t)e * k + s], p->half_count, true))
                return false;
        for (uint32_t f = cgm->face_start[map]; f < cgm->face_start[map + 1]; f++)
            if (!is_feature(cgm->face_vertex[(size_t)f * k + s], pir_cgm_is_outer(cgm, f, map) ? 0 : p->vertex_count,
                            pir_cgm_is_outer(cgm, f, map)))
                return false;
    }
    for (uint32_t e = cgm->edge_start[map]; e < cgm->edge_start[map + 1]; e++)
        if (cgm->edge_line[e] >> 1 >= cgm->line_count)
            return false;
    for (uint32_t v = cgm->vertex_start[map]; v < cgm->vertex_start[map + 1]; v++)
        if (cgm->vertex[v].map != map || cgm->vertex[v].out >= 2 * pir_cgm_edges(cgm) ||
            !is_copy(cgm, cgm->vertex[v].copy, v - cgm->vertex_start[map] < cgm->rim[map]))
            return false;
    for (uint32_t f = cgm->face_start[map]; f < cgm->face_start[map + 1]; f++)
        if (cgm->face_half[f] >= 2 * pir_cgm_edges(cgm))
            return false;
    return true;
}

static bool links_are_valid(const pir_cgm *cgm, uint32_t map) {
    uint32_t first = 2 * cgm->edge_start[map], end = 2 * cgm->edge_start[map + 1];
    for (uint32_t h = first; h < end; h++) {
        const struct pir_cgm_half *half = &cgm->half[h], *next = &cgm->half[half->next];
        if (half->next < first || half->next >= end || next->origin != pir_cgm_target(cgm, h) ||
            next->face != half->face)
            return false;
        if (half->origin < cgm->vertex_start[map] || half->origin >= cgm->vertex_start[map + 1])
            return false;
        if (half->face < cgm->face_start[map] || half->face >= cgm->face_start[map + 1])
            return false;
    }
    for (uint32_t f = cgm->face_start[map]; f < cgm->face_start[map + 1]; f++)
        if (cgm->half[cgm->face_half[f]].face != f)
            return false;
    for (uint32_t v = cgm->vertex_start[map]; v < cgm->vertex_start[map + 1]; v++)
        if (cgm->half[cgm->vertex[v].out].origin != v)
            return false;
    // connected: Euler's formula, and all halfedges of a face or around a vertex on one cycle
    uint32_t in_faces = 0, around_vertices = 0;
    for (uint32_t f = cgm->face_start[map]; f < cgm->face_start[map + 1]; f++)
        for (uint32_t start = cgm->face_half[f], h = start; in_faces++, (h = cgm->half[h].next) != start;)
            ;
    for (uint32_t v = cgm->vertex_start[map]; v < cgm->vertex_start[map + 1]; v++)
        for (uint32_t start = cgm->vertex[v].out, h = start;
             around_vertices++, (h = pir_cgm_clockwise(cgm, h)) != start;)
            ;
    pir_cgm_counts counts = pir_cgm_map_counts(cgm, map);
    return in_faces == end - first && around_vertices == end - first &&
           counts.vertices + counts.faces == counts.halfedges / 2 + 2;
}

/* Whether two directions are equal exactly. */
static bool same_direction(struct check *check, uint32_t v, uint32_t w) {
    pir_limbs *scratch = &check->sides.scratch;
    uint32_t mark = scratch->used;
    pir_int3 x = pir_cgm_point_exact(check->cgm, &check->cgm->vertex[v].point, scratch);
    pir_int3 y = pir_cgm_point_exact(check->cgm, &check->cgm->vertex[w].point, scratch);
    uint32_t limbs = pir_int3_length(&x) + pir_int3_length(&y) + 1;
    pir_int3 cross = pir_int3_take(scratch, limbs);
    pir_int3_cross(&cross, &x, &y, scratch);
    pir_int dot = pir_limbs_take(scratch, limbs);
    pir_int3_dot(&dot, &x, &y, scratch);
    scratch->used = mark;
    return pir_int3_is_zero(&cross) && dot.size > 0;
}

static bool rim_is_valid(struct check *check, uint32_t map) {
    const pir_cgm *cgm = check->cgm;
    uint32_t n = cgm->rim[map], corners = 0;
    for (uint32_t i = 0; i < n; i++) {
        uint32_t v = cgm->vertex_start[map] + i, h = 2 * (cgm->edge_start[map] + i), copies = 1;
        const struct pir_cgm_vertex *vertex = &cgm->vertex[v];
        if (vertex->out != h || cgm->half[h].origin != v || !pir_cgm_is_outer(cgm, cgm->half[h ^ 1].face, map))
            return false;
        if (vertex->place == PIR_CGM_CORNER && (corners == 4 || cgm->corner[map][pir_side_corner(corners++)] != v))
            return false;
        if (corners == 0 || pir_cgm_half_line(cgm, h) != pir_side_line(map, corners - 1))
            return false;
        for (uint32_t copy = vertex->copy; copy != v && copies < 4; copy = cgm->vertex[copy].copy, copies++)
            if (!same_direction(check, v, copy) || cgm->vertex[copy].place != vertex->place)
                return false;
        if (copies != (vertex->place == PIR_CGM_CORNER ? 3u : 2u) ||
            cgm->vertex[vertex->copy].map != pir_side_neighbor(map, corners - 1))
            return false;
        uint32_t beyond = pir_cgm_beyond(cgm, h);
        if (pir_cgm_beyond(cgm, beyond) != h ||
            pir_cgm_edge_is_real(cgm, h >> 1) != pir_cgm_edge_is_real(cgm, beyond >> 1))
            return false;
    }
    for (uint32_t v = cgm->vertex_start[map] + n; v < cgm->vertex_start[map + 1]; v++)
        if (cgm->vertex[v].place != PIR_CGM_INTERIOR || cgm->vertex[v].copy != v)
            return false;
    return corners == 4;
}

/* Every edge lies along its line, and every inner face turns left at its corners, or goes straight on along the rim. */
static bool faces_are_convex(struct check *check, uint32_t map) {
    const pir_cgm *cgm = check->cgm;
    for (uint32_t h = 2 * cgm->edge_start[map]; h < 2 * cgm->edge_start[map + 1]; h++) {
        uint32_t from = cgm->half[h].origin, to = pir_cgm_target(cgm, h), line = pir_cgm_half_line(cgm, h);
        if (side(check, h, from) != 0 || side(check, h, to) != 0 ||
            pir_cgm_ahead(&check->sides, cgm, line, cgm, &cgm->vertex[from].point, cgm, &cgm->vertex[to].point) != 1)
            return false;
        if (pir_cgm_is_outer(cgm, cgm->half[h].face, map))
            continue;
        int turn = side(check, h, pir_cgm_target(cgm, cgm->half[h].next));
        if (turn < 0 || (turn == 0 && cgm->vertex[to].place != PIR_CGM_EDGE))
            return false;
    }
    return true;
}

/* Whether vertex p of source s is extreme in the direction of vertex v. */
static bool is_extreme(struct check *check, uint32_t s, uint32_t p, uint32_t v) {
    const pir_cgm *cgm = check->cgm;
    const struct pir_cgm_source *source = &cgm->source[s];
    const pir_polytope *polytope = source->polytope;
    for (uint32_t h = polytope->ring_start[p]; h < polytope->ring_start[p + 1]; h++) {
        uint32_t e = polytope->edge[h], line = 2 * (source->line_start + e) + (polytope->edge_half[e] != h);
        if (pir_cgm_side(&check->sides, cgm, line, cgm, &cgm->vertex[v].point) > 0)
            return false;
    }
    return true;
}

/* Whether `half` of a source leads from vertex `right` to `left`, or is absent where both are one. */
static bool is_arc(const struct pir_cgm_source *source, uint32_t half, uint32_t left, uint32_t right) {
    if (half == PIR_CGM_NONE)
        return left == right;
    return source->polytope->target[half] == left && source->polytope->origin[half] == right;
}

static bool cells_are_valid(struct check *check, uint32_t map) {
    const pir_cgm *cgm = check->cgm;
    for (uint32_t h = 2 * cgm->edge_start[map]; h < 2 * cgm->edge_start[map + 1]; h++) {
        uint32_t face = cgm->half[h].face, beyond = cgm->half[h ^ 1].face;
        if (pir_cgm_is_outer(cgm, face, map))
            continue;
        for (uint32_t s = 0; s < cgm->source_count; s++)
            if (!is_extreme(check, s, pir_cgm_source_vertex(cgm, face, s), cgm->half[h].origin))
                return false;
        // what a source has there is the arc between the cells on both sides, or none where that is one cell
        if (pir_cgm_is_outer(cgm, beyond, map))
            beyond = cgm->half[pir_cgm_beyond(cgm, h)].face;
        for (uint32_t s = 0; s < cgm->source_count; s++)
            if (!is_arc(&cgm->source[s], pir_cgm_source_half(cgm, h, s), pir_cgm_source_vertex(cgm, face, s),
                        pir_cgm_source_vertex(cgm, beyond, s)))
                return false;
    }
    return true;
}

/* Whether the direction of vertex v is the normal of facet f of source s. */
static bool is_normal(struct check *check, uint32_t s, uint32_t f, uint32_t v) {
    const struct pir_cgm_source *source = &check->cgm->source[s];
    const pir_polytope *p = source->polytope;
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++)
        if (!is_extreme(check, s, p->origin[p->loop[i]], v))
            return false;
    // a polygon's vertices are extreme on both of its sides: no rounding can hide which
    pir_vec3 n = source->rotation ? pir_mat_apply(&source->rotation->r, p->normal[f]) : p->normal[f];
    return pir_vec_dot(n, check->cgm->vertex[v].point.unit) > 0;
}

/* When all maps and what joins them are valid: every vertex that is a facet's normal says so, of the
   sum and of each source. */
static bool facets_are_valid(struct check *check) {
    const pir_cgm *cgm = check->cgm;
    for (uint32_t v = 0; v < pir_cgm_vertices(cgm); v++) {
        if (cgm->vertex[v].real != pir_cgm_is_facet_of(cgm, v, 0, cgm->source_count))
            return false;
        for (uint32_t s = 0; s < cgm->source_count; s++) {
            uint32_t facet = pir_cgm_vertex_facet(cgm, v, s);
            bool right = pir_cgm_is_facet_of(cgm, v, s, 1) ? facet != PIR_CGM_NONE && is_normal(check, s, facet, v)
                                                           : facet == PIR_CGM_NONE;
            if (!right)
                return false;
        }
    }
    return true;
}

bool pir_cgm_is_valid(const pir_cgm *cgm) {
    struct check check = {.cgm = cgm};
    if (!pir_cgm_sides_init(&check.sides, &cgm->allocator, cgm, cgm))
        return false;
    // each kind of question rests on the answers to those before it, for all maps
    bool valid = true;
    for (uint32_t map = 0; map < 6 && valid; map++)
        valid = indices_are_valid(cgm, map);
    for (uint32_t map = 0; map < 6 && valid; map++)
        valid = links_are_valid(cgm, map);
    for (uint32_t map = 0; map < 6 && valid; map++)
        valid = rim_is_valid(&check, map);
    for (uint32_t map = 0; map < 6 && valid; map++)
        valid = faces_are_convex(&check, map) && cells_are_valid(&check, map);
    valid = valid && facets_are_valid(&check);
    pir_cgm_sides_finish(&check.sides, &cgm->allocator);
    return valid;
}
