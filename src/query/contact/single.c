/* SPDX-License-Identifier: MIT */
/*
 * A facet is its own patch in every direction near its normal where the edges that leave it fall from its plane by
 * more than PIR_FLAT and what the normals differ by.
 *
 * Seen at a cosine c to its normal, a length shrinks to c of itself at most, and the area of a corner's triangle to
 * exactly that. So a corner stands out from its neighbours by at least c times what it does in the facet, and the
 * outline is at least c times as wide for its length.
 *
 * The part of a facet that rises from its vertex v by at most h is a triangle, v + e₁ h/s₁, v + e₂ h/s₂,
 * where e₁ and e₂ are the facet's edges at v and s₁ and s₂ what they rise by: as long as both edges are
 * longer. Then the facet holds the triangle, which has no corner of it but v. Where the triangle is over the inside
 * of the carrier, no side of the carrier meets it, so v is the only corner of the overlap there.
 */
#include "query/contact/single.h"

/* Above what sines and differences of unit vectors round by. */
#define ROUNDING 0x1p-40

/* Above what is lost where shapes are kept as floats. */
#define COARSE 0x1p-20

/* --- vertices and edges --- */

/* The least sine by which the edges from a vertex fall or rise along a direction of the body, or 1. */
static inline double least_slope(const pir_polytope *p, uint32_t v, pir_vec3 m) {
    double least = 1;
    for (uint32_t h = p->ring_start[v]; h < p->ring_start[v + 1]; h++) {
        double slope = fabs(pir_vec_dot(m, p->direction[h]));
        least = slope < least ? slope : least;
    }
    return least;
}

/* The least sine of the edges from the origin of a halfedge but its own: from the one after it, all around. */
static inline double least_slope_beside(const pir_polytope *p, uint32_t half, pir_vec3 m) {
    const uint32_t *ring = &p->ring_start[p->origin[half]], start = ring[0], end = ring[1];
    double least = 1;
    for (uint32_t h = half, left = end - start - 1; left > 0; left--) {
        h = h + 1 < end ? h + 1 : start;
        double slope = fabs(pir_vec_dot(m, p->direction[h]));
        least = slope < least ? slope : least;
    }
    return least;
}

static inline bool is_sharp(const pir_polytope *p, pir_feature feature, pir_vec3 m, double sine) {
    if (feature.kind == PIR_FEATURE_VERTEX)
        return least_slope(p, feature.index, m) > sine;
    uint32_t half = p->edge_half[feature.index];
    // a segment's other edge is the same one
    return p->artificial || (least_slope_beside(p, half, m) > sine && least_slope_beside(p, p->twin[half], m) > sine);
}

static bool is_sharp_plain(const pir_polytope *p, pir_feature feature, pir_vec3 m, double sine) {
    return is_sharp(p, feature, m, sine);
}

/* Whether most vertices have four edges at most: one by one, these are looked at as fast. */
static inline bool is_sparse(const pir_polytope *p) {
    return p->half_count <= 4 * p->vertex_count;
}

bool pir_patch_is_sharp(const pir_patch *patch, pir_feature feature) {
    const pir_polytope *p = patch->polytope;
    pir_vec3 out = pir_patch_to_body(patch, patch->out);
    return is_sparse(p) ? is_sharp(p, feature, out, PIR_FLAT) : patch->version->is_sharp(p, feature, out, PIR_FLAT);
}

/* --- the shape of a facet --- */

static double fall_of(const pir_polytope *p, uint32_t f) {
    double least = 1;
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++) {
        uint32_t v = p->origin[p->loop[i]];
        for (uint32_t h = p->ring_start[v]; h < p->ring_start[v + 1]; h++)
            if (p->left[h] != f && pir_right(p, h) != f)
                least = fmin(least, -pir_vec_dot(p->direction[h], p->normal[f]));
    }
    return least;
}

static double least_apart(const pir_vec3 *at, uint32_t count) {
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < i; k++)
            least = fmin(least, pir_vec_length(pir_vec_sub(at[i], at[k])));
    return least;
}

/*
 * The double area of a corner's triangle, over the lengths of its two sides, is at most how far the corner stands out.
 * Over the square of the way around, it is at most the width of the facet over its length: the facet lies in a box of
 * that width and twice that length, which is at most half of the way around.
 */
