/* SPDX-License-Identifier: MIT */
/*
 * Sums from bytes: the reader's half of sum_file.h. The bytes are not trusted.
 *
 * Every count is compared with the bytes that are left before memory is allocated, so memory stays in proportion to the
 * file. The operands are made anew (restore_operand.c). The pairing is accepted when every pair of it is proven in
 * exact arithmetic at its rotation (valid.c); then it is the only one there is. What a region keeps is a function of
 * the cover (region/region.c), and the file must have pairs for exactly that.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/report.h"
#include "dymsum/file/sum_file.h"
#include "dymsum/file/sum_source.h"
#include "dymsum/fill.h"
#include "dymsum/view.h"

/* --- the sum --- */

/* Vertices of `other` into `cell`; none only where there is a region. */
static pir_status get_cells(pir_source *from, uint32_t *cell, uint32_t count, const pir_polytope *other) {
    for (uint32_t i = 0; i < count; i++) {
        cell[i] = pir_source_u32(from);
        if (cell[i] >= other->vertex_count && !(from->has_region && cell[i] == PIR_NO_PAIR))
            return pir_source_broken(from, "a pair with no vertex");
    }
    return PIR_OK;
}

static pir_status get_pairing(pir_source *from, pir_sum *sum) {
    const pir_polytope *p = pir_sum_p(sum), *q = pir_sum_q(sum);
    if (!pir_source_has(from, (uint64_t)p->facet_count + q->facet_count + p->edge_count, 4))
        return pir_source_broken(from, "truncated");
    pir_status status = get_cells(from, pir_fill_cells(sum, PIR_OPERAND_P), p->facet_count, q);
    if (status == PIR_OK)
        status = get_cells(from, pir_fill_cells(sum, PIR_OPERAND_Q), q->facet_count, p);
    if (status != PIR_OK)
        return status;
    size_t counts_at = from->at;
    uint64_t total = 0;
    for (uint32_t e = 0; e < p->edge_count; e++)
        total += pir_source_u32(from);
    if (!pir_source_has(from, total, 4))
        return pir_source_broken(from, "truncated, or numbers of crossings that lie");
    if (total > UINT32_MAX / 8 || !pir_fill_crossings(sum, (uint32_t)total))
        return pir_source_no_memory(from);
    pir_source counts = *from;
    counts.at = counts_at;
    for (uint32_t e = 0; e < p->edge_count; e++) {
        uint32_t last = PIR_NO_CROSSING;
        for (uint32_t n = pir_source_u32(&counts); n > 0; n--) {
            uint32_t code = pir_source_u32(from);
            if (code / 2 >= q->edge_count)
                return pir_source_broken(from, "a crossing with no edge of Q");
            uint32_t half = q->edge_half[code / 2];
            if (!pir_fill_crossing(sum, e, code % 2 ? q->twin[half] : half, &last))
                return pir_source_no_memory(from);
        }
    }
    pir_fill_end(sum);
    return from->at == from->size ? PIR_OK : pir_source_broken(from, "bytes past the end");
}

static bool is_unit(pir_vec3 v) {
    return fabs(pir_vec_dot(v, v) - 1) <= 0x1p-40;
}

static pir_status get_region(pir_source *from, pir_cone *ret_cone, pir_cover *ret_cover) {
    if (!pir_source_has(from, 1, 14 * 8 + 4))
        return pir_source_broken(from, "truncated");
    pir_vec3 axis = pir_source_vec(from);
    double half_angle = pir_source_double(from);
    pir_vec3 axis_p = pir_source_vec(from), axis_q = pir_source_vec(from);
    double skin_p = pir_source_double(from), skin_q = pir_source_double(from), stride = pir_source_double(from);
    if (!is_unit(axis) || !is_unit(axis_p) || !is_unit(axis_q))
        return pir_source_broken(from, "an axis that is not of unit length");
    if (pir_cone_make(axis, half_angle, ret_cone) != PIR_OK || !ret_cone->set)
        return pir_source_broken(from, "a half-angle of no cone");
    // as it was, to the bit
    ret_cone->axis = axis;
    *ret_cover = pir_cover_make(ret_cone, false, axis_p, axis_q, skin_p, skin_q, stride);
    if (ret_cover->skin_p != skin_p || ret_cover->skin_q != skin_q || ret_cover->stride != stride)
        return pir_source_broken(from, "a skin or stride out of bounds");
    ret_cover->steps = pir_source_u32(from);
    ret_cover->step = pir_source_double(from);
    return ret_cover->step >= 0 && ret_cover->step <= PIR_MOST_STEP
               ? PIR_OK
               : pir_source_broken(from, "a step that is no angle");
}

