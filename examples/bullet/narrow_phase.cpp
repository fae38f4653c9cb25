// SPDX-License-Identifier: MIT
#include "narrow_phase.hpp"

#include <algorithm>
#include <cstdlib>
#include <new>

#include <BulletCollision/CollisionDispatch/btActivatingCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

namespace {

// Bullet has no way to tell of a query that failed; where memory runs out there is nothing left to do.
void check(pir_status status) {
    if (status != PIR_OK)
        std::abort();
}

pir_vec3 vec(const btVector3 &v) {
    return {v.x(), v.y(), v.z()};
}

btVector3 vec(const pir_vec3 &v) {
    return {v.x, v.y, v.z};
}

pir_pose pose(const btTransform &transform) {
    btQuaternion q = transform.getRotation();
    return {{q.x(), q.y(), q.z(), q.w()}, vec(transform.getOrigin())};
}

pir_polytope *polytope(const btCollisionObjectWrapper *wrap) {
    return static_cast<pir_polytope *>(wrap->getCollisionShape()->getUserPointer());
}

// Four of many contacts: the deepest, then thrice the one farthest from all that are chosen.
int choose(pir_contact *contact, size_t count) {
    for (size_t chosen = 0; chosen < MANIFOLD_CACHE_SIZE && chosen < count; chosen++) {
        size_t best = chosen;
        double most = -1;
        for (size_t i = chosen; i < count; i++) {
            double far = chosen == 0 ? 1e9 - contact[i].distance : 1e300;
            for (size_t k = 0; k < chosen; k++)
                far = std::min(far, double((vec(contact[i].point_q) - vec(contact[k].point_q)).length2()));
            if (far > most) {
                most = far;
                best = i;
            }
        }
        std::swap(contact[chosen], contact[best]);
    }
    return (int)std::min<size_t>(count, MANIFOLD_CACHE_SIZE);
}

class Algorithm : public btActivatingCollisionAlgorithm {
  public:
    Algorithm(NarrowPhase &shared, const btCollisionAlgorithmConstructionInfo &info, const btCollisionObjectWrapper *a,
              const btCollisionObjectWrapper *b)
        : btActivatingCollisionAlgorithm(info, a, b), shared_(shared),
          manifold_(m_dispatcher->getNewManifold(a->getCollisionObject(), b->getCollisionObject())) {
        check(pir_pair_create(polytope(a), polytope(b), nullptr, &pair_));
    }
    ~Algorithm() override {
        pir_pair_destroy(pair_);
        m_dispatcher->releaseManifold(manifold_);
    }

    void processCollision(const btCollisionObjectWrapper *a, const btCollisionObjectWrapper *b,
                          const btDispatcherInfo &, btManifoldResult *result) override {
        pir_contact contacts[CONTACTS];
        size_t count = 0;
        pir_pair_input input = pir_pair_input_default();
        pir_query_result answer;
        input.pose_p = pose(a->getWorldTransform());
        input.pose_q = pose(b->getWorldTransform());
        input.cutoff = input.margin = shared_.margin;
        check(pir_pair_signed_distance(pair_, shared_.workspace, &input, &answer));
        check(pir_pair_manifold(pair_, shared_.workspace, &input, &answer, CONTACTS, contacts, &count));

        result->setPersistentManifold(manifold_);
        const btCollisionObject *objects[2] = {a->getCollisionObject(), b->getCollisionObject()};
        btManifoldPoint old[MANIFOLD_CACHE_SIZE], made[MANIFOLD_CACHE_SIZE];
        int kept = manifold_->getNumContacts();
        for (int i = 0; i < kept; i++)
            old[i] = manifold_->getContactPoint(i);
        int chosen = choose(contacts, std::min(count, CONTACTS)); // of more, the first are as good
        for (int i = 0; i < chosen; i++)
            made[i] = point(contacts[i], answer.normal, objects);
        double near = manifold_->getContactBreakingThreshold();
        go_on(made, chosen, old, kept, near * near);
        manifold_->clearManifold();
        for (int i = 0; i < chosen; i++)
            manifold_->addManifoldPoint(made[i]);
    }

