/* SPDX-License-Identifier: MIT */
/* See inner_sums.h. */
#include "plan/rigid/inner_sums.h"

#include <math.h>
#include <string.h>

#include <pirouette/sum.h>

#include "base/vec.h"

#define GRID_BITS 24
#define KEPT      0x1p-22 /* of the size: how far points stay within half-spaces, unrounded */
#define ROUNDED   0x1p-44 /* of the size: more than what doubles lose */
#define INWARDS   0.7     /* how far obstacles' points are moved, beside the robot's size */
#define IN_STEPS  6       /* halvings of the way that a point is moved inwards */
#define OUTWARDS  0.5     /* how far points are moved outwards at most, beside the robot's size */
#define OUT_STEPS 5
#define GAIN      0.04 /* the least part of OUTWARDS that a point is to be before its facet */
#define FAR_OUT   10   /* how much less a corner counts that is beyond the bounds by one */

static pir_vec3 turned(const pir_turn_forms *forms, int which, pir_vec3 v) {
    const pir_vec3 *row = forms->row[which];
    return (pir_vec3){pir_vec_dot(row[0], v), pir_vec_dot(row[1], v), pir_vec_dot(row[2], v)};
}

/* --- memory --- */

/* A block of a search; all are freed with it. */
struct block {
    struct block *next;
    size_t bytes;
};

struct pir_inner_search {
    const pir_rigid_question *question;
    pir_plan_space *space;
    struct block *first;
    pir_turn_forms forms;
    pir_quat middle;
    struct faces *robot, *obstacle; /* of all pieces */
    struct sum_search *pair;
};

/* An array, zeroed; NULL once the space's status is a failure. */
static void *take(pir_inner_search *s, size_t count, size_t size) {
    const size_t bytes = sizeof(struct block) + count * size;
    struct block *block = pir_plan_new(s->space, 1, bytes);
    if (!block)
        return NULL;
    *block = (struct block){s->first, bytes};
    s->first = block;
    return block + 1;
}

static void free_from(pir_inner_search *s, struct block *last) {
    while (s->first != last) {
        struct block *block = s->first;
        s->first = block->next;
        pir_plan_free(s->space, block, 1, block->bytes);
    }
}

/* --- pieces --- */

/* A piece: its corners, half-spaces n·x ≤ d of unit normals, edges with the two facets at each. */
struct faces {
    pir_vec3 *v, *n;
    double *d, size;
    uint32_t (*edge)[2], (*side)[2];
    pir_vec3 *way, middle; /* of edges, of length 1; the mean of corners */
    uint32_t vertices, facets, edges;
    /* of the robot's, per form and then for the middle: normals reflected, ways of edges, ways × their first corners,
     * points that may prove */
    pir_vec3 *back, *turned_way, *moment, *turned_point;
    uint32_t points;
};

/* Notes that a facet goes from one corner to another. */
static void add_side(struct faces *f, uint32_t facet, uint32_t a, uint32_t b) {
    for (uint32_t e = 0; e < f->edges; e++)
        if (f->edge[e][0] == b && f->edge[e][1] == a) {
            f->side[e][1] = facet;
            return;
        }
    const pir_vec3 way = pir_vec_along(f->v[b], -1, f->v[a]);
    f->way[f->edges] = pir_vec_scale(way, 1 / sqrt(pir_vec_dot(way, way)));
    f->edge[f->edges][0] = a;
    f->edge[f->edges][1] = b;
    f->side[f->edges++][0] = facet;
}

/* Reads facets: corners that go up make edges, those that go down find them. */
static void read_facets(const pir_polytope *piece, uint32_t *corner, bool up, struct faces *f) {
    for (uint32_t i = 0; i < f->facets; i++) {
        const uint32_t size = pir_polytope_facet_size(piece, i);
        pir_polytope_facet(piece, i, corner);
        f->n[i] = pir_polytope_normal(piece, i);
        f->d[i] = pir_vec_dot(f->n[i], f->v[corner[0]]);
        for (uint32_t k = 0; k < size; k++)
            if ((corner[k] < corner[(k + 1) % size]) == up)
                add_side(f, i, corner[k], corner[(k + 1) % size]);
    }
}

