/* SPDX-License-Identifier: MIT */
/* See kept_glue.h. */
#include "solid/kept/kept_glue.h"

#include <math.h>
#include <string.h>

#include "solid/space/identity.h"

/* A vertex is fresh that goes farther in a call than so many times as far as all went in the mean, in the one before;
 * with more than FRESH_MOST of them, all vertices near edges are listed. */
#define FARTHER_MOST 4
#define FRESH_MOST   64

/* A vertex is near an edge that it may get to while both go as far as they do in the mean, so many times; but never at
 * more than this distance: then only vertices that may be within it are listed, for one call. */
#define NEAR_STEPS 48
#define NEAR_MOST  .03

void pir_kept_glue_init(pir_kept_glue *glue, pir_space *space) {
    *glue = (pir_kept_glue){.space = space};
    pir_union_outline_init(&glue->around, space);
    pir_union_outline_init(&glue->cut, space);
    pir_places_init(&glue->planes, space);
    glue->around.keeps_chains = true;
}

void pir_kept_glue_finish(pir_kept_glue *glue) {
    pir_space *space = glue->space;
    if (!space)
        return;
    pir_number_list *const list[] = {&glue->spare, &glue->fresh, &glue->there,
                                     &glue->found, &glue->touch, &glue->first};
    for (size_t i = 0; i < sizeof list / sizeof *list; i++)
        pir_space_shrink(space, list[i]->number, list[i]->room, sizeof(uint32_t));
    pir_space_shrink(space, glue->point, glue->point_room, sizeof *glue->point);
    pir_space_shrink(space, glue->vertex, glue->vertex_room, sizeof *glue->vertex);
    pir_space_shrink(space, glue->met, glue->met_room, sizeof *glue->met);
    pir_space_shrink(space, glue->place, glue->place_room, sizeof *glue->place);
    pir_space_shrink(space, glue->ended, glue->ended_room, sizeof *glue->ended);
    pir_space_shrink(space, glue->renewed, glue->renewed_room, sizeof *glue->renewed);
    pir_space_shrink(space, glue->mark, glue->mark_room, sizeof *glue->mark);
    pir_space_shrink(space, glue->edge.segment, glue->edge.room, sizeof *glue->edge.segment);
    pir_union_outline_finish(&glue->around);
    pir_union_outline_finish(&glue->cut);
    pir_places_finish(&glue->planes);
    pir_vertex_grid_finish(&glue->grid, space);
    *glue = (pir_kept_glue){0};
}

/* --- the order along a line --- */

/* The sign of (n_f × n_g) · (b − a) by doubles, 0 where they do not tell. The sums of what the components of each
 * normal are off are within the errors of the planes; points are 2√3 apart at most, and each coordinate is off by no
 * more than the point's error. */
static int likely_order(const pir_space *space, const uint32_t plane[2], uint32_t a, uint32_t b) {
    const pir_space_plane *f = &space->plane[plane[0]], *g = &space->plane[plane[1]];
    const pir_space_point *p = &space->point[a], *q = &space->point[b];
    double s = 0;
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        s += (f->n[i] * g->n[j] - f->n[j] * g->n[i]) * (q->x[k] - p->x[k]);
    }
    const double bound = 4 * (f->err + g->err) + 2 * (p->err + q->err) + 0x1p-46;
    return s > bound ? 1 : s < -bound ? -1 : 0;
}

/* Likewise, exactly. */
static int order_along(pir_space *space, const uint32_t plane[2], uint32_t a, uint32_t b) {
    const int likely = likely_order(space, plane, a, b);
    if (likely != 0 || a == b)
        return likely;
    return pir_space_order(space, pir_space_add_line_direction(space, plane[0], plane[1]), a, b);
}

/* --- vertices --- */

/* Forgets all outlines. */
static void forget(pir_plane_facet *const *facet, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        facet[i]->outline.made = false;
        facet[i]->outline.run_count = 0;
    }
}

