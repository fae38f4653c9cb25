/* SPDX-License-Identifier: MIT */
/*
 * Point lists, and sines that do not depend on a machine's libm.
 *
 * The angle is reduced to one eighth of a turn in integers, so a ring of n points has the symmetries of the axes bit
 * for bit; what remains is a fixed Taylor sum of +, − , · and /, which IEEE arithmetic rounds the same everywhere.
 */
#include "polytope/shape/shape_points.h"

#include "base/memory.h"

void pir_point_list_add(struct pir_point_list *list, double x, double y, double z) {
    if (list->failed)
        return;
    if (list->count == list->capacity) {
        const size_t capacity = list->capacity ? 2 * list->capacity : 64;
        pir_vec3 *grown = PIR_RESIZE(list->allocator, list->at, list->capacity, capacity);
        if (!grown) {
            list->failed = true;
            return;
        }
        list->at = grown;
        list->capacity = capacity;
    }
    list->at[list->count++] = (pir_vec3){x, y, z};
}

void pir_point_list_finish(struct pir_point_list *list) {
    PIR_FREE(list->allocator, list->at, list->capacity);
    *list = (struct pir_point_list){.allocator = list->allocator};
}

/* Cosine and sine of 0 to π/4. The last Taylor terms, of x^20 and x^21, are below 2^-68. */
static struct pir_direction small_angle(double x) {
    const double square = x * x;
    double cosine = 1, sine = 1;
    for (int k = 18; k >= 2; k -= 2) {
        cosine = 1 - square / (k * (k - 1)) * cosine;
        sine = 1 - square / (k * (k + 1)) * sine;
    }
    return (struct pir_direction){cosine, x * sine};
}

struct pir_direction pir_turn_direction(uint64_t part, uint64_t whole) {
    const double eighth_turn = 0x1.921fb54442d18p-1; // π/4
    // the octant, and the angle from the nearer of its two ends that lies on an axis
    const uint64_t eighths = 8 * (part % whole);
    const uint64_t octant = eighths / whole, rest = eighths % whole;
    const bool mirrored = octant % 2 == 1;
    const double fraction = (double)(mirrored ? whole - rest : rest) / (double)whole;
    const struct pir_direction a = small_angle(fraction * eighth_turn);
    const struct pir_direction b = mirrored ? (struct pir_direction){a.y, a.x} : a;
    switch (octant / 2) {
    case 0:
        return b;
    case 1:
        return (struct pir_direction){-b.y, b.x};
    case 2:
        return (struct pir_direction){-b.x, -b.y};
    default:
        return (struct pir_direction){b.y, -b.x};
    }
}
