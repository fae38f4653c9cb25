/* SPDX-License-Identifier: MIT */
/* Live meshes: after every refresh what they hold is the sum's pairing and its mesh, and their lists of
   changes are the difference. */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/baseline.h>
#include <pirouette/live_mesh.h>

#include "support/bodies.h"
#include "support/memory.h"
#include "support/meshes.h"

#define PAIRS_MAX 4096

struct pairs {
    uint32_t count;
    pir_sum_pair at[PAIRS_MAX];
};

static int compare(const void *a, const void *b) {
    const pir_sum_pair *x = a, *y = b;
    if (x->kind != y->kind)
        return x->kind < y->kind ? -1 : 1;
    if (x->p != y->p)
        return x->p < y->p ? -1 : 1;
    return (x->q > y->q) - (x->q < y->q);
}

static void add(struct pairs *pairs, pir_facet_kind kind, uint32_t p, uint32_t q) {
    assert_true(pairs->count < PAIRS_MAX);
    pairs->at[pairs->count++] = (pir_sum_pair){kind, p, q};
}

/* The pairing by public calls, sorted. */
static void list_pairing(const pir_sum *sum, struct pairs *pairs) {
    pairs->count = 0;
    for (uint32_t f = 0; f < pir_polytope_facet_count(pir_sum_p(sum)); f++)
        add(pairs, PIR_FACET_FV, f, pir_sum_fv(sum)[f]);
    for (uint32_t g = 0; g < pir_polytope_facet_count(pir_sum_q(sum)); g++)
        add(pairs, PIR_FACET_VF, pir_sum_vf(sum)[g], g);
    static uint32_t ee[PAIRS_MAX][2];
    assert_true(pir_sum_ee_count(sum) <= PAIRS_MAX);
    pir_sum_ee(sum, ee);
    for (uint32_t i = 0; i < pir_sum_ee_count(sum); i++)
        add(pairs, PIR_FACET_EE, ee[i][0], ee[i][1]);
    qsort(pairs->at, pairs->count, sizeof *pairs->at, compare);
}

static void list_live(const pir_live_mesh *live, struct pairs *pairs) {
    pairs->count = 0;
    for (uint32_t slot = 0; slot < pir_live_mesh_facet_slots(live); slot++) {
        pir_sum_pair pair;
        if (pir_live_mesh_pair(live, slot, &pair))
            add(pairs, pair.kind, pair.p, pair.q);
    }
    qsort(pairs->at, pairs->count, sizeof *pairs->at, compare);
}

static bool same_pairs(const struct pairs *a, const struct pairs *b) {
    if (a->count != b->count)
        return false;
    for (uint32_t i = 0; i < a->count; i++)
        if (compare(&a->at[i], &b->at[i]) != 0)
            return false;
    return true;
}

/* Of sorted pairs, each once: the pair of two segments has two facets. */
static const struct pairs *each_once(const struct pairs *pairs, struct pairs *ret_once) {
    ret_once->count = 0;
    for (uint32_t i = 0; i < pairs->count; i++)
        if (i == 0 || compare(&pairs->at[i - 1], &pairs->at[i]) != 0)
            ret_once->at[ret_once->count++] = pairs->at[i];
    return ret_once;
}

/* That before, less what disappeared, with what appeared, is now; and that nothing did both. */
static void expect_changes(const pir_live_mesh *live, const struct pairs *pairs_before, const struct pairs *pairs_now) {
    static struct pairs once_before, once_now;
    const struct pairs *before = each_once(pairs_before, &once_before), *now = each_once(pairs_now, &once_now);
    uint32_t came, went, i = 0, j = 0;
    const pir_sum_pair *appeared = pir_live_mesh_appeared(live, &came),
                       *disappeared = pir_live_mesh_disappeared(live, &went);
    static struct pairs made;
    made.count = 0;
    for (uint32_t k = 0; k < before->count; k++) {
        if (j < went && compare(&before->at[k], &disappeared[j]) == 0)
            j++;
        else
            add(&made, before->at[k].kind, before->at[k].p, before->at[k].q);
    }
    assert_int_equal(j, went);
    for (; i < came; i++)
        add(&made, appeared[i].kind, appeared[i].p, appeared[i].q);
    qsort(made.at, made.count, sizeof *made.at, compare);
    expect(same_pairs(&made, now), "made %u now %u before %u came %u went %u", made.count, now->count, before->count,
           came, went);
    for (i = j = 0; i < came && j < went;) {
        int order = compare(&appeared[i], &disappeared[j]);
        assert_int_not_equal(order, 0);
        i += order < 0;
        j += order > 0;
    }
}

