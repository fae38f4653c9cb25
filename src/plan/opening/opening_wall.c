/* SPDX-License-Identifier: MIT */
/* See opening_wall.h. */
#include "plan/opening/opening_wall.h"

#include <math.h>
#include <stdlib.h>

#include <pirouette/mass.h>

/* Parts that holes may have in all; halvings of how much a section is widened. */
#define MOST_PARTS    1024
#define MOST_HALVINGS 128
#define MIDDLE_BITS   64

/* --- pieces --- */

static pir_status make_facets(const pir_polytope *piece, const pir_opening_body *body, pir_opening_half **ret_facet) {
    const uint32_t count = pir_polytope_facet_count(piece);
    uint32_t most = 1;
    for (uint32_t f = 0; f < count; f++)
        most = pir_polytope_facet_size(piece, f) > most ? pir_polytope_facet_size(piece, f) : most;
    uint32_t *corner = calloc(most, sizeof *corner);
    *ret_facet = calloc(count + 1, sizeof **ret_facet);
    const bool good = corner && *ret_facet;
    for (uint32_t f = 0; f < count && good; f++) {
        pir_polytope_facet(piece, f, corner);
        pir_opening_half_init(&(*ret_facet)[f]);
        pir_opening_half_of_facet((const mpq_t(*)[3])body->exact, corner, &(*ret_facet)[f]);
    }
    free(corner);
    return good ? PIR_OK : PIR_ERR_MEMORY;
}

static void free_facets(const pir_polytope *piece, pir_opening_half *facet) {
    for (uint32_t f = 0; facet && f < pir_polytope_facet_count(piece); f++)
        pir_opening_half_clear(&facet[f]);
    free(facet);
}

/* Lessens `room` to a part of how far a point within a piece is from its facets: to a double that is hardly less. */
static void take_room(const pir_polytope *piece, const pir_opening_half *facet, const mpq_t point[3], mpq_t room) {
    mpq_t value, t, own;
    mpq_inits(value, t, own, NULL);
    for (uint32_t f = 0; f < pir_polytope_facet_count(piece); f++) {
        // the square of the part of the distance
        pir_opening_half_value(&facet[f], point, value);
        mpq_div_2exp(value, value, PIR_OPENING_SHRINK);
        mpq_mul(value, value, value);
        mpq_set_ui(own, 0, 1);
        for (int k = 0; k < 3; k++) {
            mpq_mul(t, facet[f].m[k], facet[f].m[k]);
            mpq_add(own, own, t);
        }
        mpq_div(value, value, own);
        mpq_set_d(own, sqrt(mpq_get_d(value)) * (1 - 0x1p-40));
        mpq_mul(t, own, own);
        if (mpq_cmp(t, value) > 0)
            mpq_set_ui(own, 0, 1);
        if (mpq_sgn(room) < 0 || mpq_cmp(own, room) < 0)
            mpq_set(room, own);
    }
    mpq_clears(value, t, own, NULL);
}

/* Makes a piece of the robot smaller about the point within it. */
static pir_status shrink(const pir_polytope *piece, const mpq_t point[3], pir_opening_body *body, mpq_t room) {
    pir_opening_half *facet = NULL;
    const pir_status status = make_facets(piece, body, &facet);
    if (status == PIR_OK) {
        take_room(piece, facet, point, room);
        pir_opening_body_shrink(body, point, PIR_OPENING_SHRINK);
    }
    free_facets(piece, facet);
    return status;
}

/* The mean of vertices, and how far it is at most, as a sum of sizes. */
static void mean_of(const pir_opening_body *body, mpq_t mean[3], mpq_t far) {
    mpq_t t;
    mpq_init(t);
    mpq_set_ui(far, 0, 1);
    for (int k = 0; k < 3; k++) {
        for (uint32_t v = 0; v < body->vertices; v++)
            mpq_add(mean[k], mean[k], body->exact[v][k]);
        mpq_set_ui(t, body->vertices, 1);
        mpq_div(mean[k], mean[k], t);
        mpq_abs(t, mean[k]);
        mpq_add(far, far, t);
    }
    mpq_clear(t);
}

/* A piece of the robot at an end. */
static pir_status make_end(const pir_plan_asked *question, uint32_t piece, int end, pir_opening_body *ret_body) {
    const double *x = question->at[end];
    const pir_pose pose = {question->rotation[end], {x[0], x[1], x[2]}};
    pir_polytope *moved = NULL;
    pir_status status = pir_polytope_transform(question->robot->at[piece], pose, &moved);
    if (status == PIR_OK)
        status = pir_opening_body_make(moved, ret_body);
    pir_polytope_release(moved);
    return status;
}

