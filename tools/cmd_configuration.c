/* SPDX-License-Identifier: MIT */
/*
 * pirouette configuration: whether a pose is free or blocked among the bodies of a file of slices; one pose, a motion
 * between two, or a file of poses.
 */
#include <inttypes.h>
#include <stdio.h>

#include <pirouette/cspace.h>

#include "args.h"
#include "cmd.h"
#include "critical.h"
#include "file.h"
#include "input.h"
#include "interrupt.h"
#include "json.h"
#include "measure.h"
#include "message.h"
#include "pose.h"
#include "progress.h"
#include "target.h"

static const char *const verdict_names[] = {"unknown", "free", "blocked"};
static const char *const state_names[] = {"outside", "boundary", "inside"};

struct request {
    pir_pose pose, end;
    bool moves; /* to `end` */
};

static bool read_translation(const struct args *args, const char *name, pir_vec3 *ret) {
    double t[3] = {0, 0, 0};
    if (!args_numbers(args, name, 3, t))
        return false;
    *ret = (pir_vec3){t[0], t[1], t[2]};
    return true;
}

/* Where the motion ends: at the beginning's rotation and translation, as far as nothing else is said. */
static bool read_end(const struct args *args, struct request *request) {
    double q[4];
    request->end = request->pose;
    request->moves = args_has(args, "--to") || args_has(args, "--to-quat");
    if (args_has(args, "--to") && !read_translation(args, "--to", &request->end.translation))
        return false;
    if (!args_has(args, "--to-quat"))
        return true;
    if (!args_numbers(args, "--to-quat", 4, q))
        return false;
    if (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0) {
        complain("configuration: --to-quat: '%s' is the zero quaternion, which turns nothing",
                 args_value(args, "--to-quat"));
        return false;
    }
    request->end.rotation = (pir_quat){q[0], q[1], q[2], q[3]};
    return true;
}

static bool read_request(const struct args *args, struct request *request) {
    *request = (struct request){.moves = false};
    const bool batch = args_has(args, "--batch");
    if (!pose_read(args, &request->pose.rotation) ||
        !read_translation(args, "--translate", &request->pose.translation) || !read_end(args, request))
        return false;
    if (!batch && !args_has(args, "--translate")) {
        complain("configuration: say where the robot is: --translate x,y,z or --batch FILE");
        return false;
    }
    if (batch != args_has(args, "-o")) {
        complain("configuration: %s", batch ? "--batch needs -o FILE.csv for its answers" : "-o is for --batch alone");
        return false;
    }
    static const char *const alone[] = {"--quat", "--axis", "--angle", "--translate", "--to", "--to-quat"};
    for (size_t k = 0; batch && k < sizeof alone / sizeof *alone; k++)
        if (args_has(args, alone[k])) {
            complain("configuration: --batch and %s are both given; the file says where the robot is", alone[k]);
            return false;
        }
    return target_check(args, "-o", NULL);
}

/* Complains of what came of a pose; its numbers may be at fault, which `option` gave. */
static int complain_option(const struct args *args, const char *option, pir_status status, const pir_report *report) {
    if (status != PIR_ERR_LIMIT)
        return complain_status(args->positional[0], status, report);
    return complain("configuration: %s: '%s': %s", option, args_value(args, option), pir_status_text(status));
}

/* Complains of pose `number` of a batch. */
static void complain_row(const struct args *args, size_t number, pir_status status, const pir_report *report) {
    const char *path = args_value(args, "--batch");
    if (status != PIR_ERR_LIMIT)
        complain_status(args->positional[0], status, report);
    else
        complain("%s: pose %zu: %s", input_is_stdin(path) ? INPUT_NAME : path, number, pir_status_text(status));
}

/* --- one pose --- */

static void add_pose(struct json *json, const char *quat_name, const char *translation_name, const pir_pose *pose) {
    const double q[4] = {pose->rotation.x, pose->rotation.y, pose->rotation.z, pose->rotation.w};
    const double t[3] = {pose->translation.x, pose->translation.y, pose->translation.z};
    json_add_numbers(json, json->root, quat_name, q, 4);
    json_add_numbers(json, json->root, translation_name, t, 3);
}

