// SPDX-License-Identifier: MIT
//
// Two bumpy spheres of triangles, one of which turns about itself: state and nearest triangles from frame to frame,
// beside FCL's distance of OBBRSS trees, frame by frame in one run.
//
// mesh_pairs.csv has a line for each number of triangles, distance and step: the time of a frame, median, mean, 99th
// percentile and greatest, the first call apart; FCL's median and mean; what a frame looks at; the front. How often
// FCL's distance is off by more than 1e-9 of the size, where the surfaces do not meet, stands last.
// mesh_surfaces.csv: building, memory, rays and nearest points. mesh_octrees.csv: the algorithm of octree_pair.hpp on
// meshes of 15,680 triangles, by the depth of its octrees: which share of the triangles it leaves out, what it takes
// beside a pair that is new at each pose, and how often the nearest triangles were left out.
//
//     bench_mesh FOLDER
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>

#include <pirouette/shape.h>
#include <pirouette/trimesh.h>
#include <pirouette/trimesh_pair.h>

#include "mesh_peers.hpp"
#include "octree_pair.hpp"
#include "results.h"

namespace {

// This thread's time: on a machine that others use as well it is what a call takes.
double now_us() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec;
}

void check(pir_status status) {
    if (status != PIR_OK) {
        std::fprintf(stderr, "bench_mesh: %s\n", pir_status_text(status));
        std::exit(2);
    }
}

pir_vec3 bumpy(pir_vec3 v) {
    const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    v = {v.x / length, v.y / length, v.z / length};
    const double r = 1 + 0.1 * std::sin(5 * v.x) * std::sin(7 * v.y + 1) * std::sin(6 * v.z + 2);
    return {v.x * r, v.y * r, v.z * r};
}

// An icosahedron whose triangles are divided in four, `level` times.
Mesh bumpy_sphere(int level) {
    const double g = 0.5 * (1 + std::sqrt(5.0));
    Mesh mesh;
    mesh.points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.corners = {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4,  11, 10, 2,  10, 7, 6, 7, 1, 8,
                    3, 9,  4, 3, 4, 2, 3, 2, 6, 3, 6, 8,  3, 8,  9,  4, 9, 5, 2, 4,  11, 6,  2,  10, 8,  6, 7, 9, 8, 1};
    for (int i = 0; i < level; i++) {
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
        const auto middle = [&](uint32_t a, uint32_t b) {
            const auto key = std::minmax(a, b);
            const auto found = middles.find(key);
            if (found != middles.end())
                return found->second;
            const pir_vec3 p = mesh.points[a], q = mesh.points[b];
            const pir_vec3 m = {p.x + q.x, p.y + q.y, p.z + q.z};
            const double by = std::sqrt((g * g + 1) / (m.x * m.x + m.y * m.y + m.z * m.z));
            mesh.points.push_back({m.x * by, m.y * by, m.z * by});
            return middles[key] = (uint32_t)mesh.points.size() - 1;
        };
        std::vector<uint32_t> finer;
        for (size_t t = 0; t < mesh.corners.size(); t += 3) {
            const uint32_t a = mesh.corners[t], b = mesh.corners[t + 1], c = mesh.corners[t + 2];
            const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            for (const uint32_t corner : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca})
                finer.push_back(corner);
        }
        mesh.corners = finer;
    }
    for (pir_vec3 &v : mesh.points)
        v = bumpy(v);
    return mesh;
}

// A geodesic sphere of 15,680 triangles, about as many as the paper's bunny has, with bumps.
Mesh bumpy_geodesic() {
    pir_polytope *sphere = nullptr;
    check(pir_shape_create("geodesic?level=27", nullptr, nullptr, &sphere));
    Mesh mesh;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(sphere); v++)
        mesh.points.push_back(bumpy(pir_polytope_vertex(sphere, v)));
    for (uint32_t f = 0; f < pir_polytope_facet_count(sphere); f++) {
        std::vector<uint32_t> corners(pir_polytope_facet_size(sphere, f));
        pir_polytope_facet(sphere, f, corners.data());
        for (size_t i = 1; i + 1 < corners.size(); i++)
            mesh.corners.insert(mesh.corners.end(), {corners[0], corners[i], corners[i + 1]});
    }
    pir_polytope_release(sphere);
    return mesh;
}

pir_trimesh *make(const Mesh &mesh) {
    pir_trimesh_arrays arrays{};
    arrays.vertices = mesh.points.data();
    arrays.vertex_count = mesh.points.size();
    arrays.triangles = mesh.corners.data();
    arrays.triangle_count = mesh.corners.size() / 3;
    pir_trimesh *made = nullptr;
    check(pir_trimesh_create(&arrays, nullptr, nullptr, &made));
    return made;
}

