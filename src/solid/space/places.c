/* SPDX-License-Identifier: MIT */
/*
 * See places.h. Space is divided into cubes of side 2^-13, and an entry is in the slot of the cube of its middle.
 * Errors are 2^-20 at most, so what may be equal is in one of the cubes that a box of 2^-19 round the place reaches:
 * one as a rule. A plane's place is its foot, the nearest point to a point that few planes pass through; a line's
 * likewise.
 *
 * The foot of a line: what doubles make of it is off the two planes by no more than their errors and rounding, and so
 * off the line by that over the sine of their angle; where this is too much, it is made from exact numbers.
 */
#include "solid/space/places.h"

#include <math.h>

#include "solid/space/exact.h"
#include "solid/space/identity.h"

#define CUBE 0x1p-13

/* The point that feet are measured from. */
static const double middle[3] = {0.0137, -0.0291, 0.0219};

typedef bool places_equal(pir_places *table, const uint32_t a[2], const uint32_t b[2]);

void pir_places_init(pir_places *table, pir_space *space) {
    *table = (pir_places){.space = space};
}

void pir_places_finish(pir_places *table) {
    if (!table->space)
        return;
    pir_space_shrink(table->space, table->slot, table->slot_room, sizeof *table->slot);
    pir_space_shrink(table->space, table->entry, table->room, sizeof *table->entry);
    *table = (pir_places){0};
}

void pir_places_clear(pir_places *table) {
    for (uint32_t k = 0; k < table->slot_room; k++)
        table->slot[k] = PIR_SPACE_NONE;
    table->count = 0;
    table->by_numbers = false;
}

static uint32_t slot_of(const pir_places *table, const int64_t cube[3]) {
    uint64_t hash = (uint64_t)cube[0] * 0x9e3779b97f4a7c15u ^ (uint64_t)cube[1] * 0xc2b2ae3d27d4eb4fu ^
                    (uint64_t)cube[2] * 0x165667b19e3779f9u;
    hash = (hash ^ hash >> 31) * 0xbf58476d1ce4e5b9u;
    return (uint32_t)(hash >> 32) & (table->slot_room - 1);
}

static void cube_of(const double x[3], double beside, int64_t ret[3]) {
    for (int k = 0; k < 3; k++)
        ret[k] = (int64_t)floor((x[k] + beside) / CUBE);
}

static void link(pir_places *table, uint32_t e) {
    int64_t cube[3];
    cube_of(table->entry[e].x, 0, cube);
    uint32_t *slot = &table->slot[slot_of(table, cube)];
    table->entry[e].next = *slot;
    *slot = e;
}

/* Twice the slots, a power of two. */
static void widen(pir_places *table) {
    pir_space *space = table->space;
    const uint32_t room = table->slot_room ? 2 * table->slot_room : 64;
    uint32_t *slot = PIR_NEW(&space->allocator, uint32_t, room);
    if (!slot) {
        space->status = PIR_ERR_MEMORY;
        return;
    }
    for (uint32_t k = 0; k < room; k++)
        slot[k] = PIR_SPACE_NONE;
    pir_space_shrink(space, table->slot, table->slot_room, sizeof *table->slot);
    table->slot = slot;
    table->slot_room = room;
    for (uint32_t e = 0; e < table->count; e++)
        link(table, e);
}

static bool may_be_one(const pir_places_entry *a, const pir_places_entry *b) {
    for (int k = 0; k < 3; k++)
        if (fabs(a->x[k] - b->x[k]) > (a->err + b->err) * (1 + 0x1p-40))
            return false;
    return true;
}

/* The entry of the slot of a cube that is equal to one, or none. */
static uint32_t find_in(pir_places *table, const int64_t cube[3], const pir_places_entry *entry, places_equal *equal) {
    for (uint32_t e = table->slot[slot_of(table, cube)]; e != PIR_SPACE_NONE; e = table->entry[e].next)
        if (may_be_one(&table->entry[e], entry) && equal(table, table->entry[e].of, entry->of))
            return e;
    return PIR_SPACE_NONE;
}

