/* SPDX-License-Identifier: MIT */
/*
 * The nearest rotation of the Hopf grid from tables.
 *
 * Invariant: the circle that holds the rotation nearest to a quaternion whose point on the sphere has x, y ≥ 0, and
 * all that come within MARGIN of it, are listed in the cell of that point. Other points are brought there by quarter
 * turns about z, which multiply b by powers of i and take pixels to those of other faces.
 *
 * Cells. The octant is cut, as the triangle with corners on the axes, by a square lattice. A cell's points lie within
 * ρ of its middle, the greatest angle to its corners, for planes through the origin bound it. A circle whose centre
 * is an angle δ from the point comes as close as cos δ/2. It has a rotation at least as close as cos δ/2·cos s/2,
 * where s/2 is half the way between two. With δ* that of the centre nearest to the middle, the nearest rotation to any
 * quaternion of the cell has at least the closeness cos((δ* + ρ)/2)·cos s/2. A circle is left out where even
 * cos((δ − ρ)/2) is less. The lists of a square's quarters are sought in its own.
 *
 * On a circle. The product with the rotation at ψ is the real part of e^{−iψ/2}·h (circle.h). The direction of ±h
 * in the upper half-plane, as x/(|x| + y), falls into a bucket. A bucket is narrower than a step, so the nearest
 * rotation is that of the bucket's beginning or the next; were it any other, the one taken would not be closer than the
 * next by MARGIN.
 *
 * Errors. Closeness is at most 1, and off by less than 20u here and in hopf_nearest.c. So where the closest is so by
 * more than MARGIN, the search finds the same.
 */
#include "cspace/grid/hopf_lookup.h"

#include <math.h>

#include "base/layout.h"
#include "base/vec.h"
#include "cspace/grid/circle.h"

#define MARGIN 1e-12
/* The error of angles of cells, many times over. */
#define WIDE 1e-9

/* --- the tables --- */

/* Circles that are being listed, of one octant. */
struct cell_lists {
    pir_hopf_lookup *lookup;
    uint32_t south;
    double close_square; /* the least closeness on a circle relative to the greatest, squared */
};

/* The square of an octant's triangle with a corner at (u, v)/side. */
struct cell_square {
    uint32_t u, v, size;
};

static pir_layout layout_of(pir_hopf_lookup *lookup, const pir_hopf *hopf) {
    return (pir_layout){{PIR_ROW(lookup->circle, hopf->pixels), PIR_ROW(lookup->rank, hopf->pixels),
                         PIR_ROW(lookup->turn, hopf->around + 1), PIR_ROW(lookup->bucket, lookup->buckets),
                         PIR_ROW(lookup->cell, 2 * (size_t)lookup->side * lookup->side)}};
}

/* The direction of a point of the octant's triangle. */
static pir_vec3 direction_at(const struct cell_lists *listing, double u, double v) {
    const double x = u / listing->lookup->side, y = v / listing->lookup->side, z = 1 - x - y;
    const double by = 1 / sqrt(x * x + y * y + z * z);
    return (pir_vec3){x * by, y * by, listing->south ? -z * by : z * by};
}

static double cosine_between(pir_vec3 a, pir_vec3 b) {
    const double cosine = pir_vec_dot(a, b);
    return cosine > 1 ? 1 : cosine < -1 ? -1 : cosine;
}

/* The point of a circle on the sphere. */
static pir_vec3 centre_of(const pir_looked_circle *circle) {
    const double twice = 2 * circle->upper;
    return (pir_vec3){twice * circle->lower.cos, twice * circle->lower.sin, twice * circle->upper - 1};
}

/* The cosine of the sum of two angles, −1 where it is beyond half a turn, by their cosines. */
static double cosine_of_sum(double a, double b) {
    return a <= -b ? -1 : a * b - sqrt((1 - a * a) * (1 - b * b));
}

/* The cosine of the first less the other, 1 where that is below 0. */
static double cosine_of_rest(double a, double b) {
    return a >= b ? 1 : a * b + sqrt((1 - a * a) * (1 - b * b));
}

/* Lists the circles that any point of a square needs in `ret_list`; returns their number. */
static uint32_t list_needed(const struct cell_lists *listing, const struct cell_square *square, const uint32_t *list,
                            uint32_t count, uint32_t *ret_list) {
    const double u = square->u, v = square->v, size = square->size;
    const pir_vec3 middle = direction_at(listing, u + size / 2, v + size / 2);
    const pir_looked_circle *circle = listing->lookup->circle;
    double reach = 1, nearest = -1;
    for (int k = 0; k < 4; k++) {
        const double corner = cosine_between(middle, direction_at(listing, u + (k & 1) * size, v + (k >> 1) * size));
        reach = corner < reach ? corner : reach;
    }
    for (uint32_t k = 0; k < count; k++) {
        const double cosine = cosine_between(middle, centre_of(&circle[list[k]]));
        nearest = cosine > nearest ? cosine : nearest;
    }
    const double least = (1 + cosine_of_sum(nearest, reach)) * listing->close_square - WIDE;
    uint32_t needed = 0;
    for (uint32_t k = 0; k < count; k++)
        if (1 + cosine_of_rest(cosine_between(middle, centre_of(&circle[list[k]])), reach) >= least)
            ret_list[needed++] = list[k];
    return needed;
}

