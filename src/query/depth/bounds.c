/* SPDX-License-Identifier: MIT */
/*
 * Lower bounds on the slacks of a group, without looking at its planes.
 *
 * For a unit normal n, s(n) = h_D(n) − n·x is the slack of D's plane with that normal.
 *
 * Bounds that last. Let n turn by a small angle. Then the support h_P(n) of a body changes by that angle times the
 * part of its support vertex p across n, √(|p|² − h_P(n)²). That part is at most the body's swing √(size² −
 * inner²), where inner is the least offset of its facets.
 *
 * - Facets of Q do not move. A turn of R by θ changes the support of R·P in a fixed direction by at most θ·swing_p,
 *   and a move of x by d changes n·x by at most d.
 * - Facets of P turn with R. Seen from P, the same holds with Q's support and with x rotated back: n·x changes by at
 *   most θ·|x across n| + θ²/2·|x|. Over an arc n·x is least at an end while it is positive.
 * - The crossings between facets of P come and go, but all lie on the arcs between facets. Along an arc s consists of
 *   pieces a·cos(φ − φ₀), which are concave while positive. So on an arc shorter than half a turn s is nowhere
 *   less than at the crossings and at the two facets. Where P is flat its arcs are half turns, and its groups have no
 *   bound that lasts.
 *
 * Caps. For any vertex w of D − x and any n, s(n) ≥ n·w. All normals of a group, those of crossings on its arcs
 * too, lie within an angle ρ of the normal c of one of its facets. There n·w ≥ |w|·cos(∠(c, w) + ρ) = (c·w)
 * cos ρ − |w across c| sin ρ. Let w be the vertex that the pairing has for that facet. Then c·w is the facet's own
 * slack, which is an upper bound on the least slack of all, and the lower bound falls short by the square of ρ only. A
 * cap needs no plane and no memory of earlier queries. It is no bound where it is not above zero, because the angle
 * then may be more than half a turn, nor where ρ is a right angle or more.
 *
 * Rounding. w = R a + b − x is off by less than 48u of the reach. A normal is off by 47u once rotated (frame.h). The
 * bound's own arithmetic adds less than 16u of |w|. Together that is below 120u of the reach, which one error, 128u,
 * holds (tests/proofs/bounds.g). A second error holds the slack that the bound is compared with.
 */
#include "query/depth/bounds.h"

#include <string.h>

/* --- memory --- */

void pir_bounds_add_rows(pir_bounds *bounds, const pir_groups *groups, pir_layout *layout) {
    uint32_t count = groups->count;
    // there are whole lanes of groups, so that loops stay within an array
    const pir_layout rows = {{PIR_ROW(bounds->lasting.bound, count), PIR_ROW(bounds->lasting.when, count),
                              PIR_ROW(bounds->lasting.lever, count), PIR_ROW(bounds->lasting.bend, count),
                              PIR_ROWS(bounds->lasting.where, count), PIR_ROW(bounds->low, count),
                              PIR_ROWS(bounds->caps.axis, count), PIR_ROWS(bounds->caps.corner, count),
                              PIR_ROW(bounds->caps.cosine, count), PIR_ROW(bounds->caps.sine, count),
                              PIR_ROW(bounds->cap_stamp, count / PIR_SCAN_LANES)}};
    for (const pir_layout_row *row = rows.row; row->size != 0; row++)
        pir_layout_add(layout, *row);
}

/* --- bounds that last --- */

/* Adds the angle between the rotation at the last call and the present one. What R did in between does not matter. */
static void note_turn(pir_bounds *bounds, const pir_groups *groups) {
    if (bounds->turned == groups->stamp)
        return;
    pir_quat now = groups->frame->unit;
    if (bounds->turned != 0)
        bounds->turn = (bounds->turn + pir_rotation_angle_bound(bounds->turned_to, now)) * (1 + 0x1p-51);
    bounds->turned_to = now;
    bounds->turned = groups->stamp;
}
/*
 * How far x reaches across the normals n of a group, where every n·x is at least `along`. That is all of |x| where
 * `along` is not positive.
 */
static double across(double length, double along) {
    return along > 0 && along < length ? sqrt((length - along) * (length + along)) : length;
}

void pir_bounds_keep(pir_bounds *bounds, const pir_groups *groups, uint32_t g, const pir_placement *placement,
                     double low, double along) {
    const pir_group *group = &groups->at[g];
    note_turn(bounds, groups);
    double length = placement->reach - groups->frame->p.size - groups->frame->q.size;
    // a bound that is not above zero does not last: arcs are concave only while s is positive
    bool lasts = low > 0 && (group->of_q || groups->frame->p.polytope->dimension == 3);
    bounds->lasting.bound[g] = lasts ? low : -HUGE_VAL;
    bounds->lasting.when[g] = bounds->turn;
    // the part of x that rounding may hide is below 2^-40 of the reach
    double rounding = 0x1p-40 * placement->reach;
    bounds->lasting.lever[g] =
        group->of_q ? groups->frame->p.swing : groups->frame->q.swing + across(length, along - rounding) + rounding;
    bounds->lasting.bend[g] = group->of_q ? 0 : 0.5 * length;
    pir_lane_put(bounds->lasting.where, g, placement->x);
}

