/* SPDX-License-Identifier: MIT */
/*
 * Reading text: tokens between blanks, each remembered with its line, and the numbers that they spell. Every failure is
 * reported as "name:line: what".
 */
#ifndef PIR_POLYTOPE_READ_TEXT_H
#define PIR_POLYTOPE_READ_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <gmp.h>

#include <pirouette/base.h>

/* The longest number read: enough for any double written out in full, and exact arithmetic stays affordable. */
#define PIR_TOKEN_MAX 4096

struct pir_text {
    const char *text;
    size_t size, at; /* at: the first byte not yet read */
    size_t line;     /* the line of that byte, from 1 */
    const char *name;
    pir_report *report;
    bool comments;           /* '#' starts a comment, which ends with its line */
    bool folds;              /* a backslash before the end of a line joins the next one to it */
    const char *token, *end; /* the last token, up to the byte at `end`, and its line */
    size_t token_line;
    char buffer[PIR_TOKEN_MAX + 1]; /* the token as a zero-terminated string */
};

void pir_text_init(struct pir_text *text, const char *bytes, size_t size, const char *name, pir_report *report);

/* The next token, or false at the end of the text or, with `same_line`, of the line. */
bool pir_text_next(struct pir_text *text, bool same_line);

/* How many bytes the last token has. */
static inline size_t pir_text_length(const struct pir_text *text) {
    return (size_t)(text->end - text->token);
}

/* Passes what is left of the line, not its end. */
void pir_text_pass_line(struct pir_text *text);

/* Whether the last token is `word`, as it stands or whatever the case of its letters; `word` is in lower case then. */
bool pir_text_is(const struct pir_text *text, const char *word);
bool pir_text_is_word(const struct pir_text *text, const char *word);

/* The last token as a string for reports: printable ASCII, cut when long. */
#define PIR_SHOWN 28
const char *pir_text_show(const struct pir_text *text, char ret_shown[PIR_SHOWN]);

/* Reports "name:line: ...", the line being that of the last token. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
pir_status
pir_text_fail(const struct pir_text *text, pir_status status, const char *format, ...);

/*
 * The last token as a finite number. A coordinate of point `point`, for reports: "'abc' in vertex 7 is not a number".
 * Decimal digits with a point and an exponent are the nearest double. With `exact`, which is initialised, a/b is that
 * rational and an integer itself: *ret_exact says whether `exact` was set because no double is it, and *ret_value is
 * then beside it.
 */
pir_status pir_text_number(struct pir_text *text, uint32_t point, double *ret_value);
pir_status pir_text_exact_number(struct pir_text *text, uint32_t point, double *ret_value, bool *ret_exact,
                                 mpq_t exact);

/* Whether the last token is a number, perhaps "nan" or "inf". */
bool pir_text_is_number(struct pir_text *text);

/* The last token as a count or an index: decimal digits, UINT64_MAX when there are more than fit. False when it is
 * none. */
bool pir_text_count(const struct pir_text *text, uint64_t *ret_count);

/* The count that the characters from `digits` up to the one at `end` spell. */
bool pir_digits_count(const char *digits, const char *end, uint64_t *ret_count);

#endif
