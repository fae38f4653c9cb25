/* SPDX-License-Identifier: MIT */
/**
 * A convex polytope against surfaces of triangles: state, signed distance, and contacts without ghosts.
 *
 * P meets the union S of triangles T exactly where its translation lies in the union U of the sets D = T ⊕ −P. A
 * contact pushes P along a normal n. It is true where n is a normal of U at a point y of U's boundary: some ball that
 * touches y from the side of n holds no inner point of U. Otherwise it is a ghost: some other D holds what lies
 * there, and no motion of P off the surfaces needs that push. Inner edges of a floor make such ghosts, and so do the
 * walls between prisms that stand side by side.
 *
 * Theorem. n is a normal of U at y exactly when it separates P, moved to y, from every triangle that P meets there.
 * (All D are convex and closed, and there are finitely many. If n separates, each D that holds y is in the half-space
 * behind y, and the others have a distance from y, so a small ball is free. If n does not separate P from a T that it
 * meets, D holds y and a point z with n · (z − y) > 0. The segment between them is in D and enters every such ball.)
 *
 * This names the triangles that matter by what P meets, not by shared vertices. So T-junctions, duplicated triangles,
 * surfaces that overlap and seams between bodies are one case. It is decided by exact signs; nothing is welded, and no
 * tolerance decides.
 *
 * A body of several convex pieces is asked piece by piece, each with the others beside it. Where P, moved to y, touches
 * at a point x that another piece holds, and that piece has a vertex on the other side of the plane through x across n,
 * x is at a wall between pieces, or at its rim, and the contact is a ghost. Decided by exact signs, for pieces of
 * dimension 3. What another piece meets elsewhere hides no contact of P. Pieces with a radius count without it here.
 *
 * One-sided triangles push to their front. A triangle that has P wholly behind it, or in its plane, does not count.
 * With a radius it counts all the same where the ball comes to it from behind, which is where P without the radius is
 * nearer to it than that.
 *
 * Where P is apart from all triangles, y is where P comes to when it moves along −n by the gap: for each triangle the
 * contact is that of its nearest points. Where P meets another triangle on that way, y may also be a place beside,
 * within the margin, on the same facet of D. Where P overlaps, it is moved first: by `way_out`, to a place where it
 * meets no triangle, and contacts are those seen from there. Their distances are those at the pose that was given.
 *
 * A radius grows P by a ball. Contacts are then those of P grown by half of it, or by half of what P would touch with
 * where that is less: so both sides of a valley are felt before a ball of the whole radius comes to both, and distances
 * are those of the whole. Where P without its radius overlaps, or is at the back of the one-sided triangle that is
 * nearest, it is moved out first, to the front, and the depth is the radius more.
 *
 * P may be stuck: between walls that are nearer to each other than it is wide no way out is found. `is_out` tells, and
 * way_out is 0. Contacts then push both ways, so that a solver brings P to where both depths are equal. Where P without
 * its radius is apart from the walls, they are those of the theorem. Where it is not, each triangle that P meets pushes
 * across its own plane: a one-sided one to its front, another one to the nearer side. Ghosts are not told there.
 *
 * Exact for the doubles given: the state of a polytope without a radius, and which contacts are ghosts. With a radius
 * both follow from distances that are within 2^-40 of the size of the coordinates. Distances, points and normals are
 * doubles.
 *
 * Frame: the world. Normals point from the surface to P. Unit: that of the coordinates, which are at most 2^60.
 *
 * Threads: a workspace belongs to one thread at a time; polytopes and surfaces may be shared. Once the workspace has
 * grown to what was needed, no call allocates.
 *
 * Errors of a call: PIR_ERR_ARGUMENT (NULL, also among `beside`, no surface, a radius, margin or cutoff below 0, a
 * radius or margin that is infinite), PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, PIR_ERR_LIMIT (a coordinate beyond
 * 2^60, more than 2^16 triangles near P), PIR_ERR_MEMORY.
 */
#ifndef PIROUETTE_TRIMESH_CONTACT_H
#define PIROUETTE_TRIMESH_CONTACT_H

#include <stdbool.h>

#include <pirouette/polytope.h>
#include <pirouette/pose.h>
#include <pirouette/query.h>
#include <pirouette/trimesh.h>
#include <pirouette/workspace.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A surface where it stands. */
typedef struct pir_posed_surface {
    pir_surface_ref surface;
    pir_pose pose;
} pir_posed_surface;

typedef struct pir_surface_contact_input {
    pir_pose pose;                     /**< of P */
    double radius;                     /**< P grows by a ball of it: a point becomes a ball, a segment a capsule */
    double margin;                     /**< contacts up to this distance apart are given too */
    const pir_posed_surface *surfaces; /**< borrowed for the call; all are one union */
    size_t surface_count;
    /** The convex pieces of the body that P is one of, in P's frame, or NULL; borrowed, P may be among them. A contact
        at a wall between pieces is a ghost. */
    const pir_polytope *const *beside;
    size_t beside_count;
} pir_surface_contact_input;

