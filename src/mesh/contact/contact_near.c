/* SPDX-License-Identifier: MIT */
/*
 * Nearest points by descent in doubles, then proven: the simplex is that of the exact nearest points where its weights
 * are certainly positive and no other vertex or corner is as far along its direction. What cannot be proven, integers
 * decide, beginning with the simplex that was found.
 */
#include "mesh/contact/contact_near.h"

#define MOST_STEPS 48
/* How far a direction in doubles may be off before exact numbers give it. */
#define NEAR_ENOUGH 0x1p-34
/* How far off the direction of a corner or an edge that is proven may be, which its points tell. */
#define NEARLY 0x1p-29

/* A simplex in doubles. */
struct hull {
    pir_contact_simplex ids;
    pir_vec3 d[4];
    double weight[4];
    pir_vec3 nearest;
};

static pir_vec3 difference(const pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s, uint32_t v, uint32_t w) {
    return pir_vec_sub(job->vertex[v], pir_vec_sub(s->p[w], t));
}

static uint32_t most_corner(const pir_near_triangle *s, pir_vec3 n) {
    double a = pir_vec_dot(n, s->p[0]), b = pir_vec_dot(n, s->p[1]), c = pir_vec_dot(n, s->p[2]);
    return a >= b ? (a >= c ? 0 : 2) : (b >= c ? 1 : 2);
}

/* Weights of the point of the points' span that is nearest to 0, of a sum `whole`; false where it is outside. */
static bool span_two(const pir_vec3 *a, const pir_vec3 *b, double w[2], double *ret_whole) {
    pir_vec3 e = pir_vec_sub(*b, *a);
    w[0] = pir_vec_dot(*b, e);
    w[1] = -pir_vec_dot(*a, e);
    *ret_whole = w[0] + w[1];
    return w[0] > 0 && w[1] > 0;
}

static bool span_three(const pir_vec3 *a, const pir_vec3 *b, const pir_vec3 *c, double w[3], double *ret_whole) {
    pir_vec3 n = pir_vec_cross(pir_vec_sub(*b, *a), pir_vec_sub(*c, *a));
    w[0] = pir_vec_dot(n, pir_vec_cross(*b, *c));
    w[1] = pir_vec_dot(n, pir_vec_cross(*c, *a));
    w[2] = pir_vec_dot(n, pir_vec_cross(*a, *b));
    *ret_whole = w[0] + w[1] + w[2];
    return w[0] > 0 && w[1] > 0 && w[2] > 0;
}

/* A face of a hull, and its point that is nearest to 0. */
struct hull_face {
    uint32_t mask; /* of the hull's points; 0 for none */
    double square, weight[3];
    pir_vec3 nearest;
};

static uint32_t points_of(uint32_t mask, uint32_t at[4]) {
    uint32_t count = 0;
    for (uint32_t k = 0; k < 4; k++)
        if (mask >> k & 1)
            at[count++] = k;
    return count;
}

/* Takes the points of a mask, three at most, where what is nearest to 0 of their span is between them, and nearer. */
static void consider(const struct hull *hull, uint32_t mask, struct hull_face *best) {
    uint32_t at[4];
    const uint32_t count = points_of(mask, at);
    const pir_vec3 *d = hull->d;
    double w[3] = {1, 0, 0}, whole = 1;
    if (count > 3 || (count == 2 && !span_two(&d[at[0]], &d[at[1]], w, &whole)) ||
        (count == 3 && !span_three(&d[at[0]], &d[at[1]], &d[at[2]], w, &whole)))
        return;
    pir_vec3 x = {0, 0, 0};
    for (uint32_t k = 0; k < count; k++)
        x = pir_vec_add(x, pir_vec_scale(d[at[k]], w[k] / whole));
    const double square = pir_vec_dot(x, x);
    if (best->mask == 0 || square < best->square)
        *best = (struct hull_face){mask, square, {w[0] / whole, w[1] / whole, w[2] / whole}, x};
}

