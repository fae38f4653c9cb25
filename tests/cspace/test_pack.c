/* SPDX-License-Identifier: MIT */
/*
 * Units packed as HDF5 keeps them: chunks come back from packed bytes as they were put in; packed bytes that were
 * changed are no chunks or others, and never more.
 */
#include "support/test.h"

#include <string.h>
#include <zlib.h>

#include "cspace/parts/pack.h"
#include "support/random.h"

/* No chunk is longer. */
#define CHUNK_MOST (1u << 16)

static uint8_t back[CHUNK_MOST];

/* A chunk as HDF5's filters bring it back. */
static void unpack(pir_unit_section s, const pir_chunk *chunk, uint8_t *ret_data) {
    const size_t size = (size_t)pir_chunk_elements[s] * pir_unit_section_element[s], count = size / 8;
    uLongf got = sizeof back;
    if (chunk->stored)
        memcpy(back, chunk->data, size);
    else
        assert_int_equal(uncompress(back, &got, chunk->data, chunk->size), Z_OK);
    assert_true(chunk->stored || got == size);
    for (size_t i = 0; i < size; i++)
        ret_data[i] = pir_unit_section_doubles[s] ? back[i % 8 * count + i / 8] : back[i];
}

static void put_random(pir_unit *unit, test_random *random, const pir_allocator *a) {
    for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++) {
        unit->count[s][0] = test_random_below(random, 3 * pir_chunk_elements[s]);
        unit->count[s][1] = test_random_below(random, 2) * test_random_below(random, 50);
        size_t size = (size_t)pir_unit_elements(unit, s) * pir_unit_section_element[s];
        unit->data[s].used = 0;
        assert_true(pir_bytes_reserve(&unit->data[s], a, size));
        // noise, which is stored as it is, few symbols, runs
        uint32_t symbols = 1 + test_random_below(random, 256), again = test_random_below(random, 3) * 20;
        for (size_t i = 0; i < size; i++) {
            bool runs = i > 0 && test_random_below(random, 41) < again;
            unit->data[s].data[i] = runs ? unit->data[s].data[i - 1] : (uint8_t)test_random_below(random, symbols);
        }
        unit->data[s].used = size;
    }
}

static void chunks_come_back(void **state) {
    (void)state;
    const pir_allocator a = pir_allocator_or_default(NULL);
    static uint8_t chunk_data[CHUNK_MOST];
    pir_unit unit;
    pir_packer *packer = pir_packer_new(&a);
    assert_true(packer && pir_unit_init(&unit, 2, &a));
    unit.slices = 2;
    for (unsigned number = 0; number < 20; number++) {
        test_random random = test_random_case("pack", number);
        put_random(&unit, &random, &a);
        assert_true(pir_unit_pack(&unit, packer, &a));
        for (pir_unit_section s = 0; s < PIR_UNIT_SECTION_COUNT; s++) {
            const pir_bytes *given = &unit.data[s];
            assert_true(pir_packed_holds(&unit.packed[s], s, pir_unit_elements(&unit, s)));
            size_t at = 0, done = 0, size = (size_t)pir_chunk_elements[s] * pir_unit_section_element[s];
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
    pir_packer_free(packer);
}

static void changed_bytes_are_no_more(void **state) {
    (void)state;
    const pir_allocator a = pir_allocator_or_default(NULL);
    pir_unit unit;
    pir_packer *packer = pir_packer_new(&a);
    assert_true(packer && pir_unit_init(&unit, 2, &a));
    unit.slices = 2;
    test_random random = test_random_case("changed", 0);
    put_random(&unit, &random, &a);
    assert_true(pir_unit_pack(&unit, packer, &a));
    pir_bytes *packed = &unit.packed[PIR_UNIT_SECTION_RECORDS];
    uint64_t elements = pir_unit_elements(&unit, PIR_UNIT_SECTION_RECORDS);
    assert_false(pir_packed_holds(packed, PIR_UNIT_SECTION_RECORDS, elements + 2 * pir_chunk_elements[0]));
    const size_t whole = packed->used;
    for (unsigned i = 0; i < 300; i++) {
        packed->used = whole - test_random_below(&random, (uint32_t)whole / 2);
        assert_false(packed->used < whole && pir_packed_holds(packed, PIR_UNIT_SECTION_RECORDS, elements));
        packed->data[test_random_below(&random, 8)] ^= (uint8_t)(1u << test_random_below(&random, 8));
        size_t at = 0;
        for (pir_chunk chunk; pir_next_chunk(packed, &at, &chunk);)
            assert_true(chunk.data + chunk.size <= packed->data + packed->used);
    }
    pir_unit_finish(&unit, &a);
    pir_packer_free(packer);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chunks_come_back),
        cmocka_unit_test(changed_bytes_are_no_more),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
