/* SPDX-License-Identifier: MIT */
/* See plan_sums.h. */
#include "plan/plan_sums.h"

#include <pirouette/exact.h>
#include <pirouette/sum.h>

#include "base/report.h"
#include "plan/plan_cell.h"

/* --- pieces --- */

static pir_status add_solid(pir_plan_space *space, const pir_solid *solid, uint32_t body, pir_plan_pieces *pieces) {
    const pir_decompose_options how = {
        sizeof how, &space->allocator, space->limit - space->used, NULL, PIR_DECOMPOSE_BEST, 0, 0};
    pir_pieces *own = NULL;
    pir_status status = pir_solid_decompose(solid, &how, NULL, &own);
    const uint32_t count = status == PIR_OK ? pir_pieces_count(own) : 0;
    if (status == PIR_OK &&
        (!pir_plan_grow(space, (void **)&pieces->at, &pieces->room, pieces->count + count, sizeof *pieces->at) ||
         !pir_plan_grow(space, (void **)&pieces->body, &pieces->body_room, pieces->count + count,
                        sizeof *pieces->body)))
        status = space->status;
    for (uint32_t i = 0; i < count && status == PIR_OK; i++) {
        status = pir_pieces_polytope(own, i, &pieces->at[pieces->count]);
        pieces->body[pieces->count] = body;
        pieces->count += status == PIR_OK;
    }
    pir_pieces_destroy(own);
    return status;
}

pir_status pir_plan_pieces_add(pir_plan_space *space, const pir_solid *const *solid, size_t count, const char *what,
                               pir_report *report, pir_plan_pieces *pieces) {
    pir_status status = PIR_OK;
    if (count == 0)
        return pir_fail(report, PIR_ERR_EMPTY, "plan: there is no %s", what);
    for (size_t i = 0; i < count && status == PIR_OK; i++) {
        if (!solid || !solid[i])
            return pir_fail(report, PIR_ERR_ARGUMENT, "plan: a solid is NULL");
        status = add_solid(space, solid[i], (uint32_t)i, pieces);
    }
    return status;
}

void pir_plan_pieces_finish(pir_plan_space *space, pir_plan_pieces *pieces) {
    for (uint32_t i = 0; i < pieces->count; i++)
        pir_polytope_release(pieces->at[i]);
    pir_plan_free(space, pieces->at, pieces->room, sizeof *pieces->at);
    pir_plan_free(space, pieces->body, pieces->body_room, sizeof *pieces->body);
    *pieces = (pir_plan_pieces){0};
}

/* --- sums --- */

/* The half-space of a facet with these corners, counter-clockwise from outside, strictly convex. */
static uint32_t half_of(pir_plan_space *space, const uint32_t corner[3]) {
    const pir_plan_point *x[3];
    mpz_t way[2][3];
    mpz_ptr d = space->t[3];
    for (int i = 0; i < 3; i++)
        x[i] = pir_plan_point_exact(space, corner[i]);
    // ways times both last numbers, which are positive
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++) {
            mpz_init(way[i][k]);
            mpz_mul(way[i][k], x[i + 1]->x[k], x[0]->w);
            mpz_submul(way[i][k], x[0]->x[k], x[i + 1]->w);
        }
    mpz_set_ui(d, 0);
    for (int k = 0; k < 3; k++) {
        mpz_ptr n = space->t[k];
        mpz_mul(n, way[0][(k + 1) % 3], way[1][(k + 2) % 3]);
        mpz_submul(n, way[0][(k + 2) % 3], way[1][(k + 1) % 3]);
        mpz_addmul(d, n, x[0]->x[k]);
        mpz_mul(n, n, x[0]->w);
    }
    for (int k = 0; k < 3; k++)
        mpz_clears(way[0][k], way[1][k], NULL);
    return pir_plan_half(space, space->t, d);
}

