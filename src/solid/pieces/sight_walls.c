/* SPDX-License-Identifier: MIT */
/*
 * The sight wall of a reflex edge that is not vertical is the set of points that a vertical segment within the body
 * joins with the edge (Hachenberger 2008). Its part below the edge stands on the highest floor below, its part above
 * the edge stands on the edge itself. So all walls are lines in the map of the floors: sides of reflex edges between
 * floors, which are closed from the start, and for edges with a ceiling beside them what of their way lies on the
 * highest floor below.
 *
 * Between walls only vertical edges are reflex: where closed sides make more than 180 degrees. There a wall goes on
 * beyond the edge, through all of the cell up to what is closed (the paper's second step). What is left is convex: the
 * faces that open sides join make a convex polygon, over it floors are convex and ceilings concave. A piece is cut out
 * of the box by the walls round its polygon, its floors, and the ceilings that its floors see.
 *
 * With r reflex edges there are O(r²) crossings of walls, so O(r²) vertical reflex edges, each resolved by one wall,
 * which divides one cell in two: O(r²) pieces.
 */
#include "solid/pieces/sight_walls.h"

#include "base/sort.h"
#include "solid/pieces/floor_map.h"
#include "solid/space/exact.h"
#include "solid/space/polygons.h"

/* A stretch of the way of an edge over a floor: from where vertical plane ends[0] meets it to ends[1]. */
struct floor_line {
    uint32_t part, wall, ends[2];
};

/* Where an edge meets a vertical plane. */
struct stop {
    uint32_t plane, point; /* on the edge */
};

/* A floor under an edge, between two stops. */
struct under {
    uint32_t part, from, to; /* stops */
    int side;                /* of the way that all of it is on: 1 right, −1 left; 0: on both */
};

struct sight_walls {
    const pir_shell_body *body;
    pir_space *space;
    pir_cells *cells;
    pir_piece_list *pieces;
    pir_floor_map map;
    pir_polygons ceilings; /* the ceilings' parts, in front of scratch */
    uint32_t ceiling_count;
    struct floor_line *line;
    struct stop *stop; /* of the edge at hand */
    uint32_t *order, *work, *rank;
    struct under *under;
    uint32_t *group, *first, *link; /* per face: a face of its piece; the first of the piece, the next of it */
    uint32_t *plane;                /* half-spaces of the piece at hand */
    struct view {
        uint32_t ceiling, polygon; /* what of it is over the piece */
    } * view;
    uint32_t line_count, line_room, stop_count, stop_room, order_room, work_room, rank_room, under_count, under_room;
    uint32_t group_room, first_room, link_room, plane_count, plane_room, view_count, view_room;
};

/* --- the lines of walls on floors --- */

static uint32_t add_stop(struct sight_walls *s, uint32_t plane, uint32_t point) {
    if (!pir_space_grow(s->space, (void **)&s->stop, &s->stop_room, s->stop_count, sizeof *s->stop))
        return 0;
    s->stop[s->stop_count] = (struct stop){plane, point};
    return s->stop_count++;
}

/* A vertical plane through a point that is not parallel to that of the wall. */
static uint32_t plane_across(struct sight_walls *s, uint32_t wall, uint32_t point) {
    const pir_space_plane *plane = &s->space->plane[wall >> 1];
    const mpz_t *along = (const mpz_t *)s->space->number + s->space->direction[plane->direction[0]].exact;
    const int axis = mpz_cmpabs(along[0], along[1]) >= 0 ? 0 : 1;
    return pir_space_add_plane(s->space, (const uint32_t[]){s->space->axis[axis], PIR_SPACE_NONE}, false,
                               (const uint32_t[]){point, PIR_SPACE_NONE});
}

/* The stop of the edge over a point of its way, which a vertical plane holds: the first two stops are the edge's ends,
 * and the first stands for all that is before it, the second for all that is after. */
