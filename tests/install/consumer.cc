// SPDX-License-Identifier: MIT
/*
 * The C++20 program outside the build: it sees only what an installation gives. It follows the sum of a box and a
 * segment through a quarter turn and asks how far the two are apart.
 */
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <numbers>
#include <span>

#include <pirouette/exact.h>
#include <pirouette/pirouette.h>

namespace {

/* An owner that releases what it holds with a call of the library. */
template <auto release> struct releaser {
    template <class T> void operator()(T *object) const {
        release(object);
    }
};
using polytope = std::unique_ptr<pir_polytope, releaser<pir_polytope_release>>;
using sum = std::unique_ptr<pir_sum, releaser<pir_sum_destroy>>;
using query = std::unique_ptr<pir_query, releaser<pir_query_destroy>>;

int fail(const char *what) {
    std::fprintf(stderr, "consumer: %s\n", what);
    return 1;
}

polytope make(std::span<const pir_vec3> points) {
    pir_polytope *made = nullptr;
    return pir_polytope_create(points.data(), points.size(), nullptr, &made) == PIR_OK ? polytope(made) : nullptr;
}

/* The x of every vertex is -1 or 1, exactly. */
bool is_centred(const pir_polytope &body) {
    mpq_t corner[3];
    mpq_inits(corner[0], corner[1], corner[2], nullptr);
    bool all = true;
    for (uint32_t v = 0; all && v < pir_polytope_vertex_count(&body); v++) {
        pir_polytope_vertex_exact(&body, v, corner);
        all = mpq_cmp_si(corner[0], 1, 1) == 0 || mpq_cmp_si(corner[0], -1, 1) == 0;
    }
    mpq_clears(corner[0], corner[1], corner[2], nullptr);
    return all;
}

} // namespace

int main() {
    if (std::strcmp(pir_version(), PIR_VERSION_STRING) != 0)
        return fail("headers and library are of different versions");

    // The cube [-1, 1]^3, and a segment of length 2 along x.
    std::array<pir_vec3, 8> corners;
    for (int i = 0; i < 8; i++)
        corners[i] = {.x = i & 1 ? 1.0 : -1.0, .y = i & 2 ? 1.0 : -1.0, .z = i & 4 ? 1.0 : -1.0};
    const polytope cube = make(corners);
    const polytope segment = make(std::array{pir_vec3{-1, 0, 0}, pir_vec3{1, 0, 0}});
    if (!cube || !segment || !is_centred(*cube) || !is_centred(*segment))
        return fail("no polytopes");

    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    pir_sum *made = nullptr;
    if (pir_sum_create(segment.get(), cube.get(), pir_quat{.x = 0, .y = 0, .z = 0, .w = 1}, &options, &made) != PIR_OK)
        return fail("no sum");
    const sum difference(made);
    pir_query *asked = nullptr;
    if (pir_query_create(difference.get(), &asked) != PIR_OK)
        return fail("no query");
    const query places(asked);

    // The segment turns about z, its centre at (4, 0, 0): it reaches the farther towards the cube the less it has
    // turned.
    for (int degrees = 0; degrees <= 90; degrees += 15) {
        const double half = degrees * std::numbers::pi / 360;
        const pir_quat turn{.x = 0, .y = 0, .z = std::sin(half), .w = std::cos(half)};
        pir_query_input input = pir_query_input_default();
        input.translation = {.x = 4, .y = 0, .z = 0};
        pir_query_result result;
        if (pir_sum_rotate(difference.get(), turn, PIR_METHOD_UPDATE) != PIR_OK ||
            pir_query_signed_distance(places.get(), &input, nullptr, &result) != PIR_OK)
            return fail("no distance");
        if (result.state != PIR_OUTSIDE || std::abs(result.distance - (3 - std::cos(2 * half))) > 1e-12)
            return fail("the distance of a segment that turns is wrong");
    }
    std::printf("pirouette %s is installed and works in C++\n", pir_version());
}
