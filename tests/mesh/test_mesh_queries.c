/* SPDX-License-Identifier: MIT */
/*
 * Rays, boxes and nearest points against every triangle in rationals (oracle/triangles.h): which triangles are
 * met, the first of them, the nearest. Surfaces are soups of whole and of any numbers, so that rays go through
 * edges and corners, boxes touch, and triangles are equally near; bumpy spheres; height fields with holes.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include "mesh/mesh_models.h"
#include "oracle/triangles.h"

#define MOST 4096

typedef struct surface {
    pir_surface_ref ref;
    pir_trimesh *mesh;
    pir_height_field *field;
    uint32_t triangles, count;
    uint32_t number[MOST]; /* those that count */
    oracle_triangle *exact;
    double size;
} surface;

static void fill_exact(surface *s) {
    s->exact = malloc(s->triangles * sizeof *s->exact);
    s->count = 0;
    for (uint32_t t = 0; t < s->triangles; t++) {
        pir_triangle_corners c;
        pir_status status = s->mesh ? pir_trimesh_triangle(s->mesh, t, &c) : pir_height_field_triangle(s->field, t, &c);
        if (status != PIR_OK)
            continue;
        oracle_triangle_init(&s->exact[s->count]);
        oracle_triangle_set(&s->exact[s->count], c.corner);
        s->number[s->count++] = t;
    }
}

static surface field_surface(test_random *random, bool whole) {
    surface s = {.size = 6};
    float heights[7 * 6];
    uint8_t holes[6 * 5];
    for (int i = 0; i < 7 * 6; i++)
        heights[i] = whole ? (float)test_random_between(random, 0, 3) : (float)test_random_unit(random) * 3;
    for (int i = 0; i < 6 * 5; i++)
        holes[i] = test_random_below(random, 5) == 0;
    holes[7] = 0;
    pir_height_samples samples = {.heights = heights,
                                  .type = PIR_NUMBERS_FLOAT,
                                  .columns = 7,
                                  .rows = 6,
                                  .step_x = whole ? 1 : 0.9,
                                  .step_y = 1,
                                  .holes = holes};
    assert_int_equal(pir_height_field_create(&samples, NULL, NULL, &s.field), PIR_OK);
    s.ref.field = s.field;
    s.triangles = 2 * 6 * 5;
    fill_exact(&s);
    return s;
}

static surface some_surface(test_random *random, uint64_t number) {
    if (number % 4 == 3)
        return field_surface(random, number % 8 == 3);
    surface s = {.size = number % 4 == 2 ? 2 : 4};
    mesh_arrays arrays = number % 4 == 2 ? mesh_bumpy_sphere(1 + number % 3, 0.2)
                                         : mesh_soup(random, 1 + test_random_below(random, 60), 4, number % 4 == 0);
    // degenerate ones would be triangles to the oracle
    for (uint32_t t = 0; t < arrays.triangles; t++)
        arrays.vertex[arrays.triangle[t][2]].x += number % 4 == 0 && t == 0 ? 0.5 : 0;
    pir_trimesh_arrays given = mesh_arrays_of(&arrays);
    pir_status status = pir_trimesh_create(&given, NULL, NULL, &s.mesh);
    if (status == PIR_ERR_EMPTY) {
        mesh_arrays_clear(&arrays);
        return field_surface(random, true);
    }
    s.ref.mesh = s.mesh;
    s.triangles = arrays.triangles;
    fill_exact(&s);
    mesh_arrays_clear(&arrays);
    return s;
}

static void clear(surface *s) {
    for (uint32_t i = 0; i < s->count; i++)
        oracle_triangle_clear(&s->exact[i]);
    free(s->exact);
    pir_trimesh_release(s->mesh);
    pir_height_field_release(s->field);
}

/* A point in general, or with whole coordinates. */
static pir_vec3 some_point(test_random *random, const surface *s, bool whole) {
    double c[3];
    for (int k = 0; k < 3; k++)
        c[k] = whole ? 0.5 * test_random_between(random, -2 * (int)s->size, 2 * (int)s->size)
                     : 1.2 * s->size * test_random_unit(random);
    return (pir_vec3){c[0], c[1], c[2]};
}

