/* SPDX-License-Identifier: MIT */
/*
 * Long histories at the limits of doubles: what a sum or a pair says after them is what one made there says.
 *
 *   - tiny turns: a million turns of 1e-9 to 1e-3 about random axes. Now and then, and at the end, the pairing is that
 *     of a walk; at the end the mesh is proven facet by facet.
 *   - crossings: a million passages through a pose in which every feature ties. The pairings before, in and after it
 *     are those of sums made there.
 *   - touching: a million steps of an ulp to and fro through contact, face on face. The state is known in each.
 *   - turning in contact: a query follows a box that turns on its face; the state never changes.
 *
 * PIR_TEST_FRAMES sets the frames of each. Ends with 1 when anything failed.
 */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <pirouette/pair.h>

#include "support/bodies.h"
#include "support/meshes.h"

#define FRAMES 1000000
#define LOOKS  1000

static uint64_t frames;

static void die(const char *what) {
    fprintf(stderr, "motions: %s\n", what);
    exit(2);
}

static pir_sum *sum_at(pir_polytope *p, pir_polytope *q, pir_quat rotation) {
    pir_sum *sum = NULL;
    if (pir_sum_create(p, q, rotation, NULL, &sum) != PIR_OK)
        die("no sum");
    return sum;
}

/* Each returns the number of frames that were looked at and were wrong, and how many were looked at. */
typedef uint64_t motion(uint64_t *ret_looked);

static uint64_t tiny_turns(uint64_t *ret_looked) {
    test_random random = test_random_case("tiny turns", 0);
    pir_polytope *p = test_sphere(&random, 20), *q = test_random_polytope(&random, TEST_BOX, 8);
    pir_quat r = {0, 0, 0, 1};
    pir_sum *sum = sum_at(p, q, r), *other = sum_at(p, q, r);
    pir_mesh *mesh = NULL;
    uint64_t wrong = 0;
    *ret_looked = 0;
    for (uint64_t frame = 1; frame <= frames; frame++) {
        pir_vec3 axis = test_random_direction(&random);
        double by = ldexp(1, -test_random_between(&random, 10, 30));
        r = test_compose((pir_quat){by * axis.x, by * axis.y, by * axis.z, 1}, r, 1);
        if (pir_sum_rotate(sum, r, PIR_METHOD_UPDATE) != PIR_OK)
            die("no rotation");
        if (frame % (frames / LOOKS + 1) != 0 && frame != frames)
            continue;
        if (pir_sum_reset(other, r) != PIR_OK)
            die("no rebuild");
        wrong += !pir_sum_same_pairing(sum, other);
        ++*ret_looked;
    }
    if (pir_sum_mesh(sum, PIR_EXACT, &mesh) != PIR_OK)
        die("no mesh");
    wrong += test_prove_mesh(sum, mesh) != NULL;
    pir_mesh_destroy(mesh);
    pir_sum_destroy(other);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return wrong;
}

/* Through the aligned pose of two boxes, about an axis that is an edge of both: −a, 0, a, 0, … */
static uint64_t crossings(uint64_t *ret_looked) {
    static const double at[4] = {-1, 0, 1, 0};
    pir_polytope *p = test_box(1, 2, 3), *q = test_box(3, 1, 2);
    uint64_t wrong = 0;
    pir_sum *right[4], *sum = sum_at(p, q, (pir_quat){0, 0, 0, 1});
    double angle = 1e-3;
    for (int k = 0; k < 4; k++)
        right[k] = sum_at(p, q, (pir_quat){at[k] * angle, 0, 0, 1});
    for (uint64_t frame = 0; frame < frames; frame++) {
        // the last of the angles crosses by less than any double tells in a matrix
        if (frame == frames / 2) {
            angle = 1e-200;
            for (int k = 0; k < 4; k++)
                pir_sum_reset(right[k], (pir_quat){at[k] * angle, 0, 0, 1});
        }
        if (pir_sum_rotate(sum, (pir_quat){at[frame % 4] * angle, 0, 0, 1}, PIR_METHOD_UPDATE) != PIR_OK)
            die("no rotation");
        wrong += !pir_sum_same_pairing(sum, right[frame % 4]);
    }
    *ret_looked = frames;
    for (int k = 0; k < 4; k++)
        pir_sum_destroy(right[k]);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return wrong;
}

static uint64_t ask_at(double height, pir_quat rotation, pir_state state, pir_pair *pair, pir_workspace *workspace) {
    pir_pair_input input = pir_pair_input_default();
    pir_query_result result;
    input.pose_p = (pir_pose){rotation, {0.3, -0.2, height}};
    if (pir_pair_signed_distance(pair, workspace, &input, &result) != PIR_OK)
        die("no answer");
    return result.state != state || fabs(result.distance - (height - 2)) > 1e-12;
}

/* Two boxes of height 2: they touch where the upper one is at 2. */
static uint64_t steps_or_turns(bool turns) {
    static const double off[4] = {0x1p-51, 0, -0x1p-51, 0};
    static const pir_state state[4] = {PIR_OUTSIDE, PIR_BOUNDARY, PIR_INSIDE, PIR_BOUNDARY};
    pir_polytope *p = test_box(1, 1, 1), *q = test_box(4, 4, 1);
    pir_pair *pair = NULL;
    pir_workspace *workspace = NULL;
    uint64_t wrong = 0;
    if (pir_pair_create(p, q, NULL, &pair) != PIR_OK || pir_workspace_create(NULL, &workspace) != PIR_OK)
        die("no pair");
    for (uint64_t frame = 0; frame < frames; frame++) {
        double part = (double)frame / 1000;
        uint64_t k = turns ? 1 : frame % 4;
        wrong += ask_at(2 + off[k], (pir_quat){0, 0, turns ? part : 0, 1}, state[k], pair, workspace);
    }
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return wrong;
}

static uint64_t touching(uint64_t *ret_looked) {
    *ret_looked = frames;
    return steps_or_turns(false);
}

static uint64_t turning(uint64_t *ret_looked) {
    *ret_looked = frames;
    return steps_or_turns(true);
}

int main(void) {
    static const struct {
        const char *name;
        motion *run;
    } rows[] = {{"turns of 1e-9 to 1e-3 about random axes", tiny_turns},
                {"crossings of a pose where all features tie", crossings},
                {"steps of an ulp through contact, face on face", touching},
                {"a box that turns on its face", turning}};
    const char *text = getenv("PIR_TEST_FRAMES");
    int failed = 0;
    frames = text ? strtoull(text, NULL, 10) : FRAMES;
    test_print_seed();
    printf("%-50s%12s%12s%8s%8s\n", "history", "frames", "compared", "wrong", "s");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        uint64_t looked;
        clock_t began = clock();
        uint64_t wrong = rows[i].run(&looked);
        failed |= wrong != 0;
        printf("%-50s%12llu%12llu%8llu%8.2f\n", rows[i].name, (unsigned long long)frames, (unsigned long long)looked,
               (unsigned long long)wrong, (double)(clock() - began) / CLOCKS_PER_SEC);
    }
    return failed;
}
