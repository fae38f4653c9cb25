/* SPDX-License-Identifier: MIT */
/* Certificates as text. */
#include "certificate/certificate_text.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include <pirouette/certificate.h>
#include <pirouette/exact.h>

struct pir_certificate {
    pir_proof_text text;
};

/* Room for `more` bytes at the end, with one for a zero; NULL when out of memory, now or before. */
static char *room_for(pir_proof_text *text, size_t more) {
    if (text->failed || !pir_bytes_reserve(&text->bytes, &text->allocator, more + 1)) {
        text->failed = true;
        return NULL;
    }
    return (char *)text->bytes.data + text->bytes.used;
}

static void put(pir_proof_text *text, const char *string) {
    size_t length = strlen(string);
    char *at = room_for(text, length);
    if (!at)
        return;
    memcpy(at, string, length + 1);
    text->bytes.used += length;
}

static void put_count(pir_proof_text *text, uint32_t value) {
    char digits[16];
    snprintf(digits, sizeof digits, "%" PRIu32, value);
    put(text, digits);
}

static void put_integer(pir_proof_text *text, const mpz_t value) {
    char *at = room_for(text, mpz_sizeinbase(value, 10) + 2);
    if (!at)
        return;
    mpz_get_str(at, 10, value);
    text->bytes.used += strlen(at);
}

/* "a/b", or "a". */
static void put_rational(pir_proof_text *text, mpq_t value) {
    put(text, "\"");
    put_integer(text, mpq_numref(value));
    if (mpz_cmp_ui(mpq_denref(value), 1) != 0) {
        put(text, "/");
        put_integer(text, mpq_denref(value));
    }
    put(text, "\"");
}

static void put_ratio(pir_proof_text *text, const mpz_t num, const mpz_t den) {
    mpq_t value;
    mpq_init(value);
    mpz_set(mpq_numref(value), num);
    mpz_set(mpq_denref(value), den);
    mpq_canonicalize(value);
    put_rational(text, value);
    mpq_clear(value);
}

static void put_triple(pir_proof_text *text, const pir_triple *value) {
    for (int k = 0; k < 3; k++) {
        put(text, k == 0 ? "[\"" : ", \"");
        put_integer(text, value->c[k]);
        put(text, k == 2 ? "\"]" : "\"");
    }
}

/* A key, behind the one before it. */
static void put_key(pir_proof_text *text, const char *key) {
    put(text, ",\n\"");
    put(text, key);
    put(text, "\": ");
}

/* Doubles, which are rationals, exactly. */
static void put_doubles(pir_proof_text *text, const char *key, const double *value, int count) {
    put_key(text, key);
    for (int k = 0; k < count; k++) {
        mpq_t exact;
        mpq_init(exact);
        mpq_set_d(exact, value[k]);
        put(text, k == 0 ? "[" : ", ");
        put_rational(text, exact);
        mpq_clear(exact);
    }
    put(text, "]");
}

static void put_body(pir_proof_text *text, const char *key, pir_stood *stood) {
    uint32_t count = 0;
    put_key(text, key);
    for (uint32_t i = 0; i < stood->count; i++) {
        if (stood->listed[i] == PIR_UNLISTED)
            continue;
        stood->listed[i] = count;
        put(text, count++ == 0 ? "[\n" : ",\n");
        put_triple(text, &stood->at[i]);
    }
    put(text, "\n]");
}

/* The beginning: the kind of proof, the claim, and the pose of P. */
static void put_head(pir_proof_text *text, const char *kind, const char *claim, const pir_stance *bodies) {
    const pir_quat q = bodies->rotation;
    const pir_vec3 t = bodies->translation;
    put(text, "{\n\"");
    put(text, kind);
    put(text, "\": 1,\n\"claim\": \"");
    put(text, claim);
    put(text, "\"");
    put_doubles(text, "quat", (const double[4]){q.x, q.y, q.z, q.w}, 4);
    put_doubles(text, "translation", (const double[3]){t.x, t.y, t.z}, 3);
}

void pir_proof_text_begin(pir_proof_text *text, const char *claim, pir_stance *bodies) {
    put_head(text, "pirouette_certificate", claim, bodies);
    pir_proof_text_integer(text, "unit", bodies->unit);
    put_body(text, "p", &bodies->p);
    put_body(text, "q", &bodies->q);
}

