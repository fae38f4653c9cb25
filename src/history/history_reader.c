/* SPDX-License-Identifier: MIT */
/* See history_reader.h. */
#include "history/history_reader.h"

#include <string.h>

bool pir_history_has(pir_history_reader *reader, size_t bytes) {
    if (bytes > reader->size - reader->at)
        reader->broken = true;
    return !reader->broken;
}

uint64_t pir_history_take(pir_history_reader *reader, int bytes) {
    uint64_t value = 0;
    if (!pir_history_has(reader, (size_t)bytes))
        return 0;
    for (int k = 0; k < bytes; k++)
        value |= (uint64_t)reader->data[reader->at++] << (8 * k);
    return value;
}

double pir_history_take_double(pir_history_reader *reader) {
    uint64_t bits = pir_history_take(reader, 8);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

pir_vec3 pir_history_take_vec(pir_history_reader *reader) {
    pir_vec3 v;
    v.x = pir_history_take_double(reader);
    v.y = pir_history_take_double(reader);
    v.z = pir_history_take_double(reader);
    return v;
}

pir_quat pir_history_take_quat(pir_history_reader *reader) {
    pir_vec3 v = pir_history_take_vec(reader);
    double w = pir_history_take_double(reader);
    return (pir_quat){v.x, v.y, v.z, w};
}

pir_pose pir_history_take_pose(pir_history_reader *reader) {
    pir_quat rotation = pir_history_take_quat(reader);
    pir_vec3 translation = pir_history_take_vec(reader);
    return (pir_pose){rotation, translation};
}
