/* SPDX-License-Identifier: MIT */
/* See band.h. */
#include "plan/band/band.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "plan/band/band_push.h"
#include "plan/band/band_tree.h"

/* The first spacing, in parts of the robot's radius; how much finer each next one is; how many there are. */
#define FIRST_SPACING (1 / 6.0)
#define FINER         5
#define SPACINGS      5

/* How often a row is pushed at a spacing, and in vain before it is given up, at the first spacing and at others. */
#define PUSHES        200
#define FIRST_IN_VAIN 10
#define IN_VAIN       24

/* A way that was pushed at the first spacing, with the least room of its poses. */
struct pushed_way {
    pir_band_pose *pose;
    uint32_t count;
    double least;
    pir_pose end[2];
    bool is_taken;
};

struct pir_band {
    pir_band_bodies bodies;
    pir_band_row row;
    pir_band_trees trees;
    struct pushed_way *way;
    uint32_t ways, room;
};

pir_status pir_band_create(const pir_band_question *question, pir_band **ret_band) {
    pir_band *band = calloc(1, sizeof *band);
    if (!band)
        return PIR_ERR_MEMORY;
    const pir_status status = pir_band_bodies_open(question, &band->bodies);
    if (status == PIR_OK)
        *ret_band = band;
    else
        pir_band_destroy(band);
    return status;
}

void pir_band_destroy(pir_band *band) {
    if (!band)
        return;
    pir_band_bodies_finish(&band->bodies);
    for (uint32_t i = 0; i < band->ways; i++)
        free(band->way[i].pose);
    free(band->way);
    pir_band_row_finish(&band->row);
    pir_band_trees_finish(&band->trees);
    free(band);
}

static pir_band_pose unit_pose(const pir_pose *pose) {
    const pir_quat q = pose->rotation;
    const pir_vec3 t = pose->translation;
    const double size = sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return (pir_band_pose){{q.x / size, q.y / size, q.z / size, q.w / size}, {t.x, t.y, t.z}, -INFINITY};
}

/* The work that is left; none once it is used up. */
static uint64_t work_left(const pir_band *band, uint64_t begin, uint64_t work) {
    const uint64_t asked = band->bodies.work - begin;
    return asked < work ? work - asked : 0;
}

/*
 * Pushes at one spacing until the motions between poses are free, as far as rooms tell. Else the row is then that of
 * which the deepest pose was least deep, or had most room, which is how much is told.
 */
static pir_status push(pir_band *band, double spacing, int in_vain, uint64_t work, double *ret_least) {
    const uint64_t begin = band->bodies.work;
    pir_band_row *row = &band->row;
    double noted = -INFINITY, least;
    *ret_least = -INFINITY;
    for (int i = 0, since = 0; i < PUSHES && since < in_vain; i++, since++) {
        pir_status status = pir_band_space(&band->bodies, spacing, row);
        if (status == PIR_OK)
            status = pir_band_push_row(&band->bodies, spacing / 2, 2 * spacing, row, &least);
        if (status != PIR_OK || work_left(band, begin, work) == 0)
            return status;
        const double gap = pir_band_gap(&band->bodies, row);
        if (gap == 0) {
            *ret_least = least;
            return PIR_OK;
        }
        // a row of few poses tells little
        if (gap > 2 * spacing)
            continue;
        if (least > *ret_least)
            pir_band_row_note(row);
        *ret_least = fmax(*ret_least, least);
        if (*ret_least > noted + spacing / 64) {
            noted = *ret_least;
            since = 0;
        }
    }
    if (*ret_least > -INFINITY)
        pir_band_row_restore(row);
    return PIR_OK;
}

/* Keeps the row as a way. */
static pir_status keep(pir_band *band, const pir_pose *way, uint32_t count, double least) {
    if (band->ways == band->room) {
        const uint32_t room = 2 * band->room + 8;
        struct pushed_way *grown = realloc(band->way, room * sizeof *grown);
        if (!grown)
            return PIR_ERR_MEMORY;
        band->way = grown;
        band->room = room;
    }
    struct pushed_way *own = &band->way[band->ways];
    *own = (struct pushed_way){
        calloc(band->row.count, sizeof *own->pose), band->row.count, least, {way[0], way[count - 1]}, false};
    if (!own->pose)
        return PIR_ERR_MEMORY;
    memcpy(own->pose, band->row.pose, own->count * sizeof *own->pose);
    band->ways++;
    return PIR_OK;
}

