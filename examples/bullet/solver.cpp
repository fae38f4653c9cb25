// SPDX-License-Identifier: MIT
#include "solver.hpp"

void Solver::set(btContactSolverInfo &info) {
    info.m_numIterations = 200;
    info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_DISABLE_VELOCITY_DEPENDENT_FRICTION_DIRECTION;
    // a quarter of the default, which is for steps of 1/60 s: more lets a stack tremble
    info.m_erp2 = 0.05;
}

void Solver::convertContacts(btPersistentManifold **manifolds, int count, const btContactSolverInfo &info) {
    btSequentialImpulseConstraintSolver::convertContacts(manifolds, count, info);
    // two rows of friction for each contact, next to each other
    for (int i = 0; i < m_tmpSolverContactConstraintPool.size(); i++) {
        const btSolverConstraint &contact = m_tmpSolverContactConstraintPool[i];
        const btManifoldPoint *point = static_cast<btManifoldPoint *>(contact.m_originalContactPoint);
        btSolverConstraint *friction = &m_tmpSolverContactFrictionConstraintPool[contact.m_frictionIndex];
        begin(friction[0], point->m_appliedImpulseLateral1);
        begin(friction[1], point->m_appliedImpulseLateral2);
    }
}

void Solver::begin(btSolverConstraint &friction, btScalar impulse) {
    btSolverBody &a = m_tmpSolverBodyPool[friction.m_solverBodyIdA], &b = m_tmpSolverBodyPool[friction.m_solverBodyIdB];
    friction.m_appliedImpulse = impulse;
    a.internalApplyImpulse(friction.m_contactNormal1 * a.internalGetInvMass(), friction.m_angularComponentA, impulse);
    b.internalApplyImpulse(friction.m_contactNormal2 * b.internalGetInvMass(), friction.m_angularComponentB, impulse);
}
