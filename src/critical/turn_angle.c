/* SPDX-License-Identifier: MIT */
/* A κ exactly: see turn_angle.h. The room of signs is an integer of GMP's, so nothing here fails. */
#include "critical/turn_angle.h"

#include <math.h>

/* An approximation of κ is within this of it, relatively: 32u of σ and τ, and the rounding of two products. */
#define APPROXIMATE 0x1p-47

/* κ of such a size is no denormal in any unit that a double can be in. */
#define LEAST_KAPPA 0x1p-900

void pir_turn_angle_init(pir_turn_angle *angle) {
    *angle = (pir_turn_angle){.first = false};
    mpz_inits(angle->c[0], angle->c[1], angle->c[2], NULL);
}

void pir_turn_angle_clear(pir_turn_angle *angle) {
    mpz_clears(angle->c[0], angle->c[1], angle->c[2], NULL);
}

/* --- quadratics of GMP's integers --- */

/* A view of three integers, which ends with them. */
static pir_quadratic view_of(mpz_t c[3]) {
    pir_quadratic view;
    for (int i = 0; i < 3; i++) {
        const int32_t size = (int32_t)mpz_size(c[i]);
        view.c[i] = (pir_int){(mp_limb_t *)mpz_limbs_read(c[i]), mpz_sgn(c[i]) < 0 ? -size : size, 0};
    }
    return view;
}

/* Room for signs of two quadratics, in an integer that the caller clears. */
static pir_limbs room_for(mpz_t memory, mpz_t a[3], mpz_t b[3]) {
    size_t most = 1;
    for (int i = 0; i < 3; i++) {
        most = mpz_size(a[i]) > most ? mpz_size(a[i]) : most;
        most = mpz_size(b[i]) > most ? mpz_size(b[i]) : most;
    }
    const uint32_t room = PIR_QUADRATIC_SCRATCH((uint32_t)most);
    mpz_init(memory);
    return (pir_limbs){mpz_limbs_write(memory, (mp_size_t)room), 0, room};
}

int pir_turn_angle_sign(const pir_turn_angle *angle, mpz_t c[3], pir_turn_when when) {
    const pir_quadratic p = view_of(c);
    if (angle->first)
        return when == PIR_TURN_AT ? mpz_sgn(c[0]) : pir_quadratic_sign_first(&p);
    mpz_t memory, *own = (mpz_t *)angle->c;
    pir_limbs scratch = room_for(memory, c, own);
    const pir_quadratic root = view_of(own);
    const int sign = when == PIR_TURN_AT ? pir_quadratic_sign_at(&p, &root, &scratch)
                                         : pir_quadratic_sign_after(&p, &root, &scratch);
    mpz_clear(memory);
    return sign;
}

int pir_turn_angle_order(const pir_turn_angle *a, const pir_turn_angle *b) {
    if (a->between[0] > b->between[1] || a->between[1] < b->between[0])
        return a->between[0] > b->between[1] ? 1 : -1;
    if (a->between[0] == a->between[1] && b->between[0] == b->between[1])
        return 0;
    mpz_t memory, *first = (mpz_t *)a->c, *second = (mpz_t *)b->c;
    pir_limbs scratch = room_for(memory, first, second);
    const pir_quadratic x = view_of(first), y = view_of(second);
    const int order = pir_quadratic_compare(&x, &y, &scratch);
    mpz_clear(memory);
    return order;
}

/* --- doubles --- */

pir_turn_direction pir_turn_direction_of(const pir_turned *turned, double kappa) {
    const pir_turn_direction none = {0, 0, false};
    if (!(fabs(kappa) >= LEAST_KAPPA && fabs(kappa) <= 1 / LEAST_KAPPA))
        return none;
    const double scaled = ldexp(kappa, -(turned->exponent + turned->width));
    if (!(fabs(scaled) >= LEAST_KAPPA && fabs(scaled) <= 1 / LEAST_KAPPA))
        return none;
    return fabs(scaled) <= 1 ? (pir_turn_direction){scaled, 1, true}
                             : (pir_turn_direction){scaled < 0 ? -1 : 1, 1 / fabs(scaled), true};
}

