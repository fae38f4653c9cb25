/* SPDX-License-Identifier: MIT */
/*
 * Scenes that may tell manifolds of bodies that moved little again, beside scenes that may not: the same states, in
 * every frame. What is told again is held against poses of the frame that it was found in, by vertices alone: contacts
 * move with their bodies, no vertex has moved farther than the error, no distance is off by more, and no direction is
 * better than the normal by more than twice that. The same bits with 1, 2 and 4 threads and after restores; bytes that
 * lie; memory that fails.
 *
 * PIR_TEST_HEAPS sets how many heaps there are.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/scene_file.h>

#include "scene/reuse_heap.h"
#include "support/memory.h"
#include "support/vectors.h"

#define FRAMES 10
#define SLACK  1e-9
#define TRACKS 20000
#define SLOTS  4096

/* A contact as it was found, and where the bodies stood. */
struct track {
    uint32_t body[2], piece[2];
    uint64_t id;
    pir_vec3 point[2]; /* in the bodies' frames */
    pir_pose pose[2];
    uint32_t next; /* in its slot, from 1; 0 for none */
};

/* A heap in a scene that reuses, and in one that does not. */
struct twins {
    heap h;
    pir_scene_options options;
    pir_scene *old, *fresh, *pairs; /* the last without unions */
    struct track track[TRACKS];
    uint32_t slot[SLOTS];
    size_t tracks;
    uint64_t number, carried, compared;
};

static uint32_t heaps(void) {
    const char *set = getenv("PIR_TEST_HEAPS");
    return set ? (uint32_t)strtoul(set, NULL, 10) : 1000;
}

/* --- by vertices alone --- */

static pir_vec3 placed(pir_pose pose, pir_vec3 v) {
    return test_add(test_turn(pose.rotation, v, 1), pose.translation, 1);
}

static pir_vec3 unplaced(pir_pose pose, pir_vec3 x) {
    return test_turn(pose.rotation, test_add(x, pose.translation, -1), -1);
}

/* How far a vertex of body `side` moved, as the other body sees it; HUGE_VAL of a surface. */
static double way_of(const heap *h, const struct track *track, const pir_pose now[2], int side) {
    const heap_body *body = &h->body[track->body[side]];
    if (body->options.piece_count == 0)
        return HUGE_VAL;
    const pir_polytope *p = body->piece[track->piece[side]];
    double most = 0;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
        const pir_vec3 at = pir_polytope_vertex(p, v);
        const pir_vec3 before = unplaced(track->pose[1 - side], placed(track->pose[side], at));
        const pir_vec3 after = unplaced(now[1 - side], placed(now[side], at));
        most = fmax(most, test_length(test_add(after, before, -1)));
    }
    return most;
}

/* How far two pieces are apart along a direction. */
static double gap_along(const heap *h, const pir_scene_event *event, pir_vec3 n) {
    const heap_body *p = &h->body[event->body_p], *q = &h->body[event->body_q];
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(p->piece[event->piece_p]); v++)
        low = fmin(low, test_dot(n, placed(p->options.pose, pir_polytope_vertex(p->piece[event->piece_p], v))));
    for (uint32_t v = 0; v < pir_polytope_vertex_count(q->piece[event->piece_q]); v++)
        high = fmax(high, test_dot(n, placed(q->options.pose, pir_polytope_vertex(q->piece[event->piece_q], v))));
    return low - high - p->options.radius - q->options.radius;
}

/* --- tracks --- */

/* The place in the table of a contact of an event. */
static uint32_t slot_of(const pir_scene_event *event, uint64_t id) {
    const uint64_t names[5] = {event->body_p, event->body_q, event->piece_p, event->piece_q, id};
    uint64_t hash = 1;
    for (int k = 0; k < 5; k++)
        hash = (hash ^ names[k]) * UINT64_C(0x9e3779b97f4a7c15) >> 7;
    return (uint32_t)(hash % SLOTS);
}

