/* SPDX-License-Identifier: MIT */
/*
 * Verdicts on two solids come from their convex pieces. Their insides meet where those of two pieces do, and what they
 * share is of the highest dimension that two pieces share. The shared volume is what pieces of B take of those of A.
 * The rest of each falls into connected parts: cells with disjoint insides that share a face are in one.
 *
 * Invariants of a body: its pieces have disjoint insides and their union is the solid; its box holds them.
 */
#include <pirouette/clash.h>
#include <pirouette/exact.h>
#include <pirouette/solid_query.h>

#include <math.h>

#include "base/sort.h"
#include "solid/body/solid.h"
#include "solid/clash/meeting.h"
#include "solid/space/boxes.h"
#include "solid/space/exact.h"

struct pir_clash_body {
    pir_allocator allocator;
    size_t memory;
    pir_pieces *pieces;
    pir_polytope **polytope;
    uint32_t count;
    pir_space_box box, *piece_box; /* of all of it, and of each piece */
    mpq_t volume;
    mpz_t scale; /* the least common denominator of its coordinates */
};

/* --- bodies --- */

/* A box around a polytope, whose vertices are doubles within an ulp of the exact ones. */
static pir_space_box box_around(const pir_polytope *polytope) {
    pir_space_box box = PIR_SPACE_BOX_EMPTY;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(polytope); v++) {
        const pir_vec3 at = pir_polytope_vertex(polytope, v);
        const double x[3] = {at.x, at.y, at.z};
        for (int k = 0; k < 3; k++) {
            const double room = fabs(x[k]) * 0x1p-50;
            box.low[k] = fmin(box.low[k], x[k] - room);
            box.high[k] = fmax(box.high[k], x[k] + room);
        }
    }
    return box;
}

static pir_status fill_pieces(pir_clash_body *body) {
    body->count = pir_pieces_count(body->pieces);
    body->polytope = PIR_ZEROED(&body->allocator, pir_polytope *, body->count);
    body->piece_box = PIR_ZEROED(&body->allocator, pir_space_box, body->count);
    if (!body->polytope || !body->piece_box)
        return PIR_ERR_MEMORY;
    body->box = PIR_SPACE_BOX_EMPTY;
    for (uint32_t i = 0; i < body->count; i++) {
        const pir_status status = pir_pieces_polytope(body->pieces, i, &body->polytope[i]);
        if (status != PIR_OK)
            return status;
        pir_meeting_scale(body->polytope[i], body->scale);
        const pir_space_box box = body->piece_box[i] = box_around(body->polytope[i]);
        for (int k = 0; k < 3; k++) {
            body->box.low[k] = fmin(body->box.low[k], box.low[k]);
            body->box.high[k] = fmax(body->box.high[k], box.high[k]);
        }
    }
    return PIR_OK;
}

pir_status pir_clash_body_create(const pir_solid *solid, const pir_solid_options *options, pir_clash_body **ret_body) {
    if (!solid || !ret_body)
        return PIR_ERR_ARGUMENT;
    pir_allocator allocator;
    pir_solid_options used;
    pir_status status = pir_solid_options_take(options, NULL, &allocator, &used);
    if (status != PIR_OK)
        return status;
    const pir_decompose_options how = {sizeof how, used.allocator, used.memory, used.report, PIR_DECOMPOSE_FACETS, 0,
                                       0};
    pir_clash_body *body = PIR_ZEROED(&allocator, pir_clash_body, 1);
    if (!body)
        return PIR_ERR_MEMORY;
    body->allocator = allocator;
    body->memory = used.memory;
    mpq_init(body->volume);
    mpz_init_set_ui(body->scale, 1);
    status = pir_solid_volume_exact(solid, body->volume);
    if (status == PIR_OK)
        status = pir_solid_decompose(solid, &how, NULL, &body->pieces);
    if (status == PIR_OK)
        status = fill_pieces(body);
    if (status == PIR_OK)
        *ret_body = body;
    else
        pir_clash_body_destroy(body);
    return status;
}

