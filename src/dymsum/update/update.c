/* SPDX-License-Identifier: MIT */
/*
 * The update: find the facets that may have left their cells, and repair what they touched.
 *
 * Why a jump is safe. Between two frames let R turn continuously, along the way that the clock measures (clock.h). The pairing changes
 * only where a facet, a point of one Gaussian map, passes through an arc of the other, and so leaves its cell. A facet whose
 * alarm has not rung has stayed in its cell all the way. So crossings need no certificates of their own: an arc that no awake facet has
 * passed through, and whose ends stayed, has the crossings it had.
 *
 * A facet that wakes may for certain be back where it came from (alarms.h). Else it is looked at where it is now. Mostly it is in its cell,
 * too far from each side to have touched one within the step, and sleeps on. Or it has crossed one side, into a cell of which it
 * can have touched no other side than the one it came in by. Both ways of crossing are one event,
 * which changes the arcs concerned in a way known beforehand (repair.c), and at once. Of a facet of Q that has passed through an arc to
 * which something else has happened too the order is not known: that arc is led from cell to cell again at the end. Anything else,
 * several sides within reach, ties, is settled with care: the facet by descent, each arc that it may have passed through by leading
 * it again.
 */
#include "dymsum/sum.h"

/* How many cells a facet is followed back through before every edge is taken to have changed. */
#define FOLLOWED_CELLS 16

/* One in so many facets is many. */
#define MANY_OPEN 8

struct update {
    pir_sum *sum;
    uint32_t
        stamp; /* marks edges in sum->touched: this for one that an event has changed, one more for one to be led anew */
    uint32_t derive; /* edges in sum->queue, to be led anew */
    uint32_t passes; /* in sum->passes */
    bool all;        /* every edge is */
    bool failed;     /* out of memory */
};

void pir_expire_all(pir_sum *sum) {
    pir_certificates_expire(&sum->certificates, 0, pir_certificate_count(sum));
}

/* Edge e is to be led anew. */
static inline void note_edge(struct update *update, uint32_t e) {
    pir_sum *sum = update->sum;
    if (sum->touched[e] == PIR_INACTIVE)
        return;
    if (sum->touched[e] != update->stamp + 1)
        sum->queue[update->derive++] = e;
    sum->touched[e] = update->stamp + 1;
}

/* Facet f of P has crossed the arc of halfedge h of Q: its edges start there, or end, and go along. */
static void cross_of_p(struct update *update, uint32_t f, uint32_t h) {
    pir_sum *sum = update->sum;
    const pir_polytope *p = sum->pairing.p;
    bool done = true;
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++) {
        uint32_t half = p->loop[i], e = p->edge[half];
        if (sum->touched[e] == PIR_INACTIVE)
            continue;
        done &= p->edge_half[e] == half ? pir_move_start(sum, e, h) : pir_move_end(sum, e, h);
        if (sum->touched[e] < update->stamp)
            sum->touched[e] = update->stamp;
    }
    update->failed |= !done;
}

/* Facet g of Q has crossed the arc of halfedge `half` of P: noted until it is known what else has happened to its edge. */
static void note_crossing_of_q(struct update *update, uint32_t g, uint32_t half) {
    pir_sum *sum = update->sum;
    uint32_t e = sum->pairing.p->edge[half];
    if (sum->touched[e] >= update->stamp || update->passes == sum->pairing.q->facet_count) {
        note_edge(update, e);
    } else {
        sum->touched[e] = update->stamp;
        sum->passes[update->passes++] = (pir_suspect){g, half};
    }
}

/* The edges that a facet of Q has crossed, and nothing else has happened to, lead around it now. */
static void pass_facets(struct update *update) {
    pir_sum *sum = update->sum;
    for (uint32_t i = 0; i < update->passes && !update->all; i++) {
        uint32_t g = sum->passes[i].facet, half = sum->passes[i].crossed, e = sum->pairing.p->edge[half];
        if (sum->touched[e] == update->stamp)
            update->failed |= !pir_pass_facet(sum, e, g, sum->pairing.p->edge_half[e] == half);
    }
}

/* Spans beyond the farthest that is foretold are cut, and all are rounded down. The way here is not known. */
void pir_certify(pir_sum *sum, uint32_t i, const pir_expiry *expiry) {
    pir_certificate_file(&sum->step, &sum->certificates, i, pir_float_below(fmin(expiry->margin, 4)),
                   pir_float_below(fmin(expiry->ahead, (double)PIR_FARTHEST_PREDICTION)),
                   pir_float_below(fmin(-expiry->behind, (double)PIR_FARTHEST_PREDICTION)));
    pir_certificate_forget_previous(&sum->certificates, i);
}

