/* SPDX-License-Identifier: MIT */
/**
 * Snapshots of scenes: where all bodies are, and what is in contact, in bytes. A game that rolls back restores one and
 * goes on; the updates after it give the events that they gave before, bit for bit.
 *
 * A snapshot does not hold polytopes. It is restored into a scene with the same bodies under the same numbers: the one
 * that it was taken of, or one to which the same bodies were added. Bytes are the same on every machine, and two scenes
 * in one state have the same bytes, whatever their history: a hash of them is a hash of the state.
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
 * Writes poses and contacts, with a version and a checksum.
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
 * update. Contacts that they claim are only what the next update compares with. The list of events is empty afterwards,
 * also where the call fails.
 *
 * Bodies of the scene have to have the numbers, the kinds and the counts of pieces that they had, and a surface the
 * same content. All else of them is not in the bytes and not checked: polytopes, radii, categories, masks and sensors.
 * Where these differ, the updates afterwards do too.
 *
 * data, size  the bytes, which may come from anyone.
 * report      filled with what, where and why; NULL for the report of the scene, where it has one.
 *
 * Cost: that of an update of all bodies without the queries of pairs.
 *
 * Errors: PIR_ERR_ARGUMENT (the scene has other bodies), PIR_ERR_FORMAT, PIR_ERR_VERSION,
 * PIR_ERR_MEMORY. The scene is then as it was.
 */
PIR_API pir_status pir_scene_restore(pir_scene *scene, const void *data, size_t size, pir_report *report);

#ifdef __cplusplus
}
#endif

#endif
