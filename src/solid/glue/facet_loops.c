/* SPDX-License-Identifier: MIT */
/*
 * See facet_loops.h. At a corner from which several edges lead on, the loop takes the one that turns most to the
 * left, and goes back only where no other leads on: between an edge and the next lies then a wedge of the facet's
 * inside, and parts that only touch at a corner get loops of their own. At a loop's extreme corner all edges lead to
 * one side; the loop goes round a hole when the wedge on the other side is one of its own.
 *
 * Where loops begin, and their order, is that of their corners along a direction, so that it does not depend on the
 * order of the runs: equal outlines have equal loops, whatever polygons they were made of.
 */
#include "solid/glue/facet_loops.h"

#include <math.h>
#include <string.h>

#include "base/sort.h"
#include "solid/glue/slits.h"
#include "solid/space/exact.h"

struct loop_tracer {
    pir_loop_list *list;
    pir_space *space;
    const pir_union_outline *outline;
    uint32_t half;
    uint32_t first, end; /* runs of the group */
    uint32_t first_loop; /* of it */
    bool *used;          /* per run */
    uint32_t level[2];   /* the two coordinates that tell points of the plane apart */
    uint32_t axis[2];    /* their directions */
    uint32_t along;      /* a direction along which few points are level */
};

static uint32_t from_of(const pir_run *run) {
    return run->sign > 0 ? run->a : run->b;
}

static uint32_t to_of(const pir_run *run) {
    return run->sign > 0 ? run->b : run->a;
}

static void push_corner(pir_loop_list *list, uint32_t point) {
    if (pir_space_grow(list->space, (void **)&list->corner, &list->corner_room, list->corner_count,
                       sizeof *list->corner))
        list->corner[list->corner_count++] = point;
}

/* How a loop turns that comes from p to q and goes on along `run`: 2 to the left, 1 straight on, 0 to the right, −1
 * back. */
static int turn_of(struct loop_tracer *t, const pir_run *from, const pir_run *run) {
    if (from->line == run->line)
        return from->sign == run->sign ? 1 : -1;
    const int turn = pir_space_turn(t->space, t->half, from_of(from), to_of(from), to_of(run));
    return turn > 0 ? 2 : turn < 0 ? 0 : -1;
}

/* Whether `b` turns more to the left than `a`, after `from`. */
static bool turns_more(struct loop_tracer *t, const pir_run *from, const pir_run *a, const pir_run *b) {
    const int turn_a = turn_of(t, from, a), turn_b = turn_of(t, from, b);
    return turn_a != turn_b ? turn_b > turn_a : pir_space_turn(t->space, t->half, to_of(from), to_of(a), to_of(b)) > 0;
}

/* The run that a loop goes on with after `run`: the one that it began with, or one that no loop has. */
static uint32_t next_run(struct loop_tracer *t, uint32_t start, uint32_t run) {
    const pir_run *runs = t->outline->run;
    uint32_t best = PIR_SPACE_NONE;
    for (uint32_t r = t->first; r < t->end; r++)
        if ((r == start || !t->used[r]) && from_of(&runs[r]) == to_of(&runs[run]) &&
            (best == PIR_SPACE_NONE || turns_more(t, &runs[run], &runs[best], &runs[r])))
            best = r;
    return best;
}

/* The two axes that a plane's normal is not nearest to. Any two do along which the normal is not 0, and that of the
 * largest component, as doubles have it, is more than .5. */
static void set_axes(struct loop_tracer *t) {
    pir_space *space = t->space;
    const double *n = space->plane[t->half >> 1].n;
    uint32_t most = 0;
    for (uint32_t k = 1; k < 3; k++)
        most = fabs(n[k]) > fabs(n[most]) ? k : most;
    for (uint32_t i = 0; i < 2; i++) {
        t->level[i] = (most + 1 + i) % 3;
        for (uint32_t k = 0; k < 3; k++)
            mpz_set_ui(space->t[k], k == t->level[i]);
        t->axis[i] = pir_space_add_direction(space, space->t[0], space->t[1], space->t[2]);
    }
}

