/* SPDX-License-Identifier: MIT */
/*
 * A call: P is looked at where it is; where it meets triangles, at the end of its way out; ghosts are left out; the
 * contacts that stand are put together by their normals, and each normal's points are reduced to those that hold the
 * greatest area.
 */
#include "base/scratch.h"
#include "mesh/contact/contact_facets.h"
#include "mesh/contact/ghost.h"
#include "mesh/contact/patch_points.h"
#include "mesh/contact/rounded_out.h"
#include "mesh/contact/way_out.h"

/* Normals of one call, at most, and how near to one another they count as one: this chooses points only. */
#define MOST_NORMALS 64
#define SAME_SQUARE  0x1p-60
/* Points of a normal. */
#define MOST_POINTS 4

pir_surface_contact_input pir_surface_contact_input_default(void) {
    return (pir_surface_contact_input){.pose = pir_pose_identity()};
}

/* A contact that stands: the triangle, and the gap where P is. */
struct standing {
    uint32_t triangle;
    double gap;
    pir_vec3 normal;
};

struct room {
    pir_contact_job job;
    pir_way_out out;
    struct standing standing[MOST_NORMALS]; /* by rising gap, one for each normal */
    uint32_t standing_count;
    pir_surface_contact *point; /* of the normal that is looked at */
    uint32_t point_count, point_room;
    pir_surface_contact chosen[MOST_NORMALS * MOST_POINTS]; /* of all normals, the deepest first */
    uint32_t chosen_count;
};

static void destroy_room(void *room, const pir_allocator *allocator) {
    struct room *r = room;
    pir_contact_job_finish(&r->job);
    PIR_FREE(allocator, r->point, r->point_room);
    PIR_FREE(allocator, r, 1);
}

/* --- which contacts stand --- */

static double gap_of(const struct room *room, const pir_near_triangle *s, pir_vec3 normal) {
    return s->near.distance - pir_vec_dot(normal, room->out.way) - room->job.input->radius;
}

static bool is_same(pir_vec3 a, pir_vec3 b) {
    pir_vec3 way = pir_vec_sub(a, b);
    return pir_vec_dot(way, way) < SAME_SQUARE;
}

/* Puts a contact in its place, unless one of its normal is there that is as near. */
static void insert(struct room *room, struct standing contact) {
    uint32_t count = 0;
    bool known = false;
    for (uint32_t i = 0; i < room->standing_count; i++) {
        const struct standing *other = &room->standing[i];
        bool same = is_same(other->normal, contact.normal);
        if (same && contact.gap < other->gap)
            continue;
        known |= same;
        room->standing[count++] = *other;
    }
    room->standing_count = count;
    if (known || (count == MOST_NORMALS && contact.gap >= room->standing[count - 1].gap))
        return;
    uint32_t at = count < MOST_NORMALS ? room->standing_count++ : count - 1;
    for (; at > 0 && room->standing[at - 1].gap > contact.gap; at--)
        room->standing[at] = room->standing[at - 1];
    room->standing[at] = contact;
}

/* Half of the radius, or of that at which P would touch. */
static double ball_of(const pir_contact_job *job) {
    double least = job->input->radius;
    for (uint32_t i = 0; i < job->triangle_count && least > 0; i++) {
        const pir_near_triangle *s = &job->triangle[i];
        if (s->counts && !s->near.meets)
            least = fmin(least, s->near.distance);
    }
    return 0.5 * least;
}

static void find_standing(struct room *room) {
    pir_contact_job *job = &room->job;
    room->standing_count = 0;
    job->ball = ball_of(job);
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        pir_near_triangle *s = &job->triangle[i];
        s->stands = false;
        if (!s->counts || s->near.meets)
            continue;
        pir_vec3 normal = pir_vec_scale(s->near.n, 1 / pir_length(s->near.n));
        double gap = gap_of(room, s, normal);
        if (!(gap <= job->input->margin))
            continue;
        job->counts.near++;
        s->stands = pir_contact_stands(job, room->out.t, i);
        if (s->stands)
            insert(room, (struct standing){i, gap, normal});
        else
            job->counts.ghosts++;
    }
}

/* --- points --- */

