/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as a scene of bodies, some with coarse ones, and questions how far a shape is from them all:
 *
 *     coarse bodies are inside of their body, which reaches no farther beyond them than they say, by rationals;
 *     each distance that is told has the exact distance of the full bodies between its bounds: that of a pair made for
 *     it and, where the bodies are small and Q is not turned, that of exact arithmetic (place_oracle.h);
 *     bounds are as near to each other as was asked for; which pieces are told, and their states, do not depend on the
 *     accuracy, and are those that pairs find within the cutoff;
 *     the same question has the same answer, and less room the first of all.
 *
 * The bytes: shapes, bodies, then questions with moves between them. See fuzz_sum.c for how to run an engine.
 */
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include <pirouette/scene.h>
#include <pirouette/scene_query.h>

#include "fuzz/input.h"
#include "oracle/distance.h"
#include "query/place_oracle.h"
#include "support/bodies.h"

#define SHAPES     3
#define BODIES     6
#define PIECES     2
#define ALL        (BODIES * PIECES)
#define QUESTIONS  6
#define POINTS     8
#define ROUND_MOST 40 /* vertices of bodies that have coarse ones of fewer */
#define EXACT_MOST 36 /* pairs of vertices, for the oracle of placements */

struct shape {
    pir_polytope *polytope;
    pir_coarse *coarse;
};

/* A body as it was added, by the scene's numbers; pieces are numbers of shapes. */
struct body {
    pir_body_options options;
    uint32_t piece[PIECES];
};

struct world {
    struct shape shape[SHAPES];
    struct body body[BODIES];
    uint32_t shapes, bodies;
    pir_scene *scene;
    pir_workspace *workspace;
};

/* --- bodies with coarse ones --- */

/* Points about a middle, on a sphere or a grid, as long as the exponents say along each axis. */
static pir_polytope *round_body(struct fuzz_input *input) {
    test_points points = {.count = 16 + fuzz_byte(input) % (ROUND_MOST - 15)};
    test_random random = test_random_case("round body", fuzz_byte(input));
    uint8_t form = fuzz_byte(input);
    const double scale = form % 8 == 7 ? 1e-100 : form % 8 == 6 ? 1e6 : 1;
    double along[3], middle[3];
    for (int k = 0; k < 3; k++) {
        along[k] = scale * ldexp(1, form & 16 ? fuzz_small(input) / 8 : 0);
        middle[k] = form & 32 ? along[k] * fuzz_small(input) : 0;
    }
    const double grid = form & 64 ? 3 : 0;
    for (size_t i = 0; i < points.count; i++) {
        pir_vec3 u = test_random_direction(&random);
        const double at[3] = {u.x, u.y, u.z};
        double to[3];
        for (int k = 0; k < 3; k++)
            to[k] = middle[k] + along[k] * (grid > 0 ? nearbyint(grid * at[k]) / grid : at[k]);
        points.at[i] = (pir_vec3){to[0], to[1], to[2]};
    }
    pir_polytope *polytope = NULL;
    fuzz_require(pir_polytope_create(points.at, points.count, NULL, &polytope) == PIR_OK, "points have a hull");
    return polytope;
}

/* What is claimed of coarse bodies, in rationals. */
static void check_coarse(const struct shape *shape) {
    const uint32_t count = pir_coarse_count(shape->coarse);
    uint32_t most = 8;
    oracle_body body, coarse;
    const pir_coarse_body last = pir_coarse_get(shape->coarse, count - 1);
    fuzz_require(last.polytope == shape->polytope && last.error == 0, "the last one is the body");
    if (pir_polytope_dimension(shape->polytope) < 3)
        return;
    oracle_body_init(&body, shape->polytope);
    for (uint32_t i = 0; i + 1 < count; i++, most *= 4) {
        const pir_coarse_body made = pir_coarse_get(shape->coarse, i);
        fuzz_require(pir_polytope_is_valid(made.polytope) && made.error >= 0, "a coarse body");
        fuzz_require(pir_polytope_vertex_count(made.polytope) <= most, "it has few vertices");
        if (pir_polytope_dimension(made.polytope) < 3)
            continue;
        oracle_body_init(&coarse, made.polytope);
        fuzz_require(oracle_is_within(&coarse, &body, 0), "it is inside of its body");
        fuzz_require(oracle_is_within(&body, &coarse, made.error), "which reaches no farther than it says");
        oracle_body_clear(&coarse);
    }
    oracle_body_clear(&body);
}

