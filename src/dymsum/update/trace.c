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
 *
 * Where many facets are traced, floats answer first, from the rings that a review has just read. They are off by less
 * than a slack, and what holds for all values within it holds for those by doubles: then both give the same trace.
 * Where floats are not certain, doubles begin anew.
 */
#include "dymsum/update/trace.h"

#include "base/fetching.h"
#include "dymsum/pairing/predicates.h"

/* The last step, as facets of one operand have it. */
struct trace_step {
    const pir_facets *facets;
    const pir_polytope *own, *other;
    bool of_p;
    double stride; /* the angle of the step about the epoch's axis, rounded away from 0 */
    double error;  /* E */
};

struct facet_tracer {
    const struct trace_step *step;
    uint32_t facet;
    pir_vec3 turned, motion; /* the normal rotated to the other operand's frame, and its motion about the axis */
    float packed[8];         /* the two, as kernels take them */
    pir_trace *trace;
};

/* How a cell was left. */
struct exit {
    uint32_t count, half; /* how many circles the facet is past, and the halfedge of the one that it crossed first */
    double s, rising;     /* how far it is past that circle, and the derivative */
    bool known;           /* false: the order is not certain */
};

/*
 * The interval of angles ago at which s was zero, where it rises at `rising`: roots of s − s'a ± a²/2, widened by
 * the error, of all values within the slack. Both ends grow with s and shrink with s'.
 */
static void angle_of_exit(double s, double rising, double error, double slack, double *ret_least, double *ret_most) {
    double fast = rising + slack, slow = rising - slack, below = s - slack, above = s + slack;
    double rest = slow * slow - (above + above + 2 * error);
    *ret_least = sqrt(fast * fast + (below + below - 2 * error)) - fast;
    *ret_most = rest > 0 ? slow - sqrt(rest) : HUGE_VAL;
}

