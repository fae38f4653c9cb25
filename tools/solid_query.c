/* SPDX-License-Identifier: MIT */
/* pirouette query --solid: two models as the solids that they are, in pieces. */
#include <inttypes.h>
#include <stdio.h>

#include "certificate.h"
#include "json.h"
#include "measure.h"
#include "message.h"
#include "solid.h"
#include "target.h"

struct outcome {
    pir_solid_distance distance;
    pir_solid_depth depth;
    pir_impact impact;
    uint32_t pieces[2];
    double seconds;               /* of the answers, pieces being there */
    pir_certificate *certificate; /* where one is wanted */
    const char *option;           /* what was asked last, or NULL before */
};

/* A cast ends this near, relative to how far the models reach. */
#define CAST_TOLERANCE 1e-6

/* A question: where P is, how it moves in a cast, and what is to be proven. */
struct question {
    pir_pair_input input;
    bool casts, certifies;
    pir_vec3 way;
    pir_proven proven;
};

static const char *const state_names[] = {"outside", "boundary", "inside"};
static const char *const cast_names[] = {"hit", "miss", "receding", "start inside", "at rest", "step limit"};

static bool check_options(const struct args *args) {
    static const char *const others[] = {"--direction", "--batch", "-o"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (args_has(args, others[i])) {
            complain("query: %s is not for solids: leave it out, or --solid", others[i]);
            return false;
        }
    return true;
}

static void add_vector(struct json *json, cJSON *parent, const char *name, pir_vec3 v) {
    json_add_numbers(json, parent, name, (const double[]){v.x + 0.0, v.y + 0.0, v.z + 0.0}, 3);
}

static void add_feature(struct json *json, cJSON *parent, const char *name, pir_feature feature) {
    static const char *const kinds[] = {"none", "vertex", "edge", "facet"};
    cJSON *object = json_add_object(json, parent, name);
    json_add_text(json, object, "kind", kinds[feature.kind]);
    json_add_number(json, object, "index", feature.index);
}

/* The depth, and the facet of a sum of pieces that P leaves by. */
static void add_depth(struct json *json, const pir_solid_depth *depth) {
    cJSON *closest = json_add_object(json, json->root, "closest");
    add_vector(json, closest, "p", depth->point_p);
    add_vector(json, closest, "q", depth->point_q);
    add_vector(json, json->root, "normal", depth->normal);
    cJSON *penetration = json_add_object(json, json->root, "penetration");
    json_add_number(json, penetration, "depth", depth->depth);
    add_vector(json, penetration, "normal", depth->normal);
    json_add_number(json, penetration, "facets", depth->facets);
    json_add_numbers(json, penetration, "pieces", (const double[]){depth->facet[0].piece_p, depth->facet[0].piece_q},
                     2);
    add_feature(json, penetration, "p", depth->facet[0].witness.p);
    add_feature(json, penetration, "q", depth->facet[0].witness.q);
}

static bool print_json(const struct args *args, const struct question *asked, const struct outcome *outcome) {
    const pir_quat r = asked->input.pose_p.rotation;
    const pir_query_result *result = &outcome->distance.result;
    struct json json = json_new();
    json_add_text(&json, json.root, "p", args->positional[0]);
    json_add_text(&json, json.root, "q", args->positional[1]);
    json_add_flag(&json, json.root, "solid", true);
    json_add_numbers(&json, json.root, "quat", (const double[]){r.x, r.y, r.z, r.w}, 4);
    add_vector(&json, json.root, "translation", asked->input.pose_p.translation);
    json_add_text(&json, json.root, "state", state_names[result->state]);
    if (result->state != PIR_INSIDE) {
        cJSON *closest = json_add_object(&json, json.root, "closest");
        json_add_number(&json, json.root, "distance", result->distance);
        add_vector(&json, closest, "p", result->point_p);
        add_vector(&json, closest, "q", result->point_q);
        add_vector(&json, json.root, "normal", result->normal);
    } else {
        add_depth(&json, &outcome->depth);
    }
    if (asked->casts) {
        cJSON *cast = json_add_object(&json, json.root, "cast");
        json_add_text(&json, cast, "outcome", cast_names[outcome->impact.outcome]);
        if (outcome->impact.outcome != PIR_CAST_MISS)
            json_add_number(&json, cast, "time", outcome->impact.time);
    }
    json_add_numbers(&json, json.root, "pieces", (const double[]){outcome->pieces[0], outcome->pieces[1]}, 2);
    json_add_number(&json, json.root, "pairs", outcome->distance.pairs);
    json_add_number(&json, json.root, "seconds", outcome->seconds);
    return json_print(&json, stdout);
}

static void print_text(const struct args *args, const struct outcome *outcome, bool casts) {
    const pir_query_result *result = &outcome->distance.result;
    say("%s against %s, as solids: %s\n", args->positional[0], args->positional[1], state_names[result->state]);
    if (result->state != PIR_INSIDE) {
        say("  %-12s %.17g\n", "distance", result->distance);
    } else {
        say("  %-12s %.17g\n", "depth", outcome->depth.depth);
    }
    const pir_vec3 normal = result->state == PIR_INSIDE ? outcome->depth.normal : result->normal;
    say("  %-12s %.17g, %.17g, %.17g\n", "normal", normal.x, normal.y, normal.z);
    if (casts && outcome->impact.outcome != PIR_CAST_MISS)
        say("  %-12s %s, time %.17g\n", "cast", cast_names[outcome->impact.outcome], outcome->impact.time);
    else if (casts)
        say("  %-12s miss\n", "cast");
    say("  %-12s %" PRIu32 " of P, %" PRIu32 " of Q\n", "pieces", outcome->pieces[0], outcome->pieces[1]);
}

static double reach_of(const pir_solid *solid) {
    pir_solid_info info;
    pir_solid_describe(solid, &info);
    return (info.high.x - info.low.x) + (info.high.y - info.low.y) + (info.high.z - info.low.z);
}

static pir_status ask(pir_solid_query *query, pir_workspace *workspace, const struct question *asked, double tolerance,
                      struct outcome *outcome) {
    const int64_t start = clock_now();
    const pir_motion motion = {.way = asked->way};
    const pir_pair_input *input = &asked->input;
    outcome->option = "--translate";
    pir_status status = pir_solid_query_distance(query, workspace, input, &outcome->distance);
    if (status == PIR_OK && outcome->distance.result.state == PIR_INSIDE)
        status = pir_solid_query_depth(query, workspace, input, &outcome->depth);
    if (status == PIR_OK && asked->casts) {
        outcome->option = "--cast";
        status = pir_solid_query_cast(query, workspace, input, &motion, tolerance, &outcome->impact);
    }
    outcome->seconds = (double)(clock_now() - start) / 1e9;
    if (status == PIR_OK && asked->certifies) {
        outcome->option = "--certificate";
        status =
            pir_solid_query_certificate(query, input, &outcome->distance.result, asked->proven, &outcome->certificate);
    }
    return status;
}

static pir_status run(const pir_solid *const solid[2], const struct question *asked, pir_report *report,
                      struct outcome *outcome) {
    pir_decompose_options options = pir_decompose_options_default();
    pir_pieces *pieces[2] = {NULL, NULL};
    pir_solid_query *query = NULL;
    pir_workspace *workspace = NULL;
    const double tolerance = CAST_TOLERANCE * (reach_of(solid[0]) + reach_of(solid[1]));
    pir_status status = pir_workspace_create(NULL, &workspace);
    options.report = report;
    for (int k = 0; k < 2 && status == PIR_OK; k++)
        status = pir_solid_decompose(solid[k], &options, NULL, &pieces[k]);
    if (status == PIR_OK)
        status = pir_solid_query_create(pieces[0], pieces[1], NULL, &query);
    if (status == PIR_OK)
        status = ask(query, workspace, asked, tolerance, outcome);
    for (int k = 0; k < 2; k++) {
        outcome->pieces[k] = pieces[k] ? pir_pieces_count(pieces[k]) : 0;
        pir_pieces_destroy(pieces[k]);
    }
    pir_solid_query_destroy(query);
    pir_workspace_destroy(workspace);
    return status;
}

/* Writes what was found: the certificate, if any, then the answer. */
static int tell(const struct args *args, const struct question *asked, const struct outcome *outcome) {
    if (outcome->certificate && !certificate_write(args, outcome->certificate))
        return EXIT_BAD_INPUT;
    if (args_has(args, "--json"))
        return print_json(args, asked, outcome) ? EXIT_DONE : EXIT_BAD_INPUT;
    if (!target_is_stdout(args, "--certificate"))
        print_text(args, outcome, asked->casts);
    return EXIT_DONE;
}

int solid_query(const struct args *args, const pir_query_input *input, pir_quat rotation, const pir_vec3 *motion,
                int proven) {
    if (!check_options(args))
        return EXIT_BAD_INPUT;
    struct question asked = {.input = pir_pair_input_default(), .casts = motion, .proven = (pir_proven)proven};
    asked.input.pose_p = (pir_pose){rotation, input->translation};
    asked.input.radius_p = input->radius_p;
    asked.input.radius_q = input->radius_q;
    asked.certifies = args_has(args, "--certificate");
    if (motion)
        asked.way = *motion;
    struct outcome outcome = {.pieces = {0, 0}};
    pir_report report = {0};
    int result = EXIT_BAD_INPUT;
    pir_solid *p = solid_load(args, 0), *q = p ? solid_load(args, 1) : NULL;
    if (p && q) {
        const pir_status status = run((const pir_solid *const[]){p, q}, &asked, &report, &outcome);
        if (status == PIR_ERR_LIMIT && outcome.option)
            complain("query: %s: '%s': %s", outcome.option, args_value(args, outcome.option), pir_status_text(status));
        else if (status != PIR_OK)
            complain_status("query", status, &report);
        else
            result = tell(args, &asked, &outcome);
    }
    pir_solid_release(q);
    pir_solid_release(p);
    return result;
}
