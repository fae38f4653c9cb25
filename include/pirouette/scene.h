/* SPDX-License-Identifier: MIT */
/**
 * Scenes: many bodies, of which only what is asked for is computed.
 *
 * A body is one polytope, or several that are pieces of a body that is not convex, with a rounding radius. A scene
 * keeps a box around each piece in a tree, and a pair (pair.h) for each two pieces whose boxes meet. pir_scene_update
 * brings bodies to new poses, looks at the pairs that moved, and lists what happened: which contacts began, persist and
 * ended.
 *
 * Contacts are of pieces. Two bodies touch where two of their pieces do; events of one pair of bodies stand together.
 * Two pieces are in contact where they share a point, or are apart by at most the margin of the scene. Whether they
 * share a point is exact for the doubles given, as in pair.h; with rounding radii, and for the margin, the distance
 * decides.
 *
 * The body of a mesh or a height field has the triangles of that surface for its pieces, under their own numbers. A
 * triangle is flat: it has no inside, and either side of it is met. The surface's own tree is asked for those that a
 * box meets, so a triangle that nothing is near takes neither time nor memory. A surface has as many triangles as there
 * are, without a limit here; near one piece, with PIR_SCENE_MANIFOLDS, may be at most 65,536 (2^16) of them.
 * Contacts with surfaces are without ghosts (trimesh_contact.h). An event has those of one normal, with the triangle of
 * the deepest; a triangle that is met along several normals has an event for each. One all of whose contacts are ghosts
 * has an event without contacts, whose distance and normal are those of the triangle alone: do not push along it.
 *
 * Convex pieces side by side are floors as well: prisms of one body, slabs in a row, pieces next to a mesh. With
 * options.unions and PIR_SCENE_MANIFOLDS their contacts are without ghosts too. Pieces of bodies that do not move,
 * their surfaces, and pieces of one moving body are asked together where their boxes meet, each as the surface that its
 * facets make; of two moving bodies the one with more pieces is asked so. Contacts at walls between pieces of the body
 * that asks are left out as well. An event then has the contacts of one normal with one piece; one whose contacts are
 * all ghosts has none. Without it each two pieces have the contacts of their pair, whatever is beside them.
 *
 * Manifolds told again. With options.reuse above 0 the contacts of a pair are told again while its bodies have moved
 * little relative to each other since they were found: points move with their bodies. The states of all pairs are exact
 * all the same. A distance that was found earlier proves them, or else the pair is asked anew. Each event has an
 * `error` e, at most options.reuse, and 0 where all that it tells is of this update:
 *
 *   - Relative to one piece no point of the other has moved farther than e since what is told was found.
 *   - Of two convex pieces that are in no union, the signed distance is within e of that of the poses of this
 *     update, and has its sign. Along no direction are they farther apart than along the normal by more than 2e.
 *   - Contacts are those of the poses then. Each point is still on its body, where it was; the distance of a contact is
 *     that of its points now, along the normal, and was another by at most e. They need not be over each other any more
 *     than e allows. Which corners a manifold of this update would have is not told.
 *   - Contacts with surfaces, and of unions, are told again while the piece is in contact with the same pieces and
 *     triangles. Which of them are ghosts is that of the poses then. The distance of an event is that of its first
 *     contact.
 *
 * A pair needs two bodies, one of them moving, and masks that match both ways: the category of each is in the mask of
 * the other. options.meets, where there is one, may refuse it. A sensor is told of what overlaps it, and has no
 * contacts: of kinematic bodies too, whatever its own kind. Two sensors do not meet, nor do two surfaces.
 *
 * A body is known by an id: its number, which tells it from the others that are there, and a generation, which tells it
 * from bodies that had the number before. An id of a body that was removed is refused, also when its number has been
 * given again. Numbers are small, so they may index arrays of the caller (pir_body_number).
 *
 * Determinism: events, their order and all their numbers depend on the poses, on the bodies and on which pieces were in
 * contact before: not on threads, the history of the scene, nor the machine. With options.reuse they depend on what is
 * kept of contacts as well, which a snapshot holds (scene_file.h). Events are in the order of body_p, body_q,
 * piece_p, piece_q: of bodies by number, of one number by generation.
 *
 * Frame: the world. Lengths in the unit of the polytopes' coordinates.
 *
 * Ownership: a scene holds a reference to each polytope and surface of its bodies. Memory of the scene comes from its
 * allocator within its budget. What a pair keeps of a polytope alone belongs to the polytope (pair.h), is made when it
 * first meets another of a size, and does not count.
 *
 * Memory that runs out, or the budget: the call is PIR_ERR_MEMORY, and the scene is as it was before. A scene whose
 * bodies and contacts have been as many before allocates nothing; with options.reuse, contacts in manifolds of each
 * size.
 *
 * Threads: a scene belongs to one thread at a time. With options.threads above 1 it uses others within a call, and
 * calls its allocator and those of the polytopes from them: its own one at a time, those of polytopes at once, as pairs
 * do.
 */
