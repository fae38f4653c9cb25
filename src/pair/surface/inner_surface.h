/* SPDX-License-Identifier: MIT */
/*
 * A closed surface of triangles whose corners are vertices of D, about a point of D, its centre.
 *
 * Invariants
 *   - Every directed side (i, j) of a triangle is the side (j, i) of one other.
 *   - After pir_surface_place has returned true at a placement, det(a, b, c) > 0 for certain for each triangle with the
 *     corners a, b, c relative to the centre.
 *
 * With both, each ray from the centre leaves the surface through a triangle: the surface is a cycle whose
 * projection on a sphere about the centre covers it at least once. Triangles are parts of D. So a facet of D with
 * normal n has at least the distance from the centre that the triangle on the ray along n has; and where that
 * triangle lies in the plane of another facet of D, it has more than that facet.
 *
 * A surface need not be convex. It keeps its corners as vertex pairs, which pir_surface_place places again at another
 * rotation and centre.
 */
#ifndef PIR_PAIR_SURFACE_INNER_SURFACE_H
#define PIR_PAIR_SURFACE_INNER_SURFACE_H

#include <pirouette/witness.h>

#include "query/frame/frame.h"

/* With v corners a surface like a sphere has 2 v − 4 triangles. */
#define PIR_SURFACE_CORNERS   32
#define PIR_SURFACE_TRIANGLES 64

/* How far triangles are from x at a placement, at least: see kept_lows.h. */
typedef struct pir_surface_lows {
    bool is_known;
    uint8_t rest; /* how many surfaces more are not kept, since that told little */
    pir_vec3 x;
    pir_quat unit;                    /* of the rotation */
    double taken;                     /* what triangles may have come nearer since their distances were found */
    float low[PIR_SURFACE_TRIANGLES]; /* not below 0 */
    pir_witness faces;                /* the faces of a facet of D, or none, */
    uint64_t of_facet;                /* and the triangles that lie in it */
} pir_surface_lows;

typedef struct pir_surface {
    uint32_t used; /* a bit for each corner that a triangle has */
    uint32_t count;
    uint32_t a[PIR_SURFACE_CORNERS], b[PIR_SURFACE_CORNERS];
    uint8_t corner[3][PIR_SURFACE_TRIANGLES];
    pir_surface_lows lows;
} pir_surface;

/* Planes of triangles. */
typedef struct pir_surface_planes {
    double nx[PIR_SURFACE_TRIANGLES], ny[PIR_SURFACE_TRIANGLES], nz[PIR_SURFACE_TRIANGLES]; /* (b − a) × (c − a) */
    double det[PIR_SURFACE_TRIANGLES];                                                      /* n · a */
    double low[PIR_SURFACE_TRIANGLES]; /* the plane is at least this far from the centre */
} pir_surface_planes;

/* Triangles from one corner to the rim of a hole. */
typedef struct pir_surface_fan {
    uint32_t count;
    uint32_t rim, lost; /* corners on the rim, and within the hole: a bit for each */
    uint8_t corner[3][PIR_SURFACE_TRIANGLES];
    pir_surface_planes plane;
} pir_surface_fan;

/* The surface at a placement: in the workspace. Zeros at first. Loops over triangles take whole lanes of them. */
typedef struct pir_surface_room {
    const struct pir_surface_loops *loops;
    pir_vec3 centre;
    double det_error, normal_error;    /* of a det, and of a normal's length: see inner_surface.c */
    double at[PIR_SURFACE_CORNERS][4]; /* corners less the centre; the fourth counts for nothing */
    pir_surface_planes plane;
    pir_surface_fan fan; /* what is about to be put in place of triangles */
    bool has_sides;      /* whether `triangle` is that of the surface as it is placed */
    uint8_t triangle[PIR_SURFACE_CORNERS][PIR_SURFACE_CORNERS]; /* the one that has the directed side (i, j), if any */
} pir_surface_room;

/* The most triangles that a loop takes at a time. */
#define PIR_SURFACE_LANES 4

