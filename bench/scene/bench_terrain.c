/* SPDX-License-Identifier: MIT */
/*
 * Hulls on a height field of 64 × 64 cells: 300 of them, asleep and awake, rays from above, and casts of a capsule; a
 * peer, where there is one, is asked the same in turn. Each line: who, a measure, its median, the 99th percentile, the
 * unit. Times are those of the thread; a query's is the mean of a batch, since the clock takes as long as a ray. How
 * long the peer's collision takes is what it tells of itself. scene_terrain_reuse.csv has updates with manifolds, told
 * again and not.
 *
 *     bench_terrain FOLDER
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <pirouette/scene_query.h>

#include "results.h"
#include "terrain_peer.h"
#include "trial.h"

#define SIDE   65
#define BODIES 300
#define FORMS  8
#define POINTS 20

#define REUSE 5e-3 /* bodies awake move by no more than that about their places */

#define HALF      0.5 /* of the capsule, without its radius */
#define RADIUS    0.3
#define TOLERANCE 1e-3
#define BATCH     32
#define MOST      1000 /* times of a measure */

struct terrain {
    pir_scene *scene;
    pir_height_field *field;
    pir_polytope *form[FORMS], *spine, *hull[BODIES];
    struct terrain_peer *peer; /* or NULL */
    pir_scene_move rest[BODIES], move[BODIES];
    uint64_t state;
};

/* Nanoseconds of this library, of the peer, and of the peer's collision alone. */
static double times[3][MOST];
static float heights[SIDE * SIDE];

/* Uniform in [−1, 1], the same everywhere. */
static double part(uint64_t *state) {
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(int64_t)*state * 0x1p-63;
}

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return (double)time.tv_sec * 1e9 + (double)time.tv_nsec;
}

static int compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void report(FILE *file, int who, const char *measure, size_t count, double unit, const char *name) {
#ifdef PIR_HAVE_TERRAIN_PEER
    const char *of = who == 0 ? "pirouette" : terrain_peer_name();
#else
    const char *of = "pirouette";
#endif
    double *of_all = times[who];
    qsort(of_all, count, sizeof *of_all, compare);
    const double median = of_all[count / 2] / unit, late = of_all[count - 1 - count / 100] / unit;
    printf("%s,%s,%.4g,%.4g,%s\n", of, measure, median, late, name);
    fprintf(file, "%s,%s,%.4g,%.4g,%s\n", of, measure, median, late, name);
}

static void make_ground(struct terrain *terrain) {
    for (int i = 0; i < SIDE * SIDE; i++)
        heights[i] = (float)(sin(0.4 * (i % SIDE)) * cos(0.3 * (i / SIDE)));
    const pir_height_samples samples = {
        .heights = heights, .type = PIR_NUMBERS_FLOAT, .columns = SIDE, .rows = SIDE, .step_x = 1, .step_y = 1};
    trial_need(pir_height_field_create(&samples, NULL, NULL, &terrain->field), "a height field");
    pir_body_options body = pir_body_options_default();
    uint32_t number;
    body.kind = PIR_BODY_STATIC;
    body.field = terrain->field;
    trial_need(pir_scene_add(terrain->scene, &body, &number), "the ground");
}

static void make_forms(struct terrain *terrain) {
    const pir_vec3 spine[2] = {{0, 0, -HALF}, {0, 0, HALF}};
    for (int i = 0; i < FORMS; i++) {
        pir_vec3 point[POINTS];
        for (int k = 0; k < POINTS; k++) {
            double length;
            do {
                point[k] = (pir_vec3){part(&terrain->state), part(&terrain->state), part(&terrain->state)};
                length = sqrt(point[k].x * point[k].x + point[k].y * point[k].y + point[k].z * point[k].z);
            } while (length > 1 || length < 0.1);
            point[k] = (pir_vec3){0.5 * point[k].x / length, 0.5 * point[k].y / length, 0.4 * point[k].z / length};
        }
        trial_need(pir_polytope_create(point, POINTS, NULL, &terrain->form[i]), "a hull");
    }
    trial_need(pir_polytope_create(spine, 2, NULL, &terrain->spine), "a capsule");
}

