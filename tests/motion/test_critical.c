/* SPDX-License-Identifier: MIT */
/*
 * Critical maps against pairs: states at random angles, at the doubles beside events, at events that are doubles, and
 * on grids where bodies touch; the states of one translation all around a turn; facets of intervals against those that
 * events count; maps from files, whole and broken. Pairs decide states in another way, and know no events.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include <pirouette/exact.h>
#include <pirouette/pirouette.h>

#include "support/bodies.h"
#include "support/memory.h"

struct world {
    test_random random;
    pir_polytope *p, *q;
    pir_vec3 axis;
    pir_quat start;
    pir_critical_map *map, *beside; /* of Q; of another obstacle, or NULL */
    pir_pair *pair, *pair_beside;
    pir_workspace *workspace;
    double size;
    bool is_grid, every_kappa; /* small integers; doubles hold the quaternion of every κ */
};

struct tally {
    uint32_t poses, beside, at_events, states[3], contacts, lasting, gaps, beside_contacts, moments;
};

/* (u, κ)·q₀: exact for small integers and short κ, for q₀ = (0, 0, 0, 1) for every κ. */
static pir_quat at_kappa(const struct world *world, double kappa) {
    const pir_vec3 u = world->axis;
    const pir_quat q = world->start;
    if (kappa == INFINITY)
        return q;
    return (pir_quat){kappa * q.x + u.x * q.w + u.y * q.z - u.z * q.y, kappa * q.y + u.y * q.w + u.z * q.x - u.x * q.z,
                      kappa * q.z + u.z * q.w + u.x * q.y - u.y * q.x, kappa * q.w - u.x * q.x - u.y * q.y - u.z * q.z};
}

static bool is_exact(const struct world *world, double kappa) {
    return world->every_kappa || kappa == INFINITY || kappa == 0 ||
           (fabs(kappa) < 0x1p+24 && ldexp(kappa, 24) == nearbyint(ldexp(kappa, 24)));
}

static void make_world(uint64_t number, struct world *world) {
    static const char *const shapes[] = {"cube", "octahedron", "icosahedron", "geodesic?level=2", "dodecahedron"};
    static const pir_vec3 axes[] = {{0, 0, 1}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {0, -2, 0}, {2, 1, -2}};
    *world = (struct world){.random = test_random_case("critical maps", number)};
    test_random *random = &world->random;
    world->is_grid = number % 3 != 2;
    for (int k = 0; k < 2; k++) {
        pir_polytope **body = k == 0 ? &world->p : &world->q;
        const uint32_t kind = test_random_below(random, 4);
        const bool flat = k == 0 && number % 7 == 0;
        do {
            if (flat)
                *body = test_random_polytope(random, TEST_POLYGON, 8);
            else if (!world->is_grid && kind < 2)
                *body = test_sphere(random, 24);
            else if (!world->is_grid)
                assert_int_equal(pir_shape_create(shapes[test_random_below(random, 5)], NULL, NULL, body), PIR_OK);
            else
                *body = test_random_polytope(random, kind == 0 ? TEST_GRID : kind == 1 ? TEST_PRISM : TEST_BOX, 10);
            if (pir_polytope_dimension(*body) < (flat ? 2 : 3)) {
                pir_polytope_release(*body);
                *body = NULL;
            }
        } while (!*body);
    }
    world->axis = axes[test_random_below(random, 6)];
    world->start = number % 4 == 3 ? (pir_quat){1, 2, -1, 3} : (pir_quat){0, 0, 0, 1};
    world->every_kappa = number % 4 != 3;
    world->size = test_size_of(world->p) + test_size_of(world->q);
    assert_int_equal(pir_critical_map_create(world->p, world->q, world->start, world->axis, NULL, &world->map), PIR_OK);
    assert_int_equal(pir_pair_create(world->p, world->q, NULL, &world->pair), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &world->workspace), PIR_OK);
}

static void free_world(struct world *world) {
    pir_critical_map_destroy(world->map);
    pir_pair_destroy(world->pair);
    pir_workspace_destroy(world->workspace);
    pir_polytope_release(world->p);
    pir_polytope_release(world->q);
}

