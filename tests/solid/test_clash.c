/* SPDX-License-Identifier: MIT */
/*
 * Clashes and certificates of solids of unit cubes, which an oracle counts cube by cube: the state, what is shared, the
 * volume, whether one is within the other, and into how many parts each falls without the other. All of it stays so
 * when both are mapped by one integer matrix, the volume times its determinant: so edges and facets lean all ways.
 *
 * PIR_TEST_CASES sets how many cases there are.
 */
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#include <pirouette/exact.h>
#include <pirouette/pirouette.h>

#include "solid/bodies.h"
#include "support/memory.h"

#define GRID (3 * CELLS)

/* Cubes of two bodies in one grid: bit 0 those of A, bit 1 those of B. */
struct grid {
    uint8_t at[GRID][GRID][GRID];
};

struct place {
    int offset[3], matrix[3][3], det;
};

static void random_place(test_random *random, struct place *place) {
    place->det = 0;
    while (place->det <= 0) {
        for (int i = 0; i < 9; i++)
            place->matrix[i / 3][i % 3] = test_random_between(random, -3, 3);
        place->det = 0;
        for (int k = 0; k < 3; k++)
            place->det += place->matrix[0][k] * (place->matrix[1][(k + 1) % 3] * place->matrix[2][(k + 2) % 3] -
                                                 place->matrix[1][(k + 2) % 3] * place->matrix[2][(k + 1) % 3]);
    }
    // within the grid: A stands in its middle
    for (int k = 0; k < 3; k++)
        place->offset[k] = test_random_between(random, -CELLS, CELLS);
}

/* The solid of cells, moved and mapped. */
static pir_solid *placed(const cells *of, const struct place *place, bool moved) {
    static solid_facets facets;
    facets = (solid_facets){0};
    solid_add_cells(&facets, of);
    for (uint32_t p = 0; p < facets.points; p++) {
        const pir_vec3 x = facets.point[p];
        const double at[3] = {x.x + (moved ? place->offset[0] : 0), x.y + (moved ? place->offset[1] : 0),
                              x.z + (moved ? place->offset[2] : 0)};
        double to[3];
        for (int k = 0; k < 3; k++)
            to[k] = place->matrix[k][0] * at[0] + place->matrix[k][1] * at[1] + place->matrix[k][2] * at[2];
        facets.point[p] = (pir_vec3){to[0], to[1], to[2]};
    }
    return solid_of_facets(&facets);
}

static void fill(struct grid *grid, const cells *of, const int offset[3], uint8_t bit) {
    for (int x = 0; x < CELLS; x++)
        for (int y = 0; y < CELLS; y++)
            for (int z = 0; z < CELLS; z++)
                if (cells_full(of, x, y, z))
                    grid->at[CELLS + x + offset[0]][CELLS + y + offset[1]][CELLS + z + offset[2]] |= bit;
}

/* How many cubes have all bits of `with` and none of `without`. */
static int count_cubes(const struct grid *grid, uint8_t with, uint8_t without) {
    int count = 0;
    for (int i = 0; i < GRID * GRID * GRID; i++) {
        const uint8_t at = ((const uint8_t *)grid->at)[i];
        count += (at & with) == with && !(at & without);
    }
    return count;
}

static bool is_in(int x, int y, int z) {
    return x >= 0 && y >= 0 && z >= 0 && x < GRID && y < GRID && z < GRID;
}

/* Marks the part that a cube is in, by bit 7. */
static void flood(struct grid *grid, int x, int y, int z, uint8_t with, uint8_t without) {
    if (!is_in(x, y, z) || (grid->at[x][y][z] & with) != with || grid->at[x][y][z] & (without | 128))
        return;
    grid->at[x][y][z] |= 128;
    for (int k = 0; k < 6; k++) {
        const int step = k % 2 ? 1 : -1;
        flood(grid, x + (k / 2 == 0) * step, y + (k / 2 == 1) * step, z + (k / 2 == 2) * step, with, without);
    }
}

/* Into how many parts, joined by faces, the cubes with these bits fall. */
static int count_parts(const struct grid *of, uint8_t with, uint8_t without) {
    struct grid grid = *of;
    int parts = 0;
    for (int i = 0; i < GRID * GRID * GRID; i++) {
        const int x = i / (GRID * GRID), y = i / GRID % GRID, z = i % GRID;
        if ((grid.at[x][y][z] & with) != with || grid.at[x][y][z] & (without | 128))
            continue;
        flood(&grid, x, y, z, with, without);
        parts++;
    }
    return parts;
}