/* Leaves the points of a face. */
static void take_face(struct hull *hull, const struct hull_face *face) {
    uint32_t at[4];
    hull->ids.count = points_of(face->mask, at);
    hull->nearest = face->nearest;
    for (uint32_t k = 0; k < hull->ids.count; k++) {
        hull->ids.v[k] = hull->ids.v[at[k]];
        hull->ids.w[k] = hull->ids.w[at[k]];
        hull->d[k] = hull->d[at[k]];
        hull->weight[k] = face->weight[k];
    }
}

static double volume(pir_vec3 a, pir_vec3 b, pir_vec3 c) {
    return pir_vec_dot(a, pir_vec_cross(b, c));
}

/* Whether four points hold 0 inside: 1 certainly, for points off by `error`; −1 for doubles alone; 0 not. */
static int holds_zero(const pir_vec3 d[4], double error) {
    double sign[4] = {volume(d[1], d[2], d[3]), -volume(d[0], d[2], d[3]), volume(d[0], d[1], d[3]),
                      -volume(d[0], d[1], d[2])};
    double most = 0, least = HUGE_VAL;
    for (int k = 0; k < 4; k++) {
        most = pir_greater(most, pir_length(d[k]));
        if (!(sign[k] * sign[0] > 0))
            return 0;
        least = pir_lesser(least, fabs(sign[k]));
    }
    return least > 16 * most * most * error + 0x1p-48 * most * most * most ? 1 : -1;
}

/* Reduces the hull to the face that has the nearest point; what holds_zero says. */
static int reduce(struct hull *hull, double error) {
    uint32_t newest = hull->ids.count - 1;
    if (hull->ids.count == 4) {
        int holds = holds_zero(hull->d, error);
        if (holds != 0)
            return holds;
    }
    struct hull_face best = {.mask = 0};
    for (uint32_t mask = 1u << newest; mask < 2u << newest; mask++)
        consider(hull, mask, &best);
    take_face(hull, &best);
    return 0;
}

static void add(struct hull *hull, const pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s, uint32_t v,
                uint32_t w) {
    uint32_t k = hull->ids.count++;
    hull->ids.v[k] = v;
    hull->ids.w[k] = w;
    hull->d[k] = difference(job, t, s, v, w);
}

static bool has(const struct hull *hull, uint32_t v, uint32_t w) {
    for (uint32_t k = 0; k < hull->ids.count; k++)
        if (hull->ids.v[k] == v && hull->ids.w[k] == w)
            return true;
    return false;
}

/* The descent: whether P certainly meets the triangle, at coordinates off by `error`. */
static bool descend(const pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s, double error,
                    struct hull *hull) {
    pir_vec3 n = pir_vec_sub(t, pir_corner_mean(s));
    double height = pir_vec_dot(n, s->front);
    if (height != 0)
        n = height > 0 ? s->front : pir_vec_scale(s->front, -1);
    hull->ids.count = 0;
    add(hull, job, t, s, pir_contact_lowest(job, n), most_corner(s, n));
    hull->nearest = hull->d[0];
    hull->weight[0] = 1;
    for (int step = 0; step < MOST_STEPS; step++) {
        pir_vec3 x = hull->nearest;
        double square = pir_vec_dot(x, x);
        uint32_t v = pir_contact_lowest(job, x), w = most_corner(s, x);
        if (has(hull, v, w) || !(square > 0))
            return false;
        pir_vec3 d = difference(job, t, s, v, w);
        if (pir_vec_dot(x, d) >= square - 0x1p-50 * (square + job->size * sqrt(square)))
            return false;
        add(hull, job, t, s, v, w);
        int holds = reduce(hull, error);
        if (holds != 0)
            return holds > 0;
    }
    return false;
}

/* --- a guess --- */

/* Sets a hull of three pairs, and the weights of the point of their plane that is nearest; false where it is beside. */
static bool take_three(const pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s, pir_contact_simplex ids,
                       struct hull *hull) {
    double whole;
    hull->ids = ids;
    for (uint32_t k = 0; k < 3; k++)
        hull->d[k] = difference(job, t, s, ids.v[k], ids.w[k]);
    if (!span_three(&hull->d[0], &hull->d[1], &hull->d[2], hull->weight, &whole))
        return false;
    for (uint32_t k = 0; k < 3; k++)
        hull->weight[k] /= whole;
    return true;
}

