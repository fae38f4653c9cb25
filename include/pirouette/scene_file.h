/* SPDX-License-Identifier: MIT */
/**
 * Snapshots of scenes: which bodies there are, where they are, and what is in contact, in bytes. A game that rolls back
 * restores one and goes on; the updates after it give the events that they gave before, bit for bit, and bodies that
 * are added get the ids that they got before.
 *
 * A snapshot names the shape of a body, its pieces or its surface, by a hash of the content. A restore drops bodies
 * that the snapshot does not have, and makes those that the scene lacks, of shapes that it keeps (keep_shapes of
 * pir_scene_options, pir_scene_keep) or of another body. Bytes are the same on every machine, and two scenes in one
 * state have the same bytes, whatever their history: a hash of them is a hash of the state. Ids are of the state.
 *
 * Threads: as of the scene.
 */
#ifndef PIROUETTE_SCENE_FILE_H
#define PIROUETTE_SCENE_FILE_H

#include <pirouette/base.h>
#include <pirouette/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How many bytes pir_scene_serialise writes now. O(bodies + pairs). */
PIR_API size_t pir_scene_serialised_size(const pir_scene *scene);

/**
 * Writes bodies, poses and contacts, with a version and a checksum; of a scene with options.reuse also what contacts
 * keep.
 *
 * memory, size  the caller's, of exactly pir_scene_serialised_size bytes.
 *
 * Cost: O(bodies + pairs).
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_MEMORY (room to sort, the first time).
 */
PIR_API pir_status pir_scene_serialise(pir_scene *scene, void *memory, size_t size);

/**
 * Brings a scene to the state of a snapshot. The bytes are not trusted: what they say of poses is checked as in an
 * update. Contacts that they claim are only what the next update compares with. What contacts keep is checked for its
 * form alone: a scene with options.reuse tells it again as if it had been found there. The list of events is empty
 * afterwards, also where the call fails.
 *
 * A body of the scene stays where it has the id, the kind, the radius and the shape of one of the snapshot; poses,
 * categories, masks, users, and whether it is a sensor or disabled, become what they were. Others are dropped without
 * events. A surface does not take the place of another one under the same number. A scene with other options, such as a
 * margin, gives other events.
 *
 * data, size  the bytes, which may come from anyone.
 * report      filled with what, where and why; NULL for the report of the scene, where it has one.
 *
 * Cost: O(bodies + contacts), and of bodies whose poses differ that of an update without the queries of pairs.
 *
 * Errors: PIR_ERR_ARGUMENT (a body whose shape is not known, told by its id), PIR_ERR_FORMAT, PIR_ERR_VERSION,
 * PIR_ERR_MEMORY. The scene is then as it was.
 */
PIR_API pir_status pir_scene_restore(pir_scene *scene, const void *data, size_t size, pir_report *report);

/**
 * Keeps the shape of a body without adding one, so that a snapshot of another scene can be restored.
 *
 * body  as of pir_scene_add; only its pieces, coarse bodies or surface count, and are referenced.
 *
 * Cost: O(vertices of the pieces, or triangles).
 *
 * Errors: as of pir_scene_add.
 */
PIR_API pir_status pir_scene_keep(pir_scene *scene, const pir_body_options *body);

/** Drops all shapes that a scene keeps; those of its bodies stay known for as long as they are there. O(shapes). */
PIR_API void pir_scene_forget_shapes(pir_scene *scene);

#ifdef __cplusplus
}
#endif

#endif
