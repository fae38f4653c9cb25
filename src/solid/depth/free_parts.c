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

/* A ball that holds a part, by doubles. */
struct part_ball {
    double x[3], radius;
};

static struct part_ball ball_of(const pir_free_parts *parts, const pir_free_part *part) {
    const pir_obstacle_point *point = parts->obstacle->point;
    struct part_ball ball = {{0}, 0};
    for (uint32_t i = 0; i < part->corners; i++)
        for (int k = 0; k < 3; k++)
            ball.x[k] += point[parts->corner[part->first + i]].x[k] / part->corners;
    for (uint32_t i = 0; i < part->corners; i++) {
        const pir_obstacle_point *p = &point[parts->corner[part->first + i]];
        const double to[3] = {p->x[0] - ball.x[0], p->x[1] - ball.x[1], p->x[2] - ball.x[2]};
        ball.radius = fmax(ball.radius, sqrt(to[0] * to[0] + to[1] * to[1] + to[2] * to[2]) + p->err);
    }
    return ball;
}

/* Whether doubles prove that all of a ball is below a plane. */
static inline bool is_below(const struct part_ball *ball, const pir_obstacle_plane *f) {
    return f->d - (f->n[0] * ball->x[0] + f->n[1] * ball->x[1] + f->n[2] * ball->x[2]) >
           ball->radius + f->err + 0x1p-46;
}

