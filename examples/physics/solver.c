/* SPDX-License-Identifier: MIT */
/* Impulses; see solver.h. The impulse of a point acts on P, and its opposite on Q. */
#include "solver.h"

/* The spring of overlap: its frequency, at most a quarter of the steps', and its damping ratio. */
#define SPRING_HERTZ   60
#define SPRING_DAMPING 10
/* Overlap is worked off at most at this speed, in m/s, so that a bad start does not explode. */
#define PUSH_MOST 3
/* Slower approaches do not bounce, in m/s. */
#define BOUNCE_LEAST 0.5
/* Depth, in metres, that is left alone, so that contacts at rest stay contacts. */
#define SLOP 0.0002

static bool yields(const struct body *p, const struct body *q) {
    return (p->inverse_mass > 0 && !p->asleep) || (q->inverse_mass > 0 && !q->asleep);
}

static void apply(struct body *p, struct body *q, const struct point *point, pir_vec3 impulse) {
    p->velocity = vec_add(p->velocity, vec_times(p->inverse_mass, impulse));
    p->spin = vec_add(p->spin, mat_times(&p->inverse_in_world, vec_cross(point->at_p, impulse)));
    q->velocity = vec_less(q->velocity, vec_times(q->inverse_mass, impulse));
    q->spin = vec_less(q->spin, mat_times(&q->inverse_in_world, vec_cross(point->at_q, impulse)));
}

/* How fast P moves as Q sees it, at a point. */
static pir_vec3 relative(const struct body *p, const struct body *q, const struct point *point) {
    pir_vec3 of_p = vec_add(p->velocity, vec_cross(p->spin, point->at_p));
    return vec_less(of_p, vec_add(q->velocity, vec_cross(q->spin, point->at_q)));
}

/* The impulse along a unit direction that changes the relative speed along it by 1. */
static double mass_along(const struct body *p, const struct body *q, const struct point *point, pir_vec3 n) {
    pir_vec3 a = vec_cross(point->at_p, n), b = vec_cross(point->at_q, n);
    double inverse = p->inverse_mass + q->inverse_mass + vec_dot(a, mat_times(&p->inverse_in_world, a)) +
                     vec_dot(b, mat_times(&q->inverse_in_world, b));
    return inverse > 0 ? 1 / inverse : 0;
}

void solver_begin(struct body *body, const struct contacts *contacts) {
    for (uint32_t i = 0; i < contacts->link_count; i++) {
        const struct link *link = &contacts->link[i];
        struct body *p = &body[link->body_p], *q = &body[link->body_q];
        if (!yields(p, q))
            continue;
        for (uint32_t k = link->first; k < link->first + link->count; k++) {
            struct point *point = &contacts->point[k];
            point->mass = mass_along(p, q, point, link->normal);
            point->mass_across[0] = mass_along(p, q, point, link->across[0]);
            point->mass_across[1] = mass_along(p, q, point, link->across[1]);
            point->approach = vec_dot(relative(p, q, point), link->normal);
            apply(p, q, point, vec_add(vec_times(point->impulse, link->normal), point->rub));
        }
    }
}

/* How a contact yields: its speed apart is to be −speed, of which so much counts, and so much impulse is let go. */
struct softness {
    double speed, share, leak;
};

static struct softness softness_of(double distance, double step, bool push) {
    if (distance > 0)
        return (struct softness){distance / step, 1, 0};
    if (!push)
        return (struct softness){0, 1, 0};
    const double pi = 3.14159265358979323846;
    double omega = 2 * pi * fmin(SPRING_HERTZ, 0.25 / step), a = 2 * SPRING_DAMPING + step * omega,
           b = step * omega * a, c = 1 / (1 + b), rate = omega / a;
    return (struct softness){fmax(rate * fmin(distance + SLOP, 0), -PUSH_MOST), b * c, c};
}

static void rub(struct body *p, struct body *q, const struct link *link, struct point *point, double friction) {
    pir_vec3 speed = relative(p, q, point), old = point->rub, next = old;
    for (int i = 0; i < 2; i++)
        next = vec_less(next, vec_times(point->mass_across[i] * vec_dot(speed, link->across[i]), link->across[i]));
    double most = friction * point->impulse, length = vec_length(next);
    if (length > most)
        next = vec_times(most / length, next);
    point->rub = next;
    apply(p, q, point, vec_less(next, old));
}

static void press(struct body *p, struct body *q, const struct link *link, struct point *point,
                  const struct softness *soft) {
    double speed = vec_dot(relative(p, q, point), link->normal), old = point->impulse;
    double change = -point->mass * soft->share * (speed + soft->speed) - soft->leak * old;
    point->impulse = fmax(old + change, 0);
    apply(p, q, point, vec_times(point->impulse - old, link->normal));
}

void solver_pass(struct body *body, const struct contacts *contacts, double step, bool push) {
    for (uint32_t i = 0; i < contacts->link_count; i++) {
        const struct link *link = &contacts->link[i];
        struct body *p = &body[link->body_p], *q = &body[link->body_q];
        if (!yields(p, q))
            continue;
        double friction = sqrt(p->friction * q->friction);
        // friction first: what holds bodies apart matters more, so it has the last word
        for (uint32_t k = link->first; k < link->first + link->count; k++)
            rub(p, q, link, &contacts->point[k], friction);
        for (uint32_t k = link->first; k < link->first + link->count; k++) {
            struct softness soft = softness_of(contacts->point[k].distance, step, push);
            press(p, q, link, &contacts->point[k], &soft);
        }
    }
}

void solver_advance(const struct body *body, const struct contacts *contacts, double step) {
    for (uint32_t i = 0; i < contacts->link_count; i++) {
        const struct link *link = &contacts->link[i];
        for (uint32_t k = link->first; k < link->first + link->count; k++) {
            struct point *point = &contacts->point[k];
            pir_vec3 speed = relative(&body[link->body_p], &body[link->body_q], point);
            point->distance += step * vec_dot(speed, link->normal);
        }
    }
}

void solver_bounce(struct body *body, const struct contacts *contacts) {
    for (uint32_t i = 0; i < contacts->link_count; i++) {
        const struct link *link = &contacts->link[i];
        struct body *p = &body[link->body_p], *q = &body[link->body_q];
        double restitution = fmax(p->restitution, q->restitution);
        if (restitution == 0 || !yields(p, q))
            continue;
        for (uint32_t k = link->first; k < link->first + link->count; k++) {
            struct point *point = &contacts->point[k];
            if (point->approach < -BOUNCE_LEAST && point->impulse > 0)
                press(p, q, link, point, &(struct softness){restitution * point->approach, 1, 0});
        }
    }
}
