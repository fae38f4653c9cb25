/* SPDX-License-Identifier: MIT */
/* See jittered.h. A prism's ends are fans about a point that sees all of them; the other facets are convex. */
#include "solid/jittered.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "solid/models.h"
#include "support/test.h"

static uint32_t point_of(jittered *b, pir_vec3 at) {
    for (uint32_t i = 0; i < b->points; i++)
        if (b->point[i].x == at.x && b->point[i].y == at.y && b->point[i].z == at.z)
            return i;
    assert_true(b->points < JITTERED_POINTS);
    b->point[b->points] = at;
    return b->points++;
}

static void add_triangle(jittered *b, pir_vec3 p, pir_vec3 q, pir_vec3 r) {
    assert_true(b->triangles < JITTERED_TRIANGLES);
    uint32_t *corner = b->corner + 3 * b->triangles++;
    corner[0] = point_of(b, p);
    corner[1] = point_of(b, q);
    corner[2] = point_of(b, r);
}

/* A facet that its corner `apex` sees whole. */
static void add_fan(jittered *b, const pir_vec3 *corner, uint32_t count, uint32_t apex) {
    for (uint32_t i = 1; i + 1 < count; i++)
        add_triangle(b, corner[apex], corner[(apex + i) % count], corner[(apex + i + 1) % count]);
}

static bool is_level(const pir_vec3 *corner, uint32_t count) {
    for (uint32_t i = 1; i < count; i++)
        if (corner[i].z != corner[0].z)
            return false;
    return true;
}

/* The facets of a model. Level ones with more than four corners are fans about their middle, the axis. */
static void add_model(jittered *b, const char *name) {
    solid_model *model = solid_model_facets(name, 1);
    assert_non_null(model);
    for (uint32_t f = 0; f < model->facets; f++) {
        pir_vec3 corner[256];
        const uint32_t first = model->start[f], count = model->start[f + 1] - first;
        for (uint32_t i = 0; i < count; i++)
            corner[i] = model->point[model->corner[first + i]];
        if (count > 4 && is_level(corner, count))
            for (uint32_t i = 0; i < count; i++)
                add_triangle(b, (pir_vec3){0, 0, corner[0].z}, corner[i], corner[(i + 1) % count]);
        else
            add_fan(b, corner, count, 0);
    }
    free(model);
}

static void add_l(jittered *b) {
    static const double at[6][2] = {{1, 1}, {1, 2}, {0, 2}, {0, 0}, {2, 0}, {2, 1}};
    pir_vec3 low[6], high[6];
    for (int i = 0; i < 6; i++) {
        low[5 - i] = (pir_vec3){at[i][0], at[i][1], 0};
        high[i] = (pir_vec3){at[i][0], at[i][1], 1};
    }
    add_fan(b, high, 6, 0);
    add_fan(b, low, 6, 5);
    for (int i = 0; i < 6; i++) {
        const int j = (i + 1) % 6;
        add_fan(b, (const pir_vec3[]){low[5 - i], low[5 - j], high[j], high[i]}, 4, 0);
    }
}

void jittered_make(jittered *body, int which) {
    static const char *const names[JITTERED_BODIES] = {"cube", "L", "stella", "frame", "star5", "gear8", "mushroom6"};
    *body = (jittered){.name = names[which]};
    if (which == JITTERED_L)
        add_l(body);
    else
        add_model(body, names[which]);
}

void jittered_move(jittered *body, test_random *random) {
    for (uint32_t moves = 1 + test_random_below(random, 3); moves > 0; moves--) {
        pir_vec3 *point = &body->point[test_random_below(random, body->points)];
        double *c = (double *[]){&point->x, &point->y, &point->z}[test_random_below(random, 3)];
        const double way = test_random_below(random, 2) ? 1 : -1;
        if (test_random_below(random, 2))
            *c = nextafter(*c, way * HUGE_VAL);
        else
            *c += way * ldexp(1, -test_random_between(random, 10, 52));
    }
}

pir_solid *jittered_solid(const jittered *body) {
    uint32_t start[JITTERED_TRIANGLES + 1];
    for (uint32_t i = 0; i <= body->triangles; i++)
        start[i] = 3 * i;
    const pir_solid_facets facets = {body->point, body->points, start, body->corner, body->triangles};
    pir_solid *solid = NULL;
    return pir_solid_create(&facets, NULL, NULL, &solid) == PIR_OK ? solid : NULL;
}
