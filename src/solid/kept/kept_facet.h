/* SPDX-License-Identifier: MIT */
/*
 * The boundary of a sum in the plane of one candidate, or of several that are in one plane at every rotation: clipped
 * once, and kept while the choices made on the way stay the same.
 *
 * A choice rests on the side of a plane that a point is on. Where the point is a sum of vertices, its distance from the
 * plane bounds how far P may turn before that changes; the side is `cold`, and looked at once P has turned so far. A
 * point where three planes meet may move at any speed: its sides are `hot`, and looked at in every frame.
 *
 * The rates: x = p + q and y = p' + q' are sums of vertices of P and Q. With P turning by an angle, of a plane
 * through y with a normal of P, n·(x − y) changes by no more than |q − q'| times it: in P's frame only Q
 * moves. Likewise with a normal of Q. Where the normal is e × g, of unit edges of both, |e × g| times the
 * distance is det(e, g, p − p') + det(e, g, q − q'), which change by no more than |p − p'| and |q − q'|
 * times it. And two convex sets, a candidate and a pair's sum, part or approach by no more than the angle times the
 * lesser of two: how far the vertices of P that the two are of are from each other at most, and those of Q.
 *
 * Invariants of a facet that stands, at the rotation at hand:
 * - Each side that its record has is as it was told, or may be wrong only if P has turned past what is noted there.
 * - Of each pair whose sum is nearer to its candidates than the skin there is an entry, which says what of it counts.
 *   A pair that is not there covers nothing.
 * - Of a pair whose planes are listed, as are those of all that clipping came to, each plane either has all corners of
 *   the candidates below it, or in it at every rotation, and so cuts nothing of them; or it is among `cut`.
 */
#ifndef PIR_SOLID_KEPT_KEPT_FACET_H
#define PIR_SOLID_KEPT_KEPT_FACET_H

#include "solid/glue/union_outline.h"
#include "solid/kept/kept_pairs.h"
#include "solid/space/record.h"
#include "solid/sum/subtract.h"

/* The features of a candidate: a facet of P and a vertex of Q, two edges, a facet of Q and a vertex of P. In this
 * order, the numbers likewise, candidates are made anew. */
enum pir_candidate_kind { PIR_FACET_OF_P, PIR_TWO_EDGES, PIR_FACET_OF_Q };

/* A candidate, and the plane that it has at every rotation: by the first facet in one plane, the first edges on one
 * line. */
typedef struct pir_candidate_key {
    uint32_t kind, plane[2];
    uint32_t a, b; /* facet and vertex, or edges */
    bool turned;   /* whether the normal is against that of e × g */
} pir_candidate_key;

/* The part of a pair's sum that counts for a facet. */
enum pir_pair_cover {
    PIR_COVER_CLIPS, /* it was taken from the candidates */
    PIR_COVER_NONE,  /* nothing: all was covered without it */
    PIR_COVER_BELOW, /* a plane, which is the facet's own, with the sum below it */
    PIR_COVER_APART, /* a plane that the candidates are above */
    PIR_COVER_GAP,   /* boxes that are apart, until P has turned so far */
};

typedef struct pir_near_pair {
    uint32_t pair;
    enum pir_pair_cover cover;
    bool listed;    /* whether its planes are among `far` and `cut` */
    uint32_t plane; /* below, or apart */
    double depth;
    uint32_t first_cut, cuts; /* scratch of clipping */
} pir_near_pair;

/* All corners of the candidates on one side of a plane of the pair near[near]: −1 of one that cuts nothing, 1 of one
 * that holds it apart. */
typedef struct pir_far_plane {
    uint32_t plane, near;
    int32_t sign;
} pir_far_plane;

typedef struct pir_cut_plane {
    uint32_t plane, near;
} pir_cut_plane;

/* An edge of a facet's boundary: along the line where its plane meets another, between two vertices. */
typedef struct pir_kept_run {
    uint32_t plane, line; /* the line by a number of the facet's */
    uint32_t a, b;
    int sign; /* as of a pir_run */
} pir_kept_run;

