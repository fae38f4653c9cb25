/* SPDX-License-Identifier: MIT */
/*
 * A game loop: a box falls on a table while it tips level, and comes to rest on the contacts that the loop finds.
 *
 * Every frame turns the difference, asks for the signed distance with the witness of the frame before, pushes the box
 * out along the normal where it overlaps, and asks for the contacts.
 */
#include <math.h>
#include <stdio.h>

#include <pirouette/pirouette.h>

enum { FRAMES = 48, LEVEL_AT = 40, SHOW_EVERY = 4, ROOM = 16 };

/* The rotation of a frame: the box tips about (1, 1, 0), from 0.8 radians to none at frame LEVEL_AT. */
static pir_quat rotation_at(int frame) {
    double half = frame < LEVEL_AT ? 0.4 * (LEVEL_AT - frame) / LEVEL_AT : 0;
    return (pir_quat){sin(half), sin(half), 0, sqrt(2) * cos(half)}; /* any length will do */
}

static pir_status run(pir_sum *difference, pir_query *query) {
    const double step = 1.0 / 60, gravity = -9.81;
    pir_query_cache cache = {0};
    pir_query_input input = pir_query_input_default();
    input.margin = 0.01;     /* contacts up to this distance apart */
    input.translation.z = 2; /* where the box stands: its state, with the speed */
    double speed = 0;
    for (int frame = 0; frame <= FRAMES; frame++) {
        pir_query_result answer;
        pir_contact contacts[ROOM];
        size_t count = 0;
        pir_status status = pir_sum_rotate(difference, rotation_at(frame), PIR_METHOD_AUTO);
        if (status == PIR_OK)
            status = pir_query_signed_distance(query, &input, &cache, &answer);
        if (status == PIR_OK && answer.outcome == PIR_OVERLAPPING) {
            /* The normal points from the table to the box, and the distance is minus the depth. */
            input.translation.x -= answer.distance * answer.normal.x;
            input.translation.y -= answer.distance * answer.normal.y;
            input.translation.z -= answer.distance * answer.normal.z;
            speed = 0;
            status = pir_query_signed_distance(query, &input, &cache, &answer);
        }
        if (status == PIR_OK)
            status = pir_query_manifold(query, &input, &answer, ROOM, contacts, &count);
        if (status != PIR_OK)
            return status;
        if (frame % SHOW_EVERY == 0)
            printf("frame %2d: height %.6f, distance %.6f, %u contacts\n", frame, input.translation.z, answer.distance,
                   (unsigned)count);
        speed += gravity * step;
        input.translation.z += speed * step;
    }
    return PIR_OK;
}

int main(void) {
    pir_polytope *box = NULL, *table = NULL;
    pir_sum *difference = NULL;
    pir_query *query = NULL;
    pir_sum_options options = pir_sum_options_default();
    options.difference = true; /* queries are answered from the difference of the two */

    pir_status status = pir_shape_create("box?x=1&y=0.6&z=0.4", NULL, NULL, &box);
    if (status == PIR_OK)
        status = pir_shape_create("box?x=8&y=8&z=1", NULL, NULL, &table);
    if (status == PIR_OK)
        status = pir_sum_create(box, table, rotation_at(0), &options, &difference);
    if (status == PIR_OK)
        status = pir_query_create(difference, &query);
    if (status == PIR_OK)
        status = run(difference, query);

    if (status != PIR_OK)
        fprintf(stderr, "fall_and_rest: %s\n", pir_status_text(status));
    pir_query_destroy(query);
    pir_sum_destroy(difference);
    pir_polytope_release(table);
    pir_polytope_release(box);
    return status == PIR_OK ? 0 : 1;
}
