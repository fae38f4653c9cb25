/* SPDX-License-Identifier: MIT */
/*
 * The update: find the facets that may have left their cells, and repair the edges that they touched.
 *
 * Why a step of any size is safe. Between two rotations let R turn continuously, as the epoch measures it (epoch.h).
 * The pairing changes only where a facet, a point of one Gaussian map, passes through an arc of the other, and so
 * leaves its cell. A facet whose certificate has not expired has stayed in its cell through the whole step. So
 * crossings need no certificates of their own: an arc through which no facet has passed, and whose ends stayed in their
 * cells, keeps its crossings.
 *
 * A facet whose certificate has expired may certainly be back in its previous cell (certificates.h). If not, it is
 * checked where it is now. Mostly it is in its cell, too far from each side to have touched one within the step, and is
 * certified anew. Or it has crossed one side, into a cell of which it touched no other side. Both kinds of crossing are
 * one event, which changes the arcs concerned in a known way (repair.c), and at once. When a facet of Q has passed
 * through an arc that another event has touched too, the order of the two is not known. That edge is derived again at
 * the end. All else, several sides within reach or ties, takes the slow way: the facet is located by descent, and each
 * edge whose arc it may have passed through is derived again.
 */
#include "dymsum/update/update.h"

#include "dymsum/pairing/predicates.h"
#include "dymsum/rebuild/descent.h"
#include "dymsum/update/large.h"
#include "dymsum/update/repair.h"
#include "dymsum/update/trace.h"

/* A facet is followed back through at most so many cells. Beyond that all edges are derived again. */
#define FOLLOWED_CELLS 16

/* So many expired certificates of a large sum are reviewed, then traced: the memory that the review read is cached. */
#define REVIEWED 256

struct update {
    pir_tracked *tracked;
    pir_moves *moves;        /* NULL: ends of arcs are moved at once */
    uint32_t stamp;          /* in tracked->touched: an event has changed the edge; stamp + 1: it is derived anew */
    uint32_t derive;         /* edges in work.queue, to be derived anew */
    uint32_t passes;         /* in work.passes */
    uint32_t traces, traced; /* in work.traces, and how many of them have been applied */
    bool all;                /* every edge is to be derived anew */
    bool failed;             /* out of memory */
    bool large;              /* see large.h */
};

/* Edge e is to be derived again. */
static inline void note_edge(struct update *update, uint32_t e) {
    pir_tracked *tracked = update->tracked;
    if (tracked->touched[e] == PIR_INACTIVE)
        return;
    if (tracked->touched[e] != update->stamp + 1)
        tracked->work->queue[update->derive++] = e;
    tracked->touched[e] = update->stamp + 1;
}

/* Facet f of P has crossed the arc of halfedge h of Q: the edges that start or end there follow. */
static void cross_of_p(struct update *update, uint32_t f, uint32_t h) {
    pir_tracked *tracked = update->tracked;
    const pir_polytope *p = tracked->pairing.p;
    bool done = true;
    if (update->moves) {
        pir_moves_queue(update->moves, f, h);
        return;
    }
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++) {
        const pir_across side = p->across[i];
        uint32_t e = side.edge;
        if (tracked->touched[e] == PIR_INACTIVE)
            continue;
        done &= side.leaves ? pir_move_start(tracked, e, h) : pir_move_end(tracked, e, h);
        if (tracked->touched[e] < update->stamp)
            tracked->touched[e] = update->stamp;
    }
    update->failed |= !done;
}

/* Facet g of Q has crossed the arc of halfedge `half` of P. It is noted until all events of that edge are known. */
static void note_crossing_of_q(struct update *update, uint32_t g, uint32_t half) {
    pir_tracked *tracked = update->tracked;
    uint32_t e = tracked->pairing.p->edge[half];
    if (tracked->touched[e] >= update->stamp || update->passes == tracked->pairing.q->facet_count) {
        note_edge(update, e);
    } else {
        tracked->touched[e] = update->stamp;
        tracked->work->passes[update->passes++] = (pir_suspect){g, half};
    }
}

/* Repairs the edges that one facet of Q has crossed and no other event has touched. */
static void pass_facets(struct update *update) {
    pir_tracked *tracked = update->tracked;
    for (uint32_t i = 0; i < update->passes && !update->all; i++) {
        uint32_t g = tracked->work->passes[i].facet, half = tracked->work->passes[i].crossed,
                 e = tracked->pairing.p->edge[half];
        if (tracked->touched[e] == update->stamp)
            update->failed |= !pir_pass_facet(tracked, e, g, tracked->pairing.p->edge_half[e] == half);
    }
}