/* The order of two points of the plane: below 0 when a comes first, 0 only when they are one. */
static int compare_points(struct loop_tracer *t, uint32_t a, uint32_t b) {
    int order = a == b ? 0 : pir_space_order(t->space, t->along, a, b);
    for (int k = 0; k < 2 && order == 0 && a != b; k++)
        order = pir_space_order(t->space, t->axis[k], a, b);
    return -order;
}

/* The order of two loops, each from a corner on. */
static int compare_loops(struct loop_tracer *t, const pir_loop *a, uint32_t from_a, const pir_loop *b,
                         uint32_t from_b) {
    const uint32_t *x = t->list->corner + a->first, *y = t->list->corner + b->first;
    const uint32_t least = a->count < b->count ? a->count : b->count;
    for (uint32_t i = 0; i < least; i++) {
        const int order = compare_points(t, x[(from_a + i) % a->count], y[(from_b + i) % b->count]);
        if (order != 0)
            return order;
    }
    return (a->count > b->count) - (a->count < b->count);
}

/* Makes a loop begin at its first corner. */
static void turn_loop(struct loop_tracer *t, const pir_loop *loop) {
    pir_loop_list *list = t->list;
    uint32_t *corner = list->corner + loop->first, best = 0;
    if (!pir_space_grow(t->space, (void **)&list->spare, &list->spare_room, loop->count, sizeof *list->spare))
        return;
    for (uint32_t i = 1; i < loop->count; i++)
        if (compare_points(t, corner[i], corner[best]) < 0 ||
            (corner[i] == corner[best] && compare_loops(t, loop, i, loop, best) < 0))
            best = i;
    for (uint32_t i = 0; i < loop->count; i++)
        list->spare[i] = corner[(best + i) % loop->count];
    for (uint32_t i = 0; i < loop->count; i++)
        corner[i] = list->spare[i];
}

static bool loop_before(void *context, uint32_t a, uint32_t b) {
    struct loop_tracer *t = context;
    const pir_loop *loop = t->list->loop + t->first_loop;
    return compare_loops(t, &loop[a], 0, &loop[b], 0) < 0;
}

/* Puts the loops of the group in order. */
static void sort_loops(struct loop_tracer *t) {
    pir_loop_list *list = t->list;
    const uint32_t count = list->count - t->first_loop;
    pir_loop *loop = list->loop + t->first_loop;
    if (count == 1) {
        loop->within = t->first_loop;
        return;
    }
    if (!pir_space_grow(t->space, (void **)&list->order, &list->order_room, count, sizeof *list->order) ||
        !pir_space_grow(t->space, (void **)&list->work, &list->work_room, count, sizeof *list->work) ||
        !pir_space_grow(t->space, (void **)&list->copy, &list->copy_room, count, sizeof *list->copy))
        return;
    for (uint32_t i = 0; i < count; i++) {
        list->order[i] = i;
        list->copy[i] = loop[i];
    }
    pir_sort(list->order, count, list->work, loop_before, t);
    for (uint32_t i = 0; i < count; i++) {
        loop[i] = list->copy[list->order[i]];
        loop[i].within = t->first_loop + i;
    }
}

/* Whether a loop goes round a hole: a turn to the right, or back, at the corner that is first along one axis, then
 * along the other. */
static bool is_hole(struct loop_tracer *t, const pir_loop *loop) {
    const uint32_t *corner = t->list->corner + loop->first;
    uint32_t best = 0;
    for (uint32_t i = 1; i < loop->count; i++) {
        int order = pir_space_order(t->space, t->axis[0], corner[best], corner[i]);
        if (order == 0)
            order = pir_space_order(t->space, t->axis[1], corner[best], corner[i]);
        best = order < 0 ? i : best;
    }
    for (uint32_t i = best; i < loop->count; i++)
        if (corner[i] == corner[best] && pir_space_turn(t->space, t->half, corner[i > 0 ? i - 1 : loop->count - 1],
                                                        corner[i], corner[i + 1 < loop->count ? i + 1 : 0]) <= 0)
            return true;
    return false;
}

