/* SPDX-License-Identifier: MIT */
/* A segment against a polytope with a rounding radius, in doubles. */
#ifndef PIR_SCENE_QUERY_RAY_ROUNDED_H
#define PIR_SCENE_QUERY_RAY_ROUNDED_H

#include "scene/query/ray.h"

/* `radius` is above 0. */
pir_entry pir_ray_rounded(const pir_polytope *p, const pir_ray_segment *segment, double radius);

#endif