static pir_facet_shape shape_of(const pir_patch *patch, uint32_t f) {
    const pir_polytope *p = patch->polytope;
    uint32_t start = p->loop_start[f], count = p->loop_start[f + 1] - start;
    pir_facet_shape shape = {0, 0, 0, 0};
    pir_vec3 at[PIR_CLIP_MOST];
    if (count > PIR_CLIP_MOST)
        return shape;
    for (uint32_t i = 0; i < count; i++)
        at[i] = patch->vertex[p->origin[p->loop[start + i]]];
    double thick = HUGE_VAL, around = 0, most = 0;
    for (uint32_t i = 0; i < count; i++) {
        pir_vec3 a = pir_vec_sub(at[i], at[i > 0 ? i - 1 : count - 1]);
        pir_vec3 b = pir_vec_sub(at[i + 1 < count ? i + 1 : 0], at[i]);
        double twice = pir_vec_length(pir_vec_cross(a, b));
        thick = fmin(thick, twice / (pir_vec_length(a) + pir_vec_length(b)));
        most = fmax(most, twice);
        around += pir_vec_length(b);
    }
    shape.fall = (float)fall_of(p, f);
    shape.thick = (float)thick;
    shape.wide = (float)(most / (around * around));
    shape.apart = (float)least_apart(at, count);
    return shape;
}

/* --- facets --- */

/*
 * Whether a shape says that its facet is the patch that grows from it. `off` is the square of how far its normal is
 * from `out`.
 */
static inline bool is_alone(const pir_facet_shape *shape, double off, double cosine, double snap) {
    double spare = shape->fall * (1 - COARSE) - PIR_FLAT - ROUNDING, seen = cosine * (1 - COARSE);
    return (spare > 0) & (off < spare * spare) & (seen * shape->thick > PIR_CLIP_CLEAR * snap) &
           (seen * shape->wide > PIR_FLUSH);
}

/* Sets the shape of the patch to that of a facet, which is not known. */
static void find_shape(pir_patch *patch, uint32_t f) {
    patch->shape = shape_of(patch, f);
    if (patch->kept)
        pir_kept_shape_set(&patch->kept[f], &patch->shape);
}

/* Whether f is the patch that grows from it; sets the patch's shape to that of f. */
static inline bool stands_alone(pir_patch *patch, uint32_t f, double off, double cosine) {
    if (!patch->kept || !pir_kept_shape_get(&patch->kept[f], &patch->shape))
        find_shape(patch, f);
    return is_alone(&patch->shape, off, cosine, patch->snap);
}

/*
 * Looks at the halfedges at v; `out` is a direction of the body. Which of them leads is a guess, so no branch asks.
 * *least becomes the least sine by which an edge there falls or rises, if that is less.
 */
static inline pir_foremost find_facing(const pir_polytope *p, uint32_t v, pir_vec3 out, pir_foremost most,
                                       double *least) {
    for (uint32_t h = p->ring_start[v]; h < p->ring_start[v + 1]; h++) {
        double slope = fabs(pir_vec_dot(out, p->direction[h]));
        *least = slope < *least ? slope : *least;
        double along = pir_vec_dot(p->normal[p->left[h]], out);
        most.half = along > most.cosine ? h : most.half;
        most.cosine = along > most.cosine ? along : most.cosine;
    }
    return most;
}

/* The facet that an edge grows by, as the halfedge before which it lies. */
static pir_foremost grown_by_edge(const pir_polytope *p, uint32_t half, pir_vec3 out, pir_foremost found) {
    double least = 1;
    found = find_facing(p, p->origin[half], out, found, &least);
    found = find_facing(p, p->target[half], out, found, &least);
    // one at a single end of the edge leaves the other end beside it
    uint32_t facet = found.half != UINT32_MAX ? p->left[found.half] : UINT32_MAX;
    if (facet != p->left[half] && facet != pir_right(p, half))
        found.half = UINT32_MAX;
    return found;
}

/* The facet that a sharp vertex grows by. */
static pir_foremost grown_by_vertex(const pir_polytope *p, uint32_t v, pir_vec3 out, double sine) {
    double least = 1;
    pir_foremost found = find_facing(p, v, out, (pir_foremost){UINT32_MAX, PIR_LEAST_COSINE}, &least);
    found.half = least > sine ? found.half : UINT32_MAX;
    return found;
}

