// SPDX-License-Identifier: MIT
#include "pair_poses.hpp"

#include <cmath>
#include <cstdlib>

namespace {

const double PI = 3.14159265358979323846;

pir_quat product(pir_quat a, pir_quat b) {
    return {a.w * b.x + b.w * a.x + a.y * b.z - a.z * b.y, a.w * b.y + b.w * a.y + a.z * b.x - a.x * b.z,
            a.w * b.z + b.w * a.z + a.x * b.y - a.y * b.x, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

pir_quat normal(pir_quat q) {
    double by = 1 / std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return {q.x * by, q.y * by, q.z * by, q.w * by};
}

pir_quat turn(pir_vec3 axis, double angle) {
    double s = std::sin(angle / 2);
    return {axis.x * s, axis.y * s, axis.z * s, std::cos(angle / 2)};
}

// How far P may come along −direction from far out.
class Contact {
  public:
    Contact(pir_polytope *p, pir_polytope *q) {
        pir_sum_options options = pir_sum_options_default();
        options.difference = true;
        if (pir_sum_create(p, q, {0, 0, 0, 1}, &options, &sum_) != PIR_OK || pir_query_create(sum_, &query_) != PIR_OK)
            std::exit(2);
        far_ = 4 * (size_of(p) + size_of(q));
    }
    ~Contact() {
        pir_query_destroy(query_);
        pir_sum_destroy(sum_);
    }
    // The distance of P along the direction where it touches.
    double along(pir_quat r, pir_vec3 d) {
        pir_sum_rotate(sum_, r, PIR_METHOD_AUTO);
        pir_query_input input = pir_query_input_default();
        input.translation = {far_ * d.x, far_ * d.y, far_ * d.z};
        pir_query_result result;
        pir_query_directional_distance(query_, &input, {-d.x, -d.y, -d.z}, &result);
        return far_ - result.distance;
    }

  private:
    pir_sum *sum_ = nullptr;
    pir_query *query_ = nullptr;
    double far_ = 0;
};

pir_vec3 unit(pir_vec3 v) {
    double by = 1 / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return {v.x * by, v.y * by, v.z * by};
}

pir_vec3 turned(pir_quat r, pir_vec3 v) {
    pir_quat t = product(product(r, {v.x, v.y, v.z, 0}), {-r.x, -r.y, -r.z, r.w});
    return {t.x, t.y, t.z};
}

// Along a direction that drifts, P turning: at `away` of the way to contact, and `swing` of the diameter about it.
std::vector<Pose> drifting(pir_polytope *p, pir_polytope *q, int count, int steps, double away, double swing) {
    Random random;
    Contact contact(p, q);
    std::vector<Pose> poses;
    double diameter = size_of(p) + size_of(q), step = 2 * PI / steps;
    pir_quat r{0.1, 0.2, 0.3, 0.9};
    pir_vec3 axis = random.direction(), d = random.direction(), way = random.direction();
    for (int i = 0; i < count; i++) {
        if (i % 50 == 0) {
            axis = random.direction();
            way = random.direction();
        }
        r = normal(product(turn(axis, step), r));
        double drift = 0.5 * step;
        d = unit({d.x + drift * way.x, d.y + drift * way.y, d.z + drift * way.z});
        double at = away * contact.along(r, d) + swing * diameter * std::sin(2 * PI * i / 200);
        poses.push_back({r, {at * d.x, at * d.y, at * d.z}});
    }
    return poses;
}

} // namespace

std::vector<Pose> hovering(pir_polytope *p, pir_polytope *q, int count, int steps) {
    return drifting(p, q, count, steps, 1, 0.05);
}

std::vector<Pose> away_from_contact(pir_polytope *p, pir_polytope *q, int count, int steps, double away) {
    return drifting(p, q, count, steps, 1 + away, 0);
}

std::vector<Pose> teleports(const std::vector<Pose> &poses) {
    std::vector<Pose> order;
    // a prime that divides no usual count
    for (size_t i = 0; i < poses.size(); i++)
        order.push_back(poses[i * 1009 % poses.size()]);
    return order;
}

std::vector<Place> q_stands(const std::vector<Pose> &poses) {
    std::vector<Place> places;
    for (const Pose &pose : poses)
        places.push_back({pose, {{0, 0, 0, 1}, {0, 0, 0}}, pose});
    return places;
}

std::vector<Place> both_move(const std::vector<Pose> &poses, int steps) {
    Random random;
    std::vector<Place> places;
    pir_quat r{0.3, -0.1, 0.2, 0.9};
    pir_vec3 axis{0, 0, 1}, way{1, 0, 0}, at{0, 0, 0};
    for (size_t i = 0; i < poses.size(); i++) {
        if (i % 50 == 0) {
            axis = random.direction();
            way = random.direction();
        }
        r = normal(product(turn(axis, 2 * PI / steps), r));
        at = {at.x + 0.01 * way.x, at.y + 0.01 * way.y, at.z + 0.01 * way.z};
        pir_vec3 t = turned(r, poses[i].t);
        places.push_back({{normal(product(r, poses[i].r)), {at.x + t.x, at.y + t.y, at.z + t.z}}, {r, at}, poses[i]});
    }
    return places;
}

std::vector<Pose> spinning(pir_polytope *p, pir_polytope *q, int count, int steps, double depth) {
    std::vector<Pose> poses;
    pir_vec3 low, high, from, to;
    pir_polytope_bounds(p, &low, &high);
    pir_polytope_bounds(q, &from, &to);
    for (int i = 0; i < count; i++) {
        double angle = 2 * PI * i / steps;
        poses.push_back({turn({0, 0, 1}, angle), {0.1 * (to.x - from.x), 0.05, to.z - low.z - depth}});
    }
    return poses;
}

std::vector<Pose> aligned(pir_polytope *p, pir_polytope *q, int count, double away) {
    Random random;
    Contact contact(p, q);
    std::vector<Pose> poses;
    pir_vec3 d = random.direction(), way = random.direction();
    for (int i = 0; i < count; i++) {
        if (i % 50 == 0)
            way = random.direction();
        d = unit({d.x + 0.01 * way.x, d.y + 0.01 * way.y, d.z + 0.01 * way.z});
        double at = away * contact.along({0, 0, 0, 1}, d);
        poses.push_back({{0, 0, 0, 1}, {at * d.x, at * d.y, at * d.z}});
    }
    return poses;
}

pir_polytope *sphere_points(int count) {
    Random random;
    std::vector<pir_vec3> points;
    for (int i = 0; i < count; i++)
        points.push_back(random.direction());
    return from_points(points);
}

pir_polytope *sliver_points(int count) {
    Random random;
    std::vector<pir_vec3> points;
    for (int i = 0; i < count / 2; i++) {
        double angle = 4 * PI * i / count, bend = 0.01 * random.unit();
        pir_vec3 at{std::cos(angle), std::sin(angle), bend}, beside = random.direction();
        points.push_back(at);
        points.push_back({at.x + 1e-4 * beside.x, at.y + 1e-4 * beside.y, at.z + 1e-4 * beside.z});
    }
    return from_points(points);
}
