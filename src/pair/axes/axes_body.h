/* SPDX-License-Identifier: MIT */
/* The text of the loops over axes, one for all processors. */
#include "base/lane_text.h"
#include "pair/axes/axes.h"

/* Turns vectors from P's frame to Q's. */
PIR_LANES_INLINE void turn(const pir_mat3 *r, const double from[3][PIR_AXES_PADDED], uint32_t count,
                           double to[3][PIR_AXES_PADDED]) {
    for (uint32_t i = 0; i < pir_axes_padded(count); i += PIR_WIDTH) {
        pir_lane x = pir_load(&from[0][i]), y = pir_load(&from[1][i]), z = pir_load(&from[2][i]);
        for (int k = 0; k < 3; k++)
            pir_store(&to[k][i], r->m[k][0] * x + r->m[k][1] * y + r->m[k][2] * z);
    }
}

PIR_LANES_INLINE pir_lane along(pir_lane x, pir_lane y, pir_lane z, const double v[3][PIR_AXES_PADDED], uint32_t i) {
    return v[0][i] * x + v[1][i] * y + v[2][i] * z;
}

/* How much there is of a body. Of boxes it is known beforehand: then no loop counts. */
struct counts {
    uint32_t vertices, lines, along;
    bool is_central;
};

static inline bool is_box(const pir_axes_lanes *of) {
    return of->is_central && of->vertices == 4 && of->lines == 3 && of->along == 3;
}

/* The vertices of one body, as all look from the other; taken by four, which is no loop. */
struct axes_corners {
    const double (*vertex)[PIR_AXES_PADDED];
    struct counts of;
};

/* The bounds of a body's vertices along vectors. */
struct range {
    pir_lane least, most;
};

PIR_LANES_INLINE struct range range_along(pir_lane x, pir_lane y, pir_lane z, const struct axes_corners *of) {
    pir_lane to = along(x, y, z, of->vertex, 0);
    struct range range = {to, to};
    if (of->of.is_central) {
        range.most = pir_size(to);
        for (uint32_t j = 1; j < 4; j++)
            range.most = pir_greater_lanes(pir_size(along(x, y, z, of->vertex, j)), range.most);
        range.least = -range.most;
        return range;
    }
    for (uint32_t k = 0; k < of->of.vertices; k += 4)
        for (uint32_t j = k; j < k + 4; j++) {
            to = along(x, y, z, of->vertex, j);
            range.least = pir_lesser_lanes(to, range.least);
            range.most = pir_greater_lanes(to, range.most);
        }
    return range;
}

/* Slacks along lines, one way and the other, where the other body has these vertices. Returns their number. */
PIR_LANES_INLINE uint32_t lines(const double n[3][PIR_AXES_PADDED], const pir_axes_lanes *of, uint32_t count,
                                const struct axes_corners *others, pir_vec3 at, double error, double *low) {
    count = pir_axes_padded(count);
    for (uint32_t i = 0; i < count; i += PIR_WIDTH) {
        pir_lane x = pir_load(&n[0][i]), y = pir_load(&n[1][i]), z = pir_load(&n[2][i]),
                 to = x * at.x + y * at.y + z * at.z;
        struct range range = range_along(x, y, z, others);
        pir_store(&low[i], pir_load(&of->offset[0][i]) + range.most - to - error);
        pir_store(&low[count + i], pir_load(&of->offset[1][i]) - range.least + to - error);
    }
    return 2 * count;
}

/* A body, and how much there is of it. */
struct axes_side {
    const pir_axes_lanes *lanes;
    struct counts of;
};

