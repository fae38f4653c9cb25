/* SPDX-License-Identifier: MIT */
/*
 * Movers: see movers.h.
 *
 * The exit root in doubles. Let the form have the coefficients a, b, c of σ², στ and τ², each with its error,
 * δ = 2^-44 in all, and D = b² − 4ac. As a function of φ = θ/2 the form is m + ρ·cos(2φ − ψ), and its
 * slope at a root is √D. Its curvature is at most 4. The exit root is the one where it rises: (−b − √D : 2a),
 * or (2c : √D − b), whichever adds two of one sign.
 *
 * Where D ≥ 2^-36, a form that differs by at most δ, and in slope by 2δ, has one exit root within 2δ/√D of it,
 * and the root is found within 2^-47/D. Both are below 2^-41/D, because D ≤ 5. Where D < −2^-38 there is none,
 * since the form stays at least −D/8 ≥ 2^-41 away from 0. Integers decide between.
 */
#include "motion/movers.h"

#include <string.h>

#include "base/memory.h"
#include "base/vec.h"

#define LEAST_DISCRIMINANT 0x1p-36
#define NO_ROOT            (-0x1p-38)
#define ROOT_BOUND         0x1p-41
#define EXACT_SLACK        0x1p-47

/* --- made and freed --- */

static uint32_t longer(uint32_t a, uint32_t b) {
    return a > b ? a : b;
}

/* Coefficients of s for normals and edges of both, and of any double as κ. */
static uint32_t coefficient_limbs(const pir_movers *movers) {
    const pir_polytope *p = movers->operand[0], *q = movers->operand[1];
    const uint32_t normals = p->exact_normal.stride + q->exact_normal.stride,
                   mixed = longer(p->exact_normal.stride + q->exact_edge.stride,
                                  p->exact_edge.stride + q->exact_normal.stride);
    return longer(longer(normals, mixed) + movers->turning.entry_limbs + 3,
                  pir_double_power_limbs(movers->turning.exponent));
}

static bool make_arrays(pir_movers *movers) {
    const pir_allocator *a = &movers->allocator;
    const pir_polytope *p = movers->operand[0], *q = movers->operand[1];
    movers->count = p->facet_count + q->facet_count;
    movers->limbs = coefficient_limbs(movers);
    // two roots, now and one more, and the product of two components that is made with a quadratic
    movers->scratch.capacity = PIR_QUADRATIC_SCRATCH(movers->limbs) + 14 * movers->limbs;
    movers->scratch.base = PIR_NEW(a, mp_limb_t, movers->scratch.capacity);
    movers->turned = PIR_NEW(a, pir_vec3, p->half_count);
    movers->form = PIR_NEW(a, pir_form, movers->count);
    movers->mover = PIR_ZEROED(a, pir_mover, movers->count);
    movers->row = PIR_NEW(a, int8_t, movers->count);
    movers->root_limbs = PIR_NEW(a, mp_limb_t, (size_t)3 * movers->limbs);
    for (int i = 0; movers->root_limbs && i < 3; i++)
        movers->root.c[i] = (pir_int){movers->root_limbs + (size_t)i * movers->limbs, 0, movers->limbs};
    return movers->scratch.base && movers->turned && movers->form && movers->mover && movers->row &&
           movers->root_limbs && pir_parallels_init(&movers->parallels[0], p, a) &&
           pir_parallels_init(&movers->parallels[1], q, a);
}

static void set_forms(pir_movers *movers) {
    const pir_polytope *p = movers->operand[0], *q = movers->operand[1];
    for (uint32_t h = 0; h < p->half_count; h++)
        movers->turned[h] = pir_mat_apply(&movers->turning.rotation.r, p->direction[h]);
    for (uint32_t f = 0; f < p->facet_count; f++)
        movers->form[f] = pir_turning_form_p(&movers->turning, p->normal[f]);
    for (uint32_t f = 0; f < q->facet_count; f++)
        movers->form[p->facet_count + f] = pir_turning_form_q(&movers->turning, q->normal[f]);
}

