/* SPDX-License-Identifier: MIT */
/*
 * Whether a point is within a closed mesh: a line from it along z of Q's frame leaves through an odd number of
 * triangles. Every edge is on an even number of triangles, so that number is as odd whichever way the line goes.
 * Where the line meets an edge, the point is moved by (ε, ε²) along x and y, symbolically; an edge's side is one
 * sign for all triangles that have it, so each is passed by as many as if the point were moved indeed.
 */
#include "mesh/pair/inside.h"

#include "mesh/pair/leaf_pair.h"

struct column {
    pir_mesh_frame *frame;
    int side;        /* whose vertex it is */
    uint32_t vertex; /* of that mesh */
    pir_vec3 point;  /* in Q's frame */
    bool odd;
};

/* --- signs --- */

static int sign_of(double x) {
    return (x > 0) - (x < 0);
}

/* The sign of (a − p) × (b − p) along z, by integers. 0 goes on to the symbolic motion of p. */
static int exact_turn(const struct column *c, uint32_t a, uint32_t b) {
    pir_limbs *limbs = &c->frame->limbs;
    uint32_t used = limbs->used;
    pir_int3 p = pir_mesh_frame_exact(c->frame, c->side, c->vertex);
    pir_int3 xa = pir_mesh_frame_exact(c->frame, 1 - c->side, a), xb = pir_mesh_frame_exact(c->frame, 1 - c->side, b);
    pir_int3 pa = pir_num3_sub(limbs, &xa, &p), pb = pir_num3_sub(limbs, &xb, &p);
    pir_int turn = pir_num_minor(limbs, &pa.c[0], &pb.c[1], &pa.c[1], &pb.c[0]);
    int sign = pir_int_sign(&turn);
    // the derivatives by x and y of p
    if (sign == 0)
        sign = pir_num_compare(limbs, &xa.c[1], &xb.c[1]);
    if (sign == 0)
        sign = pir_num_compare(limbs, &xb.c[0], &xa.c[0]);
    limbs->used = used;
    return sign;
}

/* The sign of (a − p) × (b − p) along z, p having moved; 0 only for an edge along z. */
static int turn_sign(const struct column *c, const pir_corners *tri, int i, int j) {
    double ax = tri->p[i].x - c->point.x, ay = tri->p[i].y - c->point.y;
    double bx = tri->p[j].x - c->point.x, by = tri->p[j].y - c->point.y;
    double turn = ax * by - ay * bx, m = fabs(ax) + fabs(ay) + fabs(bx) + fabs(by), error = c->frame->error;
    // differences are off by 2E and a rounding, products by 3E·m each
    if (fabs(turn) > 8 * error * m + 0x1p-900)
        return sign_of(turn);
    return exact_turn(c, tri->id[i], tri->id[j]);
}

/* The sign of ((b − a) × (c − a)) · (p − a). */
static int side_sign(const struct column *c, const pir_corners *tri) {
    pir_vec3 e = pir_vec_sub(tri->p[1], tri->p[0]), f = pir_vec_sub(tri->p[2], tri->p[0]);
    pir_vec3 to = pir_vec_sub(c->point, tri->p[0]);
    double side = pir_vec_dot(pir_vec_cross(e, f), to), error = c->frame->error;
    double m = fmax(pir_vec_dot(e, e), fmax(pir_vec_dot(f, f), pir_vec_dot(to, to)));
    if (fabs(side) > 64 * error * m + 0x1p-900)
        return sign_of(side);
    pir_limbs *limbs = &c->frame->limbs;
    uint32_t used = limbs->used;
    pir_int3 p = pir_mesh_frame_exact(c->frame, c->side, c->vertex), x[3];
    for (int k = 0; k < 3; k++)
        x[k] = pir_mesh_frame_exact(c->frame, 1 - c->side, tri->id[k]);
    pir_int3 xe = pir_num3_sub(limbs, &x[1], &x[0]), xf = pir_num3_sub(limbs, &x[2], &x[0]);
    pir_int3 xp = pir_num3_sub(limbs, &p, &x[0]), n = pir_num3_cross(limbs, &xe, &xf);
    pir_int exact = pir_num3_dot(limbs, &n, &xp);
    limbs->used = used;
    return pir_int_sign(&exact);
}

