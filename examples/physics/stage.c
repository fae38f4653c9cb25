/* SPDX-License-Identifier: MIT */
/* Stages; see stage.h. */
#include "stage.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fields.h"
#include "stage_play.h"
#include "stage_shapes.h"
#include "vec.h"

/* A file longer than this is none of ours. */
#define FILE_MOST ((size_t)1 << 28)
/* The most bodies of a scene. */
#define BODIES_MOST 1048576
/* The longest run, in seconds. */
#define SECONDS_MOST 3600

void stage_clear(struct stage *stage) {
    for (uint32_t i = 0; i < stage->shape_count; i++)
        world_shape_release(&stage->shape[i]);
    for (uint32_t i = 0; i < stage->walk_count; i++) {
        free(stage->walk[i].point);
        pir_polytope_release(stage->walk[i].spine);
    }
    free(stage->shape);
    free(stage->body);
    free(stage->walk);
    free(stage->back);
    *stage = (struct stage){0};
}

static bool read_shapes(const struct fields *all, const char *folder, struct stage *stage) {
    struct fields shapes = fields_at(all, "shapes");
    if (!cJSON_IsObject(shapes.object))
        return fields_fail(all, "shapes", shapes.object ? "is no object" : "is missing");
    int count = cJSON_GetArraySize(shapes.object);
    stage->shape = calloc((size_t)count + 1, sizeof *stage->shape);
    if (!stage->shape)
        return fields_fail(all, "shapes", "out of memory");
    for (const cJSON *item = shapes.object->child; item; item = item->next) {
        struct fields one = fields_at(&shapes, item->string);
        if (one.object != item)
            return fields_fail(&shapes, NULL, "key '%.40s' comes twice", item->string);
        if (!stage_shape(&one, folder, &stage->shape[stage->shape_count]))
            return false;
        stage->shape_count++;
    }
    return true;
}

/* The shape of a name, or of copy `copy` where there is an array of names. */
static bool read_shape_of(const struct fields *fields, const struct fields *all, uint32_t copy, struct stage *stage,
                          struct stage_body *to) {
    const cJSON *names = cJSON_GetObjectItemCaseSensitive(fields->object, "shape");
    const bool many = cJSON_IsArray(names) && names->child && cJSON_HasObjectItem(fields->object, "grid");
    const cJSON *one = many ? cJSON_GetArrayItem(names, (int)(copy % (uint32_t)cJSON_GetArraySize(names))) : NULL;
    const char *name = many ? cJSON_GetStringValue(one) : fields_text(fields, "shape");
    if (!name)
        return many ? fields_fail(fields, "shape", "has a name that is no text") : false;
    const cJSON *shapes = cJSON_GetObjectItemCaseSensitive(all->object, "shapes"), *item = shapes->child;
    for (to->shape = 0; item && strcmp(item->string, name) != 0; item = item->next)
        to->shape++;
    if (!item)
        return fields_fail(fields, "shape", "there is no shape '%.40s'", name);
    to->body.shape = &stage->shape[to->shape];
    return true;
}

/* The bodies that stand in one place of the file: one, or those of a grid. */
struct grid {
    double count[3], apart[3];
    double seed; /* of turns; −1 for none */
};

static bool read_grid(const struct fields *fields, struct grid *ret_grid) {
    struct grid grid = *ret_grid = (struct grid){{1, 1, 1}, {0, 0, 0}, -1};
    const bool is = cJSON_HasObjectItem(fields->object, "grid");
    if (!fields_numbers(fields, "grid", 3, grid.count) || !fields_numbers(fields, "apart", 3, grid.apart) ||
        !fields_number(fields, "turned", 0, UINT32_MAX, &grid.seed))
        return false;
    if (!is && (cJSON_HasObjectItem(fields->object, "apart") || grid.seed >= 0))
        return fields_fail(fields, "grid", "is missing, of which 'apart' and 'turned' are");
    if (is && cJSON_HasObjectItem(fields->object, "walk"))
        return fields_fail(fields, "walk", "is of single bodies");
    for (int k = 0; k < 3; k++)
        if (!(grid.count[k] >= 1 && grid.count[k] <= BODIES_MOST && grid.count[k] == nearbyint(grid.count[k])))
            return fields_fail(fields, "grid", "element %d is no count", k);
    if (grid.count[0] * grid.count[1] * grid.count[2] > BODIES_MOST)
        return fields_fail(fields, "grid", "has more than %d bodies", BODIES_MOST);
    *ret_grid = grid;
    return true;
}

