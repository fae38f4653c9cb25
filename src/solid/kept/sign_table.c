/* SPDX-License-Identifier: MIT */
/* See sign_table.h. */
#include "solid/kept/sign_table.h"

#include <math.h>

#include "solid/space/rest.h"

/* The error of a product by doubles: that of pir_space_dot. */
#define DOT_ERROR 0x1p-45

/* --- lines --- */

static const pir_rest_item *item_of(const pir_space *space, uint32_t direction) {
    return &space->rest->directions.item[space->direction[direction].rest];
}

/* Numbers the line of a direction, and says whether it is reversed. */
static void number_line(pir_space *space, uint32_t *of, uint32_t *line, uint32_t *count, uint32_t direction) {
    if (space->direction[direction].rest == PIR_SPACE_NONE) {
        pir_space_fault(space);
        return;
    }
    const pir_rest_item *own = item_of(space, direction);
    const pir_rest_item *first = &space->rest->directions.item[own->same];
    if (of[first->of] == PIR_SPACE_NONE) {
        of[first->of] = 2 * *count;
        line[(*count)++] = first->of;
    }
    const double same = own->x[0] * first->x[0] + own->x[1] * first->x[1] + own->x[2] * first->x[2];
    of[direction] = (of[first->of] & ~1u) | (same < 0);
}

static uint32_t *new_numbers(pir_space *space, uint32_t count) {
    uint32_t *made = PIR_NEW(&space->allocator, uint32_t, count);
    for (uint32_t i = 0; i < count && made; i++)
        made[i] = PIR_SPACE_NONE;
    if (!made)
        space->status = PIR_ERR_MEMORY;
    return made;
}

static void number_lines(pir_sign_table *table, int k) {
    pir_space *space = table->space;
    pir_sign_half *half = &table->half[k];
    const pir_shell_body *edges = &table->body[k], *facets = &table->body[1 - k];
    const pir_convexes *of_edges = &table->convexes[k], *of_facets = &table->convexes[1 - k];
    const uint32_t room = space->rest->direction_mark;
    half->row_of = new_numbers(space, room);
    half->column_of = new_numbers(space, room);
    half->row_item = new_numbers(space, room);
    half->column_item = new_numbers(space, room);
    if (space->status != PIR_OK)
        return;
    for (uint32_t e = 0; e < edges->edge_count; e++)
        number_line(space, half->row_of, half->row_item, &half->rows, edges->edge[e].direction);
    const uint32_t outer_rows = half->rows;
    for (uint32_t e = 0; e < of_edges->edge_count; e++)
        number_line(space, half->row_of, half->row_item, &half->rows, of_edges->edge[e].direction);
    for (uint32_t f = 0; f < facets->source.facet_count; f++)
        number_line(space, half->column_of, half->column_item, &half->columns,
                    space->plane[facets->plane[f]].direction[0]);
    const uint32_t outer_columns = half->columns;
    for (uint32_t f = 0; f < of_facets->face_count; f++)
        number_line(space, half->column_of, half->column_item, &half->columns, of_facets->face[f].normal);
    half->row_is_outer = PIR_ZEROED(&space->allocator, bool, half->rows);
    half->column_is_outer = PIR_ZEROED(&space->allocator, bool, half->columns);
    half->column = PIR_NEW(&space->allocator, double, 3 * (size_t)half->columns);
    half->until = PIR_NEW(&space->allocator, double, half->rows);
    half->sign = PIR_NEW(&space->allocator, int8_t, (size_t)half->rows * half->columns);
    if (!half->row_is_outer || !half->column_is_outer || !half->column || !half->until || !half->sign) {
        space->status = PIR_ERR_MEMORY;
        return;
    }
    for (uint32_t r = 0; r < outer_rows; r++)
        half->row_is_outer[r] = true;
    for (uint32_t c = 0; c < outer_columns; c++)
        half->column_is_outer[c] = true;
}

/* --- the pieces along each line --- */

