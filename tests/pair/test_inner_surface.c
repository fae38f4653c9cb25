/* SPDX-License-Identifier: MIT */
/*
 * Surfaces inside a difference: they stay closed about their centre as corners come and go, and every version of their
 * loops gives the same bits.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/processor.h"
#include "pair/surface/inner_surface.h"
#include "support/bodies.h"

/* What is noted of sides is what the triangles tell. */
static void check_sides(const pir_surface *surface, const pir_surface_room *room) {
    for (uint32_t t = 0; t < surface->count; t++)
        for (int k = 0; k < 3; k++)
            expect(room->triangle[surface->corner[k][t]][surface->corner[(k + 1) % 3][t]] == t, "side %d of %u", k, t);
}

static void a_surface_stays_closed_as_vertices_are_added(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 40; i++) {
        test_random random = test_random_case("surfaces", i);
        pir_surface surface;
        pir_surface_begin(&surface, (const uint32_t[4]){0, 1, 2, 3}, (const uint32_t[4]){0, 0, 0, 0});
        assert_true(pir_surface_is_valid(&surface));
        // points of a sphere about the centre, as vertices of Q with P a point
        pir_vec3 vertex[40] = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}}, zero = {0, 0, 0};
        pir_vec3 of_q[2] = {{0}}; // one more: loops read past the last
        pir_frame frame = {.r = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
        frame.q.vertex = of_q;
        frame.p.vertex = vertex;
        for (int k = 4; k < 40; k++) {
            pir_vec3 d = test_random_direction(&random);
            vertex[k] = (pir_vec3){2 * d.x, 2 * d.y, 2 * d.z};
        }
        pir_surface_room room = {.loops = pir_processor_best()->surface};
        uint32_t added = 0;
        bool certain = pir_surface_place(&surface, &frame, zero, 0x1p-46, 4, &room);
        if (!certain) {
            pir_surface_begin(&surface, (const uint32_t[4]){1, 0, 2, 3}, (const uint32_t[4]){0, 0, 0, 0});
            certain = pir_surface_place(&surface, &frame, zero, 0x1p-46, 4, &room);
        }
        assert_true(certain);
        for (uint32_t k = 4; k < 40; k++) {
            uint32_t t = 0;
            double most = -HUGE_VAL;
            for (uint32_t each = 0; each < surface.count; each++) {
                double over = room.plane.nx[each] * vertex[k].x + room.plane.ny[each] * vertex[k].y +
                              room.plane.nz[each] * vertex[k].z - room.plane.det[each];
                if (over > most)
                    most = over, t = each;
            }
            const pir_surface_vertex next = {k, 0, vertex[k]};
            added += pir_surface_add(&surface, t, &next, &room) < PIR_SURFACE_CORNERS;
            expect(pir_surface_is_valid(&surface), "case %llu, vertex %u", (unsigned long long)i, k);
            check_sides(&surface, &room);
            for (uint32_t s = 0; s < surface.count; s++)
                expect(room.plane.low[s] > 0, "case %llu, vertex %u: triangle %u", (unsigned long long)i, k, s);
        }
        // what is on a sphere is beyond every surface within, as long as there is room
        assert_true(added >= PIR_SURFACE_CORNERS - 4);
    }
}

