/* SPDX-License-Identifier: MIT */
/*
 * Active sets: see active.h.
 *
 * The signed distance of overlapping bodies is the greatest of −slack over the facets of D. Where the two faces of a
 * facet are parallel, a small turn of a body makes several facets of this one, and a point x within it is then nearest
 * to the one at its foot: the slack is the height of a concave cap of planes. So to first order the slack changes as
 * the greatest over all points that the faces share at the foot, which a corner of their polygon attains. The distance
 * is the least over pairs of points, and so its change the least over the corners of the polygon of nearest points.
 */
#include "query/answer/active.h"

#include "query/answer/result.h"
#include "query/decide/within.h"

pir_query_input pir_active_bare(const pir_query_input *input) {
    pir_query_input bare = *input;
    bare.cutoff = fmax(input->cutoff, 0) + (input->radius_p + input->radius_q);
    bare.radius_p = bare.radius_q = 0;
    return bare;
}

/* --- members --- */

void pir_active_add(pir_active_list *list, const pir_query_result *result, pir_witness features) {
    const size_t i = list->count++;
    if (i >= list->capacity)
        return;
    pir_query_result answer = *result;
    pir_decider decider;
    pir_active *active = &list->at[i];
    if (list->arrive)
        list->arrive(list->context, &answer);
    pir_decider_set(list->frame, list->turn, &answer, features, &list->deriving, &decider);
    pir_gradient_fill(&decider, &active->p, &active->q);
    pir_result_add_radii(&list->radii, &answer);
    active->facet = list->facet;
    active->distance = answer.distance;
    active->normal = answer.normal;
    active->point_p = answer.point_p;
    active->point_q = answer.point_q;
    active->features = features;
}

/* Corners on their way to a list, all with one distance and one normal. */
struct corners {
    pir_active_list *list;
    pir_nearest at; /* in the frame */
    pir_piece decided;
};

static void add_corner(void *context, const pir_touch *corner) {
    const struct corners *corners = context;
    const pir_frame *frame = corners->list->frame;
    pir_query_result at = {.normal = corners->at.normal, .witness = corner->witness};
    at.distance = pir_frame_length(frame, corners->at.distance);
    at.point_q = pir_frame_world(frame, corner->point_q);
    at.point_p = pir_vec_add(at.point_q, pir_vec_scale(at.normal, at.distance));
    pir_active_add(corners->list, &at, pir_deciding_features(frame, corners->decided, corner->witness));
}

/* --- apart --- */

void pir_active_apart(pir_active_list *list, pir_exact *exact, const pir_placement *placement,
                      const pir_query_result *answer) {
    struct corners corners = {.list = list, .decided = {PIR_NO_PIECE, 0, 0}};
    const pir_touch_visitor visitor = {add_corner, &corners};
    const pir_frame *frame = exact->frame;
    const pir_witness faces = answer->witness;
    const pir_simplex simplex = {.count = 1,
                                 .a = {pir_face_lowest(frame->p.polytope, faces.p)},
                                 .b = {pir_face_lowest(frame->q.polytope, faces.q)}};
    if (answer->state == PIR_OUTSIDE && pir_nearest_each(exact, placement, &simplex, &corners.at, &visitor))
        return;
    list->arrive = NULL;
    pir_active_add(list, answer, faces);
}

/* --- facets --- */

/* The point of Q for a facet beside which the foot of x is: where the plane of its piece attains it. */
static pir_vec3 point_beside(const pir_frame *frame, const pir_placement *placement, const pir_facet *facet,
                             double slack) {
    if (facet->piece.kind != PIR_FACET_EE)
        return pir_facet_point(frame, placement, facet, slack);
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    const uint32_t half = p->edge_half[facet->piece.first], h = facet->piece.second;
    const pir_vec3 across = pir_vec_cross(pir_mat_apply(&frame->r, p->direction[half]), facet->n), d = q->direction[h];
    const pir_vec3 from = pir_vec_sub(placement->x, pir_frame_vertex(frame, p->origin[half], q->origin[h]));
    return pir_vec_add(frame->q.vertex[q->origin[h]], pir_vec_scale(d, pir_touch_part(from, d, across)));
}

