/* SPDX-License-Identifier: MIT */
/* See opening_polygon.h. */
#include "plan/opening/opening_polygon.h"

#include <math.h>
#include <stdlib.h>

void pir_opening_half_init(pir_opening_half *half) {
    mpq_inits(half->m[0], half->m[1], half->m[2], half->c, NULL);
}

void pir_opening_half_clear(pir_opening_half *half) {
    mpq_clears(half->m[0], half->m[1], half->m[2], half->c, NULL);
}

static void dot(const mpq_t a[3], const mpq_t b[3], mpq_t ret) {
    mpq_t t;
    mpq_init(t);
    mpq_set_ui(ret, 0, 1);
    for (int k = 0; k < 3; k++) {
        mpq_mul(t, a[k], b[k]);
        mpq_add(ret, ret, t);
    }
    mpq_clear(t);
}

/* (b − a) × way, or way × (b − a) where it is turned. */
static void cross(const mpq_t a[3], const mpq_t b[3], const mpq_t way[3], bool turned, mpq_t ret[3]) {
    mpq_t d[3], t;
    mpq_inits(d[0], d[1], d[2], t, NULL);
    for (int k = 0; k < 3; k++)
        mpq_sub(d[k], turned ? a[k] : b[k], turned ? b[k] : a[k]);
    for (int k = 0; k < 3; k++) {
        mpq_mul(ret[k], d[(k + 1) % 3], way[(k + 2) % 3]);
        mpq_mul(t, d[(k + 2) % 3], way[(k + 1) % 3]);
        mpq_sub(ret[k], ret[k], t);
    }
    mpq_clears(d[0], d[1], d[2], t, NULL);
}

void pir_opening_half_of_facet(const mpq_t (*vertex)[3], const uint32_t corner[3], pir_opening_half *ret_half) {
    mpq_t way[3];
    mpq_inits(way[0], way[1], way[2], NULL);
    for (int k = 0; k < 3; k++)
        mpq_sub(way[k], vertex[corner[2]][k], vertex[corner[0]][k]);
    cross(vertex[corner[0]], vertex[corner[1]], (const mpq_t *)way, false, ret_half->m);
    dot((const mpq_t *)ret_half->m, vertex[corner[0]], ret_half->c);
    mpq_clears(way[0], way[1], way[2], NULL);
}

void pir_opening_half_of_side(const mpq_t n[3], const mpq_t a[3], const mpq_t b[3], pir_opening_half *ret_half) {
    cross(a, b, n, false, ret_half->m); // to the right
    dot((const mpq_t *)ret_half->m, a, ret_half->c);
}

void pir_opening_half_value(const pir_opening_half *half, const mpq_t x[3], mpq_t ret_value) {
    dot((const mpq_t *)half->m, x, ret_value);
    mpq_sub(ret_value, ret_value, half->c);
}

bool pir_opening_polygon_new(uint32_t count, pir_opening_polygon *ret_polygon) {
    *ret_polygon = (pir_opening_polygon){.at = calloc(count + 1, sizeof *ret_polygon->at)};
    if (!ret_polygon->at)
        return false;
    ret_polygon->count = count;
    for (uint32_t i = 0; i < count; i++)
        mpq_inits(ret_polygon->at[i][0], ret_polygon->at[i][1], ret_polygon->at[i][2], NULL);
    return true;
}

void pir_opening_polygon_free(pir_opening_polygon *polygon) {
    for (uint32_t i = 0; i < polygon->count; i++)
        mpq_clears(polygon->at[i][0], polygon->at[i][1], polygon->at[i][2], NULL);
    free(polygon->at);
    *polygon = (pir_opening_polygon){0};
}

void pir_opening_polygon_bound(pir_opening_polygon *polygon) {
    for (int k = 0; k < 3; k++) {
        polygon->low[k] = INFINITY;
        polygon->high[k] = -INFINITY;
        for (uint32_t i = 0; i < polygon->count; i++) {
            const double x = mpq_get_d(polygon->at[i][k]), room = fabs(x) * 0x1p-50 + 0x1p-1000;
            polygon->low[k] = fmin(polygon->low[k], x - room);
            polygon->high[k] = fmax(polygon->high[k], x + room);
        }
    }
}

/* The corners of the part: those with a value on the side, and where sides go from one sign to the other. */
static uint32_t put_part(const pir_opening_polygon *polygon, const mpq_t *value, int side, mpq_t (*at)[3]) {
    uint32_t count = 0;
    mpq_t t;
    mpq_init(t);
    for (uint32_t i = 0; i < polygon->count; i++) {
        const uint32_t next = (i + 1) % polygon->count;
        const int sign = side * mpq_sgn(value[i]), other = side * mpq_sgn(value[next]);
        if (sign >= 0) {
            for (int k = 0; k < 3 && at; k++)
                mpq_set(at[count][k], polygon->at[i][k]);
            count++;
        }
        if (sign * other >= 0)
            continue;
        for (int k = 0; k < 3 && at; k++) {
            mpq_sub(t, value[i], value[next]);
            mpq_div(t, value[i], t);
            mpq_sub(at[count][k], polygon->at[next][k], polygon->at[i][k]);
            mpq_mul(at[count][k], at[count][k], t);
            mpq_add(at[count][k], at[count][k], polygon->at[i][k]);
        }
        count++;
    }
    mpq_clear(t);
    return count;
}

bool pir_opening_polygon_clip(const pir_opening_polygon *polygon, const pir_opening_half *half, bool beyond,
                              bool closed, pir_opening_polygon *ret_part) {
    const int side = beyond ? 1 : -1;
    mpq_t *value = calloc(polygon->count + 1, sizeof *value);
    int most = -1;
    *ret_part = (pir_opening_polygon){0};
    if (!value)
        return false;
    for (uint32_t i = 0; i < polygon->count; i++) {
        mpq_init(value[i]);
        pir_opening_half_value(half, (const mpq_t *)polygon->at[i], value[i]);
        const int sign = side * mpq_sgn(value[i]);
        most = sign > most ? sign : most;
    }
    bool good = true;
    if (most >= (closed ? 0 : 1)) {
        good = pir_opening_polygon_new(put_part(polygon, (const mpq_t *)value, side, NULL), ret_part);
        if (good)
            put_part(polygon, (const mpq_t *)value, side, ret_part->at);
        if (good)
            pir_opening_polygon_bound(ret_part);
    }
    for (uint32_t i = 0; i < polygon->count; i++)
        mpq_clear(value[i]);
    free(value);
    return good;
}

bool pir_opening_polygons_add(pir_opening_polygons *list, pir_opening_polygon *polygon) {
    if (list->count == list->room) {
        const uint32_t room = 2 * list->room + 16;
        pir_opening_polygon *more = realloc(list->at, room * sizeof *more);
        if (!more) {
            pir_opening_polygon_free(polygon);
            return false;
        }
        list->at = more;
        list->room = room;
    }
    list->at[list->count++] = *polygon;
    *polygon = (pir_opening_polygon){0};
    return true;
}

void pir_opening_polygons_free(pir_opening_polygons *list) {
    for (uint32_t i = 0; i < list->count; i++)
        pir_opening_polygon_free(&list->at[i]);
    free(list->at);
    *list = (pir_opening_polygons){0};
}