#ifndef PIROUETTE_SCENE_H
#define PIROUETTE_SCENE_H

#include <string.h>

#include <pirouette/base.h>
#include <pirouette/motion.h>
#include <pirouette/pair.h>
#include <pirouette/polytope.h>
#include <pirouette/pose.h>
#include <pirouette/query.h>
#include <pirouette/simplify.h>
#include <pirouette/tasks.h>
#include <pirouette/trimesh.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_scene pir_scene;

/** The id of no body. */
#define PIR_SCENE_NONE UINT32_MAX

/** The detail that a scene computes of pieces in contact. */
typedef enum pir_scene_detail {
    PIR_SCENE_STATES = 0, /**< that they are; no numbers */
    PIR_SCENE_DEPTHS,     /**< signed distance, normal, witness too */
    PIR_SCENE_MANIFOLDS,  /**< and the contact manifold */
} pir_scene_detail;

typedef struct pir_scene_options {
    size_t size;                    /**< of this struct, which pir_scene_options_default sets (base.h) */
    const pir_allocator *allocator; /**< or NULL: malloc's */
    size_t budget;                  /**< the most bytes that the scene may have; 0 for no bound */
    pir_scene_detail detail;
    double margin;          /**< ≥ 0: pieces apart by at most this are in contact too, for solvers; 0 for STATES */
    bool approach;          /**< whether events tell how fast the bodies approach */
    bool unions;            /**< whether contacts of pieces side by side are without ghosts; see above */
    uint32_t threads;       /**< how many threads a call uses, that of the caller included; at least 1, at most 64 */
    const pir_tasks *tasks; /**< or NULL: threads of the scene's own; copied */
    /**
     * NULL, or filled whenever a call on the scene that has no report of its own fails: what was wrong, where and why.
     * It is the caller's, and outlives the scene.
     */
    pir_report *report;
    /** Whether the shape of every body that is added is kept, so that a snapshot can make bodies that were removed
        (scene_file.h). pir_scene_forget_shapes drops them. */
    bool keep_shapes;
    bool profile; /**< whether updates count by which ways pairs are answered (pir_scene_get_profile) */
    /** NULL, or a clock in nanoseconds, by which updates are told how long their parts take. */
    uint64_t (*clock)(void *context);
    void *clock_context;
    /** A length ≥ 0: manifolds of bodies that moved by at most this since may be told again; 0 for never. Above 0 of
        PIR_SCENE_MANIFOLDS alone. See above. */
    double reuse;
    /**
     * NULL, or whether two bodies meet that kinds and masks let meet: groups, owners, joints. The ids and users are
     * those of the bodies, the lower number first. The answer is to be the same for as long as neither body is changed
     * (pir_scene_set_filter, also with what they had, has it asked again), and is asked when boxes come near, by the
     * thread that calls the scene, and by queries of bodies of the scene. It must not call the scene.
     */
    bool (*meets)(void *context, uint32_t body_p, uint64_t user_p, uint32_t body_q, uint64_t user_q);
    void *meets_context;
} pir_scene_options;

/** malloc's memory, no budget, manifolds, no margin, approach, unions, report, reuse or `meets`, one thread, no shapes
    kept. O(1). */
static inline pir_scene_options pir_scene_options_default(void) {
    pir_scene_options options;
    memset(&options, 0, sizeof options);
    options.size = sizeof options;
    options.detail = PIR_SCENE_MANIFOLDS;
    options.threads = 1;
    return options;
}

/**
 * A scene without bodies. `options` may be NULL.
 *
 * Cost: O(threads).
 *
 * Errors: PIR_ERR_ARGUMENT (a margin below 0 or with PIR_SCENE_STATES, a reuse below 0 or without manifolds, threads
 * out of range), PIR_ERR_NOT_FINITE (the margin, the reuse), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_scene_create(const pir_scene_options *options, pir_scene **ret_scene);

/** Frees, and gives all references back; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_scene_destroy(pir_scene *scene);

/* --- bodies --- */

typedef enum pir_body_kind {
    PIR_BODY_MOVING = 0, /**< meets all others */
    PIR_BODY_KINEMATIC,  /**< moves, and meets moving ones */
    PIR_BODY_STATIC,     /**< never moves, and meets moving ones */
} pir_body_kind;

