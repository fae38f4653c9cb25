/* SPDX-License-Identifier: MIT */
/*
 * See slits.h. A slit is a segment from a corner of a hole to a corner of the loop so far, which is walked both
 * ways. It leaves both corners into the facet, and meets no side of the loop or of any hole that is not yet joined.
 */
#include "solid/glue/slits.h"

struct slit {
    uint32_t hole, from, to; /* the loop of the hole, the corner's place there, the corner's place in the facet */
};

static void push(pir_loop_list *list, uint32_t point) {
    if (pir_space_grow(list->space, (void **)&list->spare, &list->spare_room, list->spare_count, sizeof *list->spare))
        list->spare[list->spare_count++] = point;
}

/* Whether x lies ahead of the corner q of a loop, strictly within the facet. */
static bool is_ahead(pir_space *space, uint32_t half, const uint32_t pqr[3], uint32_t x) {
    const int before = pir_space_turn(space, half, pqr[0], pqr[1], x);
    const int after = pir_space_turn(space, half, pqr[1], pqr[2], x);
    if (pir_space_turn(space, half, pqr[0], pqr[1], pqr[2]) > 0)
        return before > 0 && after > 0;
    return before > 0 || after > 0;
}

static bool corner_sees(const pir_loop_list *list, uint32_t half, const uint32_t *loop, const uint32_t at[2],
                        uint32_t x) {
    const uint32_t i = at[0], count = at[1];
    const uint32_t pqr[3] = {loop[i > 0 ? i - 1 : count - 1], loop[i], loop[i + 1 < count ? i + 1 : 0]};
    return is_ahead(list->space, half, pqr, x);
}

/* Whether the segment from p to q meets a side of a loop, but for those that begin or end there on another line. */
static bool is_crossed(const pir_loop_list *list, uint32_t half, const uint32_t pq[2], const uint32_t *loop,
                       uint32_t count) {
    pir_space *space = list->space;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t a = loop[i], b = loop[i + 1 < count ? i + 1 : 0];
        const int at_a = pir_space_turn(space, half, pq[0], pq[1], a),
                  at_b = pir_space_turn(space, half, pq[0], pq[1], b);
        const bool holds_a = a == pq[0] || a == pq[1], holds_b = b == pq[0] || b == pq[1];
        if (holds_a || holds_b) {
            if ((!holds_a && at_a == 0) || (!holds_b && at_b == 0))
                return true;
            continue;
        }
        if (at_a * at_b <= 0 &&
            pir_space_turn(space, half, a, b, pq[0]) * pir_space_turn(space, half, a, b, pq[1]) <= 0)
            return true;
    }
    return false;
}

/* Whether nothing that is in the facet of `outer` is in the way of a slit. */
static bool is_free(const pir_loop_list *list, uint32_t half, uint32_t outer, const uint32_t pq[2]) {
    if (is_crossed(list, half, pq, list->spare, list->spare_count))
        return false;
    for (uint32_t l = 0; l < list->count; l++) {
        const pir_loop *loop = &list->loop[l];
        if (loop->hole && loop->within == outer && is_crossed(list, half, pq, list->corner + loop->first, loop->count))
            return false;
    }
    return true;
}

static bool find_slit(const pir_loop_list *list, uint32_t half, uint32_t outer, struct slit *slit) {
    const pir_loop *hole = &list->loop[slit->hole];
    const uint32_t *corner = list->corner + hole->first;
    for (slit->from = 0; slit->from < hole->count; slit->from++)
        for (slit->to = 0; slit->to < list->spare_count; slit->to++) {
            const uint32_t pq[2] = {corner[slit->from], list->spare[slit->to]};
            if (pq[0] != pq[1] && corner_sees(list, half, corner, (const uint32_t[]){slit->from, hole->count}, pq[1]) &&
                corner_sees(list, half, list->spare, (const uint32_t[]){slit->to, list->spare_count}, pq[0]) &&
                is_free(list, half, outer, pq))
                return true;
        }
    return false;
}

/* Puts the hole's loop, and the slit both ways, behind the corner of the facet where the slit ends. */
static void cut_slit(pir_loop_list *list, const struct slit *slit) {
    const pir_loop hole = list->loop[slit->hole];
    const uint32_t added = hole.count + 2, before = list->spare_count;
    for (uint32_t i = 0; i < added; i++)
        push(list, 0);
    if (list->space->status != PIR_OK)
        return;
    for (uint32_t i = before; i-- > slit->to + 1;)
        list->spare[i + added] = list->spare[i];
    uint32_t at = slit->to + 1;
    for (uint32_t i = 0; i <= hole.count; i++)
        list->spare[at++] = list->corner[hole.first + (slit->from + i) % hole.count];
    list->spare[at] = list->spare[slit->to];
}

/* Joins one hole of the facet that can be joined; false when none is left. One of several can always be. */
static bool join_hole(pir_loop_list *list, uint32_t half, uint32_t outer) {
    bool left = false;
    for (uint32_t l = 0; l < list->count && list->space->status == PIR_OK; l++) {
        struct slit slit = {.hole = l};
        if (l == outer || !list->loop[l].hole || list->loop[l].within != outer)
            continue;
        left = true;
        if (!find_slit(list, half, outer, &slit))
            continue;
        cut_slit(list, &slit);
        list->loop[l].within = l;
        list->hole_count++;
        return true;
    }
    if (left)
        pir_space_fault(list->space);
    return false;
}

void pir_loops_add_facet(pir_loop_list *loops, uint32_t half, uint32_t outer) {
    const pir_loop loop = loops->loop[outer];
    loops->spare_count = 0;
    for (uint32_t i = 0; i < loop.count; i++)
        push(loops, loops->corner[loop.first + i]);
    while (join_hole(loops, half, outer))
        ;
    for (uint32_t i = 0; i < loops->spare_count; i++)
        pir_loops_push_corner(loops, loops->spare[i]);
    pir_loops_end_facet(loops);
}
