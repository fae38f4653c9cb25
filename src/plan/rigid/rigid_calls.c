/* SPDX-License-Identifier: MIT */
/* Plans with all turns, as callers see them: the question is checked here, and decided by rigid_search.h. */
#include <stdlib.h>

#include <pirouette/plan.h>
#include <pirouette/version.h>

#include "base/memory.h"
#include "base/options.h"
#include "base/report.h"
#include "plan/rigid/rigid_search.h"
#include "plan/rigid/wide_pieces.h"
#include "polytope/file/file_name.h"
#include "scene/tasks/tasks.h"

struct pir_rigid_plan {
    pir_rigid_plan_info info;
    pir_rigid_result result;
};

/* A question that is being decided; pieces are held by `space`. */
struct rigid_call {
    const pir_rigid_plan_input *input;
    pir_rigid_plan_options how;
    pir_plan_space space;
    pir_plan_pieces robot, obstacles, wide; /* of the obstacles those that the robot can reach */
    pir_rigid_question question;
};

static const char *const end_name[2] = {"from", "to"};

static bool is_finite(pir_vec3 v) {
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

static pir_status check_numbers(const struct rigid_call *t) {
    const pir_rigid_plan_input *in = t->input;
    const pir_vec3 low = in->low, high = in->high;
    if (!is_finite(low) || !is_finite(high))
        return pir_fail(t->how.report, PIR_ERR_NOT_FINITE, "bounds: a coordinate is not finite");
    if (!(low.x < high.x && low.y < high.y && low.z < high.z))
        return pir_fail(t->how.report, PIR_ERR_ARGUMENT, "bounds: each low one must be below its high one");
    for (int e = 0; e < 2; e++) {
        const pir_pose pose = e == 0 ? in->from : in->to;
        const pir_vec3 x = pose.translation;
        const pir_quat q = pose.rotation;
        if (!is_finite(x) || !isfinite(q.x + q.y + q.z + q.w))
            return pir_fail(t->how.report, PIR_ERR_NOT_FINITE, "%s: a number is not finite", end_name[e]);
        if (q.x == 0 && q.y == 0 && q.z == 0 && q.w == 0)
            return pir_fail(t->how.report, PIR_ERR_ZERO_QUATERNION, "%s: the quaternion is zero", end_name[e]);
        if (!(x.x >= low.x && x.y >= low.y && x.z >= low.z && x.x <= high.x && x.y <= high.y && x.z <= high.z))
            return pir_fail(t->how.report, PIR_ERR_ARGUMENT, "%s: it is outside of the bounds", end_name[e]);
    }
    if (t->how.boxes < PIR_ROTATION_ROOTS || t->how.threads == 0)
        return pir_fail(t->how.report, PIR_ERR_ARGUMENT, "plan: less than %d boxes, or no thread", PIR_ROTATION_ROOTS);
    if (t->how.resume > 1 || t->how.asymmetric > 1 || t->how.boxes_alone > 1 || (t->how.journal && !t->how.proof))
        return pir_fail(t->how.report, PIR_ERR_ARGUMENT,
                        "plan: resume, asymmetric or boxes_alone is neither 0 nor 1, or a journal has no proof");
    const pir_plan_ranks *ranks = t->how.ranks;
    if (ranks && (ranks->number >= ranks->count || !ranks->exchange || (ranks->number > 0 && t->how.journal)))
        return pir_fail(t->how.report, PIR_ERR_ARGUMENT,
                        "plan: no such process, or one beside the first has a journal");
    return PIR_OK;
}

/* The quaternion with its largest component ±1 about, so that products are finite. */
static pir_quat scaled(pir_quat q) {
    int exponent;
    frexp(fmax(fmax(fabs(q.x), fabs(q.y)), fmax(fabs(q.z), fabs(q.w))), &exponent);
    return (pir_quat){ldexp(q.x, -exponent), ldexp(q.y, -exponent), ldexp(q.z, -exponent), ldexp(q.w, -exponent)};
}

static void fill_question(struct rigid_call *t) {
    const pir_rigid_plan_input *in = t->input;
    const pir_vec3 a = in->from.translation, b = in->to.translation;
    t->question = (pir_rigid_question){.robot = &t->robot,
                                       .obstacles = &t->obstacles,
                                       .wide = &t->wide,
                                       .low = {in->low.x, in->low.y, in->low.z},
                                       .high = {in->high.x, in->high.y, in->high.z},
                                       .at = {{a.x, a.y, a.z}, {b.x, b.y, b.z}},
                                       .rotation = {scaled(in->from.rotation), scaled(in->to.rotation)},
                                       .most_boxes = t->how.boxes,
                                       .most_parts = t->how.parts,
                                       .is_boxes_alone = t->how.boxes_alone != 0,
                                       .memory = t->how.memory,
                                       .progress = t->how.progress,
                                       .context = t->how.context};
}

/* How far the robot reaches from its origin, or more: corners are rounded, and so is their length. */
static double reach_of(const pir_plan_pieces *robot) {
    double most = 0;
    for (uint32_t i = 0; i < robot->count; i++)
        for (uint32_t v = 0; v < pir_polytope_vertex_count(robot->at[i]); v++) {
            const pir_vec3 x = pir_polytope_vertex(robot->at[i], v);
            most = fmax(most, hypot(x.x, hypot(x.y, x.z)));
        }
    return most * (1 + 0x1p-40) + PIR_PLAN_TINY;
}

/* How far it is from one number up to another, or less: both are rounded. */
static double gap_between(double from, double to) {
    return to - from - (fabs(from) + fabs(to)) * 0x1p-40;
}

/* Whether a piece is beyond the reach of translations within the bounds, at every rotation. */
static bool is_beyond(const pir_rigid_plan_input *in, double reach, const pir_polytope *piece) {
    pir_vec3 low, high;
    pir_polytope_bounds(piece, &low, &high);
    return gap_between(in->high.x, low.x) > reach || gap_between(in->high.y, low.y) > reach ||
           gap_between(in->high.z, low.z) > reach || gap_between(high.x, in->low.x) > reach ||
           gap_between(high.y, in->low.y) > reach || gap_between(high.z, in->low.z) > reach;
}

/* Leaves out what the robot cannot reach, but for one piece: an obstacle there is. */
static void leave_out_far(struct rigid_call *t) {
    const double reach = reach_of(&t->robot);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < t->obstacles.count; i++)
        if ((i + 1 < t->obstacles.count || kept > 0) && is_beyond(t->input, reach, t->obstacles.at[i])) {
            pir_polytope_release(t->obstacles.at[i]);
        } else {
            t->obstacles.body[kept] = t->obstacles.body[i];
            t->obstacles.at[kept++] = t->obstacles.at[i];
        }
    t->obstacles.count = kept;
}

