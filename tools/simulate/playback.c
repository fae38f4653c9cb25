/* SPDX-License-Identifier: MIT */
/*
 * The page is playback.html with one object of JSON in it, which holds
 *
 *     title, about, rate, quantum, frames
 *     shapes: points, facets   floats of all pieces; the count of facets, then for each that of its corners and these
 *     shapes: surface          whether it is a mesh or a height field
 *     shape, kind              a number for each body
 *     sensors                  which bodies are sensors
 *     backs                    the rollbacks: the time of the run, and that which it goes back to, in seconds
 *     profile                  the work of updates: name, unit, mean, 99th percentile and worst of each part
 *     motion                   the frames
 *
 * The frames are numbers as bytes.h writes them; one that may be negative is twice its size, less 1 where it is. A
 * frame has the count of bodies that moved, for each how many were left out since the one before, and seven changes,
 * three of its place and four of its quaternion; the same for looks, with the new look; then 0 where the contacts are
 * those before, else their count and 1, and for each three changes from the contact before, whether bodies overlap, the
 * two bodies, and the normal on an octahedron folded into a square (Meyer and others, On Floating-Point Normal Vectors,
 * 2010): two numbers from 0 to 126, of which 63 is the middle.
 */
#include "playback.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../message.h"
#include "../views/forms.h"
#include "playback_template.h"

#define DATA_MARK "@DATA@"
/* Parts of 1 in a component of a quaternion. */
#define QUAT_PARTS 16384
/* Quanta in a step of a contact's place. */
#define CONTACT_STEP 8
/* The middle of the square that a normal is in. */
#define NORMAL_MIDDLE 63
/* No number of quanta is greater: JavaScript has whole numbers of 53 bits, and one bit is the sign. */
#define NUMBER_MOST 0x1p50

/* The look of a body, by its contacts, or because it sleeps or is in a sensor. */
enum look { LOOK_ALONE, LOOK_NEAR, LOOK_OVERLAPPING, LOOK_ASLEEP, LOOK_SENSED };

bool playback_init(struct playback *playback, const struct stage *stage) {
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < stage->body_count; i++)
        if (stage->body[i].body.kind == PIR_BODY_MOVING)
            least = fmin(least, stage->body[i].body.shape->radius);
    size_t count = stage->body_count + (size_t)1;
    *playback = (struct playback){.stage = stage, .quantum = (isfinite(least) ? least : 1) / 2000};
    playback->pose = calloc(count, 7 * sizeof *playback->pose);
    playback->look = calloc(count, 1);
    playback->next = calloc(count, 1);
    if (playback->pose && playback->look && playback->next)
        return true;
    complain("simulate: out of memory");
    return false;
}

void playback_clear(struct playback *playback) {
    free(playback->motion.at);
    free(playback->contacts.at);
    free(playback->pose);
    free(playback->look);
    free(playback->next);
    *playback = (struct playback){0};
}

/* The pose of a body of the stage. */
static pir_pose pose_of(const struct playback *playback, const struct world *world, uint32_t i) {
    return i < world_count(world) ? world_motion(world, i).pose : playback->stage->body[i].body.pose;
}

static int64_t whole(double x) {
    return (int64_t)nearbyint(fmin(fmax(x, -NUMBER_MOST), NUMBER_MOST));
}

static void add_signed(struct bytes *bytes, int64_t x) {
    bytes_add_number(bytes, x < 0 ? 2 * (uint64_t)-x - 1 : 2 * (uint64_t)x);
}

static void add_moves(struct playback *playback, const struct world *world) {
    struct bytes moved = {0};
    uint32_t count = 0, last = 0;
    for (uint32_t i = 0; i < playback->stage->body_count; i++) {
        pir_pose pose = pose_of(playback, world, i);
        const pir_vec3 at = pose.translation;
        const double place[3] = {at.x, at.y, at.z};
        const double quat[4] = {pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w};
        int64_t now[7], *before = &playback->pose[7 * (size_t)i];
        for (int k = 0; k < 7; k++)
            now[k] = k < 3 ? whole(place[k] / playback->quantum) : whole(quat[k - 3] * QUAT_PARTS);
        if (memcmp(now, before, sizeof now) == 0)
            continue;
        bytes_add_number(&moved, i - last);
        for (int k = 0; k < 7; k++)
            add_signed(&moved, now[k] - before[k]);
        memcpy(before, now, sizeof now);
        count++;
        last = i + 1;
    }
    bytes_add_number(&playback->motion, count);
    bytes_add(&playback->motion, moved.at, moved.size);
    playback->motion.failed |= moved.failed;
    free(moved.at);
}