/* Finds a point for each vertex that outlines still have; others are spare. */
static void find_points(pir_kept_glue *glue, pir_plane_facet *const *facet, uint32_t count) {
    for (uint32_t v = 0; v < glue->vertex_count; v++)
        glue->point[v] = PIR_SPACE_NONE;
    for (uint32_t i = 0; i < count; i++) {
        const pir_number_list *member = &facet[i]->outline.member;
        for (uint32_t k = 0; k < member->count && facet[i]->outline.made; k += 2)
            if (glue->point[member->number[k + 1]] == PIR_SPACE_NONE)
                glue->point[member->number[k + 1]] = member->number[k];
    }
    glue->spare.count = 0;
    for (uint32_t v = glue->vertex_count; v-- > 0;)
        if (glue->point[v] == PIR_SPACE_NONE)
            pir_number_list_add(&glue->spare, glue->space, v);
}

/* Notes that a vertex is fresh. */
static void refresh(pir_kept_glue *glue, uint32_t v) {
    glue->renewed[v] = glue->calls;
    pir_number_list_add(&glue->fresh, glue->space, v);
}

/* Moves a vertex to where its point is; how far it has gone. */
static double move(pir_kept_glue *glue, uint32_t v) {
    const double *x = glue->space->point[glue->point[v]].x;
    double *place = glue->place + 3 * (size_t)v, square = 0;
    for (int k = 0; k < 3; k++) {
        square += (x[k] - place[k]) * (x[k] - place[k]);
        place[k] = x[k];
    }
    return sqrt(square);
}

/* Puts the vertices where they are at this rotation; false where two are at one place. */
static bool place_vertices(pir_kept_glue *glue) {
    pir_space *space = glue->space;
    const double most = FARTHER_MOST * glue->mean;
    double farthest = 0, sum = 0;
    uint32_t count = 0;
    pir_union_outline_clear(&glue->around);
    glue->fresh.count = 0;
    for (uint32_t v = 0; v < glue->vertex_count && space->status == PIR_OK; v++) {
        const uint32_t point = glue->point[v];
        if (point == PIR_SPACE_NONE)
            continue;
        pir_space_renew_point(space, point);
        if (pir_places_point(&glue->around.points, point) != point)
            return false;
        glue->vertex[point] = v;
        const double way = move(glue, v);
        sum += way;
        count++;
        if (way > most)
            refresh(glue, v);
        else
            farthest = way > farthest ? way : farthest;
    }
    // doubles are off by no more than an error, before and now, along each axis
    glue->way += farthest + 4 * PIR_SPACE_ERROR;
    glue->mean = count > 0 ? sum / count : 0;
    return space->status == PIR_OK;
}

/* The vertex of a point, which stands for it where it is new. *ret_point is the point that stands for it. */
static uint32_t vertex_at(pir_kept_glue *glue, uint32_t point, uint32_t *ret_point) {
    pir_space *space = glue->space;
    const uint32_t known = glue->around.points.count;
    *ret_point = pir_places_point(&glue->around.points, point);
    if (glue->around.points.count == known || space->status != PIR_OK)
        return glue->vertex[*ret_point];
    uint32_t v = glue->vertex_count;
    if (glue->spare.count > 0)
        v = glue->spare.number[--glue->spare.count];
    if (!pir_space_grow(space, (void **)&glue->point, &glue->point_room, v, sizeof *glue->point) ||
        !pir_space_grow(space, (void **)&glue->mark, &glue->mark_room, v, sizeof *glue->mark) ||
        !pir_space_grow(space, (void **)&glue->ended, &glue->ended_room, v, sizeof *glue->ended) ||
        !pir_space_grow(space, (void **)&glue->renewed, &glue->renewed_room, v, sizeof *glue->renewed) ||
        !pir_space_grow(space, (void **)&glue->place, &glue->place_room, 3 * v + 2, sizeof *glue->place))
        return 0;
    if (v == glue->vertex_count) {
        glue->vertex_count++;
        glue->mark[v] = glue->ended[v] = 0;
    }
    glue->point[v] = point;
    memcpy(glue->place + 3 * (size_t)v, space->point[point].x, 3 * sizeof *glue->place);
    refresh(glue, v);
    return glue->vertex[point] = v;
}