/** At the origin, not turned; no radius, no margin, no surfaces, nothing beside. O(1). */
PIR_API pir_surface_contact_input pir_surface_contact_input_default(void);

/**
 * A contact: a point of P over a point of a triangle along the normal. Where P overlaps, point_q is on the triangle, or
 * in its plane where P is stuck, and point_p is off P by the part of way_out across the normal.
 */
typedef struct pir_surface_contact {
    pir_vec3 point_p, point_q; /**< point_p = point_q + distance · normal */
    pir_vec3 normal;           /**< unit, from the surface to P */
    double distance;           /**< along the normal; negative where P overlaps */
    uint32_t surface;          /**< the number of the surface in the input */
    uint32_t triangle, material;
    uint64_t id; /**< of the features of P and of the surface that meet here, and of the normal: unlike all others of a
                      call, and the same from call to call while these meet */
} pir_surface_contact;

/** The work of a call. */
typedef struct pir_surface_contact_counts {
    uint32_t triangles; /**< whose boxes are near P */
    uint32_t near;      /**< within the margin, or met */
    uint32_t ghosts; /**< whose contact was found to be none of the union: of each normal the nearest are looked at */
    uint32_t exact;  /**< decisions that doubles left open */
} pir_surface_contact_counts;

/**
 * How P stands to the union of the surfaces. The distance, the normal and the points belong together, and say where P
 * is by one contact:
 *
 * - Outside: of the nearest triangle that counts, ghost or not. With a radius the distance is that of P without it less
 *   the radius.
 * - Boundary: of a triangle that P touches.
 * - Inside, with a way out: P moved by −distance · normal has point_p at point_q and touches the triangle there, but
 *   for a step less than way_out, and overlaps nothing. Where the way out is that through one facet, the normal is the
 *   facet's. Where the way ends behind a one-sided triangle, there may be none that is touched: then point_q is where
 *   point_p comes to, or all is of the deepest contact.
 * - Inside, with none: of the deepest contact.
 *
 * point_p is on P with its radius where there is a way out.
 */
typedef struct pir_surface_contact_result {
    pir_state state; /**< PIR_OUTSIDE, PIR_BOUNDARY where P meets triangles but can leave all by any small motion one
                            way of each, PIR_INSIDE where it overlaps some */
    double distance; /**< above 0 outside, HUGE_VAL beyond the margin; 0 on the boundary; at most 0 inside */
    pir_vec3 normal; /**< unit, from the surface to P; 0 where there is none within the margin */
    pir_vec3 point_p, point_q;  /**< point_p = point_q + distance · normal */
    uint32_t surface, triangle; /**< where point_q is; PIR_TRIANGLE_NONE where none is within the margin, and where a
                                     ball leaves one-sided triangles by a way that no contact is on */
    pir_vec3 way_out; /**< a translation after which P, with its radius, meets no triangle; 0 where it meets none, and
                           where none was found */
    bool is_out; /**< whether P meets no triangle there, without a radius exactly; false where none was found nearby */
    bool is_shortest; /**< whether no way is shorter that leaves through one facet of one D that P's place is in, and
                            meets nothing a step farther on: 2^-12 of P's size, or 2^-28 where another triangle is
                            that near. way_out has that step, distance has not, and is
                            that way's but for roundings */
    size_t contacts;  /**< how many were written */
    pir_surface_contact_counts counts;
} pir_surface_contact_result;

/**
 * Contacts of P with the union of surfaces, the deepest first, whatever their normals. Those of one normal hold the
 * greatest area by at most four points.
 *
 * Each normal is that of a true contact of the theorem above; at most 64 normals are told, those of the nearest. The
 * contacts of a normal are the corners of what lies under the part of P that faces the surface there, of all triangles
 * whose distance along the normal is within the margin: more points, but no other normals. The nearest contact of each
 * normal is one of them, or one as deep is, within 2^-40 of the size of what is near.
 *
 * p                       any dimension.
 * workspace               scratch.
 * input                   poses, radius, margin and surfaces.
 * most, ret_contacts      at most how many, and room for them; the deepest are kept.
 * ret_result              state, distance, the number of contacts.
 *
 * Cost: O(log n + k · (v + log k)) for k triangles near P and v vertices, and O(k) for each contact that is looked at
 * and that the triangle that hid the one before does not hide.
 * Errors: those of a call.
 */
PIR_API pir_status pir_surface_contacts(const pir_polytope *p, pir_workspace *workspace,
                                        const pir_surface_contact_input *input, size_t most,
                                        pir_surface_contact *ret_contacts, pir_surface_contact_result *ret_result);

#ifdef __cplusplus
}
#endif

#endif
