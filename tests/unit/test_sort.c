/* SPDX-License-Identifier: MIT */
/* Sorting and hashing, of which much else is made: every order, every length, each byte. */
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#include "base/byte_block.h"
#include "base/sort.h"
#include "support/random.h"

static bool key_before(void *context, uint32_t a, uint32_t b) {
    const uint32_t *key = context;
    return key[a] < key[b];
}

/* By few different keys, so that many tie; those keep their order. Nothing beyond the items is touched. */
static void items_come_in_order_and_ties_stay_as_they_were(void **state) {
    (void)state;
    enum { MOST = 300 };
    test_random random = test_random_case("sort", 0);
    for (int round = 0; round < 2000; round++) {
        uint32_t key[MOST], item[MOST + 1], work[MOST + 1];
        const uint32_t count = round < 40 ? (uint32_t)round : test_random_below(&random, MOST),
                       keys = 1 + test_random_below(&random, round % 2 ? 5 : 1000);
        for (uint32_t i = 0; i < count; i++) {
            key[i] = test_random_below(&random, keys);
            item[i] = i;
        }
        item[count] = work[count] = 12345;
        pir_sort(item, count, work, key_before, key);
        uint64_t sum = 0;
        for (uint32_t i = 0; i < count; i++) {
            assert_true(item[i] < count);
            sum += item[i];
            if (i > 0)
                expect(key[item[i - 1]] < key[item[i]] || (key[item[i - 1]] == key[item[i]] && item[i - 1] < item[i]),
                       "round %d, place %u of %u", round, i, count);
        }
        assert_true(sum == (uint64_t)count * (count > 0 ? count - 1 : 0) / 2);
        assert_true(item[count] == 12345 && work[count] == 12345);
    }
}

static void short_lists_of_keys_come_in_order(void **state) {
    (void)state;
    test_random random = test_random_case("sort short", 0);
    for (uint32_t count = 0; count < 40; count++) {
        uint64_t key[41], sum = 0, sorted = 0;
        for (uint32_t i = 0; i < count; i++)
            sum += key[i] = test_random_bits(&random) >> test_random_below(&random, 60);
        key[count] = 0;
        pir_sort_short(key, count);
        for (uint32_t i = 0; i < count; i++) {
            sorted += key[i];
            assert_true(i == 0 || key[i - 1] <= key[i]);
        }
        assert_true(sorted == sum && key[count] == 0);
    }
}

/* FNV-1a of known strings, and of the same bytes eight at a time as docs/slices.md has it. */
static void hashes_are_those_that_files_are_specified_with(void **state) {
    (void)state;
    static const struct {
        const char *text;
        uint64_t hash;
    } known[] = {{"", 0xcbf29ce484222325}, {"a", 0xaf63dc4c8601ec8c}, {"foobar", 0x85944171f73967e8}};
    for (int i = 0; i < 3; i++)
        expect(pir_hash_bytes(PIR_HASH_START, known[i].text, strlen(known[i].text)) == known[i].hash, "%s",
               known[i].text);
    uint8_t bytes[41];
    for (uint8_t k = 0; k < 41; k++)
        bytes[k] = (uint8_t)(7 * k + 1);
    for (size_t size = 0; size <= 40; size++) {
        uint64_t hash = PIR_HASH_START;
        for (size_t at = 0; at < size; at += 8) {
            uint64_t word = 0;
            for (size_t k = 0; k < 8 && at + k < size; k++)
                word |= (uint64_t)bytes[at + k] << (8 * k);
            hash = (hash ^ word) * 0x100000001b3;
        }
        expect(pir_hash_words(PIR_HASH_START, bytes, size) == hash, "%zu bytes", size);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(items_come_in_order_and_ties_stay_as_they_were),
        cmocka_unit_test(short_lists_of_keys_come_in_order),
        cmocka_unit_test(hashes_are_those_that_files_are_specified_with),
    };
    return cmocka_run_group_tests_name("sorting and hashing", tests, NULL, NULL);
}
