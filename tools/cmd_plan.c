/* SPDX-License-Identifier: MIT */
/* pirouette plan: whether a body can be moved from one place to another between obstacles, with the proof. */
#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <pirouette/pirouette.h>

#include "cmd.h"
#include "file.h"
#include "json.h"
#include "measure.h"
#include "message.h"
#include "model.h"
#include "models.h"
#include "plan_motions.h"
#include "plan_page.h"
#include "progress.h"
#include "solid.h"
#include "target.h"
#include "text.h"
#include "turn.h"

#define FULL_TURN (2 * 3.14159265358979323846)

/* So that bytes fit into 63 bits, or into a size_t of 32. */
#define MOST_MEGABYTES (SIZE_MAX / 4 >> 20)

struct plan_run {
    const struct args *args;
    pir_solid **solid; /* the robot's first */
    size_t count, room, of_robot;
    pir_path_plan_input input;
    pir_path_plan_options options;
    pir_turn_plan_input turns;    /* with --axis: what of the question is its own */
    uint32_t arcs;                /* at most; 0 for the default */
    pir_rigid_plan_input motions; /* without either: what of the question is its own */
    pir_rigid_plan_options how;
    struct plan_page page; /* with --page: what it shows, and where it goes */
    struct output_file page_file;
    const pir_plan_ranks *ranks; /* the processes that share the work, or NULL */
    struct progress bar;         /* of boxes that are made, of as many as may be; then of those that are written */
    bool is_written;
    pir_report report;
    double seconds;
};

/* --- what is asked --- */

static size_t count_numbers(const char *text) {
    size_t count = 1;
    for (const char *c = text; *c; c++)
        count += *c == ',';
    return count;
}

/* A pose: x,y,z, not turned, or x,y,z and the quaternion x,y,z,w. */
static bool read_place(const struct args *args, const char *name, pir_quat *rotation, pir_vec3 *place) {
    double n[7] = {0, 0, 0, 0, 0, 0, 1};
    if (!args_has(args, name)) {
        complain("plan: %s x,y,z is missing: where the robot is to be", name);
        return false;
    }
    if (!args_numbers(args, name, count_numbers(args_value(args, name)) == 7 ? 7 : 3, n))
        return false;
    if (n[3] == 0 && n[4] == 0 && n[5] == 0 && n[6] == 0) {
        complain("plan: %s: the quaternion is zero, which turns nothing", name);
        return false;
    }
    *place = (pir_vec3){n[0], n[1], n[2]};
    *rotation = (pir_quat){n[3], n[4], n[5], n[6]};
    return true;
}

/* Whether quaternions are the same, or each the other's negative: multiples of one are told apart. */
static bool is_same_turn(pir_quat a, pir_quat b) {
    return (a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w) ||
           (a.x == -b.x && a.y == -b.y && a.z == -b.z && a.w == -b.w);
}

/* A pose with --axis: x,y,z and degrees, which may be missing. */
static bool read_turned_place(const struct args *args, const char *name, pir_vec3 *place, double *turn) {
    double n[4] = {0, 0, 0, 0};
    if (!args_has(args, name)) {
        complain("plan: %s x,y,z,DEGREES is missing: where the robot is to be", name);
        return false;
    }
    if (!args_numbers(args, name, count_numbers(args_value(args, name)) == 3 ? 3 : 4, n))
        return false;
    *place = (pir_vec3){n[0], n[1], n[2]};
    *turn = n[3] / 360 - floor(n[3] / 360);
    *turn = *turn < 1 ? *turn : 0; // a tiny angle below 0
    return true;
}

/* The question with --axis. */
static bool read_turns(struct plan_run *run, const double bounds[6]) {
    const struct args *args = run->args;
    pir_turn_plan_input *in = &run->turns;
    double axis[3];
    uint64_t arcs = 0;
    if (args_has(args, "--translate-only") || args_has(args, "--open")) {
        complain("plan: --axis goes with neither --translate-only nor --open");
        return false;
    }
    if (!args_has(args, "--bounds")) {
        complain("plan: --bounds is missing, which --axis needs");
        return false;
    }
    if (!args_numbers(args, "--axis", 3, axis) || !args_count(args, "--arcs", 8, 65536, &arcs) ||
        !read_turned_place(args, "--from", &in->from, &in->from_turn) ||
        !read_turned_place(args, "--to", &in->to, &in->to_turn))
        return false;
    in->axis = (pir_vec3){axis[0], axis[1], axis[2]};
    in->low = (pir_vec3){bounds[0], bounds[1], bounds[2]};
    in->high = (pir_vec3){bounds[3], bounds[4], bounds[5]};
    run->arcs = (uint32_t)arcs;
    return target_check(args, "-o", NULL);
}

