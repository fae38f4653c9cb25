/* SPDX-License-Identifier: MIT */
/*
 * Pieces are joined two by two into their convex hulls, the pair with the least proven error first (joint_error.h).
 *
 * Invariants: every exact piece is in the hull of the part that it went into; a part's error bounds how far it reaches
 * out of the union of the exact pieces; pairs that may be joined are in the list once, with a bound on the error that
 * comes of it. A part is paired with a few others near it, and when no pairs are left all parts are paired anew.
 * Doubles, those of lengths too, are scaled by 2^-shift, so that the greatest coordinate is about 1.
 */
#include "solid/pieces/approximate.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include <pirouette/exact.h>

#include "base/memory.h"
#include "base/vec.h"
#include "solid/pieces/joint_error.h"
#include "solid/pieces/piece_list.h"

#define NEIGHBOURS 8

struct joined_part {
    pir_joint_part joint;
    pir_polytope *polytope; /* NULL once it has been joined with another */
    uint32_t *vertex;       /* of the exact pieces: those that the part's exact hull has */
    uint32_t count, room;
    pir_vec3 low, high;
};

struct couple {
    double error;
    uint32_t a, b; /* parts, a < b */
};

struct approximation {
    const pir_pieces *pieces;
    const pir_allocator *allocator;
    struct joined_part *part; /* at most 2 · pieces − 1 */
    uint32_t part_count, part_room, left;
    struct couple *couple;
    uint32_t couple_count, couple_room;
    long shift;
    double tolerance;
    uint32_t most;
    pir_status status;
};

/* --- scale --- */

/* An e with |x| < 2^e, of numbers that are not 0. */
static long exponent_of(mpq_srcptr x) {
    return (long)mpz_sizeinbase(mpq_numref(x), 2) - (long)mpz_sizeinbase(mpq_denref(x), 2) + 1;
}

/* The exponent of the greatest coordinate of all. */
static long shift_of(const pir_pieces *pieces) {
    long most = LONG_MIN;
    for (size_t i = 0; i < 3 * (size_t)pieces->start[pieces->count]; i++)
        if (mpq_sgn(pieces->vertex[i]) != 0 && exponent_of(pieces->vertex[i]) > most)
            most = exponent_of(pieces->vertex[i]);
    return most > LONG_MIN ? most : 0;
}

/* x · 2^-shift, cut to a double; `room` is used. */
static double scaled(mpq_t room, mpq_srcptr x, long shift) {
    if (shift > 0)
        mpq_div_2exp(room, x, (mp_bitcnt_t)shift);
    else
        mpq_mul_2exp(room, x, (mp_bitcnt_t)-shift);
    return mpq_get_d(room);
}

/* A length times 2^shift; nothing is lost where the result is representable. */
static double length_scaled(double length, long shift) {
    return ldexp(length, shift > 4000 ? 4000 : shift < -4000 ? -4000 : (int)shift);
}

/* --- parts --- */

static void part_finish(struct approximation *job, struct joined_part *part) {
    pir_polytope_release(part->polytope);
    PIR_FREE(job->allocator, part->vertex, part->room);
    *part = (struct joined_part){0};
}

/* Keeps of these vertices those of their exact hull. Their numbers are borrowed while it is made. */
static pir_status keep_extreme(struct approximation *job, uint32_t *vertex, uint32_t *count) {
    const uint32_t given = *count;
    pir_polytope *hull = NULL;
    mpq_t *numbers = PIR_NEW(job->allocator, mpq_t, 3 * (size_t)given);
    if (!numbers)
        return PIR_ERR_MEMORY;
    for (uint32_t i = 0; i < given; i++)
        memcpy(numbers + 3 * (size_t)i, job->pieces->vertex + 3 * (size_t)vertex[i], 3 * sizeof *numbers);
    const pir_polytope_options options = {.size = sizeof options, .allocator = job->allocator};
    const pir_status status = pir_polytope_create_exact((const mpq_t *)numbers, given, &options, &hull);
    PIR_FREE(job->allocator, numbers, 3 * (size_t)given);
    if (status != PIR_OK)
        return status;
    // sources are not in order: what is kept is marked by the highest bit, then moved together
    for (uint32_t v = 0; v < pir_polytope_vertex_count(hull); v++)
        vertex[pir_polytope_source(hull, v)] |= 1u << 31;
    *count = 0;
    for (uint32_t i = 0; i < given; i++)
        if (vertex[i] >> 31)
            vertex[(*count)++] = vertex[i] & ~(1u << 31);
    pir_polytope_release(hull);
    return PIR_OK;
}

/*
 * Adds the hull of `count` vertices, all of them extreme, in an array of `room` that is taken over. Its polytope is of
 * the vertices as scaled doubles, which is what distances are measured with.
 */