/* --- outlines --- */

/* Whether the ends on each line with more than two stand as they did, by doubles. */
static bool chains_hold(const pir_kept_glue *glue, const pir_plane_facet *facet) {
    const pir_number_list *chain = &facet->outline.chain;
    for (uint32_t at = 0; at < chain->count; at += 2 + chain->number[at + 1]) {
        const uint32_t plane[2] = {facet->half >> 1, chain->number[at]}, ends = chain->number[at + 1];
        const uint32_t *end = chain->number + at + 2;
        pir_space_renew_plane(glue->space, plane[1]);
        const int way = likely_order(glue->space, plane, glue->point[end[0]], glue->point[end[1]]);
        bool holds = way != 0;
        for (uint32_t i = 1; i + 1 < ends && holds; i++)
            holds = likely_order(glue->space, plane, glue->point[end[i]], glue->point[end[i + 1]]) == way;
        if (!holds)
            return false;
    }
    return true;
}

/* The point that stands for an end of a facet's edge; its vertex is a member from now on. */
static uint32_t name_end(pir_kept_glue *glue, pir_facet_outline *outline, uint32_t end) {
    pir_space *space = glue->space;
    if (glue->met[end] == glue->round)
        return glue->point[glue->vertex[end]];
    uint32_t point;
    pir_space_renew_point(space, end);
    const uint32_t v = vertex_at(glue, end, &point);
    if (space->status != PIR_OK)
        return 0;
    glue->met[end] = glue->round;
    glue->vertex[end] = v;
    if (glue->mark[v] != glue->round) {
        glue->mark[v] = glue->round;
        pir_number_list_add(&outline->member, space, end);
        pir_number_list_add(&outline->member, space, v);
    }
    return point;
}

/* Lists the facet's edges between the points that stand for vertices, and these points, each once. */
static void name_ends(pir_kept_glue *glue, pir_plane_facet *facet) {
    pir_space *space = glue->space;
    const uint32_t count = facet->edge.count;
    facet->outline.member.count = 0;
    glue->round++;
    if (!pir_space_grow(space, (void **)&glue->edge.segment, &glue->edge.room, count, sizeof *glue->edge.segment))
        return;
    for (uint32_t i = 0; i < count && space->status == PIR_OK; i++) {
        pir_segment edge = facet->edge.segment[i];
        uint32_t *const end[2] = {&edge.a, &edge.b};
        pir_space_renew_plane(space, edge.plane[1]);
        for (int k = 0; k < 2; k++)
            *end[k] = name_end(glue, &facet->outline, *end[k]);
        if (space->status != PIR_OK)
            return;
        glue->edge.segment[i] = edge;
    }
}

static bool run_before(void *context, uint32_t a, uint32_t b) {
    const pir_kept_glue *glue = context;
    const pir_run *r = &glue->around.run[a], *s = &glue->around.run[b];
    const uint32_t from_r = glue->vertex[r->sign > 0 ? r->a : r->b], from_s = glue->vertex[s->sign > 0 ? s->a : s->b];
    return from_r < from_s;
}

/* Keeps a run; whether it is the same edge as the one that was there. */
static bool keep_run(pir_kept_glue *glue, pir_facet_outline *outline, const pir_run *run) {
    const uint32_t at = outline->run_count;
    if (!pir_space_grow(glue->space, (void **)&outline->run, &outline->run_room, at, sizeof *outline->run))
        return false;
    pir_kept_run *kept = &outline->run[outline->run_count++];
    const pir_kept_run own = {glue->around.line_plane[run->line][1], run->line, glue->vertex[run->a],
                              glue->vertex[run->b], run->sign};
    const bool same = (own.sign > 0 ? own.a : own.b) == (kept->sign > 0 ? kept->a : kept->b) &&
                      (own.sign > 0 ? own.b : own.a) == (kept->sign > 0 ? kept->b : kept->a);
    *kept = own;
    return same;
}

