/* SPDX-License-Identifier: MIT */
/*
 * What threads may do at once: take and give references to polytopes; track sums of the same polytopes, a sum a thread,
 * with its meshes, queries and live mesh; read one mesh and one cubical map; make shapes, and read OFF. Every thread
 * finds what one thread alone finds, bit for bit. Under ThreadSanitizer, as .ci/run builds this program, it also shows
 * that none of it races. PIR_TEST_UPDATES=1000000 lets eight threads make a million updates each.
 */
#include "support/test.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/cgm.h>
#include <pirouette/exact.h>
#include <pirouette/io.h>
#include <pirouette/live_mesh.h>
#include <pirouette/query.h>
#include <pirouette/shape.h>

#include "support/bodies.h"
#include "support/hash.h"
#include "support/meshes.h"

#define THREADS 4
#define FRAMES  60

/* Of the threads that only update: how many, and after how many updates each looks at its pairing. */
#define UPDATERS 8
#define LOOKS    500

/* What all threads read; nobody writes it while they run. The polytopes are freed by whoever lets go of them last. */
struct shared {
    pir_polytope *p, *q;
    pir_mesh *mesh;
    pir_cgm *cgm;
    pthread_barrier_t start;
};

/* One thread: what it works on, a reference of its own to each polytope, and the hash of all that it found. */
struct worker {
    struct shared *shared;
    pir_polytope *p, *q;
    uint64_t hash;
    bool failed;
};

/* cmocka's assertions are for the main thread. */
static void need(struct worker *worker, pir_status status) {
    worker->failed = worker->failed || status != PIR_OK;
}

/* --- what a thread does --- */

static void count_references(struct worker *worker) {
    for (int i = 0; i < 2000; i++) {
        pir_polytope *p = pir_polytope_retain(worker->p), *q = pir_polytope_retain(p);
        pir_polytope_release(i % 2 ? p : q);
        pir_polytope_release(i % 2 ? q : p);
    }
}

static void ask_query(struct worker *worker, pir_query *query, pir_query_cache *cache, double away) {
    pir_query_input input = pir_query_input_default();
    pir_query_result result;
    double depths[2] = {0, 0};
    input.translation = (pir_vec3){away, 0.1, -0.2};
    need(worker, pir_query_signed_distance(query, &input, cache, &result));
    worker->hash = test_hash(worker->hash, &result.distance, sizeof result.distance);
    worker->hash = test_hash(worker->hash, &result.normal, sizeof result.normal);
    const pir_vec3 translations[2] = {{0, 0, 0}, input.translation};
    need(worker, pir_query_batch_depths(query, translations, 2, depths, NULL));
    worker->hash = test_hash(worker->hash, depths, sizeof depths);
}

/* Follows a sum by all methods, with a live mesh and a query on it. */
static void track(struct worker *worker) {
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    pir_quat r = {0.1, 0.2, 0.3, 0.9};
    pir_sum *sum = NULL;
    pir_query *query = NULL;
    pir_live_mesh *live = NULL;
    pir_query_cache cache = {0};
    need(worker, pir_sum_create(worker->p, worker->q, r, &options, &sum));
    if (worker->failed)
        return;
    need(worker, pir_query_create(sum, &query));
    need(worker, pir_live_mesh_create(sum, &live));
    for (int frame = 0; frame < FRAMES && !worker->failed; frame++) {
        r = test_compose(frame % 20 == 19 ? (pir_quat){1, 0, 0, 1} : (pir_quat){0.01, -0.02, 0.015, 1}, r, 1);
        need(worker, pir_sum_rotate(sum, r, (pir_method)(frame % 4)));
        need(worker, pir_live_mesh_refresh(live));
        worker->hash = test_hash_pairing(worker->hash, sum);
        ask_query(worker, query, &cache, frame * 0.05);
    }
    pir_mesh *mesh = NULL;
    need(worker, pir_sum_mesh(sum, PIR_EXACT, &mesh));
    if (mesh)
        worker->hash = test_hash_mesh(worker->hash, mesh);
    pir_mesh_destroy(mesh);
    pir_live_mesh_destroy(live);
    pir_query_destroy(query);
    pir_sum_destroy(sum);
}

