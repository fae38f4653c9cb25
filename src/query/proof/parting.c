/* SPDX-License-Identifier: MIT */
/*
 * See parting.h. A point of the body is over the plane by
 *
 *     f(τ) = c + w·τ + a·cos(θτ) + b·sin(θτ),
 *
 * τ after the pose at hand. Its curve bends by at most Dθ² with D² = a² + b², so a parabola below it bounds the
 * first time at which it may have come down, and the bound is taken again from there. Where the point is nearly
 * down, the parabola is nearly the curve: few bounds are needed. Between c + wτ − D and c + wτ + D it swings:
 * before the lower of them reaches the plane the point does not, and after that it has within one turn. So the
 * number of bounds does not depend on the number of turns.
 */
#include "query/proof/parting.h"

/* The most bounds for one point; after so many the time that is proven stands. */
#define MOST_BOUNDS 64
/* Beyond this angle only the greatest speed counts. */
#define MOST_TURN 0x1p20

struct swing {
    double c, w, a, b, d;
};

double pir_parted_reach(const pir_vec3 *point, uint32_t count, pir_vec3 centre) {
    double most = 0;
    for (uint32_t i = 0; i < count; i++)
        most = fmax(most, pir_vec_length(pir_vec_sub(point[i], centre)));
    return most * (1 + 0x1p-48) + 0x1p-1074;
}

/* Sine and cosine by the series of base/pose.c, the angle taken into one turn first: the same bits everywhere. */
static void sine_and_cosine(double angle, double *ret_sine, double *ret_cosine) {
    // 2π in two parts; the first has so few bits that its multiples are exact
    double turns = rint(angle * 0.15915494309189535), rest = angle - turns * 0x1.921fb544p+2;
    rest -= turns * 0x1.0b4611a626331p-32;
    double part = 0.0625 * rest, square = part * part, sine = 1, cosine = 1;
    for (int k = 8; k > 0; k--) {
        sine = 1 - square / (2 * k * (2 * k + 1)) * sine;
        cosine = 1 - square / (2 * k * (2 * k - 1)) * cosine;
    }
    sine *= part;
    for (int i = 0; i < 4; i++) {
        double doubled = 2 * sine * cosine;
        cosine = 1 - 2 * sine * sine;
        sine = doubled;
    }
    *ret_sine = sine;
    *ret_cosine = cosine;
}

/* The time after which f may be at `least`, from a place where it is f with the slope s. */
static double bound_of(double f, double slope, double bend) {
    double root = sqrt(slope * slope + 2 * bend * f);
    if (slope <= 0)
        return 2 * f / (root - slope);
    return bend > 0 ? (slope + root) / bend : HUGE_VAL;
}

/* When the point is down, from 0 on, or HUGE_VAL where it is not until `end`. */
static double fall_of(const struct swing *s, double theta, const pir_parting *plane, double end) {
    const double bend = s->d * theta * theta;
    double time = 0;
    for (int i = 0; i < MOST_BOUNDS; i++) {
        // while even the lowest that it swings to is above, nothing happens
        double lowest = s->c + s->w * time - s->d;
        if (lowest > plane->near)
            time = s->w < 0 ? fmax(time, (plane->near - s->c + s->d) / s->w) : HUGE_VAL;
        if (!(time <= end))
            return HUGE_VAL;
        double sine, cosine;
        sine_and_cosine(theta * time, &sine, &cosine);
        double f = s->c + s->w * time + s->a * cosine + s->b * sine;
        if (f <= plane->near)
            return time;
        double slope = s->w + theta * (s->b * cosine - s->a * sine);
        time += bound_of(f - plane->least, slope, bend) * (1 - 0x1p-40);
    }
    return time;
}

