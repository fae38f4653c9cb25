/* SPDX-License-Identifier: MIT */
/* See bodies.h. */
#include "solid/bodies.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/exact.h>
#include <pirouette/io.h>

#include "support/test.h"

void solid_add_facet(solid_facets *facets, const pir_vec3 *corner, uint32_t count) {
    uint32_t at = facets->start[facets->facets];
    for (uint32_t i = 0; i < count; i++) {
        facets->point[facets->points] = corner[i];
        facets->corner[at++] = facets->points++;
    }
    facets->start[++facets->facets] = at;
}

void solid_add_prism(solid_facets *facets, const double (*corner)[2], uint32_t count, double height) {
    pir_vec3 bottom[64] = {{0, 0, 0}}, top[64] = {{0, 0, 0}};
    for (uint32_t i = 0; i < count; i++) {
        top[i] = (pir_vec3){corner[i][0], corner[i][1], height};
        bottom[count - 1 - i] = (pir_vec3){corner[i][0], corner[i][1], 0};
    }
    solid_add_facet(facets, top, count);
    solid_add_facet(facets, bottom, count);
    for (uint32_t i = 0; i < count; i++) {
        const double *a = corner[i], *b = corner[i + 1 < count ? i + 1 : 0];
        solid_add_facet(
            facets, (const pir_vec3[]){{a[0], a[1], 0}, {b[0], b[1], 0}, {b[0], b[1], height}, {a[0], a[1], height}},
            4);
    }
}

pir_status solid_make(const solid_facets *facets, const pir_solid_options *options, pir_report *report,
                      pir_solid **ret_solid) {
    const pir_solid_facets all = {facets->point, facets->points, facets->start, facets->corner, facets->facets};
    return pir_solid_create(&all, options, report, ret_solid);
}

pir_solid *solid_of_facets(const solid_facets *facets) {
    pir_report report = {0};
    pir_solid *solid = NULL;
    const pir_status status = solid_make(facets, NULL, &report, &solid);
    expect(status == PIR_OK, "%s", report.text);
    return solid;
}

pir_solid_info solid_info_of(pir_solid *solid) {
    pir_solid_info info;
    pir_solid_describe(solid, &info);
    pir_solid_release(solid);
    return info;
}

/* --- cells --- */

bool cells_full(const cells *of, int x, int y, int z) {
    return x >= 0 && y >= 0 && z >= 0 && x < CELLS && y < CELLS && z < CELLS && of->full[x][y][z];
}

/* Whether the eight cells round a corner of the grid, taken as full or empty, make a surface there: those of a kind
 * hang together through sides. */
static bool is_surface(const cells *of, int x, int y, int z) {
    for (int kind = 0; kind < 2; kind++) {
        unsigned members = 0, reached = 0;
        for (int i = 0; i < 8; i++)
            if (cells_full(of, x - (i & 1), y - (i >> 1 & 1), z - (i >> 2)) == (kind == 1))
                members |= 1u << i;
        reached = members & -members;
        for (int round = 0; round < 8; round++)
            for (int i = 0; i < 8; i++)
                for (int k = 0; k < 3; k++)
                    if (reached >> i & 1)
                        reached |= members & 1u << (i ^ 1 << k);
        if (reached != members)
            return false;
    }
    return true;
}

bool cells_are_solid(const cells *of) {
    for (int x = 0; x <= CELLS; x++)
        for (int y = 0; y <= CELLS; y++)
            for (int z = 0; z <= CELLS; z++)
                if (!is_surface(of, x, y, z))
                    return false;
    return true;
}

cells cells_random(test_random *random, uint32_t count) {
    cells made;
    memset(&made, 0, sizeof made);
    made.full[1][1][1] = true;
    for (uint32_t tries = 0, full = 1; full < count && tries < 100; tries++) {
        const int x = test_random_between(random, 0, CELLS - 1), y = test_random_between(random, 0, CELLS - 1),
                  z = test_random_between(random, 0, CELLS - 1);
        if (made.full[x][y][z])
            continue;
        made.full[x][y][z] = true;
        made.full[x][y][z] = cells_are_solid(&made);
        full += made.full[x][y][z];
    }
    return made;
}

void solid_add_cells(solid_facets *facets, const cells *of) {
    for (int x = 0; x < CELLS; x++)
        for (int y = 0; y < CELLS; y++)
            for (int z = 0; z < CELLS; z++)
                for (int side = 0; side < 6 && of->full[x][y][z]; side++) {
                    const int k = side / 2, up = side % 2, at[3] = {x, y, z};
                    int beside[3] = {x, y, z};
                    beside[k] += up ? 1 : -1;
                    if (cells_full(of, beside[0], beside[1], beside[2]))
                        continue;
                    pir_vec3 corner[4];
                    for (int i = 0; i < 4; i++) {
                        // round the square counter-clockwise about +k, the other way for its lower side
                        const int turn = up ? i : 3 - i;
                        double c[3];
                        c[k] = at[k] + up;
                        c[(k + 1) % 3] = at[(k + 1) % 3] + (turn == 1 || turn == 2);
                        c[(k + 2) % 3] = at[(k + 2) % 3] + (turn >= 2);
                        corner[i] = (pir_vec3){c[0], c[1], c[2]};
                    }
                    solid_add_facet(facets, corner, 4);
                }
}

