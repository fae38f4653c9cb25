/* SPDX-License-Identifier: MIT */
/* pirouette clash: what two solids, or any two of many, have in common. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/exact.h>

#include "clash_picture.h"
#include "cmd.h"
#include "json.h"
#include "measure.h"
#include "message.h"
#include "models.h"
#include "solid.h"
#include "target.h"
#include "text.h"

/* A model that is no solid, and why. */
struct refused {
    char *name, *why;
};

struct clash_run {
    const struct args *args;
    struct clash_body *body;
    size_t count, room;
    struct refused *refused;
    size_t refused_count, refused_room;
    struct clash_found *found;  /* those that are told, in order */
    size_t found_count, looked; /* and how many pairs were looked at */
    double within, tolerance;
    int64_t spent; /* on bodies and verdicts, in nanoseconds */
};

static const char *const kind_names[] = {"apart", "touching", "protrusion", "piercing", "envelope", "duplicate"};
static const char *const shared_names[] = {"nothing", "points", "edges", "facets", "volume"};

/* --- solids --- */

/* One more element at the end of an array, zeroed; NULL after a complaint. */
static void *grow(void **array, size_t *room, size_t count, size_t size) {
    if (count == *room) {
        void *grown = realloc(*array, (2 * count + 16) * size);
        if (!grown) {
            complain("clash: out of memory");
            return NULL;
        }
        *array = grown;
        *room = 2 * count + 16;
    }
    return memset((char *)*array + count * size, 0, size);
}

static char *copy_of(const char *text) {
    char *copy = malloc(strlen(text) + 1);
    return copy ? strcpy(copy, text) : NULL;
}

/* Notes a model that is not answered for. One complaint on stderr names it; the others are answered. */
static bool refuse(struct clash_run *run, const char *name, pir_status status, const pir_report *report) {
    const char *why = report->text[0] ? report->text : pir_status_text(status);
    struct refused *refused = grow((void **)&run->refused, &run->refused_room, run->refused_count, sizeof *refused);
    if (!refused)
        return false;
    refused->name = copy_of(name);
    refused->why = copy_of(why);
    run->refused_count++;
    complain("%s: %s", name, why);
    return refused->name && refused->why;
}

/* Takes a solid and makes it ready. */
static bool add_solid(struct clash_run *run, const char *name, pir_solid *solid) {
    struct clash_body *body = grow((void **)&run->body, &run->room, run->count, sizeof *body);
    pir_report report = {0};
    pir_solid_options options = pir_solid_options_default();
    options.report = &report;
    if (!body) {
        pir_solid_release(solid);
        return false;
    }
    const int64_t start = clock_now();
    const pir_status status = pir_clash_body_create(solid, &options, &body->body);
    run->spent += clock_now() - start;
    body->solid = solid;
    body->name = copy_of(name);
    run->count++;
    if (status == PIR_OK && body->name)
        return true;
    run->count--;
    pir_solid_release(solid);
    const bool on = body->name && refuse(run, name, status, &report);
    free(body->name);
    return on;
}

static bool take_solid(void *context, const struct found_model *model) {
    struct clash_run *run = context;
    pir_solid *solid = NULL;
    pir_report report = {0};
    const size_t size = model->text ? strlen(model->text) : 0;
    const pir_file_bytes file = {model->text, size, model->name, "obj"};
    const pir_status status = model->text ? pir_solid_read_bytes(&file, NULL, &report, &solid)
                                          : pir_solid_read(model->path, NULL, &report, &solid);
    return status == PIR_OK ? add_solid(run, model->name, solid) : refuse(run, model->name, status, &report);
}

/* Reads A and B, or all models of a folder or a file. */
static bool read_solids(struct clash_run *run) {
    const struct args *args = run->args;
    if (args->positional_count == 1)
        return models_each(args, args->positional[0], take_solid, run);
    for (size_t i = 0; i < 2; i++) {
        pir_solid *solid = solid_load(args, i);
        if (!solid || !add_solid(run, args->positional[i], solid))
            return false;
    }
    return run->count == 2;
}

/* --- verdicts --- */

/* The pairs that may be within the length, or of two solids theirs; to be freed. */
static pir_status list_pairs(const struct clash_run *run, pir_clash_pair **ret_pairs, size_t *ret_count) {
    pir_clash_body **body = malloc((run->count + 1) * sizeof(*body));
    if (!body)
        return PIR_ERR_MEMORY;
    for (size_t i = 0; i < run->count; i++)
        body[i] = run->body[i].body;
    const bool is_pair = run->args->positional_count == 2;
    *ret_count = is_pair;
    pir_status status = is_pair ? PIR_OK : pir_clash_pairs(body, run->count, run->within, 0, NULL, ret_count);
    *ret_pairs = status == PIR_OK ? calloc(*ret_count + 1, sizeof **ret_pairs) : NULL;
    if (status == PIR_OK && !*ret_pairs)
        status = PIR_ERR_MEMORY;
    if (status == PIR_OK && is_pair)
        (*ret_pairs)[0] = (pir_clash_pair){0, 1};
    else if (status == PIR_OK)
        status = pir_clash_pairs(body, run->count, run->within, *ret_count, *ret_pairs, ret_count);
    free(body);
    return status;
}

