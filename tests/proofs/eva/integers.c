/* SPDX-License-Identifier: MIT */
/* What Eva analyses: the functions of exact/integer.h on integers of any limbs, of up to MOST each. */
#include "__fc_builtin.h"

#include "exact/integer.h"

#define MOST 2

static mp_limb_t limbs[16][4 * MOST];

/* Any integer of a size, in room for as many limbs. */
static pir_int any_integer(int place, int32_t size) {
    pir_int a = {limbs[place], size, MOST};
    const uint32_t length = pir_int_length(&a);
    for (uint32_t i = 0; i < length; i++)
        limbs[place][i] = any_limb();
    // the invariant of integer.h
    if (length > 0)
        limbs[place][length - 1] = Frama_C_unsigned_int_interval(1, UINT32_MAX);
    return a;
}

static pir_int room_for(int place, uint32_t count) {
    return (pir_int){limbs[place], 0, count};
}

static int ask(int32_t of_a, int32_t of_b, uint32_t bits) {
    mp_limb_t memory[4 * MOST];
    pir_limbs scratch = {memory, 0, 4 * MOST};
    pir_int a = any_integer(0, of_a), b = any_integer(1, of_b), sum = room_for(2, MOST + 1),
            product = room_for(3, 2 * MOST), more = room_for(4, 2 * MOST + 1), shifted = room_for(5, 2 * MOST);
    pir_int_copy(&sum, &a);
    pir_int_add(&sum, &a, &b);
    pir_int_sub(&sum, &a, &b);
    pir_int_mul(&product, &a, &b);
    pir_int_copy(&more, &a);
    pir_int_add_mul(&more, &a, &b, &scratch);
    pir_int_copy(&more, &b);
    pir_int_sub_mul(&more, &a, &b, &scratch);
    pir_int_shift_left(&shifted, &a, bits);
    const pir_term terms[2] = {{&a, &b, false}, {&b, &a, true}};
    pir_int_sum(&more, terms, 2, &scratch);
    const pir_int3 u = {{a, b, a}}, v = {{b, b, a}};
    pir_int3 across = {{room_for(6, 2 * MOST + 1), room_for(7, 2 * MOST + 1), room_for(8, 2 * MOST + 1)}};
    pir_int3_dot(&more, &u, &v, &scratch);
    pir_int3_cross(&across, &u, &v, &scratch);
    int exponent;
    const double near = pir_int_to_double(&a, &exponent);
    (void)near;
    return pir_int_sign(&a) + (pir_int_bits(&b) > 0) + (pir_int_trailing_zeros(&a) > 0);
}

int main(void) {
    int all = 0;
    //@ loop unroll 8;
    for (int32_t a = -MOST; a <= MOST; a++)
        //@ loop unroll 8;
        for (int32_t b = -MOST; b <= MOST; b++)
            all |= ask(a, b, Frama_C_unsigned_int_interval(0, (MOST - 1) * GMP_NUMB_BITS));
    return all;
}