/* Lists the circles of a square's cells, of those of `list`, behind which there is room for the lists of its parts. */
static void list_square(struct cell_lists *listing, struct cell_square square, uint32_t *list, uint32_t count) {
    pir_hopf_lookup *lookup = listing->lookup;
    // beyond the triangle there are no points, but rounding may reach the squares that touch it
    if (square.u + square.v > lookup->side)
        return;
    uint32_t *needed = list + count;
    const uint32_t most = list_needed(listing, &square, list, count, needed), size = square.size / 2;
    for (uint32_t k = 0; size > 0 && k < 4; k++) {
        const struct cell_square part = {square.u + (k & 1) * size, square.v + (k >> 1) * size, size};
        list_square(listing, part, needed, most);
    }
    if (size > 0)
        return;
    pir_looked_cell *cell = &lookup->cell[(listing->south * lookup->side + square.u) * lookup->side + square.v];
    cell->count = most <= PIR_LOOKED_MOST ? (uint16_t)most : 0;
    for (uint32_t k = 0; k < cell->count; k++)
        cell->place[k] = (uint16_t)needed[k];
}

/* Lists the circles of all cells. */
static void list_all(pir_hopf_lookup *lookup, const pir_hopf *hopf, uint32_t *room) {
    struct cell_lists listing = {.lookup = lookup, .close_square = 1 / (1 + lookup->half_step * lookup->half_step)};
    for (listing.south = 0; listing.south < 2; listing.south++) {
        for (uint32_t place = 0; place < hopf->pixels; place++)
            room[place] = place;
        list_square(&listing, (struct cell_square){0, 0, lookup->side}, room, hopf->pixels);
    }
}

static void set_circles(pir_hopf_lookup *lookup, const pir_hopf *hopf) {
    const uint64_t around = hopf->around;
    for (uint32_t rank = 0; rank < hopf->pixels; rank++) {
        const pir_pixel pixel = pir_pixel_path_at(hopf->level, rank);
        const pir_circle circle = pir_circle_of(hopf->level, pixel);
        const uint32_t place = (((pixel.face << hopf->level) + pixel.i) << hopf->level) + pixel.j;
        lookup->rank[place] = rank;
        lookup->circle[place] =
            (pir_looked_circle){circle.upper, {circle.lower * circle.phi.cos, circle.lower * circle.phi.sin}};
    }
    for (uint32_t k = 0; k <= hopf->around; k++)
        lookup->turn[k] = pir_circle_at(2 * (uint64_t)k + 1, 4 * around);
    lookup->step = pir_circle_at(1, 2 * around);
    const pir_circle_point half = pir_circle_at(1, 4 * around);
    lookup->half_step = half.sin / half.cos;
    for (uint32_t b = 0; b < lookup->buckets; b++) {
        const double x = 1 - 2 * (double)b / lookup->buckets;
        const uint32_t k = (uint32_t)(2 * pir_turn_part(x, 1 - fabs(x)) * (double)around);
        lookup->bucket[b] = (uint16_t)(k < hopf->around ? k : hopf->around - 1);
    }
}

bool pir_hopf_lookup_init(pir_hopf_lookup *lookup, const pir_hopf *hopf, const pir_allocator *allocator) {
    *lookup = (pir_hopf_lookup){.side = 0};
    if (hopf->level > PIR_LOOKUP_LEVEL_MAX)
        return true;
    lookup->side = (uint32_t)8 << hopf->level;
    lookup->buckets = 4 * hopf->around;
    pir_layout layout = layout_of(lookup, hopf);
    // a list for each halving of squares, each as long as the one before at most
    const size_t room_size = (size_t)hopf->pixels * (hopf->level + 5);
    uint32_t *room = PIR_NEW(allocator, uint32_t, room_size);
    bool made = room && pir_layout_new(allocator, &layout);
    if (made) {
        set_circles(lookup, hopf);
        list_all(lookup, hopf, room);
    }
    PIR_FREE(allocator, room, room_size);
    if (!made)
        lookup->side = 0;
    return made;
}

