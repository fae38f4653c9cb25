/* SPDX-License-Identifier: MIT */
/*
 * The visible parts of several bodies, beside rays: through a random point of the picture exactly the part is drawn of
 * the facet that the ray from the viewer meets first.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "hidden.h"
#include "support/bodies.h"

#define BODIES 4
#define PARTS  20000

/* All parts of a picture. */
struct picture {
    size_t count;
    struct part {
        const struct seen_body *body;
        uint32_t facet;
        struct seen_polygon polygon;
    } * part;
    double drawn; /* length of all lines */
};

static void keep_polygon(void *context, const struct seen_body *body, uint32_t facet, const struct seen_polygon *part) {
    struct picture *picture = context;
    assert_true(picture->count < PARTS);
    picture->part[picture->count].body = body;
    picture->part[picture->count].facet = facet;
    picture->part[picture->count++].polygon = *part;
}

static void keep_line(void *context, const double a[2], const double b[2]) {
    ((struct picture *)context)->drawn += hypot(b[0] - a[0], b[1] - a[1]);
}

/* How far inside of a polygon, which is counter-clockwise, a point is; below 0 outside. */
static double inside(const struct seen_polygon *polygon, const double x[2]) {
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < polygon->count; i++) {
        const double *a = polygon->at[i], *b = polygon->at[i + 1 < polygon->count ? i + 1 : 0];
        double length = hypot(b[0] - a[0], b[1] - a[1]);
        if (length > 0)
            least = fmin(least, ((b[0] - a[0]) * (x[1] - a[1]) - (b[1] - a[1]) * (x[0] - a[0])) / length);
    }
    return least;
}

/*
 * Where the ray at x leaves the body towards the viewer, and by which facet; −HUGE_VAL where it misses the body.
 * *ret_unclear when it passes an edge too closely to say.
 */
static double ray(const struct seen_body *body, const double x[2], uint32_t *ret_facet, bool *ret_unclear) {
    for (uint32_t f = 0; f < pir_mesh_facet_count(body->mesh); f++) {
        struct seen_polygon whole = {.count = 0};
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(body->mesh, f, &count);
        assert_true(count <= SEEN_CORNERS);
        for (uint32_t i = 0; i < count; i++)
            memcpy(whole.at[whole.count++], body->at[corner[i]], 2 * sizeof(double));
        double depth = inside(&whole, x);
        *ret_unclear |= fabs(depth) < 1e-6;
        if (depth < 0)
            continue;
        // the plane through three corners, at x
        const double *a = body->at[corner[0]], *b = body->at[corner[1]], *c = body->at[corner[2]];
        double n[3];
        for (int k = 0; k < 3; k++) {
            int i = (k + 1) % 3, j = (k + 2) % 3;
            n[k] = (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);
        }
        *ret_facet = f;
        return a[2] - (n[0] * (x[0] - a[0]) + n[1] * (x[1] - a[1])) / n[2];
    }
    return -HUGE_VAL;
}

/* Holds one random point of the picture against what is drawn there; whether it could be told. */
static bool check_point(test_random *random, const struct seen_body *bodies, const struct picture *picture,
                        uint64_t number) {
    const double x[2] = {1.5 * test_random_unit(random), 1.5 * test_random_unit(random)};
    double nearest = -HUGE_VAL, second = -HUGE_VAL;
    uint32_t facet = 0, body = BODIES;
    bool unclear = false;
    for (uint32_t b = 0; b < BODIES; b++) {
        uint32_t f = 0;
        double z = ray(&bodies[b], x, &f, &unclear);
        if (z > nearest) {
            second = nearest;
            nearest = z;
            facet = f;
            body = b;
        } else if (z > second) {
            second = z;
        }
    }
    unclear |= body < BODIES && nearest - second < 1e-6;
    for (size_t i = 0; i < picture->count; i++)
        unclear |= fabs(inside(&picture->part[i].polygon, x)) < 1e-7;
    if (unclear)
        return false;
    size_t drawn = 0;
    for (size_t i = 0; i < picture->count; i++)
        if (inside(&picture->part[i].polygon, x) > 0) {
            drawn++;
            expect(body < BODIES && picture->part[i].body == &bodies[body] && picture->part[i].facet == facet,
                   "case %llu", (unsigned long long)number);
        }
    expect(drawn == (body < BODIES), "case %llu: %zu parts at %g, %g", (unsigned long long)number, drawn, x[0], x[1]);
    return true;
}