pir_status pir_opening_parts_make(const pir_plan_asked *question, pir_opening_parts *ret_parts) {
    const uint32_t robots = question->robot->count, obstacles = question->obstacles->count;
    pir_opening_parts p = {.question = *question,
                           .robot = calloc(robots + 1, sizeof *p.robot),
                           .obstacle = calloc(obstacles + 1, sizeof *p.obstacle),
                           .at = {calloc(robots + 1, sizeof **p.at), calloc(robots + 1, sizeof **p.at)},
                           .facet = calloc(obstacles + 1, sizeof *p.facet),
                           .point = calloc(robots + 1, sizeof *p.point)};
    mpq_t far;
    mpq_inits(p.reach, p.room, far, NULL);
    mpq_set_si(p.room, -1, 1);
    pir_status status = p.robot && p.obstacle && p.at[0] && p.at[1] && p.facet && p.point ? PIR_OK : PIR_ERR_MEMORY;
    for (uint32_t i = 0; i < robots && p.point; i++)
        mpq_inits(p.point[i][0], p.point[i][1], p.point[i][2], NULL);
    for (uint32_t i = 0; i < robots && status == PIR_OK; i++) {
        status = pir_opening_body_make(question->robot->at[i], &p.robot[i]);
        for (int end = 0; end < 2 && status == PIR_OK; end++)
            status = make_end(question, i, end, &p.at[end][i]);
        if (status == PIR_OK)
            mean_of(&p.robot[i], p.point[i], far);
        if (mpq_cmp(far, p.reach) > 0)
            mpq_set(p.reach, far);
        if (status == PIR_OK)
            status = shrink(question->robot->at[i], (const mpq_t *)p.point[i], &p.robot[i], p.room);
    }
    for (uint32_t i = 0; i < obstacles && status == PIR_OK; i++) {
        status = pir_opening_body_make(question->obstacles->at[i], &p.obstacle[i]);
        if (status == PIR_OK)
            status = make_facets(question->obstacles->at[i], &p.obstacle[i], &p.facet[i]);
    }
    mpq_clear(far);
    *ret_parts = p;
    return status;
}

void pir_opening_parts_finish(pir_opening_parts *parts) {
    for (uint32_t i = 0; i < parts->question.robot->count; i++) {
        if (parts->robot)
            pir_opening_body_finish(&parts->robot[i]);
        for (int end = 0; end < 2; end++)
            if (parts->at[end])
                pir_opening_body_finish(&parts->at[end][i]);
        if (parts->point)
            mpq_clears(parts->point[i][0], parts->point[i][1], parts->point[i][2], NULL);
    }
    for (uint32_t i = 0; i < parts->question.obstacles->count; i++) {
        if (parts->facet)
            free_facets(parts->question.obstacles->at[i], parts->facet[i]);
        if (parts->obstacle)
            pir_opening_body_finish(&parts->obstacle[i]);
    }
    free(parts->robot);
    free(parts->at[0]);
    free(parts->at[1]);
    free(parts->obstacle);
    free(parts->facet);
    free(parts->point);
    mpq_clears(parts->reach, parts->room, NULL);
    *parts = (pir_opening_parts){0};
}

/* --- which pieces have to pass --- */

/* On which side of a half-space's plane a piece is at an end, strictly; 0 where on both. */
static int side_at(const pir_opening_body *body, const pir_opening_half *plane) {
    mpq_t value;
    int side = 2;
    mpq_init(value);
    for (uint32_t v = 0; v < body->vertices && side != 0; v++) {
        pir_opening_half_value(plane, (const mpq_t *)body->exact[v], value);
        const int sign = mpq_sgn(value);
        side = side == 2 || side == sign ? sign : 0;
    }
    mpq_clear(value);
    return side;
}

/* Lists the pieces that are on the first side at the start, and on the other at the goal. */
static bool list_pieces(const pir_opening_parts *parts, const pir_opening_half *plane, pir_opening_wall *wall) {
    wall->piece = calloc(parts->question.robot->count + 1, sizeof *wall->piece);
    for (uint32_t i = 0; i < parts->question.robot->count && wall->piece; i++)
        if (side_at(&parts->at[0][i], plane) < 0 && side_at(&parts->at[1][i], plane) > 0)
            wall->piece[wall->pieces++] = i;
    return wall->piece;
}