static pir_state state_by_pair(const struct world *world, double kappa, pir_vec3 t) {
    pir_pair_input input = pir_pair_input_default();
    pir_query_result result;
    input.pose_p = (pir_pose){.translation = t, .rotation = at_kappa(world, kappa)};
    assert_int_equal(pir_pair_overlap(world->pair, world->workspace, &input, &result), PIR_OK);
    return result.state;
}

/* The state of both obstacles. */
static pir_state state_of_all(const struct world *world, double kappa, pir_vec3 t) {
    const pir_state state = state_by_pair(world, kappa, t);
    if (!world->beside)
        return state;
    struct world other = *world;
    other.pair = world->pair_beside;
    const pir_state further = state_by_pair(&other, kappa, t);
    return further > state ? further : state;
}

static double any_kappa(struct world *world) {
    static const double short_ones[] = {INFINITY, 0, 1, -1, 2, -2, 0.5, -0.5, 3, 1.5};
    if (world->is_grid && test_random_below(&world->random, 2) == 0)
        return short_ones[test_random_below(&world->random, 10)];
    const double x = test_random_unit(&world->random), y = test_random_unit(&world->random);
    return ldexp(nearbyint(ldexp(4 * x / (fabs(y) + 0x1p-8), 20)), -20);
}

/* A place near where the bodies touch at a κ: on grids often one where they do. */
static pir_vec3 any_place(struct world *world) {
    test_random *random = &world->random;
    if (world->is_grid && test_random_below(random, 2) == 0) {
        // a vertex on a vertex at the start, and at every angle where it is on the axis
        const uint32_t of_p = pir_polytope_vertex_count(world->p), of_q = pir_polytope_vertex_count(world->q);
        const pir_vec3 a = pir_polytope_vertex(world->p, test_random_below(random, of_p));
        const pir_vec3 b = pir_polytope_vertex(world->q, test_random_below(random, of_q));
        return (pir_vec3){b.x - a.x, b.y - a.y, b.z - a.z};
    }
    if (world->is_grid && test_random_below(random, 2) == 0)
        return (pir_vec3){0.5 * test_random_between(random, -14, 14), 0.5 * test_random_between(random, -14, 14),
                          0.5 * test_random_between(random, -14, 14)};
    const double by = 0.6 * world->size;
    return (pir_vec3){by * test_random_unit(random), by * test_random_unit(random), by * test_random_unit(random)};
}

static void check_state(struct world *world, uint64_t number, double kappa, pir_vec3 t, struct tally *tally) {
    pir_state state = PIR_INSIDE, same = PIR_INSIDE;
    bool is_turn = false;
    assert_int_equal(pir_critical_map_state(world->map, kappa, t, &state), PIR_OK);
    const pir_state right = state_by_pair(world, kappa, t);
    expect(state == right, "case %u, kappa %a, t %a %a %a: %d, not %d", (unsigned)number, kappa, t.x, t.y, t.z,
           (int)state, (int)right);
    pir_quat q = at_kappa(world, kappa);
    q = (pir_quat){-4 * q.x, -4 * q.y, -4 * q.z, -4 * q.w};
    assert_int_equal(pir_critical_map_state_of(world->map, q, t, &is_turn, &same), PIR_OK);
    expect(is_turn && same == right, "case %u, kappa %a by its quaternion", (unsigned)number, kappa);
    tally->states[right]++;
    tally->poses++;
}

/* Poses at random angles, and around each of some events. */
static void check_poses(struct world *world, uint64_t number, uint32_t poses, struct tally *tally) {
    const uint32_t events = pir_critical_map_event_count(world->map);
    for (uint32_t i = 0; i < poses; i++) {
        check_state(world, number, any_kappa(world), any_place(world), tally);
        if (events == 0)
            continue;
        const uint32_t event = test_random_below(&world->random, events);
        pir_critical_angle angle;
        pir_state state;
        assert_int_equal(pir_critical_map_event(world->map, event, &angle), PIR_OK);
        if (!isfinite(angle.kappa[0]) || !isfinite(angle.kappa[1]))
            continue;
        const pir_vec3 t = any_place(world);
        for (int k = 0; k < 2; k++)
            if (is_exact(world, angle.kappa[k])) {
                check_state(world, number, angle.kappa[k], t, tally);
                tally->beside++;
            }
        assert_int_equal(pir_critical_map_state_at_event(world->map, event, t, &state), PIR_OK);
        if (angle.kappa[0] == angle.kappa[1] && is_exact(world, angle.kappa[0])) {
            expect(state == state_by_pair(world, angle.kappa[0], t), "case %u, event %u", (unsigned)number,
                   (unsigned)event);
            tally->at_events++;
        }
    }
}

