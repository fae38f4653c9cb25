/* SPDX-License-Identifier: MIT */
/*
 * Pieces beside P: see beside.h. Whether a piece holds x, and has a vertex below, is told by doubles
 * first, then by integers: x is a weighted mean of vertices of P, whose weights are exact.
 */
#include "mesh/contact/beside.h"

#include "mesh/signs/mesh_numbers.h"

/* --- the pieces --- */

/* The vertices of a piece, turned, and the box of these about P's origin. */
static pir_status turn(pir_contact_job *job, const pir_polytope *p, uint32_t first, pir_contact_piece *ret_piece) {
    double most = 0;
    pir_vec3 low = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        const pir_vec3 x = pir_mat_apply(&job->rotation.r, p->vertex[v]);
        job->beside_vertex[first + v] = x;
        low = (pir_vec3){pir_lesser(low.x, x.x), pir_lesser(low.y, x.y), pir_lesser(low.z, x.z)};
        high = (pir_vec3){pir_greater(high.x, x.x), pir_greater(high.y, x.y), pir_greater(high.z, x.z)};
        most = pir_greater(most, pir_length(x));
    }
    *ret_piece = (pir_contact_piece){p, first, low, high, most};
    return most <= PIR_MESH_FARTHEST ? PIR_OK : PIR_ERR_LIMIT;
}

static bool reserve(pir_contact_job *job, uint32_t pieces, size_t vertices) {
    if (pieces > job->beside_room) {
        pir_contact_piece *grown = PIR_RESIZE(&job->allocator, job->beside, job->beside_room, pieces);
        if (!grown)
            return false;
        job->beside = grown;
        job->beside_room = pieces;
    }
    if (vertices > job->beside_vertex_room) {
        pir_vec3 *grown = PIR_RESIZE(&job->allocator, job->beside_vertex, job->beside_vertex_room, vertices);
        if (!grown)
            return false;
        job->beside_vertex = grown;
        job->beside_vertex_room = (uint32_t)vertices;
    }
    return true;
}

pir_status pir_contact_take_beside(pir_contact_job *job) {
    const pir_surface_contact_input *input = job->input;
    size_t vertices = 0;
    uint32_t first = 0;
    job->beside_count = 0;
    job->beside_radius = 0;
    for (size_t i = 0; i < input->beside_count; i++)
        vertices += input->beside[i]->vertex_count;
    if (vertices > UINT32_MAX)
        return PIR_ERR_LIMIT;
    if (!reserve(job, (uint32_t)input->beside_count, vertices))
        return PIR_ERR_MEMORY;
    for (size_t i = 0; i < input->beside_count; i++) {
        const pir_polytope *p = input->beside[i];
        // P itself hides nothing of P, and a flat piece has no inside
        if (p == job->p || p->dimension < 3)
            continue;
        pir_status status = turn(job, p, first, &job->beside[job->beside_count]);
        if (status != PIR_OK)
            return status;
        job->beside_radius = pir_greater(job->beside_radius, job->beside[job->beside_count++].radius);
        first += p->vertex_count;
    }
    return PIR_OK;
}

/* --- by doubles --- */

/* A contact's point of P and its normal, beside which a piece is looked at. */
struct inner {
    pir_contact_job *job;
    const pir_contact_place *place;
    const pir_near_triangle *s;
    const pir_contact_near *near;
    pir_vec3 x; /* about P's origin, within `error` */
    double error;
};

static pir_contact_told told(double x, double error) {
    return x > error ? PIR_TOLD_YES : x < -error ? PIR_TOLD_NO : PIR_TOLD_NOTHING;
}

/* Whether the piece holds x: where all facets certainly have it behind them. */
static pir_contact_told told_holds(const struct inner *c, const pir_contact_piece *piece) {
    const pir_polytope *p = piece->p;
    const pir_vec3 x = pir_mat_apply_transposed(&c->job->rotation.r, c->x);
    pir_contact_told all = PIR_TOLD_YES;
    for (uint32_t f = 0; f < p->facet_count; f++) {
        const pir_vec3 on = p->vertex[p->origin[p->loop[p->loop_start[f]]]];
        const double behind = pir_vec_dot(p->normal[f], pir_vec_sub(on, x));
        const pir_contact_told one = told(behind, 2 * c->error);
        if (one == PIR_TOLD_NO)
            return PIR_TOLD_NO;
        all = one == PIR_TOLD_NOTHING ? one : all;
    }
    return all;
}

/* Whether the piece has a vertex below the plane through x across the normal. */
static pir_contact_told told_below(const struct inner *c, const pir_contact_piece *piece) {
    const pir_vec3 n = c->near->n;
    double least = HUGE_VAL;
    for (uint32_t v = 0; v < piece->p->vertex_count; v++)
        least = pir_lesser(least, pir_vec_dot(n, pir_vec_sub(c->job->beside_vertex[piece->first + v], c->x)));
    return told(-least, 4 * c->error * pir_length(n) + 2 * c->near->n_error * (piece->radius + pir_length(c->x)));
}

static bool is_in_box(const struct inner *c, const pir_contact_piece *piece) {
    const double e = c->error;
    const pir_vec3 low = piece->low, high = piece->high, x = c->x;
    // an error that is no number leaves all open
    return !(x.x < low.x - e || x.x > high.x + e || x.y < low.y - e || x.y > high.y + e || x.z < low.z - e ||
             x.z > high.z + e);
}

