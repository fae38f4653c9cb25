// SPDX-License-Identifier: MIT
// CGAL's convex hull of the pairwise sums.
#include "peers.h"

#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

struct peer_result peer_cgal_hull(const pir_polytope *p, double matrix[3][3], const pir_polytope *q) {
    double start = peer_clock();
    std::vector<Kernel::Point_3> points;
    points.reserve(static_cast<std::size_t>(pir_polytope_vertex_count(p)) * pir_polytope_vertex_count(q));
    for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
        pir_vec3 x = pir_polytope_vertex(p, v);
        double c[3];
        for (int i = 0; i < 3; i++)
            c[i] = matrix[i][0] * x.x + matrix[i][1] * x.y + matrix[i][2] * x.z;
        for (uint32_t w = 0; w < pir_polytope_vertex_count(q); w++) {
            pir_vec3 y = pir_polytope_vertex(q, w);
            points.emplace_back(c[0] + y.x, c[1] + y.y, c[2] + y.z);
        }
    }
    CGAL::Surface_mesh<Kernel::Point_3> hull;
    CGAL::convex_hull_3(points.begin(), points.end(), hull);
    return {peer_clock() - start, static_cast<uint32_t>(hull.number_of_vertices()), 0};
}
