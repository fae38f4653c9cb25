/* SPDX-License-Identifier: MIT */
/*
 * See convex.h. The planes of a sum have the normals of either operand's faces, and those at which an edge of one
 * crosses an edge of the other in the Gaussian map. Crossings at the end of an arc give the normal of a face, which is
 * there already.
 */
#include "solid/sum/convex.h"

#include "solid/space/exact.h"

/* --- operands --- */

/* The direction of a half-space's normal, made once. */
static uint32_t normal_of(pir_convexes *c, uint32_t half) {
    pir_space *space = c->space;
    const uint32_t before = c->normal_room;
    if (!pir_space_grow(space, (void **)&c->normal_of, &c->normal_room, half, sizeof *c->normal_of))
        return 0;
    for (uint32_t k = before; k < c->normal_room; k++)
        c->normal_of[k] = PIR_SPACE_NONE;
    if (c->normal_of[half] != PIR_SPACE_NONE)
        return c->normal_of[half];
    const uint32_t exact = pir_space_exact_plane(space, half >> 1);
    mpz_t *n = space->t + 8;
    for (uint32_t k = 0; k < 3 && space->status == PIR_OK; k++) {
        mpz_set(n[k], space->number[exact + k]);
        if (half & 1)
            mpz_neg(n[k], n[k]);
    }
    return c->normal_of[half] = pir_space_add_direction(space, n[0], n[1], n[2]);
}

static void add_vertex(pir_convexes *c, uint32_t point) {
    pir_convex *convex = &c->convex[c->count - 1];
    for (uint32_t k = convex->vertex; k < c->vertex_count; k++)
        if (c->vertex[k] == point)
            return;
    if (!pir_space_grow(c->space, (void **)&c->vertex, &c->vertex_room, c->vertex_count, sizeof *c->vertex))
        return;
    c->vertex[c->vertex_count++] = point;
    convex->vertex_count++;
    pir_space_box_add(&convex->box, &c->space->point[point]);
}

/* The edge from a to b with its two faces, seen from the one on its left. */
static void add_edge(pir_convexes *c, uint32_t a, uint32_t b, uint32_t left, uint32_t right) {
    pir_space *space = c->space;
    if (!pir_space_grow(space, (void **)&c->edge, &c->edge_room, c->edge_count, sizeof *c->edge))
        return;
    mpz_t *cross = space->t + 8;
    pir_numbers_cross(cross, space->number + space->direction[left].exact,
                      space->number + space->direction[right].exact);
    c->edge[c->edge_count++] =
        (pir_convex_edge){a, b, pir_space_add_direction(space, cross[0], cross[1], cross[2]), {left, right}, {0, 0}};
    c->convex[c->count - 1].edge_count++;
}

/* The half-space of the other face at the edge from a to b of a cell. */
static uint32_t half_beside(const pir_cells *cells, pir_cell cell, uint32_t a, uint32_t b) {
    for (uint32_t f = cell.first; f < cell.first + cell.count; f++) {
        const pir_face *face = &cells->face[f];
        for (uint32_t i = 0; i < face->count; i++)
            if (cells->corner[face->first + i] == b &&
                cells->corner[face->first + (i + 1 < face->count ? i + 1 : 0)] == a)
                return face->half;
    }
    pir_space_fault(cells->space);
    return cells->face[cell.first].half;
}

static void add_face(pir_convexes *c, const pir_cells *cells, pir_cell cell, const pir_face *face) {
    const uint32_t normal = normal_of(c, face->half);
    if (!pir_space_grow(c->space, (void **)&c->face, &c->face_room, c->face_count, sizeof *c->face))
        return;
    c->face[c->face_count++] = (pir_convex_face){cells->corner[face->first], normal};
    c->convex[c->count - 1].face_count++;
    for (uint32_t i = 0; i < face->count; i++) {
        const uint32_t a = cells->corner[face->first + i];
        const uint32_t b = cells->corner[face->first + (i + 1 < face->count ? i + 1 : 0)];
        add_vertex(c, a);
        if (a < b)
            add_edge(c, a, b, normal, normal_of(c, half_beside(cells, cell, a, b)));
    }
}

/* Names the faces of a piece beside its edges, once all are there. */
static void find_faces(pir_convexes *c, const pir_convex *convex) {
    for (uint32_t e = convex->edge; e < convex->edge + convex->edge_count; e++)
        for (int side = 0; side < 2; side++) {
            uint32_t f = 0;
            while (f < convex->face_count && c->face[convex->face + f].normal != c->edge[e].normal[side])
                f++;
            if (f == convex->face_count)
                pir_space_fault(c->space);
            c->edge[e].face[side] = f;
        }
}

