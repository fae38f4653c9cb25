/* SPDX-License-Identifier: MIT */
/*
 * The way out of a union of differences. The facets of all D that hold P are tried by rising depth: the first through
 * whose foot P comes to a place where it meets nothing is the shortest way out by one facet. In a valley there may be
 * none, since the foot on one side is inside of the other. Then P takes, of each triangle's least way out, the longest,
 * and looks again from there.
 */
#include "mesh/contact/way_out.h"

#include <math.h>

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
    double most; /* of ways past triangles that P does not meet: none is as long */
    bool loose;  /* also ways at whose ends P is beside their facets */
    const pir_contact_job *job;
    pir_vec3 t;
    const pir_near_triangle *s;
};

static bool is_near(pir_vec3 a, pir_vec3 b) {
    pir_vec3 way = pir_vec_sub(a, b);
    return pir_vec_dot(way, way) < DOUBLE * DOUBLE;
}

/* Puts a way in its place; none that is there already. */
static void insert(struct exit_ways *ways, struct exit_way way) {
    uint32_t at = ways->count;
    while (at > 0 && ways->way[at - 1].depth > way.depth)
        at--;
    for (uint32_t k = at; k > 0 && way.depth - ways->way[k - 1].depth <= DOUBLE * ways->far; k--)
        if (is_near(ways->way[k - 1].n, way.n))
            return;
    if (ways->count == MOST_WAYS)
        ways->missed = pir_lesser(ways->missed, pir_greater(ways->way[MOST_WAYS - 1].depth, way.depth));
    else
        ways->count++;
    for (uint32_t k = ways->count - 1; k > at; k--)
        ways->way[k] = ways->way[k - 1];
    if (at < MOST_WAYS)
        ways->way[at] = way;
}

static void add_way(void *context, const pir_contact_facet *facet) {
    struct exit_ways *ways = context;
    if (ways->s->one_sided && pir_vec_dot(facet->n, ways->s->front) < BACKWARD)
        return;
    double depth = pir_greater(facet->depth, 0);
    if (facet->kind == PIR_CONTACT_FRONT)
        ways->front = pir_greater(ways->front, depth);
    if (depth < ways->least.depth)
        ways->least = (struct exit_way){facet->n, depth};
    const bool is_full = ways->count == MOST_WAYS;
    if (is_full && depth >= pir_lesser(ways->missed, ways->way[MOST_WAYS - 1].depth))
        ways->missed = pir_lesser(ways->missed, depth);
    else if (ways->loose || pir_contact_may_touch(ways->job, ways->t, ways->s, facet))
        insert(ways, (struct exit_way){facet->n, depth});
}

static void add_shorter_way(void *context, const pir_contact_facet *facet) {
    struct exit_ways *ways = context;
    const bool back = ways->s->one_sided && pir_vec_dot(facet->n, ways->s->front) < BACKWARD;
    if (!back && facet->depth > 0 && facet->depth < ways->most &&
        pir_contact_may_touch(ways->job, ways->t, ways->s, facet))
        insert(ways, (struct exit_way){facet->n, facet->depth});
}

/* The cosine of the angle between the way to P and the front; 0 for triangles that have no side. */
static double side_of(const pir_near_triangle *s) {
    return s->one_sided ? pir_vec_dot(s->near.way, s->front) / s->near.distance : 1;
}

/* The angle that a triangle has about its nearest point: all round within it, half on a side, its own at a corner. */
static double angle_of(const pir_near_triangle *s) {
    const pir_contact_simplex *near = &s->near.simplex;
    uint32_t corners = 0;
    for (uint32_t i = 0; i < near->count; i++)
        corners |= 1u << near->w[i];
    const double half = acos(-1);
    if ((corners & (corners - 1)) != 0)
        return corners == 7 ? 2 * half : half;
    const uint32_t at = corners == 4 ? 2 : corners == 2 ? 1 : 0;
    const pir_vec3 a = pir_vec_sub(s->p[(at + 1) % 3], s->p[at]), b = pir_vec_sub(s->p[(at + 2) % 3], s->p[at]);
    return acos(fmax(-1, fmin(1, pir_vec_dot(a, b) / (pir_length(a) * pir_length(b)))));
}

