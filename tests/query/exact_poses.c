/* SPDX-License-Identifier: MIT */
/* See exact_poses.h. */
#include "query/exact_poses.h"
#include "support/vectors.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void map(test_points *points, double scale, pir_vec3 offset) {
    for (size_t i = 0; i < points->count; i++)
        points->at[i] = test_add(offset, points->at[i], scale);
}

/* --- bodies --- */

static void fill_box(test_points *points, pir_vec3 low, pir_vec3 high) {
    points->count = 8;
    for (int i = 0; i < 8; i++)
        points->at[i] = (pir_vec3){i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z};
}

static void fill_dodecahedron(test_points *points) {
    const double g = (1 + sqrt(5)) / 2, h = 1 / g;
    points->count = 0;
    for (int i = 0; i < 8; i++)
        points->at[points->count++] = (pir_vec3){i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1};
    for (int i = 0; i < 4; i++) {
        double s = i & 1 ? h : -h, t = i & 2 ? g : -g;
        points->at[points->count++] = (pir_vec3){0, s, t};
        points->at[points->count++] = (pir_vec3){s, t, 0};
        points->at[points->count++] = (pir_vec3){t, 0, s};
    }
}

/* A prism over a regular polygon, rounded to doubles. */
static void fill_cylinder(test_random *random, test_points *points) {
    int sides = test_random_between(random, 3, 10);
    double height = ldexp(1, -test_random_between(random, 0, 6));
    points->count = 0;
    for (int i = 0; i < 2 * sides; i++) {
        double angle = 2 * 3.14159265358979323846 * (i / 2) / sides;
        points->at[points->count++] = (pir_vec3){cos(angle), sin(angle), i % 2 ? height : -height};
    }
}

/*
 * Small bodies whose features are parallel to those of others: on a grid, boxes with a corner or the middle at the
 * origin.
 */
static void fill_aligned(test_random *random, test_points *points) {
    static const test_body bodies[4] = {TEST_GRID, TEST_BOX, TEST_OCTAHEDRON, TEST_PRISM};
    int choice = test_random_between(random, 0, 6);
    if (choice < 4) {
        test_body_points(random, bodies[choice], 12, points);
        return;
    }
    int x = test_random_between(random, 1, 4), y = test_random_between(random, 1, 4),
        z = test_random_between(random, 1, 4);
    pir_vec3 high = {x, y, z}, low = {0, 0, 0};
    if (choice == 5)
        high = (pir_vec3){x / 8.0, y / 8.0, z / 1024.0};
    fill_box(points, low, high);
}

static void fill_flat(test_random *random, test_points *points) {
    static const test_body bodies[4] = {TEST_POLYGON, TEST_POLYGON, TEST_SEGMENT, TEST_POINT};
    test_body_points(random, bodies[test_random_below(random, 4)], 10, points);
}

static void fill_general(test_random *random, test_points *points) {
    static const test_body bodies[4] = {TEST_SPHERE, TEST_BALL, TEST_BALL, TEST_SPHERE};
    int choice = test_random_between(random, 0, 7);
    size_t most = test_random_below(random, 12) == 0 ? 40 : 16;
    test_body_points(random, bodies[choice % 4], most, points);
    // needles and plates
    double thin = ldexp(1, -test_random_between(random, 1, 20));
    for (size_t i = 0; i < points->count && choice >= 6; i++) {
        points->at[i].z *= thin;
        points->at[i].y *= choice == 6 ? thin : 1;
    }
}

static double nudge(test_random *random, double x, double size) {
    return x + test_random_unit(random) * size;
}

/* Moves every vertex by up to `size`. */
static void shake(test_random *random, test_points *points, double size) {
    for (size_t i = 0; i < points->count; i++) {
        points->at[i].x = nudge(random, points->at[i].x, size);
        points->at[i].y = nudge(random, points->at[i].y, size);
        points->at[i].z = nudge(random, points->at[i].z, size);
    }
}