/* Reads the mesh and the map that all share. */
static void read_shared(struct worker *worker) {
    const struct shared *shared = worker->shared;
    worker->hash = test_hash_mesh(worker->hash, shared->mesh);
    mpq_t x[3];
    mpq_inits(x[0], x[1], x[2], NULL);
    need(worker, pir_mesh_vertex_exact(shared->mesh, 0, x));
    mpq_clears(x[0], x[1], x[2], NULL);
    pir_cgm *twice = NULL;
    pir_cgm_locator *locator = NULL;
    pir_cgm_location location = {PIR_CGM_INSIDE, 0, 0};
    worker->failed = worker->failed || !pir_cgm_is_valid(shared->cgm);
    need(worker, pir_cgm_overlay(shared->cgm, shared->cgm, &twice));
    need(worker, pir_cgm_locator_create(shared->cgm, &locator));
    if (locator)
        need(worker, pir_cgm_locate(locator, (pir_vec3){0.5, 0.25, 0.125}, PIR_CGM_NONE, &location));
    worker->hash = test_hash(worker->hash, &location.witness, sizeof location.witness);
    pir_cgm_locator_destroy(locator);
    pir_cgm_release(twice);
}

/* Shapes by name, and a polytope from text. */
static void make_shapes(struct worker *worker) {
    static const char *const names[] = {"gs4", "icosahedron", "cube"};
    for (int i = 0; i < 3; i++) {
        pir_polytope *shape = NULL, *minus = NULL;
        need(worker, pir_shape_create(names[i], NULL, NULL, &shape));
        if (!shape)
            return;
        need(worker, pir_polytope_reflect(shape, &minus));
        uint32_t facets = minus ? pir_polytope_facet_count(minus) : 0;
        worker->hash = test_hash(worker->hash, &facets, sizeof facets);
        pir_polytope_release(minus);
        pir_polytope_release(shape);
    }
    static const char text[] = "OFF\n4 0 0\n0 0 0\n1/3 0 0\n0 1/7 0\n0 0 1e-300\n";
    pir_polytope *read = NULL;
    need(worker,
         pir_polytope_read_bytes(&(pir_file_bytes){text, sizeof text - 1, "text", "off"}, NULL, NULL, NULL, &read));
    if (!read)
        return;
    pir_vec3 vertex = pir_polytope_vertex(read, 1);
    worker->hash = test_hash(worker->hash, &vertex, sizeof vertex);
    pir_polytope_release(read);
}

static void *work(void *context) {
    struct worker *worker = context;
    worker->hash = TEST_HASH_START;
    pthread_barrier_wait(&worker->shared->start);
    count_references(worker);
    make_shapes(worker);
    track(worker);
    read_shared(worker);
    // the last thread to let go frees them
    pir_polytope_release(worker->p);
    pir_polytope_release(worker->q);
    return NULL;
}

/* --- all of it --- */

/* Runs `count` threads. When they are the last ones, what main holds of the polytopes goes to them. */
static void run_threads(struct shared *shared, struct worker *workers, unsigned count, bool last) {
    pthread_t threads[THREADS];
    assert_int_equal(pthread_barrier_init(&shared->start, NULL, count), 0);
    for (unsigned i = 0; i < count; i++) {
        workers[i] = (struct worker){shared, pir_polytope_retain(shared->p), pir_polytope_retain(shared->q), 0, false};
        assert_int_equal(pthread_create(&threads[i], NULL, work, &workers[i]), 0);
    }
    if (last) {
        pir_polytope_release(shared->q);
        pir_polytope_release(shared->p);
    }
    for (unsigned i = 0; i < count; i++) {
        assert_int_equal(pthread_join(threads[i], NULL), 0);
        assert_false(workers[i].failed);
    }
    pthread_barrier_destroy(&shared->start);
}

static void threads_find_what_one_alone_finds(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 3; i++) {
        test_random random = test_random_case("threads", i);
        struct shared shared = {.p = i == 1 ? test_random_polytope(&random, TEST_BOX, 8) : test_sphere(&random, 40),
                                .q = i == 2 ? test_random_polytope(&random, TEST_GRID, 20) : test_sphere(&random, 30)};
        pir_quat rotation = test_general_rotation(&random);
        pir_sum *sum = NULL;
        struct worker alone[1], together[THREADS];
        assert_int_equal(pir_sum_create(shared.p, shared.q, rotation, NULL, &sum), PIR_OK);
        assert_int_equal(pir_sum_mesh(sum, PIR_EXACT, &shared.mesh), PIR_OK);
        // of a body of its own: it would keep the others alive
        pir_polytope *body = test_sphere(&random, 30);
        assert_int_equal(pir_cgm_create(body, &rotation, NULL, &shared.cgm), PIR_OK);
        pir_polytope_release(body);
        pir_sum_destroy(sum);
        run_threads(&shared, alone, 1, false);
        run_threads(&shared, together, THREADS, true);
        for (int k = 0; k < THREADS; k++)
            expect(together[k].hash == alone[0].hash, "case %llu, thread %d", (unsigned long long)i, k);
        pir_cgm_release(shared.cgm);
        pir_mesh_destroy(shared.mesh);
    }
}

