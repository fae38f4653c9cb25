/* SPDX-License-Identifier: MIT */
/*
 * Which contacts are ghosts.
 *
 * P's contact with a triangle T along n is that of their nearest points: P moved by −(the way) touches T at x, and n
 * separates them. It is true where n separates P, so moved, from every triangle that it meets (trimesh_contact.h has
 * the theorem and its proof). The plane through x across n has all of P, so moved, on one side or in it. So n separates
 * P from a triangle exactly when no corner of that rises over this plane: P drops out of this sign. Triangles that rise
 * are asked whether P meets them there. One that has all the corners that x lies between certainly is met.
 *
 * A one-sided triangle pushes to its front: n must not lead into its own back. Into that of another it may: at an acute
 * edge of a solid the normal of either facet does.
 */
#ifndef PIR_MESH_CONTACT_GHOST_H
#define PIR_MESH_CONTACT_GHOST_H

#include "mesh/contact/contact_near.h"

/*
 * Whether a contact stands: that of triangle `index`, whose `near` is that at t. Where another triangle only hides the
 * facet of D that the contact is on, the facet is looked at beside it too, within the margin: n is that of the whole
 * facet.
 */
bool pir_contact_stands(pir_contact_job *job, pir_vec3 t, uint32_t index);

#endif
