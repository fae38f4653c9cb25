// SPDX-License-Identifier: MIT
// See triangles.hpp. Facets lose one ear after the other, seen along the axis that their normal is nearest to.
#include "triangles.hpp"

#include <cmath>
#include <map>

namespace {

using Point = std::array<double, 3>;

// Twice the area of a polygon, as a vector.
Point normal_of(const Triangles &mesh, const std::vector<uint32_t> &loop) {
    Point n{};
    for (size_t i = 0; i < loop.size(); i++) {
        const Point &a = mesh.points[loop[i]], &b = mesh.points[loop[(i + 1) % loop.size()]];
        for (int k = 0; k < 3; k++)
            n[k] += a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    }
    return n;
}

struct View {
    const Triangles &mesh;
    int x, y;
    // Twice the area of a triangle as seen.
    double area(uint32_t a, uint32_t b, uint32_t c) const {
        const Point &p = mesh.points[a], &q = mesh.points[b], &r = mesh.points[c];
        return (q[x] - p[x]) * (r[y] - p[y]) - (q[y] - p[y]) * (r[x] - p[x]);
    }
};

bool is_ear(const View &view, const std::vector<uint32_t> &loop, size_t at) {
    const size_t n = loop.size();
    const uint32_t a = loop[(at + n - 1) % n], b = loop[at], c = loop[(at + 1) % n];
    if (view.area(a, b, c) <= 0)
        return false;
    for (uint32_t p : loop)
        if (p != a && p != b && p != c && view.area(a, b, p) >= 0 && view.area(b, c, p) >= 0 && view.area(c, a, p) >= 0)
            return false;
    return true;
}

void add_facet(Triangles &mesh, std::vector<uint32_t> loop) {
    const Point n = normal_of(mesh, loop);
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (std::fabs(n[k]) > std::fabs(n[axis]))
            axis = k;
    const bool away = n[axis] < 0;
    const View view{mesh, (axis + 1 + away) % 3, (axis + 2 - away) % 3};
    while (loop.size() > 3) {
        size_t at = 0;
        while (at + 1 < loop.size() && !is_ear(view, loop, at))
            at++;
        mesh.corners.push_back({loop[(at + loop.size() - 1) % loop.size()], loop[at], loop[(at + 1) % loop.size()]});
        loop.erase(loop.begin() + (long)at);
    }
    mesh.corners.push_back({loop[0], loop[1], loop[2]});
}

} // namespace

Triangles triangles_of(const solid_model &model) {
    Triangles mesh;
    std::map<Point, uint32_t> numbers;
    for (uint32_t f = 0; f < model.facets; f++) {
        std::vector<uint32_t> loop;
        for (uint32_t i = model.start[f]; i < model.start[f + 1]; i++) {
            const pir_vec3 v = model.point[model.corner[i]];
            const Point at = {v.x + 0.0, v.y + 0.0, v.z + 0.0};
            const auto known = numbers.emplace(at, (uint32_t)mesh.points.size());
            if (known.second)
                mesh.points.push_back(at);
            loop.push_back(known.first->second);
        }
        add_facet(mesh, loop);
    }
    return mesh;
}
