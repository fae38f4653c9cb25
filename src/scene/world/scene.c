/* SPDX-License-Identifier: MIT */
/* The life of a scene, its bodies coming and going: see scene.h. */
#include "scene/world/scene.h"

#include <pirouette/scene_file.h>

#include "base/options.h"
#include "scene/world/grow.h"
#include "scene/world/surfaces.h"
#include "scene/world/triangles.h"

#define THREADS_MAX 64

/* How much wider a box in the tree is than the piece in it, of its greatest edge. */
#define FAT 0.05f

/* --- the scene --- */

static pir_status check(const pir_scene_options *options) {
    pir_report *report = options->report;
    if (!isfinite(options->margin))
        return pir_fail(report, PIR_ERR_NOT_FINITE, "scene: its margin is not finite");
    if (!(options->detail >= PIR_SCENE_STATES && options->detail <= PIR_SCENE_MANIFOLDS))
        return pir_fail(report, PIR_ERR_ARGUMENT, "scene: there is no detail %d", (int)options->detail);
    if (options->margin < 0)
        return pir_fail(report, PIR_ERR_ARGUMENT, "scene: its margin is %g, below 0", options->margin);
    if (options->detail == PIR_SCENE_STATES && options->margin > 0)
        return pir_fail(report, PIR_ERR_ARGUMENT, "scene: a margin of %g needs distances, and it has states alone",
                        options->margin);
    if (!isfinite(options->reuse))
        return pir_fail(report, PIR_ERR_NOT_FINITE, "scene: its reuse is not finite");
    if (options->reuse < 0)
        return pir_fail(report, PIR_ERR_ARGUMENT, "scene: its reuse is %g, below 0", options->reuse);
    if (options->reuse > 0 && options->detail != PIR_SCENE_MANIFOLDS)
        return pir_fail(report, PIR_ERR_ARGUMENT, "scene: a reuse of %g needs manifolds, and it has none",
                        options->reuse);
    if (options->threads < 1 || options->threads > THREADS_MAX)
        return pir_fail(report, PIR_ERR_ARGUMENT, "scene: %u threads, not 1 to %d", (unsigned)options->threads,
                        THREADS_MAX);
    if (options->tasks && (!options->tasks->start || !options->tasks->finish))
        return pir_fail(report, PIR_ERR_ARGUMENT, "scene: tasks without their two functions");
    return PIR_OK;
}

/* Workers, and threads for them where the caller brings none. */
static pir_status make_workers(pir_scene *scene, const pir_scene_options *options) {
    scene->threads = options->threads;
    scene->worker = PIR_ZEROED(&scene->allocator, pir_scene_worker, scene->threads);
    if (!scene->worker)
        return PIR_ERR_MEMORY;
    pir_status status = PIR_OK;
    for (uint32_t i = 0; i < scene->threads && status == PIR_OK; i++)
        status = pir_workspace_create(&scene->allocator, &scene->worker[i].workspace);
    if (status == PIR_OK && options->tasks)
        scene->tasks = *options->tasks;
    if (status == PIR_OK && !options->tasks && scene->threads > 1) {
        status = pir_task_pool_create(&scene->allocator, scene->threads, &scene->pool);
        if (status == PIR_OK)
            scene->tasks = pir_task_pool_interface(scene->pool);
    }
    return status;
}

pir_status pir_scene_create(const pir_scene_options *options, pir_scene **ret_scene) {
    pir_scene_options used = pir_scene_options_default();
    pir_status status = pir_options_take("pir_scene_options", options, &used, &used.report);
    if (status != PIR_OK)
        return status;
    if (!ret_scene)
        return pir_fail(used.report, PIR_ERR_ARGUMENT, "scene: ret_scene is NULL");
    status = check(&used);
    if (status != PIR_OK)
        return status;
    const pir_allocator a = pir_allocator_or_default(used.allocator);
    pir_scene *scene = used.budget == 0 || used.budget >= sizeof *scene ? PIR_ZEROED(&a, pir_scene, 1) : NULL;
    if (!scene)
        return pir_fail(used.report, PIR_ERR_MEMORY, "scene: no memory for it, or a budget below it");
    pir_budget_init(&scene->budget, &a, used.budget);
    scene->budget.used = scene->budget.peak = sizeof *scene;
    scene->allocator = pir_budget_allocator(&scene->budget);
    pir_blocks_init(&scene->blocks, &scene->allocator);
    scene->for_triangles = pir_blocks_allocator(&scene->blocks);
    scene->detail = used.detail;
    scene->margin = used.margin;
    scene->reuse = used.reuse;
    scene->approach = used.approach;
    scene->unions = used.unions;
    scene->keep_shapes = used.keep_shapes;
    scene->profiles = used.profile;
    scene->clock = used.clock;
    scene->clock_context = used.clock_context;
    scene->report = used.report;
    pir_bodies_init(&scene->bodies);
    scene->bodies.meets = used.meets;
    scene->bodies.meets_context = used.meets_context;
    pir_scene_pairs_init(&scene->pairs);
    status = make_workers(scene, &used);
    if (status != PIR_OK) {
        pir_scene_destroy(scene);
        return pir_fail(used.report, status, "scene: its workers: %s", pir_status_text(status));
    }
    *ret_scene = scene;
    return PIR_OK;
}

