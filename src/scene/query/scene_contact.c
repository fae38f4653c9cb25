/* SPDX-License-Identifier: MIT */
/*
 * The first contact of a body of a scene in a turn about an axis or on a way, exactly: the first of all pairs of its
 * pieces and those that may be in their way.
 *
 * On a way the tree is asked along the box that moves. In a turn it is asked with a box around all of it: a point that
 * turns by θ about an axis, no farther than r from the pivot, stays in the ball about the pivot and goes no farther
 * than min(θ, 2)·r. In a screw that box moves along the way. Pieces farther than the body has gone at the first
 * contact so far are left out.
 */
#include "impact/first_contact.h"
#include "impact/pair_impact.h"
#include "scene/change/changes.h"
#include "scene/query/swept_pieces.h"
#include "scene/world/near_triangles.h"
#include "scene/world/surfaces.h"
#include "scene/world/triangles.h"

#define RADIAN 0.017453292519943295
/* Half an angle of a contact is told within 2^-32, and so is a time of a way. */
#define TOLD 0x1p-20

typedef struct contact_job {
    pir_scene *scene;
    const pir_exact_motion *motion;
    uint32_t body; /* that moves */
    pir_first_contact first;

    /* of the piece at hand */
    pir_probe probe;
    uint32_t own_piece;
    double radius, error; /* of its points about the pivot; of boxes and of `radius` */
    double until;         /* of a way: where it need not be looked at any farther */
    pir_swept_box swept;
} contact_job;

static double size_of(pir_vec3 v) {
    return fabs(v.x) + fabs(v.y) + fabs(v.z);
}

static bool turns(const contact_job *job) {
    return job->motion->degrees != 0;
}

/* --- how far the body goes --- */

/* Whether no later contact counts than the first so far: bodies that recede may meet others. */
static bool is_met(const contact_job *job) {
    return job->first.any && job->first.best.impact.outcome != PIR_CAST_RECEDING;
}

/* No point of the piece goes farther in a turn until the first contact so far, or the end. */
static double gone(const contact_job *job) {
    const double degrees = is_met(job) ? job->first.best.degrees : fabs(job->motion->degrees);
    const double way = pir_vec_length(job->motion->way);
    return fmin(2, degrees * RADIAN + TOLD) * job->radius + way + job->error;
}

static void set_until(contact_job *job) {
    job->until = is_met(job) && !turns(job) ? fmin(1, job->first.best.impact.time + TOLD) : 1;
}

/* A box that the piece is in, at the start of a way or all through a turn. */
static void set_swept(contact_job *job) {
    const pir_exact_motion *motion = job->motion;
    const pir_probe *probe = &job->probe;
    const pir_vec3 t = probe->pose.translation, pivot = turns(job) ? motion->pivot : t;
    const double reach = probe->extent.reach;
    job->radius = reach + size_of(pir_vec_sub(t, pivot));
    job->error = 0x1p-30 * (job->radius + reach + size_of(t) + size_of(pivot) + size_of(motion->way));
    const double by = turns(job) ? gone(job) : job->error, ball = job->radius + job->error;
    const double middle[3] = {pivot.x, pivot.y, pivot.z};
    double low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = probe->box.low[k] - by;
        high[k] = probe->box.high[k] + by;
        if (turns(job)) {
            low[k] = fmax(low[k], middle[k] - ball);
            high[k] = fmin(high[k], middle[k] + ball);
        }
    }
    pir_swept_box_set(&job->swept, low, high, motion->way);
}

/* Whether a box is nearer to where the piece starts than it goes until the first contact so far. */
static bool is_near(const contact_job *job, const pir_box *box) {
    double square = 0;
    for (int k = 0; k < 3; k++) {
        const double apart =
            fmax((double)job->probe.box.low[k] - box->high[k], (double)box->low[k] - job->probe.box.high[k]);
        square += apart > 0 ? apart * apart : 0;
    }
    return sqrt(square) * (1 - 0x1p-40) <= gone(job);
}

/* --- pairs --- */

