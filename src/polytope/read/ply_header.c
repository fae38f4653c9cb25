/* SPDX-License-Identifier: MIT */
/* The header of a PLY file, line by line. A line that is none of the format's is refused, so that none is
 * misunderstood. */
#include "polytope/read/ply_header.h"

#include <string.h>

#include "base/report.h"

size_t pir_ply_type_size(enum ply_type type) {
    static const size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[type];
}

static pir_status fail_token(const struct pir_text *text, const char *what) {
    char shown[PIR_SHOWN];
    return pir_text_fail(text, PIR_ERR_FORMAT, "'%s' is not %s", pir_text_show(text, shown), what);
}

/* The next token of the line, which is `what`. */
static pir_status next_in_line(struct pir_text *text, const char *what) {
    if (pir_text_next(text, true))
        return PIR_OK;
    return pir_text_fail(text, PIR_ERR_FORMAT, "the line ends before %s", what);
}

static pir_status expect_line_end(struct pir_text *text) {
    char shown[PIR_SHOWN];
    if (!pir_text_next(text, true))
        return PIR_OK;
    return pir_text_fail(text, PIR_ERR_FORMAT, "'%s' is one word too many on this line", pir_text_show(text, shown));
}

/* "format ascii 1.0" and the like, the first word read. */
static pir_status read_format(struct pir_text *text, enum ply_format *ret_format) {
    static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    pir_status status = next_in_line(text, "the format");
    if (status != PIR_OK)
        return status;
    int format = 0;
    while (format < 3 && !pir_text_is(text, names[format]))
        format++;
    if (format == 3)
        return fail_token(text, "ascii, binary_little_endian or binary_big_endian");
    if ((status = next_in_line(text, "the version")) != PIR_OK)
        return status;
    if (!pir_text_is(text, "1.0"))
        return fail_token(text, "version 1.0");
    *ret_format = (enum ply_format)format;
    return expect_line_end(text);
}

/* "element vertex 8", the first word read. */
static pir_status read_element(struct pir_text *text, struct ply_header *header) {
    pir_status status = next_in_line(text, "the element's name");
    if (status != PIR_OK)
        return status;
    if (header->element_count >= PLY_ELEMENTS_MAX)
        return pir_text_fail(text, PIR_ERR_LIMIT, "more than %d elements", PLY_ELEMENTS_MAX);
    // strips of triangles would be facets too, and a hull without them of a part only
    if (pir_text_is(text, "tristrips"))
        return pir_text_fail(text, PIR_ERR_FORMAT, "strips of triangles are not read; only faces are");
    struct ply_element *element = &header->element[header->element_count];
    *element = (struct ply_element){.line = text->token_line, .first = header->property_count};
    element->end = element->first;
    pir_text_show(text, element->name);
    for (unsigned i = 0; i < header->element_count; i++)
        if (strcmp(header->element[i].name, element->name) == 0)
            return pir_text_fail(text, PIR_ERR_FORMAT, "element %s is on line %zu already", element->name,
                                 header->element[i].line);
    if ((status = next_in_line(text, "the number of elements")) != PIR_OK)
        return status;
    if (!pir_text_count(text, &element->count))
        return fail_token(text, "a number of elements");
    header->element_count++;
    return expect_line_end(text);
}

/* The next token of the line as a type. */
static pir_status read_type(struct pir_text *text, enum ply_type *ret_type) {
    static const struct {
        const char *name;
        enum ply_type type;
    } types[] = {
        {"char", PLY_INT8},   {"int8", PLY_INT8},     {"uchar", PLY_UINT8},   {"uint8", PLY_UINT8},
        {"short", PLY_INT16}, {"int16", PLY_INT16},   {"ushort", PLY_UINT16}, {"uint16", PLY_UINT16},
        {"int", PLY_INT32},   {"int32", PLY_INT32},   {"uint", PLY_UINT32},   {"uint32", PLY_UINT32},
        {"float", PLY_FLOAT}, {"float32", PLY_FLOAT}, {"double", PLY_DOUBLE}, {"float64", PLY_DOUBLE},
    };
    pir_status status = next_in_line(text, "the property's type");
    for (size_t i = 0; status == PIR_OK && i < sizeof types / sizeof *types; i++)
        if (pir_text_is(text, types[i].name)) {
            *ret_type = types[i].type;
            return PIR_OK;
        }
    return status == PIR_OK ? fail_token(text, "the type of a property") : status;
}

/* The last token, which names a property of the last element. */
static pir_status name_property(const struct pir_text *text, struct ply_header *header) {
    struct ply_element *element = &header->element[header->element_count - 1];
    struct ply_property *property = &header->property[header->property_count];
    pir_text_show(text, property->name);
    for (unsigned i = element->first; i < element->end; i++)
        if (strcmp(header->property[i].name, property->name) == 0)
            return pir_text_fail(text, PIR_ERR_FORMAT, "element %s has property %s already", element->name,
                                 property->name);
    bool of_vertex = strcmp(element->name, "vertex") == 0, of_face = strcmp(element->name, "face") == 0;
    if (of_vertex && pir_text_is(text, "x"))
        property->role = PLY_X;
    else if (of_vertex && pir_text_is(text, "y"))
        property->role = PLY_Y;
    else if (of_vertex && pir_text_is(text, "z"))
        property->role = PLY_Z;
    else if (of_face && (pir_text_is(text, "vertex_indices") || pir_text_is(text, "vertex_index")))
        property->role = PLY_CORNERS;
    if (property->role != PLY_PASSED_OVER && property->is_list != (property->role == PLY_CORNERS))
        return pir_text_fail(text, PIR_ERR_FORMAT, "property %s of element %s is %s list", property->name,
                             element->name, property->is_list ? "a" : "no");
    if (property->role == PLY_CORNERS && property->type >= PLY_FLOAT)
        return pir_text_fail(text, PIR_ERR_FORMAT, "the corners of faces are no integers");
    element->end = ++header->property_count;
    return PIR_OK;
}

