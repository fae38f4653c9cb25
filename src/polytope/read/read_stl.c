/* SPDX-License-Identifier: MIT */
/*
 * Reading STL: triangles, each with three points of its own.
 *
 * A file is binary when its size is what its count of triangles says: a header of 80 bytes, the count, 50 bytes each. A
 * binary file may begin with "solid" as text does, and only the size tells them apart for certain. Normals are not
 * used; the corners give them.
 */
#include "polytope/read/readers.h"

#include <math.h>
#include <string.h>

#include "base/report.h"
#include "polytope/read/bytes.h"
#include "polytope/read/text.h"

#define HEADER_BYTES   84
#define TRIANGLE_BYTES 50

/* --- binary --- */

/* The number of triangles that a binary file of at least HEADER_BYTES promises. */
static uint64_t promised_triangles(const char *data) {
    return pir_bytes_unsigned(data + 80, 4, false);
}

static pir_status read_binary(const char *data, struct pir_model *model) {
    uint32_t count = (uint32_t)promised_triangles(data);
    model->binary = true;
    pir_status status = pir_model_reserve_points(model, 3 * count);
    for (uint32_t t = 0; t < count && status == PIR_OK; t++) {
        // past the normal
        const char *corner = data + HEADER_BYTES + (size_t)t * TRIANGLE_BYTES + 12;
        status = pir_model_begin_facet(model, 0);
        for (int k = 0; k < 3 && status == PIR_OK; k++, corner += 12) {
            pir_vec3 p = {pir_bytes_float(corner, false), pir_bytes_float(corner + 4, false),
                          pir_bytes_float(corner + 8, false)};
            if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z))
                return pir_fail(model->report, PIR_ERR_NOT_FINITE,
                                "%s: triangle %u, at byte %zu, has a coordinate that is not a finite number",
                                model->name, (unsigned)t, (size_t)(corner - data));
            status = pir_model_add_corner(model, model->point_count);
            if (status == PIR_OK)
                status = pir_model_add_point(model, p);
        }
    }
    return status;
}

/* --- text --- */

/* The next token, which must be `word`. */
static pir_status expect_word(struct pir_text *text, const char *word) {
    char shown[PIR_SHOWN];
    if (!pir_text_next(text, false))
        return pir_text_fail(text, PIR_ERR_FORMAT, "the file ends before '%s'", word);
    if (!pir_text_is_word(text, word))
        return pir_text_fail(text, PIR_ERR_FORMAT, "'%s' stands where '%s' is due", pir_text_show(text, shown), word);
    return PIR_OK;
}

static pir_status expect_words(struct pir_text *text, const char *first, const char *second) {
    pir_status status = expect_word(text, first);
    return status == PIR_OK ? expect_word(text, second) : status;
}

/* The three numbers of a normal, of whatever value: some writers give nan to a triangle without area. */
static pir_status pass_normal(struct pir_text *text) {
    char shown[PIR_SHOWN];
    for (int k = 0; k < 3; k++) {
        if (!pir_text_next(text, false))
            return pir_text_fail(text, PIR_ERR_FORMAT, "the file ends in a normal");
        if (!pir_text_is_number(text))
            return pir_text_fail(text, PIR_ERR_FORMAT, "'%s' in a normal is not a number", pir_text_show(text, shown));
    }
    return PIR_OK;
}

static pir_status read_corner(struct pir_text *text, struct pir_model *model) {
    double value[3] = {0};
    pir_status status = expect_word(text, "vertex");
    for (int k = 0; k < 3 && status == PIR_OK; k++) {
        if (!pir_text_next(text, false))
            return pir_text_fail(text, PIR_ERR_FORMAT, "the file ends in vertex %u", (unsigned)model->point_count);
        status = pir_text_number(text, model->point_count, &value[k]);
    }
    if (status == PIR_OK)
        status = pir_model_add_corner(model, model->point_count);
    if (status == PIR_OK)
        status = pir_model_add_point(model, (pir_vec3){value[0], value[1], value[2]});
    return status;
}

/* A triangle, its first word read. */
static pir_status read_triangle(struct pir_text *text, struct pir_model *model) {
    pir_status status = pir_model_begin_facet(model, text->token_line);
    if (status == PIR_OK)
        status = expect_word(text, "normal");
    if (status == PIR_OK)
        status = pass_normal(text);
    if (status == PIR_OK)
        status = expect_words(text, "outer", "loop");
    for (int k = 0; k < 3 && status == PIR_OK; k++)
        status = read_corner(text, model);
    return status == PIR_OK ? expect_words(text, "endloop", "endfacet") : status;
}

/* A solid, its first word read, up to its last line. */
static pir_status read_solid(struct pir_text *text, struct pir_model *model) {
    char shown[PIR_SHOWN];
    // the name, which may be anything
    pir_text_pass_line(text);
    while (pir_text_next(text, false)) {
        if (pir_text_is_word(text, "endsolid")) {
            pir_text_pass_line(text);
            return PIR_OK;
        }
        if (!pir_text_is_word(text, "facet"))
            return pir_text_fail(text, PIR_ERR_FORMAT, "'%s' stands where 'facet' or 'endsolid' is due",
                                 pir_text_show(text, shown));
        pir_status status = read_triangle(text, model);
        if (status != PIR_OK)
            return status;
    }
    return pir_text_fail(text, PIR_ERR_FORMAT, "the file ends before 'endsolid'");
}

static pir_status read_text(struct pir_text *text, struct pir_model *model) {
    pir_status status = PIR_OK;
    char shown[PIR_SHOWN];
    // the first solid's first word is read
    do {
        if (!pir_text_is_word(text, "solid"))
            return pir_text_fail(text, PIR_ERR_FORMAT, "'%s' follows the last solid", pir_text_show(text, shown));
        status = read_solid(text, model);
    } while (status == PIR_OK && pir_text_next(text, false));
    return status;
}

pir_status pir_read_stl(const char *data, size_t size, struct pir_model *model) {
    if (size >= HEADER_BYTES && size == HEADER_BYTES + promised_triangles(data) * TRIANGLE_BYTES)
        return read_binary(data, model);
    struct pir_text text;
    pir_text_init(&text, data, size, model->name, model->report);
    if (pir_text_next(&text, false) && pir_text_is_word(&text, "solid"))
        return read_text(&text, model);
    if (size < HEADER_BYTES)
        return pir_fail(model->report, PIR_ERR_FORMAT,
                        "%s: the file neither begins with 'solid' nor holds the %d bytes of a binary STL header",
                        model->name, HEADER_BYTES);
    return pir_fail(model->report, PIR_ERR_FORMAT,
                    "%s: %llu triangles are promised at byte 80 and take %llu bytes in all; the file has %zu",
                    model->name, (unsigned long long)promised_triangles(data),
                    (unsigned long long)(HEADER_BYTES + promised_triangles(data) * TRIANGLE_BYTES), size);
}
