/* SPDX-License-Identifier: MIT */
/* Box3d: meshes with welded vertices and known edges, as it has them at its best; four substeps a frame. */
#include <stdlib.h>

#include <box3d/box3d.h>

#include "sliding_peer.h"

#define MANIFOLDS 512

static b3Vec3 vec(pir_vec3 v) {
    return (b3Vec3){(float)v.x, (float)v.y, (float)v.z};
}

static b3HullData *hull_of(const pir_vec3 *point, uint32_t count) {
    b3Vec3 points[64];
    for (uint32_t i = 0; i < count; i++)
        points[i] = vec(point[i]);
    return b3CreateHull(points, (int)count, 64);
}

static b3MeshData *mesh_of(const slide_part *part) {
    b3Vec3 *points = calloc(3 * (size_t)part->count, sizeof *points);
    int32_t *index = calloc(3 * (size_t)part->count, sizeof *index);
    b3MeshDef def = {.vertices = points,
                     .indices = index,
                     .vertexCount = 3 * (int)part->count,
                     .triangleCount = (int)part->count,
                     .weldTolerance = 1e-4f,
                     .weldVertices = true,
                     .identifyEdges = true};
    for (uint32_t i = 0; points && index && i < 3 * part->count; i++) {
        points[i] = vec(part->corner[i / 3][i % 3]);
        index[i] = (int32_t)i;
    }
    b3MeshData *mesh = points && index ? b3CreateMesh(&def, NULL, 0) : NULL;
    free(points);
    free(index);
    return mesh;
}

static b3ShapeDef smooth(void) {
    b3ShapeDef def = b3DefaultShapeDef();
    def.baseMaterial.friction = 0;
    def.baseMaterial.restitution = 0;
    return def;
}

/* Hulls are copied by the world, meshes are the caller's: *ret_mesh, or NULL. */
static void add_part(b3WorldId world, const slide_part *part, bool hull, b3MeshData **ret_mesh) {
    const b3BodyDef def = b3DefaultBodyDef();
    const b3ShapeDef shape = smooth();
    const b3BodyId body = b3CreateBody(world, &def);
    *ret_mesh = NULL;
    if (hull) {
        b3HullData *made = hull_of(part->corner[0], 3 * part->count);
        b3CreateHullShape(body, &shape, made);
        b3DestroyHull(made);
        return;
    }
    *ret_mesh = mesh_of(part);
    b3CreateMeshShape(body, &shape, *ret_mesh, (b3Vec3){1, 1, 1});
}

static b3BodyId add_slider(b3WorldId world, const slider *from, double speed) {
    b3BodyDef def = b3DefaultBodyDef();
    const b3ShapeDef shape = smooth();
    def.type = b3_dynamicBody;
    def.enableSleep = false;
    def.position =
        (b3Pos){(float)from->pose.translation.x, (float)from->pose.translation.y, (float)from->pose.translation.z};
    def.linearVelocity = (b3Vec3){(float)speed, (float)(0.05 * speed), 0};
    const b3BodyId body = b3CreateBody(world, &def);
    for (uint32_t k = 0; k < from->pieces; k++) {
        pir_vec3 vertex[64];
        const uint32_t count = pir_polytope_vertex_count(from->piece[k]);
        for (uint32_t i = 0; i < count; i++)
            vertex[i] = pir_polytope_vertex(from->piece[k], i);
        if (from->radius > 0) {
            const b3Capsule capsule = {vec(vertex[0]), vec(vertex[1]), (float)from->radius};
            b3CreateCapsuleShape(body, &shape, &capsule);
            continue;
        }
        b3HullData *hull = hull_of(vertex, count);
        b3CreateHullShape(body, &shape, hull);
        b3DestroyHull(hull);
    }
    return body;
}

static void count_contacts(b3BodyId body, slide_result *result) {
    static b3ContactData contact[MANIFOLDS];
    const int count = b3Body_GetContactData(body, contact, MANIFOLDS);
    for (int i = 0; i < count; i++)
        for (int m = 0; m < contact[i].manifoldCount; m++) {
            const b3Manifold *manifold = &contact[i].manifolds[m];
            uint64_t pushing = 0;
            for (int k = 0; k < manifold->pointCount; k++)
                pushing += manifold->points[k].totalNormalImpulse > 0;
            slide_count(result, manifold->normal.x, manifold->normal.y, pushing);
        }
}

void box3d_slide(const slide_floor *floor, const slider *body, double speed, uint32_t frames,
                 slide_result *ret_result) {
    b3WorldDef def = b3DefaultWorldDef();
    def.gravity = (b3Vec3){0, 0, -9.81f};
    const b3WorldId world = b3CreateWorld(&def);
    b3MeshData **mesh = calloc(floor->count, sizeof(void *));
    const double start = body->pose.translation.z;
    *ret_result = (slide_result){0};
    for (uint32_t i = 0; mesh && i < floor->count; i++)
        add_part(world, &floor->part[i], floor->hulls, &mesh[i]);
    const b3BodyId id = add_slider(world, body, speed);
    for (uint32_t frame = 0; mesh && frame < frames; frame++) {
        b3Pos p = b3Body_GetPosition(id);
        pir_vec3 at = {p.x, p.y, p.z};
        if (slide_goes_round(&at))
            b3Body_SetTransform(id, (b3Pos){(float)at.x, (float)at.y, (float)at.z}, b3Body_GetRotation(id));
        b3World_Step(world, 1.f / 60, 4);
        count_contacts(id, ret_result);
        const b3Vec3 v = b3Body_GetLinearVelocity(id);
        slide_note(ret_result, v.x, v.y, speed, b3Body_GetPosition(id).z - start);
    }
    b3DestroyWorld(world);
    for (uint32_t i = 0; mesh && i < floor->count; i++)
        if (mesh[i])
            b3DestroyMesh(mesh[i]);
    free(mesh);
}
