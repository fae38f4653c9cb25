/* SPDX-License-Identifier: MIT */
/*
 * pirouette impact: when P, which turns about an axis, goes straight on, or both, first touches Q, exactly. Where the
 * way is proportional to the angle, between which angles.
 */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include <pirouette/exact.h>

#include "cmd.h"
#include "exact_json.h"
#include "measure.h"
#include "message.h"
#include "model.h"
#include "pose.h"
#include "solid.h"
#include "surface.h"
#include "text.h"

struct request {
    pir_pair_input input;
    pir_exact_motion motion;
    bool turns, screws, proportional;
};

struct answer {
    pir_exact_impact impact;
    pir_sweep_result sweep; /* where the way is proportional */
    mpz_t polynomial[4];
    double seconds;
};

/* Models as their hulls, or as the solids that they are. */
struct operands {
    pir_polytope *hull[2];
    pir_surface surface[2];
    pir_solid *solid[2];
};

static const char *const outcomes[] = {"hit", "miss", "receding", "start inside", "at rest", "step limit"};
static const char *const sweep_outcomes[] = {"undecided", "free", "meets"};

/* --- the request --- */

static bool read_turn(const struct args *args, double most, pir_exact_motion *motion) {
    double pivot[3] = {0, 0, 0};
    motion->degrees = 360;
    if (!axis_read(args, "--axis", &motion->axis) || !args_numbers(args, "--pivot", 3, pivot) ||
        !args_numbers(args, "--angle", 1, &motion->degrees))
        return false;
    motion->pivot = (pir_vec3){pivot[0], pivot[1], pivot[2]};
    if (motion->degrees >= -most && motion->degrees <= most && motion->degrees != 0)
        return true;
    complain("impact: --angle: %g is not from -%g to %g, or it is 0", motion->degrees, most, most);
    return false;
}

static bool read_way(const struct args *args, bool proportional, pir_exact_motion *motion) {
    static const char *const of_turns[] = {"--pivot", "--angle"};
    for (size_t i = 0; i < sizeof of_turns / sizeof *of_turns && motion->degrees == 0; i++)
        if (args_has(args, of_turns[i])) {
            complain("impact: %s is for turns, and needs --axis x,y,z beside it", of_turns[i]);
            return false;
        }
    if (!proportional && !(motion->degrees > -180 && motion->degrees < 180)) {
        complain("impact: --way beside --axis: --angle is to be given, and below 180 degrees, or --proportional");
        return false;
    }
    double way[3];
    if (!args_numbers(args, "--way", 3, way))
        return false;
    motion->way = (pir_vec3){way[0], way[1], way[2]};
    return true;
}

static bool read_request(const struct args *args, struct request *request) {
    double t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1};
    *request = (struct request){.input = pir_pair_input_default(),
                                .turns = args_has(args, "--axis"),
                                .proportional = args_has(args, "--proportional")};
    const bool goes = args_has(args, "--way");
    if (!request->turns && !goes) {
        complain("impact: no motion: give --axis x,y,z, --way x,y,z or both");
        return false;
    }
    if (!args_numbers(args, "--translate", 3, t) || !args_numbers(args, "--quat", 4, q))
        return false;
    if (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0) {
        complain("impact: --quat: '%s' is the zero quaternion, which turns nothing", args_value(args, "--quat"));
        return false;
    }
    request->input.pose_p = (pir_pose){.rotation = {q[0], q[1], q[2], q[3]}, .translation = {t[0], t[1], t[2]}};
    const double most = request->proportional ? PIR_SWEEP_DEGREES : 360;
    if ((request->turns && !read_turn(args, most, &request->motion)) ||
        (goes && !read_way(args, request->proportional, &request->motion)))
        return false;
    const pir_vec3 way = request->motion.way;
    request->screws = request->turns && (way.x != 0 || way.y != 0 || way.z != 0);
    return true;
}

/* --- the answer --- */

static pir_status ask_hulls(const struct operands *operands, const struct request *request, struct answer *answer) {
    pir_pair *pair = NULL;
    pir_workspace *workspace = NULL;
    pir_status status = pir_workspace_create(NULL, &workspace);
    if (status == PIR_OK)
        status = pir_pair_create(operands->hull[0], operands->hull[1], NULL, &pair);
    if (status == PIR_OK && request->proportional)
        status = pir_pair_sweep_screw(pair, workspace, &request->input, &request->motion, 0, &answer->sweep);
    else if (status == PIR_OK)
        status = pir_pair_impact_exact(pair, workspace, &request->input, &request->motion, &answer->impact,
                                       answer->polynomial);
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    return status;
}