static void note_event(struct twins *t, const pir_scene_event *event) {
    const pir_pose p = t->h.body[event->body_p].options.pose, q = t->h.body[event->body_q].options.pose;
    for (uint32_t i = 0; i < event->contact_count; i++) {
        const pir_contact *contact = &event->contacts[i];
        uint32_t *slot = &t->slot[slot_of(event, contact->id)];
        assert_true(t->tracks < TRACKS);
        t->track[t->tracks] = (struct track){{event->body_p, event->body_q},
                                             {event->piece_p, event->piece_q},
                                             contact->id,
                                             {unplaced(p, contact->point_p), unplaced(q, contact->point_q)},
                                             {p, q},
                                             *slot};
        *slot = (uint32_t)++t->tracks;
    }
}

/* All contacts of a scene that does not reuse. */
static void note_contacts(struct twins *t, const pir_scene *scene) {
    size_t count;
    const pir_scene_event *event = pir_scene_events(scene, &count);
    for (size_t i = 0; i < count; i++)
        note_event(t, &event[i]);
}

/* Whether a contact was found when the bodies stood as told by a track, and has moved with them since. */
static bool is_of(const struct twins *t, const struct track *track, const pir_scene_event *event,
                  const pir_contact *contact) {
    const pir_pose now[2] = {t->h.body[event->body_p].options.pose, t->h.body[event->body_q].options.pose};
    const pir_vec3 p = placed(now[0], track->point[0]), q = placed(now[1], track->point[1]);
    return track->body[0] == event->body_p && track->body[1] == event->body_q && track->piece[0] == event->piece_p &&
           track->piece[1] == event->piece_q && track->id == contact->id &&
           test_length(test_add(contact->point_p, p, -1)) <= SLACK &&
           test_length(test_add(contact->point_q, q, -1)) <= SLACK &&
           fmin(way_of(&t->h, track, now, 0), way_of(&t->h, track, now, 1)) <= event->error + 1e-12;
}

/* Each contact that is told again was one in some frame from which no vertex has moved farther than the error. */
static void check_contacts(struct twins *t, const pir_scene_event *event) {
    for (uint32_t i = 0; i < event->contact_count; i++) {
        const pir_contact *contact = &event->contacts[i];
        uint32_t at = t->slot[slot_of(event, contact->id)];
        while (at > 0 && !is_of(t, &t->track[at - 1], event, contact))
            at = t->track[at - 1].next;
        expect(at > 0, "heap %llu: contact %u of bodies %u and %u was in no frame as near as %g",
               (unsigned long long)t->number, i, event->body_p, event->body_q, event->error);
        const double along = test_dot(event->normal, test_add(contact->point_p, contact->point_q, -1));
        expect(fabs(contact->distance - along) <= SLACK, "heap %llu: a contact's distance",
               (unsigned long long)t->number);
        t->carried++;
    }
}

/* --- frames --- */

/* Whether events of a pair are of it alone: of no surface, no union. */
static bool is_alone(const struct twins *t, const pir_scene_event *event) {
    return !t->options.unions && t->h.body[event->body_p].options.piece_count > 0 &&
           t->h.body[event->body_q].options.piece_count > 0;
}

/* Whether contacts are the same in every bit. */
static bool same_contacts(const pir_scene_event *a, const pir_scene_event *b) {
    bool same = a->contact_count == b->contact_count;
    for (uint32_t i = 0; i < a->contact_count && same; i++) {
        const pir_contact *x = &a->contacts[i], *y = &b->contacts[i];
        same = x->id == y->id && x->distance == y->distance && memcmp(&x->point_p, &y->point_p, sizeof x->point_p) == 0;
    }
    return same;
}

static void compare(struct twins *t, const pir_scene_event *old, const pir_scene_event *fresh) {
    const unsigned long long number = t->number;
    expect(old->kind == fresh->kind && old->state == fresh->state, "heap %llu: bodies %u and %u, pieces %u and %u",
           number, old->body_p, old->body_q, old->piece_p, old->piece_q);
    if (old->kind == PIR_EVENT_ENDED || old->sensor)
        return;
    if (is_alone(t, old)) {
        const double off = fabs(old->distance - fresh->distance), gap = gap_along(&t->h, old, old->normal);
        expect(off <= old->error + SLACK, "heap %llu: %g off, not %g", number, off, old->error);
        expect((old->distance < 0) == (fresh->distance < 0), "heap %llu: %g is %g", number, old->distance,
               fresh->distance);
        expect(fresh->distance - gap <= 2 * old->error + SLACK, "heap %llu: %g along the normal, not %g within %g",
               number, gap, fresh->distance, old->error);
        expect(old->error > 0 || same_contacts(old, fresh), "heap %llu: contacts of this frame", number);
    }
    t->compared++;
}

