/* SPDX-License-Identifier: MIT */
/*
 * Contact manifolds: where the contact patches of two bodies lie over each other along the normal of an answer.
 *
 * Each body's patch grows from its feature of the answer (patch.h). Where only one of the two has an area, the other
 * body is tilted. Its patch then grows by the facet that faces the first body most. The outlines are projected along
 * the normal, and the corners of their overlap (outline.h) are lifted onto the surfaces of both bodies. So every
 * contact lies on both bodies, however the patches are made.
 *
 * A patch that is one facet across the normal, as of boxes that rest, has its outline without growing, to the bit. Most
 * answers need less, and each of these is used where it is certain to be the same but for rounding:
 *
 *   - two features without an area, from which nothing grows and which are not parallel, share nothing: the answer is
 *     the one contact;
 *   - a vertex carried by a facet, where no other corner is near, is the one contact;
 *   - two patches of one facet each (single.h), tilted or both across the normal, in general position (clip.h) share
 *     corners that need no merging, and these lie on the two facets' planes.
 */
#include "query/contact/manifold.h"

#include "query/contact/clip.h"
#include "query/contact/single.h"

/* An id holds a kind in its top two bits and two indices. This kind is that of an answer that is no corner. */
#define ID_OF_ANSWER 3

struct manifold {
    const pir_frame *frame;
    pir_patch_room *room;
    const pir_query_result *answer;
    pir_patch *p, *q;
    pir_vec3 n;
    pir_vec3 axis[3];       /* two of the contact plane, and n = axis[0] × axis[1] */
    bool is_single;         /* both patches are single facets */
    pir_vec3 point;         /* the answer's on Q's polytope, in the frame */
    pir_corner of_answer;   /* that in the plane */
    double coarse;          /* a corner this near it is the same */
    double radius_p, radii; /* radius_p + radius_q */
    double limit;           /* corners up to this distance are kept */
};

/* --- the caller's answer --- */

/* All ones where something holds. */
static inline uint32_t where(bool holds) {
    return 0 - (uint32_t)holds;
}

static inline bool is_feature(const pir_polytope *p, pir_feature feature) {
    uint32_t count = (p->vertex_count & where(feature.kind == PIR_FEATURE_VERTEX)) |
                     (p->edge_count & where(feature.kind == PIR_FEATURE_EDGE)) |
                     (p->facet_count & where(feature.kind == PIR_FEATURE_FACET));
    return feature.index < count;
}

/* Whether an answer can be one about these bodies. */
static inline bool is_usable(const pir_frame *frame, const pir_query_result *answer) {
    double square = pir_vec_dot(answer->normal, answer->normal);
    const pir_vec3 *p = &answer->point_p, *q = &answer->point_q;
    // of a number that is not finite the product with 0 is no number; two at once
    double even = p->x * 0 + p->z * 0 + q->y * 0, odd = p->y * 0 + q->x * 0 + q->z * 0;
    const bool of_p = is_feature(frame->p.polytope, answer->witness.p),
               of_q = is_feature(frame->q.polytope, answer->witness.q);
    // ours are unit vectors within a few 2^-53; a caller may keep them in single precision
    return (fabs(square - 1) < 0x1p-20) & (even + odd + answer->distance * 0 == 0) & of_p & of_q;
}

/* --- setting up --- */

static inline void set_patch(pir_patch *patch, const pir_body *body, pir_vec3 out) {
    patch->polytope = body->polytope;
    patch->vertex = body->vertex;
    patch->kept = pir_body_shapes(body);
    patch->r = NULL;
    patch->sign = 1;
    patch->at = (pir_vec3){0, 0, 0};
    patch->out = out;
}

/* Sets two unit vectors across n, from the coordinate axis that is least along n. */
static inline void set_axes(struct manifold *m) {
    double x = fabs(m->n.x), y = fabs(m->n.y), z = fabs(m->n.z);
    pir_vec3 least = {(x <= y) & (x <= z), (y < x) & (y <= z), (z < x) & (z < y)};
    pir_vec3 across = pir_vec_cross(m->n, least);
    m->axis[0] = pir_vec_scale(across, 1 / sqrt(pir_vec_dot(across, across)));
    m->axis[1] = pir_vec_cross(m->n, m->axis[0]);
    m->axis[2] = m->n;
}

