/* SPDX-License-Identifier: MIT */
/*
 * See solid_mesh.h. Vertices stand in the order in which facets, then segments, then points name them. Two-sided
 * facets follow those of the boundary, each twice in a row, once each way.
 */
#include "solid/sum/solid_mesh.h"

#include "polytope/mesh.h"
#include "solid/space/exact.h"

struct source {
    pir_operands *operands;
    const pir_sum_boundary *boundary;
};

static bool reserve_exact(pir_mesh *mesh, const struct source *from) {
    const pir_allocator *a = &mesh->allocator;
    const pir_space *space = &from->operands->space;
    size_t longest = 1, weight = 1;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        mpz_t *x = space->number + space->point[from->boundary->vertex[v]].exact;
        for (int k = 0; k < 3; k++)
            longest = mpz_size(x[k]) > longest ? mpz_size(x[k]) : longest;
        weight = mpz_size(x[3]) > weight ? mpz_size(x[3]) : weight;
    }
    const pir_scale scale = {pir_int_of_mpz(from->operands->num), pir_int_of_mpz(from->operands->den)};
    mesh->exact = true;
    return pir_vectors_init(&mesh->where, a, mesh->vertex_count, (uint32_t)longest) &&
           pir_vectors_init(&mesh->weight, a, mesh->vertex_count, (uint32_t)weight) &&
           pir_scale_copy(&mesh->scale, a, &scale);
}

static void set_exact(pir_mesh *mesh, uint32_t v, mpz_t *x) {
    pir_int3 to = pir_vectors_at(&mesh->where, v), weight = pir_vectors_at(&mesh->weight, v);
    const pir_int own = pir_int_of_mpz(x[3]);
    for (int k = 0; k < 3; k++) {
        const pir_int c = pir_int_of_mpz(x[k]);
        pir_int_copy(&to.c[k], &c);
    }
    pir_int_copy(&weight.c[0], &own);
    pir_vectors_put(&mesh->where, v, &to);
    pir_vectors_put(&mesh->weight, v, &weight);
}

static void set_vertex(pir_mesh *mesh, const struct source *from, uint32_t v) {
    pir_space *space = &from->operands->space;
    mpz_t *x = space->number + space->point[from->boundary->vertex[v]].exact, *t = space->t;
    double nearest[3];
    mpz_mul(t[1], x[3], from->operands->den);
    const pir_int den = pir_int_of_mpz(t[1]), num = pir_int_of_mpz(from->operands->num);
    for (int k = 0; k < 3; k++) {
        const pir_int c = pir_int_of_mpz(x[k]);
        nearest[k] = pir_scaled_nearest_double(&c, &num, &den);
    }
    mesh->vertex[v] = (pir_vec3){nearest[0], nearest[1], nearest[2]};
    mesh->pair[v][0] = mesh->pair[v][1] = 0;
    if (mesh->exact)
        set_exact(mesh, v, x);
}

static void fill_facets(pir_mesh *mesh, const struct source *from) {
    const pir_loop_list *loops = &from->boundary->loops;
    uint32_t at = 0, made = 0;
    mesh->facets.start[0] = 0;
    for (uint32_t f = 0; f < loops->facet_count; f++) {
        const uint32_t first = f > 0 ? loops->facet[f - 1] : 0, end = loops->facet[f];
        for (uint32_t i = first; i < end; i++)
            mesh->facets.corner[at++] = from->boundary->number[loops->facet_corner[i]];
        mesh->kind[made] = f < loops->boundary_count ? PIR_FACET_MERGED : PIR_FACET_TWO_SIDED;
        mesh->facets.start[++made] = at;
        if (f < loops->boundary_count)
            continue;
        for (uint32_t i = end; i-- > first;)
            mesh->facets.corner[at++] = from->boundary->number[loops->facet_corner[i]];
        mesh->kind[made] = PIR_FACET_TWO_SIDED;
        mesh->facets.start[++made] = at;
    }
}

static bool fill_lone(pir_mesh *mesh, const struct source *from) {
    mesh->segment_count = from->boundary->segments;
    mesh->point_count = from->boundary->points.point_count;
    mesh->segment = PIR_NEW(&mesh->allocator, uint32_t, 2 * (size_t)mesh->segment_count);
    mesh->point = PIR_NEW(&mesh->allocator, uint32_t, mesh->point_count);
    if (!mesh->segment || !mesh->point)
        return false;
    uint32_t at = 0;
    for (uint32_t r = 0; r < from->boundary->outline.run_count; r++)
        if (from->boundary->outline.run[r].group == PIR_GROUP_LONE) {
            mesh->segment[at++] = from->boundary->number[from->boundary->outline.run[r].a];
            mesh->segment[at++] = from->boundary->number[from->boundary->outline.run[r].b];
        }
    for (uint32_t i = 0; i < mesh->point_count; i++)
        mesh->point[i] = from->boundary->number[from->boundary->points.point[i]];
    return true;
}

pir_status pir_solid_mesh_make(pir_operands *operands, const pir_sum_boundary *boundary, bool exact,
                               pir_mesh **ret_mesh) {
    const struct source from = {operands, boundary};
    const pir_loop_list *loops = &boundary->loops;
    const uint32_t one_sided = loops->boundary_count, two_sided = loops->facet_count - one_sided;
    const uint32_t corners = loops->facet_corner_count, once = one_sided > 0 ? loops->facet[one_sided - 1] : 0;
    pir_space *space = &operands->space;
    for (uint32_t v = 0; v < boundary->vertex_count && space->status == PIR_OK; v++)
        pir_space_exact_point(space, boundary->vertex[v]);
    if (space->status != PIR_OK)
        return space->status;
    pir_mesh *mesh = pir_mesh_new(&operands->allocator, boundary->vertex_count, one_sided + 2 * two_sided,
                                  once + 2 * (corners - once));
    if (!mesh || (exact && !reserve_exact(mesh, &from)) || !fill_lone(mesh, &from)) {
        pir_mesh_destroy(mesh);
        return PIR_ERR_MEMORY;
    }
    mesh->of_solid = true;
    mesh->edge_count = boundary->edges;
    for (uint32_t v = 0; v < boundary->vertex_count; v++)
        set_vertex(mesh, &from, v);
    fill_facets(mesh, &from);
    *ret_mesh = mesh;
    return PIR_OK;
}
