// SPDX-License-Identifier: MIT
// CGAL: decomposition into convex pieces, sums of pairs, union, on Nef polyhedra over exact numbers.
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/Polyhedron_incremental_builder_3.h>
#include <CGAL/minkowski_sum_3.h>

#include "solid_peers.hpp"
#include "stages.h"

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Polyhedron = CGAL::Polyhedron_3<Kernel>;
using Nef = CGAL::Nef_polyhedron_3<Kernel>;

struct Builder : public CGAL::Modifier_base<Polyhedron::HalfedgeDS> {
    const Triangles &from;
    explicit Builder(const Triangles &triangles) : from(triangles) {
    }
    void operator()(Polyhedron::HalfedgeDS &hds) {
        CGAL::Polyhedron_incremental_builder_3<Polyhedron::HalfedgeDS> builder(hds, true);
        builder.begin_surface(from.points.size(), from.corners.size());
        for (const auto &p : from.points)
            builder.add_vertex(Kernel::Point_3(p[0], p[1], p[2]));
        for (const auto &t : from.corners) {
            builder.begin_facet();
            for (uint32_t corner : t)
                builder.add_vertex_to_facet(corner);
            builder.end_facet();
        }
        builder.end_surface();
    }
};

Nef nef_of(const Triangles &triangles) {
    Polyhedron polyhedron;
    Builder builder(triangles);
    polyhedron.delegate(builder);
    return Nef(polyhedron);
}

} // namespace

double nef_sum(const Triangles &p, const Triangles &q) {
    Nef a = nef_of(p), b = nef_of(q);
    const double begun = stages_clock();
    Nef sum = CGAL::minkowski_sum_3(a, b);
    return sum.number_of_facets() > 0 ? stages_clock() - begun : -1;
}
