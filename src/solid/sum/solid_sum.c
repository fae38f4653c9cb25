/* SPDX-License-Identifier: MIT */
/*
 * The exact sum of two solids: P = ∪ P_i and Q = ∪ Q_j in convex pieces, P ⊕ Q = ∪ (P_i ⊕ Q_j). Its boundary
 * is what the sums of pairs leave of the candidates (convolution.c, remains.c), glued plane by plane into maximal
 * facets (solid/glue). Instead of uniting volumes, polygons are clipped in their planes (Hachenberger 2009 unites Nef
 * polyhedra). The sum of open solids leaves out more within: two-sided facets, glued likewise, and what tight.c adds.
 */
#include <pirouette/solid.h>

#include "base/sort.h"
#include "polytope/mesh.h"
#include "solid/glue/closed.h"
#include "solid/glue/cut_runs.h"
#include "solid/pieces/join_pieces.h"
#include "solid/sum/coplanar.h"
#include "solid/sum/remains.h"
#include "solid/sum/solid_mesh.h"
#include "solid/sum/tight.h"

struct solid_sum_job {
    pir_operands operands;
    pir_cells cells[2];
    pir_piece_list pieces[2];
    pir_convexes convexes[2];
    pir_remains remains;
    pir_union_outline outline;
    pir_loop_list loops;
    pir_fragments fragments; /* of all groups */
    pir_facet_group *group;
    uint32_t *order, *work;
    uint32_t order_count, group_count, group_room;
    uint32_t first_loose; /* fragments of boundary facets */
    pir_touching points;
    uint32_t edges;
};

pir_solid_sum_options pir_solid_sum_options_default(void) {
    return (pir_solid_sum_options){.solid = pir_solid_options_default(), .difference = false, .open = false};
}

static void finish(struct solid_sum_job *job) {
    pir_space *space = &job->operands.space;
    const pir_allocator *a = &job->operands.allocator;
    PIR_FREE(a, job->order, job->order_count);
    PIR_FREE(a, job->work, job->order_count);
    pir_loop_list_finish(&job->loops);
    pir_union_outline_finish(&job->outline);
    pir_fragments_finish(&job->fragments, space);
    pir_space_shrink(space, job->group, job->group_room, sizeof *job->group);
    pir_touching_finish(&job->points, space);
    pir_remains_finish(&job->remains);
    for (int k = 0; k < 2; k++) {
        pir_convexes_finish(&job->convexes[k]);
        pir_piece_list_finish(&job->pieces[k], space);
        pir_cells_finish(&job->cells[k]);
    }
    pir_operands_finish(&job->operands);
}

/* The boundary first, plane by plane. */
static bool survivor_before(void *context, uint32_t a, uint32_t b) {
    const pir_survivor *s = &((const pir_survivor *)context)[a], *t = &((const pir_survivor *)context)[b];
    return s->two_sided != t->two_sided ? t->two_sided : s->half < t->half;
}

/* Adds the outline of a group: survivors of one plane and side. */
static void outline_group(struct solid_sum_job *job, const uint32_t *order, uint32_t count) {
    pir_space *space = &job->operands.space;
    const pir_survivor *survivor = &job->remains.survivor[order[0]];
    // of a two-sided facet, candidates that face either way tell the same
    if ((survivor->two_sided && (survivor->half & 1)) ||
        !pir_space_grow(space, (void **)&job->group, &job->group_room, job->group_count, sizeof *job->group))
        return;
    const uint32_t first = job->fragments.count;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < job->remains.survivor[order[i]].count; k++)
            pir_fragments_add(&job->fragments, space, job->remains.survivor[order[i]].first + k);
    if (space->status != PIR_OK)
        return;
    if (!survivor->two_sided) {
        job->outline.loose = job->group_count + 1;
        job->first_loose = job->fragments.count;
    }
    job->group[job->group_count] = (pir_facet_group){.count = job->fragments.count - first};
    pir_coplanar_outline(&job->outline, job->group_count++, &job->remains.kept, job->fragments.polygon + first,
                         job->fragments.count - first);
}

/* Adds the interior edges of open solids to the outline before it is cut. */
static void add_tight(struct solid_sum_job *job) {
    const pir_facet_polygons facets = {&job->remains.kept, job->fragments.polygon, job->fragments.count,
                                       job->first_loose};
    pir_tight_add(&job->outline, &facets, &job->remains.left, &job->points);
}

