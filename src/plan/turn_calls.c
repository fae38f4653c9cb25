/* SPDX-License-Identifier: MIT */
/* Plans with turns, as callers see them: the question is checked here, and decided by turn_plan.h. */
#include <stdlib.h>

#include <pirouette/plan.h>

#include "base/memory.h"
#include "base/options.h"
#include "base/report.h"
#include "plan/turn_plan.h"

struct pir_turn_plan {
    pir_turn_plan_info info;
    pir_turn_result result;
};

/* A question that is being decided; pieces are held by `space`. */
struct turn_call {
    const pir_turn_plan_input *input;
    pir_turn_plan_options how;
    pir_plan_space space;
    pir_plan_pieces robot, obstacles;
};

static bool is_finite(pir_vec3 v) {
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

static bool is_within(pir_vec3 t, pir_vec3 low, pir_vec3 high) {
    return t.x >= low.x && t.y >= low.y && t.z >= low.z && t.x <= high.x && t.y <= high.y && t.z <= high.z;
}

static pir_status check_numbers(const struct turn_call *t) {
    const pir_turn_plan_input *in = t->input;
    const struct {
        const char *name;
        pir_vec3 v;
    } vector[] = {{"axis", in->axis}, {"low", in->low}, {"high", in->high}, {"from", in->from}, {"to", in->to}};
    for (int i = 0; i < 5; i++)
        if (!is_finite(vector[i].v))
            return pir_fail(t->how.report, PIR_ERR_NOT_FINITE, "%s: a coordinate is not finite", vector[i].name);
    if (!isfinite(in->from_turn) || !isfinite(in->to_turn))
        return pir_fail(t->how.report, PIR_ERR_NOT_FINITE, "from_turn, to_turn: not a finite number");
    if (in->axis.x == 0 && in->axis.y == 0 && in->axis.z == 0)
        return pir_fail(t->how.report, PIR_ERR_ARGUMENT, "axis: it is zero, which turns nothing");
    if (!(in->low.x < in->high.x && in->low.y < in->high.y && in->low.z < in->high.z))
        return pir_fail(t->how.report, PIR_ERR_ARGUMENT, "bounds: each low one must be below its high one");
    for (int e = 0; e < 2; e++) {
        const double turn = e == 0 ? in->from_turn : in->to_turn;
        if (!is_within(e == 0 ? in->from : in->to, in->low, in->high))
            return pir_fail(t->how.report, PIR_ERR_ARGUMENT, "%s: it is outside of the bounds", e == 0 ? "from" : "to");
        if (!(turn >= 0 && turn < 1))
            return pir_fail(t->how.report, PIR_ERR_ARGUMENT, "%s_turn: %g is not from 0 to below 1",
                            e == 0 ? "from" : "to", turn);
    }
    const uint32_t arcs = t->how.arcs;
    if (arcs < 8 || arcs > 65536 || (arcs & (arcs - 1)) != 0)
        return pir_fail(t->how.report, PIR_ERR_ARGUMENT, "arcs: %u is no power of two from 8 to 65536", (unsigned)arcs);
    return PIR_OK;
}

static pir_status decide(struct turn_call *t, pir_turn_plan *plan) {
    const pir_turn_plan_input *in = t->input;
    pir_status status = pir_plan_pieces_add(&t->space, in->robot, in->robot_count, "robot", t->how.report, &t->robot);
    if (status == PIR_OK)
        status =
            pir_plan_pieces_add(&t->space, in->obstacles, in->obstacle_count, "obstacle", t->how.report, &t->obstacles);
    if (status != PIR_OK)
        return status;
    // brought near 1 before it is squared
    const double most = fmax(fabs(in->axis.x), fmax(fabs(in->axis.y), fabs(in->axis.z)));
    const double x = in->axis.x / most, y = in->axis.y / most, z = in->axis.z / most,
                 length = sqrt(x * x + y * y + z * z);
    const pir_turn_question question = {
        .robot = &t->robot,
        .obstacles = &t->obstacles,
        .axis = {x / length, y / length, z / length},
        .low = {in->low.x, in->low.y, in->low.z},
        .high = {in->high.x, in->high.y, in->high.z},
        .from = {in->from.x, in->from.y, in->from.z},
        .to = {in->to.x, in->to.y, in->to.z},
        .from_turn = in->from_turn,
        .to_turn = in->to_turn,
        .most_arcs = t->how.arcs,
        .most_parts = t->how.parts,
        .memory = t->how.memory,
        .proof = t->how.proof,
    };
    status = pir_plan_turn(&question, &plan->result);
    if (status == PIR_ERR_ARGUMENT)
        return pir_fail(t->how.report, status, "from, to: the robot meets an obstacle at one of them");
    const pir_turn_result *r = &plan->result;
    plan->info =
        (pir_turn_plan_info){r->answer, r->steps, r->arcs, r->parts, t->robot.count, t->obstacles.count, r->end};
    return status;
}

static pir_status answer(struct turn_call *t, pir_turn_plan **ret_plan) {
    pir_status status = check_numbers(t);
    if (status != PIR_OK)
        return status;
    const pir_allocator allocator = pir_allocator_or_default(NULL);
    pir_turn_plan *plan = calloc(1, sizeof *plan);
    if (!plan)
        return pir_fail(t->how.report, PIR_ERR_MEMORY, "plan: out of memory");
    pir_plan_space_init(&t->space, &allocator, t->how.memory);
    status = decide(t, plan);
    pir_plan_pieces_finish(&t->space, &t->robot);
    pir_plan_pieces_finish(&t->space, &t->obstacles);
    pir_plan_space_finish(&t->space);
    if (status == PIR_OK)
        *ret_plan = plan;
    else
        pir_turn_plan_destroy(plan);
    return status;
}

pir_status pir_turn_plan_create(const pir_turn_plan_input *input, const pir_turn_plan_options *options,
                                pir_turn_plan **ret_plan) {
    if (!input || !ret_plan)
        return PIR_ERR_ARGUMENT;
    struct turn_call t = {.input = input, .how = pir_turn_plan_options_default()};
    pir_report own = {0}, *const *caller = options ? &options->report : NULL;
    pir_status status = pir_options_take("pir_turn_plan_options", options, &t.how, caller);
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

void pir_turn_plan_destroy(pir_turn_plan *plan) {
    if (!plan)
        return;
    free(plan->result.step);
    free(plan);
}

void pir_turn_plan_describe(const pir_turn_plan *plan, pir_turn_plan_info *ret_info) {
    *ret_info = plan->info;
}

pir_status pir_turn_plan_get_step(const pir_turn_plan *plan, uint32_t index, pir_turn_plan_step *ret_step) {
    if (!plan || !ret_step || index >= plan->info.steps)
        return PIR_ERR_ARGUMENT;
    const pir_turn_step *step = &plan->result.step[index];
    *ret_step = (pir_turn_plan_step){{step->at[0], step->at[1], step->at[2]}, step->low, step->high};
    return PIR_OK;
}
