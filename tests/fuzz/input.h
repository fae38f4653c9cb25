/* SPDX-License-Identifier: MIT */
/* What fuzz targets make of bytes: bodies, rotations, numbers. Past the end of the input all bytes are zero. */
#ifndef PIR_FUZZ_INPUT_H
#define PIR_FUZZ_INPUT_H

#include <stddef.h>
#include <stdint.h>

#include <pirouette/polytope.h>

struct fuzz_input {
    const uint8_t *data;
    size_t size, at;
};

/* What an engine, or standalone.c, calls with one input after another. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Ends the program with a message unless the condition holds. */
void fuzz_require(int condition, const char *what);

/* One byte, without and with a sign. */
uint8_t fuzz_byte(struct fuzz_input *input);
int fuzz_small(struct fuzz_input *input);

/* Eight bytes as a double; what is not finite is zero. */
double fuzz_double(struct fuzz_input *input);

/* A number in one of five ways: small integers, fixed point, integers times 2^exponent, any double. */
#define FUZZ_WAYS 5
double fuzz_number(struct fuzz_input *input, int way, int exponent);

/* The hull of 1 to `most` points, flat ones among them; most <= FUZZ_POINTS_MAX. */
#define FUZZ_POINTS_MAX 12
pir_polytope *fuzz_body(struct fuzz_input *input, size_t most);

/* A rotation, or a step from `from`; one that is none gives `from`. */
pir_quat fuzz_rotation(struct fuzz_input *input, pir_quat from);

/* Whether the quaternion is finite and not zero. */
int fuzz_is_rotation(pir_quat q);

#endif