/* Keeps the runs, by the vertices from which they lead; whether the edges are the same as before. */
static void keep_runs(pir_kept_glue *glue, pir_facet_outline *outline) {
    pir_space *space = glue->space;
    pir_union_outline *around = &glue->around;
    const uint32_t before = outline->run_count;
    bool same = around->run_count == before;
    if (!pir_union_outline_order(around, around->run_count, run_before, glue))
        return;
    outline->run_count = outline->chain.count = 0;
    for (uint32_t i = 0; i < around->run_count; i++)
        same &= keep_run(glue, outline, &around->run[around->order[i]]);
    if (!same) {
        outline->is_traced = outline->is_listed = false;
        outline->touch.count = 0;
    }
    for (uint32_t at = 0; at < around->chain_count; at += 2 + around->chain[at + 1])
        for (uint32_t k = at; k < at + 2 + around->chain[at + 1]; k++)
            pir_number_list_add(&outline->chain, space, k < at + 2 ? around->chain[k] : glue->vertex[around->chain[k]]);
}

/* Makes the outline of a facet anew. */
static void make_outline(pir_kept_glue *glue, pir_plane_facet *facet) {
    pir_space *space = glue->space;
    pir_union_outline *around = &glue->around;
    name_ends(glue, facet);
    if (space->status != PIR_OK)
        return;
    pir_places_clear(&around->lines);
    around->run_count = around->chain_count = 0;
    pir_union_outline_add(around, 0, facet->half, glue->edge.segment, facet->edge.count);
    if (space->status != PIR_OK)
        return;
    keep_runs(glue, &facet->outline);
    glue->fleeting |= around->lines.by_numbers;
    facet->outline.made = space->status == PIR_OK;
}

/* Brings the outlines of all facets to this rotation; false where planes are one, be it with that of a facet that does
 * not bound the sum: a sum that is made anew has the place in its order that this one has. */
static bool make_outlines(pir_kept_glue *glue, pir_plane_facet *const *facet, const uint32_t *order, uint32_t count) {
    pir_space *space = glue->space;
    pir_places_clear(&glue->planes);
    for (uint32_t i = 0; i < count && space->status == PIR_OK; i++) {
        pir_plane_facet *own = facet[order[i]];
        pir_space_renew_plane(space, own->half >> 1);
        if (pir_places_half(&glue->planes, own->half) >> 1 != own->half >> 1)
            return false;
        if (own->edge.count == 0) {
            own->outline.is_listed = false;
            continue;
        }
        if (!own->outline.made || !chains_hold(glue, own))
            make_outline(glue, own);
    }
    glue->fleeting |= glue->around.points.by_numbers;
    return space->status == PIR_OK;
}

/* --- vertices near edges --- */

/* Notes where edges end. The vertices near an edge are to be listed again where an end is fresh. */
static void note_ends(pir_kept_glue *glue, pir_plane_facet *const *facet, uint32_t count) {
    glue->all_fresh = glue->fresh.count > FRESH_MOST;
    for (uint32_t i = 0; i < count; i++) {
        pir_facet_outline *outline = &facet[i]->outline;
        for (uint32_t r = 0; r < outline->run_count && facet[i]->edge.count > 0; r++) {
            const pir_kept_run *run = &outline->run[r];
            glue->ended[run->a] = glue->ended[run->b] = glue->calls;
            outline->is_listed &= glue->renewed[run->a] != glue->calls && glue->renewed[run->b] != glue->calls;
        }
    }
}

/* Puts all vertices into the grid. */
static void make_grid(pir_kept_glue *glue) {
    glue->there.count = 0;
    for (uint32_t v = 0; v < glue->vertex_count; v++)
        if (glue->point[v] != PIR_SPACE_NONE)
            pir_number_list_add(&glue->there, glue->space, v);
    pir_vertex_grid_make(&glue->grid, glue->space, glue->point, &glue->there);
    glue->gridded = true;
}

