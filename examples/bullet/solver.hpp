// SPDX-License-Identifier: MIT
// Bullet's sequential impulses, where friction begins from the impulses of the step before, as contacts do. Bullet
// itself begins friction from nothing in every step; what leans, as a house of cards does, then creeps until it falls.
#ifndef EXAMPLE_BULLET_SOLVER_HPP
#define EXAMPLE_BULLET_SOLVER_HPP

#include <btBulletDynamicsCommon.h>

// For worlds whose solver mode has SOLVER_USE_2_FRICTION_DIRECTIONS and directions that stay.
class Solver : public btSequentialImpulseConstraintSolver {
  public:
    // Sets what the solver needs, for steps of 1/240 s.
    static void set(btContactSolverInfo &info);

  private:
    void convertContacts(btPersistentManifold **manifolds, int count, const btContactSolverInfo &info) override;
    void begin(btSolverConstraint &friction, btScalar impulse);
};

#endif
