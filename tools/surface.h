/* SPDX-License-Identifier: MIT */
/* The surface of a model before its convex hull is taken, as every subcommand with models reports it. */
#ifndef TOOLS_SURFACE_H
#define TOOLS_SURFACE_H

#include <pirouette/io.h>

#include "json.h"

/* The surface of a body that is its own hull, as built-in ones are. */
pir_surface surface_of_hull(const pir_polytope *polytope);

/* Adds a member `name` to `parent`: {"surface", "convex", "points", "facets", "volume"}. */
void surface_add_json(struct json *json, cJSON *parent, const char *name, const pir_surface *surface);

/* Adds a member "inputs" to the root, with P's surface and, when there are two, Q's. */
void surface_add_inputs(struct json *json, const pir_surface *surfaces, size_t count);

/* "closed surface of 12 facets" and the like. */
#define SURFACE_TEXT 64
const char *surface_text(const pir_surface *surface, char text[SURFACE_TEXT]);

/* Prints a line for each surface that is not convex. */
void surface_print_notes(const pir_surface *surfaces, size_t count);

#endif
