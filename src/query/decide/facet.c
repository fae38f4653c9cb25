/* SPDX-License-Identifier: MIT */
/* True facets of D: see facet.h. */
#include "query/decide/facet.h"

#include "query/decide/placed.h"
#include "query/decide/short_numbers.h"

/* --- slopes and exposed faces --- */

pir_int3 pir_normal_integers(pir_exact *exact, const pir_normal *normal) {
    return normal->exact ? *normal->exact : pir_exact_normal(exact, normal->piece);
}

static int exact_slope(pir_exact *exact, const pir_normal *normal, uint32_t half, bool of_q) {
    uint32_t mark = exact->scratch.used;
    pir_rotation_make_exact(exact->rotation);
    pir_int3 n = pir_normal_integers(exact, normal);
    pir_int3 e = of_q ? pir_exact_half_q(exact, half) : pir_exact_half_p(exact, half);
    int sign = pir_exact_dot_sign(exact, &n, &e);
    exact->scratch.used = mark;
    return sign;
}

pir_view pir_view_of(const pir_frame *frame, const pir_normal *normal, bool of_q) {
    if (of_q)
        return (pir_view){frame->q.polytope, true, normal->unit};
    return (pir_view){frame->p.polytope, false, pir_mat_apply_transposed(&frame->r, normal->unit)};
}

/* The components that are not zero: bit k for component k. */
static uint32_t occupied(const pir_int3 *v) {
    return (uint32_t)(v->c[0].size != 0) | (uint32_t)(v->c[1].size != 0) << 1 | (uint32_t)(v->c[2].size != 0) << 2;
}

/* The entries of row i of M(q) that may not be zero. Off the diagonal they are 2 (q_i q_j ∓ w q_k). */
static uint32_t occupied_row(const pir_rotation *rotation, uint32_t i) {
    const double q[3] = {rotation->given.x, rotation->given.y, rotation->given.z}, w = rotation->given.w;
    uint32_t row = 1u << i;
    for (uint32_t step = 1; step < 3; step++) {
        uint32_t j = (i + step) % 3, k = (i + 3 - step) % 3;
        row |= (uint32_t)((q[i] != 0 && q[j] != 0) || (w != 0 && q[k] != 0)) << j;
    }
    return row;
}

/*
 * Whether every product in the slope has a factor that is zero: so it is for boxes that stand on one another
 * however they are turned about the vertical. Only for a normal of one body and an edge of the other.
 */
static bool is_zero_by_terms(const pir_exact *exact, const pir_normal *normal, uint32_t half, bool of_q) {
    bool crosses = of_q ? normal->piece.kind == PIR_FACET_FV : normal->piece.kind == PIR_FACET_VF;
    if (normal->exact || !crosses || exact->rotation->relative)
        return false;
    const pir_polytope *p = exact->frame->p.polytope, *q = exact->frame->q.polytope;
    pir_int3 of_p_body = of_q ? pir_normal_exact(p, normal->piece.first) : pir_half_exact(p, half);
    pir_int3 of_q_body = of_q ? pir_half_exact(q, half) : pir_normal_exact(q, normal->piece.second);
    uint32_t columns = occupied(&of_p_body), rows = occupied(&of_q_body);
    for (uint32_t i = 0; i < 3; i++)
        if ((rows >> i & 1) && (occupied_row(exact->rotation, i) & columns))
            return false;
    return true;
}

static int slope_in_doubt(pir_exact *exact, const pir_normal *normal, uint32_t half, bool of_q) {
    return is_zero_by_terms(exact, normal, half, of_q) ? 0 : exact_slope(exact, normal, half, of_q);
}

/* As pir_slope. In the searches of this file the part in doubles is inline. */
static inline int slope_of(pir_exact *exact, const pir_normal *normal, const pir_view *view, uint32_t half) {
    double slope = pir_vec_dot(view->unit, view->body->direction[half]);
    if (fabs(slope) > PIR_SLOPE_BOUND * normal->err)
        return (slope > 0) - (slope < 0);
    return slope_in_doubt(exact, normal, half, view->of_q);
}

int pir_slope(pir_exact *exact, const pir_normal *normal, const pir_view *view, uint32_t half) {
    return slope_of(exact, normal, view, half);
}

/*
 * The facet that two edges of a vertex share. A polygon has two; then it is the one whose normal is along `unit`, a
 * direction in the body's frame.
 */
