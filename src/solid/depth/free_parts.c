/* SPDX-License-Identifier: MIT */
/* See free_parts.h. All planes of an open set are held against a closed part in turn: what is on or above one is left.
 */
#include "solid/depth/free_parts.h"

#include <math.h>

#include "polytope/polytope.h"

void pir_free_parts_finish(pir_free_parts *parts) {
    const pir_allocator *a = &parts->obstacle->allocator;
    PIR_FREE(a, parts->part, parts->room);
    PIR_FREE(a, parts->corner, parts->corner_room);
    PIR_FREE(a, parts->wall, parts->wall_room);
    PIR_FREE(a, parts->sign, parts->sign_room);
}

/* A new part without corners, behind all others. */
static uint32_t begin(pir_free_parts *parts, uint32_t plane) {
    if (!pir_obstacle_grow(parts->obstacle, (void **)&parts->part, &parts->room, parts->count, sizeof *parts->part))
        return 0;
    parts->part[parts->count] = (pir_free_part){.plane = plane, .first = parts->used};
    return parts->count++;
}

/* Adds a corner or, with none, a wall alone to the last part. */
static void add_corner(pir_free_parts *parts, uint32_t point, uint32_t wall) {
    pir_obstacle *o = parts->obstacle;
    if (!pir_obstacle_grow(o, (void **)&parts->corner, &parts->corner_room, parts->used, sizeof *parts->corner) ||
        !pir_obstacle_grow(o, (void **)&parts->wall, &parts->wall_room, parts->used, sizeof *parts->wall))
        return;
    parts->corner[parts->used] = point;
    parts->wall[parts->used++] = wall;
    parts->part[parts->count - 1].corners += point != PIR_OBSTACLE_NONE;
}

static void add_segment(pir_free_parts *parts, uint32_t plane, const uint32_t corner[2], const uint32_t wall[3]) {
    begin(parts, plane);
    add_corner(parts, corner[0], wall[0]);
    add_corner(parts, corner[1], wall[1]);
    add_corner(parts, PIR_OBSTACLE_NONE, wall[2]);
}

static uint32_t next_of(const pir_free_part *part, uint32_t i) {
    return i + 1 < part->corners ? i + 1 : 0;
}

static uint32_t before(const pir_free_part *part, uint32_t i) {
    return i > 0 ? i - 1 : part->corners - 1;
}

/* --- the nearest point --- */

/* Where the foot on a line is: −1 beyond the first of two walls, 1 beyond the second, 0 between them. */
static int place_on_line(pir_free_parts *parts, uint32_t plane, const uint32_t wall[3], uint32_t *ret_foot) {
    pir_obstacle *o = parts->obstacle;
    *ret_foot = pir_obstacle_add(o, PIR_OBSTACLE_ON_LINE, plane, wall[0] >> 1, PIR_OBSTACLE_NONE);
    if (o->status != PIR_OK)
        return 0;
    if (pir_obstacle_half_side(o, wall[1], *ret_foot) > 0)
        return -1;
    return pir_obstacle_half_side(o, wall[2], *ret_foot) > 0 ? 1 : 0;
}

/* The nearest point of a polygon whose plane has its foot outside: on a side that holds the foot on its line, or a
 * corner that the feet on the lines of both of its sides are beyond. */
static uint32_t nearest_on_sides(pir_free_parts *parts, const pir_free_part *part) {
    int first = 0, last = 0;
    for (uint32_t i = 0; i < part->corners && parts->obstacle->status == PIR_OK; i++) {
        const uint32_t *wall = parts->wall + part->first;
        const uint32_t of[3] = {wall[i], wall[before(part, i)], wall[next_of(part, i)]};
        uint32_t foot;
        const int place = place_on_line(parts, part->plane, of, &foot);
        // the foot on the plane is on the other side of this wall, or this is no nearest point
        if (place == 0 && pir_obstacle_half_side(parts->obstacle, wall[i], part->nearest) > 0)
            return foot;
        if (i > 0 && last > 0 && place < 0)
            return parts->corner[part->first + i];
        first = i == 0 ? place : first;
        last = place;
    }
    if (!(last > 0 && first < 0))
        parts->obstacle->status = parts->obstacle->status == PIR_OK ? PIR_ERR_INTERNAL : parts->obstacle->status;
    return parts->corner[part->first];
}

