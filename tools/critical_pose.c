/* SPDX-License-Identifier: MIT */
/* pirouette configuration on a file of slice --critical: poses at every angle of the turn, and all around. */
#include "critical.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/cspace.h>
#include <pirouette/pirouette.h>

#include "file.h"
#include "input.h"
#include "json.h"
#include "measure.h"
#include "message.h"
#include "pose.h"
#include "target.h"

#define MAGIC "PIRTURN\n"

static const char *const state_names[] = {"outside", "boundary", "inside"};

/* A map, with the pair of its bodies for rotations beside the axis. */
struct turn_pair {
    pir_critical_map *map;
    pir_pair *pair;
};

struct turn_file {
    const struct args *args;
    struct turn_pair *at;
    uint32_t count;
    pir_workspace *workspace;
};

/* An answer: the state of the pair that overlaps most, and that pair; where in its turn the rotation is. */
struct turn_answer {
    pir_state state;
    uint32_t pair;
    bool is_turn;
    pir_critical_place place;
};

/* --- the file --- */

bool critical_is_file(const char *path) {
    char begins[sizeof MAGIC - 1];
    FILE *file = fopen(path, "rb");
    const bool is =
        file && fread(begins, 1, sizeof begins, file) == sizeof begins && memcmp(begins, MAGIC, sizeof begins) == 0;
    if (file)
        fclose(file);
    return is;
}

static pir_status add_map(struct turn_file *turns, FILE *file, pir_report *report) {
    pir_critical_map *map;
    pir_pair *pair;
    pir_status status = pir_critical_map_read(file, NULL, report, &map);
    if (status != PIR_OK)
        return status;
    const pir_critical_turn turn = pir_critical_map_turn(map);
    struct turn_pair *grown = realloc(turns->at, ((size_t)turns->count + 1) * sizeof *grown);
    status = grown ? PIR_OK : PIR_ERR_MEMORY;
    if (grown)
        turns->at = grown;
    // references are counted in polytopes that are otherwise never changed
    if (status == PIR_OK)
        status = pir_pair_create((pir_polytope *)turn.p, (pir_polytope *)turn.q, NULL, &pair);
    if (status == PIR_OK)
        turns->at[turns->count++] = (struct turn_pair){map, pair};
    else
        pir_critical_map_destroy(map);
    return status;
}

static bool open_file(struct turn_file *turns) {
    const char *path = turns->args->positional[0];
    pir_report report = {0};
    FILE *file = fopen(path, "rb");
    pir_status status = file ? PIR_OK : PIR_ERR_FILE;
    while (status == PIR_OK)
        status = add_map(turns, file, &report);
    if (file)
        fclose(file);
    if (status == PIR_ERR_EMPTY && turns->count > 0) {
        report = (pir_report){0};
        status = pir_workspace_create(NULL, &turns->workspace);
    }
    if (status != PIR_OK)
        complain("%s: %s", path, report.text[0] ? report.text : pir_status_text(status));
    return status == PIR_OK;
}

static void close_file(struct turn_file *turns) {
    for (uint32_t i = 0; i < turns->count; i++) {
        pir_pair_destroy(turns->at[i].pair);
        pir_critical_map_destroy(turns->at[i].map);
    }
    pir_workspace_destroy(turns->workspace);
    free(turns->at);
}

/* --- one pose --- */

/* The state of one pair: by its map, or where the rotation is none of the turn by the pair itself. */
static pir_status ask_pair(struct turn_file *turns, uint32_t i, const pir_pose *pose, struct turn_answer *answer) {
    const struct turn_pair *at = &turns->at[i];
    answer->pair = i;
    pir_status status =
        pir_critical_map_state_of(at->map, pose->rotation, pose->translation, &answer->is_turn, &answer->state);
    if (status != PIR_OK)
        return status;
    if (answer->is_turn)
        return pir_critical_map_locate_rotation(at->map, pose->rotation, &answer->is_turn, &answer->place);
    pir_pair_input input = pir_pair_input_default();
    pir_query_result result;
    input.pose_p = *pose;
    status = pir_pair_overlap(at->pair, turns->workspace, &input, &result);
    if (status == PIR_OK)
        answer->state = result.state;
    return status;
}