static bool is_flat(surface *s, uint32_t i) {
    mpq_t square, zero;
    oracle_triangle *t = &s->exact[i];
    mpq_init(square);
    mpq_init(zero);
    mpq_t x, y;
    mpq_init(x);
    mpq_init(y);
    bool flat = true;
    for (int k = 0; k < 3; k++) {
        int a = (k + 1) % 3, b = (k + 2) % 3;
        mpq_sub(x, t->p[1][a], t->p[0][a]);
        mpq_sub(y, t->p[2][b], t->p[0][b]);
        mpq_mul(square, x, y);
        mpq_sub(x, t->p[1][b], t->p[0][b]);
        mpq_sub(y, t->p[2][a], t->p[0][a]);
        mpq_mul(zero, x, y);
        flat = flat && mpq_cmp(square, zero) == 0;
    }
    mpq_clear(square);
    mpq_clear(zero);
    mpq_clear(x);
    mpq_clear(y);
    return flat;
}

/* --- rays --- */

static void check_ray(surface *s, uint64_t number, pir_surface_ray ray) {
    mpq_t time, best;
    mpq_init(time);
    mpq_init(best);
    uint32_t hits = 0, first = PIR_TRIANGLE_NONE;
    bool met[MOST] = {false};
    for (uint32_t i = 0; i < s->count; i++) {
        int side;
        if (is_flat(s, i) || !oracle_segment_meets(&s->exact[i], ray.origin, ray.way, time, &side))
            continue;
        if ((ray.sides == PIR_RAY_BACK && side > 0) ||
            (side < 0 && ray.sides != PIR_RAY_BACK && ray.sides != PIR_RAY_BOTH))
            continue;
        met[i] = true;
        hits++;
        if (first == PIR_TRIANGLE_NONE || mpq_cmp(time, best) < 0) {
            first = s->number[i];
            mpq_set(best, time);
        }
    }
    pir_ray_hit hit, all[MOST];
    bool any;
    size_t count;
    assert_int_equal(pir_surface_ray_nearest(s->ref, &ray, &hit), PIR_OK);
    assert_int_equal(pir_surface_ray_any(s->ref, &ray, &any), PIR_OK);
    assert_int_equal(pir_surface_ray_all(s->ref, &ray, MOST, all, &count), PIR_OK);
    expect(hit.triangle == first && any == (hits > 0) && count == hits, "ray %llu: %u, not %u; %zu hits, not %u",
           (unsigned long long)number, hit.triangle, first, count, hits);
    for (uint32_t i = 0; i < hits; i++) {
        bool told = false;
        for (uint32_t j = 0; j < s->count; j++)
            told = told || (met[j] && s->number[j] == all[i].triangle);
        expect(told && (i == 0 || all[i - 1].time <= all[i].time), "ray %llu: hit %u", (unsigned long long)number, i);
    }
    if (hits > 0)
        expect(fabs(hit.time - mpq_get_d(best)) < 1e-13, "ray %llu: time %g, not %g", (unsigned long long)number,
               hit.time, mpq_get_d(best));
    mpq_clear(time);
    mpq_clear(best);
}

static uint64_t cases(void) {
    const char *text = getenv("PIR_TEST_CASES");
    return text ? strtoull(text, NULL, 10) : 75;
}

/* Segments between points in general, along axes, towards corners and through the middles of edges. */
static void RaysMeetWhatTheyMeet(void **state) {
    (void)state;
    for (uint64_t number = 0; number < cases(); number++) {
        test_random random = test_random_case("mesh rays", number);
        surface s = some_surface(&random, number);
        for (uint32_t i = 0; i < 12; i++) {
            pir_surface_ray ray = {some_point(&random, &s, i % 2), {0, 0, 0}, (pir_ray_sides)(i % 4)};
            pir_vec3 to = some_point(&random, &s, i % 2);
            if (i % 4 == 3) {
                // through a corner or the middle of an edge, as near as doubles are
                pir_triangle_corners c;
                uint32_t t = s.number[test_random_below(&random, s.count)];
                assert_int_equal(
                    s.mesh ? pir_trimesh_triangle(s.mesh, t, &c) : pir_height_field_triangle(s.field, t, &c), PIR_OK);
                pir_vec3 a = c.corner[0], b = c.corner[1 + i % 2];
                to = i % 8 == 3 ? a : (pir_vec3){0.5 * (a.x + b.x), 0.5 * (a.y + b.y), 0.5 * (a.z + b.z)};
            }
            double by = i % 3 == 0 ? 1 : 2;
            ray.way = (pir_vec3){by * (to.x - ray.origin.x), by * (to.y - ray.origin.y), by * (to.z - ray.origin.z)};
            if (i % 5 == 4)
                ray.way = (pir_vec3){0, 0, ray.way.z};
            check_ray(&s, number * 100 + i, ray);
        }
        clear(&s);
    }
}

