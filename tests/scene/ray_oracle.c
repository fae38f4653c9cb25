/* SPDX-License-Identifier: MIT */
/* See ray_oracle.h. */
#include "scene/ray_oracle.h"

#include <gmp.h>
#include <math.h>
#include <stdlib.h>

#include <pirouette/exact.h>

/* Doubles at the surface of a rounded body are told apart from farther ones by this much. */
#define UNSURE 1e-9L

typedef mpq_t exact[3];
typedef struct point {
    long double c[3];
} point;

struct ray_oracle {
    const pir_polytope *polytope;
    int dimension;
    double radius;
    uint32_t count;
    exact *at;   /* vertices in the world */
    point *near; /* the same */
    point middle;
    long double reach;
};

static void *need(void *memory) {
    if (!memory)
        abort();
    return memory;
}

static void init(exact v) {
    for (int k = 0; k < 3; k++)
        mpq_init(v[k]);
}

static void clear(exact v) {
    for (int k = 0; k < 3; k++)
        mpq_clear(v[k]);
}

static void set(exact v, pir_vec3 from) {
    mpq_set_d(v[0], from.x);
    mpq_set_d(v[1], from.y);
    mpq_set_d(v[2], from.z);
}

static void less(exact r, exact a, exact b) {
    for (int k = 0; k < 3; k++)
        mpq_sub(r[k], a[k], b[k]);
}

static void dot(mpq_t r, exact a, exact b) {
    mpq_t term;
    mpq_init(term);
    mpq_set_ui(r, 0, 1);
    for (int k = 0; k < 3; k++) {
        mpq_mul(term, a[k], b[k]);
        mpq_add(r, r, term);
    }
    mpq_clear(term);
}

static void cross(exact r, exact a, exact b) {
    mpq_t term;
    mpq_init(term);
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        mpq_mul(r[k], a[i], b[j]);
        mpq_mul(term, a[j], b[i]);
        mpq_sub(r[k], r[k], term);
    }
    mpq_clear(term);
}

static int is_zero(exact v) {
    return mpq_sgn(v[0]) == 0 && mpq_sgn(v[1]) == 0 && mpq_sgn(v[2]) == 0;
}

/* --- bodies --- */

/* The vertex v at the pose: v + 2 u × (u × v + w v) / |q|² + t. */
static void place(exact to, exact v, pir_pose pose) {
    const pir_quat q = pose.rotation;
    exact u, a, b, t;
    mpq_t w, norm, x;
    mpq_inits(w, norm, x, NULL);
    init(u), init(a), init(b), init(t);
    set(u, (pir_vec3){q.x, q.y, q.z});
    set(t, pose.translation);
    mpq_set_d(w, q.w);
    dot(norm, u, u);
    mpq_mul(x, w, w);
    mpq_add(norm, norm, x);
    cross(a, u, v);
    for (int k = 0; k < 3; k++) {
        mpq_mul(x, w, v[k]);
        mpq_add(a[k], a[k], x);
    }
    cross(b, u, a);
    mpq_set_ui(x, 2, 1);
    mpq_div(x, x, norm);
    for (int k = 0; k < 3; k++) {
        mpq_mul(b[k], b[k], x);
        mpq_add(to[k], v[k], b[k]);
        mpq_add(to[k], to[k], t[k]);
    }
    clear(u), clear(a), clear(b), clear(t);
    mpq_clears(w, norm, x, NULL);
}

ray_oracle *ray_oracle_new(const pir_polytope *polytope, pir_pose pose, double radius) {
    ray_oracle *o = need(calloc(1, sizeof *o));
    o->polytope = polytope;
    o->dimension = pir_polytope_dimension(polytope);
    o->radius = radius;
    o->count = pir_polytope_vertex_count(polytope);
    o->at = need(calloc(o->count, sizeof *o->at));
    o->near = need(calloc(o->count, sizeof *o->near));
    exact v;
    init(v);
    for (uint32_t i = 0; i < o->count; i++) {
        init(o->at[i]);
        pir_polytope_vertex_exact(polytope, i, v);
        place(o->at[i], v, pose);
        for (int k = 0; k < 3; k++) {
            double high = mpq_get_d(o->at[i][k]);
            o->near[i].c[k] = high;
            o->middle.c[k] += high / (long double)o->count;
        }
    }
    clear(v);
    for (uint32_t i = 0; i < o->count; i++) {
        long double square = 0;
        for (int k = 0; k < 3; k++)
            square += (o->near[i].c[k] - o->middle.c[k]) * (o->near[i].c[k] - o->middle.c[k]);
        o->reach = fmaxl(o->reach, sqrtl(square));
    }
    return o;
}

void ray_oracle_free(ray_oracle *o) {
    for (uint32_t i = 0; o && i < o->count; i++)
        clear(o->at[i]);
    if (o) {
        free(o->at);
        free(o->near);
    }
    free(o);
}

/* --- in rationals --- */

struct search {
    exact from, way;
    int found;
    mpq_t time;
};

