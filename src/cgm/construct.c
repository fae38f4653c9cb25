/* SPDX-License-Identifier: MIT */
/*
 * The cubical map of one polytope: the sites and pieces of arcs.h, put together as six planar maps.
 *
 * The order of edges around a facet's normal is that of the facet's sides. On the rim, a map has those of them that
 * lead into it, between its two sides; every other rim vertex has at most one piece in a map, since arcs meet only in
 * normals. A face has the vertex that the arcs beside it name. A face that no arc borders has the vertex of the face
 * beyond the cube edge, which is part of the same cell.
 */
#include "base/sort.h"
#include "cgm/arcs.h"

#include <string.h>

struct construct {
    pir_cgm *cgm;
    struct pir_cgm_arcs arcs;
    uint32_t vertices, edges; /* made so far */
    uint32_t *vertex_of;      /* per site: its vertex in the map being made */
    uint32_t *piece_half;     /* per piece: the halfedge along it */
    uint32_t *spoke;          /* per vertex: the one halfedge off the rim where no facet is */
    uint32_t *own;            /* per edge: the polytope's halfedge that halfedge 2e follows, or PIR_CGM_NONE */
    uint32_t *edge_sites;     /* sites on cube edges, cube edge by cube edge, in its direction */
    uint32_t edge_start[PIR_CUBE_EDGES + 1];
    uint32_t *cover; /* per site on a cube edge: the halfedge whose arc runs from it to the next one, or PIR_CGM_NONE */
    uint32_t first_cover[PIR_CUBE_EDGES]; /* the same from the corner where the cube edge starts */
    uint32_t cube_edge;                   /* being sorted */
    uint32_t *queue;
    uint32_t *before; /* per rim vertex: the rim halfedge that leaves it clockwise */
};

/* --- sites on cube edges --- */

static bool site_before(void *context, uint32_t x, uint32_t y) {
    struct construct *c = context;
    struct pir_cgm_arcs *arcs = &c->arcs;
    uint32_t line = pir_side_line(arcs->edge_map[c->cube_edge], arcs->edge_side[c->cube_edge]);
    return pir_cgm_ahead(&arcs->sides, c->cgm, line, c->cgm, &arcs->site[x].point, c->cgm, &arcs->site[y].point) > 0;
}

static void sort_edge_sites(struct construct *c) {
    const struct pir_cgm_arcs *arcs = &c->arcs;
    memset(c->edge_start, 0, sizeof c->edge_start);
    for (uint32_t i = 8; i < arcs->site_count; i++)
        if (arcs->site[i].place == PIR_CGM_EDGE)
            c->edge_start[arcs->site[i].cube_edge + 1]++;
    for (uint32_t k = 0; k < PIR_CUBE_EDGES; k++)
        c->edge_start[k + 1] += c->edge_start[k];
    uint32_t to[PIR_CUBE_EDGES];
    memcpy(to, c->edge_start, sizeof to);
    for (uint32_t i = 8; i < arcs->site_count; i++)
        if (arcs->site[i].place == PIR_CGM_EDGE)
            c->edge_sites[to[arcs->site[i].cube_edge]++] = i;
    for (uint32_t k = 0; k < PIR_CUBE_EDGES; k++) {
        c->cube_edge = k;
        pir_sort(c->edge_sites + c->edge_start[k], c->edge_start[k + 1] - c->edge_start[k], c->queue, site_before, c);
    }
}

/* Notes which parts of cube edges arcs run along. */
static void cover_cube_edges(struct construct *c) {
    const struct pir_cgm_arcs *arcs = &c->arcs;
    const pir_polytope *p = arcs->polytope;
    memset(c->cover, 0xff, arcs->site_count * sizeof *c->cover);
    memset(c->first_cover, 0xff, sizeof c->first_cover);
    for (uint32_t i = 0; i < arcs->piece_count; i++) {
        const struct pir_arc_piece *piece = &arcs->piece[i];
        if (piece->map != PIR_ALONG_EDGE)
            continue;
        uint32_t half = p->edge_half[piece->edge], start = piece->forward ? piece->from : piece->to;
        half = piece->forward ? half : p->twin[half];
        if (arcs->site[start].place == PIR_CGM_EDGE)
            c->cover[start] = half;
        else
            c->first_cover[piece->cube_edge] = half;
    }
}

/* --- vertices and edges of one map --- */

