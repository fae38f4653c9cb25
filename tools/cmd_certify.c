/* SPDX-License-Identifier: MIT */
/* pirouette certify: which volume given pieces add to a solid and lose of it, exactly. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include <pirouette/exact.h>

#include "cmd.h"
#include "json.h"
#include "measure.h"
#include "message.h"
#include "pieces.h"
#include "solid.h"
#include "text.h"

struct volumes {
    mpq_t solid, added, lost;
    double seconds;
};

/* A rational as a double and, where it is not that double, as its fraction. */
static void add_volume(struct json *json, const char *name, const mpq_t volume) {
    cJSON *object = json_add_object(json, json->root, name);
    char *exact = mpq_get_str(NULL, 10, volume);
    json_add_number(json, object, "volume", mpq_get_d(volume));
    json_add_text(json, object, "exact", exact);
    free(exact);
}

static bool print_json(const struct args *args, const struct pieces *pieces, const struct volumes *volumes) {
    struct json json = json_new();
    json_add_text(&json, json.root, "pieces_of", args->positional[0]);
    json_add_text(&json, json.root, "model", args->positional[1]);
    json_add_count(&json, json.root, "pieces", pieces->count);
    add_volume(&json, "solid", volumes->solid);
    add_volume(&json, "added", volumes->added);
    add_volume(&json, "lost", volumes->lost);
    json_add_flag(&json, json.root, "same", mpq_sgn(volumes->added) == 0 && mpq_sgn(volumes->lost) == 0);
    json_add_number(&json, json.root, "seconds", volumes->seconds);
    return json_print(&json, stdout);
}

/* A volume, its share of the solid's, and its fraction where that is short. */
static void print_volume(const char *name, const mpq_t volume, const mpq_t solid) {
    char number[TEXT_NUMBER], share[TEXT_NUMBER];
    mpq_t part;
    mpq_init(part);
    mpq_div(part, volume, solid);
    text_double(mpq_get_d(volume), number);
    text_double(100 * mpq_get_d(part), share);
    char *exact = mpq_get_str(NULL, 10, volume);
    if (mpq_sgn(volume) == 0)
        say("  %-10s nothing\n", name);
    else
        say("  %-10s %s, %s %% of the solid\n", name, number, share);
    if (mpz_cmp_ui(mpq_denref(volume), 1) != 0)
        say("  %-10s exactly %s\n", "", exact);
    free(exact);
    mpq_clear(part);
}

static void print_text(const struct args *args, const struct pieces *pieces, const struct volumes *volumes) {
    char time[TEXT_NUMBER], number[TEXT_NUMBER];
    text_time(volumes->seconds * 1e9, time);
    text_double(mpq_get_d(volumes->solid), number);
    say("%" PRIu32 " pieces of %s for %s\n", pieces->count, args->positional[0], args->positional[1]);
    say("  %-10s %s\n", "solid", number);
    print_volume("added", volumes->added, volumes->solid);
    print_volume("lost", volumes->lost, volumes->solid);
    say("  %-10s %s\n", "time", time);
}

static int certify(const struct args *args, const pir_solid *solid, const struct pieces *pieces) {
    pir_report report = {0};
    pir_solid_options options = pir_solid_options_default();
    struct volumes volumes;
    int result = EXIT_BAD_INPUT;
    mpq_inits(volumes.solid, volumes.added, volumes.lost, NULL);
    options.report = &report;
    const int64_t start = clock_now();
    pir_status status = pir_solid_volume_exact(solid, volumes.solid);
    if (status == PIR_OK)
        status = pir_solid_certify_exact(solid, pieces->at, pieces->count, &options, volumes.added, volumes.lost);
    volumes.seconds = (double)(clock_now() - start) / 1e9;
    if (status != PIR_OK) {
        complain_status("certify", status, &report);
    } else if (args_has(args, "--json")) {
        result = print_json(args, pieces, &volumes) ? EXIT_DONE : EXIT_BAD_INPUT;
    } else {
        print_text(args, pieces, &volumes);
        result = EXIT_DONE;
    }
    mpq_clears(volumes.solid, volumes.added, volumes.lost, NULL);
    return result;
}

SUBCOMMAND(certify) {
    struct pieces pieces = {0};
    pir_solid *solid = NULL;
    int result = EXIT_BAD_INPUT;
    if (pieces_load(args, 0, &pieces) && (solid = solid_load(args, 1)))
        result = certify(args, solid, &pieces);
    pir_solid_release(solid);
    pieces_release(&pieces);
    return result;
}
