/* SPDX-License-Identifier: MIT */
/*
 * Structs of options as the headers of other versions have them, given to every call that takes some: smaller ones,
 * larger ones whose tail is zero or not, and sizes that no struct has.
 *
 * Each kind of struct has fields at its end that a smaller one lacks. They are spoiled, so that the call fails or gives
 * another result where it reads them, and the result of the defaults where it does not.
 * tests/headers/check_rules.py holds that the table here has every public function with options.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <pirouette/baseline.h>
#include <pirouette/clash.h>
#include <pirouette/cspace.h>
#include <pirouette/exact.h>
#include <pirouette/history.h>
#include <pirouette/pirouette.h>
#include <pirouette/simplify.h>
#include <pirouette/solid.h>

#include "scene/scene_bodies.h"
#include "support/solid_sums.h"

/* The bytes of a struct of a later version, and the most that any struct has. */
#define LATER 64
#define MOST  256

/* The objects that the calls are on. */
struct world {
    pir_polytope *tetra, *cube; /* no reflection of the tetrahedron is one of its translates */
    pir_solid *solid;
    pir_trimesh *mesh;
    pir_scene *scene;
    pir_grid *grid;
    pir_report *report; /* of the scene */
    char path[48];
};

/* Makes something with options, of which it says `told`, a number that depends on the fields that are spoiled. */
typedef pir_status asker(struct world *w, const void *options, pir_report *report, double *told);

static const char text[] = "OFF\n4 4 0\n0 0 0\n2 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
static const pir_file_bytes file = {text, sizeof text - 1, "m.off", NULL};
static const pir_vec3 corners[4] = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 1}};
static const pir_quat straight = {0, 0, 0, 1};

/* --- what calls give --- */

static pir_status tell_polytope(pir_status status, pir_polytope *const *polytope, double *told) {
    if (status == PIR_OK)
        *told = pir_polytope_vertex(*polytope, 0).x;
    pir_polytope_release(*polytope);
    return status;
}

static pir_status tell_mesh(pir_status status, pir_mesh *const *mesh, double *told) {
    if (status != PIR_OK)
        return status;
    *told = 0;
    for (uint32_t v = 0; v < pir_mesh_vertex_count(*mesh); v++)
        *told += pir_mesh_vertices(*mesh)[v].x;
    pir_mesh_destroy(*mesh);
    return PIR_OK;
}

static pir_status tell_solid(pir_status status, pir_solid *const *solid, double *told) {
    *told = 0;
    pir_solid_release(*solid);
    return status;
}

static pir_status tell_trimesh(pir_status status, pir_trimesh *const *mesh, double *told) {
    if (status != PIR_OK)
        return status;
    pir_trimesh_info info;
    pir_trimesh_describe(*mesh, &info);
    *told = info.two_sided;
    pir_trimesh_release(*mesh);
    return PIR_OK;
}

/* The sum of the bytes of a history. */
static double bytes_of(const pir_history *history) {
    char *bytes = NULL;
    size_t size = 0;
    double sum = 0;
    FILE *stream = open_memstream(&bytes, &size);
    assert_int_equal(pir_history_write(history, stream, NULL), PIR_OK);
    fclose(stream);
    for (size_t i = 0; i < size; i++)
        sum += (double)(i + 1) * (unsigned char)bytes[i];
    free(bytes);
    return sum;
}

/* --- the calls --- */

static pir_status ask_polytope_create(struct world *w, const void *options, pir_report *report, double *told) {
    pir_polytope *made = NULL;
    (void)w, (void)report;
    return tell_polytope(pir_polytope_create(corners, 4, options, &made), &made, told);
}

static pir_status ask_polytope_create_exact(struct world *w, const void *options, pir_report *report, double *told) {
    pir_polytope *made = NULL;
    mpq_t point[3];
    (void)w, (void)report;
    mpq_inits(point[0], point[1], point[2], NULL);
    const pir_status status = pir_polytope_create_exact((const mpq_t *)point, 1, options, &made);
    mpq_clears(point[0], point[1], point[2], NULL);
    return tell_polytope(status, &made, told);
}

static pir_status ask_polytope_read(struct world *w, const void *options, pir_report *report, double *told) {
    pir_polytope *made = NULL;
    return tell_polytope(pir_polytope_read(w->path, options, report, NULL, &made), &made, told);
}