/* --- caps --- */

void pir_bounds_fill(pir_bounds *bounds, const pir_groups *groups) {
    for (uint32_t g = 0; g < groups->count; g++)
        bounds->lasting.bound[g] = groups->at[g].of.facets == groups->at[g].of.own_end ? HUGE_VAL : -HUGE_VAL;
    for (uint32_t k = 0; k < groups->count / PIR_SCAN_LANES; k++)
        bounds->cap_stamp[k] = 0;
    for (int of_q = 0; of_q < 2; of_q++) {
        const pir_group_lists *lists = groups->lists[of_q];
        uint32_t from = of_q ? groups->first_of_q : 0;
        memcpy(bounds->caps.cosine + from, lists->cap_cosine, lists->count * sizeof *lists->cap_cosine);
        memcpy(bounds->caps.sine + from, lists->cap_sine, lists->count * sizeof *lists->cap_sine);
    }
}

/* Rotates the caps of groups [g, g + PIR_SCAN_LANES), which are all of one body. */
static void make_caps(pir_bounds *bounds, const pir_groups *groups, uint32_t g) {
    const pir_pairing *pairing = groups->pairing;
    bool of_q = groups->at[g].of_q;
    pir_vec3 other[PIR_SCAN_LANES];
    for (uint32_t i = 0; i < PIR_SCAN_LANES; i++) {
        uint32_t middle = groups->at[g + i].of.middle;
        other[i] = of_q ? groups->frame->p.vertex[pairing->vf[middle]] : groups->frame->q.vertex[pairing->fv[middle]];
    }
    const pir_group_lists *lists = groups->lists[of_q];
    uint32_t at = of_q ? g - groups->first_of_q : g;
    pir_lanes axis = pir_lanes_from(bounds->caps.axis, g), corner = pir_lanes_from(bounds->caps.corner, g);
    pir_lanes axis_body = pir_lanes_from(lists->cap_axis, at), corner_body = pir_lanes_from(lists->cap_corner, at);
    if (of_q) {
        for (uint32_t i = 0; i < PIR_SCAN_LANES; i++) {
            pir_lane_put(axis, i, pir_lane_get(axis_body, i));
            pir_lane_put(corner, i, other[i]);
            other[i] = pir_lane_get(corner_body, i);
        }
        groups->scan->turn(PIR_SCAN_LANES, &groups->frame->r, corner, corner);
    } else {
        groups->scan->turn(PIR_SCAN_LANES, &groups->frame->r, axis_body, axis);
        groups->scan->turn(PIR_SCAN_LANES, &groups->frame->r, corner_body, corner);
    }
    for (uint32_t i = 0; i < PIR_SCAN_LANES; i++)
        pir_lane_put(corner, i, pir_vec_add(pir_lane_get(corner, i), other[i]));
    bounds->cap_stamp[g / PIR_SCAN_LANES] = groups->stamp;
}

/* The groups of the block from `g` that are not ruled out yet, but may be by their caps: a bit each. */
static inline uint32_t open_groups(const pir_bounds *bounds, uint32_t g, double limit) {
    uint32_t open = 0;
    for (uint32_t i = 0; i < PIR_SCAN_LANES; i++)
        open |= (uint32_t)(bounds->low[g + i] <= limit && bounds->caps.cosine[g + i] > 0) << i;
    return open;
}

double pir_bounds_find(pir_bounds *bounds, const pir_groups *groups, const pir_placement *placement, double limit) {
    double high = HUGE_VAL;
    note_turn(bounds, groups);
    groups->scan->bounds(groups->count, &bounds->lasting, bounds->turn, placement->x, placement->error, bounds->low);
    for (uint32_t g = 0; g < groups->count; g += PIR_SCAN_LANES) {
        uint32_t open = open_groups(bounds, g, limit);
        if (!open)
            continue;
        if (bounds->cap_stamp[g / PIR_SCAN_LANES] != groups->stamp)
            make_caps(bounds, groups, g);
        double least =
            groups->scan->caps(g, PIR_SCAN_LANES, &bounds->caps, placement->x, placement->error, bounds->low);
        high = least < high ? least : high;
        // what a cap rules out now stays ruled out while the bodies move little
        for (uint32_t i = g; open; i++, open >>= 1)
            if ((open & 1) && bounds->low[i] > limit)
                pir_bounds_keep(bounds, groups, i, placement, bounds->low[i], -HUGE_VAL);
    }
    return high;
}

/* --- bounds from planes --- */

void pir_bounds_look(pir_bounds *bounds, pir_groups *groups, uint32_t g, const pir_placement *placement,
                     double *ret_low, double *ret_high) {
    pir_group_make(groups, g);
    const pir_group *group = &groups->at[g];
    const pir_planes *planes = groups->planes;
    uint32_t blocks = (group->count + PIR_SCAN_BLOCK - 1) / PIR_SCAN_BLOCK * PIR_SCAN_BLOCK;
    double least[3];
    groups->scan->look(blocks, pir_lanes_from(planes->n, group->start), planes->h + group->start,
                       planes->err + group->start, placement->x, placement->error, least);
    *ret_low = least[0];
    *ret_high = least[1];
    pir_bounds_keep(bounds, groups, g, placement, least[0], least[2]);
}
