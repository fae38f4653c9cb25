/* SPDX-License-Identifier: MIT */
/* Which bodies sleep. */
#ifndef PHYSICS_SLEEP_H
#define PHYSICS_SLEEP_H

#include "solver.h"

/*
 * Puts to sleep, or wakes, groups of moving bodies that contacts join: a group sleeps where each of it has been still
 * for half a second. `group` has room for a number for each body.
 */
void sleep_update(struct body *body, uint32_t count, const struct contacts *contacts, double step, uint32_t *group);

#endif
