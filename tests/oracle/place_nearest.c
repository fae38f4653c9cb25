/* SPDX-License-Identifier: MIT */
/*
 * See place.h: the nearest point of a hull of differences of vertices. A descent from simplex to simplex (Gilbert,
 * Johnson and Keerthi, 1988), in doubles as long as they get nearer, then in integers: each step takes the face of the
 * simplex that is nearest to t, exactly, and ends when no vertex lies on t's side of the plane through the nearest
 * point across the way to t. Else that vertex joins the simplex. Distances strictly fall and simplices are finitely
 * many, so it ends.
 */
#include "oracle/place.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Heights in doubles differ from exact ones by less, relative to the size of bodies and the length of the direction. */
#define CERTAIN 0x1p-45

struct simplex {
    uint32_t count, p[4], q[4];
};

/* --- in doubles --- */

struct hull {
    const oracle_place *o;
    const oracle_set *p, *q;
    double t[3];
};

static struct hull hull_of(const oracle_place *o, const oracle_set *p, const oracle_set *q) {
    struct hull h = {o, p, q, {0}};
    long e;
    double m = mpz_get_d_2exp(&e, o->grain);
    oracle_near_at(h.t, ((oracle_place *)o)->t, o->exponent + e);
    for (int k = 0; k < 3; k++)
        h.t[k] /= m;
    return h;
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void at_near(const struct hull *h, uint32_t i, uint32_t j, double y[3]) {
    for (int k = 0; k < 3; k++)
        y[k] = h->o->near_b[j][k] - h->o->near_a[i][k] - h->t[k];
}

/* The vertex that lies least far along `along` of one body; sign −1 for P, whose vertices are subtracted. */
static uint32_t least_near(double (*near)[3], uint32_t count, const oracle_set *set, const double along[3], int sign) {
    uint32_t best = 0;
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < count; i++) {
        if (set && !oracle_set_has(set, i))
            continue;
        double height = sign * dot(along, near[i]);
        if (height < least) {
            least = height;
            best = i;
        }
    }
    return best;
}

/*
 * Barycentric coordinates, up to a common factor, of the foot of the origin on the flat through up to 3 points; false
 * when it is outside.
 */
static bool foot_near(double (*y)[3], const uint32_t *index, uint32_t count, double x[3]) {
    double w[3] = {1, 0, 0}, sum = 0, u[3], v[3];
    if (count > 1)
        for (int k = 0; k < 3; k++) {
            u[k] = y[index[1]][k] - y[index[0]][k];
            v[k] = count > 2 ? y[index[2]][k] - y[index[0]][k] : 0;
        }
    if (count == 2) {
        w[1] = -dot(u, y[index[0]]);
        w[0] = dot(u, u) - w[1];
    }
    if (count == 3) {
        double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), a = -dot(u, y[index[0]]), b = -dot(v, y[index[0]]);
        w[1] = a * vv - b * uv;
        w[2] = b * uu - a * uv;
        w[0] = uu * vv - uv * uv - w[1] - w[2];
    }
    for (uint32_t i = 0; i < count; i++) {
        if (!(w[i] >= 0))
            return false;
        sum += w[i];
    }
    if (!(sum > 0))
        return false;
    for (int k = 0; k < 3; k++) {
        x[k] = 0;
        for (uint32_t i = 0; i < count; i++)
            x[k] += w[i] / sum * y[index[i]][k];
    }
    return true;
}

/* Reduces the simplex to the face of up to 3 points whose nearest point x is the nearest. */
static double reduce_near(struct simplex *s, double (*y)[3], double ret_x[3]) {
    double least = HUGE_VAL;
    uint32_t best = 1;
    for (uint32_t subset = 1; subset < 1u << s->count; subset++) {
        uint32_t index[4], count = 0;
        double x[3];
        for (uint32_t i = 0; i < s->count; i++)
            if (subset >> i & 1)
                index[count++] = i;
        if (count > 3 || !foot_near(y, index, count, x))
            continue;
        double square = dot(x, x);
        if (square < least) {
            least = square;
            best = subset;
            memcpy(ret_x, x, sizeof x);
        }
    }
    uint32_t kept = 0;
    for (uint32_t i = 0; i < 4; i++)
        if (best >> i & 1) {
            s->p[kept] = s->p[i];
            s->q[kept] = s->q[i];
            for (int k = 0; k < 3; k++)
                y[kept][k] = y[i][k];
            kept++;
        }
    s->count = kept;
    return least;
}

