/* SPDX-License-Identifier: MIT */
/*
 * A segment clipped by half-spaces in integers. A point v of the body's frame stands at R·v + t with R = M/N. So the
 * point at time s of the ray is Mᵀ(o + s·w)/N there, with o the origin less t, and w the way. Times N, and times
 * what makes vertices and doubles integers, a half-space with the normal n through the corner c is S + s·D ≥ 0 with
 *
 *     S = n·(f·c − o'),  D = −n·w'.
 *
 * Any polytope is what such half-spaces have in common: a polygon that of its two sides and of a wall along each edge,
 * a segment and a point those of lines and planes through them, each twice. So one loop tells for each dimension where
 * the ray enters first.
 */
#include "scene/query/ray.h"

/* A time −S/D, and the half-space that it comes from; UINT32_MAX: the end of the segment. */
struct ray_crossing {
    pir_int s, d;
    uint32_t facet;
    pir_vec3 normal; /* in doubles */
};

struct exact_line {
    const pir_polytope *p;
    pir_limbs *limbs;
    pir_int f;
    pir_int3 origin, way; /* o' and w' */
    struct ray_crossing enter, leave;
    bool misses, inside; /* `inside`: the begin is within all half-spaces so far, on the boundary of none */
    int side;            /* of a polygon: the sign of D of its first facet */
    uint32_t on;         /* the first facet that the begin is on, or UINT32_MAX */
    pir_vec3 on_normal;
};

static uint32_t longer(uint32_t a, uint32_t b) {
    return a > b ? a : b;
}

/* Limbs of a point of the frame, and of a normal. */
static uint32_t limbs_of_point(const pir_polytope *p) {
    uint32_t of_vertex =
                 PIR_MATRIX_LIMBS + pir_int_length(&p->scale.num) + 1074 / GMP_NUMB_BITS + 3 + p->exact_vertex.stride,
             of_ray = PIR_MATRIX_LIMBS + PIR_QUAT_LIMBS + pir_int_length(&p->scale.den) + 4;
    return longer(of_vertex, of_ray) + 1;
}

static uint32_t limbs_of_normal(const pir_polytope *p) {
    return p->exact_edge.stride + p->exact_normal.stride + 2;
}

/*
 * At one time: the doubles as integers, 6; o' and w', twice for their parts, 12 points; two crossings and one more, 6
 * slacks; a corner and a difference, 6 points; two products of slacks; scratch of products. A slack has a point's and a
 * normal's limbs. What is returned is above their sum.
 */
uint32_t pir_ray_limbs(const pir_polytope *p) {
    return 48 * (limbs_of_point(p) + limbs_of_normal(p) + 4) + 12 * (PIR_QUAT_LIMBS + 2);
}

/* --- the line --- */

static int low_bit_of(pir_vec3 v, int so_far) {
    const double c[3] = {v.x, v.y, v.z};
    for (int k = 0; k < 3; k++)
        so_far = pir_double_low_bit(c[k]) < so_far ? pir_double_low_bit(c[k]) : so_far;
    return so_far;
}

static pir_int3 integers_of(pir_vec3 v, int exponent, pir_limbs *limbs) {
    const double c[3] = {v.x, v.y, v.z};
    pir_int3 to = pir_int3_take(limbs, PIR_QUAT_LIMBS + 1);
    for (int k = 0; k < 3; k++)
        pir_int_set_double(&to.c[k], c[k], exponent);
    return to;
}

/* den · Mᵀ v. */
static pir_int3 seen(const struct exact_line *line, const pir_rotation *rotation, const pir_int3 *v) {
    pir_int3 to = pir_int3_take(line->limbs, limbs_of_point(line->p));
    uint32_t mark = line->limbs->used;
    pir_int3 turned = pir_int3_take(line->limbs, PIR_MATRIX_LIMBS + PIR_QUAT_LIMBS + 3);
    pir_rotation_apply_transposed(rotation, &turned, v, line->limbs);
    for (int k = 0; k < 3; k++)
        pir_int_mul(&to.c[k], &turned.c[k], &line->p->scale.den);
    line->limbs->used = mark;
    return to;
}

