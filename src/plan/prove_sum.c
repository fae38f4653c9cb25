/* SPDX-License-Identifier: MIT */
/*
 * The certificate of a sum of solids: their convex pieces, a box that is divided by planes of the sums of pairs until
 * each part is blocked by one sum or free of all, and the mesh, which is to bound the blocked parts. docs/proofs.md has
 * the format and the argument, check/solid_sum.py looks at it.
 *
 * Pieces of P are the robot's and those of Q the obstacles'. Nothing of the sum is used but its solids, its rotation
 * and its mesh: pieces and parts are made anew.
 */
#include <pirouette/certificate.h>

#include <stdio.h>
#include <stdlib.h>

#include <pirouette/exact.h>

#include "base/report.h"
#include "certificate/certificate_text.h"
#include "plan/divide.h"
#include "plan/plan_write.h"
#include "solid/kept/solid_sum.h"

/* The most parts of a certificate: some hundred megabytes. */
#define PARTS_MOST 2000000

struct sum_proof {
    pir_solid_sum *sum;
    pir_plan_space space;
    pir_plan_pieces piece[2]; /* of P, of Q */
    pir_plan_sums sums;
    pir_plan_tree tree;
    pir_mesh *mesh;
    pir_proof_text text;
};

/* --- what is proven --- */

static pir_status add_pair(struct sum_proof *job, uint32_t k, uint32_t l) {
    pir_sum_options options = pir_sum_options_default();
    pir_sum *made = NULL;
    pir_mesh *mesh = NULL;
    options.allocator = &job->space.allocator;
    options.difference = job->sum->options.difference;
    pir_status status = pir_sum_create(job->piece[0].at[k], job->piece[1].at[l], job->sum->rotation, &options, &made);
    if (status == PIR_OK)
        status = pir_sum_mesh(made, PIR_EXACT, &mesh);
    if (status == PIR_OK)
        status = pir_plan_sums_add_mesh(&job->space, mesh, k, l, &job->sums);
    pir_mesh_destroy(mesh);
    pir_sum_destroy(made);
    return status;
}

static pir_status add_pairs(struct sum_proof *job) {
    pir_status status = PIR_OK;
    for (uint32_t k = 0; k < job->piece[0].count; k++)
        for (uint32_t l = 0; l < job->piece[1].count && status == PIR_OK; l++)
            status = add_pair(job, k, l);
    return status;
}

/* A box that has all sums within it, an eighth of the widest side away. */
static pir_status make_box(struct sum_proof *job, pir_report *report) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, widest = 0;
    for (uint32_t i = 0; i < job->sums.count; i++)
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], job->sums.sum[i].low[k]);
            high[k] = fmax(high[k], job->sums.sum[i].high[k]);
        }
    for (int k = 0; k < 3; k++)
        widest = fmax(widest, high[k] - low[k]);
    for (int k = 0; k < 3; k++) {
        double *box[2] = {&job->tree.low[k], &job->tree.high[k]};
        *box[0] = low[k] - widest / 8;
        *box[1] = high[k] + widest / 8;
        if (!isfinite(*box[0]) || !isfinite(*box[1]) || *box[0] >= low[k] || *box[1] <= high[k])
            return pir_fail(report, PIR_ERR_LIMIT, "certificate: coordinates are too large for a box around all");
    }
    return PIR_OK;
}

static pir_status divide_box(struct sum_proof *job) {
    pir_plan_cutter cutter = {.space = &job->space};
    pir_plan_divide(&cutter, &job->sums, PARTS_MOST, &job->tree);
    pir_plan_cutter_finish(&cutter);
    return job->space.status;
}

/* --- the text --- */

static void put_rationals(pir_proof_text *text, mpq_t *x, int count) {
    for (int k = 0; k < count; k++) {
        pir_proof_text_put(text, k == 0 ? "[" : ", ");
        pir_proof_text_put_ratio(text, mpq_numref(x[k]), mpq_denref(x[k]));
    }
    pir_proof_text_put(text, "]");
}

static void put_doubles(pir_proof_text *text, const char *before, const double *x, int count) {
    mpq_t exact[4];
    mpq_inits(exact[0], exact[1], exact[2], exact[3], NULL);
    for (int k = 0; k < count; k++)
        mpq_set_d(exact[k], x[k]);
    pir_proof_text_put(text, before);
    put_rationals(text, exact, count);
    mpq_clears(exact[0], exact[1], exact[2], exact[3], NULL);
}

/* One corner of a facet, the first of a list of facets or another. */
static void put_corner(pir_proof_text *text, uint32_t facet, uint32_t place, uint32_t corner) {
    pir_proof_text_put(text, place > 0 ? ", " : facet == 0 ? "[[" : "],\n[");
    pir_proof_text_put_count(text, corner);
}

/* The tree as plans write it, by way of malloc's memory. */
static void put_tree(struct sum_proof *job) {
    char *tree = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&tree, &size);
    if (file) {
        pir_plan_writer w = {.file = file, .space = &job->space, .sums = &job->sums, .tree = &job->tree};
        mpq_init(w.x);
        pir_plan_put_tree(&w);
        mpq_clear(w.x);
    }
    if (file && (ferror(file) | fclose(file)) == 0)
        pir_proof_text_put(&job->text, tree);
    else
        job->text.failed = true;
    free(tree);
}