static uint64_t id_of(const pir_near_triangle *s, uint32_t feature) {
    uint64_t x = ((uint64_t)s->number << 32 | feature) + (uint64_t)s->surface * 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

static bool add_point(struct room *room, const pir_surface_contact *point) {
    if (room->point_count == room->point_room) {
        uint32_t more = room->point_room ? 2 * room->point_room : 64;
        pir_surface_contact *grown = PIR_RESIZE(&room->job.allocator, room->point, room->point_room, more);
        if (!grown)
            return false;
        room->point = grown;
        room->point_room = more;
    }
    room->point[room->point_count++] = *point;
    return true;
}

static pir_surface_contact contact_on(const struct room *room, const pir_near_triangle *s, pir_vec3 normal,
                                      pir_vec3 point, double distance, uint32_t feature) {
    return (pir_surface_contact){
        .point_p = pir_vec_add(point, pir_vec_scale(normal, distance)),
        .point_q = point,
        .normal = normal,
        .distance = distance,
        .surface = s->surface,
        .triangle = s->number,
        .material = pir_surface_material(room->job.input->surfaces[s->surface].surface, s->number),
        .id = id_of(s, feature),
    };
}

/* Adds the points of P's patch over one triangle; false when out of memory. */
static bool add_points(struct room *room, const pir_near_triangle *s, const pir_patch_frame *frame,
                       const pir_contact_patch *body) {
    const pir_contact_job *job = &room->job;
    pir_contact_patch patch;
    pir_patch_point points[PIR_PATCH_POINTS];
    pir_patch_of_triangle(frame, s, &patch);
    uint32_t count = pir_patch_meet(body, &patch, points);
    double moved = pir_vec_dot(frame->n, room->out.way) + job->input->radius, least = -0x1p-30 * job->size;
    for (uint32_t i = 0; i < count; i++) {
        double apart = points[i].height_p - points[i].height_q, distance = apart - moved;
        if (!(distance <= job->input->margin) || apart < least)
            continue;
        pir_vec3 across =
            pir_vec_add(pir_vec_scale(frame->u, points[i].at[0]), pir_vec_scale(frame->v, points[i].at[1]));
        pir_vec3 point = pir_vec_add(across, pir_vec_scale(frame->n, points[i].height_q));
        pir_surface_contact contact = contact_on(room, s, frame->n, point, distance, points[i].id);
        if (!add_point(room, &contact))
            return false;
    }
    return true;
}

/* All points of a normal, the nearest ones first of all. */
static bool collect_points(struct room *room, const struct standing *standing) {
    const pir_contact_job *job = &room->job;
    const pir_patch_frame frame = pir_patch_frame_of(standing->normal);
    const pir_near_triangle *own = &job->triangle[standing->triangle];
    pir_contact_patch body;
    pir_patch_of_body(job, &frame, room->out.t, &body);
    room->point_count = 0;
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        const pir_near_triangle *s = &job->triangle[i];
        if (!s->counts || (s->one_sided && pir_vec_dot(frame.n, s->front) < -0x1p-30))
            continue;
        if (!add_points(room, s, &frame, &body))
            return false;
    }
    uint32_t feature = 3u << 30 | own->near.simplex.v[0] << 4 | own->near.simplex.w[0];
    pir_surface_contact nearest = contact_on(room, own, standing->normal, own->near.point, standing->gap, feature);
    return room->point_count > 0 || add_point(room, &nearest);
}

static pir_vec3 between(const struct room *room, uint32_t a, uint32_t b) {
    return pir_vec_sub(room->point[b].point_q, room->point[a].point_q);
}

static void bring(struct room *room, uint32_t from, uint32_t to) {
    pir_surface_contact point = room->point[from];
    room->point[from] = room->point[to];
    room->point[to] = point;
}

/* The point with the greatest measure, which is above 0, is brought to a place; false where there is none. */
static bool choose(struct room *room, uint32_t to, double (*measure)(const struct room *room, uint32_t i)) {
    uint32_t best = UINT32_MAX;
    double most = 0x1p-80 * room->job.size * room->job.size;
    for (uint32_t i = to; i < room->point_count; i++) {
        double size = measure(room, i);
        best = size > most ? i : best;
        most = fmax(most, size);
    }
    if (best != UINT32_MAX)
        bring(room, best, to);
    return best != UINT32_MAX;
}

static double square_from_first(const struct room *room, uint32_t i) {
    pir_vec3 way = between(room, 0, i);
    return pir_vec_dot(way, way);
}

static double area_about(const struct room *room, uint32_t i) {
    return pir_vec_dot(room->point[0].normal, pir_vec_cross(between(room, 0, 1), between(room, 0, i)));
}

static double area_either(const struct room *room, uint32_t i) {
    return fabs(area_about(room, i));
}

/* How much area a point adds to a triangle of three: beyond the side that it is farthest outside of. */
static double area_added(const struct room *room, uint32_t i) {
    double side = area_about(room, 2) > 0 ? 1 : -1, most = 0;
    pir_vec3 n = room->point[0].normal;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t next = (k + 1) % 3;
        double out = -side * pir_vec_dot(n, pir_vec_cross(between(room, k, next), between(room, k, i)));
        most = fmax(most, out);
    }
    return most;
}

/* Leaves the points that hold the greatest area, the deepest among them. */
static void reduce_points(struct room *room) {
    uint32_t deepest = 0;
    for (uint32_t i = 1; i < room->point_count; i++)
        if (room->point[i].distance < room->point[deepest].distance)
            deepest = i;
    bring(room, deepest, 0);
    double (*const measure[MOST_POINTS])(const struct room *, uint32_t) = {NULL, square_from_first, area_either,
                                                                           area_added};
    uint32_t count = 1;
    while (count < MOST_POINTS && choose(room, count, measure[count]))
        count++;
    room->point_count = count;
}