static void trace_loop(struct loop_tracer *t, uint32_t start) {
    pir_loop_list *list = t->list;
    pir_loop loop = {.first = list->corner_count};
    uint32_t run = start;
    do {
        t->used[run] = true;
        push_corner(list, from_of(&t->outline->run[run]));
        run = next_run(t, start, run);
    } while (run != start && run != PIR_SPACE_NONE && t->space->status == PIR_OK);
    loop.count = list->corner_count - loop.first;
    if (run == PIR_SPACE_NONE || loop.count < 2)
        pir_space_fault(t->space);
    if (!pir_space_grow(t->space, (void **)&list->loop, &list->room, list->count, sizeof *list->loop))
        return;
    loop.hole = is_hole(t, &loop);
    turn_loop(t, &loop);
    list->loop[list->count++] = loop;
}

/* --- holes --- */

static bool holds(struct loop_tracer *t, const pir_loop *loop, uint32_t point) {
    const uint32_t *corner = t->list->corner + loop->first;
    bool inside = false;
    for (uint32_t i = 0; i < loop->count; i++) {
        const uint32_t a = corner[i], b = corner[i + 1 < loop->count ? i + 1 : 0];
        const bool from = pir_space_order(t->space, t->axis[1], point, a) > 0;
        const bool to = pir_space_order(t->space, t->axis[1], point, b) > 0;
        if (from != to)
            inside ^= (pir_space_turn(t->space, t->half, a, b, point) > 0) == to;
    }
    return inside;
}

/* Twice the area of a loop that goes round a facet, seen along one axis, up to a sign that all loops of the plane
 * share: exactly, as a product over all corners. */
static void exact_area(struct loop_tracer *t, const pir_loop *loop, mpq_t ret_area) {
    const uint32_t *corner = t->list->corner + loop->first;
    pir_space *space = t->space;
    mpq_t term;
    mpq_init(term);
    mpq_set_ui(ret_area, 0, 1);
    for (uint32_t i = 0; i < loop->count && space->status == PIR_OK; i++) {
        const uint32_t p = pir_space_exact_point(space, corner[i]);
        const uint32_t q = pir_space_exact_point(space, corner[i + 1 < loop->count ? i + 1 : 0]);
        if (space->status != PIR_OK)
            break;
        mpz_t *x = space->number + p, *y = space->number + q;
        mpz_mul(mpq_numref(term), x[t->level[0]], y[t->level[1]]);
        mpz_submul(mpq_numref(term), x[t->level[1]], y[t->level[0]]);
        mpz_mul(mpq_denref(term), x[3], y[3]);
        mpq_canonicalize(term);
        mpq_add(ret_area, ret_area, term);
    }
    mpq_abs(ret_area, ret_area);
    mpq_clear(term);
}

/* Whether the first of two loops, one of which is within the other, is the inner one. */
static bool is_inner(struct loop_tracer *t, const pir_loop *a, const pir_loop *b) {
    mpq_t area[2];
    mpq_inits(area[0], area[1], NULL);
    exact_area(t, a, area[0]);
    exact_area(t, b, area[1]);
    const bool inner = mpq_cmp(area[0], area[1]) < 0;
    mpq_clears(area[0], area[1], NULL);
    return inner;
}

/* The innermost of the facets' loops that hold the hole: loops of one plane do not cross, so those nest. */
static void find_facet(struct loop_tracer *t, uint32_t hole) {
    pir_loop_list *list = t->list;
    uint32_t within = hole;
    for (uint32_t l = t->first_loop; l < list->count && t->space->status == PIR_OK; l++) {
        const pir_loop *loop = &list->loop[l];
        if (!loop->hole && holds(t, loop, list->corner[list->loop[hole].first]) &&
            (within == hole || is_inner(t, loop, &list->loop[within])))
            within = l;
    }
    list->loop[hole].within = within;
    if (within == hole)
        pir_space_fault(t->space);
}

