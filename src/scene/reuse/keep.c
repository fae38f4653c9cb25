/* SPDX-License-Identifier: MIT */
/* Records of what was found: see keep.h. */
#include "scene/reuse/keep.h"

#include "scene/reuse/motion_since.h"

/* --- room --- */

/* A record with room for so many contacts in *ret_new, unless the one at hand has it; false when out of memory. */
static bool reserve(pir_scene *scene, const pir_kept_record *at_hand, uint32_t contacts, pir_kept_record **ret_new) {
    if (at_hand && at_hand->room >= contacts)
        return true;
    *ret_new = pir_kept_pool_take(&scene->pairs.kept, &scene->allocator, contacts);
    return *ret_new;
}

static void give_back(pir_scene *scene) {
    for (uint32_t w = 0; w < scene->threads; w++)
        for (uint32_t i = 0; i < scene->worker[w].found_count; i++) {
            pir_kept_pool_give(&scene->pairs.kept, scene->worker[w].news[i].kept);
            pir_kept_pool_give(&scene->pairs.kept, scene->worker[w].news[i].united);
        }
}

pir_status pir_reserve_records(pir_scene *scene) {
    bool good = true;
    for (uint32_t w = 0; w < scene->threads; w++)
        for (uint32_t i = 0; i < scene->worker[w].found_count && good; i++) {
            const pir_scene_found *found = &scene->worker[w].found[i];
            pir_scene_news *news = &scene->worker[w].news[i];
            const pir_scene_pair *pair = &scene->pairs.at[found->pair];
            if (news->new_answer)
                good = reserve(scene, pair->kept, news->new_contacts ? found->count : 0, &news->kept);
            if (news->union_number > 0 && good)
                good = reserve(scene, pair->united, news->union_room, &news->united);
        }
    if (!good)
        give_back(scene);
    return good ? PIR_OK : PIR_ERR_MEMORY;
}

/* --- records --- */

/* The two bodies of a pair, and the one that normals move with. */
struct kept_frames {
    pir_mat3 r[2];
    pir_vec3 origin[2];
    int by;
};

static struct kept_frames frames_of(const pir_scene *scene, uint32_t pair) {
    struct kept_frames frames = {.by = 1 - pir_seen_side_of(scene, pair).side};
    for (int side = 0; side < 2; side++) {
        const pir_scene_piece *piece = &scene->bodies.piece[scene->pairs.at[pair].piece[side]];
        const pir_scene_body *body = &scene->bodies.body[piece->body];
        frames.r[side] = pir_doubles_as_given(body->unit).r;
        frames.origin[side] = body->pose.translation;
    }
    return frames;
}

/* A point in the frame of a body. */
static pir_vec3 kept_point(const struct kept_frames *frames, int side, pir_vec3 point) {
    return pir_mat_apply_transposed(&frames->r[side], pir_vec_sub(point, frames->origin[side]));
}

static pir_vec3 kept_normal(const struct kept_frames *frames, pir_vec3 normal) {
    return pir_mat_apply_transposed(&frames->r[frames->by], normal);
}

/* Adds the contacts of an event. */
static void add_event(const struct kept_frames *frames, const pir_scene_worker *worker, const pir_scene_found *found,
                      pir_kept_record *record) {
    const pir_vec3 normal = kept_normal(frames, found->normal);
    const uint32_t first = record->count;
    for (uint32_t i = 0; i < found->count; i++) {
        const pir_contact *contact = &worker->contact[found->first + i];
        record->contact[record->count++] = (pir_kept_contact){
            .point = {kept_point(frames, 0, contact->point_p), kept_point(frames, 1, contact->point_q)},
            .normal = normal,
            .place = i == 0 ? PIR_KEPT_FIRST : PIR_KEPT_ON,
            .id = contact->id};
    }
    if (found->count == 0)
        record->contact[first] = (pir_kept_contact){.place = PIR_KEPT_NONE};
    record->count = first + (found->count > 0 ? found->count : 1);
}

/* Puts a new record in place of the one of a pair, where there is one. */
static pir_kept_record *put(pir_scene *scene, pir_kept_record **record, pir_kept_record *new_record) {
    if (new_record) {
        pir_kept_pool_give(&scene->pairs.kept, *record);
        *record = new_record;
    }
    return *record;
}

/* The answer of a pair, and contacts that were found anew. */
static void keep_own(pir_scene *scene, const pir_scene_worker *worker, const pir_scene_found *found,
                     const pir_scene_news *news) {
    pir_kept_record *record = put(scene, &scene->pairs.at[found->pair].kept, news->kept);
    const struct kept_frames frames = frames_of(scene, found->pair);
    record->answer = (pir_kept_answer){
        .seen = news->seen,
        .distance = found->distance,
        .point = {kept_point(&frames, 0, news->told_point[0]), kept_point(&frames, 1, news->told_point[1])},
        .normal = kept_normal(&frames, news->told_normal),
        .state = found->state,
        .witness = found->witness};
    if (!news->new_contacts)
        return;
    record->made = news->seen;
    record->count = 0;
    if (found->count > 0)
        add_event(&frames, worker, found, record);
}

/* Begins the record of a union, without contacts. */
static void begin_united(pir_scene *scene, const pir_scene_found *found, const pir_scene_news *news) {
    pir_kept_record *record = put(scene, &scene->pairs.at[found->pair].united, news->united);
    record->made = news->seen;
    record->union_number = news->union_number;
    record->members = news->members;
    record->count = 0;
}

void pir_keep_found(pir_scene *scene) {
    for (uint32_t w = 0; w < scene->threads; w++) {
        const pir_scene_worker *worker = &scene->worker[w];
        for (uint32_t i = 0; i < worker->found_count; i++) {
            if (worker->news[i].new_answer)
                keep_own(scene, worker, &worker->found[i], &worker->news[i]);
            if (worker->news[i].union_number > 0)
                begin_united(scene, &worker->found[i], &worker->news[i]);
        }
    }
    for (uint32_t w = 0; w < scene->threads; w++) {
        const pir_scene_worker *worker = &scene->worker[w];
        for (uint32_t i = 0; i < worker->on_surface_count; i++) {
            const pir_scene_found *found = &worker->on_surface[i];
            if (pir_scene_news_of(scene, found)->union_number == 0)
                continue;
            const struct kept_frames frames = frames_of(scene, found->pair);
            add_event(&frames, worker, found, scene->pairs.at[found->pair].united);
        }
    }
}
