/* SPDX-License-Identifier: MIT */
/* Ghosts: see ghost.h. Signs by doubles first, then by integers, which are made once for a contact. */
#include "mesh/contact/ghost.h"

#include "mesh/contact/beside.h"
#include "mesh/signs/mesh_numbers.h"

struct contact {
    pir_contact_job *job;
    const pir_near_triangle *s;
    const pir_contact_near *near;
    pir_vec3 t;
    pir_vec3 moved; /* where P touches, with the ball, in doubles, within `off` */
    double off;
    bool along_front;  /* n is the normal of s itself */
    double front_sign; /* then: 1 where it is the front */
    bool has_exact;
    pir_int3 n;
    pir_exact_move move;
    pir_contact_place place; /* with that move: of P without a ball */
};

static void make_exact(struct contact *c) {
    if (c->has_exact)
        return;
    const pir_contact_place from = pir_place_at(c->t);
    c->n = pir_exact_direction(c->job, &from, c->s, &c->near->simplex, &c->move);
    c->place = (pir_contact_place){c->t, c->moved, &c->move};
    c->has_exact = true;
    c->job->counts.exact++;
}

static bool all_differ(const uint32_t *w) {
    return w[0] != w[1] && w[1] != w[2] && w[0] != w[2];
}

/* Whether four points have a coordinate in common: they are in one plane, without a look at bits. */
static bool is_flat(const pir_tri *tri, pir_vec3 x) {
    const pir_vec3 *p = tri->p;
    return (p[0].z == x.z && p[1].z == x.z && p[2].z == x.z) || (p[0].y == x.y && p[1].y == x.y && p[2].y == x.y) ||
           (p[0].x == x.x && p[1].x == x.x && p[2].x == x.x);
}

/* The sign of n · (corner b of r − x). */
static int rise(struct contact *c, const pir_near_triangle *r, int b) {
    const pir_contact_near *near = c->near;
    uint32_t a = near->simplex.w[0];
    pir_vec3 to = pir_vec_sub(r->p[b], c->s->p[a]);
    double along = pir_vec_dot(near->n, to);
    double bound =
        near->n_error * pir_length(to) + (8 * c->job->error + 0x1p-50 * pir_length(to)) * pir_length(near->n);
    if (fabs(along) > bound)
        return along > 0 ? 1 : -1;
    for (uint32_t k = 0; k < near->simplex.count; k++)
        if (pir_near_same_corner(c->job, c->s, (int)near->simplex.w[k], r, b))
            return 0; // all of these are as far along n
    if (near->axis >= 0 && pir_near_is_level(c->job, c->s, a, r, (uint32_t)b, near->axis))
        return 0;
    if (c->along_front && pir_near_same_frame(c->job, c->s, r)) {
        if (is_flat(&c->s->local, r->local.p[b]))
            return 0;
        return (c->front_sign > 0 ? 1 : -1) * pir_sign_side(&c->s->local, r->local.p[b]);
    }
    make_exact(c);
    return pir_exact_rise(c->job, &c->n, c->s, a, r, (uint32_t)b);
}

/* The sign of n · the front of r. */
static int towards_front(struct contact *c, const pir_near_triangle *r) {
    pir_vec3 e = pir_vec_sub(r->p[1], r->p[0]), f = pir_vec_sub(r->p[2], r->p[0]), front = pir_vec_cross(e, f);
    double along = pir_vec_dot(c->near->n, front), sides = pir_length(e) * pir_length(f);
    double front_error = 8 * c->job->error * (pir_length(e) + pir_length(f)) + 0x1p-50 * sides;
    double length = pir_length(c->near->n);
    double bound = c->near->n_error * sides + front_error * (length + c->near->n_error) + 0x1p-50 * length * sides;
    if (fabs(along) > bound)
        return along > 0 ? 1 : -1;
    make_exact(c);
    uint32_t used = c->job->limbs.used;
    pir_int3 exact = pir_exact_front(c->job, r);
    pir_int dot = pir_num3_dot(&c->job->limbs, &c->n, &exact);
    c->job->limbs.used = used;
    return pir_int_sign(&dot);
}