/* The question with all turns. */
static bool read_motions(struct plan_run *run, const double bounds[6]) {
    const struct args *args = run->args;
    pir_rigid_plan_input *in = &run->motions;
    uint64_t boxes = 0, threads = 1, memory = 0;
    if (args_has(args, "--open")) {
        complain("plan: --open goes with --translate-only alone");
        return false;
    }
    if (!args_has(args, "--bounds")) {
        complain("plan: --bounds is missing, which all but --translate-only needs");
        return false;
    }
    if (!args_count(args, "--boxes", 32, UINT32_MAX / 16, &boxes) || !args_count(args, "--threads", 1, 64, &threads) ||
        !args_count(args, "--memory", 1, MOST_MEGABYTES, &memory) ||
        !read_place(args, "--from", &in->from.rotation, &in->from.translation) ||
        !read_place(args, "--to", &in->to.rotation, &in->to.translation))
        return false;
    in->low = (pir_vec3){bounds[0], bounds[1], bounds[2]};
    in->high = (pir_vec3){bounds[3], bounds[4], bounds[5]};
    run->how = pir_rigid_plan_options_default();
    run->how.threads = (uint32_t)threads;
    run->how.boxes = boxes > 0 ? (uint32_t)boxes : run->how.boxes;
    run->how.memory = memory > 0 ? (size_t)memory << 20 : run->how.memory;
    run->how.asymmetric = args_has(args, "--asymmetric");
    run->how.boxes_alone = args_has(args, "--boxes-alone");
    run->how.parts = run->options.parts > 0 ? run->options.parts : run->how.parts;
    return target_check(args, "-o", NULL);
}

/* Options that only plans by any motion have. */
static const char *const of_motions[] = {"--boxes",       "--memory", "--threads", "--asymmetric",
                                         "--boxes-alone", "--resume", "--dry-run"};

static bool read_options(struct plan_run *run) {
    const struct args *args = run->args;
    if (!target_check(args, "--page", ".html") || !targets_differ(args, "-o", "--page"))
        return false;
    pir_quat end;
    double bounds[6] = {0};
    uint64_t parts = 0;
    if (!args_numbers(args, "--bounds", 6, bounds) || !args_count(args, "--budget", 1, UINT32_MAX, &parts))
        return false;
    run->options = pir_path_plan_options_default();
    run->options.parts = (uint32_t)parts;
    for (size_t i = 0; i < sizeof of_motions / sizeof *of_motions; i++)
        if (args_has(args, of_motions[i]) && (args_has(args, "--axis") || args_has(args, "--translate-only"))) {
            complain("plan: %s goes with neither --translate-only nor --axis", of_motions[i]);
            return false;
        }
    if (args_has(args, "--axis"))
        return read_turns(run, bounds);
    if (args_has(args, "--arcs")) {
        complain("plan: --arcs goes with --axis alone");
        return false;
    }
    if (!args_has(args, "--translate-only"))
        return read_motions(run, bounds);
    if (!read_place(args, "--from", &run->input.rotation, &run->input.from) ||
        !read_place(args, "--to", &end, &run->input.to))
        return false;
    if (!is_same_turn(run->input.rotation, end)) {
        complain("plan: --from and --to turn the robot otherwise, which translations cannot");
        return false;
    }
    run->options.report = &run->report;
    run->options.open = args_has(args, "--open");
    run->options.bounded = args_has(args, "--bounds");
    run->options.low = (pir_vec3){bounds[0], bounds[1], bounds[2]};
    run->options.high = (pir_vec3){bounds[3], bounds[4], bounds[5]};
    return target_check(args, "-o", NULL);
}

/* Adds a solid, which is the run's then. */
static bool add_solid(struct plan_run *run, pir_solid *solid) {
    if (run->count == run->room) {
        pir_solid **grown = realloc(run->solid, (2 * run->room + 16) * sizeof *grown);
        if (!grown) {
            pir_solid_release(solid);
            complain_status("plan", PIR_ERR_MEMORY, NULL);
            return false;
        }
        run->solid = grown;
        run->room = 2 * run->room + 16;
    }
    run->solid[run->count++] = solid;
    return true;
}

