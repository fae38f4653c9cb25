/* SPDX-License-Identifier: MIT */
/*
 * Contacts with surfaces: see surface_contacts.h. All contacts of one normal stand with the triangle of the deepest
 * one, so that a solver has them in one manifold.
 */
#include "scene/answer/surface_contacts.h"

#include <stdio.h>
#include <string.h>

#include <pirouette/trimesh_contact.h>

#include "mesh/contact/contact_job.h"
#include "scene/answer/events.h"
#include "scene/answer/share.h"
#include "scene/answer/unions.h"
#include "scene/reuse/carried.h"
#include "scene/world/grow.h"
#include "scene/world/piece_facets.h"

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

/* A piece, and the parts of unions that it is in contact with. */
struct touched {
    pir_scene *scene;
    pir_scene_worker *worker;
    pir_scene_item *item;
    uint32_t count;
    uint32_t group;       /* the union at hand */
    double radius;        /* of its bodies */
    uint32_t surfaces;    /* of the question: those of bodies, before the facets of pieces */
    uint32_t first_found; /* of the worker's */
    uint64_t number;      /* of all unions of the piece in this update */
};

static uint32_t body_of(const pir_scene_item *item) {
    return (uint32_t)(item->key.pieces >> 32);
}

static const pir_scene_body *body_at(const struct touched *touched, uint32_t i) {
    return &touched->scene->bodies.body[body_of(&touched->item[i])];
}

static const pir_scene_piece *part_at(const struct touched *touched, uint32_t i) {
    return pir_scene_union_part(touched->scene, &touched->item[i]);
}

static bool is_at_hand(const struct touched *touched, uint32_t i) {
    return touched->item[i].group == touched->group;
}

static bool is_triangle(const struct touched *touched, uint32_t i) {
    return part_at(touched, i)->kind == PIR_PIECE_TRIANGLE;
}

static bool list_surface(const struct touched *touched, uint32_t count, pir_surface_ref surface, pir_pose pose) {
    pir_scene_worker *worker = touched->worker;
    if (!PIR_GROW(&touched->scene->allocator, worker->surface, worker->surface_capacity, count + 1))
        return false;
    worker->surface[count] = (pir_posed_surface){surface, pose};
    return true;
}

/* Lists the surfaces of the union, each once, then the facets of its pieces; their number, 0 when out of memory. */
static uint32_t list_surfaces(struct touched *touched) {
    uint32_t count = 0, last = UINT32_MAX;
    bool good = true;
    for (uint32_t i = 0; i < touched->count && good; i++) {
        if (!is_at_hand(touched, i) || !is_triangle(touched, i) || body_of(&touched->item[i]) == last)
            continue;
        last = body_of(&touched->item[i]);
        good = list_surface(touched, count++, pir_body_surface_of(body_at(touched, i)), body_at(touched, i)->pose);
    }
    touched->surfaces = count;
    for (uint32_t i = 0; i < touched->count && good; i++)
        if (is_at_hand(touched, i) && !is_triangle(touched, i))
            good = list_surface(touched, count++, (pir_surface_ref){part_at(touched, i)->facets, NULL},
                                body_at(touched, i)->pose);
    return good ? count : 0;
}

/* Lists the other pieces of the body whose boxes meet that of the piece; false when out of memory. */
static bool list_beside(const struct touched *touched, const pir_scene_piece *piece, uint32_t *ret_count) {
    const pir_scene *scene = touched->scene;
    pir_scene_worker *worker = touched->worker;
    *ret_count = 0;
    for (uint32_t i = scene->bodies.body[piece->body].first; i != PIR_PIECE_NONE; i = scene->bodies.piece[i].next) {
        const pir_scene_piece *other = &scene->bodies.piece[i];
        if (other == piece || !pir_box_meets(&other->tight, &piece->tight))
            continue;
        if (!PIR_GROW(&scene->allocator, worker->beside, worker->beside_capacity, *ret_count + 1))
            return false;
        worker->beside[(*ret_count)++] = other->extent.polytope;
    }
    return true;
}

/*
 * Lists the triangles of the union, which were all found to be apart: no other is within the margin of the piece. False
 * where it has met one, or asks of other pieces too, or out of memory; then the surfaces are asked for triangles.
 */
static bool list_triangles(const struct touched *touched, pir_contact_list *ret_list) {
    pir_scene_worker *worker = touched->worker;
    uint32_t count = 0, surface = UINT32_MAX, last = UINT32_MAX;
    if (!PIR_GROW(&touched->scene->allocator, worker->near_triangle, worker->near_triangle_capacity, touched->count))
        return false;
    for (uint32_t i = 0; i < touched->count; i++) {
        const pir_scene_item *item = &touched->item[i];
        if (!is_at_hand(touched, i))
            continue;
        if (!is_triangle(touched, i) || item->found->state != PIR_OUTSIDE)
            return false;
        surface += body_of(item) != last;
        last = body_of(item);
        worker->near_triangle[count++] = (uint64_t)surface << 32 | (uint32_t)item->key.pieces;
    }
    *ret_list = (pir_contact_list){worker->near_triangle, count};
    return true;
}

