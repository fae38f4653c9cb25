/* SPDX-License-Identifier: MIT */
/*
 * Loops over public functions, so that Python calls once for an array. All arrays are the caller's, of the sizes that
 * the counts of an object say. A loop that can fail ends at the first failure, whose index is *ret_done.
 *
 * The declarations between the marks are what cffi is given.
 */
#ifndef PIR_PYTHON_LOOPS_H
#define PIR_PYTHON_LOOPS_H

#include <pirouette/pirouette.h>

/* cffi: begin */
void py_polytope_vertices(const pir_polytope *polytope, pir_vec3 *ret_vertices);
void py_polytope_edges(const pir_polytope *polytope, uint32_t *ret_edges);
void py_polytope_normals(const pir_polytope *polytope, pir_vec3 *ret_normals);
void py_polytope_starts(const pir_polytope *polytope, uint32_t *ret_starts);
void py_polytope_corners(const pir_polytope *polytope, uint32_t *ret_corners);
void py_mesh_starts(const pir_mesh *mesh, uint32_t *ret_starts);
void py_mesh_corners(const pir_mesh *mesh, uint32_t *ret_corners);
void py_mesh_kinds(const pir_mesh *mesh, uint8_t *ret_kinds);
void py_trimesh_triangles(const pir_trimesh *mesh, double *ret_corners, uint32_t *ret_materials);
/* The exact coordinates of a vertex as text, "1/3 0 -2"; the length it has, as of snprintf, or -1 without rationals. */
int py_mesh_vertex_text(const pir_mesh *mesh, uint32_t vertex, size_t size, char *text);
int py_polytope_vertex_text(const pir_polytope *polytope, uint32_t vertex, size_t size, char *text);
/* The hull of points in rationals, each number ended by a zero, three of them a point. */
pir_status py_polytope_of_text(const char *text, size_t count, pir_polytope **ret_polytope);
void py_live_mesh_starts(const pir_live_mesh *live, uint32_t *ret_starts);
void py_live_mesh_corners(const pir_live_mesh *live, uint32_t *ret_corners);
pir_status py_query_penetrations(pir_query *query, const double *translations, size_t count,
                                 pir_query_result *ret_results, size_t *ret_done);
void py_sum_ee(const pir_sum *sum, uint32_t *ret_pairs);
pir_status py_surface_rays(const pir_trimesh *mesh, const pir_height_field *field, const double *rays,
                           pir_ray_sides sides, size_t count, pir_ray_hit *ret_hits, size_t *ret_done);
pir_status py_surface_nearest(const pir_trimesh *mesh, const pir_height_field *field, const double *points,
                              double cutoff, size_t count, pir_surface_nearest *ret_nearest, size_t *ret_done);
size_t py_scene_contact_count(const pir_scene *scene);
void py_scene_contacts(const pir_scene *scene, uint64_t *ret_starts, pir_contact *ret_contacts);
/* Room for contacts of poses one after another. */
typedef struct py_contact_room {
    size_t capacity;
    pir_solid_contact *contacts;
    uint64_t *counts; /* of each pose */
    size_t done;      /* poses that were answered */
} py_contact_room;
/* It ends at a pose whose contacts have no room left, with PIR_OK and how many they are in its count. */
pir_status py_solid_contacts(pir_solid_contacts *contacts, pir_workspace *workspace, const double *poses, size_t count,
                             double margin, py_contact_room *room);
/* Poses; one whose status is not 0 is left out. */
typedef struct py_posed {
    const double *poses;
    const uint8_t *statuses;
    size_t count;
    double cutoff, radius_p, radius_q;
} py_posed;
pir_status py_pair_curvatures(pir_pair *pair, pir_workspace *workspace, const py_posed *posed,
                              pir_curvature *ret_curvatures, size_t *ret_done);
pir_status py_pair_active(pir_pair *pair, pir_workspace *workspace, const double *poses, double slack, size_t capacity,
                          pir_active *ret_active, size_t *ret_count);
pir_status py_plan_write(const pir_path_plan *plan, const char *path);
pir_status py_pair_impact(pir_pair *pair, pir_workspace *workspace, const double *pose_p, const double *pose_q,
                          const pir_motion *motion, double tolerance, pir_impact *ret_impact);
pir_status py_pair_escapes(pir_pair *pair, pir_workspace *workspace, const double *poses, double slack, size_t capacity,
                           pir_escape *ret_escapes, size_t *ret_count);
pir_status py_polytope_write(const pir_polytope *polytope, const char *path, bool exact, pir_report *report);
/* cffi: end */

#endif
