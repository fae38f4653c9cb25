/* SPDX-License-Identifier: MIT */
/* Height fields: samples are checked where a cell needs them, then the pyramid is made from the cells up. */
#include "mesh/height_field.h"

#include <string.h>

#include "base/options.h"
#include "base/report.h"
#include "mesh/mesh_tree.h"
#include "mesh/signs/mesh_numbers.h"

#define MOST_SIDE 32768u

/* --- checks --- */

static pir_status check_samples(const pir_height_samples *s, pir_report *report) {
    if (!s->heights || (s->type != PIR_NUMBERS_DOUBLE && s->type != PIR_NUMBERS_FLOAT))
        return pir_fail(report, PIR_ERR_ARGUMENT, "no heights, or heights of no type");
    if (s->columns < 2 || s->rows < 2)
        return pir_fail(report, PIR_ERR_ARGUMENT, "%u columns and %u rows of samples have no cell", s->columns,
                        s->rows);
    if (s->columns > MOST_SIDE || s->rows > MOST_SIDE)
        return pir_fail(report, PIR_ERR_LIMIT, "%u columns and %u rows: more than 32768 of either are too many",
                        s->columns, s->rows);
    if (!isfinite(s->step_x) || !isfinite(s->step_y))
        return pir_fail(report, PIR_ERR_NOT_FINITE, "the steps are %g and %g", s->step_x, s->step_y);
    if (!(s->step_x > 0) || !(s->step_y > 0))
        return pir_fail(report, PIR_ERR_ARGUMENT, "the steps are %g and %g: they must be above 0", s->step_x,
                        s->step_y);
    if (s->columns * s->step_x > PIR_MESH_FARTHEST || s->rows * s->step_y > PIR_MESH_FARTHEST)
        return pir_fail(report, PIR_ERR_LIMIT, "the samples reach farther than 2^60");
    return PIR_OK;
}

static pir_status check_sample(const pir_height_field *field, uint32_t i, uint32_t j, pir_report *report) {
    double height = pir_height_sample(field, i, j).z;
    if (!isfinite(height))
        return pir_fail(report, PIR_ERR_NOT_FINITE, "sample (%u, %u) is %g", i, j, height);
    if (fabs(height) > PIR_MESH_FARTHEST)
        return pir_fail(report, PIR_ERR_LIMIT, "sample (%u, %u), %g, is farther than 2^60", i, j, height);
    return PIR_OK;
}

static pir_status check_cells(const pir_height_field *field, pir_report *report) {
    uint32_t cell = 0;
    for (uint32_t j = 0; j + 1 < field->rows; j++)
        for (uint32_t i = 0; i + 1 < field->columns; i++, cell++)
            for (uint32_t k = 0; k < 4 && !pir_height_is_hole(field, cell); k++) {
                pir_status status = check_sample(field, i + k % 2, j + k / 2, report);
                if (status != PIR_OK)
                    return status;
            }
    return PIR_OK;
}

/* --- the pyramid --- */

static const pir_height_range nothing = {HUGE_VALF, -HUGE_VALF};

static pir_height_range join(pir_height_range a, pir_height_range b) {
    return (pir_height_range){a.low < b.low ? a.low : b.low, a.high > b.high ? a.high : b.high};
}

static pir_height_range range_of_cell(const pir_height_field *field, uint32_t i, uint32_t j) {
    if (pir_height_is_hole(field, j * pir_height_cell_columns(field) + i))
        return nothing;
    pir_height_range range = nothing;
    for (uint32_t k = 0; k < 4; k++) {
        double height = pir_height_sample(field, i + k % 2, j + k / 2).z;
        range = join(range, (pir_height_range){pir_float_under(height), pir_float_over(height)});
    }
    return range;
}

static void plan_levels(pir_height_field *field) {
    uint32_t columns = field->columns - 1, rows = field->rows - 1, level = 0;
    do {
        columns = (columns + 1) / 2;
        rows = (rows + 1) / 2;
        field->level_columns[level] = columns;
        field->level_rows[level] = rows;
        field->level_start[level + 1] = field->level_start[level] + columns * rows;
        level++;
    } while (columns > 1 || rows > 1);
    field->levels = level;
}

/* Fills a level from what is below it: cells, or blocks of the level before. */
static void fill_level(pir_height_field *field, uint32_t level) {
    uint32_t columns = level == 0 ? field->columns - 1 : field->level_columns[level - 1];
    uint32_t rows = level == 0 ? field->rows - 1 : field->level_rows[level - 1];
    const pir_height_range *below = level == 0 ? NULL : field->range + field->level_start[level - 1];
    pir_height_range *to = field->range + field->level_start[level];
    for (uint32_t j = 0; j < rows; j += 2)
        for (uint32_t i = 0; i < columns; i += 2) {
            pir_height_range all = nothing;
            for (uint32_t k = 0; k < 4; k++) {
                uint32_t x = i + k % 2, y = j + k / 2;
                if (x < columns && y < rows)
                    all = join(all, below ? below[(size_t)y * columns + x] : range_of_cell(field, x, y));
            }
            *to++ = all;
        }
}

static void measure(pir_height_field *field) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    uint32_t cell = 0;
    for (uint32_t j = 0; j + 1 < field->rows; j++)
        for (uint32_t i = 0; i + 1 < field->columns; i++, cell++) {
            if (pir_height_is_hole(field, cell))
                continue;
            field->triangles += 2;
            for (uint32_t k = 0; k < 4; k++) {
                double height = pir_height_sample(field, i + k % 2, j + k / 2).z;
                low = fmin(low, height);
                high = fmax(high, height);
            }
        }
    field->low = (pir_vec3){0, 0, low};
    field->high = pir_height_sample(field, field->columns - 1, field->rows - 1);
    field->high.z = high;
}

