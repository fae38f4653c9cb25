/* SPDX-License-Identifier: MIT */
/*
 * The text of scan.h's loops. SCAN_TARGET names the processor, SCAN_WIDTH is the number of doubles in a vector,
 * SCAN_NAME the name of the result.
 */

/* A vector of doubles: the compiler's own, loaded from and stored to any address. */
typedef double scan_lane __attribute__((vector_size(8 * SCAN_WIDTH), aligned(8), may_alias));
typedef int64_t mask __attribute__((vector_size(8 * SCAN_WIDTH)));

SCAN_TARGET static inline scan_lane load(const double *from) {
    return *(const scan_lane *)from;
}

SCAN_TARGET static inline void store(double *to, scan_lane v) {
    *(scan_lane *)to = v;
}

SCAN_TARGET static inline scan_lane roots(scan_lane v) {
    scan_lane r;
    for (int k = 0; k < SCAN_WIDTH; k++)
        r[k] = sqrt(v[k]);
    return r;
}

SCAN_TARGET static void turn(uint32_t count, const pir_mat3 *r, pir_lanes from, pir_lanes to) {
    const pir_mat3 m = *r;
    for (uint32_t i = 0; i < count; i += SCAN_WIDTH) {
        scan_lane x = load(from.x + i), y = load(from.y + i), z = load(from.z + i);
        store(to.x + i, m.m[0][0] * x + m.m[0][1] * y + m.m[0][2] * z);
        store(to.y + i, m.m[1][0] * x + m.m[1][1] * y + m.m[1][2] * z);
        store(to.z + i, m.m[2][0] * x + m.m[2][1] * y + m.m[2][2] * z);
    }
}

SCAN_TARGET static void offset(uint32_t count, pir_lanes n, const double *base, pir_lanes p, double *h) {
    for (uint32_t i = 0; i < count; i += SCAN_WIDTH)
        store(h + i, load(base + i) + (load(n.x + i) * load(p.x + i) + load(n.y + i) * load(p.y + i) +
                                       load(n.z + i) * load(p.z + i)));
}

SCAN_TARGET static double cross(uint32_t count, pir_lanes d, pir_lanes e, pir_lanes y, pir_lanes n, double *h,
                                double *err) {
    for (uint32_t i = 0; i < count; i += SCAN_WIDTH) {
        scan_lane dx = load(d.x + i), dy = load(d.y + i), dz = load(d.z + i);
        scan_lane ex = load(e.x + i), ey = load(e.y + i), ez = load(e.z + i);
        scan_lane cx = dy * ez - dz * ey, cy = dz * ex - dx * ez, cz = dx * ey - dy * ex;
        scan_lane by = 1.0 / roots(cx * cx + cy * cy + cz * cz);
        cx *= by;
        cy *= by;
        cz *= by;
        store(n.x + i, cx);
        store(n.y + i, cy);
        store(n.z + i, cz);
        store(err + i, by);
        store(h + i, cx * load(y.x + i) + cy * load(y.y + i) + cz * load(y.z + i));
    }
    double most = 0;
    for (uint32_t i = 0; i < count; i++)
        most = err[i] > most ? err[i] : most;
    return most;
}

/* The lesser of a and b in every lane, b where they are not ordered. */
SCAN_TARGET static inline scan_lane lesser(scan_lane a, scan_lane b) {
    mask less = a < b;
    return (scan_lane)(((mask)a & less) | ((mask)b & ~less));
}

SCAN_TARGET static double least_lane(scan_lane v) {
    double r = v[0];
    for (int k = 1; k < SCAN_WIDTH; k++)
        r = v[k] < r ? v[k] : r;
    return r;
}

SCAN_TARGET static void look(uint32_t count, pir_lanes n, const double *h, const double *err, pir_vec3 x, double error,
                             double ret_least[3]) {
    scan_lane low[2], high[2], along[2];
    for (int k = 0; k < 2; k++)
        low[k] = high[k] = along[k] = (scan_lane){0} + HUGE_VAL;
    for (uint32_t i = 0; i < count;)
        for (int k = 0; k < 2; k++, i += SCAN_WIDTH) {
            scan_lane to = load(n.x + i) * x.x + load(n.y + i) * x.y + load(n.z + i) * x.z;
            scan_lane s = load(h + i) - to, off = error * load(err + i);
            low[k] = lesser(s - off, low[k]);
            high[k] = lesser(s + off, high[k]);
            along[k] = lesser(to, along[k]);
        }
    ret_least[0] = least_lane(lesser(low[0], low[1]));
    ret_least[1] = least_lane(lesser(high[0], high[1]));
    ret_least[2] = least_lane(lesser(along[0], along[1]));
}

