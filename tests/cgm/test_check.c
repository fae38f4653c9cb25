/* SPDX-License-Identifier: MIT */
/*
 * The check of a map sees damage: any part of it replaced by that of another place is seen, or changes nothing that callers see. So it is
 * for maps of bodies and of sums, of every dimension, tied with the cube's planes or not.
 */
#include "support/test.h"

#include <string.h>

#include "cgm/build.h"
#include "support/bodies.h"

/* What a map is made of, array by array. */
enum { ARRAYS = 12 };

/* Entry `i` of an array, its size in bytes, and how many there are. */
static void *entry(pir_cgm *cgm, int which, uint32_t i, size_t *ret_size, uint32_t *ret_count) {
    uint32_t k = cgm->source_count, v = pir_cgm_vertices(cgm), e = pir_cgm_edges(cgm), f = pir_cgm_faces(cgm);
    const uint32_t counts[ARRAYS] = {2 * e, 2 * e, 2 * e, v, v, v, v, e, f, v * k, e * k, f * k};
    *ret_count = counts[which];
    *ret_size = which == 5 || which == 6 ? sizeof(uint8_t) : sizeof(uint32_t);
    switch (which) {
    case 0:
        return &cgm->half[i].origin;
    case 1:
        return &cgm->half[i].next;
    case 2:
        return &cgm->half[i].face;
    case 3:
        return &cgm->vertex[i].out;
    case 4:
        return &cgm->vertex[i].copy;
    case 5:
        return &cgm->vertex[i].place;
    case 6:
        return &cgm->vertex[i].real;
    case 7:
        return &cgm->edge_line[i];
    case 8:
        return &cgm->face_half[i];
    case 9:
        return &cgm->vertex_facet[i];
    case 10:
        return &cgm->edge_half[i];
    default:
        return &cgm->face_vertex[i];
    }
}

/* Whether the map still stands for the same mesh. */
static bool stands_for(const pir_cgm *cgm, const pir_mesh *mesh) {
    pir_mesh *now = NULL;
    assert_int_equal(pir_cgm_mesh(cgm, PIR_EXACT, &now), PIR_OK);
    bool same = pir_mesh_equal(now, mesh);
    pir_mesh_destroy(now);
    return same;
}

/* Replaces single entries by others of their array; counts those that the check sees and those that it lets pass. */
static void damage(test_random *random, pir_cgm *cgm, const char *what, uint32_t seen[ARRAYS],
                   uint32_t passed[ARRAYS]) {
    pir_mesh *mesh = NULL;
    assert_true(pir_cgm_is_valid(cgm));
    assert_int_equal(pir_cgm_mesh(cgm, PIR_EXACT, &mesh), PIR_OK);
    for (int n = 0; n < 20 * ARRAYS; n++) {
        int which = n % ARRAYS;
        size_t size;
        uint32_t count, before = 0;
        entry(cgm, which, 0, &size, &count);
        uint32_t i = test_random_below(random, count), j = test_random_below(random, count);
        void *to = entry(cgm, which, i, &size, &count), *from = entry(cgm, which, j, &size, &count);
        if (memcmp(to, from, size) == 0)
            continue;
        memcpy(&before, to, size);
        memcpy(to, from, size);
        bool valid = pir_cgm_is_valid(cgm);
        expect(!valid || stands_for(cgm, mesh), "%s: entry %u of array %d, as %u", what, i, which, j);
        valid ? passed[which]++ : seen[which]++;
        memcpy(to, &before, size);
    }
    assert_true(pir_cgm_is_valid(cgm));
    pir_mesh_destroy(mesh);
}

static void damage_is_seen_or_does_none(void **state) {
    (void)state;
    uint32_t seen[ARRAYS] = {0}, passed[ARRAYS] = {0};
    for (uint64_t i = 0; i < 5 * TEST_BODY_COUNT; i++) {
        test_random random = test_random_case("cgm damage", i);
        pir_polytope *p = test_random_polytope(&random, (test_body)(i % TEST_BODY_COUNT), 12);
        pir_polytope *q = test_random_polytope(&random, (test_body)(test_random_below(&random, TEST_BODY_COUNT)), 8);
        pir_quat rotation = i % 2 ? test_integer_rotation(&random) : test_general_rotation(&random);
        pir_cgm *a, *b, *sum;
        assert_int_equal(pir_cgm_create(p, i % 3 ? &rotation : NULL, NULL, &a), PIR_OK);
        assert_int_equal(pir_cgm_create(q, NULL, NULL, &b), PIR_OK);
        assert_int_equal(pir_cgm_overlay(a, b, &sum), PIR_OK);
        damage(&random, a, "a body", seen, passed);
        damage(&random, sum, "a sum", seen, passed);
        pir_cgm_destroy(sum);
        pir_cgm_destroy(b);
        pir_cgm_destroy(a);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    for (int k = 0; k < ARRAYS; k++)
        print_message("# array %d: %u seen, %u let pass\n", k, seen[k], passed[k]);
    // parallel edges give one line, the two hidden halves of a segment one arc, and any halfedge of a vertex or a face will do
    for (int k = 0; k < ARRAYS; k++)
        expect(seen[k] > 100 && (k == 3 || k == 7 || k == 8 || k == 10 || passed[k] == 0), "array %d", k);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(damage_is_seen_or_does_none)};
    return cmocka_run_group_tests_name("cgm check", tests, NULL, NULL);
}
