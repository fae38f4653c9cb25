/* SPDX-License-Identifier: MIT */
/* See place_oracle.h. */
#include "query/place_oracle.h"

#include <math.h>
#include <stdlib.h>

#include "oracle/place.h"

struct place_oracle {
    oracle_solid *p, *q;
    oracle_place *place;
    uint32_t count; /* vertices of the difference as doubles, and perhaps points between others on a facet */
    pir_vec3 *vertex;
};

static const pir_vec3 nowhere = {0, 0, 0};

/* A vertex lies in three facets at least; in a flat difference all differences of vertices are taken. */
static void list_vertices(place_oracle *o) {
    uint32_t n = o->p->count, m = o->q->count, *planes = oracle_new((size_t)n * m, sizeof *planes);
    for (uint32_t f = 0; f < o->place->plane_count; f++)
        for (uint32_t i = 0; i < n; i++)
            for (uint32_t j = 0; oracle_set_has(o->place->plane[f].p, i) && j < m; j++)
                planes[i * m + j] += (uint32_t)oracle_set_has(o->place->plane[f].q, j);
    o->vertex = oracle_new((size_t)n * m, sizeof *o->vertex);
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < m; j++)
            if (planes[i * m + j] > 2 || o->place->dimension < 3)
                o->vertex[o->count++] = oracle_place_vertex(o->place, i, j);
    free(planes);
}

place_oracle *place_oracle_make(pir_polytope *p, pir_polytope *q, pir_quat rotation) {
    place_oracle *o = oracle_new(1, sizeof *o);
    o->p = oracle_solid_make(p);
    o->q = oracle_solid_make(q);
    o->place = oracle_place_make(o->p, o->q, rotation);
    list_vertices(o);
    return o;
}

void place_oracle_free(place_oracle *o) {
    oracle_place_free(o->place);
    oracle_solid_free(o->p);
    oracle_solid_free(o->q);
    free(o->vertex);
    free(o);
}

place_answer place_oracle_ask(place_oracle *o, pir_vec3 translation) {
    oracle_place_set(o->place, translation, nowhere);
    place_answer answer = {oracle_place_state(o->place), 0, HUGE_VAL};
    if (answer.state == PIR_INSIDE)
        answer.depth = oracle_place_slack(o->place, oracle_place_deepest(o->place));
    if (answer.state == PIR_OUTSIDE)
        answer.distance = oracle_place_nearest(o->place, NULL, NULL).distance;
    return answer;
}

double place_oracle_slack(place_oracle *o, pir_vec3 translation, pir_vec3 direction) {
    oracle_place_set(o->place, translation, nowhere);
    return oracle_place_reach(o->place, direction);
}

/* The first vertex of a set from `from` on, around. */
static uint32_t next_of(const oracle_set *set, uint32_t count, uint32_t from) {
    uint32_t i = from % count;
    while (!oracle_set_has(set, i))
        i = (i + 1) % count;
    return i;
}

pir_vec3 place_oracle_vertex(const place_oracle *o, uint32_t index) {
    return o->vertex[index % o->count];
}

pir_vec3 place_oracle_on_facet(const place_oracle *o, uint32_t index) {
    const oracle_plane *plane = &o->place->plane[index % o->place->plane_count];
    pir_vec3 sum = {0, 0, 0};
    uint32_t count = 0;
    for (uint32_t i = 0; i < o->p->count; i++)
        for (uint32_t j = 0; j < o->q->count; j++) {
            if (!oracle_set_has(plane->p, i) || !oracle_set_has(plane->q, j))
                continue;
            pir_vec3 v = oracle_place_vertex(o->place, i, j);
            sum = (pir_vec3){sum.x + v.x, sum.y + v.y, sum.z + v.z};
            count++;
        }
    return (pir_vec3){sum.x / count, sum.y / count, sum.z / count};
}

pir_vec3 place_oracle_on_edge(const place_oracle *o, uint32_t index) {
    // where one body has one vertex in the plane, neighbours of the other's make edges
    const oracle_plane *plane = &o->place->plane[index % o->place->plane_count];
    uint32_t i = next_of(plane->p, o->p->count, index), j = next_of(plane->q, o->q->count, index);
    uint32_t k = next_of(plane->p, o->p->count, i + 1), l = k == i ? next_of(plane->q, o->q->count, j + 1) : j;
    pir_vec3 u = oracle_place_vertex(o->place, i, j), v = oracle_place_vertex(o->place, k, l);
    return (pir_vec3){(u.x + v.x) / 2, (u.y + v.y) / 2, (u.z + v.z) / 2};
}

double place_oracle_size(const place_oracle *o) {
    pir_vec3 low = o->vertex[0], high = low;
    for (uint32_t i = 1; i < o->count; i++) {
        pir_vec3 v = o->vertex[i];
        low = (pir_vec3){fmin(low.x, v.x), fmin(low.y, v.y), fmin(low.z, v.z)};
        high = (pir_vec3){fmax(high.x, v.x), fmax(high.y, v.y), fmax(high.z, v.z)};
    }
    double x = high.x - low.x, y = high.y - low.y, z = high.z - low.z;
    return sqrt(x * x + y * y + z * z);
}