static pir_status ask(struct turn_file *turns, const pir_pose *pose, const double *kappa,
                      struct turn_answer *ret_answer) {
    for (uint32_t i = 0; i < turns->count; i++) {
        struct turn_answer answer = {.pair = i, .is_turn = true};
        pir_status status;
        if (kappa) {
            status = pir_critical_map_state(turns->at[i].map, *kappa, pose->translation, &answer.state);
            if (status == PIR_OK)
                status = pir_critical_map_locate(turns->at[i].map, *kappa, &answer.place);
        } else {
            status = ask_pair(turns, i, pose, &answer);
        }
        if (status != PIR_OK)
            return status;
        if (i == 0 || answer.state > ret_answer->state)
            *ret_answer = answer;
    }
    return PIR_OK;
}

static const char *verdict_of(pir_state state) {
    return state == PIR_OUTSIDE ? "free" : "blocked";
}

static bool tell_pose(const struct turn_file *turns, const pir_pose *pose, const double *kappa,
                      const struct turn_answer *answer, double seconds) {
    const struct args *args = turns->args;
    if (!args_has(args, "--json")) {
        say("%s: %s\n", args->positional[0], verdict_of(answer->state));
        say("  %-12s %s\n", "state", state_names[answer->state]);
        if (answer->is_turn)
            say("  %-12s %" PRIu32 " of pair %" PRIu32 "%s\n", "interval", answer->place.interval, answer->pair,
                answer->place.at_event ? ", at the event that it begins with" : "");
        else
            say("  %-12s none: the rotation is beside the turn's axis\n", "interval");
        return true;
    }
    const double q[4] = {pose->rotation.x, pose->rotation.y, pose->rotation.z, pose->rotation.w};
    const double t[3] = {pose->translation.x, pose->translation.y, pose->translation.z};
    struct json json = json_new();
    json_add_text(&json, json.root, "file", args->positional[0]);
    if (kappa)
        json_add_number(&json, json.root, "kappa", *kappa);
    else
        json_add_numbers(&json, json.root, "quat", q, 4);
    json_add_numbers(&json, json.root, "translation", t, 3);
    json_add_text(&json, json.root, "verdict", verdict_of(answer->state));
    json_add_text(&json, json.root, "state", state_names[answer->state]);
    json_add_count(&json, json.root, "pair", answer->pair);
    if (answer->is_turn) {
        json_add_count(&json, json.root, "interval", answer->place.interval);
        json_add_flag(&json, json.root, "at_event", answer->place.at_event);
    }
    json_add_number(&json, json.root, "seconds", seconds);
    return json_print(&json, stdout);
}

static bool run_pose(struct turn_file *turns, const pir_pose *pose, const double *kappa) {
    const int64_t start = clock_now();
    struct turn_answer answer = {.pair = 0};
    const pir_status status = ask(turns, pose, kappa, &answer);
    if (status != PIR_OK) {
        complain("configuration: --translate: '%s': %s", args_value(turns->args, "--translate"),
                 pir_status_text(status));
        return false;
    }
    return tell_pose(turns, pose, kappa, &answer, (double)(clock_now() - start) / 1e9);
}

/* --- all around --- */

static void tell_stretch(const double from[2], const double to[2], pir_state state) {
    say("  from %.15g to %.15g degrees: %s, %s\n", from[0], to[1], verdict_of(state), state_names[state]);
}

