/* SPDX-License-Identifier: MIT */
/*
 * The inside of a scene.
 *
 * Invariants, between calls
 *   - The tree has a leaf for each piece, and the box there holds the piece's tight box.
 *   - Of bodies that are not fresh, each two pieces that may meet and whose boxes in the tree meet have a pair. Fresh
 *     bodies have been added since the last update, and have none yet. A surface as a whole has no pairs; each of its
 *     triangles whose tight box meets a piece's box in the tree has one with that piece.
 *   - pair.touching says whether the last update that looked at the pair found a contact. Pieces whose tight boxes do
 *     not meet have none. `touching` is the number of such pairs.
 *   - There is room in `gone` for all pairs in contact besides those that it has, so that a body can always be removed.
 */
#ifndef PIR_SCENE_WORLD_SCENE_H
#define PIR_SCENE_WORLD_SCENE_H

#include <pirouette/scene_query.h>
#include <pirouette/trimesh_contact.h>

#include "base/report.h"
#include "exact/rotation.h"
#include "scene/pairs/pairs.h"
#include "scene/shapes/kept_shapes.h"
#include "scene/tasks/tasks.h"
#include "scene/tree/tree.h"
#include "scene/world/blocks.h"
#include "scene/world/bodies.h"
#include "scene/world/budget.h"

/* The numbers by which contacts are in order: of both bodies, P's first (pir_id_order), then of both pieces. */
typedef struct pir_scene_key {
    uint64_t bodies, pieces;
} pir_scene_key;

/* A contact that a worker has found. */
typedef struct pir_scene_found {
    pir_scene_key key;
    uint32_t pair, first, count; /* and its contacts, of the worker's */
    bool in_union;               /* its event is made of what was found of a union: `on_surface` of a worker */
    pir_state state;
    double distance;
    pir_vec3 normal;
    pir_witness witness;
    double error;  /* how far the bodies have moved since what the event tells was found; with options.reuse */
    uint32_t news; /* and in which worker's list the rest of it is, under which number */
    uint32_t news_worker;
} pir_scene_found;

/* The part of a contact that records are brought up to date with: of scenes with options.reuse. */
typedef struct pir_scene_news {
    pir_seen seen;                  /* where the bodies are now */
    pir_vec3 told_normal;           /* of an answer that is new, where contacts are not */
    pir_vec3 told_point[2];         /* and its points */
    bool new_answer, new_contacts;  /* whether the pair was asked for these */
    uint32_t union_room, members;   /* of a union that was asked anew: contacts for the record; its pairs */
    uint64_t union_number;          /* or 0 */
    pir_kept_record *kept, *united; /* records with more room than those of the pair, or NULL */
} pir_scene_news;

/* A pair to be asked, or else one whose contact has ended. */
typedef struct pir_scene_noted {
    uint32_t pair;
    bool asks;
} pir_scene_noted;

/* Memory that belongs to one task at a time. */
typedef struct pir_scene_worker {
    pir_workspace *workspace;
    pir_scene_noted *noted;
    uint32_t noted_capacity, noted_count, looked;
    pir_scene_found *found;
    uint32_t found_capacity, found_count;
    pir_scene_news *news; /* of these, in their order, where manifolds may be told again */
    uint32_t news_capacity;
    pir_scene_found *on_surface; /* those of unions: surfaces, pieces side by side */
    uint32_t on_surface_capacity, on_surface_count;
    pir_contact *contact;
    uint32_t contact_capacity, contact_count;
    pir_posed_surface *surface; /* of a question about surfaces, and what it is answered by */
    pir_surface_contact *met;
    const pir_polytope **beside; /* the pieces next to the one that is asked */
    uint64_t *near_triangle;     /* those that it is asked about, where no other is near */
    uint32_t surface_capacity, met_capacity, beside_capacity, near_triangle_capacity;
    pir_pair_statistics ways;                    /* of its questions, where they are counted */
    uint32_t told[3], told_contacts, told_again; /* events of each kind, contacts of all, those told again */
    pir_status status; /* of the item with the least number that failed, in this batch of work */
    uint32_t failed;
} pir_scene_worker;

