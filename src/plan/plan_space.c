/* SPDX-License-Identifier: MIT */
/* See plan_space.h. */
#include "plan/plan_space.h"

#include <string.h>

#include "base/memory.h"

/* Numbers of planes, points and lists stay below this. */
#define MOST_NUMBERS (1u << 30)

void pir_plan_space_init(pir_plan_space *space, const pir_allocator *allocator, size_t limit) {
    *space = (pir_plan_space){.allocator = *allocator, .limit = limit};
    for (int i = 0; i < 6; i++)
        mpz_init(space->t[i]);
}

void pir_plan_space_finish(pir_plan_space *space) {
    for (uint32_t i = 0; i < space->plane_count; i++)
        mpz_clears(space->plane[i].n[0], space->plane[i].n[1], space->plane[i].n[2], space->plane[i].d, NULL);
    for (uint32_t i = 0; i < space->point_count; i++)
        if (space->point[i].is_exact)
            mpz_clears(space->point[i].x[0], space->point[i].x[1], space->point[i].x[2], space->point[i].w, NULL);
    pir_plan_free(space, space->plane, space->plane_room, sizeof *space->plane);
    pir_plan_free(space, space->point, space->point_room, sizeof *space->point);
    pir_plan_free(space, space->table, space->table_size, sizeof *space->table);
    for (int i = 0; i < 6; i++)
        mpz_clear(space->t[i]);
}

/* --- memory --- */

static bool charge(pir_plan_space *space, size_t bytes) {
    if (space->status == PIR_OK && bytes > space->limit - space->used)
        space->status = PIR_ERR_LIMIT;
    if (space->status != PIR_OK)
        return false;
    space->used += bytes;
    return true;
}

void *pir_plan_new(pir_plan_space *space, size_t count, size_t size) {
    if (!charge(space, count * size))
        return NULL;
    void *block = pir_memory_zeroed(&space->allocator, count, size);
    if (!block) {
        space->used -= count * size;
        space->status = PIR_ERR_MEMORY;
    }
    return block;
}

void pir_plan_free(pir_plan_space *space, void *block, size_t count, size_t size) {
    if (block)
        space->used -= count * size;
    pir_memory_free(&space->allocator, block, count, size);
}

bool pir_plan_grow(pir_plan_space *space, void **array, uint32_t *room, uint32_t need, size_t size) {
    if (need <= *room)
        return space->status == PIR_OK;
    const uint32_t more = need < 8 ? 8 : need + need / 2;
    if (need > MOST_NUMBERS && space->status == PIR_OK)
        space->status = PIR_ERR_LIMIT;
    if (!charge(space, (more - *room) * size))
        return false;
    void *grown = pir_memory_resize(&space->allocator, *array, *room, more, size);
    if (!grown) {
        space->used -= (more - *room) * size;
        space->status = PIR_ERR_MEMORY;
        return false;
    }
    *array = grown;
    *room = more;
    return true;
}

/* --- planes --- */

static uint32_t hash_number(uint32_t h, const mpz_t number) {
    h = (h ^ (uint32_t)(mpz_sgn(number) + 1)) * 0x9e3779b1u;
    for (size_t i = 0; i < mpz_size(number); i++) {
        const uint64_t limb = mpz_getlimbn(number, (mp_size_t)i);
        h = (h ^ (uint32_t)(limb ^ limb >> 32)) * 0x85ebca6bu;
        h ^= h >> 15;
    }
    return h;
}

static uint32_t hash_plane(mpz_t *n, const mpz_t d) {
    return hash_number(hash_number(hash_number(hash_number(0, n[0]), n[1]), n[2]), d);
}

static bool grow_table(pir_plan_space *space) {
    if (space->plane_count < space->table_size)
        return true;
    const uint32_t size = space->table_size == 0 ? 64 : 2 * space->table_size;
    uint32_t *table = pir_plan_new(space, size, sizeof *table);
    if (!table)
        return false;
    memset(table, 0xff, size * sizeof *table);
    for (uint32_t i = 0; i < space->plane_count; i++) {
        pir_plan_plane *p = &space->plane[i];
        uint32_t *slot = &table[hash_plane(p->n, p->d) & (size - 1)];
        p->next = *slot;
        *slot = i;
    }
    pir_plan_free(space, space->table, space->table_size, sizeof *space->table);
    space->table = table;
    space->table_size = size;
    return true;
}

/* A number over 2^exponent, within 2^-52 of it. */
static double over_power(const mpz_t number, long exponent) {
    long own;
    const double m = mpz_get_d_2exp(&own, number);
    return own - exponent < -4000 ? 0 : ldexp(m, own - exponent > 4000 ? 4000 : (int)(own - exponent));
}

static void round_plane(pir_plan_plane *p) {
    long top = 0;
    for (int k = 0; k < 3; k++) {
        long own;
        mpz_get_d_2exp(&own, p->n[k]);
        top = mpz_sgn(p->n[k]) != 0 && own > top ? own : top;
    }
    for (int k = 0; k < 3; k++)
        p->a[k] = over_power(p->n[k], top);
    p->b = over_power(p->d, top);
}

