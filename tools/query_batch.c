/* SPDX-License-Identifier: MIT */
/*
 * Lines of `x,y,z` in, lines of `x,y,z,state,distance,nx,ny,nz` out. A first line of three names is a heading; empty
 * lines are passed over. The distance is signed: minus the depth inside.
 */
#include "query_batch.h"

#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "file.h"
#include "input.h"
#include "interrupt.h"
#include "json.h"
#include "measure.h"
#include "message.h"
#include "progress.h"
#include "target.h"

/* Room for a line and its final zero. */
#define LINE_ROOM 1024

struct batch {
    const char *name; /* of the file, for complaints */
    FILE *in;
    struct output_file out;
    struct progress progress;
    uint64_t line, done, counts[3];
    uint64_t bytes_done;
    bool interrupted;
    double seconds;
};

/* The text between two commas, without the blanks around it. */
struct field {
    const char *text;
    size_t length;
};

/* --- reading --- */

/* Complains of what stands at `at` of the line `text`; false. */
static bool complain_at(const struct batch *batch, const char *text, const char *at, const char *what) {
    complain("%s:%" PRIu64 ":%zu: %s", batch->name, batch->line, (size_t)(at - text) + 1, what);
    return false;
}

/* The next line without its end; *ret_end at the end of the file. False after a complaint. */
static bool read_line(struct batch *batch, char text[LINE_ROOM], bool *ret_end) {
    size_t length = 0;
    int c;
    batch->line++;
    while ((c = getc(batch->in)) != EOF && c != '\n') {
        if (length + 1 == LINE_ROOM)
            return complain_at(batch, text, text + length, "the line goes on for more than 1023 characters");
        if (c == '\0')
            return complain_at(batch, text, text + length, "a zero byte");
        text[length++] = (char)c;
    }
    text[length] = '\0';
    batch->bytes_done += length + 1;
    *ret_end = c == EOF && length == 0;
    if (ferror(batch->in) && !interrupt_asked()) {
        complain("%s: cannot read: %s", batch->name, strerror(errno));
        return false;
    }
    return true;
}

static bool is_blank(const char *text) {
    return text[strspn(text, " \t\r\f\v")] == '\0';
}

/* The fields of a line; the first four are written to `ret_fields`. */
static size_t split(const char *text, struct field ret_fields[4]) {
    size_t count = 0;
    for (;; text++) {
        const char *end = text + strcspn(text, ",");
        const char *first = text + strspn(text, " \t\r\f\v"), *last = end;
        while (last > first && isspace((unsigned char)last[-1]))
            last--;
        if (count < 4)
            ret_fields[count] = (struct field){first, first < last ? (size_t)(last - first) : 0};
        count++;
        if (*end == '\0')
            return count;
        text = end;
    }
}

/* Three names: no field is empty or begins as a number does. */
static bool is_heading(const struct field *fields, size_t count) {
    for (size_t k = 0; k < count; k++) {
        char *end;
        strtod(fields[k].text, &end);
        if (count != 3 || fields[k].length == 0 || end != fields[k].text)
            return false;
    }
    return true;
}

/* The three numbers of a line; false after a complaint. */
static bool read_numbers(const struct batch *batch, const char *text, const struct field *fields, size_t count,
                         double v[3]) {
    char what[160];
    if (count != 3) {
        snprintf(what, sizeof what, "%zu field%s between commas, not three numbers x,y,z", count,
                 count == 1 ? "" : "s");
        return complain_at(batch, text, count > 3 ? fields[3].text : text, what);
    }
    for (size_t k = 0; k < 3; k++) {
        char *end;
        v[k] = strtod(fields[k].text, &end);
        if (fields[k].length > 0 && end == fields[k].text + fields[k].length && isfinite(v[k]))
            continue;
        snprintf(what, sizeof what, "%c: '%.*s' is not a finite number", "xyz"[k],
                 fields[k].length < 64 ? (int)fields[k].length : 64, fields[k].text);
        return complain_at(batch, text, fields[k].text, what);
    }
    return true;
}

/* --- answering --- */

