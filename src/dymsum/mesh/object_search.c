/* SPDX-License-Identifier: MIT */
/*
 * The search of the object-space method (Diktaş and Şahiner, An Object-Space Method for Calculating the Minkowski
 * Sums of Simple 3D Objects, 2006), decided exactly.
 *
 * A facet of the sum has the normal of a facet of P, of a facet of Q, or of an edge of each, d × e. Along a normal the
 * farthest vertices of the sum are those of P with those of Q: the sum of two faces. It is a facet
 *
 *   - for the normal of a facet, always;
 *   - for d × e, where its faces are the two edges and no more. Where one of them is more, a facet of P or Q has this
 *     normal, and the facet is found with that; where the edges themselves are not farthest, either there is no facet
 *     or other edges lie in it.
 *
 * So each facet is found once. With M the rotation up to a positive factor, u a difference of vertices of P and w one
 * of Q, all that is compared are signs of s(a, b) = (M·a)·b:
 *
 *     M·n · w = s(n, w)                   g · M·u = s(u, g)
 *     (d × M·e) · M·u = s(e × u, d)       (d × M·e) · w = s(e, w × d)
 *
 * up to positive factors. Doubles decide most of them.
 */
#include "dymsum/mesh/object_search.h"

#include "base/layout.h"

static pir_layout layout_of(pir_object_search *search) {
    const pir_polytope *p = search->posed->p, *q = search->posed->q;
    size_t most = p->vertex_count > q->vertex_count ? p->vertex_count : q->vertex_count;
    return (pir_layout){{PIR_ROW(search->at_p, p->vertex_count), PIR_ROW(search->at_q, q->vertex_count),
                         PIR_ROW(search->of_p, p->facet_count), PIR_ROW(search->of_q, q->facet_count),
                         PIR_ROW(search->fv, p->facet_count), PIR_ROW(search->vf, q->facet_count),
                         PIR_ROW(search->farthest, most), PIR_ROW(search->is_farthest, most)}};
}

uint32_t pir_object_limbs(const pir_polytope *operand) {
    // a cross product of an edge with a difference of vertices is the longest, but for a normal
    uint32_t cross = operand->exact_edge.stride + operand->exact_vertex.stride + 2;
    return cross > operand->exact_normal.stride ? cross : operand->exact_normal.stride;
}

/*
 * The vertices about the first, and the bound. With u = 2^-53, D the extent, C the greatest coordinate: a vertex is off
 * by 2·1.8u·C + u·D, turned by 38u·D more; a normal, of length 1 at most, by 60u; so the product with a difference
 * of two by less than (120 + 80 + 8)u·D + 8u·C. Underflow loses far less than 2^-1000, and nothing overflows below
 * 2^1000.
 */
static double place_operand(const pir_polytope *of, const pir_mat3 *r, pir_vec3 *at) {
    double extent = 0, greatest = 0;
    for (uint32_t v = 0; v < of->vertex_count; v++) {
        pir_vec3 x = of->vertex[v], from = pir_vec_sub(x, of->vertex[0]);
        extent = fmax(extent, fabs(from.x) + fabs(from.y) + fabs(from.z));
        greatest = fmax(greatest, fabs(x.x) + fabs(x.y) + fabs(x.z));
        at[v] = r ? pir_mat_apply(r, from) : from;
    }
    return greatest < 0x1p1000 ? 0x1p-44 * (extent + greatest) + 0x1p-1000 : INFINITY;
}

/* The sign of a product by doubles, or 0 where they are not certain. */
static int certain_sign(double value, double bound) {
    return (value > bound) - (value < -bound);
}

/* w − v exactly, in scratch that the caller gives back. */
static pir_int3 exact_difference(const pir_polytope *of, uint32_t w, uint32_t v, pir_limbs *scratch) {
    pir_int3 a = pir_vertex_exact(of, w), b = pir_vertex_exact(of, v);
    pir_int3 difference = pir_int3_take(scratch, of->exact_vertex.stride + 1);
    for (int k = 0; k < 3; k++)
        pir_int_sub(&difference.c[k], &a.c[k], &b.c[k]);
    return difference;
}

