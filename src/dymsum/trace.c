/* SPDX-License-Identifier: MIT */
/*
 * The way of a facet through one step, from the cell where it was to the one where it is, side by side.
 *
 * The step turns the facet's normal about a known axis by an angle T, and its value s against the circle of a side goes the way
 * s(−a) = s − s'a ± a²/2, a from 0 to T, where s and s' are those of now and all is off by E, the sign's bound and the slack for drift.
 * Where |s'| is at least 2T + E, s changes monotonically through the step, and the circle is crossed once at most. So in a cell that the
 * facet has come into, or began in:
 *
 *   - it was on the inner side of every circle when it came. A circle that it is past now, it has crossed since, going outwards.
 *   - a circle that it is not past it has not crossed since, for it would have crossed it twice.
 *
 * Hence it has left the cell if it is past some circle, through the side of the circle that it crossed first: the only one, or the one
 * whose span of possible times lies before those of the others. From there the next cell is looked at in the same way. Where a value is
 * within E of zero, where a circle within reach may have been crossed twice, or where the order is open, nothing is said.
 */
#include "dymsum/sum.h"

struct tracer {
    const pir_polytope *other;
    pir_vec3 turned, motion; /* the facet's normal turned to the other operand, and how that moves along the step */
    bool backwards;          /* the step went against the clock's axis */
    double stride;           /* its angle, rounded up */
};

/* What is found in one cell. */
struct exits {
    uint32_t count, first; /* how many circles it is past, and the halfedge of the one that it crossed first */
    double least, most;    /* how long ago that was */
    bool known;            /* false: too close to call */
};

#define ERROR (PIR_SIGN_BOUND + PIR_SLEEP_SLACK)

/* Takes in that the circle of halfedge h, s beyond which the facet is now, was crossed outwards at a rate of `rising`. */
static void add_exit(struct exits *exits, uint32_t h, double s, double rising) {
    // roots of s − s'a ± a²/2, the error taken to widen the span
    double square = rising * rising, short_of = square - (s + s + 2 * ERROR);
    double least = sqrt(square + (s + s - 2 * ERROR)) - rising, most = short_of > 0 ? rising - sqrt(short_of) : HUGE_VAL;
    if (exits->count++ == 0 || least > exits->most) {
        exits->first = h, exits->least = least, exits->most = most;
    } else if (!(exits->least > most)) {
        exits->known = false;
    }
}

/* Looks for the side through which the facet has left the cell of v. */
static struct exits look_for_exits(const struct tracer *tracer, uint32_t v, pir_sleep *ret_sleep) {
    const pir_polytope *other = tracer->other;
    const double stride = tracer->stride;
    struct exits exits = {.known = true};
    *ret_sleep = pir_sleep_long();
    for (uint32_t h = other->ring_start[v]; h < other->ring_start[v + 1] && exits.known; h++) {
        double s = pir_vec_dot(tracer->turned, other->direction[h]),
               rate = pir_vec_dot(tracer->motion, other->direction[h]), size = fabs(s), speed = fabs(rate);
        pir_sleep_until_change(ret_sleep, s, rate);
        bool reached = size <= speed * stride + 0.5 * stride * stride + 2 * ERROR;
        if (!reached && s < 0)
            continue;
        double rising = tracer->backwards ? -rate : rate;
        exits.known = reached && size > 2 * ERROR && speed > 2 * stride + 2 * ERROR && (s < 0 || rising > 0);
        if (exits.known && s > 0)
            add_exit(&exits, h, s, rising);
    }
    return exits;
}

static bool follow(pir_sum *sum, const struct tracer *tracer, uint32_t from, pir_trace *ret_trace) {
    ret_trace->count = 0;
    ret_trace->cell = from;
    for (;;) {
        const uint32_t *ring = &tracer->other->ring_start[ret_trace->cell];
        struct exits exits = look_for_exits(tracer, ret_trace->cell, &ret_trace->sleep);
        sum->signs.by_filter += ring[1] - ring[0];
        if (!exits.known || (exits.count > 0 && ret_trace->count == PIR_TRACE_LONGEST))
            return false;
        if (exits.count == 0)
            return true;
        ret_trace->crossed[ret_trace->count++] = exits.first;
        ret_trace->cell = tracer->other->target[exits.first];
    }
}

/* The angle of the last step; false when it is too long for this to say anything. */
static bool take_step(const pir_sum *sum, struct tracer *tracer) {
    tracer->backwards = sum->clock.stride < 0;
    tracer->stride = fabs(sum->clock.stride) * (1 + 0x1p-20);
    return tracer->stride < 0.25;
}

bool pir_trace_fv(pir_sum *sum, uint32_t f, pir_trace *ret_trace) {
    pir_vec3 turned = pir_rotated_normal(sum, f);
    struct tracer tracer = {.other = sum->q, .turned = turned, .motion = pir_motion_of(sum, turned)};
    return take_step(sum, &tracer) && follow(sum, &tracer, sum->fv[f], ret_trace);
}

bool pir_trace_vf(pir_sum *sum, uint32_t g, pir_trace *ret_trace) {
    pir_vec3 turned = pir_turned_back_normal(sum, g);
    struct tracer tracer = {.other = sum->p, .turned = turned, .motion = pir_motion_back(sum, turned)};
    return take_step(sum, &tracer) && follow(sum, &tracer, sum->vf[g], ret_trace);
}
