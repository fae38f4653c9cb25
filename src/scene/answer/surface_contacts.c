/* SPDX-License-Identifier: MIT */
/*
 * Contacts with surfaces: see surface_contacts.h. All contacts of one normal stand with the triangle of the deepest
 * one, so that a solver has them in one manifold.
 */
#include "scene/answer/surface_contacts.h"

#include <stdio.h>

#include <pirouette/trimesh_contact.h>

#include "mesh/contact/contact_job.h"
#include "scene/answer/events.h"
#include "scene/answer/share.h"
#include "scene/world/grow.h"

/* How many pieces are worth another thread. */
#define WORTH_MORE 16

/* Room for contacts at first. */
#define CONTACTS 32

bool pir_scene_is_with_surface(const pir_scene *scene, uint32_t pair) {
    const pir_scene_piece *pieces = scene->bodies.piece;
    const uint32_t *of = scene->pairs.at[pair].piece;
    const pir_scene_body *p = &scene->bodies.body[pieces[of[0]].body], *q = &scene->bodies.body[pieces[of[1]].body];
    const bool with = pieces[of[0]].kind == PIR_PIECE_TRIANGLE || pieces[of[1]].kind == PIR_PIECE_TRIANGLE;
    return with && scene->detail == PIR_SCENE_MANIFOLDS && !p->sensor && !q->sensor;
}

/* A piece, and what it is in contact with: items whose keys hold its number, the body's of a surface and a triangle. */
struct touched {
    pir_scene *scene;
    pir_scene_worker *worker;
    const pir_scene_item *item;
    uint32_t count;
    double radius;        /* of the surfaces at hand: each radius is a union of its own */
    uint32_t first_found; /* of the worker's */
};

static uint32_t body_of(const pir_scene_item *item) {
    return (uint32_t)(item->key.pieces >> 32);
}

static double radius_of(const struct touched *touched, uint32_t i) {
    return touched->scene->bodies.body[body_of(&touched->item[i])].radius;
}

/* Lists the surfaces of the radius at hand, each once. */
static pir_status list_surfaces(const struct touched *touched, uint32_t *ret_count) {
    pir_scene_worker *worker = touched->worker;
    *ret_count = 0;
    for (uint32_t i = 0; i < touched->count; i++) {
        const pir_scene_body *body = &touched->scene->bodies.body[body_of(&touched->item[i])];
        if ((i > 0 && body_of(&touched->item[i]) == body_of(&touched->item[i - 1])) || body->radius != touched->radius)
            continue;
        if (!PIR_GROW(&touched->scene->allocator, worker->surface, worker->surface_capacity, *ret_count + 1))
            return PIR_ERR_MEMORY;
        worker->surface[(*ret_count)++] = (pir_posed_surface){pir_body_surface_of(body), body->pose};
    }
    return PIR_OK;
}

/* The contacts of the piece with these, in worker->met. */
static pir_status ask(const struct touched *touched, uint32_t *ret_count) {
    const pir_scene *scene = touched->scene;
    pir_scene_worker *worker = touched->worker;
    const pir_scene_piece *piece = &scene->bodies.piece[touched->item[0].key.bodies];
    const pir_scene_body *body = &scene->bodies.body[piece->body];
    pir_surface_contact_input input = pir_surface_contact_input_default();
    pir_surface_contact_result result = {.contacts = 0};
    uint32_t surfaces, room = 0;
    pir_status status = list_surfaces(touched, &surfaces);
    input.pose = body->pose;
    input.radius = body->radius + touched->radius;
    input.margin = scene->margin;
    input.surfaces = worker->surface;
    input.surface_count = surfaces;
    // as many as there is room for may not be all
    while (status == PIR_OK && result.contacts == room) {
        room = room > 0 ? 2 * room : CONTACTS;
        if (!PIR_GROW(&scene->allocator, worker->met, worker->met_capacity, room))
            return PIR_ERR_MEMORY;
        status = pir_surface_contacts(piece->extent.polytope, worker->workspace, &input, room, worker->met, &result);
    }
    *ret_count = (uint32_t)result.contacts;
    return status;
}

static bool is_same_normal(const pir_surface_contact *a, const pir_surface_contact *b) {
    return a->normal.x == b->normal.x && a->normal.y == b->normal.y && a->normal.z == b->normal.z;
}

