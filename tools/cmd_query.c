/* SPDX-License-Identifier: MIT */
/*
 * pirouette query: P, turned and moved, against Q: overlap, distance, depth, a direction, a cast; one placement or a
 * file of them.
 */
#include <stdio.h>

#include <math.h>

#include "args.h"
#include "certificate.h"
#include "cmd.h"
#include "json.h"
#include "measure.h"
#include "message.h"
#include "model.h"
#include "pose.h"
#include "query_batch.h"
#include "query_picture.h"
#include "solid.h"
#include "surface.h"
#include "target.h"

struct request {
    pir_quat rotation;
    pir_query_input input;
    bool has_direction, casts;
    int proven; /* of pir_proven, for --certificate */
    pir_vec3 direction, motion;
    pir_surface surfaces[2]; /* of P and Q as given */
};

struct answer {
    pir_query_result result;
    pir_query_result along; /* directional depth or distance */
    pir_impact cast;
    double seconds; /* from the polytopes to the answer */
};

static bool read_vector(const struct args *args, const char *name, pir_vec3 *to) {
    double v[3] = {to->x, to->y, to->z};
    if (!args_numbers(args, name, 3, v))
        return false;
    *to = (pir_vec3){v[0], v[1], v[2]};
    return true;
}

static bool read_radius(const struct args *args, const char *name, double *radius) {
    if (!args_numbers(args, name, 1, radius))
        return false;
    if (*radius < 0) {
        complain("query: %s: %s is less than 0", name, args_value(args, name));
        return false;
    }
    return true;
}

/* Reads what --certificate is to prove, after checks. */
static bool read_proof(const struct args *args, int *proven) {
    // with these the bodies are not those of the models, or there are many answers
    static const char *const others[] = {"--merge", "--radius-p", "--radius-q", "--batch", NULL};
    static const char *const words[] = {"state", "number", NULL};
    *proven = PIR_PROVEN_NUMBER;
    if (args_has(args, "--prove") && !args_has(args, "--certificate")) {
        complain("query: --prove says what a certificate proves: give --certificate FILE");
        return false;
    }
    return certificate_check(args, others) && args_choice(args, "--prove", words, proven);
}

static bool read_request(const struct args *args, struct request *request) {
    *request = (struct request){.input = pir_query_input_default()};
    if (!pose_read(args, &request->rotation) || !read_vector(args, "--translate", &request->input.translation) ||
        !read_radius(args, "--radius-p", &request->input.radius_p) ||
        !read_radius(args, "--radius-q", &request->input.radius_q))
        return false;
    if (!isfinite(request->input.radius_p + request->input.radius_q)) {
        complain("query: --radius-p and --radius-q: too large together");
        return false;
    }
    request->has_direction = args_has(args, "--direction");
    request->casts = args_has(args, "--cast");
    if (!read_vector(args, "--direction", &request->direction) || !read_vector(args, "--cast", &request->motion))
        return false;
    if (!args_has(args, "--translate") && !args_has(args, "--batch")) {
        complain("query: say where P stands: --translate x,y,z or --batch FILE.csv");
        return false;
    }
    if (args_has(args, "--batch") && !args_has(args, "-o")) {
        complain("query: --batch needs -o FILE.csv for its answers");
        return false;
    }
    if (request->has_direction && request->direction.x == 0 && request->direction.y == 0 && request->direction.z == 0) {
        complain("query: --direction: '%s' is the zero vector, which has no direction",
                 args_value(args, "--direction"));
        return false;
    }
    return target_check(args, "-o", args_has(args, "--batch") ? NULL : ".svg") && read_proof(args, &request->proven);
}

