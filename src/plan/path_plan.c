/* SPDX-License-Identifier: MIT */
/*
 * A plan is made in stages: convex pieces, their sums, the division of the box (divide.h), what of it is connected
 * (join.h), the path (way.h).
 */
#include "plan/path_plan.h"

#include <pirouette/exact.h>

#include "base/memory.h"
#include "base/options.h"
#include "base/report.h"

static bool is_finite(pir_vec3 v) {
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

/* --- the question --- */

struct question {
    const pir_path_plan_input *input;
    pir_vec3 ends[2];
    pir_path_plan_options how;
};

static const char *const end_names[2] = {"from", "to"};

static pir_status check_bounds(const struct question *q) {
    const pir_vec3 low = q->how.low, high = q->how.high;
    if (!q->how.bounded)
        return PIR_OK;
    if (!is_finite(low) || !is_finite(high))
        return pir_fail(q->how.report, PIR_ERR_NOT_FINITE, "bounds: a coordinate is not finite");
    if (!(low.x < high.x && low.y < high.y && low.z < high.z))
        return pir_fail(q->how.report, PIR_ERR_ARGUMENT, "bounds: each low one must be below its high one");
    for (int e = 0; e < 2; e++) {
        const pir_vec3 t = q->ends[e];
        if (t.x < low.x || t.y < low.y || t.z < low.z || t.x > high.x || t.y > high.y || t.z > high.z)
            return pir_fail(q->how.report, PIR_ERR_ARGUMENT, "%s: it is outside of the bounds", end_names[e]);
    }
    return PIR_OK;
}

static bool are_solids(const pir_solid *const *solid, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (!solid || !solid[i])
            return false;
    return true;
}

static pir_status check_question(const struct question *q) {
    const pir_quat r = q->input->rotation;
    if (!isfinite(r.x) || !isfinite(r.y) || !isfinite(r.z) || !isfinite(r.w))
        return pir_fail(q->how.report, PIR_ERR_NOT_FINITE, "rotation: a component is not finite");
    if (r.x == 0 && r.y == 0 && r.z == 0 && r.w == 0)
        return pir_fail(q->how.report, PIR_ERR_ZERO_QUATERNION, "rotation: the quaternion is zero");
    for (int e = 0; e < 2; e++)
        if (!is_finite(q->ends[e]))
            return pir_fail(q->how.report, PIR_ERR_NOT_FINITE, "%s: a coordinate is not finite", end_names[e]);
    if (q->input->robot_count == 0 || q->input->obstacle_count == 0)
        return pir_fail(q->how.report, PIR_ERR_EMPTY, "plan: there is no %s",
                        q->input->robot_count == 0 ? "robot" : "obstacle");
    if (!are_solids(q->input->robot, q->input->robot_count) ||
        !are_solids(q->input->obstacles, q->input->obstacle_count))
        return pir_fail(q->how.report, PIR_ERR_ARGUMENT, "plan: a solid is NULL");
    return check_bounds(q);
}

/* --- stages --- */

static pir_status make_sums(pir_path_plan *plan, const struct question *q) {
    const pir_path_plan_input *in = q->input;
    pir_status status =
        pir_plan_pieces_add(&plan->space, in->robot, in->robot_count, "robot", q->how.report, &plan->robot);
    if (status == PIR_OK)
        status = pir_plan_pieces_add(&plan->space, in->obstacles, in->obstacle_count, "obstacle", q->how.report,
                                     &plan->obstacles);
    if (status == PIR_OK)
        status = pir_plan_sums_make(&plan->space, &plan->robot, &plan->obstacles, in->rotation, &plan->sums);
    return status;
}

/* The bounds; or a box that has all sums and both ends within it, an eighth of the widest side away. */
static pir_status make_box(pir_path_plan *plan, const struct question *q) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, widest = 0;
    for (uint32_t i = 0; i < plan->sums.count; i++)
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], plan->sums.sum[i].low[k]);
            high[k] = fmax(high[k], plan->sums.sum[i].high[k]);
        }
    for (int e = 0; e < 2; e++)
        pir_plan_box_add(&plan->space, plan->end[e], low, high);
    for (int k = 0; k < 3; k++)
        widest = fmax(widest, high[k] - low[k]);
    const double bounds[2][3] = {{q->how.low.x, q->how.low.y, q->how.low.z},
                                 {q->how.high.x, q->how.high.y, q->how.high.z}};
    for (int k = 0; k < 3; k++) {
        plan->tree.low[k] = plan->bounded ? bounds[0][k] : low[k] - widest / 8;
        plan->tree.high[k] = plan->bounded ? bounds[1][k] : high[k] + widest / 8;
        const bool is_around = plan->tree.low[k] < low[k] && plan->tree.high[k] > high[k];
        if (!isfinite(plan->tree.low[k]) || !isfinite(plan->tree.high[k]) || (!plan->bounded && !is_around))
            return pir_fail(q->how.report, PIR_ERR_LIMIT, "plan: coordinates are too large for a box around all");
    }
    return PIR_OK;
}

