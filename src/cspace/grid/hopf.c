/* SPDX-License-Identifier: MIT */
/* The grid of hopf.h: its rotations and the order of visiting. */
#include "cspace/grid/hopf.h"

#include <math.h>

#include "base/memory.h"
#include "cspace/grid/angle.h"
#include "cspace/grid/circle.h"

/* A circle without the point of φ, which its rotations do not need. */
static pir_circle rotations_over(uint32_t level, pir_pixel pixel) {
    pir_pixel_centre centre = pir_pixel_centre_of(level, pixel);
    return (pir_circle){sqrt(centre.upper), sqrt(centre.lower), centre.num, centre.den, {0, 0}};
}

pir_circle pir_circle_of(uint32_t level, pir_pixel pixel) {
    pir_circle circle = rotations_over(level, pixel);
    circle.phi = pir_circle_at(circle.num, circle.den);
    return circle;
}

pir_quat pir_circle_rotation(const pir_circle *circle, uint32_t around, uint32_t k) {
    // ψ/2 is (2k + 1)/4m of a full turn
    uint64_t den = 4 * (uint64_t)around, num = 2 * (uint64_t)k + 1;
    pir_circle_point a = pir_circle_at(num, den);
    pir_circle_point b = pir_circle_at(num * circle->den + circle->num * den, den * circle->den);
    return (pir_quat){circle->upper * a.sin, circle->lower * b.cos, circle->lower * b.sin, circle->upper * a.cos};
}

pir_circle_point pir_circle_product(const pir_circle *circle, pir_quat unit) {
    // a·cos(θ/2) + b·sin(θ/2)·e^{−iφ}
    double c = circle->lower * circle->phi.cos, s = circle->lower * circle->phi.sin;
    return (pir_circle_point){unit.w * circle->upper + unit.y * c + unit.z * s,
                              unit.x * circle->upper + unit.z * c - unit.y * s};
}

uint32_t pir_circle_nearest(pir_circle_point product, uint32_t around) {
    double part = 2 * pir_turn_part(product.cos, product.sin);
    uint32_t k = (uint32_t)((part < 1 ? part : part - 1) * around);
    return k < around ? k : around - 1;
}

/* --- the order of visiting --- */

static uint32_t first_of(uint32_t run) {
    return run >> 1;
}

static bool falls(uint32_t run) {
    return run & 1;
}

/* Number `step` of a run on the circle, and back. */
static uint32_t on_circle(const pir_hopf *hopf, uint32_t run, uint32_t step) {
    uint32_t from = first_of(run) + (falls(run) ? hopf->around - step : step);
    return from < hopf->around ? from : from - hopf->around;
}

static uint32_t step_of(const pir_hopf *hopf, uint32_t run, uint32_t k) {
    uint32_t past = falls(run) ? first_of(run) - k : k - first_of(run);
    return past < hopf->around ? past : past + hopf->around;
}

/* The last rotation of a run, the number on the next circle nearest to it, and how close they are. */
static double close_to_next(const pir_hopf *hopf, uint32_t run, const pir_circle circle[2], uint32_t *ret_next) {
    pir_quat last = pir_circle_rotation(&circle[0], hopf->around, on_circle(hopf, run, hopf->around - 1));
    *ret_next = pir_circle_nearest(pir_circle_product(&circle[1], last), hopf->around);
    return fabs(pir_quat_dot(last, pir_circle_rotation(&circle[1], hopf->around, *ret_next)));
}

bool pir_hopf_init(pir_hopf *hopf, uint32_t level, const pir_allocator *allocator) {
    *hopf = (pir_hopf){level, (uint32_t)6 << level, (uint32_t)12 << (2 * level), {0, 0, 0}, NULL};
    const uint64_t eighths = 8 * (uint64_t)hopf->around;
    const pir_circle_point cap = pir_circle_at(7, eighths);
    hopf->first_cap[0] = cap.cos;
    hopf->first_cap[1] = cap.sin;
    hopf->first_cap[2] = pir_circle_at(7, 2 * eighths).cos;
    hopf->run = PIR_NEW(allocator, uint32_t, hopf->pixels);
    if (!hopf->run)
        return false;
    pir_circle circle[2] = {pir_circle_of(level, pir_pixel_path_at(level, 0))};
    uint32_t first = 0;
    for (uint32_t rank = 0; rank + 1 < hopf->pixels; rank++) {
        uint32_t rising, falling;
        circle[1] = pir_circle_of(level, pir_pixel_path_at(level, rank + 1));
        double by_rising = close_to_next(hopf, 2 * first, circle, &rising);
        bool fall = close_to_next(hopf, 2 * first + 1, circle, &falling) > by_rising;
        hopf->run[rank] = 2 * first + fall;
        first = fall ? falling : rising;
        circle[0] = circle[1];
    }
    hopf->run[hopf->pixels - 1] = 2 * first;
    return true;
}

void pir_hopf_finish(pir_hopf *hopf, const pir_allocator *allocator) {
    PIR_FREE(allocator, hopf->run, hopf->pixels);
}

pir_quat pir_hopf_rotation(const pir_hopf *hopf, uint64_t number) {
    uint32_t rank = (uint32_t)(number / hopf->around), step = (uint32_t)(number % hopf->around);
    pir_circle circle = rotations_over(hopf->level, pir_pixel_path_at(hopf->level, rank));
    return pir_circle_rotation(&circle, hopf->around, on_circle(hopf, hopf->run[rank], step));
}

uint64_t pir_hopf_cell(const pir_hopf *hopf, uint64_t number) {
    uint32_t rank = (uint32_t)(number / hopf->around), step = (uint32_t)(number % hopf->around);
    uint64_t nested = pir_pixel_nested(hopf->level, pir_pixel_path_at(hopf->level, rank));
    return nested * hopf->around + on_circle(hopf, hopf->run[rank], step);
}

uint64_t pir_hopf_number(const pir_hopf *hopf, uint32_t rank, uint32_t k) {
    return (uint64_t)rank * hopf->around + step_of(hopf, hopf->run[rank], k);
}
