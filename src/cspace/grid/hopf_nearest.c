/* SPDX-License-Identifier: MIT */
/*
 * The nearest rotations of the Hopf grid.
 *
 * Within an angle B of a rotation lie only rotations over points within B of its own point, because the Hopf map
 * lengthens no way. So the pixels with centres in that cap are looked at, circle of latitude by circle; on the circle
 * of each, the rotations outward from the nearest. What is found is complete when the last of the nearest is within B;
 * otherwise B grows. While rotations are found it shrinks to the last of as
 * many as are sought. The cap is taken a little wide, so that rounding leaves out nothing.
 */
#include <math.h>

#include "cspace/grid/circle.h"

/* By how much cosines may err here, many times over. */
#define WIDE 1e-9

/* The cap about a rotation's point, and what is sought. */
struct cap {
    const pir_hopf *hopf;
    pir_quat unit;
    double z, across, turn_part; /* of the point: sine and cosine of its latitude, longitude in full turns */
    double cos, sin, half_cos;   /* of B, and of half of it */
    pir_near *near;
};

/* Makes B as small as what has been found allows. */
static void shrink(struct cap *cap) {
    const double least = pir_near_least(cap->near);
    if (least <= cap->half_cos)
        return;
    cap->half_cos = least;
    cap->cos = 2 * least * least - 1;
}

/* Offers the rotations over a pixel that are within B, outward from the nearest. */
static void offer_pixel(struct cap *cap, pir_pixel pixel) {
    const uint32_t around = cap->hopf->around;
    pir_circle circle = pir_circle_of(cap->hopf->level, pixel);
    pir_circle_point product = pir_circle_product(&circle, cap->unit);
    double most = sqrt(product.cos * product.cos + product.sin * product.sin);
    if (most + WIDE < cap->half_cos || most + WIDE < pir_near_least(cap->near))
        return;
    uint32_t nearest = pir_circle_nearest(product, around);
    for (uint32_t away = 0; 2 * away <= around; away++) {
        // none that is farther is closer than this: the nearest is within half a step
        double bound = away == 0 ? most : most * pir_circle_at(2 * away - 1, 4 * (uint64_t)around).cos;
        if (bound + WIDE < cap->half_cos || bound + WIDE < pir_near_least(cap->near))
            return;
        for (uint32_t side = 0; side < 2 && (side == 0 || (away > 0 && 2 * away < around)); side++) {
            uint32_t k = (nearest + (side ? around - away : away)) % around;
            double close = fabs(pir_quat_dot(cap->unit, pir_circle_rotation(&circle, around, k)));
            if (close < pir_near_least(cap->near))
                continue;
            pir_near_offer(cap->near, close,
                           pir_hopf_number(cap->hopf, pir_pixel_path_rank(cap->hopf->level, pixel), k));
            shrink(cap);
        }
    }
}

/* Offers the pixels of the circle of latitude Y that lie in the cap. */
static void offer_latitude(struct cap *cap, int32_t y) {
    const uint32_t level = cap->hopf->level, count = pir_pixel_circle_count(level, y);
    double z = pir_pixel_z_of(level, y), across = sqrt(1 - z * z) * cap->across;
    double cosine = (cap->cos - WIDE - cap->z * z) / fmax(across, WIDE);
    if (cosine >= 1)
        return;
    // the longitudes in the cap, half of them to either side of the point's: arcsin x ≤ x + (π/2 − 1)x³
    double x = sqrt(0.5 * (1 - fmax(cosine, -1))), half = 2 / PIR_FULL_TURN * (x + 0.5708 * x * x * x) + WIDE;
    double first = 0.5 * pir_pixel_circle_first(level, y);
    double from = ceil((cap->turn_part - half) * count - first), to = floor((cap->turn_part + half) * count - first);
    if (half >= 0.5 || to - from + 1 >= count) {
        from = 0;
        to = count - 1.0;
    }
    for (double k = from; k <= to; k++) {
        double wrapped = k < 0 ? k + count : k >= count ? k - count : k;
        offer_pixel(cap, pir_pixel_on_circle(level, y, (uint32_t)wrapped));
    }
}

static void offer_cap(struct cap *cap) {
    const uint32_t level = cap->hopf->level;
    const int32_t last = ((int32_t)2 << level) - 1;
    // the sines of the latitudes B away to the north and to the south, or the poles
    double north = cap->z >= cap->cos ? 1 : cap->z * cap->cos + cap->across * cap->sin;
    double south = cap->z <= -cap->cos ? -1 : cap->z * cap->cos - cap->across * cap->sin;
    double high = ceil(pir_pixel_y_of(level, fmin(north + WIDE, 1)));
    double low = floor(pir_pixel_y_of(level, fmax(south - WIDE, -1)));
    int32_t to = high > last ? last : (int32_t)high, from = low < -last ? -last : (int32_t)low;
    // from the middle on, where the nearest is likely to be: it rules out the others
    const int32_t middle = from + (to - from) / 2;
    for (int32_t y = middle; y <= to; y++)
        offer_latitude(cap, y);
    for (int32_t y = middle - 1; y >= from; y--)
        offer_latitude(cap, y);
}

void pir_hopf_nearest(const pir_hopf *hopf, pir_quat unit, pir_near *near) {
    // conj(a)·b has the longitude of the point
    double real = unit.w * unit.y + unit.x * unit.z, imaginary = unit.w * unit.z - unit.x * unit.y;
    double z = unit.w * unit.w + unit.x * unit.x - unit.y * unit.y - unit.z * unit.z;
    z = fmax(-1, fmin(1, z));
    struct cap cap = {hopf, unit, z, sqrt(1 - z * z), pir_turn_part(real, imaginary), 0, 0, 0, near};
    // B in eighths of the spacing: at first as much as one nearest rotation, and more of them, need
    uint64_t eighths = 7, half_turn = 4 * (uint64_t)hopf->around;
    for (size_t room = 1; room < near->capacity; room *= 8)
        eighths *= 2;
    for (;; eighths += eighths / 2) {
        if (eighths > half_turn)
            eighths = half_turn;
        if (eighths == 7) {
            cap.cos = hopf->first_cap[0];
            cap.sin = hopf->first_cap[1];
            cap.half_cos = hopf->first_cap[2];
        } else {
            pir_circle_point b = pir_circle_at(eighths, 2 * half_turn);
            cap.cos = b.cos;
            cap.sin = b.sin;
            cap.half_cos = pir_circle_at(eighths, 4 * half_turn).cos;
        }
        near->count = 0;
        offer_cap(&cap);
        if (eighths == half_turn || (near->count == near->capacity && pir_near_least(near) >= cap.half_cos))
            return;
    }
}
