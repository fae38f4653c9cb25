/* SPDX-License-Identifier: MIT */
/* Bounds by floats, four lanes at a time. */
#include "mesh/pair/node_bounds.h"

#include <stddef.h>
#include <string.h>

static pir_node_float4 size_of(pir_node_float4 x) {
    return (pir_node_float4)((pir_int4)x & 0x7fffffff);
}

/* a where the mask is set, b elsewhere. */
static pir_node_float4 choose(pir_int4 mask, pir_node_float4 a, pir_node_float4 b) {
    return (pir_node_float4)((mask & (pir_int4)a) | (~mask & (pir_int4)b));
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

/*
 * An item by axes. Words of a node that follow those of the axes are read as a fourth axis, and come to finite numbers
 * that nothing uses. Steps are added before they are scaled: a rounding less than reading both bounds.
 */
typedef struct item_rows {
    pir_node_float4 middle, half, normal;
} item_rows;

_Static_assert(offsetof(pir_mesh_node, normal) + 16 <= sizeof(pir_mesh_node), "a fourth axis may be read");

/* Four words of a node, of which each has a byte for each child. */
static pir_int4 words(const pir_mesh_node *node, size_t offset) {
    pir_int4 four;
    memcpy(&four, (const char *)node + offset, sizeof four);
    return four;
}

static pir_node_float4 float_of(pir_int4 x) {
    return __builtin_convertvector(x, pir_node_float4);
}

static pir_node_float4 steps_of(const pir_mesh_node *node) {
    return (pir_node_float4){pir_mesh_step(node->exponent[0]), pir_mesh_step(node->exponent[1]),
                             pir_mesh_step(node->exponent[2]), 0} *
           0.5f;
}

static item_rows rows_of(const pir_mesh_node *node, int place) {
    const int shift = 8 * (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__ ? PIR_MESH_WIDTH - 1 - place : place);
    const pir_int4 low = words(node, offsetof(pir_mesh_node, low)) >> shift & 255;
    const pir_int4 high = words(node, offsetof(pir_mesh_node, high)) >> shift & 255;
    const pir_int4 normal = words(node, offsetof(pir_mesh_node, normal)) << (24 - shift) >> 24;
    const pir_node_float4 step = steps_of(node), origin = {node->origin[0], node->origin[1], node->origin[2], 0};
    return (item_rows){origin + step * float_of(low + high), step * float_of(high - low), float_of(normal)};
}

static const pir_mesh_node *node_of(const pir_trimesh *mesh, pir_mesh_item item) {
    return &mesh->tree.node[item / PIR_MESH_WIDTH];
}

static pir_node_float4 repeat(float x) {
    return (pir_node_float4){x, x, x, x};
}

static void set_inverse(pir_node_lanes *lanes) {
    lanes->inverse = 1 / dot(lanes->normal, lanes->normal);
}

void pir_node_lanes_set(pir_node_lanes *lanes, const pir_trimesh *mesh, const pir_mesh_item item[PIR_NODE_LANES]) {
    pir_node_float4 middle[PIR_NODE_LANES], half[PIR_NODE_LANES], normal[PIR_NODE_LANES];
    for (int i = 0; i < PIR_NODE_LANES; i++) {
        const pir_mesh_node *node = node_of(mesh, item[i]);
        const int place = (int)(item[i] % PIR_MESH_WIDTH);
        const item_rows row = rows_of(node, place);
        middle[i] = row.middle;
        half[i] = row.half;
        normal[i] = row.normal;
        lanes->low[i] = node->slab_low[place];
        lanes->high[i] = node->slab_high[place];
    }
    pir_lanes_transpose(middle);
    pir_lanes_transpose(half);
    pir_lanes_transpose(normal);
    for (int k = 0; k < 3; k++) {
        lanes->middle[k] = middle[k];
        lanes->half[k] = half[k];
        lanes->normal[k] = normal[k];
    }
    set_inverse(lanes);
}

void pir_node_lanes_set_one(pir_node_lanes *lanes, const pir_trimesh *mesh, pir_mesh_item item) {
    const pir_mesh_node *node = node_of(mesh, item);
    const int place = (int)(item % PIR_MESH_WIDTH);
    const item_rows row = rows_of(node, place);
    for (int k = 0; k < 3; k++) {
        lanes->middle[k] = repeat(row.middle[k]);
        lanes->half[k] = repeat(row.half[k]);
        lanes->normal[k] = repeat(row.normal[k]);
    }
    lanes->low = repeat(node->slab_low[place]);
    lanes->high = repeat(node->slab_high[place]);
    set_inverse(lanes);
}

/* The bytes of four children as floats; of places without a child those of the first. */
static pir_int4 bytes_of(const uint8_t byte[PIR_MESH_WIDTH], pir_int4 has) {
    const pir_int4 first = {byte[0], byte[0], byte[0], byte[0]};
    return (has & (pir_int4){byte[0], byte[1], byte[2], byte[3]}) | (~has & first);
}

void pir_node_lanes_set_node(pir_node_lanes *lanes, const pir_trimesh *mesh, uint32_t n) {
    const pir_mesh_node *node = &mesh->tree.node[n];
    const pir_int4 has = (pir_int4){0, 1, 2, 3} < node->count;
    const pir_node_float4 step = steps_of(node);
    for (int k = 0; k < 3; k++) {
        const pir_int4 low = bytes_of(node->low[k], has), high = bytes_of(node->high[k], has);
        const pir_int4 normal = bytes_of((const uint8_t *)node->normal[k], has) << 24 >> 24;
        lanes->middle[k] = node->origin[k] + step[k] * float_of(low + high);
        lanes->half[k] = step[k] * float_of(high - low);
        lanes->normal[k] = float_of(normal);
    }
    memcpy(&lanes->low, node->slab_low, sizeof lanes->low);
    memcpy(&lanes->high, node->slab_high, sizeof lanes->high);
    lanes->low = choose(has, lanes->low, repeat(node->slab_low[0]));
    lanes->high = choose(has, lanes->high, repeat(node->slab_high[0]));
    set_inverse(lanes);
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
    pir_node_float4 square = dot(n, n), by = choose(square > 0x1p-100f, 1 / pir_lanes_root(square), none), unit[3];
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

pir_node_float4 pir_lanes_reach(const pir_float_frame *frame, const pir_node_lanes *l) {
    pir_node_float4 square = {0, 0, 0, 0};
    for (int k = 0; k < 3; k++) {
        const pir_node_float4 reach = size_of(l->middle[k] - frame->about[k]) + l->half[k];
        square += reach * reach;
    }
    return pir_lanes_root(square) * (1 + 0x1p-20f) + frame->error;
}

pir_node_float4 pir_lanes_size(const pir_node_lanes *l) {
    return dot(l->half, l->half);
}

float pir_item_size(const pir_trimesh *mesh, pir_mesh_item item) {
    const pir_mesh_node *node = node_of(mesh, item);
    const uint32_t i = item % PIR_MESH_WIDTH;
    float square = 0;
    for (int k = 0; k < 3; k++) {
        const float half = 0.5f * pir_mesh_step(node->exponent[k]) * (float)(node->high[k][i] - node->low[k][i]);
        square += half * half;
    }
    return square;
}