static uint32_t stop_over(struct sight_walls *s, const pir_shell_body_edge *edge, uint32_t point, uint32_t wall) {
    const uint32_t first = pir_half(s->stop[0].plane, false), last = pir_half(s->stop[1].plane, false);
    if (pir_space_side(s->space, first, point) * pir_space_side(s->space, first, edge->b) <= 0)
        return 0;
    if (pir_space_side(s->space, last, point) * pir_space_side(s->space, last, edge->a) <= 0)
        return 1;
    const uint32_t *plane = s->body->plane;
    return add_stop(s, wall >> 1, pir_space_add_meet(s->space, plane[edge->left], plane[edge->right], wall >> 1));
}

/* Where the line of a wall meets the rim of a floor, in stops of the edge: two, or fewer where no stretch is in the
 * floor. ret_all tells whether the floor has corners left of the line, and right of it. */
static uint32_t cross_rim(struct sight_walls *s, const pir_shell_body_edge *edge, uint32_t part, uint32_t wall,
                          uint32_t ret_stop[2], bool ret_all[2]) {
    const uint32_t first = s->map.face[part].side, floor = s->map.face[part].half >> 1;
    uint32_t side = first, count = 0;
    do {
        const pir_floor_side own = s->map.side[side], next = s->map.side[own.next], before = s->map.side[own.prev];
        const int at = pir_space_side(s->space, wall, own.origin), to = pir_space_side(s->space, wall, next.origin);
        const int from = pir_space_side(s->space, wall, before.origin);
        ret_all[0] = ret_all[0] || at < 0;
        ret_all[1] = ret_all[1] || at > 0;
        if (count < 2 && at == 0 && (to != 0 || from != 0))
            ret_stop[count++] = stop_over(s, edge, own.origin, to != 0 ? own.wall : before.wall);
        else if (count < 2 && at * to < 0)
            ret_stop[count++] =
                stop_over(s, edge, pir_space_add_meet(s->space, floor, wall >> 1, own.wall >> 1), own.wall);
        side = own.next;
    } while (side != first && s->space->status == PIR_OK);
    return count;
}

/* Notes a floor if it is under a stretch of the edge. */
static void look_under(struct sight_walls *s, const pir_shell_body_edge *edge, uint32_t part, uint32_t wall) {
    const uint32_t before = s->stop_count;
    uint32_t stop[2] = {0};
    bool all[2] = {false, false};
    const uint32_t count = cross_rim(s, edge, part, wall, stop, all);
    if (count < 2 || stop[0] == stop[1] || s->space->status != PIR_OK) {
        s->stop_count = before;
        return;
    }
    const bool turned =
        stop[0] == 1 || stop[1] == 0 ||
        (stop[0] > 1 && stop[1] > 1 &&
         pir_space_order(s->space, edge->direction, s->stop[stop[0]].point, s->stop[stop[1]].point) < 0);
    if (pir_space_grow(s->space, (void **)&s->under, &s->under_room, s->under_count, sizeof *s->under))
        s->under[s->under_count++] = (struct under){part, stop[turned], stop[!turned], all[1] - all[0]};
}

struct stops {
    struct sight_walls *s;
    uint32_t direction;
};

static bool stop_before(void *context, uint32_t a, uint32_t b) {
    const struct stops *stops = context;
    const struct stop *stop = stops->s->stop;
    return pir_space_order(stops->s->space, stops->direction, stop[a].point, stop[b].point) > 0;
}

/* Sorts the stops along the edge; equal ones have one rank, and `order` has one of each. How many they are. */
static uint32_t sort_stops(struct sight_walls *s, uint32_t direction) {
    const uint32_t count = s->stop_count;
    struct stops stops = {s, direction};
    if (!pir_space_grow(s->space, (void **)&s->order, &s->order_room, count, sizeof *s->order) ||
        !pir_space_grow(s->space, (void **)&s->work, &s->work_room, count, sizeof *s->work) ||
        !pir_space_grow(s->space, (void **)&s->rank, &s->rank_room, count, sizeof *s->rank))
        return 0;
    for (uint32_t i = 0; i < count; i++)
        s->order[i] = i;
    pir_sort(s->order, count, s->work, stop_before, &stops);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (i == 0 || stop_before(&stops, s->order[kept - 1], s->order[i]))
            s->order[kept++] = s->order[i];
        s->rank[s->order[i]] = kept - 1;
    }
    return kept;
}

