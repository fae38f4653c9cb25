// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdlib>

#include "results.h"
#include "scene.hpp"

namespace {

constexpr size_t COUNT = 10000;
constexpr uint32_t ROUNDS = 15;

// Uniform in the box of the difference of the body from itself, `scale` times as large; inside it alone if asked.
std::vector<pir_vec3> translations(pir_query *query, const pir_polytope *p, double scale, bool inside) {
    Random random;
    pir_vec3 low, high;
    pir_polytope_bounds(p, &low, &high);
    pir_vec3 half{scale * (high.x - low.x), scale * (high.y - low.y), scale * (high.z - low.z)};
    std::vector<pir_vec3> t;
    while (t.size() < COUNT) {
        pir_query_input input = pir_query_input_default();
        pir_query_result result;
        input.translation = {half.x * random.unit(), half.y * random.unit(), half.z * random.unit()};
        if (pir_query_overlap(query, &input, nullptr, &result) != PIR_OK)
            std::exit(2);
        if (!inside || result.state == PIR_INSIDE)
            t.push_back(input.translation);
    }
    return t;
}

} // namespace

void run_batches(FILE *csv, const char *set, pir_polytope *p) {
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    pir_sum *sum;
    pir_query *query;
    if (pir_sum_create(p, p, {0.1, 0.2, 0.3, 0.9}, &options, &sum) != PIR_OK || pir_query_create(sum, &query) != PIR_OK)
        std::exit(2);
    std::vector<pir_state> states(COUNT);
    std::vector<double> numbers(COUNT);
    for (int inside = 0; inside < 2; inside++) {
        std::vector<pir_vec3> t = translations(query, p, inside ? 1 : 1.25, inside != 0);
        auto line = [&](const char *what, auto &&batch) {
            Times times;
            for (uint32_t round = 0; round < results_count(ROUNDS); round++)
                times.ns.push_back(cpu_nanoseconds(batch) / COUNT);
            const char *where = inside ? "inside" : "in and around";
            std::printf("%-14s %-14s batch %-10s %9.4f %9.4f\n", set, where, what, times.median() / 1e3,
                        times.fastest() / 1e3);
            std::fprintf(csv, "%s,batch %s,ours %s,%.1f,%.1f,%.1f,,,,,\n", set, where, what, times.median(),
                         times.mean(), times.fastest());
        };
        line("states", [&] { pir_query_batch_states(query, t.data(), COUNT, states.data()); });
        line("depths", [&] { pir_query_batch_depths(query, t.data(), COUNT, numbers.data(), nullptr); });
        line("distances", [&] { pir_query_batch_distances(query, t.data(), COUNT, numbers.data(), nullptr); });
    }
    pir_query_destroy(query);
    pir_sum_destroy(sum);
}
