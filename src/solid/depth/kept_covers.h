/* SPDX-License-Identifier: MIT */
/*
 * Where facets are known to be covered, kept from pose to pose.
 *
 * As Q sees it, B stands, A' turns, and the place t of P moves. `turned` bounds by which part of its length any vector
 * of P has changed in all since the clock began, `way` how far any point of A' has moved relative to t. A cover (until,
 * reach) of a facet, that is of the points that its features make, says:
 *
 *     while turned < until, all of it that is nearer to t than reach − way is inside of other sums.
 *
 * Proof. At some pose all of it nearer than D is inside of sums, deeper than m + τ·d where d is the farthest that a
 * point of the facet's piece of P can be from one of the sum's (covers.h). until = turned + τ, reach = way + D.
 * Later, y = a' + b is a point of the facet and x = a + b the point of the same features then, in the sum of A_c and
 * B_c. As seen from a' − a no point of A_c has moved by more than τ·d, so that sum shrank by less than m + τ·d
 * about x, and y is inside. And x was no farther from t than y is, and the way since.
 *
 * A cover of a pair says it of the whole boundary of its sum, whatever facets that has by then. Seen from the middle of
 * its piece of P the sum has changed by no more than τ·r, r being the radius about that; the boundaries of two convex
 * bodies are no farther apart than the bodies (Schneider, Convex Bodies, 1.8.1); so y has a point x of the earlier
 * boundary within τ·r, and d is measured by balls: r, from middle to middle, and the radius of the other.
 *
 * The clock begins anew before rounding in its sums can be more than what each step is enlarged by.
 */
#ifndef PIR_SOLID_DEPTH_KEPT_COVERS_H
#define PIR_SOLID_DEPTH_KEPT_COVERS_H

#include "solid/depth/covers.h"

typedef struct pir_kept_cover {
    double until, reach;
} pir_kept_cover;

/* A facet by its pair, kind and features. */
typedef struct pir_facet_key {
    uint64_t pair_kind, features;
} pir_facet_key;

typedef struct pir_kept_facet {
    pir_facet_key key;
    pir_kept_cover cover;
    uint32_t cover_pair; /* the pair whose sum covers it, or its nearest point */
    uint32_t level;      /* how long covers of it last (kept_covers.c) */
} pir_kept_facet;

typedef struct pir_kept_covers {
    pir_covers *covers;
    pir_kept_cover *pair;  /* until 0 where there is none */
    pir_kept_facet *facet; /* a table with places for twice as many as there are, or more */
    uint32_t facet_room, facet_count, makes;
    bool begun;
    double (*vertex)[3], rotation[9]; /* of the pose before; vertices less t */
    double turned, way;               /* the clock */
    double step_turned, step_way;
} pir_kept_covers;

/* False when out of memory; pir_kept_covers_finish then frees what is there. */
bool pir_kept_covers_init(pir_kept_covers *kept, pir_covers *covers);
void pir_kept_covers_finish(pir_kept_covers *kept);

/* Moves the clock to the pose of the obstacle. Whether that is near enough to the one before for covers to pay. */
bool pir_kept_covers_step(pir_kept_covers *kept);

pir_facet_key pir_facet_key_of(const pir_obstacle_plane *plane);

static inline bool pir_facet_key_equal(pir_facet_key a, pir_facet_key b) {
    return a.pair_kind == b.pair_kind && a.features == b.features;
}

/* Whether a cover proves that nothing no farther than `most` is free. */
static inline bool pir_kept_cover_holds(const pir_kept_covers *kept, pir_kept_cover cover, double most) {
    return kept->turned < cover.until && cover.reach - kept->way > most;
}

/* The cover that is kept of the facet of a plane, for all that is no farther than `most`; `until` 0 where none is. */
pir_kept_cover pir_kept_covers_find(const pir_kept_covers *kept, uint32_t plane, double most);

/* A new cover of it, for all that is no farther than `most` and somewhat more, made and kept; `until` 0 where there is
 * none. `count` corners by doubles, within 2^-47. */
pir_kept_cover pir_kept_covers_make(pir_kept_covers *kept, uint32_t plane, uint32_t count, double (*corner)[3],
                                    double most);

/* A lower bound of how far a facet is from the place of P: no less than `least`, which its plane is. */
double pir_facet_distance(const pir_obstacle *o, uint32_t plane, uint32_t count, double (*corner)[3], double least);

/* How much more than `most` is to be covered, so that covers last. */
double pir_kept_covers_more(const pir_kept_covers *kept);

#endif
