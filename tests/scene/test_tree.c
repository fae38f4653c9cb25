/* SPDX-License-Identifier: MIT */
/* The tree of boxes against a list of them: what meets a box, while leaves come and go; boxes of turned points. */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/processor.h"
#include "scene/tree/tree.h"
#include "scene/world/turned_box.h"
#include "support/memory.h"
#include "support/random.h"

#define LEAVES 200

static pir_box random_box(test_random *random, double size) {
    double at[3], half[3];
    pir_box box;
    for (int k = 0; k < 3; k++) {
        at[k] = 8 * test_random_unit(random);
        half[k] = size * fabs(test_random_unit(random));
        // every other box on a grid, where boxes touch
        if (test_random_below(random, 2))
            at[k] = rint(at[k]), half[k] = rint(2 * half[k]) / 2;
        box.low[k] = (float)(at[k] - half[k]);
        box.high[k] = (float)(at[k] + half[k]);
    }
    return box;
}

/* The items of all leaves that meet the box are those of the list, each once. */
static void expect_same_found(const pir_tree *tree, const pir_box at[], const bool used[], const pir_box *box,
                              unsigned long long number) {
    bool seen[LEAVES] = {false};
    for (uint32_t leaf = pir_tree_first(tree, box); leaf != PIR_TREE_NONE; leaf = pir_tree_next(tree, box, leaf)) {
        uint32_t item = pir_tree_item(tree, leaf);
        expect(item < LEAVES && !seen[item], "case %llu: item %u twice", number, item);
        seen[item] = true;
    }
    for (uint32_t i = 0; i < LEAVES; i++)
        expect(seen[i] == (used[i] && pir_box_meets(&at[i], box)), "case %llu: item %u", number, i);
}

static void a_tree_finds_what_a_list_finds(void **state) {
    (void)state;
    for (uint64_t n = 0; n < 20; n++) {
        test_random random = test_random_case("tree", n);
        pir_allocator allocator = pir_allocator_or_default(NULL);
        pir_tree tree = {0};
        pir_box at[LEAVES];
        uint32_t leaf[LEAVES];
        bool used[LEAVES] = {false};
        assert_true(pir_tree_reserve(&tree, &allocator, LEAVES));
        for (int step = 0; step < 600; step++) {
            uint32_t i = test_random_below(&random, LEAVES);
            if (used[i])
                pir_tree_remove(&tree, leaf[i]);
            used[i] = !used[i] || test_random_below(&random, 3) > 0;
            at[i] = random_box(&random, 1);
            if (used[i])
                leaf[i] = pir_tree_insert(&tree, &at[i], i);
            pir_box box = random_box(&random, 3);
            expect_same_found(&tree, at, used, &box, n);
            expect(pir_tree_is_valid(&tree), "case %llu, step %d", (unsigned long long)n, step);
        }
        for (uint32_t i = 0; i < LEAVES; i++)
            if (used[i])
                pir_tree_remove(&tree, leaf[i]);
        assert_int_equal(tree.leaves, 0);
        pir_tree_finish(&tree, &allocator);
    }
}

/* Boxes in a row, put in by rising place: the worst order for a tree without rotations. */
static void a_row_of_boxes_makes_no_chain(void **state) {
    (void)state;
    const uint32_t count = 4096;
    pir_allocator allocator = pir_allocator_or_default(NULL);
    pir_tree tree = {0};
    assert_true(pir_tree_reserve(&tree, &allocator, count));
    for (uint32_t i = 0; i < count; i++) {
        pir_box box = {{(float)i, 0, 0}, {(float)i + 0.5f, 1, 1}};
        pir_tree_insert(&tree, &box, i);
    }
    assert_true(pir_tree_is_valid(&tree));
    uint64_t levels = 0;
    pir_box all = {{-1, -1, -1}, {(float)count, 2, 2}};
    for (uint32_t leaf = pir_tree_first(&tree, &all); leaf != PIR_TREE_NONE; leaf = pir_tree_next(&tree, &all, leaf))
        for (uint32_t n = leaf; n != PIR_TREE_NONE; n = tree.node[n].parent)
            levels++;
    expect(levels < 40ull * count, "%llu levels above %u leaves", (unsigned long long)levels, count);
    pir_tree_finish(&tree, &allocator);
}

static void doubles_are_rounded_outward(void **state) {
    (void)state;
    test_random random = test_random_case("rounding", 0);
    for (int i = 0; i < 100000; i++) {
        double x = i % 8 ? test_random_scaled(&random, -160, 59) : test_random_scaled(&random, -1074, -100);
        expect((double)pir_float_below(x) <= x && (double)pir_float_above(x) >= x, "%a", x);
    }
    assert_true(pir_float_below(0) <= 0 && pir_float_above(0) >= 0);
}

static void memory_that_fails_leaves_the_tree(void **state) {
    (void)state;
    test_memory memory = {.fail_at = 2};
    pir_allocator allocator = test_allocator(&memory);
    pir_tree tree = {0};
    pir_box box = {{0, 0, 0}, {1, 1, 1}};
    assert_int_equal(pir_tree_first(&tree, &box), PIR_TREE_NONE);
    assert_true(pir_tree_reserve(&tree, &allocator, 2));
    pir_tree_insert(&tree, &box, 7);
    assert_false(pir_tree_reserve(&tree, &allocator, 100));
    assert_int_equal(pir_tree_item(&tree, pir_tree_first(&tree, &box)), 7);
    assert_true(pir_tree_reserve(&tree, &allocator, 100));
    assert_true(pir_tree_is_valid(&tree));
    pir_tree_finish(&tree, &allocator);
    assert_int_equal(memory.blocks, 0);
}

/* Every version of the loop gives the bits of the plain one. */
static void boxes_of_turned_points_have_the_same_bits(void **state) {
    (void)state;
    if (!pir_processor_version(1))
        skip();
    for (uint64_t number = 0; number < 400; number++) {
        test_random random = test_random_case("turned points", number);
        pir_vec3 point[40], low[2], high[2];
        uint32_t count = test_random_below(&random, 41);
        pir_mat3 r;
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                r.m[i][k] = number % 4 ? test_random_unit(&random) : (double)test_random_between(&random, -1, 1);
        for (uint32_t i = 0; i < count; i++) {
            point[i].x = test_random_scaled(&random, -40, 60);
            point[i].y = test_random_scaled(&random, -2, 2);
            point[i].z = number % 3 ? test_random_unit(&random) : 0;
        }
        for (unsigned version = 0; pir_processor_version(version); version++) {
            unsigned at = version > 0;
            pir_processor_version(version)->turned_box->find(&r, point, count, &low[at], &high[at]);
            assert_memory_equal(&low[at], &low[0], sizeof low[0]);
            assert_memory_equal(&high[at], &high[0], sizeof high[0]);
        }
        pir_processor_best()->turned_box->find(&r, point, count, &low[1], &high[1]);
        assert_memory_equal(low, low + 1, sizeof low[0]);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tree_finds_what_a_list_finds),
        cmocka_unit_test(a_row_of_boxes_makes_no_chain),
        cmocka_unit_test(doubles_are_rounded_outward),
        cmocka_unit_test(memory_that_fails_leaves_the_tree),
        cmocka_unit_test(boxes_of_turned_points_have_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
