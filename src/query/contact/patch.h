/* SPDX-License-Identifier: MIT */
/*
 * The contact patch of a body: the part of its surface that faces the other body where an answer has its features.
 *
 * Bodies that come from modelling programs have facets that are coplanar but for rounding. A patch is therefore grown
 * over vertices: from those of the answer's feature along all edges that are nearly in the contact plane. It is a
 * vertex, a segment, or an area that covers one facet or several.
 */
#ifndef PIR_QUERY_CONTACT_PATCH_H
#define PIR_QUERY_CONTACT_PATCH_H

#include <pirouette/query.h>

#include "base/layout.h"
#include "base/vec.h"
#include "polytope/polytope.h"
#include "query/contact/outline.h"

/*
 * Tolerances. Contact manifolds are floating answers, and which corners belong together is a question of scale.
 *
 * PIR_FLAT: an edge is in the plane of a patch when the sine of their angle is at most this, 0.056°. Coordinates
 * rounded to single precision, or to six digits in a file, tilt the triangles of a facet by up to 1e-4; facets that
 * are meant to differ do so by 0.1° and more, up to some thousand of them around a body.
 *
 * PIR_FLUSH: a patch that is narrower than this part of its length is a segment; edges at a smaller angle are
 * parallel; corners that rise by less than this part of their way from the answer's point are as near as it is. It is
 * above what single precision leaves of 0, and below what is seen.
 *
 * PIR_STEEP: a facet whose normal has a smaller cosine with the contact's stands upright. It has no place in a patch,
 * for points on it are known to rounding over that cosine only.
 *
 * PIR_SNAP: points of the contact plane closer than this, relative to the placement's reach, are one. Rounding leaves
 * 2^-46 of it.
 */
#define PIR_FLAT  0x1p-10
#define PIR_FLUSH 0x1p-20
#define PIR_STEEP 0x1p-10
#define PIR_SNAP  0x1p-44

#define PIR_NO_FACET UINT32_MAX

typedef struct pir_patch {
    /* the body as it stands: P is kept reflected, so its sign is −1; Q is not turned, r being NULL */
    const pir_polytope *polytope;
    const pir_vec3 *vertex;
    const pir_mat3 *r;
    double sign;
    pir_vec3 at;
    pir_vec3 out; /* unit, towards the other body */
    double snap;

    uint32_t *member; /* its vertices */
    uint32_t members;
    bool *is_member;
    uint32_t facet; /* the one most along `out`, from which points are looked for; PIR_NO_FACET where none faces out */
    pir_corner *corner;
    pir_outline outline;
} pir_patch;

/* Room for the patches of a query and what they share. */
typedef struct pir_patch_room {
    pir_patch p, q;
    pir_corner *shared, *hull;
} pir_patch_room;

/* False when out of memory: pir_patch_room_finish frees what is there. Begins with a room of zeros. */
bool pir_patch_room_init(pir_patch_room *room, const pir_allocator *allocator, const pir_polytope *p,
                         const pir_polytope *q);
void pir_patch_room_finish(pir_patch_room *room, const pir_allocator *allocator, const pir_polytope *p,
                           const pir_polytope *q);

/* Vertex v where it stands, in the frame of queries. */
pir_vec3 pir_patch_vertex(const pir_patch *patch, uint32_t v);

/* Grows the patch from a feature of the body, whose index must be in range, by edges across `out`. */
void pir_patch_grow(pir_patch *patch, pir_feature feature);

/*
 * Grows it further: by the facet most along `out` of those that lead away from it, and what is flat with that. A vertex
 * at which no facet faces out grows by an edge. False when there is none.
 */
bool pir_patch_extend(pir_patch *patch);

/* Sets the outline along axes of the contact plane, `axis[0]` × `axis[1]` being the normal from Q to P. */
void pir_patch_set_outline(pir_patch *patch, const pir_vec3 axis[2], pir_corner *room);

/* The point of the surface that x comes to along `out`, x being beside a point of the patch. */
pir_vec3 pir_patch_lift(const pir_patch *patch, pir_vec3 x);

/* The point of the surface over part t of side `side` of the outline. */
pir_vec3 pir_patch_side(const pir_patch *patch, uint32_t side, double t);

/* Leaves the patch without members. */
void pir_patch_clear(pir_patch *patch);

#endif