pir_status pir_movers_init(pir_movers *movers, const pir_allocator *allocator, pir_polytope *const operand[2],
                           pir_vec3 axis, const pir_rotation *rotation) {
    *movers = (pir_movers){.allocator = *allocator};
    pir_status status = pir_turning_init(&movers->turning, allocator, axis, rotation);
    if (status != PIR_OK)
        return status;
    for (int k = 0; k < 2; k++)
        movers->operand[k] = pir_polytope_retain(operand[k]);
    if (!make_arrays(movers)) {
        pir_movers_finish(movers);
        return PIR_ERR_MEMORY;
    }
    movers->body[0] = (pir_ground){operand[0], movers->turned, 0};
    movers->body[1] = (pir_ground){operand[1], operand[1]->direction, operand[0]->facet_count};
    set_forms(movers);
    pir_movers_begin(movers);
    return PIR_OK;
}

void pir_movers_finish(pir_movers *movers) {
    const pir_allocator *a = &movers->allocator;
    PIR_FREE(a, movers->scratch.base, movers->scratch.capacity);
    PIR_FREE(a, movers->turned, movers->operand[0]->half_count);
    PIR_FREE(a, movers->form, movers->count);
    PIR_FREE(a, movers->mover, movers->count);
    PIR_FREE(a, movers->row, movers->count);
    PIR_FREE(a, movers->root_limbs, (size_t)3 * movers->limbs);
    for (int k = 0; k < 2; k++)
        pir_parallels_finish(&movers->parallels[k], movers->operand[k], a);
    pir_turning_finish(&movers->turning, a);
    for (int k = 0; k < 2; k++)
        pir_polytope_release(movers->operand[k]);
}

/* --- now --- */

void pir_movers_quadratic(const pir_movers *movers, uint32_t m, uint32_t half, pir_quadratic *dst, pir_limbs *scratch) {
    const pir_polytope *p = movers->operand[0], *q = movers->operand[1];
    const uint32_t f = pir_mover_facet(movers, m);
    const bool of_p = pir_mover_body(movers, m) == 0;
    const pir_int3 x = of_p ? pir_normal_exact(p, f) : pir_half_exact(p, half);
    const pir_int3 y = of_p ? pir_half_exact(q, half) : pir_normal_exact(q, f);
    pir_turning_quadratic(&movers->turning, &x, &y, dst, scratch);
}

const pir_quadratic *pir_movers_now(pir_movers *movers) {
    pir_now *now = &movers->now;
    if (!now->has_root && now->mover == PIR_NONE)
        pir_quadratic_of_double(&movers->root, now->kappa, movers->turning.exponent);
    else if (!now->has_root)
        pir_movers_quadratic(movers, now->mover, now->half, &movers->root, &movers->scratch);
    now->has_root = true;
    return &movers->root;
}

/* --- parallels --- */

/* 1 where two signs are positive multiples of each other, −1 where negative ones, 0 where that is not known. */
static int same_sign(const pir_movers *movers, uint32_t ma, uint32_t half_a, uint32_t mb, uint32_t half_b) {
    const int body = pir_mover_body(movers, ma);
    if (body != pir_mover_body(movers, mb))
        return 0;
    const uint32_t *normal = movers->parallels[body].normal, *edge = movers->parallels[1 - body].edge;
    const pir_polytope *other = movers->body[1 - body].polytope;
    const uint32_t ea = other->edge[half_a], eb = other->edge[half_b], first = movers->body[body].first;
    const uint32_t n = normal[ma - first] ^ normal[mb - first], e = edge[ea] ^ edge[eb];
    if ((n | e) > 1)
        return 0;
    return ((n ^ e) & 1) == ((other->edge_half[ea] == half_a) != (other->edge_half[eb] == half_b)) ? 1 : -1;
}

/* The key of an exit root, within EXACT_SLACK. */
static double exact_key(pir_movers *movers, const pir_quadratic *root) {
    pir_scaled sigma, tau;
    pir_quadratic_approximate(root, &sigma, &tau, &movers->scratch);
    tau.m *= movers->turning.length.m;
    tau.e += movers->turning.length.e;
    if (sigma.m == 0)
        return 0;
    const int top = tau.m != 0 && tau.e > sigma.e ? tau.e : sigma.e;
    const double s = sigma.e - top < -2000 ? 0 : ldexp(sigma.m, sigma.e - top);
    const double t = tau.e - top < -2000 ? 0 : ldexp(tau.m, tau.e - top);
    return -s / (fabs(s) + t);
}

