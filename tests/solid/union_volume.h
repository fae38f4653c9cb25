/* SPDX-License-Identifier: MIT */
/* The exact volume of a sum of solids by other means: the union of the sums of all pairs of their pieces, as hulls. */
#ifndef PIR_TEST_SOLID_UNION_VOLUME_H
#define PIR_TEST_SOLID_UNION_VOLUME_H

#include <stdbool.h>

#include <gmp.h>

#include <pirouette/solid.h>

/* False, without a volume, where there are more than `most` pairs, or the numbers are too long for hulls. */
bool union_volume(const pir_solid *p, const pir_solid *q, pir_quat turn, uint32_t most, mpq_t ret_volume);

#endif