static uint32_t first_of(const oracle_set *set) {
    uint32_t i = 0;
    while (set && !oracle_set_has(set, i))
        i++;
    return i;
}

/*
 * The simplex where doubles get no nearer; the square of its distance. Stops where t is certainly apart and ret_apart
 * is not NULL.
 */
static double descend_near(const struct hull *h, struct simplex *s, bool *ret_apart) {
    const oracle_place *o = h->o;
    double y[4][3], x[3], square, far = 1 + fabs(h->t[0]) + fabs(h->t[1]) + fabs(h->t[2]);
    *s = (struct simplex){.count = 1, .p = {first_of(h->p)}, .q = {first_of(h->q)}};
    at_near(h, s->p[0], s->q[0], y[0]);
    memcpy(x, y[0], sizeof x);
    square = dot(x, x);
    for (int step = 0; step < 100; step++) {
        uint32_t i = least_near(o->near_a, o->p->count, h->p, x, -1),
                 j = least_near(o->near_b, o->q->count, h->q, x, 1);
        struct simplex larger = *s;
        larger.p[larger.count] = i;
        larger.q[larger.count] = j;
        at_near(h, i, j, y[larger.count]);
        double least = dot(x, y[larger.count++]);
        // all of the hull lies beyond a plane across x
        if (ret_apart && square > 0x1p-80 * far * far && least > 0x1p-40 * sqrt(square) * far) {
            *ret_apart = true;
            break;
        }
        if (!(square - least > 0x1p-51 * square))
            break;
        double next = reduce_near(&larger, y, x);
        if (!(next < square) || larger.count == 4)
            break;
        square = next;
        *s = larger;
    }
    return square;
}

double oracle_place_near(const oracle_place *o, const oracle_set *p, const oracle_set *q) {
    struct hull h = hull_of(o, p, q);
    struct simplex s;
    double distance = sqrt(descend_near(&h, &s, NULL));
    long e;
    double m = mpz_get_d_2exp(&e, o->grain);
    return oracle_real_double((oracle_real){distance * m * o->scale.m, o->scale.e + o->exponent + e});
}

/* --- exactly --- */

struct work {
    oracle_place *o;
    const oracle_set *p, *q;
    oracle_vec y[4], u, v, n, foot; /* the nearest point of a simplex, seen from t, is foot / den */
    mpz_t r, s, square, best, den;
};

static void work_init(struct work *w, oracle_place *o, const oracle_set *p, const oracle_set *q) {
    w->o = o;
    w->p = p;
    w->q = q;
    for (int i = 0; i < 4; i++)
        oracle_vec_init(w->y[i]);
    oracle_vec_init(w->u);
    oracle_vec_init(w->v);
    oracle_vec_init(w->n);
    oracle_vec_init(w->foot);
    mpz_inits(w->r, w->s, w->square, w->best, w->den, NULL);
}

static void work_clear(struct work *w) {
    for (int i = 0; i < 4; i++)
        oracle_vec_clear(w->y[i]);
    oracle_vec_clear(w->u);
    oracle_vec_clear(w->v);
    oracle_vec_clear(w->n);
    oracle_vec_clear(w->foot);
    mpz_clears(w->r, w->s, w->square, w->best, w->den, NULL);
}

static void at_exact(oracle_place *o, uint32_t i, uint32_t j, oracle_vec y) {
    for (int k = 0; k < 3; k++) {
        mpz_sub(y[k], o->b[j][k], o->a[i][k]);
        mpz_mul(y[k], y[k], o->grain);
        mpz_sub(y[k], y[k], o->t[k]);
    }
}

static bool foot_of_segment(struct work *w, oracle_vec *y0, oracle_vec *y1) {
    oracle_sub(w->u, *y1, *y0);
    oracle_dot(w->den, w->u, w->u);
    oracle_dot(w->r, w->u, *y0);
    mpz_neg(w->r, w->r);
    if (mpz_sgn(w->r) < 0 || mpz_cmp(w->r, w->den) > 0 || mpz_sgn(w->den) == 0)
        return false;
    for (int k = 0; k < 3; k++) {
        mpz_mul(w->foot[k], w->den, (*y0)[k]);
        mpz_addmul(w->foot[k], w->r, w->u[k]);
    }
    return true;
}

