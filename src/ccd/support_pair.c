/* SPDX-License-Identifier: MIT */
/*
 * Overlap and distance of a pair without a sum, from support functions through libccd.
 *
 * The pair is scaled to size one, with Q's middle at the origin, because libccd compares with absolute tolerances.
 * Overlap is libccd's MPR. libccd has no distance of bodies. Here it is a descent from vertex to vertex of the
 * difference, on libccd's distances of the origin to a segment and a triangle. The bounds that the descent keeps tell
 * success from failure. A failure is an outcome, never a number.
 */
#include <pirouette/ccd.h>

#include "exact/rotation.h"
#include "query/frame/climb.h"

#if PIR_HAVE_CCD
#include <ccd/ccd.h>
#include <ccd/vec3.h>

_Static_assert(sizeof(ccd_real_t) == sizeof(double), "libccd must be built for double precision");

/*
 * The bounds on a distance must meet this closely, relative to the size of the pair: libccd's own sums round at some
 * 1e-15, and a descent loses half the digits where a triangle is narrow.
 */
#define PAIR_MEET 1e-9

/* The bound on the steps of a descent, and of libccd: in practice about ten are taken. */
#define PAIR_STEPS 128

#define EXPONENT_LEAST (-1020)

/* One operand, scaled. */
struct support_side {
    const pir_polytope *polytope;
    pir_mat3 r;
    pir_vec3 middle; /* of its bounds, in body coordinates */
    pir_vec3 at;     /* the place of the middle */
    double scale;
    uint32_t last;
};

static void side_support(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *point) {
    struct support_side *side = (struct support_side *)object;
    pir_vec3 d = {direction->v[0], direction->v[1], direction->v[2]};
    double length = sqrt(pir_vec_dot(d, d));
    d = length > 0 ? pir_vec_scale(d, 1 / length) : (pir_vec3){1, 0, 0};
    side->last = pir_climb(side->polytope, pir_mat_apply_transposed(&side->r, d), side->last);
    pir_vec3 v = pir_vec_scale(pir_vec_sub(side->polytope->vertex[side->last], side->middle), side->scale);
    v = pir_vec_add(pir_mat_apply(&side->r, v), side->at);
    ccdVec3Set(point, v.x, v.y, v.z);
}

static void side_centre(const void *object, ccd_vec3_t *point) {
    const struct support_side *side = object;
    ccdVec3Set(point, side->at.x, side->at.y, side->at.z);
}

static pir_vec3 middle_of(const pir_polytope *p, double *size) {
    pir_vec3 low, high;
    pir_polytope_bounds(p, &low, &high);
    pir_vec3 d = pir_vec_sub(high, low);
    *size = fmax(*size, fmax(d.x, fmax(d.y, d.z)));
    return (pir_vec3){0.5 * low.x + 0.5 * high.x, 0.5 * low.y + 0.5 * high.y, 0.5 * low.z + 0.5 * high.z};
}

/* Both operands on one scale, P in its place. *ret_unit is the length of the scale's unit. */
static pir_status make_sides(const pir_ccd_pair *pair, struct support_side sides[2], double *ret_unit) {
    if (!pair || !pair->p || !pair->q)
        return PIR_ERR_ARGUMENT;
    if (!pir_vec_is_finite(pair->translation))
        return PIR_ERR_NOT_FINITE;
    pir_rotation rotation;
    pir_status status = pir_rotation_set(&rotation, pair->rotation);
    if (status != PIR_OK)
        return status;
    double size = 0;
    sides[0] = (struct support_side){.polytope = pair->p, .r = rotation.r, .middle = middle_of(pair->p, &size)};
    sides[1] = (struct support_side){
        .polytope = pair->q, .r = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, .middle = middle_of(pair->q, &size)};
    pir_vec3 at = pir_vec_add(pir_mat_apply(&rotation.r, sides[0].middle), pair->translation);
    pir_vec3 apart = pir_vec_sub(at, sides[1].middle);
    // two points have no size: how far they are apart gives the unit
    if (size == 0)
        size = fmax(fabs(apart.x), fmax(fabs(apart.y), fabs(apart.z)));
    int exponent = 0;
    if (size > 0)
        frexp(size, &exponent);
    // the unit's inverse is a double
    *ret_unit = ldexp(1, exponent > EXPONENT_LEAST ? exponent : EXPONENT_LEAST);
    sides[0].scale = sides[1].scale = 1 / *ret_unit;
    sides[0].at = pir_vec_scale(apart, sides[0].scale);
    return pir_vec_is_finite(sides[0].at) ? PIR_OK : PIR_ERR_LIMIT;
}

pir_status pir_ccd_overlap(const pir_ccd_pair *pair, pir_ccd_outcome *ret_outcome) {
    struct support_side sides[2];
    double unit;
    if (!ret_outcome)
        return PIR_ERR_ARGUMENT;
    pir_status status = make_sides(pair, sides, &unit);
    if (status != PIR_OK)
        return status;
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = side_support;
    ccd.center1 = ccd.center2 = side_centre;
    ccd.max_iterations = PAIR_STEPS;
    *ret_outcome = ccdMPRIntersect(&sides[0], &sides[1], &ccd) ? PIR_CCD_OVERLAPPING : PIR_CCD_SEPARATED;
    return PIR_OK;
}

