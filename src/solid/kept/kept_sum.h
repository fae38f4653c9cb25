/* SPDX-License-Identifier: MIT */
/*
 * A sum of solids that is kept while P turns: the table of signs, the sums of pairs, and for each plane of
 * candidates what bounds the sum there. A frame looks at what may have changed, and makes only that anew.
 *
 * A sum whose table has a sign that is 0 is degenerate: then, and for open sums, all is made anew (boundary.h).
 *
 * Invariants between updates that succeed:
 * - There is one facet for each plane of candidates, by the numbers of the planes.
 * - Every facet stands (kept_facet.h), and its edges are what bounds the sum in its plane.
 * - Points and planes of the space past `points`, `planes` are of no facet and no pair.
 */
#ifndef PIR_SOLID_KEPT_KEPT_SUM_H
#define PIR_SOLID_KEPT_KEPT_SUM_H

#include "exact/rotation.h"
#include "solid/kept/kept_glue.h"
#include "solid/space/rest.h"
#include "solid/sum/boundary.h"

typedef struct pir_kept_sum {
    pir_space *space;
    const pir_shell_body *body;
    pir_convexes *convexes;
    bool valid, has_boxes;
    pir_sign_table table;
    pir_kept_pairs pairs;
    pir_facet_maker maker;
    uint32_t *line[2];                 /* per edge of a body: the first on its line */
    pir_plane_facet **facet, **merged; /* merged: scratch, as is what follows */
    uint32_t count, room, merged_room;
    pir_plane_facet **spare; /* with the memory that they had */
    uint32_t spare_count, spare_room;
    bool is_listed; /* whether the facets' order by candidates is there */
    uint32_t *by_candidate, by_candidate_room;
    pir_kept_glue glue;
    pir_candidate_key *key; /* of all facets' candidates, by planes */
    uint32_t key_count, key_room;
    pir_candidate_key *key_before, *touched; /* scratch, as is what follows */
    uint32_t key_before_count, key_before_room, touched_count, touched_room, *order, order_room, *work, work_room;
    uint8_t *below;
    uint32_t below_room;
    pir_boxes boxes;    /* of the pairs' sums when P had turned by boxes_turn */
    pir_space_box *box; /* scratch, of as many */
    uint32_t box_room;
    double boxes_turn, near_until, skin;
    uint32_t *found;
    pir_quat rotation; /* of length 1 */
    double farthest;   /* a point of P from the axis of its turns, at most */
    uint32_t points, planes;
} pir_kept_sum;

/* Keeps a sum whose space has been turned to `rotation`, and makes all of it. False when nothing is kept: the rotation
 * is degenerate, or the space's status says why. */
bool pir_kept_sum_make(pir_kept_sum *kept, const pir_shell_body body[2], pir_convexes convexes[2], pir_quat rotation);

/* Likewise for a sum that is kept, whose space has been turned from the rotation before with all points and planes
 * kept (pir_rest_turn), after pir_kept_sum_begin. */
bool pir_kept_sum_update(pir_kept_sum *kept, pir_quat rotation);

/* Takes what others have added to the space since the last call out of it. */
void pir_kept_sum_begin(pir_kept_sum *kept);

/* Glues what bounds the sum in each plane, in the order in which candidates are made anew, to a boundary. False where
 * planes of two facets are one at this rotation, so that they are to be united; or the space's status says why. */
bool pir_kept_sum_glue(pir_kept_sum *kept, pir_sum_boundary *boundary);

void pir_kept_sum_finish(pir_kept_sum *kept);

/* A quaternion of length 1, and a bound on the angle between two rotations that are so long. */
pir_quat pir_quat_of_length_1(pir_quat q);
double pir_angle_between(pir_quat a, pir_quat b);

#endif