static pir_status ask_solids(const struct operands *operands, const struct request *request, pir_report *report,
                             struct answer *answer) {
    pir_decompose_options options = pir_decompose_options_default();
    pir_pieces *pieces[2] = {NULL, NULL};
    pir_solid_query *query = NULL;
    pir_workspace *workspace = NULL;
    options.report = report;
    pir_status status = pir_workspace_create(NULL, &workspace);
    for (int k = 0; k < 2 && status == PIR_OK; k++)
        status = pir_solid_decompose(operands->solid[k], &options, NULL, &pieces[k]);
    if (status == PIR_OK)
        status = pir_solid_query_create(pieces[0], pieces[1], NULL, &query);
    if (status == PIR_OK && request->proportional)
        status = pir_solid_query_sweep_screw(query, workspace, &request->input, &request->motion, 0, &answer->sweep);
    else if (status == PIR_OK)
        status = pir_solid_query_impact(query, workspace, &request->input, &request->motion, &answer->impact);
    pir_solid_query_destroy(query);
    pir_pieces_destroy(pieces[1]);
    pir_pieces_destroy(pieces[0]);
    pir_workspace_destroy(workspace);
    return status;
}

/* --- what is printed --- */

static void add_vector(struct json *json, cJSON *parent, const char *name, pir_vec3 v) {
    // + 0.0 turns −0 into 0
    json_add_numbers(json, parent, name, (const double[]){v.x + 0.0, v.y + 0.0, v.z + 0.0}, 3);
}

static void add_witness(struct json *json, const struct operands *operands, const pir_witness *witness) {
    static const char letters[] = "-vef";
    const uint32_t room[2] = {face_room(operands->hull[0]), face_room(operands->hull[1])};
    uint32_t *corners = malloc((room[0] > room[1] ? room[0] : room[1]) * sizeof *corners);
    if (!corners) {
        json->failed = true;
        return;
    }
    const char kind[3] = {letters[witness->p.kind], letters[witness->q.kind], '\0'};
    cJSON *entry = json_add_object(json, json->root, "witness");
    json_add_text(json, entry, "kind", kind);
    json_add_face(json, entry, "p", operands->hull[0], witness->p, corners);
    json_add_face(json, entry, "q", operands->hull[1], witness->q, corners);
    free(corners);
}

/* Whether the answer has a place: the bodies touch, or are told by two of their faces. */
static bool has_place(const struct operands *operands, const pir_impact *impact) {
    const bool is_contact = impact->outcome == PIR_CAST_HIT || impact->outcome == PIR_CAST_RECEDING;
    return is_contact || (impact->outcome == PIR_CAST_START_INSIDE && operands->hull[0]);
}

static void add_impact(struct json *to, const struct operands *operands, const struct request *request,
                       struct answer *answer) {
    const pir_impact *impact = &answer->impact.impact;
    struct json json = *to;
    json_add_text(&json, json.root, "outcome", outcomes[impact->outcome]);
    json_add_number(&json, json.root, "fraction", impact->time);
    if (request->turns)
        json_add_number(&json, json.root, "degrees", answer->impact.degrees);
    if (impact->outcome == PIR_CAST_HIT && impact->steps > 0) {
        json_add_numbers(&json, json.root, "kappa", answer->impact.kappa, 2);
        if (operands->hull[0])
            json_add_integers(&json, json.root, "polynomial", answer->polynomial, request->screws ? 4 : 3);
    }
    if (has_place(operands, impact)) {
        add_vector(&json, json.root, "normal", impact->normal);
        add_vector(&json, json.root, "point", impact->point);
        const double pieces[2] = {impact->piece_p, impact->piece_q};
        if (operands->hull[0])
            add_witness(&json, operands, &impact->witness);
        else
            json_add_numbers(&json, json.root, "pieces", pieces, 2);
    }
    json_add_count(&json, json.root, "planes", impact->steps);
    *to = json;
}

/* The angles of a sweep, rounded outwards. */
static void set_angles(const struct request *request, const pir_sweep_result *sweep, double ret_angle[2]) {
    const double degrees = fabs(request->motion.degrees), from = sweep->from, to = sweep->to;
    ret_angle[0] = from < 1 ? nextafter(from * degrees, 0) : degrees;
    ret_angle[1] = to < 1 ? nextafter(to * degrees, HUGE_VAL) : degrees;
}

static void add_sweep(struct json *json, const struct request *request, const pir_sweep_result *sweep) {
    double angle[2];
    set_angles(request, sweep, angle);
    json_add_text(json, json->root, "outcome", sweep_outcomes[sweep->outcome]);
    json_add_numbers(json, json->root, "fraction", (const double[]){sweep->from, sweep->to}, 2);
    if (request->turns)
        json_add_numbers(json, json->root, "degrees", angle, 2);
    json_add_count(json, json->root, "queries", sweep->queries);
}

