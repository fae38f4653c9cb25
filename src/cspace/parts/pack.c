/* SPDX-License-Identifier: MIT */
/* Chunks shuffled and deflated, as HDF5's filters of these names do. */
#include "cspace/parts/pack.h"

#include <libdeflate.h>
#include <string.h>

/*
 * How well deflate tries. Records are dense, and tables of numbers are little else once shuffled: to look for more than
 * their code and runs takes longer and gains nothing.
 */
static const int levels[PIR_PACK_WAYS] = {[PIR_PACK_RUNS] = 1, [PIR_PACK_MATCHES] = 4};

pir_packer *pir_packer_new(const pir_allocator *allocator) {
    pir_packer *packer = PIR_NEW(allocator, pir_packer, 1);
    if (!packer)
        return NULL;
    packer->allocator = *allocator;
    bool made = true;
    for (int i = 0; i < PIR_PACK_WAYS; i++) {
        packer->compressor[i] = libdeflate_alloc_compressor(levels[i]);
        made = made && packer->compressor[i];
    }
    if (made)
        return packer;
    pir_packer_free(packer);
    return NULL;
}

void pir_packer_free(pir_packer *packer) {
    if (!packer)
        return;
    const pir_allocator a = packer->allocator;
    for (int i = 0; i < PIR_PACK_WAYS; i++)
        libdeflate_free_compressor(packer->compressor[i]);
    PIR_FREE(&a, packer, 1);
}

/* Puts the first bytes of all numbers together, then the second ones, and so on: alike bytes deflate well. */
static void shuffle(const uint8_t *data, uint32_t size, uint32_t element, uint8_t *ret_shuffled) {
    uint32_t count = size / element;
    for (uint32_t byte = 0; byte < element; byte++)
        for (uint32_t i = 0; i < count; i++)
            *ret_shuffled++ = data[i * element + byte];
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
    struct libdeflate_compressor *compressor = packer->compressor[form->again ? PIR_PACK_MATCHES : PIR_PACK_RUNS];
    // what does not get shorter is stored
    const size_t size = libdeflate_zlib_compress(compressor, bytes, form->size, packer->deflated, form->size - 1);
    return size ? (pir_chunk){packer->deflated, (uint32_t)size, false} : (pir_chunk){bytes, form->size, true};
}

static bool pack_section(pir_unit *unit, int s, pir_packer *packer, const pir_allocator *a) {
    const pir_bytes *data = &unit->data[s];
    const uint32_t size = pir_chunk_elements[s] * pir_unit_section_element[s];
    // digits of doubles come again in neighbouring numbers
    const bool doubles = pir_unit_section_doubles[s] > 0;
    const pir_chunk_form form = {size, doubles ? (uint32_t)sizeof(double) : 1, doubles};
    pir_bytes *packed = &unit->packed[s];
    for (size_t at = 0; at < data->used; at += size) {
        if (!pir_bytes_reserve(packed, a, sizeof(uint32_t) + size))
            return false;
        size_t left = data->used - at;
        pir_chunk chunk = pir_pack_chunk(packer, &form, data->data + at, left < size ? (uint32_t)left : size);
        const uint32_t head = chunk.size | (chunk.stored ? PIR_CHUNK_STORED : 0);
        memcpy(packed->data + packed->used, &head, sizeof head);
        memcpy(packed->data + packed->used + sizeof head, chunk.data, chunk.size);
        packed->used += sizeof head + chunk.size;
    }
    return true;
}

bool pir_unit_pack(pir_unit *unit, pir_packer *packer, const pir_allocator *allocator) {
    bool packed = true;
    for (int s = 0; packed && s < PIR_UNIT_SECTION_COUNT; s++) {
        unit->packed[s].used = 0;
        packed = pack_section(unit, s, packer, allocator);
    }
    return packed;
}
