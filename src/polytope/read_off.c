/* SPDX-License-Identifier: MIT */
/*
 * Reading OFF: "OFF", the counts of vertices, facets and edges, the vertices, the facets; '#' starts a comment anywhere.
 *
 * The idea: one pass over tokens, each remembered with its line. A coordinate is kept as a double while it is one; the first
 * that is none (1/3, an integer of 60 bits) makes the whole model exact. Facets serve one purpose: they must close
 * (closing.h).
 *
 * Invariants: nothing is allocated on the word of a count that the bytes left could not hold; every index is below the number of
 * vertices, or, in a file that counts from 1 and has no index 0, equal to it; a failed read leaves nothing behind.
 */
#include "polytope/io.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/exact.h>

#include "base/memory.h"
#include "base/report.h"
#include "polytope/closing.h"

/* The longest number read: enough for any double written out in full, short enough to keep exact arithmetic affordable. */
#define TOKEN_MAX 4096

/* The longest common denominator, in bits: exact arithmetic brings every coordinate to it. */
#define DENOMINATOR_BITS_MAX 65536

/* The fewest bytes that a vertex and a facet take, "0 0 0" and "3 0 1 2" with the space between them and the next. */
#define VERTEX_BYTES 6
#define FACET_BYTES  8

struct reader {
    const char *text;
    size_t size, at; /* at: the first byte not yet read */
    size_t line;     /* the line of that byte */
    const char *name;
    pir_report *report;
    pir_allocator allocator;
    const char *token; /* the last token and its line */
    size_t length, token_line;
    char buffer[TOKEN_MAX + 1]; /* the token as a zero-terminated string, see copy_token */
};

struct model {
    uint32_t vertex_count, facet_count;
    size_t zero_line, beyond_line; /* where a facet has corner 0, and corner vertex_count; 0 for nowhere; never both */
    pir_vec3 *points;              /* vertex_count */
    mpz_t common;                  /* the least common denominator of the rationals so far */
    mpq_t *exact;                  /* 3 · vertex_count, or NULL while all coordinates are doubles */
    struct pir_facet_edge *edges;  /* edge_count of edge_capacity */
    size_t edge_count, edge_capacity;
};

/* A coordinate: a double, or when `exact` the rational that stands beside it. */
struct number {
    double value;
    bool exact;
};

/* Reports "name:line: ...", the line being that of the last token. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
static pir_status
fail_at_token(const struct reader *reader, pir_status status, const char *format, ...) {
    char text[200];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return pir_fail(reader->report, status, "%s:%zu: %s", reader->name, reader->token_line, text);
}

static pir_status fail_memory(const struct reader *reader) {
    return pir_fail(reader->report, PIR_ERR_MEMORY, "%s: out of memory", reader->name);
}

/* --- tokens --- */

static bool is_line_end(char c) {
    return c == '\n' || c == '\r';
}

static bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\f' || c == '\v' || is_line_end(c);
}

/* Passes one byte; "\r\n", "\n" and a lone "\r" each end one line. */
static void pass_byte(struct reader *reader) {
    char c = reader->text[reader->at++];
    if (c == '\n' || (c == '\r' && !(reader->at < reader->size && reader->text[reader->at] == '\n')))
        reader->line++;
}

/* Passes what is left of the line, not its end. */
static void pass_line(struct reader *reader) {
    while (reader->at < reader->size && !is_line_end(reader->text[reader->at]))
        reader->at++;
}

/* Passes blanks and comments, and line ends too unless `same_line`. */
static void pass_blank(struct reader *reader, bool same_line) {
    while (reader->at < reader->size) {
        char c = reader->text[reader->at];
        if (c == '#')
            pass_line(reader);
        else if (is_space(c) && !(same_line && is_line_end(c)))
            pass_byte(reader);
        else
            return;
    }
}

/* The next token, or false at the end of the text or, with `same_line`, of the line. */
static bool next_token(struct reader *reader, bool same_line) {
    pass_blank(reader, same_line);
    if (reader->at == reader->size || is_line_end(reader->text[reader->at]))
        return false;
    reader->token = reader->text + reader->at;
    reader->token_line = reader->line;
    size_t start = reader->at;
    while (reader->at < reader->size && !is_space(reader->text[reader->at]) && reader->text[reader->at] != '#')
        reader->at++;
    reader->length = reader->at - start;
    return true;
}

