/* SPDX-License-Identifier: MIT */
/* Where faces of P and Q meet: see touch.h. */
#include "query/decide/touch.h"

#include "query/decide/short_numbers.h"

struct touch {
    pir_exact *exact;
    const pir_placement *placement;
    const pir_normal *normal;
    const pir_way *way;
    pir_vec3 x; /* y, apart from its distance along the normal */
    double error;
    bool flat; /* the sum of the faces has an area, so that its sides are across the normal */
};

/* --- signs --- */

/* A halfedge of P or Q. */
struct touch_side {
    bool of_q;
    uint32_t half;
};

static pir_vec3 direction_of(const pir_frame *frame, struct touch_side side) {
    return side.of_q ? frame->q.polytope->direction[side.half]
                     : pir_mat_apply(&frame->r, frame->p.polytope->direction[side.half]);
}

/*
 * Corner (a, b) of D minus y, times a positive number, in the scratch. At the end of a way, t has moved by (S/D)·d,
 * with d the direction, D = n·d, and S = n·W for the plane's own corner. Everything is multiplied by |D|.
 */
static pir_int3 exact_corner(const struct touch *touch, uint32_t a, uint32_t b) {
    pir_exact *exact = touch->exact;
    pir_int3 corner = pir_exact_corner(exact, a, b);
    const pir_way *way = touch->way;
    if (!way)
        return corner;
    int exponent;
    pir_int3 n = pir_normal_integers(exact, way->normal), plane = pir_exact_corner(exact, way->a, way->b);
    pir_int3 d = pir_exact_direction_by_q(exact, way->direction, &exponent);
    pir_int rate = pir_exact_dot(exact, &n, &d), slack = pir_exact_dot(exact, &n, &plane);
    if (pir_int_sign(&rate) < 0) {
        pir_int_negate(&rate);
        pir_int_negate(&slack);
    }
    pir_int3 moved = pir_exact_scaled(exact, &corner, &rate), by = pir_exact_scaled(exact, &d, &slack);
    return pir_exact_difference(exact, &moved, &by);
}

/* The exact sign of m·(y − corner (a, b)), m = n × e or, `along`, e. */
static int exact_position(const struct touch *touch, struct touch_side side, bool along, uint32_t a, uint32_t b) {
    pir_exact *exact = touch->exact;
    pir_exact_begin(exact, touch->placement->translation);
    uint32_t mark = exact->scratch.used;
    pir_int3 m = side.of_q ? pir_exact_half_q(exact, side.half) : pir_exact_half_p(exact, side.half);
    if (!along) {
        pir_int3 n = pir_normal_integers(exact, touch->normal);
        m = pir_exact_cross(exact, &n, &m);
    }
    pir_int3 corner = exact_corner(touch, a, b);
    int sign = -pir_exact_dot_sign(exact, &m, &corner);
    exact->scratch.used = mark;
    return sign;
}

/* The sign of m·(y − corner (a, b)), m = n × e. */
static inline int position(const struct touch *touch, struct touch_side side, pir_vec3 m, uint32_t a, uint32_t b) {
    double s = pir_vec_dot(m, pir_vec_sub(touch->x, pir_frame_vertex(touch->exact->frame, a, b)));
    if (fabs(s) > touch->error)
        return (s > 0) - (s < 0);
    return exact_position(touch, side, false, a, b);
}

/* --- whether a point is on a face --- */

/* y minus a vertex of the other body, in the frame of the face's body. */
struct point {
    const struct touch *touch;
    pir_view view;
    const pir_vec3 *vertex; /* of the face's body */
    pir_vec3 at;
    uint32_t fixed; /* the vertex of the other body */
};

static inline struct point point_less(const struct touch *touch, const pir_view *view, uint32_t fixed) {
    const pir_frame *frame = touch->exact->frame;
    struct point point = {.touch = touch, .view = *view, .fixed = fixed};
    if (view->of_q) {
        point.vertex = frame->q.vertex;
        point.at = pir_vec_sub(touch->x, pir_mat_apply(&frame->r, frame->p.vertex[fixed]));
    } else {
        point.vertex = frame->p.vertex;
        point.at = pir_mat_apply_transposed(&frame->r, pir_vec_sub(touch->x, frame->q.vertex[fixed]));
    }
    return point;
}

