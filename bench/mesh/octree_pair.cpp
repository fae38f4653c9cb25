// SPDX-License-Identifier: MIT
#include "octree_pair.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <pirouette/baseline.h>
#include <pirouette/shape.h>

namespace {

pir_vec3 add(pir_vec3 a, pir_vec3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
pir_vec3 sub(pir_vec3 a, pir_vec3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
pir_vec3 scale(pir_vec3 a, double by) {
    return {by * a.x, by * a.y, by * a.z};
}
double dot(pir_vec3 a, pir_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
pir_vec3 cross(pir_vec3 a, pir_vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

void need(pir_status status) {
    if (status == PIR_OK)
        return;
    std::fprintf(stderr, "bench_mesh: %s\n", pir_status_text(status));
    std::exit(1);
}

// Whether an axis parts a triangle, about a cube's middle, from the cube.
bool parts(pir_vec3 axis, const pir_vec3 (&c)[3], double half) {
    const double a = dot(axis, c[0]), b = dot(axis, c[1]), d = dot(axis, c[2]);
    const double reach = half * (std::fabs(axis.x) + std::fabs(axis.y) + std::fabs(axis.z));
    return std::min({a, b, d}) > reach || std::max({a, b, d}) < -reach;
}

bool meets(const Mesh &mesh, uint32_t triangle, pir_vec3 middle, double side) {
    static const pir_vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    pir_vec3 c[3];
    for (int k = 0; k < 3; k++)
        c[k] = sub(mesh.points[mesh.corners[3 * triangle + (uint32_t)k]], middle);
    const pir_vec3 edges[3] = {sub(c[1], c[0]), sub(c[2], c[1]), sub(c[0], c[2])};
    if (parts(cross(edges[0], edges[1]), c, 0.5 * side))
        return false;
    for (const pir_vec3 axis : axes) {
        if (parts(axis, c, 0.5 * side))
            return false;
        for (const pir_vec3 edge : edges)
            if (parts(cross(axis, edge), c, 0.5 * side))
                return false;
    }
    return true;
}

// The square of the distance of a point from a segment.
double square_from_segment(pir_vec3 x, pir_vec3 a, pir_vec3 b) {
    const pir_vec3 e = sub(b, a), from = sub(x, a);
    const double along = std::clamp(dot(from, e) / dot(e, e), 0.0, 1.0);
    const pir_vec3 rest = sub(from, scale(e, along));
    return dot(rest, rest);
}

} // namespace

Octree::Octree(const Mesh &mesh, int depth) {
    pir_vec3 low = mesh.points[0], high = low;
    for (const pir_vec3 &v : mesh.points) {
        low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
        high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    }
    const double side = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    std::vector<uint32_t> all(mesh.corners.size() / 3);
    for (uint32_t t = 0; t < all.size(); t++)
        all[t] = t;
    add(mesh, scale(::add(low, high), 0.5), side, all, depth);
}

uint32_t Octree::add(const Mesh &mesh, pir_vec3 middle, double side, const std::vector<uint32_t> &triangles,
                     int depth) {
    const uint32_t at = (uint32_t)cubes_.size();
    cubes_.push_back({middle, side, {}, {}});
    if (depth == 0) {
        cubes_[at].triangles = triangles;
        return at;
    }
    for (int octant = 0; octant < 8; octant++) {
        const double by = 0.25 * side;
        const pir_vec3 child = ::add(middle, {octant & 1 ? by : -by, octant & 2 ? by : -by, octant & 4 ? by : -by});
        std::vector<uint32_t> inside;
        for (const uint32_t t : triangles)
            if (meets(mesh, t, child, 0.5 * side))
                inside.push_back(t);
        if (inside.empty())
            continue;
        const uint32_t added = add(mesh, child, 0.5 * side, inside, depth - 1);
        cubes_[at].children.push_back(added);
    }
    return at;
}

size_t Octree::leaves() const {
    return (size_t)std::count_if(cubes_.begin(), cubes_.end(), [](const Cube &c) { return c.children.empty(); });
}

CubeSums::CubeSums(pir_quat q) {
    const double n = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, c[3] = {q.x, q.y, q.z};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const double sign = (j - i + 3) % 3 == 1 ? -1 : 1;
            matrix_[i][j] =
                i == j ? 2 * (q.w * q.w + c[i] * c[i]) / n - 1 : 2 * (c[i] * c[j] + sign * q.w * c[3 - i - j]) / n;
        }
    pir_polytope *cube = nullptr;
    pir_mesh *mesh = nullptr;
    need(pir_shape_create("cube", nullptr, nullptr, &cube));
    need(pir_object_sum(cube, cube, q, nullptr, PIR_DOUBLE, &mesh));
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh); v++) {
        uint32_t pair[2];
        pir_mesh_pair(mesh, v, pair);
        at_p_.push_back(turned(pir_polytope_vertex(cube, pair[0])));
        at_q_.push_back(pir_polytope_vertex(cube, pair[1]));
    }
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        Facet facet{{0, 0, 0}, 0, 0, {corner, corner + count}};
        const pir_vec3 *x = pir_mesh_vertices(mesh);
        for (uint32_t i = 1; i + 1 < count; i++)
            facet.normal =
                add(facet.normal, cross(sub(x[corner[i]], x[corner[0]]), sub(x[corner[i + 1]], x[corner[0]])));
        facet.normal = scale(facet.normal, 1 / std::sqrt(dot(facet.normal, facet.normal)));
        facet.of_p = dot(facet.normal, at_p_[corner[0]]);
        facet.of_q = dot(facet.normal, at_q_[corner[0]]);
        facets_.push_back(facet);
    }
    pir_mesh_destroy(mesh);
    pir_polytope_release(cube);
}

