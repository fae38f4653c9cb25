/* SPDX-License-Identifier: MIT */
/*
 * A rotation given by a quaternion of doubles, which is an exact rotation: R = M(q)/|q|² with
 *
 *     M(q)·n = (w² − |v|²)·n + 2 (v·n)·v + 2w·v × n,      q = (v, w)
 *
 * held twice: as a matrix of doubles with a proven bound, and as integers, M of q scaled to integers by a power of two.
 *
 * One rotation has many quaternions, all multiples of one another. M is the same for q and −q, but the perturbation
 * of ties (sign.h) is not: −q + ε is −(q − ε). So a rotation takes the one of q and −q whose first component
 * that is not zero, of w, x, y and z, is positive. Each ε is smaller than any multiple of the one before, so a
 * positive factor changes nothing, and the perturbed rotation depends on the rotation alone. It jumps where a motion
 * passes a half turn.
 *
 * The integers are made on demand, in memory that the rotation is given: a double spans at most 2098 bits, so nothing
 * allocates. Rotations of one thread may share that memory, one after the other.
 */
#ifndef PIR_EXACT_ROTATION_H
#define PIR_EXACT_ROTATION_H

#include "base/vec.h"
#include "exact/integer.h"

/* Limbs of a component of q as an integer, of an entry of M (a sum of four products), and of all of them. */
#define PIR_QUAT_LIMBS     (2098 / GMP_NUMB_BITS + 2)
#define PIR_MATRIX_LIMBS   (2 * PIR_QUAT_LIMBS + 1)
#define PIR_ROTATION_LIMBS (4 * PIR_QUAT_LIMBS + 10 * PIR_MATRIX_LIMBS)

typedef struct pir_rotation pir_rotation;

/* A rotation as integers. */
typedef struct pir_rotation_integers {
    const pir_rotation *of; /* whose they are, where that has_exact */
    pir_int q[4];           /* x, y, z, w on one scale, with the sign above */
    pir_int m[3][3];
    pir_int norm; /* |q|² on the scale of m: R = m/norm */
    mp_limb_t limbs[PIR_ROTATION_LIMBS];
} pir_rotation_integers;

struct pir_rotation {
    pir_quat given; /* as the caller gave it; of a relative rotation, the nearest doubles */
    pir_quat rest;  /* of a relative rotation, what `given` leaves, rounded; else 0 */
    bool relative;  /* conj(factor[0]) · factor[1] exactly */
    pir_quat factor[2];
    pir_quat unit;  /* with the sign above, scaled to length 1, within 8·2^-53 */
    pir_mat3 r;     /* within 31·2^-53 of R in Frobenius norm, 37·2^-53 if relative: see rotation.c */
    bool has_exact; /* whether integers have been made; they may be another rotation's by now */
    bool has_zeros; /* of a relative rotation with integers: `given` is zero where they are, and near them elsewhere */
    pir_rotation_integers *integers; /* set by whoever asks for integers; pir_rotation_set leaves it as it is */
};

/* The one of q and −q that stands for their rotation, its zeros without a sign. */
static inline pir_quat pir_quat_signed(pir_quat q) {
    double first = q.w != 0 ? q.w : q.x != 0 ? q.x : q.y != 0 ? q.y : q.z, sign = first < 0 ? -1 : 1;
    return (pir_quat){sign * q.x + 0.0, sign * q.y + 0.0, sign * q.z + 0.0, sign * q.w + 0.0};
}

/* Whether a quaternion, not zero, turns nothing. */
static inline bool pir_quat_is_identity(pir_quat q) {
    return q.x == 0 && q.y == 0 && q.z == 0;
}

/* |q|² between this and its inverse needs no scaling: what its products lose below 2^-1074 is far below u·n. */
#define PIR_NORM_NEAR_ONE 0x1p-400

/* A rotation in doubles: see pir_rotation. */
typedef struct pir_rotation_doubles {
    pir_quat unit;
    pir_mat3 r;
} pir_rotation_doubles;

/* That of a quaternion of the length √n near 1, which `shrink` brings to 1. */
static inline pir_rotation_doubles pir_doubles_at(pir_quat c, double n, double shrink) {
    double x = c.x, y = c.y, z = c.z, w = c.w, xx = x * x, yy = y * y, zz = z * z, ww = w * w, by = 1 / n;
    return (pir_rotation_doubles){
        .unit = {x * shrink, y * shrink, z * shrink, w * shrink},
        .r = {{{(ww + xx - yy - zz) * by, 2 * (x * y - w * z) * by, 2 * (x * z + w * y) * by},
               {2 * (x * y + w * z) * by, (ww - xx + yy - zz) * by, 2 * (y * z - w * x) * by},
               {2 * (x * z - w * y) * by, 2 * (y * z + w * x) * by, (ww - xx - yy + zz) * by}}}};
}

/* |q|². */
static inline double pir_quat_norm(pir_quat q) {
    return q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
}

static inline pir_rotation_doubles pir_doubles_of(pir_quat c) {
    double n = pir_quat_norm(c);
    return pir_doubles_at(c, n, 1 / sqrt(n));
}

