/* SPDX-License-Identifier: MIT */
/*
 * The piano with OMPL's RRT-Connect in the place of the planner here: states and motions are valid where the slices
 * prove them free.
 *
 *     piano_ompl SLICES.h5 PATH.svg
 */
#include <cstdio>
#include <memory>
#include <vector>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include "draw.h"
#include "place.h"

namespace ob = ompl::base;
namespace og = ompl::geometric;

namespace {

constexpr int points = 10000;

spot spot_of(const ob::State *state) {
    const double *v = state->as<ob::RealVectorStateSpace::StateType>()->values;
    return {v[0], v[1], v[2], v[3]};
}

class Motions : public ob::MotionValidator {
  public:
    Motions(const ob::SpaceInformationPtr &information, world &where)
        : ob::MotionValidator(information), place_(where) {
    }

    bool checkMotion(const ob::State *from, const ob::State *to) const override {
        const spot a = spot_of(from), b = spot_of(to);
        return place_may_go(&place_, &a, &b) != 0;
    }

    /* The last valid state is not looked for: the motion's beginning. */
    bool checkMotion(const ob::State *from, const ob::State *to, std::pair<ob::State *, double> &last) const override {
        const bool valid = checkMotion(from, to);
        last.second = valid ? 1 : 0;
        if (last.first)
            si_->copyState(last.first, valid ? to : from);
        return valid;
    }

  private:
    world &place_;
};

std::shared_ptr<ob::RealVectorStateSpace> make_space() {
    auto space = std::make_shared<ob::RealVectorStateSpace>(4);
    const double least[] = {spot_least.x, spot_least.y, spot_least.z, spot_least.turn};
    const double most[] = {spot_most.x, spot_most.y, spot_most.z, spot_most.turn};
    ob::RealVectorBounds bounds(4);
    for (unsigned i = 0; i < 4; i++) {
        bounds.setLow(i, least[i]);
        bounds.setHigh(i, most[i]);
    }
    space->setBounds(bounds);
    return space;
}

void set_spot(ob::ScopedState<ob::RealVectorStateSpace> &state, const spot &at) {
    const double v[] = {at.x, at.y, at.z, at.turn};
    for (unsigned i = 0; i < 4; i++)
        state[i] = v[i];
}

/* Empty where no way was found. */
std::vector<spot> plan(world &where) {
    auto space = make_space();
    og::SimpleSetup setup(space);
    auto information = setup.getSpaceInformation();
    setup.setStateValidityChecker([&](const ob::State *state) {
        const spot at = spot_of(state);
        return place_is_free(&where, &at) != 0;
    });
    information->setMotionValidator(std::make_shared<Motions>(information, where));
    ob::ScopedState<ob::RealVectorStateSpace> start(space), goal(space);
    set_spot(start, spot_start);
    set_spot(goal, spot_goal);
    setup.setStartAndGoalStates(start, goal);
    setup.setPlanner(std::make_shared<og::RRTConnect>(information));
    std::vector<spot> path;
    if (setup.solve(90.0) != ob::PlannerStatus::EXACT_SOLUTION)
        return path;
    og::PathSimplifier(information).reduceVertices(setup.getSolutionPath(), 200);
    for (const ob::State *state : setup.getSolutionPath().getStates())
        path.push_back(spot_of(state));
    return path;
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: piano_ompl SLICES.h5 PATH.svg\n");
        return 2;
    }
    ompl::RNG::setSeed(1);
    ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
    world piano;
    const bool made = place_make(&piano, argv[1]) != 0;
    const std::vector<spot> path = made ? plan(piano) : std::vector<spot>();
    const int count = static_cast<int>(path.size());
    const int bad = count > 1 ? place_check(&piano, path.data(), count, points) : -1;
    if (piano.error)
        std::fprintf(stderr, "piano_ompl: %s: %s\n", piano.error, piano.report.text);
    else if (bad < 0)
        std::fprintf(stderr, "piano_ompl: no way was found\n");
    else
        std::printf("a path of %d spots; %d points asked, %d overlap\n", count, points, bad);
    const bool drawn = bad == 0 && draw_path(&piano, path.data(), count, 40, argv[2]) != 0;
    place_clear(&piano);
    return drawn ? 0 : 1;
}