static bool read_faces(pir_inner_search *s, const pir_polytope *piece, struct faces *f) {
    const uint32_t vertices = pir_polytope_vertex_count(piece), facets = pir_polytope_facet_count(piece);
    const uint32_t edges = pir_polytope_edge_count(piece);
    uint32_t *corner = take(s, vertices, sizeof *corner);
    *f = (struct faces){.v = take(s, vertices, sizeof *f->v),
                        .n = take(s, facets, sizeof *f->n),
                        .d = take(s, facets, sizeof *f->d),
                        .edge = take(s, edges, sizeof *f->edge),
                        .side = take(s, edges, sizeof *f->side),
                        .way = take(s, edges, sizeof *f->way),
                        .vertices = vertices,
                        .facets = facets};
    if (s->space->status != PIR_OK)
        return false;
    for (uint32_t i = 0; i < vertices; i++) {
        f->v[i] = pir_polytope_vertex(piece, i);
        f->size = fmax(f->size, sqrt(pir_vec_dot(f->v[i], f->v[i])));
        f->middle = pir_vec_along(f->middle, 1.0 / vertices, f->v[i]);
    }
    read_facets(piece, corner, true, f);
    read_facets(piece, corner, false, f);
    return true;
}

/* The points of a piece that may prove. */
static pir_vec3 point_of(const struct faces *f, uint32_t i) {
    if (i < f->vertices)
        return f->v[i];
    if (i == f->vertices)
        return f->middle;
    const uint32_t *edge = f->edge[i - f->vertices - 1];
    return pir_vec_scale(pir_vec_along(f->v[edge[0]], 1, f->v[edge[1]]), 0.5);
}

/* Turns what is of use of a robot's piece. */
static bool turn_faces(pir_inner_search *s, struct faces *f) {
    const size_t forms = (size_t)s->forms.count + 1;
    f->points = f->vertices + f->edges + 1;
    f->back = take(s, f->facets * forms, sizeof *f->back);
    f->turned_way = take(s, f->edges * forms, sizeof *f->turned_way);
    f->moment = take(s, f->edges * forms, sizeof *f->moment);
    f->turned_point = take(s, f->points * forms, sizeof *f->turned_point);
    if (s->space->status != PIR_OK)
        return false;
    for (int k = 0; k <= s->forms.count; k++) {
        for (uint32_t a = 0; a < f->facets; a++)
            f->back[a * forms + k] = pir_vec_scale(turned(&s->forms, k, f->n[a]), -1);
        for (uint32_t e = 0; e < f->edges; e++) {
            f->turned_way[e * forms + k] = turned(&s->forms, k, f->way[e]);
            f->moment[e * forms + k] = turned(&s->forms, k, pir_vec_cross(f->way[e], f->v[f->edge[e][0]]));
        }
        for (uint32_t p = 0; p < f->points; p++)
            f->turned_point[p * forms + k] = turned(&s->forms, k, point_of(f, p));
    }
    return true;
}

/* --- whether a translation is blocked at all rotations --- */

struct sum_search {
    pir_inner_search *of;
    const pir_turn_forms *forms;
    const struct faces *robot, *obstacle;
    double *reach; /* per facet of the obstacle and point of the robot: the most of n·R·p */
    pir_vec3 *o;   /* corners, then nearest points of edges and facets */
    int8_t *holds; /* per facet of the robot and o: whether its half-spaces have x, −1 where that is not known */
    bool *open[2]; /* edges of the obstacle, of the robot, whose facets do not serve */
    uint32_t os;
    double kept, rounded;
};

