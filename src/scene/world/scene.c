/* SPDX-License-Identifier: MIT */
/* The life of a scene, its bodies coming and going: see scene.h. */
#include "scene/world/scene.h"

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
    scene->approach = used.approach;
    scene->unions = used.unions;
    scene->report = used.report;
    pir_bodies_init(&scene->bodies);
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

void pir_scene_destroy(pir_scene *scene) {
    if (!scene)
        return;
    const pir_allocator *a = &scene->allocator;
    pir_task_pool_destroy(scene->pool);
    for (uint32_t i = 0; scene->worker && i < scene->threads; i++) {
        pir_workspace_destroy(scene->worker[i].workspace);
        PIR_FREE(a, scene->worker[i].noted, scene->worker[i].noted_capacity);
        PIR_FREE(a, scene->worker[i].found, scene->worker[i].found_capacity);
        PIR_FREE(a, scene->worker[i].contact, scene->worker[i].contact_capacity);
        PIR_FREE(a, scene->worker[i].on_surface, scene->worker[i].on_surface_capacity);
        PIR_FREE(a, scene->worker[i].surface, scene->worker[i].surface_capacity);
        PIR_FREE(a, scene->worker[i].met, scene->worker[i].met_capacity);
        PIR_FREE(a, scene->worker[i].beside, scene->worker[i].beside_capacity);
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
    pir_tree_finish(&scene->tree, a);
    pir_bodies_finish(&scene->bodies, a);
    PIR_FREE(a, scene->fresh, scene->fresh_capacity);
    PIR_FREE(a, scene->event, scene->event_capacity);
    finish_lists(&scene->lists, a);
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

/* Boxes for the pieces of a body that was put in, and leaves of the tree. */
static void put_leaves(pir_scene *scene, uint32_t body) {
    const pir_box *box = scene->lists.box;
    bool is_static = scene->bodies.body[body].kind == PIR_BODY_STATIC;
    for (uint32_t i = scene->bodies.body[body].first; i != PIR_PIECE_NONE; i = scene->bodies.piece[i].next) {
        pir_scene_piece *piece = &scene->bodies.piece[i];
        piece->tight = box[piece->number];
        pir_box fat = is_static ? piece->tight : pir_scene_fat_box(&piece->tight, (pir_vec3){0, 0, 0});
        piece->node = pir_tree_insert(&scene->tree, &fat, i);
    }
}

/* The boxes of a body to be, for which there is room in the lists. PIR_ERR_LIMIT. */
static pir_status make_boxes(pir_scene *scene, const pir_body_options *body, const pir_place *place) {
    const double around = body->radius + 0.5 * scene->margin;
    pir_box *box = scene->lists.box;
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
    status = make_boxes(scene, body, &place);
    if (status != PIR_OK)
        return status;
    uint32_t added = pir_bodies_add(&scene->bodies, body, &place);
    put_leaves(scene, added);
    scene->fresh[scene->fresh_count++] = added;
    *ret_body = added;
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

void pir_scene_drop_pair(pir_scene *scene, uint32_t pair) {
    pir_scene_piece *pieces = scene->bodies.piece;
    const uint32_t of[2] = {scene->pairs.at[pair].piece[0], scene->pairs.at[pair].piece[1]};
    pir_scene_pairs_drop(&scene->pairs, pair, &pieces[of[0]].first, &pieces[of[1]].first);
    for (int side = 0; side < 2; side++)
        if (pieces[of[side]].kind == PIR_PIECE_TRIANGLE && pieces[of[side]].first == PIR_END_NONE)
            pir_triangles_remove(&scene->bodies, of[side]);
}

/* Drops all pairs that a piece is in, or its triangles are. */
static void drop_pairs(pir_scene *scene, uint32_t piece) {
    const pir_scene_piece *pieces = scene->bodies.piece;
    const pir_body_surface *surface = &scene->bodies.body[pieces[piece].body].surface;
    while (pieces[piece].first != PIR_END_NONE)
        pir_scene_drop_pair(scene, pieces[piece].first / 2);
    while (pieces[piece].kind == PIR_PIECE_SURFACE && surface->triangles != PIR_PIECE_NONE)
        pir_scene_drop_pair(scene, pieces[surface->triangles].first / 2);
}

pir_status pir_scene_remove(pir_scene *scene, uint32_t body) {
    if (!scene)
        return PIR_ERR_ARGUMENT;
    if (!pir_bodies_has(&scene->bodies, body))
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "remove: there is no body %u", (unsigned)body);
    for (uint32_t i = scene->bodies.body[body].first; i != PIR_PIECE_NONE; i = scene->bodies.piece[i].next) {
        drop_pairs(scene, i);
        pir_tree_remove(&scene->tree, scene->bodies.piece[i].node);
    }
    uint32_t kept = 0;
    for (uint32_t i = 0; i < scene->fresh_count; i++)
        if (scene->fresh[i] != body)
            scene->fresh[kept++] = scene->fresh[i];
    scene->fresh_count = kept;
    pir_bodies_remove(&scene->bodies, body);
    return PIR_OK;
}

/* --- reading --- */

pir_status pir_scene_pose(const pir_scene *scene, uint32_t body, pir_pose *ret_pose) {
    const pir_status status = pir_scene_given(scene, "pose", ret_pose ? NULL : "ret_pose");
    if (status != PIR_OK)
        return status;
    if (!pir_bodies_has(&scene->bodies, body))
        return pir_fail(scene->report, PIR_ERR_ARGUMENT, "pose: there is no body %u", (unsigned)body);
    *ret_pose = scene->bodies.body[body].pose;
    return PIR_OK;
}

const pir_scene_event *pir_scene_events(const pir_scene *scene, size_t *ret_count) {
    *ret_count = scene->event_count;
    return scene->event_count > 0 ? scene->event : NULL;
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
