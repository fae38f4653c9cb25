// SPDX-License-Identifier: MIT
//
// The distance of two meshes as Diktaş and Şahiner have it (An Object-Space Method for Calculating the Minkowski Sums
// of Simple 3D Objects, 2006, section 5.1), as it is written there: octrees of cubes fitted to both meshes. The two
// closest cubes are found by the least distance of cubes; the greatest distance of these two is a bound; all cubes that
// are nearer than the bound hold the triangles that may be the closest.
//
// The distance of two cubes is that of a point from their sum. At one rotation all these sums are scalings of one
// prototype, whose facets name a vertex of each cube by index.
#ifndef BENCH_MESH_OCTREE_PAIR_HPP
#define BENCH_MESH_OCTREE_PAIR_HPP

#include <cstdint>
#include <vector>

#include <pirouette/pose.h>

#include "mesh_peers.hpp"

// The cubes around a mesh's triangles, each with its children or, at the last depth, its triangles.
class Octree {
  public:
    struct Cube {
        pir_vec3 middle;
        double side;
        std::vector<uint32_t> children, triangles;
    };
    Octree(const Mesh &mesh, int depth);
    const std::vector<Cube> &cubes() const {
        return cubes_;
    }
    size_t leaves() const;

  private:
    uint32_t add(const Mesh &mesh, pir_vec3 middle, double side, const std::vector<uint32_t> &triangles, int depth);
    std::vector<Cube> cubes_; // the root first
};

// The sums of all cubes at one rotation.
class CubeSums {
  public:
    explicit CubeSums(pir_quat rotation);
    // The least and the greatest distance of a turned cube of side p and a cube of side q, t between their middles.
    double least(pir_vec3 t, double p, double q) const;
    double most(pir_vec3 t, double p, double q) const;
    pir_vec3 turned(pir_vec3 x) const;

  private:
    struct Facet {
        pir_vec3 normal;
        double of_p, of_q; // the plane's offset for sides of 1
        std::vector<uint32_t> corners;
    };
    pir_vec3 place(uint32_t vertex, double p, double q) const;
    double matrix_[3][3];
    std::vector<pir_vec3> at_p_, at_q_; // the parts of each vertex of the prototype, for sides of 1
    std::vector<Facet> facets_;
};

struct Candidates {
    double least, bound;              // of the closest cubes
    std::vector<uint32_t> of_p, of_q; // potentially closest triangles, rising
    uint64_t sums;                    // distances of cubes
};

// The triangles that may be the closest.
Candidates closest_candidates(const Octree &p, const Octree &q, pir_pose pose_p, pir_pose pose_q);

#endif
