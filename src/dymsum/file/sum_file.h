/* SPDX-License-Identifier: MIT */
/*
 * Sums as bytes, the same on every machine. All numbers are little-endian, whatever the machine's own order; u32 and
 * u64 are unsigned.
 *
 *     header     8 bytes   "PIRSUM\r\n"
 *                u32       version, 2
 *                u32       flags: 1 for a sum with a region, 2 for one that was made as a difference, P reflected
 *                u64       the length of the whole in bytes
 *                u64       checksum: FNV-1a of all other bytes
 *     operands   P, then Q, each:
 *                u32       dimension; vertices; facets, 0 below dimension 2; w, the bytes of a coordinate
 *                number    the scale's numerator, then its denominator: u32 bytes, then that many, least significant
 *                          first
 *                vertices  three coordinates each: a byte, 1 for a negative one, then w bytes; times the scale
 *                sources   u32 each, as pir_polytope_source gives them
 *                facets    u32 corners of each; then u32 each corner, a vertex
 *                u32       1 when the operand's scale was set, and then it follows as two numbers; else 0
 *     motion     4 u64     the quaternion that the pairing is exact at, as IEEE-754 doubles
 *                u64       the tolerance, a double
 *                u32       1 when another rotation is shown within the tolerance, and then 4 u64, its quaternion;
 *                          else 0
 *     region     where there is one, doubles as above: the axis, three; the half-angle; the axis as P saw it and as Q
 *                did when what is kept was chosen, three each; the skins of P and of Q; the stride, 0 after a walk;
 *                then u32 the updates since, and the last step: see cover.h
 *     pairing    u32 each  fv; vf; the number of crossings of each edge of P; then, edge by edge, 2·(edge of Q), plus
 *                          1 when it is crossed against its direction from the smaller vertex to the larger
 *
 * A facet that the region leaves out has 2^32 - 1 for its vertex; an edge that it leaves out has no crossings.
 *
 * Facets and edges of a polytope are numbered as polytope.h says, those of a segment included.
 */
#ifndef PIR_DYMSUM_FILE_SUM_FILE_H
#define PIR_DYMSUM_FILE_SUM_FILE_H

#include <stddef.h>
#include <stdint.h>

#include "polytope/exact_points.h"

#define PIR_SUM_MAGIC       "PIRSUM\r\n"
#define PIR_SUM_VERSION     2u
#define PIR_SUM_REGION      1u
#define PIR_SUM_DIFFERENCE  2u
#define PIR_SUM_HEADER_SIZE 32u
#define PIR_SUM_CHECKSUM_AT 24u

/*
 * The most bytes that a coordinate and a number of the scale may take: as many as those of any polytope take at most.
 */
#define PIR_SUM_COORDINATE_MAX (PIR_COORDINATE_BITS_MAX / 8)
#define PIR_SUM_NUMBER_MAX     (PIR_SCALE_BITS_MAX / 8)

/* The checksum of a whole file, header and all. */
uint64_t pir_sum_file_checksum(const uint8_t *data, size_t size);

#endif