static bool same_pair(const pir_scene_event *a, const pir_scene_event *b) {
    return a->body_p == b->body_p && a->body_q == b->body_q && a->piece_p == b->piece_p && a->piece_q == b->piece_q;
}

/* Pair by pair, for one with a surface may have more events than another. */
static void compare_all(struct twins *t) {
    size_t olds, news, i = 0, k = 0;
    const pir_scene_event *old = pir_scene_events(t->old, &olds), *fresh = pir_scene_events(t->fresh, &news);
    while (i < olds && k < news) {
        expect(same_pair(&old[i], &fresh[k]), "heap %llu: another pair", (unsigned long long)t->number);
        compare(t, &old[i], &fresh[k]);
        for (i++; i < olds && same_pair(&old[i], &old[i - 1]); i++)
            continue;
        for (k++; k < news && same_pair(&fresh[k], &fresh[k - 1]); k++)
            continue;
    }
    expect(i == olds && k == news, "heap %llu: %zu events and %zu", (unsigned long long)t->number, olds, news);
    for (i = 0; i < olds; i++) {
        expect(old[i].error >= 0 && old[i].error <= t->options.reuse, "heap %llu: an error of %g",
               (unsigned long long)t->number, old[i].error);
        if (old[i].error > 0)
            check_contacts(t, &old[i]);
    }
}

static void step(struct twins *t) {
    heap_move(&t->h);
    assert_int_equal(pir_scene_update(t->old, t->h.move, t->h.moves), PIR_OK);
    assert_int_equal(pir_scene_update(t->fresh, t->h.move, t->h.moves), PIR_OK);
    assert_int_equal(pir_scene_update(t->pairs, t->h.move, t->h.moves), PIR_OK);
    expect(pir_scene_is_valid(t->old), "heap %llu", (unsigned long long)t->number);
    note_contacts(t, t->fresh);
    note_contacts(t, t->pairs);
    compare_all(t);
}

static pir_scene_options options_of(uint64_t number) {
    static const double reuses[4] = {1e-3, 0.01, 0.05, 1e-6};
    pir_scene_options options = pir_scene_options_default();
    options.reuse = reuses[number / 6 % 4];
    options.margin = number % 2 ? 0.02 : 0;
    options.unions = number / 2 % 2;
    options.approach = number % 5 == 0;
    return options;
}

static void heaps_have_the_same_states(void **state) {
    (void)state;
    static struct twins t;
    uint64_t carried = 0, compared = 0;
    const uint32_t cases = heaps();
    for (uint64_t n = 0; n < cases; n++) {
        memset(&t, 0, sizeof t);
        t.number = n;
        t.options = options_of(n);
        heap_init(&t.h, n, 6 + (uint32_t)(n % 9));
        t.old = heap_scene(&t.h, &t.options);
        pir_scene_options fresh = t.options;
        fresh.reuse = 0;
        t.fresh = heap_scene(&t.h, &fresh);
        fresh.unions = false;
        t.pairs = heap_scene(&t.h, &fresh);
        for (int f = 0; f < FRAMES; f++)
            step(&t);
        carried += t.carried;
        compared += t.compared;
        pir_scene_destroy(t.old);
        pir_scene_destroy(t.fresh);
        pir_scene_destroy(t.pairs);
        heap_finish(&t.h);
    }
    print_message("%llu contacts told again, %llu pairs compared\n", (unsigned long long)carried,
                  (unsigned long long)compared);
    assert_true(carried > 20 * (uint64_t)cases);
}

/* --- the same bits --- */

struct bytes {
    unsigned char *data;
    size_t size;
};

static struct bytes snapshot(pir_scene *scene) {
    struct bytes bytes = {NULL, pir_scene_serialised_size(scene)};
    bytes.data = malloc(bytes.size);
    assert_non_null(bytes.data);
    assert_int_equal(pir_scene_serialise(scene, bytes.data, bytes.size), PIR_OK);
    return bytes;
}