/* A double between two, none of which need be one; false where there is none. */
static bool between(double above, double below, double *ret) {
    const double high = fmin(above, 0x1p+40), low = fmax(below, -0x1p+40);
    *ret = nearbyint(ldexp(0.5 * low + 0.5 * high, 20)) * 0x1p-20;
    return *ret<above && * ret> below;
}

/* The state at a κ as the contacts around the turn tell it: boundary at one that may be there. */
static bool state_of(const pir_critical_states *states, double kappa, pir_state *ret_state) {
    const uint32_t count = pir_critical_states_count(states);
    uint32_t i = 0;
    for (; i < count; i++) {
        pir_critical_angle contact;
        assert_int_equal(pir_critical_states_contact(states, i, &contact), PIR_OK);
        if (contact.kappa[0] < kappa)
            break;
        if (contact.kappa[0] == kappa && contact.kappa[1] == kappa) {
            *ret_state = PIR_BOUNDARY;
            return true;
        }
    }
    assert_int_equal(pir_critical_states_after(states, i, ret_state), PIR_OK);
    return false;
}

/* The doubles beside contacts, and short angles, at which bodies of grids often touch for a moment only. */
static void check_beside_contacts(struct world *world, uint64_t number, const pir_critical_states *states, pir_vec3 t,
                                  struct tally *tally) {
    static const double short_ones[] = {0, 1, -1, 2, -2, 0.5, -0.5, 3, -3, 1.5};
    const uint32_t count = pir_critical_states_count(states);
    for (uint32_t i = 0; i < 2 * count + 10; i++) {
        double kappa = i < 10 ? short_ones[i] : 0;
        if (i >= 10) {
            pir_critical_angle contact;
            assert_int_equal(pir_critical_states_contact(states, (i - 10) / 2, &contact), PIR_OK);
            kappa = contact.kappa[i % 2];
            if (contact.kappa[0] == contact.kappa[1])
                kappa = nextafter(kappa, i % 2 == 0 ? INFINITY : -INFINITY);
        }
        if (!isfinite(kappa) || !is_exact(world, kappa))
            continue;
        pir_state state;
        const bool touches = state_of(states, kappa, &state);
        expect(state == state_of_all(world, kappa, t), "case %u, t %a %a %a beside a contact at %a: %d",
               (unsigned)number, t.x, t.y, t.z, kappa, (int)state);
        tally->beside_contacts++;
        tally->moments += touches;
    }
}

/* The sign of c0·κ² + c1·κ + c2. */
static int sign_of_polynomial(mpz_t c[3], double kappa) {
    mpq_t x, sum, part;
    mpq_inits(x, sum, part, NULL);
    mpq_set_d(x, kappa);
    mpq_set_z(sum, c[0]);
    for (int i = 1; i < 3; i++) {
        mpq_set_z(part, c[i]);
        mpq_mul(sum, sum, x);
        mpq_add(sum, sum, part);
    }
    const int sign = mpq_sgn(sum);
    mpq_clears(x, sum, part, NULL);
    return sign;
}

/* The quadratic of a contact has a root between its doubles, or at both: its sign changes, or it is zero there. */
static void check_polynomial(mpz_t c[3], const pir_critical_angle *at) {
    if (!isfinite(at->kappa[0]) || !isfinite(at->kappa[1]))
        return;
    const int low = sign_of_polynomial(c, at->kappa[0]), high = sign_of_polynomial(c, at->kappa[1]);
    if (at->kappa[0] == at->kappa[1])
        assert_int_equal(low, 0);
    else if (low * high >= 0) {
        // a double root that is no double, or two roots there: the discriminant is small
        mpz_t square, product;
        mpz_inits(square, product, NULL);
        mpz_mul(square, c[1], c[1]);
        mpz_mul(product, c[0], c[2]);
        mpz_submul_ui(square, product, 4);
        assert_true(mpz_sgn(square) >= 0 && mpz_sgn(c[0]) != 0);
        mpz_clears(square, product, NULL);
    }
}