static void add_looks(struct playback *playback, const struct world *world) {
    uint32_t count = 0, last = 0;
    memset(playback->next, LOOK_ALONE, world_count(world));
    for (uint32_t k = 0; k < world_contact_count(world); k++) {
        struct world_contact contact = world_contact(world, k);
        const uint32_t both[2] = {contact.body_p, contact.body_q};
        for (int b = 0; b < 2; b++)
            if (contact.distance < 0 || playback->next[both[b]] == LOOK_ALONE)
                playback->next[both[b]] = contact.distance < 0 ? LOOK_OVERLAPPING : LOOK_NEAR;
    }
    for (uint32_t i = 0; i < world_count(world); i++) {
        const struct world_motion motion = world_motion(world, i);
        if (motion.asleep || motion.sensed)
            playback->next[i] = motion.sensed ? LOOK_SENSED : LOOK_ASLEEP;
        count += playback->next[i] != playback->look[i];
    }
    bytes_add_number(&playback->motion, count);
    for (uint32_t i = 0; i < world_count(world); i++)
        if (playback->next[i] != playback->look[i]) {
            bytes_add_number(&playback->motion, i - last);
            bytes_add_number(&playback->motion, playback->next[i]);
            playback->look[i] = playback->next[i];
            last = i + 1;
        }
}

static void add_normal(struct bytes *bytes, pir_vec3 n) {
    const double sum = fabs(n.x) + fabs(n.y) + fabs(n.z), x = sum > 0 ? n.x / sum : 0, y = sum > 0 ? n.y / sum : 0;
    const bool below = n.z < 0;
    const double u = below ? copysign(1 - fabs(y), x) : x, v = below ? copysign(1 - fabs(x), y) : y;
    bytes_add_number(bytes, (uint64_t)whole(NORMAL_MIDDLE * (1 + u)));
    bytes_add_number(bytes, (uint64_t)whole(NORMAL_MIDDLE * (1 + v)));
}

static void add_contacts(struct playback *playback, const struct world *world) {
    struct bytes now = {0};
    int64_t last[3] = {0};
    bytes_add_number(&now, world_contact_count(world) + (uint64_t)1);
    for (uint32_t i = 0; i < world_contact_count(world); i++) {
        struct world_contact contact = world_contact(world, i);
        const double place[3] = {contact.point.x, contact.point.y, contact.point.z};
        for (int k = 0; k < 3; k++) {
            int64_t at = whole(place[k] / (playback->quantum * CONTACT_STEP));
            add_signed(&now, at - last[k]);
            last[k] = at;
        }
        bytes_add_number(&now, contact.distance < 0);
        bytes_add_number(&now, contact.body_p);
        bytes_add_number(&now, contact.body_q);
        add_normal(&now, contact.normal);
    }
    struct bytes *before = &playback->contacts;
    bool same = now.size == before->size && memcmp(now.at, before->at, now.size) == 0;
    if (same)
        bytes_add_number(&playback->motion, 0);
    else
        bytes_add(&playback->motion, now.at, now.size);
    playback->motion.failed |= now.failed;
    free(before->at);
    *before = now;
}

bool playback_add(struct playback *playback, const struct world *world) {
    add_moves(playback, world);
    add_looks(playback, world);
    add_contacts(playback, world);
    playback->frames++;
    if (playback->motion.failed)
        complain("simulate: out of memory");
    return !playback->motion.failed;
}

/* --- the page --- */

/* Adds a triangle, and counts it. */
static void add_triangle(struct bytes *points, struct bytes *facets, const pir_triangle_corners *corners,
                         uint32_t *count) {
    bytes_add_number(facets, 3);
    for (uint32_t k = 0; k < 3; k++) {
        bytes_add_vec(points, corners->corner[k]);
        bytes_add_number(facets, 3 * (uint64_t)*count + k);
    }
    ++*count;
}

