/* SPDX-License-Identifier: MIT */
/*
 * P and the triangles near it.
 *
 * Errors, u = 2^-53: each rotation is within 31u of the exact one in Frobenius norm; a point turned by it is off by
 * another 6u of its length, and P's vertices by u, being the nearest doubles; the sum with a translation rounds once.
 * So P's vertices are within 2^-47 of P's radius, and corners of a surface that is moved within 2^-47 of the lengths
 * that they are made of; those of one that is not are exact. Differences are taken from P's translation, beside which
 * the triangles are, so they round by 2^-51 of `size` at most.
 */
#include "mesh/contact/contact_job.h"

#include <string.h>

#include "mesh/contact/beside.h"
#include "mesh/contact/contact_exact.h"
#include "mesh/signs/mesh_numbers.h"

/* How far beyond what is asked for triangles are gathered at first, by P's radius: enough to leave what is not deep. */
#define SHALLOW 0x1p-6

/* --- P --- */

/* *rotation, if it is asked for, is the pose's. */
static pir_status check_pose(const pir_pose *pose, pir_rotation *rotation) {
    const pir_quat q = pose->rotation;
    const pir_vec3 t = pose->translation;
    // ground that is not turned needs no numbers
    const bool stands = !rotation && pir_quat_is_identity(q) && q.w != 0 && isfinite(q.w);
    pir_rotation taken;
    pir_status status = stands ? PIR_OK : pir_rotation_set(&taken, q);
    if (status != PIR_OK)
        return status;
    if (!pir_vec_is_finite(t))
        return PIR_ERR_NOT_FINITE;
    if (fabs(t.x) > PIR_MESH_FARTHEST || fabs(t.y) > PIR_MESH_FARTHEST || fabs(t.z) > PIR_MESH_FARTHEST)
        return PIR_ERR_LIMIT;
    if (rotation)
        *rotation = taken;
    return PIR_OK;
}

static pir_status check_input(const pir_surface_contact_input *input) {
    if (isnan(input->radius) || isnan(input->margin))
        return PIR_ERR_NOT_FINITE;
    if (!(input->radius >= 0) || !(input->margin >= 0) || isinf(input->radius) || isinf(input->margin))
        return PIR_ERR_ARGUMENT;
    if (input->radius > PIR_MESH_FARTHEST || input->margin > PIR_MESH_FARTHEST)
        return PIR_ERR_LIMIT;
    if (input->surface_count == 0 || !input->surfaces || input->surface_count >= UINT32_MAX)
        return PIR_ERR_ARGUMENT;
    if (input->beside_count > 0 && (!input->beside || input->beside_count >= UINT32_MAX))
        return PIR_ERR_ARGUMENT;
    for (size_t i = 0; i < input->beside_count; i++)
        if (!input->beside[i])
            return PIR_ERR_ARGUMENT;
    for (size_t i = 0; i < input->surface_count; i++) {
        pir_status status = pir_surface_check(input->surfaces[i].surface);
        if (status == PIR_OK)
            status = check_pose(&input->surfaces[i].pose, NULL);
        if (status != PIR_OK)
            return status;
    }
    return PIR_OK;
}

static bool reserve(const pir_contact_job *job, pir_vec3 **block, uint32_t *room, uint32_t count) {
    if (count <= *room)
        return true;
    pir_vec3 *grown = PIR_RESIZE(&job->allocator, *block, *room, count);
    if (!grown)
        return false;
    *block = grown;
    *room = count;
    return true;
}

static pir_status turn_vertices(pir_contact_job *job) {
    uint32_t count = job->p->vertex_count;
    if (!reserve(job, &job->vertex, &job->vertex_room, count) ||
        !reserve(job, &job->turned, &job->turned_room, job->p->facet_count + job->p->edge_count))
        return PIR_ERR_MEMORY;
    job->has_turned = false;
    const pir_mat3 r = job->rotation.r;
    pir_vec3 low = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (uint32_t v = 0; v < count; v++) {
        const pir_vec3 x = pir_mat_apply(&r, job->p->vertex[v]);
        job->vertex[v] = x;
        low = (pir_vec3){pir_lesser(x.x, low.x), pir_lesser(x.y, low.y), pir_lesser(x.z, low.z)};
        high = (pir_vec3){pir_greater(x.x, high.x), pir_greater(x.y, high.y), pir_greater(x.z, high.z)};
    }
    job->low = low;
    job->high = high;
    const double most =
        pir_greater(pir_greater(pir_greater(-low.x, high.x), pir_greater(-low.y, high.y)), pir_greater(-low.z, high.z));
    job->radius = most * 1.7320508075688774;
    return most <= PIR_MESH_FARTHEST ? PIR_OK : PIR_ERR_LIMIT;
}