pir_status pir_proof_text_end(pir_proof_text *text, pir_status status, pir_certificate **ret_certificate) {
    put(text, "\n}\n");
    pir_certificate *certificate = NULL;
    if (status == PIR_OK && !text->failed)
        certificate = PIR_NEW(&text->allocator, pir_certificate, 1);
    if (!certificate) {
        pir_bytes_finish(&text->bytes, &text->allocator);
        return status == PIR_OK ? PIR_ERR_MEMORY : status;
    }
    certificate->text = *text;
    *ret_certificate = certificate;
    return PIR_OK;
}

void pir_proof_text_integer(pir_proof_text *text, const char *key, const mpz_t value) {
    put_key(text, key);
    put(text, "\"");
    put_integer(text, value);
    put(text, "\"");
}

void pir_proof_text_ratio(pir_proof_text *text, const char *key, const mpz_t num, const mpz_t den) {
    put_key(text, key);
    put_ratio(text, num, den);
}

void pir_proof_text_point(pir_proof_text *text, const char *key, const pir_triple *num, const mpz_t den) {
    put_key(text, key);
    for (int k = 0; k < 3; k++) {
        put(text, k == 0 ? "[" : ", ");
        put_ratio(text, num->c[k], den);
    }
    put(text, "]");
}

void pir_proof_text_count(pir_proof_text *text, const char *key, uint32_t value) {
    put_key(text, key);
    put_count(text, value);
}

void pir_proof_text_triple(pir_proof_text *text, const char *key, const pir_triple *value) {
    put_key(text, key);
    put_triple(text, value);
}

static void put_corner(pir_proof_text *text, const pir_stance *bodies, pir_vertex_pair corner) {
    put(text, "[");
    put_count(text, bodies->p.listed[corner.p]);
    put(text, ", ");
    put_count(text, bodies->q.listed[corner.q]);
}

void pir_proof_text_mix(pir_proof_text *text, const pir_stance *bodies, const pir_mix *mix) {
    put_key(text, "pairs");
    for (int k = 0; k < mix->count; k++) {
        put(text, k == 0 ? "[\n" : ",\n");
        put_corner(text, bodies, mix->corner[k]);
        put(text, ", ");
        put_ratio(text, mix->weight[k], mix->whole);
        put(text, "]");
    }
    put(text, "\n]");
}

void pir_proof_text_mix_point(pir_proof_text *text, const char *key, const pir_stance *bodies, const pir_mix *mix,
                              bool of_q) {
    const pir_stood *stood = of_q ? &bodies->q : &bodies->p;
    pir_triple sum;
    mpz_t den;
    pir_triple_init(&sum);
    mpz_init(den);
    for (int k = 0; k < mix->count; k++) {
        uint32_t i = of_q ? mix->corner[k].q : mix->corner[k].p;
        for (int c = 0; c < 3; c++)
            mpz_addmul(sum.c[c], mix->weight[k], stood->at[i].c[c]);
    }
    mpz_mul(den, mix->whole, bodies->unit);
    pir_proof_text_point(text, key, &sum, den);
    pir_triple_finish(&sum);
    mpz_clear(den);
}

void pir_proof_text_boundary(pir_proof_text *text, const pir_boundary *boundary) {
    uint32_t vertices = pir_mesh_vertex_count(boundary->mesh), facets = pir_mesh_facet_count(boundary->mesh);
    put_key(text, "vertices");
    for (uint32_t i = 0; i < vertices; i++) {
        put(text, i == 0 ? "[\n" : ",\n");
        put_corner(text, boundary->bodies, pir_boundary_corner(boundary, i));
        put(text, "]");
    }
    put(text, "\n]");
    put_key(text, "facets");
    for (uint32_t f = 0; f < facets; f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(boundary->mesh, f, &count);
        put(text, f == 0 ? "[\n" : ",\n");
        for (uint32_t k = 0; k < count; k++) {
            put(text, k == 0 ? "[" : ", ");
            put_count(text, corner[k]);
        }
        put(text, "]");
    }
    put(text, "\n]");
}

