/* SPDX-License-Identifier: MIT */
/*
 * Golden histories of what is made once: slices, sums of solids, simplified polytopes, models and files.
 *
 * Of a file of slices the records, planes and vertices count, as they go into it: the bytes of the container are those
 * of a version of HDF5.
 */
#include <stdio.h>

#include <pirouette/io.h>
#include <pirouette/mass.h>
#include <pirouette/shape.h>
#include <pirouette/simplify.h>
#include <pirouette/solid.h>

#include "cspace/parts/maker.h"
#include "golden/golden.h"
#include "support/bodies.h"
#include "support/meshes.h"
#include "support/solid_sums.h"

/* --- slices --- */

uint64_t golden_slices(uint64_t number) {
    test_random random = golden_random(4, number);
    pir_polytope *robot = test_random_polytope(&random, number % 3 ? TEST_SPHERE : TEST_GRID, 16);
    pir_polytope *obstacle = test_random_polytope(&random, number % 4 ? TEST_BALL : TEST_BOX, 16);
    const pir_cspace_bodies bodies = {&robot, 1, &obstacle, 1};
    pir_cspace_options options = pir_cspace_options_default();
    options.slices_per_unit = 24;
    options.slices_per_key = 8;
    options.planes = options.vertices = true;
    pir_grid *grid;
    pir_plan plan;
    pir_maker maker;
    if (number % 2)
        golden_require(pir_grid_axis((pir_vec3){1, 2, 3}, 48, NULL, &grid), "pir_grid_axis");
    else
        golden_require(pir_grid_hopf(0, NULL, &grid), "pir_grid_hopf");
    golden_require(pir_plan_init(&plan, &bodies, grid, &options, NULL), "pir_plan_init");
    golden_require(pir_maker_init(&maker, &plan) ? PIR_OK : PIR_ERR_MEMORY, "pir_maker_init");
    uint64_t hash = golden_number(TEST_HASH_START, plan.hash);
    for (uint64_t unit = 0; unit < plan.units && unit < 2; unit++) {
        golden_require(pir_maker_make(&maker, unit, plan.slices_per_unit), "pir_maker_make");
        for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++) {
            const pir_bytes *bytes = &maker.unit.data[s];
            hash = golden_number(hash, pir_unit_elements(&maker.unit, s));
            if (s == PIR_UNIT_SECTION_RECORDS)
                hash = golden_bytes(hash, bytes->data, bytes->used);
            else
                for (size_t i = 0; i < bytes->used / sizeof(double); i++)
                    hash = golden_double(hash, ((const double *)(const void *)bytes->data)[i]);
        }
    }
    pir_maker_finish(&maker);
    pir_plan_finish(&plan);
    pir_grid_destroy(grid);
    pir_polytope_release(obstacle);
    pir_polytope_release(robot);
    return hash;
}

/* --- solids --- */

/* A prism over an L of random sides: whole numbers, or halves. */
static pir_solid *solid_of(test_random *random) {
    static const uint32_t starts[9] = {0, 6, 12, 16, 20, 24, 28, 32, 36};
    double by = test_random_below(random, 2) ? 1 : 0.5;
    double a = by * test_random_between(random, 2, 5), b = by * test_random_between(random, 2, 5), c = by, d = by;
    double height = by * test_random_between(random, 1, 3);
    const double corner[6][2] = {{0, 0}, {a, 0}, {a, d}, {c, d}, {c, b}, {0, b}};
    pir_vec3 points[12];
    uint32_t corners[36], at = 0;
    for (uint32_t i = 0; i < 6; i++) {
        points[i] = (pir_vec3){corner[i][0], corner[i][1], 0};
        points[6 + i] = (pir_vec3){corner[i][0], corner[i][1], height};
        corners[i] = 6 + i;
        corners[6 + i] = 5 - i;
    }
    at = 12;
    for (uint32_t i = 0; i < 6; i++) {
        uint32_t next = (i + 1) % 6;
        corners[at++] = i;
        corners[at++] = next;
        corners[at++] = 6 + next;
        corners[at++] = 6 + i;
    }
    const pir_solid_facets facets = {points, 12, starts, corners, 8};
    pir_solid *solid;
    golden_require(pir_solid_create(&facets, NULL, NULL, &solid), "pir_solid_create");
    return solid;
}

