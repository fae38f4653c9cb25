/* SPDX-License-Identifier: MIT */
/* Half-spaces of pairs; halfspaces.h has the bound. */
#include "cspace/record/halfspaces.h"

#define SLACK       0x1p-44
#define LEAST_SINE2 0x1p-60

static double reach_of(const pir_polytope *p) {
    double most = 0;
    for (uint32_t v = 0; v < p->vertex_count; v++)
        most = fmax(most, pir_vec_dot(p->vertex[v], p->vertex[v]));
    return sqrt(most) * (1 + 0x1p-40);
}

pir_halfspaces pir_halfspaces_of(const pir_polytope *minus_p, const pir_polytope *q, const pir_mat3 *r) {
    return (pir_halfspaces){minus_p, q, r, SLACK * (reach_of(minus_p) + reach_of(q))};
}

/* The half-space with a corner of D, R·p + q, on its plane. */
static pir_halfspace through(const pir_halfspaces *of, pir_vec3 normal, uint32_t p, uint32_t q, double slack) {
    pir_vec3 corner = pir_vec_add(pir_mat_apply(of->r, of->p->vertex[p]), of->q->vertex[q]);
    return (pir_halfspace){normal, pir_vec_dot(normal, corner) + slack};
}

static uint32_t corner_of(const pir_polytope *of, uint32_t facet) {
    return of->origin[of->loop[of->loop_start[facet]]];
}

pir_halfspace pir_halfspace_fv(const pir_halfspaces *of, uint32_t f, uint32_t v) {
    return through(of, pir_mat_apply(of->r, of->p->normal[f]), corner_of(of->p, f), v, of->slack);
}

pir_halfspace pir_halfspace_vf(const pir_halfspaces *of, uint32_t g, uint32_t u) {
    return through(of, of->q->normal[g], u, corner_of(of->q, g), of->slack);
}

pir_halfspace pir_halfspace_ee(const pir_halfspaces *of, uint32_t e, uint32_t h, const uint32_t *fv) {
    const pir_polytope *p = of->p, *q = of->q;
    uint32_t half = p->edge_half[e];
    pir_vec3 n = pir_vec_cross(q->direction[h], pir_mat_apply(of->r, p->direction[half]));
    double sine2 = pir_vec_dot(n, n);
    if (sine2 < LEAST_SINE2)
        return pir_halfspace_fv(of, p->left[half], fv[p->left[half]]);
    double sine = sqrt(sine2);
    return through(of, pir_vec_scale(n, 1 / sine), p->origin[half], q->origin[h], of->slack / sine);
}
