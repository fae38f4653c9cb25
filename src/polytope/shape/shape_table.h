/* SPDX-License-Identifier: MIT */
/* The table of shapes: names, parameters with their ranges, and who makes the points. */
#ifndef PIR_POLYTOPE_SHAPE_SHAPE_TABLE_H
#define PIR_POLYTOPE_SHAPE_SHAPE_TABLE_H

#include "polytope/shape/shape_points.h"

#define PIR_SHAPE_PARAMETERS 4

/* A parameter without a name is fixed at its standard value. */
struct pir_shape_parameter {
    const char *name;
    double standard, low, high;
    bool whole;
};

struct pir_shape_entry {
    const char *name, *help;
    void (*fill)(const double *value, struct pir_point_list *points);
    struct pir_shape_parameter parameter[PIR_SHAPE_PARAMETERS];
};

extern const struct pir_shape_entry pir_shapes[];
extern const size_t pir_shapes_count;

#endif
