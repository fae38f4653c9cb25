/* SPDX-License-Identifier: MIT */
/* The scalar reference of the kernels of regions: what a sweep finds, and where descents start. */
#include "dymsum/kernels/kernels.h"

/* Lists those of eight numbers whose bits are set, without branches: none is foreseen. */
static inline uint32_t list_lanes(uint32_t lanes, const uint32_t *number, uint32_t *ret_number) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < PIR_LANES; i++) {
        ret_number[count] = number[i];
        count += lanes >> i & 1;
    }
    return count;
}

uint32_t pir_list_caps(const pir_caps *caps, const pir_sight *sight, uint32_t *ret_which) {
    uint32_t found = 0;
    for (uint32_t b = 0; b * PIR_LANES < caps->count; b++) {
        uint32_t near = 0, number[PIR_LANES];
        for (uint32_t i = 0; i < PIR_LANES; i++) {
            uint32_t k = number[i] = b * PIR_LANES + i;
            float c = caps->cosine[k], s = caps->sine[k];
            float beyond = (caps->x[k] * sight->x + caps->y[k] * sight->y + caps->z[k] * sight->z) -
                           (sight->cosine * c - sight->sine * s);
            float past = -(sight->sine * c + sight->cosine * s);
            // a reach beyond π includes all
            near |= (uint32_t)((beyond > past ? beyond : past) + sight->slack >= 0) << i;
        }
        found += list_lanes(near & pir_lanes_used(caps->count, b), number, ret_which + found);
    }
    return found;
}

uint32_t pir_list_points(const pir_clustered *points, const pir_sight *sight, uint32_t *ret_item) {
    uint32_t found = 0;
    for (uint32_t j = 0; j < points->clusters; j++) {
        uint32_t k = points->cluster[j], near = 0;
        const float *x = points->row + (size_t)k * PIR_POINT_ROWS * PIR_LANES, *y = x + PIR_LANES, *z = y + PIR_LANES;
        for (uint32_t i = 0; i < PIR_LANES; i++) {
            float by = (x[i] * sight->x + y[i] * sight->y + z[i] * sight->z) - sight->cosine + sight->slack;
            near |= (uint32_t)(by >= 0) << i;
        }
        found +=
            list_lanes(near & pir_lanes_used(points->count, k), points->item + (size_t)k * PIR_LANES, ret_item + found);
    }
    return found;
}

uint32_t pir_list_arcs(const pir_clustered *arcs, const pir_sight *sight, uint32_t *at, uint32_t *ret_item) {
    uint32_t found = 0;
    for (; *at < arcs->clusters; ++*at) {
        uint32_t k = arcs->cluster[*at], used = pir_lanes_used(arcs->count, k), near = 0, unsure = 0;
        const float *row = arcs->row + (size_t)k * PIR_ARC_ROWS * PIR_LANES;
        for (uint32_t i = 0; i < PIR_LANES; i++) {
            float n[PIR_ARC_ROWS];
            for (uint32_t r = 0; r < PIR_ARC_ROWS; r++)
                n[r] = row[r * PIR_LANES + i];
            const float *from = n + PIR_ARC_FROM, *to = n + PIR_ARC_TO, *along = n + PIR_ARC_ALONG;
            float x = from[0] * sight->x + from[1] * sight->y + from[2] * sight->z;
            float y = to[0] * sight->x + to[1] * sight->y + to[2] * sight->z;
            float d = along[0] * sight->x + along[1] * sight->y + along[2] * sight->z;
            float c = n[PIR_ARC_COSINE], one = x - c * y, other = y - c * x;
            float foot = one < other ? one : other, beside = sight->sine - fabsf(d);
            float end = (x > y ? x : y) - sight->cosine, passing = foot < beside ? foot : beside;
            float by = end > passing ? end : passing;
            near |= (uint32_t)(by >= -sight->slack) << i;
            unsure |= (uint32_t)(fabsf(by) <= sight->slack) << i;
        }
        if (unsure & used)
            return found;
        found += list_lanes(near & used, arcs->item + (size_t)k * PIR_LANES, ret_item + found);
    }
    return found;
}

/* The coordinate, from 0, of the square that x is in, from −1 to 1. */
static inline uint32_t along(float x, uint32_t side) {
    uint32_t i = (uint32_t)((x + 1) * (0.5f * (float)side));
    return i < side ? i : side - 1;
}

/* The square of a unit vector: the octahedron's lower half is unfolded around the upper one. */
static inline uint32_t square_of(uint32_t side, float x, float y, float z) {
    float scale = 1 / (fabsf(x) + fabsf(y) + fabsf(z)), u = x * scale, v = y * scale;
    float over_u = copysignf(1 - fabsf(v), u), over_v = copysignf(1 - fabsf(u), v);
    return along(z < 0 ? over_v : v, side) * side + along(z < 0 ? over_u : u, side);
}

void pir_find_starts(const pir_facets *facets, const pir_starts *starts, const uint32_t *facet, uint32_t count,
                     uint32_t *ret_from) {
    const float(*t)[8] = facets->turn;
    for (uint32_t i = 0; i < count; i++) {
        const float *n = facets->normal + (size_t)4 * facet[i];
        float turned[3];
        for (int k = 0; k < 3; k++)
            turned[k] = t[0][k] * n[0] + t[1][k] * n[1] + t[2][k] * n[2];
        ret_from[i] = starts->cell[square_of(starts->side, turned[0], turned[1], turned[2])];
    }
}