/* The sign of m·(y − corner), m = n × e or, `along`, e, for a halfedge and the body's own vertex at the corner. */
static int position_of(const struct point *point, uint32_t half, bool along, uint32_t own) {
    bool of_q = point->view.of_q;
    pir_vec3 e = point->view.body->direction[half], m = along ? e : pir_vec_cross(point->view.unit, e);
    double s = pir_vec_dot(m, pir_vec_sub(point->at, point->vertex[own]));
    if (fabs(s) > point->touch->error)
        return (s > 0) - (s < 0);
    return exact_position(point->touch, (struct touch_side){of_q, half}, along, of_q ? point->fixed : own,
                          of_q ? own : point->fixed);
}

static bool on_edge(const struct point *point, uint32_t edge, pir_feature *ret_least) {
    const pir_polytope *p = point->view.body;
    uint32_t half = p->edge_half[edge], from = p->origin[half], to = p->target[half];
    if (point->touch->flat && position_of(point, half, false, from) != 0)
        return false;
    int after = position_of(point, half, true, from), before = position_of(point, half, true, to);
    if (after < 0 || before > 0)
        return false;
    *ret_least = after == 0    ? (pir_feature){PIR_FEATURE_VERTEX, from}
                 : before == 0 ? (pir_feature){PIR_FEATURE_VERTEX, to}
                               : (pir_feature){PIR_FEATURE_EDGE, edge};
    return true;
}

static bool on_facet(const struct point *point, uint32_t facet, pir_feature *ret_least) {
    const pir_polytope *p = point->view.body;
    uint32_t start = p->loop_start[facet], end = p->loop_start[facet + 1], zeros = 0, on[2] = {0, 0};
    for (uint32_t i = start; i < end; i++) {
        int sign = position_of(point, p->loop[i], false, p->origin[p->loop[i]]);
        if (sign < 0)
            return false;
        if (sign == 0 && zeros < 2)
            on[zeros++] = i;
    }
    if (zeros == 0)
        *ret_least = (pir_feature){PIR_FEATURE_FACET, facet};
    else if (zeros == 1)
        *ret_least = (pir_feature){PIR_FEATURE_EDGE, p->edge[p->loop[on[0]]]};
    else // the corner between the two sides: the end of the first, unless they are the last and the first
        *ret_least = (pir_feature){PIR_FEATURE_VERTEX,
                                   on[1] == on[0] + 1 ? p->target[p->loop[on[0]]] : p->origin[p->loop[on[0]]]};
    return true;
}

/* Whether y minus the other body's vertex `fixed` lies on the face, and the least face that holds it. */
static bool on_face(const struct touch *touch, const pir_view *view, pir_feature face, uint32_t fixed,
                    pir_feature *ret_least) {
    *ret_least = face;
    if (face.kind == PIR_FEATURE_VERTEX)
        return true;
    struct point point = point_less(touch, view, fixed);
    return face.kind == PIR_FEATURE_FACET ? on_facet(&point, face.index, ret_least)
                                          : on_edge(&point, face.index, ret_least);
}

/* --- the parts of a face in order --- */

/*
 * The vertex of a face with the next number after `last`, or UINT32_MAX where there is none. UINT32_MAX for `last`
 * gives the first.
 */
static uint32_t next_vertex(const pir_polytope *p, pir_feature face, uint32_t last) {
    uint32_t next = UINT32_MAX, after = last + 1;
    if (face.kind == PIR_FEATURE_VERTEX)
        return face.index >= after ? face.index : next;
    if (face.kind == PIR_FEATURE_EDGE) {
        uint32_t h = p->edge_half[face.index], low = p->origin[h], high = p->target[h];
        return low >= after ? low : high >= after ? high : next;
    }
    for (uint32_t i = p->loop_start[face.index]; i < p->loop_start[face.index + 1]; i++) {
        uint32_t v = p->origin[p->loop[i]];
        next = v >= after && v < next ? v : next;
    }
    return next;
}

/* The edge of a face with the next number after `last`, as above. */
static uint32_t next_edge(const pir_polytope *p, pir_feature face, uint32_t last) {
    uint32_t next = UINT32_MAX, after = last + 1;
    if (face.kind == PIR_FEATURE_EDGE)
        return face.index >= after ? face.index : next;
    for (uint32_t i = p->loop_start[face.index]; i < p->loop_start[face.index + 1]; i++) {
        uint32_t e = p->edge[p->loop[i]];
        next = e >= after && e < next ? e : next;
    }
    return next;
}

/* --- edges that cross --- */

