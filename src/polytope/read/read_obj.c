/* SPDX-License-Identifier: MIT */
/*
 * Reading OBJ: one statement a line, of which `v` gives a point and `f` a facet; '#' starts a comment, a backslash
 * joins two lines.
 *
 * Statements that would add to the shape what is not read here (curves, surfaces, other files, commands) are refused,
 * since the hull would be of a part only. All others are passed over, those that OBJ does not have too, for programs
 * write statements of their own. No other file is opened, and none of materials.
 */
#include "polytope/read/readers.h"

#include <string.h>

#include "base/report.h"
#include "polytope/read/text.h"

static const char *const refused[] = {
    "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv",
    "sp",     "end", "con",  "bzp",  "bsp",  "cdc",   "cdp",  "res",  "call", "csh",
};

static bool is_refused(const struct pir_text *text) {
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++)
        if (pir_text_is(text, refused[i]))
            return true;
    return false;
}

/* Whether the last token is of printable ASCII characters, as the first word of a statement is. */
static bool is_printable(const struct pir_text *text) {
    for (const char *s = text->token; s < text->end; s++)
        if (*s <= ' ' || *s > '~')
            return false;
    return true;
}

/* v x y z, then perhaps a weight of 1 or a colour of three or four numbers. */
static pir_status read_point(struct pir_text *text, struct pir_model *model) {
    double value[8] = {0};
    size_t count = 0, line = text->token_line;
    while (pir_text_next(text, true)) {
        if (count == 7)
            return pir_text_fail(text, PIR_ERR_FORMAT, "vertex %u has more than 7 numbers", model->point_count + 1);
        pir_status status = pir_text_number(text, model->point_count + 1, &value[count++]);
        if (status != PIR_OK)
            return status;
    }
    if (count < 3 || count == 5)
        return pir_fail(text->report, PIR_ERR_FORMAT, "%s:%zu: vertex %u has %zu numbers, not 3, 4, 6 or 7", text->name,
                        line, (unsigned)(model->point_count + 1), count);
    if (count == 4 && value[3] != 1)
        return pir_fail(text->report, PIR_ERR_FORMAT, "%s:%zu: vertex %u has weight %g; only 1 is read", text->name,
                        line, (unsigned)(model->point_count + 1), value[3]);
    return pir_model_add_point(model, (pir_vec3){value[0], value[1], value[2]});
}

/* The first slash from `part` on, or `end`. */
static const char *part_end(const char *part, const char *end) {
    while (part < end && *part != '/')
        part++;
    return part;
}

/* A number in the characters up to `end` that counts from 1, or back from the last when it is negative; 0 is none. */
static bool parse_index(const char *digits, const char *end, uint64_t *ret_index, bool *ret_back) {
    *ret_back = digits < end && *digits == '-';
    return pir_digits_count(*ret_back ? digits + 1 : digits, end, ret_index) && *ret_index > 0;
}

/* The last token as a corner: point, point/texture, point//normal or point/texture/normal. */
static bool parse_corner(const struct pir_text *text, uint64_t *ret_index, bool *ret_back) {
    const char *slash = part_end(text->token, text->end);
    if (!parse_index(text->token, slash, ret_index, ret_back))
        return false;
    for (int parts = 1; slash < text->end; parts++) {
        uint64_t index;
        bool back;
        const char *part = slash + 1;
        slash = part_end(part, text->end);
        bool left_out = slash == part && parts == 1 && part < text->end;
        if (parts == 3 || (!left_out && !parse_index(part, slash, &index, &back)))
            return false;
    }
    return true;
}

/*
 * The last token as a corner of the last facet. A corner may be a point that is read later: whether there are as many
 * is looked at in the end. The index is below the size of a file.
 */
static pir_status read_corner(struct pir_text *text, struct pir_model *model) {
    uint64_t index = 0;
    bool back;
    char shown[PIR_SHOWN];
    if (!parse_corner(text, &index, &back))
        return pir_text_fail(text, PIR_ERR_FORMAT, "'%s' is not a corner of a facet, such as 1, 1/2, 1//3 or 1/2/3",
                             pir_text_show(text, shown));
    if (back && index > model->point_count)
        return pir_text_fail(text, PIR_ERR_FORMAT, "a facet has corner '%s' after %u vertices",
                             pir_text_show(text, shown), (unsigned)model->point_count);
    if (index > UINT32_MAX)
        return pir_text_fail(text, PIR_ERR_FORMAT, "a facet has corner '%s', beyond all vertices",
                             pir_text_show(text, shown));
    return pir_model_add_corner(model, (uint32_t)(back ? model->point_count - index : index - 1));
}

static pir_status read_facet(struct pir_text *text, struct pir_model *model) {
    size_t line = text->token_line;
    pir_status status = pir_model_begin_facet(model, line);
    uint32_t first = model->corner_count;
    while (status == PIR_OK && pir_text_next(text, true))
        status = read_corner(text, model);
    if (status == PIR_OK && model->corner_count - first < 3)
        status = pir_fail(text->report, PIR_ERR_FORMAT, "%s:%zu: the facet has %u corners; three or more are needed",
                          text->name, line, (unsigned)(model->corner_count - first));
    return status;
}

/* The statement that begins with the last token. */
static pir_status read_statement(struct pir_text *text, struct pir_model *model) {
    char shown[PIR_SHOWN];
    if (pir_text_is(text, "v"))
        return read_point(text, model);
    if (pir_text_is(text, "f") || pir_text_is(text, "fo"))
        return read_facet(text, model);
    if (is_refused(text))
        return pir_text_fail(text, PIR_ERR_FORMAT, "'%s' statements are not read; only points and facets are",
                             pir_text_show(text, shown));
    if (!is_printable(text))
        return pir_text_fail(text, PIR_ERR_FORMAT, "'%s' is not an OBJ statement", pir_text_show(text, shown));
    while (pir_text_next(text, true))
        ;
    return PIR_OK;
}

/* That every corner is a point. */
static pir_status check_corners(const struct pir_model *model) {
    for (uint32_t f = 0; f < model->facet_count; f++)
        for (uint32_t i = model->facet[f].start; i < pir_model_corners_end(model, f); i++)
            if (model->corner[i] >= model->point_count)
                return pir_fail(model->report, PIR_ERR_FORMAT,
                                "%s:%u: a facet has corner %lu; there are %u vertices, counted from 1", model->name,
                                (unsigned)model->facet[f].line, (unsigned long)model->corner[i] + 1,
                                (unsigned)model->point_count);
    return PIR_OK;
}

pir_status pir_read_obj(const char *data, size_t size, struct pir_model *model) {
    struct pir_text text;
    pir_text_init(&text, data, size, model->name, model->report);
    text.comments = text.folds = true;
    if (size >= 3 && memcmp(data, "\xEF\xBB\xBF", 3) == 0)
        text.at = 3;
    pir_status status = PIR_OK;
    while (status == PIR_OK && pir_text_next(&text, false))
        status = read_statement(&text, model);
    return status == PIR_OK ? check_corners(model) : status;
}