static bool foot_of_triangle(struct work *w, oracle_vec *y[3]) {
    oracle_sub(w->u, *y[1], *y[0]);
    oracle_sub(w->v, *y[2], *y[0]);
    oracle_cross(w->n, w->u, w->v);
    oracle_dot(w->den, w->n, w->n);
    if (mpz_sgn(w->den) == 0)
        return false;
    for (int i = 0; i < 3; i++) {
        oracle_cross(w->u, *y[(i + 1) % 3], *y[(i + 2) % 3]);
        oracle_dot(w->r, w->u, w->n);
        if (mpz_sgn(w->r) < 0)
            return false;
    }
    oracle_dot(w->r, w->n, *y[0]);
    for (int k = 0; k < 3; k++)
        mpz_mul(w->foot[k], w->n[k], w->r);
    return true;
}

/* Whether the origin is in the tetrahedron, which is none when flat. */
static bool foot_of_tetrahedron(struct work *w) {
    int first = 0;
    for (int i = 0; i < 4; i++) {
        // the side of the origin of the facet across corner i, against that of the corner
        int c[3], count = 0;
        for (int k = 0; k < 4; k++)
            if (k != i)
                c[count++] = k;
        oracle_sub(w->u, w->y[c[1]], w->y[c[0]]);
        oracle_sub(w->v, w->y[c[2]], w->y[c[0]]);
        oracle_cross(w->n, w->u, w->v);
        oracle_sub(w->u, w->y[i], w->y[c[0]]);
        oracle_dot(w->r, w->n, w->u);
        oracle_dot(w->s, w->n, w->y[c[0]]);
        first = mpz_sgn(w->r);
        if (first == 0 || -mpz_sgn(w->s) * first < 0)
            return false;
    }
    mpz_set_ui(w->den, 1);
    for (int k = 0; k < 3; k++)
        mpz_set_ui(w->foot[k], 0);
    return true;
}

/* Whether no point of the simplex lies nearer than the foot: X · (y·den − X) ≥ 0. */
static bool is_least(struct work *w, uint32_t count) {
    oracle_dot(w->square, w->foot, w->foot);
    for (uint32_t i = 0; i < count; i++) {
        oracle_dot(w->r, w->foot, w->y[i]);
        mpz_mul(w->r, w->r, w->den);
        if (mpz_cmp(w->r, w->square) < 0)
            return false;
    }
    return true;
}

static bool foot_of_subset(struct work *w, const uint32_t *index, uint32_t count) {
    oracle_vec *y[3];
    if (count == 4)
        return foot_of_tetrahedron(w);
    for (uint32_t i = 0; i < count; i++)
        y[i] = &w->y[index[i]];
    if (count == 3)
        return foot_of_triangle(w, y);
    if (count == 2)
        return foot_of_segment(w, y[0], y[1]);
    for (int k = 0; k < 3; k++)
        mpz_set(w->foot[k], (*y[0])[k]);
    mpz_set_ui(w->den, 1);
    return true;
}

static uint32_t bits_of(uint32_t subset) {
    uint32_t count = 0;
    for (; subset; subset &= subset - 1)
        count++;
    return count;
}

/* Reduces the simplex to a least face that holds its nearest point, which goes to w->foot. */
static void reduce(struct work *w, struct simplex *s) {
    for (uint32_t size = 1; size <= s->count; size++)
        for (uint32_t subset = 1; subset < 1u << s->count; subset++) {
            uint32_t index[4], count = 0;
            if (bits_of(subset) != size)
                continue;
            for (uint32_t i = 0; i < s->count; i++)
                if (subset >> i & 1)
                    index[count++] = i;
            if (!foot_of_subset(w, index, count) || !is_least(w, s->count))
                continue;
            for (uint32_t i = 0; i < count; i++) {
                s->p[i] = s->p[index[i]];
                s->q[i] = s->q[index[i]];
            }
            s->count = count;
            return;
        }
    abort();
}

