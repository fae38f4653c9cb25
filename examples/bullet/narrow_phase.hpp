// SPDX-License-Identifier: MIT
// Pirouette's narrow phase in a Bullet world: a collision algorithm for two convex hulls, and so for compounds of them.
//
// A hull's user pointer is the pir_polytope that it is made of. Each algorithm object, one for two shapes whose boxes
// meet, has a pair by need (pair.h). Its manifold is made anew in every step from the exact one; impulses go on with
// the contacts of the same ids or in the same places, of which Bullet keeps four.
#ifndef EXAMPLE_BULLET_NARROW_PHASE_HPP
#define EXAMPLE_BULLET_NARROW_PHASE_HPP

#include <btBulletDynamicsCommon.h>

#include <pirouette/pirouette.h>

// What the algorithms of one world share. It outlives the world.
class NarrowPhase : public btCollisionAlgorithmCreateFunc {
  public:
    // `margin`: how far apart hulls may be that have contacts.
    explicit NarrowPhase(double margin);
    ~NarrowPhase() override;
    NarrowPhase(const NarrowPhase &) = delete;
    NarrowPhase &operator=(const NarrowPhase &) = delete;

    // Has the dispatcher ask this for every two convex hulls.
    void use_in(btCollisionDispatcher &dispatcher);

    btCollisionAlgorithm *CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo &info,
                                                   const btCollisionObjectWrapper *a,
                                                   const btCollisionObjectWrapper *b) override;

    double margin;
    pir_workspace *workspace = nullptr;
};

#endif