    btScalar calculateTimeOfImpact(btCollisionObject *, btCollisionObject *, const btDispatcherInfo &,
                                   btManifoldResult *) override {
        return 1;
    }

    void getAllContactManifolds(btManifoldArray &manifolds) override {
        manifolds.push_back(manifold_);
    }

  private:
    static constexpr size_t CONTACTS = 256;

    // How unlike two points are: nothing where they have one id, else the square of how far the new one is from where
    // the old one would be now, in the frame of the body where that is less.
    static double unlike(const btManifoldPoint &made, const btManifoldPoint &old) {
        if (made.m_index0 == old.m_index0 && made.m_index1 == old.m_index1)
            return 0;
        return std::min((made.m_localPointA - old.m_localPointA).length2(),
                        (made.m_localPointB - old.m_localPointB).length2());
    }

    // Impulses of old points go on with the new ones most like them, each with one: a contact whose features change
    // while it stays where it is keeps what holds the bodies.
    static void go_on(btManifoldPoint *made, int count, const btManifoldPoint *old, int kept, double near) {
        bool begun[MANIFOLD_CACHE_SIZE] = {false}, gone_on[MANIFOLD_CACHE_SIZE] = {false};
        for (int pairs = std::min(count, kept); pairs > 0; pairs--) {
            int to = -1, from = -1;
            double least = near;
            for (int i = 0; i < count; i++)
                for (int k = 0; k < kept; k++)
                    if (!begun[i] && !gone_on[k] && unlike(made[i], old[k]) < least) {
                        least = unlike(made[i], old[k]);
                        to = i;
                        from = k;
                    }
            if (to < 0)
                break;
            begun[to] = gone_on[from] = true;
            made[to].m_appliedImpulse = old[from].m_appliedImpulse;
            made[to].m_appliedImpulseLateral1 = old[from].m_appliedImpulseLateral1;
            made[to].m_appliedImpulseLateral2 = old[from].m_appliedImpulseLateral2;
            made[to].m_lifeTime = old[from].m_lifeTime + 1;
        }
    }

    // A contact as Bullet has it.
    static btManifoldPoint point(const pir_contact &contact, const pir_vec3 &normal,
                                 const btCollisionObject *const objects[2]) {
        btVector3 on_a = vec(contact.point_p), on_b = vec(contact.point_q);
        btManifoldPoint made(objects[0]->getWorldTransform().invXform(on_a),
                             objects[1]->getWorldTransform().invXform(on_b), vec(normal), contact.distance);
        made.m_positionWorldOnA = on_a;
        made.m_positionWorldOnB = on_b;
        made.m_index0 = (int)(uint32_t)contact.id;
        made.m_index1 = (int)(uint32_t)(contact.id >> 32);
        made.m_combinedFriction = btManifoldResult::calculateCombinedFriction(objects[0], objects[1]);
        made.m_combinedRestitution = btManifoldResult::calculateCombinedRestitution(objects[0], objects[1]);
        return made;
    }

    NarrowPhase &shared_;
    btPersistentManifold *manifold_;
    pir_pair *pair_ = nullptr;
};

} // namespace

NarrowPhase::NarrowPhase(double margin_) : margin(margin_) {
    check(pir_workspace_create(nullptr, &workspace));
}

NarrowPhase::~NarrowPhase() {
    pir_workspace_destroy(workspace);
}

void NarrowPhase::use_in(btCollisionDispatcher &dispatcher) {
    dispatcher.registerCollisionCreateFunc(CONVEX_HULL_SHAPE_PROXYTYPE, CONVEX_HULL_SHAPE_PROXYTYPE, this);
}

btCollisionAlgorithm *NarrowPhase::CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo &info,
                                                            const btCollisionObjectWrapper *a,
                                                            const btCollisionObjectWrapper *b) {
    void *memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(Algorithm));
    return new (memory) Algorithm(*this, info, a, b);
}
