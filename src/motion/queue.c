/* SPDX-License-Identifier: MIT */
/* See queue.h. */
#include "motion/queue.h"

/* Moves `m` from place `at` down to where no child comes before it. */
static void sink(pir_queue *queue, pir_movers *movers, uint32_t at, uint32_t m) {
    for (;;) {
        uint32_t child = 2 * at + 1;
        if (child >= queue->count)
            break;
        if (child + 1 < queue->count && pir_movers_order(movers, queue->item[child + 1], queue->item[child]) < 0)
            child++;
        if (pir_movers_order(movers, m, queue->item[child]) <= 0)
            break;
        queue->item[at] = queue->item[child];
        at = child;
    }
    queue->item[at] = m;
}

void pir_queue_fill(pir_queue *queue, pir_movers *movers) {
    queue->count = 0;
    for (uint32_t m = 0; m < movers->count; m++)
        if (movers->mover[m].next.half != PIR_NONE)
            queue->item[queue->count++] = m;
    for (uint32_t at = queue->count / 2; at-- > 0;)
        sink(queue, movers, at, queue->item[at]);
}

void pir_queue_push(pir_queue *queue, pir_movers *movers, uint32_t m) {
    uint32_t at = queue->count++;
    while (at > 0 && pir_movers_order(movers, m, queue->item[(at - 1) / 2]) < 0) {
        queue->item[at] = queue->item[(at - 1) / 2];
        at = (at - 1) / 2;
    }
    queue->item[at] = m;
}

uint32_t pir_queue_pop(pir_queue *queue, pir_movers *movers) {
    const uint32_t first = queue->item[0], last = queue->item[--queue->count];
    if (queue->count > 0)
        sink(queue, movers, 0, last);
    return first;
}
