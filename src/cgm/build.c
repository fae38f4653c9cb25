/* SPDX-License-Identifier: MIT */
/*
 * The life of a map, and the parts of making one that do not depend on where it comes from. The invariants stand in
 * cgm.h.
 */
#include "cgm/build.h"

#include <string.h>

/* --- memory --- */

bool pir_cgm_grow(const pir_allocator *allocator, void **block, uint32_t *capacity, uint32_t need, size_t size) {
    if (need <= *capacity)
        return true;
    // 32-bit numbers with a bit to spare
    if (need > (uint32_t)1 << 30)
        return false;
    uint32_t more = *capacity < need / 2 ? need : 2 * *capacity;
    void *grown = pir_memory_resize(allocator, *block, *capacity, more, size);
    if (!grown)
        return false;
    *block = grown;
    *capacity = more;
    return true;
}

bool pir_cgm_reserve_vertices(pir_cgm *cgm, uint32_t count, uint32_t extra) {
    void *block = cgm->vertex;
    bool done = pir_cgm_grow(&cgm->allocator, &block, &cgm->vertex_capacity, count + extra, sizeof *cgm->vertex);
    cgm->vertex = block;
    return done;
}

bool pir_cgm_reserve_edges(pir_cgm *cgm, uint32_t count, uint32_t extra) {
    void *half = cgm->half, *line = cgm->edge_line;
    bool done = pir_cgm_grow(&cgm->allocator, &half, &cgm->half_capacity, count + extra, 2 * sizeof *cgm->half);
    cgm->half = half;
    done = done && pir_cgm_grow(&cgm->allocator, &line, &cgm->line_capacity, count + extra, sizeof *cgm->edge_line);
    cgm->edge_line = line;
    return done;
}

static void release_sources(pir_cgm *cgm) {
    for (uint32_t s = 0; s < cgm->source_count; s++) {
        PIR_FREE(&cgm->allocator, cgm->source[s].turn, 1);
        pir_polytope_release(cgm->source[s].polytope);
    }
}

pir_cgm *pir_cgm_retain(const pir_cgm *cgm) {
    pir_cgm *held = (pir_cgm *)cgm;
    atomic_fetch_add_explicit(&held->references, 1, memory_order_relaxed);
    return held;
}

void pir_cgm_release(pir_cgm *cgm) {
    if (!cgm || atomic_fetch_sub_explicit(&cgm->references, 1, memory_order_acq_rel) != 1)
        return;
    const pir_allocator allocator = cgm->allocator, *a = &allocator;
    size_t k = cgm->source_count;
    PIR_FREE(a, cgm->vertex, cgm->vertex_capacity);
    pir_memory_free(a, cgm->half, cgm->half_capacity, 2 * sizeof *cgm->half);
    PIR_FREE(a, cgm->edge_line, cgm->line_capacity);
    PIR_FREE(a, cgm->face_half, cgm->face_capacity);
    PIR_FREE(a, cgm->vertex_facet, pir_cgm_vertices(cgm) * k);
    PIR_FREE(a, cgm->edge_half, pir_cgm_edges(cgm) * k);
    PIR_FREE(a, cgm->face_vertex, pir_cgm_faces(cgm) * k);
    PIR_FREE(a, cgm->line, cgm->line_count);
    release_sources(cgm);
    PIR_FREE(a, cgm->source, cgm->source_count);
    PIR_FREE(a, cgm, 1);
}

/* --- sources and lines --- */

/* Takes one more source; false when out of memory. */
static bool add_source(pir_cgm *cgm, pir_polytope *polytope, const pir_rotation *rotation) {
    struct pir_cgm_source *source = &cgm->source[cgm->source_count];
    *source = (struct pir_cgm_source){.line_start = cgm->line_count, .normal_start = cgm->normal_count};
    uint32_t longer = 0;
    if (rotation) {
        source->turn = PIR_NEW(&cgm->allocator, struct pir_cgm_turn, 1);
        if (!source->turn)
            return false;
        source->rotation = &source->turn->rotation;
        source->rotation->integers = &source->turn->integers;
        // its integers are made now, so that asking changes nothing later
        pir_rotation_set(source->rotation, rotation->given);
        pir_rotation_make_exact(source->rotation);
        longer = PIR_MATRIX_LIMBS + 1;
    }
    source->polytope = pir_polytope_retain(polytope);
    cgm->source_count++;
    cgm->line_count += polytope->edge_count;
    cgm->normal_count += polytope->facet_count;
    uint32_t line = polytope->exact_edge.stride + longer, normal = polytope->exact_normal.stride + longer;
    cgm->line_limbs = line > cgm->line_limbs ? line : cgm->line_limbs;
    cgm->normal_limbs = normal > cgm->normal_limbs ? normal : cgm->normal_limbs;
    return true;
}

