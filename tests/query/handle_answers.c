/* SPDX-License-Identifier: MIT */
/* Whether two queries answer alike, to the bit: see handle_objects.h. */
#include "query/handle_objects.h"

#include <math.h>

#include "support/answers.h"
#include "support/queries.h"

/* Whether two numbers have the same bits, or both are no number, because the exact one is beyond the doubles. */
static bool same_number(double a, double b) {
    return a == b || (isnan(a) && isnan(b));
}

static bool same_vector(pir_vec3 a, pir_vec3 b) {
    return same_number(a.x, b.x) && same_number(a.y, b.y) && same_number(a.z, b.z);
}

static bool same_result(const pir_query_result *a, const pir_query_result *b) {
    return a->state == b->state && a->outcome == b->outcome && same_number(a->distance, b->distance) &&
           test_same_witness(&a->witness, &b->witness) && same_vector(a->normal, b->normal) &&
           same_vector(a->point_p, b->point_p) && same_vector(a->point_q, b->point_q);
}

static bool same_cast(const pir_impact *a, const pir_impact *b) {
    return a->outcome == b->outcome && a->time == b->time && same_vector(a->normal, b->normal) &&
           same_vector(a->point, b->point) && test_same_witness(&a->witness, &b->witness);
}

static bool same_escapes(const test_answer *a, const test_answer *b) {
    if (a->count != b->count)
        return false;
    for (size_t i = 0; i < a->count && i < sizeof a->escapes / sizeof *a->escapes; i++)
        if (!same_number(a->escapes[i].depth, b->escapes[i].depth) ||
            !same_vector(a->escapes[i].normal, b->escapes[i].normal) ||
            !test_same_witness(&a->escapes[i].witness, &b->escapes[i].witness))
            return false;
    return true;
}

static bool same_wrench(const pir_wrench *a, const pir_wrench *b) {
    return same_vector(a->force, b->force) && same_vector(a->torque, b->torque);
}

static bool same_derivatives(const test_answer *a, const test_answer *b) {
    if (!same_wrench(&a->gradient.p, &b->gradient.p) || !same_wrench(&a->gradient.q, &b->gradient.q))
        return false;
    for (int i = 0; i < 144; i++)
        if (!same_number(a->curvature.hessian[i / 12][i % 12], b->curvature.hessian[i / 12][i % 12]))
            return false;
    for (size_t i = 0; i < a->count && i < sizeof a->active / sizeof *a->active; i++)
        if (!same_wrench(&a->active[i].p, &b->active[i].p) || a->active[i].facet != b->active[i].facet)
            return false;
    return true;
}

void handle_compare_answers(struct program *program, pir_query *one, pir_query *other, const pir_query_input *input,
                            pir_vec3 along) {
    for (const test_query_kind *kind = test_query_kinds; kind->name; kind++) {
        test_answer a = {0}, b = {0};
        const pir_status status = kind->ask(&(test_question){one, input, NULL, along}, &a);
        need(program, status == kind->ask(&(test_question){other, input, NULL, along}, &b), "both queries end alike");
        need(program,
             status != PIR_OK || (same_result(&a.result, &b.result) && same_cast(&a.cast, &b.cast) &&
                                  same_escapes(&a, &b) && same_derivatives(&a, &b)),
             "both queries answer alike");
    }
}

void handle_compare_batches(struct program *program, pir_query *one, pir_query *other, const pir_query_input *input) {
    const pir_vec3 at[2] = {input->translation, {0, 0, 0}};
    double a[2] = {0, 0}, b[2] = {0, 0};
    pir_state s[2] = {PIR_OUTSIDE, PIR_OUTSIDE}, t[2] = {PIR_OUTSIDE, PIR_OUTSIDE};
    pir_status status = pir_query_batch_distances(one, at, 2, a, s);
    need(program, status == pir_query_batch_distances(other, at, 2, b, t), "both batches end alike");
    need(program,
         status != PIR_OK || (same_number(a[0], b[0]) && same_number(a[1], b[1]) && s[0] == t[0] && s[1] == t[1]),
         "both batches answer alike");
}

void handle_compare_advances(struct program *program, struct query *query, pir_query *other, pir_vec3 from,
                             pir_vec3 along) {
    const pir_motion motion = {.way = along};
    pir_query_input input = pir_query_input_default();
    input.translation = from;
    pir_impact a = {0}, b = {0};
    pir_status status = pir_query_time_of_impact(query->handle, &input, &motion, 0x1p-6, &a);
    need(program, status == pir_query_time_of_impact(other, &input, &motion, 0x1p-6, &b), "both advances end alike");
    need(program, status != PIR_OK || same_cast(&a, &b), "both advances answer alike");
}
