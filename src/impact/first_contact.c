/* SPDX-License-Identifier: MIT */
/* The first of many contacts: see first_contact.h. */
#include "impact/first_contact.h"

#include "base/memory.h"
#include "impact/course.h"

void pir_first_contact_init(pir_first_contact *first, const pir_allocator *allocator, pir_contact_asker *ask,
                            void *context) {
    *first = (pir_first_contact){.allocator = allocator, .ask = ask, .context = context};
    mpz_inits(first->root[0], first->root[1], first->root[2], first->other[0], first->other[1], first->other[2], NULL);
}

void pir_first_contact_finish(pir_first_contact *first) {
    mpz_clears(first->root[0], first->root[1], first->root[2], first->other[0], first->other[1], first->other[2], NULL);
}

/* The sign of the κ in `other` less that of the best, exactly. */
static pir_status compare_roots(pir_first_contact *first, int *ret_order) {
    const pir_quadratic other = pir_course_view(first->other), best = pir_course_view(first->root);
    size_t limbs = 1;
    for (int k = 0; k < 3; k++) {
        const size_t most = mpz_size(first->other[k]), own = mpz_size(first->root[k]);
        limbs = most > limbs ? most : limbs;
        limbs = own > limbs ? own : limbs;
    }
    const uint32_t room = PIR_QUADRATIC_SCRATCH((uint32_t)limbs);
    mp_limb_t *base = PIR_ZEROED(first->allocator, mp_limb_t, room);
    pir_limbs scratch = {base, 0, room};
    if (!base)
        return PIR_ERR_MEMORY;
    *ret_order = pir_quadratic_compare(&other, &best, &scratch);
    PIR_FREE(first->allocator, base, room);
    return PIR_OK;
}

/* Whether a later contact comes before the best, 1, at the same κ, 0, or after it, −1. */
static pir_status order_of(pir_first_contact *first, const pir_exact_impact *hit, int *ret_order) {
    const pir_exact_impact *best = &first->best;
    *ret_order = hit->kappa[0] > best->kappa[1] ? 1 : hit->kappa[1] < best->kappa[0] ? -1 : 0;
    if (*ret_order != 0)
        return PIR_OK;
    pir_status status = first->has_root ? PIR_OK : first->ask(first->context, &best->impact, first->root);
    first->has_root = status == PIR_OK;
    if (status == PIR_OK)
        status = first->ask(first->context, &hit->impact, first->other);
    return status == PIR_OK ? compare_roots(first, ret_order) : status;
}

static bool is_lower(const pir_impact *a, const pir_impact *b) {
    if (a->body != b->body)
        return a->body < b->body;
    return a->piece_p < b->piece_p || (a->piece_p == b->piece_p && a->piece_q < b->piece_q);
}

/* How early an answer is: 0 for none. */
static int rank_of(const pir_impact *impact) {
    switch (impact->outcome) {
    case PIR_CAST_START_INSIDE:
        return 4;
    case PIR_CAST_HIT:
        return impact->steps == 0 ? 3 : 2;
    case PIR_CAST_RECEDING:
        return 1;
    default:
        return 0;
    }
}

pir_status pir_first_contact_offer(pir_first_contact *first, const pir_exact_impact *impact) {
    const int rank = rank_of(&impact->impact), best = first->any ? rank_of(&first->best.impact) : 0;
    if (rank == 0 || rank < best)
        return PIR_OK;
    int order = rank > best;
    if (rank == 2 && best == 2) {
        const pir_status status = order_of(first, impact, &order);
        if (status != PIR_OK)
            return status;
    }
    if (order < 0 || (order == 0 && !is_lower(&impact->impact, &first->best.impact)))
        return PIR_OK;
    first->best = *impact;
    first->any = true;
    first->has_root = false;
    return PIR_OK;
}
