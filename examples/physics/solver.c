/* SPDX-License-Identifier: MIT */
/* Impulses; see solver.h. The impulse of a point acts on P, and its opposite on Q. */
#include "solver.h"

/* Overlap is worked off by this part in a step, and at most at this speed, in m/s, so that a bad start does not
 * explode. */
#define PUSH_PART 0.2
#define PUSH_MOST 3

bool solver_yields(const struct body *p, const struct body *q) {
    return (p->inverse_mass > 0 && !p->asleep) || (q->inverse_mass > 0 && !q->asleep);
}

void solver_apply(struct body *p, struct body *q, const struct point *point, pir_vec3 impulse) {
    p->velocity = vec_add(p->velocity, vec_times(p->inverse_mass, impulse));
    p->spin = vec_add(p->spin, mat_times(&p->inverse_in_world, vec_cross(point->at_p, impulse)));
    q->velocity = vec_less(q->velocity, vec_times(q->inverse_mass, impulse));
    q->spin = vec_less(q->spin, mat_times(&q->inverse_in_world, vec_cross(point->at_q, impulse)));
}

static pir_vec3 speed_at(pir_vec3 velocity, pir_vec3 spin, pir_vec3 at) {
    return vec_add(velocity, vec_cross(spin, at));
}

pir_vec3 solver_relative(const struct body *p, const struct body *q, const struct point *point) {
    return vec_less(speed_at(p->velocity, p->spin, point->at_p), speed_at(q->velocity, q->spin, point->at_q));
}

double solver_restitution(const struct body *p, const struct body *q) {
    return fmax(p->restitution, q->restitution);
}

double solver_friction(const struct body *p, const struct body *q) {
    return sqrt(p->friction * q->friction);
}

/* The impulse along a unit direction that changes the relative speed along it by 1. */
static double mass_along(const struct body *p, const struct body *q, const struct point *point, pir_vec3 n) {
    pir_vec3 a = vec_cross(point->at_p, n), b = vec_cross(point->at_q, n);
    double inverse = p->inverse_mass + q->inverse_mass + vec_dot(a, mat_times(&p->inverse_in_world, a)) +
                     vec_dot(b, mat_times(&q->inverse_in_world, b));
    return inverse > 0 ? 1 / inverse : 0;
}

void solver_place(const struct body *body, const struct contacts *contacts) {
    for (uint32_t i = 0; i < contacts->link_count; i++) {
        const struct link *link = &contacts->link[i];
        const struct body *p = &body[link->body_p], *q = &body[link->body_q];
        for (uint32_t k = link->first; k < link->first + link->count && solver_yields(p, q); k++) {
            struct point *point = &contacts->point[k];
            point->mass = mass_along(p, q, point, link->normal);
            point->mass_across[0] = mass_along(p, q, point, link->across[0]);
            point->mass_across[1] = mass_along(p, q, point, link->across[1]);
        }
    }
}

void solver_begin(struct body *body, const struct contacts *contacts, const struct solver_rules *rules) {
    for (uint32_t i = 0; i < contacts->link_count; i++) {
        const struct link *link = &contacts->link[i];
        struct body *p = &body[link->body_p], *q = &body[link->body_q];
        for (uint32_t k = link->first; k < link->first + link->count && solver_yields(p, q); k++) {
            struct point *point = &contacts->point[k];
            point->push = 0;
            point->free =
                point->distance > rules->near && vec_dot(solver_relative(p, q, point), link->normal) < -rules->bounce;
            p->flies |= point->free;
            q->flies |= point->free;
            p->touches |= point->distance <= rules->near;
            q->touches |= point->distance <= rules->near;
        }
    }
    for (uint32_t i = 0; i < contacts->link_count; i++) {
        const struct link *link = &contacts->link[i];
        struct body *p = &body[link->body_p], *q = &body[link->body_q];
        for (uint32_t k = link->first; k < link->first + link->count && solver_yields(p, q); k++) {
            struct point *point = &contacts->point[k];
            if (point->free) {
                point->impulse = 0;
                point->rub = (pir_vec3){0, 0, 0};
            }
            solver_apply(p, q, point, vec_add(vec_times(point->impulse, link->normal), point->rub));
        }
    }
}

static void rub(struct body *p, struct body *q, const struct link *link, struct point *point) {
    pir_vec3 speed = solver_relative(p, q, point), old = point->rub, next = old;
    for (int i = 0; i < 2; i++)
        next = vec_less(next, vec_times(point->mass_across[i] * vec_dot(speed, link->across[i]), link->across[i]));
    double most = solver_friction(p, q) * point->impulse, length = vec_length(next);
    if (length > most)
        next = vec_times(most / length, next);
    point->rub = next;
    solver_apply(p, q, point, vec_less(next, old));
}

/* Bodies that are apart may come as near as they rest. */
static void press(struct body *p, struct body *q, const struct link *link, struct point *point,
                  const struct solver_rules *rules) {
    double may = fmax(point->distance - rules->gap, 0) / rules->step;
    double speed = vec_dot(solver_relative(p, q, point), link->normal), old = point->impulse;
    point->impulse = fmax(old - point->mass * (speed + may), 0);
    solver_apply(p, q, point, vec_times(point->impulse - old, link->normal));
}

static void push_apart(struct body *p, struct body *q, const struct link *link, struct point *point,
                       const struct solver_rules *rules) {
    double want = fmin(-PUSH_PART * (point->distance + rules->slop) / rules->step, PUSH_MOST), old = point->push;
    double speed =
        vec_dot(vec_less(speed_at(p->push, p->push_spin, point->at_p), speed_at(q->push, q->push_spin, point->at_q)),
                link->normal);
    point->push = fmax(old + point->mass * (want - speed), 0);
    pir_vec3 impulse = vec_times(point->push - old, link->normal);
    p->push = vec_add(p->push, vec_times(p->inverse_mass, impulse));
    p->push_spin = vec_add(p->push_spin, mat_times(&p->inverse_in_world, vec_cross(point->at_p, impulse)));
    q->push = vec_less(q->push, vec_times(q->inverse_mass, impulse));
    q->push_spin = vec_less(q->push_spin, mat_times(&q->inverse_in_world, vec_cross(point->at_q, impulse)));
}

static void pass(struct body *body, const struct contacts *contacts, const struct solver_rules *rules, bool push,
                 bool back) {
    for (uint32_t i = 0; i < contacts->link_count; i++) {
        const struct link *link = &contacts->link[back ? contacts->link_count - 1 - i : i];
        struct body *p = &body[link->body_p], *q = &body[link->body_q];
        if (!solver_yields(p, q))
            continue;
        // friction first: what holds bodies apart matters more, so it has the last word
        for (uint32_t k = link->first; k < link->first + link->count; k++)
            if (!contacts->point[k].free)
                rub(p, q, link, &contacts->point[k]);
        for (uint32_t k = link->first; k < link->first + link->count; k++) {
            struct point *point = &contacts->point[k];
            if (!point->free)
                press(p, q, link, point, rules);
            if (push && (point->distance < -rules->slop || point->push > 0))
                push_apart(p, q, link, point, rules);
        }
    }
}

void solver_passes(struct body *body, const struct contacts *contacts, const struct solver_rules *rules, uint32_t count,
                   bool push) {
    // to and fro, so that in a stack what the top says comes down as fast as what the ground says goes up
    for (uint32_t i = 0; i < count; i++)
        pass(body, contacts, rules, push, i % 2 == 0);
}
