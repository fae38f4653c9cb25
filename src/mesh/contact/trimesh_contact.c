/* SPDX-License-Identifier: MIT */
/*
 * A call: P is looked at where it is; where it meets triangles, at the end of its way out; ghosts are left out; the
 * contacts that stand are put together by their normals, and each normal's points are reduced to those that hold the
 * greatest area.
 */
#include "base/scratch.h"
#include "mesh/contact/contact_facets.h"
#include "mesh/contact/contact_id.h"
#include "mesh/contact/rounded_out.h"

/* Points of a normal. */
#define MOST_POINTS 4
/* Heights and depths this near to one another, by the size of what is near P, are one: this chooses points only. */
#define LEVEL 0x1p-30
/* Ways whose lengths differ by no more, by their size, are as long: what roundings leave open, many times. */
#define SAME_WAY 0x1p-38
/* How much deeper than all points of a normal its nearest contact has to be to be one more, by that size. */
#define DEEPER 0x1p-40

pir_surface_contact_input pir_surface_contact_input_default(void) {
    return (pir_surface_contact_input){.pose = pir_pose_identity()};
}

/* A point of a normal. */
struct normal_point {
    pir_vec3 q; /* on the triangle, or in its plane */
    double distance;
    uint32_t triangle;
    pir_contact_feature feature;
};

struct room {
    pir_contact_job job;
    pir_way_out out;
    bool stuck; /* no way out of what P meets was found */
    pir_standings standings;
    struct normal_point *point; /* of the normal that is looked at */
    uint32_t point_count, point_room;
    pir_vec3 normal;
    pir_surface_contact chosen[PIR_CONTACT_NORMALS * MOST_POINTS]; /* of all normals, the deepest first */
    uint32_t chosen_count;
};

static void destroy_room(void *room, const pir_allocator *allocator) {
    struct room *r = room;
    pir_contact_job_finish(&r->job);
    PIR_FREE(allocator, r->point, r->point_room);
    PIR_FREE(allocator, r, 1);
}

/* --- points --- */

static bool add_point(struct room *room, struct normal_point point) {
    if (room->point_count == room->point_room) {
        uint32_t more = room->point_room ? 2 * room->point_room : 64;
        struct normal_point *grown = PIR_RESIZE(&room->job.allocator, room->point, room->point_room, more);
        if (!grown)
            return false;
        room->point = grown;
        room->point_room = more;
    }
    room->point[room->point_count++] = point;
    return true;
}

/* A normal, along which all triangles are looked at. */
struct normal_view {
    pir_patch_frame frame;
    pir_contact_patch body; /* P's part that faces against it */
    double low;             /* the height of P's lowest vertex */
    double moved;           /* how much less a distance is than heights are apart */
    double least;           /* how far apart heights are at least */
};

/* Adds the points of P's patch over one triangle; false when out of memory. */
static bool add_points(struct room *room, uint32_t index, const struct normal_view *view) {
    const pir_contact_job *job = &room->job;
    const pir_near_triangle *s = &job->triangle[index];
    const pir_patch_frame *frame = &view->frame;
    pir_contact_patch patch;
    pir_patch_point points[PIR_PATCH_POINTS];
    pir_patch_of_triangle(frame, s, &patch);
    uint32_t count = pir_patch_meet(&view->body, &patch, points);
    for (uint32_t i = 0; i < count; i++) {
        double apart = points[i].height_p - points[i].height_q, distance = apart - view->moved;
        if (!(distance <= job->input->margin) || apart < view->least)
            continue;
        pir_vec3 across =
            pir_vec_add(pir_vec_scale(frame->u, points[i].at[0]), pir_vec_scale(frame->v, points[i].at[1]));
        pir_vec3 point = pir_vec_add(across, pir_vec_scale(frame->n, points[i].height_q));
        if (!add_point(room, (struct normal_point){point, distance, index, points[i].feature}))
            return false;
    }
    return true;
}

