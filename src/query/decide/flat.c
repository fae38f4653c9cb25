/* SPDX-License-Identifier: MIT */
/*
 * Differences without an inside: those of two flat bodies in one plane or on one line.
 *
 * The planes of their pieces do not bound D sideways. Support planes in more directions do: where D lies in a plane,
 * along its normal and along the normals of D's sides within it; where D lies on a line, along it and across it;
 * where D is a point, along the axes. With their opposites they bound D exactly. Everything is computed in integers,
 * because such pairs are rare and small.
 */
#include "query/decide/flat.h"

static pir_int3 axis_of(pir_exact *exact, uint32_t k) {
    pir_int3 axis = pir_int3_take(&exact->scratch, 1);
    axis.c[k].limb[0] = 1;
    axis.c[k].size = 1;
    return axis;
}

/* The vector of edge `index`, in the scratch. P's edges come first, rotated, then Q's. */
static pir_int3 edge_vector(pir_exact *exact, uint32_t index) {
    const pir_frame *frame = exact->frame;
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    return index < p->edge_count ? pir_exact_half_p(exact, p->edge_half[index])
                                 : pir_exact_half_q(exact, q->edge_half[index - p->edge_count]);
}

/* A normal of the plane of the first edge and one that is not parallel to it. False where all edges are parallel. */
static bool plane_of(pir_exact *exact, uint32_t edges, pir_int3 *ret_normal) {
    pir_int3 first = edge_vector(exact, 0);
    uint32_t mark = exact->scratch.used;
    for (uint32_t i = 1; i < edges; i++, exact->scratch.used = mark) {
        pir_int3 e = edge_vector(exact, i), n = pir_exact_cross(exact, &first, &e);
        if (!pir_int3_is_zero(&n)) {
            *ret_normal = n;
            return true;
        }
    }
    return false;
}

static uint32_t normal_count(const pir_frame *frame) {
    uint32_t edges = frame->p.polytope->edge_count + frame->q.polytope->edge_count;
    return edges > 3 ? edges + 1 : 4;
}

/*
 * Direction `index` below normal_count, exact, of any length, in the scratch. False where there is no such direction.
 */
static bool flat_normal(pir_exact *exact, uint32_t index, pir_int3 *ret_normal) {
    const pir_frame *frame = exact->frame;
    uint32_t edges = frame->p.polytope->edge_count + frame->q.polytope->edge_count;
    pir_int3 n;
    if (edges == 0) {
        if (index < 3)
            *ret_normal = axis_of(exact, index);
        return index < 3;
    }
    if (plane_of(exact, edges, &n)) {
        if (index < edges) {
            pir_int3 e = edge_vector(exact, index);
            n = pir_exact_cross(exact, &n, &e);
        }
        *ret_normal = n;
        return index <= edges;
    }
    // D is on a line: along it and across it
    pir_int3 e = edge_vector(exact, 0);
    *ret_normal = e;
    if (index < 3) {
        pir_int3 axis = axis_of(exact, index);
        *ret_normal = pir_exact_cross(exact, &e, &axis);
    }
    return index <= 3 && !pir_int3_is_zero(ret_normal);
}

/* The corner of D of vertex `v` of one operand and the first vertex of the other. */
static pir_int3 corner_of(pir_exact *exact, uint32_t v, bool of_q) {
    return of_q ? pir_exact_corner(exact, 0, v) : pir_exact_corner(exact, v, 0);
}

/* The vertex of P, rotated, or of Q that is farthest along n; the first of several. */
static uint32_t farthest(pir_exact *exact, const pir_int3 *n, bool of_q) {
    const pir_frame *frame = exact->frame;
    uint32_t best = 0, mark = exact->scratch.used,
             count = of_q ? frame->q.polytope->vertex_count : frame->p.polytope->vertex_count;
    for (uint32_t v = 1; v < count; v++, exact->scratch.used = mark) {
        pir_int3 most = corner_of(exact, best, of_q), w = corner_of(exact, v, of_q);
        pir_int3 e = pir_exact_difference(exact, &w, &most);
        best = pir_exact_dot_sign(exact, n, &e) > 0 ? v : best;
    }
    return best;
}