void pir_convexes_make(pir_convexes *convexes, const pir_cells *cells, const pir_piece_list *pieces) {
    pir_convexes *c = convexes;
    *c = (pir_convexes){.space = cells->space};
    for (uint32_t i = 0; i < pieces->count; i++) {
        if (!pir_space_grow(c->space, (void **)&c->convex, &c->room, c->count, sizeof *c->convex))
            return;
        c->convex[c->count++] = (pir_convex){
            .vertex = c->vertex_count, .face = c->face_count, .edge = c->edge_count, .box = PIR_SPACE_BOX_EMPTY};
        const pir_cell cell = cells->cell[pieces->cell[i]];
        for (uint32_t f = cell.first; f < cell.first + cell.count && c->space->status == PIR_OK; f++)
            add_face(c, cells, cell, &cells->face[f]);
        const pir_convex *made = &c->convex[c->count - 1];
        if (c->space->status != PIR_OK)
            return;
        find_faces(c, made);
        if (made->face_count > 0 &&
            !pir_space_grow(c->space, (void **)&c->side, &c->side_room, made->face_count - 1, sizeof *c->side))
            return;
    }
}

void pir_convexes_set_boxes(pir_convexes *convexes) {
    for (uint32_t i = 0; i < convexes->count; i++) {
        pir_convex *convex = &convexes->convex[i];
        convex->box = PIR_SPACE_BOX_EMPTY;
        for (uint32_t k = convex->vertex; k < convex->vertex + convex->vertex_count; k++)
            pir_space_box_add(&convex->box, &convexes->space->point[convexes->vertex[k]]);
    }
}

void pir_convexes_finish(pir_convexes *convexes) {
    pir_convexes *c = convexes;
    if (!c->space)
        return;
    pir_space_shrink(c->space, c->convex, c->room, sizeof *c->convex);
    pir_space_shrink(c->space, c->vertex, c->vertex_room, sizeof *c->vertex);
    pir_space_shrink(c->space, c->face, c->face_room, sizeof *c->face);
    pir_space_shrink(c->space, c->edge, c->edge_room, sizeof *c->edge);
    pir_space_shrink(c->space, c->side, c->side_room, sizeof *c->side);
    pir_space_shrink(c->space, c->normal_of, c->normal_room, sizeof *c->normal_of);
    *c = (pir_convexes){0};
}

/* --- pair sums --- */

/* A vertex that is farthest in a direction. */
static uint32_t support(const pir_convexes *c, const pir_convex *convex, uint32_t direction) {
    uint32_t best = c->vertex[convex->vertex];
    for (uint32_t k = 1; k < convex->vertex_count; k++)
        if (pir_space_order(c->space, direction, best, c->vertex[convex->vertex + k]) > 0)
            best = c->vertex[convex->vertex + k];
    return best;
}

static void add_faces(const pir_convexes *c, const pir_convex *of, const pir_convexes *other, const pir_convex *with) {
    for (uint32_t f = of->face; f < of->face + of->face_count; f++) {
        const pir_convex_face face = c->face[f];
        pir_space_add_plane(c->space, (const uint32_t[]){face.normal, PIR_SPACE_NONE}, false,
                            (const uint32_t[]){face.point, support(other, with, face.normal)});
    }
}

/* Where the arc of an edge passes through the great circle of a direction: the sign of right · direction when it does
 * strictly, else 0. */
static int passes(pir_space *space, const pir_convex_edge *edge, uint32_t direction) {
    const int right = pir_space_dot(space, edge->normal[1], direction);
    return right != 0 && pir_space_dot(space, edge->normal[0], direction) == -right ? right : 0;
}

/* The sides of a great circle on which the normals of a piece's faces are, by face. */
static void list_sides(pir_convexes *c, const pir_convex *convex, uint32_t direction) {
    for (uint32_t f = 0; f < convex->face_count; f++)
        c->side[f] = (int8_t)pir_space_dot(c->space, c->face[convex->face + f].normal, direction);
}

/* Few arcs of b pass through the great circle of an edge. They are found first, by the sides of b's faces: each face is
 * asked once, whatever number of edges it has. */
static void add_crossings(const pir_convexes *p, const pir_convex *a, pir_convexes *q, const pir_convex *b) {
    pir_space *space = p->space;
    for (uint32_t i = a->edge; i < a->edge + a->edge_count; i++) {
        const pir_convex_edge *e = &p->edge[i];
        list_sides(q, b, e->direction);
        for (uint32_t j = b->edge; j < b->edge + b->edge_count; j++) {
            const pir_convex_edge *g = &q->edge[j];
            const int right = q->side[g->face[1]];
            // the two arcs meet in one point, not in opposite ones, when they pass opposite ways
            if (right == 0 || q->side[g->face[0]] != -right || passes(space, e, g->direction) != -right)
                continue;
            pir_space_add_plane(space, (const uint32_t[]){e->direction, g->direction}, right < 0,
                                (const uint32_t[]){e->point, g->point});
        }
    }
}

pir_pair_sum pir_pair_sum_make(const pir_convexes *p, uint32_t i, pir_convexes *q, uint32_t j) {
    const pir_convex *a = &p->convex[i], *b = &q->convex[j];
    pir_pair_sum sum = {.first = p->space->plane_count, .apart = p->space->plane_count};
    add_faces(p, a, q, b);
    add_faces(q, b, p, a);
    add_crossings(p, a, q, b);
    sum.count = p->space->plane_count - sum.first;
    for (int k = 0; k < 3; k++) {
        sum.box.low[k] = a->box.low[k] + b->box.low[k] - 0x1p-48;
        sum.box.high[k] = a->box.high[k] + b->box.high[k] + 0x1p-48;
    }
    return sum;
}
