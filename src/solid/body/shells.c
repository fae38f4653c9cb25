/* SPDX-License-Identifier: MIT */
/*
 * A shell is a part of the surface that edges join. Where a shell does not cross another, all of it is inside or
 * outside of that one; so a segment from a point of it to a point beyond the body counts how often the others are
 * around it, +1 where it leaves through the front of a part, −1 through the back. An outer shell, of positive volume,
 * must be within none, a cavity within one. Shells may touch, but share no area, so the segment begins within a part.
 * One that begins on another shell, or meets an edge or a corner of a part, is replaced by another.
 */
#include "solid/body/shells.h"

#include "base/report.h"
#include "solid/body/crossing.h"
#include "solid/space/exact.h"

struct shells {
    pir_shell_body *body;
    uint32_t *shell; /* per facet: the first of its shell */
    mpz_t six;       /* of the shell at hand */
    uint64_t random;
};

static uint32_t root_of(uint32_t *shell, uint32_t facet) {
    while (shell[facet] != facet)
        facet = shell[facet] = shell[shell[facet]];
    return facet;
}

/* Six times the volume between the origin and a facet is added to the sum. */
static void add_volume(const pir_shell_body *body, uint32_t facet, mpz_ptr sum) {
    pir_space *space = body->space;
    const uint32_t first = body->source.start[facet], end = body->source.start[facet + 1];
    mpz_t *a = space->number + space->point[body->origin[first]].exact;
    for (uint32_t i = first + 1; i + 1 < end; i++) {
        mpz_t *b = space->number + space->point[body->origin[i]].exact;
        mpz_t *c = space->number + space->point[body->origin[i + 1]].exact;
        pir_numbers_cross(space->t, b, c);
        pir_numbers_dot(space->t[17], a, space->t, 3);
        mpz_add(sum, sum, space->t[17]);
    }
}

/* --- how shells lie in each other --- */

static uint64_t next_random(struct shells *shells) {
    return shells->random = shells->random * 6364136223846793005u + 1442695040888963407u;
}

/* A point beyond the body: its coordinates are above all of the body's, in the cube of the space. */
static uint32_t point_beyond(struct shells *shells) {
    pir_space *space = shells->body->space;
    mpz_t x[4];
    for (int k = 0; k < 4; k++) {
        mpz_init_set_ui(x[k], k < 3 ? (next_random(shells) >> 40 | 1u << 24) : 1);
        if (k < 3 && space->shift >= 25)
            mpz_mul_2exp(x[k], x[k], (mp_bitcnt_t)(space->shift - 25));
    }
    if (space->shift < 25)
        mpz_set_ui(x[3], 1);
    mpz_mul_2exp(x[3], x[3], space->shift < 25 ? (mp_bitcnt_t)(25 - space->shift) : 0);
    const uint32_t point = pir_space_add_point(space, x[0], x[1], x[2], x[3]);
    for (int k = 0; k < 4; k++)
        mpz_clear(x[k]);
    return point;
}

enum { MISSES = 0, THROUGH_FRONT = 1, THROUGH_BACK = -1, UNCLEAR = 2 };

/* How a segment from p to q passes through a part. */
static int pass(pir_shell_body *body, uint32_t p, uint32_t q, uint32_t part) {
    const uint32_t half = pir_shell_body_half(body, body->part_facet[part]);
    const int from = pir_space_side(body->space, half, p), to = pir_space_side(body->space, half, q);
    if (from == to)
        return from == 0 ? UNCLEAR : MISSES;
    if (from == 0)
        return pir_shell_body_part_holds(body, part, p) ? UNCLEAR : MISSES;
    bool left = false, right = false, on = false;
    const uint32_t first = body->part_start[part], end = body->part_start[part + 1];
    for (uint32_t i = first; i < end && !(left && right); i++) {
        const uint32_t a = body->part_corner[i], b = body->part_corner[i + 1 < end ? i + 1 : first];
        const int side = pir_space_orient(body->space, p, q, a, b);
        left = left || side > 0;
        right = right || side < 0;
        on = on || side == 0;
    }
    if (left && right)
        return MISSES;
    return on || to == 0 ? UNCLEAR : to > 0 ? THROUGH_FRONT : THROUGH_BACK;
}