/* The edges of a facet, once they are glued (kept_glue.h). Vertices are the glue's. */
typedef struct pir_facet_outline {
    bool made, is_traced;   /* whether what follows is there; whether loops are */
    bool knotted;           /* loops that may not be the same at the next rotation, though all else is */
    pir_number_list member; /* a point of the facet, then the vertex that it is at */
    pir_number_list chain;  /* of each line with more than two ends: its plane, their number, and these in order */
    pir_kept_run *run;
    uint32_t run_count, run_room;
    pir_number_list touch;  /* a run, by order, then a vertex within it; along the run */
    bool is_listed;         /* whether what follows is there */
    pir_number_list near;   /* a run, by order, then a vertex near it */
    pir_space_box near_box; /* of what is so near */
    double near_until;      /* a way of the glue's vertices, up to which no other vertex gets to a run */
    pir_number_list loop;   /* corners of all loops */
    pir_number_list end;    /* of each loop in `loop` */
} pir_facet_outline;

typedef struct pir_plane_facet {
    pir_candidate_key *key; /* of all candidates in its plane */
    uint32_t key_count, key_room;
    bool based, stands, fleeting; /* whether what follows is there; whether what bounds the sum is right */
    /* the candidates, and what is near them */
    uint32_t half;
    uint32_t axis;  /* that the walls of the candidates are parallel to */
    double upright; /* how far the plane's normal led along it when they were made */
    pir_polygons candidates;
    pir_number_list points, planes; /* of the space, which only the candidates have */
    pir_near_pair *near;
    uint32_t *near_pair; /* the pairs alone */
    double *gap_until;   /* per near pair: up to which boxes keep it apart; infinite where that does not count */
    pir_far_plane *far;
    double *far_until; /* per far plane: how far P may turn */
    pir_cut_plane *cut;
    uint32_t near_count, near_room, near_pair_room, gap_until_room, far_count, far_room, far_until_room, cut_count,
        cut_room;
    uint32_t far_soon; /* the first of them, of which some may not hold past `horizon` */
    double horizon;    /* up to which all others hold */
    double near_until; /* the least of what is noted with near pairs */
    /* of the candidates, in the frame that is noted, and of the vertices of each body that they are of */
    pir_space_box box, part[2];
    uint32_t box_frame;
    /* what clipping told, and what it left */
    pir_number_list made; /* points of the space */
    pir_told_side *hot;
    pir_told_side *cold;
    double *cold_until; /* as of far planes */
    pir_parted_polygon *parted;
    pir_met *met;            /* with no set, what is left */
    pir_number_list corners; /* of what is parted or met */
    uint32_t hot_count, hot_room, cold_count, cold_room, parted_count, parted_room, met_count, met_room;
    uint32_t cold_until_room;
    uint32_t hot_clipped; /* hot sides that clipping told */
    double told_until;    /* the least of what is noted with cold sides */
    uint32_t survivors;
    pir_segment_list edge;
    pir_facet_outline outline;
} pir_plane_facet;

/* The scratch that the making of facets shares. */
typedef struct pir_facet_maker {
    pir_space *space;
    const pir_shell_body *body; /* both */
    pir_kept_pairs *pairs;
    double diameter[2]; /* of P and Q, in the space */
    double turn, step;  /* of P so far, a bound on its way; and in this frame */
    pir_side_record record;
    pir_polygons polygons;
    pir_fragments fragments, kept;
    uint32_t *half, half_room, *order, *work, order_room, work_room;
    uint32_t *due, due_count, due_room; /* of the facet at hand: far planes that are to be looked at */
    pir_far_plane *gone;                /* of these, those that are no longer so */
    uint32_t gone_count, gone_room;
    bool changed;          /* of the facet at hand: whether pairs near it have got or lost planes, in this frame */
    uint32_t spared;       /* likewise: planes taken as new ones, in this frame */
    uint64_t made, looked; /* facets clipped, sides looked at, in this frame */
} pir_facet_maker;

void pir_facet_maker_finish(pir_facet_maker *maker);

/* Makes the candidates anew, of the facet's keys; `near` are the pairs whose sums are nearer than the skin. The status
 * is the space's, as of all that follows. */
