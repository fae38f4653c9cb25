/* SPDX-License-Identifier: MIT */
/*
 * What a segment meets first. In the frame of a piece it is clipped by the planes of all facets, in doubles with a
 * bound on their error: that proves most hits and misses. What it leaves open, and pieces that are flat, are asked by a
 * pair of the segment as a polytope with the piece, whose answer is exact.
 */
#include "polytope/polytope.h"
#include "scene/query/probe.h"

/*
 * The slack of a facet at a point of the segment, in the piece's frame, is off by at most this times the sizes of
 * piece, origin and way, less the piece's translation: 8u for a unit normal, 40u for turning a point by a pose, with
 * u = 2^-53, twice each, and a few roundings.
 */
#define SLACK_ERROR 0x1p-45

/* The segment in the frame of a piece. */
struct segment {
    pir_vec3 from, way;
    double error; /* of a slack */
};

/* What clipping tells. */
typedef enum verdict { MISS, HIT, OPEN } verdict;

struct clip {
    verdict verdict;
    double enter, leave;
    uint32_t facet; /* by which it enters; UINT32_MAX where it begins inside */
};

struct ray {
    pir_scene *scene;
    pir_vec3 origin, way;
    uint32_t mask;
    pir_polytope *polytope; /* the segment from 0 to `way`, made when first needed */
};

static double length(pir_vec3 v) {
    return sqrt(pir_vec_dot(v, v));
}

static struct segment seen_by(const struct ray *ray, const pir_scene_body *body) {
    pir_vec3 away = pir_vec_sub(ray->origin, body->pose.translation);
    struct segment segment = {pir_pose_rotate_inverse(body->pose, away), pir_pose_rotate_inverse(body->pose, ray->way),
                              0};
    segment.error =
        SLACK_ERROR * (length(ray->origin) + length(body->pose.translation) + length(ray->way) + body->reach);
    return segment;
}

/* The part of the segment that is within all facets, and whether it is certain that there is one. */
static struct clip clip_by_facets(const pir_polytope *p, const struct segment *segment) {
    struct clip clip = {OPEN, 0, 1, UINT32_MAX};
    for (uint32_t f = 0; f < p->facet_count; f++) {
        double h = pir_vec_dot(p->normal[f], p->vertex[p->origin[p->loop[p->loop_start[f]]]]);
        double slack = h - pir_vec_dot(p->normal[f], segment->from), rate = -pir_vec_dot(p->normal[f], segment->way);
        // with the slack going from `slack` to slack + rate
        if (slack < -segment->error && slack + rate < -segment->error) {
            clip.verdict = MISS;
            return clip;
        }
        double at = rate != 0 ? -slack / rate : 0;
        if (rate > 0 && slack < 0 && at > clip.enter) {
            clip.enter = at;
            clip.facet = f;
        } else if (rate < 0 && slack + rate < 0 && at < clip.leave) {
            clip.leave = at;
        }
    }
    return clip;
}

/* Whether the point of the segment at `time` is inside of all facets for certain. */
static bool is_inside(const pir_polytope *p, const struct segment *segment, double time) {
    pir_vec3 x = pir_vec_add(segment->from, pir_vec_scale(segment->way, time));
    for (uint32_t f = 0; f < p->facet_count; f++) {
        pir_vec3 corner = p->vertex[p->origin[p->loop[p->loop_start[f]]]];
        if (!(pir_vec_dot(p->normal[f], pir_vec_sub(corner, x)) > 2 * segment->error))
            return false;
    }
    return true;
}

/* The state of the segment and the piece, exactly, with a point that they share where it is PIR_BOUNDARY. */
static pir_status ask(struct ray *ray, uint32_t piece, pir_query_result *ret_answer) {
    pir_scene *scene = ray->scene;
    if (!ray->polytope) {
        const pir_vec3 ends[2] = {{0, 0, 0}, ray->way};
        pir_polytope_options options = {&scene->allocator, 0};
        pir_status made = pir_polytope_create(ends, 2, &options, &ray->polytope);
        if (made != PIR_OK)
            return made;
    }
    pir_probe probe = {.scene = scene, .extent = {.polytope = ray->polytope}, .pose = {{0, 0, 0, 1}, ray->origin}};
    pir_pair *pair;
    pir_pair_input input;
    pir_status status = pir_probe_pair(&probe, piece, &pair, &input);
    input.radius_q = 0;
    if (status == PIR_OK)
        status = pir_pair_overlap(pair, scene->worker[0].workspace, &input, ret_answer);
    return status;
}

/* When a point of the segment is passed. */
static double time_of(const struct ray *ray, pir_vec3 point) {
    double square = pir_vec_dot(ray->way, ray->way);
    return square > 0 ? pir_vec_dot(pir_vec_sub(point, ray->origin), ray->way) / square : 0;
}

