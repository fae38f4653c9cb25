/* SPDX-License-Identifier: MIT */
/* See space.h: the store of a job's points, directions and planes. Number 0 of each is there from the start. */
#include "solid/space/space.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/report.h"
#include "solid/space/exact.h"
#include "solid/space/record.h"

#define SCRATCH (sizeof((pir_space *)0)->t / sizeof(mpz_t))

/* Asks the caller's allocator where the limit allows it. */
static void *limited_resize(void *context, void *block, size_t old_size, size_t new_size) {
    pir_space *space = context;
    if (new_size > old_size && new_size - old_size > space->limit - space->bytes) {
        space->refused = true;
        return NULL;
    }
    void *made = space->given.resize(space->given.context, block, old_size, new_size);
    if (made || new_size == 0)
        space->bytes = space->bytes - old_size + new_size;
    return made;
}

static pir_status status_of(const pir_space *space, pir_status status) {
    return status == PIR_ERR_MEMORY && space->refused ? PIR_ERR_LIMIT : status;
}

/* "clipping candidates, 7 of 12 done": where a job is. */
static const char *place_of(const pir_space *space, char ret_text[80]) {
    const char *what = space->stage.what ? space->stage.what : "beginning";
    if (space->stage.all > 0)
        snprintf(ret_text, 80, "%s, %llu of %llu done", what, (unsigned long long)space->stage.done,
                 (unsigned long long)space->stage.all);
    else if (space->stage.done > 0)
        snprintf(ret_text, 80, "%s, %llu steps done", what, (unsigned long long)space->stage.done);
    else
        snprintf(ret_text, 80, "%s", what);
    return ret_text;
}

pir_status pir_space_outcome(const pir_space *space, pir_status status, const char *name, pir_report *report) {
    char place[80];
    status = status_of(space, status);
    place_of(space, place);
    if (status == PIR_ERR_LIMIT && space->refused)
        return pir_fail(report, status, "%s: %s: more memory is needed than the limit of %zu bytes; %zu are held", name,
                        place, space->limit, space->bytes);
    if (status == PIR_ERR_LIMIT)
        return pir_fail(report, status, "%s: %s: too large: more than %u of one kind", name, place, UINT32_MAX / 2);
    if (status == PIR_ERR_INTERNAL || status == PIR_ERR_MEMORY)
        return pir_fail(report, status, "%s: %s: %s", name, place, pir_status_text(status));
    return status;
}

void pir_space_begin_stage(pir_space *space, const char *what, uint64_t all) {
    space->stage.what = what;
    space->stage.done = 0;
    space->stage.all = all;
}

void pir_space_init(pir_space *space, const pir_allocator *allocator, size_t limit, size_t bits) {
    *space =
        (pir_space){.allocator = {limited_resize, space}, .given = *allocator, .limit = limit, .shift = (int)bits + 1};
    for (size_t k = 0; k < SCRATCH; k++)
        mpz_init(space->t[k]);
    pir_intern_init(&space->known_point, space, 4);
    pir_intern_init(&space->known_plane, space, 4);
    pir_space_numbers(space, 4);
    mpz_t one;
    mpz_init_set_ui(one, 1);
    pir_space_add_direction(space, one, one, one);
    pir_space_add_point(space, one, one, one, one);
    pir_space_add_plane(space, (const uint32_t[]){0, PIR_SPACE_NONE}, false, (const uint32_t[]){0, PIR_SPACE_NONE});
    for (int k = 0; k < 3; k++) {
        mpz_set_ui(space->t[0], k == 0);
        mpz_set_ui(space->t[1], k == 1);
        mpz_set_ui(space->t[2], k == 2);
        space->axis[k] = pir_space_add_direction(space, space->t[0], space->t[1], space->t[2]);
    }
    mpz_clear(one);
}

