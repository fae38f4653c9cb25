/* SPDX-License-Identifier: MIT */
/**
 * Exact coordinates in and out, as GMP rationals. The one public header that shows GMP; pirouette.h does not include
 * it.
 *
 * GMP's own allocation functions serve the mpq_t and mpz_t arguments; GMP ends the process when they run out of memory.
 */
#ifndef PIROUETTE_EXACT_H
#define PIROUETTE_EXACT_H

#include <gmp.h>

#include <pirouette/base.h>
#include <pirouette/cgm.h>
#include <pirouette/clash.h>
#include <pirouette/critical.h>
#include <pirouette/events.h>
#include <pirouette/impact.h>
#include <pirouette/mesh.h>
#include <pirouette/plan.h>
#include <pirouette/polytope.h>
#include <pirouette/section.h>
#include <pirouette/solid.h>
#include <pirouette/sum.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * The exact convex hull of `count` rational points: x, y, z of point i in coordinates[3i..3i+2], canonical; copied.
 * Otherwise as pir_polytope_create. PIR_ERR_LIMIT also when the least common denominator takes more than 65536 bits, or
 * a coordinate over it more than 131072.
 *
 * options  NULL for the defaults, as of pir_polytope_create.
 *
 * Cost: as of pir_polytope_create, with arithmetic on numbers as long as the rationals.
 *
 * Errors as of pir_polytope_create, and PIR_ERR_LIMIT as above.
 */
PIR_API pir_status pir_polytope_create_exact(const mpq_t *coordinates, size_t count,
                                             const pir_polytope_options *options, pir_polytope **ret_polytope);

/**
 * As pir_polytope_scale, by a rational; PIR_ERR_LIMIT also when the scale then takes more than 65536 bits.
 *
 * factor  above 0, canonical; copied.
 *
 * Cost: O(n) for n vertices.
 *
 * Errors as of pir_polytope_scale, and PIR_ERR_LIMIT as above.
 */
PIR_API pir_status pir_polytope_scale_exact(const pir_polytope *polytope, const mpq_t factor,
                                            pir_polytope **ret_polytope);

/**
 * As pir_sum_set_scale, to a rational.
 *
 * operand, scale  which operand, and how large, as of pir_sum_set_scale; the rational is canonical and copied.
 *
 * Cost: O(n) for the operand's n vertices.
 *
 * Errors as of pir_sum_set_scale.
 */
PIR_API pir_status pir_sum_set_scale_exact(pir_sum *sum, pir_operand operand, const mpq_t scale);

/**
 * Volume, centroid and inertia as pir_polytope_mass has them, exactly, into initialised rationals.
 *
 * ret_volume    one rational.
 * ret_centroid  three: x, y, z.
 * ret_inertia   six, about the centroid: xx, yy, zz, yz, xz, xy.
 *
 * Cost: O(n), in exact arithmetic.
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_polytope_mass_exact(const pir_polytope *polytope, mpq_t ret_volume, mpq_t *ret_centroid,
                                           mpq_t *ret_inertia);

/**
 * The exact volume of a solid, into an initialised rational.
 *
 * solid  any.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_solid_volume_exact(const pir_solid *solid, mpq_t ret_volume);

/**
 * The exact volumes of what pieces add to a solid, the union of the pieces without the solid, and of what they lose of
 * it, the solid without that union, into initialised rationals. Pieces may overlap; those without an inside have no
 * volume.
 *
 * pieces              `count` of them, in the frame of the solid.
 * options             NULL for the defaults.
 * ret_added, ret_lost one rational each.
 *
 * Cost: for k pieces and m convex pieces of the solid, of bounded size each, O(k · (k + m)) cuts of convex pieces, and
 * more where many overlap.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_VERSION, PIR_ERR_LIMIT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_solid_certify_exact(const pir_solid *solid, pir_polytope *const *pieces, size_t count,
                                           const pir_solid_options *options, mpq_t ret_added, mpq_t ret_lost);

/**
 * The exact volume that two bodies share (clash.h), into an initialised rational.
 *
 * a, b  both may be the same.
 *
 * Cost: that of pir_clash.
 *
 * Errors: those of pir_clash.
 */
