/* SPDX-License-Identifier: MIT */
/*
 * Signs over lines and directions of maps.
 *
 * Errors, with u = 2^-53. A polytope's unit vectors are within 8u (polytope.h); rotated by a matrix within 31u
 * (rotation.h), which rounds by 5.3u (sign.h), within 45u. A cube plane's (±1, ±1, 0)/√2 is within 2u. A meeting
 * direction v = a × b, |a|, |b| ≤ 1 + 2^-40, is off by e = |δa| + |δb| + 5u before it is made a unit vector, which
 * then is within 2e/|v| + 4u of the true one as long as e < |v|/2. A dot product of unit vectors rounds by less than
 * 4u, a triple product by less than 12u.
 */
#include "cgm/sides.h"

#define U 0x1p-53

/* An error above every value that a filter compares with it, so that the integers decide. */
#define UNKNOWN_ERROR 4.0

uint32_t pir_cgm_point_limbs(const pir_cgm *cgm) {
    uint32_t meeting = 2 * cgm->line_limbs + 1;
    return cgm->normal_limbs > meeting ? cgm->normal_limbs : meeting;
}

bool pir_cgm_sides_init(struct pir_cgm_sides *sides, const pir_allocator *allocator, const pir_cgm *a,
                        const pir_cgm *b) {
    uint32_t line = a->line_limbs > b->line_limbs ? a->line_limbs : b->line_limbs;
    uint32_t pa = pir_cgm_point_limbs(a), pb = pir_cgm_point_limbs(b), point = pa > pb ? pa : pb;
    /*
     * pir_cgm_ahead takes most: two directions of three components, their cross product (2 point + 1 limbs), a line, a
     * dot product (2 point + line + 2) and one product on the way to it. While a direction is made from two lines,
     * those two and one product of theirs stand in its stead.
     */
    uint32_t capacity = 3 * (5 * (line + 1) + 2 * (point + 1) + (2 * point + 1)) + 4 * (2 * point + line + 4);
    mp_limb_t *base = PIR_NEW(allocator, mp_limb_t, capacity);
    if (!base)
        return false;
    *sides = (struct pir_cgm_sides){.scratch = {base, 0, capacity}};
    return true;
}

void pir_cgm_sides_finish(struct pir_cgm_sides *sides, const pir_allocator *allocator) {
    PIR_FREE(allocator, sides->scratch.base, sides->scratch.capacity);
    sides->scratch = (pir_limbs){0};
}

static pir_vec3 signed_unit(const pir_cgm *cgm, uint32_t line) {
    return pir_vec_scale(cgm->line[line >> 1].unit, line & 1 ? -1 : 1);
}

/* --- exact values --- */

/* The vector turned by the source's rotation, in scratch, or as it is. */
static pir_int3 rotate(const struct pir_cgm_source *source, pir_int3 v, pir_limbs *scratch) {
    if (!source->rotation)
        return v;
    pir_int3 turned = pir_int3_take(scratch, pir_int3_length(&v) + PIR_MATRIX_LIMBS + 1);
    pir_rotation_apply(source->rotation, &turned, &v, scratch);
    return turned;
}

pir_int3 pir_cgm_line_exact(const pir_cgm *cgm, uint32_t line, pir_limbs *scratch) {
    uint32_t number = line >> 1;
    pir_int3 v;
    if (number < PIR_CUBE_PLANES) {
        int c[3];
        pir_cube_plane(number, c);
        v = pir_int3_take(scratch, 1);
        for (int k = 0; k < 3; k++) {
            v.c[k].limb[0] = 1;
            v.c[k].size = c[k];
        }
    } else {
        const struct pir_cgm_source *source = &cgm->source[cgm->source_count - 1];
        while (source->line_start > number)
            source--;
        v = rotate(source, pir_vectors_at(&source->polytope->exact_edge, number - source->line_start), scratch);
    }
    for (int k = 0; k < 3 && (line & 1); k++)
        pir_int_negate(&v.c[k]);
    return v;
}