/* The entry that is equal to one, which is added where there is none. */
static uint32_t add(pir_places *table, pir_places_entry entry, places_equal *equal) {
    pir_space *space = table->space;
    int64_t low[3], high[3], at[3];
    if (2 * (table->count + 1) > table->slot_room)
        widen(table);
    if (!pir_space_grow(space, (void **)&table->entry, &table->room, table->count, sizeof *table->entry))
        return 0;
    cube_of(entry.x, -2 * PIR_SPACE_ERROR, low);
    cube_of(entry.x, 2 * PIR_SPACE_ERROR, high);
    for (at[0] = low[0]; at[0] <= high[0]; at[0]++)
        for (at[1] = low[1]; at[1] <= high[1]; at[1]++)
            for (at[2] = low[2]; at[2] <= high[2]; at[2]++) {
                const uint32_t found = find_in(table, at, &entry, equal);
                if (found != PIR_SPACE_NONE)
                    return found;
            }
    table->entry[table->count] = entry;
    link(table, table->count);
    return table->count++;
}

/* --- points --- */

static bool equal_numbers(const pir_space *space, uint32_t a, uint32_t b, uint32_t count) {
    for (uint32_t k = 0; k < count; k++)
        if (mpz_cmp(space->number[a + k], space->number[b + k]) != 0)
            return false;
    return true;
}

static bool equal_points(pir_places *table, const uint32_t a[2], const uint32_t b[2]) {
    pir_space *space = table->space;
    if (a[0] == b[0] || pir_identity_of_points(space, a[0], b[0]))
        return true;
    const uint32_t i = pir_space_exact_point(space, a[0]), j = pir_space_exact_point(space, b[0]);
    return space->status == PIR_OK && equal_numbers(space, i, j, 4) && (table->by_numbers = true);
}

uint32_t pir_places_point(pir_places *table, uint32_t point) {
    const pir_space_point *p = &table->space->point[point];
    const uint32_t e =
        add(table, (pir_places_entry){.x = {p->x[0], p->x[1], p->x[2]}, .err = p->err, .of = {point, 0}}, equal_points);
    return table->space->status == PIR_OK ? table->entry[e].of[0] : 0;
}

/* --- planes --- */

/* The normals of equal planes are nearer to parallel than this. */
static bool are_parallel(const double *m, const double *n, double err) {
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        if (fabs(m[i] * n[j] - m[j] * n[i]) > err)
            return false;
    }
    return true;
}

bool pir_planes_are_one(pir_space *space, uint32_t f, uint32_t g) {
    if (f == g)
        return true;
    const double err = space->plane[f].err + space->plane[g].err + 0x1p-44;
    if (!are_parallel(space->plane[f].n, space->plane[g].n, err))
        return false;
    if (pir_identity_of_planes(space, f, g))
        return true;
    const uint32_t a = pir_space_exact_plane(space, f), b = pir_space_exact_plane(space, g);
    if (space->status != PIR_OK)
        return false;
    // the same numbers, or all with the other sign
    int turn = 0;
    for (uint32_t k = 0; k < 4; k++) {
        mpz_srcptr x = space->number[a + k], y = space->number[b + k];
        const int own = mpz_sgn(x) * mpz_sgn(y);
        if (mpz_cmpabs(x, y) != 0 || (turn != 0 && own != 0 && own != turn))
            return false;
        turn = own != 0 ? own : turn;
    }
    return true;
}

bool pir_planes_face_one_way(const pir_space *space, uint32_t f, uint32_t g) {
    const double *m = space->plane[f].n, *n = space->plane[g].n;
    return m[0] * n[0] + m[1] * n[1] + m[2] * n[2] > 0;
}

static bool equal_planes(pir_places *table, const uint32_t a[2], const uint32_t b[2]) {
    return pir_planes_are_one(table->space, a[0] >> 1, b[0] >> 1);
}

uint32_t pir_places_half(pir_places *table, uint32_t half) {
    pir_space *space = table->space;
    const pir_space_plane *f = &space->plane[half >> 1];
    // the normal is off by √3 of the plane's error, at a distance below 2, and the depth by it
    pir_places_entry entry = {.err = 8 * f->err + 0x1p-46, .of = {half, 0}};
    double depth = f->d;
    for (int k = 0; k < 3; k++)
        depth -= f->n[k] * middle[k];
    for (int k = 0; k < 3; k++)
        entry.x[k] = middle[k] + depth * f->n[k];
    if (entry.err > PIR_SPACE_ERROR) {
        pir_space_exact_plane(space, half >> 1);
        return space->status == PIR_OK ? pir_places_half(table, half) : 0;
    }
    const uint32_t e = add(table, entry, equal_planes);
    if (space->status != PIR_OK)
        return 0;
    const uint32_t known = table->entry[e].of[0];
    return pir_half(known >> 1, (half & 1) != !pir_planes_face_one_way(space, known >> 1, half >> 1));
}

/* --- lines --- */

