/* SPDX-License-Identifier: MIT */
/* See handle_program.h. */
#include "query/handle_program.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/baseline.h>

#include "query/handle_objects.h"
#include "support/sum_bytes.h"

static uint32_t below(struct program *program, uint32_t count) {
    return fuzz_byte(&program->input) % count;
}

static pir_vec3 small_vector(struct program *program) {
    pir_vec3 v;
    v.x = fuzz_small(&program->input) / 16.0;
    v.y = fuzz_small(&program->input) / 16.0;
    v.z = fuzz_small(&program->input) / 16.0;
    return v;
}

/* --- subjects --- */

static struct subject *subject_new(struct program *program, const struct subject *like) {
    struct subject *subject = program->subjects;
    while (subject->uses > 0)
        subject++;
    *subject = *like;
    subject->uses = 1;
    pir_polytope_retain(like->p);
    pir_polytope_retain(like->q);
    return subject;
}

static struct subject *subject_use(struct subject *subject) {
    subject->uses++;
    return subject;
}

static void subject_drop(struct subject *subject) {
    if (!subject || --subject->uses > 0)
        return;
    pir_polytope_release(subject->p);
    pir_polytope_release(subject->q);
}

/* A new sum without a history, in the subject's state at `rotation`. */
static pir_sum *fresh_sum(struct program *program, const struct subject *subject, pir_quat rotation) {
    pir_polytope *scaled[2] = {NULL, NULL};
    pir_sum_options options = {.size = sizeof options, .allocator = NULL, .difference = subject->difference};
    pir_sum *sum = NULL;
    need(program, pir_polytope_scale(subject->p, subject->scale[0], &scaled[0]) == PIR_OK, "P can be scaled");
    need(program, pir_polytope_scale(subject->q, subject->scale[1], &scaled[1]) == PIR_OK, "Q can be scaled");
    if (scaled[0] && scaled[1]) {
        need(program, pir_sum_create(scaled[0], scaled[1], rotation, &options, &sum) == PIR_OK, "a sum can be made");
        if (sum && subject->region)
            need(program, pir_sum_set_region(sum, subject->axis, subject->half_angle) == PIR_OK, "a cone can be set");
    }
    pir_polytope_release(scaled[0]);
    pir_polytope_release(scaled[1]);
    return sum;
}

/* Updates the model's rotations after something was done to a sum. */
static void note_rotation(struct sum *sum) {
    sum->subject->rotation = pir_sum_pairing_rotation(sum->handle);
    sum->subject->shown = pir_sum_rotation(sum->handle);
    sum->subject->behind = memcmp(&sum->subject->rotation, &sum->subject->shown, sizeof(pir_quat)) != 0;
}

/* --- bodies, maps and locators --- */

static void drop_body(struct body *body) {
    pir_polytope_release(body->handle);
    pir_polytope_release(body->twin);
    *body = (struct body){NULL, NULL};
}

static void make_body(struct program *program) {
    struct body *body = &program->bodies[below(program, SLOTS)];
    drop_body(body);
    size_t at = program->input.at;
    body->handle = fuzz_body(&program->input, POINTS);
    program->input.at = at;
    body->twin = fuzz_body(&program->input, POINTS);
}

static void drop_locator(struct locator *locator) {
    pir_cgm_locator_destroy(locator->handle);
    pir_cgm_locator_destroy(locator->twin);
    *locator = (struct locator){NULL, NULL};
}

/* A locator of a map that is destroyed at once, as is the body. */
static void make_locator(struct program *program) {
    struct locator *locator = &program->locators[below(program, SLOTS)];
    struct body *body = &program->bodies[below(program, SLOTS)];
    drop_locator(locator);
    if (!body->handle)
        return;
    pir_cgm *map = NULL, *twin = NULL;
    need(program, pir_cgm_create(body->handle, NULL, NULL, &map) == PIR_OK, "a map can be made");
    need(program, pir_cgm_create(body->twin, NULL, NULL, &twin) == PIR_OK, "a map can be made");
    if (map && twin) {
        need(program, pir_cgm_locator_create(map, &locator->handle) == PIR_OK, "a locator can be made");
        need(program, pir_cgm_locator_create(twin, &locator->twin) == PIR_OK, "a locator can be made");
    }
    pir_cgm_release(twin);
    pir_cgm_release(map);
    if (below(program, 2))
        drop_body(body);
}

