/* SPDX-License-Identifier: MIT */
/*
 * Reading OFF: "OFF", the counts of vertices, facets and edges, the vertices, the facets; '#' starts a comment
 * anywhere.
 *
 * The idea: one pass over tokens, each remembered with its line. A coordinate is kept as a double while it is one; the
 * first that is none (1/3, an integer of 60 bits) makes the whole model exact.
 *
 * Invariants: nothing is allocated on the word of a count that the bytes left could not hold; every index is below the
 * number of vertices, or, in a file that counts from 1 and has no index 0, equal to it; a failed read leaves nothing
 * behind.
 */
#include "polytope/read/readers.h"

#include <string.h>

#include "base/memory.h"
#include "base/report.h"
#include "polytope/read/text.h"

/* The longest common denominator, in bits: exact arithmetic brings every coordinate to it. */
#define DENOMINATOR_BITS_MAX 65536

/* The fewest bytes that a vertex and a facet take, "0 0 0" and "3 0 1 2" with the space between them and the next. */
#define VERTEX_BYTES 6
#define FACET_BYTES  8

struct reader {
    struct pir_text text;
    struct pir_model *model;
    uint32_t vertex_count, facet_count;
    size_t zero_line, beyond_line; /* where a facet has corner 0, and corner vertex_count; 0 for nowhere; never both */
    mpz_t common;                  /* the least common denominator of the rationals so far */
};

/* A coordinate: a double, or when `exact` the rational that stands beside it. */
struct number {
    double value;
    bool exact;
};

/* --- the file, part by part --- */

static pir_status read_header(struct reader *reader) {
    struct pir_text *text = &reader->text;
    // A byte order mark, as some editors put one before UTF-8 text, is no part of the text.
    if (text->size >= 3 && memcmp(text->text, "\xEF\xBB\xBF", 3) == 0)
        text->at = 3;
    if (!pir_text_next(text, false))
        return pir_fail(text->report, PIR_ERR_EMPTY, "%s: the file is empty", text->name);
    char shown[PIR_SHOWN];
    if (pir_text_is(text, "OFF"))
        return PIR_OK;
    const size_t length = pir_text_length(text);
    if (length > 3 && length < 8 && memcmp(text->end - 3, "OFF", 3) == 0)
        return pir_text_fail(text, PIR_ERR_FORMAT,
                             "'%s' files are not read; only plain 'OFF', three coordinates a vertex, is",
                             pir_text_show(text, shown));
    return pir_text_fail(text, PIR_ERR_FORMAT, "the file begins with '%s', not with 'OFF'", pir_text_show(text, shown));
}

/* The next token as the count of `what`. */
static pir_status read_count(struct pir_text *text, const char *what, uint64_t *ret_count) {
    char shown[PIR_SHOWN];
    if (!pir_text_next(text, false))
        return pir_text_fail(text, PIR_ERR_FORMAT, "the file ends before the number of %s", what);
    if (pir_text_is(text, "BINARY"))
        return pir_text_fail(text, PIR_ERR_FORMAT, "binary OFF is not read; only text is");
    if (!pir_text_count(text, ret_count))
        return pir_text_fail(text, PIR_ERR_FORMAT, "the number of %s is '%s'", what, pir_text_show(text, shown));
    return PIR_OK;
}

/* Whether the line ends here and the next line that holds anything holds three tokens, as a vertex does and a count
 * does not. */
static bool edge_count_left_out(const struct pir_text *text) {
    struct pir_text ahead = *text;
    if (pir_text_next(&ahead, true))
        return false;
    return pir_text_next(&ahead, false) && pir_text_next(&ahead, true) && pir_text_next(&ahead, true);
}

/* V, F and E; E, which nobody needs, may be left out where V and F stand on a line of their own. */
static pir_status read_counts(struct reader *reader) {
    uint64_t vertices = 0, facets = 0, edges = 0;
    pir_status status = read_count(&reader->text, "vertices", &vertices);
    if (status)
        return status;
    size_t line = reader->text.token_line;
    if ((status = read_count(&reader->text, "facets", &facets)) != PIR_OK)
        return status;
    bool left_out = reader->text.token_line == line && edge_count_left_out(&reader->text);
    if (!left_out && (status = read_count(&reader->text, "edges", &edges)) != PIR_OK)
        return status;
    if (vertices == 0)
        return pir_text_fail(&reader->text, PIR_ERR_EMPTY, "the file has no vertices");
    // The bytes left must have room for what is promised; the first division keeps the products small.
    uint64_t room = reader->text.size - reader->text.at + 1;
    if (vertices > room / VERTEX_BYTES || facets > (room - vertices * VERTEX_BYTES) / FACET_BYTES)
        return pir_text_fail(&reader->text, PIR_ERR_FORMAT,
                             "%llu vertices and %llu facets are promised; the %zu bytes that follow cannot hold them",
                             (unsigned long long)vertices, (unsigned long long)facets,
                             reader->text.size - reader->text.at);
    reader->vertex_count = (uint32_t)vertices;
    reader->facet_count = (uint32_t)facets;
    return PIR_OK;
}

