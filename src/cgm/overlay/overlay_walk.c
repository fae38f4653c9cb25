/* SPDX-License-Identifier: MIT */
/*
 * Walking the edges of map a through the convex faces of map b (the idea of Finke and Hinrichs, "Overlaying simply
 * connected planar subdivisions in linear time", 1995, made simple by convexity and by exact signs).
 *
 * A walk is always within a face of b, at a vertex of b, or along an edge of b. Two predicates alone lead it on: on
 * which side of the walked line a vertex of b is, and on which side of an edge of b the walk's end is.
 *   - It leaves a convex face where, counter-clockwise, vertices right of the line are followed by one that is not:
 *     through that side, or through that vertex when it is on the line. The end comes first exactly when it is left of
 *     that side, and is there when on it.
 *   - At a vertex it goes on between two neighbouring edges, one on its right and, counter-clockwise after it, one on
 *     its left, or along an edge between such two. Angles off the rim are below 180°, so there is one such place.
 *   - Along an edge, the end comes before the edge's end when it is left of the next side of the face on the left.
 *
 * Walks start at located vertices, first those of the rim, and locate the vertex where they end. Every vertex is
 * reached: a face that is convex has one boundary.
 */
#include "cgm/overlay/overlay_walk.h"

struct overlay_walk {
    struct pir_overlay *overlay;
    uint32_t map, half, line; /* of a */
    uint32_t end;             /* the vertex of a where it ends */
    uint32_t at;              /* the result's vertex where it is */
    bool begun;               /* whether it has made a piece */
};

/* The side of the walked line that vertex w of b is on. */
static int vertex_side(const struct overlay_walk *walk, uint32_t w) {
    struct pir_overlay *o = walk->overlay;
    return pir_cgm_side(&o->sides, o->a, walk->line, o->b, &o->b->vertex[w].point);
}

/* The side of halfedge h of b that the walk's end is on. */
static int end_side(const struct overlay_walk *walk, uint32_t h) {
    struct pir_overlay *o = walk->overlay;
    return pir_cgm_side(&o->sides, o->b, pir_cgm_half_line(o->b, h), o->a, &o->a->vertex[walk->end].point);
}

/* --- pieces --- */

/* Tells b's edge that the result's halfedge `half`, from vertex `start` on, is on it along its halfedge 2e. */
static void cover(struct pir_overlay *o, uint32_t start, uint32_t e, uint32_t half) {
    if (o->joint[start].b != PIR_CGM_NONE)
        o->first_cover[e] = half;
    else
        o->record[o->joint[start].record].cover = half;
}

/* The next piece, to vertex `to` of the result, on halfedge `on` of b or, when that is PIR_CGM_NONE, in face `cell`. */
static bool add_piece(struct overlay_walk *walk, uint32_t to, uint32_t on, uint32_t cell) {
    struct pir_overlay *o = walk->overlay;
    if (to == PIR_CGM_NONE)
        return false;
    uint32_t e = pir_overlay_add_edge(o, walk->at, to, walk->line, (struct pir_overlay_seam){walk->half, on, cell});
    if (e == PIR_CGM_NONE)
        return false;
    struct pir_overlay_run *run = &o->run[walk->half >> 1];
    if (walk->begun)
        o->joint[walk->at].a_mid = 2 * e;
    else
        *run = (struct pir_overlay_run){e, e, walk->half};
    run->last = e;
    walk->begun = true;
    if (on != PIR_CGM_NONE)
        cover(o, on & 1 ? to : walk->at, on >> 1, 2 * e + (on & 1));
    walk->at = to;
    return true;
}

/* The result's vertex at the walk's end, found to be at `kind`, `index` in b; it is located unless it was. */
static uint32_t arrive(struct overlay_walk *walk, enum pir_kind kind, uint32_t index) {
    struct pir_overlay *o = walk->overlay;
    uint32_t t = walk->end;
    if (o->where[t].kind != PIR_UNKNOWN)
        return o->a_vertex[t];
    uint32_t v = kind == PIR_AT_VERTEX ? pir_overlay_vertex_of_b(o, index)
                                       : pir_overlay_add_vertex(o, walk->map, &o->a->vertex[t].point, PIR_CGM_INTERIOR);
    if (v == PIR_CGM_NONE || (kind == PIR_ON_EDGE && !pir_overlay_add_record(o, v, index >> 1)))
        return PIR_CGM_NONE;
    o->joint[v].a = t;
    o->a_vertex[t] = v;
    o->where[t] = (struct pir_location){(uint8_t)kind, index};
    return v;
}

/* The result's vertex where the walk crosses halfedge h of b from left to right. */
static uint32_t cross(struct overlay_walk *walk, uint32_t h) {
    struct pir_overlay *o = walk->overlay;
    struct pir_cgm_point point = pir_cgm_meet(o->result, walk->line, pir_overlay_line(o, pir_cgm_half_line(o->b, h)));
    uint32_t v = pir_overlay_add_vertex(o, walk->map, &point, PIR_CGM_INTERIOR);
    return v != PIR_CGM_NONE && pir_overlay_add_record(o, v, h >> 1) ? v : PIR_CGM_NONE;
}

/* --- steps --- */

/* The next step: from within a face, beginning with a side whose start is right of the line; from a vertex; along an
   edge; or the end. */
enum walk_step { FACE, VERTEX, ALONG, DONE, FAILED };