static void add_shape(struct world *world, struct fuzz_input *input) {
    uint8_t form = fuzz_byte(input);
    struct shape *shape = &world->shape[world->shapes];
    shape->polytope = form % 4 == 0 ? fuzz_body(input, POINTS) : round_body(input);
    pir_status status = pir_coarse_create(shape->polytope, &shape->coarse);
    fuzz_require(status == PIR_OK || status == PIR_ERR_LIMIT, "coarse bodies, or a body too far away");
    world->shapes++;
    if (status == PIR_OK && form & 64)
        check_coarse(shape);
}

/* --- the scene --- */

/* Places as far apart as the bytes say. */
static pir_pose next_pose(struct fuzz_input *input, pir_quat last) {
    pir_pose pose = {last, {0, 0, 0}};
    uint8_t form = fuzz_byte(input);
    const double unit = ldexp(1, form % 16 - 6);
    double at[3];
    if (form & 64)
        pose.rotation = fuzz_rotation(input, last);
    for (int k = 0; k < 3; k++)
        at[k] = form >= 240 ? fuzz_double(input) : unit * fuzz_small(input);
    pose.translation = (pir_vec3){at[0], at[1], at[2]};
    return pose;
}

static double next_radius(struct fuzz_input *input) {
    uint8_t form = fuzz_byte(input);
    return form % 4 ? 0 : form / 32.0;
}

static void add_body(struct world *world, struct fuzz_input *input) {
    struct body *body = &world->body[world->bodies];
    pir_polytope *piece[PIECES];
    pir_coarse *coarse[PIECES];
    uint8_t form = fuzz_byte(input);
    uint32_t id;
    *body = (struct body){.options = pir_body_options_default()};
    body->options.pieces = piece;
    body->options.coarse = form & 1 ? NULL : coarse;
    body->options.piece_count = 1 + (form >> 1 & 1);
    body->options.category = form & 4 ? 2 : 1;
    body->options.sensor = form / 8 % 8 == 7;
    for (uint32_t i = 0; i < body->options.piece_count; i++) {
        body->piece[i] = fuzz_byte(input) % world->shapes;
        piece[i] = world->shape[body->piece[i]].polytope;
        coarse[i] = form & 64 && i ? NULL : world->shape[body->piece[i]].coarse;
    }
    body->options.radius = next_radius(input);
    body->options.pose = next_pose(input, body->options.pose.rotation);
    pir_status status = pir_scene_add(world->scene, &body->options, &id);
    fuzz_require(status == PIR_OK || status == PIR_ERR_LIMIT, "a body is added, or is too far away");
    body->options.pieces = NULL;
    body->options.coarse = NULL;
    if (status != PIR_OK)
        return;
    fuzz_require(id == world->bodies, "bodies have the numbers after each other");
    world->bodies++;
}

static void move_body(struct world *world, struct fuzz_input *input) {
    pir_scene_move move = {.body = fuzz_byte(input) % world->bodies};
    pir_pose *pose = &world->body[move.body].options.pose;
    move.pose = next_pose(input, pose->rotation);
    pir_status status = pir_scene_update(world->scene, &move, 1);
    fuzz_require(status == PIR_OK || status == PIR_ERR_LIMIT, "an update, or a body too far away");
    if (status == PIR_OK)
        *pose = move.pose;
}

/* --- questions --- */

struct question {
    pir_scene_shape shape;
    double cutoff;
    pir_accuracy accuracy;
    uint32_t exactly; /* which of those told exact arithmetic is asked about */
    size_t room;      /* to ask with once more */
};

static double length(pir_vec3 v) {
    return fabs(v.x) + fabs(v.y) + fabs(v.z);
}

/* How far the farthest vertex of a body is from its origin. */
static double reach(const pir_polytope *polytope) {
    pir_vec3 low, high;
    pir_polytope_bounds(polytope, &low, &high);
    return fmax(length(low), length(high));
}

/* What a distance in doubles may be off, as scene_query.h says. */
static double off_of(const struct question *asked, const struct body *body, const pir_polytope *piece) {
    const pir_scene_shape *p = &asked->shape;
    return 1e-11 * (reach(p->polytope) + reach(piece) + p->radius + body->options.radius + length(p->pose.translation) +
                    length(body->options.pose.translation));
}

/* The distance of the full bodies, by a pair. */
static pir_status by_pair(const struct world *world, const struct question *asked, const struct body *body,
                          pir_polytope *piece, pir_query_result *ret_result) {
    pir_pair *pair = NULL;
    pir_pair_input input = pir_pair_input_default();
    input.pose_p = asked->shape.pose;
    input.radius_p = asked->shape.radius;
    input.pose_q = body->options.pose;
    input.radius_q = body->options.radius;
    pir_status status = pir_pair_create(asked->shape.polytope, piece, NULL, &pair);
    if (status == PIR_OK)
        status = pir_pair_distance(pair, world->workspace, &input, ret_result);
    pir_pair_destroy(pair);
    return status;
}