/* That vertices have the coordinates that their pairs give in the mesh of the sum; returns how many of
   the mesh's were found. */
static uint32_t count_vertices_of(pir_live_mesh *live, const pir_mesh *mesh) {
    static pir_vec3 vertices[4 * PAIRS_MAX];
    static float floats[4 * PAIRS_MAX][3];
    uint32_t slots = pir_live_mesh_vertex_slots(live), found = 0;
    assert_true(slots <= 4 * PAIRS_MAX);
    pir_live_mesh_vertices(live, vertices);
    pir_live_mesh_vertices_float(live, floats);
    for (uint32_t i = 0; i < slots; i++) {
        uint32_t pair[2], other[2];
        if (!pir_live_mesh_vertex_pair(live, i, pair))
            continue;
        assert_true(floats[i][0] == (float)vertices[i].x && floats[i][2] == (float)vertices[i].z);
        for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh); v++) {
            pir_mesh_pair(mesh, v, other);
            if (pair[0] != other[0] || pair[1] != other[1])
                continue;
            found++;
            assert_memory_equal(&vertices[i], &pir_mesh_vertices(mesh)[v], sizeof *vertices);
        }
    }
    return found;
}

static bool is_merged(const pir_mesh *mesh) {
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++)
        if (pir_mesh_facet_kind(mesh, f) == PIR_FACET_MERGED)
            return true;
    return false;
}

/* Euler's formula, each side of a facet met once the other way, and corners on their planes with the sum below. */
static void expect_closed(pir_live_mesh *live, double size) {
    static uint32_t sides[8 * PAIRS_MAX][2];
    static pir_plane_equation planes[2 * PAIRS_MAX];
    static pir_vec3 vertices[4 * PAIRS_MAX];
    uint32_t count = 0, facets = 0, used = 0, corners, pair[2];
    assert_true(pir_live_mesh_facet_slots(live) <= 2 * PAIRS_MAX);
    pir_live_mesh_planes(live, planes);
    pir_live_mesh_vertices(live, vertices);
    for (uint32_t slot = 0; slot < pir_live_mesh_facet_slots(live); slot++) {
        const uint32_t *corner = pir_live_mesh_facet(live, slot, &corners);
        facets += corners > 0;
        for (uint32_t i = 0; i < corners; i++, count++) {
            assert_true(count < 8 * PAIRS_MAX);
            sides[count][0] = corner[i];
            sides[count][1] = corner[(i + 1) % corners];
            assert_true(pir_live_mesh_vertex_pair(live, corner[i], pair));
            pir_vec3 n = planes[slot].normal, x = vertices[corner[i]];
            assert_true(fabs(n.x * x.x + n.y * x.y + n.z * x.z - planes[slot].offset) <= 1e-6 * size);
        }
    }
    for (uint32_t i = 0; i < pir_live_mesh_vertex_slots(live); i++)
        used += (uint32_t)pir_live_mesh_vertex_pair(live, i, pair);
    assert_int_equal(used + facets, count / 2 + 2);
    for (uint32_t i = 0; i < count && count < 1200; i++) {
        uint32_t met = 0;
        for (uint32_t j = 0; j < count; j++)
            met += sides[j][0] == sides[i][1] && sides[j][1] == sides[i][0];
        assert_int_equal(met, 1);
    }
}