/* Adds the circle of `half`, which was crossed outwards. The values are off by less than `slack`. */
static void add_exit(struct exit *exit, uint32_t half, double s, double rising, double error, double slack) {
    if (exit->count++ > 0) {
        double least, most, least_before, most_before;
        angle_of_exit(s, rising, error, slack, &least, &most);
        angle_of_exit(exit->s, exit->rising, error, slack, &least_before, &most_before);
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
 * Compares `count` sides from halfedge h on, at most SIDES. Returns a mask of the affected ones: those that may have
 * been touched in the step, or that the facet is past. Nothing branches here, for no processor foresees which.
 */
static inline uint32_t compare_sides(const struct facet_tracer *tracer, uint32_t h, uint32_t count,
                                     struct sides *ret_sides) {
    const double stride = fabs(tracer->step->stride), farthest = 0.5 * stride * stride + 2 * tracer->step->error;
    const pir_vec3 *direction = tracer->step->other->direction + h;
    uint32_t affected = 0;
    for (uint32_t i = 0; i < count; i++) {
        double s = pir_vec_dot(tracer->turned, direction[i]), rate = pir_vec_dot(tracer->motion, direction[i]);
        ret_sides->s[i] = s;
        ret_sides->rate[i] = rate;
        affected |= (uint32_t)((fabs(s) <= fabs(rate) * stride + farthest) | (s >= 0)) << i;
    }
    return affected;
}

/* Adds an affected side to the exit. */
static inline void see_side(const struct facet_tracer *tracer, uint32_t h, double s, double rate, struct exit *exit) {
    const double stride = fabs(tracer->step->stride), error = tracer->step->error, size = fabs(s), speed = fabs(rate);
    const double rising = tracer->step->stride < 0 ? -rate : rate;
    bool reached = size <= speed * stride + (0.5 * stride * stride + 2 * error);
    exit->known = reached && size > 2 * error && speed > 2 * stride + 2 * error && (s < 0 || rising > 0);
    if (exit->known && s > 0)
        add_exit(exit, h, s, rising, error, 0);
}

/* Finds the side through which the facet has left the cell of v. */
static struct exit find_exit(const struct facet_tracer *tracer, uint32_t v) {
    const uint32_t end = tracer->step->other->ring_start[v + 1];
    struct exit exit = {.known = true};
    for (uint32_t h = tracer->step->other->ring_start[v]; h < end && exit.known; h += SIDES) {
        struct sides sides;
        uint32_t affected = compare_sides(tracer, h, end - h < SIDES ? end - h : SIDES, &sides);
        for (; affected && exit.known; affected &= affected - 1) {
            uint32_t i = (uint32_t)__builtin_ctz(affected);
            see_side(tracer, h + i, sides.s[i], sides.rate[i], &exit);
        }
    }
    return exit;
}

/* Follows a facet by doubles. */
static void follow_by_doubles(struct facet_tracer *tracer) {
    const struct trace_step *step = tracer->step;
    pir_trace *trace = tracer->trace;
    trace->count = trace->signs = 0;
    trace->cell = trace->from;
    for (;;) {
        const uint32_t *ring = &step->other->ring_start[trace->cell];
        struct exit exit = find_exit(tracer, trace->cell);
        trace->signs += ring[1] - ring[0];
        if (!exit.known || (exit.count > 0 && trace->count == PIR_TRACE_LONGEST)) {
            trace->count = PIR_TRACE_UNKNOWN;
            return;
        }
        if (exit.count == 0)
            return;
        trace->crossed[trace->count++] = exit.half;
        trace->cell = step->other->target[exit.half];
    }
}

/* --- by floats --- */

/* Both values are off by less, and so is what this file makes of them by floats. */
#define SLACK ((double)PIR_FLOAT_BOUND)

/* Returns a mask of the directions of a block that floats do not prove untouched by the step. */
static inline uint32_t compare_block(const struct facet_tracer *tracer, const pir_ring *ring, float *ret_s,
                                     float *ret_rate) {
    const float *u = tracer->packed, stride = (float)fabs(tracer->step->stride);
    const float farthest = (float)(0.5 * (double)stride * (double)stride + 2 * tracer->step->error + 2 * SLACK);
    uint32_t affected = 0;
    for (uint32_t i = 0; i < PIR_LANES; i++) {
        ret_s[i] = u[0] * ring->x[i] + u[1] * ring->y[i] + u[2] * ring->z[i];
        ret_rate[i] = u[4] * ring->x[i] + u[5] * ring->y[i] + u[6] * ring->z[i];
    }
    for (uint32_t i = 0; i < PIR_LANES; i++)
        affected |= (uint32_t)(-ret_s[i] <= fabsf(ret_rate[i]) * stride + farthest) << i;
    return affected;
}

/* As see_side, where that is certain of all values within the slack. */
static inline void see_side_by_floats(const struct facet_tracer *tracer, uint32_t h, double s, double rate,
                                      struct exit *exit) {
    const double stride = fabs(tracer->step->stride), error = tracer->step->error;
    const double size = fabs(s) - SLACK, speed = fabs(rate) - SLACK, rising = tracer->step->stride < 0 ? -rate : rate;
    bool reached = size + 2 * SLACK <= speed * stride + (0.5 * stride * stride + 2 * error);
    exit->known = reached && size > 2 * error && speed > 2 * stride + 2 * error && (s < 0 || rising > 0);
    if (exit->known && s > 0)
        add_exit(exit, h, s, rising, error, SLACK);
}

/* The exit from the cell, which has so many sides. Its halfedge is counted from the first of the ring. */
static struct exit find_exit_by_floats(const struct facet_tracer *tracer, uint32_t cell, uint32_t sides) {
    const pir_ring *ring = pir_ring_of(tracer->step->facets, cell);
    struct exit exit = {.known = true};
    for (uint32_t h = 0; h < sides && exit.known; h += PIR_LANES, ring++) {
        float s[PIR_LANES], rate[PIR_LANES];
        uint32_t affected = compare_block(tracer, ring, s, rate) & (uint32_t)pir_side_mask(sides - h);
        for (; affected && exit.known; affected &= affected - 1) {
            uint32_t i = (uint32_t)__builtin_ctz(affected);
            see_side_by_floats(tracer, h + i, (double)s[i], (double)rate[i], &exit);
        }
    }
    return exit;
}

/* Follows a facet through one cell. False where its trace is at an end, or is to be made by doubles. */
static bool follow_on(const struct facet_tracer *tracer, bool *ret_sure) {
    const pir_facets *facets = tracer->step->facets;
    pir_trace *trace = tracer->trace;
    uint32_t start = facets->ring_start[trace->cell], sides = facets->ring_start[trace->cell + 1] - start;
    struct exit exit = find_exit_by_floats(tracer, trace->cell, sides);
    trace->signs += sides;
    *ret_sure = exit.known && (exit.count == 0 || trace->count < PIR_TRACE_LONGEST);
    if (!*ret_sure || exit.count == 0)
        return false;
    trace->crossed[trace->count++] = start + exit.half;
    const pir_ring *ring = pir_ring_of(facets, trace->cell) + exit.half / PIR_LANES;
    trace->cell = ring->target[exit.half % PIR_LANES];
    PIR_FETCH(&facets->ring_start[trace->cell]);
    ring = pir_ring_of(facets, trace->cell);
    PIR_FETCH(ring->x);
    PIR_FETCH(ring->z);
    return true;
}

/* --- all that are open --- */

/* So many facets are followed at a time, each through a cell in turn. */
#define AT_A_TIME 32

/* Turns a facet to where it is now. */
static void turn_tracer(const pir_tracked *tracked, const struct trace_step *step, uint32_t facet, pir_trace *trace,
                        struct facet_tracer *ret_tracer) {
    pir_vec3 turned =
        step->of_p ? pir_rotated_normal(&tracked->pairing, facet) : pir_turned_back_normal(&tracked->pairing, facet);
    *ret_tracer =
        (struct facet_tracer){.step = step,
                              .facet = facet,
                              .turned = turned,
                              .motion = step->of_p ? pir_motion_of(tracked, turned) : pir_motion_back(tracked, turned),
                              .trace = trace};
    pir_pack_turned(ret_tracer->turned, ret_tracer->motion, ret_tracer->packed);
}

/* Certifies a facet in the cell at the end of its trace. */
static void certify(pir_tracked *tracked, const struct facet_tracer *tracer) {
    const pir_facets *facets = tracer->step->facets;
    pir_cell_probe seen;
    tracked->kernels->probe(facets, &tracked->step, tracer->trace->cell, tracer->packed, &seen);
    const pir_expiry expiry = {seen.check.margin, seen.check.ahead, -seen.check.behind};
    facets->cell[tracer->facet] = tracer->trace->cell;
    pir_tracked_certify(tracked, facets->first_certificate + tracer->facet, &expiry);
}

static void follow(pir_tracked *tracked, struct facet_tracer *tracer, uint32_t count) {
    uint32_t going[AT_A_TIME];
    for (uint32_t i = 0; i < count; i++)
        going[i] = i;
    for (uint32_t remaining = count; remaining > 0;) {
        uint32_t on = 0;
        for (uint32_t k = 0; k < remaining; k++) {
            struct facet_tracer *t = &tracer[going[k]];
            bool sure;
            if (follow_on(t, &sure)) {
                going[on++] = going[k];
                continue;
            }
            if (!sure)
                follow_by_doubles(t);
            if (t->trace->count != PIR_TRACE_UNKNOWN)
                certify(tracked, t);
        }
        remaining = on;
    }
}

/* The last step as facets of P or of Q have it. */
static struct trace_step step_of(const pir_tracked *tracked, bool of_p) {
    const pir_epoch *epoch = &tracked->epoch;
    const pir_polytope *p = tracked->pairing.p, *q = tracked->pairing.q;
    return (struct trace_step){of_p ? &tracked->p_facets : &tracked->q_facets,
                               of_p ? p : q,
                               of_p ? q : p,
                               of_p,
                               epoch->stride * (1 + 0x1p-20),
                               (PIR_SIGN_BOUND + 2 * epoch->drift) * (1 + 0x1p-20)};
}

/* Begins the trace of a facet. */
static bool begin_trace(const struct trace_step *step, uint32_t facet, pir_trace *trace) {
    const bool followed = fabs(step->stride) <= PIR_FOLLOWED_FARTHEST;
    trace->from = trace->cell = step->facets->cell[facet];
    trace->count = followed ? 0 : PIR_TRACE_UNKNOWN;
    trace->signs = 0;
    return followed;
}

/* Follows `count` facets, at most AT_A_TIME. */
static void trace_facets(pir_tracked *tracked, bool of_p, const uint32_t *facet, uint32_t count,
                         pir_trace *ret_traces) {
    const struct trace_step step = step_of(tracked, of_p);
    struct facet_tracer tracer[AT_A_TIME];
    bool followed = true;
    for (uint32_t i = 0; i < count; i++) {
        followed &= begin_trace(&step, facet[i], &ret_traces[i]);
        PIR_FETCH(&step.own->normal[facet[i]]);
    }
    for (uint32_t i = 0; i < count && followed; i++)
        turn_tracer(tracked, &step, facet[i], &ret_traces[i], &tracer[i]);
    if (followed)
        follow(tracked, tracer, count);
}

uint32_t pir_trace_open(pir_tracked *tracked, bool of_p, const pir_suspect *suspects, uint32_t count, uint32_t room,
                        pir_trace *ret_traces) {
    uint32_t facet[AT_A_TIME], batch = 0, traced = 0;
    for (uint32_t i = 0; i < count && traced + batch < room; i++) {
        facet[batch] = suspects[i].facet;
        batch += suspects[i].crossed == PIR_NO_SIDE;
        if (batch == AT_A_TIME) {
            trace_facets(tracked, of_p, facet, batch, ret_traces + traced);
            traced += batch;
            batch = 0;
        }
    }
    if (batch > 0)
        trace_facets(tracked, of_p, facet, batch, ret_traces + traced);
    return traced + batch;
}

void pir_trace_one(pir_tracked *tracked, bool of_p, uint32_t facet, pir_trace *ret_trace) {
    const struct trace_step step = step_of(tracked, of_p);
    struct facet_tracer tracer;
    if (!begin_trace(&step, facet, ret_trace))
        return;
    turn_tracer(tracked, &step, facet, ret_trace, &tracer);
    follow_by_doubles(&tracer);
    if (ret_trace->count != PIR_TRACE_UNKNOWN)
        certify(tracked, &tracer);
}