/* The token as a string for reports: printable ASCII, cut when long. */
static const char *token_text(const struct reader *reader, char ret_text[28]) {
    size_t length = reader->length < 24 ? reader->length : 24;
    for (size_t i = 0; i < length; i++)
        ret_text[i] = reader->token[i] > ' ' && reader->token[i] <= '~' ? reader->token[i] : '?';
    strcpy(ret_text + length, reader->length > 24 ? "..." : "");
    return ret_text;
}

static bool copy_token(struct reader *reader) {
    if (reader->length > TOKEN_MAX)
        return false;
    memcpy(reader->buffer, reader->token, reader->length);
    reader->buffer[reader->length] = '\0';
    return true;
}

/* --- numbers --- */

enum form { FORM_NONE, FORM_INTEGER, FORM_RATIONAL, FORM_DECIMAL, FORM_NOT_FINITE };

static const char *pass_sign(const char *s) {
    return *s == '+' || *s == '-' ? s + 1 : s;
}

static const char *pass_digits(const char *s) {
    while (*s >= '0' && *s <= '9')
        s++;
    return s;
}

/* Equal but for case; `word` is lower case. */
static bool same_word(const char *s, const char *word) {
    for (; *s && *word; s++, word++)
        if ((*s >= 'A' && *s <= 'Z' ? *s - 'A' + 'a' : *s) != *word)
            return false;
    return *s == *word;
}

/* What the string looks like. Only decimal digits count: hexadecimal floats are no numbers here. */
static enum form form_of(const char *string) {
    const char *start = pass_sign(string), *s = pass_digits(start);
    size_t digits = (size_t)(s - start);
    if (same_word(start, "nan") || same_word(start, "inf") || same_word(start, "infinity"))
        return FORM_NOT_FINITE;
    if (*s == '\0')
        return digits > 0 ? FORM_INTEGER : FORM_NONE;
    if (*s == '/') {
        const char *below = pass_sign(s + 1), *end = pass_digits(below);
        return digits > 0 && end > below && *end == '\0' ? FORM_RATIONAL : FORM_NONE;
    }
    // A decimal: digits around a point, then perhaps an exponent.
    if (*s == '.') {
        const char *end = pass_digits(s + 1);
        digits += (size_t)(end - (s + 1));
        s = end;
    }
    if (digits == 0)
        return FORM_NONE;
    if (*s == 'e' || *s == 'E') {
        const char *exponent = pass_sign(s + 1);
        s = pass_digits(exponent);
        if (s == exponent)
            return FORM_NONE;
    }
    return *s == '\0' ? FORM_DECIMAL : FORM_NONE;
}

/* Sets `rational` to the integer or a/b in the buffer; false when b is zero. */
static bool set_rational(char *string, mpq_t rational) {
    char *slash = strchr(string, '/');
    if (slash)
        *slash = '\0';
    mpz_set_str(mpq_numref(rational), string + (*string == '+'), 10);
    if (slash)
        mpz_set_str(mpq_denref(rational), slash + 1 + (slash[1] == '+'), 10);
    else
        mpz_set_ui(mpq_denref(rational), 1);
    if (mpz_sgn(mpq_denref(rational)) == 0)
        return false;
    mpq_canonicalize(rational);
    return true;
}

/* An integer or a/b, of any length: a double where it is one, else the rational, which must lie between the largest doubles. */
static pir_status parse_rational(struct reader *reader, struct number *ret_number, mpq_t ret_rational) {
    char text[28];
    if (!set_rational(reader->buffer, ret_rational))
        return fail_at_token(reader, PIR_ERR_FORMAT, "division by zero in '%s'", token_text(reader, text));
    pir_status status = PIR_OK;
    mpq_t other;
    mpq_init(other);
    mpq_set_d(other, mpq_sgn(ret_rational) < 0 ? -DBL_MAX : DBL_MAX);
    int beyond = mpq_cmp(ret_rational, other) * mpq_sgn(ret_rational);
    if (beyond > 0) {
        status =
            fail_at_token(reader, PIR_ERR_NOT_FINITE, "'%s' is beyond the largest double", token_text(reader, text));
    } else {
        ret_number->value = mpq_get_d(ret_rational);
        mpq_set_d(other, ret_number->value);
        ret_number->exact = !mpq_equal(ret_rational, other);
    }
    mpq_clear(other);
    return status;
}

