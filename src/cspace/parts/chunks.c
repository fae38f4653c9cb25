/* SPDX-License-Identifier: MIT */
/* Packed bytes taken apart. */
#include "cspace/parts/chunks.h"

#include <string.h>

bool pir_next_chunk(const pir_bytes *packed, size_t *at, pir_chunk *ret_chunk) {
    uint32_t head;
    if (packed->used - *at < sizeof head)
        return false;
    memcpy(&head, packed->data + *at, sizeof head);
    const uint32_t size = head & ~PIR_CHUNK_STORED;
    if (size == 0 || size > packed->used - *at - sizeof head)
        return false;
    *ret_chunk = (pir_chunk){packed->data + *at + sizeof head, size, (head & PIR_CHUNK_STORED) != 0};
    *at += sizeof head + size;
    return true;
}

bool pir_packed_holds(const pir_bytes *packed, pir_unit_section section, uint64_t elements) {
    const uint64_t most = (uint64_t)pir_chunk_elements[section] * pir_unit_section_element[section];
    uint64_t chunks = 0;
    size_t at = 0;
    for (pir_chunk chunk; pir_next_chunk(packed, &at, &chunk); chunks++)
        if (chunk.stored ? chunk.size != most : chunk.size >= most)
            return false;
    return at == packed->used && chunks == pir_chunks_of((int)section, elements);
}