/* The answer's point on Q's polytope, in the frame. */
static inline pir_vec3 point_of_answer(const struct manifold *m, double radius_q) {
    const pir_frame *frame = m->frame;
    pir_vec3 w = pir_vec_sub(m->answer->point_q, pir_vec_scale(m->n, radius_q)), c = pir_dd3_round(frame->q.centre);
    pir_vec3 y = {pir_frame_from(frame, w.x), pir_frame_from(frame, w.y), pir_frame_from(frame, w.z)};
    return pir_vec_sub(y, c);
}

static inline void begin(struct manifold *m, const pir_frame *frame, const pir_placement *placement,
                         pir_patch_room *room, const pir_query_result *answer) {
    m->frame = frame;
    m->room = room;
    m->answer = answer;
    m->p = &room->p;
    m->q = &room->q;
    m->n = answer->normal;
    set_patch(m->q, &frame->q, m->n);
    set_patch(m->p, &frame->p, pir_vec_scale(m->n, -1));
    // P is stored reflected
    m->p->r = &frame->r;
    m->p->sign = -1;
    m->p->at = placement->x;
    m->p->snap = m->q->snap = PIR_SNAP * placement->reach;
}

/* fmax of numbers, in place. */
static inline double greater(double a, double b) {
    return a > b ? a : b;
}

/* Sets the lengths that corners are measured by. */
static inline void set_measures(struct manifold *m, const pir_query_input *input, const pir_placement *placement) {
    const pir_query_result *answer = m->answer;
    double error = pir_frame_length(m->frame, 4 * placement->error);
    m->radius_p = input->radius_p;
    m->radii = input->radius_p + input->radius_q;
    m->limit = greater(greater(input->margin, answer->distance), 0) + error;
    m->point = point_of_answer(m, input->radius_q);
    // the rounding of points in world coordinates grows with those
    double far = fabs(answer->point_q.x) + fabs(answer->point_q.y) + fabs(answer->point_q.z);
    m->coarse = 4 * m->p->snap + 0x1p-50 * pir_frame_from(m->frame, far);
}

static inline void set_plane(struct manifold *m) {
    set_axes(m);
    m->of_answer = (pir_corner){.u = pir_vec_dot(m->axis[0], m->point), .v = pir_vec_dot(m->axis[1], m->point)};
}

/* --- overlaps --- */

/* Whether the patches are a vertex or an edge each that share at most one point. */
static inline bool is_alone(const struct manifold *m) {
    pir_feature p = m->answer->witness.p, q = m->answer->witness.q;
    if (p.kind == PIR_FEATURE_FACET || q.kind == PIR_FEATURE_FACET || !pir_patch_is_sharp(m->p, p) ||
        !pir_patch_is_sharp(m->q, q))
        return false;
    if (p.kind == PIR_FEATURE_VERTEX || q.kind == PIR_FEATURE_VERTEX)
        return true;
    const pir_polytope *of_p = m->p->polytope, *of_q = m->q->polytope;
    pir_vec3 along = pir_mat_apply(m->p->r, of_p->direction[of_p->edge_half[p.index]]);
    pir_vec3 across = pir_vec_cross(along, of_q->direction[of_q->edge_half[q.index]]);
    // the sine as seen along the normal is at least this
    return fabs(pir_vec_dot(across, m->n)) > 2 * PIR_FLUSH;
}

/* The answer's points, in the frame. */
struct ends {
    pir_vec3 on_p, on_q;
};

static inline struct ends ends_of(const struct manifold *m) {
    double distance = pir_frame_from(m->frame, m->answer->distance + m->radii);
    return (struct ends){pir_vec_add(m->point, pir_vec_scale(m->n, distance)), m->point};
}

/* Whether a vertex of P or of Q is the answer's point. */
static inline bool is_at_vertex(const struct manifold *m, const struct ends *ends, bool of_p) {
    const pir_patch *vertex = of_p ? m->p : m->q;
    uint32_t v = of_p ? m->answer->witness.p.index : m->answer->witness.q.index;
    pir_vec3 off = pir_vec_sub(pir_patch_vertex(vertex, v), of_p ? ends->on_p : ends->on_q);
    return pir_vec_dot(off, off) <= m->coarse * m->coarse;
}

/* Whether a vertex is the answer's point, carried by a facet of the other body, and no other corner is near. */
static inline bool is_lone_vertex(const struct manifold *m, const pir_single *p, const pir_single *q) {
    bool is_p = p->half != UINT32_MAX;
    if (!is_p && q->half == UINT32_MAX)
        return false;
    struct ends ends = ends_of(m);
    if (!is_at_vertex(m, &ends, is_p))
        return false;
    double height = pir_frame_from(m->frame, m->limit - m->answer->distance) * (1 + 0x1p-20);
    const pir_lone_place place = {is_p ? ends.on_q : ends.on_p, m->coarse, height};
    return is_p ? pir_patch_is_lone(m->p, p, m->q, q, &place) : pir_patch_is_lone(m->q, q, m->p, p, &place);
}

