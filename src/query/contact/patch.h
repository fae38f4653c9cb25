/* SPDX-License-Identifier: MIT */
/*
 * The contact patch of a body: the part of its surface that faces the other body where the features of an answer lie.
 *
 * Bodies from modelling programs have facets that are coplanar but for rounding. So a patch grows over vertices: from
 * those of the answer's feature along all edges that are nearly in the contact plane. It is a vertex, a segment, or
 * an area of one facet or more.
 */
#ifndef PIR_QUERY_CONTACT_PATCH_H
#define PIR_QUERY_CONTACT_PATCH_H

#include <pirouette/query.h>

#include "base/layout.h"
#include "base/vec.h"
#include "polytope/polytope.h"
#include "query/contact/clip.h"
#include "query/frame/facet_shape.h"

/*
 * Tolerances. Contact manifolds are floating answers, and which corners belong together is a question of scale.
 *
 * PIR_FLAT: an edge lies in the plane of a patch when the sine of their angle is at most this, 0.056°. Coordinates
 * that are rounded to single precision, or to six digits in a file, tilt the triangles of a facet by up to 1e-4.
 * Facets that are meant to differ do so by 0.1° and more on bodies of up to some thousand facets around.
 *
 * PIR_FLUSH: a patch narrower than this part of its length is a segment. Edges at a smaller angle are parallel.
 * Corners that rise by less than this part of their way from the answer's point are as near as that point. It is
 * above what single precision leaves of 0, and below what is visible.
 *
 * PIR_STEEP: a facet whose normal has a smaller cosine with the contact normal is steep. No patch grows by it, because
 * rounding over that cosine is the error of heights on it.
 *
 * PIR_SNAP: points of the contact plane closer than this, relative to the placement's reach, are one. Rounding leaves
 * 2^-46.
 *
 * PIR_OVER: two points of a contact are over each other when their distance across the normal is at most this many
 * times PIR_SNAP of the reach. Merging puts them up to 5 apart.
 */
#define PIR_FLAT  0x1p-10
#define PIR_FLUSH 0x1p-20
#define PIR_STEEP 0x1p-10
#define PIR_SNAP  0x1p-44
#define PIR_OVER  8

#define PIR_NO_FACET UINT32_MAX

typedef struct pir_single_version pir_single_version; // single.h

/* The plane of a facet in its place. */
typedef struct pir_patch_plane {
    uint32_t facet;
    pir_vec3 n, from;   /* its normal, and a point of it */
    double along, more; /* the cosine of n and `out`, how far the plane is moved out */
} pir_patch_plane;

/* The most planes that are kept of a patch: of its first facet, then of those beside it. */
#define PIR_PATCH_PLANES 17

typedef struct pir_patch {
    const pir_single_version *version;
    /* the body in its place. P is stored reflected, so its sign is −1. Q is not rotated: its r is NULL. */
    const pir_polytope *polytope;
    const pir_vec3 *vertex;
    pir_kept_shape *kept; /* per facet, or NULL */
    const pir_mat3 *r;
    double sign;
    pir_vec3 at;
    pir_vec3 out; /* unit, towards the other body */
    double snap;

    uint32_t *member; /* its vertices */
    uint32_t members;
    bool *is_member;
    uint32_t facet; /* the facet that faces `out` most, from which a search for the surface starts; or PIR_NO_FACET */
    pir_corner *corner;
    pir_outline outline;
    pir_facet_shape shape;           /* of the last facet that was asked for as a single one */
    double height, along_u, along_v; /* of a single facet's plane over the contact plane's origin, and its slopes */
    uint32_t planes;                 /* so many are known; 0 for none */
    bool is_split;                   /* one of them is coplanar with the first but for rounding */
    pir_patch_plane plane[PIR_PATCH_PLANES];
} pir_patch;

/* Memory for the patches of a query and what they share; zeros at first. */
typedef struct pir_patch_room {
    pir_patch p, q;
    pir_corner *shared, *hull;
    size_t of_p, of_q; /* for bodies of so many vertices */
} pir_patch_room;

/* Makes room for bodies of so many vertices; it never shrinks. False when out of memory: the room is as it was. */
bool pir_patch_room_grow(pir_patch_room *room, const pir_allocator *allocator, size_t of_p, size_t of_q);

/* Makes room, unless there is enough. */
static inline bool pir_patch_room_reserve(pir_patch_room *room, const pir_allocator *allocator, size_t of_p,
                                          size_t of_q) {
    return (of_p <= room->of_p && of_q <= room->of_q) || pir_patch_room_grow(room, allocator, of_p, of_q);
}
void pir_patch_room_finish(pir_patch_room *room, const pir_allocator *allocator);

/* A direction of the queries' frame in the body's own frame. */
static inline pir_vec3 pir_patch_to_body(const pir_patch *patch, pir_vec3 d) {
    if (patch->r)
        d = pir_mat_apply_transposed(patch->r, d);
    return pir_vec_scale(d, patch->sign);
}

/* Vertex v in its place, in the frame of queries. */
static inline pir_vec3 pir_patch_vertex(const pir_patch *patch, uint32_t v) {
    pir_vec3 x = patch->vertex[v];
    if (patch->r)
        x = pir_mat_apply(patch->r, x);
    return pir_vec_add(pir_vec_scale(x, patch->sign), patch->at);
}

/* A vertex as a corner: its coordinates along two axes. */
static inline pir_corner pir_patch_corner(const pir_patch *patch, uint32_t v, const pir_vec3 axis[2]) {
    pir_vec3 x = pir_patch_vertex(patch, v);
    return (pir_corner){.u = pir_vec_dot(axis[0], x), .v = pir_vec_dot(axis[1], x), .p = v};
}

/*
 * Grows the patch from a feature of the body, whose index must be in range, along edges that are nearly across `out`.
 */
void pir_patch_grow(pir_patch *patch, pir_feature feature);

/*
 * Grows the patch by one facet: the one that faces `out` most, of those that have a vertex outside of the patch, and
 * what is flat with it. A vertex at which no facet faces out grows by an edge. False when there is nothing to grow
 * by.
 */
bool pir_patch_extend(pir_patch *patch);

/*
 * Makes whole a patch that has an area on a tilted facet. Of a facet with many corners some edges are nearly across
 * `out` while the facet is not, so that growing takes only a part of it: the facet that faces `out` most is taken, and
 * what is flat with it. False where that changes nothing.
 */
bool pir_patch_complete(pir_patch *patch);

/* Sets the outline in coordinates along two axes of the contact plane. axis[0] × axis[1] is the normal from Q to P. */
void pir_patch_set_outline(pir_patch *patch, const pir_vec3 axis[2], pir_corner *room);

/* Finds the planes around the first facet once for many points to lift, until the patch or its place changes. */
void pir_patch_look_around(pir_patch *patch);

/* The point of the surface that x moves to along `out`. x lies beside a point of the patch. */
pir_vec3 pir_patch_lift(const pir_patch *patch, pir_vec3 x);

/*
 * The point of the surface over or under any x near the patch. False where the line through x along `out` passes the
 * body by more than PIR_OVER · snap, or meets a facet at a cosine below PIR_LEAST_COSINE.
 */
bool pir_patch_find(const pir_patch *patch, pir_vec3 x, pir_vec3 *ret_point);

/* The point of the surface over the point at fraction t of side `side` of the outline. */
pir_vec3 pir_patch_side(const pir_patch *patch, uint32_t side, double t);

/* Removes all members. */
void pir_patch_clear(pir_patch *patch);

#endif
