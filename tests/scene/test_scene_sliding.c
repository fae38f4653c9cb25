/* SPDX-License-Identifier: MIT */
/*
 * Bodies slide without friction over floors of convex pieces: pieces of one body, bodies side by side, bodies beside
 * meshes. No normal is off the floor's, and no body loses speed. What is in a corner, deep inside or alone keeps its
 * contacts; threads find the same; memory may run out. PIR_TEST_FRAMES is how many frames each body slides over each
 * floor at each speed.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include <pirouette/scene.h>

#include "mesh/sliding_floors.h"
#include "scene/scene_bodies.h"
#include "support/hash.h"
#include "support/memory.h"

#define CONTACTS 64
#define NEAR     1e-9
#define MARGIN   0.04
/* Of the floors: 60 × 15 squares of two prisms each, as those of sliding_floors.c. */
#define COLUMNS 60
#define ROWS    15
#define PRISMS  (2 * COLUMNS * ROWS)
#define KINDS   6

static uint64_t frames(void) {
    const char *text = getenv("PIR_TEST_FRAMES");
    return text ? strtoull(text, NULL, 10) : 6;
}

static pir_polytope *hull_of(const pir_vec3 *vertex, size_t count) {
    pir_polytope *p;
    assert_int_equal(pir_polytope_create(vertex, count, NULL, &p), PIR_OK);
    return p;
}

static pir_polytope *box(pir_vec3 low, pir_vec3 high) {
    pir_vec3 v[8];
    for (int i = 0; i < 8; i++)
        v[i] = (pir_vec3){i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z};
    return hull_of(v, 8);
}

/* Half of a square of the floor, of height 1 under z = 0. */
static pir_polytope *prism(int i, int j, bool second) {
    const double x = i - COLUMNS / 2, y = j - ROWS / 2;
    const pir_vec3 corner[4] = {{x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}};
    pir_vec3 v[6];
    for (int k = 0; k < 3; k++) {
        v[k] = corner[k == 0 ? 0 : second ? k + 1 : k];
        v[k + 3] = (pir_vec3){v[k].x, v[k].y, -1};
    }
    return hull_of(v, 6);
}

static uint32_t add_body(pir_scene *scene, pir_polytope *const *pieces, uint32_t count, pir_body_kind kind) {
    pir_body_options options = pir_body_options_default();
    uint32_t body;
    options.kind = kind;
    options.pieces = pieces;
    options.piece_count = count;
    assert_int_equal(pir_scene_add(scene, &options, &body), PIR_OK);
    return body;
}

static void add_plane(pir_scene *scene, double from, double to) {
    const pir_vec3 v[4] = {{from, -7, 0}, {to, -7, 0}, {to, 8, 0}, {from, 8, 0}};
    const uint32_t corner[6] = {0, 1, 2, 0, 2, 3};
    const pir_trimesh_arrays arrays = {.vertices = v, .vertex_count = 4, .triangles = corner, .triangle_count = 2};
    pir_body_options options = pir_body_options_default();
    uint32_t body;
    options.kind = PIR_BODY_STATIC;
    assert_int_equal(pir_trimesh_create(&arrays, NULL, NULL, &options.mesh), PIR_OK);
    assert_int_equal(pir_scene_add(scene, &options, &body), PIR_OK);
    pir_trimesh_release(options.mesh);
}

/* Pieces of a floor, as bodies of so many of them. */
static void add_pieces(pir_scene *scene, pir_polytope **piece, uint32_t count, uint32_t of_body, pir_body_kind kind) {
    for (uint32_t i = 0; i < count; i += of_body)
        add_body(scene, piece + i, i + of_body <= count ? of_body : count - i, kind);
    for (uint32_t i = 0; i < count; i++)
        pir_polytope_release(piece[i]);
}

