/* SPDX-License-Identifier: MIT */
/* The exact mesh of a sum of solids at one rotation. */
#ifndef PIR_TEST_SOLID_SUMS_H
#define PIR_TEST_SOLID_SUMS_H

#include <pirouette/solid.h>

/* ret_info may be NULL. Nothing is made when it fails. */
static inline pir_status solid_sum_mesh(const pir_solid *p, const pir_solid *q, pir_quat rotation,
                                        const pir_solid_sum_options *options, pir_solid_sum_info *ret_info,
                                        pir_mesh **ret_mesh) {
    pir_solid_sum *sum = NULL;
    pir_status status = pir_solid_sum_create(p, q, rotation, options, &sum);
    if (status == PIR_OK)
        status = pir_solid_sum_mesh(sum, PIR_EXACT, ret_mesh);
    if (status == PIR_OK && ret_info)
        status = pir_solid_sum_describe(sum, ret_info);
    pir_solid_sum_destroy(sum);
    return status;
}

#endif