static bool take_solid(void *context, const struct found_model *model) {
    struct plan_run *run = context;
    pir_solid *solid = NULL;
    pir_report report = {0};
    const size_t size = model->text ? strlen(model->text) : 0;
    const pir_file_bytes file = {model->text, size, model->name, "obj"};
    const pir_status status = model->text ? pir_solid_read_bytes(&file, NULL, &report, &solid)
                                          : pir_solid_read(model->path, NULL, &report, &solid);
    if (status == PIR_OK)
        return add_solid(run, solid);
    complain_status(model->text ? model->name : model->path, status, &report);
    return false;
}

/* The solids of an argument: a shape or standard input, or the models of a path. */
static bool load_one(struct plan_run *run, size_t index) {
    const char *path = run->args->positional[index];
    if (strncmp(path, MODEL_SHAPE, strlen(MODEL_SHAPE)) != 0 && strcmp(path, "-") != 0)
        return models_each(run->args, path, take_solid, run);
    pir_solid *solid = solid_load(run->args, index);
    return solid && add_solid(run, solid);
}

static bool load(struct plan_run *run) {
    bool good = load_one(run, 0);
    run->of_robot = run->count;
    for (size_t i = 1; i < run->args->positional_count && good; i++)
        good = load_one(run, i);
    if (!good)
        return false;
    const pir_solid *const *all = (const pir_solid *const *)run->solid;
    run->input.robot = all;
    run->input.robot_count = run->of_robot;
    run->input.obstacles = all + run->of_robot;
    run->input.obstacle_count = run->count - run->of_robot;
    run->motions.robot = run->input.robot;
    run->motions.robot_count = run->input.robot_count;
    run->motions.obstacles = run->input.obstacles;
    run->motions.obstacle_count = run->input.obstacle_count;
    return true;
}

/* --- the page --- */

/* Where a proof that there is no path goes: with --page to a file of its own first. */
static FILE *proof_file(const struct plan_run *run, const struct output_file *file) {
    return run->page.proof ? run->page.proof : args_has(run->args, "-o") ? file->stream : NULL;
}

/* With --page, opens that, and a file for the proof. */
static bool open_page(struct plan_run *run) {
    const char *path = args_value(run->args, "--page");
    if (!path)
        return true;
    if (!output_open(&run->page_file, path))
        return false;
    run->page.proof = tmpfile();
    if (!run->page.proof)
        complain("plan: --page: no temporary file can be made for the proof");
    return run->page.proof;
}

static void close_page(struct plan_run *run) {
    output_discard(&run->page_file);
    plan_page_clear(&run->page);
    if (run->page.proof)
        fclose(run->page.proof);
}

/* Copies the page's proof on to -o. */
static void pass_on(const struct plan_run *run, struct output_file *file) {
    char block[65536];
    size_t size;
    if (!run->page.proof || !args_has(run->args, "-o"))
        return;
    rewind(run->page.proof);
    while ((size = fread(block, 1, sizeof block, run->page.proof)) > 0)
        fwrite(block, 1, size, file->stream);
}

/* Whether a file goes to standard output, where nothing else is printed then. */
static bool is_on_stdout(const struct plan_run *run) {
    return target_is_stdout(run->args, "-o") || target_is_stdout(run->args, "--page");
}

/* Writes the page where one is asked for; `answer` is the answer in words. */
static bool write_page(struct plan_run *run, const char *answer, bool is_proven) {
    FILE *const proof = run->page.proof;
    const struct args *args = run->args;
    char about[160], title[400];
    if (!proof)
        return true;
    snprintf(about, sizeof about, "%c%s.", toupper((unsigned char)answer[0]), answer + 1);
    if (args->positional_count == 2)
        snprintf(title, sizeof title, "%s and %s", model_title(args->positional[0]), model_title(args->positional[1]));
    else
        snprintf(title, sizeof title, "%s between %zu models", model_title(args->positional[0]),
                 (size_t)args->positional_count - 1);
    run->page.title = title;
    run->page.about = about;
    run->page.solid = (const pir_solid *const *)run->solid;
    run->page.count = run->count;
    run->page.of_robot = run->of_robot;
    run->page.proof = is_proven ? proof : NULL;
    const bool done = plan_page_write(run->page_file.stream, &run->page);
    run->page.proof = proof;
    return done && output_commit(&run->page_file);
}

/* --- what is told --- */

static const char *name_of(pir_path_plan_answer answer) {
    return answer == PIR_PLAN_PATH ? "path" : "no path";
}

