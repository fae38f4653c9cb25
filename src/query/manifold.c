/* SPDX-License-Identifier: MIT */
/*
 * Contact manifolds: the part of one body's facet that lies over the other's, by clipping polygons (Sutherland and Hodgman, 1974).
 *
 * The reference facet is the one whose normal is along the answer's normal, of Q or of P, whichever is more so; the incident facet is that of
 * the other body most against it. The incident polygon is clipped by the reference facet's sides, and its corners are the contacts. An answer
 * that no facet carries is one of edges: two parallel edges make a segment, the rest a point.
 */
#include "query/query.h"

/* A facet carries an answer when its normal is this close to it: the sine of the angle between. */
#define CARRIES 0x1p-20

/* One body as it stands: vertices in the frame, turned where it is P. Signs turn the reflected P back. */
struct body {
    const pir_polytope *polytope;
    const pir_vec3 *vertex;
    const pir_mat3 *r; /* NULL for Q */
    double sign;
    pir_vec3 at;
};

static pir_vec3 place(const struct body *body, uint32_t v) {
    pir_vec3 x = body->vertex[v];
    if (body->r)
        x = pir_mat_apply(body->r, x);
    return pir_vec_add(pir_vec_scale(x, body->sign), body->at);
}

static pir_vec3 normal_of(const struct body *body, uint32_t f) {
    pir_vec3 n = body->polytope->normal[f];
    if (body->r)
        n = pir_mat_apply(body->r, n);
    return pir_vec_scale(n, body->sign);
}

/* The facet whose normal is most along n. */
static uint32_t facet_along(const struct body *body, pir_vec3 n, double *ret_cosine) {
    uint32_t best = 0;
    double most = -2;
    for (uint32_t f = 0; f < body->polytope->facet_count; f++) {
        double c = pir_vec_dot(normal_of(body, f), n);
        if (c > most)
            most = c, best = f;
    }
    *ret_cosine = most;
    return best;
}

/* Corner i of facet f, in the order of a facet that is counter-clockwise from outside: the reflected P's are listed the other way. */
static uint32_t corner(const struct body *body, uint32_t f, uint32_t i) {
    const pir_polytope *p = body->polytope;
    uint32_t n = p->loop_start[f + 1] - p->loop_start[f];
    return p->origin[p->loop[p->loop_start[f] + (body->sign < 0 ? n - 1 - i : i)]];
}

/* The edge from corner i of facet f to the next, in that order. */
static uint32_t side_of(const struct body *body, uint32_t f, uint32_t i) {
    const pir_polytope *p = body->polytope;
    uint32_t n = p->loop_start[f + 1] - p->loop_start[f];
    return p->edge[p->loop[p->loop_start[f] + (body->sign < 0 ? (2 * n - 2 - i) % n : i)]];
}

/* Corners, and what the side from each to the next lies along: an edge of the incident body, or with REFERENCE one of the other. */
struct polygon {
    pir_vec3 *at;
    uint32_t *side;
    uint32_t count;
};

#define REFERENCE 0x40000000u

static void put_corner(struct polygon *to, uint32_t capacity, pir_vec3 at, uint32_t side) {
    if (to->count >= capacity)
        return;
    to->at[to->count] = at;
    to->side[to->count++] = side;
}

/* Keeps what is on the inner side, m·y ≤ limit, of `side` of the reference facet. */
static void clip_side(const struct polygon *from, pir_vec3 m, double limit, uint32_t side, struct polygon *to,
                      uint32_t capacity) {
    to->count = 0;
    for (uint32_t i = 0; i < from->count; i++) {
        uint32_t j = i + 1 < from->count ? i + 1 : 0;
        double a = pir_vec_dot(m, from->at[i]) - limit, b = pir_vec_dot(m, from->at[j]) - limit;
        // a corner on the line from which the polygon leaves goes on along the line
        if (a <= 0)
            put_corner(to, capacity, from->at[i], a == 0 && b > 0 ? side : from->side[i]);
        if ((a < 0 && b > 0) || (a > 0 && b < 0)) {
            pir_vec3 along = pir_vec_sub(from->at[j], from->at[i]);
            put_corner(to, capacity, pir_vec_add(from->at[i], pir_vec_scale(along, a / (a - b))),
                       b > 0 ? side : from->side[i]);
        }
    }
}

