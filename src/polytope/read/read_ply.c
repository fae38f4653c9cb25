/* SPDX-License-Identifier: MIT */
/*
 * Reading PLY, as text and in both orders of bytes: the properties x, y, z of each vertex, and the list vertex_indices
 * (or vertex_index) of each face. What else the header names is passed over, and must be there.
 *
 * In text each element stands on a line of its own. A number in text is the nearest double, in binary the float, double
 * or integer itself.
 */
#include "polytope/read/readers.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "base/report.h"
#include "polytope/read/bytes.h"
#include "polytope/read/ply_header.h"

struct ply {
    struct pir_text text; /* in binary, only text.at moves */
    struct ply_header header;
    struct pir_model *model;
    const struct ply_element *element; /* being read */
    uint64_t index;                    /* the one of them */
    bool line_open;                    /* in text: a token of its line is read */
};

/* Reports "name:line: ..." in text, "name: vertex 7, at byte 120: ..." in binary. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
static pir_status
fail_here(const struct ply *ply, pir_status status, const char *format, ...) {
    char what[160];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    if (ply->header.format == PLY_ASCII)
        return pir_text_fail(&ply->text, status, "%s %llu: %s", ply->element->name, (unsigned long long)ply->index,
                             what);
    return pir_fail(ply->text.report, status, "%s: %s %llu, at byte %zu: %s", ply->text.name, ply->element->name,
                    (unsigned long long)ply->index, ply->text.at, what);
}

/* --- one value --- */

/* The next token of the element's line, or `size` bytes; the value is at ret_bytes in binary. */
static pir_status next_value(struct ply *ply, enum ply_type type, const char **ret_bytes) {
    struct pir_text *text = &ply->text;
    if (ply->header.format == PLY_ASCII) {
        bool found = pir_text_next(text, ply->line_open);
        if (!found && ply->line_open)
            return fail_here(ply, PIR_ERR_FORMAT, "the line ends before its last value");
        ply->line_open = true;
        return found ? PIR_OK : fail_here(ply, PIR_ERR_FORMAT, "the file ends before it");
    }
    size_t size = pir_ply_type_size(type);
    if (text->size - text->at < size)
        return fail_here(ply, PIR_ERR_FORMAT, "the file ends in it");
    *ret_bytes = text->text + text->at;
    text->at += size;
    return PIR_OK;
}

static int64_t decode_integer(const char *bytes, enum ply_type type, bool big) {
    if (type == PLY_INT8 || type == PLY_INT16 || type == PLY_INT32)
        return pir_bytes_signed(bytes, pir_ply_type_size(type), big);
    return (int64_t)pir_bytes_unsigned(bytes, pir_ply_type_size(type), big);
}

static double decode(const char *bytes, enum ply_type type, bool big) {
    if (type == PLY_FLOAT)
        return pir_bytes_float(bytes, big);
    if (type == PLY_DOUBLE)
        return pir_bytes_double(bytes, big);
    return (double)decode_integer(bytes, type, big);
}

static pir_status read_coordinate(struct ply *ply, enum ply_type type, double *ret_value) {
    const char *bytes = NULL;
    pir_status status = next_value(ply, type, &bytes);
    if (status != PIR_OK)
        return status;
    if (ply->header.format == PLY_ASCII)
        return pir_text_number(&ply->text, (uint32_t)ply->index, ret_value);
    double value = decode(bytes, type, ply->header.format == PLY_BIG);
    if (!isfinite(value))
        return fail_here(ply, PIR_ERR_NOT_FINITE, "a coordinate is not a finite number");
    *ret_value = value;
    return PIR_OK;
}

static pir_status pass_value(struct ply *ply, enum ply_type type) {
    const char *bytes = NULL;
    char shown[PIR_SHOWN];
    pir_status status = next_value(ply, type, &bytes);
    if (status == PIR_OK && ply->header.format == PLY_ASCII && !pir_text_is_number(&ply->text))
        return fail_here(ply, PIR_ERR_FORMAT, "'%s' is not a number", pir_text_show(&ply->text, shown));
    return status;
}

/* A size of a list or an index: an integer type, and not negative. */
static pir_status read_index(struct ply *ply, enum ply_type type, uint64_t *ret_index) {
    const char *bytes = NULL;
    char shown[PIR_SHOWN];
    pir_status status = next_value(ply, type, &bytes);
    if (status != PIR_OK)
        return status;
    if (ply->header.format == PLY_ASCII) {
        if (!pir_text_count(&ply->text, ret_index))
            return fail_here(ply, PIR_ERR_FORMAT, "'%s' is not a size or an index", pir_text_show(&ply->text, shown));
        return PIR_OK;
    }
    int64_t value = decode_integer(bytes, type, ply->header.format == PLY_BIG);
    if (value < 0)
        return fail_here(ply, PIR_ERR_FORMAT, "%lld is not a size or an index", (long long)value);
    *ret_index = (uint64_t)value;
    return PIR_OK;
}

/* --- elements --- */

/* The size of a list, which the bytes left can hold. */
static pir_status read_list_size(struct ply *ply, const struct ply_property *property, uint64_t *ret_size) {
    pir_status status = read_index(ply, property->count_type, ret_size);
    size_t each = ply->header.format == PLY_ASCII ? 2 : pir_ply_type_size(property->type);
    // in text the last number needs no blank after it
    size_t room = ply->text.size - ply->text.at + (ply->header.format == PLY_ASCII);
    if (status == PIR_OK && *ret_size > room / each)
        return fail_here(ply, PIR_ERR_FORMAT, "list %s promises %llu values; the bytes that follow cannot hold them",
                         property->name, (unsigned long long)*ret_size);
    return status;
}

