/* SPDX-License-Identifier: MIT */
/* Meshes of arrays: what is copied is checked first, then made one where it stands at one place, then put in a tree. */
#include "mesh/trimesh.h"

#include <string.h>

#include "base/options.h"
#include "base/report.h"
#include "mesh/signs/mesh_numbers.h"
#include "mesh/weld.h"

/* Counts from here on are refused: a leaf has 29 bits for where its items begin. */
#define MOST (1u << 29)

/* --- copies --- */

static pir_status check_arrays(const pir_trimesh_arrays *a, pir_report *report) {
    size_t number = a->vertex_type == PIR_NUMBERS_FLOAT ? sizeof(float) : sizeof(double);
    if (a->vertex_type != PIR_NUMBERS_FLOAT && a->vertex_type != PIR_NUMBERS_DOUBLE)
        return pir_fail(report, PIR_ERR_ARGUMENT, "vertices are of no type: %d", (int)a->vertex_type);
    if ((!a->vertices && a->vertex_count > 0) || (!a->triangles && a->triangle_count > 0))
        return pir_fail(report, PIR_ERR_ARGUMENT, "there are no vertices or no triangles at the address given");
    if (a->vertex_count >= MOST || a->triangle_count >= MOST)
        return pir_fail(report, PIR_ERR_LIMIT, "%zu vertices and %zu triangles: 2^29 of either are too many",
                        a->vertex_count, a->triangle_count);
    if (a->triangle_count == 0)
        return pir_fail(report, PIR_ERR_EMPTY, "there is no triangle");
    if (a->vertex_stride != 0 && a->vertex_stride < 3 * number)
        return pir_fail(report, PIR_ERR_ARGUMENT, "a stride of %zu bytes is less than a vertex has", a->vertex_stride);
    if (a->triangle_stride != 0 && a->triangle_stride < 3 * sizeof(uint32_t))
        return pir_fail(report, PIR_ERR_ARGUMENT, "a stride of %zu bytes is less than a triangle has",
                        a->triangle_stride);
    if (a->materials && a->material_stride != 0 && a->material_stride < sizeof(uint32_t))
        return pir_fail(report, PIR_ERR_ARGUMENT, "a stride of %zu bytes is less than a material has",
                        a->material_stride);
    return PIR_OK;
}

static pir_vec3 vertex_of(const pir_trimesh_arrays *a, size_t v) {
    if (a->vertex_type == PIR_NUMBERS_FLOAT) {
        float x[3];
        memcpy(x, (const char *)a->vertices + v * (a->vertex_stride ? a->vertex_stride : sizeof x), sizeof x);
        return (pir_vec3){(double)x[0], (double)x[1], (double)x[2]};
    }
    double x[3];
    memcpy(x, (const char *)a->vertices + v * (a->vertex_stride ? a->vertex_stride : sizeof x), sizeof x);
    return (pir_vec3){x[0], x[1], x[2]};
}

static bool is_near(pir_vec3 v) {
    return fabs(v.x) <= PIR_MESH_FARTHEST && fabs(v.y) <= PIR_MESH_FARTHEST && fabs(v.z) <= PIR_MESH_FARTHEST;
}

static void copy_vertices(pir_trimesh *mesh, const pir_trimesh_arrays *a) {
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        mesh->vertex[v] = vertex_of(a, v);
}

/* Whether triangle t is made of vertices that are numbers within the limit. */
static pir_status check_triangle(const pir_trimesh *mesh, uint32_t t, pir_report *report) {
    for (int k = 0; k < 3; k++) {
        uint32_t c = mesh->corner[t][k];
        if (c >= mesh->vertex_count)
            return pir_fail(report, PIR_ERR_ARGUMENT, "triangle %u: corner %d is vertex %u, and there are %u", t, k, c,
                            mesh->vertex_count);
        pir_vec3 v = mesh->vertex[c];
        if (!pir_vec_is_finite(v))
            return pir_fail(report, PIR_ERR_NOT_FINITE, "triangle %u: vertex %u is (%g, %g, %g)", t, c, v.x, v.y, v.z);
        if (!is_near(v))
            return pir_fail(report, PIR_ERR_LIMIT, "triangle %u: vertex %u, (%g, %g, %g), is farther than 2^60", t, c,
                            v.x, v.y, v.z);
    }
    return PIR_OK;
}

static pir_status copy_triangles(pir_trimesh *mesh, const pir_trimesh_arrays *a, pir_report *report) {
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        size_t stride = a->triangle_stride ? a->triangle_stride : sizeof mesh->corner[t];
        memcpy(mesh->corner[t], (const char *)a->triangles + t * stride, sizeof mesh->corner[t]);
        pir_status status = check_triangle(mesh, t, report);
        if (status != PIR_OK)
            return status;
        if (mesh->material)
            memcpy(&mesh->material[t],
                   (const char *)a->materials + t * (a->material_stride ? a->material_stride : sizeof(uint32_t)),
                   sizeof(uint32_t));
    }
    return PIR_OK;
}

