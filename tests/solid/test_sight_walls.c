/* SPDX-License-Identifier: MIT */
/*
 * Pieces by sight walls (Hachenberger 2008): they add up to the solid exactly, and there are O(r²) of them.
 *
 *     volume   of cells at random, mapped by integer matrices so that edges and facets lean all ways, of solids some of
 *              whose coordinates are moved by next to nothing, and of prisms that the suites of sums try
 *     counts   of combs, which a formula gives: r notches from above make r + 1 pieces, a from above across b from
 *              below make (a + 1)(b + 1), as each of the a walls crosses each of the b
 *
 * PIR_TEST_CASES sets how many cases there are; more than 100 try the large combs too.
 */
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#include <pirouette/exact.h>
#include <pirouette/pirouette.h>

#include "solid/bodies.h"
#include "solid/jittered.h"

/* The pieces by walls, which have the volume of the solid; how many they are. */
static uint32_t check_pieces(const pir_solid *solid, const char *name, uint64_t number) {
    pir_decompose_options options = pir_decompose_options_default();
    pir_pieces *pieces = NULL;
    mpq_t sum, volume;
    mpq_inits(sum, volume, NULL);
    options.method = PIR_DECOMPOSE_WALLS;
    const pir_status status = pir_solid_decompose(solid, &options, NULL, &pieces);
    expect(status == PIR_OK, "%s %llu: %s", name, (unsigned long long)number, pir_status_text(status));
    pieces_volume(pieces, sum);
    assert_int_equal(pir_solid_volume_exact(solid, volume), PIR_OK);
    expect(mpq_equal(sum, volume), "%s %llu: the pieces hold %.17g of %.17g", name, (unsigned long long)number,
           mpq_get_d(sum), mpq_get_d(volume));
    const uint32_t count = pir_pieces_count(pieces);
    pir_pieces_destroy(pieces);
    mpq_clears(sum, volume, NULL);
    return count;
}

/* --- volumes --- */

/* A matrix of small integers that turns nothing inside out. */
static void random_matrix(test_random *random, int m[3][3]) {
    int det = 0;
    while (det <= 0) {
        for (int i = 0; i < 9; i++)
            m[i / 3][i % 3] = test_random_between(random, -3, 3);
        det = 0;
        for (int k = 0; k < 3; k++)
            det += m[0][k] * (m[1][(k + 1) % 3] * m[2][(k + 2) % 3] - m[1][(k + 2) % 3] * m[2][(k + 1) % 3]);
    }
}

static void leaning_cells_are_their_pieces(void **state) {
    (void)state;
    for (uint64_t i = 0; i < solid_cases(60); i++) {
        test_random random = test_random_case("leaning cells", i);
        const cells of = cells_random(&random, 4 + test_random_below(&random, 20));
        static solid_facets facets;
        int m[3][3];
        facets = (solid_facets){0};
        solid_add_cells(&facets, &of);
        random_matrix(&random, m);
        for (uint32_t p = 0; p < facets.points; p++) {
            const pir_vec3 x = facets.point[p];
            double to[3];
            for (int k = 0; k < 3; k++)
                to[k] = m[k][0] * x.x + m[k][1] * x.y + m[k][2] * x.z;
            facets.point[p] = (pir_vec3){to[0], to[1], to[2]};
        }
        pir_solid *solid = solid_of_facets(&facets);
        check_pieces(solid, "leaning cells", i);
        pir_solid_release(solid);
    }
}

static void nearly_coplanar_solids_are_their_pieces(void **state) {
    (void)state;
    for (uint64_t i = 0; i < solid_cases(60); i++) {
        test_random random = test_random_case("nearly vertical", i);
        static jittered body;
        jittered_make(&body, (int)test_random_below(&random, JITTERED_BODIES));
        jittered_move(&body, &random);
        pir_solid *solid = jittered_solid(&body);
        if (solid)
            check_pieces(solid, body.name, i);
        pir_solid_release(solid);
    }
}

/* --- counts --- */

/* Facets over points that they share. */
struct comb {
    pir_vec3 *point;
    uint32_t *start, *corner, points, facets;
};

static void add_facet(struct comb *c, const uint32_t *corner, uint32_t count) {
    memcpy(c->corner + c->start[c->facets], corner, count * sizeof *corner);
    c->start[c->facets + 1] = c->start[c->facets] + count;
    c->facets++;
}

/* Points on two parallel rims: number 2i and 2i + 1 for place i, every third of which is the tip of a notch. */
static uint32_t add_rim(struct comb *c, uint32_t notches, double width, bool above) {
    const uint32_t first = c->points;
    for (uint32_t i = 0; i < 3 * notches + 2; i++) {
        const bool tip = i % 3 == 2;
        const double at = i;
        for (int k = 0; k < 2; k++)
            c->point[c->points++] = above ? (pir_vec3){at, k * width, tip ? 3 : 4} : (pir_vec3){k * width, at, tip};
    }
    return first;
}