/* The item of a contact's triangle, or NULL. */
static const pir_scene_item *item_of(const struct touched *touched, const pir_surface_contact *contact) {
    const pir_posed_surface *surface = &touched->worker->surface[contact->surface];
    for (uint32_t i = 0; i < touched->count; i++) {
        const pir_surface_ref of = pir_body_surface_of(&touched->scene->bodies.body[body_of(&touched->item[i])]);
        const pir_pose *pose = &touched->scene->bodies.body[body_of(&touched->item[i])].pose;
        if ((uint32_t)touched->item[i].key.pieces == contact->triangle && of.mesh == surface->surface.mesh &&
            of.field == surface->surface.field && memcmp(pose, &surface->pose, sizeof *pose) == 0)
            return &touched->item[i];
    }
    return NULL;
}

/* A copy of an item's record in the worker's own list. */
static pir_scene_found *add_found(const struct touched *touched, const pir_scene_item *item) {
    pir_scene_worker *worker = touched->worker;
    if (!PIR_GROW(&touched->scene->allocator, worker->on_surface, worker->on_surface_capacity,
                  worker->on_surface_count + 1))
        return NULL;
    pir_scene_found *found = &worker->on_surface[worker->on_surface_count++];
    *found = *item->found;
    found->first = worker->contact_count;
    found->count = 0;
    return found;
}

/* Adds a contact to the one that was found last. */
static bool add_contact(const struct touched *touched, pir_scene_found *found, const pir_surface_contact *from) {
    pir_scene_worker *worker = touched->worker;
    const bool piece_is_p = touched->scene->pairs.at[found->pair].piece[0] == touched->item[0].key.bodies;
    // what the surface is rounded by was the piece's
    const pir_vec3 by = pir_vec_scale(from->normal, touched->radius);
    const pir_vec3 own = pir_vec_add(from->point_p, by), other = pir_vec_add(from->point_q, by);
    if (!PIR_GROW(&touched->scene->allocator, worker->contact, worker->contact_capacity, worker->contact_count + 1))
        return false;
    worker->contact[worker->contact_count++] =
        (pir_contact){piece_is_p ? own : other, piece_is_p ? other : own, from->distance, from->id};
    if (found->count++ == 0) {
        found->distance = from->distance;
        found->normal = piece_is_p ? from->normal : pir_vec_scale(from->normal, -1);
    }
    return true;
}

/* Whether a contact of this normal comes before contact `i`. */
static bool comes_again(const pir_surface_contact *met, uint32_t i) {
    for (uint32_t k = 0; k < i; k++)
        if (is_same_normal(&met[k], &met[i]))
            return true;
    return false;
}

/* All contacts of the normal of contact `i`, the first of its normal, with the first triangle that is in contact. */
static pir_status take_normal(const struct touched *touched, uint32_t i, uint32_t count) {
    const pir_surface_contact *met = touched->worker->met;
    const pir_scene_item *item = NULL;
    for (uint32_t k = i; k < count && !item; k++)
        item = is_same_normal(&met[k], &met[i]) ? item_of(touched, &met[k]) : NULL;
    pir_scene_found *found = add_found(touched, item ? item : &touched->item[0]);
    bool good = found;
    for (uint32_t k = i; k < count && good; k++)
        good = !is_same_normal(&met[k], &met[i]) || add_contact(touched, found, &met[k]);
    return good ? PIR_OK : PIR_ERR_MEMORY;
}

/* The items that no contact stands with. */
static pir_status take_others(const struct touched *touched) {
    const pir_scene_worker *worker = touched->worker;
    const uint32_t end = worker->on_surface_count;
    for (uint32_t i = 0; i < touched->count; i++) {
        uint32_t k = touched->first_found;
        while (k < end && worker->on_surface[k].pair != touched->item[i].pair)
            k++;
        if (k == end && !add_found(touched, &touched->item[i]))
            return PIR_ERR_MEMORY;
    }
    return PIR_OK;
}

/* The least radius of a surface above `last`; HUGE_VAL for none. */
static double next_radius(const struct touched *touched, double last) {
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < touched->count; i++)
        if (radius_of(touched, i) > last)
            least = fmin(least, radius_of(touched, i));
    return least;
}