/*
 * Doubles of a rotation, but for the last bits of `unit`: a quaternion of length 1 but for rounding, as most are, is
 * taken as it is, for a root and a division take as long as all else here. Its norm is within 8u of 1 and off by 4u,
 * so its length is within 6u.
 */
static inline pir_rotation_doubles pir_doubles_as_given(pir_quat c) {
    double n = pir_quat_norm(c);
    return pir_doubles_at(c, n, fabs(n - 1) <= 0x1p-50 ? 1 : 1 / sqrt(n));
}

/* Sets a rotation whose doubles are there, or kept elsewhere: then only integers may be asked for. */
static inline void pir_rotation_set_given(pir_rotation *rotation, pir_quat given) {
    rotation->given = given;
    rotation->rest = (pir_quat){0, 0, 0, 0};
    rotation->relative = false;
    rotation->has_exact = false;
}

/* Whether a quaternion needs no scaling, as most do not. */
static inline bool pir_quat_is_near_one(pir_quat q) {
    double n = pir_quat_norm(q);
    return n >= PIR_NORM_NEAR_ONE && n <= 1 / PIR_NORM_NEAR_ONE;
}

/* Whether a component is 0, or so large that the integers of a product of two have their room (PIR_QUAT_LIMBS). */
static inline bool pir_component_is_fit(double c) {
    return (c == 0) | ((fabs(c) >= 0x1p-900) & (fabs(c) < 1));
}

/* Whether a quaternion needs no scaling for a product: its greatest component is in [0.5, 1), none is too small. */
static inline bool pir_quat_is_fit(pir_quat q) {
    const bool large = (fabs(q.x) >= 0.5) | (fabs(q.y) >= 0.5) | (fabs(q.z) >= 0.5) | (fabs(q.w) >= 0.5);
    return large && pir_component_is_fit(q.x) && pir_component_is_fit(q.y) && pir_component_is_fit(q.z) &&
           pir_component_is_fit(q.w);
}

/* Takes a quaternion: PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, or PIR_OK. On failure *rotation is as it was. */
pir_status pir_rotation_set(pir_rotation *rotation, pir_quat given);

/*
 * Takes the rotation of body p as body q sees it, both given as they stand in the world: conj(q) · p. Where q
 * turns nothing it is `p` as given. Errors as above, and PIR_ERR_LIMIT where the components of either that are not 0
 * span more than 2^900.
 */
pir_status pir_rotation_set_relative(pir_rotation *rotation, pir_quat q, pir_quat p);

/* Whether the integers are there, and this rotation's. */
static inline bool pir_rotation_has_integers(const pir_rotation *rotation) {
    return rotation->has_exact && rotation->integers->of == rotation;
}

/* Makes the integers if they are not there. */
void pir_rotation_make_exact(pir_rotation *rotation);

/* dst = M·v and Mᵀ·v exactly; room: |v| + PIR_MATRIX_LIMBS + 1 each. */
void pir_rotation_apply_transposed(const pir_rotation *rotation, pir_int3 *dst, const pir_int3 *v, pir_limbs *scratch);
void pir_rotation_apply(const pir_rotation *rotation, pir_int3 *dst, const pir_int3 *v, pir_limbs *scratch);

/* --- angles --- */

/* The square of the distance of two quaternions, up to sign. */
static inline double pir_rotation_chord_square(pir_quat a, pir_quat b) {
    double sign = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w < 0 ? -1 : 1;
    double x = a.x - sign * b.x, y = a.y - sign * b.y, z = a.z - sign * b.z, w = a.w - sign * b.w;
    return x * x + y * y + z * z + w * w;
}

/*
 * An upper bound on the angle between two rotations in radians, whose unit quaternions are `chord` apart at most, up
 * to sign, but for rounding.
 */
static inline double pir_rotation_angle_of_chord(double chord) {
    /*
     * Unit quaternions at distance 2y ≤ √2 (up to sign) turn by θ = 4 asin(y). (asin(y) − y)/y³ rises with y,
     * and is below 0.2215 at y = √2/2. So θ ≤ 4 (y + 0.2215 y³), which is above π from there on. The chord is
     * off by 5u, relatively; 1 + 2^-48 on the result holds that.
     */
    double half = 0.5 * chord;
    return 4 * (half + 0.2215 * (half * half * half)) * (1 + 0x1p-48);
}

/* That bound for quaternions that are near their `unit` ones; `error` is by how much, both together. */
static inline double pir_rotation_angle_bound_within(pir_quat a, pir_quat b, double error) {
    return pir_rotation_angle_of_chord(sqrt(pir_rotation_chord_square(a, b)) + error);
}

/* The bound for `unit` quaternions; tight to a few parts in 10^15 for small turns. */
static inline double pir_rotation_angle_bound(pir_quat a, pir_quat b) {
    // each unit quaternion is off by at most 8u, the chord so by 16u, which with the 5u is below 2^-48 = 32u
    return pir_rotation_angle_bound_within(a, b, 0x1p-48);
}

#endif
