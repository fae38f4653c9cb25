/* SPDX-License-Identifier: MIT */
/**
 * Slices of a configuration space: for every rotation of a grid the difference of every robot piece and every obstacle
 * piece, made by following the pairing from rotation to rotation, kept in one HDF5 file, read and asked.
 *
 * Robot and obstacles are lists of convex pieces. A *piece pair* is one of each; it is written (robot, obstacle). A
 * *slice* of a piece pair is the pairing of the difference Q ⊕ (−R·P) at one rotation of the grid, P the robot's
 * piece and Q the obstacle's: the translations at which the two pieces overlap. The file holds changes from slice to
 * slice with key slices at fixed numbers; docs/slices.md is its specification.
 *
 * Frame: that of the obstacles; the robot turns about its own origin. Unit of length: that of the models.
 *
 * Threads: one object of this header belongs to one thread at a time, but a job makes threads of its own.
 *
 * This header is of libpirouette-cspace, which stands beside libpirouette: pkg-config's pirouette-cspace. Without HDF5
 * in the build, calls that read or write files return PIR_ERR_NOT_BUILT.
 */
#ifndef PIROUETTE_CSPACE_H
#define PIROUETTE_CSPACE_H

#include <string.h>

#include <pirouette/base.h>
#include <pirouette/grid.h>
#include <pirouette/mesh.h>
#include <pirouette/pair_batch.h>
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

/** The most slices of a unit. */
#define PIR_CSPACE_UNIT_MAX ((uint32_t)1 << 20)

typedef struct pir_cspace_options {
    size_t size;                    /**< of this struct, which pir_cspace_options_default sets (base.h) */
    const pir_allocator *allocator; /**< NULL for malloc; called from all threads of the job */
    uint32_t threads;               /**< that make units; 1 */
    uint32_t slices_per_unit;       /**< at most PIR_CSPACE_UNIT_MAX; 0: 256, or 64 where there are few in all */
    uint32_t slices_per_key;        /**< every so many slices of a unit one is written whole; 0: 64 */
    bool planes;                    /**< whether to make the planes of all slices too, as doubles */
    bool vertices;                  /**< whether to make the vertices of all slices too, as doubles */
    bool resume;                    /**< whether to go on from the parts of an earlier run; else they are removed */
    uint32_t part;                  /**< the number of this process's part; 0 */
    /**
     * Gives the number of the next unit to make, or any number from the count of units on when there is none. NULL:
     * the job deals them itself. For ranks that share a job. Called from all threads, one at a time.
     */
    uint64_t (*claim)(void *context);
    /** Called now and then, one thread at a time; false ends the run after the units in work. May be NULL. */
    bool (*progress)(void *context, const pir_cspace_progress *progress);
    void *context; /**< for claim, progress and complete */
    /**
     * Called by pir_cspace_job_assemble with the path of the file, once it is whole and sealed and before it takes the
     * place of an older one: what is added to it then (pir_cspace_seal) appears with it. Not called where the file of
     * the same job is there already. False ends the call with PIR_ERR_FILE, and the older file stays. May be NULL.
     */
    bool (*complete)(void *context, const char *path);
} pir_cspace_options;

/**
 * One thread, 256 slices a unit (64 where there are few in all), 64 a key, no planes, no vertices, no resuming. O(1).
 */
static inline pir_cspace_options pir_cspace_options_default(void) {
    pir_cspace_options options;
    memset(&options, 0, sizeof options);
    options.size = sizeof options;
    options.threads = 1;
    return options;
}