pir_status pir_scene_given(const pir_scene *scene, const char *call, const char *missing) {
    if (!scene)
        return PIR_ERR_ARGUMENT;
    return missing ? pir_fail(scene->report, PIR_ERR_ARGUMENT, "%s: %s is NULL", call, missing) : PIR_OK;
}

static void finish_lists(pir_scene_lists *lists, const pir_allocator *a) {
    PIR_FREE(a, lists->moved, lists->moved_capacity);
    PIR_FREE(a, lists->box, lists->box_capacity);
    PIR_FREE(a, lists->replaced, lists->replaced_capacity);
    PIR_FREE(a, lists->asked, lists->asked_capacity);
    PIR_FREE(a, lists->ended, lists->ended_capacity);
    PIR_FREE(a, lists->triangle, lists->triangle_capacity);
    PIR_FREE(a, lists->run, lists->run_capacity);
    PIR_FREE(a, lists->item, lists->item_capacity);
    PIR_FREE(a, lists->work, lists->work_capacity);
}

static void finish_target(pir_scene_target *target, const pir_allocator *a) {
    PIR_FREE(a, target->away, target->away_capacity);
    PIR_FREE(a, target->box, target->box_capacity);
    PIR_FREE(a, target->changed, target->changed_capacity);
    PIR_FREE(a, target->piece, target->piece_capacity);
    PIR_FREE(a, target->coarse, target->coarse_capacity);
}

void pir_scene_destroy(pir_scene *scene) {
    if (!scene)
        return;
    const pir_allocator *a = &scene->allocator;
    pir_task_pool_destroy(scene->pool);
    for (uint32_t i = 0; scene->worker && i < scene->threads; i++) {
        pir_workspace_destroy(scene->worker[i].workspace);
        PIR_FREE(a, scene->worker[i].noted, scene->worker[i].noted_capacity);
        PIR_FREE(a, scene->worker[i].found, scene->worker[i].found_capacity);
        PIR_FREE(a, scene->worker[i].news, scene->worker[i].news_capacity);
        PIR_FREE(a, scene->worker[i].contact, scene->worker[i].contact_capacity);
        PIR_FREE(a, scene->worker[i].on_surface, scene->worker[i].on_surface_capacity);
        PIR_FREE(a, scene->worker[i].surface, scene->worker[i].surface_capacity);
        PIR_FREE(a, scene->worker[i].met, scene->worker[i].met_capacity);
        PIR_FREE(a, scene->worker[i].beside, scene->worker[i].beside_capacity);
        PIR_FREE(a, scene->worker[i].near_triangle, scene->worker[i].near_triangle_capacity);
    }
    PIR_FREE(a, scene->worker, scene->threads);
    pir_scene_pairs_finish(&scene->pairs, a);
    pir_pair_destroy(scene->spare);
    PIR_FREE(&scene->allocator, scene->exact_room.limbs.base, scene->exact_room.limbs.capacity);
    PIR_FREE(&scene->allocator, scene->exact_room.integers, 1);
    PIR_FREE(a, scene->answers.hit, scene->answers.hit_capacity);
    PIR_FREE(a, scene->answers.near, scene->answers.near_capacity);
    PIR_FREE(a, scene->answers.distance, scene->answers.distance_capacity);
    PIR_FREE(a, scene->answers.impact, scene->answers.impact_capacity);
    PIR_FREE(a, scene->answers.met, scene->answers.met_capacity);
    pir_tree_finish(&scene->tree, a);
    pir_bodies_finish(&scene->bodies, a);
    pir_kept_shapes_drop(&scene->shapes, a);
    PIR_FREE(a, scene->fresh, scene->fresh_capacity);
    PIR_FREE(a, scene->gone, scene->gone_capacity);
    PIR_FREE(a, scene->event, scene->event_capacity);
    PIR_FREE(a, scene->impact, scene->impact_capacity);
    finish_lists(&scene->lists, a);
    finish_target(&scene->target, a);
    pir_blocks_finish(&scene->blocks);
    const pir_allocator base = scene->budget.base;
    pir_budget_finish(&scene->budget);
    PIR_FREE(&base, scene, 1);
}