static bool add_part(struct approximation *job, uint32_t *vertex, uint32_t count, uint32_t room, double error) {
    struct joined_part *part = &job->part[job->part_count++];
    *part = (struct joined_part){.vertex = vertex, .room = room, .count = count};
    pir_vec3 *point = PIR_NEW(job->allocator, pir_vec3, count);
    mpq_t room_of_one;
    mpq_init(room_of_one);
    for (uint32_t i = 0; i < count && point; i++) {
        const mpq_t *x = (const mpq_t *)job->pieces->vertex + 3 * (size_t)vertex[i];
        point[i] = (pir_vec3){scaled(room_of_one, x[0], job->shift), scaled(room_of_one, x[1], job->shift),
                              scaled(room_of_one, x[2], job->shift)};
    }
    mpq_clear(room_of_one);
    const pir_polytope_options options = {.size = sizeof options, .allocator = job->allocator};
    job->status = point ? pir_polytope_create(point, count, &options, &part->polytope) : PIR_ERR_MEMORY;
    PIR_FREE(job->allocator, point, count);
    if (job->status != PIR_OK)
        return false;
    part->joint = (pir_joint_part){part->polytope, error};
    pir_polytope_bounds(part->polytope, &part->low, &part->high);
    job->left++;
    return true;
}

static bool add_exact_parts(struct approximation *job) {
    const pir_pieces *pieces = job->pieces;
    for (uint32_t i = 0; i < pieces->count; i++) {
        const uint32_t first = pieces->start[i], count = pieces->start[i + 1] - first;
        uint32_t *vertex = PIR_NEW(job->allocator, uint32_t, count);
        for (uint32_t k = 0; k < count && vertex; k++)
            vertex[k] = first + k;
        if (!vertex)
            job->status = PIR_ERR_MEMORY;
        if (!vertex || !add_part(job, vertex, count, count, 0))
            return false;
    }
    return true;
}

/* --- couples --- */

static double sides(pir_vec3 low, pir_vec3 high) {
    return (high.x - low.x) + (high.y - low.y) + (high.z - low.z);
}

/* How far two boxes are from each other along the axis where they are farthest. */
static double gap(const struct joined_part *a, const struct joined_part *b) {
    const double x = fmax(a->low.x - b->high.x, b->low.x - a->high.x),
                 y = fmax(a->low.y - b->high.y, b->low.y - a->high.y),
                 z = fmax(a->low.z - b->high.z, b->low.z - a->high.z);
    return fmax(0, fmax(x, fmax(y, z)));
}

/* How much longer the sides of a box about both are than those of the larger one. */
static double growth(const struct joined_part *a, const struct joined_part *b) {
    const pir_vec3 low = {fmin(a->low.x, b->low.x), fmin(a->low.y, b->low.y), fmin(a->low.z, b->low.z)};
    const pir_vec3 high = {fmax(a->high.x, b->high.x), fmax(a->high.y, b->high.y), fmax(a->high.z, b->high.z)};
    return sides(low, high) - fmax(sides(a->low, a->high), sides(b->low, b->high));
}

static bool is_listed(const struct approximation *job, struct couple couple) {
    for (uint32_t i = 0; i < job->couple_count; i++)
        if (job->couple[i].a == couple.a && job->couple[i].b == couple.b)
            return true;
    return false;
}

static bool add_couple(struct approximation *job, uint32_t a, uint32_t b) {
    const double limit = job->most > 0 ? HUGE_VAL : job->tolerance;
    struct couple couple = {0, a < b ? a : b, a < b ? b : a};
    if (is_listed(job, couple))
        return true;
    couple.error = pir_joint_error(&job->part[couple.a].joint, &job->part[couple.b].joint, limit);
    if (!(couple.error < limit))
        return true;
    if (job->couple_count == job->couple_room) {
        const uint32_t room = 2 * job->couple_room + 64;
        void *grown = PIR_RESIZE(job->allocator, job->couple, job->couple_room, room);
        if (!grown) {
            job->status = PIR_ERR_MEMORY;
            return false;
        }
        job->couple = grown;
        job->couple_room = room;
    }
    job->couple[job->couple_count++] = couple;
    return true;
}

/* The couples of a part with the NEIGHBOURS others whose boxes make the smallest one with its box. */
static bool add_couples(struct approximation *job, uint32_t part) {
    uint32_t near[NEIGHBOURS], count = 0;
    double by[NEIGHBOURS];
    for (uint32_t other = 0; other < job->part_count; other++) {
        const struct joined_part *a = &job->part[part], *b = &job->part[other];
        if (other == part || !b->polytope || (job->most == 0 && gap(a, b) > job->tolerance))
            continue;
        const double own = growth(a, b);
        uint32_t at = count < NEIGHBOURS ? count++ : NEIGHBOURS;
        for (; at > 0 && own < by[at - 1]; at--)
            if (at < NEIGHBOURS)
                by[at] = by[at - 1], near[at] = near[at - 1];
        if (at < NEIGHBOURS)
            by[at] = own, near[at] = other;
    }
    for (uint32_t k = 0; k < count; k++)
        if (!add_couple(job, part, near[k]))
            return false;
    return true;
}

static bool add_all_couples(struct approximation *job) {
    for (uint32_t i = 0; i < job->part_count; i++)
        if (job->part[i].polytope && !add_couples(job, i))
            return false;
    return job->couple_count > 0;
}

