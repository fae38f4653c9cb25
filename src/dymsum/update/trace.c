/* SPDX-License-Identifier: MIT */
/*
 * The cells that a facet crosses in one step, from the cell where it was to the one where it is, side by side.
 *
 * The step turns the facet's normal about a known axis by an angle T. Its value s against the circle of a side was
 * s(−a) = s − s'a ± a²/2 an angle a ago, a from 0 to T, where s and s' are those of now. The error of s is at
 * most E, the sign's bound and twice the epoch's drift. Where |s'| is at least 2T + E, s is monotonic through the step,
 * and the circle is crossed at most once. So in a cell that the facet has entered, or in which it began:
 *
 *   - It was on the inner side of every circle when it entered. A circle that it is past now, it has crossed since,
 *     outwards.
 *   - A circle that it is not past it has not crossed since, because it would have crossed it twice.
 *
 * Hence it has left the cell if it is past some circle, through the side of the circle that it crossed first: the only
 * one, or the one whose interval of possible angles lies before those of the others. From there the next cell is
 * examined in the same way. Where a value is within E of zero, where a circle within reach may have been crossed twice,
 * or where the order is not certain, the trace gives no answer.
 */
#include "dymsum/update/trace.h"

#include "dymsum/pairing/predicates.h"

struct tracer {
    const pir_facets *facets;
    const pir_polytope *other;
    pir_vec3 turned,
        motion;    /* the facet's normal rotated to the other operand's frame, and its motion about the epoch's axis */
    double stride; /* the angle of the step about that axis, rounded away from 0 */
    double error;  /* E */
};

/* How a cell was left. */
struct exit {
    uint32_t count, half; /* how many circles the facet is past, and the halfedge of the one that it crossed first */
    double s, rising;     /* how far it is past that circle, and the derivative */
    bool known;           /* false: the order is not certain */
};

/*
 * The interval of angles ago at which s was zero, where it rises at `rising`: roots of s − s'a ± a²/2, widened by
 * the error.
 */
static void angle_of_exit(double s, double rising, double error, double *ret_least, double *ret_most) {
    double square = rising * rising, rest = square - (s + s + 2 * error);
    *ret_least = sqrt(square + (s + s - 2 * error)) - rising;
    *ret_most = rest > 0 ? rising - sqrt(rest) : HUGE_VAL;
}

/* Adds the circle of `half`, which was crossed outwards. */
static void add_exit(struct exit *exit, uint32_t half, double s, double rising, double error) {
    if (exit->count++ > 0) {
        double least, most, least_before, most_before;
        angle_of_exit(s, rising, error, &least, &most);
        angle_of_exit(exit->s, exit->rising, error, &least_before, &most_before);
        if (least_before > most)
            return;
        exit->known = least > most_before;
    }
    exit->half = half;
    exit->s = s;
    exit->rising = rising;
}

/* Sides that are compared at a time. */
#define SIDES 32

/* The values of sides and their derivatives. */
struct sides {
    double s[SIDES], rate[SIDES];
};

/*
 * Compares `count` sides from halfedge h on, at most SIDES. Returns a bit for each that may have been touched in the
 * step or that the facet is past; which ones these are is not foreseen, so that nothing branches here.
 */
static inline uint32_t compare_sides(const struct tracer *tracer, uint32_t h, uint32_t count, struct sides *ret_sides) {
    const double stride = fabs(tracer->stride), farthest = 0.5 * stride * stride + 2 * tracer->error;
    const pir_vec3 *direction = tracer->other->direction + h;
    uint32_t concerned = 0;
    for (uint32_t i = 0; i < count; i++) {
        double s = pir_vec_dot(tracer->turned, direction[i]), rate = pir_vec_dot(tracer->motion, direction[i]);
        ret_sides->s[i] = s;
        ret_sides->rate[i] = rate;
        concerned |= (uint32_t)((fabs(s) <= fabs(rate) * stride + farthest) | (s >= 0)) << i;
    }
    return concerned;
}

