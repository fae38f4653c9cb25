/* SPDX-License-Identifier: MIT */
/*
 * Certificates of answers and of sums. Whether the bodies are apart, and how far, is decided by a nearest point in
 * integers. Where that is the origin, the facets of the difference tell a touch from an overlap, and the depth.
 */
#include <pirouette/certificate.h>

#include <math.h>

#include "base/vec.h"
#include "certificate/certificate_text.h"
#include "dymsum/view.h"
#include "query/answer/follow.h"

/* A job: an answer at a placement. */
struct job {
    pir_stance bodies;
    pir_boundary boundary; /* where the bodies share a point */
    pir_mix mix;
    pir_triple normal; /* of a plane */
    mpz_t slack;       /* the least */
    uint32_t least;    /* which facet has it */
    const pir_query_result *answer;
    bool number;
    pir_proof_text text;
};

/* Whether √(num / den) is the number of the answer. */
static bool is_number(const struct job *job, const mpz_t num, const mpz_t den) {
    return job->answer->outcome == PIR_BEYOND_CUTOFF ||
           pir_stance_is_length(&job->bodies, job->answer->distance, num, den);
}

/* --- the bodies apart --- */

/* The normal of the answer as integers: any direction to start from. */
static void start_of(const pir_query_result *answer, pir_triple *start) {
    const double n[3] = {answer->normal.x, answer->normal.y, answer->normal.z};
    for (int k = 0; k < 3; k++)
        mpz_set_d(start->c[k], isfinite(n[k]) && fabs(n[k]) <= 1 ? -n[k] * 0x1p53 : 1);
}

/* A plane between the bodies: along the answer's normal where that parts them, else along the nearest point. */
static void write_plane(struct job *job) {
    mpz_t low, high, square, gap;
    mpz_inits(low, high, square, gap, NULL);
    start_of(job->answer, &job->normal);
    for (int turn = 0; turn < 2; turn++) {
        for (int k = 0; k < 3; k++)
            if (turn == 1)
                mpz_neg(job->normal.c[k], job->mix.point.c[k]);
            else
                mpz_neg(job->normal.c[k], job->normal.c[k]);
        pir_stood_range(&job->bodies.p, &job->normal, high, NULL);
        pir_stood_range(&job->bodies.q, &job->normal, NULL, low);
        if (mpz_cmp(low, high) < 0)
            break;
    }
    pir_triple_dot(square, &job->normal, &job->normal);
    mpz_sub(gap, high, low);
    mpz_mul(gap, gap, gap);
    mpz_mul(square, square, job->bodies.unit);
    mpz_mul(square, square, job->bodies.unit);
    // the plane's other side: P lowest, Q farthest along the normal
    pir_triple_negate(&job->normal);
    pir_stance_list(&job->bodies, pir_stance_lowest(&job->bodies, &job->normal));
    pir_triple_negate(&job->normal);
    pir_proof_text_begin(&job->text, "apart", &job->bodies);
    pir_proof_text_triple(&job->text, "normal", &job->normal);
    pir_proof_text_integer(&job->text, "low", low);
    pir_proof_text_integer(&job->text, "high", high);
    pir_proof_text_ratio(&job->text, "gap_squared", gap, square);
    mpz_clears(low, high, square, gap, NULL);
}

static void list_mix(struct job *job) {
    for (int k = 0; k < job->mix.count; k++)
        pir_stance_list(&job->bodies, job->mix.corner[k]);
}

static pir_status write_distance(struct job *job) {
    mpz_t num, den;
    mpz_inits(num, den, NULL);
    pir_triple_dot(num, &job->mix.point, &job->mix.point);
    mpz_mul(den, job->mix.whole, job->bodies.unit);
    mpz_mul(den, den, den);
    bool right = is_number(job, num, den);
    list_mix(job);
    pir_proof_text_begin(&job->text, "distance", &job->bodies);
    pir_proof_text_mix(&job->text, &job->bodies, &job->mix);
    pir_proof_text_mix_point(&job->text, "point_p", &job->bodies, &job->mix, false);
    pir_proof_text_mix_point(&job->text, "point_q", &job->bodies, &job->mix, true);
    pir_proof_text_ratio(&job->text, "distance_squared", num, den);
    mpz_clears(num, den, NULL);
    return right ? PIR_OK : PIR_ERR_ARGUMENT;
}