uint64_t golden_solid(uint64_t number) {
    test_random random = golden_random(5, number);
    pir_solid *p = solid_of(&random), *q = solid_of(&random);
    pir_solid_sum_options options = pir_solid_sum_options_default();
    options.difference = number % 2 != 0;
    options.open = number % 3 == 0;
    pir_quat r = number % 2 ? test_integer_rotation(&random) : test_general_rotation(&random);
    pir_solid_sum_info info;
    pir_mesh *mesh;
    golden_require(solid_sum_mesh(p, q, r, &options, &info, &mesh), "pir_solid_sum_mesh");
    uint64_t hash = test_hash_mesh(TEST_HASH_START, mesh);
    hash = golden_number(golden_number(golden_number(hash, info.holes), info.two_sided), info.survivors);
    pir_mesh_destroy(mesh);
    pir_solid_release(q);
    pir_solid_release(p);
    return hash;
}

/* --- polytopes and files --- */

uint64_t golden_simplify(uint64_t number) {
    test_random random = golden_random(6, number);
    pir_polytope *polytope = test_sphere(&random, 40 + 5 * number);
    pir_simplify_options options = pir_simplify_options_default();
    options.vertices = (uint32_t)(8 + 2 * number);
    pir_simplified simplified;
    golden_require(pir_polytope_simplify(polytope, &options, &simplified), "pir_polytope_simplify");
    uint64_t hash = golden_double(golden_polytope(TEST_HASH_START, simplified.inner), simplified.inner_error);
    hash = golden_double(golden_polytope(hash, simplified.outer), simplified.outer_error);
    pir_simplified_release(&simplified);
    pir_polytope_release(polytope);
    return hash;
}

static uint64_t hash_of_text(uint64_t hash, const pir_mesh *mesh, const char *format, int exact) {
    FILE *file = tmpfile();
    if (!file)
        golden_require(PIR_ERR_FILE, "tmpfile");
    golden_require(pir_mesh_write_stream(mesh, file, "golden", format, exact, NULL), "pir_mesh_write_stream");
    rewind(file);
    for (int byte = getc(file); byte != EOF; byte = getc(file))
        hash = golden_bytes(hash, &(uint8_t){(uint8_t)byte}, 1);
    fclose(file);
    return hash;
}

uint64_t golden_file(uint64_t number) {
    test_random random = golden_random(7, number);
    const char *name = pir_shape_name((size_t)(3 * number) % pir_shape_count());
    pir_polytope *p, *q = test_random_polytope(&random, TEST_GRID, 20), *turned;
    pir_mass mass;
    golden_require(pir_shape_create(name, NULL, NULL, &p), name);
    uint64_t hash = golden_polytope(TEST_HASH_START, p);
    golden_require(pir_polytope_mass(p, &mass), "pir_polytope_mass");
    hash = golden_vector(golden_double(hash, mass.volume), mass.centroid);
    pir_pose pose = {test_integer_rotation(&random), {1, 2, 3}};
    golden_require(pir_polytope_transform(q, pose, &turned), "pir_polytope_transform");
    pir_sum *sum;
    pir_mesh *mesh;
    golden_require(pir_sum_create(p, turned, test_general_rotation(&random), NULL, &sum), "pir_sum_create");
    golden_require(pir_sum_mesh(sum, PIR_EXACT, &mesh), "pir_sum_mesh");
    hash = hash_of_text(hash_of_text(hash, mesh, "off", 0), mesh, "off", 1);
    hash = hash_of_text(hash, mesh, "svg", 0);
    pir_mesh_destroy(mesh);
    pir_sum_destroy(sum);
    pir_polytope_release(turned);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return hash;
}