/* Tells each stretch, in words or into a list. */
static void tell_stretches(const pir_critical_states *states, struct json *json, cJSON *list) {
    const uint32_t count = pir_critical_states_count(states);
    pir_critical_angle from = {.kappa = {INFINITY, INFINITY}, .degrees = {0, 0}};
    for (uint32_t i = 0; i <= count; i++) {
        pir_critical_angle to = {.kappa = {-INFINITY, -INFINITY}, .degrees = {360, 360}};
        pir_state state = PIR_OUTSIDE;
        pir_critical_states_after(states, i, &state);
        if (i < count)
            pir_critical_states_contact(states, i, &to);
        if (list) {
            cJSON *stretch = json_add_object(json, list, NULL);
            json_add_text(json, stretch, "verdict", verdict_of(state));
            json_add_text(json, stretch, "state", state_names[state]);
            json_add_numbers(json, stretch, "from_degrees", from.degrees, 2);
            json_add_numbers(json, stretch, "to_degrees", to.degrees, 2);
            json_add_numbers(json, stretch, "from_kappa", from.kappa, 2);
            json_add_numbers(json, stretch, "to_kappa", to.kappa, 2);
        } else {
            tell_stretch(from.degrees, to.degrees, state);
        }
        from = to;
    }
}

static bool run_around(const struct turn_file *turns, pir_vec3 t) {
    const int64_t start = clock_now();
    const pir_critical_map **maps = calloc(turns->count, sizeof *maps);
    pir_critical_states *states = NULL;
    for (uint32_t i = 0; maps && i < turns->count; i++)
        maps[i] = turns->at[i].map;
    const pir_status status = maps ? pir_critical_states_create(maps, turns->count, t, NULL, &states) : PIR_ERR_MEMORY;
    free(maps);
    if (status == PIR_ERR_ARGUMENT)
        return !complain("%s: maps of several turns, which have no angles in common", turns->args->positional[0]);
    if (status != PIR_OK)
        return !complain_status("configuration", status, NULL);
    bool good = true;
    if (args_has(turns->args, "--json")) {
        struct json json = json_new();
        json_add_text(&json, json.root, "file", turns->args->positional[0]);
        json_add_numbers(&json, json.root, "translation", (const double[]){t.x, t.y, t.z}, 3);
        json_add_text(&json, json.root, "at_start", state_names[pir_critical_states_at_start(states)]);
        tell_stretches(states, &json, json_add_array(&json, json.root, "stretches"));
        json_add_number(&json, json.root, "seconds", (double)(clock_now() - start) / 1e9);
        good = json_print(&json, stdout);
    } else {
        say("%s: at the start %s\n", turns->args->positional[0], state_names[pir_critical_states_at_start(states)]);
        tell_stretches(states, NULL, NULL);
    }
    pir_critical_states_destroy(states);
    return good;
}

/* --- many poses --- */

static void write_row(FILE *out, const pir_pose *pose, const struct turn_answer *answer) {
    const double v[7] = {pose->rotation.x,    pose->rotation.y,    pose->rotation.z,   pose->rotation.w,
                         pose->translation.x, pose->translation.y, pose->translation.z};
    for (int k = 0; k < 7; k++)
        fprintf(out, "%.17g,", v[k]);
    fprintf(out, "%s,%s,%" PRIu32 ",", verdict_of(answer->state), state_names[answer->state], answer->pair);
    if (answer->is_turn)
        fprintf(out, "%" PRIu32, answer->place.interval);
    fputs("\n", out);
}

static bool answer_all(struct turn_file *turns, const pir_pose *poses, size_t count, struct output_file *out,
                       uint64_t counts[2]) {
    fprintf(out->stream, "x,y,z,w,tx,ty,tz,verdict,state,pair,interval\n");
    for (size_t i = 0; i < count; i++) {
        struct turn_answer answer = {.pair = 0};
        const pir_status status = ask(turns, &poses[i], NULL, &answer);
        if (status != PIR_OK) {
            complain("%s: pose %zu: %s", args_value(turns->args, "--batch"), i + 1, pir_status_text(status));
            return false;
        }
        write_row(out->stream, &poses[i], &answer);
        counts[answer.state != PIR_OUTSIDE]++;
    }
    return output_commit(out);
}