PIR_LANES_INLINE uint32_t slacks_of(struct axes_side side_p, struct axes_side side_q, const pir_mat3 *r, pir_vec3 at,
                                    double error, double low[PIR_AXES_SLACKS]) {
    const pir_axes_lanes *p = side_p.lanes, *q = side_q.lanes;
    const struct counts of_p = side_p.of, of_q = side_q.of;
    typedef const double(*lanes)[PIR_AXES_PADDED];
    double vertex[3][PIR_AXES_PADDED], normal[3][PIR_AXES_PADDED], edge[3][PIR_AXES_PADDED];
    turn(r, p->vertex, of_p.vertices, vertex);
    turn(r, p->normal, of_p.lines, normal);
    turn(r, p->edge, of_p.along, edge);
    const struct axes_corners in_p = {(lanes)vertex, of_p}, in_q = {q->vertex, of_q};
    uint32_t wide = pir_axes_padded(of_q.along), count = lines((lanes)normal, p, of_p.lines, &in_q, at, error, low);
    count += lines(q->normal, q, of_q.lines, &in_p, at, error, &low[count]);
    for (uint32_t i = 0; i < of_p.along; i++, count += 2 * wide)
        for (uint32_t k = 0; k < wide; k += PIR_WIDTH) {
            pir_lane dx = pir_load(&q->edge[0][k]), dy = pir_load(&q->edge[1][k]), dz = pir_load(&q->edge[2][k]);
            pir_lane x = dy * edge[2][i] - dz * edge[1][i], y = dz * edge[0][i] - dx * edge[2][i];
            pir_lane z = dx * edge[1][i] - dy * edge[0][i], by = 1 / pir_roots(x * x + y * y + z * z);
            struct range to_p = range_along(x, y, z, &in_p), to_q = range_along(x, y, z, &in_q);
            pir_lane to = x * at.x + y * at.y + z * at.z, off = pir_load(&q->far[k]) - 4 * error;
            pir_store(&low[count + k], (to_p.most + to_q.most - to + off) * by);
            pir_store(&low[count + wide + k], (to - to_p.least - to_q.least + off) * by);
        }
    return count;
}

PIR_LANES_TARGET static uint32_t slacks(const pir_axes_lanes *p, const pir_axes_lanes *q, const pir_mat3 *r,
                                        pir_vec3 at, double error, double low[PIR_AXES_SLACKS]) {
    const struct counts box = {4, 3, 3, true};
    if (is_box(p) && is_box(q))
        return slacks_of((struct axes_side){p, box}, (struct axes_side){q, box}, r, at, error, low);
    const struct axes_side side_p = {p, {p->vertices, p->lines, p->along, p->is_central}};
    const struct axes_side side_q = {q, {q->vertices, q->lines, q->along, q->is_central}};
    return slacks_of(side_p, side_q, r, at, error, low);
}

/* --- parallelepipeds --- */

/* The sum of two halves of edges along vectors, whichever way. */
PIR_LANES_INLINE pir_lane two_along(pir_lane3 n, pir_lane3 a, pir_lane3 b) {
    return pir_size(pir_lane3_dot(n, a)) + pir_size(pir_lane3_dot(n, b));
}

/* Half i of three, in all lanes. */
PIR_LANES_INLINE pir_lane3 half_of(const double half[3][PIR_AXES_HALVES], uint32_t i) {
    return (pir_lane3){pir_all(half[0][i]), pir_all(half[1][i]), pir_all(half[2][i])};
}

PIR_LANES_INLINE void turn_halves(const pir_mat3 *r, const double from[3][PIR_AXES_HALVES],
                                  double to[3][PIR_AXES_HALVES]) {
    for (uint32_t i = 0; i < PIR_AXES_HALVES; i += PIR_WIDTH) {
        const pir_lane x = pir_load(&from[0][i]), y = pir_load(&from[1][i]), z = pir_load(&from[2][i]);
        for (int k = 0; k < 3; k++)
            pir_store(&to[k][i], r->m[k][0] * x + r->m[k][1] * y + r->m[k][2] * z);
    }
}

PIR_LANES_INLINE pir_lane3 lanes_at(const double from[3][PIR_AXES_PADDED], uint32_t i) {
    return (pir_lane3){pir_load(&from[0][i]), pir_load(&from[1][i]), pir_load(&from[2][i])};
}

PIR_LANES_INLINE pir_lane3 halves_at(const double from[3][PIR_AXES_HALVES], uint32_t i) {
    return (pir_lane3){pir_load(&from[0][i]), pir_load(&from[1][i]), pir_load(&from[2][i])};
}

/* Less one in each lane where a slack, times a vector's length, is not above a bound, given the square of both. */
PIR_LANES_INLINE pir_lane_bits not_above(pir_lane slack, pir_lane square) {
    return ~((slack > (pir_lane){0}) & (slack * slack > square));
}

