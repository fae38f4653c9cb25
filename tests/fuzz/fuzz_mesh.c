/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as meshes: as a file of a format, or as the triangles of two. What is read has a valid tree; rays,
 * boxes and nearest points ask it. Of two meshes the state, the nearest and the farthest triangles and those
 * within a distance are held against all pairs in rationals (oracle/triangles.h).
 *
 * The bytes: which of these, then the file, or a way of numbers, triangles, poses and a distance. See fuzz_sum.c
 * for how to run an engine.
 */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include <pirouette/trimesh_pair.h>

#include "fuzz/input.h"
#include "oracle/triangles.h"

#define TRIANGLES 3

/* --- files --- */

static void ask_mesh(const pir_trimesh *mesh) {
    pir_trimesh_info info;
    pir_trimesh_describe(mesh, &info);
    fuzz_require(pir_trimesh_is_valid(mesh), "the tree is valid");
    pir_surface_ref ref = {.mesh = mesh};
    pir_surface_ray ray = {
        info.low, {info.high.x - info.low.x, info.high.y - info.low.y, info.high.z - info.low.z}, PIR_RAY_BOTH};
    pir_ray_hit hit;
    size_t count;
    bool any;
    pir_status status = pir_surface_ray_nearest(ref, &ray, &hit);
    fuzz_require(status == PIR_OK || status == PIR_ERR_LIMIT, "a ray is answered, or too long");
    fuzz_require(pir_surface_ray_any(ref, &ray, &any) == status, "all rays are");
    fuzz_require(status != PIR_OK || any == (hit.triangle != PIR_TRIANGLE_NONE), "any is the nearest");
    fuzz_require(pir_surface_box(ref, info.low, info.high, 0, NULL, &count) == PIR_OK, "a box is answered");
    fuzz_require(count == info.triangles - info.degenerate, "the box around all meets all");
    pir_surface_nearest nearest;
    fuzz_require(pir_surface_nearest_point(ref, info.low, HUGE_VAL, &nearest) == PIR_OK, "a point is answered");
    fuzz_require(nearest.triangle < info.triangles, "some triangle is the nearest");
}

static void read_file(struct fuzz_input *input, const char *format) {
    pir_trimesh *mesh = NULL;
    const pir_file_bytes bytes = {input->data + input->at, input->size - input->at, "fuzz", format};
    if (input->size > input->at && pir_trimesh_read_bytes(&bytes, NULL, NULL, &mesh) == PIR_OK)
        ask_mesh(mesh);
    pir_trimesh_release(mesh);
}

/* --- two meshes --- */

struct body {
    pir_trimesh *mesh;
    uint32_t count;
    pir_vec3 corner[TRIANGLES][3];
    oracle_triangle exact[TRIANGLES];
    bool counts[TRIANGLES]; /* it has an area */
};

/* Whether a triangle has an area: whether its mesh has. */
static bool has_area(const pir_vec3 corner[3]) {
    static const uint32_t corners[3] = {0, 1, 2};
    pir_trimesh_arrays arrays = {.vertices = corner, .vertex_count = 3, .triangles = corners, .triangle_count = 1};
    pir_trimesh *mesh = NULL;
    pir_status status = pir_trimesh_create(&arrays, NULL, NULL, &mesh);
    pir_trimesh_release(mesh);
    return status == PIR_OK;
}

static bool make_body(struct fuzz_input *input, struct body *b) {
    int way = fuzz_byte(input) % FUZZ_WAYS, exponent = fuzz_small(input) % 20;
    uint32_t corners[TRIANGLES][3];
    b->count = 1 + fuzz_byte(input) % TRIANGLES;
    for (uint32_t i = 0; i < 3 * b->count; i++) {
        double c[3];
        for (int k = 0; k < 3; k++) {
            c[k] = fuzz_number(input, way, exponent);
            // beyond 2^20 and below 2^-40 the oracle takes long
            c[k] = fabs(c[k]) < 0x1p20 ? c[k] : 0;
            c[k] = fabs(c[k]) > 0x1p-40 ? c[k] : 0;
        }
        b->corner[i / 3][i % 3] = (pir_vec3){c[0], c[1], c[2]};
        corners[i / 3][i % 3] = i;
    }
    pir_trimesh_arrays arrays = {.vertices = b->corner,
                                 .vertex_count = 3 * (size_t)b->count,
                                 .triangles = corners[0],
                                 .triangle_count = b->count};
    b->mesh = NULL;
    if (pir_trimesh_create(&arrays, NULL, NULL, &b->mesh) != PIR_OK)
        return false;
    for (uint32_t i = 0; i < b->count; i++) {
        b->counts[i] = has_area(b->corner[i]);
        oracle_triangle_init(&b->exact[i]);
    }
    return true;
}

