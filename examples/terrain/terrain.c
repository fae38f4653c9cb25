/* SPDX-License-Identifier: MIT */
/*
 * A newcomer's game: 200 hulls and 100 balls fall on hills, and a capsule walks over them, across a gorge by a bridge.
 * The hills are a height field, the bridge is a mesh; both are static bodies like any other. The bodies are those of
 * examples/physics. The capsule is no body: it asks the scene what it would meet, as a character in a game does.
 *
 * Says how far the walk came, how many bodies came to rest, and whether any fell through. Metres and seconds.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <vec.h>
#include <world.h>

#define SIDE    65 /* samples a side, a metre apart */
#define HULLS   200
#define BALLS   100
#define SHAPES  8
#define SECONDS 2
#define GORGE   32. /* where it is along x; the way across leads along y = MIDDLE */
#define MIDDLE  32.
#define SPANS   12 /* of the bridge, from GORGE − HALF to GORGE + HALF */
#define HALF    6.
#define RADIUS  0.4 /* of the capsule */

static double height(double x, double y) {
    const double hills = 1.2 * sin(0.35 * x) * cos(0.27 * y), rim = 0.006 * ((x - 32) * (x - 32) + (y - 32) * (y - 32));
    const double off = (x - GORGE) / 3, along = (y - MIDDLE) / 4;
    return hills / (1 + along * along * 0.5) + rim - 6 * exp(-off * off * off * off);
}

static pir_height_field *make_hills(void) {
    static float heights[SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE; i++)
        heights[i] = (float)height(i % SIDE, i / SIDE);
    const pir_height_samples samples = {
        .heights = heights, .type = PIR_NUMBERS_FLOAT, .columns = SIDE, .rows = SIDE, .step_x = 1, .step_y = 1};
    pir_height_field *hills = NULL;
    return pir_height_field_create(&samples, NULL, NULL, &hills) == PIR_OK ? hills : NULL;
}

/* An arch of four vertices a place: a rectangle, 3 m wide and 0.3 m thick, swept from bank to bank. */
static pir_trimesh *make_bridge(void) {
    static pir_vec3 vertex[4 * (SPANS + 1)];
    static uint32_t triangle[8 * SPANS + 4][3];
    uint32_t count = 0;
    for (uint32_t i = 0; i <= SPANS; i++) {
        const double t = 2. * i / SPANS - 1, x = GORGE + HALF * t;
        const double bank = 0.5 * ((1 - t) * height(GORGE - HALF, MIDDLE) + (1 + t) * height(GORGE + HALF, MIDDLE));
        const double top = bank + 0.1 + 0.8 * (1 - t * t);
        for (uint32_t k = 0; k < 4; k++) // up left, up right, down right, down left
            vertex[4 * i + k] = (pir_vec3){x, MIDDLE + (k == 0 || k == 3 ? 1.5 : -1.5), top - (k < 2 ? 0 : 0.3)};
    }
    for (uint32_t i = 0; i < SPANS; i++)
        for (uint32_t k = 0; k < 4; k++) {
            const uint32_t a = 4 * i + k, b = 4 * i + (k + 1) % 4, c = b + 4, d = a + 4;
            const uint32_t both[2][3] = {{a, b, c}, {a, c, d}};
            for (int j = 0; j < 2; j++, count++)
                for (int n = 0; n < 3; n++)
                    triangle[count][n] = both[j][n];
        }
    const uint32_t e = 4 * SPANS, ends[4][3] = {{0, 3, 2}, {0, 2, 1}, {e, e + 1, e + 2}, {e, e + 2, e + 3}};
    for (int j = 0; j < 4; j++, count++)
        for (int n = 0; n < 3; n++)
            triangle[count][n] = ends[j][n];
    const pir_trimesh_arrays arrays = {
        .vertices = vertex, .vertex_count = 4 * (SPANS + 1), .triangles = triangle[0], .triangle_count = count};
    pir_trimesh *bridge = NULL;
    return pir_trimesh_create(&arrays, NULL, NULL, &bridge) == PIR_OK ? bridge : NULL;
}

/* The same numbers everywhere, from 0 to 1. */
static double chance(void) {
    static uint32_t state = 1;
    state = state * 1664525u + 1013904223u;
    return (state >> 8) / 16777216.;
}

/* A ball, or a hull of 16 points. */
static pir_status make_shape(bool ball, struct world_shape *ret_shape) {
    pir_vec3 point[60];
    const uint32_t count = ball ? 60 : 16;
    const double size = 0.25 + 0.2 * chance();
    for (uint32_t i = 0; i < count; i++) {
        // a spiral, or anywhere on the sphere
        const double z = ball ? (2. * i + 1) / count - 1 : 2 * chance() - 1, turn = ball ? 2.4 * i : 6.3 * chance();
        const double r = sqrt(1 - z * z);
        point[i] = (pir_vec3){size * r * cos(turn), size * r * sin(turn), (ball ? size : 0.8 * size) * z};
    }
    pir_polytope *hull = NULL;
    pir_status status = pir_polytope_create(point, count, NULL, &hull);
    if (status == PIR_OK)
        status = world_shape_make(&hull, 1, ret_shape);
    pir_polytope_release(hull);
    return status;
}

