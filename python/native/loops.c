/* SPDX-License-Identifier: MIT */
/* Loops over public functions: see loops.h. */
#include "loops.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/exact.h>

void py_polytope_vertices(const pir_polytope *polytope, pir_vec3 *ret_vertices) {
    for (uint32_t v = 0; v < pir_polytope_vertex_count(polytope); v++)
        ret_vertices[v] = pir_polytope_vertex(polytope, v);
}

void py_polytope_edges(const pir_polytope *polytope, uint32_t *ret_edges) {
    for (uint32_t e = 0; e < pir_polytope_edge_count(polytope); e++)
        pir_polytope_edge(polytope, e, ret_edges + 2 * (size_t)e);
}

void py_polytope_normals(const pir_polytope *polytope, pir_vec3 *ret_normals) {
    for (uint32_t f = 0; f < pir_polytope_facet_count(polytope); f++)
        ret_normals[f] = pir_polytope_normal(polytope, f);
}

void py_polytope_starts(const pir_polytope *polytope, uint32_t *ret_starts) {
    ret_starts[0] = 0;
    for (uint32_t f = 0; f < pir_polytope_facet_count(polytope); f++)
        ret_starts[f + 1] = ret_starts[f] + pir_polytope_facet_size(polytope, f);
}

void py_polytope_corners(const pir_polytope *polytope, uint32_t *ret_corners) {
    for (uint32_t f = 0; f < pir_polytope_facet_count(polytope); f++) {
        pir_polytope_facet(polytope, f, ret_corners);
        ret_corners += pir_polytope_facet_size(polytope, f);
    }
}

void py_mesh_starts(const pir_mesh *mesh, uint32_t *ret_starts) {
    ret_starts[0] = 0;
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        uint32_t count;
        pir_mesh_facet(mesh, f, &count);
        ret_starts[f + 1] = ret_starts[f] + count;
    }
}

void py_mesh_corners(const pir_mesh *mesh, uint32_t *ret_corners) {
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        uint32_t count;
        const uint32_t *corners = pir_mesh_facet(mesh, f, &count);
        memcpy(ret_corners, corners, count * sizeof *corners);
        ret_corners += count;
    }
}

void py_mesh_kinds(const pir_mesh *mesh, uint8_t *ret_kinds) {
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++)
        ret_kinds[f] = (uint8_t)pir_mesh_facet_kind(mesh, f);
}

void py_trimesh_triangles(const pir_trimesh *mesh, double *ret_corners, uint32_t *ret_materials) {
    pir_trimesh_info info;
    pir_trimesh_describe(mesh, &info);
    for (uint32_t t = 0; t < info.triangles; t++) {
        pir_triangle_corners triangle;
        if (pir_trimesh_triangle(mesh, t, &triangle) == PIR_OK) {
            memcpy(ret_corners + 9 * (size_t)t, triangle.corner, sizeof triangle.corner);
            ret_materials[t] = triangle.material;
        }
    }
}

static int rational_text(mpq_t coordinates[3], pir_status status, size_t size, char *text) {
    int length = -1;
    if (status == PIR_OK)
        length = gmp_snprintf(text, size, "%Qd %Qd %Qd", coordinates[0], coordinates[1], coordinates[2]);
    mpq_clears(coordinates[0], coordinates[1], coordinates[2], NULL);
    return length;
}

int py_mesh_vertex_text(const pir_mesh *mesh, uint32_t vertex, size_t size, char *text) {
    mpq_t coordinates[3];
    mpq_inits(coordinates[0], coordinates[1], coordinates[2], NULL);
    return rational_text(coordinates, pir_mesh_vertex_exact(mesh, vertex, coordinates), size, text);
}

int py_polytope_vertex_text(const pir_polytope *polytope, uint32_t vertex, size_t size, char *text) {
    mpq_t coordinates[3];
    mpq_inits(coordinates[0], coordinates[1], coordinates[2], NULL);
    pir_polytope_vertex_exact(polytope, vertex, coordinates);
    return rational_text(coordinates, PIR_OK, size, text);
}