/* The dimension of what cubes of A and of B share: that of the nearest two less the axes along which they differ. */
static int shared_dimension(const struct grid *grid) {
    int dimension = -1;
    for (int i = 0; i < GRID * GRID * GRID; i++) {
        const int x = i / (GRID * GRID), y = i / GRID % GRID, z = i % GRID;
        if (!(grid->at[x][y][z] & 1))
            continue;
        for (int n = 0; n < 27; n++) {
            const int d[3] = {n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1};
            const int own = 3 - abs(d[0]) - abs(d[1]) - abs(d[2]);
            if (is_in(x + d[0], y + d[1], z + d[2]) && grid->at[x + d[0]][y + d[1]][z + d[2]] & 2 && own > dimension)
                dimension = own;
        }
    }
    return dimension;
}

static pir_clash_kind kind_of(const struct grid *grid) {
    const int shared = count_cubes(grid, 3, 0), only_a = count_cubes(grid, 1, 2), only_b = count_cubes(grid, 2, 1);
    if (shared == 0)
        return shared_dimension(grid) < 0 ? PIR_CLASH_APART : PIR_CLASH_TOUCHING;
    if (only_a == 0 || only_b == 0)
        return only_a == only_b ? PIR_CLASH_DUPLICATE : PIR_CLASH_ENVELOPE;
    const bool cut =
        count_parts(grid, 1, 2) > count_parts(grid, 1, 0) || count_parts(grid, 2, 1) > count_parts(grid, 2, 0);
    return cut ? PIR_CLASH_PIERCING : PIR_CLASH_PROTRUSION;
}

struct bodies_at {
    pir_solid *solid[2];
    pir_clash_body *body[2];
    struct grid grid;
    struct place place;
};

static void make_case(struct bodies_at *c, uint64_t number) {
    test_random random = test_random_case("clash", number);
    cells of[2] = {cells_random(&random, 2 + test_random_below(&random, 30)),
                   cells_random(&random, 1 + test_random_below(&random, 12))};
    random_place(&random, &c->place);
    if (number % 8 == 1) {
        // B in a full cube, or nearly
        memset(of[0].full, 1, sizeof of[0].full);
        for (int k = 0; k < 3; k++)
            c->place.offset[k] = test_random_between(&random, -1, 1);
    }
    const bool same = test_random_below(&random, 8) == 0;
    if (same)
        memset(c->place.offset, 0, sizeof c->place.offset);
    c->grid = (struct grid){0};
    for (int k = 0; k < 2; k++) {
        c->solid[k] = placed(&of[same ? 0 : k], &c->place, k == 1);
        fill(&c->grid, &of[same ? 0 : k], k == 1 ? c->place.offset : (const int[3]){0}, (uint8_t)(1 << k));
        assert_int_equal(pir_clash_body_create(c->solid[k], NULL, &c->body[k]), PIR_OK);
    }
}

static void end_case(struct bodies_at *c) {
    for (int k = 0; k < 2; k++) {
        pir_clash_body_destroy(c->body[k]);
        pir_solid_release(c->solid[k]);
    }
}

