/* SPDX-License-Identifier: MIT */
/*
 * The polygon in which a plane cuts a convex body.
 *
 * Every vertex is above the plane, below it or in it. A facet with a vertex above and one that is not has a side of the
 * polygon: its loop, counter-clockwise from outside, goes down through the plane where the side begins and up again
 * where it ends, seen from above. A vertex in the plane counts as below here, which is the section of a plane that lies
 * higher by less than any vertex; where a loop leaves or reaches the lower vertices at one that is in the plane, that
 * vertex is the end of the side. So every side of the section comes from one facet: the edges of the body that lie in
 * the plane from the facet above them. A facet that meets the plane in a vertex alone gives a side from that vertex to
 * itself, which is left out. A body without a vertex above is turned upside down first.
 *
 * Facets are maximal, so two of their planes cut this one in two lines and no corner is straight.
 */
#include "polytope/section/section.h"

#include <math.h>
#include <string.h>

#include <pirouette/exact.h>

#include "base/memory.h"
#include "base/sort.h"
#include "base/vec.h"
#include "polytope/section/cut.h"

/* A side of the polygon, from the point of one edge to that of another. */
struct section_side {
    uint32_t from[2], to[2];
};

/* The mesh that is cut, and the polygon as far as it is known. */
struct section_work {
    const pir_mesh *mesh;
    struct pir_cut cut;
    int8_t *sign;      /* per vertex: above 1, below −1, in the plane 0; the other way round when `flipped` */
    bool flipped;      /* no vertex is above */
    uint32_t signs[3]; /* how many vertices have −1, 0 and 1, before flipping */
    struct section_side *side;
    uint32_t sides;
    uint32_t *order, *sort; /* sides by where they begin, and scratch to sort them */
};

static bool begin(struct section_work *work, const pir_mesh *mesh) {
    const pir_allocator *a = &mesh->allocator;
    uint32_t facets = mesh->facets.count;
    *work = (struct section_work){.mesh = mesh};
    work->sign = PIR_NEW(a, int8_t, mesh->vertex_count);
    work->side = PIR_NEW(a, struct section_side, facets);
    work->order = PIR_NEW(a, uint32_t, facets);
    work->sort = PIR_NEW(a, uint32_t, facets);
    return work->sign && work->side && work->order && work->sort;
}

static void end(struct section_work *work) {
    const pir_allocator *a = &work->mesh->allocator;
    uint32_t facets = work->mesh->facets.count;
    PIR_FREE(a, work->sign, work->mesh->vertex_count);
    PIR_FREE(a, work->side, facets);
    PIR_FREE(a, work->order, facets);
    PIR_FREE(a, work->sort, facets);
}

static void find_signs(struct section_work *work) {
    for (uint32_t v = 0; v < work->mesh->vertex_count; v++) {
        work->sign[v] = (int8_t)pir_cut_side(&work->cut, v);
        work->signs[work->sign[v] + 1]++;
    }
    work->flipped = work->signs[2] == 0;
    for (uint32_t v = 0; work->flipped && v < work->mesh->vertex_count; v++)
        work->sign[v] = (int8_t)-work->sign[v];
}

/* The edge from `above` to `other`, or `other` alone when it is in the plane. */
static void set_point(const struct section_work *work, uint32_t above, uint32_t other, uint32_t ret_edge[2]) {
    if (work->sign[other] == 0)
        above = other;
    ret_edge[0] = above < other ? above : other;
    ret_edge[1] = above < other ? other : above;
}

