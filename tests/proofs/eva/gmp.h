/* SPDX-License-Identifier: MIT */
/*
 * GMP's functions on limbs as Eva sees them: each reads and writes the limbs that GMP's manual says, and writes any
 * values. Limbs are of 32 bits, so that the text without __int128 is analysed, which Eva does not know.
 */
#ifndef PIR_EVA_GMP_H
#define PIR_EVA_GMP_H

#include <stdint.h>

#include "__fc_builtin.h"

#define GMP_NUMB_BITS 32
typedef uint32_t mp_limb_t;
typedef long mp_size_t;
typedef unsigned long mp_bitcnt_t;

/* Numbers of any size, which readers make of texts. */
typedef struct {
    int sign;
} mpz_number, mpz_t[1], *mpz_ptr;
typedef struct {
    mpz_number num, den;
} mpq_number, mpq_t[1], *mpq_ptr;

#define mpq_numref(q)        (&(q)->num)
#define mpq_denref(q)        (&(q)->den)
#define mpz_sgn(z)           ((z)->sign)
#define mpq_sgn(q)           ((q)->num.sign)
#define mpq_init(q)          ((q)->num.sign = 0, (q)->den.sign = 1)
#define mpq_clear(q)         ((void)(q))
#define mpq_canonicalize(q)  ((void)(q))
#define mpz_set_ui(z, n)     ((z)->sign = (n) > 0)
#define mpq_set_d(q, x)      ((q)->num.sign = (x) > 0 ? 1 : (x) < 0 ? -1 : 0)
#define mpq_get_d(q)         Frama_C_double_interval(-0x1.fffffffffffffp1023, 0x1.fffffffffffffp1023)
#define mpq_cmp(p, q)        Frama_C_interval(-1, 1)
#define mpq_equal(p, q)      Frama_C_interval(0, 1)
#define mpz_set_str(z, s, b) ((z)->sign = Frama_C_interval(-1, 1), (void)(s)[0])

static inline mp_limb_t any_limb(void) {
    return Frama_C_unsigned_int_interval(0, UINT32_MAX);
}

static inline void read_limbs(const mp_limb_t *from, mp_size_t count) {
    volatile mp_limb_t read;
    for (mp_size_t i = 0; i < count; i++)
        read = from[i];
}

static inline void write_limbs(mp_limb_t *to, mp_size_t count) {
    for (mp_size_t i = 0; i < count; i++)
        to[i] = any_limb();
}

static inline mp_limb_t mpn_mul_1(mp_limb_t *to, const mp_limb_t *a, mp_size_t n, mp_limb_t b) {
    (void)b;
    read_limbs(a, n);
    write_limbs(to, n);
    return any_limb();
}

static inline mp_limb_t mpn_mul(mp_limb_t *to, const mp_limb_t *a, mp_size_t n, const mp_limb_t *b, mp_size_t m) {
    //@ assert n >= m >= 1;
    read_limbs(a, n);
    read_limbs(b, m);
    write_limbs(to, n + m);
    return to[n + m - 1];
}

static inline mp_limb_t mpn_add(mp_limb_t *to, const mp_limb_t *a, mp_size_t n, const mp_limb_t *b, mp_size_t m) {
    //@ assert n >= m >= 1;
    read_limbs(a, n);
    read_limbs(b, m);
    write_limbs(to, n);
    return Frama_C_unsigned_int_interval(0, 1);
}

static inline mp_limb_t mpn_sub(mp_limb_t *to, const mp_limb_t *a, mp_size_t n, const mp_limb_t *b, mp_size_t m) {
    return mpn_add(to, a, n, b, m);
}

static inline mp_limb_t mpn_sub_n(mp_limb_t *to, const mp_limb_t *a, const mp_limb_t *b, mp_size_t n) {
    return mpn_add(to, a, n, b, n);
}

static inline int mpn_cmp(const mp_limb_t *a, const mp_limb_t *b, mp_size_t n) {
    read_limbs(a, n);
    read_limbs(b, n);
    return Frama_C_interval(-1, 1);
}

static inline mp_limb_t mpn_lshift(mp_limb_t *to, const mp_limb_t *a, mp_size_t n, unsigned int bits) {
    //@ assert n >= 1 && 1 <= bits < GMP_NUMB_BITS;
    read_limbs(a, n);
    write_limbs(to, n);
    return Frama_C_unsigned_int_interval(0, (1u << bits) - 1);
}

static inline mp_limb_t mpn_rshift(mp_limb_t *to, const mp_limb_t *a, mp_size_t n, unsigned int bits) {
    (void)mpn_lshift(to, a, n, bits);
    return any_limb();
}

static inline mp_bitcnt_t mpn_scan1(const mp_limb_t *a, mp_bitcnt_t from) {
    (void)a;
    return Frama_C_unsigned_int_interval((unsigned int)from, 2098);
}

#endif
