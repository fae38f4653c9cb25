/* SPDX-License-Identifier: MIT */
/* A crowd of bodies, in a scene and by brute force: see crowd.h. */
#include "scene/crowd.h"

#include <math.h>
#include <string.h>

#include "support/bodies.h"
#include "support/hash.h"
#include "support/test.h"
#include "support/vectors.h"

/* --- bodies --- */

/* Random numbers are drawn one statement after the other: the order within an expression is the compiler's. */
static pir_vec3 somewhere(crowd *c) {
    double x = c->size * test_random_unit(&c->random), y = c->size * test_random_unit(&c->random);
    double z = c->size * test_random_unit(&c->random);
    return (pir_vec3){x, y, z};
}

/* A piece about `at`. */
static pir_polytope *random_piece(crowd *c, pir_vec3 at) {
    test_points points;
    static const test_body kinds[6] = {TEST_SPHERE, TEST_BOX, TEST_OCTAHEDRON, TEST_POLYGON, TEST_SEGMENT, TEST_POINT};
    test_body kind = kinds[test_random_below(&c->random, 8) % 6];
    test_body_points(&c->random, kind, 14, &points);
    double most = 0;
    for (size_t i = 0; i < points.count; i++)
        most = fmax(most, test_length(points.at[i]));
    // grids stay grids, so that bodies align
    double scale = most > 1 ? ldexp(1, -ilogb(most)) : 1;
    for (size_t i = 0; i < points.count; i++)
        points.at[i] = test_add(at, points.at[i], scale);
    return test_polytope(&points);
}

static pir_quat random_rotation(crowd *c) {
    return test_random_below(&c->random, 3) == 0 ? (pir_quat){0, 0, 0, 1}
           : test_random_below(&c->random, 2)    ? test_integer_rotation(&c->random)
                                                 : test_general_rotation(&c->random);
}

/* A place on a coarse grid, where boxes touch, or anywhere. */
static pir_vec3 random_place(crowd *c) {
    pir_vec3 at = somewhere(c);
    if (test_random_below(&c->random, 3) == 0)
        at = (pir_vec3){rint(2 * at.x) / 2, rint(2 * at.y) / 2, rint(2 * at.z) / 2};
    return at;
}

static pir_pose random_pose(crowd *c) {
    pir_quat rotation = random_rotation(c);
    return (pir_pose){rotation, random_place(c)};
}

static void random_options(crowd *c, crowd_body *body) {
    pir_body_options *options = &body->options;
    *options = pir_body_options_default();
    uint32_t kind = test_random_below(&c->random, 8);
    options->kind = kind == 0 ? PIR_BODY_STATIC : kind == 1 ? PIR_BODY_KINEMATIC : PIR_BODY_MOVING;
    options->pose = random_pose(c);
    options->piece_count = test_random_below(&c->random, 3) == 0 ? 1 + test_random_below(&c->random, CROWD_PIECES) : 1;
    for (uint32_t i = 0; i < options->piece_count; i++)
        body->piece[i] = random_piece(c, (pir_vec3){(double)i, 0, 0});
    options->pieces = body->piece;
    options->radius = test_random_below(&c->random, 6) == 0 ? 0.25 : 0;
    options->sensor = test_random_below(&c->random, 8) == 0;
    if (test_random_below(&c->random, 5) == 0) {
        options->category = 1u << test_random_below(&c->random, 3);
        options->mask = test_random_below(&c->random, 8);
    }
}

const crowd_body *crowd_body_of(const crowd *c, uint32_t id) {
    for (uint32_t i = 0; i < CROWD_BODIES; i++)
        if (c->body[i].used && c->body[i].id == id)
            return &c->body[i];
    return NULL;
}

void crowd_add(crowd *c) {
    uint32_t index = 0;
    while (index < CROWD_BODIES && c->body[index].used)
        index++;
    if (index == CROWD_BODIES)
        return;
    crowd_body *body = &c->body[index];
    random_options(c, body);
    assert_int_equal(pir_scene_add(c->scene, &body->options, &body->id), PIR_OK);
    assert_true(body->id < CROWD_BODIES);
    body->used = body->fresh = true;
    c->count++;
}

void crowd_remove(crowd *c, uint32_t index) {
    crowd_body *body = &c->body[index];
    if (!body->used)
        return;
    assert_int_equal(pir_scene_remove(c->scene, body->id), PIR_OK);
    assert_int_equal(pir_scene_remove(c->scene, body->id), PIR_ERR_ARGUMENT);
    assert_true(pir_scene_is_valid(c->scene));
    for (uint32_t other = 0; other < CROWD_BODIES; other++) {
        memset(c->touching[body->id][other], 0, sizeof c->touching[0][0]);
        memset(c->touching[other][body->id], 0, sizeof c->touching[0][0]);
    }
    for (uint32_t i = 0; i < body->options.piece_count; i++)
        pir_polytope_release(body->piece[i]);
    body->used = false;
    c->count--;
}

