/* SPDX-License-Identifier: MIT */
/*
 * Rotations in doubles as a call on a pair takes them: versions for processors that give the same bits
 * (base/processor.h), those of `rotation` and `quat_product`.
 */
#ifndef PIR_EXACT_RELATIVE_TURN_H
#define PIR_EXACT_RELATIVE_TURN_H

#include "exact/quat_product.h"

typedef struct pir_relative_version {
    /*
     * The rotation of p as q sees it: conj(q)·p, and the doubles of that with its sign. False, and nothing is written,
     * where the greatest component of either is not in [0.5, 1), or one that is not 0 is below 2^-400. So no product of
     * two, nor what rounding leaves of it, is below 2^-1022.
     */
    bool (*find)(const pir_quat *q, const pir_quat *p, pir_quat_product *ret_product, pir_quat *ret_unit,
                 pir_mat3 *ret_r);
    /* The doubles of q with its sign. False, and nothing is written, where q has to be scaled. */
    bool (*turn)(const pir_quat *q, pir_quat *ret_unit, pir_mat3 *ret_r);
} pir_relative_version;

extern const pir_relative_version pir_relative_plain, pir_relative_avx2;

/* The least magnitude of a component that is not 0, and of the greatest. */
#define PIR_RELATIVE_LEAST 0x1p-400
#define PIR_RELATIVE_MOST  0.5

#endif
