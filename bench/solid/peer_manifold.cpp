// SPDX-License-Identifier: MIT
// Manifold's Minkowski sum, in doubles, built without threads.
#include <manifold/manifold.h>

#include "solid_peers.hpp"
#include "stages.h"

static manifold::Manifold body_of(const Triangles &triangles) {
    manifold::MeshGL64 mesh;
    mesh.numProp = 3;
    for (const auto &p : triangles.points)
        mesh.vertProperties.insert(mesh.vertProperties.end(), p.begin(), p.end());
    for (const auto &t : triangles.corners)
        mesh.triVerts.insert(mesh.triVerts.end(), t.begin(), t.end());
    return manifold::Manifold(mesh);
}

double manifold_sum(const Triangles &p, const Triangles &q) {
    manifold::Manifold a = body_of(p), b = body_of(q);
    if (a.Status() != manifold::Manifold::Error::NoError || b.Status() != manifold::Manifold::Error::NoError)
        return -1;
    const double begun = stages_clock();
    manifold::Manifold sum = a.MinkowskiSum(b);
    return sum.NumTri() > 0 ? stages_clock() - begun : -1;
}