static bool open_search(struct sum_search *q) {
    const struct faces *r = q->robot, *o = q->obstacle;
    const int count = q->forms->count;
    q->os = o->vertices + o->edges + o->facets;
    q->kept = KEPT * (r->size + o->size);
    q->rounded = ROUNDED * (r->size + o->size);
    q->reach = take(q->of, (size_t)o->facets * r->points, sizeof *q->reach);
    q->o = take(q->of, q->os, sizeof *q->o);
    q->holds = take(q->of, (size_t)q->os * r->facets, sizeof *q->holds);
    q->open[0] = take(q->of, o->edges, sizeof(bool));
    q->open[1] = take(q->of, r->edges, sizeof(bool));
    if (q->of->space->status != PIR_OK)
        return false;
    for (uint32_t j = 0; j < o->facets; j++)
        for (uint32_t p = 0; p < r->points; p++) {
            double most = -INFINITY;
            for (int k = 0; k < count; k++)
                most = pir_greater(most, pir_vec_dot(o->n[j], r->turned_point[p * (count + 1) + k]));
            q->reach[j * r->points + p] = most;
        }
    memcpy(q->o, o->v, o->vertices * sizeof *q->o);
    return true;
}

/* Whether a point of the robot stays within a half-space of the obstacle. */
static inline bool point_stays(const struct sum_search *q, uint32_t facet, uint32_t p, double along) {
    return along + q->reach[facet * q->robot->points + p] - q->obstacle->d[facet] <= -q->kept;
}

/* Whether half-spaces of a facet of the robot have x, for an o. */
static bool facet_has(struct sum_search *q, uint32_t facet, uint32_t o, pir_vec3 x) {
    int8_t *known = &q->holds[facet * q->os + o];
    if (*known < 0) {
        const pir_vec3 way = pir_vec_along(x, -1, q->o[o]), *n = &q->robot->back[facet * (q->forms->count + 1)];
        const double most = q->robot->d[facet] - q->kept;
        *known = pir_vec_dot(n[q->forms->count], way) <= most;
        int beyond = 0;
        for (int k = 0; k < q->forms->count && *known; k++)
            beyond += !(pir_vec_dot(n[k], way) <= most);
        *known = *known && beyond == 0;
    }
    return *known;
}

/* The points of edges and facets nearest to x. */
static void set_nearest(struct sum_search *q, pir_vec3 x) {
    const struct faces *o = q->obstacle;
    for (uint32_t e = 0; e < o->edges; e++) {
        const pir_vec3 a = o->v[o->edge[e][0]], b = o->v[o->edge[e][1]], way = pir_vec_along(b, -1, a);
        const double part = pir_vec_dot(pir_vec_along(x, -1, a), way) / pir_vec_dot(way, way);
        q->o[o->vertices + e] = part <= 0 ? a : part >= 1 ? b : pir_vec_along(a, part, way);
    }
    for (uint32_t j = 0; j < o->facets; j++) {
        const pir_vec3 at = pir_vec_along(x, o->d[j] - pir_vec_dot(o->n[j], x), o->n[j]);
        bool is_own = true;
        for (uint32_t i = 0; i < o->facets && is_own; i++)
            is_own = i == j || pir_vec_dot(o->n[i], at) <= o->d[i] - q->rounded;
        q->o[o->vertices + o->edges + j] = is_own ? at : o->v[0];
    }
    for (uint32_t i = 0; i < q->os * q->robot->facets; i++)
        q->holds[i] = -1;
}

/* Facets of the obstacle, and then those at each of its edges. */
static bool obstacle_holds(struct sum_search *q, pir_vec3 x) {
    const struct faces *o = q->obstacle;
    for (uint32_t j = 0; j < o->facets; j++) {
        bool has = false;
        const double along = pir_vec_dot(o->n[j], x);
        for (uint32_t p = 0; p < q->robot->points && !has; p++)
            has = point_stays(q, j, p, along);
        if (!has)
            return false;
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        const uint32_t *side = o->side[e];
        const double along[2] = {pir_vec_dot(o->n[side[0]], x), pir_vec_dot(o->n[side[1]], x)};
        q->open[0][e] = true;
        for (uint32_t p = 0; p < q->robot->points && q->open[0][e]; p++)
            q->open[0][e] = !(point_stays(q, side[0], p, along[0]) && point_stays(q, side[1], p, along[1]));
    }
    return true;
}