double pir_part_until(const pir_parted *body, const pir_parting *plane, pir_pose pose, double distance, double time,
                      double end) {
    const pir_vec3 n = plane->normal;
    const double theta = sqrt(pir_vec_dot(body->turn, body->turn)), w = pir_vec_dot(body->way, n);
    if (!(theta > 0 && theta <= MOST_TURN)) {
        double rate = theta * body->reach - w;
        return rate > 0 ? time + fmax(distance - 0.5 * (plane->least + plane->near), 0) / rate : HUGE_VAL;
    }
    const pir_vec3 axis = pir_vec_scale(body->turn, 1 / theta);
    const pir_vec3 lever = pir_vec_cross(n, axis);
    const double along = pir_vec_dot(n, axis), until = end - time;
    // no point comes down faster than this
    const double rate = theta * body->reach * sqrt(pir_vec_dot(lever, lever)) - w;
    if (distance - plane->near > rate * (1 + 0x1p-40) * until)
        return HUGE_VAL;
    const pir_vec3 centre = pir_vec_add(pose.translation, pir_pose_rotate(pose, body->centre));
    const double c = pir_vec_dot(n, pir_vec_sub(centre, plane->foot)) - body->radius;
    const pir_vec3 in_body = pir_pose_rotate_inverse(pose, n), axis_in_body = pir_pose_rotate_inverse(pose, axis),
                   across = pir_vec_cross(in_body, axis_in_body);
    double first = HUGE_VAL;
    for (uint32_t v = 0; v < body->count; v++) {
        const pir_vec3 r = pir_vec_sub(body->point[v], body->centre);
        struct swing s = {.w = w, .a = pir_vec_dot(in_body, r), .b = pir_vec_dot(across, r)};
        double still = along * pir_vec_dot(axis_in_body, r);
        s.a -= still;
        s.c = c + still;
        s.d = sqrt(s.a * s.a + s.b * s.b) * (1 + 0x1p-48);
        double to = fmin(until, first);
        if (s.c - s.d + fmin(0, w * to) > plane->near)
            continue;
        first = fmin(first, fall_of(&s, theta, plane, to));
    }
    return first <= until ? time + first : HUGE_VAL;
}

/* --- motions --- */

pir_status pir_motion_check(const pir_motion *motion, double tolerance) {
    if (!pir_vec_is_finite(motion->way) || !pir_vec_is_finite(motion->turn) || isnan(tolerance) || isnan(motion->held))
        return PIR_ERR_NOT_FINITE;
    if (!(tolerance > 0 && tolerance < HUGE_VAL && motion->held >= 0))
        return PIR_ERR_ARGUMENT;
    return sqrt(pir_vec_dot(motion->turn, motion->turn)) <= MOST_TURN ? PIR_OK : PIR_ERR_LIMIT;
}

pir_status pir_screw_check(const pir_exact_motion *motion, double most_degrees) {
    if (!pir_vec_is_finite(motion->pivot) || !pir_vec_is_finite(motion->axis) || !pir_vec_is_finite(motion->way) ||
        !isfinite(motion->degrees))
        return PIR_ERR_NOT_FINITE;
    const pir_vec3 u = motion->axis;
    const double most = fmax(fmax(fabs(u.x), fabs(u.y)), fabs(u.z)), degrees = fabs(motion->degrees);
    if (degrees > most_degrees || (degrees > 0 && most == 0))
        return PIR_ERR_ARGUMENT;
    return degrees > 0 && !(most >= 0x1p-400 && most <= 0x1p400) ? PIR_ERR_LIMIT : PIR_OK;
}

/* How near a body has to come to have met another that is `distance` away at time 0; 0 where it cannot. */
static double near_of(const pir_advance *advance, double distance) {
    const double held = advance->motion->held, least = advance->least;
    if (!(held > 0) || distance > fmax(advance->tolerance, held))
        return fmax(advance->tolerance, least);
    return distance > held && 0.5 * distance > least ? 0.5 * distance : 0;
}

/*
 * The normal n from Q to P at some time, and Q's point nearest to P, make a plane that has Q below it for good, since Q
 * is at rest. The bodies are apart until P comes down to it. There the distance is asked for again, and its plane parts
 * them further. A step goes to part of what counts as met, so that few are needed.
 */
pir_status pir_advance_run(pir_advance *advance) {
    double near = 0;
    advance->outcome = PIR_CAST_STEP_LIMIT;
    advance->time = 0;
    for (int step = 0; step < advance->steps && advance->outcome == PIR_CAST_STEP_LIMIT; step++) {
        pir_pose pose;
        pir_status status = advance->ask(advance, &pose);
        if (status != PIR_OK)
            return status;
        if (advance->outcome != PIR_CAST_STEP_LIMIT)
            break;
        const double distance = advance->answer.distance;
        near = step == 0 ? near_of(advance, distance) : near;
        if (near == 0 || distance <= near) {
            advance->outcome = near == 0 ? PIR_CAST_MISS : PIR_CAST_HIT;
            break;
        }
        const pir_parting plane = {advance->answer.normal, advance->answer.point_q, 0.75 * near, 0.5 * near};
        advance->time = pir_part_until(&advance->body, &plane, pose, distance, advance->time, advance->until);
        if (!(advance->time <= advance->until))
            advance->outcome = PIR_CAST_MISS;
    }
    return PIR_OK;
}
