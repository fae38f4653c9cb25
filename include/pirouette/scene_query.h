/* SPDX-License-Identifier: MIT */
/**
 * Queries on a scene: what a shape overlaps, what is nearest, what a ray or a moving shape meets first.
 *
 * They see all bodies at their present poses, those added since the last update too, and change neither contacts nor
 * events. A shape is a polytope of any dimension with a pose and a rounding radius; it need not be one of a body.
 *
 * Rounding radii count in all of them. States, and whether a ray hits a body without a radius, are exact for the
 * doubles given, as in pair.h; distances are those of pair.h; times of moving shapes have a tolerance. Results do not
 * depend on the history of the scene; they are in the order of the numbers of bodies and pieces, or of distance or time
 * first.
 *
 * Sensors and disabled bodies are not seen. Two bodies meet as scene.h says; a shape or a ray meets bodies whose
 * category is in its mask.
 *
 * Threads: a query is a call on the scene, and belongs to its thread.
 *
 * Memory: a query may allocate from the scene's budget, where it is larger than all before. Until the next query the
 * scene may hold a reference to the shape.
 *
 * Cost: O(log n) to find the boxes in a scene of n pieces where these are apart, and a query of a pair for each piece
 * whose box meets what is asked.
 *
 * Errors of a query of a scene: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, PIR_ERR_LIMIT (a shape
 * beyond coordinates of 2^60, and as of a query of a pair), PIR_ERR_MEMORY.
 */
#ifndef PIROUETTE_SCENE_QUERY_H
#define PIROUETTE_SCENE_QUERY_H

#include <pirouette/base.h>
#include <pirouette/impact.h>
#include <pirouette/motion.h>
#include <pirouette/pose.h>
#include <pirouette/query.h>
#include <pirouette/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The bodies that a query leaves out, besides those that its mask does. */
typedef struct pir_query_filter {
    const uint32_t *ignored; /**< ids, borrowed for the call; NULL where there are none */
    size_t ignored_count;
    /** NULL, or whether a body counts; it may be called more than once for one, and must not call the scene. */
    bool (*counts)(void *context, uint32_t body, uint64_t user);
    void *context;
} pir_query_filter;

/** A shape in a place, to be asked about. */
typedef struct pir_scene_shape {
    pir_polytope *polytope;
    pir_pose pose;
    double radius;                  /**< its rounding radius, ≥ 0 */
    uint32_t mask;                  /**< the categories of bodies that it meets */
    uint32_t except;                /**< a body that it does not meet, or PIR_SCENE_NONE */
    pir_coarse *coarse;             /**< the coarse bodies of `polytope`, or NULL */
    const pir_query_filter *filter; /**< or NULL */
} pir_scene_shape;

/** `polytope` at the origin, not turned, with all in its mask. O(1). */
PIR_API pir_scene_shape pir_scene_shape_default(pir_polytope *polytope);

/** A piece of a body. */
typedef struct pir_scene_hit {
    uint32_t body, piece;
    pir_state state;
    uint64_t user, piece_user; /**< the caller's numbers; of a triangle its material */
} pir_scene_hit;

/**
 * All pieces that share a point with a shape, by the numbers of body and piece.
 *
 * shape               borrowed for the call.
 * capacity, ret_hits  room for how many, and that room.
 * ret_count           how many there are, also beyond the capacity.
 *
 * Cost: that of a query of a scene.
 *
 * Errors: those of a query of a scene.
 */
PIR_API pir_status pir_scene_overlap(pir_scene *scene, const pir_scene_shape *shape, size_t capacity,
                                     pir_scene_hit *ret_hits, size_t *ret_count);

/** A box with edges along the axes of the world, to be asked about. */
typedef struct pir_scene_box {
    pir_vec3 low, high;             /**< corners; infinite ones reach as far as any body */
    uint32_t mask;                  /**< the categories of bodies that it meets */
    uint32_t except;                /**< a body that it does not meet, or PIR_SCENE_NONE */
    const pir_query_filter *filter; /**< or NULL */
} pir_scene_box;

