/* SPDX-License-Identifier: MIT */
/*
 * Draws a slice of configuration space: for many translations of a turned box, whether it overlaps a box that stands.
 *
 * `#` overlaps, `o` touches, `.` is free. All translations share one rotation, so one batch answers them. The
 * quaternion (0, 0, 1, 2) is a turn with cosine 3/5 and sine 4/5, and states are exact: no touch is missed or invented.
 */
#include <stdio.h>

#include <pirouette/pirouette.h>

enum { COLUMNS = 33, ROWS = 33 };

static const double SPACING = 0.0625; /* exact in binary, as the translations are */

static void draw(const pir_state *states) {
    for (int row = ROWS - 1; row >= 0; row--) {
        for (int column = 0; column < COLUMNS; column++)
            putchar(".o#"[states[row * COLUMNS + column]]);
        putchar('\n');
    }
}

int main(void) {
    static pir_vec3 translations[ROWS * COLUMNS];
    static pir_state states[ROWS * COLUMNS];
    for (int row = 0; row < ROWS; row++)
        for (int column = 0; column < COLUMNS; column++)
            translations[row * COLUMNS + column] =
                (pir_vec3){SPACING * (column - COLUMNS / 2), SPACING * (row - ROWS / 2), 0.25};

    pir_polytope *p = NULL, *q = NULL;
    pir_sum *difference = NULL;
    pir_query *query = NULL;
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;

    pir_status status = pir_shape_create("box?x=0.625&y=0.625&z=1", NULL, NULL, &p);
    if (status == PIR_OK)
        status = pir_shape_create("box?x=1&y=0.5&z=1", NULL, NULL, &q);
    if (status == PIR_OK)
        status = pir_sum_create(p, q, (pir_quat){0, 0, 1, 2}, &options, &difference);
    if (status == PIR_OK)
        status = pir_query_create(difference, &query);
    if (status == PIR_OK)
        status = pir_query_batch_states(query, translations, ROWS * COLUMNS, states);
    if (status == PIR_OK)
        draw(states);

    if (status != PIR_OK)
        fprintf(stderr, "grid_of_states: %s\n", pir_status_text(status));
    pir_query_destroy(query);
    pir_sum_destroy(difference);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return status == PIR_OK ? 0 : 1;
}
