// SPDX-License-Identifier: MIT
// CGAL's spherical Gaussian map (Arr_polyhedral_sgm), with the exact kernel that filters and caches: the overlay is
// timed.
#include "peers.h"

#include <list>
#include <vector>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include <CGAL/Arr_spherical_gaussian_map_3/Arr_polyhedral_sgm.h>
#include <CGAL/Arr_spherical_gaussian_map_3/Arr_polyhedral_sgm_overlay.h>
#include <CGAL/Arr_spherical_gaussian_map_3/Arr_polyhedral_sgm_polyhedron_3.h>
#include <CGAL/Arr_spherical_gaussian_map_3/Arr_polyhedral_sgm_traits.h>

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Traits = CGAL::Arr_polyhedral_sgm_traits<Kernel, -8, 6>;
using Sgm = CGAL::Arr_polyhedral_sgm<Traits>;
using Polyhedron = CGAL::Arr_polyhedral_sgm_polyhedron_3<Sgm, Kernel>;
using Initializer = CGAL::Arr_polyhedral_sgm_initializer<Sgm, Polyhedron>;
using Facet = std::vector<std::size_t>;

// The facets keep their corners; where turning has bent one a little, its plane is that of its first three.
static void make_map(Sgm &sgm, const pir_polytope *p, double (*matrix)[3]) {
    std::vector<Kernel::Point_3> points;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
        pir_vec3 x = pir_polytope_vertex(p, v);
        double c[3] = {x.x, x.y, x.z};
        for (int i = 0; i < 3 && matrix; i++)
            c[i] = matrix[i][0] * x.x + matrix[i][1] * x.y + matrix[i][2] * x.z;
        points.emplace_back(c[0], c[1], c[2]);
    }
    std::list<Facet> facets;
    for (uint32_t f = 0; f < pir_polytope_facet_count(p); f++) {
        std::vector<uint32_t> corners(pir_polytope_facet_size(p, f));
        pir_polytope_facet(p, f, corners.data());
        facets.emplace_back(corners.begin(), corners.end());
    }
    Initializer initialize(sgm);
    initialize(points.begin(), points.end(), points.size(), facets.begin(), facets.end(), facets.size());
}

struct peer_result peer_cgal_sgm(const pir_polytope *p, double matrix[3][3], const pir_polytope *q) {
    Sgm of_p, of_q, sum;
    make_map(of_p, p, matrix);
    make_map(of_q, q, nullptr);
    double start = peer_clock();
    sum.minkowski_sum(of_p, of_q);
    double milliseconds = peer_clock() - start;
    return {milliseconds, static_cast<uint32_t>(sum.number_of_vertices()),
            static_cast<uint32_t>(sum.number_of_facets())};
}
