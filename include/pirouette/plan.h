/* SPDX-License-Identifier: MIT */
/**
 * Plans: whether a body can be moved from one place to another between obstacles by translations alone, decided
 * always and exactly, with the path, or with what proves that there is none; and by translations with turns about one
 * axis (pir_turn_plan) or any turns (pir_rigid_plan, at the end), decided where the budget lasts.
 *
 * The robot P, at one rotation R, is at a translation t where the obstacles Q are met if t lies in one of the sums
 * Q_l ⊕ (−R·P_k) of convex pieces. Free are the translations within the bounds that lie in no sum: bodies may not
 * touch. Where bodies are open they may: free are those in the inside of no sum, and the narrowest passage counts, one
 * that P fits exactly. The box of bounds is divided by planes of the sums until every part is free or blocked, and free
 * parts that meet are joined. All of it is decided by integers. docs/plan.md has the definitions and the proof.
 *
 * Lengths are in units of the models, in the frame of the obstacles: a vertex v of P is at R·v + t.
 *
 * Threads: a plan is immutable; any threads may read one.
 */
#ifndef PIROUETTE_PLAN_H
#define PIROUETTE_PLAN_H

#include <stdio.h>

#include <pirouette/base.h>
#include <pirouette/pose.h>
#include <pirouette/solid.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_path_plan pir_path_plan;

/** How a plan is made. */
typedef struct pir_path_plan_options {
    size_t size;                    /**< of this struct, which pir_path_plan_options_default sets (base.h) */
    const pir_allocator *allocator; /**< NULL for malloc's; copied; it outlives the plan */
    size_t memory;                  /**< the most bytes that the plan may hold, numbers included */
    pir_report *report;             /**< NULL, or filled when the call fails: it names what is wrong, and where */
    pir_vec3 low, high;             /**< the bounds of t, which may be on them; each low below its high */
    bool bounded;                   /**< false: no bounds; low and high are not read */
    bool open;                      /**< whether the bodies are without their boundaries, so that they may touch */
    uint32_t parts;                 /**< the most parts that the box may be divided into; 0 for what memory allows */
} pir_path_plan_options;

/** As pir_solid_options_default has it, no bounds, closed bodies, no bound on parts. O(1). */
static inline pir_path_plan_options pir_path_plan_options_default(void) {
    const pir_path_plan_options options = {sizeof(pir_path_plan_options),
                                           NULL,
                                           pir_solid_options_default().memory,
                                           NULL,
                                           {0, 0, 0},
                                           {0, 0, 0},
                                           false,
                                           false,
                                           0};
    return options;
}

/** The outcome. */
typedef enum pir_path_plan_answer {
    PIR_PLAN_NO_PATH, /**< the two translations are in different components of free space */
    PIR_PLAN_PATH
} pir_path_plan_answer;

/** The description of a plan, and the work that it took. */
typedef struct pir_path_plan_info {
    pir_path_plan_answer answer;
    uint32_t points;                        /**< of the path; 0 where there is none */
    uint32_t robot_pieces, obstacle_pieces; /**< convex ones */
    uint32_t sums;                          /**< of two pieces */
    uint32_t parts, free_parts;             /**< of the box, those that were divided among them; free ones */
    uint32_t components;                    /**< of free space within the bounds */
    pir_vec3 low, high;                     /**< the box: the bounds, or one around all sums and both places */
} pir_path_plan_info;

/** The question. Arrays and solids are borrowed for the call. */
typedef struct pir_path_plan_input {
    const pir_solid *const *robot; /**< P: solids that move together, in one frame; they may overlap */
    size_t robot_count;
    const pir_solid *const *obstacles; /**< Q, likewise */
    size_t obstacle_count;
    pir_quat rotation; /**< of P, of any non-zero length: it stands for the exact rotation */
    pir_vec3 from, to; /**< where t begins and where it is to go, both free and within the bounds */
} pir_path_plan_input;