/* A vertex that no triangle has may be anything: it is put at the origin. */
static void tame_vertices(pir_trimesh *mesh) {
    mesh->low_bit = INT32_MAX;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (!pir_vec_is_finite(mesh->vertex[v]) || !is_near(mesh->vertex[v]))
            mesh->vertex[v] = (pir_vec3){0, 0, 0};
        int low = pir_vec_low_bit(mesh->vertex[v]);
        mesh->low_bit = low < mesh->low_bit ? low : mesh->low_bit;
    }
}

/* --- what is made of them --- */

static pir_status fail_memory(pir_report *report) {
    return pir_fail(report, PIR_ERR_MEMORY, "out of memory");
}

/*
 * Counts the parts, and lists a vertex of each if the mesh is closed. The root of a part is its lowest vertex; it is a
 * corner of an item, for vertices that no item joins are alone. A bit above all numbers marks roots that were counted.
 */
static bool list_parts(pir_trimesh *mesh, uint32_t *part, const uint32_t *item, uint32_t item_count) {
    const uint32_t mark = 1u << 31;
    pir_weld_parts(part, mesh->vertex_count, (const uint32_t(*)[3])mesh->corner, item, item_count);
    for (uint32_t i = 0; i < item_count; i++) {
        uint32_t root = part[mesh->corner[item[i]][0]] & ~mark;
        mesh->part_count += part[root] >> 31 == 0;
        part[root] |= mark;
    }
    mesh->part_listed = mesh->closed ? mesh->part_count : 0;
    mesh->part_vertex = PIR_NEW(&mesh->allocator, uint32_t, mesh->part_listed);
    if (!mesh->part_vertex)
        return false;
    for (uint32_t v = 0, listed = 0; v < mesh->vertex_count && listed < mesh->part_listed; v++)
        if (part[v] >> 31)
            mesh->part_vertex[listed++] = v;
    return true;
}

/* The triangles that have an area. */
static uint32_t list_items(pir_trimesh *mesh, uint32_t *item) {
    uint32_t count = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *c = mesh->corner[t];
        pir_tri tri = pir_trimesh_tri(mesh, t);
        if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0] || pir_tri_is_degenerate(&tri))
            mesh->degenerate_count++;
        else
            item[count++] = t;
    }
    return count;
}

static bool weld(pir_trimesh *mesh, uint32_t *same) {
    if (!pir_weld_vertices(&mesh->allocator, mesh->vertex, mesh->vertex_count, same))
        return false;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++)
            mesh->corner[t][k] = same[mesh->corner[t][k]];
    return pir_weld_is_closed(&mesh->allocator, (const uint32_t(*)[3])mesh->corner, mesh->triangle_count,
                              &mesh->closed);
}

static pir_status make_tree(pir_trimesh *mesh, uint32_t *work, pir_report *report) {
    uint32_t *item = PIR_NEW(&mesh->allocator, uint32_t, mesh->triangle_count);
    if (!item)
        return fail_memory(report);
    uint32_t count = list_items(mesh, item);
    pir_status status = PIR_OK;
    if (count == 0)
        status = pir_fail(report, PIR_ERR_EMPTY, "none of the %u triangles has an area", mesh->triangle_count);
    uint32_t *fitted = count > 0 ? PIR_RESIZE(&mesh->allocator, item, mesh->triangle_count, count) : NULL;
    const pir_mesh_source source = {mesh->vertex, (const uint32_t(*)[3])mesh->corner};
    if (fitted && list_parts(mesh, work, fitted, count) &&
        pir_mesh_tree_make(&mesh->tree, &mesh->allocator, &source, fitted, count))
        return PIR_OK;
    if (fitted)
        PIR_FREE(&mesh->allocator, fitted, count);
    else
        PIR_FREE(&mesh->allocator, item, mesh->triangle_count);
    return status != PIR_OK ? status : fail_memory(report);
}

static pir_status fill(pir_trimesh *mesh, const pir_trimesh_arrays *a, pir_report *report) {
    mesh->vertex = PIR_NEW(&mesh->allocator, pir_vec3, mesh->vertex_count);
    mesh->corner = pir_memory_new(&mesh->allocator, mesh->triangle_count, sizeof *mesh->corner);
    if (a->materials)
        mesh->material = PIR_NEW(&mesh->allocator, uint32_t, mesh->triangle_count);
    if (!mesh->vertex || !mesh->corner || (a->materials && !mesh->material))
        return fail_memory(report);
    copy_vertices(mesh, a);
    pir_status status = copy_triangles(mesh, a, report);
    if (status != PIR_OK)
        return status;
    tame_vertices(mesh);
    uint32_t *work = PIR_NEW(&mesh->allocator, uint32_t, mesh->vertex_count);
    if (!work)
        return fail_memory(report);
    status = weld(mesh, work) ? make_tree(mesh, work, report) : fail_memory(report);
    PIR_FREE(&mesh->allocator, work, mesh->vertex_count);
    return status;
}

