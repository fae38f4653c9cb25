/* SPDX-License-Identifier: MIT */
/* Whether two queries answer alike, to the bit: see handle_objects.h. */
#include "query/handle_objects.h"

#include <math.h>

/* Whether two numbers have the same bits, or both are no number, because the exact one is beyond the doubles. */
static bool same_number(double a, double b) {
    return a == b || (isnan(a) && isnan(b));
}

static bool same_vector(pir_vec3 a, pir_vec3 b) {
    return same_number(a.x, b.x) && same_number(a.y, b.y) && same_number(a.z, b.z);
}

static bool same_witness(const pir_witness *a, const pir_witness *b) {
    return a->p.kind == b->p.kind && a->p.index == b->p.index && a->q.kind == b->q.kind && a->q.index == b->q.index;
}

static bool same_result(const pir_query_result *a, const pir_query_result *b) {
    return a->state == b->state && a->outcome == b->outcome && same_number(a->distance, b->distance) &&
           same_witness(&a->witness, &b->witness) && same_vector(a->normal, b->normal) &&
           same_vector(a->point_p, b->point_p) && same_vector(a->point_q, b->point_q);
}

static bool same_cast(const pir_cast_result *a, const pir_cast_result *b) {
    return a->outcome == b->outcome && a->time == b->time && same_vector(a->normal, b->normal) &&
           same_vector(a->point, b->point) && same_witness(&a->witness, &b->witness);
}

typedef pir_status (*ask_fn)(pir_query *, const pir_query_input *, pir_query_cache *, pir_query_result *);

void handle_compare_answers(struct program *program, pir_query *one, pir_query *other, const pir_query_input *input,
                            pir_vec3 along) {
    static const ask_fn asks[] = {pir_query_overlap, pir_query_distance, pir_query_penetration,
                                  pir_query_signed_distance};
    for (int i = 0; i < 4; i++) {
        pir_query_result a = {0}, b = {0};
        pir_status status = asks[i](one, input, NULL, &a);
        need(program, status == asks[i](other, input, NULL, &b), "both queries end alike");
        need(program, status != PIR_OK || same_result(&a, &b), "both queries answer alike");
    }
    pir_query_result a = {0}, b = {0};
    pir_cast_result c = {0}, d = {0};
    pir_status status = pir_query_directional_depth(one, input, along, &a);
    need(program, status == pir_query_directional_depth(other, input, along, &b), "both directions end alike");
    need(program, status != PIR_OK || same_result(&a, &b), "both directions answer alike");
    status = pir_query_cast(one, input, along, &c);
    need(program, status == pir_query_cast(other, input, along, &d), "both casts end alike");
    need(program, status != PIR_OK || same_cast(&c, &d), "both casts answer alike");
    status = pir_query_largest_distance(one, input, &a);
    need(program, status == pir_query_largest_distance(other, input, &b), "both largest distances end alike");
    need(program, status != PIR_OK || same_result(&a, &b), "both largest distances are alike");
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
    const pir_motion motion = {query->subject->rotation, from, along, {0, 0, 1}, 0};
    pir_cast_result a = {0}, b = {0};
    pir_status status = pir_query_advance(query->handle, &motion, 0x1p-6, &a);
    need(program, status == pir_query_advance(other, &motion, 0x1p-6, &b), "both advances end alike");
    need(program, status != PIR_OK || same_cast(&a, &b), "both advances answer alike");
}
