/* SPDX-License-Identifier: MIT */
/* Contact manifolds that went wrong once, flat bodies, margins, and what is refused. */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/shape.h>

#include "query/contact_scene.h"
#include "query/polygons.h"
#include "support/random.h"
#include "support/vectors.h"

static const pir_quat still = {0, 0, 0, 1};

static pir_polytope *shape(const char *name) {
    pir_polytope *p;
    assert_int_equal(pir_shape_create(name, NULL, NULL, &p), PIR_OK);
    return p;
}

/* A slab of 20 by 20 whose top is at height 0. */
static pir_polytope *slab(void) {
    return shape("box?x=20&y=20&z=2");
}

static double least_distance(const contact_scene *scene) {
    double least = HUGE_VAL;
    for (size_t i = 0; i < scene->count; i++)
        least = fmin(least, scene->contact[i].distance);
    return least;
}

/* Its 12 pentagons are 30 facets; one of them, turned down, lies 0.016 deep in a slab. */
static void a_dodecahedron_with_vertices_moved_by_an_ulp_has_its_deepest_point(void **state) {
    (void)state;
    pir_polytope *clean = shape("dodecahedron");
    pir_vec3 at[20], n = pir_polytope_normal(clean, 0);
    for (uint32_t v = 0; v < 20; v++) {
        at[v] = pir_polytope_vertex(clean, v);
        at[v].x += v % 3 == 0 ? 2e-16 : v % 3 == 1 ? -2e-16 : 0;
        at[v].y += v % 2 ? 2e-16 : 0;
        at[v].z -= v % 5 == 0 ? 2e-16 : 0;
    }
    uint32_t corner[5];
    pir_polytope_facet(clean, 0, corner);
    double inner = test_dot(n, pir_polytope_vertex(clean, corner[0]));
    pir_polytope_release(clean);
    // normal n to −z
    pir_quat down = {-n.y, n.x, 0, 1 - n.z};
    contact_scene scene = contact_scene_make(contact_scene_baked(at, 20, still), slab(), down);
    assert_true(pir_polytope_facet_count(scene.p) > 20);
    for (int tilted = 0; tilted < 2; tilted++) {
        if (tilted)
            scene.r.x += 1e-7;
        assert_int_equal(pir_sum_rotate(scene.sum, scene.r, PIR_METHOD_AUTO), PIR_OK);
        scene.t = (pir_vec3){0.1, 0.2, 1 + inner - 0.016};
        contact_scene_check(&scene, "dodecahedron", (uint64_t)tilted);
        assert_int_equal(contact_scene_corners(&scene), 5);
        assert_true(fabs(scene.answer.distance + 0.016) < 1e-6);
        for (size_t i = 0; i < scene.count; i++)
            assert_true(fabs(scene.contact[i].distance + 0.016) < 1e-6);
    }
    contact_scene_clear(&scene);
}

/* Poses in which the contacts of such bodies missed the answer's depth: shallow, level but for a little. */
static void expect_deepest(const char *name, double half) {
    for (uint64_t i = 0; i < 300; i++) {
        test_random random = test_random_case("contacts, rotated", i);
        pir_polytope *clean = shape(name);
        pir_vec3 at[SCENE_CONTACTS], axis = test_random_direction(&random);
        uint32_t count = pir_polytope_vertex_count(clean);
        for (uint32_t v = 0; v < count; v++)
            at[v] = pir_polytope_vertex(clean, v);
        pir_polytope_release(clean);
        double angle = 3 * test_random_unit(&random), s = sin(angle / 2),
               tilt = ldexp(test_random_unit(&random), -10 - (int)(i % 40));
        pir_quat baked = {s * axis.x, s * axis.y, s * axis.z, cos(angle / 2)};
        pir_quat back = {-baked.x + tilt, -baked.y, -baked.z, baked.w};
        contact_scene scene = contact_scene_make(contact_scene_baked(at, count, baked), slab(), back);
        scene.t =
            (pir_vec3){test_random_unit(&random), test_random_unit(&random), 1 + half - ldexp(1, -5 - (int)(i % 20))};
        contact_scene_check(&scene, name, i);
        assert_true(scene.answer.outcome == PIR_OVERLAPPING);
        expect(least_distance(&scene) >= scene.answer.distance - 1e-14,
               "%s, case %d: deepest at %.17g, the answer at %.17g", name, (int)i, least_distance(&scene),
               scene.answer.distance);
        contact_scene_clear(&scene);
    }
}

