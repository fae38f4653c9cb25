/* SPDX-License-Identifier: MIT */
/* The least slack from the foot of x: see foot.h. */
#include "query/walk/foot.h"

/* The error of a distance in the plane of F, in units of the placement's error and the facet's: see touch.c. */
#define MARGIN_ERRORS 16

/* Facets of so many corners together are looked at in part first. */
#define MANY_CORNERS 16

/* --- how far the foot is from the rim --- */

/* The normal of F, the foot of x on it, and what corners may be off by. */
struct foot {
    pir_vec3 n, y;
    double noise, doubt; /* the latter as the normal may be off, too */
    pir_rims *rims;      /* NULL where the nearest side alone is wanted */
};

/* A face of a body as it stands in D, and where its vertices are listed. */
struct face {
    const pir_body *body;
    const pir_mat3 *r; /* of P; NULL for Q */
    pir_feature feature;
    uint32_t start, count; /* of a facet: its first place in the loops */
};

static struct face face_of(const pir_body *body, const pir_mat3 *r, pir_feature feature) {
    const pir_polytope *p = body->polytope;
    struct face face = {body, r, feature, 0, feature.kind == PIR_FEATURE_VERTEX ? 1 : 2};
    if (feature.kind == PIR_FEATURE_FACET) {
        face.start = p->loop_start[feature.index];
        face.count = p->loop_start[feature.index + 1] - face.start;
    }
    return face;
}

/* The halfedge that leads from corner i of an edge or a facet to the next. */
static inline uint32_t half_at(const struct face *face, uint32_t i) {
    const pir_polytope *p = face->body->polytope;
    if (face->feature.kind == PIR_FEATURE_FACET)
        return p->loop[face->start + i];
    uint32_t half = p->edge_half[face->feature.index];
    return i == 0 ? half : p->twin[half];
}

static inline uint32_t vertex_at(const struct face *face, uint32_t i) {
    return face->feature.kind == PIR_FEATURE_VERTEX ? face->feature.index
                                                    : face->body->polytope->origin[half_at(face, i)];
}

/* A vector of the body's own frame in that of D, and the reverse. */
static inline pir_vec3 turned(const struct face *face, pir_vec3 v) {
    return face->r ? pir_mat_apply(face->r, v) : v;
}

static inline pir_vec3 turned_back(const struct face *face, pir_vec3 v) {
    return face->r ? pir_mat_apply_transposed(face->r, v) : v;
}

/*
 * The least that corners of a face are along `in`, and the corner: from corner *at on, where the least is or before it
 * as corners go around. Along a direction across the normal a convex polygon falls and rises once, so nothing is less
 * after a corner that is more than `noise` above.
 */
static double least_from(const struct face *face, pir_vec3 in, double noise, uint32_t *at) {
    const pir_vec3 *vertex = face->body->vertex;
    pir_vec3 d = turned_back(face, in);
    double least = HUGE_VAL;
    for (uint32_t k = 0, i = *at; k < face->count; k++) {
        double along = pir_vec_dot(d, vertex[vertex_at(face, i)]);
        if (along > least + noise)
            break;
        *at = along < least ? i : *at;
        least = along < least ? along : least;
        i = i + 1 < face->count ? i + 1 : 0;
    }
    return least;
}

/* The corner of a face that is least along `in`, by looking at all. */
static uint32_t least_of(const struct face *face, pir_vec3 in) {
    uint32_t at = 0;
    least_from(face, in, HUGE_VAL, &at);
    return at;
}

/* Lists a side once for each corner that may be the one across it: all that are as far but for rounding. */
static void list_sides(const struct face *other, pir_vec3 in, const pir_rim *side, const struct foot *foot) {
    const pir_vec3 *vertex = other->body->vertex;
    pir_rims *rims = foot->rims;
    const double least = pir_vec_dot(in, vertex[side->across]);
    for (uint32_t k = 0; k < other->count; k++) {
        uint32_t v = vertex_at(other, k);
        if (pir_vec_dot(in, vertex[v]) <= least + foot->doubt && rims->count++ < PIR_RIMS_MOST) {
            rims->side[rims->count - 1] = *side;
            rims->side[rims->count - 1].across = v;
        }
    }
}

/*
 * Looks at the sides of F that are along those of `face`, for the one that y is least within. `other` is the other
 * body's. Both go around the normal in the same sense, so that the corner across goes on from side to side.
 */