void pir_clash_body_destroy(pir_clash_body *body) {
    if (!body)
        return;
    const pir_allocator a = body->allocator;
    for (uint32_t i = 0; i < body->count && body->polytope; i++)
        pir_polytope_release(body->polytope[i]);
    PIR_FREE(&a, body->polytope, body->count);
    PIR_FREE(&a, body->piece_box, body->count);
    pir_pieces_destroy(body->pieces);
    mpq_clear(body->volume);
    mpz_clear(body->scale);
    PIR_FREE(&a, body, 1);
}

static double nearest_double(const mpq_t x) {
    mp_limb_t one_limb = 1;
    const pir_int one = {&one_limb, 1, 0};
    const pir_int top = pir_int_of_mpz(mpq_numref(x)), bottom = pir_int_of_mpz(mpq_denref(x));
    return pir_scaled_nearest_double(&top, &one, &bottom);
}

/* --- two bodies --- */

struct encounter {
    const pir_clash_body *body[2];
    pir_cell_meeting meeting;
    pir_piece_list cells[2]; /* of each body, by its pieces */
    mpq_t volume;            /* shared */
};

static void begin(struct encounter *e, const pir_clash_body *a, const pir_clash_body *b) {
    mpz_t scale;
    size_t bits = 1;
    *e = (struct encounter){.body = {a, b}};
    mpq_init(e->volume);
    mpz_init(scale);
    mpz_lcm(scale, a->scale, b->scale);
    for (int k = 0; k < 2; k++)
        for (uint32_t i = 0; i < e->body[k]->count; i++) {
            const size_t own = pir_meeting_bits(e->body[k]->polytope[i], scale);
            bits = own > bits ? own : bits;
        }
    pir_meeting_init(&e->meeting, &a->allocator, a->memory, scale, bits);
    mpz_clear(scale);
    for (int k = 0; k < 2; k++)
        for (uint32_t i = 0; i < e->body[k]->count && e->meeting.space.status == PIR_OK; i++)
            pir_piece_list_add(&e->cells[k], &e->meeting.space, pir_meeting_add(&e->meeting, e->body[k]->polytope[i]));
}

static void end(struct encounter *e) {
    pir_piece_list_finish(&e->cells[0], &e->meeting.space);
    pir_piece_list_finish(&e->cells[1], &e->meeting.space);
    pir_meeting_finish(&e->meeting);
    mpq_clear(e->volume);
}

/* The dimension of what the bodies share. */
static int dimension_of(struct encounter *e) {
    int dimension = -1;
    for (uint32_t i = 0; i < e->cells[0].count && dimension < 3; i++)
        for (uint32_t j = 0; j < e->cells[1].count && dimension < 3 && e->meeting.space.status == PIR_OK; j++)
            if (pir_space_box_meets(&e->body[0]->piece_box[i], &e->body[1]->piece_box[j])) {
                const int own = pir_meeting_common(&e->meeting, e->cells[0].cell[i], e->cells[1].cell[j]);
                dimension = own > dimension ? own : dimension;
            }
    return dimension;
}

static uint32_t root_of(uint32_t *into, uint32_t i) {
    while (into[i] != i)
        i = into[i] = into[into[i]];
    return i;
}

/* How many connected parts cells with disjoint insides make. */
static uint32_t count_parts(pir_cell_meeting *m, const pir_piece_list *list) {
    uint32_t *into = NULL, room = 0, parts = list->count;
    if (list->count == 0 || !pir_space_grow(&m->space, (void **)&into, &room, list->count, sizeof *into))
        return 0;
    for (uint32_t i = 0; i < list->count; i++)
        into[i] = i;
    for (uint32_t i = 0; i < list->count; i++)
        for (uint32_t j = 0; j < i && parts > 1 && m->space.status == PIR_OK; j++) {
            const uint32_t a = root_of(into, i), b = root_of(into, j);
            if (a == b || pir_meeting_common(m, list->cell[i], list->cell[j]) < 2)
                continue;
            into[a] = b;
            parts--;
        }
    pir_space_shrink(&m->space, into, room, sizeof *into);
    return parts;
}

