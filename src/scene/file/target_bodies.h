/* SPDX-License-Identifier: MIT */
/*
 * The bodies of a scene made those of a snapshot: some stay and may change, some go, some are made of shapes that are
 * known.
 *
 * Invariant: until pir_target_commit all can be undone, and undoing needs no memory. Bodies that go leave the tree and
 * keep their pieces and pairs until then; bodies that come are undone as a whole.
 */
#ifndef PIR_SCENE_FILE_TARGET_BODIES_H
#define PIR_SCENE_FILE_TARGET_BODIES_H

#include "scene/file/snapshot.h"

/* A snapshot that is being read, whose checksum holds. */
typedef struct pir_snapshot {
    pir_snapshot_counts counts;
    const uint8_t *generation, *body, *user, *contact, *end;
    const uint8_t *kept, *behind; /* what contacts keep, or NULL; the end of all bytes */
    pir_report *report;
} pir_snapshot;

pir_snapshot_body pir_snapshot_body_at(const pir_snapshot *snapshot, uint32_t place);

/*
 * Checks all that is told of bodies, and brings the scene to it; those that have another pose or are to find pairs are
 * put on scene->lists.moved. PIR_ERR_FORMAT, PIR_ERR_ARGUMENT, PIR_ERR_LIMIT, PIR_ERR_MEMORY, told; what was done until
 * then has to be undone.
 */
pir_status pir_target_apply(pir_scene *scene, const pir_snapshot *snapshot);

/* After pir_scene_move_back, where bodies had been moved. */
void pir_target_undo(pir_scene *scene);

/* Before pairs are dropped; no pair that goes is in contact. */
void pir_target_commit(pir_scene *scene, const pir_snapshot *snapshot);

#endif
