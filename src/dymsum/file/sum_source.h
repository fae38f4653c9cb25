/* SPDX-License-Identifier: MIT */
/*
 * The bytes of a sum while it is restored: the position of reading, and the numbers that stand there. The bytes are not
 * trusted: a caller takes numbers only after asking whether they are there, or from a call that asks itself.
 */
#ifndef PIR_DYMSUM_FILE_SUM_SOURCE_H
#define PIR_DYMSUM_FILE_SUM_SOURCE_H

#include <stdbool.h>

#include "dymsum/file/sum_file.h"
#include "polytope/polytope.h"

typedef struct pir_source {
    const uint8_t *data;
    size_t size, at;
    const char *part; /* what is being read, for reports */
    bool has_region, is_difference;
    const pir_allocator *allocator;
    pir_report *report;
} pir_source;

/* The limbs of a scale's two numbers. */
#define PIR_SCALE_LIMBS ((8 * PIR_SUM_NUMBER_MAX + GMP_NUMB_BITS - 1) / GMP_NUMB_BITS)

typedef struct pir_scale_room {
    mp_limb_t num[PIR_SCALE_LIMBS], den[PIR_SCALE_LIMBS];
} pir_scale_room;

/* --- sum_source.c --- */

/* Fills the report with what is wrong and where: PIR_ERR_FORMAT, PIR_ERR_MEMORY. */
pir_status pir_source_broken(const pir_source *from, const char *why);
pir_status pir_source_no_memory(const pir_source *from);

/* Whether `count` things of `size` bytes are left; size > 0. */
bool pir_source_has(const pir_source *from, uint64_t count, size_t size);

/* The next number, which must be there. */
uint32_t pir_source_u32(pir_source *from);
uint64_t pir_source_u64(pir_source *from);
double pir_source_double(pir_source *from);
pir_vec3 pir_source_vec(pir_source *from);
pir_quat pir_source_quat(pir_source *from);

/* An unsigned integer of `bytes` bytes, which must be there, into to->limb, which has pir_limbs_for_bytes of them. */
uint32_t pir_limbs_for_bytes(uint32_t bytes);
void pir_source_magnitude(pir_source *from, uint32_t bytes, pir_int *to);

/* A scale, in *room: PIR_ERR_FORMAT. */
pir_status pir_source_scale(pir_source *from, pir_scale_room *room, pir_scale *ret_scale);

/* --- restore_operand.c --- */

/* An operand, made anew as the hull of its vertices, at scale 1 and at its scale of now. Errors as pir_sum_restore. */
pir_status pir_source_operand(pir_source *from, pir_polytope **ret_made, pir_polytope **ret_now);

#endif