static bool print_json(const struct plan_run *run, const pir_path_plan *plan, const pir_path_plan_info *info) {
    struct json json = json_new();
    bool all_exact = true;
    json_add_text(&json, json.root, "answer", name_of(info->answer));
    json_add_text(&json, json.root, "bodies", run->options.open ? "open" : "closed");
    cJSON *path = info->answer == PIR_PLAN_PATH ? json_add_array(&json, json.root, "path") : NULL;
    for (uint32_t i = 0; i < info->points; i++) {
        pir_vec3 at;
        bool exact;
        pir_path_plan_waypoint(plan, i, &at, &exact);
        json_add_numbers(&json, path, NULL, (const double[]){at.x, at.y, at.z}, 3);
        all_exact = all_exact && exact;
    }
    if (path)
        json_add_flag(&json, json.root, "path_is_exact", all_exact);
    cJSON *bounds = json_add_object(&json, json.root, "bounds");
    json_add_numbers(&json, bounds, "low", (const double[]){info->low.x, info->low.y, info->low.z}, 3);
    json_add_numbers(&json, bounds, "high", (const double[]){info->high.x, info->high.y, info->high.z}, 3);
    json_add_count(&json, json.root, "robot_pieces", info->robot_pieces);
    json_add_count(&json, json.root, "obstacle_pieces", info->obstacle_pieces);
    json_add_count(&json, json.root, "sums", info->sums);
    json_add_count(&json, json.root, "parts", info->parts);
    json_add_count(&json, json.root, "free_parts", info->free_parts);
    json_add_count(&json, json.root, "components", info->components);
    json_add_number(&json, json.root, "seconds", run->seconds);
    return json_print(&json, stdout);
}

static void print_text(const struct plan_run *run, const pir_path_plan *plan, const pir_path_plan_info *info) {
    char time[TEXT_NUMBER];
    text_time(run->seconds * 1e9, time);
    say("%s, by translations, for %s bodies\n", name_of(info->answer), run->options.open ? "open" : "closed");
    for (uint32_t i = 0; i < info->points; i++) {
        char x[3][TEXT_NUMBER];
        pir_vec3 at;
        bool exact;
        pir_path_plan_waypoint(plan, i, &at, &exact);
        text_double(at.x, x[0]);
        text_double(at.y, x[1]);
        text_double(at.z, x[2]);
        say("  %-10s %s, %s, %s%s\n", i == 0 ? "from" : "to", x[0], x[1], x[2], exact ? "" : ", rounded");
    }
    say("  %-10s %" PRIu32 " of pieces, %" PRIu32 " and %" PRIu32 "\n", "sums", info->sums, info->robot_pieces,
        info->obstacle_pieces);
    say("  %-10s %" PRIu32 ", %" PRIu32 " of them free, in %" PRIu32 " components\n", "parts", info->parts,
        info->free_parts, info->components);
    say("  %-10s %s\n", "time", time);
}

/* Says why a plan was not made: a file that cannot be written is named. */
static void complain_of(const struct plan_run *run, pir_status status, struct output_file *file) {
    FILE *const proof = proof_file(run, file);
    const bool is_of_page = proof && proof == run->page.proof && ferror(proof);
    if (!(proof && proof == file->stream && output_failed(file)))
        complain_status(is_of_page ? "plan: --page" : "plan", status, is_of_page ? NULL : &run->report);
}

/* Writes the plan with its proof to the file that -o names. */
static bool write_plan(struct plan_run *run, const pir_path_plan *plan, struct output_file *file) {
    FILE *const proof = proof_file(run, file);
    const pir_status status = proof ? pir_path_plan_write(plan, proof) : PIR_OK;
    if (status == PIR_OK) {
        pass_on(run, file);
        return !args_has(run->args, "-o") || output_commit(file);
    }
    complain_of(run, status, file);
    return false;
}

static bool show_plan(struct plan_run *run, const pir_path_plan *plan) {
    pir_path_plan_info info;
    bool done = true;
    pir_path_plan_describe(plan, &info);
    for (uint32_t i = 0; i < info.points && done; i++) {
        pir_pose pose = {.rotation = run->input.rotation};
        pir_path_plan_waypoint(plan, i, &pose.translation, NULL);
        done = plan_page_add(&run->page, pose);
    }
    run->page.end[0] = (pir_pose){run->input.rotation, run->input.from};
    run->page.end[1] = (pir_pose){run->input.rotation, run->input.to};
    const bool is_path = info.answer == PIR_PLAN_PATH;
    return done &&
           write_page(run, is_path ? "a path, by translations alone" : "no path by translations alone", !is_path);
}