static pir_status ask_polytope_read_bytes(struct world *w, const void *options, pir_report *report, double *told) {
    pir_polytope *made = NULL;
    (void)w;
    return tell_polytope(pir_polytope_read_bytes(&file, options, report, NULL, &made), &made, told);
}

static pir_status ask_simplify(struct world *w, const void *options, pir_report *report, double *told) {
    pir_simplified made;
    (void)report;
    const pir_status status = pir_polytope_simplify(w->cube, options, &made);
    if (status != PIR_OK)
        return status;
    *told = pir_polytope_vertex_count(made.inner);
    pir_simplified_release(&made);
    return PIR_OK;
}

static pir_status ask_sum_create(struct world *w, const void *options, pir_report *report, double *told) {
    pir_sum *sum = NULL;
    pir_mesh *mesh = NULL;
    (void)report;
    pir_status status = pir_sum_create(w->tetra, w->cube, straight, options, &sum);
    if (status == PIR_OK)
        status = pir_sum_mesh(sum, PIR_DOUBLE, &mesh);
    pir_sum_destroy(sum);
    return tell_mesh(status, &mesh, told);
}

static pir_status ask_hull_sum(struct world *w, const void *options, pir_report *report, double *told) {
    pir_mesh *mesh = NULL;
    (void)report;
    return tell_mesh(pir_hull_sum(w->tetra, w->cube, straight, options, PIR_DOUBLE, &mesh), &mesh, told);
}

static pir_status ask_object_sum(struct world *w, const void *options, pir_report *report, double *told) {
    pir_mesh *mesh = NULL;
    (void)report;
    return tell_mesh(pir_object_sum(w->tetra, w->cube, straight, options, PIR_DOUBLE, &mesh), &mesh, told);
}

static pir_status ask_events_create(struct world *w, const void *options, pir_report *report, double *told) {
    pir_events *events = NULL;
    pir_event event;
    double kappa[2];
    bool found;
    (void)report;
    const pir_status status = pir_events_create(w->tetra, w->tetra, straight, (pir_vec3){1, 2, 3}, options, &events);
    if (status != PIR_OK)
        return status;
    assert_int_equal(pir_events_next(events, &event, &found), PIR_OK);
    pir_events_kappa(events, kappa);
    *told = kappa[0];
    pir_events_destroy(events);
    return PIR_OK;
}

static pir_status ask_pair_create(struct world *w, const void *options, pir_report *report, double *told) {
    pir_pair *pair = NULL;
    (void)report;
    *told = 0;
    const pir_status status = pir_pair_create(w->tetra, w->cube, options, &pair);
    pir_pair_destroy(pair);
    return status;
}

static pir_status ask_pair_batch_create(struct world *w, const void *options, pir_report *report, double *told) {
    pir_pair_batch *batch = NULL;
    (void)report;
    *told = 0;
    const pir_status status = pir_pair_batch_create(w->tetra, w->cube, options, &batch);
    pir_pair_batch_destroy(batch);
    return status;
}

static pir_status ask_history_pair(struct world *w, const void *options, pir_report *report, double *told) {
    pir_history *history = NULL;
    (void)report;
    assert_int_equal(pir_history_create(NULL, &history), PIR_OK);
    const pir_status status = pir_history_pair(history, w->tetra, w->cube, options);
    *told = status == PIR_OK ? bytes_of(history) : 0;
    pir_history_destroy(history);
    return status;
}

static pir_status ask_history_scene(struct world *w, const void *options, pir_report *report, double *told) {
    pir_history *history = NULL;
    (void)w, (void)report;
    assert_int_equal(pir_history_create(NULL, &history), PIR_OK);
    const pir_status status = pir_history_scene(history, options);
    *told = status == PIR_OK ? bytes_of(history) : 0;
    pir_history_destroy(history);
    return status;
}

static pir_status ask_history_add(struct world *w, const void *options, pir_report *report, double *told) {
    pir_history *history = NULL;
    (void)w, (void)report;
    assert_int_equal(pir_history_create(NULL, &history), PIR_OK);
    assert_int_equal(pir_history_scene(history, NULL), PIR_OK);
    const pir_status status = pir_history_add(history, options);
    *told = status == PIR_OK ? bytes_of(history) : 0;
    pir_history_destroy(history);
    return status;
}

