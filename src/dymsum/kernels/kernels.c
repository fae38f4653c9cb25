/* SPDX-License-Identifier: MIT */
/* The scalar reference of the kernels. */
#include "dymsum/kernels/kernels.h"

#include "polytope/polytope.h"

/* Checks a facet in the cell whose ring fills `blocks` blocks. */
static pir_cell_probe see(const pir_ring *ring, uint32_t blocks, const pir_step *step, const float turned[8]) {
    float highest = -HUGE_VALF, least = 4, ahead = PIR_FARTHEST_PREDICTION, behind = PIR_FARTHEST_PREDICTION;
    uint64_t touched = 0, above = 0;
    uint32_t which = 0;
    for (uint32_t i = 0; i < blocks * PIR_LANES; i++) {
        const pir_ring *at = ring + i / PIR_LANES;
        float x = at->x[i % PIR_LANES], y = at->y[i % PIR_LANES], z = at->z[i % PIR_LANES];
        float s = turned[0] * x + turned[1] * y + turned[2] * z;
        float rate = turned[4] * x + turned[5] * y + turned[6] * z;
        if (s > highest) {
            highest = s;
            which = i;
        }
        // taken as a negative value that rises at `rising`: the angle until it reaches zero, forwards and backwards
        float size = fabsf(s), rising = signbit(s) ? rate : -rate, sure = size - PIR_FLOAT_SLACK;
        float root = sure > 0 ? sqrtf(rising * rising + (sure + sure)) : 0;
        float to = sure > 0 ? root - rising : 0, since = sure > 0 ? root + rising : 0;
        least = size < least ? size : least;
        ahead = to < ahead ? to : ahead;
        behind = since < behind ? since : behind;
        bool clear = to > step->reach_ahead && since > step->reach_behind;
        touched = pir_side_mask_add(touched, i / PIR_LANES, (uint32_t)!clear << i % PIR_LANES);
        above = pir_side_mask_add(above, i / PIR_LANES, (uint32_t)(s > PIR_FLOAT_BOUND) << i % PIR_LANES);
    }
    return (pir_cell_probe){highest + 0.0f, which, {least - PIR_FLOAT_BOUND, ahead, behind, 0, touched, above}};
}

static void probe(const pir_facets *facets, const pir_step *step, uint32_t cell, const float turned[8],
                  pir_cell_probe *ret_probe) {
    uint32_t blocks;
    const pir_ring *ring = pir_rings_of(facets, cell, &blocks);
    *ret_probe = see(ring, blocks, step, turned);
}

static inline void turn_facet(const pir_facets *facets, uint32_t f, float ret_turned[8]) {
    const float *n = facets->normal + (size_t)4 * f;
    for (int i = 0; i < 8; i++)
        ret_turned[i] = facets->turn[0][i] * n[0] + facets->turn[1][i] * n[1] + facets->turn[2][i] * n[2];
}

static inline void check_in(const pir_ring *ring, uint32_t blocks, const pir_step *step, const float turned[8],
                            pir_check *ret_check) {
    *ret_check = see(ring, blocks, step, turned).check;
}

static inline float value(const pir_ring *ring, uint32_t i, const float turned[8]) {
    const pir_ring *at = ring + i / PIR_LANES;
    uint32_t lane = i % PIR_LANES;
    return turned[0] * at->x[lane] + turned[1] * at->y[lane] + turned[2] * at->z[lane];
}

static inline float steepest(const pir_ring *ring, uint32_t blocks, const float turned[8], uint32_t *ret_which) {
    float highest = -HUGE_VALF;
    for (uint32_t i = 0; i < blocks * PIR_LANES; i++) {
        float here = value(ring, i, turned);
        if (here > highest) {
            highest = here;
            *ret_which = i;
        }
    }
    return highest;
}

void pir_arcs_find_sides(const pir_polytope *q, pir_arcs *arcs) {
    for (uint32_t k = 0; k < arcs->count; k++) {
        uint32_t start = q->ring_start[arcs->from[k]], end = q->ring_start[arcs->from[k] + 1], found = PIR_NO_SIDE;
        for (uint32_t side = end; side-- > start;)
            found = q->target[side] == arcs->to[k] ? side : found;
        pir_arcs_take_side(q, arcs, k, start, end, found);
    }
}

void pir_arcs_measure_sides(const pir_facets *facets, const pir_polytope *p, const pir_polytope *q, pir_arcs *arcs) {
    for (uint32_t k = 0; k < arcs->count; k++) {
        const pir_edge_arc *arc = &p->edge_arc[arcs->edge[k]];
        const float *right = q->normal4 + 4 * (size_t)arcs->right[k], *left = q->normal4 + 4 * (size_t)arcs->left[k];
        float turned[3];
        for (int i = 0; i < 3; i++)
            turned[i] = facets->turn[0][i] * arc->x + facets->turn[1][i] * arc->y + facets->turn[2][i] * arc->z;
        arcs->value[k][0] = turned[0] * right[0] + turned[1] * right[1] + turned[2] * right[2];
        arcs->value[k][1] = turned[0] * left[0] + turned[1] * left[1] + turned[2] * left[2];
    }
}

#define DESCEND_TARGET
#include "dymsum/kernels/descend_body.h"
#define REVIEW_TARGET
#include "dymsum/kernels/review_body.h"

/* How far R has turned, by floats. */
struct turned_scalar {
    float ahead, behind;
    bool either;
};

static inline bool holds(float ahead, float behind, struct turned_scalar now) {
    bool forwards = ahead > now.ahead, backwards = behind < now.behind;
    return now.either ? forwards || backwards : forwards && backwards;
}

/* Collects the certificates of block b. */
static uint32_t collect_block(pir_certificates *certificates, uint32_t b, struct turned_scalar now, uint32_t *expired) {
    uint32_t count = 0;
    float least = HUGE_VALF, greatest = -HUGE_VALF;
    for (uint32_t i = b * PIR_CERTIFICATE_BLOCK; i < (b + 1) * PIR_CERTIFICATE_BLOCK; i++) {
        float ahead = certificates->ahead[i], behind = certificates->behind[i];
        if (holds(ahead, behind, now)) {
            least = ahead < least ? ahead : least;
            greatest = behind > greatest ? behind : greatest;
        } else {
            expired[count++] = i;
        }
    }
    certificates->block_ahead[b] = least;
    certificates->block_behind[b] = greatest;
    return count;
}

static uint32_t collect(pir_certificates *certificates, uint32_t blocks, pir_turned_angle time) {
    const struct turned_scalar now = {pir_float_above(time.ahead), pir_float_below(time.behind), time.either};
    uint32_t count = 0;
    for (uint32_t b = 0; b < blocks; b++)
        if (!holds(certificates->block_ahead[b], certificates->block_behind[b], now))
            count += collect_block(certificates, b, now, certificates->expired + count);
    return count;
}

const pir_kernels pir_kernels_plain = {"scalar",
                                       review,
                                       probe,
                                       descend,
                                       pir_find_starts,
                                       pir_arcs_find_sides,
                                       pir_arcs_measure_sides,
                                       collect,
                                       pir_list_caps,
                                       pir_list_points,
                                       pir_list_arcs};