/* The incident facet, clipped by the sides of the reference facet. */
static struct polygon clip_facets(pir_query *query, const struct body *reference, uint32_t f,
                                  const struct body *incident, uint32_t g) {
    struct polygon now = {query->polygon[0], query->polygon_side[0], 0},
                   next = {query->polygon[1], query->polygon_side[1], 0};
    const pir_polytope *p = reference->polytope, *q = incident->polytope;
    uint32_t sides = p->loop_start[f + 1] - p->loop_start[f];
    now.count = q->loop_start[g + 1] - q->loop_start[g];
    for (uint32_t i = 0; i < now.count; i++) {
        // turned over: counter-clockwise about the reference's normal
        now.at[i] = place(incident, corner(incident, g, now.count - 1 - i));
        now.side[i] = side_of(incident, g, (2 * now.count - 2 - i) % now.count);
    }
    pir_vec3 n = normal_of(reference, f);
    for (uint32_t i = 0; i < sides; i++) {
        uint32_t v = corner(reference, f, i), w = corner(reference, f, i + 1 < sides ? i + 1 : 0);
        pir_vec3 from = place(reference, v), m = pir_vec_cross(pir_vec_sub(place(reference, w), from), n);
        clip_side(&now, m, pir_vec_dot(m, from), side_of(reference, f, i) | REFERENCE, &next, query->polygon_capacity);
        struct polygon swap = now;
        now = next;
        next = swap;
    }
    return now;
}

/* What meets in corner i: the sides before and after it. */
static uint64_t id_of(const struct polygon *polygon, uint32_t i) {
    uint32_t before = polygon->side[i > 0 ? i - 1 : polygon->count - 1];
    return (uint64_t)before << 32 | polygon->side[i];
}

/* A contact between y, a point of the incident body, and the reference facet's plane, `distance` below it against `out`. */
static pir_contact make_contact(const pir_query *query, pir_vec3 y, uint64_t id, pir_vec3 out, double distance,
                                bool by_q) {
    pir_contact contact = {.distance = pir_frame_length(query, distance), .id = id | (uint64_t)by_q << 63};
    pir_vec3 there = pir_frame_world(query, pir_vec_sub(y, pir_vec_scale(out, distance)));
    contact.point_p = by_q ? pir_frame_world(query, y) : there;
    contact.point_q = by_q ? there : pir_frame_world(query, y);
    return contact;
}

/* --- parallel edges --- */

/* A halfedge of the feature that lies across n; UINT32_MAX where there is none. */
static uint32_t edge_across(const struct body *body, pir_feature feature, pir_vec3 n) {
    const pir_polytope *p = body->polytope;
    pir_vec3 m = pir_vec_scale(body->r ? pir_mat_apply_transposed(body->r, n) : n, body->sign);
    if (feature.kind == PIR_FEATURE_EDGE && feature.index < p->edge_count)
        return fabs(pir_vec_dot(p->direction[p->edge_half[feature.index]], m)) <= CARRIES ? p->edge_half[feature.index]
                                                                                          : UINT32_MAX;
    if (feature.kind == PIR_FEATURE_VERTEX && feature.index < p->vertex_count)
        for (uint32_t h = p->ring_start[feature.index]; h < p->ring_start[feature.index + 1]; h++)
            if (fabs(pir_vec_dot(p->direction[h], m)) <= CARRIES)
                return h;
    return UINT32_MAX;
}

/* An end of an edge, by how far along the line it is. */
struct end {
    double along;
    uint32_t vertex;
};

/* The ends of a halfedge along u, the lower first. */
static void ends_of(const struct body *body, uint32_t half, pir_vec3 u, struct end ret_ends[2]) {
    const pir_polytope *p = body->polytope;
    struct end a = {pir_vec_dot(u, place(body, p->origin[half])), p->origin[half]},
               b = {pir_vec_dot(u, place(body, p->target[half])), p->target[half]};
    ret_ends[0] = a.along <= b.along ? a : b;
    ret_ends[1] = a.along <= b.along ? b : a;
}

/*
 * The two ends of what parallel edges of P and Q share, the answer being theirs: a vertex of one body and the edge of the other each. Returns how many,
 * 0 where there are no such edges.
 */
