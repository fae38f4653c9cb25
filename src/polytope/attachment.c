/* SPDX-License-Identifier: MIT */
/* Data that other rooms attach to a polytope: see attachment.h. */
#include "polytope/attachment.h"

static pir_attachment *find(pir_attachment *from, const void *kind, int key) {
    while (from && (from->kind != kind || from->key != key))
        from = from->next;
    return from;
}

pir_attachment *pir_polytope_attachment(const pir_polytope *polytope, const void *kind, int key) {
    return find(atomic_load_explicit(&polytope->attachments, memory_order_acquire), kind, key);
}

pir_attachment *pir_polytope_attach(pir_polytope *polytope, pir_attachment *attachment) {
    pir_attachment *head = atomic_load_explicit(&polytope->attachments, memory_order_acquire);
    for (;;) {
        pir_attachment *first = find(head, attachment->kind, attachment->key);
        if (first) {
            attachment->destroy(attachment, &polytope->allocator);
            return first;
        }
        attachment->next = head;
        if (atomic_compare_exchange_weak_explicit(&polytope->attachments, &head, attachment, memory_order_acq_rel,
                                                  memory_order_acquire))
            return attachment;
    }
}

void pir_polytope_free_attachments(pir_polytope *polytope) {
    pir_attachment *attachment = atomic_load_explicit(&polytope->attachments, memory_order_acquire);
    while (attachment) {
        pir_attachment *next = attachment->next;
        attachment->destroy(attachment, &polytope->allocator);
        attachment = next;
    }
    atomic_store_explicit(&polytope->attachments, NULL, memory_order_relaxed);
}
