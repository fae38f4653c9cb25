/* SPDX-License-Identifier: MIT */
/*
 * The way out of a union of differences. The facets of all D that hold P are tried by rising depth: the first through
 * whose foot P comes to a place where it meets nothing is the shortest way out by one facet. In a valley there may be
 * none, since the foot on one side is inside of the other. Then P takes, of each triangle's least way out, the longest,
 * and looks again from there.
 */
#include "mesh/contact/way_out.h"

#include "mesh/contact/contact_facets.h"

/* Ways tried from one place, and places. */
#define MOST_WAYS   48
#define MOST_PLACES 12
/* How far P is taken off a triangle, by its size. */
#define STEP 0x1p-12
/* How much of a normal may lead into the back of a one-sided triangle: this chooses what is tried, no more. */
#define BACKWARD (-0x1p-30)
/* Ways this near to one another are tried once. */
#define DOUBLE 0x1p-40
/* Distances this near to one another, by their size, are one where the side of P is told: no sign is taken from it. */
#define LEVEL 0x1p-30

struct exit_way {
    pir_vec3 n;
    double depth;
};

/* The least ways from a place, rising. */
struct exit_ways {
    struct exit_way way[MOST_WAYS];
    uint32_t count;
    double missed;         /* the least depth that had no room */
    double front;          /* the greatest depth along a front */
    struct exit_way least; /* of the triangle that is looked at */
    double far;
    const pir_near_triangle *s;
};

static bool is_near(pir_vec3 a, pir_vec3 b) {
    pir_vec3 way = pir_vec_sub(a, b);
    return pir_vec_dot(way, way) < DOUBLE * DOUBLE;
}

static void add_way(void *context, const pir_contact_facet *facet) {
    struct exit_ways *ways = context;
    if (ways->s->one_sided && pir_vec_dot(facet->n, ways->s->front) < BACKWARD)
        return;
    double depth = fmax(facet->depth, 0);
    if (facet->kind == PIR_CONTACT_FRONT)
        ways->front = fmax(ways->front, depth);
    if (depth < ways->least.depth)
        ways->least = (struct exit_way){facet->n, depth};
    for (uint32_t k = 0; k < ways->count; k++)
        if (ways->way[k].depth <= depth && is_near(ways->way[k].n, facet->n) &&
            depth - ways->way[k].depth <= DOUBLE * ways->far)
            return;
    uint32_t at = ways->count;
    while (at > 0 && ways->way[at - 1].depth > depth)
        at--;
    if (at == MOST_WAYS) {
        ways->missed = fmin(ways->missed, depth);
        return;
    }
    if (ways->count == MOST_WAYS)
        ways->missed = fmin(ways->missed, ways->way[MOST_WAYS - 1].depth);
    else
        ways->count++;
    for (uint32_t k = ways->count - 1; k > at; k--)
        ways->way[k] = ways->way[k - 1];
    ways->way[at] = (struct exit_way){facet->n, depth};
}

/* The cosine of the angle between the way to P and the front; 0 for triangles that have no side. */
static double side_of(const pir_near_triangle *s) {
    return s->one_sided ? pir_vec_dot(s->near.way, s->front) / s->near.distance : 1;
}

/*
 * Whether P, without its radius, is at the back of the nearest triangle. Of triangles that are as near, as on both
 * sides of an edge, the one that faces P the most tells.
 */
static bool is_at_back(const pir_contact_job *job) {
    double least = HUGE_VAL, side = 0;
    for (uint32_t i = 0; i < job->triangle_count; i++)
        if (job->triangle[i].counts)
            least = fmin(least, job->triangle[i].near.distance);
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        const pir_near_triangle *s = &job->triangle[i];
        if (s->counts && s->near.distance <= least * (1 + LEVEL) && fabs(side_of(s)) > fabs(side))
            side = side_of(s);
    }
    return side < 0 && least < job->input->radius;
}

/* Sets `passed`, where P without its radius meets nothing; whether any is. */
static bool find_passed(pir_contact_job *job) {
    bool passed = false;
    if (job->input->radius == 0 || !is_at_back(job))
        return false;
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        pir_near_triangle *s = &job->triangle[i];
        s->passed = s->counts && s->near.distance < job->input->radius && side_of(s) < 0;
        passed |= s->passed;
    }
    return passed;
}

bool pir_contact_look(pir_contact_job *job, pir_vec3 t) {
    const pir_contact_place place = pir_place_at(t);
    bool meets = false;
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        pir_near_triangle *s = &job->triangle[i];
        s->passed = false;
        s->counts = !pir_contact_is_behind(job, &place, s);
        if (!s->counts)
            continue;
        pir_contact_nearest(job, &place, s, &s->near);
        meets |= s->near.meets;
    }
    return meets || find_passed(job);
}

/* All ways from a place that was looked at, and of each triangle's least one the longest. */
static struct exit_way find_ways(pir_contact_job *job, pir_vec3 t, struct exit_ways *ways) {
    struct exit_way longest = {{0, 0, 0}, -1};
    ways->count = 0;
    ways->missed = HUGE_VAL;
    ways->front = 0;
    ways->far = job->radius;
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        const pir_near_triangle *s = &job->triangle[i];
        if (!s->counts || (!s->near.meets && !s->passed))
            continue;
        ways->s = s;
        ways->least.depth = HUGE_VAL;
        if (s->passed)
            pir_contact_front_facet(job, t, s, add_way, ways);
        else
            pir_contact_each_facet(job, t, s, add_way, ways);
        if (ways->least.depth < HUGE_VAL && ways->least.depth > longest.depth)
            longest = ways->least;
    }
    return longest;
}

