/* SPDX-License-Identifier: MIT */
/* Rotations in double-double: see dd_rotation.h. */
#include "query/frame/dd_rotation.h"

#include <math.h>

void pir_dd_rotation(pir_quat q, pir_quat rest, pir_dd3 row[3]) {
    int top;
    double largest = fmax(fmax(fabs(q.x), fabs(q.y)), fmax(fabs(q.z), fabs(q.w)));
    frexp(largest, &top);
    const pir_dd c[4] = {{ldexp(q.x, -top), ldexp(rest.x, -top)},
                         {ldexp(q.y, -top), ldexp(rest.y, -top)},
                         {ldexp(q.z, -top), ldexp(rest.z, -top)},
                         {ldexp(q.w, -top), ldexp(rest.w, -top)}};
    pir_dd square[4], norm = {0, 0};
    for (int k = 0; k < 4; k++) {
        square[k] = pir_dd_mul(c[k], c[k]);
        norm = pir_dd_add(norm, square[k]);
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        pir_dd diagonal = pir_dd_sub(pir_dd_add(square[3], square[i]), pir_dd_add(square[j], square[k]));
        row[i].c[i] = pir_dd_divide(diagonal, norm);
        pir_dd both = pir_dd_scale(pir_dd_mul(c[i], c[j]), 2), turn = pir_dd_scale(pir_dd_mul(c[3], c[k]), 2);
        row[i].c[j] = pir_dd_divide(pir_dd_sub(both, turn), norm);
        row[j].c[i] = pir_dd_divide(pir_dd_add(both, turn), norm);
    }
}