/**
 * Decides whether P can be moved from one translation to another.
 *
 * input     the question.
 * options   NULL for the defaults.
 * ret_plan  to be freed with pir_path_plan_destroy.
 *
 * Without bounds the answer is that for all of space: a path that leaves a box around all sums can go along it.
 *
 * Cost: that of pir_solid_decompose of each; for p and q pieces p·q sums. For k sums that meet in many places O(k³)
 * parts, in most models some tens a sum; each part is held against the sums that meet its parent's.
 *
 * Errors: PIR_ERR_ARGUMENT (no solid, bounds that hold nothing, a place out of bounds, a place where bodies meet),
 * PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, PIR_ERR_EMPTY without a robot or obstacles, PIR_ERR_VERSION,
 * PIR_ERR_LIMIT (memory, parts), PIR_ERR_MEMORY; PIR_ERR_INTERNAL where a motion of the path fails the last check.
 *
 * Source: exact cell decomposition by binary space partition, after Thibault and Naylor 1987; of what sums leave, after
 * Lozano-Pérez 1983.
 */
PIR_API pir_status pir_path_plan_translate(const pir_path_plan_input *input, const pir_path_plan_options *options,
                                           pir_path_plan **ret_plan);

/** Frees; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_path_plan_destroy(pir_path_plan *plan);

/** The description of a plan. O(1). */
PIR_API void pir_path_plan_describe(const pir_path_plan *plan, pir_path_plan_info *ret_info);

/**
 * A point of the path: a translation. The first is where it begins, the last where it ends, and straight motions join
 * them. A point may be rational: this is it, rounded, and pir_path_plan_waypoint_exact (exact.h) gives it exactly.
 *
 * index      below the count of points.
 * ret_point  the point, rounded.
 * ret_exact  NULL, or whether the double is the point.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_path_plan_waypoint(const pir_path_plan *plan, uint32_t index, pir_vec3 *ret_point,
                                          bool *ret_exact);

/**
 * Writes the plan with its proof as JSON in rationals: the question, pieces, and the path or the division of the box.
 * docs/plan.md has the format, which check/plan.py checks.
 *
 * file  open for writing; it is not closed.
 *
 * Cost: O(size of what is written).
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_FILE, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_path_plan_write(const pir_path_plan *plan, FILE *file);

typedef struct pir_turn_plan pir_turn_plan;

/** How a plan with turns is made. Its memory is from malloc. */
typedef struct pir_turn_plan_options {
    size_t size;        /**< of this struct, which pir_turn_plan_options_default sets (base.h) */
    size_t memory;      /**< the most bytes that a division may hold, numbers included */
    pir_report *report; /**< NULL, or filled when the call fails: it names what is wrong, and where */
    FILE *proof;        /**< NULL, or where a path goes, or the proof that there is none, JSON; it is not closed */
    uint32_t arcs;      /**< the most arcs of the full turn: a power of two, from 8 to 65536 */
    uint32_t parts;     /**< the most parts that the boxes of all arcs may be divided into */
} pir_turn_plan_options;

/** As pir_solid_options_default has it, no proof, 1024 arcs, 2^22 parts. O(1). */
static inline pir_turn_plan_options pir_turn_plan_options_default(void) {
    const pir_turn_plan_options options = {
        sizeof(pir_turn_plan_options), pir_solid_options_default().memory, NULL, NULL, 1024, 1u << 22};
    return options;
}

/** The outcome of a plan with turns. */
typedef enum pir_turn_plan_answer {
    PIR_TURN_PLAN_UNKNOWN = 0, /**< something else ended it first: a pir_plan_end */
    PIR_TURN_PLAN_PATH,
    PIR_TURN_PLAN_NO_PATH
} pir_turn_plan_answer;

