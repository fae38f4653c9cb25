/* SPDX-License-Identifier: MIT */
/* Shapes of bodies: see pirouette/body_shape.h. Each is made of pieces with a radius, or of a surface. */
#include <pirouette/body_shape.h>

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>

#include "base/memory.h"
#include "base/report.h"
#include "base/vec.h"

#define SIDES_USUAL 32u
#define SIDES_MOST  1024u
#define PIECES_MOST 4096u

struct pir_body_shape {
    atomic_uint references;
    pir_allocator allocator;
    pir_polytope **piece;
    uint32_t pieces;
    double radius;
    pir_trimesh *mesh;
    pir_height_field *field;
    pir_mass mass; /* of pieces */
    char text[128];
};

/* A shape to be: what all constructors are given. */
struct shape_call {
    const char *name;
    const pir_allocator *allocator;
    pir_report *report;
    pir_body_shape **ret_shape;
};

/* --- checks --- */

static pir_status refuse(const struct shape_call *call, const char *what, double value) {
    return pir_fail(call->report, isnan(value) ? PIR_ERR_NOT_FINITE : PIR_ERR_ARGUMENT, "%s: its %s is %g", call->name,
                    what, value);
}

/* A length has to be finite, and at least `least`, or above 0 where that is below 0. */
static pir_status check_length(const struct shape_call *call, const char *what, double value, double least) {
    if (!call->ret_shape)
        return pir_fail(call->report, PIR_ERR_ARGUMENT, "%s: ret_shape is NULL", call->name);
    const bool is_right = isfinite(value) && (least < 0 ? value > 0 : value >= least);
    return is_right ? PIR_OK : refuse(call, what, value);
}

static pir_status check_point(const struct shape_call *call, const char *what, pir_vec3 point) {
    const double at[3] = {point.x, point.y, point.z};
    for (int k = 0; k < 3; k++)
        if (!isfinite(at[k]))
            return pir_fail(call->report, PIR_ERR_NOT_FINITE, "%s: its %s: %c is %g", call->name, what, "xyz"[k],
                            at[k]);
    return PIR_OK;
}

/* --- what all share --- */

/* A shape without pieces yet, with room for some. */
static pir_status new_shape(const struct shape_call *call, uint32_t pieces, double radius, pir_body_shape **ret_shape) {
    const pir_allocator a = pir_allocator_or_default(call->allocator);
    pir_body_shape *shape = PIR_ZEROED(&a, pir_body_shape, 1);
    pir_polytope **piece = shape && pieces > 0 ? PIR_ZEROED(&a, pir_polytope *, pieces) : NULL;
    if (!shape || (pieces > 0 && !piece)) {
        PIR_FREE(&a, shape, 1);
        return pir_fail(call->report, PIR_ERR_MEMORY, "%s: %s", call->name, pir_status_text(PIR_ERR_MEMORY));
    }
    atomic_init(&shape->references, 1);
    shape->allocator = a;
    shape->piece = piece;
    shape->pieces = pieces;
    shape->radius = radius;
    *ret_shape = shape;
    return PIR_OK;
}

/* The mass of all pieces together. */
static pir_status weigh(pir_body_shape *shape) {
    for (uint32_t i = 0; i < shape->pieces; i++) {
        pir_mass mass[2];
        pir_status status = pir_polytope_rounded_mass(shape->piece[i], shape->radius, &mass[1]);
        mass[0] = shape->mass;
        if (status == PIR_OK)
            status = i == 0 ? PIR_OK : pir_mass_combine(mass, 2, &mass[1]);
        if (status != PIR_OK)
            return status;
        shape->mass = mass[1];
    }
    return PIR_OK;
}

/* Gives a shape that has its pieces to the caller, or takes it back. */
static pir_status give(const struct shape_call *call, pir_body_shape *shape, pir_status status) {
    if (status == PIR_OK)
        status = weigh(shape);
    if (status != PIR_OK) {
        pir_body_shape_release(shape);
        return pir_fail(call->report, status, "%s: %s", call->name, pir_status_text(status));
    }
    *call->ret_shape = shape;
    return PIR_OK;
}

/* A shape of one piece, the hull of points. Its text is the caller's to write. */
static pir_status make(const struct shape_call *call, const pir_vec3 *points, size_t count, double radius,
                       pir_body_shape **ret_shape) {
    pir_status status = new_shape(call, 1, radius, ret_shape);
    if (status != PIR_OK)
        return status;
    pir_polytope_options options = pir_polytope_options_default();
    options.allocator = call->allocator;
    status = pir_polytope_create(points, count, &options, &(*ret_shape)->piece[0]);
    if (status == PIR_OK)
        return PIR_OK;
    pir_body_shape_release(*ret_shape);
    return pir_fail(call->report, status, "%s: its hull: %s", call->name, pir_status_text(status));
}

