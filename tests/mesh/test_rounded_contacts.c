/* SPDX-License-Identifier: MIT */
/*
 * Contacts of balls and capsules with soups of triangles, by the theorem in doubles and by plain means: nearest points
 * of a segment and a triangle by trying all pairs of features; a contact is true where its normal separates the body,
 * grown by the ball that contacts are looked at with and moved until it touches, from every triangle that it meets.
 * Contacts of which a rounding might decide are left out.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include "mesh/contact_stage.h"

#define CONTACTS 512
/* Quantities this near to 0 decide nothing. */
#define OPEN 1e-7
/* Heights of what is level, by roundings. */
#define LEVEL 1e-13

static uint64_t stages(void) {
    const char *text = getenv("PIR_TEST_POSES");
    return text ? strtoull(text, NULL, 10) / 8 : 120;
}

static pir_vec3 minus(pir_vec3 a, pir_vec3 b) {
    return (pir_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static pir_vec3 plus(pir_vec3 a, pir_vec3 b, double part) {
    return (pir_vec3){a.x + part * b.x, a.y + part * b.y, a.z + part * b.z};
}

static double product(pir_vec3 a, pir_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static pir_vec3 cross(pir_vec3 a, pir_vec3 b) {
    return (pir_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double length_of(pir_vec3 a) {
    return sqrt(product(a, a));
}

/* A pair of points, the nearest so far. */
typedef struct nearest {
    double distance;
    pir_vec3 p, q;
} nearest;

static void consider(nearest *best, pir_vec3 p, pir_vec3 q) {
    double distance = length_of(minus(p, q));
    if (distance < best->distance)
        *best = (nearest){distance, p, q};
}

static double within(double x) {
    return fmin(1, fmax(0, x));
}

static void point_segment(nearest *best, pir_vec3 p, pir_vec3 a, pir_vec3 b, bool turned) {
    const pir_vec3 e = minus(b, a);
    const double square = product(e, e);
    const pir_vec3 q = plus(a, e, square > 0 ? within(product(minus(p, a), e) / square) : 0);
    consider(best, turned ? q : p, turned ? p : q);
}

static void segments(nearest *best, pir_vec3 a, pir_vec3 b, pir_vec3 c, pir_vec3 d) {
    const pir_vec3 e = minus(b, a), f = minus(d, c), r = minus(a, c);
    const double ee = product(e, e), ff = product(f, f), ef = product(e, f), under = ee * ff - ef * ef;
    point_segment(best, a, c, d, false);
    point_segment(best, b, c, d, false);
    point_segment(best, c, a, b, true);
    point_segment(best, d, a, b, true);
    if (!(under > 1e-12 * ee * ff))
        return;
    const double s = (ef * product(f, r) - ff * product(e, r)) / under;
    const double t = (ee * product(f, r) - ef * product(e, r)) / under;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1)
        consider(best, plus(a, e, s), plus(c, f, t));
}

static void point_face(nearest *best, pir_vec3 p, const pir_vec3 c[3]) {
    const pir_vec3 n = cross(minus(c[1], c[0]), minus(c[2], c[0]));
    for (int k = 0; k < 3; k++)
        if (product(cross(n, minus(c[(k + 1) % 3], c[k])), minus(p, c[k])) < 0)
            return;
    consider(best, p, plus(p, n, -product(n, minus(p, c[0])) / product(n, n)));
}

/* The nearest points of a segment and a triangle that do not meet. */
static nearest nearest_of(pir_vec3 a, pir_vec3 b, const pir_vec3 c[3]) {
    nearest best = {HUGE_VAL, a, a};
    for (int k = 0; k < 3; k++)
        segments(&best, a, b, c[k], c[(k + 1) % 3]);
    point_face(&best, a, c);
    point_face(&best, b, c);
    return best;
}

/* Whether a segment goes through a triangle, or comes near to doing so. */
static bool goes_through(pir_vec3 a, pir_vec3 b, const pir_vec3 c[3]) {
    const pir_vec3 n = cross(minus(c[1], c[0]), minus(c[2], c[0]));
    const double x = product(n, minus(a, c[0])), y = product(n, minus(b, c[0]));
    if (x * y > 0)
        return false;
    const pir_vec3 at = plus(a, minus(b, a), x == y ? 0 : x / (x - y));
    for (int k = 0; k < 3; k++)
        if (product(cross(n, minus(c[(k + 1) % 3], c[k])), minus(at, c[k])) < 0)
            return false;
    return true;
}

typedef struct scene {
    uint32_t count;
    pir_vec3 corner[SOUP_MOST][3], front[SOUP_MOST];
    bool one_sided[SOUP_MOST];
    pir_vec3 a, b; /* the ends of the core */
    double radius, ball;
    nearest near[SOUP_MOST];
} scene;

static void scene_take(scene *sc, const stage *s) {
    sc->count = s->soup.count;
    for (uint32_t i = 0; i < sc->count; i++) {
        const pir_posed_surface *on = &s->surface[i % s->surfaces];
        for (int k = 0; k < 3; k++)
            sc->corner[i][k] = pir_pose_apply(on->pose, s->soup.corner[i][k]);
        const pir_vec3 n = cross(minus(sc->corner[i][1], sc->corner[i][0]), minus(sc->corner[i][2], sc->corner[i][0]));
        sc->front[i] = plus((pir_vec3){0, 0, 0}, n, 1 / length_of(n));
        sc->one_sided[i] = s->truth->difference[i].one_sided;
    }
}

/* How far the core, moved by `by`, reaches in front of a triangle. */
static double reach(const scene *sc, uint32_t i, pir_vec3 by) {
    const pir_vec3 from = minus(by, sc->corner[i][0]);
    return fmax(product(sc->front[i], plus(sc->a, from, 1)), product(sc->front[i], plus(sc->b, from, 1)));
}

/* Measures all; false where the ball overlaps any, or a rounding might say so. */
static bool is_apart(scene *sc) {
    double least = sc->radius;
    for (uint32_t i = 0; i < sc->count; i++) {
        if (goes_through(sc->a, sc->b, sc->corner[i]))
            return false;
        sc->near[i] = nearest_of(sc->a, sc->b, sc->corner[i]);
        least = fmin(least, sc->near[i].distance);
    }
    sc->ball = 0.5 * sc->radius;
    return least >= sc->radius;
}

enum verdict { GHOST, TRUE_CONTACT, UNCLEAR };

/* What one triangle says of the contact of another one. */
static enum verdict ask(const scene *sc, uint32_t r, pir_vec3 n, pir_vec3 x, pir_vec3 by) {
    const bool through = goes_through(plus(sc->a, by, 1), plus(sc->b, by, 1), sc->corner[r]);
    const double apart_by = through ? 0 : nearest_of(plus(sc->a, by, 1), plus(sc->b, by, 1), sc->corner[r]).distance;
    double rise = -HUGE_VAL;
    for (int k = 0; k < 3; k++)
        rise = fmax(rise, product(n, minus(sc->corner[r][k], x)));
    const double back = sc->one_sided[r] ? -product(n, sc->front[r]) : -1;
    const double front = sc->one_sided[r] ? reach(sc, r, by) : 1;
    const bool touches = apart_by < sc->ball + OPEN, hides = apart_by < sc->ball - OPEN;
    if (!touches || front < -OPEN || (rise < -OPEN && back < -OPEN))
        return TRUE_CONTACT;
    // a triangle that only touches hides where it has the point of contact itself
    if (!hides || fabs(front) <= OPEN || (rise <= OPEN && back <= OPEN))
        return fabs(rise) <= LEVEL && back < -OPEN ? TRUE_CONTACT : UNCLEAR;
    return GHOST;
}

static enum verdict judge(const scene *sc, uint32_t i, pir_vec3 *ret_n) {
    const nearest *near = &sc->near[i];
    const pir_vec3 n = plus((pir_vec3){0, 0, 0}, minus(near->p, near->q), 1 / near->distance);
    const pir_vec3 by = plus((pir_vec3){0, 0, 0}, n, sc->ball - near->distance);
    const double front = sc->one_sided[i] ? reach(sc, i, (pir_vec3){0, 0, 0}) : 1;
    const double back = sc->one_sided[i] ? -product(n, sc->front[i]) : -1;
    *ret_n = n;
    if (front < -OPEN || back > OPEN)
        return GHOST;
    enum verdict verdict = front <= OPEN || back > -OPEN ? UNCLEAR : TRUE_CONTACT;
    for (uint32_t r = 0; r < sc->count; r++) {
        enum verdict one = r == i ? TRUE_CONTACT : ask(sc, r, n, near->q, by);
        if (one == GHOST)
            return GHOST;
        verdict = one == UNCLEAR ? UNCLEAR : verdict;
    }
    return verdict;
}

typedef struct tally {
    uint64_t poses, contacts, ghosts, unclear;
} tally;

static void check_pose(scene *sc, const pir_surface_contact *contacts, size_t count, double margin, uint64_t number,
                       tally *seen) {
    pir_vec3 normal[SOUP_MOST];
    enum verdict verdict[SOUP_MOST];
    seen->poses++;
    for (uint32_t i = 0; i < sc->count; i++) {
        verdict[i] = judge(sc, i, &normal[i]);
        seen->contacts += verdict[i] == TRUE_CONTACT;
        seen->ghosts += verdict[i] == GHOST;
        seen->unclear += verdict[i] == UNCLEAR;
        const double gap = sc->near[i].distance - sc->radius;
        bool told = gap > margin - OPEN || verdict[i] != TRUE_CONTACT;
        for (size_t k = 0; k < count && !told; k++)
            told = apart(contacts[k].normal, normal[i]) < OPEN && contacts[k].distance < gap + OPEN;
        expect(told, "stage %llu: the contact of triangle %u, gap %g, is lost", (unsigned long long)number, i, gap);
    }
    for (size_t k = 0; k < count; k++) {
        bool is = false;
        for (uint32_t i = 0; i < sc->count && !is; i++)
            is = verdict[i] != GHOST && apart(contacts[k].normal, normal[i]) < OPEN;
        expect(is, "stage %llu: a ghost of triangle %u, normal %g %g %g", (unsigned long long)number,
               contacts[k].triangle, contacts[k].normal.x, contacts[k].normal.y, contacts[k].normal.z);
    }
}

static void no_ghost_of_a_ball_is_told_and_no_contact_lost(void **state) {
    (void)state;
    tally seen = {0, 0, 0, 0};
    pir_workspace *workspace;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t number = 0; number < stages(); number++) {
        test_random random = test_random_case("balls and capsules", number);
        stage s;
        scene sc;
        stage_make(&s, &random, number);
        scene_take(&sc, &s);
        for (int i = 0; i < 8; i++) {
            const pir_vec3 t = some_place(&random, &s);
            const pir_vec3 core[2] = {{0, 0, 0}, plus((pir_vec3){0, 0, 0}, test_random_direction(&random), 0.5)};
            pir_polytope *body;
            assert_int_equal(pir_polytope_create(core, 1 + (size_t)(i % 2), NULL, &body), PIR_OK);
            pir_surface_contact_input input = input_of(&s, t, 0.5);
            pir_surface_contact contacts[CONTACTS];
            pir_surface_contact_result result;
            input.pose.rotation = (pir_quat){0, 0, 0, 1};
            input.pose.translation.z += 0.1 * (i / 2);
            input.radius = sc.radius = i % 4 == 3 ? 0.3 : 0.1;
            sc.a = input.pose.translation;
            sc.b = plus(sc.a, core[1], i % 2);
            assert_int_equal(pir_surface_contacts(body, workspace, &input, CONTACTS, contacts, &result), PIR_OK);
            if (is_apart(&sc))
                check_pose(&sc, contacts, result.contacts, input.margin, number, &seen);
            pir_polytope_release(body);
        }
        stage_clear(&s);
    }
    pir_workspace_destroy(workspace);
    print_message("%llu poses apart: %llu contacts, %llu ghosts, %llu unclear\n", (unsigned long long)seen.poses,
                  (unsigned long long)seen.contacts, (unsigned long long)seen.ghosts, (unsigned long long)seen.unclear);
    assert_true(seen.poses > stages() && seen.contacts > seen.poses / 2 && seen.ghosts > seen.poses);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_ghost_of_a_ball_is_told_and_no_contact_lost),
    };
    return cmocka_run_group_tests_name("contacts of balls and capsules", tests, NULL, NULL);
}