/* The lines by doubles; the bounds are derived at the head of sides.c. */
static bool set_lines(pir_cgm *cgm) {
    cgm->line = PIR_NEW(&cgm->allocator, struct pir_cgm_line, cgm->line_count);
    if (!cgm->line)
        return false;
    struct pir_cgm_line *line = cgm->line;
    for (uint32_t k = 0; k < PIR_CUBE_PLANES; k++) {
        int c[3];
        pir_cube_plane(k, c);
        *line++ = (struct pir_cgm_line){pir_vec_scale((pir_vec3){c[0], c[1], c[2]}, sqrt(0.5)), 2 * 0x1p-53};
    }
    for (uint32_t s = 0; s < cgm->source_count; s++) {
        const pir_polytope *p = cgm->source[s].polytope;
        const pir_rotation *rotation = cgm->source[s].rotation;
        for (uint32_t e = 0; e < p->edge_count; e++) {
            pir_vec3 d = p->direction[p->edge_half[e]];
            *line++ = rotation ? (struct pir_cgm_line){pir_mat_apply(&rotation->r, d), PIR_CGM_TURNED_ERROR}
                               : (struct pir_cgm_line){d, PIR_CGM_UNIT_ERROR};
        }
    }
    return true;
}

static pir_cgm *new_cgm(const pir_allocator *allocator, uint32_t sources) {
    pir_cgm *cgm = PIR_ZEROED(allocator, pir_cgm, 1);
    if (!cgm)
        return NULL;
    cgm->allocator = *allocator;
    atomic_init(&cgm->references, 1);
    cgm->line_count = PIR_CUBE_PLANES;
    cgm->line_limbs = cgm->normal_limbs = 1;
    cgm->source = PIR_ZEROED(allocator, struct pir_cgm_source, sources);
    if (!cgm->source) {
        PIR_FREE(allocator, cgm, 1);
        return NULL;
    }
    return cgm;
}

/* Takes apart a map that has room for `sources` sources but fewer of them. */
static pir_cgm *give_up(pir_cgm *cgm, uint32_t sources) {
    release_sources(cgm);
    PIR_FREE(&cgm->allocator, cgm->source, sources);
    const pir_allocator allocator = cgm->allocator;
    PIR_FREE(&allocator, cgm, 1);
    return NULL;
}

pir_cgm *pir_cgm_new(const pir_allocator *allocator, const pir_cgm *first, const pir_cgm *second) {
    uint32_t sources = first->source_count + second->source_count;
    pir_cgm *cgm = new_cgm(allocator, sources);
    if (!cgm)
        return NULL;
    for (uint32_t s = 0; s < sources; s++) {
        const struct pir_cgm_source *from =
            s < first->source_count ? &first->source[s] : &second->source[s - first->source_count];
        if (!add_source(cgm, from->polytope, from->rotation))
            return give_up(cgm, sources);
    }
    return set_lines(cgm) ? cgm : give_up(cgm, sources);
}

pir_cgm *pir_cgm_new_from(const pir_allocator *allocator, pir_polytope *polytope, const pir_rotation *rotation) {
    pir_cgm *cgm = new_cgm(allocator, 1);
    if (!cgm)
        return NULL;
    return add_source(cgm, polytope, rotation) && set_lines(cgm) ? cgm : give_up(cgm, 1);
}

/* --- faces, copies, flags --- */

/* Gives the loop of `half` the next face number. */
static bool trace_face(pir_cgm *cgm, uint32_t half, uint32_t *count) {
    void *block = cgm->face_half;
    bool done = pir_cgm_grow(&cgm->allocator, &block, &cgm->face_capacity, *count + 1, sizeof *cgm->face_half);
    cgm->face_half = block;
    if (!done)
        return false;
    cgm->face_half[*count] = half;
    for (uint32_t h = half; cgm->half[h].face == PIR_CGM_NONE; h = cgm->half[h].next)
        cgm->half[h].face = *count;
    ++*count;
    return true;
}

bool pir_cgm_trace_faces(pir_cgm *cgm, uint32_t map) {
    uint32_t count = cgm->face_start[map], first = 2 * cgm->edge_start[map], end = 2 * cgm->edge_start[map + 1];
    for (uint32_t h = first; h < end; h++)
        cgm->half[h].face = PIR_CGM_NONE;
    // the outer face is right of every side
    if (!trace_face(cgm, first + 1, &count))
        return false;
    for (uint32_t h = first; h < end; h++)
        if (cgm->half[h].face == PIR_CGM_NONE && !trace_face(cgm, h, &count))
            return false;
    cgm->face_start[map + 1] = count;
    return true;
}