/* The single facets of both patches, where at least one has an area. */
static inline bool find_singles(const struct manifold *m, pir_single *ret_p, pir_single *ret_q) {
    pir_feature p = m->answer->witness.p, q = m->answer->witness.q;
    return (p.kind == PIR_FEATURE_FACET || q.kind == PIR_FEATURE_FACET) && pir_patch_single(m->p, p, ret_p) &&
           pir_patch_single(m->q, q, ret_q);
}

/* The facets of both patches, where each is one facet across the normal. */
static inline bool find_flats(const struct manifold *m, pir_single *ret_p, pir_single *ret_q) {
    *ret_p = (pir_single){pir_patch_flat(m->p, m->answer->witness.p), UINT32_MAX, 1};
    if (ret_p->facet == PIR_NO_FACET)
        return false;
    *ret_q = (pir_single){pir_patch_flat(m->q, m->answer->witness.q), UINT32_MAX, 1};
    return ret_q->facet != PIR_NO_FACET;
}

/* The corners that two single facets share, in the room; PIR_CLIP_UNCLEAR where growing and merging have to tell. */
static uint32_t overlap_singles(struct manifold *m) {
    pir_single p, q;
    bool found = find_singles(m, &p, &q);
    if (found && is_lone_vertex(m, &p, &q))
        return 0;
    set_plane(m);
    if (!found && !find_flats(m, &p, &q))
        return PIR_CLIP_UNCLEAR;
    pir_clip_places places;
    if (!m->p->version->place(m->p, &p, m->q, &q, m->axis, &places))
        return PIR_CLIP_UNCLEAR;
    return pir_clip_corners(m->p->outline, m->q->outline, m->p->snap, &places, m->room->shared);
}

/* Grows a patch from a feature, and sets its outline. */
static void grow(pir_patch *patch, pir_feature feature, const pir_vec3 axis[2], pir_corner *room) {
    uint32_t facet = pir_patch_flat(patch, feature);
    if (facet != PIR_NO_FACET) {
        pir_patch_set_flat(patch, facet, axis, room);
        return;
    }
    pir_patch_grow(patch, feature);
    pir_patch_set_outline(patch, axis, room);
    if (patch->outline.count > 2 && pir_patch_complete(patch))
        pir_patch_set_outline(patch, axis, room);
}

/* Grows both patches until each has an outline. Returns the number of corners that they share, in the room. */
static uint32_t overlap(struct manifold *m) {
    pir_patch_room *room = m->room;
    pir_patch *both[2] = {m->p, m->q};
    grow(m->p, m->answer->witness.p, m->axis, room->hull);
    grow(m->q, m->answer->witness.q, m->axis, room->hull);
    // a body without an area is tilted where it meets the other's area
    for (int k = 0; k < 2; k++)
        if (both[1 - k]->outline.count > 2)
            while (both[k]->outline.count < 3 && pir_patch_extend(both[k]))
                pir_patch_set_outline(both[k], m->axis, room->hull);
    uint32_t count = pir_outline_overlap(m->p->outline, m->q->outline, m->p->snap, PIR_FLUSH, room->shared);
    pir_patch_clear(m->p);
    pir_patch_clear(m->q);
    if (count > 0) {
        pir_patch_look_around(m->p);
        pir_patch_look_around(m->q);
    }
    return pir_outline_hull(room->shared, count, m->p->snap, room->hull);
}

/* --- contacts --- */

/* The fraction of side `side` of an outline at which it is nearest to x. */
static double along_side(const pir_outline *outline, uint32_t side, const pir_corner *x) {
    const pir_corner *a = &outline->at[side], *b = &outline->at[side + 1 < outline->count ? side + 1 : 0];
    double u = b->u - a->u, v = b->v - a->v, part = (u * (x->u - a->u) + v * (x->v - a->v)) / (u * u + v * v);
    return fmin(1, fmax(0, part));
}

/* The id of a side: the vertex that it leads from, or a segment's lower vertex. */
static uint64_t side_id(const pir_outline *outline, uint32_t side) {
    uint32_t v = outline->at[side].p;
    return outline->count > 2 || v < outline->at[1 - side].p ? v : outline->at[1 - side].p;
}

static uint64_t make_id(uint64_t kind, uint64_t first, uint64_t second) {
    return kind << 62 | first << 31 | second;
}

