/* SPDX-License-Identifier: MIT */
/*
 * Cutting ears (O'Rourke, Computational Geometry in C, 1998, section 1.4), in the plane that drops one coordinate, so
 * that the numbers stay as they are and every turn is exact. Straight corners are ears of no area: cutting them off
 * keeps the edges of the polygon those of the triangles.
 */
#include "mesh/polygon_cut.h"

#include <string.h>

#include "mesh/signs/mesh_signs.h"

/* The axes of a plane in which the polygon is counter-clockwise, by Newell's normal. */
struct plane_axes {
    int first, second;
};

static double at(const pir_vec3 *v, int axis) {
    return axis == 0 ? v->x : axis == 1 ? v->y : v->z;
}

static struct plane_axes plane_of(const pir_vec3 *point, const uint32_t *corner, uint32_t count) {
    double normal[3] = {0, 0, 0};
    pir_vec3 origin = point[corner[0]];
    for (uint32_t i = 1; i + 1 < count; i++) {
        pir_vec3 n = pir_vec_cross(pir_vec_sub(point[corner[i]], origin), pir_vec_sub(point[corner[i + 1]], origin));
        for (int k = 0; k < 3; k++)
            normal[k] += at(&n, k);
    }
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(normal[k]) > fabs(normal[axis]))
            axis = k;
    struct plane_axes plane = {(axis + 1) % 3, (axis + 2) % 3};
    return normal[axis] < 0 ? (struct plane_axes){plane.second, plane.first} : plane;
}

static int turn(const struct plane_axes *plane, const pir_vec3 *a, const pir_vec3 *b, const pir_vec3 *c) {
    const double fa[2] = {at(a, plane->first), at(a, plane->second)};
    const double fb[2] = {at(b, plane->first), at(b, plane->second)};
    const double fc[2] = {at(c, plane->first), at(c, plane->second)};
    return pir_sign_turn(fa, fb, fc);
}

/* Whether it turns left all along, and goes round once: its first coordinate rises once and falls once. */
static bool is_convex(const struct plane_axes *plane, const pir_vec3 *point, const uint32_t *corner, uint32_t count) {
    uint32_t changes = 0;
    int direction = 0, first = 0;
    for (uint32_t i = 0; i < count; i++) {
        const pir_vec3 *a = &point[corner[i]], *b = &point[corner[(i + 1) % count]];
        if (turn(plane, a, b, &point[corner[(i + 2) % count]]) < 0)
            return false;
        double x = at(a, plane->first), y = at(b, plane->first);
        int now = (y > x) - (y < x);
        if (now == 0)
            continue;
        changes += direction != 0 && now != direction;
        first = first != 0 ? first : now;
        direction = now;
    }
    return changes + (direction != first) <= 2;
}

static void cut_fan(const uint32_t *corner, uint32_t count, uint32_t (*ret_triangles)[3]) {
    for (uint32_t i = 0; i + 2 < count; i++) {
        ret_triangles[i][0] = corner[0];
        ret_triangles[i][1] = corner[i + 1];
        ret_triangles[i][2] = corner[i + 2];
    }
}

/* --- ears --- */

static int turn_at(const pir_cut_room *room, uint32_t a, uint32_t b, uint32_t c) {
    return pir_sign_turn(room->flat[a], room->flat[b], room->flat[c]);
}

static bool is_at(const pir_cut_room *room, uint32_t a, uint32_t b) {
    return room->flat[a][0] == room->flat[b][0] && room->flat[a][1] == room->flat[b][1];
}

/* Whether no other corner is in the triangle at corner `i`. Corners at the place of one of the triangle's do not count:
 * a slit has them. */
static bool is_ear(const pir_cut_room *room, uint32_t i) {
    uint32_t a = room->before[i], c = room->after[i];
    int bend = turn_at(room, a, i, c);
    if (bend <= 0)
        return bend == 0;
    for (uint32_t j = room->after[c]; j != a; j = room->after[j])
        if (!is_at(room, j, a) && !is_at(room, j, i) && !is_at(room, j, c) && turn_at(room, a, i, j) >= 0 &&
            turn_at(room, i, c, j) >= 0 && turn_at(room, c, a, j) >= 0)
            return false;
    return true;
}

/* The next ear from corner `i` on, of `rest` corners; UINT32_MAX where there is none. */
static uint32_t next_ear(const pir_cut_room *room, uint32_t i, uint32_t rest) {
    for (uint32_t looked = 0; looked < rest; looked++, i = room->after[i])
        if (room->is_ear[i])
            return i;
    return UINT32_MAX;
}

static void look_again(const pir_cut_room *room, uint32_t i, uint32_t rest) {
    for (uint32_t looked = 0; looked < rest; looked++, i = room->after[i])
        room->is_ear[i] = is_ear(room, i);
}

/* How often all corners may be looked at again where no ear is left: a polygon that needs more crosses itself. */
#define MOST_LOOKS 16

static pir_status cut_ears(const uint32_t *corner, uint32_t count, const pir_cut_room *room,
                           uint32_t (*ret_triangles)[3]) {
    for (uint32_t i = 0; i < count; i++) {
        room->before[i] = (i + count - 1) % count;
        room->after[i] = (i + 1) % count;
    }
    look_again(room, 0, count);
    uint32_t from = 0, looks = 0;
    for (uint32_t rest = count; rest > 3;) {
        uint32_t i = next_ear(room, from, rest);
        if (i == UINT32_MAX) {
            if (++looks > MOST_LOOKS)
                return PIR_ERR_FORMAT;
            look_again(room, from, rest);
            if (next_ear(room, from, rest) == UINT32_MAX)
                return PIR_ERR_FORMAT;
            continue;
        }
        uint32_t a = room->before[i], c = room->after[i];
        uint32_t *t = ret_triangles[count - rest--];
        t[0] = corner[a];
        t[1] = corner[i];
        t[2] = corner[c];
        room->after[a] = c;
        room->before[c] = a;
        room->is_ear[a] = is_ear(room, a);
        room->is_ear[c] = is_ear(room, c);
        from = c;
    }
    uint32_t a = room->before[from], c = room->after[from];
    ret_triangles[count - 3][0] = corner[a];
    ret_triangles[count - 3][1] = corner[from];
    ret_triangles[count - 3][2] = corner[c];
    return turn_at(room, a, from, c) >= 0 ? PIR_OK : PIR_ERR_FORMAT;
}

pir_status pir_polygon_cut(const pir_vec3 *point, const uint32_t *corner, uint32_t count, const pir_cut_room *room,
                           uint32_t (*ret_triangles)[3]) {
    struct plane_axes plane = plane_of(point, corner, count);
    if (count == 3 || is_convex(&plane, point, corner, count)) {
        cut_fan(corner, count, ret_triangles);
        return PIR_OK;
    }
    if (count > PIR_CUT_MOST)
        return PIR_ERR_LIMIT;
    for (uint32_t i = 0; i < count; i++) {
        room->flat[i][0] = at(&point[corner[i]], plane.first);
        room->flat[i][1] = at(&point[corner[i]], plane.second);
    }
    return cut_ears(corner, count, room, ret_triangles);
}