/* From here on the model is exact: rationals for all vertices, set for those before the next. */
static pir_status make_exact(struct reader *reader) {
    struct pir_model *model = reader->model;
    size_t count = 3 * (size_t)reader->vertex_count;
    model->exact = PIR_NEW(&model->allocator, mpq_t, count);
    if (!model->exact)
        return pir_model_fail_memory(model);
    model->exact_count = reader->vertex_count;
    for (size_t i = 0; i < count; i++)
        mpq_init(model->exact[i]);
    for (size_t v = 0; v < model->point_count; v++) {
        mpq_set_d(model->exact[3 * v], model->points[v].x);
        mpq_set_d(model->exact[3 * v + 1], model->points[v].y);
        mpq_set_d(model->exact[3 * v + 2], model->points[v].z);
    }
    return PIR_OK;
}

/* The rationals of vertex `vertex` into the model, and their denominators into the common one. */
static pir_status put_exact(struct reader *reader, uint32_t vertex, const struct number numbers[3], mpq_t scratch[3]) {
    for (size_t axis = 0; axis < 3; axis++) {
        mpq_ptr exact = reader->model->exact[3 * (size_t)vertex + axis];
        if (numbers[axis].exact)
            mpq_set(exact, scratch[axis]);
        else
            mpq_set_d(exact, numbers[axis].value);
        mpz_lcm(reader->common, reader->common, mpq_denref(exact));
    }
    if (mpz_sizeinbase(reader->common, 2) > DENOMINATOR_BITS_MAX)
        return pir_text_fail(&reader->text, PIR_ERR_LIMIT,
                             "the common denominator of all coordinates passes %d bits in vertex %u",
                             DENOMINATOR_BITS_MAX, (unsigned)vertex);
    return PIR_OK;
}

/* One vertex; `scratch` holds three rationals between the tokens and the model. */
static pir_status read_vertex(struct reader *reader, uint32_t vertex, mpq_t scratch[3]) {
    struct pir_text *text = &reader->text;
    struct number numbers[3] = {{0}};
    pir_status status;
    for (int axis = 0; axis < 3; axis++) {
        if (!pir_text_next(text, false))
            return pir_text_fail(text, PIR_ERR_FORMAT, "the file ends in vertex %u of %u", (unsigned)vertex,
                                 (unsigned)reader->vertex_count);
        status = pir_text_exact_number(text, vertex, &numbers[axis].value, &numbers[axis].exact, scratch[axis]);
        if (status != PIR_OK)
            return status;
    }
    if (!reader->model->exact && (numbers[0].exact || numbers[1].exact || numbers[2].exact))
        if ((status = make_exact(reader)) != PIR_OK)
            return status;
    if (reader->model->exact && (status = put_exact(reader, vertex, numbers, scratch)) != PIR_OK)
        return status;
    return pir_model_add_point(reader->model, (pir_vec3){numbers[0].value, numbers[1].value, numbers[2].value});
}

static pir_status read_vertices(struct reader *reader) {
    mpq_t scratch[3];
    for (int axis = 0; axis < 3; axis++)
        mpq_init(scratch[axis]);
    pir_status status = pir_model_reserve_points(reader->model, reader->vertex_count);
    for (uint32_t v = 0; v < reader->vertex_count && status == PIR_OK; v++)
        status = read_vertex(reader, v, scratch);
    for (int axis = 0; axis < 3; axis++)
        mpq_clear(scratch[axis]);
    return status;
}

