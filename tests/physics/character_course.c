/* SPDX-License-Identifier: MIT */
/*
 * A course for the character: stairs of 0.25 m up and down, a wall of 80 degrees, two corners, a slope, a platform that
 * moves, a block that pushes. Prints where the capsule was on the way, and how near it came to anything. It does not
 * depend on the number of threads, which is the argument.
 */
#include <stdio.h>
#include <stdlib.h>

#include <vec.h>

#include "character.h"

#define FRAME  (1. / 60)
#define RADIUS 0.3
#define HALF   0.6 /* of the spine */

/* What stands over an outline of four corners, from one height to another; `lean` moves its top along x. */
struct block {
    double outline[4][2], low, high, lean;
    pir_body_kind kind;
};
/* Stairs at y = 0, others a few metres apart along y; the platform and the block that pushes come last. */
static const struct block course[] = {
    {{{-20, -20}, {20, -20}, {20, 40}, {-20, 40}}, -1, 0, 0, PIR_BODY_STATIC},
    {{{3, 4}, {6, 4}, {6, 7}, {3, 7}}, 0, 3, 0.5289809421253949, PIR_BODY_STATIC},
    {{{3, 9}, {4, 9}, {4, 13}, {3, 13}}, -1, 3, 0, PIR_BODY_STATIC},
    {{{0, 12}, {3, 12}, {3, 13}, {0, 13}}, -1, 3, 0, PIR_BODY_STATIC},
    {{{0, 22}, {5, 22}, {5, 23}, {0, 23}}, -1, 3, 0, PIR_BODY_STATIC},
    {{{1, 18}, {5, 18}, {5, 22}, {3, 18}}, -1, 3, 0, PIR_BODY_STATIC},
    {{{2, 29}, {9, 29}, {9, 31}, {2, 31}}, -4, 4, 11.425184053936859, PIR_BODY_STATIC},
    {{{-6, -6}, {-4, -6}, {-4, -4}, {-6, -4}}, 0.25, 0.5, 0, PIR_BODY_KINEMATIC},
    {{{9, 14}, {10, 14}, {10, 17}, {9, 17}}, 0.125, 2, 0, PIR_BODY_KINEMATIC},
};
#define BLOCKS (sizeof course / sizeof *course)

/* Block `mover` goes along `drift` in the first half, and back in the second. */
static const struct stage {
    const char *name;
    pir_vec3 feet, velocity, drift;
    int frames;
    size_t mover;
} stage[] = {
    {"up stairs", {0, 0, 0}, {2, 0.125, 0}, {0, 0, 0}, 200, BLOCKS},
    {"down stairs", {6, 0, 2}, {-2, 0, 0}, {0, 0, 0}, 200, BLOCKS},
    {"steep", {1, 5.5, 0}, {3, 0, 0}, {0, 0, 0}, 200, BLOCKS},
    {"corner", {1, 10, 0}, {2, 1.5, 0}, {0, 0, 0}, 300, BLOCKS},
    {"narrow", {0, 20.5, 0}, {2, 0, 0}, {0, 0, 0}, 300, BLOCKS},
    {"slope", {6, 30, 0}, {2, 0, 0}, {0, 0, 0}, 200, BLOCKS},
    {"platform", {-5, -5, 0.5}, {0, 0, 0}, {1.25, 0.5, 0.5}, 240, BLOCKS - 2},
    {"pushed", {11, 15, 0}, {0, 0, 0}, {1.5, 0, 0}, 240, BLOCKS - 1},
};

static pir_status add(pir_scene *scene, const struct block *block, uint32_t *ret_id) {
    pir_body_shape *shape = NULL;
    pir_vec3 point[8];
    for (int i = 0; i < 8; i++)
        point[i] = (pir_vec3){block->outline[i % 4][0] + (i < 4 ? 0 : block->lean), block->outline[i % 4][1],
                              i < 4 ? block->low : block->high};
    pir_status status = pir_body_shape_hull(point, 8, 0, NULL, NULL, &shape);
    if (status == PIR_OK) {
        pir_body_options body = pir_body_shape_options(shape);
        body.kind = block->kind;
        status = pir_scene_add(scene, &body, ret_id);
    }
    pir_body_shape_release(shape);
    return status;
}

static pir_status run(pir_scene *scene, const struct stage *s, uint32_t mover, struct character c) {
    pir_status status = PIR_OK;
    double least = HUGE_VAL;
    for (int i = 0; i < s->frames && status == PIR_OK; i++) {
        const double time = FRAME * (i < s->frames / 2 ? i + 1 : s->frames - 1 - i);
        const pir_scene_move move = {mover, {{0, 0, 0, 1}, vec_times(time, s->drift)}};
        pir_scene_near near;
        size_t count = 0;
        status = pir_scene_update(scene, &move, s->mover < BLOCKS);
        character_move(&c, scene, s->velocity, FRAME);
        const pir_scene_shape shape = character_shape(&c);
        if (status == PIR_OK && c.status == PIR_OK)
            status = pir_scene_nearest(scene, &shape, 1, 1, &near, &count);
        least = count > 0 ? fmin(least, near.result.distance) : least;
        printf("%s %d %.17g %.17g %.17g %d\n", s->name, i + 1, c.at.x, c.at.y, c.at.z, c.stands);
    }
    printf("%s nearest %.9g\n", s->name, least);
    return c.status != PIR_OK ? c.status : status;
}

int main(int count, char **arguments) {
    const pir_vec3 end[2] = {{0, 0, -HALF}, {0, 0, HALF}};
    pir_scene_options options = pir_scene_options_default();
    pir_polytope *spine = NULL;
    pir_scene *scene = NULL;
    uint32_t id[BLOCKS + 1] = {0};
    options.threads = count > 1 ? (uint32_t)atoi(arguments[1]) : 1;
    pir_status status = pir_polytope_create(end, 2, NULL, &spine);
    status = status == PIR_OK ? pir_scene_create(&options, &scene) : status;
    for (size_t i = 0; i < BLOCKS && status == PIR_OK; i++)
        status = add(scene, &course[i], &id[i]);
    for (int i = 1; i <= 8 && status == PIR_OK; i++) {
        const double x = 1.6 + 0.4 * i;
        const struct block stair = {{{x, -1}, {8, -1}, {8, 1}, {x, 1}}, -1, 0.25 * i, 0, PIR_BODY_STATIC};
        status = add(scene, &stair, &id[BLOCKS]);
    }
    for (size_t i = 0; i < sizeof stage / sizeof *stage && status == PIR_OK; i++) {
        const struct character c = {.spine = spine,
                                    .radius = RADIUS,
                                    .body = PIR_SCENE_NONE,
                                    .at = vec_add(stage[i].feet, (pir_vec3){0, 0, HALF + RADIUS + 0.05})};
        status = run(scene, &stage[i], id[stage[i].mover], c);
    }
    if (status != PIR_OK)
        fprintf(stderr, "course: %s\n", pir_status_text(status));
    pir_scene_destroy(scene);
    pir_polytope_release(spine);
    return status == PIR_OK ? EXIT_SUCCESS : EXIT_FAILURE;
}
