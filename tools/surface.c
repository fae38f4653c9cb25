/* SPDX-License-Identifier: MIT */
/* See surface.h. */
#include "surface.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "message.h"
#include "text.h"

static const char *const form_names[] = {"points", "open", "closed"};

pir_surface surface_of_hull(const pir_polytope *polytope) {
    uint32_t facets = pir_polytope_facet_count(polytope);
    return (pir_surface){
        .form = facets > 0 ? PIR_SURFACE_CLOSED : PIR_SURFACE_POINTS,
        .convex = 1,
        .points = pir_polytope_vertex_count(polytope),
        .facets = facets,
        .volume = facets > 0 ? pir_polytope_volume(polytope) : (double)NAN,
    };
}

void surface_add_json(struct json *json, cJSON *parent, const char *name, const pir_surface *surface) {
    cJSON *object = json_add_object(json, parent, name);
    json_add_text(json, object, "surface", form_names[surface->form]);
    json_add_flag(json, object, "convex", surface->convex != 0);
    json_add_number(json, object, "points", surface->points);
    json_add_number(json, object, "facets", surface->facets);
    json_add_number(json, object, "volume", surface->volume);
}

void surface_add_inputs(struct json *json, const pir_surface *surfaces, size_t count) {
    static const char *const names[] = {"p", "q"};
    cJSON *inputs = json_add_object(json, json->root, "inputs");
    for (size_t i = 0; i < count; i++)
        surface_add_json(json, inputs, names[i], &surfaces[i]);
}

const char *surface_text(const pir_surface *surface, char text[SURFACE_TEXT]) {
    if (surface->form == PIR_SURFACE_POINTS)
        snprintf(text, SURFACE_TEXT, "%" PRIu32 " points without facets", surface->points);
    else
        snprintf(text, SURFACE_TEXT, "%s surface of %" PRIu32 " facets", form_names[surface->form], surface->facets);
    return text;
}

void surface_print_notes(const pir_surface *surfaces, size_t count) {
    for (size_t i = 0; i < count; i++) {
        char text[SURFACE_TEXT];
        if (!surfaces[i].convex)
            say("  %-10s %s, not convex; its convex hull is taken\n", i == 0 ? "P as given" : "Q as given",
                surface_text(&surfaces[i], text));
    }
}