void pir_contact_turn(pir_contact_job *job) {
    const pir_polytope *p = job->p;
    if (job->has_turned)
        return;
    for (uint32_t f = 0; f < p->facet_count; f++)
        job->turned[f] = pir_mat_apply(&job->rotation.r, p->normal[f]);
    for (uint32_t e = 0; e < p->edge_count; e++)
        job->turned[p->facet_count + e] = pir_mat_apply(&job->rotation.r, p->direction[p->edge_half[e]]);
    job->has_turned = true;
}

/* --- triangles --- */

struct gathering {
    pir_contact_job *job;
    uint32_t surface;
    const pir_mat3 *r;
    pir_vec3 t;
    bool moved, one_sided;
    pir_walk_box box;
    double most;
    const uint64_t *list; /* of the surface, or NULL */
    size_t listed;
};

static void measure(const void *context, const pir_mesh_boxes *boxes, double ret_near[PIR_MESH_WIDTH]) {
    pir_walk_box_measure(&((const struct gathering *)context)->box, boxes, ret_near);
}

static bool reserve_triangle(pir_contact_job *job) {
    if (job->triangle_count < job->triangle_room)
        return true;
    uint32_t room = job->triangle_room ? 2 * job->triangle_room : 64;
    pir_near_triangle *triangle = PIR_RESIZE(&job->allocator, job->triangle, job->triangle_room, room);
    if (!triangle)
        return false;
    job->triangle = triangle;
    job->triangle_room = room;
    return true;
}

static pir_vec3 unit_or_zero(pir_vec3 n) {
    double square = pir_vec_dot(n, n);
    return square > 0x1p-900 ? pir_vec_scale(n, 1 / sqrt(square)) : (pir_vec3){0, 0, 0};
}

/* Takes a triangle; false where there is no room. */
static bool take(struct gathering *g, const pir_met_triangle *met) {
    pir_contact_job *job = g->job;
    if (job->triangle_count >= PIR_CONTACT_TRIANGLES_MOST || !reserve_triangle(job)) {
        job->out_of_memory = true;
        return false;
    }
    pir_near_triangle *s = &job->triangle[job->triangle_count++];
    // `near` is written where the triangle is looked at
    s->local = met->tri;
    s->surface = g->surface;
    s->number = met->number;
    memcpy(s->id, met->id, sizeof s->id);
    s->one_sided = g->one_sided;
    s->counts = s->passed = s->near.meets = false;
    for (int i = 0; i < 3; i++)
        s->p[i] = g->moved ? pir_vec_add(pir_mat_apply(g->r, met->tri.p[i]), g->t) : met->tri.p[i];
    s->front = unit_or_zero(pir_vec_cross(pir_vec_sub(s->p[1], s->p[0]), pir_vec_sub(s->p[2], s->p[0])));
    return true;
}

/* Whether a triangle is in the part of the list that is of its surface. */
static bool is_listed(const struct gathering *g, uint32_t number) {
    const uint64_t key = (uint64_t)g->surface << 32 | number;
    size_t low = 0, high = g->listed;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        low = g->list[middle] < key ? middle + 1 : low;
        high = g->list[middle] < key ? high : middle;
    }
    return low < g->listed && g->list[low] == key;
}

static bool look(void *context, const pir_met_triangle *met) {
    struct gathering *g = context;
    if (g->list && !is_listed(g, met->number))
        return true;
    return !pir_walk_box_meets(&g->box, &met->tri) || take(g, met);
}

static double component(pir_vec3 v, int k) {
    return k == 0 ? v.x : k == 1 ? v.y : v.z;
}