static void set_line(struct exact_line *line, const pir_world_ray *ray, pir_pose pose, pir_rotation *rotation) {
    pir_limbs *limbs = line->limbs;
    const int e = low_bit_of(ray->origin, low_bit_of(ray->way, low_bit_of(pose.translation, 0)));
    pir_int3 origin = integers_of(ray->origin, e, limbs), at = integers_of(pose.translation, e, limbs),
             way = integers_of(ray->way, e, limbs);
    for (int k = 0; k < 3; k++)
        pir_int_sub(&origin.c[k], &origin.c[k], &at.c[k]);
    line->origin = seen(line, rotation, &origin);
    line->way = seen(line, rotation, &way);
    // f = num · N / 2^e
    const pir_int *num = &line->p->scale.num, *norm = &rotation->integers->norm;
    line->f = pir_limbs_take(limbs, limbs_of_point(line->p));
    uint32_t mark = limbs->used;
    pir_int product = pir_limbs_take(limbs, pir_int_length(num) + pir_int_length(norm));
    pir_int_mul(&product, num, norm);
    pir_int_shift_left(&line->f, &product, (uint32_t)-e);
    limbs->used = mark;
}

/* A crossing at the time 0 or 1. */
static struct ray_crossing end_of(const struct exact_line *line, int time) {
    const uint32_t room = limbs_of_point(line->p) + limbs_of_normal(line->p) + 4;
    struct ray_crossing end = {
        pir_limbs_take(line->limbs, room), pir_limbs_take(line->limbs, room), UINT32_MAX, {0, 0, 0}};
    pir_int_set_double(&end.s, time, 0);
    pir_int_set_double(&end.d, time ? -1 : 1, 0);
    return end;
}

/* The sign of the time of a less that of b. */
static int compare(const struct exact_line *line, const struct ray_crossing *a, const struct ray_crossing *b) {
    uint32_t mark = line->limbs->used,
             need = pir_int_length(&a->s) + pir_int_length(&a->d) + pir_int_length(&b->s) + pir_int_length(&b->d) + 1;
    pir_int x = pir_limbs_take(line->limbs, need), y = pir_limbs_take(line->limbs, need);
    pir_int_mul(&x, &b->s, &a->d);
    pir_int_mul(&y, &a->s, &b->d);
    pir_int_sub(&x, &x, &y);
    line->limbs->used = mark;
    return pir_int_sign(&x) * pir_int_sign(&a->d) * pir_int_sign(&b->d);
}

static void keep(struct ray_crossing *to, const struct ray_crossing *from) {
    pir_int_copy(&to->s, &from->s);
    pir_int_copy(&to->d, &from->d);
    to->facet = from->facet;
    to->normal = from->normal;
}

/* --- half-spaces --- */

/* S and D, in the limbs from here on. */
static struct ray_crossing crossing_of(const struct exact_line *line, const pir_int3 *n, uint32_t vertex) {
    const uint32_t room = limbs_of_point(line->p) + limbs_of_normal(line->p) + 4;
    struct ray_crossing made = {.s = pir_limbs_take(line->limbs, room), .d = pir_limbs_take(line->limbs, room)};
    uint32_t mark = line->limbs->used;
    pir_int3 corner = pir_int3_take(line->limbs, limbs_of_point(line->p) + 1), v = pir_vertex_exact(line->p, vertex);
    for (int k = 0; k < 3; k++) {
        pir_int_mul(&corner.c[k], &line->f, &v.c[k]);
        pir_int_sub(&corner.c[k], &corner.c[k], &line->origin.c[k]);
    }
    pir_int3_dot(&made.s, n, &corner, line->limbs);
    pir_int3_dot(&made.d, n, &line->way, line->limbs);
    pir_int_negate(&made.d);
    line->limbs->used = mark;
    return made;
}

/* Clips by the half-space with outward normal `n` through a vertex; `number` tells it, `normal` is for the entry. */
static void clip_by(struct exact_line *line, const pir_int3 *n, uint32_t vertex, uint32_t number, pir_vec3 normal) {
    uint32_t mark = line->limbs->used;
    struct ray_crossing at = crossing_of(line, n, vertex);
    at.facet = number;
    at.normal = normal;
    const int s = pir_int_sign(&at.s), d = pir_int_sign(&at.d);
    if (line->p->dimension == 2 && number == 0)
        line->side = d;
    line->inside &= s > 0;
    line->misses |= s < 0 && d <= 0;
    if (s == 0 && line->on == UINT32_MAX) {
        line->on = number;
        line->on_normal = normal;
    }
    if (d > 0 && compare(line, &at, &line->enter) > 0)
        keep(&line->enter, &at);
    else if (d < 0 && compare(line, &at, &line->leave) < 0)
        keep(&line->leave, &at);
    line->limbs->used = mark;
}