static bool print_pose(const struct args *args, const struct request *request, const pir_configuration *answer,
                       double seconds) {
    if (!args_has(args, "--json")) {
        say("%s: %s\n", args->positional[0], verdict_names[answer->verdict]);
        if (answer->on_grid)
            say("  %-12s %s\n", "state", state_names[answer->state]);
        say("  %-12s %" PRIu64 " of robot piece %" PRIu32 " and obstacle piece %" PRIu32 ", %.6g degrees away\n",
            "slice", answer->place.slice, answer->place.robot, answer->place.obstacle,
            answer->turn * 57.29577951308232);
        return true;
    }
    struct json json = json_new();
    json_add_text(&json, json.root, "file", args->positional[0]);
    add_pose(&json, "quat", "translation", &request->pose);
    json_add_text(&json, json.root, "verdict", verdict_names[answer->verdict]);
    if (answer->on_grid)
        json_add_text(&json, json.root, "state", state_names[answer->state]);
    json_add_count(&json, json.root, "slice", answer->place.slice);
    json_add_count(&json, json.root, "robot", answer->place.robot);
    json_add_count(&json, json.root, "obstacle", answer->place.obstacle);
    json_add_number(&json, json.root, "turn", answer->turn);
    json_add_number(&json, json.root, "seconds", seconds);
    return json_print(&json, stdout);
}

static int run_pose(const struct args *args, pir_cspace *cspace, const struct request *request, int64_t start) {
    pir_configuration answer;
    pir_report report = {0};
    pir_status status = pir_cspace_classify(cspace, &request->pose, &report, &answer);
    if (status != PIR_OK)
        return complain_option(args, "--translate", status, &report);
    return print_pose(args, request, &answer, (double)(clock_now() - start) / 1e9) ? EXIT_DONE : EXIT_BAD_INPUT;
}

/* --- a motion --- */

static int run_motion(const struct args *args, pir_cspace *cspace, const struct request *request, int64_t start) {
    pir_configuration begins;
    pir_cspace_motion answer;
    pir_report report = {0};
    pir_status status = pir_cspace_segment(cspace, &request->pose, &request->end, &report, &answer);
    if (status != PIR_OK) {
        // which of the ends is at fault
        bool at_end = args_has(args, "--to") && pir_cspace_classify(cspace, &request->pose, NULL, &begins) == PIR_OK;
        return complain_option(args, at_end ? "--to" : "--translate", status, &report);
    }
    double seconds = (double)(clock_now() - start) / 1e9;
    if (!args_has(args, "--json")) {
        say("%s: the motion is %s\n", args->positional[0], verdict_names[answer.verdict]);
        if (answer.verdict != PIR_VERDICT_FREE)
            say("  %-12s from %.6g to %.6g of the way\n", "not free", answer.from, answer.to);
        return EXIT_DONE;
    }
    struct json json = json_new();
    json_add_text(&json, json.root, "file", args->positional[0]);
    add_pose(&json, "quat", "translation", &request->pose);
    add_pose(&json, "to_quat", "to_translation", &request->end);
    json_add_text(&json, json.root, "verdict", verdict_names[answer.verdict]);
    json_add_number(&json, json.root, "from", answer.from);
    json_add_number(&json, json.root, "to", answer.to);
    json_add_number(&json, json.root, "seconds", seconds);
    return json_print(&json, stdout) ? EXIT_DONE : EXIT_BAD_INPUT;
}

/* --- many poses --- */

struct batch {
    pir_pose *poses;
    size_t count, done;
    uint64_t counts[3];
    struct output_file out;
};

static void write_row(FILE *out, const pir_pose *pose, const pir_configuration *answer) {
    const double v[7] = {pose->rotation.x,    pose->rotation.y,    pose->rotation.z,   pose->rotation.w,
                         pose->translation.x, pose->translation.y, pose->translation.z};
    for (int k = 0; k < 7; k++)
        fprintf(out, "%.17g,", v[k]);
    fprintf(out, "%s,%s,%" PRIu32 ",%" PRIu32 ",%" PRIu64 ",%.17g\n", verdict_names[answer->verdict],
            answer->on_grid ? state_names[answer->state] : "", answer->place.robot, answer->place.obstacle,
            answer->place.slice, answer->turn);
}

/* Answers of a call; between calls progress is shown and an interrupt heard. */
#define CHUNK 512
struct answers {
    uint8_t verdict[CHUNK], status[CHUNK], state[CHUNK], on_grid[CHUNK];
    uint32_t robot[CHUNK], obstacle[CHUNK];
    uint64_t slice[CHUNK];
    double turn[CHUNK];
};

static pir_configuration answer_of(const struct answers *answers, size_t i) {
    return (pir_configuration){(pir_verdict)answers->verdict[i],
                               {answers->robot[i], answers->obstacle[i], answers->slice[i]},
                               answers->on_grid[i] != 0,
                               (pir_state)answers->state[i],
                               answers->turn[i]};
}