static uint32_t add_vertex(struct construct *c, uint32_t site, uint32_t map) {
    const struct pir_site *s = &c->arcs.site[site];
    uint32_t v = c->vertices++;
    c->cgm->vertex[v] =
        (struct pir_cgm_vertex){.point = s->point, .out = PIR_CGM_NONE, .place = s->place, .map = (uint8_t)map};
    c->vertex_of[site] = v;
    c->spoke[v] = PIR_CGM_NONE;
    return v;
}

static uint32_t add_edge(struct construct *c, uint32_t from, uint32_t to, uint32_t line, uint32_t own) {
    uint32_t e = c->edges++;
    c->cgm->half[2 * e].origin = from;
    c->cgm->half[2 * e + 1].origin = to;
    c->cgm->edge_line[e] = line;
    c->own[e] = own;
    return 2 * e;
}

/* The vertices of one side but for its last corner, and what arc runs along from each: into `covers`, from
   the first rim vertex on. */
static void add_side_vertices(struct construct *c, uint32_t map, uint32_t side, uint32_t *covers) {
    const struct pir_cgm_arcs *arcs = &c->arcs;
    uint32_t k = arcs->cube_edge[map][side], first = c->cgm->vertex_start[map];
    uint32_t low = c->edge_start[k], n = c->edge_start[k + 1] - low, corner = pir_side_corner(side);
    bool forward = arcs->edge_map[k] == map;
    for (uint32_t i = 0; i <= n; i++) {
        // Position i along the side: the corner, then the sites in the side's order. Reversed, what is ahead of it
        // starts at its end.
        uint32_t site = i == 0 ? pir_cube_corner(map, corner) : c->edge_sites[low + (forward ? i - 1 : n - i)];
        uint32_t v = add_vertex(c, site, map), cover;
        if (forward)
            cover = i == 0 ? c->first_cover[k] : c->cover[site];
        else
            cover = i == n ? c->first_cover[k] : c->cover[c->edge_sites[low + n - i - 1]];
        covers[v - first] = forward || cover == PIR_CGM_NONE ? cover : arcs->polytope->twin[cover];
        if (i == 0)
            c->cgm->corner[map][corner] = v;
    }
}

static void add_rim(struct construct *c, uint32_t map) {
    pir_cgm *cgm = c->cgm;
    uint32_t first = cgm->vertex_start[map], at = first, *covers = c->queue;
    for (uint32_t side = 0; side < 4; side++)
        add_side_vertices(c, map, side, covers);
    uint32_t n = cgm->rim[map] = c->vertices - first;
    for (uint32_t side = 0; side < 4; side++) {
        uint32_t line = pir_side_line(map, side);
        do {
            uint32_t next = at + 1 - first == n ? first : at + 1;
            cgm->vertex[at].out = add_edge(c, at, next, line, covers[at - first]);
            c->before[next] = cgm->vertex[at].out ^ 1;
            at++;
        } while (at - first < n && cgm->vertex[at].place != PIR_CGM_CORNER);
    }
}

static void add_pieces(struct construct *c, uint32_t map) {
    const struct pir_cgm_arcs *arcs = &c->arcs;
    for (uint32_t i = 8; i < arcs->site_count; i++)
        if (arcs->site[i].place == PIR_CGM_INTERIOR && arcs->site[i].map == map)
            add_vertex(c, i, map);
    for (uint32_t i = 0; i < arcs->piece_count; i++) {
        const struct pir_arc_piece *piece = &arcs->piece[i];
        if (piece->map != map)
            continue;
        uint32_t from = c->vertex_of[piece->from], to = c->vertex_of[piece->to];
        uint32_t h = add_edge(c, from, to, 2 * (c->cgm->source[0].line_start + piece->edge),
                              arcs->polytope->edge_half[piece->edge]);
        c->piece_half[i] = h;
        c->spoke[from] = h;
        c->spoke[to] = h ^ 1;
    }
}

/* --- rings --- */

/* The halfedge in map `map` that starts the arc along polytope halfedge h from the normal of the facet left
   of it, or PIR_CGM_NONE. */
static uint32_t first_half(const struct construct *c, uint32_t h, uint32_t map) {
    const struct pir_cgm_arcs *arcs = &c->arcs;
    uint32_t e = arcs->polytope->edge[h];
    bool forward = arcs->polytope->edge_half[e] == h;
    uint32_t piece = forward ? arcs->piece_start[e] : arcs->piece_start[e + 1] - 1;
    return arcs->piece[piece].map == map ? c->piece_half[piece] ^ !forward : PIR_CGM_NONE;
}

