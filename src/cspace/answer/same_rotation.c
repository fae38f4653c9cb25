/* SPDX-License-Identifier: MIT */
/*
 * Multiples of each other: a_i·b_k = a_k·b_i for a component k of b that is not 0 and all others. A product of
 * doubles has a mantissa of at most 106 bits and a power of two, and is compared as such.
 */
#include "cspace/answer/same_rotation.h"

#include "exact/integer.h"

/* ±m·2^e exactly: the two limbs of an odd m, or m = 0. */
struct product {
    bool negative;
    uint64_t high, low;
    int exponent;
};

/* 64-bit halves of a product of two numbers below 2^53. */
static void multiply(uint64_t a, uint64_t b, struct product *product) {
    uint64_t a1 = a >> 32, a0 = a & 0xffffffff, b1 = b >> 32, b0 = b & 0xffffffff;
    uint64_t middle = a1 * b0 + (a0 * b0 >> 32), other = a0 * b1 + (middle & 0xffffffff);
    product->low = other << 32 | (a0 * b0 & 0xffffffff);
    product->high = a1 * b1 + (middle >> 32) + (other >> 32);
}

/* The mantissa and the exponent of x with trailing zeros moved to the exponent. */
static uint64_t odd_part(double x, int *ret_exponent) {
    uint64_t mantissa = pir_double_split(x, ret_exponent);
    for (; mantissa != 0 && (mantissa & 1) == 0; mantissa >>= 1)
        ++*ret_exponent;
    return mantissa;
}

static struct product product_of(double x, double y) {
    int ex, ey;
    struct product product = {.negative = (x < 0) != (y < 0)};
    uint64_t mx = odd_part(x, &ex), my = odd_part(y, &ey);
    if (mx == 0 || my == 0)
        return (struct product){0};
    multiply(mx, my, &product);
    product.exponent = ex + ey;
    return product;
}

static bool equal_products(double a, double b, double c, double d) {
    struct product x = product_of(a, b), y = product_of(c, d);
    return x.negative == y.negative && x.high == y.high && x.low == y.low && x.exponent == y.exponent;
}

bool pir_same_rotation(pir_quat a, pir_quat b) {
    const double p[4] = {a.x, a.y, a.z, a.w}, q[4] = {b.x, b.y, b.z, b.w};
    int k = 0;
    while (q[k] == 0)
        k++;
    if (p[k] == 0)
        return false;
    for (int i = 0; i < 4; i++)
        if (!equal_products(p[i], q[k], p[k], q[i]))
            return false;
    return true;
}
