/* SPDX-License-Identifier: MIT */
/* Numbers out of the bytes of a sum. See sum_source.h. */
#include "dymsum/file/sum_source.h"

#include <string.h>

#include "base/report.h"

pir_status pir_source_broken(const pir_source *from, const char *why) {
    return pir_fail(from->report, PIR_ERR_FORMAT, "sum: byte %zu, %s: %s", from->at, from->part, why);
}

pir_status pir_source_no_memory(const pir_source *from) {
    return pir_fail(from->report, PIR_ERR_MEMORY, "sum: byte %zu, %s: out of memory", from->at, from->part);
}

bool pir_source_has(const pir_source *from, uint64_t count, size_t size) {
    return count <= (from->size - from->at) / size;
}

uint32_t pir_source_u32(pir_source *from) {
    uint32_t value = 0;
    for (int k = 0; k < 4; k++)
        value |= (uint32_t)from->data[from->at++] << (8 * k);
    return value;
}

uint64_t pir_source_u64(pir_source *from) {
    uint64_t low = pir_source_u32(from);
    return low | (uint64_t)pir_source_u32(from) << 32;
}

double pir_source_double(pir_source *from) {
    uint64_t bits = pir_source_u64(from);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

pir_vec3 pir_source_vec(pir_source *from) {
    pir_vec3 v;
    v.x = pir_source_double(from);
    v.y = pir_source_double(from);
    v.z = pir_source_double(from);
    return v;
}

pir_quat pir_source_quat(pir_source *from) {
    pir_quat q;
    q.x = pir_source_double(from);
    q.y = pir_source_double(from);
    q.z = pir_source_double(from);
    q.w = pir_source_double(from);
    return q;
}

uint32_t pir_limbs_for_bytes(uint32_t bytes) {
    return (8 * bytes + GMP_NUMB_BITS - 1) / GMP_NUMB_BITS;
}

void pir_source_magnitude(pir_source *from, uint32_t bytes, pir_int *to) {
    uint32_t limbs = pir_limbs_for_bytes(bytes);
    pir_int_check_room(to->room, limbs);
    memset(to->limb, 0, limbs * sizeof *to->limb);
    for (uint32_t k = 0; k < bytes; k++)
        to->limb[8 * k / GMP_NUMB_BITS] |= (mp_limb_t)from->data[from->at++] << (8 * k % GMP_NUMB_BITS);
    while (limbs > 0 && to->limb[limbs - 1] == 0)
        limbs--;
    to->size = (int32_t)limbs;
}

pir_status pir_source_scale(pir_source *from, pir_scale_room *room, pir_scale *ret_scale) {
    pir_scale scale = {{room->num, 0, PIR_SCALE_LIMBS}, {room->den, 0, PIR_SCALE_LIMBS}};
    pir_int *part[2] = {&scale.num, &scale.den};
    for (int i = 0; i < 2; i++) {
        if (!pir_source_has(from, 1, 4))
            return pir_source_broken(from, "truncated");
        uint32_t bytes = pir_source_u32(from);
        if (bytes > PIR_SUM_NUMBER_MAX)
            return pir_source_broken(from, "a scale of too many bytes");
        if (!pir_source_has(from, bytes, 1))
            return pir_source_broken(from, "truncated");
        pir_source_magnitude(from, bytes, part[i]);
        if (part[i]->size == 0)
            return pir_source_broken(from, "a scale of zero");
    }
    *ret_scale = scale;
    return PIR_OK;
}