/* --- what obstacles and holes have of the plane --- */

/* Cuts a polygon, which is replaced. */
static bool cut(pir_opening_polygon *polygon, const pir_opening_half *half) {
    pir_opening_polygon part;
    if (!pir_opening_polygon_clip(polygon, half, false, false, &part))
        return false;
    pir_opening_polygon_free(polygon);
    *polygon = part;
    return true;
}

/* A square in the plane about the point nearest to the origin, of half the size. */
static bool make_square(const pir_opening_half *plane, const mpq_t size, pir_opening_polygon *ret_square) {
    int axis = 0;
    mpq_t e[2][3], nn, t;
    if (!pir_opening_polygon_new(4, ret_square))
        return false;
    mpq_inits(nn, t, NULL);
    for (int k = 0; k < 3; k++) {
        mpq_inits(e[0][k], e[1][k], NULL);
        mpq_mul(t, plane->m[k], plane->m[k]);
        mpq_add(nn, nn, t);
        if (fabs(mpq_get_d(plane->m[k])) < fabs(mpq_get_d(plane->m[axis])))
            axis = k;
    }
    // e0 = axis × n, e1 = n × e0: long as n is, or longer
    mpq_neg(e[0][(axis + 1) % 3], plane->m[(axis + 2) % 3]);
    mpq_set(e[0][(axis + 2) % 3], plane->m[(axis + 1) % 3]);
    for (int k = 0; k < 3; k++) {
        mpq_mul(e[1][k], plane->m[(k + 1) % 3], e[0][(k + 2) % 3]);
        mpq_mul(t, plane->m[(k + 2) % 3], e[0][(k + 1) % 3]);
        mpq_sub(e[1][k], e[1][k], t);
    }
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++) {
            mpq_mul(t, plane->m[k], plane->c);
            mpq_div(ret_square->at[i][k], t, nn);
            for (int d = 0; d < 2; d++) {
                const bool is_up = d == 0 ? i == 0 || i == 3 : i == 0 || i == 1;
                mpq_mul(t, e[d][k], size);
                if (is_up)
                    mpq_add(ret_square->at[i][k], ret_square->at[i][k], t);
                else
                    mpq_sub(ret_square->at[i][k], ret_square->at[i][k], t);
            }
        }
    for (int k = 0; k < 3; k++)
        mpq_clears(e[0][k], e[1][k], NULL);
    mpq_clears(nn, t, NULL);
    pir_opening_polygon_bound(ret_square);
    return true;
}

/* The places in the plane where the points of pieces can be. */
static bool make_places(const pir_opening_parts *parts, const pir_opening_half *plane,
                        pir_opening_polygon *ret_places) {
    pir_opening_half half;
    mpq_t size;
    double most = 1;
    for (int k = 0; k < 3; k++)
        most = fmax(most, fmax(fabs(parts->question.low[k]), fabs(parts->question.high[k])));
    mpq_init(size);
    mpq_set_d(size, most);
    mpq_add(size, size, parts->reach);
    mpq_mul_2exp(size, size, 4); // n is about 1 long, and its products no less than half
    bool good = make_square(plane, size, ret_places);
    pir_opening_half_init(&half);
    for (int i = 0; i < 6 && good && ret_places->count > 0; i++) {
        const int k = i / 2, sign = i % 2 ? -1 : 1;
        for (int j = 0; j < 3; j++)
            mpq_set_si(half.m[j], j == k ? sign : 0, 1);
        mpq_set_d(half.c, sign > 0 ? parts->question.high[k] : -parts->question.low[k]);
        mpq_add(half.c, half.c, parts->reach);
        good = cut(ret_places, &half);
    }
    pir_opening_half_clear(&half);
    mpq_clear(size);
    return good;
}

/* A square in the plane that has all obstacles. */
static bool make_around(const pir_opening_parts *parts, const pir_opening_half *plane,
                        pir_opening_polygon *ret_around) {
    mpq_t size;
    double most = fabs(mpq_get_d(plane->c));
    for (uint32_t i = 0; i < parts->question.obstacles->count; i++)
        most = fmax(most, parts->obstacle[i].reach);
    mpq_init(size);
    mpq_set_d(size, most);
    mpq_mul_2exp(size, size, 4);
    const bool good = make_square(plane, size, ret_around);
    mpq_clear(size);
    return good;
}