/* Facet f of P may have touched one side or another. */
static void settle_of_p(struct update *update, uint32_t f) {
    pir_sum *sum = update->sum;
    const pir_polytope *p = sum->pairing.p;
    pir_trace trace;
    if (!update->all && pir_trace_fv(sum, f, &trace)) {
        pir_certify(sum, f, &trace.expiry);
        sum->statistics.repaired += trace.count;
        sum->pairing.fv[f] = trace.cell;
        for (uint32_t i = 0; i < trace.count; i++)
            cross_of_p(update, f, trace.crossed[i]);
        return;
    }
    pir_expiry expiry;
    uint32_t v = pir_descend_fv(sum, f, pir_rotated_normal(sum, f), sum->pairing.fv[f], &expiry);
    pir_certify(sum, f, &expiry);
    sum->statistics.repaired += v != sum->pairing.fv[f];
    sum->pairing.fv[f] = v;
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1] && !update->all; i++)
        note_edge(update, p->edge[p->loop[i]]);
}

/* Whether side `half` of a cell of P may have been touched by the normal of a facet of Q, turned back, within the step. */
static bool touches(const pir_sum *sum, uint32_t half, pir_vec3 turned_back, pir_vec3 motion) {
    pir_vec3 d = sum->pairing.p->direction[half];
    pir_expiry expiry = pir_expiry_never();
    pir_expiry_take_sign(&expiry, pir_vec_dot(turned_back, d), pir_vec_dot(motion, d));
    return !(expiry.ahead > (double)sum->step.reach_ahead && -expiry.behind > (double)sum->step.reach_behind);
}

/*
 * Follows facet g back from the cell of v through every side that it may have touched, and notes the edges of those: it came in through a
 * touched side, and so on.
 */
static void follow_back(struct update *update, uint32_t g, uint32_t v) {
    const pir_sum *sum = update->sum;
    const pir_polytope *p = sum->pairing.p;
    pir_vec3 turned_back = pir_turned_back_normal(sum, g), motion = pir_motion_back(sum, turned_back);
    uint32_t cells[FOLLOWED_CELLS] = {v}, count = 1;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t half = p->ring_start[cells[i]]; half < p->ring_start[cells[i] + 1]; half++) {
            if (!touches(sum, half, turned_back, motion))
                continue;
            note_edge(update, p->edge[half]);
            uint32_t known = 0;
            while (known < count && cells[known] != p->target[half])
                known++;
            if (known == FOLLOWED_CELLS) {
                update->all = true;
                return;
            }
            if (known == count)
                cells[count++] = p->target[half];
        }
}

/* Facet g of Q may have touched one side or another. */
static void settle_of_q(struct update *update, uint32_t g) {
    pir_sum *sum = update->sum;
    pir_trace trace;
    if (!update->all && pir_trace_vf(sum, g, &trace)) {
        pir_certify(sum, sum->q_facets.first_certificate + g, &trace.expiry);
        sum->statistics.repaired += trace.count;
        sum->pairing.vf[g] = trace.cell;
        for (uint32_t i = 0; i < trace.count; i++)
            note_crossing_of_q(update, g, trace.crossed[i]);
        return;
    }
    pir_expiry expiry;
    uint32_t v = pir_descend_vf(sum, g, sum->pairing.vf[g], &expiry);
    pir_certify(sum, sum->q_facets.first_certificate + g, &expiry);
    sum->statistics.repaired += v != sum->pairing.vf[g];
    sum->pairing.vf[g] = v;
    if (!update->all)
        follow_back(update, g, v);
}

/* How far back the last step lies, as looks take it: any distance for one that is too long to follow. */
static float step_reach(const pir_sum *sum) {
    double reach = fabs(sum->epoch.stride) * (1 + 0x1p-20);
    return reach <= PIR_TRACE_FARTHEST ? (float)reach : HUGE_VALF;
}

void pir_begin_step(pir_sum *sum) {
    const pir_epoch *epoch = &sum->epoch;
    float most = step_reach(sum);
    bool forwards = epoch->stride >= 0;
    sum->step = (pir_step){.reach_ahead = forwards ? 0 : most,
                               .reach_behind = forwards ? most : 0,
                               .ahead = pir_float_below(epoch->axial ? epoch->phase : epoch->path),
                               .behind = pir_float_above(epoch->axial ? epoch->phase : epoch->net),
                               .axial = epoch->axial};
    pir_certificates_set_now(&sum->certificates, sum->pairing.signs.rotation.unit);
    const pir_mat3 *r = &sum->pairing.signs.rotation.r;
    pir_vec3 back = pir_mat_apply_transposed(r, epoch->axis);
    for (int k = 0; k < 3; k++) {
        pir_vec3 column = {r->m[0][k], r->m[1][k], r->m[2][k]}, row = {r->m[k][0], r->m[k][1], r->m[k][2]};
        pir_pack_turned(column, pir_vec_cross(epoch->axis, column), sum->p_facets.turn[k]);
        pir_pack_turned(row, pir_vec_cross(row, back), sum->q_facets.turn[k]);
    }
}

/* Whether so many of the suspects are to be settled that leading every edge anew is less work than finding out which. */
static bool are_many_open(const pir_sum *sum, const pir_suspect *suspects, uint32_t count) {
    uint32_t open = 0;
    for (uint32_t i = 0; i < count; i++)
        open += suspects[i].crossed == PIR_NO_SIDE;
    return open > pir_certificate_count(sum) / MANY_OPEN;
}

