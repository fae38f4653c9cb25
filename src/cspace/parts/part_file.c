/* SPDX-License-Identifier: MIT */
/* Units in parts, read and checked. */
#include "cspace/parts/part_file.h"
#include "cspace/parts/pack.h"

#include <stddef.h>
#include <string.h>

#include "polytope/file/file_places.h"

#define HASH_START UINT64_C(0x9e3779b97f4a7c15)

/* A hash of more bytes, eight at a time: parts are read back by who wrote them. */
static uint64_t hash_more(uint64_t hash, const void *data, size_t size) {
    const uint8_t *at = data;
    for (; size > 0; size -= size < 8 ? size : 8, at += 8) {
        uint64_t word = size;
        memcpy(&word, at, size < 8 ? size : 8);
        hash = (hash ^ word) * UINT64_C(0xff51afd7ed558ccd);
        hash ^= hash >> 32;
    }
    return hash;
}

static uint64_t hash_counts(const pir_unit *unit, unsigned sections) {
    uint64_t hash = HASH_START;
    for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++)
        if (sections & 1u << s)
            hash = hash_more(hash, unit->count[s], unit->slices * sizeof *unit->count[s]);
    return hash;
}

static uint64_t hash_packed(const pir_unit *unit, int s) {
    return hash_more(HASH_START, unit->packed[s].data, unit->packed[s].used);
}

static uint64_t hash_header(const pir_unit_header *header) {
    return hash_more(HASH_START, header, offsetof(pir_unit_header, hash));
}

pir_unit_header pir_unit_header_of(const pir_unit *unit, unsigned sections) {
    pir_unit_header header = {.magic = PIR_UNIT_MAGIC, .number = unit->number, .slices = unit->slices};
    for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++) {
        header.size[s] = unit->packed[s].used;
        header.packed[s] = hash_packed(unit, s);
        header.check[s] = unit->check[s];
    }
    header.counts = hash_counts(unit, sections);
    header.hash = hash_header(&header);
    return header;
}

bool pir_unit_header_holds(const pir_unit_header *header, const pir_plan *plan) {
    return header->magic == PIR_UNIT_MAGIC && header->hash == hash_header(header) && header->number < plan->units &&
           header->slices == pir_plan_count(plan, header->number);
}

/* Whether each section has the chunks that its counts add up to. */
static bool counts_add_up(const pir_unit *unit) {
    for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++)
        if (!pir_packed_holds(&unit->packed[s], s, pir_unit_elements(unit, s)))
            return false;
    return true;
}

/* A section's bytes: memory grows as they come, so that a size that lies takes none. */
static pir_status read_data(int descriptor, uint64_t at, uint64_t size, const pir_allocator *a, pir_bytes *data) {
    const size_t piece = (size_t)1 << 20;
    pir_status status = PIR_OK;
    for (data->used = 0; status == PIR_OK && data->used < size;) {
        size_t more = size - data->used < piece ? (size_t)(size - data->used) : piece;
        if (!pir_bytes_reserve(data, a, more))
            return PIR_ERR_MEMORY;
        status = pir_read_at(descriptor, data->data + data->used, more, at + data->used);
        data->used += more;
    }
    return status;
}

pir_status pir_unit_read(int descriptor, uint64_t at, const pir_plan *plan, pir_unit *unit) {
    pir_unit_header header;
    unsigned sections = pir_sections_of(plan);
    pir_status status = pir_read_at(descriptor, &header, sizeof header, at);
    if (status != PIR_OK)
        return status;
    if (!pir_unit_header_holds(&header, plan) || header.slices > unit->room)
        return PIR_ERR_FORMAT;
    at += sizeof header;
    unit->number = header.number;
    unit->slices = (uint32_t)header.slices;
    for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++) {
        size_t size = unit->slices * sizeof *unit->count[s];
        if (sections & 1u << s)
            status = pir_read_at(descriptor, unit->count[s], size, at);
        else
            for (uint32_t i = 0; i < unit->slices; i++)
                unit->count[s][i] = 0;
        if (status != PIR_OK)
            return status;
        at += sections & 1u << s ? size : 0;
    }
    for (int s = 0; status == PIR_OK && s < PIR_UNIT_SECTION_COUNT; s++) {
        status = read_data(descriptor, at, header.size[s], &plan->allocator, &unit->packed[s]);
        at += header.size[s];
    }
    if (status != PIR_OK)
        return status;
    for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++) {
        unit->check[s] = header.check[s];
        if (hash_packed(unit, s) != header.packed[s])
            return PIR_ERR_FORMAT;
    }
    return header.counts == hash_counts(unit, sections) && counts_add_up(unit) ? PIR_OK : PIR_ERR_FORMAT;
}
