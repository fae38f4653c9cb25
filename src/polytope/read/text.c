/* SPDX-License-Identifier: MIT */
/* Tokens and numbers of a text; see text.h. The C locale is the caller's to set. */
#include "polytope/read/text.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/report.h"

void pir_text_init(struct pir_text *text, const char *bytes, size_t size, const char *name, pir_report *report) {
    *text = (struct pir_text){.text = bytes,
                              .size = size,
                              .line = 1,
                              .name = name,
                              .report = report,
                              .token = bytes,
                              .end = bytes,
                              .token_line = 1};
}

pir_status pir_text_fail(const struct pir_text *text, pir_status status, const char *format, ...) {
    char what[200];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    return pir_fail(text->report, status, "%s:%zu: %s", text->name, text->token_line, what);
}

/* --- tokens --- */

static bool is_line_end(char c) {
    return c == '\n' || c == '\r';
}

static bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\f' || c == '\v' || is_line_end(c);
}

/* Passes one byte; "\r\n", "\n" and a lone "\r" each end one line. */
static void pass_byte(struct pir_text *text) {
    char c = text->text[text->at++];
    if (c == '\n' || (c == '\r' && !(text->at < text->size && text->text[text->at] == '\n')))
        text->line++;
}

void pir_text_pass_line(struct pir_text *text) {
    while (text->at < text->size && !is_line_end(text->text[text->at]))
        text->at++;
}

/* Whether a backslash that joins two lines is next. */
static bool at_fold(const struct pir_text *text) {
    return text->folds && text->at + 1 < text->size && text->text[text->at] == '\\' &&
           is_line_end(text->text[text->at + 1]);
}

/* Passes the backslash and the end of the line after it. */
static void pass_fold(struct pir_text *text) {
    text->at++;
    if (text->at < text->size && text->text[text->at] == '\r')
        pass_byte(text);
    if (text->at < text->size && text->text[text->at] == '\n')
        pass_byte(text);
}

/* Passes blanks, folds and comments, and line ends too unless `same_line`. */
static void pass_blank(struct pir_text *text, bool same_line) {
    while (text->at < text->size) {
        char c = text->text[text->at];
        if (c == '#' && text->comments)
            pir_text_pass_line(text);
        else if (at_fold(text))
            pass_fold(text);
        else if (is_space(c) && !(same_line && is_line_end(c)))
            pass_byte(text);
        else
            return;
    }
}

bool pir_text_next(struct pir_text *text, bool same_line) {
    pass_blank(text, same_line);
    if (text->at >= text->size || is_line_end(text->text[text->at]))
        return false;
    text->token = text->text + text->at;
    text->token_line = text->line;
    while (text->at < text->size && !is_space(text->text[text->at]) &&
           !(text->comments && text->text[text->at] == '#') && !at_fold(text))
        text->at++;
    text->end = text->text + text->at;
    return true;
}

bool pir_text_is(const struct pir_text *text, const char *word) {
    for (const char *s = text->token; s < text->end; s++, word++)
        if (*word == '\0' || *s != *word)
            return false;
    return *word == '\0';
}

