/* SPDX-License-Identifier: MIT */
/* Contacts in integers: see contacts.h. */
#include "oracle/contacts.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

/* --- making --- */

/* d less all that it is compared with, and what else is needed for a while. */
typedef struct scratch {
    oracle_vec a, b, n, m, y;
    mpz_t x, z, w;
} scratch;

static void scratch_init(scratch *s) {
    oracle_vec_init(s->a);
    oracle_vec_init(s->b);
    oracle_vec_init(s->n);
    oracle_vec_init(s->m);
    oracle_vec_init(s->y);
    mpz_inits(s->x, s->z, s->w, NULL);
}

static void scratch_clear(scratch *s) {
    oracle_vec_clear(s->a);
    oracle_vec_clear(s->b);
    oracle_vec_clear(s->n);
    oracle_vec_clear(s->m);
    oracle_vec_clear(s->y);
    mpz_clears(s->x, s->z, s->w, NULL);
}

static void set_scaled(oracle_vec to, oracle_corner from, const mpz_t scale) {
    for (int k = 0; k < 3; k++) {
        mpz_divexact(to[k], scale, mpq_denref(from[k]));
        mpz_mul(to[k], to[k], mpq_numref(from[k]));
    }
}

static void widen_scale(mpz_t scale, oracle_corner x) {
    for (int k = 0; k < 3; k++)
        mpz_lcm(scale, scale, mpq_denref(x[k]));
}

static void add_plane(oracle_difference *d, oracle_vec n, const mpz_t most, int sign) {
    if (d->planes == d->room) {
        d->room = d->room ? 2 * d->room : 64;
        d->plane = realloc(d->plane, d->room * sizeof *d->plane);
        if (!d->plane)
            abort();
    }
    oracle_half_space *plane = &d->plane[d->planes++];
    oracle_vec_init(plane->n);
    mpz_init(plane->most);
    for (int k = 0; k < 3; k++)
        mpz_mul_si(plane->n[k], n[k], sign);
    mpz_mul_si(plane->most, most, sign);
}

/* Adds the half-spaces of a plane through point a that have all points; whether all are in it. */
static bool try_plane(oracle_difference *d, uint32_t a, oracle_vec n, scratch *s) {
    bool above = false, below = false;
    if (oracle_is_zero(n))
        return false;
    oracle_dot(s->x, n, d->d[a]);
    for (uint32_t i = 0; i < d->count && !(above && below); i++) {
        oracle_dot(s->z, n, d->d[i]);
        int sign = mpz_cmp(s->z, s->x);
        above |= sign > 0;
        below |= sign < 0;
    }
    if (!above)
        add_plane(d, n, s->x, 1);
    if (!below)
        add_plane(d, n, s->x, -1);
    return !above && !below;
}

static void make_planes(oracle_difference *d, scratch *s) {
    bool flat = false;
    for (uint32_t a = 0; a < d->count; a++)
        for (uint32_t b = a + 1; b < d->count; b++)
            for (uint32_t c = b + 1; c < d->count && !flat; c++) {
                oracle_sub(s->a, d->d[b], d->d[a]);
                oracle_sub(s->b, d->d[c], d->d[a]);
                oracle_cross(s->n, s->a, s->b);
                flat |= try_plane(d, a, s->n, s);
            }
    d->is_solid = !flat;
    if (!flat)
        return;
    // a flat one has walls across its plane, too
    for (uint32_t a = 0; a < d->count; a++)
        for (uint32_t b = a + 1; b < d->count; b++) {
            oracle_sub(s->a, d->d[b], d->d[a]);
            oracle_cross(s->m, s->a, d->front);
            (void)try_plane(d, a, s->m, s);
        }
}

static void make_difference(oracle_scene *scene, oracle_triangle *t, oracle_difference *d, scratch *s) {
    oracle_vec w[3];
    d->count = 0;
    for (int k = 0; k < 3; k++) {
        oracle_vec_init(w[k]);
        set_scaled(w[k], t->p[k], scene->scale);
    }
    for (uint32_t v = 0; v < scene->vertices; v++)
        for (int k = 0; k < 3; k++) {
            oracle_vec_init(d->d[d->count]);
            oracle_sub(d->d[d->count++], scene->vertex[v], w[k]);
        }
    oracle_vec_init(d->front);
    oracle_vec_init(d->corner);
    oracle_sub(s->a, w[1], w[0]);
    oracle_sub(s->b, w[2], w[0]);
    oracle_cross(d->front, s->a, s->b);
    for (int k = 0; k < 3; k++)
        mpz_set(d->corner[k], w[0][k]);
    for (int k = 0; k < 3; k++)
        oracle_vec_clear(w[k]);
    make_planes(d, s);
}

