/* SPDX-License-Identifier: MIT */
/*
 * See surface.h. A closed surface that lies in the boundary of the hull covers every part of it the same number of
 * times, k, and so encloses k times the volume of the hull. It is the boundary itself when |k| = 1. So the surface is
 * convex when its facets lie in the boundary of the hull and the two exact volumes are equal up to sign.
 */
#include "polytope/surface/surface.h"

#include <math.h>
#include <stdio.h>

#include "base/memory.h"
#include "base/report.h"
#include "base/sort.h"
#include "polytope/hull/quickhull.h"
#include "polytope/surface/cut_polygon.h"
#include "polytope/surface/facets.h"

/* Findings about a surface, and the facet at which it fails to be that of a convex solid. */
struct examination {
    const struct pir_model *model;
    const struct pir_exact_points *exact;
    const pir_polytope *hull;
    struct pir_model_facets facets;
    pir_surface surface;
    uint32_t *by_piece; /* per facet: facets, those of one piece together */
    uint32_t inner;     /* a facet that is not in the boundary of the hull, or PIR_NONE */
};

/* --- volumes --- */

/* The rounded volume that is a sixth of `six`. */
static bool round_volume(const struct examination *x, const pir_int *six, double *ret_volume) {
    const pir_allocator *a = &x->model->allocator;
    const pir_scale *scale = &x->exact->scale;
    uint32_t nums = pir_int_length(&scale->num), dens = pir_int_length(&scale->den);
    uint32_t limbs = 5 * nums + 5 * dens + 8;
    pir_limbs scratch = {PIR_NEW(a, mp_limb_t, limbs), 0, limbs};
    if (!scratch.base)
        return false;
    mp_limb_t six_limb = 6;
    pir_int six_units = {&six_limb, 1, 0};
    pir_int num2 = pir_limbs_take(&scratch, 2 * nums), num3 = pir_limbs_take(&scratch, 3 * nums);
    pir_int den2 = pir_limbs_take(&scratch, 2 * dens + 1), den3 = pir_limbs_take(&scratch, 3 * dens + 1);
    pir_int_mul(&num2, &scale->num, &scale->num);
    pir_int_mul(&num3, &num2, &scale->num);
    pir_int_mul(&den3, &scale->den, &scale->den);
    pir_int_mul(&den2, &den3, &six_units);
    pir_int_mul(&den3, &den2, &scale->den);
    *ret_volume = pir_scaled_nearest_double(six, &num3, &den3);
    PIR_FREE(a, scratch.base, limbs);
    return true;
}

static bool piece_before(void *context, uint32_t a, uint32_t b) {
    const uint32_t *piece = context;
    return piece[a] < piece[b];
}

/* Facets by the pieces that they belong to; all one piece where none had to be turned. */
static bool order_by_piece(struct examination *x) {
    uint32_t count = x->facets.count, *work = PIR_NEW(&x->model->allocator, uint32_t, count);
    x->by_piece = PIR_NEW(&x->model->allocator, uint32_t, count);
    bool done = work && x->by_piece;
    if (done) {
        for (uint32_t f = 0; f < count; f++)
            x->by_piece[f] = f;
        pir_sort(x->by_piece, count, work, piece_before, x->facets.piece);
    }
    PIR_FREE(&x->model->allocator, work, count);
    return done;
}

/* Adds one facet to the volumes; PIR_IS_OFF_HULL only where `on` is given. */
static enum pir_on_hull_answer add_facet(const struct examination *x, uint32_t facet, struct pir_on_hull *on,
                                         struct pir_six_volumes *volumes) {
    const uint32_t *corner = x->facets.corner + x->facets.start[facet];
    uint32_t count = x->facets.start[facet + 1] - x->facets.start[facet];
    bool turned = x->facets.turned[facet] && x->facets.joining == PIR_JOINED_TURNED;
    if (on)
        return pir_cut_polygon(on, corner, count, turned, volumes);
    pir_six_volumes_add(volumes, corner, count, turned);
    return PIR_IS_ON_HULL;
}

/* Six times the volume of all facets. Where facets had to be turned, each piece counts with the sign that makes its
   volume positive. */
