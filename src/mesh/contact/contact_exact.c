/* SPDX-License-Identifier: MIT */
/*
 * Exact differences, and the nearest point of one by descent (Gilbert, Johnson and Keerthi, 1988) in integers: each
 * step adds the support across the nearest point of the hull so far, of which there are finitely many, each nearer.
 *
 * Room, for differences of s bits: a normal has 2s, a weight 4s, a nearest point 5s over 4s. A move made of it gives
 * differences of at most 7s + 64 bits.
 */
#include "mesh/contact/contact_exact.h"

#include "mesh/signs/mesh_numbers.h"

/* Limbs of the stack by those of a coordinate: a step of the descent takes less than 700 coordinates, and what is kept
 * around it less than 300. */
#define STACK_LIMBS(coordinate) (1200 * (coordinate) + 8000)
/* Steps of a descent, far more than are taken. */
#define MOST_STEPS 400

/* --- room --- */

static void span_of(double x, int *top, int *low) {
    int exponent;
    const uint64_t mantissa = pir_double_split(x, &exponent);
    if (mantissa == 0)
        return;
    const int high = exponent + 64 - __builtin_clzll(mantissa), bit = exponent + __builtin_ctzll(mantissa);
    *top = high > *top ? high : *top;
    *low = bit < *low ? bit : *low;
}

/* Bits of an entry of M(q), and of |q|². */
static uint32_t matrix_bits(pir_quat q) {
    int top = INT32_MIN, low = INT32_MAX;
    span_of(q.x, &top, &low);
    span_of(q.y, &top, &low);
    span_of(q.z, &top, &low);
    span_of(q.w, &top, &low);
    return 2 * (uint32_t)(top - low) + 4;
}

static int lower(int a, int b) {
    return a < b ? a : b;
}