/*
 * Whether P, without its radius, is at the back of the nearest triangle. Of triangles that share the nearest point, as
 * on both sides of an edge, the sum of their fronts tells, each weighted by its angle there: on a closed surface that
 * is right for any edge or corner (Bærentzen and Aanæs, 2005).
 */
static bool is_at_back(const pir_contact_job *job) {
    const pir_near_triangle *nearest = NULL;
    double side = 0;
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        const pir_near_triangle *s = &job->triangle[i];
        if (s->counts && (!nearest || s->near.distance < nearest->near.distance))
            nearest = s;
    }
    if (!nearest || !(nearest->near.distance < job->input->radius))
        return false;
    const double level = LEVEL * (job->size + nearest->near.distance);
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        const pir_near_triangle *s = &job->triangle[i];
        if (!s->counts || s->near.distance > nearest->near.distance + level ||
            pir_length(pir_vec_sub(s->near.point, nearest->near.point)) > level)
            continue;
        if (!s->one_sided)
            return false;
        side += angle_of(s) * pir_vec_dot(nearest->near.way, s->front);
    }
    return side < 0;
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

/*
 * Looks at one triangle: whether it counts. P without its radius has a point in front of it, or is behind it and the
 * ball comes to it from there.
 */
static bool look_at(pir_contact_job *job, const pir_contact_place *place, pir_near_triangle *s) {
    const double radius = job->input->radius;
    const bool behind = pir_contact_is_behind(job, place, s);
    s->near.meets = false;
    if (behind && (radius == 0 || pir_contact_told_behind(job, place->at, s, 0, radius) == PIR_TOLD_YES))
        return false;
    pir_contact_look_near(job, place, s, &s->near);
    if (behind && !s->near.proven)
        pir_contact_nearest(job, place, s, &s->near);
    return !behind || s->near.meets || s->near.distance < radius;
}

/* Looks at all triangles that may be within `far`; others do not count. */
static bool look_within(pir_contact_job *job, pir_vec3 t, double far) {
    const pir_contact_place place = pir_place_at(t);
    bool meets = false;
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        pir_near_triangle *s = &job->triangle[i];
        const bool is_beyond = far < HUGE_VAL && pir_contact_is_beyond(job, t, s, far);
        s->passed = s->near.meets = false;
        s->near.distance = is_beyond ? HUGE_VAL : 0;
        s->counts = !is_beyond && look_at(job, &place, s);
        meets |= s->counts && s->near.meets;
    }
    return meets || find_passed(job);
}

bool pir_contact_look_from(pir_contact_job *job, pir_vec3 t, double way) {
    const double far = job->input->radius + way;
    return look_within(job, t, far + 4 * LEVEL * (job->size + far));
}

bool pir_contact_look(pir_contact_job *job, pir_vec3 t) {
    return look_within(job, t, HUGE_VAL);
}

bool pir_contact_look_first(pir_contact_job *job) {
    // those of a list are near
    return look_within(job, job->input->pose.translation,
                       job->list ? HUGE_VAL : job->input->margin + job->input->radius);
}

/* All ways from a place that was looked at, and of each triangle's least one the longest. */
static struct exit_way find_ways(pir_contact_job *job, pir_vec3 t, bool loose, struct exit_ways *ways) {
    struct exit_way longest = {{0, 0, 0}, -1};
    ways->loose = loose;
    ways->job = job;
    ways->t = t;
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
            pir_contact_plane_facets(job, t, s, add_way, ways);
        else
            pir_contact_each_facet(job, t, s, add_way, ways);
        if (ways->least.depth < HUGE_VAL && ways->least.depth > longest.depth)
            longest = ways->least;
    }
    return longest;
}

/* Ways shorter than `most` that end at a facet of a D that P's place is not in: P leaves past an edge or a corner of a
 * triangle that it does not meet. */
static void find_ways_past(pir_contact_job *job, pir_vec3 t, double most, struct exit_ways *ways) {
    ways->loose = false;
    ways->count = 0;
    ways->missed = HUGE_VAL;
    ways->most = most - DOUBLE * ways->far;
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        const pir_near_triangle *s = &job->triangle[i];
        if (!s->counts || s->near.meets || s->passed || s->near.distance >= most)
            continue;
        ways->s = s;
        pir_contact_each_facet(job, t, s, add_shorter_way, ways);
    }
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
        most = pir_greater(most, pir_vec_dot(n, pir_vec_sub(s->p[k], t)));
    return least - most > 16 * job->error;
}

