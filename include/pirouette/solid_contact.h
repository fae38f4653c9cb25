/* SPDX-License-Identifier: MIT */
/**
 * Contacts of two bodies in convex pieces (pir_solid_decompose), both posed in the world, without ghosts.
 *
 * P meets Q exactly where its translation is in the union of the sums of all pairs of pieces. A contact of two pieces
 * whose facet of their sum lies inside of another sum is a ghost: no motion of P off Q needs its push. So inner walls
 * of both bodies, seams between pieces and pieces side by side give none (trimesh_contact.h has the theorem, and what
 * is decided exactly). Depths of overlaps, over all ways out of the union, are pir_solid_query_depth's.
 *
 * Q's pieces count as the surfaces of their vertices' doubles.
 *
 * Threads: an object belongs to one thread at a time, as its workspace does.
 */
#ifndef PIROUETTE_SOLID_CONTACT_H
#define PIROUETTE_SOLID_CONTACT_H

#include <stddef.h>
#include <stdint.h>

#include <pirouette/base.h>
#include <pirouette/pair.h>
#include <pirouette/solid.h>
#include <pirouette/workspace.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_solid_contacts pir_solid_contacts;

/** A contact: a point of a piece of P over a point of a facet of a piece of Q, along the normal. */
typedef struct pir_solid_contact {
    pir_vec3 point_p, point_q; /**< of the bodies without radii where they are apart; point_p = point_q + distance ·
                                    normal */
    pir_vec3 normal;           /**< unit, from Q to P */
    double distance;           /**< along the normal; negative where they overlap */
    uint32_t piece_p, piece_q;
    uint32_t facet_q; /**< of piece_q (pir_pieces_polytope); UINT32_MAX where P leaves past an edge or a corner of it */
    uint64_t id;      /**< of piece_p and the features that meet: unlike all others of a call, and the same from call to
                           call while these meet */
} pir_solid_contact;

/**
 * The object that finds contacts of two bodies. Both may be the same pieces.
 *
 * p, q          copied.
 * allocator     NULL for malloc.
 * ret_contacts  to be freed with pir_solid_contacts_destroy.
 *
 * Cost: that of pir_pieces_polytope for every piece, and O(n log n) for a tree of Q's n facets.
 * Errors: PIR_ERR_ARGUMENT, those of pir_pieces_polytope and of pir_trimesh_create.
 */
PIR_API pir_status pir_solid_contacts_create(const pir_pieces *p, const pir_pieces *q, const pir_allocator *allocator,
                                             pir_solid_contacts **ret_contacts);

/** Frees; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_solid_contacts_destroy(pir_solid_contacts *contacts);

/**
 * All contacts up to `margin` apart, the deepest first. Those of one normal, whichever pieces they are of, hold a great
 * area by at most four points, the deepest among them. Where bodies overlap there is one at least: at a ridge that
 * pieces of P share it may be that of the depth of the bodies alone (pir_solid_query_depth).
 *
 * workspace            scratch.
 * input                the poses of both, and radii, which count together; the cutoff does not count.
 * most, ret_contacts   how many there is room for, and the room; the deepest are written.
 * ret_count            how many there are; where that is more than `most`, the others are left out.
 *
 * Memory: grows to what the largest answer needs; then no call allocates.
 * Cost: that of pir_surface_contacts for each piece of P near Q, and O(c²) for c contacts of pieces.
 * Errors: those of pir_surface_contacts, and of pir_solid_query_depth.
 */
PIR_API pir_status pir_solid_contacts_find(pir_solid_contacts *contacts, pir_workspace *workspace,
                                           const pir_pair_input *input, size_t most, pir_solid_contact *ret_contacts,
                                           size_t *ret_count);

#ifdef __cplusplus
}
#endif

#endif