static const char *add_floor(pir_scene *scene, int kind) {
    static const char *const names[KINDS] = {"prisms in one body",          "prisms in bodies of their own",
                                             "prisms of a body that moves", "boxes of sizes that do not fit",
                                             "boxes beside meshes",         "one slab"};
    static pir_polytope *piece[PRISMS];
    uint32_t count = 0;
    if (kind <= 2) {
        for (int i = 0; i < PRISMS; i++)
            piece[count++] = prism(i / 2 / ROWS, i / 2 % ROWS, i % 2);
        add_pieces(scene, piece, count, kind == 1 ? 1 : count, kind == 2 ? PIR_BODY_MOVING : PIR_BODY_STATIC);
        return names[kind];
    }
    for (int j = 0; j < ROWS && kind == 3; j++) {
        const double y = j - ROWS / 2, cell = j % 3 == 0 ? 1 : j % 3 == 1 ? 0.625 : 2.5;
        for (double x = -30; x < 30; x += cell)
            piece[count++] = box((pir_vec3){x, y, -1}, (pir_vec3){x + cell, y + 1, 0});
    }
    for (int i = 0; i < COLUMNS / 4 && kind == 4; i++) {
        const double x = 4 * i - 30;
        piece[count++] = box((pir_vec3){x, -7, -1}, (pir_vec3){x + 2, 8, 0});
        add_plane(scene, x + 2, x + 4);
    }
    if (kind == 5)
        piece[count++] = box((pir_vec3){-30, -7, -1}, (pir_vec3){30, 8, 0});
    add_pieces(scene, piece, count, kind == 3 ? 7 : 1, PIR_BODY_STATIC);
    return names[kind];
}

typedef struct run {
    pir_scene *scene;
    const char *floor;
    uint32_t body;
    double gap, slowest;
    uint64_t frames, contacts, bare; /* events without contacts */
} run;

/* The contacts of the body in the events of an update, seen from the floor. */
static size_t contacts_of(run *r, const slider *body, double speed, uint64_t frame, pir_surface_contact *contacts) {
    size_t count, found = 0;
    const pir_scene_event *event = pir_scene_events(r->scene, &count);
    for (size_t i = 0; i < count; i++) {
        const bool is_p = event[i].body_p == r->body;
        const double sign = is_p ? 1 : -1;
        const pir_vec3 n = {sign * event[i].normal.x, sign * event[i].normal.y, sign * event[i].normal.z};
        r->bare += event[i].kind != PIR_EVENT_ENDED && event[i].contact_count == 0;
        if (event[i].contact_count == 0)
            continue;
        expect(fmax(fabs(n.x), fmax(fabs(n.y), fabs(n.z - 1))) < NEAR,
               "%s on %s at %g m/s, frame %llu: normal %.17g %.17g %.17g, pieces %u and %u, %.9g away", body->name,
               r->floor, speed, (unsigned long long)frame, n.x, n.y, n.z, event[i].piece_p, event[i].piece_q,
               event[i].distance);
        for (uint32_t k = 0; k < event[i].contact_count && found < CONTACTS; k++) {
            const pir_contact *c = &event[i].contacts[k];
            contacts[found++] =
                (pir_surface_contact){.point_p = is_p ? c->point_p : c->point_q, .normal = n, .distance = c->distance};
        }
    }
    return found;
}

static void slide(run *r, slider *body, double speed) {
    body->velocity = (pir_vec3){speed, 0.05 * speed, 0};
    for (uint64_t frame = 0; frame < frames(); frame++) {
        pir_surface_contact contacts[CONTACTS];
        pir_vec3 *at = &body->pose.translation;
        at->x -= at->x > FLOOR_LENGTH / 2 - 2 ? FLOOR_LENGTH - 2 * FLOOR_STEP : 0;
        at->y -= at->y > 3 ? 6 : 0;
        const pir_scene_move move = {r->body, body->pose};
        assert_int_equal(pir_scene_update(r->scene, &move, 1), PIR_OK);
        const size_t count = contacts_of(r, body, speed, frame, contacts);
        slider_step(body, contacts, count, r->gap);
        r->frames++;
        r->contacts += count;
        expect(at->z > -1 && at->z < 4, "%s on %s at %g m/s, frame %llu: it is at height %g", body->name, r->floor,
               speed, (unsigned long long)frame, at->z);
        r->slowest =
            fmax(r->slowest, fmax(fabs(body->velocity.x - speed), fabs(body->velocity.y - 0.05 * speed)) / speed);
    }
}