static bool is_met_at(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s) {
    return !pir_contact_is_behind(job, place, s) && pir_contact_meets(job, place, s);
}

/* Whether P meets nothing that counts at t. *met: a triangle that was met before, which is looked at first. */
static bool is_clear(pir_contact_job *job, pir_vec3 t, pir_vec3 n, uint32_t *met) {
    const pir_contact_place place = pir_place_at(t);
    double least = HUGE_VAL;
    for (uint32_t v = 0; v < job->p->vertex_count; v++)
        least = pir_lesser(least, pir_vec_dot(n, job->vertex[v]));
    if (*met < job->triangle_count && is_met_at(job, &place, &job->triangle[*met]))
        return false;
    for (uint32_t i = 0; i < job->triangle_count; i++)
        if (!is_clear_along(job, least, &job->triangle[i], n, t) && is_met_at(job, &place, &job->triangle[i])) {
            *met = i;
            return false;
        }
    return true;
}

static bool is_gathered(const pir_contact_job *job, pir_vec3 t) {
    pir_vec3 way = pir_vec_sub(t, job->input->pose.translation);
    double most = pir_greater(fabs(way.x), pir_greater(fabs(way.y), fabs(way.z)));
    return most + job->input->margin + job->input->radius <= job->grown;
}

/* Whether P, which meets nothing at t, has passed nothing either. */
static bool is_in_front(pir_contact_job *job, pir_vec3 t) {
    return job->input->radius == 0 || !pir_contact_look(job, t);
}

/*
 * The first of the ways that ends where P meets nothing: a small part of a step off its triangle, so that the way is no
 * longer than it has to be, and a whole step where that is free too. A loose one need be free at the whole step alone.
 */
static bool try_ways(pir_contact_job *job, pir_vec3 t, struct exit_ways *ways, bool loose, struct exit_way *ret_way,
                     pir_vec3 *ret_to) {
    const double step = pir_contact_step(job), first = loose ? step : PIR_CONTACT_PART_STEP * step;
    uint32_t met = UINT32_MAX;
    for (uint32_t i = 0; i < ways->count; i++) {
        const struct exit_way *way = &ways->way[i];
        const pir_vec3 whole = along(job, t, way, step), to = along(job, t, way, first);
        if (!is_gathered(job, whole)) {
            ways->missed = pir_lesser(ways->missed, way->depth);
            continue;
        }
        if (!is_clear(job, to, way->n, &met)) {
            // what touches, or overlaps by a rounding, does not say that the way is none: with others P may pass by
            if (!pir_contact_overlaps(job, to, &job->triangle[met], false))
                ways->missed = pir_lesser(ways->missed, way->depth);
            continue;
        }
        if (!is_in_front(job, to))
            continue;
        *ret_way = *way;
        *ret_to = is_clear(job, whole, way->n, &met) && is_in_front(job, whole) ? whole : to;
        return true;
    }
    return false;
}

const pir_near_triangle *pir_contact_nearest_of(const pir_contact_job *job) {
    const pir_near_triangle *nearest = NULL;
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        const pir_near_triangle *s = &job->triangle[i];
        if (s->counts && !s->near.meets && (!nearest || s->near.distance < nearest->near.distance))
            nearest = s;
    }
    return nearest;
}

void pir_contact_prove_all(pir_contact_job *job, pir_vec3 t) {
    const pir_contact_place place = pir_place_at(t);
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        pir_near_triangle *s = &job->triangle[i];
        if (s->counts && !s->near.meets && !s->near.proven)
            pir_contact_nearest(job, &place, s, &s->near);
    }
}

