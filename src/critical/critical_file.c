/* SPDX-License-Identifier: MIT */
/*
 * Maps as bytes, the same on every machine. Numbers of fixed width are little-endian; a number is otherwise in bytes of
 * seven bits each, the least significant first, all but the last with 128 added.
 *
 *     header    8 bytes   "PIRTURN\n"
 *               u32       version, 1
 *               u32       0
 *               u64       the length of the whole in bytes
 *               u64       checksum: FNV-1a of all bytes behind the header
 *     sum       u64       its length
 *               bytes     the difference at q₀, as pir_sum_serialise writes it: −P, Q and q₀
 *     axis      3 u64     u, as IEEE-754 doubles
 *     start     number    facets of interval 0; then each of them
 *     events    number    how many; then of each:
 *               u64       the greatest double not above κ
 *               byte      1 where κ is that double, else 0
 *               number    facets that end; then each of them; and likewise those that begin
 *     facet     number    16·(index of P's face) + 4·(its kind) + (the kind of Q's face); number: index of Q's face
 *
 * Kinds are 1 for a vertex, 2 for an edge, 3 for a facet. Facets stand by P's face, facets first, then edges, then
 * vertices, each by number, then by Q's likewise.
 */
#include <math.h>
#include <string.h>

#include <pirouette/sum.h>

#include "base/byte_block.h"
#include "base/report.h"
#include "critical/critical_map.h"

#define MAGIC       "PIRTURN\n"
#define VERSION     1u
#define HEADER_SIZE 32u
#define CHUNK       ((size_t)1 << 16)

/* Bytes being written; a failure stays. */
struct writer {
    const pir_allocator *allocator;
    pir_bytes bytes;
    bool failed;
};

/* --- writing --- */

static void put_byte(struct writer *writer, uint8_t byte) {
    writer->failed = writer->failed || !pir_bytes_reserve(&writer->bytes, writer->allocator, 1);
    if (!writer->failed)
        writer->bytes.data[writer->bytes.used++] = byte;
}

static void put_u64(struct writer *writer, uint64_t value) {
    for (int k = 0; k < 8; k++)
        put_byte(writer, (uint8_t)(value >> (8 * k)));
}

static void put_double(struct writer *writer, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_u64(writer, bits);
}

static void put_number(struct writer *writer, uint64_t value) {
    for (; value >= 128; value >>= 7)
        put_byte(writer, (uint8_t)(128 | (value & 127)));
    put_byte(writer, (uint8_t)value);
}

/* Lives by an interval, each list in the order of facets. */
struct ranked_lives {
    uint32_t *start, *life; /* per interval, and one more */
    uint32_t intervals, lives;
};

static void free_ranked(struct ranked_lives *ranked, const pir_allocator *a) {
    PIR_FREE(a, ranked->start, (size_t)ranked->intervals + 2);
    PIR_FREE(a, ranked->life, ranked->lives);
}

/* Puts a few lives in the order of facets. Those that begin together are in order. */
static void sort_lives(const pir_critical_map *map, uint32_t *life, uint32_t count) {
    for (uint32_t i = 1; i < count; i++) {
        const uint32_t moved = life[i];
        uint32_t k = i;
        for (; k > 0 && pir_faces_order(&map->life[moved].faces, &map->life[life[k - 1]].faces) < 0; k--)
            life[k] = life[k - 1];
        life[k] = moved;
    }
}

/* Ranks lives by the first interval, or by the one after the last. False when out of memory. */
static bool rank_lives(const pir_critical_map *map, bool by_first, const pir_allocator *a,
                       struct ranked_lives *ranked) {
    *ranked = (struct ranked_lives){.intervals = pir_critical_intervals(map), .lives = map->life_count};
    ranked->start = PIR_ZEROED(a, uint32_t, (size_t)ranked->intervals + 2);
    ranked->life = PIR_NEW(a, uint32_t, ranked->lives);
    if (!ranked->start || !ranked->life) {
        free_ranked(ranked, a);
        return false;
    }
    uint32_t *start = ranked->start;
    for (uint32_t i = 0; i < ranked->lives; i++)
        start[(by_first ? map->life[i].first : map->life[i].last + 1) + 1]++;
    for (uint32_t k = 0; k <= ranked->intervals; k++)
        start[k + 1] += start[k];
    for (uint32_t i = 0; i < ranked->lives; i++)
        ranked->life[start[by_first ? map->life[i].first : map->life[i].last + 1]++] = i;
    for (uint32_t k = ranked->intervals + 1; k > 0; k--)
        start[k] = start[k - 1];
    start[0] = 0;
    // the last list, of what never ends, is not written
    for (uint32_t k = 0; k < ranked->intervals; k++)
        sort_lives(map, ranked->life + start[k], start[k + 1] - start[k]);
    return true;
}