static pir_status ask_scene_create(struct world *w, const void *options, pir_report *report, double *told) {
    pir_scene *scene = NULL;
    (void)w, (void)report;
    *told = 0;
    const pir_status status = pir_scene_create(options, &scene);
    pir_scene_destroy(scene);
    return status;
}

static pir_status ask_scene_add(struct world *w, const void *options, pir_report *report, double *told) {
    uint32_t body;
    *told = 0;
    const pir_status status = pir_scene_add(w->scene, options, &body);
    *report = *w->report;
    return status == PIR_OK ? pir_scene_remove(w->scene, body) : status;
}

static pir_status ask_scene_keep(struct world *w, const void *options, pir_report *report, double *told) {
    const pir_status status = pir_scene_keep(w->scene, options);
    *report = *w->report;
    *told = 0;
    pir_scene_forget_shapes(w->scene);
    return status;
}

static pir_status ask_scene_ray_first(struct world *w, const void *options, pir_report *report, double *told) {
    pir_impact impact = {.time = 0};
    const pir_status status =
        pir_scene_ray_first(w->scene, (pir_vec3){0, 0, 9}, (pir_vec3){0, 0, -9}, options, &impact);
    *report = *w->report;
    *told = impact.time;
    return status;
}

static pir_status ask_scene_ray_batch(struct world *w, const void *options, pir_report *report, double *told) {
    const pir_scene_segment segment = {{0, 0, 9}, {0, 0, -9}};
    pir_impact impact = {.time = 0};
    const pir_status status = pir_scene_ray_batch(w->scene, &segment, 1, options, &impact);
    *report = *w->report;
    *told = impact.time;
    return status;
}

static pir_status ask_scene_ray_any(struct world *w, const void *options, pir_report *report, double *told) {
    bool hits = false;
    const pir_status status = pir_scene_ray_any(w->scene, (pir_vec3){0, 0, 9}, (pir_vec3){0, 0, -9}, options, &hits);
    *report = *w->report;
    *told = hits;
    return status;
}

static pir_status ask_scene_ray_all(struct world *w, const void *options, pir_report *report, double *told) {
    size_t count = 0;
    const pir_status status =
        pir_scene_ray_all(w->scene, (pir_vec3){0, 0, 9}, (pir_vec3){0, 0, -9}, options, 0, NULL, &count);
    *report = *w->report;
    *told = (double)count;
    return status;
}