/* Brings a body to its place in the grid. */
static void place_copy(const struct grid *grid, uint32_t copy, struct world_body *body) {
    const uint32_t x = (uint32_t)grid->count[0], y = (uint32_t)grid->count[1];
    const double place[3] = {copy % x, copy / x % y, copy / x / y};
    uint32_t state = (uint32_t)grid->seed + 747796405u * copy;
    double turn[4];
    for (int k = 0; k < 4; k++) {
        for (int round = 0; round < 3; round++)
            state = (state ^ state >> 15) * 2891336453u + 1013904223u;
        turn[k] = (state >> 8) / 8388608. - 1;
    }
    if (grid->seed >= 0)
        body->pose.rotation = (pir_quat){turn[0], turn[1], turn[2], turn[3] + 4e-9}; // never of length 0
    const pir_vec3 by = {place[0] * grid->apart[0], place[1] * grid->apart[1], place[2] * grid->apart[2]};
    body->pose.translation = vec_add(body->pose.translation, by);
}

static bool read_body(const struct fields *fields, const struct fields *all, const struct grid *grid, uint32_t copy,
                      struct stage *stage, struct stage_body *to) {
    static const char *const known[] = {"shape",   "kind",     "position",    "quat", "velocity", "spin",
                                        "density", "friction", "sensor",      "walk", "speed",    "grid",
                                        "apart",   "turned",   "restitution", NULL};
    static const char *const kinds[] = {"moving", "kinematic", "static", NULL};
    struct world_body *body = &to->body;
    double position[3] = {0}, quat[4] = {0, 0, 0, 1}, velocity[3] = {0}, spin[3] = {0};
    int kind = PIR_BODY_MOVING;
    *body = (struct world_body){.density = 1000, .friction = 0.6};
    if (!fields_known(fields, known) || !read_shape_of(fields, all, copy, stage, to) ||
        !fields_choice(fields, "kind", kinds, &kind) || !fields_numbers(fields, "position", 3, position) ||
        !fields_numbers(fields, "quat", 4, quat) || !fields_numbers(fields, "velocity", 3, velocity) ||
        !fields_numbers(fields, "spin", 3, spin) || !fields_number(fields, "density", 1e-9, 1e15, &body->density) ||
        !fields_number(fields, "friction", 0, 1e3, &body->friction) ||
        !fields_number(fields, "restitution", 0, 1, &body->restitution) ||
        !fields_flag(fields, "sensor", &body->sensor))
        return false;
    if (quat[0] == 0 && quat[1] == 0 && quat[2] == 0 && quat[3] == 0)
        return fields_fail(fields, "quat", "has length 0");
    if (kind == PIR_BODY_MOVING && world_shape_is_surface(body->shape))
        return fields_fail(fields, "shape", "is a surface; a body that moves by itself is of convex pieces");
    if (kind == PIR_BODY_MOVING && body->sensor)
        return fields_fail(fields, "sensor", "is of bodies that do not move by themselves");
    if (kind == PIR_BODY_MOVING && !(body->shape->mass.volume > 0))
        return fields_fail(fields, "shape", "is flat; a body that moves by itself has a volume");
    if (kind == PIR_BODY_STATIC &&
        (cJSON_HasObjectItem(fields->object, "velocity") || cJSON_HasObjectItem(fields->object, "spin")))
        return fields_fail(fields, NULL, "is static, and has a velocity or a spin");
    body->kind = (pir_body_kind)kind;
    body->pose = (pir_pose){{quat[0], quat[1], quat[2], quat[3]}, {position[0], position[1], position[2]}};
    place_copy(grid, copy, body);
    body->pose.translation = pir_pose_apply(body->pose, body->shape->offset);
    body->velocity = (pir_vec3){velocity[0], velocity[1], velocity[2]};
    body->spin = (pir_vec3){spin[0], spin[1], spin[2]};
    return true;
}

