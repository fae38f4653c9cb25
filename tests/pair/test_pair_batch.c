/* SPDX-License-Identifier: MIT */
/*
 * Batches of poses: each answer is that of a single call, bit for bit, on any number of threads, in runs of any length,
 * from arrays of any layout; bad poses are told and leave the others alone; memory that fails; gradients against
 * differences of distances.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pair_batch.h>

#include "support/answers.h"
#include "support/bodies.h"
#include "support/memory.h"
#include "support/random.h"

enum { COUNT = 300, CONTACTS = 6 };

typedef pir_status ask_one(pir_pair *, pir_workspace *, const pir_pair_input *, pir_query_result *);
typedef pir_status ask_many(pir_pair_batch *, const pir_pair_batch_input *, size_t, const pir_pair_batch_arrays *,
                            pir_pair_batch_summary *);

static const struct {
    ask_one *one;
    ask_many *many;
} calls[4] = {
    {pir_pair_overlap, pir_pair_batch_overlap},
    {pir_pair_distance, pir_pair_batch_distance},
    {pir_pair_penetration, pir_pair_batch_penetration},
    {pir_pair_signed_distance, pir_pair_batch_signed_distance},
};

struct answers {
    uint8_t state[COUNT], outcome[COUNT], status[COUNT];
    double distance[COUNT], normal[COUNT][3], point_p[COUNT][3], point_q[COUNT][3], gradient[COUNT][6];
    pir_witness witness[COUNT];
    pir_contact contacts[COUNT * CONTACTS];
    uint32_t contact_counts[COUNT];
};

static pir_pair_batch_arrays arrays_of(struct answers *a, bool contacts) {
    return (pir_pair_batch_arrays){.state = a->state,
                                   .outcome = a->outcome,
                                   .status = a->status,
                                   .distance = a->distance,
                                   .normal = a->normal,
                                   .point_p = a->point_p,
                                   .point_q = a->point_q,
                                   .gradient = a->gradient,
                                   .witness = a->witness,
                                   .contacts = contacts ? a->contacts : NULL,
                                   .contact_counts = contacts ? a->contact_counts : NULL,
                                   .contact_capacity = contacts ? CONTACTS : 0};
}

/* Poses about contact, in order of a motion, now and then elsewhere. */
static void make_poses(test_random *random, double size, pir_pose poses[COUNT]) {
    pir_pose at = {test_rotation(random), {size, 0, 0}};
    for (int i = 0; i < COUNT; i++) {
        if (test_random_below(random, 10) == 0)
            at.rotation = test_rotation(random);
        at.translation = (pir_vec3){test_random_unit(random) * size, test_random_unit(random) * size,
                                    test_random_unit(random) * size};
        poses[i] = at;
    }
}

static pir_pose_array array_of(const pir_pose *poses, bool is_one) {
    return (pir_pose_array){&poses->rotation.x, sizeof *poses, &poses->translation.x, sizeof *poses, is_one};
}

static pir_query_result answer_at(const struct answers *a, int i) {
    pir_query_result result = {.state = (pir_state)a->state[i],
                               .outcome = (pir_outcome)a->outcome[i],
                               .distance = a->distance[i],
                               .witness = a->witness[i]};
    memcpy(&result.normal, a->normal[i], sizeof result.normal);
    memcpy(&result.point_p, a->point_p[i], sizeof result.point_p);
    memcpy(&result.point_q, a->point_q[i], sizeof result.point_q);
    return result;
}

/* Contacts by the single calls are those of the batch. */
static void expect_contacts(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                            const pir_query_result *result, const struct answers *a, int i) {
    pir_contact contacts[CONTACTS];
    size_t count;
    assert_int_equal(pir_pair_manifold(pair, workspace, input, result, CONTACTS, contacts, &count), PIR_OK);
    assert_int_equal(count, a->contact_counts[i]);
    for (size_t k = 0; k < count && k < CONTACTS; k++) {
        const pir_contact *told = &a->contacts[i * CONTACTS + k];
        expect(memcmp(&contacts[k], told, sizeof *told) == 0, "pose %d, contact %zu", i, k);
    }
}

