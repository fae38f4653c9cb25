/* SPDX-License-Identifier: MIT */
/*
 * Classifying a pose: blocked as soon as one pair of pieces is, free when all pairs are. A pair that its balls do not
 * part is asked at the slices of the nearest rotations, the nearest first, until one proves something.
 */
#include "cspace/answer/pose_answers.h"

#include <math.h>

#include "base/layout.h"
#include "base/report.h"
#include "cspace/answer/same_rotation.h"

/* How many of the nearest slices are asked. */
#define NEAREST 4

/* How many slices are held: at least, and for each pair of pieces. */
#define HELD_LEAST 256
#define HELD_PAIR  16
#define HELD_MOST  ((uint64_t)1 << 20)

static pir_layout layout_of(pir_answers *answers) {
    return (pir_layout){{PIR_ROW(answers->robot, answers->source.robot_count),
                         PIR_ROW(answers->obstacle, answers->source.obstacle_count)}};
}

pir_status pir_answers_init(pir_answers *answers, const pir_slice_source *source, const pir_allocator *allocator) {
    *answers = (pir_answers){.allocator = pir_allocator_or_default(allocator), .source = *source};
    pir_layout layout = layout_of(answers);
    uint64_t room = (uint64_t)source->robot_count * source->obstacle_count * HELD_PAIR;
    room = room < HELD_LEAST ? HELD_LEAST : room > HELD_MOST ? HELD_MOST : room;
    if (!pir_layout_new(&answers->allocator, &layout) ||
        !pir_held_init(&answers->held, (uint32_t)room, &answers->allocator))
        return PIR_ERR_MEMORY;
    for (uint32_t k = 0; k < source->robot_count; k++)
        answers->robot[k] = pir_piece_ball_of(source->robot[k]);
    for (uint32_t k = 0; k < source->obstacle_count; k++)
        answers->obstacle[k] = pir_piece_ball_of(source->obstacle[k]);
    return PIR_OK;
}

void pir_answers_finish(pir_answers *answers) {
    pir_held_finish(&answers->held, &answers->allocator);
    pir_layout layout = layout_of(answers);
    pir_layout_free(&answers->allocator, &layout);
}

/* A pose that is being classified. */
struct asked {
    pir_answers *answers;
    pir_rotation rotation;
    pir_vec3 translation;
    uint64_t nearest[NEAREST];
    size_t count;
    pir_report *report;
    pir_configuration configuration;
    double gap;     /* of the pair of pieces that is nearest, as far as all are apart */
    double overlap; /* of the pair of pieces that blocks */
};

static pir_asked_pair pair_of(const struct asked *asked, uint32_t robot, uint32_t obstacle) {
    pir_answers *answers = asked->answers;
    return (pir_asked_pair){
        &answers->source, &answers->held, &answers->robot[robot], &answers->obstacle[obstacle], robot,
        obstacle,         asked->report};
}

/* A pair at the rotation of a slice. */
static pir_status ask_on_grid(struct asked *asked, const pir_asked_pair *pair, pir_proof *proof) {
    pir_state state;
    pir_status status = pir_pair_at_slice(pair, asked->nearest[0], asked->translation, &state, proof);
    if (status == PIR_OK && state > asked->configuration.state)
        asked->configuration.state = state;
    return status;
}

/* A pair beside the nearest slices. *ret_slice is the one that proves something, or the nearest. */
static pir_status ask_between(struct asked *asked, const pir_asked_pair *pair, pir_proof *proof, uint64_t *ret_slice) {
    pir_status status = PIR_OK;
    *ret_slice = asked->nearest[0];
    for (size_t k = 0; k < asked->count && status == PIR_OK; k++) {
        status = pir_pair_by_slice(pair, &asked->rotation, asked->translation, asked->nearest[k], proof);
        if (status == PIR_OK && (proof->free || proof->blocked)) {
            *ret_slice = asked->nearest[k];
            break;
        }
    }
    return status;
}

