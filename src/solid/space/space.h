/* SPDX-License-Identifier: MIT */
/*
 * The points, directions and planes that one job on solids works with: held as doubles with a proven error, and
 * exactly where a sign needs it.
 *
 * Coordinates are integers on one scale. Doubles are those integers times 2^-shift, where the shift puts every point
 * of the job into |x|, |y|, |z| ≤ 1. Each point and plane knows how far its doubles may be from the truth:
 *
 *     |point.x − x| ≤ point.err,
 *     |(plane.n·x − plane.d) − (n·x − d)| ≤ plane.err  for |n| = 1 and x in that cube.
 *
 * No such error is ever above PIR_SPACE_ERROR: where doubles cannot prove that much, as where planes are nearly
 * parallel, the exact numbers are made at once and rounded. So doubles may be read without asking first; how far they
 * may be off is what a caller has to add, and signs that this leaves open are decided exactly.
 *
 * A point is given, or the sum of two points, or where three planes meet. A plane has a direction, or the cross
 * product of two, for a normal, and holds the sum of two points. What is given may turn with the body that it is of
 * (rest.h). So exact numbers never rest on constructed ones in a row: they are made from the definition when a filter
 * fails, in lowest terms, and kept: once for all points at one place, and for all planes that are one and face one
 * way. So where much is nearly coplanar, long numbers are few.
 *
 * Planes that meet in no point of the cube, and directions of no length, are a fault of the caller's. They leave
 * PIR_ERR_INTERNAL in `status`, as does whatever else on the way contradicts what came before (pir_space_fault).
 *
 * Memory that runs out, or past the limit, is remembered in `status`; calls then return number 0, and the job looks at
 * `status` before it gives a result. The job takes all its memory from `allocator`, which counts it. Exact numbers are
 * in GMP's own memory: they are counted once they are made, when the next are asked for.
 */
#ifndef PIR_SOLID_SPACE_SPACE_H
#define PIR_SOLID_SPACE_SPACE_H

#include <gmp.h>

#include <pirouette/base.h>

#include "base/memory.h"
#include "solid/space/intern.h"

#define PIR_SPACE_NONE UINT32_MAX

/* The most that the doubles of a point or a plane may be off. */
#define PIR_SPACE_ERROR 0x1p-20

typedef struct pir_space_direction {
    double n[3];       /* unit, within 2^-47 of the true one */
    uint32_t exact;    /* three numbers without a common factor, or none yet */
    uint32_t rest;     /* what it is at rest (rest.h), or none */
    uint32_t plane[2]; /* of a line: the planes that meet in it, or none */
} pir_space_direction;

enum pir_point_kind { PIR_POINT_GIVEN, PIR_POINT_SUM, PIR_POINT_MEET, PIR_POINT_TURNED };

typedef struct pir_space_point {
    double x[3], err;
    uint32_t exact; /* X, Y, Z, W > 0 in lowest terms, or none yet */
    uint32_t of[3]; /* two points, or three planes, or what it is at rest */
    enum pir_point_kind kind;
    uint32_t frame; /* at which its doubles were made */
} pir_space_point;

typedef struct pir_space_plane {
    double n[3], d, err;
    uint32_t exact;        /* a, b, c, d of a·x + b·y + c·z = d in lowest terms, or none yet */
    uint32_t direction[2]; /* the second may be none */
    uint32_t point[2];     /* likewise */
    double length;         /* of the product of its directions; 1 of one alone */
    bool turned;           /* the normal is the reverse of what the directions say */
    uint8_t body;          /* of the normal, for whoever made the plane; 0 of two directions */
    uint32_t frame;        /* as of a point */
} pir_space_plane;

typedef struct pir_space_rest pir_space_rest;
typedef struct pir_side_record pir_side_record;

/* Numbers that are no longer in use. */
typedef struct pir_space_spare {
    uint32_t *number, count, room;
} pir_space_spare;

