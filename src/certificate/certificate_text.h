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
void pir_proof_text_end(pir_proof_text *text);

/* An integer, num / den in lowest terms, and so many of them, den being common. */
void pir_proof_text_integer(pir_proof_text *text, const char *key, const mpz_t value);
void pir_proof_text_ratio(pir_proof_text *text, const char *key, const mpz_t num, const mpz_t den);
void pir_proof_text_point(pir_proof_text *text, const char *key, const pir_triple *num, const mpz_t den);
void pir_proof_text_count(pir_proof_text *text, const char *key, uint32_t value);

/* Integers as a list. */
void pir_proof_text_triple(pir_proof_text *text, const char *key, const pir_triple *value);

/* Corners with their weights as fractions, 1 in all: "pairs". */
void pir_proof_text_mix(pir_proof_text *text, const pir_stance *bodies, const pir_mix *mix);

/* Vertices as corners, facets as cycles of those: "vertices", "facets". */
void pir_proof_text_boundary(pir_proof_text *text, const pir_boundary *boundary);

/* Texts, numbers and rationals as they stand, for what has another form. */
void pir_proof_text_put(pir_proof_text *text, const char *string);
void pir_proof_text_put_count(pir_proof_text *text, uint32_t value);
void pir_proof_text_put_ratio(pir_proof_text *text, const mpz_t num, const mpz_t den);

/* The certificate that has this text, which is its own then; PIR_ERR_MEMORY where memory ran out meanwhile. */
pir_status pir_proof_text_certificate(const pir_proof_text *text, pir_certificate **ret_certificate);

#endif