/* Whether a piece has vertices on both sides, strictly. */
static bool is_cut(const pir_opening_body *body, const pir_opening_half *plane) {
    bool has[3] = {false, false, false};
    const double n[3] = {mpq_get_d(plane->m[0]), mpq_get_d(plane->m[1]), mpq_get_d(plane->m[2])};
    // no coordinate of n is above 1 by more than roundings, so heights are within 2^-50 of the reach, as in may_meet
    const double d = mpq_get_d(plane->c), room = body->reach * 0x1p-40 + fabs(d) * 0x1p-40;
    double low = INFINITY, high = -INFINITY;
    for (uint32_t v = 0; v < body->vertices; v++) {
        low = fmin(low, pir_opening_height(body, v, n));
        high = fmax(high, pir_opening_height(body, v, n));
    }
    if (low > d + room || high < d - room)
        return false;
    mpq_t value;
    mpq_init(value);
    for (uint32_t v = 0; v < body->vertices && !(has[0] && has[2]); v++) {
        pir_opening_half_value(plane, (const mpq_t *)body->exact[v], value);
        has[mpq_sgn(value) + 1] = true;
    }
    mpq_clear(value);
    return has[0] && has[2];
}

/* Twice the area of a triangle about n, times its length: its sign is the turn's. */
static int turn_of(const mpq_t n[3], const mpq_t a[3], const mpq_t b[3], const mpq_t c[3], mpq_t scratch) {
    pir_opening_half half;
    pir_opening_half_init(&half);
    pir_opening_half_of_side(n, a, b, &half);
    pir_opening_half_value(&half, c, scratch);
    pir_opening_half_clear(&half);
    return -mpq_sgn(scratch);
}

static bool is_same(const mpq_t a[3], const mpq_t b[3]) {
    return mpq_equal(a[0], b[0]) && mpq_equal(a[1], b[1]) && mpq_equal(a[2], b[2]);
}

/* Whether b is between a and c, which are on a line. */
static bool is_between(const mpq_t a[3], const mpq_t b[3], const mpq_t c[3]) {
    for (int k = 0; k < 3; k++)
        if (mpq_cmp(a[k], b[k]) * mpq_cmp(b[k], c[k]) < 0)
            return false;
    return true;
}

/* The hull of points, one after another round it, without those on its sides. */
static bool make_hull(const mpq_t n[3], const mpq_t *const *point, uint32_t count, pir_opening_polygon *ret_hull) {
    uint32_t *of = calloc(count + 1, sizeof *of), corners = 0, at = 0;
    mpq_t scratch;
    if (!of)
        return false;
    mpq_init(scratch);
    for (uint32_t i = 1; i < count; i++)
        for (int k = 0; k < 3; k++) {
            const int order = mpq_cmp(point[i][k], point[at][k]);
            at = order < 0 ? i : at;
            if (order != 0)
                break;
        }
    do {
        of[corners++] = at;
        uint32_t next = at;
        for (uint32_t i = 0; i < count; i++) {
            if (is_same(point[i], point[at]))
                continue;
            const int side = next == at ? -1 : turn_of(n, point[at], point[next], point[i], scratch);
            if (side < 0 || (side == 0 && is_between(point[at], point[next], point[i])))
                next = i;
        }
        at = next;
    } while (corners < count && !is_same(point[at], point[of[0]]));
    const bool good = pir_opening_polygon_new(corners, ret_hull);
    for (uint32_t i = 0; i < corners && good; i++)
        for (int k = 0; k < 3; k++)
            mpq_set(ret_hull->at[i][k], point[of[i]][k]);
    if (good)
        pir_opening_polygon_bound(ret_hull);
    mpq_clear(scratch);
    free(of);
    return good;
}

/* Leaves out corners that are on sides. */
static bool replace_by_hull(const mpq_t n[3], pir_opening_polygon *polygon) {
    const mpq_t **point = calloc(polygon->count + 1, sizeof *point);
    pir_opening_polygon made = {0};
    for (uint32_t i = 0; i < polygon->count && point; i++)
        point[i] = (const mpq_t *)polygon->at[i];
    const bool good = point && make_hull(n, (const mpq_t *const *)point, polygon->count, &made);
    free(point);
    if (!good)
        return false;
    pir_opening_polygon_free(polygon);
    *polygon = made;
    return true;
}

/*
 * The mean of a polygon's corners, of which the two coordinates across the greatest of n are rounded down to multiples
 * of 2^-64, so that numbers stay short, and the third is that of the plane.
 */
