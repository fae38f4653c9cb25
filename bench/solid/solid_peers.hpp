// SPDX-License-Identifier: MIT
// The engines that add solids beside ours. Each takes triangles, and gives processor seconds of the sum alone, or a
// negative number when it fails.
#ifndef PIR_BENCH_SOLID_PEERS_HPP
#define PIR_BENCH_SOLID_PEERS_HPP

#include <array>
#include <cstdint>
#include <vector>

struct Triangles {
    std::vector<std::array<double, 3>> points;
    std::vector<std::array<uint32_t, 3>> corners;
};

double nef_sum(const Triangles &p, const Triangles &q);
double manifold_sum(const Triangles &p, const Triangles &q);

#endif