static char lower_case(char c) {
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

bool pir_text_is_word(const struct pir_text *text, const char *word) {
    for (const char *s = text->token; s < text->end; s++, word++)
        if (*word == '\0' || lower_case(*s) != *word)
            return false;
    return *word == '\0';
}

const char *pir_text_show(const struct pir_text *text, char ret_shown[PIR_SHOWN]) {
    const char *s = text->token;
    size_t length = 0;
    for (; s < text->end && length < PIR_SHOWN - 4; s++)
        ret_shown[length++] = *s > ' ' && *s <= '~' ? *s : '?';
    strcpy(ret_shown + length, s < text->end ? "..." : "");
    return ret_shown;
}

static bool copy_token(struct pir_text *text) {
    size_t length = 0;
    for (const char *s = text->token; s < text->end && length < PIR_TOKEN_MAX; s++)
        text->buffer[length++] = *s;
    text->buffer[length] = '\0';
    return length == pir_text_length(text);
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
        if (lower_case(*s) != *word)
            return false;
    return *s == *word;
}

/* The form of a number. Only decimal digits count: hexadecimal floats are no numbers here. */
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

/* The form of the last token, copied to the buffer; a zero byte in it makes it none. */
static enum form form_of_token(struct pir_text *text) {
    return copy_token(text) && strlen(text->buffer) == pir_text_length(text) ? form_of(text->buffer) : FORM_NONE;
}

bool pir_text_is_number(struct pir_text *text) {
    enum form form = form_of_token(text);
    return form == FORM_INTEGER || form == FORM_DECIMAL || form == FORM_NOT_FINITE;
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

/* An integer or a/b, of any length: a double where it is one, else the rational, which must lie between the largest
 * doubles. */
static pir_status parse_rational(struct pir_text *text, double *ret_value, bool *ret_exact, mpq_t exact) {
    char shown[PIR_SHOWN];
    if (!set_rational(text->buffer, exact))
        return pir_text_fail(text, PIR_ERR_FORMAT, "division by zero in '%s'", pir_text_show(text, shown));
    pir_status status = PIR_OK;
    mpq_t other;
    mpq_init(other);
    mpq_set_d(other, mpq_sgn(exact) < 0 ? -DBL_MAX : DBL_MAX);
    int beyond = mpq_cmp(exact, other) * mpq_sgn(exact);
    if (beyond > 0) {
        status =
            pir_text_fail(text, PIR_ERR_NOT_FINITE, "'%s' is beyond the largest double", pir_text_show(text, shown));
    } else {
        *ret_value = mpq_get_d(exact);
        mpq_set_d(other, *ret_value);
        *ret_exact = !mpq_equal(exact, other);
    }
    mpq_clear(other);
    return status;
}

/* The nearest double of the buffer. */
static pir_status parse_decimal(const struct pir_text *text, double *ret_value) {
    char shown[PIR_SHOWN];
    double value = strtod(text->buffer, NULL);
    if (!isfinite(value))
        return pir_text_fail(text, PIR_ERR_NOT_FINITE, "'%s' is beyond the largest double", pir_text_show(text, shown));
    *ret_value = value;
    return PIR_OK;
}

/* `exact` is NULL where only decimals are numbers. */
static pir_status parse_number(struct pir_text *text, uint32_t point, double *ret_value, bool *ret_exact,
                               mpq_ptr exact) {
    char shown[PIR_SHOWN];
    if (pir_text_length(text) > PIR_TOKEN_MAX)
        return pir_text_fail(text, PIR_ERR_LIMIT, "a number of %zu characters in vertex %u; %d is the limit",
                             pir_text_length(text), (unsigned)point, PIR_TOKEN_MAX);
    enum form form = form_of_token(text);
    *ret_exact = false;
    if (form == FORM_NOT_FINITE)
        return pir_text_fail(text, PIR_ERR_NOT_FINITE, "'%s' in vertex %u is not a finite number",
                             pir_text_show(text, shown), (unsigned)point);
    if (form == FORM_NONE || (form == FORM_RATIONAL && !exact))
        return pir_text_fail(text, PIR_ERR_FORMAT, "'%s' in vertex %u is not a number", pir_text_show(text, shown),
                             (unsigned)point);
    // an integer of 15 digits is a double
    if (exact && (form == FORM_RATIONAL || (form == FORM_INTEGER && pir_text_length(text) > DBL_DIG)))
        return parse_rational(text, ret_value, ret_exact, exact);
    return parse_decimal(text, ret_value);
}

pir_status pir_text_number(struct pir_text *text, uint32_t point, double *ret_value) {
    bool exact;
    return parse_number(text, point, ret_value, &exact, NULL);
}

pir_status pir_text_exact_number(struct pir_text *text, uint32_t point, double *ret_value, bool *ret_exact,
                                 mpq_t exact) {
    return parse_number(text, point, ret_value, ret_exact, exact);
}

bool pir_digits_count(const char *digits, const char *end, uint64_t *ret_count) {
    uint64_t count = 0;
    for (const char *s = digits; s < end; s++) {
        if (*s < '0' || *s > '9')
            return false;
        count = count > (UINT64_MAX - 9) / 10 ? UINT64_MAX : 10 * count + (uint64_t)(*s - '0');
    }
    *ret_count = count;
    return digits < end;
}

bool pir_text_count(const struct pir_text *text, uint64_t *ret_count) {
    return pir_digits_count(text->token, text->end, ret_count);
}