static pir_status ask_solid_create(struct world *w, const void *options, pir_report *report, double *told) {
    static const uint32_t starts[] = {0, 3, 6, 9, 12}, corner[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    const pir_solid_facets facets = {
        .points = corners, .point_count = 4, .starts = starts, .corners = corner, .facet_count = 4};
    pir_solid *made = NULL;
    (void)w;
    return tell_solid(pir_solid_create(&facets, options, report, &made), &made, told);
}

static pir_status ask_solid_from_polytope(struct world *w, const void *options, pir_report *report, double *told) {
    pir_solid *made = NULL;
    (void)report;
    return tell_solid(pir_solid_from_polytope(w->tetra, options, &made), &made, told);
}

static pir_status ask_solid_read(struct world *w, const void *options, pir_report *report, double *told) {
    pir_solid *made = NULL;
    return tell_solid(pir_solid_read(w->path, options, report, &made), &made, told);
}

static pir_status ask_solid_read_bytes(struct world *w, const void *options, pir_report *report, double *told) {
    pir_solid *made = NULL;
    (void)w;
    return tell_solid(pir_solid_read_bytes(&file, options, report, &made), &made, told);
}

static pir_status ask_solid_decompose(struct world *w, const void *options, pir_report *report, double *told) {
    pir_pieces *pieces = NULL;
    (void)report;
    const pir_status status = pir_solid_decompose(w->solid, options, NULL, &pieces);
    *told = status == PIR_OK ? pir_pieces_count(pieces) : 0;
    pir_pieces_destroy(pieces);
    return status;
}

static pir_status ask_solid_sum(struct world *w, const void *options, pir_report *report, double *told) {
    pir_mesh *mesh = NULL;
    (void)report;
    return tell_mesh(solid_sum_mesh(w->solid, w->solid, straight, options, NULL, &mesh), &mesh, told);
}

static pir_status ask_clash_body_create(struct world *w, const void *options, pir_report *report, double *told) {
    pir_clash_body *body = NULL;
    (void)report;
    *told = 0;
    const pir_status status = pir_clash_body_create(w->solid, options, &body);
    pir_clash_body_destroy(body);
    return status;
}

static pir_status ask_path_plan(struct world *w, const void *options, pir_report *report, double *told) {
    const pir_solid *const some[] = {w->solid};
    const pir_path_plan_input input = {some, 1, some, 1, straight, {-9, 0, 0}, {9, 0, 0}};
    pir_path_plan *plan = NULL;
    pir_path_plan_info info = {0};
    (void)report;
    const pir_status status = pir_path_plan_translate(&input, options, &plan);
    if (status == PIR_OK)
        pir_path_plan_describe(plan, &info);
    pir_path_plan_destroy(plan);
    *told = info.parts;
    return status;
}

static pir_status ask_turn_plan(struct world *w, const void *options, pir_report *report, double *told) {
    const pir_solid *const some[] = {w->solid};
    const pir_turn_plan_input input = {some,      1,          some,      1, {0, 0, 1}, {-9, -9, -9},
                                       {9, 9, 9}, {-8, 0, 0}, {8, 0, 0}, 0, .25};
    pir_turn_plan *plan = NULL;
    pir_turn_plan_info info = {0};
    (void)report;
    const pir_status status = pir_turn_plan_create(&input, options, &plan);
    if (status == PIR_OK)
        pir_turn_plan_describe(plan, &info);
    pir_turn_plan_destroy(plan);
    *told = info.parts;
    return status;
}

static pir_status ask_rigid_plan(struct world *w, const void *options, pir_report *report, double *told) {
    const pir_solid *const some[] = {w->solid};
    const pir_rigid_plan_input input = {
        some, 1, some, 1, {-9, -9, -9}, {9, 9, 9}, {{0, 0, 0, 1}, {-8, 0, 0}}, {{0, 0, 1, 1}, {8, 0, 0}}};
    pir_rigid_plan *plan = NULL;
    pir_rigid_plan_info info = {0};
    (void)report;
    const pir_status status = pir_rigid_plan_create(&input, options, &plan);
    if (status == PIR_OK)
        pir_rigid_plan_describe(plan, &info);
    pir_rigid_plan_destroy(plan);
    *told = (double)info.parts;
    return status;
}

static pir_status ask_solid_certify_exact(struct world *w, const void *options, pir_report *report, double *told) {
    mpq_t added, lost;
    (void)report;
    mpq_inits(added, lost, NULL);
    const pir_status status = pir_solid_certify_exact(w->solid, &w->cube, 1, options, added, lost);
    *told = mpq_get_d(added) + mpq_get_d(lost);
    mpq_clears(added, lost, NULL);
    return status;
}

static pir_status ask_trimesh_create(struct world *w, const void *options, pir_report *report, double *told) {
    static const uint32_t triangle[] = {0, 2, 1};
    const pir_trimesh_arrays arrays = {
        .vertices = corners, .vertex_count = 4, .triangles = triangle, .triangle_count = 1};
    pir_trimesh *made = NULL;
    (void)w;
    return tell_trimesh(pir_trimesh_create(&arrays, options, report, &made), &made, told);
}

static pir_status ask_trimesh_read(struct world *w, const void *options, pir_report *report, double *told) {
    pir_trimesh *made = NULL;
    return tell_trimesh(pir_trimesh_read(w->path, options, report, &made), &made, told);
}

static pir_status ask_trimesh_read_bytes(struct world *w, const void *options, pir_report *report, double *told) {
    pir_trimesh *made = NULL;
    (void)w;
    return tell_trimesh(pir_trimesh_read_bytes(&file, options, report, &made), &made, told);
}

static pir_status ask_height_field_create(struct world *w, const void *options, pir_report *report, double *told) {
    static const double heights[4] = {0, 0, 0, 1};
    const pir_height_samples samples = {.heights = heights, .columns = 2, .rows = 2, .step_x = 1, .step_y = 1};
    pir_height_field *field = NULL;
    pir_height_info info;
    (void)w;
    const pir_status status = pir_height_field_create(&samples, options, report, &field);
    if (status != PIR_OK)
        return status;
    pir_height_field_describe(field, &info);
    *told = info.two_sided;
    pir_height_field_release(field);
    return PIR_OK;
}

static pir_status ask_trimesh_pair_batch_create(struct world *w, const void *options, pir_report *report,
                                                double *told) {
    pir_trimesh_pair_batch *batch = NULL;
    (void)report;
    *told = 0;
    const pir_status status = pir_trimesh_pair_batch_create(w->mesh, w->mesh, options, &batch);
    pir_trimesh_pair_batch_destroy(batch);
    return status;
}

static pir_status ask_solid_query_batch_create(struct world *w, const void *options, pir_report *report, double *told) {
    pir_solid_query_batch *batch = NULL;
    pir_pieces *pieces = NULL;
    (void)report;
    *told = 0;
    pir_status status = pir_solid_decompose(w->solid, NULL, NULL, &pieces);
    if (status == PIR_OK)
        status = pir_solid_query_batch_create(pieces, pieces, options, &batch);
    pir_solid_query_batch_destroy(batch);
    pir_pieces_destroy(pieces);
    return status;
}

static pir_status ask_trimesh_pair_create(struct world *w, const void *options, pir_report *report, double *told) {
    pir_trimesh_pair *pair = NULL;
    (void)report;
    *told = 0;
    const pir_status status = pir_trimesh_pair_create(w->mesh, w->mesh, options, &pair);
    pir_trimesh_pair_destroy(pair);
    return status;
}

static pir_status ask_cspace_job_create(struct world *w, const void *options, pir_report *report, double *told) {
    const pir_cspace_bodies bodies = {&w->tetra, 1, &w->cube, 1};
    char target[64];
    pir_cspace_job *job = NULL;
    snprintf(target, sizeof target, "%s.h5", w->path);
    const pir_status status = pir_cspace_job_create(&bodies, w->grid, target, options, report, &job);
    *told = (double)pir_cspace_job_units(job);
    pir_cspace_job_destroy(job);
    return status;
}

static pir_status ask_cspace_get_estimate(struct world *w, const void *options, pir_report *report, double *told) {
    const pir_cspace_bodies bodies = {&w->tetra, 1, &w->cube, 1};
    pir_cspace_estimate estimate = {0};
    const pir_status status = pir_cspace_get_estimate(&bodies, w->grid, options, report, &estimate);
    *told = (double)estimate.units;
    return status;
}

/* --- the structs --- */

struct kind {
    const char *name;
    size_t size, older; /* with all fields, and without those that are spoiled: 0 where that leaves none */
    size_t report_at;   /* where a pointer to the report is, or 0 */
    void (*begin)(struct world *w, void *options);
    void (*spoil)(void *options);
};

/* A kind whose smaller struct ends before `lacking`; what its caller sets besides the defaults, and what is spoiled. */
#define KIND(of, lacking, report_offset, set, wrong)                                                                   \
    static void begin_##of(struct world *w, void *options) {                                                           \
        pir_##of##_options *o = options;                                                                               \
        *o = pir_##of##_options_default();                                                                             \
        (void)w;                                                                                                       \
        set;                                                                                                           \
    }                                                                                                                  \
    static void spoil_##of(void *options) {                                                                            \
        pir_##of##_options *o = options;                                                                               \
        (void)o;                                                                                                       \
        wrong;                                                                                                         \
    }                                                                                                                  \
    static const struct kind of##_kind = {                                                                             \
        "pir_" #of "_options", sizeof(pir_##of##_options), lacking, report_offset, begin_##of, spoil_##of};