static void middle_of(const pir_opening_half *plane, const pir_opening_polygon *polygon, mpq_t ret_middle[3]) {
    mpq_t t, u;
    int axis = 0;
    mpq_inits(t, u, NULL);
    for (int k = 1; k < 3; k++) {
        mpq_abs(t, plane->m[k]);
        mpq_abs(u, plane->m[axis]);
        axis = mpq_cmp(t, u) > 0 ? k : axis;
    }
    mpq_set(ret_middle[axis], plane->c);
    for (int k = (axis + 1) % 3; k != axis; k = (k + 1) % 3) {
        mpq_set_ui(ret_middle[k], 0, 1);
        for (uint32_t i = 0; i < polygon->count; i++)
            mpq_add(ret_middle[k], ret_middle[k], polygon->at[i][k]);
        mpq_set_ui(t, polygon->count, 1);
        mpq_div(t, ret_middle[k], t);
        mpq_mul_2exp(t, t, MIDDLE_BITS);
        mpz_fdiv_q(mpq_numref(ret_middle[k]), mpq_numref(t), mpq_denref(t));
        mpz_set_ui(mpq_denref(ret_middle[k]), 1);
        mpq_div_2exp(ret_middle[k], ret_middle[k], MIDDLE_BITS);
        mpq_mul(t, ret_middle[k], plane->m[k]);
        mpq_sub(ret_middle[axis], ret_middle[axis], t);
    }
    mpq_div(ret_middle[axis], ret_middle[axis], plane->m[axis]);
    mpq_clears(t, u, NULL);
}

/* Widens a polygon about its middle, by a power of two of its size such that no corner is moved by more than room. */
static void widen(const pir_opening_half *plane, const mpq_t room, pir_opening_polygon *polygon) {
    mpq_t mean[3], most, t, sum;
    mpq_inits(mean[0], mean[1], mean[2], most, t, sum, NULL);
    middle_of(plane, polygon, mean);
    for (uint32_t i = 0; i < polygon->count; i++) {
        mpq_set_ui(sum, 0, 1);
        for (int k = 0; k < 3; k++) {
            mpq_sub(t, polygon->at[i][k], mean[k]);
            mpq_abs(t, t);
            mpq_add(sum, sum, t);
        }
        if (mpq_cmp(sum, most) > 0)
            mpq_set(most, sum);
    }
    mp_bitcnt_t halvings = 0;
    for (; mpq_cmp(most, room) > 0 && halvings < MOST_HALVINGS; halvings++)
        mpq_div_2exp(most, most, 1);
    for (uint32_t i = 0; i < polygon->count && mpq_cmp(most, room) <= 0; i++)
        for (int k = 0; k < 3; k++) {
            mpq_sub(t, polygon->at[i][k], mean[k]);
            mpq_div_2exp(t, t, halvings);
            mpq_add(polygon->at[i][k], polygon->at[i][k], t);
        }
    pir_opening_polygon_bound(polygon);
    mpq_clears(mean[0], mean[1], mean[2], most, t, sum, NULL);
}

/* The sections of obstacles, widened. */
static bool make_sections(const pir_opening_parts *parts, const pir_opening_half *plane,
                          const pir_opening_polygon *around, pir_opening_polygons *ret_sections) {
    const pir_plan_pieces *pieces = parts->question.obstacles;
    for (uint32_t i = 0; i < pieces->count; i++) {
        if (!is_cut(&parts->obstacle[i], plane))
            continue;
        pir_opening_polygon section = {0};
        for (uint32_t f = 0; f < pir_polytope_facet_count(pieces->at[i]); f++) {
            pir_opening_polygon part;
            if (!pir_opening_polygon_clip(f == 0 ? around : &section, &parts->facet[i][f], false, false, &part)) {
                pir_opening_polygon_free(&section);
                return false;
            }
            pir_opening_polygon_free(&section);
            section = part;
            if (section.count == 0)
                break;
        }
        if (section.count == 0)
            continue;
        bool good = replace_by_hull((const mpq_t *)plane->m, &section);
        if (good)
            widen(plane, parts->room, &section);
        else
            pir_opening_polygon_free(&section);
        good = good && pir_opening_polygons_add(ret_sections, &section);
        if (!good)
            return false;
    }
    return true;
}

