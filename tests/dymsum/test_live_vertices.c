/* SPDX-License-Identifier: MIT */
/*
 * The vertices of a live mesh, counted pair by pair, and compared with a plain list while they appear, disappear and
 * make the table grow, with memory and without.
 */
#include "support/test.h"

#include <string.h>

#include "dymsum/live/live_vertices.h"
#include "support/memory.h"
#include "support/random.h"

#define PAIRS 300

/* How often each pair is in use, and in which slot. */
struct list {
    uint32_t uses[PAIRS], slot[PAIRS];
};

static void take(pir_live_vertices *v, struct list *list, uint32_t pair) {
    uint32_t slot = pir_live_vertex_take(v, pair * 7, pair * 13 + 5);
    expect(list->uses[pair] == 0 || slot == list->slot[pair], "pair %u moved", pair);
    list->slot[pair] = slot;
    list->uses[pair]++;
}

/* The table says what the list says. */
static void expect_same_list(const pir_live_vertices *v, const struct list *list) {
    uint32_t used = 0;
    for (uint32_t pair = 0; pair < PAIRS; pair++) {
        if (list->uses[pair] == 0)
            continue;
        uint32_t slot = list->slot[pair];
        used++;
        assert_true(slot < v->used && v->used <= v->capacity);
        expect(v->uses[slot] == list->uses[pair] && v->pair[slot][0] == pair * 7 && v->pair[slot][1] == pair * 13 + 5,
               "pair %u in slot %u", pair, slot);
    }
    uint32_t in_use = 0;
    for (uint32_t slot = 0; slot < v->used; slot++)
        in_use += v->uses[slot] > 0;
    assert_int_equal(in_use, used);
}

/* After a sweep each slot is in use or free: none is lost. */
static void expect_none_lost(const pir_live_vertices *v) {
    uint32_t in_use = 0, free_count = 0;
    for (uint32_t slot = 0; slot < v->used; slot++)
        in_use += v->uses[slot] > 0;
    for (uint32_t slot = v->free; slot != PIR_NO_SLOT && free_count <= v->used; slot = v->next_free[slot])
        free_count++;
    expect(in_use + free_count == v->used, "%u in use, %u free of %u", in_use, free_count, v->used);
}

static void vertices_stay_where_they_are_while_others_come_and_go(void **state) {
    (void)state;
    uint64_t failures = 0;
    for (uint64_t i = 0; i < 40; i++) {
        test_random random = test_random_case("live vertices", i);
        test_memory memory = {0};
        pir_allocator allocator = test_allocator(&memory);
        pir_live_vertices v = {0};
        struct list list;
        memset(&list, 0, sizeof list);
        for (uint32_t room = 20; room <= PAIRS; room += 70) {
            // the table cannot grow, wherever memory ends, and stays as it was; then it grows
            uint64_t n = 0;
            do {
                memory.fail_at = memory.requests + ++n;
                if (pir_live_vertices_reserve(&v, &allocator, room))
                    break;
                failures++;
                expect_same_list(&v, &list);
            } while (n < 20);
            memory.fail_at = 0;
            assert_true(pir_live_vertices_reserve(&v, &allocator, room) && v.capacity >= room);
            expect_same_list(&v, &list);
            for (int step = 0; step < 200; step++) {
                uint32_t pair = test_random_below(&random, room);
                if (list.uses[pair] > 0 && test_random_below(&random, 2)) {
                    pir_live_vertex_drop(&v, list.slot[pair]);
                    list.uses[pair]--;
                } else {
                    take(&v, &list, pair);
                }
                // what nothing uses keeps its slot until it is swept
                if (step % 25 == 24) {
                    pir_live_vertices_sweep(&v);
                    expect_none_lost(&v);
                }
                expect_same_list(&v, &list);
            }
        }
        pir_live_vertices_finish(&v, &allocator);
        assert_true(memory.blocks == 0 && !memory.wrong_size);
    }
    assert_true(failures >= 160);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(vertices_stay_where_they_are_while_others_come_and_go)};
    return cmocka_run_group_tests_name("live vertices", tests, NULL, NULL);
}
