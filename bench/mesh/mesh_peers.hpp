// SPDX-License-Identifier: MIT
// Meshes in FCL's terms, and how far they are apart by its trees of triangles.
#ifndef PIR_BENCH_MESH_PEERS_HPP
#define PIR_BENCH_MESH_PEERS_HPP

#include <cstdint>
#include <memory>
#include <vector>

#include <pirouette/pose.h>

struct Mesh {
    std::vector<pir_vec3> points;
    std::vector<uint32_t> corners; // three a triangle
};

class MeshPeer {
  public:
    virtual ~MeshPeer() = default;
    virtual double distance(const pir_pose &pose_p, const pir_pose &pose_q) = 0;
};

std::unique_ptr<MeshPeer> make_fcl_meshes(const Mesh &p, const Mesh &q);

#endif
