/* SPDX-License-Identifier: MIT */
/* Writes small critical maps, to start fuzzing their reader from. Usage: write_turns FOLDER */
#include <stdio.h>

#include <pirouette/pirouette.h>

#include "fuzz/input.h"

int main(int argc, char **argv) {
    static const struct {
        const char *p, *q;
        pir_quat start;
        pir_vec3 axis;
    } turns[] = {{"cube", "cube", {0, 0, 0, 1}, {0, 0, 1}},
                 {"tetrahedron", "octahedron", {1, 2, 3, 4}, {0.1, -2, 1}},
                 {"octahedron", "tetrahedron", {0, 0, 1, 1}, {1, 1, 1}},
                 {"prism?sides=3", "cube", {0.5, 0, 0, 1}, {0x1p-30, 0, 3}}};
    if (argc != 2) {
        fprintf(stderr, "usage: write_turns FOLDER\n");
        return 2;
    }
    for (unsigned i = 0; i < sizeof turns / sizeof *turns; i++) {
        char path[4096];
        pir_polytope *p = NULL, *q = NULL;
        pir_critical_map *map = NULL;
        fuzz_require(pir_shape_create(turns[i].p, NULL, NULL, &p) == PIR_OK, "a shape is made");
        fuzz_require(pir_shape_create(turns[i].q, NULL, NULL, &q) == PIR_OK, "a shape is made");
        fuzz_require(pir_critical_map_create(p, q, turns[i].start, turns[i].axis, NULL, &map) == PIR_OK, "a map");
        snprintf(path, sizeof path, "%s/map_%u.turn", argv[1], i);
        FILE *file = fopen(path, "wb");
        fuzz_require(file != NULL, path);
        fuzz_require(pir_critical_map_write(map, file, NULL) == PIR_OK, "it is written");
        fuzz_require(fclose(file) == 0, path);
        pir_critical_map_destroy(map);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    return 0;
}
