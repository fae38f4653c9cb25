/* SPDX-License-Identifier: MIT */
/**
 * Solids: polyhedral bodies that need not be convex, their division into convex pieces, and the exact sum of two.
 *
 * A solid is bounded by one or more closed surfaces, its shells: facets are planar polygons, counter-clockwise from
 * outside. One with holes is a single loop: a slit, walked both ways, joins each hole to what is round it. A shell
 * inside another that faces inwards is the boundary of a cavity. Whatever is not such a boundary is refused with the
 * place named, and never repaired. Everything is decided exactly.
 *
 * A solid is immutable and counts its references; threads may read one together.
 */
#ifndef PIROUETTE_SOLID_H
#define PIROUETTE_SOLID_H

#include <pirouette/base.h>
#include <pirouette/io.h>
#include <pirouette/mesh.h>
#include <pirouette/polytope.h>
#include <pirouette/sum.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_solid pir_solid;
typedef struct pir_pieces pir_pieces;

/** How solids are made and computed with. */
typedef struct pir_solid_options {
    size_t size;                    /**< of this struct, which pir_solid_options_default sets (base.h) */
    const pir_allocator *allocator; /**< NULL for malloc's; copied; it outlives what is made */
    size_t
        memory; /**< the most bytes that one call may hold beside its result and its solids, GMP's numbers included */
    /**
     * NULL, or filled when a call that has no report of its own ends with PIR_ERR_LIMIT, PIR_ERR_MEMORY or
     * PIR_ERR_INTERNAL, or refuses the options' size: it names the limit and its value, and how far the job was.
     */
    pir_report *report;
} pir_solid_options;

/** malloc's allocator, 4 GiB, or all that a size_t can tell, no report. O(1). */
static inline pir_solid_options pir_solid_options_default(void) {
    const uint64_t memory = (uint64_t)1 << 32;
    const pir_solid_options options = {sizeof(pir_solid_options), NULL, memory < SIZE_MAX ? (size_t)memory : SIZE_MAX,
                                       NULL};
    return options;
}

/** The description of a solid. Lengths in units of the model. */
typedef struct pir_solid_info {
    uint32_t vertices, edges, facets; /**< as given; points at one place are one vertex */
    /** The counts once coplanar neighbours are one facet and straight corners are gone. */
    uint32_t merged_vertices, merged_edges, merged_facets;
    uint32_t reflex_edges; /**< those with more than 180 degrees inside, straight corners gone */
    uint32_t shells;
    int64_t genus;      /**< of all shells together */
    double volume;      /**< nearest to the exact one */
    pir_vec3 low, high; /**< bounds */
} pir_solid_info;

/**
 * Reads the solid in `path`, by its ending (PIR_READ_FORMATS).
 *
 * options  NULL for the defaults.
 * report   NULL, or filled when the call fails: it names the facet by its line, or the edge by its ends.
 *
 * Points at the same place are one vertex. Every edge must be on two facets, which walk it opposite ways, or on an
 * even number, between which inside and outside take turns around it; facets must be planar exactly as the file's
 * numbers are, with an area; none may cross another or share an area with it, though they may touch; outer shells face
 * outwards, cavities inwards.
 *
 * Cost: O(n log n) for n facets of bounded size whose boxes meet few others; exact arithmetic where doubles cannot
 * tell.
 *
 * Errors: those of reading (pir_polytope_read); PIR_ERR_NOT_CLOSED for an edge that is not on such facets;
 * PIR_ERR_FORMAT for facets that are not planar, have no area, cross or overlap, for shells that are inside out or
 * hold no volume; PIR_ERR_EMPTY without facets; PIR_ERR_LIMIT, PIR_ERR_MEMORY.
 *
 * ret_solid  the caller owns one reference.
 */
PIR_API pir_status pir_solid_read(const char *path, const pir_solid_options *options, pir_report *report,
                                  pir_solid **ret_solid);

/**
 * A solid of a file in memory.
 *
 * file                        the bytes, and their format.
 * options, report, ret_solid  as of pir_solid_read.
 *
 * Cost: as of pir_solid_read.
 *
 * Errors as of pir_solid_read, without PIR_ERR_FILE.
 */
PIR_API pir_status pir_solid_read_bytes(const pir_file_bytes *file, const pir_solid_options *options,
                                        pir_report *report, pir_solid **ret_solid);

