/* SPDX-License-Identifier: MIT */
#include "slices_scene.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "results.h"
#include "trial.h"

double slices_cpu(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e9 + (double)now.tv_nsec;
}

static pir_polytope *body_of(const char *name) {
    if (strncmp(name, "shape:", 6) == 0)
        return trial_model(name + 6);
    pir_polytope *polytope = NULL;
    pir_report report = {0};
    if (pir_polytope_read(name, NULL, &report, NULL, &polytope) != PIR_OK) {
        fprintf(stderr, "bench_slices: %s\n", report.text);
        exit(2);
    }
    return polytope;
}

static int compare_names(const void *a, const void *b) {
    return strcmp(a, b);
}

/* The models of a folder, by name. */
static void read_folder(const char *folder, struct slices_bodies *bodies) {
    DIR *entries = opendir(folder);
    for (struct dirent *entry; entries && (entry = readdir(entries)) && bodies->pieces < SLICES_PIECES_MOST;)
        if (entry->d_name[0] != '.')
            snprintf(bodies->name[bodies->pieces++], sizeof *bodies->name, "%s/%s", folder, entry->d_name);
    if (entries)
        closedir(entries);
    qsort(bodies->name, bodies->pieces, sizeof *bodies->name, compare_names);
}

/* The first rotations of a grid, as a grid of their own. */
static pir_grid *first_of(pir_grid *grid, uint64_t count) {
    pir_quat *rotation = malloc((size_t)count * sizeof *rotation);
    if (!rotation)
        exit(2);
    for (uint64_t i = 0; i < count; i++)
        rotation[i] = pir_grid_rotation(grid, i);
    pir_grid *first = NULL;
    trial_need(pir_grid_list(rotation, (size_t)count, 1, NULL, &first), "grid");
    pir_grid_destroy(grid);
    free(rotation);
    return first;
}

void slices_make(const struct slices_scene *scene, struct slices_bodies *ret_bodies) {
    *ret_bodies = (struct slices_bodies){.q_name = scene->q};
    struct stat is;
    if (stat(scene->p, &is) == 0 && S_ISDIR(is.st_mode))
        read_folder(scene->p, ret_bodies);
    else
        snprintf(ret_bodies->name[ret_bodies->pieces++], sizeof *ret_bodies->name, "%s", scene->p);
    if (!ret_bodies->q_name)
        ret_bodies->q_name = ret_bodies->name[0];
    for (uint32_t i = 0; i < ret_bodies->pieces; i++)
        ret_bodies->p[i] = body_of(ret_bodies->name[i]);
    ret_bodies->q = body_of(ret_bodies->q_name);
    if (scene->steps)
        trial_need(pir_grid_axis((pir_vec3){0.48, 0.6, 0.64}, scene->steps, NULL, &ret_bodies->grid), "grid");
    else
        trial_need(pir_grid_hopf(scene->level, NULL, &ret_bodies->grid), "grid");
    uint64_t all = pir_grid_get_info(ret_bodies->grid).count, count = all / scene->share;
    if (results_count(1000) < 1000 && count > SLICES_UNIT)
        count = SLICES_UNIT;
    ret_bodies->slices = count;
    if (count < all)
        ret_bodies->grid = first_of(ret_bodies->grid, count);
    ret_bodies->turn = pir_grid_get_turns(ret_bodies->grid).mean * 57.29577951308232;
}

void slices_free(struct slices_bodies *bodies) {
    pir_grid_destroy(bodies->grid);
    for (uint32_t i = 0; i < bodies->pieces; i++)
        pir_polytope_release(bodies->p[i]);
    pir_polytope_release(bodies->q);
}
