// SPDX-License-Identifier: MIT
// Ours by a tracked sum: with a tolerance, with coordinates of all vertices in each frame, with a region.
#include <cstdio>

#include "trade.hpp"

namespace {

std::string text(double x) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%g", x);
    return buffer;
}

// A sum with a query, made anew for each run.
class Sum : public Way {
  public:
    Sum(const TradePair &pair, std::string family, std::string setting)
        : Way(std::move(family), std::move(setting)), pair_(pair) {
    }
    ~Sum() override {
        clear();
    }
    void restart() override {
        clear();
        pir_sum_options options = pir_sum_options_default();
        options.difference = true;
        trade_check(pir_sum_create(pair_.p, pair_.q, pair_.poses[0].r, &options, &sum_));
        trade_check(pir_query_create(sum_, &query_));
        cache_ = {};
        begin();
    }
    std::vector<pir_vec3> kept() override {
        pir_mesh *mesh;
        trade_check(pir_sum_mesh(sum_, PIR_DOUBLE, &mesh));
        const pir_vec3 *vertex = pir_mesh_vertices(mesh);
        std::vector<pir_vec3> points(vertex, vertex + pir_mesh_vertex_count(mesh));
        pir_mesh_destroy(mesh);
        return points;
    }

  protected:
    virtual void begin() {
    }
    double ask(const Pose &pose) {
        pir_query_input input = pir_query_input_default();
        pir_query_result result;
        input.translation = pose.t;
        trade_check(pir_query_signed_distance(query_, &input, &cache_, &result));
        return result.distance;
    }

    const TradePair &pair_;
    pir_sum *sum_ = nullptr;
    pir_query *query_ = nullptr;
    pir_query_cache cache_ = {};

  private:
    void clear() {
        pir_query_destroy(query_);
        pir_sum_destroy(sum_);
        query_ = nullptr;
        sum_ = nullptr;
    }
};

class Tolerance : public Sum {
  public:
    Tolerance(const TradePair &pair, double tolerance)
        : Sum(pair, "tolerance", text(tolerance)), tolerance_(tolerance * pair.size) {
    }
    double frame(const Pose &pose) override {
        trade_check(pir_sum_rotate(sum_, pose.r, PIR_METHOD_AUTO));
        return ask(pose);
    }

  protected:
    void begin() override {
        trade_check(pir_sum_set_tolerance(sum_, tolerance_));
    }

  private:
    double tolerance_;
};

enum class Digits { FLOAT, DOUBLE, EXACT };

// All vertices in each frame, for whoever draws or writes the sum; no depth.
class Coordinates : public Sum {
  public:
    Coordinates(const TradePair &pair, Digits digits)
        : Sum(pair, "coordinates",
              digits == Digits::FLOAT    ? "float"
              : digits == Digits::DOUBLE ? "double"
                                         : "exact"),
          digits_(digits) {
    }
    ~Coordinates() override {
        pir_live_mesh_destroy(live_);
    }
    double frame(const Pose &pose) override {
        trade_check(pir_sum_rotate(sum_, pose.r, PIR_METHOD_AUTO));
        if (digits_ == Digits::EXACT) {
            pir_mesh *mesh;
            trade_check(pir_sum_mesh(sum_, PIR_EXACT, &mesh));
            pir_mesh_destroy(mesh);
            return NAN;
        }
        trade_check(pir_live_mesh_refresh(live_));
        size_t slots = pir_live_mesh_vertex_slots(live_);
        if (digits_ == Digits::DOUBLE) {
            doubles_.resize(slots);
            pir_live_mesh_vertices(live_, doubles_.data());
        } else {
            floats_.resize(3 * slots);
            pir_live_mesh_vertices_float(live_, reinterpret_cast<float(*)[3]>(floats_.data()));
        }
        return NAN;
    }
    std::vector<pir_vec3> kept() override {
        std::vector<pir_vec3> points;
        if (digits_ == Digits::EXACT)
            return Sum::kept();
        for (uint32_t v = 0; v < pir_live_mesh_vertex_slots(live_); v++) {
            uint32_t named[2];
            if (!pir_live_mesh_vertex_pair(live_, v, named))
                continue;
            const float *at = digits_ == Digits::FLOAT ? &floats_[3 * v] : nullptr;
            points.push_back(at ? pir_vec3{at[0], at[1], at[2]} : doubles_[v]);
        }
        return points;
    }

  protected:
    void begin() override {
        pir_live_mesh_destroy(live_);
        live_ = nullptr;
        trade_check(pir_live_mesh_create(sum_, &live_));
    }

  private:
    Digits digits_;
    pir_live_mesh *live_ = nullptr;
    std::vector<pir_vec3> doubles_;
    std::vector<float> floats_;
};

// A cone about the way out that the frame before has found.
class Region : public Sum {
  public:
    Region(const TradePair &pair, double degrees)
        : Sum(pair, "region", text(degrees)), half_angle_(degrees * 3.14159265358979323846 / 180) {
    }
    double frame(const Pose &pose) override {
        pir_query_input input = pir_query_input_default();
        pir_query_result result;
        input.translation = pose.t;
        trade_check(pir_sum_set_region(sum_, axis_, half_angle_));
        trade_check(pir_sum_rotate(sum_, pose.r, PIR_METHOD_AUTO));
        trade_check(pir_query_penetration(query_, &input, &cache_, &result));
        bool found = result.outcome == PIR_OVERLAPPING || result.outcome == PIR_NOT_SEPARATED;
        if (found)
            axis_ = result.normal;
        return found ? result.distance : NAN;
    }
    std::vector<pir_vec3> kept() override {
        return {};
    }

  protected:
    void begin() override {
        pir_query_input input = pir_query_input_default();
        pir_query_result result;
        input.translation = pair_.poses[0].t;
        trade_check(pir_query_penetration(query_, &input, &cache_, &result));
        axis_ = result.normal;
    }

  private:
    double half_angle_;
    pir_vec3 axis_ = {0, 0, 1};
};

} // namespace

void add_sums(const TradePair &pair, Ways *ret_ways) {
    for (double tolerance : {0.0, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1})
        ret_ways->push_back(std::make_unique<Tolerance>(pair, tolerance));
    for (double degrees : {180.0, 90.0, 60.0, 30.0, 20.0, 10.0})
        ret_ways->push_back(std::make_unique<Region>(pair, degrees));
    for (Digits digits : {Digits::FLOAT, Digits::DOUBLE, Digits::EXACT})
        ret_ways->push_back(std::make_unique<Coordinates>(pair, digits));
}
