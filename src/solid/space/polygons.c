/* SPDX-License-Identifier: MIT */
/* See polygons.h. A wall is parallel to the axis that the polygon's normal is nearest to, so that its numbers are
 * short and it meets the plane at an angle of 35 degrees at least. */
#include "solid/space/polygons.h"

#include <math.h>

#include <math.h>
#include <string.h>

#include "solid/space/exact.h"

void pir_polygons_init(pir_polygons *polygons, pir_space *space) {
    *polygons = (pir_polygons){.space = space};
}

void pir_polygons_finish(pir_polygons *polygons) {
    if (!polygons->space)
        return;
    pir_space_shrink(polygons->space, polygons->polygon, polygons->room, sizeof *polygons->polygon);
    pir_space_shrink(polygons->space, polygons->point, polygons->point_room, sizeof *polygons->point);
    pir_space_shrink(polygons->space, polygons->wall, polygons->wall_room, sizeof *polygons->wall);
    pir_space_shrink(polygons->space, polygons->sign, polygons->sign_room, sizeof *polygons->sign);
    pir_space_shrink(polygons->space, polygons->corner, polygons->made_room, sizeof *polygons->corner);
    pir_space_shrink(polygons->space, polygons->direction, polygons->direction_room, sizeof *polygons->direction);
    *polygons = (pir_polygons){0};
}

static uint32_t begin(pir_polygons *polygons, uint32_t half) {
    if (!pir_space_grow(polygons->space, (void **)&polygons->polygon, &polygons->room, polygons->count,
                        sizeof *polygons->polygon))
        return 0;
    polygons->polygon[polygons->count] = (pir_polygon){half, polygons->corner_count, 0};
    return polygons->count++;
}

static void add_corner(pir_polygons *polygons, uint32_t point, uint32_t wall) {
    const uint32_t at = polygons->corner_count;
    if (!pir_space_grow(polygons->space, (void **)&polygons->point, &polygons->point_room, at,
                        sizeof *polygons->point) ||
        !pir_space_grow(polygons->space, (void **)&polygons->wall, &polygons->wall_room, at, sizeof *polygons->wall))
        return;
    polygons->point[at] = point;
    polygons->wall[at] = wall;
    polygons->corner_count++;
    polygons->polygon[polygons->count - 1].count++;
}

uint32_t pir_polygons_direction(pir_space *space, uint32_t a, uint32_t b) {
    const uint32_t i = pir_space_exact_point(space, a), j = pir_space_exact_point(space, b);
    if (space->status != PIR_OK)
        return 0;
    mpz_t *p = space->number + i, *q = space->number + j;
    mpz_t *t = space->t;
    for (int k = 0; k < 3; k++) {
        mpz_mul(t[k], q[k], p[3]);
        mpz_submul(t[k], p[k], q[3]);
    }
    return pir_space_add_direction(space, t[0], t[1], t[2]);
}

uint32_t pir_polygons_add(pir_polygons *polygons, uint32_t half, const uint32_t *point, const uint32_t *direction,
                          const bool *reversed, uint32_t count) {
    pir_space *space = polygons->space;
    const double *n = space->plane[half >> 1].n;
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(n[k]) > fabs(n[axis]))
            axis = k;
    const bool turned = (n[axis] < 0) != (half & 1);
    const uint32_t made = begin(polygons, half);
    for (uint32_t i = 0; i < count && space->status == PIR_OK; i++) {
        const uint32_t wall = pir_space_add_plane(space, (const uint32_t[]){direction[i], space->axis[axis]}, turned,
                                                  (const uint32_t[]){point[i], PIR_SPACE_NONE});
        add_corner(polygons, point[i], pir_half(wall, reversed && reversed[i]));
    }
    return made;
}

uint32_t pir_polygons_copy(pir_polygons *polygons, const pir_polygons *from, uint32_t polygon) {
    const pir_polygon p = from->polygon[polygon];
    const uint32_t made = begin(polygons, p.half);
    for (uint32_t i = 0; i < p.count && polygons->space->status == PIR_OK; i++)
        add_corner(polygons, from->point[p.first + i], from->wall[p.first + i]);
    return made;
}