static bool robot_holds(struct sum_search *q, pir_vec3 x) {
    const struct faces *r = q->robot;
    for (uint32_t a = 0; a < r->facets; a++) {
        bool has = false;
        for (uint32_t o = q->os; o-- > 0 && !has;)
            has = facet_has(q, a, o, x);
        if (!has)
            return false;
    }
    for (uint32_t e = 0; e < r->edges; e++) {
        q->open[1][e] = true;
        for (uint32_t o = q->os; o-- > 0 && q->open[1][e];)
            q->open[1][e] = !(facet_has(q, r->side[e][0], o, x) && facet_has(q, r->side[e][1], o, x));
    }
    return true;
}

/* Whether N·(x − o + R·p) ≤ 0 for N of e and an edge of the robot, and an o and p. */
static bool edges_have(const struct sum_search *q, pir_vec3 e, uint32_t f, pir_vec3 way, uint32_t p) {
    const int count = q->forms->count;
    const struct faces *r = q->robot;
    const pir_vec3 *to = &r->turned_way[f * (count + 1)], *moment = &r->moment[f * (count + 1)];
    const bool is_own = p == r->edge[f][0];
    const pir_vec3 of_p = pir_vec_cross(r->way[f], r->v[p]);
    for (int i = 0; i <= count; i++) {
        const int k = i == 0 ? count : i - 1;
        const pir_vec3 n = pir_vec_cross(e, to[k]);
        const double most =
            pir_vec_dot(n, way) + pir_vec_dot(e, is_own ? moment[k] : turned(q->forms, k, of_p)) + q->rounded;
        if (!(most <= 0 && most * most >= q->kept * q->kept * pir_vec_dot(n, n)))
            return false;
    }
    return true;
}

/* The corner that is farthest along a direction. */
static uint32_t farthest(const struct faces *f, pir_vec3 along) {
    uint32_t best = 0;
    for (uint32_t i = 1; i < f->vertices; i++)
        best = pir_vec_dot(f->v[i], along) > pir_vec_dot(f->v[best], along) ? i : best;
    return best;
}

static bool pair_holds(const struct sum_search *q, uint32_t e, uint32_t f, double sign, pir_vec3 x) {
    const struct faces *r = q->robot, *b = q->obstacle;
    const int middle = q->forms->count;
    const pir_vec3 own = pir_vec_scale(b->way[e], sign);
    const pir_vec3 n = pir_vec_cross(own, r->turned_way[f * (middle + 1) + middle]);
    const pir_vec3 *row = q->forms->row[middle];
    // the transposed turns a direction back
    const pir_vec3 back = {row[0].x * n.x + row[1].x * n.y + row[2].x * n.z,
                           row[0].y * n.x + row[1].y * n.y + row[2].y * n.z,
                           row[0].z * n.x + row[1].z * n.y + row[2].z * n.z};
    const uint32_t o[2] = {b->edge[e][0], farthest(b, n)}, p[2] = {r->edge[f][0], farthest(r, pir_vec_scale(back, -1))};
    for (int i = 0; i < 4; i++)
        if (edges_have(q, own, f, pir_vec_along(x, -1, b->v[o[i & 1]]), p[i >> 1]))
            return true;
    return false;
}

/* Whether one o is in the robot throughout. */
static bool one_is_met(struct sum_search *q, pir_vec3 x) {
    for (uint32_t o = q->os; o-- > 0;) {
        bool has = true;
        for (uint32_t a = 0; a < q->robot->facets && has; a++)
            has = facet_has(q, a, o, x);
        if (has)
            return true;
    }
    return false;
}

/* Whether x is in S(q) for all rotations, with room. */
static bool is_within(struct sum_search *q, pir_vec3 x) {
    set_nearest(q, x);
    if (one_is_met(q, x))
        return true;
    if (!obstacle_holds(q, x) || !robot_holds(q, x))
        return false;
    for (uint32_t e = 0; e < q->obstacle->edges; e++)
        for (uint32_t f = 0; f < q->robot->edges && q->open[0][e]; f++)
            if (q->open[1][f] && !(pair_holds(q, e, f, 1, x) && pair_holds(q, e, f, -1, x)))
                return false;
    return true;
}

