/* SPDX-License-Identifier: MIT */
/* Every version of the kernels that this processor runs gives the bits of the scalar reference, on
   general and on tied data. */
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#include "base/processor.h"
#include "dymsum/sum.h"
#include "support/bodies.h"
#include "support/hash.h"

/* Between −1 and 1. */
static double uniform(test_random *random) {
    return 2 * test_random_unit(random) - 1;
}

/* Moves the facets' cells and the step at random, so that every case of a review occurs. */
static void move(test_random *random, pir_facets *facets, uint32_t vertices, pir_step *step) {
    for (uint32_t f = 0; f < facets->count; f++)
        if (test_random_below(random, 4) == 0)
            facets->cell[f] = test_random_below(random, vertices);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 8; i++)
            if (i % 4 != 3 && test_random_below(random, 3) == 0)
                facets->turn[k][i] = test_random_below(random, 4) == 0 ? 0 : (float)uniform(random);
    *step = (pir_step){.reach_ahead = (float)(uniform(random) * 0.2 + 0.2),
                       .reach_behind = test_random_below(random, 2) ? 0 : 0x1p-10f,
                       .ahead = (float)uniform(random) / 4,
                       .behind = (float)uniform(random) / 4,
                       .axial = test_random_below(random, 4) != 0};
}

/* A hash of all that a review by `kernels` leaves. Certificates and cells are afterwards as before the review. */
static uint64_t review_hash(pir_sum *sum, const pir_kernels *kernels, const pir_facets *facets, pir_step step) {
    uint32_t count = facets->count, certificates = pir_certificate_count(&sum->tracked);
    uint32_t *cells = malloc((count + 1) * sizeof *cells), *expired = malloc((count + 1) * sizeof *expired);
    uint32_t *uncertain = malloc((count + 1) * sizeof *uncertain);
    pir_suspect *suspects = malloc((count + 1) * sizeof *suspects);
    memcpy(cells, facets->cell, count * sizeof *cells);
    for (uint32_t f = 0; f < count; f++)
        expired[f] = facets->first_certificate + f;
    pir_certificates_lay_out(&sum->tracked.certificates, certificates);
    uint64_t sides = 0, hash = 0xcbf29ce484222325u;
    // in two parts
    const pir_due first = {expired, count / 2, count - count / 2, false};
    const pir_due rest = {expired + first.count, first.behind, 0, true};
    uint32_t found = kernels->review(facets, &step, &sum->tracked.certificates, &first, suspects, &sides);
    found += kernels->review(facets, &step, &sum->tracked.certificates, &rest, suspects + found, &sides);
    for (uint32_t i = 0; i < found; i++) {
        hash = test_hash(hash, &suspects[i].facet, sizeof suspects[i].facet);
        hash = test_hash(hash, &suspects[i].crossed, sizeof suspects[i].crossed);
    }
    hash = test_hash(hash, facets->cell, count * sizeof *cells);
    hash = test_hash(hash, sum->tracked.certificates.margin, certificates * sizeof *sum->tracked.certificates.margin);
    hash = test_hash(hash, sum->tracked.certificates.ahead, certificates * sizeof *sum->tracked.certificates.ahead);
    hash = test_hash(hash, sum->tracked.certificates.behind, certificates * sizeof *sum->tracked.certificates.behind);
    hash = test_hash(hash, &sides, sizeof sides);
    memcpy(facets->cell, cells, count * sizeof *cells);
    for (uint32_t f = 0; f < count; f++)
        expired[f] = f;
    for (uint32_t f = 0; f < count; f += PIR_DESCENT_MOST) {
        uint32_t some = count - f < PIR_DESCENT_MOST ? count - f : PIR_DESCENT_MOST;
        uint32_t open = kernels->descend(facets, expired + f, cells + f, some, uncertain, &sides);
        hash = test_hash(hash, uncertain, open * sizeof *uncertain);
    }
    hash = test_hash(hash, facets->cell, count * sizeof *cells);
    hash = test_hash(hash, &sides, sizeof sides);
    for (uint32_t f = 0; f < count; f++) {
        pir_cell_probe seen;
        kernels->probe(facets, &step, cells[f], facets->turn[f % 3], &seen);
        const float spans[4] = {seen.highest, seen.check.margin, seen.check.ahead, seen.check.behind};
        hash = test_hash(hash, &seen.check.touched, sizeof seen.check.touched);
        hash = test_hash(hash, &seen.check.above, sizeof seen.check.above);
        hash = test_hash(hash, &seen.which, sizeof seen.which);
        hash = test_hash(hash, spans, sizeof spans);
    }
    memcpy(facets->cell, cells, count * sizeof *cells);
    free(suspects);
    free(uncertain);
    free(expired);
    free(cells);
    return hash;
}