/* Whether both ends are free. */
static pir_status check_ends(struct rigid_call *t) {
    for (int e = 0; e < 2; e++) {
        pir_plan_sums sums = {0};
        pir_status status = pir_plan_sums_make(&t->space, &t->robot, &t->obstacles, t->question.rotation[e], &sums);
        const uint32_t point = status == PIR_OK ? pir_plan_point_at(&t->space, t->question.at[e]) : 0;
        if (status == PIR_OK && t->space.status == PIR_OK &&
            pir_plan_sums_at(&t->space, &sums, point, false) != PIR_PLAN_NONE)
            status = pir_fail(t->how.report, PIR_ERR_ARGUMENT, "%s: the robot meets an obstacle there", end_name[e]);
        pir_plan_sums_finish(&t->space, &sums);
        if (status == PIR_OK)
            status = t->space.status;
        if (status != PIR_OK)
            return status;
    }
    return PIR_OK;
}

static uint64_t hash_doubles(uint64_t hash, const double *x, size_t count) {
    return pir_hash_words(hash, x, count * sizeof *x);
}

static uint64_t hash_pieces(uint64_t hash, const pir_plan_pieces *pieces) {
    for (uint32_t i = 0; i < pieces->count; i++) {
        const uint32_t of[2] = {pieces->body[i], pir_polytope_vertex_count(pieces->at[i])};
        hash = pir_hash_words(hash, of, sizeof of);
        for (uint32_t v = 0; v < of[1]; v++) {
            const pir_vec3 x = pir_polytope_vertex(pieces->at[i], v);
            hash = hash_doubles(hash, (const double[]){x.x, x.y, x.z}, 3);
        }
    }
    return hash;
}

/* All that blocks depend on: not on budgets, which only say which of them are made. */
static uint64_t hash_of(const struct rigid_call *t) {
    const pir_rigid_question *q = &t->question;
    uint64_t hash = pir_hash_bytes(PIR_HASH_START, PIR_VERSION_STRING, sizeof PIR_VERSION_STRING);
    hash = hash_pieces(hash_pieces(hash_pieces(hash, q->robot), q->obstacles), q->wide);
    hash = hash_doubles(hash_doubles(hash, q->low, 3), q->high, 3);
    for (int e = 0; e < 2; e++) {
        const pir_quat r = q->rotation[e];
        hash = hash_doubles(hash_doubles(hash, q->at[e], 3), (const double[]){r.x, r.y, r.z, r.w}, 4);
    }
    return hash;
}