static void cubes_rotated_in_double_have_their_deepest_point(void **state) {
    (void)state;
    expect_deepest("cube", 0.5);
}

static void cylinders_rotated_in_double_have_their_deepest_point(void **state) {
    (void)state;
    expect_deepest("cylinder?sides=32&radius=0.5&height=1", 0.5);
}

/* A cube with each corner six times, for two triangles on each of its sides, ulps apart. */
static pir_polytope *clusters(test_random *random) {
    pir_vec3 at[48];
    for (int i = 0; i < 48; i++) {
        int c = i / 6;
        pir_vec3 tiny = test_random_direction(random);
        at[i] = test_add((pir_vec3){c & 1 ? 0.5 : -0.5, c & 2 ? 0.5 : -0.5, c & 4 ? 0.5 : -0.5}, tiny, 2e-15);
    }
    return contact_scene_baked(at, 48, still);
}

/* Which of a corner's vertices a facet ends at is chance. */
static void corners_given_once_a_triangle_are_one_patch(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 200; number++) {
        test_random random = test_random_case("contacts, clusters", number);
        pir_polytope *p = clusters(&random), *q = clusters(&random);
        contact_scene scene = contact_scene_make(p, q, (pir_quat){1e-17, 0, 0, 1});
        scene.t = (pir_vec3){0.3, 0.1, number % 2 ? 0.99 : number % 4 ? 1 + 1e-13 : 1.01};
        contact_scene_check(&scene, "clusters", number);
        expect(contact_scene_corners(&scene) == 4, "case %d: %zu corners", (int)number, contact_scene_corners(&scene));
        contact_scene_clear(&scene);
    }
}

/* The area of the corners of the last manifold, seen along z. */
static double area_of(const contact_scene *scene) {
    polygon flat = {.count = contact_scene_corners(scene)};
    for (size_t i = 0; i < flat.count; i++) {
        const pir_contact *corner = &scene->contact[scene->count - flat.count + i];
        flat.at[i] = (polygon_point){corner->point_q.x, corner->point_q.y};
    }
    return polygon_area(&flat);
}

/* A cube with more points on its edges and faces, turned and rounded to doubles or to floats. */
static pir_polytope *grid(pir_quat turned, bool single) {
    pir_vec3 at[64];
    for (int i = 0; i < 64; i++) {
        pir_vec3 x = {(i % 4) / 3.0 - 0.5, (i / 4 % 4) / 3.0 - 0.5, (i / 16) / 3.0 - 0.5};
        x = test_turn(turned, x, 1);
        at[i] = single ? (pir_vec3){(float)x.x, (float)x.y, (float)x.z} : x;
    }
    return contact_scene_baked(at, 64, still);
}

/*
 * Rounding leaves slivers along the edges of such a cube, with normals anywhere between its faces'. On a face, on an
 * edge or on a corner, its patch is the whole of the face that faces down most: as large as that is from below.
 */
static void faces_of_rounded_grids_are_whole(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 300; number++) {
        test_random random = test_random_case("contacts, grids", number);
        bool single = number % 2;
        pir_vec3 axis = test_random_direction(&random);
        pir_quat b = {axis.x, axis.y, axis.z, test_random_unit(&random)};
        // tilted by little, about an edge, or anyhow
        double tilt = number % 3 == 0 ? 1e-5 : 0.3, x = tilt * test_random_unit(&random);
        double y = number % 3 == 1 ? 1e-9 : tilt * test_random_unit(&random);
        pir_quat pose = {x, y, 0, 1};
        // the pose after the inverse of b
        pir_quat r = {x * b.w - b.x - y * b.z, y * b.w - b.y + x * b.z, -b.z - x * b.y + y * b.x,
                      b.w + x * b.x + y * b.y};
        double down = test_turn(pose, (pir_vec3){0, 0, 1}, 1).z;
        contact_scene scene = contact_scene_make(grid(b, single), slab(), r);
        scene.t = (pir_vec3){0.1, 0.2, 1.5};
        scene.margin = 2;
        contact_scene_check(&scene, "grids", number);
        expect(fabs(area_of(&scene) - down) < (single ? 1e-5 : 1e-9), "case %d: %.12g for %.12g", (int)number,
               area_of(&scene), down);
        contact_scene_clear(&scene);
    }
}