static void put_mesh(struct sum_proof *job) {
    pir_proof_text *text = &job->text;
    const uint32_t counts[3] = {pir_mesh_vertex_count(job->mesh), pir_mesh_edge_count(job->mesh),
                                pir_mesh_facet_count(job->mesh)};
    const char *const keys[3] = {"vertex_count", "edge_count", "facet_count"};
    mpq_t x[3];
    mpq_inits(x[0], x[1], x[2], NULL);
    for (int k = 0; k < 3; k++)
        pir_proof_text_count(text, keys[k], counts[k]);
    for (uint32_t v = 0; v < counts[0]; v++) {
        pir_mesh_vertex_exact(job->mesh, v, x);
        pir_proof_text_put(text, v == 0 ? ",\n\"vertices\": [\n" : ",\n");
        put_rationals(text, x, 3);
    }
    pir_proof_text_put(text, "\n],\n\"facets\": ");
    for (uint32_t f = 0; f < counts[2]; f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(job->mesh, f, &count);
        for (uint32_t i = 0; i < count; i++)
            put_corner(text, f, i, corner[i]);
    }
    pir_proof_text_put(text, "]]");
    mpq_clears(x[0], x[1], x[2], NULL);
}

static pir_status put_all(struct sum_proof *job) {
    const pir_quat q = job->sum->rotation;
    pir_proof_text_put(&job->text, "{\n\"pirouette_solid_sum\": 1,\n\"claim\": \"");
    pir_proof_text_put(&job->text, job->sum->options.difference ? "difference" : "sum");
    put_doubles(&job->text, "\",\n\"quat\": ", (const double[4]){q.x, q.y, q.z, q.w}, 4);
    for (int k = 0; k < 2; k++)
        pir_proof_text_pieces(&job->text, k == 0 ? "p" : "q", (const pir_polytope *const *)job->piece[k].at,
                              job->piece[k].count);
    put_doubles(&job->text, ",\n\"low\": ", job->tree.low, 3);
    put_doubles(&job->text, ",\n\"high\": ", job->tree.high, 3);
    put_tree(job);
    put_mesh(job);
    return job->space.status;
}

/* --- the call --- */

static pir_status make_proof(struct sum_proof *job, pir_report *report) {
    pir_status status = pir_solid_sum_mesh(job->sum, PIR_EXACT, &job->mesh);
    for (int k = 0; k < 2 && status == PIR_OK; k++) {
        const pir_solid *solid = job->sum->solid[k];
        status = pir_plan_pieces_add(&job->space, &solid, 1, k == 0 ? "P" : "Q", report, &job->piece[k]);
    }
    if (status == PIR_OK)
        status = add_pairs(job);
    if (status == PIR_OK)
        status = make_box(job, report);
    if (status == PIR_OK)
        status = divide_box(job);
    return status == PIR_OK ? put_all(job) : status;
}

/* Fills the report where what was called has not. The status that the caller is told. */
static pir_status tell(const struct sum_proof *job, pir_status status, pir_report *report) {
    if (status == PIR_PLAN_ERR_PARTS)
        return pir_fail(report, PIR_ERR_LIMIT, "certificate: more than %d parts are needed", PARTS_MOST);
    if (status == PIR_ERR_LIMIT && job->space.status == PIR_ERR_LIMIT)
        return pir_fail(report, status, "certificate: more than %zu bytes are needed, with %u parts made",
                        job->sum->options.memory, job->tree.node_count);
    if (status == PIR_ERR_MEMORY)
        return pir_fail(report, status, "certificate: out of memory");
    return status;
}

pir_status pir_solid_sum_certificate(pir_solid_sum *sum, pir_certificate **ret_certificate) {
    if (!sum || !ret_certificate)
        return PIR_ERR_ARGUMENT;
    pir_report *report = sum->options.report;
    if (sum->options.open)
        return pir_fail(report, PIR_ERR_ARGUMENT, "certificate: there is none of sums of open solids");
    if (sum->scale[0] != 1 || sum->scale[1] != 1)
        return pir_fail(report, PIR_ERR_ARGUMENT, "certificate: there is none of solids that are scaled");
    struct sum_proof job = {.sum = sum, .text = {sum->allocator, {0}, false}};
    pir_plan_space_init(&job.space, &sum->allocator, sum->options.memory);
    pir_status status = pir_proof_text_end(&job.text, make_proof(&job, report), ret_certificate);
    status = status == PIR_OK ? PIR_OK : tell(&job, status, report);
    pir_mesh_destroy(job.mesh);
    pir_plan_tree_finish(&job.space, &job.tree);
    pir_plan_sums_finish(&job.space, &job.sums);
    for (int k = 0; k < 2; k++)
        pir_plan_pieces_finish(&job.space, &job.piece[k]);
    pir_plan_space_finish(&job.space);
    return status;
}