static void ask_locator(struct program *program) {
    struct locator *locator = &program->locators[below(program, SLOTS)];
    pir_cgm_location one = {PIR_CGM_OUTSIDE, 0, 0}, other = one;
    pir_vec3 at = small_vector(program);
    if (!locator->handle || !locator->twin)
        return;
    need(program, pir_cgm_locate(locator->handle, at, PIR_CGM_NONE, &one) == PIR_OK, "a point can be located");
    need(program, pir_cgm_locate(locator->twin, at, PIR_CGM_NONE, &other) == PIR_OK, "a point can be located");
    need(program, one.position == other.position && one.witness == other.witness, "both locators agree");
}

/* --- sums --- */

static void drop_sum(struct sum *sum) {
    pir_sum_destroy(sum->handle);
    subject_drop(sum->subject);
    *sum = (struct sum){NULL, NULL};
}

/* Puts a sum in place of another, which is destroyed. */
static void put_sum(struct program *program, struct sum *place, pir_sum *handle, const struct subject *like) {
    struct subject *subject = subject_new(program, like);
    drop_sum(place);
    *place = (struct sum){handle, subject};
    note_rotation(place);
}

static void make_sum(struct program *program) {
    struct sum *place = &program->sums[below(program, SLOTS)];
    const struct body *p = &program->bodies[below(program, SLOTS)], *q = &program->bodies[below(program, SLOTS)];
    pir_allocator allocator = test_allocator(&program->memory);
    pir_sum_options options = {.size = sizeof options, .allocator = &allocator, .difference = below(program, 8) != 0};
    options.workspace = place == program->sums ? NULL : program->workspace;
    pir_quat rotation = fuzz_rotation(&program->input, (pir_quat){0, 0, 0, 1});
    if (!p->handle || !q->handle)
        return;
    struct subject like = {.p = p->twin, .q = q->twin, .difference = options.difference, .scale = {1, 1}};
    pir_sum *sum = NULL;
    need(program, pir_sum_create(p->handle, q->handle, rotation, &options, &sum) == PIR_OK, "a sum can be made");
    if (sum)
        put_sum(program, place, sum, &like);
}

static void copy_sum(struct program *program) {
    struct sum *from = &program->sums[below(program, SLOTS)], *to = &program->sums[below(program, SLOTS)];
    pir_allocator allocator = test_allocator(&program->memory);
    pir_sum *copy = NULL;
    bool by_file = below(program, 2);
    if (!from->handle)
        return;
    if (by_file) {
        test_bytes bytes = test_bytes_of(from->handle);
        need(program, bytes.data && pir_sum_restore(bytes.data, bytes.size, &allocator, NULL, &copy) == PIR_OK,
             "a sum can be written and read");
        free(bytes.data);
    } else {
        need(program, pir_sum_clone(from->handle, NULL, &copy) == PIR_OK, "a sum can be cloned");
    }
    if (copy)
        put_sum(program, to, copy, from->subject);
}

static void turn_sum(struct program *program, struct sum *sum) {
    static const pir_method methods[] = {PIR_METHOD_AUTO, PIR_METHOD_UPDATE, PIR_METHOD_WALK, PIR_METHOD_CGM};
    uint32_t how = below(program, 7);
    pir_quat rotation = fuzz_rotation(&program->input, sum->subject->shown);
    pir_status status = how < 4    ? pir_sum_rotate(sum->handle, rotation, methods[how])
                        : how == 4 ? pir_sum_reset(sum->handle, rotation)
                        : how == 5 ? pir_sum_rotate_brute_force(sum->handle, rotation)
                                   : pir_sum_settle(sum->handle);
    need(program, status == PIR_OK, "a sum can be rotated");
}

static void scale_sum(struct program *program, struct sum *sum) {
    static const double scales[] = {1, 3, 0.1, 2, 0x1p-60, 1e30, 0x1p500, 0x1.23456789abcdfp-900};
    uint32_t operand = below(program, 2);
    double scale = scales[below(program, 8)];
    pir_status status = pir_sum_set_scale(sum->handle, operand ? PIR_OPERAND_Q : PIR_OPERAND_P, scale);
    need(program, status == PIR_OK || status == PIR_ERR_LIMIT, "a sum can be scaled unless that is beyond doubles");
    if (status == PIR_OK)
        sum->subject->scale[operand] = scale;
}