static bool print_json(const struct args *args, const struct operands *operands, const struct request *request,
                       struct answer *answer) {
    struct json json = json_new();
    json_add_text(&json, json.root, "p", args->positional[0]);
    json_add_text(&json, json.root, "q", args->positional[1]);
    json_add_flag(&json, json.root, "solid", !operands->hull[0]);
    if (request->proportional)
        add_sweep(&json, request, &answer->sweep);
    else
        add_impact(&json, operands, request, answer);
    json_add_number(&json, json.root, "seconds", answer->seconds);
    if (operands->hull[0])
        surface_add_inputs(&json, operands->surface, 2);
    return json_print(&json, stdout);
}

static void print_vector(const char *name, pir_vec3 v) {
    say("  %-12s %.17g, %.17g, %.17g\n", name, v.x + 0.0, v.y + 0.0, v.z + 0.0);
}

static void print_sweep(const struct request *request, const pir_sweep_result *sweep) {
    double angle[2];
    set_angles(request, sweep, angle);
    if (request->turns)
        say("  %-12s %.17g to %.17g\n", "degrees", angle[0], angle[1]);
    say("  %-12s %.17g to %.17g\n", "fraction", sweep->from, sweep->to);
    say("  %-12s %" PRIu32 "\n", "queries", sweep->queries);
}

static void print_impact(const struct operands *operands, const struct request *request, const struct answer *answer) {
    const pir_impact *impact = &answer->impact.impact;
    if (request->turns)
        say("  %-12s %.15g\n", "degrees", answer->impact.degrees);
    say("  %-12s %.17g\n", "fraction", impact->time);
    if (has_place(operands, impact)) {
        print_vector("normal", impact->normal);
        print_vector("point", impact->point);
        if (!operands->hull[0])
            say("  %-12s %" PRIu32 " of P, %" PRIu32 " of Q\n", "pieces", impact->piece_p, impact->piece_q);
    }
    say("  %-12s %" PRIu32 "\n", "planes", impact->steps);
}

static void print_text(const struct args *args, const struct operands *operands, const struct request *request,
                       const struct answer *answer) {
    const char *moving = request->screws ? "screwing" : request->turns ? "turning" : "going";
    say("%s %s against %s%s: %s\n", args->positional[0], moving, args->positional[1],
        operands->hull[0] ? "" : ", as solids",
        request->proportional ? sweep_outcomes[answer->sweep.outcome] : outcomes[answer->impact.impact.outcome]);
    if (operands->hull[0])
        surface_print_notes(operands->surface, 2);
    if (request->proportional)
        print_sweep(request, &answer->sweep);
    else
        print_impact(operands, request, answer);
    char time[TEXT_NUMBER];
    text_time(answer->seconds * 1e9, time);
    say("  %-12s %s\n", "time", time);
}

static int run(const struct args *args, const struct operands *operands, const struct request *request,
               struct answer *answer) {
    pir_report report = {0};
    const int64_t start = clock_now();
    const pir_status status =
        operands->hull[0] ? ask_hulls(operands, request, answer) : ask_solids(operands, request, &report, answer);
    answer->seconds = (double)(clock_now() - start) / 1e9;
    if (status == PIR_ERR_ARGUMENT && operands->hull[0])
        return complain("impact: P and Q are to be of dimension 2 or 3, one of dimension 3");
    if (status != PIR_OK)
        return complain_status("impact", status, &report);
    if (args_has(args, "--json"))
        return print_json(args, operands, request, answer) ? EXIT_DONE : EXIT_BAD_INPUT;
    print_text(args, operands, request, answer);
    return EXIT_DONE;
}

/* --- the models --- */

static bool load(const struct args *args, struct operands *operands) {
    for (size_t k = 0; k < 2; k++) {
        if (args_has(args, "--solid"))
            operands->solid[k] = solid_load(args, k);
        else
            operands->hull[k] = model_load(args, k, &operands->surface[k]);
        if (!operands->solid[k] && !operands->hull[k])
            return false;
    }
    return true;
}

SUBCOMMAND(impact) {
    struct request request;
    struct operands operands = {{NULL, NULL}, .solid = {NULL, NULL}};
    if (!read_request(args, &request))
        return EXIT_BAD_INPUT;
    struct answer answer = {.seconds = 0};
    for (int k = 0; k < 4; k++)
        mpz_init(answer.polynomial[k]);
    const int result = load(args, &operands) ? run(args, &operands, &request, &answer) : EXIT_BAD_INPUT;
    for (int k = 0; k < 4; k++)
        mpz_clear(answer.polynomial[k]);
    for (int k = 0; k < 2; k++) {
        pir_solid_release(operands.solid[k]);
        pir_polytope_release(operands.hull[k]);
    }
    return result;
}