/* From inside a closed mesh every ray leaves: also those through corners and along edges, as near as doubles are. */
static void NoRaySlipsOutBetweenTriangles(void **state) {
    (void)state;
    mesh_arrays ball = mesh_bumpy_sphere(4, 0.1);
    pir_trimesh *mesh = mesh_of(&ball, NULL);
    test_random random = test_random_case("mesh slips", 0);
    for (uint32_t i = 0; i < 200 * cases(); i++) {
        pir_vec3 from = test_random_direction(&random), to = ball.vertex[test_random_below(&random, ball.vertices)];
        pir_vec3 other = ball.vertex[test_random_below(&random, ball.vertices)];
        from = (pir_vec3){0.3 * from.x, 0.3 * from.y, 0.3 * from.z};
        if (i % 2)
            to = (pir_vec3){0.5 * (to.x + other.x), 0.5 * (to.y + other.y), 0.5 * (to.z + other.z)};
        double by = 8 / (0.01 + fabs(to.x - from.x) + fabs(to.y - from.y) + fabs(to.z - from.z));
        pir_surface_ray ray = {from, {by * (to.x - from.x), by * (to.y - from.y), by * (to.z - from.z)}, PIR_RAY_BACK};
        bool hits;
        assert_int_equal(pir_surface_ray_any((pir_surface_ref){.mesh = mesh}, &ray, &hits), PIR_OK);
        expect(hits, "ray %u leaves through nothing", i);
    }
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&ball);
}

/* --- boxes --- */

static void BoxesMeetWhatTheyMeet(void **state) {
    (void)state;
    for (uint64_t number = 0; number < cases(); number++) {
        test_random random = test_random_case("mesh boxes", number);
        surface s = some_surface(&random, number);
        for (uint32_t i = 0; i < 6; i++) {
            pir_vec3 a = some_point(&random, &s, i % 2), b = some_point(&random, &s, i % 2);
            b = i % 3 ? (pir_vec3){a.x + 0.3 * (b.x - a.x), a.y + 0.3 * (b.y - a.y), a.z + 0.3 * (b.z - a.z)} : b;
            pir_vec3 low = {fmin(a.x, b.x), fmin(a.y, b.y), fmin(a.z, b.z)};
            pir_vec3 high = {fmax(a.x, b.x), fmax(a.y, b.y), fmax(a.z, b.z)};
            uint32_t told[MOST];
            size_t count, at = 0;
            assert_int_equal(pir_surface_box(s.ref, low, high, MOST, told, &count), PIR_OK);
            for (uint32_t t = 0; t < s.count; t++) {
                bool meets = !is_flat(&s, t) && oracle_box_meets(&s.exact[t], low, high);
                bool is_told = at < count && told[at] == s.number[t];
                expect(meets == is_told, "box %llu of surface %llu: triangle %u", (unsigned long long)i,
                       (unsigned long long)number, s.number[t]);
                at += is_told;
            }
            assert_int_equal(at, count);
            size_t again;
            assert_int_equal(pir_surface_box(s.ref, low, high, 0, NULL, &again), PIR_OK);
            assert_int_equal(again, count);
        }
        clear(&s);
    }
}

/* --- the nearest point --- */

