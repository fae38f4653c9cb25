/* SPDX-License-Identifier: MIT */
/*
 * Distances over a scene by the accuracy that is asked for: bodies in a room, at most so full, of which some ask how
 * far all others are. Each line: vertices of a body, the accuracy as a part of the distance, nanoseconds for a distance
 * (median over those who ask), the share that boxes, coarse bodies and the bodies settled, and the greatest half width
 * of the bounds and error of their middle, as parts of the distance.
 *
 *     bench_distances FOLDER
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <pirouette/scene_query.h>

#include "results.h"
#include "trial.h"

#define BODIES 400
#define FORMS  6
#define ASKED  40
#define EDGE   40.0 /* of the room; a body has radius 1 */

static const double parts[] = {0, 1e-4, 1e-3, 0.01, 0.05, 0.2};
#define PARTS (sizeof parts / sizeof *parts)

struct room {
    pir_scene *scene;
    pir_polytope *form[FORMS];
    pir_coarse *coarse[FORMS];
    pir_scene_shape shape[BODIES];
};

struct figures {
    double ns[ASKED];
    uint64_t settled[3], count;
    double width, error;
};

/* Uniform in [−1, 1], the same everywhere. */
static double part(uint64_t *state) {
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(int64_t)*state * 0x1p-63;
}

static pir_polytope *make_form(uint64_t *state, uint32_t vertices) {
    pir_vec3 *point = calloc(vertices, sizeof *point);
    pir_polytope *made = NULL;
    if (!point)
        trial_need(PIR_ERR_MEMORY, "a body");
    for (uint32_t i = 0; i < vertices; i++) {
        double length;
        do {
            point[i] = (pir_vec3){part(state), part(state), part(state)};
            length = sqrt(point[i].x * point[i].x + point[i].y * point[i].y + point[i].z * point[i].z);
        } while (length > 1 || length < 0.1);
        point[i] = (pir_vec3){point[i].x / length, 0.8 * point[i].y / length, 0.6 * point[i].z / length};
    }
    trial_need(pir_polytope_create(point, vertices, NULL, &made), "a body");
    free(point);
    return made;
}

static void open_room(struct room *room, uint32_t vertices) {
    uint64_t state = vertices;
    trial_need(pir_scene_create(NULL, &room->scene), "a scene");
    for (int i = 0; i < FORMS; i++) {
        room->form[i] = make_form(&state, vertices);
        trial_need(pir_coarse_create(room->form[i], &room->coarse[i]), "coarse bodies");
    }
    for (uint32_t i = 0; i < BODIES; i++) {
        pir_body_options body = pir_body_options_default();
        uint32_t id;
        body.pieces = &room->form[i % FORMS];
        body.coarse = &room->coarse[i % FORMS];
        body.piece_count = 1;
        body.pose.rotation = (pir_quat){part(&state), part(&state), part(&state), part(&state)};
        body.pose.translation = (pir_vec3){EDGE / 2 * part(&state), EDGE / 2 * part(&state), EDGE / 2 * part(&state)};
        trial_need(pir_scene_add(room->scene, &body, &id), "a scene");
        room->shape[i] = pir_scene_shape_default(room->form[i % FORMS]);
        room->shape[i].coarse = room->coarse[i % FORMS];
        room->shape[i].pose = body.pose;
        room->shape[i].except = id;
    }
}

static void close_room(struct room *room) {
    pir_scene_destroy(room->scene);
    for (int i = 0; i < FORMS; i++) {
        pir_coarse_release(room->coarse[i]);
        pir_polytope_release(room->form[i]);
    }
}

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return (double)time.tv_sec * 1e9 + (double)time.tv_nsec;
}

static void ask(const struct room *room, uint32_t body, double accuracy, pir_scene_distance *ret_distances) {
    size_t count;
    const pir_accuracy wanted = {0, accuracy};
    trial_need(pir_scene_distances(room->scene, &room->shape[body], HUGE_VAL, wanted, BODIES, ret_distances, &count),
               "distances");
}

/* Holds the bounds to the exact distances. */
static void judge(struct figures *figures, const pir_scene_distance *rough, const pir_scene_distance *exact) {
    for (int i = 0; i < BODIES - 1; i++) {
        figures->count++;
        figures->settled[rough[i].settled]++;
        double right = (exact[i].least + exact[i].most) / 2, middle = (rough[i].least + rough[i].most) / 2;
        if (right == 0)
            continue;
        figures->width = fmax(figures->width, (rough[i].most - rough[i].least) / 2 / right);
        figures->error = fmax(figures->error, fabs(middle - right) / right);
    }
}

static void run(const struct room *room, struct figures *figures) {
    static pir_scene_distance exact[BODIES], rough[BODIES];
    for (uint32_t k = 0; k < ASKED; k++) {
        uint32_t body = k * (BODIES / ASKED);
        ask(room, body, 0, exact);
        for (size_t a = 0; a < PARTS; a++) {
            double best = HUGE_VAL;
            for (int again = 0; again < 3; again++) {
                double begin = now();
                ask(room, body, parts[a], rough);
                best = fmin(best, now() - begin);
            }
            figures[a].ns[k] = best / (BODIES - 1);
            judge(&figures[a], rough, exact);
        }
    }
}

static void report(FILE *file, uint32_t vertices, double accuracy, struct figures *f) {
    static const char line[] = "%u,%g,%.0f,%.3f,%.3f,%.3f,%.2g,%.2g\n";
    double ns = trial_median(f->ns, ASKED), count = (double)f->count, share[3];
    for (int i = 0; i < 3; i++)
        share[i] = (double)f->settled[i] / count;
    printf(line, vertices, accuracy, ns, share[0], share[1], share[2], f->width, f->error);
    fprintf(file, line, vertices, accuracy, ns, share[0], share[1], share[2], f->width, f->error);
}

int main(int argc, char **argv) {
    static const uint32_t vertices[] = {20, 100, 1000, 10000};
    if (argc != 2) {
        fprintf(stderr, "usage: bench_distances FOLDER\n");
        return 2;
    }
    const struct results results = results_new(argv[1]);
    FILE *file = results_open(&results, "distances.csv");
    fprintf(file, "vertices,accuracy,ns,by_boxes,by_coarse,exactly,half_width,error\n");
    for (uint32_t i = 0; i < results_count(4); i++) {
        static struct room room;
        static struct figures figures[PARTS];
        open_room(&room, vertices[i]);
        for (size_t a = 0; a < PARTS; a++)
            figures[a] = (struct figures){.count = 0};
        run(&room, figures);
        for (size_t a = 0; a < PARTS; a++)
            report(file, vertices[i], parts[a], &figures[a]);
        close_room(&room);
    }
    results_close(file, "distances.csv");
    return 0;
}
