/* SPDX-License-Identifier: MIT */
/*
 * The loops over planes, behind one dispatch struct: a plain version and one for AVX2, chosen when a query is made.
 * Both are the same text, compiled twice, without fused operations: they give the same bits.
 *
 * `slacks` and `caps` are given whole lanes and nothing else, `look` and `least` whole blocks; the rest read and
 * write up to PIR_SCAN_LANES − 1 elements past `count`.
 */
#ifndef PIR_QUERY_PLANES_SCAN_H
#define PIR_QUERY_PLANES_SCAN_H

#include <stdint.h>

#include "query/frame/lanes.h"

typedef struct pir_scan {
    const char *name;

    /* to[i] = r · from[i]. */
    void (*turn)(uint32_t count, const pir_mat3 *r, pir_lanes from, pir_lanes to);

    /* h[i] = base[i] + n[i] · p[i]. */
    void (*offset)(uint32_t count, pir_lanes n, const double *base, pir_lanes p, double *h);

    /* n[i] = unit(d[i] × e[i]), err[i] = 1 / |d[i] × e[i]|, h[i] = n[i] · y[i]; returns the greatest err. */
    double (*cross)(uint32_t count, pir_lanes d, pir_lanes e, pir_lanes y, pir_lanes n, double *h, double *err);

    /* The least s − error · err, s + error · err and n · x of whole blocks, s = h − n · x. */
    void (*look)(uint32_t count, pir_lanes n, const double *h, const double *err, pir_vec3 x, double error,
                 double ret_least[3]);

    /* to[i] = r · from[i] − x and s[i] = base[i] + n[i] · to[i]; the least s and n · x. */
    void (*slacks)(uint32_t count, const pir_mat3 *r, pir_lanes from, pir_vec3 x, pir_lanes n, const double *base,
                   pir_lanes to, double *s, double ret_least[2]);

    /* The least h[i] − n[i] · x of whole blocks. */
    double (*least)(uint32_t count, pir_lanes n, const double *h, pir_vec3 x);

    /* low[i] = h[i] − the most that n · x can be, n from from[i] to to[i] − error · err[i]. */
    void (*boxes)(uint32_t count, pir_lanes from, pir_lanes to, const double *h, const double *err, pir_vec3 x,
                  double error, double *low);

    /* low[i] = bound[i] − (a · (lever[i] + a · bend[i]) + |x − at[i]|) · (1 + 2^-40) − error, a = turned − when[i]. */
    void (*bounds)(uint32_t count, const double *bound, const double *when, const double *lever, const double *bend,
                   pir_lanes at, double turned, pir_vec3 x, double error, double *low);

    /*
     * With w = corner[i] − x and along = axis[i]·w: low[i] becomes along · cosine[i] − |w across axis[i]| · sine[i] −
     * 2 error where that is above 0 and above what it is. Returns the least along + error.
     */
    double (*caps)(uint32_t count, pir_lanes axis, pir_lanes corner, const double *cosine, const double *sine,
                   pir_vec3 x, double error, double *low);
} pir_scan;

/* The versions that this build has and this processor runs, the plain one first; NULL past the last. */
const pir_scan *pir_scan_version(unsigned index);

#endif
