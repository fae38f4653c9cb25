/* SPDX-License-Identifier: MIT */
/*
 * The check of a map sees damage: any part of it replaced by that of another place is seen, or changes nothing that
 * callers see. So it is for maps of bodies and of sums, of every dimension, tied with the cube's planes or not.
 */
#include "support/test.h"

#include <string.h>

#include "cgm/build.h"
#include "support/bodies.h"

/* What a map is made of, array by array. */
enum { ARRAYS = 13 };

/* Entry `i` of an array, its size in bytes, and how many there are. */
static void *entry(pir_cgm *cgm, int which, uint32_t i, size_t *ret_size, uint32_t *ret_count) {
    uint32_t k = cgm->source_count, v = pir_cgm_vertices(cgm), e = pir_cgm_edges(cgm), f = pir_cgm_faces(cgm);
    const uint32_t counts[ARRAYS] = {2 * e, 2 * e, 2 * e, v, v, v, v, e, f, v * k, e * k, f * k, 24};
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
    case 11:
        return &cgm->face_vertex[i];
    default:
        return &cgm->corner[i / 4][i % 4];
    }
}

static uint64_t mix(uint64_t hash, uint64_t value) {
    return (hash ^ value) * 0x100000001b3u;
}

/* A hash of what callers see of a map, but for which of its halfedges a vertex or a face names. */
static uint64_t view_of(const pir_cgm *cgm) {
    pir_cgm_counts total = pir_cgm_total_counts(cgm);
    uint64_t hash = 0xcbf29ce484222325u;
    for (uint32_t v = 0; v < total.vertices; v++) {
        pir_cgm_vertex_info info = pir_cgm_vertex_at(cgm, v);
        hash = mix(mix(mix(hash, info.map), (uint64_t)info.place << 1 | (uint64_t)info.real), info.copy);
        for (uint32_t s = 0; s < pir_cgm_source_count(cgm); s++)
            hash = mix(hash, pir_cgm_vertex_facet(cgm, v, s));
    }
    for (uint32_t h = 0; h < total.halfedges; h++) {
        pir_cgm_halfedge_info info = pir_cgm_halfedge_at(cgm, h);
        hash = mix(mix(mix(hash, info.origin), info.next), (uint64_t)info.face << 1 | (uint64_t)info.real);
        for (uint32_t s = 0; s < pir_cgm_source_count(cgm); s++)
            hash = mix(hash, pir_cgm_halfedge_edge(cgm, h, s));
    }
    for (uint32_t f = 0; f < total.faces; f++)
        for (uint32_t s = 0; s < pir_cgm_source_count(cgm); s++)
            hash = mix(hash, pir_cgm_face_vertex(cgm, f, s));
    for (uint32_t i = 0; i < 24; i++)
        hash = mix(hash, pir_cgm_corner(cgm, i / 4, i % 4));
    return hash;
}

/* Whether the map still stands for the same mesh. */
static bool stands_for(const pir_cgm *cgm, const pir_mesh *mesh) {
    pir_mesh *now = NULL;
    assert_int_equal(pir_cgm_mesh(cgm, PIR_EXACT, &now), PIR_OK);
    bool same = pir_mesh_equal(now, mesh);
    pir_mesh_destroy(now);
    return same;
}

/*
 * What might stand in place of entry `i`: what stands elsewhere, before or after it, its own value with the lowest bit
 * turned round, another halfedge of its vertex, or an index of nothing.
 */
static uint32_t other_value(test_random *random, pir_cgm *cgm, int which, uint32_t i) {
    size_t size;
    uint32_t count, value = 0, kind = test_random_below(random, 5);
    const void *from = entry(cgm, which, i, &size, &count);
    memcpy(&value, from, size);
    if (kind == 0)
        return value ^ 1;
    // nothing, or nothing that is there
    if (kind == 4)
        return size == 1 ? 7 : PIR_CGM_NONE - test_random_below(random, 2);
    if (kind == 1 && which == 3)
        return pir_cgm_clockwise(cgm, value);
    uint32_t j = kind == 1 ? (i + 1) % count : kind == 2 ? (i + count - 1) % count : test_random_below(random, count);
    from = entry(cgm, which, j, &size, &count);
    memcpy(&value, from, size);
    return value;
}

/* Replaces single entries; counts those that the check sees and those that it lets pass. */
static void damage(test_random *random, pir_cgm *cgm, const char *what, uint32_t seen[ARRAYS],
                   uint32_t passed[ARRAYS]) {
    pir_mesh *mesh = NULL;
    uint64_t view = view_of(cgm);
    assert_true(pir_cgm_is_valid(cgm));
    assert_int_equal(pir_cgm_mesh(cgm, PIR_EXACT, &mesh), PIR_OK);
    for (int n = 0; n < 20 * ARRAYS; n++) {
        int which = n % ARRAYS;
        size_t size;
        uint32_t count, before = 0;
        entry(cgm, which, 0, &size, &count);
        uint32_t i = test_random_below(random, count), value = other_value(random, cgm, which, i);
        void *to = entry(cgm, which, i, &size, &count);
        memcpy(&before, to, size);
        if (value == before)
            continue;
        memcpy(to, &value, size);
        bool valid = pir_cgm_is_valid(cgm);
        expect(!valid || (view_of(cgm) == view && stands_for(cgm, mesh)), "%s: entry %u of array %d, %u", what, i,
               which, value);
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
        pir_cgm_release(sum);
        pir_cgm_release(b);
        pir_cgm_release(a);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    for (int k = 0; k < ARRAYS; k++)
        print_message("# array %d: %u seen, %u let pass\n", k, seen[k], passed[k]);
    for (int k = 0; k < ARRAYS; k++)
        expect(seen[k] > 100, "array %d", k);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(damage_is_seen_or_does_none)};
    return cmocka_run_group_tests_name("cgm check", tests, NULL, NULL);
}
