/* SPDX-License-Identifier: MIT */
/* The pairs that an update has to look at: those of bodies that were moved or are fresh. */
#ifndef PIR_SCENE_ANSWER_CANDIDATES_H
#define PIR_SCENE_ANSWER_CANDIDATES_H

#include "scene/world/scene.h"

/* Makes the pairs that the pieces in scene->lists.replaced lack. PIR_ERR_MEMORY. */
pir_status pir_scene_find_pairs(pir_scene *scene);

/*
 * Looks at all pairs of the bodies in scene->lists.moved. Those that have to be asked go to the list `asked`, each with
 * its pir_pair; those that are certain to be no contact any more go to `ended`. Where there are threads the order of
 * both is not determined. Errors as pir_pair_create.
 */
pir_status pir_scene_list_questions(pir_scene *scene);

/* Notes a pair that has to be asked, or else one whose contact has ended, for a worker. PIR_ERR_MEMORY. */
pir_status pir_scene_note(pir_scene *scene, pir_scene_worker *worker, uint32_t pair, bool asks);

/* Drops the pairs of replaced pieces whose boxes in the tree do not meet, or that of a triangle wider by its skin. */
void pir_scene_drop_pairs(pir_scene *scene);

#endif