/* --- making --- */

static size_t sample_count(const pir_height_field *field) {
    return (size_t)field->columns * field->rows;
}

static size_t hole_bytes(const pir_height_field *field) {
    return (pir_height_cells(field) + 7) / 8;
}

static bool copy(pir_height_field *field, const pir_height_samples *s) {
    const pir_allocator *allocator = &field->allocator;
    size_t samples = sample_count(field), cells = pir_height_cells(field);
    if (s->type == PIR_NUMBERS_FLOAT && (field->floats = PIR_NEW(allocator, float, samples)))
        memcpy(field->floats, s->heights, samples * sizeof *field->floats);
    if (s->type == PIR_NUMBERS_DOUBLE && (field->doubles = PIR_NEW(allocator, double, samples)))
        memcpy(field->doubles, s->heights, samples * sizeof *field->doubles);
    if (s->materials && (field->material = PIR_NEW(allocator, uint32_t, cells)))
        memcpy(field->material, s->materials, cells * sizeof *field->material);
    if (s->holes && (field->hole = PIR_ZEROED(allocator, uint8_t, hole_bytes(field))))
        for (size_t cell = 0; cell < cells; cell++)
            field->hole[cell / 8] |= (uint8_t)((s->holes[cell] != 0) << cell % 8);
    return (field->floats || field->doubles) && (!s->materials || field->material) && (!s->holes || field->hole);
}

static pir_status fill(pir_height_field *field, const pir_height_samples *s, pir_report *report) {
    plan_levels(field);
    field->range = PIR_NEW(&field->allocator, pir_height_range, field->level_start[field->levels]);
    if (!field->range || !copy(field, s))
        return pir_fail(report, PIR_ERR_MEMORY, "out of memory");
    pir_status status = check_cells(field, report);
    if (status != PIR_OK)
        return status;
    for (uint32_t level = 0; level < field->levels; level++)
        fill_level(field, level);
    measure(field);
    return field->triangles > 0 ? PIR_OK : pir_fail(report, PIR_ERR_EMPTY, "every cell is a hole");
}

static void free_field(pir_height_field *field) {
    const pir_allocator allocator = field->allocator;
    PIR_FREE(&allocator, field->floats, sample_count(field));
    PIR_FREE(&allocator, field->doubles, sample_count(field));
    PIR_FREE(&allocator, field->material, pir_height_cells(field));
    PIR_FREE(&allocator, field->hole, hole_bytes(field));
    PIR_FREE(&allocator, field->range, field->level_start[field->levels]);
    PIR_FREE(&allocator, field, 1);
}

pir_status pir_height_field_create(const pir_height_samples *samples, const pir_height_options *options,
                                   pir_report *report, pir_height_field **ret_field) {
    if (!samples || !ret_field)
        return pir_fail(report, PIR_ERR_ARGUMENT, "no samples, or no place for the field");
    pir_height_options used = pir_height_options_default();
    pir_status status = pir_options_take("pir_height_options", options, &used, &report);
    if (status == PIR_OK)
        status = check_samples(samples, report);
    if (status != PIR_OK)
        return status;
    const pir_allocator allocator = pir_allocator_or_default(used.allocator);
    pir_height_field *field = PIR_ZEROED(&allocator, pir_height_field, 1);
    if (!field)
        return pir_fail(report, PIR_ERR_MEMORY, "out of memory");
    field->allocator = allocator;
    atomic_init(&field->references, 1);
    field->columns = samples->columns;
    field->rows = samples->rows;
    field->step_x = samples->step_x;
    field->step_y = samples->step_y;
    field->two_sided = used.two_sided;
    status = fill(field, samples, report);
    if (status != PIR_OK)
        free_field(field);
    else
        *ret_field = field;
    return status;
}

pir_height_field *pir_height_field_retain(pir_height_field *field) {
    atomic_fetch_add_explicit(&field->references, 1, memory_order_relaxed);
    return field;
}

void pir_height_field_release(pir_height_field *field) {
    if (field && atomic_fetch_sub_explicit(&field->references, 1, memory_order_acq_rel) == 1)
        free_field(field);
}

void pir_height_field_describe(const pir_height_field *field, pir_height_info *ret_info) {
    size_t tree = field->level_start[field->levels] * sizeof *field->range, samples = sample_count(field);
    *ret_info = (pir_height_info){
        .columns = field->columns,
        .rows = field->rows,
        .triangles = field->triangles,
        .two_sided = field->two_sided,
        .low = field->low,
        .high = field->high,
        .bytes = sizeof *field + tree + samples * (field->floats ? sizeof(float) : sizeof(double)) +
                 (field->material ? pir_height_cells(field) * sizeof(uint32_t) : 0) +
                 (field->hole ? hole_bytes(field) : 0),
        .tree_bytes = tree,
    };
}

pir_status pir_height_field_triangle(const pir_height_field *field, uint32_t triangle,
                                     pir_triangle_corners *ret_corners) {
    if (!field || !ret_corners || triangle / 2 >= pir_height_cells(field) || pir_height_is_hole(field, triangle / 2))
        return PIR_ERR_ARGUMENT;
    pir_tri tri = pir_height_tri(field, triangle);
    *ret_corners =
        (pir_triangle_corners){{tri.p[0], tri.p[1], tri.p[2]}, field->material ? field->material[triangle / 2] : 0};
    return PIR_OK;
}