static int tell(struct plan_run *run, const pir_path_plan *plan) {
    pir_path_plan_info info;
    pir_path_plan_describe(plan, &info);
    if (args_has(run->args, "--json"))
        return print_json(run, plan, &info) ? EXIT_DONE : EXIT_BAD_INPUT;
    if (!is_on_stdout(run))
        print_text(run, plan, &info);
    return EXIT_DONE;
}

/* --- turns --- */

static const char *turn_answer_name(pir_turn_plan_answer answer) {
    return answer == PIR_TURN_PLAN_PATH ? "path" : answer == PIR_TURN_PLAN_NO_PATH ? "no path" : "unknown";
}

/* The reasons that a plan is unknown, in words for programs and for people. */
static const char *const end_name[] = {"decided", "boxes", "parts", "memory", "caller", "finest"};
static const char *const end_text[] = {
    "",
    "boxes of rotations: --boxes allows more",
    "parts of translations: --budget allows more",
    "memory: --memory allows more",
    "the caller",
    "the size of boxes: those in doubt are the finest ones, and no budget decides it"};

static bool print_turns_json(FILE *file, const struct plan_run *run, const pir_turn_plan *plan,
                             const pir_turn_plan_info *info) {
    struct json json = json_new();
    json_add_text(&json, json.root, "answer", turn_answer_name(info->answer));
    if (info->answer == PIR_TURN_PLAN_UNKNOWN)
        json_add_text(&json, json.root, "ended", info->end == PIR_PLAN_END_BOXES ? "arcs" : end_name[info->end]);
    cJSON *path = info->answer == PIR_TURN_PLAN_PATH ? json_add_array(&json, json.root, "path") : NULL;
    for (uint32_t i = 0; i < info->steps; i++) {
        pir_turn_plan_step step;
        pir_turn_plan_get_step(plan, i, &step);
        cJSON *one = json_add_object(&json, path, NULL);
        json_add_numbers(&json, one, "at", (const double[]){step.at.x, step.at.y, step.at.z}, 3);
        json_add_numbers(&json, one, "radians", (const double[]){step.low, step.high}, 2);
    }
    json_add_count(&json, json.root, "robot_pieces", info->robot_pieces);
    json_add_count(&json, json.root, "obstacle_pieces", info->obstacle_pieces);
    json_add_count(&json, json.root, "arcs", info->arcs);
    json_add_count(&json, json.root, "parts", info->parts);
    json_add_number(&json, json.root, "seconds", run->seconds);
    return json_print(&json, file);
}

static void print_turns_text(const struct plan_run *run, const pir_turn_plan_info *info) {
    char time[TEXT_NUMBER];
    text_time(run->seconds * 1e9, time);
    say("%s, by translations and turns about the axis, for closed bodies\n", turn_answer_name(info->answer));
    if (info->answer == PIR_TURN_PLAN_UNKNOWN)
        say("  %-10s %s\n", "ended by",
            info->end == PIR_PLAN_END_BOXES    ? "arcs of the turn: --arcs allows more"
            : info->end == PIR_PLAN_END_MEMORY ? "memory"
                                               : end_text[info->end]);
    if (info->answer == PIR_TURN_PLAN_PATH)
        say("  %-10s %" PRIu32 ", each a motion and a turn; -o or --json tells them\n", "steps", info->steps);
    say("  %-10s %" PRIu32 ", in %" PRIu32 " parts of boxes\n", "arcs", info->arcs, info->parts);
    say("  %-10s %s\n", "time", time);
}

/* The page: at each step in the middle of its angles. */
static bool show_turns(struct plan_run *run, const pir_turn_plan *plan, const pir_turn_plan_info *info) {
    const pir_turn_plan_input *in = &run->turns;
    bool done = true;
    for (uint32_t i = 0; i < info->steps && done; i++) {
        pir_turn_plan_step step;
        pir_turn_plan_get_step(plan, i, &step);
        const pir_quat turned = turn_about(in->axis, (step.low + step.high) / 2, FULL_TURN);
        if (i > 0) // the turn to here is at the place before
            done = plan_page_add(&run->page, (pir_pose){turned, run->page.pose[run->page.poses - 1].translation});
        done = done && plan_page_add(&run->page, (pir_pose){turned, step.at});
    }
    run->page.end[0] = (pir_pose){turn_about(in->axis, in->from_turn, 1), in->from};
    run->page.end[1] = (pir_pose){turn_about(in->axis, in->to_turn, 1), in->to};
    char answer[80];
    snprintf(answer, sizeof answer, "%s, by translations and turns about the axis", turn_answer_name(info->answer));
    return done && write_page(run, answer, info->answer == PIR_TURN_PLAN_NO_PATH);
}