/* --- constructors --- */

pir_status pir_body_shape_ball(double radius, const pir_allocator *allocator, pir_report *report,
                               pir_body_shape **ret_shape) {
    const struct shape_call call = {"ball", allocator, report, ret_shape};
    const pir_vec3 centre = {0, 0, 0};
    pir_body_shape *shape;
    pir_status status = check_length(&call, "radius", radius, -1);
    if (status == PIR_OK)
        status = make(&call, &centre, 1, radius, &shape);
    if (status != PIR_OK)
        return status;
    snprintf(shape->text, sizeof shape->text, "ball of radius %g", radius);
    return give(&call, shape, PIR_OK);
}

pir_status pir_body_shape_capsule(pir_vec3 a, pir_vec3 b, double radius, const pir_allocator *allocator,
                                  pir_report *report, pir_body_shape **ret_shape) {
    const struct shape_call call = {"capsule", allocator, report, ret_shape};
    const pir_vec3 ends[2] = {a, b}, way = pir_vec_sub(b, a);
    pir_body_shape *shape;
    pir_status status = check_length(&call, "radius", radius, -1);
    if (status == PIR_OK)
        status = check_point(&call, "first end", a);
    if (status == PIR_OK)
        status = check_point(&call, "second end", b);
    if (status == PIR_OK)
        status = make(&call, ends, 2, radius, &shape);
    if (status != PIR_OK)
        return status;
    snprintf(shape->text, sizeof shape->text, "capsule of radius %g, %g between the centres of its ends", radius,
             sqrt(pir_vec_dot(way, way)));
    return give(&call, shape, PIR_OK);
}

pir_status pir_body_shape_box(pir_vec3 half, double radius, const pir_allocator *allocator, pir_report *report,
                              pir_body_shape **ret_shape) {
    const struct shape_call call = {"box", allocator, report, ret_shape};
    const double edge[3] = {half.x, half.y, half.z};
    pir_body_shape *shape;
    pir_vec3 corner[8];
    pir_status status = check_length(&call, "radius", radius, 0);
    for (int k = 0; k < 3 && status == PIR_OK; k++)
        status = check_length(&call, "half edge, which the radius is part of,", edge[k], radius > 0 ? radius : -1);
    for (int i = 0; i < 8; i++)
        corner[i] = (pir_vec3){(i & 1 ? 1 : -1) * (half.x - radius), (i & 2 ? 1 : -1) * (half.y - radius),
                               (i & 4 ? 1 : -1) * (half.z - radius)};
    if (status == PIR_OK)
        status = make(&call, corner, 8, radius, &shape);
    if (status != PIR_OK)
        return status;
    snprintf(shape->text, sizeof shape->text, "box of %g × %g × %g, radius %g", 2 * half.x, 2 * half.y, 2 * half.z,
             radius);
    return give(&call, shape, PIR_OK);
}

/* Corners of a regular polygon of a radius at a height. */
static void put_ring(pir_vec3 *corner, double radius, double z, uint32_t sides) {
    const double turn = 2 * 3.14159265358979323846 / sides;
    for (uint32_t i = 0; i < sides; i++)
        corner[i] = (pir_vec3){radius * cos(i * turn), radius * sin(i * turn), z};
}

/* A cylinder, or a cone, whose upper ring is one point. */
static pir_status make_round(const struct shape_call *call, double radius, double height, uint32_t sides,
                             bool is_cone) {
    pir_vec3 corner[2 * SIDES_MOST];
    pir_body_shape *shape;
    const uint32_t used = sides == 0 ? SIDES_USUAL : sides;
    pir_status status = check_length(call, "radius", radius, -1);
    if (status == PIR_OK)
        status = check_length(call, "height", height, -1);
    if (status != PIR_OK)
        return status;
    if (used < 3 || used > SIDES_MOST)
        return pir_fail(call->report, PIR_ERR_ARGUMENT, "%s: %u sides, not 3 to %u", call->name, (unsigned)used,
                        SIDES_MOST);
    put_ring(corner, radius, is_cone ? -height / 4 : -height / 2, used);
    if (is_cone)
        corner[used] = (pir_vec3){0, 0, 0.75 * height};
    else
        put_ring(corner + used, radius, height / 2, used);
    status = make(call, corner, is_cone ? used + 1 : 2 * used, 0, &shape);
    if (status != PIR_OK)
        return status;
    snprintf(shape->text, sizeof shape->text, "%s of radius %g and height %g, with %u sides", call->name, radius,
             height, (unsigned)used);
    return give(call, shape, PIR_OK);
}