#define LACKS(of, field) offsetof(pir_##of##_options, field)

KIND(polytope, LACKS(polytope, merge_tolerance), 0, , o->merge_tolerance = NAN)
KIND(read, LACKS(read, merge_tolerance), 0, , o->merge_tolerance = NAN)
KIND(simplify, LACKS(simplify, error), 0, o->vertices = 5, o->error = NAN)
KIND(sum, LACKS(sum, difference), 0, , o->difference = true)
KIND(events, LACKS(events, difference), 0, , o->difference = true)
KIND(pair, LACKS(pair, least), 0, , o->least = PIR_LEVEL_WHOLE; o->most = PIR_LEVEL_NONE)
KIND(pair_batch, LACKS(pair_batch, threads), 0, , o->threads = 99)
KIND(scene, LACKS(scene, detail), LACKS(scene, report), o->report = w->report, o->margin = -1; o->reuse = -1)
KIND(body, LACKS(body, radius), 0, o->pieces = &w->cube; o->piece_count = 1, o->radius = NAN)
KIND(scene_ray, LACKS(scene_ray, sides), 0, , o->sides = (pir_ray_sides)9)
KIND(solid, LACKS(solid, memory), LACKS(solid, report), o->report = w->report, o->memory = 1)
KIND(decompose, LACKS(decompose, method), LACKS(decompose, report), o->report = w->report, o->tolerance = NAN)
KIND(solid_sum, LACKS(solid_sum, difference), LACKS(solid_sum, report), o->report = w->report, o->difference = true)
KIND(path_plan, LACKS(path_plan, low), LACKS(path_plan, report), o->report = w->report, o->open = true)
KIND(turn_plan, LACKS(turn_plan, arcs), LACKS(turn_plan, report), o->report = w->report, o->arcs = 9)
KIND(rigid_plan, LACKS(rigid_plan, boxes), LACKS(rigid_plan, report), o->report = w->report, o->boxes = 9)
KIND(trimesh, LACKS(trimesh, two_sided), 0, , o->two_sided = true)
KIND(height, LACKS(height, two_sided), 0, , o->two_sided = true)
KIND(trimesh_pair, 0, 0, , )
KIND(cspace, LACKS(cspace, threads), 0, , o->threads = 0; o->slices_per_unit = PIR_CSPACE_UNIT_MAX + 1)

