/* SPDX-License-Identifier: MIT */
/*
 * Whether a body can be moved between two poses by translations and any turns, between closed bodies.
 *
 * First some straight ways are pushed to where the robot has room (plan/band): most paths are found so, in a time that
 * hardly depends on how narrow they are. Where none is, boxes are made.
 *
 * Then walls with holes that are too narrow are looked for (plan/opening), which have three degrees of freedom, not
 * six. Where there is none of these, or it is not decided:
 *
 * Rotations are divided into boxes (rotation_box.h). For each box the translations are divided for inner sums
 * (inner_sums.h): what they have is blocked at every rotation of the box. Free cells of boxes that share a rotation
 * are joined unless they are proven to be apart. Where the ends are not connected, there is no path.
 *
 * A *hub* is a free place at the middle of a box. A box has those of the box that it is a part of, where the robot can
 * turn from one middle to the other on the spot, which outer pieces over the arc between them prove. Of the first
 * boxes, and of cubes that are doubted, the translations are divided for the robot at the middle; then each connected
 * part is a hub, joined with others by turns at translations that both have. Where the ends are connected through hubs
 * there is a path: translations at middles, and turns where the robot stands. Hubs stay when their box is divided, for
 * what they prove stays true.
 *
 * Else boxes are divided where that may decide. Free parts of boxes are nodes of a graph, of which hubs tell that some
 * can be reached from the start, others from the end. Nodes on shortest ways from the first to the second are doubted:
 * a path may lead through them, or they block too little. A box with a way of its own is halved. Where ways are left
 * only from box to box, those on the shortest ones are asked to block translations that parts on both sides of a link
 * share, and are made anew with more or wider sums. A link of which neither box can do that has the larger one halved.
 * Only new boxes are looked at.
 *
 * Symmetries (symmetries.h) map leaves to leaves: those of an orbit stand beside each other, the image of leaf i under
 * symmetry k is leaf i ^ k, and all are divided at once. What their boxes have in common the first of them has: inner
 * parts, which leaves it touches, the links. The others have the images of these.
 *
 * So PATH and NO_PATH are both proven, and cannot both be. UNKNOWN is said where boxes, parts or memory end first, or
 * all boxes in doubt are the finest ones. The answer and what proves it are the same for any number of threads: boxes
 * are made by themselves, and joined in order.
 */
#ifndef PIR_PLAN_RIGID_RIGID_PLAN_H
#define PIR_PLAN_RIGID_RIGID_PLAN_H

#include <pirouette/plan.h>
#include <pirouette/workspace.h>

#include "plan/blocks/block_work.h"
#include "plan/rigid/inner_division.h"
#include "plan/rotations/rotation_box.h"

/* Another leaf that a leaf touches; links join parts of both, each numbered as in the first of its orbit. */
typedef struct pir_rigid_touch {
    uint32_t other, links;
    uint32_t (*link)[2]; /* own part, the other's */
    bool is_linked;
} pir_rigid_touch;

/* A link in doubt of which a box is to block the translations that both parts share. */
typedef struct pir_rigid_ask {
    uint32_t part, other, other_part;
} pir_rigid_ask;

/* A free place at a middle: any one of a connected part, if these are known. */
typedef struct pir_rigid_hub {
    double at[3];
    uint32_t node, in; /* its number; the part of the box's inner ones that it is in, or none */
} pir_rigid_hub;

/* A box of rotations. One that was divided keeps its hubs. What is marked with * the first of an orbit alone has. */
typedef struct pir_rigid_leaf {
    pir_rotation_box box;
    bool is_divided, is_full; /* whether hubs are those of the parts at the middle, the first ones */
    bool is_open, is_spent;   /* whether inner sums leave a way between the ends; whether no more help * */
    bool is_due;              /* whether it is to be divided */
    uint32_t end[2];          /* the inner parts that have the ends' translations, or none */
    uint32_t parent;          /* PIR_PLAN_NONE of roots */
    pir_inner_list list;      /* * */
    pir_box_parts inner;      /* for the inner sums of the list * */
    pir_box_parts middle;     /* at the middle, where it is full, or another of the orbit is * */
    pir_rigid_hub *hub;
    uint32_t node;          /* the first */
    pir_rigid_touch *touch; /* * */
    uint32_t touches, room, hubs, hub_room;
    pir_rigid_ask *ask; /* * */
    uint32_t asks, ask_room;
    double (*shared)[3]; /* translations that it is to block * */
    uint32_t shareds, shared_room;
    pir_status status; /* of its making */
} pir_rigid_leaf;

/* A turn at a translation between two hubs. */
typedef struct pir_rigid_turn {
    uint32_t leaf[2], hub[2]; /* hubs as nodes */
    double at[3];
} pir_rigid_turn;

/* The numbers of the hubs that the ends are. */
enum pir_rigid_end { PIR_RIGID_START, PIR_RIGID_GOAL, PIR_RIGID_ENDS };

typedef struct pir_rigid_job {
    const pir_rigid_question *question;
    const pir_block_makers *makers;
    pir_status status;
    pir_plan_end end; /* what kept boxes that are in doubt from being divided last */
    pir_rigid_leaf *leaf;
    uint32_t leaves, leaf_room, alive;
    uint32_t told;                     /* the most leaves that the caller was told are made */
    uint32_t first_new;                /* leaves from here on were added last */
    uint32_t *list, listed, list_room; /* leaves that are doubted */
    uint32_t nodes;                    /* parts of all leaves that are not divided */
    uint32_t *root;                    /* of nodes */
    uint32_t root_room;
    uint32_t hubs, *hub_root, hub_room;
    double (*obstacle_box)[2][3]; /* of each obstacle's piece: a least and a greatest corner */
    pir_rigid_turn *turn;
    uint32_t turns, turn_room;
    uint64_t parts; /* of all divisions */
    size_t kept;    /* bytes of parts */
    pir_workspace *workspace;
} pir_rigid_job;

typedef struct pir_rigid_result {
    pir_turn_plan_answer answer;
    pir_plan_end end;
    uint32_t boxes, divided; /* leaves at the end; boxes that were divided */
    uint32_t cells;          /* of openings */
    uint64_t parts;
    pir_pose *step; /* of a path; from malloc */
    uint32_t steps;
} pir_rigid_result;

/* The first of the orbit of a leaf; which symmetry makes the leaf of that. */
static inline uint32_t pir_rigid_first(const pir_rigid_job *job, uint32_t leaf) {
    return leaf & ~(job->question->symmetries.count - 1);
}

static inline uint32_t pir_rigid_image(const pir_rigid_job *job, uint32_t leaf) {
    return leaf & (job->question->symmetries.count - 1);
}

/* The status of blocks that were made: only the caller ends their making with a limit. */
static inline pir_status pir_rigid_told(pir_status status) {
    return status == PIR_ERR_LIMIT ? PIR_PLAN_ERR_CALLER : status;
}

/* Grows an array of the job's; false once its status is a failure. */
bool pir_rigid_grow(pir_rigid_job *job, void **array, uint32_t *room, uint32_t need, size_t size);

/* The root in a forest of numbers. */
uint32_t pir_rigid_root(uint32_t *root, uint32_t i);

#endif
