/* SPDX-License-Identifier: MIT */
/*
 * A segment clipped by half-spaces in doubles (Cyrus and Beck, 1978), with the interval in which each crossing is. The
 * slack of a half-space goes from s0 at the begin to s1 at the end, both within the segment's error e. With s1 above e
 * and s0 not, the segment enters at −s0 / (s1 − s0), which the errors move by at most e / (s1 − s0).
 */
#ifndef PIR_SCENE_QUERY_RAY_CLIP_H
#define PIR_SCENE_QUERY_RAY_CLIP_H

#include "scene/query/ray.h"

/* An entry known no better than this is left to the integers. */
#define PIR_RAY_GOOD_ENOUGH 0x1p-41

/* Bounds on the times at which the segment is within all half-spaces so far. */
typedef struct pir_ray_clip {
    bool misses, open;
    double enter_low, enter_high, leave_low, leave_high;
    double time;    /* of the last entry, by doubles */
    uint32_t facet; /* and its half-space; UINT32_MAX where there is none yet */
} pir_ray_clip;

static const pir_ray_clip pir_ray_unclipped = {false, false, -HUGE_VAL, -HUGE_VAL, HUGE_VAL, HUGE_VAL, 0, UINT32_MAX};

static inline void pir_ray_clip_by(pir_ray_clip *clip, const pir_ray_segment *segment, pir_vec3 normal, pir_vec3 corner,
                                   uint32_t facet) {
    const double e = segment->error, s0 = pir_vec_dot(normal, pir_vec_sub(corner, segment->from)),
                 s1 = s0 - pir_vec_dot(normal, segment->way), span = fabs(s1 - s0);
    if (s0 > e && s1 > e)
        return;
    if (s0 < -e && s1 < -e) {
        clip->misses = true;
    } else if (s1 > e) {
        double at = -s0 / span;
        clip->enter_low = pir_greater(clip->enter_low, at - 1.5 * e / span);
        clip->enter_high = pir_greater(clip->enter_high, at + 1.5 * e / span);
        if (clip->facet == UINT32_MAX || at > clip->time) {
            clip->facet = facet;
            clip->time = at;
        }
    } else if (s0 > e) {
        double at = s0 / span;
        clip->leave_low = pir_lesser(clip->leave_low, at - 1.5 * e / span);
        clip->leave_high = pir_lesser(clip->leave_high, at + 1.5 * e / span);
    } else {
        clip->open = true;
    }
}

/* Whether a clip without doubt misses. */
static inline bool pir_ray_clip_misses(const pir_ray_clip *clip) {
    return clip->misses || clip->enter_low > pir_lesser(clip->leave_high, 1) || clip->leave_high < 0;
}

/*
 * Where the segment crosses a polygon: its plane, clipped by both of its sides, and the walls along its edges. False
 * where doubles do not tell; `normal` is that of the side which is met.
 */
static inline bool pir_ray_crosses(const pir_ray_clip *plane, const pir_ray_clip *walls, pir_vec3 normal,
                                   pir_entry *ret_entry) {
    if (plane->misses || pir_ray_clip_misses(walls)) {
        *ret_entry = (pir_entry){.hits = false, .time = 1};
        return true;
    }
    // the plane has to be crossed between the ends
    if (plane->open || walls->open || plane->facet == UINT32_MAX || !(plane->enter_low > 0 && plane->enter_high < 1) ||
        plane->enter_high - plane->enter_low > PIR_RAY_GOOD_ENOUGH)
        return false;
    const bool before = plane->enter_high<walls->enter_low, after = plane->enter_low> walls->leave_high;
    const bool within = plane->enter_low > walls->enter_high && plane->enter_high < walls->leave_low;
    *ret_entry = (pir_entry){.hits = within, .time = plane->time, .normal = normal, .side = plane->facet == 0 ? 1 : -1};
    return before || after || within;
}

#endif
