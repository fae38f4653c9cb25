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
 * Which plane: that of a fragment which resolves many creases, which is to hold them, and which cuts few fragments. By
 * sight walls a body is divided in sight_walls.c.
 *
 * A node's planes are counted once: a child whose fragments and creases are mostly the node's takes over its counts,
 * and changes them by what came and went. So O(n²) sides are asked in all where cuts take off little.
 */
#include "solid/pieces/decompose.h"

#include "solid/pieces/plane_sides.h"
#include "solid/pieces/sight_walls.h"
#include "solid/space/polygons.h"

struct node {
    uint32_t cell;
    uint32_t fragment, fragment_count; /* in `list` */
    uint32_t crease, crease_count;     /* in `creases` */
    uint32_t choice, choice_count;     /* in `choices`; none until they are needed */
    bool inside;                       /* when there are no fragments */
};

struct crease {
    uint32_t a, b;     /* points */
    uint32_t plane[2]; /* of its facets */
};

/* A plane to cut by: what that does to the node whose choice it is. */
struct choice {
    uint32_t half;
    int32_t side[2], cut; /* fragments with a part below the plane, above it, both */
    int64_t creases;      /* what those that it holds count and, against it, those that it cuts */
};

/* A fragment, or a crease of the list, that came or went. */
struct change {
    uint32_t fragment, crease; /* no crease where it is a fragment */
    int sign;
};

struct division {
    const pir_shell_body *body;
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
    struct choice *choices;
    uint32_t choice_count, choice_room;
    struct change *changes; /* scratch: between a node and a child */
    uint32_t change_count, change_room;
    uint32_t *seen, *place; /* per plane: the last look that came to it, and its place among choices then */
    uint32_t seen_room, place_room, look;
    pir_plane_sides sides;
};

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

static void push_change(struct division *d, struct change change) {
    if (pir_space_grow(d->space, (void **)&d->changes, &d->change_room, d->change_count, sizeof *d->changes))
        d->changes[d->change_count++] = change;
}

static uint32_t half_of(const struct division *d, uint32_t at) {
    return d->polygons.polygon[d->list[at]].half;
}

/* --- the choice of a plane --- */

