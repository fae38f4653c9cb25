/* SPDX-License-Identifier: MIT */
/* See bodies.h. */
#include "support/bodies.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static size_t count_of(test_random *random, size_t most) {
    return 1 + test_random_below(random, (uint32_t)most);
}

/* One coordinate after another: an initialiser's parts may be worked out in any order. */
static pir_vec3 grid_point(test_random *random, int size) {
    int x = test_random_between(random, 0, size), y = test_random_between(random, 0, size),
        z = test_random_between(random, 0, size);
    return (pir_vec3){x, y, z};
}

static pir_vec3 cube_point(test_random *random) {
    double x = test_random_unit(random), y = test_random_unit(random), z = test_random_unit(random);
    return (pir_vec3){x, y, z};
}

static void fill_grid(test_random *random, size_t most, int size, test_points *points) {
    points->count = count_of(random, most);
    for (size_t i = 0; i < points->count; i++)
        points->at[i] = grid_point(random, size);
}

static void fill_box(test_random *random, test_points *points) {
    int x = test_random_between(random, 1, 3), y = test_random_between(random, 1, 3),
        z = test_random_between(random, 1, 3);
    points->count = 8;
    for (int i = 0; i < 8; i++)
        points->at[i] = (pir_vec3){i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z};
}

static void fill_octahedron(test_random *random, test_points *points) {
    points->count = 6;
    for (int i = 0; i < 6; i++) {
        double r[3] = {0, 0, 0};
        r[i / 2] = (i % 2 ? -1 : 1) * test_random_between(random, 1, 2);
        points->at[i] = (pir_vec3){r[0], r[1], r[2]};
    }
}

static void fill_prism(test_random *random, size_t most, test_points *points) {
    fill_grid(random, most > 1 ? most / 2 : 1, 3, points);
    size_t n = points->count;
    for (size_t i = 0; i < n; i++) {
        points->at[i].z = 0;
        points->at[n + i] = points->at[i];
        points->at[n + i].z = 1;
    }
    points->count = 2 * n;
}

/* Points o + i·a + j·b of a plane, or of a line when b is zero, with integers i and j. */
static void fill_lattice(test_random *random, size_t most, int flat, test_points *points) {
    int o[3], a[3], b[3];
    for (int k = 0; k < 3; k++) {
        o[k] = test_random_between(random, -2, 2);
        a[k] = test_random_between(random, -2, 2);
        b[k] = flat ? test_random_between(random, -2, 2) : 0;
    }
    points->count = count_of(random, most);
    for (size_t n = 0; n < points->count; n++) {
        int i = test_random_between(random, -3, 3), j = test_random_between(random, -3, 3);
        points->at[n] = (pir_vec3){o[0] + i * a[0] + j * b[0], o[1] + i * a[1] + j * b[1], o[2] + i * a[2] + j * b[2]};
    }
}

static void map(test_points *points, pir_vec3 scale, pir_vec3 offset) {
    for (size_t i = 0; i < points->count; i++) {
        pir_vec3 x = points->at[i];
        points->at[i] = (pir_vec3){x.x * scale.x + offset.x, x.y * scale.y + offset.y, x.z * scale.z + offset.z};
    }
}

void test_body_points(test_random *random, test_body body, size_t most, test_points *ret_points) {
    test_points *points = ret_points;
    const pir_vec3 origin = {0, 0, 0};
    switch (body) {
    case TEST_SPHERE:
        points->count = count_of(random, most);
        for (size_t i = 0; i < points->count; i++)
            points->at[i] = test_random_direction(random);
        break;
    case TEST_BALL:
        points->count = count_of(random, most);
        for (size_t i = 0; i < points->count; i++)
            points->at[i] = cube_point(random);
        break;
    case TEST_GRID:
        fill_grid(random, most, test_random_between(random, 1, 4), points);
        break;
    case TEST_BOX:
        fill_box(random, points);
        break;
    case TEST_OCTAHEDRON:
        fill_octahedron(random, points);
        break;
    case TEST_PRISM:
        fill_prism(random, most, points);
        break;
    case TEST_NEEDLE:
        fill_grid(random, most, 2, points);
        map(points, (pir_vec3){1, 1, 1e-6}, origin);
        break;
    case TEST_FAR:
        fill_grid(random, most, 3, points);
        map(points, (pir_vec3){0.1, 0.1, 0.1}, (pir_vec3){1e7, -1e7, 1e7});
        break;
    case TEST_SCALED: {
        test_body_points(random, test_random_below(random, 2) ? TEST_BALL : TEST_GRID, most, points);
        int k = test_random_between(random, -300, 300);
        map(points, (pir_vec3){ldexp(1, k), ldexp(1, k + test_random_between(random, -3, 3)), ldexp(-1, k)}, origin);
        break;
    }
    case TEST_POLYGON:
        fill_lattice(random, most, 1, points);
        break;
    case TEST_SEGMENT:
        fill_lattice(random, most, 0, points);
        break;
    default:
        points->count = count_of(random, 3);
        for (size_t i = 0; i < points->count; i++)
            points->at[i] = (pir_vec3){0.25, -3, 1e-3};
        break;
    }
}

