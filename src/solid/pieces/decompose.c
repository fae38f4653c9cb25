/* SPDX-License-Identifier: MIT */
/*
 * Space is divided by planes of facets until the body is convex in every cell: a binary space partition (Fuchs, Kedem,
 * Naylor 1980) that stops early.
 *
 * A cell holds fragments, the parts of facets that are in its inside, and creases, the parts of reflex edges there.
 * When every fragment is on or below the plane of every other, the body in the cell is the cell cut by those
 * planes: that convex set K has the fragments in its boundary and none within, so its inside is inside the body,
 * and since K's other faces are in the cell's boundary, whatever else of the cell the body held would meet K in the
 * inside of the cell with no fragment between. Otherwise the cell is cut by the plane of one of its fragments. A
 * cell without fragments is what a side of the cut was: below the fragment whose plane it was, inside.
 *
 * Which plane: one that resolves many creases, which is to hold them, and that cuts few fragments. By facets it is the
 * plane of one. By walls it is, while creases are left, a vertical plane through one, or the plane of a facet at a
 * vertical one (Hachenberger 2008: walls that points of reflex edges see up and down; here they end where the cell
 * does). On both sides of a plane that holds a crease some of the body is next to the crease, so a cell without
 * fragments there is inside.
 */
#include "solid/pieces/decompose.h"

#include <string.h>

#include "base/sort.h"
#include "solid/space/polygons.h"

struct node {
    uint32_t cell;
    uint32_t fragment, fragment_count; /* in `list` */
    uint32_t crease, crease_count;     /* in `creases` */
    bool inside;                       /* when there are no fragments */
};

struct crease {
    uint32_t a, b;     /* points */
    uint32_t plane[2]; /* of its facets */
    uint32_t wall[2];  /* half-spaces to cut by: twice the same where it is not vertical */
    bool vertical;
};

struct division {
    const pir_body *body;
    pir_decompose_method method;
    pir_space *space;
    pir_cells *cells;
    pir_piece_list *pieces;
    pir_polygons polygons;
    struct node *node;
    uint32_t node_count, node_room;
    uint32_t *list;
    uint32_t list_count, list_room;
    uint32_t *above; /* scratch: fragments above the plane of a cut */
    uint32_t above_count, above_room;
    struct crease *creases;
    uint32_t crease_count, crease_room;
    uint32_t *seen; /* per plane: the last look that came to it */
    uint32_t seen_room, look;
    struct choice *choice; /* scratch: the planes of a node */
    uint32_t *order, *work;
    uint32_t choice_room, order_room, work_room;
    uint8_t *side; /* per plane of a facet and given point: 0, or the side that it is on, and 2 */
    uint32_t side_room, first_plane, planes, points;
};

/* Numbers of sides that are kept; a body that has more is asked anew each time. */
#define MOST_SIDES (1u << 20)

void pir_piece_list_add(pir_piece_list *pieces, pir_space *space, uint32_t cell) {
    if (pir_space_grow(space, (void **)&pieces->cell, &pieces->room, pieces->count, sizeof *pieces->cell))
        pieces->cell[pieces->count++] = cell;
}

void pir_piece_list_finish(pir_piece_list *pieces, pir_space *space) {
    pir_space_shrink(space, pieces->cell, pieces->room, sizeof *pieces->cell);
    *pieces = (pir_piece_list){0};
}

static void push_fragment(struct division *d, uint32_t polygon) {
    if (pir_space_grow(d->space, (void **)&d->list, &d->list_room, d->list_count, sizeof *d->list))
        d->list[d->list_count++] = polygon;
}

static void push_crease(struct division *d, struct crease crease) {
    if (pir_space_grow(d->space, (void **)&d->creases, &d->crease_room, d->crease_count, sizeof *d->creases))
        d->creases[d->crease_count++] = crease;
}

static void push_node(struct division *d, struct node node) {
    if (pir_space_grow(d->space, (void **)&d->node, &d->node_room, d->node_count, sizeof *d->node))
        d->node[d->node_count++] = node;
}

static uint32_t half_of(const struct division *d, uint32_t at) {
    return d->polygons.polygon[d->list[at]].half;
}

/* --- the choice of a plane --- */

struct choice {
    uint32_t half;
    int64_t value;
};