/* The box of P, grown, in the frame of a surface, and a little more for all roundings. */
static void set_box(struct gathering *g, const pir_contact_job *job, double grow, double slack) {
    pir_vec3 t = job->input->pose.translation;
    for (int k = 0; k < 3; k++) {
        double low = component(job->low, k) + component(t, k), high = component(job->high, k) + component(t, k);
        g->box.low[k] = low - grow - slack;
        g->box.high[k] = high + grow + slack;
    }
    if (!g->moved)
        return;
    double middle[3], half[3];
    for (int k = 0; k < 3; k++) {
        middle[k] = 0.5 * (g->box.low[k] + g->box.high[k]) - component(g->t, k);
        half[k] = 0.5 * (g->box.high[k] - g->box.low[k]);
    }
    for (int k = 0; k < 3; k++) {
        double at = 0, reach = slack;
        for (int i = 0; i < 3; i++) {
            at += g->r->m[i][k] * middle[i];
            reach += fabs(g->r->m[i][k]) * half[i];
        }
        g->box.low[k] = at - reach;
        g->box.high[k] = at + reach;
    }
}

static bool turns_nothing(const pir_pose *pose) {
    pir_vec3 t = pose->translation;
    return pir_quat_is_identity(pose->rotation) && t.x == 0 && t.y == 0 && t.z == 0;
}

static double surface_size(const pir_posed_surface *posed) {
    double reach[3];
    pir_surface_reach(posed->surface, reach);
    return reach[0] + reach[1] + reach[2] + pir_length(posed->pose.translation);
}

/* Takes the part of the list that is of the surface. */
static void set_list(struct gathering *g, const pir_contact_list *list) {
    size_t begin = 0, end;
    while (begin < list->count && list->triangle[begin] >> 32 < g->surface)
        begin++;
    for (end = begin; end < list->count && list->triangle[end] >> 32 == g->surface;)
        end++;
    g->list = list->triangle + begin;
    g->listed = end - begin;
}

/* The triangles of a list are taken in the order of the walk, on which the choice among equals depends. */
static void gather_surface(pir_contact_job *job, uint32_t surface, double grow) {
    const pir_posed_surface *posed = &job->input->surfaces[surface];
    pir_rotation rotation;
    struct gathering g = {.job = job,
                          .surface = surface,
                          .r = &rotation.r,
                          .t = posed->pose.translation,
                          .moved = !turns_nothing(&posed->pose),
                          .one_sided =
                              posed->surface.mesh ? !posed->surface.mesh->two_sided : !posed->surface.field->two_sided};
    if (g.moved)
        (void)pir_rotation_set(&rotation, posed->pose.rotation); // checked before
    if (job->list)
        set_list(&g, job->list);
    if (g.list && g.listed < 2) {
        for (size_t i = 0; i < g.listed; i++) {
            const pir_met_triangle met = pir_surface_met(posed->surface, (uint32_t)g.list[i]);
            (void)take(&g, &met);
        }
        return;
    }
    double size = surface_size(posed) + job->radius + grow + pir_length(job->input->pose.translation);
    set_box(&g, job, grow, 0x1p-44 * size);
    pir_surface_walk(posed->surface, &(pir_walk){measure, look, &g, &g.most, &g.box});
}

/* Sizes, of what was gathered. */
static void set_size(pir_contact_job *job) {
    double far = 0, moved = 0;
    pir_vec3 t = job->input->pose.translation;
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        const pir_near_triangle *s = &job->triangle[i];
        const pir_pose *pose = &job->input->surfaces[s->surface].pose;
        for (int k = 0; k < 3; k++) {
            far = pir_greater(far, pir_length(pir_vec_sub(s->p[k], t)));
            if (!turns_nothing(pose))
                moved = pir_greater(moved, pir_length(s->local.p[k]) + pir_length(pose->translation));
        }
    }
    const double radius = pir_greater(job->radius, job->beside_radius);
    job->size = far + radius + 2 * job->grown;
    job->error = 0x1p-47 * (radius + moved) + 0x1p-51 * job->size;
}

pir_status pir_contact_job_gather(pir_contact_job *job, double grow) {
    job->triangle_count = 0;
    job->killer = UINT32_MAX;
    job->out_of_memory = false;
    job->grown = grow;
    for (uint32_t i = 0; i < job->input->surface_count && !job->out_of_memory; i++)
        gather_surface(job, i, grow);
    if (job->out_of_memory)
        return job->triangle_count >= PIR_CONTACT_TRIANGLES_MOST ? PIR_ERR_LIMIT : PIR_ERR_MEMORY;
    set_size(job);
    job->counts.triangles = job->triangle_count;
    return pir_contact_exact_reserve(job);
}