/* A time at which the ray is at a point of the body counts where it is on its way. */
static void note(struct search *s, mpq_t time) {
    if (mpq_sgn(time) < 0 || mpq_cmp_ui(time, 1, 1) > 0 || (s->found && mpq_cmp(time, s->time) >= 0))
        return;
    mpq_set(s->time, time);
    s->found = 1;
}

static void note_begin(struct search *s) {
    mpq_set_ui(s->time, 0, 1);
    s->found = 1;
}

static void meet_point(struct search *s, exact a) {
    exact off, c;
    mpq_t x, y;
    init(off), init(c);
    mpq_inits(x, y, NULL);
    less(off, a, s->from);
    cross(c, off, s->way);
    if (is_zero(c)) {
        dot(x, off, s->way);
        dot(y, s->way, s->way);
        mpq_div(x, x, y);
        note(s, x);
    }
    clear(off), clear(c);
    mpq_clears(x, y, NULL);
}

static void meet_segment(struct search *s, exact a, exact b) {
    exact e, off, c, d;
    mpq_t x, y, square;
    init(e), init(off), init(c), init(d);
    mpq_inits(x, y, square, NULL);
    less(e, b, a);
    less(off, a, s->from);
    cross(c, s->way, e);
    if (is_zero(c)) {
        // along one line, or beside each other: its ends, and the begin between them
        meet_point(s, a);
        meet_point(s, b);
        cross(d, off, e);
        dot(x, off, e);
        dot(square, e, e);
        mpq_neg(x, x);
        if (is_zero(d) && mpq_sgn(x) >= 0 && mpq_cmp(x, square) <= 0)
            note_begin(s);
    } else {
        dot(x, off, c);
        if (mpq_sgn(x) == 0) {
            dot(square, c, c);
            cross(d, off, s->way);
            dot(y, d, c);
            mpq_div(y, y, square);
            cross(d, off, e);
            dot(x, d, c);
            mpq_div(x, x, square);
            if (mpq_sgn(y) >= 0 && mpq_cmp_ui(y, 1, 1) <= 0)
                note(s, x);
        }
    }
    clear(e), clear(off), clear(c), clear(d);
    mpq_clears(x, y, square, NULL);
}

/* The corners of a facet, and its normal. */
struct polygon {
    uint32_t count, corner[512];
    exact normal;
};

static void polygon_init(struct polygon *p, const ray_oracle *o, uint32_t facet) {
    exact a, b;
    init(a), init(b), init(p->normal);
    p->count = pir_polytope_facet_size(o->polytope, facet);
    if (p->count > 512)
        abort();
    pir_polytope_facet(o->polytope, facet, p->corner);
    less(a, o->at[p->corner[1]], o->at[p->corner[0]]);
    less(b, o->at[p->corner[2]], o->at[p->corner[0]]);
    cross(p->normal, a, b);
    clear(a), clear(b);
}

/* Whether a point of the plane is in the polygon. */
static int holds(const ray_oracle *o, struct polygon *p, exact x) {
    exact e, off, c;
    mpq_t side;
    int in = 1;
    init(e), init(off), init(c);
    mpq_init(side);
    for (uint32_t i = 0; i < p->count && in; i++) {
        less(e, o->at[p->corner[(i + 1) % p->count]], o->at[p->corner[i]]);
        less(off, x, o->at[p->corner[i]]);
        cross(c, e, off);
        dot(side, c, p->normal);
        in = mpq_sgn(side) >= 0;
    }
    clear(e), clear(off), clear(c);
    mpq_clear(side);
    return in;
}

/* Meets the polygon of a facet; returns the sign of the begin's height over its plane. */
static int meet_facet(struct search *s, const ray_oracle *o, uint32_t facet) {
    struct polygon p;
    exact off, x;
    mpq_t height, rate;
    init(off), init(x);
    mpq_inits(height, rate, NULL);
    polygon_init(&p, o, facet);
    less(off, s->from, o->at[p.corner[0]]);
    dot(height, off, p.normal);
    dot(rate, s->way, p.normal);
    int sign = mpq_sgn(height);
    if (mpq_sgn(rate) != 0) {
        mpq_div(rate, height, rate);
        mpq_neg(rate, rate);
        for (int k = 0; k < 3; k++) {
            mpq_mul(x[k], s->way[k], rate);
            mpq_add(x[k], x[k], s->from[k]);
        }
        if (holds(o, &p, x))
            note(s, rate);
    } else if (sign == 0) {
        if (holds(o, &p, s->from))
            note_begin(s);
        for (uint32_t i = 0; i < p.count; i++)
            meet_segment(s, o->at[p.corner[i]], o->at[p.corner[(i + 1) % p.count]]);
    }
    clear(off), clear(x), clear(p.normal);
    mpq_clears(height, rate, NULL);
    return sign;
}