/* The vertex of one body that lies least far along x; sign −1 for P. Its height goes to w->best. */
static uint32_t least(struct work *w, bool of_p, const double near[3]) {
    oracle_place *o = w->o;
    const oracle_set *set = of_p ? w->p : w->q;
    double(*all)[3] = of_p ? o->near_a : o->near_b, low = HUGE_VAL;
    oracle_vec *at = of_p ? o->a : o->b;
    uint32_t count = of_p ? o->p->count : o->q->count, best = 0;
    int sign = of_p ? -1 : 1;
    bool any = false;
    for (uint32_t i = 0; i < count; i++)
        if (!set || oracle_set_has(set, i))
            low = fmin(low, sign * dot(near, all[i]));
    for (uint32_t i = 0; i < count; i++) {
        if ((set && !oracle_set_has(set, i)) || sign * dot(near, all[i]) > low + CERTAIN)
            continue;
        oracle_dot(w->r, w->foot, at[i]);
        if (!any || sign * mpz_cmp(w->r, w->best) < 0) {
            mpz_set(w->best, w->r);
            best = i;
        }
        any = true;
    }
    return best;
}

/* Takes the vertex that lies farthest towards t into the simplex; false when none lies beyond the nearest point. */
static bool step(struct work *w, struct simplex *s) {
    double near[3];
    oracle_near(near, w->foot);
    uint32_t i = least(w, true, near), j = least(w, false, near), n = s->count;
    // the points of the simplex that are left, and the new one
    for (uint32_t k = 0; k < n; k++)
        at_exact(w->o, s->p[k], s->q[k], w->y[k]);
    at_exact(w->o, i, j, w->y[n]);
    oracle_dot(w->r, w->foot, w->y[n]);
    mpz_mul(w->r, w->r, w->den);
    if (mpz_cmp(w->r, w->square) >= 0)
        return false;
    s->p[n] = i;
    s->q[n] = j;
    s->count++;
    return true;
}

/* Distance and normal from the foot, not 0. */
static void round_foot(struct work *w, oracle_nearest *nearest) {
    double near[3];
    long e, f;
    oracle_near(near, w->foot);
    double length = sqrt(dot(near, near)), m = mpz_get_d_2exp(&e, w->square), d = mpz_get_d_2exp(&f, w->den);
    nearest->normal = (pir_vec3){-near[0] / length, -near[1] / length, -near[2] / length};
    oracle_real root = e % 2 == 0 ? (oracle_real){sqrt(m), e / 2} : (oracle_real){sqrt(2 * m), (e - 1) / 2};
    nearest->distance = oracle_real_double((oracle_real){root.m / d * w->o->scale.m, root.e - f + w->o->scale.e});
}

/* The nearest point of a hull; t goes there when `moves`. */
static oracle_nearest find(oracle_place *o, const oracle_set *p, const oracle_set *q, bool moves) {
    struct work *w = oracle_new(1, sizeof *w);
    struct hull h = hull_of(o, p, q);
    struct simplex s;
    work_init(w, o, p, q);
    descend_near(&h, &s, NULL);
    for (uint32_t i = 0; i < s.count; i++)
        at_exact(o, s.p[i], s.q[i], w->y[i]);
    do
        reduce(w, &s);
    while (mpz_sgn(w->square) != 0 && step(w, &s));
    oracle_nearest nearest = {.apart = mpz_sgn(w->square) != 0, .count = s.count};
    memcpy(nearest.p, s.p, sizeof s.p);
    memcpy(nearest.q, s.q, sizeof s.q);
    if (nearest.apart)
        round_foot(w, &nearest);
    for (int k = 0; k < 3 && moves; k++) {
        mpz_mul(o->t[k], o->t[k], w->den);
        mpz_add(o->t[k], o->t[k], w->foot[k]);
    }
    if (moves)
        mpz_mul(o->grain, o->grain, w->den);
    work_clear(w);
    free(w);
    return nearest;
}

oracle_nearest oracle_place_nearest(oracle_place *o, const oracle_set *p, const oracle_set *q) {
    return find(o, p, q, false);
}

void oracle_place_to_nearest(oracle_place *o) {
    find(o, NULL, NULL, true);
}

int oracle_place_is_apart(oracle_place *o, const oracle_set *p, const oracle_set *q) {
    struct hull h = hull_of(o, p, q);
    struct simplex s;
    bool apart = false;
    descend_near(&h, &s, &apart);
    return apart || find(o, p, q, false).apart;
}