/* Writes and tells what was decided; the proof, where there is one, stands in the file already. */
static int tell_turns(struct plan_run *run, const pir_turn_plan *plan, struct output_file *file) {
    pir_turn_plan_info info;
    pir_turn_plan_describe(plan, &info);
    const bool is_kept = args_has(run->args, "-o"), is_proven = info.answer != PIR_TURN_PLAN_UNKNOWN;
    if (is_kept && !is_proven && !print_turns_json(file->stream, run, plan, &info))
        return EXIT_BAD_INPUT;
    if (is_proven)
        pass_on(run, file);
    if ((is_kept && !output_commit(file)) || !show_turns(run, plan, &info))
        return EXIT_BAD_INPUT;
    if (args_has(run->args, "--json"))
        return print_turns_json(stdout, run, plan, &info) ? EXIT_DONE : EXIT_BAD_INPUT;
    if (!is_on_stdout(run))
        print_turns_text(run, &info);
    return EXIT_DONE;
}

/* Plans with --axis. */
static int plan_turns(struct plan_run *run, struct output_file *file) {
    pir_turn_plan_options options = pir_turn_plan_options_default();
    pir_turn_plan *plan = NULL;
    options.report = &run->report;
    options.proof = proof_file(run, file);
    options.arcs = run->arcs > 0 ? run->arcs : options.arcs;
    options.parts = run->options.parts > 0 ? run->options.parts : options.parts;
    run->turns.robot = run->input.robot;
    run->turns.robot_count = run->input.robot_count;
    run->turns.obstacles = run->input.obstacles;
    run->turns.obstacle_count = run->input.obstacle_count;
    const int64_t start = clock_now();
    const pir_status status = pir_turn_plan_create(&run->turns, &options, &plan);
    run->seconds = (double)(clock_now() - start) / 1e9;
    if (status != PIR_OK) {
        complain_of(run, status, file);
        return EXIT_BAD_INPUT;
    }
    const int result = tell_turns(run, plan, file);
    pir_turn_plan_destroy(plan);
    return result;
}

/* --- all turns --- */

static bool print_motions_json(FILE *file, const struct plan_run *run, const pir_rigid_plan *plan,
                               const pir_rigid_plan_info *info) {
    struct json json = json_new();
    json_add_text(&json, json.root, "answer", turn_answer_name(info->answer));
    if (info->answer == PIR_TURN_PLAN_UNKNOWN)
        json_add_text(&json, json.root, "ended", end_name[info->end]);
    cJSON *path = info->answer == PIR_TURN_PLAN_PATH ? json_add_array(&json, json.root, "path") : NULL;
    for (uint32_t i = 0; i < info->steps; i++) {
        pir_pose pose;
        pir_rigid_plan_get_step(plan, i, &pose);
        const pir_vec3 x = pose.translation;
        const pir_quat q = pose.rotation;
        cJSON *one = json_add_object(&json, path, NULL);
        json_add_numbers(&json, one, "at", (const double[]){x.x, x.y, x.z}, 3);
        json_add_numbers(&json, one, "quat", (const double[]){q.x, q.y, q.z, q.w}, 4);
    }
    json_add_count(&json, json.root, "robot_pieces", info->robot_pieces);
    json_add_count(&json, json.root, "obstacle_pieces", info->obstacle_pieces);
    json_add_count(&json, json.root, "boxes", info->boxes);
    json_add_count(&json, json.root, "divided", info->divided);
    json_add_count(&json, json.root, "cells", info->cells);
    json_add_count(&json, json.root, "symmetries", info->symmetries);
    json_add_count(&json, json.root, "parts", info->parts);
    json_add_number(&json, json.root, "seconds", run->seconds);
    return json_print(&json, file);
}