/* The sign of n·(d × e), for the directions d and e of two halfedges. */
static int turn_of(const struct touch *touch, uint32_t half_p, uint32_t half_q, pir_vec3 e, pir_vec3 d) {
    pir_exact *exact = touch->exact;
    double s = pir_vec_dot(touch->normal->unit, pir_vec_cross(d, e));
    if (fabs(s) > 2 * PIR_SLACK_BOUND * touch->normal->err)
        return (s > 0) - (s < 0);
    uint32_t mark = exact->scratch.used;
    pir_rotation_make_exact(exact->rotation);
    pir_int3 n = pir_normal_integers(exact, touch->normal), a = pir_exact_half_q(exact, half_q),
             b = pir_exact_half_p(exact, half_p), c = pir_exact_cross(exact, &a, &b);
    int sign = pir_exact_dot_sign(exact, &n, &c);
    exact->scratch.used = mark;
    return sign;
}

/* Whether y is the foot of x on the plane of two edges. */
static bool is_foot_between(const struct touch *touch, uint32_t edge_p, uint32_t edge_q) {
    const pir_normal *normal = touch->normal;
    return !touch->way && !normal->exact && normal->piece.kind == PIR_FACET_EE && normal->piece.first == edge_p &&
           touch->exact->frame->q.polytope->edge[normal->piece.second] == edge_q;
}

/* The fraction of the edge of Q at which y lies, from integers, correct to a few ulps. */
static double exact_part(const struct touch *touch, uint32_t half_p, uint32_t half_q) {
    pir_exact *exact = touch->exact;
    const pir_frame *frame = exact->frame;
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    double brief;
    if (is_foot_between(touch, p->edge[half_p], q->edge[half_q]) &&
        pir_short_part(exact, touch->placement->translation, half_p, half_q, &brief))
        return brief;
    pir_exact_begin(exact, touch->placement->translation);
    uint32_t mark = exact->scratch.used;
    pir_int3 n = pir_normal_integers(exact, touch->normal), e = pir_exact_half_p(exact, half_p),
             m = pir_exact_cross(exact, &n, &e);
    pir_int at[2];
    for (int k = 0; k < 2; k++) {
        pir_int3 corner = exact_corner(touch, p->origin[half_p], k == 0 ? q->origin[half_q] : q->target[half_q]);
        at[k] = pir_exact_dot(exact, &m, &corner);
    }
    pir_int whole = pir_limbs_take(
        &exact->scratch,
        (pir_int_length(&at[0]) > pir_int_length(&at[1]) ? pir_int_length(&at[0]) : pir_int_length(&at[1])) + 1);
    pir_int_sub(&whole, &at[0], &at[1]);
    pir_real part = pir_real_over(pir_real_of(&at[0]), pir_real_of(&whole));
    exact->scratch.used = mark;
    return pir_real_double(part);
}

/* The point of Q's edge where the edges cross. */
static pir_vec3 crossing_point(const struct touch *touch, uint32_t half_p, uint32_t half_q, pir_vec3 y) {
    const pir_frame *frame = touch->exact->frame;
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    pir_vec3 from = frame->q.vertex[q->origin[half_q]], d = pir_vec_sub(frame->q.vertex[q->target[half_q]], from);
    pir_vec3 across = pir_vec_cross(pir_mat_apply(&frame->r, p->direction[half_p]), touch->normal->unit);
    pir_vec3 turn = pir_vec_cross(q->direction[half_q], pir_mat_apply(&frame->r, p->direction[half_p]));
    double part;
    if (pir_vec_dot(turn, turn) < PIR_SIN_REFINED * PIR_SIN_REFINED)
        part = exact_part(touch, half_p, half_q);
    else
        part = pir_touch_part(pir_vec_sub(y, pir_frame_vertex(frame, p->origin[half_p], q->origin[half_q])), d, across);
    return pir_touch_along(from, d, part);
}

