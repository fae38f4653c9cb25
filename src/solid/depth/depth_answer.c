/* SPDX-License-Identifier: MIT */
/*
 * See depth_answer.h. An answer depends on the place that was found alone, not on how: its facets are found anew among
 * all that hold it, and its numbers come from the doubles of one facet, or from the exact place.
 */
#include "solid/depth/depth_answer.h"

#include <math.h>

#include "base/vec.h"
#include "solid/depth/shared_middle.h"

/* More planes than this that hold one place are left out: the first ones count. */
#define HOLDING 64

/* A facet whose plane is no farther off gives numbers by its doubles. */
#define NEAR_ENOUGH 0x1p-42

struct holding {
    uint32_t count, plane[HOLDING];
    bool below[HOLDING]; /* the place of P is strictly below the plane: P may leave through it */
};

/* Adds the planes of a sum that hold a point of it. */
static void add_holding(pir_obstacle *o, const pir_obstacle_sum *sum, uint32_t point, struct holding *holding) {
    const uint32_t before = holding->count;
    for (uint32_t f = sum->first; f < sum->first + sum->count && o->status == PIR_OK; f++) {
        const int side = pir_obstacle_side(o, f, point);
        if (side > 0) {
            holding->count = before;
            return;
        }
        if (side == 0 && holding->count < HOLDING) {
            holding->below[holding->count] = pir_obstacle_side(o, f, 0) < 0;
            holding->plane[holding->count++] = f;
        }
    }
}

static void find_holding(pir_obstacle *o, uint32_t point, struct holding *holding) {
    const pir_obstacle_point at = o->point[point];
    for (uint32_t pair = 0; pair < o->pairs && o->status == PIR_OK; pair++) {
        const pir_space_box box = pir_obstacle_box(o, pair);
        bool holds = true;
        for (int k = 0; k < 3; k++)
            holds = holds && at.x[k] > box.low[k] - at.err - 0x1p-46 && at.x[k] < box.high[k] + at.err + 0x1p-46;
        if (holds && !pir_obstacle_is_beyond(o, pair, at.x, at.err)) {
            const pir_obstacle_sum sum = *pir_obstacle_open(o, pair);
            add_holding(o, &sum, point, holding);
        }
    }
}

/* Takes two facets out of those that hold a nearest place: whether the way there is spanned by their normals. */
static bool choose_two(pir_obstacle *o, uint32_t point, const struct holding *h, uint32_t i, uint32_t ret_chosen[2]) {
    for (uint32_t j = 0; j < h->count; j++)
        if (i != j && pir_obstacle_is_along(o, point, h->plane[i], h->plane[j])) {
            ret_chosen[0] = h->plane[i];
            ret_chosen[1] = h->plane[j];
            return true;
        }
    return false;
}

/* The facets that determine a nearest place, as few as do; how many they are. P leaves through the first. */
static uint32_t choose(pir_obstacle *o, uint32_t point, const struct holding *h, uint32_t ret_chosen[3]) {
    for (uint32_t i = 0; i < h->count; i++)
        if (h->below[i] && pir_obstacle_is_along(o, point, h->plane[i], h->plane[i])) {
            ret_chosen[0] = h->plane[i];
            return 1;
        }
    for (uint32_t i = 0; i < h->count; i++)
        if (h->below[i] && choose_two(o, point, h, i, ret_chosen))
            return 2;
    uint32_t chosen = 0;
    for (uint32_t i = 0; i < h->count && chosen == 0; i++)
        if (h->below[i])
            ret_chosen[chosen++] = h->plane[i];
    for (uint32_t i = 0; i < h->count && chosen > 0 && chosen < 3; i++)
        if (pir_obstacle_are_independent(o, ret_chosen, chosen, h->plane[i]))
            ret_chosen[chosen++] = h->plane[i];
    return chosen;
}

/* The first facet that the way goes out by. */
static uint32_t choose_along(pir_obstacle *o, const struct holding *h, uint32_t ret_chosen[3]) {
    for (uint32_t i = 0; i < h->count; i++)
        if (h->below[i] && o->status == PIR_OK) {
            ret_chosen[0] = h->plane[i];
            return 1;
        }
    return 0;
}

