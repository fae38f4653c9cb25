/* SPDX-License-Identifier: MIT */
/* Impacts; see bounce.h. */
#include "bounce.h"

/* Passes that stop an approach, and how often what then still approaches bounces again. */
#define PASSES_MOST 40
#define ROUNDS_MOST 8
/* A pass that changes no speed by more than this part of the fastest approach is the last. */
#define SMALL 1e-9

/* Marks what bounces; the fastest approach, 0 where there is none. */
static double mark(const struct body *body, const struct contacts *contacts, const struct solver_rules *rules) {
    double fastest = 0;
    for (uint32_t i = 0; i < contacts->link_count; i++) {
        const struct link *link = &contacts->link[i];
        const struct body *p = &body[link->body_p], *q = &body[link->body_q];
        bool may = solver_yields(p, q);
        for (uint32_t k = link->first; k < link->first + link->count; k++) {
            struct point *point = &contacts->point[k];
            point->bounce.is = false;
            if (!may || point->distance > rules->near)
                continue;
            pir_vec3 before = solver_relative(p, q, point), none = {0, 0, 0};
            double speed = vec_dot(before, link->normal);
            point->bounce.is = speed < -rules->bounce;
            point->bounce.before = before;
            point->bounce.impulse = 0;
            point->bounce.rub = point->bounce.both = none;
            if (point->bounce.is)
                fastest = fmax(fastest, -speed);
        }
    }
    return fastest;
}

/* Stops the approach at a contact, and rubs there; by how much that changes the speed. */
static double stop(struct body *p, struct body *q, const struct link *link, struct point *point) {
    pir_vec3 speed = solver_relative(p, q, point), old = point->bounce.rub, next = old;
    double was = point->bounce.impulse, approach = vec_dot(speed, link->normal);
    point->bounce.impulse = fmax(was - point->mass * approach, 0);
    for (int i = 0; i < 2; i++)
        next = vec_less(next, vec_times(point->mass_across[i] * vec_dot(speed, link->across[i]), link->across[i]));
    double most = solver_friction(p, q) * point->bounce.impulse, length = vec_length(next);
    if (length > most)
        next = vec_times(length > 0 ? most / length : 0, next);
    point->bounce.rub = next;
    double change = point->bounce.impulse - was;
    solver_apply(p, q, point, vec_add(vec_times(change, link->normal), vec_less(next, old)));
    return point->mass > 0 ? fabs(change) / point->mass : 0;
}

static void stop_all(struct body *body, const struct contacts *contacts, double fastest) {
    double most = fastest;
    for (int pass = 0; pass < PASSES_MOST && most > SMALL * fastest; pass++) {
        most = 0;
        for (uint32_t i = 0; i < contacts->link_count; i++) {
            const struct link *link = &contacts->link[i];
            for (uint32_t k = link->first; k < link->first + link->count; k++)
                if (contacts->point[k].bounce.is)
                    most = fmax(most, stop(&body[link->body_p], &body[link->body_q], link, &contacts->point[k]));
        }
    }
}

/* --- work --- */

static uint32_t leader(uint32_t *group, uint32_t i) {
    while (group[i] != i)
        i = group[i] = group[group[i]];
    return i;
}

/* Bodies that impacts link have one leader; those that do not yield link none. */
static void link_bodies(struct body *body, uint32_t count, const struct contacts *contacts, uint32_t *group) {
    for (uint32_t i = 0; i < count; i++) {
        group[i] = i;
        body[i].work = body[i].change = 0;
    }
    for (uint32_t i = 0; i < contacts->link_count; i++) {
        const struct link *link = &contacts->link[i];
        bool any = false;
        for (uint32_t k = link->first; k < link->first + link->count; k++)
            any |= contacts->point[k].bounce.is;
        if (any && body[link->body_p].inverse_mass > 0 && body[link->body_q].inverse_mass > 0)
            group[leader(group, link->body_p)] = leader(group, link->body_q);
    }
}

/* Whose group a link counts for. */
static uint32_t owner_of(const struct body *body, const struct link *link, uint32_t *group) {
    return leader(group, body[link->body_p].inverse_mass > 0 ? link->body_p : link->body_q);
}

/*
 * The impulses j of a group, taken s times, do the work s·Σj·u + s²/2·Σj·(u' − u): u is the
 * velocity before, u' after. Where that is above 0 for s = 1, less is taken.
 */
static void limit_work(struct body *body, uint32_t count, const struct contacts *contacts, uint32_t *group) {
    link_bodies(body, count, contacts, group);
    for (int again = 0; again < 2; again++)
        for (uint32_t i = 0; i < contacts->link_count; i++) {
            const struct link *link = &contacts->link[i];
            struct body *p = &body[link->body_p], *q = &body[link->body_q];
            struct body *owner = &body[owner_of(body, link, group)];
            for (uint32_t k = link->first; k < link->first + link->count; k++) {
                struct point *point = &contacts->point[k];
                if (!point->bounce.is)
                    continue;
                if (!again) {
                    pir_vec3 change = vec_less(solver_relative(p, q, point), point->bounce.before);
                    owner->work += vec_dot(point->bounce.both, point->bounce.before);
                    owner->change += vec_dot(point->bounce.both, change);
                } else if (owner->work + 0.5 * owner->change > 0) {
                    double part = fmax(-2 * owner->work / owner->change, 0);
                    solver_apply(p, q, point, vec_times(part - 1, point->bounce.both));
                }
            }
        }
}

void bounce_all(struct body *body, uint32_t count, const struct contacts *contacts, const struct solver_rules *rules,
                uint32_t *group) {
    for (int round = 0; round < ROUNDS_MOST; round++) {
        double fastest = mark(body, contacts, rules);
        if (fastest == 0)
            return;
        stop_all(body, contacts, fastest);
        for (uint32_t i = 0; i < contacts->link_count; i++) {
            const struct link *link = &contacts->link[i];
            struct body *p = &body[link->body_p], *q = &body[link->body_q];
            for (uint32_t k = link->first; k < link->first + link->count; k++) {
                struct point *point = &contacts->point[k];
                if (!point->bounce.is)
                    continue;
                pir_vec3 stops = vec_times(point->bounce.impulse, link->normal);
                pir_vec3 more = vec_times(solver_restitution(p, q), stops);
                point->bounce.both = vec_add(vec_add(stops, more), point->bounce.rub);
                solver_apply(p, q, point, more);
                point->spent += vec_dot(vec_add(stops, more), link->normal);
            }
        }
        limit_work(body, count, contacts, group);
    }
}
