/* SPDX-License-Identifier: MIT */
/*
 * The point of D nearest to x, by descent from vertex to vertex (Gilbert, Johnson and Keerthi, 1988). Supports come
 * from hill climbing.
 *
 * All points here are relative to x. A step takes the point v nearest to 0 of the hull of at most three vertices of
 * D, then the vertex w of D farthest along −v. |v| is an upper bound on the distance, w·v/|v| a lower bound. The
 * descent ends when the bounds meet, or when a step brings v no nearer; then v is as near as doubles can tell.
 *
 * Near D doubles lose the direction of v, for |v| is known to an ulp of the bodies' size only. nearest/nearest.c
 * decides there.
 */
#include "query/nearest/nearest_vertex.h"

/* --- the nearest point of a simplex to the origin --- */

/* Up to three of the points, the weights with which they give the nearest point v, and |v|². */
struct nearest {
    uint32_t count, index[3];
    double weight[3];
    pir_vec3 v;
    double square;
    bool encloses; /* four points have the origin within, as rounding tells */
};

static void take_point(const pir_vec3 *w, uint32_t a, struct nearest *best) {
    double square = pir_vec_dot(w[a], w[a]);
    if (square < best->square)
        *best = (struct nearest){1, {a, 0, 0}, {1, 0, 0}, w[a], square, false};
}

/* The inside of the segment a–b. Its ends are tried as points. */
static void take_segment(const pir_vec3 *w, uint32_t a, uint32_t b, struct nearest *best) {
    pir_vec3 e = pir_vec_sub(w[b], w[a]);
    double along = -pir_vec_dot(w[a], e), whole = pir_vec_dot(e, e);
    if (!(along > 0 && along < whole))
        return;
    double t = along / whole;
    // measured from the nearer end, which rounds less
    pir_vec3 v = t <= 0.5 ? pir_vec_add(w[a], pir_vec_scale(e, t)) : pir_vec_sub(w[b], pir_vec_scale(e, 1 - t));
    double square = pir_vec_dot(v, v);
    if (square < best->square)
        *best = (struct nearest){2, {a, b, 0}, {1 - t, t, 0}, v, square, false};
}

/*
 * The foot of the origin on the plane through three points. n is across the plane, |n|² = whole. The foot is inside
 * their triangle, with weights in proportion to `share`.
 */
static inline void take_inside(const pir_vec3 *w, const uint32_t index[3], const double share[3], pir_vec3 n,
                               double whole, struct nearest *best) {
    // the shortest corner gives the plane's distance with the smallest error
    pir_vec3 a = w[index[0]], b = w[index[1]], c = w[index[2]];
    double qa = pir_vec_dot(a, a), qb = pir_vec_dot(b, b), qc = pir_vec_dot(c, c);
    pir_vec3 corner = qa <= qb && qa <= qc ? a : qb <= qc ? b : c;
    pir_vec3 v = pir_vec_scale(n, pir_vec_dot(n, corner) / whole);
    double square = pir_vec_dot(v, v), by = 1 / (share[0] + share[1] + share[2]);
    if (square < best->square * (1 + 0x1p-20))
        *best = (struct nearest){
            3, {index[0], index[1], index[2]}, {share[0] * by, share[1] * by, share[2] * by}, v, square, false};
}

/*
 * The inside of the triangle. Its sides are tried as segments. Where the foot is inside, the triangle is nearer than
 * its sides, but rounding may hide that where the triangle is nearly flat towards x. So the triangle wins within
 * 2^-20, or the descent would stop at a side.
 */
static void take_triangle(const pir_vec3 *w, uint32_t a, uint32_t b, uint32_t c, struct nearest *best) {
    pir_vec3 n = pir_vec_cross(pir_vec_sub(w[b], w[a]), pir_vec_sub(w[c], w[a]));
    double whole = pir_vec_dot(n, n);
    double wa = pir_vec_dot(n, pir_vec_cross(w[b], w[c])), wb = pir_vec_dot(n, pir_vec_cross(w[c], w[a]));
    double wc = pir_vec_dot(n, pir_vec_cross(w[a], w[b]));
    if (wa > 0 && wb > 0 && wc > 0 && whole > 0)
        take_inside(w, (const uint32_t[3]){a, b, c}, (const double[3]){wa, wb, wc}, n, whole, best);
}