pir_vec3 pir_contact_place_by(const pir_contact_job *job, pir_vec3 by) {
    pir_vec3 start = job->input->pose.translation;
    by = (pir_vec3){pir_contact_on_grid(job, by.x), pir_contact_on_grid(job, by.y), pir_contact_on_grid(job, by.z)};
    for (int again = 0; again < 3; again++)
        by = pir_vec_sub(pir_vec_add(start, by), start);
    return pir_vec_add(start, by);
}

double pir_contact_step(const pir_contact_job *job) {
    return STEP * (job->radius + job->input->radius) + 64 * job->error;
}

/* Where a way leads from t. */
static pir_vec3 along(const pir_contact_job *job, pir_vec3 t, const struct exit_way *way, double step) {
    pir_vec3 moved = pir_vec_sub(t, job->input->pose.translation);
    return pir_contact_place_by(job, pir_vec_add(moved, pir_vec_scale(way->n, way->depth + step)));
}

/* Whether a direction, along which no vertex of P is below `least`, takes a triangle apart from P at t by doubles. */
static bool is_clear_along(const pir_contact_job *job, double least, const pir_near_triangle *s, pir_vec3 n,
                           pir_vec3 t) {
    double most = -HUGE_VAL;
    for (int k = 0; k < 3; k++)
        most = fmax(most, pir_vec_dot(n, pir_vec_sub(s->p[k], t)));
    return least - most > 16 * job->error;
}

static bool is_met_at(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s) {
    return !pir_contact_is_behind(job, place, s) && pir_contact_meets(job, place, s);
}

/* The first triangle that counts and that P meets at t; UINT32_MAX for none. */
static uint32_t first_met(pir_contact_job *job, pir_vec3 t, pir_vec3 n) {
    const pir_contact_place place = pir_place_at(t);
    double least = HUGE_VAL;
    for (uint32_t v = 0; v < job->p->vertex_count; v++)
        least = fmin(least, pir_vec_dot(n, job->vertex[v]));
    for (uint32_t i = 0; i < job->triangle_count; i++)
        if (!is_clear_along(job, least, &job->triangle[i], n, t) && is_met_at(job, &place, &job->triangle[i]))
            return i;
    return UINT32_MAX;
}

static bool is_gathered(const pir_contact_job *job, pir_vec3 t) {
    pir_vec3 way = pir_vec_sub(t, job->input->pose.translation);
    double most = fmax(fabs(way.x), fmax(fabs(way.y), fabs(way.z)));
    return most + job->input->margin + job->input->radius <= job->grown;
}

/* Whether P, which meets nothing at t, has passed nothing either. */
static bool is_in_front(pir_contact_job *job, pir_vec3 t) {
    return job->input->radius == 0 || !pir_contact_look(job, t);
}

/*
 * Whether a way ends where P meets nothing: a step off the triangle, or a small part of it, where another one is that
 * near.
 */
static bool try_way(pir_contact_job *job, pir_vec3 t, const struct exit_way *way, double step, pir_vec3 *ret_to) {
    *ret_to = along(job, t, way, step);
    if (!is_gathered(job, *ret_to))
        return false;
    uint32_t met = first_met(job, *ret_to, way->n);
    if (met == UINT32_MAX && is_in_front(job, *ret_to))
        return true;
    *ret_to = along(job, t, way, PIR_CONTACT_PART_STEP * step); // likewise gathered
    const pir_contact_place place = pir_place_at(*ret_to);
    return (met == UINT32_MAX || !is_met_at(job, &place, &job->triangle[met])) &&
           first_met(job, *ret_to, way->n) == UINT32_MAX && is_in_front(job, *ret_to);
}

/* The first of the ways that ends where P meets nothing. */
static bool try_ways(pir_contact_job *job, pir_vec3 t, struct exit_ways *ways, double step, struct exit_way *ret_way,
                     pir_vec3 *ret_to) {
    for (uint32_t i = 0; i < ways->count; i++) {
        *ret_way = ways->way[i];
        if (try_way(job, t, ret_way, step, ret_to))
            return true;
        if (!is_gathered(job, *ret_to))
            ways->missed = fmin(ways->missed, ret_way->depth);
    }
    return false;
}

pir_status pir_contact_find_way_out(pir_contact_job *job, pir_way_out *ret_out) {
    pir_vec3 start = job->input->pose.translation, t = start;
    double step = pir_contact_step(job);
    struct exit_ways ways;
    struct exit_way way = find_ways(job, t, &ways);
    // a thin core that leaves one triangle by its side may still have to come up through its neighbour
    double most = fmax(way.depth, job->input->radius > 0 ? ways.front : 0);
    double need = job->input->margin + job->input->radius + 3 * (most + step);
    if (need > job->grown) {
        pir_status status = pir_contact_job_gather(job, need);
        if (status == PIR_OK)
            status = pir_contact_exact_reserve(job);
        if (status != PIR_OK)
            return status;
    }
    double depth = 0;
    *ret_out = (pir_way_out){.t = t};
    for (int place = 0; place < MOST_PLACES && !ret_out->is_out; place++) {
        ret_out->is_out = !pir_contact_look(job, t);
        if (ret_out->is_out)
            break;
        struct exit_way longest = find_ways(job, t, &ways);
        pir_vec3 to;
        ret_out->is_out = try_ways(job, t, &ways, step, &way, &to);
        ret_out->is_shortest = ret_out->is_out && place == 0 && way.depth < ways.missed;
        if (!ret_out->is_out && longest.depth < 0)
            break;
        depth += ret_out->is_out ? way.depth : longest.depth;
        t = ret_out->is_out ? to : along(job, t, &longest, step);
        if (!is_gathered(job, t))
            break;
    }
    ret_out->t = t;
    ret_out->way = pir_vec_sub(t, start);
    ret_out->depth = ret_out->is_shortest ? depth : pir_length(ret_out->way);
    return PIR_OK;
}
