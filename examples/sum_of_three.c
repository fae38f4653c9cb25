/* SPDX-License-Identifier: MIT */
/*
 * Adds three boxes, each turned its own way, by overlaying their cubical Gaussian maps, and asks where points are.
 *
 * An overlay is a map like any other, so a sum of three is the overlay of an overlay. Every answer is exact.
 */
#include <stdio.h>

#include <pirouette/pirouette.h>

static const char *const BOXES[3] = {"box?x=30&y=30&z=30", "box?x=15&y=30&z=45", "box?x=78&y=39&z=39"};
static const pir_quat ROTATIONS[3] = {{0, 0, 0, 1}, {1, 2, 3, 4}, {2, 1, -3, 5}};
static const pir_vec3 POINTS[] = {{0, 0, 0}, {60, 40, 0}, {45, 60, 0}, {41.5, 65.5, 32}, {41.5, 65.5, 32.0625}};

/* The map of box `i`; it keeps a reference of its own to the polytope. */
static pir_status make_map(int i, pir_cgm **ret_map) {
    pir_polytope *box = NULL;
    pir_status status = pir_shape_create(BOXES[i], NULL, NULL, &box);
    if (status == PIR_OK)
        status = pir_cgm_create(box, &ROTATIONS[i], NULL, ret_map);
    pir_polytope_release(box);
    return status;
}

static pir_status print_size(const pir_cgm *map) {
    pir_mesh *mesh = NULL;
    pir_status status = pir_cgm_mesh(map, PIR_DOUBLE, &mesh);
    if (status == PIR_OK)
        printf("vertices %u, edges %u, facets %u\n", (unsigned)pir_mesh_vertex_count(mesh),
               (unsigned)pir_mesh_edge_count(mesh), (unsigned)pir_mesh_facet_count(mesh));
    pir_mesh_destroy(mesh);
    return status;
}

static pir_status print_places(const pir_cgm *map) {
    static const char *const PLACES[] = {"outside", "boundary", "inside"};
    pir_cgm_locator *locator = NULL;
    pir_cgm_location where = {.witness = PIR_CGM_NONE};
    pir_status status = pir_cgm_locator_create(map, &locator);
    for (size_t i = 0; status == PIR_OK && i < sizeof POINTS / sizeof POINTS[0]; i++) {
        /* Each walk starts where the one before ended. */
        status = pir_cgm_locate(locator, POINTS[i], where.witness, &where);
        if (status == PIR_OK)
            printf("(%g, %g, %g) %s\n", POINTS[i].x, POINTS[i].y, POINTS[i].z, PLACES[where.position]);
    }
    pir_cgm_locator_destroy(locator);
    return status;
}

int main(void) {
    pir_cgm *maps[3] = {NULL, NULL, NULL}, *two = NULL, *three = NULL;
    pir_status status = PIR_OK;
    for (int i = 0; status == PIR_OK && i < 3; i++)
        status = make_map(i, &maps[i]);
    if (status == PIR_OK)
        status = pir_cgm_overlay(maps[0], maps[1], &two);
    if (status == PIR_OK)
        status = pir_cgm_overlay(two, maps[2], &three);
    if (status == PIR_OK)
        status = print_size(three);
    if (status == PIR_OK)
        status = print_places(three);

    if (status != PIR_OK)
        fprintf(stderr, "sum_of_three: %s\n", pir_status_text(status));
    pir_cgm_release(three);
    pir_cgm_release(two);
    for (int i = 0; i < 3; i++)
        pir_cgm_release(maps[i]);
    return status == PIR_OK ? 0 : 1;
}
