/* SPDX-License-Identifier: MIT */
/*
 * The loops over planes, behind one dispatch struct, which a query takes from the processor's table
 * (base/processor.h) when it is made.
 *
 * `look` and `least` take whole blocks of planes, `slacks` and `caps` whole lanes. The other loops read and write up
 * to PIR_SCAN_LANES − 1 elements past `count`.
 */
#ifndef PIR_QUERY_DEPTH_SCAN_H
#define PIR_QUERY_DEPTH_SCAN_H

#include <stdint.h>

#include "query/frame/lanes.h"

/* Facets of a body: unit normals, and offsets from its middle. */
typedef struct pir_facet_lanes {
    pir_lanes normal;
    const double *offset;
} pir_facet_lanes;

/* Where `slacks` writes, and the least slack and the least n·x that it has found. */
typedef struct pir_slack_lanes {
    pir_lanes to;
    double *s;
    double least, along;
} pir_slack_lanes;

/* Boxes around planes: normals from `least` to `most` component by component, the least offset, the greatest err. */
typedef struct pir_box_lanes {
    pir_lanes least, most;
    double *h, *err;
} pir_box_lanes;

/*
 * Bounds that last. The slacks of a group were at least `bound` when x was at `where` and the turn was `when`. A turn
 * by an angle a since then lowers them by at most a · (lever + a · bend), a move of x by at most its length.
 */
typedef struct pir_lasting_lanes {
    double *bound, *when, *lever, *bend;
    pir_lanes where;
} pir_lasting_lanes;

/* Caps: directions within an angle of a unit axis, and a corner of D. */
typedef struct pir_cap_lanes {
    pir_lanes axis, corner;
    double *cosine, *sine; /* of the angle */
} pir_cap_lanes;

typedef struct pir_scan {
    const char *name;

    /* to[i] = r · from[i]. */
    void (*turn)(uint32_t count, const pir_mat3 *r, pir_lanes from, pir_lanes to);

    /* h[i] = base[i] + n[i] · p[i]. */
    void (*offset)(uint32_t count, pir_lanes n, const double *base, pir_lanes p, double *h);

    /* n[i] = unit(d[i] × e[i]), err[i] = 1 / |d[i] × e[i]|, h[i] = n[i] · y[i]. Returns the greatest err. */
    double (*cross)(uint32_t count, pir_lanes d, pir_lanes e, pir_lanes y, pir_lanes n, double *h, double *err);

    /* The least s − error · err, s + error · err and n · x, where s = h − n · x. */
    void (*look)(uint32_t count, pir_lanes n, const double *h, const double *err, pir_vec3 x, double error,
                 double ret_least[3]);

    /* to[i] = r · from[i] − x and s[i] = offset[i] + normal[i] · to[i]; the least s and normal · x. */
    void (*slacks)(uint32_t count, const pir_mat3 *r, pir_lanes from, pir_vec3 x, const pir_facet_lanes *facets,
                   pir_slack_lanes *slacks);

    /* The least h[i] − n[i] · x. */
    double (*least)(uint32_t count, pir_lanes n, const double *h, pir_vec3 x);

    /* low[i] = h[i] − the greatest n · x of the normals in box i − error · err[i]. */
    void (*boxes)(uint32_t count, const pir_box_lanes *boxes, pir_vec3 x, double error, double *low);

    /*
     * low[i] = bound[i] − (a · (lever[i] + a · bend[i]) + |x − where[i]|) · (1 + 2^-40) − error, a = turn −
     * when[i].
     */
    void (*bounds)(uint32_t count, const pir_lasting_lanes *lasting, double turn, pir_vec3 x, double error,
                   double *low);

    /*
     * For `count` caps from number `from` on, with w = corner[i] − x and along = axis[i]·w: low[i] becomes along ·
     * cosine[i] − |w across axis[i]| · sine[i] − 2 error where that is above 0 and above what it is. Returns the
     * least along + error.
     */
    double (*caps)(uint32_t from, uint32_t count, const pir_cap_lanes *caps, pir_vec3 x, double error, double *low);
} pir_scan;

extern const pir_scan pir_scan_plain, pir_scan_avx2;

#endif