/* Sets the doubles to those around an approximation σ/τ in k, each within 16u. */
static void set_between(pir_turn_angle *angle, const pir_turned *turned, pir_scaled sigma, pir_scaled tau) {
    const double kappa = sigma.m == 0 ? 0 : ldexp(sigma.m / tau.m, sigma.e - tau.e + turned->exponent);
    const bool is_normal = fabs(kappa) >= LEAST_KAPPA && fabs(kappa) <= 1 / LEAST_KAPPA;
    angle->between[0] = kappa - fabs(kappa) * APPROXIMATE;
    angle->between[1] = kappa + fabs(kappa) * APPROXIMATE;
    if (!is_normal && sigma.m != 0) {
        // far out, or near 0: on which side is known
        angle->between[0] = sigma.m < 0 ? -INFINITY : 0;
        angle->between[1] = sigma.m < 0 ? 0 : INFINITY;
    }
    angle->direction = sigma.m == 0 ? (pir_turn_direction){0, 1, true} : pir_turn_direction_of(turned, kappa);
}

/* --- making --- */

void pir_turn_angle_at(pir_turn_angle *angle, const pir_turned *turned, double kappa) {
    angle->first = kappa == INFINITY;
    angle->between[0] = angle->between[1] = kappa;
    angle->direction = kappa == INFINITY ? (pir_turn_direction){1, 0, true}
                       : kappa == 0      ? (pir_turn_direction){0, 1, true}
                                         : pir_turn_direction_of(turned, kappa);
    if (angle->first)
        return;
    // −τ·k + σ, κ = σ/τ·2^exponent
    mpz_set_ui(angle->c[0], 0);
    mpz_set_si(angle->c[1], -1);
    mpz_set_ui(angle->c[2], 0);
    if (kappa == 0)
        return;
    const int low = pir_double_low_bit(kappa), shift = low - turned->exponent;
    pir_integer_of_double(angle->c[2], kappa, low);
    mpz_t *scaled = &angle->c[shift < 0 ? 1 : 2];
    mpz_mul_2exp(*scaled, *scaled, (mp_bitcnt_t)(shift < 0 ? -shift : shift));
}

/* dst = q·conj(p) of integers x, y, z, w. */
static void quotient(mpz_t dst[4], mpz_t q[4], mpz_t p[4]) {
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        mpz_mul(dst[k], q[k], p[3]);
        mpz_submul(dst[k], q[3], p[k]);
        mpz_submul(dst[k], q[i], p[j]);
        mpz_addmul(dst[k], q[j], p[i]);
    }
    mpz_mul(dst[3], q[3], p[3]);
    for (int k = 0; k < 3; k++)
        mpz_addmul(dst[3], q[k], p[k]);
}

static void set_quat(mpz_t dst[4], pir_quat q) {
    const double c[4] = {q.x, q.y, q.z, q.w};
    int low = INT32_MAX;
    for (int k = 0; k < 4; k++)
        low = pir_double_low_bit(c[k]) < low ? pir_double_low_bit(c[k]) : low;
    for (int k = 0; k < 4; k++) {
        mpz_init(dst[k]);
        if (c[k] != 0)
            pir_integer_of_double(dst[k], c[k], low);
    }
}

