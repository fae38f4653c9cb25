/* SPDX-License-Identifier: MIT */
/*
 * Two bodies that both move: a pair by need, which is what most loops want. A box flies by over a plate that spins, and
 * touches it on the way.
 *
 * Nothing is rotated beforehand: each question brings both poses, and the pair remembers what its last answer needed.
 */
#include <math.h>
#include <stdio.h>

#include <pirouette/pirouette.h>

enum { FRAMES = 200, SHOW_EVERY = 10, ROOM = 16 };

static const double step = 1.0 / 60;

/* Farther apart than this is all the same to the loop. Contacts are asked for up to `margin` apart. */
static const double cutoff = 1.25, margin = 0.02;

static void show(int frame, const pir_query_result *answer, size_t contacts) {
    printf("frame %3d: ", frame);
    if (answer->outcome == PIR_BEYOND_CUTOFF)
        printf("farther apart than %g\n", cutoff);
    else
        printf("distance %.9f, normal %.9f %.9f %.9f, %zu contacts\n", answer->distance, answer->normal.x,
               answer->normal.y, answer->normal.z, contacts);
}

static pir_status run(pir_pair *pair, pir_workspace *workspace) {
    pir_pair_input input = pir_pair_input_default();
    input.cutoff = cutoff;
    input.margin = margin;
    for (int frame = 0; frame <= FRAMES; frame++) {
        const double time = frame * step;
        pir_query_result answer;
        pir_contact contacts[ROOM];
        size_t count = 0;
        input.pose_p.rotation = (pir_quat){sin(time / 2), 0, 0, cos(time / 2)};
        input.pose_p.translation = (pir_vec3){3 - 2 * time, 0.25, 0.6};
        input.pose_q.rotation = (pir_quat){0, 0, sin(time), cos(time)};
        pir_status status = pir_pair_signed_distance(pair, workspace, &input, &answer);
        if (status == PIR_OK && answer.outcome != PIR_BEYOND_CUTOFF && answer.distance <= margin)
            status = pir_pair_manifold(pair, workspace, &input, &answer, ROOM, contacts, &count);
        if (status != PIR_OK)
            return status;
        if (frame % SHOW_EVERY == 0)
            show(frame, &answer, count);
    }
    const pir_pair_statistics done = pir_pair_get_statistics(pair);
    printf("of %u answers %u by what had been proven before, %u by the facet of the answer before\n",
           (unsigned)done.queries, (unsigned)done.by_proof, (unsigned)done.by_walk);
    return PIR_OK;
}

int main(void) {
    pir_polytope *box = NULL, *plate = NULL;
    pir_workspace *workspace = NULL; /* scratch, for any number of pairs of one thread */
    pir_pair *pair = NULL;

    pir_status status = pir_shape_create("box?x=1&y=0.6&z=0.4", NULL, NULL, &box);
    if (status == PIR_OK)
        status = pir_shape_create("box?x=2&y=2&z=0.5", NULL, NULL, &plate);
    if (status == PIR_OK)
        status = pir_workspace_create(NULL, &workspace);
    if (status == PIR_OK)
        status = pir_pair_create(box, plate, NULL, &pair);
    if (status == PIR_OK)
        status = run(pair, workspace);

    if (status != PIR_OK)
        fprintf(stderr, "two_bodies: %s\n", pir_status_text(status));
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_polytope_release(plate);
    pir_polytope_release(box);
    return status == PIR_OK ? 0 : 1;
}
