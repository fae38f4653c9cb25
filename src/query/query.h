/* SPDX-License-Identifier: MIT */
/*
 * The inside of a query object.
 *
 * Numbers are worked out in a frame of their own. Each operand is moved so that the middle of its bounding box is the origin, and
 * scaled by one power of two, so that sizes are near 1; the difference of the two is D. A translation t becomes the point x of that frame, worked
 * out in double-double, so neither a far origin nor a small scale costs digits. The slack of a facet of D with unit normal n and
 * offset h is s = h − n·x: all slacks positive is inside, one negative is outside, and the least of all is the depth.
 *
 * Facets of D are the pieces of the sum's pairing. They are kept in groups that turn together: some facets of P with the edges between
 * them and what crosses those, or some facets of Q. Bounds tell which groups could hold the least slack (bounds.c); those are sieved
 * (sieve.c) the first time at a rotation, and have their planes made the second. For many translations at one rotation all planes are
 * made and laid out in leaves (leaves.c).
 *
 * Exactness: a slack is known within err · PIR_SLACK_BOUND · (size of bodies + |x|); what that leaves open, side.c decides in integers.
 */
#ifndef PIR_QUERY_QUERY_H
#define PIR_QUERY_QUERY_H

#include <pirouette/query.h>

#include "dymsum/view.h"
#include "query/decide/placed.h"
#include "query/frame/dd.h"
#include "query/frame/lanes.h"
#include "query/planes/scan.h"

/*
 * With u = 2^-53 and sizes r_P, r_Q: a rotated unit normal is off by 42u (exact/sign.h), which moves n·(q − x) by 42u (r_Q + |x|);
 * P's own offset n·p is off by 14u r_P (vertices 3u, normal 8u, dot product 3u); q, x and the last operations add
 * less than 12u (r_P + r_Q + |x|). Together below 68u; 2^-46 = 128u. An edge pair's normal is a cross product of unit vectors off by 8u
 * and 42u, so it is off by less than 64u / sin of their angle, and err is 1 / sin there.
 */
#define PIR_SLACK_BOUND 0x1p-46

/* Edge pairs with a smaller |sin| get their normal from exact integers before they decide an answer, and at once below the second. */
#define PIR_SIN_REFINED 0x1p-5
#define PIR_SIN_EXACT   0x1p-40

/* How many directions a climb has vertices at hand for, to start from: see descent.c. */
#define PIR_LANDMARKS 24

/* The last slot is spare: for a piece by itself. */
#define PIR_SPARE_SLOTS 1

/* A facet of D: PIR_FACET_FV (first: facet of P), VF (second: facet of Q), EE (first: edge of P, second: halfedge of Q). */
typedef struct pir_piece {
    uint32_t kind, first, second;
} pir_piece;

/* facet.h */
typedef struct pir_facet pir_facet;
typedef struct pir_least pir_least;

/* Parallel arrays of planes. */
typedef struct pir_planes {
    pir_lanes n; /* unit normals */
    double *h, *err;
    pir_piece *piece;
    uint32_t capacity, used;
} pir_planes;

typedef struct pir_group {
    /* what it is made of: parts of query->facet_list and edge_list; facets past own_end are neighbours, there for its bound only */
    bool of_q;
    uint32_t middle; /* the facet of its own that its others are nearest to */
    uint32_t facets, own_end, facets_end, edges, edges_end;
    /* its planes, where stamp is the query's, padded to whole blocks by planes that never matter */
    uint64_t stamp;
    uint32_t start, count;
    uint64_t sieved; /* the stamp of the rotation at which it was last sieved */
} pir_group;

/* Planes of one rotation in leaves: see leaves.c. */
typedef struct pir_leaves {
    uint64_t stamp; /* of the rotation */
    uint32_t plane_count, leaf_count, capacity;
    pir_lanes n;
    double *h, *err;
    uint32_t *slot;                /* where each stands in query->planes */
    uint32_t *cell, *cell_start;   /* cells while planes are sorted, work space after */
    pir_lanes box_least, box_most; /* per leaf: of the normals; the least h, the greatest err */
    double *box_h, *box_err, *low;
    uint32_t *looked;
} pir_leaves;

typedef struct pir_patch_room pir_patch_room;

