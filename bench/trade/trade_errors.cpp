// SPDX-License-Identifier: MIT
// How far apart two convex bodies are that should be one.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

#include "trade.hpp"

namespace {

constexpr int DIRECTIONS = 200;

double support(const std::vector<pir_vec3> &points, pir_vec3 n) {
    double most = -HUGE_VAL;
    for (const pir_vec3 &x : points)
        most = std::max(most, x.x * n.x + x.y * n.y + x.z * n.z);
    return most;
}

// The points in an order of their own.
std::vector<std::array<double, 3>> sorted(const std::vector<pir_vec3> &points) {
    std::vector<std::array<double, 3>> all;
    for (const pir_vec3 &x : points)
        all.push_back({x.x, x.y, x.z});
    std::sort(all.begin(), all.end());
    return all;
}

// The farthest of the points from the hull of `of`, by a pair of it and a point.
double farthest(const std::vector<pir_vec3> &points, const std::vector<pir_vec3> &of) {
    pir_polytope *hull = from_points(of), *origin = from_points({{0, 0, 0}});
    pir_workspace *workspace;
    pir_pair *pair;
    trade_check(pir_workspace_create(nullptr, &workspace));
    trade_check(pir_pair_create(origin, hull, nullptr, &pair));
    double most = 0;
    for (const pir_vec3 &x : points) {
        pir_pair_input input = pir_pair_input_default();
        pir_query_result result;
        input.pose_p.translation = x;
        trade_check(pir_pair_distance(pair, workspace, &input, &result));
        most = std::max(most, result.distance);
    }
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
    pir_polytope_release(origin);
    pir_polytope_release(hull);
    return most;
}

} // namespace

double support_error(const std::vector<pir_vec3> &a, const std::vector<pir_vec3> &b) {
    Random random;
    double most = 0;
    for (int i = 0; i < DIRECTIONS; i++) {
        pir_vec3 n = random.direction();
        most = std::max(most, std::fabs(support(a, n) - support(b, n)));
    }
    return most;
}

double hausdorff(const std::vector<pir_vec3> &a, const std::vector<pir_vec3> &b) {
    if (sorted(a) == sorted(b))
        return 0;
    return std::max(farthest(a, b), farthest(b, a));
}

std::vector<pir_vec3> exact_difference(const TradePair &pair, pir_quat r) {
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    pir_sum *sum;
    pir_mesh *mesh;
    trade_check(pir_sum_create(pair.p, pair.q, r, &options, &sum));
    trade_check(pir_sum_mesh(sum, PIR_DOUBLE, &mesh));
    const pir_vec3 *vertex = pir_mesh_vertices(mesh);
    std::vector<pir_vec3> points(vertex, vertex + pir_mesh_vertex_count(mesh));
    pir_mesh_destroy(mesh);
    pir_sum_destroy(sum);
    return points;
}

void trade_check(pir_status status) {
    if (status == PIR_OK)
        return;
    std::fprintf(stderr, "bench_trade: %s\n", pir_status_text(status));
    std::exit(2);
}