static void verdicts_are_those_of_the_cubes(void **state) {
    (void)state;
    pir_workspace *workspace = NULL;
    unsigned seen[6] = {0};
    mpq_t volume;
    mpq_init(volume);
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t i = 0; i < solid_cases(120); i++) {
        static struct bodies_at c;
        pir_clash_verdict v, back;
        make_case(&c, i);
        assert_int_equal(pir_clash(c.body[0], c.body[1], workspace, &v), PIR_OK);
        assert_int_equal(pir_clash(c.body[1], c.body[0], workspace, &back), PIR_OK);
        assert_int_equal(pir_clash_volume_exact(c.body[0], c.body[1], volume), PIR_OK);
        const pir_clash_kind kind = kind_of(&c.grid);
        const int shared = count_cubes(&c.grid, 3, 0);
        seen[kind]++;
        expect(v.kind == kind && back.kind == kind, "case %llu: kind %d and %d, not %d", (unsigned long long)i,
               (int)v.kind, (int)back.kind, (int)kind);
        expect(v.dimension == shared_dimension(&c.grid), "case %llu: dimension %d, not %d", (unsigned long long)i,
               v.dimension, shared_dimension(&c.grid));
        expect(mpq_cmp_si(volume, (long)shared * c.place.det, 1) == 0 && v.volume == shared * (double)c.place.det,
               "case %llu: volume %g, not %d", (unsigned long long)i, v.volume, shared * c.place.det);
        expect((v.kind == PIR_CLASH_APART) == (v.distance > 0), "case %llu: distance %g", (unsigned long long)i,
               v.distance);
        const bool clash = kind > PIR_CLASH_TOUCHING;
        expect(clash == (v.depth > 0), "case %llu: depth %g", (unsigned long long)i, v.depth);
        assert_int_equal(v.a_in_b, clash && count_cubes(&c.grid, 1, 2) == 0);
        assert_int_equal(v.b_in_a, clash && count_cubes(&c.grid, 2, 1) == 0);
        assert_int_equal(v.a_is_cut, back.b_is_cut);
        assert_int_equal(v.a_is_cut, clash && count_parts(&c.grid, 1, 2) > count_parts(&c.grid, 1, 0));
        assert_int_equal(v.b_is_cut, clash && count_parts(&c.grid, 2, 1) > count_parts(&c.grid, 2, 0));
        end_case(&c);
    }
    for (int kind = 0; kind < 6; kind++)
        expect(seen[kind] > 0 || solid_cases(120) < 120, "no case of kind %d", kind);
    pir_workspace_destroy(workspace);
    mpq_clear(volume);
}

/* The polytopes of a solid's pieces, some left out, some twice, and one of another solid. */
static void certificates_are_those_of_the_cubes(void **state) {
    (void)state;
    mpq_t added, lost;
    mpq_inits(added, lost, NULL);
    for (uint64_t i = 0; i < solid_cases(60); i++) {
        static struct bodies_at c;
        pir_polytope *piece[128] = {NULL};
        uint32_t count = 0;
        pir_pieces *pieces = NULL;
        make_case(&c, i);
        assert_int_equal(pir_solid_decompose(c.solid[1], NULL, NULL, &pieces), PIR_OK);
        for (uint32_t k = 0; k < pir_pieces_count(pieces) && count < 128; k++)
            assert_int_equal(pir_pieces_polytope(pieces, k, &piece[count++]), PIR_OK);
        piece[count] = pir_polytope_retain(piece[0]); // twice: it counts once
        count++;
        assert_int_equal(pir_solid_certify_exact(c.solid[0], piece, count, NULL, added, lost), PIR_OK);
        const long want[2] = {(long)count_cubes(&c.grid, 2, 1) * c.place.det,
                              (long)count_cubes(&c.grid, 1, 2) * c.place.det};
        expect(mpq_cmp_si(added, want[0], 1) == 0, "case %llu: added %g, not %ld", (unsigned long long)i,
               mpq_get_d(added), want[0]);
        expect(mpq_cmp_si(lost, want[1], 1) == 0, "case %llu: lost %g, not %ld", (unsigned long long)i, mpq_get_d(lost),
               want[1]);
        for (uint32_t k = 0; k < count; k++)
            pir_polytope_release(piece[k]);
        pir_pieces_destroy(pieces);
        end_case(&c);
    }
    mpq_clears(added, lost, NULL);
}

static void pairs_are_those_whose_boxes_are_near(void **state) {
    (void)state;
    enum { COUNT = 40 };
    test_random random = test_random_case("clash pairs", 0);
    pir_clash_body *body[COUNT];
    double low[COUNT][3];
    for (int i = 0; i < COUNT; i++) {
        struct place place = {.matrix = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .det = 1};
        cells of = {.full = {{{true}}}};
        for (int k = 0; k < 3; k++)
            low[i][k] = place.offset[k] = test_random_between(&random, 0, 9);
        pir_solid *solid = placed(&of, &place, true);
        assert_int_equal(pir_clash_body_create(solid, NULL, &body[i]), PIR_OK);
        pir_solid_release(solid);
    }
    for (int within = 0; within < 3; within++) {
        pir_clash_pair pair[COUNT * COUNT];
        size_t count = 0, at = 0, all = 0;
        assert_int_equal(pir_clash_pairs(body, COUNT, within, COUNT * COUNT, pair, &count), PIR_OK);
        assert_int_equal(pir_clash_pairs(body, COUNT, within, 0, NULL, &all), PIR_OK);
        assert_int_equal(all, count);
        for (uint32_t i = 0; i < COUNT; i++)
            for (uint32_t j = i + 1; j < COUNT; j++) {
                bool near = true;
                for (int k = 0; k < 3; k++)
                    near = near && low[i][k] - low[j][k] <= 1 + within && low[j][k] - low[i][k] <= 1 + within;
                if (!near)
                    continue;
                expect(at < count && pair[at].a == i && pair[at].b == j, "within %d: %u and %u", within, (unsigned)i,
                       (unsigned)j);
                at++;
            }
        assert_int_equal(at, count);
    }
    size_t count;
    assert_int_equal(pir_clash_pairs(body, COUNT, -1, 0, NULL, &count), PIR_ERR_ARGUMENT);
    for (int i = 0; i < COUNT; i++)
        pir_clash_body_destroy(body[i]);
}

