/* SPDX-License-Identifier: MIT */
/*
 * Plans by any motion where memory runs out at the n-th request: the call says so, or gives the answer that it gives
 * with plenty; its journal keeps all that it had, and a call that goes on with it writes the same proof. The linker
 * gives __wrap_X the calls of X that the library makes; GMP's numbers are not among them.
 *
 * Without PIR_TEST_CASES, some n; with it, that many for each question, evenly.
 */
#include "gates.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

/* Requests so far, the one that fails, 0 for none, and the last one for a name, which is that of the journal. */
static atomic_ulong requests, failing, naming;

static bool fails(void) {
    return atomic_fetch_add(&requests, 1) + 1 == atomic_load(&failing);
}

void *__real_malloc(size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_malloc(size_t size) {
    return fails() ? NULL : __real_malloc(size);
}

void *__real_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size) {
    return fails() ? NULL : __real_calloc(count, size);
}

void *__real_realloc(void *block, size_t size);
void *__wrap_realloc(void *block, size_t size);
void *__wrap_realloc(void *block, size_t size) {
    return fails() ? NULL : __real_realloc(block, size);
}

char *__real_strdup(const char *text);
char *__wrap_strdup(const char *text);
char *__wrap_strdup(const char *text) {
    atomic_store(&naming, atomic_load(&requests) + 1);
    return fails() ? NULL : __real_strdup(text);
}

FILE *__real_open_memstream(char **text, size_t *size);
FILE *__wrap_open_memstream(char **text, size_t *size);
FILE *__wrap_open_memstream(char **text, size_t *size) {
    return fails() ? NULL : __real_open_memstream(text, size);
}

/* A tetrahedron before a window of four sides. */
struct question {
    pir_solid *robot, *wall[4];
    pir_rigid_plan_input input;
    uint32_t boxes, boxes_alone;
    pir_turn_plan_answer answer;
    char journal[32], *proof; /* the text of a proof where there is no path */
    size_t proof_size;
};

/* With half an edge of a cube about the tetrahedron, and half the width of the window. */
static void make_question(double e, double x, uint32_t boxes, pir_turn_plan_answer answer, struct question *q) {
    const pir_vec3 corner[4] = {{e, e, e}, {e, -e, -e}, {-e, e, -e}, {-e, -e, e}};
    *q = (struct question){.boxes = boxes, .boxes_alone = 1, .answer = answer, .journal = "rigid_memory_XXXXXX"};
    q->robot = make_simplex(corner);
    q->input = make_gate_of(2 * x, 2 * x, 2 * e + 1, &q->robot, q->wall, NULL);
    const int descriptor = mkstemp(q->journal);
    assert_true(descriptor >= 0);
    close(descriptor);
}

static void release(struct question *q) {
    for (int i = 0; i < 4; i++)
        pir_solid_release(q->wall[i]);
    pir_solid_release(q->robot);
    unlink(q->journal);
    free(q->proof);
}

/* The text of a file. */
static char *text_of(FILE *file, size_t *ret_size) {
    fseek(file, 0, SEEK_END);
    *ret_size = (size_t)ftell(file);
    char *text = __real_calloc(*ret_size + 1, 1);
    rewind(file);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, *ret_size, file), *ret_size);
    return text;
}

/* Asks while request `n` fails; whether the answer was given, which is then the right one. */
static bool ask(struct question *q, unsigned long n, uint32_t threads, bool resume) {
    pir_rigid_plan *const before = (pir_rigid_plan *)&before;
    pir_rigid_plan *plan = before;
    pir_report report = {0};
    pir_rigid_plan_options options = pir_rigid_plan_options_default();
    options.boxes = q->boxes;
    options.boxes_alone = q->boxes_alone;
    options.threads = threads;
    options.proof = tmpfile();
    options.journal = q->journal;
    options.resume = resume;
    options.report = &report;
    assert_non_null(options.proof);
    atomic_store(&requests, 0);
    atomic_store(&failing, n);
    const pir_status status = pir_rigid_plan_create(&q->input, &options, &plan);
    atomic_store(&failing, 0);
    if (status == PIR_OK) {
        pir_rigid_plan_info info;
        size_t size;
        pir_rigid_plan_describe(plan, &info);
        expect(info.answer == q->answer, "request %lu: answer %d", n, (int)info.answer);
        char *text = text_of(options.proof, &size);
        if (q->answer == PIR_TURN_PLAN_NO_PATH && q->proof)
            expect(size == q->proof_size && memcmp(text, q->proof, size) == 0, "request %lu: another proof", n);
        free(q->proof);
        q->proof = text;
        q->proof_size = size;
        pir_rigid_plan_destroy(plan);
    } else {
        expect(status == PIR_ERR_MEMORY, "request %lu: %s", n, report.text);
        assert_ptr_equal(plan, before);
        assert_int_equal(report.status, PIR_ERR_MEMORY);
        assert_non_null(strstr(report.text, "out of memory"));
    }
    fclose(options.proof);
    return status == PIR_OK;
}

