/* SPDX-License-Identifier: MIT */
/* An answer that has just been written, given to the caller. */
#ifndef PIR_PAIR_GIVE_H
#define PIR_PAIR_GIVE_H

#include <pirouette/query.h>
#include <string.h>

/* As bytes, of which a compiler does not know that they are apart from all others: so it makes no wider load of two. */
static inline void copy_double(const void *from, void *to) {
    double v;
    memcpy(&v, from, sizeof v);
    memcpy(to, &v, sizeof v);
}

static inline void copy_vector(const pir_vec3 *from, pir_vec3 *to) {
    copy_double(&from->x, &to->x);
    copy_double(&from->y, &to->y);
    copy_double(&from->z, &to->z);
}

static inline void copy_int(const void *from, void *to) {
    uint32_t v;
    memcpy(&v, from, sizeof v);
    memcpy(to, &v, sizeof v);
}

/*
 * Copies number by number, as they have just been stored: a wider load would wait until all of them have reached the
 * cache.
 */
static inline void pir_result_give(const pir_query_result *from, pir_query_result *to) {
    copy_int(&from->state, &to->state);
    copy_int(&from->outcome, &to->outcome);
    copy_double(&from->distance, &to->distance);
    copy_vector(&from->normal, &to->normal);
    copy_vector(&from->point_p, &to->point_p);
    copy_vector(&from->point_q, &to->point_q);
    copy_int(&from->witness.p.kind, &to->witness.p.kind);
    copy_int(&from->witness.p.index, &to->witness.p.index);
    copy_int(&from->witness.q.kind, &to->witness.q.kind);
    copy_int(&from->witness.q.index, &to->witness.q.index);
    copy_int(&from->steps, &to->steps);
}

#endif