/* The halfedges that leave a facet's normal within a map, counter-clockwise. */
static void link_facet(struct construct *c, uint32_t facet, uint32_t map, struct pir_cgm_ring *ring) {
    const pir_polytope *p = c->arcs.polytope;
    uint32_t start = p->loop_start[facet], n = p->loop_start[facet + 1] - start, i = 0;
    // on the rim, start after one that is not in the map
    while (i < n && first_half(c, p->loop[start + i], map) != PIR_CGM_NONE)
        i++;
    for (uint32_t k = 0; k < n; k++) {
        uint32_t h = first_half(c, p->loop[start + (i + k) % n], map);
        if (h != PIR_CGM_NONE)
            pir_ring_add(c->cgm, ring, h);
    }
}

static void link_vertices(struct construct *c, uint32_t map) {
    pir_cgm *cgm = c->cgm;
    for (uint32_t i = 0; i < c->arcs.site_count; i++) {
        const struct pir_site *site = &c->arcs.site[i];
        uint32_t v = c->vertex_of[i];
        // vertices of maps made before do not count
        if (v == PIR_CGM_NONE || v < cgm->vertex_start[map])
            continue;
        struct pir_cgm_ring ring = {PIR_CGM_NONE, PIR_CGM_NONE};
        if (site->place != PIR_CGM_INTERIOR)
            pir_ring_add(cgm, &ring, cgm->vertex[v].out);
        if (site->facet != PIR_CGM_NONE)
            link_facet(c, site->facet, map, &ring);
        else if (c->spoke[v] != PIR_CGM_NONE) {
            // an arc through a corner may come into one map and leave into another, but never both in one
            pir_ring_add(cgm, &ring, c->spoke[v]);
        }
        if (site->place != PIR_CGM_INTERIOR)
            pir_ring_add(cgm, &ring, c->before[v]);
        else
            cgm->vertex[v].out = ring.first;
        pir_ring_close(cgm, &ring);
    }
}

static bool make_map(struct construct *c, uint32_t map) {
    pir_cgm *cgm = c->cgm;
    add_rim(c, map);
    add_pieces(c, map);
    cgm->vertex_start[map + 1] = c->vertices;
    cgm->edge_start[map + 1] = c->edges;
    link_vertices(c, map);
    return pir_cgm_trace_faces(cgm, map);
}

/* --- what the polytope contributes --- */

/* Hands vertices of the polytope on from faces that have one to those beyond bare cube edges. */
static void spread_vertices(struct construct *c) {
    pir_cgm *cgm = c->cgm;
    uint32_t head = 0, tail = 0;
    for (uint32_t f = 0; f < pir_cgm_faces(cgm); f++)
        if (cgm->face_vertex[f] != PIR_CGM_NONE)
            c->queue[tail++] = f;
    // a point has no arcs at all
    if (tail == 0) {
        cgm->face_vertex[1] = 0;
        c->queue[tail++] = 1;
    }
    while (head < tail) {
        uint32_t face = c->queue[head++], start = cgm->face_half[face], h = start;
        do {
            uint32_t map = cgm->vertex[cgm->half[h].origin].map;
            if (pir_cgm_is_side(cgm, h, map) && c->own[h >> 1] == PIR_CGM_NONE) {
                uint32_t other = cgm->half[pir_cgm_beyond(cgm, h)].face;
                if (cgm->face_vertex[other] == PIR_CGM_NONE) {
                    cgm->face_vertex[other] = cgm->face_vertex[face];
                    c->queue[tail++] = other;
                }
            }
            h = cgm->half[h].next;
        } while (h != start);
    }
}

static bool set_attributes(struct construct *c) {
    pir_cgm *cgm = c->cgm;
    const pir_polytope *p = c->arcs.polytope;
    if (!pir_cgm_connect(cgm))
        return false;
    // vertices that define themselves by a facet have it; a facet at a cube corner is known there alone
    for (uint32_t v = 0; v < pir_cgm_vertices(cgm); v++)
        if (cgm->vertex[v].point.b == PIR_CGM_NONE)
            cgm->vertex_facet[v] = cgm->vertex[v].point.a;
    for (uint32_t map = 0; map < 6; map++)
        for (uint32_t k = 0; k < 4; k++)
            cgm->vertex_facet[cgm->corner[map][k]] = c->arcs.site[pir_cube_corner(map, k)].facet;
    // left of an arc is the cell of its edge's end
    for (uint32_t e = 0; e < pir_cgm_edges(cgm); e++) {
        uint32_t half = cgm->edge_half[e] = c->own[e];
        if (half == PIR_CGM_NONE)
            continue;
        cgm->face_vertex[cgm->half[2 * e].face] = p->target[half];
        cgm->face_vertex[cgm->half[2 * e + 1].face] = p->origin[half];
    }
    for (uint32_t map = 0; map < 6; map++)
        cgm->face_vertex[cgm->face_start[map]] = PIR_CGM_NONE;
    spread_vertices(c);
    return true;
}