/* Whether body k is cut into more parts by the other one; adds the volume taken to `taken`, unless that is NULL. */
static bool is_cut(struct encounter *e, int k, mpq_ptr taken) {
    pir_piece_list list = {0}, other = {0};
    for (uint32_t i = 0; i < e->cells[k].count; i++)
        pir_piece_list_add(&list, &e->meeting.space, e->cells[k].cell[i]);
    for (uint32_t j = 0; j < e->cells[1 - k].count; j++)
        pir_meeting_take_all(&e->meeting, &list, &other, e->cells[1 - k].cell[j], taken);
    const uint32_t parts = count_parts(&e->meeting, &list);
    const bool is = parts > 1 && parts > count_parts(&e->meeting, &e->cells[k]);
    pir_piece_list_finish(&list, &e->meeting.space);
    pir_piece_list_finish(&other, &e->meeting.space);
    return is;
}

/* The kind of bodies whose insides meet. */
static void judge_overlap(struct encounter *e, pir_clash_verdict *verdict) {
    verdict->a_is_cut = is_cut(e, 0, e->volume);
    verdict->a_in_b = mpq_equal(e->volume, e->body[0]->volume);
    verdict->b_in_a = mpq_equal(e->volume, e->body[1]->volume);
    const bool within = verdict->a_in_b || verdict->b_in_a;
    // a hole right through a body is no cut; one that is within the other may cut it, and is an envelope all the same
    verdict->b_is_cut = is_cut(e, 1, NULL);
    verdict->kind = verdict->a_in_b && verdict->b_in_a       ? PIR_CLASH_DUPLICATE
                    : within                                 ? PIR_CLASH_ENVELOPE
                    : verdict->a_is_cut || verdict->b_is_cut ? PIR_CLASH_PIERCING
                                                             : PIR_CLASH_PROTRUSION;
    verdict->volume = nearest_double(e->volume);
}

static pir_status judge(struct encounter *e, pir_clash_verdict *verdict) {
    verdict->dimension = dimension_of(e);
    verdict->kind = verdict->dimension < 0 ? PIR_CLASH_APART : PIR_CLASH_TOUCHING;
    if (verdict->dimension == 3)
        judge_overlap(e, verdict);
    return pir_space_outcome(&e->meeting.space, e->meeting.space.status, "clash", NULL);
}

/* How far apart bodies are that share no point, or how deep they are in each other. */
static pir_status measure(const pir_clash_body *a, const pir_clash_body *b, pir_workspace *workspace,
                          pir_clash_verdict *verdict) {
    pir_solid_query *query = NULL;
    const pir_pair_input input = pir_pair_input_default();
    pir_solid_distance distance;
    pir_solid_depth depth;
    pir_status status = pir_solid_query_create(a->pieces, b->pieces, &a->allocator, &query);
    if (status == PIR_OK && verdict->kind == PIR_CLASH_APART) {
        status = pir_solid_query_distance(query, workspace, &input, &distance);
        if (status == PIR_OK) {
            verdict->distance = distance.result.distance;
            verdict->point_a = distance.result.point_p;
            verdict->point_b = distance.result.point_q;
        }
    } else if (status == PIR_OK) {
        status = pir_solid_query_depth(query, workspace, &input, &depth);
        if (status == PIR_OK) {
            verdict->depth = depth.depth;
            verdict->direction = depth.normal;
        }
    }
    pir_solid_query_destroy(query);
    return status;
}