/*
 * The nearest point of the hull of `count` ≤ 4 points, the last of them new. It is tried on every face that can hold
 * it.
 */
static void find_nearest(const pir_vec3 *w, uint32_t count, struct nearest *best) {
    best->square = HUGE_VAL;
    uint32_t last = count - 1;
    for (uint32_t i = 0; i < count; i++)
        take_point(w, i, best);
    for (uint32_t i = 0; i < last; i++)
        take_segment(w, i, last, best);
    if (count >= 3) {
        take_segment(w, 0, 1, best);
        take_triangle(w, 0, 1, last, best);
    }
    if (count == 4) {
        take_segment(w, 0, 2, best);
        take_segment(w, 1, 2, best);
        take_triangle(w, 0, 2, last, best);
        take_triangle(w, 1, 2, last, best);
    }
}

/* --- the same for points in general position, at a third of the work --- */

/* The nearest point of the closed segment a–b, a < b, where it is nearer than `best`. */
static void reach_segment(const pir_vec3 *w, uint32_t a, uint32_t b, struct nearest *best) {
    pir_vec3 e = pir_vec_sub(w[b], w[a]);
    double along = -pir_vec_dot(w[a], e), whole = pir_vec_dot(e, e);
    if (along <= 0)
        take_point(w, a, best);
    else if (along >= whole)
        take_point(w, b, best);
    else
        take_segment(w, a, b, best);
}

/*
 * The nearest point of the closed triangle a, b, c, a < b < c. A foot beyond one side only is nearest to that side,
 * because the way from it to any other point of the triangle passes through that side. A foot beyond two sides is
 * nearest to one of them. False where the triangle has no plane.
 */
static bool reach_triangle(const pir_vec3 *w, uint32_t a, uint32_t b, uint32_t c, struct nearest *best) {
    pir_vec3 n = pir_vec_cross(pir_vec_sub(w[b], w[a]), pir_vec_sub(w[c], w[a]));
    double whole = pir_vec_dot(n, n);
    double wa = pir_vec_dot(n, pir_vec_cross(w[b], w[c])), wb = pir_vec_dot(n, pir_vec_cross(w[c], w[a]));
    double wc = pir_vec_dot(n, pir_vec_cross(w[a], w[b]));
    if (whole == 0)
        return false;
    if (wa > 0 && wb > 0 && wc > 0) {
        take_inside(w, (const uint32_t[3]){a, b, c}, (const double[3]){wa, wb, wc}, n, whole, best);
        return true;
    }
    if (wa <= 0)
        reach_segment(w, b, c, best);
    if (wb <= 0)
        reach_segment(w, a, c, best);
    if (wc <= 0)
        reach_segment(w, a, b, best);
    return true;
}

/*
 * The nearest point of a tetrahedron, on the faces at the last point that the origin sees. It sees a face where its
 * weight of the opposite corner is negative. The weights are these determinants over their sum. False where it sees
 * no face.
 */
static bool reach_tetrahedron(const pir_vec3 *w, struct nearest *best) {
    pir_vec3 c0 = pir_vec_cross(w[3], w[0]), c1 = pir_vec_cross(w[3], w[1]), c2 = pir_vec_cross(w[3], w[2]);
    double d0 = -pir_vec_dot(w[2], c1), d1 = -pir_vec_dot(w[0], c2), d2 = -pir_vec_dot(w[1], c0);
    double d3 = pir_vec_dot(w[0], pir_vec_cross(w[1], w[2])), whole = d3 + d0 + d1 + d2;
    bool sees = false;
    best->encloses = d0 * whole > 0 && d1 * whole > 0 && d2 * whole > 0 && d3 * whole > 0;
    if (d2 * whole < 0)
        sees = reach_triangle(w, 0, 1, 3, best);
    if (d1 * whole < 0)
        sees |= reach_triangle(w, 0, 2, 3, best);
    if (d0 * whole < 0)
        sees |= reach_triangle(w, 1, 2, 3, best);
    return sees;
}

