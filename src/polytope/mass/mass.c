/* SPDX-License-Identifier: MIT */
/*
 * Volume, centroid and inertia, as integers over the tetrahedra that vertex 0 makes with a fan of each facet.
 *
 * With the corners a, b, c of such a tetrahedron relative to vertex 0, its determinant d, and s = a + b + c, the
 * integrals over it are
 *
 *     of 1: d/6      of x: d s/24      of x xᵀ: d (a aᵀ + b bᵀ + c cᵀ + s sᵀ)/120
 *
 * Sums over all tetrahedra are integers on the scale of the vertices; what is divided is divided once, at the end. A
 * flat body has the same with triangles of its facet, segments or its point in place of tetrahedra, for the centroid.
 */
#include <math.h>

#include <pirouette/exact.h>
#include <pirouette/mass.h>

#include "base/vec.h"
#include "polytope/polytope.h"

typedef struct moments {
    mpz_t whole, first[3], second[3][3]; /* Σ d, Σ d s, Σ d (…) */
    mpz_t corner[3][3], sum[3], d, t;    /* of the simplex at hand */
    int across;                          /* the coordinate that triangles of a polygon are seen along */
} moments;

static void moments_init(moments *m) {
    mpz_inits(m->whole, m->d, m->t, NULL);
    for (int i = 0; i < 3; i++) {
        mpz_inits(m->first[i], m->sum[i], NULL);
        for (int k = 0; k < 3; k++)
            mpz_inits(m->second[i][k], m->corner[i][k], NULL);
    }
}

static void moments_clear(moments *m) {
    mpz_clears(m->whole, m->d, m->t, NULL);
    for (int i = 0; i < 3; i++) {
        mpz_clears(m->first[i], m->sum[i], NULL);
        for (int k = 0; k < 3; k++)
            mpz_clears(m->second[i][k], m->corner[i][k], NULL);
    }
}

/* Corner `index` of the simplex: a vertex relative to vertex 0. */
static void set_corner(moments *m, const pir_polytope *p, int index, uint32_t vertex) {
    pir_int3 v = pir_vertex_exact(p, vertex), origin = pir_vertex_exact(p, 0);
    for (int k = 0; k < 3; k++) {
        mpz_t a, b;
        mpz_sub(m->corner[index][k], mpz_roinit_n(a, v.c[k].limb, v.c[k].size),
                mpz_roinit_n(b, origin.c[k].limb, origin.c[k].size));
    }
}

/* d = the component k of (corner[1] − corner[0]) × (corner[2] − corner[0]). */
static void set_area(moments *m, int k) {
    int i = (k + 1) % 3, j = (k + 2) % 3;
    mpz_set_ui(m->d, 0);
    for (int a = 0; a < 3; a++) {
        int b = (a + 1) % 3;
        mpz_addmul(m->d, m->corner[a][i], m->corner[b][j]);
        mpz_submul(m->d, m->corner[a][j], m->corner[b][i]);
    }
}

/* d = the determinant of the three corners. */
static void set_determinant(moments *m) {
    mpz_set_ui(m->d, 0);
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        mpz_mul(m->t, m->corner[1][i], m->corner[2][j]);
        mpz_submul(m->t, m->corner[1][j], m->corner[2][i]);
        mpz_addmul(m->d, m->corner[0][k], m->t);
    }
}

/* Adds the simplex of the first `corners` corners and, in dimension 3, vertex 0. */
static void add_simplex(moments *m, int corners) {
    mpz_add(m->whole, m->whole, m->d);
    for (int k = 0; k < 3; k++) {
        mpz_set_ui(m->sum[k], 0);
        for (int c = 0; c < corners; c++)
            mpz_add(m->sum[k], m->sum[k], m->corner[c][k]);
        mpz_addmul(m->first[k], m->d, m->sum[k]);
    }
    for (int i = 0; i < 3; i++)
        for (int k = i; k < 3; k++) {
            mpz_mul(m->t, m->sum[i], m->sum[k]);
            for (int c = 0; c < corners; c++)
                mpz_addmul(m->t, m->corner[c][i], m->corner[c][k]);
            mpz_addmul(m->second[i][k], m->d, m->t);
        }
}