/**
 * Makes a job. With `resume` it takes over the units that parts of an earlier run hold, and where the file itself is
 * there, of the same job, nothing is left to make; else it removes such parts. Of several processes that share a job
 * only the first, whose `part` is 0, may be without `resume`, and the others make theirs after it. That first one holds
 * the lock `path`.lock until it is destroyed, so that no other job makes the same file meanwhile; a process that is
 * killed drops it. docs/slices.md says what holds where a file system has no locks.
 *
 * bodies   pieces of any dimension, at least one of each; the job takes a reference to each.
 * grid     borrowed until the job is destroyed.
 * path     the file that will appear when all units are made; links are followed. A file that stands there stays until
 *          then, and leaves the new one its permissions; what is no regular file is refused.
 * options  NULL for the defaults.
 * report   NULL, or filled when the call fails.
 *
 * Cost: O(rotations + size of the pieces); with `resume`, the time to read all parts.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_EMPTY (no pieces), PIR_ERR_FORMAT (with `resume`, a part of another job, or a file
 * that is another one and no part of this job), PIR_ERR_FILE (also where another job holds the lock), PIR_ERR_LIMIT,
 * PIR_ERR_MEMORY, PIR_ERR_NOT_BUILT (no HDF5).
 */
PIR_API pir_status pir_cspace_job_create(const pir_cspace_bodies *bodies, const pir_grid *grid, const char *path,
                                         const pir_cspace_options *options, pir_report *report,
                                         pir_cspace_job **ret_job);

/** Frees; parts stay. NULL is accepted. Cost: the time to free it. */
PIR_API void pir_cspace_job_destroy(pir_cspace_job *job);

/** Units in all, those that are made included. O(1). */
PIR_API uint64_t pir_cspace_job_units(const pir_cspace_job *job);

/**
 * Units that were still to be made when the job was created. Of processes that share a job only the first one, whose
 * `part` is 0, looks whether the file is complete.
 *
 * Cost: O(1).
 */
PIR_API uint64_t pir_cspace_job_left(const pir_cspace_job *job);

/**
 * Makes units until none is left to claim, or until `progress` returns false, and appends them to this process's
 * part. Each unit that was appended is kept, whatever comes after; what is on the disk after a loss of power may be
 * two seconds old.
 *
 * report  NULL, or filled when the call fails.
 *
 * Cost: a walk for each unit, and for each slice an update and what it changes.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_FILE (a full disk, a part that another process writes to), PIR_ERR_FORMAT,
 * PIR_ERR_LIMIT, PIR_ERR_MEMORY. Units made before the error are kept.
 */
PIR_API pir_status pir_cspace_job_run(pir_cspace_job *job, pir_report *report);

/**
 * Makes the file of all parts beside it, and removes these. The file appears complete or not at all, and is the same
 * whoever made which unit.
 *
 * report  NULL, or filled when the call fails.
 *
 * Cost: the time to read the parts and write the file.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_EMPTY (units are still to be made), PIR_ERR_FILE, PIR_ERR_FORMAT, PIR_ERR_MEMORY.
 * Parts stay after an error.
 */
PIR_API pir_status pir_cspace_job_assemble(pir_cspace_job *job, pir_report *report);

/** The work of a job, estimated. Times are those of this machine as it is now. */
typedef struct pir_cspace_estimate {
    uint64_t slices;  /**< of piece pairs */
    uint64_t units;   /**< in all */
    double seconds;   /**< of one thread */
    double bytes;     /**< of the file, compressed; of its tables alone in a build without HDF5 */
    double mean_turn; /**< radians between successive rotations */
    double most_turn;
} pir_cspace_estimate;

/**
 * Estimates what a job would take, from the first slices of 24 units spread over it. Writes no file.
 *
 * bodies, grid, options, report  as of pir_cspace_job_create.
 *
 * Cost: O(rotations), and 840 slices at most.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_EMPTY, PIR_ERR_LIMIT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_cspace_get_estimate(const pir_cspace_bodies *bodies, const pir_grid *grid,
                                           const pir_cspace_options *options, pir_report *report,
                                           pir_cspace_estimate *ret_estimate);

/* --- reading slices --- */

/** An open file of slices. */
typedef struct pir_cspace pir_cspace;