/* --- farthest along the normal of a facet --- */

/* The normal of a facet of one operand, along which vertices of the other are compared. */
struct along {
    pir_vec3 normal;
    pir_int3 exact;
    bool of_p; /* the facet is P's, the vertices are Q's */
};

/* Exactly: the sign of how much farther w is than v. */
static int exact_farther(const pir_object_search *search, const struct along *along, uint32_t w, uint32_t v) {
    const pir_posed *posed = search->posed;
    pir_limbs *scratch = posed->signs->scratch;
    uint32_t mark = scratch->used;
    pir_int3 way = exact_difference(along->of_p ? posed->q : posed->p, w, v, scratch);
    int sign = along->of_p ? pir_sign_true(posed->signs, &along->exact, &way)
                           : pir_sign_true(posed->signs, &way, &along->exact);
    scratch->used = mark;
    return sign;
}

/* Fills `farthest`, by rising number; returns how many. */
static uint32_t find_farthest(pir_object_search *search, const struct along *along) {
    const pir_polytope *of = along->of_p ? search->posed->q : search->posed->p;
    const pir_vec3 *at = along->of_p ? search->at_q : search->at_p;
    double bound = along->of_p ? search->bound_q : search->bound_p, greatest = -INFINITY;
    uint32_t count = 0;
    for (uint32_t v = 0; v < of->vertex_count; v++)
        greatest = fmax(greatest, pir_vec_dot(along->normal, at[v]));
    for (uint32_t v = 0; v < of->vertex_count; v++) {
        if (pir_vec_dot(along->normal, at[v]) - greatest < -bound)
            continue;
        int farther = count == 0 ? 1 : exact_farther(search, along, v, search->farthest[0]);
        if (farther > 0)
            count = 0;
        if (farther >= 0)
            search->farthest[count++] = v;
    }
    return count;
}

/* The facet of `of` whose corners are the farthest vertices, with its normal along that of `along`; or PIR_NO_FACE. */
static uint32_t facet_of_farthest(const pir_object_search *search, const struct along *along, const pir_polytope *of) {
    uint32_t v = search->farthest[0];
    for (uint32_t h = of->ring_start[v]; h < of->ring_start[v + 1]; h++) {
        uint32_t g = of->left[h];
        bool all = true;
        for (uint32_t i = of->loop_start[g]; i < of->loop_start[g + 1]; i++)
            all = all && search->is_farthest[of->origin[of->loop[i]]];
        pir_int3 normal = pir_normal_exact(of, g);
        // a polygon's two facets have the same corners
        if (all && (along->of_p ? pir_sign_true(search->posed->signs, &along->exact, &normal)
                                : pir_sign_true(search->posed->signs, &normal, &along->exact)) > 0)
            return g;
    }
    return PIR_NO_FACE;
}

/* The halfedge that joins the two farthest vertices, or PIR_NO_FACE. */
static uint32_t half_of_farthest(const pir_object_search *search, const pir_polytope *of) {
    uint32_t v = search->farthest[0];
    for (uint32_t h = of->ring_start[v]; h < of->ring_start[v + 1]; h++)
        if (of->target[h] == search->farthest[1])
            return h;
    return PIR_NO_FACE;
}