static void look_along(const struct face *face, const struct face *other, const struct foot *foot, pir_rim *rim) {
    const pir_body *body = face->body;
    const pir_vec3 n = turned_back(face, foot->n), y = turned_back(face, foot->y);
    uint32_t across = 0;
    for (uint32_t i = 0; face->count > 1 && i < face->count; i++) {
        uint32_t half = half_at(face, i);
        pir_vec3 in = pir_vec_cross(n, body->polytope->direction[half]), of_other = turned(face, in);
        if (i == 0)
            across = least_of(other, of_other);
        double within = pir_vec_dot(in, pir_vec_sub(y, body->vertex[body->polytope->origin[half]])) -
                        least_from(other, of_other, foot->noise, &across);
        pir_rim side = {within, face->r == NULL, half, vertex_at(other, across)};
        if (within < rim->margin)
            *rim = side;
        if (foot->rims && within < foot->rims->within)
            list_sides(other, turned_back(other, of_other), &side, foot);
    }
}

/* F is the sum of two faces: each side is along a side of one, and through the vertex of the other farthest across. */
static pir_rim rim_of(const pir_frame *frame, const pir_facet *facet, struct foot foot) {
    struct face p = face_of(&frame->p, &frame->r, facet->faces.p), q = face_of(&frame->q, NULL, facet->faces.q);
    pir_rim rim = {HUGE_VAL, false, UINT32_MAX, UINT32_MAX};
    look_along(&p, &q, &foot, &rim);
    look_along(&q, &p, &foot, &rim);
    rim.margin -= MARGIN_ERRORS * foot.noise * facet->err + foot.noise;
    return rim;
}

/* The foot of x on F, for the nearest side alone. */
static struct foot foot_of(const pir_placement *placement, const pir_facet *facet, double slack) {
    return (struct foot){facet->n, pir_vec_add(placement->x, pir_vec_scale(facet->n, slack)), placement->error, 0,
                         NULL};
}

pir_rim pir_foot_rim(const pir_exact *exact, const pir_placement *placement, const pir_facet *facet, double slack) {
    return rim_of(exact->frame, facet, foot_of(placement, facet, slack));
}

pir_rim pir_foot_rims(const pir_exact *exact, const pir_placement *placement, const pir_facet *facet, pir_vec3 y,
                      pir_rims *rims) {
    rims->count = 0;
    const double doubt = 2 * MARGIN_ERRORS * placement->error * facet->err;
    return rim_of(exact->frame, facet, (struct foot){facet->n, y, placement->error, doubt, rims});
}

/*
 * The distance of y from the rim of a part of F: of the facet of fewer corners, put at a point within that of the
 * other. It is found sooner where that has many. 0 where neither has, or where one body has no facet there.
 */
static double margin_of_part(const pir_frame *frame, const pir_facet *facet, const struct foot *foot) {
    struct face p = face_of(&frame->p, &frame->r, facet->faces.p), q = face_of(&frame->q, NULL, facet->faces.q);
    if (p.feature.kind != PIR_FEATURE_FACET || q.feature.kind != PIR_FEATURE_FACET || p.count + q.count < MANY_CORNERS)
        return 0;
    const struct face *few = p.count < q.count ? &p : &q, *many = p.count < q.count ? &q : &p;
    pir_vec3 sum = {0, 0, 0};
    for (uint32_t k = 0; k < 3; k++)
        sum = pir_vec_add(sum, many->body->vertex[vertex_at(many, k * (many->count / 3))]);
    const pir_body *body = few->body;
    pir_vec3 y = pir_vec_sub(foot->y, turned(many, pir_vec_scale(sum, 1.0 / 3)));
    const pir_vec3 n = turned_back(few, foot->n);
    double margin = HUGE_VAL;
    y = turned_back(few, y);
    for (uint32_t i = 0; i < few->count; i++) {
        uint32_t half = half_at(few, i);
        pir_vec3 in = pir_vec_cross(n, body->polytope->direction[half]);
        double within = pir_vec_dot(in, pir_vec_sub(y, body->vertex[body->polytope->origin[half]]));
        margin = within < margin ? within : margin;
    }
    return margin - (MARGIN_ERRORS * facet->err + 1) * foot->noise;
}

/* --- the proof --- */

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
    const struct foot foot = foot_of(placement, facet, slack);
    double margin = margin_of_part(frame, facet, &foot);
    if (margin > 0 && pir_foot_settles_within(frame, placement, facet, slack, margin))
        return true;
    margin = rim_of(frame, facet, foot).margin;
    return pir_foot_settles_within(frame, placement, facet, slack, margin);
}