/* Whether a vertex is no farther from a run than a radius. */
static bool is_near(const pir_kept_glue *glue, const pir_kept_run *run, uint32_t v, double radius) {
    const double *x = glue->place + 3 * (size_t)v;
    const double *a = glue->place + 3 * (size_t)run->a, *b = glue->place + 3 * (size_t)run->b;
    double along = 0, length = 0, square = 0;
    for (int k = 0; k < 3; k++) {
        along += (b[k] - a[k]) * (x[k] - a[k]);
        length += (b[k] - a[k]) * (b[k] - a[k]);
    }
    const double at = along <= 0 ? 0 : along >= length ? 1 : along / length;
    for (int k = 0; k < 3; k++) {
        const double off = x[k] - a[k] - at * (b[k] - a[k]);
        square += off * off;
    }
    return square <= radius * radius;
}

static pir_space_box run_box(const pir_kept_glue *glue, const pir_kept_run *run, double radius) {
    pir_space_box box = PIR_SPACE_BOX_EMPTY;
    pir_space_box_add(&box, &glue->space->point[glue->point[run->a]]);
    pir_space_box_add(&box, &glue->space->point[glue->point[run->b]]);
    for (int k = 0; k < 3; k++) {
        box.low[k] -= radius;
        box.high[k] += radius;
    }
    return box;
}

/* Lists the vertices near the runs of a facet. */
static void list_near(pir_kept_glue *glue, pir_facet_outline *outline) {
    pir_space *space = glue->space;
    const double wanted = NEAR_STEPS * glue->mean, skin = glue->all_fresh || wanted > NEAR_MOST ? 0 : wanted;
    const double radius = skin + 16 * PIR_SPACE_ERROR;
    if (!glue->gridded)
        make_grid(glue);
    outline->near.count = 0;
    outline->near_box = PIR_SPACE_BOX_EMPTY;
    for (uint32_t r = 0; r < outline->run_count && space->status == PIR_OK; r++) {
        const pir_kept_run *run = &outline->run[r];
        const pir_space_box box = run_box(glue, run, radius);
        for (int k = 0; k < 3; k++) {
            outline->near_box.low[k] = fmin(outline->near_box.low[k], box.low[k]);
            outline->near_box.high[k] = fmax(outline->near_box.high[k], box.high[k]);
        }
        pir_vertex_grid_find(&glue->grid, space, glue->point, box, &glue->found);
        for (uint32_t i = 0; i < glue->found.count; i++) {
            const uint32_t v = glue->found.number[i];
            if (v == run->a || v == run->b || (skin > 0 && !is_near(glue, run, v, radius)))
                continue;
            pir_number_list_add(&outline->near, space, r);
            pir_number_list_add(&outline->near, space, v);
        }
    }
    // an edge and a vertex approach by no more than both go
    outline->near_until = glue->way + skin / 2;
    outline->is_listed = space->status == PIR_OK;
}

static bool is_known(const pir_number_list *list, uint32_t r, uint32_t v) {
    for (uint32_t i = 0; i < list->count; i += 2)
        if (list->number[i] == r && list->number[i + 1] == v)
            return true;
    return false;
}

/* Lists a vertex as near run r, in the order of runs. */
static void insert_near(pir_kept_glue *glue, pir_number_list *near, uint32_t r, uint32_t v) {
    if (is_known(near, r, v))
        return;
    pir_number_list_add(near, glue->space, r);
    pir_number_list_add(near, glue->space, v);
    if (glue->space->status != PIR_OK)
        return;
    for (uint32_t at = near->count - 2; at > 0 && near->number[at - 2] > r; at -= 2) {
        near->number[at] = near->number[at - 2];
        near->number[at + 1] = near->number[at - 1];
        near->number[at - 2] = r;
        near->number[at - 1] = v;
    }
}