void crowd_init(crowd *c, uint64_t number, uint32_t count, const pir_scene_options *options) {
    memset(c, 0, sizeof *c);
    c->random = test_random_case("crowd", number);
    c->options = *options;
    // its cube is near the count; without the C library, whose roots differ
    while (c->size * c->size * c->size < 0.5 * count)
        c->size += 0.125;
    assert_int_equal(pir_scene_create(options, &c->scene), PIR_OK);
    for (uint32_t i = 0; i < count; i++)
        crowd_add(c);
}

void crowd_finish(crowd *c) {
    pir_scene_destroy(c->scene);
    for (uint32_t i = 0; i < CROWD_BODIES; i++)
        for (uint32_t k = 0; c->body[i].used && k < c->body[i].options.piece_count; k++)
            pir_polytope_release(c->body[i].piece[k]);
}

void crowd_move(crowd *c, double part) {
    c->moves = 0;
    for (uint32_t i = 0; i < CROWD_BODIES; i++) {
        crowd_body *body = &c->body[i];
        if (!body->used || body->options.kind == PIR_BODY_STATIC || test_random_unit(&c->random) > 2 * part - 1)
            continue;
        pir_pose *pose = &body->options.pose;
        uint32_t how = test_random_below(&c->random, 16);
        if (how == 0) {
            *pose = random_pose(c);
        } else if (how < 14) {
            pir_vec3 velocity = test_random_direction(&c->random), spin = test_random_direction(&c->random);
            double time = 0.1 * test_random_unit(&c->random);
            *pose = pir_pose_integrate(*pose, velocity, spin, time);
        }
        c->move[c->moves++] = (pir_scene_move){body->id, *pose};
    }
}

/* --- by brute force --- */

static bool may_meet(const crowd_body *a, const crowd_body *b) {
    const pir_body_options *p = &a->options, *q = &b->options;
    return (p->kind == PIR_BODY_MOVING || q->kind == PIR_BODY_MOVING) && (p->category & q->mask) &&
           (q->category & p->mask) && !(p->sensor && q->sensor);
}

static bool was_moved(const crowd *c, const crowd_body *body) {
    for (size_t i = 0; i < c->moves; i++)
        if (c->move[i].body == body->id)
            return true;
    return body->fresh;
}

struct reply {
    pir_query_result answer;
    pir_contact contacts[128];
    size_t count;
};

