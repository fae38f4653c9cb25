/* SPDX-License-Identifier: MIT */
/*
 * Integers and the room that is reserved for them: what needs one limb more than there is ends the process, in every
 * build, before it writes past the end; what fits exactly goes through.
 */
#define _DEFAULT_SOURCE
#include "support/test.h"

#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "exact/vectors.h"

#define GUARD ((mp_limb_t)0x5bd1e995)
#define LIMBS 16

/* Shared with the process that is to end: operands all ones, and a result with guards behind its room. */
struct desk {
    mp_limb_t a[LIMBS], b[LIMBS], result[LIMBS + 4], scratch[4 * LIMBS];
};

/* Does one thing with `room` limbs for its result. */
typedef void operation(struct desk *desk, uint32_t room);

static pir_int result_of(struct desk *desk, int32_t size, uint32_t room) {
    return (pir_int){desk->result, size, room};
}

static void copy(struct desk *desk, uint32_t room) {
    pir_int a = {desk->a, -5, 0}, r = result_of(desk, 0, room);
    pir_int_copy(&r, &a);
}

static void multiply(struct desk *desk, uint32_t room) {
    pir_int a = {desk->a, 3, 0}, b = {desk->b, -2, 0}, r = result_of(desk, 0, room);
    pir_int_mul(&r, &a, &b);
}

static void multiply_by_a_limb(struct desk *desk, uint32_t room) {
    pir_int a = {desk->a, 1, 0}, b = {desk->b, 4, 0}, r = result_of(desk, 0, room);
    pir_int_mul(&r, &a, &b);
}

static void add_with_a_carry(struct desk *desk, uint32_t room) {
    pir_int a = {desk->a, 4, 0}, b = {desk->b, 2, 0}, r = result_of(desk, 0, room);
    pir_int_add(&r, &a, &b);
}

static void subtract_the_longer(struct desk *desk, uint32_t room) {
    pir_int a = {desk->a, 2, 0}, b = {desk->b, 5, 0}, r = result_of(desk, 0, room);
    pir_int_sub(&r, &a, &b);
}

static void add_nothing(struct desk *desk, uint32_t room) {
    pir_int a = {desk->a, 5, 0}, b = {desk->b, 0, 0}, r = result_of(desk, 0, room);
    pir_int_add(&r, &a, &b);
}

static void add_a_product(struct desk *desk, uint32_t room) {
    pir_int a = {desk->a, 3, 0}, b = {desk->b, 2, 0}, r = result_of(desk, 0, room);
    pir_limbs scratch = {desk->scratch, 0, 5};
    pir_int_add_mul(&r, &a, &b, &scratch);
}

static void shift_with_a_carry(struct desk *desk, uint32_t room) {
    pir_int a = {desk->a, 3, 0}, r = result_of(desk, 0, room);
    pir_int_shift_left(&r, &a, 64 + 1);
}

static void shift_by_whole_limbs(struct desk *desk, uint32_t room) {
    pir_int a = {desk->a, 3, 0}, r = result_of(desk, 0, room);
    pir_int_shift_left(&r, &a, 128);
}

static void set_a_double(struct desk *desk, uint32_t room) {
    pir_int r = result_of(desk, 0, room);
    pir_int_set_double(&r, 0x1p200, 0);
}

static void take_a_vector(struct desk *desk, uint32_t room) {
    pir_limbs limbs = {desk->result, 0, room};
    pir_int3_take(&limbs, 2);
}

static void write_to_a_view(struct desk *desk, uint32_t room) {
    pir_int a = {desk->a, 1, 0}, view = {desk->result, 1, room ? 1 : 0};
    pir_int_copy(&view, &a);
}

static void set_a_vector(struct desk *desk, uint32_t room) {
    int32_t sizes[3] = {0, 0, 0};
    pir_vectors vectors = {desk->result, sizes, 1, room};
    pir_int a = {desk->a, 2, 0}, zero = {desk->a, 0, 0};
    pir_vectors_set(&vectors, 0, &(pir_int3){{a, zero, zero}});
}

static const struct {
    const char *name;
    operation *perform;
    uint32_t need; /* limbs of its result */
} operations[] = {
    {"a copy", copy, 5},
    {"a product", multiply, 5},
    {"a product with one limb", multiply_by_a_limb, 5},
    {"a sum with a carry", add_with_a_carry, 5},
    {"a difference", subtract_the_longer, 5},
    {"a sum with zero", add_nothing, 5},
    {"a product added", add_a_product, 5},
    {"a shift with a carry", shift_with_a_carry, 5},
    {"a shift by whole limbs", shift_by_whole_limbs, 5},
    {"a double", set_a_double, 4},
    {"a vector from scratch", take_a_vector, 6},
    {"a view", write_to_a_view, 1},
    {"a vector in an array", set_a_vector, 2},
};

#define OPERATIONS (sizeof operations / sizeof *operations)

static void prepare(struct desk *desk, uint32_t room) {
    memset(desk, 0xff, sizeof *desk);
    for (uint32_t i = room; i < LIMBS + 4; i++)
        desk->result[i] = GUARD;
}

static bool guards_hold(const struct desk *desk, uint32_t room) {
    for (uint32_t i = room; i < LIMBS + 4; i++)
        if (desk->result[i] != GUARD)
            return false;
    return true;
}

static void what_fits_exactly_goes_through(void **state) {
    (void)state;
    struct desk desk;
    for (size_t i = 0; i < OPERATIONS; i++) {
        prepare(&desk, operations[i].need);
        operations[i].perform(&desk, operations[i].need);
        expect(guards_hold(&desk, operations[i].need), "%s", operations[i].name);
    }
}

static void what_does_not_fit_ends_the_process_and_writes_nothing_beyond(void **state) {
    (void)state;
    struct desk *desk = mmap(NULL, sizeof *desk, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(desk != MAP_FAILED);
    for (size_t i = 0; i < OPERATIONS; i++) {
        uint32_t room = operations[i].need - 1;
        prepare(desk, room);
        int line[2];
        assert_int_equal(pipe(line), 0);
        pid_t child = fork();
        if (child == 0) {
            if (dup2(line[1], STDERR_FILENO) < 0)
                _exit(1);
            signal(SIGABRT, SIG_DFL);
            operations[i].perform(desk, room);
            _exit(0);
        }
        int status = 0;
        char said[256] = "";
        close(line[1]);
        assert_true(read(line[0], said, sizeof said - 1) >= 0);
        close(line[0]);
        assert_int_equal(waitpid(child, &status, 0), child);
        expect(strstr(said, "pirouette: an integer would outgrow the memory") == said, "%s: '%s'", operations[i].name,
               said);
        expect(WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT, "%s", operations[i].name);
        expect(guards_hold(desk, room), "%s", operations[i].name);
    }
    munmap(desk, sizeof *desk);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_fits_exactly_goes_through),
        cmocka_unit_test(what_does_not_fit_ends_the_process_and_writes_nothing_beyond),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