/* A contact that ended between updates, for one of its bodies was removed or changed: the next update tells it. */
typedef struct pir_scene_gone {
    pir_scene_key key;
    uint64_t user[2], piece_user[2];
    bool sensor;
} pir_scene_gone;

/* An event to be: what was found of a pair, or NULL where the contact ended. Of what is gone the pair is none, and
   `group` its place in the list. */
typedef struct pir_scene_item {
    pir_scene_key key;
    const pir_scene_worker *worker;
    pir_scene_found *found;
    uint32_t pair;
    uint32_t group; /* the first item of its union, in a run of items of one piece */
} pir_scene_item;

/* A body that an update brings to a place. */
typedef struct pir_scene_moved {
    uint32_t body, first; /* of its boxes */
    pir_pose pose;        /* where to */
    pir_place place;      /* the same, once it has been checked */
} pir_scene_moved;

/* A piece that got a new box in the tree, and the one before. */
typedef struct pir_scene_replaced {
    uint32_t piece;
    bool moved; /* in the tree; a fresh piece that was not is here as well */
    pir_box before;
} pir_scene_replaced;

/* The lists of an update; the memory stays. */
typedef struct pir_scene_lists {
    pir_scene_moved *moved;
    pir_box *box; /* of the pieces of those */
    pir_scene_replaced *replaced;
    uint32_t *asked, *ended; /* pairs */
    uint32_t *triangle;      /* those of a surface that a box meets */
    uint32_t *run;           /* where items of one piece begin */
    pir_scene_item *item, *work;
    uint32_t moved_capacity, box_capacity, replaced_capacity, asked_capacity, ended_capacity, triangle_capacity,
        run_capacity, item_capacity, work_capacity;
    uint32_t moved_count, replaced_count, asked_count, ended_count;
} pir_scene_lists;

/* Scratch of rays that doubles do not settle; made when it is first needed. */
typedef struct pir_exact_room {
    pir_limbs limbs;
    pir_rotation_integers *integers;
} pir_exact_room;

/* A hit of a shape that moves, and how deep the shape begins in what it meets; below 0 where it does not. */
typedef struct pir_scene_met {
    pir_impact impact;
    double depth;
} pir_scene_met;

/* Answers of a query as they are found; the caller's arrays are filled once it has succeeded. The memory stays. */
typedef struct pir_scene_answers {
    pir_scene_hit *hit;
    pir_scene_near *near;
    pir_scene_distance *distance;
    pir_impact *impact;
    pir_scene_met *met;
    uint32_t hit_capacity, near_capacity, distance_capacity, impact_capacity, met_capacity;
} pir_scene_answers;

/* A body that a restore takes away, or the number that it gives to one that it makes. */
typedef struct pir_scene_away {
    uint32_t number, box; /* the first of its boxes in the tree */
    pir_scene_body body;  /* as it was */
    bool is_made;         /* whether another stands there now */
} pir_scene_away;

/* A body that stays, as it was before a restore changed it. */
typedef struct pir_scene_changed {
    uint32_t number, category, mask;
    bool sensor, disabled, fresh;
} pir_scene_changed;

/* The lists of a restore; the memory stays. */
typedef struct pir_scene_target {
    pir_scene_away *away;
    pir_box *box; /* in the tree, of the pieces of those */
    pir_scene_changed *changed;
    pir_polytope **piece; /* of a body that is made */
    pir_coarse **coarse;
    uint32_t away_capacity, box_capacity, changed_capacity, piece_capacity, coarse_capacity;
    uint32_t away_count, box_count, changed_count;
} pir_scene_target;

struct pir_scene {
    pir_budget budget;
    pir_allocator allocator; /* of the budget */
    pir_blocks blocks;       /* of the polytopes of triangles */
    pir_allocator for_triangles;
    pir_scene_detail detail;
    double margin, reuse;
    bool approach, unions, keep_shapes;
    pir_report *report; /* the caller's, or NULL */
    uint32_t threads;
    pir_tasks tasks;
    pir_task_pool *pool; /* or NULL: the tasks are the caller's, or none */
    pir_scene_worker *worker;