/* a − b, and whether that is exact: what rounding has taken away is 0 (Knuth's sum of two). */
static double difference(double a, double b, bool *exact) {
    const double d = a - b, back = d - a;
    *exact = *exact && (a - (d - back)) + (-b - back) == 0;
    return d;
}

/* The same by exact arithmetic, for small bodies where Q is not turned and the places differ by doubles. */
static void check_by_oracle(const struct question *asked, const struct body *body, pir_polytope *piece,
                            const pir_scene_distance *told, double off) {
    const pir_quat q = body->options.pose.rotation;
    const pir_vec3 a = asked->shape.pose.translation, b = body->options.pose.translation;
    const double radii = asked->shape.radius + body->options.radius;
    bool exact = q.x == 0 && q.y == 0 && q.z == 0;
    pir_vec3 t;
    t.x = difference(a.x, b.x, &exact);
    t.y = difference(a.y, b.y, &exact);
    t.z = difference(a.z, b.z, &exact);
    if (!exact || pir_polytope_vertex_count(asked->shape.polytope) * pir_polytope_vertex_count(piece) > EXACT_MOST)
        return;
    place_oracle *oracle = place_oracle_make(asked->shape.polytope, piece, asked->shape.pose.rotation);
    const place_answer right = place_oracle_ask(oracle, t);
    place_oracle_free(oracle);
    const double distance = right.state == PIR_OUTSIDE ? fmax(0, right.distance - radii) : 0;
    if (radii == 0)
        fuzz_require(told->state == right.state, "the state is the exact one");
    fuzz_require(told->least <= distance + off * 1e-3 && distance <= told->most + off * 1e-3,
                 "the exact distance is between the bounds");
}

static void check_told(const struct question *asked, const struct body *body, pir_polytope *piece,
                       const pir_scene_distance *told, const pir_query_result *right, bool exactly) {
    const double off = off_of(asked, body, piece);
    const double allowed = fmax(asked->accuracy.length, asked->accuracy.part * told->least);
    fuzz_require(told->state == right->state, "the state is that of a pair");
    fuzz_require(0 <= told->least && told->least <= told->most, "bounds are in order");
    fuzz_require(told->least <= right->distance && right->distance <= told->most,
                 "the distance of a pair is between the bounds");
    fuzz_require(told->most - told->least <= allowed + off, "bounds are as near as was asked for");
    fuzz_require(told->state == PIR_OUTSIDE || (told->least == 0 && told->most == 0), "a shared point has no distance");
    if (exactly)
        check_by_oracle(asked, body, piece, told, off);
}

static bool is_asked_of(const struct question *asked, const struct world *world, uint32_t b) {
    const pir_body_options *body = &world->body[b].options;
    return !body->sensor && (body->category & asked->shape.mask) && b != asked->shape.except;
}

/* Each piece is told where a pair finds it within the cutoff. */
static void check_all(const struct world *world, const struct question *asked, const pir_scene_distance *told,
                      size_t count) {
    size_t at = 0;
    for (uint32_t b = 0; b < world->bodies; b++)
        for (uint32_t i = 0; is_asked_of(asked, world, b) && i < world->body[b].options.piece_count; i++) {
            const struct body *body = &world->body[b];
            pir_polytope *piece = world->shape[body->piece[i]].polytope;
            pir_query_result right;
            const bool is_told = at < count && told[at].body == b && told[at].piece == i;
            const pir_status status = by_pair(world, asked, body, piece, &right);
            // boxes tell of bodies too far from each other for a pair
            fuzz_require(status == PIR_OK || status == PIR_ERR_LIMIT, "a pair of bodies that a scene has taken");
            if (status == PIR_OK && fabs(right.distance - asked->cutoff) > off_of(asked, body, piece))
                fuzz_require(is_told == (right.distance <= asked->cutoff), "what is within the cutoff is told");
            if (status == PIR_OK && is_told)
                check_told(asked, body, piece, &told[at], &right, at == asked->exactly % count);
            at += is_told;
        }
    fuzz_require(at == count, "nothing else is told, and all by the numbers of body and piece");
}