/** The box between the corners `low` and `high`, with all in its mask, no body left out, no filter. O(1). */
static inline pir_scene_box pir_scene_box_default(pir_vec3 low, pir_vec3 high) {
    const pir_scene_box box = {low, high, UINT32_MAX, PIR_SCENE_NONE, NULL};
    return box;
}

/** A piece of a body, or a triangle of its surface, of which nothing else is told. */
typedef struct pir_scene_part {
    uint32_t body, piece;
    uint64_t user, piece_user; /**< the caller's numbers; of a triangle its material */
} pir_scene_part;

/**
 * All pieces and triangles whose boxes meet a box, by the numbers of body and piece: the broad phase alone. Each that
 * shares a point with the box is told. Others are where their own box meets it: this is along the axes of the world, in
 * floats rounded outward, and holds the radius and half of the scene's margin.
 *
 * box                  borrowed for the call.
 * capacity, ret_parts  room for how many, and that room.
 * ret_count            how many there are, also beyond the capacity.
 *
 * Cost: O(log n) to find the boxes in a scene of n pieces, and O(capacity) for each that is told.
 *
 * Errors: PIR_ERR_ARGUMENT (a corner that is lower than the low one), PIR_ERR_NOT_FINITE (one that is no number),
 * PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_scene_in_box(pir_scene *scene, const pir_scene_box *box, size_t capacity,
                                    pir_scene_part *ret_parts, size_t *ret_count);

/** Two pieces that are near, or a shape, as P with body_p = PIR_SCENE_NONE, and a piece. */
typedef struct pir_scene_near {
    uint32_t body_p, body_q, piece_p, piece_q;
    pir_query_result result;             /**< as of pir_pair_signed_distance */
    uint64_t user_p, user_q;             /**< the caller's numbers; 0 of a shape */
    uint64_t piece_user_p, piece_user_q; /**< of a triangle its material */
} pir_scene_near;

/**
 * The pieces nearest to a shape, nearest first, where it overlaps them the deepest; of equal distances the lower
 * numbers first. At most `most`, and at most `cutoff` away.
 *
 * shape           borrowed for the call.
 * cutoff          a distance, HUGE_VAL for none: then all boxes are looked at.
 * most, ret_near  how many are asked for, at least 1, and room for them; *ret_count of them are found and filled.
 *
 * Cost: that of a query of a scene, and O(most) for each answer.
 *
 * Errors: those of a query of a scene.
 */
PIR_API pir_status pir_scene_nearest(pir_scene *scene, const pir_scene_shape *shape, double cutoff, size_t most,
                                     pir_scene_near *ret_near, size_t *ret_count);

/**
 * The closest pairs of pieces of different bodies that may meet, in the order of pir_scene_nearest, P of the
 * lower number.
 *
 * cutoff          a distance, finite or HUGE_VAL.
 * most, ret_near  how many are asked for, at least 1, and room for them; *ret_count of them are found and filled.
 *
 * Cost: that of a query of a scene for each piece, and O(most) for each answer.
 *
 * Errors: those of a query of a scene.
 */
PIR_API pir_status pir_scene_closest_pairs(pir_scene *scene, double cutoff, size_t most, pir_scene_near *ret_near,
                                           size_t *ret_count);

/** How accurate a distance has to be: within `length`, or within `part` of the distance, whichever is more. */
typedef struct pir_accuracy {
    double length, part; /**< ≥ 0 */
} pir_accuracy;

/** The way by which a distance was settled. */
typedef enum pir_settled {
    PIR_SETTLED_BY_BOXES = 0, /**< the boxes around both */
    PIR_SETTLED_BY_COARSE,    /**< coarse bodies, and balls in and around the bodies */
    PIR_SETTLED_EXACTLY,      /**< the bodies themselves */
} pir_settled;