struct Times {
    std::vector<double> us;
    double at(double part) {
        if (us.empty())
            return 0;
        std::sort(us.begin(), us.end());
        return us[(size_t)(part * (double)(us.size() - 1))];
    }
    double mean() const {
        double sum = 0;
        for (const double t : us)
            sum += t;
        return us.empty() ? 0 : sum / (double)us.size();
    }
};

// P, turned about a tilted axis by a part of a turn; at a distance of the middles.
pir_pose pose_at(uint32_t frame, uint32_t steps, double distance) {
    const double half = 3.141592653589793 * frame / steps, s = std::sin(half);
    return {{0.36 * s, 0.48 * s, 0.8 * s, std::cos(half)}, {distance, 0.1, 0.05}};
}

void run_pairs(FILE *csv, const Mesh &mesh, pir_trimesh *surface, uint32_t frames) {
    struct Place {
        const char *name;
        double distance;
    };
#ifdef PIR_HAVE_FCL
    const auto fcl = make_fcl_meshes(mesh, mesh);
#endif
    for (const Place place : {Place{"near", 2.1}, Place{"apart", 3.0}})
        for (const uint32_t steps : {50u, 500u, 5000u}) {
            pir_trimesh_pair *pair = nullptr;
            check(pir_trimesh_pair_create(surface, surface, nullptr, &pair));
            Times ours, theirs;
            double first = 0;
            uint32_t wrong = 0, meeting = 0;
            for (uint32_t frame = 0; frame < frames; frame++) {
                const pir_pose p = pose_at(frame, steps, place.distance), q = pir_pose_identity();
                pir_trimesh_distance answer;
                double start = now_us();
                check(pir_trimesh_pair_nearest(pair, p, q, &answer));
                const double took = now_us() - start;
                if (frame == 0)
                    first = took;
                else
                    ours.us.push_back(took);
                meeting += answer.state == PIR_TRIMESH_MEET;
#ifdef PIR_HAVE_FCL
                start = now_us();
                const double distance = fcl->distance(p, q);
                theirs.us.push_back(now_us() - start);
                wrong += answer.state != PIR_TRIMESH_MEET && std::fabs(distance - answer.distance) > 1e-9;
#endif
            }
            const pir_trimesh_pair_statistics s = pir_trimesh_pair_get_statistics(pair);
            const double n = frames;
            std::fprintf(csv, "%zu,%s,%u,%u,%u,%.1f,%.2f,%.2f,%.2f,%.2f,%.2f,%.2f,%.1f,%.1f,%.1f,%llu,%zu,%u\n",
                         mesh.corners.size() / 3, place.name, steps, frames, meeting, first, ours.at(0.5), ours.mean(),
                         ours.at(0.99), ours.at(1), theirs.at(0.5), theirs.mean(), (double)s.expired / n,
                         (double)s.bounds / n, (double)s.triangles / n, (unsigned long long)s.front, s.bytes, wrong);
            std::printf(
                "%6zu %-5s 1/%-4u first %7.1f  median %7.2f  mean %7.2f  p99 %7.1f  fcl %7.1f %7.1f  expired %.0f "
                "bounds %.0f triangles %.0f front %llu rebuilt %llu exact %llu wrong %u meet %u\n",
                mesh.corners.size() / 3, place.name, steps, first, ours.at(0.5), ours.mean(), ours.at(0.99),
                theirs.at(0.5), theirs.mean(), (double)s.expired / n, (double)s.bounds / n, (double)s.triangles / n,
                (unsigned long long)s.front, (unsigned long long)s.rebuilt, (unsigned long long)s.exact, wrong,
                meeting);
            std::fflush(stdout);
            pir_trimesh_pair_destroy(pair);
        }
}

bool holds(const std::vector<uint32_t> &rising, uint32_t number) {
    return std::binary_search(rising.begin(), rising.end(), number);
}