static void print_motions_text(const struct plan_run *run, const pir_rigid_plan_info *info) {
    char time[TEXT_NUMBER];
    text_time(run->seconds * 1e9, time);
    say("%s, by any motion, for closed bodies\n", turn_answer_name(info->answer));
    if (info->answer == PIR_TURN_PLAN_UNKNOWN)
        say("  %-10s %s\n", "ended by", end_text[info->end]);
    if (info->answer == PIR_TURN_PLAN_UNKNOWN && run->how.journal && info->end != PIR_PLAN_END_FINEST)
        say("  %-10s all boxes; --resume goes on from them\n", "kept");
    if (info->answer == PIR_TURN_PLAN_PATH)
        say("  %-10s %" PRIu32 ", by motions that are proven to be free; -o or --json tells them\n", "poses",
            info->steps);
    if (info->cells > 0)
        say("  %-10s %" PRIu32 " of planes through holes of walls\n", "cells", info->cells);
    say("  %-10s %" PRIu32 " of rotations, %" PRIu32 " more divided, %" PRIu64 " parts of translations\n", "boxes",
        info->boxes, info->divided, info->parts);
    if (info->symmetries > 1 && info->boxes > 0)
        say("  %-10s of bodies and bounds: one box stands for %" PRIu32 "\n", "symmetries", info->symmetries);
    say("  %-10s %s\n", "time", time);
}

static bool show_motions(struct plan_run *run, const pir_rigid_plan *plan, const pir_rigid_plan_info *info) {
    bool done = true;
    for (uint32_t i = 0; i < info->steps && done; i++) {
        pir_pose pose;
        pir_rigid_plan_get_step(plan, i, &pose);
        done = plan_page_add(&run->page, pose);
    }
    run->page.end[0] = run->motions.from;
    run->page.end[1] = run->motions.to;
    char answer[80];
    snprintf(answer, sizeof answer, "%s, by any motion", turn_answer_name(info->answer));
    return done && write_page(run, answer, info->answer == PIR_TURN_PLAN_NO_PATH);
}

/* Writes and tells what was decided; the proof, where there is one, stands in the file already. */
static int tell_motions(struct plan_run *run, const pir_rigid_plan *plan, struct output_file *file) {
    pir_rigid_plan_info info;
    pir_rigid_plan_describe(plan, &info);
    const bool is_kept = args_has(run->args, "-o"), is_proven = info.answer != PIR_TURN_PLAN_UNKNOWN;
    if (is_kept && !is_proven && !print_motions_json(file->stream, run, plan, &info))
        return EXIT_BAD_INPUT;
    if (is_proven)
        pass_on(run, file);
    if ((is_kept && !output_commit(file)) || !show_motions(run, plan, &info))
        return EXIT_BAD_INPUT;
    if (args_has(run->args, "--json"))
        return print_motions_json(stdout, run, plan, &info) ? EXIT_DONE : EXIT_BAD_INPUT;
    if (!is_on_stdout(run))
        print_motions_text(run, &info);
    return EXIT_DONE;
}

/* The journal beside a file, which is to be freed; NULL where nothing is kept, as of a stream. */
static char *journal_of(const struct output_file *file) {
    const size_t size = file->target ? strlen(file->target) + sizeof ".part" : 0;
    char *path = size > 0 ? malloc(size) : NULL;
    if (path)
        snprintf(path, size, "%s.part", file->target);
    return path;
}

static bool on_progress(void *context, uint32_t made, uint32_t written) {
    struct plan_run *run = context;
    if (written > 0 && !run->is_written) {
        progress_end(&run->bar);
        run->bar = progress_new(made);
        run->is_written = true;
    }
    progress_show(&run->bar, written > 0 ? written : made);
    return true;
}

#define FIRST_BOXES 32

/* Has the time begin with the first boxes, and end with them. */
static bool end_with_boxes(void *context, uint32_t made, uint32_t written) {
    int64_t *start = context;
    (void)written;
    if (made == 0)
        *start = clock_now();
    return made < FIRST_BOXES;
}

/* Makes the first boxes alone, and tells what as many as may be would take, were all like these. */
static int foresee(struct plan_run *run) {
    pir_rigid_plan_options how = run->how;
    pir_rigid_plan_info info;
    pir_rigid_plan *plan = NULL;
    int64_t start = clock_now();
    how.progress = end_with_boxes;
    how.context = &start;
    how.report = &run->report;
    const pir_status status = pir_rigid_plan_create(&run->motions, &how, &plan);
    if (status != PIR_OK)
        return complain_status("plan", status, &run->report);
    pir_rigid_plan_describe(plan, &info);
    pir_rigid_plan_destroy(plan);
    // a path that is found without boxes takes no longer than this
    const double boxes = info.boxes > 0 ? how.boxes / (double)info.boxes : 1;
    const double seconds = (double)(clock_now() - start) / 1e9 * boxes;
    if (args_has(run->args, "--json")) {
        struct json json = json_new();
        json_add_count(&json, json.root, "robot_pieces", info.robot_pieces);
        json_add_count(&json, json.root, "obstacle_pieces", info.obstacle_pieces);
        json_add_count(&json, json.root, "boxes", how.boxes);
        json_add_number(&json, json.root, "seconds", seconds);
        return json_print(&json, stdout) ? EXIT_DONE : EXIT_BAD_INPUT;
    }
    char time[TEXT_NUMBER];
    text_time(seconds * 1e9, time);
    say("a plan by any motion, for closed bodies\n");
    say("  %-10s %" PRIu32 " by %" PRIu32 "\n", "pieces", info.robot_pieces, info.obstacle_pieces);
    say("  %-10s %" PRIu32 " of rotations at most, in about %s\n", "boxes", how.boxes, time);
    return EXIT_DONE;
}