/** A piece, and bounds on how far it is. */
typedef struct pir_scene_distance {
    uint32_t body, piece;
    pir_state state;    /**< exact, as of pir_pair_distance */
    double least, most; /**< the distance is between these; both 0 where a point is shared */
    pir_settled settled;
    uint64_t user, piece_user; /**< the caller's numbers; of a triangle its material */
} pir_scene_distance;

/**
 * How far a shape is from all pieces that are at most `cutoff` away, as accurately as is asked for. Of a pair that is
 * far apart only the boxes are looked at; where both have coarse bodies, then balls and a few vertices of these; where
 * that is not enough, the bodies. By the numbers of body and piece.
 *
 * The distance is always between `least` and `most`. These differ by at most the accuracy, with `part` taken of
 * `least`, and by what a distance in doubles may be off, 1e-11 of the sizes and coordinates at most. Which pieces are
 * told, and their states, do not depend on the accuracy.
 *
 * shape                    borrowed for the call.
 * cutoff                   a distance, finite or HUGE_VAL.
 * accuracy                 what is accurate enough.
 * capacity, ret_distances  room for how many, and that room.
 * ret_count                how many there are, also beyond the capacity.
 *
 * Cost: that of a query of a scene; O(1) for a piece that is settled without the bodies.
 *
 * Errors: those of a query of a scene.
 */
PIR_API pir_status pir_scene_distances(pir_scene *scene, const pir_scene_shape *shape, double cutoff,
                                       pir_accuracy accuracy, size_t capacity, pir_scene_distance *ret_distances,
                                       size_t *ret_count);

/**
 * The first hit of the segment from `origin` to `origin` + `way`. Bodies are as large as their rounding radii make
 * them.
 *
 * Without a radius, whether the segment shares a point with a piece is exact, and time and point are those of the first
 * point shared, within 2^-40 of the way: also on a flat piece, and where the segment lies in its plane. With a radius
 * r, a segment is told rightly where its distance from the polytope is not within 1e-12 of r, relative to sizes and
 * coordinates; time and point are those of the rounded body. Of pieces that are met at times that do not differ the one
 * of the lowest numbers is told.
 *
 * A triangle of a surface is met as a flat piece is, but a one-sided surface only from the front: a segment that goes
 * from behind, or lies in the plane, does not meet it. A surface with a radius is met from all sides.
 *
 * The normal is that of the surface where it is entered. Where the segment meets an edge of a flat piece within its
 * plane, it lies in the plane; where it meets a piece that is a segment or a point, it is against the way, and 0 for a
 * way of 0.
 *
 * origin, way  in the world; a way of 0 asks for what holds the origin, which a one-sided surface without a radius
 *              never does.
 * mask         the categories of bodies that it meets.
 *
 * Cost: that of a query of a scene, for the boxes that the segment meets: O(vertices) for each.
 *
 * Errors: those of a query of a scene.
 */
PIR_API pir_status pir_scene_ray(pir_scene *scene, pir_vec3 origin, pir_vec3 way, uint32_t mask,
                                 pir_impact *ret_impact);

/** The bodies and sides that rays meet. */
typedef struct pir_scene_ray_options {
    size_t size;         /**< of this struct, which pir_scene_ray_options_default sets (base.h) */
    uint32_t mask;       /**< the categories of bodies that it meets */
    uint32_t except;     /**< a body that it does not meet, or PIR_SCENE_NONE */
    pir_ray_sides sides; /**< from which side it meets triangles of surfaces that have no radius */
    double radius; /**< ≥ 0: of a ball that goes along the segment in place of a point; surfaces have no sides then */
    const pir_query_filter *filter; /**< or NULL */
} pir_scene_ray_options;

/** All in the mask, no body left out, triangles as their surfaces say, no radius, no filter. O(1). */
static inline pir_scene_ray_options pir_scene_ray_options_default(void) {
    const pir_scene_ray_options options = {
        sizeof(pir_scene_ray_options), UINT32_MAX, PIR_SCENE_NONE, PIR_RAY_AS_SURFACE, 0, NULL};
    return options;
}

