// SPDX-License-Identifier: MIT
// A scene of examples/scenes in a Bullet world, with Pirouette's narrow phase and with Bullet's own, no body asleep:
// how long what stands keeps standing, how fast bodies are in the end, and how deep they overlap.
//
//     bullet SCENE.json [SECONDS] [pirouette | bullet]
//
// Both worlds have the same solver, step and bodies. Inertia is the diagonal of a body's own, in its frame.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include "narrow_phase.hpp"
#include "solver.hpp"

extern "C" {
#include "stage.h"
}

namespace {

// A body that has gone so far from where it stood, in parts of its radius, has fallen.
constexpr double FALLEN = 0.25;
// Of Bullet's own hulls; its default, 0.04 m, is thicker than a card.
constexpr double HULL_MARGIN = 0.001;

btTransform transform(const pir_pose &pose) {
    const pir_quat &q = pose.rotation;
    const pir_vec3 &t = pose.translation;
    btQuaternion turn(q.x, q.y, q.z, q.w);
    return btTransform(turn.normalized(), btVector3(t.x, t.y, t.z));
}

class World {
  public:
    World(const stage &stage, bool exact)
        : stage_(stage), narrow_(stage.options.margin), dispatcher_(&configuration_),
          world_(&dispatcher_, &broadphase_, &solver_, &configuration_) {
        if (exact)
            narrow_.use_in(dispatcher_);
        const pir_vec3 &g = stage.options.gravity;
        world_.setGravity(btVector3(g.x, g.y, g.z));
        Solver::set(world_.getSolverInfo());
        for (uint32_t i = 0; i < stage.shape_count; i++)
            shapes_.push_back(make_shape(stage.shape[i]));
        for (uint32_t i = 0; i < stage.body_count; i++)
            add(stage.body[i]);
    }
    ~World() {
        for (auto &body : bodies_)
            world_.removeRigidBody(body.get());
    }

    void step() {
        world_.stepSimulation(stage_.options.step, 1, stage_.options.step);
        // Bullet moves kinematic bodies by their motion states alone
        for (uint32_t i = 0; i < stage_.body_count; i++)
            if (stage_.body[i].body.kind == PIR_BODY_KINEMATIC)
                drive(i);
    }

    // The farthest that a moving body has gone, in parts of its radius.
    double gone() const {
        double most = 0;
        for (uint32_t i = 0; i < stage_.body_count; i++) {
            const world_body &from = stage_.body[i].body;
            if (from.kind != PIR_BODY_MOVING)
                continue;
            btVector3 way = bodies_[i]->getWorldTransform().getOrigin() - transform(from.pose).getOrigin();
            most = std::fmax(most, way.length() / from.shape->radius);
        }
        return most;
    }

    double mean_speed() const {
        double sum = 0;
        int count = 0;
        for (uint32_t i = 0; i < stage_.body_count; i++)
            if (stage_.body[i].body.kind == PIR_BODY_MOVING) {
                sum += bodies_[i]->getLinearVelocity().length();
                count++;
            }
        return count ? sum / count : 0;
    }

    // The deepest overlap of two bodies of one piece each, by pairs made for the question, and the deepest in parts of
    // the size of the smaller body.
    void deepest(double *ret_depth, double *ret_part) const {
        *ret_depth = *ret_part = 0;
        for (uint32_t i = 0; i < stage_.body_count; i++)
            for (uint32_t k = i + 1; k < stage_.body_count; k++) {
                double deep = depth(i, k);
                double size = 2 * std::fmin(stage_.body[i].body.shape->radius, stage_.body[k].body.shape->radius);
                *ret_depth = std::fmax(*ret_depth, deep);
                *ret_part = std::fmax(*ret_part, deep / size);
            }
    }

  private:
    // A compound also where there is one piece alone: child shapes are told apart by their pieces.
    std::unique_ptr<btCompoundShape> make_shape(const world_shape &from) {
        auto compound = std::make_unique<btCompoundShape>();
        for (uint32_t i = 0; i < from.count; i++) {
            auto hull = std::make_unique<btConvexHullShape>();
            for (uint32_t v = 0; v < pir_polytope_vertex_count(from.piece[i]); v++) {
                pir_vec3 x = pir_polytope_vertex(from.piece[i], v);
                hull->addPoint(btVector3(x.x, x.y, x.z), false);
            }
            hull->recalcLocalAabb();
            hull->setMargin(HULL_MARGIN);
            hull->setUserPointer(from.piece[i]);
            hulls_.push_back(std::move(hull));
            compound->addChildShape(btTransform::getIdentity(), hulls_.back().get());
        }
        return compound;
    }

