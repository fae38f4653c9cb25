/* SPDX-License-Identifier: MIT */
/* The picture of a placement: both bodies as wires, the answer between them. */
#ifndef TOOLS_QUERY_PICTURE_H
#define TOOLS_QUERY_PICTURE_H

#include <stdbool.h>

#include <pirouette/query.h>

/* Writes an SVG file; false after a complaint. */
bool query_picture_write(const char *path, const pir_polytope *p, const pir_polytope *q, pir_quat rotation,
                         pir_vec3 translation, const pir_query_result *answer);

#endif