/** The reason that a plan with turns ended: the budget of which more may decide it, where that is one. */
typedef enum pir_plan_end {
    PIR_PLAN_END_DECIDED = 0, /**< the answer is not unknown */
    PIR_PLAN_END_BOXES,       /**< arcs of the turn, or boxes of all rotations: `arcs`, `boxes` */
    PIR_PLAN_END_PARTS,       /**< a division of translations: `parts` */
    PIR_PLAN_END_MEMORY,      /**< what is held: `memory` */
    PIR_PLAN_END_CALLER,      /**< `progress`, which was false */
    PIR_PLAN_END_FINEST       /**< no budget: no box in doubt can be divided or block more, as after 18 halvings */
} pir_plan_end;

/** The question of a plan with turns. Arrays and solids are borrowed for the call. Bodies are closed. */
typedef struct pir_turn_plan_input {
    const pir_solid *const *robot; /**< P: solids that move together, in one frame; they may overlap */
    size_t robot_count;
    const pir_solid *const *obstacles; /**< Q, likewise */
    size_t obstacle_count;
    pir_vec3 axis;             /**< through P's origin, of any length but 0 */
    pir_vec3 low, high;        /**< the bounds of the translation t; each low below its high */
    pir_vec3 from, to;         /**< t at the begin and at the end */
    double from_turn, to_turn; /**< the turn there, as a part of a full turn: from 0 to below 1 */
} pir_turn_plan_input;

/** The description of a plan with turns. */
typedef struct pir_turn_plan_info {
    pir_turn_plan_answer answer;
    uint32_t steps; /**< of the path; 0 where there is none */
    uint32_t arcs;  /**< that the full turn was divided into in the end */
    uint32_t parts; /**< of the boxes of all of these */
    uint32_t robot_pieces, obstacle_pieces;
    pir_plan_end end; /**< of DECIDED, BOXES, PARTS and MEMORY */
} pir_turn_plan_info;

/** A step of a path: a straight motion to `at` at any angle of an interval, then a turn there to the next interval. */
typedef struct pir_turn_plan_step {
    pir_vec3 at;
    double low, high; /**< radians: the motion to here is free at each of these angles, and so is staying */
} pir_turn_plan_step;

/**
 * Decides whether P can be moved from one translation and turn about an axis to another.
 *
 * input     the question.
 * options   NULL for the defaults.
 * ret_plan  to be freed with pir_turn_plan_destroy; also where the answer is unknown.
 *
 * The full turn is divided into arcs, 8, then twice as many. What pieces within P at every angle of an arc block is
 * blocked, and what pieces around P leave is free: an answer other than unknown is proven, and of two questions that
 * only differ in their budgets no two are answered otherwise.
 *
 * Cost: for each number n of arcs n times that of pir_path_plan_translate; n grows as the inverse of the gap.
 *
 * Errors: PIR_ERR_ARGUMENT (no solid, no axis, bounds that hold nothing, a place out of bounds or blocked, a turn not
 * from 0 to below 1, arcs that are no such number), PIR_ERR_NOT_FINITE, PIR_ERR_EMPTY without a robot or obstacles,
 * PIR_ERR_VERSION, PIR_ERR_LIMIT (a solid), PIR_ERR_FILE (the proof), PIR_ERR_MEMORY.
 *
 * Source: cells of translations over intervals of the angle, after Brooks and Lozano-Pérez 1985.
 */
PIR_API pir_status pir_turn_plan_create(const pir_turn_plan_input *input, const pir_turn_plan_options *options,
                                        pir_turn_plan **ret_plan);

/** Frees; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_turn_plan_destroy(pir_turn_plan *plan);

/** The description of a plan with turns. O(1). */
PIR_API void pir_turn_plan_describe(const pir_turn_plan *plan, pir_turn_plan_info *ret_info);

/**
 * A step of the path. The first is where it begins, the last where it ends.
 *
 * index     below the count of steps.
 * ret_step  the step.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_turn_plan_get_step(const pir_turn_plan *plan, uint32_t index, pir_turn_plan_step *ret_step);

/* --- translations and all turns --- */

