/* SPDX-License-Identifier: MIT */
/*
 * Two convex bodies of small integers, one beside the other or a cavity in it, touch or meet in many ways. Whether that
 * is a solid is found by separating planes in integers; the volume is the sum, or the difference.
 *
 * PIR_TEST_CASES sets how many cases there are.
 */
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#include <pirouette/exact.h>
#include <pirouette/pirouette.h>

#include "solid/bodies.h"

static solid_facets facets;

#define CORNERS 8
#define SIDES   16

typedef struct point {
    int64_t x[3];
} point;

typedef struct side {
    point normal;
    uint32_t count, corner[CORNERS];
} side;

typedef struct body {
    pir_mesh *mesh;
    uint32_t points, sides;
    point at[CORNERS];
    side side[SIDES];
} body;

static point minus(point a, point b) {
    return (point){{a.x[0] - b.x[0], a.x[1] - b.x[1], a.x[2] - b.x[2]}};
}

static point cross(point a, point b) {
    return (point){
        {a.x[1] * b.x[2] - a.x[2] * b.x[1], a.x[2] * b.x[0] - a.x[0] * b.x[2], a.x[0] * b.x[1] - a.x[1] * b.x[0]}};
}

static int64_t dot(point a, point b) {
    return a.x[0] * b.x[0] + a.x[1] * b.x[1] + a.x[2] * b.x[2];
}

/* The hull of points. */
static body body_of(const pir_vec3 *at, size_t count) {
    body made = {0};
    pir_polytope *hull = NULL;
    assert_int_equal(pir_polytope_create(at, count, NULL, &hull), PIR_OK);
    const int dimension = pir_polytope_dimension(hull);
    if (dimension == 3)
        assert_int_equal(pir_mesh_from_polytope(hull, &made.mesh), PIR_OK);
    pir_polytope_release(hull);
    if (dimension < 3)
        return made;
    made.points = pir_mesh_vertex_count(made.mesh);
    made.sides = pir_mesh_facet_count(made.mesh);
    for (uint32_t i = 0; i < made.points; i++) {
        const pir_vec3 v = pir_mesh_vertices(made.mesh)[i];
        made.at[i] = (point){{(int64_t)v.x, (int64_t)v.y, (int64_t)v.z}};
    }
    for (uint32_t f = 0; f < made.sides; f++) {
        side *s = &made.side[f];
        const uint32_t *corner = pir_mesh_facet(made.mesh, f, &s->count);
        memcpy(s->corner, corner, s->count * sizeof *corner);
        s->normal = cross(minus(made.at[corner[1]], made.at[corner[0]]), minus(made.at[corner[2]], made.at[corner[0]]));
    }
    return made;
}

/* A body of up to six points of a grid of steps of 6. */
static body body_at_random(test_random *random, int size, int middle) {
    body made;
    do {
        pir_vec3 at[6];
        const size_t count = 4 + test_random_below(random, 3);
        for (size_t i = 0; i < count; i++)
            at[i] = (pir_vec3){6 * (middle + test_random_between(random, 0, size)),
                               6 * test_random_between(random, 0, size), 6 * test_random_between(random, 0, size)};
        made = body_of(at, count);
    } while (!made.mesh);
    return made;
}

/* A body whose corners are corners of another, or in the middle of two or three, perhaps moved by a step. */
static body body_within(test_random *random, const body *outer) {
    body made;
    do {
        pir_vec3 at[6];
        const size_t count = 4 + test_random_below(random, 3);
        for (size_t i = 0; i < count; i++) {
            const uint32_t of = 1 + test_random_below(random, 3);
            double x[3] = {0, 0, 0};
            for (uint32_t k = 0; k < of; k++) {
                const point *corner = &outer->at[test_random_below(random, outer->points)];
                for (int axis = 0; axis < 3; axis++)
                    x[axis] += (double)corner->x[axis] / of;
            }
            const double off = test_random_below(random, 40) == 0;
            at[i] = (pir_vec3){x[0] + off, x[1], x[2]};
        }
        made = body_of(at, count);
    } while (!made.mesh);
    return made;
}

/* How far a body reaches along a direction, at most and at least. */
static void reach(const body *b, point along, int64_t ret[2]) {
    ret[0] = ret[1] = dot(b->at[0], along);
    for (uint32_t i = 1; i < b->points; i++) {
        const int64_t d = dot(b->at[i], along);
        ret[0] = d < ret[0] ? d : ret[0];
        ret[1] = d > ret[1] ? d : ret[1];
    }
}

/* Whether a plane square to a direction has the bodies on its two sides. */
static bool separates(const body *a, const body *b, point along) {
    int64_t of_a[2], of_b[2];
    reach(a, along, of_a);
    reach(b, along, of_b);
    return of_a[1] <= of_b[0] || of_b[1] <= of_a[0];
}

