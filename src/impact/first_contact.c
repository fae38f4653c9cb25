/* SPDX-License-Identifier: MIT */
/* The first of many contacts: see first_contact.h. */
#include "impact/first_contact.h"

#include "base/memory.h"
#include "impact/course.h"
#include "impact/pair_impact.h"

void pir_first_contact_init(pir_first_contact *first, const pir_allocator *allocator, const pir_exact_motion *motion,
                            pir_contact_asker *ask, void *context) {
    *first = (pir_first_contact){.allocator = allocator, .ask = ask, .context = context};
    first->screws = pir_exact_motion_screws(motion);
    for (int k = 0; k < 4; k++)
        mpz_inits(first->root[k], first->other[k], NULL);
}

void pir_first_contact_finish(pir_first_contact *first) {
    for (int k = 0; k < 4; k++)
        mpz_clears(first->root[k], first->other[k], NULL);
}

/* dst = the greatest root of a cubic in κ, which is above 0, between two doubles. */
static bool make_cubic_root(pir_cubic_root *dst, mpz_t c[4], const double kappa[2]) {
    pir_cubic f;
    mpz_t end[2];
    int e[2];
    pir_cubic_init(&f);
    for (int k = 0; k < 4; k++)
        mpz_set(f.c[k], c[3 - k]);
    pir_cubic_trim(&f);
    for (int k = 0; k < 2; k++) {
        mpz_init(end[k]);
        const double inside = fmin(kappa[k], 0x1.fffffffffffffp1023), m = frexp(inside, &e[k]);
        mpz_set_d(end[k], ldexp(m, 53));
        e[k] -= 53;
    }
    // the lower end is left out of the interval, which is made wider by one last bit
    mpz_sub_ui(end[0], end[0], 1);
    const int low = e[0] < e[1] ? e[0] : e[1], least = low < 0 ? low : 0;
    for (int k = 0; k < 2; k++)
        mpz_mul_2exp(end[k], end[k], (mp_bitcnt_t)(e[k] - least));
    const bool found = pir_cubic_root_within(dst, &f, end[0], end[1], (mp_bitcnt_t)-least, PIR_LAST_ROOT);
    mpz_clears(end[0], end[1], NULL);
    pir_cubic_clear(&f);
    return found;
}

static pir_status compare_cubic_roots(pir_first_contact *first, const pir_exact_impact *hit, int *ret_order) {
    pir_cubic_root other, best;
    pir_cubic_root_init(&other);
    pir_cubic_root_init(&best);
    const bool found =
        make_cubic_root(&other, first->other, hit->kappa) && make_cubic_root(&best, first->root, first->best.kappa);
    *ret_order = found ? pir_cubic_root_compare(&other, &best) : 0;
    pir_cubic_root_clear(&other);
    pir_cubic_root_clear(&best);
    return found ? PIR_OK : PIR_ERR_INTERNAL;
}

/* The sign of the κ in `other`, that of a hit, less that of the best, exactly. */
static pir_status compare_roots(pir_first_contact *first, const pir_exact_impact *hit, int *ret_order) {
    if (first->screws)
        return compare_cubic_roots(first, hit, ret_order);
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
    return status == PIR_OK ? compare_roots(first, hit, ret_order) : status;
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