static pir_status fail(const contact_job *job, pir_status status, const pir_scene_piece *piece) {
    return pir_fail(job->scene->report, status, "first contact: body %u, piece %u: %s", (unsigned)piece->body,
                    (unsigned)piece->number, pir_status_text(status));
}

static pir_status ask_pair(const contact_job *job, const pir_probe *probe, pir_scene_piece *piece,
                           pir_exact_impact *ret_impact, mpz_t *root) {
    pir_scene *scene = job->scene;
    pir_pair *pair;
    pir_pair_input input;
    if (scene->bodies.body[piece->body].radius > 0)
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "first contact: body %u in the way has a radius",
                        (unsigned)piece->body);
    pir_status status = pir_probe_pair(probe, piece, &pair, &input);
    if (status == PIR_OK)
        status = pir_pair_impact_run(pair, scene->worker[0].workspace, &input, job->motion, ret_impact, root);
    return status == PIR_OK ? PIR_OK : fail(job, status, piece);
}

/* As ask_pair, of a triangle by its number. */
static pir_status ask_triangle(const contact_job *job, const pir_probe *probe, uint32_t body, uint32_t triangle,
                               pir_exact_impact *ret_impact, mpz_t *root) {
    pir_bodies *bodies = &job->scene->bodies;
    pir_scene_piece piece = pir_triangle_piece(bodies, body, triangle);
    piece.extent.polytope = pir_triangles_recall(bodies, body, triangle);
    const pir_status status = ask_pair(job, probe, &piece, ret_impact, root);
    pir_triangles_keep(bodies, &job->scene->allocator, &piece);
    return status;
}

static pir_status ask_again(void *context, const pir_impact *of, mpz_t *root) {
    const contact_job *job = context;
    pir_bodies *bodies = &job->scene->bodies;
    pir_exact_impact again;
    const uint32_t own = pir_bodies_piece(bodies, job->body, of->piece_p);
    const pir_probe probe = pir_probe_of_piece(job->scene, &bodies->piece[own]);
    if (pir_body_has_surface(&bodies->body[of->body]))
        return ask_triangle(job, &probe, of->body, of->piece_q, &again, root);
    return ask_pair(job, &probe, &bodies->piece[pir_bodies_piece(bodies, of->body, of->piece_q)], &again, root);
}

/* Offers the answer of the piece at hand and another. */
static pir_status offer(contact_job *job, pir_exact_impact *impact, uint32_t body, uint32_t piece, uint64_t user) {
    impact->impact.body = body;
    impact->impact.piece_p = job->own_piece;
    impact->impact.piece_q = piece;
    impact->impact.piece_user = user;
    const pir_status status = pir_first_contact_offer(&job->first, impact);
    set_until(job);
    return status;
}

static pir_status look_at_piece(contact_job *job, pir_scene_piece *piece) {
    pir_exact_impact impact;
    if (turns(job) && !is_near(job, &piece->tight))
        return PIR_OK;
    const pir_status status = ask_pair(job, &job->probe, piece, &impact, NULL);
    return status != PIR_OK
               ? status
               : offer(job, &impact, piece->body, piece->number, pir_piece_user(&job->scene->bodies, piece));
}

/* The triangles of a surface that are looked at. */
struct surface_look {
    contact_job *job;
    const pir_scene_body *body;
    pir_status status;
};

static bool look_at_triangle(void *context, const pir_met_triangle *met) {
    struct surface_look *look = context;
    contact_job *job = look->job;
    const uint32_t body = (uint32_t)(look->body - job->scene->bodies.body);
    pir_exact_impact impact;
    look->status = ask_triangle(job, &job->probe, body, met->number, &impact, NULL);
    if (look->status == PIR_OK)
        look->status =
            offer(job, &impact, body, met->number, pir_surface_material(pir_body_surface_of(look->body), met->number));
    return look->status == PIR_OK;
}