/* Whether a triangle may have points of a normal: it is not too far below P along it. */
static bool may_have_points(const struct room *room, const pir_near_triangle *s, const struct normal_view *view) {
    const pir_vec3 n = view->frame.n;
    if (!s->counts || (s->one_sided && pir_vec_dot(n, s->front) < -LEVEL) ||
        (room->stuck && !s->near.meets && !s->passed))
        return false;
    const double high =
        pir_greater(pir_vec_dot(n, s->p[0]), pir_greater(pir_vec_dot(n, s->p[1]), pir_vec_dot(n, s->p[2])));
    return view->low - high - view->moved <= room->job.input->margin + LEVEL * room->job.size;
}

static void set_view(const struct room *room, pir_vec3 normal, struct normal_view *ret_view) {
    const pir_contact_job *job = &room->job;
    ret_view->frame = pir_patch_frame_of(normal);
    ret_view->moved = pir_vec_dot(normal, room->out.way) + job->input->radius;
    ret_view->least = room->stuck ? -HUGE_VAL : -LEVEL * job->size;
    const uint32_t lowest = pir_contact_lowest(job, normal);
    ret_view->low = pir_vec_dot(normal, job->vertex[lowest]) + pir_vec_dot(normal, room->out.t);
    pir_patch_of_body(job, &ret_view->frame, room->out.t, lowest, &ret_view->body);
}

/* Takes out the points that are at a place; whether there are any. */
static bool drop_points_at(struct room *room, pir_vec3 at) {
    const double near = LEVEL * room->job.size;
    const uint32_t before = room->point_count;
    room->point_count = 0;
    for (uint32_t i = 0; i < before; i++)
        if (!(pir_length(pir_vec_sub(room->point[i].q, at)) <= near))
            room->point[room->point_count++] = room->point[i];
    return room->point_count < before;
}

/*
 * All points of a normal. Its nearest contact is one of them where no other one is as deep, and where it is at an end
 * of an edge of P, which else is now a crossing and now none, by rounding.
 */
static bool collect_points(struct room *room, const pir_standing *standing, const struct normal_view *view) {
    double least = HUGE_VAL;
    room->normal = standing->normal;
    room->point_count = 0;
    for (uint32_t i = 0; i < room->job.triangle_count; i++)
        if (may_have_points(room, &room->job.triangle[i], view) && !add_points(room, i, view))
            return false;
    for (uint32_t i = 0; i < room->point_count; i++)
        least = pir_lesser(least, room->point[i].distance);
    const pir_contact_feature feature = pir_contact_feature_of(&standing->simplex);
    const bool is_end = view->body.count == 2 && feature.p[0] == feature.p[1];
    const bool is_there = is_end && drop_points_at(room, standing->point);
    if (!is_there && least <= standing->gap + DEEPER * room->job.size)
        return true;
    return add_point(room, (struct normal_point){standing->point, standing->gap, standing->triangle, feature});
}

static pir_vec3 between(const struct room *room, uint32_t a, uint32_t b) {
    return pir_vec_sub(room->point[b].q, room->point[a].q);
}

static void bring(struct room *room, uint32_t from, uint32_t to) {
    struct normal_point point = room->point[from];
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
        most = pir_greater(most, size);
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
    return pir_vec_dot(room->normal, pir_vec_cross(between(room, 0, 1), between(room, 0, i)));
}

static double area_either(const struct room *room, uint32_t i) {
    return fabs(area_about(room, i));
}