/* --- the bodies sharing a point --- */

/* A direction that a difference without an area does not extend in. */
static void normal_of_line(struct job *job) {
    pir_triple way, axis;
    mpz_t square;
    pir_triple_init(&way);
    pir_triple_init(&axis);
    mpz_init(square);
    uint32_t vertices = pir_mesh_vertex_count(job->boundary.mesh);
    pir_stance_vertex(&job->bodies, pir_boundary_corner(&job->boundary, 0), &axis);
    pir_stance_vertex(&job->bodies, pir_boundary_corner(&job->boundary, vertices - 1), &way);
    pir_triple_subtract(&way, &way, &axis);
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 3; i++)
            mpz_set_ui(axis.c[i], i == k);
        pir_triple_cross(&job->normal, &way, &axis);
        pir_triple_dot(square, &job->normal, &job->normal);
        if (mpz_sgn(square) != 0)
            break;
    }
    if (mpz_sgn(square) == 0)
        mpz_set_ui(job->normal.c[0], 1);
    pir_triple_finish(&way);
    pir_triple_finish(&axis);
    mpz_clear(square);
}

/* The normal points from Q to P: out of the difference at the origin, seen from the other side. */
static void write_touching(struct job *job) {
    mpz_t at, square;
    mpz_inits(at, square, NULL);
    pir_stood_range(&job->bodies.p, &job->normal, at, NULL);
    pir_triple_dot(square, &job->normal, &job->normal);
    list_mix(job);
    pir_proof_text_begin(&job->text, "touching", &job->bodies);
    pir_proof_text_mix(&job->text, &job->bodies, &job->mix);
    pir_proof_text_mix_point(&job->text, "point", &job->bodies, &job->mix, false);
    pir_proof_text_triple(&job->text, "normal", &job->normal);
    pir_proof_text_integer(&job->text, "at", at);
    pir_proof_text_integer(&job->text, "length_squared", square);
    mpz_clears(at, square, NULL);
}

static void write_overlap(struct job *job) {
    pir_boundary_around(&job->boundary, &job->mix);
    list_mix(job);
    pir_proof_text_begin(&job->text, "overlap", &job->bodies);
    pir_proof_text_mix(&job->text, &job->bodies, &job->mix);
    pir_proof_text_mix_point(&job->text, "point", &job->bodies, &job->mix, false);
}

static pir_status write_depth(struct job *job) {
    mpz_t num, den;
    mpz_inits(num, den, NULL);
    mpz_mul(num, job->slack, job->slack);
    pir_triple_dot(den, &job->normal, &job->normal);
    mpz_mul(den, den, job->bodies.unit);
    mpz_mul(den, den, job->bodies.unit);
    bool right = is_number(job, num, den);
    pir_boundary_list(&job->boundary, &job->bodies);
    pir_proof_text_begin(&job->text, "depth", &job->bodies);
    pir_proof_text_boundary(&job->text, &job->boundary);
    pir_proof_text_count(&job->text, "facet", job->least);
    pir_proof_text_ratio(&job->text, "depth_squared", num, den);
    mpz_clears(num, den, NULL);
    return right ? PIR_OK : PIR_ERR_ARGUMENT;
}

static pir_status write_meeting(struct job *job, pir_sum *sum) {
    pir_status status = pir_boundary_make(&job->boundary, &job->bodies, sum);
    if (status != PIR_OK)
        return status;
    uint32_t facets = pir_mesh_facet_count(job->boundary.mesh);
    if (facets > 0)
        job->least = pir_boundary_least(&job->boundary, job->slack, &job->normal);
    else
        normal_of_line(job);
    bool inside = facets > 2 && mpz_sgn(job->slack) > 0;
    if (job->answer->state != (inside ? PIR_INSIDE : PIR_BOUNDARY))
        status = PIR_ERR_ARGUMENT;
    else if (!inside)
        write_touching(job);
    else if (job->number)
        status = write_depth(job);
    else
        write_overlap(job);
    pir_boundary_finish(&job->boundary);
    return status;
}