/* Counts what all maps take, and allocates it. */
static bool allocate(struct construct *c) {
    const pir_allocator *a = &c->cgm->allocator;
    const struct pir_cgm_arcs *arcs = &c->arcs;
    uint32_t on_edges = 0, interior = 0, pieces = 0;
    for (uint32_t i = 8; i < arcs->site_count; i++)
        arcs->site[i].place == PIR_CGM_EDGE ? on_edges++ : interior++;
    for (uint32_t i = 0; i < arcs->piece_count; i++)
        pieces += arcs->piece[i].map != PIR_ALONG_EDGE;
    uint32_t vertices = 24 + 2 * on_edges + interior, edges = 24 + 2 * on_edges + pieces;
    c->vertices = vertices;
    c->edges = edges;
    c->vertex_of = PIR_NEW(a, uint32_t, arcs->site_count);
    c->cover = PIR_NEW(a, uint32_t, arcs->site_count);
    c->edge_sites = PIR_NEW(a, uint32_t, arcs->site_count);
    c->piece_half = PIR_NEW(a, uint32_t, arcs->piece_count);
    c->spoke = PIR_NEW(a, uint32_t, vertices);
    c->before = PIR_NEW(a, uint32_t, vertices);
    c->own = PIR_NEW(a, uint32_t, edges);
    // also a queue of faces, of which a map has at most as many as edges
    c->queue = PIR_NEW(a, uint32_t, (size_t)edges + vertices);
    return c->vertex_of && c->cover && c->edge_sites && c->piece_half && c->spoke && c->before && c->own && c->queue &&
           pir_cgm_reserve_vertices(c->cgm, 0, vertices) && pir_cgm_reserve_edges(c->cgm, 0, edges);
}

static void release(struct construct *c, uint32_t vertices, uint32_t edges) {
    const pir_allocator *a = &c->cgm->allocator;
    const struct pir_cgm_arcs *arcs = &c->arcs;
    PIR_FREE(a, c->vertex_of, arcs->site_count);
    PIR_FREE(a, c->cover, arcs->site_count);
    PIR_FREE(a, c->edge_sites, arcs->site_count);
    PIR_FREE(a, c->piece_half, arcs->piece_count);
    PIR_FREE(a, c->spoke, vertices);
    PIR_FREE(a, c->before, vertices);
    PIR_FREE(a, c->own, edges);
    PIR_FREE(a, c->queue, (size_t)edges + vertices);
}

/* Fills a map whose source and lines are there; false when out of memory. */
static bool fill(pir_cgm *cgm) {
    struct construct c = {.cgm = cgm};
    if (!pir_arcs_init(&c.arcs, cgm))
        return false;
    bool done = allocate(&c);
    uint32_t vertices = c.vertices, edges = c.edges;
    c.vertices = c.edges = 0;
    if (done) {
        memset(c.vertex_of, 0xff, c.arcs.site_count * sizeof *c.vertex_of);
        sort_edge_sites(&c);
        cover_cube_edges(&c);
        for (uint32_t map = 0; map < 6 && done; map++)
            done = make_map(&c, map);
        done = done && set_attributes(&c);
    }
    if (done) {
        pir_cgm_flag_vertices(cgm);
        pir_cgm_trim(cgm);
        cgm->by_filter = c.arcs.sides.by_filter;
        cgm->by_exact = c.arcs.sides.by_exact;
    }
    release(&c, vertices, edges);
    pir_arcs_finish(&c.arcs);
    return done;
}

pir_status pir_cgm_create(pir_polytope *polytope, const pir_quat *rotation, const pir_allocator *allocator,
                          pir_cgm **ret_cgm) {
    if (!polytope || !ret_cgm)
        return PIR_ERR_ARGUMENT;
    const pir_allocator used = pir_allocator_or_default(allocator);
    pir_rotation_integers integers;
    pir_rotation turned = {.integers = &integers};
    if (rotation) {
        pir_status status = pir_rotation_set(&turned, *rotation);
        if (status != PIR_OK)
            return status;
    }
    pir_cgm *cgm = pir_cgm_new_from(&used, polytope, rotation ? &turned : NULL);
    if (!cgm)
        return PIR_ERR_MEMORY;
    if (!fill(cgm)) {
        pir_cgm_release(cgm);
        return PIR_ERR_MEMORY;
    }
    *ret_cgm = cgm;
    return PIR_OK;
}
