/* SPDX-License-Identifier: MIT */
/* The public questions about a polytope, and the whole-structure check. */
#include <pirouette/exact.h>

#include "base/vec.h"
#include "polytope/polytope.h"

int pir_polytope_dimension(const pir_polytope *p) {
    return p->dimension;
}

uint32_t pir_polytope_vertex_count(const pir_polytope *p) {
    return p->vertex_count;
}

uint32_t pir_polytope_edge_count(const pir_polytope *p) {
    return p->artificial ? 1 : p->edge_count;
}

uint32_t pir_polytope_facet_count(const pir_polytope *p) {
    return p->artificial ? 0 : p->facet_count;
}

double pir_polytope_merge_bound(const pir_polytope *p) {
    return p->merge_bound;
}

pir_vec3 pir_polytope_vertex(const pir_polytope *p, uint32_t vertex) {
    return p->vertex[vertex];
}

uint32_t pir_polytope_source(const pir_polytope *p, uint32_t vertex) {
    return p->source[vertex];
}

void pir_polytope_edge(const pir_polytope *p, uint32_t edge, uint32_t ret_vertices[2]) {
    ret_vertices[0] = p->origin[p->edge_half[edge]];
    ret_vertices[1] = p->target[p->edge_half[edge]];
}

uint32_t pir_polytope_facet_size(const pir_polytope *p, uint32_t facet) {
    return p->loop_start[facet + 1] - p->loop_start[facet];
}

void pir_polytope_facet(const pir_polytope *p, uint32_t facet, uint32_t *ret_vertices) {
    for (uint32_t i = p->loop_start[facet]; i < p->loop_start[facet + 1]; i++)
        *ret_vertices++ = p->origin[p->loop[i]];
}

pir_vec3 pir_polytope_normal(const pir_polytope *p, uint32_t facet) {
    return p->normal[facet];
}

void pir_polytope_bounds(const pir_polytope *p, pir_vec3 *ret_low, pir_vec3 *ret_high) {
    pir_vec3 low = p->vertex[0], high = low;
    for (uint32_t v = 1; v < p->vertex_count; v++) {
        pir_vec3 x = p->vertex[v];
        low = (pir_vec3){fmin(low.x, x.x), fmin(low.y, x.y), fmin(low.z, x.z)};
        high = (pir_vec3){fmax(high.x, x.x), fmax(high.y, x.y), fmax(high.z, x.z)};
    }
    *ret_low = low;
    *ret_high = high;
}

/* v in units of `unit`, by division: the inverse of a denormal unit would overflow. */
static pir_vec3 in_units(pir_vec3 v, double unit) {
    return (pir_vec3){v.x / unit, v.y / unit, v.z / unit};
}

double pir_polytope_volume(const pir_polytope *p) {
    if (p->dimension < 3)
        return 0;
    // in units of the greatest extent, so that nothing overflows on the way
    pir_vec3 low, high;
    pir_polytope_bounds(p, &low, &high);
    double half = fmax(fmax(high.x / 2 - low.x / 2, high.y / 2 - low.y / 2), high.z / 2 - low.z / 2);
    pir_vec3 origin = in_units(p->vertex[0], half);
    // tetrahedra from vertex 0 over a fan of each facet
    double six = 0;
    for (uint32_t f = 0; f < p->facet_count; f++) {
        const uint32_t *loop = p->loop + p->loop_start[f];
        uint32_t n = pir_polytope_facet_size(p, f);
        pir_vec3 a = pir_vec_sub(in_units(p->vertex[p->origin[loop[0]]], half), origin);
        for (uint32_t i = 1; i + 1 < n; i++) {
            pir_vec3 b = pir_vec_sub(in_units(p->vertex[p->origin[loop[i]]], half), origin);
            pir_vec3 c = pir_vec_sub(in_units(p->vertex[p->origin[loop[i + 1]]], half), origin);
            six += pir_vec_dot(a, pir_vec_cross(b, c));
        }
    }
    return six / 6 * half * half * half;
}

void pir_polytope_vertex_exact(const pir_polytope *p, uint32_t vertex, mpq_t ret_coordinates[3]) {
    pir_int3 v = pir_vertex_exact(p, vertex);
    for (int k = 0; k < 3; k++)
        pir_scale_to_rational(ret_coordinates[k], &v.c[k], &p->scale);
}

/* --- the whole-structure check --- */

/* Each halfedge by itself: what it names is there, and names it back. */
static bool halves_are_valid(const pir_polytope *p) {
    for (uint32_t v = 0; v < p->vertex_count; v++)
        for (uint32_t h = p->ring_start[v]; h < p->ring_start[v + 1]; h++) {
            uint32_t t = p->twin[h];
            if (p->origin[h] != v || t >= p->half_count || t == h || p->twin[t] != h || p->target[h] != p->origin[t])
                return false;
            if (p->edge[h] >= p->edge_count || p->edge[t] != p->edge[h])
                return false;
        }
    return true;
}

static bool rings_are_valid(const pir_polytope *p) {
    // the next halfedge of a ring has on its right what the one before has on its left
    for (uint32_t h = 0; h < p->half_count; h++)
        if (pir_right(p, pir_ring_next(p, h)) != p->left[h])
            return false;
    for (uint32_t e = 0; e < p->edge_count; e++)
        if (p->edge[p->edge_half[e]] != e || p->origin[p->edge_half[e]] > p->target[p->edge_half[e]])
            return false;
    return true;
}

static bool loops_are_valid(const pir_polytope *p) {
    for (uint32_t f = 0; f < p->facet_count; f++)
        for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++) {
            uint32_t next = i + 1 == p->loop_start[f + 1] ? p->loop_start[f] : i + 1;
            if (p->left[p->loop[i]] != f || p->target[p->loop[i]] != p->origin[p->loop[next]])
                return false;
        }
    return true;
}

/* Every neighbour of a facet's corner is on the facet's plane when it is beside it in the loop, and
   strictly below otherwise. */
static bool is_strictly_convex(const pir_polytope *p, pir_limbs *scratch) {
    pir_int s = pir_limbs_take(scratch, p->exact_normal.stride + p->exact_edge.stride + 2);
    for (uint32_t f = 0; f < p->facet_count; f++) {
        pir_int3 n = pir_normal_exact(p, f);
        for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++) {
            uint32_t v = p->origin[p->loop[i]];
            for (uint32_t h = p->ring_start[v]; h < p->ring_start[v + 1]; h++) {
                pir_int3 d = pir_half_exact(p, h);
                pir_int3_dot(&s, &n, &d, scratch);
                bool beside = p->left[h] == f || pir_right(p, h) == f;
                if (beside ? s.size != 0 : s.size >= 0)
                    return false;
            }
        }
    }
    return true;
}

bool pir_polytope_is_valid(const pir_polytope *p) {
    if (!halves_are_valid(p) || !rings_are_valid(p) || !loops_are_valid(p))
        return false;
    if (p->dimension == 0)
        return p->vertex_count == 1 && p->half_count == 0;
    if (p->vertex_count + p->facet_count != p->edge_count + 2)
        return false;
    uint32_t limbs = 3 * (p->exact_normal.stride + p->exact_edge.stride + 2);
    pir_limbs scratch = {PIR_NEW(&p->allocator, mp_limb_t, limbs), 0, limbs};
    bool convex = scratch.base && is_strictly_convex(p, &scratch);
    PIR_FREE(&p->allocator, scratch.base, limbs);
    return convex;
}