/* A vertex of each operand that n exposes. */
static void flat_support(pir_exact *exact, const pir_int3 *n, uint32_t *ret_a, uint32_t *ret_b) {
    *ret_a = farthest(exact, n, false);
    *ret_b = farthest(exact, n, true);
}

/* Whether t lies beyond the support plane of n. */
static bool is_beyond(pir_exact *exact, const pir_int3 *n) {
    uint32_t a, b, mark = exact->scratch.used;
    flat_support(exact, n, &a, &b);
    pir_int3 corner = pir_exact_corner(exact, a, b);
    bool beyond = pir_exact_dot_sign(exact, n, &corner) < 0;
    exact->scratch.used = mark;
    return beyond;
}

bool pir_flat_holds(pir_exact *exact, pir_vec3 translation) {
    const pir_frame *frame = exact->frame;
    pir_exact_begin(exact, translation);
    uint32_t mark = exact->scratch.used, count = normal_count(frame);
    bool beyond = false;
    for (uint32_t i = 0; i < count && !beyond; i++) {
        pir_int3 n;
        if (flat_normal(exact, i, &n)) {
            beyond = is_beyond(exact, &n);
            for (int k = 0; k < 3; k++)
                pir_int_negate(&n.c[k]);
            beyond |= is_beyond(exact, &n);
        }
        exact->scratch.used = mark;
    }
    return !beyond;
}

bool pir_flat_is(pir_exact *exact) {
    const pir_frame *frame = exact->frame;
    uint32_t edges = frame->p.polytope->edge_count + frame->q.polytope->edge_count, mark = exact->scratch.used;
    if (frame->p.polytope->dimension == 3 || frame->q.polytope->dimension == 3)
        return false;
    pir_rotation_make_exact(exact->rotation);
    pir_int3 n;
    bool flat = true;
    if (edges > 0 && plane_of(exact, edges, &n)) {
        uint32_t inner = exact->scratch.used;
        for (uint32_t i = 0; i < edges && flat; i++, exact->scratch.used = inner) {
            pir_int3 e = edge_vector(exact, i);
            flat = pir_exact_dot_sign(exact, &n, &e) == 0;
        }
    }
    exact->scratch.used = mark;
    return flat;
}

pir_vec3 pir_flat_across(const pir_frame *frame) {
    pir_vec3 e;
    if (frame->q.polytope->edge_count > 0)
        e = frame->q.polytope->direction[0];
    else if (frame->p.polytope->edge_count > 0)
        e = pir_mat_apply(&frame->r, frame->p.polytope->direction[0]);
    else
        return (pir_vec3){1, 0, 0};
    double x = fabs(e.x), y = fabs(e.y), z = fabs(e.z);
    pir_vec3 n = pir_vec_cross(e, (pir_vec3){x <= y && x <= z, !(x <= y && x <= z) && y <= z, z < x && z < y});
    return pir_vec_scale(n, 1 / sqrt(pir_vec_dot(n, n)));
}

/* --- a line into it --- */

/*
 * A support plane that a line crosses: the number of its direction, whether its opposite is meant, and the corner of
 * D that it passes through.
 */
struct bound {
    bool found, opposite;
    uint32_t index, a, b;
};

/*
 * The normal of a support plane, and its slack S and rate along the line, in the scratch. False where there is no
 * such direction.
 */
static bool make_bound(pir_exact *exact, const pir_int3 *direction, struct bound *bound, pir_int3 *ret_n,
                       pir_int *ret_s, pir_int *ret_d) {
    if (!flat_normal(exact, bound->index, ret_n))
        return false;
    for (int k = 0; k < 3 && bound->opposite; k++)
        pir_int_negate(&ret_n->c[k]);
    flat_support(exact, ret_n, &bound->a, &bound->b);
    pir_int3 corner = pir_exact_corner(exact, bound->a, bound->b);
    *ret_s = pir_exact_dot(exact, ret_n, &corner);
    *ret_d = pir_exact_dot(exact, ret_n, direction);
    return true;
}