/* Adds the fan of a facet: in dimension 3 as tetrahedra, in dimension 2 as triangles. */
static void add_facet(moments *m, const pir_polytope *p, uint32_t facet) {
    uint32_t start = p->loop_start[facet], end = p->loop_start[facet + 1];
    set_corner(m, p, 0, p->origin[p->loop[start]]);
    for (uint32_t i = start + 1; i + 1 < end; i++) {
        set_corner(m, p, 1, p->origin[p->loop[i]]);
        set_corner(m, p, 2, p->origin[p->loop[i + 1]]);
        if (p->dimension == 3)
            set_determinant(m);
        else
            set_area(m, m->across);
        add_simplex(m, 3);
    }
}

static void find_moments(moments *m, const pir_polytope *p) {
    if (p->dimension == 3) {
        for (uint32_t f = 0; f < p->facet_count; f++)
            add_facet(m, p, f);
    } else if (p->dimension == 2) {
        pir_int3 n = pir_normal_exact(p, 0);
        while (n.c[m->across].size == 0)
            m->across++;
        add_facet(m, p, 0);
    } else {
        for (int c = 0; c <= p->dimension; c++)
            set_corner(m, p, c, (uint32_t)c);
        mpz_set_ui(m->d, 1);
        add_simplex(m, p->dimension + 1);
    }
}

/* to = numerator / (denominator · factor). */
static void set_quotient(mpq_t to, const mpz_t numerator, const mpz_t denominator, unsigned long factor) {
    mpz_set(mpq_numref(to), numerator);
    mpz_mul_ui(mpq_denref(to), denominator, factor);
    mpq_canonicalize(to);
}

/* The second moment (i, k) about the centroid, on the scale: second/120 − first first / (96 whole). */
static void set_spread(mpq_t to, moments *m, int i, int k) {
    mpz_mul(m->t, m->first[i], m->first[k]);
    mpz_mul_ui(m->t, m->t, 5);
    mpz_mul(m->d, m->second[i][k], m->whole);
    mpz_submul_ui(m->t, m->d, 4);
    mpz_neg(m->t, m->t);
    set_quotient(to, m->t, m->whole, 480);
}

/* The scale, to the third and to the fifth power. */
static void set_scales(const pir_polytope *p, mpq_t scale, mpq_t cube, mpq_t fifth) {
    mpz_t num, den;
    mpz_set(mpq_numref(scale), mpz_roinit_n(num, p->scale.num.limb, p->scale.num.size));
    mpz_set(mpq_denref(scale), mpz_roinit_n(den, p->scale.den.limb, p->scale.den.size));
    mpq_canonicalize(scale);
    mpq_mul(cube, scale, scale);
    mpq_mul(fifth, cube, cube);
    mpq_mul(fifth, fifth, scale);
    mpq_mul(cube, cube, scale);
}

/* The inertia from the spread: the trace less the spread, on the diagonal that of the two other axes. */
static void set_inertia(moments *m, const mpq_t fifth, mpq_t inertia[6]) {
    static const int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
    mpq_t spread[3];
    mpq_inits(spread[0], spread[1], spread[2], NULL);
    for (int k = 0; k < 3; k++)
        set_spread(spread[k], m, k, k);
    for (int k = 0; k < 6; k++) {
        if (k < 3) {
            mpq_add(inertia[k], spread[(k + 1) % 3], spread[(k + 2) % 3]);
        } else {
            set_spread(inertia[k], m, row[k], column[k]);
            mpq_neg(inertia[k], inertia[k]);
        }
        mpq_mul(inertia[k], inertia[k], fifth);
    }
    mpq_clears(spread[0], spread[1], spread[2], NULL);
}

