/* SPDX-License-Identifier: MIT */
/* Exact numbers of an obstacle: see obstacle.h. Planes and points are integers without a common factor. */
#include "solid/depth/obstacle.h"

#include "base/vec.h"
#include "solid/space/exact.h"

/* `count` numbers in a row, to be set. */
static uint32_t take(pir_obstacle *o, uint32_t count) {
    while (o->number_count + count > o->number_made) {
        if (!pir_obstacle_grow(o, (void **)&o->number, &o->number_room, o->number_made, sizeof *o->number))
            return 0;
        mpz_init(o->number[o->number_made++]);
    }
    o->number_count += count;
    return o->number_count - count;
}

/* Numbers of scratch, without their common factor, as new ones. */
static uint32_t keep(pir_obstacle *o, mpz_t *made, uint32_t count) {
    const uint32_t first = take(o, count);
    if (o->status != PIR_OK)
        return 0;
    for (uint32_t k = 0; k < count; k++)
        mpz_swap(o->number[first + k], made[k]);
    return first;
}

static void split_pair(const pir_obstacle *o, uint32_t pair, uint32_t piece[2]) {
    const uint32_t of_q = o->frame.body[1].of->count;
    piece[0] = pair / of_q;
    piece[1] = pair % of_q;
}

/* --- planes --- */

/* ret = n·x of a point of four numbers, over its W. */
static void height_of(mpz_ptr ret, mpz_t *n, mpz_t *x) {
    pir_numbers_dot(ret, n, x, 3);
}

/* num/den = the greatest height of a vertex of a piece along n; t[12..16] are scratch. */
static void highest(pir_obstacle *o, int side, uint32_t i, mpz_t *n, mpz_ptr num, mpz_ptr den) {
    mpz_t *x = o->t + 12;
    const pir_compound *c = o->frame.body[side].of;
    for (uint32_t v = 0; v < c->vertex_start[i + 1] - c->vertex_start[i]; v++) {
        pir_piece_frame_vertex(&o->frame, side, i, v, x);
        height_of(o->t[16], n, x);
        // vertices of one piece have one denominator
        if (v == 0 || mpz_cmp(o->t[16], num) > 0)
            mpz_set(num, o->t[16]);
        mpz_set(den, x[3]);
    }
}

/* The outward normal of a plane, of any length. */
static void normal_of(pir_obstacle *o, const pir_obstacle_plane *f, const uint32_t piece[2], mpz_t *n) {
    if (f->kind != PIR_OBSTACLE_EDGES) {
        const int side = f->kind == PIR_OBSTACLE_Q_FACET;
        pir_piece_frame_normal(&o->frame, side, piece[side], side ? f->q : f->p, n);
        return;
    }
    pir_piece_frame_along(&o->frame, 0, piece[0], f->p, o->t + 12);
    pir_piece_frame_along(&o->frame, 1, piece[1], f->q, o->t + 15);
    pir_numbers_cross(n, o->t + 12, o->t + 15);
    for (int k = 0; k < 3 && f->turned; k++)
        mpz_neg(n[k], n[k]);
}

/* A plane x_axis = ±3/16 of the box, as a half-space that holds it. */
static void make_box_plane(pir_obstacle *o, uint32_t which, mpz_t *made) {
    for (int k = 0; k < 4; k++)
        mpz_set_si(made[k], 0);
    mpz_set_si(made[which / 2], which & 1 ? -1 : 1);
    mpz_set_ui(made[3], 3);
    const int exponent = o->frame.exponent - 4;
    if (exponent >= 0)
        mpz_mul_2exp(made[3], made[3], (mp_bitcnt_t)exponent);
    else
        mpz_mul_2exp(made[which / 2], made[which / 2], (mp_bitcnt_t)-exponent);
}

/* The wall through two points across a plane. */
static void make_wall(pir_obstacle *o, const pir_obstacle_plane *wall, mpz_t *made) {
    const uint32_t facet = pir_obstacle_exact_plane(o, wall->pair);
    const uint32_t from = pir_obstacle_exact_point(o, wall->p), to = pir_obstacle_exact_point(o, wall->q);
    if (o->status != PIR_OK)
        return;
    mpz_t *x = o->number + from, *y = o->number + to, *side = o->t + 4;
    for (int k = 0; k < 3; k++) {
        mpz_mul(side[k], y[k], x[3]);
        mpz_submul(side[k], x[k], y[3]);
    }
    pir_numbers_cross(made, side, o->number + facet);
    for (int k = 0; k < 3 && wall->turned; k++)
        mpz_neg(made[k], made[k]);
    pir_numbers_dot(made[3], made, x, 3);
    for (int k = 0; k < 3; k++)
        mpz_mul(made[k], made[k], x[3]);
}

