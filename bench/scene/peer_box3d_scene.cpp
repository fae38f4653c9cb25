// SPDX-License-Identifier: MIT
// box3d: a world that steps by no time, in floats: pairs and manifolds, no solver. It may keep the manifolds of bodies
// that moved little, or not.
#include <algorithm>
#include <map>

#include <box3d/box3d.h>

#include "scene_peers.hpp"

namespace {

b3HullData *hull(const pir_polytope *p) {
    std::vector<b3Vec3> points;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
        pir_vec3 c = pir_polytope_vertex(p, v);
        points.push_back({(float)c.x, (float)c.y, (float)c.z});
    }
    return b3CreateHull(points.data(), (int)points.size(), (int)points.size());
}

class Box3dScene : public ScenePeer {
  public:
    Box3dScene(const Recording &recording, bool reuse) : reuse_(reuse), statics_(recording.statics.size()) {
        b3WorldDef world = b3DefaultWorldDef();
        world.gravity = {0, 0, 0};
        world.enableSleep = false;
        world_ = b3CreateWorld(&world);
        if (!reuse)
            b3World_SetContactRecycleDistance(world_, 0);
        std::map<const pir_polytope *, b3HullData *> hulls;
        for (const pir_polytope *p : recording.shapes)
            hulls[p] = hull(p);
        for (const RecordedBody &body : recording.statics)
            add(hulls[body.polytope], body.pose, b3_staticBody);
        for (size_t i = 0; i < recording.bodies.size(); i++)
            add(hulls[recording.bodies[i].polytope], recording.frames[0][i], b3_dynamicBody);
        for (auto &made : hulls)
            b3DestroyHull(made.second);
    }
    ~Box3dScene() override {
        b3DestroyWorld(world_);
    }
    const char *name() const override {
        return reuse_ ? "box3d reusing manifolds" : "box3d";
    }
    void set(const std::vector<uint32_t> &moved, const std::vector<pir_pose> &poses) override {
        for (uint32_t i : moved)
            b3Body_SetTransform(bodies_[statics_ + i], position(poses[i]), rotation(poses[i]));
        b3World_Step(world_, 0, 1);
    }
    void overlapping(std::vector<BodyPair> *ret_pairs) override {
        std::vector<b3ContactData> contacts(4096);
        for (uint32_t i = 0; i < bodies_.size(); i++) {
            int count = b3Body_GetContactData(bodies_[i], contacts.data(), (int)contacts.size());
            for (int k = 0; k < count; k++) {
                uint32_t a = number(contacts[(size_t)k].shapeIdA), b = number(contacts[(size_t)k].shapeIdB);
                // each contact is told by both of its bodies
                if (std::min(a, b) == i && overlaps(contacts[(size_t)k]))
                    ret_pairs->push_back({std::min(a, b), std::max(a, b)});
            }
        }
    }

  private:
    static b3Pos position(const pir_pose &pose) {
        return {(float)pose.translation.x, (float)pose.translation.y, (float)pose.translation.z};
    }
    static b3Quat rotation(const pir_pose &pose) {
        b3Quat q;
        q.v = {(float)pose.rotation.x, (float)pose.rotation.y, (float)pose.rotation.z};
        q.s = (float)pose.rotation.w;
        return q;
    }
    static uint32_t number(b3ShapeId shape) {
        return (uint32_t) reinterpret_cast<uintptr_t>(b3Shape_GetUserData(shape));
    }
    static bool overlaps(const b3ContactData &contact) {
        for (int m = 0; m < contact.manifoldCount; m++)
            for (int k = 0; k < contact.manifolds[m].pointCount; k++)
                if (contact.manifolds[m].points[k].separation <= 0)
                    return true;
        return false;
    }
    void add(const b3HullData *shape, const pir_pose &pose, b3BodyType type) {
        b3BodyDef body = b3DefaultBodyDef();
        body.type = type;
        body.position = position(pose);
        body.rotation = rotation(pose);
        b3ShapeDef def = b3DefaultShapeDef();
        def.userData = reinterpret_cast<void *>(bodies_.size());
        bodies_.push_back(b3CreateBody(world_, &body));
        b3CreateHullShape(bodies_.back(), &def, shape);
    }

    bool reuse_;
    size_t statics_;
    b3WorldId world_;
    std::vector<b3BodyId> bodies_;
};

} // namespace

std::unique_ptr<ScenePeer> make_box3d_scene(const Recording &recording, bool reuse) {
    for (const pir_polytope *p : recording.shapes)
        if (pir_polytope_edge_count(p) > 128)
            return nullptr;
    return std::make_unique<Box3dScene>(recording, reuse);
}
