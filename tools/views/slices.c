/* SPDX-License-Identifier: MIT */
#include "slices.h"

#include <math.h>

#include "../message.h"

bool slices_open(struct slices *slices, const char *path, uint64_t every, uint64_t most) {
    pir_report report = {0};
    *slices = (struct slices){.path = path};
    pir_status status = pir_cspace_open(path, NULL, &report, &slices->file);
    if (status != PIR_OK) {
        complain_status(path, status, &report);
        return false;
    }
    slices->info = pir_cspace_get_info(slices->file);
    uint64_t total = slices->info.grid.count;
    slices->every = every ? every : (total + most - 1) / most;
    slices->count = (total + slices->every - 1) / slices->every;
    slices->pairs = slices->info.robot_count * slices->info.obstacle_count;
    return true;
}

void slices_close(struct slices *slices) {
    pir_cspace_destroy(slices->file);
    slices->file = NULL;
}

uint64_t slices_number(const struct slices *slices, uint64_t shown) {
    return slices->first + shown * slices->every;
}

pir_quat slices_rotation(const struct slices *slices, uint64_t shown) {
    return pir_grid_rotation(pir_cspace_grid(slices->file), slices_number(slices, shown));
}

pir_mesh *slices_mesh(const struct slices *slices, uint64_t shown, uint32_t pair, pir_precision precision) {
    pir_report report = {0};
    pir_mesh *mesh = NULL;
    const pir_cspace_place place = {.robot = pair / slices->info.obstacle_count,
                                    .obstacle = pair % slices->info.obstacle_count,
                                    .slice = slices_number(slices, shown)};
    pir_status status = pir_cspace_mesh(slices->file, place, precision, &report, &mesh);
    if (status != PIR_OK)
        complain_status(slices->path, status, &report);
    return mesh;
}

void slices_ball(const struct slices *slices, pir_vec3 *ret_middle, double *ret_radius) {
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, reach = 0;
    for (uint32_t k = 0; k < slices->info.robot_count; k++) {
        const pir_polytope *body = pir_cspace_robot(slices->file, k);
        for (uint32_t v = 0; v < pir_polytope_vertex_count(body); v++) {
            pir_vec3 x = pir_polytope_vertex(body, v);
            reach = fmax(reach, hypot(hypot(x.x, x.y), x.z));
        }
    }
    for (uint32_t l = 0; l < slices->info.obstacle_count; l++) {
        const pir_polytope *body = pir_cspace_obstacle(slices->file, l);
        for (uint32_t v = 0; v < pir_polytope_vertex_count(body); v++) {
            pir_vec3 x = pir_polytope_vertex(body, v);
            const double c[3] = {x.x, x.y, x.z};
            for (int k = 0; k < 3; k++) {
                low[k] = fmin(low[k], c[k]);
                high[k] = fmax(high[k], c[k]);
            }
        }
    }
    double half[3];
    for (int k = 0; k < 3; k++)
        half[k] = high[k] / 2 - low[k] / 2;
    *ret_middle = (pir_vec3){low[0] + half[0], low[1] + half[1], low[2] + half[2]};
    double radius = reach + hypot(hypot(half[0], half[1]), half[2]);
    *ret_radius = radius > 0 ? radius : 1;
}