/* As find_nearest. False where the points are not in general position. */
static bool reach_nearest(const pir_vec3 *w, uint32_t count, struct nearest *best) {
    best->square = HUGE_VAL;
    best->encloses = false;
    if (count == 4)
        return reach_tetrahedron(w, best);
    if (count == 3)
        return reach_triangle(w, 0, 1, 2, best);
    if (count == 2)
        reach_segment(w, 0, 1, best);
    else
        take_point(w, 0, best);
    return true;
}

/*
 * Reduces the simplex to the face that holds the nearest point. Indices rise, so nothing is overwritten before it is
 * read.
 */
static void keep_nearest(pir_simplex *simplex, pir_vec3 *w, const struct nearest *best) {
    simplex->count = best->count;
    for (uint32_t i = 0; i < best->count; i++) {
        uint32_t from = best->index[i];
        simplex->a[i] = simplex->a[from];
        simplex->b[i] = simplex->b[from];
        simplex->weight[i] = best->weight[i];
        w[i] = w[from];
    }
}

/*
 * Whether the point that the weights give is within `length`. It is a point of D whatever the weights are. So this
 * proves an upper bound even where a triangle is so narrow that its normal is rounding alone.
 */
static bool held_within(const pir_simplex *simplex, const pir_vec3 *w, double length) {
    pir_vec3 v = pir_vec_scale(w[0], simplex->weight[0]);
    for (uint32_t i = 1; i < simplex->count; i++)
        v = pir_vec_add(v, pir_vec_scale(w[i], simplex->weight[i]));
    return length >= 0 && pir_vec_dot(v, v) <= length * length;
}

/* The index of vertex (a, b) of D in the simplex, or the simplex's count where it is not there. */
static inline uint32_t place_of(const pir_simplex *simplex, uint32_t a, uint32_t b) {
    uint32_t i = 0;
    while (i < simplex->count && (simplex->a[i] != a || simplex->b[i] != b))
        i++;
    return i;
}

/* The one of two vertices that is farther along n. */
static uint32_t farther(const pir_vec3 *vertices, pir_vec3 n, uint32_t a, uint32_t b) {
    return pir_vec_dot(n, vertices[b]) > pir_vec_dot(n, vertices[a]) ? b : a;
}

/*
 * Where a climb along n starts: at a vertex, or at a landmark where the vertex is on the far side of the body, which is
 * where x has come inside of D since.
 */
static inline uint32_t start_of(const pir_body *body, pir_vec3 n, uint32_t vertex) {
    return pir_vec_dot(n, body->vertex[vertex]) < 0
               ? farther(body->vertex, n, vertex, body->landmarks[pir_landmark_of(n)])
               : vertex;
}

/* Gives a simplex without vertices the vertex farthest towards x. */
void pir_simplex_start(const pir_frame *frame, const pir_placement *placement, pir_simplex *simplex) {
    if (simplex->count > 0)
        return;
    double length = sqrt(pir_vec_dot(placement->x, placement->x));
    pir_vec3 n = length > 0 ? pir_vec_scale(placement->x, 1 / length) : (pir_vec3){1, 0, 0};
    pir_vec3 back = pir_mat_apply_transposed(&frame->r, n);
    simplex->count = 1;
    simplex->a[0] =
        pir_climb_above(frame->p.polytope, back, PIR_LEAST_SLOPE, frame->p.landmarks[pir_landmark_of(back)]);
    simplex->b[0] = pir_climb_above(frame->q.polytope, n, PIR_LEAST_SLOPE, frame->q.landmarks[pir_landmark_of(n)]);
}