/* Puts a point behind those that are as deep. */
static void choose_point(struct room *room, const pir_surface_contact *point) {
    uint32_t at = room->chosen_count++;
    for (; at > 0 && room->chosen[at - 1].distance > point->distance; at--)
        room->chosen[at] = room->chosen[at - 1];
    room->chosen[at] = *point;
}

static pir_status choose_points(struct room *room) {
    room->chosen_count = 0;
    for (uint32_t i = 0; i < room->standing_count; i++) {
        if (!collect_points(room, &room->standing[i]))
            return PIR_ERR_MEMORY;
        reduce_points(room);
        for (uint32_t k = 0; k < room->point_count; k++)
            choose_point(room, &room->point[k]);
    }
    return PIR_OK;
}

/* --- the state --- */

/* The state of P where it is; it has been looked at. */
static pir_state state_of(pir_contact_job *job, bool meets) {
    double radius = job->input->radius, least = HUGE_VAL;
    if (meets && radius > 0)
        return PIR_INSIDE;
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        const pir_near_triangle *s = &job->triangle[i];
        if (!s->counts)
            continue;
        if (!s->near.meets)
            least = fmin(least, s->near.distance);
        else if (pir_contact_overlaps(job, job->input->pose.translation, s))
            return PIR_INSIDE;
    }
    if (meets)
        return PIR_BOUNDARY;
    return radius == 0 || least > radius ? PIR_OUTSIDE : least < radius ? PIR_INSIDE : PIR_BOUNDARY;
}

/* All but the way out, and what follows from it. */
static void set_result(const struct room *room, pir_state state, size_t most, pir_surface_contact_result *result) {
    const pir_contact_job *job = &room->job;
    *result = (pir_surface_contact_result){.state = state,
                                           .distance = HUGE_VAL,
                                           .surface = UINT32_MAX,
                                           .triangle = PIR_TRIANGLE_NONE,
                                           .contacts = room->chosen_count < most ? room->chosen_count : most,
                                           .counts = job->counts};
    if (room->standing_count > 0) {
        const struct standing *nearest = &room->standing[0];
        const pir_near_triangle *s = &job->triangle[nearest->triangle];
        result->distance = nearest->gap;
        result->normal = nearest->normal;
        result->point_q = s->near.point;
        result->surface = s->surface;
        result->triangle = s->number;
    }
}

static void set_way_out(const struct room *room, bool meets, pir_surface_contact_result *result) {
    result->way_out = room->out.way;
    result->is_out = room->out.is_out;
    result->is_shortest = room->out.is_shortest;
    if (result->state == PIR_INSIDE)
        result->distance = -room->out.depth;
    else if (meets)
        result->distance = 0;
    if (room->standing_count > 0)
        result->point_p = pir_vec_add(result->point_q, pir_vec_scale(result->normal, result->distance));
}

static pir_status run(struct room *room, size_t most, pir_surface_contact *contacts,
                      pir_surface_contact_result *ret_result) {
    pir_contact_job *job = &room->job;
    pir_vec3 t = job->input->pose.translation;
    pir_surface_contact_result result;
    bool meets = pir_contact_look(job, t);
    pir_state state = state_of(job, meets);
    pir_status status = PIR_OK;
    room->out = (pir_way_out){.t = t, .is_out = true, .is_shortest = true};
    if (meets) {
        status = pir_contact_find_way_out(job, &room->out);
        if (status != PIR_OK)
            return status;
        (void)pir_contact_look(job, room->out.t);
    }
    find_standing(room);
    status = choose_points(room);
    if (status != PIR_OK)
        return status;
    set_result(room, state, most, &result);
    if (state == PIR_INSIDE && job->input->radius > 0)
        status = pir_contact_find_rounded_way_out(job, &room->out);
    if (status != PIR_OK)
        return status;
    set_way_out(room, meets, &result);
    for (size_t i = 0; i < result.contacts; i++)
        contacts[i] = room->chosen[i];
    *ret_result = result;
    return PIR_OK;
}

pir_status pir_surface_contacts(const pir_polytope *p, pir_workspace *workspace, const pir_surface_contact_input *input,
                                size_t most, pir_surface_contact *ret_contacts,
                                pir_surface_contact_result *ret_result) {
    if (!p || !workspace || !input || !ret_result || (!ret_contacts && most > 0))
        return PIR_ERR_ARGUMENT;
    pir_scratch *scratch = ((pir_workspace_head *)workspace)->scratch;
    struct room *room = pir_scratch_room(scratch, PIR_ROOM_SURFACE, sizeof *room, destroy_room);
    if (!room)
        return PIR_ERR_MEMORY;
    room->job.allocator = scratch->allocator;
    pir_status status = pir_contact_job_begin(&room->job, p, input, input->margin + input->radius);
    return status == PIR_OK ? run(room, most, ret_contacts, ret_result) : status;
}
