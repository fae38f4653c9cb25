/* SPDX-License-Identifier: MIT */
/* See obstacle.h. A normal of a facet is within 2^-47, which is worth less than 2^-46 at |x| ≤ √3; its height is
 * within 2^-48. So a plane is within 2^-45. */
#include "solid/depth/obstacle.h"

#include "base/vec.h"

#define BOX_PLANES 6

/* Planes and points that doubles are farther off from are made exactly, and rounded. */
#define FAR_OFF 0x1p-26

/* --- memory --- */

bool pir_obstacle_grow(pir_obstacle *obstacle, void **array, uint32_t *room, uint32_t count, size_t size) {
    pir_obstacle *o = obstacle;
    if (o->status != PIR_OK)
        return false;
    if (count < *room)
        return true;
    if (count >= PIR_OBSTACLE_MOST) {
        o->status = PIR_ERR_LIMIT;
        return false;
    }
    const uint32_t wanted = *room ? 2 * *room : 256;
    void *grown = pir_memory_resize(&o->allocator, *array, *room, wanted, size);
    if (!grown) {
        o->status = PIR_ERR_MEMORY;
        return false;
    }
    *array = grown;
    *room = wanted;
    return true;
}

/* Room for the slopes of any sum. False when out of memory. */
static bool make_slopes(pir_obstacle *o) {
    uint32_t faces[2] = {0}, edges[2] = {0};
    for (int side = 0; side < 2; side++) {
        const pir_framed_body *body = &o->frame.body[side];
        for (uint32_t i = 0; i < body->of->count; i++) {
            const uint32_t own_faces = body->of->face_start[i + 1] - body->of->face_start[i];
            const uint32_t own_edges = body->edge_start[i + 1] - body->edge_start[i];
            faces[side] = own_faces > faces[side] ? own_faces : faces[side];
            edges[side] = own_edges > edges[side] ? own_edges : edges[side];
        }
    }
    for (int side = 0; side < 2; side++) {
        o->slope_room[side] = faces[side] * edges[1 - side];
        o->slope[side] = PIR_NEW(&o->allocator, int8_t, o->slope_room[side]);
        if (!o->slope[side])
            return false;
    }
    return true;
}

bool pir_obstacle_init(pir_obstacle *obstacle, const pir_compound *p, const pir_compound *q,
                       const pir_allocator *allocator) {
    pir_obstacle *o = obstacle;
    *o = (pir_obstacle){.allocator = *allocator, .pairs = p->count * q->count};
    for (size_t k = 0; k < sizeof o->t / sizeof *o->t; k++)
        mpz_init(o->t[k]);
    o->sum = PIR_ZEROED(allocator, pir_obstacle_sum, o->pairs);
    o->open = PIR_NEW(allocator, uint32_t, o->pairs);
    o->beyond = (double(*)[3])PIR_ZEROED(allocator, double, 3 * (size_t)o->pairs);
    return o->sum && o->open && o->beyond && pir_piece_frame_init(&o->frame, p, q, allocator) && make_slopes(o);
}

void pir_obstacle_finish(pir_obstacle *obstacle) {
    pir_obstacle *o = obstacle;
    for (size_t k = 0; k < sizeof o->t / sizeof *o->t; k++)
        mpz_clear(o->t[k]);
    while (o->number_made > 0)
        mpz_clear(o->number[--o->number_made]);
    PIR_FREE(&o->allocator, o->number, o->number_room);
    PIR_FREE(&o->allocator, o->plane, o->plane_room);
    PIR_FREE(&o->allocator, o->point, o->point_room);
    PIR_FREE(&o->allocator, o->sum, o->pairs);
    PIR_FREE(&o->allocator, o->open, o->pairs);
    PIR_FREE(&o->allocator, (double *)o->beyond, 3 * (size_t)o->pairs);
    for (int side = 0; side < 2; side++)
        PIR_FREE(&o->allocator, o->slope[side], o->slope_room[side]);
    pir_piece_frame_finish(&o->frame, &o->allocator);
}

/* --- planes --- */

