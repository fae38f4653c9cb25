/* SPDX-License-Identifier: MIT */
/* Bounds by floats, four lanes at a time. */
#include "mesh/pair/node_bounds.h"

static pir_node_float4 size_of(pir_node_float4 x) {
    return (pir_node_float4)((pir_int4)x & 0x7fffffff);
}

/* a where the mask is set, b elsewhere. */
static pir_node_float4 choose(pir_int4 mask, pir_node_float4 a, pir_node_float4 b) {
    return (pir_node_float4)((mask & (pir_int4)a) | (~mask & (pir_int4)b));
}

static pir_node_float4 root_of(pir_node_float4 x) {
    return (pir_node_float4){sqrtf(x[0]), sqrtf(x[1]), sqrtf(x[2]), sqrtf(x[3])};
}

static pir_node_float4 dot(const pir_node_float4 a[3], const pir_node_float4 b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void pir_float_frame_set(pir_float_frame *floats, const pir_mesh_frame *frame, pir_vec3 about) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            floats->r[i][j] = (float)frame->r.m[i][j];
    const double t[3] = {frame->t.x, frame->t.y, frame->t.z}, middle[3] = {about.x, about.y, about.z};
    for (int k = 0; k < 3; k++) {
        floats->t[k] = (float)t[k];
        floats->about[k] = (float)middle[k];
    }
    floats->error = pir_float_over(0x1p-17 * frame->size);
}

/* --- lanes --- */

void pir_lane_set(pir_node_lanes *lanes, int lane, const pir_trimesh *mesh, pir_mesh_item item) {
    const pir_mesh_node *node = &mesh->tree.node[item / PIR_MESH_WIDTH];
    const uint32_t i = item % PIR_MESH_WIDTH;
    float square = 0;
    for (int k = 0; k < 3; k++) {
        float low = pir_mesh_bound(node, k, node->low[k][i]), high = pir_mesh_bound(node, k, node->high[k][i]);
        float normal = (float)node->normal[k][i];
        lanes->middle[k][lane] = 0.5f * (low + high);
        lanes->half[k][lane] = 0.5f * (high - low);
        lanes->normal[k][lane] = normal;
        square += normal * normal;
    }
    lanes->inverse[lane] = 1 / square;
    lanes->low[lane] = node->slab_low[i];
    lanes->high[lane] = node->slab_high[i];
}

void pir_node_lanes_set_node(pir_node_lanes *lanes, const pir_trimesh *mesh, uint32_t n) {
    const pir_mesh_node *node = &mesh->tree.node[n];
    for (int i = 0; i < PIR_NODE_LANES; i++)
        pir_lane_set(lanes, i, mesh, n * PIR_MESH_WIDTH + (i < node->count ? (uint32_t)i : 0));
}

static pir_node_float4 repeat(pir_node_float4 x, int lane) {
    return (pir_node_float4){x[lane], x[lane], x[lane], x[lane]};
}

void pir_node_lanes_repeat(pir_node_lanes *lanes, const pir_node_lanes *from, int lane) {
    for (int k = 0; k < 3; k++) {
        lanes->middle[k] = repeat(from->middle[k], lane);
        lanes->half[k] = repeat(from->half[k], lane);
        lanes->normal[k] = repeat(from->normal[k], lane);
    }
    lanes->inverse = repeat(from->inverse, lane);
    lanes->low = repeat(from->low, lane);
    lanes->high = repeat(from->high, lane);
}

/* --- bounds --- */

/* At least the greatest w · x of each lane. */
static pir_node_float4 supports(const pir_node_lanes *l, const pir_node_float4 w[3]) {
    pir_node_float4 along = dot(w, l->normal) * l->inverse, box = {0, 0, 0, 0};
    pir_node_float4 slab = along * choose(along > 0, l->high, l->low);
    for (int k = 0; k < 3; k++) {
        pir_node_float4 rest = w[k] - along * l->normal[k];
        box += w[k] * l->middle[k] + size_of(w[k]) * l->half[k];
        slab += rest * l->middle[k] + size_of(rest) * l->half[k];
    }
    return choose(box < slab, box, slab);
}

/* How far directions of length 1 take the lanes apart. */
static pir_node_float4 gaps(const pir_float_frame *f, const pir_node_lanes *p, const pir_node_lanes *q,
                            const pir_node_float4 n[3]) {
    pir_node_float4 towards[3];
    for (int k = 0; k < 3; k++)
        towards[k] = -(f->r[0][k] * n[0] + f->r[1][k] * n[1] + f->r[2][k] * n[2]);
    return f->t[0] * n[0] + f->t[1] * n[1] + f->t[2] * n[2] - supports(p, towards) - supports(q, n) - f->error;
}

void pir_bound_along(const pir_float_frame *frame, const pir_node_lanes *p, const pir_node_lanes *q,
                     pir_node_axes *axes) {
    axes->bound = gaps(frame, p, q, axes->n);
}

/* Makes directions as long as 1, from the middles of Q to those of P, and keeps those that prove more. */
static void try_directions(const pir_float_frame *frame, const pir_node_lanes *p, const pir_node_lanes *q,
                           const pir_node_float4 n[3], const pir_node_float4 between[3], pir_node_axes *axes) {
    const pir_node_float4 none = {0, 0, 0, 0};
    pir_node_float4 square = dot(n, n), by = choose(square > 0x1p-100f, 1 / root_of(square), none), unit[3];
    by = choose(dot(n, between) < 0, -by, by);
    for (int k = 0; k < 3; k++)
        unit[k] = n[k] * by;
    pir_node_float4 gap = gaps(frame, p, q, unit);
    pir_int4 better = gap > axes->bound;
    axes->bound = choose(better, gap, axes->bound);
    for (int k = 0; k < 3; k++)
        axes->n[k] = choose(better, unit[k], axes->n[k]);
}

static void turn(const pir_float_frame *f, const pir_node_float4 v[3], pir_node_float4 ret_turned[3]) {
    for (int k = 0; k < 3; k++)
        ret_turned[k] = f->r[k][0] * v[0] + f->r[k][1] * v[1] + f->r[k][2] * v[2];
}

void pir_bound_by_nodes(const pir_float_frame *f, const pir_node_lanes *p, const pir_node_lanes *q,
                        pir_node_axes *axes) {
    pir_node_float4 between[3], normal[3];
    turn(f, p->middle, between);
    turn(f, p->normal, normal);
    for (int k = 0; k < 3; k++)
        between[k] += f->t[k] - q->middle[k];
    try_directions(f, p, q, between, between, axes);
    try_directions(f, p, q, q->normal, between, axes);
    try_directions(f, p, q, normal, between, axes);
}

float pir_lane_reach(const pir_float_frame *frame, const pir_node_lanes *l, int i) {
    float square = 0;
    for (int k = 0; k < 3; k++) {
        float reach = fabsf(l->middle[k][i] - frame->about[k]) + l->half[k][i];
        square += reach * reach;
    }
    return sqrtf(square) * (1 + 0x1p-20f) + frame->error;
}

float pir_lane_size(const pir_node_lanes *l, int i) {
    return l->half[0][i] * l->half[0][i] + l->half[1][i] * l->half[1][i] + l->half[2][i] * l->half[2][i];
}
