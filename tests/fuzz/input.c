/* SPDX-License-Identifier: MIT */
/* See input.h. */
#include "fuzz/input.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/bodies.h"

void fuzz_require(int condition, const char *what) {
    if (!condition) {
        fprintf(stderr, "does not hold: %s\n", what);
        abort();
    }
}

uint8_t fuzz_byte(struct fuzz_input *input) {
    return input->at < input->size ? input->data[input->at++] : 0;
}

int fuzz_small(struct fuzz_input *input) {
    return (int8_t)fuzz_byte(input);
}

double fuzz_double(struct fuzz_input *input) {
    uint64_t bits = 0;
    for (int k = 0; k < 8; k++)
        bits |= (uint64_t)fuzz_byte(input) << (8 * k);
    double x;
    memcpy(&x, &bits, sizeof x);
    return isfinite(x) ? x : 0;
}

double fuzz_number(struct fuzz_input *input, int way, int exponent) {
    switch (way) {
    case 0:
        return fuzz_byte(input) % 3;
    case 1:
        return fuzz_small(input) % 5;
    case 2: {
        int whole = fuzz_small(input), part = fuzz_small(input);
        return whole + part / 256.0;
    }
    case 3:
        return ldexp(fuzz_small(input) % 4, exponent);
    default:
        return fuzz_double(input);
    }
}

pir_polytope *fuzz_body(struct fuzz_input *input, size_t most) {
    pir_vec3 points[FUZZ_POINTS_MAX];
    size_t count = 1 + fuzz_byte(input) % most;
    uint8_t form = fuzz_byte(input);
    int way = form % FUZZ_WAYS, flat = form / FUZZ_WAYS % 4, exponent = 8 * fuzz_small(input);
    for (size_t i = 0; i < count; i++) {
        points[i].x = fuzz_number(input, way, exponent);
        points[i].y = flat == 3 ? points[i].x : fuzz_number(input, way, exponent);
        points[i].z = flat >= 2 ? 1 : fuzz_number(input, way, exponent);
    }
    pir_polytope *polytope = NULL;
    fuzz_require(pir_polytope_create(points, count, NULL, &polytope) == PIR_OK, "finite points have a hull");
    fuzz_require(pir_polytope_is_valid(polytope), "the hull is valid");
    return polytope;
}

int fuzz_is_rotation(pir_quat q) {
    return isfinite(q.x) && isfinite(q.y) && isfinite(q.z) && isfinite(q.w) &&
           (q.x != 0 || q.y != 0 || q.z != 0 || q.w != 0);
}

pir_quat fuzz_rotation(struct fuzz_input *input, pir_quat from) {
    uint8_t form = fuzz_byte(input);
    pir_quat q = {0, 0, 0, 1};
    double c[4];
    switch (form % 6) {
    case 0:
        q = test_hard_rotation(form / 6u);
        break;
    case 1:
    case 2:
        for (int k = 0; k < 4; k++)
            c[k] = fuzz_small(input) % 4;
        q = (pir_quat){c[0], c[1], c[2], c[3]};
        q = form % 6 == 1 ? q : test_compose(q, from, 0);
        break;
    case 3:
    case 4:
        for (int k = 0; k < 3; k++)
            c[k] = fuzz_small(input) * (form % 6 == 3 ? 0x1p-6 : 0x1p-24);
        q = test_compose((pir_quat){c[0], c[1], c[2], 1}, from, 1);
        break;
    default:
        for (int k = 0; k < 4; k++)
            c[k] = fuzz_double(input);
        q = (pir_quat){c[0], c[1], c[2], c[3]};
        break;
    }
    return fuzz_is_rotation(q) ? q : from;
}