static uint32_t nearest_of(pir_free_parts *parts, pir_free_part *part) {
    pir_obstacle *o = parts->obstacle;
    const uint32_t *corner = parts->corner + part->first, *wall = parts->wall + part->first;
    if (part->corners == 1)
        return corner[0];
    if (part->corners == 2) {
        uint32_t foot;
        const int place = place_on_line(parts, part->plane, wall, &foot);
        return place < 0 ? corner[0] : place > 0 ? corner[1] : foot;
    }
    part->nearest = pir_obstacle_add(o, PIR_OBSTACLE_ON_PLANE, part->plane, PIR_OBSTACLE_NONE, PIR_OBSTACLE_NONE);
    for (uint32_t i = 0; i < part->corners && o->status == PIR_OK; i++)
        if (pir_obstacle_half_side(o, wall[i], part->nearest) > 0)
            return nearest_on_sides(parts, part);
    return part->nearest;
}

/* Finds the nearest points of the parts from `from` on. */
static uint32_t measure(pir_free_parts *parts, uint32_t from) {
    pir_obstacle *o = parts->obstacle;
    for (uint32_t k = from; k < parts->count && o->status == PIR_OK; k++) {
        pir_free_part *part = &parts->part[k];
        part->nearest = nearest_of(parts, part);
        if (o->status != PIR_OK)
            break;
        const pir_obstacle_point *x = &o->point[part->nearest], *t = &o->point[0];
        double square = 0;
        for (int i = 0; i < 3; i++)
            square += (x->x[i] - t->x[i]) * (x->x[i] - t->x[i]);
        const double away = sqrt(square), room = x->err + t->err + 0x1p-50;
        part->least = away - room;
        part->most = away + room;
    }
    return from;
}

/* --- cutting --- */

/* Which sides of a half-space the corners of a part are on: bit 0 below, bit 1 above. Leaves them in `sign`. */
static unsigned sides_of(pir_free_parts *parts, uint32_t part, uint32_t half) {
    const pir_free_part p = parts->part[part];
    unsigned sides = 0;
    for (uint32_t i = 0; i < p.corners; i++) {
        if (!pir_obstacle_grow(parts->obstacle, (void **)&parts->sign, &parts->sign_room, i, sizeof *parts->sign))
            return 0;
        const int side = pir_obstacle_half_side(parts->obstacle, half, parts->corner[p.first + i]);
        parts->sign[i] = (int8_t)side;
        sides |= side < 0 ? 1u : side > 0 ? 2u : 0u;
    }
    return sides;
}

/* The part of a segment below a half-space, which has an end on each side. */
static void cut_segment(pir_free_parts *parts, const pir_free_part *of, uint32_t half) {
    const uint32_t *corner = parts->corner + of->first, *wall = parts->wall + of->first;
    uint32_t end[2] = {corner[0], corner[1]}, walls[3] = {wall[0], wall[1], wall[2]};
    const int gone = parts->sign[0] > 0 ? 0 : 1;
    end[gone] = pir_obstacle_add(parts->obstacle, PIR_OBSTACLE_MEET, of->plane, wall[0] >> 1, half >> 1);
    walls[1 + gone] = half;
    add_segment(parts, of->plane, end, walls);
}

/* The part of a polygon below a half-space, with corners on both sides, whose signs sides_of has left for `turned`
 * false; the part above, where it is true. */
static void cut_polygon(pir_free_parts *parts, const pir_free_part *of, uint32_t half, bool turned) {
    pir_obstacle *o = parts->obstacle;
    const int keep = turned ? 1 : -1;
    const uint32_t own = half ^ (uint32_t)turned;
    begin(parts, of->plane);
    for (uint32_t i = 0; i < of->corners && o->status == PIR_OK; i++) {
        const int a = parts->sign[i] * keep, b = parts->sign[next_of(of, i)] * keep;
        const uint32_t corner = parts->corner[of->first + i], wall = parts->wall[of->first + i];
        if (a >= 0)
            add_corner(parts, corner, a == 0 && b <= 0 ? own : wall);
        if (a * b < 0) {
            const uint32_t made = pir_obstacle_add(o, PIR_OBSTACLE_MEET, of->plane, wall >> 1, half >> 1);
            add_corner(parts, made, a > 0 ? own : wall);
        }
    }
}

