// SPDX-License-Identifier: MIT
// The trade of a scene: rain of tumbling hulls, as they are and simplified, and other engines on the same poses.
#include <algorithm>

#include "judge.hpp"
#include "results.h"
#include "trade.hpp"

namespace {

constexpr uint32_t BODIES = 300, FRAMES = 61;

// Every so manieth frame is judged.
constexpr size_t EVERY = 10;

struct Lane {
    std::unique_ptr<ScenePeer> peer;
    Measured measured;
    std::vector<double> ns = {};
    size_t wrong = 0;
};

// The same rain, of inner polytopes of at most so many vertices.
std::unique_ptr<Recording> simplified(const Recording &recording, uint32_t vertices) {
    auto made = std::make_unique<Recording>();
    made->name = recording.name;
    made->frames = recording.frames;
    for (pir_polytope *shape : recording.shapes)
        made->shapes.push_back(fewer_vertices(shape, vertices));
    for (const RecordedBody &body : recording.bodies) {
        auto at = std::find(recording.shapes.begin(), recording.shapes.end(), body.polytope);
        made->bodies.push_back({made->shapes[(size_t)(at - recording.shapes.begin())], body.pose});
    }
    return made;
}

void join(std::vector<Lane> *lanes, std::unique_ptr<ScenePeer> peer, const char *family, const std::string &setting) {
    if (!peer)
        return;
    bool ours = family != nullptr;
    std::string name = ours ? family : peer->name();
    Measured empty = {name, setting, ours, 0, 0, NAN, NAN, 0};
    lanes->push_back({std::move(peer), empty});
}

} // namespace

std::vector<Measured> measure_scene(std::string *ret_name) {
    std::unique_ptr<Recording> rain = make_rain(BODIES, BODIES, FRAMES);
    std::vector<std::unique_ptr<Recording>> fewer;
    std::vector<Lane> lanes;
    join(&lanes, make_our_scene(*rain, 1, 0), "scene", "exact");
    for (uint32_t vertices : {24u, 16u, 12u, 8u, 6u}) {
        fewer.push_back(simplified(*rain, vertices));
        join(&lanes, make_our_scene(*fewer.back(), 1, 0), "simplified", std::to_string(vertices));
    }
#ifdef PIR_HAVE_FCL
    join(&lanes, make_fcl_scene(*rain), nullptr, "built in");
#endif
#ifdef PIR_HAVE_BULLET
    join(&lanes, make_bullet_scene(*rain), nullptr, "built in");
#endif
#ifdef PIR_HAVE_BOX3D
    join(&lanes, make_box3d_scene(*rain, true), nullptr, "built in");
#endif
    std::vector<uint32_t> all_bodies;
    for (uint32_t i = 0; i < BODIES; i++)
        all_bodies.push_back(i);
    size_t right = 0, frames = std::max<size_t>(2, results_count(FRAMES));
    for (size_t f = 0; f < frames; f++) {
        bool judged = f % EVERY == 0;
        std::vector<BodyPair> exact;
        if (judged)
            exact = exact_pairs(*rain, rain->frames[f]);
        right += exact.size();
        for (Lane &lane : lanes) {
            double ns = cpu_nanoseconds([&] { lane.peer->set(all_bodies, rain->frames[f]); });
            std::vector<BodyPair> pairs;
            lane.peer->overlapping(&pairs);
            // the first frame makes everything
            if (f > 0)
                lane.ns.push_back(ns);
            if (judged)
                lane.wrong += differences(exact, pairs);
        }
    }
    std::vector<Measured> all;
    for (Lane &lane : lanes) {
        Times times = {lane.ns};
        lane.measured.ns = times.median();
        lane.measured.depth = (double)lane.wrong / (double)std::max<size_t>(right, 1);
        all.push_back(lane.measured);
    }
    *ret_name = "rain-" + std::to_string(BODIES);
    return all;
}