static void put_facets(struct writer *writer, const pir_critical_map *map, const struct ranked_lives *ranked,
                       uint32_t interval) {
    const uint32_t start = ranked->start[interval], end = ranked->start[interval + 1];
    put_number(writer, end - start);
    for (uint32_t i = start; i < end; i++) {
        const pir_witness *faces = &map->life[ranked->life[i]].faces;
        put_number(writer, 16 * (uint64_t)faces->p.index + 4 * (uint64_t)faces->p.kind + (uint64_t)faces->q.kind);
        put_number(writer, faces->q.index);
    }
}

/* The axis and the turn, which stand behind the sum. */
static void put_turn(struct writer *writer, const pir_critical_map *map) {
    struct ranked_lives begins, ends;
    put_double(writer, map->axis.x);
    put_double(writer, map->axis.y);
    put_double(writer, map->axis.z);
    if (!rank_lives(map, true, writer->allocator, &begins)) {
        writer->failed = true;
        return;
    }
    if (rank_lives(map, false, writer->allocator, &ends)) {
        put_facets(writer, map, &begins, 0);
        put_number(writer, map->event_count);
        for (uint32_t i = 0; i < map->event_count; i++) {
            put_double(writer, map->event[i].kappa[0]);
            put_byte(writer, map->event[i].kappa[0] == map->event[i].kappa[1]);
            put_facets(writer, map, &ends, i + 1);
            put_facets(writer, map, &begins, i + 1);
        }
        free_ranked(&ends, writer->allocator);
    } else {
        writer->failed = true;
    }
    free_ranked(&begins, writer->allocator);
}

/* The difference at the start. */
static pir_status put_sum(struct writer *writer, const pir_critical_map *map) {
    pir_sum_options options = pir_sum_options_default();
    options.allocator = writer->allocator;
    options.difference = true;
    pir_sum *sum;
    pir_status status = pir_sum_create(map->p, map->q, map->start, &options, &sum);
    if (status != PIR_OK)
        return status;
    const size_t size = pir_sum_serialised_size(sum);
    put_u64(writer, size);
    if (!writer->failed && pir_bytes_reserve(&writer->bytes, writer->allocator, size))
        status = pir_sum_serialise(sum, writer->bytes.data + writer->bytes.used, size);
    else
        status = PIR_ERR_MEMORY;
    writer->bytes.used += status == PIR_OK ? size : 0;
    pir_sum_destroy(sum);
    return status;
}

pir_status pir_critical_map_write(const pir_critical_map *map, FILE *file, pir_report *report) {
    if (!map || !file)
        return pir_fail(report, PIR_ERR_ARGUMENT, "critical map: no map or no file to write");
    struct writer header = {.allocator = &map->allocator}, body = {.allocator = &map->allocator};
    pir_status status = put_sum(&body, map);
    if (status == PIR_OK)
        put_turn(&body, map);
    for (size_t k = 0; k < 8; k++)
        put_byte(&header, (uint8_t)MAGIC[k]);
    put_u64(&header, VERSION);
    put_u64(&header, HEADER_SIZE + body.bytes.used);
    put_u64(&header, pir_hash_bytes(PIR_HASH_START, body.bytes.data, body.bytes.used));
    if (status == PIR_OK && (header.failed || body.failed))
        status = PIR_ERR_MEMORY;
    if (status != PIR_OK)
        pir_fail(report, status, "critical map: %s", pir_status_text(status));
    else if (fwrite(header.bytes.data, 1, header.bytes.used, file) != header.bytes.used ||
             fwrite(body.bytes.data, 1, body.bytes.used, file) != body.bytes.used || fflush(file) != 0)
        status = pir_fail(report, PIR_ERR_FILE, "critical map: the file could not be written in full");
    pir_bytes_finish(&header.bytes, &map->allocator);
    pir_bytes_finish(&body.bytes, &map->allocator);
    return status;
}

/* --- reading --- */

static uint64_t get_u64(const uint8_t *at) {
    uint64_t value = 0;
    for (int k = 0; k < 8; k++)
        value |= (uint64_t)at[k] << (8 * k);
    return value;
}

/* Reads up to `size` bytes, in chunks, so that memory stays in proportion to what is there. */
static pir_status read_bytes(FILE *file, uint64_t size, const pir_allocator *a, pir_bytes *bytes) {
    while (bytes->used < size) {
        const uint64_t left = size - bytes->used;
        const size_t part = left < CHUNK ? (size_t)left : CHUNK;
        if (!pir_bytes_reserve(bytes, a, part))
            return PIR_ERR_MEMORY;
        const size_t got = fread(bytes->data + bytes->used, 1, part, file);
        bytes->used += got;
        if (got < part)
            return ferror(file) ? PIR_ERR_FILE : PIR_OK;
    }
    return PIR_OK;
}