/* The impact on a piece, where there is one. */
static pir_status meet(struct ray *ray, uint32_t number, pir_scene_impact *impact) {
    const pir_scene_piece *piece = &ray->scene->bodies.piece[number];
    const pir_scene_body *body = &ray->scene->bodies.body[piece->body];
    struct segment segment = seen_by(ray, body);
    struct clip clip = clip_by_facets(piece->extent.polytope, &segment);
    if (clip.verdict == OPEN && piece->extent.polytope->dimension == 3 && clip.enter < clip.leave &&
        is_inside(piece->extent.polytope, &segment, 0.5 * (clip.enter + clip.leave)))
        clip.verdict = HIT;
    bool hits = clip.verdict == HIT;
    if (clip.verdict == OPEN) {
        pir_query_result answer;
        pir_status status = ask(ray, number, &answer);
        if (status != PIR_OK)
            return status;
        hits = answer.state != PIR_OUTSIDE;
        // a flat piece that the segment does not go through: planes do not bound what they share
        if (answer.state == PIR_BOUNDARY && piece->extent.polytope->dimension < 3)
            clip = (struct clip){HIT, time_of(ray, answer.point_q), 1, UINT32_MAX};
        clip.enter = fmin(fmax(clip.enter, 0), 1);
    }
    impact->body = hits ? piece->body : PIR_SCENE_NONE;
    impact->piece = piece->number;
    impact->time = clip.enter;
    impact->normal = (pir_vec3){0, 0, 0};
    if (clip.facet != UINT32_MAX)
        impact->normal = pir_pose_rotate(body->pose, piece->extent.polytope->normal[clip.facet]);
    impact->point = pir_vec_add(ray->origin, pir_vec_scale(ray->way, clip.enter));
    return PIR_OK;
}

/* Whether an impact comes before another, or there is no other. */
static bool comes_before(const pir_scene_impact *a, const pir_scene_impact *b) {
    if (a->body == PIR_SCENE_NONE || b->body == PIR_SCENE_NONE)
        return a->body != PIR_SCENE_NONE;
    if (a->time != b->time)
        return a->time < b->time;
    return a->body != b->body ? a->body < b->body : a->piece < b->piece;
}

/*
 * Whether the segment may meet a box, by axes of the box and its own, with twice the room that rounding needs. `to` is
 * how far along it the search still goes.
 */
static bool may_meet(const struct ray *ray, const pir_box *box, double to) {
    double from[3] = {ray->origin.x, ray->origin.y, ray->origin.z}, way[3] = {ray->way.x, ray->way.y, ray->way.z};
    double enter = 0, leave = to;
    for (int k = 0; k < 3; k++) {
        double room = 0x1p-40 * (fabs(from[k]) + fabs(way[k]) + fabs(box->low[k]) + fabs(box->high[k]));
        double low = box->low[k] - room - from[k], high = box->high[k] + room - from[k];
        if (fabs(way[k]) < 0x1p-900) {
            if (low > fabs(way[k]) || high < -fabs(way[k]))
                return false;
            continue;
        }
        double a = low / way[k], b = high / way[k];
        enter = fmax(enter, fmin(a, b) * (a > 0 && b > 0 ? 1 - 0x1p-40 : 1 + 0x1p-40));
        leave = fmin(leave, fmax(a, b) * (a > 0 || b > 0 ? 1 + 0x1p-40 : 1 - 0x1p-40));
    }
    return enter <= leave;
}

static pir_status search(struct ray *ray, pir_scene_impact *first) {
    const pir_tree *tree = &ray->scene->tree;
    pir_probe probe = {.scene = ray->scene, .body = PIR_SCENE_NONE, .mask = ray->mask, .except = PIR_SCENE_NONE};
    uint32_t n = tree->node ? tree->root : PIR_TREE_NONE;
    while (n != PIR_TREE_NONE) {
        double to = first->body == PIR_SCENE_NONE ? 1 : first->time * (1 + 0x1p-30);
        bool may = may_meet(ray, &tree->node[n].box, to);
        uint32_t piece = tree->node[n].child[1];
        if (may && tree->node[n].child[0] != PIR_TREE_NONE) {
            n = tree->node[n].child[0];
            continue;
        }
        if (may && pir_probe_meets(&probe, piece)) {
            pir_scene_impact impact;
            pir_status status = meet(ray, piece, &impact);
            if (status != PIR_OK)
                return status;
            impact.own_piece = 0;
            if (comes_before(&impact, first))
                *first = impact;
        }
        n = pir_tree_beyond(tree, n);
    }
    return PIR_OK;
}

pir_status pir_scene_ray(pir_scene *scene, pir_vec3 origin, pir_vec3 way, uint32_t mask, pir_scene_impact *ret_impact) {
    if (!scene || !ret_impact)
        return PIR_ERR_ARGUMENT;
    if (!pir_vec_is_finite(origin) || !pir_vec_is_finite(way))
        return PIR_ERR_NOT_FINITE;
    if (!(length(origin) <= PIR_BOX_FARTHEST && length(way) <= PIR_BOX_FARTHEST))
        return PIR_ERR_LIMIT;
    struct ray ray = {.scene = scene, .origin = origin, .way = way, .mask = mask};
    pir_scene_impact first = {.body = PIR_SCENE_NONE, .piece = PIR_SCENE_NONE, .time = 1};
    pir_status status = search(&ray, &first);
    // the pair holds the segment: it takes another polytope before that is freed
    pir_polytope_release(ray.polytope);
    if (status == PIR_OK)
        *ret_impact = first;
    return status;
}