/* Two such cubes, edge to edge along edges that are parallel but for rounding. */
static void edges_of_rounded_grids_share_a_segment(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 100; number++) {
        test_random random = test_random_case("contacts, edges of grids", number);
        double eighth = atan(1) / 2, s = sin(eighth), tiny = number % 2 ? 3e-8 : 1e-15;
        contact_scene scene = contact_scene_make(grid((pir_quat){s, 0, 0, cos(eighth)}, number % 2),
                                                 grid((pir_quat){-s, 0, 0, cos(eighth)}, number % 2),
                                                 (pir_quat){0, 0, tiny * test_random_unit(&random), 1});
        scene.t = (pir_vec3){0.4 * test_random_unit(&random), 0, sqrt(2) + 0.01};
        contact_scene_check(&scene, "edges of grids", number);
        expect(contact_scene_corners(&scene) == 2, "case %d: %zu corners", (int)number, contact_scene_corners(&scene));
        const pir_contact *corner = &scene.contact[scene.count - 2];
        assert_true(fabs(fabs(corner[0].point_q.x - corner[1].point_q.x) - (1 - fabs(scene.t.x))) < 1e-6);
        contact_scene_clear(&scene);
    }
}

/* A face bent by 0.03° is one patch: its contacts are on the two facets, not on the plane between its corners. */
static void contacts_of_a_bent_face_lie_on_it(void **state) {
    (void)state;
    pir_vec3 at[10];
    for (int i = 0; i < 8; i++) {
        double half = i & 4 ? 1.3 : 1;
        at[i] = (pir_vec3){i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? 1 : 0};
    }
    at[8] = (pir_vec3){0, -1, -2.5e-4};
    at[9] = (pir_vec3){0, 1, -2.5e-4};
    contact_scene scene =
        contact_scene_make(contact_scene_baked(at, 10, still), contact_scene_box(0.5, 2, 1), (pir_quat){0, 0, 0.1, 1});
    scene.t = (pir_vec3){0.2, 0, 0.99};
    contact_scene_check(&scene, "bent", 0);
    assert_true(contact_scene_corners(&scene) == 4 && fabs(scene.answer.distance + 0.01025) < 1e-12);
    for (size_t i = scene.count - 4; i < scene.count; i++)
        assert_true(scene.contact[i].distance > -0.01025 && scene.contact[i].distance < -0.01001);
    contact_scene_clear(&scene);
}

static pir_polytope *regular_prism(uint32_t sides) {
    pir_vec3 at[32];
    pir_polytope *p = NULL;
    for (uint32_t i = 0; i < 2 * sides; i++) {
        const double angle = 6.283185307179586 * (i / 2) / sides;
        at[i] = (pir_vec3){cos(angle), sin(angle), i % 2 ? -0.5 : 0.5};
    }
    assert_int_equal(pir_polytope_create(at, 2 * sides, NULL, &p), PIR_OK);
    return p;
}

/*
 * Equal prisms beside each other, one turned by next to nothing: the ends of one are a few roundings beyond those of
 * the other, and so steep that the heights of points on them are any. Corners there are on the sides.
 */
static void corners_beside_a_steep_end_lie_on_the_sides(void **state) {
    (void)state;
    for (uint32_t sides = 3; sides <= 9; sides++)
        for (int k = 0; k < 120; k++) {
            const double angle = (k % 2 ? 1 : -1) * pow(10, -11 - 0.02 * k);
            contact_scene scene = contact_scene_make(regular_prism(sides), regular_prism(sides), still);
            scene.margin = 1;
            for (int axis = 0; axis < 3; axis++)
                for (int way = 0; way < 4; way++) {
                    scene.r = (pir_quat){axis == 0 ? angle : 0, axis == 1 ? angle : 0, axis == 2 ? angle : 0, 1};
                    assert_int_equal(pir_sum_rotate(scene.sum, scene.r, PIR_METHOD_AUTO), PIR_OK);
                    scene.t = (pir_vec3){way == 0 ? 1 : way == 1 ? -1 : 0, way == 2 ? 1 : way == 3 ? -1 : 0, 0};
                    contact_scene_check(&scene, "prisms", sides * 1000 + (uint64_t)k);
                }
            contact_scene_clear(&scene);
        }
}