/* Adds what is proven of one pair to what is known of the pose. */
static void add_proof(struct asked *asked, const pir_proof *proof, pir_cspace_place place) {
    pir_configuration *known = &asked->configuration;
    if (proof->blocked) {
        // the most overlapping pair on the grid, else the first
        if (known->verdict != PIR_VERDICT_BLOCKED) {
            known->verdict = PIR_VERDICT_BLOCKED;
            known->place = place;
            asked->overlap = proof->gap;
        }
    } else if (!proof->free) {
        if (known->verdict == PIR_VERDICT_FREE) {
            known->verdict = PIR_VERDICT_UNKNOWN;
            known->place = place;
        }
    } else if (proof->gap < asked->gap) {
        asked->gap = proof->gap;
        if (known->verdict == PIR_VERDICT_FREE)
            known->place = place;
    }
}

static pir_status ask_pair(struct asked *asked, uint32_t robot, uint32_t obstacle) {
    const pir_asked_pair pair = pair_of(asked, robot, obstacle);
    pir_proof proof = {0};
    uint64_t slice = asked->nearest[0];
    pir_status status = PIR_OK;
    if (asked->configuration.on_grid)
        status = ask_on_grid(asked, &pair, &proof);
    else if (!pir_balls_apart(&pair, &asked->rotation, asked->translation, &proof))
        status = ask_between(asked, &pair, &proof, &slice);
    if (status == PIR_OK)
        add_proof(asked, &proof, (pir_cspace_place){robot, obstacle, slice});
    return status;
}

static pir_status ask_all(struct asked *asked) {
    const pir_slice_source *source = &asked->answers->source;
    for (uint32_t robot = 0; robot < source->robot_count; robot++)
        for (uint32_t obstacle = 0; obstacle < source->obstacle_count; obstacle++) {
            pir_status status = ask_pair(asked, robot, obstacle);
            if (status != PIR_OK)
                return status;
            // between slices one is enough; on the grid the state is the most overlapping one of all
            if (asked->configuration.verdict == PIR_VERDICT_BLOCKED &&
                (!asked->configuration.on_grid || asked->configuration.state == PIR_INSIDE))
                return PIR_OK;
        }
    return PIR_OK;
}

/* The nearest slices, that of the pose's very rotation first: doubles may take a rotation 1e-16 off for nearer. */
static void find_nearest(struct asked *asked, pir_quat rotation) {
    const pir_grid *grid = asked->answers->source.grid;
    uint64_t *nearest = asked->nearest;
    asked->count = pir_grid_nearest(grid, rotation, NEAREST, nearest);
    for (size_t k = 0; k < asked->count && !asked->configuration.on_grid; k++)
        if (pir_same_rotation(rotation, pir_grid_rotation(grid, nearest[k]))) {
            uint64_t same = nearest[k];
            nearest[k] = nearest[0];
            nearest[0] = same;
            asked->configuration.on_grid = 1;
        }
}

pir_status pir_answers_classify(pir_answers *answers, const pir_pose *pose, pir_report *report,
                                pir_configuration *ret_configuration, double *ret_gap) {
    struct asked asked = {.answers = answers, .translation = pose->translation, .report = report, .gap = HUGE_VAL};
    pir_status status = pir_rotation_set(&asked.rotation, pose->rotation);
    if (status == PIR_OK && !pir_vec_is_finite(pose->translation))
        status = PIR_ERR_NOT_FINITE;
    if (status != PIR_OK)
        return pir_fail(report, status, "the pose: %s", pir_status_text(status));
    find_nearest(&asked, pose->rotation);
    asked.configuration.verdict = PIR_VERDICT_FREE;
    asked.configuration.place.slice = asked.nearest[0];
    status = ask_all(&asked);
    if (status != PIR_OK)
        return status;
    pir_rotation at;
    pir_rotation_set(&at, pir_grid_rotation(answers->source.grid, asked.configuration.place.slice));
    asked.configuration.turn = asked.configuration.on_grid ? 0 : pir_rotation_angle_bound(asked.rotation.unit, at.unit);
    *ret_configuration = asked.configuration;
    *ret_gap = asked.configuration.verdict == PIR_VERDICT_FREE ? asked.gap : asked.overlap;
    return PIR_OK;
}