bool pir_turn_angle_of(pir_turn_angle *angle, const pir_turned *turned, pir_quat q, pir_quat start) {
    mpz_t a[4], b[4], turn[4], along, part;
    set_quat(a, q);
    set_quat(b, start);
    mpz_inits(turn[0], turn[1], turn[2], turn[3], along, part, NULL);
    quotient(turn, a, b);
    // (v, σ) is a multiple of (u, k) where v × u is 0
    bool is_turn = true;
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        mpz_mul(part, turn[i], turned->axis[j]);
        mpz_submul(part, turn[j], turned->axis[i]);
        is_turn = is_turn && mpz_sgn(part) == 0;
        mpz_addmul(along, turn[k], turned->axis[k]);
    }
    angle->first = mpz_sgn(along) == 0;
    angle->between[0] = angle->between[1] = INFINITY;
    angle->direction = (pir_turn_direction){1, 0, true};
    if (is_turn && !angle->first) {
        // k = σ |u|²/(v·u)
        mpz_set_ui(angle->c[0], 0);
        mpz_mul(angle->c[2], turn[3], turned->square);
        if (mpz_sgn(along) < 0)
            mpz_neg(angle->c[2], angle->c[2]);
        mpz_abs(along, along);
        mpz_neg(angle->c[1], along);
        signed long up, down;
        const double sigma = mpz_get_d_2exp(&up, angle->c[2]), tau = mpz_get_d_2exp(&down, along);
        set_between(angle, turned, (pir_scaled){sigma, (int)up}, (pir_scaled){tau, (int)down});
    }
    mpz_clears(turn[0], turn[1], turn[2], turn[3], along, part, NULL);
    for (int k = 0; k < 4; k++)
        mpz_clears(a[k], b[k], NULL);
    return is_turn;
}

bool pir_turn_angle_root(pir_turn_angle *angle, const pir_turned *turned, mpz_t root[3], int sign) {
    for (int i = 0; i < 3; i++) {
        if (sign < 0)
            mpz_neg(angle->c[i], root[i]);
        else
            mpz_set(angle->c[i], root[i]);
    }
    mpz_t memory;
    pir_limbs scratch = room_for(memory, angle->c, angle->c);
    const pir_quadratic view = view_of(angle->c);
    const bool has_exit = pir_quadratic_has_exit(&view, &scratch);
    angle->first = false;
    if (has_exit) {
        pir_scaled sigma, tau;
        pir_quadratic_approximate(&view, &sigma, &tau, &scratch);
        set_between(angle, turned, sigma, tau);
    }
    mpz_clear(memory);
    return has_exit;
}

/* The sign of κ less x. */
static int side_of(const pir_turn_angle *angle, const pir_turned *turned, double x) {
    pir_turn_angle at;
    pir_turn_angle_init(&at);
    pir_turn_angle_at(&at, turned, x);
    mpz_t memory, *own = (mpz_t *)angle->c;
    pir_limbs scratch = room_for(memory, own, at.c);
    const pir_quadratic root = view_of(own), other = view_of(at.c);
    const int side = pir_quadratic_compare(&root, &other, &scratch);
    mpz_clear(memory);
    pir_turn_angle_clear(&at);
    return side;
}

/* A double in the middle of two, as their bits are: at most 64 halvings reach neighbours. */
static double middle_of(double a, double b) {
    if (a < 0 && b > 0)
        return 0;
    const double most = 0x1.fffffffffffffp1023;
    if (a < 0)
        return -middle_of(-b, -a);
    // of sizes far apart the geometric middle
    b = fmin(b, most);
    if (b > 4 * a)
        return fmin(b, fmax(nextafter(a, b), sqrt(fmax(a, 0x1p-1074)) * sqrt(b)));
    return a + (b - a) / 2;
}

void pir_turn_angle_tighten(pir_turn_angle *angle, const pir_turned *turned) {
    double *between = angle->between;
    while (!angle->first && nextafter(between[0], INFINITY) < between[1]) {
        const double x = middle_of(between[0], between[1]);
        if (x <= between[0] || x >= between[1])
            break;
        const int side = side_of(angle, turned, x);
        if (side >= 0)
            between[0] = x;
        if (side <= 0)
            between[1] = x;
    }
    // an end may be κ itself
    for (int k = 0; k < 2 && !angle->first && between[0] < between[1]; k++)
        if (isfinite(between[k]) && side_of(angle, turned, between[k]) == 0)
            between[1 - k] = between[k];
    between[0] += 0.0;
    between[1] += 0.0;
}

void pir_turn_angle_polynomial(const pir_turn_angle *angle, const pir_turned *turned, mpz_t *ret_coefficients) {
    const pir_quadratic root = view_of((mpz_t *)angle->c);
    pir_turning_polynomial(&root, turned->exponent, ret_coefficients);
}