/* A point within the first part of the shell: the middle of three corners, or another where the shells' `random` has
 * chosen weights. */
static uint32_t point_within(struct shells *shells, uint32_t shell, bool middle) {
    const pir_shell_body *body = shells->body;
    pir_space *space = body->space;
    uint32_t part = 0;
    while (shells->shell[body->part_facet[part]] != shell)
        part++;
    mpz_t x[4];
    for (int k = 0; k < 4; k++)
        mpz_init(x[k]);
    for (uint32_t i = body->part_start[part]; i < body->part_start[part] + 3; i++) {
        const unsigned long weight = middle ? 1 : (unsigned long)(next_random(shells) >> 48 | 1);
        for (uint32_t k = 0; k < 4; k++)
            mpz_addmul_ui(x[k], space->number[space->point[body->part_corner[i]].exact + k], weight);
    }
    const uint32_t point = pir_space_add_point(space, x[0], x[1], x[2], x[3]);
    for (int k = 0; k < 4; k++)
        mpz_clear(x[k]);
    return point;
}

/* How often the other shells are around the shell; false where no segment could tell. */
static bool find_winding(struct shells *shells, uint32_t shell, int *ret_winding) {
    pir_shell_body *body = shells->body;
    uint32_t from = point_within(shells, shell, true);
    for (int attempt = 0; attempt < 64 && body->space->status == PIR_OK; attempt++) {
        const uint32_t to = point_beyond(shells);
        int winding = 0, how = MISSES;
        for (uint32_t p = 0; p < body->part_count && how != UNCLEAR; p++) {
            if (shells->shell[body->part_facet[p]] == shell)
                continue;
            how = pass(body, from, to, p);
            winding += how;
        }
        if (how != UNCLEAR) {
            *ret_winding = winding;
            return true;
        }
        from = point_within(shells, shell, false);
    }
    return false;
}

static pir_status check_shell(struct shells *shells, uint32_t shell, uint32_t count) {
    const pir_shell_body_source *source = &shells->body->source;
    char where[PIR_BODY_WHERE];
    pir_shell_body_where(source, shell, where);
    const int sign = mpz_sgn(shells->six);
    int winding = 0;
    if (sign == 0)
        return pir_fail(source->report, PIR_ERR_FORMAT, "%s: the shell of this facet holds no volume", where);
    if (count > 1 && !find_winding(shells, shell, &winding))
        return pir_fail(source->report, PIR_ERR_FORMAT, "%s: the shell of this facet touches another", where);
    if (sign < 0 && winding == 0)
        return pir_fail(source->report, PIR_ERR_FORMAT, "%s: the shell of this facet is inside out", where);
    if (winding != (sign < 0))
        return pir_fail(source->report, PIR_ERR_FORMAT,
                        "%s: the shell of this facet is within another that faces the "
                        "same way",
                        where);
    return PIR_OK;
}

static pir_status check_shells(struct shells *shells, uint32_t count, mpz_ptr six_volume) {
    const pir_shell_body *body = shells->body;
    pir_status status = PIR_OK;
    mpz_set_ui(six_volume, 0);
    for (uint32_t shell = 0; shell < body->source.facet_count && status == PIR_OK; shell++) {
        if (shells->shell[shell] != shell)
            continue;
        mpz_set_ui(shells->six, 0);
        for (uint32_t f = 0; f < body->source.facet_count; f++)
            if (shells->shell[f] == shell)
                add_volume(body, f, shells->six);
        mpz_add(six_volume, six_volume, shells->six);
        status = check_shell(shells, shell, count);
    }
    return status;
}

/* --- counts --- */

/* The edges and facets at a point of the body, as far as counts need them. */
struct corner {
    uint32_t bends, reflex;     /* edges that are not flat, and the reflex ones among them */
    uint32_t first[2], last[2]; /* their least and greatest direction's edge, for two bends, for two reflex ones */
};

static bool is_straight(pir_shell_body *body, const uint32_t edge[2]) {
    pir_space *space = body->space;
    const uint32_t a = body->edge[edge[0]].direction, b = body->edge[edge[1]].direction;
    mpz_t *cross = space->t;
    pir_numbers_cross(cross, space->number + space->direction[a].exact, space->number + space->direction[b].exact);
    return mpz_sgn(cross[0]) == 0 && mpz_sgn(cross[1]) == 0 && mpz_sgn(cross[2]) == 0;
}

