/* SPDX-License-Identifier: MIT */
/* See turn_bodies.h. */
#include "plan/turn_bodies.h"

#include <math.h>
#include <stdlib.h>

#define MARGIN 0x1p-28 /* of the size: how far outer pieces are grown */
#define KEPT   0x1p-42 /* of the size: how far inner pieces stay within half-spaces */
#define SAME   0x1p-40 /* half-spaces that differ by less are one */
#define ROOM   0x1p-14

#define MOST_FORMS (PIR_PLAN_TURNS * (PIR_PLAN_TURNS + 1) / 2)

static double dot(pir_vec3 a, pir_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static pir_vec3 sum_of(pir_vec3 a, double s, pir_vec3 b) {
    return (pir_vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static pir_vec3 times(double s, pir_vec3 a) {
    return (pir_vec3){s * a.x, s * a.y, s * a.z};
}

static double length_of(pir_vec3 a) {
    return sqrt(dot(a, a));
}

/* The rows of B(p, q) / p·q for each two of the quaternions, then those of the middle one. */
struct forms {
    pir_vec3 row[MOST_FORMS + 1][3];
    int count;
};

static void set_form(pir_quat p, pir_quat q, pir_vec3 row[3]) {
    const double ww = p.w * q.w, xx = p.x * q.x, yy = p.y * q.y, zz = p.z * q.z, scale = 1 / (ww + xx + yy + zz);
    const double xy = p.x * q.y + p.y * q.x, yz = p.y * q.z + p.z * q.y, zx = p.z * q.x + p.x * q.z;
    const double wx = p.w * q.x + p.x * q.w, wy = p.w * q.y + p.y * q.w, wz = p.w * q.z + p.z * q.w;
    row[0] = times(scale, (pir_vec3){ww + xx - yy - zz, xy - wz, zx + wy});
    row[1] = times(scale, (pir_vec3){xy + wz, ww - xx + yy - zz, yz - wx});
    row[2] = times(scale, (pir_vec3){zx - wy, yz + wx, ww - xx - yy + zz});
}

static struct forms forms_of(const pir_plan_turns *turns) {
    struct forms forms = {.count = 0};
    pir_quat middle = {0, 0, 0, 0};
    for (int i = 0; i < turns->count; i++) {
        const pir_quat q = turns->q[i];
        for (int k = i; k < turns->count; k++)
            set_form(q, turns->q[k], forms.row[forms.count++]);
        middle = (pir_quat){middle.x + q.x, middle.y + q.y, middle.z + q.z, middle.w + q.w};
    }
    set_form(middle, middle, forms.row[forms.count]);
    return forms;
}

static pir_vec3 turned(const struct forms *forms, int which, pir_vec3 v) {
    const pir_vec3 *row = forms->row[which];
    return (pir_vec3){dot(row[0], v), dot(row[1], v), dot(row[2], v)};
}

static double size_of(const pir_polytope *piece) {
    double size = 0;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(piece); v++)
        size = fmax(size, length_of(pir_polytope_vertex(piece, v)));
    return size;
}

static pir_vec3 mean_of(const pir_vec3 *v, size_t count) {
    pir_vec3 mean = {0, 0, 0};
    for (size_t i = 0; i < count; i++)
        mean = sum_of(mean, 1 / (double)count, v[i]);
    return mean;
}

static pir_vec3 middle_of(const pir_polytope *piece) {
    const uint32_t count = pir_polytope_vertex_count(piece);
    pir_vec3 mean = {0, 0, 0};
    for (uint32_t v = 0; v < count; v++)
        mean = sum_of(mean, 1 / (double)count, pir_polytope_vertex(piece, v));
    return mean;
}

/* Half-spaces n·x ≤ d of unit normals. */
struct halves {
    pir_vec3 *n;
    double *d;
    size_t count;
};

/* Facets of a piece over a set of rotations. */
struct turned_facets {
    const pir_polytope *piece;
    struct forms forms;
    struct halves all;    /* those of all forms, in the order of facets */
    struct halves chosen; /* those whose corners are looked for */
    uint32_t *corner;     /* of the facet at hand */
    pir_vec3 middle;      /* a point within, turned */
    double size;
};

static void add_half(struct halves *halves, pir_vec3 n, double d) {
    const double length = length_of(n);
    halves->n[halves->count] = times(1 / length, n);
    halves->d[halves->count++] = d / length;
}

/* All half-spaces of an arc's facet, but for those that are about the one before. */
static void choose_all(struct turned_facets *f, size_t first) {
    struct halves *to = &f->chosen;
    for (size_t i = first; i < f->all.count; i++) {
        const size_t last = to->count - 1;
        if (i > first && length_of(sum_of(to->n[last], -1, f->all.n[i])) < SAME) {
            to->d[last] = fmin(to->d[last], f->all.d[i]);
            continue;
        }
        to->n[to->count] = f->all.n[i];
        to->d[to->count++] = f->all.d[i];
    }
}

/* One half-space for a facet of so many corners: that at the middle, moved in. */
static void choose_one(struct turned_facets *f, pir_vec3 n, double d, uint32_t corners, size_t first) {
    const int middle = f->forms.count;
    double most = 0;
    for (uint32_t c = 0; c < corners; c++) {
        const pir_vec3 x = turned(&f->forms, middle, pir_polytope_vertex(f->piece, f->corner[c]));
        for (size_t i = first; i < f->all.count; i++)
            most = fmax(most, dot(f->all.n[i], x) - f->all.d[i]);
    }
    add_half(&f->chosen, turned(&f->forms, middle, n), d);
    f->chosen.d[f->chosen.count - 1] -= most;
}

static void list_halves(struct turned_facets *f) {
    for (uint32_t i = 0; i < pir_polytope_facet_count(f->piece); i++) {
        const pir_vec3 n = pir_polytope_normal(f->piece, i);
        const uint32_t corners = pir_polytope_facet_size(f->piece, i);
        const size_t first = f->all.count;
        pir_polytope_facet(f->piece, i, f->corner);
        const double d = dot(n, pir_polytope_vertex(f->piece, f->corner[0]));
        for (int k = 0; k < f->forms.count; k++)
            add_half(&f->all, turned(&f->forms, k, n), d);
        if (f->forms.count > 3)
            choose_one(f, n, d, corners, first);
        else
            choose_all(f, first);
    }
}

/* How much of the way from the middle to x keeps all half-spaces; 0 where the middle itself has no room. */
static double part_within(const struct turned_facets *f, pir_vec3 x) {
    const pir_vec3 way = sum_of(x, -1, f->middle);
    double part = 1;
    for (size_t i = 0; i < f->all.count; i++) {
        const double room = f->all.d[i] - dot(f->all.n[i], f->middle) - KEPT * f->size, need = dot(f->all.n[i], way);
        if (!(room > ROOM * f->size))
            return 0;
        if (need > part * room)
            part = 0.5 * (room / need) < part ? fmin(part, room / need) : part;
    }
    return part;
}

/* Corners of what the chosen half-spaces leave, as the facets of the hull of n / (d − n·middle). */
static pir_status corners_of(const struct turned_facets *f, pir_vec3 **ret_x, size_t *ret_count) {
    pir_vec3 *dual = calloc(f->chosen.count, sizeof *dual);
    pir_polytope *hull = NULL;
    pir_status status = dual ? PIR_OK : PIR_ERR_MEMORY;
    bool has_room = true;
    for (size_t i = 0; i < f->chosen.count && status == PIR_OK && has_room; i++) {
        const double room = f->chosen.d[i] - dot(f->chosen.n[i], f->middle);
        has_room = room > ROOM * f->size;
        dual[i] = times(f->size / room, f->chosen.n[i]);
    }
    if (status == PIR_OK && has_room)
        status = pir_polytope_create(dual, f->chosen.count, NULL, &hull);
    if (hull) {
        uint32_t *corner = calloc(pir_polytope_vertex_count(hull), sizeof *corner);
        *ret_x = calloc(pir_polytope_facet_count(hull), sizeof **ret_x);
        status = corner && *ret_x ? PIR_OK : PIR_ERR_MEMORY;
        for (uint32_t i = 0; i < pir_polytope_facet_count(hull) && status == PIR_OK; i++) {
            const pir_vec3 n = pir_polytope_normal(hull, i);
            pir_polytope_facet(hull, i, corner);
            const double d = dot(n, pir_polytope_vertex(hull, corner[0]));
            if (d > 0)
                (*ret_x)[(*ret_count)++] = sum_of(f->middle, f->size / d, n);
        }
        free(corner);
    }
    pir_polytope_release(hull);
    free(dual);
    return status == PIR_ERR_MEMORY ? status : PIR_OK;
}

static pir_status make_within(struct turned_facets *f, pir_polytope **ret_inner) {
    pir_vec3 *x = NULL;
    size_t count = 0;
    list_halves(f);
    pir_status status = corners_of(f, &x, &count);
    bool has_room = count > 3;
    for (size_t i = 0; i < count && status == PIR_OK && has_room; i++) {
        const double part = part_within(f, x[i]);
        has_room = part > 0;
        x[i] = sum_of(f->middle, part, sum_of(x[i], -1, f->middle));
    }
    if (status == PIR_OK && has_room)
        status = pir_polytope_create(x, count, NULL, ret_inner);
    free(x);
    // corners that are flat leave no inside
    return status == PIR_ERR_MEMORY ? status : PIR_OK;
}

pir_status pir_plan_piece_within(const pir_polytope *piece, const pir_plan_turns *turns, pir_polytope **ret_inner) {
    struct turned_facets f = {.piece = piece, .forms = forms_of(turns), .size = size_of(piece)};
    const size_t most = (size_t)f.forms.count * pir_polytope_facet_count(piece);
    *ret_inner = NULL;
    f.middle = turned(&f.forms, f.forms.count, middle_of(piece));
    f.all = (struct halves){calloc(most, sizeof *f.all.n), calloc(most, sizeof *f.all.d), 0};
    f.chosen = (struct halves){calloc(most, sizeof *f.all.n), calloc(most, sizeof *f.all.d), 0};
    f.corner = calloc(pir_polytope_vertex_count(piece), sizeof *f.corner);
    const bool has_memory = f.all.n && f.all.d && f.chosen.n && f.chosen.d && f.corner;
    const pir_status status = has_memory ? make_within(&f, ret_inner) : PIR_ERR_MEMORY;
    free(f.corner);
    free(f.chosen.d);
    free(f.chosen.n);
    free(f.all.d);
    free(f.all.n);
    return status;
}

/* Whether the piece has a ball about its middle, which it then has, turned, about the turned middle. */
static bool is_thick(const pir_polytope *piece, uint32_t *corner) {
    const pir_vec3 own = middle_of(piece);
    const double size = size_of(piece);
    for (uint32_t f = 0; f < pir_polytope_facet_count(piece); f++) {
        pir_polytope_facet(piece, f, corner);
        const pir_vec3 way = sum_of(pir_polytope_vertex(piece, corner[0]), -1, own);
        if (!(dot(pir_polytope_normal(piece, f), way) > ROOM * size))
            return false;
    }
    return true;
}

pir_status pir_plan_piece_around(const pir_polytope *piece, const pir_plan_turns *turns, pir_polytope **ret_outer) {
    const uint32_t vertices = pir_polytope_vertex_count(piece);
    const struct forms forms = forms_of(turns);
    const size_t count = (size_t)forms.count * vertices;
    pir_vec3 *x = calloc(count, sizeof *x);
    uint32_t *corner = calloc(vertices, sizeof *corner);
    pir_status status = x && corner ? PIR_OK : PIR_ERR_MEMORY;
    if (status == PIR_OK && !is_thick(piece, corner))
        status = PIR_ERR_LIMIT;
    if (status == PIR_OK) {
        for (uint32_t v = 0; v < vertices; v++)
            for (int k = 0; k < forms.count; k++)
                x[(size_t)v * forms.count + k] = turned(&forms, k, pir_polytope_vertex(piece, v));
        const pir_vec3 middle = mean_of(x, count);
        for (size_t i = 0; i < count; i++)
            x[i] = sum_of(middle, 1 + MARGIN, sum_of(x[i], -1, middle));
        status = pir_polytope_create(x, count, NULL, ret_outer);
    }
    free(corner);
    free(x);
    return status;
}
