/* SPDX-License-Identifier: MIT */
/* When a tracked sum pays, from measured costs. */
#include <math.h>

#include <pirouette/baseline.h>

double pir_query_break_even(double cost_rotation, double cost_query, double cost_stateless) {
    if (!(cost_rotation >= 0 && cost_query >= 0 && cost_stateless >= 0))
        return NAN;
    // n · stateless ≥ rotation + n · query
    double saved = cost_stateless - cost_query;
    if (cost_rotation == 0 && saved >= 0)
        return 0;
    return saved > 0 ? ceil(cost_rotation / saved) : HUGE_VAL;
}
