/* SPDX-License-Identifier: MIT */
/*
 * Blocks have count·size bytes whenever they are asked for, resized and given back; what does not fit a size_t is
 * never asked for. Reports hold one line.
 */
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <pirouette/io.h>

#include "base/memory.h"
#include "base/report.h"
#include "support/random.h"

/* What an allocator was told last; it gives no more than a page. */
struct told {
    uint64_t requests;
    size_t old_size, new_size;
};

static void *listen(void *context, void *block, size_t old_size, size_t new_size) {
    struct told *told = context;
    told->requests++;
    told->old_size = old_size;
    told->new_size = new_size;
    if (new_size > 4096)
        return NULL;
    if (new_size == 0) {
        free(block);
        return NULL;
    }
    return realloc(block, new_size);
}

static void sizes_are_products_or_nothing_is_asked_for(void **state) {
    (void)state;
    struct told told = {0, 1, 1};
    const pir_allocator allocator = {listen, &told};
    static const size_t sizes[] = {2, 3, 8, 24};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        size_t size = sizes[i], most = SIZE_MAX / size;
        // the last that fits is asked for, and refused; the next one is not even asked for
        assert_null(pir_memory_new(&allocator, most, size));
        assert_true(told.new_size == most * size && told.old_size == 0);
        uint64_t requests = told.requests;
        assert_null(pir_memory_new(&allocator, most + 1, size));
        assert_int_equal(told.requests, requests);
        // no element takes the room of one
        void *block = pir_memory_new(&allocator, 0, size);
        assert_non_null(block);
        assert_int_equal(told.new_size, size);
        requests = told.requests;
        assert_null(pir_memory_resize(&allocator, block, 0, most + 1, size));
        assert_int_equal(told.requests, requests);
        block = pir_memory_resize(&allocator, block, 0, 3, size);
        assert_true(told.old_size == size && told.new_size == 3 * size);
        pir_memory_free(&allocator, block, 3, size);
        assert_true(told.old_size == 3 * size && told.new_size == 0);
        // a block that is not there has no size, whatever count goes with it, and is not given back
        block = pir_memory_resize(&allocator, NULL, 5, 7, size);
        assert_true(told.old_size == 0 && told.new_size == 7 * size);
        pir_memory_free(&allocator, block, 7, size);
        requests = told.requests;
        pir_memory_free(&allocator, NULL, 3, size);
        assert_int_equal(told.requests, requests);
    }
    unsigned char *zeroed = pir_memory_zeroed(&allocator, 100, 3);
    assert_non_null(zeroed);
    for (int i = 0; i < 300; i++)
        assert_int_equal(zeroed[i], 0);
    pir_memory_free(&allocator, zeroed, 100, 3);
    assert_null(pir_memory_zeroed(&allocator, 5000, 1));
}

/* Large blocks that last are zeroed, on huge pages where the kernel has them, and may grow and go as others. */
static void large_blocks_that_last_begin_with_a_huge_page(void **state) {
    (void)state;
    const pir_allocator allocator = pir_allocator_or_default(NULL);
    const size_t page = (size_t)2 << 20, sizes[] = {1, 4096, 2 * page - 1, 2 * page, 2 * page + 1, 3 * page};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        unsigned char *block = pir_memory_lasting(&allocator, sizes[i]);
        assert_non_null(block);
        for (size_t k = 0; k < sizes[i]; k += 509)
            assert_int_equal(block[k], 0);
        assert_int_equal(block[sizes[i] - 1], 0);
#ifdef __linux__
        if (sizes[i] >= 2 * page)
            expect((uintptr_t)block % page == 0, "%zu bytes", sizes[i]);
#endif
        block[sizes[i] - 1] = 7;
        block = pir_memory_resize(&allocator, block, sizes[i], sizes[i] + 5, 1);
        assert_true(block && block[sizes[i] - 1] == 7);
        pir_memory_free(&allocator, block, sizes[i] + 5, 1);
    }
}

/* The default allocator gives back what it gave. */
static void nothing_stays_with_malloc(void **state) {
    (void)state;
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
    const pir_allocator allocator = pir_allocator_or_default(NULL);
    size_t before = 0, after = 0;
    for (int i = 0; i < 100; i++) {
        char *block = pir_memory_new(&allocator, 1000, 16);
        block = pir_memory_resize(&allocator, block, 1000, 2000, 16);
        assert_non_null(block);
        memset(block, i, 32000);
        pir_memory_free(&allocator, block, 2000, 16);
        struct mallinfo2 now = mallinfo2();
        after = now.uordblks + now.hblkhd;
        before = i == 0 ? after : before;
    }
    assert_true(after < before + 32000);
#else
    skip();
#endif
}

static void reports_are_one_line(void **state) {
    (void)state;
    pir_report report;
    pir_polytope *p = NULL;
    assert_int_equal(pir_polytope_read("no\nsuch\rfile\r\nat all.off", NULL, &report, NULL, &p), PIR_ERR_FILE);
    assert_null(strpbrk(report.text, "\r\n"));
    assert_non_null(strstr(report.text, "no such file  at all.off"));
    assert_int_equal(pir_fail(&report, PIR_ERR_FORMAT, "\n%s\r%d\n", "a", 7), PIR_ERR_FORMAT);
    assert_string_equal(report.text, " a 7 ");
    assert_int_equal(report.status, PIR_ERR_FORMAT);
    assert_int_equal(pir_fail(NULL, PIR_ERR_LIMIT, "x"), PIR_ERR_LIMIT);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes_are_products_or_nothing_is_asked_for),
        cmocka_unit_test(large_blocks_that_last_begin_with_a_huge_page),
        cmocka_unit_test(nothing_stays_with_malloc),
        cmocka_unit_test(reports_are_one_line),
    };
    return cmocka_run_group_tests_name("memory", tests, NULL, NULL);
}
