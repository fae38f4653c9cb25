/* SPDX-License-Identifier: MIT */
/*
 * Two bodies of a kind fall on a slab, side by side and one onto the other, with contacts from the library's
 * manifolds alone, and come to rest. Their vertices were rotated in double before their hulls were made, so that no
 * facet is quite flat. PIR_TEST_DROPS sets the number of falls of each kind.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include <pirouette/shape.h>

#include "query/rigid.h"
#include "support/bodies.h"
#include "support/vectors.h"

#define FRAMES  5000
#define STEP    (1.0 / 240)
#define AT_REST 1e-4
#define SUNK    2e-3 /* four times the depth that the solver leaves */

/* A shape with its vertices rotated in double, about its middle. */
static pir_polytope *baked(const char *name, pir_quat turned) {
    pir_polytope *shape, *result;
    pir_vec3 at[256], middle = test_zero;
    assert_int_equal(pir_shape_create(name, NULL, NULL, &shape), PIR_OK);
    uint32_t count = pir_polytope_vertex_count(shape);
    assert_true(count <= 256);
    for (uint32_t v = 0; v < count; v++)
        middle = test_add(middle, pir_polytope_vertex(shape, v), 1.0 / count);
    for (uint32_t v = 0; v < count; v++)
        at[v] = rigid_turn(turned, test_add(pir_polytope_vertex(shape, v), middle, -1));
    assert_int_equal(pir_polytope_create(at, count, NULL, &result), PIR_OK);
    pir_polytope_release(shape);
    return result;
}

static pir_quat turn_about(pir_vec3 axis, double angle) {
    double s = sin(angle / 2);
    return (pir_quat){s * axis.x, s * axis.y, s * axis.z, cos(angle / 2)};
}

/* A rotation that lays the shape's facet with the most corners down, tilted by a few degrees. */
static pir_quat upright(const pir_polytope *shape, test_random *random) {
    // split facets have as many corners as others, so the greatest reach of what is flat with them counts
    double least = HUGE_VAL;
    pir_vec3 down = {0, 0, -1};
    for (uint32_t f = 0; f < pir_polytope_facet_count(shape); f++) {
        uint32_t corner[256], level = 0;
        pir_polytope_facet(shape, f, corner);
        pir_vec3 n = pir_polytope_normal(shape, f);
        for (uint32_t v = 0; v < pir_polytope_vertex_count(shape); v++)
            level +=
                fabs(test_dot(n, test_add(pir_polytope_vertex(shape, v), pir_polytope_vertex(shape, corner[0]), -1))) <
                1e-9;
        if (-(double)level < least) {
            least = -(double)level;
            down = n;
        }
    }
    pir_quat lay = rigid_turn_to(down, (pir_vec3){0, 0, -1});
    pir_quat yaw = turn_about((pir_vec3){0, 0, 1}, 3 * test_random_unit(random));
    pir_vec3 axis = test_random_direction(random);
    return rigid_product(turn_about(axis, 0.05 * test_random_unit(random)), rigid_product(yaw, lay));
}

static pir_quat any_turn(test_random *random) {
    return turn_about(test_random_direction(random), 3 * test_random_unit(random));
}

/* The height that the rotated shape reaches, or its depth with sign −1. */
static double reach(const pir_polytope *shape, pir_quat turned, double sign) {
    double most = 0;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(shape); v++)
        most = fmax(most, sign * rigid_turn(turned, pir_polytope_vertex(shape, v)).z);
    return most;
}

/* A slab, rotated in double as well and turned back, and two bodies above it. */
static void build(rigid_world *world, const char *name, bool stacked, test_random *random) {
    pir_quat bake = any_turn(random);
    double top = 0;
    rigid_add(world, baked("box?x=12&y=12&z=1", bake), 0, (pir_vec3){0, 0, -0.5}, rigid_inverse(bake));
    for (int i = 0; i < 2; i++) {
        pir_polytope *shape = baked(name, any_turn(random));
        pir_quat turn = stacked ? upright(shape, random) : any_turn(random);
        pir_vec3 place = {0.05 * test_random_unit(random), 0.05 * test_random_unit(random),
                          top + 0.2 + reach(shape, turn, -1)};
        place.x += stacked ? 0 : i == 0 ? -1.6 : 1.6;
        top = stacked ? place.z + reach(shape, turn, 1) : 0.3;
        rigid_add(world, shape, 1, place, turn);
    }
    rigid_start(world);
}

static double lowest(const rigid_body *body) {
    return body->place.z - reach(body->shape, body->rotation, -1);
}

static void fall(const char *name, bool stacked, uint64_t number) {
    test_random random = test_random_case(name, number);
    rigid_world world = {.bodies = 0};
    build(&world, name, stacked, &random);
    const rigid_body *a = &world.body[1], *b = &world.body[2];
    double fastest = 0, late = 0;
    int rested = 0;
    for (int frame = 0; frame < FRAMES; frame++) {
        rigid_step(&world, STEP);
        double speed = fmax(rigid_speed(a), rigid_speed(b));
        fastest = fmax(fastest, speed);
        rested = speed < AT_REST ? rested : frame + 1;
        late = frame >= FRAMES - 100 ? fmax(late, speed) : 0;
    }
    unsigned long long n = number;
    print_message("# %.12s %s %llu: fastest %.2f m/s, at rest from frame %d, %.1e m/s in the last 100; %lu manifolds, "
                  "%lu without their answer, up to %zu contacts\n",
                  name, stacked ? "stacked" : "beside", n, fastest, rested, late, world.asked, world.missed,
                  world.most);
    assert_true(fastest > 1 && world.asked > FRAMES && world.missed == 0);
    expect(late < AT_REST, "%s, %llu: %.3g m/s", name, n, late);
    // on the slab and on each other, not in them
    double over = stacked ? a->place.z + reach(a->shape, a->rotation, 1) : 0;
    expect(fabs(lowest(a)) < SUNK && fabs(lowest(b) - over) < SUNK, "%s, %llu: %.3g and %.3g above", name, n, lowest(a),
           lowest(b) - over);
    rigid_clear(&world);
}

static void bodies_fall_and_rest(void **state) {
    (void)state;
    const char *text = getenv("PIR_TEST_DROPS");
    const uint64_t drops = text && *text ? strtoull(text, NULL, 10) : 1;
    static const char *const names[] = {"cube", "dodecahedron", "cylinder?sides=32&radius=0.5&height=1"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        for (uint64_t i = 0; i < drops; i++) {
            fall(names[k], false, i);
            fall(names[k], true, i);
        }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(bodies_fall_and_rest)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
