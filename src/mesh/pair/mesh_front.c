/* SPDX-License-Identifier: MIT */
/*
 * The front as arrays: keys and reaches are read one after the other in each call, the rest where a key has expired.
 *
 * Keys are floats. What they lose is below 2^-23 of the key, so bounds are stored 2^-22 lower and compared with as much
 * to spare; when the motion counted is long, keys are brought back to now.
 */
#include "mesh/pair/mesh_front.h"

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

float pir_mesh_front_along(const pir_mesh_front *front, const pir_float_frame *f, uint32_t i) {
    const pir_front_entry *e = &front->entry[i];
    float along = -e->taken - e->radius * ((float)front->turn * (1 + (float)LOSS) - e->made) - f->error;
    for (int k = 0; k < 3; k++)
        along +=
            e->n[k] * (f->r[k][0] * e->middle[0] + f->r[k][1] * e->middle[1] + f->r[k][2] * e->middle[2] + f->t[k]);
    return along;
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
    uint32_t count = 0;
    for (uint32_t i = front->count; i-- > 0;) {
        front->expired[count] = i;
        count += front->key[i] <= path + front->reach[i] * turn;
    }
    return count;
}
