/* SPDX-License-Identifier: MIT */
/*
 * The text of scan.h's loops; SCAN_TARGET says for which processor, SCAN_WIDTH how many doubles it takes at once,
 * SCAN_NAME what the result is called.
 */

/* A few doubles at once: the compiler's own vectors, loaded from and stored to any address. */
typedef double lane __attribute__((vector_size(8 * SCAN_WIDTH), aligned(8), may_alias));
typedef int64_t mask __attribute__((vector_size(8 * SCAN_WIDTH)));
#define AT(pointer)       (*(lane *)((pointer) + i))
#define CONST_AT(pointer) (*(const lane *)((pointer) + i))

SCAN_TARGET static inline lane roots(lane v) {
    lane r;
    for (int k = 0; k < SCAN_WIDTH; k++)
        r[k] = sqrt(v[k]);
    return r;
}

SCAN_TARGET static void turn(uint32_t count, const pir_mat3 *r, pir_lanes from, pir_lanes to) {
    const pir_mat3 m = *r;
    for (uint32_t i = 0; i < count; i += SCAN_WIDTH) {
        lane x = CONST_AT(from.x), y = CONST_AT(from.y), z = CONST_AT(from.z);
        AT(to.x) = m.m[0][0] * x + m.m[0][1] * y + m.m[0][2] * z;
        AT(to.y) = m.m[1][0] * x + m.m[1][1] * y + m.m[1][2] * z;
        AT(to.z) = m.m[2][0] * x + m.m[2][1] * y + m.m[2][2] * z;
    }
}

SCAN_TARGET static void offset(uint32_t count, pir_lanes n, const double *base, pir_lanes p, double *h) {
    for (uint32_t i = 0; i < count; i += SCAN_WIDTH)
        AT(h) = CONST_AT(base) +
                (CONST_AT(n.x) * CONST_AT(p.x) + CONST_AT(n.y) * CONST_AT(p.y) + CONST_AT(n.z) * CONST_AT(p.z));
}

SCAN_TARGET static double cross(uint32_t count, pir_lanes d, pir_lanes e, pir_lanes y, pir_lanes n, double *h,
                                double *err) {
    for (uint32_t i = 0; i < count; i += SCAN_WIDTH) {
        lane dx = CONST_AT(d.x), dy = CONST_AT(d.y), dz = CONST_AT(d.z);
        lane ex = CONST_AT(e.x), ey = CONST_AT(e.y), ez = CONST_AT(e.z);
        lane cx = dy * ez - dz * ey, cy = dz * ex - dx * ez, cz = dx * ey - dy * ex;
        lane by = 1.0 / roots(cx * cx + cy * cy + cz * cz);
        cx *= by, cy *= by, cz *= by;
        AT(n.x) = cx;
        AT(n.y) = cy;
        AT(n.z) = cz;
        AT(err) = by;
        AT(h) = cx * CONST_AT(y.x) + cy * CONST_AT(y.y) + cz * CONST_AT(y.z);
    }
    double most = 0;
    for (uint32_t i = 0; i < count; i++)
        most = err[i] > most ? err[i] : most;
    return most;
}

/* Lane by lane, a where it is less than b. */
SCAN_TARGET static inline lane lesser(lane a, lane b) {
    mask less = a < b;
    return (lane)(((mask)a & less) | ((mask)b & ~less));
}

SCAN_TARGET static double least_lane(lane v) {
    double r = v[0];
    for (int k = 1; k < SCAN_WIDTH; k++)
        r = v[k] < r ? v[k] : r;
    return r;
}

SCAN_TARGET static void look(uint32_t count, pir_lanes n, const double *h, const double *err, pir_vec3 x, double error,
                             double ret_least[3]) {
    lane low[2], high[2], along[2];
    for (int k = 0; k < 2; k++)
        low[k] = high[k] = along[k] = (lane){0} + HUGE_VAL;
    for (uint32_t i = 0; i < count;)
        for (int k = 0; k < 2; k++, i += SCAN_WIDTH) {
            lane to = CONST_AT(n.x) * x.x + CONST_AT(n.y) * x.y + CONST_AT(n.z) * x.z;
            lane s = CONST_AT(h) - to, off = error * CONST_AT(err);
            low[k] = lesser(s - off, low[k]);
            high[k] = lesser(s + off, high[k]);
            along[k] = lesser(to, along[k]);
        }
    ret_least[0] = least_lane(lesser(low[0], low[1]));
    ret_least[1] = least_lane(lesser(high[0], high[1]));
    ret_least[2] = least_lane(lesser(along[0], along[1]));
}

