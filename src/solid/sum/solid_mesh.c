/* SPDX-License-Identifier: MIT */
/*
 * See solid_mesh.h. Vertices stand in the order in which facets, then segments, then points name them. Two-sided facets
 * follow those of the boundary, each twice in a row, once each way.
 */
#include "solid/sum/solid_mesh.h"

#include "polytope/mesh.h"
#include "solid/space/exact.h"

struct source {
    pir_operands *operands;
    const pir_union_outline *outline;
    const pir_loop_list *loops;
    const pir_touching *points;
    uint32_t *number, *point; /* per point of the space its vertex; per vertex its point */
    uint32_t vertices, segments;
};

static bool reserve_exact(pir_mesh *mesh, const struct source *from, const uint32_t *point) {
    const pir_allocator *a = &mesh->allocator;
    const pir_space *space = &from->operands->space;
    size_t longest = 1, weight = 1;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        mpz_t *x = space->number + space->point[point[v]].exact;
        for (int k = 0; k < 3; k++)
            longest = mpz_size(x[k]) > longest ? mpz_size(x[k]) : longest;
        weight = mpz_size(x[3]) > weight ? mpz_size(x[3]) : weight;
    }
    const pir_scale scale = {pir_int_of_mpz(from->operands->num), pir_int_of_mpz(from->operands->den)};
    return pir_vectors_init(&mesh->where, a, mesh->vertex_count, (uint32_t)longest) &&
           pir_vectors_init(&mesh->weight, a, mesh->vertex_count, (uint32_t)weight) &&
           pir_scale_copy(&mesh->scale, a, &scale);
}

static void set_vertex(pir_mesh *mesh, const struct source *from, uint32_t v, uint32_t point) {
    pir_space *space = &from->operands->space;
    mpz_t *x = space->number + space->point[point].exact, *t = space->t;
    pir_int3 to = pir_vectors_at(&mesh->where, v), weight = pir_vectors_at(&mesh->weight, v);
    double nearest[3];
    mpz_mul(t[1], x[3], from->operands->den);
    const pir_int den = pir_int_of_mpz(t[1]), own = pir_int_of_mpz(x[3]), num = pir_int_of_mpz(from->operands->num);
    for (int k = 0; k < 3; k++) {
        const pir_int c = pir_int_of_mpz(x[k]);
        pir_int_copy(&to.c[k], &c);
        nearest[k] = pir_scaled_nearest_double(&c, &num, &den);
    }
    pir_int_copy(&weight.c[0], &own);
    pir_vectors_put(&mesh->where, v, &to);
    pir_vectors_put(&mesh->weight, v, &weight);
    mesh->vertex[v] = (pir_vec3){nearest[0], nearest[1], nearest[2]};
    mesh->pair[v][0] = mesh->pair[v][1] = 0;
}

static void name(struct source *from, uint32_t point) {
    if (from->number[point] != PIR_SPACE_NONE)
        return;
    from->number[point] = from->vertices;
    from->point[from->vertices++] = point;
}

static void name_all(struct source *from) {
    for (uint32_t i = 0; i < from->loops->facet_corner_count; i++)
        name(from, from->loops->facet_corner[i]);
    for (uint32_t r = 0; r < from->outline->run_count; r++)
        if (from->outline->run[r].group == PIR_GROUP_LONE) {
            name(from, from->outline->run[r].a);
            name(from, from->outline->run[r].b);
            from->segments++;
        }
    for (uint32_t i = 0; i < from->points->point_count; i++)
        name(from, from->points->point[i]);
}

static void fill_facets(pir_mesh *mesh, const struct source *from) {
    const pir_loop_list *loops = from->loops;
    uint32_t at = 0, made = 0;
    mesh->facets.start[0] = 0;
    for (uint32_t f = 0; f < loops->facet_count; f++) {
        const uint32_t first = f > 0 ? loops->facet[f - 1] : 0, end = loops->facet[f];
        for (uint32_t i = first; i < end; i++)
            mesh->facets.corner[at++] = from->number[loops->facet_corner[i]];
        mesh->kind[made] = f < loops->boundary_count ? PIR_FACET_MERGED : PIR_FACET_TWO_SIDED;
        mesh->facets.start[++made] = at;
        if (f < loops->boundary_count)
            continue;
        for (uint32_t i = end; i-- > first;)
            mesh->facets.corner[at++] = from->number[loops->facet_corner[i]];
        mesh->kind[made] = PIR_FACET_TWO_SIDED;
        mesh->facets.start[++made] = at;
    }
}

static bool fill_lone(pir_mesh *mesh, const struct source *from) {
    mesh->segment_count = from->segments;
    mesh->point_count = from->points->point_count;
    mesh->segment = PIR_NEW(&mesh->allocator, uint32_t, 2 * (size_t)mesh->segment_count);
    mesh->point = PIR_NEW(&mesh->allocator, uint32_t, mesh->point_count);
    if (!mesh->segment || !mesh->point)
        return false;
    uint32_t at = 0;
    for (uint32_t r = 0; r < from->outline->run_count; r++)
        if (from->outline->run[r].group == PIR_GROUP_LONE) {
            mesh->segment[at++] = from->number[from->outline->run[r].a];
            mesh->segment[at++] = from->number[from->outline->run[r].b];
        }
    for (uint32_t i = 0; i < mesh->point_count; i++)
        mesh->point[i] = from->number[from->points->point[i]];
    return true;
}

static pir_status fill(struct source *from, pir_mesh **ret_mesh) {
    const pir_loop_list *loops = from->loops;
    const uint32_t boundary = loops->boundary_count, two_sided = loops->facet_count - boundary;
    const uint32_t corners = loops->facet_corner_count, once = boundary > 0 ? loops->facet[boundary - 1] : 0;
    name_all(from);
    pir_mesh *mesh =
        pir_mesh_new(&from->operands->allocator, from->vertices, boundary + 2 * two_sided, once + 2 * (corners - once));
    if (!mesh || !reserve_exact(mesh, from, from->point) || !fill_lone(mesh, from)) {
        pir_mesh_destroy(mesh);
        return PIR_ERR_MEMORY;
    }
    mesh->exact = true;
    mesh->of_solid = true;
    for (uint32_t v = 0; v < from->vertices; v++)
        set_vertex(mesh, from, v, from->point[v]);
    fill_facets(mesh, from);
    *ret_mesh = mesh;
    return PIR_OK;
}

pir_status pir_solid_mesh_make(pir_operands *operands, const pir_union_outline *outline, const pir_loop_list *loops,
                               const pir_touching *points, pir_mesh **ret_mesh) {
    const pir_allocator *a = &operands->allocator;
    const uint32_t count = operands->space.point_count;
    struct source from = {.operands = operands, .outline = outline, .loops = loops, .points = points};
    from.number = PIR_NEW(a, uint32_t, count);
    from.point = PIR_NEW(a, uint32_t, count);
    pir_status status = PIR_ERR_MEMORY;
    for (uint32_t p = 0; p < count && from.number; p++)
        from.number[p] = PIR_SPACE_NONE;
    if (from.number && from.point)
        status = fill(&from, ret_mesh);
    PIR_FREE(a, from.number, count);
    PIR_FREE(a, from.point, count);
    return status;
}