typedef struct pir_space {
    pir_space_rest *rest;    /* of what turns, or NULL */
    pir_side_record *record; /* of the job at hand, or NULL (record.h) */
    uint32_t axis[3];        /* directions of the axes */
    bool reuses;             /* whether numbers that are spare are taken first */
    uint32_t frame;          /* what is of another one has the doubles of an earlier rotation */
    pir_space_spare spare_points, spare_planes;
    pir_allocator allocator; /* gives what the limit allows, from the caller's */
    pir_allocator given;
    pir_status status;
    size_t bytes, limit; /* of all that the job holds, GMP's numbers counted in */
    bool refused;        /* the limit did not allow something */
    uint32_t weighed;    /* numbers that are counted in */
    size_t weight;       /* the bytes that these take */
    int shift;
    pir_space_direction *direction;
    pir_space_point *point;
    pir_space_plane *plane;
    mpz_t *number; /* those past the count keep their memory for the next ones */
    uint32_t direction_count, point_count, plane_count, number_count, number_made;
    uint32_t number_lately; /* the most that were in use before they were forgotten, less with each time */
    uint32_t direction_room, point_room, plane_room, number_room;
    mpz_t t[20];                         /* scratch of the exact calls */
    pir_intern known_point, known_plane; /* exact numbers: equal ones are there once */
    struct pir_known_side {
        uint32_t plane, point; /* the first of the exact numbers of each; no plane's is 0 */
        int32_t sign;
    } * side; /* what exact numbers told last, at a place that both make */
    uint32_t side_room, side_count;
    struct {
        const char *what; /* "clipping candidates" */
        uint64_t done, all;
    } stage; /* of the job, for reports */
} pir_space;

/* `bits` of the longest coordinate of the job, sums included; at most `limit` bytes of memory. The space stays where it
 * is. */
void pir_space_init(pir_space *space, const pir_allocator *allocator, size_t limit, size_t bits);
void pir_space_finish(pir_space *space);

/* The status that a job ends with: memory that the limit did not allow had not run out. Fills `report`, unless it is
 * NULL or says it already, where a limit was met, memory ran out or a check failed: which limit, its value, and how
 * far the job of this name was. */
pir_status pir_space_outcome(const pir_space *space, pir_status status, const char *name, pir_report *report);

/* Begins a stage of the job, of `all` steps: `space->stage.done` counts them. */
void pir_space_begin_stage(pir_space *space, const char *what, uint64_t all);

/* Notes that something contradicts what is known, so that the job ends without a result. */
void pir_space_fault(pir_space *space);

/* Grows *array, of *room elements, to hold one more than `count`, within the limit. False once `status` is a failure.
 * */
bool pir_space_widen(pir_space *space, void **array, uint32_t *room, size_t count, size_t size);
static inline bool pir_space_grow(pir_space *space, void **array, uint32_t *room, size_t count, size_t size) {
    return (count < *room && space->status == PIR_OK) || pir_space_widen(space, array, room, count, size);
}

/* Frees an array that has grown. */
void pir_space_shrink(pir_space *space, void *array, uint32_t room, size_t size);

/* `count` new numbers, all 0; the number of the first. */
uint32_t pir_space_numbers(pir_space *space, uint32_t count);

/* Takes back the numbers from `first` on, which nothing refers to. */
void pir_space_drop_numbers(pir_space *space, uint32_t first);

/* Forgets all exact numbers, and which of them are known. What had them is to be made anew. */
void pir_space_drop_exact(pir_space *space);

/* The direction (x, y, z), which is not zero. */
uint32_t pir_space_add_direction(pir_space *space, mpz_srcptr x, mpz_srcptr y, mpz_srcptr z);

/* The direction of the line where two planes meet. Its doubles may be farther off than those of others: they are for
 * the order of points on that line. */
uint32_t pir_space_add_line_direction(pir_space *space, uint32_t f, uint32_t g);

