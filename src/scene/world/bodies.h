/* SPDX-License-Identifier: MIT */
/*
 * Bodies and their pieces, where they are, and the boxes around them.
 *
 * A body with a surface has one piece, the surface as a whole, and a list of pieces that are those of its triangles
 * which are in pairs (triangles.h).
 *
 * Numbers of bodies are the least that are free; numbers of pieces are of the table's own, and a body has its pieces in
 * a list. The inside of a scene knows bodies by their numbers, callers by ids: the generation above the number, which
 * grows when a body is removed. A number whose generations are used up stays free.
 *
 * `travel` of a body bounds from above how far any of its points has moved since it was added, as the length of all
 * steps. It only grows. So two bodies that were apart by d are apart by at least d less what both have travelled since.
 */
#ifndef PIR_SCENE_WORLD_BODIES_H
#define PIR_SCENE_WORLD_BODIES_H

#include <pirouette/scene.h>
#include <pirouette/trimesh.h>

#include "base/memory.h"
#include "scene/tree/box.h"

#define PIR_PIECE_NONE UINT32_MAX
#define PIR_NO_END     UINT32_MAX /* of a piece's list of pairs */
#define PIR_BODIES_MAX ((uint32_t)1 << 20)
#define PIR_PIECES_MAX 4096u /* of a body */

#define PIR_NUMBER_BITS      20
#define PIR_GENERATIONS_LAST 4095u /* of a number that is not given any more */

/* A polytope, its coarse bodies or NULL, and the farthest that a vertex is from its origin, rounded up. */
typedef struct pir_extent {
    pir_polytope *polytope; /* NULL of a surface as a whole, and of a triangle until it is needed */
    pir_coarse *coarse;
    double reach;
} pir_extent;

typedef enum pir_piece_kind {
    PIR_PIECE_CONVEX = 0,
    PIR_PIECE_SURFACE,
    PIR_PIECE_TRIANGLE,
} pir_piece_kind;

typedef struct pir_scene_piece {
    pir_extent extent;     /* of its polytope; that and the coarse bodies are referenced */
    uint32_t body, number; /* of the body's own: for a triangle that of the surface */
    uint32_t next;         /* of the body; of an unused piece: the next one */
    uint32_t node;         /* its leaf of the tree; of a triangle: the one before it in the list */
    uint32_t first;        /* end of its list of pairs */
    uint8_t kind;
    pir_trimesh *facets; /* of a convex piece: its boundary, or NULL until it is needed */
    uint64_t mark;       /* the visit that has seen it */
    uint64_t moved;      /* the update that moved its body last */
    uint64_t user;       /* the caller's number */
    pir_box tight;       /* holds the piece with its radius and half of the scene's margin */
} pir_scene_piece;

/*
 * The surface of a body, or neither. Pairs with its triangles were looked for where it was before it drifted, with
 * boxes that were wider by `skin`.
 */
typedef struct pir_body_surface {
    pir_trimesh *mesh; /* referenced */
    pir_height_field *field;
    uint32_t triangles; /* a list of pieces */
    double skin, drift, previous_drift;
} pir_body_surface;

typedef struct pir_scene_body {
    /* what every question of a pair reads is first */
    pir_pose pose;
    pir_quat unit; /* of the pose, of length 1 */
    double radius, reach, travel;
    double fast;            /* the tolerance of its meetings on the way, or 0 */
    uint32_t first, pieces; /* the list; how many */
    uint32_t category, mask;
    uint64_t moved; /* the update that moved it last: `previous` is its pose before that */
    bool used, sensor, fresh, disabled;
    uint8_t kind;
    uint16_t generation; /* of a number that is free: of the next body that gets it */
    uint64_t user;
    uint64_t shape; /* a hash of its pieces or its surface */
    pir_pose previous;
    pir_body_surface surface;
} pir_scene_body;

/* The polytope of a triangle that a query asked for: triangles.h. */
typedef struct pir_kept_triangle {
    uint32_t body, number;
    pir_polytope *polytope; /* or NULL */
} pir_kept_triangle;

typedef struct pir_bodies {
    pir_scene_body *body;
    pir_scene_piece *piece;
    uint32_t body_capacity, body_end, body_count;       /* bodies are below body_end */
    uint32_t body_slots;                                /* numbers below this have been given */
    uint32_t piece_capacity, piece_unused, piece_count; /* the count is without triangles */
    uint32_t *triangle;                                 /* a table of the pieces that are triangles: triangles.c */
    uint32_t triangle_slots, triangle_count;
    pir_kept_triangle *kept; /* PIR_TRIANGLES_KEPT of them, or NULL */
    /* The caller's, or NULL: whether two bodies meet, by id and user. */
    bool (*meets)(void *context, uint32_t body_p, uint64_t user_p, uint32_t body_q, uint64_t user_q);
    void *meets_context;
} pir_bodies;

/* A pose that has been checked. */
typedef struct pir_place {
    pir_pose pose;
    pir_quat unit;
    pir_mat3 r; /* within 31·2^-53 of the rotation */
} pir_place;

void pir_bodies_init(pir_bodies *bodies);
void pir_bodies_finish(pir_bodies *bodies, const pir_allocator *allocator);

/* PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, PIR_ERR_LIMIT. */
pir_status pir_place_make(pir_pose pose, pir_place *ret_place);

/* Reports why a place could not be made, or that a body reaches too far there; `of` says whose. Returns `status`. */
pir_status pir_place_fail(pir_pose pose, pir_status status, const char *of, pir_report *report);

/* Whether these are the polytope's coarse bodies, or none. */
static inline bool pir_is_coarse_of(const pir_coarse *coarse, const pir_polytope *polytope) {
    return !coarse || pir_coarse_get(coarse, pir_coarse_count(coarse) - 1).polytope == polytope;
}

/* Without coarse bodies. O(vertices). */
pir_extent pir_extent_of(pir_polytope *polytope);

/* Points of a body, none farther from its origin than `reach`. */
typedef struct pir_reaching {
    const pir_vec3 *point;
    uint32_t count;
    double reach;
} pir_reaching;

/* The box of points in a place, `around` wider on each side; false where it is too far away. */
bool pir_place_points(const pir_place *place, const pir_reaching *points, double around, pir_box *ret_box);

/* The box of a polytope at a place, wider by `around`. */
bool pir_place_box(const pir_place *place, const pir_extent *extent, double around, pir_box *ret_box);

/* The box of a piece of a body, which need not be in a table. */
bool pir_piece_box(const pir_scene_body *body, const pir_scene_piece *piece, const pir_place *place, double around,
                   pir_box *ret_box);

/* Room for the next body with so many pieces. PIR_ERR_LIMIT, PIR_ERR_MEMORY. */
pir_status pir_bodies_reserve(pir_bodies *bodies, const pir_allocator *allocator, uint32_t pieces);

/* Room for so many more pieces. PIR_ERR_LIMIT, PIR_ERR_MEMORY. */
pir_status pir_pieces_reserve(pir_bodies *bodies, const pir_allocator *allocator, uint32_t pieces);

/* Puts in a body for which there is room, without boxes. */
uint32_t pir_bodies_add(pir_bodies *bodies, const pir_body_options *options, const pir_place *place);
void pir_bodies_remove(pir_bodies *bodies, uint32_t body);

/* Puts in a body under a number that is free, in a generation; the table has that number. */
void pir_bodies_put(pir_bodies *bodies, uint32_t body, uint32_t generation, const pir_body_options *options,
                    const pir_place *place);

/* Gives back all that a body holds; its number and the counts of bodies stay as they are. */
void pir_bodies_empty(pir_bodies *bodies, uint32_t body);

/* Sets body_end behind the last body. */
void pir_bodies_trim(pir_bodies *bodies);

/* Numbers below this are in the table, whether they were given or not. False when out of memory. */
bool pir_bodies_reach(pir_bodies *bodies, const pir_allocator *allocator, uint32_t numbers);

/* A number that two shapes of bodies share where they are the same bits, and hardly otherwise. O(vertices). */
uint64_t pir_shape_hash(const pir_body_options *options);

/* Adds the way from the body's pose to a place to what it has travelled. */
void pir_bodies_travel(pir_scene_body *body, const pir_place *place);

/* Whether pieces of the two meet at all. */
bool pir_bodies_meet(const pir_bodies *bodies, uint32_t a, uint32_t b);

static inline pir_surface_ref pir_body_surface_of(const pir_scene_body *body) {
    return (pir_surface_ref){body->surface.mesh, body->surface.field};
}

static inline bool pir_body_has_surface(const pir_scene_body *body) {
    return body->surface.mesh || body->surface.field;
}

/* The first of the pieces of a body that may be in pairs. */
static inline uint32_t pir_body_paired(const pir_scene_body *body) {
    return pir_body_has_surface(body) ? body->surface.triangles : body->first;
}

/* The caller's number for a piece; of a triangle its material, of a surface as a whole 0. */
uint64_t pir_piece_user(const pir_bodies *bodies, const pir_scene_piece *piece);

/* The piece of a body with a number, of a surface the triangle that is a piece, or PIR_PIECE_NONE. */
uint32_t pir_bodies_piece(const pir_bodies *bodies, uint32_t body, uint32_t number);

static inline uint32_t pir_body_id(const pir_bodies *bodies, uint32_t body) {
    return (uint32_t)bodies->body[body].generation << PIR_NUMBER_BITS | body;
}

/* The number of the body with an id, or PIR_SCENE_NONE. */
static inline uint32_t pir_bodies_find(const pir_bodies *bodies, uint32_t id) {
    const uint32_t body = pir_body_number(id);
    const bool has = body < bodies->body_end && bodies->body[body].used && pir_body_id(bodies, body) == id;
    return has ? body : PIR_SCENE_NONE;
}

/* Ids turned so that they are in order of numbers, then generations; and back. */
static inline uint32_t pir_id_order(uint32_t id) {
    return id << (32 - PIR_NUMBER_BITS) | id >> PIR_NUMBER_BITS;
}

static inline uint32_t pir_id_of_order(uint32_t order) {
    return order << PIR_NUMBER_BITS | order >> (32 - PIR_NUMBER_BITS);
}

#endif