/* The facet that a vertex or an edge grows by; none where either is not sharp. */
static inline pir_foremost grown_by(const pir_patch *patch, pir_feature feature, pir_vec3 out) {
    const pir_polytope *p = patch->polytope;
    pir_foremost none = {UINT32_MAX, PIR_LEAST_COSINE};
    if (feature.kind == PIR_FEATURE_EDGE)
        return patch->version->is_sharp(p, feature, out, PIR_FLAT)
                   ? grown_by_edge(p, p->edge_half[feature.index], out, none)
                   : none;
    return is_sparse(p) ? grown_by_vertex(p, feature.index, out, PIR_FLAT)
                        : patch->version->foremost(p, feature.index, out, PIR_FLAT);
}

bool pir_patch_single(pir_patch *patch, pir_feature feature, pir_single *ret_single) {
    const pir_polytope *p = patch->polytope;
    pir_vec3 out = pir_patch_to_body(patch, patch->out);
    if (p->artificial)
        return false;
    if (feature.kind == PIR_FEATURE_FACET) {
        pir_vec3 n = p->normal[feature.index], off = pir_vec_sub(out, n);
        *ret_single = (pir_single){feature.index, UINT32_MAX, pir_vec_dot(out, n)};
        return stands_alone(patch, feature.index, pir_vec_dot(off, off), ret_single->cosine);
    }
    pir_foremost found = grown_by(patch, feature, out);
    if (found.half == UINT32_MAX)
        return false;
    uint32_t half = found.half;
    *ret_single = (pir_single){p->left[half], feature.kind == PIR_FEATURE_VERTEX ? half : UINT32_MAX, found.cosine};
    // one that a vertex or an edge grows by is looked at across its own normal
    return stands_alone(patch, ret_single->facet, 0, found.cosine);
}

void pir_patch_set_single(pir_patch *patch, const pir_single *single, const pir_vec3 axis[3]) {
    const pir_polytope *p = patch->polytope;
    pir_vec3 u = pir_patch_to_body(patch, axis[0]), v = pir_patch_to_body(patch, axis[1]);
    pir_vec3 w = pir_patch_to_body(patch, axis[2]), n = p->normal[single->facet];
    double at_u = pir_vec_dot(axis[0], patch->at), at_v = pir_vec_dot(axis[1], patch->at);
    uint32_t start = p->loop_start[single->facet], count = p->loop_start[single->facet + 1] - start;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t a = p->origin[p->loop[start + i]];
        pir_vec3 x = patch->vertex[a];
        patch->corner[i].u = pir_vec_dot(u, x) + at_u;
        patch->corner[i].v = pir_vec_dot(v, x) + at_v;
        patch->corner[i].p = a;
    }
    const pir_corner *first = &patch->corner[0];
    double by = -1 / pir_vec_dot(n, w),
           from = pir_vec_dot(w, patch->vertex[first->p]) + pir_vec_dot(axis[2], patch->at);
    patch->along_u = by * pir_vec_dot(n, u);
    patch->along_v = by * pir_vec_dot(n, v);
    patch->height = from - patch->along_u * first->u - patch->along_v * first->v;
    patch->outline = (pir_outline){patch->corner, count};
}

/* The foremost facet at a feature. */
static uint32_t foremost(const pir_polytope *p, pir_feature feature, pir_vec3 out) {
    if (feature.kind == PIR_FEATURE_FACET)
        return feature.index;
    if (feature.kind == PIR_FEATURE_VERTEX) {
        double unused = 1;
        pir_foremost found = find_facing(p, feature.index, out, (pir_foremost){UINT32_MAX, 0}, &unused);
        return found.half != UINT32_MAX ? p->left[found.half] : PIR_NO_FACET;
    }
    uint32_t left = p->left[p->edge_half[feature.index]], right = pir_right(p, p->edge_half[feature.index]);
    return pir_vec_dot(p->normal[left], out) > pir_vec_dot(p->normal[right], out) ? left : right;
}

/* All edges of such a facet are flat, so the patch that grows from one of its vertices has all of them. */
uint32_t pir_patch_flat(pir_patch *patch, pir_feature feature) {
    const pir_polytope *p = patch->polytope;
    if (p->artificial)
        return PIR_NO_FACET;
    pir_vec3 out = pir_patch_to_body(patch, patch->out);
    uint32_t f = foremost(p, feature, out);
    if (f == PIR_NO_FACET)
        return f;
    pir_vec3 off = pir_vec_sub(out, p->normal[f]);
    double cosine = pir_vec_dot(out, p->normal[f]);
    bool flat = cosine > PIR_LEVEL_COSINE && stands_alone(patch, f, pir_vec_dot(off, off), cosine);
    return flat ? f : PIR_NO_FACET;
}