/** A plan with translations and turns about any axis. */
typedef struct pir_rigid_plan pir_rigid_plan;

/**
 * Processes that make one plan together, such as ranks of MPI: each calls for the same question with the same options,
 * but for threads, proof and journal, and gets the same answer. All give a proof, or none; the first alone has a
 * journal, and its proof is the one to be kept.
 */
typedef struct pir_plan_ranks {
    uint32_t number, count; /**< of this process, from 0; of all */
    void *context;
    /**
     * Gives all processes the bytes of each, one after another in the order of their numbers; called by all in turn,
     * from the thread that made the call. What it gives stays until the next exchange. False where that fails.
     */
    bool (*exchange)(void *context, const void *own, size_t size, void **ret_all, size_t *ret_size);
} pir_plan_ranks;

/** How it is made. */
typedef struct pir_rigid_plan_options {
    size_t size;        /**< of this struct, which pir_rigid_plan_options_default sets (base.h) */
    size_t memory;      /**< the most bytes that one division may hold, and that may be kept of all */
    pir_report *report; /**< NULL, or filled when the call fails */
    FILE *proof;        /**< NULL, or where a path goes, or the proof that there is none, as docs/plan.md has it */
    uint32_t boxes;     /**< the most boxes that all rotations may be divided into, at least 32 */
    uint32_t parts;     /**< the most parts that one box of translations may be divided into */
    uint32_t threads;   /**< that the work is shared among, the caller's own included; the answer is the same */
    uint32_t resume;    /**< 1: what an earlier call kept in the journal is taken over; 0: it begins anew */
    /**
     * NULL, or the path of a file that keeps what is made of each box, beside `proof`, which is not NULL then. A call
     * for the same question goes on with it, whatever ended the first one, to the same answer and proof; boxes, parts
     * and memory may be others. The file is removed where the answer is not unknown. What it holds is not believed: a
     * proof of no path makes each box again, and a path is proven anew.
     */
    const char *journal;
    const pir_plan_ranks *ranks; /**< NULL, or the processes that share the work; borrowed for the call */
    /**
     * NULL, or told how far the call is: how many boxes are made of those that there are now, never fewer than before,
     * and how many the proof has. Called by the thread that made the call, after each way that is pushed, and each box
     * that this thread divides or writes. False ends the call with an unknown answer, with `ranks` in all processes.
     */
    bool (*progress)(void *context, uint32_t made, uint32_t written);
    void *context; /**< given to `progress` */
    /**
     * 0: where signs of coordinates leave the pieces of P, the obstacles and the bounds as they are, one box stands for
     * up to 16; 1: each is made by itself. Another answer than unknown is the same, another proof may be given.
     */
    uint32_t asymmetric;
    /** 0: walls whose holes are too narrow are looked for before boxes are made; 1: boxes of rotations alone. */
    uint32_t boxes_alone;
} pir_rigid_plan_options;

/** Memory as of pir_solid_options_default; no proof, no journal, 2^16 boxes, 2^22 parts, 1 thread, 0 else. O(1). */
static inline pir_rigid_plan_options pir_rigid_plan_options_default(void) {
    const pir_rigid_plan_options options = {sizeof(pir_rigid_plan_options),
                                            pir_solid_options_default().memory,
                                            NULL,
                                            NULL,
                                            1u << 16,
                                            1u << 22,
                                            1,
                                            0,
                                            NULL,
                                            NULL,
                                            NULL,
                                            NULL,
                                            0,
                                            0};
    return options;
}

/** The question of a plan with all turns. Arrays and solids are borrowed for the call. Bodies are closed. */
typedef struct pir_rigid_plan_input {
    const pir_solid *const *robot; /**< P: solids that move together, in one frame; they may overlap */
    size_t robot_count;
    const pir_solid *const *obstacles; /**< Q, likewise */
    size_t obstacle_count;
    pir_vec3 low, high; /**< the bounds of the translation t; each low below its high */
    pir_pose from, to;  /**< of P: it begins here, and is to go there */
} pir_rigid_plan_input;