/* The last token as a coordinate of vertex `vertex`. */
static pir_status parse_number(struct reader *reader, uint32_t vertex, struct number *ret_number, mpq_t ret_rational) {
    char text[28];
    if (!copy_token(reader))
        return fail_at_token(reader, PIR_ERR_LIMIT, "a number of %zu characters in vertex %u; %d is the limit",
                             reader->length, (unsigned)vertex, TOKEN_MAX);
    enum form form = strlen(reader->buffer) == reader->length ? form_of(reader->buffer) : FORM_NONE;
    switch (form) {
    case FORM_NOT_FINITE:
        return fail_at_token(reader, PIR_ERR_NOT_FINITE, "'%s' in vertex %u is not a finite number",
                             token_text(reader, text), (unsigned)vertex);
    case FORM_NONE:
        return fail_at_token(reader, PIR_ERR_FORMAT, "'%s' in vertex %u is not a number", token_text(reader, text),
                             (unsigned)vertex);
    case FORM_INTEGER:
        if (reader->length > DBL_DIG)
            return parse_rational(reader, ret_number, ret_rational);
        break;
    case FORM_RATIONAL:
        return parse_rational(reader, ret_number, ret_rational);
    case FORM_DECIMAL:
        break;
    }
    // The nearest double; an integer of 15 digits is one.
    double value = strtod(reader->buffer, NULL);
    if (!isfinite(value))
        return fail_at_token(reader, PIR_ERR_NOT_FINITE, "'%s' is beyond the largest double", token_text(reader, text));
    *ret_number = (struct number){.value = value, .exact = false};
    return PIR_OK;
}

/* The last token as a count or an index: decimal digits, UINT64_MAX when there are more than fit. False when it is none. */
static bool parse_count(const struct reader *reader, uint64_t *ret_count) {
    uint64_t count = 0;
    for (size_t i = 0; i < reader->length; i++) {
        char c = reader->token[i];
        if (c < '0' || c > '9')
            return false;
        count = count > (UINT64_MAX - 9) / 10 ? UINT64_MAX : 10 * count + (uint64_t)(c - '0');
    }
    *ret_count = count;
    return true;
}

/* --- the file, part by part --- */

static pir_status read_header(struct reader *reader) {
    // A byte order mark, as some editors put one before UTF-8 text, is no part of the text.
    if (reader->size >= 3 && memcmp(reader->text, "\xEF\xBB\xBF", 3) == 0)
        reader->at = 3;
    if (!next_token(reader, false))
        return pir_fail(reader->report, PIR_ERR_EMPTY, "%s: the file is empty", reader->name);
    char text[28];
    if (reader->length == 3 && memcmp(reader->token, "OFF", 3) == 0)
        return PIR_OK;
    if (reader->length > 3 && reader->length < 8 && memcmp(reader->token + reader->length - 3, "OFF", 3) == 0)
        return fail_at_token(reader, PIR_ERR_FORMAT,
                             "'%s' files are not read; only plain 'OFF', three coordinates a vertex, is",
                             token_text(reader, text));
    return fail_at_token(reader, PIR_ERR_FORMAT, "the file begins with '%s', not with 'OFF'", token_text(reader, text));
}

/* The next token as the count of `what`. */
static pir_status read_count(struct reader *reader, const char *what, uint64_t *ret_count) {
    char text[28];
    if (!next_token(reader, false))
        return fail_at_token(reader, PIR_ERR_FORMAT, "the file ends before the number of %s", what);
    if (reader->length == 6 && memcmp(reader->token, "BINARY", 6) == 0)
        return fail_at_token(reader, PIR_ERR_FORMAT, "binary OFF is not read; only text is");
    if (!parse_count(reader, ret_count))
        return fail_at_token(reader, PIR_ERR_FORMAT, "the number of %s is '%s'", what, token_text(reader, text));
    return PIR_OK;
}