typedef struct pir_body_options {
    size_t size; /**< of this struct, which pir_body_options_default sets (base.h) */
    pir_body_kind kind;
    pir_pose pose;
    pir_polytope *const *pieces; /**< the convex pieces, in the body's frame; of any dimension */
    uint32_t piece_count;        /**< 1 to 4096 */
    /** A surface in place of pieces, of a static or a kinematic body: one of these two, with `pieces` NULL. */
    pir_trimesh *mesh;
    pir_height_field *field;
    /** The coarse bodies of each piece's polytope, or NULL for a piece that has none; NULL where none has. Answers that
        may be inaccurate use them: those of pir_scene_distances. */
    pir_coarse *const *coarse;
    double radius;           /**< the rounding radius, ≥ 0 */
    uint32_t category, mask; /**< bits: of what the body is; of what it meets */
    bool sensor;
    bool disabled;               /**< whether it begins disabled: it meets nothing, and no query sees it */
    uint64_t user;               /**< a number of the caller's, which events and hits tell; a pointer fits in */
    const uint64_t *piece_users; /**< one for each piece, or NULL for 0; a triangle has its material */
    /** Above 0: the body is fast, and updates tell what it meets on its way within this tolerance (pir_scene_impacts);
        not of a body with a surface. */
    double fast;
} pir_body_options;

/**
 * A moving body at the origin, not turned, without pieces or a surface yet; category 1, all in its mask, no sensor.
 * O(1).
 */
static inline pir_body_options pir_body_options_default(void) {
    pir_body_options options;
    memset(&options, 0, sizeof options);
    options.size = sizeof options;
    options.pose.rotation.w = 1;
    options.category = 1;
    options.mask = UINT32_MAX;
    return options;
}

/**
 * Adds a body, and gives its id: the least number that is free, in a generation that it never had. Its contacts begin
 * with the next update. At most 2^20 bodies; a number is given 4,095 times, then no more.
 *
 * body  its pieces and their coarse bodies, or its surface, are referenced; the rest is copied.
 *
 * Cost: O(vertices of the pieces, or triangles), and O(log n) a piece in a scene of n pieces; O(n) where a number below
 * the greatest is free.
 *
 * Errors: PIR_ERR_ARGUMENT (neither pieces nor a surface, or more than one of these, a surface that is moving, coarse
 * bodies of another polytope, a radius below 0 or infinite, a kind out of range), PIR_ERR_NOT_FINITE,
 * PIR_ERR_ZERO_QUATERNION, PIR_ERR_LIMIT (too many pieces or bodies; a coordinate of the body in the world beyond
 * 2^60), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_scene_add(pir_scene *scene, const pir_body_options *body, uint32_t *ret_body);

/**
 * Removes a body. The next update tells that its contacts ended, with the id that it had. Events of the last update
 * stay as they are; ids in them that name it are refused from now on.
 *
 * body  the id of a body of the scene.
 *
 * Cost: O(pieces · log n + pairs that it is in).
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_scene_remove(pir_scene *scene, uint32_t body);

/**
 * Where a body is: after the last update, or as it was added.
 *
 * body  the id of a body of the scene.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_scene_pose(const pir_scene *scene, uint32_t body, pir_pose *ret_pose);

/** The number in `body`, an id: below 2^20, and of bodies that are in a scene at once each has another. O(1). */
static inline uint32_t pir_body_number(uint32_t body) {
    return body & 0xfffff;
}

/** Whether a body with that id is in the scene. O(1). */
PIR_API bool pir_scene_has(const pir_scene *scene, uint32_t body);

/**
 * The body of the next greater number, the first one for PIR_SCENE_NONE; PIR_SCENE_NONE behind the last. The id need
 * not be of a body that is there: one may be removed on the way. O(1), but for numbers that are free.
 */
PIR_API uint32_t pir_scene_next(const pir_scene *scene, uint32_t body);

/** All that a scene knows of a body. */
typedef struct pir_body_state {
    pir_body_kind kind;
    pir_pose pose;
    double radius;
    uint32_t piece_count; /**< 0 of a surface */
    pir_trimesh *mesh;    /**< borrowed, or NULL */
    pir_height_field *field;
    uint32_t category, mask;
    bool sensor, disabled;
    uint64_t user;
} pir_body_state;

