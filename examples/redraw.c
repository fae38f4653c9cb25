/* SPDX-License-Identifier: MIT */
/*
 * Draws a sum that turns without making its mesh anew: a live mesh rewrites the facets that changed.
 *
 * In place of a picture, each line gives the volume that the live facets enclose, and how many of them were
 * rewritten since the start. Two boxes serve, whose sum's volume anyone can work out another way.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <pirouette/pirouette.h>

enum { FRAMES = 60, SHOW_EVERY = 10 };

/* The volume of the pyramids from the origin over all facets, each taken as a fan of triangles. */
static double volume(pir_live_mesh *live, const pir_vec3 *at) {
    double six = 0;
    for (uint32_t slot = 0; slot < pir_live_mesh_facet_slots(live); slot++) {
        uint32_t count;
        const uint32_t *corner = pir_live_mesh_facet(live, slot, &count); /* count is 0 in an empty slot */
        for (uint32_t i = 2; i < count; i++) {
            pir_vec3 a = at[corner[0]], b = at[corner[i - 1]], c = at[corner[i]];
            six += a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
        }
    }
    return six / 6;
}

static pir_status turn(pir_sum *sum, pir_live_mesh *live) {
    pir_vec3 *at = NULL;
    pir_status status = PIR_OK;
    unsigned total = 0;
    for (int frame = 0; status == PIR_OK && frame <= FRAMES; frame++) {
        double half = 0.02 * frame;
        pir_quat rotation = {0.6 * sin(half), 0.64 * sin(half), 0.48 * sin(half), cos(half)};
        status = pir_sum_rotate(sum, rotation, PIR_METHOD_AUTO);
        if (status == PIR_OK)
            status = pir_live_mesh_refresh(live);
        if (status != PIR_OK)
            break;

        /* Coordinates move every frame; a renderer would have them written into its own buffer. */
        void *grown = realloc(at, pir_live_mesh_vertex_slots(live) * sizeof *at);
        if (!grown) {
            status = PIR_ERR_MEMORY;
            break;
        }
        at = grown;
        pir_live_mesh_vertices(live, at);
        uint32_t rewritten;
        pir_live_mesh_rewritten(live, &rewritten);
        total += rewritten;
        if (frame % SHOW_EVERY == 0)
            printf("frame %2d: volume %.12f, %u facet slots, %u rewritten so far\n", frame, volume(live, at),
                   (unsigned)pir_live_mesh_facet_slots(live), total);
    }
    free(at);
    return status;
}

int main(void) {
    pir_polytope *p = NULL, *q = NULL;
    pir_sum *sum = NULL;
    pir_live_mesh *live = NULL;

    pir_status status = pir_shape_create("box?x=1&y=2&z=3", NULL, NULL, &p);
    if (status == PIR_OK)
        status = pir_shape_create("box?x=2&y=1&z=1", NULL, NULL, &q);
    if (status == PIR_OK)
        status = pir_sum_create(p, q, (pir_quat){0, 0, 0, 1}, NULL, &sum);
    if (status == PIR_OK)
        status = pir_live_mesh_create(sum, &live);
    if (status == PIR_OK)
        status = turn(sum, live);

    if (status != PIR_OK)
        fprintf(stderr, "redraw: %s\n", pir_status_text(status));
    pir_live_mesh_destroy(live);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return status == PIR_OK ? 0 : 1;
}