/* The sign of how far one floor is above another between two successive stops; other PIR_SPACE_NONE: the edge. */
static int is_above(struct sight_walls *s, const uint32_t stop[2], uint32_t wall, uint32_t part, uint32_t other) {
    int sum = 0;
    for (int k = 0; k < 2; k++) {
        const struct stop *at = &s->stop[stop[k]];
        const uint32_t point = other == PIR_SPACE_NONE
                                   ? at->point
                                   : pir_space_add_meet(s->space, s->map.face[other].half >> 1, wall >> 1, at->plane);
        sum += pir_space_side(s->space, s->map.face[part].half, point);
    }
    return sum;
}

/* Whether the facets at an edge that lies on a floor are above it: else the edge touches the floor from outside. */
static bool is_stood_on(struct sight_walls *s, const pir_shell_body_edge *edge, uint32_t part) {
    const pir_space_plane *plane = s->space->plane;
    const uint32_t floor = plane[s->map.face[part].half >> 1].direction[0];
    const uint32_t left = plane[s->body->plane[edge->left]].direction[0];
    const uint32_t right = plane[s->body->plane[edge->right]].direction[0];
    // a facet leads away from its edge along the product of its normal and the edge
    return pir_space_det(s->space, floor, left, edge->direction) <= 0 &&
           pir_space_det(s->space, floor, right, edge->direction) >= 0;
}

/* The highest floor under the edge between the stop of this rank and the next, or none. One that the edge lies on
 * counts where it is on both sides of the way. */
static uint32_t highest_under(struct sight_walls *s, const pir_shell_body_edge *edge, uint32_t rank, uint32_t wall) {
    const uint32_t stop[2] = {s->order[rank], s->order[rank + 1]};
    uint32_t best = PIR_SPACE_NONE, left = PIR_SPACE_NONE, right = PIR_SPACE_NONE;
    for (uint32_t i = 0; i < s->under_count && s->space->status == PIR_OK; i++) {
        const struct under *under = &s->under[i];
        if (s->rank[under->from] > rank || s->rank[under->to] <= rank)
            continue;
        const int above = is_above(s, stop, wall, under->part, PIR_SPACE_NONE);
        const bool on = above == 0 && is_stood_on(s, edge, under->part);
        if (on && under->side <= 0)
            left = under->part;
        if (on && under->side >= 0)
            right = under->part;
        if (above < 0 && (best == PIR_SPACE_NONE || is_above(s, stop, wall, under->part, best) > 0))
            best = under->part;
    }
    return left != PIR_SPACE_NONE && right != PIR_SPACE_NONE ? left : best;
}

static void add_line(struct sight_walls *s, struct floor_line line) {
    if (pir_space_grow(s->space, (void **)&s->line, &s->line_room, s->line_count, sizeof *s->line))
        s->line[s->line_count++] = line;
}

/* The lines of the wall below an edge. */
static void look_down(struct sight_walls *s, const pir_shell_body_edge *edge) {
    const uint32_t wall = pir_floor_wall(&s->map, edge->a, edge->b);
    s->stop_count = s->under_count = 0;
    add_stop(s, plane_across(s, wall, edge->a), edge->a);
    add_stop(s, plane_across(s, wall, edge->b), edge->b);
    for (uint32_t part = 0; part < s->map.face_count && s->space->status == PIR_OK; part++)
        look_under(s, edge, part, wall);
    const uint32_t count = sort_stops(s, edge->direction);
    for (uint32_t rank = count ? s->rank[0] : 0; count && rank < s->rank[1] && s->space->status == PIR_OK; rank++) {
        const uint32_t part = highest_under(s, edge, rank, wall), from = s->stop[s->order[rank]].plane;
        struct floor_line *last = s->line_count ? &s->line[s->line_count - 1] : NULL;
        const uint32_t to = s->stop[s->order[rank + 1]].plane;
        if (part == PIR_SPACE_NONE)
            continue;
        if (last && last->part == part && last->wall == wall && last->ends[1] == from)
            last->ends[1] = to;
        else
            add_line(s, (struct floor_line){part, wall, {from, to}});
    }
}