/* Counts, less than none, slacks along the lines of one body, where the other has these halves of edges. */
PIR_LANES_INLINE pir_lane_bits near_lines(const pir_axes_lanes *of, const double normal[3][PIR_AXES_PADDED],
                                          const double half[3][PIR_AXES_HALVES], pir_vec3 at, double least) {
    pir_lane_bits near = {0};
    for (uint32_t i = 0; i < PIR_AXES_HALVES; i += PIR_WIDTH) {
        const pir_lane3 n = lanes_at(normal, i);
        const pir_lane to = pir_lane3_dot(n, pir_lane3_all(at)), bound = pir_all(least);
        const pir_lane h =
            two_along(n, half_of(half, 0), half_of(half, 1)) + pir_size(pir_lane3_dot(n, half_of(half, 2)));
        near += ~(pir_load(&of->offset[0][i]) + h - to > bound) + ~(pir_load(&of->offset[1][i]) + h + to > bound);
    }
    return near;
}

/* An edge of P, turned, and the halves along its other two. */
struct axes_edge {
    pir_lane3 e, half[2];
};

/* Likewise slacks across an edge of P and each of Q. */
PIR_LANES_INLINE pir_lane_bits near_edges(const struct axes_edge *p, const pir_axes_lanes *q, pir_vec3 at, double error,
                                          double most) {
    pir_lane_bits near = {0};
    for (uint32_t k = 0; k < PIR_AXES_HALVES; k += PIR_WIDTH) {
        const pir_lane3 d = lanes_at(q->edge, k), e = p->e;
        const pir_lane3 n = {d.y * e.z - d.z * e.y, d.z * e.x - d.x * e.z, d.x * e.y - d.y * e.x};
        const pir_lane h = two_along(n, p->half[0], p->half[1]) +
                           two_along(n, halves_at(q->other[0], k), halves_at(q->other[1], k)) + pir_load(&q->far[k]);
        const pir_lane to = pir_lane3_dot(n, pir_lane3_all(at)), over = h - pir_all(error);
        // what rounds is less than the last factor holds
        const pir_lane square = pir_lane3_dot(n, n) * pir_all(most * most * (1 + 0x1p-45));
        near += not_above(over - to, square) + not_above(over + to, square);
    }
    return near;
}

PIR_LANES_TARGET static uint32_t near(const pir_axes_lanes *p, const pir_axes_lanes *q, const pir_mat3 *r, pir_vec3 at,
                                      double error, double most) {
    double normal[3][PIR_AXES_PADDED], edge[3][PIR_AXES_PADDED], half[3][PIR_AXES_HALVES];
    int64_t count = 0;
    turn(r, p->normal, 3, normal);
    turn(r, p->edge, 3, edge);
    turn_halves(r, p->half, half);
    typedef const double(*lanes)[PIR_AXES_PADDED];
    typedef const double(*halves)[PIR_AXES_HALVES];
    pir_lane_bits near = near_lines(p, (lanes)normal, q->half, at, most + 2 * error) +
                         near_lines(q, q->normal, (halves)half, at, most + 2 * error);
    for (uint32_t i = 0; i < 3; i++)
        near +=
            near_edges(&(struct axes_edge){{pir_all(edge[0][i]), pir_all(edge[1][i]), pir_all(edge[2][i])},
                                           {half_of((halves)half, (i + 1) % 3), half_of((halves)half, (i + 2) % 3)}},
                       q, at, 4 * error, most);
    for (int k = 0; k < PIR_WIDTH; k++)
        count -= near[k];
    return (uint32_t)count;
}

/* --- the least --- */

PIR_LANES_TARGET static uint32_t least(const double *low, uint32_t count, double *ret_next) {
    pir_lane most = pir_all(HUGE_VAL), first = most, second = most;
    pir_lane_bits at = {0}, here = {0};
    for (uint32_t i = 0; i < count; i += PIR_WIDTH) {
        pir_lane v = pir_load(&low[i]);
        pir_lane_bits less = v < first;
        second = pir_lesser_lanes(pir_greater_lanes(v, first), second);
        first = pir_lesser_lanes(v, first);
        at = (at & ~less) | (here & less);
        here += PIR_WIDTH;
    }
    double best = first[0], next = second[0];
    int64_t place = at[0];
    for (int k = 1; k < PIR_WIDTH; k++) {
        double greater = first[k] < best ? best : first[k];
        bool is_less = first[k] < best || (first[k] == best && at[k] + k < place);
        place = is_less ? at[k] + k : place;
        best = first[k] < best ? first[k] : best;
        next = greater < next ? greater : next;
        next = second[k] < next ? second[k] : next;
    }
    *ret_next = next;
    return (uint32_t)place;
}

const pir_axes_loops PIR_LANES_OF(pir_axes) = {PIR_LANES_NAME, slacks, near, least};