/* --- points --- */

static pir_vec3 rounded(pir_vec3 x, double grid) {
    return (pir_vec3){rint(x.x / grid) * grid, rint(x.y / grid) * grid, rint(x.z / grid) * grid};
}

/* The farthest part of a way from a point, between a good one and a bad one, at which it is within. */
static double last_within(struct sum_search *q, pir_vec3 from, pir_vec3 way, double good, double bad, int steps) {
    for (int i = 0; i < steps; i++) {
        const double half = (good + bad) / 2;
        if (is_within(q, pir_vec_along(from, half, way)))
            good = half;
        else
            bad = half;
    }
    return good;
}

/* Moves a point o − R·p inwards until it is within; false where it never is. */
static bool move_within(struct sum_search *q, pir_vec3 o, pir_vec3 *x) {
    const struct faces *r = q->robot, *b = q->obstacle;
    const pir_vec3 inwards = pir_vec_along(b->middle, -1, o);
    const double length = sqrt(pir_vec_dot(inwards, inwards)), far = INWARDS * r->size;
    const pir_vec3 to = pir_vec_along(pir_vec_along(o, length > far ? far / length : 1, inwards), -1,
                                      turned(q->forms, q->forms->count, r->middle));
    const pir_vec3 from = *x, way = pir_vec_along(to, -1, from);
    if (!is_within(q, to))
        return false;
    *x = pir_vec_along(from, last_within(q, from, way, 1, 0, IN_STEPS), way);
    return true;
}

/* Corners of the sum at the middle rotation, moved inwards. */
static size_t list_points(struct sum_search *q, const pir_mesh *mesh, double grid, pir_vec3 *x) {
    const uint32_t corners = pir_mesh_vertex_count(mesh);
    const pir_vec3 *at = pir_mesh_vertices(mesh);
    size_t count = 0;
    for (uint32_t v = 0; v < corners; v++) {
        uint32_t of[2];
        pir_mesh_pair(mesh, v, of);
        x[count] = at[v];
        count += move_within(q, q->obstacle->v[of[1]], &x[count]);
    }
    for (size_t i = 0; i < count; i++)
        x[i] = rounded(x[i], grid);
    return count;
}

/* Moves a point outwards as far as it stays within. */
static double move_outwards(struct sum_search *q, pir_vec3 along, double most, pir_vec3 *x) {
    const double good = last_within(q, *x, along, 0, most, OUT_STEPS);
    *x = pir_vec_along(*x, good, along);
    return good;
}

/* How far a translation is beyond the bounds. */
static double beyond(const struct sum_search *q, pir_vec3 x) {
    const double *low = q->of->question->low, *high = q->of->question->high;
    const double out[3] = {fmax(low[0] - x.x, x.x - high[0]), fmax(low[1] - x.y, x.y - high[1]),
                           fmax(low[2] - x.z, x.z - high[2])};
    return fmax(0, fmax(out[0], fmax(out[1], out[2])));
}

/* Adds points before the middles of facets; how many. */
static size_t add_before(struct sum_search *q, const pir_polytope *made, double grid, pir_vec3 *x) {
    size_t count = 0;
    uint32_t *corner = take(q->of, pir_polytope_vertex_count(made), sizeof *corner);
    for (uint32_t f = 0; corner && f < pir_polytope_facet_count(made); f++) {
        const uint32_t size = pir_polytope_facet_size(made, f);
        pir_vec3 middle = {0, 0, 0};
        pir_polytope_facet(made, f, corner);
        for (uint32_t k = 0; k < size; k++)
            middle = pir_vec_along(middle, 1.0 / size, pir_polytope_vertex(made, corner[k]));
        const double most = OUTWARDS * q->robot->size;
        if (beyond(q, middle) > 0)
            continue;
        x[count] = middle;
        if (move_outwards(q, pir_polytope_normal(made, f), most, &x[count]) > most * GAIN) {
            x[count] = rounded(x[count], grid);
            count++;
        }
    }
    return count;
}