/* Rotates every vertex in doubles. */
static void bake(test_points *points, pir_quat q) {
    double n = sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w), x = q.x / n, y = q.y / n, z = q.z / n, w = q.w / n;
    for (size_t i = 0; i < points->count; i++) {
        pir_vec3 v = points->at[i];
        double a = y * v.z - z * v.y, b = z * v.x - x * v.z, c = x * v.y - y * v.x;
        points->at[i] = (pir_vec3){v.x + 2 * (w * a + y * c - z * b), v.y + 2 * (w * b + z * a - x * c),
                                   v.z + 2 * (w * c + x * b - y * a)};
    }
}

static double tiny_length(test_random *random) {
    return pow(10, -test_random_between(random, 10, 17));
}

/* --- scenes --- */

static void make_degenerate(test_random *random, exact_scene *s) {
    s->aligns = 1;
    s->rotation = test_integer_rotation(random);
    fill_aligned(random, &s->points_p);
    fill_aligned(random, &s->points_q);
    switch (test_random_below(random, 6)) {
    case 0:
        snprintf(s->situation, sizeof s->situation, "aligned");
        break;
    case 1:
        snprintf(s->situation, sizeof s->situation, "equal parts");
        s->points_q = s->points_p;
        break;
    case 2:
        snprintf(s->situation, sizeof s->situation, "flat P");
        fill_flat(random, &s->points_p);
        break;
    case 3:
        snprintf(s->situation, sizeof s->situation, "flat Q");
        fill_flat(random, &s->points_q);
        break;
    case 4:
        snprintf(s->situation, sizeof s->situation, "both flat");
        fill_flat(random, &s->points_p);
        fill_flat(random, &s->points_q);
        break;
    default: {
        // coordinates of P that the rotation takes to integers
        snprintf(s->situation, sizeof s->situation, "rational rotation");
        pir_quat q = s->rotation;
        map(&s->points_p, q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, (pir_vec3){0, 0, 0});
        map(&s->points_q, test_random_between(random, 1, 8), (pir_vec3){0, 0, 0});
        break;
    }
    }
    if (test_random_below(random, 4) == 0)
        map(&s->points_p, 1, (pir_vec3){test_random_between(random, -900, 900), 7, 0});
}

static void make_near(test_random *random, exact_scene *s) {
    s->aligns = 1;
    s->rotation = test_integer_rotation(random);
    fill_aligned(random, &s->points_p);
    fill_aligned(random, &s->points_q);
    switch (test_random_below(random, 5)) {
    case 0:
        snprintf(s->situation, sizeof s->situation, "moved vertices");
        shake(random, &s->points_p, tiny_length(random));
        shake(random, &s->points_q, tiny_length(random));
        break;
    case 1: {
        snprintf(s->situation, sizeof s->situation, "baked alike");
        pir_quat turn = test_general_rotation(random);
        bake(&s->points_p, turn);
        bake(&s->points_q, turn);
        s->rotation = (pir_quat){0, 0, 0, 1};
        break;
    }
    case 2:
        snprintf(s->situation, sizeof s->situation, "dodecahedra");
        fill_dodecahedron(&s->points_p);
        if (test_random_below(random, 2))
            fill_dodecahedron(&s->points_q);
        shake(random, &s->points_p, 2e-16);
        s->rotation = test_random_below(random, 2) ? s->rotation : (pir_quat){0, 0, 0, 1};
        break;
    case 3:
        snprintf(s->situation, sizeof s->situation, "cylinders");
        fill_cylinder(random, &s->points_p);
        if (test_random_below(random, 2))
            fill_cylinder(random, &s->points_q);
        break;
    default:
        snprintf(s->situation, sizeof s->situation, "nearly aligned");
        break;
    }
    if (test_random_below(random, 3) == 0) {
        double h = tiny_length(random);
        s->rotation.x = nudge(random, s->rotation.x, h);
        s->rotation.y = nudge(random, s->rotation.y, h);
        s->rotation.w = nudge(random, s->rotation.w, h);
    }
}