/* Corners that rounding puts beside a side that leans by 1 in 500 are on the face, not below. */
static void corners_on_a_rim_are_as_deep_as_the_face(void **state) {
    (void)state;
    pir_vec3 at[8];
    for (int i = 0; i < 8; i++) {
        double half = i & 4 ? 1 : 1.002;
        at[i] = (pir_vec3){i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? 0 : -1};
    }
    for (int i = -20; i <= 20; i++) {
        contact_scene scene = contact_scene_make(contact_scene_box(1, 1, 1), contact_scene_baked(at, 8, still), still);
        scene.t = (pir_vec3){i * 1e-14, i * 2e-14, 0.99};
        contact_scene_check(&scene, "rim", (uint64_t)(i + 20));
        assert_int_equal(contact_scene_corners(&scene), 4);
        for (size_t k = 0; k < scene.count; k++)
            assert_true(fabs(scene.contact[k].distance + 0.01) < 1e-12);
        contact_scene_clear(&scene);
    }
}

/* --- aligned faces --- */

/*
 * Equal cubes, one on the other: each corner is one of both bodies and two crossings, but one contact, whatever
 * rounding says.
 */
static void equal_faces_have_four_corners_with_ids_that_last(void **state) {
    (void)state;
    uint64_t ids[4] = {0};
    for (uint64_t i = 0; i < 100; i++) {
        test_random random = test_random_case("contacts, equal", i);
        double tiny = i == 0 ? 0 : 1e-14;
        contact_scene scene = contact_scene_make(contact_scene_box(1, 1, 1), contact_scene_box(1, 1, 1),
                                                 (pir_quat){0, 0, tiny * test_random_unit(&random), 1});
        scene.t = (pir_vec3){tiny * test_random_unit(&random), tiny * test_random_unit(&random), 1.75};
        contact_scene_check(&scene, "equal faces", i);
        expect(contact_scene_corners(&scene) == 4, "case %d: %zu corners", (int)i, contact_scene_corners(&scene));
        const pir_contact *corner = &scene.contact[scene.count - 4];
        size_t same = 0;
        for (size_t k = 0; k < 4; k++)
            for (size_t l = 0; l < 4; l++)
                same += corner[k].id == ids[l];
        if (i == 0)
            for (size_t k = 0; k < 4; k++)
                ids[k] = corner[k].id;
        else
            expect(same == 4, "case %d: %zu ids of 4 lasted", (int)i, same);
        contact_scene_clear(&scene);
    }
}

/* Far from the origin points are coarse; the answer's is still the corner that it is. */
static void answers_far_from_the_origin_are_corners(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 50; number++) {
        test_random random = test_random_case("contacts, far", number);
        pir_vec3 at[8], origin = {1e7 * test_random_unit(&random), 1e7 * test_random_unit(&random), 0};
        for (int i = 0; i < 8; i++)
            at[i] = test_add(origin, (pir_vec3){i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1}, 1);
        contact_scene scene =
            contact_scene_make(contact_scene_box(1, 1, 1), contact_scene_baked(at, 8, still), (pir_quat){0, 0, 0.2, 1});
        scene.t = test_add(origin, (pir_vec3){0.25 * test_random_unit(&random), 0.25, 1.9}, 1);
        contact_scene_check(&scene, "far", number);
        expect(scene.count == contact_scene_corners(&scene), "case %d: %zu contacts", (int)number, scene.count);
        contact_scene_clear(&scene);
    }
}

/* --- flat bodies --- */

static pir_polytope *flat(size_t count, const double points[][2], double turned) {
    pir_vec3 at[8];
    for (size_t i = 0; i < count; i++)
        at[i] = (pir_vec3){points[i][0], points[i][1], 0};
    return contact_scene_baked(at, count, (pir_quat){0, 0, sin(turned / 2), cos(turned / 2)});
}

