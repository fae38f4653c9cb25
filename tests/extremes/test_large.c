/* SPDX-License-Identifier: MIT */
/*
 * Large and crowded inputs:
 *
 *   - points within an ulp of a sphere, and bodies of many facets, against a box: the pairing by update is that by
 *     walk, every pair holds, and the mesh reaches as far as both bodies together, exactly, in random directions;
 *   - sums with as many facets as two bodies' edges have pairs: arcs of circles in planes across each other;
 *   - prisms on themselves, whose caps tie in every pair of sides;
 *   - the same under a bound on memory below what they need: refused with PIR_ERR_MEMORY, and nothing leaks.
 *
 * PIR_TEST_SIZE scales the sizes; 100 is that of the suite `slow`: 10^7 facets, 10^5 facets, 10^4 sides. One row each,
 * with the bytes that were asked for at most. Ends with 1 when anything failed.
 */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <pirouette/exact.h>
#include <pirouette/sum.h>

#include "extremes/situations.h"
#include "oracle/points.h"
#include "support/random.h"

#define DIRECTIONS 20

static void die(const char *what) {
    fprintf(stderr, "large: %s\n", what);
    exit(2);
}

/* --- memory within a bound --- */

typedef struct budget {
    size_t most, out, peak;
} budget;

static void *take(void *context, void *old, size_t old_size, size_t size) {
    budget *b = context;
    if (size > old_size && b->out + (size - old_size) > b->most)
        return NULL;
    void *at = NULL;
    if (size == 0)
        free(old);
    else if (!(at = realloc(old, size)))
        return NULL;
    b->out = b->out - old_size + size;
    b->peak = b->out > b->peak ? b->out : b->peak;
    return at;
}

/* --- bodies --- */

static pir_polytope *hull_of(pir_vec3 *points, size_t count) {
    pir_polytope *polytope = NULL;
    if (pir_polytope_create(points, count, NULL, &polytope) != PIR_OK)
        die("no body");
    free(points);
    return polytope;
}

static pir_vec3 *room(size_t count) {
    pir_vec3 *points = malloc(count * sizeof *points);
    if (!points)
        die("no memory");
    return points;
}

static pir_polytope *sphere(size_t count) {
    test_random random = test_random_case("large sphere", count);
    pir_vec3 *points = room(count);
    for (size_t i = 0; i < count; i++)
        points[i] = situation_near_sphere(&random);
    return hull_of(points, count);
}

static pir_polytope *box(void) {
    pir_vec3 *points = room(8);
    for (int i = 0; i < 8; i++)
        points[i] = (pir_vec3){i & 1, i & 2, i & 4};
    return hull_of(points, 8);
}

/* Half of a regular polygon of 2·sides sides, in the plane x = 0 or y = 0. */
static pir_polytope *arc(size_t sides, bool across) {
    pir_vec3 *points = room(sides + 1);
    for (size_t i = 0; i <= sides; i++) {
        double angle = 3.14159265358979323846 * (double)i / (double)sides, c = cos(angle), s = sin(angle);
        points[i] = across ? (pir_vec3){0, c, s} : (pir_vec3){c, 0, s};
    }
    return hull_of(points, sides + 1);
}

static pir_polytope *prism(size_t sides) {
    pir_vec3 *points = room(2 * sides);
    for (size_t i = 0; i < sides; i++) {
        double angle = 2 * 3.14159265358979323846 * (double)i / (double)sides, c = cos(angle), s = sin(angle);
        points[i] = (pir_vec3){c, s, 0};
        points[sides + i] = (pir_vec3){c, s, 1};
    }
    return hull_of(points, 2 * sides);
}

/* --- rows --- */

static bool failed;

static void print_row(const char *name, size_t size, double pairs, double facets, const budget *b, clock_t began,
                      const char *wrong) {
    printf("%-42s%9zu%12.4g%12.4g%12.4g%8.2f%s%s\n", name, size, pairs, facets, (double)b->peak,
           (double)(clock() - began) / CLOCKS_PER_SEC, wrong ? "  FAILED: " : "", wrong ? wrong : "");
    failed |= wrong != NULL;
}

/* The sum reaches exactly as far as both bodies together, in directions of integers. */
static const char *check_reach(const pir_sum *sum, const pir_mesh *mesh) {
    test_random random = test_random_case("reach", 0);
    oracle_points p, q, m, *sets[3] = {&p, &q, &m};
    oracle_quat rotation;
    oracle_vec n;
    mpz_t of_p, of_q, of_m;
    const char *wrong = NULL;
    mpz_inits(of_p, of_q, of_m, NULL);
    oracle_vec_init(n);
    oracle_points_from_polytope(&p, pir_sum_p(sum));
    oracle_points_from_polytope(&q, pir_sum_q(sum));
    oracle_points_from_mesh(&m, mesh);
    oracle_quat_init(rotation, pir_sum_rotation(sum));
    oracle_points_rotate(&p, rotation);
    oracle_points_common(sets, 3);
    for (int i = 0; i < DIRECTIONS; i++) {
        for (int k = 0; k < 3; k++)
            mpz_set_si(n[k], test_random_between(&random, -1000000, 1000000));
        oracle_support(of_p, &p, n);
        oracle_support(of_q, &q, n);
        oracle_support(of_m, &m, n);
        mpz_add(of_p, of_p, of_q);
        if (mpz_cmp(of_p, of_m) != 0)
            wrong = "the mesh does not reach as far as both bodies";
    }
    oracle_quat_clear(rotation);
    oracle_points_clear(&m);
    oracle_points_clear(&q);
    oracle_points_clear(&p);
    oracle_vec_clear(n);
    mpz_clears(of_p, of_q, of_m, NULL);
    return wrong;
}