/* Where the pieces of a body name a line: with their edges, or with their faces. */
static uint32_t line_at(const pir_sign_half *half, const pir_convexes *convexes, bool of_edges, uint32_t i) {
    return of_edges ? half->row_of[convexes->edge[i].direction] >> 1 : half->column_of[convexes->face[i].normal] >> 1;
}

/* Lists, for each line, the pieces along it, each once; `seen` has room for all lines. */
static void list_pieces(pir_space *space, pir_list_of_lists *lists, const pir_sign_half *half,
                        const pir_convexes *convexes, bool of_edges, uint32_t *seen) {
    lists->count = of_edges ? half->rows : half->columns;
    lists->entry_count = of_edges ? convexes->edge_count : convexes->face_count;
    lists->start = PIR_ZEROED(&space->allocator, uint32_t, (size_t)lists->count + 2);
    lists->entry = PIR_NEW(&space->allocator, uint32_t, lists->entry_count);
    if (!lists->start || !lists->entry) {
        space->status = PIR_ERR_MEMORY;
        return;
    }
    for (int fill = 0; fill < 2; fill++) {
        for (uint32_t l = 0; l < lists->count; l++)
            seen[l] = PIR_SPACE_NONE;
        for (uint32_t c = 0; c < convexes->count; c++) {
            const pir_convex *piece = &convexes->convex[c];
            const uint32_t first = of_edges ? piece->edge : piece->face;
            const uint32_t end = first + (of_edges ? piece->edge_count : piece->face_count);
            for (uint32_t i = first; i < end; i++) {
                const uint32_t line = line_at(half, convexes, of_edges, i);
                if (seen[line] == c)
                    continue;
                seen[line] = c;
                if (fill)
                    lists->entry[lists->start[line + 1]++] = c;
                else
                    lists->start[line + 2]++;
            }
        }
        for (uint32_t l = 0; l < lists->count && !fill; l++)
            lists->start[l + 2] += lists->start[l + 1];
    }
}

/* Where the edges of a body and of its pieces are in the table. */
static void list_table_edges(pir_sign_table *table, int k) {
    pir_space *space = table->space;
    const pir_shell_body *body = &table->body[k];
    const pir_convexes *convexes = &table->convexes[k];
    const uint32_t *row = table->half[k].row_of, *column = table->half[1 - k].column_of;
    table->edge[k] = PIR_NEW(&space->allocator, pir_table_edge, body->edge_count);
    table->piece_edge[k] = PIR_NEW(&space->allocator, pir_table_edge, convexes->edge_count);
    if (!table->edge[k] || !table->piece_edge[k]) {
        space->status = PIR_ERR_MEMORY;
        return;
    }
    for (uint32_t e = 0; e < body->edge_count; e++) {
        const pir_shell_body_edge *edge = &body->edge[e];
        table->edge[k][e] =
            (pir_table_edge){row[edge->direction], column[space->plane[body->plane[edge->left]].direction[0]],
                             column[space->plane[body->plane[edge->right]].direction[0]]};
    }
    for (uint32_t e = 0; e < convexes->edge_count; e++) {
        const pir_convex_edge *edge = &convexes->edge[e];
        table->piece_edge[k][e] =
            (pir_table_edge){row[edge->direction], column[edge->normal[0]], column[edge->normal[1]]};
    }
}

void pir_sign_table_init(pir_sign_table *table, const pir_shell_body body[2], const pir_convexes convexes[2]) {
    pir_space *space = body[0].space;
    *table = (pir_sign_table){.space = space, .body = body, .convexes = convexes};
    const uint32_t room = space->rest->direction_mark;
    uint32_t *seen = new_numbers(space, room);
    for (int k = 0; k < 2 && space->status == PIR_OK; k++) {
        pir_sign_half *half = &table->half[k];
        number_lines(table, k);
        if (space->status != PIR_OK)
            break;
        list_pieces(space, &half->row_pieces, half, &convexes[k], true, seen);
        list_pieces(space, &half->column_pieces, half, &convexes[1 - k], false, seen);
    }
    for (int k = 0; k < 2 && space->status == PIR_OK; k++)
        list_table_edges(table, k);
    PIR_FREE(&space->allocator, seen, room);
}

