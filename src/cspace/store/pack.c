/* SPDX-License-Identifier: MIT */
/* Chunks shuffled and deflated, as HDF5's filters of these names do. */
#include "cspace/store/pack.h"

#include <string.h>
#include <zlib.h>

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
    z_stream stream;
};

/* A chunk deflated into as much room as it takes itself; its length, or 0 where that is too little. */
static uint32_t deflate_chunk(const uint8_t *data, uint32_t size, z_stream *stream, uint8_t *ret_stream) {
    deflateReset(stream);
    stream->next_in = (z_const Bytef *)data;
    stream->avail_in = size;
    stream->next_out = ret_stream;
    stream->avail_out = size - 1;
    return deflate(stream, Z_FINISH) == Z_STREAM_END ? size - 1 - stream->avail_out : 0;
}

/* Appends the chunk behind its size; there is room for both. */
static void put_chunk(pir_bytes *packed, const uint8_t *data, uint32_t size, z_stream *stream) {
    uint8_t *head = packed->data + packed->used, *body = head + sizeof size;
    uint32_t deflated = deflate_chunk(data, size, stream, body);
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
        put_chunk(packed, chunk, size, &work->stream);
    }
    return true;
}

/*
 * Records are dense: to look for more than runs takes ten times as long and gains an eighth. Digits of doubles come
 * again in neighbouring numbers, where matches are worth their time.
 */
static int strategy_of(int section) {
    return pir_section_doubles[section] > 0 ? Z_DEFAULT_STRATEGY : Z_RLE;
}

bool pir_unit_pack(pir_unit *unit, const pir_allocator *allocator) {
    unit->work.used = 0;
    if (!pir_bytes_reserve(&unit->work, allocator, sizeof(struct work)))
        return false;
    struct work *work = (void *)unit->work.data;
    bool packed = true;
    for (int s = 0; packed && s < PIR_SECTION_COUNT; s++) {
        unit->packed[s].used = 0;
        if (unit->data[s].used == 0)
            continue;
        work->stream = (z_stream){0};
        packed = deflateInit2(&work->stream, PIR_DEFLATE_LEVEL, Z_DEFLATED, MAX_WBITS, MAX_MEM_LEVEL, strategy_of(s)) ==
                 Z_OK;
        if (!packed)
            break;
        packed = pack_section(unit, s, work, allocator);
        deflateEnd(&work->stream);
    }
    return packed;
}