/* The face of the other operand along the normal of a facet: a vertex, which is told in any case, an edge, a facet. */
static pir_status face_along(pir_object_search *search, const struct along *along, pir_sum_face *ret_face,
                             uint32_t *ret_vertex) {
    const pir_polytope *of = along->of_p ? search->posed->q : search->posed->p;
    uint32_t count = find_farthest(search, along);
    *ret_face = (pir_sum_face){PIR_NO_FACE, PIR_NO_FACE};
    *ret_vertex = search->farthest[0];
    if (count == 2) {
        ret_face->half = half_of_farthest(search, of);
    } else if (count > 2) {
        for (uint32_t i = 0; i < count; i++)
            search->is_farthest[search->farthest[i]] = 1;
        ret_face->facet = facet_of_farthest(search, along, of);
        for (uint32_t i = 0; i < count; i++)
            search->is_farthest[search->farthest[i]] = 0;
    }
    bool is_found = count == 1 || ret_face->half != PIR_NO_FACE || ret_face->facet != PIR_NO_FACE;
    return is_found ? PIR_OK : PIR_ERR_INTERNAL;
}

/* The faces along all normals of facets. */
static pir_status find_faces(pir_object_search *search) {
    const pir_polytope *p = search->posed->p, *q = search->posed->q;
    pir_status status = PIR_OK;
    for (uint32_t f = 0; status == PIR_OK && f < pir_polytope_facet_count(p); f++) {
        const struct along along = {search->posed->normal[f], pir_normal_exact(p, f), true};
        status = face_along(search, &along, &search->of_p[f], &search->fv[f]);
    }
    for (uint32_t g = 0; status == PIR_OK && g < pir_polytope_facet_count(q); g++) {
        const struct along along = {q->normal[g], pir_normal_exact(q, g), false};
        status = face_along(search, &along, &search->of_q[g], &search->vf[g]);
    }
    return status;
}

/* --- farthest along the normal of two edges --- */

/* On which side of its edge in the pair an operand lies, along d × e. */
enum beside_edge { SIDE_MIXED = 0, SIDE_BELOW = 1, SIDE_ABOVE = 2, SIDE_BOTH = 3 };

/* Exactly: the sign of (d × M·e)·M·u, u leading from the edge of P to vertex v. */
static int exact_side_p(const pir_posed *posed, const pir_edge_pair *pair, uint32_t v) {
    pir_limbs *scratch = posed->signs->scratch;
    uint32_t mark = scratch->used;
    pir_int3 e = pir_half_exact(posed->p, pair->half), d = pir_half_exact(posed->q, pair->h);
    pir_int3 u = exact_difference(posed->p, v, posed->p->origin[pair->half], scratch);
    pir_int3 turned = pir_int3_take(scratch, pir_int3_length(&e) + pir_int3_length(&u) + 1);
    pir_int3_cross(&turned, &e, &u, scratch);
    int sign = pir_sign_true(posed->signs, &turned, &d);
    scratch->used = mark;
    return sign;
}

/* Exactly: the sign of (d × M·e)·w, w leading from the edge of Q to vertex v. */
static int exact_side_q(const pir_posed *posed, const pir_edge_pair *pair, uint32_t v) {
    pir_limbs *scratch = posed->signs->scratch;
    uint32_t mark = scratch->used;
    pir_int3 e = pir_half_exact(posed->p, pair->half), d = pir_half_exact(posed->q, pair->h);
    pir_int3 w = exact_difference(posed->q, v, posed->q->origin[pair->h], scratch);
    pir_int3 turned = pir_int3_take(scratch, pir_int3_length(&w) + pir_int3_length(&d) + 1);
    pir_int3_cross(&turned, &w, &d, scratch);
    int sign = pir_sign_true(posed->signs, &e, &turned);
    scratch->used = mark;
    return sign;
}

/* The sides that all vertices but those of the edge are on: both where there are no others. */
static enum beside_edge side_of_p(const pir_object_search *search, const pir_edge_pair *pair, pir_vec3 normal) {
    const pir_polytope *p = search->posed->p;
    uint32_t from = p->origin[pair->half], to = p->target[pair->half], side = SIDE_BOTH;
    for (uint32_t v = 0; v < p->vertex_count && side != SIDE_MIXED; v++) {
        if (v == from || v == to)
            continue;
        int sign = certain_sign(pir_vec_dot(normal, pir_vec_sub(search->at_p[v], search->at_p[from])), search->bound_p);
        if (sign == 0)
            sign = exact_side_p(search->posed, pair, v);
        side &= sign < 0 ? SIDE_BELOW : sign > 0 ? SIDE_ABOVE : SIDE_MIXED;
    }
    return (enum beside_edge)side;
}

