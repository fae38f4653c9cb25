/* SPDX-License-Identifier: MIT */
/*
 * Certificates of answers about two bodies in pieces. Every pair of pieces is looked at: its nearest points in integers
 * and, where the pieces share a point, the facets of their difference tell a touch from an overlap. So each pair has a
 * plane that parts it. What is written is a shorter normal where one proves as much.
 */
#include <pirouette/certificate.h>

#include <math.h>

#include "base/vec.h"
#include "certificate/certificate_text.h"
#include "solid/query/solid_query.h"

struct solid_proof {
    pir_solid_query *query;
    pir_stance_body body[2];
    pir_stance bodies; /* all pieces */
    pir_state state;   /* of the pairs so far */
    pir_mix least;     /* of the first nearest pair so far, or of a point that the first one to share one shares */
    pir_vertex_pair nearest;
    pir_part_plane *plane; /* of each pair so far */
    size_t count, room;
    bool number;
    pir_proof_text text;
};

/* Two pieces as bodies of their own; borrowed, not to be finished. */
static pir_stance pieces_of(const struct solid_proof *proof, pir_vertex_pair part) {
    const pir_compound *p = &proof->query->p, *q = &proof->query->q;
    const uint32_t from_p = p->vertex_start[part.p], from_q = q->vertex_start[part.q];
    pir_stance pieces = proof->bodies;
    pieces.p = (pir_stood){pieces.p.at + from_p, pieces.p.listed + from_p, p->vertex_start[part.p + 1] - from_p};
    pieces.q = (pir_stood){pieces.q.at + from_q, pieces.q.listed + from_q, q->vertex_start[part.q + 1] - from_q};
    return pieces;
}

/* --- looking at all pairs --- */

/* Whether a mix is nearer to the origin than the least. */
static bool is_nearer(const pir_mix *mix, const pir_mix *least) {
    mpz_t here, best;
    mpz_inits(here, best, NULL);
    pir_triple_dot(here, &mix->point, &mix->point);
    pir_triple_dot(best, &least->point, &least->point);
    for (int k = 0; k < 2; k++) {
        mpz_mul(here, here, least->whole);
        mpz_mul(best, best, mix->whole);
    }
    const bool nearer = mpz_cmp(here, best) < 0;
    mpz_clears(here, best, NULL);
    return nearer;
}

/* Tells whether pieces that share a point touch or overlap: by the plane of least slack, or a point of both insides. */
static pir_status look_at_meeting(struct solid_proof *proof, const pir_stance *pieces, pir_part_plane *plane,
                                  pir_mix *mix) {
    const pir_solid_query *query = proof->query;
    pir_sum_options options = pir_sum_options_default();
    options.allocator = &query->allocator;
    options.difference = true;
    pir_boundary boundary = {0};
    pir_sum *sum = NULL;
    mpz_t slack;
    mpz_init(slack);
    pir_status status = pir_sum_create(query->p.piece[plane->part.p], query->q.piece[plane->part.q],
                                       proof->bodies.rotation, &options, &sum);
    if (status == PIR_OK)
        status = pir_boundary_make(&boundary, pieces, sum);
    if (status == PIR_OK) {
        pir_boundary_least(&boundary, slack, &plane->normal);
        proof->state = mpz_sgn(slack) > 0 ? PIR_INSIDE : PIR_BOUNDARY;
        if (proof->state == PIR_INSIDE)
            pir_boundary_around(&boundary, mix);
    }
    pir_boundary_finish(&boundary);
    pir_sum_destroy(sum);
    mpz_clear(slack);
    return status;
}

static pir_status look_at_pair(struct solid_proof *proof, pir_vertex_pair part, pir_mix *mix) {
    pir_stance pieces = pieces_of(proof, part);
    pir_part_plane *plane = &proof->plane[proof->count++];
    plane->part = part;
    pir_triple_init(&plane->normal);
    pir_stance_vertex(&pieces, (pir_vertex_pair){0, 0}, &plane->normal);
    pir_nearest_pairs(&pieces, &plane->normal, mix);
    for (int k = 0; k < 3; k++)
        mpz_neg(plane->normal.c[k], mix->point.c[k]);
    pir_triple_strip(&plane->normal);
    pir_status status = PIR_OK;
    bool meet = true;
    for (int k = 0; k < 3; k++)
        meet = meet && mpz_sgn(mix->point.c[k]) == 0;
    if (meet)
        status = look_at_meeting(proof, &pieces, plane, mix);
    if (status == PIR_OK && (proof->count == 1 || proof->state == PIR_INSIDE || is_nearer(mix, &proof->least))) {
        const pir_mix other = proof->least;
        proof->least = *mix;
        *mix = other;
        proof->nearest = part;
    }
    return status;
}

