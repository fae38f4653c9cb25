/* SPDX-License-Identifier: MIT */
/* Memory of a tracked pairing, and its certificates. See tracked.h. */
#include "dymsum/pairing/tracked.h"

#include "base/processor.h"
#include "dymsum/pairing/crossings.h"

static uint32_t most(uint32_t a, uint32_t b) {
    return a > b ? a : b;
}

/* --- the room --- */

static pir_layout layout_of_work(pir_pairing_work *work) {
    uint32_t queue = most(most(work->facets_p, work->facets_q), work->edges);
    return (pir_layout){
        {PIR_ROW(work->queue, queue), PIR_ROW(work->met, work->edges), PIR_ROW(work->rotated, work->facets_p),
         PIR_ROW(work->suspects, work->facets_p + work->facets_q), PIR_ROW(work->passes, work->facets_q),
         PIR_ROW(work->traces, pir_traces_most(work->facets_p + work->facets_q))}};
}

static void destroy_room(void *at, const pir_allocator *allocator) {
    pir_sum_room *room = at;
    pir_layout layout = layout_of_work(&room->work);
    pir_layout_free(allocator, &layout);
    pir_signs_room_finish(&room->signs, allocator);
    PIR_FREE(allocator, room, 1);
}

/* Makes work space for two more operands. */
static bool reserve_work(pir_pairing_work *work, const pir_allocator *allocator, const pir_polytope *p,
                         const pir_polytope *q) {
    uint32_t edges = most(p->edge_count, q->edge_count);
    pir_pairing_work fresh = {.facets_p = most(p->facet_count, work->facets_p),
                              .facets_q = most(q->facet_count, work->facets_q),
                              .edges = most(edges, work->edges)};
    if (work->queue && p->facet_count <= work->facets_p && q->facet_count <= work->facets_q && edges <= work->edges)
        return true;
    pir_layout layout = layout_of_work(&fresh), old = layout_of_work(work);
    if (!pir_layout_new(allocator, &layout))
        return false;
    pir_layout_free(allocator, &old);
    *work = fresh;
    return true;
}

pir_sum_room *pir_sum_room_of(pir_scratch *scratch, const pir_polytope *p, const pir_polytope *q) {
    const pir_allocator *a = &scratch->allocator;
    pir_sum_room *room = pir_scratch_room(scratch, PIR_ROOM_SUM, sizeof *room, destroy_room);
    bool done = room && reserve_work(&room->work, a, p, q) &&
                pir_signs_reserve(&room->signs, a, most(p->exact_edge.stride, p->exact_normal.stride),
                                  most(q->exact_edge.stride, q->exact_normal.stride)) == PIR_OK;
    return done ? room : NULL;
}

/* --- a pairing --- */

/* The arrays, but those of the certificates and of the crossings' slots. */
static pir_layout layout_of(pir_tracked *tracked) {
    pir_pairing *pairing = &tracked->pairing;
    const pir_polytope *p = pairing->p, *q = pairing->q;
    return (pir_layout){{PIR_ROW(pairing->fv, p->facet_count), PIR_ROW(pairing->vf, q->facet_count),
                         PIR_ROW(pairing->crossings.first, p->edge_count), PIR_ROW(tracked->touched, p->edge_count)}};
}

/* The facets of p, in the cells `cell` of q. */
static void link_facets(pir_facets *facets, const pir_polytope *p, const pir_polytope *q, uint32_t *cell) {
    facets->count = p->facet_count;
    facets->normal = p->normal4;
    facets->ring_start = q->ring_start;
    facets->ring_block = q->ring_block;
    facets->single = q->half_count > 0 && q->ring_block[q->vertex_count] == q->vertex_count;
    facets->target = q->target;
    facets->twin = q->twin;
    facets->ring = q->ring;
    facets->cell = cell;
}

void pir_tracked_link_facets(pir_tracked *tracked) {
    const pir_pairing *pairing = &tracked->pairing;
    link_facets(&tracked->p_facets, pairing->p, pairing->q, pairing->fv);
    link_facets(&tracked->q_facets, pairing->q, pairing->p, pairing->vf);
    tracked->q_facets.first_certificate = pairing->p->facet_count;
}

static bool allocate(pir_tracked *tracked) {
    pir_pairing *pairing = &tracked->pairing;
    const pir_allocator *a = &pairing->allocator;
    pir_layout layout = layout_of(tracked);
    if (!pir_layout_new(a, &layout) ||
        !pir_certificates_init(&tracked->certificates, a, pir_certificate_count(tracked)))
        return false;
    pir_tracked_link_facets(tracked);
    return pir_crossings_reserve(tracked, pir_crossings_expected(pairing->p, pairing->q));
}