void pir_polygons_truncate(pir_polygons *polygons, uint32_t count) {
    if (count < polygons->count)
        polygons->corner_count = polygons->polygon[count].first;
    polygons->count = count;
}

unsigned pir_polygons_sides(pir_polygons *polygons, uint32_t polygon, uint32_t half) {
    const pir_polygon p = polygons->polygon[polygon];
    if (!pir_space_grow(polygons->space, (void **)&polygons->sign, &polygons->sign_room, p.count,
                        sizeof *polygons->sign))
        return 0;
    if (p.half >> 1 == half >> 1) {
        memset(polygons->sign, 0, p.count);
        return 0;
    }
    unsigned sides = 0;
    for (uint32_t i = 0; i < p.count; i++) {
        const int sign = pir_space_side(polygons->space, half, polygons->point[p.first + i]);
        polygons->sign[i] = (int8_t)sign;
        sides |= sign < 0 ? 1u : sign > 0 ? 2u : 0u;
    }
    return sides;
}

pir_ball pir_polygons_ball(const pir_polygons *polygons, uint32_t polygon) {
    const pir_polygon p = polygons->polygon[polygon];
    const uint32_t *point = polygons->point + p.first;
    pir_ball ball = {{0}, 0};
    for (uint32_t i = 0; i < p.count; i++)
        for (int k = 0; k < 3; k++)
            ball.x[k] += polygons->space->point[point[i]].x[k] / p.count;
    for (uint32_t i = 0; i < p.count; i++) {
        const pir_space_point *x = &polygons->space->point[point[i]];
        const double to[3] = {x->x[0] - ball.x[0], x->x[1] - ball.x[1], x->x[2] - ball.x[2]};
        const double away = sqrt(to[0] * to[0] + to[1] * to[1] + to[2] * to[2]) + 2 * x->err;
        ball.radius = away > ball.radius ? away : ball.radius;
    }
    return ball;
}

void pir_polygons_cut(pir_polygons *polygons, uint32_t polygon, uint32_t half, uint32_t ret_parts[2]) {
    pir_space *space = polygons->space;
    const pir_polygon from = polygons->polygon[polygon];
    // where the loop passes through the plane: going up, coming down, each once
    uint32_t pass[2] = {0}, point[2] = {0}, passes[2] = {0};
    for (uint32_t i = 0; i < from.count && space->status == PIR_OK; i++) {
        const uint32_t j = i + 1 < from.count ? i + 1 : 0;
        const int a = polygons->sign[i], b = polygons->sign[j];
        if (a * b < 0) {
            const int down = a > 0;
            passes[down]++;
            pass[down] = i;
            point[down] = pir_space_add_meet(space, from.half >> 1, polygons->wall[from.first + i] >> 1, half >> 1);
        } else if (a == 0 && b != 0 && polygons->sign[i > 0 ? i - 1 : from.count - 1] != b) {
            passes[b < 0]++;
            pass[b < 0] = i;
            point[b < 0] = polygons->point[from.first + i];
        }
    }
    if (passes[0] != 1 || passes[1] != 1)
        pir_space_fault(space);
    for (int above = 0; above < 2 && space->status == PIR_OK; above++) {
        const uint32_t enter = pass[!above], leave = pass[above];
        ret_parts[above] = begin(polygons, from.half);
        add_corner(polygons, point[!above], polygons->wall[from.first + enter]);
        uint32_t i = enter;
        do {
            i = i + 1 < from.count ? i + 1 : 0;
            if (polygons->sign[i] == (above ? 1 : -1))
                add_corner(polygons, polygons->point[from.first + i], polygons->wall[from.first + i]);
        } while (i != leave);
        add_corner(polygons, point[above], above ? half ^ 1 : half);
    }
}