void pir_kept_facet_make(pir_facet_maker *maker, pir_plane_facet *facet, const uint32_t *near, uint32_t count);

/* Takes pairs that may have become nearer than the skin. */
void pir_kept_facet_meet(pir_facet_maker *maker, pir_plane_facet *facet, const uint32_t *near, uint32_t count);

/* Brings what is near to the rotation at hand; where that may change what bounds the sum, the facet does not stand. */
void pir_kept_facet_follow(pir_facet_maker *maker, pir_plane_facet *facet);

/* Whether the walls of the candidates still lead across their plane, on the same side. */
bool pir_kept_facet_is_upright(pir_facet_maker *maker, const pir_plane_facet *facet);

/* The box of the facet's candidates. */
pir_space_box pir_kept_facet_box(pir_facet_maker *maker, pir_plane_facet *facet);

/* Gives back the numbers that only the facet has, and forgets its candidates. */
void pir_kept_facet_empty(pir_facet_maker *maker, pir_plane_facet *facet);

/* Likewise, and frees its memory. */
void pir_kept_facet_finish(pir_facet_maker *maker, pir_plane_facet *facet);

/* How far corners of the candidates are from the vertices that a plane of a pair is through, of each body. */
typedef struct pir_plane_reach {
    uint32_t first; /* the body of the plane's normal; P where it is of two edges */
    bool of_edges;
    const double *through[2];
    double square[2]; /* the greatest */
} pir_plane_reach;

pir_plane_reach pir_reach_of(const pir_space *space, uint32_t plane);

/* Takes a corner of the facet's candidates. */
static inline void pir_reach_add(pir_plane_reach *reach, const pir_space *space, const pir_plane_facet *facet,
                                 const pir_space_point *corner) {
    // the body of the facet's normal comes first
    const uint32_t swapped = facet->key[0].kind == PIR_FACET_OF_Q;
    for (uint32_t k = 0; k < 2; k++) {
        if (k == reach->first && !reach->of_edges)
            continue;
        const double *x = space->point[corner->of[k ^ swapped]].x, *y = reach->through[k];
        const double to[3] = {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
        const double square = to[0] * to[0] + to[1] * to[1] + to[2] * to[2];
        reach->square[k] = square > reach->square[k] ? square : reach->square[k];
    }
}

/* How far P may turn before one of these corners, which are at this distance from the plane at least, not sure where it
 * is not above 0, may be in it: counted from the beginning. */
double pir_distance_until(const pir_facet_maker *maker, uint32_t plane, double distance, const pir_plane_reach *reach);

/* A distance by doubles that a point has at least from a plane, on that side; 0 or less where they do not tell. */
double pir_sure_distance(const pir_space *space, uint32_t plane, uint32_t point, int side);

/* Lists the planes of the pair near[at], which may clip. */
void pir_kept_facet_list_planes(pir_facet_maker *maker, pir_plane_facet *facet, uint32_t at);

/* --- clipping (clip_facet.c) --- */

/* Clips the candidates by what is near, and unites what is left. */
void pir_kept_facet_clip(pir_facet_maker *maker, pir_plane_facet *facet);

/* Whether all that clipping was told is as it was. */
bool pir_kept_facet_stands(pir_facet_maker *maker, pir_plane_facet *facet);

/* Takes a plane that the pair near[at] has got: the facet stands on if it cuts nothing of what the pair met. */
void pir_kept_facet_amend_plane(pir_facet_maker *maker, pir_plane_facet *facet, uint32_t at, uint32_t plane);

/* Takes the pair near[at] last of all: the facet stands on if it is apart from all that is left. */
void pir_kept_facet_amend_pair(pir_facet_maker *maker, pir_plane_facet *facet, uint32_t at);

/* Forgets what clipping left. */
void pir_kept_facet_unclip(pir_facet_maker *maker, pir_plane_facet *facet);

/* Makes numbers of points or planes spare. */
void pir_give_back(pir_space *space, pir_space_spare *spare, pir_number_list *list);

#endif