/* A box with `above` notches from above and `below` from below, across those. */
static pir_solid *make_comb(uint32_t above, uint32_t below) {
    const uint32_t a = 3 * above + 2, b = 3 * below + 2;
    struct comb c = {.point = malloc(2 * (a + b) * sizeof *c.point),
                     .start = calloc(a + b + 8, sizeof *c.start),
                     .corner = malloc(8 * (a + b + 8) * sizeof *c.corner)};
    uint32_t *side = malloc((a + b + 8) * sizeof *side);
    assert_true(c.point && c.start && c.corner && side);
    const uint32_t top = add_rim(&c, above, b - 1, true), low = add_rim(&c, below, a - 1, false);
    for (uint32_t i = 0; i + 1 < a; i++)
        add_facet(&c, (const uint32_t[]){top + 2 * i, top + 2 * i + 2, top + 2 * i + 3, top + 2 * i + 1}, 4);
    for (uint32_t i = 0; i + 1 < b; i++)
        add_facet(&c, (const uint32_t[]){low + 2 * i, low + 2 * i + 2, low + 2 * i + 3, low + 2 * i + 1}, 4);
    for (uint32_t k = 0; k < 2; k++) {
        // the sides y = 0 and y = b − 1 end in the rim above, the others in the one below
        uint32_t count = 0;
        for (uint32_t i = 0; i < a; i++)
            side[count++] = top + 2 * (k ? i : a - 1 - i) + k;
        side[count++] = low + (k ? 2 * (b - 1) + 1 : 0);
        side[count++] = low + (k ? 2 * (b - 1) : 1);
        add_facet(&c, side, count);
        count = 0;
        for (uint32_t i = 0; i < b; i++)
            side[count++] = low + 2 * (k ? i : b - 1 - i) + k;
        side[count++] = top + (k ? 2 * (a - 1) + 1 : 0);
        side[count++] = top + (k ? 2 * (a - 1) : 1);
        add_facet(&c, side, count);
    }
    const pir_solid_facets facets = {c.point, c.points, c.start, c.corner, c.facets};
    pir_report report = {0};
    pir_solid *solid = NULL;
    expect(pir_solid_create(&facets, NULL, &report, &solid) == PIR_OK, "%s", report.text);
    free(c.point);
    free(c.start);
    free(c.corner);
    free(side);
    return solid;
}

static void check_comb(uint32_t above, uint32_t below) {
    pir_solid *solid = make_comb(above, below);
    pir_solid_info info;
    pir_solid_describe(solid, &info);
    assert_int_equal(info.reflex_edges, above + below);
    const uint32_t count = check_pieces(solid, "comb", above + below);
    expect(count == (above + 1) * (below + 1), "%u notches across %u: %u pieces", (unsigned)above, (unsigned)below,
           (unsigned)count);
    pir_solid_release(solid);
}

static void combs_have_as_many_pieces_as_their_walls_make(void **state) {
    (void)state;
    const bool all = solid_cases(0) > 100;
    for (uint32_t r = 10; r <= (all ? 1000 : 100); r *= 10)
        check_comb(r, 0);
    for (uint32_t r = 10; r <= (all ? 1000 : 30); r *= r == 10 ? 3 : 10)
        check_comb(r / 2, r / 2);
}

/* Two slabs joined at one end, with a notch in the upper one: its wall ends at the slot. */
static void wall_ends_where_sight_does(void **state) {
    (void)state;
    static const double profile[12][2] = {{0, 0}, {9, 0}, {9, 1}, {1, 1}, {1, 2}, {9, 2},
                                          {9, 4}, {6, 4}, {5, 3}, {4, 4}, {0, 4}, {0, 0}};
    static solid_facets facets;
    facets = (solid_facets){0};
    pir_vec3 front[11], back[11];
    for (int i = 0; i < 11; i++) {
        front[i] = (pir_vec3){profile[i][0], 0, profile[i][1]};
        back[10 - i] = (pir_vec3){profile[i][0], 2, profile[i][1]};
        const double *a = profile[i], *b = profile[i + 1];
        solid_add_facet(&facets, (const pir_vec3[]){{a[0], 0, a[1]}, {a[0], 2, a[1]}, {b[0], 2, b[1]}, {b[0], 0, b[1]}},
                        4);
    }
    solid_add_facet(&facets, front, 11);
    solid_add_facet(&facets, back, 11);
    pir_solid *solid = solid_of_facets(&facets);
    assert_int_equal(check_pieces(solid, "slabs", 0), 4);
    pir_solid_release(solid);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(leaning_cells_are_their_pieces),
        cmocka_unit_test(nearly_coplanar_solids_are_their_pieces),
        cmocka_unit_test(combs_have_as_many_pieces_as_their_walls_make),
        cmocka_unit_test(wall_ends_where_sight_does),
    };
    return cmocka_run_group_tests_name("sight walls", tests, NULL, NULL);
}