/* Adds what of a polygon is not in a section to a list; the polygon is used up. */
static bool leave_out(const mpq_t n[3], const pir_opening_polygon *section, pir_opening_polygon *polygon,
                      pir_opening_polygons *rest) {
    pir_opening_half half;
    bool good = true;
    if (!pir_opening_polygons_near(section, polygon))
        return pir_opening_polygons_add(rest, polygon);
    pir_opening_half_init(&half);
    for (uint32_t i = 0; i < section->count && polygon->count > 0 && good; i++) {
        pir_opening_polygon beyond;
        pir_opening_half_of_side(n, (const mpq_t *)section->at[i], (const mpq_t *)section->at[(i + 1) % section->count],
                                 &half);
        good = pir_opening_polygon_clip(polygon, &half, true, false, &beyond);
        if (good && beyond.count > 0)
            good = pir_opening_polygons_add(rest, &beyond);
        good = good && cut(polygon, &half);
    }
    pir_opening_half_clear(&half);
    pir_opening_polygon_free(polygon);
    return good;
}

/* The rest of the places, which are used up, without the sections; `ret_is_much` where it has too many parts. */
static bool make_rest(const mpq_t n[3], const pir_opening_polygons *sections, pir_opening_polygon *places,
                      pir_opening_polygons *ret_rest, bool *ret_is_much) {
    bool good = places->count == 0 || pir_opening_polygons_add(ret_rest, places);
    *ret_is_much = false;
    for (uint32_t i = 0; i < sections->count && good; i++) {
        pir_opening_polygons rest = {0};
        for (uint32_t j = 0; j < ret_rest->count && good; j++)
            good = leave_out(n, &sections->at[i], &ret_rest->at[j], &rest);
        pir_opening_polygons_free(ret_rest);
        *ret_rest = rest;
        *ret_is_much = *ret_is_much || rest.count > MOST_PARTS;
        if (*ret_is_much)
            break;
    }
    return good;
}

/* --- holes --- */

/* Whether polygons have a point in common. */
static bool do_meet(const mpq_t n[3], const pir_opening_polygon *a, const pir_opening_polygon *b, bool *ret_meet) {
    pir_opening_half half;
    pir_opening_polygon common = {0};
    bool good = true;
    *ret_meet = pir_opening_polygons_near(a, b);
    if (!*ret_meet)
        return true;
    pir_opening_half_init(&half);
    for (uint32_t i = 0; i < b->count && good && *ret_meet; i++) {
        pir_opening_polygon part;
        pir_opening_half_of_side(n, (const mpq_t *)b->at[i], (const mpq_t *)b->at[(i + 1) % b->count], &half);
        good = pir_opening_polygon_clip(i == 0 ? a : &common, &half, false, true, &part);
        pir_opening_polygon_free(&common);
        if (good)
            common = part;
        *ret_meet = common.count > 0;
    }
    pir_opening_polygon_free(&common);
    pir_opening_half_clear(&half);
    return good;
}

/* A part of a side: from `low` to `high` of its length. */
struct side_span {
    mpq_t low, high;
};

/* The part of a side in a polygon; false where there is none. */
static bool span_in(const mpq_t n[3], const mpq_t a[3], const mpq_t b[3], const pir_opening_polygon *polygon,
                    struct side_span *span) {
    pir_opening_half half;
    mpq_t u, v;
    mpq_inits(u, v, NULL);
    pir_opening_half_init(&half);
    mpq_set_ui(span->low, 0, 1);
    mpq_set_ui(span->high, 1, 1);
    bool is_any = true;
    for (uint32_t i = 0; i < polygon->count && is_any; i++) {
        pir_opening_half_of_side(n, (const mpq_t *)polygon->at[i], (const mpq_t *)polygon->at[(i + 1) % polygon->count],
                                 &half);
        pir_opening_half_value(&half, a, u);
        pir_opening_half_value(&half, b, v);
        const int from = mpq_sgn(u), to = mpq_sgn(v);
        is_any = from <= 0 || to <= 0;
        if (!is_any || (from <= 0 && to <= 0))
            continue;
        mpq_sub(v, u, v);
        mpq_div(u, u, v);
        if (from > 0 && mpq_cmp(u, span->low) > 0)
            mpq_set(span->low, u);
        if (to > 0 && mpq_cmp(u, span->high) < 0)
            mpq_set(span->high, u);
    }
    pir_opening_half_clear(&half);
    mpq_clears(u, v, NULL);
    return is_any && mpq_cmp(span->low, span->high) <= 0;
}

/* How far along a side a point on its line is. */
static void part_of(const mpq_t a[3], const mpq_t b[3], const mpq_t x[3], mpq_t ret) {
    for (int k = 0; k < 3; k++)
        if (!mpq_equal(a[k], b[k])) {
            mpq_t t;
            mpq_init(t);
            mpq_sub(t, b[k], a[k]);
            mpq_sub(ret, x[k], a[k]);
            mpq_div(ret, ret, t);
            mpq_clear(t);
            return;
        }
}

