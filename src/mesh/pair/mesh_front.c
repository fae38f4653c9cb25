/* SPDX-License-Identifier: MIT */
/*
 * The front as arrays: keys and reaches are read one after the other in each call, the rest where a key has expired.
 *
 * Keys are floats. What they lose is below 2^-23 of the key, so bounds are stored 2^-22 lower and compared with as much
 * to spare; when the motion counted is long, keys are brought back to now.
 */
#include "mesh/pair/mesh_front.h"

#include <stddef.h>
#include <string.h>

#define LOSS 0x1p-22

void pir_mesh_front_finish(pir_mesh_front *front, const pir_allocator *allocator) {
    PIR_FREE(allocator, front->entry, front->room);
    PIR_FREE(allocator, front->key, front->room);
    PIR_FREE(allocator, front->reach, front->room);
    PIR_FREE(allocator, front->expired, front->room);
}

/* Makes keys those of a count of motion that begins now. */
static void rebase(pir_mesh_front *front) {
    for (uint32_t i = 0; i < front->count; i++) {
        double key = (double)front->key[i] - (front->path + (double)front->reach[i] * front->turn);
        front->key[i] = (float)(key - LOSS * (fabs((double)front->key[i]) + fabs(key)));
        front->entry[i].made -= (float)front->turn;
    }
    front->path = front->turn = 0;
}

void pir_mesh_front_move(pir_mesh_front *front, const pir_mesh_frame *frame, pir_vec3 about) {
    pir_vec3 middle = pir_mesh_frame_apply(frame, about);
    double square = 0;
    for (int i = 0; i < 9; i++) {
        double change = frame->r.m[i / 3][i % 3] - front->r.m[i / 3][i % 3];
        square += change * change;
    }
    // |ΔR| as an operator is its Frobenius norm over √2, for ΔR has rank two and equal singular values
    front->turn += sqrt(0.5 * square) * (1 + 0x1p-40) + 0x1p-44;
    front->path += pir_vec_length(pir_vec_sub(middle, front->middle)) * (1 + 0x1p-40) + 4 * frame->error;
    front->r = frame->r;
    front->middle = middle;
    if (front->path + frame->reach[0] * front->turn > 4 * frame->size)
        rebase(front);
}

static bool grow(pir_mesh_front *front, const pir_allocator *allocator) {
    uint32_t old = front->room, room = old > 0 ? 2 * old : 256;
    pir_front_entry *entry = PIR_NEW(allocator, pir_front_entry, room);
    float *key = PIR_NEW(allocator, float, room), *reach = PIR_NEW(allocator, float, room);
    uint32_t *expired = PIR_NEW(allocator, uint32_t, room);
    if (!entry || !key || !reach || !expired) {
        PIR_FREE(allocator, entry, room);
        PIR_FREE(allocator, key, room);
        PIR_FREE(allocator, reach, room);
        PIR_FREE(allocator, expired, room);
        return false;
    }
    for (uint32_t i = 0; i < front->count; i++) {
        entry[i] = front->entry[i];
        key[i] = front->key[i];
        reach[i] = front->reach[i];
        expired[i] = front->expired[i];
    }
    pir_mesh_front_finish(front, allocator);
    front->entry = entry;
    front->key = key;
    front->reach = reach;
    front->expired = expired;
    front->room = room;
    return true;
}

void pir_mesh_front_renew(pir_mesh_front *front, uint32_t i, float bound) {
    double key = (double)bound + front->path + (double)front->reach[i] * front->turn;
    front->key[i] = (float)(key - LOSS * fabs(key));
}

bool pir_mesh_front_add(pir_mesh_front *front, const pir_allocator *allocator, const pir_front_entry *entry,
                        float reach, float bound) {
    if (front->count == front->room && !grow(front, allocator))
        return false;
    front->entry[front->count] = *entry;
    front->reach[front->count] = reach;
    pir_mesh_front_renew(front, front->count++, bound);
    return true;
}

void pir_mesh_front_drop(pir_mesh_front *front, uint32_t i) {
    uint32_t last = --front->count;
    front->entry[i] = front->entry[last];
    front->key[i] = front->key[last];
    front->reach[i] = front->reach[last];
}

