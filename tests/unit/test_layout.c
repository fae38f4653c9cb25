/* SPDX-License-Identifier: MIT */
/* Tables of arrays: what they make is one block of zeros, which they free, and a failure leaves nothing behind. */
#include "support/test.h"

#include <string.h>

#include "base/layout.h"
#include "support/memory.h"

struct thing {
    double *numbers;
    uint8_t *marks;
    struct thing **links;
    uint32_t count;
};

static pir_layout layout_of(struct thing *thing) {
    return (pir_layout){
        {PIR_ROW(thing->numbers, thing->count + 2), PIR_ROW(thing->marks, thing->count), PIR_ROW(thing->links, 3)}};
}

static void arrays_are_zeroed_and_freed_at_their_sizes(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    for (uint32_t count = 0; count < 9; count++) {
        struct thing thing = {.count = count};
        pir_layout layout = layout_of(&thing);
        assert_true(pir_layout_new(&allocator, &layout));
        assert_int_equal(memory.blocks, 1);
        assert_true((size_t)memory.bytes >= pir_layout_bytes(&layout));
        assert_int_equal((uintptr_t)thing.links % sizeof(void *), 0);
        for (uint32_t i = 0; i < count + 2; i++)
            assert_true(thing.numbers[i] == 0);
        for (uint32_t i = 0; i < count; i++)
            assert_int_equal(thing.marks[i], 0);
        memset(thing.numbers, 1, (count + 2) * sizeof *thing.numbers);
        memset(thing.marks, 1, count);
        for (int i = 0; i < 3; i++)
            assert_null(thing.links[i]);
        // a table that is made again, from the same counts, frees the same arrays
        pir_layout again = layout_of(&thing);
        pir_layout_free(&allocator, &again);
        assert_int_equal(memory.blocks, 0);
        assert_int_equal(memory.bytes, 0);
    }
    assert_false(memory.wrong_size || memory.overrun);
}

static void what_fails_leaves_no_array(void **state) {
    (void)state;
    test_memory memory = {.fail_at = 1};
    pir_allocator allocator = test_allocator(&memory);
    struct thing thing = {.count = 5};
    pir_layout layout = layout_of(&thing);
    assert_false(pir_layout_new(&allocator, &layout));
    assert_true(!thing.numbers && !thing.marks && !thing.links);
    pir_layout_free(&allocator, &layout);
    assert_int_equal(memory.blocks, 0);
    assert_false(memory.wrong_size || memory.overrun);
}

static void pointers_may_change_places(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    double *first = NULL, *second = NULL;
    pir_layout layout = {{PIR_ROW(first, 7)}};
    pir_layout_add(&layout, (pir_layout_row)PIR_ROW(second, 7));
    assert_true(pir_layout_new(&allocator, &layout));
    double *kept = first;
    first = second;
    second = kept;
    pir_layout_free(&allocator, &layout);
    assert_int_equal(memory.blocks, 0);
    assert_false(memory.wrong_size || memory.overrun);
}

static void counts_that_overflow_are_a_failure(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    struct thing thing = {.count = 0};
    pir_layout layout = {{PIR_ROW(thing.numbers, SIZE_MAX / 2), PIR_ROW(thing.marks, 1)}};
    assert_false(pir_layout_new(&allocator, &layout));
    assert_null(thing.numbers);
    assert_null(thing.marks);
    pir_layout_free(&allocator, &layout);
    assert_int_equal(memory.blocks, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arrays_are_zeroed_and_freed_at_their_sizes), cmocka_unit_test(what_fails_leaves_no_array),
        cmocka_unit_test(pointers_may_change_places), cmocka_unit_test(counts_that_overflow_are_a_failure)};
    return cmocka_run_group_tests_name("layout", tests, NULL, NULL);
}
