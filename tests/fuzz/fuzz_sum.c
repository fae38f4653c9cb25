/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as two small bodies, a rotation and twenty more: hulls, a sum, updates, each held against a walk, the check of the whole pairing
 * and, every few, the mesh against the hull of all sums of vertices.
 *
 * With an engine (clang's libFuzzer), from the root of the project:
 *
 *     CC=clang meson setup build-fuzz -Dfuzz=true -Db_sanitize=address,undefined -Db_lundef=false -Db_ndebug=false
 *     ninja -C build-fuzz
 *     mkdir -p found && build-fuzz/tests/fuzz/engine_sum -max_len=512 -max_total_time=300 found tests/fuzz/corpus/sum
 *
 * Without one, standalone.c runs it over the kept corpus in suite fuzz-replay.
 *
 * The bytes: two bodies, a rotation, then twenty steps. Past their end all bytes are zero.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pirouette.h>

#include "support/bodies.h"

#define POINTS_MAX 12
#define STEPS      20

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

struct input {
    const uint8_t *data;
    size_t size, at;
};

static void require(int condition, const char *what) {
    if (!condition) {
        fprintf(stderr, "does not hold: %s\n", what);
        abort();
    }
}

static uint8_t next_byte(struct input *input) {
    return input->at < input->size ? input->data[input->at++] : 0;
}

static int next_small(struct input *input) {
    return (int8_t)next_byte(input);
}

/* Eight bytes as a double; what is not finite is zero. */
static double next_double(struct input *input) {
    uint64_t bits = 0;
    for (int k = 0; k < 8; k++)
        bits |= (uint64_t)next_byte(input) << (8 * k);
    double x;
    memcpy(&x, &bits, sizeof x);
    return isfinite(x) ? x : 0;
}

/* A coordinate in one of five ways. */
static double next_coordinate(struct input *input, int way, int exponent) {
    switch (way) {
    case 0:
        return next_byte(input) % 3;
    case 1:
        return next_small(input) % 5;
    case 2:
        return next_small(input) + next_small(input) / 256.0;
    case 3:
        return ldexp(next_small(input) % 4, exponent);
    default:
        return next_double(input);
    }
}

static pir_polytope *next_body(struct input *input) {
    pir_vec3 points[POINTS_MAX];
    size_t count = 1 + next_byte(input) % POINTS_MAX;
    uint8_t form = next_byte(input);
    int way = form % 5, flat = form / 5 % 4, exponent = 8 * next_small(input);
    for (size_t i = 0; i < count; i++) {
        points[i].x = next_coordinate(input, way, exponent);
        points[i].y = flat == 3 ? points[i].x : next_coordinate(input, way, exponent);
        points[i].z = flat >= 2 ? 1 : next_coordinate(input, way, exponent);
    }
    pir_polytope *polytope = NULL;
    require(pir_polytope_create(points, count, NULL, &polytope) == PIR_OK, "finite points have a hull");
    require(pir_polytope_is_valid(polytope), "the hull is valid");
    return polytope;
}

static int is_rotation(pir_quat q) {
    return isfinite(q.x) && isfinite(q.y) && isfinite(q.z) && isfinite(q.w) &&
           (q.x != 0 || q.y != 0 || q.z != 0 || q.w != 0);
}

/* A rotation, or a step from `from`; one that is none gives `from`. */
static pir_quat next_rotation(struct input *input, pir_quat from) {
    uint8_t form = next_byte(input);
    pir_quat q = {0, 0, 0, 1};
    double c[4];
    switch (form % 6) {
    case 0:
        q = test_hard_rotation(form / 6u);
        break;
    case 1:
    case 2:
        for (int k = 0; k < 4; k++)
            c[k] = next_small(input) % 4;
        q = (pir_quat){c[0], c[1], c[2], c[3]};
        q = form % 6 == 1 ? q : test_compose(q, from, 0);
        break;
    case 3:
    case 4:
        for (int k = 0; k < 3; k++)
            c[k] = next_small(input) * (form % 6 == 3 ? 0x1p-6 : 0x1p-24);
        q = test_compose((pir_quat){c[0], c[1], c[2], 1}, from, 1);
        break;
    default:
        for (int k = 0; k < 4; k++)
            c[k] = next_double(input);
        q = (pir_quat){c[0], c[1], c[2], c[3]};
        break;
    }
    return is_rotation(q) ? q : from;
}

static void check_mesh(pir_sum *sum, pir_polytope *p, pir_polytope *q, const pir_sum_options *options) {
    pir_mesh *mesh = NULL, *hull = NULL;
    require(pir_sum_mesh(sum, PIR_EXACT, &mesh) == PIR_OK, "a sum has a mesh");
    require(pir_hull_sum(p, q, pir_sum_rotation(sum), options, PIR_DOUBLE, &hull) == PIR_OK,
            "sums of vertices have a hull");
    require(pir_mesh_equal(mesh, hull), "the mesh is the hull of all sums of vertices");
    pir_mesh_destroy(hull);
    pir_mesh_destroy(mesh);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct input input = {data, size, 0};
    pir_sum_options options = pir_sum_options_default();
    uint8_t form = next_byte(&input);
    options.difference = form & 1;
    pir_polytope *p = next_body(&input), *q = form & 2 ? pir_polytope_retain(p) : next_body(&input);
    pir_quat rotation = next_rotation(&input, (pir_quat){0, 0, 0, 1});
    pir_sum *tracked = NULL, *rebuilt = NULL;
    require(pir_sum_create(p, q, rotation, &options, &tracked) == PIR_OK, "a sum can be made");
    require(pir_sum_create(p, q, rotation, &options, &rebuilt) == PIR_OK, "a sum can be made twice");
    for (int step = 0; step < STEPS; step++) {
        rotation = next_rotation(&input, rotation);
        pir_method method = step % 5 == 4 ? PIR_METHOD_AUTO : PIR_METHOD_UPDATE;
        require(pir_sum_rotate(tracked, rotation, method) == PIR_OK, "a sum can be updated");
        require(pir_sum_rotate(rebuilt, rotation, PIR_METHOD_WALK) == PIR_OK, "a sum can be rebuilt");
        require(pir_sum_same_pairing(tracked, rebuilt), "update and walk agree");
        require(pir_sum_is_valid(tracked), "the pairing is valid");
        if (step % 7 == 0)
            check_mesh(tracked, p, q, &options);
        if (step % 10 == 0) {
            require(pir_sum_rotate_brute_force(rebuilt, rotation) == PIR_OK, "a sum can be made by brute force");
            require(pir_sum_same_pairing(tracked, rebuilt), "update and brute force agree");
        }
        if (input.at >= input.size)
            break;
    }
    pir_sum_destroy(rebuilt);
    pir_sum_destroy(tracked);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return 0;
}