static void make_general(test_random *random, exact_scene *s) {
    s->aligns = 0;
    s->rotation = test_general_rotation(random);
    fill_general(random, &s->points_p);
    fill_general(random, &s->points_q);
    snprintf(s->situation, sizeof s->situation, "general position");
    if (test_random_below(random, 6) == 0) {
        snprintf(s->situation, sizeof s->situation, "a hundred times the size");
        map(&s->points_q, 100, (pir_vec3){0, 0, 0});
    }
}

static void rescale(test_random *random, exact_scene *s) {
    static const double ten[2] = {1e150, 1e-150};
    int choice = test_random_between(random, 0, 9);
    s->scale = 1;
    if (choice < 2)
        s->scale = s->aligns ? ldexp(1, choice ? -498 : 498) : ten[choice];
    if (choice == 2)
        s->scale = ldexp(1, test_random_between(random, -300, 300));
    map(&s->points_p, s->scale, (pir_vec3){0, 0, 0});
    map(&s->points_q, s->scale, (pir_vec3){0, 0, 0});
    size_t n = strlen(s->situation);
    if (s->scale != 1)
        snprintf(s->situation + n, sizeof s->situation - n, ", times %.3g", s->scale);
}

void exact_scene_make(test_random *random, uint64_t number, exact_scene *ret_scene) {
    void (*const make[3])(test_random *, exact_scene *) = {make_degenerate, make_near, make_general};
    make[number % 3](random, ret_scene);
    rescale(random, ret_scene);
}

pir_quat exact_rotation(test_random *random, const exact_scene *scene) {
    if (!scene->aligns || test_random_below(random, 4) == 0)
        return test_general_rotation(random);
    pir_quat r = test_integer_rotation(random);
    if (test_random_below(random, 4) == 0)
        r.z = nudge(random, r.z, tiny_length(random));
    return r;
}

/* --- translations --- */

static uint32_t some_of(test_random *random, const oracle_set *set, uint32_t count) {
    for (;;) {
        uint32_t i = test_random_below(random, count);
        if (oracle_set_has(set, i))
            return i;
    }
}

/* A vertex of the difference, in plane i where it has planes. */
static pir_vec3 some_vertex(test_random *random, const oracle_place *o, uint32_t i) {
    return oracle_place_vertex(o, some_of(random, o->plane[i].p, o->p->count),
                               some_of(random, o->plane[i].q, o->q->count));
}

/* A point of plane i of the difference: between 1 to 3 of its vertices. */
static pir_vec3 some_point(test_random *random, const oracle_place *o, uint32_t i, int corners) {
    pir_vec3 at = some_vertex(random, o, i);
    if (corners > 1)
        at = test_add(at, test_add(some_vertex(random, o, i), at, -1), test_random_below(random, 2) ? 0.5 : 0.375);
    if (corners > 2)
        at = test_add(at, test_add(some_vertex(random, o, i), at, -1), test_random_below(random, 2) ? 0.25 : 0.4);
    return at;
}

static pir_vec3 step_ulps(test_random *random, pir_vec3 x) {
    double *c[3] = {&x.x, &x.y, &x.z};
    double *one = c[test_random_below(random, 3)];
    *one = nextafter(*one, test_random_below(random, 2) ? HUGE_VAL : -HUGE_VAL);
    return x;
}

static double round_to(double x, double unit) {
    return rint(x / unit) * unit;
}