/* The contacts of the piece with the union, in worker->met; *ret_near is whether any, ghosts included, was near. */
static pir_status ask(struct touched *touched, uint32_t *ret_count, bool *ret_near) {
    const pir_scene *scene = touched->scene;
    pir_scene_worker *worker = touched->worker;
    const pir_scene_piece *piece = &scene->bodies.piece[touched->item[0].key.bodies];
    const pir_scene_body *body = &scene->bodies.body[piece->body];
    pir_surface_contact_input input = pir_surface_contact_input_default();
    pir_surface_contact_result result; // set by a call that succeeds
    uint32_t room = 0, beside;
    pir_contact_list list;
    const bool listed = list_triangles(touched, &list);
    input.surface_count = list_surfaces(touched);
    if (input.surface_count == 0 || !list_beside(touched, piece, &beside))
        return PIR_ERR_MEMORY;
    input.pose = body->pose;
    input.radius = body->radius + touched->radius;
    input.margin = scene->margin;
    input.surfaces = worker->surface;
    input.beside = worker->beside;
    input.beside_count = beside;
    pir_status status = PIR_OK;
    // as many as there is room for may not be all
    for (result.contacts = 0; status == PIR_OK && result.contacts == room;) {
        room = room > 0 ? 2 * room : CONTACTS;
        if (!PIR_GROW(&scene->allocator, worker->met, worker->met_capacity, room))
            return PIR_ERR_MEMORY;
        status = pir_surface_contacts_among(piece->extent.polytope, worker->workspace, &input, listed ? &list : NULL,
                                            room, worker->met, &result);
    }
    if (status != PIR_OK)
        return status;
    *ret_count = (uint32_t)result.contacts;
    *ret_near = result.counts.near > 0;
    return PIR_OK;
}

/* Whether two contacts stand in one event: those of one normal, with surfaces or with one and the same piece. */
static bool is_one_event(const struct touched *touched, const pir_surface_contact *a, const pir_surface_contact *b) {
    const bool on_surfaces = a->surface < touched->surfaces && b->surface < touched->surfaces;
    return a->normal.x == b->normal.x && a->normal.y == b->normal.y && a->normal.z == b->normal.z &&
           (on_surfaces || a->surface == b->surface);
}

/* The item of a contact's triangle or piece, or NULL. */
static pir_scene_item *item_of(const struct touched *touched, const pir_surface_contact *contact) {
    const pir_posed_surface *surface = &touched->worker->surface[contact->surface];
    for (uint32_t i = 0; i < touched->count; i++) {
        const pir_scene_body *body = body_at(touched, i);
        if (!is_at_hand(touched, i) || memcmp(&body->pose, &surface->pose, sizeof body->pose) != 0)
            continue;
        const pir_surface_ref of = pir_body_surface_of(body);
        const bool same = contact->surface < touched->surfaces
                              ? (uint32_t)touched->item[i].key.pieces == contact->triangle &&
                                    of.mesh == surface->surface.mesh && of.field == surface->surface.field
                              : part_at(touched, i)->facets == surface->surface.mesh;
        if (same)
            return &touched->item[i];
    }
    return NULL;
}

/* A copy of an item's record in the worker's own list. */
static pir_scene_found *add_found(const struct touched *touched, pir_scene_item *item) {
    pir_scene_worker *worker = touched->worker;
    if (!PIR_GROW(&touched->scene->allocator, worker->on_surface, worker->on_surface_capacity,
                  worker->on_surface_count + 1))
        return NULL;
    pir_scene_found *found = &worker->on_surface[worker->on_surface_count++];
    item->found->in_union = true;
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
        found->error = 0;
        found->distance = from->distance;
        found->normal = piece_is_p ? from->normal : pir_vec_scale(from->normal, -1);
    }
    return true;
}

/* Whether a contact before contact `i` stands in its event. */
static bool comes_again(const struct touched *touched, uint32_t i) {
    const pir_surface_contact *met = touched->worker->met;
    for (uint32_t k = 0; k < i; k++)
        if (is_one_event(touched, &met[k], &met[i]))
            return true;
    return false;
}

/* The first triangle of the union. */
static pir_scene_item *first_triangle(const struct touched *touched) {
    uint32_t i = 0;
    while (!is_at_hand(touched, i) || !is_triangle(touched, i))
        i++;
    return &touched->item[i];
}

/* All contacts of the event of contact `i`, its first, with the first triangle that is in contact, or the piece. */
static pir_status take_event(const struct touched *touched, uint32_t i, uint32_t count) {
    const pir_surface_contact *met = touched->worker->met;
    pir_scene_item *item = NULL;
    for (uint32_t k = i; k < count && !item; k++)
        item = is_one_event(touched, &met[k], &met[i]) ? item_of(touched, &met[k]) : NULL;
    pir_scene_found *found = add_found(touched, item ? item : first_triangle(touched));
    bool good = found;
    for (uint32_t k = i; k < count && good; k++)
        good = !is_one_event(touched, &met[k], &met[i]) || add_contact(touched, found, &met[k]);
    return good ? PIR_OK : PIR_ERR_MEMORY;
}

