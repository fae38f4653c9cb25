/* SPDX-License-Identifier: MIT */
/*
 * Integers as exact/integer.h tells of them, in place of integer.c, which is analysed by itself: each function reads
 * its operands, ends the process where there is no room for the result, and writes any limbs.
 */
#include <stdlib.h>

#include "__fc_builtin.h"

#include "exact/integer.h"

void pir_int_outgrown(void) {
    exit(1);
}

static uint32_t longer(uint32_t a, uint32_t b) {
    return a > b ? a : b;
}

/* The operand's length, all of which may be read. */
static uint32_t read_whole(const pir_int *a) {
    const uint32_t length = pir_int_length(a);
    //@ assert length == 0 || \valid_read(a->limb + (0 .. length - 1));
    return length;
}

/* Room for a product in a scratch, all of which may be written. */
static void use_scratch(pir_limbs *scratch, uint32_t length) {
    const uint32_t mark = scratch->used;
    const pir_int product = pir_limbs_take(scratch, length);
    //@ assert length == 0 || \valid(product.limb + (0 .. length - 1));
    (void)product;
    scratch->used = mark;
}

/* Any result of up to `most` limbs. */
static void write_any(pir_int *dst, uint32_t most) {
    const uint32_t length = Frama_C_unsigned_int_interval(0, most);
    pir_int_check_room(dst->room, length);
    //@ assert length == 0 || \valid(dst->limb + (0 .. length - 1));
    for (uint32_t i = 0; i < dst->room; i++)
        dst->limb[i] = any_limb();
    dst->size = Frama_C_interval(0, 1) ? (int32_t)length : -(int32_t)length;
}

void pir_int_copy(pir_int *dst, const pir_int *a) {
    write_any(dst, read_whole(a));
}

void pir_int_add(pir_int *dst, const pir_int *a, const pir_int *b) {
    write_any(dst, longer(read_whole(a), read_whole(b)) + 1);
}

void pir_int_sub(pir_int *dst, const pir_int *a, const pir_int *b) {
    pir_int_add(dst, a, b);
}

void pir_int_add_mul(pir_int *dst, const pir_int *a, const pir_int *b, pir_limbs *scratch) {
    const uint32_t product = read_whole(a) + read_whole(b);
    use_scratch(scratch, product);
    write_any(dst, longer(read_whole(dst), product) + 1);
}

void pir_int_sub_mul(pir_int *dst, const pir_int *a, const pir_int *b, pir_limbs *scratch) {
    pir_int_add_mul(dst, a, b, scratch);
}

void pir_int_sum(pir_int *dst, const pir_term *terms, uint32_t count, pir_limbs *scratch) {
    uint32_t longest = 0;
    for (uint32_t k = 0; k < count; k++)
        longest = longer(longest, read_whole(terms[k].a) + read_whole(terms[k].b));
    if (Frama_C_interval(0, 1))
        use_scratch(scratch, longest);
    write_any(dst, longest + 1);
}

void pir_int_set_double(pir_int *dst, double x, int exponent) {
    (void)x;
    (void)exponent;
    write_any(dst, dst->room);
}

void pir_int_shift_left(pir_int *dst, const pir_int *a, uint32_t bits) {
    write_any(dst, read_whole(a) + bits / GMP_NUMB_BITS + 1);
}

void pir_int_shift_right(pir_int *a, uint32_t bits) {
    (void)bits;
    write_any(a, read_whole(a));
}

uint32_t pir_int_trailing_zeros(const pir_int *a) {
    return read_whole(a) == 0 ? UINT32_MAX : Frama_C_unsigned_int_interval(0, 32 * read_whole(a) - 1);
}

uint32_t pir_int_bits(const pir_int *a) {
    return Frama_C_unsigned_int_interval(0, 32 * read_whole(a));
}

double pir_int_to_double(const pir_int *a, int *ret_exponent) {
    *ret_exponent = Frama_C_interval(0, 32 * (int)read_whole(a));
    return Frama_C_double_interval(-1, 1);
}

void pir_int3_cross(pir_int3 *dst, const pir_int3 *a, const pir_int3 *b, pir_limbs *scratch) {
    for (int k = 0; k < 3; k++) {
        const pir_term terms[2] = {{&a->c[(k + 1) % 3], &b->c[(k + 2) % 3], false},
                                   {&a->c[(k + 2) % 3], &b->c[(k + 1) % 3], true}};
        pir_int_sum(&dst->c[k], terms, 2, scratch);
    }
}

void pir_int3_dot(pir_int *dst, const pir_int3 *a, const pir_int3 *b, pir_limbs *scratch) {
    const pir_term terms[3] = {{&a->c[0], &b->c[0], false}, {&a->c[1], &b->c[1], false}, {&a->c[2], &b->c[2], false}};
    pir_int_sum(dst, terms, 3, scratch);
}

uint32_t pir_int3_length(const pir_int3 *a) {
    return longer(pir_int_length(&a->c[0]), longer(pir_int_length(&a->c[1]), pir_int_length(&a->c[2])));
}
