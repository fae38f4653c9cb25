/* SPDX-License-Identifier: MIT */
/*
 * Plans as JSON: docs/plan.md has the format. Numbers are texts of integers and fractions, a/b in lowest terms, so that
 * nothing is rounded on the way.
 *
 * The proof that there is no path is the tree of the division. Leaves say whether they are connected with the place
 * where the path would begin.
 */
#include "plan/plan_write.h"

#include <pirouette/exact.h>

#include "base/memory.h"
#include "plan/path_plan.h"

static void put_text(pir_plan_writer *w, const char *text) {
    fputs(text, w->file);
}

static void put_rational(pir_plan_writer *w, mpq_srcptr x, const char *before) {
    put_text(w, before);
    fputc('"', w->file);
    mpq_out_str(w->file, 10, x);
    fputc('"', w->file);
}

static void put_integer(pir_plan_writer *w, const mpz_t x, bool turned, const char *before) {
    mpz_set(mpq_numref(w->x), x);
    mpz_set_ui(mpq_denref(w->x), 1);
    if (turned)
        mpq_neg(w->x, w->x);
    put_rational(w, w->x, before);
}

void pir_plan_put_doubles(pir_plan_writer *w, const double *x, int count) {
    for (int k = 0; k < count; k++) {
        mpq_set_d(w->x, x[k]);
        put_rational(w, w->x, k == 0 ? "[" : ", ");
    }
    put_text(w, "]");
}

static void put_point(pir_plan_writer *w, uint32_t point) {
    const pir_plan_point *p = &w->space->point[point];
    for (int k = 0; k < 3; k++) {
        mpz_set(mpq_numref(w->x), p->x[k]);
        mpz_set(mpq_denref(w->x), p->w);
        mpq_canonicalize(w->x);
        put_rational(w, w->x, k == 0 ? "[" : ", ");
    }
    put_text(w, "]");
}

static void put_piece(pir_plan_writer *w, const pir_polytope *piece) {
    mpq_t x[3];
    mpq_inits(x[0], x[1], x[2], NULL);
    for (uint32_t v = 0; v < pir_polytope_vertex_count(piece); v++) {
        pir_polytope_vertex_exact(piece, v, x);
        for (int k = 0; k < 3; k++)
            put_rational(w, x[k], k > 0 ? ", " : v == 0 ? "[[" : ", [");
        put_text(w, "]");
    }
    put_text(w, "]");
    mpq_clears(x[0], x[1], x[2], NULL);
}

static void put_facets(pir_plan_writer *w, const pir_polytope *piece) {
    for (uint32_t f = 0; f < pir_polytope_facet_count(piece); f++) {
        const uint32_t size = pir_polytope_facet_size(piece, f);
        pir_polytope_facet(piece, f, w->corner);
        for (uint32_t i = 0; i < size; i++)
            fprintf(w->file, "%s%u", i > 0 ? ", " : f == 0 ? "[[" : "], [", w->corner[i]);
    }
    put_text(w, "]]");
}

void pir_plan_put_pieces(pir_plan_writer *w, const char *name, const pir_plan_pieces *pieces) {
    fprintf(w->file, ",\n \"%s\": [", name);
    for (uint32_t i = 0; i < pieces->count; i++) {
        fprintf(w->file, "%s\n  {\"body\": %u, \"points\": ", i == 0 ? "" : ",", pieces->body[i]);
        put_piece(w, pieces->at[i]);
        put_text(w, ", \"facets\": ");
        put_facets(w, pieces->at[i]);
        put_text(w, "}");
    }
    put_text(w, "]");
}

void pir_plan_put_rationals(pir_plan_writer *w, const mpq_t *x, int count) {
    for (int k = 0; k < count; k++)
        put_rational(w, x[k], k == 0 ? "[" : ", ");
    put_text(w, "]");
}

void pir_plan_put_asked(pir_plan_writer *w, const char *kind, const pir_plan_asked *asked) {
    const struct {
        const char *name;
        const double *x;
    } member[] = {{"low", asked->low}, {"high", asked->high}, {"from", asked->at[0]}, {"to", asked->at[1]}};
    fprintf(w->file, "{\"%s\": 1", kind);
    for (int i = 0; i < 4; i++) {
        fprintf(w->file, ",\n \"%s\": ", member[i].name);
        pir_plan_put_doubles(w, member[i].x, 3);
    }
    for (int i = 0; i < 2; i++) {
        const pir_quat r = asked->rotation[i];
        fprintf(w->file, ",\n \"%s_rotation\": ", member[2 + i].name);
        pir_plan_put_doubles(w, (const double[]){r.x, r.y, r.z, r.w}, 4);
    }
    pir_plan_put_pieces(w, "robot", asked->robot);
    pir_plan_put_pieces(w, "obstacles", asked->obstacles);
}

