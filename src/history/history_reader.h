/* SPDX-License-Identifier: MIT */
/* Numbers out of the bytes of a history, which are not trusted. Past their end a number is 0, and `broken` is set. */
#ifndef PIR_HISTORY_HISTORY_READER_H
#define PIR_HISTORY_HISTORY_READER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <pirouette/pose.h>

typedef struct pir_history_reader {
    const uint8_t *data;
    size_t size, at;
    bool broken;
} pir_history_reader;

/* Whether so many bytes are left; where not, the reader is broken. */
bool pir_history_has(pir_history_reader *reader, size_t bytes);

/* The next `bytes` bytes, 8 at most, as a number. */
uint64_t pir_history_take(pir_history_reader *reader, int bytes);

double pir_history_take_double(pir_history_reader *reader);
pir_vec3 pir_history_take_vec(pir_history_reader *reader);
pir_quat pir_history_take_quat(pir_history_reader *reader);
pir_pose pir_history_take_pose(pir_history_reader *reader);

#endif