static pir_status hull_of(pir_vec3 *x, size_t count, pir_polytope **ret_inner) {
    *ret_inner = NULL;
    // flat ones have no inside
    if (count > 3 && pir_polytope_create(x, count, NULL, ret_inner) == PIR_ERR_MEMORY)
        return PIR_ERR_MEMORY;
    if (*ret_inner && pir_polytope_dimension(*ret_inner) < 3) {
        pir_polytope_release(*ret_inner);
        *ret_inner = NULL;
    }
    return PIR_OK;
}

/* Adds points before facets of a polytope, which is then another. */
static pir_status grow(struct sum_search *q, double grid, pir_polytope **made) {
    const uint32_t old = pir_polytope_vertex_count(*made);
    pir_vec3 *x = take(q->of, (size_t)old + pir_polytope_facet_count(*made), sizeof *x);
    if (!x)
        return q->of->space->status;
    for (uint32_t i = 0; i < old; i++)
        x[i] = pir_polytope_vertex(*made, i);
    const size_t added = add_before(q, *made, grid, x + old);
    pir_polytope *larger = NULL;
    const pir_status status = added > 0 ? hull_of(x, old + added, &larger) : q->of->space->status;
    if (larger) {
        pir_polytope_release(*made);
        *made = larger;
    }
    return status;
}

/* Corners of a simplex: one, and each time the one farthest from what those before span. */
static void choose_simplex(const pir_vec3 *v, uint32_t count, pir_vec3 *rest, uint32_t chosen[4]) {
    memcpy(rest, v, count * sizeof *v);
    chosen[0] = 0;
    for (uint32_t i = 0; i < count; i++)
        rest[i] = pir_vec_along(v[i], -1, v[0]);
    for (int n = 1; n < 4; n++) {
        uint32_t best = 0;
        for (uint32_t i = 1; i < count; i++)
            best = pir_vec_dot(rest[i], rest[i]) > pir_vec_dot(rest[best], rest[best]) ? i : best;
        chosen[n] = best;
        const pir_vec3 way = pir_vec_scale(rest[best], 1 / sqrt(pir_vec_dot(rest[best], rest[best])));
        for (uint32_t i = 0; i < count; i++)
            rest[i] = pir_vec_along(rest[i], -pir_vec_dot(rest[i], way), way);
    }
}

/* The point that is farthest beyond facets of a polytope of few corners; none is where the count is returned. */
static uint32_t farthest_beyond(const struct sum_search *q, const pir_polytope *made, const pir_vec3 *v,
                                uint32_t count) {
    uint32_t best = count;
    double most = 0;
    for (uint32_t i = 0; i < count; i++) {
        const double weight = 1 / (1 + FAR_OUT * beyond(q, v[i]));
        for (uint32_t f = 0; f < pir_polytope_facet_count(made); f++) {
            uint32_t corner[PIR_INNER_CORNERS];
            pir_polytope_facet(made, f, corner);
            const pir_vec3 way = pir_vec_along(v[i], -1, pir_polytope_vertex(made, corner[0]));
            const double far = weight * pir_vec_dot(pir_polytope_normal(made, f), way);
            best = far > most ? i : best;
            most = fmax(most, far);
        }
    }
    return best;
}

/* Leaves a polytope few corners: divisions cost as its facets. */
static pir_status thin_out(struct sum_search *q, pir_polytope **made) {
    const uint32_t count = pir_polytope_vertex_count(*made);
    pir_vec3 *v = take(q->of, count, sizeof *v), *rest = take(q->of, count, sizeof *rest), x[PIR_INNER_CORNERS];
    uint32_t chosen[PIR_INNER_CORNERS], now = 4;
    if (!v || !rest)
        return q->of->space->status;
    for (uint32_t i = 0; i < count; i++)
        v[i] = pir_polytope_vertex(*made, i);
    choose_simplex(v, count, rest, chosen);
    pir_polytope_release(*made);
    *made = NULL;
    for (pir_status status;; now++) {
        for (uint32_t i = 0; i < now; i++)
            x[i] = v[chosen[i]];
        pir_polytope_release(*made);
        status = hull_of(x, now, made);
        if (!*made || now == PIR_INNER_CORNERS)
            return status;
        chosen[now] = farthest_beyond(q, *made, v, count);
        if (chosen[now] == count)
            return status;
    }
}