/* The loops over a surface, in versions for processors that give the same bits. Sets have a bit for each triangle. */
typedef struct pir_surface_loops {
    const char *name;

    /* Places the corners that are used. */
    void (*corners)(const pir_surface *surface, const pir_frame *frame, pir_surface_room *room);

    /*
     * Sets how far from the centre the planes of some triangles are at least. Whole lanes of them are taken: `triangle`
     * and `ret_low` have room for that, and what is past the count are triangles too.
     */
    void (*lows)(const pir_surface *surface, const uint8_t *triangle, uint32_t count, const pir_frame *frame,
                 const pir_surface_room *room, double *ret_low);

    /*
     * The planes of triangles, whose corners are in three rows of PIR_SURFACE_TRIANGLES. Returns those whose `low` is
     * not positive.
     */
    uint64_t (*planes)(const pir_surface_room *room, const uint8_t *corner, uint32_t count,
                       pir_surface_planes *ret_planes);

    /* The triangles whose `low` is at most this. */
    uint64_t (*below)(const pir_surface *surface, const pir_surface_room *room, double limit);

    /* The triangles whose distance that is kept is at most this, which is not below 0. */
    uint64_t (*near)(const pir_surface *surface, float limit);

    /* The least `low` of some triangles; HUGE_VAL where there are none. */
    double (*least)(const pir_surface *surface, const pir_surface_room *room, uint64_t triangles);

    /* The triangles whose planes a point is beyond. */
    uint64_t (*seen)(const pir_surface *surface, const pir_surface_room *room, pir_vec3 w);

    /* The triangles at a corner. */
    uint64_t (*about)(const pir_surface *surface, uint32_t corner);

    /* The triangles that have no corners but these. */
    uint64_t (*within)(const pir_surface *surface, uint32_t corners);

    /* Which of the vertices that corners have, all those of P or all those of Q, are one of two: a bit for each. */
    uint32_t (*either)(const uint32_t vertex[PIR_SURFACE_CORNERS], uint32_t u, uint32_t v);
} pir_surface_loops;

/* Empties the surface and gives it the tetrahedron of four vertices of D. */
void pir_surface_begin(pir_surface *surface, const uint32_t a[4], const uint32_t b[4]);

/* Sets the centre, a point as pir_surface_place takes it, and the errors there. */
static inline void pir_surface_set_centre(pir_vec3 centre, double error, double reach, pir_surface_room *room) {
    room->centre = centre;
    room->det_error = 4 * error * reach * reach;
    room->normal_error = 10 * error * reach;
    room->has_sides = false;
}

/*
 * Places the corners about `centre`, a point of the frame exactly as given that is off by at most `error`. False
 * where a det is not certain to be positive. `room->loops` is set.
 */
bool pir_surface_place(const pir_surface *surface, const pir_frame *frame, pir_vec3 centre, double error, double reach,
                       pir_surface_room *room);

/* A vertex of D, and where it is, less the centre. */
typedef struct pir_surface_vertex {
    uint32_t a, b;
    pir_vec3 at;
} pir_surface_vertex;

/*
 * Adds a vertex of D, in place of triangle t, which it lies beyond, and of others beside that. A vertex that is a
 * corner already is joined to what is about t. Returns the number of its corner; PIR_SURFACE_CORNERS where no surface
 * about the centre with certain dets comes of that, or it has no room: then the surface is as it was. Where the det of
 * t is not certain, the new ones need not be.
 */
uint32_t pir_surface_add(pir_surface *surface, uint32_t t, const pir_surface_vertex *vertex, pir_surface_room *room);

/*
 * Where a corner across a side of triangle t is beyond that, the surface has a dent: turns the side across which the
 * farthest is, so that it joins the two corners across it, or takes away the end of it that is within. False where no
 * corner is beyond, or no triangles with certain dets come of that.
 */
bool pir_surface_turn(pir_surface *surface, uint32_t t, pir_surface_room *room);

/* Whether a surface that is placed has room for any vertex that may be added. */
static inline bool pir_surface_has_room(const pir_surface *surface) {
    return surface->used != UINT32_MAX;
}

/*
 * Takes some of the corners that are farthest from the centre out of a surface that is placed. Its triangles have
 * other numbers then. False where no certain surface is left without any of them.
 */
bool pir_surface_trim(pir_surface *surface, pir_surface_room *room);

/* The first `count` triangles: a bit for each. */
static inline uint64_t pir_surface_first(uint32_t count) {
    return count > 0 ? UINT64_MAX >> (PIR_SURFACE_TRIANGLES - count) : 0;
}

/* Corner i, and the normal of triangle t. */
static inline pir_vec3 pir_surface_corner(const pir_surface_room *room, uint32_t i) {
    return (pir_vec3){room->at[i][0], room->at[i][1], room->at[i][2]};
}

static inline pir_vec3 pir_surface_normal(const pir_surface_room *room, uint32_t t) {
    return (pir_vec3){room->plane.nx[t], room->plane.ny[t], room->plane.nz[t]};
}

/* Whether every directed side has its counterpart: for tests. */
bool pir_surface_is_valid(const pir_surface *surface);

extern const pir_surface_loops pir_surface_plain, pir_surface_avx2;

#endif