oracle_scene *oracle_scene_make(const pir_vec3 *vertex, uint32_t vertices, pir_quat rotation, oracle_triangle *triangle,
                                const bool *one_sided, uint32_t triangles) {
    oracle_scene *scene = calloc(1, sizeof *scene);
    scratch s;
    oracle_triangle placed;
    if (!scene)
        abort();
    scratch_init(&s);
    oracle_triangle_init(&placed);
    scene->vertices = vertices;
    scene->triangles = triangles;
    scene->vertex = calloc(vertices, sizeof *scene->vertex);
    scene->difference = calloc(triangles, sizeof *scene->difference);
    mpz_init(scene->scale);
    mpz_ui_pow_ui(scene->scale, 2, 80); // of most translations, and of all by refine
    for (uint32_t i = 0; i < triangles; i++)
        for (int k = 0; k < 3; k++)
            widen_scale(scene->scale, triangle[i].p[k]);
    for (int round = 0; round < 2; round++)
        for (uint32_t v = 0; v < vertices; v++) {
            const pir_vec3 same[3] = {vertex[v], vertex[v], vertex[v]};
            oracle_triangle_place(&placed, same, (pir_pose){rotation, {0, 0, 0}});
            if (round == 0) {
                widen_scale(scene->scale, placed.p[0]);
            } else {
                oracle_vec_init(scene->vertex[v]);
                set_scaled(scene->vertex[v], placed.p[0], scene->scale);
            }
        }
    oracle_vec_init(scene->t);
    for (uint32_t i = 0; i < triangles; i++) {
        scene->difference[i].one_sided = one_sided[i];
        make_difference(scene, &triangle[i], &scene->difference[i], &s);
    }
    oracle_triangle_clear(&placed);
    scratch_clear(&s);
    return scene;
}

void oracle_scene_free(oracle_scene *scene) {
    for (uint32_t i = 0; i < scene->triangles; i++) {
        oracle_difference *d = &scene->difference[i];
        for (uint32_t k = 0; k < d->count; k++)
            oracle_vec_clear(d->d[k]);
        for (uint32_t k = 0; k < d->planes; k++) {
            oracle_vec_clear(d->plane[k].n);
            mpz_clear(d->plane[k].most);
        }
        oracle_vec_clear(d->front);
        oracle_vec_clear(d->corner);
        free(d->plane);
    }
    for (uint32_t v = 0; v < scene->vertices; v++)
        oracle_vec_clear(scene->vertex[v]);
    oracle_vec_clear(scene->t);
    mpz_clear(scene->scale);
    free(scene->vertex);
    free(scene->difference);
    free(scene);
}

static void shift(oracle_vec v, mp_bitcnt_t bits) {
    for (int k = 0; k < 3; k++)
        mpz_mul_2exp(v[k], v[k], bits);
}

/* Makes the scale 2^bits times as fine. Lengths are of the first degree, normals of the second. */
static void refine(oracle_scene *scene, mp_bitcnt_t bits) {
    mpz_mul_2exp(scene->scale, scene->scale, bits);
    for (uint32_t v = 0; v < scene->vertices; v++)
        shift(scene->vertex[v], bits);
    for (uint32_t i = 0; i < scene->triangles; i++) {
        oracle_difference *d = &scene->difference[i];
        for (uint32_t k = 0; k < d->count; k++)
            shift(d->d[k], bits);
        shift(d->corner, bits);
        shift(d->front, 2 * bits);
        for (uint32_t k = 0; k < d->planes; k++) {
            shift(d->plane[k].n, 2 * bits);
            mpz_mul_2exp(d->plane[k].most, d->plane[k].most, 3 * bits);
        }
    }
}

