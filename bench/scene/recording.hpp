// SPDX-License-Identifier: MIT
// Recorded piles: shapes, static boxes, and the poses of all bodies frame by frame. The format, little endian and
// packed:
//
//     "SCENE01\0"; u32 shapes, bodies, statics, frames; f32 dt
//     per shape:           u32 vertices, triangles; f32 vertex[vertices][3]; u32 triangle[triangles][3]
//     per static box:      f32 half[3], position[3], quaternion[4]
//     u32 shape[bodies]
//     per frame and body:  f32 position[3], quaternion[4] (x, y, z, w)
#ifndef BENCH_RECORDING_HPP
#define BENCH_RECORDING_HPP

#include <memory>
#include <string>
#include <vector>

#include <pirouette/pirouette.h>

struct RecordedBody {
    pir_polytope *polytope; // of the recording's
    pir_pose pose;          // of a static one
};

struct Recording {
    std::string name;
    std::vector<pir_polytope *> shapes;
    std::vector<RecordedBody> statics, bodies;
    std::vector<std::vector<pir_pose>> frames;

    Recording() = default;
    Recording(const Recording &) = delete;
    Recording &operator=(const Recording &) = delete;
    ~Recording();
};

// Reads a recording; ends the program with a message where the file is none.
std::unique_ptr<Recording> read_recording(const std::string &path);

// Tumbling hulls at constant density, a room for each cubic unit and a half; their poses for so many frames. Where
// `moving` is below `bodies`, all others stand still.
std::unique_ptr<Recording> make_rain(uint32_t bodies, uint32_t moving, uint32_t frames);

#endif