/* --- distance --- */

struct pair_simplex {
    uint32_t count;
    ccd_vec3_t w[4];
};

static void support_of_difference(struct support_side sides[2], const ccd_vec3_t *direction, ccd_vec3_t *w) {
    ccd_vec3_t minus, a, b;
    ccdVec3Copy(&minus, direction);
    ccdVec3Scale(&minus, -1);
    side_support(&sides[0], direction, &a);
    side_support(&sides[1], &minus, &b);
    ccdVec3Sub2(w, &a, &b);
}

/*
 * The nearest point to the origin on the simplex' faces at the last vertex. Drops one vertex of four that it does not
 * need.
 */
static double nearest_of(struct pair_simplex *simplex, ccd_vec3_t *ret_v) {
    ccd_vec3_t *w = simplex->w;
    if (simplex->count == 1) {
        ccdVec3Copy(ret_v, &w[0]);
        return ccdVec3Len2(&w[0]);
    }
    if (simplex->count == 2)
        return ccdVec3PointSegmentDist2(ccd_vec3_origin, &w[0], &w[1], ret_v);
    if (simplex->count == 3)
        return ccdVec3PointTriDist2(ccd_vec3_origin, &w[0], &w[1], &w[2], ret_v);
    double best = HUGE_VAL;
    uint32_t spare = 0;
    for (uint32_t i = 0; i < 3; i++) {
        ccd_vec3_t v;
        double square = ccdVec3PointTriDist2(ccd_vec3_origin, &w[(i + 1) % 3], &w[(i + 2) % 3], &w[3], &v);
        if (square < best) {
            best = square;
            spare = i;
            ccdVec3Copy(ret_v, &v);
        }
    }
    ccdVec3Copy(&w[spare], &w[3]);
    simplex->count = 3;
    return best;
}

pir_status pir_ccd_distance(const pir_ccd_pair *pair, pir_ccd_outcome *ret_outcome, double *ret_distance) {
    struct support_side sides[2];
    double unit;
    if (!ret_outcome || !ret_distance)
        return PIR_ERR_ARGUMENT;
    pir_status status = make_sides(pair, sides, &unit);
    if (status != PIR_OK)
        return status;
    struct pair_simplex simplex = {.count = 1};
    ccd_vec3_t v = {{sides[0].at.x, sides[0].at.y, sides[0].at.z}}, minus;
    double reach = 2 + sqrt(ccdVec3Len2(&v)), upper = HUGE_VAL, lower = -HUGE_VAL;
    ccdVec3Copy(&minus, &v);
    ccdVec3Scale(&minus, -1);
    support_of_difference(sides, &minus, &simplex.w[0]);
    for (int step = 0; step < PAIR_STEPS; step++) {
        double length = sqrt(nearest_of(&simplex, &v));
        // no nearer than before: doubles give no more
        if (!(length < upper) || length <= PAIR_MEET * reach) {
            upper = fmin(upper, length);
            break;
        }
        upper = length;
        ccdVec3Copy(&minus, &v);
        ccdVec3Scale(&minus, -1);
        support_of_difference(sides, &minus, &simplex.w[simplex.count]);
        lower = fmax(lower, ccdVec3Dot(&v, &simplex.w[simplex.count]) / length);
        if (upper - lower <= PAIR_MEET * reach)
            break;
        simplex.count++;
    }
    // a pair overlaps when no plane separates it; bounds that neither meet nor separate are no answer
    bool met = upper - lower <= PAIR_MEET * reach && lower > 0, close = upper <= PAIR_MEET * reach;
    pir_ccd_outcome outcome = met ? PIR_CCD_SEPARATED : PIR_CCD_FAILED;
    if (!met && (close || lower <= 0)) {
        status = pir_ccd_overlap(pair, &outcome);
        if (status == PIR_OK && outcome == PIR_CCD_SEPARATED)
            outcome = close ? PIR_CCD_OVERLAPPING : PIR_CCD_FAILED;
    }
    *ret_outcome = outcome;
    *ret_distance = outcome == PIR_CCD_SEPARATED ? upper * unit : 0;
    return status;
}

#else

pir_status pir_ccd_overlap(const pir_ccd_pair *pair, pir_ccd_outcome *ret_outcome) {
    return pair && ret_outcome ? PIR_ERR_NOT_BUILT : PIR_ERR_ARGUMENT;
}

pir_status pir_ccd_distance(const pir_ccd_pair *pair, pir_ccd_outcome *ret_outcome, double *ret_distance) {
    return pair && ret_outcome && ret_distance ? PIR_ERR_NOT_BUILT : PIR_ERR_ARGUMENT;
}
#endif
