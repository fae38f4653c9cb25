/* SPDX-License-Identifier: MIT */
/* See symmetries.h. */
#include "plan/rotations/symmetries.h"

#include <stdlib.h>
#include <string.h>

#define SIGNS   8 /* of three coordinates */
#define NEITHER 63
#define UNIT    (1 << 20)

/* --- bodies --- */

/* Corners of a piece in an order that tells equal sets. */
static int compare_corners(const void *a, const void *b) {
    const double *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p[k] != q[k])
            return p[k] < q[k] ? -1 : 1;
    return 0;
}

/* Lists the corners of a piece with signs, in order. */
static void list_corners(const pir_polytope *piece, uint32_t signs, double (*ret_x)[3]) {
    const uint32_t count = pir_polytope_vertex_count(piece);
    for (uint32_t v = 0; v < count; v++) {
        const pir_vec3 at = pir_polytope_vertex(piece, v);
        const double x[3] = {at.x, at.y, at.z};
        for (int k = 0; k < 3; k++)
            ret_x[v][k] = signs >> k & 1 ? -x[k] : x[k];
    }
    qsort(ret_x, count, sizeof *ret_x, compare_corners);
}

/* Whether one of the pieces is the image of a piece, whose corners are listed. */
static bool has_image(const pir_plan_pieces *pieces, const double (*x)[3], uint32_t count, double (*other)[3]) {
    for (uint32_t i = 0; i < pieces->count; i++) {
        bool same = pir_polytope_vertex_count(pieces->at[i]) == count;
        if (same)
            list_corners(pieces->at[i], 0, other);
        for (uint32_t v = 0; v < count && same; v++)
            same = compare_corners(x[v], other[v]) == 0;
        if (same)
            return true;
    }
    return false;
}

/* Which signs map pieces to pieces, as a set of bits; images of different pieces are different. */
static uint32_t signs_of(const pir_plan_pieces *pieces) {
    uint32_t most = 1, kept = 1;
    for (uint32_t i = 0; i < pieces->count; i++) {
        const uint32_t count = pir_polytope_vertex_count(pieces->at[i]);
        most = count > most ? count : most;
    }
    double(*x)[3] = calloc(most, sizeof *x), (*other)[3] = calloc(most, sizeof *other);
    for (uint32_t signs = 1; signs < SIGNS && x && other; signs++) {
        bool all = true;
        for (uint32_t i = 0; i < pieces->count && all; i++) {
            list_corners(pieces->at[i], signs, x);
            all = has_image(pieces, (const double(*)[3])x, pir_polytope_vertex_count(pieces->at[i]), other);
        }
        kept |= (uint32_t)all << signs;
    }
    free(x);
    free(other);
    return kept;
}

static bool is_odd(uint32_t signs) {
    return (signs ^ signs >> 1 ^ signs >> 2) & 1;
}

static bool has_signs(const pir_symmetries *s, uint32_t signs) {
    for (uint32_t i = 0; i < s->count; i++)
        if (s->signs[i] == signs)
            return true;
    return false;
}

pir_symmetries pir_symmetries_of(const pir_plan_pieces *robot, const pir_plan_pieces *obstacles, const double low[3],
                                 const double high[3]) {
    pir_symmetries s = {.count = 1};
    const uint32_t of_robot = signs_of(robot);
    uint32_t of_places = signs_of(obstacles);
    for (uint32_t d = 0; d < SIGNS; d++)
        for (int k = 0; k < 3; k++)
            if (d >> k & 1 && low[k] != -high[k])
                of_places &= ~(1u << d);
    for (uint32_t signs = 1; signs < NEITHER; signs++) {
        const uint32_t d = signs % SIGNS, e = signs / SIGNS;
        if (is_odd(d) != is_odd(e) || !(of_places >> d & 1) || !(of_robot >> e & 1) || has_signs(&s, signs) ||
            has_signs(&s, signs ^ NEITHER))
            continue;
        for (uint32_t i = 0; i < s.count; i++)
            s.signs[s.count + i] = (uint8_t)(s.signs[i] ^ signs);
        s.count *= 2;
    }
    return s;
}

/* --- boxes --- */

static void multiply(const int32_t a[4], const int32_t b[4], int32_t ret[4]) {
    const int32_t product[4] = {
        a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1], a[3] * b[1] + a[1] * b[3] + a[2] * b[0] - a[0] * b[2],
        a[3] * b[2] + a[2] * b[3] + a[0] * b[1] - a[1] * b[0], a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
    memcpy(ret, product, sizeof product);
}

/* The quaternion of signs, or of their opposites: of the two that have an even number of negative ones. */
static void turn_of(uint32_t signs, int32_t ret[4]) {
    const uint32_t even = is_odd(signs) ? signs ^ (SIGNS - 1) : signs;
    for (int k = 0; k < 3; k++)
        ret[k] = even != 0 && !(even >> k & 1);
    ret[3] = even == 0;
}

pir_rotation_box pir_symmetries_image(const pir_symmetries *symmetries, uint32_t number, pir_rotation_box box) {
    const uint32_t signs = symmetries->signs[number];
    int32_t end[2][4], d[4], e[4];
    turn_of(signs % SIGNS, d);
    turn_of(signs / SIGNS, e);
    pir_rotation_box_bounds(box, end[0], end[1]);
    for (int s = 0; s < 2; s++) {
        multiply(d, end[s], end[s]);
        multiply(end[s], e, end[s]);
    }
    pir_rotation_box image = {.level = box.level};
    for (uint8_t c = 0; c < 4; c++)
        if (end[0][c] == end[1][c])
            image.chart = c;
    const int32_t sign = end[0][image.chart] > 0 ? 1 : -1, width = 2 * UNIT >> box.level;
    for (int c = 0, k = 0; c < 4; c++) {
        const int32_t a = sign * end[0][c], b = sign * end[1][c];
        if (c != image.chart)
            image.at[k++] = (uint32_t)(((a < b ? a : b) + UNIT) / width);
    }
    return image;
}
