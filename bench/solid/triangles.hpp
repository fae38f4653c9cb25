// SPDX-License-Identifier: MIT
// The triangles of a model: points at one place are one.
#ifndef PIR_BENCH_TRIANGLES_HPP
#define PIR_BENCH_TRIANGLES_HPP

#include "solid/models.h"
#include "solid_peers.hpp"

Triangles triangles_of(const solid_model &model);

#endif