static pir_status find(struct touched *touched) {
    pir_status status = PIR_OK;
    touched->first_found = touched->worker->on_surface_count;
    for (touched->radius = next_radius(touched, -1); status == PIR_OK && touched->radius < HUGE_VAL;
         touched->radius = next_radius(touched, touched->radius)) {
        uint32_t count = 0;
        status = ask(touched, &count);
        for (uint32_t i = 0; i < count && status == PIR_OK; i++)
            if (!comes_again(touched->worker->met, i))
                status = take_normal(touched, i, count);
    }
    return status == PIR_OK ? take_others(touched) : status;
}

static void find_items(pir_scene *scene, uint32_t task, uint32_t begin, uint32_t end) {
    const uint32_t *run = scene->lists.run;
    for (uint32_t i = begin; i < end; i++) {
        struct touched touched = {.scene = scene,
                                  .worker = &scene->worker[task],
                                  .item = &scene->lists.item[run[i]],
                                  .count = run[i + 1] - run[i]};
        pir_scene_worker_note(&scene->worker[task], find(&touched), i);
    }
}

/* Lists what was found with surfaces, piece by piece; the number. */
static uint32_t list_items(pir_scene *scene) {
    uint32_t count = 0;
    for (uint32_t w = 0; w < scene->threads; w++)
        for (uint32_t i = 0; i < scene->worker[w].found_count; i++) {
            const pir_scene_found *found = &scene->worker[w].found[i];
            if (!pir_scene_is_with_surface(scene, found->pair))
                continue;
            const uint32_t *of = scene->pairs.at[found->pair].piece;
            const int side = scene->bodies.piece[of[0]].kind == PIR_PIECE_TRIANGLE ? 0 : 1;
            const pir_scene_piece *triangle = &scene->bodies.piece[of[side]];
            scene->lists.item[count++] = (pir_scene_item){
                {of[1 - side], (uint64_t)triangle->body << 32 | triangle->number}, NULL, found, found->pair};
        }
    if (count > 1)
        pir_scene_sort_items(scene->lists.item, scene->lists.work, count);
    return count;
}

/* Reports the first question that failed: of a piece with one surface or more. */
static pir_status fail(const pir_scene *scene, pir_status status) {
    const uint32_t *run = &scene->lists.run[pir_scene_workers_failed(scene)];
    const pir_scene_item *first = &scene->lists.item[run[0]], *last = &scene->lists.item[run[1] - 1];
    const pir_scene_piece *piece = &scene->bodies.piece[first->key.bodies];
    const unsigned body = piece->body, number = piece->number;
    char of[64];
    if (body_of(first) == body_of(last))
        snprintf(of, sizeof of, "the surface of body %u", (unsigned)body_of(first));
    else
        snprintf(of, sizeof of, "the surfaces of bodies %u to %u", (unsigned)body_of(first), (unsigned)body_of(last));
    // coordinates are within their limit, as in boxes; the sum of two radii may not be
    const double radius = scene->bodies.body[body].radius + scene->bodies.body[body_of(last)].radius;
    if (status == PIR_ERR_LIMIT && radius + scene->margin <= PIR_BOX_FARTHEST)
        return pir_fail(scene->report, status, "update: body %u, piece %u: more than %u triangles near it, of %s", body,
                        number, PIR_CONTACT_TRIANGLES_MOST, of);
    return pir_fail(scene->report, status, "update: body %u, piece %u, with %s: %s", body, number, of,
                    pir_status_text(status));
}

pir_status pir_scene_find_surface_contacts(pir_scene *scene) {
    pir_scene_lists *lists = &scene->lists;
    uint32_t most = 0, runs = 0;
    for (uint32_t w = 0; w < scene->threads; w++)
        most += scene->worker[w].found_count;
    if (!PIR_GROW(&scene->allocator, lists->item, lists->item_capacity, most) ||
        !PIR_GROW(&scene->allocator, lists->work, lists->work_capacity, most) ||
        !PIR_GROW(&scene->allocator, lists->run, lists->run_capacity, most + 1))
        return pir_fail(scene->report, PIR_ERR_MEMORY, "update: its surfaces: %s", pir_status_text(PIR_ERR_MEMORY));
    const uint32_t count = list_items(scene);
    for (uint32_t i = 0; i < count; i++)
        if (i == 0 || lists->item[i].key.bodies != lists->item[i - 1].key.bodies)
            lists->run[runs++] = i;
    lists->run[runs] = count;
    pir_scene_workers_begin(scene);
    pir_scene_share(scene, runs, WORTH_MORE, find_items);
    const pir_status status = pir_scene_workers_status(scene);
    return status == PIR_OK ? PIR_OK : fail(scene, status);
}
