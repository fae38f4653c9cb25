/* SPDX-License-Identifier: MIT */
/* Sums to bytes: the writer's half of sum_file.h. One pass counts, the next one writes. */
#include <stdio.h>
#include <string.h>

#include "base/report.h"
#include "dymsum/file/sum_file.h"
#include "dymsum/view.h"

_Static_assert(GMP_NUMB_BITS % 8 == 0, "bytes do not straddle limbs");

/* Bytes so far; they are stored only where there is memory. */
struct sink {
    uint8_t *data; /* NULL: count only */
    size_t used;
};

uint64_t pir_sum_file_checksum(const uint8_t *data, size_t size) {
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < size; i++) {
        if (i >= PIR_SUM_CHECKSUM_AT && i < PIR_SUM_HEADER_SIZE)
            continue;
        hash = (hash ^ data[i]) * UINT64_C(0x100000001b3);
    }
    return hash;
}

static void put_byte(struct sink *sink, uint8_t byte) {
    if (sink->data)
        sink->data[sink->used] = byte;
    sink->used++;
}

static void put_u32(struct sink *sink, uint32_t value) {
    for (int k = 0; k < 4; k++)
        put_byte(sink, (uint8_t)(value >> (8 * k)));
}

static void put_u64(struct sink *sink, uint64_t value) {
    put_u32(sink, (uint32_t)value);
    put_u32(sink, (uint32_t)(value >> 32));
}

static void put_double(struct sink *sink, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_u64(sink, bits);
}

static void put_vec(struct sink *sink, pir_vec3 v) {
    put_double(sink, v.x);
    put_double(sink, v.y);
    put_double(sink, v.z);
}

static void put_quat(struct sink *sink, pir_quat q) {
    put_double(sink, q.x);
    put_double(sink, q.y);
    put_double(sink, q.z);
    put_double(sink, q.w);
}

/* --- integers --- */

static uint32_t bytes_of(const pir_int *a) {
    return (pir_int_bits(a) + 7) / 8;
}

/* |a| in `count` bytes, least significant first. */
static void put_magnitude(struct sink *sink, const pir_int *a, uint32_t count) {
    uint32_t length = pir_int_length(a);
    for (uint32_t k = 0; k < count; k++) {
        uint32_t limb = 8 * k / GMP_NUMB_BITS, shift = 8 * k % GMP_NUMB_BITS;
        put_byte(sink, limb < length ? (uint8_t)(a->limb[limb] >> shift) : 0);
    }
}

static void put_scale(struct sink *sink, const pir_scale *scale) {
    const pir_int *part[2] = {&scale->num, &scale->den};
    for (int i = 0; i < 2; i++) {
        put_u32(sink, bytes_of(part[i]));
        put_magnitude(sink, part[i], bytes_of(part[i]));
    }
}

/* --- operands --- */

static void put_vertices(struct sink *sink, const pir_polytope *p, uint32_t width) {
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        pir_int3 x = pir_vertex_exact(p, v);
        for (int k = 0; k < 3; k++) {
            put_byte(sink, x.c[k].size < 0);
            put_magnitude(sink, &x.c[k], width);
        }
    }
}

static void put_polytope(struct sink *sink, const pir_polytope *p) {
    uint32_t width = 1, facets = p->dimension >= 2 ? p->facet_count : 0;
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        pir_int3 x = pir_vertex_exact(p, v);
        for (int k = 0; k < 3; k++)
            width = bytes_of(&x.c[k]) > width ? bytes_of(&x.c[k]) : width;
    }
    put_u32(sink, (uint32_t)p->dimension);
    put_u32(sink, p->vertex_count);
    put_u32(sink, facets);
    put_u32(sink, width);
    put_scale(sink, &p->scale);
    put_vertices(sink, p, width);
    for (uint32_t v = 0; v < p->vertex_count; v++)
        put_u32(sink, p->source[v]);
    for (uint32_t f = 0; f < facets; f++)
        put_u32(sink, p->loop_start[f + 1] - p->loop_start[f]);
    for (uint32_t i = 0; facets > 0 && i < p->half_count; i++)
        put_u32(sink, p->origin[p->loop[i]]);
}

static void put_operand(struct sink *sink, const pir_polytope *made_of, const pir_polytope *now) {
    put_polytope(sink, made_of);
    put_u32(sink, now != made_of);
    if (now != made_of)
        put_scale(sink, &now->scale);
}

/* --- the sum --- */