/* A surface around the origin whose corners are random points, and a room where it is placed. */
static void make_surface(test_random *random, pir_surface *surface, pir_vec3 vertex[40], pir_frame *frame,
                         pir_surface_room *room) {
    static pir_vec3 of_q[2]; // one more: loops read past the last
    const pir_vec3 zero = {0, 0, 0};
    *frame = (pir_frame){.r = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    frame->q.vertex = of_q;
    frame->p.vertex = vertex;
    const pir_vec3 first[4] = {{1, 1, 1}, {-1, -1, 1}, {1, -1, -1}, {-1, 1, -1}};
    for (int k = 0; k < 40; k++) {
        pir_vec3 d = test_random_direction(random);
        vertex[k] = k < 4 ? first[k] : (pir_vec3){2 * d.x, 2 * d.y, 2 * d.z};
    }
    pir_surface_begin(surface, (const uint32_t[4]){0, 1, 2, 3}, (const uint32_t[4]){0, 0, 0, 0});
    assert_true(pir_surface_place(surface, frame, zero, 0x1p-46, 4, room));
    uint32_t corners = (uint32_t)test_random_between(random, 5, 40);
    for (uint32_t k = 4; k < corners && pir_surface_has_room(surface); k++)
        for (uint32_t t = 0; t < surface->count; t++) {
            const pir_surface_vertex next = {k, 0, vertex[k]};
            if (pir_vec_dot(pir_surface_normal(room, t), vertex[k]) > room->plane.det[t]) {
                pir_surface_add(surface, t, &next, room);
                break;
            }
        }
}

static void every_version_of_the_loops_gives_the_bits_of_the_plain_one(void **state) {
    (void)state;
    if (!pir_processor_version(1))
        print_message("this processor runs the plain version only\n");
    for (uint64_t i = 0; i < 60; i++) {
        test_random random = test_random_case("surface loops", i);
        pir_vec3 vertex[40];
        pir_frame frame;
        pir_surface surface;
        static pir_surface_room plain, room;
        memset(&surface, 0, sizeof surface);
        plain.loops = pir_processor_version(0)->surface;
        make_surface(&random, &surface, vertex, &frame, &plain);
        pir_quat q = test_general_rotation(&random);
        double n = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, w = q.w, x = q.x, y = q.y, z = q.z;
        frame.r = (pir_mat3){{{(w * w + x * x - y * y - z * z) / n, 2 * (x * y - w * z) / n, 2 * (x * z + w * y) / n},
                              {2 * (x * y + w * z) / n, (w * w - x * x + y * y - z * z) / n, 2 * (y * z - w * x) / n},
                              {2 * (x * z - w * y) / n, 2 * (y * z + w * x) / n, (w * w - x * x - y * y + z * z) / n}}};
        pir_vec3 centre = test_random_direction(&random);
        bool certain = pir_surface_place(&surface, &frame, centre, 0x1p-46, 4, &plain);
        for (unsigned version = 1; pir_processor_version(version); version++) {
            room.loops = pir_processor_version(version)->surface;
            assert_int_equal(pir_surface_place(&surface, &frame, centre, 0x1p-46, 4, &room), certain);
            double least = room.loops->least(&surface, &room, UINT64_MAX),
                   limits[3] = {least, 0, plain.plane.low[surface.count / 2]};
            assert_memory_equal(room.plane.nx, plain.plane.nx, surface.count * sizeof *room.plane.nx);
            assert_memory_equal(room.plane.ny, plain.plane.ny, surface.count * sizeof *room.plane.ny);
            assert_memory_equal(room.plane.nz, plain.plane.nz, surface.count * sizeof *room.plane.nz);
            assert_memory_equal(room.plane.det, plain.plane.det, surface.count * sizeof *room.plane.det);
            assert_memory_equal(room.plane.low, plain.plane.low, surface.count * sizeof *room.plane.low);
            assert_true(least == plain.loops->least(&surface, &plain, UINT64_MAX));
            for (int k = 0; k < 3; k++)
                assert_true(room.loops->below(&surface, &room, limits[k]) ==
                            plain.loops->below(&surface, &plain, limits[k]));
            for (uint32_t v = 0; v < 40; v++)
                assert_true(room.loops->seen(&surface, &room, vertex[v]) ==
                            plain.loops->seen(&surface, &plain, vertex[v]));
            for (uint32_t c = 0; c < PIR_SURFACE_CORNERS; c++) {
                assert_true(room.loops->about(&surface, c) == plain.loops->about(&surface, c));
                uint32_t other = surface.a[test_random_below(&random, PIR_SURFACE_CORNERS)];
                assert_true(room.loops->either(surface.a, surface.a[c], other) ==
                            plain.loops->either(surface.a, surface.a[c], other));
            }
            assert_true(room.loops->either(surface.a, 40, 41) == 0);
            for (int k = 0; k < 40; k++) {
                uint32_t corners = (uint32_t)test_random_bits(&random) | (uint32_t)test_random_bits(&random);
                uint64_t within = room.loops->within(&surface, corners);
                assert_true(within == plain.loops->within(&surface, corners));
                assert_true(room.loops->least(&surface, &room, within) == plain.loops->least(&surface, &plain, within));
            }
        }
    }
}

struct made {
    pir_vec3 vertex[40];
    pir_frame frame;
    pir_surface surface;
    pir_surface_room room;
};

static struct made *make_with_best_loops(test_random *random) {
    static struct made made;
    made.room.loops = pir_processor_best()->surface;
    make_surface(random, &made.surface, made.vertex, &made.frame, &made.room);
    return &made;
}

static void a_trimmed_surface_is_closed_about_its_centre(void **state) {
    (void)state;
    uint32_t taken = 0;
    for (uint64_t i = 0; i < 60; i++) {
        test_random random = test_random_case("trimmed surfaces", i);
        struct made *made = make_with_best_loops(&random);
        pir_surface *surface = &made->surface;
        pir_surface_room *room = &made->room;
        uint32_t before = (uint32_t)__builtin_popcount(surface->used);
        bool done = pir_surface_trim(surface, room);
        uint32_t after = (uint32_t)__builtin_popcount(surface->used);
        expect(done == (after < before) && pir_surface_is_valid(surface), "case %llu: %u corners, then %u",
               (unsigned long long)i, before, after);
        check_sides(surface, room);
        taken += before - after;
        for (uint32_t t = 0; t < surface->count; t++)
            expect(room->plane.low[t] > 0, "case %llu: triangle %u", (unsigned long long)i, t);
        // placed anew it is the same
        assert_true(pir_surface_place(surface, &made->frame, (pir_vec3){0, 0, 0}, 0x1p-46, 4, room));
    }
    assert_true(taken > 200);
}

/* Six times what a surface encloses. */
static double volume_of(const pir_surface *surface, const pir_surface_room *room) {
    double volume = 0;
    for (uint32_t t = 0; t < surface->count; t++)
        volume += room->plane.det[t];
    return volume;
}

static void a_dented_surface_grows_as_its_sides_are_turned(void **state) {
    (void)state;
    uint32_t turned = 0, lost = 0;
    for (uint64_t i = 0; i < 60; i++) {
        test_random random = test_random_case("dented surfaces", i);
        struct made *made = make_with_best_loops(&random);
        pir_surface *surface = &made->surface;
        pir_surface_room *room = &made->room;
        // along its own ray a corner may be anywhere
        for (uint32_t k = 0; k < 40; k++) {
            double by = (double)test_random_between(&random, 20, 100) / 100;
            made->vertex[k] = (pir_vec3){made->vertex[k].x * by, made->vertex[k].y * by, made->vertex[k].z * by};
        }
        assert_true(pir_surface_place(surface, &made->frame, (pir_vec3){0, 0, 0}, 0x1p-46, 4, room));
        double volume = volume_of(surface, room);
        uint32_t used = surface->used;
        for (uint32_t t = 0; t < surface->count; t++)
            for (int times = 0; t < surface->count && pir_surface_turn(surface, t, room); times++) {
                double grown = volume_of(surface, room);
                expect(grown > volume && times < 100, "case %llu, triangle %u: %a, then %a", (unsigned long long)i, t,
                       volume, grown);
                assert_true(pir_surface_is_valid(surface));
                check_sides(surface, room);
                volume = grown;
                turned++;
            }
        for (uint32_t t = 0; t < surface->count; t++)
            expect(room->plane.low[t] > 0, "case %llu: triangle %u", (unsigned long long)i, t);
        lost += (uint32_t)__builtin_popcount(used & ~surface->used);
        assert_true((surface->used & ~used) == 0);
    }
    assert_true(turned > 300 && lost > 50);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_surface_stays_closed_as_vertices_are_added),
        cmocka_unit_test(every_version_of_the_loops_gives_the_bits_of_the_plain_one),
        cmocka_unit_test(a_trimmed_surface_is_closed_about_its_centre),
        cmocka_unit_test(a_dented_surface_grows_as_its_sides_are_turned),
    };
    return cmocka_run_group_tests_name("inner surfaces", tests, NULL, NULL);
}