/* Draws all walls: below edges first, then beyond vertical ones. */
static void draw_walls(struct sight_walls *s) {
    const pir_shell_body *body = s->body;
    for (uint32_t e = 0; e < body->edge_count && s->space->status == PIR_OK; e++) {
        const pir_shell_body_edge *edge = &body->edge[e];
        if (edge->bend == PIR_BEND_REFLEX &&
            (pir_facet_rise(body, edge->left) > 0 || pir_facet_rise(body, edge->right) > 0))
            look_down(s, edge);
    }
    for (uint32_t i = 0; i < s->line_count && s->space->status == PIR_OK; i++)
        pir_floor_map_draw(&s->map, s->line[i].part, s->line[i].wall, s->line[i].ends);
    // a wall that closes an open side may leave an angle there, where sides have been looked at before
    uint32_t closings;
    do {
        closings = s->map.closings;
        for (uint32_t side = 0; side < s->map.side_count && s->space->status == PIR_OK; side++)
            pir_floor_map_extend(&s->map, side);
    } while (s->map.closings != closings && s->space->status == PIR_OK);
}

/* --- pieces --- */

static uint32_t root_of(const struct sight_walls *s, uint32_t face) {
    while (s->group[face] != face)
        face = s->group[face] = s->group[s->group[face]];
    return face;
}

/* Lists the faces of each piece. */
static void group_faces(struct sight_walls *s) {
    const uint32_t count = s->map.face_count;
    if (!pir_space_grow(s->space, (void **)&s->group, &s->group_room, count, sizeof *s->group) ||
        !pir_space_grow(s->space, (void **)&s->first, &s->first_room, count, sizeof *s->first) ||
        !pir_space_grow(s->space, (void **)&s->link, &s->link_room, count, sizeof *s->link))
        return;
    for (uint32_t f = 0; f < count; f++)
        s->group[f] = f, s->first[f] = PIR_SPACE_NONE;
    for (uint32_t side = 0; side < s->map.side_count; side++) {
        const pir_floor_side *own = &s->map.side[side];
        if (own->closed)
            continue;
        const uint32_t a = root_of(s, own->face), b = root_of(s, s->map.side[own->twin].face);
        s->group[a > b ? a : b] = a < b ? a : b;
    }
    for (uint32_t f = count; f-- > 0;) {
        const uint32_t root = root_of(s, f);
        s->link[f] = s->first[root];
        s->first[root] = f;
    }
}

static void add_plane(struct sight_walls *s, uint32_t half) {
    for (uint32_t i = 0; i < s->plane_count; i++)
        if (s->plane[i] == half)
            return;
    if (pir_space_grow(s->space, (void **)&s->plane, &s->plane_room, s->plane_count, sizeof *s->plane))
        s->plane[s->plane_count++] = half;
}

/* The floors of a piece, then the walls round it; how many floors there are. */
static uint32_t list_planes(struct sight_walls *s, uint32_t first) {
    s->plane_count = 0;
    for (uint32_t f = first; f != PIR_SPACE_NONE; f = s->link[f])
        add_plane(s, s->map.face[f].half);
    const uint32_t floors = s->plane_count;
    for (uint32_t f = first; f != PIR_SPACE_NONE; f = s->link[f]) {
        uint32_t side = s->map.face[f].side;
        do {
            if (s->map.side[side].closed)
                add_plane(s, s->map.side[side].wall);
            side = s->map.side[side].next;
        } while (side != s->map.face[f].side);
    }
    return floors;
}

/* The part of a ceiling that is within the walls of the piece, a polygon, or none. */
static uint32_t clip_ceiling(struct sight_walls *s, uint32_t ceiling, uint32_t floors) {
    pir_polygons *polygons = &s->ceilings;
    uint32_t left = ceiling;
    for (uint32_t i = floors; i < s->plane_count && s->space->status == PIR_OK; i++) {
        const unsigned sides = pir_polygons_sides(polygons, left, s->plane[i]);
        if (!(sides & 1))
            return PIR_SPACE_NONE;
        if (!(sides & 2))
            continue;
        uint32_t parts[2];
        pir_polygons_cut(polygons, left, s->plane[i], parts);
        left = parts[0];
    }
    return left;
}