/* Adds a side that is concerned to the exit. */
static inline void see_side(const struct tracer *tracer, uint32_t h, double s, double rate, struct exit *exit) {
    const double stride = fabs(tracer->stride), error = tracer->error, size = fabs(s), speed = fabs(rate);
    const double rising = tracer->stride < 0 ? -rate : rate;
    bool reached = size <= speed * stride + (0.5 * stride * stride + 2 * error);
    exit->known = reached && size > 2 * error && speed > 2 * stride + 2 * error && (s < 0 || rising > 0);
    if (exit->known && s > 0)
        add_exit(exit, h, s, rising, error);
}

/* Finds the side through which the facet has left the cell of v. */
static struct exit find_exit(const struct tracer *tracer, uint32_t v) {
    const uint32_t end = tracer->other->ring_start[v + 1];
    struct exit exit = {.known = true};
    for (uint32_t h = tracer->other->ring_start[v]; h < end && exit.known; h += SIDES) {
        struct sides sides;
        uint32_t concerned = compare_sides(tracer, h, end - h < SIDES ? end - h : SIDES, &sides);
        for (; concerned && exit.known; concerned &= concerned - 1) {
            uint32_t i = (uint32_t)__builtin_ctz(concerned);
            see_side(tracer, h + i, sides.s[i], sides.rate[i], &exit);
        }
    }
    return exit;
}

static bool follow(pir_tracked *tracked, const struct tracer *tracer, uint32_t from, pir_trace *ret_trace) {
    if (!(fabs(tracer->stride) <= PIR_FOLLOWED_FARTHEST))
        return false;
    ret_trace->count = 0;
    ret_trace->cell = from;
    for (;;) {
        const uint32_t *ring = &tracer->other->ring_start[ret_trace->cell];
        struct exit exit = find_exit(tracer, ret_trace->cell);
        tracked->pairing.signs.by_filter += ring[1] - ring[0];
        if (!exit.known || (exit.count > 0 && ret_trace->count == PIR_TRACE_LONGEST))
            return false;
        if (exit.count == 0)
            break;
        ret_trace->crossed[ret_trace->count++] = exit.half;
        ret_trace->cell = tracer->other->target[exit.half];
    }
    float turned[8];
    pir_pack_turned(tracer->turned, tracer->motion, turned);
    pir_probe seen;
    tracked->kernels->probe(tracer->facets, &tracked->step, ret_trace->cell, turned, &seen);
    ret_trace->expiry = (pir_expiry){seen.check.margin, seen.check.ahead, -seen.check.behind};
    return true;
}

/* The facet of normal `turned` in the cells of `other`. */
static struct tracer tracer_of(const pir_tracked *tracked, const pir_facets *facets, const pir_polytope *other,
                               pir_vec3 turned, pir_vec3 motion) {
    const pir_epoch *epoch = &tracked->epoch;
    return (struct tracer){facets,
                           other,
                           turned,
                           motion,
                           epoch->stride * (1 + 0x1p-20),
                           (PIR_SIGN_BOUND + 2 * epoch->drift) * (1 + 0x1p-20)};
}

bool pir_trace_fv(pir_tracked *tracked, uint32_t f, pir_trace *ret_trace) {
    pir_vec3 turned = pir_rotated_normal(&tracked->pairing, f);
    const struct tracer tracer =
        tracer_of(tracked, &tracked->p_facets, tracked->pairing.q, turned, pir_motion_of(tracked, turned));
    return follow(tracked, &tracer, tracked->pairing.fv[f], ret_trace);
}

bool pir_trace_vf(pir_tracked *tracked, uint32_t g, pir_trace *ret_trace) {
    pir_vec3 turned = pir_turned_back_normal(&tracked->pairing, g);
    const struct tracer tracer =
        tracer_of(tracked, &tracked->q_facets, tracked->pairing.p, turned, pir_motion_back(tracked, turned));
    return follow(tracked, &tracer, tracked->pairing.vf[g], ret_trace);
}
