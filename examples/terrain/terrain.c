/* SPDX-License-Identifier: MIT */
/*
 * A newcomer's game: 200 hulls and 100 balls fall on hills, and a capsule walks over them, across a gorge by a bridge.
 * The hills are a height field, the bridge is a mesh; both are static bodies like any other. The bodies are those of
 * examples/physics. The capsule is no body: it asks the scene what it would meet, as a character in a game does.
 *
 * Says how far the walk came, how many bodies came to rest, and whether any fell through. `terrain page >FILE.html`
 * writes a page that shows it. Metres and seconds.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "simulate/playback.h"
#include <vec.h>

#define SIDE    65 /* samples a side, a metre apart */
#define HULLS   200
#define BALLS   100
#define SHAPES  8
#define BODIES  (2 + HULLS + BALLS)
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

static pir_status make_hills(struct world_shape *ret_shape) {
    static float heights[SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE; i++)
        heights[i] = (float)height(i % SIDE, i / SIDE);
    const pir_height_samples samples = {
        .heights = heights, .type = PIR_NUMBERS_FLOAT, .columns = SIDE, .rows = SIDE, .step_x = 1, .step_y = 1};
    pir_height_field *hills = NULL;
    const pir_status status = pir_height_field_create(&samples, NULL, NULL, &hills);
    if (status == PIR_OK)
        *ret_shape = world_shape_of_field(hills);
    pir_height_field_release(hills);
    return status;
}

/* An arch of four vertices a place: a rectangle, 3 m wide and 0.3 m thick, swept from bank to bank. */
static pir_status make_bridge(struct world_shape *ret_shape) {
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
            memcpy(triangle[count], both, sizeof both);
            count += 2;
        }
    const uint32_t e = 4 * SPANS, ends[4][3] = {{0, 3, 2}, {0, 2, 1}, {e, e + 1, e + 2}, {e, e + 2, e + 3}};
    memcpy(triangle[count], ends, sizeof ends);
    count += 4;
    const pir_trimesh_arrays arrays = {
        .vertices = vertex, .vertex_count = 4 * (SPANS + 1), .triangles = triangle[0], .triangle_count = count};
    pir_trimesh *bridge = NULL;
    const pir_status status = pir_trimesh_create(&arrays, NULL, NULL, &bridge);
    if (status == PIR_OK)
        *ret_shape = world_shape_of_mesh(bridge);
    pir_trimesh_release(bridge);
    return status;
}

/* The same numbers everywhere, from 0 to 1. */
static double chance(void) {
    static uint32_t state = 1;
    return ((state = state * 1664525u + 1013904223u) >> 8) / 16777216.;
}

/* Hills, the bridge, hulls of 16 points, balls of many; last a capsule, halves of a ball a metre apart. */
static pir_status make_shape(int number, struct world_shape *ret_shape) {
    if (number < 2)
        return number == 0 ? make_hills(ret_shape) : make_bridge(ret_shape);
    const bool hull = number < 2 + SHAPES / 2, capsule = number == 2 + SHAPES;
    const uint32_t count = hull ? 16 : capsule ? 200 : 60;
    const double size = capsule ? RADIUS : 0.25 + 0.2 * chance();
    pir_vec3 point[200];
    for (uint32_t i = 0; i < count; i++) {
        // anywhere on the sphere, or a spiral
        const double z = hull ? 2 * chance() - 1 : (2. * i + 1) / count - 1, r = sqrt(1 - z * z);
        const double turn = hull ? 6.3 * chance() : 2.4 * i, up = capsule ? copysign(0.5, z) : 0;
        point[i] = (pir_vec3){size * r * cos(turn), size * r * sin(turn), (hull ? 0.8 : 1) * size * z + up};
    }
    pir_polytope *made = NULL;
    pir_status status = pir_polytope_create(point, count, NULL, &made);
    status = status == PIR_OK ? world_shape_make(&made, 1, ret_shape) : status;
    pir_polytope_release(made);
    return status;
}

/* Hills, bridge, hulls and balls; last the capsule, which the page shows and the world does not have. */
static pir_status fill(struct world *world, struct stage *stage) {
    pir_status status = PIR_OK;
    for (uint32_t i = 0; i <= BODIES && status == PIR_OK; i++) {
        const uint32_t k = i - 2, kind = (k < HULLS ? 0 : SHAPES / 2) + k % (SHAPES / 2) + 2;
        const uint32_t shape = i < 2 ? i : i < BODIES ? kind : 2 + SHAPES;
        const pir_body_kind moves = i < 2 ? PIR_BODY_STATIC : i < BODIES ? PIR_BODY_MOVING : PIR_BODY_KINEMATIC;
        struct world_body body = {.kind = moves, .density = 1000, .friction = 0.6, .shape = &stage->shape[shape]};
        body.pose = pir_pose_identity();
        // beside the way of the capsule
        const double x = 8 + 2.5 * (k % 20), y = 8 + 3 * (k / 20) + (k / 20 < 8 ? 0. : 5.);
        if (moves == PIR_BODY_MOVING)
            body.pose.translation = (pir_vec3){x, y, height(x, y) + 0.7 + chance()};
        stage->body[i] = (struct stage_body){body, shape};
        status = i < BODIES ? world_add(world, &body) : PIR_OK;
    }
    return status;
}