/* `reported`: whether the call has a report, beside that of the struct. */
static const struct call {
    const char *name;
    asker *ask;
    const struct kind *kind;
    bool reported;
} calls[] = {
    {"pir_polytope_create", ask_polytope_create, &polytope_kind, false},
    {"pir_polytope_create_exact", ask_polytope_create_exact, &polytope_kind, false},
    {"pir_polytope_read", ask_polytope_read, &read_kind, true},
    {"pir_polytope_read_bytes", ask_polytope_read_bytes, &read_kind, true},
    {"pir_polytope_simplify", ask_simplify, &simplify_kind, false},
    {"pir_sum_create", ask_sum_create, &sum_kind, false},
    {"pir_hull_sum", ask_hull_sum, &sum_kind, false},
    {"pir_object_sum", ask_object_sum, &sum_kind, false},
    {"pir_events_create", ask_events_create, &events_kind, false},
    {"pir_pair_create", ask_pair_create, &pair_kind, false},
    {"pir_pair_batch_create", ask_pair_batch_create, &pair_batch_kind, false},
    {"pir_solid_query_batch_create", ask_solid_query_batch_create, &pair_batch_kind, false},
    {"pir_trimesh_pair_batch_create", ask_trimesh_pair_batch_create, &pair_batch_kind, false},
    {"pir_history_pair", ask_history_pair, &pair_kind, false},
    {"pir_history_scene", ask_history_scene, &scene_kind, false},
    {"pir_history_add", ask_history_add, &body_kind, false},
    {"pir_scene_create", ask_scene_create, &scene_kind, false},
    {"pir_scene_add", ask_scene_add, &body_kind, true},
    {"pir_scene_keep", ask_scene_keep, &body_kind, true},
    {"pir_scene_ray_first", ask_scene_ray_first, &scene_ray_kind, true},
    {"pir_scene_ray_batch", ask_scene_ray_batch, &scene_ray_kind, true},
    {"pir_scene_ray_any", ask_scene_ray_any, &scene_ray_kind, true},
    {"pir_scene_ray_all", ask_scene_ray_all, &scene_ray_kind, true},
    {"pir_solid_create", ask_solid_create, &solid_kind, true},
    {"pir_solid_from_polytope", ask_solid_from_polytope, &solid_kind, false},
    {"pir_solid_read", ask_solid_read, &solid_kind, true},
    {"pir_solid_read_bytes", ask_solid_read_bytes, &solid_kind, true},
    {"pir_solid_decompose", ask_solid_decompose, &decompose_kind, false},
    {"pir_solid_sum_create", ask_solid_sum, &solid_sum_kind, false},
    {"pir_clash_body_create", ask_clash_body_create, &solid_kind, false},
    {"pir_path_plan_translate", ask_path_plan, &path_plan_kind, false},
    {"pir_turn_plan_create", ask_turn_plan, &turn_plan_kind, false},
    {"pir_rigid_plan_create", ask_rigid_plan, &rigid_plan_kind, false},
    {"pir_solid_certify_exact", ask_solid_certify_exact, &solid_kind, false},
    {"pir_trimesh_create", ask_trimesh_create, &trimesh_kind, true},
    {"pir_trimesh_read", ask_trimesh_read, &trimesh_kind, true},
    {"pir_trimesh_read_bytes", ask_trimesh_read_bytes, &trimesh_kind, true},
    {"pir_height_field_create", ask_height_field_create, &height_kind, true},
    {"pir_trimesh_pair_create", ask_trimesh_pair_create, &trimesh_pair_kind, false},
    {"pir_cspace_job_create", ask_cspace_job_create, &cspace_kind, true},
    {"pir_cspace_get_estimate", ask_cspace_get_estimate, &cspace_kind, true},
};
enum { CALLS = sizeof calls / sizeof *calls };

