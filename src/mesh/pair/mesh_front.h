/* SPDX-License-Identifier: MIT */
/*
 * The front: pairs of items (a node's children, of P and of Q) with what they are known to be apart, and how much
 * motion that bears. Motion is counted as the path of P's middle in Q's frame and the sum of |ΔR|: no point at a
 * distance `reach` from the middle has moved farther than path + reach · turn.
 */
#ifndef PIR_MESH_PAIR_MESH_FRONT_H
#define PIR_MESH_PAIR_MESH_FRONT_H

#include "mesh/pair/node_bounds.h"

/*
 * Along n the items are apart by at least n · (r·middle + t) − taken − radius · (turn − made): P's item turns
 * about its own middle, so that little is lost while that moves across n.
 */
typedef struct pir_front_entry {
    pir_mesh_item p, q;
    float n[3], taken; /* n is the direction that proved it; four floats that are read at once */
    float middle[3], radius;
    float made;
} pir_front_entry;

typedef struct pir_mesh_front {
    pir_front_entry *entry;
    float *key, *reach; /* see trimesh_pair.h */
    uint32_t *expired;  /* entries that are looked at in a call */
    uint32_t count, room;
    uint32_t built; /* entries when it was made from the roots */
    double path, turn;
    pir_mat3 r; /* the relative pose of the last call */
    pir_vec3 middle;
} pir_mesh_front;

void pir_mesh_front_finish(pir_mesh_front *front, const pir_allocator *allocator);

/* Counts the motion since the last call. */
void pir_mesh_front_move(pir_mesh_front *front, const pir_mesh_frame *frame, pir_vec3 about);

/* Adds an entry that is apart by `bound` now. False when out of memory. */
bool pir_mesh_front_add(pir_mesh_front *front, const pir_allocator *allocator, const pir_front_entry *entry,
                        float reach, float bound);

/* Sets what an entry is apart by now. */
void pir_mesh_front_renew(pir_mesh_front *front, uint32_t i, float bound);

/* Takes an entry out; the last one takes its place. */
void pir_mesh_front_drop(pir_mesh_front *front, uint32_t i);

/* Lists entries, from the last to the first, that may be apart by no more than `most`; how many they are. */
uint32_t pir_mesh_front_expired(pir_mesh_front *front, double most);

/*
 * Renews all that are listed, by what their directions still prove. Those that are apart by no more than `most` stay in
 * the list; how many they are.
 */
uint32_t pir_mesh_front_renew_along(pir_mesh_front *front, const pir_float_frame *frame, uint32_t count, float most);

#endif