static bool run_batch(struct turn_file *turns) {
    const struct args *args = turns->args;
    const int64_t start = clock_now();
    const char *path = args_value(args, "--batch");
    pir_report report = {0};
    pir_pose *poses;
    size_t count;
    if (input_is_stdin(path) && !input_take())
        return false;
    pir_status status =
        pir_cspace_read_poses(input_is_stdin(path) ? "/dev/stdin" : path, NULL, &report, &poses, &count);
    if (status != PIR_OK) {
        complain_status(path, status, &report);
        return false;
    }
    struct output_file out = {0};
    uint64_t counts[2] = {0, 0};
    bool good = output_open(&out, args_value(args, "-o")) && answer_all(turns, poses, count, &out, counts);
    output_discard(&out);
    pir_cspace_free_poses(poses, count, NULL);
    if (!good || target_is_stdout(args, "-o"))
        return good;
    const double seconds = (double)(clock_now() - start) / 1e9;
    if (!args_has(args, "--json")) {
        say("%zu poses: %" PRIu64 " free, %" PRIu64 " blocked, 0 unknown\n", count, counts[0], counts[1]);
        return true;
    }
    struct json json = json_new();
    json_add_text(&json, json.root, "file", args->positional[0]);
    json_add_count(&json, json.root, "poses", count);
    json_add_count(&json, json.root, "free", counts[0]);
    json_add_count(&json, json.root, "blocked", counts[1]);
    json_add_count(&json, json.root, "unknown", 0);
    json_add_number(&json, json.root, "seconds", seconds);
    return json_print(&json, stdout);
}

/* --- the request --- */

/* Whether the options go together; `ret` tells what is asked for besides the translation. */
static bool check_options(const struct args *args) {
    static const char *const ways[] = {"--kappa", "--quat", "--axis", "--angle", "--around"};
    const bool batch = args_has(args, "--batch");
    if (args_has(args, "--to") || args_has(args, "--to-quat"))
        return !complain("configuration: --to and --to-quat are for slices of a grid; a .turn has --around");
    if (batch == args_has(args, "--translate"))
        return !complain("configuration: say where the robot is: --translate x,y,z or --batch FILE");
    if (batch != args_has(args, "-o"))
        return !complain("configuration: %s",
                         batch ? "--batch needs -o FILE.csv for its answers" : "-o is for --batch alone");
    const char *first = batch ? "--batch" : NULL;
    for (size_t k = 0; k < sizeof ways / sizeof *ways; k++) {
        if (!args_has(args, ways[k]))
            continue;
        const bool is_angle = first && strcmp(first, "--axis") == 0 && strcmp(ways[k], "--angle") == 0;
        if (first && !is_angle)
            return !complain("configuration: %s and %s are both given; one says how the robot is turned", first,
                             ways[k]);
        first = ways[k];
    }
    return target_check(args, "-o", NULL);
}

int critical_configuration(const struct args *args) {
    struct turn_file turns = {.args = args};
    pir_pose pose = {.rotation = {0, 0, 0, 1}};
    double t[3] = {0, 0, 0}, kappa = 0;
    if (!check_options(args) || !args_numbers(args, "--translate", 3, t) || !args_numbers(args, "--kappa", 1, &kappa) ||
        !pose_read(args, &pose.rotation))
        return EXIT_BAD_INPUT;
    pose.translation = (pir_vec3){t[0], t[1], t[2]};
    bool good = open_file(&turns);
    if (good)
        good = args_has(args, "--batch")    ? run_batch(&turns)
               : args_has(args, "--around") ? run_around(&turns, pose.translation)
                                            : run_pose(&turns, &pose, args_has(args, "--kappa") ? &kappa : NULL);
    close_file(&turns);
    return good ? EXIT_DONE : EXIT_BAD_INPUT;
}
