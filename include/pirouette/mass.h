/* SPDX-License-Identifier: MIT */
/**
 * The mass of a polytope, and polytopes moved without loss.
 *
 * Volume, centroid and inertia are computed as rationals from the exact vertices, and rounded once to the nearest
 * doubles; exact.h gives the rationals. A moved polytope is the exact image: its coordinates are rationals, and all
 * features keep their numbers.
 *
 * Frame: that of the polytope. Unit: lengths as its coordinates, density 1: a body of density d has d times the mass
 * and d times the inertia.
 *
 * Ownership: a polytope that comes back belongs to the caller, who releases it; its memory comes from the allocator of
 * the polytope that it was made of. Rationals are GMP's memory.
 *
 * Threads: polytopes are read, never changed; any thread.
 */
#ifndef PIROUETTE_MASS_H
#define PIROUETTE_MASS_H

#include <pirouette/base.h>
#include <pirouette/polytope.h>
#include <pirouette/pose.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A body of density 1. */
typedef struct pir_mass {
    double volume;        /**< 0 where the body is flat */
    pir_vec3 centroid;    /**< of a flat body: of its area, its length, or its point */
    double inertia[3][3]; /**< about the centroid, symmetric; zeros where the body is flat */
} pir_mass;

/**
 * Volume, centroid and inertia, each the double nearest to the exact number (Mirtich, J. Graphics Tools 1(2), 1996,
 * here by tetrahedra over the facets).
 *
 * Cost: O(n), in exact arithmetic.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_LIMIT (a number beyond the largest double).
 */
PIR_API pir_status pir_polytope_mass(const pir_polytope *polytope, pir_mass *ret_mass);

/**
 * The mass of the polytope grown by a ball of a radius, as bodies with rounding radii are: of a segment that of a
 * capsule, of a point that of a ball. In doubles, within about 1e-13 of the sizes.
 *
 * radius  ≥ 0; with 0 it is pir_polytope_mass.
 *
 * Cost: O(n) besides that of pir_polytope_mass.
 *
 * Errors: PIR_ERR_ARGUMENT (a radius below 0 or infinite), PIR_ERR_NOT_FINITE (the radius), PIR_ERR_LIMIT (a number
 * beyond the largest double, or a volume below the least).
 */
PIR_API pir_status pir_polytope_rounded_mass(const pir_polytope *polytope, double radius, pir_mass *ret_mass);

/**
 * The mass of several bodies taken as one, in doubles: volumes are added, so where two of them overlap the shared part
 * counts twice. The centroid of bodies that are all flat is the mean of theirs.
 *
 * masses, count  at least one, all in one frame.
 *
 * Cost: O(count).
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE (a volume, centroid or inertia).
 */
PIR_API pir_status pir_mass_combine(const pir_mass *masses, size_t count, pir_mass *ret_mass);

/**
 * The polytope moved by `offset`, exactly.
 *
 * Cost: that of the exact hull of its n vertices, O(n log n).
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE (the offset), PIR_ERR_LIMIT (a coordinate beyond the largest double, or
 * longer than pir_polytope_create_exact takes), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_polytope_translate(const pir_polytope *polytope, pir_vec3 offset, pir_polytope **ret_polytope);

/**
 * The polytope in a pose, exactly: a vertex v becomes R·v + translation, where R is the exact rotation of the
 * quaternion.
 *
 * Cost: that of the exact hull of its n vertices, O(n log n).
 *
 * Errors: those of pir_polytope_translate, and PIR_ERR_ZERO_QUATERNION.
 */
PIR_API pir_status pir_polytope_transform(const pir_polytope *polytope, pir_pose pose, pir_polytope **ret_polytope);

/**
 * The polytope moved so that its centroid is at the origin within the rounding of one double, as *ret_polytope, and by
 * how much: exactly, the polytope is the result moved by *ret_offset.
 *
 * Cost: as of pir_polytope_translate.
 *
 * Errors: those of pir_polytope_translate and pir_polytope_mass.
 */
PIR_API pir_status pir_polytope_recentre(const pir_polytope *polytope, pir_polytope **ret_polytope,
                                         pir_vec3 *ret_offset);

#ifdef __cplusplus
}
#endif

#endif