pir_status pir_body_shape_cylinder(double radius, double height, uint32_t sides, const pir_allocator *allocator,
                                   pir_report *report, pir_body_shape **ret_shape) {
    return make_round(&(struct shape_call){"cylinder", allocator, report, ret_shape}, radius, height, sides, false);
}

pir_status pir_body_shape_cone(double radius, double height, uint32_t sides, const pir_allocator *allocator,
                               pir_report *report, pir_body_shape **ret_shape) {
    return make_round(&(struct shape_call){"cone", allocator, report, ret_shape}, radius, height, sides, true);
}

/* Two unit vectors that are orthogonal to a unit one and to each other; along axes where that one is. */
static void find_tangents(pir_vec3 n, pir_vec3 *ret_u, pir_vec3 *ret_v) {
    const double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    const pir_vec3 axis = x <= y && x <= z ? (pir_vec3){1, 0, 0} : y <= z ? (pir_vec3){0, 1, 0} : (pir_vec3){0, 0, 1};
    const pir_vec3 u = pir_vec_cross(n, axis);
    *ret_u = pir_vec_scale(u, 1 / sqrt(pir_vec_dot(u, u)));
    *ret_v = pir_vec_cross(n, *ret_u);
}

pir_status pir_body_shape_plane(pir_vec3 normal, double offset, double reach, const pir_allocator *allocator,
                                pir_report *report, pir_body_shape **ret_shape) {
    const struct shape_call call = {"plane", allocator, report, ret_shape};
    const double length = sqrt(pir_vec_dot(normal, normal));
    pir_vec3 corner[8], u, v;
    pir_body_shape *shape;
    pir_status status = check_length(&call, "reach", reach, -1);
    if (status == PIR_OK)
        status = check_point(&call, "normal", normal);
    if (status == PIR_OK && !isfinite(offset))
        status = refuse(&call, "offset", offset);
    if (status == PIR_OK && !(length > 0 && length < HUGE_VAL))
        status = refuse(&call, "normal's length", length);
    if (status != PIR_OK)
        return status;
    const pir_vec3 n = pir_vec_scale(normal, 1 / length);
    find_tangents(n, &u, &v);
    for (int i = 0; i < 8; i++) {
        const pir_vec3 along =
            pir_vec_add(pir_vec_scale(u, i & 1 ? reach : -reach), pir_vec_scale(v, i & 2 ? reach : -reach));
        corner[i] = pir_vec_add(along, pir_vec_scale(n, i & 4 ? offset : offset - reach));
    }
    status = make(&call, corner, 8, 0, &shape);
    if (status != PIR_OK)
        return status;
    snprintf(shape->text, sizeof shape->text, "plane with normal (%g, %g, %g) at %g, as far as %g", n.x, n.y, n.z,
             offset, reach);
    return give(&call, shape, PIR_OK);
}

pir_status pir_body_shape_hull(const pir_vec3 *points, size_t count, double radius, const pir_allocator *allocator,
                               pir_report *report, pir_body_shape **ret_shape) {
    const struct shape_call call = {"hull", allocator, report, ret_shape};
    pir_body_shape *shape;
    pir_status status = check_length(&call, "radius", radius, 0);
    if (status == PIR_OK)
        status = make(&call, points, count, radius, &shape);
    if (status != PIR_OK)
        return status;
    snprintf(shape->text, sizeof shape->text, "hull of %u vertices, radius %g",
             (unsigned)pir_polytope_vertex_count(shape->piece[0]), radius);
    return give(&call, shape, PIR_OK);
}

/* Checks the parts of a compound; the number of their pieces. */
static pir_status count_pieces(const struct shape_call *call, const pir_body_part *parts, size_t count,
                               uint32_t *ret_pieces) {
    uint32_t pieces = 0;
    if (!call->ret_shape || !parts || count == 0)
        return pir_fail(call->report, PIR_ERR_ARGUMENT, "compound: it has no parts, or ret_shape is NULL");
    for (size_t i = 0; i < count; i++) {
        const pir_body_shape *part = parts[i].shape;
        if (!part || part->pieces == 0)
            return pir_fail(call->report, PIR_ERR_ARGUMENT, "compound: part %zu is NULL or a surface", i);
        if (part->radius != parts[0].shape->radius)
            return pir_fail(call->report, PIR_ERR_ARGUMENT, "compound: part %zu has radius %g, the first one %g", i,
                            part->radius, parts[0].shape->radius);
        if (part->pieces > PIECES_MOST - pieces)
            return pir_fail(call->report, PIR_ERR_LIMIT, "compound: more than %u pieces", PIECES_MOST);
        pieces += part->pieces;
    }
    *ret_pieces = pieces;
    return PIR_OK;
}

