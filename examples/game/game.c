/* SPDX-License-Identifier: MIT */
/*
 * A game: 300 hulls fall on hills and push each other, a character walks among them, looks round by rays and shoots
 * bullets of 200 m/s, a sensor counts who is in it. Each frame is run on a guess, taken back, and run again. Memory,
 * with a budget, and threads are its own. `game THREADS` prints a hash of all frames, as `game THREADS plain` does
 * without guesses.
 */
#include <character.h>
#include <vec.h>

#include "crew.h"

#define HULLS 300
#define SIDE  64
#define STEP  (1. / 60)

/* All that is taken back with the scene. The user of a hull is 1 + its number. */
static struct game {
    uint32_t hull[HULLS], bullet;
    pir_vec3 velocity[HULLS], push[HULLS];
    struct character hero;
    uint32_t hits, seen, sensed;
} game;

static pir_scene *scene;
static pir_body_shape *ball;

static uint32_t add(pir_body_shape *shape, pir_body_kind kind, pir_vec3 at, uint64_t user) {
    pir_body_options body = pir_body_shape_options(shape);
    uint32_t id;
    body.kind = kind;
    body.pose.translation = at;
    body.user = user;
    body.sensor = kind == PIR_BODY_STATIC && !body.field;
    body.fast = shape == ball ? 1e-3 : 0;
    must(pir_scene_add(scene, &body, &id));
    pir_body_shape_release(shape == ball ? NULL : shape);
    return id;
}

static void build(void) {
    static float height[SIDE * SIDE];
    pir_height_field *field;
    pir_body_shape *shape;
    for (int i = 0; i < SIDE * SIDE; i++)
        height[i] = (float)(i % SIDE % 16 * (16 - i % SIDE % 16) * (i / SIDE % 16) * (16 - i / SIDE % 16) / 2048.);
    const pir_height_samples samples = {height, PIR_NUMBERS_FLOAT, SIDE, SIDE, 1, 1, NULL, NULL};
    must(pir_height_field_create(&samples, NULL, NULL, &field));
    must(pir_body_shape_field(field, 0, &crew_memory, NULL, &shape));
    add(shape, PIR_BODY_STATIC, (pir_vec3){0, 0, 0}, 0);
    pir_height_field_release(field);
    must(pir_body_shape_box((pir_vec3){4, 4, 4}, 0, &crew_memory, NULL, &shape));
    add(shape, PIR_BODY_STATIC, (pir_vec3){32, 32, 2}, 0);
    for (uint32_t i = 0; i < HULLS; i++) {
        pir_vec3 point[12];
        for (int k = 0; k < 12; k++)
            point[k] = (pir_vec3){chance() - 0.5, chance() - 0.5, chance() - 0.5};
        must(pir_body_shape_hull(point, 12, 0.05, &crew_memory, NULL, &shape));
        const pir_vec3 at = {16.3 + 1.6 * (i % 20), 20.3 + 1.6 * (i / 20), 5};
        game.hull[i] = add(shape, PIR_BODY_MOVING, at, 1 + i);
    }
    must(pir_body_shape_ball(0.05, &crew_memory, NULL, &ball));
    must(pir_body_shape_capsule((pir_vec3){0, 0, -0.6}, (pir_vec3){0, 0, 0.6}, 0.3, &crew_memory, NULL, &shape));
    game.hero.spine = pir_polytope_retain(pir_body_shape_options(shape).pieces[0]);
    game.hero.radius = 0.3;
    game.hero.at = (pir_vec3){12, 31, 4};
    game.hero.body = add(shape, PIR_BODY_KINEMATIC, game.hero.at, 0);
}

/* A hull that meets something is pushed out of it, along `normal`, and stops along it. */
static void push(uint64_t user, pir_vec3 normal, double depth) {
    if (user == 0 || depth < 0)
        return;
    pir_vec3 *v = &game.velocity[user - 1];
    game.push[user - 1] = vec_add(game.push[user - 1], vec_times(0.3 * depth, normal));
    *v = vec_times(0.9, vec_less(*v, vec_times(fmin(0, vec_dot(*v, normal)), normal)));
}

