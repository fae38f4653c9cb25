/* SPDX-License-Identifier: MIT */
/* pirouette slice --critical: a full turn of a robot about one axis, whole, into one file. */
#include <inttypes.h>
#include <stdio.h>
#include <sys/stat.h>

#include "critical.h"
#include "file.h"
#include "json.h"
#include "measure.h"
#include "message.h"
#include "pieces.h"
#include "pose.h"
#include "text.h"

struct turn_run {
    struct pieces robot, obstacles;
    pir_vec3 axis;
    pir_quat start;
    uint64_t events, most_facets;
    struct output_file out;
};

static bool read_request(const struct args *args, struct turn_run *run) {
    static const char *const others[] = {"--steps",           "--grid",   "--level",   "--rotations", "--threads",
                                         "--slices-per-unit", "--resume", "--dry-run", "--planes",    "--vertices",
                                         "--planar"};
    double q[4] = {0, 0, 0, 1};
    const char *path = args_value(args, "-o");
    if (!args_has(args, "--critical")) {
        complain("slice: --quat is where a turn of --critical starts; grids have rotations of their own");
        return false;
    }
    for (size_t k = 0; k < sizeof others / sizeof *others; k++)
        if (args_has(args, others[k])) {
            complain("slice: --critical and %s are both given; a turn has no grid and one file", others[k]);
            return false;
        }
    if (!args_has(args, "--axis") || !path || !output_ends_in(path, ".turn")) {
        complain("slice: --critical needs --axis x,y,z and -o FILE.turn; see pirouette slice --help");
        return false;
    }
    if (!axis_read(args, "--axis", &run->axis) || !args_numbers(args, "--quat", 4, q))
        return false;
    if (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0) {
        complain("slice: --quat: '%s' is the zero quaternion, which turns nothing", args_value(args, "--quat"));
        return false;
    }
    run->start = (pir_quat){q[0], q[1], q[2], q[3]};
    return true;
}

static bool load(const struct args *args, struct turn_run *run) {
    if (!pieces_load(args, 0, &run->robot))
        return false;
    for (size_t i = 1; i < args->positional_count; i++)
        if (!pieces_load(args, i, &run->obstacles))
            return false;
    for (uint32_t i = 0; i < run->robot.count; i++)
        for (uint32_t k = 0; k < run->obstacles.count; k++) {
            const int p = pir_polytope_dimension(run->robot.at[i]), q = pir_polytope_dimension(run->obstacles.at[k]);
            if (p < 2 || q < 2 || p + q < 5) {
                complain("slice: piece %" PRIu32 " of the robot and obstacle piece %" PRIu32
                         ": their difference has no inside; of each pair one has to be solid, the other at least flat",
                         i, k);
                return false;
            }
        }
    return true;
}

/* Makes the map of a pair and writes it. */
static pir_status make_pair(struct turn_run *run, uint32_t i, uint32_t k, pir_report *report) {
    pir_critical_map *map;
    pir_status status =
        pir_critical_map_create(run->robot.at[i], run->obstacles.at[k], run->start, run->axis, NULL, &map);
    if (status != PIR_OK)
        return status;
    const uint32_t events = pir_critical_map_event_count(map);
    run->events += events;
    for (uint32_t interval = 0; interval <= events; interval++) {
        uint32_t facets;
        if (pir_critical_map_facets(map, interval, NULL, &facets) == PIR_OK && facets > run->most_facets)
            run->most_facets = facets;
    }
    status = pir_critical_map_write(map, run->out.stream, report);
    pir_critical_map_destroy(map);
    return status;
}

static bool make_all(const struct args *args, struct turn_run *run) {
    if (!output_open(&run->out, args_value(args, "-o")))
        return false;
    for (uint32_t i = 0; i < run->robot.count; i++)
        for (uint32_t k = 0; k < run->obstacles.count; k++) {
            pir_report report = {0};
            const pir_status status = make_pair(run, i, k, &report);
            // the stream says why it could not be written
            if (status == PIR_ERR_FILE && output_failed(&run->out))
                return false;
            if (status != PIR_OK) {
                complain_status("slice", status, &report);
                return false;
            }
        }
    return output_commit(&run->out);
}

static bool tell(const struct args *args, const struct turn_run *run, double seconds) {
    const char *path = args_value(args, "-o");
    struct stat file = {0};
    const double bytes = stat(path, &file) == 0 ? (double)file.st_size : 0;
    if (args_has(args, "--json")) {
        struct json json = json_new();
        json_add_text(&json, json.root, "robot", args->positional[0]);
        json_add_count(&json, json.root, "robot_pieces", run->robot.count);
        json_add_count(&json, json.root, "obstacle_pieces", run->obstacles.count);
        json_add_numbers(&json, json.root, "axis", (const double[]){run->axis.x, run->axis.y, run->axis.z}, 3);
        json_add_numbers(&json, json.root, "quat",
                         (const double[]){run->start.x, run->start.y, run->start.z, run->start.w}, 4);
        json_add_count(&json, json.root, "events", run->events);
        json_add_count(&json, json.root, "most_facets", run->most_facets);
        json_add_number(&json, json.root, "seconds", seconds);
        json_add_number(&json, json.root, "bytes", bytes);
        json_add_text(&json, json.root, "file", path);
        return json_print(&json, stdout);
    }
    char time[TEXT_NUMBER];
    text_time(seconds * 1e9, time);
    say("a full turn of %s, %" PRIu32 " by %" PRIu32 " pieces\n", args->positional[0], run->robot.count,
        run->obstacles.count);
    say("  %-10s %" PRIu64 ", between them at most %" PRIu64 " facets\n", "events", run->events, run->most_facets);
    say("  %-10s %s\n", "time", time);
    say("  %-10s %s, %.3g MB\n", "file", path, bytes / 1e6);
    return true;
}

int critical_slice(const struct args *args) {
    struct turn_run run = {.events = 0};
    bool done = read_request(args, &run) && load(args, &run);
    const int64_t start = clock_now();
    done = done && make_all(args, &run) && tell(args, &run, (double)(clock_now() - start) / 1e9);
    output_discard(&run.out);
    pieces_release(&run.obstacles);
    pieces_release(&run.robot);
    return done ? EXIT_DONE : EXIT_BAD_INPUT;
}