struct next {
    enum walk_step step;
    uint32_t index;
};

/* Within a face, from side g on, whose start is right of the line. */
static struct next cross_face(struct overlay_walk *walk, uint32_t g) {
    const pir_cgm *b = walk->overlay->b;
    int ahead;
    while ((ahead = vertex_side(walk, pir_cgm_target(b, g))) < 0)
        g = b->half[g].next;
    uint32_t cell = b->half[g].face, w = pir_cgm_target(b, g);
    int end = end_side(walk, g);
    if (end >= 0) {
        enum pir_kind kind = end > 0 ? PIR_IN_FACE : ahead > 0 ? PIR_ON_EDGE : PIR_AT_VERTEX;
        uint32_t v = arrive(walk, kind, end > 0 ? cell : ahead > 0 ? g : w);
        return (struct next){add_piece(walk, v, PIR_CGM_NONE, cell) ? DONE : FAILED, 0};
    }
    if (ahead > 0) {
        // the side's start is right of the line, and so is where the next face's boundary goes on
        bool done = add_piece(walk, cross(walk, g), PIR_CGM_NONE, cell);
        return (struct next){done ? FACE : FAILED, b->half[g ^ 1].next};
    }
    bool done = add_piece(walk, pir_overlay_vertex_of_b(walk->overlay, w), PIR_CGM_NONE, cell);
    return (struct next){done ? VERTEX : FAILED, w};
}

/* At vertex w of b: the way on. */
static struct next leave_vertex(struct overlay_walk *walk, uint32_t w) {
    const pir_cgm *b = walk->overlay->b;
    uint32_t r = b->vertex[w].out;
    int side = vertex_side(walk, pir_cgm_target(b, r));
    for (;;) {
        uint32_t right = pir_cgm_clockwise(b, r);
        int right_side = vertex_side(walk, pir_cgm_target(b, right));
        if (side >= 0 && right_side < 0)
            return side == 0 ? (struct next){ALONG, r} : (struct next){FACE, b->half[right].next};
        r = right;
        side = right_side;
    }
}

/* Along halfedge k of b. */
static struct next follow(struct overlay_walk *walk, uint32_t k) {
    const pir_cgm *b = walk->overlay->b;
    uint32_t w = pir_cgm_target(b, k);
    int end = end_side(walk, b->half[k].next);
    if (end >= 0) {
        uint32_t v = arrive(walk, end > 0 ? PIR_ON_EDGE : PIR_AT_VERTEX, end > 0 ? k : w);
        return (struct next){add_piece(walk, v, k, PIR_CGM_NONE) ? DONE : FAILED, 0};
    }
    bool done = add_piece(walk, pir_overlay_vertex_of_b(walk->overlay, w), k, PIR_CGM_NONE);
    return (struct next){done ? VERTEX : FAILED, w};
}

/* From within an edge of b. */
static struct next leave_edge(struct overlay_walk *walk, uint32_t k) {
    const struct pir_overlay *o = walk->overlay;
    int start = vertex_side(walk, o->b->half[k].origin);
    if (start == 0) {
        bool same = pir_cgm_same_way(o->a, walk->line, o->b, pir_cgm_half_line(o->b, k));
        return (struct next){ALONG, same ? k : k ^ 1};
    }
    return (struct next){FACE, o->b->half[start > 0 ? k : k ^ 1].next};
}

/* From within a face: a side whose start is right of the line. */
static struct next leave_inside(struct overlay_walk *walk, uint32_t face) {
    const pir_cgm *b = walk->overlay->b;
    uint32_t g = b->face_half[face];
    while (vertex_side(walk, b->half[g].origin) >= 0)
        g = b->half[g].next;
    return (struct next){FACE, g};
}

static bool walk_half(struct pir_overlay *o, uint32_t map, uint32_t half) {
    uint32_t from = o->a->half[half].origin;
    struct overlay_walk walk = {.overlay = o,
                                .map = map,
                                .half = half,
                                .line = pir_cgm_half_line(o->a, half),
                                .end = pir_cgm_target(o->a, half),
                                .at = o->a_vertex[from]};
    struct pir_location where = o->where[from];
    struct next next = where.kind == PIR_AT_VERTEX ? (struct next){VERTEX, where.index}
                       : where.kind == PIR_ON_EDGE ? leave_edge(&walk, where.index)
                                                   : leave_inside(&walk, where.index);
    while (next.step < DONE)
        next = next.step == FACE     ? cross_face(&walk, next.index)
               : next.step == VERTEX ? leave_vertex(&walk, next.index)
                                     : follow(&walk, next.index);
    return next.step == DONE;
}

bool pir_overlay_walk(struct pir_overlay *o, uint32_t map) {
    const pir_cgm *a = o->a;
    uint32_t head = 0, tail = 0;
    for (uint32_t i = 0; i < a->rim[map]; i++)
        o->queue[tail++] = a->vertex_start[map] + i;
    while (head < tail) {
        uint32_t v = o->queue[head++], start = a->vertex[v].out, h = start;
        do {
            if (o->run[h >> 1].first > o->run[h >> 1].last) {
                uint32_t to = pir_cgm_target(a, h);
                bool is_new = o->where[to].kind == PIR_UNKNOWN;
                if (!walk_half(o, map, h))
                    return false;
                if (is_new)
                    o->queue[tail++] = to;
            }
            h = pir_cgm_clockwise(a, h);
        } while (h != start);
    }
    return true;
}