/* Begins a look at each plane once. */
static void forget_planes(struct division *d) {
    const uint32_t before = d->seen_room, planes = d->space->plane_count;
    if (planes > before && !pir_space_grow(d->space, (void **)&d->seen, &d->seen_room, planes, sizeof *d->seen))
        return;
    for (uint32_t k = before; k < d->seen_room; k++)
        d->seen[k] = 0;
    d->look++;
}

/* Whether the plane of a half-space comes for the first time since. */
static bool is_new(struct division *d, uint32_t half) {
    const bool is = d->space->status == PIR_OK && d->seen[half >> 1] != d->look;
    if (is)
        d->seen[half >> 1] = d->look;
    return is;
}

/* Makes the table of sides, where it is small enough. */
static void begin_sides(struct division *d) {
    const pir_body *body = d->body;
    uint32_t first = PIR_SPACE_NONE, last = 0;
    for (uint32_t f = 0; f < body->source.facet_count; f++) {
        first = body->plane[f] < first ? body->plane[f] : first;
        last = body->plane[f] > last ? body->plane[f] : last;
    }
    const uint64_t sides = (uint64_t)(last - first + 1) * body->source.point_count;
    if (sides > MOST_SIDES || !pir_space_grow(d->space, (void **)&d->side, &d->side_room, sides, sizeof *d->side))
        return;
    memset(d->side, 0, d->side_room);
    d->first_plane = first;
    d->planes = last - first + 1;
    d->points = body->source.point_count;
}

/* The side of a plane that a point is on. */
static int side_of(struct division *d, uint32_t plane, uint32_t point) {
    const uint32_t row = plane - d->first_plane, column = point - d->body->first_point;
    if (row >= d->planes || column >= d->points)
        return pir_space_side(d->space, pir_half(plane, false), point);
    uint8_t *side = &d->side[(size_t)row * d->points + column];
    if (*side == 0)
        *side = (uint8_t)(pir_space_side(d->space, pir_half(plane, false), point) + 2);
    return *side - 2;
}

/* What a plane's creases count: those that it holds and, against it, those that it cuts. */
static int64_t value_of_creases(struct division *d, const struct node *node, uint32_t half) {
    int64_t value = 0;
    for (uint32_t i = node->crease; i < node->crease + node->crease_count; i++) {
        const int a = side_of(d, half >> 1, d->creases[i].a), b = side_of(d, half >> 1, d->creases[i].b);
        value += a == 0 && b == 0 ? 16 : a * b < 0 ? -8 : 0;
    }
    return value;
}

/* Takes fragments that a plane cuts from its value; whether it divides them and its value ends above `least`. */
static bool count_cuts(struct division *d, const struct node *node, struct choice *choice, int64_t least) {
    bool divides = false;
    for (uint32_t i = node->fragment; i < node->fragment + node->fragment_count && choice->value > least; i++) {
        const unsigned sides = pir_polygons_sides(&d->polygons, d->list[i], choice->half);
        choice->value -= sides == 3;
        divides = divides || sides >= 2;
    }
    return divides && choice->value > least;
}

/* The wall to cut by; none where no creases are left. Those of vertical creases come when no others are left. */
static uint32_t choose_wall(struct division *d, const struct node *node) {
    uint32_t best = PIR_SPACE_NONE;
    int64_t value = INT64_MIN;
    bool vertical = true;
    for (uint32_t i = node->crease; i < node->crease + node->crease_count; i++)
        vertical = vertical && d->creases[i].vertical;
    for (uint32_t i = node->crease; i < node->crease + node->crease_count && d->space->status == PIR_OK; i++) {
        const struct crease crease = d->creases[i];
        for (int k = 0; k < 2 && crease.vertical == vertical; k++) {
            struct choice choice = {crease.wall[k], value_of_creases(d, node, crease.wall[k])};
            count_cuts(d, node, &choice, value);
            if (choice.value > value)
                value = choice.value, best = choice.half;
        }
    }
    return best;
}

static bool is_worth_more(void *context, uint32_t a, uint32_t b) {
    const struct choice *choice = context;
    return choice[a].value > choice[b].value;
}

