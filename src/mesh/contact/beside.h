/* SPDX-License-Identifier: MIT */
/*
 * The other convex pieces of P's body, beside P in one frame. They meet nothing here themselves; P's contacts are
 * looked at for what the others hide.
 *
 * A contact of P along n is at a point x of P. It is of the body where the body is on one side of the plane through x
 * across n, near x. Pieces are convex and closed, and there are finitely many. So those that do not hold x have a
 * distance from it, and one that holds x has a point below the plane near x exactly where it has a vertex below. The
 * contact is a ghost where such a piece is there: x is on an inner wall, or at the rim of one.
 */
#ifndef PIR_MESH_CONTACT_BESIDE_H
#define PIR_MESH_CONTACT_BESIDE_H

#include "mesh/contact/contact_near.h"

/* Takes the other pieces of the input: their vertices, turned. PIR_ERR_MEMORY, PIR_ERR_LIMIT. */
pir_status pir_contact_take_beside(pir_contact_job *job);

/* Whether another piece hides the contact of a triangle that is not met, whose nearest points at a place these are. */
bool pir_contact_is_inner(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                          const pir_contact_near *near);

#endif
