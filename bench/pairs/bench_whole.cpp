// SPDX-License-Identifier: MIT
//
// Whole sums with their queries, as objects: what they weigh, what making them takes, and many at once.
//
// whole.csv has a line for each body with itself: the bytes of a sum and of a query on it, both after a thousand frames
// at 500 steps, of the workspace of their thread, and of what they left with the polytopes, which all others share;
// then the time of making either, in a workspace that is warm, and of beginning again by pir_sum_reset. whole_many.csv
// has 10 to 10,000 sums of two hulls of 20 points, each at its own place of the motion: the time of a turn and a signed
// distance, and the bytes.
//
//     bench_whole FOLDER
#include <algorithm>
#include <cstdlib>
#include <string>

#include "pair_poses.hpp"
#include "results.h"

namespace {

void check(pir_status status) {
    if (status != PIR_OK) {
        std::fprintf(stderr, "bench_whole: %s\n", pir_status_text(status));
        std::exit(2);
    }
}

// An allocator that counts what is there.
struct Counted {
    size_t bytes = 0, blocks = 0, most = 0;
    pir_allocator allocator{resize, this};

    static void *resize(void *context, void *block, size_t old_size, size_t new_size) {
        Counted *counted = static_cast<Counted *>(context);
        counted->bytes += new_size - old_size;
        counted->blocks += (new_size > 0) - (size_t)(old_size > 0);
        counted->most = std::max(counted->most, counted->bytes);
        if (new_size > 0)
            return std::realloc(block, new_size);
        std::free(block);
        return nullptr;
    }
};

pir_sum_options options_of(const pir_allocator *allocator, pir_workspace *workspace) {
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    options.allocator = allocator;
    options.workspace = workspace;
    return options;
}

struct Whole {
    pir_sum *sum = nullptr;
    pir_query *query = nullptr;
    pir_query_cache cache = {};

    void make_sum(pir_polytope *p, const Pose &pose, const pir_sum_options &options) {
        check(pir_sum_create(p, p, pose.r, &options, &sum));
    }
    void make_query() {
        check(pir_query_create(sum, &query));
    }
    double ask(const Pose &pose) {
        pir_query_input input = pir_query_input_default();
        pir_query_result result;
        input.translation = pose.t;
        pir_sum_rotate(sum, pose.r, PIR_METHOD_AUTO);
        pir_query_signed_distance(query, &input, &cache, &result);
        return result.distance;
    }
    void destroy() {
        pir_query_destroy(query);
        pir_sum_destroy(sum);
        *this = {};
    }
};

double median_of(std::vector<double> ns) {
    std::sort(ns.begin(), ns.end());
    return ns[ns.size() / 2];
}

// What a sum and a query hold: made with allocators of their own.
void weigh(pir_polytope *polytope, const std::vector<Pose> &poses, size_t ret_bytes[4]) {
    std::vector<pir_vec3> points;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(polytope); v++)
        points.push_back(pir_polytope_vertex(polytope, v));
    Counted shared, own, scratch;
    pir_polytope_options with = pir_polytope_options_default();
    with.allocator = &shared.allocator;
    pir_polytope *p;
    check(pir_polytope_create(points.data(), points.size(), &with, &p));
    size_t alone = shared.bytes;
    pir_workspace *workspace;
    check(pir_workspace_create(&scratch.allocator, &workspace));
    pir_sum_options options = options_of(&own.allocator, workspace);
    Whole whole;
    whole.make_sum(p, poses[0], options);
    for (const Pose &pose : poses)
        check(pir_sum_rotate(whole.sum, pose.r, PIR_METHOD_AUTO));
    size_t sum = own.bytes;
    whole.make_query();
    for (const Pose &pose : poses)
        whole.ask(pose);
    ret_bytes[0] = sum;
    ret_bytes[1] = own.bytes;
    ret_bytes[2] = scratch.bytes;
    ret_bytes[3] = shared.bytes - alone;
    whole.destroy();
    pir_workspace_destroy(workspace);
    pir_polytope_release(p);
    if (own.bytes + scratch.bytes + shared.bytes != 0)
        std::exit(2);
}