void oracle_scene_move(oracle_scene *scene, pir_vec3 t) {
    const double c[3] = {t.x, t.y, t.z};
    mpq_t x;
    mpq_init(x);
    for (int k = 0; k < 3; k++) {
        mpq_set_d(x, c[k]);
        const mp_bitcnt_t has = mpz_scan1(scene->scale, 0), needs = mpz_scan1(mpq_denref(x), 0);
        if (needs > has) // t of earlier axes is made again
            refine(scene, needs - has);
    }
    for (int k = 0; k < 3; k++) {
        mpq_set_d(x, c[k]);
        mpz_mul(scene->t[k], scene->scale, mpq_numref(x));
        mpz_divexact(scene->t[k], scene->t[k], mpq_denref(x));
    }
    mpq_clear(x);
}

/* --- where P is: at the translation plus y / m --- */

/* How `y`, less t times m, lies in −difference: −1 outside, 0 on the boundary, 1 inside. */
static int lies(oracle_scene *scene, const oracle_difference *d, oracle_vec y, const mpz_t m, scratch *s) {
    int least = d->is_solid ? 1 : 0;
    for (uint32_t i = 0; i < d->planes; i++) {
        // 0 is in d + t + y/m exactly when −(t + y/m) is in d
        oracle_half_space *plane = &d->plane[i];
        oracle_dot(s->x, plane->n, scene->t);
        mpz_add(s->x, s->x, plane->most);
        mpz_mul(s->x, s->x, m);
        oracle_dot(s->z, plane->n, y);
        mpz_add(s->x, s->x, s->z);
        int sign = mpz_sgn(s->x);
        if (sign < 0)
            return -1;
        least = sign < least ? sign : least;
    }
    return least;
}

static bool counts_at(oracle_scene *scene, oracle_difference *d, oracle_vec y, const mpz_t m, scratch *s) {
    if (!d->one_sided)
        return true;
    for (uint32_t v = 0; v < scene->vertices; v++) {
        oracle_sub(s->a, scene->vertex[v], d->corner);
        for (int k = 0; k < 3; k++) {
            mpz_add(s->a[k], s->a[k], scene->t[k]);
            mpz_mul(s->a[k], s->a[k], m);
            mpz_add(s->a[k], s->a[k], y[k]);
        }
        oracle_dot(s->x, d->front, s->a);
        if (mpz_sgn(s->x) > 0)
            return true;
    }
    return false;
}

bool oracle_scene_counts(oracle_scene *scene, uint32_t i) {
    scratch s;
    oracle_vec zero;
    scratch_init(&s);
    oracle_vec_init(zero);
    mpz_set_ui(s.w, 1);
    bool counts = counts_at(scene, &scene->difference[i], zero, s.w, &s);
    oracle_vec_clear(zero);
    scratch_clear(&s);
    return counts;
}

int oracle_scene_state(oracle_scene *scene) {
    scratch s;
    oracle_vec zero;
    int most = -1;
    scratch_init(&s);
    oracle_vec_init(zero);
    mpz_set_ui(s.w, 1);
    for (uint32_t i = 0; i < scene->triangles; i++) {
        oracle_difference *d = &scene->difference[i];
        if (!counts_at(scene, d, zero, s.w, &s))
            continue;
        int lie = lies(scene, d, zero, s.w, &s);
        most = lie > most ? lie : most;
    }
    oracle_vec_clear(zero);
    scratch_clear(&s);
    return most + 1;
}

/* --- nearest points --- */

/* A point of the difference where P is. */
static void point_of(oracle_scene *scene, const oracle_difference *d, uint32_t k, oracle_vec to) {
    for (int i = 0; i < 3; i++)
        mpz_add(to[i], d->d[k][i], scene->t[i]);
}

/*
 * The point nearest to 0 of the span of up to three points, times ret_m; false where it has a weight that is not
 * positive. n is the direction to it.
 */
static bool span_point(oracle_vec p[3], uint32_t count, oracle_vec ret_c, mpz_t ret_m, scratch *s) {
    if (count == 1) {
        for (int k = 0; k < 3; k++)
            mpz_set(ret_c[k], p[0][k]);
        mpz_set_ui(ret_m, 1);
        return true;
    }
    oracle_sub(s->a, p[1], p[0]);
    if (count == 2) {
        oracle_dot(ret_m, s->a, s->a);
        oracle_dot(s->x, p[1], s->a);
        oracle_dot(s->z, p[0], s->a);
        mpz_neg(s->z, s->z);
        for (int k = 0; k < 3; k++) {
            mpz_mul(ret_c[k], p[0][k], s->x);
            mpz_addmul(ret_c[k], p[1][k], s->z);
        }
        return mpz_sgn(s->x) > 0 && mpz_sgn(s->z) > 0;
    }
    oracle_sub(s->b, p[2], p[0]);
    oracle_cross(s->n, s->a, s->b);
    oracle_dot(ret_m, s->n, s->n);
    for (int k = 0; k < 3; k++) {
        oracle_cross(s->m, p[(k + 1) % 3], p[(k + 2) % 3]);
        oracle_dot(s->x, s->n, s->m);
        if (mpz_sgn(s->x) <= 0)
            return false;
    }
    oracle_dot(s->x, s->n, p[0]);
    for (int k = 0; k < 3; k++)
        mpz_mul(ret_c[k], s->n[k], s->x);
    return true;
}