pir_int3 pir_cgm_point_exact(const pir_cgm *cgm, const struct pir_cgm_point *point, pir_limbs *scratch) {
    if (point->b == PIR_CGM_NONE) {
        const struct pir_cgm_source *source = &cgm->source[cgm->source_count - 1];
        while (source->normal_start > point->a)
            source--;
        return rotate(source, pir_normal_exact(source->polytope, point->a - source->normal_start), scratch);
    }
    pir_int3 v = pir_int3_take(scratch, 2 * cgm->line_limbs + 1);
    uint32_t mark = scratch->used;
    pir_int3 a = pir_cgm_line_exact(cgm, point->a, scratch), b = pir_cgm_line_exact(cgm, point->b, scratch);
    pir_int3_cross(&v, &a, &b, scratch);
    scratch->used = mark;
    return v;
}

/* --- signs --- */

/* The side that a value by doubles, off by less than the bound, is on of a line; 0 where that is not certain. */
static int filtered(struct pir_cgm_sides *sides, uint32_t line, double value, double bound) {
    bool certain = value > bound || value < -bound;
    sides->by_filter += certain;
    sides->by_exact += !certain;
    return !certain ? 0 : (value > 0) != (line & 1) ? 1 : -1;
}

/* The sign of x·y, by integers; what was taken from the scratch since `mark` goes back. */
static int sign_of_dot(pir_limbs *scratch, uint32_t mark, const pir_int3 *x, const pir_int3 *y) {
    pir_int product = pir_limbs_take(scratch, pir_int3_length(x) + pir_int3_length(y) + 1);
    pir_int3_dot(&product, x, y, scratch);
    scratch->used = mark;
    return pir_int_sign(&product);
}

int pir_cgm_side(struct pir_cgm_sides *sides, const pir_cgm *a, uint32_t line, const pir_cgm *b,
                 const struct pir_cgm_point *point) {
    const struct pir_cgm_line *l = &a->line[line >> 1];
    double bound = l->error + point->error * (1 + 0x1p-40) + 5 * U;
    int side = filtered(sides, line, pir_vec_dot(l->unit, point->unit), bound);
    if (side != 0)
        return side;
    pir_limbs *scratch = &sides->scratch;
    uint32_t mark = scratch->used;
    pir_int3 x = pir_cgm_line_exact(a, line, scratch), y = pir_cgm_point_exact(b, point, scratch);
    return sign_of_dot(scratch, mark, &x, &y);
}

int pir_cgm_ahead(struct pir_cgm_sides *sides, const pir_cgm *a, uint32_t line, const pir_cgm *b,
                  const struct pir_cgm_point *x, const pir_cgm *c, const struct pir_cgm_point *y) {
    const struct pir_cgm_line *l = &a->line[line >> 1];
    double bound = (l->error + x->error + y->error) * 2 + 12 * U;
    int side = filtered(sides, line, pir_vec_dot(l->unit, pir_vec_cross(x->unit, y->unit)), bound);
    if (side != 0)
        return side;
    pir_limbs *scratch = &sides->scratch;
    uint32_t mark = scratch->used;
    pir_int3 vx = pir_cgm_point_exact(b, x, scratch), vy = pir_cgm_point_exact(c, y, scratch);
    pir_int3 cross = pir_int3_take(scratch, pir_int3_length(&vx) + pir_int3_length(&vy) + 1);
    pir_int3_cross(&cross, &vx, &vy, scratch);
    pir_int3 v = pir_cgm_line_exact(a, line, scratch);
    return sign_of_dot(scratch, mark, &cross, &v);
}

bool pir_cgm_same_way(const pir_cgm *a, uint32_t line, const pir_cgm *b, uint32_t other) {
    // the true product of the unit vectors is 1 or −1: no rounding can hide which
    return pir_vec_dot(signed_unit(a, line), signed_unit(b, other)) > 0;
}

struct pir_cgm_point pir_cgm_meet(const pir_cgm *cgm, uint32_t a, uint32_t b) {
    pir_vec3 v = pir_vec_cross(signed_unit(cgm, a), signed_unit(cgm, b));
    double length = sqrt(pir_vec_dot(v, v)), off = cgm->line[a >> 1].error + cgm->line[b >> 1].error + 5 * U;
    struct pir_cgm_point point = {.a = a, .b = b, .error = UNKNOWN_ERROR};
    if (length > 0)
        point.unit = pir_vec_scale(v, 1 / length);
    if (length > 4 * off)
        point.error = 2 * off / (length - off) + 6 * U;
    return point;
}
