/* SPDX-License-Identifier: MIT */
/*
 * Answers and contacts of earlier updates, used again.
 *
 * Let no point of one body have moved by more than m relative to the other since an answer. The signed distance is the
 * greatest, over unit directions n, of how far the bodies are apart along n, which is below 0 where they overlap along
 * n. (Apart: the direction of the closest points; overlapping: that of the least depth.) Each of these changes by at
 * most m, so the signed distance does. Hence:
 *
 *   - A distance d was, and is one that is below 0, above 0, or within the margin, when d − m and d + m are both.
 *   - Bodies that were apart by d along n are apart by d − m along it, and the signed distance is at most d + m: no
 *     direction is better than n by more than 2m.
 *   - Bodies that are apart along the n of then share no point, and are no farther apart than two of their points. This
 *     holds however far they have moved, and is tried where the first does not.
 */
#ifndef PIR_SCENE_REUSE_CARRIED_H
#define PIR_SCENE_REUSE_CARRIED_H

#include "scene/world/scene.h"

/* Whether the kept answer of a pair, whose bodies are seen so, still tells its state. Then the numbers of `found`,
   which holds the pair, are set to it. */
bool pir_carry_answer(const pir_scene *scene, const pir_seen *seen, pir_scene_found *found);

/* Whether the bodies of a pair have moved by at most options.reuse between two views; *ret_moved is the bound. */
bool pir_is_near_kept(const pir_scene *scene, uint32_t pair, const pir_seen *seen, const pir_seen *kept,
                      double *ret_moved);

/* Adds the contacts of the event that begins at *at of a record to those of a worker and to `found`, and moves *at
   behind them. PIR_ERR_MEMORY. */
pir_status pir_carry_event(pir_scene *scene, pir_scene_worker *worker, const pir_kept_record *record, uint32_t *at,
                           pir_scene_found *found);

/*
 * Contacts of a union that stand: those of a run of items of one piece, where the same pairs were in contact when they
 * were found and all bodies are near the places that they had then. *ret_carried is whether they were.
 */
pir_status pir_carry_union(pir_scene *scene, pir_scene_worker *worker, pir_scene_item *item, uint32_t count,
                           bool *ret_carried);

#endif
