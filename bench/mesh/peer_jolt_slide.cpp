// SPDX-License-Identifier: MIT
// Jolt with its enhanced removal of inner edges; one collision step a frame, as it advises for 60 Hz. Impulses are not
// told: a contact pushes where its points would meet within the frame.
#include <Jolt/Jolt.h>

#include <Jolt/Core/Factory.h>
#include <Jolt/Core/JobSystemSingleThreaded.h>
#include <Jolt/Core/TempAllocator.h>
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Collision/Shape/CapsuleShape.h>
#include <Jolt/Physics/Collision/Shape/ConvexHullShape.h>
#include <Jolt/Physics/Collision/Shape/MeshShape.h>
#include <Jolt/Physics/Collision/Shape/RotatedTranslatedShape.h>
#include <Jolt/Physics/Collision/Shape/StaticCompoundShape.h>
#include <Jolt/Physics/PhysicsSystem.h>
#include <Jolt/RegisterTypes.h>

#include "sliding_peer.h"

namespace {

using namespace JPH;

constexpr float FRAME = 1.f / 60;
constexpr ObjectLayer STILL = 0, MOVES = 1;

Vec3 vec(pir_vec3 v) {
    return Vec3((float)v.x, (float)v.y, (float)v.z);
}

/* Two layers: bodies that stand still do not meet each other. */
class Layers : public BroadPhaseLayerInterface, public ObjectVsBroadPhaseLayerFilter, public ObjectLayerPairFilter {
  public:
    uint GetNumBroadPhaseLayers() const override {
        return 2;
    }
    BroadPhaseLayer GetBroadPhaseLayer(ObjectLayer layer) const override {
        return BroadPhaseLayer((BroadPhaseLayer::Type)layer);
    }
    bool ShouldCollide(ObjectLayer a, BroadPhaseLayer b) const override {
        return a == MOVES || (BroadPhaseLayer::Type)b == MOVES;
    }
    bool ShouldCollide(ObjectLayer a, ObjectLayer b) const override {
        return a == MOVES || b == MOVES;
    }
};

class Counter : public ContactListener {
  public:
    slide_result result = slide_result();
    void OnContactAdded(const Body &a, const Body &b, const ContactManifold &manifold, ContactSettings &) override {
        count(a, b, manifold);
    }
    void OnContactPersisted(const Body &a, const Body &b, const ContactManifold &manifold, ContactSettings &) override {
        count(a, b, manifold);
    }