static double pairs_of(const pir_sum *sum) {
    return (double)pir_polytope_facet_count(pir_sum_p(sum)) + pir_polytope_facet_count(pir_sum_q(sum)) +
           pir_sum_ee_count(sum);
}

static const char *check_sum(pir_sum *sum, pir_quat then, double *ret_facets) {
    pir_mesh *mesh = NULL;
    pir_sum *other = NULL;
    if (pir_sum_rotate(sum, then, PIR_METHOD_UPDATE) != PIR_OK || pir_sum_clone(sum, NULL, &other) != PIR_OK ||
        pir_sum_reset(other, then) != PIR_OK)
        die("no rotation");
    const char *wrong = pir_sum_same_pairing(sum, other) ? NULL : "update and walk differ";
    pir_sum_destroy(other);
    if (!wrong && !pir_sum_is_valid(sum))
        wrong = "a pair does not hold";
    if (pir_sum_mesh(sum, PIR_EXACT, &mesh) != PIR_OK)
        die("no mesh");
    *ret_facets = pir_mesh_facet_count(mesh);
    wrong = wrong ? wrong : check_reach(sum, mesh);
    pir_mesh_destroy(mesh);
    return wrong;
}

static void against_box(const char *name, size_t count) {
    pir_polytope *p = sphere(count), *q = box();
    budget b = {.most = SIZE_MAX};
    pir_allocator allocator = {take, &b};
    pir_sum_options options = pir_sum_options_default();
    pir_sum *sum = NULL;
    double facets;
    options.allocator = &allocator;
    clock_t began = clock();
    if (pir_sum_create(p, q, (pir_quat){0, 0, 0, 1}, &options, &sum) != PIR_OK)
        die("no sum");
    const char *wrong = check_sum(sum, (pir_quat){1e-3, 0, 1e-4, 1}, &facets);
    print_row(name, pir_polytope_facet_count(p), pairs_of(sum), facets, &b, began, wrong);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

/* A sum and its mesh, made, and then again in nine tenths of the memory that it took. */
static void made_and_refused(const char *name, pir_polytope *p, pir_polytope *q, size_t size, double expected) {
    budget b = {.most = SIZE_MAX};
    pir_allocator allocator = {take, &b};
    pir_sum_options options = pir_sum_options_default();
    options.allocator = &allocator;
    for (int again = 0; again < 2; again++) {
        pir_sum *sum = NULL;
        pir_mesh *mesh = NULL;
        double pairs = 0, facets = 0;
        const char *wrong = NULL;
        clock_t began = clock();
        b.most = again ? b.peak / 10 * 9 : SIZE_MAX;
        b.peak = 0;
        pir_status status = pir_sum_create(p, q, (pir_quat){0, 0, 0, 1}, &options, &sum);
        pairs = status == PIR_OK ? pairs_of(sum) : 0;
        status = status == PIR_OK ? pir_sum_mesh(sum, PIR_DOUBLE, &mesh) : status;
        if (status != (again ? PIR_ERR_MEMORY : PIR_OK))
            wrong = "another status";
        facets = mesh ? pir_mesh_facet_count(mesh) : 0;
        if (!again && facets != expected)
            wrong = "another number of facets";
        pir_mesh_destroy(mesh);
        pir_sum_destroy(sum);
        if (b.out != 0)
            wrong = "memory is left";
        print_row(again ? "  in nine tenths of that memory: refused" : name, size, pairs, facets, &b, began, wrong);
    }
    pir_polytope_release(q);
    pir_polytope_release(p);
}

int main(void) {
    const char *text = getenv("PIR_TEST_SIZE");
    double scale = text ? strtod(text, NULL) : 1, root = sqrt(scale);
    size_t sides = (size_t)(317 * root), tied = (size_t)(1000 * root);
    test_print_seed();
    printf("%-42s%9s%12s%12s%12s%8s\n", "sum", "size", "pairs", "facets", "bytes", "s");
    against_box("points within an ulp of a sphere, and a box", (size_t)(1000 * root));
    against_box("a body of many facets, and a box", (size_t)(5010 * root));
    // each side of one arc with each of the other, the chords with each other, both faces of both polygons
    made_and_refused("arcs across each other", arc(sides, false), arc(sides, true), sides, (double)(sides * sides) + 5);
    made_and_refused("a prism on itself", prism(tied), prism(tied), tied, (double)tied + 2);
    return failed;
}