void test_shuffle(test_random *random, test_points *points) {
    for (size_t i = points->count; i > 1; i--) {
        size_t j = test_random_below(random, (uint32_t)i);
        pir_vec3 kept = points->at[i - 1];
        points->at[i - 1] = points->at[j];
        points->at[j] = kept;
    }
}

void test_bake(test_points *points, pir_quat q) {
    double size = sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    double x = q.x / size, y = q.y / size, z = q.z / size, w = q.w / size;
    for (size_t i = 0; i < points->count; i++) {
        pir_vec3 v = points->at[i];
        points->at[i] = (pir_vec3){
            (1 - 2 * (y * y + z * z)) * v.x + 2 * (x * y - w * z) * v.y + 2 * (x * z + w * y) * v.z,
            2 * (x * y + w * z) * v.x + (1 - 2 * (x * x + z * z)) * v.y + 2 * (y * z - w * x) * v.z,
            2 * (x * z - w * y) * v.x + 2 * (y * z + w * x) * v.y + (1 - 2 * (x * x + y * y)) * v.z,
        };
    }
}

pir_polytope *test_hull(const pir_vec3 *points, size_t count) {
    pir_polytope *polytope = NULL;
    pir_status status = pir_polytope_create(points, count, NULL, &polytope);
    if (status != PIR_OK) {
        fprintf(stderr, "a test's body of %zu points has no hull: status %d\n", count, (int)status);
        abort();
    }
    return polytope;
}

pir_polytope *test_polytope(const test_points *points) {
    return test_hull(points->at, points->count);
}

pir_polytope *test_box_at(double x, double y, double z, pir_vec3 at) {
    pir_vec3 corner[8];
    for (int i = 0; i < 8; i++)
        corner[i] = (pir_vec3){at.x + (i & 1 ? x : -x), at.y + (i & 2 ? y : -y), at.z + (i & 4 ? z : -z)};
    return test_hull(corner, 8);
}

pir_polytope *test_box(double x, double y, double z) {
    return test_box_at(x, y, z, (pir_vec3){0, 0, 0});
}

pir_polytope *test_fluted_prism(bool upright_along_z) {
    test_points points = {.count = 82};
    for (int i = 0; i < 41; i++) {
        double t = (i - 19.5) / 100, x = i < 40 ? (1 - t * t) / (1 + t * t) : -1, y = i < 40 ? 2 * t / (1 + t * t) : 0;
        for (int end = -1; end <= 1; end += 2)
            points.at[2 * i + (end > 0)] = upright_along_z ? (pir_vec3){x, y, end} : (pir_vec3){x, end, y};
    }
    return test_polytope(&points);
}

double test_size_of(const pir_polytope *polytope) {
    pir_vec3 low, high;
    pir_polytope_bounds(polytope, &low, &high);
    return fmax(high.x - low.x, fmax(high.y - low.y, high.z - low.z));
}

pir_polytope *test_sphere(test_random *random, size_t count) {
    test_points points = {.count = count};
    for (size_t i = 0; i < count; i++)
        points.at[i] = test_random_direction(random);
    return test_polytope(&points);
}

pir_polytope *test_random_polytope(test_random *random, test_body body, size_t most) {
    test_points points;
    test_body_points(random, body, most, &points);
    return test_polytope(&points);
}

pir_quat test_hard_rotation(uint32_t index) {
    static const pir_quat hard[TEST_HARD_ROTATIONS] = {
        {0, 0, 0, 1},
        {0, 0, 1, 1},
        {1, 0, 0, 1},
        {1, 1, 1, 1},
        {0, 0, 1, 3},
        {0, 1, 0, 1e-9},
        {3e-160, 0, 4e-160, 5e-160},
        {1e150, -2e150, 3e150, 7e150},
        {5e-324, 0, 0, 0},
        {5e-324, -5e-324, 1e-323, 5e-324},
        {1, 5e-324, 0, 1},
        {1e308, 1e308, -1e308, 1e308},
        {1e308, 5e-324, 0, 1},
        {0, 1, 0, 0},
        {1, 1, 0, 0},
        {-1, 0x1p-60, 0x1p-30, -1},
    };
    return hard[index % TEST_HARD_ROTATIONS];
}