static void put_pairing(struct sink *sink, const pir_pairing *pairing) {
    const pir_polytope *p = pairing->p, *q = pairing->q;
    for (uint32_t f = 0; f < p->facet_count; f++)
        put_u32(sink, pairing->fv[f]);
    for (uint32_t g = 0; g < q->facet_count; g++)
        put_u32(sink, pairing->vf[g]);
    for (uint32_t e = 0; e < p->edge_count; e++) {
        uint32_t count = 0;
        for (uint32_t at = pir_crossing_first(pairing, e); at != PIR_NO_CROSSING; at = pir_crossing_next(pairing, at))
            count++;
        put_u32(sink, count);
    }
    for (uint32_t e = 0; e < p->edge_count; e++)
        for (uint32_t at = pir_crossing_first(pairing, e); at != PIR_NO_CROSSING; at = pir_crossing_next(pairing, at)) {
            uint32_t half = pir_crossing_half(pairing, at), edge = q->edge[half];
            put_u32(sink, 2 * edge + (q->edge_half[edge] != half));
        }
}

static void put_region(struct sink *sink, const pir_cone *cone, const pir_cover *cover) {
    put_vec(sink, cone->axis);
    put_double(sink, cone->half_angle);
    put_vec(sink, cover->axis_p);
    put_vec(sink, cover->axis_q);
    put_double(sink, cover->skin_p);
    put_double(sink, cover->skin_q);
    put_double(sink, cover->stride);
    put_u32(sink, cover->steps);
    put_double(sink, cover->step);
}

/* Puts it all, with `length` and `checksum` in the header. */
static void put_sum(struct sink *sink, const pir_sum *sum, uint64_t length, uint64_t checksum) {
    const pir_pairing *pairing = pir_sum_pairing(sum);
    const pir_rotation *shown = pir_sum_shown_rotation(sum);
    bool behind = shown != &pairing->signs.rotation;
    for (int k = 0; k < 8; k++)
        put_byte(sink, (uint8_t)PIR_SUM_MAGIC[k]);
    put_u32(sink, PIR_SUM_VERSION);
    put_u32(sink, (pir_sum_cone(sum)->set ? PIR_SUM_REGION : 0) | (pairing->difference ? PIR_SUM_DIFFERENCE : 0));
    put_u64(sink, length);
    put_u64(sink, checksum);
    put_operand(sink, pir_sum_made_of(sum, PIR_OPERAND_P), pairing->p);
    put_operand(sink, pir_sum_made_of(sum, PIR_OPERAND_Q), pairing->q);
    put_quat(sink, pairing->signs.rotation.given);
    put_double(sink, pir_sum_tolerance(sum));
    put_u32(sink, behind);
    if (behind)
        put_quat(sink, shown->given);
    if (pir_sum_cone(sum)->set)
        put_region(sink, pir_sum_cone(sum), pir_sum_cover(sum));
    put_pairing(sink, pairing);
}

size_t pir_sum_serialised_size(const pir_sum *sum) {
    struct sink sink = {NULL, 0};
    put_sum(&sink, sum, 0, 0);
    return sink.used;
}

pir_status pir_sum_serialise(const pir_sum *sum, void *memory, size_t size) {
    if (!sum || !memory)
        return PIR_ERR_ARGUMENT;
    if (size != pir_sum_serialised_size(sum))
        return PIR_ERR_ARGUMENT;
    struct sink sink = {memory, 0};
    put_sum(&sink, sum, size, 0);
    struct sink checksum = {memory, PIR_SUM_CHECKSUM_AT};
    put_u64(&checksum, pir_sum_file_checksum(memory, size));
    return PIR_OK;
}

pir_status pir_sum_write(const pir_sum *sum, FILE *file, pir_report *report) {
    if (!sum || !file)
        return pir_fail(report, PIR_ERR_ARGUMENT, "sum: no sum or no file to write");
    size_t size = pir_sum_serialised_size(sum);
    uint8_t *data = PIR_NEW(&pir_sum_pairing(sum)->allocator, uint8_t, size);
    if (!data)
        return pir_fail(report, PIR_ERR_MEMORY, "sum: out of memory for %zu bytes to write", size);
    pir_status status = pir_sum_serialise(sum, data, size);
    PIR_ASSERT(status == PIR_OK);
    if (fwrite(data, 1, size, file) != size || fflush(file) != 0)
        status = pir_fail(report, PIR_ERR_FILE, "sum: the file could not be written in full");
    PIR_FREE(&pir_sum_pairing(sum)->allocator, data, size);
    return status;
}
