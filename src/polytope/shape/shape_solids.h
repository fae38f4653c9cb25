/* SPDX-License-Identifier: MIT */
/* Points of the platonic and archimedean solids and of the triakis icosahedron. */
#ifndef PIR_POLYTOPE_SHAPE_SHAPE_SOLIDS_H
#define PIR_POLYTOPE_SHAPE_SHAPE_SOLIDS_H

#include "polytope/shape/shape_points.h"

enum pir_shape_solid {
    PIR_TETRAHEDRON,
    PIR_CUBE,
    PIR_OCTAHEDRON,
    PIR_DODECAHEDRON,
    PIR_ICOSAHEDRON,
    PIR_TRUNCATED_TETRAHEDRON,
    PIR_CUBOCTAHEDRON,
    PIR_TRUNCATED_CUBE,
    PIR_TRUNCATED_OCTAHEDRON,
    PIR_RHOMBICUBOCTAHEDRON,
    PIR_TRUNCATED_CUBOCTAHEDRON,
    PIR_SNUB_CUBE,
    PIR_ICOSIDODECAHEDRON,
    PIR_TRUNCATED_DODECAHEDRON,
    PIR_TRUNCATED_ICOSAHEDRON,
    PIR_RHOMBICOSIDODECAHEDRON,
    PIR_TRUNCATED_ICOSIDODECAHEDRON,
    PIR_SNUB_DODECAHEDRON,
    PIR_TRIAKIS_ICOSAHEDRON,
};

/* value[0] is an enum pir_shape_solid. The largest coordinate is in [1/2, 1): the cube's side is 1. */
void pir_points_solid(const double *value, struct pir_point_list *points);

#endif