static pir_status add_mesh(pir_plan_space *space, const pir_mesh *mesh, pir_plan_sums *sums, pir_plan_sum *sum) {
    const uint32_t corners = pir_mesh_vertex_count(mesh), facets = pir_mesh_facet_count(mesh);
    sum->corner = sums->corner_count;
    sum->half = sums->half_count;
    sum->corners = corners;
    sum->halves = facets;
    if (!pir_plan_grow(space, (void **)&sums->corner, &sums->corner_room, sum->corner + corners, sizeof(uint32_t)) ||
        !pir_plan_grow(space, (void **)&sums->half, &sums->half_room, sum->half + facets, sizeof(uint32_t)))
        return space->status;
    for (uint32_t v = 0; v < corners && space->status == PIR_OK; v++) {
        mpq_t x[3];
        mpq_inits(x[0], x[1], x[2], NULL);
        const pir_status status = pir_mesh_vertex_exact(mesh, v, x);
        if (status == PIR_OK)
            sums->corner[sums->corner_count++] = pir_plan_point_of(space, (const mpq_t *)x);
        mpq_clears(x[0], x[1], x[2], NULL);
        if (status != PIR_OK)
            return status;
        if (space->status == PIR_OK)
            pir_plan_box_add(space, sums->corner[sum->corner + v], sum->low, sum->high);
    }
    for (uint32_t f = 0; f < facets && space->status == PIR_OK; f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        const uint32_t of[3] = {sums->corner[sum->corner + corner[0]], sums->corner[sum->corner + corner[1]],
                                sums->corner[sum->corner + corner[2]]};
        sums->half[sums->half_count++] = half_of(space, of);
    }
    return space->status;
}

/* Has room for one more sum, which is then made by a mesh. */
static pir_status open_sum(pir_plan_space *space, uint32_t robot, uint32_t obstacle, pir_plan_sums *sums) {
    if (!pir_plan_grow(space, (void **)&sums->sum, &sums->room, sums->count + 1, sizeof *sums->sum))
        return space->status;
    sums->sum[sums->count] = (pir_plan_sum){.robot = robot,
                                            .obstacle = obstacle,
                                            .low = {INFINITY, INFINITY, INFINITY},
                                            .high = {-INFINITY, -INFINITY, -INFINITY}};
    return PIR_OK;
}

pir_status pir_plan_sums_add_mesh(pir_plan_space *space, const pir_mesh *mesh, uint32_t robot, uint32_t obstacle,
                                  pir_plan_sums *sums) {
    pir_status status = open_sum(space, robot, obstacle, sums);
    if (status == PIR_OK)
        status = add_mesh(space, mesh, sums, &sums->sum[sums->count]);
    sums->count += status == PIR_OK;
    return status;
}

pir_status pir_plan_sums_add(pir_plan_space *space, const pir_polytope *made, uint32_t robot, uint32_t obstacle,
                             pir_plan_sums *sums) {
    pir_mesh *mesh = NULL;
    pir_status status = pir_mesh_from_polytope(made, &mesh);
    if (status == PIR_OK)
        status = pir_plan_sums_add_mesh(space, mesh, robot, obstacle, sums);
    pir_mesh_destroy(mesh);
    return status;
}

static pir_status add_sum(pir_plan_space *space, pir_polytope *p, pir_polytope *q, pir_quat rotation,
                          pir_plan_sums *sums) {
    pir_sum_options options = pir_sum_options_default();
    pir_polytope *back = NULL;
    pir_sum *made = NULL;
    pir_mesh *mesh = NULL;
    options.allocator = &space->allocator;
    pir_status status = pir_polytope_reflect(p, &back);
    if (status == PIR_OK)
        status = pir_sum_create(back, q, rotation, &options, &made);
    if (status == PIR_OK)
        status = pir_sum_mesh(made, PIR_EXACT, &mesh);
    if (status == PIR_OK)
        status = add_mesh(space, mesh, sums, &sums->sum[sums->count]);
    sums->count += status == PIR_OK;
    pir_mesh_destroy(mesh);
    pir_sum_destroy(made);
    pir_polytope_release(back);
    return status;
}

