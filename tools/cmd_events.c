/* SPDX-License-Identifier: MIT */
/* pirouette events: the critical angles of a turn, with the facets that come and go. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <pirouette/exact.h>

#include "cmd.h"
#include "events_picture.h"
#include "exact_json.h"
#include "file.h"
#include "json.h"
#include "measure.h"
#include "message.h"
#include "model.h"
#include "pose.h"
#include "surface.h"
#include "target.h"
#include "text.h"

struct request {
    pir_quat quat;
    pir_vec3 axis;
    double from, to; /* degrees */
    bool json, plot;
};

struct turn {
    const struct args *args;
    struct request request;
    pir_polytope *operand[2];
    pir_surface surfaces[2];
    pir_events *events;
    uint32_t facets_first; /* at the beginning */
    struct chart_event *seen;
    size_t count, room;
    uint32_t *corners;
    mpz_t polynomial[3];
    struct json json;
    cJSON *list;
    int64_t spent; /* nanoseconds, without what is printed */
};

/* --- the request --- */

static bool read_request(const struct args *args, struct request *request) {
    double q[4] = {0, 0, 0, 1};
    *request = (struct request){.axis = {0, 0, 1}, .to = 360};
    if (args_has(args, "--axis") && !axis_read(args, "--axis", &request->axis))
        return false;
    if (!args_numbers(args, "--quat", 4, q) || !args_numbers(args, "--from", 1, &request->from) ||
        !args_numbers(args, "--to", 1, &request->to) || !target_check(args, "--plot", ".svg"))
        return false;
    if (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0) {
        complain("events: --quat: '%s' is the zero quaternion, which turns nothing", args_value(args, "--quat"));
        return false;
    }
    if (!(request->from >= 0 && request->from < request->to && request->to <= 360)) {
        complain("events: --from and --to: %g to %g is no range of angles within 0 to 360", request->from, request->to);
        return false;
    }
    request->quat = (pir_quat){q[0], q[1], q[2], q[3]};
    request->json = args_has(args, "--json");
    request->plot = args_has(args, "--plot");
    return true;
}

/* --- events --- */

static void add_faces(struct turn *turn, cJSON *parent, const char *name, const pir_witness *faces, uint32_t count) {
    static const char letters[] = "-vef";
    cJSON *list = json_add_array(&turn->json, parent, name);
    for (uint32_t i = 0; i < count; i++) {
        const char kind[3] = {letters[faces[i].p.kind], letters[faces[i].q.kind], '\0'};
        cJSON *entry = json_add_object(&turn->json, list, NULL);
        json_add_text(&turn->json, entry, "kind", kind);
        json_add_face(&turn->json, entry, "p", turn->operand[0], faces[i].p, turn->corners);
        json_add_face(&turn->json, entry, "q", turn->operand[1], faces[i].q, turn->corners);
    }
}

static bool add_event(struct turn *turn, const pir_event *event, const double degrees[2], uint32_t facets) {
    double kappa[2];
    pir_events_kappa(turn->events, kappa);
    cJSON *entry = json_add_object(&turn->json, turn->list, NULL);
    json_add_numbers(&turn->json, entry, "kappa", kappa, 2);
    if (pir_events_polynomial_exact(turn->events, turn->polynomial) != PIR_OK)
        return false;
    json_add_integers(&turn->json, entry, "polynomial", turn->polynomial, 3);
    json_add_numbers(&turn->json, entry, "angle", degrees, 2);
    json_add_count(&turn->json, entry, "facets", facets);
    add_faces(turn, entry, "lost", event->lost, event->lost_count);
    add_faces(turn, entry, "gained", event->gained, event->gained_count);
    return true;
}

static bool keep(struct turn *turn, double degrees, uint32_t facets) {
    if (turn->count == turn->room) {
        struct chart_event *grown = realloc(turn->seen, (2 * turn->room + 64) * sizeof *grown);
        if (!grown)
            return false;
        turn->seen = grown;
        turn->room = 2 * turn->room + 64;
    }
    turn->seen[turn->count++] = (struct chart_event){degrees, facets};
    return true;
}

/* A κ a little before an angle, so that what is at the angle follows. */
static double kappa_before(const struct request *request) {
    const pir_vec3 u = request->axis;
    if (request->from == 0)
        return INFINITY;
    const double kappa = hypot(hypot(u.x, u.y), u.z) / tan(request->from * (3.14159265358979323846 / 360));
    return kappa + fabs(kappa) * 0x1p-48 + 0x1p-1000;
}

/* Prints or keeps an event; false when out of memory. */
static bool tell(struct turn *turn, const pir_event *event, const double degrees[2]) {
    const uint32_t facets = pir_events_facet_count(turn->events);
    if (!keep(turn, degrees[0] / 2 + degrees[1] / 2, facets))
        return false;
    if (turn->request.json)
        return add_event(turn, event, degrees, facets);
    if (!target_is_stdout(turn->args, "--plot"))
        say("  %-20.15g %10" PRIu32 " %8" PRIu32 " %8" PRIu32 "\n", turn->seen[turn->count - 1].degrees, facets,
            event->lost_count, event->gained_count);
    return true;
}