static uint32_t shared_facet(const pir_polytope *p, uint32_t half, uint32_t other, pir_vec3 unit) {
    uint32_t left = p->left[half], right = pir_right(p, half);
    bool has_left = left == p->left[other] || left == pir_right(p, other);
    bool has_right = right == p->left[other] || right == pir_right(p, other);
    if (has_left && has_right)
        return pir_vec_dot(p->normal[left], unit) > 0 ? left : right;
    return has_left ? left : right;
}

/*
 * Where a search for an exposed face starts: an exposed vertex, and a halfedge from it that is known to be across the
 * normal, or NO_HALF.
 */
struct from {
    uint32_t vertex, across;
};

#define NO_HALF UINT32_MAX

/* The face of a vertex that is exposed, `count` of its edges, two at most, being across the normal. */
static pir_feature face_across(const pir_view *view, uint32_t vertex, const uint32_t across[2], uint32_t count) {
    const pir_polytope *p = view->body;
    if (count == 0)
        return (pir_feature){PIR_FEATURE_VERTEX, vertex};
    if (p->artificial)
        return (pir_feature){PIR_FEATURE_EDGE, 0};
    if (count == 1)
        return (pir_feature){PIR_FEATURE_EDGE, p->edge[across[0]]};
    return (pir_feature){PIR_FEATURE_FACET, shared_facet(p, across[0], across[1], view->unit)};
}

/* The exposed face that holds the vertex of `from`. */
static pir_feature exposed(pir_exact *exact, const pir_normal *normal, const pir_view *view, struct from from) {
    const pir_polytope *p = view->body;
    uint32_t across[2] = {0, 0}, count = 0, vertex = from.vertex;
    for (uint32_t h = p->ring_start[vertex]; h < p->ring_start[vertex + 1] && count < 2; h++)
        if (h == from.across || slope_of(exact, normal, view, h) == 0)
            across[count++] = h;
    return face_across(view, vertex, across, count);
}

/* The exposed face, given a vertex that may not be exposed; false then. */
static bool prove_exposed(pir_exact *exact, const pir_normal *normal, const pir_view *view, struct from from,
                          pir_feature *ret_face) {
    const pir_polytope *p = view->body;
    uint32_t across[2] = {0, 0}, count = 0, vertex = from.vertex;
    for (uint32_t h = p->ring_start[vertex]; h < p->ring_start[vertex + 1]; h++) {
        int slope = h == from.across ? 0 : slope_of(exact, normal, view, h);
        if (slope > 0)
            return false;
        if (slope == 0 && count < 2)
            across[count++] = h;
    }
    *ret_face = face_across(view, vertex, across, count);
    return true;
}

pir_feature pir_exposed(pir_exact *exact, const pir_normal *normal, const pir_view *view, uint32_t vertex) {
    return exposed(exact, normal, view, (struct from){vertex, NO_HALF});
}

uint32_t pir_face_lowest(const pir_polytope *p, pir_feature face) {
    if (face.kind == PIR_FEATURE_VERTEX)
        return face.index;
    // edge_half leaves the lower vertex
    if (face.kind == PIR_FEATURE_EDGE)
        return p->origin[p->edge_half[face.index]];
    uint32_t lowest = UINT32_MAX;
    for (uint32_t i = p->loop_start[face.index]; i < p->loop_start[face.index + 1]; i++)
        lowest = p->origin[p->loop[i]] < lowest ? p->origin[p->loop[i]] : lowest;
    return lowest;
}

/* --- planes --- */

/* Of two edges, the halfedge of Q's for which d × e is along the normal. False where they are parallel. */
static bool orient_edges(pir_exact *exact, const pir_normal *normal, uint32_t e, uint32_t d, uint32_t *ret_half) {
    const pir_frame *frame = exact->frame;
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    uint32_t half = q->edge_half[d];
    pir_vec3 n = pir_vec_cross(q->direction[half], pir_mat_apply(&frame->r, p->direction[p->edge_half[e]]));
    double along = pir_vec_dot(n, normal->unit);
    // d is off by 6u, e by 47u, their product rounds by 4u, the normal is off by 64u·err, the dot product by 4u:
    // below 125u·err, and 256u·err is more than enough
    if (fabs(along) <= 2 * PIR_SLOPE_BOUND * normal->err) {
        uint32_t mark = exact->scratch.used;
        pir_rotation_make_exact(exact->rotation);
        pir_int3 across = pir_exact_normal(exact, (pir_piece){PIR_FACET_EE, e, half});
        pir_int3 to = pir_normal_integers(exact, normal);
        along = pir_exact_dot_sign(exact, &across, &to);
        exact->scratch.used = mark;
    }
    *ret_half = along > 0 ? half : q->twin[half];
    return along != 0;
}