void pir_proof_text_put(pir_proof_text *text, const char *string) {
    put(text, string);
}

void pir_proof_text_put_count(pir_proof_text *text, uint32_t value) {
    put_count(text, value);
}

void pir_proof_text_put_ratio(pir_proof_text *text, const mpz_t num, const mpz_t den) {
    put_ratio(text, num, den);
}

/* --- of solids --- */

/* The vertices of a piece in the frame of its model. */
static void put_vertices(pir_proof_text *text, const pir_polytope *piece) {
    mpq_t v[3];
    mpq_inits(v[0], v[1], v[2], NULL);
    for (uint32_t i = 0; i < pir_polytope_vertex_count(piece); i++) {
        pir_polytope_vertex_exact(piece, i, v);
        put(text, i == 0 ? "" : ", ");
        for (int k = 0; k < 3; k++) {
            put(text, k == 0 ? "[" : ", ");
            put_rational(text, v[k]);
        }
        put(text, "]");
    }
    mpq_clears(v[0], v[1], v[2], NULL);
}

static void put_facets(pir_proof_text *text, const pir_polytope *piece) {
    uint32_t most = 0;
    for (uint32_t f = 0; f < pir_polytope_facet_count(piece); f++) {
        const uint32_t size = pir_polytope_facet_size(piece, f);
        most = size > most ? size : most;
    }
    uint32_t *corner = PIR_NEW(&text->allocator, uint32_t, most);
    text->failed |= !corner;
    for (uint32_t f = 0; corner && f < pir_polytope_facet_count(piece); f++) {
        pir_polytope_facet(piece, f, corner);
        put(text, f == 0 ? "" : ", ");
        for (uint32_t k = 0; k < pir_polytope_facet_size(piece, f); k++) {
            put(text, k == 0 ? "[" : ", ");
            put_count(text, corner[k]);
        }
        put(text, "]");
    }
    PIR_FREE(&text->allocator, corner, most);
}

void pir_proof_text_pieces(pir_proof_text *text, const char *key, const pir_polytope *const *piece, uint32_t count) {
    put_key(text, key);
    for (uint32_t i = 0; i < count; i++) {
        put(text, i == 0 ? "[\n{\"points\": [" : ",\n{\"points\": [");
        put_vertices(text, piece[i]);
        put(text, "], \"facets\": [");
        put_facets(text, piece[i]);
        put(text, "]}");
    }
    put(text, "\n]");
}

void pir_proof_text_begin_solids(pir_proof_text *text, const char *claim, const pir_stance *bodies,
                                 const pir_stance_body body[2]) {
    put_head(text, "pirouette_solids", claim, bodies);
    for (int k = 0; k < 2; k++)
        pir_proof_text_pieces(text, k == 0 ? "p" : "q", body[k].part, body[k].count);
}

static void put_parts(pir_proof_text *text, pir_vertex_pair part) {
    put_count(text, part.p);
    put(text, ", ");
    put_count(text, part.q);
}

void pir_proof_text_planes(pir_proof_text *text, const pir_part_plane *plane, size_t count) {
    put_key(text, "planes");
    put(text, "[");
    for (size_t i = 0; i < count; i++) {
        put(text, i == 0 ? "\n[" : ",\n[");
        put_parts(text, plane[i].part);
        put(text, ", ");
        put_triple(text, &plane[i].normal);
        put(text, "]");
    }
    put(text, "\n]");
}

void pir_proof_text_parts(pir_proof_text *text, pir_vertex_pair part) {
    put_key(text, "pieces");
    put(text, "[");
    put_parts(text, part);
    put(text, "]");
}

/* --- what the caller has of it --- */

const char *pir_certificate_text(const pir_certificate *certificate, size_t *ret_length) {
    if (ret_length)
        *ret_length = certificate->text.bytes.used;
    return (const char *)certificate->text.bytes.data;
}

void pir_certificate_destroy(pir_certificate *certificate) {
    if (!certificate)
        return;
    const pir_allocator allocator = certificate->text.allocator;
    pir_bytes_finish(&certificate->text.bytes, &allocator);
    PIR_FREE(&allocator, certificate, 1);
}
