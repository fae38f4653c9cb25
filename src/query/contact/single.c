/* SPDX-License-Identifier: MIT */
/*
 * A facet is its own patch in every direction near its normal where the edges that leave it fall from its plane by
 * more than PIR_FLAT and what the normals differ by.
 */
#include "query/contact/single.h"

#include "query/contact/clip.h"

/* A facet at a smaller cosine with the contact normal is not taken: heights on its plane would lose digits. */
#define LEAST_COSINE 0x1p-4

/* Above what sines and differences of unit vectors round by. */
#define ROUNDING 0x1p-40

/* --- vertices and edges --- */

/* Whether all edges from v but one to `except` fall or rise steeply. m is a direction of the body. */
static bool is_sharp_at(const pir_polytope *p, uint32_t v, uint32_t except, pir_vec3 m) {
    bool sharp = true;
    for (uint32_t h = p->ring_start[v]; h < p->ring_start[v + 1]; h++)
        sharp &= fabs(pir_vec_dot(m, p->direction[h])) > PIR_FLAT || p->target[h] == except;
    return sharp;
}

bool pir_patch_is_sharp(const pir_patch *patch, pir_feature feature) {
    const pir_polytope *p = patch->polytope;
    pir_vec3 m = pir_patch_to_body(patch, patch->out);
    if (feature.kind == PIR_FEATURE_VERTEX)
        return is_sharp_at(p, feature.index, UINT32_MAX, m);
    uint32_t half = p->edge_half[feature.index], a = p->origin[half], b = p->target[half];
    return is_sharp_at(p, a, b, m) && is_sharp_at(p, b, a, m);
}

/* --- facets --- */

static float fall_of(const pir_polytope *p, uint32_t f) {
    double least = 1;
    if (p->loop_start[f + 1] - p->loop_start[f] > PIR_CLIP_MOST)
        return 0;
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++) {
        uint32_t v = p->origin[p->loop[i]];
        for (uint32_t h = p->ring_start[v]; h < p->ring_start[v + 1]; h++)
            if (p->left[h] != f && pir_right(p, h) != f)
                least = fmin(least, -pir_vec_dot(p->direction[h], p->normal[f]));
    }
    return (float)least;
}

/* Whether f alone is the patch that grows from it across `out`, a direction of the body. */
static bool stands_alone(pir_patch *patch, uint32_t f, pir_vec3 out) {
    if (patch->fall.facet != f + 1)
        patch->fall = (pir_fall){f + 1, fall_of(patch->polytope, f)};
    pir_vec3 off = pir_vec_sub(out, patch->polytope->normal[f]);
    double room = patch->fall.sine * (1 - 0x1p-20) - PIR_FLAT - ROUNDING;
    return room > 0 && pir_vec_dot(off, off) < room * room;
}

/* Of the facets at v, the one that faces `out`, a direction of the body, most, where it does so more than `*most`. */
static void find_facing(const pir_polytope *p, uint32_t v, pir_vec3 out, double *most, uint32_t *facet) {
    for (uint32_t h = p->ring_start[v]; h < p->ring_start[v + 1]; h++) {
        double along = pir_vec_dot(p->normal[p->left[h]], out);
        if (along > *most) {
            *most = along;
            *facet = p->left[h];
        }
    }
}

uint32_t pir_patch_single(pir_patch *patch, pir_feature feature) {
    const pir_polytope *p = patch->polytope;
    pir_vec3 out = pir_patch_to_body(patch, patch->out);
    if (p->artificial)
        return PIR_NO_FACET;
    if (feature.kind == PIR_FEATURE_FACET)
        return stands_alone(patch, feature.index, out) ? feature.index : PIR_NO_FACET;
    if (!pir_patch_is_sharp(patch, feature))
        return PIR_NO_FACET;
    uint32_t f = PIR_NO_FACET;
    double most = LEAST_COSINE;
    if (feature.kind == PIR_FEATURE_VERTEX) {
        find_facing(p, feature.index, out, &most, &f);
    } else {
        uint32_t half = p->edge_half[feature.index];
        find_facing(p, p->origin[half], out, &most, &f);
        find_facing(p, p->target[half], out, &most, &f);
        // one at a single end of the edge leaves the other end beside it
        if (f != p->left[half] && f != pir_right(p, half))
            return PIR_NO_FACET;
    }
    return f != PIR_NO_FACET && stands_alone(patch, f, p->normal[f]) ? f : PIR_NO_FACET;
}

void pir_patch_set_single(pir_patch *patch, uint32_t facet, const pir_vec3 axis[3]) {
    const pir_polytope *p = patch->polytope;
    pir_vec3 own[3];
    double at[3];
    for (int k = 0; k < 3; k++) {
        own[k] = pir_patch_to_body(patch, axis[k]);
        at[k] = pir_vec_dot(axis[k], patch->at);
    }
    uint32_t start = p->loop_start[facet], count = p->loop_start[facet + 1] - start;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t v = p->origin[p->loop[start + i]];
        pir_vec3 x = patch->vertex[v];
        patch->corner[i] =
            (pir_corner){.u = pir_vec_dot(own[0], x) + at[0], .v = pir_vec_dot(own[1], x) + at[1], .p = v};
    }
    pir_vec3 n = p->normal[facet];
    const pir_corner *first = &patch->corner[0];
    double by = -1 / pir_vec_dot(n, own[2]);
    patch->along_u = by * pir_vec_dot(n, own[0]);
    patch->along_v = by * pir_vec_dot(n, own[1]);
    patch->height =
        pir_vec_dot(own[2], patch->vertex[first->p]) + at[2] - patch->along_u * first->u - patch->along_v * first->v;
    patch->outline = (pir_outline){patch->corner, count};
}