static const double point_at[][2] = {{0, 0}}, segment_at[][2] = {{-1, 0}, {1, 0}},
                    triangle_at[][2] = {{-1, -0.5}, {1, -0.5}, {0, 0.75}};

/* Asks with P's origin at t, checks, and expects as many corners, or with 0 the answer alone. */
static void expect_corners(pir_polytope *p, pir_polytope *q, pir_quat r, pir_vec3 t, size_t corners, const char *what) {
    contact_scene scene = contact_scene_make(p, q, r);
    scene.t = t;
    contact_scene_check(&scene, what, 0);
    expect(corners > 0 ? contact_scene_corners(&scene) == corners : scene.count == 1, "%s: %zu contacts, %zu corners",
           what, scene.count, contact_scene_corners(&scene));
    contact_scene_clear(&scene);
}

static void flat_bodies_share_segments_and_points(void **state) {
    (void)state;
    const pir_quat upright = {1, 0, 0, 1}, quarter = {0, 0, 1, 1};
    // depths and gaps alike
    for (int i = 0; i < 3; i++) {
        double up = 1 + (i - 1) * 0.125;
        expect_corners(flat(2, segment_at, 0), slab(), still, (pir_vec3){0, 0, up}, 2, "a segment on a face");
        expect_corners(flat(2, segment_at, 0), slab(), still, (pir_vec3){10, 3, up}, 2, "a segment over a side");
        expect_corners(flat(2, segment_at, 0.7), slab(), still, (pir_vec3){0, 0, up}, 2, "a turned segment on a face");
        expect_corners(slab(), flat(2, segment_at, 0.7), still, (pir_vec3){0, 0, -up}, 2, "a face under a segment");
        expect_corners(flat(3, triangle_at, 0), slab(), still, (pir_vec3){0, 0, up}, 3, "a triangle on a face");
        expect_corners(flat(3, triangle_at, 0), slab(), upright, (pir_vec3){0, 0, up + 0.5}, 2,
                       "a triangle on its side");
        expect_corners(flat(1, point_at, 0), slab(), still, (pir_vec3){0, 0, up}, 0, "a point on a face");
    }
    expect_corners(flat(2, segment_at, 0), flat(2, segment_at, 0), still, (pir_vec3){0.5, 0, 0.25}, 2,
                   "segments along");
    expect_corners(flat(2, segment_at, 0), flat(2, segment_at, 0), quarter, (pir_vec3){0.5, 0, 0.25}, 0,
                   "segments across");
    expect_corners(flat(2, segment_at, 0), flat(3, triangle_at, 0), still, (pir_vec3){0, 0, 0.25}, 2,
                   "a segment on a triangle");
    expect_corners(flat(3, triangle_at, 0), flat(3, triangle_at, 0), still, (pir_vec3){0.25, 0, 0.25}, 3,
                   "a triangle on a triangle");
    expect_corners(flat(2, segment_at, 0), contact_scene_box(1, 1, 1), still, (pir_vec3){0, -1.5, 1.5}, 2,
                   "a segment along an edge");
    expect_corners(flat(1, point_at, 0), flat(1, point_at, 0), still, (pir_vec3){0, 0, 1}, 0, "a point and a point");
}

/* The id of where a segment crosses the rim of a slab, as it turns: its ends change their order in any plane. */
static void ids_last_while_a_segment_turns(void **state) {
    (void)state;
    contact_scene scene = contact_scene_make(flat(2, segment_at, 0), slab(), still);
    uint64_t before = 0;
    scene.t = (pir_vec3){10, 0.5, 0.99};
    for (int i = -8; i <= 8; i++) {
        uint64_t crossing = 0;
        scene.r = (pir_quat){0, 0, sin(0.08 * i), cos(0.08 * i)};
        assert_int_equal(pir_sum_rotate(scene.sum, scene.r, PIR_METHOD_AUTO), PIR_OK);
        contact_scene_check(&scene, "a segment turns", (uint64_t)(i + 8));
        for (size_t k = 0; k < scene.count; k++)
            crossing = fabs(scene.contact[k].point_q.x - 10) < 1e-12 ? scene.contact[k].id : crossing;
        assert_true(crossing >> 62 == 2 && (i == -8 || crossing == before));
        before = crossing;
    }
    contact_scene_clear(&scene);
    // a contact that stands alone is named by its vertex
    scene = contact_scene_make(flat(1, point_at, 0), slab(), still);
    scene.t = (pir_vec3){0, 0, 1};
    contact_scene_check(&scene, "a point", 0);
    assert_true(scene.count == 1 && scene.contact[0].id >> 62 == 0);
    contact_scene_clear(&scene);
}