/* Limits the pairing that was read to the region. */
static pir_status set_region(const pir_source *from, pir_sum *sum, const pir_cone *cone, const pir_cover *cover) {
    bool fits;
    if (!pir_fill_region(sum, cone, cover, &fits))
        return pir_source_no_memory(from);
    return fits ? PIR_OK : pir_source_broken(from, "not the pairs that the region asks for");
}

/* Sets the tolerance and the rotation shown, once the pairing is there. */
static pir_status set_lag(const pir_source *from, pir_sum *sum, double tolerance, bool lagging, pir_quat shown) {
    if (pir_sum_set_tolerance(sum, tolerance) != PIR_OK)
        return pir_source_broken(from, "a tolerance that is no length");
    bool done = true;
    if (lagging && (pir_fill_shown(sum, shown, &done) != PIR_OK || !done))
        return pir_source_broken(from, "a rotation shown that is not within the tolerance");
    return PIR_OK;
}

static pir_status get_sum(pir_source *from, const pir_fill_operands *operands, pir_sum **ret_sum) {
    from->part = "motion";
    if (!pir_source_has(from, 1, 5 * 8 + 4))
        return pir_source_broken(from, "truncated");
    pir_quat rotation = pir_source_quat(from), shown = rotation;
    double tolerance = pir_source_double(from);
    uint32_t lagging = pir_source_u32(from);
    if (lagging > 1 || (lagging && !pir_source_has(from, 1, 4 * 8)))
        return pir_source_broken(from, "truncated, or neither lagging nor not");
    if (lagging)
        shown = pir_source_quat(from);
    pir_sum *sum = NULL;
    pir_status status = pir_fill_begin(operands, rotation, from->allocator, &sum);
    if (status == PIR_ERR_MEMORY)
        return pir_source_no_memory(from);
    if (status != PIR_OK)
        return pir_source_broken(from, pir_status_text(status));
    pir_cone cone;
    pir_cover cover;
    from->part = "region";
    if (from->has_region)
        status = get_region(from, &cone, &cover);
    from->part = "pairing";
    if (status == PIR_OK)
        status = get_pairing(from, sum);
    if (status == PIR_OK && from->has_region)
        status = set_region(from, sum, &cone, &cover);
    if (status == PIR_OK && !pir_sum_is_valid(sum))
        status = pir_source_broken(from, "not the pairing at this rotation");
    if (status == PIR_OK)
        status = set_lag(from, sum, tolerance, lagging == 1, shown);
    if (status != PIR_OK) {
        pir_sum_destroy(sum);
        return status;
    }
    pir_sum_reset_statistics(sum);
    *ret_sum = sum;
    return PIR_OK;
}

/* Whether the header, which is there in full, is that of a sum. Reads the length and the checksum. */
static pir_status get_header(pir_source *from, uint64_t *ret_length, uint64_t *ret_checksum) {
    if (memcmp(from->data, PIR_SUM_MAGIC, 8) != 0)
        return pir_source_broken(from, "these bytes are no sum");
    from->at = 8;
    uint32_t version = pir_source_u32(from);
    if (version != PIR_SUM_VERSION)
        return pir_fail(from->report, PIR_ERR_VERSION, "sum: header: version %u, this library reads version %u",
                        (unsigned)version, PIR_SUM_VERSION);
    uint32_t flags = pir_source_u32(from);
    if (flags & ~(PIR_SUM_REGION | PIR_SUM_DIFFERENCE))
        return pir_source_broken(from, "flags that no sum has");
    from->has_region = flags & PIR_SUM_REGION;
    from->is_difference = flags & PIR_SUM_DIFFERENCE;
    *ret_length = pir_source_u64(from);
    *ret_checksum = pir_source_u64(from);
    return *ret_length < PIR_SUM_HEADER_SIZE ? pir_source_broken(from, "a length that lies") : PIR_OK;
}