static void slide_all(int kind, double gap) {
    static const double speeds[3] = {1, 7, 30};
    run r = {.gap = gap};
    pir_scene_options options = pir_scene_options_default();
    options.margin = MARGIN;
    options.unions = true;
    assert_int_equal(pir_scene_create(&options, &r.scene), PIR_OK);
    r.floor = add_floor(r.scene, kind);
    for (int shape = 0; shape < SLIDER_KINDS; shape++)
        for (int i = 0; i < 3; i++) {
            slider body;
            slider_make(&body, shape, gap);
            pir_body_options added = pir_body_options_default();
            added.pieces = body.piece;
            added.piece_count = body.pieces;
            added.radius = body.radius;
            body.pose.translation.x = 0.13;
            body.pose.translation.y = 0.07;
            added.pose = body.pose;
            assert_int_equal(pir_scene_add(r.scene, &added, &r.body), PIR_OK);
            slide(&r, &body, speeds[i]);
            assert_int_equal(pir_scene_remove(r.scene, r.body), PIR_OK);
            slider_clear(&body);
        }
    assert_true(pir_scene_is_valid(r.scene));
    print_message("%s, at a gap of %g: %llu frames, %llu contacts, %llu events of ghosts alone, speed off by %.2g\n",
                  r.floor, gap, (unsigned long long)r.frames, (unsigned long long)r.contacts,
                  (unsigned long long)r.bare, r.slowest);
    assert_true(r.contacts * 2 > r.frames);
    assert_true(r.slowest < 1e-6);
    pir_scene_destroy(r.scene);
}

static void floors_of_pieces_have_one_normal(void **state) {
    (void)state;
    for (int kind = 0; kind < KINDS; kind++)
        slide_all(kind, 0.005);
}

static void bodies_that_have_sunk_in_feel_the_same_floor(void **state) {
    (void)state;
    for (int kind = 1; kind < KINDS; kind += kind == 1 ? 2 : 1)
        slide_all(kind, -0.002);
}

/* --- what unions leave as it is --- */

static pir_scene *scene_with(bool unions, uint32_t threads, const pir_allocator *allocator) {
    pir_scene_options options = pir_scene_options_default();
    pir_scene *scene = NULL;
    options.margin = MARGIN;
    options.unions = unions;
    options.threads = threads;
    options.allocator = allocator;
    (void)pir_scene_create(&options, &scene);
    return scene;
}

static uint32_t add_box(pir_scene *scene, pir_vec3 low, pir_vec3 high, pir_body_kind kind) {
    pir_polytope *piece = box(low, high);
    const uint32_t body = add_body(scene, &piece, 1, kind);
    pir_polytope_release(piece);
    return body;
}

/* How many contacts of the last update have a normal, or its opposite, within the tolerance. */
static uint32_t contacts_along(const pir_scene *scene, pir_vec3 n) {
    size_t count;
    uint32_t found = 0;
    const pir_scene_event *event = pir_scene_events(scene, &count);
    for (size_t i = 0; i < count; i++) {
        const pir_vec3 m = event[i].normal;
        if (fabs(m.x * n.x + m.y * n.y + m.z * n.z) > 1 - NEAR)
            found += event[i].contact_count;
    }
    return found;
}

static uint32_t contacts_in_all(const pir_scene *scene) {
    size_t count;
    uint32_t found = 0;
    const pir_scene_event *event = pir_scene_events(scene, &count);
    for (size_t i = 0; i < count; i++)
        found += event[i].contact_count;
    return found;
}