/* The answers of one batch are those of single calls on a pair that is made for each pose. */
static void expect_single(pir_polytope *p, pir_polytope *q, const pir_pair_batch_input *input, const pir_pose *at_p,
                          const pir_pose *at_q, int call, const struct answers *a) {
    pir_workspace *workspace;
    pir_pair *pair;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    assert_int_equal(pir_pair_create(p, q, NULL, &pair), PIR_OK);
    for (int i = 0; i < COUNT; i++) {
        pir_pair_input one = {at_p[i],         at_q[input->poses_q.is_one ? 0 : i],
                              input->radius_p, input->radius_q,
                              input->cutoff,   input->margin};
        pir_query_result result, told = answer_at(a, i);
        assert_int_equal(pir_pair_reset(pair, p, q), PIR_OK);
        const pir_status status = calls[call].one(pair, workspace, &one, &result);
        assert_int_equal(status, a->status[i]);
        expect(status != PIR_OK || test_same_result(&result, &told), "call %d, pose %d", call, i);
        if (status == PIR_OK && call == 3)
            expect_contacts(pair, workspace, &one, &result, a, i);
    }
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
}

/* Hard rotations are out of range beside another. */
static void expect_summary(const pir_pair_batch_summary *summary, const struct answers *a) {
    size_t bad = 0, first = COUNT;
    for (size_t i = COUNT; i-- > 0;)
        if (a->status[i] != PIR_OK)
            bad++, first = i;
    assert_int_equal(summary->bad, bad);
    assert_int_equal(summary->first_bad, first);
    assert_int_equal(summary->first_status, bad ? a->status[first] : PIR_OK);
}

static void answers_are_those_of_single_calls(void **state) {
    (void)state;
    static struct answers a, b;
    static pir_pose at_p[COUNT], at_q[COUNT];
    test_random random = test_random_case("pair batch", 11);
    for (int scene = 0; scene < 8; scene++) {
        pir_polytope *p = test_random_polytope(&random, (test_body)(scene % TEST_BODY_COUNT), 24);
        pir_polytope *q = test_random_polytope(&random, TEST_SPHERE, 12);
        const double size = test_size_of(p) + test_size_of(q);
        make_poses(&random, size, at_p);
        make_poses(&random, size / 4, at_q);
        pir_pair_batch_input input = pir_pair_batch_input_default();
        input.poses_p = array_of(at_p, false);
        input.poses_q = array_of(at_q, scene % 2 == 0);
        input.radius_p = scene % 3 == 2 ? size / 16 : 0;
        input.cutoff = scene % 4 == 1 ? size / 8 : HUGE_VAL;
        input.margin = size / 32;
        for (int call = 0; call < 4; call++)
            for (uint32_t threads = 1; threads <= 3; threads++) {
                pir_pair_batch_options options = pir_pair_batch_options_default();
                pir_pair_batch *batch;
                pir_pair_batch_summary summary;
                struct answers *to = threads == 1 ? &a : &b;
                memset(to, 0, sizeof *to);
                const pir_pair_batch_arrays arrays = arrays_of(to, call == 3);
                options.threads = threads;
                options.run = threads == 3 ? 7 : 0;
                assert_int_equal(pir_pair_batch_create(p, q, &options, &batch), PIR_OK);
                assert_int_equal(calls[call].many(batch, &input, COUNT, &arrays, &summary), PIR_OK);
                expect_summary(&summary, to);
                pir_pair_batch_destroy(batch);
                if (threads == 1)
                    expect_single(p, q, &input, at_p, at_q, call, &a);
                else
                    assert_memory_equal(&a, &b, sizeof a);
            }
        pir_polytope_release(p);
        pir_polytope_release(q);
    }
}

/* --- bad poses --- */

