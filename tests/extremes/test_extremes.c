/* SPDX-License-Identifier: MIT */
/*
 * Situations at the limits of doubles, and what must hold in each:
 *
 *   - sums: the pairing by update is that by walk and by CGM; every pair holds in exact arithmetic; the mesh is
 *     proven facet by facet by the oracle. `vertex` is the greatest error of a coordinate of the mesh in doubles.
 *   - queries: every state, outcome, witness and tie is the oracle's, exactly. `number` is the greatest error of a
 *     distance, depth, time or direction, relative to the size of the bodies and of the answer; at most 1e-12.
 *   - pairs: bit for bit what the query says; `turned` is the error with both bodies turned.
 *   - scenes: contacts and events are exactly those of the states, with the query's bits.
 *   - slices: the states that a file of slices at these rotations gives are the oracle's.
 *
 * One row a situation. PIR_TEST_POSES sets the translations at each rotation. Ends with 1 when anything failed.
 */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "extremes/slices.h"
#include "extremes/ways.h"
#include "query/exact_poses.h"
#include "query/exact_report.h"

typedef struct row {
    const char *wrong[4]; /* of sums, pairs, scenes, slices */
    double vertex, turned;
    exact_tally queries;
    uint64_t poses;
} row;

static const char *const ways[4] = {"sums", "pairs", "scenes", "slices"};

enum way { SUMS, PAIRS, SCENES, SLICES };

static void note(row *r, enum way way, const char *wrong) {
    if (wrong && !r->wrong[way])
        r->wrong[way] = wrong;
}

static void die(const char *what) {
    fprintf(stderr, "extremes: %s\n", what);
    exit(2);
}

/* Of a face on a face: any place along it, and off it by nothing or a few of the least steps. */
static pir_vec3 slide(test_random *random) {
    static const double off[5] = {0, 0, 0x1p-52, -0x1p-52, 0x1p-40};
    double x = 4 * test_random_unit(random), y = 3.5 * test_random_unit(random);
    return (pir_vec3){x, y, 1.25 + off[test_random_below(random, 5)]};
}

/* Some of the least denormals in each coordinate. */
static pir_vec3 some_steps(test_random *random) {
    int x = test_random_between(random, -8, 8), y = test_random_between(random, -8, 8);
    return (pir_vec3){x * 5e-324, y * 5e-324, (2 * test_random_between(random, -4, 4) + 1) * 5e-324};
}

static pir_vec3 translation(const situation *s, const exact_pair *pair, test_random *random) {
    if (s->move == SITUATION_SLIDE)
        return slide(random);
    if (s->move == SITUATION_STEPS)
        return some_steps(random);
    return exact_translation(random, pair->place, pair->size);
}

static void check_pose(row *r, const situation *s, exact_pair *pair, way_objects *objects, pir_quat rotation,
                       test_random *random, exact_pose *pose) {
    *pose = (exact_pose){.input = pir_query_input_default()};
    pose->t = translation(s, pair, random);
    pose->direction =
        s->move == SITUATION_STEPS ? some_steps(random) : exact_direction(random, pair->place, pose->t, pair->size);
    pose->input.translation = pose->t;
    snprintf(exact_at.text, sizeof exact_at.text, "%s, rotation %.17g,%.17g,%.17g,%.17g, t %.17g,%.17g,%.17g", s->name,
             rotation.x, rotation.y, rotation.z, rotation.w, pose->t.x, pose->t.y, pose->t.z);
    exact_check_pose(pair, random, pose);
    if (pose->limit)
        return;
    exact_check_directions(pair, pose);
    exact_check_others(pair, random, pose);
    oracle_place_set(pair->place, pose->t, pose->direction);
    note(r, PAIRS, way_pair(objects, pair, rotation, pose, &r->turned));
    note(r, SCENES, way_scene(objects, rotation, pose));
    r->poses++;
}

