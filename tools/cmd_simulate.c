/* SPDX-License-Identifier: MIT */
/* pirouette simulate: a scene of rigid bodies, run, as a page that plays it back and as a recording. */
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <play.h>

#include "args.h"
#include "cmd.h"
#include "file.h"
#include "json.h"
#include "measure.h"
#include "message.h"
#include "model.h"
#include "progress.h"
#include "simulate/playback.h"
#include "simulate/profile.h"
#include "simulate/recording.h"
#include "simulate/scenes.h"
#include "target.h"
#include "text.h"

/* A recording has 60 frames a second, a page every second one of them. */
#define FRAME_RATE  STAGE_RATE
#define SECONDS_MAX 3600

struct run {
    const char *path; /* of the scene */
    struct stage stage;
    struct play *play;
    struct world *world; /* of the play */
    struct playback playback;
    struct profile profile;
    bool is_short;                      /* of memory, for the profile */
    struct output_file page, recording; /* open where they were asked for */
    double asked;                       /* how many seconds were to be simulated */
    uint32_t frames;                    /* after the first one */
    double seconds;                     /* that the run took */
    uint64_t state;                     /* a hash of poses and contacts at the end */
};

/* --- what is asked for --- */

/* Whether -o and --record name what can be written, and not the same. */
static bool check_targets(const struct args *args) {
    const char *page = args_value(args, "-o");
    if (!target_check(args, "-o", NULL) || !target_check(args, "--record", NULL))
        return false;
    if (page && !output_is_stream(page) && !output_ends_in(page, ".html")) {
        complain("simulate: -o: '%s' does not end in .html", page);
        return false;
    }
    return targets_differ(args, "-o", "--record");
}

/* The number of frames that comes nearest to the time, and one at least where there is any. */
static uint32_t frames_of(double seconds) {
    return seconds > 0 ? (uint32_t)fmax(1, nearbyint(seconds * FRAME_RATE)) : 0;
}

static uint64_t clock_of_updates(void *context) {
    (void)context;
    return (uint64_t)clock_now();
}

/* The scene with what the options say otherwise. */
static bool read_stage(const struct args *args, struct run *run) {
    char why[STAGE_WHY];
    uint64_t threads = 1;
    double reuse = 0;
    run->asked = -1;
    if (!args_numbers(args, "--seconds", 1, &run->asked) || !args_count(args, "--threads", 1, 64, &threads) ||
        !args_numbers(args, "--reuse", 1, &reuse))
        return false;
    if (!(reuse >= 0 && reuse <= DBL_MAX)) {
        complain("simulate: --reuse: %g is no length", reuse);
        return false;
    }
    if (args_has(args, "--seconds") && !(run->asked >= 0 && run->asked <= SECONDS_MAX)) {
        complain("simulate: --seconds: %g is not between 0 and %d", run->asked, SECONDS_MAX);
        return false;
    }
    if (!(scenes_has_name(run->path) ? scenes_read : stage_read)(run->path, &run->stage, why)) {
        complain("%s", why);
        return false;
    }
    run->stage.options.threads = (uint32_t)threads;
    run->stage.options.reuse = reuse;
    run->stage.options.profile = args_has(args, "-o");
    run->profile.timed = args_has(args, "--times");
    if (run->profile.timed)
        run->stage.options.clock = clock_of_updates;
    if (args_has(args, "--awake"))
        run->stage.options.sleep = false;
    if (run->asked < 0)
        run->asked = run->stage.seconds;
    run->frames = frames_of(run->asked);
    return !args_has(args, "--record") || recording_check(&run->stage);
}

static bool open_targets(const struct args *args, struct run *run) {
    const char *page = args_value(args, "-o"), *recording = args_value(args, "--record");
    if (page && !(output_open(&run->page, page) && playback_init(&run->playback, &run->stage)))
        return false;
    return !recording || (output_open(&run->recording, recording) &&
                          recording_begin(run->recording.stream, &run->stage, run->frames + 1));
}

/* --- the run --- */

static bool add_frame(struct run *run, uint32_t frame) {
    if (run->recording.stream)
        recording_add(run->recording.stream, &run->stage, run->world);
    return !run->page.stream || frame % (FRAME_RATE / PLAYBACK_RATE) != 0 || playback_add(&run->playback, run->world);
}

static void watch(void *context, struct world *world) {
    struct run *run = context;
    run->is_short = run->is_short || (run->page.stream && !profile_add(&run->profile, world_scene(world)));
}

static bool run_world(struct run *run) {
    struct progress progress = progress_new(run->frames);
    const int64_t start = clock_now();
    pir_status status = play_begin(&run->stage, watch, run, &run->play);
    run->world = status == PIR_OK ? play_world(run->play) : NULL;
    bool good = status == PIR_OK && add_frame(run, 0);
    uint32_t frame = 0;
    while (good && frame < run->frames) {
        status = play_frame(run->play);
        status = run->is_short ? PIR_ERR_MEMORY : status;
        frame++;
        good = status == PIR_OK && add_frame(run, frame);
        progress_show(&progress, frame);
    }
    progress_end(&progress);
    run->seconds = (double)(clock_now() - start) / 1e9;
    if (status != PIR_OK)
        complain("%s: after %.2f s: %s", run->path, (double)frame / FRAME_RATE, pir_status_text(status));
    return good;
}