/* Lists those fresh vertices that are near the runs of a facet, too. */
static void add_fresh(pir_kept_glue *glue, pir_facet_outline *outline) {
    const double radius = 2 * (outline->near_until - glue->way) + 16 * PIR_SPACE_ERROR;
    for (uint32_t i = 0; i < glue->fresh.count; i++) {
        const uint32_t v = glue->fresh.number[i];
        if (!pir_vertex_is_in(&outline->near_box, glue->place + 3 * (size_t)v))
            continue;
        for (uint32_t r = 0; r < outline->run_count; r++)
            if (is_near(glue, &outline->run[r], v, radius))
                insert_near(glue, &outline->near, r, v);
    }
}

/* Sees to it that each vertex that may be within a run of a facet is listed as near it. */
static void follow_near(pir_kept_glue *glue, pir_facet_outline *outline) {
    if (!outline->is_listed || glue->all_fresh || glue->way > outline->near_until)
        list_near(glue, outline);
    else
        add_fresh(glue, outline);
}

/* --- touches --- */

/* Whether doubles say that a point is off a plane. */
static bool is_off(const pir_space *space, uint32_t plane, uint32_t point) {
    const pir_space_plane *f = &space->plane[plane];
    const pir_space_point *p = &space->point[point];
    const double s = f->n[0] * p->x[0] + f->n[1] * p->x[1] + f->n[2] * p->x[2] - f->d;
    return fabs(s) > f->err + p->err + 0x1p-48;
}

/* Whether a vertex that doubles do not tell to be off the line of a run is within it. */
static bool is_within(pir_kept_glue *glue, const pir_kept_run *run, const uint32_t plane[2], uint32_t v, bool known) {
    pir_space *space = glue->space;
    const uint32_t point = glue->point[v], a = glue->point[run->a], b = glue->point[run->b];
    for (int k = 0; k < 2 && !known; k++)
        if (pir_space_side(space, pir_half(plane[k], false), point) != 0)
            return false;
    const int way = order_along(space, plane, a, b);
    if (order_along(space, plane, a, point) != way || order_along(space, plane, point, b) != way)
        return false;
    for (int k = 0; k < 2 && !known; k++)
        glue->fleeting |= !pir_identity_holds(space, plane[k], point);
    return true;
}

/* Adds a touch of run r to the list, which has those of this run from `first` on, in their order. */
static void add_touch(pir_kept_glue *glue, uint32_t r, const uint32_t plane[2], const pir_kept_run *run, uint32_t v,
                      uint32_t first) {
    pir_number_list *touch = &glue->touch;
    pir_number_list_add(touch, glue->space, r);
    pir_number_list_add(touch, glue->space, v);
    if (glue->space->status != PIR_OK)
        return;
    const int way = order_along(glue->space, plane, glue->point[run->a], glue->point[run->b]);
    for (uint32_t at = touch->count - 2; at > first; at -= 2) {
        uint32_t *own = &touch->number[at + 1], *before = &touch->number[at - 1];
        if (order_along(glue->space, plane, glue->point[*before], glue->point[*own]) == way)
            break;
        const uint32_t swapped = *own;
        *own = *before;
        *before = swapped;
    }
}

/* Finds the vertices within the runs of a facet; whether they are as they were. */
static bool find_touches(pir_kept_glue *glue, pir_plane_facet *facet) {
    pir_space *space = glue->space;
    pir_facet_outline *outline = &facet->outline;
    const pir_number_list *near = &outline->near;
    glue->touch.count = 0;
    follow_near(glue, outline);
    for (uint32_t i = 0, first = 0; i < near->count && space->status == PIR_OK; i += 2) {
        const uint32_t r = near->number[i], v = near->number[i + 1];
        const pir_kept_run *run = &outline->run[r];
        const uint32_t plane[2] = {facet->half >> 1, run->plane};
        first = i > 0 && near->number[i - 2] == r ? first : glue->touch.count;
        if (v == run->a || v == run->b || glue->ended[v] != glue->calls || is_off(space, plane[0], glue->point[v]))
            continue;
        pir_space_renew_plane(space, plane[1]);
        if (!is_off(space, plane[1], glue->point[v]) && is_within(glue, run, plane, v, is_known(&outline->touch, r, v)))
            add_touch(glue, r, plane, run, v, first);
    }
    bool same = outline->touch.count == glue->touch.count;
    for (uint32_t i = 0; i < glue->touch.count && same; i++)
        same = outline->touch.number[i] == glue->touch.number[i];
    if (same)
        return true;
    outline->touch.count = 0;
    for (uint32_t i = 0; i < glue->touch.count; i++)
        pir_number_list_add(&outline->touch, space, glue->touch.number[i]);
    return false;
}