static void check_turns(row *r, const situation *s, exact_pair *pair, pir_sum *sum, way_objects *objects,
                        uint32_t poses) {
    test_random random = test_random_case(s->name, poses);
    slice_file slices;
    note(r, SLICES, slice_file_make(&slices, pair->body[0].polytope, pair->body[1].polytope, s->turn, s->turns));
    for (uint32_t turn = 0; turn < s->turns; turn++) {
        static exact_pose pose;
        exact_at.turn = (int)turn;
        note(r, SUMS, way_sum(sum, s->turn[turn], pair->size, &r->vertex));
        if (pir_query_create(sum, &pair->fresh) != PIR_OK)
            die("no query");
        exact_pair_turn(pair, s->turn[turn]);
        for (uint32_t i = 0; i < poses; i++) {
            exact_at.pose = (int)i;
            check_pose(r, s, pair, objects, s->turn[turn], &random, &pose);
            if (!pose.limit)
                note(r, SLICES, slice_file_check(&slices, s->turn[turn], pose.t, pose.state));
        }
        exact_pair_leave(pair);
        pir_query_destroy(pair->fresh);
    }
    slice_file_free(&slices);
}

static row check_situation(uint32_t index, uint32_t poses) {
    static situation s;
    row r = {.poses = 0};
    pir_sum *sum = NULL;
    way_objects objects;
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    situation_make(index, &s);
    exact_at = (exact_where){.scene = index};
    exact_report_only(s.kinds);
    exact_pair pair = exact_pair_make(test_polytope(&s.p), test_polytope(&s.q), s.scale);
    for (int i = 0; i < 2; i++) {
        const char *wrong = oracle_solid_compare(pair.body[i].solid, pair.body[i].polytope);
        exact_check(EXACT_FEATURES, !wrong, "%s: %s", i ? "Q" : "P", wrong ? wrong : "");
    }
    if (pir_sum_create(pair.body[0].polytope, pair.body[1].polytope, s.turn[0], &options, &sum) != PIR_OK ||
        pir_query_create(sum, &pair.query) != PIR_OK)
        die("no sum, or no query");
    note(&r, SCENES, way_objects_make(&objects, pair.body[0].polytope, pair.body[1].polytope));
    check_turns(&r, &s, &pair, sum, &objects, poses);
    way_objects_free(&objects);
    pir_query_destroy(pair.query);
    pir_sum_destroy(sum);
    exact_pair_free(&pair);
    r.queries = exact_report_take();
    return r;
}

static int print_row(const char *name, const row *r, double seconds) {
    int failed = r->queries.failed > 0;
    printf("%-50s%7llu%12.2g%12.2g%12.2g%7.2f", name, (unsigned long long)r->poses, r->vertex, r->queries.worst,
           r->turned, seconds);
    for (int way = 0; way < 4; way++) {
        failed |= r->wrong[way] != NULL;
        if (r->wrong[way])
            printf("  FAILED %s: %s", ways[way], r->wrong[way]);
    }
    if (r->queries.failed)
        printf("  FAILED queries: %llu of %llu", r->queries.failed, r->queries.count);
    printf("\n");
    return failed;
}

int main(int argc, char **argv) {
    const char *text = getenv("PIR_TEST_POSES");
    uint32_t poses = text ? (uint32_t)strtoul(text, NULL, 10) : 10, failed = 0;
    test_print_seed();
    printf("# Greatest errors: of a coordinate of the mesh, of a number of a query, of a distance with both turned.\n"
           "# States, pairings, witnesses, ties, events are exact or the row fails.\n"
           "%-50s%7s%12s%12s%12s%7s\n",
           "situation", "poses", "vertex", "number", "turned", "s");
    for (uint32_t index = 0; index < situation_count(); index++) {
        static situation s;
        if (argc > 1 && strtoul(argv[1], NULL, 10) != index)
            continue;
        situation_make(index, &s);
        clock_t began = clock();
        row r = check_situation(index, poses);
        failed += (uint32_t)print_row(s.name, &r, (double)(clock() - began) / CLOCKS_PER_SEC);
    }
    printf("# %u situations, %u failed\n", situation_count(), failed);
    return failed ? 1 : 0;
}