void pir_hopf_lookup_finish(pir_hopf_lookup *lookup, const pir_hopf *hopf, const pir_allocator *allocator) {
    if (lookup->side == 0)
        return;
    pir_layout layout = layout_of(lookup, hopf);
    pir_layout_free(allocator, &layout);
}

/* --- looking up --- */

/* A quaternion brought to x, y ≥ 0 by quarter turns about z, and its cell. */
struct looked_quat {
    uint32_t quarters;
    double ax, aw, by, bz; /* a and b */
    const pir_looked_cell *cell;
};

static inline struct looked_quat turned_of(const pir_hopf_lookup *lookup, pir_quat q) {
    const double z = q.w * q.w + q.x * q.x - q.y * q.y - q.z * q.z;
    const double x = q.w * q.y + q.x * q.z, y = q.w * q.z - q.x * q.y;
    const double by = lookup->side / (2 * (fabs(x) + fabs(y)) + fabs(z));
    // quadrants 0 to 3 count from x, y ≥ 0 on
    const uint32_t below = y < 0, odd = (uint32_t)(x < 0) ^ below, last = lookup->side - 1;
    const double across[2] = {fabs(x), fabs(y)}, b[2] = {q.y, q.z};
    const uint32_t u = (uint32_t)(2 * across[odd] * by), v = (uint32_t)(2 * across[1 - odd] * by);
    const uint32_t at = ((z < 0) * lookup->side + (u < last ? u : last)) * lookup->side + (v < last ? v : last);
    // b·(−i)^quarters
    const double sign[2] = {1, -1};
    return (struct looked_quat){2 * below + odd,  q.x, q.w, sign[below] * b[odd], sign[below ^ odd] * b[1 - odd],
                                &lookup->cell[at]};
}

/* The nearest rotation of a circle. */
struct looked_rotation {
    double close, other; /* how close it is, and the next of the circle */
    uint32_t k, place;
};

/* No branch depends on where the rotation is, for it would be foretold wrongly half the time. */
static inline struct looked_rotation nearest_on(const pir_hopf_lookup *lookup, uint32_t place,
                                                const struct looked_quat *q) {
    const pir_looked_circle *circle = &lookup->circle[place];
    const double c = circle->lower.cos, s = circle->lower.sin, upper = circle->upper;
    double x = q->aw * upper + q->by * c + q->bz * s, y = q->ax * upper + q->bz * c - q->by * s;
    x = copysign(1, y) * x;
    y = fabs(y);
    // far from all of the circle x and y may be 0, and the bucket any
    const double part = 0.5 * (1 - x / (fabs(x) + y + 0x1p-1000));
    const uint32_t b = (uint32_t)(part * lookup->buckets), last = lookup->buckets - 1;
    uint32_t k = lookup->bucket[b < last ? b : last];
    const pir_circle_point first = lookup->turn[k];
    k += y * first.cos - x * first.sin > (x * first.cos + y * first.sin) * lookup->half_step;
    const pir_circle_point at = lookup->turn[k];
    const double close = x * at.cos + y * at.sin, off = y * at.cos - x * at.sin;
    return (struct looked_rotation){close, close * lookup->step.cos + fabs(off) * lookup->step.sin, k, place};
}

bool pir_hopf_look_up(const pir_hopf_lookup *lookup, const pir_hopf *hopf, pir_quat unit, uint64_t *ret_number,
                      pir_quat *ret_nearest) {
    if (lookup->side == 0)
        return false;
    const struct looked_quat q = turned_of(lookup, unit);
    if (q.cell->count == 0)
        return false;
    struct looked_rotation found[PIR_LOOKED_MOST];
    uint32_t nearest = 0;
    for (uint32_t i = 0; i < q.cell->count; i++) {
        found[i] = nearest_on(lookup, q.cell->place[i], &q);
        nearest = found[i].close > found[nearest].close ? i : nearest;
    }
    const struct looked_rotation best = found[nearest];
    found[nearest].close = best.other;
    for (uint32_t i = 0; i < q.cell->count; i++)
        if (!(best.close > found[i].close + MARGIN))
            return false;
    // of the pixel of the same row of faces, so many quarters on
    const uint32_t face = best.place >> (2 * hopf->level), row = face & ~(uint32_t)3;
    const uint32_t place =
        best.place + ((row + ((face + q.quarters) & 3)) << (2 * hopf->level)) - (face << (2 * hopf->level));
    const pir_circle_point at = lookup->turn[best.k], lower = lookup->circle[place].lower;
    const double upper = lookup->circle[place].upper;
    *ret_number = pir_hopf_number(hopf, lookup->rank[place], best.k < hopf->around ? best.k : 0);
    *ret_nearest = (pir_quat){upper * at.sin, lower.cos * at.cos - lower.sin * at.sin,
                              lower.cos * at.sin + lower.sin * at.cos, upper * at.cos};
    return true;
}