/* A new plane, whose normal is made exactly where doubles say too little of it. */
static void add_plane(pir_obstacle *o, pir_obstacle_plane plane) {
    if (!pir_obstacle_grow(o, (void **)&o->plane, &o->plane_room, o->plane_count, sizeof *o->plane))
        return;
    plane.exact = PIR_OBSTACLE_NONE;
    o->plane[o->plane_count++] = plane;
    if (plane.err > FAR_OFF) {
        pir_obstacle_exact_plane(o, o->plane_count - 1);
        if (o->status == PIR_OK)
            pir_obstacle_round_plane(o, o->plane_count - 1);
    }
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The planes of the facets of piece i of one body, with the highest vertices of piece j of the other. */
static void add_facets(pir_obstacle *o, uint32_t pair, int side, uint32_t i, uint32_t j) {
    const pir_framed_body *own = &o->frame.body[side], *other = &o->frame.body[1 - side];
    const uint32_t first = other->of->vertex_start[j];
    for (uint32_t f = own->of->face_start[i]; f < own->of->face_start[i + 1]; f++) {
        const double *n = own->normal[f];
        double most = -HUGE_VAL, second = -HUGE_VAL;
        uint32_t at = first;
        for (uint32_t v = first; v < other->of->vertex_start[j + 1]; v++) {
            const double height = dot(n, other->vertex[v]);
            const bool higher = height > most;
            second = higher ? most : height > second ? height : second;
            at = higher ? v : at;
            most = higher ? height : most;
        }
        const uint32_t face = f - own->of->face_start[i], vertex = at - first;
        add_plane(o, (pir_obstacle_plane){.n = {n[0], n[1], n[2]},
                                          .d = own->height[f] + most,
                                          .err = 0x1p-45,
                                          .pair = pair,
                                          .p = side ? vertex : face,
                                          .q = side ? face : vertex,
                                          .kind = side ? PIR_OBSTACLE_Q_FACET : PIR_OBSTACLE_P_FACET,
                                          .tied = second > most - 0x1p-44,
                                          .shared_p = side ? other->shared.vertex[at] : own->shared.plane[f],
                                          .shared_q = side ? own->shared.plane[f] : other->shared.vertex[at]});
    }
}

/* The signs of the normals of a piece's faces along the edges of a piece of the other body, by doubles. */
static void fill_slopes(pir_obstacle *o, int side, const uint32_t piece[2]) {
    const pir_framed_body *own = &o->frame.body[side], *other = &o->frame.body[1 - side];
    const uint32_t first = other->edge_start[piece[1 - side]], end = other->edge_start[piece[1 - side] + 1];
    int8_t *to = o->slope[side];
    for (uint32_t f = own->of->face_start[piece[side]]; f < own->of->face_start[piece[side] + 1]; f++)
        for (uint32_t e = first; e < end; e++) {
            const double s = dot(own->normal[f], other->along[e]);
            *to++ = (int8_t)(s > 0x1p-45 ? 1 : s < -0x1p-45 ? -1 : 2);
        }
}

/* The sign of a normal of one body along an edge of the other, by their numbers in the pieces. */
static inline int slope(pir_obstacle *o, int side, const uint32_t piece[2], uint32_t face, uint32_t edge) {
    const pir_framed_body *other = &o->frame.body[1 - side];
    const uint32_t edges = other->edge_start[piece[1 - side] + 1] - other->edge_start[piece[1 - side]];
    int8_t *known = &o->slope[side][face * edges + edge];
    if (*known == 2)
        *known = (int8_t)pir_obstacle_exact_slope(o, side, piece, face, edge);
    return *known;
}

/* The sign with which the arc of an edge passes through the great circle of an edge of the other; 0: it does not. */
static inline int passes(pir_obstacle *o, int side, const uint32_t piece[2], uint32_t own, uint32_t other) {
    const pir_framed_body *body = &o->frame.body[side];
    const pir_framed_edge *edge = &body->edge[body->edge_start[piece[side]] + own];
    const uint32_t first = body->of->face_start[piece[side]];
    const int right = slope(o, side, piece, edge->right - first, other);
    return right != 0 && slope(o, side, piece, edge->left - first, other) == -right ? right : 0;
}

/* The plane of two edges whose arcs cross. Directions are within 2^-47 and 2^-50, so the unit normal is within
 * 2^-46 over the length of their product, which is worth less than 2^-45 at |x| ≤ √3. */
static void add_crossing(pir_obstacle *o, const uint32_t piece[2], uint32_t pair, uint32_t e, uint32_t g, bool turned) {
    const pir_framed_body *p = &o->frame.body[0], *q = &o->frame.body[1];
    const double *a = p->along[e], *b = q->along[g], *x = p->vertex[p->edge[e].origin],
                 *y = q->vertex[q->edge[g].origin];
    const double cross[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    const double length = sqrt(dot(cross, cross)), by = (turned ? -1 : 1) / length;
    pir_obstacle_plane plane = {.err = length > 0 ? 0x1p-44 / length : HUGE_VAL,
                                .pair = pair,
                                .p = e - p->edge_start[piece[0]],
                                .q = g - q->edge_start[piece[1]],
                                .kind = PIR_OBSTACLE_EDGES,
                                .shared_p = p->edge[e].line,
                                .shared_q = q->edge[g].line,
                                .turned = turned};
    for (int k = 0; k < 3; k++) {
        plane.n[k] = by * cross[k];
        plane.d += plane.n[k] * (x[k] + y[k]);
    }
    add_plane(o, plane);
}

static void add_crossings(pir_obstacle *o, uint32_t pair, const uint32_t piece[2]) {
    const pir_framed_body *p = &o->frame.body[0], *q = &o->frame.body[1];
    const uint32_t first[2] = {p->edge_start[piece[0]], q->edge_start[piece[1]]};
    const uint32_t edges[2] = {p->edge_start[piece[0] + 1] - first[0], q->edge_start[piece[1] + 1] - first[1]};
    fill_slopes(o, 0, piece);
    fill_slopes(o, 1, piece);
    for (uint32_t e = 0; e < edges[0]; e++)
        for (uint32_t g = 0; g < edges[1]; g++) {
            const int along = passes(o, 0, piece, e, g);
            // the two arcs meet in one point, not in opposite ones, when they pass opposite ways
            if (along != 0 && passes(o, 1, piece, g, e) == -along)
                add_crossing(o, piece, pair, first[0] + e, first[1] + g, along > 0);
        }
}

pir_obstacle_sum *pir_obstacle_open(pir_obstacle *obstacle, uint32_t pair) {
    pir_obstacle *o = obstacle;
    pir_obstacle_sum *sum = &o->sum[pair];
    if (sum->count > 0)
        return sum;
    const uint32_t of_q = o->frame.body[1].of->count, piece[2] = {pair / of_q, pair % of_q};
    sum->first = sum->outer = o->plane_count;
    add_facets(o, pair, 0, piece[0], piece[1]);
    add_facets(o, pair, 1, piece[1], piece[0]);
    add_crossings(o, pair, piece);
    sum->count = o->plane_count - sum->first;
    o->open[o->opened++] = pair;
    return sum;
}

void pir_obstacle_note_beyond(pir_obstacle *obstacle, uint32_t plane) {
    const pir_obstacle_plane *f = &obstacle->plane[plane];
    for (int k = 0; k < 3; k++)
        obstacle->beyond[f->pair][k] = f->n[k];
}

/* How high a piece is along a unit vector. */
static double height_along(const pir_framed_body *body, uint32_t piece, const double n[3]) {
    double most = -HUGE_VAL;
    for (uint32_t v = body->of->vertex_start[piece]; v < body->of->vertex_start[piece + 1]; v++) {
        const double height = dot(n, body->vertex[v]);
        most = height > most ? height : most;
    }
    return most;
}

bool pir_obstacle_is_beyond(const pir_obstacle *obstacle, uint32_t pair, const double x[3], double err) {
    const pir_framed_body *p = &obstacle->frame.body[0], *q = &obstacle->frame.body[1];
    const double *n = obstacle->beyond[pair];
    // without a normal both sides are 0
    return dot(n, x) >
           height_along(p, pair / q->of->count, n) + height_along(q, pair % q->of->count, n) + err + 0x1p-44;
}

pir_space_box pir_obstacle_box(const pir_obstacle *obstacle, uint32_t pair) {
    const pir_framed_body *p = &obstacle->frame.body[0], *q = &obstacle->frame.body[1];
    const pir_space_box *a = &p->box[pair / q->of->count], *b = &q->box[pair % q->of->count];
    pir_space_box box;
    for (int k = 0; k < 3; k++) {
        box.low[k] = a->low[k] + b->low[k];
        box.high[k] = a->high[k] + b->high[k];
    }
    return box;
}

/* The box about all sums, which nothing that matters is outside of: |x| ≤ 3/16. */
static void add_box(pir_obstacle *o) {
    for (uint32_t which = 0; which < BOX_PLANES; which++) {
        pir_obstacle_plane plane = {.d = 0.1875, .pair = which, .kind = PIR_OBSTACLE_BOX};
        plane.n[which / 2] = which & 1 ? -1 : 1;
        add_plane(o, plane);
    }
}

/* --- poses --- */

/* The unit vector of a direction of the world, as Q sees it. */
static void set_way(pir_obstacle *o, pir_vec3 way) {
    int exponent;
    (void)frexp(fmax(fabs(way.x), fmax(fabs(way.y), fabs(way.z))), &exponent);
    const pir_vec3 near = {ldexp(way.x, -exponent), ldexp(way.y, -exponent), ldexp(way.z, -exponent)};
    const pir_vec3 turned = pir_mat_apply_transposed(&o->frame.rotation_q.r, near);
    const double length = sqrt(pir_vec_dot(turned, turned));
    o->way[0] = turned.x / length;
    o->way[1] = turned.y / length;
    o->way[2] = turned.z / length;
    o->world_way = way;
    o->exact_way = PIR_OBSTACLE_NONE;
}

pir_status pir_obstacle_set(pir_obstacle *obstacle, const pir_pair_input *input, const pir_vec3 *way) {
    pir_obstacle *o = obstacle;
    o->status = PIR_OK;
    for (; o->opened > 0; o->opened--)
        o->sum[o->open[o->opened - 1]].count = 0;
    o->plane_count = o->point_count = o->number_count = 0;
    const pir_status status = pir_piece_frame_set(&o->frame, input);
    if (status != PIR_OK)
        return status;
    add_box(o);
    const uint32_t place =
        pir_obstacle_add(o, PIR_OBSTACLE_PLACE, PIR_OBSTACLE_NONE, PIR_OBSTACLE_NONE, PIR_OBSTACLE_NONE);
    for (int k = 0; k < 3 && o->status == PIR_OK; k++)
        o->point[place].x[k] = o->frame.t[k];
    if (way)
        set_way(o, *way);
    return o->status;
}

uint32_t pir_obstacle_add_wall(pir_obstacle *obstacle, uint32_t plane, uint32_t from, uint32_t to, bool turned) {
    pir_obstacle *o = obstacle;
    const double *n = o->plane[plane].n, *a = o->point[from].x, *b = o->point[to].x;
    const double side[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const double cross[3] = {side[1] * n[2] - side[2] * n[1], side[2] * n[0] - side[0] * n[2],
                             side[0] * n[1] - side[1] * n[0]};
    const double length = sqrt(dot(cross, cross)), by = (turned ? -1 : 1) / length;
    // both ends are within 2^-47
    pir_obstacle_plane wall = {.err = length > 0 ? 0x1p-44 / length + 4 * o->plane[plane].err : HUGE_VAL,
                               .pair = plane,
                               .p = from,
                               .q = to,
                               .kind = PIR_OBSTACLE_WALL,
                               .turned = turned};
    for (int k = 0; k < 3; k++) {
        wall.n[k] = by * cross[k];
        wall.d += wall.n[k] * a[k];
    }
    add_plane(o, wall);
    return o->plane_count - 1;
}

/* --- what holds at every pose --- */

/* Whether the sum of a vertex of A' and one of B, by their numbers in the bodies, is on a plane at every pose. */
static bool holds_vertices(const pir_obstacle *o, const pir_obstacle_plane *f, const uint32_t of[2]) {
    const pir_shared_features *p = &o->frame.body[0].shared, *q = &o->frame.body[1].shared;
    const uint32_t a = p->vertex[of[0]], b = q->vertex[of[1]];
    switch (f->kind) {
    case PIR_OBSTACLE_P_FACET:
        return f->shared_q == b && pir_shared_features_on(p, f->shared_p, a);
    case PIR_OBSTACLE_Q_FACET:
        return f->shared_p == a && pir_shared_features_on(q, f->shared_q, b);
    case PIR_OBSTACLE_EDGES:
        return pir_framed_on_line(&o->frame.body[0], f->shared_p, a) &&
               pir_framed_on_line(&o->frame.body[1], f->shared_q, b);
    case PIR_OBSTACLE_WALL:
        for (int end = 0; end < 2; end++) {
            const uint32_t *own = o->point[end ? f->q : f->p].of;
            if (p->vertex[own[0]] == a && q->vertex[own[1]] == b)
                return true;
        }
        return false;
    case PIR_OBSTACLE_BOX:
        break;
    }
    return false;
}

/* Whether two planes are one at every pose, whichever way they face. */
static bool are_always_one(const pir_obstacle_plane *f, const pir_obstacle_plane *g) {
    return f->kind == g->kind && f->kind != PIR_OBSTACLE_WALL && f->kind != PIR_OBSTACLE_BOX &&
           f->shared_p == g->shared_p && f->shared_q == g->shared_q;
}

bool pir_obstacle_is_always_on(const pir_obstacle *obstacle, uint32_t plane, uint32_t point) {
    const pir_obstacle *o = obstacle;
    const pir_obstacle_plane *f = &o->plane[plane];
    const pir_obstacle_point *p = &o->point[point];
    if (p->kind == PIR_OBSTACLE_VERTICES)
        return holds_vertices(o, f, p->of);
    for (int k = 0; k < 3; k++) {
        if (p->of[k] == PIR_OBSTACLE_NONE)
            continue;
        const pir_obstacle_plane *g = &o->plane[p->of[k]];
        if (p->of[k] == plane || are_always_one(f, g))
            return true;
        // of a wall and its facet, the line of a side: on the plane where both ends are
        if (g->kind == PIR_OBSTACLE_WALL && p->of[0] == g->pair && holds_vertices(o, f, o->point[g->p].of) &&
            holds_vertices(o, f, o->point[g->q].of))
            return true;
    }
    return false;
}

/* --- points --- */

/* A plane in doubles, with its error. */
struct near_plane {
    const double *n;
    double d, err;
};

/* How far a solution may be from where the true planes meet: each plane's residual, with what it may be wrong by, over
 * the least determinant that the true normals may have. The cross product of two unit normals is no longer than 1. */
static double meet_error(const struct near_plane plane[3], const double x[3], double det) {
    double all = 0, wrong = 0x1p-48;
    for (int k = 0; k < 3; k++) {
        all += fabs(dot(plane[k].n, x) - plane[k].d) + plane[k].err + 0x1p-50;
        wrong += 2 * plane[k].err;
    }
    const double least = fabs(det) * (1 - 0x1p-40) - wrong;
    return least > 0 ? all * (1 + 0x1p-40) / least : HUGE_VAL;
}

/* Where three planes meet, by doubles, and how far off that may be: infinite where it is not in the cube. */
static double solve_meet(const struct near_plane plane[3], double x[3]) {
    double sum[3] = {0}, det = 0;
    for (int i = 0; i < 3; i++) {
        const double *a = plane[(i + 1) % 3].n, *b = plane[(i + 2) % 3].n, d = plane[i].d;
        const double cross[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
        for (int k = 0; k < 3; k++)
            sum[k] += d * cross[k];
        if (i == 0)
            det = dot(plane[0].n, cross);
    }
    for (int k = 0; k < 3; k++) {
        x[k] = sum[k] / det;
        if (!(fabs(x[k]) <= 1))
            return HUGE_VAL;
    }
    return meet_error(plane, x, det);
}

/* The foot on the line where two planes meet: where they meet the plane across that line through the place. */
static double solve_line(const struct near_plane of[2], const pir_obstacle_point *place, double x[3]) {
    const double *a = of[0].n, *b = of[1].n;
    double cross[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    const double length = sqrt(dot(cross, cross));
    if (!(length > 0x1p-30))
        return HUGE_VAL;
    for (int k = 0; k < 3; k++)
        cross[k] /= length;
    // normals are off by no more than √3 times a plane's error; the third plane is so by that over the length
    const double err = 8 * (of[0].err + of[1].err + 0x1p-50) / length + 2 * place->err;
    const struct near_plane plane[3] = {of[0], of[1], {cross, dot(cross, place->x), err}};
    return solve_meet(plane, x);
}

/* The doubles of a point by those of its planes; how far off they may be. */
static double solve(const pir_obstacle *o, const pir_obstacle_point *p, double x[3]) {
    struct near_plane of[3];
    const pir_obstacle_point *place = &o->point[0];
    for (int k = 0; k < 3; k++) {
        const pir_obstacle_plane *f = p->of[k] == PIR_OBSTACLE_NONE ? NULL : &o->plane[p->of[k]];
        of[k] = f ? (struct near_plane){f->n, f->d, f->err} : (struct near_plane){0};
    }
    if (p->kind == PIR_OBSTACLE_MEET)
        return solve_meet(of, x);
    if (p->kind == PIR_OBSTACLE_ON_LINE)
        return solve_line(of, place, x);
    const double over = dot(of[0].n, place->x) - of[0].d;
    const bool on_way = p->kind == PIR_OBSTACLE_ON_WAY;
    const double *u = on_way ? o->way : of[0].n, rate = on_way ? dot(of[0].n, u) : 1, by = -over / rate;
    for (int k = 0; k < 3; k++) {
        x[k] = place->x[k] + by * u[k];
        if (!(fabs(x[k]) <= 1))
            return HUGE_VAL;
    }
    // the normal and the way are off by 2·err and 2^-47, the height by err and what the place is
    const double least = fabs(rate) - 2 * of[0].err - 0x1p-46;
    if (!(least > 0))
        return HUGE_VAL;
    const double off = 2 * of[0].err + 0x1p-46;
    return 2 * place->err + (of[0].err + place->err + off * (1 + fabs(by)) + 0x1p-50) / least + fabs(by) * off;
}

uint32_t pir_obstacle_add(pir_obstacle *obstacle, enum pir_obstacle_point_kind kind, uint32_t f, uint32_t g,
                          uint32_t h) {
    pir_obstacle *o = obstacle;
    const uint32_t made = o->point_count;
    if (!pir_obstacle_grow(o, (void **)&o->point, &o->point_room, made, sizeof *o->point))
        return 0;
    pir_obstacle_point *p = &o->point[made];
    *p = (pir_obstacle_point){.of = {f, g, h}, .exact = PIR_OBSTACLE_NONE, .kind = kind};
    o->point_count++;
    if (kind == PIR_OBSTACLE_PLACE) {
        p->err = 0x1p-46;
        return made;
    }
    if (kind == PIR_OBSTACLE_VERTICES) {
        for (int k = 0; k < 3; k++)
            p->x[k] = o->frame.body[0].vertex[f][k] + o->frame.body[1].vertex[g][k];
        p->err = 0x1p-47;
        return made;
    }
    p->err = solve(o, p, p->x);
    if (!(p->err <= FAR_OFF)) {
        pir_obstacle_exact_point(o, made);
        if (o->status == PIR_OK)
            pir_obstacle_round_point(o, made);
    }
    return made;
}