/* Points, segments, polygons and boxes in poses level and not, apart and touching. */
static void contacts_of_flat_bodies_lie_on_them(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 2000; number++) {
        test_random random = test_random_case("contacts, flat", number);
        pir_polytope *body[2];
        for (int k = 0; k < 2; k++) {
            static const double(*const at[3])[2] = {point_at, segment_at, triangle_at};
            uint32_t kind = test_random_below(&random, 4);
            body[k] = kind == 3 ? contact_scene_box(0.5, 1, 0.25)
                                : flat(kind + 1, at[kind], number % 3 ? test_random_unit(&random) : 0);
        }
        double tilt = number % 2 ? 0 : ldexp(test_random_unit(&random), -test_random_between(&random, 0, 50));
        contact_scene scene = contact_scene_make(
            body[0], body[1],
            (pir_quat){tilt, tilt * test_random_unit(&random), number % 5 ? test_random_unit(&random) : 0, 1});
        scene.t = (pir_vec3){test_random_unit(&random), test_random_unit(&random),
                             ldexp(test_random_unit(&random), -test_random_between(&random, 0, 9))};
        scene.margin = number % 4 ? 0 : 0.1;
        contact_scene_check(&scene, "flat bodies", number);
        contact_scene_clear(&scene);
    }
}

/* --- margins --- */

static void a_margin_brings_contacts_before_bodies_meet(void **state) {
    (void)state;
    contact_scene scene = contact_scene_make(contact_scene_box(1, 1, 1), slab(), still);
    scene.t = (pir_vec3){0, 0, 2.01};
    scene.margin = 0.02;
    contact_scene_check(&scene, "apart", 0);
    assert_int_equal(contact_scene_corners(&scene), 4);
    assert_true(scene.answer.outcome == PIR_SEPARATED);
    for (size_t i = 0; i < scene.count; i++)
        assert_true(fabs(scene.contact[i].distance - 0.01) < 1e-12);
    contact_scene_clear(&scene);
    // standing on an edge, tilted so that the other two corners are 0.2 · sin above the slab
    scene = contact_scene_make(contact_scene_box(1, 1, 1), slab(), (pir_quat){0, 0.01, 0, 1});
    double angle = 2 * atan(0.01), low = cos(angle) + sin(angle), risen = 2 * sin(angle);
    scene.t = (pir_vec3){0, 0, 1 + low};
    static const double margins[4] = {0, 0.9, 1.1, HUGE_VAL};
    for (int i = 0; i < 4; i++) {
        scene.margin = margins[i] * risen;
        contact_scene_check(&scene, "tilted", (uint64_t)i);
        assert_int_equal(contact_scene_corners(&scene), i < 2 ? 2 : 4);
        for (size_t k = 0; k < scene.count; k++)
            assert_true(fabs(scene.contact[k].distance) < 1e-12 || fabs(scene.contact[k].distance - risen) < 1e-12);
    }
    contact_scene_clear(&scene);
}

/* Radii move the points along the normal, and shorten every distance by their sum. */
static void radii_move_the_contacts(void **state) {
    (void)state;
    contact_scene scene = contact_scene_make(contact_scene_box(1, 1, 1), slab(), still);
    pir_query_input input = pir_query_input_default();
    pir_query_result answer;
    pir_contact contact[8];
    size_t count = 0;
    input.translation = (pir_vec3){0, 0, 2.01};
    input.radius_p = 0.03;
    input.radius_q = 0.05;
    assert_int_equal(pir_query_signed_distance(scene.query, &input, NULL, &answer), PIR_OK);
    assert_int_equal(pir_query_manifold(scene.query, &input, &answer, 8, contact, &count), PIR_OK);
    assert_true(count >= 4 && count <= 5 && answer.outcome == PIR_OVERLAPPING);
    for (size_t i = 0; i < count; i++) {
        assert_true(fabs(contact[i].distance + 0.07) < 1e-12);
        assert_true(fabs(contact[i].point_p.z - 0.98) < 1e-12 && fabs(contact[i].point_q.z - 1.05) < 1e-12);
    }
    contact_scene_clear(&scene);
}