pir_status pir_plan_sums_make(pir_plan_space *space, const pir_plan_pieces *robot, const pir_plan_pieces *obstacles,
                              pir_quat rotation, pir_plan_sums *sums) {
    for (uint32_t l = 0; l < obstacles->count; l++)
        for (uint32_t k = 0; k < robot->count; k++) {
            pir_status status = open_sum(space, k, l, sums);
            if (status == PIR_OK)
                status = add_sum(space, robot->at[k], obstacles->at[l], rotation, sums);
            if (status != PIR_OK)
                return status;
        }
    return PIR_OK;
}

void pir_plan_sums_finish(pir_plan_space *space, pir_plan_sums *sums) {
    pir_plan_free(space, sums->sum, sums->room, sizeof *sums->sum);
    pir_plan_free(space, sums->half, sums->half_room, sizeof *sums->half);
    pir_plan_free(space, sums->corner, sums->corner_room, sizeof *sums->corner);
    *sums = (pir_plan_sums){0};
}

/* --- segments --- */

/* The part of a segment within half-spaces: from `low` to `high` of its length. */
struct inner_span {
    mpq_t low, high, at;
    mpz_t from, to;
};

/* Cuts the part by a half-space; false where nothing of it is left whatever the others say. */
static bool cut_span(pir_plan_space *space, uint32_t half, const uint32_t end[2], bool open, struct inner_span *span) {
    const int side[2] = {pir_plan_side(space, half, end[0]), pir_plan_side(space, half, end[1])};
    if (open ? side[0] >= 0 && side[1] >= 0 : side[0] > 0 && side[1] > 0)
        return false;
    if (side[0] <= 0 && side[1] <= 0)
        return true; // of an open sum, an end on the plane takes a point from the part, never all of it
    // the excess of one end times the other's w, so that both are in one unit
    pir_plan_excess(space, half, end[0], span->from);
    pir_plan_excess(space, half, end[1], span->to);
    mpz_mul(span->from, span->from, space->point[end[1]].w);
    mpz_mul(span->to, span->to, space->point[end[0]].w);
    mpz_set(mpq_numref(span->at), span->from);
    mpz_sub(mpq_denref(span->at), span->from, span->to);
    mpq_canonicalize(span->at);
    if (side[0] > 0 && mpq_cmp(span->at, span->low) > 0)
        mpq_set(span->low, span->at);
    if (side[1] > 0 && mpq_cmp(span->at, span->high) < 0)
        mpq_set(span->high, span->at);
    return true;
}

static bool meets_segment(pir_plan_space *space, const pir_plan_sums *sums, const pir_plan_sum *sum,
                          const uint32_t end[2], bool open, struct inner_span *span) {
    mpq_set_ui(span->low, 0, 1);
    mpq_set_ui(span->high, 1, 1);
    for (uint32_t i = 0; i < sum->halves; i++)
        if (!cut_span(space, sums->half[sum->half + i], end, open, span))
            return false;
    const int order = mpq_cmp(span->low, span->high);
    return open ? order < 0 : order <= 0;
}

uint32_t pir_plan_sums_along(pir_plan_space *space, const pir_plan_sums *sums, uint32_t from, uint32_t to, bool open) {
    struct inner_span span;
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    uint32_t met = PIR_PLAN_NONE;
    const uint32_t end[2] = {from, to};
    pir_plan_box_add(space, from, low, high);
    pir_plan_box_add(space, to, low, high);
    mpq_inits(span.low, span.high, span.at, NULL);
    mpz_inits(span.from, span.to, NULL);
    for (uint32_t i = 0; i < sums->count && met == PIR_PLAN_NONE; i++) {
        const pir_plan_sum *sum = &sums->sum[i];
        if (pir_plan_boxes_meet(low, high, sum->low, sum->high) && meets_segment(space, sums, sum, end, open, &span))
            met = i;
    }
    mpq_clears(span.low, span.high, span.at, NULL);
    mpz_clears(span.from, span.to, NULL);
    return met;
}

uint32_t pir_plan_sums_at(pir_plan_space *space, const pir_plan_sums *sums, uint32_t point, bool open) {
    return pir_plan_sums_along(space, sums, point, point, open);
}