pir_status pir_clash(const pir_clash_body *a, const pir_clash_body *b, pir_workspace *workspace,
                     pir_clash_verdict *ret_verdict) {
    if (!a || !b || !workspace || !ret_verdict)
        return PIR_ERR_ARGUMENT;
    pir_clash_verdict verdict = {
        .dimension = -1, .volume_a = nearest_double(a->volume), .volume_b = nearest_double(b->volume)};
    pir_status status = PIR_OK;
    if (pir_space_box_meets(&a->box, &b->box)) {
        struct encounter e;
        begin(&e, a, b);
        status = judge(&e, &verdict);
        end(&e);
    }
    if (status == PIR_OK && verdict.kind != PIR_CLASH_TOUCHING)
        status = measure(a, b, workspace, &verdict);
    if (status == PIR_OK)
        *ret_verdict = verdict;
    return status;
}

pir_status pir_clash_volume_exact(const pir_clash_body *a, const pir_clash_body *b, mpq_t ret_volume) {
    if (!a || !b || !ret_volume)
        return PIR_ERR_ARGUMENT;
    struct encounter e;
    begin(&e, a, b);
    is_cut(&e, 0, e.volume);
    const pir_status status = pir_space_outcome(&e.meeting.space, e.meeting.space.status, "clash", NULL);
    if (status == PIR_OK)
        mpq_set(ret_volume, e.volume);
    end(&e);
    return status;
}

/* --- many bodies --- */

/* Lists the bodies after number `own` whose boxes meet a box, in their order; `found` has room for all. */
static uint32_t partners_of(const pir_boxes *boxes, const pir_space_box *box, uint32_t own, uint32_t *found) {
    const uint32_t all = pir_boxes_find(boxes, box, found);
    uint32_t count = 0;
    for (uint32_t i = 0; i < all; i++)
        if (found[i] > own)
            found[count++] = found[i];
    return count;
}

static bool comes_before(void *context, uint32_t a, uint32_t b) {
    (void)context;
    return a < b;
}

pir_status pir_clash_pairs(pir_clash_body *const *bodies, size_t count, double within, size_t capacity,
                           pir_clash_pair *ret_pairs, size_t *ret_count) {
    if ((!bodies && count > 0) || (!ret_pairs && capacity > 0) || !ret_count || within < 0)
        return PIR_ERR_ARGUMENT;
    if (!isfinite(within))
        return PIR_ERR_NOT_FINITE;
    if (count >= 1u << 30)
        return PIR_ERR_LIMIT;
    const pir_allocator a = count > 0 ? bodies[0]->allocator : pir_allocator_or_default(NULL);
    pir_boxes boxes = {0};
    pir_space_box *box = PIR_NEW(&a, pir_space_box, count);
    uint32_t *found = PIR_NEW(&a, uint32_t, 2 * count);
    for (size_t i = 0; i < count && box; i++)
        box[i] = bodies[i]->box;
    const bool good = count == 0 || (box && found && pir_boxes_init(&boxes, &a, box, (uint32_t)count));
    size_t pairs = 0;
    for (uint32_t i = 0; i < count && good; i++) {
        pir_space_box wide = box[i];
        for (int k = 0; k < 3; k++) {
            // one ulp more, since the sums are rounded
            wide.low[k] = nextafter(wide.low[k] - within, -HUGE_VAL);
            wide.high[k] = nextafter(wide.high[k] + within, HUGE_VAL);
        }
        const uint32_t partners = partners_of(&boxes, &wide, i, found);
        pir_sort(found, partners, found + count, comes_before, NULL);
        for (uint32_t k = 0; k < partners; k++, pairs++)
            if (pairs < capacity)
                ret_pairs[pairs] = (pir_clash_pair){i, found[k]};
    }
    pir_boxes_finish(&boxes, &a);
    PIR_FREE(&a, found, 2 * count);
    PIR_FREE(&a, box, count);
    if (!good)
        return PIR_ERR_MEMORY;
    *ret_count = pairs;
    return PIR_OK;
}