/* Whether no point of the difference is nearer to 0 than c/m, a point of it. */
static bool is_nearest(oracle_scene *scene, const oracle_difference *d, oracle_vec c, const mpz_t m, scratch *s) {
    oracle_dot(s->z, c, c);
    for (uint32_t k = 0; k < d->count; k++) {
        point_of(scene, d, k, s->a);
        oracle_dot(s->x, s->a, c);
        mpz_mul(s->x, s->x, m);
        if (mpz_cmp(s->x, s->z) < 0)
            return false;
    }
    return true;
}

/* All simplices, those of few points first. */
static bool find_nearest(oracle_scene *scene, const oracle_difference *d, oracle_vec ret_c, mpz_t ret_m, scratch *s) {
    oracle_vec p[3];
    bool found = false;
    for (int k = 0; k < 3; k++)
        oracle_vec_init(p[k]);
    for (uint32_t count = 1; count <= 3 && !found; count++)
        for (uint32_t a = 0; a < d->count && !found; a++)
            for (uint32_t b = a + 1; b < (count > 1 ? d->count : a + 2) && !found; b++)
                for (uint32_t c = b + 1; c < (count > 2 ? d->count : b + 2) && !found; c++) {
                    const uint32_t at[3] = {a, b, c};
                    for (uint32_t k = 0; k < count; k++)
                        point_of(scene, d, at[k], p[k]);
                    found = span_point(p, count, ret_c, ret_m, s) && mpz_sgn(ret_m) > 0 &&
                            is_nearest(scene, d, ret_c, ret_m, s);
                }
    for (int k = 0; k < 3; k++)
        oracle_vec_clear(p[k]);
    return found;
}

/* c as a unit vector, and c/m/scale as a length. */
static void to_doubles(const oracle_scene *scene, oracle_vec c, const mpz_t m, pir_vec3 *ret_unit, double *ret_length) {
    double x[3], square = 0;
    long top = LONG_MIN, e, f, g;
    for (int k = 0; k < 3; k++) {
        x[k] = mpz_get_d_2exp(&e, c[k]);
        top = x[k] != 0 && e > top ? e : top;
    }
    for (int k = 0; k < 3; k++) {
        x[k] = mpz_get_d_2exp(&e, c[k]);
        x[k] = x[k] == 0 || e < top - 200 ? 0 : ldexp(x[k], (int)(e - top));
        square += x[k] * x[k];
    }
    double length = sqrt(square), under = mpz_get_d_2exp(&f, m), scale = mpz_get_d_2exp(&g, scene->scale);
    *ret_unit = (pir_vec3){x[0] / length, x[1] / length, x[2] / length};
    *ret_length = ldexp(length / under / scale, (int)(top - f - g));
}

/* The sign of the greatest n · (d' − d) for d' of a difference and the point c/m, both less what P is moved by. */
static bool rises_over(oracle_scene *scene, const oracle_difference *d, oracle_vec c, const mpz_t m, scratch *s) {
    // P moved by −c/m: the difference is moved likewise, and c is along n; triangles rise where d' is behind c
    oracle_dot(s->z, c, c);
    for (uint32_t k = 0; k < d->count; k++) {
        point_of(scene, d, k, s->a);
        oracle_dot(s->x, s->a, c);
        mpz_mul(s->x, s->x, m);
        if (mpz_cmp(s->x, s->z) < 0)
            return true;
    }
    return false;
}

