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

/* Numbers of any size, of which only the sign is known, and of views and quotients how many limbs they have at most. */
typedef struct {
    int sign;
    mp_size_t size;
} mpz_number, mpz_t[1], *mpz_ptr;
typedef struct {
    mpz_number num, den;
} mpq_number, mpq_t[1], *mpq_ptr;

#define mpq_numref(q)         (&(q)->num)
#define mpq_denref(q)         (&(q)->den)
#define mpz_sgn(z)            ((z)->sign)
#define mpq_sgn(q)            ((q)->num.sign)
#define mpq_init(q)           ((q)->num.sign = 0, (q)->den.sign = 1)
#define mpq_clear(q)          ((void)(q))
#define mpq_canonicalize(q)   ((void)(q))
#define mpz_set_ui(z, n)      ((z)->sign = (n) > 0)
#define mpq_set_d(q, x)       ((q)->num.sign = (x) > 0 ? 1 : (x) < 0 ? -1 : 0)
#define mpq_get_d(q)          Frama_C_double_interval(-0x1.fffffffffffffp1023, 0x1.fffffffffffffp1023)
#define mpq_cmp(p, q)         Frama_C_interval(-1, 1)
#define mpq_equal(p, q)       Frama_C_interval(0, 1)
#define mpz_init_set_ui(z, n) mpz_set_ui(z, n)
#define mpz_clear(z)          ((void)(z))
#define mpz_lcm(z, a, b)      ((z)->sign = (a)->sign != 0 && (b)->sign != 0)
#define mpq_set(p, q)         ((p)->num.sign = (q)->num.sign, (p)->den.sign = (q)->den.sign)
#define mpz_set_str(z, s, b)  ((z)->sign = Frama_C_interval(-1, 1), (void)(s)[0])

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

/* Limbs that a number shows. */
#define PIR_EVA_LIMBS 8

static inline mpz_ptr mpz_roinit_n(mpz_ptr z, const mp_limb_t *limbs, mp_size_t n) {
    const mp_size_t size = n < 0 ? -n : n;
    read_limbs(limbs, size);
    z->sign = (n > 0) - (n < 0);
    z->size = size;
    return z;
}

static inline const mp_limb_t *mpz_limbs_read(const mpz_number *z) {
    static mp_limb_t shown[PIR_EVA_LIMBS];
    //@ assert z->size <= PIR_EVA_LIMBS;
    write_limbs(shown, PIR_EVA_LIMBS);
    return shown;
}

/* A quotient of integers is no longer than what is divided. */
static inline void mpz_divexact(mpz_ptr q, const mpz_number *a, const mpz_number *b) {
    //@ assert b->sign != 0;
    q->sign = a->sign * b->sign;
    q->size = Frama_C_long_interval(0, a->size);
}

static inline void mpz_tdiv_qr(mpz_ptr q, mpz_ptr rest, const mpz_number *a, const mpz_number *b) {
    //@ assert b->sign != 0;
    (void)a;
    q->sign = Frama_C_interval(-1, 1);
    rest->sign = Frama_C_interval(-1, 1);
}

static inline void mpz_gcd(mpz_ptr to, const mpz_number *a, const mpz_number *b) {
    to->sign = a->sign != 0 || b->sign != 0;
}

#define mpz_inits(...)            ((void)0)
#define mpz_clears(...)           ((void)0)
#define mpz_set(z, a)             (*(z) = *(a))
#define mpz_size(z)               ((size_t)(z)->size)
#define mpz_mul(to, a, b)         ((to)->sign = (a)->sign * (b)->sign)
#define mpz_cmp_ui(z, n)          ((z)->sign <= 0 ? -1 : Frama_C_interval(-1, 1))
#define mpz_sizeinbase(z, base)   ((size_t)Frama_C_unsigned_int_interval(1, 1 << 20))
#define mpz_mul_2exp(to, a, n)    ((to)->sign = (a)->sign, (void)(n))
#define mpz_tdiv_q_2exp(to, a, n) ((to)->sign = Frama_C_interval(0, 1) * (a)->sign, (void)(n))
#define mpz_setbit(z, n)          ((z)->sign = 1, (void)(n))
#define mpz_tstbit(z, n)          Frama_C_interval(0, 1)
#define mpz_scan1(z, n)           ((mp_bitcnt_t)Frama_C_unsigned_int_interval(0, 1 << 20))
#define mpz_odd_p(z)              Frama_C_interval(0, 1)
#define mpz_add_ui(to, a, n)      ((to)->sign = Frama_C_interval(0, 1))
#define mpz_get_d(z)              Frama_C_double_interval(-0x1p60, 0x1p60)

static inline mp_bitcnt_t mpn_scan1(const mp_limb_t *a, mp_bitcnt_t from) {
    (void)a;
    return Frama_C_unsigned_int_interval((unsigned int)from, 2098);
}

#endif