pir_status pir_band_add(pir_band *band, const pir_pose *way, uint32_t count, uint64_t *work, double *ret_room) {
    const double spacing = band->bodies.radius * FIRST_SPACING;
    const uint64_t begin = band->bodies.work;
    double least;
    if (!pir_band_row_reserve(&band->row, count))
        return PIR_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++)
        band->row.pose[i] = unit_pose(&way[i]);
    band->row.count = count;
    pir_status status = push(band, spacing, FIRST_IN_VAIN, *work, &least);
    if (status == PIR_OK)
        status = keep(band, way, count, least);
    *work = work_left(band, begin, *work);
    *ret_room = least / spacing;
    return status;
}

/* Joins poses of the band by motions that are proven, each as long as doublings find; false where one is not. */
static pir_status prove(pir_band *band, const pir_pose end[2], pir_pose *step, uint32_t *ret_steps, bool *ret_free) {
    const pir_band_row *row = &band->row;
    pir_status status = PIR_OK;
    uint32_t at = 0, steps = 0;
    for (uint32_t i = 0; i < row->count; i++) {
        const double *q = row->pose[i].q, *t = row->pose[i].t;
        step[i] = (pir_pose){{q[0], q[1], q[2], q[3]}, {t[0], t[1], t[2]}};
    }
    step[0] = end[0];
    step[row->count - 1] = end[1];
    *ret_free = true;
    while (at + 1 < row->count && status == PIR_OK && *ret_free) {
        uint32_t next = at;
        bool is_free = true;
        for (uint32_t far = 1; is_free && status == PIR_OK && next + 1 < row->count; far *= 2) {
            const uint32_t to = at + far < row->count ? at + far : row->count - 1;
            status = pir_band_prove(&band->bodies, &step[at], &step[to], &is_free);
            next = is_free ? to : next;
        }
        *ret_free = next > at;
        at = next;
        step[++steps] = step[at];
    }
    *ret_steps = steps + 1;
    return status;
}

/* Pushes the row at finer spacings until its motions are proven. */
static pir_status refine(pir_band *band, const struct pushed_way *way, uint64_t work, pir_pose **ret_step,
                         uint32_t *ret_steps) {
    const uint64_t begin = band->bodies.work;
    double spacing = band->bodies.radius * FIRST_SPACING, least = way->least;
    pir_status status = PIR_OK;
    for (int i = 0; i < SPACINGS && status == PIR_OK && !*ret_step; i++, spacing /= FINER) {
        if (i > 0)
            status = push(band, spacing, IN_VAIN, work_left(band, begin, work), &least);
        // what is nearly free may come free in smaller steps
        if (status != PIR_OK || least <= -spacing / 2 || work_left(band, begin, work) == 0)
            break;
        if (least <= 0)
            continue;
        bool is_free = false;
        pir_pose *step = calloc(band->row.count, sizeof *step);
        status = step ? prove(band, way->end, step, ret_steps, &is_free) : PIR_ERR_MEMORY;
        if (status == PIR_OK && is_free)
            *ret_step = step;
        else
            free(step);
    }
    return status;
}

pir_status pir_band_try(pir_band *band, uint64_t *work, pir_pose **ret_step, uint32_t *ret_steps) {
    const uint64_t begin = band->bodies.work;
    struct pushed_way *best = NULL;
    *ret_step = NULL;
    *ret_steps = 0;
    for (uint32_t i = 0; i < band->ways; i++)
        if (!band->way[i].is_taken && (!best || band->way[i].least > best->least))
            best = &band->way[i];
    if (!best || *work == 0)
        return PIR_ERR_EMPTY;
    best->is_taken = true;
    if (!pir_band_row_reserve(&band->row, best->count))
        return PIR_ERR_MEMORY;
    memcpy(band->row.pose, best->pose, best->count * sizeof *best->pose);
    band->row.count = best->count;
    const pir_status status = refine(band, best, *work, ret_step, ret_steps);
    *work = work_left(band, begin, *work);
    return status;
}

pir_status pir_band_grow(pir_band *band, const pir_pose end[2], uint64_t *work, pir_pose **ret_step,
                         uint32_t *ret_steps) {
    const pir_band_pose ends[2] = {unit_pose(&end[0]), unit_pose(&end[1])};
    const uint64_t begin = band->bodies.work;
    uint32_t met[2];
    bool is_free = false;
    *ret_step = NULL;
    *ret_steps = 0;
    pir_status status = pir_band_trees_grow(&band->bodies, ends, *work, &band->trees, met);
    if (status == PIR_OK)
        status = pir_band_trees_way(&band->trees, met, &band->row);
    if (status == PIR_OK) {
        pir_pose *step = calloc(band->row.count, sizeof *step);
        status = step ? prove(band, end, step, ret_steps, &is_free) : PIR_ERR_MEMORY;
        if (status == PIR_OK && is_free)
            *ret_step = step;
        else
            free(step);
    }
    *work = work_left(band, begin, *work);
    return status;
}