/* --- many updates at once --- */

/* Updates a thread; the environment may ask for more. */
static unsigned long updates(void) {
    const char *text = getenv("PIR_TEST_UPDATES");
    return text ? strtoul(text, NULL, 10) : 2 * LOOKS;
}

/* One of many on the same bodies: how often it updates, and the hash of what it saw on the way. */
struct updater {
    const struct shared *shared;
    unsigned long count;
    uint64_t hash;
    bool failed;
};

static void *update(void *context) {
    struct updater *updater = context;
    pir_quat rotation = {0.1, 0.2, 0.3, 0.9};
    pir_sum *sum = NULL;
    updater->hash = TEST_HASH_START;
    updater->failed = pir_sum_create(updater->shared->p, updater->shared->q, rotation, NULL, &sum) != PIR_OK;
    for (unsigned long i = 1; i <= updater->count && !updater->failed; i++) {
        rotation = test_compose((pir_quat){0.004, -0.003, 0.005, 1}, rotation, 1);
        updater->failed = pir_sum_rotate(sum, rotation, PIR_METHOD_AUTO) != PIR_OK;
        if (i % LOOKS == 0)
            updater->hash = test_hash_pairing(updater->hash, sum);
    }
    pir_sum_destroy(sum);
    return NULL;
}

static void threads_update_sums_of_the_same_bodies(void **state) {
    (void)state;
    test_random random = test_random_case("threads updates", 0);
    struct shared shared = {.p = test_sphere(&random, 12), .q = test_sphere(&random, 12)};
    struct updater alone = {&shared, updates(), 0, false}, together[UPDATERS];
    pthread_t threads[UPDATERS];
    for (int k = 0; k < UPDATERS; k++) {
        together[k] = alone;
        assert_int_equal(pthread_create(&threads[k], NULL, update, &together[k]), 0);
    }
    for (int k = 0; k < UPDATERS; k++)
        assert_int_equal(pthread_join(threads[k], NULL), 0);
    update(&alone);
    assert_false(alone.failed);
    for (int k = 0; k < UPDATERS; k++)
        expect(!together[k].failed && together[k].hash == alone.hash, "thread %d", k);
    pir_polytope_release(shared.q);
    pir_polytope_release(shared.p);
}

/* --- one sum, from thread to thread --- */

/* A sum that goes round; whoever has the turn rotates it. */
struct relay {
    pir_sum *sum;
    pir_quat rotation;
    pthread_mutex_t turn;
    bool failed;
};

static void *take_turns(void *context) {
    struct relay *relay = context;
    for (int i = 0; i < 25; i++) {
        pthread_mutex_lock(&relay->turn);
        relay->rotation = test_compose((pir_quat){0.01, 0.02, -0.01, 1}, relay->rotation, 1);
        pir_status status = pir_sum_rotate(relay->sum, relay->rotation, PIR_METHOD_AUTO);
        relay->failed = relay->failed || status != PIR_OK;
        pthread_mutex_unlock(&relay->turn);
    }
    return NULL;
}

static void a_sum_may_go_from_thread_to_thread(void **state) {
    (void)state;
    test_random random = test_random_case("threads relay", 0);
    pir_polytope *p = test_sphere(&random, 30), *q = test_sphere(&random, 30);
    struct relay relay = {.rotation = {0, 0, 0, 1}};
    pthread_t threads[THREADS];
    pir_sum *fresh = NULL;
    assert_int_equal(pthread_mutex_init(&relay.turn, NULL), 0);
    assert_int_equal(pir_sum_create(p, q, relay.rotation, NULL, &relay.sum), PIR_OK);
    for (int i = 0; i < THREADS; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, take_turns, &relay), 0);
    for (int i = 0; i < THREADS; i++)
        assert_int_equal(pthread_join(threads[i], NULL), 0);
    assert_false(relay.failed);
    assert_int_equal(pir_sum_create(p, q, relay.rotation, NULL, &fresh), PIR_OK);
    assert_true(pir_sum_same_pairing(relay.sum, fresh));
    pir_sum_destroy(fresh);
    pir_sum_destroy(relay.sum);
    pthread_mutex_destroy(&relay.turn);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_find_what_one_alone_finds),
        cmocka_unit_test(threads_update_sums_of_the_same_bodies),
        cmocka_unit_test(a_sum_may_go_from_thread_to_thread),
    };
    return cmocka_run_group_tests_name("threads", tests, NULL, NULL);
}
