/* SPDX-License-Identifier: MIT */
/*
 * Which points of two bodies meet: see exact_checks.h.
 *
 * A contact is a point x of the difference, so that every pair of points a of P and b of Q with b − a = x meets
 * there. A face of P and a face of Q hold such a pair exactly when x lies in the difference of the two faces.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "query/exact_checks.h"
#include "query/exact_report.h"

/* Whether x, the oracle's point, lies in the difference of parts of both bodies. NULL for the whole of a body. */
static int meet(exact_pair *pair, const oracle_set *p, const oracle_set *q) {
    return !oracle_place_is_apart(pair->place, p, q);
}

/* Advances from one feature of a body to the next: vertices, edges, facets, in order. */
static int next_feature(const exact_body *body, pir_feature *feature) {
    const uint32_t counts[4] = {0, body->solid->count, body->edges, body->facets};
    feature->index++;
    while (feature->kind <= PIR_FEATURE_FACET && feature->index >= counts[feature->kind]) {
        feature->kind++;
        feature->index = 0;
    }
    return feature->kind <= PIR_FEATURE_FACET;
}

/* The first of the least faces of one body that meets a part of the other. */
static pir_feature least_face(exact_pair *pair, pir_operand operand, const oracle_set *other) {
    const exact_body *body = &pair->body[operand];
    oracle_set *set = oracle_new(body->solid->words, sizeof *set);
    pir_feature face = {PIR_FEATURE_VERTEX, 0};
    int found = 0;
    do {
        exact_feature_set(body, face, set);
        found = operand == PIR_OPERAND_P ? meet(pair, set, other) : meet(pair, other, set);
    } while (!found && next_feature(body, &face));
    free(set);
    return found ? face : (pir_feature){PIR_FEATURE_NONE, 0};
}

/* The lowest vertex of one body that meets the other, and the least face of the other there. 0 when none meets it. */
static int vertex_meets(exact_pair *pair, pir_operand operand, pir_witness *ret_witness) {
    const exact_body *body = &pair->body[operand];
    pir_feature *own = operand == PIR_OPERAND_P ? &ret_witness->p : &ret_witness->q;
    pir_feature *other = operand == PIR_OPERAND_P ? &ret_witness->q : &ret_witness->p;
    oracle_set *set = oracle_new(body->solid->words, sizeof *set);
    int found = 0;
    for (uint32_t v = 0; v < body->solid->count && !found; v++) {
        *own = (pir_feature){PIR_FEATURE_VERTEX, v};
        exact_feature_set(body, *own, set);
        found = operand == PIR_OPERAND_P ? meet(pair, set, NULL) : meet(pair, NULL, set);
    }
    if (found)
        *other = least_face(pair, operand == PIR_OPERAND_P ? PIR_OPERAND_Q : PIR_OPERAND_P, set);
    free(set);
    return found;
}

/* The first two edges that meet. */
static int edges_meet(exact_pair *pair, pir_witness *ret_witness) {
    const exact_body *p = &pair->body[PIR_OPERAND_P], *q = &pair->body[PIR_OPERAND_Q];
    for (uint32_t e = 0; e < p->edges; e++) {
        if (!meet(pair, &p->edge[e * p->solid->words], NULL))
            continue;
        for (uint32_t f = 0; f < q->edges; f++)
            if (meet(pair, &p->edge[e * p->solid->words], &q->edge[f * q->solid->words])) {
                *ret_witness = (pir_witness){{PIR_FEATURE_EDGE, e}, {PIR_FEATURE_EDGE, f}};
                return 1;
            }
    }
    return 0;
}

/* The witness that the rule asks for at the contact. */
static pir_witness right_witness(exact_pair *pair, const exact_contact *contact) {
    oracle_place *o = pair->place;
    pir_witness witness = {{PIR_FEATURE_NONE, 0}, {PIR_FEATURE_NONE, 0}};
    oracle_place_set(o, contact->t, contact->direction);
    if (contact->way == EXACT_NEAREST)
        oracle_place_to_nearest(o);
    else if (contact->way == EXACT_TO_PLANE)
        oracle_place_to_plane(o, contact->plane);
    else
        oracle_place_along_to_plane(o, contact->plane);
    if (!vertex_meets(pair, PIR_OPERAND_Q, &witness) && !vertex_meets(pair, PIR_OPERAND_P, &witness))
        edges_meet(pair, &witness);
    return witness;
}

double exact_distance_from(exact_pair *pair, pir_operand operand, const oracle_set *part, pir_vec3 point,
                           pir_vec3 translation, double tolerance) {
    oracle_place *o = pair->place;
    const oracle_set *p = operand == PIR_OPERAND_P ? part : o->only_p, *q = operand == PIR_OPERAND_P ? o->only_q : part;
    oracle_place_set_point(o, operand, point, translation);
    double away = oracle_place_near(o, p, q);
    // what doubles leave open
    return away <= 0.5 * tolerance ? away : oracle_place_nearest(o, p, q).distance;
}

void exact_check_holds(exact_pair *pair, pir_operand operand, pir_feature feature, pir_vec3 point, pir_vec3 translation,
                       double tolerance) {
    const exact_body *body = &pair->body[operand];
    oracle_set *set = oracle_new(body->solid->words, sizeof *set);
    double away = HUGE_VAL;
    if (exact_feature_set(body, feature, set))
        away = exact_distance_from(pair, operand, set, point, translation, tolerance);
    exact_check(EXACT_HOLDS, away <= tolerance,
                "point (%.17g, %.17g, %.17g) is %.3g of the size, %.3g of the tolerance off feature %d %u of %s",
                point.x, point.y, point.z, away / pair->size, away / tolerance, (int)feature.kind, feature.index,
                operand == PIR_OPERAND_P ? "P" : "Q");
    free(set);
}

void exact_check_witness(exact_pair *pair, const exact_contact *contact, const pir_witness *witness, pir_vec3 point_p,
                         pir_vec3 point_q, double tolerance) {
    pir_witness right = right_witness(pair, contact);
    exact_check(EXACT_WITNESS,
                exact_same_feature(&pair->body[0], right.p, witness->p) &&
                    exact_same_feature(&pair->body[1], right.q, witness->q),
                "witness %d %u, %d %u, not %d %u, %d %u", (int)witness->p.kind, witness->p.index, (int)witness->q.kind,
                witness->q.index, (int)right.p.kind, right.p.index, (int)right.q.kind, right.q.index);
    exact_check_holds(pair, PIR_OPERAND_P, witness->p, point_p, contact->there, tolerance);
    exact_check_holds(pair, PIR_OPERAND_Q, witness->q, point_q, contact->there, tolerance);
    oracle_place_set(pair->place, contact->t, contact->direction);
}