static pir_mesh *random_mesh(test_random *random, uint64_t number) {
    test_points points;
    test_body_points(random, number % 3 ? TEST_SPHERE : TEST_BOX, 20, &points);
    double size = number % 3 ? 0.8 : 0.1;
    pir_vec3 at = number % 4 == 3 ? (pir_vec3){0, 0, 0} : test_random_direction(random);
    for (size_t i = 0; i < points.count; i++)
        points.at[i] = (pir_vec3){size * points.at[i].x + 0.5 * at.x, size * points.at[i].y + 0.5 * at.y,
                                  size * points.at[i].z + 0.5 * at.z};
    pir_polytope *polytope = test_polytope(&points);
    pir_mesh *mesh = NULL;
    assert_int_equal(pir_mesh_from_polytope(polytope, &mesh), PIR_OK);
    pir_polytope_release(polytope);
    return mesh;
}

static void each_point_shows_what_its_ray_meets_first(void **state) {
    (void)state;
    size_t told = 0;
    struct picture picture = {.part = malloc(PARTS * sizeof *picture.part)};
    for (uint64_t i = 0; i < 12; i++) {
        test_random random = test_random_case("hidden", i);
        struct seen_body bodies[BODIES];
        pir_mesh *meshes[BODIES];
        for (int b = 0; b < BODIES; b++) {
            meshes[b] = random_mesh(&random, i);
            assert_true(hidden_see(&bodies[b], meshes[b], (pir_vec3){0, 0, 0}));
        }
        picture.count = 0;
        const struct seen_sink sink = {&picture, keep_polygon, keep_line};
        for (uint32_t b = 0; b < BODIES; b++)
            assert_true(hidden_parts(bodies, BODIES, b, &sink));
        for (int n = 0; n < 200; n++)
            told += check_point(&random, bodies, &picture, i);
        for (int b = 0; b < BODIES; b++) {
            hidden_clear(&bodies[b]);
            pir_mesh_destroy(meshes[b]);
        }
    }
    free(picture.part);
    expect(told > 1500, "%zu points", told);
}

static double area_of(const struct picture *picture) {
    double sum = 0;
    for (size_t i = 0; i < picture->count; i++) {
        const struct seen_polygon *p = &picture->part[i].polygon;
        for (uint32_t k = 0; k < p->count; k++) {
            const double *a = p->at[k], *b = p->at[k + 1 < p->count ? k + 1 : 0];
            sum += 0.5 * (a[0] * b[1] - a[1] * b[0]);
        }
    }
    return sum;
}

/* Facets in one plane hide each other once, not both or neither. */
static void what_coincides_is_drawn_once(void **state) {
    (void)state;
    struct picture one = {.part = malloc(PARTS * sizeof *one.part)}, two = {.part = malloc(PARTS * sizeof *two.part)};
    double total = 0;
    for (uint64_t i = 0; i < 6; i++) {
        test_random random = test_random_case("hidden twice", i);
        struct seen_body bodies[2];
        pir_mesh *mesh = random_mesh(&random, i);
        one.count = two.count = 0;
        one.drawn = two.drawn = 0;
        const struct seen_sink to_one = {&one, keep_polygon, keep_line}, to_two = {&two, keep_polygon, keep_line};
        for (int b = 0; b < 2; b++)
            assert_true(hidden_see(&bodies[b], mesh, (pir_vec3){0, 0, 0}));
        assert_true(hidden_parts(bodies, 1, 0, &to_one));
        for (uint32_t b = 0; b < 2; b++)
            assert_true(hidden_parts(bodies, 2, b, &to_two));
        double a = area_of(&one), b = area_of(&two);
        total += a;
        expect(fabs(a - b) <= 1e-5 * a, "case %llu: areas %g and %g", (unsigned long long)i, a, b);
        expect(fabs(one.drawn - two.drawn) <= 1e-5 * one.drawn, "case %llu: lines of %g and %g", (unsigned long long)i,
               one.drawn, two.drawn);
        for (int k = 0; k < 2; k++)
            hidden_clear(&bodies[k]);
        pir_mesh_destroy(mesh);
    }
    free(one.part);
    free(two.part);
    assert_true(total > 0.5);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_point_shows_what_its_ray_meets_first),
        cmocka_unit_test(what_coincides_is_drawn_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
