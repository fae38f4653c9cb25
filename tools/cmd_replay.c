/* SPDX-License-Identifier: MIT */
/* pirouette replay: a history of calls is run again, with hashes of what they give. */
#include <inttypes.h>
#include <stdio.h>

#include <pirouette/history.h>

#include "args.h"
#include "cmd.h"
#include "json.h"
#include "message.h"

/* The output of a run; `json` is NULL where lines are printed. */
struct run {
    struct json *json;
    cJSON *steps;
    uint64_t count, refused, hash;
};

static void tell(void *context, const pir_history_step *step) {
    struct run *run = context;
    char hash[17];
    snprintf(hash, sizeof hash, "%016" PRIx64, step->hash);
    run->count++;
    run->refused += step->status != PIR_OK;
    // one number for all steps: the statuses count
    run->hash = (run->hash ^ step->hash ^ (uint64_t)step->status) * UINT64_C(0x100000001b3);
    if (!run->json) {
        say("%8" PRIu64 " %-10s %s%s%s\n", step->index, step->call, hash, step->status == PIR_OK ? "" : " ",
            step->status == PIR_OK ? "" : pir_status_text(step->status));
        return;
    }
    cJSON *at = json_add_object(run->json, run->steps, NULL);
    json_add_text(run->json, at, "call", step->call);
    json_add_text(run->json, at, "hash", hash);
    if (step->status != PIR_OK)
        json_add_text(run->json, at, "refused", pir_status_text(step->status));
}

static bool print_json(struct run *run, const char *path) {
    char hash[17];
    snprintf(hash, sizeof hash, "%016" PRIx64, run->hash);
    json_add_text(run->json, run->json->root, "file", path);
    json_add_count(run->json, run->json->root, "calls", run->count);
    json_add_count(run->json, run->json->root, "refused", run->refused);
    json_add_text(run->json, run->json->root, "hash", hash);
    return json_print(run->json, stdout);
}

SUBCOMMAND(replay) {
    const char *path = args->positional[0];
    struct json json = json_new();
    struct run run = {.hash = UINT64_C(0xcbf29ce484222325)};
    if (args_has(args, "--json")) {
        run.json = &json;
        run.steps = json_add_array(&json, json.root, "steps");
    }
    const pir_history_visitor visitor = {NULL, &run, tell};
    pir_report report = {PIR_OK, ""};
    pir_status status = pir_history_replay(path, &visitor, &report);
    if (status != PIR_OK) {
        json_discard(&json);
        return complain_status(path, status, &report);
    }
    if (run.json)
        return print_json(&run, path) ? EXIT_DONE : EXIT_BAD_INPUT;
    json_discard(&json);
    say("%s: %" PRIu64 " calls, %" PRIu64 " refused, hash %016" PRIx64 "\n", path, run.count, run.refused, run.hash);
    return EXIT_DONE;
}
