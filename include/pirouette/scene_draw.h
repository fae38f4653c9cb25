/* SPDX-License-Identifier: MIT */
/**
 * Debug draw: a scene as a program sees it that draws it. One struct of callbacks is told hulls, triangles, boxes and
 * contacts, each with a colour; what is NULL is left out.
 *
 * Nothing of a scene changes. Order: bodies by number, each with its pieces, then the events of the last update.
 *
 * Threads: as of the scene; the callbacks are called from the thread of the call.
 */
#ifndef PIROUETTE_SCENE_DRAW_H
#define PIROUETTE_SCENE_DRAW_H

#include <string.h>

#include <pirouette/base.h>
#include <pirouette/polytope.h>
#include <pirouette/pose.h>
#include <pirouette/query.h>
#include <pirouette/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Colours as 0xRRGGBB: of bodies by kind, and of contacts by what found them. */
typedef enum pir_draw_colour {
    PIR_DRAW_MOVING = 0x4f81bd,
    PIR_DRAW_KINEMATIC = 0x9b59b6,
    PIR_DRAW_STATIC = 0x8a8a8a,
    PIR_DRAW_SENSOR = 0xf1c40f,
    PIR_DRAW_DISABLED = 0xd0d0d0,
    PIR_DRAW_BOX = 0x2ecc71,
    PIR_DRAW_BEGAN = 0xe74c3c,     /**< contacts of an event that began */
    PIR_DRAW_PERSISTED = 0xe67e22, /**< of one that persisted */
} pir_draw_colour;

/** A hull, in a place, grown by a radius. */
typedef struct pir_draw_hull {
    uint32_t body, piece; /**< id and number */
    pir_polytope *polytope;
    pir_pose pose;
    double radius;
    uint32_t colour;
} pir_draw_hull;

/** A triangle of a surface, in the world. */
typedef struct pir_draw_triangle {
    uint32_t body, triangle; /**< id and number */
    pir_vec3 corner[3];
    uint32_t colour;
} pir_draw_triangle;

/** A contact of an event. */
typedef struct pir_draw_contact {
    const pir_scene_event *event;
    pir_vec3 point; /**< half-way between the bodies */
    pir_vec3 normal;
    double distance;
    pir_level level; /**< by which way the pair was answered; PIR_LEVEL_APART where it is not known */
    uint32_t colour;
} pir_draw_contact;

/** The callbacks, and what is drawn. */
typedef struct pir_scene_drawing {
    size_t size; /**< of this struct, which pir_scene_drawing_default sets (base.h) */
    void *context;
    void (*hull)(void *context, const pir_draw_hull *hull);
    void (*triangle)(void *context, const pir_draw_triangle *triangle);
    void (*box)(void *context, pir_vec3 low, pir_vec3 high, uint32_t colour);
    void (*contact)(void *context, const pir_draw_contact *contact);
    bool near_triangles; /**< of surfaces those alone that something is near */
} pir_scene_drawing;

/** No callbacks, all triangles. O(1). */
static inline pir_scene_drawing pir_scene_drawing_default(void) {
    pir_scene_drawing drawing;
    memset(&drawing, 0, sizeof drawing);
    drawing.size = sizeof drawing;
    return drawing;
}

/**
 * Calls the callbacks for all that there is.
 *
 * drawing  borrowed for the call. `box` is told the box of each piece in the tree; a surface has one.
 *
 * Cost: O(pieces + triangles + contacts).
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_VERSION.
 */
PIR_API pir_status pir_scene_draw(const pir_scene *scene, const pir_scene_drawing *drawing);

#ifdef __cplusplus
}
#endif

#endif