/* The part of a side that a side of another polygon has, which runs the other way. */
static bool span_against(const mpq_t n[3], const mpq_t a[3], const mpq_t b[3], const mpq_t c[3], const mpq_t d[3],
                         struct side_span *span) {
    if (turn_of(n, a, b, c, span->low) != 0 || turn_of(n, a, b, d, span->low) != 0)
        return false;
    part_of(a, b, d, span->low);
    part_of(a, b, c, span->high);
    return mpq_cmp(span->low, span->high) < 0;
}

/* Adds to the part of a side from its beginning that is covered what goes on from it; whether that is more. */
static bool go_on(const struct side_span *span, mpq_t covered) {
    if (mpq_cmp(span->low, covered) > 0 || mpq_cmp(span->high, covered) <= 0)
        return false;
    mpq_set(covered, span->high);
    return true;
}

/* Whether each point of a side of a part of a hole is in a section, or on a side of another part. */
static bool is_covered(const mpq_t n[3], const pir_opening_polygons *sections, const pir_opening_polygons *parts,
                       uint32_t part, uint32_t side) {
    const pir_opening_polygon *own = &parts->at[part];
    const mpq_t *a = (const mpq_t *)own->at[side], *b = (const mpq_t *)own->at[(side + 1) % own->count];
    struct side_span span;
    mpq_t covered;
    mpq_inits(span.low, span.high, covered, NULL);
    for (bool is_more = true; is_more && mpq_cmp_ui(covered, 1, 1) < 0;) {
        is_more = false;
        for (uint32_t i = 0; i < sections->count; i++)
            if (pir_opening_polygons_near(own, &sections->at[i]) && span_in(n, a, b, &sections->at[i], &span))
                is_more = go_on(&span, covered) || is_more;
        for (uint32_t i = 0; i < parts->count; i++)
            for (uint32_t k = 0; i != part && k < parts->at[i].count; k++)
                if (span_against(n, a, b, (const mpq_t *)parts->at[i].at[k],
                                 (const mpq_t *)parts->at[i].at[(k + 1) % parts->at[i].count], &span))
                    is_more = go_on(&span, covered) || is_more;
    }
    const bool is_all = mpq_cmp_ui(covered, 1, 1) >= 0;
    mpq_clears(span.low, span.high, covered, NULL);
    return is_all;
}

static bool is_closed(const mpq_t n[3], const pir_opening_polygons *sections, const pir_opening_polygons *parts) {
    for (uint32_t i = 0; i < parts->count; i++)
        for (uint32_t side = 0; side < parts->at[i].count; side++)
            if (!is_covered(n, sections, parts, i, side))
                return false;
    return true;
}

/* The hull of the polygons of a group, or of one of them. */
static bool add_hull(const mpq_t n[3], const pir_opening_polygons *rest, const uint32_t *group, uint32_t of,
                     uint32_t only, pir_opening_polygons *parts) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < rest->count; i++)
        count += rest->at[i].count;
    const mpq_t **point = calloc(count + 1, sizeof *point);
    pir_opening_polygon hull = {0};
    count = 0;
    for (uint32_t i = 0; i < rest->count && point; i++)
        for (uint32_t k = 0; k < rest->at[i].count && (only == UINT32_MAX ? group[i] == of : i == only); k++)
            point[count++] = (const mpq_t *)rest->at[i].at[k];
    const bool good =
        point && make_hull(n, (const mpq_t *const *)point, count, &hull) && pir_opening_polygons_add(parts, &hull);
    free(point);
    return good;
}

/* A disc round a hole: a middle, and a square of a radius that is above those of all corners. */
static void make_disc(const mpq_t n[3], pir_opening_hole *hole, mpq_t square) {
    const double normal[3] = {mpq_get_d(n[0]), mpq_get_d(n[1]), mpq_get_d(n[2])};
    mpq_t sum, t;
    pir_opening_body_disc(normal, hole->parts.at, hole->parts.count, hole->centre);
    mpq_inits(sum, t, NULL);
    for (uint32_t i = 0; i < hole->parts.count; i++)
        for (uint32_t c = 0; c < hole->parts.at[i].count; c++) {
            mpq_set_ui(sum, 0, 1);
            for (int k = 0; k < 3; k++) {
                mpq_set_d(t, hole->centre[k]);
                mpq_sub(t, t, hole->parts.at[i].at[c][k]);
                mpq_mul(t, t, t);
                mpq_add(sum, sum, t);
            }
            mpq_set_d(t, nextafter(mpq_get_d(sum), INFINITY));
            if (mpq_cmp(t, square) > 0)
                mpq_set(square, t);
        }
    mpq_clears(sum, t, NULL);
}

