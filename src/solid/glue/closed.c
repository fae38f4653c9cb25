/* SPDX-License-Identifier: MIT */
/*
 * See closed.h. It trusts nothing but the corners that the mesh will have. Where edges pair up, facets make up closed
 * surfaces that have two sides; their Euler characteristic is even then, so it tells nothing more. Slits pair up with
 * themselves. A two-sided facet is given out once each way, so that its sides pair up whatever they are.
 */
#include "solid/glue/closed.h"

#include "base/sort.h"

struct directed_side {
    uint32_t a, b; /* points, the lower number first */
    int way;       /* 1 from a to b, −1 from b to a */
};

static bool side_before(void *context, uint32_t i, uint32_t j) {
    const struct directed_side *s = &((const struct directed_side *)context)[i],
                               *t = &((const struct directed_side *)context)[j];
    return s->a != t->a ? s->a < t->a : s->b < t->b;
}

/* The sides of all boundary facets; false where a facet has too few corners, or two in a row at one place. */
static bool list_sides(const pir_loop_list *loops, struct directed_side *side) {
    for (uint32_t f = 0, first = 0; f < loops->facet_count; first = loops->facet[f++])
        for (uint32_t i = first, end = loops->facet[f]; i < end; i++) {
            const uint32_t p = loops->facet_corner[i], q = loops->facet_corner[i + 1 < end ? i + 1 : first];
            if (p == q || end - first < 3)
                return false;
            if (f < loops->boundary_count)
                side[i] = p < q ? (struct directed_side){p, q, 1} : (struct directed_side){q, p, -1};
        }
    return true;
}

/* Whether the sides order[0 .. count) lead each way equally often between each two points; they are in order. */
static bool pair_up(struct directed_side *side, const uint32_t *order, uint32_t count) {
    int sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (i > 0 && side_before(side, order[i - 1], order[i]) && sum != 0)
            return false;
        sum += side[order[i]].way;
    }
    return sum == 0;
}

void pir_loops_check_closed(pir_loop_list *loops) {
    pir_space *space = loops->space;
    const pir_allocator *a = &space->allocator;
    const uint32_t count = loops->boundary_count > 0 ? loops->facet[loops->boundary_count - 1] : 0;
    struct directed_side *side = PIR_NEW(a, struct directed_side, count);
    uint32_t *order = PIR_NEW(a, uint32_t, count), *work = PIR_NEW(a, uint32_t, count);
    if (side && order && work) {
        for (uint32_t i = 0; i < count; i++)
            order[i] = i;
        bool closed = count > 0 && list_sides(loops, side);
        if (closed) {
            pir_sort(order, count, work, side_before, side);
            closed = pair_up(side, order, count);
        }
        if (!closed)
            pir_space_fault(space);
    } else {
        space->status = PIR_ERR_MEMORY;
    }
    PIR_FREE(a, side, count);
    PIR_FREE(a, order, count);
    PIR_FREE(a, work, count);
}