/* Divides by the greatest common divisor; whether the signs were changed. */
static bool make_coprime(pir_plan_space *space, mpz_t *n, mpz_t d) {
    mpz_ptr g = space->t[5];
    mpz_gcd(g, n[0], n[1]);
    mpz_gcd(g, g, n[2]);
    mpz_gcd(g, g, d);
    const int first = mpz_sgn(n[0]) ? mpz_sgn(n[0]) : mpz_sgn(n[1]) ? mpz_sgn(n[1]) : mpz_sgn(n[2]);
    if (first < 0)
        mpz_neg(g, g);
    for (int k = 0; k < 3; k++)
        mpz_divexact(n[k], n[k], g);
    mpz_divexact(d, d, g);
    return first < 0;
}

uint32_t pir_plan_half(pir_plan_space *space, mpz_t *n, mpz_t d) {
    const bool turned = make_coprime(space, n, d);
    if (!grow_table(space) ||
        !pir_plan_grow(space, (void **)&space->plane, &space->plane_room, space->plane_count + 1, sizeof *space->plane))
        return 0;
    uint32_t *slot = &space->table[hash_plane(n, d) & (space->table_size - 1)];
    for (uint32_t i = *slot; i != PIR_PLAN_NONE; i = space->plane[i].next) {
        const pir_plan_plane *p = &space->plane[i];
        if (mpz_cmp(p->n[0], n[0]) == 0 && mpz_cmp(p->n[1], n[1]) == 0 && mpz_cmp(p->n[2], n[2]) == 0 &&
            mpz_cmp(p->d, d) == 0)
            return i << 1 | turned;
    }
    pir_plan_plane *p = &space->plane[space->plane_count];
    for (int k = 0; k < 3; k++)
        mpz_init_set(p->n[k], n[k]);
    mpz_init_set(p->d, d);
    round_plane(p);
    p->next = *slot;
    *slot = space->plane_count++;
    return *slot << 1 | turned;
}

/* --- points --- */

static double quotient(const mpz_t x, const mpz_t w) {
    long of_x, of_w;
    const double a = mpz_get_d_2exp(&of_x, x), b = mpz_get_d_2exp(&of_w, w);
    const long exponent = of_x - of_w;
    return a == 0 || exponent < -4000 ? 0 : ldexp(a / b, exponent > 4000 ? 4000 : (int)exponent);
}

/* How many points may stand on each other before integers are made at once. */
#define MOST_DEPTH 128

/* How small errors are to be beside values. */
#define WELL_POSED 0x1p-16

/* A new point. */
static pir_plan_point *open_point(pir_plan_space *space) {
    if (!pir_plan_grow(space, (void **)&space->point, &space->point_room, space->point_count + 1, sizeof *space->point))
        return NULL;
    pir_plan_point *p = &space->point[space->point_count++];
    *p = (pir_plan_point){.plane = PIR_PLAN_NONE};
    return p;
}

/* Has room for the integers of a point, which are then set and closed. */
static void open_numbers(pir_plan_point *p) {
    mpz_inits(p->x[0], p->x[1], p->x[2], p->w, NULL);
    p->is_exact = true;
}

static void close_numbers(pir_plan_space *space, pir_plan_point *p) {
    mpz_ptr g = space->t[5];
    mpz_gcd(g, p->x[0], p->x[1]);
    mpz_gcd(g, g, p->x[2]);
    mpz_gcd(g, g, p->w);
    size_t limbs = 0;
    for (int k = 0; k < 3; k++) {
        mpz_divexact(p->x[k], p->x[k], g);
        limbs += mpz_size(p->x[k]);
    }
    mpz_divexact(p->w, p->w, g);
    for (int k = 0; k < 3; k++)
        p->at[k] = quotient(p->x[k], p->w);
    p->room = 0;
    charge(space, (limbs + mpz_size(p->w)) * sizeof(mp_limb_t));
}

uint32_t pir_plan_point_of(pir_plan_space *space, const mpq_t x[3]) {
    pir_plan_point *p = open_point(space);
    if (!p)
        return 0;
    open_numbers(p);
    mpz_lcm(p->w, mpq_denref(x[0]), mpq_denref(x[1]));
    mpz_lcm(p->w, p->w, mpq_denref(x[2]));
    for (int k = 0; k < 3; k++) {
        mpz_divexact(p->x[k], p->w, mpq_denref(x[k]));
        mpz_mul(p->x[k], p->x[k], mpq_numref(x[k]));
    }
    close_numbers(space, p);
    return space->point_count - 1;
}

uint32_t pir_plan_point_at(pir_plan_space *space, const double x[3]) {
    mpq_t q[3];
    for (int k = 0; k < 3; k++) {
        mpq_init(q[k]);
        mpq_set_d(q[k], x[k]);
    }
    const uint32_t point = pir_plan_point_of(space, (const mpq_t *)q);
    mpq_clears(q[0], q[1], q[2], NULL);
    return point;
}

