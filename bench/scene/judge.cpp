// SPDX-License-Identifier: MIT
#include "judge.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace {

void check(pir_status status) {
    if (status != PIR_OK) {
        std::fprintf(stderr, "bench_scene: %s\n", pir_status_text(status));
        std::exit(2);
    }
}

double radius_of(const pir_polytope *p) {
    double most = 0;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
        pir_vec3 c = pir_polytope_vertex(p, v);
        most = std::max(most, std::sqrt(c.x * c.x + c.y * c.y + c.z * c.z));
    }
    return most * (1 + 1e-12);
}

struct Posed {
    pir_polytope *polytope;
    pir_pose pose;
    double radius;
};

bool spheres_meet(const Posed &p, const Posed &q) {
    pir_vec3 a = p.pose.translation, b = q.pose.translation;
    double x = a.x - b.x, y = a.y - b.y, z = a.z - b.z, r = p.radius + q.radius;
    return x * x + y * y + z * z <= r * r * (1 + 1e-12);
}

} // namespace

std::vector<BodyPair> exact_pairs(const Recording &recording, const std::vector<pir_pose> &poses) {
    std::vector<Posed> bodies;
    for (const RecordedBody &body : recording.statics)
        bodies.push_back({body.polytope, body.pose, radius_of(body.polytope)});
    for (size_t i = 0; i < poses.size(); i++)
        bodies.push_back({recording.bodies[i].polytope, poses[i], radius_of(recording.bodies[i].polytope)});
    pir_pair_options options = pir_pair_options_default();
    options.least = PIR_LEVEL_WHOLE;
    pir_workspace *workspace;
    check(pir_workspace_create(nullptr, &workspace));
    std::vector<BodyPair> found;
    for (uint32_t a = 0; a < bodies.size(); a++)
        for (uint32_t b = std::max(a + 1, (uint32_t)recording.statics.size()); b < bodies.size(); b++) {
            if (!spheres_meet(bodies[a], bodies[b]))
                continue;
            pir_pair *pair;
            pir_pair_input input = pir_pair_input_default();
            pir_query_result result;
            input.pose_p = bodies[a].pose;
            input.pose_q = bodies[b].pose;
            check(pir_pair_create(bodies[a].polytope, bodies[b].polytope, &options, &pair));
            check(pir_pair_overlap(pair, workspace, &input, &result));
            pir_pair_destroy(pair);
            if (result.state != PIR_OUTSIDE)
                found.push_back({a, b});
        }
    pir_workspace_destroy(workspace);
    return found;
}

size_t differences(std::vector<BodyPair> a, std::vector<BodyPair> b) {
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    std::vector<BodyPair> rest;
    std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(rest));
    return rest.size();
}