/* The answer of a pair made for it, with its contacts; whether they are in contact. */
static bool ask_pieces(const crowd *c, const crowd_body *p, const crowd_body *q, uint32_t i, uint32_t k,
                       struct reply *reply) {
    pir_pair *pair;
    pir_workspace *workspace;
    pir_pair_input input = pir_pair_input_default();
    input.pose_p = p->options.pose;
    input.pose_q = q->options.pose;
    input.radius_p = p->options.radius;
    input.radius_q = q->options.radius;
    input.margin = c->options.margin;
    assert_int_equal(pir_pair_create(p->piece[i], q->piece[k], NULL, &pair), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    assert_int_equal(pir_pair_signed_distance(pair, workspace, &input, &reply->answer), PIR_OK);
    bool sensor = p->options.sensor || q->options.sensor;
    bool is = reply->answer.state != PIR_OUTSIDE ||
              (!sensor && c->options.margin > 0 && reply->answer.distance <= c->options.margin);
    reply->count = 0;
    if (is && !sensor && c->options.detail == PIR_SCENE_MANIFOLDS)
        assert_int_equal(
            pir_pair_manifold(pair, workspace, &input, &reply->answer, 128, reply->contacts, &reply->count), PIR_OK);
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    return is;
}

static bool same_contacts(const pir_contact *a, const pir_contact *b, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (a[i].id != b[i].id || memcmp(&a[i].distance, &b[i].distance, sizeof(double)) != 0 ||
            memcmp(&a[i].point_p, &b[i].point_p, sizeof(pir_vec3)) != 0 ||
            memcmp(&a[i].point_q, &b[i].point_q, sizeof(pir_vec3)) != 0)
            return false;
    return true;
}

static bool same_numbers(const crowd *c, const pir_scene_event *event, const pir_query_result *answer) {
    if (event->state != answer->state)
        return false;
    if (event->sensor || c->options.detail == PIR_SCENE_STATES)
        return event->distance == 0 && event->normal.x == 0 && event->witness.p.kind == PIR_FEATURE_NONE;
    return memcmp(&event->distance, &answer->distance, sizeof(double)) == 0 &&
           memcmp(&event->normal, &answer->normal, sizeof(pir_vec3)) == 0 &&
           memcmp(&event->witness, &answer->witness, sizeof(pir_witness)) == 0;
}

/* How far a body's point that is at `point` has come, from the poses before and after. */
static pir_vec3 way_of(const pir_pose *before, const pir_pose *after, pir_vec3 point) {
    pir_vec3 own = test_turn(after->rotation, test_add(point, after->translation, -1), -1);
    pir_vec3 old = test_add(test_turn(before->rotation, own, 1), before->translation, 1);
    return test_add(point, old, -1);
}

static void check_approach(const crowd *c, const pir_scene_event *event, const pir_pose before[], uint64_t number) {
    const crowd_body *p = crowd_body_of(c, event->body_p), *q = crowd_body_of(c, event->body_q);
    double expected = 0;
    if (c->options.approach && event->contact_count > 0) {
        pir_vec3 of_p = way_of(&before[event->body_p], &p->options.pose, event->contacts[0].point_p);
        pir_vec3 of_q = way_of(&before[event->body_q], &q->options.pose, event->contacts[0].point_q);
        expected = test_dot(test_add(of_q, of_p, -1), event->normal);
    }
    expect(fabs(event->approach - expected) <= 1e-12, "crowd %llu: approach", (unsigned long long)number);
}

/* The next event is that of these pieces, where they need one; whether there was one. */
static bool check_pieces(crowd *c, const crowd_body *p, const crowd_body *q, uint32_t i, uint32_t k,
                         const pir_scene_event *event, uint64_t number) {
    struct reply reply;
    bool *before = &c->touching[p->id][q->id][i][k];
    bool is = ask_pieces(c, p, q, i, k, &reply);
    bool was = *before;
    unsigned long long n = number;
    c->contacts += is;
    *before = is;
    if (!is && !was)
        return false;
    expect(event && event->body_p == p->id && event->body_q == q->id && event->piece_p == i && event->piece_q == k,
           "crowd %llu: bodies %u, %u, pieces %u, %u have no event", n, p->id, q->id, i, k);
    pir_event_kind kind = !is ? PIR_EVENT_ENDED : was ? PIR_EVENT_PERSISTED : PIR_EVENT_BEGAN;
    expect(event->kind == kind && !event->sensor == !(p->options.sensor || q->options.sensor), "crowd %llu", n);
    if (is) {
        expect(same_numbers(c, event, &reply.answer), "crowd %llu: bodies %u, %u", n, p->id, q->id);
        expect(event->contact_count == reply.count && same_contacts(event->contacts, reply.contacts, reply.count),
               "crowd %llu", n);
    }
    return true;
}

void crowd_update_and_check(crowd *c, uint64_t number) {
    pir_pose before[CROWD_BODIES];
    size_t count, next = 0;
    for (uint32_t i = 0; i < CROWD_BODIES; i++)
        if (c->body[i].used)
            assert_int_equal(pir_scene_pose(c->scene, c->body[i].id, &before[c->body[i].id]), PIR_OK);
    assert_int_equal(pir_scene_update(c->scene, c->move, c->moves), PIR_OK);
    expect(pir_scene_is_valid(c->scene), "crowd %llu", (unsigned long long)number);
    const pir_scene_event *events = pir_scene_events(c->scene, &count);
    for (uint32_t a = 0; a < CROWD_BODIES; a++)
        for (uint32_t b = a + 1; b < CROWD_BODIES; b++) {
            const crowd_body *p = crowd_body_of(c, a), *q = crowd_body_of(c, b);
            if (!p || !q || !may_meet(p, q) || !(was_moved(c, p) || was_moved(c, q)))
                continue;
            for (uint32_t i = 0; i < p->options.piece_count; i++)
                for (uint32_t k = 0; k < q->options.piece_count; k++)
                    if (check_pieces(c, p, q, i, k, next < count ? &events[next] : NULL, number))
                        check_approach(c, &events[next++], before, number);
        }
    for (uint32_t i = 0; i < CROWD_BODIES; i++)
        c->body[i].fresh = false;
    expect(next == count, "crowd %llu: %zu events, %zu expected", (unsigned long long)number, count, next);
}

/* --- hashes --- */

uint64_t crowd_hash_events(uint64_t hash, const pir_scene *scene) {
    size_t count;
    const pir_scene_event *event = pir_scene_events(scene, &count);
    hash = test_hash(hash, &count, sizeof count);
    for (const pir_scene_event *end = event + count; event != end; event++) {
        const uint32_t numbers[12] = {event->kind,           event->body_p,          event->body_q,
                                      event->piece_p,        event->piece_q,         (uint32_t)event->sensor,
                                      event->state,          event->witness.p.kind,  event->witness.p.index,
                                      event->witness.q.kind, event->witness.q.index, event->contact_count};
        hash = test_hash(hash, numbers, sizeof numbers);
        hash = test_hash(hash, &event->distance, sizeof event->distance);
        hash = test_hash(hash, &event->normal, sizeof event->normal);
        hash = test_hash(hash, &event->approach, sizeof event->approach);
        for (uint32_t i = 0; i < event->contact_count; i++) {
            hash = test_hash(hash, &event->contacts[i].id, sizeof event->contacts[i].id);
            hash = test_hash(hash, &event->contacts[i].point_p, sizeof(pir_vec3));
            hash = test_hash(hash, &event->contacts[i].point_q, sizeof(pir_vec3));
        }
    }
    return hash;
}