static ray_verdict ask_exactly(const ray_oracle *o, pir_vec3 origin, pir_vec3 way) {
    struct search s = {.found = 0};
    init(s.from), init(s.way);
    mpq_init(s.time);
    set(s.from, origin);
    set(s.way, way);
    if (o->dimension == 0)
        meet_point(&s, o->at[0]);
    if (o->dimension == 1)
        meet_segment(&s, o->at[0], o->at[1]);
    int below = o->dimension == 3;
    for (uint32_t f = 0; f < pir_polytope_facet_count(o->polytope) && o->dimension >= 2; f++)
        below &= meet_facet(&s, o, f) <= 0;
    if (below)
        note_begin(&s);
    ray_verdict verdict = {s.found, s.found ? mpq_get_d(s.time) : 1};
    clear(s.from), clear(s.way);
    mpq_clear(s.time);
    return verdict;
}

/* --- with a radius --- */

static point minus(point a, point b) {
    return (point){{a.c[0] - b.c[0], a.c[1] - b.c[1], a.c[2] - b.c[2]}};
}

static long double times(point a, point b) {
    return a.c[0] * b.c[0] + a.c[1] * b.c[1] + a.c[2] * b.c[2];
}

static point off_plane(point a, point b) {
    return (point){
        {a.c[1] * b.c[2] - a.c[2] * b.c[1], a.c[2] * b.c[0] - a.c[0] * b.c[2], a.c[0] * b.c[1] - a.c[1] * b.c[0]}};
}

static long double to_segment(point x, point a, point b) {
    point e = minus(b, a), off = minus(x, a);
    long double square = times(e, e), part = square > 0 ? fminl(fmaxl(times(off, e) / square, 0), 1) : 0;
    for (int k = 0; k < 3; k++)
        off.c[k] -= part * e.c[k];
    return sqrtl(times(off, off));
}

/* The distance from a facet, and whether x is below it. */
static long double to_facet(const ray_oracle *o, uint32_t facet, point x, int *below) {
    uint32_t corner[512], count = pir_polytope_facet_size(o->polytope, facet);
    if (count > 512)
        abort();
    pir_polytope_facet(o->polytope, facet, corner);
    point n = off_plane(minus(o->near[corner[1]], o->near[corner[0]]), minus(o->near[corner[2]], o->near[corner[0]]));
    long double height = times(n, minus(x, o->near[corner[0]])) / sqrtl(times(n, n)), least = HUGE_VALL;
    int over = 1;
    for (uint32_t i = 0; i < count; i++) {
        point a = o->near[corner[i]], b = o->near[corner[(i + 1) % count]];
        over &= times(off_plane(minus(b, a), minus(x, a)), n) >= 0;
        least = fminl(least, to_segment(x, a, b));
    }
    *below = height <= 0;
    return over ? fabsl(height) : least;
}

static long double height_of(const ray_oracle *o, point x) {
    long double least = to_segment(x, o->near[0], o->near[o->dimension == 1 ? 1 : 0]);
    int inside = o->dimension == 3;
    for (uint32_t f = 0; f < pir_polytope_facet_count(o->polytope) && o->dimension >= 2; f++) {
        int below;
        least = fminl(least, to_facet(o, f, x, &below));
        inside &= below;
    }
    return (inside ? -least : least) - o->radius;
}

double ray_oracle_height(const ray_oracle *o, pir_vec3 at) {
    return (double)height_of(o, (point){{at.x, at.y, at.z}});
}

static long double height_at(const ray_oracle *o, pir_vec3 origin, pir_vec3 way, long double time) {
    return height_of(o, (point){{origin.x + time * way.x, origin.y + time * way.y, origin.z + time * way.z}});
}

/* Heights along a line are convex where they are above 0: the least by thirds, the first at 0 by halves. */
static ray_verdict ask_rounded(const ray_oracle *o, pir_vec3 origin, pir_vec3 way) {
    long double low = 0, high = 1;
    for (int i = 0; i < 120; i++) {
        long double a = low + (high - low) / 3, b = high - (high - low) / 3;
        if (height_at(o, origin, way, a) <= height_at(o, origin, way, b))
            high = b;
        else
            low = a;
    }
    long double lowest = low, least = fminl(height_at(o, origin, way, low), height_at(o, origin, way, high));
    if (fabsl(least) <= UNSURE)
        return (ray_verdict){-1, 1};
    if (least > 0)
        return (ray_verdict){0, 1};
    low = 0;
    high = lowest;
    if (height_at(o, origin, way, 0) <= 0)
        return (ray_verdict){1, 0};
    for (int i = 0; i < 80; i++) {
        long double half = (low + high) / 2;
        if (height_at(o, origin, way, half) <= 0)
            high = half;
        else
            low = half;
    }
    return (ray_verdict){1, (double)high};
}

ray_verdict ray_oracle_ask(const ray_oracle *o, pir_vec3 origin, pir_vec3 way) {
    // a ball around all, with room for any rounding: most are far from it
    point from = {{origin.x, origin.y, origin.z}}, to = {{origin.x + way.x, origin.y + way.y, origin.z + way.z}};
    if (to_segment(o->middle, from, to) > (o->reach + o->radius) * 1.001L + 1e-6L)
        return (ray_verdict){0, 1};
    return o->radius > 0 ? ask_rounded(o, origin, way) : ask_exactly(o, origin, way);
}
