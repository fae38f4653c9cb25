/* SPDX-License-Identifier: MIT */
/* Answers and contacts used again: see carried.h. */
#include "scene/reuse/carried.h"

#include "polytope/polytope.h"
#include "scene/reuse/motion_since.h"
#include "scene/world/grow.h"

/* --- answers --- */

static const pir_scene_body *body_of(const pir_scene *scene, uint32_t pair, int side) {
    return &scene->bodies.body[scene->bodies.piece[scene->pairs.at[pair].piece[side]].body];
}

bool pir_is_near_kept(const pir_scene *scene, uint32_t pair, const pir_seen *seen, const pir_seen *kept,
                      double *ret_moved) {
    *ret_moved = pir_motion_between(seen, kept, pir_seen_side_of(scene, pair).reach);
    return *ret_moved <= scene->reuse;
}

/* Whether all distances from `low` to `high` have one state, and are within the margin. */
static bool is_of_state(const pir_scene *scene, pir_state state, double low, double high) {
    return (state == PIR_INSIDE && high < 0) || (state == PIR_OUTSIDE && low > 0 && high <= scene->margin);
}

/* The least of n · v over the vertices of a piece of the body at `pose`, and the greatest for −n. */
static double lowest(const pir_scene_piece *piece, const pir_scene_body *body, pir_vec3 n) {
    const pir_polytope *p = piece->extent.polytope;
    const pir_rotation_doubles turned = pir_doubles_as_given(body->unit);
    const pir_vec3 own = pir_mat_apply_transposed(&turned.r, n);
    double least = HUGE_VAL;
    for (uint32_t v = 0; v < p->vertex_count; v++)
        least = pir_lesser(least, pir_vec_dot(own, p->vertex[v]));
    return least + pir_vec_dot(n, body->pose.translation);
}

/* Pieces with more vertices are asked. */
#define LOOKED_THROUGH 64

/*
 * Whether pieces that were apart are so still, along the normal of then, and within the margin, by the points of then:
 * bounds from both sides that hold farther than how much the bodies have moved. `off` is above their rounding.
 */
static bool is_still_apart(const pir_scene *scene, const pir_scene_found *found, pir_vec3 normal, double off) {
    const pir_scene_pair *pair = &scene->pairs.at[found->pair];
    const pir_scene_piece *p = &scene->bodies.piece[pair->piece[0]], *q = &scene->bodies.piece[pair->piece[1]];
    const pir_scene_body *a = &scene->bodies.body[p->body], *b = &scene->bodies.body[q->body];
    const pir_kept_answer *kept = &pair->kept->answer;
    if (kept->state != PIR_OUTSIDE || !(p->extent.polytope && q->extent.polytope) ||
        p->extent.polytope->vertex_count > LOOKED_THROUGH || q->extent.polytope->vertex_count > LOOKED_THROUGH)
        return false;
    const pir_vec3 between =
        pir_vec_sub(pir_pose_apply(a->pose, kept->point[0]), pir_pose_apply(b->pose, kept->point[1]));
    if (!(pir_vec_length(between) + off <= scene->margin))
        return false;
    return lowest(p, a, normal) + lowest(q, b, pir_vec_scale(normal, -1)) - a->radius - b->radius > off;
}

bool pir_carry_answer(const pir_scene *scene, const pir_seen *seen, pir_scene_found *found) {
    const pir_kept_answer *kept = &scene->pairs.at[found->pair].kept->answer;
    const pir_scene_body *p = body_of(scene, found->pair, 0), *q = body_of(scene, found->pair, 1);
    double moved;
    if (!pir_is_near_kept(scene, found->pair, seen, &kept->seen, &moved))
        return false;
    const pir_pose by = pir_seen_side_of(scene, found->pair).side == 0 ? q->pose : p->pose;
    const pir_vec3 normal = pir_pose_rotate(by, kept->normal);
    const double rounded = 2 * pir_scene_distance_error(p, q), off = moved + rounded;
    if (!is_of_state(scene, kept->state, kept->distance - off, kept->distance + off) &&
        !is_still_apart(scene, found, normal, rounded))
        return false;
    found->state = kept->state;
    found->distance = kept->distance;
    found->normal = normal;
    found->witness = kept->witness;
    found->error = moved;
    return true;
}