/* Whether r has all the corners that x lies between. */
static bool has_point(const struct contact *c, const pir_near_triangle *r) {
    for (uint32_t k = 0; k < c->near->simplex.count; k++) {
        bool found = false;
        for (int b = 0; b < 3 && !found; b++)
            found = pir_near_same_corner(c->job, c->s, (int)c->near->simplex.w[k], r, b);
        if (!found)
            return false;
    }
    return true;
}

static pir_vec3 on_grid(const pir_contact_job *job, pir_vec3 v) {
    return (pir_vec3){pir_contact_on_grid(job, v.x), pir_contact_on_grid(job, v.y), pir_contact_on_grid(job, v.z)};
}

/* Where P touches with a ball: integers know places on the grid alone, which is far finer than the errors. */
static pir_contact_place ball_place(const struct contact *c) {
    return pir_place_at(on_grid(c->job, c->moved));
}

/* Whether P without the ball is behind r, where it touches with it. */
static bool is_behind(struct contact *c, const pir_near_triangle *r) {
    if (c->job->ball > 0) {
        const pir_contact_place place = ball_place(c);
        return pir_contact_is_behind(c->job, &place, r);
    }
    pir_contact_told told = pir_contact_told_behind(c->job, c->moved, r, c->off, 0);
    if (told != PIR_TOLD_NOTHING)
        return told == PIR_TOLD_YES;
    make_exact(c);
    return pir_exact_is_behind(c->job, &c->place, r);
}

/* Whether P, moved until it touches, meets r. With a ball: whether it is nearer than that. */
static bool is_met(struct contact *c, const pir_near_triangle *r) {
    double ball = c->job->ball;
    if (ball > 0) {
        const pir_contact_place place = ball_place(c);
        pir_contact_near near;
        pir_contact_nearest(c->job, &place, r, &near);
        return near.meets || near.distance < ball - 8 * (c->off + c->job->error);
    }
    pir_contact_simplex simplex;
    pir_contact_told told = pir_contact_told_meets(c->job, c->moved, r, c->off, &simplex);
    if (told != PIR_TOLD_NOTHING)
        return told == PIR_TOLD_YES;
    make_exact(c);
    return pir_exact_nearest(c->job, &c->place, r, &simplex);
}

/* Whether n does not separate P from r. */
static bool is_against(struct contact *c, const pir_near_triangle *r) {
    for (int b = 0; b < 3; b++)
        if (rise(c, r, b) > 0)
            return true;
    return false;
}

/* Whether a corner of r rises that P has inside, where it touches: certainly, and at next to no cost. */
static bool is_corner_inside(struct contact *c, const pir_near_triangle *r) {
    for (int b = 0; b < 3; b++)
        if (pir_contact_holds_point(c->job, c->moved, r->p[b], c->off) && rise(c, r, b) > 0)
            return true;
    return false;
}

/* Whether doubles alone tell that a triangle makes the contact a ghost. */
static bool is_certain_killer(struct contact *c, const pir_near_triangle *r) {
    pir_contact_simplex simplex;
    if (r == c->s || c->job->ball > 0)
        return false;
    return (is_corner_inside(c, r) ||
            (is_against(c, r) && pir_contact_told_meets(c->job, c->moved, r, c->off, &simplex) == PIR_TOLD_YES)) &&
           !is_behind(c, r);
}

/* Whether one of a pass does: those that have the point, which take one sign, or the others. */
static bool is_killer(struct contact *c, const pir_near_triangle *r, bool with_point) {
    return r != c->s && has_point(c, r) == with_point && is_against(c, r) && (with_point || is_met(c, r)) &&
           !is_behind(c, r);
}

/* Verdicts on a contact: `HIDDEN` that a triangle without its point, job->killer, is met where P touches. */
enum verdict { STANDS, GHOST, HIDDEN };