pir_status pir_body_shape_compound(const pir_body_part *parts, size_t count, const pir_allocator *allocator,
                                   pir_report *report, pir_body_shape **ret_shape) {
    const struct shape_call call = {"compound", allocator, report, ret_shape};
    pir_body_shape *shape;
    uint32_t pieces = 0, next = 0;
    pir_status status = count_pieces(&call, parts, count, &pieces);
    if (status == PIR_OK)
        status = new_shape(&call, pieces, parts[0].shape->radius, &shape);
    if (status != PIR_OK)
        return status;
    for (size_t i = 0; i < count && status == PIR_OK; i++)
        for (uint32_t k = 0; k < parts[i].shape->pieces && status == PIR_OK; k++)
            status = pir_polytope_transform(parts[i].shape->piece[k], parts[i].pose, &shape->piece[next++]);
    snprintf(shape->text, sizeof shape->text, "compound of %zu parts in %u pieces, radius %g", count, (unsigned)pieces,
             shape->radius);
    return give(&call, shape, status);
}

/* A shape with a surface. */
static pir_status make_surface(const struct shape_call *call, pir_trimesh *mesh, pir_height_field *field,
                               double radius) {
    pir_body_shape *shape;
    pir_status status = check_length(call, "radius", radius, 0);
    if (status == PIR_OK && !mesh && !field)
        status = pir_fail(call->report, PIR_ERR_ARGUMENT, "%s: it is NULL", call->name);
    if (status == PIR_OK)
        status = new_shape(call, 0, radius, &shape);
    if (status != PIR_OK)
        return status;
    shape->mesh = mesh ? pir_trimesh_retain(mesh) : NULL;
    shape->field = field ? pir_height_field_retain(field) : NULL;
    snprintf(shape->text, sizeof shape->text, "%s, radius %g", call->name, radius);
    return give(call, shape, PIR_OK);
}

pir_status pir_body_shape_mesh(pir_trimesh *mesh, double radius, const pir_allocator *allocator, pir_report *report,
                               pir_body_shape **ret_shape) {
    return make_surface(&(struct shape_call){"mesh", allocator, report, ret_shape}, mesh, NULL, radius);
}

pir_status pir_body_shape_field(pir_height_field *field, double radius, const pir_allocator *allocator,
                                pir_report *report, pir_body_shape **ret_shape) {
    return make_surface(&(struct shape_call){"height field", allocator, report, ret_shape}, NULL, field, radius);
}

/* --- life and reading --- */

pir_body_shape *pir_body_shape_retain(pir_body_shape *shape) {
    if (shape)
        atomic_fetch_add_explicit(&shape->references, 1, memory_order_relaxed);
    return shape;
}

void pir_body_shape_release(pir_body_shape *shape) {
    if (!shape || atomic_fetch_sub_explicit(&shape->references, 1, memory_order_acq_rel) != 1)
        return;
    const pir_allocator a = shape->allocator;
    for (uint32_t i = 0; i < shape->pieces; i++)
        pir_polytope_release(shape->piece[i]);
    pir_trimesh_release(shape->mesh);
    pir_height_field_release(shape->field);
    PIR_FREE(&a, shape->piece, shape->pieces);
    PIR_FREE(&a, shape, 1);
}

pir_body_options pir_body_shape_options(const pir_body_shape *shape) {
    pir_body_options options = pir_body_options_default();
    if (!shape)
        return options;
    options.pieces = shape->piece;
    options.piece_count = shape->pieces;
    options.radius = shape->radius;
    options.mesh = shape->mesh;
    options.field = shape->field;
    options.kind = shape->pieces > 0 ? PIR_BODY_MOVING : PIR_BODY_STATIC;
    return options;
}

pir_status pir_body_shape_mass(const pir_body_shape *shape, pir_mass *ret_mass) {
    if (!shape || !ret_mass || shape->pieces == 0)
        return PIR_ERR_ARGUMENT;
    *ret_mass = shape->mass;
    return PIR_OK;
}

const char *pir_body_shape_text(const pir_body_shape *shape) {
    return shape ? shape->text : "no shape";
}