/* n_f × n_g, and the foot of the line; what the foot may be off, or infinity where doubles do not tell. */
static double find_foot(const pir_space_plane *f, const pir_space_plane *g, double ret_along[3], double ret_foot[3]) {
    double depth[2] = {f->d, g->d}, square = 0;
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        ret_along[k] = f->n[i] * g->n[j] - f->n[j] * g->n[i];
        square += ret_along[k] * ret_along[k];
        depth[0] -= f->n[k] * middle[k];
        depth[1] -= g->n[k] * middle[k];
    }
    const double *u = ret_along;
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        const double of_f = g->n[i] * u[j] - g->n[j] * u[i], of_g = u[i] * f->n[j] - u[j] * f->n[i];
        ret_foot[k] = middle[k] + (depth[0] * of_f + depth[1] * of_g) / square;
    }
    const double wrong = 32 * (f->err + g->err + 0x1p-44), sine = sqrt(square) - wrong;
    return sine > 0 ? wrong / (sine * sine) : (double)INFINITY;
}

/* The line where two planes with exact numbers meet as six numbers, in lowest terms but for their sign. */
static void exact_line(pir_space *space, mpz_t *line, const uint32_t plane[2]) {
    mpz_t *p = space->number + space->plane[plane[0]].exact, *q = space->number + space->plane[plane[1]].exact;
    pir_numbers_cross(line, p, q);
    for (int k = 0; k < 3; k++) {
        mpz_mul(line[3 + k], p[3], q[k]);
        mpz_submul(line[3 + k], q[3], p[k]);
    }
    pir_numbers_reduce(line, 6, space->t[16]);
}

static bool equal_lines(pir_places *table, const uint32_t a[2], const uint32_t b[2]) {
    pir_space *space = table->space;
    if (pir_identity_of_lines(space, a, b))
        return true;
    for (int k = 0; k < 2; k++) {
        pir_space_exact_plane(space, a[k]);
        pir_space_exact_plane(space, b[k]);
    }
    if (space->status != PIR_OK)
        return false;
    exact_line(space, space->t, a);
    exact_line(space, space->t + 6, b);
    int turn = 0;
    for (int k = 0; k < 6; k++) {
        const int own = mpz_sgn(space->t[k]) * mpz_sgn(space->t[6 + k]);
        if (mpz_cmpabs(space->t[k], space->t[6 + k]) != 0 || (turn != 0 && own != 0 && own != turn))
            return false;
        turn = own != 0 ? own : turn;
    }
    return table->by_numbers = true;
}

/* The foot by exact numbers: middle + u × ((m + middle × u) / |u|²), m the moment of the line about the origin. */
static void exact_foot(pir_space *space, const uint32_t plane[2], double ret_foot[3]) {
    double u[3], m[3];
    mpz_t *t = space->t;
    pir_space_exact_plane(space, plane[0]);
    pir_space_exact_plane(space, plane[1]);
    if (space->status != PIR_OK)
        return;
    exact_line(space, t, plane);
    if (mpz_sgn(t[0]) == 0 && mpz_sgn(t[1]) == 0 && mpz_sgn(t[2]) == 0) {
        pir_space_fault(space);
        return;
    }
    long top = 0, e;
    bool any = false;
    for (int k = 0; k < 3; k++)
        if (mpz_get_d_2exp(&e, t[k]) != 0 && (!any || e > top)) {
            top = e;
            any = true;
        }
    for (int k = 0; k < 6; k++) {
        const double x = mpz_get_d_2exp(&e, t[k]);
        const long power = e - top - (k < 3 ? 0 : space->shift);
        *(k < 3 ? &u[k] : &m[k - 3]) = x == 0 || power < -300 ? 0 : ldexp(x, power < 300 ? (int)power : 300);
    }
    const double square = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        m[k] = -m[k] - (middle[i] * u[j] - middle[j] * u[i]);
    }
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        ret_foot[k] = middle[k] + (u[i] * m[j] - u[j] * m[i]) / square;
    }
}

uint32_t pir_places_line(pir_places *table, uint32_t f, uint32_t g) {
    pir_space *space = table->space;
    double along[3];
    pir_places_entry entry = {.of = {f, g}};
    entry.err = find_foot(&space->plane[f], &space->plane[g], along, entry.x);
    if (!(entry.err <= PIR_SPACE_ERROR)) {
        exact_foot(space, entry.of, entry.x);
        entry.err = 0x1p-40;
    }
    return space->status == PIR_OK ? add(table, entry, equal_lines) : 0;
}