PIR_API pir_status pir_clash_volume_exact(const pir_clash_body *a, const pir_clash_body *b, mpq_t ret_volume);

/** The exact coordinates of a vertex, into three initialised rationals. O(1). */
PIR_API void pir_polytope_vertex_exact(const pir_polytope *polytope, uint32_t vertex, mpq_t ret_coordinates[3]);

/**
 * The exact coordinates of a mesh's vertex; PIR_ERR_ARGUMENT when it does not.
 *
 * vertex  a number below pir_mesh_vertex_count.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_mesh_vertex_exact(const pir_mesh *mesh, uint32_t vertex, mpq_t ret_coordinates[3]);

/**
 * The exact coordinates of a point of a path (plan.h), into three initialised rationals.
 *
 * index  below the count of points.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_path_plan_waypoint_exact(const pir_path_plan *plan, uint32_t index, mpq_t ret_coordinates[3]);

/**
 * The exact coordinates of a corner of a section, into three initialised rationals; PIR_ERR_ARGUMENT when the mesh
 * holds no exact coordinates.
 *
 * mesh    the one that the section was cut from.
 * corner  a number below pir_section_corner_count.
 *
 * Cost: O(1), in exact arithmetic.
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_section_corner_exact(const pir_section *section, const pir_mesh *mesh, uint32_t corner,
                                            mpq_t ret_coordinates[3]);

/**
 * The support plane of a map's polytope or sum in the direction of a vertex: a normal (a, b, c) of integers and the
 * offset d of a·x + b·y + c·z = d, into four initialised rationals. PIR_ERR_ARGUMENT, PIR_ERR_MEMORY.
 *
 * Cost: O(1), in exact arithmetic.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_cgm_vertex_plane_exact(const pir_cgm *cgm, uint32_t vertex, mpq_t ret_plane[4]);

/**
 * The quadratic that the place among events is a root of: c[0]·κ² + c[1]·κ + c[2] = 0, into three initialised
 * integers without a common divisor, the first that is not zero positive. c[0] is zero where κ is rational and the
 * root of a linear one. PIR_ERR_ARGUMENT at the beginning of the turn.
 *
 * ret_coefficients  three.
 *
 * Cost: O(1), in exact arithmetic.
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_events_polynomial_exact(pir_events *events, mpz_t *ret_coefficients);

/**
 * The quadratic that an event of a map, or a contact of a place, is a root of, as of pir_events_polynomial_exact.
 *
 * event, contact    below the count.
 * ret_coefficients  three initialised integers.
 *
 * Cost: O(1), in exact arithmetic.
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_critical_map_polynomial_exact(const pir_critical_map *map, uint32_t event,
                                                     mpz_t *ret_coefficients);
PIR_API pir_status pir_critical_states_polynomial_exact(const pir_critical_states *states, uint32_t contact,
                                                        mpz_t *ret_coefficients);

/**
 * As pir_pair_impact (impact.h); on a hit after the start also the quadratic that the κ of the contact is a root of,
 * as of pir_events_polynomial_exact: that at which it turns while κ falls, of the one or two. Of a screw it is a
 * cubic, c0·κ³ + c1·κ² + c2·κ + c3. Else, zeros.
 *
 * pair, workspace, input, motion  as of pir_pair_impact.
 * ret_impact                      likewise.
 * ret_coefficients                three initialised integers, of a screw four.
 *
 * Cost: as of pir_pair_impact, in exact arithmetic at the end.
 *
 * Errors: those of pir_pair_impact.
 */
PIR_API pir_status pir_pair_impact_exact(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                         const pir_exact_motion *motion, pir_exact_impact *ret_impact,
                                         mpz_t *ret_coefficients);

#ifdef __cplusplus
}
#endif

#endif
