/* SPDX-License-Identifier: MIT */
/*
 * A segment clipped by half-spaces in doubles (Cyrus and Beck, 1978), with the interval in which each crossing is. The
 * slack of a half-space goes from s0 at the begin to s1 at the end, both within the segment's error e. With s1 above e
 * and s0 not, the segment enters at −s0 / (s1 − s0), which the errors move by at most e / (s1 − s0).
 */
#include "scene/query/ray.h"

/* An entry known no better than this is left to the integers. */
#define GOOD_ENOUGH 0x1p-42

/* Bounds on the times at which the segment is within all half-spaces so far. */
struct ray_clip {
    bool misses, open;
    double enter_low, enter_high, leave_low, leave_high;
    double time;    /* of the last entry, by doubles */
    uint32_t facet; /* and its half-space; UINT32_MAX where there is none yet */
};

static const struct ray_clip unclipped = {false, false, -HUGE_VAL, -HUGE_VAL, HUGE_VAL, HUGE_VAL, 0, UINT32_MAX};

static void clip_by(struct ray_clip *clip, const pir_ray_segment *segment, pir_vec3 normal, pir_vec3 corner,
                    uint32_t facet) {
    const double e = segment->error, s0 = pir_vec_dot(normal, pir_vec_sub(corner, segment->from)),
                 s1 = s0 - pir_vec_dot(normal, segment->way), span = fabs(s1 - s0);
    if (s0 > e && s1 > e)
        return;
    if (s0 < -e && s1 < -e) {
        clip->misses = true;
    } else if (s1 > e) {
        double at = -s0 / span;
        clip->enter_low = fmax(clip->enter_low, at - 1.5 * e / span);
        clip->enter_high = fmax(clip->enter_high, at + 1.5 * e / span);
        if (clip->facet == UINT32_MAX || at > clip->time) {
            clip->facet = facet;
            clip->time = at;
        }
    } else if (s0 > e) {
        double at = s0 / span;
        clip->leave_low = fmin(clip->leave_low, at - 1.5 * e / span);
        clip->leave_high = fmin(clip->leave_high, at + 1.5 * e / span);
    } else {
        clip->open = true;
    }
}

/* Whether a clip without doubt misses. */
static bool misses(const struct ray_clip *clip) {
    return clip->misses || clip->enter_low > fmin(clip->leave_high, 1) || clip->leave_high < 0;
}

/* A polygon is met where its plane is crossed, if that is within its sides. */
static bool cross_polygon(const pir_polytope *p, const pir_ray_segment *segment, pir_entry *entry) {
    struct ray_clip plane = unclipped, sides = unclipped;
    const pir_vec3 corner = pir_facet_corner(p, 0);
    uint32_t side = pir_vec_dot(p->normal[0], segment->way) < 0 ? 0 : 1;
    clip_by(&plane, segment, p->normal[side], corner, side);
    for (uint32_t i = p->loop_start[0]; i < p->loop_start[1] && !plane.misses && !sides.misses; i++)
        clip_by(&sides, segment, pir_wall_normal(p, 0, p->loop[i]), p->vertex[p->origin[p->loop[i]]], 0);
    if (plane.misses || misses(&sides)) {
        *entry = (pir_entry){.hits = false, .time = 1};
        return true;
    }
    // the plane has to be crossed between the ends
    if (plane.open || sides.open || plane.facet == UINT32_MAX || !(plane.enter_low > 0 && plane.enter_high < 1) ||
        plane.enter_high - plane.enter_low > GOOD_ENOUGH)
        return false;
    bool before = plane.enter_high<sides.enter_low, after = plane.enter_low> sides.leave_high;
    bool within = plane.enter_low > sides.enter_high && plane.enter_high < sides.leave_low;
    *entry = (pir_entry){.hits = within, .time = plane.time, .normal = p->normal[side]};
    return before || after || within;
}

static bool enter_body(const pir_polytope *p, const pir_ray_segment *segment, pir_entry *entry) {
    struct ray_clip clip = unclipped;
    for (uint32_t f = 0; f < p->facet_count && !clip.misses; f++)
        clip_by(&clip, segment, p->normal[f], pir_facet_corner(p, f), f);
    if (misses(&clip)) {
        *entry = (pir_entry){.hits = false, .time = 1};
        return true;
    }
    if (clip.open || !(clip.enter_high < clip.leave_low && clip.leave_low > 0))
        return false;
    if (clip.enter_high < 0 || clip.facet == UINT32_MAX) {
        *entry = (pir_entry){true, true, 0, p->normal[pir_least_facet(p, segment->from)]};
        return true;
    }
    *entry = (pir_entry){true, false, clip.time, p->normal[clip.facet]};
    return clip.enter_low > 0 && clip.enter_high < 1 && clip.enter_high - clip.enter_low <= GOOD_ENOUGH;
}

bool pir_ray_by_doubles(const pir_polytope *p, const pir_ray_segment *segment, pir_entry *ret_entry) {
    return p->dimension == 3   ? enter_body(p, segment, ret_entry)
           : p->dimension == 2 ? cross_polygon(p, segment, ret_entry)
                               : false;
}