/** The contents of a file. */
typedef struct pir_cspace_info {
    pir_grid_info grid;
    uint32_t robot_count, obstacle_count;
    uint32_t slices_per_unit, slices_per_key;
    bool has_planes, has_vertices;
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

/** The points x with normal·x ≤ offset. */
typedef struct pir_halfspace {
    pir_vec3 normal; /**< outward, of unit length within 2^-50 */
    double offset;   /**< the half-space holds the whole difference; see docs/slices.md for how far it may exceed it */
} pir_halfspace;

/**
 * Opens a file of slices. Its form is checked and its pieces are made anew as exact hulls; the rest is read and checked
 * as it is asked for.
 *
 * path       of the file.
 * allocator  NULL for malloc; copied, its context must outlive the file. HDF5 has memory of its own.
 * report     NULL, or filled with what, where and why when the call fails.
 *
 * Cost: exact hulls of the pieces; for a grid that is a list, O(rotations).
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_FILE, PIR_ERR_FORMAT (no HDF5, truncated, a hash that does not match),
 * PIR_ERR_LIMIT, PIR_ERR_MEMORY, PIR_ERR_VERSION, PIR_ERR_NOT_BUILT (no HDF5).
 */
PIR_API pir_status pir_cspace_open(const char *path, const pir_allocator *allocator, pir_report *report,
                                   pir_cspace **ret_cspace);

/**
 * Checks every byte of a file of slices against the seal at its end. Not needed before reading: pir_cspace_open reads
 * no byte that has not been checked, and checks those that it reads.
 *
 * path       of the file.
 * allocator  NULL for malloc.
 * report     NULL, or filled with what, where and why when the call fails.
 *
 * Cost: the time to read the file.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_FILE, PIR_ERR_FORMAT (damaged, or no sealed file), PIR_ERR_MEMORY,
 * PIR_ERR_NOT_BUILT (no HDF5 in this build).
 */
PIR_API pir_status pir_cspace_check(const char *path, const pir_allocator *allocator, pir_report *report);

/**
 * Seals a file of slices anew, to which something was added through HDF5: writes hashes of all its bytes at its end.
 * They vouch for what the file holds then, whatever it is, so it should have been checked before something was added.
 *
 * path       of the file.
 * allocator  NULL for malloc.
 * report     NULL, or filled when the call fails.
 *
 * Cost: the time to read the file.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_FILE, PIR_ERR_MEMORY, PIR_ERR_NOT_BUILT (no HDF5 in this build).
 */
PIR_API pir_status pir_cspace_seal(const char *path, const pir_allocator *allocator, pir_report *report);

/** Closes and frees; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_cspace_destroy(pir_cspace *cspace);

/** The contents of the file. O(1). */
PIR_API pir_cspace_info pir_cspace_get_info(const pir_cspace *cspace);

/** The grid; borrowed. O(1). */
PIR_API const pir_grid *pir_cspace_grid(const pir_cspace *cspace);

/** Piece `piece` of the robot, and of the obstacles, which must be below their counts; borrowed. O(1). */
PIR_API const pir_polytope *pir_cspace_robot(const pir_cspace *cspace, uint32_t piece);
PIR_API const pir_polytope *pir_cspace_obstacle(const pir_cspace *cspace, uint32_t piece);

/**
 * Reads the pairs of a slice. Every number of the file is checked to be a feature, and crossings to lead from cell to
 * cell, but not that the pairs are those of the rotation: pir_cspace_sum proves that.
 *
 * place   which slice.
 * report  NULL, or filled when the call fails.
 *
 * Cost: reading its unit, where that was not one of the 16 asked last; then O(size of the pairing), and the changes
 * since the key slice before it, or since the slice that was read last.
 *
 * Errors: PIR_ERR_ARGUMENT (no such slice), PIR_ERR_FILE, PIR_ERR_FORMAT (corrupted), PIR_ERR_LIMIT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_cspace_slice(pir_cspace *cspace, pir_cspace_place place, pir_report *report,
                                    pir_slice *ret_slice);

/**
 * The half-spaces of all pairs of a slice: fv, then vf, then ee, in the order of pir_slice. Those of segments, whose
 * facets a slice does not show, are there too. Each holds the whole difference, if the pairs are those of the rotation.
 *
 * place, report            as of pir_cspace_slice.
 * ret_planes, ret_count    the half-spaces; they belong to `cspace` and hold until its next call.
 *
 * Cost: that of pir_cspace_slice.
 *
 * Errors: those of pir_cspace_slice.
 */
PIR_API pir_status pir_cspace_planes(pir_cspace *cspace, pir_cspace_place place, pir_report *report,
                                     const pir_halfspace **ret_planes, uint32_t *ret_count);

/**
 * A slice as a sum that keeps the difference, which queries take, and which turns on from there. It is made anew, and
 * its pairing held against that of the file, so the sum is right whoever wrote the file.
 *
 * place, report  as of pir_cspace_slice.
 *
 * The caller destroys *ret_sum; it may outlive `cspace`.
 *
 * Cost: that of pir_cspace_slice and of pir_sum_create.
 *
 * Errors: those of pir_cspace_slice; PIR_ERR_FORMAT where the pairing is not that of the rotation.
 */
PIR_API pir_status pir_cspace_sum(pir_cspace *cspace, pir_cspace_place place, pir_report *report, pir_sum **ret_sum);

/**
 * The mesh of a slice: that of the true sum, as pir_sum_mesh makes it. The caller destroys *ret_mesh.
 *
 * place, report  as of pir_cspace_slice.
 * precision      doubles, or exact rationals beside them.
 *
 * Cost: that of pir_cspace_sum and of pir_sum_mesh.
 *
 * Errors: those of pir_cspace_sum.
 */
PIR_API pir_status pir_cspace_mesh(pir_cspace *cspace, pir_cspace_place place, pir_precision precision,
                                   pir_report *report, pir_mesh **ret_mesh);

/* --- asking --- */

/** Knowledge of a pose, or of a motion. Never wrong: what is not proven is unknown. */
typedef enum pir_verdict {
    PIR_VERDICT_UNKNOWN = 0, /**< neither is proven: of motions alone */
    PIR_VERDICT_FREE,        /**< no piece of the robot overlaps or touches an obstacle's */
    PIR_VERDICT_BLOCKED,     /**< some piece of the robot overlaps or touches an obstacle's */
} pir_verdict;

/** The answer for one pose. */
typedef struct pir_configuration {
    pir_verdict verdict;
    /**
     * The slice of the nearest rotation; of a blocked pose the first pair of pieces that is, of a free one that whose
     * balls come nearest.
     */
    pir_cspace_place place;
    bool on_grid;    /**< whether the rotation is that of a slice */
    pir_state state; /**< the most overlapping state over all piece pairs; with on_grid alone */
    double turn;     /**< radians, rounded up, from the slice's rotation to the pose's */
} pir_configuration;

/**
 * Classifies a pose: free or blocked, exactly, at the very doubles of the pose.
 *
 * Balls around the pieces that are apart are tried first, then pairs by need (pair.h) of the file's pieces. No slice is
 * read, as a pair is asked in less time than a slice takes to read or to make; docs/slices.md has figures, and says
 * when slices pay. At the rotation of a slice (a quaternion that is a multiple of the grid's) the state is told too;
 * where a list has five rotations or more within 1e-7 of each other, the slice may not be found among them, and the
 * pose is answered as one beside it.
 *
 * pose    of the robot.
 * report  NULL, or filled when the call fails.
 *
 * Up to 1024 pairs of pieces are kept between calls, with what their last answers needed.
 *
 * Cost: a query of a pair for each pair of pieces whose balls meet, until one is blocked; finding the nearest rotation.
 *
 * Errors: PIR_ERR_ARGUMENT, those of queries of a pair; PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION and PIR_ERR_LIMIT
 * (a translation beyond 2^1000) of the pose.
 */
PIR_API pir_status pir_cspace_classify(pir_cspace *cspace, const pir_pose *pose, pir_report *report,
                                       pir_configuration *ret_configuration);

/**
 * Where the answers of many poses go: arrays of the caller's with an element for each pose, or NULL for what is not
 * wanted. Elements touch. Without `state`, `on_grid`, `slice` and `turn` the nearest rotation is not looked for, which
 * takes most of the time of a pose that balls part.
 */
typedef struct pir_cspace_arrays {
    uint8_t *verdict; /**< a pir_verdict, or PIR_POSE_BAD */
    uint8_t *status;  /**< a pir_status: PIR_OK, or why the pose is bad */
    uint8_t *state;   /**< as of pir_configuration, this and the next; 0 off the grid; or PIR_POSE_BAD */
    uint8_t *on_grid;
    uint32_t *robot, *obstacle; /**< of its `place`; of a bad pose 0 */
    uint64_t *slice;
    double *turn; /**< of a bad pose NaN */
} pir_cspace_arrays;

/**
 * Classifies many poses. Each answer is that of pir_cspace_classify, whatever comes before it. A pose that is bad (not
 * finite, a quaternion of zeros, out of range, one that memory ran out at) is told by its index; all others are
 * answered.
 *
 * poses        of the robot, as arrays (pair_batch.h).
 * count        how many there are.
 * arrays       where the answers go.
 * report       NULL, or filled when the call fails.
 * ret_summary  NULL, or how many poses are bad.
 *
 * Cost: that of pir_cspace_classify for each pose; in order of a motion less than at random.
 *
 * Errors: PIR_ERR_ARGUMENT (NULL, a stride that is no multiple of 8 or shorter than an element), PIR_ERR_MEMORY. The
 * arrays are then untouched.
 */
PIR_API pir_status pir_cspace_classify_many(pir_cspace *cspace, const pir_pose_array *poses, size_t count,
                                            const pir_cspace_arrays *arrays, pir_report *report,
                                            pir_pair_batch_summary *ret_summary);

/** The answer for a motion from one pose to another. */
typedef struct pir_cspace_motion {
    pir_verdict verdict; /**< of the whole: free all along, blocked somewhere, else unknown */
    double from, to;     /**< where the first stretch that is not proven free begins and ends, of 0 to 1; else 0, 0 */
} pir_cspace_motion;

/**
 * Classifies all poses of a motion: at time s of 0 to 1 the translation is (1 − s) times that of `from` plus s times
 * that of `to`, and the robot is turned from the first rotation by s of the angle to the second, the shorter way about
 * one axis; where both ways are half a turn, the way of the quaternions as they are given.
 *
 * Stretches of the motion are halved until what is proven of their middle holds all along them, at most 16 times, and
 * once less for every 16 stretches that were left unproven; 4096 poses are asked at most. Up to motion.from the motion
 * is proven free.
 *
 * from, to  the poses at its ends.
 * report    NULL, or filled when the call fails.
 *
 * Cost: that of pir_cspace_classify for each pose that is asked.
 *
 * Errors: those of pir_cspace_classify.
 */
PIR_API pir_status pir_cspace_segment(pir_cspace *cspace, const pir_pose *from, const pir_pose *to, pir_report *report,
                                      pir_cspace_motion *ret_motion);

/**
 * Reads poses from a file: seven numbers x,y,z,w,tx,ty,tz a row, the quaternion and the translation. The file is text
 * or npy, as of pir_grid_read.
 *
 * path       of the file, of at most 2 GiB.
 * allocator  NULL for malloc.
 * report     NULL, or filled with what, where (line or row) and why when the call fails.
 * ret_poses  the poses, of which there are *ret_count; pir_cspace_free_poses frees them.
 *
 * Cost: O(size of the file).
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_FILE, PIR_ERR_EMPTY, PIR_ERR_FORMAT, PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION,
 * PIR_ERR_LIMIT, PIR_ERR_VERSION (of an npy file), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_cspace_read_poses(const char *path, const pir_allocator *allocator, pir_report *report,
                                         pir_pose **ret_poses, size_t *ret_count);

/**
 * Frees poses that were read; NULL is accepted.
 *
 * poses, count, allocator  as pir_cspace_read_poses gave them, and was given.
 *
 * Cost: O(1).
 */
PIR_API void pir_cspace_free_poses(pir_pose *poses, size_t count, const pir_allocator *allocator);

#ifdef __cplusplus
}
#endif

#endif