/* How much area a point adds to a triangle of three: beyond the side that it is farthest outside of. */
static double area_added(const struct room *room, uint32_t i) {
    double side = area_about(room, 2) > 0 ? 1 : -1, most = 0;
    pir_vec3 n = room->normal;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t next = (k + 1) % 3;
        double out = -side * pir_vec_dot(n, pir_vec_cross(between(room, k, next), between(room, k, i)));
        most = pir_greater(most, out);
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

/* Whether a contact that was chosen has a number. */
static bool has_id(const struct room *room, uint64_t id) {
    for (uint32_t i = 0; i < room->chosen_count; i++)
        if (room->chosen[i].id == id)
            return true;
    return false;
}

/* Puts a contact behind those that are as deep. */
static void choose_point(struct room *room, const struct normal_point *point, pir_normal_name of) {
    const pir_near_triangle *s = &room->job.triangle[point->triangle];
    uint64_t id = pir_contact_id(&room->job, s, &point->feature, room->normal, of);
    while (has_id(room, id))
        id++;
    uint32_t at = room->chosen_count++;
    for (; at > 0 && room->chosen[at - 1].distance > point->distance; at--)
        room->chosen[at] = room->chosen[at - 1];
    room->chosen[at] = (pir_surface_contact){
        .point_p = pir_vec_add(point->q, pir_vec_scale(room->normal, point->distance)),
        .point_q = point->q,
        .normal = room->normal,
        .distance = point->distance,
        .surface = s->surface,
        .triangle = s->number,
        .material = pir_surface_material(room->job.input->surfaces[s->surface].surface, s->number),
        .id = id,
    };
}

static pir_status choose_points(struct room *room) {
    room->chosen_count = 0;
    for (uint32_t i = 0; i < room->standings.count; i++) {
        const pir_standing *standing = &room->standings.at[i];
        struct normal_view view;
        set_view(room, standing->normal, &view);
        if (!collect_points(room, standing, &view))
            return PIR_ERR_MEMORY;
        reduce_points(room);
        const pir_normal_name of = pir_contact_normal_name(&room->job, standing, &view.body);
        for (uint32_t k = 0; k < room->point_count; k++)
            choose_point(room, &room->point[k], of);
    }
    return PIR_OK;
}

/* --- the state --- */

/* The state of P where it is; it has been looked at. */
static pir_state state_of(pir_contact_job *job, bool meets) {
    const double radius = job->input->radius;
    const pir_near_triangle *nearest = pir_contact_nearest_of(job);
    if (meets && radius > 0)
        return PIR_INSIDE;
    // most that is overlapped is certain to be so, which saves integers for what is only touched
    for (int exactly = 0; exactly < 2 && meets; exactly++)
        for (uint32_t i = 0; i < job->triangle_count; i++) {
            const pir_near_triangle *s = &job->triangle[i];
            if (s->counts && s->near.meets && pir_contact_overlaps(job, job->input->pose.translation, s, exactly))
                return PIR_INSIDE;
        }
    if (meets)
        return PIR_BOUNDARY;
    if (radius == 0 || !nearest || nearest->near.distance > radius)
        return PIR_OUTSIDE;
    return nearest->near.distance < radius ? PIR_INSIDE : PIR_BOUNDARY;
}

/* --- the result --- */

static void set_nearest(const pir_near_triangle *s, const pir_standing *contact, pir_surface_contact_result *result) {
    result->normal = contact->normal;
    result->distance = contact->gap;
    result->point_q = contact->point;
    result->point_p = pir_vec_add(contact->point, pir_vec_scale(contact->normal, contact->gap));
    result->surface = s->surface;
    result->triangle = s->number;
}

/* The nearest triangle where P is apart from all, or overlaps them with its ball alone. */
static void set_apart(pir_contact_job *job, pir_surface_contact_result *result) {
    const pir_near_triangle *s = pir_contact_nearest_of(job);
    if (!s || s->near.distance - job->input->radius > job->input->margin)
        return;
    const pir_standing contact = {.gap = s->near.distance - job->input->radius,
                                  .normal = pir_vec_scale(s->near.n, 1 / pir_length(s->near.n)),
                                  .point = s->near.point};
    set_nearest(s, &contact, result);
}

/* The deepest contact, where no way out was found; what is touched where P does no more than that. */
static void set_deepest(struct room *room, pir_surface_contact_result *result) {
    const pir_surface_contact *deepest = &room->chosen[0];
    const pir_vec3 t = room->job.input->pose.translation;
    pir_standing contact;
    if (result->state == PIR_BOUNDARY && pir_contact_find_touch(&room->job, t, &contact))
        set_nearest(&room->job.triangle[contact.triangle], &contact, result);
    if (result->state == PIR_BOUNDARY || room->chosen_count == 0 || deepest->distance > 0)
        return;
    result->normal = deepest->normal;
    result->distance = deepest->distance;
    result->point_q = deepest->point_q;
    result->point_p = deepest->point_p;
    result->surface = deepest->surface;
    result->triangle = deepest->triangle;
}

/*
 * Of P that overlaps where no contact says so: at the end of its way P is behind every triangle. As deep as its way is
 * long; its point is the one that is last to leave.
 */
static void set_way(const struct room *room, pir_surface_contact_result *result) {
    const pir_contact_job *job = &room->job;
    const double length = pir_length(room->out.way);
    result->distance = -pir_greater(room->out.depth, 0);
    if (!(length > 0))
        return;
    result->normal = pir_vec_scale(room->out.way, 1 / length);
    result->distance = -length;
    const pir_vec3 low = job->vertex[pir_contact_lowest(job, result->normal)];
    const pir_vec3 own = pir_vec_sub(low, pir_vec_scale(result->normal, job->input->radius));
    result->point_p = pir_vec_add(own, job->input->pose.translation);
    result->point_q = pir_vec_add(result->point_p, room->out.way);
}

/*
 * The contact of the way out: P moved by −distance · normal touches the nearest triangle at its end, and meets no
 * other, for all others are as far from that end at least.
 */
static void set_own_contact(struct room *room, pir_surface_contact_result *result) {
    pir_contact_job *job = &room->job;
    pir_contact_prove_all(job, room->out.t);
    const pir_near_triangle *s = pir_contact_nearest_of(job);
    result->way_out = room->out.way;
    if (!s) {
        if (result->state == PIR_BOUNDARY)
            set_deepest(room, result);
        else
            set_way(room, result);
        return;
    }
    const pir_vec3 n = pir_vec_scale(s->near.n, 1 / pir_length(s->near.n)), t = job->input->pose.translation;
    const double gap = s->near.distance - job->input->radius;
    const bool touches = gap <= 2 * pir_contact_step(job); // else P is held off by what it is behind of
    const pir_vec3 move = pir_vec_sub(room->out.way, pir_vec_scale(n, touches ? gap : 0));
    const double along = pir_vec_dot(move, n), length = pir_length(move), level = LEVEL * job->size;
    pir_standing contact = {.gap = -pir_greater(along, 0), .normal = n, .point = s->near.point};
    if (!touches)
        contact.point = pir_vec_add(contact.point, pir_vec_scale(n, gap));
    if (result->state == PIR_BOUNDARY) {
        contact.gap = 0;
        // what P touches may not be what it leaves last
        if (length > level && pir_contact_look(job, t) && pir_contact_find_touch(job, t, &contact))
            s = &job->triangle[contact.triangle];
    } else if (pir_length(pir_vec_sub(move, pir_vec_scale(n, along))) > level) {
        contact.gap = -length;
        contact.normal = pir_vec_scale(move, 1 / length);
    }
    set_nearest(s, &contact, result);
    // another triangle within the step may stand higher than the one that P leaves
    result->is_shortest &= length <= room->out.depth + SAME_WAY * job->size;
}

/* The contacts of P, which was looked at where the input has it. */
static pir_status find_contacts(struct room *room, bool meets) {
    pir_contact_job *job = &room->job;
    const pir_vec3 t = job->input->pose.translation;
    pir_status status = PIR_OK;
    room->out = (pir_way_out){.t = t, .is_out = true, .is_shortest = true};
    if (meets)
        status = pir_contact_find_way_out(job, &room->out);
    if (status != PIR_OK)
        return status;
    room->stuck = !room->out.is_out;
    if (room->stuck) {
        room->out = (pir_way_out){.t = t};
        (void)pir_contact_look(job, t);
        pir_contact_find_stuck(job, &room->standings);
    } else if (!pir_contact_find_standings(job, &room->out, &room->standings))
        return PIR_ERR_MEMORY;
    return choose_points(room);
}

/* Gathers the triangles, and looks at P where it is: whether it meets any, its state, and what is nearest. */
static pir_status look_where_it_is(struct room *room, bool *ret_meets, pir_surface_contact_result *result) {
    pir_contact_job *job = &room->job;
    pir_status status = pir_contact_job_gather_first(job);
    if (status != PIR_OK)
        return status;
    const bool meets = pir_contact_look_first(job);
    if (!meets)
        pir_contact_prove_all(job, job->input->pose.translation);
    result->state = state_of(job, meets);
    if (!meets)
        set_apart(job, result);
    *ret_meets = meets;
    return PIR_OK;
}

static pir_status run(struct room *room, size_t most, pir_surface_contact *contacts,
                      pir_surface_contact_result *ret_result) {
    pir_contact_job *job = &room->job;
    pir_surface_contact_result result = {.distance = HUGE_VAL,
                                         .surface = UINT32_MAX,
                                         .triangle = PIR_TRIANGLE_NONE,
                                         .is_out = true,
                                         .is_shortest = true};
    bool meets;
    pir_status status = look_where_it_is(room, &meets, &result);
    if (status == PIR_OK && job->list && result.state != PIR_OUTSIDE) {
        // the list is of what is within the margin: ways out go farther
        job->list = NULL;
        status = look_where_it_is(room, &meets, &result);
    }
    if (status != PIR_OK)
        return status;
    if (!meets && result.state != PIR_INSIDE)
        pir_contact_keep_within(job, job->input->margin + job->input->radius);
    status = find_contacts(room, meets);
    if (status == PIR_OK && result.state == PIR_INSIDE && job->input->radius > 0)
        status = pir_contact_find_rounded_way_out(job, &room->out);
    if (status != PIR_OK)
        return status;
    result.is_out = room->out.is_out;
    result.is_shortest = room->out.is_shortest;
    if ((meets || result.state == PIR_INSIDE) && room->out.is_out)
        set_own_contact(room, &result);
    else if (meets || result.state == PIR_INSIDE)
        set_deepest(room, &result);
    if (result.state == PIR_INSIDE && !(result.distance <= 0))
        set_way(room, &result);
    result.contacts = room->chosen_count < most ? room->chosen_count : most;
    result.counts = job->counts;
    for (size_t i = 0; i < result.contacts; i++)
        contacts[i] = room->chosen[i];
    *ret_result = result;
    return PIR_OK;
}

pir_status pir_surface_contacts(const pir_polytope *p, pir_workspace *workspace, const pir_surface_contact_input *input,
                                size_t most, pir_surface_contact *ret_contacts,
                                pir_surface_contact_result *ret_result) {
    return pir_surface_contacts_among(p, workspace, input, NULL, most, ret_contacts, ret_result);
}

pir_status pir_surface_contacts_among(const pir_polytope *p, pir_workspace *workspace,
                                      const pir_surface_contact_input *input, const pir_contact_list *list, size_t most,
                                      pir_surface_contact *ret_contacts, pir_surface_contact_result *ret_result) {
    if (!p || !workspace || !input || !ret_result || (!ret_contacts && most > 0))
        return PIR_ERR_ARGUMENT;
    pir_scratch *scratch = ((pir_workspace_head *)workspace)->scratch;
    struct room *room = pir_scratch_room(scratch, PIR_ROOM_SURFACE, sizeof *room, destroy_room);
    if (!room)
        return PIR_ERR_MEMORY;
    room->job.allocator = scratch->allocator;
    room->job.list = list;
    pir_status status = pir_contact_job_begin(&room->job, p, input);
    return status == PIR_OK ? run(room, most, ret_contacts, ret_result) : status;
}
