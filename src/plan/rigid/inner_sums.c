/* SPDX-License-Identifier: MIT */
/* See inner_sums.h. */
#include "plan/rigid/inner_sums.h"

#include <math.h>
#include <stdlib.h>

#include <pirouette/sum.h>

#define GRID_BITS 24
#define KEPT      0x1p-22 /* of the size: how far points stay within half-spaces, unrounded */
#define ROUNDED   0x1p-44 /* of the size: more than what doubles lose */
#define INWARDS   0.7     /* how far obstacles' points are moved, beside the robot's size */
#define IN_STEPS  6       /* halvings of the way that a point is moved inwards */
#define OUTWARDS  0.5     /* how far points are moved outwards at most, beside the robot's size */
#define OUT_STEPS 5
#define ROUNDS    3    /* of points before facets */
#define GAIN      0.04 /* the least part of OUTWARDS that a point is to be before its facet */

static double dot(pir_vec3 a, pir_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static pir_vec3 sum_of(pir_vec3 a, double s, pir_vec3 b) {
    return (pir_vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static pir_vec3 times(double s, pir_vec3 a) {
    return (pir_vec3){s * a.x, s * a.y, s * a.z};
}

static pir_vec3 cross(pir_vec3 a, pir_vec3 b) {
    return (pir_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static pir_vec3 turned(const pir_turn_forms *forms, int which, pir_vec3 v) {
    const pir_vec3 *row = forms->row[which];
    return (pir_vec3){dot(row[0], v), dot(row[1], v), dot(row[2], v)};
}

/* --- pieces --- */

/* A piece: its corners, half-spaces n·x ≤ d of unit normals, edges with the two facets at each. */
struct faces {
    pir_vec3 *v, *n;
    double *d, size;
    uint32_t (*edge)[2], (*side)[2];
    pir_vec3 *way, middle; /* of edges, of length 1; the mean of corners */
    uint32_t vertices, facets, edges;
};

static void free_faces(struct faces *f) {
    free(f->v);
    free(f->n);
    free(f->d);
    free(f->edge);
    free(f->side);
    free(f->way);
}

/* Notes that a facet goes from one corner to another. */
static void add_side(struct faces *f, uint32_t facet, uint32_t a, uint32_t b) {
    for (uint32_t e = 0; e < f->edges; e++)
        if (f->edge[e][0] == b && f->edge[e][1] == a) {
            f->side[e][1] = facet;
            return;
        }
    const pir_vec3 way = sum_of(f->v[b], -1, f->v[a]);
    f->way[f->edges] = times(1 / sqrt(dot(way, way)), way);
    f->edge[f->edges][0] = a;
    f->edge[f->edges][1] = b;
    f->side[f->edges++][0] = facet;
}

static bool read_faces(const pir_polytope *piece, struct faces *f) {
    const uint32_t vertices = pir_polytope_vertex_count(piece), facets = pir_polytope_facet_count(piece);
    const uint32_t edges = pir_polytope_edge_count(piece);
    uint32_t *corner = calloc(vertices, sizeof *corner);
    *f = (struct faces){.v = calloc(vertices, sizeof *f->v),
                        .n = calloc(facets, sizeof *f->n),
                        .d = calloc(facets, sizeof *f->d),
                        .edge = calloc(edges, sizeof *f->edge),
                        .side = calloc(edges, sizeof *f->side),
                        .way = calloc(edges, sizeof *f->way),
                        .vertices = vertices,
                        .facets = facets};
    const bool good = corner && f->v && f->n && f->d && f->edge && f->side && f->way;
    for (uint32_t i = 0; i < vertices && good; i++) {
        f->v[i] = pir_polytope_vertex(piece, i);
        f->size = fmax(f->size, sqrt(dot(f->v[i], f->v[i])));
        f->middle = sum_of(f->middle, 1.0 / vertices, f->v[i]);
    }
    for (uint32_t i = 0; i < facets && good; i++) {
        const uint32_t size = pir_polytope_facet_size(piece, i);
        pir_polytope_facet(piece, i, corner);
        f->n[i] = pir_polytope_normal(piece, i);
        f->d[i] = dot(f->n[i], f->v[corner[0]]);
        for (uint32_t k = 0; k < size; k++)
            if (corner[k] < corner[(k + 1) % size])
                add_side(f, i, corner[k], corner[(k + 1) % size]);
    }
    for (uint32_t i = 0; i < facets && good; i++) {
        const uint32_t size = pir_polytope_facet_size(piece, i);
        pir_polytope_facet(piece, i, corner);
        for (uint32_t k = 0; k < size; k++)
            if (corner[k] > corner[(k + 1) % size])
                add_side(f, i, corner[k], corner[(k + 1) % size]);
    }
    free(corner);
    return good;
}

/* --- whether a translation is blocked at all rotations --- */

struct sum_search {
    const pir_turn_forms *forms;
    const struct faces *robot, *obstacle;
    double *reach;  /* per facet of the obstacle and point of the robot: the most of n·R·p */
    pir_vec3 *back; /* per facet of the robot and form: the normal turned and reflected */
    pir_vec3 *o;    /* corners, then nearest points of edges */
    int8_t *holds;  /* per facet of the robot and o: whether its half-spaces have x, −1 where that is not known */
    bool *open[2];  /* edges of the obstacle, of the robot, whose facets do not serve */
    uint32_t points, os;
    const double *low, *high; /* bounds of translations */
    double kept, rounded;
};

static void finish_search(struct sum_search *q) {
    free(q->reach);
    free(q->back);
    free(q->o);
    free(q->holds);
    free(q->open[0]);
    free(q->open[1]);
}

static pir_vec3 point_of(const struct faces *f, uint32_t i) {
    if (i < f->vertices)
        return f->v[i];
    if (i == f->vertices)
        return f->middle;
    const uint32_t *edge = f->edge[i - f->vertices - 1];
    return times(0.5, sum_of(f->v[edge[0]], 1, f->v[edge[1]]));
}

static bool open_search(struct sum_search *q) {
    const struct faces *r = q->robot, *o = q->obstacle;
    const int count = q->forms->count;
    q->points = r->vertices + r->edges + 1;
    q->os = o->vertices + o->edges + o->facets;
    q->kept = KEPT * (r->size + o->size);
    q->rounded = ROUNDED * (r->size + o->size);
    q->reach = calloc((size_t)o->facets * q->points, sizeof *q->reach);
    q->back = calloc((size_t)r->facets * (count + 1), sizeof *q->back);
    q->o = calloc(q->os, sizeof *q->o);
    q->holds = calloc((size_t)q->os * r->facets, sizeof *q->holds);
    q->open[0] = calloc(o->edges, sizeof(bool));
    q->open[1] = calloc(r->edges, sizeof(bool));
    if (!q->reach || !q->back || !q->o || !q->holds || !q->open[0] || !q->open[1])
        return false;
    for (uint32_t p = 0; p < q->points; p++) {
        const pir_vec3 own = point_of(r, p);
        for (uint32_t j = 0; j < o->facets; j++)
            q->reach[j * q->points + p] = -INFINITY;
        for (int k = 0; k < count; k++) {
            const pir_vec3 at = turned(q->forms, k, own);
            for (uint32_t j = 0; j < o->facets; j++)
                q->reach[j * q->points + p] = fmax(q->reach[j * q->points + p], dot(o->n[j], at));
        }
    }
    for (uint32_t a = 0; a < r->facets; a++)
        for (int k = 0; k <= count; k++)
            q->back[a * (count + 1) + k] = times(-1, turned(q->forms, k, r->n[a]));
    for (uint32_t i = 0; i < o->vertices; i++)
        q->o[i] = o->v[i];
    return true;
}

/* Whether a point of the robot stays within a half-space of the obstacle. */
static inline bool point_stays(const struct sum_search *q, uint32_t facet, uint32_t p, double along) {
    return along + q->reach[facet * q->points + p] - q->obstacle->d[facet] <= -q->kept;
}

/* Whether half-spaces of a facet of the robot have x, for an o. */
static bool facet_has(struct sum_search *q, uint32_t facet, uint32_t o, pir_vec3 x) {
    int8_t *known = &q->holds[facet * q->os + o];
    if (*known < 0) {
        const pir_vec3 way = sum_of(x, -1, q->o[o]), *n = &q->back[facet * (q->forms->count + 1)];
        const double most = q->robot->d[facet] - q->kept;
        *known = dot(n[q->forms->count], way) <= most;
        for (int k = 0; k < q->forms->count && *known; k++)
            *known = dot(n[k], way) <= most;
    }
    return *known;
}

/* The points of edges and facets nearest to x. */
static void set_nearest(struct sum_search *q, pir_vec3 x) {
    const struct faces *o = q->obstacle;
    for (uint32_t e = 0; e < o->edges; e++) {
        const pir_vec3 a = o->v[o->edge[e][0]], b = o->v[o->edge[e][1]], way = sum_of(b, -1, a);
        const double part = dot(sum_of(x, -1, a), way) / dot(way, way);
        q->o[o->vertices + e] = part <= 0 ? a : part >= 1 ? b : sum_of(a, part, way);
    }
    for (uint32_t j = 0; j < o->facets; j++) {
        const pir_vec3 at = sum_of(x, o->d[j] - dot(o->n[j], x), o->n[j]);
        bool is_own = true;
        for (uint32_t i = 0; i < o->facets && is_own; i++)
            is_own = i == j || dot(o->n[i], at) <= o->d[i] - q->rounded;
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
        const double along = dot(o->n[j], x);
        for (uint32_t p = 0; p < q->points && !has; p++)
            has = point_stays(q, j, p, along);
        if (!has)
            return false;
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        const uint32_t *side = o->side[e];
        const double along[2] = {dot(o->n[side[0]], x), dot(o->n[side[1]], x)};
        q->open[0][e] = true;
        for (uint32_t p = 0; p < q->points && q->open[0][e]; p++)
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

/* Whether N·(x − o + R·p) ≤ 0 for N of two edges, times a sign, and an o and p. */
static bool edges_have(const struct sum_search *q, pir_vec3 e, pir_vec3 f, pir_vec3 way, pir_vec3 p) {
    const pir_vec3 of_p = cross(f, p);
    const int count = q->forms->count;
    for (int i = 0; i <= count; i++) {
        const int k = i == 0 ? count : i - 1;
        const pir_vec3 n = cross(e, turned(q->forms, k, f));
        if (!(dot(n, way) + dot(e, turned(q->forms, k, of_p)) <= -q->kept * sqrt(dot(n, n)) - q->rounded))
            return false;
    }
    return true;
}

/* The corner that is farthest along a direction. */
static pir_vec3 farthest(const struct faces *f, pir_vec3 along) {
    uint32_t best = 0;
    for (uint32_t i = 1; i < f->vertices; i++)
        best = dot(f->v[i], along) > dot(f->v[best], along) ? i : best;
    return f->v[best];
}

static bool pair_holds(const struct sum_search *q, uint32_t e, uint32_t f, double sign, pir_vec3 x) {
    const struct faces *r = q->robot, *b = q->obstacle;
    const pir_vec3 own = times(sign, b->way[e]), other = r->way[f];
    const pir_vec3 n = cross(own, turned(q->forms, q->forms->count, other));
    const pir_vec3 *row = q->forms->row[q->forms->count];
    // the transposed turns a direction back
    const pir_vec3 back = {row[0].x * n.x + row[1].x * n.y + row[2].x * n.z,
                           row[0].y * n.x + row[1].y * n.y + row[2].y * n.z,
                           row[0].z * n.x + row[1].z * n.y + row[2].z * n.z};
    const pir_vec3 o[2] = {b->v[b->edge[e][0]], farthest(b, n)};
    const pir_vec3 p[2] = {r->v[r->edge[f][0]], farthest(r, times(-1, back))};
    for (int i = 0; i < 4; i++)
        if (edges_have(q, own, other, sum_of(x, -1, o[i & 1]), p[i >> 1]))
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

/* Moves a point o − R·p inwards until it is within; false where it never is. */
static bool move_within(struct sum_search *q, pir_vec3 o, pir_vec3 *x) {
    const struct faces *r = q->robot, *b = q->obstacle;
    const pir_vec3 inwards = sum_of(b->middle, -1, o);
    const double length = sqrt(dot(inwards, inwards)), far = INWARDS * r->size;
    const pir_vec3 to =
        sum_of(sum_of(o, length > far ? far / length : 1, inwards), -1, turned(q->forms, q->forms->count, r->middle));
    const pir_vec3 from = *x, way = sum_of(to, -1, from);
    double good = 1, bad = 0;
    if (!is_within(q, to))
        return false;
    for (int i = 0; i < IN_STEPS; i++) {
        const double half = (good + bad) / 2;
        if (is_within(q, sum_of(from, half, way)))
            good = half;
        else
            bad = half;
    }
    *x = sum_of(from, good, way);
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
    const pir_vec3 from = *x;
    double good = 0, bad = most;
    for (int i = 0; i < OUT_STEPS; i++) {
        const double half = (good + bad) / 2;
        if (is_within(q, sum_of(from, half, along)))
            good = half;
        else
            bad = half;
    }
    *x = sum_of(from, good, along);
    return good;
}

/* Whether a box has a point. */
static bool box_has(const double low[3], const double high[3], pir_vec3 x) {
    return x.x >= low[0] && x.y >= low[1] && x.z >= low[2] && x.x <= high[0] && x.y <= high[1] && x.z <= high[2];
}

/* Adds points before the middles of facets; how many. */
static size_t add_before(struct sum_search *q, const pir_polytope *made, double grid, pir_vec3 *x) {
    size_t count = 0;
    uint32_t *corner = calloc(pir_polytope_vertex_count(made), sizeof *corner);
    for (uint32_t f = 0; corner && f < pir_polytope_facet_count(made); f++) {
        const uint32_t size = pir_polytope_facet_size(made, f);
        pir_vec3 middle = {0, 0, 0};
        pir_polytope_facet(made, f, corner);
        for (uint32_t k = 0; k < size; k++)
            middle = sum_of(middle, 1.0 / size, pir_polytope_vertex(made, corner[k]));
        const double most = OUTWARDS * q->robot->size;
        if (!box_has(q->low, q->high, middle))
            continue;
        x[count] = middle;
        if (move_outwards(q, pir_polytope_normal(made, f), most, &x[count]) > most * GAIN) {
            x[count] = rounded(x[count], grid);
            count++;
        }
    }
    free(corner);
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

/* Adds points before facets of a polytope, which is then another; whether it is. */
static pir_status grow(struct sum_search *q, double grid, pir_polytope **made, bool *ret_grown) {
    const uint32_t old = pir_polytope_vertex_count(*made);
    pir_vec3 *x = calloc((size_t)old + pir_polytope_facet_count(*made), sizeof *x);
    *ret_grown = false;
    if (!x)
        return PIR_ERR_MEMORY;
    for (uint32_t i = 0; i < old; i++)
        x[i] = pir_polytope_vertex(*made, i);
    const size_t added = add_before(q, *made, grid, x + old);
    pir_polytope *larger = NULL;
    const pir_status status = added > 0 ? hull_of(x, old + added, &larger) : PIR_OK;
    free(x);
    if (larger) {
        pir_polytope_release(*made);
        *made = larger;
        *ret_grown = true;
    }
    return status;
}

static pir_status sum_within(pir_polytope *back, pir_polytope *obstacle, pir_quat middle, struct sum_search *q,
                             pir_polytope **ret_inner) {
    const double size = q->robot->size + q->obstacle->size, grid = ldexp(1, ilogb(size) - GRID_BITS);
    pir_sum *made = NULL;
    pir_mesh *mesh = NULL;
    pir_status status = pir_sum_create(back, obstacle, middle, NULL, &made);
    if (status == PIR_OK)
        status = pir_sum_mesh(made, PIR_DOUBLE, &mesh);
    if (status == PIR_OK) {
        pir_vec3 *x = calloc(pir_mesh_vertex_count(mesh), sizeof *x);
        status = x ? hull_of(x, list_points(q, mesh, grid, x), ret_inner) : PIR_ERR_MEMORY;
        free(x);
    }
    bool is_grown = *ret_inner != NULL;
    for (int round = 0; round < ROUNDS && is_grown && status == PIR_OK; round++)
        status = grow(q, grid, ret_inner, &is_grown);
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

struct pir_inner_search {
    pir_turn_forms forms;
    pir_quat middle;
    const pir_rigid_question *question;
    struct faces *robot, *obstacle; /* of all pieces */
    struct sum_search *pair;
};

pir_status pir_inner_search_open(const pir_rigid_question *question, const pir_plan_turns *turns,
                                 pir_inner_search **ret_search) {
    const uint32_t robots = question->robot->count, obstacles = question->wide->count;
    pir_inner_search *s = calloc(1, sizeof *s);
    *ret_search = s;
    if (!s)
        return PIR_ERR_MEMORY;
    s->forms = pir_turn_forms_of(turns);
    s->middle = middle_of(turns);
    s->question = question;
    s->robot = calloc(robots, sizeof *s->robot);
    s->obstacle = calloc(obstacles, sizeof *s->obstacle);
    s->pair = calloc((size_t)robots * obstacles, sizeof *s->pair);
    bool good = s->robot && s->obstacle && s->pair;
    for (uint32_t k = 0; k < robots && good; k++)
        good = read_faces(question->robot->at[k], &s->robot[k]);
    for (uint32_t l = 0; l < obstacles && good; l++)
        good = read_faces(question->wide->at[l], &s->obstacle[l]);
    for (uint32_t i = 0; i < robots * obstacles && good; i++) {
        s->pair[i] = (struct sum_search){.forms = &s->forms,
                                         .robot = &s->robot[i / obstacles],
                                         .obstacle = &s->obstacle[i % obstacles],
                                         .low = question->low,
                                         .high = question->high};
        good = open_search(&s->pair[i]);
    }
    return good ? PIR_OK : PIR_ERR_MEMORY;
}

void pir_inner_search_close(pir_inner_search *s) {
    if (!s)
        return;
    const uint32_t robots = s->question->robot->count, obstacles = s->question->wide->count;
    for (uint32_t i = 0; s->pair && i < robots * obstacles; i++)
        finish_search(&s->pair[i]);
    for (uint32_t k = 0; s->robot && k < robots; k++)
        free_faces(&s->robot[k]);
    for (uint32_t l = 0; s->obstacle && l < obstacles; l++)
        free_faces(&s->obstacle[l]);
    free(s->robot);
    free(s->obstacle);
    free(s->pair);
    free(s);
}

double pir_inner_depth(const pir_inner_search *search, uint32_t pair, const double at[3]) {
    const struct sum_search *s = &search->pair[pair];
    const struct faces *r = s->robot, *b = s->obstacle;
    const int middle = s->forms->count;
    const pir_vec3 x = {at[0], at[1], at[2]};
    double least = INFINITY;
    for (uint32_t a = 0; a < r->facets && least > 0; a++) {
        const pir_vec3 n = s->back[a * (middle + 1) + middle];
        double most = -INFINITY;
        for (uint32_t o = 0; o < b->vertices; o++)
            most = fmax(most, dot(n, b->v[o]));
        least = fmin(least, r->d[a] + most - dot(n, x));
    }
    for (uint32_t j = 0; j < b->facets && least > 0; j++) {
        double most = -INFINITY;
        for (uint32_t p = 0; p < r->vertices; p++)
            most = fmax(most, -dot(b->n[j], turned(s->forms, middle, r->v[p])));
        least = fmin(least, b->d[j] + most - dot(b->n[j], x));
    }
    return least;
}

bool pir_inner_has(pir_inner_search *search, uint32_t pair, const double at[3]) {
    return is_within(&search->pair[pair], (pir_vec3){at[0], at[1], at[2]});
}

pir_status pir_inner_sum_make(pir_inner_search *search, uint32_t pair, pir_polytope **ret_sum) {
    const uint32_t obstacles = search->question->wide->count;
    pir_polytope *back = NULL;
    pir_status status = pir_polytope_reflect(search->question->robot->at[pair / obstacles], &back);
    *ret_sum = NULL;
    if (status == PIR_OK)
        status = sum_within(back, search->question->wide->at[pair % obstacles], search->middle, &search->pair[pair],
                            ret_sum);
    pir_polytope_release(back);
    return status;
}