/**
 * The state of a body.
 *
 * body  the id of a body of the scene.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_scene_get_body(const pir_scene *scene, uint32_t body, pir_body_state *ret_state);

/**
 * A convex piece of a body.
 *
 * body, piece   the id of a body of the scene that has no surface, and the number of a piece of it.
 * ret_polytope  borrowed, for as long as the body is there; NULL where it is not wanted.
 * ret_user      the number of the caller's; NULL where it is not wanted.
 *
 * Cost: O(pieces).
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_scene_get_piece(const pir_scene *scene, uint32_t body, uint32_t piece,
                                       pir_polytope **ret_polytope, uint64_t *ret_user);

/* --- bodies that change --- */

/**
 * Gives a body another number of the caller's. Events of the next update tell it.
 *
 * body  the id of a body of the scene.
 * user  the number.
 *
 * Cost: O(1).
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_scene_set_user(pir_scene *scene, uint32_t body, uint64_t user);

/**
 * Gives a piece of a body another number of the caller's.
 *
 * body, piece  as of pir_scene_get_piece.
 * user         the number.
 *
 * Cost: O(pieces).
 *
 * Errors: PIR_ERR_ARGUMENT.
 */
PIR_API pir_status pir_scene_set_piece_user(pir_scene *scene, uint32_t body, uint32_t piece, uint64_t user);

/**
 * Changes what a body is and what it meets. Contacts with bodies that it no longer meets have ended, and the next
 * update tells so; in that update the body counts as moved. So do all changes below.
 *
 * body            the id of a body of the scene.
 * category, mask  as of pir_body_options.
 *
 * Cost: O(pairs that it is in); the next update finds its pairs anew.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_scene_set_filter(pir_scene *scene, uint32_t body, uint32_t category, uint32_t mask);

/**
 * Makes a body a sensor, or no sensor any more.
 *
 * body  the id of a body of the scene.
 *
 * Cost: as of pir_scene_set_filter.
 *
 * Errors: as of pir_scene_set_filter.
 */
PIR_API pir_status pir_scene_set_sensor(pir_scene *scene, uint32_t body, bool sensor);

/**
 * Disables a body, or enables it again. A disabled one keeps its id and may be moved, meets nothing, and is not seen by
 * queries.
 *
 * body  the id of a body of the scene.
 *
 * Cost: as of pir_scene_set_filter.
 *
 * Errors: as of pir_scene_set_filter.
 */
PIR_API pir_status pir_scene_set_disabled(pir_scene *scene, uint32_t body, bool disabled);

/* --- updates and events --- */

/** A body and its new pose. */
typedef struct pir_scene_move {
    uint32_t body;
    pir_pose pose;
} pir_scene_move;

/**
 * Brings bodies to new poses, and makes the list of events: for all contacts of bodies that are in `moves` or were
 * added or changed since the last update, and of removed ones those that they had. Contacts between others are as they
 * were, and have no event. The list before is gone, also where the call fails.
 *
 * moves, count  in any order, a body once, none of them static; a body that stays may be in it.
 *
 * Cost: O(vertices of the pieces that are moved), and a query of a pair for each two of them whose boxes meet; O(log n)
 * for a piece whose box leaves the margin that the tree has around it. Nothing for bodies that are not in `moves`.
 *
 * Errors: PIR_ERR_ARGUMENT (a body that is not there, comes twice or is static), PIR_ERR_NOT_FINITE,
 * PIR_ERR_ZERO_QUATERNION, PIR_ERR_LIMIT (coordinates beyond 2^60, more than 2^16 triangles of surfaces near one piece,
 * with PIR_SCENE_MANIFOLDS, and as of a query of a pair), PIR_ERR_MEMORY. The scene is then as it was before, but for
 * the list of events, which is empty.
 */
PIR_API pir_status pir_scene_update(pir_scene *scene, const pir_scene_move *moves, size_t count);

typedef enum pir_event_kind {
    PIR_EVENT_BEGAN = 0, /**< they are in contact, and were not before */
    PIR_EVENT_PERSISTED, /**< they are, and were */
    PIR_EVENT_ENDED,     /**< they are not any more, or a body was removed; only ids, numbers and users are set */
} pir_event_kind;

/**
 * The findings of an update about two pieces. Where the detail or a sensor leaves out a number, it is 0.
 *
 * Normals point from Q, the body of the greater number, to P. So a body on a terrain that was added before it has
 * normals that point down, into the terrain: turn them round to push it.
 *
 * A piece of a body with a surface is a triangle. pir_trimesh_triangle or pir_height_field_triangle, asked with
 * piece_p or piece_q, tells its corners and its material.
 */