bool oracle_scene_contact(oracle_scene *scene, uint32_t i, pir_vec3 *ret_normal, double *ret_gap) {
    scratch s;
    oracle_vec c;
    bool stands = true;
    scratch_init(&s);
    oracle_vec_init(c);
    if (!find_nearest(scene, &scene->difference[i], c, s.w, &s))
        abort();
    to_doubles(scene, c, s.w, ret_normal, ret_gap);
    for (int k = 0; k < 3; k++)
        mpz_neg(s.y[k], c[k]);
    for (uint32_t j = 0; j < scene->triangles && stands; j++) {
        oracle_difference *d = &scene->difference[j];
        if (lies(scene, d, s.y, s.w, &s) < 0 || !counts_at(scene, d, s.y, s.w, &s))
            continue;
        stands = !rises_over(scene, d, c, s.w, &s);
    }
    // the triangle itself is met there; from behind it is none
    oracle_dot(s.x, c, scene->difference[i].front);
    stands &= !(scene->difference[i].one_sided && mpz_sgn(s.x) < 0);
    oracle_vec_clear(c);
    scratch_clear(&s);
    return stands;
}

/* --- facets --- */

#define PIECE_CORNERS 96

/* A convex polygon in the plane of a facet: corners over one denominator each. */
typedef struct oracle_piece {
    uint32_t count;
    mpq_t (*corner)[3];
} oracle_piece;

static oracle_piece piece_make(void) {
    oracle_piece piece = {0, calloc(PIECE_CORNERS, sizeof *piece.corner)};
    for (int i = 0; piece.corner && i < PIECE_CORNERS; i++)
        for (int k = 0; k < 3; k++)
            mpq_init(piece.corner[i][k]);
    if (!piece.corner)
        abort();
    return piece;
}

static void piece_free(oracle_piece *piece) {
    for (int i = 0; i < PIECE_CORNERS; i++)
        for (int k = 0; k < 3; k++)
            mpq_clear(piece->corner[i][k]);
    free(piece->corner);
}

static void piece_add(oracle_piece *piece, mpq_t corner[3]) {
    if (piece->count == PIECE_CORNERS)
        abort();
    for (int k = 0; k < 3; k++)
        mpq_set(piece->corner[piece->count][k], corner[k]);
    piece->count++;
}

/* n · x less the offset of a plane. */
static void height_over(mpq_t ret, oracle_half_space *plane, mpq_t x[3]) {
    mpq_t part;
    mpq_init(part);
    mpq_set_z(ret, plane->most);
    mpq_neg(ret, ret);
    for (int k = 0; k < 3; k++) {
        mpq_set_z(part, plane->n[k]);
        mpq_mul(part, part, x[k]);
        mpq_add(ret, ret, part);
    }
    mpq_clear(part);
}

/* The part of a polygon on one side of a plane: sign −1 within, 1 beyond. */
static void piece_cut(oracle_piece *from, oracle_half_space *plane, int sign, oracle_piece *to) {
    mpq_t a, b, part, x[3];
    mpq_inits(a, b, part, x[0], x[1], x[2], NULL);
    to->count = 0;
    for (uint32_t i = 0; i < from->count; i++) {
        mpq_t *p = from->corner[i], *q = from->corner[(i + 1) % from->count];
        height_over(a, plane, p);
        height_over(b, plane, q);
        if (sign * mpq_sgn(a) >= 0)
            piece_add(to, p);
        if (mpq_sgn(a) * mpq_sgn(b) >= 0)
            continue;
        mpq_sub(b, a, b);
        mpq_div(part, a, b);
        for (int k = 0; k < 3; k++) {
            mpq_sub(x[k], q[k], p[k]);
            mpq_mul(x[k], x[k], part);
            mpq_add(x[k], x[k], p[k]);
        }
        piece_add(to, x);
    }
    mpq_clears(a, b, part, x[0], x[1], x[2], NULL);
}

/* Whether a polygon has an area: three corners that are in no line. */
static bool piece_is_wide(const oracle_piece *piece) {
    mpq_t e[3], f[3], x, y;
    bool wide = false;
    mpq_inits(e[0], e[1], e[2], f[0], f[1], f[2], x, y, NULL);
    for (uint32_t i = 2; i < piece->count && !wide; i++) {
        for (int k = 0; k < 3; k++) {
            mpq_sub(e[k], piece->corner[i - 1][k], piece->corner[0][k]);
            mpq_sub(f[k], piece->corner[i][k], piece->corner[0][k]);
        }
        for (int k = 0; k < 3 && !wide; k++) {
            mpq_mul(x, e[k], f[(k + 1) % 3]);
            mpq_mul(y, e[(k + 1) % 3], f[k]);
            wide = !mpq_equal(x, y);
        }
    }
    mpq_clears(e[0], e[1], e[2], f[0], f[1], f[2], x, y, NULL);
    return wide;
}

