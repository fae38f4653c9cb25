/* SPDX-License-Identifier: MIT */
/*
 * Contacts of a polytope with triangles, in integers and by plain means. Each difference T ⊕ −P is its vertices and
 * all half-spaces that three of these span. Each nearest point is the one of all simplices of three vertices at most
 * that satisfies the conditions of a nearest point. It shares no code with the library.
 */
#ifndef PIR_ORACLE_CONTACTS_H
#define PIR_ORACLE_CONTACTS_H

#include <stdbool.h>

#include "oracle/points.h"
#include "oracle/triangles.h"

#define ORACLE_CONTACT_POINTS 24

typedef struct oracle_half_space {
    oracle_vec n;
    mpz_t most; /* n · d ≤ most */
} oracle_half_space;

/* A triangle against P at a rotation. */
typedef struct oracle_difference {
    uint32_t count;
    oracle_vec d[ORACLE_CONTACT_POINTS]; /* p − w for P at the origin of its translation */
    oracle_vec front, corner;
    bool one_sided, is_solid;
    uint32_t planes, room;
    oracle_half_space *plane;
} oracle_difference;

typedef struct oracle_scene {
    uint32_t vertices, triangles;
    oracle_vec *vertex; /* of P, turned, in units of 1/scale, as all else */
    oracle_difference *difference;
    mpz_t scale;
    oracle_vec t; /* the translation, of P */
} oracle_scene;

/* P's vertices at a rotation, and triangles that stand in the world. */
oracle_scene *oracle_scene_make(const pir_vec3 *vertex, uint32_t vertices, pir_quat rotation, oracle_triangle *triangle,
                                const bool *one_sided, uint32_t triangles);
void oracle_scene_free(oracle_scene *scene);

/* Moves P. */
void oracle_scene_move(oracle_scene *scene, pir_vec3 t);

/* Whether a triangle counts where P is: it is two-sided, or P has a point in front of it. */
bool oracle_scene_counts(oracle_scene *scene, uint32_t i);

/* How P stands to the triangles that count: 0 apart, 1 touching, 2 overlapping. */
int oracle_scene_state(oracle_scene *scene);

/* The contact of a triangle that is apart from P: its unit normal, its gap, and whether it is one of the union. */
bool oracle_scene_contact(oracle_scene *scene, uint32_t i, pir_vec3 *ret_normal, double *ret_gap);

/*
 * Whether some part of the facet of triangle i's difference that has a normal, which is given in doubles, is on the
 * boundary of the union: the facet is clipped by all differences that are in the way.
 */
bool oracle_scene_exposed(oracle_scene *scene, uint32_t i, pir_vec3 normal);

/*
 * The least way out of an overlap through the foot on one half-space of one triangle that counts, along which P meets
 * nothing a step farther on: HUGE_VAL where there is none.
 */
double oracle_scene_way_out(oracle_scene *scene, double step);

#endif