/* The walls of prisms are felt by pairs: so there is something to leave out. */
static void pairs_alone_feel_walls(void **state) {
    (void)state;
    for (int unions = 0; unions < 2; unions++) {
        pir_scene *scene = scene_with(unions, 1, NULL);
        uint32_t off = 0;
        (void)add_floor(scene, 0);
        const uint32_t body = add_box(scene, (pir_vec3){-0.5, -0.4, 0}, (pir_vec3){0.5, 0.4, 0.5}, PIR_BODY_MOVING);
        for (int i = 0; i < 40; i++) {
            const pir_scene_move move = {body, scene_at(0.037 * i, 0.011 * i, i % 2 ? 0.005 : -0.002)};
            assert_int_equal(pir_scene_update(scene, &move, 1), PIR_OK);
            off += contacts_in_all(scene) - contacts_along(scene, (pir_vec3){0, 0, 1});
        }
        assert_true(unions ? off == 0 : off > 40);
        pir_scene_destroy(scene);
    }
}

/* A box on one slab, and one between slabs that are apart, have the contacts of their pairs, bit for bit. */
static void bodies_that_nothing_is_beside_have_the_contacts_of_pairs(void **state) {
    (void)state;
    for (int ceiling = 0; ceiling < 2; ceiling++) {
        pir_scene *scene[2] = {scene_with(false, 1, NULL), scene_with(true, 1, NULL)};
        const pir_scene_event *event[2];
        size_t count[2];
        for (int k = 0; k < 2; k++) {
            (void)add_box(scene[k], (pir_vec3){-4, -4, -1}, (pir_vec3){4, 4, 0}, PIR_BODY_STATIC);
            if (ceiling)
                (void)add_box(scene[k], (pir_vec3){-4, -4, 1}, (pir_vec3){4, 4, 2}, PIR_BODY_STATIC);
            (void)add_box(scene[k], (pir_vec3){-0.5, -0.4, -0.001}, (pir_vec3){0.5, 0.4, 1.002}, PIR_BODY_MOVING);
            assert_int_equal(pir_scene_update(scene[k], NULL, 0), PIR_OK);
            event[k] = pir_scene_events(scene[k], &count[k]);
        }
        assert_true(count[0] == count[1] && count[0] == (ceiling ? 2 : 1));
        for (size_t i = 0; i < count[0]; i++) {
            assert_true(event[0][i].contact_count == 4 && event[1][i].contact_count == 4);
            assert_memory_equal(event[0][i].contacts, event[1][i].contacts, 4 * sizeof(pir_contact));
        }
        for (int k = 0; k < 2; k++)
            pir_scene_destroy(scene[k]);
    }
}

static void a_corner_holds_on_both_sides_and_what_is_deep_inside_is_pushed_out(void **state) {
    (void)state;
    static const double gaps[3] = {0.005, 0, -0.002};
    for (int i = 0; i < 4; i++) {
        pir_scene *scene = scene_with(true, 1, NULL);
        const double gap = i < 3 ? gaps[i] : -2;
        (void)add_box(scene, (pir_vec3){-8, -8, -8}, (pir_vec3){8, 8, 0}, PIR_BODY_STATIC);
        (void)add_box(scene, (pir_vec3){-8, -8, 0}, (pir_vec3){0, 8, 8}, PIR_BODY_STATIC);
        const pir_vec3 low = {i < 3 ? gap : -2, -0.5, gap}, high = {low.x + 1, 0.5, low.z + 1};
        (void)add_box(scene, low, high, PIR_BODY_MOVING);
        assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
        const uint32_t up = contacts_along(scene, (pir_vec3){0, 0, 1}),
                       side = contacts_along(scene, (pir_vec3){1, 0, 0}), all = contacts_in_all(scene);
        expect(i < 3 ? up == 4 && side == 4 && all == 8 : all > 0, "gap %g: %u up, %u aside, %u in all", gap, up, side,
               all);
        pir_scene_destroy(scene);
    }
}