pir_vec3 CubeSums::turned(pir_vec3 x) const {
    return {matrix_[0][0] * x.x + matrix_[0][1] * x.y + matrix_[0][2] * x.z,
            matrix_[1][0] * x.x + matrix_[1][1] * x.y + matrix_[1][2] * x.z,
            matrix_[2][0] * x.x + matrix_[2][1] * x.y + matrix_[2][2] * x.z};
}

pir_vec3 CubeSums::place(uint32_t vertex, double p, double q) const {
    return add(scale(at_p_[vertex], p), scale(at_q_[vertex], q));
}

double CubeSums::least(pir_vec3 t, double p, double q) const {
    double square = HUGE_VAL;
    bool inside = true;
    for (const Facet &facet : facets_) {
        const double above = dot(facet.normal, t) - (p * facet.of_p + q * facet.of_q);
        if (above <= 0)
            continue;
        inside = false;
        // over the facet, or nearest to one of its sides
        bool over = true;
        for (size_t i = 0; i < facet.corners.size(); i++) {
            const pir_vec3 a = place(facet.corners[i], p, q);
            const pir_vec3 b = place(facet.corners[(i + 1) % facet.corners.size()], p, q);
            if (dot(cross(facet.normal, sub(b, a)), sub(t, a)) >= 0)
                continue;
            over = false;
            square = std::min(square, square_from_segment(t, a, b));
        }
        if (over)
            square = std::min(square, above * above);
    }
    return inside ? 0 : std::sqrt(square);
}

double CubeSums::most(pir_vec3 t, double p, double q) const {
    double square = 0;
    for (uint32_t v = 0; v < at_p_.size(); v++) {
        const pir_vec3 between = sub(t, place(v, p, q));
        square = std::max(square, dot(between, between));
    }
    return std::sqrt(square);
}

namespace {

// One call: both trees at their poses.
struct Search {
    const Octree &p, &q;
    CubeSums sums;
    std::vector<pir_vec3> at; // the middles of P's cubes in Q's frame
    uint64_t asked = 0;
    double best = HUGE_VAL;
    uint32_t best_p = 0, best_q = 0;
    std::vector<uint8_t> near_p, near_q;

    double distance(uint32_t i, uint32_t j) {
        asked++;
        const Octree::Cube &a = p.cubes()[i], &b = q.cubes()[j];
        return sums.least(sub(b.middle, at[i]), a.side, b.side);
    }

    // The pairs of children of the larger cube that has any.
    std::vector<std::pair<uint32_t, uint32_t>> divided(uint32_t i, uint32_t j) const {
        const Octree::Cube &a = p.cubes()[i], &b = q.cubes()[j];
        std::vector<std::pair<uint32_t, uint32_t>> pairs;
        if (b.children.empty() || (!a.children.empty() && a.side >= b.side))
            for (const uint32_t child : a.children)
                pairs.emplace_back(child, j);
        else
            for (const uint32_t child : b.children)
                pairs.emplace_back(i, child);
        return pairs;
    }

    // Step 1: the closest leaves.
    void find_closest(uint32_t i, uint32_t j, double apart) {
        if (apart >= best)
            return;
        const auto pairs = divided(i, j);
        if (pairs.empty()) {
            best = apart;
            best_p = i;
            best_q = j;
            return;
        }
        std::vector<std::pair<double, std::pair<uint32_t, uint32_t>>> ordered;
        for (const auto &pair : pairs)
            ordered.emplace_back(distance(pair.first, pair.second), pair);
        std::sort(ordered.begin(), ordered.end());
        for (const auto &next : ordered)
            find_closest(next.second.first, next.second.second, next.first);
    }

    // Step 3: all leaves that are nearer than the bound.
    void find_near(uint32_t i, uint32_t j, double bound) {
        if (distance(i, j) > bound)
            return;
        const auto pairs = divided(i, j);
        if (pairs.empty())
            near_p[i] = near_q[j] = 1;
        for (const auto &pair : pairs)
            find_near(pair.first, pair.second, bound);
    }
};

std::vector<uint32_t> triangles_of(const Octree &tree, const std::vector<uint8_t> &near) {
    std::vector<uint32_t> all;
    for (size_t i = 0; i < near.size(); i++)
        if (near[i])
            all.insert(all.end(), tree.cubes()[i].triangles.begin(), tree.cubes()[i].triangles.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

} // namespace

Candidates closest_candidates(const Octree &p, const Octree &q, pir_pose pose_p, pir_pose pose_q) {
    // Q stands unturned in this benchmark
    Search search{p, q, CubeSums(pose_p.rotation), {}, 0, HUGE_VAL, 0, 0, {}, {}};
    const pir_vec3 t = sub(pose_p.translation, pose_q.translation);
    for (const Octree::Cube &cube : p.cubes())
        search.at.push_back(add(search.sums.turned(cube.middle), t));
    search.near_p.resize(p.cubes().size());
    search.near_q.resize(q.cubes().size());
    search.find_closest(0, 0, search.distance(0, 0));
    const Octree::Cube &a = p.cubes()[search.best_p], &b = q.cubes()[search.best_q];
    const double bound = search.sums.most(sub(b.middle, search.at[search.best_p]), a.side, b.side);
    search.find_near(0, 0, bound);
    return {search.best, bound, triangles_of(p, search.near_p), triangles_of(q, search.near_q), search.asked};
}