pir_status pir_contact_job_gather_first(pir_contact_job *job) {
    return pir_contact_job_gather(job, job->input->margin + job->input->radius + SHALLOW * job->radius);
}

bool pir_contact_reserve_order(pir_contact_job *job) {
    if (2 * job->triangle_count <= job->order_room)
        return true;
    uint32_t *order = PIR_RESIZE(&job->allocator, job->order, job->order_room, 2 * job->triangle_room);
    if (!order)
        return false;
    job->order = order;
    job->order_room = 2 * job->triangle_room;
    return true;
}

pir_status pir_contact_job_begin(pir_contact_job *job, const pir_polytope *p, const pir_surface_contact_input *input) {
    pir_status status = check_input(input);
    if (status == PIR_OK)
        status = check_pose(&input->pose, &job->rotation);
    if (status != PIR_OK)
        return status;
    job->p = p;
    job->input = input;
    job->counts = (pir_surface_contact_counts){0, 0, 0, 0};
    job->rotation.integers = &job->integers[0];
    job->surface_rotation.integers = &job->integers[1];
    job->surface = UINT32_MAX;
    status = turn_vertices(job);
    return status == PIR_OK ? pir_contact_take_beside(job) : status;
}

void pir_contact_job_finish(pir_contact_job *job) {
    PIR_FREE(&job->allocator, job->vertex, job->vertex_room);
    PIR_FREE(&job->allocator, job->turned, job->turned_room);
    PIR_FREE(&job->allocator, job->beside, job->beside_room);
    PIR_FREE(&job->allocator, job->beside_vertex, job->beside_vertex_room);
    PIR_FREE(&job->allocator, job->triangle, job->triangle_room);
    PIR_FREE(&job->allocator, job->order, job->order_room);
    PIR_FREE(&job->allocator, job->limbs.base, job->limbs.capacity);
}

/* --- one frame --- */

bool pir_near_same_frame(const pir_contact_job *job, const pir_near_triangle *s, const pir_near_triangle *t) {
    if (s->surface == t->surface)
        return true;
    const pir_pose *a = &job->input->surfaces[s->surface].pose, *b = &job->input->surfaces[t->surface].pose;
    pir_quat p = a->rotation, q = b->rotation;
    bool turned = p.x == q.x && p.y == q.y && p.z == q.z && p.w == q.w;
    return (turned || (pir_quat_is_identity(p) && pir_quat_is_identity(q))) && a->translation.x == b->translation.x &&
           a->translation.y == b->translation.y && a->translation.z == b->translation.z;
}

/* Whether a rotation keeps the coordinate k of every point, exactly. */
static bool keeps(pir_quat q, int k) {
    return (k == 0 || q.x == 0) && (k == 1 || q.y == 0) && (k == 2 || q.z == 0);
}

bool pir_near_is_level(const pir_contact_job *job, const pir_near_triangle *s, uint32_t a, const pir_near_triangle *t,
                       uint32_t b, int axis) {
    const pir_pose *p = &job->input->surfaces[s->surface].pose, *q = &job->input->surfaces[t->surface].pose;
    return component(s->local.p[a], axis) == component(t->local.p[b], axis) && keeps(p->rotation, axis) &&
           keeps(q->rotation, axis) && component(p->translation, axis) == component(q->translation, axis);
}

bool pir_near_same_corner(const pir_contact_job *job, const pir_near_triangle *s, int a, const pir_near_triangle *t,
                          int b) {
    if (s->surface == t->surface)
        return s->id[a] == t->id[b];
    pir_vec3 x = s->local.p[a], y = t->local.p[b];
    return x.x == y.x && x.y == y.y && x.z == y.z && pir_near_same_frame(job, s, t);
}

uint32_t pir_contact_lowest(const pir_contact_job *job, pir_vec3 n) {
    uint32_t best = 0;
    double least = pir_vec_dot(n, job->vertex[0]);
    for (uint32_t v = 1; v < job->p->vertex_count; v++) {
        double along = pir_vec_dot(n, job->vertex[v]);
        best = along < least ? v : best;
        least = along < least ? along : least;
    }
    return best;
}
