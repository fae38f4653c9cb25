/* SPDX-License-Identifier: MIT */
/* What Eva analyses: rotations of any quaternions, and signs of any vectors of up to MOST limbs a component. */
#include "__fc_builtin.h"

#include "exact/relative_turn.h"
#include "exact/sign.h"

#define MOST 2

static mp_limb_t limbs[6][MOST];

/* Any vector. */
static pir_int3 any_vector(int place) {
    pir_int3 v;
    for (int k = 0; k < 3; k++) {
        v.c[k] = (pir_int){limbs[place + k], Frama_C_interval(-MOST, MOST), MOST};
        write_limbs(limbs[place + k], MOST);
    }
    return v;
}

/* The C library's, of which Eva knows no bounds of exponents. */
double frexp(double x, int *ret_exponent) {
    (void)x;
    *ret_exponent = Frama_C_interval(-1073, 1024);
    return Frama_C_double_interval(-1, 1);
}

static int ask(pir_signs *signs, const pir_int3 *a, const pir_int3 *b) {
    return pir_sign_true(signs, a, b) + pir_sign_perturbed(signs, a, b);
}

int main(void) {
    static pir_signs_room room;
    pir_signs signs;
    if (pir_signs_reserve(&room, NULL, MOST, MOST) != PIR_OK)
        return 0;
    int all = 0;
    const pir_int3 a = any_vector(0), b = any_vector(3);
    const pir_quat q = any_quaternion(), p = any_quaternion();
    pir_signs_init(&signs, &room);
    if (Frama_C_interval(0, 1)) {
        if (pir_rotation_set(&signs.rotation, p) == PIR_OK)
            all = ask(&signs, &a, &b);
    } else if (pir_rotation_set_relative(&signs.rotation, q, p) == PIR_OK) {
        all = ask(&signs, &a, &b);
    }
    pir_quat unit;
    pir_mat3 r;
    pir_quat_product product;
    pir_signs_room_finish(&room, NULL);
    return all + pir_relative_plain.turn(&q, &unit, &r) + pir_relative_plain.find(&q, &p, &product, &unit, &r);
}
