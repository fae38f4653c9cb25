/* SPDX-License-Identifier: MIT */
#include "draw.h"

#include <stdio.h>

static const double scale = 110;

/* The outline of a body seen from above: that of its section halfway up, which its boxes and prisms fill. */
static void put_body(FILE *file, const pir_polytope *body, const spot *at, const char *look) {
    const pir_pose pose = place_pose(at);
    pir_vec3 low, high;
    pir_mesh *mesh = NULL;
    pir_section *section = NULL;
    pir_polytope_bounds(body, &low, &high);
    if (pir_mesh_from_polytope(body, &mesh) == PIR_OK &&
        pir_mesh_section(mesh, (pir_vec3){0, 0, 1}, low.z / 2 + high.z / 2, &section) == PIR_OK) {
        fprintf(file, "<polygon %s points=\"", look);
        for (uint32_t i = 0; i < pir_section_corner_count(section); i++) {
            pir_vec3 corner = pir_pose_apply(pose, pir_section_corners(section)[i]);
            fprintf(file, "%.1f,%.1f ", scale * corner.x, -scale * corner.y);
        }
        fputs("\"/>\n", file);
    }
    pir_section_destroy(section);
    pir_mesh_destroy(mesh);
}

int draw_path(const world *place, const spot *path, int count, int poses, const char *name) {
    static const spot home = {0, 0, 0, 0};
    FILE *file = fopen(name, "w");
    if (!file)
        return 0;
    fprintf(file, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"%g %g %g %g\" width=\"%g\" height=\"%g\">\n",
            -3.4 * scale, -2.4 * scale, 6.8 * scale, 4.8 * scale, 6.8 * scale, 4.8 * scale);
    fprintf(file, "<rect x=\"-400\" y=\"-300\" width=\"800\" height=\"600\" fill=\"white\"/>\n");
    for (int n = 0; n < poses; n++) {
        double at = (double)n / (poses - 1) * (count - 1);
        int leg = (int)at < count - 1 ? (int)at : count - 2;
        const spot here = spot_between(&path[leg], &path[leg + 1], at - leg);
        char look[96];
        snprintf(look, sizeof look, "fill=\"hsl(%d,60%%,55%%)\" fill-opacity=\"0.35\" stroke=\"#24384a\"",
                 210 - 170 * n / poses);
        for (int i = 0; i < ROBOT_PIECES - 1; i++) // the lid lies over the first
            put_body(file, place->robot[i], &here, look);
    }
    for (int i = 0; i < OBSTACLES; i++)
        put_body(file, place->obstacle[i], &home, "fill=\"#24384a\"");
    fputs("</svg>\n", file);
    int done = !ferror(file);
    return fclose(file) == 0 && done;
}