/* Asks all that is asked for; *ret_option names the option that a failure is about. */
static pir_status ask(pir_query *query, const struct request *request, struct answer *answer, const char **ret_option) {
    pir_query_cache cache = {0};
    *ret_option = "--translate";
    pir_status status = pir_query_signed_distance(query, &request->input, &cache, &answer->result);
    if (status == PIR_OK && request->has_direction) {
        *ret_option = "--direction";
        status = answer->result.state == PIR_INSIDE
                     ? pir_query_directional_depth(query, &request->input, request->direction, &answer->along)
                     : pir_query_directional_distance(query, &request->input, request->direction, &answer->along);
    }
    if (status == PIR_OK && request->casts) {
        *ret_option = "--cast";
        status = pir_query_cast(query, &request->input, request->motion, &answer->cast);
    }
    return status;
}

/* --- printing --- */

static const char *const state_names[] = {"outside", "boundary", "inside"};
static const char *const cast_names[] = {"hit", "miss", "receding", "start inside", "at rest", "step limit"};

/* Two letters, P's feature and Q's: "fv", "ee". */
static void witness_kind(const pir_witness *witness, char text[3]) {
    static const char letters[] = "-vef";
    text[0] = letters[witness->p.kind];
    text[1] = letters[witness->q.kind];
    text[2] = 0;
}

static void add_vector(struct json *json, cJSON *parent, const char *name, pir_vec3 v) {
    // + 0.0 turns −0 into 0
    const double numbers[3] = {v.x + 0.0, v.y + 0.0, v.z + 0.0};
    json_add_numbers(json, parent, name, numbers, 3);
}

static void add_witness(struct json *json, cJSON *parent, const pir_witness *witness) {
    char kind[3];
    cJSON *object = json_add_object(json, parent, "witness");
    witness_kind(witness, kind);
    json_add_text(json, object, "kind", kind);
    json_add_number(json, object, "p", witness->p.index);
    json_add_number(json, object, "q", witness->q.index);
}

static bool print_json(const struct args *args, const struct request *request, const struct answer *answer) {
    const double quat[4] = {request->rotation.x, request->rotation.y, request->rotation.z, request->rotation.w};
    const pir_query_result *result = &answer->result;
    struct json json = json_new();
    json_add_text(&json, json.root, "p", args->positional[0]);
    json_add_text(&json, json.root, "q", args->positional[1]);
    json_add_numbers(&json, json.root, "quat", quat, 4);
    add_vector(&json, json.root, "translation", request->input.translation);
    json_add_text(&json, json.root, "state", state_names[result->state]);
    if (result->state != PIR_INSIDE)
        json_add_number(&json, json.root, "distance", result->distance);
    cJSON *closest = json_add_object(&json, json.root, "closest");
    add_vector(&json, closest, "p", result->point_p);
    add_vector(&json, closest, "q", result->point_q);
    add_vector(&json, json.root, "normal", result->normal);
    if (result->state == PIR_INSIDE) {
        cJSON *penetration = json_add_object(&json, json.root, "penetration");
        json_add_number(&json, penetration, "depth", -result->distance);
        add_vector(&json, penetration, "normal", result->normal);
    }
    if (request->has_direction) {
        bool hits = answer->along.outcome != PIR_NO_HIT;
        cJSON *directional = json_add_object(&json, json.root, "directional");
        if (result->state == PIR_INSIDE)
            json_add_number(&json, directional, "depth", -answer->along.distance);
        else
            json_add_number(&json, directional, "distance", hits ? answer->along.distance : HUGE_VAL);
        json_add_flag(&json, directional, "hits", hits);
    }
    if (request->casts) {
        cJSON *cast = json_add_object(&json, json.root, "cast");
        json_add_text(&json, cast, "outcome", cast_names[answer->cast.outcome]);
        json_add_number(&json, cast, "time", answer->cast.time);
        if (answer->cast.outcome == PIR_CAST_HIT)
            add_vector(&json, cast, "normal", answer->cast.normal);
    }
    add_witness(&json, json.root, &result->witness);
    json_add_number(&json, json.root, "steps", result->steps);
    json_add_number(&json, json.root, "seconds", answer->seconds);
    surface_add_inputs(&json, request->surfaces, 2);
    return json_print(&json, stdout);
}

static void print_vector(const char *name, pir_vec3 v) {
    say("  %-12s %.17g, %.17g, %.17g\n", name, v.x, v.y, v.z);
}