static uint32_t segment(const pir_query *query, const struct body *of_p, const struct body *of_q,
                        const pir_query_result *answer, pir_contact ret_contacts[2]) {
    uint32_t e = edge_across(of_p, answer->witness.p, answer->normal),
             d = edge_across(of_q, answer->witness.q, answer->normal);
    if (e == UINT32_MAX || d == UINT32_MAX)
        return 0;
    const pir_polytope *p = of_p->polytope, *q = of_q->polytope;
    pir_vec3 u = q->direction[d], v = pir_mat_apply(&query->r, p->direction[e]), c = pir_vec_cross(u, v);
    if (pir_vec_dot(c, c) > CARRIES * CARRIES)
        return 0;
    struct end on_p[2], on_q[2];
    ends_of(of_p, e, u, on_p);
    ends_of(of_q, d, u, on_q);
    bool first = on_p[0].along > on_q[0].along, second = on_p[1].along < on_q[1].along;
    double from = first ? on_p[0].along : on_q[0].along, to = second ? on_p[1].along : on_q[1].along;
    if (!(from < to))
        return 0;
    pir_vec3 origin = of_q->vertex[q->origin[d]];
    double apart = pir_frame_length(query, pir_vec_dot(answer->normal, pir_vec_sub(place(of_p, p->origin[e]), origin)));
    for (int k = 0; k < 2; k++) {
        bool by_p = k == 0 ? first : second;
        double along = (k == 0 ? from : to) - pir_vec_dot(u, origin);
        pir_contact *contact = &ret_contacts[k];
        contact->distance = apart;
        contact->point_q = pir_frame_world(query, pir_vec_add(origin, pir_vec_scale(u, along)));
        contact->point_p = pir_vec_add(contact->point_q, pir_vec_scale(answer->normal, apart));
        uint64_t vertex = by_p ? on_p[k].vertex : on_q[k].vertex, edge = by_p ? q->edge[d] : p->edge[e];
        contact->id = (uint64_t)(by_p ? 5 : 4) << 60 | vertex << 30 | edge;
    }
    return 2;
}

/* The answer's own points, as one contact. */
static pir_status single(const pir_query_result *answer, size_t capacity, pir_contact *ret_contacts,
                         size_t *ret_count) {
    *ret_count = 1;
    if (capacity < 1)
        return PIR_ERR_LIMIT;
    uint64_t p = (uint64_t)answer->witness.p.kind << 30 | answer->witness.p.index;
    uint64_t q = (uint64_t)answer->witness.q.kind << 30 | answer->witness.q.index;
    ret_contacts[0] = (pir_contact){answer->point_p, answer->point_q, answer->distance, p << 32 | q};
    return PIR_OK;
}

pir_status pir_query_manifold(pir_query *query, const pir_query_input *input, const pir_query_result *answer,
                              size_t capacity, pir_contact *ret_contacts, size_t *ret_count) {
    pir_placement placement;
    if (!answer || (!ret_contacts && capacity > 0) || !ret_count)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_query_begin(query, input, &placement);
    if (status != PIR_OK)
        return status;
    // Q about its middle; P, reflected back, at x: its own normals are minus those that the sum holds
    struct body of_p = {query->p, query->vp, &query->r, -1, placement.x},
                of_q = {query->q, query->vq, NULL, 1, {0, 0, 0}};
    pir_vec3 n = answer->normal, minus = pir_vec_scale(n, -1);
    double along_q = -2, along_p = -2;
    uint32_t g = 0, f = 0;
    if (query->q->dimension >= 2)
        g = facet_along(&of_q, n, &along_q);
    if (query->p->dimension >= 2)
        f = facet_along(&of_p, minus, &along_p);
    bool by_q = along_q >= along_p;
    double most = by_q ? along_q : along_p;
    if (most < 0 || 1 - most > CARRIES * CARRIES || along_p < -1 || along_q < -1) {
        pir_contact pair[2];
        if (segment(query, &of_p, &of_q, answer, pair) == 0)
            return single(answer, capacity, ret_contacts, ret_count);
        for (size_t i = 0; i < 2 && i < capacity; i++)
            ret_contacts[i] = pair[i];
        *ret_count = 2;
        return capacity >= 2 ? PIR_OK : PIR_ERR_LIMIT;
    }
    const struct body *reference = by_q ? &of_q : &of_p, *incident = by_q ? &of_p : &of_q;
    struct polygon polygon = clip_facets(query, reference, by_q ? g : f, incident, by_q ? f : g);
    // contacts are the corners behind the reference plane, or as near to it as the bodies are to each other
    uint32_t anchor = corner(reference, by_q ? g : f, 0), count = 0;
    pir_vec3 out = normal_of(reference, by_q ? g : f);
    double level = pir_vec_dot(out, place(reference, anchor)),
           hair = placement.error + pir_frame_from(query, fmax(answer->distance, 0)) * (1 + 0x1p-30);
    for (uint32_t k = 0; k < polygon.count; k++) {
        // the polygon turns about the reference's normal, which is against the answer's when P is the reference
        uint32_t i = by_q ? k : polygon.count - 1 - k;
        double distance = pir_vec_dot(out, polygon.at[i]) - level;
        if (distance > hair)
            continue;
        if (count < capacity)
            ret_contacts[count] = make_contact(query, polygon.at[i], id_of(&polygon, i), out, distance, by_q);
        count++;
    }
    if (count == 0)
        return single(answer, capacity, ret_contacts, ret_count);
    *ret_count = count;
    return count <= capacity ? PIR_OK : PIR_ERR_LIMIT;
}