static pir_status fill(struct world *world, const struct world_shape *ground, const struct world_shape *shape) {
    struct world_body body = {.kind = PIR_BODY_STATIC, .density = 1000, .friction = 0.6};
    body.pose.rotation.w = 1;
    pir_status status = PIR_OK;
    for (int i = 0; i < 2 && status == PIR_OK; i++) {
        body.shape = &ground[i];
        status = world_add(world, &body);
    }
    body.kind = PIR_BODY_MOVING;
    for (int i = 0; i < HULLS + BALLS && status == PIR_OK; i++) {
        // beside the way of the capsule
        const double x = 8 + 2.5 * (i % 20), y = 8 + 3 * (i / 20) + (i / 20 < 8 ? 0. : 5.);
        body.shape = &shape[i < HULLS ? i % (SHAPES / 2) : SHAPES / 2 + i % (SHAPES / 2)];
        body.pose.translation = (pir_vec3){x, y, height(x, y) + 0.7 + chance()};
        status = world_add(world, &body);
    }
    return status;
}

/* How far the capsule can go along a way, as a part of it. What it stands on does not keep it from going up. */
static double can_go(pir_scene *scene, const pir_scene_shape *capsule, pir_vec3 way) {
    const pir_motion motion = {.way = way, .held = way.z > 0 ? 2e-3 : 0};
    pir_impact impact;
    if (pir_scene_cast(scene, capsule, &motion, 1e-3, &impact) != PIR_OK)
        return 0;
    return impact.body == PIR_SCENE_NONE ? 1 : impact.time;
}

/* A step of a walk: up as far as a stair is high, on, and down to the ground. */
static void walk(pir_scene *scene, pir_scene_shape *capsule, pir_vec3 on) {
    const pir_vec3 way[3] = {{0, 0, 0.35}, on, {0, 0, -0.8}};
    for (int k = 0; k < 3; k++)
        capsule->pose.translation =
            vec_add(capsule->pose.translation, vec_times(can_go(scene, capsule, way[k]), way[k]));
}

static int tell(const struct world *world, double walked, double bridge) {
    int through = 0, asleep = 0;
    for (uint32_t i = 2; i < world_count(world); i++) {
        const struct world_motion motion = world_motion(world, i);
        const pir_vec3 at = motion.pose.translation;
        asleep += motion.asleep;
        through += at.z < height(at.x, at.y) - 0.5;
    }
    printf("%d bodies, %d fell through the ground, %d came to rest\n", HULLS + BALLS, through, asleep);
    printf("the capsule walked %.1f m, over the bridge %.1f m above the ground of the gorge\n", walked, bridge);
    return through == 0 && walked > 44 && bridge > 4 ? EXIT_SUCCESS : EXIT_FAILURE;
}

int main(void) {
    struct world_options options = world_options_default();
    struct world_shape ground[2] = {0}, shape[SHAPES] = {0};
    struct world *world = NULL;
    pir_height_field *hills = make_hills();
    pir_trimesh *bridge = make_bridge();
    const pir_vec3 spine[2] = {{0, 0, -0.5}, {0, 0, 0.5}};
    pir_polytope *segment = NULL;
    pir_status status = hills && bridge ? pir_polytope_create(spine, 2, NULL, &segment) : PIR_ERR_MEMORY;
    if (status == PIR_OK) {
        ground[0] = world_shape_of_field(hills);
        ground[1] = world_shape_of_mesh(bridge);
    }
    for (int i = 0; i < SHAPES && status == PIR_OK; i++)
        status = make_shape(i >= SHAPES / 2, &shape[i]);
    if (status == PIR_OK)
        status = world_create(&options, &world);
    if (status == PIR_OK)
        status = fill(world, ground, shape);
    pir_scene_shape capsule = pir_scene_shape_default(segment);
    capsule.radius = RADIUS;
    capsule.pose.translation = (pir_vec3){8, MIDDLE, height(8, MIDDLE) + 2};
    const int steps = (int)(SECONDS / options.step);
    double above = 0;
    for (int i = 0; i < steps && status == PIR_OK; i++) {
        status = world_step(world);
        walk(world_scene(world), &capsule, (pir_vec3){48. / steps, 0, 0});
        const pir_vec3 at = capsule.pose.translation;
        above = fmax(above, fabs(at.x - GORGE) < 1 ? at.z - 0.5 - RADIUS - height(at.x, at.y) : 0);
    }
    const int result = status == PIR_OK ? tell(world, capsule.pose.translation.x - 8, above) : EXIT_FAILURE;
    if (status != PIR_OK)
        fprintf(stderr, "terrain: %s\n", pir_status_text(status));
    world_destroy(world);
    for (int i = 0; i < SHAPES; i++)
        world_shape_release(&shape[i]);
    for (int i = 0; i < 2; i++)
        world_shape_release(&ground[i]);
    pir_polytope_release(segment);
    pir_trimesh_release(bridge);
    pir_height_field_release(hills);
    return result;
}