/* Makes the hole of a group; false when out of memory or where it is open. */
static bool make_hole(const pir_opening_polygons *sections, const pir_opening_polygons *rest, const uint32_t *group,
                      uint32_t of, pir_opening_wall *wall, bool *ret_open) {
    const mpq_t *n = (const mpq_t *)wall->plane;
    pir_opening_hole *hole = &wall->hole[wall->holes++];
    *ret_open = false;
    if (!add_hull(n, rest, group, of, UINT32_MAX, &hole->parts))
        return false;
    if (!is_closed(n, sections, &hole->parts)) {
        pir_opening_polygons_free(&hole->parts);
        for (uint32_t i = 0; i < rest->count; i++)
            if (group[i] == of && !add_hull(n, rest, group, of, i, &hole->parts))
                return false;
        *ret_open = !is_closed(n, sections, &hole->parts);
    }
    if (!*ret_open)
        make_disc(n, hole, wall->square);
    return true;
}

static bool make_holes(const pir_opening_polygons *sections, const pir_opening_polygons *rest, pir_opening_wall *wall,
                       bool *ret_open) {
    uint32_t *group = calloc(rest->count + 1, sizeof *group);
    wall->hole = calloc(rest->count + 1, sizeof *wall->hole);
    bool good = group && wall->hole, meet;
    *ret_open = false;
    for (uint32_t i = 0; i < rest->count && good; i++) {
        group[i] = i;
        for (uint32_t j = 0; j < i && good; j++) {
            if (group[j] == group[i])
                continue;
            good = do_meet((const mpq_t *)wall->plane, &rest->at[i], &rest->at[j], &meet);
            const uint32_t from = group[j];
            for (uint32_t k = 0; k < i && meet && good; k++)
                group[k] = group[k] == from ? group[i] : group[k];
        }
    }
    // each group has one that bears its number
    for (uint32_t i = 0; i < rest->count && good && !*ret_open; i++)
        if (group[i] == i)
            good = make_hole(sections, rest, group, i, wall, ret_open);
    free(group);
    return good;
}

pir_status pir_opening_wall_make(const pir_opening_parts *parts, const double n[3], double d,
                                 pir_opening_wall *ret_wall) {
    pir_opening_wall wall = {0};
    pir_opening_half plane;
    pir_opening_polygon places = {0}, around = {0};
    pir_opening_polygons sections = {0}, rest = {0};
    bool is_none = false;
    mpq_inits(wall.plane[0], wall.plane[1], wall.plane[2], wall.plane[3], wall.square, NULL);
    pir_opening_half_init(&plane);
    for (int k = 0; k < 3; k++) {
        mpq_set_d(wall.plane[k], n[k]);
        mpq_set_d(plane.m[k], n[k]);
    }
    mpq_set_d(wall.plane[3], d);
    mpq_set_d(plane.c, d);
    bool good = list_pieces(parts, &plane, &wall);
    if (good && wall.pieces > 0)
        good = make_places(parts, &plane, &places) && make_around(parts, &plane, &around) &&
               make_sections(parts, &plane, &around, &sections) &&
               make_rest((const mpq_t *)wall.plane, &sections, &places, &rest, &is_none) &&
               (is_none || make_holes(&sections, &rest, &wall, &is_none));
    if (is_none)
        wall.pieces = 0;
    pir_opening_polygon_free(&places);
    pir_opening_polygon_free(&around);
    pir_opening_polygons_free(&sections);
    pir_opening_polygons_free(&rest);
    pir_opening_half_clear(&plane);
    *ret_wall = wall;
    return good ? PIR_OK : PIR_ERR_MEMORY;
}

void pir_opening_wall_finish(pir_opening_wall *wall) {
    for (uint32_t i = 0; i < wall->holes; i++)
        pir_opening_polygons_free(&wall->hole[i].parts);
    free(wall->hole);
    free(wall->piece);
    mpq_clears(wall->plane[0], wall->plane[1], wall->plane[2], wall->plane[3], wall->square, NULL);
    *wall = (pir_opening_wall){0};
}