/* The facet of P that faces against n most. */
static uint32_t facing_facet(const pir_contact_job *job, pir_vec3 n) {
    uint32_t best = 0;
    double most = -HUGE_VAL;
    for (uint32_t f = 0; f < job->p->facet_count; f++) {
        const double facing = -pir_vec_dot(n, job->turned[f]);
        best = facing > most ? f : best;
        most = pir_greater(most, facing);
    }
    return best;
}

/*
 * The nearest points of most triangles under a body: P's lowest vertex over the triangle, or the triangle's highest
 * corner under the facet of P that faces it, which is three vertices of a fan of that facet.
 */
static bool guess(pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s, struct hull *hull) {
    const pir_polytope *p = job->p;
    const double height = pir_vec_dot(s->front, pir_vec_sub(t, s->p[0]));
    const pir_vec3 n = height < 0 ? pir_vec_scale(s->front, -1) : s->front;
    const uint32_t v = pir_contact_lowest(job, n);
    if (take_three(job, t, s, (pir_contact_simplex){3, {v, v, v}, {0, 1, 2}}, hull))
        return true;
    if (p->dimension < 3)
        return false;
    pir_contact_turn(job);
    const uint32_t f = facing_facet(job, n), w = most_corner(s, pir_vec_scale(job->turned[f], -1));
    const uint32_t start = p->loop_start[f], end = p->loop_start[f + 1], first = p->origin[p->loop[start]];
    for (uint32_t i = start + 1; i + 1 < end; i++) {
        const pir_contact_simplex ids = {3, {first, p->origin[p->loop[i]], p->origin[p->loop[i + 1]]}, {w, w, w}};
        if (take_three(job, t, s, ids, hull))
            return true;
    }
    return false;
}

/* --- the proof --- */

/* The direction of a simplex, and by how much it may be off, where coordinates of differences are off by `error`. */
static pir_vec3 direction_of(const pir_vec3 *d, uint32_t count, const double *weight, double error, double *ret_error) {
    if (count == 1) {
        *ret_error = 2 * error;
        return d[0];
    }
    pir_vec3 e = pir_vec_sub(d[1], d[0]);
    double length = pir_length(e);
    if (count == 2) {
        pir_vec3 x = pir_vec_add(pir_vec_scale(d[0], weight[0]), pir_vec_scale(d[1], weight[1]));
        *ret_error = 64 * error * (pir_length(d[0]) + pir_length(d[1]) + length) / length;
        return x;
    }
    pir_vec3 f = pir_vec_sub(d[2], d[0]), n = pir_vec_cross(e, f);
    *ret_error = 8 * error * (length + pir_length(f)) + 0x1p-50 * length * pir_length(f);
    return pir_vec_dot(n, d[0]) < 0 ? pir_vec_scale(n, -1) : n;
}

static uint32_t distinct(const uint32_t *id, uint32_t count) {
    uint32_t found = 0;
    for (uint32_t k = 0; k < count; k++) {
        bool again = false;
        for (uint32_t i = 0; i < k; i++)
            again |= id[i] == id[k];
        found += !again;
    }
    return found;
}

static bool is_in(const uint32_t *id, uint32_t count, uint32_t x) {
    for (uint32_t k = 0; k < count; k++)
        if (id[k] == x)
            return true;
    return false;
}

/* Whether a rotation keeps the coordinate k of every point, exactly. */
static bool keeps(pir_quat q, int k) {
    return (k == 0 || q.x == 0) && (k == 1 || q.y == 0) && (k == 2 || q.z == 0);
}

static double component(pir_vec3 v, int k) {
    return k == 0 ? v.x : k == 1 ? v.y : v.z;
}