void pir_patch_set_flat(pir_patch *patch, uint32_t facet, const pir_vec3 axis[2], pir_corner *room) {
    const pir_polytope *p = patch->polytope;
    uint32_t start = p->loop_start[facet], count = p->loop_start[facet + 1] - start, least = 0;
    for (uint32_t i = 0; i < count; i++) {
        room[i] = pir_patch_corner(patch, p->origin[p->loop[start + i]], axis);
        least = pir_corner_before(&room[i], &room[least]) ? i : least;
    }
    // hulls begin there
    for (uint32_t i = 0; i < count; i++)
        patch->corner[i] = room[least + i < count ? least + i : least + i - count];
    patch->outline = (pir_outline){patch->corner, count};
    patch->facet = facet;
}

static bool place_plain(pir_patch *p, const pir_single *of_p, pir_patch *q, const pir_single *of_q,
                        const pir_vec3 axis[3], pir_clip_places *places) {
    pir_patch_set_single(p, of_p, axis);
    pir_patch_set_single(q, of_q, axis);
    return pir_clip_place(p->outline, q->outline, p->snap, places);
}

const pir_single_version pir_single_plain = {is_sharp_plain, grown_by_vertex, place_plain};

/* --- lone vertices --- */

/* A direction of one body, in its own frame, in the other's. */
static pir_vec3 carry(const pir_patch *from, const pir_patch *to, pir_vec3 d) {
    if (from->r)
        d = pir_mat_apply(from->r, d);
    return pir_patch_to_body(to, pir_vec_scale(d, from->sign));
}

/* The rising part of a vertex's facet, as its carrier sees it. */
struct rising {
    pir_vec3 at, edge[2]; /* the point under the vertex, and the two edges of the facet there */
    double rise[2];       /* what those rise by at least */
    double height, clear; /* how far up counts, and how clear of a side is clear enough */
    double least, wide;   /* what either edge rises by; all of it is nearer to the vertex than `wide` over that */
};

/* Whether all of that is over the inside of side h of the carrier. */
static inline bool is_within_side(const struct rising *rising, const pir_patch *carrier, pir_vec3 n, uint32_t h) {
    const pir_polytope *q = carrier->polytope;
    pir_vec3 in = pir_vec_cross(n, q->direction[h]);
    double from = pir_vec_dot(in, pir_vec_sub(rising->at, carrier->vertex[q->origin[h]])) - rising->clear;
    if (from * rising->least > rising->wide)
        return true;
    bool inside = from > 0;
    for (int k = 0; k < 2; k++) {
        double along = pir_vec_dot(in, rising->edge[k]);
        inside &= from * rising->rise[k] + along * rising->height > 0;
    }
    return inside;
}

/* Whether it is over the inside of all sides of a facet of the carrier with normal n. */
static inline bool is_within(const struct rising *rising, const pir_patch *carrier, uint32_t facet, pir_vec3 n) {
    const pir_polytope *q = carrier->polytope;
    for (uint32_t i = q->loop_start[facet]; i < q->loop_start[facet + 1]; i++)
        if (!is_within_side(rising, carrier, n, q->loop[i]))
            return false;
    return true;
}

bool pir_patch_is_lone(const pir_patch *vertex, const pir_single *of, const pir_patch *carrier, const pir_single *by,
                       const pir_lone_place *place) {
    if (of->half == UINT32_MAX || !(by->cosine > PIR_LEVEL_COSINE))
        return false;
    const pir_polytope *p = vertex->polytope;
    pir_vec3 n = carrier->polytope->normal[by->facet];
    struct rising rising;
    rising.height = place->height;
    for (int k = 0; k < 2; k++) {
        uint32_t half = k == 0 ? of->half : pir_ring_next(p, of->half);
        rising.edge[k] = carry(vertex, carrier, p->direction[half]);
        double rise = rising.rise[k] = pir_vec_dot(n, rising.edge[k]) - PIR_LEVEL;
        if (!(rise > PIR_FLUSH && rise * vertex->shape.apart * (1 - COARSE) > rising.height))
            return false;
    }
    rising.at = pir_patch_to_body(carrier, pir_vec_sub(place->at, carrier->at));
    rising.clear = place->coarse + PIR_CLIP_CLEAR * carrier->snap;
    rising.least = rising.rise[0] < rising.rise[1] ? rising.rise[0] : rising.rise[1];
    rising.wide = (1 + COARSE) * rising.height;
    return is_within(&rising, carrier, by->facet, n);
}
