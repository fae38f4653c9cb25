/* SPDX-License-Identifier: MIT */
/* Chunks shuffled and deflated, as HDF5's filters of these names do. */
#include "cspace/store/pack.h"

#include <string.h>
#include <zlib.h>

#include "cspace/store/deflate.h"

/* The most bytes of a chunk. */
#define CHUNK_MOST (1u << 16)

/* What doubles are shuffled by: the first bytes of all, then the second ones. */
static void shuffle(const uint8_t *data, size_t size, uint8_t *ret_shuffled) {
    size_t count = size / sizeof(double);
    for (size_t byte = 0; byte < sizeof(double); byte++)
        for (size_t i = 0; i < count; i++)
            *ret_shuffled++ = data[i * sizeof(double) + byte];
}

/* What packing works on. */
struct work {
    uint8_t filled[CHUNK_MOST], shuffled[CHUNK_MOST];
    pir_deflate_work deflate;
};

/* A chunk deflated into as much room as it takes itself; its length, or 0 where that is too little. */
static size_t deflate_chunk(const uint8_t *data, uint32_t size, bool doubles, struct work *work, uint8_t *ret_stream) {
    if (!doubles)
        return pir_deflate(data, size, &work->deflate, ret_stream, size);
    // digits come again in neighbouring numbers: matches are worth their time here
    uLongf length = size - 1;
    return compress2(ret_stream, &length, data, size, PIR_DEFLATE_LEVEL) == Z_OK ? length : 0;
}

/* Appends the chunk behind its size; there is room for both. */
static void put_chunk(pir_bytes *packed, const uint8_t *data, uint32_t size, bool doubles, struct work *work) {
    uint8_t *head = packed->data + packed->used, *body = head + sizeof size;
    uint32_t deflated = (uint32_t)deflate_chunk(data, size, doubles, work, body);
    if (deflated == 0)
        memcpy(body, data, size);
    const uint32_t value = deflated ? deflated : size | PIR_CHUNK_STORED;
    memcpy(head, &value, sizeof value);
    packed->used += sizeof value + (deflated ? deflated : size);
}

static bool pack_section(pir_unit *unit, int s, struct work *work, const pir_allocator *a) {
    const pir_bytes *data = &unit->data[s];
    const uint32_t size = pir_chunk_elements[s] * pir_section_element[s];
    const bool doubles = pir_section_doubles[s] > 0;
    pir_bytes *packed = &unit->packed[s];
    packed->used = 0;
    for (size_t at = 0; at < data->used; at += size) {
        const uint8_t *chunk = data->data + at;
        if (!pir_bytes_reserve(packed, a, sizeof size + size))
            return false;
        if (data->used - at < size) {
            memcpy(work->filled, chunk, data->used - at);
            memset(work->filled + (data->used - at), 0, size - (data->used - at));
            chunk = work->filled;
        }
        if (doubles) {
            shuffle(chunk, size, work->shuffled);
            chunk = work->shuffled;
        }
        put_chunk(packed, chunk, size, doubles, work);
    }
    return true;
}

bool pir_unit_pack(pir_unit *unit, const pir_allocator *allocator) {
    unit->work.used = 0;
    if (!pir_bytes_reserve(&unit->work, allocator, sizeof(struct work)))
        return false;
    void *work = unit->work.data;
    for (int s = 0; s < PIR_SECTION_COUNT; s++)
        if (!pack_section(unit, s, work, allocator))
            return false;
    return true;
}
