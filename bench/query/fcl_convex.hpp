// SPDX-License-Identifier: MIT
// A polytope as FCL's convex body, with its facets.
#ifndef BENCH_FCL_CONVEX_HPP
#define BENCH_FCL_CONVEX_HPP

#include <memory>
#include <vector>

#include <fcl/fcl.h>
#include <pirouette/pirouette.h>

inline std::shared_ptr<fcl::Convexd> fcl_convex(const pir_polytope *p) {
    auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
    for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
        pir_vec3 c = pir_polytope_vertex(p, v);
        vertices->emplace_back(c.x, c.y, c.z);
    }
    auto faces = std::make_shared<std::vector<int>>();
    for (uint32_t f = 0; f < pir_polytope_facet_count(p); f++) {
        std::vector<uint32_t> corners(pir_polytope_facet_size(p, f));
        pir_polytope_facet(p, f, corners.data());
        faces->push_back((int)corners.size());
        faces->insert(faces->end(), corners.begin(), corners.end());
    }
    return std::make_shared<fcl::Convexd>(vertices, (int)pir_polytope_facet_count(p), faces);
}

#endif