pir_status py_polytope_of_text(const char *text, size_t count, pir_polytope **ret_polytope) {
    mpq_t *coordinates = malloc((3 * count + 1) * sizeof *coordinates);
    if (!coordinates)
        return PIR_ERR_MEMORY;
    pir_status status = PIR_OK;
    for (size_t i = 0; i < 3 * count; i++) {
        mpq_init(coordinates[i]);
        if (mpq_set_str(coordinates[i], text, 10) != 0 || mpz_sgn(mpq_denref(coordinates[i])) == 0) {
            mpq_set_ui(coordinates[i], 0, 1);
            status = PIR_ERR_ARGUMENT;
        }
        mpq_canonicalize(coordinates[i]);
        text += strlen(text) + 1;
    }
    if (status == PIR_OK)
        status = pir_polytope_create_exact((const mpq_t *)coordinates, count, NULL, ret_polytope);
    for (size_t i = 0; i < 3 * count; i++)
        mpq_clear(coordinates[i]);
    free(coordinates);
    return status;
}

void py_live_mesh_starts(const pir_live_mesh *live, uint32_t *ret_starts) {
    ret_starts[0] = 0;
    for (uint32_t slot = 0; slot < pir_live_mesh_facet_slots(live); slot++) {
        uint32_t count;
        pir_live_mesh_facet(live, slot, &count);
        ret_starts[slot + 1] = ret_starts[slot] + count;
    }
}

void py_live_mesh_corners(const pir_live_mesh *live, uint32_t *ret_corners) {
    for (uint32_t slot = 0; slot < pir_live_mesh_facet_slots(live); slot++) {
        uint32_t count;
        const uint32_t *corners = pir_live_mesh_facet(live, slot, &count);
        if (count > 0)
            memcpy(ret_corners, corners, count * sizeof *corners);
        ret_corners += count;
    }
}

pir_status py_query_penetrations(pir_query *query, const double *translations, size_t count,
                                 pir_query_result *ret_results, size_t *ret_done) {
    pir_query_input input = pir_query_input_default();
    pir_query_cache cache;
    memset(&cache, 0, sizeof cache);
    pir_status status = PIR_OK;
    size_t i = 0;
    for (; i < count && status == PIR_OK; i += status == PIR_OK) {
        input.translation = (pir_vec3){translations[3 * i], translations[3 * i + 1], translations[3 * i + 2]};
        status = pir_query_penetration(query, &input, &cache, &ret_results[i]);
    }
    *ret_done = i;
    return status;
}

void py_sum_ee(const pir_sum *sum, uint32_t *ret_pairs) {
    pir_sum_ee(sum, (uint32_t(*)[2])ret_pairs);
}

static pir_vec3 vector(const double *numbers) {
    return (pir_vec3){numbers[0], numbers[1], numbers[2]};
}

pir_status py_surface_rays(const pir_trimesh *mesh, const pir_height_field *field, const double *rays,
                           pir_ray_sides sides, size_t count, pir_ray_hit *ret_hits, size_t *ret_done) {
    const pir_surface_ref surface = {mesh, field};
    pir_status status = PIR_OK;
    size_t i = 0;
    for (; i < count && status == PIR_OK; i += status == PIR_OK) {
        const pir_surface_ray ray = {vector(rays + 6 * i), vector(rays + 6 * i + 3), sides};
        status = pir_surface_ray_nearest(surface, &ray, &ret_hits[i]);
    }
    *ret_done = i;
    return status;
}

pir_status py_surface_nearest(const pir_trimesh *mesh, const pir_height_field *field, const double *points,
                              double cutoff, size_t count, pir_surface_nearest *ret_nearest, size_t *ret_done) {
    const pir_surface_ref surface = {mesh, field};
    pir_status status = PIR_OK;
    size_t i = 0;
    for (; i < count && status == PIR_OK; i += status == PIR_OK)
        status = pir_surface_nearest_point(surface, vector(points + 3 * i), cutoff, &ret_nearest[i]);
    *ret_done = i;
    return status;
}

size_t py_scene_contact_count(const pir_scene *scene) {
    size_t events = 0, contacts = 0;
    const pir_scene_event *event = pir_scene_events(scene, &events);
    for (size_t i = 0; i < events; i++)
        contacts += event[i].contact_count;
    return contacts;
}

