/* SPDX-License-Identifier: MIT */
/*
 * box3d: a world that steps by no time, in floats. Its height fields have heights along y and rows along z: x, y, z
 * here are its z, x, y.
 */
#include <stdlib.h>

#include <box3d/box3d.h>

#include "terrain_peer.h"

#define MOST_POINTS 64

struct terrain_peer {
    b3WorldId world;
    b3BodyId *body;
    b3HeightFieldData *field;
};

const char *terrain_peer_name(void) {
    return "box3d";
}

static b3Vec3 seen(pir_vec3 v) {
    return (b3Vec3){(float)v.y, (float)v.z, (float)v.x};
}

static b3Quat turned(pir_quat q) {
    return b3NormalizeQuat((b3Quat){seen((pir_vec3){q.x, q.y, q.z}), (float)q.w});
}

static void add_ground(struct terrain_peer *peer, const struct terrain_ground *ground) {
    const int side = ground->side;
    float *heights = calloc((size_t)side * (size_t)side, sizeof *heights);
    uint8_t *materials = calloc((size_t)side * (size_t)side, 1);
    for (int i = 0; heights && i < side; i++)
        for (int j = 0; j < side; j++)
            heights[i * side + j] = ground->heights[j * side + i];
    const b3HeightFieldDef def = {.heights = heights,
                                  .materialIndices = materials,
                                  .scale = {1, 1, 1},
                                  .countX = side,
                                  .countZ = side,
                                  .globalMinimumHeight = ground->low,
                                  .globalMaximumHeight = ground->high};
    peer->field = b3CreateHeightField(&def);
    free(heights);
    free(materials);
    const b3BodyDef body = b3DefaultBodyDef();
    const b3ShapeDef shape = b3DefaultShapeDef();
    b3CreateHeightFieldShape(b3CreateBody(peer->world, &body), &shape, peer->field);
}

static void add_hull(struct terrain_peer *peer, size_t i, const pir_polytope *hull, const pir_pose *pose) {
    b3Vec3 point[MOST_POINTS];
    const uint32_t count = pir_polytope_vertex_count(hull);
    for (uint32_t v = 0; v < count && v < MOST_POINTS; v++)
        point[v] = seen(pir_polytope_vertex(hull, v));
    b3HullData *made = b3CreateHull(point, (int)count, (int)count);
    b3BodyDef body = b3DefaultBodyDef();
    b3ShapeDef shape = b3DefaultShapeDef();
    body.type = b3_dynamicBody;
    body.position = seen(pose->translation);
    body.rotation = turned(pose->rotation);
    peer->body[i] = b3CreateBody(peer->world, &body);
    b3CreateHullShape(peer->body[i], &shape, made);
    b3DestroyHull(made);
}

struct terrain_peer *terrain_peer_make(const struct terrain_ground *ground, pir_polytope *const *hulls,
                                       const pir_scene_move *poses, size_t count) {
    struct terrain_peer *peer = calloc(1, sizeof *peer);
    b3WorldDef world = b3DefaultWorldDef();
    if (!peer || !(peer->body = calloc(count, sizeof *peer->body)))
        abort();
    world.gravity = (b3Vec3){0, 0, 0};
    world.enableSleep = false;
    peer->world = b3CreateWorld(&world);
    b3World_SetContactRecycleDistance(peer->world, 0);
    add_ground(peer, ground);
    for (size_t i = 0; i < count; i++)
        add_hull(peer, i, hulls[i], &poses[i].pose);
    b3World_Step(peer->world, 0, 1);
    return peer;
}

void terrain_peer_free(struct terrain_peer *peer) {
    b3DestroyWorld(peer->world);
    b3DestroyHeightField(peer->field);
    free(peer->body);
    free(peer);
}

double terrain_peer_ray(struct terrain_peer *peer, pir_vec3 origin, pir_vec3 way) {
    const b3RayResult result = b3World_CastRayClosest(peer->world, seen(origin), seen(way), b3DefaultQueryFilter());
    return result.hit ? (double)result.fraction : 1;
}

/* A callback of the peer's form, of eight parameters. */
#define CALLBACK(name)                                                                                                 \
    static float name(b3ShapeId shape, b3Vec3 point, b3Vec3 normal, float fraction, uint64_t material, int triangle,   \
                      int child, void *context)

CALLBACK(take) {
    (void)shape, (void)point, (void)normal, (void)material, (void)triangle, (void)child;
    *(float *)context = fraction;
    return fraction;
}

double terrain_peer_capsule(struct terrain_peer *peer, double half, double radius, pir_vec3 origin, pir_vec3 way) {
    const b3Vec3 end[2] = {{0, (float)-half, 0}, {0, (float)half, 0}};
    const b3ShapeProxy proxy = {end, 2, (float)radius};
    float time = 1;
    b3World_CastShape(peer->world, seen(origin), &proxy, seen(way), b3DefaultQueryFilter(), take, &time);
    return time;
}

void terrain_peer_update(struct terrain_peer *peer, const pir_scene_move *poses, size_t count, double *ret_collision) {
    for (size_t i = 0; i < count; i++)
        b3Body_SetTransform(peer->body[i], seen(poses[i].pose.translation), turned(poses[i].pose.rotation));
    b3World_Step(peer->world, 0, 1);
    const b3Profile profile = b3World_GetProfile(peer->world);
    *ret_collision = ((double)profile.pairs + (double)profile.collide) * 1e6;
}