uint32_t pir_obstacle_exact_plane(pir_obstacle *obstacle, uint32_t plane) {
    pir_obstacle *o = obstacle;
    if (o->plane[plane].exact != PIR_OBSTACLE_NONE)
        return o->plane[plane].exact;
    const pir_obstacle_plane f = o->plane[plane];
    mpz_t *made = o->t;
    if (f.kind == PIR_OBSTACLE_BOX) {
        make_box_plane(o, f.pair, made);
    } else if (f.kind == PIR_OBSTACLE_WALL) {
        make_wall(o, &f, made);
    } else {
        uint32_t piece[2];
        split_pair(o, f.pair, piece);
        normal_of(o, &f, piece, made);
        // heights h/w of both: n·x ≤ h_0/w_0 + h_1/w_1
        for (int side = 0; side < 2; side++)
            highest(o, side, piece[side], made, o->t[4 + 2 * side], o->t[5 + 2 * side]);
        mpz_mul(made[3], o->t[4], o->t[7]);
        mpz_addmul(made[3], o->t[6], o->t[5]);
        mpz_mul(o->t[5], o->t[5], o->t[7]);
        for (int k = 0; k < 3; k++)
            mpz_mul(made[k], made[k], o->t[5]);
    }
    const uint32_t exact = keep(o, made, 4);
    if (o->status == PIR_OK)
        o->plane[plane].exact = exact;
    return exact;
}

int pir_obstacle_exact_slope(pir_obstacle *obstacle, int side, const uint32_t piece[2], uint32_t face, uint32_t edge) {
    pir_obstacle *o = obstacle;
    pir_piece_frame_normal(&o->frame, side, piece[side], face, o->t);
    pir_piece_frame_along(&o->frame, 1 - side, piece[1 - side], edge, o->t + 3);
    pir_numbers_dot(o->t[6], o->t, o->t + 3, 3);
    return mpz_sgn(o->t[6]);
}

/* --- points --- */

/* Where three planes meet, by Cramer's rule; its W may be below 0. */
static void make_meet(pir_obstacle *o, mpz_t *ret, const uint32_t exact[3]) {
    mpz_t *cross = o->t + 4;
    for (int k = 0; k < 4; k++)
        mpz_set_ui(ret[k], 0);
    for (int i = 0; i < 3; i++) {
        mpz_t *f = o->number + exact[i];
        pir_numbers_cross(cross, o->number + exact[(i + 1) % 3], o->number + exact[(i + 2) % 3]);
        for (int k = 0; k < 3; k++)
            mpz_addmul(ret[k], f[3], cross[k]);
        if (i == 0)
            pir_numbers_dot(ret[3], f, cross, 3);
    }
}

/* ret = how far the place X/W is from a plane, times W and the length of its normal: n·X − d·W. */
static void height_over(mpz_ptr ret, mpz_t *f, mpz_t *x) {
    pir_numbers_dot(ret, f, x, 3);
    mpz_submul(ret, f[3], x[3]);
}

/* The foot on a plane: x − n·(n·x − d)/(n·n). */
static void make_foot(pir_obstacle *o, mpz_t *ret, mpz_t *f, mpz_t *x) {
    mpz_ptr square = o->t[4], over = o->t[5];
    pir_numbers_dot(square, f, f, 3);
    height_over(over, f, x);
    for (int k = 0; k < 3; k++) {
        mpz_mul(ret[k], x[k], square);
        mpz_submul(ret[k], f[k], over);
    }
    mpz_mul(ret[3], x[3], square);
}