/** Facets in memory: facet f has the corners from corners[starts[f]] up to corners[starts[f + 1]], numbers of points.
    */
typedef struct pir_solid_facets {
    const pir_vec3 *points; /**< borrowed, as are the others */
    size_t point_count;
    const uint32_t *starts; /**< facet_count + 1 */
    const uint32_t *corners;
    size_t facet_count;
} pir_solid_facets;

/**
 * A solid of facets in memory.
 *
 * facets                      everything is copied.
 * options, report, ret_solid  as of pir_solid_read; facets are told by their numbers.
 *
 * Cost: as of pir_solid_read.
 *
 * Errors as of pir_solid_read, PIR_ERR_NOT_FINITE, PIR_ERR_ARGUMENT for corners that are no points, and PIR_ERR_LIMIT
 * for counts of 2^30 or more, before anything is read.
 */
PIR_API pir_status pir_solid_create(const pir_solid_facets *facets, const pir_solid_options *options,
                                    pir_report *report, pir_solid **ret_solid);

/**
 * The solid that a polytope is.
 *
 * polytope            with an inside: one of dimension 3.
 * options, ret_solid  as of pir_solid_read.
 *
 * Cost: as of pir_solid_read.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_EMPTY for a flat polytope, PIR_ERR_LIMIT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_solid_from_polytope(const pir_polytope *polytope, const pir_solid_options *options,
                                           pir_solid **ret_solid);

/** Another reference to `solid`, which is returned. O(1). */
PIR_API pir_solid *pir_solid_retain(pir_solid *solid);

/** Gives back a reference; NULL is accepted. O(1), and for the last reference the time to free it. */
PIR_API void pir_solid_release(pir_solid *solid);

/** The description of `solid`. O(1). */
PIR_API void pir_solid_describe(const pir_solid *solid, pir_solid_info *ret_info);

/** By which planes a solid is cut. */
typedef enum pir_decompose_method {
    PIR_DECOMPOSE_BEST,   /**< both ways; what gives fewer pieces counts, by facets where they give as many */
    PIR_DECOMPOSE_FACETS, /**< planes of facets: pieces have no planes but the solid's */
    PIR_DECOMPOSE_WALLS   /**< sight walls of reflex edges, then walls beyond vertical ones (Hachenberger 2008) */
} pir_decompose_method;

/** How a solid is divided. */
typedef struct pir_decompose_options {
    size_t size;                    /**< of this struct, which pir_decompose_options_default sets (base.h) */
    const pir_allocator *allocator; /**< this and the next two as of pir_solid_options */
    size_t memory;
    pir_report *report;
    pir_decompose_method method;
    uint32_t pieces;  /**< the most that there may be; 0 for no bound */
    double tolerance; /**< pieces may reach this far out of the solid where that makes them fewer, a length; 0: not */
} pir_decompose_options;

/** As pir_solid_options_default has it, PIR_DECOMPOSE_BEST, exact. O(1). */
static inline pir_decompose_options pir_decompose_options_default(void) {
    const pir_decompose_options options = {
        sizeof(pir_decompose_options), NULL, pir_solid_options_default().memory, NULL, PIR_DECOMPOSE_BEST, 0, 0};
    return options;
}

/** The outcome of a decomposition. */
typedef struct pir_decompose_info {
    pir_decompose_method method; /**< the one that counted: not PIR_DECOMPOSE_BEST */
    uint32_t exact_pieces;       /**< before any were joined by a hull */
    double error; /**< no point of a piece is farther than this from the solid, rounded up; 0: the pieces are it */
} pir_decompose_info;

/**
 * Divides a solid into convex pieces whose union contains it. By default their insides are disjoint and their union is
 * the solid: space is cut until the solid is convex in every cell, then pieces are joined while the union of two is
 * convex. With a tolerance, or a number of pieces, there are fewer, which may overlap and reach out of the solid: two
 * pieces at a time are replaced by their convex hull, those first whose hull reaches out least.
 *
 * options     NULL for the defaults. Pieces are joined while none reaches farther out than `tolerance`, and however
 * far
 *             that is while there are more than `pieces`.
 * ret_info    NULL, or what was done. Its error bounds the Hausdorff distance between the union of the pieces and the
 *             solid. It is proven pair by pair, so it may be larger than need be.
 * ret_pieces  to be freed with pir_pieces_destroy.
 *
 * Cost: for r reflex edges and n facets O(r²) pieces and O(r·n) fragments in most models, for each of two methods.
 * For fewer than the m exact pieces O(m) hulls and O(m · k) bounds, k pieces being near another.
 *
 * Errors: PIR_ERR_ARGUMENT (no method, a tolerance below 0), PIR_ERR_NOT_FINITE, PIR_ERR_LIMIT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_solid_decompose(const pir_solid *solid, const pir_decompose_options *options,
                                       pir_decompose_info *ret_info, pir_pieces **ret_pieces);

/** Frees; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_pieces_destroy(pir_pieces *pieces);

/** How many pieces there are. O(1). */
PIR_API uint32_t pir_pieces_count(const pir_pieces *pieces);