/* Room for so many bodies more. */
static bool reserve_bodies(struct stage *stage, uint32_t more, uint32_t *room) {
    const uint32_t wanted = 2 * stage->body_count + more;
    struct stage_body *grown = realloc(stage->body, wanted * sizeof *grown);
    if (!grown)
        return false;
    stage->body = grown;
    *room = wanted;
    return true;
}

static bool read_bodies(const struct fields *all, struct stage *stage) {
    const cJSON *bodies = cJSON_GetObjectItemCaseSensitive(all->object, "bodies");
    if (!cJSON_IsArray(bodies))
        return fields_fail(all, "bodies", bodies ? "is no array" : "is missing");
    uint32_t room = 0, number = 0;
    for (const cJSON *item = bodies->child; item; item = item->next, number++) {
        struct fields one = {.object = item, .why = all->why, .size = all->size};
        struct grid grid;
        snprintf(one.place, sizeof one.place, "bodies[%u]", (unsigned)number);
        if (!cJSON_IsObject(item))
            return fields_fail(&one, NULL, "is no object");
        if (!read_grid(&one, &grid))
            return false;
        const uint32_t copies = (uint32_t)(grid.count[0] * grid.count[1] * grid.count[2]);
        if (stage->body_count + copies > BODIES_MOST)
            return fields_fail(&one, NULL, "there are more than %d bodies", BODIES_MOST);
        if (stage->body_count + copies > room && !reserve_bodies(stage, copies, &room))
            return fields_fail(all, "bodies", "out of memory");
        for (uint32_t i = 0; i < copies; i++, stage->body_count++)
            if (!read_body(&one, all, &grid, i, stage, &stage->body[stage->body_count]))
                return false;
        if (!stage_play_walk(&one, stage, stage->body_count - 1))
            return false;
    }
    return stage->body_count > 0 || reserve_bodies(stage, 1, &room) || fields_fail(all, "bodies", "out of memory");
}

/* A text, or "" where there is none. */
static bool read_line(const struct fields *all, const char *name, size_t size, char *text) {
    const char *read = cJSON_HasObjectItem(all->object, name) ? fields_text(all, name) : "";
    if (!read)
        return false;
    if (strlen(read) >= size)
        return fields_fail(all, name, "is longer than %zu bytes", size - 1);
    memcpy(text, read, strlen(read) + 1);
    return true;
}

static bool read_all(const struct fields *all, const char *folder, struct stage *stage) {
    static const char *const known[] = {"title",      "about",       "gravity", "seconds", "margin",    "sleep",
                                        "iterations", "relaxations", "shapes",  "bodies",  "rollbacks", NULL};
    struct world_options *options = &stage->options;
    double gravity[3] = {options->gravity.x, options->gravity.y, options->gravity.z};
    double iterations = options->iterations, relaxations = options->relaxations;
    if (!fields_known(all, known) || !fields_numbers(all, "gravity", 3, gravity) ||
        !fields_number(all, "seconds", 0, SECONDS_MOST, &stage->seconds) ||
        !fields_number(all, "margin", 0, 1e6, &options->margin) || !fields_flag(all, "sleep", &options->sleep) ||
        !fields_number(all, "iterations", 1, 1000, &iterations) ||
        !fields_number(all, "relaxations", 0, 1000, &relaxations))
        return false;
    options->gravity = (pir_vec3){gravity[0], gravity[1], gravity[2]};
    options->iterations = (uint32_t)iterations;
    options->relaxations = (uint32_t)relaxations;
    return read_line(all, "title", sizeof stage->title, stage->title) &&
           read_line(all, "about", sizeof stage->about, stage->about) && read_shapes(all, folder, stage) &&
           read_bodies(all, stage) && stage_play_backs(all, stage);
}

/* --- the file --- */

