/* SPDX-License-Identifier: MIT */
/* What Eva analyses: the functions of exact/integer.h on integers of any limbs, of up to MOST each. */
#include "__fc_builtin.h"

#include "exact/integer.h"

#define MOST 2

static mp_limb_t limbs[16][4 * MOST], of_a[MOST], of_b[MOST];

/* Any integer of a size, at the end of an array: nothing beyond it may be read. */
static pir_int any_integer(mp_limb_t array[MOST], int32_t size) {
    const uint32_t length = (uint32_t)(size < 0 ? -size : size);
    const pir_int a = {length > 0 ? array + (MOST - length) : array, size, length};
    write_limbs(a.limb, length);
    // the invariant of integer.h
    if (length > 0)
        a.limb[length - 1] = Frama_C_unsigned_int_interval(1, UINT32_MAX);
    return a;
}

static pir_int room_for(int place, uint32_t count) {
    return (pir_int){limbs[place], 0, count};
}

static int ask(int32_t size_a, int32_t size_b, uint32_t bits) {
    mp_limb_t memory[4 * MOST];
    pir_limbs scratch = {memory, 0, 4 * MOST};
    const pir_int a = any_integer(of_a, size_a), b = any_integer(of_b, size_b);
    pir_int sum = room_for(2, MOST + 1), product = room_for(3, 2 * MOST), more = room_for(4, 2 * MOST + 1),
            shifted = room_for(5, 2 * MOST);
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

/* Any double in units of its lowest bit and of less, and an integer without some of the zeros at its end. */
static int ask_double(uint32_t bits) {
    const double x = Frama_C_double_interval(-0x1.fffffffffffffp1023, 0x1.fffffffffffffp1023);
    pir_int a = room_for(0, 2 * MOST);
    const int low = pir_double_low_bit(x);
    if (low != INT32_MAX)
        pir_int_set_double(&a, x, low);
    pir_int b = any_integer(of_b, MOST);
    if (bits < pir_int_trailing_zeros(&b))
        pir_int_shift_right(&b, bits);
    return pir_int_sign(&a) + pir_int_sign(&b) + (pir_double_limbs(low == INT32_MAX ? 1 : 1024, -1074) > 1);
}

int main(void) {
    int all = 0;
    //@ loop unroll 2 * GMP_NUMB_BITS;
    for (uint32_t bits = 0; bits < 2 * GMP_NUMB_BITS; bits++)
        all |= ask_double(bits);
    //@ loop unroll 8;
    for (int32_t a = -MOST; a <= MOST; a++)
        //@ loop unroll 8;
        for (int32_t b = -MOST; b <= MOST; b++)
            all |= ask(a, b, Frama_C_unsigned_int_interval(0, (MOST - 1) * GMP_NUMB_BITS));
    return all;
}