/* Looks at all pairs, or at those before the first one that overlaps. */
static pir_status look_at_all(struct solid_proof *proof) {
    pir_mix mix;
    pir_status status = PIR_OK;
    pir_mix_init(&mix);
    for (uint32_t i = 0; i < proof->body[0].count; i++)
        for (uint32_t k = 0; k < proof->body[1].count && status == PIR_OK && proof->state != PIR_INSIDE; k++)
            status = look_at_pair(proof, (pir_vertex_pair){i, k}, &mix);
    pir_mix_finish(&mix);
    return status;
}

/* --- short normals --- */

/* Whether a plane parts two pieces, by the least distance where that is to be proven. */
static bool is_parting(const struct solid_proof *proof, const pir_stance *pieces, const pir_triple *normal) {
    mpz_t gap, low, square;
    mpz_inits(gap, low, square, NULL);
    pir_stood_range(&pieces->p, normal, gap, NULL);
    pir_stood_range(&pieces->q, normal, NULL, low);
    mpz_sub(gap, gap, low);
    bool parts = mpz_sgn(gap) > 0;
    if (parts && proof->number && proof->state == PIR_OUTSIDE) {
        // (gap / |normal|)² against (|point| / whole)²
        mpz_mul(gap, gap, proof->least.whole);
        mpz_mul(gap, gap, gap);
        pir_triple_dot(square, normal, normal);
        pir_triple_dot(low, &proof->least.point, &proof->least.point);
        mpz_mul(square, square, low);
        parts = mpz_cmp(gap, square) >= 0;
    }
    mpz_clears(gap, low, square, NULL);
    return parts;
}

/* Rounds a plane's normal to as few bits as still part its pieces. */
static void shorten(const struct solid_proof *proof, pir_part_plane *plane) {
    static const size_t lengths[] = {2, 5, 10, 20, 40};
    const pir_stance pieces = pieces_of(proof, plane->part);
    size_t bits = 0;
    for (int k = 0; k < 3; k++) {
        const size_t size = mpz_sizeinbase(plane->normal.c[k], 2);
        bits = size > bits ? size : bits;
    }
    pir_triple rounded;
    pir_triple_init(&rounded);
    bool done = false;
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths && lengths[i] < bits && !done; i++) {
        const mp_bitcnt_t shift = bits - lengths[i];
        for (int k = 0; k < 3; k++) {
            mpz_fdiv_q_2exp(rounded.c[k], plane->normal.c[k], shift - 1);
            mpz_add_ui(rounded.c[k], rounded.c[k], 1);
            mpz_fdiv_q_2exp(rounded.c[k], rounded.c[k], 1);
        }
        pir_triple_strip(&rounded);
        done = is_parting(proof, &pieces, &rounded);
    }
    for (int k = 0; k < 3 && done; k++)
        mpz_swap(plane->normal.c[k], rounded.c[k]);
    pir_triple_finish(&rounded);
}

/* --- writing --- */

static void write_planes(struct solid_proof *proof) {
    for (size_t i = 0; i < proof->count; i++)
        shorten(proof, &proof->plane[i]);
    pir_proof_text_planes(&proof->text, proof->plane, proof->count);
}

/* The pair of pieces that has the point, or the distance, and its corners. */
static pir_stance write_nearest(struct solid_proof *proof) {
    const pir_stance pieces = pieces_of(proof, proof->nearest);
    for (int k = 0; k < proof->least.count; k++) {
        const pir_vertex_pair corner = proof->least.corner[k];
        pieces.p.listed[corner.p] = corner.p;
        pieces.q.listed[corner.q] = corner.q;
    }
    pir_proof_text_parts(&proof->text, proof->nearest);
    pir_proof_text_mix(&proof->text, &pieces, &proof->least);
    return pieces;
}

static void write_common(struct solid_proof *proof) {
    const bool is_inside = proof->state == PIR_INSIDE;
    pir_proof_text_begin_solids(&proof->text, is_inside ? "overlap" : "touching", &proof->bodies, proof->body);
    if (!is_inside)
        write_planes(proof);
    const pir_stance pieces = write_nearest(proof);
    pir_proof_text_mix_point(&proof->text, "point", &pieces, &proof->least, false);
}