/**
 * Piece `index` as a polytope, exactly.
 *
 * Cost: a hull of its vertices, whose exact coordinates have one common denominator then.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_LIMIT (numbers too long), PIR_ERR_MEMORY.
 *
 * ret_polytope  the caller owns one reference.
 */
PIR_API pir_status pir_pieces_polytope(const pir_pieces *pieces, uint32_t index, pir_polytope **ret_polytope);

/** How a sum of solids is made. */
typedef struct pir_solid_sum_options {
    size_t size;                    /**< of this struct, which pir_solid_sum_options_default sets (base.h) */
    const pir_allocator *allocator; /**< this and the next two as of pir_solid_options */
    size_t memory;
    pir_report *report;
    bool difference; /**< true: Q ⊕ (−R·P), what P may be moved by to meet Q; false: R·P ⊕ Q */
    bool open;       /**< whether P and Q are without their boundaries; what they leave out within is in the mesh */
} pir_solid_sum_options;

/** As pir_solid_options_default has it, no difference, closed. O(1). */
static inline pir_solid_sum_options pir_solid_sum_options_default(void) {
    const pir_solid_sum_options options = {
        sizeof(pir_solid_sum_options), NULL, pir_solid_options_default().memory, NULL, false, false};
    return options;
}

/** The description of a sum of solids, and the work that it took. */
typedef struct pir_solid_sum_info {
    uint32_t vertices, edges, facets; /**< with maximal facets */
    uint32_t holes;                   /**< of facets */
    uint32_t two_sided;               /**< facets among these that have the sum on both sides: of open solids */
    uint32_t segments, points;        /**< on their own, which no facet has: of open solids */
    uint32_t pieces_p, pieces_q;      /**< convex pieces */
    uint64_t candidates;              /**< facets that features of P and Q make where they support each other locally */
    uint64_t survivors;               /**< those of which something bounds the sum */
    uint64_t clipped;                 /**< planes of candidates that the last rotation clipped: all, of a rebuild */
} pir_solid_sum_info;

typedef struct pir_solid_sum pir_solid_sum;

/** How a sum of solids is brought to a rotation. All give the same sum, bit for bit. */
typedef enum pir_solid_method {
    PIR_SOLID_AUTO =
        0,             /**< an update where the turn is small and updates have found little to change, else a rebuild */
    PIR_SOLID_UPDATE,  /**< keep what bounds the sum, plane by plane, and make anew only where a choice has changed */
    PIR_SOLID_REBUILD, /**< make all from the pieces */
} pir_solid_method;

/**
 * Makes the exact sum of P, turned, and Q as the bodies they are, boundaries included. Release it with
 * pir_solid_sum_destroy. Both are divided into convex pieces once; pir_solid_sum_rotate brings the sum to other
 * rotations.
 *
 * p, q      the sum takes a reference to each.
 * rotation  of P, of any non-zero length: it stands for the exact rotation.
 * options   NULL for the defaults. Allocator and report, if there are any, outlive the sum: calls on it use them.
 * ret_sum   the caller's.
 *
 * A passage that Q fits through exactly is filled: the sum of closed bodies is closed. That of open ones
 * (`options->open`) leaves it out.
 *
 * A sum belongs to one thread at a time; different sums are independent, even of the same solids.
 *
 * Cost: pir_solid_decompose of each by facets; for p and q pieces with few facets each, O(p·q) to add their pairs,
 * and for c candidates O(c·k), where k pairs are near a candidate; O(n·m) to find the candidates of solids with n
 * and m edges.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, PIR_ERR_LIMIT (options->memory),
 * PIR_ERR_MEMORY; PIR_ERR_INTERNAL where the surface fails the last check, that it is closed.
 */