void pir_descend_to_point(const pir_frame *frame, const pir_placement *placement, double cutoff, pir_simplex *simplex,
                          uint32_t *steps) {
    pir_vec3 w[4];
    struct nearest best;
    const double meet = PIR_MEET * placement->reach;
    // a cold start may be far from the vertices that it leads to, so landmarks are tried as well
    const bool far = simplex->count == 0;
    pir_simplex_start(frame, placement, simplex);
    for (uint32_t i = 0; i < simplex->count; i++)
        w[i] = pir_vec_sub(pir_frame_vertex(frame, simplex->a[i], simplex->b[i]), placement->x);
    simplex->certain = false;
    simplex->lower = -HUGE_VAL;
    simplex->upper = HUGE_VAL;
    uint32_t n = simplex->count;
    double square = HUGE_VAL;
    for (uint32_t step = 0; step < PIR_MOST_STEPS; step++) {
        simplex->tried = n;
        bool reached = reach_nearest(w, n, &best);
        if (best.encloses)
            return;
        if (!reached || !(best.square < square))
            find_nearest(w, n, &best);
        double length = sqrt(best.square);
        if (!(length < simplex->upper) || length == 0)
            return;
        square = best.square;
        keep_nearest(simplex, w, &best);
        n = simplex->count;
        simplex->upper = length;
        simplex->direction = pir_vec_scale(best.v, -1 / length);
        ++*steps;
        // climb from the vertex that came last, along −v: unlike its unit vector it is known at once
        pir_vec3 minus = pir_vec_scale(best.v, -1), back = pir_mat_apply_transposed(&frame->r, minus);
        double least = PIR_LEAST_SLOPE * length;
        uint32_t a = simplex->a[n - 1], b = simplex->b[n - 1];
        if (far) {
            a = farther(frame->p.vertex, back, a, frame->p.landmarks[pir_landmark_of(back)]);
            b = farther(frame->q.vertex, minus, b, frame->q.landmarks[pir_landmark_of(minus)]);
        } else {
            a = start_of(&frame->p, back, a);
            b = start_of(&frame->q, minus, b);
        }
        a = pir_climb_above(frame->p.polytope, back, least, a);
        b = pir_climb_above(frame->q.polytope, minus, least, b);
        uint32_t at = place_of(simplex, a, b);
        if (at == n)
            w[n] = pir_vec_sub(pir_frame_vertex(frame, a, b), placement->x);
        simplex->lower = -pir_vec_dot(w[at], simplex->direction);
        simplex->certain = length - simplex->lower <= meet && held_within(simplex, w, simplex->lower + meet);
        if (simplex->certain || simplex->lower > cutoff || at < n)
            return;
        simplex->a[n] = a;
        simplex->b[n] = b;
        n++;
    }
}

/* --- where a descent begins --- */

/* Three vertices of a facet, far apart. */
static void spread(const pir_polytope *p, uint32_t facet, uint32_t v[3]) {
    uint32_t start = p->loop_start[facet], count = p->loop_start[facet + 1] - start;
    for (uint32_t i = 0; i < 3; i++)
        v[i] = p->origin[p->loop[start + i * count / 3]];
}

void pir_facet_simplex(const pir_frame *frame, pir_piece piece, pir_simplex *simplex) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    simplex->count = 3;
    if (piece.kind == PIR_FACET_FV) {
        spread(p, piece.first, simplex->a);
        simplex->b[0] = simplex->b[1] = simplex->b[2] = piece.second;
    } else if (piece.kind == PIR_FACET_VF) {
        simplex->a[0] = simplex->a[1] = simplex->a[2] = piece.first;
        spread(q, piece.second, simplex->b);
    } else {
        uint32_t half = p->edge_half[piece.first];
        simplex->a[0] = simplex->a[1] = p->origin[half];
        simplex->a[2] = p->target[half];
        simplex->b[0] = q->origin[piece.second];
        simplex->b[1] = simplex->b[2] = q->target[piece.second];
    }
}