/* Lists the planes of a node, each once, with what creases count, into `order` the best first. */
static uint32_t list_choices(struct division *d, const struct node *node) {
    uint32_t count = 0;
    forget_planes(d);
    for (uint32_t i = node->fragment; i < node->fragment + node->fragment_count && d->space->status == PIR_OK; i++) {
        const uint32_t half = half_of(d, i);
        if (!is_new(d, half) ||
            !pir_space_grow(d->space, (void **)&d->choice, &d->choice_room, count, sizeof *d->choice))
            continue;
        d->choice[count++] = (struct choice){half, value_of_creases(d, node, half)};
    }
    if (!pir_space_grow(d->space, (void **)&d->order, &d->order_room, count, sizeof *d->order) ||
        !pir_space_grow(d->space, (void **)&d->work, &d->work_room, count, sizeof *d->work))
        return 0;
    for (uint32_t i = 0; i < count; i++)
        d->order[i] = i;
    pir_sort(d->order, count, d->work, is_worth_more, d->choice);
    return count;
}

/* The half-space to cut by, or none when every fragment is on or below the plane of every other. Of planes with the
 * best value it is the first. Fragments only take away, so that most planes are not held against them. */
static uint32_t choose_plane(struct division *d, const struct node *node) {
    uint32_t best = PIR_SPACE_NONE;
    int64_t value = INT64_MIN;
    for (uint32_t i = 0, count = list_choices(d, node); i < count && d->space->status == PIR_OK; i++) {
        const uint32_t at = d->order[i];
        const int64_t least = best == PIR_SPACE_NONE || at > best ? value : value - 1;
        if (d->choice[at].value < value)
            break;
        if (count_cuts(d, node, &d->choice[at], least)) {
            value = d->choice[at].value;
            best = at;
        }
    }
    return best == PIR_SPACE_NONE ? best : d->choice[best].half;
}

/* --- the cut --- */

static void push_above(struct division *d, uint32_t polygon) {
    if (pir_space_grow(d->space, (void **)&d->above, &d->above_room, d->above_count, sizeof *d->above))
        d->above[d->above_count++] = polygon;
}

static void cut_fragments(struct division *d, const struct node *node, uint32_t half, struct node child[2]) {
    child[0].fragment = d->list_count;
    d->above_count = 0;
    for (uint32_t i = node->fragment; i < node->fragment + node->fragment_count && d->space->status == PIR_OK; i++) {
        const uint32_t fragment = d->list[i];
        uint32_t parts[2] = {fragment, fragment};
        const unsigned sides = pir_polygons_sides(&d->polygons, fragment, half);
        if (sides == 3)
            pir_polygons_cut(&d->polygons, fragment, half, parts);
        if (sides & 1)
            push_fragment(d, parts[0]);
        if (sides & 2)
            push_above(d, parts[1]);
    }
    child[0].fragment_count = d->list_count - child[0].fragment;
    child[1].fragment = d->list_count;
    child[1].fragment_count = d->above_count;
    for (uint32_t i = 0; i < d->above_count; i++)
        push_fragment(d, d->above[i]);
}

static void cut_creases(struct division *d, const struct node *node, uint32_t half, struct node child[2]) {
    for (int above = 0; above < 2; above++) {
        const int keep = above ? 1 : -1;
        child[above].crease = d->crease_count;
        for (uint32_t i = node->crease; i < node->crease + node->crease_count; i++) {
            struct crease crease = d->creases[i];
            const int a = keep * pir_space_side(d->space, half, crease.a);
            const int b = keep * pir_space_side(d->space, half, crease.b);
            if (a <= 0 && b <= 0)
                continue;
            if (a * b < 0) {
                const uint32_t point = pir_space_add_meet(d->space, crease.plane[0], crease.plane[1], half >> 1);
                *(a < 0 ? &crease.a : &crease.b) = point;
            }
            push_crease(d, crease);
        }
        child[above].crease_count = d->crease_count - child[above].crease;
    }
}

/* `holds_crease`: the plane does, so that both sides are inside where they have no fragments. */
static void cut_node(struct division *d, const struct node *node, uint32_t half, bool holds_crease) {
    struct node child[2] = {{.inside = true}, {.inside = holds_crease}};
    uint32_t parts[2] = {0};
    pir_cells_cut(d->cells, node->cell, half, parts);
    cut_fragments(d, node, half, child);
    cut_creases(d, node, half, child);
    for (int above = 0; above < 2; above++) {
        child[above].cell = parts[above];
        if (parts[above] != PIR_SPACE_NONE)
            push_node(d, child[above]);
    }
}

