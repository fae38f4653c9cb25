/* SPDX-License-Identifier: MIT */
/**
 * Shapes of bodies as people name them: balls, capsules, boxes, cylinders, cones, planes, hulls, compounds, meshes and
 * height fields. A shape has what a body of a scene is made of, its pieces and rounding radius or its surface, its
 * mass, and a line of text that says what it is.
 *
 *     pir_body_shape *capsule;
 *     pir_body_shape_capsule((pir_vec3){0, 0, -0.5}, (pir_vec3){0, 0, 0.5}, 0.3, NULL, NULL, &capsule);
 *     pir_body_options body = pir_body_shape_options(capsule);
 *     pir_scene_add(scene, &body, &id);
 *
 * Balls, capsules and rounded boxes are exactly that: a point, a segment, a box, and a radius, which contacts, rays,
 * casts, overlaps and nearest points honour. Cylinders and cones are polytopes whose corners lie on the round one, so
 * within it by radius · (1 − cos(π / sides)).
 *
 * Ownership: shapes are immutable, and count references. What their options point to is theirs: they have to be there
 * when a body is added, and may go afterwards.
 *
 * Threads: any thread may read a shape.
 *
 * Errors of all constructors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_LIMIT, PIR_ERR_MEMORY, with a report.
 *
 * Parameters of all constructors: allocator, NULL for malloc; report, NULL, or filled with what, where and why.
 */
#ifndef PIROUETTE_BODY_SHAPE_H
#define PIROUETTE_BODY_SHAPE_H

#include <pirouette/base.h>
#include <pirouette/mass.h>
#include <pirouette/polytope.h>
#include <pirouette/pose.h>
#include <pirouette/scene.h>
#include <pirouette/trimesh.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_body_shape pir_body_shape;

/**
 * A ball about the origin.
 *
 * radius  > 0.
 * allocator, report  NULL, or as of all constructors.
 *
 * Cost: O(1).
 *
 * Errors: those of all constructors.
 */
PIR_API pir_status pir_body_shape_ball(double radius, const pir_allocator *allocator, pir_report *report,
                                       pir_body_shape **ret_shape);

/**
 * All that is within a radius of the segment from a to b.
 *
 * radius  > 0.
 * allocator, report  NULL, or as of all constructors.
 *
 * Cost: O(1).
 *
 * Errors: those of all constructors.
 */
PIR_API pir_status pir_body_shape_capsule(pir_vec3 a, pir_vec3 b, double radius, const pir_allocator *allocator,
                                          pir_report *report, pir_body_shape **ret_shape);

/**
 * A box about the origin, with rounded edges where the radius is above 0.
 *
 * half    half of its edges, the radius included; each at least the radius and above 0.
 * radius  ≥ 0, of its edges.
 * allocator, report  NULL, or as of all constructors.
 *
 * Cost: O(1).
 *
 * Errors: those of all constructors.
 */
PIR_API pir_status pir_body_shape_box(pir_vec3 half, double radius, const pir_allocator *allocator, pir_report *report,
                                      pir_body_shape **ret_shape);

/**
 * A cylinder about the z axis, from −height/2 to height/2, with as many sides.
 *
 * radius, height  > 0.
 * sides           3 to 1024, or 0 for 32.
 * allocator, report  NULL, or as of all constructors.
 *
 * Cost: that of the hull.
 *
 * Errors: those of all constructors.
 */
PIR_API pir_status pir_body_shape_cylinder(double radius, double height, uint32_t sides, const pir_allocator *allocator,
                                           pir_report *report, pir_body_shape **ret_shape);

/**
 * A cone about the z axis: its base of a radius at −height/4, its apex at 3/4 height, so that its centroid is the
 * origin.
 *
 * radius, height, sides  as of a cylinder.
 * allocator, report  NULL, or as of all constructors.
 *
 * Cost: that of the hull.
 *
 * Errors: those of all constructors.
 */
PIR_API pir_status pir_body_shape_cone(double radius, double height, uint32_t sides, const pir_allocator *allocator,
                                       pir_report *report, pir_body_shape **ret_shape);