static void TheNearestTriangleIsTheNearest(void **state) {
    (void)state;
    for (uint64_t number = 0; number < cases(); number++) {
        test_random random = test_random_case("mesh nearest", number);
        surface s = some_surface(&random, number);
        for (uint32_t i = 0; i < 3; i++) {
            pir_vec3 point = some_point(&random, &s, i % 2);
            if (i == 2 && s.mesh && number % 4 == 2)
                point = (pir_vec3){0, 0, 0};
            oracle_triangle at;
            oracle_triangle_init(&at);
            oracle_triangle_set(&at, (pir_vec3[3]){point, point, point});
            mpq_t square, best;
            mpq_init(square);
            mpq_init(best);
            uint32_t first = PIR_TRIANGLE_NONE;
            for (uint32_t t = 0; t < s.count; t++) {
                if (is_flat(&s, t))
                    continue;
                oracle_triangles_least(square, &s.exact[t], &at);
                if (first == PIR_TRIANGLE_NONE || mpq_cmp(square, best) < 0) {
                    first = s.number[t];
                    mpq_set(best, square);
                }
            }
            pir_surface_nearest nearest;
            assert_int_equal(pir_surface_nearest_point(s.ref, point, HUGE_VAL, &nearest), PIR_OK);
            double distance = sqrt(mpq_get_d(best));
            expect(nearest.triangle == first && fabs(nearest.distance - distance) < 1e-13,
                   "point %u of surface %llu: %u at %.17g, not %u at %.17g", i, (unsigned long long)number,
                   nearest.triangle, nearest.distance, first, distance);
            assert_int_equal(pir_surface_nearest_point(s.ref, point, 0.999 * distance, &nearest), PIR_OK);
            assert_true(nearest.triangle == PIR_TRIANGLE_NONE || distance == 0);
            // a cutoff that is exactly the distance is within it
            mpq_set_d(square, distance);
            mpq_mul(square, square, square);
            assert_int_equal(pir_surface_nearest_point(s.ref, point, distance, &nearest), PIR_OK);
            expect((nearest.triangle == first) == (mpq_cmp(best, square) <= 0), "cutoff at the distance");
            mpq_clear(square);
            mpq_clear(best);
            oracle_triangle_clear(&at);
        }
        clear(&s);
    }
}

/* --- bad input --- */

static bool stop(void *context, uint32_t triangle) {
    (void)triangle;
    ++*(int *)context;
    return false;
}

static void WrongQuestionsAreRefused(void **state) {
    (void)state;
    mesh_arrays plane = mesh_plane(3);
    pir_trimesh *mesh = mesh_of(&plane, NULL);
    pir_surface_ref ref = {.mesh = mesh}, none = {0};
    pir_surface_ray ray = {{0, 0, 1}, {0, 0, -2}, PIR_RAY_BOTH}, nan = {{NAN, 0, 1}, {0, 0, -2}, PIR_RAY_BOTH};
    pir_surface_ray far = {{0x1p61, 0, 1}, {0, 0, -2}, PIR_RAY_BOTH};
    pir_ray_hit hit = {.triangle = 77};
    size_t count = 5;
    assert_int_equal(pir_surface_ray_nearest(none, &ray, &hit), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_surface_ray_nearest(ref, NULL, &hit), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_surface_ray_nearest(ref, &nan, &hit), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_surface_ray_nearest(ref, &far, &hit), PIR_ERR_LIMIT);
    assert_int_equal(pir_surface_ray_all(ref, &ray, 1, NULL, &count), PIR_ERR_ARGUMENT);
    assert_true(hit.triangle == 77 && count == 5);
    pir_vec3 low = {0, 0, 0}, high = {1, 1, 1}, wild = {0, INFINITY, 0};
    uint32_t triangles[2];
    assert_int_equal(pir_surface_box(ref, high, low, 2, triangles, &count), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_surface_box(ref, low, wild, 2, triangles, &count), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_surface_box(ref, low, high, 2, triangles, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_surface_box_each(ref, low, high, NULL, NULL), PIR_ERR_ARGUMENT);
    int told = 0;
    assert_int_equal(pir_surface_box_each(ref, low, high, stop, &told), PIR_OK);
    assert_int_equal(told, 1);
    pir_surface_nearest nearest;
    assert_int_equal(pir_surface_nearest_point(ref, low, -1, &nearest), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_surface_nearest_point(ref, low, NAN, &nearest), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_surface_nearest_point(ref, wild, 1, &nearest), PIR_ERR_NOT_FINITE);
    // too small a room tells how much is needed
    assert_int_equal(pir_surface_ray_all(ref, &ray, 0, NULL, &count), PIR_OK);
    assert_int_equal(count, 2);
    pir_trimesh_release(mesh);
    mesh_arrays_clear(&plane);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(RaysMeetWhatTheyMeet),     cmocka_unit_test(NoRaySlipsOutBetweenTriangles),
        cmocka_unit_test(BoxesMeetWhatTheyMeet),    cmocka_unit_test(TheNearestTriangleIsTheNearest),
        cmocka_unit_test(WrongQuestionsAreRefused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
