/* SPDX-License-Identifier: MIT */
/* Exact answers in JSON: integers of any length as texts, faces by the numbers of their vertices. */
#ifndef TOOLS_EXACT_JSON_H
#define TOOLS_EXACT_JSON_H

#include <gmp.h>

#include <pirouette/pirouette.h>

#include "json.h"

/* Adds an array of integers, as texts. */
void json_add_integers(struct json *json, cJSON *parent, const char *name, mpz_t *values, size_t count);

/* How many vertices the largest facet of a polytope has, 2 at least: the room that json_add_face needs. */
uint32_t face_room(const pir_polytope *p);

/* Adds the vertices of a face of `p`, as the model numbers them. `corners` is scratch of face_room. */
void json_add_face(struct json *json, cJSON *parent, const char *name, const pir_polytope *p, pir_feature face,
                   uint32_t *corners);

#endif