pir_status pir_polytope_mass_exact(const pir_polytope *p, mpq_t ret_volume, mpq_t *ret_centroid, mpq_t *ret_inertia) {
    if (!p || !ret_volume || !ret_centroid || !ret_inertia)
        return PIR_ERR_ARGUMENT;
    moments m = {.across = 0};
    mpq_t scale, cube, fifth;
    mpq_inits(scale, cube, fifth, NULL);
    moments_init(&m);
    find_moments(&m, p);
    set_scales(p, scale, cube, fifth);
    pir_int3 origin = pir_vertex_exact(p, 0);
    for (int k = 0; k < 3; k++) {
        mpz_t view;
        set_quotient(ret_centroid[k], m.first[k], m.whole, (unsigned long)p->dimension + 1);
        mpz_addmul(mpq_numref(ret_centroid[k]), mpq_denref(ret_centroid[k]),
                   mpz_roinit_n(view, origin.c[k].limb, origin.c[k].size));
        mpq_mul(ret_centroid[k], ret_centroid[k], scale);
    }
    mpq_set_ui(ret_volume, 0, 1);
    for (int k = 0; k < 6; k++)
        mpq_set_ui(ret_inertia[k], 0, 1);
    if (p->dimension == 3) {
        mpz_set(mpq_numref(ret_volume), m.whole);
        mpz_set_ui(mpq_denref(ret_volume), 6);
        mpq_canonicalize(ret_volume);
        mpq_mul(ret_volume, ret_volume, cube);
        set_inertia(&m, fifth, ret_inertia);
    }
    moments_clear(&m);
    mpq_clears(scale, cube, fifth, NULL);
    return PIR_OK;
}

/* --- in doubles --- */

static double nearest(const mpq_t q) {
    mp_limb_t one_limb = 1;
    pir_int one = {&one_limb, 1, 0};
    pir_int num = {(mp_limb_t *)mpz_limbs_read(mpq_numref(q)), (int32_t)mpz_size(mpq_numref(q)), 0};
    pir_int den = {(mp_limb_t *)mpz_limbs_read(mpq_denref(q)), (int32_t)mpz_size(mpq_denref(q)), 0};
    if (mpq_sgn(q) < 0)
        pir_int_negate(&num);
    return pir_scaled_nearest_double(&num, &one, &den);
}

static bool is_finite(const pir_mass *mass) {
    bool all = isfinite(mass->volume) && pir_vec_is_finite(mass->centroid);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            all = all && isfinite(mass->inertia[i][k]);
    return all;
}

pir_status pir_polytope_mass(const pir_polytope *p, pir_mass *ret_mass) {
    if (!p || !ret_mass)
        return PIR_ERR_ARGUMENT;
    mpq_t volume, centroid[3], inertia[6];
    mpq_init(volume);
    for (int k = 0; k < 6; k++)
        mpq_init(inertia[k]);
    for (int k = 0; k < 3; k++)
        mpq_init(centroid[k]);
    pir_polytope_mass_exact(p, volume, centroid, inertia);
    double yz = nearest(inertia[3]), xz = nearest(inertia[4]), xy = nearest(inertia[5]);
    pir_mass mass = {nearest(volume),
                     {nearest(centroid[0]), nearest(centroid[1]), nearest(centroid[2])},
                     {{nearest(inertia[0]), xy, xz}, {xy, nearest(inertia[1]), yz}, {xz, yz, nearest(inertia[2])}}};
    mpq_clear(volume);
    for (int k = 0; k < 6; k++)
        mpq_clear(inertia[k]);
    for (int k = 0; k < 3; k++)
        mpq_clear(centroid[k]);
    if (!is_finite(&mass))
        return PIR_ERR_LIMIT;
    *ret_mass = mass;
    return PIR_OK;
}

/* Adds a body's inertia about a point that its centroid is `away` from. */
static void add_inertia(pir_mass *sum, const pir_mass *mass, pir_vec3 away) {
    double a[3] = {away.x, away.y, away.z}, square = pir_vec_dot(away, away);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            sum->inertia[i][k] += mass->inertia[i][k] + mass->volume * ((i == k ? square : 0) - a[i] * a[k]);
}

pir_status pir_mass_combine(const pir_mass *masses, size_t count, pir_mass *ret_mass) {
    if (!masses || count == 0 || !ret_mass)
        return PIR_ERR_ARGUMENT;
    pir_mass sum = {.volume = 0};
    pir_vec3 mean = {0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        if (!is_finite(&masses[i]))
            return PIR_ERR_NOT_FINITE;
        sum.volume += masses[i].volume;
        sum.centroid = pir_vec_add(sum.centroid, pir_vec_scale(masses[i].centroid, masses[i].volume));
        mean = pir_vec_add(mean, masses[i].centroid);
    }
    sum.centroid =
        sum.volume > 0 ? pir_vec_scale(sum.centroid, 1 / sum.volume) : pir_vec_scale(mean, 1 / (double)count);
    for (size_t i = 0; i < count; i++)
        add_inertia(&sum, &masses[i], pir_vec_sub(masses[i].centroid, sum.centroid));
    *ret_mass = sum;
    return PIR_OK;
}