static void limit_sum(struct program *program, struct sum *sum) {
    struct subject *subject = sum->subject;
    subject->region = below(program, 3) > 0;
    subject->axis = small_vector(program);
    if (subject->axis.x == 0 && subject->axis.y == 0 && subject->axis.z == 0)
        subject->axis.z = 1;
    subject->half_angle = subject->region ? below(program, 32) / 10.0 : 4;
    subject->region = subject->half_angle < 3.1;
    need(program, pir_sum_set_region(sum->handle, subject->axis, subject->region ? subject->half_angle : 4) == PIR_OK,
         "a region can be set");
}

static void change_sum(struct program *program) {
    struct sum *sum = &program->sums[below(program, SLOTS)];
    if (!sum->handle)
        return;
    switch (below(program, 6)) {
    case 0:
        scale_sum(program, sum);
        break;
    case 1:
        limit_sum(program, sum);
        break;
    case 2:
        sum->subject->tolerant = below(program, 2);
        need(program, pir_sum_set_tolerance(sum->handle, sum->subject->tolerant ? 0.25 : 0) == PIR_OK,
             "a tolerance can be set");
        break;
    default:
        turn_sum(program, sum);
    }
    note_rotation(sum);
}

/* --- queries --- */

static void drop_query(struct query *query) {
    pir_query_destroy(query->handle);
    subject_drop(query->subject);
    *query = (struct query){.handle = NULL};
}

static void make_query(struct program *program) {
    struct query *query = &program->queries[below(program, SLOTS)];
    struct sum *sum = &program->sums[below(program, SLOTS)];
    drop_query(query);
    if (!sum->handle)
        return;
    pir_status status = pir_query_create(sum->handle, &query->handle);
    if (!sum->subject->difference)
        need(program, status == PIR_ERR_ARGUMENT, "a sum that is no difference is refused");
    else
        need(program, status == PIR_OK || status == PIR_ERR_LIMIT, "a query can be made unless a body is far away");
    if (status == PIR_OK)
        query->subject = subject_use(sum->subject);
    else
        query->handle = NULL;
}

static void ask_query(struct program *program) {
    struct query *query = &program->queries[below(program, SLOTS)];
    pir_query_input input = pir_query_input_default();
    uint32_t kind = below(program, 8);
    input.translation = small_vector(program);
    pir_vec3 along = small_vector(program);
    if (!query->handle)
        return;
    // the cache is passed from pose to pose: its contents must do no harm
    pir_query_result unused;
    pir_query_signed_distance(query->handle, &input, &query->cache, &unused);
    pir_sum *sum = fresh_sum(program, query->subject, query->subject->rotation);
    pir_query *fresh = NULL;
    pir_status status = sum ? pir_query_create(sum, &fresh) : PIR_OK;
    if (fresh) {
        handle_compare_answers(program, query->handle, fresh, &input, along);
        if (kind == 0)
            handle_compare_batches(program, query->handle, fresh, &input);
        if (kind == 1 && !query->subject->tolerant)
            handle_compare_advances(program, query, fresh, input.translation, along);
    } else if (sum) {
        need(program, status == PIR_ERR_LIMIT, "a query can be made unless a body is far away");
        need(program, pir_query_penetration(query->handle, &input, NULL, &unused) == PIR_ERR_LIMIT,
             "what no query can be made for is refused by one that is there");
    }
    pir_query_destroy(fresh);
    pir_sum_destroy(sum);
}

/* --- live meshes --- */

static void drop_live(struct live *live) {
    pir_live_mesh_destroy(live->handle);
    subject_drop(live->subject);
    *live = (struct live){NULL, NULL};
}

static void make_live(struct program *program) {
    struct live *live = &program->lives[below(program, SLOTS)];
    struct sum *sum = &program->sums[below(program, SLOTS)];
    drop_live(live);
    if (!sum->handle)
        return;
    need(program, pir_live_mesh_create(sum->handle, &live->handle) == PIR_OK, "a live mesh can be made");
    if (live->handle)
        live->subject = subject_use(sum->subject);
}

static uint64_t mix(uint64_t hash, uint64_t number) {
    for (int k = 0; k < 8; k++)
        hash = (hash ^ (number >> 8 * k & 0xff)) * UINT64_C(0x100000001b3);
    return hash;
}

static uint64_t mix_double(uint64_t hash, double x) {
    uint64_t bits;
    x += 0.0; // what underflows is zero, of either sign
    memcpy(&bits, &x, sizeof bits);
    return mix(hash, bits);
}

static uint64_t mix_vector(uint64_t hash, pir_vec3 v) {
    return mix_double(mix_double(mix_double(hash, v.x), v.y), v.z);
}

