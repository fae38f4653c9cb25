/* SPDX-License-Identifier: MIT */
/*
 * Unions: what a piece is in contact with that is asked about together, since one part may hide contacts of another.
 *
 * All triangles of surfaces with one radius are one union. Convex pieces of bodies that do not move, and those of one
 * moving body, join where their boxes meet, with one another and with triangles. Bodies that move each on their own are
 * no union, for what one hides the other may uncover. Two pieces alone are none where both are whole bodies or the one
 * that asks is: nothing hides their contacts.
 */
#ifndef PIR_SCENE_ANSWER_UNIONS_H
#define PIR_SCENE_ANSWER_UNIONS_H

#include "scene/world/scene.h"

/*
 * Lists what was found with parts of unions, by the piece that asks; keys hold its number, the other's body and its
 * number there. There is room. The number of items.
 */
uint32_t pir_scene_list_union_items(pir_scene *scene);

/* The other piece of an item. */
const pir_scene_piece *pir_scene_union_part(const pir_scene *scene, const pir_scene_item *item);

/* Sets `group` of all items of one piece: the number of the first item of the same union. */
void pir_scene_group_items(const pir_scene *scene, pir_scene_item *item, uint32_t count);

#endif