/* The side that a facet gives; false when it gives none. */
static bool find_side(const struct section_work *work, uint32_t facet, struct section_side *ret_side) {
    uint32_t count;
    const uint32_t *corner = pir_mesh_facet(work->mesh, facet, &count);
    bool crosses = false;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t a = corner[i], b = corner[i + 1 < count ? i + 1 : 0];
        bool above = work->sign[a] > 0, next_above = work->sign[b] > 0;
        if (above && !next_above)
            set_point(work, a, b, ret_side->from);
        if (next_above && !above)
            set_point(work, b, a, ret_side->to);
        crosses |= above != next_above;
    }
    if (!crosses || memcmp(ret_side->from, ret_side->to, sizeof ret_side->from) == 0)
        return false;
    if (work->flipped) {
        struct section_side back = *ret_side;
        memcpy(ret_side->from, back.to, sizeof back.to);
        memcpy(ret_side->to, back.from, sizeof back.from);
    }
    return true;
}

static bool edge_before(const uint32_t a[2], const uint32_t b[2]) {
    return a[0] != b[0] ? a[0] < b[0] : a[1] < b[1];
}

static bool side_before(void *context, uint32_t a, uint32_t b) {
    const struct section_work *work = context;
    return edge_before(work->side[a].from, work->side[b].from);
}

static void find_sides(struct section_work *work) {
    for (uint32_t f = 0; f < work->mesh->facets.count; f++)
        if (find_side(work, f, &work->side[work->sides])) {
            work->order[work->sides] = work->sides;
            work->sides++;
        }
    pir_sort(work->order, work->sides, work->sort, side_before, work);
}

/* The side that begins where another ends: by halving, since they are in order. */
static uint32_t side_from(const struct section_work *work, const uint32_t point[2]) {
    uint32_t low = 0, high = work->sides;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (edge_before(point, work->side[work->order[middle]].from))
            high = middle;
        else
            low = middle;
    }
    return work->order[low];
}

static void put_vertex(pir_section *section, uint32_t vertex) {
    section->edge[section->count][0] = section->edge[section->count][1] = vertex;
    section->count++;
}

/* A body that lies in the plane whole: of the two facets of a polygon the one that faces the normal's way. */
static void put_whole(struct section_work *work, pir_section *section) {
    const pir_mesh *mesh = work->mesh;
    if (mesh->facets.count == 0) {
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
            put_vertex(section, v);
        return;
    }
    uint32_t count;
    const uint32_t *corner = pir_mesh_facet(mesh, 0, &count);
    if (pir_cut_turn(&work->cut, corner) < 0)
        corner = pir_mesh_facet(mesh, 1, &count);
    for (uint32_t i = 0; i < count; i++)
        put_vertex(section, corner[i]);
}

/* A section that is no polygon with sides from facets: empty, a vertex, or that of a segment. */
static void put_small(const struct section_work *work, pir_section *section) {
    const pir_mesh *mesh = work->mesh;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        if (work->sign[v] == 0)
            put_vertex(section, v);
    if (mesh->facets.count == 0 && work->signs[0] && work->signs[2]) {
        section->edge[0][0] = 0;
        section->edge[0][1] = 1;
        section->count = 1;
    }
}

/* The sides one after the other, from the first in order. */
static void put_sides(const struct section_work *work, pir_section *section) {
    uint32_t side = work->order[0];
    for (uint32_t i = 0; i < work->sides; i++) {
        memcpy(section->edge[i], work->side[side].from, sizeof section->edge[i]);
        side = side_from(work, work->side[side].to);
    }
    section->count = work->sides;
}

static void put_corners(struct section_work *work, pir_section *section) {
    mpz_t over[3], under;
    mpz_inits(over[0], over[1], over[2], under, NULL);
    for (uint32_t i = 0; i < section->count; i++) {
        double c[3];
        pir_cut_point(&work->cut, section->edge[i], over, under);
        for (int k = 0; k < 3; k++) {
            const pir_int a = {over[k]->_mp_d, over[k]->_mp_size, 0}, b = {under->_mp_d, under->_mp_size, 0};
            static const mp_limb_t one = 1;
            const pir_int unit = {(mp_limb_t *)&one, 1, 0};
            c[k] = pir_scaled_nearest_double(&a, &unit, &b);
        }
        section->corner[i] = (pir_vec3){c[0], c[1], c[2]};
    }
    mpz_clears(over[0], over[1], over[2], under, NULL);
}