/* Both ends are to be free. */
static pir_status make_ends(pir_path_plan *plan, const struct question *q) {
    for (int e = 0; e < 2; e++) {
        const double x[3] = {q->ends[e].x, q->ends[e].y, q->ends[e].z};
        plan->end[e] = pir_plan_point_at(&plan->space, x);
        if (plan->space.status != PIR_OK)
            return plan->space.status;
        const uint32_t met = pir_plan_sums_at(&plan->space, &plan->sums, plan->end[e], q->how.open);
        if (met != PIR_PLAN_NONE)
            return pir_fail(q->how.report, PIR_ERR_ARGUMENT, "%s: it is not free: the robot %s obstacle %u",
                            end_names[e], q->how.open ? "overlaps" : "touches or overlaps",
                            plan->obstacles.body[plan->sums.sum[met].obstacle]);
    }
    return plan->space.status;
}

/* A free cell that has each end: any, for all that have it are connected. */
static pir_status find_cells(pir_path_plan *plan) {
    for (int e = 0; e < 2; e++) {
        uint32_t cell = 0;
        while (cell < plan->tree.cell_count && !pir_plan_cell_has(&plan->space, &plan->tree.cell[cell], plan->end[e]))
            cell++;
        if (cell == plan->tree.cell_count)
            return PIR_ERR_INTERNAL;
        plan->cell[e] = cell;
    }
    return PIR_OK;
}

static void fill_info(pir_path_plan *plan) {
    const uint32_t *root = plan->joints.root;
    uint32_t components = 0;
    for (uint32_t i = 0; i < plan->joints.cells; i++)
        components += root[i] == i;
    const double *low = plan->tree.low, *high = plan->tree.high;
    plan->info = (pir_path_plan_info){
        .answer = root[plan->cell[0]] == root[plan->cell[1]] ? PIR_PLAN_PATH : PIR_PLAN_NO_PATH,
        .robot_pieces = plan->robot.count,
        .obstacle_pieces = plan->obstacles.count,
        .sums = plan->sums.count,
        .parts = plan->tree.node_count,
        .free_parts = plan->tree.cell_count,
        .components = components,
        .low = {low[0], low[1], low[2]},
        .high = {high[0], high[1], high[2]},
    };
}

static pir_status make_plan(pir_path_plan *plan, const struct question *q) {
    pir_plan_space *space = &plan->space;
    pir_plan_cutter cutter = {.space = space};
    pir_status status = make_sums(plan, q);
    if (status == PIR_OK)
        status = make_ends(plan, q);
    if (status == PIR_OK)
        status = make_box(plan, q);
    if (status == PIR_OK) {
        pir_plan_divide(&cutter, &plan->sums, q->how.parts > 0 ? q->how.parts : UINT32_MAX, &plan->tree);
        if (space->status == PIR_OK)
            pir_plan_join(&cutter, &plan->tree, &plan->joints);
        status = space->status;
    }
    if (status == PIR_OK)
        status = find_cells(plan);
    if (status == PIR_OK) {
        fill_info(plan);
        if (plan->info.answer == PIR_PLAN_PATH)
            pir_plan_way_make(&cutter, &plan->sums, &plan->tree, &plan->joints, plan->cell, plan->end, &plan->way);
        plan->info.points = plan->way.count;
        status = space->status;
    }
    pir_plan_cutter_finish(&cutter);
    return status;
}

/* Fills the report where no stage has. The status that callers are told. */
static pir_status tell(const struct question *q, const pir_path_plan *plan, pir_status status) {
    pir_report *report = q->how.report;
    if (report->status == status)
        return status;
    if (status == PIR_PLAN_ERR_PARTS)
        return pir_fail(report, PIR_ERR_LIMIT, "plan: more than %u parts are needed", q->how.parts);
    if (status == PIR_ERR_LIMIT)
        return pir_fail(report, status, "plan: more than %zu bytes are needed, with %u parts of the box made",
                        q->how.memory, plan->tree.node_count);
    return pir_fail(report, status, "plan: %s", pir_status_text(status));
}