/**
 * The first hit of the segment, or of a ball that goes along it: pir_scene_ray with options.
 *
 * A ball is asked about as a point is, of bodies that are grown by its radius, in closed form and without a tolerance:
 * the time is that at which its centre comes to the grown body, the point is where it touches.
 *
 * origin, way  as of pir_scene_ray.
 * options      or NULL for the defaults.
 *
 * Cost: as of pir_scene_ray; with a radius O(facets + edges) for each box that is met.
 *
 * Errors: those of a query of a scene; PIR_ERR_ARGUMENT also for a radius below 0 or infinite.
 */
PIR_API pir_status pir_scene_ray_first(pir_scene *scene, pir_vec3 origin, pir_vec3 way,
                                       const pir_scene_ray_options *options, pir_impact *ret_impact);

/** A segment from an origin along a way. */
typedef struct pir_scene_segment {
    pir_vec3 origin, way;
} pir_scene_segment;

/**
 * pir_scene_ray_first for many segments, with the options read once.
 *
 * segments, count  borrowed for the call; with 0 of them nothing is done.
 * options          or NULL for the defaults.
 * ret_impacts      room for `count`. Where the call fails none is written.
 *
 * Cost: that of each ray.
 *
 * Errors: those of the first that fails.
 */
PIR_API pir_status pir_scene_ray_batch(pir_scene *scene, const pir_scene_segment *segments, size_t count,
                                       const pir_scene_ray_options *options, pir_impact *ret_impacts);

/**
 * Whether the segment hits any piece or triangle at all; it stops at the first that is found.
 *
 * origin, way  as of pir_scene_ray.
 * options      or NULL for the defaults.
 *
 * Cost: at most that of pir_scene_ray.
 *
 * Errors: those of a query of a scene.
 */
PIR_API pir_status pir_scene_ray_any(pir_scene *scene, pir_vec3 origin, pir_vec3 way,
                                     const pir_scene_ray_options *options, bool *ret_hits);

/**
 * All pieces and triangles that the segment hits, each where it is entered, by time, of equal times by the numbers of
 * body and piece.
 *
 * pir_trimesh_triangle or pir_height_field_triangle, asked with `piece_q` of an impact, tells the material of the
 * triangle and its corners, which are counter-clockwise from the front, in the frame of the body. The normal of the
 * impact is against the way: a triangle without a radius is met from behind where it points away from the front.
 *
 * origin, way, options   as of pir_scene_ray_any.
 * capacity, ret_impacts  room for how many, and that room: for the first of them.
 * ret_count              how many there are, also beyond the capacity.
 *
 * Cost: that of a query of a scene, and O(capacity) for each hit.
 *
 * Errors: those of a query of a scene.
 */
PIR_API pir_status pir_scene_ray_all(pir_scene *scene, pir_vec3 origin, pir_vec3 way,
                                     const pir_scene_ray_options *options, size_t capacity, pir_impact *ret_impacts,
                                     size_t *ret_count);

/**
 * When a shape that moves first comes within `tolerance` of a piece, by conservative advancement (Mirtich, 1996):
 * before that time it shares no point with any. An advance that takes more than 512 steps for each full turn begun, or
 * 65,536, along something that is hardly farther than the tolerance, ends with PIR_CAST_STEP_LIMIT at the time that is
 * proven.
 *
 * Of pieces that are met at times that do not differ, that in which the shape begins deepest is told; it is told before
 * all that the shape only touches then. Else the one of the lowest numbers is told.
 *
 * A triangle of a surface is met as a flat piece is, from both sides: of a one-sided surface also from behind, though
 * it has no contacts there. A shape that is to come out of such a surface is cast with a mask, or `except`, that leaves
 * the surface out.
 *
 * shape      where it begins; borrowed for the call.
 * motion     over which it moves.
 * tolerance  > 0, a length; below 1e-10 of the size of bodies and coordinates it counts as that.
 *
 * Cost: that of a query of a scene for all that the way may meet, for each of them some queries of a pair, and, where
 * the shape turns, as often O(its vertices).
 *
 * Errors: those of a query of a scene; PIR_ERR_ARGUMENT also for a tolerance that is not above 0, and
 * for `held` below 0; PIR_ERR_NOT_FINITE for one that is no number.
 */
