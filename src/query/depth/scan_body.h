/* SPDX-License-Identifier: MIT */
/* The text of scan.h's loops, one for all processors. */
#include "base/lane_text.h"
#include "query/depth/scan.h"

PIR_LANES_TARGET static void turn(uint32_t count, const pir_mat3 *r, pir_lanes from, pir_lanes to) {
    const pir_mat3 m = *r;
    for (uint32_t i = 0; i < count; i += PIR_WIDTH) {
        pir_lane x = pir_load(from.x + i), y = pir_load(from.y + i), z = pir_load(from.z + i);
        pir_store(to.x + i, m.m[0][0] * x + m.m[0][1] * y + m.m[0][2] * z);
        pir_store(to.y + i, m.m[1][0] * x + m.m[1][1] * y + m.m[1][2] * z);
        pir_store(to.z + i, m.m[2][0] * x + m.m[2][1] * y + m.m[2][2] * z);
    }
}

PIR_LANES_TARGET static void offset(uint32_t count, pir_lanes n, const double *base, pir_lanes p, double *h) {
    for (uint32_t i = 0; i < count; i += PIR_WIDTH)
        pir_store(h + i,
                  pir_load(base + i) + (pir_load(n.x + i) * pir_load(p.x + i) + pir_load(n.y + i) * pir_load(p.y + i) +
                                        pir_load(n.z + i) * pir_load(p.z + i)));
}

PIR_LANES_TARGET static double cross(uint32_t count, pir_lanes d, pir_lanes e, pir_lanes y, pir_lanes n, double *h,
                                     double *err) {
    for (uint32_t i = 0; i < count; i += PIR_WIDTH) {
        pir_lane dx = pir_load(d.x + i), dy = pir_load(d.y + i), dz = pir_load(d.z + i);
        pir_lane ex = pir_load(e.x + i), ey = pir_load(e.y + i), ez = pir_load(e.z + i);
        pir_lane cx = dy * ez - dz * ey, cy = dz * ex - dx * ez, cz = dx * ey - dy * ex;
        pir_lane by = 1.0 / pir_roots(cx * cx + cy * cy + cz * cz);
        cx *= by;
        cy *= by;
        cz *= by;
        pir_store(n.x + i, cx);
        pir_store(n.y + i, cy);
        pir_store(n.z + i, cz);
        pir_store(err + i, by);
        pir_store(h + i, cx * pir_load(y.x + i) + cy * pir_load(y.y + i) + cz * pir_load(y.z + i));
    }
    double most = 0;
    for (uint32_t i = 0; i < count; i++)
        most = err[i] > most ? err[i] : most;
    return most;
}

PIR_LANES_TARGET static void look(uint32_t count, pir_lanes n, const double *h, const double *err, pir_vec3 x,
                                  double error, double ret_least[3]) {
    pir_lane low[2], high[2], along[2];
    for (int k = 0; k < 2; k++)
        low[k] = high[k] = along[k] = pir_all(HUGE_VAL);
    for (uint32_t i = 0; i < count;)
        for (int k = 0; k < 2; k++, i += PIR_WIDTH) {
            pir_lane to = pir_load(n.x + i) * x.x + pir_load(n.y + i) * x.y + pir_load(n.z + i) * x.z;
            pir_lane s = pir_load(h + i) - to, off = error * pir_load(err + i);
            low[k] = pir_lesser_lanes(s - off, low[k]);
            high[k] = pir_lesser_lanes(s + off, high[k]);
            along[k] = pir_lesser_lanes(to, along[k]);
        }
    ret_least[0] = pir_least_of(pir_lesser_lanes(low[0], low[1]));
    ret_least[1] = pir_least_of(pir_lesser_lanes(high[0], high[1]));
    ret_least[2] = pir_least_of(pir_lesser_lanes(along[0], along[1]));
}

