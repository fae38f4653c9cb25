/* SPDX-License-Identifier: MIT */
/*
 * Writing STL: triangles, of which each facet is a fan about its first corner.
 *
 * Binary STL has floats. It is written where these hold every coordinate exactly; else STL as text, whose decimals read
 * back as the same doubles. So nothing is lost, and neighbours that touch in the mesh touch in the file.
 */
#include "polytope/write/write_stl.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>

#include "base/report.h"
#include "base/vec.h"
#include "polytope/file/c_locale.h"
#include "polytope/mesh.h"
#include "polytope/write/write_bytes.h"
#include "polytope/write/write_number.h"

#define HEADER_BYTES 80

/* --- triangles --- */

/* Walks the triangles of a mesh; begins as {mesh}. */
struct triangles {
    const pir_mesh *mesh;
    uint32_t facet, at; /* the next one has the corners 0, at + 1, at + 2 of this facet */
    pir_vec3 corner[3];
};

static bool next_triangle(struct triangles *walk) {
    uint32_t count = 0;
    for (; walk->facet < pir_mesh_facet_count(walk->mesh); walk->facet++, walk->at = 0) {
        const uint32_t *corners = pir_mesh_facet(walk->mesh, walk->facet, &count);
        if (walk->at + 2 >= count)
            continue;
        const pir_vec3 *vertices = pir_mesh_vertices(walk->mesh);
        walk->corner[0] = vertices[corners[0]];
        walk->corner[1] = vertices[corners[walk->at + 1]];
        walk->corner[2] = vertices[corners[walk->at + 2]];
        walk->at++;
        return true;
    }
    return false;
}

/* The unit normal in floats, or zeros where rounding leaves none. */
static void normal_of(const struct triangles *walk, float ret_normal[3]) {
    double most = 0;
    for (int k = 0; k < 3; k++)
        most = fmax(most, fmax(fabs(walk->corner[k].x), fmax(fabs(walk->corner[k].y), fabs(walk->corner[k].z))));
    int exponent = 0;
    frexp(most, &exponent);
    // about size one: products of what is larger or smaller may leave the doubles
    pir_vec3 edge[2];
    for (int k = 0; k < 2; k++) {
        const pir_vec3 *from = &walk->corner[0], *to = &walk->corner[k + 1];
        edge[k] = (pir_vec3){ldexp(to->x, -exponent) - ldexp(from->x, -exponent),
                             ldexp(to->y, -exponent) - ldexp(from->y, -exponent),
                             ldexp(to->z, -exponent) - ldexp(from->z, -exponent)};
    }
    const pir_vec3 n = pir_vec_cross(edge[0], edge[1]);
    const double length = sqrt(pir_vec_dot(n, n));
    const double part[3] = {n.x, n.y, n.z};
    for (int k = 0; k < 3; k++)
        ret_normal[k] = length > 0 ? (float)(part[k] / length) : 0;
}

/* --- the two forms --- */

static bool is_float(double value) {
    // beyond the floats the conversion is not defined
    return fabs(value) <= (double)FLT_MAX && (double)(float)value == value;
}

/* Whether binary STL holds the mesh as it is. */
static bool fits_binary(const pir_mesh *mesh, uint64_t triangles) {
    const pir_vec3 *vertices = pir_mesh_vertices(mesh);
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh); v++)
        if (!is_float(vertices[v].x) || !is_float(vertices[v].y) || !is_float(vertices[v].z))
            return false;
    return triangles <= UINT32_MAX;
}

static void write_vector(FILE *file, float x, float y, float z) {
    pir_write_float(file, x);
    pir_write_float(file, y);
    pir_write_float(file, z);
}

static void write_binary(const pir_mesh *mesh, FILE *file, uint32_t count) {
    // it must not begin with "solid", as text does
    fprintf(file, "%-*s", HEADER_BYTES, "binary STL");
    pir_write_bytes(file, count, 4);
    float n[3];
    for (struct triangles walk = {.mesh = mesh}; next_triangle(&walk);) {
        normal_of(&walk, n);
        write_vector(file, n[0], n[1], n[2]);
        for (int k = 0; k < 3; k++)
            write_vector(file, (float)walk.corner[k].x, (float)walk.corner[k].y, (float)walk.corner[k].z);
        pir_write_bytes(file, 0, 2);
    }
}

static void write_text(const pir_mesh *mesh, FILE *file) {
    fputs("solid mesh\n", file);
    float n[3];
    for (struct triangles walk = {.mesh = mesh}; next_triangle(&walk);) {
        normal_of(&walk, n);
        fprintf(file, "facet normal %.9g %.9g %.9g\nouter loop\n", (double)n[0], (double)n[1], (double)n[2]);
        for (int k = 0; k < 3; k++) {
            fputs("vertex ", file);
            pir_write_number(file, walk.corner[k].x, ' ');
            pir_write_number(file, walk.corner[k].y, ' ');
            pir_write_number(file, walk.corner[k].z, '\n');
        }
        fputs("endloop\nendfacet\n", file);
    }
    fputs("endsolid mesh\n", file);
}

pir_status pir_mesh_write_stl(const pir_mesh *mesh, FILE *file, const char *name, pir_report *report) {
    if (pir_mesh_facet_count(mesh) == 0)
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: .stl holds facets and a %s has none; .off holds it", name,
                        pir_mesh_vertex_count(mesh) > 1 ? "segment" : "point");
    if (mesh->of_solid)
        return pir_fail(report, PIR_ERR_ARGUMENT,
                        "%s: .stl holds triangles, and facets of a sum of solids may have holes; .off holds them",
                        name);
    uint64_t triangles = 0;
    uint32_t corners;
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        pir_mesh_facet(mesh, f, &corners);
        triangles += corners - 2;
    }
    if (fits_binary(mesh, triangles)) {
        write_binary(mesh, file, (uint32_t)triangles);
        return PIR_OK;
    }
    struct pir_c_locale locale;
    if (!pir_c_locale_enter(&locale))
        return pir_fail(report, PIR_ERR_MEMORY, "%s: out of memory", name);
    write_text(mesh, file);
    pir_c_locale_leave(&locale);
    return PIR_OK;
}
