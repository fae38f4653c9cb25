/* SPDX-License-Identifier: MIT */
/*
 * Impacts of bodies with a restitution, all that happen at one time together. What stops the approach at all their
 * contacts is found first; that is the least change of velocities that does (Moreau, 1988), so reversing as much again
 * neither adds energy nor takes it, and a restitution below 1 takes some (Smith et al., "Reflections on simultaneous
 * impact", SIGGRAPH 2012). What passes leave open, and different restitutions, cannot add any either: the impulses of
 * bodies that are linked are taken as far along their direction as their work is not above 0.
 */
#ifndef PHYSICS_BOUNCE_H
#define PHYSICS_BOUNCE_H

#include "solver.h"

/* `group` has room for all bodies. */
void bounce_all(struct body *body, uint32_t count, const struct contacts *contacts, const struct solver_rules *rules,
                uint32_t *group);

#endif
