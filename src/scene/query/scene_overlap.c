/* SPDX-License-Identifier: MIT */
/* The pieces that a shape overlaps. Hits are kept in order, so that those beyond the capacity are dropped. */
#include "scene/query/near_pieces.h"
#include "scene/world/grow.h"

struct overlap_hits {
    const pir_probe *probe;
    size_t capacity, count; /* of the scene's room for such answers */
};

static bool comes_before(const pir_scene_hit *a, const pir_scene_hit *b) {
    return a->body != b->body ? a->body < b->body : a->piece < b->piece;
}

/* Puts a hit in its place among those that there are, of which the first `capacity` are kept. */
static pir_status put(struct overlap_hits *hits, pir_scene_hit hit) {
    pir_scene *scene = hits->probe->scene;
    pir_scene_answers *answers = &scene->answers;
    size_t at = hits->count < hits->capacity ? hits->count : hits->capacity;
    const bool is_full = at == hits->capacity;
    if (!is_full && !PIR_GROW(&scene->allocator, answers->hit, answers->hit_capacity, (uint32_t)at + 1))
        return PIR_ERR_MEMORY;
    hits->count++;
    if (is_full && (at == 0 || !comes_before(&hit, &answers->hit[--at])))
        return PIR_OK;
    for (; at > 0 && comes_before(&hit, &answers->hit[at - 1]); at--)
        answers->hit[at] = answers->hit[at - 1];
    answers->hit[at] = hit;
    return PIR_OK;
}

static pir_status look(void *context, pir_scene_piece *piece) {
    struct overlap_hits *hits = context;
    pir_pair *pair;
    pir_pair_input input;
    pir_query_result answer;
    if (!pir_box_meets(&piece->tight, &hits->probe->box))
        return PIR_OK;
    pir_status status = pir_probe_pair(hits->probe, piece, &pair, &input);
    if (status == PIR_OK)
        status = pir_pair_overlap(pair, hits->probe->scene->worker[0].workspace, &input, &answer);
    if (status == PIR_OK && answer.state != PIR_OUTSIDE)
        status = put(hits, (pir_scene_hit){.body = piece->body,
                                           .piece = piece->number,
                                           .state = answer.state,
                                           .piece_user = pir_piece_user(&hits->probe->scene->bodies, piece)});
    if (status != PIR_OK)
        return pir_fail(hits->probe->scene->report, status, "overlap: body %u, piece %u: %s", (unsigned)piece->body,
                        (unsigned)piece->number, pir_status_text(status));
    return PIR_OK;
}

pir_status pir_scene_overlap(pir_scene *scene, const pir_scene_shape *shape, size_t capacity, pir_scene_hit *ret_hits,
                             size_t *ret_count) {
    pir_probe probe;
    const double most = 0;
    const char *missing = !shape ? "shape" : !ret_hits && capacity > 0 ? "ret_hits" : !ret_count ? "ret_count" : NULL;
    pir_status status = pir_scene_given(scene, "overlap", missing);
    if (status == PIR_OK)
        status = pir_probe_of_shape(scene, shape, &probe);
    if (status != PIR_OK)
        return status;
    struct overlap_hits hits = {&probe, capacity, 0};
    status = pir_near_pieces(
        &(pir_near_search){.probe = &probe, .box = probe.box, .most = &most, .look = look, .context = &hits});
    if (status != PIR_OK)
        return status;
    for (size_t i = 0; i < hits.count && i < capacity; i++) {
        ret_hits[i] = scene->answers.hit[i];
        ret_hits[i].user = scene->bodies.body[ret_hits[i].body].user;
        ret_hits[i].body = pir_body_id(&scene->bodies, ret_hits[i].body);
    }
    *ret_count = hits.count;
    return PIR_OK;
}
