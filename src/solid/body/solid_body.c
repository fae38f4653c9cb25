/* SPDX-License-Identifier: MIT */
/* See solid_body.h. Normals are Newell's, in exact integers. */
#include "solid/body/solid_body.h"

#include <math.h>
#include <stdio.h>

#include "base/layout.h"
#include "base/report.h"
#include "solid/body/facet_parts.h"
#include "solid/body/twins.h"
#include "solid/space/exact.h"
#include "solid/space/intern.h"

static pir_layout layout_of(pir_shell_body *body) {
    const uint32_t facets = body->source.facet_count, halves = body->half_room;
    return (pir_layout){{PIR_ROW(body->plane, facets), PIR_ROW(body->half, facets), PIR_ROW(body->group, facets),
                         PIR_ROW(body->origin, halves), PIR_ROW(body->next, halves), PIR_ROW(body->prev, halves),
                         PIR_ROW(body->twin, halves), PIR_ROW(body->facet, halves),
                         PIR_ROW(body->edge, body->edge_room), PIR_ROW(body->part_start, body->part_room + 1),
                         PIR_ROW(body->part_facet, body->part_room), PIR_ROW(body->part_corner, body->corner_room),
                         PIR_ROW(body->part_direction, body->corner_room)}};
}

const char *pir_shell_body_where(const pir_shell_body_source *source, uint32_t facet, char ret_text[PIR_BODY_WHERE]) {
    if (source->line)
        snprintf(ret_text, PIR_BODY_WHERE, "%.80s:%u", source->name, (unsigned)source->line[facet]);
    else
        snprintf(ret_text, PIR_BODY_WHERE, "%.80s: facet %u", source->name, (unsigned)facet);
    return ret_text;
}

const char *pir_shell_body_place(const pir_shell_body *body, uint32_t point, char ret_text[PIR_BODY_WHERE]) {
    const double *x = body->space->point[point].x;
    snprintf(ret_text, PIR_BODY_WHERE, "(%.9g, %.9g, %.9g)", x[0] * body->source.unit, x[1] * body->source.unit,
             x[2] * body->source.unit);
    return ret_text;
}

/* --- points and planes --- */

static void add_points(pir_shell_body *body, uint32_t numbers) {
    pir_space *space = body->space;
    mpz_t one;
    mpz_init_set_ui(one, 1);
    body->first_point = space->point_count;
    for (uint32_t i = 0; i < body->source.point_count && space->status == PIR_OK; i++) {
        // the numbers may move when the point adds its own
        mpz_t x[3];
        for (uint32_t k = 0; k < 3; k++)
            mpz_init_set(x[k], space->number[numbers + 3 * i + k]);
        pir_space_add_point(space, x[0], x[1], x[2], one);
        for (int k = 0; k < 3; k++)
            mpz_clear(x[k]);
    }
    mpz_clear(one);
}

/* Newell's normal of a facet into n; x is scratch. */
static void make_normal(const pir_shell_body *body, uint32_t facet, mpz_t *n, mpz_t *x) {
    const pir_space *space = body->space;
    const uint32_t first = body->source.start[facet], end = body->source.start[facet + 1];
    for (int k = 0; k < 3; k++)
        mpz_set_ui(n[k], 0);
    for (uint32_t i = first; i < end; i++) {
        const uint32_t a = body->source.corner[i], b = body->source.corner[i + 1 < end ? i + 1 : first];
        mpz_t *p = space->number + space->point[body->first_point + a].exact;
        mpz_t *q = space->number + space->point[body->first_point + b].exact;
        pir_numbers_cross(x, p, q);
        for (int k = 0; k < 3; k++)
            mpz_add(n[k], n[k], x[k]);
    }
}

static pir_status add_plane(pir_shell_body *body, uint32_t facet) {
    pir_space *space = body->space;
    const uint32_t first = body->source.start[facet], end = body->source.start[facet + 1];
    char where[PIR_BODY_WHERE], place[PIR_BODY_WHERE];
    mpz_t *n = space->t, *x = space->t + 3;
    if (end > first)
        make_normal(body, facet, n, x);
    if (end == first || (mpz_sgn(n[0]) == 0 && mpz_sgn(n[1]) == 0 && mpz_sgn(n[2]) == 0))
        return pir_fail(body->source.report, PIR_ERR_FORMAT, "%s: this facet has no area",
                        pir_shell_body_where(&body->source, facet, where));
    const uint32_t normal = pir_space_add_direction(space, n[0], n[1], n[2]);
    body->plane[facet] = pir_space_add_plane(space, (const uint32_t[]){normal, PIR_SPACE_NONE}, false,
                                             (const uint32_t[]){body->origin[first], PIR_SPACE_NONE});
    for (uint32_t i = first; i < end && space->status == PIR_OK; i++)
        if (pir_space_side(space, pir_shell_body_half(body, facet), body->origin[i]) != 0)
            return pir_fail(body->source.report, PIR_ERR_FORMAT,
                            "%s: this facet is not planar: its corner at %s is "
                            "off the plane of the others",
                            pir_shell_body_where(&body->source, facet, where),
                            pir_shell_body_place(body, body->origin[i], place));
    return space->status;
}

