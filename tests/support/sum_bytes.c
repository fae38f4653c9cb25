/* SPDX-License-Identifier: MIT */
#include "support/sum_bytes.h"

#include <stdlib.h>

#include "dymsum/file/sum_file.h"

test_bytes test_bytes_of(const pir_sum *sum) {
    test_bytes bytes = {NULL, pir_sum_serialised_size(sum)};
    bytes.data = malloc(bytes.size);
    if (bytes.data && pir_sum_serialise(sum, bytes.data, bytes.size) != PIR_OK) {
        free(bytes.data);
        bytes.data = NULL;
    }
    return bytes;
}

static void put_u64(uint8_t *to, uint64_t value) {
    for (int k = 0; k < 8; k++)
        to[k] = (uint8_t)(value >> (8 * k));
}

void test_bytes_seal(uint8_t *data, size_t size) {
    put_u64(data + PIR_SUM_CHECKSUM_AT - 8, size);
    put_u64(data + PIR_SUM_CHECKSUM_AT, pir_sum_file_checksum(data, size));
}
