/* SPDX-License-Identifier: MIT */
/*
 * Parts: what a job that is under way has made. A part is a file that only grows, FILE.part0, FILE.part1, …, one for
 * each process of the job. It begins with a header that names the plan, and holds units one after another, each with a
 * checksum.
 *
 * A process that is killed leaves at most one unit that is not whole, at the end of its part, whatever had been written
 * of it: reading stops at the first unit whose checksum does not match, and its owner goes on from there. A unit that
 * could not be written in full, as on a full disk, is cut off again.
 *
 * Numbers are in the machine's own order: parts are read by machines of the kind that wrote them.
 */
#ifndef PIR_CSPACE_PARTS_PARTS_H
#define PIR_CSPACE_PARTS_PARTS_H

#include "cspace/parts/plan.h"
#include "cspace/parts/unit.h"

/* The part that this process appends to. */
typedef struct pir_part {
    int descriptor;    /* or -1 */
    uint64_t end;      /* of what is whole */
    unsigned sections; /* of the plan: a bit for each */
    double synced;     /* when it was last made to reach the disk, in seconds of a clock */
    char *path;
    size_t path_size;
} pir_part;

/* Where a unit stands. */
typedef struct pir_unit_place {
    uint32_t part; /* 1 + its number; 0: in none */
    uint64_t at;   /* of the unit's header in its part */
} pir_unit_place;

/* All parts of a job. */
typedef struct pir_parts {
    pir_allocator allocator;
    const pir_plan *plan; /* borrowed */
    const char *file;     /* the file that is being made; borrowed */
    pir_unit_place *unit; /* per unit of the plan */
    uint64_t found;       /* parts, those without a whole unit included */
    uint64_t done;        /* units that stand in some part */
    uint64_t done_slices;
    uint64_t done_bytes; /* at most what the file will take for these, beside tables */
} pir_parts;

/* False when out of memory. pir_parts_finish releases whatever is there. */
bool pir_parts_init(pir_parts *parts, const pir_plan *plan, const char *file);
void pir_parts_finish(pir_parts *parts);

/*
 * Reads what the parts beside the file hold. Errors: PIR_ERR_FILE; PIR_ERR_FORMAT where a part is of another job;
 * PIR_ERR_MEMORY.
 */
pir_status pir_parts_scan(pir_parts *parts, pir_report *report);

/* Files that runs leave beside the output: parts, and those being made of all parts, under names of their own. */
enum pir_left { PIR_LEFT_PARTS = 1, PIR_LEFT_ASSEMBLING = 2, PIR_LEFT_ALL = 3 };

/* How the name of such a file goes on behind that of the one that it is to be. */
#define PIR_ASSEMBLING ".assembling"

/* Removes what is left beside the file, of the kinds given as bits. Errors: PIR_ERR_FILE, PIR_ERR_MEMORY. */
pir_status pir_parts_remove(const pir_parts *parts, unsigned kinds, pir_report *report);

/*
 * Opens part `number` to append to, behind the last unit of it that is whole, and locks it. Errors: PIR_ERR_FILE (also
 * where another process has it), PIR_ERR_FORMAT (of another job), PIR_ERR_MEMORY.
 */
pir_status pir_part_open(pir_part *part, const pir_parts *parts, uint32_t number, pir_report *report);

/* Appends a unit that is sealed and packed, and now and then sees to it that what was written is on the disk. */
pir_status pir_part_append(pir_part *part, const pir_unit *unit, pir_report *report);

/* Closes the part. PIR_ERR_FILE where that fails. */
pir_status pir_part_close(pir_part *part, const pir_allocator *allocator, pir_report *report);

/* Notes that a unit stands in part `number`, where none had it. */
void pir_parts_note(pir_parts *parts, const pir_unit *unit, uint32_t number, uint64_t at);

/*
 * Reads a unit that stands in a part, packed as it is; `unit` has room for its slices. Errors: PIR_ERR_FILE,
 * PIR_ERR_FORMAT, PIR_ERR_MEMORY.
 */
pir_status pir_parts_read(const pir_parts *parts, uint64_t number, pir_unit *unit, pir_report *report);

#endif
