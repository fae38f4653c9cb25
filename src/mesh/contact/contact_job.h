/* SPDX-License-Identifier: MIT */
/*
 * A polytope P and the triangles near it, all in the world. Doubles are within `error` of the exact coordinates;
 * integers (contact_exact.h) say what those cannot.
 *
 * P stands at the pose's rotation. Its translation is a parameter of what follows: `t` moves the vertices in `vertex`.
 * Points of the difference are d = p + t − w for a vertex p of P and a corner w of a triangle: P meets the triangle
 * where the hull of these holds 0.
 */
#ifndef PIR_MESH_CONTACT_CONTACT_JOB_H
#define PIR_MESH_CONTACT_CONTACT_JOB_H

#include <pirouette/trimesh_contact.h>

#include "exact/rotation.h"
#include "mesh/query/mesh_walk.h"
#include "polytope/polytope.h"

/* How many triangles may be near P. */
#define PIR_CONTACT_TRIANGLES_MOST (1u << 16)

/* Points of a difference: vertices of P and corners of a triangle. */
typedef struct pir_contact_simplex {
    uint32_t count, v[4], w[4];
} pir_contact_simplex;

/* Nearest points of P and a triangle. Whether they meet is exact; numbers are doubles. */
typedef struct pir_contact_near {
    bool meets;  /* then the rest is not set */
    bool proven; /* the simplex that holds the nearest points is exactly that; else it is what doubles found */
    pir_contact_simplex simplex;
    pir_vec3 way;    /* from the triangle to P */
    double distance; /* its length */
    pir_vec3 n;      /* along the way, of any length: made of the simplex */
    double n_error;  /* of n, as a length */
    pir_vec3 point;  /* of the triangle */
    int axis;        /* of the world, that n has exactly; −1: none is known */
} pir_contact_near;

/* The triangles that alone are within the margin of P, which meets none: surface << 32 | number of each, rising. */
typedef struct pir_contact_list {
    const uint64_t *triangle;
    size_t count;
} pir_contact_list;

/* A triangle near P. */
typedef struct pir_near_triangle {
    pir_vec3 p[3];  /* in the world */
    pir_vec3 front; /* unit, towards the front; 0 where doubles cannot tell */
    pir_tri local;  /* in the frame of its surface */
    uint32_t surface, number;
    uint32_t id[3]; /* of its corners, equal where those of one surface are at one place */
    bool one_sided;
    bool counts;           /* at the place of `near`: P is not behind it, or its ball comes to it from there */
    bool passed;           /* there: P without its radius has come to its back, but with it has not left it */
    pir_contact_near near; /* at the place that was looked at last */
    double gap;            /* of its contact where the input has P: set for those in `order` */
} pir_near_triangle;

/* Another convex piece of P's body: beside.h. Lengths are from P's origin, turned. */
typedef struct pir_contact_piece {
    const pir_polytope *p;
    uint32_t first; /* of its vertices in `beside_vertex` */
    pir_vec3 low, high;
    double radius;
} pir_contact_piece;

typedef struct pir_contact_job {
    pir_allocator allocator;
    const pir_polytope *p;
    const pir_surface_contact_input *input;
    const pir_contact_list *list; /* or NULL: triangles are looked for */
    pir_vec3 *vertex;             /* of P, turned */
    uint32_t vertex_room;
    pir_vec3 *turned; /* normals of P's facets, then directions of its edges, turned: see pir_contact_turn */
    uint32_t turned_room;
    bool has_turned;
    double radius; /* of a ball about P's origin that holds P's vertices */
    pir_contact_piece *beside;
    pir_vec3 *beside_vertex;
    uint32_t beside_count, beside_room, beside_vertex_room;
    double beside_radius; /* the greatest of them */
    pir_vec3 low, high;
    pir_near_triangle *triangle;
    uint32_t triangle_count, triangle_room;
    uint32_t *order; /* numbers of triangles, and room to sort as many */
    uint32_t order_room;
    bool out_of_memory;
    double grown;          /* by how much P's box was grown to gather triangles */
    double size;           /* the sum of all lengths that a coordinate is made of */
    double error;          /* of a coordinate */
    pir_rotation rotation; /* of P, and of the surface whose integers were made last */
    pir_rotation surface_rotation;
    uint32_t surface; /* which; UINT32_MAX for none */
    pir_rotation_integers integers[2];
    pir_limbs limbs;
    int exponent;    /* of coordinates as integers */
    double ball;     /* the radius of the ball by which P is grown where ghosts are told; 0 for none */
    uint32_t killer; /* the triangle that made the last ghost; may be none */
    pir_surface_contact_counts counts;
} pir_contact_job;

/* pir_surface_contacts where it is known which triangles are near: finds the same. If P meets one all the same, or with
 * its radius, the list is left alone. `list` may be NULL. */
pir_status pir_surface_contacts_among(const pir_polytope *p, pir_workspace *workspace,
                                      const pir_surface_contact_input *input, const pir_contact_list *list, size_t most,
                                      pir_surface_contact *ret_contacts, pir_surface_contact_result *ret_result);

/* Takes the input. */
pir_status pir_contact_job_begin(pir_contact_job *job, const pir_polytope *p, const pir_surface_contact_input *input);
/* Gathers the triangles of job->list, or those that may be within the margin, and a little more. */
pir_status pir_contact_job_gather_first(pir_contact_job *job);
/* Gathers those whose boxes meet that of P grown by `grow`. */
pir_status pir_contact_job_gather(pir_contact_job *job, double grow);
/* Sets `turned`, once a call. */
void pir_contact_turn(pir_contact_job *job);
/* Room in `order` for all triangles; false when out of memory. */
bool pir_contact_reserve_order(pir_contact_job *job);
void pir_contact_job_finish(pir_contact_job *job);

/* The first of the turned vertices of P that are lowest along n, by doubles. */
uint32_t pir_contact_lowest(const pir_contact_job *job, pir_vec3 n);

/* Whether corner `a` of one triangle and `b` of another are certainly at one place. */
bool pir_near_same_corner(const pir_contact_job *job, const pir_near_triangle *s, int a, const pir_near_triangle *t,
                          int b);

/* Whether two corners of triangles, which may be of one, have the coordinate `axis` of the world in common, exactly. */
bool pir_near_is_level(const pir_contact_job *job, const pir_near_triangle *s, uint32_t a, const pir_near_triangle *t,
                       uint32_t b, int axis);

/* Whether two triangles stand in one frame, so that signs of their own coordinates tell how they lie. */
bool pir_near_same_frame(const pir_contact_job *job, const pir_near_triangle *s, const pir_near_triangle *t);

static inline double pir_length(pir_vec3 v) {
    return sqrt(pir_vec_dot(v, v));
}

static inline pir_vec3 pir_corner_mean(const pir_near_triangle *s) {
    return pir_vec_scale(pir_vec_add(s->p[0], pir_vec_add(s->p[1], s->p[2])), 1.0 / 3);
}

#endif
