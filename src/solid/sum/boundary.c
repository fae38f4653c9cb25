/* SPDX-License-Identifier: MIT */
/*
 * See boundary.h. P = ∪ P_i and Q = ∪ Q_j in convex pieces, P ⊕ Q = ∪ (P_i ⊕ Q_j). Its boundary is what the
 * sums of pairs leave of the candidates (convolution.c, remains.c), glued plane by plane into maximal facets
 * (solid/glue). Instead of uniting volumes, polygons are clipped in their planes (Hachenberger 2009 unites Nef
 * polyhedra). The sum of open solids leaves out more within: two-sided facets, glued likewise, and what tight.c adds.
 */
#include "solid/sum/boundary.h"

#include "base/sort.h"
#include "solid/glue/closed.h"
#include "solid/glue/cut_runs.h"
#include "solid/sum/coplanar.h"
#include "solid/sum/tight.h"

/* The boundary first, plane by plane. */
static bool survivor_before(void *context, uint32_t a, uint32_t b) {
    const pir_survivor *s = &((const pir_survivor *)context)[a], *t = &((const pir_survivor *)context)[b];
    return s->two_sided != t->two_sided ? t->two_sided : s->half < t->half;
}

/* Adds the outline of a group: survivors of one plane and side. */
static void outline_group(pir_sum_boundary *b, const uint32_t *order, uint32_t count) {
    pir_space *space = b->space;
    const pir_survivor *survivor = &b->remains.survivor[order[0]];
    // of a two-sided facet, candidates that face either way tell the same
    if ((survivor->two_sided && (survivor->half & 1)) ||
        !pir_space_grow(space, (void **)&b->group, &b->group_room, b->group_count, sizeof *b->group))
        return;
    const uint32_t first = b->fragments.count;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < b->remains.survivor[order[i]].count; k++)
            pir_fragments_add(&b->fragments, space, b->remains.survivor[order[i]].first + k);
    if (space->status != PIR_OK)
        return;
    if (!survivor->two_sided) {
        b->outline.loose = b->group_count + 1;
        b->first_loose = b->fragments.count;
    }
    b->group[b->group_count] = (pir_facet_group){.count = b->fragments.count - first};
    pir_coplanar_outline(&b->outline, b->group_count++, &b->remains.kept, b->fragments.polygon + first,
                         b->fragments.count - first);
}

/* Adds the interior edges of open solids to the outline before it is cut. */
static void add_tight(pir_sum_boundary *b) {
    const pir_facet_polygons facets = {&b->remains.kept, b->fragments.polygon, b->fragments.count, b->first_loose};
    pir_tight_add(&b->outline, &facets, &b->remains.left, &b->points);
}

static void imprint(pir_sum_boundary *b) {
    uint32_t first = 0;
    for (uint32_t g = 0; g < b->group_count; g++) {
        b->group[g].polygons = &b->remains.kept;
        b->group[g].polygon = b->fragments.polygon + first;
        first += b->group[g].count;
    }
    pir_union_outline_imprint(&b->outline, b->group, b->group_count);
}

/* The outline of what is left, plane by plane. */
static void outline_planes(pir_sum_boundary *b) {
    pir_space *space = b->space;
    pir_remains *remains = &b->remains;
    b->order_count = remains->survivor_count;
    b->order = PIR_NEW(&space->allocator, uint32_t, b->order_count);
    b->work = PIR_NEW(&space->allocator, uint32_t, b->order_count);
    pir_union_outline_init(&b->outline, space);
    if (!b->order || !b->work) {
        space->status = PIR_ERR_MEMORY;
        return;
    }
    for (uint32_t s = 0; s < b->order_count; s++)
        b->order[s] = s;
    pir_sort(b->order, b->order_count, b->work, survivor_before, remains->survivor);
    pir_space_begin_stage(space, "uniting what bounds the sum", b->order_count);
    for (uint32_t i = 0, end; i < b->order_count && space->status == PIR_OK; i = end) {
        space->stage.done = i;
        for (end = i + 1; end < b->order_count && !survivor_before(remains->survivor, b->order[i], b->order[end]);
             end++)
            ;
        outline_group(b, b->order + i, end - i);
    }
}

