/* SPDX-License-Identifier: MIT */
/*
 * The exact sum of two solids: P = ∪ P_i and Q = ∪ Q_j in convex pieces, P ⊕ Q = ∪ (P_i ⊕ Q_j). Its boundary
 * is what the sums of pairs leave of the candidates (convolution.c, remains.c), glued plane by plane into maximal
 * facets (union_outline.c, facet_loops.c). Instead of uniting volumes, polygons are clipped in their planes
 * (Hachenberger 2009 unites Nef polyhedra).
 */
#include <pirouette/solid.h>

#include "base/sort.h"
#include "polytope/mesh.h"
#include "solid/pieces/join_pieces.h"
#include "solid/space/exact.h"
#include "solid/sum/facet_loops.h"
#include "solid/sum/operands.h"
#include "solid/sum/remains.h"

struct job {
    pir_operands operands;
    pir_cells cells[2];
    pir_piece_list pieces[2];
    pir_convexes convexes[2];
    pir_remains remains;
    pir_outline outline;
    pir_loop_list loops;
    pir_fragments fragments;
    uint32_t *order, *work;
    uint32_t order_count;
};

pir_solid_sum_options pir_solid_sum_options_default(void) {
    return (pir_solid_sum_options){.solid = pir_solid_options_default(), .difference = 0};
}

static void finish(struct job *job) {
    pir_space *space = &job->operands.space;
    const pir_allocator *a = &job->operands.allocator;
    PIR_FREE(a, job->order, job->order_count);
    PIR_FREE(a, job->work, job->order_count);
    pir_loop_list_finish(&job->loops);
    pir_outline_finish(&job->outline);
    pir_fragments_finish(&job->fragments, space);
    pir_remains_finish(&job->remains);
    for (int k = 0; k < 2; k++) {
        pir_convexes_finish(&job->convexes[k]);
        pir_piece_list_finish(&job->pieces[k], space);
        pir_cells_finish(&job->cells[k]);
    }
    pir_operands_finish(&job->operands);
}

static bool survivor_before(void *context, uint32_t a, uint32_t b) {
    const pir_survivor *survivor = context;
    return survivor[a].half < survivor[b].half;
}

/* The boundary of what is left, plane by plane. */
static void outline_planes(struct job *job) {
    pir_space *space = &job->operands.space;
    pir_remains *remains = &job->remains;
    job->order_count = remains->survivor_count;
    job->order = PIR_NEW(&space->allocator, uint32_t, job->order_count);
    job->work = PIR_NEW(&space->allocator, uint32_t, job->order_count);
    pir_outline_init(&job->outline, space);
    if (!job->order || !job->work) {
        space->status = PIR_ERR_MEMORY;
        return;
    }
    for (uint32_t s = 0; s < job->order_count; s++)
        job->order[s] = s;
    pir_sort(job->order, job->order_count, job->work, survivor_before, remains->survivor);
    for (uint32_t i = 0, end; i < job->order_count && space->status == PIR_OK; i = end) {
        for (end = i + 1;
             end < job->order_count && remains->survivor[job->order[i]].half == remains->survivor[job->order[end]].half;
             end++)
            ;
        job->fragments.count = 0;
        pir_remains_part(remains, job->order + i, end - i, &job->fragments);
        pir_outline_add(&job->outline, &remains->kept, job->fragments.polygon, job->fragments.count);
    }
    pir_outline_cut(&job->outline);
    pir_loops_trace(&job->loops, &job->outline);
}

static pir_status compute(struct job *job) {
    pir_space *space = &job->operands.space;
    for (int k = 0; k < 2; k++) {
        pir_cells_init(&job->cells[k], space);
        pir_status status = pir_decompose(&job->operands.body[k], &job->cells[k], &job->pieces[k]);
        if (status != PIR_OK)
            return status;
        pir_merge_pieces(&job->cells[k], &job->pieces[k]);
        pir_convexes_make(&job->convexes[k], &job->cells[k], &job->pieces[k]);
    }
    if (space->status == PIR_OK)
        pir_remains_make(&job->remains, job->operands.body, job->convexes);
    if (space->status == PIR_OK)
        outline_planes(job);
    return space->status;
}

/* --- the mesh --- */

static bool reserve_exact(pir_mesh *mesh, struct job *job, const uint32_t *point) {
    const pir_allocator *a = &mesh->allocator;
    const pir_space *space = &job->operands.space;
    size_t longest = 1, weight = 1;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        mpz_t *x = space->number + space->point[point[v]].exact;
        for (int k = 0; k < 3; k++)
            longest = mpz_size(x[k]) > longest ? mpz_size(x[k]) : longest;
        weight = mpz_size(x[3]) > weight ? mpz_size(x[3]) : weight;
    }
    const pir_scale scale = {pir_int_of_mpz(job->operands.num), pir_int_of_mpz(job->operands.den)};
    return pir_vectors_init(&mesh->where, a, mesh->vertex_count, (uint32_t)longest) &&
           pir_vectors_init(&mesh->weight, a, mesh->vertex_count, (uint32_t)weight) &&
           pir_scale_copy(&mesh->scale, a, &scale);
}

