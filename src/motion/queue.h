/* SPDX-License-Identifier: MIT */
/*
 * Movers in the order of their next instants: a heap, ordered exactly.
 *
 * Invariant: no mover's next instant comes before that of its parent. Movers without a next instant are not in it.
 */
#ifndef PIR_MOTION_QUEUE_H
#define PIR_MOTION_QUEUE_H

#include "motion/movers.h"

typedef struct pir_queue {
    uint32_t *item; /* room for all movers */
    uint32_t count;
} pir_queue;

/* Makes the heap of all movers that have a next instant. */
void pir_queue_fill(pir_queue *queue, pir_movers *movers);

void pir_queue_push(pir_queue *queue, pir_movers *movers, uint32_t m);

/* Takes the first mover off. The queue must hold one. */
uint32_t pir_queue_pop(pir_queue *queue, pir_movers *movers);

#endif
