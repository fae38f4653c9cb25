/* SPDX-License-Identifier: MIT */
/* See stages.h. The decomposition and the pair sums are made once more, for their times alone. */
#include "stages.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "solid/pieces/join_pieces.h"
#include "solid/sum/convex.h"
#include "solid/sum/operands.h"

double stages_clock(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void check(pir_status status) {
    if (status == PIR_OK)
        return;
    fprintf(stderr, "bench_solid: %s\n", pir_status_text(status));
    exit(2);
}

static void measure_parts(const pir_solid *const solids[2], stages *ret_stages) {
    pir_allocator allocator;
    pir_solid_options options;
    check(pir_solid_options_take(NULL, NULL, &allocator, &options));
    pir_rotation_integers integers;
    pir_rotation rotation = {.integers = &integers};
    pir_operands operands;
    pir_cells cells[2];
    pir_piece_list pieces[2] = {{0}, {0}};
    pir_convexes convexes[2];
    check(pir_rotation_set(&rotation, (pir_quat){0, 0, 0, 1}));
    check(pir_operands_init(&operands, solids, &rotation, false, &options));
    const double begun = stages_clock();
    for (int k = 0; k < 2; k++) {
        pir_cells_init(&cells[k], &operands.space);
        check(pir_decompose(&operands.body[k], PIR_DECOMPOSE_FACETS, &cells[k], &pieces[k]));
        pir_merge_pieces(&cells[k], &pieces[k]);
        pir_convexes_make(&convexes[k], &cells[k], &pieces[k]);
    }
    const double divided = stages_clock();
    for (uint32_t i = 0; i < convexes[0].count; i++)
        for (uint32_t j = 0; j < convexes[1].count; j++)
            pir_pair_sum_make(&convexes[0], i, &convexes[1], j);
    ret_stages->decompose = divided - begun;
    ret_stages->pairs = stages_clock() - divided;
    check(operands.space.status);
    for (int k = 0; k < 2; k++) {
        pir_convexes_finish(&convexes[k]);
        pir_piece_list_finish(&pieces[k], &operands.space);
        pir_cells_finish(&cells[k]);
    }
    pir_operands_finish(&operands);
}

stages stages_measure(const pir_solid *p, const pir_solid *q) {
    stages made = {0};
    pir_solid_sum *sum;
    pir_mesh *mesh;
    const double begun = stages_clock();
    check(pir_solid_sum_create(p, q, (pir_quat){0, 0, 0, 1}, NULL, &sum));
    check(pir_solid_sum_mesh(sum, PIR_EXACT, &mesh));
    check(pir_solid_sum_describe(sum, &made.info));
    pir_mesh_destroy(mesh);
    pir_solid_sum_destroy(sum);
    made.whole = stages_clock() - begun;
    measure_parts((const pir_solid *const[2]){p, q}, &made);
    return made;
}