/* Answers the next poses and writes them, up to one that is bad. False after a complaint. */
static bool answer_chunk(const struct args *args, pir_cspace *cspace, struct batch *batch) {
    static struct answers answers;
    const pir_cspace_arrays to = {answers.verdict, answers.status,   answers.state, answers.on_grid,
                                  answers.robot,   answers.obstacle, answers.slice, answers.turn};
    const pir_pose *poses = batch->poses + batch->done;
    const size_t left = batch->count - batch->done, count = left < CHUNK ? left : CHUNK;
    const pir_pose_array array = {&poses->rotation.x, sizeof *poses, &poses->translation.x, sizeof *poses, false};
    pir_report report = {0};
    pir_pair_batch_summary summary;
    pir_status status = pir_cspace_classify_many(cspace, &array, count, &to, &report, &summary);
    const size_t good = status == PIR_OK ? summary.first_bad : 0;
    for (size_t i = 0; i < good; i++) {
        const pir_configuration answer = answer_of(&answers, i);
        write_row(batch->out.stream, &poses[i], &answer);
        batch->counts[answer.verdict]++;
    }
    batch->done += good;
    if (status == PIR_OK && good == count)
        return true;
    if (status == PIR_OK) {
        // one pose says what is wrong with it
        pir_configuration answer;
        status = pir_cspace_classify(cspace, &poses[good], &report, &answer);
    }
    complain_row(args, batch->done + 1, status, &report);
    return false;
}

/* Answers all poses, or as many as there was time for. False after a complaint. */
static bool answer_all(const struct args *args, pir_cspace *cspace, struct batch *batch) {
    struct progress progress = progress_new(batch->count);
    interrupt_put_off(true);
    fprintf(batch->out.stream, "x,y,z,w,tx,ty,tz,verdict,state,robot,obstacle,slice,turn\n");
    bool good = true;
    while (good && batch->done < batch->count && !interrupt_asked()) {
        good = answer_chunk(args, cspace, batch);
        progress_show(&progress, batch->done);
    }
    interrupt_put_off(false);
    progress_end(&progress);
    return good;
}

static bool print_counts(const struct args *args, const struct batch *batch, double seconds) {
    const bool interrupted = batch->done < batch->count;
    if (!args_has(args, "--json")) {
        say("%zu poses%s: %" PRIu64 " free, %" PRIu64 " blocked, %" PRIu64 " unknown\n", batch->done,
            interrupted ? ", then interrupted" : "", batch->counts[PIR_VERDICT_FREE],
            batch->counts[PIR_VERDICT_BLOCKED], batch->counts[PIR_VERDICT_UNKNOWN]);
        return true;
    }
    struct json json = json_new();
    json_add_text(&json, json.root, "file", args->positional[0]);
    json_add_count(&json, json.root, "poses", batch->done);
    for (int verdict = 0; verdict < 3; verdict++)
        json_add_count(&json, json.root, verdict_names[verdict], batch->counts[verdict]);
    json_add_flag(&json, json.root, "interrupted", interrupted);
    json_add_number(&json, json.root, "seconds", seconds);
    return json_print(&json, stdout);
}

static int run_batch(const struct args *args, pir_cspace *cspace, int64_t start) {
    struct batch batch = {.poses = NULL};
    pir_report report = {0};
    const char *path = args_value(args, "--batch");
    if (input_is_stdin(path) && !input_take())
        return EXIT_BAD_INPUT;
    pir_status status =
        pir_cspace_read_poses(input_is_stdin(path) ? "/dev/stdin" : path, NULL, &report, &batch.poses, &batch.count);
    if (status != PIR_OK)
        return complain_status(path, status, &report);
    bool good = output_open(&batch.out, args_value(args, "-o")) && answer_all(args, cspace, &batch);
    // what stops in the middle is kept only where it is already out
    if (good && !(batch.done < batch.count && batch.out.temporary))
        good = output_commit(&batch.out);
    output_discard(&batch.out);
    pir_cspace_free_poses(batch.poses, batch.count, NULL);
    if (good && !target_is_stdout(args, "-o"))
        good = print_counts(args, &batch, (double)(clock_now() - start) / 1e9);
    return good ? EXIT_DONE : EXIT_BAD_INPUT;
}

SUBCOMMAND(configuration) {
    struct request request;
    if (critical_is_file(args->positional[0]))
        return critical_configuration(args);
    if (!read_request(args, &request))
        return EXIT_BAD_INPUT;
    pir_cspace *cspace;
    pir_report report = {0};
    pir_status status = pir_cspace_open(args->positional[0], NULL, &report, &cspace);
    if (status != PIR_OK)
        return complain_status(args->positional[0], status, &report);
    if (args_has(args, "--kappa") || args_has(args, "--around")) {
        pir_cspace_destroy(cspace);
        return complain("configuration: --kappa and --around are for files of slice --critical");
    }
    int64_t start = clock_now();
    int result = args_has(args, "--batch") ? run_batch(args, cspace, start)
                 : request.moves           ? run_motion(args, cspace, &request, start)
                                           : run_pose(args, cspace, &request, start);
    pir_cspace_destroy(cspace);
    return result;
}