/* The plane as two half-spaces. */
static void clip_by_plane(struct exact_line *line, pir_int3 n, uint32_t vertex, pir_vec3 normal) {
    for (int side = 0; side < 2; side++) {
        clip_by(line, &n, vertex, 0, normal);
        for (int k = 0; k < 3; k++)
            pir_int_negate(&n.c[k]);
    }
}

static void clip_by_facets(struct exact_line *line) {
    const pir_polytope *p = line->p;
    for (uint32_t f = 0; f < p->facet_count && !line->misses; f++) {
        pir_int3 n = pir_normal_exact(p, f);
        clip_by(line, &n, p->origin[p->loop[p->loop_start[f]]], f, p->normal[f]);
    }
}

static void clip_by_walls(struct exact_line *line) {
    const pir_polytope *p = line->p;
    pir_int3 n = pir_normal_exact(p, 0);
    for (uint32_t i = p->loop_start[0]; i < p->loop_start[1] && !line->misses; i++) {
        uint32_t mark = line->limbs->used, half = p->loop[i];
        pir_int3 e = pir_half_exact(p, half), wall = pir_int3_take(line->limbs, limbs_of_normal(p));
        pir_int3_cross(&wall, &e, &n, line->limbs);
        clip_by(line, &wall, p->origin[half], p->facet_count + i, pir_wall_normal(p, 0, half));
        line->limbs->used = mark;
    }
}

/* The k-th axis, or, for a segment along e, the axis × e. */
static void clip_by_axes(struct exact_line *line, const pir_int3 *e, pir_vec3 normal) {
    for (int k = 0; k < 3 && !line->misses; k++) {
        uint32_t mark = line->limbs->used;
        mp_limb_t one = 1;
        pir_int3 n = {0};
        if (e) {
            n.c[(k + 1) % 3] = e->c[(k + 2) % 3];
            n.c[(k + 2) % 3] = e->c[(k + 1) % 3];
            pir_int_negate(&n.c[(k + 1) % 3]);
        } else {
            n.c[k] = (pir_int){&one, 1, 0};
        }
        clip_by_plane(line, n, 0, normal);
        line->limbs->used = mark;
    }
}

static void clip_by_ends(struct exact_line *line, pir_vec3 normal) {
    const pir_polytope *p = line->p;
    for (uint32_t v = 0; v < 2; v++) {
        // the edge leaves vertex 0 towards vertex 1
        pir_int3 n = pir_half_exact(p, p->edge_half[0]);
        for (int k = 0; k < 3 && v == 0; k++)
            pir_int_negate(&n.c[k]);
        clip_by(line, &n, v, v, normal);
    }
}

static double time_of(const struct ray_crossing *at) {
    int es, ed;
    double s = pir_int_to_double(&at->s, &es), d = pir_int_to_double(&at->d, &ed);
    return s == 0 ? 0 : fmin(ldexp(-s / d, es - ed), 1);
}

pir_entry pir_ray_exact(const pir_polytope *p, const pir_world_ray *ray, pir_pose pose, const pir_ray_segment *segment,
                        pir_exact_room *room) {
    const pir_vec3 against = pir_against(segment->way);
    pir_rotation rotation = {.integers = room->integers};
    pir_rotation_set_given(&rotation, pose.rotation);
    pir_rotation_make_exact(&rotation);
    room->limbs.used = 0;
    struct exact_line line = {.p = p, .limbs = &room->limbs, .inside = true, .on = UINT32_MAX};
    set_line(&line, ray, pose, &rotation);
    line.enter = end_of(&line, 0);
    line.leave = end_of(&line, 1);
    if (p->dimension >= 2)
        clip_by_facets(&line);
    if (p->dimension == 2)
        clip_by_walls(&line);
    if (p->dimension == 1) {
        pir_int3 e = pir_half_exact(p, p->edge_half[0]);
        clip_by_axes(&line, &e, against);
        clip_by_ends(&line, against);
    }
    if (p->dimension == 0)
        clip_by_axes(&line, NULL, against);
    if (line.misses || compare(&line, &line.enter, &line.leave) > 0)
        return (pir_entry){.hits = false, .time = 1};
    if (line.inside)
        return (pir_entry){true, true, 0, p->normal[pir_least_facet(p, segment->from)], 0};
    bool begins = line.enter.facet == UINT32_MAX;
    return (pir_entry){true, false, begins ? 0 : time_of(&line.enter), begins ? line.on_normal : line.enter.normal,
                       line.side};
}