/* The sign of λ at the crossing of `a` minus λ at the crossing of `b`. */
static int compare(pir_exact *exact, const pir_int3 *direction, struct bound a, struct bound b) {
    uint32_t mark = exact->scratch.used;
    pir_int3 n;
    pir_int s[2], d[2];
    make_bound(exact, direction, &a, &n, &s[0], &d[0]);
    make_bound(exact, direction, &b, &n, &s[1], &d[1]);
    pir_int left = pir_exact_product(exact, &s[0], &d[1]), right = pir_exact_product(exact, &s[1], &d[0]);
    int order = pir_exact_compare(exact, &left, &right) * pir_int_sign(&d[0]) * pir_int_sign(&d[1]);
    exact->scratch.used = mark;
    return order;
}

/* The last support plane that the line enters by. False where the line misses D, or meets it only before x. */
static bool find_entry(pir_exact *exact, const pir_int3 *direction, struct bound *ret_enter) {
    const pir_frame *frame = exact->frame;
    struct bound enter = {.found = false}, leave = {.found = false};
    uint32_t mark = exact->scratch.used, count = normal_count(frame);
    int enter_side = 0;
    for (uint32_t i = 0; i < 2 * count; i++) {
        struct bound bound = {true, i % 2 != 0, i / 2, 0, 0};
        pir_int3 n;
        pir_int s, d;
        bool is_bound = make_bound(exact, direction, &bound, &n, &s, &d);
        int rate = is_bound ? pir_int_sign(&d) : 0, side = is_bound ? pir_int_sign(&s) : 0;
        exact->scratch.used = mark;
        if (is_bound && rate == 0 && side < 0)
            return false;
        if (rate > 0 && (!leave.found || compare(exact, direction, bound, leave) < 0))
            leave = bound;
        if (rate < 0 && (!enter.found || compare(exact, direction, bound, enter) > 0)) {
            enter = bound;
            enter_side = side;
        }
    }
    *ret_enter = enter;
    return enter.found && enter_side < 0 && (!leave.found || compare(exact, direction, enter, leave) <= 0);
}

bool pir_flat_enter(pir_exact *exact, const pir_line *line, pir_arrival *ret_arrival) {
    const pir_frame *frame = exact->frame;
    int exponent;
    pir_exact_begin(exact, line->placement->translation);
    uint32_t mark = exact->scratch.used;
    pir_int3 direction = pir_exact_direction_by_q(exact, line->direction, &exponent), n;
    struct bound enter;
    bool hit = find_entry(exact, &direction, &enter);
    if (hit) {
        pir_int s, d;
        make_bound(exact, &direction, &enter, &n, &s, &d);
        pir_normal normal = {.unit = pir_int3_unit(&n), .err = 1, .exact = &n};
        pir_way way = {.u = line->u, .direction = line->direction, .normal = &normal, .a = enter.a, .b = enter.b};
        way.at = pir_line_length(exact, &direction, &s, &d);
        way.error = 0x1p-48 * fabs(way.at);
        ret_arrival->at = way.at;
        ret_arrival->within = pir_line_past_end(exact, &s, &d, exponent) <= 0;
        ret_arrival->normal = normal.unit;
        pir_facet facet;
        pir_meeting meeting = {.normal = &normal, .way = &way};
        pir_view of_p = pir_view_of(frame, &normal, false), of_q = pir_view_of(frame, &normal, true);
        meeting.faces.p = pir_exposed(exact, &normal, &of_p, enter.a);
        meeting.faces.q = pir_exposed(exact, &normal, &of_q, enter.b);
        meeting.flat = pir_facet_of_faces(exact, &normal, meeting.faces, &facet);
        hit = pir_touch_find(exact, line->placement, &meeting, &ret_arrival->touch);
    }
    exact->scratch.used = mark;
    return hit;
}