/*
 * The trace of facet f of P or of Q, the next that may have touched several sides. NULL where it is to be located by
 * descent from the cell where it was before the step. *made: where there is room for a trace.
 */
static const pir_trace *next_trace(struct update *update, bool of_p, uint32_t f, pir_trace *made) {
    pir_tracked *tracked = update->tracked;
    const pir_trace *trace = made;
    if (update->traced < update->traces)
        trace = &tracked->work->traces[update->traced++];
    else if (!update->all)
        pir_trace_one(tracked, of_p, f, made);
    else
        return NULL;
    if (update->all) {
        *(of_p ? &tracked->pairing.fv[f] : &tracked->pairing.vf[f]) = trace->from;
        return NULL;
    }
    tracked->pairing.signs.by_filter += trace->signs;
    return trace->count != PIR_TRACE_UNKNOWN ? trace : NULL;
}

/* Repairs or notes the edges of facet f of P, which may have touched several sides. */
static void settle_of_p(struct update *update, uint32_t f) {
    pir_tracked *tracked = update->tracked;
    pir_pairing *pairing = &tracked->pairing;
    const pir_polytope *p = pairing->p;
    pir_trace made;
    const pir_trace *trace = next_trace(update, true, f, &made);
    if (trace) {
        tracked->statistics.repaired += trace->count;
        for (uint32_t i = 0; i < trace->count; i++)
            cross_of_p(update, f, trace->crossed[i]);
        for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1] && trace->count > 1; i++)
            pir_journal_note_edge(&tracked->journal, p->across[i].edge);
        return;
    }
    pir_expiry expiry;
    uint32_t v = pir_descend_fv(tracked, f, pir_rotated_normal(pairing, f), pairing->fv[f], &expiry);
    pir_tracked_certify(tracked, f, &expiry);
    tracked->statistics.repaired += v != pairing->fv[f];
    pairing->fv[f] = v;
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1] && !update->all; i++)
        note_edge(update, p->edge[p->loop[i]]);
}

/* Whether the normal of a facet of Q, rotated back, may have touched side `half` of a cell of P within the step. */
static bool touches(const pir_tracked *tracked, uint32_t half, pir_vec3 turned_back, pir_vec3 motion) {
    pir_vec3 d = tracked->pairing.p->direction[half];
    pir_expiry expiry = pir_expiry_never();
    pir_expiry_take_sign(&expiry, pir_vec_dot(turned_back, d), pir_vec_dot(motion, d));
    return !(expiry.ahead > (double)tracked->step.reach_ahead && -expiry.behind > (double)tracked->step.reach_behind);
}

/*
 * Follows facet g back from the cell of v through every side that it may have touched, and notes the edges of those: it
 * came in through such a side, and into that cell through another, and so on.
 */
