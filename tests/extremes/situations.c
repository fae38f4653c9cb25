/* SPDX-License-Identifier: MIT */
/* See situations.h. */
#include "extremes/situations.h"

#include <math.h>

typedef struct maker {
    const char *name;
    void (*make)(test_random *random, situation *s);
} maker;

/* --- parts --- */

static void scale_by(test_points *points, double x, double y, double z) {
    for (size_t i = 0; i < points->count; i++)
        points->at[i] = (pir_vec3){points->at[i].x * x, points->at[i].y * y, points->at[i].z * z};
}

static void move_by(test_points *points, double x, double y, double z) {
    for (size_t i = 0; i < points->count; i++)
        points->at[i] = (pir_vec3){points->at[i].x + x, points->at[i].y + y, points->at[i].z + z};
}

static void box(test_points *points, double x, double y, double z) {
    points->count = 8;
    for (int i = 0; i < 8; i++)
        points->at[i] = (pir_vec3){i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z};
}

/* Exactly `count` points of the sphere. */
static void sphere(test_random *random, size_t count, test_points *points) {
    points->count = count;
    for (size_t i = 0; i < count; i++)
        points->at[i] = test_random_direction(random);
}

/* A box of integers, and a sphere. */
static void box_and_sphere(test_random *random, situation *s) {
    test_body_points(random, TEST_BOX, 8, &s->p);
    sphere(random, 14, &s->q);
}

static void turn_to(situation *s, double x, double y, double z, double w) {
    s->turn[s->turns++] = (pir_quat){x, y, z, w};
}

/* Aligned, a quarter turn, a third turn, and any. */
static void turn_anyhow(test_random *random, situation *s) {
    turn_to(s, 0, 0, 0, 1);
    turn_to(s, 0, 0, 1, 1);
    turn_to(s, 1, 1, 1, 1);
    s->turn[s->turns++] = test_general_rotation(random);
}

static void rescale(situation *s, double p, double q) {
    scale_by(&s->p, p, p, p);
    scale_by(&s->q, q, q, q);
    s->scale = fmax(p, q);
}

/* --- sizes --- */

static void tiny(test_random *random, situation *s) {
    box_and_sphere(random, s);
    rescale(s, 1e-150, 1e-150);
    turn_anyhow(random, s);
}

static void huge(test_random *random, situation *s) {
    box_and_sphere(random, s);
    rescale(s, 1e150, 1e150);
    turn_anyhow(random, s);
}

static void tiny_on_huge(test_random *random, situation *s) {
    box_and_sphere(random, s);
    rescale(s, 1e-12, 1e12);
    turn_anyhow(random, s);
}

static void huge_on_tiny(test_random *random, situation *s) {
    box_and_sphere(random, s);
    rescale(s, 1e12, 1e-12);
    turn_anyhow(random, s);
}

static void far_away(test_random *random, situation *s) {
    box(&s->p, 2, 3, 4);
    sphere(random, 14, &s->q);
    move_by(&s->p, 1e15, -1e15, 1e15);
    move_by(&s->q, -1e15, 1e15, 1e15);
    turn_anyhow(random, s);
}

static void least_denormals(test_random *random, situation *s) {
    test_body_points(random, TEST_GRID, 14, &s->p);
    box(&s->q, 3, 2, 1);
    rescale(s, 5e-324, 5e-324);
    s->move = SITUATION_STEPS;
    s->kinds = "oracle,features,state,witness,tie,cache,batch,approach-outcome,cast-outcome";
    turn_anyhow(random, s);
}

/* All coordinates are denormals, of 40 bits. */
static void denormal(test_random *random, situation *s) {
    box_and_sphere(random, s);
    rescale(s, 0x1p-1034, 0x1p-1034);
    s->kinds = "oracle,features,state,distance,depth,normal,witness,tie,cache,batch,approach-outcome,cast-outcome";
    turn_anyhow(random, s);
}

static void with_denormal(test_random *random, situation *s) {
    box_and_sphere(random, s);
    for (size_t i = 0; i < s->q.count; i++)
        s->q.at[i].z *= 1e-310;
    turn_anyhow(random, s);
}