static long long size_of_journal(const struct question *q) {
    struct stat file;
    return stat(q->journal, &file) == 0 ? (long long)file.st_size : -1;
}

/* Lets request `n` fail in a call, in one that goes on with its journal, and goes on with that. */
static void try_request(struct question *q, unsigned long n, uint32_t threads, bool goes_on, unsigned *failures) {
    const bool is_given = ask(q, n, threads, false);
    *failures += !is_given;
    if (is_given || !goes_on)
        return;
    const long long kept = size_of_journal(q);
    if (!ask(q, n / 2 + 1, threads, true)) {
        expect(size_of_journal(q) >= kept, "request %lu: the journal has lost something", n);
        expect(ask(q, 0, threads, true), "request %lu: the journal is of no use", n);
    }
}

/* Requests in the order of their numbers, closer in the beginning, or all that are asked for. */
static void try_all(struct question *q) {
    const char *told = getenv("PIR_TEST_CASES");
    const unsigned long cases = told ? strtoul(told, NULL, 10) : 0;
    for (uint32_t threads = 1; threads <= 2; threads++) {
        expect(ask(q, 0, threads, false), "with plenty");
        const unsigned long all = atomic_load(&requests);
        const unsigned long step = cases == 0 ? 0 : cases < all ? all / cases : 1;
        unsigned tries = 0, failures = 0;
        for (unsigned long n = 1; n <= all; n += step > 0 ? step : threads * n, tries++)
            try_request(q, n, threads, tries % 8 == 7, &failures);
        printf("%u threads: %lu requests, %u failures in %u tries\n", threads, all, failures, tries);
        assert_true(failures > tries / 2);
    }
}

/* The first boxes decide. */
static void test_no_path(void **state) {
    (void)state;
    struct question q;
    make_question(16 / sqrt(3), 1, 32, PIR_TURN_PLAN_NO_PATH, &q);
    try_all(&q);
    release(&q);
}

/* A wall is found, and its planes divided. */
static void test_opening(void **state) {
    (void)state;
    struct question q;
    make_question(16 / sqrt(3), .5, 3200, PIR_TURN_PLAN_NO_PATH, &q);
    q.boxes_alone = 0;
    try_all(&q);
    assert_non_null(strstr(q.proof, "openings"));
    release(&q);
}

static void test_path(void **state) {
    (void)state;
    struct question q;
    make_question(.5, 1.5, 32, PIR_TURN_PLAN_PATH, &q);
    try_all(&q);
    release(&q);
}

/* Boxes take all their sums, and are divided, until the budget ends. Then its journal is read, which loses nothing. */
static void test_unknown(void **state) {
    (void)state;
    struct question q;
    make_question(16 / sqrt(3), 1.9, 60, PIR_TURN_PLAN_UNKNOWN, &q);
    try_all(&q);
    assert_true(ask(&q, 0, 1, false));
    const long long kept = size_of_journal(&q);
    const unsigned long first = atomic_load(&naming);
    assert_true(ask(&q, 0, 1, true));
    const unsigned long all = atomic_load(&requests);
    for (unsigned long n = first - 1; n < first + 8; n++) {
        const bool is_given = ask(&q, n, 1, true);
        expect(size_of_journal(&q) >= kept, "request %lu: the journal has lost something", n);
        expect(!is_given || atomic_load(&requests) < all + all / 2, "request %lu: boxes are made again", n);
    }
    release(&q);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_no_path), cmocka_unit_test(test_opening),
                                       cmocka_unit_test(test_path), cmocka_unit_test(test_unknown)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
