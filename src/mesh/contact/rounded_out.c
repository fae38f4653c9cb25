/* SPDX-License-Identifier: MIT */
/*
 * The way out of a rounded body. The distance from a triangle is a convex function of P's place. So where n is the
 * unit way from its nearest point, at a place with the distance d, each move x from there with n · x ≥ r − d takes
 * P to the distance r. P takes the least move that the nearest triangle asks for. The one that is nearest there asks in
 * its turn. Each demand holds at any place, so they are kept, and the move is the least that meets all.
 */
#include "mesh/contact/rounded_out.h"

#define MOST_PLACES 16
#define MOST_SWEEPS 256
/* Squares of how near two directions are that are one: this chooses demands only. */
#define SAME_SQUARE 0x1p-60

/* n · x ≥ need, for the move x from the input's translation; the push along n that x has of it. */
struct demand {
    pir_vec3 n;
    double need, push;
};

struct demands {
    struct demand demand[MOST_PLACES];
    uint32_t count;
};

static void add_demand(struct demands *demands, pir_vec3 n, double need) {
    for (uint32_t i = 0; i < demands->count; i++) {
        pir_vec3 way = pir_vec_sub(demands->demand[i].n, n);
        if (pir_vec_dot(way, way) < SAME_SQUARE) {
            demands->demand[i].need = pir_greater(demands->demand[i].need, need);
            return;
        }
    }
    if (demands->count < MOST_PLACES)
        demands->demand[demands->count++] = (struct demand){n, need, 0};
}

/*
 * Adds what the nearest triangle asks for at a place that was looked at; by how much it is within the radius, at least
 * 0. Its neighbours mostly are left when it is left, and their demands from below would be more than they need.
 */
static double add_deepest(const pir_contact_job *job, pir_vec3 moved, double step, struct demands *demands) {
    const pir_near_triangle *nearest = NULL;
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        const pir_near_triangle *s = &job->triangle[i];
        if (s->counts && (!nearest || s->near.distance < nearest->near.distance))
            nearest = s;
    }
    double depth = nearest ? job->input->radius - nearest->near.distance : 0;
    if (depth <= 0)
        return 0;
    pir_vec3 n = pir_vec_scale(nearest->near.n, 1 / pir_length(nearest->near.n));
    add_demand(demands, n, pir_vec_dot(n, moved) + depth + step);
    return depth;
}

/* The least move that meets all demands: each in turn pushes by what is missing, and takes back what is too much. */
static pir_vec3 least_move(struct demands *demands) {
    pir_vec3 x = {0, 0, 0};
    for (uint32_t i = 0; i < demands->count; i++)
        demands->demand[i].push = 0;
    for (int sweep = 0; sweep < MOST_SWEEPS; sweep++) {
        double most = 0;
        for (uint32_t i = 0; i < demands->count; i++) {
            struct demand *d = &demands->demand[i];
            double push = pir_greater(d->push + d->need - pir_vec_dot(d->n, x), 0), by = push - d->push;
            x = pir_vec_add(x, pir_vec_scale(d->n, by));
            d->push = push;
            most = pir_greater(most, fabs(by));
        }
        if (most <= 0x1p-40 * pir_length(x))
            break;
    }
    return x;
}

static pir_status gather_about(pir_contact_job *job, pir_vec3 moved) {
    double need = pir_greater(fabs(moved.x), pir_greater(fabs(moved.y), fabs(moved.z))) + job->input->radius;
    if (need <= job->grown)
        return PIR_OK;
    return pir_contact_job_gather(job, 1.25 * need);
}

/* From where *out leads, by a step; *ret_deepest is how deep P was there. */
static pir_status leave(pir_contact_job *job, const pir_way_out *out, double step, double *ret_deepest,
                        pir_way_out *ret_out) {
    pir_vec3 start = job->input->pose.translation;
    struct demands demands = {.count = 0};
    *ret_out = (pir_way_out){.t = out->t, .way = out->way};
    for (int place = 0; place < MOST_PLACES; place++) {
        pir_status status = gather_about(job, ret_out->way);
        if (status != PIR_OK)
            return status;
        if (pir_contact_look_from(job, ret_out->t, pir_length(ret_out->way)))
            return PIR_OK;
        double deepest = add_deepest(job, ret_out->way, step, &demands);
        *ret_deepest = place == 0 ? deepest : *ret_deepest;
        ret_out->is_out = deepest == 0;
        if (ret_out->is_out)
            return PIR_OK;
        ret_out->t = pir_contact_place_by(job, least_move(&demands));
        ret_out->way = pir_vec_sub(ret_out->t, start);
    }
    return PIR_OK;
}

pir_status pir_contact_find_rounded_way_out(pir_contact_job *job, pir_way_out *out) {
    const double step = pir_contact_step(job), radius = job->input->radius;
    const bool moved = out->way.x != 0 || out->way.y != 0 || out->way.z != 0;
    double deepest = 0, slack = 4 * step;
    pir_way_out found = {.is_out = false};
    for (int part = 0; part < 2 && out->is_out && !found.is_out; part++) {
        pir_status status = leave(job, out, part ? PIR_CONTACT_PART_STEP * step : step, &deepest, &found);
        if (status != PIR_OK)
            return status;
    }
    if (found.is_out)
        pir_contact_pull_back(job, radius, &found);
    double bound = moved ? out->depth + radius : deepest, length = pir_length(found.way);
    if (!found.is_out) {
        out->is_out = out->is_shortest = false;
        out->depth = moved ? out->depth + radius : pir_greater(deepest, 0);
        return PIR_OK;
    }
    found.is_shortest = out->is_shortest && length <= bound + slack;
    found.depth = found.is_shortest ? pir_lesser(bound, length) : length;
    *out = found;
    return PIR_OK;
}
