/* SPDX-License-Identifier: MIT */
/* Exact answers in JSON. */
#include "exact_json.h"

#include <stdlib.h>

void json_add_integers(struct json *json, cJSON *parent, const char *name, mpz_t *values, size_t count) {
    cJSON *list = json_add_array(json, parent, name);
    for (size_t i = 0; i < count; i++) {
        char *digits = malloc(mpz_sizeinbase(values[i], 10) + 2);
        if (digits)
            json_add_text(json, list, NULL, mpz_get_str(digits, 10, values[i]));
        else
            json->failed = true;
        free(digits);
    }
}

uint32_t face_room(const pir_polytope *p) {
    uint32_t most = 2;
    for (uint32_t f = 0; f < pir_polytope_facet_count(p); f++) {
        const uint32_t size = pir_polytope_facet_size(p, f);
        most = size > most ? size : most;
    }
    return most;
}

void json_add_face(struct json *json, cJSON *parent, const char *name, const pir_polytope *p, pir_feature face,
                   uint32_t *corners) {
    uint32_t count = 1;
    corners[0] = face.index;
    if (face.kind == PIR_FEATURE_EDGE) {
        count = 2;
        pir_polytope_edge(p, face.index, corners);
    } else if (face.kind == PIR_FEATURE_FACET) {
        count = pir_polytope_facet_size(p, face.index);
        pir_polytope_facet(p, face.index, corners);
    }
    cJSON *list = json_add_array(json, parent, name);
    for (uint32_t i = 0; i < count; i++)
        json_add_count(json, list, NULL, pir_polytope_source(p, corners[i]));
}