/* Cuts the outline, and traces the facets that it goes round. */
static void glue(pir_sum_boundary *b) {
    pir_space_begin_stage(b->space, "cutting edges", 0);
    if (b->remains.open)
        add_tight(b);
    pir_union_outline_cut(&b->outline);
    b->edges = b->outline.run_count / 2;
    if (b->remains.open) {
        imprint(b);
        b->edges = pir_union_outline_edges(&b->outline);
    }
    pir_space_begin_stage(b->space, "tracing facets", 0);
    pir_loops_begin(&b->loops, b->space);
    pir_loops_trace(&b->loops, &b->outline);
    if (b->space->status == PIR_OK)
        pir_loops_check_closed(&b->loops);
}

/* --- vertices --- */

static void name(pir_sum_boundary *b, uint32_t point) {
    if (b->number[point] != PIR_SPACE_NONE ||
        !pir_space_grow(b->space, (void **)&b->vertex, &b->vertex_room, b->vertex_count, sizeof *b->vertex))
        return;
    b->number[point] = b->vertex_count;
    b->vertex[b->vertex_count++] = point;
}

static void name_vertices(pir_sum_boundary *b) {
    if (!pir_space_grow(b->space, (void **)&b->number, &b->number_room, b->space->point_count, sizeof *b->number))
        return;
    for (uint32_t p = 0; p < b->space->point_count; p++)
        b->number[p] = PIR_SPACE_NONE;
    for (uint32_t i = 0; i < b->loops.facet_corner_count; i++)
        name(b, b->loops.facet_corner[i]);
    for (uint32_t r = 0; r < b->outline.run_count; r++)
        if (b->outline.run[r].group == PIR_GROUP_LONE) {
            name(b, b->outline.run[r].a);
            name(b, b->outline.run[r].b);
            b->segments++;
        }
    for (uint32_t i = 0; i < b->points.point_count; i++)
        name(b, b->points.point[i]);
}

void pir_sum_boundary_make(pir_sum_boundary *boundary, const pir_shell_body body[2], pir_convexes convexes[2],
                           bool open) {
    *boundary = (pir_sum_boundary){.space = body[0].space};
    pir_remains_make(&boundary->remains, body, convexes, open);
    boundary->candidates = boundary->remains.candidates;
    boundary->survivors = boundary->remains.survivor_count;
    if (boundary->space->status == PIR_OK)
        outline_planes(boundary);
    if (boundary->space->status == PIR_OK)
        glue(boundary);
    if (boundary->space->status == PIR_OK)
        name_vertices(boundary);
}

void pir_sum_boundary_begin(pir_sum_boundary *boundary, pir_space *space) {
    if (!boundary->is_glued)
        pir_sum_boundary_finish(boundary);
    boundary->space = space;
    boundary->is_glued = true;
    boundary->vertex_count = boundary->edges = 0;
    boundary->candidates = boundary->survivors = 0;
    pir_loops_begin(&boundary->loops, space);
    pir_space_begin_stage(space, "gluing what bounds the sum", 0);
}

void pir_sum_boundary_end(pir_sum_boundary *boundary) {
    if (boundary->space->status == PIR_OK)
        pir_loops_check_closed(&boundary->loops);
    if (boundary->space->status == PIR_OK)
        name_vertices(boundary);
}

void pir_sum_boundary_finish(pir_sum_boundary *boundary) {
    pir_sum_boundary *b = boundary;
    if (!b->space)
        return;
    PIR_FREE(&b->space->allocator, b->order, b->order_count);
    PIR_FREE(&b->space->allocator, b->work, b->order_count);
    pir_space_shrink(b->space, b->number, b->number_room, sizeof *b->number);
    pir_space_shrink(b->space, b->vertex, b->vertex_room, sizeof *b->vertex);
    pir_loop_list_finish(&b->loops);
    pir_union_outline_finish(&b->outline);
    pir_fragments_finish(&b->fragments, b->space);
    pir_space_shrink(b->space, b->group, b->group_room, sizeof *b->group);
    pir_touching_finish(&b->points, b->space);
    pir_remains_finish(&b->remains);
    *b = (pir_sum_boundary){0};
}
