/* SPDX-License-Identifier: MIT */
/*
 * The question, the wall with its holes, and for each chart its tree in preorder: a digit for the axis of a halving,
 * then the halves; + where a cell is of the start's side, − of the other, x where it is blocked, by the next block.
 */
#include "plan/opening/opening_write.h"

#include <stdlib.h>

#include "plan/plan_write.h"

static void put_wall(pir_plan_writer *w, const pir_opening_wall *wall) {
    fputs(",\n \"plane\": ", w->file);
    pir_plan_put_rationals(w, (const mpq_t *)wall->plane, 4);
    fputs(",\n \"holes\": [", w->file);
    for (uint32_t i = 0; i < wall->holes; i++) {
        fputs(i == 0 ? "\n  {\"centre\": " : ",\n  {\"centre\": ", w->file);
        pir_plan_put_doubles(w, wall->hole[i].centre, 3);
        fputs(", \"parts\": [", w->file);
        for (uint32_t p = 0; p < wall->hole[i].parts.count; p++) {
            const pir_opening_polygon *part = &wall->hole[i].parts.at[p];
            for (uint32_t c = 0; c < part->count; c++) {
                fputs(c > 0 ? ", " : p == 0 ? "[" : ", [", w->file);
                pir_plan_put_rationals(w, (const mpq_t *)part->at[c], 3);
            }
            fputs("]", w->file);
        }
        fputs("]}", w->file);
    }
    fputs("]", w->file);
}

/* The leaves and halvings below a cell, in preorder: letters, or the blocks of those that have one. */
static void put_cells(const pir_opening_cells *cells, uint32_t root, bool is_text, FILE *file) {
    uint32_t todo[4 * PIR_OPENING_LEVELS], count = 0;
    bool is_next = false;
    todo[count++] = root;
    while (count > 0) {
        const pir_opening_cell *cell = &cells->cell[todo[--count]];
        const pir_opening_block *block = cell->block == PIR_OPENING_NONE ? NULL : &cells->block[cell->block];
        if (cell->child != PIR_OPENING_NONE) {
            todo[count++] = cell->child + 1;
            todo[count++] = cell->child;
        }
        if (is_text) {
            fputc(cell->child != PIR_OPENING_NONE ? '0' + cell->halved
                  : block                         ? 'x'
                  : cell->label == 1              ? '-'
                                                  : '+',
                  file);
            continue;
        }
        for (uint32_t i = 0; block && i < block->count; i++) {
            const pir_opening_end *e = block->end[i];
            fprintf(file, "%s[%u, [%u, %u, %u], [%u, %u, %u]]",
                    i > 0     ? ", "
                    : is_next ? ",\n   ["
                              : "\n   [",
                    block->weight[i], e[0].vertex, e[0].to, e[0].halvings, e[1].vertex, e[1].to, e[1].halvings);
        }
        if (block)
            fputs("]", file);
        is_next = is_next || block;
    }
}

pir_status pir_opening_write(const pir_opening_parts *parts, const pir_opening_wall *wall, uint32_t piece,
                             const pir_opening_cells *cells, FILE *file) {
    const pir_plan_asked *q = &parts->question;
    const uint32_t own = pir_plan_most_corners(q->robot), other = pir_plan_most_corners(q->obstacles);
    pir_plan_writer w = {.file = file, .corner = calloc(own > other ? own : other, sizeof *w.corner)};
    if (!w.corner)
        return PIR_ERR_MEMORY;
    mpq_init(w.x);
    pir_plan_put_asked(&w, "openings", q);
    put_wall(&w, wall);
    fprintf(file, ",\n \"piece\": %u,\n \"point\": ", piece);
    pir_plan_put_rationals(&w, (const mpq_t *)parts->point[piece], 3);
    fprintf(file, ",\n \"shrink\": %d,\n \"room\": \"", PIR_OPENING_SHRINK);
    mpq_out_str(file, 10, parts->room);
    fputs("\",\n \"reach\": ", file);
    mpq_set_d(w.x, parts->robot[piece].reach);
    fputc('"', file);
    mpq_out_str(file, 10, w.x);
    fputs("\",\n \"charts\": [", file);
    for (uint32_t i = 0; i < PIR_OPENING_CHARTS && cells->count > 0; i++) {
        fprintf(file, "%s{\"axis\": %d, \"sign\": %d, \"tree\": \"", i == 0 ? "\n  " : ",\n  ",
                cells->cell[i].chart / 2, cells->cell[i].chart % 2 ? -1 : 1);
        put_cells(cells, i, true, file);
        fputs("\", \"blocked\": [", file);
        put_cells(cells, i, false, file);
        fputs("]}", file);
    }
    fputs("]}\n", file);
    mpq_clear(w.x);
    free(w.corner);
    return ferror(file) ? PIR_ERR_FILE : PIR_OK;
}