static enum pir_on_hull_answer add_facets(struct examination *x, struct pir_on_hull *on, struct pir_six_volumes *total,
                                          struct pir_six_volumes *piece) {
    const uint32_t *root = x->facets.piece;
    for (uint32_t i = 0, count = x->facets.count; i < count; i++) {
        uint32_t f = x->by_piece[i];
        enum pir_on_hull_answer answer = add_facet(x, f, on, piece);
        if (answer == PIR_IS_OFF_HULL)
            x->inner = f;
        if (answer != PIR_IS_ON_HULL)
            return answer;
        if (i + 1 < count && root[x->by_piece[i + 1]] == root[f])
            continue;
        if (piece->sum.size < 0 && x->facets.joining == PIR_JOINED_TURNED)
            pir_int_negate(&piece->sum);
        pir_int_add(&total->sum, &total->sum, &piece->sum);
        piece->sum.size = 0;
    }
    return PIR_IS_ON_HULL;
}

/* --- convex or not --- */

/* Adds the facets of the hull, or the first alone. */
static bool add_hull(const struct examination *x, struct pir_six_volumes *volumes, uint32_t facets) {
    const pir_polytope *hull = x->hull;
    uint32_t *corner = PIR_NEW(&x->model->allocator, uint32_t, hull->half_count);
    if (!corner)
        return false;
    for (uint32_t f = 0; f < facets; f++) {
        uint32_t count = hull->loop_start[f + 1] - hull->loop_start[f];
        for (uint32_t i = 0; i < count; i++)
            corner[i] = hull->source[hull->origin[hull->loop[hull->loop_start[f] + i]]];
        pir_six_volumes_add(volumes, corner, count, false);
    }
    PIR_FREE(&x->model->allocator, corner, hull->half_count);
    return true;
}

/* |a| == |b|. */
static bool same_size(const pir_int *a, const pir_int *b) {
    uint32_t length = pir_int_length(a);
    return length == pir_int_length(b) && (length == 0 || mpn_cmp(a->limb, b->limb, length) == 0);
}

/* A closed surface in space: the volume that its facets enclose as the hull cuts them, against that of the hull. */
static bool examine_solid(struct examination *x, struct pir_six_volumes volumes[3]) {
    struct pir_on_hull on;
    if (!pir_on_hull_init(&on, x->hull, &x->facets, &x->exact->vectors, &x->model->allocator))
        return false;
    enum pir_on_hull_answer answer = add_facets(x, &on, &volumes[0], &volumes[1]);
    pir_on_hull_finish(&on);
    if (answer == PIR_IS_OFF_HULL)
        return true;
    if (answer == PIR_ON_HULL_NO_MEMORY || !add_hull(x, &volumes[2], x->hull->facet_count))
        return false;
    x->surface.convex = same_size(&volumes[0].sum, &volumes[2].sum);
    if (x->surface.convex)
        x->surface.volume = pir_polytope_volume(x->hull) * pir_int_sign(&volumes[0].sum);
    return true;
}

/* A closed surface in a plane is convex when its facets on either side have the area of the hull. */
static bool examine_flat(struct examination *x, struct pir_six_volumes volumes[3]) {
    const pir_polytope *hull = x->hull;
    const uint32_t *loop = hull->loop;
    uint32_t a = hull->source[hull->origin[loop[0]]], b = hull->source[hull->origin[loop[1]]],
             c = hull->source[hull->origin[loop[2]]];
    pir_points points;
    if (!pir_points_init(&points, &x->model->allocator, &x->exact->vectors, NULL))
        return false;
    int axis = pir_steepest_axis(&points, a, b, c);
    pir_points_finish(&points, &x->model->allocator);
    for (int k = 0; k < 3; k++)
        pir_six_volumes_lift(&volumes[k], a, axis);
    if (!add_hull(x, &volumes[2], 1))
        return false;
    for (uint32_t f = 0; f < x->facets.count; f++) {
        struct pir_six_volumes one = volumes[2];
        one.sum = pir_limbs_take(&one.scratch, 3 * (one.points->stride + 2) + 4);
        add_facet(x, f, NULL, &one);
        struct pir_six_volumes *side = &volumes[one.sum.size > 0];
        pir_int_add(&side->sum, &side->sum, &one.sum);
    }
    x->surface.convex = same_size(&volumes[0].sum, &volumes[2].sum) && same_size(&volumes[1].sum, &volumes[2].sum);
    return true;
}

/* The volume within facets that face one way, with pyramids from the origin over the edges of an open surface. */
static bool examine_volume(struct examination *x, struct pir_six_volumes volumes[3]) {
    if (!order_by_piece(x))
        return false;
    add_facets(x, NULL, &volumes[0], &volumes[1]);
    bool done = round_volume(x, &volumes[0].sum, &x->surface.volume);
    volumes[0].sum.size = 0;
    return done;
}