/* Whether two vertices of P, or two corners, have the coordinate k in common, exactly. */
static bool is_level_vertex(const pir_contact_job *job, uint32_t v, uint32_t o, int k) {
    const pir_polytope *p = job->p;
    return v == o || (keeps(job->input->pose.rotation, k) && component(p->vertex[v], k) == component(p->vertex[o], k) &&
                      pir_vertex_is_double(p, v, k) && pir_vertex_is_double(p, o, k));
}

static bool is_level_corner(const pir_contact_job *job, const pir_near_triangle *s, uint32_t w, uint32_t o, int k) {
    return w == o || pir_near_is_level(job, s, w, s, o, k);
}

/* The axis that the direction of three pairs has exactly, because all that they are made of is level; −1 for none. */
static int axis_of(const pir_contact_job *job, const pir_near_triangle *s, const pir_contact_simplex *ids) {
    for (int k = 0; k < 3 && ids->count == 3; k++) {
        bool level = true;
        for (uint32_t i = 1; i < 3 && level; i++)
            level = is_level_vertex(job, ids->v[i], ids->v[0], k) && is_level_corner(job, s, ids->w[i], ids->w[0], k);
        if (level)
            return k;
    }
    return -1;
}

static bool has_vertex(const pir_polytope *p, uint32_t facet, uint32_t v) {
    for (uint32_t i = p->loop_start[facet]; i < p->loop_start[facet + 1]; i++)
        if (p->origin[p->loop[i]] == v)
            return true;
    return false;
}

/* Whether three vertices are those of a facet of P that faces against n: then no vertex is less far along n. */
static bool is_facet(const pir_contact_job *job, const uint32_t v[3], pir_vec3 n) {
    const pir_polytope *p = job->p;
    for (uint32_t h = p->ring_start[v[0]]; h < p->ring_start[v[0] + 1] && p->dimension >= 2; h++) {
        uint32_t f = p->left[h];
        if (has_vertex(p, f, v[1]) && has_vertex(p, f, v[2]) &&
            pir_vec_dot(n, pir_mat_apply(&job->rotation.r, p->normal[f])) < 0)
            return true;
    }
    return false;
}

/*
 * Whether all vertices and corners but those of the simplex are certainly no farther along n. Where the pairs of the
 * simplex join its vertices and corners to one tree, these are all as far, since the pairs are. What is level is known
 * to be as far too, and so are the vertices of a facet and the corners of a triangle.
 */
static bool is_supported(const pir_contact_job *job, const pir_near_triangle *s, const pir_contact_near *near,
                         double error) {
    const pir_contact_simplex *ids = &near->simplex;
    uint32_t vertices = distinct(ids->v, ids->count), corners = distinct(ids->w, ids->count);
    double own = 4 * error * pir_length(near->n);
    int axis = near->axis;
    if (axis < 0 && vertices + corners != ids->count + 1)
        return false;
    const pir_vec3 p = job->vertex[ids->v[0]], q = s->p[ids->w[0]], n = near->n;
    const double bound = own + near->n_error * 2 * job->radius;
    const uint32_t looked_at = vertices == 3 && is_facet(job, ids->v, n) ? 0 : job->p->vertex_count;
    for (uint32_t v = 0; v < looked_at; v++)
        if (!(pir_vec_dot(n, pir_vec_sub(job->vertex[v], p)) > bound) && !is_in(ids->v, ids->count, v) &&
            !(axis >= 0 && is_level_vertex(job, v, ids->v[0], axis)))
            return false;
    for (uint32_t w = 0; w < 3 && corners < 3; w++) {
        pir_vec3 away = pir_vec_sub(s->p[w], q);
        if (!(pir_vec_dot(near->n, away) < -own - near->n_error * pir_length(away)) && !is_in(ids->w, ids->count, w) &&
            !(axis >= 0 && is_level_corner(job, s, w, ids->w[0], axis)))
            return false;
    }
    return true;
}