typedef struct pir_scene_event {
    pir_event_kind kind;
    uint32_t body_p, body_q;             /**< ids; the number of body_p is the lower one */
    uint32_t piece_p, piece_q;           /**< of the bodies' own */
    uint64_t user_p, user_q;             /**< the caller's numbers for the bodies */
    uint64_t piece_user_p, piece_user_q; /**< and for the pieces; of a triangle its material */
    bool sensor;                         /**< whether one of the bodies is a sensor */
    pir_state state;
    /** Signed, as of pir_pair_signed_distance; in a union that of the deepest contact, or without contacts that of the
        two pieces alone. */
    double distance;
    pir_vec3 normal; /**< unit, from Q to P; of the same */
    pir_witness witness;
    /** The length by which the bodies approached at the first contact in this update, along the normal; divided by the
        time between two updates, the speed of approach. */
    double approach;
    uint32_t contact_count;
    const pir_contact
        *contacts; /**< of the scene's; ids are stable as of pir_pair_manifold; NULL where there are none */
    /** With options.reuse: no point of one piece has moved farther than this relative to the other since what is told
        here was found; 0 where all of it is of this update. At most options.reuse. See above. */
    double error;
} pir_scene_event;

/**
 * The events of the last update, until the next one, or NULL where there are none; the scene owns them. Bodies may be
 * added, changed and removed while they are read: the id of one that was removed is refused. O(1).
 */
PIR_API const pir_scene_event *pir_scene_events(const pir_scene *scene, size_t *ret_count);

/** The first meeting of a fast body on its way from pose to pose. */
typedef struct pir_scene_impact {
    uint32_t body; /**< its id */
    uint64_t user;
    pir_impact impact; /**< `time` is a part of the way in the update; what is met is its `body` */
} pir_scene_impact;

/**
 * Continuous collision: what the fast bodies that the last update moved have met on their way first, by their numbers;
 * NULL where they met nothing. The scene owns the list until the next update.
 *
 * A fast body goes from its pose before the update to the one after it, straight and turning evenly the shorter way,
 * and is held against all others as they stand after the update, as of pir_scene_time_of_impact with `fast` for a
 * tolerance. So it passes nothing that stands, however thin and however fast it is; a body that it touches at the begin
 * is met at time 0. Events are of the poses after the update: a program that is to stop a body brings it to the pose at
 * that time with the next one. Sensors and disabled bodies are neither asked about nor met. O(1).
 */
PIR_API const pir_scene_impact *pir_scene_impacts(const pir_scene *scene, size_t *ret_count);

/** The contents of a scene, and the work of its last update. */
typedef struct pir_scene_statistics {
    uint32_t bodies, pieces; /**< a surface counts as one piece */
    uint32_t triangles;      /**< of surfaces that are in pairs */
    uint32_t pairs;          /**< of pieces whose boxes in the tree meet */
    uint32_t looked;         /**< pairs that the last update looked at */
    uint32_t asked;          /**< of these, those that needed a query, or with options.reuse an earlier answer */
    uint32_t replaced;       /**< pieces whose box left its margin in the tree */
    size_t bytes;            /**< of the scene's memory in use */
    size_t peak;             /**< the most that has been */
} pir_scene_statistics;

/** The counters of `scene`. O(1). */
PIR_API pir_scene_statistics pir_scene_get_statistics(const pir_scene *scene);

/** The work of the last update, part by part. */
typedef struct pir_scene_profile {
    uint32_t moved, boxes;            /**< bodies that were brought to poses, and boxes made of their pieces */
    uint32_t replaced;                /**< pieces that left their boxes in the tree */
    uint32_t looked, asked;           /**< pairs that were looked at, and those that were asked */
    uint32_t began, persisted, ended; /**< events of each kind */
    uint32_t contacts;                /**< of all events */
    uint32_t reused;                  /**< events that tell of what was found before: their error is above 0 */
    /** With options.profile: how many questions were answered by each way (pir_pair_statistics); 0 without. */
    uint64_t by_proof, by_walk, by_nearest, by_depth, by_whole, manifolds;
    /** With options.clock, in nanoseconds: poses and boxes; the tree; pairs found; looks; questions; unions, surfaces
        among them; events, with what follows them. */
    uint64_t places_ns, tree_ns, pairs_ns, looks_ns, questions_ns, unions_ns, events_ns;
} pir_scene_profile;

/** The profile of the last update; of one that failed as far as it came. O(1). */
PIR_API pir_scene_profile pir_scene_get_profile(const pir_scene *scene);

/** A whole-structure check for tests: true when the tree, the pairs and the bodies agree. O(pairs · degree). */
PIR_API bool pir_scene_is_valid(const pir_scene *scene);

#ifdef __cplusplus
}
#endif

#endif
