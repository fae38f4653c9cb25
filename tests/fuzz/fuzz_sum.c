/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as two small bodies, a rotation and twenty more, to and fro at times: hulls, a sum, updates, each held
 * against a walk, the check of the whole pairing and, every few, the mesh against the hull of all sums of vertices.
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
#include <stdint.h>

#include <pirouette/baseline.h>
#include <pirouette/pirouette.h>

#include "fuzz/input.h"

#define STEPS 20

static void check_mesh(pir_sum *sum, pir_polytope *p, pir_polytope *q, const pir_sum_options *options) {
    pir_mesh *mesh = NULL, *hull = NULL, *object = NULL;
    fuzz_require(pir_sum_mesh(sum, PIR_EXACT, &mesh) == PIR_OK, "a sum has a mesh");
    fuzz_require(pir_hull_sum(p, q, pir_sum_rotation(sum), options, PIR_DOUBLE, &hull) == PIR_OK,
                 "sums of vertices have a hull");
    fuzz_require(pir_mesh_equal(mesh, hull), "the mesh is the hull of all sums of vertices");
    fuzz_require(pir_object_sum(p, q, pir_sum_rotation(sum), options, PIR_DOUBLE, &object) == PIR_OK,
                 "the object-space method finds a sum");
    fuzz_require(pir_mesh_equal(mesh, object), "the mesh is that of the object-space method");
    pir_mesh_destroy(object);
    pir_mesh_destroy(hull);
    pir_mesh_destroy(mesh);
}

static void check_update(pir_sum *tracked, pir_sum *rebuilt, pir_quat rotation, pir_method method) {
    fuzz_require(pir_sum_rotate(tracked, rotation, method) == PIR_OK, "a sum can be updated");
    fuzz_require(pir_sum_rotate(rebuilt, rotation, PIR_METHOD_WALK) == PIR_OK, "a sum can be rebuilt");
    fuzz_require(pir_sum_same_pairing(tracked, rebuilt), "update and walk agree");
    fuzz_require(pir_sum_is_valid(tracked), "the pairing is valid");
}

/* A sum with a region that the bytes have chosen by the way: about the last axis, or about another in some steps. */
static void check_region(pir_sum *part, const pir_sum *whole, pir_quat rotation, int step) {
    fuzz_require(pir_sum_rotate(part, rotation, PIR_METHOD_UPDATE) == PIR_OK, "a part can be updated");
    fuzz_require(pir_sum_same_pairing(part, whole) && pir_sum_is_valid(part), "the part is that of the whole");
    pir_vec3 axis =
        step % 4 == 3 ? (pir_vec3){rotation.w, rotation.x, rotation.y} : (pir_vec3){rotation.x, rotation.y, rotation.z};
    if (axis.x == 0 && axis.y == 0 && axis.z == 0)
        axis.z = 1;
    fuzz_require(pir_sum_set_region(part, axis, step % 6 == 5 ? 1.4 : 0.3) == PIR_OK, "a region can be set");
    fuzz_require(pir_sum_same_pairing(part, whole) && pir_sum_is_valid(part),
                 "the part in the new region is that of the whole");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct fuzz_input input = {data, size, 0};
    pir_sum_options options = pir_sum_options_default();
    uint8_t form = fuzz_byte(&input);
    options.difference = form & 1;
    pir_polytope *p = fuzz_body(&input, FUZZ_POINTS_MAX),
                 *q = form & 2 ? pir_polytope_retain(p) : fuzz_body(&input, FUZZ_POINTS_MAX);
    pir_quat rotation = fuzz_rotation(&input, (pir_quat){0, 0, 0, 1});
    pir_sum *tracked = NULL, *rebuilt = NULL, *part = NULL;
    fuzz_require(pir_sum_create(p, q, rotation, &options, &tracked) == PIR_OK, "a sum can be made");
    fuzz_require(pir_sum_clone(tracked, NULL, &part) == PIR_OK, "a sum can be cloned");
    fuzz_require(pir_sum_create(p, q, rotation, &options, &rebuilt) == PIR_OK, "a sum can be made twice");
    for (int step = 0; step < STEPS; step++) {
        const pir_quat before = rotation;
        rotation = fuzz_rotation(&input, rotation);
        check_update(tracked, rebuilt, rotation, step % 5 == 4 ? PIR_METHOD_AUTO : PIR_METHOD_UPDATE);
        for (int swing = 0; step % 3 == 1 && swing < 6; swing++)
            check_update(tracked, rebuilt, swing % 2 ? rotation : before, PIR_METHOD_UPDATE);
        check_region(part, tracked, rotation, step);
        if (step % 7 == 0)
            check_mesh(tracked, p, q, &options);
        if (step % 10 == 0) {
            fuzz_require(pir_sum_rotate_brute_force(rebuilt, rotation) == PIR_OK, "a sum can be made by brute force");
            fuzz_require(pir_sum_same_pairing(tracked, rebuilt), "update and brute force agree");
        }
        if (input.at >= input.size)
            break;
    }
    pir_sum_destroy(part);
    pir_sum_destroy(rebuilt);
    pir_sum_destroy(tracked);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return 0;
}
