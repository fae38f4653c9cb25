/* SPDX-License-Identifier: MIT */
/* A crowd of bodies, in a scene and by brute force: see crowd.h. */
#include "scene/crowd.h"

#include <math.h>
#include <stdlib.h>
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
    options->user = (uint64_t)1 << 40 | c->adds++;
    static const uint64_t users[CROWD_PIECES] = {100, 101, 102};
    options->piece_users = users;
    options->radius = test_random_below(&c->random, 6) == 0 ? 0.25 : 0;
    options->sensor = test_random_below(&c->random, 8) == 0;
    if (test_random_below(&c->random, 5) == 0) {
        options->category = 1u << test_random_below(&c->random, 3);
        options->mask = test_random_below(&c->random, 8);
    }
}

const crowd_body *crowd_body_of(const crowd *c, uint32_t id) {
    for (uint32_t i = 0; i < CROWD_BODIES; i++)
        if (c->body[i].used && pir_body_number(c->body[i].id) == pir_body_number(id))
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
    assert_true(pir_body_number(body->id) < CROWD_BODIES && pir_scene_has(c->scene, body->id));
    body->used = body->fresh = true;
    c->count++;
}

/* Whether two bodies meet, by the rules of scene.h. */
static bool may_meet(const crowd_body *a, const crowd_body *b) {
    const pir_body_options *p = &a->options, *q = &b->options;
    const bool moves = p->kind == PIR_BODY_MOVING || q->kind == PIR_BODY_MOVING;
    const bool is_sensed = (p->sensor && q->kind == PIR_BODY_KINEMATIC) || (q->sensor && p->kind == PIR_BODY_KINEMATIC);
    return !p->disabled && !q->disabled && (moves || is_sensed) && (p->category & q->mask) && (q->category & p->mask) &&
           !(p->sensor && q->sensor);
}

static void end_contact(crowd *c, const crowd_body *p, const crowd_body *q, bool sensor) {
    for (uint32_t i = 0; i < CROWD_PIECES; i++)
        for (uint32_t k = 0; k < CROWD_PIECES; k++) {
            bool *touching = &c->touching[pir_body_number(p->id)][pir_body_number(q->id)][i][k];
            if (!*touching)
                continue;
            *touching = false;
            assert_true(c->gone_count < CROWD_GONE);
            c->gone[c->gone_count++] = (pir_scene_event){.kind = PIR_EVENT_ENDED,
                                                         .body_p = p->id,
                                                         .body_q = q->id,
                                                         .piece_p = i,
                                                         .piece_q = k,
                                                         .user_p = p->options.user,
                                                         .user_q = q->options.user,
                                                         .sensor = sensor};
        }
}

/* Ends the contacts of a body with those that it does not meet, or all. */
static void end_contacts(crowd *c, const crowd_body *body, bool all) {
    for (uint32_t i = 0; i < CROWD_BODIES; i++) {
        const crowd_body *other = &c->body[i];
        if (!other->used || other == body || (!all && may_meet(body, other)))
            continue;
        const bool first = pir_body_number(body->id) < pir_body_number(other->id);
        end_contact(c, first ? body : other, first ? other : body, body->options.sensor || other->options.sensor);
    }
}

void crowd_remove(crowd *c, uint32_t index) {
    crowd_body *body = &c->body[index];
    if (!body->used)
        return;
    end_contacts(c, body, true);
    assert_int_equal(pir_scene_remove(c->scene, body->id), PIR_OK);
    assert_false(pir_scene_has(c->scene, body->id));
    assert_int_equal(pir_scene_remove(c->scene, body->id), PIR_ERR_ARGUMENT);
    assert_true(pir_scene_is_valid(c->scene));
    for (uint32_t i = 0; i < body->options.piece_count; i++)
        pir_polytope_release(body->piece[i]);
    body->used = false;
    c->count--;
}

void crowd_change(crowd *c, uint32_t index) {
    crowd_body *body = &c->body[index];
    pir_body_options *options = &body->options;
    if (!body->used)
        return;
    const uint32_t how = test_random_below(&c->random, 4);
    if (how == 0) {
        options->sensor = !options->sensor;
        assert_int_equal(pir_scene_set_sensor(c->scene, body->id, options->sensor), PIR_OK);
    } else if (how == 1) {
        options->category = 1u << test_random_below(&c->random, 3);
        options->mask = test_random_below(&c->random, 8);
        assert_int_equal(pir_scene_set_filter(c->scene, body->id, options->category, options->mask), PIR_OK);
    } else {
        options->disabled = !options->disabled;
        assert_int_equal(pir_scene_set_disabled(c->scene, body->id, options->disabled), PIR_OK);
    }
    end_contacts(c, body, false);
    body->fresh = true;
    assert_true(pir_scene_is_valid(c->scene));
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
        pir_vec3 of_p = way_of(&before[pir_body_number(event->body_p)], &p->options.pose, event->contacts[0].point_p);
        pir_vec3 of_q = way_of(&before[pir_body_number(event->body_q)], &q->options.pose, event->contacts[0].point_q);
        expected = test_dot(test_add(of_q, of_p, -1), event->normal);
    }
    expect(fabs(event->approach - expected) <= 1e-12, "crowd %llu: approach", (unsigned long long)number);
}