static double grid_of(const struct sum_search *q) {
    return ldexp(1, ilogb(q->robot->size + q->obstacle->size) - GRID_BITS);
}

static pir_status sum_within(pir_polytope *back, pir_polytope *obstacle, struct sum_search *q,
                             pir_polytope **ret_inner) {
    const double grid = grid_of(q);
    pir_sum *made = NULL;
    pir_mesh *mesh = NULL;
    pir_status status = pir_sum_create(back, obstacle, q->of->middle, NULL, &made);
    if (status == PIR_OK)
        status = pir_sum_mesh(made, PIR_DOUBLE, &mesh);
    if (status == PIR_OK) {
        pir_vec3 *x = take(q->of, pir_mesh_vertex_count(mesh), sizeof *x);
        status = x ? hull_of(x, list_points(q, mesh, grid, x), ret_inner) : q->of->space->status;
    }
    if (status == PIR_OK && *ret_inner)
        status = grow(q, grid, ret_inner);
    if (status == PIR_OK && *ret_inner)
        status = thin_out(q, ret_inner);
    pir_mesh_destroy(mesh);
    pir_sum_destroy(made);
    return status;
}

static pir_quat middle_of(const pir_plan_turns *turns) {
    pir_quat m = {0, 0, 0, 0};
    for (int i = 0; i < turns->count; i++) {
        const pir_quat q = turns->q[i];
        m = (pir_quat){m.x + q.x, m.y + q.y, m.z + q.z, m.w + q.w};
    }
    return m;
}

/* --- searches --- */

static pir_inner_search *new_search(const pir_rigid_question *question, pir_plan_space *space) {
    pir_inner_search *s = pir_plan_new(space, 1, sizeof *s);
    if (s)
        *s = (pir_inner_search){.question = question, .space = space};
    return s;
}

pir_status pir_inner_search_open(const pir_rigid_question *question, const pir_plan_turns *turns, pir_plan_space *space,
                                 pir_inner_search **ret_search) {
    const uint32_t robots = question->robot->count, obstacles = question->wide->count;
    pir_inner_search *s = *ret_search = new_search(question, space);
    if (!s)
        return space->status;
    s->forms = pir_turn_forms_of(turns);
    s->middle = middle_of(turns);
    s->robot = take(s, robots, sizeof *s->robot);
    s->obstacle = take(s, obstacles, sizeof *s->obstacle);
    s->pair = take(s, (size_t)robots * obstacles, sizeof *s->pair);
    bool good = space->status == PIR_OK;
    for (uint32_t k = 0; k < robots && good; k++)
        good = read_faces(s, question->robot->at[k], &s->robot[k]) && turn_faces(s, &s->robot[k]);
    for (uint32_t l = 0; l < obstacles && good; l++)
        good = read_faces(s, question->wide->at[l], &s->obstacle[l]);
    for (uint32_t i = 0; i < robots * obstacles && good; i++) {
        s->pair[i] = (struct sum_search){
            .of = s, .forms = &s->forms, .robot = &s->robot[i / obstacles], .obstacle = &s->obstacle[i % obstacles]};
        good = open_search(&s->pair[i]);
    }
    return space->status;
}

void pir_inner_search_close(pir_inner_search *s) {
    if (!s)
        return;
    free_from(s, NULL);
    pir_plan_free(s->space, s, 1, sizeof *s);
}