static void set_now(pir_movers *movers, double key, double slack) {
    pir_now *now = &movers->now;
    const double sigma = -key, tau = 1 - fabs(key), by = 1 / sqrt(sigma * sigma + tau * tau);
    now->first = false;
    now->key = key;
    now->slack = slack;
    now->sigma = sigma * by;
    now->tau = tau * by;
}

void pir_movers_begin(pir_movers *movers) {
    movers->now = (pir_now){.first = true, .sigma = 1, .key = -1, .mover = PIR_NONE};
}

void pir_movers_go_to(pir_movers *movers, double kappa) {
    movers->now = (pir_now){.mover = PIR_NONE, .kappa = kappa};
    set_now(movers, exact_key(movers, pir_movers_now(movers)), EXACT_SLACK);
}

void pir_movers_advance(pir_movers *movers, uint32_t m) {
    const pir_instant *next = &movers->mover[m].next;
    set_now(movers, next->key, next->slack);
    movers->now.mover = m;
    movers->now.half = next->half;
    movers->now.simple = next->simple;
    movers->now.has_root = false;
}

/* --- signs --- */

int pir_movers_filter(const pir_movers *movers, uint32_t m, uint32_t half) {
    const pir_now *now = &movers->now;
    const pir_form *form = &movers->form[m];
    const pir_vec3 d = pir_mover_ground(movers, m)->direction[half];
    const double s = (pir_vec_dot(form->c[0], d) * now->sigma + pir_vec_dot(form->c[1], d) * now->tau) * now->sigma +
                     pir_vec_dot(form->c[2], d) * (now->tau * now->tau);
    // the slope in φ is at most 2, φ is off by twice the slack, and rounding is far below the bound of a form
    const double bound = 2 * PIR_FORM_BOUND + 8 * now->slack;
    return (s > bound) - (s < -bound);
}

static int exact_sign(pir_movers *movers, uint32_t m, uint32_t half, pir_when when) {
    const uint32_t mark = movers->scratch.used;
    pir_quadratic s = pir_quadratic_take(&movers->scratch, movers->limbs);
    pir_movers_quadratic(movers, m, half, &s, &movers->scratch);
    int sign;
    if (movers->now.first) {
        sign = when == PIR_AFTER ? pir_quadratic_sign_first(&s) : pir_int_sign(&s.c[0]);
    } else {
        const pir_quadratic *root = pir_movers_now(movers);
        sign = when == PIR_AT      ? pir_quadratic_sign_at(&s, root, &movers->scratch)
               : when == PIR_AFTER ? pir_quadratic_sign_after(&s, root, &movers->scratch)
                                   : pir_quadratic_sign_before(&s, root, &movers->scratch);
    }
    movers->scratch.used = mark;
    movers->by_exact++;
    return sign;
}

int pir_movers_sign(pir_movers *movers, uint32_t m, uint32_t half, pir_when when) {
    const pir_now *now = &movers->now;
    const int sign = pir_movers_filter(movers, m, half);
    movers->by_filter += sign != 0;
    if (sign != 0)
        return sign;
    const int same = now->mover != PIR_NONE && now->simple ? same_sign(movers, m, half, now->mover, now->half) : 0;
    if (same != 0)
        // at its own exit root a sign turns from negative to positive
        return when == PIR_AT ? 0 : when == PIR_AFTER ? same : -same;
    return exact_sign(movers, m, half, when);
}

/* --- the next instant --- */

/* Outcomes of a look by doubles at a side's exit root. */
enum seen { SEEN_NONE, SEEN_ROOT, SEEN_UNSURE };

/* The exit root by doubles, where it is certainly there and after now. */
static inline enum seen see_root(const pir_form *form, pir_vec3 d, const pir_now *now, double *ret_key,
                                 double *ret_slack) {
    const double a = pir_vec_dot(form->c[0], d), b = pir_vec_dot(form->c[1], d), c = pir_vec_dot(form->c[2], d);
    const double discriminant = b * b - 4 * a * c;
    if (discriminant < LEAST_DISCRIMINANT)
        return discriminant < NO_ROOT ? SEEN_NONE : SEEN_UNSURE;
    const double root = sqrt(discriminant);
    double sigma = b >= 0 ? -(b + root) : 2 * c, tau = b >= 0 ? 2 * a : root - b;
    if (tau < 0) {
        sigma = -sigma;
        tau = -tau;
    }
    const double key = -sigma / (fabs(sigma) + tau), slack = ROOT_BOUND / discriminant;
    // at either end a root may be at the other one, or at infinity
    if (key + slack < now->key - now->slack && key - slack > -1)
        return SEEN_NONE;
    if (key - slack <= now->key + now->slack || key + slack >= 1)
        return SEEN_UNSURE;
    *ret_key = key;
    *ret_slack = slack;
    return SEEN_ROOT;
}