static pir_solid_facet facet_of(const pir_obstacle *o, uint32_t plane) {
    const pir_obstacle_plane *f = &o->plane[plane];
    const uint32_t of_q = o->frame.body[1].of->count;
    const bool edges = f->kind == PIR_OBSTACLE_EDGES;
    const pir_feature_kind p = edges                             ? PIR_FEATURE_EDGE
                               : f->kind == PIR_OBSTACLE_P_FACET ? PIR_FEATURE_FACET
                                                                 : PIR_FEATURE_VERTEX;
    const pir_feature_kind q = edges                    ? PIR_FEATURE_EDGE
                               : p == PIR_FEATURE_FACET ? PIR_FEATURE_VERTEX
                                                        : PIR_FEATURE_FACET;
    return (pir_solid_facet){f->pair / of_q, f->pair % of_q, {{p, f->p}, {q, f->q}}};
}

/* The way to the foot on a plane: by its doubles, where they are near enough. */
static double way_to_plane(pir_obstacle *o, uint32_t plane, double way[3]) {
    const pir_obstacle_plane *f = &o->plane[plane];
    if (f->err > NEAR_ENOUGH) {
        const uint32_t foot = pir_obstacle_add(o, PIR_OBSTACLE_ON_PLANE, plane, PIR_OBSTACLE_NONE, PIR_OBSTACLE_NONE);
        return o->status == PIR_OK ? pir_obstacle_exact_way(o, foot, way) : 0;
    }
    const double *t = o->point[0].x, depth = f->d - (f->n[0] * t[0] + f->n[1] * t[1] + f->n[2] * t[2]);
    for (int k = 0; k < 3; k++)
        way[k] = depth * f->n[k];
    return depth;
}

/* The numbers and points of an answer, once its facets are known. */
static void fill(pir_obstacle *o, uint32_t plane, const double way[3], double depth, const double normal[3],
                 pir_solid_depth *ret) {
    const double unit = ldexp(1, o->frame.exponent), *t = o->point[0].x;
    const double x[3] = {t[0] + way[0], t[1] + way[1], t[2] + way[2]};
    double touch[3];
    pir_obstacle_shared_middle(o, plane, x, touch);
    ret->state = PIR_INSIDE;
    ret->depth = unit * depth;
    ret->normal = pir_mat_apply(&o->frame.rotation_q.r, (pir_vec3){normal[0], normal[1], normal[2]});
    ret->point_q = pir_vec_add(pir_piece_frame_to_world(&o->frame, touch), o->frame.translation[1]);
    ret->point_p = pir_vec_sub(ret->point_q, pir_piece_frame_to_world(&o->frame, way));
    ret->pairs = o->opened;
}

/* Chooses the facets of an answer; how many there are. */
static uint32_t facets_of(pir_obstacle *o, pir_depth_found found, uint32_t ret_chosen[3]) {
    const enum pir_obstacle_point_kind kind = o->point[found.point].kind;
    ret_chosen[0] = found.plane;
    if (kind == PIR_OBSTACLE_ON_PLANE)
        return 1;
    struct holding h = {0};
    find_holding(o, found.point, &h);
    const uint32_t chosen =
        kind == PIR_OBSTACLE_ON_WAY ? choose_along(o, &h, ret_chosen) : choose(o, found.point, &h, ret_chosen);
    if (o->status == PIR_OK && chosen == 0)
        o->status = PIR_ERR_INTERNAL;
    return chosen;
}

pir_status pir_depth_answer(pir_depth_search *search, pir_depth_found found, pir_solid_depth *ret_depth) {
    pir_obstacle *o = &search->obstacle;
    const bool nearest = o->point[found.point].kind != PIR_OBSTACLE_ON_WAY;
    uint32_t plane[3];
    const uint32_t chosen = facets_of(o, found, plane);
    if (o->status != PIR_OK)
        return o->status;
    double way[3], normal[3];
    const double depth =
        nearest && chosen == 1 ? way_to_plane(o, plane[0], way) : pir_obstacle_exact_way(o, found.point, way);
    if (o->status != PIR_OK)
        return o->status;
    const pir_obstacle_plane *f = &o->plane[plane[0]];
    for (int k = 0; k < 3; k++)
        normal[k] = !nearest || (chosen == 1 && f->err <= NEAR_ENOUGH) ? f->n[k] : way[k] / depth;
    *ret_depth = (pir_solid_depth){.facets = chosen};
    for (uint32_t i = 0; i < chosen; i++)
        ret_depth->facet[i] = facet_of(o, plane[i]);
    fill(o, plane[0], way, depth, normal, ret_depth);
    return PIR_OK;
}