/* --- shapes --- */

static void needles(test_random *random, situation *s) {
    sphere(random, 12, &s->p);
    sphere(random, 12, &s->q);
    scale_by(&s->p, 1, 1, 1e9);
    scale_by(&s->q, 1e9, 1, 1);
    s->scale = 1e9;
    turn_anyhow(random, s);
}

static void plates(test_random *random, situation *s) {
    sphere(random, 12, &s->p);
    box(&s->q, 1, 1, 1e-9);
    scale_by(&s->p, 1, 1, 1e-9);
    turn_anyhow(random, s);
}

/* A box whose top bulges by less than 20 ulps over 4 by 4 squares: facets meet there at about 1e-15. */
static void bulging_box(test_points *points, double side) {
    box(points, side, side, 1);
    for (int i = -2; i <= 2; i++)
        for (int j = -2; j <= 2; j++)
            points->at[points->count++] =
                (pir_vec3){side * i / 2, side * j / 2, 1 + (2 * (10 - i * i - j * j)) * 0x1p-52};
}

static void flat_dihedrals(test_random *random, situation *s) {
    bulging_box(&s->p, 1);
    bulging_box(&s->q, 2);
    turn_anyhow(random, s);
    turn_to(s, 1, 0, 0, 0);
}

static void near_parallel(test_random *random, situation *s) {
    test_body_points(random, TEST_BOX, 8, &s->p);
    test_body_points(random, TEST_BOX, 8, &s->q);
    turn_to(s, 1e-16, 0, 0, 1);
    turn_to(s, 1e-17, -3e-17, 2e-17, 1);
    turn_to(s, 0, 0, 1, 1 + 0x1p-52);
    turn_to(s, 0, 0x1p-53, 1, 1);
    turn_to(s, 1, 1, 1, 1 + 0x1p-52);
}

pir_vec3 situation_near_sphere(test_random *random) {
    pir_vec3 v = test_random_direction(random);
    double *c[3] = {&v.x, &v.y, &v.z};
    for (int k = 0; k < 3; k++)
        *c[k] = nextafter(*c[k], test_random_below(random, 2) ? 2 : -2);
    return v;
}

static void near_sphere(test_random *random, situation *s) {
    test_points *of[2] = {&s->p, &s->q};
    for (int k = 0; k < 2; k++)
        for (of[k]->count = 0; of[k]->count < 24; of[k]->count++)
            of[k]->at[of[k]->count] = situation_near_sphere(random);
    turn_anyhow(random, s);
}

/* Of each small cluster of points only ulps apart all are vertices, or nearly. */
static void clusters(test_random *random, situation *s) {
    test_points *of[2] = {&s->p, &s->q};
    for (int k = 0; k < 2; k++) {
        test_points corners;
        box(&corners, 1, 1, 1);
        for (size_t i = 0; i < 24; i++) {
            pir_vec3 v = corners.at[i % 8];
            v.x += test_random_between(random, -2, 2) * 0x1p-52;
            v.y += test_random_between(random, -2, 2) * 0x1p-52;
            v.z += test_random_between(random, -2, 2) * 0x1p-52;
            of[k]->at[i] = v;
        }
        of[k]->count = 24;
    }
    turn_anyhow(random, s);
}

/* --- rotations --- */

static void tiny_quaternions(test_random *random, situation *s) {
    box_and_sphere(random, s);
    turn_to(s, 1e-160, 2e-160, -3e-160, 4e-160);
    turn_to(s, 0, 0, 1e-160, 1e-160);
    turn_to(s, 5e-324, 0, 0, 1e-323);
    turn_to(s, 1e-310, 1e-310, 1e-310, 1e-310);
}

static void huge_quaternions(test_random *random, situation *s) {
    box_and_sphere(random, s);
    turn_to(s, 1e150, -2e150, 3e150, 4e150);
    turn_to(s, 0, 0, 1e150, 1e150);
    turn_to(s, 1e308, -1e308, 1e308, 1e308);
}