void py_scene_contacts(const pir_scene *scene, uint64_t *ret_starts, pir_contact *ret_contacts) {
    size_t events = 0;
    const pir_scene_event *event = pir_scene_events(scene, &events);
    ret_starts[0] = 0;
    for (size_t i = 0; i < events; i++) {
        if (event[i].contact_count > 0)
            memcpy(ret_contacts + ret_starts[i], event[i].contacts, event[i].contact_count * sizeof *ret_contacts);
        ret_starts[i + 1] = ret_starts[i] + event[i].contact_count;
    }
}

static pir_pose pose(const double *numbers) {
    return (pir_pose){{numbers[0], numbers[1], numbers[2], numbers[3]}, vector(numbers + 4)};
}

pir_status py_solid_contacts(pir_solid_contacts *contacts, pir_workspace *workspace, const double *poses, size_t count,
                             double margin, py_contact_room *room) {
    pir_pair_input input = pir_pair_input_default();
    input.margin = margin;
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        room->done = i;
        input.pose_p = pose(poses + 14 * i);
        input.pose_q = pose(poses + 14 * i + 7);
        size_t found = 0;
        const pir_status status =
            pir_solid_contacts_find(contacts, workspace, &input, room->capacity - used, room->contacts + used, &found);
        if (status != PIR_OK)
            return status;
        room->counts[i] = found;
        if (found > room->capacity - used)
            return PIR_OK;
        used += found;
    }
    room->done = count;
    return PIR_OK;
}

pir_status py_pair_curvatures(pir_pair *pair, pir_workspace *workspace, const py_posed *posed,
                              pir_curvature *ret_curvatures, size_t *ret_done) {
    pir_pair_input input = pir_pair_input_default();
    input.cutoff = posed->cutoff;
    input.radius_p = posed->radius_p;
    input.radius_q = posed->radius_q;
    pir_status status = PIR_OK;
    size_t i = 0;
    for (; i < posed->count && status == PIR_OK; i += status == PIR_OK) {
        pir_query_result result;
        pir_gradient gradient;
        input.pose_p = pose(posed->poses + 14 * i);
        input.pose_q = pose(posed->poses + 14 * i + 7);
        ret_curvatures[i].is_known = false;
        if (posed->statuses[i] == 0)
            status = pir_pair_gradient(pair, workspace, &input, &result, &gradient, &ret_curvatures[i]);
    }
    *ret_done = i;
    return status;
}

pir_status py_pair_active(pir_pair *pair, pir_workspace *workspace, const double *poses, double slack, size_t capacity,
                          pir_active *ret_active, size_t *ret_count) {
    pir_pair_input input = pir_pair_input_default();
    input.pose_p = pose(poses);
    input.pose_q = pose(poses + 7);
    return pir_pair_active(pair, workspace, &input, slack, capacity, ret_active, ret_count);
}

pir_status py_plan_write(const pir_path_plan *plan, const char *path) {
    FILE *file = fopen(path, "w");
    if (!file)
        return PIR_ERR_FILE;
    const pir_status status = pir_path_plan_write(plan, file);
    return fclose(file) != 0 && status == PIR_OK ? PIR_ERR_FILE : status;
}

pir_status py_pair_impact(pir_pair *pair, pir_workspace *workspace, const double *pose_p, const double *pose_q,
                          const pir_motion *motion, double tolerance, pir_impact *ret_impact) {
    pir_pair_input input = pir_pair_input_default();
    input.pose_p = pose(pose_p);
    input.pose_q = pose(pose_q);
    return pir_pair_time_of_impact(pair, workspace, &input, motion, tolerance, ret_impact);
}

pir_status py_pair_escapes(pir_pair *pair, pir_workspace *workspace, const double *poses, double slack, size_t capacity,
                           pir_escape *ret_escapes, size_t *ret_count) {
    pir_pair_input input = pir_pair_input_default();
    input.pose_p = pose(poses);
    input.pose_q = pose(poses + 7);
    return pir_pair_escapes(pair, workspace, &input, slack, capacity, ret_escapes, ret_count);
}

pir_status py_polytope_write(const pir_polytope *polytope, const char *path, bool exact, pir_report *report) {
    pir_mesh *mesh;
    pir_status status = pir_mesh_from_polytope(polytope, &mesh);
    if (status != PIR_OK)
        return status;
    status = pir_mesh_write(mesh, path, exact, report);
    pir_mesh_destroy(mesh);
    return status;
}