/* --- the world --- */

static void make(struct world *w, pir_report *report) {
    pir_scene_options options = pir_scene_options_default();
    *w = (struct world){.cube = scene_cube(1), .report = report};
    snprintf(w->path, sizeof w->path, "/tmp/pir-options-%ld.off", (long)getpid());
    FILE *made = fopen(w->path, "w");
    assert_true(made && fputs(text, made) >= 0 && fclose(made) == 0);
    assert_int_equal(pir_polytope_create(corners, 4, NULL, &w->tetra), PIR_OK);
    assert_int_equal(pir_solid_from_polytope(w->tetra, NULL, &w->solid), PIR_OK);
    assert_int_equal(pir_trimesh_read_bytes(&file, NULL, NULL, &w->mesh), PIR_OK);
    assert_int_equal(pir_grid_axis((pir_vec3){0, 0, 1}, 8, NULL, &w->grid), PIR_OK);
    options.report = report;
    assert_int_equal(pir_scene_create(&options, &w->scene), PIR_OK);
    scene_add(w->scene, w->cube, scene_at(0, 0, 0), PIR_BODY_STATIC);
}

static void clear(struct world *w) {
    remove(w->path);
    pir_scene_destroy(w->scene);
    pir_grid_destroy(w->grid);
    pir_trimesh_release(w->mesh);
    pir_solid_release(w->solid);
    pir_polytope_release(w->tetra);
    pir_polytope_release(w->cube);
}

/* A struct in memory that ends where it does, so that a sanitizer sees reads behind it. */
struct given {
    struct world *w;
    const struct call *call;
    pir_report report, kept;
    double told;
};

/* The outcome of the call with the first `size` bytes of a struct, its size among them. */
static pir_status ask(struct given *g, const unsigned char *options, size_t size) {
    unsigned char *copy = malloc(size);
    assert_non_null(copy);
    memcpy(copy, options, size);
    g->report = *g->w->report = (pir_report){PIR_OK, ""};
    const pir_status status = g->call->ask(g->w, copy, &g->report, &g->told);
    g->kept = *g->w->report;
    free(copy);
    return status;
}

/* Whether the report, of the call or of a struct of that size, names the struct. */
static bool is_named(const struct given *g, pir_status status, size_t size) {
    const struct kind *kind = g->call->kind;
    const bool in_struct = kind->report_at && size >= kind->report_at + sizeof(void *);
    const pir_report *report = g->call->reported ? &g->report : &g->kept;
    return !(g->call->reported || in_struct) || (report->status == status && strstr(report->text, kind->name));
}

static bool is_built(struct given *g, const unsigned char *options) {
    return ask(g, options, g->call->kind->size) != PIR_ERR_NOT_BUILT;
}