/* The exit root by integers: SEEN_NONE where there is none after now; `*ret_lasts` where s is zero all along. */
static enum seen find_root(pir_movers *movers, uint32_t m, uint32_t half, pir_instant *ret_instant, bool *ret_lasts) {
    const uint32_t mark = movers->scratch.used;
    pir_quadratic s = pir_quadratic_take(&movers->scratch, movers->limbs);
    pir_movers_quadratic(movers, m, half, &s, &movers->scratch);
    enum seen seen = SEEN_NONE;
    *ret_lasts = pir_quadratic_is_zero(&s);
    movers->by_exact++;
    if (!*ret_lasts && pir_quadratic_has_exit(&s, &movers->scratch)) {
        bool after = movers->now.first;
        if (!after)
            after = pir_quadratic_compare(&s, pir_movers_now(movers), &movers->scratch) < 0;
        if (after) {
            *ret_instant = (pir_instant){exact_key(movers, &s), EXACT_SLACK, half, true, false};
            seen = SEEN_ROOT;
        }
    }
    movers->scratch.used = mark;
    return seen;
}

/* The sign of b − a for two exit roots: −1 where a comes first. */
static int exact_order(pir_movers *movers, uint32_t ma, uint32_t half_a, uint32_t mb, uint32_t half_b) {
    if (same_sign(movers, ma, half_a, mb, half_b) > 0)
        return 0;
    const uint32_t mark = movers->scratch.used;
    pir_quadratic a = pir_quadratic_take(&movers->scratch, movers->limbs);
    pir_quadratic b = pir_quadratic_take(&movers->scratch, movers->limbs);
    pir_movers_quadratic(movers, ma, half_a, &a, &movers->scratch);
    pir_movers_quadratic(movers, mb, half_b, &b, &movers->scratch);
    const int order = pir_quadratic_compare(&b, &a, &movers->scratch);
    movers->scratch.used = mark;
    movers->by_exact++;
    return order;
}

static inline int key_order(const pir_instant *a, const pir_instant *b) {
    const double apart = a->key - b->key, slack = a->slack + b->slack;
    return (apart > slack) - (apart < -slack);
}

int pir_movers_order(pir_movers *movers, uint32_t a, uint32_t b) {
    const pir_instant *x = &movers->mover[a].next, *y = &movers->mover[b].next;
    if (x->half == PIR_NONE || y->half == PIR_NONE)
        return (x->half == PIR_NONE) - (y->half == PIR_NONE);
    const int order = key_order(x, y);
    return order != 0 || a == b ? order : exact_order(movers, a, x->half, b, y->half);
}

/* Keeps the earlier of two roots of a mover's sides. */
static void keep_first(pir_movers *movers, uint32_t m, pir_instant *best, const pir_instant *other) {
    int order = best->half == PIR_NONE ? 1 : key_order(best, other);
    if (order == 0)
        order = exact_order(movers, m, best->half, m, other->half);
    if (order > 0)
        *best = *other;
    else if (order == 0)
        best->alone = false;
}

/* The sides of the cell that doubles are unsure of; those on which the mover stays are counted. */
static uint32_t follow_exactly(pir_movers *movers, uint32_t m, pir_instant *best) {
    const pir_ground *ground = pir_mover_ground(movers, m);
    const pir_polytope *other = ground->polytope;
    pir_mover *mover = &movers->mover[m];
    uint32_t lasting = 0;
    for (uint32_t h = other->ring_start[mover->cell]; h < other->ring_start[mover->cell + 1]; h++) {
        pir_instant instant;
        double key, slack;
        if (see_root(&movers->form[m], ground->direction[h], &movers->now, &key, &slack) != SEEN_UNSURE)
            continue;
        bool lasts;
        if (find_root(movers, m, h, &instant, &lasts) == SEEN_ROOT)
            keep_first(movers, m, best, &instant);
        if (lasts) {
            mover->on = h;
            lasting++;
        }
    }
    return lasting;
}

