/* SPDX-License-Identifier: MIT */
/**
 * Grids of rotations, in an order in which successive rotations are near each other.
 *
 * Rotations are numbered 0, 1, … in the order of visiting, a path of small turns through the grid. They are made with
 * +, −, ·, / and √ of doubles alone, so that a grid has the same bits on every machine. A grid about an axis and
 * one of all rotations keep no rotations: any one is made from its number.
 *
 * This header is of libpirouette-cspace, which stands beside libpirouette.
 *
 * Threads may read one grid at the same time.
 */
#ifndef PIROUETTE_GRID_H
#define PIROUETTE_GRID_H

#include <pirouette/base.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_grid pir_grid;

/** Which rotations a grid has. */
typedef enum pir_grid_kind {
    PIR_GRID_AXIS = 0, /**< `count` equal turns about one axis, which make a full turn, beginning with no turn */
    PIR_GRID_HOPF,     /**< the incremental grid of all rotations at `level`: 72·8^level of them */
    PIR_GRID_LIST,     /**< rotations that the caller or a file gave */
} pir_grid_kind;

/** The making of a grid. */
typedef struct pir_grid_info {
    pir_grid_kind kind;
    uint64_t count; /**< of rotations */
    pir_vec3 axis;  /**< PIR_GRID_AXIS: as given */
    uint32_t level; /**< PIR_GRID_HOPF */
    /**
     * Radians between neighbours: a full turn by `count` about an axis, 60° by 2^level for PIR_GRID_HOPF. For
     * PIR_GRID_LIST the mean turn from a rotation to the nearest other one.
     */
    double spacing;
} pir_grid_info;

/** The greatest level of PIR_GRID_HOPF: 1.2·10^9 rotations, 0.23° apart. */
#define PIR_GRID_LEVEL_MAX 8

/** The greatest counts of PIR_GRID_AXIS and of PIR_GRID_LIST. */
#define PIR_GRID_STEPS_MAX ((uint64_t)1 << 31)
#define PIR_GRID_LIST_MAX  ((size_t)1 << 26)

/**
 * Makes a grid of `steps` rotations about `axis`: number i turns by i/steps of a full turn.
 *
 * axis       of any length but 0.
 * steps      1 to PIR_GRID_STEPS_MAX.
 * allocator  NULL for malloc; copied, its context must outlive the grid.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT (an axis of zeros, no steps), PIR_ERR_NOT_FINITE, PIR_ERR_LIMIT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_grid_axis(pir_vec3 axis, uint64_t steps, const pir_allocator *allocator, pir_grid **ret_grid);

/**
 * Makes the grid of all rotations (Yershova, Jain, LaValle and Mitchell, Generating Uniform Incremental Grids on SO(3)
 * Using the Hopf Fibration, Int. J. Robotics Research 29(7), 2010): over each of the 12·4^level pixels of a HEALPix
 * map (Górski et al., Astrophysical J. 622, 2005) a circle of 6·2^level rotations.
 *
 * The path runs once round the circle of a pixel, in equal turns about the axis x of the frame that does not turn. It
 * then goes to the nearest rotation over the next pixel. Pixels follow a Hilbert curve, so that each is a neighbour of
 * the one before.
 *
 * level      0 to PIR_GRID_LEVEL_MAX. Each halves the spacing.
 * allocator  as of pir_grid_axis.
 *
 * Cost: O(4^level) time and memory: 4 bytes a pixel, and up to level 5 some 200 bytes more and 2 µs for tables of
 * which rotations are nearest.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_LIMIT (a higher level), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_grid_hopf(uint32_t level, const pir_allocator *allocator, pir_grid **ret_grid);

/**
 * Makes a grid of given rotations.
 *
 * rotations   `count` of them, 1 to PIR_GRID_LIST_MAX, each of any length but 0; copied as they are.
 * keep_order  true: number i is rotations[i]. false: numbers follow a path of small turns, found by joining nearest
 *             neighbours first and then exchanging steps while that shortens it. It is not the shortest.
 * allocator   as of pir_grid_axis.
 *
 * Cost: O(n log n) expected for n rotations.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_EMPTY, PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, PIR_ERR_LIMIT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_grid_list(const pir_quat *rotations, size_t count, bool keep_order,
                                 const pir_allocator *allocator, pir_grid **ret_grid);

/**
 * Reads rotations from a file and makes a grid of them in a path of small turns.
 *
 * A file that begins with the bytes of npy (NumPy Enhancement Proposal 1) holds an array of N × 4 float64, by rows.
 * Any other is text: four numbers x,y,z,w a line, between commas or blanks; a first line of names is passed over, and
 * so are empty lines and what follows a #.
 *
 * path       of the file, of at most 2 GiB.
 * allocator  as of pir_grid_axis.
 * report     NULL, or filled with what, where (line or row) and why when the call fails.
 *
 * Cost: that of pir_grid_list.
 *
 * Errors: those of pir_grid_list, PIR_ERR_FILE, PIR_ERR_FORMAT, PIR_ERR_VERSION (of an npy file).
 */