static void imprint(struct solid_sum_job *job) {
    uint32_t first = 0;
    for (uint32_t g = 0; g < job->group_count; g++) {
        job->group[g].polygons = &job->remains.kept;
        job->group[g].polygon = job->fragments.polygon + first;
        first += job->group[g].count;
    }
    pir_union_outline_imprint(&job->outline, job->group, job->group_count);
}

/* The outline of what is left, plane by plane, and the facets that it goes round. */
static void outline_planes(struct solid_sum_job *job) {
    pir_space *space = &job->operands.space;
    pir_remains *remains = &job->remains;
    job->order_count = remains->survivor_count;
    job->order = PIR_NEW(&space->allocator, uint32_t, job->order_count);
    job->work = PIR_NEW(&space->allocator, uint32_t, job->order_count);
    pir_union_outline_init(&job->outline, space);
    if (!job->order || !job->work) {
        space->status = PIR_ERR_MEMORY;
        return;
    }
    for (uint32_t s = 0; s < job->order_count; s++)
        job->order[s] = s;
    pir_sort(job->order, job->order_count, job->work, survivor_before, remains->survivor);
    pir_space_begin_stage(space, "uniting what bounds the sum", job->order_count);
    for (uint32_t i = 0, end; i < job->order_count && space->status == PIR_OK; i = end) {
        space->stage.done = i;
        for (end = i + 1; end < job->order_count && !survivor_before(remains->survivor, job->order[i], job->order[end]);
             end++)
            ;
        outline_group(job, job->order + i, end - i);
    }
    pir_space_begin_stage(space, "cutting edges", 0);
    if (remains->open)
        add_tight(job);
    pir_union_outline_cut(&job->outline);
    job->edges = job->outline.run_count / 2;
    if (remains->open) {
        imprint(job);
        job->edges = pir_union_outline_edges(&job->outline);
    }
    pir_space_begin_stage(space, "tracing facets", 0);
    pir_loops_trace(&job->loops, &job->outline);
    if (space->status == PIR_OK)
        pir_loops_check_closed(&job->loops);
}

static pir_status compute(struct solid_sum_job *job, bool open) {
    pir_space *space = &job->operands.space;
    for (int k = 0; k < 2; k++) {
        pir_space_begin_stage(space, k == 0 ? "dividing P" : "dividing Q", 0);
        pir_cells_init(&job->cells[k], space);
        pir_status status =
            pir_decompose(&job->operands.body[k], PIR_DECOMPOSE_FACETS, &job->cells[k], &job->pieces[k]);
        if (status != PIR_OK)
            return status;
        pir_merge_pieces(&job->cells[k], &job->pieces[k]);
        pir_convexes_make(&job->convexes[k], &job->cells[k], &job->pieces[k]);
    }
    if (space->status == PIR_OK)
        pir_remains_make(&job->remains, job->operands.body, job->convexes, open);
    if (space->status == PIR_OK)
        outline_planes(job);
    return space->status;
}

static pir_solid_sum_info describe(const struct solid_sum_job *job, const pir_mesh *mesh) {
    return (pir_solid_sum_info){.vertices = mesh->vertex_count,
                                .edges = mesh->edge_count,
                                .facets = job->loops.facet_count,
                                .holes = job->loops.hole_count,
                                .two_sided = job->loops.facet_count - job->loops.boundary_count,
                                .segments = mesh->segment_count,
                                .points = mesh->point_count,
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
    struct solid_sum_job job = {0};
    const pir_solid *const solids[2] = {p, q};
    status = pir_operands_init(&job.operands, solids, &exact, used.difference != 0, &solid_options);
    if (status == PIR_OK)
        status = compute(&job, used.open != 0);
    status = pir_space_outcome(&job.operands.space, status, "sum", used.solid.report);
    pir_mesh *mesh = NULL;
    if (status == PIR_OK)
        status = pir_solid_mesh_make(&job.operands, &job.outline, &job.loops, &job.points, &mesh);
    if (status == PIR_OK) {
        mesh->edge_count = job.edges;
        if (ret_info)
            *ret_info = describe(&job, mesh);
        *ret_mesh = mesh;
    }
    finish(&job);
    return status;
}