static inline uint64_t corner_id(const struct manifold *m, const pir_corner *corner) {
    switch (corner->kind) {
    case PIR_CORNER_P:
        return make_id(PIR_CORNER_P, m->p->outline.at[corner->p].p, 0);
    case PIR_CORNER_Q:
        return make_id(PIR_CORNER_Q, m->q->outline.at[corner->q].p, 0);
    default:
        return make_id(PIR_CORNER_CROSSING, side_id(&m->p->outline, corner->p), side_id(&m->q->outline, corner->q));
    }
}

/* The point of a patch over a corner. A segment gives its nearest point. */
static pir_vec3 beside(const pir_patch *patch, const pir_corner *corner, pir_vec3 x) {
    return patch->outline.count > 2 ? pir_patch_lift(patch, x)
                                    : pir_patch_side(patch, 0, along_side(&patch->outline, 0, corner));
}

/* A contact between a point of Q's polytope, in the frame, and the one over it. */
static inline pir_contact contact_at(const struct manifold *m, const pir_corner *corner, pir_vec3 q, double distance) {
    pir_vec3 from = pir_vec_add(pir_frame_world(m->frame, q), pir_vec_scale(m->n, m->radii - m->radius_p));
    return (pir_contact){pir_vec_add(from, pir_vec_scale(m->n, distance)), from, distance, corner_id(m, corner)};
}

/* Whether two points are over each other along the normal. */
static inline bool is_over(const struct manifold *m, pir_vec3 p, pir_vec3 q) {
    pir_vec3 off = pir_vec_sub(p, q);
    double along = pir_vec_dot(m->n, off), most = PIR_OVER * m->p->snap;
    pir_vec3 across = pir_vec_sub(off, pir_vec_scale(m->n, along));
    return pir_vec_dot(across, across) <= most * most;
}

/*
 * The points of both patches at a corner. Edges that are nearly parallel, and sides at a sharp corner, pass each other:
 * then one of the points stays, and the other is over or under it, on a facet beside the edge. False where there is
 * none.
 */
static bool find_points(const struct manifold *m, const pir_corner *corner, pir_vec3 *ret_p, pir_vec3 *ret_q) {
    pir_vec3 p, q;
    if (corner->kind == PIR_CORNER_P) {
        p = pir_patch_vertex(m->p, m->p->outline.at[corner->p].p);
        q = beside(m->q, corner, p);
    } else if (corner->kind == PIR_CORNER_Q) {
        q = pir_patch_vertex(m->q, m->q->outline.at[corner->q].p);
        p = beside(m->p, corner, q);
    } else {
        p = pir_patch_side(m->p, corner->p, along_side(&m->p->outline, corner->p, corner));
        q = pir_patch_side(m->q, corner->q, along_side(&m->q->outline, corner->q, corner));
    }
    bool found = is_over(m, p, q) || (corner->kind != PIR_CORNER_P && pir_patch_find(m->p, q, &p)) ||
                 (corner->kind != PIR_CORNER_Q && pir_patch_find(m->q, p, &q));
    *ret_p = p;
    *ret_q = q;
    return found;
}

/* Whether a corner is near enough to be a contact. */
static inline bool is_near(const struct manifold *m, const pir_corner *corner, double distance) {
    if (distance <= m->limit)
        return true;
    const pir_corner *a = &m->of_answer;
    double more = distance - m->answer->distance;
    // the way is no longer than both its parts: most that are too far are so by that
    if (more > 2 * PIR_FLUSH * pir_frame_length(m->frame, fabs(corner->u - a->u) + fabs(corner->v - a->v)))
        return false;
    return more <= PIR_FLUSH * pir_frame_length(m->frame, pir_outline_distance(corner, a));
}

/* The contact at a corner of grown patches; false where there is none. */
static bool contact_of_patches(const struct manifold *m, const pir_corner *corner, pir_contact *ret_contact) {
    pir_vec3 p, q;
    if (!find_points(m, corner, &p, &q))
        return false;
    double distance = pir_frame_length(m->frame, pir_vec_dot(m->n, pir_vec_sub(p, q))) - m->radii;
    *ret_contact = contact_at(m, corner, q, distance);
    // sides that meet at a corner may be apart there by rounding
    ret_contact->point_p = pir_vec_sub(pir_frame_world(m->frame, p), pir_vec_scale(m->n, m->radius_p));
    return is_near(m, corner, distance);
}

/*
 * The id of the answer's own contact: as a corner, a vertex where one of its features is one, otherwise the two
 * features.
 */