/* The states all around, at doubles between contacts and at contacts that are doubles. */
static void check_turn(struct world *world, uint64_t number, struct tally *tally) {
    const pir_vec3 t = any_place(world);
    pir_critical_states *states;
    const pir_critical_map *const maps[2] = {world->map, world->beside};
    assert_int_equal(pir_critical_states_create(maps, world->beside ? 2 : 1, t, NULL, &states), PIR_OK);
    const uint32_t count = pir_critical_states_count(states);
    double above = INFINITY;
    pir_state before = PIR_OUTSIDE;
    mpz_t c[3];
    mpz_inits(c[0], c[1], c[2], NULL);
    expect(pir_critical_states_at_start(states) == state_of_all(world, INFINITY, t), "case %u, start",
           (unsigned)number);
    for (uint32_t i = 0; i <= count; i++) {
        pir_critical_angle contact = {.kappa = {-INFINITY, -INFINITY}};
        pir_state state;
        double kappa;
        assert_int_equal(pir_critical_states_after(states, i, &state), PIR_OK);
        if (i < count) {
            assert_int_equal(pir_critical_states_contact(states, i, &contact), PIR_OK);
            assert_int_equal(pir_critical_states_polynomial_exact(states, i, c), PIR_OK);
            check_polynomial(c, &contact);
        }
        assert_true(contact.kappa[0] <= contact.kappa[1] && contact.kappa[1] <= above);
        if (between(above, contact.kappa[1], &kappa) && is_exact(world, kappa)) {
            expect(state == state_of_all(world, kappa, t), "case %u, t %a %a %a, stretch %u at %a: %d",
                   (unsigned)number, t.x, t.y, t.z, (unsigned)i, kappa, (int)state);
            tally->gaps++;
            tally->lasting += state == PIR_BOUNDARY;
        }
        // contacts within a stretch of contact are none
        expect(i == 0 || state != PIR_BOUNDARY || before != PIR_BOUNDARY, "case %u, stretch %u", (unsigned)number,
               (unsigned)i);
        before = state;
        if (i < count && contact.kappa[0] == contact.kappa[1] && is_exact(world, contact.kappa[0])) {
            assert_int_equal(state_of_all(world, contact.kappa[0], t), PIR_BOUNDARY);
        }
        above = contact.kappa[0];
    }
    // no state but that of the stretch is found at random angles
    for (uint32_t k = 0; k < 8; k++) {
        const double kappa = any_kappa(world);
        uint32_t i = 0;
        pir_critical_angle contact = {.kappa = {INFINITY, INFINITY}};
        while (i < count && pir_critical_states_contact(states, i, &contact) == PIR_OK && contact.kappa[0] > kappa)
            i++;
        pir_state state;
        assert_int_equal(pir_critical_states_after(states, i, &state), PIR_OK);
        if (kappa != INFINITY && (i == count || contact.kappa[1] < kappa))
            expect(state == state_of_all(world, kappa, t), "case %u, t %a %a %a at %a: not %d", (unsigned)number, t.x,
                   t.y, t.z, kappa, (int)state);
    }
    check_beside_contacts(world, number, states, t, tally);
    mpz_clears(c[0], c[1], c[2], NULL);
    tally->contacts += count;
    pir_critical_states_destroy(states);
}

static void every_pose_has_its_state(void **state) {
    (void)state;
    const char *told = getenv("PIR_TEST_POSES");
    const uint32_t most = told ? (uint32_t)strtoul(told, NULL, 10) : 30000;
    struct tally tally = {0};
    for (uint64_t number = 0; tally.poses < most; number++) {
        struct world world;
        make_world(number, &world);
        check_poses(&world, number, 60, &tally);
        for (int i = 0; i < 10; i++)
            check_turn(&world, number, &tally);
        free_world(&world);
    }
    printf("# %u poses: %u outside, %u on the boundary, %u inside; %u beside events, %u at events\n", tally.poses,
           tally.states[0], tally.states[1], tally.states[2], tally.beside, tally.at_events);
    printf("# %u contacts, %u stretches, of which %u in contact\n", tally.contacts, tally.gaps, tally.lasting);
    printf("# %u states beside contacts or at short angles, %u at contacts\n", tally.beside_contacts, tally.moments);
    assert_true(tally.states[0] > most / 20 && tally.states[1] > most / 40 && tally.states[2] > most / 20);
    assert_true(tally.beside > most / 10 && tally.at_events > most / 100 && tally.lasting > 0);
}