static void free_mesh(pir_trimesh *mesh) {
    const pir_allocator allocator = mesh->allocator;
    PIR_FREE(&allocator, mesh->vertex, mesh->vertex_count);
    PIR_FREE(&allocator, mesh->corner, mesh->triangle_count);
    PIR_FREE(&allocator, mesh->material, mesh->triangle_count);
    PIR_FREE(&allocator, mesh->part_vertex, mesh->part_listed);
    pir_mesh_tree_finish(&mesh->tree, &allocator);
    PIR_FREE(&allocator, mesh, 1);
}

pir_status pir_trimesh_create(const pir_trimesh_arrays *arrays, const pir_trimesh_options *options, pir_report *report,
                              pir_trimesh **ret_mesh) {
    if (!arrays || !ret_mesh)
        return pir_fail(report, PIR_ERR_ARGUMENT, "no arrays, or no place for the mesh");
    pir_trimesh_options used = pir_trimesh_options_default();
    pir_status status = pir_options_take("pir_trimesh_options", options, &used, &report);
    if (status == PIR_OK)
        status = check_arrays(arrays, report);
    if (status != PIR_OK)
        return status;
    const pir_allocator allocator = pir_allocator_or_default(used.allocator);
    pir_trimesh *mesh = PIR_ZEROED(&allocator, pir_trimesh, 1);
    if (!mesh)
        return fail_memory(report);
    mesh->allocator = allocator;
    atomic_init(&mesh->references, 1);
    mesh->vertex_count = (uint32_t)arrays->vertex_count;
    mesh->triangle_count = (uint32_t)arrays->triangle_count;
    mesh->two_sided = used.two_sided;
    status = fill(mesh, arrays, report);
    if (status != PIR_OK)
        free_mesh(mesh);
    else
        *ret_mesh = mesh;
    return status;
}

pir_trimesh *pir_trimesh_retain(pir_trimesh *mesh) {
    atomic_fetch_add_explicit(&mesh->references, 1, memory_order_relaxed);
    return mesh;
}

void pir_trimesh_release(pir_trimesh *mesh) {
    if (mesh && atomic_fetch_sub_explicit(&mesh->references, 1, memory_order_acq_rel) == 1)
        free_mesh(mesh);
}

void pir_trimesh_describe(const pir_trimesh *mesh, pir_trimesh_info *ret_info) {
    pir_vec3 low = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (uint32_t i = 0; i < mesh->tree.item_count; i++) {
        pir_tri tri = pir_trimesh_tri(mesh, mesh->tree.item[i]);
        for (int k = 0; k < 3; k++) {
            low = (pir_vec3){fmin(low.x, tri.p[k].x), fmin(low.y, tri.p[k].y), fmin(low.z, tri.p[k].z)};
            high = (pir_vec3){fmax(high.x, tri.p[k].x), fmax(high.y, tri.p[k].y), fmax(high.z, tri.p[k].z)};
        }
    }
    *ret_info = (pir_trimesh_info){
        .vertices = mesh->vertex_count,
        .triangles = mesh->triangle_count,
        .degenerate = mesh->degenerate_count,
        .parts = mesh->part_count,
        .closed = mesh->closed,
        .two_sided = mesh->two_sided,
        .low = low,
        .high = high,
        .tree_bytes = mesh->tree.node_count * sizeof *mesh->tree.node +
                      mesh->tree.item_count * sizeof *mesh->tree.item + mesh->part_listed * sizeof *mesh->part_vertex,
    };
}

pir_status pir_trimesh_triangle(const pir_trimesh *mesh, uint32_t triangle, pir_triangle_corners *ret_corners) {
    if (!mesh || !ret_corners || triangle >= mesh->triangle_count)
        return PIR_ERR_ARGUMENT;
    pir_tri tri = pir_trimesh_tri(mesh, triangle);
    *ret_corners =
        (pir_triangle_corners){{tri.p[0], tri.p[1], tri.p[2]}, mesh->material ? mesh->material[triangle] : 0};
    return PIR_OK;
}

bool pir_trimesh_is_valid(const pir_trimesh *mesh) {
    const pir_mesh_source source = {mesh->vertex, (const uint32_t(*)[3])mesh->corner};
    return mesh->tree.item_count + mesh->degenerate_count == mesh->triangle_count &&
           pir_mesh_tree_is_valid(&mesh->tree, &source);
}