PIR_API pir_status pir_grid_read(const char *path, const pir_allocator *allocator, pir_report *report,
                                 pir_grid **ret_grid);

/**
 * A grid from the bytes of a file in memory.
 *
 * data, size         the bytes of the file.
 * name               stands for the file in reports.
 * allocator, report  as of pir_grid_read.
 *
 * Cost: that of pir_grid_list.
 *
 * Errors: those of pir_grid_read, without PIR_ERR_FILE.
 */
PIR_API pir_status pir_grid_read_bytes(const void *data, size_t size, const char *name, const pir_allocator *allocator,
                                       pir_report *report, pir_grid **ret_grid);

/** Frees; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_grid_destroy(pir_grid *grid);

/** The description of the grid. O(1). */
PIR_API pir_grid_info pir_grid_get_info(const pir_grid *grid);

/**
 * Rotation `number`, which must be below the count. O(level) for PIR_GRID_HOPF, else O(1).
 */
PIR_API pir_quat pir_grid_rotation(const pir_grid *grid, uint64_t number);

/**
 * The number of rotation `number` in the grid's own numbering: the row of a list, counted from 0; for PIR_GRID_HOPF the
 * nested number of the pixel times 6·2^level plus the number on the circle. O(level) for PIR_GRID_HOPF, else O(1).
 */
PIR_API uint64_t pir_grid_cell(const pir_grid *grid, uint64_t number);

/**
 * Finds the rotations of the grid that are nearest to `rotation`, the nearest first and, of equally near ones, the
 * lower number. How near they are is compared by cosines in double: those within 1e-7 of `rotation` count as equally
 * near. The result is how many are found, 0 where `rotation` is zero or not finite.
 *
 * rotation           of any length but 0.
 * most, ret_numbers  how many are asked for, at most 64 of which are found, and room for them.
 *
 * Cost: O(most²), O(log n) more for a list of n rotations; one rotation of a PIR_GRID_HOPF up to level 5 by a look at
 * four of them.
 */
PIR_API size_t pir_grid_nearest(const pir_grid *grid, pir_quat rotation, size_t most, uint64_t *ret_numbers);

/** The turns between successive rotations of a grid, in radians; 0 where there is one rotation. */
typedef struct pir_grid_turns {
    double mean, most;
} pir_grid_turns;

/** O(count). */
PIR_API pir_grid_turns pir_grid_get_turns(const pir_grid *grid);

/**
 * The angle in radians, 0 to π, by which two rotations differ, within 1e-14; NaN where one is zero or not finite.
 *
 * a, b  of any length but 0.
 *
 * Cost: O(1).
 */
PIR_API double pir_grid_turn(pir_quat a, pir_quat b);

#ifdef __cplusplus
}
#endif

#endif