/*
 * A hash of what a live mesh holds, whatever the order of slots: pairs, their planes, pairs of vertices with their
 * coordinates.
 */
static uint64_t hash_live(struct program *program, pir_live_mesh *live) {
    uint32_t facets = pir_live_mesh_facet_slots(live), vertices = pir_live_mesh_vertex_slots(live), ends[2];
    pir_plane_equation *plane = malloc((facets + 1) * sizeof *plane);
    pir_vec3 *vertex = malloc((vertices + 1) * sizeof *vertex);
    uint64_t sum = 0;
    need(program, plane && vertex, "there is memory");
    if (plane && vertex) {
        pir_live_mesh_planes(live, plane);
        pir_live_mesh_vertices(live, vertex);
        for (uint32_t i = 0; i < facets; i++) {
            pir_sum_pair pair;
            if (!pir_live_mesh_pair(live, i, &pair))
                continue;
            uint64_t hash = mix(mix((uint64_t)pair.kind, pair.p), pair.q);
            sum += mix_double(mix_vector(hash, plane[i].normal), plane[i].offset);
        }
        for (uint32_t i = 0; i < vertices; i++)
            if (pir_live_mesh_vertex_pair(live, i, ends))
                sum += mix_vector(mix(mix(3, ends[0]), ends[1]), vertex[i]);
    }
    free(plane);
    free(vertex);
    return sum;
}

static void refresh_live(struct program *program) {
    struct live *live = &program->lives[below(program, SLOTS)];
    if (!live->handle)
        return;
    need(program, pir_live_mesh_refresh(live->handle) == PIR_OK, "a live mesh can be refreshed");
    uint64_t held = hash_live(program, live->handle);
    // with a region a live mesh holds what the sum keeps, which depends on its past
    if (live->subject->region || live->subject->behind)
        return;
    pir_live_mesh *fresh = NULL;
    pir_sum *sum = fresh_sum(program, live->subject, live->subject->rotation);
    if (sum)
        need(program, pir_live_mesh_create(sum, &fresh) == PIR_OK, "a live mesh can be made");
    if (fresh)
        need(program, hash_live(program, fresh) == held, "both live meshes hold the same");
    pir_live_mesh_destroy(fresh);
    pir_sum_destroy(sum);
}

/* --- the program --- */

static void drop_something(struct program *program) {
    uint32_t i = below(program, SLOTS);
    switch (below(program, 5)) {
    case 0:
        drop_body(&program->bodies[i]);
        break;
    case 1:
        drop_sum(&program->sums[i]);
        break;
    case 2:
        drop_query(&program->queries[i]);
        break;
    case 3:
        drop_live(&program->lives[i]);
        break;
    default:
        drop_locator(&program->locators[i]);
    }
}

static void step(struct program *program) {
    static const struct {
        uint32_t weight;
        void (*act)(struct program *);
    } acts[] = {{6, change_sum}, {6, ask_query},   {2, make_query},    {2, refresh_live},
                {1, make_live},  {1, make_sum},    {1, copy_sum},      {1, make_locator},
                {1, make_body},  {1, ask_locator}, {1, drop_something}};
    uint32_t left = below(program, 23), i = 0;
    while (left >= acts[i].weight)
        left -= acts[i++].weight;
    acts[i].act(program);
}

const char *handle_program_run(const uint8_t *data, size_t size, uint32_t *ret_step) {
    struct program program = {.input = {data, size, 0}};
    uint32_t count = 0;
    pir_allocator allocator = test_allocator(&program.memory);
    need(&program, pir_workspace_create(&allocator, &program.workspace) == PIR_OK, "a workspace can be made");
    for (int i = 0; i < 2 * SLOTS; i++)
        make_body(&program);
    for (int i = 0; i < SLOTS; i++) {
        make_sum(&program);
        make_query(&program);
    }
    for (; program.input.at < size && !program.failed; count++)
        step(&program);
    pir_workspace_destroy(program.workspace);
    for (int i = 0; i < SLOTS; i++) {
        drop_body(&program.bodies[i]);
        drop_sum(&program.sums[i]);
    }
    for (int i = 0; i < SLOTS; i++) {
        drop_query(&program.queries[i]);
        drop_live(&program.lives[i]);
        drop_locator(&program.locators[i]);
    }
    need(&program, program.memory.blocks == 0 && !program.memory.wrong_size, "nothing is left behind");
    *ret_step = count;
    return program.failed;
}