/* Lists the ceilings over a piece, of whatever height. */
static void list_views(struct sight_walls *s, uint32_t floors) {
    s->view_count = 0;
    for (uint32_t c = 0; c < s->ceiling_count && s->space->status == PIR_OK; c++) {
        const uint32_t polygon = clip_ceiling(s, c, floors);
        if (polygon != PIR_SPACE_NONE &&
            pir_space_grow(s->space, (void **)&s->view, &s->view_room, s->view_count, sizeof *s->view))
            s->view[s->view_count++] = (struct view){c, polygon};
    }
}

/* The middle of a polygon's first three corners, which are no line. */
static uint32_t middle_of(struct sight_walls *s, uint32_t polygon) {
    const uint32_t *corner = s->ceilings.point + s->ceilings.polygon[polygon].first;
    const uint32_t exact[3] = {pir_space_exact_point(s->space, corner[0]), pir_space_exact_point(s->space, corner[1]),
                               pir_space_exact_point(s->space, corner[2])};
    mpz_t sum[4], share;
    mpz_init(share);
    for (int k = 0; k < 4; k++)
        mpz_init(sum[k]);
    const mpz_t *number = (const mpz_t *)s->space->number;
    for (int i = 0; i < 3; i++) {
        mpz_mul(share, number[exact[(i + 1) % 3] + 3], number[exact[(i + 2) % 3] + 3]);
        for (int k = 0; k < 4; k++)
            mpz_addmul(sum[k], share, number[exact[i] + (uint32_t)k]);
    }
    const uint32_t made = pir_space_add_point(s->space, sum[0], sum[1], sum[2], sum[3]);
    mpz_clear(share);
    for (int k = 0; k < 4; k++)
        mpz_clear(sum[k]);
    return made;
}

/* The point of a ceiling's plane above or below a point. */
static uint32_t lift(struct sight_walls *s, uint32_t point, uint32_t half) {
    const uint32_t p = pir_space_exact_point(s->space, point), f = pir_space_exact_plane(s->space, half >> 1);
    mpz_t x[4];
    for (int k = 0; k < 4; k++)
        mpz_init(x[k]);
    const mpz_t *at = (const mpz_t *)s->space->number + p, *plane = (const mpz_t *)s->space->number + f;
    mpz_mul(x[2], plane[3], at[3]);
    for (int k = 0; k < 2; k++) {
        mpz_mul(x[k], at[k], plane[2]);
        mpz_submul(x[2], plane[k], at[k]);
    }
    mpz_mul(x[3], at[3], plane[2]);
    for (int k = 0; k < 4 && mpz_sgn(x[3]) < 0; k++)
        mpz_neg(x[k], x[k]);
    if (mpz_sgn(x[3]) < 0)
        mpz_neg(x[3], x[3]);
    const uint32_t made = pir_space_add_point(s->space, x[0], x[1], x[2], x[3]);
    for (int k = 0; k < 4; k++)
        mpz_clear(x[k]);
    return made;
}

/* Whether a point is above or on all floors of the piece. */
static bool is_over_floors(struct sight_walls *s, uint32_t point, uint32_t floors) {
    for (uint32_t i = 0; i < floors; i++)
        if (pir_space_side(s->space, s->plane[i], point) > 0)
            return false;
    return true;
}

/* Whether a ceiling is between the floors of the piece and a point above them. */
static bool hides(struct sight_walls *s, uint32_t ceiling, uint32_t point, uint32_t floors) {
    const pir_polygon polygon = s->ceilings.polygon[ceiling];
    if (pir_space_side(s->space, polygon.half, point) <= 0)
        return false;
    for (uint32_t i = 0; i < polygon.count; i++)
        if (pir_space_side(s->space, s->ceilings.wall[polygon.first + i], point) > 0)
            return false;
    return is_over_floors(s, lift(s, point, polygon.half), floors);
}