static void tiny_turns(test_random *random, situation *s) {
    test_body_points(random, TEST_BOX, 8, &s->p);
    test_body_points(random, TEST_BOX, 8, &s->q);
    turn_to(s, 0, 0, 0, 1);
    turn_to(s, 1e-300, 0, 0, 1);
    turn_to(s, 1e-300, -1e-300, 5e-324, 1);
    turn_to(s, 1, 0, 1e-300, 1);
    turn_to(s, 0, 1, 0, -1e-300);
}

static void quarter_turns(test_random *random, situation *s) {
    test_body_points(random, TEST_PRISM, 12, &s->p);
    test_body_points(random, TEST_BOX, 8, &s->q);
    turn_to(s, 0, 0, 1, 1);
    turn_to(s, 1, 0, 0, 0);
    turn_to(s, 0, 0, 0, -1);
    turn_to(s, 0, 1, 1, 0);
    // what sin and cos make of 90, 180 and 360 degrees
    turn_to(s, 0, 0, sin(0.78539816339744831), cos(0.78539816339744831));
    turn_to(s, 0, 1, 0, cos(1.57079632679489662));
    turn_to(s, sin(3.14159265358979312), 0, 0, -1);
}

/* --- pairs --- */

static void identical(test_random *random, situation *s) {
    sphere(random, 16, &s->p);
    s->q = s->p;
    turn_anyhow(random, s);
    turn_to(s, 1, 0, 0, 0);
}

static void mirrored(test_random *random, situation *s) {
    sphere(random, 16, &s->p);
    s->q = s->p;
    scale_by(&s->q, -1, -1, -1);
    turn_anyhow(random, s);
    turn_to(s, 1, 0, 0, 0);
}

static void sliding(test_random *random, situation *s) {
    (void)random;
    box(&s->p, 0.5, 1, 0.25);
    box(&s->q, 4, 3, 1);
    s->move = SITUATION_SLIDE;
    turn_to(s, 0, 0, 0, 1);
    turn_to(s, 0, 0, 1, 3);
    turn_to(s, 1, 0, 0, 0);
}

static void flat_on_flat(test_random *random, situation *s) {
    test_body_points(random, TEST_POLYGON, 10, &s->p);
    test_body_points(random, TEST_SEGMENT, 6, &s->q);
    turn_anyhow(random, s);
}

static const maker makers[] = {
    {"size 1e-150", tiny},
    {"size 1e150", huge},
    {"1e-12 against 1e12", tiny_on_huge},
    {"1e12 against 1e-12", huge_on_tiny},
    {"1e15 from the origin", far_away},
    {"coordinates of a few least denormals", least_denormals},
    {"coordinates below the normal numbers", denormal},
    {"a side of 1e-310", with_denormal},
    {"needles 1e9 : 1", needles},
    {"plates 1 : 1e-9", plates},
    {"dihedral angles of 1e-15", flat_dihedrals},
    {"edges parallel within 1e-16", near_parallel},
    {"points within an ulp of a sphere", near_sphere},
    {"clusters of points ulps apart", clusters},
    {"quaternions of length 1e-160 and less", tiny_quaternions},
    {"quaternions of length 1e150 and more", huge_quaternions},
    {"turns of 1e-300", tiny_turns},
    {"turns of 90, 180, 360 degrees, exact and rounded", quarter_turns},
    {"identical operands", identical},
    {"mirrored operands", mirrored},
    {"face sliding on face, within an ulp", sliding},
    {"a polygon and a segment", flat_on_flat},
};

uint32_t situation_count(void) {
    return sizeof makers / sizeof *makers;
}

void situation_make(uint32_t index, situation *ret_situation) {
    test_random random = test_random_case("situations", index);
    ret_situation->name = makers[index].name;
    ret_situation->turns = 0;
    ret_situation->move = SITUATION_ANY;
    ret_situation->scale = 1;
    ret_situation->kinds = NULL;
    makers[index].make(&random, ret_situation);
}