/* Whether the line from the point upwards goes through a triangle. */
static bool goes_through(const struct column *c, uint32_t triangle) {
    pir_corners tri = pir_frame_corners(c->frame, 1 - c->side, triangle);
    int first = turn_sign(c, &tri, 0, 1);
    if (first == 0 || turn_sign(c, &tri, 1, 2) != first || turn_sign(c, &tri, 2, 0) != first)
        return false;
    // the triangle faces up where it turns left: then the point is below if it is behind
    return side_sign(c, &tri) == -first;
}

/* --- the tree --- */

/* Whether the line may meet a child's box, as it stands in Q's frame. */
static bool may_meet(const struct column *c, const pir_mesh_boxes *boxes, int i) {
    const pir_mesh_frame *frame = c->frame;
    double half[3], slack = 0x1p-44 * frame->size;
    pir_vec3 middle;
    double m[3];
    for (int k = 0; k < 3; k++) {
        m[k] = 0.5 * ((double)boxes->low[k][i] + (double)boxes->high[k][i]);
        half[k] = 0.5 * ((double)boxes->high[k][i] - (double)boxes->low[k][i]);
    }
    middle = (pir_vec3){m[0], m[1], m[2]};
    if (c->side == 1) {
        double turned[3];
        for (int k = 0; k < 3; k++)
            turned[k] =
                fabs(frame->r.m[k][0]) * half[0] + fabs(frame->r.m[k][1]) * half[1] + fabs(frame->r.m[k][2]) * half[2];
        for (int k = 0; k < 3; k++)
            half[k] = turned[k];
        middle = pir_mesh_frame_apply(frame, middle);
    }
    return fabs(middle.x - c->point.x) <= half[0] + slack && fabs(middle.y - c->point.y) <= half[1] + slack &&
           middle.z + half[2] + slack >= c->point.z;
}

static void count_through(struct column *c) {
    const pir_mesh_tree *tree = &c->frame->mesh[1 - c->side]->tree;
    uint32_t stack[PIR_MESH_WIDTH * PIR_MESH_DEPTH], used = 0;
    stack[used++] = 0;
    while (used > 0) {
        uint32_t at = stack[--used];
        if (pir_mesh_is_leaf(at)) {
            for (uint32_t i = 0; i < pir_mesh_leaf_count(at); i++)
                c->odd ^= goes_through(c, tree->item[pir_mesh_leaf_start(at) + i]);
            continue;
        }
        const pir_mesh_node *node = &tree->node[at];
        pir_mesh_boxes boxes;
        pir_mesh_read_boxes(node, &boxes);
        for (int i = 0; i < node->count; i++)
            if (may_meet(c, &boxes, i))
                stack[used++] = node->child[i];
    }
}

/* Whether a point may be within the box around a mesh, in the frame of that mesh. */
static bool is_in_box(const pir_mesh_frame *frame, int side, pir_vec3 point) {
    const pir_mesh_tree *tree = &frame->mesh[1 - side]->tree;
    pir_vec3 x = side == 0 ? point : pir_mat_apply_transposed(&frame->r, pir_vec_sub(point, frame->t));
    double slack = 0x1p-44 * frame->size;
    const double c[3] = {x.x, x.y, x.z};
    for (int k = 0; k < 3; k++)
        if (c[k] < (double)tree->low[k] - slack || c[k] > (double)tree->high[k] + slack)
            return false;
    return true;
}

bool pir_is_inside(pir_mesh_frame *frame, int side) {
    const pir_trimesh *mesh = frame->mesh[side];
    if (!mesh->closed || !frame->mesh[1 - side]->closed)
        return false;
    for (uint32_t i = 0; i < mesh->part_listed; i++) {
        uint32_t v = mesh->part_vertex[i];
        pir_vec3 point = side == 0 ? pir_mesh_frame_apply(frame, mesh->vertex[v]) : mesh->vertex[v];
        struct column column = {.frame = frame, .side = side, .vertex = v, .point = point};
        if (!is_in_box(frame, side, point))
            continue;
        count_through(&column);
        if (column.odd)
            return true;
    }
    return false;
}