/* The foot on the line where f and g meet: x − α·f − β·g with (α, β) from the normals' inner products. */
static void make_line_foot(pir_obstacle *o, mpz_t *ret, mpz_t *f, mpz_t *g, mpz_t *x) {
    mpz_t *t = o->t + 4; // ff, gg, fg, over f, over g, α, β
    pir_numbers_dot(t[0], f, f, 3);
    pir_numbers_dot(t[1], g, g, 3);
    pir_numbers_dot(t[2], f, g, 3);
    height_over(t[3], f, x);
    height_over(t[4], g, x);
    mpz_mul(t[5], t[3], t[1]);
    mpz_submul(t[5], t[4], t[2]);
    mpz_mul(t[6], t[4], t[0]);
    mpz_submul(t[6], t[3], t[2]);
    mpz_mul(ret[3], t[0], t[1]);
    mpz_submul(ret[3], t[2], t[2]);
    for (int k = 0; k < 3; k++) {
        mpz_mul(ret[k], x[k], ret[3]);
        mpz_submul(ret[k], f[k], t[5]);
        mpz_submul(ret[k], g[k], t[6]);
    }
    mpz_mul(ret[3], ret[3], x[3]);
}

/* The direction of the way: where its numbers are. */
static uint32_t exact_way(pir_obstacle *o) {
    if (o->exact_way == PIR_OBSTACLE_NONE) {
        pir_piece_frame_turn_back(&o->frame, o->world_way, o->t);
        o->exact_way = keep(o, o->t, 3);
    }
    return o->exact_way;
}

/* Where the way from x meets a plane: x − u·(n·x − d)/(n·u). */
static void make_on_way(pir_obstacle *o, mpz_t *ret, mpz_t *f, mpz_t *x, mpz_t *u) {
    mpz_ptr slope = o->t[4], over = o->t[5];
    pir_numbers_dot(slope, f, u, 3);
    height_over(over, f, x);
    for (int k = 0; k < 3; k++) {
        mpz_mul(ret[k], x[k], slope);
        mpz_submul(ret[k], u[k], over);
    }
    mpz_mul(ret[3], x[3], slope);
}

/* The sum of two vertices, by their numbers in the bodies. */
static void make_vertices(pir_obstacle *o, mpz_t *ret, const uint32_t of[2]) {
    mpz_t *x = o->t + 4, *y = o->t + 8;
    for (int side = 0; side < 2; side++) {
        const pir_compound *c = o->frame.body[side].of;
        uint32_t i = 0;
        while (c->vertex_start[i + 1] <= of[side])
            i++;
        pir_piece_frame_vertex(&o->frame, side, i, of[side] - c->vertex_start[i], side ? y : x);
    }
    for (int k = 0; k < 3; k++) {
        mpz_mul(ret[k], x[k], y[3]);
        mpz_addmul(ret[k], y[k], x[3]);
    }
    mpz_mul(ret[3], x[3], y[3]);
}

uint32_t pir_obstacle_exact_point(pir_obstacle *obstacle, uint32_t point) {
    pir_obstacle *o = obstacle;
    if (o->point[point].exact != PIR_OBSTACLE_NONE)
        return o->point[point].exact;
    const pir_obstacle_point p = o->point[point];
    uint32_t of[3] = {0}, place = 0;
    if (p.kind != PIR_OBSTACLE_PLACE && p.kind != PIR_OBSTACLE_MEET && p.kind != PIR_OBSTACLE_VERTICES)
        place = pir_obstacle_exact_point(o, 0);
    for (int k = 0; k < 3 && p.kind != PIR_OBSTACLE_VERTICES; k++)
        of[k] = p.of[k] == PIR_OBSTACLE_NONE ? 0 : pir_obstacle_exact_plane(o, p.of[k]);
    const uint32_t way = p.kind == PIR_OBSTACLE_ON_WAY ? exact_way(o) : 0;
    if (o->status != PIR_OK)
        return 0;
    mpz_t *made = o->t, *n = o->number;
    if (p.kind == PIR_OBSTACLE_VERTICES)
        make_vertices(o, made, p.of);
    else if (p.kind == PIR_OBSTACLE_PLACE)
        pir_piece_frame_translation(&o->frame, made);
    else if (p.kind == PIR_OBSTACLE_ON_PLANE)
        make_foot(o, made, n + of[0], n + place);
    else if (p.kind == PIR_OBSTACLE_ON_LINE)
        make_line_foot(o, made, n + of[0], n + of[1], n + place);
    else if (p.kind == PIR_OBSTACLE_MEET)
        make_meet(o, made, of);
    else
        make_on_way(o, made, n + of[0], n + place, n + way);
    if (mpz_sgn(made[3]) == 0) {
        o->status = PIR_ERR_INTERNAL;
        return 0;
    }
    const bool reversed = mpz_sgn(made[3]) < 0;
    for (int k = 0; k < 4 && reversed; k++)
        mpz_neg(made[k], made[k]);
    const uint32_t exact = keep(o, made, 4);
    if (o->status == PIR_OK)
        o->point[point].exact = exact;
    return exact;
}