/* --- the tests --- */

static void set_size(unsigned char *options, size_t size) {
    memcpy(options, &size, sizeof size);
}

static void begin(const struct given *g, unsigned char options[MOST]) {
    memset(options, 0, MOST);
    g->call->kind->begin(g->w, options);
}

/* Fields that a smaller struct lacks are the defaults, whatever stands behind it. */
static void check_smaller(struct given *g, double told) {
    const struct kind *kind = g->call->kind;
    unsigned char options[MOST];
    if (kind->older == 0)
        return;
    begin(g, options);
    kind->spoil(options);
    const pir_status status = ask(g, options, kind->size);
    expect(status != PIR_OK || g->told != told, "%s does not see what is spoiled", g->call->name);
    set_size(options, kind->older);
    expect(ask(g, options, kind->older) == PIR_OK, "%s with %zu bytes of %zu: %s", g->call->name, kind->older,
           kind->size, g->report.text);
    expect(g->told == told, "%s with %zu bytes: %g, not %g", g->call->name, kind->older, g->told, told);
}

static void check_larger(struct given *g, double told) {
    const struct kind *kind = g->call->kind;
    unsigned char options[MOST];
    begin(g, options);
    set_size(options, kind->size + LATER);
    expect(ask(g, options, kind->size + LATER) == PIR_OK && g->told == told, "%s with zeros behind", g->call->name);
    for (size_t i = 0; i < LATER; i++) {
        options[kind->size + i] = 1;
        const pir_status status = ask(g, options, kind->size + LATER);
        expect(status == PIR_ERR_VERSION, "%s with byte %zu behind set: %d", g->call->name, i, (int)status);
        expect(is_named(g, status, kind->size + LATER), "%s: '%s'", g->call->name, g->report.text);
        options[kind->size + i] = 0;
    }
}

static void check_no_size(struct given *g) {
    const size_t sizes[] = {0, 1, sizeof(size_t), sizeof(size_t) + 1, g->call->kind->size - 1, 4097, SIZE_MAX};
    unsigned char options[MOST];
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        begin(g, options);
        set_size(options, sizes[i]);
        const pir_status status = ask(g, options, g->call->kind->size);
        expect(status == PIR_ERR_ARGUMENT, "%s with size %zu: %d", g->call->name, sizes[i], (int)status);
        expect(!g->call->reported || is_named(g, status, 0), "%s: '%s'", g->call->name, g->report.text);
    }
}

static void structs_of_other_versions_are_served_or_refused(void **state) {
    (void)state;
    pir_report report;
    struct world w;
    uint32_t checked = 0;
    make(&w, &report);
    for (int i = 0; i < CALLS; i++) {
        struct given g = {.w = &w, .call = &calls[i]};
        unsigned char options[MOST];
        begin(&g, options);
        if (!is_built(&g, options))
            continue;
        expect(ask(&g, options, calls[i].kind->size) == PIR_OK, "%s: %s", calls[i].name, g.report.text);
        const double told = g.told;
        check_smaller(&g, told);
        check_larger(&g, told);
        check_no_size(&g);
        checked++;
    }
    printf("# %u of %d calls\n", (unsigned)checked, CALLS);
    assert_true(checked + 2 >= CALLS);
    clear(&w);
}

/* NULL stands for the defaults, where they are enough. */
static void no_options_are_the_defaults(void **state) {
    (void)state;
    pir_report report;
    struct world w;
    make(&w, &report);
    for (int i = 0; i < CALLS; i++) {
        struct given g = {.w = &w, .call = &calls[i]};
        const bool needed = calls[i].kind == &simplify_kind || calls[i].kind == &body_kind;
        unsigned char options[MOST];
        double told = 0;
        begin(&g, options);
        const pir_status status = needed ? PIR_ERR_ARGUMENT : ask(&g, options, calls[i].kind->size);
        expect(calls[i].ask(&w, NULL, &report, &told) == status, "%s without options", calls[i].name);
        expect(status != PIR_OK || told == g.told, "%s without options: %g, not %g", calls[i].name, told, g.told);
    }
    clear(&w);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(structs_of_other_versions_are_served_or_refused),
        cmocka_unit_test(no_options_are_the_defaults),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