/* The product of n and x less d and w, times a sign. */
static void set_excess(const pir_plan_plane *h, const pir_plan_point *p, mpz_t ret) {
    mpz_mul(ret, h->n[0], p->x[0]);
    mpz_addmul(ret, h->n[1], p->x[1]);
    mpz_addmul(ret, h->n[2], p->x[2]);
    mpz_submul(ret, h->d, p->w);
}

const pir_plan_point *pir_plan_point_exact(pir_plan_space *space, uint32_t point) {
    pir_plan_point *p = &space->point[point];
    if (p->is_exact)
        return p;
    const pir_plan_point *a = pir_plan_point_exact(space, p->end[0]), *b = pir_plan_point_exact(space, p->end[1]);
    mpz_ptr of_a = space->t[0], of_b = space->t[1];
    set_excess(&space->plane[p->plane], a, of_a);
    set_excess(&space->plane[p->plane], b, of_b);
    open_numbers(p);
    // b's excess times A, less a's, which is negative, times B: on the plane, with a positive last number
    for (int k = 0; k < 3; k++) {
        mpz_mul(p->x[k], of_b, a->x[k]);
        mpz_submul(p->x[k], of_a, b->x[k]);
    }
    mpz_mul(p->w, of_b, a->w);
    mpz_submul(p->w, of_a, b->w);
    close_numbers(space, p);
    return p;
}

void pir_plan_excess(pir_plan_space *space, uint32_t half, uint32_t point, mpz_t ret_excess) {
    set_excess(&space->plane[half >> 1], pir_plan_point_exact(space, point), ret_excess);
    if (half & 1)
        mpz_neg(ret_excess, ret_excess);
}

int pir_plan_exact_side(pir_plan_space *space, uint32_t plane, uint32_t point) {
    pir_plan_excess(space, plane << 1, point, space->t[4]);
    return mpz_sgn(space->t[4]);
}

uint32_t pir_plan_point_between(pir_plan_space *space, uint32_t plane, uint32_t below, uint32_t above) {
    pir_plan_point *p = open_point(space);
    if (!p)
        return 0;
    const pir_plan_point *a = &space->point[below], *b = &space->point[above];
    const uint16_t depth = a->depth > b->depth ? a->depth : b->depth;
    double of_a, of_b;
    const double at_a = pir_plan_value(space, plane, below, &of_a), at_b = pir_plan_value(space, plane, above, &of_b);
    const double whole = at_b - at_a, part = 2 * (of_a + of_b) / whole;
    double size = 0, way = 0;
    p->plane = plane;
    p->end[0] = below;
    p->end[1] = above;
    for (int k = 0; k < 3; k++) {
        p->at[k] = (at_b * a->at[k] - at_a * b->at[k]) / whole;
        size = fmax(size, fmax(fabs(a->at[k]), fabs(b->at[k])));
        way = fmax(way, fabs(a->at[k] - b->at[k]));
    }
    p->room = (fmax(a->room, b->room) + way * part) * (1 + 0x1p-12) + size * 0x1p-46;
    p->depth = (uint16_t)(depth + 1);
    // ends that are exact from now on end what stands on each other
    if (!(at_a < 0 && at_b > 0 && part < WELL_POSED && depth < MOST_DEPTH && isfinite(p->room))) {
        p->depth = 0;
        pir_plan_point_exact(space, space->point_count - 1);
    }
    return space->point_count - 1;
}

uint32_t pir_plan_point_mean(pir_plan_space *space, const uint32_t *points, uint32_t count) {
    mpq_t mean[3], x;
    mpq_init(x);
    for (int k = 0; k < 3; k++) {
        mpq_init(mean[k]);
        for (uint32_t i = 0; i < count; i++) {
            const pir_plan_point *p = pir_plan_point_exact(space, points[i]);
            mpz_set(mpq_numref(x), p->x[k]);
            mpz_set(mpq_denref(x), p->w);
            mpq_canonicalize(x);
            mpq_add(mean[k], mean[k], x);
        }
        mpz_mul_ui(mpq_denref(mean[k]), mpq_denref(mean[k]), count);
        mpq_canonicalize(mean[k]);
    }
    const uint32_t point = pir_plan_point_of(space, (const mpq_t *)mean);
    mpq_clears(mean[0], mean[1], mean[2], x, NULL);
    return point;
}

double pir_plan_distance(const pir_plan_space *space, uint32_t half, uint32_t point) {
    const pir_plan_plane *p = &space->plane[half >> 1];
    const double *x = space->point[point].at;
    const double s = p->a[0] * x[0] + p->a[1] * x[1] + p->a[2] * x[2] - p->b;
    const double length = sqrt(p->a[0] * p->a[0] + p->a[1] * p->a[1] + p->a[2] * p->a[2]);
    return (half & 1 ? -s : s) / length;
}