static int low_exponent(const pir_contact_job *job) {
    int low = lower(0, pir_vec_low_bit(job->input->pose.translation)), step;
    for (size_t i = 0; i < job->input->surface_count; i++)
        low = lower(low, pir_vec_low_bit(job->input->surfaces[i].pose.translation));
    for (uint32_t i = 0; i < job->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            low = lower(low, pir_vec_low_bit(job->triangle[i].local.p[k]));
    // places between are on a grid of their own: fine beside P, and beside the last bits of its translation
    (void)frexp(job->radius + job->error, &step);
    return lower(low, step - 60);
}

/* Bits of a difference: of q bits for P's rotation, `turned` for a surface's, and `fine` for a coordinate. */
static uint32_t difference_bits(const pir_polytope *p, uint32_t q, uint32_t turned, uint32_t fine) {
    uint32_t num = pir_int_bits(&p->scale.num), den = pir_int_bits(&p->scale.den);
    uint32_t vertex = q + p->exact_vertex.stride * GMP_NUMB_BITS + num + (fine - 61) + 4, moved = fine + q + den;
    uint32_t body = (vertex > moved ? vertex : moved) + 1, corner = turned + fine + 5;
    uint32_t first = body + turned, second = corner + q + den;
    return (first > second ? first : second) + 2;
}

pir_status pir_contact_exact_reserve(pir_contact_job *job) {
    int exponent = low_exponent(job);
    uint32_t fine = (uint32_t)(61 - exponent), q = matrix_bits(job->input->pose.rotation), turned = 1;
    for (size_t i = 0; i < job->input->surface_count; i++) {
        uint32_t bits = matrix_bits(job->input->surfaces[i].pose.rotation);
        turned = bits > turned ? bits : turned;
    }
    uint32_t bits = difference_bits(job->p, q, turned, fine);
    for (uint32_t i = 0; i < job->beside_count; i++) {
        uint32_t beside = difference_bits(job->beside[i].p, q, turned, fine);
        bits = beside > bits ? beside : bits;
    }
    uint32_t room = STACK_LIMBS((7 * bits + 64) / GMP_NUMB_BITS + 2);
    job->exponent = exponent;
    if (room <= job->limbs.capacity)
        return PIR_OK;
    mp_limb_t *base = PIR_RESIZE(&job->allocator, job->limbs.base, job->limbs.capacity, room);
    if (!base)
        return PIR_ERR_MEMORY;
    job->limbs = (pir_limbs){base, 0, room};
    return PIR_OK;
}

double pir_contact_on_grid(const pir_contact_job *job, double x) {
    return fabs(x) >= ldexp(1, job->exponent + 53) ? x : ldexp(rint(ldexp(x, -job->exponent)), job->exponent);
}

/* --- points --- */

/* An exact point: over / under. */
struct exact_point {
    pir_int3 over;
    pir_int under;
};

static pir_int3 multiply(pir_limbs *limbs, const pir_rotation_integers *by, const pir_int3 *v) {
    pir_int3 r;
    for (int i = 0; i < 3; i++) {
        const pir_int3 row = {{by->m[i][0], by->m[i][1], by->m[i][2]}};
        r.c[i] = pir_num3_dot(limbs, &row, v);
    }
    return r;
}

static pir_int shifted(pir_limbs *limbs, const pir_int *a, uint32_t bits) {
    pir_int r = pir_limbs_take(limbs, pir_int_length(a) + bits / GMP_NUMB_BITS + 1);
    pir_int_shift_left(&r, a, bits);
    return r;
}

static const pir_rotation_integers *turn_of(pir_rotation *rotation) {
    if (!pir_rotation_has_integers(rotation))
        pir_rotation_make_exact(rotation);
    return rotation->integers;
}

/* A vertex of P at t. */
static struct exact_point vertex_at(pir_contact_job *job, uint32_t v, pir_vec3 t) {
    pir_limbs *limbs = &job->limbs;
    const pir_rotation_integers *q = turn_of(&job->rotation);
    pir_int3 x = pir_vertex_exact(job->p, v), on_unit;
    for (int k = 0; k < 3; k++) {
        pir_int whole = pir_num_mul(limbs, &x.c[k], &job->p->scale.num);
        on_unit.c[k] = shifted(limbs, &whole, (uint32_t)-job->exponent);
    }
    pir_int3 turned = multiply(limbs, q, &on_unit), from = pir_num3_doubles(limbs, t, job->exponent);
    struct exact_point at = {.under = pir_num_mul(limbs, &q->norm, &job->p->scale.den)};
    pir_int3 moved = pir_num3_scale(limbs, &from, &at.under);
    at.over = pir_num3_add(limbs, &turned, &moved);
    return at;
}

static struct exact_point corner_at(pir_contact_job *job, const pir_near_triangle *s, uint32_t k) {
    pir_limbs *limbs = &job->limbs;
    const pir_pose *pose = &job->input->surfaces[s->surface].pose;
    if (job->surface != s->surface) {
        (void)pir_rotation_set(&job->surface_rotation, pose->rotation); // checked before
        job->surface = s->surface;
    }
    const pir_rotation_integers *q = turn_of(&job->surface_rotation);
    pir_int3 x = pir_num3_doubles(limbs, s->local.p[k], job->exponent), turned = multiply(limbs, q, &x);
    pir_int3 t = pir_num3_doubles(limbs, pose->translation, job->exponent);
    pir_int3 moved = pir_num3_scale(limbs, &t, &q->norm);
    struct exact_point at = {pir_num3_add(limbs, &turned, &moved), pir_limbs_take(limbs, pir_int_length(&q->norm) + 1)};
    pir_int_copy(&at.under, &q->norm); // another surface's numbers may take their place
    return at;
}

/* a − b, times both weights. */
static pir_int3 between(pir_limbs *limbs, const struct exact_point *a, const struct exact_point *b) {
    pir_int3 x = pir_num3_scale(limbs, &a->over, &b->under), y = pir_num3_scale(limbs, &b->over, &a->under);
    return pir_num3_sub(limbs, &x, &y);
}

static struct exact_point placed(pir_contact_job *job, const pir_contact_place *place, uint32_t v) {
    pir_limbs *limbs = &job->limbs;
    struct exact_point at = vertex_at(job, v, place->t);
    if (!place->move)
        return at;
    pir_int3 own = pir_num3_scale(limbs, &at.over, &place->move->under);
    pir_int3 on = pir_num3_scale(limbs, &place->move->over, &at.under);
    return (struct exact_point){pir_num3_add(limbs, &own, &on), pir_num_mul(limbs, &at.under, &place->move->under)};
}

/* Copies a vector down to `used`, and gives back the stack above it. */
static pir_int3 keep(pir_limbs *limbs, uint32_t used, const pir_int3 *v) {
    pir_int3 kept;
    limbs->used = used;
    for (int k = 0; k < 3; k++) {
        // what is copied lies above where it goes, component by component
        uint32_t length = pir_int_length(&v->c[k]);
        kept.c[k] = pir_limbs_take(limbs, length + 1);
        for (uint32_t i = 0; i < length; i++)
            kept.c[k].limb[i] = v->c[k].limb[i];
        kept.c[k].size = v->c[k].size;
    }
    return kept;
}

static pir_int3 difference(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s, uint32_t v,
                           uint32_t k) {
    uint32_t used = job->limbs.used;
    struct exact_point p = placed(job, place, v), w = corner_at(job, s, k);
    pir_int3 d = between(&job->limbs, &p, &w);
    return keep(&job->limbs, used, &d);
}

/* --- the nearest point of a simplex --- */

/* Weights of the nearest point of the span of `count` points, and the direction towards it. */
struct span_nearest {
    pir_int weight[3];
    pir_int3 direction; /* 0 where the point is 0 */
};

static void span_two(pir_limbs *limbs, const pir_int3 *a, const pir_int3 *b, struct span_nearest *ret) {
    pir_int3 e = pir_num3_sub(limbs, b, a);
    ret->weight[0] = pir_num3_dot(limbs, b, &e);
    ret->weight[1] = pir_num3_dot(limbs, a, &e);
    pir_int_negate(&ret->weight[1]);
    pir_int3 x = pir_num3_scale(limbs, a, &ret->weight[0]), y = pir_num3_scale(limbs, b, &ret->weight[1]);
    ret->direction = pir_num3_add(limbs, &x, &y);
}

static void negate(pir_int3 *v) {
    for (int k = 0; k < 3; k++)
        pir_int_negate(&v->c[k]);
}

static void span_three(pir_limbs *limbs, const pir_int3 *const d[3], struct span_nearest *ret) {
    pir_int3 e = pir_num3_sub(limbs, d[1], d[0]), f = pir_num3_sub(limbs, d[2], d[0]);
    pir_int3 n = pir_num3_cross(limbs, &e, &f);
    for (int k = 0; k < 3; k++) {
        pir_int3 side = pir_num3_cross(limbs, d[(k + 1) % 3], d[(k + 2) % 3]);
        ret->weight[k] = pir_num3_dot(limbs, &n, &side);
    }
    pir_int height = pir_num3_dot(limbs, &n, d[0]);
    if (height.size < 0)
        negate(&n);
    if (height.size == 0)
        for (int k = 0; k < 3; k++)
            n.c[k].size = 0;
    ret->direction = n;
}

/* False where the nearest point of their span is not within their hull. */
static bool span_is_within(pir_limbs *limbs, const pir_int3 *const d[3], uint32_t count, struct span_nearest *ret) {
    if (count == 1) {
        ret->direction = *d[0];
        return true;
    }
    if (count == 2)
        span_two(limbs, d[0], d[1], ret);
    else
        span_three(limbs, d, ret);
    for (uint32_t k = 0; k < count; k++)
        if (ret->weight[k].size <= 0)
            return false;
    return true;
}

static int along_sign(pir_limbs *limbs, const pir_int3 *n, const pir_int3 *a, const pir_int3 *b) {
    uint32_t used = limbs->used;
    pir_int3 way = pir_num3_sub(limbs, a, b);
    pir_int along = pir_num3_dot(limbs, n, &way);
    limbs->used = used;
    return pir_int_sign(&along);
}

/* The points of `d` whose hull holds, inside, the point nearest to 0, as a set; 0 where a solid simplex holds 0. */
static uint32_t nearest_face(pir_limbs *limbs, const pir_int3 *d, uint32_t count, pir_int3 *ret_direction) {
    uint32_t base = limbs->used;
    for (uint32_t mask = 1; mask < 1u << count; mask++) {
        const pir_int3 *chosen[3];
        uint32_t size = 0;
        if (__builtin_popcount(mask) > 3)
            continue;
        for (uint32_t k = 0; k < count; k++)
            if (mask >> k & 1)
                chosen[size++] = &d[k];
        limbs->used = base;
        struct span_nearest n;
        if (!span_is_within(limbs, chosen, size, &n))
            continue;
        bool least = true;
        for (uint32_t k = 0; k < count && least; k++)
            least = (mask >> k & 1) || along_sign(limbs, &n.direction, &d[k], chosen[0]) >= 0;
        if (least) {
            *ret_direction = n.direction;
            return mask;
        }
    }
    return 0;
}

/* --- supports --- */

/* The vertex of P that is least along n, or the corner that is most: exactly; of equals the lowest. */
static uint32_t least_vertex(pir_contact_job *job, const pir_contact_place *place, const pir_int3 *n) {
    pir_vec3 u = pir_int3_unit(n);
    double least = HUGE_VAL, room = 16 * job->error;
    for (uint32_t v = 0; v < job->p->vertex_count; v++)
        least = pir_lesser(least, pir_vec_dot(u, job->vertex[v]));
    uint32_t best = UINT32_MAX, used = job->limbs.used;
    for (uint32_t v = 0; v < job->p->vertex_count; v++) {
        if (!(pir_vec_dot(u, job->vertex[v]) <= least + room))
            continue;
        if (best != UINT32_MAX) {
            struct exact_point a = placed(job, place, v), b = placed(job, place, best);
            pir_int3 way = between(&job->limbs, &a, &b);
            pir_int along = pir_num3_dot(&job->limbs, n, &way);
            job->limbs.used = used;
            if (along.size >= 0)
                continue;
        }
        best = v;
    }
    return best;
}

static uint32_t most_corner(pir_contact_job *job, const pir_near_triangle *s, const pir_int3 *n) {
    uint32_t best = 0;
    for (uint32_t k = 1; k < 3; k++)
        if (pir_exact_rise(job, n, s, best, s, k) > 0)
            best = k;
    return best;
}

int pir_exact_rise(pir_contact_job *job, const pir_int3 *n, const pir_near_triangle *s, uint32_t a,
                   const pir_near_triangle *t, uint32_t b) {
    uint32_t used = job->limbs.used;
    struct exact_point from = corner_at(job, s, a), to = corner_at(job, t, b);
    pir_int3 way = between(&job->limbs, &to, &from);
    pir_int along = pir_num3_dot(&job->limbs, n, &way);
    job->limbs.used = used;
    return pir_int_sign(&along);
}

int pir_exact_least(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                    const pir_int3 *n) {
    uint32_t used = job->limbs.used, v = least_vertex(job, place, n), k = most_corner(job, s, n);
    pir_int3 d = difference(job, place, s, v, k);
    pir_int along = pir_num3_dot(&job->limbs, n, &d);
    job->limbs.used = used;
    return pir_int_sign(&along);
}

/* --- the descent --- */

static void take(pir_contact_simplex *simplex, uint32_t mask) {
    uint32_t count = 0;
    for (uint32_t k = 0; k < simplex->count; k++)
        if (mask >> k & 1) {
            simplex->v[count] = simplex->v[k];
            simplex->w[count++] = simplex->w[k];
        }
    simplex->count = count;
}

/* One step: whether it was the last. */
static bool step_nearer(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                        pir_contact_simplex *simplex, bool *ret_meets) {
    pir_int3 d[4], n;
    for (uint32_t k = 0; k < simplex->count; k++)
        d[k] = difference(job, place, s, simplex->v[k], simplex->w[k]);
    uint32_t mask = nearest_face(&job->limbs, d, simplex->count, &n);
    *ret_meets = mask == 0 || pir_int3_is_zero(&n);
    if (*ret_meets)
        return true;
    const pir_int3 *first = &d[__builtin_ctz(mask)];
    take(simplex, mask);
    uint32_t v = least_vertex(job, place, &n), w = most_corner(job, s, &n);
    pir_int3 next = difference(job, place, s, v, w);
    if (along_sign(&job->limbs, &n, &next, first) >= 0)
        return true;
    simplex->v[simplex->count] = v;
    simplex->w[simplex->count++] = w;
    return false;
}

bool pir_exact_nearest(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                       pir_contact_simplex *simplex) {
    uint32_t used = job->limbs.used;
    bool meets = false;
    if (simplex->count == 0)
        *simplex = (pir_contact_simplex){.count = 1};
    job->counts.exact++;
    for (int step = 0; step < MOST_STEPS; step++) {
        bool last = step_nearer(job, place, s, simplex, &meets);
        job->limbs.used = used;
        if (last)
            break;
    }
    return meets;
}

pir_int3 pir_exact_direction(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                             const pir_contact_simplex *simplex, pir_exact_move *ret_move) {
    pir_limbs *limbs = &job->limbs;
    pir_int3 d[3], n, over;
    const pir_int3 *chosen[3] = {&d[0], &d[1], &d[2]};
    for (uint32_t k = 0; k < simplex->count; k++)
        d[k] = difference(job, place, s, simplex->v[k], simplex->w[k]);
    struct span_nearest nearest;
    (void)span_is_within(limbs, chosen, simplex->count, &nearest);
    n = over = nearest.direction;
    // what the difference was scaled by
    struct exact_point p = placed(job, place, simplex->v[0]), w = corner_at(job, s, simplex->w[0]);
    ret_move->under = pir_num_mul(limbs, &p.under, &w.under);
    if (simplex->count == 2) {
        pir_int whole = pir_num_add(limbs, &nearest.weight[0], &nearest.weight[1]);
        ret_move->under = pir_num_mul(limbs, &ret_move->under, &whole);
    } else if (simplex->count == 3) {
        pir_int height = pir_num3_dot(limbs, &n, &d[0]), square = pir_num3_dot(limbs, &n, &n);
        over = pir_num3_scale(limbs, &n, &height);
        ret_move->under = pir_num_mul(limbs, &ret_move->under, &square);
    }
    ret_move->over = over;
    negate(&ret_move->over);
    return n;
}

void pir_exact_weights(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                       const pir_contact_simplex *simplex, pir_int ret_weight[3]) {
    pir_int3 d[3];
    const pir_int3 *chosen[3] = {&d[0], &d[1], &d[2]};
    struct span_nearest nearest;
    for (uint32_t k = 0; k < simplex->count; k++)
        d[k] = difference(job, place, s, simplex->v[k], simplex->w[k]);
    nearest.weight[0] = pir_num_double(&job->limbs, 1, 0);
    (void)span_is_within(&job->limbs, chosen, simplex->count, &nearest);
    for (uint32_t k = 0; k < simplex->count; k++)
        ret_weight[k] = nearest.weight[k];
}

/* a/b in the unit of coordinates. */
static double ratio(const pir_contact_job *job, const pir_int *a, const pir_int *b) {
    int top, under;
    double x = pir_int_to_double(a, &top), y = pir_int_to_double(b, &under);
    return ldexp(x / y, top - under + job->exponent);
}

void pir_exact_way(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                   const pir_contact_simplex *simplex, pir_vec3 *ret_unit, pir_vec3 *ret_way) {
    uint32_t used = job->limbs.used;
    pir_exact_move move;
    pir_int3 n = pir_exact_direction(job, place, s, simplex, &move);
    *ret_unit = pir_int3_unit(&n);
    *ret_way = (pir_vec3){-ratio(job, &move.over.c[0], &move.under), -ratio(job, &move.over.c[1], &move.under),
                          -ratio(job, &move.over.c[2], &move.under)};
    job->limbs.used = used;
}

/* --- directions --- */

pir_int3 pir_exact_front(pir_contact_job *job, const pir_near_triangle *s) {
    pir_limbs *limbs = &job->limbs;
    struct exact_point a = corner_at(job, s, 0), b = corner_at(job, s, 1), c = corner_at(job, s, 2);
    pir_int3 e = between(limbs, &b, &a), f = between(limbs, &c, &a);
    return pir_num3_cross(limbs, &e, &f);
}

pir_int3 pir_exact_facet(pir_contact_job *job, uint32_t facet) {
    pir_int3 n = pir_normal_exact(job->p, facet);
    return multiply(&job->limbs, turn_of(&job->rotation), &n);
}

pir_int3 pir_exact_across(pir_contact_job *job, const pir_near_triangle *s, uint32_t k, uint32_t edge) {
    pir_limbs *limbs = &job->limbs;
    struct exact_point a = corner_at(job, s, k), b = corner_at(job, s, (k + 1) % 3);
    pir_int3 along = pir_vectors_at(&job->p->exact_edge, edge), e = between(limbs, &b, &a);
    pir_int3 f = multiply(limbs, turn_of(&job->rotation), &along);
    return pir_num3_cross(limbs, &e, &f);
}