/* A half-space as a, b, c, d of a·x + b·y + c·z ≤ d. */
static void put_half(pir_plan_writer *w, uint32_t half, const char *before) {
    const pir_plan_plane *p = &w->space->plane[half >> 1];
    for (int k = 0; k < 3; k++)
        put_integer(w, p->n[k], half & 1, k == 0 ? before : ", ");
    put_integer(w, p->d, half & 1, ", ");
}

static void put_node(pir_plan_writer *w, const pir_plan_node *node) {
    if (node->part == PIR_PLAN_FREE) {
        const bool is_start = w->root && w->root[node->by] == w->start;
        put_text(w, !w->root ? "[\"free\"]" : is_start ? "[\"start\"]" : "[\"other\"]");
    } else if (node->part == PIR_PLAN_SPLIT) {
        put_half(w, node->by, "[\"split\", [");
        fprintf(w->file, "], %u, %u]", node->child[0], node->child[1]);
    } else {
        const pir_plan_sum *sum = &w->sums->sum[node->by];
        fprintf(w->file, "[\"blocked\", %u, %u", sum->robot, sum->obstacle);
        for (uint32_t i = 0; i < node->child[1]; i++) {
            const uint32_t child = node->child[0] + i;
            put_half(w, w->sums->half[sum->half + w->tree->node[child].face], ", [[");
            fprintf(w->file, "], %u]", child);
        }
        put_text(w, "]");
    }
}

static void put_path(pir_plan_writer *w, const pir_path_plan *plan) {
    put_text(w, ",\n \"path\": [");
    for (uint32_t i = 0; i < plan->way.count; i++) {
        const double *x = plan->space.point[plan->way.point[i]].at;
        fprintf(w->file, "%s\n  [%.17g, %.17g, %.17g]", i == 0 ? "" : ",", x[0], x[1], x[2]);
    }
    put_text(w, "],\n \"path_exact\": [");
    for (uint32_t i = 0; i < plan->way.count; i++) {
        put_text(w, i == 0 ? "\n  " : ",\n  ");
        put_point(w, plan->way.point[i]);
    }
    put_text(w, "]");
}

void pir_plan_put_tree(pir_plan_writer *w) {
    put_text(w, ",\n \"tree\": [");
    for (uint32_t i = 0; i < w->tree->node_count; i++) {
        put_text(w, i == 0 ? "\n  " : ",\n  ");
        put_node(w, &w->tree->node[i]);
    }
    put_text(w, "]");
}

static void put_question(pir_plan_writer *w, const pir_path_plan *plan) {
    const double rotation[4] = {plan->rotation.x, plan->rotation.y, plan->rotation.z, plan->rotation.w};
    fprintf(w->file,
            "{\"plan\": 1,\n \"bodies\": \"%s\",\n \"bounded\": %s,\n \"low\": ", plan->tree.open ? "open" : "closed",
            plan->bounded ? "true" : "false");
    pir_plan_put_doubles(w, plan->tree.low, 3);
    put_text(w, ",\n \"high\": ");
    pir_plan_put_doubles(w, plan->tree.high, 3);
    put_text(w, ",\n \"rotation\": ");
    pir_plan_put_doubles(w, rotation, 4);
    put_text(w, ",\n \"from\": ");
    put_point(w, plan->end[0]);
    put_text(w, ",\n \"to\": ");
    put_point(w, plan->end[1]);
    pir_plan_put_pieces(w, "robot", &plan->robot);
    pir_plan_put_pieces(w, "obstacles", &plan->obstacles);
    fprintf(w->file, ",\n \"answer\": \"%s\"", plan->info.answer == PIR_PLAN_PATH ? "path" : "no path");
}

uint32_t pir_plan_most_corners(const pir_plan_pieces *pieces) {
    uint32_t most = 1;
    for (uint32_t i = 0; i < pieces->count; i++)
        for (uint32_t f = 0; f < pir_polytope_facet_count(pieces->at[i]); f++) {
            const uint32_t size = pir_polytope_facet_size(pieces->at[i], f);
            most = size > most ? size : most;
        }
    return most;
}

pir_status pir_path_plan_write(const pir_path_plan *plan, FILE *file) {
    if (!plan || !file)
        return PIR_ERR_ARGUMENT;
    const uint32_t own = pir_plan_most_corners(&plan->robot), other = pir_plan_most_corners(&plan->obstacles);
    const uint32_t most = own > other ? own : other;
    const uint32_t *root = plan->joints.root;
    pir_plan_writer w = {.file = file, .space = &plan->space, .sums = &plan->sums, .tree = &plan->tree};
    w.root = root;
    w.start = root[plan->cell[0]];
    w.corner = PIR_NEW(&plan->allocator, uint32_t, most);
    if (!w.corner)
        return PIR_ERR_MEMORY;
    mpq_init(w.x);
    put_question(&w, plan);
    if (plan->info.answer == PIR_PLAN_PATH)
        put_path(&w, plan);
    else
        pir_plan_put_tree(&w);
    put_text(&w, "}\n");
    mpq_clear(w.x);
    PIR_FREE(&plan->allocator, w.corner, most);
    return ferror(file) ? PIR_ERR_FILE : PIR_OK;
}