/* Whether the nearest point is certainly within the simplex, not at its rim. */
static bool is_within(const pir_vec3 *d, uint32_t count, const double *weight, double error) {
    if (count == 1)
        return true;
    double most = 0, size = 0;
    for (uint32_t k = 0; k < count; k++)
        size = pir_greater(size, pir_length(d[k]));
    pir_vec3 e = pir_vec_sub(d[1], d[0]);
    double under = pir_vec_dot(e, e), wide = pir_length(e);
    if (count == 3) {
        pir_vec3 f = pir_vec_sub(d[2], d[0]), n = pir_vec_cross(e, f);
        under = pir_vec_dot(n, n);
        wide = pir_greater(wide, pir_length(f));
        wide = wide * wide * wide;
    }
    // a weight times `under` is a sum of products of this size, each off by `error` in one factor
    most = 64 * (error + 0x1p-52 * size) * size * wide;
    for (uint32_t k = 0; k < count; k++)
        if (!(weight[k] * under > most))
            return false;
    return true;
}

static void set_numbers(const pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                        double error, pir_contact_near *near) {
    struct hull hull = {.ids = near->simplex};
    for (uint32_t k = 0; k < near->simplex.count; k++)
        hull.d[k] = difference(job, place->at, s, near->simplex.v[k], near->simplex.w[k]);
    double whole = 1;
    hull.weight[0] = 1;
    if (near->simplex.count == 2)
        (void)span_two(&hull.d[0], &hull.d[1], hull.weight, &whole);
    if (near->simplex.count == 3)
        (void)span_three(&hull.d[0], &hull.d[1], &hull.d[2], hull.weight, &whole);
    near->point = near->way = (pir_vec3){0, 0, 0};
    for (uint32_t k = 0; k < near->simplex.count; k++) {
        hull.weight[k] /= whole;
        near->point = pir_vec_add(near->point, pir_vec_scale(s->p[near->simplex.w[k]], hull.weight[k]));
        near->way = pir_vec_add(near->way, pir_vec_scale(hull.d[k], hull.weight[k]));
    }
    near->n = direction_of(hull.d, near->simplex.count, hull.weight, error, &near->n_error);
    if (near->simplex.count == 3) {
        // the height over a plane is off by less than what three weights add up
        double square = pir_vec_dot(near->n, near->n);
        near->way = pir_vec_scale(near->n, pir_vec_dot(near->n, hull.d[0]) / square);
    }
    near->distance = pir_length(near->way);
}

/* Sets what doubles say of a simplex; whether that is the one of the nearest points, certainly. */
static bool is_proven(const pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                      const struct hull *hull, pir_contact_near *near) {
    const double error = 4 * job->error;
    near->simplex = hull->ids;
    near->axis = axis_of(job, s, &hull->ids);
    set_numbers(job, place, s, error, near);
    return near->distance > 4 * error && is_within(hull->d, hull->ids.count, hull->weight, error) &&
           is_supported(job, s, near, error);
}

/* Whether a direction certainly parts P from the triangle. */
static bool is_parted(const pir_contact_job *job, pir_vec3 at, const pir_near_triangle *s, pir_vec3 n, double off) {
    const pir_vec3 d = difference(job, at, s, pir_contact_lowest(job, n), most_corner(s, n));
    const double length = pir_length(n);
    return length > 0 && pir_vec_dot(n, d) > length * (2 * off + 0x1p-48 * job->size);
}

static void set_exact_way(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                          pir_contact_near *near) {
    pir_exact_way(job, place, s, &near->simplex, &near->n, &near->way);
    near->n_error = 0x1p-47;
    near->distance = pir_length(near->way);
}

/* By integers, beginning with near->simplex. */
static void find_exactly(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                         pir_contact_near *near) {
    const double error = 4 * job->error;
    near->proven = true;
    near->meets = pir_exact_nearest(job, place, s, &near->simplex);
    if (near->meets)
        return;
    near->axis = axis_of(job, s, &near->simplex);
    set_numbers(job, place, s, error, near);
    // what is too near for doubles has no direction in them
    if (!(near->n_error < NEAR_ENOUGH * pir_length(near->n)) || near->distance < 4 * error)
        set_exact_way(job, place, s, near);
}