PIR_API pir_status pir_solid_sum_create(const pir_solid *p, const pir_solid *q, pir_quat rotation,
                                        const pir_solid_sum_options *options, pir_solid_sum **ret_sum);

/** Frees, and gives back the references to both solids; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_solid_sum_destroy(pir_solid_sum *sum);

/**
 * Brings the sum to `rotation`, any distance away from the last one. The pieces are kept. When the call fails the sum
 * stays at its previous rotation.
 *
 * An update keeps the sums of pairs of pieces and what is left of each candidate, and looks at what the turn may have
 * changed. Facets are glued together when the mesh or the description is asked for, so that a rotation that nobody
 * looks at costs less. Where a facet of one solid is parallel to an edge or facet of the other, exactly, and for sums
 * of open solids, an update is a rebuild.
 *
 * method  how; PIR_SOLID_AUTO needs no knowledge of the motion.
 *
 * Cost: of a rebuild, that of pir_solid_sum_create without the decompositions. Of an update by a five-thousandth of a
 * turn a sixth to two thirds of that before gluing, with gluing four fifths; of larger turns more than a rebuild
 * (docs/solids.md). The first one keeps what a rebuild makes, and takes up to twice as long. Memory: what is kept is
 * 11 to 90 KB a candidate, the more the more pairs of pieces are near. A motion that is gone again takes no more.
 *
 * Errors: PIR_ERR_ARGUMENT (no such method); else as of pir_solid_sum_create.
 */
PIR_API pir_status pir_solid_sum_rotate(pir_solid_sum *sum, pir_quat rotation, pir_solid_method method);

/**
 * Makes an operand `scale` times as large as it was when the sum was made, about its own origin. Scales do not
 * accumulate: each counts from the first size. The scale is taken exactly. When the call fails the sum stays as it
 * was.
 *
 * Cost: as of a rebuild by pir_solid_sum_rotate.
 *
 * Errors: PIR_ERR_NOT_FINITE, PIR_ERR_ARGUMENT (no operand, or a scale that is not positive); else as of
 * pir_solid_sum_rotate.
 */
PIR_API pir_status pir_solid_sum_set_scale(pir_solid_sum *sum, pir_operand operand, double scale);

/**
 * Makes a second sum of the same solids with the same options, at the same rotation and scales.
 *
 * ret_sum  the caller's.
 *
 * Cost: as of pir_solid_sum_create.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_LIMIT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_solid_sum_clone(const pir_solid_sum *sum, pir_solid_sum **ret_sum);

/** The rotation that the sum was brought to, as it was given. O(1). */
PIR_API pir_quat pir_solid_sum_rotation(const pir_solid_sum *sum);

/** A number that grows with every call that rotates or scales the sum. O(1). */
PIR_API uint64_t pir_solid_sum_generation(const pir_solid_sum *sum);

/**
 * The description of the sum.
 *
 * Cost: O(1); after an update, O(n log n) once for n edges, to glue facets together, which the mesh needs as well.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_LIMIT, PIR_ERR_MEMORY, PIR_ERR_INTERNAL (the surface is not closed).
 */
PIR_API pir_status pir_solid_sum_describe(pir_solid_sum *sum, pir_solid_sum_info *ret_info);

/**
 * The boundary of the sum.
 *
 * precision  PIR_DOUBLE, or PIR_EXACT for rationals beside the doubles, which are the nearest ones to them.
 * ret_mesh   to be freed with pir_mesh_destroy. Facets are maximal and need not be convex. One with holes is a single
 *            loop: a slit, walked both ways, joins each hole to what is round it. Vertices have no pairs, facets are of
 *            kind PIR_FACET_MERGED.
 *
 * The mesh of an open sum has two-sided facets, after those of the boundary, each twice in a row, once each way;
 * segments (pir_mesh_segments) and points (pir_mesh_points) that are on their own. Facets and segments are cut where
 * others begin or cross them; pir_solid_sum_describe counts a two-sided facet once.
 *
 * Two sums of the same solids with the same options have the same mesh, bit for bit, at the same rotation and scales,
 * whatever way they came there.
 *
 * Cost: O(size of the mesh), and that of pir_solid_sum_describe.
 *
 * Errors: PIR_ERR_ARGUMENT; else as of pir_solid_sum_describe.
 */
PIR_API pir_status pir_solid_sum_mesh(pir_solid_sum *sum, pir_precision precision, pir_mesh **ret_mesh);

#ifdef __cplusplus
}
#endif

#endif
