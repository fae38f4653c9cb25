/* SPDX-License-Identifier: MIT */
/*
 * Data that other rooms attach to a polytope: made when first needed, never changed but for numbers that an item learns
 * atomically (query/frame/facet_shape.h), freed with the polytope.
 *
 * A polytope is shared by threads, so the list only ever grows at its head, by one atomic exchange. Where two
 * threads make the same item at once, the first that is added stands and the other is destroyed.
 */
#ifndef PIR_POLYTOPE_ATTACHMENT_H
#define PIR_POLYTOPE_ATTACHMENT_H

#include "polytope/polytope.h"

/* The head of an item. Its maker names it by an address and a number; memory comes from the polytope's allocator. */
struct pir_attachment {
    pir_attachment *next;
    const void *kind;
    int key;
    void (*destroy)(pir_attachment *attachment, const pir_allocator *allocator);
};

/* The item of that name, or NULL. */
pir_attachment *pir_polytope_attachment(const pir_polytope *polytope, const void *kind, int key);

/* Adds an item, and returns the one that stands for its name. */
pir_attachment *pir_polytope_attach(pir_polytope *polytope, pir_attachment *attachment);

/* Destroys all items, when the polytope is freed. */
void pir_polytope_free_attachments(pir_polytope *polytope);

#endif
