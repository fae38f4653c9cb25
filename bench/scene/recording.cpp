// SPDX-License-Identifier: MIT
#include "recording.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace {

[[noreturn]] void fail(const std::string &path, const char *why) {
    std::fprintf(stderr, "bench_scene: %s: %s\n", path.c_str(), why);
    std::exit(2);
}

// The bytes of a file, taken from the front.
class Reader {
  public:
    explicit Reader(const std::string &path) : path_(path) {
        std::ifstream file(path, std::ios::binary);
        if (!file)
            fail(path, "cannot be read");
        bytes_.assign(std::istreambuf_iterator<char>(file), {});
    }
    template <typename T> T take() {
        T value;
        if (bytes_.size() - at_ < sizeof value)
            fail(path_, "ends too early");
        std::memcpy(&value, bytes_.data() + at_, sizeof value);
        at_ += sizeof value;
        return value;
    }
    pir_vec3 take_vec() {
        float x = take<float>(), y = take<float>(), z = take<float>();
        return {x, y, z};
    }
    pir_pose take_pose() {
        pir_pose pose;
        pose.translation = take_vec();
        float x = take<float>(), y = take<float>(), z = take<float>(), w = take<float>();
        pose.rotation = {x, y, z, w};
        return pose;
    }
    void expect(bool holds, const char *why) const {
        if (!holds)
            fail(path_, why);
    }

  private:
    std::string path_;
    std::vector<char> bytes_;
    size_t at_ = 0;
};

pir_polytope *hull(const std::vector<pir_vec3> &points) {
    pir_polytope *made = nullptr;
    if (pir_polytope_create(points.data(), points.size(), nullptr, &made) != PIR_OK) {
        std::fprintf(stderr, "bench_scene: a shape has no hull\n");
        std::exit(2);
    }
    return made;
}

pir_polytope *box(pir_vec3 half) {
    std::vector<pir_vec3> corners;
    for (int i = 0; i < 8; i++)
        corners.push_back({i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
    return hull(corners);
}

// Numbers in [−1, 1), from a linear congruence: the same everywhere.
class Numbers {
  public:
    double next() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return (double)(int64_t)state_ * 0x1p-63;
    }
    pir_vec3 vec() {
        double x = next(), y = next(), z = next();
        return {x, y, z};
    }

  private:
    uint64_t state_ = 1;
};

} // namespace

Recording::~Recording() {
    for (pir_polytope *shape : shapes)
        pir_polytope_release(shape);
}

std::unique_ptr<Recording> read_recording(const std::string &path) {
    Reader in(path);
    auto made = std::make_unique<Recording>();
    made->name = path.substr(path.rfind('/') + 1);
    for (char c : {'S', 'C', 'E', 'N', 'E', '0', '1', '\0'})
        in.expect(in.take<char>() == c, "is no recording");
    uint32_t shapes = in.take<uint32_t>(), bodies = in.take<uint32_t>(), statics = in.take<uint32_t>(),
             frames = in.take<uint32_t>();
    in.take<float>();
    for (uint32_t i = 0; i < shapes; i++) {
        uint32_t vertices = in.take<uint32_t>(), triangles = in.take<uint32_t>();
        std::vector<pir_vec3> points;
        for (uint32_t v = 0; v < vertices; v++)
            points.push_back(in.take_vec());
        for (uint32_t t = 0; t < 3 * triangles; t++)
            in.take<uint32_t>();
        made->shapes.push_back(hull(points));
    }
    for (uint32_t i = 0; i < statics; i++) {
        made->shapes.push_back(box(in.take_vec()));
        made->statics.push_back({made->shapes.back(), in.take_pose()});
    }
    for (uint32_t i = 0; i < bodies; i++) {
        uint32_t shape = in.take<uint32_t>();
        in.expect(shape < shapes, "names a shape that it lacks");
        made->bodies.push_back({made->shapes[shape], pir_pose_identity()});
    }
    made->frames.resize(frames);
    for (auto &frame : made->frames)
        for (uint32_t i = 0; i < bodies; i++)
            frame.push_back(in.take_pose());
    return made;
}

std::unique_ptr<Recording> make_rain(uint32_t bodies, uint32_t moving, uint32_t frames) {
    constexpr uint32_t SHAPES = 32;
    auto made = std::make_unique<Recording>();
    made->name = "rain " + std::to_string(bodies) + (moving < bodies ? " moving " + std::to_string(moving) : "");
    Numbers numbers;
    for (uint32_t i = 0; i < SHAPES; i++) {
        std::vector<pir_vec3> points;
        for (uint32_t v = 0; v < 10 + i; v++) {
            pir_vec3 x = numbers.vec();
            double half = 0.5 / std::sqrt(x.x * x.x + x.y * x.y + x.z * x.z + 1e-9);
            points.push_back({x.x * half, x.y * half, x.z * half});
        }
        made->shapes.push_back(hull(points));
    }
    double half = 0.5 * std::cbrt(1.5 * bodies);
    std::vector<pir_pose> poses;
    std::vector<pir_vec3> velocity, spin;
    for (uint32_t i = 0; i < bodies; i++) {
        made->bodies.push_back({made->shapes[i % SHAPES], pir_pose_identity()});
        pir_vec3 at = numbers.vec(), turn = numbers.vec();
        pir_pose pose = {{turn.x, turn.y, turn.z, 1}, {half * at.x, half * at.y, half * at.z}};
        // of length 1, which the others need
        poses.push_back(pir_pose_integrate(pose, {0, 0, 0}, {0, 0, 0}, 0));
        velocity.push_back(numbers.vec());
        spin.push_back(numbers.vec());
    }
    for (uint32_t f = 0; f < frames; f++) {
        made->frames.push_back(poses);
        for (uint32_t i = 0; i < moving; i++) {
            uint32_t body = i * (bodies / moving);
            // back and forth, so that density stays
            pir_vec3 v = velocity[body];
            double way = f / 30 % 2 ? -1 : 1;
            poses[body] = pir_pose_integrate(poses[body], {way * v.x, way * v.y, way * v.z}, spin[body], 1. / 60);
        }
    }
    return made;
}