/* Adds the triangles of a surface; their number. */
static uint32_t add_surface(struct bytes *points, struct bytes *facets, const struct world_shape *shape) {
    pir_triangle_corners corners;
    uint32_t count = 0, numbers;
    if (shape->mesh) {
        pir_trimesh_info info;
        pir_trimesh_describe(shape->mesh, &info);
        numbers = info.triangles;
    } else {
        pir_height_info info;
        pir_height_field_describe(shape->field, &info);
        numbers = 2 * (info.columns - 1) * (info.rows - 1);
    }
    // a number of a height field that is in a hole has none
    for (uint32_t t = 0; t < numbers; t++)
        if ((shape->mesh ? pir_trimesh_triangle(shape->mesh, t, &corners)
                         : pir_height_field_triangle(shape->field, t, &corners)) == PIR_OK)
            add_triangle(points, facets, &corners, &count);
    return count;
}

static bool print_shape(FILE *file, const struct world_shape *shape) {
    struct bytes points = {0}, facets = {0}, triangles = {0};
    uint32_t first = 0;
    uint64_t count = 0;
    pir_status status = PIR_OK;
    if (world_shape_is_surface(shape))
        count = add_surface(&points, &triangles, shape);
    for (uint32_t i = 0; i < shape->count; i++)
        count += pir_polytope_facet_count(shape->piece[i]);
    bytes_add_number(&facets, count);
    bytes_add(&facets, triangles.at, triangles.size);
    facets.failed |= triangles.failed;
    for (uint32_t i = 0; status == PIR_OK && i < shape->count; i++)
        status = forms_add(&points, &facets, shape->piece[i], &first);
    if (status == PIR_OK && (points.failed || facets.failed))
        status = PIR_ERR_MEMORY;
    if (status == PIR_OK) {
        fputs("{", file);
        forms_print(file, &points, &facets);
        fprintf(file, ",\"surface\":%s}", world_shape_is_surface(shape) ? "true" : "false");
    } else
        complain("simulate: %s", pir_status_text(status));
    free(points.at);
    free(facets.at);
    free(triangles.at);
    return status == PIR_OK;
}

/* Sensors and rollbacks. */
static void print_sensors(FILE *file, const struct stage *stage) {
    const char *before = "";
    fputs("],\"sensors\":[", file);
    for (uint32_t i = 0; i < stage->body_count; i++)
        if (stage->body[i].body.sensor) {
            fprintf(file, "%s%u", before, (unsigned)i);
            before = ",";
        }
    fputs("],\"backs\":[", file);
    for (uint32_t i = 0; i < stage->back_count; i++)
        fprintf(file, "%s[%.6g,%.6g]", i ? "," : "", (double)stage->back[i].at / STAGE_RATE,
                (double)stage->back[i].to / STAGE_RATE);
}

static bool print_data(FILE *file, const struct playback *playback, const char *title, const struct profile *profile) {
    const struct stage *stage = playback->stage;
    bool done = true;
    fputs("{\"title\":", file);
    bytes_print_text(file, title);
    fputs(",\"about\":", file);
    bytes_print_text(file, stage->about);
    fprintf(file, ",\"rate\":%d,\"quantum\":%.17g,\"frames\":%u,\"shapes\":[", PLAYBACK_RATE, playback->quantum,
            (unsigned)playback->frames);
    for (uint32_t i = 0; done && i < stage->shape_count; i++) {
        fputs(i ? "," : "", file);
        done = print_shape(file, &stage->shape[i]);
    }
    fputs("],\"shape\":[", file);
    for (uint32_t i = 0; i < stage->body_count; i++)
        fprintf(file, "%s%u", i ? "," : "", (unsigned)stage->body[i].shape);
    fputs("],\"kind\":[", file);
    for (uint32_t i = 0; i < stage->body_count; i++)
        fprintf(file, "%s%d", i ? "," : "", (int)stage->body[i].body.kind);
    print_sensors(file, stage);
    fputs("],\"profile\":", file);
    if (!profile)
        fputs("[]", file);
    else if (done && !profile_print(file, profile)) {
        complain("simulate: out of memory");
        done = false;
    }
    fputs(",\"motion\":\"", file);
    bytes_print(file, playback->motion.at, playback->motion.size);
    fputs("\"}", file);
    return done;
}

bool playback_print(FILE *file, const struct playback *playback, const char *title, const struct profile *profile) {
    const char *mark = strstr(playback_template, DATA_MARK);
    fwrite(playback_template, 1, (size_t)(mark - playback_template), file);
    bool done = print_data(file, playback, title, profile);
    fputs(mark + strlen(DATA_MARK), file);
    return done;
}