void pir_space_finish(pir_space *space) {
    for (size_t k = 0; k < SCRATCH; k++)
        mpz_clear(space->t[k]);
    for (uint32_t k = 0; k < space->number_made; k++)
        mpz_clear(space->number[k]);
    pir_intern_finish(&space->known_point);
    pir_intern_finish(&space->known_plane);
    pir_space_shrink(space, space->spare_points.number, space->spare_points.room, sizeof(uint32_t));
    pir_space_shrink(space, space->spare_planes.number, space->spare_planes.room, sizeof(uint32_t));
    pir_space_shrink(space, space->side, space->side_room, sizeof *space->side);
    pir_space_shrink(space, space->number, space->number_room, sizeof *space->number);
    pir_space_shrink(space, space->direction, space->direction_room, sizeof *space->direction);
    pir_space_shrink(space, space->point, space->point_room, sizeof *space->point);
    pir_space_shrink(space, space->plane, space->plane_room, sizeof *space->plane);
    *space = (pir_space){0};
}

void pir_space_fault(pir_space *space) {
    if (space->status == PIR_OK)
        space->status = PIR_ERR_INTERNAL;
}

bool pir_space_widen(pir_space *space, void **array, uint32_t *room, size_t count, size_t size) {
    if (space->status != PIR_OK)
        return false;
    const size_t larger = 2 * count + 16;
    if (larger >= UINT32_MAX / 2) {
        space->status = PIR_ERR_LIMIT;
        return false;
    }
    void *grown = pir_memory_resize(&space->allocator, *array, *room, larger, size);
    if (!grown) {
        space->status = status_of(space, PIR_ERR_MEMORY);
        return false;
    }
    *array = grown;
    *room = (uint32_t)larger;
    return true;
}

void pir_space_shrink(pir_space *space, void *array, uint32_t room, size_t size) {
    pir_memory_free(&space->allocator, array, room, size);
}

/* The bytes that numbers take which are not weighed yet. */
static size_t weigh_up_to(pir_space *space, uint32_t count) {
    size_t bytes = 0;
    for (; space->weighed < count; space->weighed++)
        bytes += (size_t)space->number[space->weighed]->_mp_alloc * sizeof(mp_limb_t);
    return bytes;
}

/* Counts the numbers that are made by now. */
static void weigh_numbers(pir_space *space) {
    const size_t bytes = weigh_up_to(space, space->number_count);
    if (bytes > space->limit - space->bytes) {
        space->refused = true;
        space->status = PIR_ERR_LIMIT;
        return;
    }
    space->bytes += bytes;
    space->weight += bytes;
}

uint32_t pir_space_numbers(pir_space *space, uint32_t count) {
    weigh_numbers(space);
    if (!pir_space_grow(space, (void **)&space->number, &space->number_room, space->number_count + count,
                        sizeof *space->number))
        return 0;
    const uint32_t first = space->number_count;
    for (uint32_t k = 0; k < count; k++, space->number_count++)
        if (space->number_count < space->number_made)
            mpz_set_ui(space->number[space->number_count], 0);
        else
            mpz_init(space->number[space->number_made++]);
    return first;
}

void pir_space_drop_numbers(pir_space *space, uint32_t first) {
    space->number_count = space->number_count < first ? space->number_count : first;
}

/* Frees the memory of numbers, which nothing refers to any longer, where it is more than such jobs had need of. */
static void free_numbers(pir_space *space) {
    const uint32_t lately = space->number_lately - space->number_lately / 1024;
    space->number_lately = space->number_count > lately ? space->number_count : lately;
    const bool many = space->number_made / 4 > space->number_lately || space->weight > space->limit / 8;
    while (many && space->number_made > 0)
        mpz_clear(space->number[--space->number_made]);
    space->number_count = 0;
    // what stays may have grown since it was weighed
    space->bytes -= space->weight;
    space->weighed = 0;
    space->weight = weigh_up_to(space, space->number_made);
    space->bytes += space->weight;
}

void pir_space_drop_exact(pir_space *space) {
    free_numbers(space);
    pir_intern_clear(&space->known_point);
    pir_intern_clear(&space->known_plane);
    if (space->side_count > 0)
        memset(space->side, 0, space->side_room * sizeof *space->side);
    space->side_count = 0;
    pir_space_numbers(space, 4);
}

