/* SPDX-License-Identifier: MIT */
/*
 * The volumes that pieces add to a solid and lose of it. Lost is what all pieces leave of the solid's own convex
 * pieces.
 * Added is what those leave of each piece, and the pieces before it leave of that: so where pieces overlap, a point
 * counts once.
 */
#include <pirouette/exact.h>

#include "base/report.h"
#include "solid/body/solid.h"
#include "solid/clash/meeting.h"

/* The pieces given, and those of the solid after them. */
struct certified {
    const pir_allocator *allocator;
    pir_polytope **polytope; /* each with a reference */
    uint32_t *cell;
    uint32_t count, given, room;
};

static pir_status gather(struct certified *c, const pir_pieces *own, pir_polytope *const *pieces, size_t count) {
    const size_t all = count + pir_pieces_count(own);
    if (all >= UINT32_MAX / 2)
        return PIR_ERR_LIMIT;
    c->room = (uint32_t)all;
    c->polytope = PIR_ZEROED(c->allocator, pir_polytope *, all);
    c->cell = PIR_ZEROED(c->allocator, uint32_t, all);
    if (!c->polytope || !c->cell)
        return PIR_ERR_MEMORY;
    for (size_t i = 0; i < count; i++)
        if (pir_polytope_dimension(pieces[i]) == 3)
            c->polytope[c->count++] = pir_polytope_retain(pieces[i]);
    c->given = c->count;
    pir_status status = PIR_OK;
    for (uint32_t i = 0; i < pir_pieces_count(own) && status == PIR_OK; i++) {
        status = pir_pieces_polytope(own, i, &c->polytope[c->count]);
        c->count += status == PIR_OK;
    }
    return status;
}

static void finish(struct certified *c) {
    for (uint32_t i = 0; i < c->count && c->polytope; i++)
        pir_polytope_release(c->polytope[i]);
    PIR_FREE(c->allocator, c->polytope, c->room);
    PIR_FREE(c->allocator, c->cell, c->room);
}

/* The volumes of what cells from `from` on up to `to` are left with once others are taken away. */
static void measure(pir_cell_meeting *m, const struct certified *c, bool of_given, mpq_t volume) {
    pir_piece_list list = {0}, other = {0};
    const uint32_t first = of_given ? 0 : c->given, end = of_given ? c->given : c->count;
    for (uint32_t i = first; i < end && m->space.status == PIR_OK; i++) {
        m->space.stage.done++;
        list.count = 0;
        pir_piece_list_add(&list, &m->space, c->cell[i]);
        // of the pieces given those before count, of the solid's, which are disjoint, none
        for (uint32_t k = 0; k < c->count && list.count > 0 && m->space.status == PIR_OK; k++)
            if (of_given ? k < i || k >= c->given : k < c->given)
                pir_meeting_take_all(m, &list, &other, c->cell[k], NULL);
        for (uint32_t k = 0; k < list.count && m->space.status == PIR_OK; k++)
            pir_meeting_add_volume(m, list.cell[k], volume);
    }
    pir_piece_list_finish(&list, &m->space);
    pir_piece_list_finish(&other, &m->space);
}

static pir_status certify(struct certified *c, const pir_solid_options *options, mpq_t added, mpq_t lost) {
    pir_cell_meeting meeting;
    mpz_t scale;
    size_t bits = 1;
    mpz_init_set_ui(scale, 1);
    for (uint32_t i = 0; i < c->count; i++)
        pir_meeting_scale(c->polytope[i], scale);
    for (uint32_t i = 0; i < c->count; i++) {
        const size_t own = pir_meeting_bits(c->polytope[i], scale);
        bits = own > bits ? own : bits;
    }
    pir_meeting_init(&meeting, options->allocator, options->memory, scale, bits);
    mpz_clear(scale);
    pir_space_begin_stage(&meeting.space, "taking pieces away", c->count);
    for (uint32_t i = 0; i < c->count && meeting.space.status == PIR_OK; i++)
        c->cell[i] = pir_meeting_add(&meeting, c->polytope[i]);
    measure(&meeting, c, true, added);
    measure(&meeting, c, false, lost);
    const pir_status status = pir_space_outcome(&meeting.space, meeting.space.status, "certify", options->report);
    pir_meeting_finish(&meeting);
    return status;
}

pir_status pir_solid_certify_exact(const pir_solid *solid, pir_polytope *const *pieces, size_t count,
                                   const pir_solid_options *options, mpq_t ret_added, mpq_t ret_lost) {
    if (!solid || (!pieces && count > 0) || !ret_added || !ret_lost)
        return PIR_ERR_ARGUMENT;
    pir_allocator allocator;
    pir_solid_options used;
    pir_status status = pir_solid_options_take(options, NULL, &allocator, &used);
    if (status != PIR_OK)
        return status;
    const pir_decompose_options how = {sizeof how, used.allocator, used.memory, used.report, PIR_DECOMPOSE_FACETS, 0,
                                       0};
    pir_pieces *own = NULL;
    struct certified c = {.allocator = used.allocator};
    mpq_t added, lost;
    mpq_inits(added, lost, NULL);
    status = pir_solid_decompose(solid, &how, NULL, &own);
    if (status == PIR_OK)
        status = gather(&c, own, pieces, count);
    if (status == PIR_OK)
        status = certify(&c, &used, added, lost);
    if (status == PIR_OK) {
        mpq_set(ret_added, added);
        mpq_set(ret_lost, lost);
    }
    mpq_clears(added, lost, NULL);
    finish(&c);
    pir_pieces_destroy(own);
    return status;
}
