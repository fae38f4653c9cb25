/* SPDX-License-Identifier: MIT */
/*
 * Classifying a pose: blocked as soon as one pair of pieces is, free when all pairs are. What balls around two pieces
 * do not part is decided by pairs by need, exactly, at the very doubles of the pose.
 *
 * Invariant: the pair of robot piece k and obstacle piece l is kept at its number modulo `pair_count`, where `made`
 * names what is there. What a pair was asked before does not change an answer, so neither does what was kept.
 *
 * Errors: with u = 2^-53, matrices are within 31u of the exact ones in Frobenius norm (exact/rotation.h), vertices
 * within u of their length. What that and rounding make of the place of a ball is some 100u of the lengths that enter.
 */
#include "cspace/answer/pose_answers.h"

#include <math.h>

#include "base/layout.h"
#include "base/report.h"
#include "base/vec.h"
#include "cspace/answer/same_rotation.h"
#include "cspace/grid/angle.h"
#include "cspace/grid/nearby.h"
#include "exact/rotation.h"

/*
 * How many of the nearest rotations of a list are held against the pose's, which may be closer to each other than
 * doubles tell. Those of other grids are not: the nearest is the pose's own where one is.
 */
#define NEAREST 4

/* The most pairs that are kept. */
#define PAIRS 1024

/* Translations beyond are refused, as pairs refuse them: sums with lengths of bodies could overflow. */
#define FARTHEST 0x1p1000

#define BALL_ERROR (512 * PIR_ROUNDING)
/* Twice what distances of pairs may be off by, relative to the bodies and the distance. */
#define DISTANCE_ERROR 4e-12

typedef struct pir_kept_pair {
    pir_pair *pair; /* NULL: none */
    uint64_t made;
} pir_kept_pair;

static pir_layout layout_of(pir_answers *answers) {
    return (pir_layout){{PIR_ROW(answers->robot, answers->bodies.robot_count),
                         PIR_ROW(answers->obstacle, answers->bodies.obstacle_count),
                         PIR_ROW(answers->pair, answers->pair_count)}};
}

pir_status pir_answers_init(pir_answers *answers, const pir_answered_bodies *bodies, const pir_allocator *allocator) {
    const uint64_t pairs = (uint64_t)bodies->robot_count * bodies->obstacle_count;
    *answers = (pir_answers){.allocator = pir_allocator_or_default(allocator), .bodies = *bodies};
    answers->input = pir_pair_input_default();
    answers->is_list = pir_grid_get_info(bodies->grid).kind == PIR_GRID_LIST;
    answers->pair_count = pairs < PAIRS ? (uint32_t)pairs : PAIRS;
    pir_layout layout = layout_of(answers);
    if (!pir_layout_new(&answers->allocator, &layout)) {
        answers->pair_count = 0;
        return PIR_ERR_MEMORY;
    }
    for (uint32_t k = 0; k < answers->pair_count; k++)
        answers->pair[k] = (pir_kept_pair){NULL, 0};
    for (uint32_t k = 0; k < bodies->robot_count; k++)
        answers->robot[k] = pir_piece_ball_of(bodies->robot[k]);
    for (uint32_t k = 0; k < bodies->obstacle_count; k++)
        answers->obstacle[k] = pir_piece_ball_of(bodies->obstacle[k]);
    return pir_workspace_create(&answers->allocator, &answers->workspace);
}

void pir_answers_finish(pir_answers *answers) {
    for (uint32_t k = 0; k < answers->pair_count; k++)
        pir_pair_destroy(answers->pair[k].pair);
    pir_workspace_destroy(answers->workspace);
    pir_layout layout = layout_of(answers);
    pir_layout_free(&answers->allocator, &layout);
}

/* A pose that is being classified. */
struct asked {
    pir_answers *answers;
    const pir_pose *pose;
    pir_rotation_doubles rotation;
    pir_answer_wish wish;
    double length; /* of the translation */
    pir_configuration configuration;
    double nearest_balls; /* the least gap between balls of two pieces so far */
    double gap;           /* of the pair of pieces that is nearest, as far as all are apart */
    double overlap;       /* of the pair of pieces that blocks */
};

