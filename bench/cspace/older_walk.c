/* SPDX-License-Identifier: MIT */
/* Compiled with the headers of the library that it loads. */
#define _GNU_SOURCE
#include "older_walk.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/io.h>
#include <pirouette/shape.h>
#include <pirouette/sum.h>

struct older_walk {
    pir_sum *sum;
    __typeof__(&pir_sum_reset) reset;
    __typeof__(&pir_sum_destroy) destroy;
};

/* A function of the library, by name. */
static void find(const char *name, void *ret_function) {
    static void *library;
    if (!library)
        library = dlmopen(LM_ID_NEWLM, PIR_OLDER_LIBRARY, RTLD_NOW);
    void *function = library ? dlsym(library, name) : NULL;
    if (!function) {
        fprintf(stderr, "bench_slices: %s\n", dlerror());
        exit(2);
    }
    memcpy(ret_function, &function, sizeof function);
}

static pir_polytope *body_of(const char *name) {
    __typeof__(&pir_shape_create) shape;
    __typeof__(&pir_polytope_read) read;
    pir_polytope *polytope = NULL;
    find("pir_shape_create", &shape);
    find("pir_polytope_read", &read);
    pir_status status =
        strncmp(name, "shape:", 6) == 0 ? shape(name + 6, NULL, NULL, &polytope) : read(name, NULL, NULL, &polytope);
    if (status != PIR_OK) {
        fprintf(stderr, "bench_slices: %s: the older library cannot make it\n", name);
        exit(2);
    }
    return polytope;
}

struct older_walk *older_walk_new(const char *p, const char *q, const double rotation[4]) {
    struct older_walk *walk = malloc(sizeof *walk);
    __typeof__(&pir_sum_create) create;
    __typeof__(&pir_polytope_release) release;
    find("pir_sum_create", &create);
    find("pir_polytope_release", &release);
    if (!walk)
        exit(2);
    find("pir_sum_reset", &walk->reset);
    find("pir_sum_destroy", &walk->destroy);
    pir_polytope *body[2] = {body_of(p), body_of(q)};
    const pir_sum_options options = {.size = sizeof options, .allocator = NULL, .difference = true};
    const pir_quat r = {rotation[0], rotation[1], rotation[2], rotation[3]};
    if (create(body[0], body[1], r, &options, &walk->sum) != PIR_OK) {
        fprintf(stderr, "bench_slices: the older library makes no sum\n");
        exit(2);
    }
    release(body[0]);
    release(body[1]);
    return walk;
}

void older_walk_free(struct older_walk *walk) {
    if (walk)
        walk->destroy(walk->sum);
    free(walk);
}

void older_walk_rebuild(struct older_walk *walk, const double rotation[4]) {
    const pir_quat r = {rotation[0], rotation[1], rotation[2], rotation[3]};
    if (walk->reset(walk->sum, r) != PIR_OK)
        exit(2);
}