/* --- contacts --- */

pir_status pir_carry_event(pir_scene *scene, pir_scene_worker *worker, const pir_kept_record *record, uint32_t *at,
                           pir_scene_found *found) {
    uint32_t count = 1;
    while (*at + count < record->count && record->contact[*at + count].place == PIR_KEPT_ON)
        count++;
    if (!PIR_GROW(&scene->allocator, worker->contact, worker->contact_capacity, worker->contact_count + count))
        return PIR_ERR_MEMORY;
    const pir_scene_body *body[2] = {body_of(scene, found->pair, 0), body_of(scene, found->pair, 1)};
    const pir_mat3 r[2] = {pir_doubles_as_given(body[0]->unit).r, pir_doubles_as_given(body[1]->unit).r};
    const pir_kept_contact *first = &record->contact[*at];
    found->first = worker->contact_count;
    found->count = count;
    found->normal = pir_mat_apply(&r[1 - pir_seen_side_of(scene, found->pair).side], first->normal);
    for (uint32_t i = 0; i < count; i++) {
        pir_vec3 point[2];
        for (int side = 0; side < 2; side++)
            point[side] = pir_vec_add(pir_mat_apply(&r[side], first[i].point[side]), body[side]->pose.translation);
        worker->contact[worker->contact_count++] =
            (pir_contact){point[0], point[1], pir_vec_dot(found->normal, pir_vec_sub(point[0], point[1])), first[i].id};
    }
    *at += count;
    return PIR_OK;
}

/* --- unions --- */

/* Whether all items were in contact with the piece when the contacts of the first were found, and no others, and have
   moved little since; *ret_moved is the most. */
static bool is_same_union(const pir_scene *scene, const pir_scene_item *item, uint32_t count, double *ret_moved) {
    const pir_kept_record *first = scene->pairs.at[item[0].pair].united;
    bool same = first && first->members == count;
    *ret_moved = 0;
    for (uint32_t i = 0; i < count && same; i++) {
        const pir_kept_record *record = scene->pairs.at[item[i].pair].united;
        double moved;
        same = record && record->union_number == first->union_number &&
               pir_is_near_kept(scene, item[i].pair, &pir_scene_news_of(scene, item[i].found)->seen, &record->made,
                                &moved);
        if (same)
            *ret_moved = pir_greater(*ret_moved, moved);
    }
    return same;
}

/* Adds all events of an item to those of unions. */
static pir_status carry_item(pir_scene *scene, pir_scene_worker *worker, pir_scene_item *item, double moved) {
    const pir_kept_record *record = scene->pairs.at[item->pair].united;
    pir_status status = PIR_OK;
    for (uint32_t at = 0; at < record->count && status == PIR_OK;) {
        if (!PIR_GROW(&scene->allocator, worker->on_surface, worker->on_surface_capacity, worker->on_surface_count + 1))
            return PIR_ERR_MEMORY;
        pir_scene_found *found = &worker->on_surface[worker->on_surface_count++];
        item->found->in_union = true;
        *found = *item->found;
        found->first = worker->contact_count;
        found->count = 0;
        if (record->contact[at].place == PIR_KEPT_NONE) {
            at++;
            continue;
        }
        status = pir_carry_event(scene, worker, record, &at, found);
        if (status == PIR_OK)
            found->distance = worker->contact[found->first].distance;
        found->error = moved;
    }
    return status;
}

pir_status pir_carry_union(pir_scene *scene, pir_scene_worker *worker, pir_scene_item *item, uint32_t count,
                           bool *ret_carried) {
    double moved;
    pir_status status = PIR_OK;
    *ret_carried = is_same_union(scene, item, count, &moved);
    for (uint32_t i = 0; i < count && *ret_carried && status == PIR_OK; i++)
        status = carry_item(scene, worker, &item[i], moved);
    return status;
}