/* The pair of two pieces. */
static pir_status get_pair(pir_answers *answers, uint32_t robot, uint32_t obstacle, pir_pair **ret_pair) {
    const uint64_t number = (uint64_t)robot * answers->bodies.obstacle_count + obstacle;
    pir_kept_pair *kept = &answers->pair[number < answers->pair_count ? number : number % answers->pair_count];
    pir_status status = PIR_OK;
    if (!kept->pair) {
        pir_pair_options options = pir_pair_options_default();
        options.allocator = &answers->allocator;
        status =
            pir_pair_create(answers->bodies.robot[robot], answers->bodies.obstacle[obstacle], &options, &kept->pair);
    } else if (kept->made != number) {
        status = pir_pair_reset(kept->pair, answers->bodies.robot[robot], answers->bodies.obstacle[obstacle]);
    }
    if (status != PIR_OK)
        return status;
    kept->made = number;
    *ret_pair = kept->pair;
    return PIR_OK;
}

/* A lower bound on how far apart the balls around two pieces are. */
static double between_balls(const struct asked *asked, const pir_piece_ball *p, const pir_piece_ball *q) {
    pir_vec3 centre = pir_vec_add(pir_mat_apply(&asked->rotation.r, p->centre), asked->pose->translation);
    double error = BALL_ERROR * (p->reach + q->reach + asked->length);
    return pir_safe_length(pir_vec_sub(centre, q->centre)) - p->radius - q->radius - error;
}

/* Adds the exact state of one pair to what is known of the pose. */
static void add_state(struct asked *asked, pir_state state, double gap, uint32_t robot, uint32_t obstacle) {
    pir_configuration *known = &asked->configuration;
    known->state = state > known->state ? state : known->state;
    if (state == PIR_OUTSIDE) {
        asked->gap = fmin(asked->gap, gap);
    } else if (known->verdict != PIR_VERDICT_BLOCKED) {
        known->verdict = PIR_VERDICT_BLOCKED;
        known->place.robot = robot;
        known->place.obstacle = obstacle;
        asked->overlap = gap;
    }
}

static pir_status ask_pair(struct asked *asked, uint32_t robot, uint32_t obstacle) {
    pir_answers *answers = asked->answers;
    const pir_piece_ball *p = &answers->robot[robot], *q = &answers->obstacle[obstacle];
    const double balls = between_balls(asked, p, q);
    if (balls < asked->nearest_balls && asked->configuration.verdict == PIR_VERDICT_FREE) {
        asked->nearest_balls = balls;
        asked->configuration.place.robot = robot;
        asked->configuration.place.obstacle = obstacle;
    }
    if (balls > 0) {
        add_state(asked, PIR_OUTSIDE, balls, robot, obstacle);
        return PIR_OK;
    }
    pir_pair *pair;
    pir_query_result result;
    answers->input.pose_p = *asked->pose;
    pir_status status = get_pair(answers, robot, obstacle, &pair);
    if (status != PIR_OK)
        return status;
    status = asked->wish == PIR_WISH_GAP ? pir_pair_signed_distance(pair, answers->workspace, &answers->input, &result)
                                         : pir_pair_overlap(pair, answers->workspace, &answers->input, &result);
    if (status != PIR_OK)
        return status;
    double gap = 0;
    if (asked->wish == PIR_WISH_GAP)
        gap = fmax(0, fabs(result.distance) - DISTANCE_ERROR * (p->reach + q->reach + fabs(result.distance)));
    add_state(asked, result.state, gap, robot, obstacle);
    return PIR_OK;
}