/*
 * Takes those back that are where they came from: facets of P with their edges; those of Q are listed in sum->suspects, *ret_of_q of them.
 * What is left of alarms->woken is the others; returns their number.
 */
static uint32_t take_back(struct update *update, uint32_t expired, uint32_t *ret_of_q) {
    pir_sum *sum = update->sum;
    uint32_t *certificate = sum->certificates.expired, left = 0, of_q = 0;
    *ret_of_q = 0;
    // who never turned round never comes back
    if (!sum->epoch.reverses)
        return expired;
    for (uint32_t k = 0; k < expired; k++) {
        uint32_t i = certificate[k], half;
        bool of_p = i < sum->q_facets.first_certificate;
        const pir_facets *facets = of_p ? &sum->p_facets : &sum->q_facets;
        uint32_t f = i - facets->first_certificate;
        if (!pir_certificate_reuse(&sum->certificates, i, sum->epoch.phase, facets->twin, &half)) {
            certificate[left++] = i;
            continue;
        }
        facets->cell[f] = facets->target[half];
        if (of_p) {
            pir_journal_note(&sum->journal, f);
            cross_of_p(update, f, half);
            sum->statistics.repaired++;
        } else {
            sum->suspects[of_q++] = (pir_suspect){f, half};
        }
    }
    *ret_of_q = of_q;
    return left;
}

/* What is seen of facets of Q, after all of P: their edges tell then whether another event has touched them. */
static void take_along_of_q(struct update *update, const pir_suspect *suspects, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        pir_journal_note(&update->sum->journal, update->sum->q_facets.first_certificate + suspects[i].facet);
        if (suspects[i].crossed == PIR_NO_SIDE) {
            settle_of_q(update, suspects[i].facet);
        } else {
            note_crossing_of_q(update, suspects[i].facet, suspects[i].crossed);
            update->sum->statistics.repaired++;
        }
    }
}

static void take_along_of_p(struct update *update, const pir_suspect *suspects, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        pir_journal_note(&update->sum->journal, suspects[i].facet);
        if (suspects[i].crossed == PIR_NO_SIDE) {
            settle_of_p(update, suspects[i].facet);
        } else {
            cross_of_p(update, suspects[i].facet, suspects[i].crossed);
            update->sum->statistics.repaired++;
        }
    }
}

/* Finds where the facets that wake are, and brings along what they have touched or notes it. */
static void review(struct update *update, uint32_t expired) {
    pir_sum *sum = update->sum;
    uint32_t back, left = take_back(update, expired, &back), of_p = 0, of_q = 0;
    pir_suspect *seen = sum->suspects + back;
    if (left > 0) {
        const uint32_t *certificate = sum->certificates.expired;
        uint32_t left_of_p = 0;
        while (left_of_p < left && certificate[left_of_p] < sum->q_facets.first_certificate)
            left_of_p++;
        pir_begin_step(sum);
        // all looks before anything that depends on what they see: processors look ahead
        of_p = sum->kernels->review(&sum->p_facets, &sum->step, &sum->certificates, certificate, left_of_p, seen,
                                    &sum->pairing.signs.by_filter);
        of_q = sum->kernels->review(&sum->q_facets, &sum->step, &sum->certificates, certificate + left_of_p, left - left_of_p,
                                    seen + of_p, &sum->pairing.signs.by_filter);
        update->all |= are_many_open(sum, seen, of_p + of_q);
    }
    take_along_of_p(update, seen, of_p);
    take_along_of_q(update, sum->suspects, back);
    take_along_of_q(update, seen + of_p, of_q);
    pass_facets(update);
}

/* Above all that is in sum->touched. */
static uint32_t next_stamp(pir_sum *sum) {
    if (sum->stamp >= UINT32_MAX - 3) {
        sum->stamp = 0;
        for (uint32_t e = 0; e < sum->pairing.p->edge_count; e++)
            sum->touched[e] = sum->touched[e] == PIR_INACTIVE ? PIR_INACTIVE : 0;
    }
    return sum->stamp += 2;
}

pir_status pir_update_repair(pir_sum *sum) {
    uint32_t expired =
        pir_certificates_collect(&sum->certificates, sum->kernels, pir_certificate_count(sum), pir_turned_angle_of(&sum->epoch));
    sum->expired += expired;
    // what sleeps tells nothing of a step that dormant facets may have come in by
    bool jumped = sum->region.jumped;
    if (expired == 0 && !jumped)
        return PIR_OK;
    sum->statistics.checked += expired;
    struct update update = {.sum = sum, .stamp = next_stamp(sum)};
    update.all = jumped || !(step_reach(sum) < HUGE_VALF);
    review(&update, expired);
    for (uint32_t e = 0; update.all && e < sum->pairing.p->edge_count; e++)
        note_edge(&update, e);
    for (uint32_t i = 0; i < update.derive && !update.failed; i++)
        update.failed = !pir_derive_edge(sum, sum->queue[i]);
    return update.failed ? PIR_ERR_MEMORY : PIR_OK;
}
