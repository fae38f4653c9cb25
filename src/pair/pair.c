/* SPDX-License-Identifier: MIT */
/* The life of pairs and workspaces. */
#include "pair/pair.h"

#include <stdlib.h>

#include "base/options.h"
#include "base/processor.h"

/* --- workspaces --- */

pir_status pir_workspace_create(const pir_allocator *allocator, pir_workspace **ret_workspace) {
    if (!ret_workspace)
        return PIR_ERR_ARGUMENT;
    const pir_allocator a = pir_allocator_or_default(allocator);
    pir_workspace *workspace = PIR_ZEROED(&a, pir_workspace, 1);
    if (!workspace)
        return PIR_ERR_MEMORY;
    workspace->allocator = a;
    workspace->head.scratch = pir_scratch_new(&a);
    if (!workspace->head.scratch) {
        PIR_FREE(&a, workspace, 1);
        return PIR_ERR_MEMORY;
    }
    workspace->rotation.integers = &workspace->integers[0];
    workspace->rotation_q.integers = &workspace->integers[1];
    workspace->exact.frame = &workspace->frame;
    workspace->exact.rotation = &workspace->rotation;
    workspace->world.rotation_q = &workspace->rotation_q;
    workspace->room.loops = pir_processor_best()->surface;
    workspace->axes = pir_processor_best()->axes;
    workspace->walker = pir_processor_best()->walker;
    workspace->relative = pir_processor_best()->relative;
    *ret_workspace = workspace;
    return PIR_OK;
}

void pir_workspace_destroy(pir_workspace *workspace) {
    if (!workspace)
        return;
    const pir_allocator a = workspace->allocator;
    pir_exact_finish(&workspace->exact, &a);
    pir_patch_room_finish(&workspace->patches, &a);
    pir_query_destroy(workspace->query);
    pir_sum_destroy(workspace->sum);
    pir_scratch_release(workspace->head.scratch);
    PIR_FREE(&a, workspace, 1);
}

/* --- pairs --- */

/* Finds the axes of both bodies, where both have few. */
static pir_status find_axes(pir_polytope *p, pir_polytope *q, pir_pair *pair) {
    pir_status status = pir_axes_find(p, pair->exponent, &pair->body_p->body, &pair->axes_p);
    if (status == PIR_OK && pair->axes_p)
        status = pir_axes_find(q, pair->exponent, &pair->body_q->body, &pair->axes_q);
    pair->axes_p = pair->axes_q ? pair->axes_p : NULL;
    return status;
}

/* Finds the bodies of a pair, with the tables that it reads. */
static pir_status find_bodies(pir_polytope *p, pir_polytope *q, pir_pair *pair) {
    pir_polytope *reflected;
    int of_p, of_q;
    pir_status status = pir_polytope_reflect(p, &reflected);
    if (status != PIR_OK)
        return status;
    // p holds it
    pir_polytope_release(reflected);
    status = pir_kept_exponent(reflected, &of_p);
    if (status == PIR_OK)
        status = pir_kept_exponent(q, &of_q);
    if (status != PIR_OK)
        return status;
    pair->exponent = pir_frame_exponent(of_p, of_q, reflected, q);
    pair->down = abs(pair->exponent) < 1000 ? ldexp(1, -pair->exponent) : 0;
    pair->limbs = pir_exact_limbs(reflected, q);
    status = pir_kept_body_of(reflected, pair->exponent, &pair->body_p);
    if (status == PIR_OK)
        status = pir_kept_body_of(q, pair->exponent, &pair->body_q);
    return status == PIR_OK ? find_axes(reflected, q, pair) : status;
}

static bool are_levels(pir_level least, pir_level most) {
    return least >= PIR_LEVEL_NONE && most >= PIR_LEVEL_APART && most <= PIR_LEVEL_WHOLE && least <= most;
}

static uint8_t levels_between(pir_level least, pir_level most) {
    return (uint8_t)((1u << (most + 1)) - (1u << least));
}

pir_status pir_pair_create(pir_polytope *p, pir_polytope *q, const pir_pair_options *options, pir_pair **ret_pair) {
    if (!p || !q || !ret_pair)
        return PIR_ERR_ARGUMENT;
    pir_pair_options used = pir_pair_options_default();
    pir_status status = pir_options_take("pir_pair_options", options, &used, NULL);
    if (status != PIR_OK)
        return status;
    if (!are_levels(used.least, used.most))
        return PIR_ERR_ARGUMENT;
    const pir_allocator a = pir_allocator_or_default(used.allocator);
    pir_pair *pair = PIR_ZEROED(&a, pir_pair, 1);
    if (!pair)
        return PIR_ERR_MEMORY;
    pair->allocator = a;
    pair->levels = levels_between(used.least, used.most);
    status = find_bodies(p, q, pair);
    if (status != PIR_OK) {
        PIR_FREE(&a, pair, 1);
        return status;
    }
    pair->p = pir_polytope_retain(p);
    pair->q = pir_polytope_retain(q);
    *ret_pair = pair;
    return PIR_OK;
}

void pir_pair_destroy(pir_pair *pair) {
    if (!pair)
        return;
    const pir_allocator a = pair->allocator;
    PIR_FREE(&a, pair->surface, 1);
    pir_polytope_release(pair->p);
    pir_polytope_release(pair->q);
    PIR_FREE(&a, pair, 1);
}

pir_status pir_pair_reset(pir_pair *pair, pir_polytope *p, pir_polytope *q) {
    if (!pair || !p || !q)
        return PIR_ERR_ARGUMENT;
    pir_pair fresh = {.allocator = pair->allocator, .levels = pair->levels, .surface = pair->surface};
    pir_status status = find_bodies(p, q, &fresh);
    if (status != PIR_OK)
        return status;
    fresh.p = pir_polytope_retain(p);
    fresh.q = pir_polytope_retain(q);
    pir_polytope_release(pair->p);
    pir_polytope_release(pair->q);
    if (fresh.surface)
        fresh.surface->count = 0;
    *pair = fresh;
    return PIR_OK;
}

/* --- reading --- */

pir_level pir_pair_level(const pir_pair *pair) {
    return (pir_level)pair->level;
}

pir_pair_statistics pir_pair_get_statistics(const pir_pair *pair) {
    return pair->statistics;
}