void pir_contact_pull_back(pir_contact_job *job, double radius, pir_way_out *out) {
    const double step = pir_contact_step(job);
    const pir_near_triangle *nearest = pir_contact_nearest_of(job);
    if (!nearest || nearest->near.distance - radius <= 2 * step)
        return;
    const double by = (nearest->near.distance - radius - step) / pir_length(nearest->near.n);
    const pir_vec3 t = pir_contact_place_by(job, pir_vec_sub(out->way, pir_vec_scale(nearest->near.n, by)));
    // what P has left may be what it is behind of: then the nearest one is no part of its way
    if (pir_length(pir_vec_sub(t, job->input->pose.translation)) >= pir_length(out->way))
        return;
    const bool meets = pir_contact_look(job, t);
    nearest = pir_contact_nearest_of(job);
    if (meets || !nearest || nearest->near.distance < radius) {
        (void)pir_contact_look(job, out->t);
        return;
    }
    out->t = t;
    out->way = pir_vec_sub(t, job->input->pose.translation);
    out->depth = pir_length(out->way);
}

/* A place, and whether the way there is one that leaves a triangle through a facet. */
struct step_out {
    struct exit_ways ways;
    double far;   /* how deep P is: triangles are needed from about that far */
    bool goes_on; /* out->t is another place than before */
};

/* From one place, which was looked at: out->t is the next one, or the end. */
static void leave_place(pir_contact_job *job, struct step_out *by, pir_way_out *out) {
    const struct exit_way longest = find_ways(job, out->t, false, &by->ways);
    struct exit_way way;
    pir_vec3 to;
    // a thin core that leaves one triangle by its side may still have to come up through its neighbour
    by->far = pir_greater(longest.depth, job->input->radius > 0 ? by->ways.front : 0);
    const bool tight = try_ways(job, out->t, &by->ways, false, &way, &to);
    const double missed = by->ways.missed;
    out->is_out = tight;
    if (tight) {
        struct exit_way shorter;
        pir_vec3 end;
        find_ways_past(job, out->t, way.depth, &by->ways);
        if (try_ways(job, out->t, &by->ways, false, &shorter, &end)) {
            way = shorter;
            to = end;
        }
    }
    if (!tight && longest.depth >= 0) {
        (void)find_ways(job, out->t, true, &by->ways);
        out->is_out = try_ways(job, out->t, &by->ways, true, &way, &to);
    }
    // no way through one facet is shorter than a loose one either, where all of them were tried
    out->is_shortest = out->is_out && way.depth <= missed;
    out->depth = out->is_out ? way.depth : HUGE_VAL;
    by->goes_on = out->is_out || longest.depth >= 0;
    if (out->is_out)
        out->t = to;
    else if (by->goes_on)
        out->t = along(job, out->t, &longest, pir_contact_step(job));
}

/* From the input's place: with what is gathered, then, where that is not enough, with more. */
static pir_status leave_start(pir_contact_job *job, struct step_out *by, pir_way_out *out) {
    const pir_vec3 start = job->input->pose.translation;
    for (int round = 0; round < 2; round++) {
        *out = (pir_way_out){.t = start};
        leave_place(job, by, out);
        const double need = job->input->margin + job->input->radius + 3 * (by->far + pir_contact_step(job));
        if (out->is_shortest || need <= job->grown)
            break;
        pir_status status = pir_contact_job_gather(job, need);
        if (status != PIR_OK)
            return status;
        (void)pir_contact_look(job, start);
    }
    return PIR_OK;
}

pir_status pir_contact_find_way_out(pir_contact_job *job, pir_way_out *ret_out) {
    struct step_out by;
    pir_status status = leave_start(job, &by, ret_out);
    if (status != PIR_OK)
        return status;
    const bool at_once = ret_out->is_out && ret_out->depth < HUGE_VAL, shortest = ret_out->is_shortest;
    for (int place = 1; place < MOST_PLACES && !ret_out->is_out && by.goes_on && is_gathered(job, ret_out->t);
         place++) {
        ret_out->is_out = !pir_contact_look(job, ret_out->t);
        if (!ret_out->is_out)
            leave_place(job, &by, ret_out);
    }
    ret_out->way = pir_vec_sub(ret_out->t, job->input->pose.translation);
    ret_out->is_shortest = shortest;
    ret_out->depth = at_once ? ret_out->depth : pir_length(ret_out->way);
    if (!ret_out->is_out)
        return PIR_OK;
    (void)pir_contact_look(job, ret_out->t);
    pir_contact_pull_back(job, 0, ret_out);
    return PIR_OK;
}
