/* SPDX-License-Identifier: MIT */
/*
 * The text of a certificate, written piece by piece: one JSON object, each element of a list on a line of its own, so
 * that a checker can name the line that fails. Where memory runs out `failed` stays set and later writes do nothing.
 */
#ifndef PIR_CERTIFICATE_CERTIFICATE_TEXT_H
#define PIR_CERTIFICATE_CERTIFICATE_TEXT_H

#include <pirouette/certificate.h>

#include "base/byte_block.h"
#include "certificate/sum_facets.h"

typedef struct pir_proof_text {
    pir_allocator allocator;
    pir_bytes bytes;
    bool failed;
} pir_proof_text;

/*
 * Begins with what all have: the claim, the pose, and the listed vertices of both bodies where they stand, which get
 * their numbers here.
 */
void pir_proof_text_begin(pir_proof_text *text, const char *claim, pir_stance *bodies);

/* Ends it, and makes a certificate of it where the status so far is good; frees it where that is not, or fails. */
pir_status pir_proof_text_end(pir_proof_text *text, pir_status status, pir_certificate **ret_certificate);

/* An integer, num / den in lowest terms, and so many of them, den being common. */
void pir_proof_text_integer(pir_proof_text *text, const char *key, const mpz_t value);
void pir_proof_text_ratio(pir_proof_text *text, const char *key, const mpz_t num, const mpz_t den);
void pir_proof_text_point(pir_proof_text *text, const char *key, const pir_triple *num, const mpz_t den);
void pir_proof_text_count(pir_proof_text *text, const char *key, uint32_t value);

/* Integers as a list. */
void pir_proof_text_triple(pir_proof_text *text, const char *key, const pir_triple *value);

/* Corners with their weights as fractions, 1 in all: "pairs". */
void pir_proof_text_mix(pir_proof_text *text, const pir_stance *bodies, const pir_mix *mix);

/* The point of P, or of Q, that a mix is at. */
void pir_proof_text_mix_point(pir_proof_text *text, const char *key, const pir_stance *bodies, const pir_mix *mix,
                              bool of_q);

/* Vertices as corners, facets as cycles of those: "vertices", "facets". */
void pir_proof_text_boundary(pir_proof_text *text, const pir_boundary *boundary);

/* Texts, numbers and rationals as they stand, for what has another form. */
void pir_proof_text_put(pir_proof_text *text, const char *string);
void pir_proof_text_put_count(pir_proof_text *text, uint32_t value);
void pir_proof_text_put_ratio(pir_proof_text *text, const mpz_t num, const mpz_t den);

/* --- of solids --- */

/* Begins with what proofs of solids have: the claim, the pose, and all pieces of both in the frames of their models. */
void pir_proof_text_begin_solids(pir_proof_text *text, const char *claim, const pir_stance *bodies,
                                 const pir_stance_body body[2]);

/* Convex pieces in the frame of their model: points, and facets as cycles of their numbers. */
void pir_proof_text_pieces(pir_proof_text *text, const char *key, const pir_polytope *const *piece, uint32_t count);

/* A plane between a piece of P and one of Q; its normal points to P's. */
typedef struct pir_part_plane {
    pir_vertex_pair part; /* the numbers of the pieces */
    pir_triple normal;
} pir_part_plane;

void pir_proof_text_planes(pir_proof_text *text, const pir_part_plane *plane, size_t count);

/* Which pieces the corners of a mix are of: "pieces". */
void pir_proof_text_parts(pir_proof_text *text, pir_vertex_pair part);

#endif