/* A square in a plane, far wider than all. */
static void set_square(oracle_half_space *plane, oracle_vec at, oracle_piece *piece) {
    oracle_vec axis, u, v;
    mpq_t x[3];
    oracle_vec_init(axis);
    oracle_vec_init(u);
    oracle_vec_init(v);
    mpq_inits(x[0], x[1], x[2], NULL);
    mpz_set_ui(axis[mpz_sgn(plane->n[0]) != 0 ? 1 : 0], 1);
    oracle_cross(u, plane->n, axis);
    if (oracle_is_zero(u)) {
        mpz_set_ui(axis[2], 1);
        oracle_cross(u, plane->n, axis);
    }
    oracle_cross(v, plane->n, u);
    piece->count = 0;
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            mpz_t *way = i % 2 == 0 ? &u[k] : &v[k];
            mpz_mul_2exp(axis[k], *way, 40);
            if (i >= 2)
                mpz_neg(axis[k], axis[k]);
            mpz_add(axis[k], axis[k], at[k]);
            mpq_set_z(x[k], axis[k]);
        }
        piece_add(piece, x);
    }
    mpq_clears(x[0], x[1], x[2], NULL);
    oracle_vec_clear(axis);
    oracle_vec_clear(u);
    oracle_vec_clear(v);
}

/* Whether a difference is in the way of P at the plane of another: it rises over it. */
static bool is_in_the_way(const oracle_difference *d, oracle_half_space *plane, scratch *s) {
    for (uint32_t k = 0; k < d->count; k++) {
        oracle_dot(s->x, plane->n, ((oracle_difference *)d)->d[k]);
        if (mpz_cmp(s->x, plane->most) > 0)
            return true;
    }
    return false;
}

/* Whether some of a piece is in no difference that is in the way: it is cut along the half-spaces of one after one. */
static bool is_some_left(oracle_scene *scene, oracle_half_space *plane, oracle_piece *piece, uint32_t from,
                         scratch *s) {
    if (!piece_is_wide(piece))
        return false;
    uint32_t j = from;
    while (j < scene->triangles && !is_in_the_way(&scene->difference[j], plane, s))
        j++;
    if (j == scene->triangles)
        return true;
    oracle_difference *d = &scene->difference[j];
    oracle_piece out = piece_make(), in = piece_make(), rest = piece_make();
    bool left = !d->is_solid && is_some_left(scene, plane, piece, j + 1, s);
    for (uint32_t i = 0; i < piece->count; i++)
        piece_add(&rest, piece->corner[i]);
    for (uint32_t k = 0; k < d->planes && !left && piece_is_wide(&rest); k++) {
        piece_cut(&rest, &d->plane[k], 1, &out);
        piece_cut(&rest, &d->plane[k], -1, &in);
        left = is_some_left(scene, plane, &out, j + 1, s);
        oracle_piece swap = rest;
        rest = in;
        in = swap;
    }
    piece_free(&out);
    piece_free(&in);
    piece_free(&rest);
    return left;
}

/* The facet of a difference in one of its planes. */
static void set_facet(oracle_difference *own, oracle_half_space *plane, oracle_piece *ret_piece, scratch *s) {
    oracle_piece cut = piece_make();
    uint32_t at = 0;
    for (uint32_t k = 0; k < own->count; k++) {
        oracle_dot(s->x, plane->n, own->d[k]);
        at = mpz_cmp(s->x, plane->most) == 0 ? k : at;
    }
    set_square(plane, own->d[at], ret_piece);
    for (uint32_t k = 0; k < own->planes; k++) {
        piece_cut(ret_piece, &own->plane[k], -1, &cut);
        oracle_piece swap = *ret_piece;
        *ret_piece = cut;
        cut = swap;
    }
    piece_free(&cut);
}