static void check_same_polynomial(pir_events *events, const pir_critical_map *map, uint32_t event) {
    mpz_t c[3], other[3];
    mpz_inits(c[0], c[1], c[2], other[0], other[1], other[2], NULL);
    assert_int_equal(pir_events_polynomial_exact(events, c), PIR_OK);
    assert_int_equal(pir_critical_map_polynomial_exact(map, event, other), PIR_OK);
    for (int k = 0; k < 3; k++)
        assert_int_equal(mpz_cmp(c[k], other[k]), 0);
    mpz_clears(c[0], c[1], c[2], other[0], other[1], other[2], NULL);
}

/* Two obstacles: one beside the other, or across it. */
static void several_obstacles_have_one_answer(void **state) {
    (void)state;
    struct tally tally = {0};
    for (uint64_t number = 0; number < 150; number++) {
        struct world world, other;
        make_world(number, &world);
        make_world(number + 3000, &other);
        assert_int_equal(pir_critical_map_create(world.p, other.q, world.start, world.axis, NULL, &world.beside),
                         PIR_OK);
        assert_int_equal(pir_pair_create(world.p, other.q, NULL, &world.pair_beside), PIR_OK);
        for (int i = 0; i < 20; i++)
            check_turn(&world, number, &tally);
        pir_critical_map_destroy(world.beside);
        pir_pair_destroy(world.pair_beside);
        free_world(&world);
        free_world(&other);
    }
    printf("# two obstacles: %u contacts, %u stretches, of which %u in contact, %u states beside contacts\n",
           tally.contacts, tally.gaps, tally.lasting, tally.beside_contacts);
    assert_true(tally.contacts > 300 && tally.lasting > 10);
}

/* The facets of an interval are as many as events count, and places are where κ is. */
static void intervals_have_the_facets_of_events(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 24; number++) {
        struct world world;
        make_world(number, &world);
        pir_events_options options = pir_events_options_default();
        options.difference = true;
        pir_events *events;
        assert_int_equal(pir_events_create(world.p, world.q, world.start, world.axis, &options, &events), PIR_OK);
        const uint32_t count = pir_critical_map_event_count(world.map);
        for (uint32_t i = 0; i <= count; i++) {
            uint32_t facets, again;
            double kappa, degrees[2];
            pir_critical_place place;
            pir_critical_angle angle;
            pir_event event;
            bool found;
            assert_int_equal(pir_critical_map_facets(world.map, i, NULL, &facets), PIR_OK);
            assert_int_equal(facets, pir_events_facet_count(events));
            pir_witness *faces = calloc(facets, sizeof *faces);
            assert_int_equal(pir_critical_map_facets(world.map, i, faces, &again), PIR_OK);
            assert_int_equal(again, facets);
            free(faces);
            if (pir_events_between(events, &kappa) == PIR_OK) {
                assert_int_equal(pir_critical_map_locate(world.map, kappa, &place), PIR_OK);
                assert_true(place.interval == i && !place.at_event);
            }
            assert_int_equal(pir_events_next(events, &event, &found), PIR_OK);
            assert_int_equal(found, i < count);
            if (!found)
                break;
            pir_events_angle(events, degrees);
            assert_int_equal(pir_critical_map_event(world.map, i, &angle), PIR_OK);
            assert_true(angle.degrees[0] == degrees[0] && angle.degrees[1] == degrees[1]);
            check_same_polynomial(events, world.map, i);
            if (angle.kappa[0] == angle.kappa[1] && isfinite(angle.kappa[0])) {
                assert_int_equal(pir_critical_map_locate(world.map, angle.kappa[0], &place), PIR_OK);
                assert_true(place.interval == i + 1 && place.at_event);
            }
        }
        pir_events_destroy(events);
        free_world(&world);
    }
}