static void reviews_have_the_bits_of_the_reference(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 300; i++) {
        test_random random = test_random_case("kernels", i);
        test_pose pose;
        test_random_pose(&random, 60, &pose);
        pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
        pir_sum *sum = NULL;
        assert_int_equal(pir_sum_create(p, q, pose.rotation, NULL, &sum), PIR_OK);
        assert_int_equal(pir_sum_rotate(sum, test_rotation(&random), PIR_METHOD_UPDATE), PIR_OK);
        for (int operand = 0; operand < 2; operand++) {
            pir_facets *facets = operand ? &sum->tracked.q_facets : &sum->tracked.p_facets;
            pir_step step = sum->tracked.step;
            for (int round = 0; round < 4; round++) {
                uint64_t expected = review_hash(sum, pir_processor_version(0)->kernels, facets, step);
                for (unsigned k = 1; pir_processor_version(k); k++)
                    expect(review_hash(sum, pir_processor_version(k)->kernels, facets, step) == expected,
                           "%s, case %llu, round %d", pir_processor_version(k)->kernels->name, (unsigned long long)i,
                           round);
                move(&random, facets, operand ? p->vertex_count : q->vertex_count, &step);
            }
        }
        pir_sum_destroy(sum);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

/* Sets certificates about phase 0, some on it. */
static void set_certificates(test_random *random, pir_certificates *certificates, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        float ahead = (float)uniform(random) + 0.9f, behind = (float)uniform(random) - 0.9f;
        if (test_random_below(random, 16) == 0)
            ahead = 0;
        if (test_random_below(random, 16) == 0)
            behind = -PIR_NEVER;
        pir_certificate_set(certificates, i, 1, ahead, behind);
    }
}

static void collections_list_the_same_certificates(void **state) {
    (void)state;
    const pir_allocator allocator = pir_allocator_or_default(NULL);
    uint64_t total = 0;
    for (uint64_t i = 0; i < 400; i++) {
        uint32_t listed = 0;
        uint64_t expected = 0;
        for (unsigned k = 0; pir_processor_version(k); k++) {
            test_random random = test_random_case("kernels collect", i);
            uint32_t count = 1 + test_random_below(&random, 700);
            pir_certificates certificates = {0};
            assert_true(pir_certificates_init(&certificates, &allocator, count));
            uint32_t blocks = certificates.capacity / PIR_CERTIFICATE_BLOCK;
            set_certificates(&random, &certificates, count);
            uint64_t hash = 0xcbf29ce484222325u;
            for (int round = 0; round < 3; round++) {
                const pir_turned_angle turned = {uniform(&random) / 50, uniform(&random) / 50,
                                                 test_random_below(&random, 2) == 0};
                uint32_t found = pir_kernels_collect(pir_processor_version(k)->kernels, &certificates, count, turned);
                hash = test_hash(hash, certificates.expired, found * sizeof *certificates.expired);
                hash = test_hash(hash, certificates.block_ahead, blocks * sizeof *certificates.block_ahead);
                hash = test_hash(hash, certificates.block_behind, blocks * sizeof *certificates.block_behind);
                listed += k == 0 ? found : 0;
            }
            if (k == 0)
                expected = hash;
            expect(hash == expected, "%s, case %llu", pir_processor_version(k)->kernels->name, (unsigned long long)i);
            pir_certificates_finish(&certificates, &allocator);
        }
        total += listed;
    }
    assert_true(total > 1000);
}