static pir_status ask_all(struct asked *asked) {
    const pir_answered_bodies *bodies = &asked->answers->bodies;
    for (uint32_t robot = 0; robot < bodies->robot_count; robot++)
        for (uint32_t obstacle = 0; obstacle < bodies->obstacle_count; obstacle++) {
            pir_status status = ask_pair(asked, robot, obstacle);
            if (status != PIR_OK)
                return status;
            // one is enough; on the grid the state is told, which is the most overlapping one of all
            if (asked->configuration.verdict == PIR_VERDICT_BLOCKED &&
                (!asked->configuration.on_grid || asked->configuration.state == PIR_INSIDE))
                return PIR_OK;
        }
    return PIR_OK;
}

/* Makes a rotation of the grid the pose's own, where it is: its `unit` is known. */
static bool is_own(struct asked *asked, uint64_t number, pir_quat unit) {
    // those that are not close, as nearly all, are not held against the pose's by integers
    if (fabs(pir_quat_dot(asked->rotation.unit, unit)) <= 1 - 1e-9 ||
        !pir_same_rotation(asked->pose->rotation, pir_grid_rotation(asked->answers->bodies.grid, number)))
        return false;
    asked->configuration.place.slice = number;
    asked->configuration.on_grid = true;
    asked->configuration.turn = 0;
    return true;
}

/* The nearest rotation, that of the pose's very rotation first: doubles may take one 1e-16 off for nearer. */
static void find_nearest(struct asked *asked) {
    const pir_grid *grid = asked->answers->bodies.grid;
    const pir_grid_nearby nearby = pir_grid_nearest_to(grid, asked->pose->rotation, asked->rotation.unit);
    asked->configuration.place.slice = nearby.number;
    asked->configuration.turn = pir_rotation_angle_bound(asked->rotation.unit, nearby.unit);
    if (is_own(asked, nearby.number, nearby.unit) || !asked->answers->is_list)
        return;
    uint64_t nearest[NEAREST];
    const size_t count = pir_grid_nearest(grid, asked->pose->rotation, NEAREST, nearest);
    for (size_t k = 1; k < count; k++)
        if (is_own(asked, nearest[k], pir_quat_unit(pir_grid_rotation(grid, nearest[k]))))
            return;
}

/* As pir_rotation_set, the doubles alone. */
static pir_status set_doubles(pir_rotation_doubles *doubles, pir_quat given) {
    const pir_quat q = pir_quat_signed(given);
    if (pir_quat_is_near_one(q)) {
        *doubles = pir_doubles_of(q);
        return PIR_OK;
    }
    pir_rotation rotation;
    const pir_status status = pir_rotation_set(&rotation, given);
    if (status == PIR_OK)
        *doubles = (pir_rotation_doubles){rotation.unit, rotation.r};
    return status;
}

pir_status pir_answers_classify(pir_answers *answers, const pir_pose *pose, pir_answer_wish wish, pir_report *report,
                                pir_configuration *ret_configuration, double *ret_gap) {
    struct asked asked; // set member by member, for the whole is written far faster than it is cleared
    asked.answers = answers;
    asked.pose = pose;
    asked.wish = wish;
    asked.gap = asked.nearest_balls = HUGE_VAL;
    asked.overlap = 0;
    asked.configuration = (pir_configuration){.verdict = PIR_VERDICT_FREE};
    pir_status status = set_doubles(&asked.rotation, pose->rotation);
    if (status == PIR_OK && !pir_vec_is_finite(pose->translation))
        status = PIR_ERR_NOT_FINITE;
    if (status == PIR_OK) {
        asked.length = pir_safe_length(pose->translation);
        status = asked.length <= FARTHEST ? PIR_OK : PIR_ERR_LIMIT;
    }
    if (status == PIR_OK) {
        if (wish != PIR_WISH_VERDICT)
            find_nearest(&asked);
        status = ask_all(&asked);
    }
    if (status != PIR_OK)
        return pir_fail(report, status, "the pose: %s", pir_status_text(status));
    if (!asked.configuration.on_grid)
        asked.configuration.state = PIR_OUTSIDE;
    *ret_configuration = asked.configuration;
    *ret_gap = asked.configuration.verdict == PIR_VERDICT_FREE ? asked.gap : asked.overlap;
    return PIR_OK;
}