/* The next token as a corner of facet `facet`. Some files count vertices from 1: all do or none does. */
static pir_status read_corner(struct reader *reader, uint32_t facet, uint32_t *ret_corner) {
    uint64_t corner = 0;
    char shown[PIR_SHOWN];
    if (!pir_text_next(&reader->text, false))
        return pir_text_fail(&reader->text, PIR_ERR_FORMAT, "the file ends in facet %u of %u", (unsigned)facet,
                             (unsigned)reader->facet_count);
    if (!pir_text_count(&reader->text, &corner))
        return pir_text_fail(&reader->text, PIR_ERR_FORMAT, "'%s' in facet %u is not an index",
                             pir_text_show(&reader->text, shown), (unsigned)facet);
    if (corner > reader->vertex_count || (corner == reader->vertex_count && reader->zero_line))
        return pir_text_fail(&reader->text, PIR_ERR_FORMAT,
                             "facet %u has corner %s; there are %u vertices, counted from 0", (unsigned)facet,
                             pir_text_show(&reader->text, shown), (unsigned)reader->vertex_count);
    if (corner == 0 && reader->beyond_line)
        return pir_text_fail(&reader->text, PIR_ERR_FORMAT,
                             "corner 0 here and corner %u on line %zu are one more than %u vertices",
                             (unsigned)reader->vertex_count, reader->beyond_line, (unsigned)reader->vertex_count);
    if (corner == 0)
        reader->zero_line = reader->text.token_line;
    if (corner == reader->vertex_count)
        reader->beyond_line = reader->text.token_line;
    *ret_corner = (uint32_t)corner;
    return PIR_OK;
}

static pir_status fail_twice(const struct reader *reader, uint32_t corner) {
    return pir_text_fail(&reader->text, PIR_ERR_FORMAT, "a facet has corner %u twice in a row", (unsigned)corner);
}

/* One facet to the model; what follows on the line of its last corner is a colour and passed over. */
static pir_status read_facet(struct reader *reader, uint32_t facet) {
    char shown[PIR_SHOWN];
    uint64_t size = 0;
    if (!pir_text_next(&reader->text, false))
        return pir_text_fail(&reader->text, PIR_ERR_FORMAT, "the file ends before facet %u of %u", (unsigned)facet,
                             (unsigned)reader->facet_count);
    size_t line = reader->text.token_line;
    if (!pir_text_count(&reader->text, &size) || size < 3)
        return pir_text_fail(&reader->text, PIR_ERR_FORMAT, "facet %u has '%s' corners; three or more are needed",
                             (unsigned)facet, pir_text_show(&reader->text, shown));
    if (size > (reader->text.size - reader->text.at) / 2)
        return pir_text_fail(&reader->text, PIR_ERR_FORMAT,
                             "facet %u promises %llu corners; the %zu bytes that follow cannot hold them",
                             (unsigned)facet, (unsigned long long)size, reader->text.size - reader->text.at);
    // Corners one by one; a third value among them shows that there are three.
    pir_status status = pir_model_begin_facet(reader->model, line);
    uint32_t first = 0, second = 0, last = 0;
    bool three = false;
    for (uint64_t i = 0; i < size && status == PIR_OK; i++) {
        uint32_t corner = 0;
        status = read_corner(reader, facet, &corner);
        if (status == PIR_OK && i > 0 && corner == last)
            status = fail_twice(reader, corner);
        if (status == PIR_OK)
            status = pir_model_add_corner(reader->model, corner);
        if (i == 0)
            first = corner;
        else if (i == 1)
            second = corner;
        else
            three = three || (corner != first && corner != second);
        last = corner;
    }
    if (status != PIR_OK)
        return status;
    if (!three)
        return pir_text_fail(&reader->text, PIR_ERR_FORMAT, "facet %u has fewer than three different corners",
                             (unsigned)facet);
    if (last == first)
        return fail_twice(reader, first);
    pir_text_pass_line(&reader->text);
    return PIR_OK;
}

static pir_status read_facets(struct reader *reader) {
    for (uint32_t f = 0; f < reader->facet_count; f++) {
        pir_status status = read_facet(reader, f);
        if (status != PIR_OK)
            return status;
    }
    char shown[PIR_SHOWN];
    if (pir_text_next(&reader->text, false))
        return pir_text_fail(&reader->text, PIR_ERR_FORMAT, "'%s' follows the last %s",
                             pir_text_show(&reader->text, shown), reader->facet_count ? "facet" : "vertex");
    return PIR_OK;
}

static pir_status read_parts(struct reader *reader) {
    pir_status status = read_header(reader);
    if (status == PIR_OK)
        status = read_counts(reader);
    if (status == PIR_OK)
        status = read_vertices(reader);
    if (status == PIR_OK)
        status = read_facets(reader);
    // corners that count from 1 become those that count from 0
    for (uint32_t i = 0; status == PIR_OK && reader->beyond_line && i < reader->model->corner_count; i++)
        reader->model->corner[i]--;
    return status;
}

pir_status pir_read_off(const char *data, size_t size, struct pir_model *model) {
    struct reader reader = {.model = model};
    pir_text_init(&reader.text, data, size, model->name, model->report);
    reader.text.comments = true;
    mpz_init_set_ui(reader.common, 1);
    pir_status status = read_parts(&reader);
    mpz_clear(reader.common);
    return status;
}
