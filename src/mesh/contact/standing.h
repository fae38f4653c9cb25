/* SPDX-License-Identifier: MIT */
/*
 * The normals along which P is pushed, the deepest first, each with the triangle whose contact it is.
 *
 * Where P is apart from all that counts, they are those of the union (ghost.h). Contacts are looked at by rising gap. A
 * normal that is there already is not looked at again, for of one normal the nearest contact alone is kept: on flat
 * ground one contact is judged, however many triangles there are.
 *
 * Where P is stuck, which is where no way out of what it meets was found, no place says what a ghost is. Each triangle
 * that is met then pushes across its own plane: a one-sided one to its front, another one to the side that is nearer.
 */
#ifndef PIR_MESH_CONTACT_STANDING_H
#define PIR_MESH_CONTACT_STANDING_H

#include "mesh/contact/way_out.h"

/* Normals of one call, at most. */
#define PIR_CONTACT_NORMALS 64

typedef struct pir_standing {
    uint32_t triangle;
    double gap; /* where the input has P */
    pir_vec3 normal, point;
    pir_contact_simplex simplex; /* of the nearest points; of a vertex and a face where P is stuck */
} pir_standing;

typedef struct pir_standings {
    pir_standing at[PIR_CONTACT_NORMALS];
    uint32_t count;
} pir_standings;

/* Whether two unit normals are so near to each other that they count as one: this chooses points only. */
bool pir_contact_same_normal(pir_vec3 a, pir_vec3 b);

/* Of P at the end of a way out, which was looked at. False when out of memory. */
bool pir_contact_find_standings(pir_contact_job *job, const pir_way_out *out, pir_standings *ret);

/* Of P that is stuck where the input has it, which was looked at. */
void pir_contact_find_stuck(pir_contact_job *job, pir_standings *ret);

/*
 * The contact of a triangle that P, where it was looked at, touches, with a normal that parts them: false where there
 * is none. Others may keep P from moving along it.
 */
bool pir_contact_find_touch(pir_contact_job *job, pir_vec3 t, pir_standing *ret);

#endif
