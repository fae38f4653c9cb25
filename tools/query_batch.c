/* SPDX-License-Identifier: MIT */
/*
 * Lines of `x,y,z` in, lines of `x,y,z,state,distance,nx,ny,nz` out. A first line that is no numbers is a heading; empty lines
 * are passed over. The distance is signed: minus the depth inside.
 */
#include "query_batch.h"

#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "json.h"
#include "message.h"
#include "progress.h"

#define LINE_MAX_LENGTH 1024

struct batch {
    const char *path;
    FILE *in;
    struct output_file out;
    struct progress progress;
    uint64_t line, done, counts[3];
    uint64_t bytes, bytes_done;
};

/* Three numbers between commas and nothing else. */
static bool read_numbers(const char *text, double v[3]) {
    for (int k = 0; k < 3; k++) {
        char *end;
        v[k] = strtod(text, &end);
        if (end == text || !isfinite(v[k]))
            return false;
        while (isspace((unsigned char)*end))
            end++;
        if (*end != (k < 2 ? ',' : 0))
            return false;
        text = end + 1;
    }
    return true;
}

static bool is_blank(const char *text) {
    while (isspace((unsigned char)*text))
        text++;
    return *text == 0;
}

static bool answer_line(struct batch *batch, pir_query *query, pir_query_input *input, pir_query_cache *cache,
                        const char *text) {
    static const char *const state_names[] = {"outside", "boundary", "inside"};
    double v[3];
    if (!read_numbers(text, v)) {
        if (batch->line == 1)
            return true;
        complain("%s:%" PRIu64 ": not three finite numbers x,y,z", batch->path, batch->line);
        return false;
    }
    pir_query_result r;
    input->translation = (pir_vec3){v[0], v[1], v[2]};
    pir_status status = pir_query_signed_distance(query, input, cache, &r);
    if (status != PIR_OK) {
        complain("%s:%" PRIu64 ": %s", batch->path, batch->line, pir_status_text(status));
        return false;
    }
    fprintf(batch->out.stream, "%.17g,%.17g,%.17g,%s,%.17g,%.17g,%.17g,%.17g\n", v[0], v[1], v[2], state_names[r.state],
            r.distance, r.normal.x, r.normal.y, r.normal.z);
    batch->counts[r.state]++;
    batch->done++;
    return true;
}

static bool answer_all(struct batch *batch, pir_query *query, const pir_query_input *common) {
    char text[LINE_MAX_LENGTH];
    pir_query_input input = *common;
    pir_query_cache cache = {0};
    fprintf(batch->out.stream, "x,y,z,state,distance,nx,ny,nz\n");
    while (fgets(text, sizeof text, batch->in)) {
        batch->line++;
        size_t length = strlen(text);
        batch->bytes_done += length;
        if (length + 1 == sizeof text && text[length - 1] != '\n') {
            complain("%s:%" PRIu64 ": a line longer than %d characters", batch->path, batch->line, LINE_MAX_LENGTH - 2);
            return false;
        }
        if (!is_blank(text) && !answer_line(batch, query, &input, &cache, text))
            return false;
        progress_show(&batch->progress, batch->bytes_done);
    }
    if (ferror(batch->in)) {
        complain("%s: cannot be read: %s", batch->path, strerror(errno));
        return false;
    }
    if (batch->done == 0)
        complain("%s: holds no translation", batch->path);
    return batch->done > 0;
}

static uint64_t size_of(FILE *file) {
    if (fseek(file, 0, SEEK_END) != 0)
        return 0;
    long size = ftell(file);
    rewind(file);
    return size > 0 ? (uint64_t)size : 0;
}

static bool report(const struct args *args, const struct batch *batch) {
    if (!args_has(args, "--json")) {
        printf("%" PRIu64 " placements: %" PRIu64 " outside, %" PRIu64 " boundary, %" PRIu64 " inside\n", batch->done,
               batch->counts[0], batch->counts[1], batch->counts[2]);
        return true;
    }
    struct json json = json_new();
    json_add_number(&json, json.root, "placements", (double)batch->done);
    json_add_number(&json, json.root, "outside", (double)batch->counts[0]);
    json_add_number(&json, json.root, "boundary", (double)batch->counts[1]);
    json_add_number(&json, json.root, "inside", (double)batch->counts[2]);
    return json_print(&json, stdout);
}

int query_batch_run(const struct args *args, pir_query *query, const pir_query_input *input) {
    struct batch batch = {.path = args_value(args, "--batch")};
    batch.in = fopen(batch.path, "r");
    if (!batch.in)
        return complain("%s: cannot be opened: %s", batch.path, strerror(errno));
    bool done = output_open(&batch.out, args_value(args, "-o"));
    if (done) {
        batch.progress = progress_new(size_of(batch.in));
        done = answer_all(&batch, query, input);
        progress_end(&batch.progress);
        done = done && output_commit(&batch.out);
    }
    output_discard(&batch.out);
    fclose(batch.in);
    return done && report(args, &batch) ? EXIT_DONE : EXIT_BAD_INPUT;
}