/* The next event is that of these pieces, where they need one; whether there was one. */
static bool check_pieces(crowd *c, const crowd_body *p, const crowd_body *q, uint32_t i, uint32_t k,
                         const pir_scene_event *event, uint64_t number) {
    struct reply reply;
    bool *before = &c->touching[pir_body_number(p->id)][pir_body_number(q->id)][i][k];
    bool is = ask_pieces(c, p, q, i, k, &reply);
    bool was = *before;
    unsigned long long n = number;
    c->contacts += is;
    *before = is;
    if (!is && !was)
        return false;
    expect(event && event->body_p == p->id && event->body_q == q->id && event->piece_p == i && event->piece_q == k,
           "crowd %llu: bodies %u, %u, pieces %u, %u have no event", n, p->id, q->id, i, k);
    expect(event->user_p == p->options.user && event->user_q == q->options.user, "crowd %llu: users", n);
    expect(event->piece_user_p == 100 + i && event->piece_user_q == 100 + k, "crowd %llu: users of pieces", n);
    pir_event_kind kind = !is ? PIR_EVENT_ENDED : was ? PIR_EVENT_PERSISTED : PIR_EVENT_BEGAN;
    expect(event->kind == kind && !event->sensor == !(p->options.sensor || q->options.sensor), "crowd %llu", n);
    if (is) {
        expect(same_numbers(c, event, &reply.answer), "crowd %llu: bodies %u, %u", n, p->id, q->id);
        expect(event->contact_count == reply.count && same_contacts(event->contacts, reply.contacts, reply.count),
               "crowd %llu", n);
    }
    return true;
}

static uint32_t order_of(uint32_t id) {
    return pir_body_number(id) << 12 | id >> 20;
}

static int by_order(const void *x, const void *y) {
    const pir_scene_event *a = x, *b = y;
    const uint32_t p[4] = {order_of(a->body_p), order_of(a->body_q), a->piece_p, a->piece_q};
    const uint32_t q[4] = {order_of(b->body_p), order_of(b->body_q), b->piece_p, b->piece_q};
    for (int k = 0; k < 4; k++)
        if (p[k] != q[k])
            return p[k] < q[k] ? -1 : 1;
    return 0;
}

/* The ends that bodies left which were removed or changed stand in order among the events; the others are given. */
static size_t check_gone(crowd *c, const pir_scene_event *events, size_t count, pir_scene_event *ret_others,
                         uint64_t number) {
    size_t next = 0, others = 0;
    qsort(c->gone, c->gone_count, sizeof *c->gone, by_order);
    for (size_t i = 0; i < count; i++) {
        expect(i == 0 || by_order(&events[i - 1], &events[i]) <= 0, "crowd %llu: event %zu is out of order",
               (unsigned long long)number, i);
        const pir_scene_event *gone = next < c->gone_count ? &c->gone[next] : NULL;
        if (!gone || events[i].kind != PIR_EVENT_ENDED || by_order(gone, &events[i]) != 0) {
            ret_others[others++] = events[i];
            continue;
        }
        expect(events[i].user_p == gone->user_p && events[i].user_q == gone->user_q &&
                   events[i].piece_user_p == 100 + gone->piece_p && events[i].piece_user_q == 100 + gone->piece_q &&
                   !events[i].sensor == !gone->sensor && events[i].contact_count == 0,
               "crowd %llu: an end of a body that is gone", (unsigned long long)number);
        next++;
    }
    expect(next == c->gone_count, "crowd %llu: %zu ends, %zu expected", (unsigned long long)number, next,
           c->gone_count);
    c->gone_count = 0;
    return others;
}

void crowd_update_and_check(crowd *c, uint64_t number) {
    pir_pose before[CROWD_BODIES];
    size_t count, next = 0;
    for (uint32_t i = 0; i < CROWD_BODIES; i++)
        if (c->body[i].used)
            assert_int_equal(pir_scene_pose(c->scene, c->body[i].id, &before[pir_body_number(c->body[i].id)]), PIR_OK);
    assert_int_equal(pir_scene_update(c->scene, c->move, c->moves), PIR_OK);
    expect(pir_scene_is_valid(c->scene), "crowd %llu", (unsigned long long)number);
    static pir_scene_event events[CROWD_BODIES * CROWD_BODIES * CROWD_PIECES * CROWD_PIECES];
    const pir_scene_event *all = pir_scene_events(c->scene, &count);
    count = check_gone(c, all, count, events, number);
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