/* Cuts a part with corners on both sides. */
static void cut(pir_free_parts *parts, uint32_t part, uint32_t half, bool above) {
    const pir_free_part of = parts->part[part];
    if (of.corners == 2 && above)
        for (int i = 0; i < 2; i++)
            parts->sign[i] = (int8_t)-parts->sign[i];
    if (of.corners == 2)
        cut_segment(parts, &of, half ^ (uint32_t)above);
    else
        cut_polygon(parts, &of, half, above);
    if (of.corners == 2 && above)
        for (int i = 0; i < 2; i++)
            parts->sign[i] = (int8_t)-parts->sign[i];
}

/* Adds the corner or the side by which a part below a half-space touches its plane, if it does. */
static void add_touching(pir_free_parts *parts, uint32_t part) {
    const pir_free_part of = parts->part[part];
    for (uint32_t i = 0; i < of.corners; i++) {
        if (parts->sign[i] != 0)
            continue;
        const uint32_t j = next_of(&of, i), h = before(&of, i);
        if (of.corners > 2 && parts->sign[j] == 0) {
            const uint32_t *corner = parts->corner + of.first, *wall = parts->wall + of.first;
            const uint32_t ends[2] = {corner[i], corner[j]}, walls[3] = {wall[i], wall[h], wall[j]};
            add_segment(parts, of.plane, ends, walls);
        } else if (of.corners == 2 || parts->sign[h] != 0) {
            begin(parts, of.plane);
            add_corner(parts, parts->corner[of.first + i], PIR_OBSTACLE_NONE);
        }
    }
}

uint32_t pir_free_parts_subtract(pir_free_parts *parts, uint32_t part, const pir_obstacle_sum *sum) {
    const pir_obstacle *o = parts->obstacle;
    // what is left below all planes so far is in no list; parts that are left are those from here on, but for it
    const uint32_t from = parts->count;
    uint32_t rest = part, kept = from;
    for (uint32_t f = sum->first; f < sum->first + sum->count && o->status == PIR_OK; f++) {
        const uint32_t half = pir_obstacle_half(f, false);
        const unsigned sides = sides_of(parts, rest, half);
        if (!(sides & 1)) {
            // none of it is inside
            begin(parts, parts->part[rest].plane);
            if (o->status == PIR_OK)
                parts->part[parts->count - 1] = parts->part[rest];
            parts->part[parts->count - 1].nearest = 0;
            break;
        }
        if (!(sides & 2)) {
            add_touching(parts, rest);
            continue;
        }
        cut(parts, rest, half, true);
        cut(parts, rest, half, false);
        rest = parts->count - 1;
        // `rest` is no part that is left: marked by its lack of a nearest point
        parts->part[rest].nearest = PIR_OBSTACLE_NONE;
    }
    for (uint32_t k = from; k < parts->count && o->status == PIR_OK; k++)
        if (parts->part[k].nearest != PIR_OBSTACLE_NONE)
            parts->part[kept++] = parts->part[k];
    if (o->status == PIR_OK)
        parts->count = kept;
    return measure(parts, from);
}

/* --- facets --- */

/* The plane within the box, as a polygon: cut by the four planes of the box that are steepest to it. */
static void begin_square(pir_free_parts *parts, uint32_t plane) {
    pir_obstacle *o = parts->obstacle;
    const double *n = o->plane[plane].n;
    const uint32_t axis = fabs(n[0]) >= fabs(n[1]) && fabs(n[0]) >= fabs(n[2]) ? 0 : fabs(n[1]) >= fabs(n[2]) ? 1 : 2;
    const uint32_t i = (axis + 1) % 3, j = (axis + 2) % 3, side[4] = {2 * i, 2 * j, 2 * i + 1, 2 * j + 1};
    begin(parts, plane);
    for (int k = 0; k < 4 && o->status == PIR_OK; k++) {
        const uint32_t wall = side[k], last = side[(k + 3) % 4];
        add_corner(parts, pir_obstacle_add(o, PIR_OBSTACLE_MEET, plane, last, wall), pir_obstacle_half(wall, false));
    }
}