/* --- what is refused --- */

static void bad_margins_and_answers_are_refused(void **state) {
    (void)state;
    contact_scene scene = contact_scene_make(contact_scene_box(1, 1, 1), slab(), still);
    scene.t = (pir_vec3){0, 0, 1.9};
    contact_scene_ask(&scene);
    const pir_query_result right = scene.answer;
    pir_query_input input = pir_query_input_default();
    pir_contact contact[8], before[8];
    size_t count = 77;
    input.translation = scene.t;
    memset(contact, 7, sizeof contact);
    memcpy(before, contact, sizeof contact);
    input.margin = NAN;
    assert_int_equal(pir_query_manifold(scene.query, &input, &right, 8, contact, &count), PIR_ERR_NOT_FINITE);
    input.margin = -1e-300;
    assert_int_equal(pir_query_manifold(scene.query, &input, &right, 8, contact, &count), PIR_ERR_ARGUMENT);
    input.margin = 0;
    for (int i = 0; i < 7; i++) {
        pir_query_result wrong = right;
        if (i == 0)
            memset(&wrong, 0, sizeof wrong);
        if (i == 1)
            wrong.normal.x = NAN;
        if (i == 2)
            wrong.witness.p.index = UINT32_MAX;
        if (i == 3)
            wrong.witness.q.kind = PIR_FEATURE_NONE;
        if (i == 4)
            wrong.normal.z *= 2;
        if (i == 5)
            wrong.point_q.y = HUGE_VAL;
        if (i == 6)
            wrong.distance = NAN;
        assert_int_equal(pir_query_manifold(scene.query, &input, &wrong, 8, contact, &count), PIR_ERR_ARGUMENT);
    }
    assert_true(count == 77 && memcmp(contact, before, sizeof contact) == 0);
    // an answer beyond the cutoff has no points, and no contacts
    input.translation.z = 5;
    input.cutoff = 0.5;
    assert_int_equal(pir_query_signed_distance(scene.query, &input, NULL, &scene.answer), PIR_OK);
    assert_true(scene.answer.outcome == PIR_BEYOND_CUTOFF);
    assert_int_equal(pir_query_manifold(scene.query, &input, &scene.answer, 8, contact, &count), PIR_OK);
    assert_true(count == 0);
    contact_scene_clear(&scene);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_dodecahedron_with_vertices_moved_by_an_ulp_has_its_deepest_point),
        cmocka_unit_test(cubes_rotated_in_double_have_their_deepest_point),
        cmocka_unit_test(cylinders_rotated_in_double_have_their_deepest_point),
        cmocka_unit_test(corners_given_once_a_triangle_are_one_patch),
        cmocka_unit_test(faces_of_rounded_grids_are_whole),
        cmocka_unit_test(edges_of_rounded_grids_share_a_segment),
        cmocka_unit_test(contacts_of_a_bent_face_lie_on_it),
        cmocka_unit_test(corners_beside_a_steep_end_lie_on_the_sides),
        cmocka_unit_test(corners_on_a_rim_are_as_deep_as_the_face),
        cmocka_unit_test(equal_faces_have_four_corners_with_ids_that_last),
        cmocka_unit_test(flat_bodies_share_segments_and_points),
        cmocka_unit_test(ids_last_while_a_segment_turns),
        cmocka_unit_test(answers_far_from_the_origin_are_corners),
        cmocka_unit_test(contacts_of_flat_bodies_lie_on_them),
        cmocka_unit_test(a_margin_brings_contacts_before_bodies_meet),
        cmocka_unit_test(radii_move_the_contacts),
        cmocka_unit_test(bad_margins_and_answers_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
