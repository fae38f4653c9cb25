/* SPDX-License-Identifier: MIT */
/*
 * The pieces that a shape overlaps, and those whose boxes meet a box. Hits are kept in order, so that those beyond the
 * capacity are dropped.
 */
#include "scene/query/near_pieces.h"
#include "scene/world/grow.h"

struct overlap_hits {
    const pir_probe *probe;
    size_t capacity, count; /* of the scene's room for such answers */
};

static bool comes_before(const void *x, const void *y) {
    const pir_scene_hit *a = x, *b = y;
    return a->body != b->body ? a->body < b->body : a->piece < b->piece;
}

static pir_status put(struct overlap_hits *hits, const pir_scene_hit *hit) {
    pir_scene *scene = hits->probe->scene;
    const pir_order order = {sizeof *hit, hits->capacity, comes_before};
    const bool is_put = pir_put_in_order(&scene->allocator, &scene->answers.hit, &scene->answers.hit_capacity, &order,
                                         hit, &hits->count);
    return is_put ? PIR_OK : PIR_ERR_MEMORY;
}

static pir_status fail(const struct overlap_hits *hits, const char *call, pir_status status,
                       const pir_scene_piece *piece) {
    return pir_fail(hits->probe->scene->report, status, "%s: body %u, piece %u: %s", call, (unsigned)piece->body,
                    (unsigned)piece->number, pir_status_text(status));
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
        status = put(hits, &(pir_scene_hit){.body = piece->body,
                                            .piece = piece->number,
                                            .state = answer.state,
                                            .piece_user = pir_piece_user(&hits->probe->scene->bodies, piece)});
    return status == PIR_OK ? PIR_OK : fail(hits, "overlap", status, piece);
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

/* --- boxes alone --- */

static pir_status look_at_box(void *context, pir_scene_piece *piece) {
    struct overlap_hits *hits = context;
    if (!pir_box_meets(&piece->tight, &hits->probe->box))
        return PIR_OK;
    const pir_status status =
        put(hits, &(pir_scene_hit){.body = piece->body,
                                   .piece = piece->number,
                                   .piece_user = pir_piece_user(&hits->probe->scene->bodies, piece)});
    return status == PIR_OK ? PIR_OK : fail(hits, "boxes", status, piece);
}

/* Checks a box, and makes one of floats that holds what of it any body may be in. */
static pir_status take_box(const pir_scene *scene, const pir_scene_box *box, pir_box *ret_box) {
    const double low[3] = {box->low.x, box->low.y, box->low.z}, high[3] = {box->high.x, box->high.y, box->high.z};
    const double farthest = 2 * PIR_BOX_FARTHEST;
    for (int k = 0; k < 3; k++) {
        if (isnan(low[k]) || isnan(high[k]))
            return pir_fail(scene->report, PIR_ERR_NOT_FINITE, "boxes: %c of a corner is not a number", "xyz"[k]);
        if (low[k] > high[k])
            return pir_fail(scene->report, PIR_ERR_ARGUMENT, "boxes: in %c the low corner is at %g, the high one at %g",
                            "xyz"[k], low[k], high[k]);
        ret_box->low[k] = pir_float_below(fmax(fmin(low[k], farthest), -farthest));
        ret_box->high[k] = pir_float_above(fmax(fmin(high[k], farthest), -farthest));
    }
    return PIR_OK;
}

pir_status pir_scene_in_box(pir_scene *scene, const pir_scene_box *box, size_t capacity, pir_scene_part *ret_parts,
                            size_t *ret_count) {
    const double most = 0;
    const char *missing = !box ? "box" : !ret_parts && capacity > 0 ? "ret_parts" : !ret_count ? "ret_count" : NULL;
    pir_probe probe = {.scene = scene, .body = PIR_SCENE_NONE};
    pir_status status = pir_scene_given(scene, "boxes", missing);
    if (status == PIR_OK)
        status = take_box(scene, box, &probe.box);
    if (status != PIR_OK)
        return status;
    probe.mask = box->mask;
    probe.except = pir_bodies_find(&scene->bodies, box->except);
    probe.filter = box->filter;
    struct overlap_hits hits = {&probe, capacity, 0};
    status = pir_near_pieces(
        &(pir_near_search){.probe = &probe, .box = probe.box, .most = &most, .look = look_at_box, .context = &hits});
    if (status != PIR_OK)
        return status;
    for (size_t i = 0; i < hits.count && i < capacity; i++) {
        const pir_scene_hit *hit = &scene->answers.hit[i];
        const pir_scene_body *body = &scene->bodies.body[hit->body];
        ret_parts[i] =
            (pir_scene_part){pir_body_id(&scene->bodies, hit->body), hit->piece, body->user, hit->piece_user};
    }
    *ret_count = hits.count;
    return PIR_OK;
}
