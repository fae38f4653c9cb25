/* SPDX-License-Identifier: MIT */
/*
 * See imprint.h. Once runs are cut, one is within a group's polygons, in their boundary or outside with all of its
 * length. So it is within when some polygon of the group has a length of it and no run of the group is at its place.
 */
#include "solid/glue/imprint.h"

#include "solid/glue/cut_runs.h"

bool pir_segment_clip(pir_space *space, pir_segment *segment, const uint32_t *half, uint32_t count) {
    for (uint32_t h = 0; h < count; h++) {
        const int a = pir_space_side(space, half[h], segment->a), b = pir_space_side(space, half[h], segment->b);
        if (a >= 0 && b >= 0 && (a | b) != 0)
            return false;
        if (a <= 0 && b <= 0)
            continue;
        *(a > 0 ? &segment->a : &segment->b) =
            pir_space_add_meet(space, segment->plane[0], segment->plane[1], half[h] >> 1);
    }
    return true;
}

static bool same_place(const pir_run *r, const pir_run *s) {
    return r->line == s->line && r->a == s->a && r->b == s->b;
}

/* Whether a run lies within polygons of a group, in whose plane it is. */
static bool is_in(const pir_union_outline *o, const pir_facet_group *group, const pir_run *run) {
    for (uint32_t i = 0; i < group->count; i++) {
        const pir_polygon p = group->polygons->polygon[group->polygon[i]];
        const uint32_t *plane = o->line_plane[run->line];
        pir_segment segment = {{plane[0], plane[1]}, run->a, run->b};
        if (pir_segment_clip(o->space, &segment, group->polygons->wall + p.first, p.count))
            return true;
    }
    return false;
}

static bool run_before(void *context, uint32_t a, uint32_t b) {
    const pir_run *r = &((const pir_union_outline *)context)->run[a],
                  *s = &((const pir_union_outline *)context)->run[b];
    return r->line != s->line ? r->line < s->line : r->a != s->a ? r->a < s->a : r->b < s->b;
}

/* Imprints the runs at one place, order[0 .. count), on the groups. */
static void imprint_place(pir_union_outline *o, const uint32_t *order, uint32_t count, const pir_facet_group *group,
                          uint32_t groups) {
    const pir_run run = o->run[order[0]];
    for (uint32_t g = 0; g < groups && o->space->status == PIR_OK; g++) {
        bool own = group[g].count == 0;
        for (uint32_t i = 0; i < count && !own; i++)
            own = o->run[order[i]].group == g;
        const uint32_t half = own ? 0 : group[g].polygons->polygon[group[g].polygon[0]].half;
        if (own || pir_space_side(o->space, half, run.a) != 0 || pir_space_side(o->space, half, run.b) != 0 ||
            !is_in(o, &group[g], &run))
            continue;
        pir_union_outline_push_side(o, (pir_run){g, half, run.line, run.a, run.b, 1});
        pir_union_outline_push_side(o, (pir_run){g, half, run.line, run.a, run.b, -1});
    }
}

void pir_union_outline_imprint(pir_union_outline *outline, const pir_facet_group *group, uint32_t count) {
    pir_union_outline *o = outline;
    o->side_count = 0;
    if (!pir_union_outline_sort(o, o->run_count, run_before))
        return;
    for (uint32_t i = 0, end; i < o->run_count; i = end) {
        bool loose = false;
        for (end = i; end < o->run_count && same_place(&o->run[o->order[i]], &o->run[o->order[end]]); end++)
            loose = loose || o->run[o->order[end]].group >= o->loose;
        if (loose)
            imprint_place(o, o->order + i, end - i, group, count);
    }
    for (uint32_t i = 0; i < o->run_count; i++)
        pir_union_outline_push_side(o, o->run[i]);
    pir_union_outline_sort_runs(o);
}

uint32_t pir_union_outline_edges(pir_union_outline *outline) {
    pir_union_outline *o = outline;
    uint32_t edges = 0;
    if (!pir_union_outline_sort(o, o->run_count, run_before))
        return 0;
    for (uint32_t i = 0; i < o->run_count; i++)
        edges += i == 0 || !same_place(&o->run[o->order[i]], &o->run[o->order[i - 1]]);
    return edges;
}