  private:
    void count(const Body &a, const Body &b, const ContactManifold &manifold) {
        const Vec3 n = manifold.mWorldSpaceNormal; // from a to b
        uint64_t pushing = 0;
        for (uint i = 0; i < manifold.mRelativeContactPointsOn1.size(); i++) {
            const Vec3 on_a = manifold.mRelativeContactPointsOn1[i], on_b = manifold.mRelativeContactPointsOn2[i];
            const RVec3 at = manifold.mBaseOffset + on_a;
            const float gap = (on_b - on_a).Dot(n), nearing = (a.GetPointVelocity(at) - b.GetPointVelocity(at)).Dot(n);
            pushing += nearing * FRAME > gap;
        }
        slide_count(&result, n.GetX(), n.GetY(), pushing);
    }
};

ShapeRefC made(const ShapeSettings &settings) {
    const ShapeSettings::ShapeResult result = settings.Create();
    if (result.HasError()) {
        fprintf(stderr, "Jolt: %s\n", result.GetError().c_str());
        exit(2);
    }
    return result.Get();
}

ShapeRefC hull_of(const pir_vec3 *point, uint32_t count) {
    Array<Vec3> points;
    for (uint32_t i = 0; i < count; i++)
        points.push_back(vec(point[i]));
    ConvexHullShapeSettings settings(points);
    settings.SetEmbedded();
    return made(settings);
}

ShapeRefC mesh_of(const slide_part &part) {
    TriangleList triangles;
    for (uint32_t t = 0; t < part.count; t++)
        triangles.push_back(Triangle(vec(part.corner[t][0]), vec(part.corner[t][1]), vec(part.corner[t][2])));
    MeshShapeSettings settings(triangles);
    settings.SetEmbedded();
    return made(settings);
}

ShapeRefC capsule_of(const pir_vec3 *end, double radius) {
    const Vec3 a = vec(end[0]), way = vec(end[1]) - a;
    const ShapeRefC capsule = new CapsuleShape(way.Length() / 2, (float)radius);
    RotatedTranslatedShapeSettings settings(a + way / 2, Quat::sFromTo(Vec3::sAxisY(), way.Normalized()), capsule);
    settings.SetEmbedded();
    return made(settings);
}

ShapeRefC slider_of(const slider *from) {
    StaticCompoundShapeSettings settings;
    ShapeRefC piece;
    settings.SetEmbedded();
    for (uint32_t k = 0; k < from->pieces; k++) {
        pir_vec3 vertex[64];
        const uint32_t count = pir_polytope_vertex_count(from->piece[k]);
        for (uint32_t i = 0; i < count; i++)
            vertex[i] = pir_polytope_vertex(from->piece[k], i);
        piece = from->radius > 0 ? capsule_of(vertex, from->radius) : hull_of(vertex, count);
        settings.AddShape(Vec3::sZero(), Quat::sIdentity(), piece);
    }
    return from->pieces == 1 ? piece : made(settings);
}

BodyID add(BodyInterface &bodies, const ShapeRefC &shape, RVec3 at, bool moves) {
    BodyCreationSettings settings(shape, at, Quat::sIdentity(), moves ? EMotionType::Dynamic : EMotionType::Static,
                                  moves ? MOVES : STILL);
    settings.mFriction = 0;
    settings.mRestitution = 0;
    settings.mLinearDamping = 0;
    settings.mAngularDamping = 0;
    settings.mAllowSleeping = false;
    settings.mEnhancedInternalEdgeRemoval = true;
    return bodies.CreateAndAddBody(settings, moves ? EActivation::Activate : EActivation::DontActivate);
}

void start_once() {
    static bool started = false;
    if (started)
        return;
    started = true;
    RegisterDefaultAllocator();
    Factory::sInstance = new Factory();
    RegisterTypes();
}

} // namespace

void jolt_slide(const slide_floor *floor, const slider *from, double speed, uint32_t frames, slide_result *ret_result) {
    start_once();
    TempAllocatorImpl memory(32 << 20);
    JobSystemSingleThreaded jobs(2048);
    Layers layers;
    Counter counter;
    PhysicsSystem world;
    world.Init(4096, 0, 4096, 4096, layers, layers, layers);
    world.SetGravity(Vec3(0, 0, -9.81f));
    world.SetContactListener(&counter);
    BodyInterface &bodies = world.GetBodyInterfaceNoLock();
    for (uint32_t i = 0; i < floor->count; i++) {
        const slide_part &part = floor->part[i];
        add(bodies, floor->hulls ? hull_of(part.corner[0], 3 * part.count) : mesh_of(part), RVec3::sZero(), false);
    }
    const double start = from->pose.translation.z;
    const BodyID body = add(bodies, slider_of(from), RVec3(vec(from->pose.translation)), true);
    bodies.SetLinearVelocity(body, Vec3((float)speed, (float)(0.05 * speed), 0));
    world.OptimizeBroadPhase();
    for (uint32_t frame = 0; frame < frames; frame++) {
        const RVec3 p = bodies.GetPosition(body);
        pir_vec3 at = {p.GetX(), p.GetY(), p.GetZ()};
        if (slide_goes_round(&at))
            bodies.SetPosition(body, RVec3(vec(at)), EActivation::Activate);
        world.Update(FRAME, 1, &memory, &jobs);
        const Vec3 v = bodies.GetLinearVelocity(body);
        slide_note(&counter.result, v.GetX(), v.GetY(), speed, bodies.GetPosition(body).GetZ() - start);
    }
    *ret_result = counter.result;
}