/* --- bodies --- */

/* A body is of pieces, or of one surface and does not move freely. */
static pir_status check_form(const pir_body_options *body, pir_report *report) {
    if (!body->mesh && !body->field)
        return body->pieces && body->piece_count > 0 ? PIR_OK
                                                     : pir_fail(report, PIR_ERR_ARGUMENT, "body: it has no pieces");
    if (body->mesh && body->field)
        return pir_fail(report, PIR_ERR_ARGUMENT, "body: it has both a mesh and a height field");
    if (body->pieces)
        return pir_fail(report, PIR_ERR_ARGUMENT, "body: it has both pieces and a surface");
    if (body->kind == PIR_BODY_MOVING)
        return pir_fail(report, PIR_ERR_ARGUMENT, "body: it has a surface, which must be static or kinematic");
    return PIR_OK;
}

static pir_status check_body(const pir_body_options *body, pir_report *report) {
    if (!(body->kind >= PIR_BODY_MOVING && body->kind <= PIR_BODY_STATIC))
        return pir_fail(report, PIR_ERR_ARGUMENT, "body: there is no kind %d", (int)body->kind);
    const pir_status status = check_form(body, report);
    if (status != PIR_OK)
        return status;
    if (isnan(body->radius))
        return pir_fail(report, PIR_ERR_NOT_FINITE, "body: its radius is not a number");
    if (!(body->radius >= 0 && body->radius < HUGE_VAL))
        return pir_fail(report, PIR_ERR_ARGUMENT, "body: its radius is %g, not from 0 up", body->radius);
    if (isnan(body->fast))
        return pir_fail(report, PIR_ERR_NOT_FINITE, "body: its tolerance as a fast body is not a number");
    if (!(body->fast >= 0 && body->fast < HUGE_VAL) || (body->fast > 0 && !body->pieces))
        return pir_fail(report, PIR_ERR_ARGUMENT,
                        "body: its tolerance as a fast body is %g, not from 0 up, or it has a surface", body->fast);
    if (body->piece_count > PIR_PIECES_MAX)
        return pir_fail(report, PIR_ERR_LIMIT, "body: %u pieces, more than %d", (unsigned)body->piece_count,
                        (int)PIR_PIECES_MAX);
    for (uint32_t i = 0; body->pieces && i < body->piece_count; i++) {
        if (!body->pieces[i])
            return pir_fail(report, PIR_ERR_ARGUMENT, "body: piece %u is NULL", (unsigned)i);
        if (!pir_is_coarse_of(body->coarse ? body->coarse[i] : NULL, body->pieces[i]))
            return pir_fail(report, PIR_ERR_ARGUMENT, "body: the coarse bodies of piece %u are another polytope's",
                            (unsigned)i);
    }
    return PIR_OK;
}

pir_box pir_scene_fat_box(const pir_box *tight, pir_vec3 way) {
    float edge = 0, on[3] = {(float)way.x, (float)way.y, (float)way.z};
    for (int k = 0; k < 3; k++)
        edge = fmaxf(edge, tight->high[k] - tight->low[k]);
    pir_box fat = *tight;
    for (int k = 0; k < 3; k++) {
        // not on by more than the piece itself
        float ahead = fminf(fmaxf(on[k], -edge), edge);
        fat.low[k] -= FAT * edge - fminf(ahead, 0);
        fat.high[k] += FAT * edge + fmaxf(ahead, 0);
    }
    return fat;
}

void pir_scene_put_leaves(pir_scene *scene, uint32_t body, const pir_box *box) {
    bool is_static = scene->bodies.body[body].kind == PIR_BODY_STATIC;
    for (uint32_t i = scene->bodies.body[body].first; i != PIR_PIECE_NONE; i = scene->bodies.piece[i].next) {
        pir_scene_piece *piece = &scene->bodies.piece[i];
        piece->tight = box[piece->number];
        pir_box fat = is_static ? piece->tight : pir_scene_fat_box(&piece->tight, (pir_vec3){0, 0, 0});
        piece->node = pir_tree_insert(&scene->tree, &fat, i);
    }
}