pir_status pir_sum_restore(const void *data, size_t size, const pir_allocator *allocator, pir_report *report,
                           pir_sum **ret_sum) {
    if (!data || !ret_sum)
        return pir_fail(report, PIR_ERR_ARGUMENT, "sum: no data, or nowhere to put the sum");
    const pir_allocator used = pir_allocator_or_default(allocator);
    pir_source from = {data, size, 0, "header", false, false, &used, report};
    if (size == 0)
        return pir_fail(report, PIR_ERR_EMPTY, "sum: no bytes at all");
    if (size < PIR_SUM_HEADER_SIZE)
        return pir_source_broken(&from, "truncated");
    uint64_t length, checksum;
    pir_status status = get_header(&from, &length, &checksum);
    if (status != PIR_OK)
        return status;
    if (length != size)
        return pir_source_broken(&from, length > size ? "truncated" : "bytes past the end");
    if (checksum != pir_sum_file_checksum(data, size))
        return pir_source_broken(&from, "the checksum does not match: the bytes are corrupted");
    static const char *const parts[2] = {"operand P", "operand Q"};
    pir_fill_operands operands = {.difference = from.is_difference};
    for (int i = 0; status == PIR_OK && i < 2; i++) {
        from.part = parts[i];
        status = pir_source_operand(&from, &operands.made_of[i], &operands.now[i]);
    }
    if (status == PIR_OK)
        status = get_sum(&from, &operands, ret_sum);
    for (int i = 0; i < 2; i++) {
        pir_polytope_release(operands.made_of[i]);
        pir_polytope_release(operands.now[i]);
    }
    return status;
}

/* --- files --- */

/* How much is read at a time before the file has shown that it is as long as it says. */
#define CHUNK ((size_t)1 << 16)

/* Reads from the file until the block has `length` bytes. The block grows as bytes come. */
static pir_status fill(FILE *file, const pir_source *from, uint8_t **data, size_t *size, size_t length) {
    while (*size < length) {
        size_t more = *size < CHUNK ? CHUNK : *size;
        if (more > length - *size)
            more = length - *size;
        uint8_t *grown = PIR_RESIZE(from->allocator, *data, *size, *size + more);
        if (!grown)
            return pir_source_no_memory(from);
        *data = grown;
        size_t got = fread(grown + *size, 1, more, file);
        *size += more;
        if (got != more)
            return ferror(file) ? pir_fail(from->report, PIR_ERR_FILE, "sum: the file cannot be read")
                                : pir_source_broken(from, "the file ends before the sum does");
    }
    return PIR_OK;
}

pir_status pir_sum_read(FILE *file, const pir_allocator *allocator, pir_report *report, pir_sum **ret_sum) {
    if (!file || !ret_sum)
        return pir_fail(report, PIR_ERR_ARGUMENT, "sum: no file, or nowhere to put the sum");
    const pir_allocator used = pir_allocator_or_default(allocator);
    uint8_t *data = NULL;
    size_t size = 0;
    uint64_t length = 0, checksum;
    pir_source from = {NULL, 0, 0, "header", false, false, &used, report};
    pir_status status = fill(file, &from, &data, &size, PIR_SUM_HEADER_SIZE);
    if (status == PIR_OK) {
        from.data = data;
        status = get_header(&from, &length, &checksum);
    }
    if (status == PIR_OK && length > SIZE_MAX / 2)
        status = pir_source_broken(&from, "a length that lies");
    if (status == PIR_OK)
        status = fill(file, &from, &data, &size, (size_t)length);
    if (status == PIR_OK)
        status = pir_sum_restore(data, size, allocator, report, ret_sum);
    PIR_FREE(&used, data, size);
    return status;
}
