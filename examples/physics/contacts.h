/* SPDX-License-Identifier: MIT */
/* Contacts from the events of a scene. */
#ifndef PHYSICS_CONTACTS_H
#define PHYSICS_CONTACTS_H

#include "solver.h"

/*
 * Puts into `next` what the events say, with the impulses that `last` has for contacts of the same ids; and of `last`
 * what no event speaks of, since both bodies sleep. False where memory runs out.
 */
bool contacts_follow(struct contacts *next, const struct contacts *last, const struct body *body,
                     const pir_scene_event *event, size_t count);

/* Makes `to` the same as `from`, in memory of its own. False where memory runs out. */
bool contacts_copy(struct contacts *to, const struct contacts *from);

void contacts_clear(struct contacts *contacts);

#endif