static void bad_poses_are_told_and_the_others_answered(void **state) {
    (void)state;
    static struct answers right, told;
    static pir_pose good[COUNT], some[COUNT];
    test_random random = test_random_case("pair batch", 12);
    pir_polytope *p = test_sphere(&random, 20), *q = test_box(1, 1, 1);
    make_poses(&random, 3, good);
    memcpy(some, good, sizeof some);
    some[7].translation.y = NAN;
    some[70].rotation = (pir_quat){0, 0, 0, 0};
    some[200].translation.z = 1e300;
    const pir_status should[3] = {PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, PIR_ERR_LIMIT};
    for (uint32_t threads = 1; threads <= 2; threads++) {
        pir_pair_batch_options options = pir_pair_batch_options_default();
        pir_pair_batch_input input = pir_pair_batch_input_default();
        pir_pair_batch_arrays arrays = arrays_of(&right, true);
        pir_pair_batch_summary summary;
        pir_pair_batch *batch;
        options.threads = threads;
        assert_int_equal(pir_pair_batch_create(p, q, &options, &batch), PIR_OK);
        input.poses_p = array_of(good, false);
        memset(&right, 0, sizeof right), memset(&told, 0, sizeof told);
        assert_int_equal(pir_pair_batch_signed_distance(batch, &input, COUNT, &arrays, NULL), PIR_OK);
        input.poses_p = array_of(some, false);
        arrays = arrays_of(&told, true);
        assert_int_equal(pir_pair_batch_signed_distance(batch, &input, COUNT, &arrays, &summary), PIR_OK);
        assert_int_equal(summary.bad, 3);
        assert_int_equal(summary.first_bad, 7);
        assert_int_equal(summary.first_status, PIR_ERR_NOT_FINITE);
        for (int i = 0; i < COUNT; i++) {
            const int bad = i == 7 ? 0 : i == 70 ? 1 : i == 200 ? 2 : -1;
            const pir_query_result a = answer_at(&right, i), b = answer_at(&told, i);
            if (bad < 0) {
                expect(told.status[i] == PIR_OK && test_same_result(&a, &b), "pose %d", i);
                continue;
            }
            assert_int_equal(told.status[i], should[bad]);
            assert_int_equal(told.state[i], PIR_POSE_BAD);
            assert_int_equal(told.outcome[i], PIR_POSE_BAD);
            assert_true(isnan(told.distance[i]) && isnan(told.normal[i][0]) && isnan(told.gradient[i][5]));
            assert_int_equal(told.contact_counts[i], 0);
        }
        pir_pair_batch_destroy(batch);
    }
    pir_polytope_release(p);
    pir_polytope_release(q);
}

/* --- refusals --- */