/* Whether the edges cross at y, and the least faces that hold it. */
static bool edges_cross(const struct touch *touch, uint32_t e, uint32_t d, pir_witness *ret_witness) {
    const pir_polytope *p = touch->exact->frame->p.polytope, *q = touch->exact->frame->q.polytope;
    struct touch_side of_p = {false, p->edge_half[e]}, of_q = {true, q->edge_half[d]};
    pir_vec3 along_p = direction_of(touch->exact->frame, of_p), along_q = direction_of(touch->exact->frame, of_q);
    int turn = turn_of(touch, of_p.half, of_q.half, along_p, along_q);
    if (turn == 0)
        return false;
    pir_vec3 n = touch->normal->unit, across_p = pir_vec_cross(n, along_p), across_q = pir_vec_cross(n, along_q);
    uint32_t a[2] = {p->origin[of_p.half], p->target[of_p.half]}, b[2] = {q->origin[of_q.half], q->target[of_q.half]};
    int after_a = turn * position(touch, of_q, across_q, a[0], b[0]);
    if (after_a < 0)
        return false;
    int before_a = turn * position(touch, of_q, across_q, a[1], b[0]);
    if (before_a > 0)
        return false;
    int after_b = -turn * position(touch, of_p, across_p, a[0], b[0]);
    int before_b = -turn * position(touch, of_p, across_p, a[0], b[1]);
    if (after_b < 0 || before_b > 0)
        return false;
    ret_witness->p = after_a == 0    ? (pir_feature){PIR_FEATURE_VERTEX, a[0]}
                     : before_a == 0 ? (pir_feature){PIR_FEATURE_VERTEX, a[1]}
                                     : (pir_feature){PIR_FEATURE_EDGE, e};
    ret_witness->q = after_b == 0    ? (pir_feature){PIR_FEATURE_VERTEX, b[0]}
                     : before_b == 0 ? (pir_feature){PIR_FEATURE_VERTEX, b[1]}
                                     : (pir_feature){PIR_FEATURE_EDGE, d};
    return true;
}

/* --- the search --- */

static bool find_witness(const struct touch *touch, pir_witness faces, pir_witness *ret_witness) {
    const pir_polytope *p = touch->exact->frame->p.polytope, *q = touch->exact->frame->q.polytope;
    bool two_edges = faces.p.kind == PIR_FEATURE_EDGE && faces.q.kind == PIR_FEATURE_EDGE;
    // edges that are not parallel meet in one point
    if (two_edges && touch->flat)
        return edges_cross(touch, faces.p.index, faces.q.index, ret_witness);
    const pir_view of_p = pir_view_of(touch->exact->frame, touch->normal, false);
    if (faces.p.kind != PIR_FEATURE_VERTEX || faces.q.kind == PIR_FEATURE_VERTEX)
        for (uint32_t b = next_vertex(q, faces.q, UINT32_MAX); b != UINT32_MAX; b = next_vertex(q, faces.q, b))
            if (on_face(touch, &of_p, faces.p, b, &ret_witness->p)) {
                ret_witness->q = (pir_feature){PIR_FEATURE_VERTEX, b};
                return true;
            }
    const pir_view of_q = pir_view_of(touch->exact->frame, touch->normal, true);
    if (faces.q.kind != PIR_FEATURE_VERTEX)
        for (uint32_t a = next_vertex(p, faces.p, UINT32_MAX); a != UINT32_MAX; a = next_vertex(p, faces.p, a))
            if (on_face(touch, &of_q, faces.q, a, &ret_witness->q)) {
                ret_witness->p = (pir_feature){PIR_FEATURE_VERTEX, a};
                return true;
            }
    if (faces.p.kind == PIR_FEATURE_VERTEX || faces.q.kind == PIR_FEATURE_VERTEX)
        return false;
    for (uint32_t e = next_edge(p, faces.p, UINT32_MAX); e != UINT32_MAX; e = next_edge(p, faces.p, e))
        for (uint32_t d = next_edge(q, faces.q, UINT32_MAX); d != UINT32_MAX; d = next_edge(q, faces.q, d))
            if (edges_cross(touch, e, d, ret_witness))
                return true;
    return false;
}

static struct touch touch_at(pir_exact *exact, const pir_placement *placement, const pir_meeting *meeting) {
    const pir_normal *normal = meeting->normal;
    const pir_way *way = meeting->way;
    struct touch touch = {.exact = exact,
                          .placement = placement,
                          .normal = normal,
                          .way = way,
                          .x = placement->x,
                          .error = PIR_SIDE_ERRORS * placement->error * normal->err,
                          .flat = meeting->flat};
    if (way) {
        touch.x = pir_vec_add(placement->x, pir_vec_scale(way->u, way->at));
        touch.error += PIR_SIDE_ERRORS * (way->error + PIR_SLACK_BOUND * way->at * normal->err);
    }
    return touch;
}

/* The point of Q of a witness that is a corner. */
static pir_vec3 point_of(const struct touch *touch, const pir_meeting *meeting, pir_witness witness) {
    const pir_frame *frame = touch->exact->frame;
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    pir_vec3 y =
        meeting->way ? touch->x : pir_vec_add(touch->placement->x, pir_vec_scale(touch->normal->unit, meeting->slack));
    if (witness.q.kind == PIR_FEATURE_VERTEX)
        return frame->q.vertex[witness.q.index];
    if (witness.p.kind == PIR_FEATURE_VERTEX)
        return pir_vec_sub(y, pir_mat_apply(&frame->r, frame->p.vertex[witness.p.index]));
    return crossing_point(touch, p->edge_half[witness.p.index], q->edge_half[witness.q.index], y);
}

