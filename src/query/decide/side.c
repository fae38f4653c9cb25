/* SPDX-License-Identifier: MIT */
/* On which side of a piece's plane a translation lies: see side.h. */
#include "query/decide/side.h"

bool pir_side_normal(pir_exact *exact, pir_piece piece, pir_vec3 *ret_normal) {
    pir_rotation_make_exact(exact->rotation);
    uint32_t mark = exact->scratch.used;
    pir_int3 n = pir_exact_normal(exact, piece);
    bool is_normal = !pir_int3_is_zero(&n);
    if (is_normal)
        *ret_normal = pir_int3_unit(&n);
    exact->scratch.used = mark;
    return is_normal;
}

int pir_side_exact(pir_exact *exact, pir_piece piece, pir_vec3 translation) {
    pir_exact_begin(exact, translation);
    uint32_t mark = exact->scratch.used, a, b;
    pir_piece_corner(exact->frame, piece, &a, &b);
    pir_int3 n = pir_exact_normal(exact, piece), corner = pir_exact_corner(exact, a, b);
    int sign = pir_exact_dot_sign(exact, &n, &corner);
    exact->scratch.used = mark;
    return sign;
}