static enum beside_edge side_of_q(const pir_object_search *search, const pir_edge_pair *pair, pir_vec3 normal) {
    const pir_polytope *q = search->posed->q;
    uint32_t from = q->origin[pair->h], to = q->target[pair->h], side = SIDE_BOTH;
    for (uint32_t v = 0; v < q->vertex_count && side != SIDE_MIXED; v++) {
        if (v == from || v == to)
            continue;
        int sign = certain_sign(pir_vec_dot(normal, pir_vec_sub(search->at_q[v], search->at_q[from])), search->bound_q);
        if (sign == 0)
            sign = exact_side_q(search->posed, pair, v);
        side &= sign < 0 ? SIDE_BELOW : sign > 0 ? SIDE_ABOVE : SIDE_MIXED;
    }
    return (enum beside_edge)side;
}

static bool add_swept(pir_object_search *search, uint32_t half, uint32_t h) {
    if (search->swept_count == search->swept_room) {
        uint32_t room = search->swept_room * 2 + 32;
        pir_swept *grown = PIR_RESIZE(search->allocator, search->swept, search->swept_room, room);
        if (!grown)
            return false;
        search->swept = grown;
        search->swept_room = room;
    }
    search->swept[search->swept_count++] = (pir_swept){half, h};
    return true;
}

/* Adds what an edge of P and one of Q sweep where that is a facet: along d × e, and along its reverse. */
static bool sweep_pair(pir_object_search *search, const pir_edge_pair *pair) {
    const pir_vec3 normal = pir_vec_cross(pair->d, pair->e);
    uint32_t side = side_of_p(search, pair, normal);
    if (side != SIDE_MIXED)
        side &= side_of_q(search, pair, normal);
    if (side == SIDE_MIXED || pir_edges_are_parallel(search->posed, pair))
        return true;
    return (!(side & SIDE_BELOW) || add_swept(search, pair->half, pair->h)) &&
           (!(side & SIDE_ABOVE) || add_swept(search, pair->half, search->posed->q->twin[pair->h]));
}

static pir_status sweep_edges(pir_object_search *search) {
    const pir_polytope *p = search->posed->p, *q = search->posed->q;
    for (uint32_t i = 0; i < pir_polytope_edge_count(p); i++) {
        pir_edge_pair pair = {.half = p->edge_half[i], .e = pir_posed_direction(search->posed, p->edge_half[i])};
        for (uint32_t j = 0; j < pir_polytope_edge_count(q); j++) {
            pair.h = q->edge_half[j];
            pair.d = q->direction[pair.h];
            if (!sweep_pair(search, &pair))
                return PIR_ERR_MEMORY;
        }
    }
    return PIR_OK;
}

pir_status pir_object_search_run(pir_object_search *search, const pir_posed *posed, const pir_allocator *allocator) {
    *search = (pir_object_search){.allocator = allocator, .posed = posed};
    pir_layout layout = layout_of(search);
    if (!pir_layout_new(allocator, &layout))
        return PIR_ERR_MEMORY;
    search->bound_p = place_operand(posed->p, &posed->signs->rotation.r, search->at_p);
    search->bound_q = place_operand(posed->q, NULL, search->at_q);
    pir_status status = find_faces(search);
    return status == PIR_OK ? sweep_edges(search) : status;
}

void pir_object_search_finish(pir_object_search *search) {
    pir_layout layout = layout_of(search);
    pir_layout_free(search->allocator, &layout);
    PIR_FREE(search->allocator, search->swept, search->swept_room);
    *search = (pir_object_search){0};
}