/* --- loops --- */

/* The runs of a facet, cut at what touches them. */
static void cut_runs(pir_kept_glue *glue, const pir_plane_facet *facet) {
    const pir_facet_outline *outline = &facet->outline;
    const pir_number_list *touch = &outline->touch;
    glue->cut.run_count = 0;
    uint32_t at = 0;
    for (uint32_t r = 0; r < outline->run_count; r++) {
        const pir_kept_run *run = &outline->run[r];
        pir_run part = {0, facet->half, run->line, glue->point[run->a], glue->point[run->b], run->sign};
        for (; at < touch->count && touch->number[at] == r; at += 2) {
            part.b = glue->point[touch->number[at + 1]];
            pir_union_outline_push(&glue->cut, part);
            part.a = part.b;
        }
        part.b = glue->point[run->b];
        pir_union_outline_push(&glue->cut, part);
    }
}

/* Traces the loops of a facet, and keeps them. They may differ at the next rotation where one goes round a hole, or a
 * vertex is met twice. */
static void trace(pir_kept_glue *glue, pir_plane_facet *facet, pir_loop_list *loops) {
    pir_space *space = glue->space;
    pir_facet_outline *outline = &facet->outline;
    const uint32_t first = loops->facet_count, holes = loops->hole_count;
    cut_runs(glue, facet);
    pir_loops_trace(loops, &glue->cut);
    outline->loop.count = outline->end.count = 0;
    outline->knotted = loops->hole_count > holes;
    glue->round++;
    for (uint32_t f = first, i = first > 0 ? loops->facet[first - 1] : 0; f < loops->facet_count; f++) {
        for (; i < loops->facet[f] && space->status == PIR_OK; i++) {
            const uint32_t v = glue->vertex[loops->facet_corner[i]];
            outline->knotted |= glue->mark[v] == glue->round;
            glue->mark[v] = glue->round;
            pir_number_list_add(&outline->loop, space, v);
        }
        pir_number_list_add(&outline->end, space, outline->loop.count);
    }
    outline->is_traced = space->status == PIR_OK;
}

/* Where a vertex is along the direction by which loops begin (facet_loops.c): (61, 53, 41). */
static double rank_of(const pir_kept_glue *glue, uint32_t v) {
    const double *x = glue->space->point[glue->point[v]].x;
    return 61 * x[0] + 53 * x[1] + 41 * x[2];
}

/* The doubt about a rank: two that differ by more than both doubts are sure. */
static double doubt_of(const pir_kept_glue *glue, uint32_t v) {
    return 156 * glue->space->point[glue->point[v]].err + 0x1p-42;
}

/* The corner at which a loop of corners begin .. end begins; none where doubles do not tell. */
static uint32_t first_corner(const pir_kept_glue *glue, const uint32_t *corner, uint32_t begin, uint32_t end) {
    uint32_t best = begin;
    double least = rank_of(glue, corner[begin]);
    for (uint32_t i = begin + 1; i < end; i++) {
        const double rank = rank_of(glue, corner[i]);
        best = rank < least ? i : best;
        least = rank < least ? rank : least;
    }
    const double doubt = doubt_of(glue, corner[best]);
    for (uint32_t i = begin; i < end; i++)
        if (i != best && rank_of(glue, corner[i]) - least <= doubt + doubt_of(glue, corner[i]))
            return PIR_SPACE_NONE;
    return best;
}

