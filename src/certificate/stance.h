/* SPDX-License-Identifier: MIT */
/*
 * Both bodies where they stand, exactly. Every coordinate is an integer of one unit: a vertex is at `number / unit`.
 *
 * Vertex (i, j) of the difference is Q's vertex j minus P's vertex i, so that bodies share a point exactly when the
 * origin lies in it; of a sum it is their sum.
 *
 * Numbers are GMP's, in its own memory, which ends the process when it runs out; arrays are the allocator's.
 */
#ifndef PIR_CERTIFICATE_STANCE_H
#define PIR_CERTIFICATE_STANCE_H

#include <pirouette/polytope.h>
#include <pirouette/pose.h>
#include <pirouette/sum.h>

#include <gmp.h>

#include "base/memory.h"

/* Three integers. */
typedef struct pir_triple {
    mpz_t c[3];
} pir_triple;

void pir_triple_init(pir_triple *triple);
void pir_triple_finish(pir_triple *triple);
void pir_triple_subtract(pir_triple *to, const pir_triple *a, const pir_triple *b);

/* to = a × b; `to` is neither. */
void pir_triple_cross(pir_triple *to, const pir_triple *a, const pir_triple *b);
void pir_triple_negate(pir_triple *triple);

/* Divides by what the three have in common, unless all are 0. */
void pir_triple_strip(pir_triple *triple);
void pir_triple_dot(mpz_t to, const pir_triple *a, const pir_triple *b);

/* One body's vertices. */
typedef struct pir_stood {
    pir_triple *at;
    uint32_t *listed; /* which a certificate lists: 1, then their numbers in it; PIR_UNLISTED for the others */
    uint32_t count;
} pir_stood;

#define PIR_UNLISTED UINT32_MAX

typedef struct pir_stance {
    pir_allocator allocator;
    pir_quat rotation;
    pir_vec3 translation;
    pir_stood p, q;
    mpz_t unit; /* above 0; has no factor in common with all coordinates */
    bool difference;
} pir_stance;

/* The polytopes that a body is made of, one at least. */
typedef struct pir_stance_body {
    const pir_polytope *const *part;
    uint32_t count;
} pir_stance_body;

/* A vertex of P and one of Q. */
typedef struct pir_vertex_pair {
    uint32_t p, q;
} pir_vertex_pair;

/*
 * Makes the bodies of a sum, P turned by the sum's rotation, then moved. `allocator` lasts as long as they do.
 * PIR_ERR_MEMORY.
 */
pir_status pir_stance_make(pir_stance *bodies, const pir_allocator *allocator, const pir_sum *sum, bool difference,
                           pir_vec3 translation);

/*
 * Makes P and Q, of parts, each with the vertices of its parts in a row, P turned, then moved. Otherwise as above; the
 * difference is theirs.
 */
pir_status pir_stance_make_parts(pir_stance *bodies, const pir_allocator *allocator, const pir_stance_body body[2],
                                 pir_pose pose_p);
void pir_stance_finish(pir_stance *bodies);

/* The vertex of the difference or sum at a corner. */
void pir_stance_vertex(const pir_stance *bodies, pir_vertex_pair corner, pir_triple *to);

/* Puts both vertices of a corner on the certificate's lists. */
void pir_stance_list(pir_stance *bodies, pir_vertex_pair corner);

/* A corner of the difference that lies least far along `way`. */
pir_vertex_pair pir_stance_lowest(const pir_stance *bodies, const pir_triple *way);

/* The least and the greatest of way·v over a body's vertices; either may be NULL. */
void pir_stood_range(const pir_stood *stood, const pir_triple *way, mpz_ptr ret_least, mpz_ptr ret_most);

/* The greatest magnitude of a coordinate, in doubles; infinite where it is beyond them. */
double pir_stance_reach(const pir_stance *bodies);

/* Whether √(num / den), as a double, is a number that an answer tells, but for rounding. */
bool pir_stance_is_length(const pir_stance *bodies, double told, const mpz_t num, const mpz_t den);

/* num / den as a double of the exponent *ret_exponent; den is above 0. */
double pir_ratio_split(const mpz_t num, const mpz_t den, long *ret_exponent);

#endif