struct pir_query {
    pir_allocator allocator;
    /*
     * references: to the sum, and to its operands as all below was made from them; p is reflected, as the sum holds it
     */
    pir_sum *sum;
    pir_polytope *p, *q;
    bool fits;             /* whether what depends on their coordinates is filled */
    uint64_t generation;   /* of the sum, that all below is for; 0 where it is for none: see follow.c */
    int exponent;          /* one unit of the frame is 2^exponent */
    double up, down;       /* 2^exponent and 2^-exponent, or 0 where either is no normal number */
    pir_vec3 *vp, *vq;     /* vertices in the frame */
    double *hp, *hq;       /* per facet, normal · vertex */
    double size_p, size_q; /* the farthest vertices */
    uint32_t landmarks_p[PIR_LANDMARKS], landmarks_q[PIR_LANDMARKS];
    double swing_p, swing_q;    /* how fast supports change as directions turn: see planes.c */
    pir_dd3 centre_p, centre_q; /* in units of the frame */

    /* the rotation that all below is for */
    bool followed;
    pir_quat at;
    pir_mat3 r;
    pir_dd3 r_fine[3]; /* rows, where has_fine */
    bool has_fine;
    pir_dd3 offset; /* x = translation / 2^exponent − offset */
    uint64_t stamp;
    /* an upper bound on all turning from one rotation that bounds were asked at to the next: the last, which `turned` is the stamp of */
    double turn;
    pir_quat turned_to;
    uint64_t turned;

    pir_group *groups;
    /* those of P from 0, those of Q from first_of_q; up to the next whole lane they are followed by empty ones */
    uint32_t group_count, groups_of_p, groups_of_q, first_of_q;
    uint32_t *facet_list, *edge_list;
    uint32_t *edge_left, *edge_right; /* per edge of the list: where its facets stand in the list of its group */
    uint32_t facet_list_count, edge_list_count;
    double *slack; /* per group: what a search for the state knows, HUGE_VAL where it did not look */

    /* per group: slacks were at least bound[g], at point where[g] and turn when[g]; an angle a may lower them by
       a · (lever[g] + a · bend[g]) */
    double *bound, *when, *lever, *bend, *low; /* low: the bounds for the placement in hand */
    pir_lanes where;
    /* per group: its cap's axis and corner of D in the frame, at the rotation that the stamp of its block of lanes is of; both in the body's frame;
       cosine and sine of its angle */
    pir_lanes cap_axis, cap_corner, cap_axis_body, cap_corner_body;
    double *cap_cos, *cap_sin;
    uint64_t *cap_stamp;
    /* what a search for the least slack found: groups that were looked at, and planes from slot `candidates` up to the spare ones */
    uint32_t *looked;
    uint32_t looked_count, candidates;

    /* what planes are made from, in the order of the lists: facets' normals and offsets, edges' directions and origins, as bodies have them */
    pir_lanes facet_normal, edge_direction, edge_origin;
    double *facet_offset;
    /* work space: edges turned; of the group being made, the vectors of its planes */
    pir_lanes turned_direction, turned_origin, work[3];
    uint32_t work_capacity;
    const pir_scan *scan;
    pir_planes planes;
    pir_leaves leaves;

    /* for sums with a region, see region.c: bounds per facet of P, of Q and edge of P, the ways, and where the last search was */
    double *known_p, *known_q, *known_edge;
    double way_p, way_q;
    pir_quat way_unit;
    pir_vec3 way_x;

    pir_limbs scratch; /* of exact signs */
    pir_exact exact;
    pir_patch_room *patches; /* of manifold.c */
};

/* A placement brought into the frame. */
typedef struct pir_placement {
    pir_vec3 translation;
    pir_vec3 x;
    pir_dd3 fine; /* x with 106 bits */
    double reach; /* size_p + size_q + |x| */
    double error; /* PIR_SLACK_BOUND · reach, and what x itself may be off by */
} pir_placement;

/* --- frame.c --- */

/*
 * Room for what does not depend on the rotation but the groups; false when out of memory. Filled, in that room:
 * PIR_ERR_LIMIT.
 */
bool pir_frame_init(pir_query *query);
void pir_frame_finish(pir_query *query);
pir_status pir_frame_fill(pir_query *query);

/* Takes note of the sum's rotation. */
void pir_frame_follow(pir_query *query);
void pir_frame_make_fine(pir_query *query);

/* Checks and converts a translation: PIR_ERR_NOT_FINITE, PIR_ERR_LIMIT. */
pir_status pir_frame_place(pir_query *query, pir_vec3 translation, pir_placement *ret_placement);