/* All of the file, ended by a zero, to be freed; NULL after a line. */
static char *read_text(const char *path, char why[STAGE_WHY]) {
    bool from_stdin = strcmp(path, "-") == 0;
    FILE *file = from_stdin ? stdin : fopen(path, "rb");
    char *text = NULL;
    size_t used = 0, room = 0;
    bool memory = true;
    while (file && memory && used <= FILE_MOST && !feof(file) && !ferror(file)) {
        if (room - used < 4096) {
            char *grown = realloc(text, room += room + 65536);
            memory = grown;
            text = grown ? grown : text;
        }
        if (memory)
            used += fread(text + used, 1, room - used - 1, file);
    }
    bool good = false;
    if (!file || ferror(file))
        snprintf(why, STAGE_WHY, "cannot be read: %s", strerror(errno));
    else if (!memory)
        snprintf(why, STAGE_WHY, "out of memory");
    else if (used > FILE_MOST)
        snprintf(why, STAGE_WHY, "is longer than %zu bytes", FILE_MOST);
    else if (memchr(text, 0, used))
        snprintf(why, STAGE_WHY, "has a zero byte; it is no text");
    else
        good = true;
    if (file && !from_stdin)
        fclose(file);
    if (good) {
        text[used] = '\0';
        return text;
    }
    free(text);
    return NULL;
}

static void say_where(const char *text, const char *end, char why[STAGE_WHY]) {
    size_t line = 1, column = 1;
    for (const char *at = text; at < end; at++, column++)
        if (*at == '\n') {
            line++;
            column = 0;
        }
    snprintf(why, STAGE_WHY, "line %zu, column %zu: is no JSON", line, column);
}

/* Reads a text, with the folder of `path` for its files. */
static bool read_from(const char *path, const char *text, struct stage *stage, char why[STAGE_WHY]) {
    const char *end = text;
    cJSON *root = cJSON_ParseWithLengthOpts(text, strlen(text) + 1, &end, 1);
    const char *slash = strrchr(path, '/');
    char folder[4096];
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - path) + 1 : 0, path);
    struct fields all = {.object = root, .why = why, .size = STAGE_WHY};
    if (!root)
        say_where(text, end, why);
    bool good = root && read_all(&all, folder, stage);
    cJSON_Delete(root);
    return good;
}

/* Names from the file may hold ends of lines, and what a terminal obeys. */
static void make_one_line(char *text) {
    for (; *text; text++)
        if ((unsigned char)*text < ' ' || *text == 127)
            *text = '?';
}

/* The stage of a text, or of none after a line in `what`. */
static bool finish(const char *name, const char *path, const char *text, char what[STAGE_WHY], struct stage *ret_stage,
                   char why[STAGE_WHY]) {
    struct stage stage = {.options = world_options_default(), .seconds = 10};
    if (text && read_from(path, text, &stage, what)) {
        *ret_stage = stage;
        return true;
    }
    stage_clear(&stage);
    make_one_line(what);
    const int room = STAGE_WHY / 2 - 4;
    snprintf(why, STAGE_WHY, "%.*s: %.*s", room, name, room, what);
    return false;
}

bool stage_read(const char *path, struct stage *ret_stage, char why[STAGE_WHY]) {
    char what[STAGE_WHY] = "";
    char *text = read_text(path, what);
    const bool good = finish(strcmp(path, "-") == 0 ? "standard input" : path, path, text, what, ret_stage, why);
    free(text);
    return good;
}

bool stage_read_text(const char *name, const char *text, struct stage *ret_stage, char why[STAGE_WHY]) {
    char what[STAGE_WHY] = "";
    return finish(name, "", text, what, ret_stage, why);
}

pir_status stage_world(const struct stage *stage, struct world **ret_world) {
    struct world *world = NULL;
    pir_status status = world_create(&stage->options, &world);
    for (uint32_t i = 0; status == PIR_OK && i < stage->body_count; i++)
        status = world_add(world, &stage->body[i].body);
    if (status == PIR_OK)
        *ret_world = world;
    else
        world_destroy(world);
    return status;
}
