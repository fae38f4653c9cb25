/* SPDX-License-Identifier: MIT */
/* Two bodies, their contacts, and checks that hold of every manifold. */
#ifndef PIR_TEST_CONTACT_SCENE_H
#define PIR_TEST_CONTACT_SCENE_H

#include <stdbool.h>

#include <pirouette/query.h>

#define SCENE_CONTACTS 256

typedef struct contact_scene {
    pir_polytope *p, *q;
    pir_sum *sum;
    pir_query *query;
    pir_quat r;
    pir_vec3 t;
    double margin;
    double size;
    /* the last manifold */
    pir_query_result answer;
    pir_contact contact[SCENE_CONTACTS];
    size_t count;
} contact_scene;

/* Makes a scene and takes over the bodies. */
contact_scene contact_scene_make(pir_polytope *p, pir_polytope *q, pir_quat r);
void contact_scene_clear(contact_scene *scene);

/* Asks for the manifold at the scene's translation and margin. */
void contact_scene_ask(contact_scene *scene);

/*
 * Asks for the manifold and checks it. The answer comes first. Each point is on its body and over the other. No
 * contact is deeper than the answer or farther than was asked for. Ids are distinct. The corners turn
 * counter-clockwise about the normal. A smaller capacity gives the first contacts, and a larger margin only adds
 * contacts. `what` and `number` name the case.
 */
void contact_scene_check(contact_scene *scene, const char *what, uint64_t number);

/* The number of corners of the last manifold: of all contacts but an answer that is none. */
size_t contact_scene_corners(const contact_scene *scene);

/* The distance of x, in the body's frame, from the surface of a polytope of any dimension. */
double contact_scene_off(const pir_polytope *body, pir_vec3 x);

/* The hull of points that are rotated in double first. */
pir_polytope *contact_scene_baked(const pir_vec3 *points, size_t count, pir_quat turned);

/* The box of the given half sides about the origin. */
pir_polytope *contact_scene_box(double x, double y, double z);

#endif