uint32_t pir_mesh_front_expired(pir_mesh_front *front, double most) {
    // what is compared is off by less than 2^-21 of what enters
    double largest = most + front->path;
    float path = (float)(largest + 4 * LOSS * largest), turn = (float)(front->turn * (1 + 4 * LOSS));
    uint32_t count = 0, i = front->count;
    for (; i % PIR_NODE_LANES != 0; i--) {
        front->expired[count] = i - 1;
        count += front->key[i - 1] <= path + front->reach[i - 1] * turn;
    }
    for (; i > 0; i -= PIR_NODE_LANES) {
        pir_node_float4 key, reach;
        memcpy(&key, front->key + i - PIR_NODE_LANES, sizeof key);
        memcpy(&reach, front->reach + i - PIR_NODE_LANES, sizeof reach);
        const pir_int4 is = key <= path + reach * turn;
        for (int lane = PIR_NODE_LANES - 1; lane >= 0; lane--) {
            front->expired[count] = i - PIR_NODE_LANES + (uint32_t)lane;
            count += (uint32_t)-is[lane];
        }
    }
    return count;
}

/* Four floats of each of four entries, by lanes. */
static void read_lanes(const pir_mesh_front *front, const uint32_t which[PIR_NODE_LANES], size_t offset,
                       pir_node_float4 ret_lanes[PIR_NODE_LANES]) {
    for (int i = 0; i < PIR_NODE_LANES; i++)
        memcpy(&ret_lanes[i], (const char *)&front->entry[which[i]] + offset, sizeof ret_lanes[i]);
    pir_lanes_transpose(ret_lanes);
}

/* The bounds that the directions of four entries still prove. */
static pir_node_float4 bounds_along(const pir_mesh_front *front, const pir_float_frame *f,
                                    const uint32_t which[PIR_NODE_LANES]) {
    pir_node_float4 n[4], middle[4]; // with `taken` and `radius`
    read_lanes(front, which, offsetof(pir_front_entry, n), n);
    read_lanes(front, which, offsetof(pir_front_entry, middle), middle);
    const pir_front_entry *e = front->entry;
    const pir_node_float4 made = {e[which[0]].made, e[which[1]].made, e[which[2]].made, e[which[3]].made};
    pir_node_float4 along = -n[3] - middle[3] * ((float)front->turn * (1 + (float)LOSS) - made) - f->error;
    for (int k = 0; k < 3; k++)
        along += n[k] * (f->r[k][0] * middle[0] + f->r[k][1] * middle[1] + f->r[k][2] * middle[2] + f->t[k]);
    return along;
}

uint32_t pir_mesh_front_renew_along(pir_mesh_front *front, const pir_float_frame *f, uint32_t count, float most) {
    const float path = (float)front->path, turn = (float)front->turn;
    uint32_t *list = front->expired, left = 0;
    for (uint32_t at = 0; at < count; at += PIR_NODE_LANES) {
        const uint32_t lanes = count - at < PIR_NODE_LANES ? count - at : PIR_NODE_LANES;
        uint32_t which[PIR_NODE_LANES];
        for (uint32_t i = 0; i < PIR_NODE_LANES; i++)
            which[i] = list[at + (i < lanes ? i : 0)];
        const pir_node_float4 bound = bounds_along(front, f, which);
        const pir_node_float4 reach = {front->reach[which[0]], front->reach[which[1]], front->reach[which[2]],
                                       front->reach[which[3]]};
        // six roundings of 2^-24 of what enters
        const pir_node_float4 moved = path + reach * turn;
        const pir_node_float4 size = (pir_node_float4)((pir_int4)bound & 0x7fffffff) + moved;
        const pir_node_float4 key = bound + moved - 2 * (float)LOSS * size;
        const pir_int4 is_far = bound > most;
        for (uint32_t i = 0; i < lanes; i++) {
            front->key[which[i]] = key[i];
            list[left] = which[i];
            left += (uint32_t)(1 + is_far[i]);
        }
    }
    return left;
}