/* Begins a look at each plane once. */
static void forget_planes(struct division *d) {
    const uint32_t before = d->seen_room, planes = d->space->plane_count;
    if (planes > before && (!pir_space_grow(d->space, (void **)&d->place, &d->place_room, planes, sizeof *d->place) ||
                            !pir_space_grow(d->space, (void **)&d->seen, &d->seen_room, planes, sizeof *d->seen)))
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

/* The weight of a crease for a plane that holds it, or against one that cuts it. */
static int worth_of(struct division *d, const struct crease *crease, uint32_t plane) {
    const unsigned seen = pir_plane_sides_of_points(&d->sides, plane, (const uint32_t[]){crease->a, crease->b}, 2);
    return seen == PIR_ON_PLANE ? 16 : seen == (PIR_ABOVE | PIR_BELOW) ? -8 : 0;
}

/* Counts a crease, or takes it back. */
static void count_crease(struct division *d, struct choice *choice, const struct crease *crease, int sign) {
    choice->creases += sign * worth_of(d, crease, choice->half >> 1);
}

/* Counts a fragment, or takes it back. */
static void count_fragment(struct division *d, struct choice *choice, uint32_t fragment, int sign) {
    const unsigned seen = pir_plane_sides_of_polygon(&d->sides, choice->half >> 1, fragment);
    choice->side[0] += seen & PIR_BELOW ? sign : 0;
    choice->side[1] += seen & PIR_ABOVE ? sign : 0;
    choice->cut += (seen & PIR_ABOVE) && (seen & PIR_BELOW) ? sign : 0;
}

static int64_t value_of(const struct choice *choice) {
    return choice->creases - choice->cut;
}

/* Lists the planes of a node, each once, as `from` has them, whose planes have been looked at; NULL: not counted. */
static void list_choices(struct division *d, struct node *node, const struct node *from) {
    node->choice = d->choice_count;
    for (uint32_t i = from ? from->choice : 0; from && i < from->choice + from->choice_count; i++)
        d->place[d->choices[i].half >> 1] = i;
    for (uint32_t i = node->fragment; i < node->fragment + node->fragment_count && d->space->status == PIR_OK; i++) {
        const uint32_t half = half_of(d, i);
        if (!is_new(d, half) ||
            !pir_space_grow(d->space, (void **)&d->choices, &d->choice_room, d->choice_count, sizeof *d->choices))
            continue;
        struct choice *choice = &d->choices[d->choice_count++];
        *choice = from ? d->choices[d->place[half >> 1]] : (struct choice){0};
        choice->half = half;
    }
    node->choice_count = d->choice_count - node->choice;
}

/* Counts the planes of a node. */
static void count_choices(struct division *d, struct node *node) {
    forget_planes(d);
    list_choices(d, node, NULL);
    for (uint32_t k = node->choice; k < node->choice + node->choice_count && d->space->status == PIR_OK; k++) {
        for (uint32_t i = node->crease; i < node->crease + node->crease_count; i++)
            count_crease(d, &d->choices[k], &d->creases[i], 1);
        for (uint32_t i = node->fragment; i < node->fragment + node->fragment_count; i++)
            count_fragment(d, &d->choices[k], d->list[i], 1);
    }
}

/* The half-space to cut by, or none when every fragment is on or below the plane of every other. Of planes with the
 * best value it is the first. */
static uint32_t choose_plane(struct division *d, struct node *node) {
    uint32_t best = PIR_SPACE_NONE;
    if (node->choice_count == 0)
        count_choices(d, node);
    for (uint32_t k = node->choice; k < node->choice + node->choice_count; k++) {
        const struct choice *choice = &d->choices[k];
        if (choice->side[choice->half & 1 ? 0 : 1] > 0 &&
            (best == PIR_SPACE_NONE || value_of(choice) > value_of(&d->choices[best])))
            best = k;
    }
    return best == PIR_SPACE_NONE || d->space->status != PIR_OK ? PIR_SPACE_NONE : d->choices[best].half;
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
        if (sides == 3) {
            pir_polygons_cut(&d->polygons, fragment, half, parts);
            pir_plane_sides_add(&d->sides, parts[0], fragment);
            pir_plane_sides_add(&d->sides, parts[1], fragment);
        }
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

/* The difference of a child and its node, both ways: in the order of the node's, parts that the cut
 * made stand for what they are parts of. Points and polygons from first[0] and first[1] on are such. */
static void list_changes(struct division *d, const struct node *node, const struct node *child,
                         const uint32_t first[2]) {
    d->change_count = 0;
    for (uint32_t i = 0, at = 0; i < node->fragment_count; i++) {
        const uint32_t own = d->list[node->fragment + i];
        const uint32_t next = at < child->fragment_count ? d->list[child->fragment + at] : PIR_SPACE_NONE;
        const bool made = next != PIR_SPACE_NONE && next >= first[1];
        at += next == own || made;
        if (next != own)
            push_change(d, (struct change){.fragment = own, .crease = PIR_SPACE_NONE, .sign = -1});
        if (made)
            push_change(d, (struct change){.fragment = next, .crease = PIR_SPACE_NONE, .sign = 1});
    }
    for (uint32_t i = 0, at = 0; i < node->crease_count; i++) {
        const struct crease *own = &d->creases[node->crease + i];
        const struct crease *next = at < child->crease_count ? &d->creases[child->crease + at] : NULL;
        const bool same = next && next->a == own->a && next->b == own->b;
        const bool made = next && (next->a >= first[0] || next->b >= first[0]) && !same;
        at += same || made;
        if (!same)
            push_change(d, (struct change){.crease = node->crease + i, .sign = -1});
        if (made)
            push_change(d, (struct change){.crease = child->crease + at - 1, .sign = 1});
    }
}

/* Counts a child's planes by what changes against the node's, where that is less than to count them anew. */
static void change_choices(struct division *d, const struct node *node, struct node *child, const uint32_t first[2]) {
    child->choice = d->choice_count;
    if (node->choice_count == 0 || d->space->status != PIR_OK)
        return;
    list_changes(d, node, child, first);
    if (d->change_count >= child->fragment_count + child->crease_count)
        return;
    forget_planes(d);
    list_choices(d, child, node);
    for (uint32_t k = child->choice; k < child->choice + child->choice_count && d->space->status == PIR_OK; k++)
        for (uint32_t i = 0; i < d->change_count; i++) {
            const struct change *change = &d->changes[i];
            if (change->crease == PIR_SPACE_NONE)
                count_fragment(d, &d->choices[k], change->fragment, change->sign);
            else
                count_crease(d, &d->choices[k], &d->creases[change->crease], change->sign);
        }
}

static void cut_node(struct division *d, const struct node *node, uint32_t half) {
    struct node child[2] = {{.inside = true}, {.inside = false}};
    const uint32_t first[2] = {d->space->point_count, d->polygons.count};
    uint32_t parts[2] = {0};
    pir_cells_cut(d->cells, node->cell, half, parts);
    cut_fragments(d, node, half, child);
    cut_creases(d, node, half, child);
    for (int above = 0; above < 2; above++) {
        child[above].cell = parts[above];
        change_choices(d, node, &child[above], first);
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
        struct node node = d->node[--d->node_count];
        d->space->stage.done++;
        // what was listed after this node's own is of nodes that are done
        d->list_count = node.fragment + node.fragment_count;
        d->crease_count = node.crease + node.crease_count;
        d->choice_count = node.choice + node.choice_count;
        const uint32_t half = node.fragment_count ? choose_plane(d, &node) : PIR_SPACE_NONE;
        if (half != PIR_SPACE_NONE)
            cut_node(d, &node, half);
        else if (node.fragment_count || node.inside)
            keep_piece(d, &node);
    }
}

/* --- the whole --- */

static void begin(struct division *d) {
    const pir_shell_body *body = d->body;
    struct node root = {.cell = pir_cells_add_box(d->cells)};
    for (uint32_t p = 0; p < body->part_count && d->space->status == PIR_OK; p++) {
        const uint32_t made = pir_polygons_add(
            &d->polygons, body->half[body->part_facet[p]], body->part_corner + body->part_start[p],
            body->part_direction + body->part_start[p], NULL, body->part_start[p + 1] - body->part_start[p]);
        pir_plane_sides_add(&d->sides, made, PIR_SPACE_NONE);
        push_fragment(d, made);
    }
    for (uint32_t e = 0; e < body->edge_count; e++) {
        const pir_shell_body_edge *edge = &body->edge[e];
        if (edge->bend == PIR_BEND_REFLEX)
            push_crease(d, (struct crease){edge->a, edge->b, {body->plane[edge->left], body->plane[edge->right]}});
    }
    root.fragment_count = d->list_count;
    root.crease_count = d->crease_count;
    push_node(d, root);
}

pir_status pir_decompose(const pir_shell_body *body, pir_decompose_method method, pir_cells *cells,
                         pir_piece_list *pieces) {
    pir_space *space = body->space;
    struct division d = {.body = body, .space = space, .cells = cells, .pieces = pieces};
    if (method == PIR_DECOMPOSE_WALLS) {
        pir_decompose_by_sight(body, cells, pieces);
        return space->status;
    }
    pir_polygons_init(&d.polygons, space);
    pir_plane_sides_init(&d.sides, body, &d.polygons);
    begin(&d);
    divide(&d);
    pir_space_shrink(space, d.node, d.node_room, sizeof *d.node);
    pir_space_shrink(space, d.list, d.list_room, sizeof *d.list);
    pir_space_shrink(space, d.above, d.above_room, sizeof *d.above);
    pir_space_shrink(space, d.creases, d.crease_room, sizeof *d.creases);
    pir_space_shrink(space, d.seen, d.seen_room, sizeof *d.seen);
    pir_space_shrink(space, d.place, d.place_room, sizeof *d.place);
    pir_space_shrink(space, d.choices, d.choice_room, sizeof *d.choices);
    pir_space_shrink(space, d.changes, d.change_room, sizeof *d.changes);
    pir_plane_sides_finish(&d.sides);
    pir_polygons_finish(&d.polygons);
    return space->status;
}
