/* SPDX-License-Identifier: MIT */
/* The pieces that a shape overlaps. Hits are kept in order, so that those beyond the capacity fall off. */
#include "scene/query/probe.h"
#include "scene/world/grow.h"

static bool comes_before(const pir_scene_hit *a, const pir_scene_hit *b) {
    return a->body != b->body ? a->body < b->body : a->piece < b->piece;
}

/* Puts a hit in its place among the `count` that there are, of which the first `capacity` are kept. */
static pir_status put(pir_scene *scene, pir_scene_hit hit, size_t capacity, size_t count) {
    pir_scene_answers *answers = &scene->answers;
    size_t at = count < capacity ? count : capacity;
    if (at < capacity && !PIR_GROW(&scene->allocator, answers->hit, answers->hit_capacity, (uint32_t)at + 1))
        return PIR_ERR_MEMORY;
    pir_scene_hit *hits = answers->hit;
    if (at == capacity && (capacity == 0 || !comes_before(&hit, &hits[--at])))
        return PIR_OK;
    for (; at > 0 && comes_before(&hit, &hits[at - 1]); at--)
        hits[at] = hits[at - 1];
    hits[at] = hit;
    return PIR_OK;
}

pir_status pir_scene_overlap(pir_scene *scene, const pir_scene_shape *shape, size_t capacity, pir_scene_hit *ret_hits,
                             size_t *ret_count) {
    pir_probe probe;
    if (!scene || !shape || (!ret_hits && capacity > 0) || !ret_count)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_probe_of_shape(scene, shape, &probe);
    if (status != PIR_OK)
        return status;
    size_t count = 0;
    for (uint32_t leaf = pir_tree_first(&scene->tree, &probe.box); leaf != PIR_TREE_NONE;
         leaf = pir_tree_next(&scene->tree, &probe.box, leaf)) {
        uint32_t piece = pir_tree_item(&scene->tree, leaf);
        const pir_scene_piece *p = &scene->bodies.piece[piece];
        pir_pair *pair;
        pir_pair_input input;
        pir_query_result answer;
        if (!pir_box_meets(&p->tight, &probe.box) || !pir_probe_meets(&probe, piece))
            continue;
        status = pir_probe_pair(&probe, piece, &pair, &input);
        if (status == PIR_OK)
            status = pir_pair_overlap(pair, scene->worker[0].workspace, &input, &answer);
        if (status == PIR_OK && answer.state != PIR_OUTSIDE)
            status = put(scene, (pir_scene_hit){p->body, p->number, answer.state}, capacity, count++);
        if (status != PIR_OK)
            return pir_fail(scene->report, status, "overlap: body %u, piece %u: %s", (unsigned)p->body,
                            (unsigned)p->number, pir_status_text(status));
    }
    for (size_t i = 0; i < count && i < capacity; i++)
        ret_hits[i] = scene->answers.hit[i];
    *ret_count = count;
    return PIR_OK;
}