/* Each hull where it comes down on the ground, a millimetre above it. */
static void put_down(struct terrain *terrain) {
    for (uint32_t i = 0; i < BODIES; i++) {
        pir_body_options body = pir_body_options_default();
        const pir_motion down = {.way = {0, 0, -6}};
        pir_impact impact;
        terrain->hull[i] = terrain->form[i % FORMS];
        body.pieces = &terrain->hull[i];
        body.piece_count = 1;
        body.pose.rotation = (pir_quat){part(&terrain->state), part(&terrain->state), part(&terrain->state), 1};
        body.pose.translation = (pir_vec3){4.3 + 3 * (i % 19), 4.7 + 3.5 * (i / 19), 4};
        pir_scene_shape shape = pir_scene_shape_default(body.pieces[0]);
        shape.pose = body.pose;
        trial_need(pir_scene_cast(terrain->scene, &shape, &down, TOLERANCE, &impact), "a cast");
        body.pose.translation.z -= 6 * impact.time;
        trial_need(pir_scene_add(terrain->scene, &body, &terrain->rest[i].body), "a hull");
        terrain->rest[i].pose = body.pose;
    }
    trial_need(pir_scene_update(terrain->scene, NULL, 0), "an update");
#ifdef PIR_HAVE_TERRAIN_PEER
    const struct terrain_ground ground = {heights, SIDE, -1, 1};
    terrain->peer = terrain_peer_make(&ground, terrain->hull, terrain->rest, BODIES);
#endif
}

static void time_updates(struct terrain *terrain, FILE *file, const char *measure, size_t moved) {
    const size_t frames = results_count(400), warm = frames / 4;
    for (size_t f = 0; f < warm + frames; f++) {
        for (size_t i = 0; i < moved; i++) {
            pir_scene_move *move = &terrain->move[i];
            *move = terrain->rest[i];
            move->pose.translation.x += 1e-3 * part(&terrain->state);
            move->pose.translation.z += 5e-4 * part(&terrain->state);
            move->pose.rotation.z += 1e-3 * part(&terrain->state);
        }
        const double begin = now();
        trial_need(pir_scene_update(terrain->scene, terrain->move, moved), "an update");
        const double between = now();
#ifdef PIR_HAVE_TERRAIN_PEER
        double collision;
        terrain_peer_update(terrain->peer, terrain->move, moved, &collision);
        times[2][f < warm ? 0 : f - warm] = collision;
#endif
        times[0][f < warm ? 0 : f - warm] = between - begin;
        times[1][f < warm ? 0 : f - warm] = now() - between;
    }
    report(file, 0, measure, frames, 1e3, "us");
    if (terrain->peer) {
        report(file, 1, moved > 0 ? "poses and step awake" : "step asleep", frames, 1e3, "us");
        report(file, 2, moved > 0 ? "collision awake" : "collision asleep", frames, 1e3, "us");
    }
}

/* One question of a batch. */
struct question {
    pir_vec3 from, way;
    double time, peer_time;
};

static void ask(struct terrain *terrain, bool is_ray, struct question *question) {
    const pir_motion motion = {.way = question->way};
    pir_scene_shape capsule = pir_scene_shape_default(terrain->spine);
    pir_impact impact;
    capsule.pose.translation = question->from;
    capsule.radius = RADIUS;
    trial_need(is_ray ? pir_scene_ray(terrain->scene, question->from, question->way, UINT32_MAX, &impact)
                      : pir_scene_cast(terrain->scene, &capsule, &motion, TOLERANCE, &impact),
               "a query");
    question->time = impact.time;
}

static void ask_peer(struct terrain *terrain, bool is_ray, struct question *question) {
#ifdef PIR_HAVE_TERRAIN_PEER
    question->peer_time = is_ray ? terrain_peer_ray(terrain->peer, question->from, question->way)
                                 : terrain_peer_capsule(terrain->peer, HALF, RADIUS, question->from, question->way);
#else
    (void)terrain, (void)is_ray;
    question->peer_time = question->time;
#endif
}

