/* SPDX-License-Identifier: MIT */
/* A tracked run: a sum carried from frame to frame, timed, and on request held against other ways to make it. */
#ifndef TOOLS_TRACK_H
#define TOOLS_TRACK_H

#include <pirouette/pirouette.h>

#include "args.h"
#include "file.h"
#include "json.h"
#include "times.h"

struct track_request {
    const char *p, *q;       /* the models as they were named */
    pir_surface surfaces[2]; /* and as they were given */
    uint64_t frames, steps, seed;
    bool random; /* random axes from seed, or else `axis` */
    pir_vec3 axis;
    bool difference; /* of the sum of Q and the reflected P */
    bool open;       /* solids without their boundaries */
    pir_method method;
    pir_solid_method solid_method;
    const char *method_name;
    double tolerance; /* 0: exact */
    pir_vec3 region;  /* the axis of the region that is kept, where its half-angle is below 180 degrees */
    double region_degrees;
    bool brute;
    uint64_t verify_every; /* 0: never */
    const char *dump;      /* a folder; NULL for none */
    bool dump_exact;       /* in rationals alone */
    uint64_t dump_every;
    const char *plot; /* a file; NULL for none */
};

struct track_result {
    struct times update_times, walk_times, cgm_times, brute_times;
    struct order update, walk, cgm, brute;
    uint64_t frames;           /* run through: those asked for, or fewer when a signal came */
    bool interrupted;          /* by that signal */
    double seconds;            /* from the polytopes to the last frame's answers */
    pir_sum_statistics did;    /* by the tracked sum, over all frames */
    double shortfall;          /* the greatest bound attained, where there is a tolerance */
    uint64_t warm_up;          /* frames after which memory should no longer grow */
    uint64_t late_allocations; /* times it did */
    uint64_t verified;         /* frames held against a rebuilt sum */
    uint64_t mismatches;       /* how many of them differed */
    uint64_t first_mismatch;   /* the first of these, when there is one */
    uint64_t dumped;           /* frames written */
};

/* Does the run; false after a complaint. Release what stands in *result with track_finish either way. */
bool track_run(const struct track_request *request, pir_polytope *p, pir_polytope *q, struct track_result *result);

void track_finish(struct track_result *result);

/* track --solid; an exit status. */
int solid_track(const struct args *args, const struct track_request *request);

/* --- track_report.c --- */

/* The request, with the frames that were run through: as JSON, and the first lines of the text. */
void track_add_request(struct json *json, const struct track_request *request, uint64_t frames, bool interrupted);
void track_print_motion(const struct track_request *request, uint64_t frames, bool interrupted);

bool track_print_json(const struct track_request *request, const struct track_result *result);
void track_print_text(const struct track_request *request, const struct track_result *result);

/* Draws the times; false, after a complaint, when out of memory. */
bool track_plot(const struct track_request *request, const struct track_result *result, FILE *file);

#endif
