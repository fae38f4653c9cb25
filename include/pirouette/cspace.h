/* SPDX-License-Identifier: MIT */
/**
 * Slices of a configuration space: for every rotation of a grid the difference of every robot piece and every obstacle
 * piece, made by following the pairing from rotation to rotation, kept in one HDF5 file, read and asked.
 *
 * Robot and obstacles are lists of convex pieces. A *piece pair* is one of each; it is written (robot, obstacle). A
 * *slice* of a piece pair is the pairing of the difference Q ⊕ (−R·P) at one rotation of the grid, P the robot's piece
 * and Q the obstacle's: the translations at which the two pieces overlap. The file holds changes from slice to slice
 * with key slices at fixed numbers; docs/slices.md is its specification.
 *
 * Frame: that of the obstacles; the robot turns about its own origin. Unit of length: that of the models.
 *
 * Threads: one object of this header belongs to one thread at a time, but a job makes threads of its own.
 *
 * Without HDF5 in the build, calls that read or write files return PIR_ERR_UNSUPPORTED.
 */
#ifndef PIROUETTE_CSPACE_H
#define PIROUETTE_CSPACE_H

#include <pirouette/base.h>
#include <pirouette/grid.h>
#include <pirouette/mesh.h>
#include <pirouette/pair.h>
#include <pirouette/polytope.h>
#include <pirouette/query.h>
#include <pirouette/sum.h>

#ifdef __cplusplus
extern "C" {
#endif

/* --- making slices --- */

/** The bodies whose configuration space is sliced. Arrays and polytopes are borrowed for the call. */
typedef struct pir_cspace_bodies {
    pir_polytope *const *robot; /**< the pieces that turn */
    uint32_t robot_count;
    pir_polytope *const *obstacle; /**< the pieces that stand */
    uint32_t obstacle_count;
} pir_cspace_bodies;

/** How far a job has come. */
typedef struct pir_cspace_progress {
    uint64_t done, total; /**< slices of piece pairs, those of an earlier run included */
    uint64_t resumed;     /**< of `done`, those that an earlier run has made */
    double seconds;       /**< since this run began */
} pir_cspace_progress;

/**
 * A job: making the file. Work is dealt in units, `slices_per_unit` successive slices of one piece pair. A unit's bytes
 * depend on its bodies and rotations alone. Units that are done stand in parts beside the file, FILE.part0, FILE.part1,
 * …, one for each process; the file itself appears when all are done, complete.
 */
typedef struct pir_cspace_job pir_cspace_job;

typedef struct pir_cspace_options {
    const pir_allocator *allocator; /**< NULL for malloc; called from all threads of the job */
    uint32_t threads;               /**< that make units; 1 */
    uint32_t slices_per_unit;       /**< 256 */
    uint32_t slices_per_key;        /**< every so many slices of a unit one is written whole; 64 */
    int planes;                     /**< 1: also the planes of all slices, as doubles */
    int vertices;                   /**< 1: also the vertices of all slices, as doubles */
    int resume;                     /**< 1: go on from the parts of an earlier run; 0: remove them */
    uint32_t part;                  /**< the number of this process's part; 0 */
    /**
     * Gives the number of the next unit to make, or any number from the count of units on when there is none. NULL:
     * the job deals them itself. For ranks that share a job. Called from all threads, one at a time.
     */
    uint64_t (*claim)(void *context);
    /** Called now and then, one thread at a time; a result of 0 ends the run after the units in work. May be NULL. */
    int (*progress)(void *context, const pir_cspace_progress *progress);
    void *context; /**< for claim and progress */
} pir_cspace_options;

/** What a job will take. */
typedef struct pir_cspace_estimate {
    uint64_t slices;  /**< of piece pairs */
    uint64_t units;   /**< in all */
    double seconds;   /**< of one thread */
    double bytes;     /**< of the file */
    double mean_turn; /**< radians between successive rotations */
    double most_turn;
} pir_cspace_estimate;

/* --- reading slices --- */

/** An open file of slices. */
typedef struct pir_cspace pir_cspace;

/** What a file holds. */
typedef struct pir_cspace_info {
    pir_grid_info grid;
    uint32_t robot_count, obstacle_count;
    uint32_t slices_per_unit, slices_per_key;
    int has_planes, has_vertices;
} pir_cspace_info;

/** Which slice of which piece pair. */
typedef struct pir_cspace_place {
    uint32_t robot, obstacle;
    uint64_t slice; /**< the number of its rotation in the grid's order */
} pir_cspace_place;

/**
 * A slice. The arrays belong to the pir_cspace and hold until its next call. Features are numbered as in the polytopes;
 * those of the robot's piece P are the same in −P.
 */
typedef struct pir_slice {
    pir_quat rotation;
    uint32_t fv_count, vf_count, ee_count;
    const uint32_t *fv;      /**< per facet of P the vertex of Q */
    const uint32_t *vf;      /**< per facet of Q the vertex of P */
    const uint32_t (*ee)[2]; /**< {edge of P, edge of Q}, by rising edge of P and in order along its arc */
} pir_slice;

/** A half-space: the points x with normal·x ≤ offset. */
typedef struct pir_plane {
    pir_vec3 normal; /**< outward, of unit length within 2^-50 */
    double offset;   /**< the half-space holds the whole difference; see docs/slices.md for how far it may exceed it */
} pir_plane;

/* --- asking --- */

/** What is known of a pose, or of a motion. Never wrong: what is not proven is unknown. */
typedef enum pir_verdict {
    PIR_VERDICT_UNKNOWN = 0, /**< neither is proven */
    PIR_VERDICT_FREE,        /**< no piece of the robot overlaps or touches an obstacle's */
    PIR_VERDICT_BLOCKED,     /**< some piece of the robot overlaps or touches an obstacle's */
} pir_verdict;

/** The answer for one pose. */
typedef struct pir_configuration {
    pir_verdict verdict;
    pir_cspace_place place; /**< the slice that the answer rests on; of a free pose the least certain pair's */
    int on_grid;            /**< 1: the rotation is that of a slice, and `state` is exact */
    pir_state state;        /**< the most overlapping state over all piece pairs; with on_grid alone */
    double turn;            /**< radians, rounded up, from the slice's rotation to the pose's */
} pir_configuration;

/** The answer for a motion from one pose to another: straight in translation, about one axis in rotation. */
typedef struct pir_cspace_motion {
    pir_verdict verdict; /**< of the whole: free all along, blocked somewhere, else unknown */
    double from, to;     /**< where the first stretch that is not proven free begins and ends, of 0 to 1 */
} pir_cspace_motion;

#ifdef __cplusplus
}
#endif

#endif
