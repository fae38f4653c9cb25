/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as records of slices: they are refused, or give cells and crossings that are features and lead from cell to
 * cell. The first two bytes choose the bodies; then each record stands behind its length, two bytes, the lower first.
 */
#include <stdint.h>

#include <pirouette/pirouette.h>

#include "cspace/record/replay.h"
#include "fuzz/input.h"
#include "support/memory.h"

#define SIZE_LIMIT 65536

static const char *const shapes[] = {"cube", "tetrahedron", "icosahedron", "hp", "gs1", "dodecahedron"};
#define SHAPES (sizeof shapes / sizeof *shapes)

static pir_polytope *body_of(uint8_t choice, const pir_allocator *allocator) {
    pir_polytope *body = NULL;
    fuzz_require(pir_shape_create(shapes[choice % SHAPES], allocator, NULL, &body) == PIR_OK, "a shape is made");
    return body;
}

/* What has been taken is a pairing in form. */
static void check_replay(pir_record_replay *replay) {
    const pir_record_replay_crossing *crossing;
    uint32_t count;
    for (uint32_t f = 0; f < replay->p->facet_count; f++)
        fuzz_require(replay->fv[f] < replay->q->vertex_count, "a cell of Q is a vertex");
    for (uint32_t g = 0; g < replay->q->facet_count; g++)
        fuzz_require(replay->vf[g] < replay->p->vertex_count, "a cell of P is a vertex");
    if (pir_record_replay_crossings(replay, &crossing, &count) != PIR_OK)
        return;
    uint32_t at = 0;
    for (uint32_t e = 0; e < replay->p->edge_count; e++) {
        uint32_t half = replay->p->edge_half[e], cell = replay->fv[replay->p->left[half]];
        for (; at < count && crossing[at].edge == e; at++) {
            fuzz_require(replay->q->origin[crossing[at].half] == cell, "a crossing leaves the cell that was reached");
            cell = replay->q->target[crossing[at].half];
        }
        fuzz_require(cell == replay->fv[pir_right(replay->p, half)], "a way leads to the last cell");
    }
    fuzz_require(at == count, "crossings are by rising edge");
}

static void apply(pir_record_replay *replay, const uint8_t *data, size_t size) {
    while (size >= 2) {
        size_t length = data[0] | (size_t)data[1] << 8;
        data += 2;
        size -= 2;
        length = length < size ? length : size;
        pir_status status = pir_record_replay_record(replay, data, length);
        fuzz_require(status == PIR_OK || status == PIR_ERR_FORMAT, "a record is taken or refused for what it is");
        if (status == PIR_OK)
            check_replay(replay);
        data += length;
        size -= length;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size < 2 || size > SIZE_LIMIT)
        return 0;
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_polytope *p = body_of(data[0], &allocator), *q = body_of(data[1], &allocator);
    pir_record_replay replay;
    fuzz_require(pir_record_replay_init(&replay, p, q, &allocator), "there is memory");
    apply(&replay, data + 2, size - 2);
    pir_record_replay_finish(&replay);
    pir_polytope_release(p);
    pir_polytope_release(q);
    fuzz_require(memory.blocks == 0 && !memory.wrong_size, "nothing is left behind");
    return 0;
}