static void live_mesh_is_the_sum_after_every_rotation(void **state) {
    (void)state;
    static struct pairs before, now, held;
    uint32_t plain = 0, merged = 0;
    for (uint64_t i = 0; i < 150; i++) {
        test_random random = test_random_case("live mesh", i);
        test_pose pose;
        test_random_pose(&random, 14, &pose);
        pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
        pir_sum *sum;
        pir_live_mesh *live;
        assert_int_equal(pir_sum_create(p, q, pose.rotation, NULL, &sum), PIR_OK);
        assert_int_equal(pir_live_mesh_create(sum, &live), PIR_OK);
        before.count = 0;
        for (int step = 0; step < 12; step++) {
            list_pairing(sum, &now);
            list_live(live, &held);
            expect(same_pairs(&now, &held), "case %d, %s, step %d", (int)i, pose.situation, step);
            expect_changes(live, &before, &now);
            before = now;
            pir_mesh *mesh;
            assert_int_equal(pir_sum_mesh(sum, PIR_DOUBLE, &mesh), PIR_OK);
            // every vertex of the true sum is one of the live mesh's; where nothing merges there are no others
            uint32_t found = count_vertices_of(live, mesh);
            expect(found == pir_mesh_vertex_count(mesh) || now.count == 0, "case %d, %s, step %d", (int)i,
                   pose.situation, step);
            bool three = pir_polytope_dimension(p) == 3 && pir_polytope_dimension(q) == 3;
            if (three && !is_merged(mesh) && now.count == pir_mesh_facet_count(mesh)) {
                plain++;
                uint32_t used = 0, pair[2];
                for (uint32_t v = 0; v < pir_live_mesh_vertex_slots(live); v++)
                    used += (uint32_t)pir_live_mesh_vertex_pair(live, v, pair);
                expect(used == found, "case %d, %s, step %d", (int)i, pose.situation, step);
            } else {
                merged++;
            }
            pir_mesh_destroy(mesh);
            pir_quat next = step % 3 ? test_general_rotation(&random) : test_rotation(&random);
            assert_int_equal(pir_sum_rotate(sum, next, step % 4 ? PIR_METHOD_UPDATE : PIR_METHOD_WALK), PIR_OK);
            assert_int_equal(pir_live_mesh_refresh(live), PIR_OK);
        }
        pir_live_mesh_destroy(live);
        pir_sum_destroy(sum);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    print_message("%u plain, %u with ties\n", plain, merged);
    assert_true(plain > 100 && merged > 100);
}

/* A region of the live mesh lets in and out facets of a pair that stays. */
static void region_of_a_live_mesh_tells_each_change_once(void **state) {
    (void)state;
    static struct pairs before, held;
    static const test_body bodies[] = {TEST_SEGMENT, TEST_SEGMENT, TEST_POLYGON, TEST_POINT, TEST_BOX, TEST_PRISM};
    uint32_t of_segments = 0;
    for (uint64_t i = 0; i < 600; i++) {
        test_random random = test_random_case("live regions", i);
        pir_polytope *p = test_random_polytope(&random, bodies[i % 2 ? 0 : test_random_below(&random, 6)], 8),
                     *q = test_random_polytope(&random, bodies[i % 2 ? 0 : test_random_below(&random, 6)], 8);
        pir_sum *sum;
        pir_live_mesh *live;
        assert_int_equal(pir_sum_create(p, q, test_rotation(&random), NULL, &sum), PIR_OK);
        assert_int_equal(pir_live_mesh_create(sum, &live), PIR_OK);
        list_live(live, &held);
        for (int frame = 0; frame < 20; frame++) {
            before = held;
            if (frame % 7 == 6)
                pir_live_mesh_clear_region(live);
            else
                assert_int_equal(pir_live_mesh_set_region(live, test_random_direction(&random), frame % 5 * 0.5),
                                 PIR_OK);
            if (frame % 2)
                assert_int_equal(pir_sum_rotate(sum, test_rotation(&random), PIR_METHOD_UPDATE), PIR_OK);
            assert_int_equal(pir_live_mesh_refresh(live), PIR_OK);
            list_live(live, &held);
            expect_changes(live, &before, &held);
            bool segments = pir_polytope_dimension(p) == 1 && pir_polytope_dimension(q) == 1;
            of_segments += segments && before.count + held.count == 3;
        }
        pir_live_mesh_destroy(live);
        pir_sum_destroy(sum);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    assert_true(of_segments > 200);
}

/* Slot for slot the same, and the same lists of what changed. */
static bool same_slots(const pir_live_mesh *a, const pir_live_mesh *b) {
    uint32_t slots = pir_live_mesh_facet_slots(a), vertices = pir_live_mesh_vertex_slots(a), m, n;
    if (slots != pir_live_mesh_facet_slots(b) || vertices != pir_live_mesh_vertex_slots(b))
        return false;
    for (uint32_t i = 0; i < slots; i++) {
        const uint32_t *x = pir_live_mesh_facet(a, i, &m), *y = pir_live_mesh_facet(b, i, &n);
        pir_sum_pair s = {0}, t = {0};
        if (m != n || (m > 0 && memcmp(x, y, m * sizeof *x) != 0) ||
            pir_live_mesh_pair(a, i, &s) != pir_live_mesh_pair(b, i, &t) || compare(&s, &t) != 0)
            return false;
    }
    for (uint32_t i = 0; i < vertices; i++) {
        uint32_t s[2] = {0, 0}, t[2] = {0, 0};
        if (pir_live_mesh_vertex_pair(a, i, s) != pir_live_mesh_vertex_pair(b, i, t) || s[0] != t[0] || s[1] != t[1])
            return false;
    }
    const uint32_t *x = pir_live_mesh_rewritten(a, &m), *y = pir_live_mesh_rewritten(b, &n);
    if (m != n || memcmp(x, y, m * sizeof *x) != 0)
        return false;
    const pir_sum_pair *(*const lists[2])(const pir_live_mesh *, uint32_t *) = {pir_live_mesh_appeared,
                                                                                pir_live_mesh_disappeared};
    for (int k = 0; k < 2; k++) {
        const pir_sum_pair *s = lists[k](a, &m), *t = lists[k](b, &n);
        if (m != n)
            return false;
        for (uint32_t i = 0; i < n; i++)
            if (compare(&s[i], &t[i]) != 0)
                return false;
    }
    return true;
}

/* One mesh that follows the journal, one that compares all, and one that is refreshed seldom. */
static void what_is_noted_is_what_changed(void **state) {
    (void)state;
    static struct pairs held, late;
    uint64_t few = 0;
    for (uint64_t i = 0; i < 150; i++) {
        test_random random = test_random_case("live journal", i);
        test_pose pose;
        test_random_pose(&random, i % 3 ? 14 : 120, &pose);
        pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
        pir_sum *sum;
        pir_live_mesh *noted, *compared, *seldom;
        assert_int_equal(pir_sum_create(p, q, pose.rotation, NULL, &sum), PIR_OK);
        assert_int_equal(pir_live_mesh_create(sum, &noted), PIR_OK);
        assert_int_equal(pir_live_mesh_create(sum, &compared), PIR_OK);
        assert_int_equal(pir_live_mesh_create(sum, &seldom), PIR_OK);
        pir_quat there = test_general_rotation(&random), step = {0.01, 0.02, -0.01, 1};
        for (int frame = 0; frame < 60; frame++) {
            uint32_t what = (uint32_t)test_random_below(&random, 32);
            pir_vec3 axis = test_random_direction(&random);
            if (what < 12) // and back
                step = (pir_quat){-step.x, -step.y, -step.z, 1};
            else if (what < 18)
                step = (pir_quat){0.003 * axis.x, 0.003 * axis.y, 0.003 * axis.z, 1};
            else if (what == 18)
                there = test_general_rotation(&random);
            if (what == 19 || what == 20)
                assert_int_equal(pir_sum_set_region(sum, axis, what == 19 ? 0.6 : 4), PIR_OK);
            there = test_compose(step, there, 1);
            static const pir_method methods[] = {PIR_METHOD_WALK, PIR_METHOD_CGM, PIR_METHOD_AUTO};
            assert_int_equal(pir_sum_rotate(sum, there, what < 29 ? PIR_METHOD_UPDATE : methods[what - 29]), PIR_OK);
            if (what == 21)
                assert_int_equal(pir_sum_rotate_brute_force(sum, there), PIR_OK);
            assert_int_equal(pir_live_mesh_refresh(noted), PIR_OK);
            assert_int_equal(pir_live_mesh_set_region(compared, axis, 4), PIR_OK);
            assert_int_equal(pir_live_mesh_refresh(compared), PIR_OK);
            expect(same_slots(noted, compared), "case %d, %s, frame %d", (int)i, pose.situation, frame);
            uint32_t count;
            pir_live_mesh_rewritten(noted, &count);
            few += count > 0 && count < 20;
            if (test_random_below(&random, 8) > 0)
                continue;
            assert_int_equal(pir_live_mesh_refresh(seldom), PIR_OK);
            list_live(seldom, &late);
            list_live(noted, &held);
            expect(same_pairs(&late, &held), "case %d, %s, frame %d, late", (int)i, pose.situation, frame);
        }
        pir_live_mesh_destroy(seldom);
        pir_live_mesh_destroy(compared);
        pir_live_mesh_destroy(noted);
        pir_sum_destroy(sum);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    assert_true(few > 1000);
}

static void small_turns_rewrite_little_and_allocate_nothing(void **state) {
    (void)state;
    static struct pairs now, held;
    test_random random = test_random_case("live spin", 0);
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_sum_options options = {.size = sizeof options, .allocator = &allocator, .difference = false};
    pir_polytope *p = test_sphere(&random, 90), *q = test_sphere(&random, 70);
    pir_sum *sum;
    pir_live_mesh *live;
    pir_quat there = test_general_rotation(&random);
    assert_int_equal(pir_sum_create(p, q, there, &options, &sum), PIR_OK);
    assert_int_equal(pir_live_mesh_create(sum, &live), PIR_OK);
    uint64_t requests = memory.requests, rewritten = 0, slots = 0;
    for (int i = 0; i < 2000; i++) {
        pir_vec3 axis = {0.36, 0.48, 0.8};
        there = test_compose((pir_quat){1e-3 * axis.x, 1e-3 * axis.y, 1e-3 * axis.z, 1}, there, 1);
        assert_int_equal(pir_sum_rotate(sum, there, PIR_METHOD_UPDATE), PIR_OK);
        assert_int_equal(pir_live_mesh_refresh(live), PIR_OK);
        uint32_t count;
        const uint32_t *slot = pir_live_mesh_rewritten(live, &count);
        for (uint32_t k = 0; k + 1 < count; k++)
            assert_true(slot[k] < slot[k + 1]);
        rewritten += count;
        slots += pir_live_mesh_facet_slots(live);
        if (i % 50 == 0) {
            list_pairing(sum, &now);
            list_live(live, &held);
            assert_true(same_pairs(&now, &held));
            expect_closed(live, 2);
        }
    }
    assert_int_equal(memory.requests, requests);
    print_message("%.2f of %.0f slots a frame rewritten\n", (double)rewritten / 2000, (double)slots / 2000);
    assert_true(rewritten > 2000 && rewritten < slots / 20);
    // a rebuild at the same rotation moves crossings to other slots, but no pair appears or disappears
    assert_int_equal(pir_sum_rotate(sum, there, PIR_METHOD_WALK), PIR_OK);
    assert_int_equal(pir_live_mesh_refresh(live), PIR_OK);
    uint32_t came, went;
    pir_live_mesh_appeared(live, &came);
    pir_live_mesh_disappeared(live, &went);
    assert_true(came == 0 && went == 0);
    expect_closed(live, 2);
    pir_live_mesh_destroy(live);
    pir_sum_destroy(sum);
    assert_int_equal(memory.blocks, 0);
    assert_false(memory.wrong_size);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void region_holds_the_facets_that_face_its_way(void **state) {
    (void)state;
    static pir_plane_equation planes[2 * PAIRS_MAX];
    static struct pairs before, held;
    test_random random = test_random_case("live region", 0);
    pir_polytope *p = test_sphere(&random, 60), *q = test_sphere(&random, 50);
    pir_sum *sum;
    pir_live_mesh *all, *part;
    pir_quat there = test_general_rotation(&random);
    assert_int_equal(pir_sum_create(p, q, there, NULL, &sum), PIR_OK);
    assert_int_equal(pir_live_mesh_create(sum, &all), PIR_OK);
    assert_int_equal(pir_live_mesh_create(sum, &part), PIR_OK);
    list_live(part, &before);
    for (int i = 0; i < 200; i++) {
        pir_vec3 axis = test_random_direction(&random);
        double half_angle = 0.1 + 3 * fabs(test_random_unit(&random)),
               scale = ldexp(1, test_random_between(&random, -600, 600));
        pir_vec3 scaled = {scale * axis.x, scale * axis.y, scale * axis.z};
        assert_int_equal(pir_live_mesh_set_region(part, scaled, half_angle), PIR_OK);
        there = test_compose((pir_quat){2e-3, 1e-3, -1e-3, 1}, there, 1);
        assert_int_equal(pir_sum_rotate(sum, there, PIR_METHOD_UPDATE), PIR_OK);
        assert_int_equal(pir_live_mesh_refresh(all), PIR_OK);
        assert_int_equal(pir_live_mesh_refresh(part), PIR_OK);
        list_live(part, &held);
        expect_changes(part, &before, &held);
        before = held;
        pir_live_mesh_planes(all, planes);
        uint32_t slots = pir_live_mesh_facet_slots(all), corners, uses = 0, pair[2], used = 0;
        assert_int_equal(pir_live_mesh_facet_slots(part), slots);
        for (uint32_t slot = 0; slot < slots; slot++) {
            pir_sum_pair one, other;
            if (!pir_live_mesh_pair(all, slot, &one))
                continue;
            pir_vec3 n = planes[slot].normal;
            double cosine = n.x * axis.x + n.y * axis.y + n.z * axis.z;
            int is_in = pir_live_mesh_pair(part, slot, &other);
            if (cosine > cos(half_angle))
                expect(is_in && compare(&one, &other) == 0, "step %d, slot %u", i, slot);
            else if (cosine < cos(half_angle) - 1e-9)
                expect(!is_in, "step %d, slot %u", i, slot);
            pir_live_mesh_facet(part, slot, &corners);
            assert_true((corners > 0) == is_in);
            uses += corners;
        }
        // no vertex is held that no facet needs
        for (uint32_t v = 0; v < pir_live_mesh_vertex_slots(part); v++)
            used += (uint32_t)pir_live_mesh_vertex_pair(part, v, pair);
        assert_true(uses == 0 ? used == 0 : used <= uses);
    }
    pir_live_mesh_clear_region(part);
    pir_live_mesh_clear_region(NULL);
    assert_int_equal(pir_live_mesh_refresh(part), PIR_OK);
    expect_closed(part, 2);
    assert_int_equal(pir_live_mesh_set_region(part, (pir_vec3){0, 0, 0}, 1), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_live_mesh_set_region(part, (pir_vec3){0, 0, 1}, -1), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_live_mesh_set_region(part, (pir_vec3){0, 0, (double)NAN}, 1), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_live_mesh_set_region(part, (pir_vec3){0, 0, 1}, (double)INFINITY), PIR_ERR_NOT_FINITE);
    pir_live_mesh_destroy(part);
    pir_live_mesh_destroy(all);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void making_one_without_memory_leaves_nothing_behind(void **state) {
    (void)state;
    test_random random = test_random_case("live memory", 0);
    pir_polytope *p = test_sphere(&random, 20), *q = test_sphere(&random, 20);
    uint64_t n = 0;
    for (bool failed = true; failed;) {
        test_memory memory = {0};
        pir_allocator allocator = test_allocator(&memory);
        pir_sum_options options = {.size = sizeof options, .allocator = &allocator, .difference = false};
        pir_sum *sum;
        pir_live_mesh *live = NULL;
        assert_int_equal(pir_sum_create(p, q, (pir_quat){1, 2, 3, 4}, &options, &sum), PIR_OK);
        memory.fail_at = memory.requests + ++n;
        pir_status status = pir_live_mesh_create(sum, &live);
        failed = status == PIR_ERR_MEMORY;
        assert_true(failed ? live == NULL : status == PIR_OK);
        pir_live_mesh_destroy(live);
        pir_sum_destroy(sum);
        assert_int_equal(memory.blocks, 0);
    }
    assert_true(n > 5);
    pir_live_mesh *live;
    assert_int_equal(pir_live_mesh_create(NULL, &live), PIR_ERR_ARGUMENT);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(live_mesh_is_the_sum_after_every_rotation),
        cmocka_unit_test(region_of_a_live_mesh_tells_each_change_once),
        cmocka_unit_test(what_is_noted_is_what_changed),
        cmocka_unit_test(small_turns_rewrite_little_and_allocate_nothing),
        cmocka_unit_test(region_holds_the_facets_that_face_its_way),
        cmocka_unit_test(making_one_without_memory_leaves_nothing_behind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