static void clear_body(struct body *b) {
    for (uint32_t i = 0; b->mesh && i < b->count; i++)
        oracle_triangle_clear(&b->exact[i]);
    pir_trimesh_release(b->mesh);
}

static pir_pose some_pose(struct fuzz_input *input, pir_pose before) {
    pir_pose pose = {fuzz_rotation(input, before.rotation), before.translation};
    const double q[4] = {pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w};
    for (int k = 0; k < 4; k++)
        if (q[k] != 0 && (fabs(q[k]) < 0x1p-40 || fabs(q[k]) > 0x1p40))
            pose.rotation = before.rotation;
    double t[3];
    for (int k = 0; k < 3; k++)
        t[k] = fuzz_number(input, fuzz_byte(input) % 2, 0);
    pose.translation = (pir_vec3){t[0], t[1], t[2]};
    return pose;
}

struct truth {
    mpq_t least, most, square, within;
    uint32_t p, q, far_p, far_q;
    size_t count;
};

static void find_truth(struct truth *t, struct body *a, struct body *b) {
    t->p = t->q = PIR_TRIANGLE_NONE;
    t->count = 0;
    for (uint32_t i = 0; i < a->count; i++)
        for (uint32_t j = 0; j < b->count; j++) {
            if (!a->counts[i] || !b->counts[j])
                continue;
            oracle_triangles_least(t->square, &a->exact[i], &b->exact[j]);
            t->count += mpq_cmp(t->square, t->within) <= 0;
            if (t->p == PIR_TRIANGLE_NONE || mpq_cmp(t->square, t->least) < 0) {
                mpq_set(t->least, t->square);
                t->p = i;
                t->q = j;
            }
            oracle_triangles_most(t->square, &a->exact[i], &b->exact[j]);
            if ((t->p == i && t->q == j && t->far_p == PIR_TRIANGLE_NONE) || mpq_cmp(t->square, t->most) > 0) {
                mpq_set(t->most, t->square);
                t->far_p = i;
                t->far_q = j;
            }
        }
}

static void check_pose(struct fuzz_input *input, pir_trimesh_pair *pair, struct body bodies[2], pir_pose pose[2]) {
    for (int i = 0; i < 2; i++) {
        pose[i] = some_pose(input, pose[i]);
        for (uint32_t t = 0; t < bodies[i].count; t++)
            oracle_triangle_place(&bodies[i].exact[t], bodies[i].corner[t], pose[i]);
    }
    pir_within_input asked = {pose[0], pose[1], fabs(fuzz_number(input, 0, 0))};
    struct truth t = {.far_p = PIR_TRIANGLE_NONE};
    mpq_inits(t.least, t.most, t.square, t.within, NULL);
    mpq_set_d(t.within, asked.distance);
    mpq_mul(t.within, t.within, t.within);
    find_truth(&t, &bodies[0], &bodies[1]);
    pir_trimesh_distance near, far;
    size_t count;
    fuzz_require(pir_trimesh_pair_nearest(pair, pose[0], pose[1], &near) == PIR_OK, "the nearest is answered");
    fuzz_require(near.triangle_p == t.p && near.triangle_q == t.q, "the nearest triangles");
    fuzz_require((near.state == PIR_TRIMESH_MEET) == (mpq_sgn(t.least) == 0), "the state");
    fuzz_require(pir_trimesh_pair_farthest(pair, pose[0], pose[1], &far) == PIR_OK, "the farthest is answered");
    fuzz_require(far.triangle_p == t.far_p && far.triangle_q == t.far_q, "the farthest triangles");
    fuzz_require(pir_trimesh_pair_within(pair, &asked, 0, NULL, &count) == PIR_OK, "those within are answered");
    fuzz_require(count == t.count, "those within");
    mpq_clears(t.least, t.most, t.square, t.within, NULL);
}

static void two_meshes(struct fuzz_input *input) {
    struct body bodies[2] = {{.mesh = NULL}, {.mesh = NULL}};
    pir_trimesh_pair *pair = NULL;
    if (make_body(input, &bodies[0]) && make_body(input, &bodies[1])) {
        fuzz_require(pir_trimesh_pair_create(bodies[0].mesh, bodies[1].mesh, NULL, &pair) == PIR_OK, "a pair is made");
        pir_pose pose[2] = {pir_pose_identity(), pir_pose_identity()};
        for (int i = 0; i < 3; i++)
            check_pose(input, pair, bodies, pose);
    }
    pir_trimesh_pair_destroy(pair);
    clear_body(&bodies[0]);
    clear_body(&bodies[1]);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const char *const formats[4] = {"off", "obj", "stl", "ply"};
    struct fuzz_input input = {data, size, 0};
    uint8_t which = fuzz_byte(&input);
    if (which >= 'A' && which < 'E')
        read_file(&input, formats[which - 'A']);
    else
        two_meshes(&input);
    return 0;
}