/* As pir_facet_of_faces; `known` is a plane that is refined. */
static bool facet_of_faces(pir_exact *exact, const pir_normal *normal, pir_witness faces, const pir_plane *known,
                           pir_facet *ret_facet) {
    const pir_frame *frame = exact->frame;
    pir_feature p = faces.p, q = faces.q;
    uint32_t half = 0, a = pir_face_lowest(frame->p.polytope, p), b = pir_face_lowest(frame->q.polytope, q);
    if (p.kind == PIR_FEATURE_FACET)
        ret_facet->piece = (pir_piece){PIR_FACET_FV, p.index, b};
    else if (q.kind == PIR_FEATURE_FACET)
        ret_facet->piece = (pir_piece){PIR_FACET_VF, a, q.index};
    else if (p.kind == PIR_FEATURE_EDGE && q.kind == PIR_FEATURE_EDGE &&
             orient_edges(exact, normal, p.index, q.index, &half))
        ret_facet->piece = (pir_piece){PIR_FACET_EE, p.index, half};
    else
        return false;
    pir_plane plane;
    const bool is_known = known && pir_piece_same(known->piece, ret_facet->piece);
    const bool has_plane =
        is_known || (pir_plane_of(exact, ret_facet->piece, &plane) && pir_plane_refine(exact, &plane));
    if (is_known)
        plane = *known;
    PIR_ASSERT(has_plane);
    ret_facet->faces = faces;
    ret_facet->a = a;
    ret_facet->b = b;
    ret_facet->n = plane.n;
    ret_facet->h = plane.h;
    ret_facet->err = plane.err;
    return has_plane;
}

bool pir_facet_of_faces(pir_exact *exact, const pir_normal *normal, pir_witness faces, pir_facet *ret_facet) {
    return facet_of_faces(exact, normal, faces, NULL, ret_facet);
}

/* The beginning of both ways to a piece's true facet: its plane, and the vertices that the search starts from. */
struct search_start {
    pir_plane plane;
    pir_normal normal;
    struct from a, b;
    pir_view of_p, of_q;
    bool by_p, by_q; /* a facet of P, or of Q, whose own normal it is: that exposes it */
};

static inline bool start_search(pir_exact *exact, pir_piece piece, struct search_start *ret_start) {
    const pir_frame *frame = exact->frame;
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    pir_plane *plane = &ret_start->plane;
    if (!pir_plane_of(exact, piece, plane) || !pir_plane_refine(exact, plane))
        return false;
    ret_start->normal = (pir_normal){.unit = plane->n, .err = plane->err, .piece = piece};
    ret_start->a.across = piece.kind == PIR_FACET_EE ? p->edge_half[piece.first] : NO_HALF;
    ret_start->b.across = piece.kind == PIR_FACET_EE ? piece.second : NO_HALF;
    pir_piece_corner(frame, piece, &ret_start->a.vertex, &ret_start->b.vertex);
    ret_start->of_p = pir_view_of(frame, &ret_start->normal, false);
    ret_start->of_q = pir_view_of(frame, &ret_start->normal, true);
    ret_start->by_p = piece.kind == PIR_FACET_FV && !p->artificial;
    ret_start->by_q = piece.kind == PIR_FACET_VF && !q->artificial;
    return true;
}

bool pir_facet_of(pir_exact *exact, pir_piece piece, pir_facet *ret_facet) {
    struct search_start s;
    if (!start_search(exact, piece, &s))
        return false;
    pir_witness faces;
    faces.p = s.by_p ? (pir_feature){PIR_FEATURE_FACET, piece.first} : exposed(exact, &s.normal, &s.of_p, s.a);
    faces.q = s.by_q ? (pir_feature){PIR_FEATURE_FACET, piece.second} : exposed(exact, &s.normal, &s.of_q, s.b);
    return facet_of_faces(exact, &s.normal, faces, &s.plane, ret_facet);
}

bool pir_facet_prove(pir_exact *exact, pir_piece piece, pir_facet *ret_facet) {
    struct search_start s;
    if (!start_search(exact, piece, &s))
        return false;
    pir_witness faces = {{PIR_FEATURE_FACET, piece.first}, {PIR_FEATURE_FACET, piece.second}};
    return (s.by_p || prove_exposed(exact, &s.normal, &s.of_p, s.a, &faces.p)) &&
           (s.by_q || prove_exposed(exact, &s.normal, &s.of_q, s.b, &faces.q)) &&
           facet_of_faces(exact, &s.normal, faces, &s.plane, ret_facet);
}