/* "property float x" or "property list uchar int vertex_indices", the first word read. */
static pir_status read_property(struct pir_text *text, struct ply_header *header) {
    if (header->element_count == 0)
        return pir_text_fail(text, PIR_ERR_FORMAT, "a property stands before any element");
    if (header->property_count >= PLY_PROPERTIES_MAX)
        return pir_text_fail(text, PIR_ERR_LIMIT, "more than %d properties", PLY_PROPERTIES_MAX);
    struct ply_property *property = &header->property[header->property_count];
    *property = (struct ply_property){0};
    struct pir_text ahead = *text;
    pir_status status = PIR_OK;
    if (pir_text_next(&ahead, true) && pir_text_is(&ahead, "list")) {
        *text = ahead;
        property->is_list = true;
        status = read_type(text, &property->count_type);
        if (status == PIR_OK && property->count_type >= PLY_FLOAT)
            return pir_text_fail(text, PIR_ERR_FORMAT, "the size of a list is no integer");
    }
    if (status == PIR_OK)
        status = read_type(text, &property->type);
    if (status == PIR_OK)
        status = next_in_line(text, "the property's name");
    if (status == PIR_OK)
        status = name_property(text, header);
    return status == PIR_OK ? expect_line_end(text) : status;
}

/* That the elements are such as a model needs. */
static pir_status check_elements(const struct pir_text *text, struct ply_header *header) {
    const struct ply_element *face = NULL;
    unsigned seen = 0;
    for (unsigned e = 0; e < header->element_count; e++) {
        const struct ply_element *element = &header->element[e];
        if (element->first == element->end && element->count > 0)
            return pir_fail(text->report, PIR_ERR_FORMAT, "%s:%zu: element %s has no properties", text->name,
                            element->line, element->name);
        header->vertex = strcmp(element->name, "vertex") == 0 ? element : header->vertex;
        face = strcmp(element->name, "face") == 0 ? element : face;
        for (unsigned i = element->first; i < element->end; i++)
            seen |= 1u << header->property[i].role;
    }
    if (!header->vertex || header->vertex->count == 0)
        return pir_text_fail(text, PIR_ERR_EMPTY, "the file has no vertices");
    const unsigned xyz = 1u << PLY_X | 1u << PLY_Y | 1u << PLY_Z;
    if ((seen & xyz) != xyz)
        return pir_text_fail(text, PIR_ERR_FORMAT, "element vertex has no property %s",
                             !(seen & 1u << PLY_X)   ? "x"
                             : !(seen & 1u << PLY_Y) ? "y"
                                                     : "z");
    if (face && face->count > 0 && !(seen & 1u << PLY_CORNERS))
        return pir_text_fail(text, PIR_ERR_FORMAT, "element face has no list vertex_indices");
    return PIR_OK;
}

/* Passes the end of a line, which must be at hand: what follows in a binary file may look like one more. */
static bool pass_line_end(struct pir_text *text, bool carriage_return, bool line_feed) {
    const char end[3] = {carriage_return ? '\r' : '\n', '\n', '\0'};
    size_t length = carriage_return && line_feed ? 2 : 1;
    if (text->size - text->at < length || memcmp(text->text + text->at, end, length) != 0)
        return false;
    text->at += length;
    text->line++;
    return true;
}

/* The lines between the first and "end_header". */
static pir_status read_lines(struct pir_text *text, struct ply_header *header, bool *ret_has_format) {
    pir_status status = PIR_OK;
    while (status == PIR_OK) {
        if (!pir_text_next(text, false))
            return pir_text_fail(text, PIR_ERR_FORMAT, "the file ends before 'end_header'");
        if (pir_text_is(text, "end_header"))
            return PIR_OK;
        if (pir_text_is(text, "comment") || pir_text_is(text, "obj_info")) {
            pir_text_pass_line(text);
        } else if (pir_text_is(text, "format")) {
            if (*ret_has_format)
                return pir_text_fail(text, PIR_ERR_FORMAT, "the format is given twice");
            *ret_has_format = true;
            status = read_format(text, &header->format);
        } else if (pir_text_is(text, "element")) {
            status = read_element(text, header);
        } else if (pir_text_is(text, "property")) {
            status = read_property(text, header);
        } else {
            return fail_token(text, "a line of a PLY header");
        }
    }
    return status;
}

pir_status pir_ply_read_header(struct pir_text *text, struct ply_header *ret_header) {
    bool has_format = false;
    *ret_header = (struct ply_header){0};
    if (text->size < 4 || memcmp(text->text, "ply", 3) != 0)
        return pir_text_fail(text, PIR_ERR_FORMAT, "the file does not begin with a line 'ply'");
    text->at = 3;
    // the first line's end is that of the last
    bool carriage_return = text->text[3] == '\r', line_feed = text->text[carriage_return ? 4 : 3] == '\n';
    if (!pass_line_end(text, carriage_return, line_feed))
        return pir_text_fail(text, PIR_ERR_FORMAT, "the file does not begin with a line 'ply'");
    pir_status status = read_lines(text, ret_header, &has_format);
    if (status != PIR_OK)
        return status;
    if (!has_format)
        return pir_text_fail(text, PIR_ERR_FORMAT, "the header has no line 'format'");
    if ((status = check_elements(text, ret_header)) != PIR_OK)
        return status;
    if (!pass_line_end(text, carriage_return, line_feed))
        return pir_text_fail(text, PIR_ERR_FORMAT, "'end_header' is not followed by the end of a line as in line 1");
    return PIR_OK;
}
