/* SPDX-License-Identifier: MIT */
/* P, turned, and Q on one scale, in one space: their bodies and what those stand on. */
#ifndef PIR_SOLID_SUM_OPERANDS_H
#define PIR_SOLID_SUM_OPERANDS_H

#include "exact/rotation.h"
#include "solid/body/solid.h"

typedef struct pir_operands {
    pir_allocator allocator;
    pir_space space;
    bool has_space;
    pir_shell_body body[2];
    mpz_t *coordinate[2]; /* three a point, on the common scale */
    uint32_t count[2];
    uint32_t *reversed; /* of P, its facets' corners the other way round, when it is reflected */
    uint32_t reversed_count;
    mpz_t num, den; /* the scale */
} pir_operands;

/* P turned by `rotation` and, when `reflected`, through the origin. What is there after a failure is to be finished. */
pir_status pir_operands_init(pir_operands *operands, const pir_solid *const solid[2], pir_rotation *rotation,
                             bool reflected, const pir_solid_options *options);
void pir_operands_finish(pir_operands *operands);

#endif