bool pir_touch_find(pir_exact *exact, const pir_placement *placement, const pir_meeting *meeting,
                    pir_touch *ret_touch) {
    const struct touch touch = touch_at(exact, placement, meeting);
    if (!find_witness(&touch, meeting->faces, &ret_touch->witness))
        return false;
    ret_touch->point_q = point_of(&touch, meeting, ret_touch->witness);
    return true;
}

/* --- all corners --- */

static void give_corner(const struct touch *touch, const pir_meeting *meeting, pir_witness witness,
                        const pir_touch_visitor *visitor) {
    const pir_touch corner = {witness, point_of(touch, meeting, witness)};
    visitor->visit(visitor->context, &corner);
}

/* The vertices of a face of Q that lie on P's face, or, of P, on Q's face but not at a vertex where `only_inner`. */
static void give_vertices(const struct touch *touch, const pir_meeting *meeting, bool of_q, bool only_inner,
                          const pir_touch_visitor *visitor) {
    const pir_frame *frame = touch->exact->frame;
    const pir_polytope *body = of_q ? frame->q.polytope : frame->p.polytope;
    const pir_feature from = of_q ? meeting->faces.q : meeting->faces.p;
    const pir_feature on = of_q ? meeting->faces.p : meeting->faces.q;
    const pir_view view = pir_view_of(frame, touch->normal, !of_q);
    for (uint32_t v = next_vertex(body, from, UINT32_MAX); v != UINT32_MAX; v = next_vertex(body, from, v)) {
        const pir_feature vertex = {PIR_FEATURE_VERTEX, v};
        pir_feature least;
        if (!on_face(touch, &view, on, v, &least) || (only_inner && least.kind == PIR_FEATURE_VERTEX))
            continue;
        give_corner(touch, meeting, of_q ? (pir_witness){least, vertex} : (pir_witness){vertex, least}, visitor);
    }
}

/* Where the edges of two faces cross, none at an end unless each face is an edge. */
static void give_crossings(const struct touch *touch, const pir_meeting *meeting, const pir_touch_visitor *visitor) {
    const pir_frame *frame = touch->exact->frame;
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    const pir_feature fp = meeting->faces.p, fq = meeting->faces.q;
    const bool are_edges = fp.kind == PIR_FEATURE_EDGE && fq.kind == PIR_FEATURE_EDGE;
    pir_witness witness;
    for (uint32_t e = next_edge(p, fp, UINT32_MAX); e != UINT32_MAX; e = next_edge(p, fp, e))
        for (uint32_t d = next_edge(q, fq, UINT32_MAX); d != UINT32_MAX; d = next_edge(q, fq, d))
            if (edges_cross(touch, e, d, &witness) &&
                (are_edges || (witness.p.kind == PIR_FEATURE_EDGE && witness.q.kind == PIR_FEATURE_EDGE)))
                give_corner(touch, meeting, witness, visitor);
}

void pir_touch_each(pir_exact *exact, const pir_placement *placement, const pir_meeting *meeting,
                    const pir_touch_visitor *visitor) {
    const struct touch touch = touch_at(exact, placement, meeting);
    const pir_feature p = meeting->faces.p, q = meeting->faces.q;
    const bool of_vertex_p = p.kind == PIR_FEATURE_VERTEX, of_vertex_q = q.kind == PIR_FEATURE_VERTEX;
    const bool are_edges = p.kind == PIR_FEATURE_EDGE && q.kind == PIR_FEATURE_EDGE;
    if (!(are_edges && meeting->flat)) {
        const bool by_q = !of_vertex_p || of_vertex_q;
        if (by_q)
            give_vertices(&touch, meeting, true, false, visitor);
        if (!of_vertex_q)
            give_vertices(&touch, meeting, false, by_q, visitor);
    }
    // without an area the edges are parallel
    if (meeting->flat && !of_vertex_p && !of_vertex_q)
        give_crossings(&touch, meeting, visitor);
}

bool pir_touch_facet(pir_exact *exact, const pir_placement *placement, const pir_facet *facet, double slack,
                     const pir_way *way, pir_touch *ret_touch) {
    pir_normal normal = pir_facet_normal(facet);
    pir_meeting meeting = {&normal, facet->faces, true, slack, way};
    return pir_touch_find(exact, placement, &meeting, ret_touch);
}