static pir_status write_distance(struct solid_proof *proof, const pir_query_result *result) {
    mpz_t num, den;
    mpz_inits(num, den, NULL);
    pir_triple_dot(num, &proof->least.point, &proof->least.point);
    mpz_mul(den, proof->least.whole, proof->bodies.unit);
    mpz_mul(den, den, den);
    const bool right =
        result->outcome == PIR_BEYOND_CUTOFF || pir_stance_is_length(&proof->bodies, result->distance, num, den);
    pir_proof_text_begin_solids(&proof->text, "distance", &proof->bodies, proof->body);
    write_planes(proof);
    const pir_stance pieces = write_nearest(proof);
    pir_proof_text_mix_point(&proof->text, "point_p", &pieces, &proof->least, false);
    pir_proof_text_mix_point(&proof->text, "point_q", &pieces, &proof->least, true);
    pir_proof_text_ratio(&proof->text, "distance_squared", num, den);
    mpz_clears(num, den, NULL);
    return right ? PIR_OK : PIR_ERR_ARGUMENT;
}

static pir_status write_proof(struct solid_proof *proof, const pir_query_result *result) {
    if (proof->state != result->state)
        return PIR_ERR_ARGUMENT;
    if (proof->state != PIR_OUTSIDE) {
        write_common(proof);
    } else if (proof->number) {
        return write_distance(proof, result);
    } else {
        pir_proof_text_begin_solids(&proof->text, "apart", &proof->bodies, proof->body);
        write_planes(proof);
    }
    return PIR_OK;
}

/* --- the call --- */

static pir_status prove(struct solid_proof *proof, const pir_query_result *result, pir_certificate **ret_certificate) {
    const pir_allocator *a = &proof->query->allocator;
    proof->room = (size_t)proof->body[0].count * proof->body[1].count;
    proof->plane = PIR_NEW(a, pir_part_plane, proof->room);
    if (!proof->plane)
        return PIR_ERR_MEMORY;
    pir_mix_init(&proof->least);
    pir_status status = look_at_all(proof);
    if (status == PIR_OK)
        status = write_proof(proof, result);
    status = pir_proof_text_end(&proof->text, status, ret_certificate);
    pir_mix_finish(&proof->least);
    for (size_t i = 0; i < proof->count; i++)
        pir_triple_finish(&proof->plane[i].normal);
    PIR_FREE(a, proof->plane, proof->room);
    return status;
}

static pir_status check_input(const pir_pair_input *input) {
    const pir_quat r = input->pose_p.rotation, q = input->pose_q.rotation;
    const pir_vec3 t = input->pose_q.translation;
    if (!pir_vec_is_finite(input->pose_p.translation) || !pir_vec_is_finite((pir_vec3){r.x, r.y, r.z}) ||
        !isfinite(r.w))
        return PIR_ERR_NOT_FINITE;
    if (r.x == 0 && r.y == 0 && r.z == 0 && r.w == 0)
        return PIR_ERR_ZERO_QUATERNION;
    const bool rests = q.x == 0 && q.y == 0 && q.z == 0 && q.w == 1 && t.x == 0 && t.y == 0 && t.z == 0;
    return rests && input->radius_p == 0 && input->radius_q == 0 ? PIR_OK : PIR_ERR_ARGUMENT;
}

pir_status pir_solid_query_certificate(pir_solid_query *query, const pir_pair_input *input,
                                       const pir_query_result *answer, pir_proven proven,
                                       pir_certificate **ret_certificate) {
    if (!query || !input || !answer || !ret_certificate || (proven != PIR_PROVEN_STATE && proven != PIR_PROVEN_NUMBER))
        return PIR_ERR_ARGUMENT;
    pir_status status = check_input(input);
    if (status != PIR_OK)
        return status;
    struct solid_proof proof = {.query = query, .state = PIR_OUTSIDE, .number = proven == PIR_PROVEN_NUMBER};
    proof.text = (pir_proof_text){query->allocator, {0}, false};
    proof.body[0] = (pir_stance_body){(const pir_polytope *const *)query->p.piece, query->p.count};
    proof.body[1] = (pir_stance_body){(const pir_polytope *const *)query->q.piece, query->q.count};
    status = pir_stance_make_parts(&proof.bodies, &query->allocator, proof.body, input->pose_p);
    if (status != PIR_OK)
        return status;
    status = prove(&proof, answer, ret_certificate);
    pir_stance_finish(&proof.bodies);
    return status;
}