SCAN_TARGET static void slacks(uint32_t count, const pir_mat3 *r, pir_lanes from, pir_vec3 x, pir_lanes n,
                               const double *base, pir_lanes to, double *s, double ret_least[2]) {
    const pir_mat3 m = *r;
    lane low = (lane){0} + HUGE_VAL, along = low;
    for (uint32_t i = 0; i < count; i += SCAN_WIDTH) {
        lane fx = CONST_AT(from.x), fy = CONST_AT(from.y), fz = CONST_AT(from.z);
        lane ux = m.m[0][0] * fx + m.m[0][1] * fy + m.m[0][2] * fz - x.x;
        lane uy = m.m[1][0] * fx + m.m[1][1] * fy + m.m[1][2] * fz - x.y;
        lane uz = m.m[2][0] * fx + m.m[2][1] * fy + m.m[2][2] * fz - x.z;
        lane nx = CONST_AT(n.x), ny = CONST_AT(n.y), nz = CONST_AT(n.z);
        lane slack = CONST_AT(base) + (nx * ux + ny * uy + nz * uz);
        AT(to.x) = ux;
        AT(to.y) = uy;
        AT(to.z) = uz;
        AT(s) = slack;
        low = lesser(slack, low);
        along = lesser(nx * x.x + ny * x.y + nz * x.z, along);
    }
    ret_least[0] = least_lane(low);
    ret_least[1] = least_lane(along);
}

SCAN_TARGET static double least(uint32_t count, pir_lanes n, const double *h, pir_vec3 x) {
    lane low[2] = {(lane){0} + HUGE_VAL, (lane){0} + HUGE_VAL};
    for (uint32_t i = 0; i < count;)
        for (int k = 0; k < 2; k++, i += SCAN_WIDTH)
            low[k] = lesser(CONST_AT(h) - (CONST_AT(n.x) * x.x + CONST_AT(n.y) * x.y + CONST_AT(n.z) * x.z), low[k]);
    return least_lane(lesser(low[0], low[1]));
}

SCAN_TARGET static void boxes(uint32_t count, pir_lanes from, pir_lanes to, const double *h, const double *err,
                              pir_vec3 x, double error, double *low) {
    // the corner of the box that is farthest along x
    const double *cx = x.x > 0 ? to.x : from.x, *cy = x.y > 0 ? to.y : from.y, *cz = x.z > 0 ? to.z : from.z;
    for (uint32_t i = 0; i < count; i += SCAN_WIDTH)
        AT(low) = CONST_AT(h) - (CONST_AT(cx) * x.x + CONST_AT(cy) * x.y + CONST_AT(cz) * x.z) - error * CONST_AT(err);
}

SCAN_TARGET static void bounds(uint32_t count, const double *bound, const double *when, const double *lever,
                               const double *bend, pir_lanes at, double turned, pir_vec3 x, double error, double *low) {
    for (uint32_t i = 0; i < count; i += SCAN_WIDTH) {
        lane mx = x.x - CONST_AT(at.x), my = x.y - CONST_AT(at.y), mz = x.z - CONST_AT(at.z),
             angle = turned - CONST_AT(when);
        lane loss = angle * (CONST_AT(lever) + angle * CONST_AT(bend)) + roots(mx * mx + my * my + mz * mz);
        AT(low) = CONST_AT(bound) - loss * (1 + 0x1p-40) - error;
    }
}

SCAN_TARGET static double caps(uint32_t count, pir_lanes axis, pir_lanes corner, const double *cosine,
                               const double *sine, pir_vec3 x, double error, double *low) {
    lane high = (lane){0} + HUGE_VAL;
    for (uint32_t i = 0; i < count; i += SCAN_WIDTH) {
        lane wx = CONST_AT(corner.x) - x.x, wy = CONST_AT(corner.y) - x.y, wz = CONST_AT(corner.z) - x.z;
        lane along = CONST_AT(axis.x) * wx + CONST_AT(axis.y) * wy + CONST_AT(axis.z) * wz;
        lane square = wx * wx + wy * wy + wz * wz;
        // rounded up by more than either square is off by, so it is never below zero
        lane across = roots(square * (1 + 0x1p-47) - along * along);
        lane bound = along * CONST_AT(cosine) - across * CONST_AT(sine) - 2 * error, old = CONST_AT(low);
        mask better = (bound > (lane){0}) & (bound > old);
        AT(low) = (lane)(((mask)bound & better) | ((mask)old & ~better));
        high = lesser(along + error, high);
    }
    return least_lane(high);
}

const pir_scan SCAN_NAME = {SCAN_TEXT, turn, offset, cross, look, slacks, least, boxes, bounds, caps};