/* FNV-1a of a snapshot of the scene: runs that end in one state have one hash. */
static bool hash_state(struct run *run) {
    pir_scene *scene = world_scene(run->world);
    size_t size = pir_scene_serialised_size(scene);
    uint8_t *bytes = malloc(size);
    pir_status status = bytes ? pir_scene_serialise(scene, bytes, size) : PIR_ERR_MEMORY;
    run->state = 0xcbf29ce484222325;
    for (size_t i = 0; status == PIR_OK && i < size; i++)
        run->state = (run->state ^ bytes[i]) * 0x100000001b3;
    free(bytes);
    if (status != PIR_OK)
        complain_status("simulate", status, NULL);
    return status == PIR_OK;
}

static bool write_targets(struct run *run) {
    const char *title = *run->stage.title ? run->stage.title : model_title(run->path);
    return (!run->page.stream ||
            (playback_print(run->page.stream, &run->playback, title, &run->profile) && output_commit(&run->page))) &&
           (!run->recording.stream || output_commit(&run->recording));
}

/* --- what is told --- */

struct end {
    uint32_t moving, asleep;
    double deepest;
};

static struct end end_of(const struct run *run) {
    struct end end = {0};
    for (uint32_t i = 0; i < run->stage.body_count; i++) {
        end.moving += run->stage.body[i].body.kind == PIR_BODY_MOVING;
        end.asleep += world_motion(run->world, i).asleep;
    }
    for (uint32_t i = 0; i < world_contact_count(run->world); i++)
        end.deepest = fmax(end.deepest, -world_contact(run->world, i).distance);
    return end;
}

static bool print_json(const struct args *args, const struct run *run) {
    struct end end = end_of(run);
    char state[24];
    struct json json = json_new();
    snprintf(state, sizeof state, "%016" PRIx64, run->state);
    json_add_text(&json, json.root, "scene", run->path);
    json_add_text(&json, json.root, "title", run->stage.title);
    json_add_count(&json, json.root, "bodies", run->stage.body_count);
    json_add_count(&json, json.root, "moving", end.moving);
    json_add_number(&json, json.root, "duration", (double)run->frames / FRAME_RATE);
    json_add_count(&json, json.root, "steps", (uint64_t)run->frames * play_steps(run->play));
    json_add_number(&json, json.root, "mean_speed", world_mean_speed(run->world));
    json_add_count(&json, json.root, "asleep", end.asleep);
    json_add_count(&json, json.root, "contacts", world_contact_count(run->world));
    json_add_number(&json, json.root, "deepest", end.deepest);
    json_add_text(&json, json.root, "state", state);
    if (args_has(args, "-o")) {
        json_add_text(&json, json.root, "file", args_value(args, "-o"));
        json_add_count(&json, json.root, "frames", run->playback.frames);
    }
    if (args_has(args, "--record"))
        json_add_text(&json, json.root, "record", args_value(args, "--record"));
    json_add_number(&json, json.root, "seconds", run->seconds);
    return json_print(&json, stdout);
}

static void print_text(const struct args *args, const struct run *run) {
    struct end end = end_of(run);
    char time[TEXT_NUMBER];
    text_time(run->seconds * 1e9, time);
    say("%s\n", *run->stage.title ? run->stage.title : run->path);
    say("  %-10s %" PRIu32 ", %" PRIu32 " of them moving, %" PRIu32 " asleep at the end\n", "bodies",
        run->stage.body_count, end.moving, end.asleep);
    say("  %-10s %g s in %" PRIu64 " steps", "simulated", (double)run->frames / FRAME_RATE,
        (uint64_t)run->frames * play_steps(run->play));
    if (fabs(run->asked * FRAME_RATE - run->frames) > 1e-6)
        say(", as near to %g s as frames of 1/%d s come", run->asked, FRAME_RATE);
    say("\n");
    say("  %-10s %.3g m/s at the end\n", "mean speed", world_mean_speed(run->world));
    say("  %-10s %" PRIu32 " at the end, the deepest %.3g m\n", "contacts", world_contact_count(run->world),
        end.deepest);
    say("  %-10s %016" PRIx64 "\n", "state", run->state);
    say("  %-10s %s\n", "time", time);
    if (args_has(args, "-o"))
        say("  %-10s %s\n", "written to", args_value(args, "-o"));
    if (args_has(args, "--record"))
        say("  %-10s %s\n", "recorded", args_value(args, "--record"));
}

static bool tell(const struct args *args, const struct run *run) {
    if (args_has(args, "--json"))
        return print_json(args, run);
    if (!target_is_stdout(args, "-o") && !target_is_stdout(args, "--record"))
        print_text(args, run);
    return true;
}

SUBCOMMAND(simulate) {
    struct run run = {.path = args->positional[0]};
    if (args_has(args, "--list") != !run.path)
        return complain(run.path ? "simulate: --list stands alone, without a scene"
                                 : "simulate: SCENE.json is missing; pirouette simulate --list shows scenes by name");
    if (!run.path)
        return scenes_list(args_has(args, "--json")) ? EXIT_DONE : EXIT_BAD_INPUT;
    bool good = check_targets(args) && read_stage(args, &run) && open_targets(args, &run) && run_world(&run) &&
                hash_state(&run) && write_targets(&run);
    good = good && tell(args, &run);
    output_discard(&run.page);
    output_discard(&run.recording);
    playback_clear(&run.playback);
    profile_clear(&run.profile);
    play_end(run.play);
    stage_clear(&run.stage);
    return good ? EXIT_DONE : EXIT_BAD_INPUT;
}
