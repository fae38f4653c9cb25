/* SPDX-License-Identifier: MIT */
/*
 * Contacts of pieces with unions, without ghosts: those of one piece with all triangles of surfaces, and with all
 * pieces side by side, that it is in contact with, are found together (unions.h, trimesh_contact.h).
 */
#ifndef PIR_SCENE_ANSWER_SURFACE_CONTACTS_H
#define PIR_SCENE_ANSWER_SURFACE_CONTACTS_H

#include "scene/world/scene.h"

/* Whether contacts of a pair that was found are left to this. */
bool pir_scene_is_with_surface(const pir_scene *scene, uint32_t pair);

/*
 * From what the workers found of such pairs makes their lists `on_surface`: a pair once, or more often where it has
 * contacts of several normals, or once without contacts where it has none. Errors: those of pir_surface_contacts.
 */
pir_status pir_scene_find_surface_contacts(pir_scene *scene);

#endif
