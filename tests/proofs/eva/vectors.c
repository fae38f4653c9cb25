/* SPDX-License-Identifier: MIT */
/* What Eva analyses: blocks of COUNT vectors of any integers of up to MOST limbs, scales, and what is made of them. */
#include "__fc_builtin.h"

#include "exact/vectors.h"

#define COUNT 2
#define MOST  2

/* Any integer; the invariant of integer.h holds of it. */
static void set_any(pir_int *a) {
    const int32_t length = Frama_C_interval(0, MOST);
    a->size = Frama_C_interval(0, 1) ? length : -length;
    write_limbs(a->limb, MOST);
}

static void ask_vectors(void) {
    pir_vectors vectors;
    if (!pir_vectors_init(&vectors, NULL, COUNT, MOST))
        return;
    //@ loop unroll COUNT;
    for (uint32_t i = 0; i < COUNT; i++) {
        pir_int3 v = pir_vectors_at(&vectors, i);
        for (int k = 0; k < 3; k++)
            set_any(&v.c[k]);
        pir_int3_strip(&v);
        pir_vectors_put(&vectors, i, &v);
        const pir_vec3 unit = pir_int3_unit(&v);
        (void)unit;
    }
    pir_int3 first = pir_vectors_at(&vectors, 0);
    pir_vectors_set(&vectors, COUNT - 1, &first);
    volatile uint32_t bits = pir_vectors_bits(&vectors);
    bits += pir_vectors_reduce(&vectors, NULL);
    pir_vectors_finish(&vectors, NULL);
}

static void ask_scales(void) {
    static mp_limb_t limbs[3][MOST];
    pir_int a = {limbs[0], 0, MOST}, num = {limbs[1], 0, MOST}, den = {limbs[2], 0, MOST};
    set_any(&a);
    set_any(&num);
    set_any(&den);
    // a scale is positive
    num.size = Frama_C_interval(1, MOST);
    den.size = Frama_C_interval(1, MOST);
    const pir_scale scale = {num, den};
    volatile double nearest = pir_scaled_nearest_double(&a, &num, &den);
    (void)nearest;
    mpq_t rational;
    mpq_init(rational);
    pir_scale_to_rational(rational, &a, &scale);
    pir_scale copy;
    if (pir_scale_copy(&copy, NULL, &scale))
        pir_scale_finish(&copy, NULL);
    if (pir_scale_init_power(&copy, NULL, Frama_C_interval(-1100, 1100)))
        pir_scale_finish(&copy, NULL);
}

int main(void) {
    ask_vectors();
    ask_scales();
    return 0;
}
