/* SPDX-License-Identifier: MIT */
/* The store of certificates. Its design and its invariant stand in certificates.h. */
#include "dymsum/certificate/certificates.h"

#include "base/layout.h"

/* Kernels read blocks eight at a time. */
#define BLOCKS_AT_A_TIME 8

/* The blocks that have bounds. Those behind the last block of certificates never expire. */
static uint32_t block_count(const pir_certificates *certificates) {
    uint32_t blocks = certificates->capacity / PIR_CERTIFICATE_BLOCK;
    return (blocks + BLOCKS_AT_A_TIME - 1) / BLOCKS_AT_A_TIME * BLOCKS_AT_A_TIME;
}

static pir_layout layout_of(pir_certificates *certificates) {
    uint32_t capacity = certificates->capacity, blocks = block_count(certificates);
    return (pir_layout){{PIR_ROW(certificates->margin, capacity), PIR_ROW(certificates->at, capacity),
                         PIR_ROW(certificates->ahead, capacity), PIR_ROW(certificates->behind, capacity),
                         PIR_ROW(certificates->block_ahead, blocks), PIR_ROW(certificates->block_behind, blocks),
                         PIR_ROW(certificates->previous, capacity), PIR_ROW(certificates->expired, capacity)}};
}

bool pir_certificates_init(pir_certificates *certificates, const pir_allocator *allocator, uint32_t count) {
    const uint32_t unit = PIR_CERTIFICATE_BLOCK;
    *certificates = (pir_certificates){.capacity = (count + unit - 1) / unit * unit};
    pir_layout layout = layout_of(certificates);
    if (!pir_layout_new(allocator, &layout)) {
        pir_certificates_finish(certificates, allocator);
        return false;
    }
    for (uint32_t i = 0; i < certificates->capacity; i++)
        pir_certificate_clear(certificates, i);
    for (uint32_t b = 0; b < block_count(certificates); b++) {
        certificates->block_ahead[b] = PIR_NEVER;
        certificates->block_behind[b] = -PIR_NEVER;
    }
    return true;
}

void pir_certificates_finish(pir_certificates *certificates, const pir_allocator *allocator) {
    pir_layout layout = layout_of(certificates);
    pir_layout_free(allocator, &layout);
    *certificates = (pir_certificates){0};
}

/* Makes the bounds of block b from its certificates. */
static void bound_block(pir_certificates *certificates, uint32_t b) {
    float ahead = HUGE_VALF, behind = -HUGE_VALF;
    for (uint32_t i = b * PIR_CERTIFICATE_BLOCK; i < (b + 1) * PIR_CERTIFICATE_BLOCK; i++) {
        ahead = certificates->ahead[i] < ahead ? certificates->ahead[i] : ahead;
        behind = certificates->behind[i] > behind ? certificates->behind[i] : behind;
    }
    certificates->block_ahead[b] = ahead;
    certificates->block_behind[b] = behind;
}

/* From here on keys mean other phases, so the certificates of previous cells are void. */
static void begin_stretch(pir_certificates *certificates) {
    if (++certificates->stretch != PIR_NO_STRETCH)
        return;
    // numbers have run out: begin again
    for (uint32_t i = 0; i < certificates->capacity; i++)
        pir_certificate_forget_previous(certificates, i);
    certificates->stretch = 0;
}

void pir_certificates_shift(pir_certificates *certificates, uint32_t used, double shift) {
    begin_stretch(certificates);
    if (certificates->expired_all)
        return;
    for (uint32_t i = 0; i < used; i++) {
        certificates->ahead[i] = pir_float_below((double)certificates->ahead[i] - shift);
        certificates->behind[i] = pir_float_above((double)certificates->behind[i] - shift);
    }
    for (uint32_t b = 0; b * PIR_CERTIFICATE_BLOCK < used; b++)
        bound_block(certificates, b);
}

/*
 * Unit quaternions at distance 2y (up to sign) turn by at most 4 (y + 0.2215 y³): see pir_rotation_angle_bound. In
 * floats two of them are off by less than 2^-23 together, which is 2^-22 of angle for small angles and in proportion
 * for large ones. The rest of the float rounding is less.
 */
#define NET_ERROR    0x1p-20f
#define NET_RELATIVE (1 + 0x1p-19f)

/* An upper bound on the rest of certificate i's margin, in whatever epoch it was made. */
static inline float left_of(const pir_certificates *certificates, uint32_t i) {
    const float *now = certificates->now.c;
    float apart = 0, across = 0;
    for (int k = 0; k < 4; k++) {
        float minus = certificates->at[i].c[k] - now[k], plus = certificates->at[i].c[k] + now[k];
        apart += minus * minus;
        across += plus * plus;
    }
    float y = 0.5f * sqrtf(apart < across ? apart : across);
    return certificates->margin[i] - 4 * (y + 0.2215f * (y * y * y)) * NET_RELATIVE - NET_ERROR;
}

void pir_certificates_new_epoch(pir_certificates *certificates, uint32_t used, bool axial, double expected) {
    const float slack = axial ? (float)PIR_DRIFT_SLACK : 0, enough = axial ? (float)expected : -HUGE_VALF;
    begin_stretch(certificates);
    if (certificates->expired_all)
        return;
    for (uint32_t b = 0; b * PIR_CERTIFICATE_BLOCK < used; b++) {
        float left[PIR_CERTIFICATE_BLOCK];
        for (uint32_t i = 0; i < PIR_CERTIFICATE_BLOCK; i++)
            left[i] = left_of(certificates, b * PIR_CERTIFICATE_BLOCK + i) - slack;
        float least = HUGE_VALF;
        for (uint32_t i = 0; i < PIR_CERTIFICATE_BLOCK; i++) {
            float ahead = left[i] >= enough ? left[i] : -PIR_NEVER;
            certificates->ahead[b * PIR_CERTIFICATE_BLOCK + i] = ahead;
            certificates->behind[b * PIR_CERTIFICATE_BLOCK + i] = -ahead;
            least = ahead < least ? ahead : least;
        }
        certificates->block_ahead[b] = least;
        certificates->block_behind[b] = -least;
    }
}

void pir_certificates_set_now(pir_certificates *certificates, pir_quat unit) {
    const double q[4] = {unit.x, unit.y, unit.z, unit.w};
    for (int k = 0; k < 4; k++)
        certificates->now.c[k] = (float)q[k];
}

void pir_certificates_expire(pir_certificates *certificates) {
    certificates->expired_all = true;
    begin_stretch(certificates);
}

void pir_certificates_lay_out(pir_certificates *certificates, uint32_t used) {
    certificates->expired_all = false;
    // array by array: each loop is one of vectors
    for (uint32_t i = 0; i < used; i++)
        certificates->ahead[i] = -PIR_NEVER;
    for (uint32_t i = 0; i < used; i++)
        certificates->behind[i] = PIR_NEVER;
    for (uint32_t i = 0; i < used; i++)
        certificates->margin[i] = -1;
    for (uint32_t b = 0; b * PIR_CERTIFICATE_BLOCK < used; b++) {
        certificates->block_ahead[b] = -PIR_NEVER;
        certificates->block_behind[b] = PIR_NEVER;
    }
}