/* By how much x may be off. Weights are off by errors over the height of a simplex, so those of needles by much. */
static double error_of(const struct inner *c) {
    const pir_contact_job *job = c->job;
    const pir_contact_simplex *ids = &c->near->simplex;
    pir_vec3 d[3];
    for (uint32_t k = 0; k < ids->count; k++)
        d[k] = pir_vec_sub(job->vertex[ids->v[k]], pir_vec_sub(c->s->p[ids->w[k]], c->place->at));
    double spread = 0;
    if (ids->count == 2)
        spread = job->size / pir_length(pir_vec_sub(d[1], d[0]));
    if (ids->count == 3) {
        const pir_vec3 e = pir_vec_sub(d[1], d[0]), f = pir_vec_sub(d[2], d[0]), n = pir_vec_cross(e, f);
        const double wide = pir_greater(pir_length(e), pir_length(f));
        spread = job->size * wide * wide * wide / pir_vec_dot(n, n);
    }
    return 256 * (1 + spread) * (job->error + 0x1p-50 * job->size);
}

/* --- by integers --- */

/* x in the frame of P's body: over / under, under > 0. */
struct exact_mean {
    pir_int3 over;
    pir_int under;
};

static struct exact_mean mean_of(struct inner *c) {
    pir_limbs *limbs = &c->job->limbs;
    const pir_polytope *p = c->job->p;
    const pir_contact_simplex *simplex = &c->near->simplex;
    pir_int weight[3];
    struct exact_mean mean = {.over = pir_vertex_exact(p, simplex->v[0])};
    pir_exact_weights(c->job, c->place, c->s, simplex, weight);
    pir_int whole = weight[0];
    mean.over = pir_num3_scale(limbs, &mean.over, &weight[0]);
    for (uint32_t k = 1; k < simplex->count; k++) {
        pir_int3 vertex = pir_vertex_exact(p, simplex->v[k]);
        vertex = pir_num3_scale(limbs, &vertex, &weight[k]);
        mean.over = pir_num3_add(limbs, &mean.over, &vertex);
        whole = pir_num_add(limbs, &whole, &weight[k]);
    }
    mean.over = pir_num3_scale(limbs, &mean.over, &p->scale.num);
    mean.under = pir_num_mul(limbs, &whole, &p->scale.den);
    return mean;
}

/* Whether a facet of the piece has x in its plane or behind it. */
static bool is_behind_facet(pir_limbs *limbs, const struct exact_mean *x, const pir_polytope *p, uint32_t f) {
    const uint32_t used = limbs->used;
    pir_int3 n = pir_normal_exact(p, f), on = pir_vertex_exact(p, p->origin[p->loop[p->loop_start[f]]]);
    pir_int own = pir_num_mul(limbs, &p->scale.num, &x->under);
    pir_int3 from = pir_num3_scale(limbs, &on, &own), to = pir_num3_scale(limbs, &x->over, &p->scale.den);
    pir_int3 way = pir_num3_sub(limbs, &to, &from);
    pir_int along = pir_num3_dot(limbs, &n, &way);
    limbs->used = used;
    return pir_int_sign(&along) <= 0;
}

static bool holds_exactly(struct inner *c, const pir_polytope *p) {
    pir_limbs *limbs = &c->job->limbs;
    const uint32_t used = limbs->used;
    const struct exact_mean x = mean_of(c);
    bool holds = true;
    for (uint32_t f = 0; f < p->facet_count && holds; f++)
        holds = is_behind_facet(limbs, &x, p, f);
    limbs->used = used;
    c->job->counts.exact++;
    return holds;
}

/* The triangle's plane across the normal is that through x, once P has moved: so the piece in P's place is asked. */
static bool is_below_exactly(struct inner *c, const pir_contact_piece *piece) {
    pir_contact_job *job = c->job;
    const uint32_t used = job->limbs.used;
    pir_exact_move move;
    pir_int3 n = pir_exact_direction(job, c->place, c->s, &c->near->simplex, &move);
    const pir_contact_place moved = {c->place->t, c->place->at, &move};
    const pir_polytope *own = job->p;
    pir_vec3 *vertex = job->vertex;
    job->p = piece->p;
    job->vertex = &job->beside_vertex[piece->first];
    const bool below = pir_exact_least(job, &moved, c->s, &n) < 0;
    job->p = own;
    job->vertex = vertex;
    job->limbs.used = used;
    job->counts.exact++;
    return below;
}

bool pir_contact_is_inner(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                          const pir_contact_near *near) {
    struct inner c = {.job = job, .place = place, .s = s, .near = near};
    c.x = pir_vec_sub(pir_vec_add(near->point, near->way), place->at);
    c.error = job->beside_count > 0 ? error_of(&c) : 0;
    for (uint32_t i = 0; i < job->beside_count; i++) {
        const pir_contact_piece *piece = &job->beside[i];
        if (!is_in_box(&c, piece))
            continue;
        pir_contact_told holds = told_holds(&c, piece);
        pir_contact_told below = holds == PIR_TOLD_NO ? PIR_TOLD_NO : told_below(&c, piece);
        if (below == PIR_TOLD_NO)
            continue;
        if ((below == PIR_TOLD_YES || is_below_exactly(&c, piece)) &&
            (holds == PIR_TOLD_YES || holds_exactly(&c, piece->p)))
            return true;
    }
    return false;
}