/* --- signs --- */

int pir_obstacle_exact_side(pir_obstacle *obstacle, uint32_t plane, uint32_t point) {
    pir_obstacle *o = obstacle;
    const uint32_t f = pir_obstacle_exact_plane(o, plane), x = pir_obstacle_exact_point(o, point);
    if (o->status != PIR_OK)
        return 0;
    height_over(o->t[0], o->number + f, o->number + x);
    return mpz_sgn(o->t[0]);
}

int pir_obstacle_exact_rate(pir_obstacle *obstacle, uint32_t plane) {
    pir_obstacle *o = obstacle;
    const uint32_t f = pir_obstacle_exact_plane(o, plane), way = exact_way(o);
    if (o->status != PIR_OK)
        return 0;
    pir_numbers_dot(o->t[0], o->number + f, o->number + way, 3);
    return mpz_sgn(o->t[0]);
}

/* ret[0..2] = (X·W' − X'·W), the way from the place X'/W' times both W, which are ret[3]. */
static void way_to(pir_obstacle *o, uint32_t point, mpz_t *ret) {
    const uint32_t at = pir_obstacle_exact_point(o, point), from = pir_obstacle_exact_point(o, 0);
    mpz_t *x = o->number + at, *y = o->number + from;
    for (int k = 0; k < 3; k++) {
        mpz_mul(ret[k], x[k], y[3]);
        mpz_submul(ret[k], y[k], x[3]);
    }
    mpz_mul(ret[3], x[3], y[3]);
}

int pir_obstacle_exact_nearer(pir_obstacle *obstacle, uint32_t a, uint32_t b) {
    pir_obstacle *o = obstacle;
    const uint32_t point[2] = {a, b};
    for (int i = 0; i < 2; i++) {
        pir_obstacle_exact_point(o, point[i]);
        if (o->status != PIR_OK)
            return 0;
    }
    for (int i = 0; i < 2; i++) {
        way_to(o, point[i], o->t + 4);
        pir_numbers_dot(o->t[2 * i], o->t + 4, o->t + 4, 3);
        mpz_mul(o->t[2 * i + 1], o->t[7], o->t[7]);
    }
    mpz_mul(o->t[0], o->t[0], o->t[3]);
    mpz_mul(o->t[2], o->t[2], o->t[1]);
    return mpz_cmp(o->t[0], o->t[2]);
}

int pir_obstacle_exact_order(pir_obstacle *obstacle, uint32_t a, uint32_t b) {
    pir_obstacle *o = obstacle;
    const uint32_t first = pir_obstacle_exact_point(o, a), second = pir_obstacle_exact_point(o, b);
    if (o->status != PIR_OK)
        return 0;
    mpz_t *x = o->number + first, *y = o->number + second;
    int order = 0;
    for (int k = 0; k < 3 && order == 0; k++) {
        mpz_mul(o->t[0], x[k], y[3]);
        mpz_mul(o->t[1], y[k], x[3]);
        order = mpz_cmp(o->t[0], o->t[1]);
    }
    return order;
}

bool pir_obstacle_is_along(pir_obstacle *obstacle, uint32_t point, uint32_t f, uint32_t g) {
    pir_obstacle *o = obstacle;
    const uint32_t a = pir_obstacle_exact_plane(o, f), b = pir_obstacle_exact_plane(o, g);
    pir_obstacle_exact_point(o, point);
    pir_obstacle_exact_point(o, 0);
    if (o->status != PIR_OK)
        return false;
    way_to(o, point, o->t);
    pir_numbers_cross(o->t + 4, o->number + a, o->t);
    if (f == g)
        return mpz_sgn(o->t[4]) == 0 && mpz_sgn(o->t[5]) == 0 && mpz_sgn(o->t[6]) == 0;
    pir_numbers_dot(o->t[7], o->t + 4, o->number + b, 3);
    pir_numbers_cross(o->t + 8, o->number + a, o->number + b);
    const bool independent = mpz_sgn(o->t[8]) != 0 || mpz_sgn(o->t[9]) != 0 || mpz_sgn(o->t[10]) != 0;
    return independent && mpz_sgn(o->t[7]) == 0;
}

