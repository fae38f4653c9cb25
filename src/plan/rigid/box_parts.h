/* SPDX-License-Identifier: MIT */
/*
 * The box of translations divided for one robot at one rotation, and what is kept of that.
 *
 * A division is exact, and large. Kept are the free cells, by their corners in doubles (plan_space.h has the errors),
 * and which connected part of free space each is of. The same question gives the same division, cell for cell, so
 * that paths and proofs make it again.
 */
#ifndef PIR_PLAN_RIGID_BOX_PARTS_H
#define PIR_PLAN_RIGID_BOX_PARTS_H

#include "base/byte_block.h"
#include "plan/join.h"
#include "plan/rotations/symmetries.h"

/* The question. Rotations and bounds are borrowed for as long as the plan is made. */
typedef struct pir_rigid_question {
    const pir_plan_pieces *robot, *obstacles, *wide; /* pieces; those of obstacles made wide (wide_pieces.h) */
    pir_symmetries symmetries;                       /* of robot, wide pieces and bounds */
    double low[3], high[3];                          /* bounds of translations */
    double at[2][3];                                 /* translations: from, to */
    pir_quat rotation[2];                            /* likewise */
    uint32_t most_boxes;                             /* of rotations */
    uint32_t most_parts;                             /* of the boxes of one division */
    bool is_boxes_alone;                             /* whether openings are not tried */
    size_t memory;                                   /* of one division, and of all parts that are kept */
    bool (*progress)(void *context, uint32_t made, uint32_t written); /* NULL, or told of boxes; false ends it */
    void *context;
} pir_rigid_question;

typedef struct pir_box_division {
    pir_plan_space space;
    pir_plan_cutter cutter;
    pir_plan_sums sums;
    pir_plan_tree tree;
    pir_plan_joints joints;
} pir_box_division;

/* The box, which nothing divides yet. To be finished also where it fails. */
pir_status pir_box_division_open(const pir_rigid_question *question, pir_box_division *division);

/* Divides the box for pieces, turned as they are. To be finished also where it fails. */
pir_status pir_box_division_make(const pir_rigid_question *question, const pir_plan_pieces *robot, bool with_doors,
                                 pir_box_division *division);

/* Divides free cells by a polytope of translations that two pieces block, or by more of them. */
pir_status pir_box_division_add(const pir_rigid_question *question, const pir_plan_pieces *made, uint32_t first,
                                pir_box_division *division);

/* Says which cells are connected. */
pir_status pir_box_division_join(bool with_doors, pir_box_division *division);
void pir_box_division_finish(pir_box_division *division);

/* The cell of a division that has a free point; PIR_PLAN_NONE where a sum has it. */
uint32_t pir_box_division_cell_at(pir_box_division *division, uint32_t point);

typedef struct pir_box_cell {
    uint32_t first, points; /* among all points */
    uint32_t part;
    double low[3], high[3];
} pir_box_cell;

typedef struct pir_box_parts {
    double (*x)[3], room; /* how far they may be from the exact ones, but for 2^-50 relatively */
    pir_box_cell *cell;
    uint32_t cells, points;
    uint32_t parts; /* connected ones */
    uint32_t nodes; /* of the division */
} pir_box_parts;

/* Keeps parts of a division that is joined. To be finished also where it fails. */
pir_status pir_box_parts_keep(const pir_box_division *division, pir_box_parts *ret_parts);
void pir_box_parts_finish(pir_box_parts *parts);

/* The image of parts under a symmetry. To be finished also where it fails. */
pir_status pir_box_parts_image(const pir_box_parts *parts, const pir_symmetries *symmetries, uint32_t number,
                               pir_box_parts *ret_image);

/* The bytes that parts take. */
size_t pir_box_parts_size(const pir_box_parts *parts);

/* Appends parts as bytes, the same for the same parts; false when out of memory. */
bool pir_box_parts_pack(const pir_box_parts *parts, pir_bytes *bytes);

/* Makes parts of bytes; false where these are none, or when out of memory. To be finished also then. */
bool pir_box_parts_unpack(const pir_bytes *bytes, pir_box_parts *ret_parts);

/* Whether two cells may share a point: false is proven. `shared` may be NULL; else it gets about such a point. */
bool pir_box_cells_meet(const pir_box_parts *a, const pir_box_cell *of_a, const pir_box_parts *b,
                        const pir_box_cell *of_b, double ret_shared[3]);

/* Whether a point may lie in a cell, likewise. */
bool pir_box_cell_has(const pir_box_parts *parts, const pir_box_cell *cell, const double x[3]);

#endif