/* Whether the floors of a piece see a ceiling that is over it. */
static bool is_seen(struct sight_walls *s, const struct view *view, uint32_t floors) {
    const uint32_t middle = middle_of(s, view->polygon);
    if (!is_over_floors(s, middle, floors))
        return false;
    for (uint32_t i = 0; i < s->view_count && s->space->status == PIR_OK; i++)
        if (s->view[i].ceiling != view->ceiling && hides(s, s->view[i].ceiling, middle, floors))
            return false;
    return true;
}

/* Cuts a piece out of the box. */
static void make_piece(struct sight_walls *s, uint32_t first) {
    const uint32_t floors = list_planes(s, first);
    list_views(s, floors);
    for (uint32_t i = 0; i < s->view_count && s->space->status == PIR_OK; i++)
        if (is_seen(s, &s->view[i], floors))
            add_plane(s, s->ceilings.polygon[s->view[i].ceiling].half);
    pir_polygons_truncate(&s->ceilings, s->ceiling_count);
    uint32_t cell = pir_cells_add_box(s->cells);
    for (uint32_t i = 0; i < s->plane_count && s->space->status == PIR_OK; i++) {
        uint32_t parts[2];
        pir_cells_cut(s->cells, cell, s->plane[i], parts);
        cell = parts[0];
        if (cell == PIR_SPACE_NONE)
            pir_space_fault(s->space);
    }
    if (s->space->status == PIR_OK)
        pir_piece_list_add(s->pieces, s->space, cell);
}

/* The ceilings' parts, with vertical walls: so these tell what is below a ceiling. */
static void add_ceilings(struct sight_walls *s) {
    const pir_shell_body *body = s->body;
    pir_polygons *polygons = &s->ceilings;
    pir_polygons_init(polygons, s->space);
    for (uint32_t p = 0; p < body->part_count && s->space->status == PIR_OK; p++) {
        if (pir_facet_rise(body, body->part_facet[p]) <= 0)
            continue;
        const uint32_t *corner = body->part_corner + body->part_start[p];
        const uint32_t count = body->part_start[p + 1] - body->part_start[p];
        const uint32_t made = pir_polygons_add(polygons, body->half[body->part_facet[p]], corner,
                                               body->part_direction + body->part_start[p], NULL, count);
        for (uint32_t i = 0; i < count && s->space->status == PIR_OK; i++)
            polygons->wall[polygons->polygon[made].first + i] =
                pir_floor_wall(&s->map, corner[i], corner[i + 1 < count ? i + 1 : 0]);
    }
    s->ceiling_count = polygons->count;
}

void pir_decompose_by_sight(const pir_shell_body *body, pir_cells *cells, pir_piece_list *pieces) {
    pir_space *space = body->space;
    struct sight_walls s = {.body = body, .space = space, .cells = cells, .pieces = pieces};
    pir_floor_map_init(&s.map, body);
    add_ceilings(&s);
    if (space->status == PIR_OK)
        draw_walls(&s);
    if (space->status == PIR_OK)
        group_faces(&s);
    for (uint32_t f = 0; f < s.map.face_count && space->status == PIR_OK; f++)
        if (s.first[f] != PIR_SPACE_NONE) {
            space->stage.done++;
            make_piece(&s, s.first[f]);
        }
    pir_polygons_finish(&s.ceilings);
    pir_floor_map_finish(&s.map);
    pir_space_shrink(space, s.line, s.line_room, sizeof *s.line);
    pir_space_shrink(space, s.stop, s.stop_room, sizeof *s.stop);
    pir_space_shrink(space, s.order, s.order_room, sizeof *s.order);
    pir_space_shrink(space, s.work, s.work_room, sizeof *s.work);
    pir_space_shrink(space, s.rank, s.rank_room, sizeof *s.rank);
    pir_space_shrink(space, s.under, s.under_room, sizeof *s.under);
    pir_space_shrink(space, s.group, s.group_room, sizeof *s.group);
    pir_space_shrink(space, s.first, s.first_room, sizeof *s.first);
    pir_space_shrink(space, s.link, s.link_room, sizeof *s.link);
    pir_space_shrink(space, s.plane, s.plane_room, sizeof *s.plane);
    pir_space_shrink(space, s.view, s.view_room, sizeof *s.view);
}