/* Decides a question, with its threads and its journal. */
static pir_status decide_with(struct rigid_call *t, pir_rigid_result *result) {
    const pir_allocator allocator = pir_allocator_or_default(NULL);
    pir_block_makers makers = {.ranks = t->how.ranks};
    pir_task_pool *pool = NULL;
    pir_status status = pir_task_pool_create(&allocator, t->how.threads, &pool);
    if (status == PIR_OK && t->how.journal)
        status = pir_block_journal_open(t->how.journal, hash_of(t), t->how.resume != 0, t->how.report, &makers.journal);
    if (status == PIR_OK) {
        makers.tasks = pir_task_pool_interface(pool);
        status = pir_rigid_decide(&t->question, &makers, t->how.proof, result);
        // a part that is not the same again is our own mistake where nobody else had it
        if (status == PIR_ERR_FORMAT)
            status = makers.journal ? pir_fail(t->how.report, status, "%s: it has a box that is not the same again",
                                               pir_short_name(t->how.journal))
                                    : PIR_ERR_INTERNAL;
        pir_block_journal_close(makers.journal, status == PIR_OK && result->answer != PIR_TURN_PLAN_UNKNOWN);
    }
    pir_task_pool_destroy(pool);
    return status;
}

static pir_status decide(struct rigid_call *t, pir_rigid_plan *plan) {
    const pir_rigid_plan_input *in = t->input;
    pir_status status = pir_plan_pieces_add(&t->space, in->robot, in->robot_count, "robot", t->how.report, &t->robot);
    if (status == PIR_OK)
        status =
            pir_plan_pieces_add(&t->space, in->obstacles, in->obstacle_count, "obstacle", t->how.report, &t->obstacles);
    if (status != PIR_OK)
        return status;
    const uint32_t obstacle_pieces = t->obstacles.count;
    leave_out_far(t);
    fill_question(t);
    status = check_ends(t);
    if (status == PIR_OK)
        status = pir_wide_pieces_make(&t->obstacles, t->how.memory, &t->wide);
    if (status != PIR_OK)
        return status;
    t->question.symmetries.count = 1;
    if (t->how.asymmetric == 0)
        t->question.symmetries = pir_symmetries_of(&t->robot, &t->wide, t->question.low, t->question.high);
    status = decide_with(t, &plan->result);
    const pir_rigid_result *r = &plan->result;
    plan->info = (pir_rigid_plan_info){r->answer, r->steps,       r->boxes,        r->divided,
                                       r->parts,  t->robot.count, obstacle_pieces, t->question.symmetries.count,
                                       r->end,    r->cells};
    return status;
}

static pir_status answer(struct rigid_call *t, pir_rigid_plan **ret_plan) {
    pir_status status = check_numbers(t);
    if (status != PIR_OK)
        return status;
    const pir_allocator allocator = pir_allocator_or_default(NULL);
    pir_rigid_plan *plan = calloc(1, sizeof *plan);
    if (!plan)
        return pir_fail(t->how.report, PIR_ERR_MEMORY, "plan: out of memory");
    pir_plan_space_init(&t->space, &allocator, t->how.memory);
    status = decide(t, plan);
    pir_plan_pieces_finish(&t->space, &t->robot);
    pir_plan_pieces_finish(&t->space, &t->obstacles);
    pir_plan_pieces_over_free(&t->wide);
    pir_plan_space_finish(&t->space);
    if (status == PIR_OK)
        *ret_plan = plan;
    else
        pir_rigid_plan_destroy(plan);
    return status;
}

pir_status pir_rigid_plan_create(const pir_rigid_plan_input *input, const pir_rigid_plan_options *options,
                                 pir_rigid_plan **ret_plan) {
    if (!input || !ret_plan)
        return PIR_ERR_ARGUMENT;
    struct rigid_call t = {.input = input, .how = pir_rigid_plan_options_default()};
    pir_report own = {0}, *const *caller = options ? &options->report : NULL;
    pir_status status = pir_options_take("pir_rigid_plan_options", options, &t.how, caller);
    if (status != PIR_OK)
        return status;
    // a report is filled only where the call fails
    pir_report *told = t.how.report;
    t.how.report = &own;
    status = answer(&t, ret_plan);
    if (status != PIR_OK && own.status != status)
        pir_fail(&own, status, "plan: %s", pir_status_text(status));
    if (status != PIR_OK && told)
        *told = own;
    return status;
}

void pir_rigid_plan_destroy(pir_rigid_plan *plan) {
    if (!plan)
        return;
    free(plan->result.step);
    free(plan);
}

void pir_rigid_plan_describe(const pir_rigid_plan *plan, pir_rigid_plan_info *ret_info) {
    *ret_info = plan->info;
}

pir_status pir_rigid_plan_get_step(const pir_rigid_plan *plan, uint32_t index, pir_pose *ret_pose) {
    if (!plan || !ret_pose || index >= plan->info.steps)
        return PIR_ERR_ARGUMENT;
    *ret_pose = plan->result.step[index];
    return PIR_OK;
}