static uint64_t answer_id(const struct manifold *m, bool is_corner) {
    pir_feature p = m->answer->witness.p, q = m->answer->witness.q;
    if (is_corner && p.kind == PIR_FEATURE_VERTEX)
        return make_id(PIR_CORNER_P, p.index, 0);
    if (is_corner && q.kind == PIR_FEATURE_VERTEX)
        return make_id(PIR_CORNER_Q, q.index, 0);
    uint64_t kinds = (uint64_t)(p.kind - PIR_FEATURE_VERTEX) * 3 + (uint64_t)(q.kind - PIR_FEATURE_VERTEX);
    return make_id(ID_OF_ANSWER, kinds << 27 ^ p.index, q.index);
}

/* The corner that is the answer's own point, or `count` where none is. */
static inline uint32_t corner_of_answer(const struct manifold *m, uint32_t count) {
    const pir_corner *corner = m->room->shared, *a = &m->of_answer;
    for (uint32_t i = 0; i < count; i++) {
        // most are so far that one coordinate tells
        bool near = fabs(corner[i].u - a->u) <= 2 * m->coarse && fabs(corner[i].v - a->v) <= 2 * m->coarse;
        if (near && pir_outline_distance(&corner[i], a) <= m->coarse)
            return i;
    }
    return count;
}

/* The contact at a corner; false where it is too far apart. */
static inline bool make_contact(const struct manifold *m, const pir_corner *corner, pir_contact *ret_contact) {
    if (!m->is_single)
        return contact_of_patches(m, corner, ret_contact);
    double p = pir_patch_height(m->p, corner), q = pir_patch_height(m->q, corner);
    double distance = pir_frame_length(m->frame, p - q) - m->radii;
    if (!is_near(m, corner, distance))
        return false;
    pir_vec3 in_plane = pir_vec_add(pir_vec_scale(m->axis[0], corner->u), pir_vec_scale(m->axis[1], corner->v));
    *ret_contact = contact_at(m, corner, pir_vec_add(in_plane, pir_vec_scale(m->n, q)), distance);
    return true;
}

/* Puts the answer as the first contact. `own` of `corners` is its corner, where there is one. */
static inline size_t put_answer(const struct manifold *m, const pir_manifold_ask *ask, uint32_t own, uint32_t corners,
                                pir_contact *ret_contacts) {
    const pir_query_result *answer = m->answer;
    if (ask->capacity > 0) {
        uint64_t id = own < corners ? corner_id(m, &m->room->shared[own]) : answer_id(m, corners == 0);
        ret_contacts[0] = (pir_contact){answer->point_p, answer->point_q, answer->distance, id};
    }
    return 1;
}

/* Puts all contacts, as far as there is room for them, and returns their number. */
static size_t put_contacts(struct manifold *m, const pir_placement *placement, const pir_manifold_ask *ask,
                           pir_contact *ret_contacts) {
    set_measures(m, ask->input, placement);
    uint32_t corners = overlap_singles(m);
    m->is_single = corners != PIR_CLIP_UNCLEAR;
    corners = m->is_single ? corners : overlap(m);
    uint32_t own = corner_of_answer(m, corners);
    size_t count = put_answer(m, ask, own, corners, ret_contacts);
    for (uint32_t i = own < corners; i < corners; i++) {
        pir_contact contact;
        uint32_t k = own < corners ? own + i : i;
        k -= k < corners ? 0 : corners;
        if (!make_contact(m, &m->room->shared[k], &contact))
            continue;
        if (count < ask->capacity)
            ret_contacts[count] = contact;
        count++;
    }
    return count;
}

/* --- the calls --- */

pir_status pir_manifold_find(const pir_frame *frame, const pir_placement *placement, pir_patch_room *room,
                             const pir_manifold_ask *ask, pir_contact *ret_contacts, size_t *ret_count) {
    const pir_query_result *answer = ask->answer;
    if (isnan(ask->input->margin))
        return PIR_ERR_NOT_FINITE;
    bool has_points = answer->outcome != PIR_BEYOND_CUTOFF && answer->outcome != PIR_NO_HIT;
    if (!(ask->input->margin >= 0) || (has_points && !is_usable(frame, answer)))
        return PIR_ERR_ARGUMENT;
    if (!has_points) {
        *ret_count = 0;
        return PIR_OK;
    }
    struct manifold m;
    begin(&m, frame, placement, room, answer);
    *ret_count =
        is_alone(&m) ? put_answer(&m, ask, 0, 0, ret_contacts) : put_contacts(&m, placement, ask, ret_contacts);
    return PIR_OK;
}
