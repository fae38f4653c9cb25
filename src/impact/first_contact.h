/* SPDX-License-Identifier: MIT */
/*
 * The first of the contacts of many pairs in one motion: contacts in doubles where their intervals are apart, else as
 * algebraic numbers.
 *
 * Invariant: of all that were offered, `best` is the first; of equal ones that of the lowest body, piece of P, piece
 * of Q.
 */
#ifndef PIR_IMPACT_FIRST_CONTACT_H
#define PIR_IMPACT_FIRST_CONTACT_H

#include <gmp.h>

#include <pirouette/impact.h>

/* The pair of an impact, asked again for its polynomial. */
typedef pir_status pir_contact_asker(void *context, const pir_impact *of, mpz_t *ret_root);

typedef struct pir_first_contact {
    const pir_allocator *allocator;
    pir_contact_asker *ask;
    void *context;
    bool any; /* whether there is a best */
    pir_exact_impact best;
    bool screws;   /* contacts are roots of cubics, of the first coefficient first, else of quadratics */
    bool has_root; /* whether `root` is the best's */
    mpz_t root[4], other[4];
} pir_first_contact;

void pir_first_contact_init(pir_first_contact *first, const pir_allocator *allocator, const pir_exact_motion *motion,
                            pir_contact_asker *ask, void *context);
void pir_first_contact_finish(pir_first_contact *first);

/*
 * Offers an answer of a pair. Overlaps at the start come first, then contacts from which the bodies overlap at once,
 * then later contacts, then those at the start that recede; other answers are none. PIR_ERR_MEMORY, and errors of the
 * asker.
 */
pir_status pir_first_contact_offer(pir_first_contact *first, const pir_exact_impact *impact);

#endif
