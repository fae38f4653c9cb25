/* SPDX-License-Identifier: MIT */
/*
 * Scenes in bytes, little endian:
 *
 *     "PIRSCENE"; u32 version, numbers, bodies, users, contacts, ends; u64 checksum of all bytes but its own
 *     per number, up to the last that was ever given: u32 generation; one more of 0 where these are odd in number
 *     per body, by number:       u32 id, pieces; u8 kind, flags; u16 0; u32 category, mask, 0;
 *                                u64 user, hash of its shape; f64 radius, fast, quaternion[4], translation[3]
 *     of bodies with users of pieces, in their order, for each piece: u64 user
 *     per contact, by its key:   u64 of bodies, of pieces
 *     per contact that ended since the last update, by its key: u64 of bodies, of pieces, user[2], piece user[2],
 *                                whether of a sensor
 *     in version 4, of scenes with options.reuse: what each contact keeps (kept_bytes.h)
 *
 * A key holds the ids of both bodies, their numbers in front, and the numbers of both pieces (scene/world/scene.h). The
 * checksum is FNV-1a over words of eight bytes.
 */
#ifndef PIR_SCENE_FILE_SNAPSHOT_H
#define PIR_SCENE_FILE_SNAPSHOT_H

#include "scene/world/scene.h"

#define PIR_SNAPSHOT_MAGIC       "PIRSCENE"
#define PIR_SNAPSHOT_VERSION     3u /* without what contacts keep */
#define PIR_SNAPSHOT_LAST        4u /* with it */
#define PIR_SNAPSHOT_HEADER      40u
#define PIR_SNAPSHOT_CHECKSUM_AT 32u
#define PIR_SNAPSHOT_BODY        112u
#define PIR_SNAPSHOT_CONTACT     16u
#define PIR_SNAPSHOT_END         56u

/* Flags of a body. */
#define PIR_SNAPSHOT_SENSOR   1u
#define PIR_SNAPSHOT_DISABLED 2u
#define PIR_SNAPSHOT_FRESH    4u
#define PIR_SNAPSHOT_USERS    8u

/* How many of each there are. */
typedef struct pir_snapshot_counts {
    uint32_t numbers, bodies, users, contacts, ends;
} pir_snapshot_counts;

/* All that is written of one body, but for the users of its pieces. */
typedef struct pir_snapshot_body {
    uint32_t id, pieces, category, mask;
    uint8_t kind, flags;
    uint64_t user, shape;
    double radius, fast;
    pir_pose pose;
} pir_snapshot_body;

uint64_t pir_snapshot_checksum(const uint8_t *data, size_t size);

static inline uint64_t pir_snapshot_size(const pir_snapshot_counts *counts) {
    return PIR_SNAPSHOT_HEADER + 4 * ((uint64_t)counts->numbers + counts->numbers % 2) +
           (uint64_t)counts->bodies * PIR_SNAPSHOT_BODY + 8 * (uint64_t)counts->users +
           (uint64_t)counts->contacts * PIR_SNAPSHOT_CONTACT + (uint64_t)counts->ends * PIR_SNAPSHOT_END;
}

static inline uint64_t pir_snapshot_take(const uint8_t **at, int bytes) {
    uint64_t value = 0;
    for (int k = 0; k < bytes; k++)
        value |= (uint64_t) * (*at)++ << (8 * k);
    return value;
}

#endif