static pir_status look_at_surface(contact_job *job, const pir_scene_body *body) {
    struct surface_look look = {job, body, PIR_OK};
    const pir_vec3 t = body->pose.translation;
    const double room = 0x1p-30 * (body->reach + size_of(t));
    pir_place place;
    const pir_status status = pir_place_make(body->pose, &place);
    if (status != PIR_OK)
        return status;
    pir_box box;
    for (int k = 0; k < 3; k++) {
        box.low[k] = pir_float_below(job->swept.low[k]);
        box.high[k] = pir_float_above(job->swept.high[k]);
    }
    box = pir_box_wider(&box, room);
    const pir_walk_box from = pir_place_sees(&place, &box);
    const pir_vec3 way = pir_mat_apply_transposed(&place.r, job->motion->way);
    pir_swept_walk walk = {.until = &job->until, .look = look_at_triangle, .context = &look};
    pir_swept_box_set(&walk.swept, from.low, from.high, way);
    pir_swept_triangles(body, &walk);
    return look.status;
}

static pir_status look_at_leaf(void *context, pir_scene_piece *piece) {
    contact_job *job = context;
    return piece->kind == PIR_PIECE_SURFACE ? look_at_surface(job, &job->scene->bodies.body[piece->body])
                                            : look_at_piece(job, piece);
}

/* --- the call --- */

static pir_status look_from_pieces(contact_job *job) {
    pir_scene *scene = job->scene;
    pir_status status = PIR_OK;
    for (uint32_t p = scene->bodies.body[job->body].first; status == PIR_OK && p != PIR_PIECE_NONE;
         p = scene->bodies.piece[p].next) {
        job->probe = pir_probe_of_piece(scene, &scene->bodies.piece[p]);
        job->own_piece = scene->bodies.piece[p].number;
        set_until(job);
        set_swept(job);
        status = pir_swept_pieces(&(pir_swept_search){&job->probe, &job->swept, &job->until, look_at_leaf, job});
    }
    return status;
}

static pir_status check(pir_scene *scene, uint32_t id, const pir_exact_motion *motion, uint32_t *ret_body) {
    pir_status status = pir_scene_find_body(scene, "first contact", id, ret_body);
    if (status != PIR_OK)
        return status;
    const pir_scene_body *body = &scene->bodies.body[*ret_body];
    const char *fault = body->sensor                 ? "is a sensor"
                        : pir_body_has_surface(body) ? "has a surface"
                        : body->radius > 0           ? "has a radius"
                                                     : NULL;
    if (fault)
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "first contact: body %u %s", (unsigned)id, fault);
    status = pir_exact_motion_check(motion);
    const pir_vec3 pivot = motion->degrees != 0 ? motion->pivot : (pir_vec3){0, 0, 0};
    if (status == PIR_OK && !(size_of(motion->way) <= PIR_BOX_FARTHEST && size_of(pivot) <= PIR_BOX_FARTHEST))
        status = PIR_ERR_LIMIT;
    return status == PIR_OK ? PIR_OK
                            : pir_fail(scene->report, status, "first contact: its motion: %s", pir_status_text(status));
}

pir_status pir_scene_first_contact(pir_scene *scene, uint32_t id, const pir_exact_motion *motion,
                                   pir_exact_impact *ret_impact) {
    contact_job job = {.scene = scene, .motion = motion};
    const char *missing = !motion ? "motion" : !ret_impact ? "ret_impact" : NULL;
    pir_status status = pir_scene_given(scene, "first contact", missing);
    if (status == PIR_OK)
        status = check(scene, id, motion, &job.body);
    if (status != PIR_OK)
        return status;
    const bool rests = motion->degrees == 0 && size_of(motion->way) == 0;
    pir_exact_impact impact = {.impact = {.outcome = rests ? PIR_CAST_AT_REST : PIR_CAST_MISS,
                                          .time = rests ? 0 : 1,
                                          .body = PIR_SCENE_NONE,
                                          .piece_q = PIR_SCENE_NONE},
                               .kappa = {HUGE_VAL, HUGE_VAL},
                               .degrees = fabs(motion->degrees)};
    pir_first_contact_init(&job.first, &scene->allocator, motion, ask_again, &job);
    status = look_from_pieces(&job);
    if (status == PIR_OK) {
        impact = job.first.any ? job.first.best : impact;
        pir_name_impact(scene, &impact.impact);
        *ret_impact = impact;
    }
    pir_first_contact_finish(&job.first);
    return status;
}
