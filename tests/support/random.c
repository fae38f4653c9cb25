/* SPDX-License-Identifier: MIT */
/* See random.h. */
#include "support/random.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

uint64_t test_seed(void) {
    const char *text = getenv("PIR_TEST_SEED");
    return text && *text ? strtoull(text, NULL, 0) : 1;
}

void test_print_seed(void) {
    printf("# seed %llu (PIR_TEST_SEED sets another)\n", (unsigned long long)test_seed());
}

static uint64_t splitmix(uint64_t *state) {
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

test_random test_random_case(const char *stream, uint64_t number) {
    uint64_t state = test_seed() * 0xd1342543de82ef95u + number;
    for (; *stream; stream++)
        state = (state ^ (unsigned char)*stream) * 0x100000001b3u;
    test_random random;
    for (int k = 0; k < 4; k++)
        random.state[k] = splitmix(&state);
    return random;
}

static uint64_t rotate_left(uint64_t x, int k) {
    return (x << k) | (x >> (64 - k));
}

uint64_t test_random_bits(test_random *random) {
    uint64_t *s = random->state, result = rotate_left(s[1] * 5, 7) * 9, t = s[1] << 17;
    s[2] ^= s[0];
    s[3] ^= s[1];
    s[1] ^= s[2];
    s[0] ^= s[3];
    s[2] ^= t;
    s[3] = rotate_left(s[3], 45);
    return result;
}

uint32_t test_random_below(test_random *random, uint32_t below) {
    return (uint32_t)((test_random_bits(random) >> 32) * below >> 32);
}

int test_random_between(test_random *random, int low, int high) {
    return low + (int)test_random_below(random, (uint32_t)(high - low + 1));
}

double test_random_unit(test_random *random) {
    return (double)(test_random_bits(random) >> 11) * 0x1p-52 - 1;
}

double test_random_scaled(test_random *random, int low, int high) {
    double m = 1 + (double)(test_random_bits(random) >> 12) * 0x1p-52;
    double x = ldexp(m, test_random_between(random, low, high));
    return test_random_below(random, 2) ? -x : x;
}

pir_vec3 test_random_direction(test_random *random) {
    for (;;) {
        double x = test_random_unit(random), y = test_random_unit(random), z = test_random_unit(random);
        double square = x * x + y * y + z * z;
        if (square > 1 || square < 0.01)
            continue;
        double length = sqrt(square);
        return (pir_vec3){x / length, y / length, z / length};
    }
}