    pir_bodies bodies;
    pir_kept_shapes shapes;
    pir_tree tree;
    pir_scene_pairs pairs;
    pir_pair *spare; /* of queries, or NULL */
    pir_exact_room exact_room;
    pir_scene_answers answers;
    uint32_t *fresh; /* bodies added or changed since the last update */
    uint32_t fresh_capacity, fresh_count;
    pir_scene_gone *gone;
    uint32_t gone_capacity, gone_count, touching;

    uint64_t update, visit; /* numbers of the last ones */
    uint64_t unions_asked;  /* numbers up to this have been given to unions */
    bool profiles;
    uint64_t (*clock)(void *context); /* or NULL */
    void *clock_context;
    uint64_t part_began; /* by the clock */
    pir_scene_profile profile;
    pir_scene_lists lists;
    pir_scene_target target;
    pir_scene_event *event;
    uint32_t event_capacity, event_count, looked;
    pir_scene_impact *impact; /* of fast bodies, by number */
    uint32_t impact_capacity, impact_count;
};

/* A piece's box in the tree: its tight one, wider by a margin, and on along `way`. */
pir_box pir_scene_fat_box(const pir_box *tight, pir_vec3 way);

/* The width by which boxes of pieces reach beyond these on each side: the radius, and half of the margin. */
static inline double pir_scene_around(const pir_scene *scene, const pir_scene_body *body) {
    return body->radius + 0.5 * scene->margin;
}

static inline pir_scene_news *pir_scene_news_of(const pir_scene *scene, const pir_scene_found *found) {
    return &scene->worker[found->news_worker].news[found->news];
}

/* Distances in doubles are within this of the exact ones, with room to spare. */
static inline double pir_scene_distance_error(const pir_scene_body *p, const pir_scene_body *q) {
    return 1e-11 * (p->reach + q->reach + p->radius + q->radius + pir_vec_length(p->pose.translation) +
                    pir_vec_length(q->pose.translation));
}

/* Gives the pieces of a body that was put in their boxes, those of scene->lists.box from `box` on, and leaves. */
void pir_scene_put_leaves(pir_scene *scene, uint32_t body, const pir_box *box);

/* The boxes of a body to be, for which there is room from `box` on. PIR_ERR_LIMIT, told. */
pir_status pir_scene_body_boxes(const pir_scene *scene, const pir_body_options *body, const pir_place *place,
                                pir_box *box);

/* PIR_ERR_ARGUMENT where there is no scene, or a parameter is `missing`: the name of one that is NULL, or NULL. */
pir_status pir_scene_given(const pir_scene *scene, const char *call, const char *missing);

/* The id of the body on a side of a key. */
static inline uint32_t pir_key_body(pir_scene_key key, int side) {
    return pir_id_of_order((uint32_t)(key.bodies >> (side == 0 ? 32 : 0)));
}

/* Errors of a batch of work: begins one; keeps what became of an item; the error of the first that failed. */
static inline void pir_scene_workers_begin(pir_scene *scene) {
    for (uint32_t i = 0; i < scene->threads; i++) {
        scene->worker[i].status = PIR_OK;
        scene->worker[i].failed = UINT32_MAX;
    }
}

static inline void pir_scene_worker_note(pir_scene_worker *worker, pir_status status, uint32_t item) {
    if (status != PIR_OK && item < worker->failed) {
        worker->status = status;
        worker->failed = item;
    }
}

/* The least number of an item that failed. */
static inline uint32_t pir_scene_workers_failed(const pir_scene *scene) {
    uint32_t first = UINT32_MAX;
    for (uint32_t i = 0; i < scene->threads; i++)
        first = scene->worker[i].failed < first ? scene->worker[i].failed : first;
    return first;
}

static inline pir_status pir_scene_workers_status(const pir_scene *scene) {
    const pir_scene_worker *first = &scene->worker[0];
    for (uint32_t i = 1; i < scene->threads; i++)
        if (scene->worker[i].failed < first->failed)
            first = &scene->worker[i];
    return first->status;
}

#endif