pir_solid *solid_of_cells(const cells *of) {
    static solid_facets facets;
    facets = (solid_facets){0};
    solid_add_cells(&facets, of);
    return solid_of_facets(&facets);
}

pir_status solid_try_again(const pir_mesh *mesh, pir_report *report, pir_solid **ret_solid) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    assert_int_equal(pir_mesh_write_stream(mesh, file, "again", "off", 1, NULL), PIR_OK);
    fclose(file);
    const pir_status status =
        pir_solid_read_bytes(&(pir_file_bytes){text, size, "again", "off"}, NULL, report, ret_solid);
    free(text);
    return status;
}

pir_solid *solid_read_again(const pir_mesh *mesh) {
    pir_report report = {0};
    pir_solid *solid = NULL;
    const pir_status status = solid_try_again(mesh, &report, &solid);
    expect(status == PIR_OK, "%s", report.text);
    return solid;
}

uint64_t solid_cases(uint64_t usual) {
    const char *text = getenv("PIR_TEST_CASES");
    return text ? strtoull(text, NULL, 10) : usual;
}

/* --- volumes --- */

/* Adds the determinant of three vertices; a and b are scratch. */
static void add_determinant(mpq_t sum, mpq_t *const v[3], mpq_t a, mpq_t b) {
    for (int k = 0; k < 3; k++) {
        mpq_mul(a, v[1][(k + 1) % 3], v[2][(k + 2) % 3]);
        mpq_mul(b, v[1][(k + 2) % 3], v[2][(k + 1) % 3]);
        mpq_sub(a, a, b);
        mpq_mul(a, a, v[0][k]);
        mpq_add(sum, sum, a);
    }
}

void mesh_volume(const pir_mesh *mesh, mpq_t ret_volume) {
    const uint32_t vertices = pir_mesh_vertex_count(mesh);
    mpq_t *x = malloc(3 * (size_t)vertices * sizeof *x), a, b;
    assert_non_null(x);
    mpq_inits(a, b, NULL);
    for (uint32_t v = 0; v < vertices; v++) {
        mpq_inits(x[3 * v], x[3 * v + 1], x[3 * v + 2], NULL);
        pir_mesh_vertex_exact(mesh, v, &x[3 * v]);
    }
    mpq_set_ui(ret_volume, 0, 1);
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        for (uint32_t i = 1; i + 1 < count; i++)
            add_determinant(ret_volume, (mpq_t *const[]){&x[3 * corner[0]], &x[3 * corner[i]], &x[3 * corner[i + 1]]},
                            a, b);
    }
    mpq_set_ui(a, 6, 1);
    mpq_div(ret_volume, ret_volume, a);
    mpq_clears(a, b, NULL);
    for (uint32_t k = 0; k < 3 * vertices; k++)
        mpq_clear(x[k]);
    free(x);
}

void pieces_volume(const pir_pieces *pieces, mpq_t ret_volume) {
    mpq_t volume, moment[9]; // the middle and the inertia, which nobody asks for
    mpq_init(volume);
    for (int k = 0; k < 9; k++)
        mpq_init(moment[k]);
    mpq_set_ui(ret_volume, 0, 1);
    for (uint32_t k = 0; k < pir_pieces_count(pieces); k++) {
        pir_polytope *piece = NULL;
        assert_int_equal(pir_pieces_polytope(pieces, k, &piece), PIR_OK);
        assert_int_equal(pir_polytope_mass_exact(piece, volume, moment, moment + 3), PIR_OK);
        mpq_add(ret_volume, ret_volume, volume);
        pir_polytope_release(piece);
    }
    mpq_clear(volume);
    for (int k = 0; k < 9; k++)
        mpq_clear(moment[k]);
}

void solid_check_volume(const pir_solid *solid, const mpq_t right, uint64_t number) {
    pir_pieces *pieces = NULL;
    mpq_t volume;
    mpq_init(volume);
    assert_int_equal(pir_solid_volume_exact(solid, volume), PIR_OK);
    expect(mpq_equal(volume, right), "case %llu: the volume is %g, not %g", (unsigned long long)number,
           mpq_get_d(volume), mpq_get_d(right));
    assert_int_equal(pir_solid_decompose(solid, NULL, NULL, &pieces), PIR_OK);
    pieces_volume(pieces, volume);
    expect(mpq_equal(volume, right), "case %llu: pieces have the volume %g, not %g", (unsigned long long)number,
           mpq_get_d(volume), mpq_get_d(right));
    pir_pieces_destroy(pieces);
    mpq_clear(volume);
}