static void follow_back(struct update *update, uint32_t g, uint32_t v) {
    const pir_tracked *tracked = update->tracked;
    const pir_polytope *p = tracked->pairing.p;
    pir_vec3 turned_back = pir_turned_back_normal(&tracked->pairing, g), motion = pir_motion_back(tracked, turned_back);
    uint32_t cells[FOLLOWED_CELLS] = {v}, count = 1;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t half = p->ring_start[cells[i]]; half < p->ring_start[cells[i] + 1]; half++) {
            if (!touches(tracked, half, turned_back, motion))
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

/* Journals the edge of P between two vertices, if there is one: more than one facet may have passed it. */
static void note_side(pir_tracked *tracked, uint32_t from, uint32_t to) {
    const pir_polytope *p = tracked->pairing.p;
    for (uint32_t half = p->ring_start[from]; half < p->ring_start[from + 1]; half++)
        if (p->target[half] == to)
            pir_journal_note_edge(&tracked->journal, p->edge[half]);
}

/* Notes the edges that a facet of Q has passed, one after another, and those of the shortest way. */
static void note_way_of_q(pir_tracked *tracked, const pir_trace *trace) {
    note_side(tracked, trace->from, trace->cell);
    for (uint32_t i = 0; i < trace->count; i++)
        pir_journal_note_edge(&tracked->journal, tracked->pairing.p->edge[trace->crossed[i]]);
}

/* Notes the edges of P that facet g of Q, which may have touched several sides, may have crossed. */
static void settle_of_q(struct update *update, uint32_t g) {
    pir_tracked *tracked = update->tracked;
    pir_pairing *pairing = &tracked->pairing;
    pir_trace made;
    const pir_trace *trace = next_trace(update, false, g, &made);
    if (trace) {
        tracked->statistics.repaired += trace->count;
        if (trace->count > 1)
            note_way_of_q(tracked, trace);
        for (uint32_t i = 0; i < trace->count; i++)
            note_crossing_of_q(update, g, trace->crossed[i]);
        return;
    }
    pir_expiry expiry;
    uint32_t v = pir_descend_vf(tracked, g, pairing->vf[g], &expiry);
    pir_tracked_certify(tracked, tracked->q_facets.first_certificate + g, &expiry);
    tracked->statistics.repaired += v != pairing->vf[g];
    note_side(tracked, pairing->vf[g], v);
    pairing->vf[g] = v;
    if (!update->all)
        follow_back(update, g, v);
}

/*
 * Returns facets that are certainly back in their previous cells to those. The edges of those of P are repaired. Those
 * of Q are listed in work.suspects, *ret_of_q of them. The others stay in certificates.expired; returns their number.
 */
static uint32_t return_facets(struct update *update, uint32_t expired, uint32_t *ret_of_q) {
    pir_tracked *tracked = update->tracked;
    uint32_t *certificate = tracked->certificates.expired, due = 0, of_q = 0;
    *ret_of_q = 0;
    // while the motion has not reversed, no facet returns
    if (!tracked->epoch.reverses)
        return expired;
    for (uint32_t k = 0; k < expired; k++) {
        uint32_t i = certificate[k], half;
        bool of_p = i < tracked->q_facets.first_certificate;
        const pir_facets *facets = of_p ? &tracked->p_facets : &tracked->q_facets;
        uint32_t f = i - facets->first_certificate;
        if (!pir_certificate_reuse(&tracked->certificates, i, tracked->epoch.phase, facets->twin, &half)) {
            certificate[due++] = i;
            continue;
        }
        facets->cell[f] = facets->target[half];
        if (of_p) {
            pir_journal_note(&tracked->journal, f);
            cross_of_p(update, f, half);
            tracked->statistics.repaired++;
        } else {
            tracked->work->suspects[of_q++] = (pir_suspect){f, half};
        }
    }
    *ret_of_q = of_q;
    return due;
}

/*
 * Applies the findings of a review on facets of Q. All of P come first, so that each edge shows whether another event
 * has touched it.
 */
static void apply_of_q(struct update *update, const pir_suspect *suspects, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        pir_journal_note(&update->tracked->journal, update->tracked->q_facets.first_certificate + suspects[i].facet);
        if (suspects[i].crossed == PIR_NO_SIDE) {
            settle_of_q(update, suspects[i].facet);
        } else {
            note_crossing_of_q(update, suspects[i].facet, suspects[i].crossed);
            update->tracked->statistics.repaired++;
        }
    }
}

/* Applies the findings of a review on facets of P. In a large sum the ends of arcs are moved in turns. */
static void apply_of_p(struct update *update, const pir_suspect *suspects, uint32_t count) {
    pir_moves moves;
    if (update->large) {
        pir_moves_begin(&moves, update->tracked, update->stamp);
        update->moves = &moves;
    }
    for (uint32_t i = 0; i < count; i++) {
        pir_journal_note(&update->tracked->journal, suspects[i].facet);
        if (suspects[i].crossed == PIR_NO_SIDE) {
            settle_of_p(update, suspects[i].facet);
        } else {
            cross_of_p(update, suspects[i].facet, suspects[i].crossed);
            update->tracked->statistics.repaired++;
        }
    }
    if (update->large)
        update->failed |= !pir_moves_finish(&moves);
    update->moves = NULL;
}

/* Whether so many of the suspects are still to be followed or located that all edges are derived again. */
static bool are_many_open(const pir_tracked *tracked, const pir_suspect *suspects, uint32_t count) {
    uint32_t open = 0;
    for (uint32_t i = 0; i < count; i++)
        open += suspects[i].crossed == PIR_NO_SIDE;
    return open > pir_certificate_count(tracked) / PIR_MANY_OPEN;
}

/* Reviews expired certificates, of P or of Q. Returns how many suspects it has listed. */
static inline uint32_t review_part(const struct update *update, bool of_p, pir_due due, pir_suspect *ret_suspects) {
    pir_tracked *tracked = update->tracked;
    // all checks come before anything that depends on their results, so that a processor can overlap them
    return tracked->kernels->review(of_p ? &tracked->p_facets : &tracked->q_facets, &tracked->step,
                                    &tracked->certificates, &due, ret_suspects, &tracked->pairing.signs.by_filter);
}