static pir_status walk(struct turn *turn) {
    const struct request *request = &turn->request;
    pir_events_options options = pir_events_options_default();
    options.difference = args_has(turn->args, "--difference");
    int64_t start = clock_now();
    pir_status status =
        pir_events_create(turn->operand[0], turn->operand[1], request->quat, request->axis, &options, &turn->events);
    if (status == PIR_OK && request->from > 0)
        status = pir_events_seek(turn->events, kappa_before(request));
    if (status != PIR_OK)
        return status;
    turn->facets_first = pir_events_facet_count(turn->events);
    turn->spent += clock_now() - start;
    for (;;) {
        pir_event event;
        bool found;
        double degrees[2];
        start = clock_now();
        status = pir_events_next(turn->events, &event, &found);
        turn->spent += clock_now() - start;
        if (status != PIR_OK || !found)
            return status;
        pir_events_angle(turn->events, degrees);
        if (degrees[0] > request->to)
            return PIR_OK;
        if (degrees[1] < request->from)
            turn->facets_first = pir_events_facet_count(turn->events);
        else if (!tell(turn, &event, degrees))
            return PIR_ERR_MEMORY;
    }
}

/* --- what is printed --- */

static void begin(struct turn *turn) {
    const struct request *request = &turn->request;
    const pir_vec3 u = request->axis;
    const pir_quat q = request->quat;
    if (!request->json) {
        if (target_is_stdout(turn->args, "--plot"))
            return;
        say("events of %s turning about %g, %g, %g, and %s\n", turn->args->positional[0], u.x, u.y, u.z,
            turn->args->positional[1]);
        surface_print_notes(turn->surfaces, 2);
        say("  %-20s %10s %8s %8s\n", "degrees", "facets", "lost", "gained");
        return;
    }
    turn->json = json_new();
    json_add_numbers(&turn->json, turn->json.root, "axis", (const double[]){u.x, u.y, u.z}, 3);
    json_add_numbers(&turn->json, turn->json.root, "quat", (const double[]){q.x, q.y, q.z, q.w}, 4);
    json_add_flag(&turn->json, turn->json.root, "difference", args_has(turn->args, "--difference"));
    turn->list = json_add_array(&turn->json, turn->json.root, "events");
}

static bool end(struct turn *turn) {
    const char *path = args_value(turn->args, "--plot");
    if (path) {
        struct output_file file = {0};
        const struct events_chart chart = {
            .title = {model_title(turn->args->positional[0]), model_title(turn->args->positional[1])},
            .from = turn->request.from,
            .to = turn->request.to,
            .facets = turn->facets_first,
            .event = turn->seen,
            .count = turn->count};
        bool written = output_open(&file, path);
        if (written) {
            events_picture_write(file.stream, &chart);
            written = output_commit(&file);
        }
        output_discard(&file);
        if (!written)
            return false;
    }
    const double seconds = (double)turn->spent / 1e9;
    if (turn->request.json) {
        json_add_count(&turn->json, turn->json.root, "facets", turn->facets_first);
        json_add_number(&turn->json, turn->json.root, "seconds", seconds);
        surface_add_inputs(&turn->json, turn->surfaces, 2);
        return json_print(&turn->json, stdout);
    }
    if (target_is_stdout(turn->args, "--plot"))
        return true;
    char time[TEXT_NUMBER];
    text_time(seconds * 1e9, time);
    say("  %-20s %zu, %" PRIu32 " facets before the first\n", "events", turn->count, turn->facets_first);
    say("  %-20s %s\n", "time", time);
    if (path)
        say("  %-20s %s\n", "file", path);
    return true;
}

static bool load(struct turn *turn) {
    uint32_t most = 2;
    for (size_t k = 0; k < 2; k++) {
        turn->operand[k] = model_load(turn->args, k, &turn->surfaces[k]);
        if (!turn->operand[k])
            return false;
        if (pir_polytope_dimension(turn->operand[k]) < 2) {
            complain("%s: a point or a segment, which has no facets to turn", turn->args->positional[k]);
            return false;
        }
        const uint32_t room = face_room(turn->operand[k]);
        most = room > most ? room : most;
    }
    turn->corners = malloc(most * sizeof *turn->corners);
    if (!turn->corners)
        complain("events: out of memory");
    return turn->corners != NULL;
}

SUBCOMMAND(events) {
    struct turn turn = {.args = args};
    if (!read_request(args, &turn.request))
        return EXIT_BAD_INPUT;
    int result = EXIT_BAD_INPUT;
    mpz_inits(turn.polynomial[0], turn.polynomial[1], turn.polynomial[2], NULL);
    if (load(&turn)) {
        begin(&turn);
        const pir_status status = walk(&turn);
        if (status != PIR_OK)
            complain_status("events", status, NULL);
        else if (end(&turn))
            result = EXIT_DONE;
    }
    json_discard(&turn.json);
    mpz_clears(turn.polynomial[0], turn.polynomial[1], turn.polynomial[2], NULL);
    pir_events_destroy(turn.events);
    free(turn.corners);
    free(turn.seen);
    for (int k = 0; k < 2; k++)
        pir_polytope_release(turn.operand[k]);
    return result;
}