/* Puts the last loop listed in order among those before it, by where they begin; false where doubles do not tell. */
static bool insert_loop(const pir_kept_glue *glue, const uint32_t *corner) {
    uint32_t *first = glue->first.number;
    for (uint32_t at = glue->first.count - 2; at > 0; at -= 2) {
        const uint32_t own[2] = {first[at], first[at + 1]}, before[2] = {first[at - 2], first[at - 1]};
        const double by = rank_of(glue, corner[own[1]]) - rank_of(glue, corner[before[1]]);
        if (fabs(by) <= doubt_of(glue, corner[own[1]]) + doubt_of(glue, corner[before[1]]))
            return false;
        if (by > 0)
            break;
        first[at] = before[0];
        first[at + 1] = before[1];
        first[at - 2] = own[0];
        first[at - 1] = own[1];
    }
    return true;
}

/* Adds the loops that a facet has kept, each from where it begins now on, and in the order of these; false where
 * doubles do not tell it. */
static bool add_loops(pir_kept_glue *glue, const pir_facet_outline *outline, pir_loop_list *loops) {
    pir_space *space = glue->space;
    const uint32_t *corner = outline->loop.number, *end = outline->end.number;
    pir_number_list *first = &glue->first;
    first->count = 0;
    for (uint32_t l = 0; l < outline->end.count; l++) {
        const uint32_t at = first_corner(glue, corner, l > 0 ? end[l - 1] : 0, end[l]);
        pir_number_list_add(first, space, l);
        pir_number_list_add(first, space, at);
        if (at == PIR_SPACE_NONE || space->status != PIR_OK || !insert_loop(glue, corner))
            return false;
    }
    for (uint32_t i = 0; i < first->count; i += 2) {
        const uint32_t l = first->number[i], begin = l > 0 ? end[l - 1] : 0, from = first->number[i + 1];
        for (uint32_t k = begin, at = from; k < end[l]; k++, at = at + 1 < end[l] ? at + 1 : begin)
            pir_loops_push_corner(loops, glue->point[corner[at]]);
        pir_loops_end_facet(loops);
    }
    return true;
}

/* --- all --- */

static bool prepare(pir_kept_glue *glue, pir_plane_facet *const *facet, uint32_t count) {
    pir_space *space = glue->space;
    const uint32_t points = space->point_count, before = glue->met_room;
    const bool room = pir_space_grow(space, (void **)&glue->vertex, &glue->vertex_room, points, sizeof *glue->vertex) &&
                      pir_space_grow(space, (void **)&glue->met, &glue->met_room, points, sizeof *glue->met);
    for (uint32_t p = before; p < glue->met_room; p++)
        glue->met[p] = 0;
    glue->calls++;
    glue->gridded = false;
    if (glue->fleeting)
        forget(facet, count);
    glue->fleeting = false;
    find_points(glue, facet, count);
    if (room && !place_vertices(glue) && space->status == PIR_OK) {
        // numbers say that two vertices are one, at this rotation
        forget(facet, count);
        find_points(glue, facet, count);
        glue->fleeting = true;
        return place_vertices(glue);
    }
    return space->status == PIR_OK;
}

bool pir_kept_glue_make(pir_kept_glue *glue, pir_plane_facet *const *facet, const uint32_t *order, uint32_t count,
                        pir_loop_list *loops, uint32_t *ret_edges) {
    pir_space *space = glue->space;
    uint32_t sides = 0;
    if (!prepare(glue, facet, count) || !make_outlines(glue, facet, order, count))
        return false;
    note_ends(glue, facet, count);
    for (uint32_t i = 0; i < count && space->status == PIR_OK; i++) {
        pir_plane_facet *own = facet[order[i]];
        pir_facet_outline *outline = &own->outline;
        if (own->edge.count == 0)
            continue;
        const bool same = find_touches(glue, own);
        sides += outline->run_count + outline->touch.count / 2;
        if (!same || !outline->is_traced || outline->knotted || !add_loops(glue, outline, loops))
            trace(glue, own, loops);
    }
    loops->boundary_count = loops->facet_count;
    *ret_edges = sides / 2;
    return space->status == PIR_OK;
}