/*
 * The items that no contact stands with. Where nothing is near, the piece is deep inside of others, away from their
 * facets: the pairs know how deep.
 */
static pir_status take_others(const struct touched *touched, bool near) {
    const pir_scene_worker *worker = touched->worker;
    const uint32_t end = worker->on_surface_count;
    for (uint32_t i = 0; i < touched->count; i++) {
        uint32_t k = touched->first_found;
        if (!is_at_hand(touched, i) || (!near && !is_triangle(touched, i)))
            continue;
        while (k < end && worker->on_surface[k].pair != touched->item[i].pair)
            k++;
        if (k == end && !add_found(touched, &touched->item[i]))
            return PIR_ERR_MEMORY;
    }
    return PIR_OK;
}

/* Whether the group that begins with an item is one piece alone, and the piece that asks is a whole body. */
static bool is_alone(const struct touched *touched) {
    const pir_scene *scene = touched->scene;
    if (scene->bodies.body[scene->bodies.piece[touched->item[0].key.bodies].body].pieces > 1)
        return false;
    for (uint32_t i = touched->group + 1; i < touched->count; i++)
        if (is_at_hand(touched, i))
            return false;
    return !is_triangle(touched, touched->group);
}

static pir_status find_union(struct touched *touched) {
    uint32_t count = 0;
    bool near = false;
    if (is_alone(touched))
        return PIR_OK;
    touched->radius = body_at(touched, touched->group)->radius;
    touched->first_found = touched->worker->on_surface_count;
    pir_status status = ask(touched, &count, &near);
    for (uint32_t i = 0; i < count && status == PIR_OK; i++)
        if (!comes_again(touched, i))
            status = take_event(touched, i, count);
    return status == PIR_OK ? take_others(touched, near) : status;
}

/* Notes what of each pair is to be kept: all of its contacts with unions. */
static void note_items(const struct touched *touched) {
    for (uint32_t i = 0; i < touched->count; i++) {
        pir_scene_news *news = pir_scene_news_of(touched->scene, touched->item[i].found);
        news->union_number = touched->number;
        news->members = touched->count;
    }
}

/* Counts the room that events from number `first` on take in records. */
static void count_room(const struct touched *touched, uint32_t first) {
    const pir_scene_worker *worker = touched->worker;
    for (uint32_t k = first; k < worker->on_surface_count; k++) {
        const pir_scene_found *found = &worker->on_surface[k];
        pir_scene_news_of(touched->scene, found)->union_room += found->count > 0 ? found->count : 1;
    }
}

static pir_status find(struct touched *touched) {
    const uint32_t first = touched->worker->on_surface_count;
    pir_status status = PIR_OK;
    if (touched->scene->reuse > 0) {
        bool carried;
        status = pir_carry_union(touched->scene, touched->worker, touched->item, touched->count, &carried);
        if (carried)
            return status;
        note_items(touched);
    }
    pir_scene_group_items(touched->scene, touched->item, touched->count);
    for (uint32_t i = 0; i < touched->count && status == PIR_OK; i++) {
        touched->group = i;
        if (touched->item[i].group == i)
            status = find_union(touched);
    }
    if (touched->scene->reuse > 0)
        count_room(touched, first);
    return status;
}

static void find_items(pir_scene *scene, uint32_t task, uint32_t begin, uint32_t end) {
    const uint32_t *run = scene->lists.run;
    for (uint32_t i = begin; i < end; i++) {
        struct touched touched = {.scene = scene,
                                  .worker = &scene->worker[task],
                                  .item = &scene->lists.item[run[i]],
                                  .count = run[i + 1] - run[i],
                                  .number = scene->unions_asked + i + 1};
        pir_scene_worker_note(&scene->worker[task], find(&touched), i);
    }
}

/* Makes the facets of all pieces that may be asked about. */
static pir_status make_facets(pir_scene *scene, uint32_t count) {
    pir_status status = PIR_OK;
    for (uint32_t i = 0; i < count && status == PIR_OK; i++) {
        const pir_scene_item *item = &scene->lists.item[i];
        const uint32_t *of = scene->pairs.at[item->pair].piece;
        pir_scene_piece *part = &scene->bodies.piece[of[0] == item->key.bodies ? of[1] : of[0]];
        if (part->kind == PIR_PIECE_CONVEX)
            status = pir_piece_facets(part, &scene->allocator);
    }
    return status;
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
    const uint32_t count = pir_scene_list_union_items(scene);
    if (make_facets(scene, count) != PIR_OK)
        return pir_fail(scene->report, PIR_ERR_MEMORY, "update: its surfaces: %s", pir_status_text(PIR_ERR_MEMORY));
    for (uint32_t i = 0; i < count; i++)
        if (i == 0 || lists->item[i].key.bodies != lists->item[i - 1].key.bodies)
            lists->run[runs++] = i;
    lists->run[runs] = count;
    pir_scene_workers_begin(scene);
    pir_scene_share(scene, runs, WORTH_MORE, find_items);
    scene->unions_asked += runs;
    const pir_status status = pir_scene_workers_status(scene);
    return status == PIR_OK ? PIR_OK : fail(scene, status);
}