/* Whether the line ends here and the next line that holds anything holds three tokens, as a vertex does and a count does not. */
static bool edge_count_left_out(const struct reader *reader) {
    struct reader ahead = *reader;
    if (next_token(&ahead, true))
        return false;
    return next_token(&ahead, false) && next_token(&ahead, true) && next_token(&ahead, true);
}

/* V, F and E; E, which nobody needs, may be left out where V and F stand on a line of their own. */
static pir_status read_counts(struct reader *reader, struct model *model) {
    uint64_t vertices, facets, edges;
    pir_status status = read_count(reader, "vertices", &vertices);
    if (status)
        return status;
    size_t line = reader->token_line;
    if ((status = read_count(reader, "facets", &facets)) != PIR_OK)
        return status;
    bool left_out = reader->token_line == line && edge_count_left_out(reader);
    if (!left_out && (status = read_count(reader, "edges", &edges)) != PIR_OK)
        return status;
    if (vertices == 0)
        return fail_at_token(reader, PIR_ERR_EMPTY, "the file has no vertices");
    // The bytes left must have room for what is promised; the first division keeps the products small.
    uint64_t room = reader->size - reader->at + 1;
    if (vertices > room / VERTEX_BYTES || facets > (room - vertices * VERTEX_BYTES) / FACET_BYTES)
        return fail_at_token(reader, PIR_ERR_FORMAT,
                             "%llu vertices and %llu facets are promised; the %zu bytes that follow cannot hold them",
                             (unsigned long long)vertices, (unsigned long long)facets, reader->size - reader->at);
    model->vertex_count = (uint32_t)vertices;
    model->facet_count = (uint32_t)facets;
    return PIR_OK;
}

/* From here on the model is exact: rationals for all vertices, set for those before `done`. */
static pir_status make_exact(struct reader *reader, struct model *model, uint32_t done) {
    size_t count = 3 * (size_t)model->vertex_count;
    model->exact = PIR_NEW(&reader->allocator, mpq_t, count);
    if (!model->exact)
        return fail_memory(reader);
    for (size_t i = 0; i < count; i++)
        mpq_init(model->exact[i]);
    for (size_t v = 0; v < done; v++) {
        mpq_set_d(model->exact[3 * v], model->points[v].x);
        mpq_set_d(model->exact[3 * v + 1], model->points[v].y);
        mpq_set_d(model->exact[3 * v + 2], model->points[v].z);
    }
    return PIR_OK;
}

/* One vertex; `scratch` holds three rationals between the tokens and the model. */
static pir_status read_vertex(struct reader *reader, struct model *model, uint32_t vertex, mpq_t scratch[3]) {
    struct number numbers[3];
    pir_status status;
    for (int axis = 0; axis < 3; axis++) {
        if (!next_token(reader, false))
            return fail_at_token(reader, PIR_ERR_FORMAT, "the file ends in vertex %u of %u", (unsigned)vertex,
                                 (unsigned)model->vertex_count);
        if ((status = parse_number(reader, vertex, &numbers[axis], scratch[axis])) != PIR_OK)
            return status;
    }
    if (!model->exact && (numbers[0].exact || numbers[1].exact || numbers[2].exact))
        if ((status = make_exact(reader, model, vertex)) != PIR_OK)
            return status;
    model->points[vertex] = (pir_vec3){numbers[0].value, numbers[1].value, numbers[2].value};
    for (size_t axis = 0; model->exact && axis < 3; axis++) {
        mpq_ptr exact = model->exact[3 * (size_t)vertex + axis];
        if (numbers[axis].exact)
            mpq_set(exact, scratch[axis]);
        else
            mpq_set_d(exact, numbers[axis].value);
        mpz_lcm(model->common, model->common, mpq_denref(exact));
    }
    if (mpz_sizeinbase(model->common, 2) > DENOMINATOR_BITS_MAX)
        return fail_at_token(reader, PIR_ERR_LIMIT,
                             "the common denominator of all coordinates passes %d bits in vertex %u",
                             DENOMINATOR_BITS_MAX, (unsigned)vertex);
    return PIR_OK;
}

