/* SPDX-License-Identifier: MIT */
/* The check of a sum sees damage: a cell that is another, a crossing that is another, and, with a region,
   whatever of it is taken out. */
#include "support/test.h"

#include <math.h>

#include "dymsum/pairing/predicates.h"
#include "dymsum/sum.h"
#include "support/bodies.h"

enum { SEEN, HARMLESS };

/* Gives a facet another cell, or none, which only a region allows. */
static void damage_cells(test_random *random, pir_sum *sum, uint32_t *cell, uint32_t count, uint32_t others,
                         uint32_t told[2]) {
    for (int n = 0; n < 20; n++) {
        uint32_t f = test_random_below(random, count), before = cell[f];
        cell[f] = n % 4 == 0 && !sum->region.cone.set ? PIR_NO_PAIR : test_random_below(random, others);
        if (cell[f] != before && before != PIR_NO_PAIR) {
            // at the perturbed rotation no two vertices are farthest at once
            expect(!pir_sum_is_valid(sum), "facet %u in %u, not %u", f, cell[f], before);
            told[SEEN]++;
        }
        cell[f] = before;
    }
}

/* Whether a normal of P is inside the region beyond doubt. */
static bool is_inside(const pir_sum *sum, uint32_t f) {
    return pir_vec_dot(sum->region.cone.axis, pir_rotated_normal(&sum->tracked.pairing, f)) >
           sum->region.cone.cosine + 1e-6;
}

/*
 * Removes the crossings of an edge of P as if it were inactive. That is harmless where its arc stays out of the region.
 */
static void damage_edges(pir_sum *sum, uint32_t told[2]) {
    for (uint32_t e = 0; e < sum->tracked.pairing.p->edge_count; e++) {
        uint32_t half = sum->tracked.pairing.p->edge_half[e], first = sum->tracked.pairing.crossings.first[e],
                 stamp = sum->tracked.touched[e], left = sum->tracked.pairing.p->left[half],
                 right = pir_right(sum->tracked.pairing.p, half);
        if (stamp == PIR_INACTIVE || first != PIR_NO_CROSSING)
            continue;
        // an arc without crossings: whether it is active is the only difference
        sum->tracked.touched[e] = PIR_INACTIVE;
        bool valid = pir_sum_is_valid(sum) != 0;
        sum->tracked.touched[e] = stamp;
        told[valid ? HARMLESS : SEEN]++;
        if (is_inside(sum, left) || is_inside(sum, right))
            expect(!valid, "edge %u", e);
    }
}

/* Makes an inactive edge of P active whose two facets are in no cell. */
static void damage_inactive_edges(pir_sum *sum, uint32_t told[2]) {
    const pir_polytope *p = sum->tracked.pairing.p;
    for (uint32_t e = 0; e < p->edge_count; e++) {
        uint32_t half = p->edge_half[e], stamp = sum->tracked.touched[e];
        if (stamp != PIR_INACTIVE || sum->tracked.pairing.fv[p->left[half]] != PIR_NO_PAIR ||
            sum->tracked.pairing.fv[pir_right(p, half)] != PIR_NO_PAIR)
            continue;
        sum->tracked.touched[e] = 0;
        expect(!pir_sum_is_valid(sum), "edge %u is active without cells", e);
        sum->tracked.touched[e] = stamp;
        told[SEEN]++;
    }
}

/* Puts the half of a crossing in place of another's. */
static void damage_crossings(test_random *random, pir_sum *sum, uint32_t told[2]) {
    pir_crossings *c = &sum->tracked.pairing.crossings;
    for (uint32_t slot = 0; slot < c->used; slot++) {
        uint32_t before = c->at[slot].half, other = test_random_below(random, sum->tracked.pairing.q->half_count);
        if (c->at[slot].edge == PIR_NO_CROSSING || other == before)
            continue;
        c->at[slot].half = other;
        expect(!pir_sum_is_valid(sum), "crossing %u", slot);
        c->at[slot].half = before;
        told[SEEN]++;
    }
}

/* Leads the chain of free slots to a slot in use or beyond the last, and cuts it off. */
static void damage_free_slots(pir_sum *sum, uint32_t *told) {
    pir_crossings *c = &sum->tracked.pairing.crossings;
    uint32_t before = c->free;
    for (uint32_t slot = 0; slot <= c->used; slot++) {
        if (slot < c->used && c->at[slot].edge == PIR_NO_CROSSING)
            continue;
        c->free = slot;
        expect(!pir_sum_is_valid(sum), "slot %u of %u is free and in use", slot, c->used);
        (*told)++;
    }
    if (before != PIR_NO_CROSSING) {
        c->free = PIR_NO_CROSSING;
        expect(!pir_sum_is_valid(sum), "free slots are lost");
    }
    c->free = before;
}

static void damage_is_seen(void **state) {
    (void)state;
    uint32_t told[4][2] = {{0}};
    for (uint64_t i = 0; i < 120; i++) {
        test_random random = test_random_case("sum damage", i);
        test_pose pose;
        test_random_pose(&random, 14, &pose);
        pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
        pir_sum *sum = NULL;
        assert_int_equal(pir_sum_create(p, q, pose.rotation, NULL, &sum), PIR_OK);
        if (pir_polytope_dimension(p) == 3 && pir_polytope_dimension(q) == 3)
            for (int region = 0; region < 2; region++) {
                if (region)
                    assert_int_equal(pir_sum_set_region(sum, test_random_direction(&random), 1.2), PIR_OK);
                assert_true(pir_sum_is_valid(sum));
                damage_cells(&random, sum, sum->tracked.pairing.fv, p->facet_count, q->vertex_count, told[0]);
                damage_cells(&random, sum, sum->tracked.pairing.vf, q->facet_count, p->vertex_count, told[0]);
                damage_crossings(&random, sum, told[1]);
                damage_free_slots(sum, &told[1][SEEN]);
                if (region)
                    damage_edges(sum, told[2]), damage_inactive_edges(sum, told[3]);
                assert_true(pir_sum_is_valid(sum));
            }
        pir_sum_destroy(sum);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    print_message("# cells %u seen, crossings %u, edges %u and %u harmless\n", told[0][SEEN], told[1][SEEN],
                  told[2][SEEN], told[2][HARMLESS]);
    assert_true(told[0][SEEN] > 1000 && told[1][SEEN] > 500 && told[2][SEEN] > 30 && told[3][SEEN] > 30);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(damage_is_seen)};
    return cmocka_run_group_tests_name("dymsum valid", tests, NULL, NULL);
}
