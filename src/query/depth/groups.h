/* SPDX-License-Identifier: MIT */
/*
 * The pieces of the sum's pairing in groups of neighbours (group_lists.h), and their planes.
 *
 * A group of P's also has the edge pairs of its edges. Groups of Q begin at a whole block of lanes, behind empty
 * groups, so that all groups of a block are of one body.
 *
 * The planes of a group are made when they are asked for, and stay until pir_groups_forget.
 */
#ifndef PIR_QUERY_DEPTH_GROUPS_H
#define PIR_QUERY_DEPTH_GROUPS_H

#include <pirouette/query.h>

#include "dymsum/pairing/pairing.h"
#include "query/decide/piece_plane.h"
#include "query/depth/group_lists.h"
#include "query/depth/scan.h"

typedef struct pir_group {
    bool of_q;
    pir_group_range of; /* its parts of the lists */
    /* its planes, which are made where stamp is that of the groups; padded to whole blocks */
    uint32_t start, count;
    uint64_t stamp;
    uint64_t sieved; /* the stamp at which it was sieved last */
} pir_group;

/* Work space for one group: its edges rotated, and vectors of its planes. */
typedef struct pir_group_work {
    pir_lanes direction, origin;
    pir_lanes vector[3];
    uint32_t edges, capacity;
} pir_group_work;

typedef struct pir_groups {
    const pir_frame *frame;
    pir_exact *exact;
    const pir_pairing *pairing;
    const pir_scan *scan;
    uint64_t stamp; /* changes with every rotation, and whenever planes are forgotten */
    pir_group *at;
    /* groups of P from 0, groups of Q from first_of_q; each followed by empty ones up to whole lanes */
    uint32_t count, first_of_q;
    const pir_group_lists *lists[2]; /* P's and Q's, which belong to the polytopes */
    pir_group_work *work;            /* both are the thread's, see answer/follow.h */
    pir_planes *planes;
    uint32_t room_for; /* there is room for fewer crossings than this; 0 before there is any */
} pir_groups;

/* The lists that a group is a part of. */
static inline const pir_group_lists *pir_lists_of(const pir_groups *groups, const pir_group *group) {
    return groups->lists[group->of_q];
}

/*
 * Finds the lists of a frame's bodies, whose polytopes are p and q. `like` are those of the same bodies at another
 * scale, or NULL. PIR_ERR_MEMORY.
 */
pir_status pir_groups_find_lists(const pir_frame *frame, pir_polytope *const operand[2],
                                 const pir_group_lists *const like[2], const pir_group_lists *ret_lists[2]);

/* Sets the lists. The number of groups follows from them, and they replace only lists of as many. */
void pir_groups_set_lists(pir_groups *groups, const pir_group_lists *const lists[2]);

/* Makes the groups anew, with no planes. */
void pir_groups_fill(pir_groups *groups);

/*
 * Makes room for the planes of the present pairing, in the thread's memory: PIR_ERR_MEMORY. *ret_grown: what was there
 * is lost.
 */
pir_status pir_groups_reserve(pir_groups *groups, const pir_allocator *allocator, bool *ret_grown);

/* Frees work space. */
void pir_group_work_finish(pir_group_work *work, const pir_allocator *allocator);

/* Forgets all planes and everything else that is known for the present stamp. */
static inline void pir_groups_forget(pir_groups *groups) {
    groups->stamp++;
    groups->planes->used = 0;
}

/* The piece of a facet of P, and of a facet of Q, in the pairing. */
static inline pir_piece pir_piece_fv(const pir_groups *groups, uint32_t f) {
    return (pir_piece){PIR_FACET_FV, f, groups->pairing->fv[f]};
}

static inline pir_piece pir_piece_vf(const pir_groups *groups, uint32_t g) {
    return (pir_piece){PIR_FACET_VF, groups->pairing->vf[g], g};
}

/* --- planes of groups, and the piece that a cache keeps from query to query --- */

/* Makes the planes of group `g`, unless they are there. */
void pir_group_make(pir_groups *groups, uint32_t g);

/* Keeps a piece in a cache. Nothing changes where there is no cache, NULL, or no piece. */
void pir_piece_keep(pir_query_cache *cache, pir_piece piece);

/* The piece that a cache keeps, or a piece beside it where that is gone. False where the cache keeps none. */
bool pir_piece_cached(const pir_groups *groups, const pir_query_cache *cache, pir_piece *ret_piece);

/* The plane of that piece. */
bool pir_piece_recall(const pir_groups *groups, const pir_query_cache *cache, pir_plane *ret_plane);

#endif