static void find_near(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s, bool exactly,
                      pir_contact_near *near) {
    struct hull hull;
    const double error = 4 * job->error;
    *near = (pir_contact_near){.proven = true};
    if (guess(job, place->at, s, &hull) && is_proven(job, place, s, &hull, near))
        return;
    near->meets = descend(job, place->at, s, error, &hull);
    if (near->meets)
        return;
    if (hull.ids.count < 4 && is_proven(job, place, s, &hull, near)) {
        if (near->simplex.count < 3 && error > NEARLY * near->distance)
            set_exact_way(job, place, s, near);
        return;
    }
    near->simplex = hull.ids;
    near->proven = exactly || hull.ids.count == 4 || !is_parted(job, place->at, s, hull.nearest, error);
    if (near->proven)
        find_exactly(job, place, s, near);
}

void pir_contact_look_near(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                           pir_contact_near *ret_near) {
    find_near(job, place, s, false, ret_near);
}

void pir_contact_nearest(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                         pir_contact_near *ret_near) {
    find_near(job, place, s, true, ret_near);
}

bool pir_contact_holds_point(pir_contact_job *job, pir_vec3 at, pir_vec3 x, double error) {
    const pir_polytope *p = job->p;
    const double far = 4 * job->error + error + 0x1p-46 * job->size;
    const pir_vec3 own = pir_vec_sub(x, at);
    if (p->dimension < 3)
        return false;
    pir_contact_turn(job);
    for (uint32_t f = 0; f < p->facet_count; f++) {
        const pir_vec3 on = job->vertex[p->origin[p->loop[p->loop_start[f]]]];
        if (!(pir_vec_dot(job->turned[f], pir_vec_sub(own, on)) < -far))
            return false;
    }
    return true;
}

pir_vec3 pir_contact_touch_point(const pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s) {
    const pir_contact_simplex *ids = &s->near.simplex;
    struct hull hull = {.ids = *ids};
    struct hull_face face = {.mask = 0};
    pir_vec3 x = {0, 0, 0};
    for (uint32_t k = 0; k < ids->count; k++)
        hull.d[k] = difference(job, t, s, ids->v[k], ids->w[k]);
    for (uint32_t mask = 1; mask < 1u << ids->count; mask++)
        consider(&hull, mask, &face);
    take_face(&hull, &face);
    for (uint32_t k = 0; k < hull.ids.count; k++)
        x = pir_vec_add(x, pir_vec_scale(s->p[hull.ids.w[k]], hull.weight[k]));
    return x;
}

pir_contact_told pir_contact_told_meets(const pir_contact_job *job, pir_vec3 at, const pir_near_triangle *s,
                                        double error, pir_contact_simplex *ret_simplex) {
    struct hull hull;
    double off = 4 * job->error + error;
    bool meets = descend(job, at, s, off, &hull);
    *ret_simplex = hull.ids;
    if (meets)
        return PIR_TOLD_YES;
    // a direction that takes all apart by more than what they are off by
    return hull.ids.count < 4 && is_parted(job, at, s, hull.nearest, off) ? PIR_TOLD_NO : PIR_TOLD_NOTHING;
}

bool pir_contact_meets(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s) {
    pir_contact_simplex simplex;
    pir_contact_told told = pir_contact_told_meets(job, place->at, s, 0, &simplex);
    return told == PIR_TOLD_NOTHING ? pir_exact_nearest(job, place, s, &simplex) : told == PIR_TOLD_YES;
}

/* --- from behind --- */