void pir_movers_follow(pir_movers *movers, uint32_t m) {
    const pir_ground *ground = pir_mover_ground(movers, m);
    pir_mover *mover = &movers->mover[m];
    const pir_form *form = &movers->form[m];
    const uint32_t *start = ground->polytope->ring_start + mover->cell;
    pir_instant best = {INFINITY, 0, PIR_NONE, true, true};
    bool unsure = false;
    mover->on = mover->pinned = PIR_NONE;
    for (uint32_t h = start[0]; h < start[1]; h++) {
        pir_instant instant = {0, 0, h, true, true};
        const enum seen seen = see_root(form, ground->direction[h], &movers->now, &instant.key, &instant.slack);
        if (seen == SEEN_ROOT)
            keep_first(movers, m, &best, &instant);
        unsure |= seen == SEEN_UNSURE;
    }
    const uint32_t lasting = unsure ? follow_exactly(movers, m, &best) : 0;
    if (lasting > 1) {
        mover->pinned = pir_movers_corner(movers, m);
        mover->on = PIR_NONE;
        best = (pir_instant){INFINITY, 0, PIR_NONE, true, true};
    }
    mover->next = best;
}

/* --- places --- */

/* Whether a mover's normal and that of a facet of the other body, parallel at now, point the same way. */
static bool is_along(pir_movers *movers, uint32_t m, uint32_t facet) {
    const uint32_t mark = movers->scratch.used, f = pir_mover_facet(movers, m);
    const bool of_p = pir_mover_body(movers, m) == 0;
    const pir_int3 x = pir_normal_exact(movers->operand[0], of_p ? f : facet);
    const pir_int3 y = pir_normal_exact(movers->operand[1], of_p ? facet : f);
    pir_quadratic s = pir_quadratic_take(&movers->scratch, movers->limbs);
    pir_turning_quadratic(&movers->turning, &x, &y, &s, &movers->scratch);
    int sign = pir_quadratic_sign_first(&s);
    if (!movers->now.first)
        sign = pir_quadratic_sign_at(&s, pir_movers_now(movers), &movers->scratch);
    movers->scratch.used = mark;
    return sign > 0;
}

uint32_t pir_movers_corner(pir_movers *movers, uint32_t m) {
    const pir_polytope *other = pir_mover_ground(movers, m)->polytope;
    const uint32_t v = movers->mover[m].cell, first = other->ring_start[v], end = other->ring_start[v + 1];
    // at the beginning only what lasts is asked for
    const pir_when when = movers->now.first ? PIR_AFTER : PIR_AT;
    uint32_t corner = PIR_NONE;
    bool before = pir_movers_sign(movers, m, end - 1, when) == 0;
    for (uint32_t h = first; h < end; h++) {
        const bool zero = pir_movers_sign(movers, m, h, when) == 0;
        const uint32_t between = other->left[h == first ? end - 1 : h - 1];
        // a vertex of a polygon has two sides, which meet at both facets
        if (zero && before && (corner == PIR_NONE || is_along(movers, m, between)))
            corner = between;
        before = zero;
    }
    PIR_ASSERT(corner != PIR_NONE);
    return corner;
}

/* From a vertex uphill to one that no neighbour is farther than. */
static uint32_t climb(pir_movers *movers, uint32_t m, uint32_t v) {
    const pir_polytope *other = pir_mover_ground(movers, m)->polytope;
    for (uint32_t h = other->ring_start[v]; h < other->ring_start[v + 1]; h++)
        if (pir_movers_sign(movers, m, h, PIR_AFTER) > 0) {
            v = other->target[h];
            h = other->ring_start[v] - 1;
        }
    return v;
}

void pir_movers_locate(pir_movers *movers) {
    for (int k = 0; k < 2; k++) {
        const pir_polytope *own = movers->body[k].polytope;
        pir_mover *mover = movers->mover + movers->body[k].first;
        for (uint32_t i = 0; i < own->facet_count; i++) {
            const pir_visit visit = own->visit[i];
            const uint32_t m = movers->body[k].first + visit.facet;
            mover[visit.facet].cell = climb(movers, m, i == 0 ? 0 : mover[visit.beside].cell);
            pir_movers_follow(movers, m);
        }
    }
}