/* Another accuracy tells of the same pieces; a smaller room holds the first of them. */
static void check_again(struct world *world, const struct question *asked, const pir_scene_distance *told,
                        size_t count) {
    pir_scene_distance again[ALL];
    size_t same = 0;
    const size_t capacity = asked->room;
    memset(again, 0, sizeof again);
    fuzz_require(pir_scene_distances(world->scene, &asked->shape, asked->cutoff, asked->accuracy, capacity,
                                     capacity ? again : NULL, &same) == PIR_OK &&
                     same == count,
                 "a smaller room");
    for (size_t i = 0; i < count && i < capacity; i++)
        fuzz_require(again[i].body == told[i].body && again[i].piece == told[i].piece &&
                         again[i].state == told[i].state && again[i].settled == told[i].settled &&
                         memcmp(&again[i].least, &told[i].least, sizeof(double)) == 0 &&
                         memcmp(&again[i].most, &told[i].most, sizeof(double)) == 0,
                     "the same question has the same answer");
    pir_status status =
        pir_scene_distances(world->scene, &asked->shape, asked->cutoff, (pir_accuracy){0, 0}, ALL, again, &same);
    if (status == PIR_ERR_LIMIT)
        return;
    fuzz_require(status == PIR_OK && same == count, "accuracy does not change how many are told");
    for (size_t i = 0; i < count; i++)
        fuzz_require(again[i].body == told[i].body && again[i].piece == told[i].piece &&
                         again[i].state == told[i].state,
                     "accuracy does not change which are told, nor their states");
}

static struct question next_question(const struct world *world, struct fuzz_input *input) {
    const struct shape *shape = &world->shape[fuzz_byte(input) % world->shapes];
    struct question asked = {.shape = pir_scene_shape_default(shape->polytope), .cutoff = HUGE_VAL};
    uint8_t form = fuzz_byte(input), near = fuzz_byte(input);
    asked.shape.coarse = form & 1 ? NULL : shape->coarse;
    asked.shape.mask = form / 2 % 8 ? UINT32_MAX : 2;
    asked.shape.except = form / 16 % 4 ? PIR_SCENE_NONE : form / 64;
    asked.shape.radius = next_radius(input);
    asked.shape.pose = next_pose(input, asked.shape.pose.rotation);
    if (near % 8 == 0)
        asked.cutoff = fabs(fuzz_double(input));
    else if (near % 8 < 4)
        asked.cutoff = near % 8 == 1 ? 0 : ldexp(1, near / 8 % 16 - 6);
    uint8_t accuracy = fuzz_byte(input);
    if (accuracy % 4 != 3)
        asked.accuracy.part = ldexp(1, -(accuracy / 4 % 8));
    if (accuracy % 4 > 1)
        asked.accuracy.length = accuracy >= 240 ? fabs(fuzz_double(input)) : ldexp(1, accuracy / 8 - 20);
    const uint8_t rest = fuzz_byte(input);
    asked.exactly = rest / (ALL + 1);
    asked.room = rest % (ALL + 1);
    return asked;
}

static void ask_distances(struct world *world, struct fuzz_input *input) {
    const struct question asked = next_question(world, input);
    pir_scene_distance told[ALL];
    size_t count = 0;
    pir_status status =
        pir_scene_distances(world->scene, &asked.shape, asked.cutoff, asked.accuracy, ALL, told, &count);
    fuzz_require(status == PIR_OK || status == PIR_ERR_LIMIT, "distances, or a shape too far away");
    if (status != PIR_OK)
        return;
    fuzz_require(count <= ALL, "no more than there are");
    check_all(world, &asked, told, count);
    check_again(world, &asked, told, count);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct fuzz_input input = {data, size, 0};
    struct world world = {0};
    fuzz_require(pir_scene_create(NULL, &world.scene) == PIR_OK, "a scene");
    fuzz_require(pir_workspace_create(NULL, &world.workspace) == PIR_OK, "a workspace");
    const uint8_t form = fuzz_byte(&input);
    for (int i = 0; i <= form % SHAPES; i++)
        add_shape(&world, &input);
    for (int i = 0; i <= form / SHAPES % BODIES; i++)
        add_body(&world, &input);
    for (int i = 0; i < QUESTIONS && world.bodies > 0 && input.at < input.size; i++) {
        if (fuzz_byte(&input) % 4 == 0)
            move_body(&world, &input);
        ask_distances(&world, &input);
    }
    pir_scene_destroy(world.scene);
    pir_workspace_destroy(world.workspace);
    for (uint32_t i = 0; i < world.shapes; i++) {
        pir_coarse_release(world.shape[i].coarse);
        pir_polytope_release(world.shape[i].polytope);
    }
    return 0;
}