/* A hash of what a sweep finds by `kernels`, and of where descents start; *listed grows by how many are found. */
static uint64_t sweep_hash(const pir_sum *sum, const pir_kernels *kernels, const pir_sight *sight, uint64_t *listed) {
    const pir_sweep *sweep = sum->region.sweep;
    const pir_clusters *of[2] = {&sweep->arcs, &sweep->points};
    uint32_t most = (sweep->edges.capacity + sweep->q.members.capacity + 1) * PIR_LANES;
    uint32_t *which = malloc(most * sizeof *which), *item = malloc(most * sizeof *item);
    uint64_t hash = 0xcbf29ce484222325u;
    for (int k = 0; k < 2; k++) {
        uint32_t near = kernels->list_caps(&of[k]->caps, sight, which), found = 0;
        const float *row = k ? sweep->point : sweep->arc;
        const pir_clustered clustered = {row, of[k]->item, of[k]->count, which, near};
        hash = test_hash(hash, which, near * sizeof *which);
        if (k == 1)
            found = kernels->list_points(&clustered, sight, item);
        for (uint32_t at = 0; k == 0 && at < near; at++) {
            found += kernels->list_arcs(&clustered, sight, &at, item + found);
            hash = test_hash(hash, &at, sizeof at);
        }
        hash = test_hash(hash, item, found * sizeof *item);
        *listed += found;
    }
    const pir_facets *facets[2] = {&sum->tracked.p_facets, &sum->tracked.q_facets};
    const pir_starts *starts[2] = {&sweep->p.starts, &sweep->q.starts};
    for (int k = 0; k < 2; k++)
        for (uint32_t f = 0; f < facets[k]->count; f += PIR_DESCENT_MOST) {
            uint32_t count = facets[k]->count - f < PIR_DESCENT_MOST ? facets[k]->count - f : PIR_DESCENT_MOST;
            for (uint32_t i = 0; i < count; i++)
                which[i] = f + i;
            kernels->find_starts(facets[k], starts[k], which, count, item);
            hash = test_hash(hash, item, count * sizeof *item);
        }
    free(item);
    free(which);
    return hash;
}

static void sweeps_find_the_same(void **state) {
    (void)state;
    uint64_t listed = 0;
    for (uint64_t i = 0; i < 300; i++) {
        test_random random = test_random_case("kernels sweep", i);
        test_pose pose;
        test_random_pose(&random, 60, &pose);
        pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
        pir_sum *sum = NULL;
        assert_int_equal(pir_sum_create(p, q, pose.rotation, NULL, &sum), PIR_OK);
        assert_int_equal(pir_sum_set_region(sum, (pir_vec3){0, 0, 1}, 0.5), PIR_OK);
        for (int round = 0; round < 8; round++) {
            // along a normal there are ties
            uint32_t facets = q->facet_count;
            pir_vec3 axis = facets > 0 && round % 2 ? q->normal[test_random_below(&random, facets)]
                                                    : test_random_direction(&random);
            const pir_arc reach = pir_arc_of(round < 2 ? 0 : 3.2 * test_random_unit(&random));
            const pir_sight sight = {(float)axis.x,       (float)axis.y,     (float)axis.z,
                                     (float)reach.cosine, (float)reach.sine, round % 3 ? 0x1p-18f : 0x1p-4f};
            uint64_t expected = sweep_hash(sum, pir_processor_version(0)->kernels, &sight, &listed);
            for (unsigned k = 1; pir_processor_version(k); k++)
                expect(sweep_hash(sum, pir_processor_version(k)->kernels, &sight, &listed) == expected,
                       "%s, case %llu, round %d", pir_processor_version(k)->kernels->name, (unsigned long long)i,
                       round);
        }
        pir_sum_destroy(sum);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    assert_true(listed > 10000);
}

int main(void) {
    test_print_seed();
    for (unsigned k = 0; pir_processor_version(k); k++)
        print_message("# kernels: %s\n", pir_processor_version(k)->kernels->name);
    if (!pir_processor_version(1)) {
        print_message("# nothing to compare: the scalar version alone runs here\n");
        return TEST_SKIPPED;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reviews_have_the_bits_of_the_reference),
        cmocka_unit_test(collections_list_the_same_certificates),
        cmocka_unit_test(sweeps_find_the_same),
    };
    return cmocka_run_group_tests_name("kernels", tests, NULL, NULL);
}
