/* SPDX-License-Identifier: MIT */
/* Which contacts stand: see standing.h. */
#include "mesh/contact/standing.h"

#include "base/sort.h"
#include "mesh/contact/contact_facets.h"
#include "mesh/contact/ghost.h"

#define SAME_SQUARE 0x1p-60
/* How much of a normal may lead into the back of a one-sided triangle. */
#define LEVEL 0x1p-30

bool pir_contact_same_normal(pir_vec3 a, pir_vec3 b) {
    pir_vec3 way = pir_vec_sub(a, b);
    return pir_vec_dot(way, way) < SAME_SQUARE;
}

static bool has_normal(const pir_standings *standings, pir_vec3 normal) {
    for (uint32_t i = 0; i < standings->count; i++)
        if (pir_contact_same_normal(standings->at[i].normal, normal))
            return true;
    return false;
}

/* Half of the radius, or of that at which P would touch. */
static double ball_of(const pir_contact_job *job) {
    double least = job->input->radius;
    for (uint32_t i = 0; i < job->triangle_count && least > 0; i++) {
        const pir_near_triangle *s = &job->triangle[i];
        if (s->counts && !s->near.meets)
            least = pir_lesser(least, s->near.distance);
    }
    return 0.5 * least;
}

static bool is_before(void *context, uint32_t a, uint32_t b) {
    const pir_near_triangle *triangle = context;
    return triangle[a].gap < triangle[b].gap;
}

/* Lists the triangles within the margin, by rising gap; the number. */
static uint32_t list_near(pir_contact_job *job, const pir_way_out *out) {
    const double radius = job->input->radius, margin = job->input->margin, far = pir_length(out->way) + radius;
    uint32_t count = 0;
    pir_contact_prove_all(job, out->t);
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        pir_near_triangle *s = &job->triangle[i];
        if (!s->counts || s->near.meets || s->near.distance - far > margin)
            continue;
        s->gap = s->near.distance - pir_vec_dot(s->near.n, out->way) / pir_length(s->near.n) - radius;
        if (s->gap <= margin)
            job->order[count++] = i;
    }
    pir_sort(job->order, count, job->order + job->triangle_count, is_before, job->triangle);
    return count;
}

static pir_vec3 normal_of(const pir_near_triangle *s) {
    return pir_vec_scale(s->near.n, 1 / pir_length(s->near.n));
}

/* Adds the contact of a triangle where it stands and has a normal of its own. */
static void judge(pir_contact_job *job, const pir_way_out *out, uint32_t index, pir_standings *standings) {
    pir_near_triangle *s = &job->triangle[index];
    const pir_vec3 normal = normal_of(s);
    if (has_normal(standings, normal))
        return;
    if (!pir_contact_stands(job, out->t, index)) {
        job->counts.ghosts++;
        return;
    }
    standings->at[standings->count++] = (pir_standing){index, s->gap, normal, s->near.point, s->near.simplex};
}

bool pir_contact_find_standings(pir_contact_job *job, const pir_way_out *out, pir_standings *ret) {
    ret->count = 0;
    if (!pir_contact_reserve_order(job))
        return false;
    job->ball = ball_of(job);
    const uint32_t count = list_near(job, out);
    job->counts.near += count;
    for (uint32_t k = 0; k < count && ret->count < PIR_CONTACT_NORMALS; k++)
        judge(job, out, job->order[k], ret);
    return true;
}

/* --- stuck --- */

/* The facet of a triangle's plane along which P leaves it first. */
static void take_least(void *context, const pir_contact_facet *facet) {
    pir_contact_facet *least = context;
    if (facet->depth < least->depth)
        *least = *facet;
}

/* Puts a contact in its place, unless one of its normal is there that is as deep. */
static void insert(pir_standings *standings, const pir_standing *contact) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < standings->count; i++) {
        const pir_standing *other = &standings->at[i];
        if (pir_contact_same_normal(other->normal, contact->normal)) {
            if (other->gap <= contact->gap)
                return;
            continue;
        }
        standings->at[count++] = *other;
    }
    standings->count = count;
    if (count == PIR_CONTACT_NORMALS && contact->gap >= standings->at[count - 1].gap)
        return;
    uint32_t at = count < PIR_CONTACT_NORMALS ? standings->count++ : count - 1;
    for (; at > 0 && standings->at[at - 1].gap > contact->gap; at--)
        standings->at[at] = standings->at[at - 1];
    standings->at[at] = *contact;
}

void pir_contact_find_stuck(pir_contact_job *job, pir_standings *ret) {
    const pir_vec3 t = job->input->pose.translation;
    ret->count = 0;
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        const pir_near_triangle *s = &job->triangle[i];
        pir_contact_facet least = {.depth = HUGE_VAL};
        if (!s->counts || (!s->near.meets && !s->passed))
            continue;
        job->counts.near++;
        pir_contact_plane_facets(job, t, s, take_least, &least);
        if (!(least.depth < HUGE_VAL))
            continue;
        const uint32_t v = pir_contact_lowest(job, least.n);
        const pir_vec3 low = pir_vec_add(job->vertex[v], t), over = pir_vec_scale(least.n, least.depth);
        const pir_standing contact = {
            i, -least.depth - job->input->radius, least.n, pir_vec_add(low, over), {3, {v, v, v}, {0, 1, 2}}};
        insert(ret, &contact);
    }
}

/* --- touching --- */

/* The facet along which P leaves a triangle first, without going into its back. */
struct least_facet {
    const pir_near_triangle *s;
    pir_contact_facet facet;
};

static void take_forward(void *context, const pir_contact_facet *facet) {
    struct least_facet *least = context;
    if (!(least->s->one_sided && pir_vec_dot(facet->n, least->s->front) < -LEVEL))
        take_least(&least->facet, facet);
}

bool pir_contact_find_touch(pir_contact_job *job, pir_vec3 t, pir_standing *ret) {
    for (uint32_t i = 0; i < job->triangle_count; i++) {
        const pir_near_triangle *s = &job->triangle[i];
        struct least_facet least = {s, {.depth = HUGE_VAL}};
        if (!s->counts || !s->near.meets)
            continue;
        pir_contact_each_facet(job, t, s, take_forward, &least);
        if (!(least.facet.depth < HUGE_VAL))
            continue;
        *ret = (pir_standing){i, 0, least.facet.n, pir_contact_touch_point(job, t, s), s->near.simplex};
        return true;
    }
    return false;
}