void run_body(FILE *csv, const char *name, pir_polytope *p, double overhead) {
    std::vector<Pose> poses = hovering(p, p, (int)results_count(1000), 500);
    size_t bytes[4];
    weigh(p, poses, bytes);
    pir_workspace *workspace;
    check(pir_workspace_create(nullptr, &workspace));
    pir_sum_options options = options_of(nullptr, workspace);
    std::vector<double> sum, query, both, again;
    Whole kept;
    kept.make_sum(p, poses[0], options);
    kept.make_query();
    for (const Pose &pose : poses) {
        Whole whole;
        double made = nanoseconds(overhead, [&] { whole.make_sum(p, pose, options); }),
               asked = nanoseconds(overhead, [&] { whole.make_query(); });
        sum.push_back(made);
        query.push_back(asked);
        both.push_back(made + asked);
        whole.destroy();
        again.push_back(nanoseconds(overhead, [&] { check(pir_sum_reset(kept.sum, pose.r)); }));
    }
    kept.destroy();
    pir_workspace_destroy(workspace);
    std::printf("%-13s %8zu %8zu %8zu %8zu  %9.0f %9.0f %9.0f %9.0f\n", name, bytes[0], bytes[1] - bytes[0], bytes[2],
                bytes[3], median_of(sum), median_of(query), median_of(both), median_of(again));
    std::fprintf(csv, "%s,%u,%zu,%zu,%zu,%zu,%zu,%.0f,%.0f,%.0f,%.0f\n", name, pir_polytope_facet_count(p), bytes[0],
                 bytes[1] - bytes[0], bytes[1], bytes[2], bytes[3], median_of(sum), median_of(query), median_of(both),
                 median_of(again));
}

void run_many(FILE *csv, pir_polytope *p, const std::vector<Pose> &poses, int count) {
    Counted own;
    pir_workspace *workspace;
    check(pir_workspace_create(&own.allocator, &workspace));
    pir_sum_options options = options_of(&own.allocator, workspace);
    std::vector<Whole> all((size_t)count);
    auto pose_of = [&](size_t i, size_t frame) { return poses[(i * 37 + frame) % poses.size()]; };
    for (size_t i = 0; i < all.size(); i++) {
        all[i].make_sum(p, pose_of(i, 0), options);
        all[i].make_query();
    }
    std::vector<double> ns;
    size_t frames = results_count(count > 1000 ? 150 : 600);
    for (size_t frame = 0; frame < frames; frame++)
        ns.push_back(nanoseconds(0, [&] {
            for (size_t i = 0; i < all.size(); i++)
                all[i].ask(pose_of(i, frame));
        }));
    double median = median_of(ns), fastest = *std::min_element(ns.begin(), ns.end());
    std::printf("%-13s %5d sums: %8.1f ns each, %7.3f ms a frame (fastest %7.3f), %7.1f MB\n", "20 points", count,
                median / count, median / 1e6, fastest / 1e6, (double)own.bytes / 1e6);
    std::fprintf(csv, "20 points,%d,%.1f,%.4f,%.4f,%zu,%zu\n", count, median / count, median / 1e6, fastest / 1e6,
                 own.bytes, frames);
    for (Whole &whole : all)
        whole.destroy();
    pir_workspace_destroy(workspace);
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: bench_whole FOLDER\n");
        return 2;
    }
    results where = results_new(argv[1]);
    double overhead = clock_cost();
    struct {
        const char *name;
        pir_polytope *polytope;
    } bodies[] = {{"cube", shape("cube")},
                  {"icosahedron", shape("icosahedron")},
                  {"20 points", sphere_points(20)},
                  {"60 points", sphere_points(60)},
                  {"gs4", shape("gs4")},
                  {"ellipsoid960", shape("ellipse")}};
    FILE *csv = results_open(&where, "whole.csv");
    std::fprintf(csv,
                 "body,facets,sum_bytes,query_bytes,both_bytes,workspace_bytes,polytope_bytes,sum_ns,query_ns,both_ns,"
                 "reset_ns\n");
    std::printf("%-13s %8s %8s %8s %8s  %9s %9s %9s %9s\n", "body", "sum", "query", "scratch", "shared", "sum ns",
                "query ns", "both ns", "reset ns");
    for (auto &body : bodies)
        run_body(csv, body.name, body.polytope, overhead);
    results_close(csv, "whole.csv");
    csv = results_open(&where, "whole_many.csv");
    std::fprintf(csv, "body,sums,ns_each,frame_ms,fastest_frame_ms,bytes,frames\n");
    std::vector<Pose> poses = hovering(bodies[2].polytope, bodies[2].polytope, (int)results_count(5000), 500);
    for (int count : {10, 100, 1000, 10000})
        run_many(csv, bodies[2].polytope, poses, (int)results_count((uint32_t)count));
    results_close(csv, "whole_many.csv");
    for (auto &body : bodies)
        pir_polytope_release(body.polytope);
    std::printf("results in %s\n", where.folder);
    return 0;
}
