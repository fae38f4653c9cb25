/* SPDX-License-Identifier: MIT */
/*
 * See closed.h. It trusts nothing but the corners that the mesh will have. Where edges pair up, facets make up closed
 * surfaces that have two sides; their Euler characteristic is even then, so it tells nothing more. Slits pair up with
 * themselves. A two-sided facet is given out once each way, so that its sides pair up whatever they are.
 *
 * Sides between the same two points are found by a hash table: each seat has the first of them, and what they add up
 * to.
 */
#include "solid/glue/closed.h"

/* A seat: two points, the lower number first, and how many sides lead up more than down, as a difference. */
#define SEAT 3

static uint32_t first_seat(uint32_t a, uint32_t b, uint32_t seats) {
    const uint64_t hash = ((uint64_t)a << 32 | b) * 0x9e3779b97f4a7c15u;
    return (uint32_t)(hash >> 32) & (seats - 1);
}

/* Adds a side to the seat of its points. */
static void seat_side(uint32_t *seat, uint32_t seats, uint32_t p, uint32_t q) {
    const uint32_t a = p < q ? p : q, b = p < q ? q : p;
    uint32_t at = first_seat(a, b, seats);
    while (seat[SEAT * at] != PIR_SPACE_NONE && (seat[SEAT * at] != a || seat[SEAT * at + 1] != b))
        at = (at + 1) & (seats - 1);
    if (seat[SEAT * at] == PIR_SPACE_NONE) {
        seat[SEAT * at] = a;
        seat[SEAT * at + 1] = b;
        seat[SEAT * at + 2] = 0;
    }
    seat[SEAT * at + 2] += p < q ? 1 : UINT32_MAX;
}

/* Seats the sides of all boundary facets; false where a facet has too few corners, or two in a row at one place. */
static bool seat_sides(const pir_loop_list *loops, uint32_t *seat, uint32_t seats) {
    for (uint32_t f = 0, first = 0; f < loops->facet_count; first = loops->facet[f++])
        for (uint32_t i = first, end = loops->facet[f]; i < end; i++) {
            const uint32_t p = loops->facet_corner[i], q = loops->facet_corner[i + 1 < end ? i + 1 : first];
            if (p == q || end - first < 3)
                return false;
            if (f < loops->boundary_count)
                seat_side(seat, seats, p, q);
        }
    return true;
}

void pir_loops_check_closed(pir_loop_list *loops) {
    pir_space *space = loops->space;
    const uint32_t count = loops->boundary_count > 0 ? loops->facet[loops->boundary_count - 1] : 0;
    uint32_t seats = 64;
    while (seats < 2 * (uint64_t)count)
        seats *= 2;
    if (!pir_space_grow(space, (void **)&loops->seat, &loops->seat_room, (size_t)SEAT * seats, sizeof *loops->seat))
        return;
    for (uint32_t k = 0; k < seats; k++)
        loops->seat[SEAT * k] = PIR_SPACE_NONE;
    bool closed = count > 0 && seat_sides(loops, loops->seat, seats);
    for (uint32_t k = 0; k < seats && closed; k++)
        closed = loops->seat[SEAT * k] == PIR_SPACE_NONE || loops->seat[SEAT * k + 2] == 0;
    if (!closed)
        pir_space_fault(space);
}
