/* SPDX-License-Identifier: MIT */
/*
 * Polytopes moved without loss: the exact hull of the exact images of the vertices, in their order. A rigid motion
 * keeps which points are extreme and which are coplanar, so all features come back under their numbers.
 */
#include <math.h>
#include <string.h>

#include <pirouette/exact.h>
#include <pirouette/mass.h>

#include "base/vec.h"
#include "polytope/polytope.h"

/* x → linear·x / norm + offset, in rationals. */
typedef struct affine_map {
    mpq_t linear[3][3], norm, offset[3];
} affine_map;

static void motion_init(affine_map *m) {
    mpq_init(m->norm);
    for (int i = 0; i < 3; i++) {
        mpq_init(m->offset[i]);
        for (int k = 0; k < 3; k++)
            mpq_init(m->linear[i][k]);
    }
}

static void motion_clear(affine_map *m) {
    mpq_clear(m->norm);
    for (int i = 0; i < 3; i++) {
        mpq_clear(m->offset[i]);
        for (int k = 0; k < 3; k++)
            mpq_clear(m->linear[i][k]);
    }
}

/*
 * linear = M(q) and norm = |q|²: M has w² + v_i² − v_j² − v_k² on its diagonal and 2 (v_i v_k ± w v_j) beside
 * it.
 */
static void set_rotation(affine_map *m, pir_quat q) {
    double components[4] = {q.x, q.y, q.z, q.w};
    mpq_t c[4], t;
    mpq_init(t);
    for (int i = 0; i < 4; i++) {
        mpq_init(c[i]);
        mpq_set_d(c[i], components[i]);
        mpq_mul(t, c[i], c[i]);
        mpq_add(m->norm, m->norm, t);
        for (int k = 0; k < 3; k++)
            (i == 3 || i == k ? mpq_add : mpq_sub)(m->linear[k][k], m->linear[k][k], t);
    }
    for (int i = 0; i < 3; i++) {
        int k = (i + 1) % 3, j = (i + 2) % 3;
        mpq_t product;
        mpq_init(product);
        mpq_mul(product, c[i], c[k]);
        mpq_mul(t, c[3], c[j]);
        mpq_sub(m->linear[i][k], product, t);
        mpq_add(m->linear[k][i], product, t);
        mpq_mul_2exp(m->linear[i][k], m->linear[i][k], 1);
        mpq_mul_2exp(m->linear[k][i], m->linear[k][i], 1);
        mpq_clear(product);
    }
    for (int i = 0; i < 4; i++)
        mpq_clear(c[i]);
    mpq_clear(t);
}

/* The images of all vertices, three rationals each. */
static void apply(const affine_map *m, const pir_polytope *p, mpq_t *coordinates) {
    mpq_t x[3], t;
    mpq_inits(x[0], x[1], x[2], t, NULL);
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        pir_polytope_vertex_exact(p, v, x);
        for (int i = 0; i < 3; i++) {
            mpq_t *y = &coordinates[3 * (size_t)v + (size_t)i];
            for (int k = 0; k < 3; k++) {
                mpq_mul(t, m->linear[i][k], x[k]);
                mpq_add(*y, *y, t);
            }
            mpq_div(*y, *y, m->norm);
            mpq_add(*y, *y, m->offset[i]);
        }
    }
    mpq_clears(x[0], x[1], x[2], t, NULL);
}

static bool has_finite_vertices(const pir_polytope *p) {
    for (uint32_t v = 0; v < p->vertex_count; v++)
        if (!pir_vec_is_finite(p->vertex[v]))
            return false;
    return true;
}

static pir_status move(const affine_map *m, const pir_polytope *p, pir_polytope **ret_polytope) {
    size_t count = 3 * (size_t)p->vertex_count;
    mpq_t *coordinates = PIR_NEW(&p->allocator, mpq_t, count);
    if (!coordinates)
        return PIR_ERR_MEMORY;
    for (size_t i = 0; i < count; i++)
        mpq_init(coordinates[i]);
    apply(m, p, coordinates);
    pir_polytope_options options = {sizeof options, &p->allocator, 0};
    pir_polytope *moved;
    pir_status status = pir_polytope_create_exact((const mpq_t *)coordinates, p->vertex_count, &options, &moved);
    for (size_t i = 0; i < count; i++)
        mpq_clear(coordinates[i]);
    PIR_FREE(&p->allocator, coordinates, count);
    if (status != PIR_OK)
        return status;
    if (!has_finite_vertices(moved)) {
        pir_polytope_release(moved);
        return PIR_ERR_LIMIT;
    }
    memcpy(moved->source, p->source, p->vertex_count * sizeof *p->source);
    moved->merge_bound = p->merge_bound;
    *ret_polytope = moved;
    return PIR_OK;
}

pir_status pir_polytope_transform(const pir_polytope *p, pir_pose pose, pir_polytope **ret_polytope) {
    pir_quat q = pose.rotation;
    pir_vec3 t = pose.translation;
    if (!p || !ret_polytope)
        return PIR_ERR_ARGUMENT;
    if (!isfinite(q.x) || !isfinite(q.y) || !isfinite(q.z) || !isfinite(q.w) || !pir_vec_is_finite(t))
        return PIR_ERR_NOT_FINITE;
    if (q.x == 0 && q.y == 0 && q.z == 0 && q.w == 0)
        return PIR_ERR_ZERO_QUATERNION;
    affine_map m;
    motion_init(&m);
    set_rotation(&m, q);
    mpq_set_d(m.offset[0], t.x);
    mpq_set_d(m.offset[1], t.y);
    mpq_set_d(m.offset[2], t.z);
    pir_status status = move(&m, p, ret_polytope);
    motion_clear(&m);
    return status;
}

pir_status pir_polytope_translate(const pir_polytope *p, pir_vec3 offset, pir_polytope **ret_polytope) {
    return pir_polytope_transform(p, (pir_pose){{0, 0, 0, 1}, offset}, ret_polytope);
}

pir_status pir_polytope_recentre(const pir_polytope *p, pir_polytope **ret_polytope, pir_vec3 *ret_offset) {
    pir_mass mass;
    if (!p || !ret_polytope || !ret_offset)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_polytope_mass(p, &mass);
    if (status == PIR_OK)
        status = pir_polytope_translate(p, pir_vec_scale(mass.centroid, -1), ret_polytope);
    if (status == PIR_OK)
        *ret_offset = mass.centroid;
    return status;
}
