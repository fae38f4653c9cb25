/* SPDX-License-Identifier: MIT */
/*
 * The facets of a model before its hull is taken: closed or not, convex or not, and the volume that they
 * enclose. All of it is decided exactly, by the positions of corners: points at the same place are one corner, whatever
 * their numbers.
 */
#ifndef PIR_POLYTOPE_SURFACE_SURFACE_H
#define PIR_POLYTOPE_SURFACE_SURFACE_H

#include "polytope/exact_points.h"
#include "polytope/polytope.h"
#include "polytope/surface/model.h"

/* `exact` holds the points of the model, `hull` is made from them; `require_convex` as in pir_model_make. */
pir_status pir_surface_examine(const struct pir_model *model, const struct pir_exact_points *exact,
                               const pir_polytope *hull, bool require_convex, pir_surface *ret_surface);

#endif