double pir_inner_depth(const pir_inner_search *search, uint32_t pair, const double at[3]) {
    const struct sum_search *s = &search->pair[pair];
    const struct faces *r = s->robot, *b = s->obstacle;
    const int middle = s->forms->count;
    const pir_vec3 x = {at[0], at[1], at[2]};
    double least = INFINITY;
    for (uint32_t a = 0; a < r->facets && least > 0; a++) {
        const pir_vec3 n = r->back[a * (middle + 1) + middle];
        double most = -INFINITY;
        for (uint32_t o = 0; o < b->vertices; o++)
            most = pir_greater(most, pir_vec_dot(n, b->v[o]));
        least = pir_lesser(least, r->d[a] + most - pir_vec_dot(n, x));
    }
    for (uint32_t j = 0; j < b->facets && least > 0; j++) {
        double most = -INFINITY;
        for (uint32_t p = 0; p < r->vertices; p++)
            most = pir_greater(most, -pir_vec_dot(b->n[j], r->turned_point[p * (middle + 1) + middle]));
        least = pir_lesser(least, b->d[j] + most - pir_vec_dot(b->n[j], x));
    }
    return least;
}

bool pir_inner_has(pir_inner_search *search, uint32_t pair, const double at[3]) {
    return is_within(&search->pair[pair], (pir_vec3){at[0], at[1], at[2]});
}

pir_status pir_inner_sum_make(pir_inner_search *search, uint32_t pair, pir_polytope **ret_sum) {
    const uint32_t obstacles = search->question->wide->count;
    struct block *last = search->first;
    pir_polytope *back = NULL;
    pir_status status = pir_polytope_reflect(search->question->robot->at[pair / obstacles], &back);
    *ret_sum = NULL;
    if (status == PIR_OK)
        status = sum_within(back, search->question->wide->at[pair % obstacles], &search->pair[pair], ret_sum);
    free_from(search, last);
    pir_polytope_release(back);
    return status;
}

pir_status pir_inner_sum_widen(pir_inner_search *search, const pir_polytope *sum, const pir_vec3 *more, uint32_t count,
                               pir_polytope **ret_wider) {
    const uint32_t old = pir_polytope_vertex_count(sum);
    struct block *last = search->first;
    pir_vec3 *x = take(search, (size_t)old + count, sizeof *x);
    *ret_wider = NULL;
    if (!x)
        return search->space->status;
    for (uint32_t i = 0; i < old; i++)
        x[i] = pir_polytope_vertex(sum, i);
    memcpy(x + old, more, count * sizeof *x);
    const pir_status status = hull_of(x, old + count, ret_wider);
    free_from(search, last);
    return status;
}

/* How far a point is beyond the facet that it is farthest beyond. */
static double beyond_facets(const pir_polytope *sum, pir_vec3 x, pir_vec3 *ret_normal) {
    double most = -INFINITY;
    for (uint32_t f = 0; f < pir_polytope_facet_count(sum); f++) {
        uint32_t corner[PIR_INNER_CORNERS + PIR_INNER_MORE];
        pir_polytope_facet(sum, f, corner);
        const pir_vec3 n = pir_polytope_normal(sum, f);
        const double far = pir_vec_dot(n, pir_vec_along(x, -1, pir_polytope_vertex(sum, corner[0])));
        *ret_normal = far > most ? n : *ret_normal;
        most = fmax(most, far);
    }
    return most;
}

double pir_inner_sum_far(const pir_polytope *sum, const double at[3]) {
    pir_vec3 way = {0, 0, 0};
    return beyond_facets(sum, (pir_vec3){at[0], at[1], at[2]}, &way);
}

bool pir_inner_sum_point(pir_inner_search *search, uint32_t pair, const pir_polytope *sum, const double at[3],
                         pir_vec3 *ret_point) {
    struct sum_search *q = &search->pair[pair];
    pir_vec3 way = {0, 0, 0}, x = {at[0], at[1], at[2]};
    beyond_facets(sum, x, &way);
    *ret_point = rounded(x, grid_of(q));
    move_outwards(q, way, OUTWARDS * q->robot->size, &x);
    const pir_vec3 farther = rounded(x, grid_of(q));
    // what is kept is looked at again as it is kept
    if (is_within(q, farther)) {
        *ret_point = farther;
        return true;
    }
    return is_within(q, *ret_point);
}