static pir_status read_vertices(struct reader *reader, struct model *model) {
    model->points = PIR_NEW(&reader->allocator, pir_vec3, model->vertex_count);
    if (!model->points)
        return fail_memory(reader);
    mpq_t scratch[3];
    for (int axis = 0; axis < 3; axis++)
        mpq_init(scratch[axis]);
    pir_status status = PIR_OK;
    for (uint32_t v = 0; v < model->vertex_count && status == PIR_OK; v++)
        status = read_vertex(reader, model, v, scratch);
    for (int axis = 0; axis < 3; axis++)
        mpq_clear(scratch[axis]);
    return status;
}

/* Adds the edge from `from` to `to` of a facet that starts on `line`. */
static pir_status add_edge(struct reader *reader, struct model *model, uint32_t from, uint32_t to, size_t line) {
    if (from == to)
        return fail_at_token(reader, PIR_ERR_FORMAT, "a facet has corner %u twice in a row", (unsigned)from);
    if (model->edge_count == model->edge_capacity) {
        size_t capacity = model->edge_capacity ? 2 * model->edge_capacity : 4 * (size_t)model->facet_count;
        struct pir_facet_edge *edges = PIR_RESIZE(&reader->allocator, model->edges, model->edge_capacity, capacity);
        if (!edges)
            return fail_memory(reader);
        model->edges = edges;
        model->edge_capacity = capacity;
    }
    model->edges[model->edge_count++] =
        (struct pir_facet_edge){from < to ? from : to, from < to ? to : from, (uint32_t)line};
    return PIR_OK;
}

/* The next token as a corner of facet `facet`. Some files count vertices from 1: all do or none does. */
static pir_status read_corner(struct reader *reader, struct model *model, uint32_t facet, uint32_t *ret_corner) {
    uint64_t corner;
    char text[28];
    if (!next_token(reader, false))
        return fail_at_token(reader, PIR_ERR_FORMAT, "the file ends in facet %u of %u", (unsigned)facet,
                             (unsigned)model->facet_count);
    if (!parse_count(reader, &corner))
        return fail_at_token(reader, PIR_ERR_FORMAT, "'%s' in facet %u is not an index", token_text(reader, text),
                             (unsigned)facet);
    if (corner > model->vertex_count || (corner == model->vertex_count && model->zero_line))
        return fail_at_token(reader, PIR_ERR_FORMAT, "facet %u has corner %s; there are %u vertices, counted from 0",
                             (unsigned)facet, token_text(reader, text), (unsigned)model->vertex_count);
    if (corner == 0 && model->beyond_line)
        return fail_at_token(reader, PIR_ERR_FORMAT,
                             "corner 0 here and corner %u on line %zu are one more than %u vertices",
                             (unsigned)model->vertex_count, model->beyond_line, (unsigned)model->vertex_count);
    if (corner == 0)
        model->zero_line = reader->token_line;
    if (corner == model->vertex_count)
        model->beyond_line = reader->token_line;
    *ret_corner = (uint32_t)corner;
    return PIR_OK;
}

/* One facet: its edges to the model; what follows on the line of its last corner is a colour and passed over. */
static pir_status read_facet(struct reader *reader, struct model *model, uint32_t facet) {
    char text[28];
    uint64_t size;
    if (!next_token(reader, false))
        return fail_at_token(reader, PIR_ERR_FORMAT, "the file ends before facet %u of %u", (unsigned)facet,
                             (unsigned)model->facet_count);
    size_t line = reader->token_line;
    if (!parse_count(reader, &size) || size < 3)
        return fail_at_token(reader, PIR_ERR_FORMAT, "facet %u has '%s' corners; three or more are needed",
                             (unsigned)facet, token_text(reader, text));
    if (size > (reader->size - reader->at) / 2)
        return fail_at_token(reader, PIR_ERR_FORMAT,
                             "facet %u promises %llu corners; the %zu bytes that follow cannot hold them",
                             (unsigned)facet, (unsigned long long)size, reader->size - reader->at);
    // Corners one by one, each with the edge that leads to it; a third value among them shows that there are three.
    uint32_t first = 0, second = 0, last = 0;
    bool three = false;
    for (uint64_t i = 0; i < size; i++) {
        uint32_t corner = 0;
        pir_status status = read_corner(reader, model, facet, &corner);
        if (status == PIR_OK && i > 0)
            status = add_edge(reader, model, last, corner, line);
        if (status != PIR_OK)
            return status;
        if (i == 0)
            first = corner;
        else if (i == 1)
            second = corner;
        else
            three = three || (corner != first && corner != second);
        last = corner;
    }
    if (!three)
        return fail_at_token(reader, PIR_ERR_FORMAT, "facet %u has fewer than three different corners",
                             (unsigned)facet);
    pir_status status = add_edge(reader, model, last, first, line);
    pass_line(reader);
    return status;
}