/* Reviews all of P or of Q in parts. Each part is traced as soon as it was read. */
static uint32_t review_and_trace(struct update *update, bool of_p, const uint32_t *expired, uint32_t count,
                                 pir_suspect *ret_suspects) {
    pir_tracked *tracked = update->tracked;
    const uint32_t most = pir_traces_most(pir_certificate_count(tracked));
    uint32_t listed = 0;
    for (uint32_t k = 0; k < count; k += REVIEWED) {
        const uint32_t batch = count - k < REVIEWED ? count - k : REVIEWED;
        pir_suspect *suspects = ret_suspects + listed;
        uint32_t found = review_part(update, of_p, (pir_due){expired + k, batch, count - k - batch, k > 0}, suspects);
        listed += found;
        if (!update->all)
            update->traces += pir_trace_open(tracked, of_p, suspects, found, most - update->traces,
                                             tracked->work->traces + update->traces);
    }
    return listed;
}

static inline uint32_t review_all(struct update *update, bool of_p, const uint32_t *expired, uint32_t count,
                                  pir_suspect *ret_suspects) {
    return update->large ? review_and_trace(update, of_p, expired, count, ret_suspects)
                         : review_part(update, of_p, (pir_due){expired, count, 0, false}, ret_suspects);
}

/* Locates the facets whose certificates have expired, and repairs or notes the edges that they have touched. */
static void review(struct update *update, uint32_t expired) {
    pir_tracked *tracked = update->tracked;
    uint32_t back, due = return_facets(update, expired, &back), of_p = 0, of_q = 0;
    pir_suspect *seen = tracked->work->suspects + back;
    if (due > 0) {
        const uint32_t *certificate = tracked->certificates.expired;
        uint32_t due_of_p = 0;
        while (due_of_p < due && certificate[due_of_p] < tracked->q_facets.first_certificate)
            due_of_p++;
        pir_tracked_begin_step(tracked);
        of_p = review_all(update, true, certificate, due_of_p, seen);
        of_q = review_all(update, false, certificate + due_of_p, due - due_of_p, seen + of_p);
        update->all |= are_many_open(tracked, seen, of_p + of_q);
    }
    apply_of_p(update, seen, of_p);
    apply_of_q(update, tracked->work->suspects, back);
    apply_of_q(update, seen + of_p, of_q);
    pass_facets(update);
}

/* A stamp greater than all in `touched`. */
static uint32_t next_stamp(pir_tracked *tracked) {
    if (tracked->stamp >= UINT32_MAX - 3) {
        tracked->stamp = 0;
        for (uint32_t e = 0; e < tracked->pairing.p->edge_count; e++)
            tracked->touched[e] = tracked->touched[e] == PIR_INACTIVE ? PIR_INACTIVE : 0;
    }
    return tracked->stamp += 2;
}

/* Derives the edges anew that are to be. */
static void derive(struct update *update) {
    pir_tracked *tracked = update->tracked;
    const uint32_t *edge = tracked->work->queue;
    for (uint32_t i = 0; i < update->derive; i++)
        pir_journal_note_edge(&tracked->journal, edge[i]);
    if (update->large)
        update->failed = !pir_derive_edges(tracked, edge, update->derive);
    for (uint32_t i = 0; i < update->derive && !update->large && !update->failed; i++)
        update->failed = !pir_derive_edge(tracked, edge[i]);
}

pir_status pir_update_repair(pir_tracked *tracked, bool jumped) {
    pir_journal_note_step(&tracked->journal);
    if (tracked->certificates.expired_all)
        pir_tracked_lay_out_certificates(tracked);
    uint32_t expired = pir_kernels_collect(tracked->kernels, &tracked->certificates, pir_certificate_count(tracked),
                                           pir_turned_angle_of(&tracked->epoch));
    tracked->expired_in_epoch += expired;
    if (expired == 0 && !jumped)
        return PIR_OK;
    tracked->statistics.checked += expired;
    struct update update = {.tracked = tracked, .stamp = next_stamp(tracked), .large = pir_sum_is_large(tracked)};
    update.all = jumped || !(pir_epoch_reach(&tracked->epoch) < HUGE_VALF);
    review(&update, expired);
    for (uint32_t e = 0; update.all && e < tracked->pairing.p->edge_count; e++)
        note_edge(&update, e);
    if (!update.failed)
        derive(&update);
    return update.failed ? PIR_ERR_MEMORY : PIR_OK;
}