static void trace_group(struct loop_tracer *t) {
    pir_loop_list *list = t->list;
    t->first_loop = list->count;
    set_axes(t);
    for (uint32_t r = t->first; r < t->end && t->space->status == PIR_OK; r++)
        if (!t->used[r])
            trace_loop(t, r);
    if (t->space->status == PIR_OK)
        sort_loops(t);
    for (uint32_t l = t->first_loop; l < list->count && t->space->status == PIR_OK; l++)
        if (list->loop[l].hole)
            find_facet(t, l);
    for (uint32_t l = t->first_loop; l < list->count && t->space->status == PIR_OK; l++)
        if (!list->loop[l].hole)
            pir_loops_add_facet(list, t->half, l);
}

void pir_loops_begin(pir_loop_list *loops, pir_space *space) {
    loops->space = space;
    loops->count = loops->corner_count = loops->facet_count = loops->facet_corner_count = 0;
    loops->boundary_count = loops->hole_count = 0;
}

void pir_loops_push_corner(pir_loop_list *loops, uint32_t point) {
    if (pir_space_grow(loops->space, (void **)&loops->facet_corner, &loops->facet_corner_room,
                       loops->facet_corner_count, sizeof *loops->facet_corner))
        loops->facet_corner[loops->facet_corner_count++] = point;
}

void pir_loops_end_facet(pir_loop_list *loops) {
    if (pir_space_grow(loops->space, (void **)&loops->facet, &loops->facet_room, loops->facet_count,
                       sizeof *loops->facet))
        loops->facet[loops->facet_count++] = loops->facet_corner_count;
}

void pir_loops_trace(pir_loop_list *loops, const pir_union_outline *outline) {
    pir_space *space = outline->space;
    struct loop_tracer t = {.list = loops, .space = space, .outline = outline};
    mpz_set_ui(space->t[0], 61);
    mpz_set_ui(space->t[1], 53);
    mpz_set_ui(space->t[2], 41);
    t.along = pir_space_add_direction(space, space->t[0], space->t[1], space->t[2]);
    if (!pir_space_grow(space, (void **)&loops->used, &loops->used_room, outline->run_count, sizeof *loops->used))
        return;
    t.used = loops->used;
    memset(t.used, 0, outline->run_count * sizeof *t.used);
    for (t.first = 0; t.first < outline->run_count && space->status == PIR_OK; t.first = t.end) {
        const pir_run run = outline->run[t.first];
        t.half = run.half;
        for (t.end = t.first + 1; t.end < outline->run_count && outline->run[t.end].group == run.group; t.end++)
            ;
        if (run.group < PIR_GROUP_CROSSING)
            trace_group(&t);
        if (run.group < outline->loose)
            loops->boundary_count = loops->facet_count;
    }
}

void pir_loop_list_finish(pir_loop_list *loops) {
    if (!loops->space)
        return;
    pir_space_shrink(loops->space, loops->loop, loops->room, sizeof *loops->loop);
    pir_space_shrink(loops->space, loops->corner, loops->corner_room, sizeof *loops->corner);
    pir_space_shrink(loops->space, loops->facet, loops->facet_room, sizeof *loops->facet);
    pir_space_shrink(loops->space, loops->facet_corner, loops->facet_corner_room, sizeof *loops->facet_corner);
    pir_space_shrink(loops->space, loops->spare, loops->spare_room, sizeof *loops->spare);
    pir_space_shrink(loops->space, loops->used, loops->used_room, sizeof *loops->used);
    pir_space_shrink(loops->space, loops->seat, loops->seat_room, sizeof *loops->seat);
    pir_space_shrink(loops->space, loops->order, loops->order_room, sizeof *loops->order);
    pir_space_shrink(loops->space, loops->work, loops->work_room, sizeof *loops->work);
    pir_space_shrink(loops->space, loops->copy, loops->copy_room, sizeof *loops->copy);
    *loops = (pir_loop_list){0};
}