PIR_API pir_status pir_scene_cast(pir_scene *scene, const pir_scene_shape *shape, const pir_motion *motion,
                                  double tolerance, pir_impact *ret_impact);

/**
 * All pieces and triangles that a shape meets as it moves through the scene, each as if the others were not there: when
 * it first comes within `tolerance` of it. They are in the order in which pir_scene_cast prefers them, so the first is
 * what that tells: by time, those in which the shape begins by their depth, then by numbers.
 *
 * shape, motion, tolerance  as of pir_scene_cast.
 * capacity, ret_impacts     room for how many, and that room: for the first of them.
 * ret_count                 how many there are, also beyond the capacity.
 *
 * Cost: that of pir_scene_cast for a way on which nothing stops it, and O(capacity) for each hit.
 *
 * Errors: those of pir_scene_cast.
 */
PIR_API pir_status pir_scene_cast_all(pir_scene *scene, const pir_scene_shape *shape, const pir_motion *motion,
                                      double tolerance, size_t capacity, pir_impact *ret_impacts, size_t *ret_count);

/**
 * A cast of a body of the scene from its present pose on, with the bodies that it may meet, all others at rest: the
 * time of impact of a fast body. A surface that moves is asked about likewise, before the update that moves it: an
 * update sees the poses of its frame alone, and what a surface has passed by then, or holds whole, is not in contact
 * with any of its triangles.
 *
 * body               the id of a body that is no sensor.
 * motion, tolerance  as of pir_scene_cast.
 *
 * Cost: that of pir_scene_cast for each of its pieces.
 *
 * Errors: those of pir_scene_cast.
 */
PIR_API pir_status pir_scene_time_of_impact(pir_scene *scene, uint32_t body, const pir_motion *motion, double tolerance,
                                            pir_impact *ret_impact);

/**
 * When a body of the scene first touches another that it may meet, in a turn about an axis, as a door, on a way, or in
 * a screw, exactly: the first contact of all pairs of pieces, as pir_pair_impact tells it. All others are at rest.
 * Contacts of two pairs are compared as algebraic numbers; of equal ones that of the lowest number of the other body,
 * then of the lowest pieces, is told.
 *
 * PIR_CAST_START_INSIDE comes before all: a piece overlaps another at the start. Then comes PIR_CAST_HIT: at time 0
 * where pieces touch at the start and overlap just after it. Pieces that touch at the start and do not, as those of a
 * door on its floor, are passed over: no later contact of the same two is looked for. PIR_CAST_RECEDING is told where
 * there are such and nothing else is met.
 *
 * Triangles of surfaces are met as flat pieces, from both sides.
 *
 * body        the id of a body without a surface or a radius that is no sensor.
 * motion      its own, in the world.
 * ret_impact  body and pieces are set, and the caller's numbers.
 *
 * Cost: that of a query of a scene for all that may be in the way, and of pir_pair_impact for each of them; for each
 * tie O(1) of these again, in exact arithmetic.
 *
 * Errors: those of a query of a scene and of pir_pair_impact; PIR_ERR_ARGUMENT also where what may be in the way has a
 * radius, or is flat as the body's own piece is; PIR_ERR_LIMIT also for a way or a pivot beyond 2^60.
 */
PIR_API pir_status pir_scene_first_contact(pir_scene *scene, uint32_t body, const pir_exact_motion *motion,
                                           pir_exact_impact *ret_impact);

#ifdef __cplusplus
}
#endif

#endif
