/* SPDX-License-Identifier: MIT */
/* Points of the shapes that come in sizes. Each maker reads its parameters from `value`, in the
   order named beside it. */
#ifndef PIR_POLYTOPE_SHAPE_SHAPE_FAMILIES_H
#define PIR_POLYTOPE_SHAPE_SHAPE_FAMILIES_H

#include "polytope/shape/shape_points.h"

void pir_points_point(const double *value, struct pir_point_list *points);
void pir_points_segment(const double *value, struct pir_point_list *points);       /* length */
void pir_points_polygon(const double *value, struct pir_point_list *points);       /* sides, radius */
void pir_points_box(const double *value, struct pir_point_list *points);           /* x, y, z */
void pir_points_prism(const double *value, struct pir_point_list *points);         /* sides, radius, height */
void pir_points_antiprism(const double *value, struct pir_point_list *points);     /* sides, radius, height */
void pir_points_pyramid(const double *value, struct pir_point_list *points);       /* sides, radius, height */
void pir_points_dipyramid(const double *value, struct pir_point_list *points);     /* sides, radius, height */
void pir_points_dioctagonal(const double *value, struct pir_point_list *points);   /* radius, height */
void pir_points_rod(const double *value, struct pir_point_list *points);           /* sides, rings, radius, height */
void pir_points_ellipsoid(const double *value, struct pir_point_list *points);     /* level, x, y, z */
void pir_points_geodesic(const double *value, struct pir_point_list *points);      /* level, radius */
void pir_points_random(const double *value, struct pir_point_list *points);        /* points, seed, radius */
void pir_points_random_sphere(const double *value, struct pir_point_list *points); /* points, seed, radius */

#endif
