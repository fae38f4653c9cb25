/* SPDX-License-Identifier: MIT */
/*
 * The first contact of a pair: from separating plane to separating plane, each proven at the κ where the last one
 * ends.
 *
 * At such a κ the bodies are apart or they touch, for they were apart at all κ above it. They are apart exactly when
 * a facet of their difference separates strictly. So a search among all facets decides where quicker ways do not.
 */
#include "impact/pair_impact.h"

#include <pirouette/pose.h>

#include "impact/planes.h"
#include "pair/pair.h"
#include "query/proof/parting.h"

#define DEGREE 57.29577951308232

typedef struct impact_job {
    pir_impact_search search;
    pir_pair *pair;
    pir_workspace *workspace;
    const pir_exact_motion *motion;
    pir_pair_input input;
    pir_condition plane; /* the last that separated */
} impact_job;

/* --- the bodies in doubles --- */

/* P's pose now. */
static pir_pose pose_of_now(const impact_job *job) {
    const pir_course *course = &job->search.course;
    const double phi = job->search.now.phi, s = cos(phi), t = sin(phi);
    pir_pose pose = course->pose[0];
    if (!course->turns) {
        pose.translation = pir_vec_add(pose.translation, pir_vec_scale(course->way, tan(phi)));
        return pose;
    }
    const pir_vec3 u = course->unit;
    const pir_pose turn = {.rotation = {t * u.x, t * u.y, t * u.z, s}};
    pose.translation = pir_vec_sub(pose.translation, course->pivot);
    pose = pir_pose_compose(turn, pose);
    pose.translation = pir_vec_add(pose.translation, course->pivot);
    if (course->screws)
        pose.translation = pir_vec_add(pose.translation, pir_vec_scale(course->advance, tan(phi)));
    return pose;
}

static pir_status ask_now(impact_job *job, pir_query_result *ret_result) {
    pir_pair_input input = pir_pair_input_default();
    input.pose_p = pose_of_now(job);
    input.pose_q = job->input.pose_q;
    return pir_pair_signed_distance(job->pair, job->workspace, &input, ret_result);
}

/* A plane that separates strictly now, near an answer; false proves nothing. */
static bool plane_near(impact_job *job, const pir_query_result *result, pir_condition *ret_plane) {
    return result->state == PIR_OUTSIDE && pir_candidates_near(&job->search, &result->witness, ret_plane) &&
           pir_parts_strictly(&job->search, ret_plane, PIR_SIGN_NOW);
}

/* --- the search --- */

/* Whether the bodies are apart at the root where the last plane ended; the next plane then is found. */
static bool is_apart(impact_job *job) {
    pir_impact_search *search = &job->search;
    const pir_condition *ended = &search->now.root;
    if (ended->kind != PIR_CROSSING && pir_features_touch(search, ended))
        return false;
    pir_query_result result;
    if (search->status == PIR_OK)
        search->status = ask_now(job, &result);
    if (search->status != PIR_OK)
        return false;
    pir_condition plane;
    bool found = plane_near(job, &result, &plane);
    if (!found && search->status == PIR_OK && !pir_witness_touches(search, &result.witness))
        found = pir_candidates_any(search, PIR_SIGN_NOW, &plane);
    if (found)
        job->plane = plane;
    return found;
}

/* On from a plane that separates. Hit or miss. */
static pir_cast_outcome go_on(impact_job *job) {
    pir_impact_search *search = &job->search;
    while (search->status == PIR_OK) {
        search->planes++;
        const pir_moment next = pir_search_exit(search, &job->plane);
        if (search->status != PIR_OK || next.kind == PIR_MOMENT_END)
            break;
        pir_search_go_to(search, next);
        if (!is_apart(job))
            return PIR_CAST_HIT;
    }
    return PIR_CAST_MISS;
}

/* The outcome for bodies that touch at the start. */
static pir_cast_outcome from_contact(impact_job *job) {
    pir_condition plane;
    if (pir_candidates_any(&job->search, PIR_SIGN_SOON, &plane) || pir_candidates_rest(&job->search))
        return PIR_CAST_RECEDING;
    return PIR_CAST_HIT;
}

/* --- the answer --- */