/* A point of the frame in world coordinates: that of Q's body, y given relative to Q's centre. */
pir_vec3 pir_frame_world(const pir_query *query, pir_vec3 y);

static inline double pir_frame_length(const pir_query *query, double length) {
    return query->up != 0 ? length * query->up : ldexp(length, query->exponent);
}

static inline double pir_frame_from(const pir_query *query, double length) {
    return query->up != 0 ? length * query->down : ldexp(length, -query->exponent);
}

/* Vertex (a, b) of D. */
static inline pir_vec3 pir_frame_vertex(const pir_query *query, uint32_t a, uint32_t b) {
    return pir_vec_add(pir_mat_apply(&query->r, query->vp[a]), query->vq[b]);
}

/* --- planes.c --- */

/*
 * Room, and the groups, which depend on normals alone; false when out of memory. Filled with what groups read of the
 * bodies.
 */
bool pir_planes_init(pir_query *query);
void pir_planes_finish(pir_query *query);
void pir_planes_fill(pir_query *query);

/* Room for the planes of the sum's present pairing; PIR_ERR_MEMORY. */
pir_status pir_planes_reserve(pir_query *query);

/* The plane of one piece into slot `slot`; false when its edges are parallel and it is none. */
bool pir_plane_make(pir_query *query, pir_piece piece, uint32_t slot);

/* The plane of slot `slot` from exact integers; false when its edges are parallel. */
bool pir_plane_refine(pir_query *query, uint32_t slot);

/* Makes the planes of group `g` unless they are there. */
void pir_group_make(pir_query *query, uint32_t g);

/* --- sieve.c --- */

/*
 * Adds to the candidates those pieces of group `g` whose slack may be at most `limit`, without making its other planes; keeps the group's
 * bound. Returns what the least slack of all is not above, `limit` or less.
 */
double pir_group_sieve(pir_query *query, uint32_t g, const pir_placement *placement, double limit);

/* --- bounds.c --- */

/* Room; false when out of memory. Filled: caps, and no bound known. */
bool pir_bounds_init(pir_query *query);
void pir_bounds_finish(pir_query *query);
void pir_bounds_fill(pir_query *query);

/*
 * query->low[g]: no slack of group g at x is below it; worked out no better than to tell it from `limit`. Returns a number that the least
 * slack of all is not above, HUGE_VAL where it met none.
 */
double pir_groups_bound(pir_query *query, const pir_placement *placement, double limit);

/* Looks at every plane of group `g`: the least s − error and the least s + error; keeps the first as its bound. */
void pir_group_look(pir_query *query, uint32_t g, const pir_placement *placement, double *ret_low, double *ret_high);

/* Keeps what is known of group `g` at x: no slack is below `low`, and no n·x below `along`. */
void pir_bound_keep(pir_query *query, uint32_t g, const pir_placement *placement, double low, double along);

static inline double pir_plane_slack(const pir_planes *planes, uint32_t i, pir_vec3 x) {
    return planes->h[i] - (planes->n.x[i] * x.x + planes->n.y[i] * x.y + planes->n.z[i] * x.z);
}

/* The piece kept in a cache, if it still is one: made into the spare slot, the last. */
static inline pir_vec3 pir_plane_normal(const pir_planes *planes, uint32_t i) {
    return (pir_vec3){planes->n.x[i], planes->n.y[i], planes->n.z[i]};
}

bool pir_piece_recall(pir_query *query, const pir_query_cache *cache, uint32_t *ret_slot);
void pir_piece_keep(pir_query_cache *cache, pir_piece piece);

/* --- side.c --- */

/* The exact sign of the slack of a piece at a translation. The piece's edges must not be parallel. */
int pir_side_exact(pir_query *query, pir_piece piece, pir_vec3 translation);

/* A corner of a piece. */
void pir_piece_corner(const pir_query *query, pir_piece piece, uint32_t *ret_a, uint32_t *ret_b);

/* The exact unit normal of an edge pair; false when parallel. */
bool pir_side_normal(pir_query *query, pir_piece piece, pir_vec3 *ret_normal);

/* --- state.c --- */

#define PIR_NO_PLANE UINT32_MAX

/*
 * The exact state. When outside, *ret_slot is the slot of a plane that separates, PIR_NO_PLANE where none is known. On the boundary,
 * *ret_touching is the first true facet in order that t lies on; there may be none where D has no area.
 */