void run_octrees(FILE *csv, const Mesh &mesh, pir_trimesh *surface, int depth, uint32_t poses) {
    const Octree tree(mesh, depth);
    Times theirs, ours;
    double left = 0, sums = 0;
    uint32_t missed = 0;
    const double triangles = (double)mesh.corners.size() / 3;
    for (uint32_t i = 0; i < poses; i++) {
        const pir_pose p = pose_at(7 * i + 1, 500, i % 2 == 0 ? 2.1 : 3.0), q = pir_pose_identity();
        double start = now_us();
        const Candidates found = closest_candidates(tree, tree, p, q);
        theirs.us.push_back(now_us() - start);
        start = now_us();
        pir_trimesh_pair *pair = nullptr;
        pir_trimesh_distance answer;
        check(pir_trimesh_pair_create(surface, surface, nullptr, &pair));
        check(pir_trimesh_pair_nearest(pair, p, q, &answer));
        ours.us.push_back(now_us() - start);
        pir_trimesh_pair_destroy(pair);
        left += (double)(found.of_p.size() + found.of_q.size()) / (2 * triangles);
        sums += (double)found.sums;
        missed += !holds(found.of_p, answer.triangle_p) || !holds(found.of_q, answer.triangle_q);
    }
    std::fprintf(csv, "%.0f,%d,%zu,%u,%.0f,%.4f,%.0f,%.1f,%.1f,%u\n", triangles, depth, tree.leaves(), poses,
                 left / poses * triangles, 100 * (1 - left / poses), sums / poses, theirs.at(0.5), ours.at(0.5),
                 missed);
    std::printf(
        "octrees of depth %d, %zu cubes: %.0f triangles of %.0f left, %.2f %% culled, %.0f sums, %.0f us; a new "
        "pair %.0f us; missed %u\n",
        depth, tree.leaves(), left / poses * triangles, triangles, 100 * (1 - left / poses), sums / poses,
        theirs.at(0.5), ours.at(0.5), missed);
}

void run_surface(FILE *csv, const Mesh &mesh, uint32_t count) {
    const double start = now_us();
    pir_trimesh *surface = make(mesh);
    const double built = now_us() - start;
    pir_trimesh_info info;
    pir_trimesh_describe(surface, &info);
    pir_surface_ref ref{};
    ref.mesh = surface;
    Times rays, points;
    for (uint32_t i = 0; i < count; i++) {
        const double a = 2.399963 * i, z = 1 - 2 * (i + 0.5) / count, r = std::sqrt(1 - z * z);
        const pir_vec3 from = {3 * r * std::cos(a), 3 * r * std::sin(a), 3 * z};
        pir_surface_ray ray{};
        ray.origin = from;
        ray.way = {-2 * from.x + 0.3 * from.y, -2 * from.y + 0.3 * from.z, -2 * from.z + 0.3 * from.x};
        pir_ray_hit hit;
        pir_surface_nearest nearest;
        double t = now_us();
        check(pir_surface_ray_nearest(ref, &ray, &hit));
        rays.us.push_back(now_us() - t);
        t = now_us();
        check(pir_surface_nearest_point(ref, {0.5 * from.x, 0.5 * from.y, 0.5 * from.z}, HUGE_VAL, &nearest));
        points.us.push_back(now_us() - t);
    }
    std::fprintf(csv, "%u,%.2f,%.2f,%.3f,%.3f,%.3f,%.3f\n", info.triangles, built / 1000,
                 (double)info.tree_bytes / info.triangles, rays.at(0.5), rays.mean(), points.at(0.5), points.mean());
    std::printf("%6u built in %.2f ms, tree %.2f bytes a triangle, ray %.3f us, nearest point %.3f us\n",
                info.triangles, built / 1000, (double)info.tree_bytes / info.triangles, rays.at(0.5), points.at(0.5));
    pir_trimesh_release(surface);
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: bench_mesh FOLDER\n");
        return 2;
    }
    const results where = results_new(argv[1]);
    std::printf("%s\n", where.machine);
    const bool smoke = results_count(1000) < 1000;
    FILE *csv = results_open(&where, "mesh_surfaces.csv");
    std::fprintf(csv, "triangles,build_ms,tree_bytes_a_triangle,ray_us,ray_mean_us,nearest_us,nearest_mean_us\n");
    for (int level = 4; level <= (smoke ? 4 : 8); level++)
        run_surface(csv, bumpy_sphere(level), results_count(20000));
    results_close(csv, "mesh_surfaces.csv");
    csv = results_open(&where, "mesh_octrees.csv");
    std::fprintf(csv, "triangles,depth,cubes,poses,left,culled_percent,sums,octrees_us,pair_us,missed\n");
    const Mesh geodesic = bumpy_geodesic();
    pir_trimesh *of_geodesic = make(geodesic);
    for (int depth = 3; depth <= (smoke ? 3 : 7); depth++)
        run_octrees(csv, geodesic, of_geodesic, depth, results_count(100));
    pir_trimesh_release(of_geodesic);
    results_close(csv, "mesh_octrees.csv");
    csv = results_open(&where, "mesh_pairs.csv");
    std::fprintf(csv, "triangles,place,steps,frames,meeting,first_us,median_us,mean_us,p99_us,max_us,fcl_median_us,"
                      "fcl_mean_us,expired,bounds,triangle_pairs,front,bytes,fcl_wrong\n");
    for (int level = 4; level <= (smoke ? 4 : 6); level++) {
        const Mesh mesh = bumpy_sphere(level);
        pir_trimesh *surface = make(mesh);
        run_pairs(csv, mesh, surface, results_count(1000));
        pir_trimesh_release(surface);
    }
    results_close(csv, "mesh_pairs.csv");
    return 0;
}