/* Rays from above, or casts of a capsule across the ground; how many the peer answers another way is told. */
static void time_queries(struct terrain *terrain, FILE *file, bool is_ray) {
    const size_t batches = results_count(is_ray ? MOST : MOST / 4);
    struct question question[BATCH];
    size_t other = 0;
    for (size_t b = 0; b < batches; b++) {
        for (size_t i = 0; i < BATCH; i++) {
            const double x = 32 + 28 * part(&terrain->state), y = 32 + 28 * part(&terrain->state);
            question[i].from = (pir_vec3){x, y, 4};
            question[i].way = (pir_vec3){8 * part(&terrain->state), 8 * part(&terrain->state), is_ray ? -8 : -4};
        }
        const double begin = now();
        for (size_t i = 0; i < BATCH; i++)
            ask(terrain, is_ray, &question[i]);
        const double between = now();
        for (size_t i = 0; i < BATCH; i++)
            ask_peer(terrain, is_ray, &question[i]);
        times[1][b] = (now() - between) / BATCH;
        times[0][b] = (between - begin) / BATCH;
        for (size_t i = 0; i < BATCH; i++)
            other += fabs(question[i].time - question[i].peer_time) > 0.01;
    }
    report(file, 0, is_ray ? "ray" : "capsule cast", batches, 1e3, "us");
    if (terrain->peer)
        report(file, 1, is_ray ? "ray" : "capsule cast", batches, 1e3, "us");
    printf("%zu of %zu %s end elsewhere by more than 1 %% of the way\n", other, batches * BATCH,
           is_ray ? "rays" : "casts");
}

/* A scene with the ground, of a detail; manifolds may be as old as bodies move by `reuse`. */
static void open_terrain(struct terrain *terrain, pir_scene_detail detail, double reuse) {
    pir_scene_options options = pir_scene_options_default();
    options.detail = detail;
    options.reuse = reuse;
    options.margin = detail == PIR_SCENE_STATES ? 0 : 0.005;
    *terrain = (struct terrain){.state = 1};
    trial_need(pir_scene_create(&options, &terrain->scene), "a scene");
    make_ground(terrain);
    make_forms(terrain);
}

static void close_terrain(struct terrain *terrain) {
#ifdef PIR_HAVE_TERRAIN_PEER
    if (terrain->peer)
        terrain_peer_free(terrain->peer);
#endif
    pir_scene_destroy(terrain->scene);
    pir_height_field_release(terrain->field);
    for (int i = 0; i < FORMS; i++)
        pir_polytope_release(terrain->form[i]);
    pir_polytope_release(terrain->spine);
}

/* What is timed of a scene. */
struct named_scene {
    pir_scene_detail detail;
    double reuse;
    const char *asleep, *awake, *memory;
};

static const struct named_scene distances = {PIR_SCENE_DEPTHS, 0, "update asleep with distances",
                                             "update awake with distances", "memory of the scene with distances"};
static const struct named_scene manifolds = {PIR_SCENE_MANIFOLDS, 0, "update asleep with manifolds",
                                             "update awake with manifolds", "memory of the scene with manifolds"};
static const struct named_scene reused = {PIR_SCENE_MANIFOLDS, REUSE, "update asleep reusing manifolds",
                                          "update awake reusing manifolds", "memory of the scene reusing manifolds"};

static void time_bodies(FILE *file, const struct named_scene *of) {
    static struct terrain terrain;
    open_terrain(&terrain, of->detail, of->reuse);
    put_down(&terrain);
    time_updates(&terrain, file, of->asleep, 0);
    time_updates(&terrain, file, of->awake, BODIES);
    times[0][0] = (double)pir_scene_get_statistics(terrain.scene).bytes;
    report(file, 0, of->memory, 1, 1e3, "kB");
    close_terrain(&terrain);
}

int main(int argc, char **argv) {
    static struct terrain terrain;
    pir_height_info info;
    if (argc != 2) {
        fprintf(stderr, "usage: bench_terrain FOLDER\n");
        return 2;
    }
    const struct results results = results_new(argv[1]);
    FILE *file = results_open(&results, "scene_terrain.csv");
    fprintf(file, "who,measure,median,p99,unit\n");
    open_terrain(&terrain, PIR_SCENE_DEPTHS, 0);
    pir_height_field_describe(terrain.field, &info);
    times[0][0] = (double)info.bytes;
    report(file, 0, "memory of the field", 1, 1e3, "kB");
    put_down(&terrain);
    time_queries(&terrain, file, true);
    time_queries(&terrain, file, false);
    close_terrain(&terrain);
    time_bodies(file, &distances);
    time_bodies(file, &manifolds);
    results_close(file, "scene_terrain.csv");
    file = results_open(&results, "scene_terrain_reuse.csv");
    fprintf(file, "who,measure,median,p99,unit\n");
    time_bodies(file, &manifolds);
    time_bodies(file, &reused);
    results_close(file, "scene_terrain_reuse.csv");
    return 0;
}
