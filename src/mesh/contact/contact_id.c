/* SPDX-License-Identifier: MIT */
/* Numbers of contacts: see contact_id.h. */
#include "mesh/contact/contact_id.h"

/* The first part of the name of a normal. */
enum normal_kind { OF_PLANE = 1, OF_FACET, OF_FEATURES };

/* Directions in a surface are named by coordinates that are rounded to this. */
#define DIRECTION_UNIT 0x1p-20
/* The sine of the angle between edges that are parallel, at most. */
#define PARALLEL 0x1p-20

static uint64_t mix(uint64_t hash, uint64_t x) {
    x += hash * 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

/* Adds numbers to a list in order, each once. */
static void note(uint32_t *list, uint32_t *count, uint32_t x) {
    uint32_t at = 0;
    while (at < *count && list[at] < x)
        at++;
    if (at < *count && list[at] == x)
        return;
    for (uint32_t k = (*count)++; k > at; k--)
        list[k] = list[k - 1];
    list[at] = x;
}

pir_contact_feature pir_contact_feature_of(const pir_contact_simplex *simplex) {
    uint32_t vertex[4], vertices = 0, corners = 0;
    for (uint32_t k = 0; k < simplex->count; k++) {
        note(vertex, &vertices, simplex->v[k]);
        corners |= 1u << simplex->w[k];
    }
    if (vertices > 2)
        return (pir_contact_feature){{UINT32_MAX, UINT32_MAX}, corners};
    return (pir_contact_feature){{vertex[0], vertex[vertices - 1]}, corners};
}

/* Whether a normal is that of a triangle's plane. */
static bool is_of_plane(const pir_near_triangle *s, pir_vec3 normal) {
    return pir_contact_same_normal(normal, s->front) || pir_contact_same_normal(normal, pir_vec_scale(s->front, -1));
}

/* A direction by its coordinates in the frame of a surface. */
static uint64_t direction_name(const pir_contact_job *job, uint32_t surface, pir_vec3 normal) {
    const pir_quat q = job->input->surfaces[surface].pose.rotation;
    if (!pir_quat_is_identity(q)) {
        pir_rotation rotation;
        (void)pir_rotation_set(&rotation, q); // checked before
        normal = pir_mat_apply_transposed(&rotation.r, normal);
    }
    const pir_vec3 n = pir_vec_scale(normal, 1 / DIRECTION_UNIT);
    uint64_t name = mix(OF_PLANE, (uint64_t)(int64_t)rint(n.x));
    name = mix(name, (uint64_t)(int64_t)rint(n.y));
    return mix(name, (uint64_t)(int64_t)rint(n.z));
}

/* The facet of P that a normal is of; UINT32_MAX for none. */
static uint32_t facet_of(const pir_contact_job *job, pir_vec3 normal) {
    const pir_vec3 own = pir_vec_scale(pir_mat_apply_transposed(&job->rotation.r, normal), -1);
    for (uint32_t f = 0; f < job->p->facet_count; f++)
        if (pir_contact_same_normal(own, job->p->normal[f]))
            return f;
    return UINT32_MAX;
}

/* Whether two patches are edges that are parallel, so that their nearest points wander. */
static bool are_parallel(const pir_contact_patch *p, const pir_contact_patch *q) {
    if (p->count != 2 || q->count != 2)
        return false;
    const double a[2] = {p->at[1][0] - p->at[0][0], p->at[1][1] - p->at[0][1]};
    const double b[2] = {q->at[1][0] - q->at[0][0], q->at[1][1] - q->at[0][1]};
    const double across = a[0] * b[1] - a[1] * b[0], along = a[0] * b[0] + a[1] * b[1];
    return fabs(across) <= PARALLEL * fabs(along);
}

static uint64_t features_name(const pir_contact_job *job, const pir_standing *standing, const pir_contact_patch *body) {
    const pir_near_triangle *s = &job->triangle[standing->triangle];
    const pir_patch_frame frame = pir_patch_frame_of(standing->normal);
    pir_contact_patch patch;
    uint32_t vertex[4], vertices = 0, corner[4], corners = 0;
    pir_patch_of_triangle(&frame, s, &patch);
    const bool parallel = are_parallel(body, &patch);
    for (uint32_t k = 0; k < (parallel ? 2 : standing->simplex.count); k++) {
        note(vertex, &vertices, parallel ? body->id[k] : standing->simplex.v[k]);
        note(corner, &corners, s->id[parallel ? patch.id[k] : standing->simplex.w[k]]);
    }
    uint64_t name = mix(OF_FEATURES, s->surface);
    for (uint32_t k = 0; k < vertices; k++)
        name = mix(name, vertex[k]);
    for (uint32_t k = 0; k < corners; k++)
        name = mix(name, (uint64_t)(k + 1) << 32 | corner[k]);
    return name;
}

pir_normal_name pir_contact_normal_name(const pir_contact_job *job, const pir_standing *standing,
                                        const pir_contact_patch *body) {
    if (is_of_plane(&job->triangle[standing->triangle], standing->normal))
        return (pir_normal_name){true, 0};
    const uint32_t facet = facet_of(job, standing->normal);
    return (pir_normal_name){false, facet != UINT32_MAX ? mix(OF_FACET, facet) : features_name(job, standing, body)};
}

uint64_t pir_contact_id(const pir_contact_job *job, const pir_near_triangle *s, const pir_contact_feature *feature,
                        pir_vec3 normal, pir_normal_name of) {
    const bool is_face = feature->corners == 7;
    uint32_t corner[3], corners = 0;
    uint64_t id = of.of_plane || is_of_plane(s, normal) ? direction_name(job, s->surface, normal) : of.name;
    id = mix(id, s->surface);
    for (uint32_t k = 0; k < 3 && !is_face; k++)
        if (feature->corners >> k & 1)
            note(corner, &corners, s->id[k]);
    if (is_face)
        id = mix(id, s->number);
    for (uint32_t k = 0; k < corners; k++)
        id = mix(id, (uint64_t)(k + 1) << 32 | corner[k]);
    return mix(id, (uint64_t)feature->p[0] << 32 | feature->p[1]);
}