/* Looks at the one that made the last ghost first, then at all, those next to the triangle in the tree first. */
static enum verdict judge_among(struct contact *c, uint32_t index) {
    pir_contact_job *job = c->job;
    if (job->killer < job->triangle_count && is_certain_killer(c, &job->triangle[job->killer]))
        return has_point(c, &job->triangle[job->killer]) ? GHOST : HIDDEN;
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t away = 1; away < job->triangle_count; away++)
            for (int side = 0; side < 2; side++) {
                if (side == 0 ? away > index : away >= job->triangle_count - index)
                    continue;
                uint32_t i = side == 0 ? index - away : index + away;
                if (!is_killer(c, &job->triangle[i], pass == 0))
                    continue;
                job->killer = i;
                return pass == 0 ? GHOST : HIDDEN;
            }
    return STANDS;
}

static enum verdict judge(pir_contact_job *job, pir_vec3 t, uint32_t index, const pir_contact_near *near) {
    const pir_near_triangle *s = &job->triangle[index];
    double length = pir_length(near->n);
    struct contact c = {.job = job, .s = s, .near = near, .t = t};
    double part = job->ball > 0 ? 1 - job->ball / near->distance : 1;
    c.moved = pir_vec_sub(t, pir_vec_scale(near->way, part));
    c.off = near->distance * (near->n_error / length + 0x1p-48) + 16 * job->error + 0x1p-50 * pir_length(t);
    c.along_front = near->simplex.count == 3 && all_differ(near->simplex.w);
    c.front_sign = pir_vec_dot(near->n, s->front);
    uint32_t used = job->limbs.used;
    const pir_contact_place place = pir_place_at(t);
    enum verdict verdict = s->one_sided && towards_front(&c, s) < 0 ? GHOST : judge_among(&c, index);
    if (verdict == STANDS && pir_contact_is_inner(job, &place, s, near))
        verdict = GHOST;
    job->limbs.used = used;
    return verdict;
}

/* --- beside what hides --- */

/* Places beside that are tried, and how far beyond what hides, as a part of the margin. */
#define MOST_PLACES 4
#define BEYOND      0x1p-8
/* How near two normals are that are one. */
#define SAME_SQUARE 0x1p-60

static pir_vec3 unit(pir_vec3 n) {
    return pir_vec_scale(n, 1 / pir_length(n));
}

/*
 * Moves `t` across n, until P, which then touches along −n, has left the plane across the normal of what hides: false
 * where that is farther than the margin.
 */
static bool step_beside(const pir_contact_job *job, const pir_contact_near *near, pir_vec3 from, pir_vec3 *t) {
    const pir_near_triangle *r = &job->triangle[job->killer];
    if (!r->counts || r->near.meets)
        return false;
    pir_vec3 n = unit(near->n), m = unit(r->near.n);
    double cosine = pir_vec_dot(n, m);
    pir_vec3 across = pir_vec_sub(m, pir_vec_scale(n, cosine)), moved = pir_vec_sub(*t, from);
    double sine = pir_length(across), margin = job->input->margin;
    double need = near->distance * cosine - r->near.distance - pir_vec_dot(m, moved);
    if (!(cosine > 0) || !(need < sine * margin))
        return false;
    double step = pir_greater(need, 0) / sine + BEYOND * margin;
    *t = on_grid(job, pir_vec_add(*t, pir_vec_scale(across, step / sine)));
    return pir_length(pir_vec_sub(*t, from)) + near->distance <= margin;
}

bool pir_contact_stands(pir_contact_job *job, pir_vec3 t, uint32_t index) {
    const pir_near_triangle *s = &job->triangle[index];
    pir_contact_near near = s->near;
    pir_vec3 at = t, n = unit(near.n);
    enum verdict verdict = judge(job, t, index, &near);
    for (int i = 0; i < MOST_PLACES && verdict == HIDDEN && near.simplex.count == 3 && job->ball == 0; i++) {
        if (!step_beside(job, &s->near, t, &at))
            return false;
        const pir_contact_place place = pir_place_at(at);
        pir_contact_nearest(job, &place, s, &near);
        if (near.meets || near.simplex.count != 3)
            return false;
        pir_vec3 other = pir_vec_sub(unit(near.n), n);
        if (pir_vec_dot(other, other) > SAME_SQUARE)
            return false;
        verdict = judge(job, at, index, &near);
    }
    return verdict == STANDS;
}