static pir_status answer(struct question *q, pir_path_plan **ret_plan) {
    pir_status status = check_question(q);
    if (status != PIR_OK)
        return status;
    const pir_allocator allocator = pir_allocator_or_default(q->how.allocator);
    pir_path_plan *plan = PIR_ZEROED(&allocator, pir_path_plan, 1);
    if (!plan)
        return pir_fail(q->how.report, PIR_ERR_MEMORY, "plan: out of memory");
    plan->allocator = allocator;
    plan->rotation = q->input->rotation;
    plan->bounded = q->how.bounded;
    plan->tree.open = q->how.open;
    pir_plan_space_init(&plan->space, &plan->allocator, q->how.memory);
    status = make_plan(plan, q);
    if (status == PIR_OK) {
        *ret_plan = plan;
        return PIR_OK;
    }
    status = tell(q, plan, status);
    pir_path_plan_destroy(plan);
    return status;
}

pir_status pir_path_plan_translate(const pir_path_plan_input *input, const pir_path_plan_options *options,
                                   pir_path_plan **ret_plan) {
    if (!input || !ret_plan)
        return PIR_ERR_ARGUMENT;
    struct question q = {input, {input->from, input->to}, pir_path_plan_options_default()};
    pir_report own = {0}, *const *caller = options ? &options->report : NULL;
    pir_status status = pir_options_take("pir_path_plan_options", options, &q.how, caller);
    if (status != PIR_OK)
        return status;
    // a report is filled only where the call fails
    pir_report *told = q.how.report;
    q.how.report = &own;
    status = answer(&q, ret_plan);
    if (status != PIR_OK && told)
        *told = own;
    return status;
}

void pir_path_plan_destroy(pir_path_plan *plan) {
    if (!plan)
        return;
    const pir_allocator allocator = plan->allocator;
    pir_plan_way_finish(&plan->space, &plan->way);
    pir_plan_joints_finish(&plan->space, &plan->joints);
    pir_plan_tree_finish(&plan->space, &plan->tree);
    pir_plan_sums_finish(&plan->space, &plan->sums);
    pir_plan_pieces_finish(&plan->space, &plan->robot);
    pir_plan_pieces_finish(&plan->space, &plan->obstacles);
    pir_plan_space_finish(&plan->space);
    PIR_FREE(&allocator, plan, 1);
}

/* --- answers --- */

void pir_path_plan_describe(const pir_path_plan *plan, pir_path_plan_info *ret_info) {
    *ret_info = plan->info;
}

pir_status pir_path_plan_waypoint(const pir_path_plan *plan, uint32_t index, pir_vec3 *ret_point, bool *ret_exact) {
    if (!plan || !ret_point || index >= plan->way.count)
        return PIR_ERR_ARGUMENT;
    const pir_plan_point *p = &plan->space.point[plan->way.point[index]];
    bool exact = true;
    mpq_t x, rounded;
    mpq_inits(x, rounded, NULL);
    for (int k = 0; k < 3; k++) {
        mpz_set(mpq_numref(x), p->x[k]);
        mpz_set(mpq_denref(x), p->w);
        mpq_canonicalize(x);
        exact = exact && isfinite(p->at[k]);
        if (exact)
            mpq_set_d(rounded, p->at[k]);
        exact = exact && mpq_equal(x, rounded);
    }
    mpq_clears(x, rounded, NULL);
    *ret_point = (pir_vec3){p->at[0], p->at[1], p->at[2]};
    if (ret_exact)
        *ret_exact = exact;
    return PIR_OK;
}

pir_status pir_path_plan_waypoint_exact(const pir_path_plan *plan, uint32_t index, mpq_t ret_coordinates[3]) {
    if (!plan || !ret_coordinates || index >= plan->way.count)
        return PIR_ERR_ARGUMENT;
    const pir_plan_point *p = &plan->space.point[plan->way.point[index]];
    for (int k = 0; k < 3; k++) {
        mpz_set(mpq_numref(ret_coordinates[k]), p->x[k]);
        mpz_set(mpq_denref(ret_coordinates[k]), p->w);
        mpq_canonicalize(ret_coordinates[k]);
    }
    return PIR_OK;
}