/* --- order --- */

bool pir_facet_before(const pir_facet *a, const pir_facet *b) {
    if (a->piece.kind != b->piece.kind)
        return a->piece.kind < b->piece.kind;
    // compare the features of the facets, not of the pieces that stand for them: an edge's number, not its halfedge's
    if (a->piece.kind != PIR_FACET_VF && a->faces.p.index != b->faces.p.index)
        return a->faces.p.index < b->faces.p.index;
    return a->piece.kind != PIR_FACET_FV && a->faces.q.index < b->faces.q.index;
}

/* --- slacks --- */

/* The slack and its sign from integers. */
static int exact_slack(pir_exact *exact, const pir_placement *placement, const pir_facet *facet, double *ret_slack) {
    int side;
    if (pir_short_slack(exact, placement->translation, facet, &side, ret_slack))
        return side;
    pir_exact_begin(exact, placement->translation);
    uint32_t mark = exact->scratch.used;
    pir_int3 normal = pir_exact_normal(exact, facet->piece), corner = pir_exact_corner(exact, facet->a, facet->b);
    pir_int dot = pir_exact_dot(exact, &normal, &corner);
    pir_real length = pir_exact_length(exact, &normal);
    exact->scratch.used = mark;
    *ret_slack = pir_real_double(pir_real_times(pir_real_over(pir_real_of(&dot), length), pir_exact_unit(exact)));
    return pir_int_sign(&dot);
}

/* By doubles. */
static double near_slack(const pir_placement *placement, const pir_facet *facet) {
    return facet->h - pir_vec_dot(facet->n, placement->x);
}

static int sign_of(double x) {
    return (x > 0) - (x < 0);
}

double pir_facet_slack(pir_exact *exact, const pir_placement *placement, const pir_facet *facet) {
    double slack = near_slack(placement, facet);
    if (!(fabs(slack) > PIR_NEXT_TO_NOTHING * placement->reach))
        exact_slack(exact, placement, facet, &slack);
    return slack;
}

/* --- planes across an axis --- */

/* Component k of a vertex, where it is a double exactly. */
static bool exact_component(const pir_polytope *p, uint32_t vertex, int k, double *ret_c) {
    const pir_vec3 d = p->vertex[vertex];
    *ret_c = k == 0 ? d.x : k == 1 ? d.y : d.z;
    return pir_vertex_is_double(p, vertex, k);
}

/* The axis that a facet's normal is along, where the rotation turns about it or half round across it. */
static bool axis_of(const pir_exact *exact, const pir_facet *facet, int *ret_k, int *ret_turned) {
    const pir_frame *frame = exact->frame;
    bool by_p = facet->piece.kind == PIR_FACET_FV;
    if (exact->world || exact->rotation->relative || facet->piece.kind == PIR_FACET_EE)
        return false;
    pir_int3 n = by_p ? pir_normal_exact(frame->p.polytope, facet->piece.first)
                      : pir_normal_exact(frame->q.polytope, facet->piece.second);
    uint32_t along = occupied(&n);
    int k = along == 1 ? 0 : along == 2 ? 1 : along == 4 ? 2 : -1;
    if (k < 0 || occupied_row(exact->rotation, k) != along)
        return false;
    const pir_quat q = exact->rotation->given;
    const double c[3] = {q.x, q.y, q.z};
    // row k of M is zero but for its diagonal entry, which is |q|² or −|q|²
    *ret_k = k;
    *ret_turned = c[k] == 0 && q.w == 0 ? -1 : 1;
    return true;
}

/*
 * The exact sign of the slack from one coordinate: that of bodies which stand on one another. The slack is then
 * ±(±p + q − t), three doubles. False where that is not so, or rounding leaves it open.
 */