static void set_vertex(pir_mesh *mesh, struct job *job, uint32_t v, uint32_t point) {
    pir_space *space = &job->operands.space;
    mpz_t *x = space->number + space->point[point].exact, *t = space->t;
    pir_int3 to = pir_vectors_at(&mesh->where, v), weight = pir_vectors_at(&mesh->weight, v);
    double nearest[3];
    mpz_mul(t[1], x[3], job->operands.den);
    const pir_int den = pir_int_of_mpz(t[1]), own = pir_int_of_mpz(x[3]), num = pir_int_of_mpz(job->operands.num);
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

/* The vertices in the order in which facets name them; `number` is per point of the space. */
static pir_status fill_mesh(struct job *job, uint32_t *number, uint32_t *point, pir_mesh **ret_mesh) {
    const pir_loop_list *loops = &job->loops;
    uint32_t vertices = 0;
    for (uint32_t i = 0; i < loops->facet_corner_count; i++) {
        const uint32_t p = loops->facet_corner[i];
        if (number[p] == PIR_SPACE_NONE) {
            number[p] = vertices;
            point[vertices++] = p;
        }
    }
    pir_mesh *mesh = pir_mesh_new(&job->operands.allocator, vertices, loops->facet_count, loops->facet_corner_count);
    if (!mesh || !reserve_exact(mesh, job, point)) {
        pir_mesh_destroy(mesh);
        return PIR_ERR_MEMORY;
    }
    mesh->exact = true;
    mesh->edge_count = job->outline.run_count / 2;
    for (uint32_t v = 0; v < vertices; v++)
        set_vertex(mesh, job, v, point[v]);
    mesh->facets.start[0] = 0;
    for (uint32_t f = 0; f < loops->facet_count; f++) {
        mesh->facets.start[f + 1] = loops->facet[f];
        mesh->kind[f] = PIR_FACET_MERGED;
    }
    for (uint32_t i = 0; i < loops->facet_corner_count; i++)
        mesh->facets.corner[i] = number[loops->facet_corner[i]];
    *ret_mesh = mesh;
    return PIR_OK;
}

static pir_status make_mesh(struct job *job, pir_mesh **ret_mesh) {
    const pir_allocator *a = &job->operands.allocator;
    const uint32_t points = job->operands.space.point_count;
    uint32_t *number = PIR_NEW(a, uint32_t, points), *point = PIR_NEW(a, uint32_t, points);
    pir_status status = PIR_ERR_MEMORY;
    for (uint32_t p = 0; p < points && number; p++)
        number[p] = PIR_SPACE_NONE;
    if (number && point)
        status = fill_mesh(job, number, point, ret_mesh);
    PIR_FREE(a, number, points);
    PIR_FREE(a, point, points);
    return status;
}

static pir_solid_sum_info describe(const struct job *job) {
    return (pir_solid_sum_info){.facets = job->loops.facet_count,
                                .edges = job->outline.run_count / 2,
                                .holes = job->loops.hole_count,
                                .pieces_p = job->pieces[0].count,
                                .pieces_q = job->pieces[1].count,
                                .candidates = job->remains.candidates,
                                .survivors = job->remains.survivor_count};
}

pir_status pir_solid_sum(const pir_solid *p, const pir_solid *q, pir_quat rotation,
                         const pir_solid_sum_options *options, pir_solid_sum_info *ret_info, pir_mesh **ret_mesh) {
    if (!p || !q || !ret_mesh)
        return PIR_ERR_ARGUMENT;
    const pir_solid_sum_options used = options ? *options : pir_solid_sum_options_default();
    pir_allocator allocator;
    const pir_solid_options solid_options = pir_solid_options_or_default(&used.solid, &allocator);
    pir_rotation_integers integers;
    pir_rotation exact = {.integers = &integers};
    pir_status status = pir_rotation_set(&exact, rotation);
    if (status != PIR_OK)
        return status;
    struct job job = {0};
    const pir_solid *const solids[2] = {p, q};
    status = pir_operands_init(&job.operands, solids, &exact, used.difference != 0, &solid_options);
    if (status == PIR_OK)
        status = compute(&job);
    pir_mesh *mesh = NULL;
    if (status == PIR_OK)
        status = make_mesh(&job, &mesh);
    if (status == PIR_OK) {
        if (ret_info) {
            *ret_info = describe(&job);
            ret_info->vertices = mesh->vertex_count;
        }
        *ret_mesh = mesh;
    }
    finish(&job);
    return status;
}