PIR_LANES_TARGET static void slacks(uint32_t count, const pir_mat3 *r, pir_lanes from, pir_vec3 x,
                                    const pir_facet_lanes *facets, pir_slack_lanes *slacks) {
    const pir_mat3 m = *r;
    const pir_lanes n = facets->normal, to = slacks->to;
    const double *offset_of = facets->offset;
    double *s = slacks->s;
    pir_lane low = pir_all(HUGE_VAL), along = low;
    for (uint32_t i = 0; i < count; i += PIR_WIDTH) {
        pir_lane fx = pir_load(from.x + i), fy = pir_load(from.y + i), fz = pir_load(from.z + i);
        pir_lane ux = m.m[0][0] * fx + m.m[0][1] * fy + m.m[0][2] * fz - x.x;
        pir_lane uy = m.m[1][0] * fx + m.m[1][1] * fy + m.m[1][2] * fz - x.y;
        pir_lane uz = m.m[2][0] * fx + m.m[2][1] * fy + m.m[2][2] * fz - x.z;
        pir_lane nx = pir_load(n.x + i), ny = pir_load(n.y + i), nz = pir_load(n.z + i);
        pir_lane slack = pir_load(offset_of + i) + (nx * ux + ny * uy + nz * uz);
        pir_store(to.x + i, ux);
        pir_store(to.y + i, uy);
        pir_store(to.z + i, uz);
        pir_store(s + i, slack);
        low = pir_lesser_lanes(slack, low);
        along = pir_lesser_lanes(nx * x.x + ny * x.y + nz * x.z, along);
    }
    slacks->least = pir_least_of(low);
    slacks->along = pir_least_of(along);
}

PIR_LANES_TARGET static double least(uint32_t count, pir_lanes n, const double *h, pir_vec3 x) {
    pir_lane low[2] = {pir_all(HUGE_VAL), pir_all(HUGE_VAL)};
    for (uint32_t i = 0; i < count;)
        for (int k = 0; k < 2; k++, i += PIR_WIDTH)
            low[k] = pir_lesser_lanes(pir_load(h + i) -
                                          (pir_load(n.x + i) * x.x + pir_load(n.y + i) * x.y + pir_load(n.z + i) * x.z),
                                      low[k]);
    return pir_least_of(pir_lesser_lanes(low[0], low[1]));
}

PIR_LANES_TARGET static void boxes(uint32_t count, const pir_box_lanes *boxes, pir_vec3 x, double error, double *low) {
    const double *h = boxes->h, *err = boxes->err;
    // the corner of the box that is farthest along x
    const double *cx = x.x > 0 ? boxes->most.x : boxes->least.x, *cy = x.y > 0 ? boxes->most.y : boxes->least.y,
                 *cz = x.z > 0 ? boxes->most.z : boxes->least.z;
    for (uint32_t i = 0; i < count; i += PIR_WIDTH) {
        pir_lane along = pir_load(cx + i) * x.x + pir_load(cy + i) * x.y + pir_load(cz + i) * x.z;
        pir_store(low + i, pir_load(h + i) - along - error * pir_load(err + i));
    }
}

PIR_LANES_TARGET static void bounds(uint32_t count, const pir_lasting_lanes *lasting, double turn, pir_vec3 x,
                                    double error, double *low) {
    const double *bound = lasting->bound, *when = lasting->when, *lever = lasting->lever, *bend = lasting->bend;
    const pir_lanes at = lasting->where;
    for (uint32_t i = 0; i < count; i += PIR_WIDTH) {
        pir_lane mx = x.x - pir_load(at.x + i), my = x.y - pir_load(at.y + i), mz = x.z - pir_load(at.z + i);
        pir_lane angle = turn - pir_load(when + i);
        pir_lane loss =
            angle * (pir_load(lever + i) + angle * pir_load(bend + i)) + pir_roots(mx * mx + my * my + mz * mz);
        pir_store(low + i, pir_load(bound + i) - loss * (1 + 0x1p-40) - error);
    }
}

PIR_LANES_TARGET static double caps(uint32_t from, uint32_t count, const pir_cap_lanes *caps, pir_vec3 x, double error,
                                    double *low) {
    const pir_lanes axis = caps->axis, corner = caps->corner;
    const double *cosine = caps->cosine, *sine = caps->sine;
    pir_lane high = pir_all(HUGE_VAL);
    for (uint32_t i = from; i < from + count; i += PIR_WIDTH) {
        pir_lane wx = pir_load(corner.x + i) - x.x, wy = pir_load(corner.y + i) - x.y,
                 wz = pir_load(corner.z + i) - x.z;
        pir_lane along = pir_load(axis.x + i) * wx + pir_load(axis.y + i) * wy + pir_load(axis.z + i) * wz;
        pir_lane square = wx * wx + wy * wy + wz * wz;
        // rounded up by more than the error of either square, so that it is never below zero
        pir_lane across = pir_roots(square * (1 + 0x1p-47) - along * along);
        pir_lane bound = along * pir_load(cosine + i) - across * pir_load(sine + i) - 2 * error,
                 old = pir_load(low + i);
        pir_store(low + i, pir_choose((bound > (pir_lane){0}) & (bound > old), bound, old));
        high = pir_lesser_lanes(along + error, high);
    }
    return pir_least_of(high);
}

const pir_scan PIR_LANES_OF(pir_scan) = {PIR_LANES_NAME, turn, offset, cross, look, slacks, least, boxes, bounds, caps};