/* The facet as a copy of a facet of P or Q, moved by a vertex, or the parallelogram of two edges: the sums of vertices
 * that are its corners, in turn; whether they are counter-clockwise from above. In A', which is reflected, facets are
 * walked the other way round, and edges lead from their target to their origin. */
static bool add_corners(pir_free_parts *parts, uint32_t plane) {
    pir_obstacle *o = parts->obstacle;
    const pir_obstacle_plane f = o->plane[plane];
    const uint32_t pieces_q = o->frame.body[1].of->count, piece[2] = {f.pair / pieces_q, f.pair % pieces_q};
    const pir_framed_body *p = &o->frame.body[0], *q = &o->frame.body[1];
    const uint32_t first_p = p->of->vertex_start[piece[0]], first_q = q->of->vertex_start[piece[1]];
    if (f.kind == PIR_OBSTACLE_EDGES) {
        const pir_framed_edge e = p->edge[p->edge_start[piece[0]] + f.p], g = q->edge[q->edge_start[piece[1]] + f.q];
        const uint32_t corner[4][2] = {
            {e.origin, g.origin}, {e.target, g.origin}, {e.target, g.target}, {e.origin, g.target}};
        for (int i = 0; i < 4; i++)
            add_corner(parts, pir_obstacle_add(o, PIR_OBSTACLE_VERTICES, corner[i][0], corner[i][1], PIR_OBSTACLE_NONE),
                       0);
        return f.turned;
    }
    const bool of_q = f.kind == PIR_OBSTACLE_Q_FACET;
    const pir_polytope *own = of_q ? q->of->piece[piece[1]] : p->of->piece[piece[0]];
    const uint32_t face = of_q ? f.q : f.p;
    for (uint32_t i = own->loop_start[face]; i < own->loop_start[face + 1]; i++) {
        const uint32_t v = own->origin[own->loop[i]];
        const uint32_t a = first_p + (of_q ? f.p : v), b = first_q + (of_q ? v : f.q);
        add_corner(parts, pir_obstacle_add(o, PIR_OBSTACLE_VERTICES, a, b, PIR_OBSTACLE_NONE), 0);
    }
    return of_q;
}

/* The facet whose corners are sums of vertices, with a wall through each side. */
static uint32_t add_copy(pir_free_parts *parts, uint32_t plane) {
    pir_obstacle *o = parts->obstacle;
    const uint32_t made = begin(parts, plane);
    const bool forward = add_corners(parts, plane);
    for (uint32_t i = 0; o->status == PIR_OK && i < parts->part[made].corners; i++) {
        const pir_free_part *part = &parts->part[made];
        const uint32_t *corner = parts->corner + part->first;
        const uint32_t wall = pir_obstacle_add_wall(o, plane, corner[i], corner[next_of(part, i)], !forward);
        parts->wall[part->first + i] = pir_obstacle_half(wall, false);
    }
    return o->status == PIR_OK ? measure(parts, made) : PIR_OBSTACLE_NONE;
}

uint32_t pir_free_parts_facet(pir_free_parts *parts, uint32_t plane) {
    pir_obstacle *o = parts->obstacle;
    if (!o->plane[plane].tied)
        return add_copy(parts, plane);
    const pir_obstacle_sum sum = o->sum[o->plane[plane].pair];
    const uint32_t from = parts->count;
    begin_square(parts, plane);
    uint32_t rest = from;
    for (uint32_t f = sum.first; f < sum.first + sum.count && o->status == PIR_OK; f++) {
        if (f == plane)
            continue;
        const uint32_t half = pir_obstacle_half(f, false);
        const unsigned sides = sides_of(parts, rest, half);
        if (sides == 2) {
            parts->count = from;
            return PIR_OBSTACLE_NONE;
        }
        if (sides != 3)
            continue;
        cut(parts, rest, half, false);
        rest = parts->count - 1;
    }
    if (o->status != PIR_OK)
        return PIR_OBSTACLE_NONE;
    parts->part[from] = parts->part[rest];
    parts->count = from + 1;
    return measure(parts, from);
}