static bool answer_line(struct batch *batch, pir_query *query, pir_query_input *input, pir_query_cache *cache,
                        const char *text) {
    static const char *const state_names[] = {"outside", "boundary", "inside"};
    struct field fields[4];
    double v[3];
    size_t count = split(text, fields);
    if (batch->line == 1 && is_heading(fields, count))
        return true;
    if (!read_numbers(batch, text, fields, count, v))
        return false;
    pir_query_result r;
    input->translation = (pir_vec3){v[0], v[1], v[2]};
    pir_status status = pir_query_signed_distance(query, input, cache, &r);
    if (status != PIR_OK)
        return complain_at(batch, text, text, status == PIR_ERR_LIMIT ? "x,y,z: too large" : pir_status_text(status));
    // + 0.0 turns −0 into 0
    fprintf(batch->out.stream, "%.17g,%.17g,%.17g,%s,%.17g,%.17g,%.17g,%.17g\n", v[0], v[1], v[2], state_names[r.state],
            r.distance, r.normal.x + 0.0, r.normal.y + 0.0, r.normal.z + 0.0);
    batch->counts[r.state]++;
    batch->done++;
    return true;
}

static bool answer_all(struct batch *batch, pir_query *query, const pir_query_input *common) {
    char text[LINE_ROOM];
    bool end = false;
    pir_query_input input = *common;
    pir_query_cache cache = {0};
    fprintf(batch->out.stream, "x,y,z,state,distance,nx,ny,nz\n");
    while (!interrupt_asked()) {
        if (!read_line(batch, text, &end))
            return false;
        if (end || interrupt_asked())
            break;
        if (!is_blank(text) && !answer_line(batch, query, &input, &cache, text))
            return false;
        progress_show(&batch->progress, batch->bytes_done);
    }
    batch->interrupted = interrupt_asked();
    if (batch->done == 0 && !batch->interrupted)
        complain("%s: holds no translation", batch->name);
    return batch->done > 0 || batch->interrupted;
}

/* The bytes of a regular file, 0 of another. */
static uint64_t size_of(FILE *file) {
    struct stat about;
    return fstat(fileno(file), &about) == 0 && S_ISREG(about.st_mode) ? (uint64_t)about.st_size : 0;
}

/* Runs through the open files; answers that stop in the middle of a file are kept only where they are already out. */
static bool answer_file(struct batch *batch, pir_query *query, const pir_query_input *input) {
    batch->progress = progress_new(size_of(batch->in));
    interrupt_put_off(true);
    bool done = answer_all(batch, query, input);
    interrupt_put_off(false);
    progress_end(&batch->progress);
    if (done && !(batch->interrupted && batch->out.temporary))
        done = output_commit(&batch->out);
    return done;
}

static bool report(const struct args *args, const struct batch *batch) {
    if (!args_has(args, "--json")) {
        say("%" PRIu64 " placements%s: %" PRIu64 " outside, %" PRIu64 " boundary, %" PRIu64 " inside\n", batch->done,
            batch->interrupted ? ", then interrupted" : "", batch->counts[0], batch->counts[1], batch->counts[2]);
        return true;
    }
    struct json json = json_new();
    json_add_count(&json, json.root, "placements", batch->done);
    json_add_count(&json, json.root, "outside", batch->counts[0]);
    json_add_count(&json, json.root, "boundary", batch->counts[1]);
    json_add_count(&json, json.root, "inside", batch->counts[2]);
    json_add_flag(&json, json.root, "interrupted", batch->interrupted);
    json_add_number(&json, json.root, "seconds", batch->seconds);
    return json_print(&json, stdout);
}

static bool open_lines(struct batch *batch, const char *path) {
    bool standard = input_is_stdin(path);
    batch->name = standard ? INPUT_NAME : path;
    if (standard && !input_take())
        return false;
    batch->in = standard ? stdin : fopen(path, "r");
    if (!batch->in)
        complain("%s: cannot open: %s", path, strerror(errno));
    return batch->in != NULL;
}

int query_batch_run(const struct args *args, pir_query *query, const pir_query_input *input, int64_t start) {
    struct batch batch = {0};
    if (!open_lines(&batch, args_value(args, "--batch")))
        return EXIT_BAD_INPUT;
    bool quiet = target_is_stdout(args, "-o");
    bool done = output_open(&batch.out, args_value(args, "-o")) && answer_file(&batch, query, input);
    batch.seconds = (double)(clock_now() - start) / 1e9;
    output_discard(&batch.out);
    if (batch.in != stdin)
        fclose(batch.in);
    return done && (quiet || report(args, &batch)) ? EXIT_DONE : EXIT_BAD_INPUT;
}