static bool insides_meet(const body *a, const body *b) {
    for (uint32_t f = 0; f < a->sides; f++)
        if (separates(a, b, a->side[f].normal))
            return false;
    for (uint32_t g = 0; g < b->sides; g++)
        if (separates(a, b, b->side[g].normal))
            return false;
    for (uint32_t f = 0; f < a->sides; f++)
        for (uint32_t i = 0; i < a->side[f].count; i++)
            for (uint32_t g = 0; g < b->sides; g++)
                for (uint32_t k = 0; k < b->side[g].count; k++) {
                    const side *s = &a->side[f], *t = &b->side[g];
                    const point u = minus(a->at[s->corner[(i + 1) % s->count]], a->at[s->corner[i]]);
                    const point v = minus(b->at[t->corner[(k + 1) % t->count]], b->at[t->corner[k]]);
                    const point along = cross(u, v);
                    if (dot(along, along) != 0 && separates(a, b, along))
                        return false;
                }
    return true;
}

/* Whether a line along a side of one of two facets in one plane separates them. */
static bool is_separate(const body *a, const side *s, const body *b, const side *t) {
    for (uint32_t i = 0; i < s->count; i++) {
        const point p = a->at[s->corner[i]], u = minus(a->at[s->corner[(i + 1) % s->count]], p);
        bool all = true;
        for (uint32_t k = 0; k < t->count; k++)
            all = all && dot(cross(s->normal, u), minus(b->at[t->corner[k]], p)) <= 0;
        if (all)
            return true;
    }
    return false;
}

/* Whether two bodies have facets that share an area. */
static bool share_area(const body *a, const body *b) {
    for (uint32_t f = 0; f < a->sides; f++)
        for (uint32_t g = 0; g < b->sides; g++) {
            const side *s = &a->side[f], *t = &b->side[g];
            const point turned = cross(s->normal, t->normal);
            if (dot(turned, turned) == 0 && dot(s->normal, minus(b->at[t->corner[0]], a->at[s->corner[0]])) == 0 &&
                !is_separate(a, s, b, t) && !is_separate(b, t, a, s))
                return true;
        }
    return false;
}

static bool is_within(const body *inner, const body *outer) {
    for (uint32_t f = 0; f < outer->sides; f++)
        for (uint32_t i = 0; i < inner->points; i++)
            if (dot(outer->side[f].normal, minus(inner->at[i], outer->at[outer->side[f].corner[0]])) > 0)
                return false;
    return true;
}

/* The body's facets, turned inside out for a cavity; whole or as triangles. */
static void add_body(const body *b, bool inwards, bool triangles) {
    for (uint32_t f = 0; f < b->sides; f++) {
        const side *s = &b->side[f];
        pir_vec3 at[CORNERS] = {{0, 0, 0}};
        for (uint32_t i = 0; i < s->count; i++)
            at[inwards ? s->count - 1 - i : i] = pir_mesh_vertices(b->mesh)[s->corner[i]];
        for (uint32_t i = 1; triangles && i + 1 < s->count; i++)
            solid_add_facet(&facets, (const pir_vec3[]){at[0], at[i], at[i + 1]}, 3);
        if (!triangles)
            solid_add_facet(&facets, at, s->count);
    }
}

/* Whether the surface of both is a solid: touching, each beyond the other or the second a cavity in the first. */
static bool check_pair(const body *a, const body *b, bool cavity, bool triangles, uint64_t number) {
    const bool right = !share_area(a, b) && (cavity ? is_within(b, a) : !insides_meet(a, b));
    pir_solid *solid = NULL;
    pir_report report = {0};
    facets = (solid_facets){0};
    add_body(a, false, triangles);
    add_body(b, cavity, triangles && number % 3);
    const pir_status status = solid_make(&facets, NULL, &report, &solid);
    expect((status == PIR_OK) == right, "case %llu: %s%s", (unsigned long long)number,
           right ? "refused: " : "taken for a solid", report.text);
    if (status != PIR_OK)
        return false;
    mpq_t volume[2];
    mpq_inits(volume[0], volume[1], NULL);
    mesh_volume(a->mesh, volume[0]);
    mesh_volume(b->mesh, volume[1]);
    if (cavity)
        mpq_sub(volume[0], volume[0], volume[1]);
    else
        mpq_add(volume[0], volume[0], volume[1]);
    solid_check_volume(solid, volume[0], number);
    mpq_clears(volume[0], volume[1], NULL);
    pir_solid_release(solid);
    return true;
}

static void convex_bodies_touch_or_cross(void **state) {
    (void)state;
    uint64_t taken[2] = {0, 0};
    const uint64_t cases = solid_cases(1500);
    for (uint64_t i = 0; i < cases; i++) {
        test_random random = test_random_case("touching", i);
        const bool cavity = i % 2;
        const int size = cavity ? 3 + (int)(i / 2 % 3) : 2 + (int)(i / 2 % 4);
        body a = body_at_random(&random, size, 0),
             b = cavity ? body_within(&random, &a) : body_at_random(&random, 2, 1);
        taken[cavity] += check_pair(&a, &b, cavity, i / 8 % 2, i);
        pir_mesh_destroy(b.mesh);
        pir_mesh_destroy(a.mesh);
    }
    expect(cases < 1000 || (taken[0] > 50 && taken[1] > 5), "%llu and %llu solids", (unsigned long long)taken[0],
           (unsigned long long)taken[1]);
    printf("# %llu solids of two bodies, %llu with a cavity\n", (unsigned long long)taken[0],
           (unsigned long long)taken[1]);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(convex_bodies_touch_or_cross)};
    return cmocka_run_group_tests_name("solids that touch or cross", tests, NULL, NULL);
}
