/* SPDX-License-Identifier: MIT */
/* The least slack from the foot of x: see foot.h. */
#include "query/last/foot.h"

/* What a distance in the plane of F is off by, in units of the placement's error and the facet's: see touch.c. */
#define MARGIN_ERRORS 16

/* Faces with more vertices are not looked at. */
#define MOST_VERTICES 32

/* A face as it stands in D: its vertices in order, and the unit vectors from each to the next; an edge has two. */
struct face {
    uint32_t count;
    pir_vec3 at[MOST_VERTICES], along[MOST_VERTICES];
};

/* One vertex of it, with the halfedge that leads on from there. */
static void put_vertex(const pir_body *body, const pir_mat3 *r, uint32_t vertex, uint32_t half, struct face *face) {
    pir_vec3 at = body->vertex[vertex], along = {0, 0, 0};
    if (half != UINT32_MAX)
        along = body->polytope->direction[half];
    face->at[face->count] = r ? pir_mat_apply(r, at) : at;
    face->along[face->count++] = r ? pir_mat_apply(r, along) : along;
}

/* A face of P, turned by r, or of Q, r being NULL; false where it has too many vertices. */
static bool make_face(const pir_body *body, const pir_mat3 *r, pir_feature feature, struct face *face) {
    const pir_polytope *p = body->polytope;
    face->count = 0;
    if (feature.kind == PIR_FEATURE_VERTEX) {
        put_vertex(body, r, feature.index, UINT32_MAX, face);
    } else if (feature.kind == PIR_FEATURE_EDGE) {
        uint32_t half = p->edge_half[feature.index];
        put_vertex(body, r, p->origin[half], half, face);
        put_vertex(body, r, p->target[half], p->twin[half], face);
    } else {
        uint32_t start = p->loop_start[feature.index], end = p->loop_start[feature.index + 1];
        if (end - start > MOST_VERTICES)
            return false;
        for (uint32_t i = start; i < end; i++)
            put_vertex(body, r, p->origin[p->loop[i]], p->loop[i], face);
    }
    return true;
}

/* How far y is within the sides of F that are along those of `face`: `other` is the other body's. */
static double margin_along(const struct face *face, const struct face *other, pir_vec3 n, pir_vec3 y) {
    double margin = HUGE_VAL;
    for (uint32_t i = 0; face->count > 1 && i < face->count; i++) {
        pir_vec3 in = pir_vec_cross(n, face->along[i]);
        double least = HUGE_VAL;
        for (uint32_t k = 0; k < other->count; k++) {
            double along = pir_vec_dot(in, other->at[k]);
            least = along < least ? along : least;
        }
        double within = pir_vec_dot(in, pir_vec_sub(y, face->at[i])) - least;
        margin = within < margin ? within : margin;
    }
    return margin;
}

/*
 * The distance of y from the rim of F; negative outside, or where it is not known. F is the sum of two faces, so
 * each of its sides is along a side of one of them and through the vertex of the other that is farthest across it.
 */
static double margin_of(const pir_frame *frame, const pir_facet *facet, pir_vec3 y) {
    struct face p, q;
    if (!make_face(&frame->p, &frame->r, facet->faces.p, &p) || !make_face(&frame->q, NULL, facet->faces.q, &q))
        return -1;
    double of_p = margin_along(&p, &q, facet->n, y), of_q = margin_along(&q, &p, facet->n, y);
    return of_p < of_q ? of_p : of_q;
}

/* The vertex of D at the landmarks along a direction. */
static pir_vec3 landmark(const pir_frame *frame, pir_vec3 along) {
    pir_vec3 turned = pir_mat_apply_transposed(&frame->r, along);
    uint32_t a = frame->p.landmarks[pir_landmark_of(turned)], b = frame->q.landmarks[pir_landmark_of(along)];
    return pir_frame_vertex(frame, a, b);
}

/*
 * Whether the ball inside of D leaves more than `most` to all facets beyond the reach of the disc: see foot.h. The
 * normal is off by 2^-42 at most, so what x is along it by that times the reach, which is less than `spare`; its part
 * across comes from squares, which are off by less than 2^-40 of the reach's.
 */
static inline bool is_beyond_ball(const pir_frame *frame, const pir_placement *placement, const pir_facet *facet,
                                  double most, double margin) {
    const double far = pir_vec_dot(placement->x, placement->x), along = pir_vec_dot(facet->n, placement->x);
    const double square = far - along * along, reach = placement->reach;
    const double across = sqrt((square > 0 ? square : 0) + 0x1p-40 * reach * reach);
    const double s = most * most, m = margin * margin, scale = 1 / (s + m);
    const double cosine = (s - m) * scale, sine = 2 * most * margin * scale;
    const double spare = 0x1p-30 * reach + 4 * placement->error;
    return (margin > 0) & (cosine * sqrt(far) < along - spare) &
           (frame->inner - spare - (along * cosine + across * sine) > most);
}

/*
 * Whether all facets at a great angle from this one have more slack than `most`, as the point z of D tells: see
 * foot.h.
 */
static inline bool is_enough(const pir_placement *placement, const pir_facet *facet, pir_vec3 z, double most,
                             double kappa) {
    pir_vec3 way = pir_vec_sub(z, placement->x);
    double below = facet->h - pir_vec_dot(facet->n, z) - 2 * most, down = pir_vec_dot(facet->n, way);
    // y is over x along the normal, so z is as far from the line through both
    double square = pir_vec_dot(way, way) - down * down;
    double beside = sqrt((square > 0 ? square : 0) + 0x1p-40 * placement->reach * placement->reach);
    return (below - most) * (1 - kappa * kappa) - 2 * kappa * beside > 3 * most;
}

bool pir_foot_settles_within(const pir_frame *frame, const pir_placement *placement, const pir_facet *facet,
                             double slack, double margin) {
    double most = (slack > 0 ? slack : 0) + placement->error * facet->err;
    if (is_beyond_ball(frame, placement, facet, most, margin))
        return true;
    if (!(margin > most))
        return false;
    double kappa = most / margin * (1 + 0x1p-40);
    return is_enough(placement, facet, landmark(frame, pir_vec_scale(facet->n, -1)), most, kappa) ||
           is_enough(placement, facet, landmark(frame, pir_vec_scale(placement->x, -1)), most, kappa);
}

bool pir_foot_settles(const pir_exact *exact, const pir_placement *placement, const pir_facet *facet, double slack) {
    const pir_frame *frame = exact->frame;
    if (frame->p.polytope->artificial || frame->q.polytope->artificial)
        return false;
    pir_vec3 y = pir_vec_add(placement->x, pir_vec_scale(facet->n, slack));
    double margin = margin_of(frame, facet, y) - MARGIN_ERRORS * placement->error * facet->err;
    return pir_foot_settles_within(frame, placement, facet, slack, margin);
}