/* A step of a walk: up as far as a stair is high, on, and down to the ground, each as far as the capsule can go. */
static void walk(pir_scene *scene, pir_scene_shape *capsule, pir_vec3 on) {
    const pir_vec3 way[3] = {{0, 0, 0.35}, on, {0, 0, -0.8}};
    for (int k = 0; k < 3; k++) {
        const pir_motion motion = {.way = way[k], .held = k == 0 ? 2e-3 : 0}; // what it stands on lets it go up
        pir_impact impact = {.body = 0, .time = 0};
        (void)pir_scene_cast(scene, capsule, &motion, 1e-3, &impact); // where it fails, it stays
        const double part = impact.body == PIR_SCENE_NONE ? 1 : impact.time;
        capsule->pose.translation = vec_add(capsule->pose.translation, vec_times(part, way[k]));
    }
}

static int tell(const struct world *world, double walked, double bridge) {
    int through = 0, asleep = 0;
    for (uint32_t i = 2; i < world_count(world); i++) {
        const pir_vec3 at = world_motion(world, i).pose.translation;
        asleep += world_motion(world, i).asleep;
        through += at.z < height(at.x, at.y) - 0.5;
    }
    fprintf(stderr, "%d bodies, %d fell through the ground, %d came to rest\n", HULLS + BALLS, through, asleep);
    fprintf(stderr, "the capsule walked %.1f m, over a bridge %.1f m above the ground of the gorge\n", walked, bridge);
    return through == 0 && walked > 44 && bridge > 4 ? EXIT_SUCCESS : EXIT_FAILURE;
}

/* Runs it all; the capsule starts where it stands. */
static pir_status run(struct world *world, struct playback *page, pir_scene_shape *capsule, double *ret_above) {
    const int steps = (int)(SECONDS / world_options_default().step), frame = steps / SECONDS / PLAYBACK_RATE;
    pir_status status = PIR_OK;
    for (int i = 0; i < steps && status == PIR_OK; i++) {
        page->stage->body[BODIES].body.pose = capsule->pose;
        if (i % frame == 0 && !playback_add(page, world))
            return PIR_ERR_MEMORY;
        status = world_step(world);
        walk(world_scene(world), capsule, (pir_vec3){48. / steps, 0, 0});
        const pir_vec3 at = capsule->pose.translation;
        *ret_above = fmax(*ret_above, fabs(at.x - GORGE) < 1 ? at.z - 0.5 - RADIUS - height(at.x, at.y) : 0);
    }
    return status;
}

int main(int count, char **arguments) {
    const struct world_options options = world_options_default();
    static struct world_shape shape[SHAPES + 3];
    static struct stage_body body[BODIES + 1];
    struct stage stage = {.shape = shape, .body = body, .shape_count = SHAPES + 3, .body_count = BODIES + 1};
    struct world *world = NULL;
    struct playback page = {0};
    const pir_vec3 spine[2] = {{0, 0, -0.5}, {0, 0, 0.5}};
    pir_polytope *segment = NULL;
    double above = 0;
    pir_status status = pir_polytope_create(spine, 2, NULL, &segment);
    for (int i = 0; i < SHAPES + 3 && status == PIR_OK; i++)
        status = make_shape(i, &shape[i]);
    status = status == PIR_OK ? world_create(&options, &world) : status;
    status = status == PIR_OK ? fill(world, &stage) : status;
    pir_scene_shape capsule = pir_scene_shape_default(segment);
    capsule.radius = RADIUS;
    capsule.pose.translation = (pir_vec3){8, MIDDLE, height(8, MIDDLE) + 2};
    if (status == PIR_OK)
        status = playback_init(&page, &stage) ? run(world, &page, &capsule, &above) : PIR_ERR_MEMORY;
    const bool shown = status == PIR_OK && count > 1 && strcmp(arguments[1], "page") == 0;
    status = shown && !playback_print(stdout, &page, "A capsule walks over hills and a bridge, among 300 bodies", NULL)
                 ? PIR_ERR_MEMORY
                 : status;
    const int result = status == PIR_OK ? tell(world, capsule.pose.translation.x - 8, above) : EXIT_FAILURE;
    if (status != PIR_OK)
        fprintf(stderr, "terrain: %s\n", pir_status_text(status));
    playback_clear(&page);
    world_destroy(world);
    for (int i = 0; i < SHAPES + 3; i++)
        world_shape_release(&shape[i]);
    pir_polytope_release(segment);
    return result;
}
