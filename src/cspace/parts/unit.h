/* SPDX-License-Identifier: MIT */
/*
 * A unit of a job that has been made: successive slices of one pair of pieces, in sections. Each section has a number
 * of elements for each slice and the elements of all slices one after another.
 */
#ifndef PIR_CSPACE_PARTS_UNIT_H
#define PIR_CSPACE_PARTS_UNIT_H

#include "cspace/record/record_bytes.h"

typedef enum pir_unit_section {
    PIR_UNIT_SECTION_RECORDS = 0, /* bytes */
    PIR_UNIT_SECTION_PLANES,      /* four doubles each: normal and offset */
    PIR_UNIT_SECTION_VERTICES,    /* three doubles each */
    PIR_UNIT_SECTION_COUNT,
} pir_unit_section;

/* Bytes of an element of each section, and its doubles; 0 for bytes. */
static const uint32_t pir_unit_section_element[PIR_UNIT_SECTION_COUNT] = {1, 32, 24};
static const uint32_t pir_unit_section_doubles[PIR_UNIT_SECTION_COUNT] = {0, 4, 3};

typedef struct pir_unit {
    uint64_t number;
    uint32_t slices, room;                    /* slices; how many `count` has room for */
    uint32_t *count[PIR_UNIT_SECTION_COUNT];  /* per slice: elements */
    pir_bytes data[PIR_UNIT_SECTION_COUNT];   /* empty where a job has no such section */
    uint64_t check[PIR_UNIT_SECTION_COUNT];   /* of the bytes of data */
    pir_bytes packed[PIR_UNIT_SECTION_COUNT]; /* data as the file keeps it; see pack.h */
} pir_unit;

/* Room for so many slices; false when out of memory, and there is nothing to finish then. */
bool pir_unit_init(pir_unit *unit, uint32_t slices, const pir_allocator *allocator);
void pir_unit_finish(pir_unit *unit, const pir_allocator *allocator);

/* Elements of all slices of a section. */
static inline uint64_t pir_unit_elements(const pir_unit *unit, int section) {
    uint64_t elements = 0;
    for (uint32_t i = 0; i < unit->slices; i++)
        elements += unit->count[section][i];
    return elements;
}

/* Works the checks out. */
void pir_unit_seal(pir_unit *unit);

#endif