/* --- the calls --- */

static pir_status write_answer(struct job *job, pir_sum *sum) {
    start_of(job->answer, &job->normal);
    pir_nearest_pairs(&job->bodies, &job->normal, &job->mix);
    bool meet = true;
    for (int k = 0; k < 3; k++)
        meet = meet && mpz_sgn(job->mix.point.c[k]) == 0;
    if (meet)
        return write_meeting(job, sum);
    if (job->answer->state != PIR_OUTSIDE)
        return PIR_ERR_ARGUMENT;
    if (job->number)
        return write_distance(job);
    write_plane(job);
    return PIR_OK;
}

/* Whether the pairing is that of the rotation, and of all directions. */
static pir_status check_sum(const pir_sum *sum) {
    pir_quat a = pir_sum_rotation(sum), b = pir_sum_pairing_rotation(sum);
    if (pir_sum_cone(sum)->set)
        return PIR_ERR_REGION;
    return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w ? PIR_OK : PIR_ERR_ARGUMENT;
}

pir_status pir_query_certificate(pir_query *query, const pir_query_input *input, const pir_query_result *answer,
                                 pir_proven proven, pir_certificate **ret_certificate) {
    if (!query || !input || !answer || !ret_certificate || (proven != PIR_PROVEN_STATE && proven != PIR_PROVEN_NUMBER))
        return PIR_ERR_ARGUMENT;
    if (!pir_vec_is_finite(input->translation))
        return PIR_ERR_NOT_FINITE;
    pir_status status = check_sum(query->sum);
    if (status == PIR_OK && (input->radius_p != 0 || input->radius_q != 0))
        status = PIR_ERR_ARGUMENT;
    struct job job = {.answer = answer, .number = proven == PIR_PROVEN_NUMBER, .text = {query->allocator, {0}, false}};
    if (status == PIR_OK)
        status = pir_stance_make(&job.bodies, &query->allocator, query->sum, true, input->translation);
    if (status != PIR_OK)
        return status;
    pir_mix_init(&job.mix);
    pir_triple_init(&job.normal);
    mpz_init(job.slack);
    status = write_answer(&job, query->sum);
    status = pir_proof_text_end(&job.text, status, ret_certificate);
    mpz_clear(job.slack);
    pir_triple_finish(&job.normal);
    pir_mix_finish(&job.mix);
    pir_stance_finish(&job.bodies);
    return status;
}

/* Writes all facets of the sum of these bodies. */
static pir_status write_sum(pir_proof_text *text, pir_stance *bodies, pir_sum *sum) {
    pir_boundary boundary;
    pir_status status = pir_boundary_make(&boundary, bodies, sum);
    if (status != PIR_OK)
        return status;
    const uint32_t counts[3] = {pir_mesh_vertex_count(boundary.mesh), pir_mesh_edge_count(boundary.mesh),
                                pir_mesh_facet_count(boundary.mesh)};
    if (counts[2] < 2)
        status = PIR_ERR_ARGUMENT;
    pir_boundary_list(&boundary, bodies);
    pir_proof_text_begin(text, bodies->difference ? "difference" : "sum", bodies);
    pir_proof_text_boundary(text, &boundary);
    pir_proof_text_count(text, "vertex_count", counts[0]);
    pir_proof_text_count(text, "edge_count", counts[1]);
    pir_proof_text_count(text, "facet_count", counts[2]);
    pir_boundary_finish(&boundary);
    return status;
}

pir_status pir_sum_certificate(pir_sum *sum, pir_certificate **ret_certificate) {
    if (!sum || !ret_certificate)
        return PIR_ERR_ARGUMENT;
    const pir_pairing *pairing = pir_sum_pairing(sum);
    pir_proof_text text = {pairing->allocator, {0}, false};
    pir_stance bodies;
    pir_status status = check_sum(sum);
    if (status == PIR_OK)
        status = pir_stance_make(&bodies, &pairing->allocator, sum, pairing->difference, (pir_vec3){0, 0, 0});
    if (status != PIR_OK)
        return status;
    status = pir_proof_text_end(&text, write_sum(&text, &bodies, sum), ret_certificate);
    pir_stance_finish(&bodies);
    return status;
}