uint32_t pir_free_parts_subtract(pir_free_parts *parts, uint32_t part, const pir_obstacle_sum *sum) {
    const pir_obstacle *o = parts->obstacle;
    // what is left below all planes so far is in no list; parts that are left are those from here on, but for it
    const uint32_t from = parts->count;
    uint32_t rest = part, kept = from;
    struct part_ball ball = ball_of(parts, &parts->part[part]);
    for (uint32_t f = sum->first; f < sum->first + sum->count && o->status == PIR_OK; f++) {
        if (is_below(&ball, &o->plane[f]))
            continue;
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
        ball = ball_of(parts, &parts->part[rest]);
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

/* The features of a facet that is a copy of a facet of P or Q, moved by a vertex, or the parallelogram of two edges:
 * corners, sums of vertices, in turn, and in `sign` of each whether it, bit 0, and the side that begins there, bit 1,
 * are inner. In A', which is reflected, facets are walked the other way round, and edges lead from target to origin. */
struct copy_features {
    bool forward; /* the corners are counter-clockwise from above */
    bool inner;   /* the whole is */
};

static void add_feature(pir_free_parts *parts, uint32_t a, uint32_t b, bool inner_side) {
    pir_obstacle *o = parts->obstacle;
    const pir_shared_features *p = &o->frame.body[0].shared, *q = &o->frame.body[1].shared;
    const uint32_t i = parts->part[parts->count - 1].corners;
    if (!pir_obstacle_grow(o, (void **)&parts->sign, &parts->sign_room, i, sizeof *parts->sign))
        return;
    const bool inner = p->inner_vertex[p->vertex[a]] || q->inner_vertex[q->vertex[b]];
    parts->sign[i] = (int8_t)(inner | inner_side << 1);
    add_corner(parts, pir_obstacle_add(o, PIR_OBSTACLE_VERTICES, a, b, PIR_OBSTACLE_NONE), 0);
}

static struct copy_features add_edge_features(pir_free_parts *parts, const pir_obstacle_plane *f,
                                              const uint32_t piece[2]) {
    const pir_framed_body *p = &parts->obstacle->frame.body[0], *q = &parts->obstacle->frame.body[1];
    const pir_framed_edge *e = &p->edge[p->edge_start[piece[0]] + f->p], *g = &q->edge[q->edge_start[piece[1]] + f->q];
    const bool *of_p = p->shared.inner_vertex, *of_q = q->shared.inner_vertex;
    add_feature(parts, e->origin, g->origin, e->inner || of_q[q->shared.vertex[g->origin]]);
    add_feature(parts, e->target, g->origin, g->inner || of_p[p->shared.vertex[e->target]]);
    add_feature(parts, e->target, g->target, e->inner || of_q[q->shared.vertex[g->target]]);
    add_feature(parts, e->origin, g->target, g->inner || of_p[p->shared.vertex[e->origin]]);
    return (struct copy_features){.forward = f->turned, .inner = e->inner || g->inner};
}

static struct copy_features add_facet_features(pir_free_parts *parts, const pir_obstacle_plane *f,
                                               const uint32_t piece[2]) {
    const int side = f->kind == PIR_OBSTACLE_Q_FACET;
    const pir_framed_body *own = &parts->obstacle->frame.body[side], *other = &parts->obstacle->frame.body[1 - side];
    const pir_polytope *of = own->of->piece[piece[side]];
    const uint32_t face = side ? f->q : f->p, first = own->of->vertex_start[piece[side]];
    const uint32_t vertex = other->of->vertex_start[piece[1 - side]] + (side ? f->p : f->q);
    const bool inner = other->shared.inner_vertex[other->shared.vertex[vertex]];
    for (uint32_t i = of->loop_start[face]; i < of->loop_start[face + 1]; i++) {
        const uint32_t v = first + of->origin[of->loop[i]], edge = own->edge_start[piece[side]] + of->edge[of->loop[i]];
        add_feature(parts, side ? vertex : v, side ? v : vertex, inner || own->edge[edge].inner);
    }
    return (struct copy_features){.forward = side,
                                  .inner = inner || own->shared.inner_face[own->of->face_start[piece[side]] + face]};
}

uint32_t pir_free_parts_corners(const pir_obstacle *obstacle, uint32_t plane, uint32_t room, double (*ret_corner)[3]) {
    const pir_obstacle_plane *f = &obstacle->plane[plane];
    const pir_framed_body *p = &obstacle->frame.body[0], *q = &obstacle->frame.body[1];
    const uint32_t piece[2] = {f->pair / q->of->count, f->pair % q->of->count};
    if (f->tied)
        return 0;
    if (f->kind == PIR_OBSTACLE_EDGES) {
        const pir_framed_edge *e = &p->edge[p->edge_start[piece[0]] + f->p];
        const pir_framed_edge *g = &q->edge[q->edge_start[piece[1]] + f->q];
        for (uint32_t i = 0; i < 4 && room >= 4; i++)
            for (int k = 0; k < 3; k++)
                ret_corner[i][k] = p->vertex[i == 1 || i == 2 ? e->target : e->origin][k] +
                                   q->vertex[i >= 2 ? g->target : g->origin][k];
        return room >= 4 ? 4 : 0;
    }
    const int side = f->kind == PIR_OBSTACLE_Q_FACET;
    const pir_framed_body *own = side ? q : p, *other = side ? p : q;
    const pir_polytope *of = own->of->piece[piece[side]];
    const double *by = other->vertex[other->of->vertex_start[piece[1 - side]] + (side ? f->p : f->q)];
    const uint32_t first = own->of->vertex_start[piece[side]], face = side ? f->q : f->p;
    const uint32_t start = of->loop_start[face], count = of->loop_start[face + 1] - start;
    for (uint32_t i = 0; i < count && count <= room; i++)
        for (int k = 0; k < 3; k++)
            ret_corner[i][k] = own->vertex[first + of->origin[of->loop[start + i]]][k] + by[k];
    return count <= room ? count : 0;
}

/* Puts the sides and corners of an inner facet in its place that are not inner themselves. */
static void add_rim(pir_free_parts *parts, uint32_t facet) {
    const pir_free_part of = parts->part[facet];
    for (uint32_t i = 0; i < of.corners; i++) {
        const uint32_t *corner = parts->corner + of.first, *wall = parts->wall + of.first;
        const uint32_t h = before(&of, i), j = next_of(&of, i);
        const uint32_t ends[2] = {corner[i], corner[j]}, walls[3] = {wall[i], wall[h], wall[j]};
        if (!(parts->sign[i] & 2)) {
            add_segment(parts, of.plane, ends, walls);
        } else if (!(parts->sign[i] & 1) && (parts->sign[h] & 2)) {
            begin(parts, of.plane);
            add_corner(parts, ends[0], PIR_OBSTACLE_NONE);
        }
    }
    for (uint32_t k = facet + 1; k < parts->count && parts->obstacle->status == PIR_OK; k++)
        parts->part[k - 1] = parts->part[k];
    parts->count -= parts->obstacle->status == PIR_OK;
}

/* The facet whose corners are sums of vertices, with a wall through each side. */
static uint32_t add_copy(pir_free_parts *parts, uint32_t plane) {
    pir_obstacle *o = parts->obstacle;
    const pir_obstacle_plane f = o->plane[plane];
    const uint32_t pieces_q = o->frame.body[1].of->count, piece[2] = {f.pair / pieces_q, f.pair % pieces_q};
    const uint32_t made = begin(parts, plane);
    if (o->status != PIR_OK)
        return made;
    const struct copy_features features =
        f.kind == PIR_OBSTACLE_EDGES ? add_edge_features(parts, &f, piece) : add_facet_features(parts, &f, piece);
    bool all = features.inner;
    for (uint32_t i = 0; i < parts->part[made].corners && all; i++)
        all = parts->sign[i] == 3;
    if (all || o->status != PIR_OK) {
        parts->count = made;
        return made;
    }
    for (uint32_t i = 0; o->status == PIR_OK && i < parts->part[made].corners; i++) {
        const pir_free_part *part = &parts->part[made];
        const uint32_t *corner = parts->corner + part->first;
        const uint32_t wall = pir_obstacle_add_wall(o, plane, corner[i], corner[next_of(part, i)], !features.forward);
        parts->wall[part->first + i] = pir_obstacle_half(wall, false);
    }
    if (features.inner && o->status == PIR_OK)
        add_rim(parts, made);
    return measure(parts, made);
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
            return from;
        }
        if (sides != 3)
            continue;
        cut(parts, rest, half, false);
        rest = parts->count - 1;
    }
    if (o->status != PIR_OK)
        return from;
    parts->part[from] = parts->part[rest];
    parts->count = from + 1;
    return measure(parts, from);
}