static pir_status pass_list(struct ply *ply, const struct ply_property *property) {
    uint64_t size = 0;
    pir_status status = read_list_size(ply, property, &size);
    for (uint64_t i = 0; i < size && status == PIR_OK; i++)
        status = pass_value(ply, property->type);
    return status;
}

/* The list of a face's corners as a facet of the model. */
static pir_status read_corners(struct ply *ply, const struct ply_property *property) {
    uint64_t size = 0, vertices = ply->header.vertex->count;
    pir_status status = read_list_size(ply, property, &size);
    if (status == PIR_OK && size < 3)
        return fail_here(ply, PIR_ERR_FORMAT, "it has %u corners; three or more are needed", (unsigned)size);
    if (status == PIR_OK)
        status = pir_model_begin_facet(ply->model, ply->text.token_line);
    for (uint64_t i = 0; i < size && status == PIR_OK; i++) {
        uint64_t corner = 0;
        status = read_index(ply, property->type, &corner);
        if (status == PIR_OK && corner >= vertices)
            return fail_here(ply, PIR_ERR_FORMAT, "it has corner %llu; there are %llu vertices, counted from 0",
                             (unsigned long long)corner, (unsigned long long)vertices);
        if (status == PIR_OK)
            status = pir_model_add_corner(ply->model, (uint32_t)corner);
    }
    return status;
}

/* One property of an element; a coordinate goes to `point`. */
static pir_status read_property(struct ply *ply, const struct ply_property *property, pir_vec3 *point) {
    switch (property->role) {
    case PLY_X:
        return read_coordinate(ply, property->type, &point->x);
    case PLY_Y:
        return read_coordinate(ply, property->type, &point->y);
    case PLY_Z:
        return read_coordinate(ply, property->type, &point->z);
    case PLY_CORNERS:
        return read_corners(ply, property);
    case PLY_PASSED_OVER:
        break;
    }
    return property->is_list ? pass_list(ply, property) : pass_value(ply, property->type);
}

/* That nothing is left on an element's line. */
static pir_status close_line(struct ply *ply) {
    char shown[PIR_SHOWN];
    ply->line_open = false;
    if (ply->header.format == PLY_ASCII && pir_text_next(&ply->text, true))
        return fail_here(ply, PIR_ERR_FORMAT, "'%s' is one value too many on its line",
                         pir_text_show(&ply->text, shown));
    return PIR_OK;
}

/* That the bytes left have room for as many elements as the header promises. */
static pir_status check_room(const struct ply *ply) {
    const struct ply_element *element = ply->element;
    uint64_t each = 0, room = ply->text.size - ply->text.at + 1;
    for (unsigned i = element->first; i < element->end; i++) {
        const struct ply_property *property = &ply->header.property[i];
        enum ply_type type = property->is_list ? property->count_type : property->type;
        each += ply->header.format == PLY_ASCII ? 2 : pir_ply_type_size(type);
    }
    if (each > 0 && element->count > room / each)
        return pir_fail(ply->text.report, PIR_ERR_FORMAT,
                        "%s:%zu: %llu elements %s are promised; the %zu bytes that follow cannot hold them",
                        ply->text.name, element->line, (unsigned long long)element->count, element->name,
                        ply->text.size - ply->text.at);
    return PIR_OK;
}

static pir_status read_elements(struct ply *ply) {
    bool is_vertex = ply->element == ply->header.vertex;
    pir_status status = check_room(ply);
    if (status == PIR_OK && is_vertex)
        status = pir_model_reserve_points(ply->model, (uint32_t)ply->element->count);
    for (ply->index = 0; ply->index < ply->element->count && status == PIR_OK; ply->index++) {
        pir_vec3 point = {0, 0, 0};
        for (unsigned i = ply->element->first; i < ply->element->end && status == PIR_OK; i++)
            status = read_property(ply, &ply->header.property[i], &point);
        if (status == PIR_OK)
            status = close_line(ply);
        if (status == PIR_OK && is_vertex)
            status = pir_model_add_point(ply->model, point);
    }
    return status;
}

/* That the file ends where the last element does. */
static pir_status check_end(struct ply *ply) {
    struct pir_text *text = &ply->text;
    char shown[PIR_SHOWN];
    if (ply->header.format == PLY_ASCII && pir_text_next(text, false))
        return pir_text_fail(text, PIR_ERR_FORMAT, "'%s' follows the last element", pir_text_show(text, shown));
    if (ply->header.format != PLY_ASCII && text->at < text->size)
        return pir_fail(text->report, PIR_ERR_FORMAT, "%s: %zu bytes follow the last element, which ends at byte %zu",
                        text->name, text->size - text->at, text->at);
    return PIR_OK;
}

pir_status pir_read_ply(const char *data, size_t size, struct pir_model *model) {
    struct ply ply = {.model = model};
    pir_text_init(&ply.text, data, size, model->name, model->report);
    pir_status status = pir_ply_read_header(&ply.text, &ply.header);
    model->binary = ply.header.format != PLY_ASCII;
    for (unsigned e = 0; e < ply.header.element_count && status == PIR_OK; e++) {
        ply.element = &ply.header.element[e];
        status = read_elements(&ply);
    }
    return status == PIR_OK ? check_end(&ply) : status;
}
