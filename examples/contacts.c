/* SPDX-License-Identifier: MIT */
/*
 * Lowers a cube onto a table while it turns level, and prints where they touch in each frame.
 *
 * A solver would put an impulse at each contact; the ids tell it which contact of the frame before is the same.
 */
#include <math.h>
#include <stdio.h>

#include <pirouette/pirouette.h>

enum { FRAMES = 8, ROOM = 16 };

static void print_contacts(int frame, const pir_query_result *answer, const pir_contact *contacts, size_t count) {
    printf("frame %d: distance %+.4f, %u contacts\n", frame, answer->distance, (unsigned)count);
    for (size_t i = 0; i < count && i < ROOM; i++) /* `count` is that of all there are */
        printf("  %016llx at (%+.3f, %+.3f, %+.3f), %+.4f apart\n", (unsigned long long)contacts[i].id,
               contacts[i].point_q.x, contacts[i].point_q.y, contacts[i].point_q.z, contacts[i].distance);
}

static pir_status lower(pir_sum *difference, pir_query *query) {
    pir_query_cache cache = {0};
    pir_query_input input = pir_query_input_default();
    input.margin = input.cutoff = 0.05; /* contacts are asked for before the bodies meet; farther away, nothing */
    for (int frame = 0; frame < FRAMES; frame++) {
        double half = 0.02 * (1 - frame / (FRAMES - 1.0)); /* half the angle by which the cube is tilted */
        input.translation.z = 0.62 - 0.02 * frame;
        pir_query_result answer;
        pir_contact contacts[ROOM];
        size_t count = 0;
        pir_status status = pir_sum_rotate(difference, (pir_quat){sin(half), 0, 0, cos(half)}, PIR_METHOD_AUTO);
        if (status == PIR_OK)
            status = pir_query_signed_distance(query, &input, &cache, &answer);
        if (status == PIR_OK)
            status = pir_query_manifold(query, &input, &answer, ROOM, contacts, &count);
        if (status != PIR_OK)
            return status;
        print_contacts(frame, &answer, contacts, count);
    }
    return PIR_OK;
}

int main(void) {
    pir_polytope *cube = NULL, *table = NULL;
    pir_sum *difference = NULL;
    pir_query *query = NULL;
    pir_sum_options options = pir_sum_options_default();
    options.difference = true; /* queries are answered from the difference of the two */

    pir_status status = pir_shape_create("cube", NULL, NULL, &cube);
    if (status == PIR_OK)
        status = pir_shape_create("box?x=4&y=4&z=0.1", NULL, NULL, &table);
    if (status == PIR_OK)
        status = pir_sum_create(cube, table, (pir_quat){0, 0, 0, 1}, &options, &difference);
    if (status == PIR_OK)
        status = pir_query_create(difference, &query);
    if (status == PIR_OK)
        status = lower(difference, query);

    if (status != PIR_OK)
        fprintf(stderr, "contacts: %s\n", pir_status_text(status));
    pir_query_destroy(query);
    pir_sum_destroy(difference);
    pir_polytope_release(table);
    pir_polytope_release(cube);
    return status == PIR_OK ? 0 : 1;
}
