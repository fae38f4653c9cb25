/* SPDX-License-Identifier: MIT */
/*
 * Turns about one axis u. The product of the unit quaternion q = (v, w) with that of the turn by α is w·cos(α/2) +
 * (v·u)·sin(α/2): with h = w + (v·u)·i it is |h|·cos(arg h − α/2), so the nearest turn is by 2·arg h.
 */
#include "cspace/grid/turns.h"

#include <math.h>

#include "cspace/grid/angle.h"

pir_quat pir_turns_rotation(const pir_turns *turns, uint64_t number) {
    pir_circle_point half = pir_circle_at(number, 2 * turns->count);
    return (pir_quat){turns->unit.x * half.sin, turns->unit.y * half.sin, turns->unit.z * half.sin, half.cos};
}

static void offer(const pir_turns *turns, pir_quat unit, uint64_t number, pir_near *near) {
    pir_near_offer(near, fabs(pir_quat_dot(unit, pir_turns_rotation(turns, number))), number);
}

void pir_turns_nearest(const pir_turns *turns, pir_quat unit, pir_near *near) {
    double along = unit.x * turns->unit.x + unit.y * turns->unit.y + unit.z * turns->unit.z;
    double part = 2 * pir_turn_part(unit.w, along);
    uint64_t nearest = (uint64_t)((part < 1 ? part : part - 1) * (double)turns->count + 0.5) % turns->count;
    offer(turns, unit, nearest, near);
    // both ways from there; one more than is sought, where rounding chose the other of two
    for (uint64_t away = 1; away <= near->capacity + 1 && 2 * away <= turns->count; away++) {
        offer(turns, unit, (nearest + away) % turns->count, near);
        if (2 * away < turns->count)
            offer(turns, unit, (nearest + turns->count - away) % turns->count, near);
    }
}
