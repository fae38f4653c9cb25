/* SPDX-License-Identifier: MIT */
/* The product of two quaternions as Eva sees it: any doubles, for it knows no vectors. */
#ifndef PIR_EVA_QUAT_PRODUCT_H
#define PIR_EVA_QUAT_PRODUCT_H

#include "__fc_builtin.h"

#include "exact/rotation.h"

typedef struct pir_quat_product {
    pir_quat whole, rest;
} pir_quat_product;

static inline double any_double(void) {
    return Frama_C_double_interval(-0x1.fffffffffffffp1023, 0x1.fffffffffffffp1023);
}

static inline pir_quat any_quaternion(void) {
    return (pir_quat){any_double(), any_double(), any_double(), any_double()};
}

static inline pir_quat_product pir_quat_conjugate_times(pir_quat a, pir_quat b) {
    (void)a;
    (void)b;
    return (pir_quat_product){any_quaternion(), any_quaternion()};
}

#endif