/* The features of a piece. */
static pir_witness features_of_piece(const pir_frame *frame, pir_piece piece) {
    const pir_feature_kind facet = PIR_FEATURE_FACET, vertex = PIR_FEATURE_VERTEX;
    if (piece.kind == PIR_FACET_FV)
        return (pir_witness){{facet, piece.first}, {vertex, piece.second}};
    if (piece.kind == PIR_FACET_VF)
        return (pir_witness){{vertex, piece.first}, {facet, piece.second}};
    return pir_deciding_features(frame, piece, (pir_witness){{vertex, 0}, {vertex, 0}});
}

/* Adds the corners of a facet, the normal being turned round where `side` is −1. */
static void add_facet(pir_active_list *list, pir_exact *exact, const pir_placement *placement, const pir_facet *facet,
                      double side) {
    const pir_frame *frame = exact->frame;
    double slack;
    // a slack that rounds below zero is one of next to nothing
    const int sign = pir_facet_measure(exact, placement, facet, &slack);
    slack = sign > 0 && slack > 0 ? slack : 0;
    struct corners corners = {.list = list, .decided = facet->piece};
    corners.at.distance = 0 - slack;
    corners.at.normal = pir_vec_scale(facet->n, side);
    const pir_touch_visitor visitor = {add_corner, &corners};
    const pir_normal normal = pir_facet_normal(facet);
    const pir_meeting meeting = {&normal, facet->faces, true, slack, NULL};
    const size_t before = list->count;
    pir_touch_each(exact, placement, &meeting, &visitor);
    if (list->count == before) {
        corners.decided.kind = PIR_NO_PIECE;
        add_corner(&corners,
                   &(pir_touch){features_of_piece(frame, facet->piece), point_beside(frame, placement, facet, slack)});
    }
    list->facet++;
}

/* Bounds on the slack of an active facet. */
struct limit {
    const pir_facet *least;
    double more, doubles; /* in the caller's unit; the greatest slack by doubles, rounded up */
};

/* The first facet in order after `after` within the limit. */
static pir_least next_within(pir_query *query, const pir_placement *placement, const struct limit *limit,
                             const pir_facet *after) {
    const pir_planes *planes = query->search.groups.planes;
    pir_least next = {.found = false};
    for (uint32_t g = 0; g < query->search.groups.count; g++) {
        const pir_group *group = &query->search.groups.at[g];
        for (uint32_t i = group->start; i < group->start + group->count; i++) {
            pir_facet facet;
            if (pir_planes_slack(planes, i, placement->x) - placement->error * planes->err[i] > limit->doubles ||
                !pir_facet_of(&query->exact, planes->piece[i], &facet) || (after && !pir_facet_before(after, &facet)) ||
                (next.found && !pir_facet_before(&facet, &next.facet)) ||
                !pir_facet_within(&query->exact, placement, &facet, limit->least, limit->more))
                continue;
            next = (pir_least){true, facet};
        }
    }
    return next;
}

void pir_active_facets(pir_active_list *list, pir_query *query, const pir_placement *placement, pir_piece decided,
                       double slack) {
    pir_facet least, last;
    const bool found = pir_facet_of(&query->exact, decided, &least);
    PIR_ASSERT(found);
    if (!found)
        return;
    if (query->p->artificial && query->q->artificial) {
        // two segments: both sides of their parallelogram are of the same features
        add_facet(list, &query->exact, placement, &least, 1);
        add_facet(list, &query->exact, placement, &least, -1);
        return;
    }
    struct limit limit = {.least = &least, .more = slack};
    limit.doubles = least.h - pir_vec_dot(least.n, placement->x) + placement->error * least.err;
    limit.doubles += pir_frame_from(&query->frame, slack) * (1 + 0x1p-50) + 0x1p-1060;
    for (uint32_t g = 0; g < query->search.groups.count; g++)
        pir_group_make(&query->search.groups, g);
    for (pir_least next = next_within(query, placement, &limit, NULL); next.found;
         next = next_within(query, placement, &limit, &last)) {
        last = next.facet;
        add_facet(list, &query->exact, placement, &last, 1);
    }
}
