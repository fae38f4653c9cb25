/* SPDX-License-Identifier: MIT */
/*
 * Every placement query against the oracle of placements (oracle/place.h): states and outcomes exactly, numbers to
 * 1e-12, points on the bodies and on the features that the witness names, answers the same bit for bit with any cache,
 * history and in batches.
 *
 *     query_exact_answers [POSES [KINDS [SCENE]]]
 *
 * checks about POSES poses, counting only checks of KINDS (names of the table with commas between them, or "all"), only
 * of scene SCENE. PIR_TEST_SEED sets the seed, PIR_TEST_PRINTED how many failures of a kind are printed. Ends with 1
 * when a check failed.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "query/exact_checks.h"
#include "query/exact_poses.h"
#include "query/exact_report.h"

#define TURNS 2
#define POSES 12

static void die(const char *what) {
    fprintf(stderr, "exact answers: %s\n", what);
    exit(2);
}

static void describe(const exact_scene *scene, pir_quat r, const exact_pose *pose) {
    snprintf(exact_at.text, sizeof exact_at.text,
             "%s, rotation %.17g,%.17g,%.17g,%.17g, t %.17g,%.17g,%.17g, direction %.17g,%.17g,%.17g", scene->situation,
             r.x, r.y, r.z, r.w, pose->t.x, pose->t.y, pose->t.z, pose->direction.x, pose->direction.y,
             pose->direction.z);
}

static void print_body(const char *name, const pir_polytope *p) {
    printf("# %s:", name);
    for (uint32_t i = 0; i < pir_polytope_vertex_count(p); i++) {
        pir_vec3 v = pir_polytope_vertex(p, i);
        printf(" %.17g,%.17g,%.17g", v.x, v.y, v.z);
    }
    printf("\n");
}

/* All poses at once give what each gave alone. */
static void check_batch(exact_pair *pair, const exact_pose *poses) {
    pir_vec3 t[POSES];
    pir_state states[POSES], more[POSES];
    double depths[POSES], distances[POSES];
    size_t count = 0;
    const exact_pose *of[POSES];
    for (int i = 0; i < POSES; i++)
        if (!poses[i].limit) {
            of[count] = &poses[i];
            t[count++] = poses[i].t;
        }
    if (pir_query_batch_states(pair->query, t, count, states) != PIR_OK ||
        pir_query_batch_depths(pair->query, t, count, depths, more) != PIR_OK)
        die("a batch is refused");
    for (size_t i = 0; i < count; i++) {
        const pir_query_result *r = &of[i]->answer;
        double depth = r->state == PIR_INSIDE ? -r->distance : 0;
        exact_at.pose = (int)(of[i] - poses);
        exact_check(EXACT_BATCH, states[i] == r->state && more[i] == r->state && depths[i] == depth,
                    "states %d %d, not %d, depth %.17g, not %.17g", (int)states[i], (int)more[i], (int)r->state,
                    depths[i], depth);
    }
    if (pir_query_batch_distances(pair->fresh, t, count, distances, more) != PIR_OK)
        die("a batch is refused");
    for (size_t i = 0; i < count; i++)
        exact_check(EXACT_BATCH, more[i] == of[i]->answer.state && distances[i] == of[i]->answer.distance,
                    "state %d, not %d, distance %.17g, not %.17g", (int)more[i], (int)of[i]->answer.state, distances[i],
                    of[i]->answer.distance);
}

static void check_turn(exact_pair *pair, test_random *random, const exact_scene *scene, pir_quat rotation) {
    exact_pose poses[POSES];
    for (int i = 0; i < POSES; i++) {
        exact_pose *pose = &poses[i];
        *pose = (exact_pose){.input = pir_query_input_default()};
        pose->t = exact_translation(random, pair->place, pair->size);
        pose->direction = exact_direction(random, pair->place, pose->t, pair->size);
        pose->input.translation = pose->t;
        exact_at.pose = i;
        describe(scene, rotation, pose);
        exact_check_pose(pair, random, pose);
        if (pose->limit)
            continue;
        exact_check_directions(pair, pose);
        if (i % 3 == 0)
            exact_check_others(pair, random, pose);
    }
    check_batch(pair, poses);
}

static void check_turns(exact_pair *pair, test_random *random, const exact_scene *scene, pir_sum *sum) {
    pir_quat rotation = scene->rotation;
    for (int turn = 0; turn < TURNS; turn++) {
        exact_at.turn = turn;
        if (pir_sum_rotate(sum, rotation, PIR_METHOD_AUTO) != PIR_OK || pir_query_create(sum, &pair->fresh) != PIR_OK)
            die("no rotation");
        exact_pair_turn(pair, rotation);
        check_turn(pair, random, scene, rotation);
        exact_pair_leave(pair);
        pir_query_destroy(pair->fresh);
        rotation = exact_rotation(random, scene);
    }
}

static void check_scene(uint64_t number, int prints) {
    test_random random = test_random_case("exact answers", number);
    static exact_scene scene;
    exact_at = (exact_where){.scene = number};
    exact_scene_make(&random, number, &scene);
    snprintf(exact_at.text, sizeof exact_at.text, "%s", scene.situation);
    exact_pair pair = exact_pair_make(test_polytope(&scene.points_p), test_polytope(&scene.points_q), scene.scale);
    uint32_t vertices = 0;
    for (int i = 0; i < 2; i++) {
        const char *wrong = oracle_solid_compare(pair.body[i].solid, pair.body[i].polytope);
        exact_check(EXACT_FEATURES, !wrong, "%s: %s", i ? "Q" : "P", wrong ? wrong : "");
        vertices += pair.body[i].solid->count;
        if (prints)
            print_body(i ? "Q" : "P", pair.body[i].polytope);
    }
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    pir_sum *sum;
    if (pir_sum_create(pair.body[0].polytope, pair.body[1].polytope, scene.rotation, &options, &sum) != PIR_OK)
        die("no sum");
    pir_status status = pir_query_create(sum, &pair.query);
    // two points may be too far away for their size, which then is 1
    exact_check(EXACT_STATE, status == PIR_OK || (status == PIR_ERR_LIMIT && vertices == 2), "no query: status %d",
                (int)status);
    if (status == PIR_OK)
        check_turns(&pair, &random, &scene, sum);
    pir_query_destroy(status == PIR_OK ? pair.query : NULL);
    pir_sum_destroy(sum);
    exact_pair_free(&pair);
}

int main(int argc, char **argv) {
    uint64_t poses = argc > 1 ? strtoull(argv[1], NULL, 10) : 2000,
             scenes = (poses + TURNS * POSES - 1) / (TURNS * POSES);
    if (argc > 2 && strcmp(argv[2], "all") != 0 && !exact_report_only(argv[2]))
        die("no such kind of check");
    test_print_seed();
    if (argc > 3)
        check_scene(strtoull(argv[3], NULL, 10), 1);
    else
        for (uint64_t number = 0; number < scenes; number++)
            check_scene(number, 0);
    printf("# %llu poses\n", (unsigned long long)(argc > 3 ? 1 : scenes) * TURNS * POSES);
    return exact_report_print() ? 1 : 0;
}