/* Pairs the vertices along one side with those of the map beyond, which go the other way. */
static void pair_side(pir_cgm *cgm, uint32_t map, uint32_t side) {
    uint32_t other = pir_side_neighbor(map, side), beyond = pir_side_beyond(map, side);
    uint32_t from = cgm->corner[map][pir_side_corner(side)], end = cgm->corner[map][pir_side_corner((side + 1) % 4)];
    uint32_t opposite = cgm->corner[other][pir_side_corner((beyond + 1) % 4)];
    uint32_t other_start = cgm->vertex_start[other];
    for (uint32_t v = from; v != end; v = pir_cgm_target(cgm, cgm->vertex[v].out)) {
        cgm->vertex[v].copy = opposite;
        // one step on along the side is one back beyond it
        opposite = opposite == other_start ? other_start + cgm->rim[other] - 1 : opposite - 1;
    }
}

static uint32_t *new_attributes(const pir_cgm *cgm, uint32_t count) {
    size_t entries = (size_t)count * cgm->source_count;
    uint32_t *block = PIR_NEW(&cgm->allocator, uint32_t, entries);
    if (block)
        memset(block, 0xff, entries * sizeof *block);
    return block;
}

bool pir_cgm_connect(pir_cgm *cgm) {
    for (uint32_t map = 0; map < 6; map++) {
        for (uint32_t v = cgm->vertex_start[map] + cgm->rim[map]; v < cgm->vertex_start[map + 1]; v++)
            cgm->vertex[v].copy = v;
        for (uint32_t side = 0; side < 4; side++)
            pair_side(cgm, map, side);
    }
    cgm->vertex_facet = new_attributes(cgm, pir_cgm_vertices(cgm));
    cgm->edge_half = new_attributes(cgm, pir_cgm_edges(cgm));
    cgm->face_vertex = new_attributes(cgm, pir_cgm_faces(cgm));
    return cgm->vertex_facet && cgm->edge_half && cgm->face_vertex;
}

/* Whether both faces carry the same vertices of `count` sources from `first` on. */
static bool same_vertices(const pir_cgm *cgm, uint32_t f, uint32_t g, uint32_t first, uint32_t count) {
    for (uint32_t s = first; s < first + count; s++)
        if (pir_cgm_source_vertex(cgm, f, s) != pir_cgm_source_vertex(cgm, g, s))
            return false;
    return true;
}

bool pir_cgm_is_facet_of(const pir_cgm *cgm, uint32_t v, uint32_t first, uint32_t count) {
    struct pir_cgm_around around = pir_cgm_around_new(cgm, v);
    uint32_t start = cgm->half[around.half].face, last = start, changes = 0;
    while (pir_cgm_around_next(cgm, &around)) {
        uint32_t face = cgm->half[around.half].face;
        changes += !same_vertices(cgm, last, face, first, count);
        last = face;
    }
    return changes + !same_vertices(cgm, last, start, first, count) >= 3;
}

/* Gives a block's spare room back; where that fails it stays as it is. */
static void trim(const pir_allocator *allocator, void **block, uint32_t *capacity, uint32_t count, size_t size) {
    void *smaller = count < *capacity ? pir_memory_resize(allocator, *block, *capacity, count, size) : NULL;
    if (smaller) {
        *block = smaller;
        *capacity = count;
    }
}

void pir_cgm_trim(pir_cgm *cgm) {
    const pir_allocator *a = &cgm->allocator;
    void *vertex = cgm->vertex, *face = cgm->face_half, *half = cgm->half, *line = cgm->edge_line;
    trim(a, &vertex, &cgm->vertex_capacity, pir_cgm_vertices(cgm), sizeof *cgm->vertex);
    trim(a, &half, &cgm->half_capacity, pir_cgm_edges(cgm), 2 * sizeof *cgm->half);
    trim(a, &line, &cgm->line_capacity, pir_cgm_edges(cgm), sizeof *cgm->edge_line);
    trim(a, &face, &cgm->face_capacity, pir_cgm_faces(cgm), sizeof *cgm->face_half);
    cgm->vertex = vertex;
    cgm->half = half;
    cgm->edge_line = line;
    cgm->face_half = face;
}

void pir_cgm_flag_vertices(pir_cgm *cgm) {
    for (uint32_t v = 0; v < pir_cgm_vertices(cgm); v++)
        cgm->vertex[v].real = pir_cgm_is_facet_of(cgm, v, 0, cgm->source_count);
}
