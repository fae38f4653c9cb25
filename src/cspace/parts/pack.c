/* SPDX-License-Identifier: MIT */
/* Chunks shuffled and deflated, as HDF5's filters of these names do. */
#include "cspace/parts/pack.h"

#include <string.h>
#include <zlib.h>

#include "cspace/parts/deflate.h"

struct pir_packer {
    pir_allocator allocator;
    z_stream for_matches;
    bool begun; /* the stream */
    pir_byte_run run[PIR_RUNS_MOST];
    uint8_t filled[PIR_CHUNK_MOST], shuffled[PIR_CHUNK_MOST], deflated[PIR_CHUNK_MOST + PIR_DEFLATE_SLACK];
};

_Static_assert(PIR_CHUNK_MOST <= PIR_DEFLATE_MOST, "a chunk is deflated at a time");

pir_packer *pir_packer_new(const pir_allocator *allocator) {
    pir_packer *packer = PIR_NEW(allocator, pir_packer, 1);
    if (!packer)
        return NULL;
    packer->allocator = *allocator;
    packer->begun = false;
    return packer;
}

void pir_packer_free(pir_packer *packer) {
    if (!packer)
        return;
    const pir_allocator a = packer->allocator;
    if (packer->begun)
        deflateEnd(&packer->for_matches);
    PIR_FREE(&a, packer, 1);
}

/* What numbers are shuffled by: the first bytes of all, then the second ones. */
static void shuffle(const uint8_t *data, uint32_t size, uint32_t element, uint8_t *ret_shuffled) {
    uint32_t count = size / element;
    for (uint32_t byte = 0; byte < element; byte++)
        for (uint32_t i = 0; i < count; i++)
            *ret_shuffled++ = data[i * element + byte];
}

/* Makes the stream ready; false when out of memory. Few files need it. */
static bool begin_matches(pir_packer *packer) {
    z_stream *stream = &packer->for_matches;
    if (packer->begun)
        return deflateReset(stream) == Z_OK;
    *stream = (z_stream){0};
    packer->begun = deflateInit(stream, PIR_DEFLATE_LEVEL) == Z_OK;
    return packer->begun;
}

/* Deflates with a look at all that comes again. Returns the bytes that it gives; 0 where there are no fewer of them. */
static uint32_t deflate_matches(pir_packer *packer, const uint8_t *data, uint32_t size) {
    z_stream *stream = &packer->for_matches;
    stream->next_in = (z_const Bytef *)data;
    stream->avail_in = size;
    stream->next_out = packer->deflated;
    stream->avail_out = size - 1;
    return deflate(stream, Z_FINISH) == Z_STREAM_END ? size - 1 - stream->avail_out : 0;
}

pir_chunk pir_pack_chunk(pir_packer *packer, const pir_chunk_form *form, const void *data, uint32_t used) {
    const uint8_t *bytes = data;
    if (used < form->size) {
        memcpy(packer->filled, data, used);
        memset(packer->filled + used, 0, form->size - used);
        bytes = packer->filled;
    }
    if (form->element > 1) {
        shuffle(bytes, form->size, form->element, packer->shuffled);
        bytes = packer->shuffled;
    }
    if (form->again && !begin_matches(packer))
        return (pir_chunk){NULL, 0, false};
    const uint32_t size = form->again ? deflate_matches(packer, bytes, form->size)
                                      : pir_deflate_runs(bytes, form->size, packer->run, packer->deflated);
    // what does not get shorter is stored
    return size > 0 ? (pir_chunk){packer->deflated, size, false} : (pir_chunk){bytes, form->size, true};
}

static bool pack_section(pir_unit *unit, int s, pir_packer *packer, const pir_allocator *a) {
    const pir_bytes *data = &unit->data[s];
    const uint32_t size = pir_chunk_elements[s] * pir_section_element[s];
    // digits of doubles come again in neighbouring numbers
    const bool doubles = pir_section_doubles[s] > 0;
    const pir_chunk_form form = {size, doubles ? (uint32_t)sizeof(double) : 1, doubles};
    pir_bytes *packed = &unit->packed[s];
    for (size_t at = 0; at < data->used; at += size) {
        if (!pir_bytes_reserve(packed, a, sizeof(uint32_t) + size))
            return false;
        size_t left = data->used - at;
        pir_chunk chunk = pir_pack_chunk(packer, &form, data->data + at, left < size ? (uint32_t)left : size);
        if (!chunk.data)
            return false;
        const uint32_t head = chunk.size | (chunk.stored ? PIR_CHUNK_STORED : 0);
        memcpy(packed->data + packed->used, &head, sizeof head);
        memcpy(packed->data + packed->used + sizeof head, chunk.data, chunk.size);
        packed->used += sizeof head + chunk.size;
    }
    return true;
}

bool pir_unit_pack(pir_unit *unit, pir_packer *packer, const pir_allocator *allocator) {
    bool packed = true;
    for (int s = 0; packed && s < PIR_SECTION_COUNT; s++) {
        unit->packed[s].used = 0;
        packed = pack_section(unit, s, packer, allocator);
    }
    return packed;
}