static void print_text(const struct args *args, const struct request *request, const struct answer *answer) {
    const pir_query_result *result = &answer->result;
    char kind[3];
    witness_kind(&result->witness, kind);
    say("%s against %s: %s\n", args->positional[0], args->positional[1], state_names[result->state]);
    surface_print_notes(request->surfaces, 2);
    if (result->state == PIR_INSIDE)
        say("  %-12s %.17g\n", "depth", -result->distance);
    else
        say("  %-12s %.17g\n", "distance", result->distance);
    print_vector("normal", result->normal);
    print_vector("point of P", result->point_p);
    print_vector("point of Q", result->point_q);
    say("  %-12s %s %u, %u\n", "witness", kind, (unsigned)result->witness.p.index, (unsigned)result->witness.q.index);
    if (request->has_direction && answer->along.outcome == PIR_NO_HIT)
        say("  %-12s never touches\n", "direction");
    else if (request->has_direction)
        say("  %-12s %.17g\n", result->state == PIR_INSIDE ? "depth along" : "touches at",
            fabs(answer->along.distance));
    if (request->casts)
        say("  %-12s %s, time %.17g\n", "cast", cast_names[answer->cast.outcome], answer->cast.time);
    if (args_has(args, "-o"))
        say("  %-12s %s\n", "file", args_value(args, "-o"));
}

/* Writes what proves the answer. */
static bool prove(const struct args *args, const struct request *request, pir_query *query,
                  const struct answer *answer) {
    pir_certificate *certificate;
    pir_status status =
        pir_query_certificate(query, &request->input, &answer->result, (pir_proven)request->proven, &certificate);
    if (status == PIR_OK)
        return certificate_write(args, certificate);
    complain("query: --certificate: '%s': %s", args_value(args, "--certificate"), pir_status_text(status));
    return false;
}

static int run_one(const struct args *args, const struct request *request, pir_polytope *p, pir_polytope *q,
                   pir_query *query, int64_t start) {
    struct answer answer = {0};
    const char *option;
    pir_status status = ask(query, request, &answer, &option);
    answer.seconds = (double)(clock_now() - start) / 1e9;
    if (status != PIR_OK)
        return complain("query: %s: '%s': %s", option, args_value(args, option), pir_status_text(status));
    const char *file = args_value(args, "-o");
    if (file && !query_picture_write(file, p, q, request->rotation, request->input.translation, &answer.result))
        return EXIT_BAD_INPUT;
    if (args_has(args, "--certificate") && !prove(args, request, query, &answer))
        return EXIT_BAD_INPUT;
    if (args_has(args, "--json"))
        return print_json(args, request, &answer) ? EXIT_DONE : EXIT_BAD_INPUT;
    if (!target_is_stdout(args, "-o") && !target_is_stdout(args, "--certificate"))
        print_text(args, request, &answer);
    return EXIT_DONE;
}

SUBCOMMAND(query) {
    struct request request;
    if (!read_request(args, &request))
        return EXIT_BAD_INPUT;
    if (args_has(args, "--solid"))
        return solid_query(args, &request.input, request.rotation, request.casts ? &request.motion : NULL,
                           request.proven);
    int result = EXIT_BAD_INPUT;
    pir_sum *sum = NULL;
    pir_query *query = NULL;
    pir_polytope *q = NULL, *p = model_load(args, 0, &request.surfaces[0]);
    if (p)
        q = model_load(args, 1, &request.surfaces[1]);
    if (!p || !q)
        goto done;
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    int64_t start = clock_now();
    pir_status status = pir_sum_create(p, q, request.rotation, &options, &sum);
    if (status == PIR_OK)
        status = pir_query_create(sum, &query);
    if (status != PIR_OK)
        complain_status("query", status, NULL);
    else if (args_has(args, "--batch"))
        result = query_batch_run(args, query, &request.input, start);
    else
        result = run_one(args, &request, p, q, query, start);

done:
    pir_query_destroy(query);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return result;
}