static pir_witness witness_of(const pir_condition *on) {
    pir_witness witness = {{PIR_FEATURE_EDGE, on->p}, {PIR_FEATURE_EDGE, on->q}};
    if (on->kind == PIR_Q_PLANE || on->kind == PIR_P_PLANE) {
        witness.p.kind = on->kind == PIR_Q_PLANE ? PIR_FEATURE_VERTEX : PIR_FEATURE_FACET;
        witness.q.kind = on->kind == PIR_Q_PLANE ? PIR_FEATURE_FACET : PIR_FEATURE_VERTEX;
    }
    return witness;
}

/* The point of edge q nearest to edge p, both as they are now. */
static pir_vec3 edge_point(const pir_course *course, const pir_condition *on, pir_vec3 e, double phi) {
    const pir_polytope *p = course->body[0], *q = course->body[1];
    const pir_vec3 f = course->edge[1][on->q], b = course->point[1][q->origin[q->edge_half[on->q]]];
    const pir_vec3 a = pir_course_point(course, course->point[0][p->origin[p->edge_half[on->p]]], phi);
    const pir_vec3 d = pir_vec_sub(a, b);
    const double ef = pir_vec_dot(e, f), de = pir_vec_dot(d, e), df = pir_vec_dot(d, f), square = 1 - ef * ef;
    const double along = square > 0 ? (df - ef * de) / square : 0;
    return pir_vec_add(b, pir_vec_scale(f, along));
}

static void tell_contact(const impact_job *job, pir_impact *impact) {
    const pir_course *course = &job->search.course;
    const double phi = job->search.now.phi;
    // of what ended: its slack, or the plane whose edges ceased to cross there
    pir_condition on = job->search.now.root.kind == PIR_CROSSING ? job->plane : job->search.now.root;
    impact->witness = witness_of(&on);
    if (on.kind == PIR_Q_PLANE) {
        impact->normal = course->normal[1][on.q];
        impact->point = pir_course_point(course, course->point[0][on.p], phi);
    } else if (on.kind == PIR_P_PLANE) {
        impact->normal = pir_vec_scale(pir_course_direction(course, course->normal[0][on.p], phi), -1);
        impact->point = course->point[1][on.q];
    } else {
        const pir_vec3 e = pir_course_direction(course, course->edge[0][on.p], phi);
        const pir_vec3 n = pir_vec_cross(e, course->edge[1][on.q]);
        impact->normal = pir_vec_scale(n, on.side / pir_vec_length(n));
        impact->point = edge_point(course, &on, e, phi);
    }
    impact->point = pir_vec_add(impact->point, course->pivot);
}

/* Time and angle, rounded down. */
static void tell_hit(impact_job *job, pir_exact_impact *impact) {
    pir_impact_search *search = &job->search;
    pir_search_refine(search);
    pir_search_kappa(search, impact->kappa);
    const double now = search->now.phi, phi = fmax(0, now - search->now.slack - 0x1p-49 * fmin(1, now));
    const double down = 1 - 0x1p-50;
    if (search->course.turns) {
        impact->degrees = fmin(2 * phi * DEGREE * down, fabs(job->motion->degrees));
        impact->impact.time = fmin(1, impact->degrees / fabs(job->motion->degrees) * down);
    } else {
        impact->impact.time = fmin(1, tan(phi) * down);
    }
    tell_contact(job, &impact->impact);
}

/* Normal, point and witness at the start. */
static pir_status tell_start(impact_job *job, pir_exact_impact *impact) {
    pir_query_result result;
    const pir_status status = ask_now(job, &result);
    if (status == PIR_OK) {
        impact->impact.normal = result.normal;
        impact->impact.point = result.point_q;
        impact->impact.witness = result.witness;
    }
    return status;
}

static pir_status run(impact_job *job, pir_exact_impact *impact) {
    pir_impact_search *search = &job->search;
    pir_query_result result;
    pir_status status = ask_now(job, &result);
    if (status != PIR_OK)
        return status;
    const bool rests = job->motion->degrees == 0 && pir_vec_size(job->motion->way) == 0;
    impact->kappa[0] = impact->kappa[1] = INFINITY;
    if (result.state != PIR_OUTSIDE) {
        const bool inside = result.state == PIR_INSIDE;
        impact->impact.outcome = inside ? PIR_CAST_START_INSIDE : rests ? PIR_CAST_RECEDING : from_contact(job);
        status = search->status != PIR_OK ? search->status : tell_start(job, impact);
    } else if (rests) {
        impact->impact.outcome = PIR_CAST_AT_REST;
    } else if (plane_near(job, &result, &job->plane) || pir_candidates_any(search, PIR_SIGN_NOW, &job->plane)) {
        impact->impact.outcome = go_on(job);
        impact->impact.time = 1;
        if (impact->impact.outcome == PIR_CAST_HIT)
            tell_hit(job, impact);
        else
            impact->degrees = fabs(job->motion->degrees);
        status = search->status;
    } else {
        status = search->status != PIR_OK ? search->status : PIR_ERR_INTERNAL;
    }
    impact->impact.steps = search->planes;
    return status;
}