pir_vec3 exact_translation(test_random *random, const oracle_place *o, double size) {
    uint32_t i = test_random_below(random, o->plane_count), j = test_random_below(random, o->plane_count);
    pir_vec3 direction = test_random_direction(random),
             at = some_point(random, o, i, test_random_between(random, 1, 3));
    pir_vec3 normal = {o->plane[i].near[0], o->plane[i].near[1], o->plane[i].near[2]};
    double small = ldexp(size, -test_random_between(random, 4, 58)), unit = ldexp(1, ilogb(size) - 4);
    switch (test_random_below(random, 11)) {
    case 0:
        return test_add(at, direction, size * ldexp(1, test_random_between(random, -2, 20)));
    case 1:
    case 2:
        return at;
    case 3:
        return step_ulps(random, at);
    case 4:
        return test_add(at, direction, small);
    case 5:
        return test_add(at, normal, small);
    case 6:
        return test_add(at, normal, -small);
    case 7: {
        pir_vec3 middle = test_add(at, test_add(some_point(random, o, j, 3), at, -1), 0.5);
        return test_random_below(random, 2)
                   ? middle
                   : (pir_vec3){round_to(middle.x, unit), round_to(middle.y, unit), round_to(middle.z, unit)};
    }
    case 8:
        return test_add(at, test_add(some_vertex(random, o, j), at, -1), fabs(test_random_unit(random)));
    case 9:
        return (pir_vec3){round_to(at.x, unit), round_to(at.y, unit), round_to(at.z, unit)};
    default:
        // one coordinate next to 0 gives gaps far below an ulp of the size where a facet passes there
        at.x = test_random_below(random, 2) ? ldexp(size, -test_random_between(random, 46, 58)) : at.x;
        at.y = test_random_below(random, 2) ? -ldexp(size, -test_random_between(random, 46, 58)) : at.y;
        return at;
    }
}

/* --- directions --- */

static pir_vec3 some_direction(test_random *random, const oracle_place *o, pir_vec3 t, double size) {
    uint32_t i = test_random_below(random, o->plane_count), j = test_random_below(random, o->plane_count);
    pir_vec3 normal = {o->plane[i].near[0], o->plane[i].near[1], o->plane[i].near[2]};
    pir_vec3 edge = test_add(some_vertex(random, o, i), some_vertex(random, o, i), -1),
             any = test_random_direction(random);
    double length = ldexp(size, test_random_between(random, -4, 3));
    pir_vec3 across = test_cross(normal, any);
    double lean = pow(10, -test_random_between(random, 1, 17)) * (test_random_below(random, 2) ? 1 : -1);
    switch (test_random_below(random, 9)) {
    case 0:
        return test_add((pir_vec3){0, 0, 0}, any, length);
    case 1: {
        double axis[3] = {0, 0, 0};
        axis[test_random_below(random, 3)] = test_random_below(random, 2) ? length : -length;
        return (pir_vec3){axis[0], axis[1], axis[2]};
    }
    case 2:
        return edge.x == 0 && edge.y == 0 && edge.z == 0 ? any : edge;
    case 3:
        return test_add((pir_vec3){0, 0, 0}, across, length);
    case 4:
        return test_add((pir_vec3){0, 0, 0}, test_add(across, normal, lean), length);
    case 5:
        return edge.x == 0 && edge.y == 0 && edge.z == 0 ? any : test_add(edge, normal, lean * size);
    case 6:
        return test_add((pir_vec3){0, 0, 0}, normal, test_random_below(random, 2) ? length : -length);
    default: {
        // towards a point of the difference: hits
        pir_vec3 to = test_add(some_point(random, o, j, test_random_between(random, 1, 3)), t, -1);
        double factor = test_random_below(random, 2) ? 1 : ldexp(1, test_random_between(random, -1, 3));
        return to.x == 0 && to.y == 0 && to.z == 0 ? any : test_add((pir_vec3){0, 0, 0}, to, factor);
    }
    }
}

pir_vec3 exact_direction(test_random *random, const oracle_place *o, pir_vec3 t, double size) {
    pir_vec3 d = some_direction(random, o, t, size);
    // halves of the least double are nothing
    return d.x == 0 && d.y == 0 && d.z == 0 ? (pir_vec3){1, 0, 0} : d;
}