/** The description of a plan with all turns. */
typedef struct pir_rigid_plan_info {
    pir_turn_plan_answer answer;
    uint32_t steps;          /**< poses of the path; 0 where there is none */
    uint32_t boxes, divided; /**< of rotations: those at the end, and those that were divided on the way */
    uint64_t parts;          /**< of all boxes of translations that were divided */
    uint32_t robot_pieces, obstacle_pieces;
    uint32_t symmetries; /**< how many boxes, of those at the end, one stands for; 1 where there is no symmetry */
    pir_plan_end end;    /**< why it ended */
    uint32_t cells;      /**< of planes that the holes of walls were divided into; 0 where none were looked at */
} pir_rigid_plan_info;

/**
 * Decides whether P can be moved from one pose to another, by any motion within bounds of its translation.
 *
 * input     the question.
 * options   NULL for the defaults.
 * ret_plan  to be freed with pir_rigid_plan_destroy; also where the answer is unknown.
 *
 * Rotations are divided into boxes, finer where the question needs it. Translations at which two pieces meet at
 * every rotation of a box are blocked, so where free cells of all boxes leave the ends apart there is no path. A path
 * is made of motions that sweeps prove to be free, found by pushing ways to where P has room; or of exact translations
 * at single rotations, and of turns that pieces around P over the turn prove to be free.
 * Before boxes are made, walls are looked for: planes that cut obstacles such that a piece of P has to pass holes.
 * Where its sections by all planes between one side and the other are in no disc that has the hole, there is no path.
 * Planes in the frame of the piece have three degrees of freedom, however long and wide the way is.
 * An answer other than unknown is proven, and of two questions that only differ in their budgets no two are answered
 * otherwise.
 *
 * Cost: for each box that of pir_path_plan_translate twice; of boxes that symmetries map to each other, for one alone.
 * Where a gap is less than a passage needs by a part ε, boxes of size ε are needed where P nearly fits: in general
 * O(ε^-3) of them. Of walls, some 1/ε² cells of planes at worst, at most 64 times `boxes`, each some microseconds.
 *
 * Errors: PIR_ERR_ARGUMENT (no solid, bounds that hold nothing, a pose out of bounds or blocked), PIR_ERR_NOT_FINITE,
 * PIR_ERR_ZERO_QUATERNION, PIR_ERR_EMPTY without a robot or obstacles, PIR_ERR_VERSION, PIR_ERR_LIMIT (a solid),
 * PIR_ERR_FILE (the proof, or the journal, which another process may be writing to), PIR_ERR_FORMAT (a journal of
 * another question, or one whose boxes are not what is made again), PIR_ERR_MEMORY.
 *
 * Source: cells of translations over cells of rotations, after Brooks and Lozano-Pérez 1985; boxes of the charts of
 * unit quaternions, and turned vectors as means of polar forms, are this library's own.
 */
PIR_API pir_status pir_rigid_plan_create(const pir_rigid_plan_input *input, const pir_rigid_plan_options *options,
                                         pir_rigid_plan **ret_plan);

/** Frees; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_rigid_plan_destroy(pir_rigid_plan *plan);

/** The description. O(1). */
PIR_API void pir_rigid_plan_describe(const pir_rigid_plan *plan, pir_rigid_plan_info *ret_info);

/**
 * A pose of the path. The first is where it begins, the last where it ends. Between two the motion is that of sweep.h:
 * it goes straight and turns evenly by the lesser angle about one axis, as slerp does, or it does one of these alone.
 *
 * index     below the count of steps.
 * ret_pose  the pose; its quaternion is of any length.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_rigid_plan_get_step(const pir_rigid_plan *plan, uint32_t index, pir_pose *ret_pose);

#ifdef __cplusplus
}
#endif

#endif