/* The point (x, y, z)/w, w > 0. */
uint32_t pir_space_add_point(pir_space *space, mpz_srcptr x, mpz_srcptr y, mpz_srcptr z, mpz_srcptr w);

uint32_t pir_space_add_sum(pir_space *space, uint32_t a, uint32_t b);

/* Where three planes meet in one point. */
uint32_t pir_space_add_meet(pir_space *space, uint32_t f, uint32_t g, uint32_t h);

/* The plane with normal ±a, or ±(a × b) unless b is none, through point p, or p + q unless q is none. */
uint32_t pir_space_add_plane(pir_space *space, const uint32_t direction[2], bool turned, const uint32_t point[2]);

/* Makes the doubles of a point or a plane of an earlier frame anew, and of what it is made of. */
void pir_space_renew_point(pir_space *space, uint32_t point);
void pir_space_place_plane(pir_space *space, uint32_t plane);
static inline void pir_space_renew_plane(pir_space *space, uint32_t plane) {
    if (space->plane[plane].frame != space->frame)
        pir_space_place_plane(space, plane);
}

/* Likewise by doubles alone, of what need not be there at this rotation: planes that have come to be parallel, or meet
 * far away. False where doubles do not do, or it is not there. */
bool pir_space_look_at_point(pir_space *space, uint32_t point);
bool pir_space_look_at_plane(pir_space *space, uint32_t plane);

/* Whether the doubles of a point or a plane are, or can be made, those of this rotation; likewise. */
static inline bool pir_space_sees_point(pir_space *space, uint32_t point) {
    return space->point[point].frame == space->frame || pir_space_look_at_point(space, point);
}
static inline bool pir_space_sees_plane(pir_space *space, uint32_t plane) {
    return space->plane[plane].frame == space->frame || pir_space_look_at_plane(space, plane);
}

/* Forgets the exact numbers of all that is in the space, and begins a frame. */
void pir_space_begin_frame(pir_space *space);

/* A half-space: a plane's, and whether it is turned. Its points have side ≤ 0. */
static inline uint32_t pir_half(uint32_t plane, bool turned) {
    return plane << 1 | turned;
}

/* The side of a plane on which a point lies, by exact numbers. */
int pir_space_exact_side(pir_space *space, uint32_t plane, uint32_t point);

/* Notes a side in the record of the job at hand. */
void pir_space_note_side(pir_space *space, uint32_t plane, uint32_t point, int sign);

/* The side of a half-space on which a point lies: 1 above, −1 below, 0 in its plane. */
static inline int pir_space_side(pir_space *space, uint32_t half, uint32_t point) {
    const pir_space_plane *f = &space->plane[half >> 1];
    const pir_space_point *p = &space->point[point];
    const double s = f->n[0] * p->x[0] + f->n[1] * p->x[1] + f->n[2] * p->x[2] - f->d;
    const double bound = f->err + p->err + 0x1p-48;
    const int sign = s > bound ? 1 : s < -bound ? -1 : pir_space_exact_side(space, half >> 1, point);
    if (space->record)
        pir_space_note_side(space, half >> 1, point, sign);
    return half & 1 ? -sign : sign;
}

/* The sign of det(a, b, c) and of a · b for directions. */
int pir_space_det(pir_space *space, uint32_t a, uint32_t b, uint32_t c);
int pir_space_dot(pir_space *space, uint32_t a, uint32_t b);

/* The sign of the turn from a over b to c, seen from above the half-space in whose plane all three are. */
int pir_space_turn(pir_space *space, uint32_t half, uint32_t a, uint32_t b, uint32_t c);

/* The sign of det(b − a, c − a, d − a). */
int pir_space_orient(pir_space *space, uint32_t a, uint32_t b, uint32_t c, uint32_t d);

/* The sign of direction · (b − a). */
int pir_space_order(pir_space *space, uint32_t direction, uint32_t a, uint32_t b);

#endif
