/* SPDX-License-Identifier: MIT */
/* What pir_scene_is_valid is for: each of its invariants, broken by hand in a scene that holds, is missed. */
#include "support/test.h"

#include <pirouette/shape.h>

#include "scene/world/scene.h"

/* Four cubes in a row that touch, the last of two pieces; one body is static. */
static pir_scene *row_of_cubes(void) {
    pir_polytope *cube = NULL, *pieces[2];
    pir_scene *scene = NULL;
    pir_body_options body = pir_body_options_default();
    uint32_t number;
    assert_int_equal(pir_shape_create("cube", NULL, NULL, &cube), PIR_OK);
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    pieces[0] = pieces[1] = cube;
    body.pieces = pieces;
    for (uint32_t i = 0; i < 4; i++) {
        body.kind = i == 0 ? PIR_BODY_STATIC : PIR_BODY_MOVING;
        body.piece_count = i == 3 ? 2 : 1;
        body.pose.translation.x = 0.5 * i;
        assert_int_equal(pir_scene_add(scene, &body, &number), PIR_OK);
    }
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    pir_polytope_release(cube);
    assert_true(pir_scene_is_valid(scene) && scene->pairs.count > 3);
    return scene;
}

static void expect_missed(pir_scene *scene, uint32_t *number, uint32_t wrong, const char *what) {
    const uint32_t right = *number;
    assert_true(right != wrong);
    *number = wrong;
    expect(!pir_scene_is_valid(scene), "%s", what);
    *number = right;
    expect(pir_scene_is_valid(scene), "%s, put right", what);
}

static void counts_that_are_wrong_are_missed(void **state) {
    (void)state;
    pir_scene *scene = row_of_cubes();
    pir_bodies *bodies = &scene->bodies;
    expect_missed(scene, &bodies->body_count, bodies->body_count + 1, "one body more");
    expect_missed(scene, &bodies->piece_count, bodies->piece_count + 1, "one piece more");
    expect_missed(scene, &scene->pairs.count, scene->pairs.count + 1, "one pair more");
    expect_missed(scene, &scene->pairs.count, scene->pairs.count - 1, "one pair less");
    expect_missed(scene, &scene->tree.leaves, scene->tree.leaves + 1, "one leaf more");
    expect_missed(scene, &bodies->body[3].pieces, 1, "a body with another number of pieces");
    pir_scene_destroy(scene);
}

static void pieces_that_are_wrong_are_missed(void **state) {
    (void)state;
    pir_scene *scene = row_of_cubes();
    pir_bodies *bodies = &scene->bodies;
    const uint32_t first = bodies->body[3].first, second = bodies->piece[first].next;
    expect_missed(scene, &bodies->piece[first].body, 2, "a piece of another body");
    expect_missed(scene, &bodies->piece[second].number, 0, "two pieces of one number");
    expect_missed(scene, &bodies->piece[first].node, bodies->piece[second].node, "the leaf of another piece");
    expect_missed(scene, &bodies->piece[first].next, PIR_PIECE_NONE, "a list of pieces that is cut");
    bodies->body[3].used = false;
    assert_false(pir_scene_is_valid(scene));
    bodies->body[3].used = true;
    bodies->piece[first].tight.high[0] += 10;
    assert_false(pir_scene_is_valid(scene));
    bodies->piece[first].tight.high[0] -= 10;
    assert_true(pir_scene_is_valid(scene));
    pir_scene_destroy(scene);
}

static void lists_of_pairs_that_are_wrong_are_missed(void **state) {
    (void)state;
    pir_scene *scene = row_of_cubes();
    pir_bodies *bodies = &scene->bodies;
    const uint32_t piece = bodies->body[1].first, end = bodies->piece[piece].first;
    pir_scene_pair *pair = &scene->pairs.at[end / 2];
    const uint32_t side = end % 2;
    expect_missed(scene, &pair->piece[side], bodies->body[2].first, "an end of another piece");
    expect_missed(scene, &pair->previous[side], end, "an end that follows itself");
    expect_missed(scene, &pair->next[side], PIR_END_NONE, "a list of pairs that is cut");
    expect_missed(scene, &bodies->piece[piece].first, PIR_END_NONE, "a list of pairs that is empty");
    // both ends changed alike: P and Q exchanged
    const pir_scene_pair right = *pair;
    for (int k = 0; k < 2; k++)
        pair->piece[k] = right.piece[1 - k];
    assert_false(pir_scene_is_valid(scene));
    *pair = right;
    assert_true(pir_scene_is_valid(scene));
    pir_scene_destroy(scene);
}

/* Two cubes apart, whose boxes are made to meet: then they lack their pair, unless one of them is fresh. */
static void a_pair_that_is_not_there_is_missed(void **state) {
    (void)state;
    pir_scene *scene = row_of_cubes();
    pir_polytope *cube = NULL;
    pir_body_options body = pir_body_options_default();
    uint32_t number;
    assert_int_equal(pir_shape_create("cube", NULL, NULL, &cube), PIR_OK);
    body.pieces = &cube;
    body.piece_count = 1;
    body.pose.translation.y = 40;
    assert_int_equal(pir_scene_add(scene, &body, &number), PIR_OK);
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    pir_scene_body *far = &scene->bodies.body[number];
    assert_true(pir_scene_is_valid(scene) && scene->bodies.piece[far->first].first == PIR_END_NONE);
    // every box on the way up grows over all of the others, so the tree itself holds
    pir_tree *tree = &scene->tree;
    const pir_box whole = tree->node[tree->root].box;
    for (uint32_t n = scene->bodies.piece[far->first].node; n != PIR_TREE_NONE; n = tree->node[n].parent)
        tree->node[n].box = whole;
    assert_true(pir_tree_is_valid(tree));
    assert_false(pir_scene_is_valid(scene));
    far->fresh = true;
    assert_true(pir_scene_is_valid(scene));
    far->fresh = false;
    far->mask = 0;
    assert_true(pir_scene_is_valid(scene));
    pir_polytope_release(cube);
    pir_scene_destroy(scene);
}

static void a_tree_that_is_wrong_is_missed(void **state) {
    (void)state;
    pir_scene *scene = row_of_cubes();
    pir_tree *tree = &scene->tree;
    pir_tree_node *root = &tree->node[tree->root];
    expect_missed(scene, &root->parent, root->child[0], "a root with a parent");
    expect_missed(scene, &tree->node[root->child[0]].parent, root->child[1], "a node with another parent");
    const double low = root->box.low[1];
    root->box.low[1] = low - 1;
    assert_false(pir_tree_is_valid(tree));
    root->box.low[1] = low;
    assert_true(pir_tree_is_valid(tree));
    pir_scene_destroy(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_that_are_wrong_are_missed),
        cmocka_unit_test(pieces_that_are_wrong_are_missed),
        cmocka_unit_test(lists_of_pairs_that_are_wrong_are_missed),
        cmocka_unit_test(a_pair_that_is_not_there_is_missed),
        cmocka_unit_test(a_tree_that_is_wrong_is_missed),
    };
    return cmocka_run_group_tests_name("scenes that are not valid", tests, NULL, NULL);
}
