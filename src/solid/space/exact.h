/* SPDX-License-Identifier: MIT */
/* The exact numbers of points and planes, made from their definitions when they are first asked for. */
#ifndef PIR_SOLID_SPACE_EXACT_H
#define PIR_SOLID_SPACE_EXACT_H

#include "exact/integer.h"
#include "solid/space/space.h"

/* A GMP integer as one of ours, borrowed, to be read only. */
static inline pir_int pir_int_of_mpz(mpz_srcptr z) {
    return (pir_int){(mp_limb_t *)mpz_limbs_read(z), mpz_sgn(z) * (int32_t)mpz_size(z), 0};
}

/* X, Y, Z, W of a point and a, b, c, d of a plane: the number of the first of four. */
uint32_t pir_space_exact_point(pir_space *space, uint32_t point);
uint32_t pir_space_exact_plane(pir_space *space, uint32_t plane);

/* x, y, z of a direction: the number of the first of three. */
uint32_t pir_space_exact_direction(pir_space *space, uint32_t direction);

/* Divides `count` numbers by their greatest common divisor. */
void pir_numbers_reduce(mpz_t *number, uint32_t count, mpz_ptr scratch);

/* ret = a × b; `ret` is none of them. */
void pir_numbers_cross(mpz_t *ret, mpz_t *a, mpz_t *b);

/* ret = a · b over `count` components. */
void pir_numbers_dot(mpz_ptr ret, mpz_t *a, mpz_t *b, uint32_t count);

/* Doubles of a point and of a plane that have exact numbers; and of a direction. */
void pir_space_round_point(pir_space *space, uint32_t point);
void pir_space_round_plane(pir_space *space, uint32_t plane);
void pir_space_round_direction(double ret[3], mpz_t *number);

#endif
