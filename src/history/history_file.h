/* SPDX-License-Identifier: MIT */
/*
 * The file of a history, little endian:
 *
 *     "PIRHISTO"; u32 version, 0; u64 size of the whole, checksum of all bytes but its own (FNV-1a)
 *     notes, each u8 kind and what follows by it:
 *
 *     body       u32 size; so many bytes of exact OFF. Bodies are numbered as they come
 *     sum        u32 p, q; u8 difference; f64 rotation[4]
 *     rotate     f64 rotation[4]; u8 method
 *     tolerance  f64
 *     region     f64 axis[3], half_angle
 *     query      f64 translation[3], radius_p, radius_q, cutoff, margin
 *     pair       u32 p, q; u8 least, most
 *     ask        f64 rotation[4], translation[3] of P, of Q; radius_p, radius_q, cutoff, margin
 *     scene      u8 detail, approach + 2 · unions + 4 · whether it reuses manifolds; f64 margin, reuse where it does
 *     add        u8 kind, sensor + 2 · disabled; u32 category, mask; f64 radius, rotation[4], translation[3];
 *                u32 count, pieces
 *     remove     u32 body
 *     change     u32 body; u8 of what: 0 filter, 1 sensor, 2 disabled; u32 value[2]: category and mask, or 0 or 1 and 0
 *     update     u32 count; for each u32 body, f64 rotation[4], translation[3]
 *
 * A body stands before the note that first names it. The first note but bodies is sum, pair or scene.
 */
#ifndef PIR_HISTORY_HISTORY_FILE_H
#define PIR_HISTORY_HISTORY_FILE_H

#include <stdint.h>

#define PIR_HISTORY_VERSION 2u
#define PIR_HISTORY_LAST    3u /* of scenes that reuse manifolds */

#define PIR_HISTORY_HEADER      32
#define PIR_HISTORY_SIZE_AT     16
#define PIR_HISTORY_CHECKSUM_AT 24

#define PIR_HISTORY_MAGIC "PIRHISTO"

/* The most pieces of a body, and bodies in an update: those of scenes. */
#define PIR_HISTORY_PIECES_MAX 4096u
#define PIR_HISTORY_MOVES_MAX  ((uint32_t)1 << 20)

/* Bytes of a move. */
#define PIR_HISTORY_MOVE 60

typedef enum pir_note {
    PIR_NOTE_NONE = 0,
    PIR_NOTE_BODY,
    PIR_NOTE_SUM,
    PIR_NOTE_ROTATE,
    PIR_NOTE_TOLERANCE,
    PIR_NOTE_REGION,
    PIR_NOTE_QUERY,
    PIR_NOTE_PAIR,
    PIR_NOTE_ASK,
    PIR_NOTE_SCENE,
    PIR_NOTE_ADD,
    PIR_NOTE_REMOVE,
    PIR_NOTE_UPDATE,
    PIR_NOTE_CHANGE,
    PIR_NOTE_COUNT,
} pir_note;

/* The property that a note of a change is of. */
typedef enum pir_note_change {
    PIR_CHANGE_FILTER = 0,
    PIR_CHANGE_SENSOR,
    PIR_CHANGE_DISABLED,
} pir_note_change;

#endif
