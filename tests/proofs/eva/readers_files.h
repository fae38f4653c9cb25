/* SPDX-License-Identifier: MIT */
/*
 * Files and models for the readers of polytope/read/readers.h. A file is of any bytes, or begins with given ones; a
 * model is as model.h says, and memory may run out at any time.
 */
#include <stdlib.h>
#include <string.h>

#include "__fc_builtin.h"

#include "base/memory.h"
#include "base/report.h"
#include "polytope/read/readers.h"

/* The most bytes of a file, and as many points, facets and corners. */
#ifndef MOST
#define MOST 200
#endif

pir_status pir_fail(pir_report *report, pir_status status, const char *format, ...) {
    (void)report;
    (void)format;
    return status;
}

void *pir_memory_new(const pir_allocator *allocator, size_t count, size_t size) {
    (void)allocator;
    return malloc(count * size);
}

/* --- a model --- */

static pir_vec3 points[MOST];
static struct pir_model_facet facets[MOST];
static uint32_t corners[MOST];

static struct pir_model empty_model(void) {
    return (struct pir_model){.name = "file", .points = points, .facet = facets, .corner = corners};
}

static pir_status any_failure(void) {
    const pir_status failures[] = {PIR_ERR_MEMORY, PIR_ERR_LIMIT};
    return failures[Frama_C_interval(0, 1)];
}

pir_status pir_model_fail_memory(const struct pir_model *model) {
    (void)model;
    return PIR_ERR_MEMORY;
}

pir_status pir_model_reserve_points(struct pir_model *model, uint32_t count) {
    (void)model;
    (void)count;
    return Frama_C_interval(0, 1) ? PIR_OK : any_failure();
}

pir_status pir_model_add_point(struct pir_model *model, pir_vec3 point) {
    if (model->point_count >= MOST || Frama_C_interval(0, 1))
        return any_failure();
    points[model->point_count++] = point;
    return PIR_OK;
}

pir_status pir_model_begin_facet(struct pir_model *model, size_t line) {
    if (model->facet_count >= MOST || Frama_C_interval(0, 1))
        return any_failure();
    // member by member: Eva mixes up those of a struct that is copied to any place
    facets[model->facet_count].start = model->corner_count;
    facets[model->facet_count++].line = (uint32_t)line;
    return PIR_OK;
}

pir_status pir_model_add_corner(struct pir_model *model, uint32_t point) {
    if (model->corner_count >= MOST || Frama_C_interval(0, 1))
        return any_failure();
    corners[model->corner_count++] = point;
    return PIR_OK;
}

/* --- files --- */

static char bytes[MOST];

/* A file of `length` given bytes and as many `more`, any. None is there after its last. */
static pir_status ask(pir_reader *read, const char *begin, size_t length, size_t more) {
    char *file = bytes + (MOST - length - more);
    memcpy(file, begin, length);
    for (size_t i = length; i < length + more; i++)
        file[i] = (char)Frama_C_char_interval(-128, 127);
    //@ widen_hints global:"all", 59, 60, 61, 199, 200, 201;
    struct pir_model model = empty_model();
    return read(file, length + more, &model);
}
