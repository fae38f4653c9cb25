/* SPDX-License-Identifier: MIT */
/*
 * The text of the loops over axes. AXES_TARGET names the processor, AXES_WIDTH is the number of doubles in a vector,
 * AXES_NAME the name of the result. AXES_LESSER, AXES_GREATER and AXES_ROOTS are what the processor has for vectors.
 *
 * Every operation is one on lanes, in one order and never fused, so all versions have the same bits.
 */

/* A vector of doubles: the compiler's own, loaded from and stored to any address. */
typedef double lane __attribute__((vector_size(8 * AXES_WIDTH), aligned(8), may_alias));

AXES_TARGET static inline lane load(const double *from) {
    return *(const lane *)from;
}

AXES_TARGET static inline void store(double *to, lane v) {
    *(lane *)to = v;
}

#ifndef AXES_LESSER
static inline lane lesser(lane a, lane b) {
    for (int k = 0; k < AXES_WIDTH; k++)
        a[k] = a[k] < b[k] ? a[k] : b[k];
    return a;
}

static inline lane greater(lane a, lane b) {
    for (int k = 0; k < AXES_WIDTH; k++)
        a[k] = a[k] > b[k] ? a[k] : b[k];
    return a;
}

static inline lane roots(lane a) {
    for (int k = 0; k < AXES_WIDTH; k++)
        a[k] = sqrt(a[k]);
    return a;
}

#define AXES_LESSER(a, b)  lesser(a, b)
#define AXES_GREATER(a, b) greater(a, b)
#define AXES_ROOTS(a)      roots(a)
#endif

/* Whole lanes of four, whatever the width. */
static inline uint32_t padded(uint32_t count) {
    return (count + 3) & ~3u;
}

/* Turns vectors from P's frame to Q's. */
AXES_TARGET static inline void turn(const pir_mat3 *r, const double from[3][PIR_AXES_PADDED], uint32_t count,
                                    double to[3][PIR_AXES_PADDED]) {
    for (uint32_t i = 0; i < padded(count); i += AXES_WIDTH) {
        lane x = load(&from[0][i]), y = load(&from[1][i]), z = load(&from[2][i]);
        for (int k = 0; k < 3; k++)
            store(&to[k][i], r->m[k][0] * x + r->m[k][1] * y + r->m[k][2] * z);
    }
}

AXES_TARGET static inline lane along(lane x, lane y, lane z, const double v[3][PIR_AXES_PADDED], uint32_t i) {
    return v[0][i] * x + v[1][i] * y + v[2][i] * z;
}

/* The vertices of one body, as all look from the other; taken by four, which is no loop. */
struct corners {
    const double (*vertex)[PIR_AXES_PADDED];
    uint32_t count;
};

/* Slacks of facets with these normals, where the other body has these vertices. */
AXES_TARGET static inline void facets(const double n[3][PIR_AXES_PADDED], const pir_axes_lanes *of,
                                      struct corners others, pir_vec3 at, double error, double *low) {
    for (uint32_t i = 0; i < padded(of->facets); i += AXES_WIDTH) {
        lane x = load(&n[0][i]), y = load(&n[1][i]), z = load(&n[2][i]), most = along(x, y, z, others.vertex, 0);
        for (uint32_t k = 0; k < others.count; k += 4)
            for (uint32_t j = k; j < k + 4; j++)
                most = AXES_GREATER(along(x, y, z, others.vertex, j), most);
        store(&low[i], load(&of->offset[i]) + most - (x * at.x + y * at.y + z * at.z) - error);
    }
}

/* The bounds of a body's vertices along vectors. */
struct range {
    lane least, most;
};

AXES_TARGET static inline struct range range_along(lane x, lane y, lane z, struct corners of) {
    struct range range;
    range.least = range.most = along(x, y, z, of.vertex, 0);
    for (uint32_t k = 0; k < of.count; k += 4)
        for (uint32_t j = k; j < k + 4; j++) {
            lane to = along(x, y, z, of.vertex, j);
            range.least = AXES_LESSER(to, range.least);
            range.most = AXES_GREATER(to, range.most);
        }
    return range;
}

AXES_TARGET static uint32_t slacks(const pir_axes_lanes *p, const pir_axes_lanes *q, const pir_mat3 *r, pir_vec3 at,
                                   double error, double low[PIR_AXES_SLACKS]) {
    typedef const double(*lanes)[PIR_AXES_PADDED];
    double vertex[3][PIR_AXES_PADDED], normal[3][PIR_AXES_PADDED], edge[3][PIR_AXES_PADDED];
    turn(r, p->vertex, p->vertices, vertex);
    turn(r, p->normal, p->facets, normal);
    turn(r, p->edge, p->along, edge);
    const struct corners in_p = {(lanes)vertex, p->vertices}, in_q = {q->vertex, q->vertices};
    uint32_t count = padded(p->facets), wide = padded(q->along);
    facets((lanes)normal, p, in_q, at, error, low);
    facets(q->normal, q, in_p, at, error, &low[count]);
    count += padded(q->facets);
    for (uint32_t i = 0; i < p->along; i++, count += 2 * wide)
        for (uint32_t k = 0; k < wide; k += AXES_WIDTH) {
            lane dx = load(&q->edge[0][k]), dy = load(&q->edge[1][k]), dz = load(&q->edge[2][k]);
            lane x = dy * edge[2][i] - dz * edge[1][i], y = dz * edge[0][i] - dx * edge[2][i];
            lane z = dx * edge[1][i] - dy * edge[0][i], length = AXES_ROOTS(x * x + y * y + z * z);
            struct range of_p = range_along(x, y, z, in_p), of_q = range_along(x, y, z, in_q);
            lane to = x * at.x + y * at.y + z * at.z, off = load(&q->far[k]) - 4 * error;
            store(&low[count + k], (of_p.most + of_q.most - to + off) / length);
            store(&low[count + wide + k], (to - of_p.least - of_q.least + off) / length);
        }
    return count;
}

AXES_TARGET static uint32_t least(const double *low, uint32_t count, double *ret_next) {
    lane most = (lane){0} + HUGE_VAL, first = most, second = most;
    for (uint32_t i = 0; i < count; i += AXES_WIDTH) {
        lane v = load(&low[i]);
        second = AXES_LESSER(AXES_GREATER(v, first), second);
        first = AXES_LESSER(v, first);
    }
    double best = HUGE_VAL, next = HUGE_VAL;
    for (int k = 0; k < AXES_WIDTH; k++) {
        next = first[k] < best ? best : first[k] < next ? first[k] : next;
        best = first[k] < best ? first[k] : best;
    }
    for (int k = 0; k < AXES_WIDTH; k++)
        next = second[k] < next ? second[k] : next;
    *ret_next = next;
    uint32_t at = 0;
    while (at + 1 < count && low[at] != best)
        at++;
    return at;
}

const pir_axes_loops AXES_NAME = {AXES_TEXT, slacks, least};