/* An empty section with room for `room` corners; NULL when out of memory. */
static pir_section *new_section(const pir_allocator *allocator, uint32_t room) {
    pir_section *section = PIR_ZEROED(allocator, pir_section, 1);
    if (!section)
        return NULL;
    section->allocator = *allocator;
    section->room = room;
    section->corner = PIR_NEW(allocator, pir_vec3, room);
    section->edge = pir_memory_new(allocator, room, sizeof *section->edge);
    if (section->corner && section->edge)
        return section;
    pir_section_destroy(section);
    return NULL;
}

static pir_section *make(struct section_work *work) {
    // A polygon in the plane has as many corners as vertices, another one no more than it has facets.
    uint32_t room = work->sides > 2 ? work->sides : work->mesh->vertex_count;
    pir_section *section = new_section(&work->mesh->allocator, room);
    if (!section)
        return NULL;
    if (work->signs[0] + work->signs[2] == 0)
        put_whole(work, section);
    else if (work->sides == 0)
        put_small(work, section);
    else
        put_sides(work, section);
    put_corners(work, section);
    return section;
}

pir_status pir_mesh_section(const pir_mesh *mesh, pir_vec3 normal, double offset, pir_section **ret_section) {
    if (!mesh || !ret_section || !mesh->exact || (normal.x == 0 && normal.y == 0 && normal.z == 0))
        return PIR_ERR_ARGUMENT;
    if (!pir_vec_is_finite(normal) || !isfinite(offset))
        return PIR_ERR_NOT_FINITE;
    struct section_work work;
    pir_section *section = NULL;
    if (begin(&work, mesh)) {
        pir_cut_init(&work.cut, mesh, normal, offset);
        find_signs(&work);
        find_sides(&work);
        section = make(&work);
        pir_cut_finish(&work.cut);
    }
    end(&work);
    if (!section)
        return PIR_ERR_MEMORY;
    section->normal = normal;
    section->offset = offset;
    *ret_section = section;
    return PIR_OK;
}

void pir_section_destroy(pir_section *section) {
    if (!section)
        return;
    const pir_allocator allocator = section->allocator, *a = &allocator;
    PIR_FREE(a, section->corner, section->room);
    PIR_FREE(a, section->edge, section->room);
    PIR_FREE(a, section, 1);
}

uint32_t pir_section_corner_count(const pir_section *section) {
    return section->count;
}

const pir_vec3 *pir_section_corners(const pir_section *section) {
    return section->corner;
}

void pir_section_edge(const pir_section *section, uint32_t corner, uint32_t ret_edge[2]) {
    ret_edge[0] = section->edge[corner][0];
    ret_edge[1] = section->edge[corner][1];
}

pir_status pir_section_corner_exact(const pir_section *section, const pir_mesh *mesh, uint32_t corner,
                                    mpq_t ret_coordinates[3]) {
    if (!section || !mesh || !mesh->exact || corner >= section->count || section->edge[corner][1] >= mesh->vertex_count)
        return PIR_ERR_ARGUMENT;
    struct pir_cut cut;
    mpz_t over[3], under;
    mpz_inits(over[0], over[1], over[2], under, NULL);
    pir_cut_init(&cut, mesh, section->normal, section->offset);
    pir_cut_point(&cut, section->edge[corner], over, under);
    for (int k = 0; k < 3; k++) {
        mpz_set(mpq_numref(ret_coordinates[k]), over[k]);
        mpz_set(mpq_denref(ret_coordinates[k]), under);
        mpq_canonicalize(ret_coordinates[k]);
    }
    pir_cut_finish(&cut);
    mpz_clears(over[0], over[1], over[2], under, NULL);
    return PIR_OK;
}