uint32_t pir_space_add_direction(pir_space *space, mpz_srcptr x, mpz_srcptr y, mpz_srcptr z) {
    const uint32_t exact = pir_space_numbers(space, 3), made = space->direction_count;
    if (!pir_space_grow(space, (void **)&space->direction, &space->direction_room, made, sizeof *space->direction))
        return 0;
    mpz_t *n = space->number + exact;
    mpz_set(n[0], x);
    mpz_set(n[1], y);
    mpz_set(n[2], z);
    space->direction[made].rest = space->direction[made].plane[0] = PIR_SPACE_NONE;
    if (mpz_sgn(x) == 0 && mpz_sgn(y) == 0 && mpz_sgn(z) == 0) {
        pir_space_fault(space);
        return 0;
    }
    pir_numbers_reduce(n, 3, space->t[16]);
    space->direction[made].exact = exact;
    pir_space_round_direction(space->direction[made].n, n);
    return space->direction_count++;
}

uint32_t pir_space_add_line_direction(pir_space *space, uint32_t f, uint32_t g) {
    const uint32_t made = space->direction_count;
    if (!pir_space_grow(space, (void **)&space->direction, &space->direction_room, made, sizeof *space->direction))
        return 0;
    pir_space_direction *d = &space->direction[made];
    const double *a = space->plane[f].n, *b = space->plane[g].n;
    double square = 0;
    *d = (pir_space_direction){.exact = PIR_SPACE_NONE, .rest = PIR_SPACE_NONE, .plane = {f, g}};
    for (int k = 0; k < 3; k++) {
        d->n[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
        square += d->n[k] * d->n[k];
    }
    space->direction_count++;
    // within 60 degrees of the line it tells which way that leads
    const double length = sqrt(square);
    if (length > 8 * (space->plane[f].err + space->plane[g].err) + 0x1p-40)
        for (int k = 0; k < 3; k++)
            d->n[k] /= length;
    else if (pir_space_exact_direction(space, made) != 0 && space->status == PIR_OK)
        pir_space_round_direction(space->direction[made].n, space->number + space->direction[made].exact);
    return made;
}

static uint32_t take_point(pir_space *space) {
    if (space->reuses && space->spare_points.count > 0)
        return space->spare_points.number[--space->spare_points.count];
    if (!pir_space_grow(space, (void **)&space->point, &space->point_room, space->point_count, sizeof *space->point))
        return 0;
    return space->point_count++;
}

/* A new point without coordinates. */
static uint32_t new_point(pir_space *space, enum pir_point_kind kind) {
    const uint32_t made = take_point(space);
    if (space->status != PIR_OK)
        return 0;
    space->point[made] = (pir_space_point){.exact = PIR_SPACE_NONE, .kind = kind, .frame = space->frame};
    if (space->record)
        pir_record_point(space, made);
    return made;
}

uint32_t pir_space_add_point(pir_space *space, mpz_srcptr x, mpz_srcptr y, mpz_srcptr z, mpz_srcptr w) {
    const uint32_t exact = pir_space_numbers(space, 4), made = new_point(space, PIR_POINT_GIVEN);
    if (space->status != PIR_OK)
        return 0;
    mpz_t *n = space->number + exact;
    mpz_set(n[0], x);
    mpz_set(n[1], y);
    mpz_set(n[2], z);
    mpz_set(n[3], w);
    pir_numbers_reduce(n, 4, space->t[16]);
    space->point[made].exact = exact;
    pir_space_round_point(space, made);
    return made;
}

static void set_sum(const pir_space *space, pir_space_point *sum) {
    const pir_space_point *p = &space->point[sum->of[0]], *q = &space->point[sum->of[1]];
    for (int k = 0; k < 3; k++)
        sum->x[k] = p->x[k] + q->x[k];
    sum->err = p->err + q->err + 0x1p-51;
}

uint32_t pir_space_add_sum(pir_space *space, uint32_t a, uint32_t b) {
    const uint32_t made = new_point(space, PIR_POINT_SUM);
    if (space->status != PIR_OK)
        return 0;
    space->point[made].of[0] = a;
    space->point[made].of[1] = b;
    set_sum(space, &space->point[made]);
    return made;
}

/* How far a solution may be from where the true planes meet: each plane's residual, with what it may be wrong by, over
 * the least determinant that the true normals may have. The cross product of two unit normals is no longer than 1. */
static double meet_error(const pir_space_plane *const plane[3], const double x[3], double det) {
    double all = 0, wrong = 0x1p-48;
    for (int k = 0; k < 3; k++) {
        const double *n = plane[k]->n;
        all += fabs(n[0] * x[0] + n[1] * x[1] + n[2] * x[2] - plane[k]->d) + plane[k]->err + 0x1p-48;
        wrong += 2 * plane[k]->err;
    }
    const double least = fabs(det) * (1 - 0x1p-40) - wrong;
    return least > 0 ? all * (1 + 0x1p-40) / least : (double)INFINITY;
}

/* Where three planes meet, by doubles, and how far off that may be: infinite where it is not in the cube. */
static double solve_meet(const pir_space_plane *const plane[3], double x[3]) {
    double sum[3] = {0}, det = 0;
    for (int i = 0; i < 3; i++) {
        const double *a = plane[(i + 1) % 3]->n, *b = plane[(i + 2) % 3]->n, d = plane[i]->d;
        const double cross[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
        for (int k = 0; k < 3; k++)
            sum[k] += d * cross[k];
        if (i == 0)
            det = plane[0]->n[0] * cross[0] + plane[0]->n[1] * cross[1] + plane[0]->n[2] * cross[2];
    }
    for (int k = 0; k < 3; k++) {
        x[k] = sum[k] / det;
        if (!(fabs(x[k]) <= 1))
            return (double)INFINITY;
    }
    return meet_error(plane, x, det);
}

static void set_meet(pir_space *space, uint32_t point) {
    pir_space_point *p = &space->point[point];
    const pir_space_plane *const plane[3] = {&space->plane[p->of[0]], &space->plane[p->of[1]], &space->plane[p->of[2]]};
    p->err = solve_meet(plane, p->x);
    if (!(p->err <= PIR_SPACE_ERROR))
        pir_space_exact_point(space, point);
}

uint32_t pir_space_add_meet(pir_space *space, uint32_t f, uint32_t g, uint32_t h) {
    const uint32_t made = new_point(space, PIR_POINT_MEET), of[3] = {f, g, h};
    if (space->status != PIR_OK)
        return 0;
    for (int k = 0; k < 3; k++)
        space->point[made].of[k] = of[k];
    set_meet(space, made);
    return made;
}

/* The unit normal of a plane, and how far it may be from the true one: two directions, each within 2^-47, bring
 * 2^-46 and the rounding of their product, over its length. Infinite where that has none. */
static double set_normal(const pir_space *space, pir_space_plane *p) {
    const double *a = space->direction[p->direction[0]].n, sign = p->turned ? -1 : 1;
    if (p->direction[1] == PIR_SPACE_NONE) {
        for (int k = 0; k < 3; k++)
            p->n[k] = sign * a[k];
        p->length = 1;
        return 0x1p-47;
    }
    const double *b = space->direction[p->direction[1]].n;
    const double cross[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    const double length = sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]);
    for (int k = 0; k < 3; k++)
        p->n[k] = sign * cross[k] / length;
    p->length = length;
    return length > 0 ? 0x1p-45 / length : (double)INFINITY;
}

/* The doubles of a plane, whose directions and points are there; whether they do. */
static bool set_plane(pir_space *space, uint32_t plane) {
    pir_space_plane *p = &space->plane[plane];
    const double off = set_normal(space, p);
    const pir_space_point *a = &space->point[p->point[0]];
    const pir_space_point *b = p->point[1] == PIR_SPACE_NONE ? NULL : &space->point[p->point[1]];
    double x[3];
    for (int k = 0; k < 3; k++)
        x[k] = a->x[k] + (b ? b->x[k] : 0);
    p->d = p->n[0] * x[0] + p->n[1] * x[1] + p->n[2] * x[2];
    // the normal is wrong at x and at the point itself, each within √3 of the middle
    p->err = 4 * off + a->err + (b ? b->err : 0) + 0x1p-48;
    p->frame = space->frame;
    return p->err <= PIR_SPACE_ERROR;
}

static uint32_t take_plane(pir_space *space) {
    if (space->reuses && space->spare_planes.count > 0)
        return space->spare_planes.number[--space->spare_planes.count];
    if (!pir_space_grow(space, (void **)&space->plane, &space->plane_room, space->plane_count, sizeof *space->plane))
        return 0;
    return space->plane_count++;
}

uint32_t pir_space_add_plane(pir_space *space, const uint32_t direction[2], bool turned, const uint32_t point[2]) {
    const uint32_t made = take_plane(space);
    if (space->status != PIR_OK)
        return 0;
    space->plane[made] = (pir_space_plane){.exact = PIR_SPACE_NONE,
                                           .direction = {direction[0], direction[1]},
                                           .point = {point[0], point[1]},
                                           .turned = turned};
    if (!set_plane(space, made))
        pir_space_exact_plane(space, made);
    if (space->record)
        pir_record_plane(space, made);
    return made;
}

void pir_space_renew_point(pir_space *space, uint32_t point) {
    pir_space_point *p = &space->point[point];
    if (p->frame == space->frame || (p->kind != PIR_POINT_SUM && p->kind != PIR_POINT_MEET))
        return;
    p->frame = space->frame;
    if (p->kind == PIR_POINT_SUM) {
        set_sum(space, p);
        return;
    }
    for (int k = 0; k < 3; k++)
        pir_space_renew_plane(space, p->of[k]);
    set_meet(space, point);
}

/* Makes the doubles of the points that a plane is made of, which are sums of vertices. */
static void renew_points_of(pir_space *space, const pir_space_plane *f) {
    for (int k = 0; k < 2; k++)
        if (f->point[k] != PIR_SPACE_NONE)
            pir_space_renew_point(space, f->point[k]);
}

void pir_space_place_plane(pir_space *space, uint32_t plane) {
    renew_points_of(space, &space->plane[plane]);
    if (!set_plane(space, plane))
        pir_space_exact_plane(space, plane);
}

bool pir_space_look_at_plane(pir_space *space, uint32_t plane) {
    pir_space_plane *f = &space->plane[plane];
    if (f->frame == space->frame)
        return true;
    renew_points_of(space, f);
    const bool done = set_plane(space, plane);
    f->frame = done ? space->frame : 0;
    return done;
}

bool pir_space_look_at_point(pir_space *space, uint32_t point) {
    pir_space_point *p = &space->point[point];
    if (p->frame == space->frame || p->kind != PIR_POINT_MEET) {
        pir_space_renew_point(space, point);
        return true;
    }
    for (int k = 0; k < 3; k++)
        if (!pir_space_look_at_plane(space, p->of[k]))
            return false;
    const pir_space_plane *const plane[3] = {&space->plane[p->of[0]], &space->plane[p->of[1]], &space->plane[p->of[2]]};
    p->err = solve_meet(plane, p->x);
    p->frame = p->err <= PIR_SPACE_ERROR ? space->frame : 0;
    return p->frame == space->frame;
}

void pir_space_note_side(pir_space *space, uint32_t plane, uint32_t point, int sign) {
    pir_record_side(space, plane, point, sign);
}

void pir_space_begin_frame(pir_space *space) {
    pir_space_drop_exact(space);
    space->frame++;
    for (uint32_t p = 0; p < space->point_count; p++)
        space->point[p].exact = PIR_SPACE_NONE;
    for (uint32_t f = 0; f < space->plane_count; f++)
        space->plane[f].exact = PIR_SPACE_NONE;
}