/* Whether a verdict is told: of many solids those that are apart by more than the length are counted only. */
static bool is_told(const struct clash_run *run, const pir_clash_verdict *verdict) {
    return run->args->positional_count == 2 || verdict->kind != PIR_CLASH_APART || verdict->distance <= run->within;
}

static pir_status judge_pairs(struct clash_run *run, const pir_clash_pair *pairs, size_t count) {
    pir_workspace *workspace = NULL;
    pir_status status = pir_workspace_create(NULL, &workspace);
    run->found = calloc(count + 1, sizeof *run->found);
    run->looked = count;
    if (!run->found)
        status = PIR_ERR_MEMORY;
    for (size_t i = 0; i < count && status == PIR_OK; i++) {
        struct clash_found *found = &run->found[run->found_count];
        found->pair = pairs[i];
        status = pir_clash(run->body[pairs[i].a].body, run->body[pairs[i].b].body, workspace, &found->verdict);
        found->minor = found->verdict.kind > PIR_CLASH_TOUCHING && found->verdict.depth <= run->tolerance;
        run->found_count += status == PIR_OK && is_told(run, &found->verdict);
    }
    pir_workspace_destroy(workspace);
    return status;
}

/* Clashes first, those within the tolerance last among them; then touching, then apart; the deeper first. */
static int compare_found(const void *a, const void *b) {
    const struct clash_found *x = a, *y = b;
    const bool clash[2] = {x->verdict.kind > PIR_CLASH_TOUCHING, y->verdict.kind > PIR_CLASH_TOUCHING};
    if (clash[0] != clash[1])
        return clash[0] ? -1 : 1;
    if (x->minor != y->minor)
        return x->minor ? 1 : -1;
    if (!clash[0] && x->verdict.kind != y->verdict.kind)
        return x->verdict.kind == PIR_CLASH_TOUCHING ? -1 : 1;
    if (x->verdict.depth != y->verdict.depth)
        return x->verdict.depth > y->verdict.depth ? -1 : 1;
    if (x->verdict.volume != y->verdict.volume)
        return x->verdict.volume > y->verdict.volume ? -1 : 1;
    if (x->verdict.distance != y->verdict.distance)
        return x->verdict.distance < y->verdict.distance ? -1 : 1;
    if (x->pair.a != y->pair.a)
        return x->pair.a < y->pair.a ? -1 : 1;
    return (x->pair.b > y->pair.b) - (x->pair.b < y->pair.b);
}

static bool judge_all(struct clash_run *run) {
    pir_clash_pair *pairs = NULL;
    size_t count = 0;
    const int64_t start = clock_now();
    pir_status status = list_pairs(run, &pairs, &count);
    if (status == PIR_OK)
        status = judge_pairs(run, pairs, count);
    free(pairs);
    if (status != PIR_OK) {
        complain_status("clash", status, NULL);
        return false;
    }
    qsort(run->found, run->found_count, sizeof *run->found, compare_found);
    run->spent += clock_now() - start;
    return true;
}

/* --- printing --- */

static void add_vector(struct json *json, cJSON *parent, const char *name, pir_vec3 v) {
    json_add_numbers(json, parent, name, (const double[]){v.x + 0.0, v.y + 0.0, v.z + 0.0}, 3);
}

static void add_exact(struct json *json, cJSON *parent, const struct clash_run *run, const struct clash_found *found) {
    mpq_t volume;
    mpq_init(volume);
    if (pir_clash_volume_exact(run->body[found->pair.a].body, run->body[found->pair.b].body, volume) == PIR_OK) {
        char *text = mpq_get_str(NULL, 10, volume);
        json_add_text(json, parent, "volume_exact", text);
        free(text);
    }
    mpq_clear(volume);
}

static void add_pair(struct json *json, cJSON *pairs, const struct clash_run *run, const struct clash_found *found) {
    const pir_clash_verdict *v = &found->verdict;
    cJSON *pair = json_add_object(json, pairs, NULL);
    json_add_text(json, pair, "a", run->body[found->pair.a].name);
    json_add_text(json, pair, "b", run->body[found->pair.b].name);
    json_add_text(json, pair, "kind", kind_names[v->kind]);
    json_add_text(json, pair, "shared", shared_names[v->dimension + 1]);
    if (v->kind == PIR_CLASH_APART) {
        json_add_number(json, pair, "distance", v->distance);
        add_vector(json, pair, "point_a", v->point_a);
        add_vector(json, pair, "point_b", v->point_b);
    }
    if (v->kind <= PIR_CLASH_TOUCHING)
        return;
    json_add_number(json, pair, "depth", v->depth);
    add_vector(json, pair, "direction", v->direction);
    json_add_number(json, pair, "volume", v->volume);
    add_exact(json, pair, run, found);
    json_add_flag(json, pair, "a_in_b", v->a_in_b);
    json_add_flag(json, pair, "b_in_a", v->b_in_a);
    json_add_flag(json, pair, "a_is_cut", v->a_is_cut);
    json_add_flag(json, pair, "b_is_cut", v->b_is_cut);
    json_add_flag(json, pair, "minor", found->minor);
}