static bool couple_before(const struct couple *a, const struct couple *b) {
    return a->error != b->error ? a->error < b->error : a->a != b->a ? a->a < b->a : a->b < b->b;
}

/* Takes the least couple out of the list, and with it those of parts that are gone. */
static struct couple take_least(struct approximation *job) {
    uint32_t count = 0, least = 0;
    for (uint32_t i = 0; i < job->couple_count; i++)
        if (job->part[job->couple[i].a].polytope && job->part[job->couple[i].b].polytope)
            job->couple[count++] = job->couple[i];
    for (uint32_t i = 1; i < count; i++)
        if (couple_before(&job->couple[i], &job->couple[least]))
            least = i;
    job->couple_count = count;
    if (count == 0)
        return (struct couple){HUGE_VAL, 0, 0};
    const struct couple couple = job->couple[least];
    job->couple[least] = job->couple[--job->couple_count];
    return couple;
}

/* --- joining --- */

static bool join(struct approximation *job, const struct couple *couple) {
    struct joined_part *a = &job->part[couple->a], *b = &job->part[couple->b];
    const uint32_t room = a->count + b->count, made = job->part_count;
    uint32_t *vertex = PIR_NEW(job->allocator, uint32_t, room), count = room;
    if (!vertex) {
        job->status = PIR_ERR_MEMORY;
        return false;
    }
    memcpy(vertex, a->vertex, a->count * sizeof *vertex);
    memcpy(vertex + a->count, b->vertex, b->count * sizeof *vertex);
    job->status = keep_extreme(job, vertex, &count);
    if (job->status != PIR_OK) {
        PIR_FREE(job->allocator, vertex, room);
        return false;
    }
    part_finish(job, a);
    part_finish(job, b);
    job->left -= 2;
    return add_part(job, vertex, count, room, couple->error) && add_couples(job, made);
}

static bool is_wanted(const struct approximation *job, double error) {
    return error <= job->tolerance || (job->most > 0 && job->left > job->most);
}

static void join_all(struct approximation *job) {
    uint32_t listed_at = job->left + 1; // how many parts there were when all couples were listed
    while (job->left > 1 && job->status == PIR_OK) {
        const struct couple couple = take_least(job);
        if (couple.error < HUGE_VAL && is_wanted(job, couple.error)) {
            if (!join(job, &couple))
                return;
        } else if (couple.error < HUGE_VAL || job->left == listed_at) {
            return;
        } else {
            listed_at = job->left;
            if (!add_all_couples(job))
                return;
        }
    }
}

/* --- the result --- */

static pir_pieces *result_of(const struct approximation *job, double *ret_error) {
    uint32_t vertices = 0, at = 0, piece = 0;
    for (uint32_t i = 0; i < job->part_count; i++)
        vertices += job->part[i].polytope ? job->part[i].count : 0;
    pir_pieces *made = pir_pieces_new(job->allocator, job->left, vertices);
    *ret_error = 0;
    for (uint32_t i = 0; i < job->part_count && made; i++) {
        const struct joined_part *part = &job->part[i];
        if (!part->polytope)
            continue;
        *ret_error = fmax(*ret_error, part->joint.error);
        for (uint32_t v = 0; v < part->count; v++, at++)
            for (uint32_t k = 0; k < 3; k++)
                mpq_set(made->vertex[3 * (size_t)at + k], job->pieces->vertex[3 * (size_t)part->vertex[v] + k]);
        made->start[++piece] = at;
    }
    return made;
}

pir_status pir_pieces_approximate(pir_pieces **pieces, uint32_t most, double tolerance, double *ret_error) {
    const pir_allocator allocator = (*pieces)->allocator;
    struct approximation job = {
        .pieces = *pieces, .allocator = &allocator, .most = most, .part_room = 2 * (*pieces)->count};
    *ret_error = 0;
    if ((*pieces)->count < 2)
        return PIR_OK;
    job.shift = shift_of(*pieces);
    job.tolerance = length_scaled(tolerance, -job.shift);
    job.part = PIR_ZEROED(job.allocator, struct joined_part, job.part_room);
    job.status = job.part ? PIR_OK : PIR_ERR_MEMORY;
    if (job.status == PIR_OK && add_exact_parts(&job))
        join_all(&job);
    if (job.status == PIR_OK && job.left < job.pieces->count) {
        double error;
        pir_pieces *made = result_of(&job, &error);
        if (made) {
            // up: the least numbers that there are have fewer bits
            *ret_error = error > 0 ? nextafter(length_scaled(error, job.shift), HUGE_VAL) : 0;
            pir_pieces_destroy(*pieces);
            *pieces = made;
        } else {
            job.status = PIR_ERR_MEMORY;
        }
    }
    for (uint32_t i = 0; i < job.part_count; i++)
        part_finish(&job, &job.part[i]);
    PIR_FREE(job.allocator, job.part, job.part_room);
    PIR_FREE(job.allocator, job.couple, job.couple_room);
    return job.status;
}
