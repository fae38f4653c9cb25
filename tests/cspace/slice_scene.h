/* SPDX-License-Identifier: MIT */
/* A scene to slice, and files of it in a folder of the test's own. */
#ifndef PIR_TEST_SLICE_SCENE_H
#define PIR_TEST_SLICE_SCENE_H

#include "support/test.h"

#include <pirouette/cspace.h>

#define SLICE_PATH 256

/* A robot of two pieces and three obstacles, of all dimensions. */
struct slice_scene {
    pir_polytope *robot[2], *obstacle[3];
    pir_cspace_bodies bodies;
    pir_grid *grid;
};

void slice_scene_make(struct slice_scene *scene, uint64_t steps);
void slice_scene_finish(struct slice_scene *scene);

/* Makes and removes the folder of the tests; for cmocka. */
int slice_make_folder(void **state);
int slice_remove_folder(void **state);

/* The path of a file in the folder. */
void slice_path(const char *name, char path[SLICE_PATH]);

/* Units of few slices. */
pir_cspace_options slice_short_units(void);

/* Makes the file of the scene. */
void slice_make_file(const struct slice_scene *scene, const char *path, const pir_cspace_options *options);

/* All bytes of a file, to be freed; and a file of these bytes. */
uint8_t *slice_read_whole(const char *path, size_t *ret_size);
void slice_write_whole(const char *path, const uint8_t *bytes, size_t size);

void slice_expect_same_files(const char *a, const char *b);

#endif