static size_t count_kind(const struct clash_run *run, pir_clash_kind kind) {
    size_t count = 0;
    for (size_t i = 0; i < run->found_count; i++)
        count += run->found[i].verdict.kind == kind;
    return count;
}

static bool print_json(const struct clash_run *run) {
    struct json json = json_new();
    json_add_count(&json, json.root, "solids", run->count);
    json_add_count(&json, json.root, "pairs_looked_at", run->looked);
    cJSON *counts = json_add_object(&json, json.root, "counts");
    for (int kind = PIR_CLASH_APART; kind <= PIR_CLASH_DUPLICATE; kind++)
        json_add_count(&json, counts, kind_names[kind], count_kind(run, (pir_clash_kind)kind));
    cJSON *pairs = json_add_array(&json, json.root, "pairs");
    for (size_t i = 0; i < run->found_count; i++)
        add_pair(&json, pairs, run, &run->found[i]);
    cJSON *refused = json_add_array(&json, json.root, "refused");
    for (size_t i = 0; i < run->refused_count; i++) {
        cJSON *model = json_add_object(&json, refused, NULL);
        json_add_text(&json, model, "model", run->refused[i].name);
        json_add_text(&json, model, "why", run->refused[i].why);
    }
    json_add_number(&json, json.root, "seconds", (double)run->spent / 1e9);
    return json_print(&json, stdout);
}

static void print_pair(const struct clash_run *run, const struct clash_found *found) {
    char number[TEXT_NUMBER], depth[TEXT_NUMBER];
    const pir_clash_verdict *v = &found->verdict;
    text_double(v->depth, depth);
    say("  %-10s %s, %s: ", kind_names[v->kind], run->body[found->pair.a].name, run->body[found->pair.b].name);
    text_double(v->kind == PIR_CLASH_APART ? v->distance : v->volume, number);
    if (v->kind == PIR_CLASH_APART)
        say("by %s\n", number);
    else if (v->kind == PIR_CLASH_TOUCHING)
        say("they share %s\n", shared_names[v->dimension + 1]);
    else
        say("%s deep, they share the volume %s%s\n", depth, number, found->minor ? ", within the tolerance" : "");
}

static void print_text(const struct clash_run *run) {
    char time[TEXT_NUMBER];
    text_time((double)run->spent, time);
    say("%zu solids\n", run->count);
    for (size_t i = 0; i < run->found_count; i++)
        print_pair(run, &run->found[i]);
    for (int kind = PIR_CLASH_APART; kind <= PIR_CLASH_DUPLICATE; kind++)
        say("  %-10s %zu\n", kind_names[kind], count_kind(run, (pir_clash_kind)kind));
    say("  %-10s %s, %zu pairs looked at\n", "time", time, run->looked);
}

/* --- the whole --- */

static bool read_options(struct clash_run *run) {
    if (!args_numbers(run->args, "--within", 1, &run->within) ||
        !args_numbers(run->args, "--tolerance", 1, &run->tolerance))
        return false;
    if (run->within >= 0 && run->tolerance >= 0)
        return target_check(run->args, "-o", ".svg");
    complain("clash: %s: 0 or more is wanted", run->within >= 0 ? "--tolerance" : "--within");
    return false;
}

static void finish(struct clash_run *run) {
    for (size_t i = 0; i < run->count; i++) {
        pir_clash_body_destroy(run->body[i].body);
        pir_solid_release(run->body[i].solid);
        free(run->body[i].name);
    }
    for (size_t i = 0; i < run->refused_count; i++) {
        free(run->refused[i].name);
        free(run->refused[i].why);
    }
    free(run->body);
    free(run->refused);
    free(run->found);
}

SUBCOMMAND(clash) {
    struct clash_run run = {.args = args};
    const char *path = args_value(args, "-o");
    bool good = read_options(&run) && read_solids(&run) && run.count > 0 && judge_all(&run);
    if (good && path)
        good = clash_picture_write(path, run.body, run.count, run.found, run.found_count);
    if (good && args_has(args, "--json"))
        good = print_json(&run);
    else if (good && !target_is_stdout(args, "-o"))
        print_text(&run);
    // models that were refused were complained of by name
    const int result = good && run.refused_count == 0 ? EXIT_DONE : EXIT_BAD_INPUT;
    finish(&run);
    return result;
}