static void what_is_no_batch_is_refused_and_writes_nothing(void **state) {
    (void)state;
    static struct answers a, untouched;
    pir_polytope *p = test_box(1, 1, 1);
    pir_pair_batch *batch = NULL;
    pir_pair_batch_options options = pir_pair_batch_options_default();
    const pir_tasks no_tasks = {0};
    assert_int_equal(pir_pair_batch_create(NULL, p, NULL, &batch), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_pair_batch_create(p, NULL, NULL, &batch), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_pair_batch_create(p, p, NULL, NULL), PIR_ERR_ARGUMENT);
    options.threads = 0;
    assert_int_equal(pir_pair_batch_create(p, p, &options, &batch), PIR_ERR_ARGUMENT);
    options.threads = 65;
    assert_int_equal(pir_pair_batch_create(p, p, &options, &batch), PIR_ERR_ARGUMENT);
    options.threads = 1, options.tasks = &no_tasks;
    assert_int_equal(pir_pair_batch_create(p, p, &options, &batch), PIR_ERR_ARGUMENT);
    assert_null(batch);
    assert_int_equal(pir_pair_batch_create(p, p, NULL, &batch), PIR_OK);
    memset(&a, 0x5a, sizeof a);
    untouched = a;
    pir_pair_batch_arrays arrays = arrays_of(&a, true);
    const pir_pair_batch_input good = pir_pair_batch_input_default();
    pir_pair_batch_input input[6] = {good, good, good, good, good, good};
    input[0].radius_p = -1, input[1].radius_q = NAN, input[2].cutoff = NAN, input[3].margin = -1;
    input[4].poses_p.rotation_stride = 28, input[5].poses_q.translation_stride = 8;
    for (int i = 0; i < 6; i++)
        expect(pir_pair_batch_signed_distance(batch, &input[i], COUNT, &arrays, NULL) ==
                   (i == 1 || i == 2 ? PIR_ERR_NOT_FINITE : PIR_ERR_ARGUMENT),
               "case %d", i);
    assert_int_equal(pir_pair_batch_signed_distance(batch, NULL, COUNT, &arrays, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_pair_batch_signed_distance(batch, &good, COUNT, NULL, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_pair_batch_signed_distance(NULL, &good, COUNT, &arrays, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_pair_batch_overlap(batch, &good, COUNT, &arrays, NULL), PIR_ERR_ARGUMENT);
    arrays.contact_counts = NULL;
    assert_int_equal(pir_pair_batch_signed_distance(batch, &good, COUNT, &arrays, NULL), PIR_ERR_ARGUMENT);
    assert_memory_equal(&a, &untouched, sizeof a);
    arrays = (pir_pair_batch_arrays){0};
    assert_int_equal(pir_pair_batch_signed_distance(batch, &good, COUNT, &arrays, NULL), PIR_OK);
    assert_int_equal(pir_pair_batch_signed_distance(batch, &good, 0, &arrays, NULL), PIR_OK);
    pir_pair_batch_destroy(batch);
    pir_pair_batch_destroy(NULL);
    pir_polytope_release(p);
}

/* --- memory --- */

static void memory_that_fails_is_that_of_its_pose(void **state) {
    (void)state;
    static struct answers right, told;
    static pir_pose at[COUNT];
    test_random random = test_random_case("pair batch", 13);
    pir_polytope *p = test_sphere(&random, 30), *q = test_sphere(&random, 30);
    make_poses(&random, 2, at);
    bool failed = true;
    for (uint64_t n = 0; failed; n++) {
        test_memory memory = {.fail_at = n};
        const pir_allocator allocator = test_allocator(&memory);
        pir_pair_batch_options options = pir_pair_batch_options_default();
        pir_pair_batch_input input = pir_pair_batch_input_default();
        pir_pair_batch_summary summary = {0};
        pir_pair_batch *batch = NULL;
        struct answers *to = n == 0 ? &right : &told;
        const pir_pair_batch_arrays arrays = arrays_of(to, true);
        options.allocator = &allocator;
        input.poses_p = array_of(at, false);
        pir_status status = pir_pair_batch_create(p, q, &options, &batch);
        expect(status == PIR_OK || (n > 0 && status == PIR_ERR_MEMORY && !batch), "request %u", (unsigned)n);
        if (status == PIR_OK) {
            assert_int_equal(pir_pair_batch_signed_distance(batch, &input, COUNT, &arrays, &summary), PIR_OK);
            for (int i = 0; i < COUNT; i++) {
                const pir_query_result a = answer_at(&right, i), b = answer_at(to, i);
                expect(to->status[i] == PIR_ERR_MEMORY || test_same_result(&a, &b), "request %u, pose %d", (unsigned)n,
                       i);
            }
            expect(summary.bad <= 1 && (summary.bad == 0 || summary.first_status == PIR_ERR_MEMORY), "%zu bad",
                   summary.bad);
        }
        failed = n == 0 || memory.requests >= n;
        pir_pair_batch_destroy(batch);
        assert_int_equal(memory.blocks, 0);
        assert_false(memory.wrong_size);
    }
    pir_polytope_release(p);
    pir_polytope_release(q);
}

/* --- threads of the caller's --- */

struct backwards {
    void (*task)(void *data, uint32_t index);
    void *data;
    uint32_t count, batches;
};

static void start_backwards(void *context, void (*task)(void *data, uint32_t index), void *data, uint32_t count) {
    struct backwards *b = context;
    b->task = task, b->data = data, b->count = count;
}

static void finish_backwards(void *context) {
    struct backwards *b = context;
    for (uint32_t i = b->count; i-- > 0;)
        b->task(b->data, i);
    b->batches++;
}

static void threads_may_be_the_caller_s(void **state) {
    (void)state;
    static struct answers a;
    static pir_pose at[COUNT];
    test_random random = test_random_case("pair batch", 14);
    pir_polytope *p = test_sphere(&random, 30);
    make_poses(&random, 2, at);
    struct backwards backwards = {0};
    const pir_tasks tasks = {&backwards, start_backwards, finish_backwards};
    pir_pair_batch_options options = pir_pair_batch_options_default();
    pir_pair_batch_input input = pir_pair_batch_input_default();
    const pir_pair_batch_arrays arrays = arrays_of(&a, true);
    pir_pair_batch *batch;
    options.threads = 4, options.tasks = &tasks;
    input.poses_p = array_of(at, false);
    assert_int_equal(pir_pair_batch_create(p, p, &options, &batch), PIR_OK);
    assert_int_equal(pir_pair_batch_signed_distance(batch, &input, COUNT, &arrays, NULL), PIR_OK);
    assert_int_equal(backwards.batches, 1);
    assert_int_equal(backwards.count, 4);
    const pir_pose origin = pir_pose_identity();
    input.poses_q = array_of(&origin, true);
    expect_single(p, p, &input, at, &origin, 3, &a);
    pir_pair_batch_destroy(batch);
    pir_polytope_release(p);
}

/* --- gradients --- */

/* P moved along, or turned about its own origin along, axis k of the world. */
static pir_pose moved(pir_pose at, int k, double by) {
    const pir_vec3 along = {k % 3 == 0 ? by : 0, k % 3 == 1 ? by : 0, k % 3 == 2 ? by : 0}, none = {0, 0, 0};
    return pir_pose_integrate(at, k < 3 ? along : none, k < 3 ? none : along, 1);
}

static void gradients_are_those_of_the_distance(void **state) {
    (void)state;
    static struct answers a;
    static pir_pose at[COUNT];
    const double h = 1e-6;
    int checked = 0;
    test_random random = test_random_case("pair batch", 15);
    pir_polytope *p = test_sphere(&random, 20), *q = test_sphere(&random, 20);
    pir_workspace *workspace;
    pir_pair *pair;
    pir_pair_batch *batch;
    make_poses(&random, 1.2, at);
    pir_pair_batch_input input = pir_pair_batch_input_default();
    const pir_pair_batch_arrays arrays = arrays_of(&a, false);
    input.poses_p = array_of(at, false);
    input.radius_q = 0.01;
    assert_int_equal(pir_pair_batch_create(p, q, NULL, &batch), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    assert_int_equal(pir_pair_create(p, q, NULL, &pair), PIR_OK);
    assert_int_equal(pir_pair_batch_signed_distance(batch, &input, COUNT, &arrays, NULL), PIR_OK);
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < 6; k++) {
            pir_query_result less, more;
            pir_pair_input one = pir_pair_input_default();
            one.radius_q = input.radius_q;
            one.pose_p = moved(at[i], k, -h);
            assert_int_equal(pir_pair_signed_distance(pair, workspace, &one, &less), PIR_OK);
            one.pose_p = moved(at[i], k, h);
            assert_int_equal(pir_pair_signed_distance(pair, workspace, &one, &more), PIR_OK);
            // where features change within the step there is no derivative
            if (!test_same_witness(&less.witness, &more.witness))
                continue;
            const double slope = (more.distance - less.distance) / (2 * h);
            expect(fabs(slope - a.gradient[i][k]) < 1e-6, "pose %d, %d: %g for %g", i, k, a.gradient[i][k], slope);
            checked++;
        }
    expect(checked > COUNT * 5, "%d checked", checked);
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_pair_batch_destroy(batch);
    pir_polytope_release(p);
    pir_polytope_release(q);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(answers_are_those_of_single_calls),
        cmocka_unit_test(bad_poses_are_told_and_the_others_answered),
        cmocka_unit_test(what_is_no_batch_is_refused_and_writes_nothing),
        cmocka_unit_test(memory_that_fails_is_that_of_its_pose),
        cmocka_unit_test(threads_may_be_the_caller_s),
        cmocka_unit_test(gradients_are_those_of_the_distance),
    };
    return cmocka_run_group_tests_name("batches of pairs", tests, NULL, NULL);
}
