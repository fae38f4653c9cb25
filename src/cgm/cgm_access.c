/* SPDX-License-Identifier: MIT */
/* The public questions about a map. */
#include "cgm/build.h"

uint32_t pir_cgm_source_count(const pir_cgm *cgm) {
    return cgm->source_count;
}

const pir_polytope *pir_cgm_source(const pir_cgm *cgm, uint32_t source) {
    return cgm->source[source].polytope;
}

pir_quat pir_cgm_source_rotation(const pir_cgm *cgm, uint32_t source) {
    const pir_rotation *rotation = cgm->source[source].rotation;
    return rotation ? rotation->given : (pir_quat){0, 0, 0, 1};
}

pir_cgm_counts pir_cgm_map_counts(const pir_cgm *cgm, uint32_t map) {
    return (pir_cgm_counts){cgm->vertex_start[map + 1] - cgm->vertex_start[map],
                            2 * (cgm->edge_start[map + 1] - cgm->edge_start[map]),
                            cgm->face_start[map + 1] - cgm->face_start[map]};
}

pir_cgm_counts pir_cgm_total_counts(const pir_cgm *cgm) {
    return (pir_cgm_counts){pir_cgm_vertices(cgm), 2 * pir_cgm_edges(cgm), pir_cgm_faces(cgm)};
}

pir_cgm_counts pir_cgm_map_first(const pir_cgm *cgm, uint32_t map) {
    return (pir_cgm_counts){cgm->vertex_start[map], 2 * cgm->edge_start[map], cgm->face_start[map]};
}

const char *pir_cgm_map_name(uint32_t map) {
    static const char *const names[6] = {"-x", "-y", "-z", "+x", "+y", "+z"};
    return map < 6 ? names[map] : "";
}

static double coordinate(pir_vec3 v, uint32_t axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

pir_cgm_vertex_info pir_cgm_vertex_at(const pir_cgm *cgm, uint32_t vertex) {
    const struct pir_cgm_vertex *v = &cgm->vertex[vertex];
    double depth = fabs(coordinate(v->point.unit, pir_map_axis(v->map)));
    return (pir_cgm_vertex_info){.map = v->map,
                                 .place = (pir_cgm_place)v->place,
                                 .real = v->real,
                                 .direction = v->point.unit,
                                 .x = coordinate(v->point.unit, pir_map_plane_axis(v->map, 0)) / depth,
                                 .y = coordinate(v->point.unit, pir_map_plane_axis(v->map, 1)) / depth,
                                 .half = v->out,
                                 .copy = v->copy};
}

pir_cgm_halfedge_info pir_cgm_halfedge_at(const pir_cgm *cgm, uint32_t halfedge) {
    const struct pir_cgm_half *h = &cgm->half[halfedge];
    bool side = pir_cgm_is_side(cgm, halfedge, cgm->vertex[h->origin].map);
    return (pir_cgm_halfedge_info){.origin = h->origin,
                                   .target = pir_cgm_target(cgm, halfedge),
                                   .twin = halfedge ^ 1,
                                   .next = h->next,
                                   .face = h->face,
                                   .beyond = side ? pir_cgm_beyond(cgm, halfedge) : PIR_CGM_NONE,
                                   .real = pir_cgm_edge_is_real(cgm, halfedge >> 1)};
}

pir_cgm_face_info pir_cgm_face_at(const pir_cgm *cgm, uint32_t face) {
    uint32_t half = cgm->face_half[face], map = cgm->vertex[cgm->half[half].origin].map;
    return (pir_cgm_face_info){.map = map, .half = half, .outer = pir_cgm_is_outer(cgm, face, map)};
}

uint32_t pir_cgm_corner(const pir_cgm *cgm, uint32_t map, uint32_t corner) {
    return cgm->corner[map][corner];
}

uint32_t pir_cgm_clockwise_after(const pir_cgm *cgm, uint32_t halfedge) {
    return pir_cgm_clockwise(cgm, halfedge);
}

uint32_t pir_cgm_vertex_facet(const pir_cgm *cgm, uint32_t vertex, uint32_t source) {
    return cgm->vertex_facet[(size_t)vertex * cgm->source_count + source];
}

uint32_t pir_cgm_halfedge_edge(const pir_cgm *cgm, uint32_t halfedge, uint32_t source) {
    const pir_polytope *p = cgm->source[source].polytope;
    uint32_t h = cgm->edge_half[(size_t)(halfedge >> 1) * cgm->source_count + source];
    // a segment has one edge; the second is hidden
    return h == PIR_CGM_NONE || p->artificial ? h == PIR_CGM_NONE ? h : 0 : p->edge[h];
}

uint32_t pir_cgm_face_vertex(const pir_cgm *cgm, uint32_t face, uint32_t source) {
    return pir_cgm_source_vertex(cgm, face, source);
}

pir_cgm_statistics pir_cgm_get_statistics(const pir_cgm *cgm) {
    size_t k = cgm->source_count, vertices = pir_cgm_vertices(cgm), edges = pir_cgm_edges(cgm),
           faces = pir_cgm_faces(cgm);
    size_t bytes = sizeof *cgm + cgm->vertex_capacity * sizeof *cgm->vertex;
    bytes += cgm->half_capacity * 2 * sizeof *cgm->half + cgm->line_capacity * sizeof *cgm->edge_line;
    bytes += cgm->face_capacity * sizeof *cgm->face_half + (vertices + edges + faces) * k * sizeof(uint32_t);
    bytes += cgm->line_count * sizeof *cgm->line + k * sizeof *cgm->source;
    for (size_t s = 0; s < k; s++)
        bytes += cgm->source[s].rotation ? sizeof(struct pir_cgm_turn) : 0;
    return (pir_cgm_statistics){cgm->by_filter, cgm->by_exact, bytes};
}