static void fill_halves(pir_shell_body *body) {
    for (uint32_t f = 0; f < body->source.facet_count; f++) {
        const uint32_t first = body->source.start[f], end = body->source.start[f + 1];
        body->group[f] = f;
        for (uint32_t i = first; i < end; i++) {
            body->origin[i] = body->first_point + body->source.corner[i];
            body->facet[i] = f;
            body->next[i] = i + 1 < end ? i + 1 : first;
            body->prev[i] = i > first ? i - 1 : end - 1;
        }
    }
    body->half_count = body->source.start[body->source.facet_count];
}

/* --- edges --- */

static uint32_t root_of(const pir_shell_body *body, uint32_t facet) {
    while (body->group[facet] != facet)
        facet = body->group[facet] = body->group[body->group[facet]];
    return facet;
}

/* How an edge bends: the sign of det(left normal, right normal, direction). Facets that fold onto each other are
 * refused. */
static pir_status bend_edge(pir_shell_body *body, pir_shell_body_edge *edge) {
    pir_space *space = body->space;
    char where[PIR_BODY_WHERE], beside[PIR_BODY_WHERE];
    mpz_t *p = space->number + space->point[edge->a].exact, *q = space->number + space->point[edge->b].exact;
    mpz_t *t = space->t + 6;
    for (int k = 0; k < 3; k++)
        mpz_sub(t[k], q[k], p[k]);
    edge->direction = pir_space_add_direction(space, t[0], t[1], t[2]);
    const uint32_t left = space->plane[body->plane[edge->left]].direction[0];
    const uint32_t right = space->plane[body->plane[edge->right]].direction[0];
    edge->bend = (enum pir_bend)pir_space_det(space, left, right, edge->direction);
    if (edge->bend != PIR_BEND_FLAT || space->status != PIR_OK)
        return space->status;
    if (pir_space_dot(space, left, right) < 0)
        return pir_fail(body->source.report, PIR_ERR_FORMAT, "%s: this facet and %s are folded onto each other",
                        pir_shell_body_where(&body->source, edge->left, where),
                        pir_shell_body_where(&body->source, edge->right, beside));
    const uint32_t a = root_of(body, edge->left), b = root_of(body, edge->right);
    body->group[a > b ? a : b] = a < b ? a : b;
    return PIR_OK;
}

/* One plane for each group, and one number for equal planes of several. */
static void join_planes(pir_shell_body *body) {
    pir_intern planes;
    pir_intern_init(&planes, body->space, 4);
    for (uint32_t f = 0; f < body->source.facet_count; f++) {
        const uint32_t group = body->group[f] = root_of(body, f);
        body->plane[f] = body->plane[group];
        body->half[f] = group == f ? pir_intern_half(&planes, pir_half(body->plane[f], false)) : body->half[group];
    }
    pir_intern_finish(&planes);
}

/* --- the whole --- */

static pir_status make(pir_shell_body *body, uint32_t numbers) {
    add_points(body, numbers);
    pir_status status = body->space->status;
    if (status == PIR_OK)
        fill_halves(body);
    for (uint32_t f = 0; f < body->source.facet_count && status == PIR_OK; f++)
        status = add_plane(body, f);
    if (status == PIR_OK)
        status = pir_shell_body_find_twins(body);
    for (uint32_t e = 0; e < body->edge_count && status == PIR_OK; e++)
        status = bend_edge(body, &body->edge[e]);
    if (status != PIR_OK)
        return status;
    join_planes(body);
    uint32_t facet;
    char where[PIR_BODY_WHERE];
    if (!pir_shell_body_cut_parts(body, &facet))
        return pir_fail(body->source.report, PIR_ERR_FORMAT, "%s: the sides of this facet cross each other",
                        pir_shell_body_where(&body->source, facet, where));
    return body->space->status;
}

pir_status pir_shell_body_make(pir_shell_body *body, pir_space *space, const pir_shell_body_source *source,
                               uint32_t numbers) {
    const uint32_t corners = source->start[source->facet_count];
    *body = (pir_shell_body){.space = space,
                             .source = *source,
                             .half_room = 3 * corners,
                             .edge_room = corners,
                             .part_room = corners,
                             .corner_room = 3 * corners};
    const pir_layout layout = layout_of(body);
    pir_status status = pir_layout_new(&space->allocator, &layout) ? space->status : PIR_ERR_MEMORY;
    if (status == PIR_OK)
        status = make(body, numbers);
    if (status != PIR_OK)
        pir_shell_body_finish(body);
    return status;
}

void pir_shell_body_finish(pir_shell_body *body) {
    if (!body->space)
        return;
    const pir_layout layout = layout_of(body);
    pir_layout_free(&body->space->allocator, &layout);
    *body = (pir_shell_body){0};
}
