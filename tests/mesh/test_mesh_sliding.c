/* SPDX-License-Identifier: MIT */
/*
 * Bodies slide without friction over floors of triangles: no normal is off those of the floor, and none slows the body.
 * PIR_TEST_FRAMES is how many frames each body slides over each floor at each speed.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include "mesh/sliding_floors.h"

#define CONTACTS 64
#define SURFACES 256
#define NEAR     1e-9

static uint64_t frames(void) {
    const char *text = getenv("PIR_TEST_FRAMES");
    return text ? strtoull(text, NULL, 10) : 20;
}

static double apart(pir_vec3 a, pir_vec3 b) {
    return fmax(fabs(a.x - b.x), fmax(fabs(a.y - b.y), fabs(a.z - b.z)));
}

/* Whether a normal is one of the floor: of a ridge or the bottom between strips, also what lies between both sides'. */
static bool is_true(int kind, pir_vec3 n) {
    double length = sqrt(1 + FLOOR_SLOPE * FLOOR_SLOPE), z = 1 / length, side = FLOOR_SLOPE / length;
    if (kind == FLOOR_RIDGE)
        return fabs(n.y) < NEAR && fabs(n.x) < side + NEAR && n.z > z - NEAR;
    if (kind == FLOOR_VALLEY)
        return apart(n, (pir_vec3){0, side, z}) < NEAR || apart(n, (pir_vec3){0, -side, z}) < NEAR;
    return apart(n, (pir_vec3){0, 0, 1}) < NEAR;
}

typedef struct run {
    const sliding_floor *floor;
    int kind;
    double gap;
    pir_workspace *workspace;
    uint64_t frames, contacts;
    double slowest; /* the greatest part of its speed that a body lost or gained */
} run;

/* The contacts of all pieces of a body where it is; how many. */
static size_t contacts_of(const run *r, const slider *body, double speed, uint64_t frame,
                          pir_surface_contact contacts[CONTACTS]) {
    pir_posed_surface surfaces[SURFACES];
    const pir_polytope *beside[SLIDER_PIECES];
    pir_surface_contact_input input = pir_surface_contact_input_default();
    const double x = body->pose.translation.x;
    size_t count = 0;
    for (uint32_t k = 0; k < body->pieces; k++)
        beside[k] = body->piece[k];
    input.pose = body->pose;
    input.radius = body->radius;
    input.margin = 0.04;
    input.beside = beside;
    input.beside_count = body->pieces;
    input.surfaces = surfaces;
    input.surface_count = floor_between(r->floor, x - 0.8, x + 0.8, surfaces, SURFACES);
    for (uint32_t k = 0; k < body->pieces; k++) {
        pir_surface_contact_result result;
        assert_int_equal(
            pir_surface_contacts(body->piece[k], r->workspace, &input, CONTACTS - count, contacts + count, &result),
            PIR_OK);
        for (size_t i = count; i < count + result.contacts; i++)
            expect(is_true(r->kind, contacts[i].normal),
                   "%s, piece %u, on %s at %g m/s, frame %llu: normal %.17g %.17g %.17g of triangle %u, %.9g away",
                   body->name, k, r->floor->name, speed, (unsigned long long)frame, contacts[i].normal.x,
                   contacts[i].normal.y, contacts[i].normal.z, contacts[i].triangle, contacts[i].distance);
        count += result.contacts;
    }
    return count;
}

static void slide(run *r, slider *body, double speed) {
    body->velocity = (pir_vec3){speed, 0, 0};
    // a little across the cells, but along a valley
    body->velocity.y = r->kind >= FLOOR_RIDGE ? 0 : 0.05 * speed;
    const double across = body->velocity.y;
    for (uint64_t frame = 0; frame < frames(); frame++) {
        pir_surface_contact contacts[CONTACTS];
        pir_vec3 *at = &body->pose.translation;
        at->x -= at->x > FLOOR_LENGTH / 2 - 2 ? FLOOR_LENGTH - 2 * FLOOR_STEP : 0;
        at->y -= at->y > 3 && r->kind < FLOOR_RIDGE ? 6 : 0;
        const size_t count = contacts_of(r, body, speed, frame, contacts);
        slider_step(body, contacts, count, r->gap);
        r->frames++;
        r->contacts += count;
        expect(at->z > -1 && at->z < (r->kind == FLOOR_RIDGE ? 50 : 4),
               "%s on %s at %g m/s, frame %llu: it is at height %g", body->name, r->floor->name, speed,
               (unsigned long long)frame, at->z);
        if (r->kind == FLOOR_RIDGE) // it goes up and down; we keep it going
            body->velocity.x = fmax(body->velocity.x, 1);
        else
            r->slowest = fmax(r->slowest, fabs(body->velocity.x - speed) / speed);
        if (r->kind < FLOOR_RIDGE)
            r->slowest = fmax(r->slowest, fabs(body->velocity.y - across) / speed);
    }
}

/* Every body at every speed over one floor, resting at a gap, which may be an overlap. */
static void slide_all(int kind, double gap) {
    static const double speeds[3] = {1, 7, 30};
    sliding_floor floor;
    pir_workspace *workspace;
    floor_make(&floor, kind);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    run r = {&floor, kind, gap, workspace, 0, 0, 0};
    for (int shape = 0; shape < SLIDER_KINDS; shape++)
        for (int i = 0; i < 3; i++) {
            slider body;
            slider_make(&body, shape, gap);
            body.pose.translation.x = 0.13;
            body.pose.translation.y = kind >= FLOOR_RIDGE ? 0 : 0.07;
            body.pose.translation.z += kind == FLOOR_RIDGE ? 0.2 : kind == FLOOR_VALLEY ? 0.15 : 0;
            slide(&r, &body, speeds[i]);
            slider_clear(&body);
        }
    print_message("%s, at a gap of %g: %llu frames, %llu contacts, speed off by at most %.2g\n", floor.name, gap,
                  (unsigned long long)r.frames, (unsigned long long)r.contacts, r.slowest);
    assert_true(r.contacts * 4 > r.frames);
    assert_true(r.slowest < 1e-6);
    pir_workspace_destroy(workspace);
    floor_clear(&floor);
}

static void flat_floors_have_one_normal(void **state) {
    (void)state;
    for (int kind = 0; kind < FLOOR_RIDGE; kind++)
        slide_all(kind, 0.005);
}

static void bodies_that_have_sunk_in_feel_the_same_floor(void **state) {
    (void)state;
    for (int kind = 0; kind < FLOOR_RIDGE; kind++)
        slide_all(kind, -0.002);
}

static void ridges_and_valleys_have_the_normals_of_their_sides(void **state) {
    (void)state;
    slide_all(FLOOR_RIDGE, 0.005);
    slide_all(FLOOR_VALLEY, 0.005);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flat_floors_have_one_normal),
        cmocka_unit_test(bodies_that_have_sunk_in_feel_the_same_floor),
        cmocka_unit_test(ridges_and_valleys_have_the_normals_of_their_sides),
    };
    return cmocka_run_group_tests_name("contacts of meshes, sliding", tests, NULL, NULL);
}
