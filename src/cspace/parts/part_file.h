/* SPDX-License-Identifier: MIT */
/* The bytes of a part: its header, and the header of each unit; and reading them back. */
#ifndef PIR_CSPACE_PARTS_PART_FILE_H
#define PIR_CSPACE_PARTS_PART_FILE_H

#include "cspace/parts/parts.h"

#define PIR_PART_MAGIC UINT64_C(0x0a33545241504950) /* "PIPART3\n" where bytes stand with the least first */
#define PIR_UNIT_MAGIC UINT64_C(0x54494e5552495031)

typedef struct pir_part_header {
    uint64_t magic, plan;
} pir_part_header;

/* Behind it stand the counts of each section that the plan has, then their packed bytes. */
typedef struct pir_unit_header {
    uint64_t magic, number, slices;
    uint64_t size[PIR_UNIT_SECTION_COUNT];   /* packed bytes, */
    uint64_t packed[PIR_UNIT_SECTION_COUNT]; /* and a hash of them */
    uint64_t check[PIR_UNIT_SECTION_COUNT];  /* of the bytes before they were packed */
    uint64_t counts;                         /* a hash of the counts */
    uint64_t hash;                           /* a hash of what stands before it */
} pir_unit_header;

/* The sections that a plan has: a bit for each. */
static inline unsigned pir_sections_of(const pir_plan *plan) {
    return 1u | (plan->planes ? 2u : 0) | (plan->vertices ? 4u : 0);
}

/* The header of a unit that is sealed and packed. */
pir_unit_header pir_unit_header_of(const pir_unit *unit, unsigned sections);

/* Whether it is the header of a unit of the plan. */
bool pir_unit_header_holds(const pir_unit_header *header, const pir_plan *plan);

/* The bytes of the unit behind its header. */
static inline uint64_t pir_unit_body(const pir_unit_header *header, unsigned sections) {
    uint64_t size = 0;
    for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++)
        size += sections & 1u << s ? header->slices * sizeof(uint32_t) + header->size[s] : 0;
    return size;
}

/*
 * Reads the unit whose header stands at `at` into `unit`, which has room for its slices, and checks it against its
 * checksums: its counts, its packed bytes, and the checks of what these were made of. Errors: PIR_ERR_FORMAT,
 * PIR_ERR_FILE, PIR_ERR_MEMORY.
 */
pir_status pir_unit_read(int descriptor, uint64_t at, const pir_plan *plan, pir_unit *unit);

#endif
