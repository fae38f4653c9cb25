/* SPDX-License-Identifier: MIT */
/*
 * The question, and for each box of rotations its inner sums and the tree of its division. Divisions are made again,
 * and are the same.
 */
#include "plan/rigid/rigid_write.h"

#include <stdlib.h>

#include "plan/plan_write.h"
#include "plan/rigid/inner_division.h"

static void put_question(pir_plan_writer *w, const pir_rigid_question *q) {
    const struct {
        const char *name;
        const double *x;
    } member[] = {{"{\"motions\": 1,\n \"low\": ", q->low},
                  {",\n \"high\": ", q->high},
                  {",\n \"from\": ", q->at[0]},
                  {",\n \"to\": ", q->at[1]}};
    for (int i = 0; i < 4; i++) {
        fputs(member[i].name, w->file);
        pir_plan_put_doubles(w, member[i].x, 3);
    }
    for (int i = 0; i < 2; i++) {
        const pir_quat r = q->rotation[i];
        const double x[4] = {r.x, r.y, r.z, r.w};
        fputs(i == 0 ? ",\n \"from_rotation\": " : ",\n \"to_rotation\": ", w->file);
        pir_plan_put_doubles(w, x, 4);
    }
    pir_plan_put_pieces(w, "robot", q->robot);
    pir_plan_put_pieces(w, "obstacles", q->wide);
}

/* One box: the root of each of its cells is that of the node that its part is. */
static pir_status put_box(pir_rigid_job *job, const pir_rigid_leaf *leaf, pir_plan_writer *w) {
    const pir_plan_turns corners = pir_rotation_box_corners(leaf->box);
    pir_box_division division;
    pir_plan_pieces sums;
    pir_status status = pir_inner_division_make(job->question, &corners, &sums, &division);
    uint32_t *root = calloc(leaf->inner.cells > 0 ? leaf->inner.cells : 1, sizeof *root);
    const uint32_t most = pir_plan_most_corners(&sums);
    uint32_t *corner = calloc(most, sizeof *corner), *kept = w->corner;
    status = status == PIR_OK && (!root || !corner) ? PIR_ERR_MEMORY : status;
    if (status == PIR_OK) {
        for (uint32_t i = 0; i < leaf->inner.cells; i++)
            root[i] = pir_rigid_root(job->root, leaf->node + leaf->inner.cell[i].part);
        int32_t low[4], high[4];
        pir_rotation_box_bounds(leaf->box, low, high);
        fputs("{\"box\": [", w->file);
        for (int c = 0; c < 4; c++)
            fprintf(w->file, "%s[%ld, %ld]", c == 0 ? "" : ", ", (long)low[c], (long)high[c]);
        fputs("]", w->file);
        w->space = &division.space;
        w->sums = &division.sums;
        w->tree = &division.tree;
        w->root = root;
        w->corner = corner;
        pir_plan_put_pieces(w, "sums", &sums);
        pir_plan_put_tree(w);
        fputs("}", w->file);
    }
    w->corner = kept;
    free(corner);
    free(root);
    pir_box_division_finish(&division);
    pir_plan_pieces_over_free(&sums);
    return status;
}

pir_status pir_rigid_write(pir_rigid_job *job, uint32_t start, FILE *file) {
    const pir_rigid_question *q = job->question;
    const uint32_t own = pir_plan_most_corners(q->robot), other = pir_plan_most_corners(q->wide);
    pir_plan_writer w = {.file = file, .start = start, .corner = calloc(own > other ? own : other, sizeof *w.corner)};
    pir_status status = w.corner ? PIR_OK : PIR_ERR_MEMORY;
    bool is_first = true;
    mpq_init(w.x);
    if (status == PIR_OK)
        put_question(&w, q);
    fputs(",\n \"boxes\": [", file);
    for (uint32_t i = 0; i < job->leaves && status == PIR_OK; i++) {
        const pir_rigid_leaf *leaf = &job->leaf[i];
        if (leaf->is_divided)
            continue;
        fputs(is_first ? "\n " : ",\n ", file);
        is_first = false;
        status = put_box(job, leaf, &w);
    }
    fputs("]}\n", file);
    mpq_clear(w.x);
    free(w.corner);
    return status == PIR_OK && ferror(file) ? PIR_ERR_FILE : status;
}