static pir_status read_facets(struct reader *reader, struct model *model) {
    for (uint32_t f = 0; f < model->facet_count; f++) {
        pir_status status = read_facet(reader, model, f);
        if (status != PIR_OK)
            return status;
    }
    char text[28];
    if (next_token(reader, false))
        return fail_at_token(reader, PIR_ERR_FORMAT, "'%s' follows the last %s", token_text(reader, text),
                             model->facet_count ? "facet" : "vertex");
    return PIR_OK;
}

/* --- the whole --- */

static pir_status read_model(struct reader *reader, struct model *model) {
    pir_status status = read_header(reader);
    if (status == PIR_OK)
        status = read_counts(reader, model);
    if (status == PIR_OK)
        status = read_vertices(reader, model);
    if (status == PIR_OK)
        status = read_facets(reader, model);
    if (status == PIR_OK)
        status = pir_check_closing(model->edges, model->edge_count, model->vertex_count + 1, &reader->allocator,
                                   reader->name, reader->report);
    return status;
}

static pir_status make_polytope(const struct reader *reader, const struct model *model,
                                const pir_polytope_options *options, pir_polytope **ret_polytope) {
    pir_status status = model->exact ? pir_polytope_create_exact((const mpq_t *)model->exact, model->vertex_count,
                                                                 options, ret_polytope)
                                     : pir_polytope_create(model->points, model->vertex_count, options, ret_polytope);
    if (status != PIR_OK)
        pir_fail(reader->report, status, "%s: the convex hull of its points: %s", reader->name,
                 pir_status_text(status));
    return status;
}

static void free_model(const struct reader *reader, struct model *model) {
    mpz_clear(model->common);
    for (size_t i = 0; model->exact && i < 3 * (size_t)model->vertex_count; i++)
        mpq_clear(model->exact[i]);
    PIR_FREE(&reader->allocator, model->exact, 3 * (size_t)model->vertex_count);
    PIR_FREE(&reader->allocator, model->edges, model->edge_capacity);
    PIR_FREE(&reader->allocator, model->points, model->vertex_count);
}

pir_status pir_polytope_read_off(const char *text, size_t size, const char *name, const pir_polytope_options *options,
                                 pir_report *report, pir_polytope **ret_polytope) {
    name = name ? pir_short_name(name) : "text";
    if ((!text && size > 0) || !ret_polytope)
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: no text, or no place for the polytope", name);
    if (size > PIR_FILE_SIZE_MAX)
        return pir_fail(report, PIR_ERR_LIMIT, "%s: larger than 2 GiB", name);
    struct pir_c_locale locale;
    if (!pir_c_locale_enter(&locale))
        return pir_fail(report, PIR_ERR_MEMORY, "%s: out of memory", name);

    struct reader reader = {.text = text, .size = size, .line = 1, .token_line = 1, .name = name, .report = report};
    reader.allocator = pir_allocator_or_default(options ? options->allocator : NULL);
    struct model model = {0};
    mpz_init_set_ui(model.common, 1);
    pir_status status = read_model(&reader, &model);
    if (status == PIR_OK)
        status = make_polytope(&reader, &model, options, ret_polytope);
    free_model(&reader, &model);
    pir_c_locale_leave(&locale);
    return status;
}