static pir_status broken(pir_report *report, const char *why) {
    return pir_fail(report, PIR_ERR_FORMAT, "critical map: %s", why);
}

/* Makes the map that the bytes behind the header describe. */
static pir_status make_again(const pir_bytes *bytes, const pir_allocator *a, pir_report *report,
                             pir_critical_map **ret_map) {
    if (bytes->used < 8)
        return broken(report, "truncated");
    const uint64_t size = get_u64(bytes->data);
    if (size > bytes->used - 8 || bytes->used - 8 - size < 24)
        return broken(report, "truncated within its sum or its axis");
    const uint8_t *turn = bytes->data + 8 + size;
    pir_sum *sum;
    pir_status status = pir_sum_restore(bytes->data + 8, (size_t)size, a, report, &sum);
    if (status != PIR_OK)
        return status;
    double axis[3];
    for (int k = 0; k < 3; k++) {
        const uint64_t bits = get_u64(turn + 8 * k);
        memcpy(&axis[k], &bits, sizeof bits);
    }
    pir_polytope *p;
    pir_critical_map *map;
    // a sum has −P
    status = pir_polytope_reflect(pir_sum_p(sum), &p);
    if (status == PIR_OK) {
        status = pir_critical_map_create(p, (pir_polytope *)pir_sum_q(sum), pir_sum_rotation(sum),
                                         (pir_vec3){axis[0], axis[1], axis[2]}, a, &map);
        pir_polytope_release(p);
    }
    pir_sum_destroy(sum);
    if (status == PIR_ERR_ARGUMENT || status == PIR_ERR_NOT_FINITE)
        return broken(report, "an axis or operands that make no turn");
    if (status != PIR_OK)
        return pir_fail(report, status, "critical map: %s", pir_status_text(status));
    struct writer again = {.allocator = a};
    put_turn(&again, map);
    const size_t rest = bytes->used - 8 - (size_t)size;
    if (again.failed)
        status = pir_fail(report, PIR_ERR_MEMORY, "critical map: out of memory");
    else if (again.bytes.used != rest || memcmp(again.bytes.data, turn, rest) != 0)
        status = broken(report, "events or facets that are not those of its bodies");
    pir_bytes_finish(&again.bytes, a);
    if (status == PIR_OK)
        *ret_map = map;
    else
        pir_critical_map_destroy(map);
    return status;
}

static pir_status read_map(FILE *file, const pir_allocator *a, pir_report *report, pir_bytes *bytes,
                           pir_critical_map **ret_map) {
    pir_status status = read_bytes(file, HEADER_SIZE, a, bytes);
    if (status == PIR_OK && bytes->used == 0)
        return pir_fail(report, PIR_ERR_EMPTY, "critical map: nothing is left in the file");
    if (status == PIR_OK && (bytes->used < HEADER_SIZE || memcmp(bytes->data, MAGIC, 8) != 0))
        return broken(report, "not a file of critical maps");
    if (status == PIR_OK && get_u64(bytes->data + 8) != VERSION)
        return pir_fail(report, PIR_ERR_VERSION, "critical map: version %llu, which this library does not know",
                        (unsigned long long)get_u64(bytes->data + 8));
    if (status == PIR_OK) {
        const uint64_t length = get_u64(bytes->data + 16), checksum = get_u64(bytes->data + 24);
        bytes->used = 0;
        if (length < HEADER_SIZE)
            return broken(report, "a length that lies");
        status = read_bytes(file, length - HEADER_SIZE, a, bytes);
        if (status == PIR_OK && bytes->used != length - HEADER_SIZE)
            return broken(report, "truncated");
        if (status == PIR_OK && pir_hash_bytes(PIR_HASH_START, bytes->data, bytes->used) != checksum)
            return broken(report, "a checksum that does not match");
    }
    if (status != PIR_OK)
        return pir_fail(report, status, "critical map: %s", pir_status_text(status));
    return make_again(bytes, a, report, ret_map);
}

pir_status pir_critical_map_read(FILE *file, const pir_allocator *allocator, pir_report *report,
                                 pir_critical_map **ret_map) {
    if (!file || !ret_map)
        return pir_fail(report, PIR_ERR_ARGUMENT, "critical map: no file, or nowhere to put the map");
    const pir_allocator a = pir_allocator_or_default(allocator);
    pir_bytes bytes = {0};
    const pir_status status = read_map(file, &a, report, &bytes, ret_map);
    pir_bytes_finish(&bytes, &a);
    return status;
}