pir_status pir_tracked_init(pir_tracked *tracked, const pir_sum_parts *parts) {
    pir_pairing *pairing = &tracked->pairing;
    *pairing = (pir_pairing){.allocator = *parts->allocator,
                             .p = pir_polytope_retain(parts->p),
                             .q = pir_polytope_retain(parts->q),
                             .generation = 1};
    tracked->kernels = pir_processor_best()->kernels;
    pir_journal_init(&tracked->journal);
    pairing->scratch = parts->scratch ? pir_scratch_retain(parts->scratch) : pir_scratch_new(parts->allocator);
    pir_sum_room *room = pairing->scratch ? pir_sum_room_of(pairing->scratch, parts->p, parts->q) : NULL;
    if (!room || !allocate(tracked))
        return PIR_ERR_MEMORY;
    pir_signs_init(&pairing->signs, &room->signs);
    tracked->work = &room->work;
    return pir_rotation_set(&pairing->signs.rotation, parts->rotation);
}

void pir_tracked_finish(pir_tracked *tracked) {
    pir_pairing *pairing = &tracked->pairing;
    const pir_allocator *a = &pairing->allocator;
    pir_layout layout = layout_of(tracked);
    pir_crossings_finish(tracked);
    pir_layout_free(a, &layout);
    pir_certificates_finish(&tracked->certificates, a);
    pir_journal_finish(&tracked->journal, a);
    pir_scratch_release(pairing->scratch);
    pir_polytope_release(pairing->p);
    pir_polytope_release(pairing->q);
}

void pir_tracked_begin_step(pir_tracked *tracked) {
    const pir_epoch *epoch = &tracked->epoch;
    float most = pir_epoch_reach(&tracked->epoch);
    bool forwards = epoch->stride >= 0;
    tracked->step = (pir_step){.reach_ahead = forwards ? 0 : most,
                               .reach_behind = forwards ? most : 0,
                               .ahead = pir_float_below(epoch->axial ? epoch->phase : epoch->path),
                               .behind = pir_float_above(epoch->axial ? epoch->phase : epoch->net),
                               .axial = epoch->axial};
    pir_certificates_set_now(&tracked->certificates, tracked->pairing.signs.rotation.unit);
    pir_tracked_turn_facets(tracked);
}

void pir_tracked_turn_facets(pir_tracked *tracked) {
    const pir_epoch *epoch = &tracked->epoch;
    const pir_mat3 *r = &tracked->pairing.signs.rotation.r;
    pir_vec3 back = pir_mat_apply_transposed(r, epoch->axis);
    for (int k = 0; k < 3; k++) {
        pir_vec3 column = {r->m[0][k], r->m[1][k], r->m[2][k]}, row = {r->m[k][0], r->m[k][1], r->m[k][2]};
        pir_pack_turned(column, pir_vec_cross(epoch->axis, column), tracked->p_facets.turn[k]);
        pir_pack_turned(row, pir_vec_cross(row, back), tracked->q_facets.turn[k]);
    }
}

static double least(double a, double b) {
    return a < b ? a : b;
}

/* Predictions beyond the farthest are cut, and all are rounded down. How the facet came here is not known. */
void pir_tracked_certify(pir_tracked *tracked, uint32_t i, const pir_expiry *expiry) {
    pir_certificate_file(&tracked->step, &tracked->certificates, i, pir_float_below(least(expiry->margin, 4)),
                         pir_float_below(least(expiry->ahead, (double)PIR_FARTHEST_PREDICTION)),
                         pir_float_below(least(-expiry->behind, (double)PIR_FARTHEST_PREDICTION)));
    pir_certificate_forget_previous(&tracked->certificates, i);
}

void pir_tracked_expire_all(pir_tracked *tracked) {
    pir_certificates_expire(&tracked->certificates);
}

/* Facets that a region leaves out have certificates that never expire. */
static void clear_inactive(pir_certificates *certificates, const pir_facets *facets) {
    for (uint32_t f = 0; f < facets->count; f++)
        if (facets->cell[f] == PIR_NO_PAIR)
            pir_certificate_clear(certificates, facets->first_certificate + f);
}

void pir_tracked_lay_out_certificates(pir_tracked *tracked) {
    pir_certificates_lay_out(&tracked->certificates, pir_certificate_count(tracked));
    clear_inactive(&tracked->certificates, &tracked->p_facets);
    clear_inactive(&tracked->certificates, &tracked->q_facets);
}