static void finish_lists(const pir_allocator *a, pir_list_of_lists *lists) {
    PIR_FREE(a, lists->start, (size_t)lists->count + 2);
    PIR_FREE(a, lists->entry, lists->entry_count);
}

void pir_sign_table_finish(pir_sign_table *table) {
    if (!table->space)
        return;
    const pir_allocator *a = &table->space->allocator;
    const uint32_t room = table->space->rest->direction_mark;
    for (int k = 0; k < 2; k++) {
        pir_sign_half *half = &table->half[k];
        PIR_FREE(a, half->row_item, room);
        PIR_FREE(a, half->column_item, room);
        PIR_FREE(a, half->row_of, room);
        PIR_FREE(a, half->column_of, room);
        PIR_FREE(a, half->column, 3 * (size_t)half->columns);
        PIR_FREE(a, half->sign, (size_t)half->rows * half->columns);
        PIR_FREE(a, half->until, half->rows);
        PIR_FREE(a, half->row_is_outer, half->rows);
        PIR_FREE(a, half->column_is_outer, half->columns);
        PIR_FREE(a, table->edge[k], table->body[k].edge_count);
        PIR_FREE(a, table->piece_edge[k], table->convexes[k].edge_count);
        finish_lists(a, &half->row_pieces);
        finish_lists(a, &half->column_pieces);
    }
    pir_space_shrink(table->space, table->change, table->change_room, sizeof *table->change);
    *table = (pir_sign_table){0};
}

/* --- signs --- */

static void turn_columns(const pir_space *space, pir_sign_half *half) {
    for (uint32_t c = 0; c < half->columns; c++)
        for (uint32_t k = 0; k < 3; k++)
            half->column[k * half->columns + c] = space->direction[half->column_item[c]].n[k];
}

/* Makes a row; what differs is listed where `changes` is wanted. False where a sign may be 0. */
static bool make_row(pir_sign_table *table, uint32_t k, uint32_t row, double turn, bool changes) {
    pir_sign_half *half = &table->half[k];
    const uint32_t columns = half->columns;
    const double *n = table->space->direction[half->row_item[row]].n;
    const double *x = half->column, *y = x + columns, *z = y + columns;
    int8_t *sign = half->sign + (size_t)row * columns;
    double least = 1;
    for (uint32_t c = 0; c < columns; c++) {
        const double dot = n[0] * x[c] + n[1] * y[c] + n[2] * z[c];
        const int8_t made = dot > 0 ? 1 : -1;
        least = fabs(dot) < least ? fabs(dot) : least;
        if (changes && made != sign[c] &&
            pir_space_grow(table->space, (void **)&table->change, &table->change_room, table->change_count,
                           sizeof *table->change))
            table->change[table->change_count++] = (pir_sign_change){k, row, c};
        sign[c] = made;
    }
    table->looked += columns;
    half->until[row] = turn + (least - DOT_ERROR) * (1 - 0x1p-40) - PIR_TURN_SLACK;
    return least > DOT_ERROR;
}

static bool make_rows(pir_sign_table *table, double turn, bool changes) {
    table->change_count = 0;
    table->looked = 0;
    for (uint32_t k = 0; k < 2; k++) {
        pir_sign_half *half = &table->half[k];
        turn_columns(table->space, half);
        for (uint32_t r = 0; r < half->rows; r++)
            if ((!changes || half->until[r] < turn) && !make_row(table, k, r, turn, changes))
                return false;
    }
    return table->space->status == PIR_OK;
}

bool pir_sign_table_make(pir_sign_table *table, double turn) {
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < (size_t)table->half[k].rows * table->half[k].columns; i++)
            table->half[k].sign[i] = 0;
    return make_rows(table, turn, false);
}

bool pir_sign_table_update(pir_sign_table *table, double turn) {
    return make_rows(table, turn, true);
}