static bool side_along_axis(const pir_exact *exact, const pir_placement *placement, const pir_facet *facet,
                            int *ret_sign) {
    int k, turned;
    double p, q;
    if (!axis_of(exact, facet, &k, &turned) || !exact_component(exact->frame->p.polytope, facet->a, k, &p) ||
        !exact_component(exact->frame->q.polytope, facet->b, k, &q))
        return false;
    const double t[3] = {placement->translation.x, placement->translation.y, placement->translation.z};
    const double n[3] = {facet->n.x, facet->n.y, facet->n.z};
    pir_dd first = pir_dd_two_sum(turned * p, q), second = pir_dd_two_sum(first.hi, -t[k]);
    pir_dd rest = pir_dd_two_sum(first.lo, second.lo), whole = pir_dd_two_sum(second.hi, rest.hi);
    if (!(fabs(whole.hi) < 0x1p1000) || (whole.hi != 0 && fabs(whole.hi) <= 4 * (fabs(whole.lo) + fabs(rest.lo))) ||
        (whole.hi == 0 && rest.lo != 0))
        return false;
    *ret_sign = ((whole.hi > 0) - (whole.hi < 0)) * (n[k] > 0 ? 1 : -1);
    return true;
}

int pir_facet_side(pir_exact *exact, const pir_placement *placement, const pir_facet *facet) {
    double slack = near_slack(placement, facet);
    if (fabs(slack) > placement->error * facet->err)
        return sign_of(slack);
    int along;
    if (side_along_axis(exact, placement, facet, &along))
        return along;
    int side;
    if (pir_short_slack(exact, placement->translation, facet, &side, &slack))
        return side;
    pir_exact_begin(exact, placement->translation);
    uint32_t mark = exact->scratch.used;
    pir_int3 n = pir_exact_normal(exact, facet->piece), corner = pir_exact_corner(exact, facet->a, facet->b);
    int sign = pir_exact_dot_sign(exact, &n, &corner);
    exact->scratch.used = mark;
    return sign;
}

int pir_facet_measure(pir_exact *exact, const pir_placement *placement, const pir_facet *facet, double *ret_slack) {
    double slack = near_slack(placement, facet);
    *ret_slack = slack;
    if (fabs(slack) > PIR_NEXT_TO_NOTHING * placement->reach)
        return fabs(slack) > placement->error * facet->err ? sign_of(slack) : pir_facet_side(exact, placement, facet);
    int along;
    if (side_along_axis(exact, placement, facet, &along) && along == 0) {
        *ret_slack = 0;
        return 0;
    }
    return exact_slack(exact, placement, facet, ret_slack);
}

int pir_facet_compare(pir_exact *exact, const pir_placement *placement, const pir_facet *a, const pir_facet *b) {
    pir_vec3 x = placement->x;
    double difference = (a->h - pir_vec_dot(a->n, x)) - (b->h - pir_vec_dot(b->n, x));
    if (fabs(difference) > placement->error * (a->err + b->err))
        return (difference > 0) - (difference < 0);
    // compare s²·|m|² with r²·|n|², with the signs of s and r
    pir_exact_begin(exact, placement->translation);
    uint32_t mark = exact->scratch.used;
    const pir_facet *facet[2] = {a, b};
    pir_int dot[2], square[2];
    for (int k = 0; k < 2; k++) {
        pir_int3 normal = pir_exact_normal(exact, facet[k]->piece);
        pir_int3 corner = pir_exact_corner(exact, facet[k]->a, facet[k]->b);
        dot[k] = pir_exact_dot(exact, &normal, &corner);
        square[k] = pir_exact_square(exact, &normal);
    }
    int sign = pir_int_sign(&dot[0]), other = pir_int_sign(&dot[1]);
    pir_int of_a = pir_exact_product(exact, &dot[0], &dot[0]), of_b = pir_exact_product(exact, &dot[1], &dot[1]);
    pir_int left = pir_exact_product(exact, &of_a, &square[1]), right = pir_exact_product(exact, &of_b, &square[0]);
    int order = sign != other ? (sign > other) - (sign < other) : sign * pir_exact_compare(exact, &left, &right);
    exact->scratch.used = mark;
    return order;
}

void pir_least_offer_facet(pir_exact *exact, const pir_placement *placement, pir_least *least, const pir_facet *facet) {
    int order = -1;
    if (least->found) {
        if (pir_facet_same(facet, &least->facet))
            return;
        order = pir_facet_compare(exact, placement, facet, &least->facet);
        if (order == 0)
            order = pir_facet_before(facet, &least->facet) ? -1 : 1;
    }
    if (order < 0)
        least->facet = *facet;
    least->found = true;
}

void pir_least_offer(pir_exact *exact, const pir_placement *placement, pir_least *least, pir_piece piece) {
    pir_facet facet;
    if (pir_facet_of(exact, piece, &facet))
        pir_least_offer_facet(exact, placement, least, &facet);
}
