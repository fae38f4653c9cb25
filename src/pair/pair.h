/* SPDX-License-Identifier: MIT */
/*
 * The inside of a pair and of a workspace.
 *
 * A pair holds what persists: the bodies, and hints from which the next answer starts. Hints are never believed: an
 * answer follows from proofs at its own placement, so it has the same bits whatever the hints were.
 *
 * The two exceptions are a proof that the bodies are apart, with the poses that it was made at (query/proof/proof.h),
 * and the distances of a surface's triangles from x, with their placement (surface/kept_lows.h).
 */
#ifndef PIR_PAIR_PAIR_H
#define PIR_PAIR_PAIR_H

#include <pirouette/pair.h>

#include "base/scratch.h"
#include "exact/relative_turn.h"
#include "pair/axes/axes.h"
#include "pair/surface/inner_surface.h"
#include "query/answer/ladder.h"
#include "query/contact/patch.h"
#include "query/frame/body.h"
#include "query/proof/proof.h"

struct pir_pair {
    pir_allocator allocator;
    pir_polytope *p, *q;                  /* as the caller gave them; referenced */
    const pir_kept_body *body_p, *body_q; /* of P reflected, and of Q; they belong to p and q */
    const pir_axes *axes_p, *axes_q;      /* likewise; NULL where either has many */
    int exponent;                         /* one unit of the frame is 2^exponent */
    double down;                          /* units of the frame in one of the world; 0 where that is no normal number */
    uint32_t limbs;                       /* that exact signs need */
    uint8_t levels, level;                /* those that the option allows, as a set; that of the last answer */
    uint8_t resting;                      /* how many more calls leave out the axes, since they told nothing */

    /* hints */
    pir_hint hint;
    bool has_axis;           /* the next two */
    pir_vec3 axis;           /* unit; x was apart along it by more than the cutoff */
    pir_vec3 axis_of_p;      /* the same in the frame of P */
    uint32_t axis_a, axis_b; /* the supports there */
    pir_surface *surface;    /* made when first needed; used where `deep` */

    pir_pair_proof proof;

    const pir_workspace *workspace; /* of the last call; never followed */

    pir_pair_statistics statistics;
};

struct pir_workspace {
    pir_workspace_head head; /* first, see base/scratch.h */
    pir_allocator allocator;
    pir_frame frame;
    pir_rotation rotation;   /* of P relative to Q; its doubles are those of the frame alone */
    pir_rotation rotation_q; /* of Q */
    pir_rotation_integers integers[2];
    bool has_q;            /* whether what depends on Q's pose alone is that of pose[1] below */
    bool posed, is_turned; /* Q is not at the origin, or turned; it is turned */
    pir_world world;
    pir_exact exact;
    pir_surface_room room;
    const pir_axes_loops *axes;
    const pir_walker *walker;
    const pir_relative_version *relative;
    pir_surface spare; /* where a pair has none */
    pir_patch_room patches;

    /*
     * The inputs of the last call. The frame is still that pair's where the pair names this workspace: each forgets
     * the other when it is made, and when it is used with a third.
     */
    const pir_pair *pair; /* never followed */
    pir_pose pose[2];     /* of P and of Q */
    pir_placement placement;
    pir_query_result answer; /* that it gave */
    pir_piece decided;       /* of that answer: see pir_task */

    /* the level `whole`: for the bodies of the pair that took it last */
    pir_sum *sum;
    pir_query *query;
};

/* Whether the options allow answers by a level. */
static inline bool pir_pair_allows(const pir_pair *pair, pir_level level) {
    return (pair->levels >> level & 1) != 0;
}

/*
 * A vector that has just been stored, number by number, and is read likewise: a wider load would wait until all of
 * them have reached the cache. The compiler may make no wider load of what is volatile.
 */
static inline pir_vec3 pir_vec_just_stored(const volatile pir_vec3 *from) {
    return (pir_vec3){from->x, from->y, from->z};
}

/* Whether radii, cutoff and margin are numbers that mean something. */
static inline pir_status pir_pair_check(const pir_pair_input *input) {
    const double p = input->radius_p, q = input->radius_q;
    // mostly all hold
    if ((p >= 0) & (p < HUGE_VAL) & (q >= 0) & (q < HUGE_VAL) & !isunordered(input->cutoff, input->margin))
        return PIR_OK;
    bool is_nan = isnan(p) || isnan(q) || isnan(input->cutoff) || isnan(input->margin);
    return is_nan ? PIR_ERR_NOT_FINITE : PIR_ERR_ARGUMENT;
}

/* Whether the bodies are apart by more than a length, as an earlier answer proves. False where the input is wrong. */
static inline bool pir_pair_stays_apart(const pir_pair *pair, const pir_pair_input *input, double least) {
    return pir_pair_proof_holds(&pair->proof, &pair->body_p->body, &pair->body_q->body, &input->pose_p, &input->pose_q,
                                least) &&
           pir_pair_check(input) == PIR_OK;
}

/* --- begin.c --- */

/* Whether the last call in this workspace was on this pair, and this pair's last call was in this workspace. */
static inline bool pir_pair_is_at(const pir_pair *pair, const pir_workspace *workspace) {
    return workspace->pair == pair && pair->workspace == workspace;
}

/* Begins a call: checks but for NULL, the frame at the relative pose, the workspace's placement. */
pir_status pir_pair_begin(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input);

/* A point in Q's frame, and a result, brought to the world: where Q is not at the origin, or turned. */
pir_vec3 pir_pair_point_to_world(const pir_workspace *workspace, pir_vec3 y);
void pir_pair_to_world(const pir_workspace *workspace, pir_query_result *result);

/* --- answer.c --- */

/*
 * Has the workspace's query on the whole difference of the bodies, which it makes where it has another, at the poses
 * that pir_pair_begin was given, and places it. PIR_ERR_MEMORY.
 */
pir_status pir_pair_place_whole(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                pir_placement *ret_placement);

#endif