/* The cell of a node, cut by the planes of all its fragments. */
static void keep_piece(struct division *d, const struct node *node) {
    uint32_t cell = node->cell;
    forget_planes(d);
    for (uint32_t i = node->fragment; i < node->fragment + node->fragment_count && cell != PIR_SPACE_NONE; i++) {
        uint32_t parts[2] = {0};
        if (!is_new(d, half_of(d, i)))
            continue;
        pir_cells_cut(d->cells, cell, half_of(d, i), parts);
        cell = parts[0];
    }
    if (cell != PIR_SPACE_NONE)
        pir_piece_list_add(d->pieces, d->space, cell);
}

static void divide(struct division *d) {
    while (d->node_count > 0 && d->space->status == PIR_OK) {
        const struct node node = d->node[--d->node_count];
        const bool by_wall = d->method == PIR_DECOMPOSE_WALLS && node.crease_count > 0;
        const uint32_t half = by_wall               ? choose_wall(d, &node)
                              : node.fragment_count ? choose_plane(d, &node)
                                                    : PIR_SPACE_NONE;
        if (half != PIR_SPACE_NONE)
            cut_node(d, &node, half, by_wall);
        else if (node.fragment_count || node.inside)
            keep_piece(d, &node);
    }
}

/* --- the whole --- */

/* The walls of a reflex edge. */
static struct crease crease_at(struct division *d, const pir_body_edge *edge, uint32_t up) {
    const pir_body *body = d->body;
    const uint32_t left = body->plane[edge->left], right = body->plane[edge->right];
    struct crease crease = {.a = edge->a, .b = edge->b, .plane = {left, right}};
    if (d->method != PIR_DECOMPOSE_WALLS)
        return crease;
    const mpz_t *along = (const mpz_t *)d->space->number + d->space->direction[edge->direction].exact;
    crease.vertical = mpz_sgn(along[0]) == 0 && mpz_sgn(along[1]) == 0;
    crease.wall[0] = pir_half(left, false);
    crease.wall[1] = pir_half(right, false);
    if (!crease.vertical)
        crease.wall[0] = crease.wall[1] =
            pir_half(pir_space_add_plane(d->space, (const uint32_t[]){edge->direction, up}, false,
                                         (const uint32_t[]){edge->a, PIR_SPACE_NONE}),
                     false);
    return crease;
}

static void begin(struct division *d) {
    const pir_body *body = d->body;
    struct node root = {.cell = pir_cells_add_box(d->cells)};
    for (uint32_t p = 0; p < body->part_count; p++)
        push_fragment(d, pir_polygons_add(&d->polygons, body->half[body->part_facet[p]],
                                          body->part_corner + body->part_start[p],
                                          body->part_direction + body->part_start[p],
                                          body->part_start[p + 1] - body->part_start[p]));
    for (uint32_t e = 0; e < body->edge_count; e++) {
        const pir_body_edge *edge = &body->edge[e];
        if (edge->bend == PIR_BEND_REFLEX)
            push_crease(d, crease_at(d, edge, d->polygons.axis[2]));
    }
    root.fragment_count = d->list_count;
    root.crease_count = d->crease_count;
    push_node(d, root);
}

pir_status pir_decompose(const pir_body *body, pir_decompose_method method, pir_cells *cells, pir_piece_list *pieces) {
    pir_space *space = body->space;
    struct division d = {.body = body, .method = method, .space = space, .cells = cells, .pieces = pieces};
    pir_polygons_init(&d.polygons, space);
    begin_sides(&d);
    begin(&d);
    divide(&d);
    pir_space_shrink(space, d.node, d.node_room, sizeof *d.node);
    pir_space_shrink(space, d.list, d.list_room, sizeof *d.list);
    pir_space_shrink(space, d.above, d.above_room, sizeof *d.above);
    pir_space_shrink(space, d.side, d.side_room, sizeof *d.side);
    pir_space_shrink(space, d.creases, d.crease_room, sizeof *d.creases);
    pir_space_shrink(space, d.seen, d.seen_room, sizeof *d.seen);
    pir_space_shrink(space, d.choice, d.choice_room, sizeof *d.choice);
    pir_space_shrink(space, d.order, d.order_room, sizeof *d.order);
    pir_space_shrink(space, d.work, d.work_room, sizeof *d.work);
    pir_polygons_finish(&d.polygons);
    return space->status;
}
