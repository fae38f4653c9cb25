/* SPDX-License-Identifier: MIT */
/*
 * The parts of several convex bodies that a viewer sees. Bodies may overlap. Of their union only the parts that nothing
 * hides are drawn.
 *
 * Coordinates are those of the picture: right, up, towards the viewer, who is far away. All is in doubles: what is
 * drawn is a picture, and no answer depends on it.
 */
#ifndef TOOLS_VIEWS_HIDDEN_H
#define TOOLS_VIEWS_HIDDEN_H

#include <stdbool.h>

#include <pirouette/pirouette.h>

/* A half-space: x with normal·x ≤ offset. */
struct half_space {
    double normal[3], offset;
};

/* An edge, directed as a facet that faces the viewer has it. */
struct rim {
    uint32_t from, to;
};

/* One body as seen. Zeroed or filled, hidden_clear releases it. */
struct seen_body {
    const pir_mesh *mesh; /* the caller's */
    double (*at)[3];      /* per vertex */
    bool *front;          /* per facet: it faces the viewer */
    double (*plane)[4];   /* per facet: a normal of unit length and the offset */
    struct rim *rim;      /* of all facets that face the viewer, in order */
    uint32_t rims;
    struct half_space *shadow;
    uint32_t shadows; /* half-spaces whose intersection is the body and all behind it; 0 for a flat body */
    double low[2], high[2];
};

/* A convex polygon of the picture. */
#define SEEN_CORNERS 256
struct seen_polygon {
    uint32_t count;
    double at[SEEN_CORNERS][2];
};

/* The receiver of a picture's parts. */
struct seen_sink {
    void *context;
    /* A visible part of a facet; a facet may come in several. */
    void (*polygon)(void *context, const struct seen_body *body, uint32_t facet, const struct seen_polygon *part);
    /* A visible part of an edge. */
    void (*line)(void *context, const double a[2], const double b[2]);
};

/*
 * The body whose mesh this is, relative to `middle`, seen from azimuth and elevation 35° and 25°. False when out of
 * memory.
 */
bool hidden_see(struct seen_body *body, const pir_mesh *mesh, pir_vec3 middle);
void hidden_clear(struct seen_body *body);

/* Gives all visible parts of the facets of body `which`, then those of its edges. False when out of memory. */
bool hidden_parts(const struct seen_body *bodies, uint32_t count, uint32_t which, const struct seen_sink *sink);

#endif
