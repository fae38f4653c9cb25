/* SPDX-License-Identifier: MIT */
/*
 * An open file of slices, and the slice that was read last.
 *
 * A slice is read from the key slice before it by applying the records in between, so the slice after the last one
 * costs one record. The units asked last stay.
 *
 * Invariant: where has_slice is set, `replay` holds the pairing of slice `slice` of unit `at`.
 */
#ifndef PIR_CSPACE_READ_CSPACE_H
#define PIR_CSPACE_READ_CSPACE_H

#include <pirouette/cspace.h>

#include "cspace/record/replay.h"
#include "cspace/store/store.h"

/*
 * How many units are kept. The slices nearest to a rotation stand in several, which are asked by turns as the rotation
 * moves.
 */
#define PIR_UNITS_KEPT 16

/* A unit that has been read and checked. */
typedef struct pir_cspace_unit {
    pir_unit unit;      /* records alone */
    pir_quat *rotation; /* of its slices */
    uint64_t asked;     /* when it was asked last, counted in asks; 0: nothing is there */
} pir_cspace_unit;

/* The slice that was read last. */
typedef struct pir_cspace_cursor {
    pir_cspace_unit kept[PIR_UNITS_KEPT];
    const pir_cspace_unit *at; /* of them, the unit of the slice; NULL: none */
    uint64_t asks;
    bool has_slice;  /* the replay is at `slice` of it */
    uint64_t offset; /* in the unit's bytes, of the record after `slice` */
    uint32_t slice;  /* counted in the unit */
    uint64_t pair;   /* that the replay is of, where has_replay */
    bool has_replay;
    pir_polytope *minus_p; /* of that pair; held */
    pir_record_replay replay;
    uint32_t (*ee)[2]; /* room for the pairs that are shown */
    uint32_t ee_room;
    pir_halfspace *plane; /* likewise */
    uint32_t plane_room;
} pir_cspace_cursor;

struct pir_cspace {
    pir_allocator allocator;
    pir_store *store;
    pir_grid *grid;
    pir_cspace_info info;
    uint64_t units_per_pair;
    pir_cspace_cursor cursor;
    /* The state that answers keep between calls, and the function that frees it; NULL before the first question. */
    void *answers;
    void (*answers_free)(pir_cspace *cspace);
};

/*
 * Brings the cursor to a slice, and gives its crossings, in order; they hold until the next call. Errors as of
 * pir_cspace_slice.
 */
pir_status pir_cspace_go_to(pir_cspace *cspace, pir_cspace_place place, pir_report *report,
                            const pir_record_replay_crossing **ret_crossings, uint32_t *ret_count);

/* The rotation that the cursor is at. */
static inline pir_quat pir_cspace_cursor_rotation(const pir_cspace *cspace) {
    return cspace->cursor.at->rotation[cspace->cursor.slice];
}

#endif