/* Whether a journal is to be gone on with, or is none yet: one of an earlier run is not lost unasked. */
static bool may_begin(const struct plan_run *run, const char *journal) {
    const bool resume = args_has(run->args, "--resume");
    if (resume && !journal)
        complain("plan: --resume needs -o FILE, beside which FILE.part is");
    else if (!resume && journal && access(journal, F_OK) == 0)
        complain("%s: an earlier run has left this; --resume goes on with it, and to begin anew, remove it", journal);
    else
        return true;
    return false;
}

/* Plans with neither --axis nor --translate-only. */
static int plan_motions(struct plan_run *run, struct output_file *file) {
    pir_rigid_plan *plan = NULL;
    char *journal = journal_of(file);
    const bool is_first = !run->ranks || run->ranks->number == 0;
    if (is_first && !may_begin(run, journal)) {
        free(journal);
        return EXIT_BAD_INPUT;
    }
    run->how.ranks = run->ranks;
    run->how.journal = journal;
    run->how.resume = args_has(run->args, "--resume");
    run->bar = progress_new(run->how.boxes);
    run->how.progress = is_first ? on_progress : NULL;
    run->how.context = run;
    run->how.report = &run->report;
    run->how.proof = proof_file(run, file);
    const int64_t start = clock_now();
    const pir_status status = pir_rigid_plan_create(&run->motions, &run->how, &plan);
    run->seconds = (double)(clock_now() - start) / 1e9;
    progress_end(&run->bar);
    int result = EXIT_BAD_INPUT;
    if (status != PIR_OK && is_first)
        complain_of(run, status, file);
    else if (status == PIR_OK)
        result = is_first ? tell_motions(run, plan, file) : EXIT_DONE;
    pir_rigid_plan_destroy(plan);
    free(journal);
    return result;
}

int plan_by(const struct args *args, const pir_plan_ranks *ranks) {
    struct plan_run run = {.args = args, .ranks = ranks};
    struct output_file file = {0};
    const char *path = args_value(args, "-o");
    const bool is_first = !ranks || ranks->number == 0;
    // plans of other kinds are made by the first process alone
    if (!is_first && (args_has(args, "--axis") || args_has(args, "--translate-only")))
        return EXIT_DONE;
    if (path && !is_first)
        path = "/dev/null";
    pir_path_plan *plan = NULL;
    int result = EXIT_BAD_INPUT;
    bool good = read_options(&run) && load(&run);
    const bool is_dry = good && args_has(args, "--dry-run");
    good = good && !is_dry && (!path || output_open(&file, path)) && open_page(&run);
    if (is_dry) {
        result = is_first ? foresee(&run) : EXIT_DONE;
    } else if (good && args_has(args, "--axis")) {
        result = plan_turns(&run, &file);
    } else if (good && !args_has(args, "--translate-only")) {
        result = plan_motions(&run, &file);
    } else if (good) {
        const int64_t start = clock_now();
        const pir_status status = pir_path_plan_translate(&run.input, &run.options, &plan);
        run.seconds = (double)(clock_now() - start) / 1e9;
        good = status == PIR_OK && write_plan(&run, plan, &file) && show_plan(&run, plan);
        if (status != PIR_OK)
            complain_status("plan", status, &run.report);
        if (good)
            result = tell(&run, plan);
    }
    output_discard(&file);
    close_page(&run);
    pir_path_plan_destroy(plan);
    for (size_t i = 0; i < run.count; i++)
        pir_solid_release(run.solid[i]);
    free(run.solid);
    return result;
}

SUBCOMMAND(plan) {
    return plan_by(args, NULL);
}