static bool same_bytes(const struct bytes *a, const struct bytes *b) {
    return a->size == b->size && memcmp(a->data, b->data, a->size) == 0;
}

static void threads_and_restores_give_the_same_bits(void **state) {
    (void)state;
    static heap h;
    for (uint64_t n = 0; n < 48; n++) {
        static const uint32_t threads[4] = {1, 2, 4, 1};
        pir_scene *scene[4];
        pir_scene_options options = options_of(n);
        heap_init(&h, 5000 + n, 20 + (uint32_t)(n % 40));
        for (int k = 0; k < 4; k++) {
            options.threads = threads[k];
            scene[k] = heap_scene(&h, &options);
        }
        for (int f = 0; f < FRAMES; f++) {
            struct bytes all[4];
            heap_move(&h);
            for (int k = 0; k < 4; k++) {
                assert_int_equal(pir_scene_update(scene[k], h.move, h.moves), PIR_OK);
                expect(k == 0 || heap_same_events(scene[0], scene[k]), "heap %llu, frame %d, scene %d",
                       (unsigned long long)n, f, k);
                all[k] = snapshot(scene[k]);
                expect(same_bytes(&all[0], &all[k]), "heap %llu, frame %d, scene %d", (unsigned long long)n, f, k);
            }
            // the last one sees two frames that the others do not, and goes back
            for (int on = 0; on < 2; on++) {
                heap other = h;
                heap_move(&other);
                assert_int_equal(pir_scene_update(scene[3], other.move, other.moves), PIR_OK);
            }
            assert_int_equal(pir_scene_restore(scene[3], all[0].data, all[0].size, NULL), PIR_OK);
            expect(pir_scene_is_valid(scene[3]), "heap %llu, frame %d", (unsigned long long)n, f);
            for (int k = 0; k < 4; k++)
                free(all[k].data);
        }
        for (int k = 0; k < 4; k++)
            pir_scene_destroy(scene[k]);
        heap_finish(&h);
    }
}

/* --- bytes that lie --- */

/* Sets the checksum right. */
static void seal(struct bytes *bytes) {
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < bytes->size; i += 8) {
        uint64_t word = 0;
        for (size_t k = 0; k < 8; k++)
            word |= (uint64_t)bytes->data[i + k] << (8 * k);
        if (i != 32)
            hash = (hash ^ word) * UINT64_C(0x100000001b3);
    }
    for (int k = 0; k < 8; k++)
        bytes->data[32 + k] = (unsigned char)(hash >> (8 * k));
}

static void bytes_that_lie_harm_nothing(void **state) {
    (void)state;
    static heap h;
    for (uint64_t n = 0; n < 12; n++) {
        pir_scene_options options = options_of(n + 6);
        options.keep_shapes = true; // of bodies that lies take away
        heap_init(&h, 7000 + n, 5);
        pir_scene *scene = heap_scene(&h, &options), *other = NULL;
        options.reuse = 0;
        other = heap_scene(&h, &options);
        heap_move(&h);
        assert_int_equal(pir_scene_update(scene, h.move, h.moves), PIR_OK);
        struct bytes good = snapshot(scene), bad = snapshot(scene);
        pir_report first = {PIR_OK, ""};
        expect(pir_scene_restore(other, good.data, good.size, &first) == PIR_OK, "heap %llu: %s", (unsigned long long)n,
               first.text);
        for (size_t i = 0; i < good.size; i++) {
            pir_report report = {PIR_OK, ""};
            memcpy(bad.data, good.data, good.size);
            bad.data[i] ^= (unsigned char)(1u << test_random_below(&h.random, 8));
            seal(&bad);
            if (pir_scene_restore(scene, bad.data, bad.size, &report) == PIR_OK)
                (void)pir_scene_update(scene, h.move, h.moves); // poses may be too far away now
            expect(pir_scene_is_valid(scene), "heap %llu, byte %zu", (unsigned long long)n, i);
            const pir_status status = pir_scene_restore(scene, good.data, good.size, &report);
            expect(status == PIR_OK, "heap %llu, byte %zu: %s", (unsigned long long)n, i, report.text);
        }
        for (size_t cut = 8; cut < good.size; cut += 8) {
            bad.size = good.size - cut;
            memcpy(bad.data, good.data, bad.size);
            if (bad.size >= 40)
                seal(&bad);
            assert_int_not_equal(pir_scene_restore(scene, bad.data, bad.size, NULL), PIR_OK);
        }
        free(good.data);
        free(bad.data);
        pir_scene_destroy(scene);
        pir_scene_destroy(other);
        heap_finish(&h);
    }
}