static void rotations_beside_the_axis_are_none(void **state) {
    (void)state;
    struct world world;
    make_world(0, &world);
    pir_critical_map *map = NULL;
    pir_critical_place place = {UINT32_MAX, true};
    bool is_turn = true;
    const pir_vec3 axis = {0, 0, 1};
    const pir_quat start = {0, 0, 0, 1};
    assert_int_equal(pir_critical_map_create(world.p, world.q, start, axis, NULL, &map), PIR_OK);
    assert_int_equal(pir_critical_map_locate_rotation(map, (pir_quat){0, 0x1p-1000, 1, 1}, &is_turn, &place), PIR_OK);
    assert_true(!is_turn && place.interval == UINT32_MAX);
    assert_int_equal(pir_critical_map_locate_rotation(map, (pir_quat){0, 0, 0.1, 0x1p-1000}, &is_turn, &place), PIR_OK);
    assert_true(is_turn && place.interval != UINT32_MAX);
    assert_int_equal(pir_critical_map_locate_rotation(map, (pir_quat){0, 0, 0, -3}, &is_turn, &place), PIR_OK);
    assert_true(is_turn && place.interval == 0 && !place.at_event);
    assert_int_equal(pir_critical_map_locate_rotation(map, (pir_quat){0, 0, 0, 0}, &is_turn, &place),
                     PIR_ERR_ZERO_QUATERNION);
    assert_int_equal(pir_critical_map_locate(map, NAN, &place), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_critical_map_locate(map, -INFINITY, &place), PIR_ERR_NOT_FINITE);
    assert_true(pir_critical_map_turn(map).p == world.p && pir_critical_map_turn(map).q == world.q);
    pir_critical_map_destroy(map);
    // hard axes
    const pir_vec3 hard[] = {{0x1p+500, 0, 0}, {0x1p-1000, 0x1p-1000, 0}, {3, 0x1p-500, 0}};
    for (size_t i = 0; i < sizeof hard / sizeof *hard; i++) {
        assert_int_equal(pir_critical_map_create(world.p, world.q, start, hard[i], NULL, &map), PIR_OK);
        for (int k = 0; k < 40; k++) {
            const double kappa = ldexp(test_random_unit(&world.random), test_random_between(&world.random, -900, 900));
            const pir_vec3 t = any_place(&world);
            struct world other = world;
            other.axis = hard[i];
            pir_state told;
            assert_int_equal(pir_critical_map_state(map, kappa, t, &told), PIR_OK);
            assert_int_equal(told, state_by_pair(&other, kappa, t));
        }
        pir_critical_map_destroy(map);
    }
    free_world(&world);
}