/**
 * The half-space of all x with normal · x ≤ offset, as far as `reach` from the foot of the origin: a box, for bodies
 * have bounds. Its top is exact where the normal is along an axis.
 *
 * normal         of any length but 0.
 * offset, reach  in units of length, also where the normal is no unit vector; reach > 0.
 * allocator, report  NULL, or as of all constructors.
 *
 * Cost: O(1).
 *
 * Errors: those of all constructors.
 */
PIR_API pir_status pir_body_shape_plane(pir_vec3 normal, double offset, double reach, const pir_allocator *allocator,
                                        pir_report *report, pir_body_shape **ret_shape);

/**
 * The hull of points, grown by a radius.
 *
 * points, count  at least one; copied.
 * radius         ≥ 0.
 * allocator, report  NULL, or as of all constructors.
 *
 * Cost: that of the hull.
 *
 * Errors: those of all constructors.
 */
PIR_API pir_status pir_body_shape_hull(const pir_vec3 *points, size_t count, double radius,
                                       const pir_allocator *allocator, pir_report *report, pir_body_shape **ret_shape);

/** A shape in a compound, and where it is. */
typedef struct pir_body_part {
    const pir_body_shape *shape; /**< of pieces; of one radius with all others */
    pir_pose pose;
} pir_body_part;

/**
 * Shapes put together: their pieces, each moved exactly.
 *
 * parts, count  at least one; together at most 4096 pieces.
 * allocator, report  NULL, or as of all constructors.
 *
 * Cost: that of the hulls of their pieces.
 *
 * Errors: those of all constructors; PIR_ERR_ARGUMENT where radii differ, or a part has a surface;
 * PIR_ERR_ZERO_QUATERNION.
 */
PIR_API pir_status pir_body_shape_compound(const pir_body_part *parts, size_t count, const pir_allocator *allocator,
                                           pir_report *report, pir_body_shape **ret_shape);

/**
 * A mesh, for bodies that are static or kinematic.
 *
 * mesh    referenced.
 * radius  ≥ 0.
 * allocator, report  NULL, or as of all constructors.
 *
 * Cost: O(1).
 *
 * Errors: those of all constructors.
 */
PIR_API pir_status pir_body_shape_mesh(pir_trimesh *mesh, double radius, const pir_allocator *allocator,
                                       pir_report *report, pir_body_shape **ret_shape);

/**
 * A height field, for bodies that are static or kinematic.
 *
 * field   referenced.
 * radius  ≥ 0.
 * allocator, report  NULL, or as of all constructors.
 *
 * Cost: O(1).
 *
 * Errors: those of all constructors.
 */
PIR_API pir_status pir_body_shape_field(pir_height_field *field, double radius, const pir_allocator *allocator,
                                        pir_report *report, pir_body_shape **ret_shape);

/** One more reference; returns the shape. NULL is accepted. O(1). */
PIR_API pir_body_shape *pir_body_shape_retain(pir_body_shape *shape);

/** Gives a reference back; the last one frees. NULL is accepted. Cost: the time to free it. */
PIR_API void pir_body_shape_release(pir_body_shape *shape);

/** The options of a body of that shape: those of pir_body_options_default, static where it has a surface. O(1). */
PIR_API pir_body_options pir_body_shape_options(const pir_body_shape *shape);

/**
 * The mass of a shape of density 1, its radius counted; of a compound that of its parts, where what two share counts
 * twice. It is worked out when the shape is made.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT (a surface, which has none).
 */
PIR_API pir_status pir_body_shape_mass(const pir_body_shape *shape, pir_mass *ret_mass);

/** One line that says what the shape is, as long as the shape is there. O(1). */
PIR_API const char *pir_body_shape_text(const pir_body_shape *shape);

/**
 * One line on a body of a scene: its id, kind, pieces, radius, place and what is set of it.
 *
 * body        the id of a body of the scene.
 * size, text  room for the line and its end; it is cut to fit. 256 bytes are always enough.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_scene_body_text(const pir_scene *scene, uint32_t body, size_t size, char *text);

#ifdef __cplusplus
}
#endif

#endif