pir_contact_told pir_contact_told_behind(const pir_contact_job *job, pir_vec3 at, const pir_near_triangle *s,
                                         double error, double grow) {
    if (!s->one_sided)
        return PIR_TOLD_NO;
    pir_vec3 e = pir_vec_sub(s->p[1], s->p[0]), f = pir_vec_sub(s->p[2], s->p[0]), n = pir_vec_cross(e, f);
    double length = pir_length(n), off = 4 * job->error + error, most = -HUGE_VAL;
    double far = pir_length(pir_vec_sub(at, s->p[0])) + 2 * job->radius, sides = pir_length(e) + pir_length(f);
    double bound = off * (8 * sides * far + 2 * length) + 0x1p-48 * pir_length(e) * pir_length(f) * far;
    // one vertex in front is enough, and of most bodies any is
    for (uint32_t v = 0; v < job->p->vertex_count; v++) {
        most = pir_greater(most, pir_vec_dot(n, difference(job, at, s, v, 0)) + grow * length);
        if (most > bound)
            return PIR_TOLD_NO;
    }
    if (most < -bound)
        return PIR_TOLD_YES;
    return grow > 0 ? PIR_TOLD_NO : PIR_TOLD_NOTHING;
}

bool pir_exact_is_behind(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s) {
    uint32_t used = job->limbs.used;
    pir_int3 back = pir_exact_front(job, s);
    for (int k = 0; k < 3; k++)
        pir_int_negate(&back.c[k]);
    bool behind = pir_exact_least(job, place, s, &back) >= 0;
    job->limbs.used = used;
    job->counts.exact++;
    return behind;
}

bool pir_contact_is_behind(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s) {
    pir_contact_told told = pir_contact_told_behind(job, place->at, s, 0, 0);
    return told == PIR_TOLD_NOTHING ? pir_exact_is_behind(job, place, s) : told == PIR_TOLD_YES;
}

/* --- beyond reach --- */

/* The most that roundings may add to a distance. */
static double slack_of(const pir_contact_job *job) {
    return 0x1p-40 * job->size + 16 * job->error;
}

/* The least and the most of P's vertices along n. */
static void span_along(const pir_contact_job *job, pir_vec3 n, double *ret_least, double *ret_most) {
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (uint32_t v = 0; v < job->p->vertex_count; v++) {
        const double along = pir_vec_dot(n, job->vertex[v]);
        least = along < least ? along : least;
        most = along > most ? along : most;
    }
    *ret_least = least;
    *ret_most = most;
}

/* The point of a triangle's rim that is nearest to x, by doubles. */
static pir_vec3 nearest_of_rim(const pir_near_triangle *s, pir_vec3 x) {
    pir_vec3 nearest = s->p[0];
    double least = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const pir_vec3 a = s->p[k], e = pir_vec_sub(s->p[(k + 1) % 3], a);
        const double part = pir_vec_dot(e, pir_vec_sub(x, a)) / pir_vec_dot(e, e);
        const pir_vec3 q = pir_vec_add(a, pir_vec_scale(e, part > 0 ? (part < 1 ? part : 1) : 0));
        const pir_vec3 way = pir_vec_sub(x, q);
        const double square = pir_vec_dot(way, way);
        nearest = square < least ? q : nearest;
        least = square < least ? square : least;
    }
    return nearest;
}

bool pir_contact_is_beyond(const pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s, double far) {
    const double reach = far + slack_of(job), height = pir_vec_dot(s->front, pir_vec_sub(t, s->p[0]));
    double least, most, corner = -HUGE_VAL;
    span_along(job, s->front, &least, &most);
    if (height + least > reach || -(height + most) > reach)
        return true;
    const pir_vec3 middle = pir_vec_add(t, pir_vec_scale(pir_vec_add(job->low, job->high), 0.5));
    const pir_vec3 way = pir_vec_sub(middle, nearest_of_rim(s, middle));
    const double length = pir_length(way);
    if (!(length > reach))
        return false;
    const pir_vec3 n = pir_vec_scale(way, 1 / length);
    for (int k = 0; k < 3; k++)
        corner = pir_greater(corner, pir_vec_dot(n, pir_vec_sub(s->p[k], t)));
    span_along(job, n, &least, &most);
    return least - corner > reach;
}

void pir_contact_keep_within(pir_contact_job *job, double far) {
    const double reach = far + slack_of(job);
    uint32_t count = 0;
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        const pir_near_triangle *s = &job->triangle[i];
        if (s->near.meets || !(s->near.distance > reach))
            job->triangle[count++] = *s;
    }
    job->triangle_count = count;
}