/* Bodies, a verdict, a volume, pieces by walls and a certificate, with memory from one allocator. */
static pir_status all_calls(pir_solid *const solid[2], pir_polytope *piece, const pir_allocator *allocator) {
    pir_solid_options options = pir_solid_options_default();
    pir_decompose_options how = pir_decompose_options_default();
    pir_clash_body *body[2] = {NULL, NULL};
    pir_workspace *workspace = NULL;
    pir_pieces *pieces = NULL;
    pir_clash_verdict verdict;
    mpq_t volume, lost;
    mpq_inits(volume, lost, NULL);
    options.allocator = how.allocator = allocator;
    how.method = PIR_DECOMPOSE_WALLS;
    pir_status status = pir_workspace_create(allocator, &workspace);
    for (int k = 0; k < 2 && status == PIR_OK; k++)
        status = pir_clash_body_create(solid[k], &options, &body[k]);
    if (status == PIR_OK)
        status = pir_clash(body[0], body[1], workspace, &verdict);
    if (status == PIR_OK)
        status = pir_clash_volume_exact(body[0], body[1], volume);
    if (status == PIR_OK)
        status = pir_solid_certify_exact(solid[0], &piece, 1, &options, volume, lost);
    if (status == PIR_OK)
        status = pir_solid_decompose(solid[0], &how, NULL, &pieces);
    pir_pieces_destroy(pieces);
    pir_clash_body_destroy(body[0]);
    pir_clash_body_destroy(body[1]);
    pir_workspace_destroy(workspace);
    mpq_clears(volume, lost, NULL);
    return status;
}

static void every_failing_request_is_survived(void **state) {
    (void)state;
    static struct bodies_at c;
    pir_polytope *piece = NULL;
    make_case(&c, 3);
    assert_int_equal(pir_shape_create("cube", NULL, NULL, &piece), PIR_OK);
    bool done = false;
    uint64_t fail_at = 1;
    // the first requests one by one, later ones at growing steps
    for (; !done; fail_at += 1 + fail_at / 40) {
        test_memory memory = {.fail_at = fail_at};
        const pir_allocator allocator = test_allocator(&memory);
        const pir_status status = all_calls(c.solid, piece, &allocator);
        done = memory.requests < fail_at;
        expect(status == (done ? PIR_OK : PIR_ERR_MEMORY), "request %llu: status %d", (unsigned long long)fail_at,
               (int)status);
        expect(memory.blocks == 0 && !memory.wrong_size, "request %llu: %zu blocks left", (unsigned long long)fail_at,
               memory.blocks);
    }
    expect(fail_at > 100, "%llu requests", (unsigned long long)fail_at);
    pir_polytope_release(piece);
    end_case(&c);
}

static void bad_input_is_refused(void **state) {
    (void)state;
    pir_clash_body *body = NULL;
    pir_clash_verdict verdict;
    mpq_t volume;
    mpq_init(volume);
    assert_int_equal(pir_clash_body_create(NULL, NULL, &body), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_clash(NULL, NULL, NULL, &verdict), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_clash_volume_exact(NULL, NULL, volume), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_certify_exact(NULL, NULL, 0, NULL, volume, volume), PIR_ERR_ARGUMENT);
    pir_clash_body_destroy(NULL);
    mpq_clear(volume);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(verdicts_are_those_of_the_cubes),
        cmocka_unit_test(certificates_are_those_of_the_cubes),
        cmocka_unit_test(pairs_are_those_whose_boxes_are_near),
        cmocka_unit_test(every_failing_request_is_survived),
        cmocka_unit_test(bad_input_is_refused),
    };
    return cmocka_run_group_tests_name("clashes of solids", tests, NULL, NULL);
}