pir_status pir_scene_body_boxes(const pir_scene *scene, const pir_body_options *body, const pir_place *place,
                                pir_box *box) {
    const double around = body->radius + 0.5 * scene->margin;
    if (!body->pieces) {
        pir_vec3 corner[8];
        const pir_surface_ref surface = {body->mesh, body->field};
        const uint32_t count = pir_surface_corners(surface, corner);
        const pir_reaching corners = {corner, count, pir_surface_farthest(surface)};
        if (!pir_place_points(place, &corners, around, box))
            return pir_fail(scene->report, PIR_ERR_LIMIT, "body: its surface reaches beyond 2^60");
        return PIR_OK;
    }
    for (uint32_t i = 0; i < body->piece_count; i++) {
        pir_extent extent = pir_extent_of(body->pieces[i]);
        if (!pir_place_box(place, &extent, around, &box[i]))
            return pir_fail(scene->report, PIR_ERR_LIMIT, "body: piece %u reaches beyond 2^60", (unsigned)i);
    }
    return PIR_OK;
}

pir_status pir_scene_keep(pir_scene *scene, const pir_body_options *body) {
    pir_body_options used = pir_body_options_default();
    pir_status status = pir_scene_given(scene, "shape", body ? NULL : "body");
    if (status == PIR_OK)
        status = pir_options_take("pir_body_options", body, &used, &scene->report);
    if (status == PIR_OK)
        status = check_body(&used, scene->report);
    if (status != PIR_OK)
        return status;
    status = pir_kept_shapes_add(&scene->shapes, &scene->allocator, &used, pir_shape_hash(&used));
    return status == PIR_OK ? PIR_OK : pir_fail(scene->report, status, "shape: %s", pir_status_text(status));
}

void pir_scene_forget_shapes(pir_scene *scene) {
    if (scene)
        pir_kept_shapes_drop(&scene->shapes, &scene->allocator);
}

/* Adds a body whose options have been checked. */
static pir_status add(pir_scene *scene, const pir_body_options *body, uint32_t *ret_body) {
    pir_place place;
    const uint32_t pieces = body->pieces ? body->piece_count : 1;
    pir_status status = pir_place_make(body->pose, &place);
    if (status != PIR_OK)
        return pir_place_fail(body->pose, status, "body", scene->report);
    status = pir_bodies_reserve(&scene->bodies, &scene->allocator, pieces);
    if (status != PIR_OK)
        return pir_fail(scene->report, status, "body: room for it: %s", pir_status_text(status));
    pir_scene_lists *lists = &scene->lists;
    if (!pir_tree_reserve(&scene->tree, &scene->allocator, scene->tree.leaves + pieces) ||
        !PIR_GROW(&scene->allocator, lists->box, lists->box_capacity, pieces) ||
        !PIR_GROW(&scene->allocator, scene->fresh, scene->fresh_capacity, scene->fresh_count + 1))
        return pir_fail(scene->report, PIR_ERR_MEMORY, "body: room for it: %s", pir_status_text(PIR_ERR_MEMORY));
    status = pir_scene_body_boxes(scene, body, &place, lists->box);
    if (status != PIR_OK)
        return status;
    if (scene->keep_shapes && pir_scene_keep(scene, body) != PIR_OK)
        return PIR_ERR_MEMORY;
    uint32_t added = pir_bodies_add(&scene->bodies, body, &place);
    pir_scene_put_leaves(scene, added, lists->box);
    scene->fresh[scene->fresh_count++] = added;
    *ret_body = pir_body_id(&scene->bodies, added);
    return PIR_OK;
}

pir_status pir_scene_add(pir_scene *scene, const pir_body_options *body, uint32_t *ret_body) {
    pir_body_options used = pir_body_options_default();
    pir_status status = pir_scene_given(scene, "body", !body ? "body" : !ret_body ? "ret_body" : NULL);
    if (status == PIR_OK)
        status = pir_options_take("pir_body_options", body, &used, &scene->report);
    if (status == PIR_OK)
        status = check_body(&used, scene->report);
    return status == PIR_OK ? add(scene, &used, ret_body) : status;
}

/* --- reading --- */

const pir_scene_event *pir_scene_events(const pir_scene *scene, size_t *ret_count) {
    *ret_count = scene->event_count;
    return scene->event_count > 0 ? scene->event : NULL;
}

const pir_scene_impact *pir_scene_impacts(const pir_scene *scene, size_t *ret_count) {
    *ret_count = scene->impact_count;
    return scene->impact_count > 0 ? scene->impact : NULL;
}

pir_scene_profile pir_scene_get_profile(const pir_scene *scene) {
    return scene->profile;
}

pir_scene_statistics pir_scene_get_statistics(const pir_scene *scene) {
    return (pir_scene_statistics){.bodies = scene->bodies.body_count,
                                  .pieces = scene->bodies.piece_count,
                                  .triangles = scene->bodies.triangle_count,
                                  .pairs = scene->pairs.count,
                                  .looked = scene->looked,
                                  .asked = scene->lists.asked_count,
                                  .replaced = scene->lists.replaced_count,
                                  .bytes = scene->budget.used,
                                  .peak = scene->budget.peak};
}