pir_quat test_integer_rotation(test_random *random) {
    for (;;) {
        int x = test_random_between(random, -2, 2), y = test_random_between(random, -2, 2);
        int z = test_random_between(random, -2, 2), w = test_random_between(random, -2, 2);
        if (x || y || z || w)
            return (pir_quat){x, y, z, w};
    }
}

pir_quat test_general_rotation(test_random *random) {
    double scale = ldexp(1, test_random_between(random, -40, 40));
    double x = test_random_scaled(random, -4, 0), y = test_random_scaled(random, -4, 0);
    double z = test_random_scaled(random, -4, 0), w = test_random_scaled(random, -4, 0);
    return (pir_quat){x * scale, y * scale, z * scale, w * scale};
}

pir_quat test_rotation(test_random *random) {
    switch (test_random_below(random, 4)) {
    case 0:
        return test_hard_rotation(test_random_below(random, TEST_HARD_ROTATIONS));
    case 1:
        return test_integer_rotation(random);
    default:
        return test_general_rotation(random);
    }
}

pir_quat test_compose(pir_quat b, pir_quat a, int normalise) {
    pir_quat c = {b.w * a.x + b.x * a.w + b.y * a.z - b.z * a.y, b.w * a.y - b.x * a.z + b.y * a.w + b.z * a.x,
                  b.w * a.z + b.x * a.y - b.y * a.x + b.z * a.w, b.w * a.w - b.x * a.x - b.y * a.y - b.z * a.z};
    if (!normalise)
        return c;
    double length = sqrt(c.x * c.x + c.y * c.y + c.z * c.z + c.w * c.w);
    return (pir_quat){c.x / length, c.y / length, c.z / length, c.w / length};
}

/* A solid whose facets and edges line up with those of its like. */
static test_body aligned_body(test_random *random) {
    static const test_body aligned[] = {TEST_GRID, TEST_BOX, TEST_OCTAHEDRON, TEST_PRISM};
    return aligned[test_random_below(random, 4)];
}

static test_body flat_body(test_random *random) {
    static const test_body flat[] = {TEST_POLYGON, TEST_POLYGON, TEST_SEGMENT, TEST_POINT};
    return flat[test_random_below(random, 4)];
}

static test_body any_body(test_random *random) {
    return (test_body)test_random_below(random, TEST_BODY_COUNT);
}

void test_random_pose(test_random *random, size_t most, test_pose *ret_pose) {
    test_pose *pose = ret_pose;
    pose->rotation = test_rotation(random);
    switch (test_random_below(random, 8)) {
    case 0:
        pose->situation = "spheres in general position";
        test_body_points(random, TEST_SPHERE, most, &pose->p);
        test_body_points(random, TEST_SPHERE, most, &pose->q);
        pose->rotation = test_general_rotation(random);
        break;
    case 1:
        pose->situation = "equal parts";
        test_body_points(random, test_random_below(random, 2) ? aligned_body(random) : TEST_SPHERE, most, &pose->p);
        pose->q = pose->p;
        pose->rotation = test_integer_rotation(random);
        break;
    case 2:
        pose->situation = "parts that mirror each other";
        test_body_points(random, aligned_body(random), most, &pose->p);
        pose->q = pose->p;
        map(&pose->q, (pir_vec3){-1, -1, -1}, (pir_vec3){1, 0, 0});
        break;
    case 3:
        pose->situation = "aligned boxes";
        test_body_points(random, TEST_BOX, most, &pose->p);
        test_body_points(random, TEST_BOX, most, &pose->q);
        pose->rotation = test_integer_rotation(random);
        break;
    case 4:
        pose->situation = "parts of one grid";
        test_body_points(random, aligned_body(random), most, &pose->p);
        test_body_points(random, aligned_body(random), most, &pose->q);
        pose->rotation = test_integer_rotation(random);
        break;
    case 5:
        pose->situation = "a flat operand";
        test_body_points(random, flat_body(random), most, &pose->p);
        test_body_points(random, any_body(random), most, &pose->q);
        break;
    case 6:
        pose->situation = "two flat operands, or a flat one that stands";
        test_body_points(random, test_random_below(random, 2) ? flat_body(random) : any_body(random), most, &pose->p);
        test_body_points(random, flat_body(random), most, &pose->q);
        break;
    default:
        pose->situation = "any two bodies";
        test_body_points(random, any_body(random), most, &pose->p);
        test_body_points(random, any_body(random), most, &pose->q);
        break;
    }
}