pir_state pir_state_find(pir_query *query, const pir_placement *placement, const pir_query_cache *cache,
                         uint32_t *ret_slot, pir_least *ret_touching, uint32_t *steps);

/* --- depth.c --- */

/* Keeps the true facet of least slack, and the first in order of those that tie, of all whose pieces were offered. */
void pir_least_offer(pir_query *query, const pir_placement *placement, pir_least *least, pir_piece piece);

/* The true facet of least slack; false where D has none. Which it is means nothing when x is outside, but for the sign of its slack. */
bool pir_depth_find(pir_query *query, const pir_placement *placement, const pir_query_cache *cache,
                    pir_facet *ret_facet, uint32_t *steps);

/* --- leaves.c --- */

/* Makes the leaves of the rotation; PIR_ERR_MEMORY. */
pir_status pir_leaves_make(pir_query *query);
void pir_leaves_finish(pir_query *query);

/* The state where doubles tell it; false where they leave it open. */
bool pir_leaves_state(pir_query *query, const pir_placement *placement, pir_state *ret_state);

/* As pir_depth_find. */
bool pir_leaves_depth(pir_query *query, const pir_placement *placement, pir_facet *ret_facet);

/* A number that no slack is below. */
double pir_leaves_least(pir_query *query, const pir_placement *placement);

/* --- descent.c --- */

/* The bounds meet when they are this close, relative to the placement's reach; 2^-46 is what rounding leaves. */
#define PIR_MEET 0x1p-44

/* A descent finds a new vertex in every step, in practice four to ten in all; this ends what rounding might turn in a circle. */
#define PIR_MOST_STEPS 128

/* Up to three vertices of D whose hull holds the point nearest to x, and its weights. */
typedef struct pir_simplex {
    uint32_t count;
    uint32_t a[4], b[4];
    double weight[4];
    pir_vec3 direction;  /* unit, from D to x */
    double upper, lower; /* bounds on the distance */
    bool certain;        /* the bounds met */
} pir_simplex;

/* Descends from `simplex` (count 0: cold) until the bounds meet, the lower passes `cutoff`, or no step helps. */
void pir_descend_to_point(pir_query *query, const pir_placement *placement, double cutoff, pir_simplex *simplex,
                          uint32_t *steps);

/* Vertices to climb from, of all directions. */
void pir_landmarks_set(const pir_polytope *polytope, uint32_t landmarks[PIR_LANDMARKS]);

/* A first vertex when there is none: that towards x. */
void pir_simplex_start(const pir_query *query, const pir_placement *placement, pir_simplex *simplex);

/* --- proof.c --- */

/*
 * Whether a facet of D beside the simplex certainly separates. Then it is kept in the cache, if there is one, and its
 * plane stands in the last slot.
 */
bool pir_prove_outside(pir_query *query, const pir_placement *placement, const pir_simplex *simplex,
                       pir_query_cache *cache);

/* The vertex of a polytope farthest along unit n, from `from` uphill. */
uint32_t pir_climb(const pir_polytope *polytope, pir_vec3 n, uint32_t from);

/* --- direction.c --- */

/* A vector of any length as a unit vector and its length; false when it is zero. */
bool pir_unit_of(pir_vec3 v, pir_vec3 *ret_unit, double *ret_length);

/* --- witness.c --- */

/* The least face of `polytope` that holds the given vertices; the first vertex where no face holds all. */
pir_feature pir_feature_of(const pir_polytope *polytope, const uint32_t *vertices, uint32_t count);

/* --- region.c --- */

/* Room for what a search remembers; false when out of memory. */
bool pir_region_init(pir_query *query);
void pir_region_free(pir_query *query);
void pir_region_forget(pir_query *query);

/*
 * The state as the facets in the region of the sum tell it. *ret_least is the facet that separates, or touches, or is the one of least slack;
 * there is none where the region has none.
 */
pir_state pir_region_find(pir_query *query, const pir_placement *placement, const pir_query_cache *cache,
                          pir_least *ret_least, uint32_t *steps);

/* --- follow.c --- */

/* What every call begins with: checks, what has changed in the sum, the placement. */
pir_status pir_query_place(pir_query *query, const pir_query_input *input, pir_placement *ret_placement);

/* The same for calls that need the whole sum: PIR_ERR_UNSUPPORTED where it has a region. */
pir_status pir_query_begin(pir_query *query, const pir_query_input *input, pir_placement *ret_placement);

#endif
