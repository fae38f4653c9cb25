/* SPDX-License-Identifier: MIT */
/*
 * Sums from bytes: the reader's half of sum_file.h. Nothing that the bytes say is believed.
 *
 * Every count is held against the bytes that are left before memory is asked for, so memory stays in proportion to the file. The
 * operands are made anew as exact hulls of their vertices, and the facets in the file must be that hull's, in any order. The pairing is
 * accepted when every pair of it is proven in exact arithmetic at its rotation (valid.c); then it is the only one there is.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/report.h"
#include "dymsum/sum.h"
#include "dymsum/sum_file.h"
#include "polytope/hull.h"

struct source {
    const uint8_t *data;
    size_t size, at;
    const char *part; /* what is being read, for reports */
    bool has_region, is_difference;
    const pir_allocator *allocator;
    pir_report *report;
};

/* --- numbers --- */

static pir_status broken(const struct source *from, const char *why) {
    return pir_fail(from->report, PIR_ERR_FORMAT, "sum: byte %zu, %s: %s", from->at, from->part, why);
}

static pir_status no_memory(const struct source *from) {
    return pir_fail(from->report, PIR_ERR_MEMORY, "sum: byte %zu, %s: out of memory", from->at, from->part);
}

/* Whether `count` things of `size` bytes are left; size > 0. */
static bool are_left(const struct source *from, uint64_t count, size_t size) {
    return count <= (from->size - from->at) / size;
}

static uint32_t get_u32(struct source *from) {
    uint32_t value = 0;
    for (int k = 0; k < 4; k++)
        value |= (uint32_t)from->data[from->at++] << (8 * k);
    return value;
}

static uint64_t get_u64(struct source *from) {
    uint64_t low = get_u32(from);
    return low | (uint64_t)get_u32(from) << 32;
}

