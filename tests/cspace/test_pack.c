/* SPDX-License-Identifier: MIT */
/*
 * Units packed as HDF5 keeps them: what is deflated comes back from zlib, whatever the bytes; chunks come back from
 * packed bytes as they were put in; packed bytes that were changed are no chunks or others, and never more.
 */
#include "support/test.h"

#include <string.h>
#include <zlib.h>

#include "cspace/store/deflate.h"
#include "cspace/store/pack.h"
#include "support/random.h"

#define CASES 600

static uint8_t data[PIR_DEFLATE_MOST], stream[PIR_DEFLATE_MOST + 1024], back[PIR_DEFLATE_MOST];
static pir_deflate_work work;

/* Weights of symbols that grow as Fibonacci's numbers make the deepest codes. */
static void fill_deep(test_random *random, size_t size) {
    size_t at = 0, run = 1, before = 1;
    for (uint8_t symbol = 0; at < size; symbol++) {
        for (size_t i = 0; i < run && at < size; i++)
            data[at++] = symbol;
        size_t sum = run + before;
        before = run;
        run = sum;
    }
    for (size_t i = size - 1; i > 0; i--) {
        size_t other = test_random_below(random, (uint32_t)i + 1);
        uint8_t moved = data[i];
        data[i] = data[other];
        data[other] = moved;
    }
}

/* Bytes of many kinds: noise, few symbols, runs, one byte alone, deep codes. */
static size_t fill(test_random *random, unsigned number) {
    size_t size = 1 + test_random_below(random, number % 8 == 0 ? PIR_DEFLATE_MOST : 400);
    uint32_t kind = test_random_below(random, 5), symbols = kind == 0 ? 256 : 1 + test_random_below(random, 20);
    if (kind == 4) {
        fill_deep(random, size);
        return size;
    }
    for (size_t i = 0; i < size; i++) {
        bool again = i > 0 && kind == 2 && test_random_below(random, 40) > 0;
        data[i] = again ? data[i - 1] : kind == 3 ? 7 : (uint8_t)test_random_below(random, symbols);
    }
    return size;
}

static void zlib_reads_what_is_deflated(void **state) {
    (void)state;
    for (unsigned number = 0; number < CASES; number++) {
        test_random random = test_random_case("deflate", number);
        size_t size = fill(&random, number), length = pir_deflate(data, size, &work, stream, sizeof stream);
        uLongf got = sizeof back;
        expect(length > 0 && uncompress(back, &got, stream, (uLong)length) == Z_OK && got == size &&
                   memcmp(back, data, size) == 0,
               "case %u: %zu bytes", number, size);
        // no more room than it takes is too little, and what is behind the room stays
        stream[length - 1] = 0xa5;
        assert_int_equal(pir_deflate(data, size, &work, stream, length - 1), 0);
        assert_int_equal(stream[length - 1], 0xa5);
        assert_int_equal(pir_deflate(data, size, &work, stream, length + 1), length);
    }
}

/* A chunk as HDF5's filters bring it back. */
static void unpack(pir_section s, const pir_chunk *chunk, uint8_t *ret_data) {
    const size_t size = (size_t)pir_chunk_elements[s] * pir_section_element[s], count = size / 8;
    uLongf got = sizeof back;
    if (chunk->stored)
        memcpy(back, chunk->data, size);
    else
        assert_int_equal(uncompress(back, &got, chunk->data, chunk->size), Z_OK);
    assert_true(chunk->stored || got == size);
    for (size_t i = 0; i < size; i++)
        ret_data[i] = pir_section_doubles[s] ? back[i % 8 * count + i / 8] : back[i];
}

static void put_random(pir_unit *unit, test_random *random, const pir_allocator *a) {
    for (int s = 0; s < PIR_SECTION_COUNT; s++) {
        unit->count[s][0] = test_random_below(random, 3 * pir_chunk_elements[s]);
        unit->count[s][1] = test_random_below(random, 2) * test_random_below(random, 50);
        size_t size = (size_t)pir_unit_elements(unit, s) * pir_section_element[s];
        unit->data[s].used = 0;
        assert_true(pir_bytes_reserve(&unit->data[s], a, size));
        uint32_t symbols = 1 + test_random_below(random, 256);
        for (size_t i = 0; i < size; i++)
            unit->data[s].data[i] = (uint8_t)test_random_below(random, symbols);
        unit->data[s].used = size;
    }
}

static void chunks_come_back(void **state) {
    (void)state;
    const pir_allocator a = pir_allocator_or_default(NULL);
    static uint8_t chunk_data[PIR_DEFLATE_MOST];
    pir_unit unit;
    assert_true(pir_unit_init(&unit, 2, &a));
    unit.slices = 2;
    for (unsigned number = 0; number < 20; number++) {
        test_random random = test_random_case("pack", number);
        put_random(&unit, &random, &a);
        assert_true(pir_unit_pack(&unit, &a));
        for (pir_section s = 0; s < PIR_SECTION_COUNT; s++) {
            const pir_bytes *given = &unit.data[s];
            assert_true(pir_packed_holds(&unit.packed[s], s, pir_unit_elements(&unit, s)));
            size_t at = 0, done = 0, size = (size_t)pir_chunk_elements[s] * pir_section_element[s];
            for (pir_chunk chunk; pir_next_chunk(&unit.packed[s], &at, &chunk); done += size) {
                unpack(s, &chunk, chunk_data);
                size_t own = given->used - done < size ? given->used - done : size;
                assert_memory_equal(chunk_data, given->data + done, own);
                for (size_t i = own; i < size; i++)
                    assert_int_equal(chunk_data[i], 0);
            }
            assert_true(done >= given->used && done < given->used + size);
        }
    }
    pir_unit_finish(&unit, &a);
}

static void changed_bytes_are_no_more(void **state) {
    (void)state;
    const pir_allocator a = pir_allocator_or_default(NULL);
    pir_unit unit;
    assert_true(pir_unit_init(&unit, 2, &a));
    unit.slices = 2;
    test_random random = test_random_case("changed", 0);
    put_random(&unit, &random, &a);
    assert_true(pir_unit_pack(&unit, &a));
    pir_bytes *packed = &unit.packed[PIR_SECTION_RECORDS];
    uint64_t elements = pir_unit_elements(&unit, PIR_SECTION_RECORDS);
    assert_false(pir_packed_holds(packed, PIR_SECTION_RECORDS, elements + 2 * pir_chunk_elements[0]));
    const size_t whole = packed->used;
    for (unsigned i = 0; i < 300; i++) {
        packed->used = whole - test_random_below(&random, (uint32_t)whole / 2);
        assert_false(packed->used < whole && pir_packed_holds(packed, PIR_SECTION_RECORDS, elements));
        packed->data[test_random_below(&random, 8)] ^= (uint8_t)(1u << test_random_below(&random, 8));
        size_t at = 0;
        for (pir_chunk chunk; pir_next_chunk(packed, &at, &chunk);)
            assert_true(chunk.data + chunk.size <= packed->data + packed->used);
    }
    pir_unit_finish(&unit, &a);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(zlib_reads_what_is_deflated),
        cmocka_unit_test(chunks_come_back),
        cmocka_unit_test(changed_bytes_are_no_more),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