bool oracle_scene_exposed(oracle_scene *scene, uint32_t i, pir_vec3 normal) {
    oracle_difference *own = &scene->difference[i];
    scratch s;
    bool found = false;
    scratch_init(&s);
    for (uint32_t k = 0; k < own->planes && !found; k++) {
        oracle_half_space *plane = &own->plane[k];
        pir_vec3 unit;
        double length;
        mpz_set_ui(s.w, 1);
        to_doubles(scene, plane->n, s.w, &unit, &length);
        if (fabs(unit.x + normal.x) + fabs(unit.y + normal.y) + fabs(unit.z + normal.z) > 1e-8)
            continue;
        oracle_piece piece = piece_make();
        set_facet(own, plane, &piece, &s);
        found = !is_in_the_way(own, plane, &s) && is_some_left(scene, plane, &piece, 0, &s);
        piece_free(&piece);
    }
    scratch_clear(&s);
    return found;
}

/* --- ways out --- */

/* Whether y separates P, moved by y/m, from a difference that it is moved along. */
static bool is_over(oracle_scene *scene, const oracle_difference *d, oracle_vec y, const mpz_t m, scratch *s) {
    oracle_dot(s->z, y, y);
    for (uint32_t k = 0; k < d->count; k++) {
        point_of(scene, d, k, s->a);
        oracle_dot(s->x, s->a, y);
        mpz_mul(s->x, s->x, m);
        mpz_add(s->x, s->x, s->z);
        if (mpz_sgn(s->x) < 0)
            return false;
    }
    return true;
}

/* Whether P, moved by y/m, is on the boundary of all differences that hold it and count there, and y leads off them. */
static bool is_free(oracle_scene *scene, oracle_vec y, const mpz_t m, scratch *s) {
    for (uint32_t j = 0; j < scene->triangles; j++) {
        oracle_difference *d = &scene->difference[j];
        if (lies(scene, d, y, m, s) >= 0 && counts_at(scene, d, y, m, s) && !is_over(scene, d, y, m, s))
            return false;
    }
    return true;
}

/* Whether P, moved by y/m times 1 + part, meets nothing that counts there. */
static bool is_clear(oracle_scene *scene, oracle_vec y, const mpz_t m, double part, scratch *s) {
    oracle_vec far;
    mpz_t under;
    bool clear = true;
    oracle_vec_init(far);
    mpz_init(under);
    mpz_mul_2exp(under, m, 60);
    for (int k = 0; k < 3; k++) {
        mpz_mul_2exp(far[k], y[k], 60);
        mpz_set_d(s->x, ldexp(part, 60));
        mpz_addmul(far[k], y[k], s->x);
    }
    for (uint32_t j = 0; j < scene->triangles && clear; j++) {
        oracle_difference *d = &scene->difference[j];
        clear = lies(scene, d, far, under, s) < 0 || !counts_at(scene, d, far, under, s);
    }
    mpz_clear(under);
    oracle_vec_clear(far);
    return clear;
}

double oracle_scene_way_out(oracle_scene *scene, double step) {
    scratch s;
    oracle_vec y, zero;
    mpz_t m, one;
    double least = HUGE_VAL;
    scratch_init(&s);
    oracle_vec_init(y);
    oracle_vec_init(zero);
    mpz_inits(m, one, NULL);
    mpz_set_ui(one, 1);
    for (uint32_t i = 0; i < scene->triangles; i++) {
        oracle_difference *d = &scene->difference[i];
        if (!counts_at(scene, d, zero, one, &s) || lies(scene, d, zero, one, &s) <= 0)
            continue;
        for (uint32_t k = 0; k < d->planes; k++) {
            // P moves along −n by the slack: most + n · t, over n · n
            oracle_half_space *plane = &d->plane[k];
            oracle_dot(s.x, plane->n, d->front);
            if (d->one_sided && mpz_sgn(s.x) > 0)
                continue;
            oracle_dot(s.w, plane->n, scene->t);
            mpz_add(s.w, s.w, plane->most);
            oracle_dot(m, plane->n, plane->n);
            for (int l = 0; l < 3; l++) {
                mpz_mul(y[l], plane->n[l], s.w);
                mpz_neg(y[l], y[l]);
            }
            pir_vec3 unit;
            double length;
            to_doubles(scene, y, m, &unit, &length);
            if (length < least && lies(scene, d, y, m, &s) == 0 && is_free(scene, y, m, &s) &&
                is_clear(scene, y, m, step / length, &s))
                least = length;
        }
    }
    mpz_clears(m, one, NULL);
    oracle_vec_clear(y);
    oracle_vec_clear(zero);
    scratch_clear(&s);
    return least;
}