static void note_edge(struct corner *corner, uint32_t edge, bool reflex) {
    corner->first[0] = corner->bends++ == 0 ? edge : corner->first[0];
    corner->last[0] = edge;
    if (reflex) {
        corner->first[1] = corner->reflex++ == 0 ? edge : corner->first[1];
        corner->last[1] = edge;
    }
}

/* Edges that a straight corner joins are one. */
static bool count_merged(pir_shell_body *body, pir_shell_body_counts *counts) {
    const uint32_t points = body->source.point_count;
    struct corner *corner = PIR_ZEROED(&body->space->allocator, struct corner, points);
    for (uint32_t e = 0; e < body->edge_count && corner; e++) {
        const pir_shell_body_edge *edge = &body->edge[e];
        if (edge->bend == PIR_BEND_FLAT)
            continue;
        counts->merged_edges++;
        counts->reflex_edges += edge->bend == PIR_BEND_REFLEX;
        note_edge(&corner[edge->a - body->first_point], e, edge->bend == PIR_BEND_REFLEX);
        note_edge(&corner[edge->b - body->first_point], e, edge->bend == PIR_BEND_REFLEX);
    }
    for (uint32_t p = 0; p < points && corner; p++) {
        const bool straight =
            corner[p].bends == 2 && is_straight(body, (const uint32_t[]){corner[p].first[0], corner[p].last[0]});
        counts->merged_vertices += corner[p].bends > 0 && !straight;
        counts->merged_edges -= straight;
        counts->reflex_edges -= straight && corner[p].reflex == 2;
    }
    PIR_FREE(&body->space->allocator, corner, points);
    return corner;
}

/* Halfedges that leave one vertex: umbrellas, so that a point where two of them touch counts twice. */
static bool count_vertices(pir_shell_body *body, pir_shell_body_counts *counts) {
    const uint32_t halves = body->source.start[body->source.facet_count];
    bool *seen = PIR_ZEROED(&body->space->allocator, bool, halves);
    for (uint32_t h = 0; h < halves && seen; h++) {
        counts->vertices += !seen[h];
        for (uint32_t at = h; !seen[at];) {
            seen[at] = true;
            const uint32_t twin = body->twin[at], f = body->facet[twin];
            at = twin + 1 < body->source.start[f + 1] ? twin + 1 : body->source.start[f];
        }
    }
    PIR_FREE(&body->space->allocator, seen, halves);
    return seen;
}

pir_status pir_shell_body_check_shells(pir_shell_body *body, pir_shell_body_counts *ret_counts,
                                       mpz_ptr ret_six_volume) {
    const pir_allocator *a = &body->space->allocator;
    const uint32_t facets = body->source.facet_count;
    pir_shell_body_counts counts = {.edges = body->edge_count, .facets = facets};
    struct shells shells = {.body = body, .shell = PIR_NEW(a, uint32_t, facets), .random = 1};
    if (!shells.shell)
        return PIR_ERR_MEMORY;
    mpz_init(shells.six);
    for (uint32_t f = 0; f < facets; f++)
        shells.shell[f] = f;
    for (uint32_t e = 0; e < body->edge_count; e++) {
        const uint32_t l = root_of(shells.shell, body->edge[e].left), r = root_of(shells.shell, body->edge[e].right);
        shells.shell[l > r ? l : r] = l < r ? l : r;
    }
    for (uint32_t f = 0; f < facets; f++) {
        shells.shell[f] = root_of(shells.shell, f);
        counts.shells += shells.shell[f] == f;
        counts.merged_facets += body->group[f] == f;
    }
    pir_status status = check_shells(&shells, counts.shells, ret_six_volume);
    if (status == PIR_OK && !(count_merged(body, &counts) && count_vertices(body, &counts)))
        status = PIR_ERR_MEMORY;
    mpz_clear(shells.six);
    PIR_FREE(a, shells.shell, facets);
    if (status != PIR_OK)
        return status;
    const int64_t euler = (int64_t)counts.vertices - counts.edges + counts.facets;
    counts.genus = counts.shells - euler / 2;
    *ret_counts = counts;
    return body->space->status;
}