/* The next pose of a body. How many bodies there are: 0 where it is gone. */
static size_t moved(uint32_t id, pir_vec3 by, pir_scene_move *ret_move) {
    const bool there = pir_scene_pose(scene, ret_move->body = id, &ret_move->pose) == PIR_OK;
    ret_move->pose.translation = there ? vec_add(ret_move->pose.translation, by) : by;
    return there;
}

static void step(int frame, pir_vec3 input) {
    pir_scene_move move[HULLS + 2];
    pir_impact met;
    size_t moves = 0, count;
    if (frame % 4 == 0)
        game.bullet = add(ball, PIR_BODY_MOVING, vec_add(game.hero.at, (pir_vec3){0.5, 0, 0.3}), 0);
    for (uint32_t i = 0; i < HULLS; i++) {
        game.velocity[i].z -= 9.81 * STEP;
        moves += moved(game.hull[i], vec_add(vec_times(STEP, game.velocity[i]), game.push[i]), &move[moves]);
        game.push[i] = (pir_vec3){0, 0, 0};
    }
    moves += moved(game.bullet, (pir_vec3){200 * STEP, frame % 7 - 3, -0.2}, &move[moves]);
    move[moves++] = (pir_scene_move){game.hero.body, character_shape(&game.hero).pose};
    must(pir_scene_update(scene, move, moves));
    const pir_scene_event *event = pir_scene_events(scene, &count);
    for (size_t i = 0; i < count; i++) {
        game.sensed += event[i].sensor && event[i].kind == PIR_EVENT_BEGAN;
        const double depth = event[i].kind == PIR_EVENT_ENDED || event[i].sensor ? -1 : -event[i].distance;
        push(event[i].user_p, event[i].normal, depth);
        push(event[i].user_q, vec_times(-1, event[i].normal), depth);
    }
    const pir_scene_impact *impact = pir_scene_impacts(scene, &count);
    if (count > 0 && impact->impact.user > 0) { // a hull is shot
        game.hits++;
        game.velocity[impact->impact.user - 1].x += 2;
    }
    if (count > 0 || frame % 4 == 3)
        (void)pir_scene_remove(scene, game.bullet); // it may be gone by then
    character_move(&game.hero, scene, input, STEP);
    must(game.hero.status);
    pir_scene_ray_options look = pir_scene_ray_options_default();
    look.except = game.hero.body;
    for (int i = -8; i < 8; i++) {
        must(pir_scene_ray_first(scene, game.hero.at, (pir_vec3){20, 2 * i, -1}, &look, &met));
        game.seen += met.body != PIR_SCENE_NONE && met.user > 0;
    }
}

int main(int count, char **arguments) {
    struct crew crew = {.threads = count > 1 ? (uint32_t)atoi(arguments[1]) : 1};
    const pir_scene_options options = crew_options(&crew, (size_t)64 << 20);
    uint64_t hash = 14695981039346656037u;
    must(pir_scene_create(&options, &scene));
    build();
    for (int frame = 0; frame < 240; frame++) {
        const size_t size = pir_scene_serialised_size(scene);
        const struct game before = game;
        unsigned char *state = malloc(size);
        must(state ? pir_scene_serialise(scene, state, size) : PIR_ERR_MEMORY);
        hash = hash_of(state, size, hash);
        if (count < 3) { // a guess, taken back
            step(frame, (pir_vec3){3, -2, 0});
            must(pir_scene_restore(scene, state, size, NULL));
            game = before;
        }
        step(frame, (pir_vec3){3, frame % 60 < 30 ? 0.5 : -0.5, 0});
        free(state);
    }
    printf("hash %016" PRIx64 ", %u hits, %u seen, %u sensed, hero at %.17g %.17g %.17g\n", hash, game.hits, game.seen,
           game.sensed, game.hero.at.x, game.hero.at.y, game.hero.at.z);
    pir_scene_destroy(scene);
    pir_body_shape_release(ball);
    pir_polytope_release(game.hero.spine);
    return crew_memory_left == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