static void bad_input_is_refused(void **state) {
    (void)state;
    struct world world;
    make_world(1, &world);
    pir_critical_map *map = NULL;
    pir_critical_angle angle;
    pir_critical_states *states = NULL;
    pir_state told;
    uint32_t count;
    const pir_quat start = {0, 0, 0, 1};
    const pir_vec3 axis = {0, 0, 1}, bad = {NAN, 0, 0};
    const pir_vec3 flat[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    pir_polytope *polygon = test_hull(flat, 3), *segment = test_hull(flat, 2);
    assert_int_equal(pir_critical_map_create(NULL, world.q, start, axis, NULL, &map), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_critical_map_create(polygon, polygon, start, axis, NULL, &map), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_critical_map_create(segment, world.q, start, axis, NULL, &map), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_critical_map_create(world.p, world.q, start, bad, NULL, &map), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_critical_map_create(world.p, world.q, start, flat[0], NULL, &map), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_critical_map_create(world.p, world.q, (pir_quat){0, 0, 0, 0}, axis, NULL, &map),
                     PIR_ERR_ZERO_QUATERNION);
    assert_null(map);
    const uint32_t events = pir_critical_map_event_count(world.map);
    assert_int_equal(pir_critical_map_event(world.map, events, &angle), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_critical_map_facets(world.map, events + 1, NULL, &count), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_critical_map_state(world.map, 1, bad, &told), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_critical_map_state_at_event(world.map, events, axis, &told), PIR_ERR_ARGUMENT);
    const pir_critical_map *maps[2] = {world.map, NULL};
    assert_int_equal(pir_critical_states_create(maps, 1, bad, NULL, &states), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_critical_states_create(maps, 0, axis, NULL, &states), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_critical_states_create(maps, 2, axis, NULL, &states), PIR_ERR_ARGUMENT);
    const pir_vec3 other = {world.axis.x, world.axis.y, world.axis.z + 1};
    assert_int_equal(pir_critical_map_create(world.p, world.q, world.start, other, NULL, &map), PIR_OK);
    maps[1] = map;
    assert_int_equal(pir_critical_states_create(maps, 2, axis, NULL, &states), PIR_ERR_ARGUMENT);
    pir_critical_map_destroy(map);
    assert_int_equal(pir_critical_states_create(maps, 1, axis, NULL, &states), PIR_OK);
    count = pir_critical_states_count(states);
    assert_int_equal(pir_critical_states_contact(states, count, &angle), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_critical_states_after(states, count + 1, &told), PIR_ERR_ARGUMENT);
    pir_critical_states_destroy(states);
    pir_polytope_release(polygon);
    pir_polytope_release(segment);
    free_world(&world);
}

/* Writes a map, changes a byte unless `at` is 0, and reads it; what comes of that. */
static pir_status through_a_file(const pir_critical_map *map, size_t at, size_t cut, pir_critical_map **ret_map) {
    FILE *file = tmpfile();
    pir_report report = {0};
    assert_non_null(file);
    assert_int_equal(pir_critical_map_write(map, file, &report), PIR_OK);
    const long size = ftell(file);
    if (at > 0) {
        fseek(file, (long)(at % (size_t)size), SEEK_SET);
        const int byte = fgetc(file);
        fseek(file, (long)(at % (size_t)size), SEEK_SET);
        fputc(byte ^ 5, file);
    }
    if (cut > 0) {
        char *bytes = malloc((size_t)size);
        rewind(file);
        assert_int_equal(fread(bytes, 1, (size_t)size, file), size);
        fclose(file);
        file = tmpfile();
        const size_t left = cut % (size_t)size;
        assert_int_equal(fwrite(bytes, 1, left, file), left);
        free(bytes);
    }
    rewind(file);
    const pir_status status = pir_critical_map_read(file, NULL, &report, ret_map);
    if (status == PIR_OK) {
        pir_critical_map *none = NULL;
        assert_int_equal(pir_critical_map_read(file, NULL, &report, &none), PIR_ERR_EMPTY);
    }
    fclose(file);
    return status;
}

static void files_hold_the_map(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 12; number++) {
        struct world world;
        struct tally tally = {0};
        pir_critical_map *again = NULL, *none = NULL;
        make_world(number, &world);
        assert_int_equal(through_a_file(world.map, 0, 0, &again), PIR_OK);
        assert_int_equal(pir_critical_map_event_count(again), pir_critical_map_event_count(world.map));
        for (int k = 0; k < 6; k++) {
            const size_t at = 1 + test_random_below(&world.random, 1u << 30);
            assert_int_not_equal(through_a_file(world.map, k % 2 == 0 ? at : 0, k % 2 == 0 ? 0 : at, &none), PIR_OK);
        }
        assert_null(none);
        pir_critical_map_destroy(world.map);
        world.map = again;
        check_poses(&world, number, 20, &tally);
        check_turn(&world, number, &tally);
        free_world(&world);
    }
}

/* Where memory runs out at any request, nothing is left, and the next try is as if nothing had been. */
static void memory_may_run_out(void **state) {
    (void)state;
    struct world world;
    make_world(4, &world);
    uint64_t requests = UINT64_MAX;
    for (uint64_t at = 0; at <= requests; at++) {
        test_memory memory = {.fail_at = at};
        const pir_allocator allocator = test_allocator(&memory);
        pir_critical_map *map = NULL;
        pir_critical_states *states = NULL;
        pir_status status = pir_critical_map_create(world.p, world.q, world.start, world.axis, &allocator, &map);
        assert_true(status == PIR_OK || status == PIR_ERR_MEMORY);
        if (status == PIR_OK)
            status = pir_critical_states_create((const pir_critical_map *const[]){map, map}, 2, (pir_vec3){0.5, 0, 0.5},
                                                &allocator, &states);
        assert_true(status == PIR_OK || (status == PIR_ERR_MEMORY && !states));
        assert_true((at == 0) == (status == PIR_OK));
        if (at == 0)
            requests = memory.requests;
        pir_critical_states_destroy(states);
        pir_critical_map_destroy(map);
        assert_true(memory.blocks == 0 && memory.bytes == 0 && !memory.wrong_size);
    }
    free_world(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pose_has_its_state),
        cmocka_unit_test(several_obstacles_have_one_answer),
        cmocka_unit_test(intervals_have_the_facets_of_events),
        cmocka_unit_test(rotations_beside_the_axis_are_none),
        cmocka_unit_test(bad_input_is_refused),
        cmocka_unit_test(files_hold_the_map),
        cmocka_unit_test(memory_may_run_out),
    };
    test_print_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