static bool examine_facets(struct examination *x) {
    struct pir_six_volumes volumes[3] = {0};
    bool done = true;
    for (int k = 0; k < 3; k++)
        done = done && pir_six_volumes_init(&volumes[k], &x->model->allocator, &x->exact->vectors);
    done = done && examine_volume(x, volumes);
    bool closed = x->surface.form == PIR_SURFACE_CLOSED;
    if (done && closed && x->hull->dimension == 3)
        done = examine_solid(x, volumes);
    else if (done && closed && x->hull->dimension == 2)
        done = examine_flat(x, volumes);
    else if (done)
        x->surface.convex = closed;
    for (int k = 0; k < 3; k++)
        pir_six_volumes_finish(&volumes[k], &x->model->allocator);
    return done;
}

static bool examine(struct examination *x) {
    x->surface = (pir_surface){.points = x->model->point_count, .facets = x->model->facet_count, .volume = (double)NAN};
    if (!pir_facets_init(&x->facets, x->model, &x->exact->vectors))
        return false;
    x->surface.form = x->facets.count == 0                  ? PIR_SURFACE_POINTS
                      : x->facets.joining == PIR_JOINED_NOT ? PIR_SURFACE_OPEN
                                                            : PIR_SURFACE_CLOSED;
    if (x->surface.form == PIR_SURFACE_POINTS)
        x->surface.convex = x->facets.place_count == x->hull->vertex_count;
    bool faces_one_way = x->facets.one_way || x->facets.joining == PIR_JOINED_TURNED;
    return x->surface.form == PIR_SURFACE_POINTS || !faces_one_way || examine_facets(x);
}

/* --- refusals --- */

/* "name:line", or "name: facet 7" where the file has no lines. */
static const char *name_facet(const struct pir_model *model, uint32_t facet, char *text, size_t room) {
    if (model->binary)
        snprintf(text, room, "%s: facet %u", model->name, (unsigned)facet);
    else
        snprintf(text, room, "%s:%u", model->name, (unsigned)model->facet[facet].line);
    return text;
}

static pir_status refuse_open(const struct examination *x) {
    const struct pir_model *model = x->model;
    const struct pir_model_facets *facets = &x->facets;
    char where[128];
    pir_vec3 a = model->points[facets->open_edge[0]], b = model->points[facets->open_edge[1]];
    return pir_fail(model->report, PIR_ERR_NOT_CLOSED,
                    "%s: the surface is open: the edge from (%g, %g, %g) to (%g, %g, %g) is on %u facet%s",
                    name_facet(model, facets->open_facet, where, sizeof where), a.x, a.y, a.z, b.x, b.y, b.z,
                    (unsigned)facets->open_count, facets->open_count == 1 ? "" : "s");
}

static pir_status refuse(const struct examination *x) {
    const struct pir_model *model = x->model;
    char where[128];
    if (x->surface.form == PIR_SURFACE_OPEN)
        return refuse_open(x);
    if (x->surface.form == PIR_SURFACE_POINTS)
        return pir_fail(model->report, PIR_ERR_NOT_CONVEX,
                        "%s: not convex: there are no facets, and of %u places %u are no vertices of their hull",
                        model->name, (unsigned)x->facets.place_count,
                        (unsigned)(x->facets.place_count - x->hull->vertex_count));
    if (x->facets.joining == PIR_JOINED_NEITHER)
        return pir_fail(model->report, PIR_ERR_NOT_CONVEX,
                        "%s: not convex: the facets cannot all face one side of the surface", model->name);
    if (x->inner != PIR_NONE)
        return pir_fail(model->report, PIR_ERR_NOT_CONVEX,
                        "%s: not convex: this facet is inside the convex hull; volume %g, of the hull %g",
                        name_facet(model, x->inner, where, sizeof where), x->surface.volume,
                        pir_polytope_volume(x->hull));
    return pir_fail(model->report, PIR_ERR_NOT_CONVEX,
                    "%s: not convex: the facets do not cover the boundary of the convex hull once", model->name);
}

pir_status pir_surface_examine(const struct pir_model *model, const struct pir_exact_points *exact,
                               const pir_polytope *hull, bool require_convex, pir_surface *ret_surface) {
    struct examination x = {.model = model, .exact = exact, .hull = hull, .inner = PIR_NONE};
    pir_status status = PIR_OK;
    if (!examine(&x))
        status = pir_model_fail_memory(model);
    else if (require_convex && !x.surface.convex)
        status = refuse(&x);
    else
        *ret_surface = x.surface;
    PIR_FREE(&model->allocator, x.by_piece, x.facets.count);
    pir_facets_finish(&x.facets, &model->allocator);
    return status;
}
