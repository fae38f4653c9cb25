/* SPDX-License-Identifier: MIT */
/* Hashes of what calls give: FNV-1a over numbers of eight bytes in one order, on from `hash`. */
#ifndef PIR_HISTORY_REPLAY_HASH_H
#define PIR_HISTORY_REPLAY_HASH_H

#include <pirouette/query.h>
#include <pirouette/scene.h>
#include <pirouette/sum.h>

/* Pairing and shortfall of a sum; `pairs` has room for its ee pairs. */
uint64_t pir_replay_hash_sum(uint64_t hash, const pir_sum *sum, uint32_t (*pairs)[2]);

/* An answer without the steps that it took. */
uint64_t pir_replay_hash_answer(uint64_t hash, const pir_query_result *answer);

uint64_t pir_replay_hash_contacts(uint64_t hash, const pir_contact *contacts, size_t count);

/* The events of a scene's last update. */
uint64_t pir_replay_hash_events(uint64_t hash, const pir_scene *scene);

#endif