static double get_double(struct source *from) {
    uint64_t bits = get_u64(from);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static pir_vec3 get_vec(struct source *from) {
    pir_vec3 v;
    v.x = get_double(from);
    v.y = get_double(from);
    v.z = get_double(from);
    return v;
}

static pir_quat get_quat(struct source *from) {
    pir_quat q;
    q.x = get_double(from);
    q.y = get_double(from);
    q.z = get_double(from);
    q.w = get_double(from);
    return q;
}

static uint32_t limbs_for(uint32_t bytes) {
    return (8 * bytes + GMP_NUMB_BITS - 1) / GMP_NUMB_BITS;
}

/* An unsigned integer of `bytes` bytes into to->limb, which has limbs_for of them. */
static void get_magnitude(struct source *from, uint32_t bytes, pir_int *to) {
    uint32_t limbs = limbs_for(bytes);
    memset(to->limb, 0, limbs * sizeof *to->limb);
    for (uint32_t k = 0; k < bytes; k++)
        to->limb[8 * k / GMP_NUMB_BITS] |= (mp_limb_t)from->data[from->at++] << (8 * k % GMP_NUMB_BITS);
    while (limbs > 0 && to->limb[limbs - 1] == 0)
        limbs--;
    to->size = (int32_t)limbs;
}

/* The limbs of a scale's two numbers. */
#define SCALE_LIMBS ((8 * PIR_SUM_NUMBER_MAX + GMP_NUMB_BITS - 1) / GMP_NUMB_BITS)

struct scale_room {
    mp_limb_t num[SCALE_LIMBS], den[SCALE_LIMBS];
};

static pir_status get_scale(struct source *from, struct scale_room *room, pir_scale *ret_scale) {
    pir_scale scale = {{room->num, 0}, {room->den, 0}};
    pir_int *part[2] = {&scale.num, &scale.den};
    for (int i = 0; i < 2; i++) {
        if (!are_left(from, 1, 4))
            return broken(from, "truncated");
        uint32_t bytes = get_u32(from);
        if (bytes > PIR_SUM_NUMBER_MAX)
            return broken(from, "a scale of too many bytes");
        if (!are_left(from, bytes, 1))
            return broken(from, "truncated");
        get_magnitude(from, bytes, part[i]);
        if (part[i]->size == 0)
            return broken(from, "a scale of zero");
    }
    *ret_scale = scale;
    return PIR_OK;
}

/* --- operands --- */

/* What the file says of one operand. */
struct operand {
    uint32_t dimension, vertices, facets, width, corners;
    struct scale_room room;
    pir_scale scale;
    pir_vectors points;
    uint32_t *source;
    pir_loops loops;
};

static void finish_operand(struct operand *operand, const pir_allocator *a) {
    pir_vectors_finish(&operand->points, a);
    PIR_FREE(a, operand->source, operand->vertices);
    if (operand->loops.start)
        pir_loops_finish(&operand->loops, a, operand->corners);
}

static pir_status get_vertices(struct source *from, struct operand *operand) {
    if (!are_left(from, operand->vertices, 3 * ((size_t)operand->width + 1) + 4))
        return broken(from, "truncated, or a number of vertices that lies");
    operand->source = PIR_NEW(from->allocator, uint32_t, operand->vertices);
    if (!operand->source ||
        !pir_vectors_init(&operand->points, from->allocator, operand->vertices, limbs_for(operand->width)))
        return no_memory(from);
    for (uint32_t v = 0; v < operand->vertices; v++) {
        pir_int3 x = pir_vectors_at(&operand->points, v);
        for (int k = 0; k < 3; k++) {
            uint8_t negative = from->data[from->at++];
            if (negative > 1)
                return broken(from, "a coordinate's sign is neither 0 nor 1");
            get_magnitude(from, operand->width, &x.c[k]);
            if (negative)
                pir_int_negate(&x.c[k]);
        }
        pir_vectors_put(&operand->points, v, &x);
    }
    for (uint32_t v = 0; v < operand->vertices; v++)
        operand->source[v] = get_u32(from);
    return PIR_OK;
}

static pir_status get_facets(struct source *from, struct operand *operand) {
    if (!are_left(from, operand->facets, 4))
        return broken(from, "truncated, or a number of facets that lies");
    // the sizes first, so that the corners are counted before room for them is made
    size_t sizes_at = from->at;
    uint64_t corners = 0;
    for (uint32_t f = 0; f < operand->facets; f++) {
        uint32_t size = get_u32(from);
        if (size < 3)
            return broken(from, "a facet of fewer than three corners");
        corners += size;
    }
    if (!are_left(from, corners, 4))
        return broken(from, "truncated, or numbers of corners that lie");
    operand->corners = (uint32_t)corners;
    if (!pir_loops_init(&operand->loops, from->allocator, operand->facets, operand->corners))
        return no_memory(from);
    size_t corners_at = from->at;
    from->at = sizes_at;
    operand->loops.start[0] = 0;
    for (uint32_t f = 0; f < operand->facets; f++)
        operand->loops.start[f + 1] = operand->loops.start[f] + get_u32(from);
    from->at = corners_at;
    for (uint32_t i = 0; i < operand->corners; i++) {
        operand->loops.corner[i] = get_u32(from);
        if (operand->loops.corner[i] >= operand->vertices)
            return broken(from, "a corner that is no vertex");
    }
    return PIR_OK;
}

/* Whether the facets that were read are those of the hull, turned or in another order. */
static pir_status compare_facets(const struct source *from, const struct operand *operand, const pir_hull *hull) {
    const pir_loops *own = &operand->loops;
    bool counts = hull->dimension == (int)operand->dimension && hull->vertex_count == operand->vertices &&
                  own->count == hull->facets.count && pir_loops_corners(own) == pir_loops_corners(&hull->facets);
    if (!counts)
        return broken(from, "the vertices are not the corners of a body with these facets");
    pir_loops sorted;
    if (!pir_loops_init(&sorted, from->allocator, own->count, operand->corners))
        return no_memory(from);
    memcpy(sorted.start, own->start, ((size_t)own->count + 1) * sizeof *own->start);
    memcpy(sorted.corner, own->corner, operand->corners * sizeof *own->corner);
    pir_status status = PIR_OK;
    if (!pir_loops_canonicalise(&sorted, NULL, from->allocator))
        status = no_memory(from);
    else if (memcmp(sorted.start, hull->facets.start, ((size_t)own->count + 1) * sizeof *own->start) != 0 ||
             memcmp(sorted.corner, hull->facets.corner, operand->corners * sizeof *own->corner) != 0)
        status = broken(from, "the facets are not those of the vertices' hull");
    pir_loops_finish(&sorted, from->allocator, operand->corners);
    return status;
}

static pir_status build_polytope(const struct source *from, const struct operand *operand, pir_polytope **ret) {
    pir_hull hull;
    pir_status status = pir_hull_make(&operand->points, from->allocator, &hull);
    if (status != PIR_OK)
        return pir_fail(from->report, status, "sum: %s: %s", from->part, pir_status_text(status));
    if (hull.dimension >= 2)
        status = compare_facets(from, operand, &hull);
    else if (hull.dimension != (int)operand->dimension || hull.vertex_count != operand->vertices || operand->facets > 0)
        status = broken(from, "the vertices are not those of a segment or point");
    pir_polytope *polytope = NULL;
    if (status == PIR_OK) {
        pir_polytope_parts parts = {&operand->points, &operand->scale,   NULL,           hull.dimension,
                                    hull.vertices,    hull.vertex_count, &operand->loops};
        if (pir_polytope_build(&parts, from->allocator, &polytope) != PIR_OK)
            status = no_memory(from);
    }
    pir_hull_finish(&hull, from->allocator);
    for (uint32_t v = 0; status == PIR_OK && v < polytope->vertex_count; v++) {
        polytope->source[v] = operand->source[v];
        if (!pir_vec_is_finite(polytope->vertex[v]))
            status = broken(from, "a coordinate beyond the doubles");
    }
    if (status == PIR_OK)
        *ret = polytope;
    else
        pir_polytope_release(polytope);
    return status;
}

/* Reads one operand, at scale 1 and at its scale of now. */
static pir_status get_operand(struct source *from, struct operand *operand, pir_polytope **ret_made,
                              pir_polytope **ret_now) {
    if (!are_left(from, 4, 4))
        return broken(from, "truncated");
    operand->dimension = get_u32(from);
    uint32_t vertices = get_u32(from);
    operand->facets = get_u32(from);
    operand->width = get_u32(from);
    if (operand->dimension > 3 || vertices == 0 || vertices >= (uint32_t)1 << 30 || operand->width == 0 ||
        operand->width > PIR_SUM_COORDINATE_MAX)
        return broken(from, "a dimension or count out of range");
    operand->vertices = vertices;
    pir_status status = get_scale(from, &operand->room, &operand->scale);
    if (status == PIR_OK)
        status = get_vertices(from, operand);
    if (status == PIR_OK)
        status = get_facets(from, operand);
    pir_polytope *made = NULL, *now = NULL;
    if (status == PIR_OK)
        status = build_polytope(from, operand, &made);
    if (status == PIR_OK && !are_left(from, 1, 4))
        status = broken(from, "truncated");
    uint32_t scaled = status == PIR_OK ? get_u32(from) : 0;
    if (scaled > 1)
        status = broken(from, "neither scaled nor not");
    pir_scale scale;
    if (status == PIR_OK && scaled)
        status = get_scale(from, &operand->room, &scale);
    if (status == PIR_OK) {
        pir_status built = PIR_OK;
        if (scaled)
            built = pir_polytope_rescale(made, &scale, &now);
        else
            now = pir_polytope_retain(made);
        if (built != PIR_OK)
            status = built == PIR_ERR_MEMORY ? no_memory(from) : broken(from, "a scale beyond the doubles");
    }
    if (status == PIR_OK) {
        *ret_made = made;
        *ret_now = now;
    } else {
        pir_polytope_release(made);
    }
    return status;
}

/* --- the sum --- */

/* Vertices of `other` into `cell`; none only where there is a region. */
static pir_status get_cells(struct source *from, uint32_t *cell, uint32_t count, const pir_polytope *other) {
    for (uint32_t i = 0; i < count; i++) {
        cell[i] = get_u32(from);
        if (cell[i] >= other->vertex_count && !(from->has_region && cell[i] == PIR_NO_PAIR))
            return broken(from, "a pair with no vertex");
    }
    return PIR_OK;
}

static pir_status get_pairing(struct source *from, pir_sum *sum) {
    const pir_polytope *p = sum->p, *q = sum->q;
    if (!are_left(from, (uint64_t)p->facet_count + q->facet_count + p->edge_count, 4))
        return broken(from, "truncated");
    pir_status status = get_cells(from, sum->fv, p->facet_count, q);
    if (status == PIR_OK)
        status = get_cells(from, sum->vf, q->facet_count, p);
    if (status != PIR_OK)
        return status;
    size_t counts_at = from->at;
    uint64_t total = 0;
    for (uint32_t e = 0; e < p->edge_count; e++)
        total += get_u32(from);
    if (!are_left(from, total, 4))
        return broken(from, "truncated, or numbers of crossings that lie");
    if (total > UINT32_MAX / 8 || !pir_crossings_reserve(sum, (uint32_t)total))
        return no_memory(from);
    struct source counts = *from;
    counts.at = counts_at;
    pir_crossings_clear(sum);
    for (uint32_t e = 0; e < p->edge_count; e++) {
        uint32_t last = PIR_NO_CROSSING;
        for (uint32_t n = get_u32(&counts); n > 0; n--) {
            uint32_t code = get_u32(from);
            if (code / 2 >= q->edge_count)
                return broken(from, "a crossing with no edge of Q");
            uint32_t half = q->edge_half[code / 2];
            if (!pir_crossing_append(sum, e, code % 2 ? q->twin[half] : half, &last))
                return no_memory(from);
        }
    }
    pir_expire_all(sum);
    return from->at == from->size ? PIR_OK : broken(from, "bytes past the end");
}

static bool is_unit(pir_vec3 v) {
    return fabs(pir_vec_dot(v, v) - 1) <= 0x1p-40;
}

static pir_status get_region(struct source *from, pir_cone *ret_cone, pir_cover *ret_cover) {
    if (!are_left(from, 1, 13 * 8))
        return broken(from, "truncated");
    pir_vec3 axis = get_vec(from);
    double half_angle = get_double(from);
    pir_vec3 axis_p = get_vec(from), axis_q = get_vec(from);
    double skin_p = get_double(from), skin_q = get_double(from), stride = get_double(from);
    if (!is_unit(axis) || !is_unit(axis_p) || !is_unit(axis_q))
        return broken(from, "an axis that is not of unit length");
    if (pir_cone_make(axis, half_angle, ret_cone) != PIR_OK || !ret_cone->set)
        return broken(from, "a half-angle of no cone");
    // as it was, to the bit
    ret_cone->axis = axis;
    *ret_cover = pir_cover_make(ret_cone, false, axis_p, axis_q, skin_p, skin_q, stride);
    if (ret_cover->skin_p != skin_p || ret_cover->skin_q != skin_q || ret_cover->stride != stride)
        return broken(from, "a skin or stride out of bounds");
    return PIR_OK;
}

/* Limits the pairing that was read to the region. */
static pir_status set_region(const struct source *from, pir_sum *sum, const pir_cone *cone, const pir_cover *cover) {
    bool fits;
    if (!pir_region_adopt(sum, cone, cover, &fits))
        return no_memory(from);
    return fits ? PIR_OK : broken(from, "not the pairs that the region asks for");
}

/* The rotation shown and the tolerance, once the pairing is there. */
static pir_status set_lag(const struct source *from, pir_sum *sum, double tolerance, bool lagging, pir_quat shown) {
    if (pir_sum_set_tolerance(sum, tolerance) != PIR_OK)
        return broken(from, "a tolerance that is no length");
    bool done = true;
    if (lagging && (pir_lag_behind(sum, shown, &done) != PIR_OK || !done))
        return broken(from, "a rotation shown that is not within the tolerance");
    return PIR_OK;
}

static pir_status get_sum(struct source *from, pir_polytope *const made[2], pir_polytope *const now[2],
                          pir_sum **ret_sum) {
    from->part = "motion";
    if (!are_left(from, 1, 5 * 8 + 4))
        return broken(from, "truncated");
    pir_quat rotation = get_quat(from), shown = rotation;
    double tolerance = get_double(from);
    uint32_t lagging = get_u32(from);
    if (lagging > 1 || (lagging && !are_left(from, 1, 4 * 8)))
        return broken(from, "truncated, or neither lagging nor not");
    if (lagging)
        shown = get_quat(from);
    pir_sum *sum = NULL;
    pir_status status = pir_sum_new(now[0], now[1], rotation, from->allocator, &sum);
    if (status == PIR_ERR_MEMORY)
        return no_memory(from);
    if (status != PIR_OK)
        return broken(from, pir_status_text(status));
    for (int i = 0; i < 2; i++) {
        pir_polytope_release(sum->made_of[i]);
        sum->made_of[i] = pir_polytope_retain(made[i]);
    }
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
        status = broken(from, "not the pairing at this rotation");
    if (status == PIR_OK)
        status = set_lag(from, sum, tolerance, lagging == 1, shown);
    if (status != PIR_OK) {
        pir_sum_destroy(sum);
        return status;
    }
    sum->difference = from->is_difference;
    pir_sum_reset_statistics(sum);
    *ret_sum = sum;
    return PIR_OK;
}

/* Whether the header, all of which is there, is that of a sum; takes the length it tells. */
static pir_status get_header(struct source *from, uint64_t *ret_length, uint64_t *ret_checksum) {
    if (memcmp(from->data, PIR_SUM_MAGIC, 8) != 0)
        return broken(from, "these bytes are no sum");
    from->at = 8;
    uint32_t version = get_u32(from);
    if (version != PIR_SUM_VERSION)
        return pir_fail(from->report, PIR_ERR_UNSUPPORTED, "sum: header: version %u, this library reads version %u",
                        (unsigned)version, PIR_SUM_VERSION);
    uint32_t flags = get_u32(from);
    if (flags & ~(PIR_SUM_REGION | PIR_SUM_DIFFERENCE))
        return broken(from, "flags that no sum has");
    from->has_region = flags & PIR_SUM_REGION;
    from->is_difference = flags & PIR_SUM_DIFFERENCE;
    *ret_length = get_u64(from);
    *ret_checksum = get_u64(from);
    return *ret_length < PIR_SUM_HEADER_SIZE ? broken(from, "a length that lies") : PIR_OK;
}

pir_status pir_sum_restore(const void *data, size_t size, const pir_allocator *allocator, pir_report *report,
                           pir_sum **ret_sum) {
    if (!data || !ret_sum)
        return pir_fail(report, PIR_ERR_ARGUMENT, "sum: no data, or nowhere to put the sum");
    const pir_allocator used = pir_allocator_or_default(allocator);
    struct source from = {data, size, 0, "header", false, false, &used, report};
    if (size == 0)
        return pir_fail(report, PIR_ERR_EMPTY, "sum: no bytes at all");
    if (size < PIR_SUM_HEADER_SIZE)
        return broken(&from, "truncated");
    uint64_t length, checksum;
    pir_status status = get_header(&from, &length, &checksum);
    if (status != PIR_OK)
        return status;
    if (length != size)
        return broken(&from, length > size ? "truncated" : "bytes past the end");
    if (checksum != pir_sum_file_checksum(data, size))
        return broken(&from, "the checksum does not match: the bytes are corrupted");
    static const char *const parts[2] = {"operand P", "operand Q"};
    pir_polytope *made[2] = {NULL, NULL}, *now[2] = {NULL, NULL};
    struct operand *operand = PIR_NEW(&used, struct operand, 1);
    if (!operand)
        return no_memory(&from);
    for (int i = 0; status == PIR_OK && i < 2; i++) {
        from.part = parts[i];
        *operand = (struct operand){0};
        status = get_operand(&from, operand, &made[i], &now[i]);
        finish_operand(operand, &used);
    }
    PIR_FREE(&used, operand, 1);
    if (status == PIR_OK)
        status = get_sum(&from, made, now, ret_sum);
    for (int i = 0; i < 2; i++) {
        pir_polytope_release(made[i]);
        pir_polytope_release(now[i]);
    }
    return status;
}

/* --- files --- */

/* What is read at a time before the file has shown that it is as long as it says. */
#define CHUNK ((size_t)1 << 16)

/* Brings the block up to `length` bytes from the file; the block grows as bytes come. */
static pir_status fill(FILE *file, const struct source *from, uint8_t **data, size_t *size, size_t length) {
    while (*size < length) {
        size_t more = *size < CHUNK ? CHUNK : *size;
        if (more > length - *size)
            more = length - *size;
        uint8_t *grown = PIR_RESIZE(from->allocator, *data, *size, *size + more);
        if (!grown)
            return no_memory(from);
        *data = grown;
        size_t got = fread(grown + *size, 1, more, file);
        *size += more;
        if (got != more)
            return ferror(file) ? pir_fail(from->report, PIR_ERR_FILE, "sum: the file cannot be read")
                                : broken(from, "the file ends before the sum does");
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
    struct source from = {NULL, 0, 0, "header", false, false, &used, report};
    pir_status status = fill(file, &from, &data, &size, PIR_SUM_HEADER_SIZE);
    if (status == PIR_OK) {
        from.data = data;
        status = get_header(&from, &length, &checksum);
    }
    if (status == PIR_OK && length > SIZE_MAX / 2)
        status = broken(&from, "a length that lies");
    if (status == PIR_OK)
        status = fill(file, &from, &data, &size, (size_t)length);
    if (status == PIR_OK)
        status = pir_sum_restore(data, size, allocator, report, ret_sum);
    PIR_FREE(&used, data, size);
    return status;
}