/* A few compounds on a floor of prisms; a hash of the events of some updates, 0 where memory ran out. */
static uint64_t run_crowd(uint32_t threads, const pir_allocator *allocator, uint32_t bodies, int updates) {
    pir_scene *scene = scene_with(true, threads, allocator);
    pir_polytope *floor_piece[8], *half[2];
    uint32_t body[64];
    uint64_t hash = scene ? TEST_HASH_START : 0;
    pir_body_options options = pir_body_options_default();
    for (uint32_t i = 0; i < 8; i++)
        floor_piece[i] = box((pir_vec3){(double)i - 4, -4, -1}, (pir_vec3){(double)i - 3, 4, 0});
    for (int k = 0; k < 2; k++)
        half[k] = box((pir_vec3){k - 0.5, -0.25, -0.25}, (pir_vec3){k + 0.5 * k, 0.25, 0.25});
    options.pieces = floor_piece;
    options.piece_count = 8;
    options.kind = PIR_BODY_STATIC;
    if (hash && pir_scene_add(scene, &options, &body[0]) != PIR_OK)
        hash = 0;
    options.pieces = half;
    options.piece_count = 2;
    options.kind = PIR_BODY_MOVING;
    for (uint32_t i = 0; i < bodies && hash; i++) {
        options.pose = scene_at(0.37 * (i % 16) - 2.9, 0.9 * (i / 16) - 2, 0.25);
        hash = pir_scene_add(scene, &options, &body[i]) == PIR_OK ? hash : 0;
    }
    for (int n = 0; n < updates && hash; n++) {
        pir_scene_move moves[64];
        for (uint32_t i = 0; i < bodies; i++)
            moves[i] = (pir_scene_move){
                body[i],
                {{0, 0.002 * (i % 5), 0, 1},
                 {0.37 * (i % 16) - 2.9 + 0.01 * n, 0.9 * (i / 16) - 2, 0.25 + 0.001 * (i % 7) - 0.002}}};
        hash = pir_scene_update(scene, moves, bodies) == PIR_OK ? hash : 0;
        size_t count;
        const pir_scene_event *event = pir_scene_events(scene, &count);
        for (size_t i = 0; i < count && hash; i++) {
            hash = test_hash(hash, &event[i].normal, sizeof event[i].normal);
            hash = test_hash(hash, event[i].contacts, event[i].contact_count * sizeof(pir_contact));
        }
    }
    for (uint32_t i = 0; i < 8; i++)
        pir_polytope_release(floor_piece[i]);
    for (int k = 0; k < 2; k++)
        pir_polytope_release(half[k]);
    pir_scene_destroy(scene);
    return hash;
}

static void threads_find_the_same_unions(void **state) {
    (void)state;
    const uint64_t one = run_crowd(1, NULL, 60, 5);
    assert_true(one != 0);
    assert_true(run_crowd(2, NULL, 60, 5) == one && run_crowd(4, NULL, 60, 5) == one);
}

static void memory_may_run_out_at_every_request(void **state) {
    (void)state;
    test_memory memory = {0};
    const pir_allocator allocator = test_allocator(&memory);
    uint64_t got = 0;
    for (uint64_t at = 1; got == 0; at++) {
        memory.requests = 0;
        memory.fail_at = at;
        got = run_crowd(1, &allocator, 3, 2);
        assert_true(memory.blocks == 0 && !memory.wrong_size && !memory.overrun && at < 2000);
    }
    assert_true(got == run_crowd(1, NULL, 3, 2));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(floors_of_pieces_have_one_normal),
        cmocka_unit_test(bodies_that_have_sunk_in_feel_the_same_floor),
        cmocka_unit_test(pairs_alone_feel_walls),
        cmocka_unit_test(bodies_that_nothing_is_beside_have_the_contacts_of_pairs),
        cmocka_unit_test(a_corner_holds_on_both_sides_and_what_is_deep_inside_is_pushed_out),
        cmocka_unit_test(threads_find_the_same_unions),
        cmocka_unit_test(memory_may_run_out_at_every_request),
    };
    return cmocka_run_group_tests_name("sliding in scenes", tests, NULL, NULL);
}