SCAN_TARGET static void slacks(uint32_t count, const pir_mat3 *r, pir_lanes from, pir_vec3 x,
                               const pir_facet_lanes *facets, pir_slack_lanes *slacks) {
    const pir_mat3 m = *r;
    const pir_lanes n = facets->normal, to = slacks->to;
    const double *offset_of = facets->offset;
    double *s = slacks->s;
    scan_lane low = (scan_lane){0} + HUGE_VAL, along = low;
    for (uint32_t i = 0; i < count; i += SCAN_WIDTH) {
        scan_lane fx = load(from.x + i), fy = load(from.y + i), fz = load(from.z + i);
        scan_lane ux = m.m[0][0] * fx + m.m[0][1] * fy + m.m[0][2] * fz - x.x;
        scan_lane uy = m.m[1][0] * fx + m.m[1][1] * fy + m.m[1][2] * fz - x.y;
        scan_lane uz = m.m[2][0] * fx + m.m[2][1] * fy + m.m[2][2] * fz - x.z;
        scan_lane nx = load(n.x + i), ny = load(n.y + i), nz = load(n.z + i);
        scan_lane slack = load(offset_of + i) + (nx * ux + ny * uy + nz * uz);
        store(to.x + i, ux);
        store(to.y + i, uy);
        store(to.z + i, uz);
        store(s + i, slack);
        low = lesser(slack, low);
        along = lesser(nx * x.x + ny * x.y + nz * x.z, along);
    }
    slacks->least = least_lane(low);
    slacks->along = least_lane(along);
}

SCAN_TARGET static double least(uint32_t count, pir_lanes n, const double *h, pir_vec3 x) {
    scan_lane low[2] = {(scan_lane){0} + HUGE_VAL, (scan_lane){0} + HUGE_VAL};
    for (uint32_t i = 0; i < count;)
        for (int k = 0; k < 2; k++, i += SCAN_WIDTH)
            low[k] = lesser(load(h + i) - (load(n.x + i) * x.x + load(n.y + i) * x.y + load(n.z + i) * x.z), low[k]);
    return least_lane(lesser(low[0], low[1]));
}

SCAN_TARGET static void boxes(uint32_t count, const pir_box_lanes *boxes, pir_vec3 x, double error, double *low) {
    const double *h = boxes->h, *err = boxes->err;
    // the corner of the box that is farthest along x
    const double *cx = x.x > 0 ? boxes->most.x : boxes->least.x, *cy = x.y > 0 ? boxes->most.y : boxes->least.y,
                 *cz = x.z > 0 ? boxes->most.z : boxes->least.z;
    for (uint32_t i = 0; i < count; i += SCAN_WIDTH) {
        scan_lane along = load(cx + i) * x.x + load(cy + i) * x.y + load(cz + i) * x.z;
        store(low + i, load(h + i) - along - error * load(err + i));
    }
}

SCAN_TARGET static void bounds(uint32_t count, const pir_lasting_lanes *lasting, double turn, pir_vec3 x, double error,
                               double *low) {
    const double *bound = lasting->bound, *when = lasting->when, *lever = lasting->lever, *bend = lasting->bend;
    const pir_lanes at = lasting->where;
    for (uint32_t i = 0; i < count; i += SCAN_WIDTH) {
        scan_lane mx = x.x - load(at.x + i), my = x.y - load(at.y + i), mz = x.z - load(at.z + i);
        scan_lane angle = turn - load(when + i);
        scan_lane loss = angle * (load(lever + i) + angle * load(bend + i)) + roots(mx * mx + my * my + mz * mz);
        store(low + i, load(bound + i) - loss * (1 + 0x1p-40) - error);
    }
}

SCAN_TARGET static double caps(uint32_t from, uint32_t count, const pir_cap_lanes *caps, pir_vec3 x, double error,
                               double *low) {
    const pir_lanes axis = caps->axis, corner = caps->corner;
    const double *cosine = caps->cosine, *sine = caps->sine;
    scan_lane high = (scan_lane){0} + HUGE_VAL;
    for (uint32_t i = from; i < from + count; i += SCAN_WIDTH) {
        scan_lane wx = load(corner.x + i) - x.x, wy = load(corner.y + i) - x.y, wz = load(corner.z + i) - x.z;
        scan_lane along = load(axis.x + i) * wx + load(axis.y + i) * wy + load(axis.z + i) * wz;
        scan_lane square = wx * wx + wy * wy + wz * wz;
        // rounded up by more than the error of either square, so that it is never below zero
        scan_lane across = roots(square * (1 + 0x1p-47) - along * along);
        scan_lane bound = along * load(cosine + i) - across * load(sine + i) - 2 * error, old = load(low + i);
        mask better = (bound > (scan_lane){0}) & (bound > old);
        store(low + i, (scan_lane)(((mask)bound & better) | ((mask)old & ~better)));
        high = lesser(along + error, high);
    }
    return least_lane(high);
}

const pir_scan SCAN_NAME = {SCAN_TEXT, turn, offset, cross, look, slacks, least, boxes, bounds, caps};