    void add(const stage_body &from) {
        const world_body &body = from.body;
        const pir_mass &mass = body.shape->mass;
        btCompoundShape *compound = shapes_[from.shape].get();
        btCollisionShape *shape = compound->getNumChildShapes() == 1 ? compound->getChildShape(0) : compound;
        bool moves = body.kind == PIR_BODY_MOVING;
        btVector3 inertia(mass.inertia[0][0], mass.inertia[1][1], mass.inertia[2][2]);
        btRigidBody::btRigidBodyConstructionInfo info(moves ? body.density * mass.volume : 0, nullptr, shape,
                                                      moves ? body.density * inertia : btVector3(0, 0, 0));
        info.m_startWorldTransform = transform(body.pose);
        // Bullet multiplies the frictions of two bodies
        info.m_friction = std::sqrt(body.friction);
        info.m_restitution = body.restitution;
        bodies_.push_back(std::make_unique<btRigidBody>(info));
        btRigidBody &made = *bodies_.back();
        made.setLinearVelocity(btVector3(body.velocity.x, body.velocity.y, body.velocity.z));
        made.setAngularVelocity(btVector3(body.spin.x, body.spin.y, body.spin.z));
        made.setActivationState(DISABLE_DEACTIVATION);
        if (body.kind == PIR_BODY_KINEMATIC)
            made.setCollisionFlags(made.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
        world_.addRigidBody(&made);
    }

    void drive(uint32_t i) {
        const world_body &body = stage_.body[i].body;
        btTransform next;
        btTransformUtil::integrateTransform(
            bodies_[i]->getWorldTransform(), btVector3(body.velocity.x, body.velocity.y, body.velocity.z),
            btVector3(body.spin.x, body.spin.y, body.spin.z), stage_.options.step, next);
        bodies_[i]->setWorldTransform(next);
    }

    double depth(uint32_t i, uint32_t k) const {
        const world_body &a = stage_.body[i].body, &b = stage_.body[k].body;
        const btTransform &at_a = bodies_[i]->getWorldTransform(), &at_b = bodies_[k]->getWorldTransform();
        double apart = (at_a.getOrigin() - at_b.getOrigin()).length();
        if (a.shape->count != 1 || b.shape->count != 1 || apart > a.shape->radius + b.shape->radius ||
            (a.kind != PIR_BODY_MOVING && b.kind != PIR_BODY_MOVING))
            return 0;
        pir_pair *pair = nullptr;
        pir_query_result answer;
        pir_pair_input input = pir_pair_input_default();
        input.pose_p = pose(at_a);
        input.pose_q = pose(at_b);
        if (pir_pair_create(a.shape->piece[0], b.shape->piece[0], nullptr, &pair) != PIR_OK ||
            pir_pair_signed_distance(pair, narrow_.workspace, &input, &answer) != PIR_OK)
            std::abort();
        pir_pair_destroy(pair);
        return -answer.distance;
    }

    static pir_pose pose(const btTransform &at) {
        btQuaternion q = at.getRotation();
        return {{q.x(), q.y(), q.z(), q.w()}, {at.getOrigin().x(), at.getOrigin().y(), at.getOrigin().z()}};
    }

    const stage &stage_;
    NarrowPhase narrow_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btDbvtBroadphase broadphase_;
    Solver solver_;
    btDiscreteDynamicsWorld world_;
    std::vector<std::unique_ptr<btConvexHullShape>> hulls_;
    std::vector<std::unique_ptr<btCompoundShape>> shapes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

void run(const stage &stage, double seconds, bool exact) {
    World world(stage, exact);
    double fallen = -1;
    int steps = (int)(seconds / stage.options.step + 0.5);
    for (int i = 1; i <= steps; i++) {
        world.step();
        if (fallen < 0 && world.gone() > FALLEN)
            fallen = i * stage.options.step;
    }
    std::printf("%-30s", exact ? "Pirouette's narrow phase:" : "Bullet's own:");
    if (fallen < 0)
        std::printf("stands for %g s", seconds);
    else
        std::printf("moves on at %.2f s", fallen);
    double depth, part;
    world.deepest(&depth, &part);
    std::printf(", at the end mean speed %.2g m/s, deepest overlap %.2g m, %.2g %% of a size\n", world.mean_speed(),
                depth, 100 * part);
}

} // namespace

int main(int argc, char **argv) {
    stage stage = {};
    char why[STAGE_WHY];
    if (argc < 2 || argc > 4) {
        std::fprintf(stderr, "usage: bullet SCENE.json [SECONDS] [pirouette | bullet]\n");
        return 2;
    }
    if (!stage_read(argv[1], &stage, why)) {
        std::fprintf(stderr, "bullet: %s\n", why);
        return 2;
    }
    double seconds = argc > 2 ? std::atof(argv[2]) : stage.seconds;
    const char *which = argc > 3 ? argv[3] : "";
    std::printf("%s, %g s without sleep\n", stage.title, seconds);
    if (std::strcmp(which, "bullet") != 0)
        run(stage, seconds, true);
    if (std::strcmp(which, "pirouette") != 0)
        run(stage, seconds, false);
    stage_clear(&stage);
    return 0;
}