/* --- the calls --- */

pir_status pir_exact_motion_check(const pir_exact_motion *motion) {
    const bool goes = pir_vec_size(motion->way) > 0;
    const pir_status status = pir_screw_check(motion, goes ? nextafter(180, 0) : 360);
    if (status == PIR_OK && pir_exact_motion_screws(motion) && fabs(motion->degrees) < 0x1p-20)
        return PIR_ERR_LIMIT;
    return status;
}

bool pir_exact_motion_screws(const pir_exact_motion *motion) {
    return motion->degrees != 0 && pir_vec_size(motion->way) > 0;
}

static void set_end(pir_impact_search *search, const pir_exact_motion *motion) {
    pir_course *course = &search->course;
    const bool turns = course->turns;
    search->end.kind = PIR_MOMENT_END;
    search->end.phi = turns ? fabs(motion->degrees) / DEGREE / 2 : atan2(1, 1);
    search->end.slack = 0x1p-49;
    const double length = turns ? pir_vec_length(motion->axis) : 1;
    const double degrees = fabs(motion->degrees);
    course->end_kappa = !turns           ? 1
                        : degrees == 360 ? -INFINITY
                        : degrees == 180 ? 0
                        : degrees == 90  ? length // which the tangent of a double near to an eighth of a turn misses
                                         : length / tan(search->end.phi);
    // a turn so short that its κ is no double has none before its end
    if (course->end_kappa > 0x1.fffffffffffffp1023)
        course->end_kappa = 0x1.fffffffffffffp1023;
}

pir_status pir_pair_impact_run(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                               const pir_exact_motion *motion, pir_exact_impact *ret_impact, mpz_t *ret_coefficients) {
    if (pair == NULL || workspace == NULL || input == NULL || motion == NULL || ret_impact == NULL)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_exact_motion_check(motion);
    if (status != PIR_OK)
        return status;
    const int p = pair->p->dimension, q = pair->q->dimension;
    if (p < 2 || q < 2 || p + q < 5)
        return PIR_ERR_ARGUMENT;
    impact_job job = {.pair = pair, .workspace = workspace, .motion = motion, .input = *input};
    pir_course *course = &job.search.course;
    course->allocator = &pair->allocator;
    course->turns = motion->degrees != 0;
    course->axis = pir_vec_scale(motion->axis, motion->degrees < 0 ? -1 : 1);
    course->pivot = course->turns ? motion->pivot : (pir_vec3){0, 0, 0};
    course->way = motion->way;
    course->screws = pir_exact_motion_screws(motion);
    set_end(&job.search, motion);
    pir_exact_impact impact = {{0}, {0, 0}, 0};
    const pir_polytope *const body[2] = {pair->p, pair->q};
    const pir_pose pose[2] = {input->pose_p, input->pose_q};
    if ((status = pir_course_init(course, body, pose)) != PIR_OK)
        return status;
    pir_search_go_to(&job.search, (pir_moment){.kind = PIR_MOMENT_FIRST});
    status = run(&job, &impact);
    const bool after_start = impact.impact.outcome == PIR_CAST_HIT && job.search.planes > 0;
    if (status == PIR_OK && ret_coefficients != NULL) {
        for (int k = 0; k < (course->screws ? 4 : 3); k++)
            mpz_set_ui(ret_coefficients[k], 0);
        if (after_start)
            status = pir_course_polynomial(course, &job.search.now.root, ret_coefficients);
    }
    pir_course_finish(course);
    if (status == PIR_OK)
        *ret_impact = impact;
    return status;
}

pir_status pir_pair_impact(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                           const pir_exact_motion *motion, pir_exact_impact *ret_impact) {
    return pir_pair_impact_run(pair, workspace, input, motion, ret_impact, NULL);
}