/* --- memory --- */

/* Whatever request fails, the scene is as it was, and goes on as one that never failed. */
static void memory_that_fails_changes_nothing(void **state) {
    (void)state;
    static heap h;
    for (uint64_t n = 0; n < 6; n++) {
        test_memory memory = {0};
        const pir_allocator allocator = test_allocator(&memory);
        pir_scene_options options = options_of(n + 6);
        heap_init(&h, 8000 + n, 10);
        pir_scene *good = heap_scene(&h, &options);
        options.allocator = &allocator;
        pir_scene *scene = heap_scene(&h, &options);
        for (int f = 0; f < 4; f++) {
            pir_status status = PIR_ERR_MEMORY;
            heap_move(&h);
            struct bytes before = snapshot(scene);
            for (uint64_t at = 1; status == PIR_ERR_MEMORY; at++) {
                memory.fail_at = memory.requests + at;
                status = pir_scene_update(scene, h.move, h.moves);
                memory.fail_at = 0;
                struct bytes now = snapshot(scene);
                expect(status == PIR_OK || same_bytes(&before, &now), "heap %llu, frame %d, request %llu",
                       (unsigned long long)n, f, (unsigned long long)at);
                free(now.data);
            }
            assert_int_equal(status, PIR_OK);
            free(before.data);
            assert_int_equal(pir_scene_update(good, h.move, h.moves), PIR_OK);
            expect(heap_same_events(good, scene), "heap %llu, frame %d", (unsigned long long)n, f);
        }
        pir_scene_destroy(scene);
        pir_scene_destroy(good);
        heap_finish(&h);
        assert_int_equal(memory.blocks, 0);
    }
}

/* A heap that trembles allocates nothing. */
static void a_heap_at_rest_allocates_nothing(void **state) {
    (void)state;
    static heap h;
    test_memory memory = {0};
    const pir_allocator allocator = test_allocator(&memory);
    pir_scene_options options = options_of(6);
    options.allocator = &allocator;
    heap_init(&h, 9000, 30);
    pir_scene *scene = heap_scene(&h, &options);
    pir_scene_move move[HEAP_BODIES];
    uint64_t requests = 0;
    for (int f = 0; f < 40; f++) {
        size_t moves = 0;
        for (uint32_t i = 0; i < h.count; i++)
            if (i != h.ground_at) {
                move[moves] = (pir_scene_move){i, h.body[i].options.pose};
                move[moves++].pose.translation.x += f % 2 ? 1e-4 : 0;
            }
        if (f == 8)
            requests = memory.requests;
        assert_int_equal(pir_scene_update(scene, move, moves), PIR_OK);
    }
    assert_true(memory.requests == requests);
    pir_scene_destroy(scene);
    heap_finish(&h);
}

static void reuse_that_cannot_be_is_refused(void **state) {
    (void)state;
    pir_scene *scene = NULL;
    pir_scene_options options = pir_scene_options_default();
    options.reuse = -1;
    assert_int_equal(pir_scene_create(&options, &scene), PIR_ERR_ARGUMENT);
    options.reuse = NAN;
    assert_int_equal(pir_scene_create(&options, &scene), PIR_ERR_NOT_FINITE);
    options.reuse = 0.01;
    options.detail = PIR_SCENE_DEPTHS;
    assert_int_equal(pir_scene_create(&options, &scene), PIR_ERR_ARGUMENT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(heaps_have_the_same_states),       cmocka_unit_test(threads_and_restores_give_the_same_bits),
        cmocka_unit_test(bytes_that_lie_harm_nothing),      cmocka_unit_test(memory_that_fails_changes_nothing),
        cmocka_unit_test(a_heap_at_rest_allocates_nothing), cmocka_unit_test(reuse_that_cannot_be_is_refused),
    };
    test_print_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