bool pir_obstacle_are_independent(pir_obstacle *obstacle, const uint32_t *plane, uint32_t count, uint32_t other) {
    pir_obstacle *o = obstacle;
    const uint32_t a = pir_obstacle_exact_plane(o, plane[0]), b = pir_obstacle_exact_plane(o, other);
    const uint32_t c = count > 1 ? pir_obstacle_exact_plane(o, plane[1]) : a;
    if (o->status != PIR_OK)
        return false;
    pir_numbers_cross(o->t, o->number + a, o->number + (count > 1 ? c : b));
    if (count == 1)
        return mpz_sgn(o->t[0]) != 0 || mpz_sgn(o->t[1]) != 0 || mpz_sgn(o->t[2]) != 0;
    pir_numbers_dot(o->t[3], o->t, o->number + b, 3);
    return mpz_sgn(o->t[3]) != 0;
}

/* --- rounding --- */

/* num/den times 2^-exponent of the frame. mpz_get_d_2exp cuts off: within 2^-51 of it, relative to it. */
static double ratio(mpz_srcptr num, mpz_srcptr den, int exponent) {
    long e, f;
    const double a = mpz_get_d_2exp(&e, num), b = mpz_get_d_2exp(&f, den);
    const long power = e - f - exponent;
    return a == 0 || power < -1000 ? 0 : ldexp(a / b, power < 1000 ? (int)power : 1000);
}

void pir_obstacle_round_point(pir_obstacle *obstacle, uint32_t point) {
    pir_obstacle_point *p = &obstacle->point[point];
    mpz_t *x = obstacle->number + p->exact;
    for (int k = 0; k < 3; k++)
        p->x[k] = ratio(x[k], x[3], obstacle->frame.exponent);
    const bool near = fabs(p->x[0]) <= 1 && fabs(p->x[1]) <= 1 && fabs(p->x[2]) <= 1;
    p->err = near ? 0x1p-50 : HUGE_VAL;
}

/* The normal is within 2^-50, its height within 2^-50 of itself. */
void pir_obstacle_round_plane(pir_obstacle *obstacle, uint32_t plane) {
    pir_obstacle_plane *f = &obstacle->plane[plane];
    mpz_t *a = obstacle->number + f->exact;
    long e[3], top = 0, scale;
    double m[3];
    bool any = false;
    for (int k = 0; k < 3; k++) {
        m[k] = mpz_get_d_2exp(&e[k], a[k]);
        top = m[k] != 0 && (!any || e[k] > top) ? e[k] : top;
        any = any || m[k] != 0;
    }
    for (int k = 0; k < 3; k++)
        f->n[k] = m[k] == 0 || top - e[k] > 200 ? 0 : ldexp(m[k], (int)(e[k] - top));
    const double length = sqrt(f->n[0] * f->n[0] + f->n[1] * f->n[1] + f->n[2] * f->n[2]);
    for (int k = 0; k < 3; k++)
        f->n[k] /= length;
    const double d = mpz_get_d_2exp(&scale, a[3]);
    const long power = scale - top - obstacle->frame.exponent;
    f->d = d == 0 || power < -300 ? 0 : ldexp(d / length, (int)power);
    f->err = 0x1p-47;
}

double pir_obstacle_exact_way(pir_obstacle *obstacle, uint32_t point, double ret_way[3]) {
    pir_obstacle *o = obstacle;
    pir_obstacle_exact_point(o, point);
    pir_obstacle_exact_point(o, 0);
    if (o->status != PIR_OK)
        return 0;
    way_to(o, point, o->t);
    // in lowest terms the numbers do not depend on how the point was made
    pir_numbers_reduce(o->t, 4, o->t[23]);
    for (int k = 0; k < 3; k++)
        ret_way[k] = ratio(o->t[k], o->t[3], o->frame.exponent);
    return sqrt(ret_way[0] * ret_way[0] + ret_way[1] * ret_way[1] + ret_way[2] * ret_way[2]);
}
