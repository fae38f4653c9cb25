// SPDX-License-Identifier: MIT
// Bullet in double precision: meshes whose inner edges are known, as btInternalEdgeUtility has them; four substeps a
// frame. Hulls and triangles are inflated by margins, which the body's place of rest is raised by. These margins are
// less than Bullet's own, and all overlaps are mended by split impulses: so its bodies rest with the least motion.
#include <memory>
#include <vector>

#include <BulletCollision/CollisionDispatch/btInternalEdgeUtility.h>
#include <btBulletDynamicsCommon.h>

#include "sliding_peer.h"

namespace {

constexpr double MARGIN = 0.005;

btVector3 vec(pir_vec3 v) {
    return btVector3(v.x, v.y, v.z);
}

/* A contact of a triangle is turned to its plane, unless its edge is convex. */
bool adjust(btManifoldPoint &point, const btCollisionObjectWrapper *a, int, int, const btCollisionObjectWrapper *b,
            int part, int index) {
    if (b->getCollisionShape()->getShapeType() == TRIANGLE_SHAPE_PROXYTYPE)
        btAdjustInternalEdgeContacts(point, b, a, part, index);
    return true;
}

class World {
  public:
    World() : dispatcher_(&configuration_), world_(&dispatcher_, &broadphase_, &solver_, &configuration_) {
        world_.setGravity(btVector3(0, 0, -9.81));
        world_.getSolverInfo().m_splitImpulsePenetrationThreshold = 0;
        gContactAddedCallback = adjust;
    }
    ~World() {
        for (auto &body : bodies_)
            world_.removeRigidBody(body.get());
    }
    void add_floor(const slide_part &part, bool hull) {
        btRigidBody *body = add(hull ? hull_of(part.corner[0], 3 * part.count) : mesh_of(part), 0, btVector3(0, 0, 0));
        if (!hull)
            body->setCollisionFlags(body->getCollisionFlags() | btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
    }
    btRigidBody *add_slider(const slider *from, double speed, double raised) {
        auto shape = std::make_unique<btCompoundShape>();
        for (uint32_t k = 0; k < from->pieces; k++)
            add_piece(shape.get(), from->piece[k], from->radius);
        btCompoundShape *all = shape.get();
        btCollisionShape *used = all->getNumChildShapes() == 1 && from->radius <= 0 ? all->getChildShape(0) : all;
        shapes_.push_back(std::move(shape));
        btRigidBody *body = add(used, 1, vec(from->pose.translation) + btVector3(0, 0, raised));
        body->setLinearVelocity(btVector3(speed, 0.05 * speed, 0));
        body->setActivationState(DISABLE_DEACTIVATION);
        return body;
    }
    void step(slide_result *result) {
        world_.stepSimulation(1.0 / 60, 4, 1.0 / 240);
        for (int i = 0; i < dispatcher_.getNumManifolds(); i++) {
            const btPersistentManifold *manifold = dispatcher_.getManifoldByIndexInternal(i);
            for (int k = 0; k < manifold->getNumContacts(); k++) {
                const btManifoldPoint &point = manifold->getContactPoint(k);
                slide_count(result, point.m_normalWorldOnB.x(), point.m_normalWorldOnB.y(), point.m_appliedImpulse > 0);
            }
        }
    }

  private:
    btRigidBody *add(btCollisionShape *shape, double mass, const btVector3 &at) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0)
            shape->calculateLocalInertia(mass, inertia);
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, inertia);
        info.m_startWorldTransform.setOrigin(at);
        info.m_friction = 0;
        bodies_.push_back(std::make_unique<btRigidBody>(info));
        world_.addRigidBody(bodies_.back().get());
        return bodies_.back().get();
    }
    btCollisionShape *hull_of(const pir_vec3 *point, uint32_t count) {
        auto shape = std::make_unique<btConvexHullShape>();
        for (uint32_t i = 0; i < count; i++)
            shape->addPoint(vec(point[i]), false);
        shape->recalcLocalAabb();
        shape->setMargin(MARGIN);
        shapes_.push_back(std::move(shape));
        return shapes_.back().get();
    }
    btCollisionShape *mesh_of(const slide_part &part) {
        auto triangles = std::make_unique<btTriangleMesh>();
        for (uint32_t t = 0; t < part.count; t++)
            triangles->addTriangle(vec(part.corner[t][0]), vec(part.corner[t][1]), vec(part.corner[t][2]));
        auto shape = std::make_unique<btBvhTriangleMeshShape>(triangles.get(), true);
        shape->setMargin(MARGIN);
        edges_.push_back(std::make_unique<btTriangleInfoMap>());
        btGenerateInternalEdgeInfo(shape.get(), edges_.back().get());
        triangles_.push_back(std::move(triangles));
        shapes_.push_back(std::move(shape));
        return shapes_.back().get();
    }
    void add_piece(btCompoundShape *all, const pir_polytope *piece, double radius) {
        std::vector<pir_vec3> vertex(pir_polytope_vertex_count(piece));
        for (uint32_t i = 0; i < vertex.size(); i++)
            vertex[i] = pir_polytope_vertex(piece, i);
        btTransform at = btTransform::getIdentity();
        if (radius <= 0) {
            all->addChildShape(at, hull_of(vertex.data(), (uint32_t)vertex.size()));
            return;
        }
        const btVector3 a = vec(vertex[0]), way = vec(vertex[1]) - a;
        at.setOrigin(a + way / 2);
        at.setRotation(shortestArcQuat(btVector3(0, 0, 1), way.normalized()));
        shapes_.push_back(std::make_unique<btCapsuleShapeZ>(radius, way.length()));
        all->addChildShape(at, shapes_.back().get());
    }

    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_;
    std::vector<std::unique_ptr<btTriangleInfoMap>> edges_;
    std::vector<std::unique_ptr<btTriangleMesh>> triangles_;
    std::vector<std::unique_ptr<btCollisionShape>> shapes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

} // namespace

void bullet_slide(const slide_floor *floor, const slider *from, double speed, uint32_t frames,
                  slide_result *ret_result) {
    World world;
    // a capsule's margin is its radius
    const double raised = from->radius > 0 ? MARGIN : 2 * MARGIN, start = from->pose.translation.z + raised;
    *ret_result = slide_result();
    for (uint32_t i = 0; i < floor->count; i++)
        world.add_floor(floor->part[i], floor->hulls);
    btRigidBody *body = world.add_slider(from, speed, raised);
    for (uint32_t frame = 0; frame < frames; frame++) {
        btTransform pose = body->getWorldTransform();
        pir_vec3 at = {pose.getOrigin().x(), pose.getOrigin().y(), pose.getOrigin().z()};
        if (slide_goes_round(&at)) {
            pose.setOrigin(vec(at));
            body->setCenterOfMassTransform(pose);
        }
        world.step(ret_result);
        const btVector3 v = body->getLinearVelocity();
        slide_note(ret_result, v.x(), v.y(), speed, body->getWorldTransform().getOrigin().z() - start);
    }
}
